// How large the page of 200 frames of 10 000 vertices is, and how fast it plays: the script's part of a frame, and how often the
// browser drew, which without a graphics card is mostly its software's doing.
//   node measure.mjs PROGRAM WORK
import { statSync } from "node:fs";
import { join, resolve } from "node:path";
import { drape, find_browser, launch, playwright, simulate } from "./tools.mjs";

const [program, work] = process.argv.slice(2).map((path) => resolve(path));
const folder = simulate(program, join(work, "run"), { n: 100, duration: 2, frame_rate: 100 });
const written = drape(program, ["view", folder]);
if (written.code !== 0) throw new Error(written.err);
const path = join(folder, "view.html");
console.log(`page: ${(statSync(path).size / 1e6).toFixed(1)} MB`);

const browser = await launch(playwright(join(work, "npm")), find_browser());
const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
const started = Date.now();
await page.goto(`file://${path}`);
await page.waitForFunction(() => window.drape);
console.log(`opened in ${Date.now() - started} ms`);
for (const mode of ["plain", "strain", "speed", "contact"]) {
  const result = await page.evaluate(async (colour) => {
    document.getElementById("colour-" + colour).click();
    const { transport, stage } = window.drape, frames = transport.times.length, updates = [];
    const begun = performance.now();
    for (let k = 0; k < frames; ++k) transport.seek(k), updates.push(stage.update_ms);
    const script = (performance.now() - begun) / frames;
    transport.seek(0);
    transport.play(true);
    let draws = 0;
    const settled = performance.now() + 2000; // until the number of pixels has been found
    while (performance.now() < settled) await new Promise(requestAnimationFrame);
    const { scale } = stage;
    for (const end = performance.now() + 3000; performance.now() < end; ++draws) await new Promise(requestAnimationFrame);
    transport.play(false);
    return { update: updates.sort((a, b) => a - b)[frames >> 1], script, scale, draws: draws / 3 };
  }, mode);
  console.log(`${mode}: geometry and colours ${result.update.toFixed(1)} ms (median), script in all ${result.script.toFixed(1)} ms a frame, ` +
    `drawn ${result.draws.toFixed(1)} times a second with ${Math.round(100 * result.scale)} % of the pixels of a side`);
}
await browser.close();
