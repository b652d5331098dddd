// Charts of histories, drawn by uPlot. A chart has variants that are chosen above it.

const CHART_HEIGHT = 250;

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
  /** `variants` are {name, label, make}: make returns {x, series, axis, log, along}. */
  constructor(page, title, variants, note = "") {
    this.page = page;
    this.variants = variants;
    this.select = make("select", { "aria-label": `${title}: what is shown`, onchange: () => this.build() });
    fillSelect(this.select, [["", variants.map(({ name }, i) => [i, name])]]);
    this.plotted = make("div", { class: "plot" });
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
    const tables = new Map();
    for (const each of shown.series) {
      const x = each.x ?? shown.x;
      if (!tables.has(x)) tables.set(x, [Array.from(x)]);
      tables.get(x).push(each.values);
      each.table = x;
    }
    const ordered = [...tables.keys()].flatMap((x) => shown.series.filter((each) => each.table === x));
    const joined = tables.size > 1;
    const data = joined ? uPlot.join([...tables.values()]) : [...tables.values()][0] ?? [[], []];
    this.plot?.destroy();
    this.line = null;
    this.plotted.replaceChildren();
    this.note.textContent = shown.note ?? this.note.textContent;
    this.plot = new uPlot(this.options(shown, ordered, joined), data, this.plotted);
    this.line = make("div", { class: "now" });
    this.plot.over.append(this.line);
    this.plot.over.addEventListener("click", () => this.jump());
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
      cursor: { sync: shown.along ? undefined : { key: "time" }, drag: { x: true, y: false }, points: { size: 6 } },
      scales: { x: { time: false }, y: { distr: shown.log ? 3 : 1, range: shown.log ? undefined : span } },
      axes: [
        { ...axis, label: shown.along ?? "time", values: shorten, size: 34 },
        { ...axis, label: shown.axis, values: shorten, size: widest },
      ],
      series: [
        { label: shown.along ? "at" : "t", value: (_, value) => number(value, 5) },
        ...ordered.map((each) => {
          const colour = CURVES[each.colour % CURVES.length];
          const stroke = each.faint ? () => styleColour("grid-strong") : colour;
          const points = { show: Boolean(each.points), size: 5, fill: stroke };
          const dash = each.dash ? [6, 4] : undefined;
          const value = (_, found) => number(found, 5);
          return { label: each.label, stroke, width: 1.6, dash, spanGaps: joined, points, value, fill: each.fill };
        }),
      ],
    };
  }

  /** Values of a chart that changes with the frame. */
  setValues(values) {
    this.plot?.setData([this.plot.data[0], ...values], false);
  }

  /** The line at the time of the frame. */
  mark() {
    if (!this.line || !this.made || this.made.along) {
      if (this.line) this.line.hidden = true;
      return;
    }
    const { view } = this.page;
    const left = this.plot.valToPos(view.result.times[view.frame], "x");
    this.line.hidden = !(left >= 0 && left <= this.plot.over.clientWidth);
    this.line.style.transform = `translateX(${left}px)`;
  }

  /** Goes to the time that was clicked, unless the mouse drew a window. */
  jump() {
    if (this.made.along || this.plot.select.width > 2) return;
    const time = this.plot.posToVal(this.plot.cursor.left, "x");
    this.page.player.go(this.page.view.result.nearestFrame(time));
  }
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
