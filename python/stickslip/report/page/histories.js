// The charts of the page: forces against displacements, energies, momenta, contact forces, work of the solver, surfaces, nodes, any history.

/** Curves of histories by name for a result and what is laid over it. */
async function curves(page, wanted) {
  const series = [];
  let colour = 0;
  for (const { name, column = 0, label, each = null } of wanted) {
    for (const [k, histories] of page.histories.entries()) {
      if (!histories.has(name)) continue;
      let values = await histories.column(name, column);
      if (each) values = values.map((value) => (value === null ? null : each(value)));
      series.push({ label: k > 0 ? `${label}, other` : label, values, x: histories.time, colour, dash: k > 0 });
    }
    colour++;
  }
  return { series, x: page.histories[0].time, note: page.other ? `Dashed: ${page.other.job}.` : undefined };
}

/** Axis text: a name and the dimension. */
function axisText(text, dimension) {
  const of = dimensionText(dimension);
  return of ? `${text} (${of})` : text;
}

/** Histories of names that are not 0 in every result. */
function present(page, names) {
  return names.filter((name) => page.histories.some((each) => each.has(name) && !each.zero(name)));
}

/** Forces against the displacements in their directions, and both over the time; the largest work first. */
function forceChart(page) {
  const { pairs } = page.result;
  if (pairs.length === 0) return null;
  const made = async (pair, x, y) => {
    const series = [];
    for (const [k, result] of page.results.entries()) {
      const found = result.pairs.find((each) => each.name === pair.name && each.titles[1] === pair.titles[1]);
      if (!found) continue;
      found.loading ??= unpacked(found.values);
      const values = await found.loading;
      const column = (at) => Array.from({ length: found.values.rows }, (_, row) => values[3 * row + at]);
      series.push({ label: k > 0 ? "other" : result.job, values: column(y), x: column(x), colour: 0, dash: k > 0, times: column(0) });
    }
    const note = page.other ? `Dashed: ${page.other.job}.` : "";
    return { series, x: series[0].x, axis: pair.titles[y - 1], along: x > 0 ? pair.titles[x - 1] : undefined, way: x > 0, note };
  };
  const variants = pairs.map((pair) => ({ name: `${pair.name}: force against displacement`, make: () => made(pair, 1, 2) }));
  for (const pair of pairs) {
    variants.push({ name: `${pair.name}: force`, make: () => made(pair, 0, 2) });
    variants.push({ name: `${pair.name}: displacement`, make: () => made(pair, 0, 1) });
  }
  return new Chart(page, "Force and displacement", variants);
}

function energyChart(page) {
  const names = page.histories[0].under("energy/").filter((name) => name !== "energy/balance");
  const wanted = (chosen) => present(page, chosen).map((name) => ({ name, label: words(name) }));
  const lost = names.filter((name) => !/kinetic|strain|external/.test(name));
  const bodies = page.results[0].bodies;
  const variants = [
    ["all accounts", names],
    ["stored and put in", ["energy/kinetic", "energy/strain", "energy/external_work"]],
    ["what has left the bodies", lost],
  ];
  const made = variants
    .filter(([, chosen]) => present(page, chosen).length)
    .map(([name, chosen]) => ({ name, make: async () => ({ ...(await curves(page, wanted(chosen))), axis: "energy" }) }));
  for (const part of ["kinetic", "strain"]) {
    if (bodies < 2 || bodies > 8) break;
    const each = Array.from({ length: bodies }, (_, body) => ({ name: `bodies/${part}`, column: body, label: `body ${body}` }));
    made.push({ name: `${part} energy of the bodies`, make: async () => ({ ...(await curves(page, each)), axis: "energy" }) });
  }
  const chart = new Chart(page, "Energies", made);
  if (page.results[0].histories.thinned) {
    chart.note.textContent = "Long run: every curve shows the smallest and the largest value of equal groups of increments.";
  }
  return chart;
}

function momentumChart(page) {
  if (present(page, page.histories[0].under("momentum/")).length === 0) return null; // of static steps
  const linear = page.result.axes.map((axis, column) => ({ name: "momentum/linear", column, label: `linear, ${axis}` }));
  const angular = [{ name: "momentum/angular", label: "angular" }];
  return new Chart(page, "Momenta", [
    { name: "linear", make: async () => ({ ...(await curves(page, linear)), axis: axisText("momentum", page.histories[0].dimension("momentum/linear")) }) },
    { name: "angular, about the origin", make: async () => ({ ...(await curves(page, angular)), axis: axisText("momentum", page.histories[0].dimension("momentum/angular")) }) },
  ]);
}

/** Names of the contacts of a result. */
function contactsOf(page) {
  return [...new Set(page.histories[0].under("contact/").map((name) => name.split("/")[1]))];
}

function contactChart(page) {
  const contacts = contactsOf(page);
  if (contacts.length === 0) return null;
  const variants = [];
  if (contacts.length > 1) {
    const normal = contacts.map((contact) => ({ name: `contact/${contact}/normal`, label: contact }));
    variants.push({ name: "normal forces of all contacts", make: async () => ({ ...(await curves(page, normal)), axis: "force" }) });
  }
  for (const contact of contacts) {
    const at = (name) => `contact/${contact}/${name}`;
    const forces = [
      { name: at("normal"), label: "normal" },
      { name: at("tangential"), label: "tangential" },
    ];
    const parts = page.result.axes.map((axis, column) => ({ name: at("force"), column, label: `force, ${axis}` }));
    const pairs = ["closed", "sticking"].map((name) => ({ name: at(name), label: name }));
    const gap = [{ name: at("min_gap"), label: "smallest gap" }];
    for (const [text, wanted, axis] of [["normal and tangential", forces, "force"], [`force in ${page.result.axes.join(" and ")}`, parts, "force"], ["pairs in contact", pairs, "pairs"], ["smallest gap", gap, "length"]]) {
      variants.push({ name: `${contact}: ${text}`, make: async () => ({ ...(await curves(page, wanted)), axis }) });
    }
  }
  return new Chart(page, "Contact", variants);
}

function solverChart(page) {
  const work = ["solver/lcp_size", "solver/pivots", "solver/active_set_iterations", "solver/factorizations"];
  const checks = page.results[0].checks.map(({ name }) => name);
  const named = (names) => present(page, names).map((name) => ({ name, label: words(name) }));
  const size = (value) => Math.abs(value) || null;
  const variants = [
    { name: "passes of an increment", make: async () => ({ ...(await curves(page, [{ name: "solver/passes", label: "passes" }])), axis: "passes" }) },
    { name: "length of an increment", make: async () => ({ ...(await curves(page, [{ name: "dt", label: "increment" }])), axis: "time" }) },
    { name: "complementarity problems", make: async () => ({ ...(await curves(page, named(work))), axis: "count" }) },
    {
      name: "checks",
      make: async () => {
        const wanted = present(page, checks).map((name) => ({ name, label: words(name), each: size }));
        return { ...(await curves(page, wanted)), axis: "error", log: true };
      },
    },
  ];
  return new Chart(page, "Solver", variants);
}

/** Contact pressure along a surface in the frame, and the largest of all frames. */
function surfaceChart(page) {
  const surfaces = page.results[0].surfaces.filter((surface) => surface.largest > 0);
  if (surfaces.length === 0) return null;
  const pressure = (result, surface, frame) => {
    const field = result.field("CONTACT_PRESSURE");
    return surface.nodes.map((node) => field?.value(frame, node) || 0);
  };
  const largest = (result, surface) => {
    const most = surface.nodes.map(() => 0);
    for (let frame = 0; frame < result.frames; frame++) {
      pressure(result, surface, frame).forEach((value, i) => (most[i] = Math.max(most[i], value)));
    }
    return most;
  };
  const same = (surface) => page.other?.surfaces.find((each) => each.name === surface.name && each.nodes.length);
  const now = (surface, frame) => {
    const own = { label: "now", values: pressure(page.result, surface, frame), x: surface.along, colour: 0, points: surface.nodes.length < 80 };
    const laid = same(surface);
    if (!laid) return [own];
    const at = page.other.nearestFrame(page.result.times[frame]);
    return [own, { label: "now, other", values: pressure(page.other, laid, at), x: laid.along, colour: 1, dash: true }];
  };
  const variants = surfaces.map((surface) => ({
    name: `${surface.name} (node ${page.result.mesh.nodeLabels[surface.nodes[0]]} to ${page.result.mesh.nodeLabels[surface.nodes.at(-1)]})`,
    make: async () => {
      const most = { label: "largest of all frames", values: largest(page.result, surface), x: surface.along, colour: 0, faint: true };
      const series = [most, ...now(surface, page.view.frame)];
      const note = same(surface) ? `Dashed: ${page.other.job}.` : undefined;
      return { series, note, x: surface.along, axis: "pressure (force/length²)", along: "way along the undeformed surface (length)", surface };
    },
  }));
  const chart = new Chart(page, "Contact pressure along a surface", variants);
  page.view.on(() => {
    if (!chart.made?.surface) return;
    if (same(chart.made.surface)) {
      chart.build();
      return;
    }
    chart.setValues([chart.plot.data[1], now(chart.made.surface, page.view.frame)[0].values]);
    chart.plot.redraw(false);
  });
  return chart;
}

/** Fields of the chosen nodes over the frames. */
function nodeChart(page) {
  const quantities = page.result.scalars.map((scalar) => scalar.nodal ?? scalar).filter((scalar) => scalar.at === "nodes");
  const variants = quantities.map((scalar) => ({
    name: scalar.label,
    make: async () => {
      await scalar.field.load();
      const series = page.view.picked.map((node, colour) => ({
        label: `node ${page.result.mesh.nodeLabels[node]}`,
        values: page.result.times.map((_, frame) => {
          const value = scalar.value(frame, node);
          return Number.isFinite(value) ? value : null;
        }),
        x: page.result.times,
        colour,
        points: page.result.frames < 60,
      }));
      const note = series.length ? `From the ${page.result.frames} frames.` : "Click a node in the picture, or give its number.";
      return { series: series.length ? series : [{ label: "", values: page.result.times.map(() => null), colour: 0 }], x: page.result.times, axis: axisText(scalar.label, scalar.field.dimension), note, empty: series.length === 0 };
    },
  }));
  const chart = new Chart(page, "Chosen nodes", variants);
  const start = quantities.findIndex((scalar) => scalar.id === "U:y");
  chart.select.value = String(Math.max(start, 0));
  const input = make("input", { type: "text", inputmode: "numeric", placeholder: "node", size: 6, "aria-label": "number of a node" });
  const add = () => {
    const node = page.result.mesh.nodeLabels.indexOf(Number(input.value));
    input.setCustomValidity(node < 0 || !input.value ? "there is no node of this number" : "");
    if (!input.reportValidity()) return;
    page.pick(node, true);
    input.value = "";
  };
  input.addEventListener("keydown", (event) => event.key === "Enter" && add());
  input.addEventListener("input", () => input.setCustomValidity(""));
  chart.tools.append(input, make("button", { type: "button", onclick: add }, "add"), make("button", { type: "button", onclick: () => page.unpick() }, "clear"));
  return chart;
}

/** The column of a history that is shown first: the second, or one that changes. */
async function columnOf(histories, name) {
  const columns = histories.columns(name).slice(0, 20).map((_, column) => column);
  const order = columns.length > 1 ? [1, 0, ...columns.slice(2)] : columns;
  for (const column of order) if ((await histories.column(name, column)).some((value, _, all) => value !== all[0])) return column;
  return order[0];
}

/** Any history of the file, against the time or any other. */
function anyChart(page) {
  const histories = page.histories[0];
  const groups = new Map();
  for (const name of histories.byName.keys()) {
    const group = name.includes("/") ? name.slice(0, name.lastIndexOf("/")) : "increments";
    if (!groups.has(group)) groups.set(group, []);
    histories.columns(name).slice(0, 400).forEach((text, column) => {
      groups.get(group).push([`${name}|${column}`, text ? `${words(name)}: ${text}` : words(name)]);
    });
  }
  const chosen = [];
  const start = ["rigid/", "nodes/", "bodies/center"].map((each) => histories.under(each).find((name) => !histories.zero(name) && !/node$/.test(name))).find(Boolean);
  let ready = null;
  const described = (id) => {
    const [name, column] = [id.slice(0, id.lastIndexOf("|")), Number(id.slice(id.lastIndexOf("|") + 1))];
    const text = histories.columns(name)[column];
    const short = name.split("/").slice(-2).join("/");
    return { name, column, label: text ? `${short}: ${text}` : short };
  };
  const across = make("select", { "aria-label": "abscissa" });
  const make_ = async () => {
    ready ??= start && columnOf(histories, start).then((column) => chosen.push(`${start}|${column}`));
    await ready;
    const wanted = chosen.map(described);
    const made = await curves(page, wanted);
    const dimensions = [...new Set(wanted.map(({ name }) => histories.dimension(name)))];
    if (made.series.length === 0) made.series.push({ label: "", values: Array.from(histories.time, () => null), colour: 0 });
    const axis = dimensions.map(dimensionText).join(", ");
    if (!across.value) return { ...made, axis };
    const { name, column, label } = described(across.value);
    const columns = new Map();
    for (const each of page.histories) columns.set(each.time, await each.column(name, column));
    for (const each of made.series) Object.assign(each, { times: each.x ?? made.x, x: columns.get(each.x ?? made.x) });
    return { ...made, axis, x: columns.get(made.x), way: true, along: axisText(label, histories.dimension(name)) };
  };
  const chart = new Chart(page, "Any history", [{ name: "", make: make_ }], "Choosing a history adds its curve; every increment is in it.");
  const select = make("select", { "aria-label": "history to add" });
  fillSelect(select, [["", [["", "add a history ..."]]], ...groups]);
  fillSelect(across, [["", [["", "against the time"]]], ...[...groups].map(([group, each]) => [group, each.map(([id, text]) => [id, `against ${text}`])])]);
  across.addEventListener("change", () => chart.build());
  select.addEventListener("change", () => {
    if (select.value && !chosen.includes(select.value)) chosen.push(select.value);
    select.value = "";
    chart.build();
  });
  chart.tools.append(select, across, make("button", { type: "button", onclick: () => (chosen.splice(0), chart.build()) }, "clear"));
  return chart;
}
