// The page of `drape view`: puts its parts together.
import { read_columns, read_head } from "./data.js";
import { Shape } from "./shape.js";
import { Colouring } from "./colours.js";
import { Stage } from "./scene.js";
import { Look } from "./look.js";
import { Picking } from "./picking.js";
import { Plots } from "./plots.js";
import { Transport, listen_to_keys } from "./controls.js";
import { Pace } from "./pace.js";
import { VertexPanel, fill_banner, fill_run } from "./panel.js";

const get = (id) => document.getElementById(id);

function make_stage(shapes, planes, colouring) {
  try {
    const stage = new Stage(get("canvas"), shapes, planes, colouring);
    new ResizeObserver(() => stage.resize()).observe(get("canvas").parentElement);
    stage.resize();
    stage.reset_view();
    return stage;
  } catch (error) {
    get("no-webgl").hidden = false;
    get("no-webgl").textContent = `The scene cannot be drawn: this browser gives no WebGL (${error.message}).`;
    return null;
  }
}

function make_plots(steps, seek) {
  if (steps) return new Plots(get("plots"), read_columns(steps.block, steps.columns, steps.rows), seek);
  get("no-plots").hidden = false;
  return null;
}

function clock(times) {
  const count = times.length, digits = String(count).length;
  return (frame) => {
    get("frame").textContent = `${String(frame + 1).padStart(digits, "\u2007")} / ${count}`;
    get("time").textContent = times[frame].toFixed(3) + " s";
  };
}

function connect_keys(transport, look, stage) {
  const toggle = (id) => () => get(id).disabled || get(id).click();
  const pace = (by) => () => {
    const { options, selectedIndex } = get("speed");
    get("speed").selectedIndex = Math.max(0, Math.min(options.length - 1, selectedIndex + by));
  };
  const turn = (azimuth, polar) => () => stage?.turn(azimuth, polar);
  listen_to_keys({
    " ": () => transport.play(!transport.playing),
    ArrowLeft: () => transport.step(-1),
    ArrowRight: () => transport.step(1),
    Home: () => transport.seek(0),
    End: () => transport.seek(transport.times.length - 1),
    "+": pace(1),
    "-": pace(-1),
    w: toggle("wireframe"),
    b: toggle("bodies"),
    l: toggle("loop"),
    c: () => look.next_colour(),
    r: () => stage?.reset_view(),
    Escape: () => get("vertex-clear").click(),
    "Shift+ArrowLeft": turn(-0.1, 0),
    "Shift+ArrowRight": turn(0.1, 0),
    "Shift+ArrowUp": turn(0, -0.1),
    "Shift+ArrowDown": turn(0, 0.1),
  });
}

// What draws when the browser wants to.
function run(transport, stage) {
  const pace = stage && new Pace(stage);
  const tick = (now) => {
    transport.tick(now);
    pace?.tick(now, transport.playing);
    stage?.draw();
    requestAnimationFrame(tick);
  };
  requestAnimationFrame(tick);
}

function start() {
  const head = read_head(), { times, planes } = head;
  fill_banner(head.missing);
  const shapes = head.shapes.map((shape) => new Shape(shape, times));
  const colouring = new Colouring(shapes), stage = make_stage(shapes, planes, colouring);
  if (stage && planes.length > 0) head.notes.push(`A square of the grid is ${stage.grid_spacing} m wide.`);
  fill_run(head.facts, head.warnings, head.notes);

  const vertex = new VertexPanel(shapes, (picked) => (picking ? picking.take(picked) : chosen(picked)));
  const chosen = (picked) => {
    vertex.choose(picked);
    vertex.show(transport.frame);
  };
  const picking = stage && new Picking(stage, chosen);
  const plots = make_plots(head.steps, (time) => transport.seek_time(time)), show_clock = clock(times);
  const transport = new Transport(times, (frame) => {
    stage?.show(frame);
    picking?.follow();
    vertex.show(frame);
    plots?.show(times[frame]);
    show_clock(frame);
  });
  const look = new Look(stage, colouring, planes.length > 0 || shapes.some((shape) => shape.body));
  look.follow_theme(() => plots?.redraw());
  transport.seek(0);
  look.colour_by("plain");
  look.show();
  connect_keys(transport, look, stage);
  run(transport, stage);
  window.drape = { head, shapes, stage, transport, picking, plots, colouring }; // for scripts and tests
}

try {
  start();
} catch (error) {
  get("failed").hidden = false;
  get("failed").textContent = `This page cannot be shown: ${error.message}`;
  throw error;
}
