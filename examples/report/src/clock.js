// SPDX-License-Identifier: MIT

/** Which frame is shown. Runs at the pace of the motion; poses that are no motion follow each other at a pace to look at. */
export class Clock {
  /** `places`: times [s] of the frames, or what stands for them, ascending; `isMotion`: whether they are moments of a motion. */
  constructor(places, isMotion, first) {
    this.places = places;
    const pace = Math.min(Math.max(6 / places.length, 0.12), 1.1);
    this.times = isMotion ? places : places.map((_, frame) => pace * frame);
    this.frame = Math.min(Math.max(first, 0), places.length - 1);
    this.isPlaying = false;
    this.speed = 1;
    this.listeners = [];
    this.time = this.times[this.frame];
  }

  get count() {
    return this.places.length;
  }

  listen(listener) {
    this.listeners.push(listener);
  }

  tell() {
    this.listeners.forEach((listener) => listener(this));
  }

  show(frame) {
    this.frame = Math.min(Math.max(Math.round(frame), 0), this.count - 1);
    this.time = this.times[this.frame];
    this.tell();
  }

  /** From the last frame on to the first, and back. */
  step(count) {
    this.pause();
    this.show((this.frame + count + this.count) % this.count);
  }

  play() {
    if (this.isPlaying || this.count < 2) {
      return;
    }
    this.isPlaying = true;
    if (this.frame === this.count - 1) {
      this.show(0);
    }
    let last = performance.now();
    const advance = (now) => {
      if (!this.isPlaying) {
        return;
      }
      this.time += (Math.min(now - last, 100) / 1000) * this.speed;
      last = now;
      const end = this.times[this.count - 1];
      const gap = (end - this.times[0]) / (this.count - 1);
      if (this.time >= end + gap) {
        this.time = this.times[0];
      }
      let frame = this.time < this.times[this.frame] ? 0 : this.frame;
      while (frame + 1 < this.count && this.times[frame + 1] <= this.time) {
        ++frame;
      }
      if (frame !== this.frame) {
        this.frame = frame;
        this.tell();
      }
      requestAnimationFrame(advance);
    };
    requestAnimationFrame(advance);
    this.tell();
  }

  pause() {
    this.isPlaying = false;
    this.time = this.times[this.frame];
    this.tell();
  }

  toggle() {
    if (this.isPlaying) {
      this.pause();
    } else {
      this.play();
    }
  }
}
