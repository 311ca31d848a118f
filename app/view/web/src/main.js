// The page of `drape view`: puts its parts together.
import { read_columns, read_head } from "./data.js";
import { Shape } from "./shape.js";
import { Colouring, modes } from "./colours.js";
import { Stage } from "./scene.js";
import { Picking } from "./picking.js";
import { Plots } from "./plots.js";
import { Transport, listen_to_keys } from "./controls.js";
import { VertexPanel, fill_banner, fill_run } from "./panel.js";

const get = (id) => document.getElementById(id);
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

function make_stage(shapes, planes, colouring) {
  try {
    return new Stage(get("canvas"), shapes, planes, colouring);
  } catch (error) {
    get("no-webgl").hidden = false;
    get("no-webgl").textContent = `The scene cannot be drawn: this browser gives no WebGL (${error.message}).`;
    return null;
  }
}

function make_plots(steps, seek) {
  if (!steps) return void (get("no-plots").hidden = false);
  return new Plots(get("plots"), read_columns(steps.block, steps.columns, steps.rows), seek);
}

function start() {
  const head = read_head(), { times } = head;
  fill_banner(head.missing);
  const shapes = head.shapes.map((shape) => new Shape(shape, times));
  const colouring = new Colouring(shapes);
  const stage = make_stage(shapes, head.planes, colouring);
  if (stage && head.planes.length > 0) head.notes.push(`A square of the grid is ${stage.grid_spacing} m wide.`);
  fill_run(head.facts, head.warnings, head.notes);

  const vertex = new VertexPanel(shapes, (picked) => (picking ? picking.take(picked) : chosen(picked)));
  const chosen = (picked) => {
    vertex.choose(picked);
    vertex.show(transport.frame);
  };
  const picking = stage && new Picking(stage, chosen);
  const plots = make_plots(head.steps, (time) => transport.seek_time(time));
  const digits = String(times.length - 1).length;
  const show = (frame) => {
    stage?.show(frame);
    picking?.follow();
    vertex.show(frame);
    plots?.show(times[frame]);
    get("frame").textContent = String(frame).padStart(digits, "\u2007") + " / " + (times.length - 1);
    get("time").textContent = times[frame].toFixed(3) + " s";
  };
  const transport = new Transport(times, show);

  const look = () => stage?.set_visible({ wireframe: get("wireframe").checked, bodies: get("bodies").checked });
  const colour_by = (mode) => {
    colouring.mode = mode;
    colouring.fill_legend(get("legend"));
    get("colour-" + mode).checked = true;
    stage?.show(transport.frame);
  };
  for (const mode of Object.keys(modes)) {
    const button = get("colour-" + mode);
    button.addEventListener("change", () => colour_by(mode));
    button.disabled = !colouring.known(mode);
    if (button.disabled) button.parentElement.title = "not recorded in this run";
  }
  for (const id of ["wireframe", "bodies"]) get(id).addEventListener("change", look);
  get("reset").addEventListener("click", () => stage?.reset_view());
  get("bodies").disabled = shapes.every((shape) => !shape.body) && head.planes.length === 0;

  const toggle = (id) => () => get(id).disabled || get(id).click();
  const next_colour = () => {
    const known = Object.keys(modes).filter((mode) => colouring.known(mode));
    colour_by(known[(known.indexOf(colouring.mode) + 1) % known.length]);
  };
  const speed = (by) => () => {
    const { options, selectedIndex } = get("speed");
    get("speed").selectedIndex = Math.max(0, Math.min(options.length - 1, selectedIndex + by));
  };
  listen_to_keys({
    " ": () => transport.play(!transport.playing), ArrowLeft: () => transport.step(-1), ArrowRight: () => transport.step(1),
    Home: () => transport.seek(0), End: () => transport.seek(times.length - 1), w: toggle("wireframe"), b: toggle("bodies"),
    l: toggle("loop"), c: next_colour, r: () => stage?.reset_view(), "+": speed(1), "-": speed(-1),
    Escape: () => get("vertex-clear").click(), "Shift+ArrowLeft": () => stage?.turn(-0.1, 0),
    "Shift+ArrowRight": () => stage?.turn(0.1, 0), "Shift+ArrowUp": () => stage?.turn(0, -0.1),
    "Shift+ArrowDown": () => stage?.turn(0, 0.1),
  });

  const theme = () => {
    stage?.set_theme({ background: css("--scene"), floor: css("--floor"), grid: css("--grid") });
    plots?.redraw();
  };
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", theme);
  theme();
  if (stage) {
    new ResizeObserver(() => stage.resize()).observe(get("canvas").parentElement);
    stage.resize();
    stage.reset_view();
  }
  colour_by("plain");
  transport.seek(0);
  look();
  const tick = (now) => {
    transport.tick(now);
    stage?.draw();
    requestAnimationFrame(tick);
  };
  requestAnimationFrame(tick);
  // For scripts and tests.
  window.drape = { head, shapes, stage, transport, picking, plots, colouring };
}

try {
  start();
} catch (error) {
  get("failed").hidden = false;
  get("failed").textContent = `This page cannot be shown: ${error.message}`;
  throw error;
}
