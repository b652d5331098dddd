// Marks over the bodies: contact states, pressure, arrows, chosen nodes, time and the scale of the colours.

const PRESSURE_HEIGHT = 56; // pixels of the usual largest pressure
const ARROW_LENGTH = 64; // pixels of the usual largest vector

class Marks {
  constructor(view, context) {
    this.view = view;
    this.context = context;
    this.context.font = "12px system-ui, sans-serif";
  }

  inside([x, y], room = 20) {
    const { width, height } = this.view.seen;
    return x > -room && y > -room && x < width + room && y < height + room;
  }

  /** Slave nodes in contact: filled where they stick, hollow where they slide. */
  states() {
    const { view, context } = this;
    const status = view.result.field("CONTACT_STATUS");
    if (!status) return;
    const size = Math.min(5, Math.max(2.2, 0.22 * view.edge * view.seen.scale));
    const colours = { 2: styleColour("stick"), 3: styleColour("slip") };
    context.lineWidth = 1.8;
    for (const node of status.onlyPlaces ?? view.deformable) {
      const state = status.value(view.frame, node);
      if (state < 2) continue;
      const spot = view.spot(node);
      if (!this.inside(spot)) continue;
      context.beginPath();
      context.arc(...spot, size, 0, 2 * Math.PI);
      context.fillStyle = state === 2 ? colours[2] : styleColour("ground");
      context.strokeStyle = colours[state];
      context.fill();
      context.stroke();
    }
  }

  /** A field at nodes at a vertex, 0 where it has no value. */
  atVertex(field, vertex) {
    const { nodes, after } = this.view.result.mesh;
    if (vertex < nodes) return field.value(this.view.frame, vertex) || 0;
    const i = 3 * (vertex - nodes);
    return 0.5 * (this.atVertex(field, after[i]) + this.atVertex(field, after[i + 1]));
  }

  /** Contact pressure as a height over the surface. */
  pressure() {
    const { view, context } = this;
    const field = view.result.field("CONTACT_PRESSURE");
    if (!field) return;
    const largest = view.result.scalar("CONTACT_PRESSURE").range(view.result.frames).high;
    if (!(largest > 0)) return;
    context.fillStyle = styleColour("pressure-fill");
    context.strokeStyle = styleColour("pressure");
    context.lineWidth = 1.2;
    const { outline } = view.result.mesh;
    for (let i = 0; i < outline.length; i += 2) {
      const ends = [outline[i], outline[i + 1]];
      const heights = ends.map((vertex) => Math.max(0, this.atVertex(field, vertex)) / largest);
      if (!(heights[0] > 0) && !(heights[1] > 0)) continue;
      const [a, b] = ends.map((node) => view.spot(node));
      const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
      if (!this.inside(a, 80 + length) || length === 0) continue;
      // the body lies on the left of the edge; upwards is negative in the picture
      const out = [-(b[1] - a[1]) / length, (b[0] - a[0]) / length];
      const tops = [a, b].map((spot, k) => spot.map((each, axis) => each + out[axis] * PRESSURE_HEIGHT * heights[k]));
      context.beginPath();
      context.moveTo(...a);
      context.lineTo(...tops[0]);
      context.lineTo(...tops[1]);
      context.lineTo(...b);
      context.fill();
      context.beginPath();
      context.moveTo(...tops[0]);
      context.lineTo(...tops[1]);
      context.stroke();
    }
  }

  /** A vector field at the nodes. */
  arrows() {
    const { view, context } = this;
    const { result, look, frame } = view;
    const field = result.field(look.vectors);
    const scalar = result.scalar(`${look.vectors}:magnitude`);
    if (!field?.data || !scalar) return;
    const largest = scalar.range(result.frames).high;
    if (!(largest > 0)) return;
    const contact = look.vectors === "CONTACT_FORCE";
    const bodies = new Set(view.deformable);
    const nodes = (field.onlyPlaces ?? view.deformable).filter((node) => !contact || bodies.has(node));
    const every = field.onlyPlaces && nodes.length < 4000 ? 1 : Math.ceil(nodes.length / MOST_ARROWS);
    const long = (ARROW_LENGTH * look.vectorScale) / largest;
    context.strokeStyle = context.fillStyle = styleColour("arrow");
    for (let i = 0; i < nodes.length; i += every) {
      const [x, y] = [field.value(frame, nodes[i], 0), field.value(frame, nodes[i], 1)];
      const spot = view.spot(nodes[i]);
      if ((x || y) && this.inside(spot, 100)) this.arrow(spot, x * long, -y * long);
    }
    if (contact) for (const [spot, x, y] of this.onRigid(field)) this.arrow(spot, x * long, -y * long);
    this.arrow([16, view.seen.height - 18], ARROW_LENGTH * look.vectorScale, 0);
    this.text(`${field.words} ${number(largest, 3)}`, 16, view.seen.height - 28);
  }

  /** Forces on rigid lines [place, x, y] where the contact is: against each node that is pressed by a segment near it.
   *
   * The file holds them at the ends of the segments, which may be far away. */
  onRigid(field) {
    const { view } = this;
    const { mesh } = view.result;
    const { positions } = view.layer;
    const forceOf = (node) => [0, 1].map((k) => field.value(view.frame, node, k) || 0);
    const at = (node) => [positions[2 * node], positions[2 * node + 1]];
    const pressed = [];
    for (let i = 0; i < mesh.rigid.length; i += 2) {
      const ends = [mesh.rigid[i], mesh.rigid[i + 1]];
      if (ends.some((node) => forceOf(node).some(Boolean))) pressed.push(ends.map(at));
    }
    const found = [];
    if (pressed.length === 0) return found;
    for (const node of view.deformable) {
      const [x, y] = forceOf(node);
      if (!x && !y) continue;
      const [px, py] = at(node);
      let [best, least] = [null, 0.5 * view.edge];
      for (const [[ax, ay], [bx, by]] of pressed) {
        const [dx, dy] = [bx - ax, by - ay];
        const part = Math.min(1, Math.max(0, ((px - ax) * dx + (py - ay) * dy) / (dx * dx + dy * dy)));
        const foot = [ax + part * dx, ay + part * dy];
        const distance = Math.hypot(px - foot[0], py - foot[1]);
        if (distance < least) [best, least] = [foot, distance];
      }
      if (best) found.push([view.spotOf(...best), -x, -y]);
    }
    return found;
  }

  /** Marks of the smallest and the largest value of the frame. */
  extremes() {
    const { view, context } = this;
    const { look, layer, frame, result } = view;
    const { scalar } = look;
    const ofElements = scalar.at === "elements";
    const places = ofElements ? layer.ofElements.length : scalar.field.places;
    const values = ofElements ? layer.ofElements : layer.values;
    let [least, most] = [-1, -1];
    for (let i = 0; i < places; i++) {
      if (!(values[i] < 1e38)) continue;
      if (least < 0 || values[i] < values[least]) least = i;
      if (most < 0 || values[i] > values[most]) most = i;
    }
    if (most < 0 || !(values[most] > values[least])) return;
    for (const [place, down] of [[most, false], [least, true]]) {
      const [x, y] = ofElements ? view.middle(place) : view.spot(place);
      if (!this.inside([x, y], 0)) continue;
      const way = down ? -1 : 1;
      context.beginPath();
      context.moveTo(x, y);
      context.lineTo(x - 5, y - way * 10);
      context.lineTo(x + 5, y - way * 10);
      context.closePath();
      context.fillStyle = styleColour("ink");
      context.strokeStyle = styleColour("ground");
      context.lineWidth = 1.5;
      context.stroke();
      context.fill();
      const name = down ? "smallest" : "largest";
      const right = x > view.seen.width - 240;
      this.text(`${name} ${number(scalar.value(frame, place))}`, x + (right ? -9 : 9), y - way * 6 + 4, right ? "right" : "left");
    }
  }

  /** The cross that the keys move. */
  cross([x, y]) {
    const { context } = this;
    for (const [width, colour] of [[3, "ground"], [1.2, "accent"]]) {
      context.lineWidth = width;
      context.strokeStyle = styleColour(colour);
      context.beginPath();
      for (const way of [-1, 1]) {
        context.moveTo(x + 4 * way, y);
        context.lineTo(x + 14 * way, y);
        context.moveTo(x, y + 4 * way);
        context.lineTo(x, y + 14 * way);
      }
      context.stroke();
    }
  }

  arrow([x, y], dx, dy) {
    const { context } = this;
    const length = Math.hypot(dx, dy);
    if (length < 1.5) return;
    const head = Math.min(8, 0.4 * length);
    const [ux, uy] = [dx / length, dy / length];
    const [tx, ty] = [x + dx, y + dy];
    context.lineWidth = 1.6;
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(tx - 0.8 * head * ux, ty - 0.8 * head * uy);
    context.stroke();
    context.beginPath();
    context.moveTo(tx, ty);
    context.lineTo(tx - head * ux - 0.42 * head * uy, ty - head * uy + 0.42 * head * ux);
    context.lineTo(tx - head * ux + 0.42 * head * uy, ty - head * uy - 0.42 * head * ux);
    context.fill();
  }

  text(text, x, y, align = "left", colour = styleColour("ink")) {
    const { context } = this;
    context.textAlign = align;
    context.lineWidth = 3;
    context.strokeStyle = styleColour("ground");
    context.strokeText(text, x, y);
    context.fillStyle = colour;
    context.fillText(text, x, y);
  }

  /** Chosen nodes with their numbers, in the colours of their curves. */
  picked() {
    const { view, context } = this;
    view.picked.forEach((node, i) => {
      const [x, y] = view.spot(node);
      context.beginPath();
      context.arc(x, y, 6, 0, 2 * Math.PI);
      context.lineWidth = 2.5;
      context.strokeStyle = CURVES[i % CURVES.length];
      context.stroke();
      this.text(String(view.result.mesh.nodeLabels[node]), x + 9, y - 7, "left", CURVES[i % CURVES.length]);
    });
  }

  time() {
    const { view } = this;
    this.context.font = "600 13px system-ui, sans-serif";
    this.text(`t = ${number(view.result.times[view.frame], 5)}`, 16, 26);
    this.context.font = "12px system-ui, sans-serif";
    if (view.look.scale !== 1) this.text(`displacements × ${number(view.look.scale)}`, 16, 44);
  }

  /** The scale of the colours, with what lies beyond its ends. */
  scale(ends) {
    const { view, context } = this;
    const { scalar } = view.look;
    const { bands } = view.look;
    const table = colourTable(view.mapShown, bands);
    const ticks = bands ? bands / Math.ceil(bands / 8) : 4;
    const height = Math.min(240, view.seen.height - 120);
    const [x, top, width] = [view.seen.width - 84, 56, 14];
    const ink = styleColour("ink");
    // rigid lines reach to the border of the picture
    context.globalAlpha = 0.8;
    context.fillStyle = styleColour("ground");
    context.fillRect(x - 6, top - 12, view.seen.width - x + 6, height + 24);
    context.globalAlpha = 1;
    for (let i = 0; i < height; i++) {
      const at = 4 * Math.round((1 - i / (height - 1)) * 255);
      context.fillStyle = `rgb(${table[at]} ${table[at + 1]} ${table[at + 2]})`;
      context.fillRect(x, top + i, width, 1.5);
    }
    const point = (base, tip, at) => {
      context.beginPath();
      context.moveTo(x, base);
      context.lineTo(x + width, base);
      context.lineTo(x + width / 2, tip);
      context.fillStyle = `rgb(${table[at]} ${table[at + 1]} ${table[at + 2]})`;
      context.fill();
    };
    if (ends.most > ends.high * (1 + 1e-6)) point(top, top - 10, 1020);
    if (ends.least < ends.low * (1 + 1e-6) && ends.least < ends.low) point(top + height, top + height + 10, 0);
    for (let tick = 0; tick <= ticks; tick++) {
      const y = top + height * (1 - tick / ticks);
      context.fillStyle = ink;
      context.fillRect(x + width, y - 0.5, 4, 1);
      const value = ends.low + (tick / ticks) * (ends.high - ends.low);
      this.text(number(Math.abs(value) < 1e-12 * (ends.high - ends.low) ? 0 : value, 3), x + width + 7, y + 4);
    }
    const right = view.seen.width - 12;
    this.text(scalar.label, right, 22, "right");
    const dimension = dimensionText(scalar.field.dimension);
    if (dimension) this.text(dimension, right, 38, "right", styleColour("muted"));
    const beyond = [];
    if (ends.most > ends.high * (1 + 1e-6)) beyond.push(`largest ${number(ends.most, 3)} at t = ${number(view.result.times[ends.mostFrame], 3)}`);
    if (ends.least < ends.low && ends.least < 0) beyond.push(`smallest ${number(ends.least, 3)} at t = ${number(view.result.times[ends.leastFrame], 3)}`);
    beyond.forEach((line, i) => this.text(line, right, top + height + 28 + 16 * i, "right", styleColour("muted")));
  }

  /** The window that is being drawn with the mouse. */
  window([x0, y0, x1, y1]) {
    const { context } = this;
    context.lineWidth = 1;
    context.strokeStyle = styleColour("accent");
    context.setLineDash([5, 4]);
    context.strokeRect(Math.min(x0, x1), Math.min(y0, y1), Math.abs(x1 - x0), Math.abs(y1 - y0));
    context.setLineDash([]);
  }
}
