// The Khronos validator and three.js on the glTF export:  node check_gltf.mjs FOLDER   (short_run.py made it)
//   three.js plays the animation to the time of each frame; every vertex is where the run had it.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { compared_count, equal, need, read_expected, same } from "./expected.mjs";

const validator = (await need("gltf-validator")).default;
const three = await need("three");
const { GLTFLoader } = await need("three/addons/loaders/GLTFLoader.js");

const folder = process.argv[2];
const bytes = readFileSync(join(folder, "gltf", "run.glb"));
const { times, shapes } = read_expected(folder);

const report = await validator.validateBytes(new Uint8Array(bytes), { maxIssues: 20 });
equal(report.issues.numErrors + report.issues.numWarnings, 0, "errors and warnings " + JSON.stringify(report.issues.messages));

const file = await new GLTFLoader().parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), "");
equal(file.scene.children.length, shapes.length, "nodes");
const mixer = new three.AnimationMixer(file.scene);
const action = mixer.clipAction(file.animations[0]);
action.setLoop(three.LoopOnce);
action.clampWhenFinished = true;
action.play();

function places(node, count) {
  const found = [];
  for (let v = 0; v < count; ++v) {
    node.updateWorldMatrix(true, false);
    found.push(...node.getVertexPosition(v, new three.Vector3()).applyMatrix4(node.matrixWorld).toArray());
  }
  return found;
}

for (const [s, shape] of shapes.entries()) {
  const node = file.scene.children[s];
  const own = shape.positions[0].length / 3;
  equal(file.parser.json.nodes[s].name, shape.name, "name");
  const mesh = file.parser.json.meshes[s];
  const targets = mesh.primitives[0].targets?.length ?? 0;
  const deforms = !shape.body || shape.name === "blob";
  equal(targets, deforms ? times.length - 1 : 0, shape.name + ": morph targets");
  // A vertex with two uv comes again behind the mesh's own, 11 of the seam; and each corner of the box for its three sides.
  const doubled = shape.name === "stand" ? 16 : shape.uv && shape.name !== "plain" ? 11 : 0;
  equal(node.geometry.attributes.position.count, own + doubled, shape.name + ": vertices");
  const triangles = shape.faces.reduce((sum, face) => sum + face.length - 2, 0);
  equal(node.geometry.index.count, 3 * triangles, shape.name + ": indices");
  const uv = node.geometry.attributes.uv;
  equal(uv !== undefined, shape.uv !== null, shape.name + ": has uv");
  if (!uv) continue;
  // Every corner of every triangle has a uv that a face of the input has at that place. v goes down in glTF.
  const known = new Set();
  shape.faces.forEach((face, f) => face.forEach((v, k) => {
    const at = shape.positions[0].slice(3 * v, 3 * v + 3).map(Math.fround);
    known.add([...at, Math.fround(shape.uv[f][k][0]), Math.fround(1 - shape.uv[f][k][1])].join());
  }));
  const position = node.geometry.attributes.position;
  const found = new Set();
  for (const v of node.geometry.index.array) {
    const key = [position.getX(v), position.getY(v), position.getZ(v), uv.getX(v), uv.getY(v)].join();
    if (!known.has(key)) throw new Error(`${shape.name}: vertex ${v} has a uv that it has in no face: ${key}`);
    found.add(key);
  }
  equal(found.size, known.size, shape.name + ": vertices with their uv");
}

for (const [k, time] of times.entries()) {
  mixer.setTime(time);
  for (const [s, shape] of shapes.entries()) {
    const count = shape.positions[k].length / 3;
    same(places(file.scene.children[s], count), shape.positions[k], 1e-6, `${shape.name}, frame ${k + 1}`);
  }
}
// Half way between two frames a vertex of what deforms is half way.
mixer.setTime((times[3] + times[4]) / 2);
const half = shapes[0].positions[3].map((x, i) => (x + shapes[0].positions[4][i]) / 2);
same(places(file.scene.children[0], half.length / 3), half, 2e-6, "between frames");

console.log(`the validator has no errors and no warnings; three.js plays ${compared_count()} coordinates as they were computed`);
