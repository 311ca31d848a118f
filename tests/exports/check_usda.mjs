// Two readers on the USD export:  node check_usda.mjs FOLDER   (short_run.py made it)
//   tinyusdz, which is strict about syntax and types, takes the file and refuses damaged ones; three.js reads the numbers.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { compared_count, equal, need, read_expected, same } from "./expected.mjs";

const { USDAParser } = await need("three/addons/loaders/usd/USDAParser.js");
await need("three");

// tinyusdz is built for browsers only: what tells it that it is not in one is hidden while it starts.
async function start_tinyusdz() {
  let path;
  try {
    path = createRequire(import.meta.url).resolve("tinyusdz/tinyusdz.js");
  } catch {
    return (await need("tinyusdz")).default;
  }
  const wasmBinary = readFileSync(path.replace(/js$/, "wasm"));
  const own = globalThis.process;
  globalThis.window = globalThis;
  globalThis.process = undefined;
  try {
    return await (await import(pathToFileURL(path))).default({ wasmBinary });
  } finally {
    globalThis.process = own;
    delete globalThis.window;
  }
}

const folder = process.argv[2];
const text = readFileSync(join(folder, "usda", "run.usda"), "utf8");
const { times, shapes } = read_expected(folder);

const tinyusdz = await start_tinyusdz();
function load(source) {
  const loader = new tinyusdz.TinyUSDZLoaderNative();
  return loader.loadFromBinary(new TextEncoder().encode(source), "run.usda") ? loader : loader.error();
}
const loader = load(text);
if (typeof loader === "string") throw new Error(loader);
equal(loader.numMeshes(), shapes.length, "meshes");
const names = new Set();
for (let s = 0; s < shapes.length; ++s) names.add(loader.getMesh(s).displayName);
equal([...names].sort(), shapes.map((shape) => shape.name).sort(), "display names");
for (const damaged of [text.slice(0, text.length / 2), text.replace("point3f[]", "point3g[]"), text.replace("0: [(", "0: [(,")]) {
  if (typeof load(damaged) !== "string") throw new Error("a damaged file is read: this check checks nothing");
}

const layer = new USDAParser().parseData(text).specsByPath;
const root = layer["/"].fields;
equal([root.timeCodesPerSecond, root.metersPerUnit, root.upAxis].map(String), ["25", "1", "Y"], "stage");
const whole = new tinyusdz.TinyUSDZLoaderNative();
equal(whole.loadAsLayerFromBinary(new TextEncoder().encode(text), "run.usda"), true, "as a layer");
for (const line of ["startTimeCode = 0\n", `endTimeCode = ${times.length - 1}\n`, 'defaultPrim = "run"\n']) {
  if (!whole.layerToString().includes(line)) throw new Error("stage without " + line);
}
const paths = Object.keys(layer).filter((path) => layer[path].fields.typeName === "Mesh");
equal(paths.length, shapes.length, "meshes");

for (const [s, shape] of shapes.entries()) {
  const field = (name) => layer[`${paths[s]}.${name}`]?.fields;
  equal(field("faceVertexCounts").default, shape.faces.map((face) => face.length), shape.name + ": faces");
  equal(field("faceVertexIndices").default, shape.faces.flat(), shape.name + ": corners");
  if (shape.uv) same(field("primvars:st").default, shape.uv.flat(2), 1e-7, shape.name + ": st");
  equal(field("primvars:st") !== undefined, shape.uv !== null, shape.name + ": has st");
  equal(field("velocities") !== undefined, !shape.body, shape.name + ": has velocities");
  equal(field("normals") !== undefined, shape.name !== "stand", shape.name + ": has normals, but for hard edges");
  for (const name of ["points", "extent"]) {
    equal(field(name).timeSamples !== undefined, shape.moves, `${shape.name}: ${name} by time`);
  }
  for (const [k, time] of times.entries()) {
    const place = `${shape.name}, frame ${k + 1}`;
    const at = (name) => {
      const { timeSamples, default: still } = field(name);
      if (!timeSamples) return still;
      equal(timeSamples.times.length, times.length, place + ": samples");
      same([timeSamples.times[k] / 25], [time], 1e-9, place + ": time");
      return timeSamples.values[k];
    };
    same(at("points"), shape.positions[k], 5e-7, place);
    if (!shape.body) same(at("velocities"), shape.velocities[k], 5e-7, place + ": velocities");
    const extent = at("extent").flat();
    for (let axis = 0; axis < 3; ++axis) {
      const along = shape.positions[k].filter((_, i) => i % 3 === axis);
      same([extent[axis], extent[axis + 3]], [Math.min(...along), Math.max(...along)], 5e-7, place + ": extent");
    }
  }
}
console.log(`tinyusdz takes the file; three.js reads ${compared_count()} numbers as they were computed`);
