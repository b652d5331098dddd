// Puts the page together: controls, charts, tables.

/** Width of paper in pixels of the page. */
const PAPER = 800;

class Page {
  constructor(data) {
    this.results = data.results.map((each) => new Result(each));
    [this.result, this.other] = this.results;
    this.info = data.info;
    this.version = data.version;
  }

  async start() {
    this.head();
    await Promise.all(this.results.map((result) => result.load()));
    this.histories = this.results.map((result) => new Histories(result));
    this.view = new View(this.result, this.other, byId("view"));
    this.player = new Player(this.view);
    this.mouse = new Mouse(this.view, (node) => this.pick(node));
    this.controls();
    this.keys();
    const charts = [forceChart, energyChart, contactChart, momentumChart, solverChart, surfaceChart, nodeChart, anyChart];
    this.charts = charts.map((chart) => chart(this)).filter(Boolean);
    this.nodes = this.charts.at(-2);
    this.view.on(() => this.charts.forEach((chart) => chart.mark()));
    await this.chooseField(this.firstField());
    this.view.setFrame(0);
    this.tables();
    document.body.dataset.ready = "yes";
    // a print that the browser begins cannot wait for charts
    (window.requestIdleCallback ?? setTimeout)(() => this.buildAll());
  }

  // What stands above the picture.

  head() {
    const { result, other } = this;
    document.title = `${result.job} – stickslip`;
    byId("job").textContent = other ? `${result.job} and ${other.job}` : result.job;
    byId("heading").textContent = result.heading;
    const status = result.run.exit_status;
    const stopped = { "-1": "not finished", 0: "finished", 1: "stopped in the solve", 129: "stopped by SIGHUP", 130: "stopped by SIGINT", 143: "stopped by SIGTERM" }[status] ?? `ended with code ${status}`;
    const badges = [make("span", { class: `badge ${status === 0 ? "good" : "bad"}` }, stopped)];
    const { warnings } = this.info;
    if (warnings.length) {
      const text = warnings.length === 1 ? "1 warning" : `${warnings.length} warnings`;
      badges.push(make("a", { class: "badge warn", href: "#warnings" }, text));
    }
    byId("badges").replaceChildren(...badges);
    const landings = result.landings ? [["landings", counted(result.landings)]] : [];
    const seconds = result.run.seconds_total;
    const figures = [
      ["elements", counted(result.elements)],
      ["nodes", counted(result.nodes)],
      ["bodies", counted(result.bodies)],
      ["increments", counted(result.increments)],
      ["time", number(result.end)],
      ...landings,
      ...(seconds > 0 ? [["computed in", duration(seconds)]] : []),
    ];
    byId("figures").replaceChildren(...figures.map(([name, value]) => make("div", {}, make("dt", {}, name), make("dd", {}, value))));
  }

  // Controls beside the picture.

  controls() {
    const { view, result } = this;
    const groups = new Map([["", [["none", "no field"], ...(result.bodies > 1 ? [["bodies", "bodies"]] : [])]]]);
    for (const scalar of result.scalars) {
      if (!groups.has(scalar.group)) groups.set(scalar.group, []);
      groups.get(scalar.group).push([scalar.id, `${scalar.label} (${scalar.known})`]);
    }
    fillSelect(byId("field"), [...groups]);
    byId("field").addEventListener("change", (event) => this.chooseField(event.target.value));
    byId("values").addEventListener("change", () => this.chooseField(byId("field").value));
    byId("bands").addEventListener("change", (event) => view.setLook({ bands: Number(event.target.value) }));
    byId("range").addEventListener("change", (event) => this.chooseRange(event.target.value));
    for (const id of ["low", "high"]) byId(id).addEventListener("change", () => this.chooseRange("own"));
    byId("map").addEventListener("change", (event) => view.setLook({ map: event.target.value }));
    const vectors = result.fields.filter((field) => field.components === 2 && field.values.columns > 0);
    fillSelect(byId("vectors"), [["", [["", "no arrows"], ...vectors.map((field) => [field.name, `${field.words} (${field.name})`])]]]);
    byId("vectors").addEventListener("change", (event) => view.setLook({ vectors: event.target.value }));
    byId("vector-scale").addEventListener("input", (event) => view.setLook({ vectorScale: 2 ** Number(event.target.value) }));
    byId("scale").addEventListener("change", (event) => view.setLook({ scale: Math.max(Number(event.target.value) || 0, 0) }));
    for (const name of ["lines", "states", "pressure", "other", "undeformed", "extremes"]) {
      byId(name).addEventListener("change", (event) => view.setLook({ [name]: event.target.checked }));
    }
    byId("other").parentElement.hidden = !this.other;
    if (this.other) byId("other-name").textContent = `outlines of ${this.other.job}`;
    const contact = Boolean(result.field("CONTACT_STATUS"));
    for (const name of ["states", "pressure"]) byId(name).parentElement.hidden = !contact;
    byId("legend").hidden = !contact;
    byId("follow").parentElement.hidden = result.bodies < 1;
    const bodies = Array.from({ length: Math.min(result.bodies, 200) }, (_, body) => [body, `body ${body}`]);
    fillSelect(byId("follow"), [["", [[-1, "stands still"], ...bodies]]]);
    byId("follow").addEventListener("change", (event) => view.setLook({ follow: Number(event.target.value) }).then(() => view.fit()));
    const actions = {
      "zoom-in": () => view.zoom(1.4),
      "zoom-out": () => view.zoom(1 / 1.4),
      fit: () => view.fit(),
      window: () => this.mouse.setWindowed(!this.mouse.windowed),
      picture: () => this.savePicture(),
      theme: () => this.changeTheme(),
      print: () => this.buildAll().then(() => window.print()),
      help: () => byId("keys").showModal(),
      "close-keys": () => byId("keys").close(),
    };
    for (const [id, action] of Object.entries(actions)) byId(id).addEventListener("click", action);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.redraw());
    window.addEventListener("beforeprint", () => this.forPrint(true));
    window.addEventListener("afterprint", () => this.forPrint(false));
    if (contact && result.field("CONTACT_FORCE")) byId("vectors").value = "CONTACT_FORCE";
    view.setLook({ vectors: byId("vectors").value });
  }

  firstField() {
    for (const id of ["MISES", "U:magnitude"]) if (this.result.scalar(id)) return id;
    return "none";
  }

  async chooseField(id) {
    byId("field").value = id;
    const named = this.result.scalar(id);
    byId("values").disabled = !named?.nodal;
    const scalar = (byId("values").value === "nodes" && named?.nodal) || named;
    this.chosen = scalar;
    if (scalar) await scalar.field.load();
    if (this.chosen !== scalar) return;
    if (byId("range").value === "own") byId("range").value = "usual";
    await this.view.setLook({ scalar: scalar ?? (id === "bodies" ? id : null), range: byId("range").value });
    this.showRange();
  }

  /** The other one of values at nodes and of elements. */
  otherValues() {
    const select = byId("values");
    if (select.disabled) return;
    select.value = select.value === "nodes" ? "elements" : "nodes";
    this.chooseField(byId("field").value);
  }

  async chooseRange(range) {
    byId("range").value = range;
    const [low, high] = ["low", "high"].map((id) => Number(byId(id).value));
    await this.view.setLook({ range, low, high });
    this.showRange();
  }

  /** The ends of the colours in the fields for them. */
  showRange() {
    const coloured = this.view.look.scalar instanceof Scalar;
    for (const id of ["range", "low", "high", "map", "bands", "extremes"]) byId(id).disabled = !coloured;
    if (!coloured || this.view.look.range === "own") return;
    const ends = this.view.ends();
    byId("low").value = number(ends.low);
    byId("high").value = number(ends.high);
  }

  // Chosen nodes.

  pick(node, keep = false) {
    const { picked } = this.view;
    const at = picked.indexOf(node);
    if (at < 0) {
      if (picked.length === CURVES.length) picked.shift();
      picked.push(node);
    } else if (!keep) picked.splice(at, 1);
    this.view.refresh();
    this.nodes.build();
  }

  unpick() {
    this.view.picked.splice(0);
    this.view.refresh();
    this.nodes.build();
  }

  // Keys, theme, print, picture.

  keys() {
    const { view, player } = this;
    const by = (event) => (event.shiftKey ? 10 : 1);
    const click = (id) => () => byId(id).click();
    const actions = {
      " ": () => player.toggle(),
      ArrowRight: (event) => player.step(by(event)),
      ArrowLeft: (event) => player.step(-by(event)),
      Home: () => player.go(0),
      End: () => player.go(this.result.frames - 1),
      "+": () => view.zoom(1.25, ...(view.cross ?? [])),
      "=": () => view.zoom(1.25, ...(view.cross ?? [])),
      "-": () => view.zoom(0.8, ...(view.cross ?? [])),
      0: () => view.fit(),
      f: () => view.fit(true),
      l: click("lines"),
      c: click("states"),
      p: click("pressure"),
      u: click("undeformed"),
      e: click("extremes"),
      v: () => this.otherValues(),
      m: () => this.mouse.toggleCross(),
      w: click("window"),
      "?": click("help"),
    };
    const move = (dx, dy) => (event) => this.mouse.moveCross(...[dx, dy].map((way) => way * (event.shiftKey ? 1 : 10)));
    const crossed = {
      ArrowRight: move(1, 0),
      ArrowLeft: move(-1, 0),
      ArrowUp: move(0, -1),
      ArrowDown: move(0, 1),
      Enter: () => this.mouse.pickAtCross(),
      Escape: () => this.mouse.toggleCross(),
    };
    document.addEventListener("keydown", (event) => {
      const { tagName, type } = event.target;
      const typing = tagName === "SELECT" || (tagName === "INPUT" && !["checkbox", "range"].includes(type)) || byId("keys").open;
      const onButton = [" ", "Enter"].includes(event.key) && (tagName === "BUTTON" || type === "checkbox" || tagName === "SUMMARY");
      const onSlider = type === "range" && event.target.id !== "frame" && event.key.startsWith("Arrow");
      if (typing || onButton || onSlider || event.ctrlKey || event.metaKey || event.altKey) return;
      const action = (view.cross && crossed[event.key]) || actions[event.key];
      if (!action) return;
      event.preventDefault();
      action(event);
    });
  }

  changeTheme() {
    const dark = matchMedia("(prefers-color-scheme: dark)").matches;
    const now = document.documentElement.dataset.theme ?? (dark ? "dark" : "light");
    document.documentElement.dataset.theme = now === "dark" ? "light" : "dark";
    this.redraw();
  }

  /** Light colours, and pictures in the place of canvases, which keep their shape at the width of the paper. */
  forPrint(begins) {
    const { dataset } = document.documentElement;
    if (begins) this.themeBefore = dataset.theme;
    if (begins) dataset.theme = "light";
    else if (this.themeBefore) dataset.theme = this.themeBefore;
    else delete dataset.theme;
    document.querySelectorAll(".printed").forEach((each) => each.remove());
    this.view.draw();
    if (begins) this.view.element.append(printed(this.drawn()));
    for (const chart of this.charts) {
      const { plot } = chart;
      if (!plot) continue;
      // the text of a chart wider than the paper would be too small on it
      plot.batch(() => {
        if (begins && plot.width > PAPER) plot.setSize({ width: PAPER, height: plot.height });
        else if (!begins) chart.fit();
        plot.redraw(false);
      });
      if (begins) plot.root.querySelector(".u-wrap").append(printed(plot.ctx.canvas));
    }
  }

  /** Builds the charts that have not come near the window, so that a print holds them. */
  async buildAll() {
    for (const chart of this.charts) {
      if (chart.seen) continue;
      chart.seen = true;
      await chart.build();
    }
  }

  redraw() {
    this.view.refresh();
    for (const chart of this.charts) chart.plot?.redraw(false);
  }

  /** Saves the picture of the frame. */
  savePicture() {
    const { view } = this;
    view.draw();
    const canvas = this.drawn();
    const name = `${this.result.job}_${String(view.frame).padStart(4, "0")}.png`;
    make("a", { href: canvas.toDataURL("image/png"), download: name }).click();
  }

  /** The picture with its marks. */
  drawn() {
    const { overlay } = this.view;
    const canvas = make("canvas", { width: overlay.width, height: overlay.height });
    const context = canvas.getContext("2d");
    context.drawImage(byId("bodies"), 0, 0);
    context.drawImage(overlay, 0, 0);
    return canvas;
  }

  // Tables below the charts.

  tables() {
    const { info, result } = this;
    const rows = info.lines.map(([name, text]) => make("tr", {}, make("th", { scope: "row" }, name), make("td", {}, text)));
    byId("summary").append(make("table", { class: "pairs" }, make("tbody", {}, ...rows)));
    const warnings = info.warnings.map((text) => make("li", {}, text));
    const none = info.missing ?? "The run has no warnings.";
    byId("warnings").append(warnings.length ? make("ul", { class: "warnings" }, ...warnings) : make("p", { class: "note" }, none));
    this.checkTable();
    byId("deck").textContent = result.deck;
    const notes = [`${counted(result.frames)} of ${counted(result.framesInFile)} frames`];
    if (this.version) notes.unshift(this.version);
    byId("about").textContent = notes.join(" · ");
  }

  checkTable() {
    const { checks } = this.result;
    const head = ["check", "largest", "bound", "increment", "time"].map((text) => make("th", { scope: "col" }, text));
    const rows = checks.map((check) => {
      const go = () => this.player.go(this.result.nearestFrame(check.time));
      const time = make("button", { type: "button", class: "link", onclick: go, title: "show this time" }, number(check.time));
      const where = check.largest > 0 ? [String(check.increment), time] : ["–", "–"];
      return make("tr", {}, make("th", { scope: "row" }, check.text), make("td", {}, check.largest > 0 ? check.largest.toExponential(1) : "0"), make("td", {}, check.bound?.toExponential(0) ?? "–"), ...where.map((each) => make("td", {}, each)));
    });
    const { certificate } = this.result;
    byId("checks").append(make("p", { class: "note" }, `Certificate, from the file alone: ${certificate}.`));
    byId("checks").append(make("table", { class: "checks" }, make("thead", {}, make("tr", {}, ...head)), make("tbody", {}, ...rows)));
  }
}

/** A canvas as a picture for paper. */
function printed(canvas) {
  return make("img", { class: "printed", alt: "", src: canvas.toDataURL("image/png") });
}

/** A duration in words. */
function duration(seconds) {
  if (seconds < 60) return `${number(seconds, 3)} s`;
  if (seconds < 3600) return `${number(seconds / 60, 3)} min`;
  return `${number(seconds / 3600, 3)} h`;
}

window.page = new Page(JSON.parse(byId("data").textContent));
window.page.start().catch((error) => {
  byId("failure").hidden = false;
  byId("failure").textContent = `This page cannot be shown: ${error.message}`;
  console.error(error);
});
