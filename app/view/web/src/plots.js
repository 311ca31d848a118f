// What steps.csv says, over time: small plots whose line follows the frame that is shown; a click in one goes there.
import uPlot from "uplot";
import { css, decades, linear_range, whole_decades } from "./axes.js";
import { short } from "./words.js";

const plots = [
  { title: "Energy", unit: "J", series: { kinetic_energy: "kinetic", elastic_energy: "elastic", gravity_energy: "gravity" } },
  { title: "Iterations of the linear solver", series: { linear_iterations: "a step" } },
  { title: "Residual", series: { residual: "relative" }, log: true },
  { title: "Contacts", series: { contacts: "particles" } },
  { title: "Cloth on cloth", series: { self_contacts: "pairs", self_guarded: "pushed or stopped" }, where_any: true },
  { title: "Largest strain of an edge; of triangles", unit: "%", scale: 100, series: { max_edge_strain: "edge", strain_min: "least", strain_max: "largest" } },
  { title: "Time of a step", unit: "ms", series: { assemble_ms: "assemble", solve_ms: "solve", collide_ms: "collide", step_ms: "all" } },
];
const height = 108;

export class Plots {
  #all = [];

  constructor(element, columns, seek) {
    this.element = element;
    this.times = columns.get("time");
    for (const plot of plots) {
      const names = Object.keys(plot.series).filter((name) => columns.has(name));
      const rows = names.map((name) => Array.from(columns.get(name), (y) => shown(y, plot)));
      if (rows.some((row) => row.some((y) => (plot.where_any ? y > 0 : y !== null)))) this.#add(plot, names, rows, seek);
    }
    new ResizeObserver(() => this.#resize()).observe(element);
  }

  get count() {
    return this.#all.length;
  }

  #add(plot, names, rows, seek) {
    const figure = document.createElement("figure"), caption = document.createElement("figcaption");
    const title = document.createElement("strong");
    title.textContent = plot.title + (plot.unit ? ` [${plot.unit}]` : "");
    caption.append(title);
    const values = names.map((name, k) => {
      const key = document.createElement("span"), value = document.createElement("output");
      key.className = `key series-${k}`;
      key.append(plot.series[name] + " ", value);
      caption.append(key);
      return value;
    });
    figure.append(caption);
    this.element.append(figure);
    const u = new uPlot(options(plot, names, this.#width()), [this.times, ...rows], figure);
    const line = document.createElement("div");
    line.className = "now";
    u.over.append(line);
    u.over.addEventListener("click", (event) => seek(u.posToVal(event.offsetX, "x")));
    u.root.setAttribute("role", "img");
    u.root.setAttribute("aria-label", `${plot.title} over time`);
    this.#all.push({ u, line, values, rows });
  }

  #width() {
    return Math.max(200, this.element.clientWidth);
  }

  #resize() {
    for (const { u } of this.#all) if (u.width !== this.#width()) u.setSize({ width: this.#width(), height });
    if (this.time !== undefined) this.show(this.time);
  }

  show(time) {
    this.time = time;
    const row = this.#row(time);
    for (const { u, line, values, rows } of this.#all) {
      line.style.transform = `translateX(${u.valToPos(time, "x")}px)`;
      values.forEach((value, k) => (value.textContent = row < 0 || rows[k][row] === null ? "–" : short(rows[k][row])));
    }
  }

  // The last step that had ended by then.
  #row(time) {
    let low = 0, high = this.times.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.times[middle] <= time + 1e-6 * Math.abs(time)) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }

  redraw() {
    for (const { u } of this.#all) u.redraw(false);
  }
}

function shown(y, plot) {
  return !Number.isFinite(y) || (plot.log && y <= 0) ? null : y * (plot.scale ?? 1);
}

function options(plot, names, width) {
  const axis = {
    stroke: () => css("--faint"),
    grid: { stroke: () => css("--line"), width: 1 },
    ticks: { show: false },
    font: "11px system-ui, sans-serif",
  };
  return {
    width,
    height,
    padding: [6, 16, 0, 0],
    legend: { show: false },
    cursor: { y: false, points: { show: false }, drag: { x: false, y: false } },
    scales: { x: { time: false }, y: plot.log ? { distr: 3, range: whole_decades } : { range: linear_range } },
    axes: [
      { ...axis, size: 22, gap: 3, space: 60, values: (u, ticks) => ticks.map((x) => short(x) + " s") },
      { ...axis, size: 50, gap: 4, space: 24, ...(plot.log ? { splits: decades } : {}), values: (u, ticks) => ticks.map((y) => (y === null ? "" : plot.log ? `1e${Math.round(Math.log10(y))}` : short(y))) },
    ],
    series: [{}, ...names.map((name, k) => ({ stroke: () => css(`--series-${k}`), width: 1.5, points: { show: false } }))],
  };
}
