// What the camera looks at: where the cloths are in the whole run, with so much of the bodies as is near them.
export function view_box(shapes, planes) {
  const box = { low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] };
  const cloths = shapes.filter((shape) => !shape.body);
  for (const shape of cloths.length ? cloths : shapes) widen(box, reach(shape));
  if (cloths.length) {
    const most = 2 * Math.max(...[0, 1, 2].map((c) => box.high[c] - box.low[c]));
    const limit = { low: box.low.map((x) => x - most), high: box.high.map((x) => x + most) };
    for (const shape of shapes.filter((s) => s.body)) {
      const body = reach(shape);
      const low = body.low.map((x, c) => Math.max(x, limit.low[c])), high = body.high.map((x, c) => Math.min(x, limit.high[c]));
      if (low.every((x, c) => x <= high[c])) widen(box, { low, high });
    }
  }
  const middle = box.low.map((x, c) => (x + box.high[c]) / 2);
  const radius = Math.max(1e-6, Math.hypot(...box.low.map((x, c) => box.high[c] - x)) / 2);
  return { ...box, middle, radius, up: up_of(planes) };
}

function reach({ track }) {
  const low = [...track.min];
  return { low, high: low.map((x, c) => x + 65535 * track.step[c]) };
}

function widen(box, { low, high }) {
  for (let c = 0; c < 3; ++c) {
    box.low[c] = Math.min(box.low[c], low[c]);
    box.high[c] = Math.max(box.high[c], high[c]);
  }
}

// y is up, unless the ground says otherwise.
function up_of(planes) {
  return planes.some((plane) => plane.normals[0][2] > 0.9) ? [0, 0, 1] : [0, 1, 0];
}
