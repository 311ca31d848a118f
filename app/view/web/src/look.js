// How the scene looks: colouring, wireframe, bodies, light or dark.
import { modes } from "./colours.js";

const get = (id) => document.getElementById(id);
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

// Without a stage nothing is drawn, and the controls do nothing.
export class Look {
  constructor(stage, colouring, has_bodies) {
    this.stage = stage;
    this.colouring = colouring;
    for (const mode of Object.keys(modes)) {
      const button = get("colour-" + mode);
      button.addEventListener("change", () => this.colour_by(mode));
      button.disabled = !colouring.known(mode);
      if (button.disabled) button.parentElement.title = "not recorded in this run";
    }
    for (const id of ["wireframe", "bodies"]) get(id).addEventListener("change", () => this.show());
    get("reset").addEventListener("click", () => stage?.reset_view());
    get("bodies").disabled = !has_bodies;
  }

  show() {
    this.stage?.set_visible({ wireframe: get("wireframe").checked, bodies: get("bodies").checked });
  }

  colour_by(mode) {
    this.colouring.mode = mode;
    this.colouring.fill_legend(get("legend"));
    get("colour-" + mode).checked = true;
    this.stage?.show(this.stage.frame);
  }

  next_colour() {
    const known = Object.keys(modes).filter((mode) => this.colouring.known(mode));
    this.colour_by(known[(known.indexOf(this.colouring.mode) + 1) % known.length]);
  }

  // As the system is, and again when it changes.
  follow_theme(changed) {
    const theme = () => {
      this.stage?.set_theme({ background: css("--scene"), floor: css("--floor"), grid: css("--grid") });
      changed();
    };
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", theme);
    theme();
  }
}
