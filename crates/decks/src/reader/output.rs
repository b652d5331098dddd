//! Output requests: times of frames (`*OUTPUT`, `*NODE FILE` and related keywords, `*TIME POINTS`), sets
//! of the histories (`*NODE PRINT`, `*EL PRINT`), dofs in the status file (`*MONITOR`); `*RESTART`.

use super::amplitudes::{report_long_rows, time_base};
use super::boundary::{Direction, Targets, direction};
use super::context::Context;
use super::names::Named;
use super::sets::Sets;
use crate::deck::{Card, Line, Text};
use crate::diagnostics::{Code, shown};
use crate::model::{Frames, HistorySet, NodalVariable, RequestedFields, RestartOutput, TimeBase};

/// Names of variables that the result file holds.
const WRITTEN: &[&str] = &[
    "U", "V", "A", "RF", "CF", "UT", "VT", "AT", "S11", "S22", "S33", "S12", "MISES", "E11", "E22",
    "E33", "E12", "LE11", "LE22", "LE33", "LE12", "U1", "U2", "V1", "V2", "A1", "A2", "RF1", "RF2",
    "CF1", "CF2", "S", "PEEQ", "SP", "SP1", "SP2", "SP3", "PRESS", "E", "LE", "ENER", "ELSE",
    "ELKE", "EVOL", "CSTRESS", "CDISP", "CFORCE", "CSTATUS", "CDIS", "CSTR", "CELS", "CF", "CFN",
    "CFS", "CFT", "CNUM", "CFNM", "CFSM", "CFTM", "CPRESS", "COPEN", "CSLIP1", "ALLKE", "ALLSE",
    "ALLIE", "ALLWK", "ALLFD", "ALLVD", "ETOTAL", "NT", "NT11", "TEMP",
];

/// Output requests of the deck so far.
pub(crate) struct Requests {
    points: TimePoints,
    /// Frames of the current step.
    frames: Frames,
    /// Time points in total time; the points of a step are selected when the step is built.
    total_times: Option<Vec<f64>>,
    /// Requests for histories and the status file.
    pub histories: Histories,
    /// Requests for checkpoints.
    pub restarts: Vec<RestartOutput>,
    /// Number of the step that is being read, from 1.
    pub step: usize,
}

impl Requests {
    /// The state before any request.
    pub fn new(cx: &mut Context) -> Requests {
        Requests {
            points: time_points(cx),
            frames: Frames::Default,
            total_times: None,
            histories: Histories::default(),
            restarts: Vec::new(),
            step: 1,
        }
    }

    /// `*RESTART, WRITE`: checkpoints from the current step on.
    pub fn restart(&mut self, card: &Card, cx: &mut Context) {
        if !card.has("WRITE") {
            return;
        }
        let every = match card.has("FREQUENCY") {
            true => count(card, "FREQUENCY", 0, cx),
            // at the ends of steps
            false if card.has("NUMBER INTERVAL") => Some(usize::MAX >> 1),
            false => Some(1),
        };
        let every = every.unwrap_or(0);
        self.restarts
            .retain(|earlier| earlier.from_step < self.step);
        if every > 0 || !self.restarts.is_empty() {
            self.restarts.push(RestartOutput {
                from_step: self.step,
                every,
                keeps_all: !card.has("OVERLAY"),
            });
        }
    }

    /// Reads the output cards of a step.
    pub fn cards(&mut self, cards: &[&Card], targets: Targets, cx: &mut Context) {
        let mut in_history = None;
        for card in cards {
            match (card.keyword.name, in_history) {
                ("OUTPUT", _) => in_history = self.output(card, cx),
                ("NODE PRINT", _) | ("NODE OUTPUT", Some(true)) => {
                    self.history(card, MemberKind::Nodes, targets, cx);
                }
                ("EL PRINT", _) | ("ELEMENT OUTPUT", Some(true)) => {
                    self.history(card, MemberKind::Elements, targets, cx);
                }
                ("CONTACT OUTPUT", Some(true)) => skip_sets(card),
                ("NODE OUTPUT" | "ELEMENT OUTPUT" | "CONTACT OUTPUT", Some(false)) => {
                    skip_sets(card);
                    self.histories.fields(card);
                }
                ("NODE OUTPUT" | "ELEMENT OUTPUT" | "CONTACT OUTPUT", None)
                | ("NODE FILE" | "EL FILE" | "CONTACT FILE", _) => {
                    skip_sets(card);
                    self.histories.fields(card);
                    self.when(card, cx);
                }
                ("CONTACT PRINT", _) => self.check_when(card, cx),
                ("ENERGY OUTPUT", _) => {}
                ("RESTART", _) => self.restart(card, cx),
                ("MONITOR", _) => self.histories.monitor(card, targets, cx),
                _ => continue,
            }
            report_variables(card, cx);
        }
    }

    /// Reads `*OUTPUT`; returns whether the cards below ask for histories (`true`) or for fields (`false`).
    fn output(&mut self, card: &Card, cx: &mut Context) -> Option<bool> {
        match (card.has("FIELD"), card.has("HISTORY")) {
            (true, true) => {
                let message = "FIELD and HISTORY exclude each other";
                cx.error(Code::BadValue, card.span_of("HISTORY"), message);
                None
            }
            (true, false) => {
                self.when(card, cx);
                Some(false)
            }
            (false, true) => {
                self.check_when(card, cx);
                Some(true)
            }
            (false, false) => {
                self.when(card, cx);
                None
            }
        }
    }

    /// Adds the set of a card to the histories.
    fn history(&mut self, card: &Card, family: MemberKind, targets: Targets, cx: &mut Context) {
        self.check_when(card, cx);
        self.histories.card(card, family, targets.sets, cx);
    }

    /// Sets the times of frames, if the card gives times.
    fn when(&mut self, card: &Card, cx: &mut Context) {
        let given: Vec<&str> = WHEN.into_iter().filter(|name| card.has(name)).collect();
        if let [first, second, ..] = given[..] {
            let message = format!("{first} and {second} exclude each other");
            cx.error(Code::OutputTimes, card.span_of(second), message);
            return;
        }
        let Some(&name) = given.first() else { return };
        if let Some((frames, total_times)) = self.asked(name, card, cx) {
            self.frames = frames;
            self.total_times = total_times;
        }
    }

    /// Checks the times on a card for histories; these times have no effect, because histories hold every increment.
    fn check_when(&self, card: &Card, cx: &mut Context) {
        for name in WHEN.into_iter().filter(|name| card.has(name)) {
            self.asked(name, card, cx);
        }
    }

    /// Frames that a parameter requests, and the time points that it names if these are in total time.
    fn asked(
        &self,
        name: &str,
        card: &Card,
        cx: &mut Context,
    ) -> Option<(Frames, Option<Vec<f64>>)> {
        let frames = match name {
            "FREQUENCY" => frequency(card, cx),
            "NUMBER INTERVAL" => number_interval(card, cx),
            "TIME INTERVAL" => time_interval(card, cx),
            _ => return self.at_time_points(card, cx),
        };
        Some((frames?, None))
    }

    fn at_time_points(&self, card: &Card, cx: &mut Context) -> Option<(Frames, Option<Vec<f64>>)> {
        let name = card.value("TIME POINTS")?;
        let (base, times) = self.points.find(name, cx)?;
        let total_times = (*base == TimeBase::Total).then(|| times.clone());
        Some((Frames::Times(times.clone()), total_times))
    }

    /// Frames of a step that begins at total time `start` and has the duration `period`.
    pub fn frames(&self, start: f64, period: f64) -> Frames {
        let within = |times: Vec<f64>| {
            let inside = times
                .into_iter()
                .filter(|&t| t > 0.0 && t <= period * (1.0 + 1e-9));
            Frames::Times(inside.collect())
        };
        match (&self.total_times, &self.frames) {
            (Some(times), _) => within(times.iter().map(|t| t - start).collect()),
            (None, Frames::Times(times)) => within(times.clone()),
            (None, frames) => frames.clone(),
        }
    }
}

/// Marks the sets of a request for fields as read: fields are written on the whole mesh.
fn skip_sets(card: &Card) {
    card.value("NSET");
    card.value("ELSET");
}

const WHEN: [&str; 4] = [
    "FREQUENCY",
    "NUMBER INTERVAL",
    "TIME INTERVAL",
    "TIME POINTS",
];

/// Reads FREQUENCY: frames after every multiple of this number of increments; 0 means a frame only at the end of the
/// step.
fn frequency(card: &Card, cx: &mut Context) -> Option<Frames> {
    match count(card, "FREQUENCY", 0, cx)? {
        0 => Some(Frames::Count(1)),
        n => Some(Frames::Increments(n)),
    }
}

fn number_interval(card: &Card, cx: &mut Context) -> Option<Frames> {
    count(card, "NUMBER INTERVAL", 1, cx).map(Frames::Count)
}

fn count(card: &Card, name: &str, least: i64, cx: &mut Context) -> Option<usize> {
    let value = card.integer(name, cx.d)?;
    if value < least {
        let message = format!("{name} must be at least {least}, found {value}");
        cx.error(Code::OutputTimes, card.span_of(name), message);
        return None;
    }
    usize::try_from(value).ok()
}

fn time_interval(card: &Card, cx: &mut Context) -> Option<Frames> {
    let (interval, rule) = (
        card.value("TIME INTERVAL")?,
        "TIME INTERVAL must be positive",
    );
    let interval = interval.real_that(|t| t > 0.0, rule, Code::OutputTimes, cx.d);
    interval.map(Frames::Every)
}

/// Warns about variables that are not written.
fn report_variables(card: &Card, cx: &mut Context) {
    for field in card.rows.iter().flat_map(Line::fields) {
        if !field.is_empty() && !WRITTEN.contains(&field.name_key().as_str()) {
            let message = format!("the variable {} is not written", field.text);
            cx.d.warning_once(Code::IgnoredVariable, field.span, message)
                .help("docs/output.md lists everything the result file holds");
        }
    }
}

/// Histories, fields and monitored dofs that the deck has asked for so far.
#[derive(Default)]
pub(crate) struct Histories {
    /// Node sets that have a history.
    pub nodes: Vec<HistorySet>,
    /// Element sets that have a history.
    pub elements: Vec<HistorySet>,
    /// Fields that are written on request only.
    pub fields: RequestedFields,
    /// Dofs whose displacements the status file shows.
    pub monitored: Vec<usize>,
}

/// Kind of the members of a set.
#[derive(Clone, Copy)]
pub(super) enum MemberKind {
    Nodes,
    Elements,
}

impl MemberKind {
    fn parameter(self) -> &'static str {
        match self {
            MemberKind::Nodes => "NSET",
            MemberKind::Elements => "ELSET",
        }
    }

    /// Warns that a history without a set is not written.
    fn report_all(self, card: &Card, cx: &mut Context) {
        let (members, help) = match self {
            MemberKind::Nodes => ("nodes", "name a node set with NSET="),
            MemberKind::Elements => ("elements", "name an element set with ELSET="),
        };
        let message = format!("the history of all {members} is not written");
        cx.warning(Code::IgnoredVariable, card.span, message)
            .help(help);
    }
}

impl Histories {
    /// Adds the set of a card to the histories; a card with `FREQUENCY=0` adds nothing.
    pub(super) fn card(&mut self, card: &Card, family: MemberKind, sets: &Sets, cx: &mut Context) {
        let name = card.value(family.parameter());
        let is_off = card
            .value("FREQUENCY")
            .is_some_and(|n| n.text.trim() == "0");
        let each_member = card.choice("TOTALS") != Some("ONLY");
        match name {
            Some(name) => {
                if let Some(set) = family.set(name, sets, cx).filter(|_| !is_off) {
                    let position = match family {
                        MemberKind::Nodes => None,
                        MemberKind::Elements => card.choice("POSITION"),
                    };
                    let asked = HistorySet {
                        set,
                        each_member,
                        at_points: position == Some("INTEGRATION POINTS"),
                        at_nodes: matches!(position, Some("NODES" | "AVERAGED AT NODES")),
                    };
                    self.add(family, asked);
                }
            }
            None if is_off || card.has(family.parameter()) => {}
            None => family.report_all(card, cx),
        }
    }

    fn add(&mut self, family: MemberKind, asked: HistorySet) {
        let known = match family {
            MemberKind::Nodes => &mut self.nodes,
            MemberKind::Elements => &mut self.elements,
        };
        match known.iter_mut().find(|known| known.set == asked.set) {
            Some(known) => {
                known.each_member |= asked.each_member;
                known.at_points |= asked.at_points;
                known.at_nodes |= asked.at_nodes;
            }
            None => known.push(asked),
        }
    }

    /// Adds those fields of nodes or elements named by a card that are written on request only.
    pub(super) fn fields(&mut self, card: &Card) {
        if card.keyword.name.starts_with("CONTACT") {
            return;
        }
        let is_at_nodes = card.keyword.name.starts_with("EL")
            && matches!(card.choice("POSITION"), Some("NODES" | "AVERAGED AT NODES"));
        for field in card.rows.iter().flat_map(Line::fields) {
            let name = field.name_key();
            let variable = NodalVariable::named(name.as_str()).filter(|_| is_at_nodes);
            self.fields.at_nodes.extend(variable);
            match name.as_str() {
                "CF" => self.fields.concentrated_load = true,
                "ENER" => self.fields.energy_density = true,
                "LE" | "LE11" | "LE22" | "LE33" | "LE12" => self.fields.logarithmic_strain = true,
                "SP" | "SP1" | "SP2" | "SP3" => self.fields.principal_stress = true,
                "PRESS" => self.fields.pressure = true,
                "PEEQ" => self.fields.plastic_strain = true,
                _ => {}
            }
        }
    }

    /// Adds the dof of `*MONITOR`.
    pub(super) fn monitor(&mut self, card: &Card, targets: Targets, cx: &mut Context) {
        let new = monitored(card, targets, cx).filter(|dof| !self.monitored.contains(dof));
        self.monitored.extend(new);
    }
}

impl MemberKind {
    /// Index of the set with a name. An element set without plane elements gives `None` and a warning if it holds other
    /// elements.
    fn set(self, name: Text, sets: &Sets, cx: &mut Context) -> Option<usize> {
        let set = match self {
            MemberKind::Nodes => return sets.node_names.find(name, cx),
            MemberKind::Elements => sets.element_names.find(name, cx)?,
        };
        if sets.holds_others_only(set) {
            let message = format!("{} holds no plane elements: it has no history", name.text);
            cx.warning(Code::IgnoredVariable, name.span, message)
                .help("line elements name faces; springs and dashpots have a history of their own");
            return None;
        }
        Some(set)
    }
}

/// The dof that a card `*MONITOR` names.
pub(super) fn monitored(card: &Card, targets: Targets, cx: &mut Context) -> Option<usize> {
    let node = card.required("NODE", cx.d);
    let dof = card.required("DOF", cx.d);
    let help = "a column shows one node; give *MONITOR for each";
    let node = node.and_then(|field| {
        let Targets {
            sets, mesh_index, ..
        } = targets;
        sets.single_node(field, mesh_index, (Code::BadValue, help), cx)
    });
    let dof = dof?;
    match (node, direction(dof, cx)?) {
        (node, Direction::Plane(direction)) => Some(2 * node? + direction),
        (_, Direction::Rotation | Direction::OutOfPlane) => {
            let message = format!("direction {} is not in the status file", dof.text);
            cx.warning(Code::IgnoredVariable, dof.span, message)
                .help("1 is x, 2 is y");
            None
        }
    }
}

/// Largest number of intervals between the times of a row with GENERATE.
const MOST_TIMES: f64 = 1e6;

/// Named lists of times.
type TimePoints = Named<(TimeBase, Vec<f64>)>;

/// Reads all `*TIME POINTS`.
fn time_points(cx: &mut Context) -> TimePoints {
    let mut points = TimePoints::new("list of time points");
    let deck = cx.deck;
    for card in deck.cards_of("TIME POINTS") {
        points.add(card, cx, |_, cx| {
            let times = cx.sound(card, |cx| Some(times(card, cx)))?;
            Some((time_base(card), times))
        });
    }
    points
}

/// The times of a card `*TIME POINTS` in increasing order.
fn times(card: &Card, cx: &mut Context) -> Vec<f64> {
    let generate = card.has("GENERATE");
    if !generate {
        report_long_rows(card, cx);
    }
    let mut times = Vec::new();
    for row in card.rows.iter() {
        match generate {
            true => times.extend(generated(row, cx)),
            false => times.extend(row.fields().filter_map(|field| field.real(cx.d))),
        }
    }
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}

/// Reads a row `first, last, increment`.
fn generated(row: Line, cx: &mut Context) -> Vec<f64> {
    row.at_most(3, cx.d);
    let first = row.real(0, "the first time", cx.d);
    let last = row.real(1, "the last time", cx.d);
    let step = row.real(2, "the increment", cx.d);
    let (Some(first), Some(last), Some(step)) = (first, last, step) else {
        return Vec::new();
    };
    let count = ((last - first) / step + 1e-9).floor();
    if step <= 0.0 || !(0.0..=MOST_TIMES).contains(&count) {
        let message = format!(
            "no times run from {} to {} in steps of {}",
            shown(first),
            shown(last),
            shown(step)
        );
        cx.error(Code::OutputTimes, row.span(), message);
        return Vec::new();
    }
    (0..=count as usize)
        .map(|i| first + i as f64 * step)
        .collect()
}
