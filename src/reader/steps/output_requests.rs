//! `*OUTPUT`, `*NODE OUTPUT`, `*NODE FILE`, `*NODE PRINT` and related keywords; `*TIME POINTS`,
//! `*MONITOR`.

use super::amplitude::time_base;
use super::boundary::Targets;
use super::monitor::monitored;
use crate::deck::{Card, Row};
use crate::diagnostics::{Code, Diagnostic, shown};
use crate::model::{Frames, HistorySet, TimeBase};
use crate::reader::context::Context;
use crate::reader::mesh::Sets;
use crate::reader::names::Names;

/// Largest number of frames a deck may generate.
const MOST_TIMES: f64 = 1e6;

/// Variables that the result file holds.
const WRITTEN: &[&str] = &[
    "U", "V", "A", "RF", "CF", "U1", "U2", "V1", "V2", "A1", "A2", "RF1", "RF2", "CF1", "CF2", "S",
    "E", "LE", "ENER", "ELSE", "ELKE", "EVOL", "CSTRESS", "CDISP", "CFORCE", "CSTATUS", "CDIS",
    "CSTR", "CELS", "CF", "CFN", "CFS", "CFT", "CAREA", "CNUM", "CFNM", "CFSM", "CFTM", "CPRESS",
    "CSHEAR1", "COPEN", "CSLIP1", "ALLKE", "ALLSE", "ALLIE", "ALLWK", "ALLFD", "ALLVD", "ETOTAL",
];

/// Named lists of times.
pub(crate) struct TimePoints {
    names: Names,
    all: Vec<(TimeBase, Vec<f64>)>,
}

/// Reads all `*TIME POINTS`.
pub(crate) fn time_points(cx: &mut Context) -> TimePoints {
    let mut points = TimePoints {
        names: Names::new("list of time points"),
        all: Vec::new(),
    };
    let deck = cx.deck;
    for card in deck
        .cards
        .iter()
        .filter(|card| card.keyword.name == "TIME POINTS")
    {
        let Some(name) = points.names.new_name(card, cx) else {
            continue;
        };
        let errors = cx.errors();
        let generate = card.has("GENERATE");
        let mut times = Vec::new();
        for row in card.rows.iter() {
            match generate {
                true => times.extend(generated(row, cx)),
                false => times.extend(row.fields().filter_map(|field| field.real(cx.d))),
            }
        }
        if cx.errors() > errors || card.faulty {
            points.names.spoil(&name);
            continue;
        }
        times.sort_by(f64::total_cmp);
        times.dedup();
        points.all.push((time_base(card), times));
        points.names.define(name);
    }
    points
}

/// `first, last, increment`
fn generated(row: Row, cx: &mut Context) -> Vec<f64> {
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

/// Output requests of the deck so far.
pub(crate) struct Requests {
    points: TimePoints,
    /// Frames of the current step.
    frames: Frames,
    /// Time points in total time: those of each step are selected when it is built.
    total_times: Option<Vec<f64>>,
    /// Node sets of the history.
    pub history: Vec<HistorySet>,
    /// Dofs in the status file.
    pub monitored: Vec<usize>,
}

impl Requests {
    /// Nothing yet.
    pub fn new(points: TimePoints) -> Requests {
        Requests {
            points,
            frames: Frames::Default,
            total_times: None,
            history: Vec::new(),
            monitored: Vec::new(),
        }
    }

    /// Reads the output cards of a step.
    pub fn cards(&mut self, cards: &[&Card], targets: Targets, cx: &mut Context) {
        let sets = targets.sets;
        let mut in_history = None;
        for card in cards {
            match card.keyword.name {
                "OUTPUT" => in_history = self.output(card, cx),
                "NODE PRINT" => self.history(card, true, sets, cx),
                "NODE OUTPUT" if in_history == Some(true) => self.history(card, false, sets, cx),
                "NODE OUTPUT" | "ELEMENT OUTPUT" | "CONTACT OUTPUT" if in_history.is_some() => {
                    card.value("NSET");
                }
                "NODE OUTPUT" | "ELEMENT OUTPUT" | "CONTACT OUTPUT" | "NODE FILE" | "EL FILE"
                | "CONTACT FILE" => {
                    card.value("NSET");
                    self.when(card, cx);
                }
                "EL PRINT" | "CONTACT PRINT" | "ENERGY OUTPUT" => {}
                "RESTART" => restart(card, cx),
                "MONITOR" => self.monitor(card, targets, cx),
                _ => continue,
            }
            report_variables(card, cx);
        }
    }

    /// `*OUTPUT`: whether histories, or else fields, are asked for below it.
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

    /// Adds the node set of a card to the history.
    fn history(&mut self, card: &Card, required: bool, sets: &Sets, cx: &mut Context) {
        let name = match required {
            true => card.required("NSET", cx.d),
            false => card.value("NSET"),
        };
        self.check_when(card, cx);
        let Some(name) = name else {
            if !required {
                let message = "the history of all nodes is not written";
                let warning = Diagnostic::warning(Code::IgnoredVariable, card.span, message);
                cx.d.push(warning.help("name a node set with NSET="));
            }
            return;
        };
        let each_node = card.choice("TOTALS") != Some("ONLY");
        let Some(set) = sets.node_names.find(name, cx) else {
            return;
        };
        match self.history.iter_mut().find(|known| known.set == set) {
            Some(known) => known.each_node |= each_node,
            None => self.history.push(HistorySet { set, each_node }),
        }
    }

    fn monitor(&mut self, card: &Card, targets: Targets, cx: &mut Context) {
        let new = monitored(card, targets, cx).filter(|dof| !self.monitored.contains(dof));
        self.monitored.extend(new);
    }

    /// Sets the times of frames, if the card gives any.
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

    /// Checks the times on a card for histories; histories hold every increment all the same.
    fn check_when(&self, card: &Card, cx: &mut Context) {
        for name in WHEN.into_iter().filter(|name| card.has(name)) {
            self.asked(name, card, cx);
        }
    }

    /// Frames that a parameter requests, and its time points in total time.
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
        let index = self.points.names.find(name, cx)?;
        let (base, times) = self.points.all.get(index)?;
        let total_times = (*base == TimeBase::Total).then(|| times.clone());
        Some((Frames::Times(times.clone()), total_times))
    }

    /// Frames of a step that begins at total time `start` and takes `period`.
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

const WHEN: [&str; 4] = [
    "FREQUENCY",
    "NUMBER INTERVAL",
    "TIME INTERVAL",
    "TIME POINTS",
];

/// Every so many increments; 0 means the ends of the step only.
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
    let interval = card.real("TIME INTERVAL", cx.d)?;
    if interval <= 0.0 {
        let message = format!("TIME INTERVAL must be positive, found {}", shown(interval));
        cx.error(Code::OutputTimes, card.span_of("TIME INTERVAL"), message);
        return None;
    }
    Some(Frames::Every(interval))
}

/// Warns that `*RESTART` writes nothing.
pub(crate) fn restart(card: &Card, cx: &mut Context) {
    let off = card.integer("FREQUENCY", cx.d) == Some(0);
    if card.has("WRITE") && !off {
        let message = "*RESTART, WRITE is left out: a run cannot be continued yet";
        cx.d.push_once(Diagnostic::warning(
            Code::IgnoredKeyword,
            card.span,
            message,
        ));
    }
}

/// Warns about variables that are not written.
fn report_variables(card: &Card, cx: &mut Context) {
    for field in card.rows.iter().flat_map(Row::fields) {
        if !field.is_empty() && !WRITTEN.contains(&field.name_key().as_str()) {
            let message = format!("the variable {} is not written", field.text);
            let warning = Diagnostic::warning(Code::IgnoredVariable, field.span, message);
            cx.d.push_once(warning.help("docs/output.md lists everything the result file holds"));
        }
    }
}
