// The page of `drape compare` in a real browser: the plots of a real comparison, and of plots that are known.
//   node compare.mjs PROGRAM WORK      exit code 77: skipped, the reason is printed
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { after, afterEach, before, test } from "node:test";
import { drape, find_browser, launch, playwright, skip } from "./tools.mjs";

const [program, work] = process.argv.slice(2).map((path) => resolve(path));
const executable = find_browser();
if (!executable) skip("there is no browser; on Debian: apt install chromium-headless-shell");
rmSync(join(work, "compare"), { recursive: true, force: true });
mkdirSync(join(work, "compare"), { recursive: true });
const words = ["compare", "--sizes", "100,400", "--steps", "4", "--repeats", "1", "--solvers", "mpcg,eigen-cg,eigen-ldlt", "--threads", "1"];
const ran = drape(program, [...words, "--out", "o"], join(work, "compare"));
assert.equal(ran.code, 0, ran.err);
const path = join(work, "compare/o/compare.html"), html = readFileSync(path, "utf8");
if (html.includes("the viewer is not in this build")) skip("the viewer is not in this build");
const library = playwright(join(work, "npm"));

let browser, page;
before(async () => (browser = await launch(library, executable)));
after(() => browser.close());
afterEach(async () => {
  await page.close();
  assert.deepEqual(page.said, []);
});

async function open(file, options = {}) {
  page = await browser.newPage({ viewport: { width: 1400, height: 800 }, ...options });
  page.said = [];
  // That the tests read pixels back is of no concern here.
  page.on("console", (message) => message.text().includes("readback") || page.said.push(message.text()));
  page.on("pageerror", (error) => page.said.push(error.stack));
  page.on("request", (request) => request.url() !== `file://${file}` && page.said.push(`request: ${request.url()}`));
  await page.goto(`file://${file}`);
}

// The page with other plots.
function with_plots(name, plots) {
  const file = join(work, "compare", name), figures = plots.map(({ title }) => `<figure><figcaption><strong>${title}</strong></figcaption></figure>`);
  const data = /(<script type="application\/json" id="drape-plots">)[^<]*/;
  writeFileSync(file, html.replace(/<figure>[^]*<\/figure>/, () => figures.join("")).replace(data, (all, tag) => tag + JSON.stringify(plots)));
  return file;
}
const series = (name, look, x, y, more = {}) => ({ name, x, y, line: true, every: 1, dashed: false, look, ...more });
const plot = (logarithmic, all) => ({ title: "t", x_label: "x", y_label: "y", log_x: logarithmic, log_y: logarithmic, series: all });

// Where the points of a series of the first plot are drawn, in pixels of the canvas, and the colours there.
const points = (k) => page.evaluate((at) => {
  const u = drape.plots[0], [xs, ys] = u.data[at + 1]; // the first place of data is free
  return xs.map((x, i) => {
    const place = [u.valToPos(x, "x", true), u.valToPos(ys[i], "y", true)];
    return { place, colour: [...u.ctx.getImageData(Math.round(place[0]), Math.round(place[1]), 1, 1).data].join() };
  });
}, k);

test("a real comparison has its plots, in both themes", async () => {
  for (const colorScheme of ["light", "dark"]) {
    await open(path, { colorScheme });
    assert.equal(await page.evaluate(() => drape.plots.length), 4);
    assert.equal(await page.locator(".plots .uplot[role=img]").count(), 4);
    assert.match(await page.locator(".plots .uplot").first().getAttribute("aria-label"), /^Time against vertices: set-up and solve, ms against vertices of mpcg, eigen-cg, eigen-ldlt; /);
    assert.deepEqual(await page.locator("figure").nth(0).locator("li").allInnerTexts(), ["mpcg", "eigen-cg", "eigen-ldlt"]);
    assert.deepEqual(await page.locator("figure").nth(1).locator("li").allInnerTexts(), ["mpcg", "eigen-cg"]); // a direct one has no iterations
    assert.equal((await points(0)).length, 2);
    await page.screenshot({ path: join(work, "compare", `${colorScheme}.png`), fullPage: true });
    if (colorScheme === "light") await page.close();
  }
});

test("points lie where the axes say, each series in its own colour", async () => {
  for (const logarithmic of [false, true]) {
    const x = logarithmic ? [1, 10, 1000] : [10, 20, 40], y = logarithmic ? [0.01, 1, 0.1] : [3, 1, 2];
    await open(with_plots("known.html", [plot(logarithmic, [series("s", 0, x, y)])]));
    const at = await points(0), [first, second, third] = at.map(({ place }) => place);
    assert.ok(Math.abs((second[0] - first[0]) / (third[0] - first[0]) - 1 / 3) < 0.01);
    assert.ok(Math.abs((third[1] - first[1]) / (second[1] - first[1]) - 0.5) < 0.01);
    assert.equal(second[1] < first[1], y[1] > y[0]); // up is more
    for (const { colour } of at) assert.equal(colour, "0,114,178,255");
    if (!logarithmic) await page.close();
  }
  await page.close();
  const rows = [...Array(7).keys()];
  await open(with_plots("seven.html", [plot(false, rows.map((k) => series(String(k), k, [0, 1], [k, k])))]));
  assert.equal(new Set(await Promise.all(rows.map(async (k) => (await points(k))[0].colour))).size, 7);
});

test("a limit is dashed, in the colour of the text; every fifth point has a marker", async () => {
  const x = [...Array(11).keys()], all = [series("s", 0, x, x.map(() => 1), { line: false, every: 5 }), series("limit", 1, [0, 10], [2, 2], { every: 0, dashed: true })];
  await open(with_plots("limit.html", [plot(false, all)]), { colorScheme: "dark" });
  const drawn = (await points(0)).map(({ colour }) => colour === "0,114,178,255");
  assert.deepEqual(drawn, x.map((k) => k % 5 === 0));
  const colours = await page.evaluate(() => {
    const u = drape.plots[0], y = Math.round(u.valToPos(2, "y", true)), from = Math.round(u.valToPos(0, "x", true)), to = Math.round(u.valToPos(10, "x", true));
    const row = u.ctx.getImageData(from, y, to - from, 1).data;
    return Array.from({ length: to - from }, (_, i) => row[4 * i] > 200);
  });
  const light = colours.filter(Boolean).length / colours.length;
  assert.ok(light > 0.4 && light < 0.7, `${light}`);
});

test("a narrow window has narrow plots", async () => {
  await open(path, { viewport: { width: 420, height: 800 } });
  assert.ok(await page.evaluate(() => drape.plots.every((u) => u.width <= 420)));
});
