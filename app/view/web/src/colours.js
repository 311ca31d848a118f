// What a vertex's colour says, and the legend that explains it.
import { interpolateRdBu, interpolateViridis } from "d3-scale-chromatic";

const steps = 512;

function rgb(text) {
  if (text[0] === "#") return [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16));
  return text.match(/\d+/g).slice(0, 3).map(Number);
}

const linear = (c) => (c <= 10.31475 ? c / 3294.6 : Math.pow((c / 255 + 0.055) / 1.055, 2.4));

// A table of linear colours, as the renderer wants them.
function table(colour_at) {
  const out = new Float32Array(3 * (steps + 1));
  for (let i = 0; i <= steps; ++i) out.set(rgb(colour_at(i / steps)).map(linear), 3 * i);
  return out;
}

const contact_names = ["free", "slides", "sticks", "on cloth", "stopped"];
const contact_colours = ["#b9bec6", "#e69f00", "#0072b2", "#009e73", "#cc79a7"]; // of Okabe and Ito: told apart by everyone

export const modes = {
  plain: { label: "Plain" },
  strain: { label: "Strain", unit: "%", scale: 100, colour: (x) => interpolateRdBu(1 - x), diverging: true },
  speed: { label: "Speed", unit: "m/s", scale: 1, colour: interpolateViridis },
  contact: { label: "Contact", names: contact_names, colours: contact_colours },
};

// So that a few wild vertices do not take the whole scale: what 99.5 % of the values stay below, rounded up.
function top_of(shapes, field) {
  const sample = [];
  let least = 0, largest = 0;
  for (const shape of shapes) {
    if (!shape.has(field)) continue;
    const frames = shape.track.frames, own = shape.vertices / shape.sides;
    const stride = Math.max(1, Math.floor((frames * own) / 50000));
    for (let k = 0; k < frames * own; k += stride) {
      const value = shape.value(field, Math.floor(k / own), k % own);
      sample.push(Math.abs(value));
      least = Math.min(least, value), largest = Math.max(largest, value);
    }
  }
  sample.sort((a, b) => a - b);
  const top = sample.length ? sample[Math.floor(0.995 * (sample.length - 1))] : 0;
  if (!(top > 1e-9)) return { top: modes[field].scale === 100 ? 0.01 : 0.1, below: false, beyond: false };
  const unit = 10 ** Math.floor(Math.log10(top));
  const nice = [1, 1.5, 2, 3, 4, 5, 6, 8, 10].find((x) => x * unit >= top * 0.9999) * unit;
  return { top: nice, below: least < -nice * 1.0001, beyond: largest > nice * 1.0001 };
}

export class Colouring {
  #tables = {};
  #ranges = {};
  #values = new Float32Array(0);

  constructor(shapes) {
    this.cloths = shapes.filter((shape) => !shape.body);
    this.mode = "plain";
  }

  known(mode) {
    return mode === "plain" || this.cloths.some((shape) => shape.has(mode));
  }

  range(mode) {
    return (this.#ranges[mode] ??= top_of(this.cloths, mode));
  }

  // Colours of a cloth's vertices; false where it has its plain colour.
  paint(out, shape, frame) {
    if (this.mode === "plain" || !shape.has(this.mode)) return false;
    if (this.#values.length < shape.vertices) this.#values = new Float32Array(shape.vertices);
    const values = this.#values, { scale, offset, last, colours } = this.#lookup();
    shape.values_to(values, this.mode, frame);
    for (let i = 0; i < shape.vertices; ++i) {
      const at = 3 * Math.max(0, Math.min(last, Math.round(offset + scale * values[i])));
      out[3 * i] = colours[at], out[3 * i + 1] = colours[at + 1], out[3 * i + 2] = colours[at + 2];
    }
    return true;
  }

  #lookup() {
    const mode = modes[this.mode];
    if (mode.names) {
      const colours = (this.#tables[this.mode] ??= Float32Array.from(mode.colours.flatMap((c) => rgb(c).map(linear))));
      return { scale: 1, offset: 0, last: mode.names.length - 1, colours };
    }
    const colours = (this.#tables[this.mode] ??= table(mode.colour)), { top } = this.range(this.mode);
    if (mode.diverging) return { scale: steps / 2 / top, offset: steps / 2, last: steps, colours };
    return { scale: steps / top, offset: 0, last: steps, colours };
  }

  fill_legend(element) {
    const mode = modes[this.mode];
    element.replaceChildren();
    element.hidden = this.mode === "plain";
    if (element.hidden) return;
    const title = document.createElement("div");
    title.className = "legend-title";
    title.textContent = mode.unit ? `${mode.label} [${mode.unit}]` : mode.label;
    element.append(title, mode.names ? categories(mode) : this.#scale(mode));
  }

  #scale(mode) {
    const { top, below, beyond } = this.range(this.mode), low = mode.diverging ? -top : 0;
    const box = document.createElement("div"), bar = document.createElement("div"), ticks = document.createElement("div");
    bar.className = "legend-bar";
    const stops = Array.from({ length: 17 }, (_, i) => mode.colour(i / 16));
    bar.style.background = `linear-gradient(to right, ${stops.join(", ")})`;
    ticks.className = "legend-ticks";
    for (let i = 0; i <= 4; ++i) {
      const tick = document.createElement("span"), value = (low + ((top - low) * i) / 4) * mode.scale;
      tick.textContent = (i === 4 && beyond ? "≥ " : i === 0 && below ? "≤ " : "") + Number(value.toPrecision(3));
      ticks.append(tick);
    }
    box.append(bar, ticks);
    return box;
  }
}

function categories(mode) {
  const list = document.createElement("ul");
  list.className = "legend-list";
  mode.names.forEach((name, i) => {
    const item = document.createElement("li"), swatch = document.createElement("span");
    swatch.style.background = mode.colours[i];
    item.append(swatch, name);
    list.append(item);
  });
  return list;
}
