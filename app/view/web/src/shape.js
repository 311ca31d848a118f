// A cloth, soft body, rope or body of the run: its faces, where its vertices are, and what is known of them.
import { Track, read_indices } from "./data.js";

export class Shape {
  constructor(head, times) {
    this.name = head.name;
    this.body = head.body;
    this.vertices = head.vertices; // those that are drawn
    this.sides = head.sides ?? 1; // how many are drawn for each of its own: a ring of them round each point of a rope
    this.triangles = read_indices(head.triangles.block, head.triangles.count);
    this.edges = read_indices(head.edges.block, head.edges.count);
    this.track = new Track(head.positions, head.vertices);
    this.fields = {};
    for (const field of ["speed", "strain", "contact"])
      if (head[field]) this.fields[field] = new Track(head[field], head.vertices);
    this.times = times;
    this.speed_from_positions = !head.body && !head.speed && times.length > 1;
  }

  has(field) {
    return field in this.fields || (field === "speed" && this.speed_from_positions);
  }

  // Of one of its own vertices, as below: the middle of its ring.
  position(frame, vertex) {
    const ring = Array.from({ length: this.sides }, (_, k) => vertex * this.sides + k);
    return [0, 1, 2].map((c) => ring.reduce((sum, v) => sum + this.track.value(frame, v, c), 0) / this.sides);
  }

  // Null where it is not known.
  value(field, frame, vertex) {
    if (this.fields[field]) return this.fields[field].value(frame, vertex * this.sides);
    return this.has(field) ? this.#speed(...this.#neighbours(frame), vertex) : null;
  }

  values_to(out, field, frame) {
    if (this.fields[field]) return this.fields[field].copy_to(out, frame);
    const [before, after] = this.#neighbours(frame);
    for (let i = 0; i < this.vertices; ++i) out[i] = this.#speed(before, after, Math.floor(i / this.sides));
  }

  #neighbours(frame) {
    return [Math.max(0, frame - 1), Math.min(this.times.length - 1, frame + 1)];
  }

  // Where velocities were not recorded: the way between the frames before and after.
  #speed(before, after, vertex) {
    const a = this.position(before, vertex), b = this.position(after, vertex);
    return Math.hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]) / (this.times[after] - this.times[before]);
  }
}
