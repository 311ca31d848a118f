// The page of `drape view` in a real browser: a real run, the real program.
//   node viewer.mjs PROGRAM WORK      exit code 77: skipped, the reason is printed
import assert from "node:assert/strict";
import { cpSync, readFileSync, rmSync, truncateSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { after, before, beforeEach, afterEach, test } from "node:test";
import { compare_pixels, drape, find_browser, launch, playwright, read_pc2, simulate, skip } from "./tools.mjs";

const [program, work] = process.argv.slice(2).map((path) => resolve(path));
const executable = find_browser();
if (!executable) skip("there is no browser; on Debian: apt install chromium-headless-shell");
const folder = simulate(program, join(work, "run"));
const written = drape(program, ["view", folder]);
if (written.err.includes("not in this build")) skip(written.err.trim());
const library = playwright(join(work, "npm"));

let browser, page, said;
before(async () => (browser = await launch(library, executable)));
after(() => browser.close());

// A page that remembers every complaint and every request.
async function open(path, options = {}) {
  const opened = await browser.newPage({ viewport: { width: 1100, height: 700 }, ...options });
  opened.said = [];
  opened.on("console", (message) => ["error", "warning"].includes(message.type()) && opened.said.push(message.text()));
  opened.on("pageerror", (error) => opened.said.push(error.stack));
  opened.on("request", (request) => request.url() !== `file://${path}` && opened.said.push(`request: ${request.url()}`));
  await opened.goto(`file://${path}`);
  await opened.waitForFunction(() => window.drape);
  return opened;
}

beforeEach(async () => (page = await open(join(folder, "view.html"))));
afterEach(async () => {
  // What Chromium says of software rendering is of no concern here.
  said = page.said.filter((line) => !/GPU stall|GL Driver Message|software WebGL/i.test(line));
  await page.close();
  assert.deepEqual(said, []);
});

const frame = () => page.evaluate(() => window.drape.transport.frame);
const seek = (k) => page.evaluate((at) => window.drape.transport.seek(at), k);
// After the scene has been drawn.
async function picture() {
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  return page.locator("#stage").screenshot();
}
async function differing(act) {
  const first = await picture();
  await act();
  return (await compare_pixels(browser, first, await picture())).different;
}

test("the program says what it wrote", () => {
  assert.equal(written.code, 0, written.err);
  assert.equal(written.err, "");
  assert.match(written.out, /^wrote .*view\.html \(26 frames, \d+\.\d MB\)\n$/);
});

test("the scene is drawn", async () => {
  const { colours } = await compare_pixels(browser, await picture());
  assert.ok(colours > 200, `${colours} colours`);
  assert.equal(await page.title(), "scene");
  assert.equal(await page.locator("#banner").isVisible(), false);
  assert.match(await page.locator("#facts").innerText(), /Integrator\s+implicit-euler/);
});

test("it plays, pauses and loops", async () => {
  await page.keyboard.press("Space");
  await page.waitForFunction(() => window.drape.transport.frame > 3);
  await page.evaluate(() => (window.seen = new Set()) && setInterval(() => window.seen.add(window.drape.transport.frame), 5));
  await page.waitForFunction(() => window.seen.has(25) && window.drape.transport.frame < 20);
  await page.keyboard.press("Space");
  const stopped = await frame();
  await page.waitForTimeout(150);
  assert.equal(await frame(), stopped);
  await page.locator("#loop + span").click();
  await seek(22);
  await page.locator("#play").click();
  await page.waitForFunction(() => !window.drape.transport.playing);
  assert.equal(await frame(), 25);
});

test("speed is that of the clock", async () => {
  await page.selectOption("#speed", "0.1");
  const started = await page.evaluate(() => {
    window.drape.transport.play(true);
    return performance.now();
  });
  await page.waitForFunction(() => window.drape.transport.frame >= 3);
  const took = (await page.evaluate(() => performance.now())) - started;
  assert.ok(took >= 3 * 0.02 * 1000 / 0.1 - 5, `${took} ms`); // 3 frames of 20 ms, ten times slower; never early
});

test("arrow keys step, Home and End go to the ends", async () => {
  await page.keyboard.press("End");
  assert.equal(await frame(), 25);
  await page.keyboard.press("ArrowLeft");
  assert.equal(await frame(), 24);
  await page.keyboard.press("Home");
  await page.keyboard.press("ArrowLeft");
  assert.equal(await frame(), 0);
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowRight");
  assert.equal(await frame(), 2);
  assert.match(await page.locator("#frame").innerText(), /^\s*3 \/ 26$/); // from 1, as in picture --frame
  assert.match(await page.locator("#scrub").getAttribute("aria-valuetext"), /^frame 3, /);
  assert.equal(await page.locator("#time").innerText(), "0.040 s");
});

test("scrubbing shows another moment", async () => {
  const box = await page.locator("#scrub").boundingBox();
  const changed = await differing(() => page.mouse.click(box.x + 0.6 * box.width, box.y + box.height / 2));
  assert.ok(changed > 1000, `${changed} pixels`);
  assert.ok(Math.abs((await frame()) - 15) <= 1);
});

test("every colouring changes pixels and has its legend", async () => {
  await seek(20);
  for (const [mode, legend] of [["strain", /Strain \[%\]/], ["speed", /Speed \[m\/s\]/], ["contact", /Contact\s+free\s*slides\s*sticks\s*on cloth\s*stopped/]]) {
    const changed = await differing(() => page.locator(`#colour-${mode} + span`).click());
    assert.ok(changed > 1000, `${mode}: ${changed} pixels`);
    assert.match(await page.locator("#legend").innerText(), legend);
  }
  assert.ok((await differing(() => page.keyboard.press("c"))) > 1000); // round to plain
  assert.equal(await page.locator("#legend").isVisible(), false);
});

test("the faster a vertex is, the brighter it is", async () => {
  await seek(20);
  await page.locator("#colour-speed + span").click();
  const vertices = await page.evaluate(() => {
    const [{ shape, colour }] = window.drape.stage.drawn, bright = (i) => [0.2126, 0.7152, 0.0722].reduce((sum, w, c) => sum + w * colour.array[3 * i + c], 0);
    return Array.from({ length: shape.vertices }, (_, i) => ({ speed: shape.value("speed", 20, i), bright: bright(i) }));
  });
  vertices.sort((a, b) => a.speed - b.speed);
  for (let i = 1; i < vertices.length; ++i) {
    const [slower, faster] = vertices.slice(i - 1, i + 1); // the map's colours are rounded to 8 bits
    assert.ok(faster.bright >= slower.bright - 0.002, JSON.stringify([slower, faster]));
  }
  assert.ok(vertices.at(-1).bright > vertices[0].bright + 0.05);
});

test("wireframe, bodies and turning change pixels", async () => {
  await seek(20);
  assert.ok((await differing(() => page.locator("#wireframe + span").click())) > 1000);
  assert.ok((await differing(() => page.keyboard.press("w"))) > 1000);
  assert.ok((await differing(() => page.keyboard.press("b"))) > 1000);
  const box = await page.locator("#canvas").boundingBox();
  const drag = async () => {
    await page.mouse.move(box.x + 300, box.y + 200);
    await page.mouse.down();
    await page.mouse.move(box.x + 380, box.y + 230, { steps: 4 });
    await page.mouse.up();
  };
  assert.ok((await differing(drag)) > 1000);
  assert.equal(await page.evaluate(() => window.drape.picking.picked), null); // a drag is no click
  assert.ok((await differing(() => page.keyboard.press("Shift+ArrowRight"))) > 1000);
});

test("both sides of the cloth are seen, in two tones", async () => {
  const tone = (up) => page.evaluate(async (sign) => {
    const { stage } = window.drape, { middle, radius } = stage.box;
    stage.camera.position.set(middle[0], middle[1] + sign * 4 * radius, middle[2] + 0.01 * radius);
    stage.set_visible({ wireframe: false, bodies: false });
    await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    stage.dirty = true;
    stage.draw();
    const gl = stage.renderer.getContext(), pixel = new Uint8Array(4);
    gl.readPixels(gl.drawingBufferWidth / 2, gl.drawingBufferHeight / 2, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    return [...pixel];
  }, up);
  const above = await tone(1), below = await tone(-1);
  const ratio = (pixel) => pixel[2] / pixel[0]; // light scales red and blue alike, the tone does not
  assert.ok(Math.abs(ratio(above) / ratio(below) - 1) > 0.05, `${above} and ${below}`);
});

test("what lies beneath the cloth does not show through", async () => {
  await page.keyboard.press("End"); // corners of the sheet lie on the floor
  const [inside, through] = await page.evaluate(async () => {
    const { stage } = window.drape, { middle, radius } = stage.box, gl = stage.renderer.getContext();
    stage.camera.position.set(middle[0] + 0.01 * radius, middle[1] + 4 * radius, middle[2]);
    await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    const across = gl.drawingBufferWidth, high = gl.drawingBufferHeight, [sheet, ...others] = [...stage.drawn, ...stage.floors];
    const seen = (cloth, beneath) => {
      sheet.mesh.visible = cloth;
      for (const { mesh } of others) mesh.visible = beneath;
      stage.renderer.render(stage.scene, stage.camera);
      const pixels = new Uint8Array(4 * across * high);
      gl.readPixels(0, 0, across, high, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      return new Int32Array(pixels.buffer);
    };
    const nothing = seen(false, false), alone = seen(true, false), all = seen(true, true);
    const around = [-1, 0, 1].flatMap((row) => [-1, 0, 1].map((column) => row * across + column));
    const cloth = [...alone.keys()].filter((k) => around.every((to) => alone[k + to] !== nothing[k + to]));
    return [cloth.length, cloth.filter((k) => alone[k] !== all[k]).length];
  });
  assert.ok(inside > 5000, `${inside}`);
  assert.ok(through < 0.005 * inside, `${through} of ${inside} pixels`); // at rims, where pixels are half covered
});

test("a click takes a vertex, and it is where the PC2 file has it", async () => {
  const pc2 = read_pc2(join(folder, "sheet.pc2"));
  await seek(10);
  await picture();
  const nearest = await page.evaluate(() => {
    const { stage, shapes } = window.drape, sheet = shapes[0], area = stage.canvas.getBoundingClientRect();
    let best = { away: Infinity };
    for (let vertex = 0; vertex < sheet.vertices; ++vertex) {
      const at = stage.camera.position.clone().set(...sheet.position(stage.frame, vertex)), away = at.distanceTo(stage.camera.position);
      const seen = at.project(stage.camera);
      const x = area.x + ((seen.x + 1) / 2) * area.width, y = area.y + ((1 - seen.y) / 2) * area.height;
      if (away < best.away) best = { away, vertex, x, y };
    }
    const [x, y] = [area.x + area.width / 2 - best.x, area.y + area.height / 2 - best.y], length = Math.hypot(x, y);
    return { vertex: best.vertex, x: best.x + (3 * x) / length, y: best.y + (3 * y) / length }; // on the cloth, not at its rim
  });
  await page.mouse.click(nearest.x, nearest.y);
  assert.equal(await page.locator("#vertex-number").inputValue(), String(nearest.vertex));
  assert.equal(await page.locator("#vertex-shape").evaluate((choice) => choice.selectedOptions[0].text), "sheet");
  await page.locator("#vertex-number").blur();

  const step = await page.evaluate(() => window.drape.shapes[0].track.step);
  for (const k of [10, 11, 25]) {
    await seek(k);
    const shown = (await page.locator("#vertex-values dd").first().innerText()).split(", ").map(Number);
    const decimals = 0.5 * 10 ** -(await page.locator("#vertex-values dd").first().innerText()).split(",")[0].split(".")[1].length;
    pc2.position(k, nearest.vertex).forEach((x, c) =>
      assert.ok(Math.abs(shown[c] - x) <= step[c] / 2 + decimals + 1e-7, `frame ${k}: ${shown} for ${pc2.position(k, nearest.vertex)}`));
  }
  const values = await page.locator("#vertex-values").innerText();
  for (const line of [/speed \[m\/s\]\s+[\d.e-]+/, /strain \[%\]\s+-?[\d.e-]+/, /contact\s+(free|slides|sticks|on cloth|stopped)/]) assert.match(values, line);
  await page.keyboard.press("Escape");
  assert.equal(await page.locator("#vertex-values").isVisible(), false);
});

test("all positions are the PC2 file's to half a step", async () => {
  const pc2 = read_pc2(join(folder, "sheet.pc2"));
  const { values, step } = await page.evaluate(() => {
    const sheet = window.drape.shapes[0], all = [];
    for (let k = 0; k < sheet.track.frames; ++k) for (let i = 0; i < sheet.vertices; ++i) all.push(sheet.position(k, i));
    return { values: all, step: sheet.track.step };
  });
  assert.equal(values.length, pc2.frames * pc2.vertices);
  let worst = 0;
  values.forEach((x, k) => {
    const expected = pc2.position(Math.floor(k / pc2.vertices), k % pc2.vertices);
    for (let c = 0; c < 3; ++c) worst = Math.max(worst, Math.abs(x[c] - expected[c]) / step[c]);
  });
  assert.ok(worst <= 0.5001, `${worst} steps`);
});

test("plots follow the time, and a click in one goes there", async () => {
  assert.equal(await page.locator("#plots figure").count(), 6);
  const line = page.locator("#plots .now").first(), place = async () => (await line.boundingBox()).x;
  await seek(5);
  const early = await place();
  const contacts = page.locator("#plots figure", { hasText: "Contacts" }).locator("output");
  const before_touch = await contacts.innerText();
  await seek(25);
  assert.ok((await place()) > early + 50);
  const rows = readFileSync(join(folder, "steps.csv"), "utf8").trim().split("\n").map((row) => row.split(","));
  assert.equal(await contacts.innerText(), rows.at(-1)[rows[0].indexOf("contacts")]);
  assert.notEqual(await contacts.innerText(), before_touch);
  const area = await page.locator("#plots .u-over").nth(1).boundingBox();
  await page.mouse.click(area.x + 0.4 * area.width, area.y + 20);
  const time = await page.evaluate(() => window.drape.head.times[window.drape.transport.frame]);
  assert.ok(Math.abs(time - 0.2) < 0.03, `${time} s`);
});

test("dark and light", async () => {
  const changed = await differing(() => page.emulateMedia({ colorScheme: "dark" }));
  assert.ok(changed > 100000, `${changed} pixels`);
});

test("narrow windows and frames in other pages", async () => {
  await page.setViewportSize({ width: 390, height: 800 });
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), true);
  const outer = await browser.newPage({ viewport: { width: 1000, height: 700 } });
  const errors = [];
  outer.on("pageerror", (error) => errors.push(error.stack));
  await outer.evaluate((html) => {
    const frame = document.createElement("iframe");
    Object.assign(frame, { srcdoc: html, width: 900, height: 600 });
    document.body.append(frame);
  }, readFileSync(join(folder, "view.html"), "utf8"));
  await outer.waitForFunction(() => window.frames[0]?.drape);
  const { colours } = await compare_pixels(browser, await outer.frames()[1].locator("#stage").screenshot());
  await outer.close();
  assert.ok(colours > 200, `${colours} colours`);
  assert.deepEqual(errors, []);
});

test("a name that looks like markup is text", async () => {
  const copy = join(work, "markup"), path = join(copy, "run.json"), name = "</script><script>window.broken=1</script>&\"'@@DATA@@";
  rmSync(copy, { recursive: true, force: true });
  cpSync(folder, copy, { recursive: true });
  writeFileSync(path, JSON.stringify({ ...JSON.parse(readFileSync(path, "utf8")), scene: name + ".toml", warnings: [name] }));
  assert.equal(drape(program, ["view", copy]).code, 0);
  const other = await open(join(copy, "view.html"));
  assert.equal(await other.locator("#warnings li").innerText(), name);
  assert.equal(await other.locator("#facts").evaluate((table, text) => table.innerText.includes(text), name), true);
  assert.equal(await other.evaluate(() => window.broken), undefined);
  assert.deepEqual(other.said, []);
  await other.close();
});

test("a damaged folder is shown, with what is missing", async () => {
  const copy = join(work, "damaged");
  rmSync(copy, { recursive: true, force: true });
  cpSync(folder, copy, { recursive: true });
  rmSync(join(copy, "steps.csv"));
  rmSync(join(copy, "run.json"));
  const pc2 = read_pc2(join(copy, "sheet.pc2"));
  truncateSync(join(copy, "sheet.pc2"), 32 + 12 * pc2.vertices * 9 + 5); // in the tenth frame
  const outcome = drape(program, ["view", copy]);
  assert.equal(outcome.code, 0);
  const warnings = outcome.err.trim().split("\n");
  assert.ok(warnings.length >= 3 && warnings.every((line) => line.startsWith("warning: ")), outcome.err);
  const other = await open(join(copy, "view.html"));
  assert.deepEqual(await other.locator("#missing li").allInnerTexts(), warnings.map((line) => line.replace("warning: ", "")));
  assert.equal(await other.locator("#banner").isVisible(), true);
  assert.equal(await other.locator("#no-plots").isVisible(), true);
  assert.equal(await other.evaluate(() => window.drape.shapes[0].track.frames), 9);
  assert.deepEqual(other.said, []);
  await other.close();
});

test("without WebGL the numbers are there", async () => {
  const other = await browser.newPage({ viewport: { width: 1100, height: 700 } });
  await other.addInitScript(() => (HTMLCanvasElement.prototype.getContext = ((real) => function (kind, ...rest) {
    return kind.startsWith("webgl") ? null : real.call(this, kind, ...rest);
  })(HTMLCanvasElement.prototype.getContext)));
  await other.goto(`file://${join(folder, "view.html")}`);
  await other.waitForFunction(() => window.drape);
  assert.match(await other.locator("#no-webgl").innerText(), /no WebGL/);
  await other.keyboard.press("End");
  assert.match(await other.locator("#frame").innerText(), /26 \/ 26/);
  assert.equal(await other.locator("#plots figure").count(), 6);
  await other.locator("#vertex-number").fill("7");
  await other.locator("#vertex-number").blur();
  assert.match(await other.locator("#vertex-values").innerText(), /position/);
  await other.close();
});
