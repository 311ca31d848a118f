// Smooth normals, and where a surface is to have none: at sharp edges.

// Sums of the faces' normals, weighted by area, at every vertex; of unit length. The page sums them itself for the frame that it shows,
// by the formula of mesh/triangles/normals.h, because a recording holds positions only.
export function smooth_normals(normals, positions, triangles) {
  normals.fill(0);
  for (let t = 0; t < triangles.length; t += 3) {
    const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
    const ux = positions[b] - positions[a], uy = positions[b + 1] - positions[a + 1], uz = positions[b + 2] - positions[a + 2];
    const vx = positions[c] - positions[a], vy = positions[c + 1] - positions[a + 1], vz = positions[c + 2] - positions[a + 2];
    const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    normals[a] += x, normals[a + 1] += y, normals[a + 2] += z;
    normals[b] += x, normals[b + 1] += y, normals[b + 2] += z;
    normals[c] += x, normals[c + 1] += y, normals[c + 2] += z;
  }
  for (let i = 0; i < normals.length; i += 3) {
    const length = Math.sqrt(normals[i] ** 2 + normals[i + 1] ** 2 + normals[i + 2] ** 2) || 1;
    normals[i] /= length, normals[i + 1] /= length, normals[i + 2] /= length;
  }
}

function face_normals(positions, triangles) {
  const normals = new Float32Array(triangles.length);
  const corners = new Float32Array(9), normal = new Float32Array(9);
  for (let t = 0; t < triangles.length; t += 3) {
    for (let k = 0; k < 9; ++k) corners[k] = positions[3 * triangles[t + Math.floor(k / 3)] + (k % 3)];
    smooth_normals(normal, corners, [0, 1, 2]);
    normals.set(normal.subarray(0, 3), t);
  }
  return normals;
}

// A body's vertices taken apart where its faces meet at more than `angle` [rad]: the corner of a box becomes three.
// source[i]: the vertex that the drawn vertex i is a copy of.
export function creased(positions, triangles, angle) {
  const normals = face_normals(positions, triangles), least = Math.cos(angle);
  const copies = new Map(); // vertex: its copies, each with the normal of its first face
  const source = [], out = new Uint32Array(triangles.length);
  triangles.forEach((vertex, k) => {
    const t = 3 * Math.floor(k / 3), n = normals.subarray(t, t + 3);
    if (!copies.has(vertex)) copies.set(vertex, []);
    let copy = copies.get(vertex).find(({ normal: m }) => m[0] * n[0] + m[1] * n[1] + m[2] * n[2] > least);
    if (!copy) {
      copy = { normal: n, index: source.length };
      source.push(vertex);
      copies.get(vertex).push(copy);
    }
    out[k] = copy.index;
  });
  return { source: Uint32Array.from(source), triangles: out };
}
