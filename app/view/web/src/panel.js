// What stands beside the scene: what is missing, the run in a table, the vertex that was picked.
import { fixed, short } from "./words.js";
import { modes } from "./colours.js";

export function fill_banner(missing) {
  const banner = document.getElementById("banner");
  banner.hidden = missing.length === 0;
  fill_list(document.getElementById("missing"), missing);
}

function fill_list(list, lines) {
  list.replaceChildren(...lines.map((line) => Object.assign(document.createElement("li"), { textContent: line })));
}

export function fill_run(facts, warnings, notes) {
  const rows = facts.map(([name, value]) => {
    const row = document.createElement("tr"), head = document.createElement("th"), cell = document.createElement("td");
    head.scope = "row";
    head.textContent = name;
    cell.textContent = value;
    row.append(head, cell);
    return row;
  });
  document.getElementById("facts").replaceChildren(...rows);
  document.getElementById("warnings-title").hidden = warnings.length === 0;
  fill_list(document.getElementById("warnings"), warnings);
  fill_list(document.getElementById("notes"), notes);
}

export class VertexPanel {
  constructor(shapes, take) {
    this.shapes = shapes;
    this.name = document.getElementById("vertex-shape");
    this.number = document.getElementById("vertex-number");
    this.values = document.getElementById("vertex-values");
    this.hint = document.getElementById("vertex-hint");
    this.clear = document.getElementById("vertex-clear");
    this.name.append(...shapes.map((shape, k) => new Option(shape.name + (shape.body ? " (body)" : ""), k)));
    const chosen = () => {
      const shape = shapes[this.name.value], vertex = Number(this.number.value);
      if (this.number.value !== "" && Number.isInteger(vertex) && vertex >= 0 && vertex < shape.vertices / shape.sides) take({ shape, vertex });
      else take(null);
    };
    this.name.addEventListener("change", chosen);
    this.number.addEventListener("change", chosen);
    this.clear.addEventListener("click", () => take(null));
  }

  choose(picked) {
    this.picked = picked;
    this.hint.hidden = picked !== null;
    this.values.hidden = this.clear.hidden = picked === null;
    if (!picked) return void (this.number.value = "");
    this.name.value = this.shapes.indexOf(picked.shape);
    this.number.max = picked.shape.vertices / picked.shape.sides - 1;
    this.number.value = picked.vertex;
  }

  show(frame) {
    if (!this.picked) return;
    const { shape, vertex } = this.picked, step = Math.max(...shape.track.step);
    const position = shape.position(frame, vertex).map((x) => fixed(x, step)).join(", ");
    const rows = [["position [m]", position]];
    if (!shape.body) {
      const speed = shape.value("speed", frame, vertex), strain = shape.value("strain", frame, vertex);
      const contact = shape.value("contact", frame, vertex);
      rows.push(["speed [m/s]", speed === null ? "not recorded" : short(speed)]);
      rows.push(["strain [%]", strain === null ? "not recorded" : short(100 * strain)]);
      rows.push(["contact", contact === null ? "not recorded" : modes.contact.names[Math.round(contact)]]);
    }
    if (this.values.children.length !== 2 * rows.length)
      this.values.replaceChildren(...rows.flatMap(() => [document.createElement("dt"), document.createElement("dd")]));
    rows.forEach(([name, value], k) => {
      this.values.children[2 * k].textContent = name;
      this.values.children[2 * k + 1].textContent = value;
    });
  }
}
