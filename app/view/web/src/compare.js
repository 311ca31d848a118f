// The plots of compare.html: lines and markers over linear or logarithmic axes. The page holds what they show as JSON, in the element
// drape-plots: a list of { title, x_label, y_label, log_x, log_y, series }, one for each <figure> of .plots; of a series
//   name, x, y   points that the axes can show
//   line         whether they are joined, in their order
//   every        how many points there are to a marker; 0: none
//   dashed       a limit, not a measurement: in the colour of the text
//   look         which colour and which marker
// Every series has its own marker, too, so that the plots can be read without colours.
import uPlot from "uplot";
import { css, linear_range, whole_decades } from "./axes.js";
import { short } from "./words.js";

// Okabe and Ito's colours, those that can be seen on white and on black.
const colours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#999999"];
const font = "13px system-ui, sans-serif", height = 320;

const colour_of = (series) => (series.dashed ? css("--text") : colours[series.look % colours.length]);

// Circle, square, triangle, diamond, in turn; the corners as far from the middle as the last three say.
const corners = [null, [[-3.5, -3.5], [3.5, -3.5], [3.5, 3.5], [-3.5, 3.5]], [[0, -4.5], [4.5, 3.5], [-4.5, 3.5]], [[0, -5], [5, 0], [0, 5], [-5, 0]]];

// Lines and markers of a series through places on a canvas; `scale`: pixels of the canvas for one of the page.
function draw(context, series, places, scale) {
  context.save();
  context.strokeStyle = context.fillStyle = colour_of(series);
  context.lineWidth = 1.8 * scale;
  if (series.dashed) context.setLineDash([5 * scale, 4 * scale]);
  context.beginPath();
  if (series.line) for (const [x, y] of places) context.lineTo(x, y);
  context.stroke();
  const shape = corners[series.look % corners.length];
  for (let i = 0; series.every > 0 && i < places.length; i += series.every) {
    const [x, y] = places[i];
    context.beginPath();
    if (shape) for (const [right, down] of shape) context.lineTo(x + right * scale, y + down * scale);
    else context.arc(x, y, 3.5 * scale, 0, 2 * Math.PI);
    context.fill();
  }
  context.restore();
}

function draw_key(canvas, series) {
  const scale = devicePixelRatio, [width, height] = [28, 12];
  canvas.width = width * scale, canvas.height = height * scale;
  canvas.style.width = `${width}px`, canvas.style.height = `${height}px`;
  const places = [0, 0.5, 1].map((part) => [part * canvas.width, canvas.height / 2]);
  draw(canvas.getContext("2d"), { ...series, every: 0 }, places, scale);
  draw(canvas.getContext("2d"), { ...series, line: false }, [places[1]], scale);
}

// Over two decades the powers of ten, eight at most; over less twice and five times these, too.
function log_ticks(low, high) {
  const first = Math.floor(Math.log10(low) + 1e-9), last = Math.ceil(Math.log10(high) - 1e-9), ticks = [];
  const stride = Math.ceil((last - first) / 8) || 1, parts = last - first <= 2 ? [1, 2, 5] : [1];
  for (let k = first; k <= last; k += stride) for (const part of parts) ticks.push(Number(`${part}e${k}`));
  return ticks.filter((tick) => tick >= low * (1 - 1e-9) && tick <= high * (1 + 1e-9));
}

function axis(label, logarithmic, size) {
  const grid = { stroke: () => css("--line"), width: 1 };
  return {
    label, labelFont: font, font, size, labelSize: 20, gap: 4, stroke: () => css("--text"), grid, ticks: { show: false },
    border: { show: true, stroke: () => css("--faint"), width: 1 },
    values: (u, ticks) => ticks.map((tick) => (tick >= 1 && tick < 1e6 ? String(Number(tick.toPrecision(6))) : short(tick).replace(/\.0+e/, "e"))),
    ...(logarithmic ? { splits: (u, k, low, high) => log_ticks(low, high), filter: (u, ticks) => ticks } : {}),
  };
}

const scale_of = (logarithmic) => ({ time: false, ...(logarithmic ? { distr: 3, range: whole_decades } : { range: linear_range }) });

function options(plot, width) {
  const facets = [{ scale: "x", auto: true }, { scale: "y", auto: true }];
  const series = plot.series.map((one) => ({
    facets,
    paths: (u, k) => {
      const places = u.data[k][0].map((x, i) => [u.valToPos(x, "x", true), u.valToPos(u.data[k][1][i], "y", true)]);
      draw(u.ctx, one, places, devicePixelRatio);
      return null;
    },
  }));
  return {
    mode: 2, width, height, padding: [10, 28, 0, 0], legend: { show: false }, cursor: { show: false },
    scales: { x: scale_of(plot.log_x), y: scale_of(plot.log_y) },
    axes: [axis(plot.x_label, plot.log_x, 26), axis(plot.y_label, plot.log_y, 62)],
    series: [null, ...series],
  };
}

function show(figure, plot) {
  const keys = document.createElement("ul");
  const canvases = plot.series.map((series) => {
    const item = document.createElement("li"), canvas = document.createElement("canvas");
    item.append(canvas, series.name);
    keys.append(item);
    return canvas;
  });
  figure.querySelector("figcaption").append(keys);
  const width = () => Math.max(200, figure.clientWidth);
  const u = new uPlot(options(plot, width()), [null, ...plot.series.map(({ x, y }) => [x, y])], figure);
  u.root.setAttribute("role", "img");
  const names = plot.series.map(({ name }) => name).join(", ");
  u.root.setAttribute("aria-label", `${plot.title}: ${plot.y_label} against ${plot.x_label} of ${names}; the numbers stand in the tables`);
  const redraw = () => {
    canvases.forEach((canvas, k) => draw_key(canvas, plot.series[k]));
    u.redraw(false, true);
  };
  redraw();
  new ResizeObserver(() => u.width !== width() && u.setSize({ width: width(), height })).observe(figure);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  return u;
}

const plots = JSON.parse(document.getElementById("drape-plots").textContent);
const figures = document.querySelectorAll(".plots figure");
window.drape = { plots: plots.map((plot, k) => show(figures[k], plot)) };
