// What the tests of the page need: a browser, a run of the real program, its PC2 file, the pixels of a picture.
import { execFileSync, spawnSync } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));

export function skip(reason) {
  console.log(`SKIPPED: ${reason}`);
  process.exit(77);
}

export function find_browser() {
  const names = ["chromium-headless-shell", "chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];
  const folders = process.env.PATH.split(":");
  return process.env.DRAPE_BROWSER ?? names.flatMap((name) => folders.map((folder) => join(folder, name))).find(existsSync);
}

// Fetched into `work` once; the source tree stays as it is.
export function playwright(work) {
  mkdirSync(work, { recursive: true });
  const lock = readFileSync(join(here, "package-lock.json"), "utf8"), stamp = join(work, "fetched");
  if (!existsSync(stamp) || readFileSync(stamp, "utf8") !== lock) {
    for (const name of ["package.json", "package-lock.json", ".npmrc"]) copyFileSync(join(here, name), join(work, name));
    const npm = spawnSync("npm", ["ci", "--loglevel=error"], { cwd: work, encoding: "utf8" });
    if (npm.status !== 0) skip(`npm could not fetch playwright-core: ${npm.error?.message ?? npm.stderr.trim()}`);
    writeFileSync(stamp, lock);
  }
  return createRequire(join(work, "package.json"))("playwright-core");
}

// No sandbox: in a container root has none. WebGL in software: it needs no graphics card.
export function launch({ chromium }, executablePath) {
  return chromium.launch({ executablePath, args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
}

export function drape(program, words, cwd) {
  const run = spawnSync(program, words, { cwd, encoding: "utf8" });
  if (run.error) throw run.error;
  return { code: run.status, out: run.stdout, err: run.stderr };
}

const scene = (duration, frame_rate) => `[simulation]
duration = ${duration}
frame_rate = ${frame_rate}
tolerance = 1e-4
[[cloth]]
name = "sheet"
mesh = "sheet.obj"
translate = [0.01, 0.3, 0.02]
stretch = "300 N/m"
[[obstacle]]
name = "ball"
shape = "sphere"
radius = "0.2 m"
[obstacle.motion]
keyframes = [{ time = "0 s" }, { time = "0.5 s", translate = ["0.1 m", "0 m", "0 m"] }]
[[obstacle]]
name = "floor"
shape = "plane"
point = [0, -0.2, 0]
normal = [0, 1, 0]
`;

// A sheet of n x n vertices over a ball that moves, on a floor.
export function simulate(program, work, { n = 20, duration = 0.5, frame_rate = 50 } = {}) {
  rmSync(work, { recursive: true, force: true });
  mkdirSync(work, { recursive: true });
  const lines = [];
  for (let j = 0; j < n; ++j) for (let i = 0; i < n; ++i) lines.push(`v ${i / (n - 1) - 0.5} 0 ${j / (n - 1) - 0.5}`);
  for (let j = 1; j < n; ++j)
    for (let i = 1; i < n; ++i) lines.push(`f ${(j - 1) * n + i} ${j * n + i} ${j * n + i + 1} ${(j - 1) * n + i + 1}`);
  writeFileSync(join(work, "sheet.obj"), lines.join("\n") + "\n");
  writeFileSync(join(work, "scene.toml"), scene(duration, frame_rate));
  execFileSync(program, ["simulate", "scene.toml", "--out", "run", "--quiet", "--threads", "1"], { cwd: work });
  return join(work, "run");
}

// POINTCACHE2: vertices and samples in the head of 32 bytes, then float32 x y z.
export function read_pc2(path) {
  const bytes = readFileSync(path), vertices = bytes.readInt32LE(16), frames = bytes.readInt32LE(28);
  const position = (frame, vertex) => [0, 1, 2].map((c) => bytes.readFloatLE(32 + 4 * (3 * (frame * vertices + vertex) + c)));
  return { vertices, frames, position };
}

// Of two pictures (PNG): how many colours the first has, and how many pixels differ. A page of the browser decodes them.
export async function compare_pixels(browser, first, second = first) {
  const page = await browser.newPage();
  const counts = await page.evaluate(async (pictures) => {
    const pixels = await Promise.all(pictures.map(async (text) => {
      const image = await createImageBitmap(await (await fetch("data:image/png;base64," + text)).blob());
      const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
      context.drawImage(image, 0, 0);
      return new Uint32Array(context.getImageData(0, 0, image.width, image.height).data.buffer);
    }));
    return { colours: new Set(pixels[0]).size, different: pixels[0].filter((x, i) => x !== pixels[1][i]).length };
  }, [first, second].map((picture) => picture.toString("base64")));
  await page.close();
  return counts;
}
