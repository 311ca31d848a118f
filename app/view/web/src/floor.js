// A plane as a disc under the scene, with a grid that tells sizes; both fade out.
import {
  BufferAttribute, BufferGeometry, Color, DoubleSide, Group, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, Quaternion,
  RingGeometry, Vector3,
} from "three";

const fade = (x) => Math.max(0, 1 - x * x) ** 1.5;

function disc(radius) {
  const geometry = new RingGeometry(0, radius, 72, 12);
  const { position } = geometry.attributes, colours = new Float32Array(4 * position.count);
  for (let i = 0; i < position.count; ++i)
    colours.set([1, 1, 1, fade(Math.hypot(position.getX(i), position.getY(i)) / radius)], 4 * i);
  geometry.setAttribute("color", new BufferAttribute(colours, 4));
  return new Mesh(geometry, new MeshBasicMaterial({
    side: DoubleSide, vertexColors: true, transparent: true, depthWrite: false, polygonOffset: true, polygonOffsetFactor: 2,
    polygonOffsetUnits: 2,
  }));
}

// A tenth to a quarter of the scene, of 1, 2 or 5.
export function grid_spacing(radius) {
  const unit = 10 ** Math.floor(Math.log10(radius / 2));
  return unit * [5, 2, 1].find((x) => x * unit <= radius / 2);
}

function grid(radius, spacing) {
  const points = [], colours = [], lines = Math.floor(radius / spacing), pieces = 24;
  const add = (x, y) => {
    points.push(x, y, 0);
    colours.push(1, 1, 1, fade(Math.hypot(x, y) / radius));
  };
  for (let k = -lines; k <= lines; ++k) {
    const at = k * spacing, half = Math.sqrt(Math.max(0, radius * radius - at * at));
    for (let i = 0; i < pieces; ++i) {
      const from = half * ((2 * i) / pieces - 1), to = half * ((2 * i + 2) / pieces - 1);
      add(at, from), add(at, to), add(from, at), add(to, at);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(Float32Array.from(points), 3));
  geometry.setAttribute("color", new BufferAttribute(Float32Array.from(colours), 4));
  return new LineSegments(geometry, new LineBasicMaterial({ vertexColors: true, transparent: true, depthWrite: false }));
}

export function floor_of(plane, box) {
  const radius = 3 * box.radius, group = new Group();
  const surface = disc(radius), lines = grid(radius, grid_spacing(box.radius));
  group.add(surface, lines);
  const middle = new Vector3(...box.middle), point = new Vector3(), normal = new Vector3(), turn = new Quaternion();
  const show = (frame) => {
    const k = Math.min(frame, plane.points.length - 1);
    point.set(...plane.points[k]);
    normal.set(...plane.normals[k]);
    group.position.copy(middle).addScaledVector(normal, normal.dot(point) - normal.dot(middle));
    group.quaternion.copy(turn.setFromUnitVectors(new Vector3(0, 0, 1), normal));
  };
  const set_colours = (floor, line) => {
    surface.material.color = new Color(floor);
    lines.material.color = new Color(line);
  };
  show(0);
  return { group, show, set_colours };
}
