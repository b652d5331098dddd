// Scalars that colour the bodies, made from the fields of the frames, and the ranges of their colours.

const NONE = 3e38; // stands for "no value"

const radius = (d, i) => Math.hypot(0.5 * (d[i] - d[i + 1]), d[i + 2]);

/** Numbers made of a vector or a tensor: [id, name in words, function]. The ids of components are the same everywhere. */
function partsOf(components, axes, tensor) {
  if (components === 1) return [["", "", (d, i) => d[i]]];
  if (components === 2) {
    return [
      ["magnitude", "magnitude", (d, i) => Math.hypot(d[i], d[i + 1])],
      ["x", axes[0], (d, i) => d[i]],
      ["y", axes[1], (d, i) => d[i + 1]],
    ];
  }
  return [
    ["xx", tensor[0], (d, i) => d[i]],
    ["yy", tensor[1], (d, i) => d[i + 1]],
    ["xy", tensor[2], (d, i) => d[i + 2]],
    ["max", "largest principal in the plane", (d, i) => 0.5 * (d[i] + d[i + 1]) + radius(d, i)],
    ["min", "smallest principal in the plane", (d, i) => 0.5 * (d[i] + d[i + 1]) - radius(d, i)],
    ["mean", "mean in the plane", (d, i) => 0.5 * (d[i] + d[i + 1])],
  ];
}

/** A field [frames, places, components] of the page, unpacked when it is asked for. */
class Field {
  constructor(description, places) {
    Object.assign(this, description);
    this.places = places;
    this.data = null;
  }

  /** Values and the places that have any; the promise is kept. */
  load() {
    this.loading ??= (async () => {
      const only = this.only ? await unpacked(this.only) : null;
      const data = await unpacked(this.values);
      this.index = null;
      if (only) {
        this.index = new Int32Array(this.places).fill(-1);
        only.forEach((place, i) => (this.index[place] = i));
      }
      this.onlyPlaces = only;
      this.data = data;
      this.columns = this.values.columns;
    })();
    return this.loading;
  }

  /** Start of a place's components in a frame; -1 where it has none. */
  startOf(frame, place) {
    const i = this.index ? this.index[place] : place;
    return i < 0 ? -1 : frame * this.columns + i * this.components;
  }

  /** A component of a place in a frame. */
  value(frame, place, component = 0) {
    const start = this.startOf(frame, place);
    return start < 0 ? (this.empty === null ? NaN : 0) : this.data[start + component];
  }
}

/** Fields that are made of the stresses in the plane and across it. */
const principal = (k) => (x, y, xy, z) => {
  const [middle, half] = [0.5 * (x + y), Math.hypot(0.5 * (x - y), xy)];
  return [middle - half, middle + half, z].sort((a, b) => a - b)[k];
};
const INVARIANTS = {
  MISES: (x, y, xy, z) => Math.sqrt(((x - y) ** 2 + (y - z) ** 2 + (z - x) ** 2) / 2 + 3 * xy * xy),
  PRESS: (x, y, xy, z) => -(x + y + z) / 3,
  SP1: principal(0),
  SP2: principal(1),
  SP3: principal(2),
};

/** A field of elements at the places of nodes, averaged within a body and a material (nodal.py). */
class NodalField extends Field {
  constructor(result, source) {
    const columns = result.recovery.places * source.components;
    super({ ...source, at: "nodes", empty: null, only: null, values: { columns } }, result.recovery.places);
    this.result = result;
    this.source = source;
  }

  load() {
    this.loading ??= this.recover();
    return this.loading;
  }

  async recover() {
    const { result, source } = this;
    const ofProgram = result.field(`${source.name}_AT_NODES`);
    const [inPlane, across] = ["S", "S33"].map((name) => result.scalars.find((scalar) => scalar.field.name === name)?.nodal.field);
    const of = inPlane && INVARIANTS[source.name];
    await Promise.all([source, of && inPlane, of && across, ofProgram].map((field) => field?.load()));
    const data = of ? this.invariant(of, inPlane.data, across?.data) : this.average();
    for (let frame = 0; ofProgram && frame < result.frames; frame++) {
      for (const node of result.recovery.alone) {
        for (let k = 0; k < this.components; k++) {
          data[frame * this.values.columns + node * this.components + k] = ofProgram.value(frame, node, k);
        }
      }
    }
    this.data = data;
    this.columns = this.values.columns;
  }

  /** Values that are made of the stresses at the places; without any across the plane, as in plane stress. */
  invariant(of, inPlane, across) {
    const at = (i) => of(inPlane[3 * i], inPlane[3 * i + 1], inPlane[3 * i + 2], across ? across[i] : 0);
    return Float32Array.from({ length: inPlane.length / 3 }, (_, i) => at(i));
  }

  /** Weighted means of the elements around corners; means of these between them. */
  average() {
    const { result, source, components } = this;
    const { places, place, element, weight, middles, corners } = result.recovery;
    const columns = places * components;
    const data = new Float32Array(result.frames * columns).fill(NaN);
    const sums = new Float64Array(places);
    const values = new Float64Array(source.places);
    for (let frame = 0; frame < result.frames; frame++) {
      for (let k = 0; k < components; k++) {
        let least = Infinity;
        for (let cell = 0; cell < values.length; cell++) {
          values[cell] = source.value(frame, cell, k);
          if (values[cell] < least) least = values[cell];
        }
        sums.fill(0);
        for (let w = 0; w < place.length; w++) sums[place[w]] += weight[w] * values[element[w]];
        const start = frame * columns + k;
        for (let i = 0; i < corners.length; i++) {
          const sum = sums[corners[i]];
          data[start + corners[i] * components] = least >= 0 && sum < 0 ? 0 : sum;
        }
        for (let i = 0; i < middles.length; i += 3) {
          const ends = data[start + middles[i] * components] + data[start + middles[i + 2] * components];
          data[start + middles[i + 1] * components] = 0.5 * ends;
        }
      }
    }
    return data;
  }
}

/** A number for each node or element: a component of a field, or what is made of its components. */
class Scalar {
  constructor(field, part, text, of) {
    this.field = field;
    this.id = part ? `${field.name}:${part}` : field.name;
    const name = field.words;
    this.group = name;
    this.label = text ? `${name}, ${text}` : name;
    this.known = field.also[part] ?? field.name;
    this.of = of;
    this.at = field.at;
    this.onEdges = field.at === "nodes" && field.empty === null && !field.source && !field.name.endsWith("_AT_NODES");
  }

  value(frame, place) {
    const start = this.field.startOf(frame, place);
    return start < 0 ? (this.field.empty === null ? NaN : 0) : this.of(this.field.data, start);
  }

  /** All values of a frame; NONE where there is none. */
  fill(frame, into) {
    const { field, of } = this;
    const { data, columns, components, index, places } = field;
    const empty = field.empty === null ? NONE : 0;
    const start = frame * columns;
    for (let place = 0; place < places; place++) {
      const i = index ? index[place] : place;
      const value = i < 0 ? NaN : of(data, start + i * components);
      into[place] = i < 0 ? empty : Number.isFinite(value) ? value : NONE;
    }
  }

  /** Values that are there and not 0 in a frame, sorted. */
  sorted(frame) {
    const { data, columns, components } = this.field;
    const places = columns / components;
    const found = new Float32Array(places);
    let count = 0;
    for (let i = 0; i < places; i++) {
      const value = this.of(data, frame * columns + i * components);
      if (Number.isFinite(value) && value !== 0) found[count++] = value;
    }
    return found.subarray(0, count).sort();
  }

  /** Smallest and largest value of all frames with their frames, and ends of colours without peaks. */
  range(frames) {
    if (this.found) return this.found;
    const found = { least: 0, most: 0, leastFrame: 0, mostFrame: 0 };
    const { data, columns, components } = this.field;
    const every = Math.max(1, Math.ceil(frames / 60));
    const lows = [];
    const highs = [];
    for (let frame = 0; frame < frames; frame++) {
      for (let i = frame * columns; i < (frame + 1) * columns; i += components) {
        const value = this.of(data, i);
        if (value < found.least) [found.least, found.leastFrame] = [value, frame];
        if (value > found.most) [found.most, found.mostFrame] = [value, frame];
      }
      if (frame % every === 0 || frame === frames - 1) {
        const sorted = this.sorted(frame);
        lows.push(-frameEnd(sorted, -1));
        highs.push(frameEnd(sorted, 1));
      }
    }
    found.low = -usual(lows, -found.least);
    found.high = usual(highs, found.most);
    return (this.found = found);
  }
}

/** Largest value of a frame towards one side without the fiftieth of its places that stands out. */
function frameEnd(sorted, side) {
  if (sorted.length === 0) return 0;
  const end = side > 0 ? sorted[sorted.length - 1] : sorted[0];
  const from = Math.floor(0.02 * (sorted.length - 1)) + (sorted.length > 20 ? 1 : 0);
  const inner = side > 0 ? sorted[sorted.length - 1 - from] : sorted[from];
  const most = 1.4 * Math.max(0, side * inner);
  return side * Math.max(0, Math.min(side * end, most || side * end));
}

/** Largest of the ends of frames [frames] without the frames that are peaks. */
function usual(ends, all) {
  const positive = ends.filter((end) => end > 0).sort((a, b) => a - b);
  if (positive.length === 0) return Math.max(all, 0);
  const most = positive[Math.floor(0.95 * (positive.length - 1))];
  return Math.min(positive[positive.length - 1], 2 * most);
}

/** All scalars of the fields of a result; those of elements have a twin at nodes. */
function scalarsOf(result) {
  const scalars = [];
  for (const field of result.fields) {
    if (field.name === "CONTACT_STATUS" || field.values.columns === 0) continue;
    const nodal = field.at === "elements" && field.dimension !== "energy" && result.recovery ? new NodalField(result, field) : null;
    for (const [part, text, of] of partsOf(field.components, result.axes, result.tensor)) {
      const scalar = new Scalar(field, part, text, of);
      if (nodal) scalar.nodal = new Scalar(nodal, part, text, of);
      scalars.push(scalar);
    }
  }
  return scalars;
}

/** A result of the page with what is needed to draw it. */
class Result {
  constructor(described) {
    Object.assign(this, described);
    this.frames = this.times.length;
    const motion = { name: "U", at: "nodes", components: 2, empty: 0, dimension: "length", values: this.motion, ...this.displacement };
    this.displacement = new Field(motion, this.mesh.nodes);
    this.fields = [motion, ...this.fields].map(
      (each) => new Field(each, each.at === "nodes" ? this.mesh.nodes : this.mesh.elements),
    );
    this.fields[0] = this.displacement;
    this.scalars = scalarsOf(this);
  }

  /** Unpacks the mesh, its motion and what belongs to contact. */
  async load() {
    const { mesh, recovery } = this;
    for (const group of [mesh, recovery ?? {}]) {
      for (const [name, value] of Object.entries(group)) {
        if (value && typeof value === "object" && "blob" in value) group[name] = await unpacked(value);
      }
    }
    mesh.vertices = mesh.nodes + mesh.after.length / 3;
    if (recovery) {
      recovery.corners = Int32Array.from(new Set(recovery.place));
      const twins = new Set(recovery.twins);
      recovery.alone = Array.from({ length: mesh.nodes }, (_, node) => node).filter((node) => !twins.has(node));
    }
    const contact = ["CONTACT_STATUS", "CONTACT_PRESSURE", "CONTACT_FORCE"];
    await Promise.all(this.fields.filter((f) => f.name === "U" || contact.includes(f.name)).map((f) => f.load()));
    this.time = await unpacked(this.histories.time);
  }

  field(name) {
    return this.fields.find((field) => field.name === name && field.values.columns > 0) ?? null;
  }

  scalar(id) {
    return this.scalars.find((scalar) => scalar.id === id) ?? null;
  }

  /** Positions of the vertices [2 vertices] in a frame, from the middle of the mesh, with displacements so many times. */
  positions(frame, scale, into) {
    const { coordinates, nodes, after } = this.mesh;
    const { data } = this.displacement;
    const start = frame * 2 * nodes;
    for (let i = 0; i < 2 * nodes; i++) into[i] = coordinates[i] + scale * data[start + i];
    // on the parabola through a corner, a node between and the other corner
    for (let i = 0, at = 2 * nodes; i < after.length; i += 3) {
      const [a, m, b] = [2 * after[i], 2 * after[i + 1], 2 * after[i + 2]];
      into[at++] = 0.375 * into[a] + 0.75 * into[m] - 0.125 * into[b];
      into[at++] = 0.375 * into[a + 1] + 0.75 * into[m + 1] - 0.125 * into[b + 1];
    }
  }

  /** Values at the vertices behind the `known` first ones, straight between nodes. */
  spread(values, known) {
    const { nodes, after } = this.mesh;
    for (let vertex = known; vertex < nodes + after.length / 3; vertex++) {
      const i = 3 * (vertex - nodes);
      values[vertex] = 0.5 * (values[after[i]] + values[after[i + 1]]);
    }
  }

  /** Frame that is last at or before a time. */
  frameAt(time) {
    let frame = 0;
    while (frame + 1 < this.frames && this.times[frame + 1] <= time * (1 + 1e-9)) frame++;
    return frame;
  }

  /** Frame that is nearest to a time. */
  nearestFrame(time) {
    const before = this.frameAt(time);
    const after = Math.min(before + 1, this.frames - 1);
    return Math.abs(this.times[after] - time) < Math.abs(this.times[before] - time) ? after : before;
  }
}
