// Charts of histories, drawn by uPlot. A chart has variants that are chosen above it.

const CHART_HEIGHT = 250;
const CHART_KEYS = "+ and − zoom, arrows move, 0 shows all, Shift and arrows read values, Enter goes to the time";

/** Histories of a result by name; values are unpacked when they are asked for. */
class Histories {
  constructor(result) {
    this.result = result;
    this.time = result.time;
    this.byName = new Map(result.histories.all.map((each) => [each.name, each]));
  }

  has(name) {
    return this.byName.has(name);
  }

  /** Names that begin with a text, in the order of the file. */
  under(start) {
    return [...this.byName.keys()].filter((name) => name.startsWith(start));
  }

  /** Whether a history is 0 throughout. */
  zero(name) {
    return this.byName.get(name)?.zero ?? true;
  }

  dimension(name) {
    return this.byName.get(name)?.dimension ?? "1";
  }

  /** A column of a history as numbers, null where there is none. */
  async column(name, column = 0) {
    const history = this.byName.get(name);
    if (!history || history.zero) return new Array(this.time.length).fill(0);
    history.loading ??= unpacked(history.values);
    const values = await history.loading;
    const { columns } = history.values;
    return Array.from(this.time, (_, row) => {
      const value = values[row * columns + column];
      return Number.isFinite(value) ? value : null;
    });
  }

  /** Columns of a history with words for each: "node 12, x". */
  columns(name) {
    return this.byName.get(name).columns;
  }
}

/** Words of the last part of a name. */
function words(name) {
  return name.slice(name.lastIndexOf("/") + 1).replaceAll("_", " ");
}

/** Where the curves of a chart come from: a variant of energies, forces, ... */
class Chart {
  /** `variants` are {name, label, make}: make returns {x, series, axis, log, along}, and `way` where x goes to and fro. */
  constructor(page, title, variants, note = "") {
    this.page = page;
    this.title = title;
    this.variants = variants;
    this.select = make("select", { "aria-label": `${title}: what is shown`, onchange: () => this.build() });
    fillSelect(this.select, [["", variants.map(({ name }, i) => [i, name])]]);
    this.plotted = make("div", { class: "plot", tabIndex: 0, role: "group", "aria-label": `${title}: ${CHART_KEYS}`, onkeydown: (event) => this.key(event) });
    this.tools = make("div", { class: "tools" }, variants.length > 1 ? this.select : null);
    this.note = make("p", { class: "note" }, note);
    const heading = make("header", {}, make("h3", {}, title), this.tools);
    this.card = make("section", { class: "card chart" }, heading, this.plotted, this.note);
    byId("charts").append(this.card);
    // a chart is made when it comes near the window
    new IntersectionObserver((entries, observer) => {
      if (!entries.some((entry) => entry.isIntersecting)) return;
      observer.disconnect();
      if (this.seen) return;
      this.seen = true;
      this.build();
    }, { rootMargin: "300px" }).observe(this.card);
    new ResizeObserver(() => this.fit()).observe(this.plotted);
  }

  fit() {
    const width = this.plotted.clientWidth;
    if (this.plot && width > 0 && Math.abs(width - this.plot.width) > 1) {
      this.plot.setSize({ width, height: CHART_HEIGHT });
      this.mark();
    }
  }

  /** Draws the chosen variant anew. */
  async build() {
    if (!this.seen) return;
    const turn = (this.turn = (this.turn ?? 0) + 1);
    const made = await this.variants[Number(this.select.value) || 0].make();
    if (turn !== this.turn) return;
    const shown = (this.made = made);
    this.card.classList.toggle("empty", Boolean(made.empty));
    const { ordered, joined, data } = shown.way ? ways(shown) : tables(shown);
    this.plot?.destroy();
    this.line = null;
    this.plotted.replaceChildren();
    this.note.textContent = shown.note ?? this.note.textContent;
    this.ends = shown.way ? this.whole() : {};
    this.plot = new uPlot(this.options(shown, ordered, joined), data, this.plotted);
    this.line = make("div", { class: "now" });
    this.plot.over.append(this.line);
    this.plot.over.addEventListener("click", () => this.jump());
    this.plot.over.addEventListener("dblclick", () => this.showAll());
    for (const name of this.plot.root.querySelectorAll(".u-series th")) {
      Object.assign(name, { tabIndex: 0, role: "button" });
      name.addEventListener("keydown", (event) => event.key === "Enter" && name.click());
    }
    this.mark();
  }

  options(shown, ordered, joined) {
    const axis = {
      stroke: () => styleColour("muted"),
      grid: { stroke: () => styleColour("grid"), width: 1 },
      ticks: { stroke: () => styleColour("grid"), width: 1, size: 4 },
      font: "11px system-ui, sans-serif",
      labelFont: "11px system-ui, sans-serif",
      labelSize: 16,
    };
    const shorten = (_, values) => values.map((value) => (value === null ? "" : number(value, 5)));
    const widest = (plot, values) => 16 + 6.5 * Math.max(3, ...(values ?? [""]).map((each) => String(each).length));
    return {
      width: Math.max(200, this.plotted.clientWidth),
      height: CHART_HEIGHT,
      legend: { live: true },
      hooks: { draw: [() => this.mark()] },
      cursor: { sync: shown.along ? undefined : { key: "time" }, drag: { x: !shown.way, y: false }, points: { size: 6 }, ...(shown.way ? { dataIdx: nearestOnWay } : {}) },
      scales: { x: { time: false, ...(shown.way ? { range: () => this.ends.x } : {}) }, y: { distr: shown.log ? 3 : 1, range: shown.way ? () => this.ends.y : shown.log ? undefined : span } },
      axes: [
        { ...axis, label: shown.along ?? "time", values: shorten, size: 34 },
        { ...axis, label: shown.axis, values: shorten, size: widest },
      ],
      series: [
        { label: shown.along ? "at" : "t", value: (_, value) => number(value, 5), ...(shown.way ? { sorted: 0 } : {}) },
        ...ordered.map((each) => {
          const colour = CURVES[each.colour % CURVES.length];
          const stroke = each.faint ? () => styleColour("grid-strong") : colour;
          const points = { show: Boolean(each.points), size: 5, fill: stroke };
          const dash = each.dash ? [6, 4] : undefined;
          const value = (_, found) => number(found, 5);
          const paths = shown.way ? wayPath : undefined;
          return { label: each.label, paths, stroke, width: 1.6, dash, spanGaps: joined, points, value, fill: each.fill };
        }),
      ],
    };
  }

  /** Values of a chart that changes with the frame. */
  setValues(values) {
    this.plot?.setData([this.plot.data[0], ...values], false);
  }

  /** Zoom, window, cursor and time by keys. */
  key(event) {
    if (event.target !== this.plotted || !this.plot || event.ctrlKey || event.metaKey || event.altKey) return;
    const { way } = this.made;
    const ways = { ArrowLeft: ["x", -1], ArrowRight: ["x", 1], ...(way ? { ArrowUp: ["y", 1], ArrowDown: ["y", -1] } : {}) };
    const factor = { "+": 0.7, "=": 0.7, "-": 1 / 0.7 }[event.key];
    const [axis, sign] = ways[event.key] ?? [];
    if (factor) this.window("xy", (low, high, at) => [at - (at - low) * factor, at + (high - at) * factor]);
    else if (event.key === "0") this.showAll();
    else if (event.key === "Enter") this.jump();
    else if (axis && event.shiftKey) this.moveCursor(sign);
    else if (axis) this.window(axis, (low, high) => [low, high].map((end) => end + 0.1 * sign * (high - low)));
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  /** Other ends of axes, each made of its ends and the place of the cursor or the middle between them. */
  window(axes, made) {
    const { plot } = this;
    const { left, top } = plot.cursor;
    for (const axis of axes) {
      // the ordinate of curves over abscissae that grow follows what is in the window
      if (axis === "y" && !this.made.way) continue;
      const { min, max } = plot.scales[axis];
      const at = left >= 0 ? plot.posToVal(axis === "x" ? left : top, axis) : 0.5 * (min + max);
      const [low, high] = made(min, max, at, axis);
      if (!(high > low)) continue;
      this.ends[axis] = [low, high];
      plot.setScale(axis, { min: low, max: high });
    }
  }

  showAll() {
    const whole = this.whole();
    this.window("xy", (low, high, at, axis) => whole[axis]);
  }

  /** Ends of the axes that show all. */
  whole() {
    const { made, plot } = this;
    if (made.way) return { x: spanOf(made.series.map(({ x }) => x)), y: spanOf(made.series.map(({ values }) => values)) };
    return { x: [plot.data[0][0], plot.data[0].at(-1)] };
  }

  /** The cursor at a point before or after the one where it is. */
  moveCursor(step) {
    const { made, plot } = this;
    const x = plot.data[0];
    const row = Math.min(Math.max((plot.cursor.idx ?? (step > 0 ? -1 : x.length)) + step, 0), x.length - 1);
    const series = plot.data.findIndex((column, at) => at > 0 && (column[row] ?? null) !== null);
    const top = series > 0 ? plot.valToPos(plot.data[series][row], "y") : 0;
    const [low, high] = [plot.scales.x.min, plot.scales.x.max];
    if (x[row] < low || x[row] > high) this.window("x", () => [low, high].map((end) => end + x[row] - 0.5 * (low + high)));
    plot.setCursor({ left: plot.valToPos(x[row], "x"), top });
  }

  /** The line at the time of the frame, or where a curve that goes to and fro is then. */
  mark() {
    if (!this.line || !this.made) return;
    const { made, plot } = this;
    const { view } = this.page;
    const time = view.result.times[view.frame];
    this.line.hidden = Boolean(made.along) && !made.way;
    if (this.line.hidden) return;
    const [first] = made.series;
    const at = made.way && first.times ? first.x[rowAt(first.times, time)] : time;
    const left = plot.valToPos(at, "x");
    this.line.hidden = !(left >= 0 && left <= plot.over.clientWidth);
    this.line.style.transform = `translateX(${left}px)`;
  }

  /** Goes to the time that was clicked, unless the mouse drew a window. */
  jump() {
    const { made, plot } = this;
    if ((made.along && !made.way) || plot.select.width > 2) return;
    const { idx, left } = plot.cursor;
    const time = made.way ? made.series[0].times?.[idx] : plot.posToVal(left, "x");
    if (time === undefined) return;
    this.page.player.go(this.page.view.result.nearestFrame(time));
  }
}

/** Curves over abscissae that grow, those of one abscissa beside each other. */
function tables(shown) {
  const found = new Map();
  for (const each of shown.series) {
    const x = each.x ?? shown.x;
    if (!found.has(x)) found.set(x, [Array.from(x)]);
    found.get(x).push(each.values);
    each.table = x;
  }
  const ordered = [...found.keys()].flatMap((x) => shown.series.filter((each) => each.table === x));
  const joined = found.size > 1;
  return { ordered, joined, data: joined ? uPlot.join([...found.values()]) : [...found.values()][0] ?? [[], []] };
}

/** Curves that go to and fro, one behind the other: each has values at its own part of the abscissa. */
function ways(shown) {
  const x = shown.series.flatMap((each) => Array.from(each.x));
  let start = 0;
  const columns = shown.series.map((each) => {
    const column = new Array(x.length).fill(null);
    each.values.forEach((value, row) => (column[start + row] = value));
    start += each.values.length;
    return column;
  });
  return { ordered: shown.series, joined: false, data: [x, ...columns] };
}

/** The lines of a curve that goes to and fro. */
function wayPath(plot, series) {
  const [x, y] = [plot.data[0], plot.data[series]];
  const stroke = new Path2D();
  let down = false;
  for (let row = 0; row < x.length; row++) {
    const there = x[row] !== null && y[row] !== null;
    if (there) stroke[down ? "lineTo" : "moveTo"](plot.valToPos(x[row], "x", true), plot.valToPos(y[row], plot.series[series].scale, true));
    down = there;
  }
  const clip = new Path2D();
  clip.rect(plot.bbox.left, plot.bbox.top, plot.bbox.width, plot.bbox.height);
  return { stroke, fill: null, clip, flags: 1 };
}

/** The row of a curve that is nearest to the mouse. */
function nearestOnWay(plot, series) {
  const [x, y] = [plot.data[0], plot.data[series]];
  const { left, top } = plot.cursor;
  let [best, least] = [null, Infinity];
  for (let row = 0; series > 0 && row < x.length; row++) {
    if (x[row] === null || y[row] === null) continue;
    const distance = Math.hypot(plot.valToPos(x[row], "x") - left, plot.valToPos(y[row], "y") - top);
    if (distance < least) [best, least] = [row, distance];
  }
  return series > 0 ? best : nearestOnWay(plot, 1);
}

/** Last row at or before a time; those of the rows have single precision. */
function rowAt(times, time) {
  let row = 0;
  while (row + 1 < times.length && times[row + 1] <= time * (1 + 1e-6)) row++;
  return row;
}

/** Ends of an axis for all values of some columns. */
function spanOf(columns) {
  let [low, high] = [Infinity, -Infinity];
  for (const column of columns) {
    for (const value of column) {
      if (value === null || !Number.isFinite(value)) continue;
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  return low <= high ? span(null, low, high) : [0, 1];
}

/** Ends of an axis with some room; a constant has room of its own size. */
function span(_, low, high) {
  if (low === null || high === null) return [0, 1];
  if (low === high) {
    const room = Math.abs(low) || 1;
    return low === 0 ? [-0.1 * room, room] : [low - 0.5 * room, high + 0.5 * room];
  }
  const room = 0.06 * (high - low);
  return [low - room, high + room];
}
