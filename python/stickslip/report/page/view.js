// The view: what is drawn of a frame, seen by a camera that the mouse moves.

const STATES = ["none", "open", "stick", "slip"];
const LINES_FROM = 4; // mesh lines are drawn where an edge is so many pixels long
const MOST_ARROWS = 700;

class View {
  constructor(result, other, frameElement) {
    this.result = result;
    this.other = other;
    this.element = frameElement;
    this.overlay = byId("overlay");
    this.look = {
      scalar: null, // a Scalar, "bodies" or null
      range: "usual",
      low: 0,
      high: 1,
      map: "auto",
      scale: 1,
      lines: true,
      states: true,
      vectors: "",
      vectorScale: 1,
      pressure: false,
      other: true,
      undeformed: false,
      bands: 12, // of equal colour; 0 for none
      extremes: true,
      follow: -1,
    };
    this.frame = 0;
    this.picked = [];
    this.listeners = [];
    this.prepare();
    this.camera = { x: 0, y: 0, scale: 1, width: 1, height: 1, density: 1 };
    new ResizeObserver(() => this.resize()).observe(this.element);
    this.resize();
    this.fit();
  }

  /** Layers of the painter and sizes of the mesh. */
  prepare() {
    const { result, other } = this;
    const canvas = byId("bodies");
    this.painter = new Painter(canvas);
    this.layer = this.painter.layer(result.mesh);
    if (other) this.otherLayer = this.painter.layer(other.mesh);
    const { connectivity, inner, outline, nodes } = result.mesh;
    this.deformable = [...new Set(connectivity)].filter((vertex) => vertex < nodes);
    this.undeformed = this.painter.layer(result.mesh);
    const coordinates = this.undeformed.positions;
    result.positions(0, 0, coordinates);
    const edges = [...inner.slice(0, 4000), ...outline.slice(0, 4000)];
    let length = 0;
    for (let i = 0; i < edges.length; i += 2) {
      const [a, b] = [edges[i], edges[i + 1]];
      length += Math.hypot(coordinates[2 * a] - coordinates[2 * b], coordinates[2 * a + 1] - coordinates[2 * b + 1]);
    }
    this.edge = edges.length ? (2 * length) / edges.length : 1;
  }

  on(listener) {
    this.listeners.push(listener);
  }

  /** Draws again before the browser shows its next picture. */
  refresh() {
    this.waiting ??= requestAnimationFrame(() => {
      this.waiting = undefined;
      this.draw();
    });
  }

  setFrame(frame) {
    this.frame = Math.min(Math.max(frame, 0), this.result.frames - 1);
    this.refresh();
    for (const listener of this.listeners) listener(this.frame);
  }

  /** Changes what is drawn; loads the field first. */
  async setLook(change) {
    Object.assign(this.look, change);
    const { scalar, vectors } = this.look;
    if (scalar instanceof Scalar) await scalar.field.load();
    if (vectors) await this.result.field(vectors)?.load();
    this.refresh();
  }

  // The camera.

  resize() {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (!width || !height) return;
    const density = Math.min(window.devicePixelRatio || 1, 2);
    for (const canvas of [byId("bodies"), this.overlay]) {
      canvas.width = Math.round(width * density);
      canvas.height = Math.round(height * density);
    }
    Object.assign(this.camera, { width, height, density });
    if (!this.moved && this.box) this.show(this.box);
    this.refresh();
  }

  /** Shows all that the bodies sweep, or the rigid lines without any, in all frames or in the present one. */
  fit(now = false) {
    const swept = this.deformable.length ? this.deformable : this.result.mesh.rigid;
    const box = [Infinity, Infinity, -Infinity, -Infinity];
    const positions = new Float32Array(2 * this.result.mesh.vertices);
    const { frames } = this.result;
    const every = Math.max(1, Math.floor(frames / 50));
    for (let frame = now ? this.frame : 0; frame < (now ? this.frame + 1 : frames); frame += every) {
      this.result.positions(frame, this.look.scale, positions);
      const [dx, dy] = this.shift(frame);
      for (const node of swept) {
        const [x, y] = [positions[2 * node] - dx, positions[2 * node + 1] - dy];
        if (x < box[0]) box[0] = x;
        if (y < box[1]) box[1] = y;
        if (x > box[2]) box[2] = x;
        if (y > box[3]) box[3] = y;
      }
    }
    if (!(box[0] <= box[2])) box.splice(0, 4, -1, -1, 1, 1);
    this.moved = false;
    this.box = box;
    this.show(box);
  }

  show([x0, y0, x1, y1]) {
    const { camera } = this;
    const room = 1.12;
    camera.x = 0.5 * (x0 + x1);
    camera.y = 0.5 * (y0 + y1);
    const width = Math.max(x1 - x0, 1e-9 * Math.abs(x1), 1e-30);
    const height = Math.max(y1 - y0, 1e-9 * Math.abs(y1), 1e-30);
    camera.scale = Math.min((camera.width - 130) / (room * width), (camera.height - 30) / (room * height));
    camera.x += 45 / camera.scale; // room for the scale of the colours
    this.refresh();
  }

  zoom(factor, x = this.camera.width / 2, y = this.camera.height / 2) {
    const { camera } = this;
    const dx = (x - camera.width / 2) / camera.scale;
    const dy = (camera.height / 2 - y) / camera.scale;
    camera.x += dx * (1 - 1 / factor);
    camera.y += dy * (1 - 1 / factor);
    camera.scale *= factor;
    this.moved = true;
    this.refresh();
  }

  pan(dx, dy) {
    this.camera.x -= dx / this.camera.scale;
    this.camera.y += dy / this.camera.scale;
    this.moved = true;
    this.refresh();
  }

  /** Way of the body that the camera follows, since the first frame. */
  shift(frame) {
    const body = this.look.follow;
    if (body < 0) return [0, 0];
    const { nodeBody } = this.result.mesh;
    const { data } = this.result.displacement;
    const start = 2 * frame * this.result.mesh.nodes;
    let [x, y, count] = [0, 0, 0];
    for (let node = 0; node < nodeBody.length; node++) {
      if (nodeBody[node] !== body) continue;
      x += data[start + 2 * node];
      y += data[start + 2 * node + 1];
      count++;
    }
    return count ? [(x / count) * this.look.scale, (y / count) * this.look.scale] : [0, 0];
  }

  /** The camera with the way of the body that it follows. */
  eye() {
    const [dx, dy] = this.shift(this.frame);
    return { ...this.camera, x: this.camera.x + dx, y: this.camera.y + dy };
  }

  // The range of the colours.

  ends() {
    const { look, result } = this;
    if (look.scalar === "bodies") return { low: 0, high: 8, least: 0, most: 8 };
    if (look.range === "own") return { ...look.scalar.range(result.frames), low: look.low, high: look.high };
    const found = { ...look.scalar.range(result.frames) };
    if (look.range === "full") [found.low, found.high] = [found.least, found.most];
    if (look.range === "frame") {
      const sorted = look.scalar.sorted(this.frame);
      [found.low, found.high] = [Math.min(sorted[0] ?? 0, 0), Math.max(sorted.at(-1) ?? 0, 0)];
    }
    if (this.signs(found)) {
      const most = Math.max(-found.low, found.high);
      [found.low, found.high] = [-most, most];
    }
    if (!(found.high > found.low)) found.high = found.low + 1;
    return found;
  }

  /** Whether a range is shown with a map that has its middle at 0. */
  signs({ low, high }) {
    if (this.look.map !== "auto" && this.look.map !== "cool-warm") return false;
    return low < 0 && high > 0 && Math.min(-low, high) > 0.02 * Math.max(-low, high);
  }

  mapName(ends) {
    if (this.look.scalar === "bodies") return "bodies";
    if (this.look.map !== "auto") return this.look.map;
    return ends.low < 0 && ends.high > 0 && Math.abs(ends.low + ends.high) < 1e-9 * ends.high ? "cool-warm" : "viridis";
  }

  // Drawing.

  draw() {
    const { painter, layer, look, result, frame } = this;
    const ground = styleColour("ground");
    const ink = styleColour("ink");
    const camera = this.eye();
    this.seen = camera;
    result.positions(frame, look.scale, layer.positions);
    const coloured = look.scalar === "bodies" || (look.scalar?.field.data ?? null) !== null;
    const onEdges = coloured && look.scalar.onEdges;
    const ends = coloured ? this.ends() : null;
    if (coloured) {
      this.mapShown = this.mapName(ends);
      painter.colours(colourTable(this.mapShown, look.bands));
      this.fill();
    }
    painter.begin(camera, ground);
    painter.place(layer);
    const range = ends ? [ends.low, ends.high] : [0, 1];
    const plain = styleColour("body");
    const atNodes = coloured && look.scalar.at === "nodes";
    painter.drawFaces(layer, { plain, coloured: coloured && !onEdges, atNodes, range });
    if (look.lines && this.edge * camera.scale >= LINES_FROM) {
      const opacity = Math.min(0.35, 0.08 + 0.008 * this.edge * camera.scale);
      painter.drawEdges(layer, "inner", 0.8, coloured ? { plain: "#101418", onDark: "#ffffff", opacity } : { plain: ink, opacity });
    }
    const thin = this.edge * camera.scale < 2 ? 0.7 : 1.2;
    painter.drawEdges(layer, "outline", thin, { plain: ink, opacity: 0.75 });
    if (onEdges) painter.drawEdges(layer, "outline", 5, { plain, coloured: true, range });
    if (look.undeformed) {
      painter.place(this.undeformed);
      painter.drawEdges(this.undeformed, "outline", 1.2, { plain: styleColour("muted"), opacity: 0.8 });
    }
    painter.drawEdges(layer, "rigid", 2.5, { plain: styleColour("rigid") });
    if (this.other && look.other) this.drawOther();
    painter.end();
    this.drawMarks(camera, ends);
  }

  /** Values of the frame: at vertices and middles of elements, or of elements. */
  fill() {
    const { layer, look, result, frame, painter } = this;
    if (look.scalar === "bodies") result.mesh.body.forEach((body, i) => (layer.ofElements[i] = (body % 8) + 0.5));
    else if (look.scalar.at === "elements") look.scalar.fill(frame, layer.ofElements);
    else {
      look.scalar.fill(frame, layer.values);
      result.spread(layer.values, look.scalar.field.places);
      painter.middles(layer, layer.values);
    }
  }

  /** Outlines of the other result at the nearest of its frames. */
  drawOther() {
    const { painter, other, otherLayer } = this;
    const { positions } = otherLayer;
    other.positions(other.nearestFrame(this.result.times[this.frame]), this.look.scale, positions);
    const [dx, dy] = [0, 1].map((k) => other.mesh.middle[k] - this.result.mesh.middle[k]);
    for (let i = 0; i < other.mesh.vertices; i++) {
      positions[2 * i] += dx;
      positions[2 * i + 1] += dy;
    }
    painter.place(otherLayer);
    const plain = styleColour("other");
    painter.drawEdges(otherLayer, "outline", 1.8, { plain });
    painter.drawEdges(otherLayer, "rigid", 1.8, { plain });
  }

  /** Place of a vertex in the picture. */
  spot(vertex) {
    const data = this.layer.positions;
    return this.spotOf(data[2 * vertex], data[2 * vertex + 1]);
  }

  /** Place of a point of the plane in the picture. */
  spotOf(x, y) {
    const { seen } = this;
    return [seen.width / 2 + (x - seen.x) * seen.scale, seen.height / 2 - (y - seen.y) * seen.scale];
  }

  /** Place of the middle of an element in the picture. */
  middle(element) {
    const { layer, seen } = this;
    const vertex = layer.mesh.vertices + element;
    return [layer.x[vertex] / seen.density, layer.y[vertex] / seen.density];
  }

  /** Point of the plane at a place of the picture, from the middle of the mesh. */
  point(x, y) {
    const { seen } = this;
    return [seen.x + (x - seen.width / 2) / seen.scale, seen.y + (seen.height / 2 - y) / seen.scale];
  }

  /** Signs, arrows, pressure, scale of the colours. */
  drawMarks(camera, ends) {
    const context = this.overlay.getContext("2d");
    context.setTransform(camera.density, 0, 0, camera.density, 0, 0);
    context.clearRect(0, 0, camera.width, camera.height);
    context.lineJoin = "round";
    const marks = new Marks(this, context);
    if (this.look.pressure) marks.pressure();
    if (this.look.vectors) marks.arrows();
    if (this.look.states) marks.states();
    marks.picked();
    marks.time();
    if (ends && this.look.scalar !== "bodies") {
      if (this.look.extremes) marks.extremes();
      marks.scale(ends);
    }
    if (this.cross) marks.cross(this.cross);
    if (this.window) marks.window(this.window);
  }

  // What is under the mouse.

  /** Element that holds a point; -1 where none does. */
  elementAt(px, py) {
    const { connectivity, offsets, elements } = this.result.mesh;
    const data = this.layer.positions;
    for (let cell = 0; cell < elements; cell++) {
      let inside = false;
      let before = connectivity[offsets[cell + 1] - 1];
      for (let i = offsets[cell]; i < offsets[cell + 1]; i++) {
        const node = connectivity[i];
        const [x0, y0, x1, y1] = [data[2 * before], data[2 * before + 1], data[2 * node], data[2 * node + 1]];
        if (y0 > py !== y1 > py && px < ((x1 - x0) * (py - y0)) / (y1 - y0) + x0) inside = !inside;
        before = node;
      }
      if (inside) return cell;
    }
    return -1;
  }

  /** Node nearest to a place of the picture within some pixels; -1 where there is none. */
  nodeAt(x, y, within = 12) {
    const [px, py] = this.point(x, y);
    const data = this.layer.positions;
    let [best, least] = [-1, (within / this.seen.scale) ** 2];
    for (const node of this.deformable) {
      const distance = (data[2 * node] - px) ** 2 + (data[2 * node + 1] - py) ** 2;
      if (distance < least) [best, least] = [node, distance];
    }
    return best;
  }

  /** Lines [name, value] about what is at a place of the picture; none beside the bodies. */
  about(x, y) {
    const { result, frame, look } = this;
    const [px, py] = this.point(x, y);
    const { middle } = result.mesh;
    const lines = [];
    const node = this.nodeAt(x, y);
    const element = this.elementAt(px, py);
    if (node < 0 && element < 0) return lines;
    if (element >= 0) {
      const body = result.bodies > 1 ? `, body ${result.mesh.body[element]}` : "";
      lines.push(["element", `${result.mesh.elementLabels[element]}${body}`]);
    }
    if (node >= 0) lines.push(["node", String(result.mesh.nodeLabels[node])]);
    if (look.scalar instanceof Scalar && look.scalar.field.data) {
      const { scalar } = look;
      if (scalar.at === "elements") {
        if (element >= 0) lines.push([scalar.label, number(scalar.value(frame, element))]);
      } else if (element >= 0 && !scalar.onEdges) {
        lines.push([scalar.label, number(this.valueIn(element, px, py, node))]);
        const mean = scalar.field.source && result.scalar(scalar.id);
        if (mean) lines.push(["mean of the element", number(mean.value(frame, element))]);
      } else if (node >= 0) lines.push([scalar.label, number(scalar.value(frame, node))]);
    }
    const data = this.layer.positions;
    const place = node >= 0 ? [data[2 * node], data[2 * node + 1]] : [px, py];
    lines.push([`position ${result.axes.join(", ")}`, place.map((each, k) => number(each + middle[k])).join(", ")]);
    if (node >= 0) {
      const u = [0, 1].map((k) => result.displacement.value(frame, node, k));
      lines.push(["displacement", u.map((each) => number(each)).join(", ")]);
      this.aboutContact(node, lines);
    }
    return lines;
  }

  /** Value at a node of an element or at a point in it, as it is drawn. */
  valueIn(element, px, py, node) {
    const { connectivity, offsets, vertices, nodes } = this.result.mesh;
    const { values, positions } = this.layer;
    const { twins } = this.result.recovery;
    const ring = connectivity.subarray(offsets[element], offsets[element + 1]);
    const nodeOf = (vertex) => (vertex < nodes ? vertex : twins[vertex - nodes]);
    for (const vertex of ring) if (nodeOf(vertex) === node) return values[vertex];
    const sum = [0, 0];
    for (const vertex of ring) for (const k of [0, 1]) sum[k] += positions[2 * vertex + k] / ring.length;
    const at = (vertex) => [positions[2 * vertex], positions[2 * vertex + 1]];
    for (let i = 0; i < ring.length; i++) {
      const [a, b] = [ring[i], ring[(i + 1) % ring.length]];
      const parts = barycentric([px, py], at(a), at(b), sum);
      if (parts.every((part) => part >= -1e-9)) return parts[0] * values[a] + parts[1] * values[b] + parts[2] * values[vertices + element];
    }
    return values[vertices + element];
  }

  aboutContact(node, lines) {
    const { result, frame } = this;
    const status = result.field("CONTACT_STATUS")?.value(frame, node) ?? 0;
    if (status > 0) lines.push(["contact", STATES[status]]);
    const pressure = result.field("CONTACT_PRESSURE")?.value(frame, node);
    if (pressure > 0 && this.look.scalar?.field?.name !== "CONTACT_PRESSURE") lines.push(["contact pressure", number(pressure)]);
    const force = result.field("CONTACT_FORCE");
    if (!force) return;
    const parts = [0, 1].map((k) => force.value(frame, node, k));
    if (parts[0] || parts[1]) lines.push(["contact force", parts.map((each) => number(each)).join(", ")]);
  }
}

/** Parts of the corners of a triangle in a point. */
function barycentric([x, y], [xa, ya], [xb, yb], [xc, yc]) {
  const twice = (xb - xa) * (yc - ya) - (xc - xa) * (yb - ya);
  const b = ((x - xa) * (yc - ya) - (xc - xa) * (y - ya)) / twice;
  const c = ((xb - xa) * (y - ya) - (x - xa) * (yb - ya)) / twice;
  return [1 - b - c, b, c];
}
