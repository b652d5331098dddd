// The mouse in the view: wheel zooms, dragging moves, dragging with Shift draws a window, a click chooses a node. A cross
// that the keys move does the same.

class Mouse {
  constructor(view, onNode) {
    this.view = view;
    this.onNode = onNode;
    this.tip = byId("tip");
    const target = view.overlay;
    target.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    target.addEventListener("pointerdown", (event) => this.down(event));
    target.addEventListener("pointermove", (event) => this.move(event));
    target.addEventListener("pointerup", (event) => this.up(event));
    target.addEventListener("pointerleave", () => this.hide());
    target.addEventListener("dblclick", () => view.fit());
    view.on(() => this.last && this.show());
  }

  wheel(event) {
    event.preventDefault();
    this.view.zoom(Math.exp(-0.0015 * event.deltaY), event.offsetX, event.offsetY);
  }

  down(event) {
    this.view.overlay.setPointerCapture(event.pointerId);
    this.start = [event.offsetX, event.offsetY];
    this.before = this.start;
    this.drawing = event.shiftKey || this.windowed;
    this.moved = false;
    this.hide();
  }

  move(event) {
    const { view } = this;
    const spot = [event.offsetX, event.offsetY];
    if (!this.start) {
      this.last = spot;
      this.show();
      return;
    }
    this.moved ||= Math.hypot(spot[0] - this.start[0], spot[1] - this.start[1]) > 4;
    if (!this.moved) return;
    if (this.drawing) {
      view.window = [...this.start, ...spot];
      view.refresh();
    } else {
      view.pan(spot[0] - this.before[0], spot[1] - this.before[1]);
      this.before = spot;
    }
  }

  up(event) {
    const { view } = this;
    if (!this.start) return;
    if (!this.moved) {
      const node = view.nodeAt(event.offsetX, event.offsetY, 16);
      if (node >= 0) this.onNode(node);
    } else if (this.drawing && view.window) {
      const [x0, y0, x1, y1] = view.window;
      if (Math.abs(x1 - x0) > 4 && Math.abs(y1 - y0) > 4) {
        const factor = Math.min(view.camera.width / Math.abs(x1 - x0), view.camera.height / Math.abs(y1 - y0));
        const [mx, my] = [0.5 * (x0 + x1), 0.5 * (y0 + y1)];
        view.pan(view.camera.width / 2 - mx, view.camera.height / 2 - my);
        view.zoom(factor);
      }
      view.window = null;
      this.setWindowed(false);
      view.refresh();
    }
    this.start = null;
  }

  /** Whether the next dragging draws a window. */
  setWindowed(windowed) {
    this.windowed = windowed;
    byId("window").setAttribute("aria-pressed", windowed);
    this.view.overlay.style.cursor = windowed ? "crosshair" : "";
  }

  /** Shows or hides the cross in the middle of the picture. */
  toggleCross() {
    const { view } = this;
    view.cross = view.cross ? null : [view.camera.width / 2, view.camera.height / 2];
    this.followCross();
  }

  /** Moves the cross by pixels; the picture moves where the cross is at its edge. */
  moveCross(dx, dy) {
    const { view } = this;
    const { width, height } = view.camera;
    const [x, y] = [view.cross[0] + dx, view.cross[1] + dy];
    view.cross = [Math.min(Math.max(x, 20), width - 20), Math.min(Math.max(y, 20), height - 20)];
    if (x !== view.cross[0] || y !== view.cross[1]) view.pan(view.cross[0] - x, view.cross[1] - y);
    this.followCross();
  }

  /** Chooses the node at the cross. */
  pickAtCross() {
    const node = this.view.nodeAt(...this.view.cross, 16);
    if (node >= 0) this.onNode(node);
  }

  followCross() {
    const { view } = this;
    view.draw();
    this.last = view.cross;
    if (view.cross) this.show();
    else this.hide();
  }

  hide() {
    this.last = null;
    this.tip.hidden = true;
  }

  /** Values under the mouse. */
  show() {
    const { view, tip } = this;
    if (!view.seen) return;
    const [x, y] = this.last;
    const lines = view.about(x, y);
    tip.hidden = lines.length === 0;
    if (tip.hidden) return;
    tip.replaceChildren(...lines.flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)]));
    const left = x + 18 + tip.offsetWidth > view.camera.width ? x - 14 - tip.offsetWidth : x + 18;
    const top = Math.min(y + 14, view.camera.height - tip.offsetHeight - 6);
    tip.style.transform = `translate(${Math.max(left, 4)}px, ${Math.max(top, 4)}px)`;
  }
}
