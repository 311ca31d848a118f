// Where drawing is slow, as without a graphics card, fewer pixels are drawn while it plays: 30 frames/s matter more then.
const wanted = 36, least = 0.5; // ms from one frame to the next; part of the pixels of a side

export class Pace {
  constructor(stage) {
    this.stage = stage;
    this.scale = 1; // while it plays; it does not rise again, or the picture would flicker
    this.mean = 0;
    this.last = 0;
  }

  tick(now, playing) {
    const took = now - this.last;
    this.last = now;
    if (playing && took < 500) {
      this.mean += 0.2 * (took - this.mean);
      if (this.mean > wanted && this.scale > least) {
        this.scale = Math.max(least, 0.8 * this.scale);
        this.mean = 0.8 * wanted;
      }
    }
    this.stage.set_scale(playing ? this.scale : 1);
  }
}
