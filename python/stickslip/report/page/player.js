// Plays the frames: the whole run takes some seconds, times a speed.

const WHOLE_RUN = 8; // seconds of a run at speed 1

class Player {
  constructor(view) {
    this.view = view;
    this.times = view.result.times;
    this.playing = false;
    this.speed = 1;
    this.time = this.times[0];
    const slider = byId("frame");
    slider.max = this.times.length - 1;
    slider.addEventListener("input", () => this.go(Number(slider.value)));
    byId("play").addEventListener("click", () => this.toggle());
    byId("first").addEventListener("click", () => this.go(0));
    byId("back").addEventListener("click", () => this.step(-1));
    byId("forth").addEventListener("click", () => this.step(1));
    byId("last").addEventListener("click", () => this.go(this.times.length - 1));
    byId("speed").addEventListener("change", (event) => (this.speed = Number(event.target.value)));
    view.on((frame) => this.show(frame));
    if (this.times.length < 2) for (const id of ["play", "first", "back", "forth", "last", "frame", "speed"]) byId(id).disabled = true;
  }

  /** Shows a frame and stops there. */
  go(frame) {
    this.pause();
    this.view.setFrame(frame);
    this.time = this.times[this.view.frame];
  }

  step(by) {
    this.go(this.view.frame + by);
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  pause() {
    if (!this.playing) return;
    this.playing = false;
    this.button("Play", "play-icon");
  }

  play() {
    if (this.times.length < 2) return;
    if (this.view.frame === this.times.length - 1) {
      this.time = this.times[0];
      this.view.setFrame(0);
    }
    this.playing = true;
    this.button("Pause", "pause-icon");
    let before = null;
    const tick = (now) => {
      if (!this.playing) return;
      if (before !== null) this.advance((now - before) / 1000);
      before = now;
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  /** Time goes on by seconds of the clock. */
  advance(seconds) {
    const [start, end] = [this.times[0], this.times.at(-1)];
    this.time += (seconds * this.speed * (end - start)) / WHOLE_RUN;
    if (this.time >= end) {
      if (byId("loop").checked) this.time = start + ((this.time - start) % (end - start));
      else {
        this.view.setFrame(this.times.length - 1);
        this.pause();
        return;
      }
    }
    const frame = this.view.result.frameAt(this.time);
    if (frame !== this.view.frame) this.view.setFrame(frame);
  }

  button(label, icon) {
    byId("play").setAttribute("aria-label", label);
    byId("play").title = `${label} (space)`;
    byId("play").firstElementChild.firstElementChild.setAttribute("href", `#${icon}`);
  }

  show(frame) {
    const slider = byId("frame");
    slider.value = frame;
    slider.setAttribute("aria-valuetext", `time ${number(this.times[frame], 5)}`);
    byId("when").textContent = `t = ${number(this.times[frame], 5)}`;
    byId("count").textContent = `frame ${frame + 1} of ${this.times.length}`;
  }

  /** Frames per second when every frame is drawn as soon as it can be, over some seconds. */
  measure(seconds = 3) {
    return new Promise((resolve) => {
      let count = 0;
      const start = performance.now();
      const tick = () => {
        const now = performance.now();
        if (now - start >= 1000 * seconds) {
          resolve((1000 * count) / (now - start));
          return;
        }
        count++;
        this.view.setFrame((this.view.frame + 1) % this.times.length);
        requestAnimationFrame(tick);
      };
      requestAnimationFrame(tick);
    });
  }
}
