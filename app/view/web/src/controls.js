// Play, pause, scrub, step, speed, loop: the time that is shown. Frames count from 0 in here, from 1 for people.
const fallback_rate = 25; // 1/s, where the frames have no times

export class Transport {
  constructor(times, changed) {
    this.times = times;
    this.changed = changed;
    this.frame = 0;
    this.playing = false;
    this.play_button = document.getElementById("play");
    this.slider = document.getElementById("scrub");
    this.speed = document.getElementById("speed");
    this.loop = document.getElementById("loop");
    this.slider.max = times.length - 1;
    this.slider.addEventListener("input", () => this.seek(Number(this.slider.value)));
    this.play_button.addEventListener("click", () => this.play(!this.playing));
    document.getElementById("first").addEventListener("click", () => this.seek(0));
    document.getElementById("back").addEventListener("click", () => this.step(-1));
    document.getElementById("next").addEventListener("click", () => this.step(1));
    document.getElementById("last").addEventListener("click", () => this.seek(times.length - 1));
    if (times.length < 2) for (const control of document.querySelectorAll("#transport button, #scrub")) control.disabled = true;
  }

  play(on) {
    if (this.times.length < 2) return;
    this.playing = on;
    if (on && this.frame === this.times.length - 1) this.seek(0);
    this.#start();
    document.body.classList.toggle("playing", on);
    this.play_button.setAttribute("aria-label", on ? "Pause" : "Play");
  }

  // Real time is told by the frames' times, whatever the browser draws.
  #start() {
    this.clock = performance.now();
    this.time = this.times[this.frame];
  }

  step(by) {
    this.play(false);
    this.seek(this.frame + by);
  }

  seek(frame) {
    this.#show(Math.max(0, Math.min(this.times.length - 1, frame)));
    this.#start();
  }

  seek_time(time) {
    const next = this.#frame_at(time) + 1, { times } = this;
    this.seek(next < times.length && times[next] - time < time - times[next - 1] ? next : next - 1);
  }

  #show(frame) {
    this.frame = frame;
    this.slider.value = frame;
    this.slider.setAttribute("aria-valuetext", `frame ${frame + 1}, ${this.times[frame].toFixed(3)} s`);
    this.changed(frame);
  }

  #frame_at(time) {
    let low = 0, high = this.times.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.times[middle] <= time + 1e-9) low = middle + 1;
      else high = middle;
    }
    return Math.max(0, low - 1);
  }

  // Called whenever the browser draws.
  tick(now) {
    if (!this.playing) return;
    const { times } = this, last = times.length - 1;
    this.time += ((now - this.clock) / 1000) * Number(this.speed.value);
    this.clock = now;
    const frame_time = (times[last] - times[0]) / last || 1 / fallback_rate;
    if (this.time >= times[last] + frame_time) {
      if (!this.loop.checked) {
        this.#show(last);
        return this.play(false);
      }
      this.time = times[0] + ((this.time - times[last]) % frame_time);
    }
    const frame = this.#frame_at(this.time);
    if (frame !== this.frame) this.#show(frame);
  }
}

// Keys of the whole page; a control that has the focus keeps its own.
export function listen_to_keys(actions) {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { target } = event, kind = target.tagName === "INPUT" ? target.type : target.tagName;
    if (["SELECT", "number", "TEXTAREA"].includes(kind)) return;
    if (event.key === " " && ["BUTTON", "radio", "checkbox", "SUMMARY"].includes(kind)) return;
    if (event.key.startsWith("Arrow") && ["radio", "range"].includes(kind)) return;
    const action = actions[(event.shiftKey && event.key.startsWith("Arrow") ? "Shift+" : "") + event.key];
    if (!action) return;
    event.preventDefault();
    action();
  });
  // After a click the keys are the page's again.
  document.addEventListener("click", (event) => {
    if (event.detail > 0 && event.target.closest("button, label, input[type=radio], input[type=checkbox]")) document.activeElement?.blur();
  });
}
