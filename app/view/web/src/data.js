// The data of the page: a JSON head, and blocks of compressed numbers beside it, as app/view/page_data.cpp writes them.
import { unzlibSync } from "fflate";

export function read_head() {
  return JSON.parse(document.getElementById("drape-head").textContent);
}

// fflate and not the browser's DecompressionStream: it answers at once, also in browsers that do not have the latter.
function block_bytes(id) {
  const element = document.getElementById("drape-block-" + id);
  const text = atob(element.textContent.trim());
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  element.remove(); // its memory is not needed twice
  return unzlibSync(bytes);
}

const unzigzag = (z) => (z >>> 1) ^ -(z & 1);

// A list of numbers from 0: differences of neighbours, four planes of bytes.
export function read_indices(id, count) {
  const bytes = block_bytes(id);
  const list = new Uint32Array(count);
  let last = 0;
  for (let i = 0; i < count; ++i) {
    const z = bytes[i] | (bytes[count + i] << 8) | (bytes[2 * count + i] << 16) | (bytes[3 * count + i] << 24);
    list[i] = last += unzigzag(z);
  }
  return list;
}

// Columns of 32-bit floating point numbers, one after the other.
export function read_columns(id, names, rows) {
  const bytes = block_bytes(id);
  const all = new Float32Array(bytes.buffer, bytes.byteOffset, names.length * rows);
  return new Map(names.map((name, c) => [name, all.subarray(c * rows, (c + 1) * rows)]));
}

// Whole numbers of 16 bits that change with time. A chunk of frames has of every frame, component and vertex the
// difference to what the frames before let expect (order 1: that nothing moves, 2: that it goes on as before), with
// `neighbours` the difference of this to that of the vertex before; low bytes first, then the high ones.
export class Track {
  constructor(head, vertices) {
    this.vertices = vertices;
    this.components = head.min.length;
    this.min = head.min;
    this.step = head.step;
    this.row = vertices * this.components;
    this.frames = head.chunks.reduce((sum, chunk) => sum + chunk.frames, 0);
    this.values = new Uint16Array(this.frames * this.row);
    let frame = 0;
    for (const chunk of head.chunks) {
      const bytes = block_bytes(chunk.block), count = chunk.frames * this.row;
      for (let k = 0; k < chunk.frames; ++k, ++frame)
        this.#decode(frame, bytes.subarray(k * this.row), bytes.subarray(count + k * this.row), chunk);
    }
  }

  #decode(frame, low, high, { order, neighbours }) {
    const { values, row, vertices } = this, start = frame * row;
    const last = frame > 0 ? start - row : -1, before = order === 2 && frame > 1 ? start - 2 * row : last;
    for (let i = 0, change = 0; i < row; ++i) {
      if (!neighbours || i % vertices === 0) change = 0;
      change += unzigzag(low[i] | (high[i] << 8));
      // Of 16 bits: it wraps round as the writer's does.
      values[start + i] = change + (last < 0 ? 0 : before === last ? values[last + i] : 2 * values[last + i] - values[before + i]);
    }
  }

  #start(frame, component) {
    return Math.min(frame, this.frames - 1) * this.row + component * this.vertices;
  }

  value(frame, vertex, component = 0) {
    return this.min[component] + this.step[component] * this.values[this.#start(frame, component) + vertex];
  }

  // All vertices of a frame, component by component next to each other: x y z x y z ...
  copy_to(out, frame) {
    const { components, vertices, values } = this;
    for (let c = 0; c < components; ++c) {
      const start = this.#start(frame, c), min = this.min[c], step = this.step[c];
      for (let i = 0, to = c; i < vertices; ++i, to += components) out[to] = min + step * values[start + i];
    }
  }
}
