// A vertex taken by a click, or by its number, and what is known of it.
import { Raycaster, Vector2 } from "three";

const still = 5; // pixels: a pointer that went farther has turned the scene

export class Picking {
  constructor(stage, changed) {
    this.stage = stage;
    this.changed = changed;
    this.picked = null; // { shape, vertex }
    this.ray = new Raycaster();
    let down = null;
    stage.canvas.addEventListener("pointerdown", (event) => (down = event.isPrimary && event.button === 0 ? event : null));
    stage.canvas.addEventListener("pointerup", (event) => {
      if (down && Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY) < still) this.at(event.clientX, event.clientY);
      down = null;
    });
  }

  // The nearest corner of the face under the pointer; what hides it is taken instead.
  at(x, y) {
    const { canvas, camera, drawn } = this.stage, area = canvas.getBoundingClientRect();
    const place = new Vector2((2 * (x - area.left)) / area.width - 1, 1 - (2 * (y - area.top)) / area.height);
    camera.updateMatrixWorld();
    this.ray.setFromCamera(place, camera);
    const seen = drawn.filter(({ mesh }) => mesh.visible);
    const [hit] = this.ray.intersectObjects(seen.map(({ mesh }) => mesh), false);
    if (!hit) return this.take(null);
    const { shape, source, position } = seen.find(({ mesh }) => mesh === hit.object);
    const away = (i) => Math.hypot(...["x", "y", "z"].map((axis, c) => position.array[3 * i + c] - hit.point[axis]));
    const nearest = [hit.face.a, hit.face.b, hit.face.c].sort((a, b) => away(a) - away(b))[0];
    this.take({ shape, vertex: Math.floor((source ? source[nearest] : nearest) / shape.sides) });
  }

  take(picked) {
    this.picked = picked;
    this.follow();
    this.changed(picked);
  }

  follow() {
    const { picked, stage } = this;
    stage.mark(picked ? picked.shape.position(stage.frame, picked.vertex) : null);
  }
}
