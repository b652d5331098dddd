//! Writes initial velocities and steps; the cards of a step change the loads of the step before into the loads of the
//! step.

use super::lines::{DeckWriter, name, named, number, set};
use super::model::{Interactions, elements_field, friction, pair_row};
use crate::model::{
    ALL_EXTERIOR, Amplitude, BodyForce, CentrifugalForce, ContactChanges, Frames, HistorySet,
    Incrementation, Increments, Interference, Load, Model, NamedSets, NodalVariable,
    NodeTemperature, PointLoad, Pressure, Procedure, Rate, Scheme, Settings, Step, Support,
    SupportMotion, TimeBase, Traction, Variation,
};
use crate::reader::{self, carried_loads, carried_temperatures};
use crate::vectors::difference;
use std::collections::HashMap;

/// Number of times on a data line.
const TIMES: usize = 8;

/// Writes initial velocities and all steps.
pub(super) fn write(model: &Model, lines: &mut DeckWriter) {
    initial_velocity(model, lines);
    initial_temperature(model, lines);
    for (index, step) in model.steps.iter().enumerate() {
        time_points(index, step, lines);
    }
    let mut supports = Vec::new();
    let mut loads = LoadCards::default();
    let mut contacts = &ContactChanges::default();
    let mut temperatures = Vec::new();
    for (index, step) in model.steps.iter().enumerate() {
        let now = LoadCards::of(step, model);
        let ramps = now.ramp() || step.contacts.ramp() || step.temperatures.iter().any(Load::ramps);
        head(step, model, ramps, lines);
        settings(&step.settings, lines);
        write_supports(&step.supports, &supports, model, lines);
        now.write((&loads, ramps), model, lines);
        let before = index.checked_sub(1).map(|before| &model.steps[before]);
        write_interferences(step, before, model, lines);
        write_temperatures(&step.temperatures, &temperatures, model, lines);
        contact_changes([contacts, &step.contacts], model, lines);
        contacts = &step.contacts;
        requests(index, step, model, lines);
        lines.card("END STEP", []);
        supports = carried(&step.supports, step, &model.amplitudes);
        loads = LoadCards::of(&carried_loads(step, &model.amplitudes), model);
        temperatures = carried_temperatures(
            &step.temperatures,
            &model.initial_temperature,
            step.increments.period,
            &model.amplitudes,
        );
    }
}

fn initial_velocity(model: &Model, lines: &mut DeckWriter) {
    let velocity = model.initial_velocity.iter().enumerate();
    let moving: Vec<(usize, &f64)> = velocity.filter(|(_, v)| **v != 0.0).collect();
    if !moving.is_empty() {
        lines.card("INITIAL CONDITIONS", [set("TYPE", "VELOCITY")]);
    }
    for (dof, &value) in moving {
        lines.row(dof_fields(dof, model).into_iter().chain([number(value)]));
    }
}

fn initial_temperature(model: &Model, lines: &mut DeckWriter) {
    if model.initial_temperature.is_empty() {
        return;
    }
    lines.card("INITIAL CONDITIONS", [set("TYPE", "TEMPERATURE")]);
    let labels = model.mesh.node_labels.iter();
    for (label, &value) in labels.zip(&model.initial_temperature) {
        lines.row([label.to_string(), number(value)]);
    }
}

/// Writes the temperatures that differ from the temperatures carried over from the step before. If no prescribed
/// temperature is left and temperatures do not ramp, a card without rows returns all nodes to their initial
/// temperature.
fn write_temperatures(
    now: &[Load<NodeTemperature>],
    carried: &[Load<NodeTemperature>],
    model: &Model,
    lines: &mut DeckWriter,
) {
    let is_kept = |load: &Load<NodeTemperature>| now.iter().any(|other| other.at == load.at);
    let is_new = !carried.iter().all(is_kept);
    let changed: Vec<&Load<NodeTemperature>> = match is_new {
        true => now.iter().collect(),
        false => now.iter().filter(|load| !carried.contains(load)).collect(),
    };
    if is_new && changed.is_empty() {
        lines.card("TEMPERATURE", [set("OP", "NEW")]);
    }
    let amplitude = |load: &Load<NodeTemperature>| match load.variation {
        Variation::Amplitude(index) => Some(index),
        Variation::Constant | Variation::Ramp { .. } => None,
    };
    for alike in changed.chunk_by(|a, b| amplitude(a) == amplitude(b)) {
        let operation = is_new.then(|| set("OP", "NEW"));
        let curve =
            amplitude(alike[0]).map(|index| named("AMPLITUDE", &model.amplitudes[index].name));
        lines.card("TEMPERATURE", operation.into_iter().chain(curve));
        for load in alike {
            let label = model.mesh.node_labels[load.at.node];
            lines.row([label.to_string(), number(load.magnitude)]);
        }
    }
}

fn dof_fields(dof: usize, model: &Model) -> [String; 2] {
    let mut bodies = model.rigid_bodies.iter();
    if let Some(body) = bodies.find(|body| model.angle_of(body) == dof) {
        let label = model.mesh.node_labels[body.reference];
        return [label.to_string(), "6".to_owned()];
    }
    let label = model.mesh.node_labels[dof / 2];
    [label.to_string(), (dof % 2 + 1).to_string()]
}

/// Writes `*STEP` and its procedure.
fn head(step: &Step, model: &Model, ramps: bool, lines: &mut DeckWriter) {
    let mut parameters = vec!["NLGEOM".to_owned()];
    parameters.extend(step.name.as_ref().map(|name| named("NAME", name)));
    let amplitude = match step.procedure {
        Procedure::Dynamic => ramps.then_some("RAMP"),
        Procedure::QuasiStatic | Procedure::Static => (!ramps).then_some("STEP"),
    };
    parameters.extend(amplitude.map(|amplitude| set("AMPLITUDE", amplitude)));
    lines.card("STEP", parameters);
    let Increments {
        dt,
        period,
        dt_min,
        dt_max,
        incrementation,
    } = step.increments;
    let (procedure, application) = match step.procedure {
        Procedure::Dynamic => ("DYNAMIC", None),
        Procedure::QuasiStatic => ("DYNAMIC", Some(set("APPLICATION", "QUASI-STATIC"))),
        Procedure::Static => ("STATIC", None),
    };
    let direct = matches!(incrementation, Incrementation::Fixed).then(|| "DIRECT".to_owned());
    let scale = match incrementation {
        Incrementation::Error { tolerance } if tolerance != reader::TRUNCATION_ERROR => {
            let factor = tolerance / reader::tolerance_of_factor(!model.contacts.is_empty());
            Some(set("HALFINC SCALE FACTOR", number(factor)))
        }
        _ => None,
    };
    let count = if direct.is_some() { 3 } else { 4 };
    let parameters = direct.into_iter().chain(application).chain(scale);
    lines.card(procedure, parameters);
    let times = [dt, period, dt_min, dt_max].into_iter();
    lines.row(times.take(count).map(number));
}

/// Writes the cards for changes of contacts between one step and the next.
fn contact_changes([before, now]: [&ContactChanges; 2], model: &Model, lines: &mut DeckWriter) {
    let interactions = Interactions::new(&model.contacts);
    let mut written = Vec::new();
    for (index, contact) in model.contacts.iter().enumerate() {
        let own = &contact.interaction;
        let changes = [before, now].map(|changes| {
            let mut of_step = changes.friction.iter();
            of_step.find(|change| change.contact == index)
        });
        let [before, now] = changes
            .map(|change| change.map_or(own.friction.clone(), |change| change.friction.clone()));
        if before == now || written.contains(own) {
            continue;
        }
        written.push(own.clone());
        let former = changes[1].and_then(|change| change.from.as_ref());
        let amplitude = former.and_then(|from| from.amplitude);
        let amplitude = amplitude.map(|index| named("AMPLITUDE", &model.amplitudes[index].name));
        let parameter = set("INTERACTION", interactions.name(own));
        let is_reset = now == own.friction;
        let reset = is_reset.then(|| "RESET".to_owned());
        let parameters = [parameter].into_iter().chain(amplitude).chain(reset);
        lines.card("CHANGE FRICTION", parameters);
        if !is_reset {
            friction(&now, lines);
        }
    }
    for (operation, [in_first, in_second]) in [
        ("REMOVE", [&now.removed, &before.removed]),
        ("ADD", [&before.removed, &now.removed]),
    ] {
        let changed = in_first.iter().filter(|index| !in_second.contains(index));
        let changed: Vec<usize> = changed.copied().collect();
        if changed.is_empty() {
            continue;
        }
        let kind = set("TYPE", "CONTACT PAIR");
        lines.card("MODEL CHANGE", [kind, operation.to_owned()]);
        for index in changed {
            pair_row(&model.contacts[index], model, lines);
        }
    }
}

fn settings(settings: &Settings, lines: &mut DeckWriter) {
    let Settings {
        scheme,
        impact,
        impact_time,
        landing,
        contact_mass,
        lcp,
        factorization,
        solver,
        tolerance,
        max_passes,
        is_check_only,
    } = *settings;
    if is_check_only {
        lines.card("NO ANALYSIS", []);
    }
    let mut parameters = match scheme {
        Scheme::EnergyMomentum => vec![set("SCHEME", "ENERGY-MOMENTUM")],
        Scheme::Ss22 { theta1, theta2 } => vec![
            set("SCHEME", "SS22"),
            set("THETA1", number(theta1)),
            set("THETA2", number(theta2)),
        ],
    };
    parameters.extend([
        reader::IMPACT.written(impact),
        reader::IMPACT_TIME.written(impact_time),
        reader::LANDING.written(landing),
        reader::CONTACT_MASS.written(contact_mass),
        reader::LCP.written(lcp),
        reader::FACTORIZATION.written(factorization),
        reader::SOLVER.written(solver),
        set("TOLERANCE", number(tolerance)),
        set("MAX PASSES", max_passes),
    ]);
    lines.card("STICKSLIP", parameters);
}

/// Supports that a step hands on to the next step.
fn carried(supports: &[Support], step: &Step, amplitudes: &[Amplitude]) -> Vec<Support> {
    let period = step.increments.period;
    let kept = supports.iter().map(|&Support { dof, motion }| Support {
        dof,
        motion: motion.after_step(period, amplitudes),
    });
    kept.collect()
}

/// Writes the overlaps that contact pairs allow, except the overlaps that are carried over from the step before.
fn write_interferences(step: &Step, before: Option<&Step>, model: &Model, lines: &mut DeckWriter) {
    let is_pair = |load: &&Load<Interference>| {
        let contact = &model.contacts[load.at.contact];
        model.surfaces[contact.slave].name != ALL_EXTERIOR
    };
    let left = |contact: usize| {
        let before = before?;
        let mut all = before.interferences.iter();
        let load = all.find(|load| load.at.contact == contact)?;
        let curve = match load.variation {
            Variation::Amplitude(index) => Some(&model.amplitudes[index]),
            Variation::Constant | Variation::Ramp { .. } => None,
        };
        Some(match curve {
            Some(curve) if curve.time == TimeBase::Total => *load,
            Some(curve) => load.between([load.magnitude * curve.at(before.increments.period); 2]),
            None => load.between([load.magnitude; 2]),
        })
    };
    let is_given = |load: &&Load<Interference>| left(load.at.contact) != Some(**load);
    for load in step.interferences.iter().filter(is_pair).filter(is_given) {
        // without an amplitude an overlap falls to nothing
        let (amplitude, overlap) = match load.variation {
            Variation::Amplitude(index) => (Some(index), load.magnitude),
            Variation::Ramp { from } => (None, from),
            Variation::Constant => (None, load.magnitude),
        };
        let is_shrink = load.at.is_shrink;
        let amplitude = amplitude.map(|index| named("AMPLITUDE", &model.amplitudes[index].name));
        let shrink = is_shrink.then(|| "SHRINK".to_owned());
        lines.card("CONTACT INTERFERENCE", amplitude.into_iter().chain(shrink));
        let contact = &model.contacts[load.at.contact];
        let surfaces = [contact.slave, contact.master].map(|s| name(&model.surfaces[s].name));
        let overlap = (!is_shrink).then(|| number(overlap));
        lines.row(surfaces.into_iter().chain(overlap));
    }
}

/// Parameters on the keyword line of a card of supports: the derivative that the card prescribes, and the amplitude.
fn kind_of(support: &Support) -> (Option<Rate>, Option<usize>) {
    match support.motion {
        SupportMotion::Ramp { .. } => (None, None),
        SupportMotion::Amplitude { amplitude, .. } => (None, Some(amplitude)),
        SupportMotion::Rate {
            rate, amplitude, ..
        } => (Some(rate), amplitude),
    }
}

/// Writes all supports of a step if any support differs from the step before.
fn write_supports(now: &[Support], carried: &[Support], model: &Model, lines: &mut DeckWriter) {
    if now == carried {
        return;
    }
    let amplitudes = || std::iter::once(None).chain((0..model.amplitudes.len()).map(Some));
    let rates = [None, Some(Rate::Velocity), Some(Rate::Acceleration)];
    let kinds = rates
        .iter()
        .flat_map(|&rate| amplitudes().map(move |a| (rate, a)));
    let mut operation = (!carried.is_empty()).then(|| set("OP", "NEW"));
    if now.is_empty() {
        lines.card("BOUNDARY", operation.clone());
    }
    for (rate, amplitude) in kinds {
        let is_own = |s: &&Support| kind_of(s) == (rate, amplitude);
        let of_card: Vec<&Support> = now.iter().filter(is_own).collect();
        if of_card.is_empty() {
            continue;
        }
        let rate = rate.map(|rate| match rate {
            Rate::Velocity => set("TYPE", "VELOCITY"),
            Rate::Acceleration => set("TYPE", "ACCELERATION"),
        });
        let name = amplitude.map(|index| named("AMPLITUDE", &model.amplitudes[index].name));
        let parameters = operation.take().into_iter().chain(rate).chain(name);
        lines.card("BOUNDARY", parameters);
        let alike = |a: &&Support, b: &&Support| a.dof / 2 == b.dof / 2 && a.motion == b.motion;
        for supports in of_card.chunk_by(alike) {
            support_row(supports, model, lines);
        }
    }
}

/// Supports of a node that have the same motion in one or both directions.
fn support_row(supports: &[&Support], model: &Model, lines: &mut DeckWriter) {
    let (Some(first), Some(last)) = (supports.first(), supports.last()) else {
        return;
    };
    let (SupportMotion::Ramp { to: value }
    | SupportMotion::Amplitude { value, .. }
    | SupportMotion::Rate { value, .. }) = first.motion;
    let [label, direction] = dof_fields(first.dof, model);
    let [_, to] = dof_fields(last.dof, model);
    lines.row([label, direction, to, number(value)]);
}

/// Name of the list of times at which a step writes its frames.
fn times_name(index: usize) -> String {
    format!("TIMES-{}", index + 1)
}

fn time_points(index: usize, step: &Step, lines: &mut DeckWriter) {
    let Frames::Times(times) = &step.frames else {
        return;
    };
    lines.card("TIME POINTS", [set("NAME", times_name(index))]);
    // frames are written after the start only: this time stands for an empty list
    let times = if times.is_empty() { &[0.0][..] } else { times };
    for times in times.chunks(TIMES) {
        lines.row(times.iter().copied().map(number));
    }
}

/// Writes the times of the frames; in the first step also the fields written on request, the sets of the history output
/// and the dofs in the status file.
fn requests(index: usize, step: &Step, model: &Model, lines: &mut DeckWriter) {
    let when = match &step.frames {
        Frames::Default => None,
        Frames::Count(count) => Some(set("NUMBER INTERVAL", count)),
        Frames::Every(interval) => Some(set("TIME INTERVAL", number(*interval))),
        Frames::Increments(count) => Some(set("FREQUENCY", count)),
        Frames::Times(_) => Some(set("TIME POINTS", times_name(index))),
    };
    if let Some(when) = when {
        lines.card("OUTPUT", ["FIELD".to_owned(), when]);
    }
    for restart in model.restarts.iter().filter(|r| r.from_step == index + 1) {
        let mut parameters = vec!["WRITE".to_owned(), set("FREQUENCY", restart.every)];
        parameters.extend((!restart.keeps_all).then(|| "OVERLAY".to_owned()));
        lines.card("RESTART", parameters);
    }
    if index == 0 {
        histories(&model.sets, lines);
        for &dof in &model.sets.monitored {
            let [node, direction] = dof_fields(dof, model);
            lines.card("MONITOR", [set("NODE", node), set("DOF", direction)]);
        }
    }
}

fn histories(sets: &NamedSets, lines: &mut DeckWriter) {
    let asked = &sets.fields;
    if asked.concentrated_load {
        lines.card("NODE FILE", []);
        lines.row(["CF".to_owned()]);
    }
    let of_elements = [
        (asked.energy_density, "ENER"),
        (asked.logarithmic_strain, "LE"),
        (asked.principal_stress, "SP"),
        (asked.pressure, "PRESS"),
        (asked.plastic_strain, "PEEQ"),
    ];
    let of_elements = of_elements.iter().filter(|(is_asked, _)| *is_asked);
    let names: Vec<String> = of_elements.map(|(_, name)| (*name).to_owned()).collect();
    if !names.is_empty() {
        lines.card("EL FILE", []);
        lines.row(names);
    }
    let at_nodes = NodalVariable::ALL
        .iter()
        .filter(|(v, _)| asked.at_nodes.contains(v));
    let names: Vec<String> = at_nodes.map(|(_, name)| (*name).to_owned()).collect();
    if !names.is_empty() {
        lines.card("EL FILE", [set("POSITION", "NODES")]);
        lines.row(names);
    }
    let totals = |asked: &HistorySet| set("TOTALS", if asked.each_member { "YES" } else { "ONLY" });
    for asked in &sets.history {
        let name = named("NSET", &sets.nodes[asked.set].name);
        lines.card("NODE PRINT", [name, totals(asked)]);
        lines.row(["U", "V", "RF"].map(str::to_owned));
    }
    for asked in &sets.element_history {
        let name = named("ELSET", &sets.elements[asked.set].name);
        let places = [
            (!asked.at_points && !asked.at_nodes, None),
            (asked.at_points, Some("INTEGRATION POINTS")),
            (asked.at_nodes, Some("NODES")),
        ];
        for (_, place) in places.into_iter().filter(|(is_asked, _)| *is_asked) {
            let [name, totals] = [name.clone(), totals(asked)];
            match place {
                None => lines.card("EL PRINT", [name, totals]),
                Some(place) => lines.card("EL PRINT", [name, totals, set("POSITION", place)]),
            }
            lines.row(["S", "E", "ENER", "ELSE", "ELKE", "EVOL"].map(str::to_owned));
        }
    }
}

/// A load as the fields of a data line.
#[derive(Clone, PartialEq)]
struct LoadLine {
    /// Loaded element, for body forces.
    element: Option<usize>,
    /// Label of the loaded node, or of the element of a loaded face; empty for body forces.
    target: String,
    /// Fields of the loaded dof or face.
    kind: String,
    /// Fields behind the magnitude.
    direction: Vec<String>,
    /// Whether the load is a traction.
    is_traction: bool,
    magnitude: f64,
    variation: Variation,
}

/// Cards of the keywords `*CLOAD` and `*DLOAD`.
#[derive(Default)]
pub(super) struct LoadCards([Vec<LoadLine>; 2]);

impl LoadCards {
    /// Loads of a step, and loads carried over from the step before.
    pub fn of(step: &Step, model: &Model) -> LoadCards {
        let points = step.point_loads.iter().map(|load| point_load(load, model));
        let bodies = step.body_forces.iter().map(body_force);
        let turned = step.centrifugal_forces.iter();
        let turned = turned.map(|load| centrifugal_force(load, model));
        let pressures = step.pressures.iter().map(|load| pressure(load, model));
        let tractions = step.tractions.iter().map(|load| traction(load, model));
        LoadCards([
            points.collect(),
            (bodies.chain(turned))
                .chain(pressures)
                .chain(tractions)
                .collect(),
        ])
    }

    /// Whether loads grow over the step (`*STEP, AMPLITUDE=RAMP`).
    pub fn ramp(&self) -> bool {
        let mut all = self.0.iter().flatten();
        all.any(|entry| matches!(entry.variation, Variation::Ramp { .. }))
    }

    /// Writes the cards of a step that begins with the loads `carried` from the step before.
    pub fn write(
        &self,
        (carried, ramps): (&LoadCards, bool),
        model: &Model,
        lines: &mut DeckWriter,
    ) {
        let families = self.0.iter().zip(&carried.0);
        for (keyword, (now, carried)) in ["CLOAD", "DLOAD"].into_iter().zip(families) {
            if now == carried {
                continue;
            }
            // Where loads ramp, OP=NEW would fade those that stay.
            let is_new = !carried.is_empty() && !ramps;
            let operation = is_new.then(|| set("OP", "NEW"));
            let entries = match is_new {
                true => now.clone(),
                false => at_changed_places(now, carried),
            };
            write_cards(keyword, operation, &grouped(entries, model), model, lines);
        }
    }
}

/// Place of a load: its element or target, and the loaded dof or face.
type Key<'e> = (Option<usize>, &'e str, &'e str);

impl LoadLine {
    fn key(&self) -> Key<'_> {
        (self.element, &self.target, &self.kind)
    }

    fn new<T>(target: String, kind: impl Into<String>, load: &Load<T>) -> LoadLine {
        LoadLine {
            element: None,
            target,
            kind: kind.into(),
            direction: Vec::new(),
            is_traction: false,
            magnitude: load.magnitude,
            variation: load.variation,
        }
    }

    fn amplitude(&self) -> Option<usize> {
        match self.variation {
            Variation::Amplitude(index) => Some(index),
            Variation::Constant | Variation::Ramp { .. } => None,
        }
    }
}

fn point_load(load: &Load<PointLoad>, model: &Model) -> LoadLine {
    let PointLoad { dof } = load.at;
    let [label, direction] = dof_fields(dof, model);
    LoadLine::new(label, direction, load)
}

fn body_force(load: &Load<BodyForce>) -> LoadLine {
    let BodyForce {
        element,
        direction,
        per_mass,
    } = load.at;
    let kind = match (per_mass, direction[0] != 0.0) {
        (true, _) => "GRAV",
        (false, true) => "BX",
        (false, false) => "BY",
    };
    LoadLine {
        element: Some(element),
        direction: if per_mass {
            direction.map(number).to_vec()
        } else {
            Vec::new()
        },
        ..LoadLine::new(String::new(), kind, load)
    }
}

fn centrifugal_force(load: &Load<CentrifugalForce>, model: &Model) -> LoadLine {
    let CentrifugalForce { element, axis } = load.at;
    let direction = match model.mesh.elements[element].element_type.is_ring() {
        true => ["0.", "1.", "0."],
        false => ["0.", "0.", "1."],
    };
    let place = axis.map(number).into_iter().chain([number(0.0)]);
    LoadLine {
        element: Some(element),
        direction: place.chain(direction.map(str::to_owned)).collect(),
        ..LoadLine::new(String::new(), "CENTRIF", load)
    }
}

fn pressure(load: &Load<Pressure>, model: &Model) -> LoadLine {
    let Pressure { face, is_shear } = load.at;
    let (mesh, side) = (&model.mesh, face.side + 1);
    let label = mesh.elements[face.element].label.to_string();
    if !is_shear {
        return LoadLine::new(label, format!("P{side}"), load);
    }
    let [from, to] = face.ends(mesh).map(|node| mesh.coordinates[node]);
    LoadLine {
        direction: difference(from, to).map(number).to_vec(),
        ..LoadLine::new(label, format!("TRSHR{side}"), load)
    }
}

fn traction(load: &Load<Traction>, model: &Model) -> LoadLine {
    let Traction { face, direction } = load.at;
    let label = model.mesh.elements[face.element].label;
    LoadLine {
        direction: direction.map(number).to_vec(),
        is_traction: true,
        ..LoadLine::new(label.to_string(), format!("TRVEC{}", face.side + 1), load)
    }
}

/// All loads of the places whose loads differ from the step before: a load that ramps replaces all earlier loads of its
/// place.
fn at_changed_places(entries: &[LoadLine], carried: &[LoadLine]) -> Vec<LoadLine> {
    let (now, before) = (by_key(entries), by_key(carried));
    let is_changed = |entry: &&LoadLine| {
        let key = entry.key();
        now.get(&key) != before.get(&key)
    };
    entries.iter().filter(is_changed).cloned().collect()
}

fn by_key(entries: &[LoadLine]) -> HashMap<Key<'_>, Vec<&LoadLine>> {
    let mut by_key: HashMap<Key, Vec<&LoadLine>> = HashMap::new();
    for entry in entries {
        by_key.entry(entry.key()).or_default().push(entry);
    }
    by_key
}

/// Cards in which equal body forces share one entry, if these forces act on all elements or on a set.
fn grouped(entries: Vec<LoadLine>, model: &Model) -> Vec<LoadLine> {
    let mut groups: Vec<(LoadLine, Vec<usize>)> = Vec::new();
    let mut rest = Vec::new();
    for entry in entries {
        let Some(element) = entry.element else {
            rest.push(entry);
            continue;
        };
        let alike = LoadLine {
            element: None,
            ..entry
        };
        match groups.iter_mut().find(|(known, _)| *known == alike) {
            Some((_, elements)) => elements.push(element),
            None => groups.push((alike, vec![element])),
        }
    }
    let written = groups.into_iter().flat_map(|(entry, elements)| {
        let field = elements_field(&elements, model);
        let targets = field.map_or_else(
            || {
                elements
                    .iter()
                    .map(|&e| model.mesh.elements[e].label.to_string())
                    .collect()
            },
            |field| vec![field],
        );
        targets.into_iter().map(move |target| LoadLine {
            target,
            ..entry.clone()
        })
    });
    written.chain(rest).collect()
}

/// Writes loads, one card for all loads with the same parameters; a card without loads removes all loads.
fn write_cards(
    keyword: &str,
    operation: Option<String>,
    entries: &[LoadLine],
    model: &Model,
    lines: &mut DeckWriter,
) {
    let card = |first: Option<&LoadLine>, lines: &mut DeckWriter| {
        let amplitude = first
            .and_then(LoadLine::amplitude)
            .map(|index| &model.amplitudes[index]);
        let amplitude = amplitude.map(|amplitude| named("AMPLITUDE", &amplitude.name));
        let is_dead = first.is_some_and(|entry| entry.is_traction);
        let follower = is_dead.then(|| set("FOLLOWER", "NO"));
        let parameters = operation.iter().cloned().chain(amplitude).chain(follower);
        lines.card(keyword, parameters);
    };
    if entries.is_empty() {
        card(None, lines);
    }
    let alike = |a: &LoadLine, b: &LoadLine| {
        a.amplitude() == b.amplitude() && a.is_traction == b.is_traction
    };
    for entries in entries.chunk_by(alike) {
        card(entries.first(), lines);
        for entry in entries {
            let fields = [
                entry.target.clone(),
                entry.kind.clone(),
                number(entry.magnitude),
            ];
            lines.row(fields.into_iter().chain(entry.direction.iter().cloned()));
        }
    }
}
