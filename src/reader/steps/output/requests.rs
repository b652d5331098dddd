//! `*OUTPUT`, `*NODE OUTPUT`, `*NODE FILE`, `*NODE PRINT` and related keywords; `*RESTART`.

use super::histories::{Family, Histories};
use super::time_points::{TimePoints, time_points};
use crate::deck::{Card, Row};
use crate::diagnostics::{Code, Diagnostic, shown};
use crate::model::{Frames, TimeBase};
use crate::reader::context::Context;
use crate::reader::steps::boundary::Targets;

/// Variables that the result file holds.
const WRITTEN: &[&str] = &[
    "U", "V", "A", "RF", "CF", "UT", "VT", "AT", "S11", "S22", "S33", "S12", "MISES", "E11", "E22",
    "E12", "LE11", "LE22", "LE12", "U1", "U2", "V1", "V2", "A1", "A2", "RF1", "RF2", "CF1", "CF2",
    "S", "E", "LE", "ENER", "ELSE", "ELKE", "EVOL", "CSTRESS", "CDISP", "CFORCE", "CSTATUS",
    "CDIS", "CSTR", "CELS", "CF", "CFN", "CFS", "CFT", "CNUM", "CFNM", "CFSM", "CFTM", "CPRESS",
    "COPEN", "CSLIP1", "ALLKE", "ALLSE", "ALLIE", "ALLWK", "ALLFD", "ALLVD", "ETOTAL",
];

/// Output requests of the deck so far.
pub(crate) struct Requests {
    points: TimePoints,
    /// Frames of the current step.
    frames: Frames,
    /// Time points in total time: those of each step are selected when it is built.
    total_times: Option<Vec<f64>>,
    /// What the histories and the status file show.
    pub histories: Histories,
}

impl Requests {
    /// Nothing yet.
    pub fn new(cx: &mut Context) -> Requests {
        Requests {
            points: time_points(cx),
            frames: Frames::Default,
            total_times: None,
            histories: Histories::default(),
        }
    }

    /// Reads the output cards of a step.
    pub fn cards(&mut self, cards: &[&Card], targets: Targets, cx: &mut Context) {
        let mut in_history = None;
        for card in cards {
            match (card.keyword.name, in_history) {
                ("OUTPUT", _) => in_history = self.output(card, cx),
                ("NODE PRINT", _) | ("NODE OUTPUT", Some(true)) => {
                    self.history(card, Family::Nodes, targets, cx);
                }
                ("EL PRINT", _) | ("ELEMENT OUTPUT", Some(true)) => {
                    self.history(card, Family::Elements, targets, cx);
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
                ("RESTART", _) => restart(card, cx),
                ("MONITOR", _) => self.histories.monitor(card, targets, cx),
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

    /// Adds the set of a card to the history.
    fn history(&mut self, card: &Card, family: Family, targets: Targets, cx: &mut Context) {
        self.check_when(card, cx);
        self.histories.card(card, family, targets.sets, cx);
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
        let (base, times) = self.points.find(name, cx)?;
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

/// Sets that fields are asked for on, which are written on the whole mesh.
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
        let message = "*RESTART, WRITE is left out: there are no restart files";
        let warning = Diagnostic::warning(Code::IgnoredKeyword, card.span, message);
        cx.d.push_once(warning.help(
            "a run that ends early leaves its frames, the last good state among them; to go on from there, run \
             the deck with all its steps again",
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
