//! `*AMPLITUDE`: tables of points; `signal` reads the other definitions.

use super::signal::{self, Axes, are_in_reach, positive, report_out_of_reach};
use crate::deck::{Card, Row, Text};
use crate::diagnostics::{Code, Diagnostic, Span};
use crate::model::{Amplitude, Curve, TimeBase};
use crate::reader::context::Context;
use crate::reader::names::Names;

/// All amplitudes.
pub(crate) struct Amplitudes {
    /// Their names.
    pub names: Names,
    /// Amplitudes in the order of their names.
    pub all: Vec<Amplitude>,
    /// Their places.
    pub spans: Vec<Span>,
}

impl Amplitudes {
    /// Index of the amplitude that a card names with `AMPLITUDE=`; `Err` after a reported error.
    pub fn of(&self, card: &Card, cx: &mut Context) -> Result<Option<usize>, ()> {
        match card.value("AMPLITUDE") {
            Some(name) => self.names.find(name, cx).map(Some).ok_or(()),
            None => Ok(None),
        }
    }
}

/// Reads all amplitudes, including those in steps.
pub(crate) fn read(cx: &mut Context) -> Amplitudes {
    let mut amplitudes = Amplitudes {
        names: Names::new("amplitude"),
        all: Vec::new(),
        spans: Vec::new(),
    };
    let deck = cx.deck;
    for card in deck
        .cards
        .iter()
        .filter(|card| card.keyword.name == "AMPLITUDE")
    {
        let Some(name) = amplitudes.names.new_name(card, cx) else {
            continue;
        };
        let errors = cx.errors();
        let curve = curve(card, cx);
        let Some(curve) = curve.filter(|_| !card.faulty && cx.errors() == errors) else {
            amplitudes.names.spoil(&name);
            continue;
        };
        amplitudes.spans.push(card.span_of("NAME"));
        amplitudes.all.push(Amplitude {
            name: name.typed.clone(),
            time: time_base(card),
            curve,
        });
        amplitudes.names.define(name);
    }
    amplitudes
}

/// The time base given by a card's parameter `TIME`.
pub(crate) fn time_base(card: &Card) -> TimeBase {
    match card.choice("TIME") {
        Some("TOTAL TIME") => TimeBase::Total,
        _ => TimeBase::Step,
    }
}

fn curve(card: &Card, cx: &mut Context) -> Option<Curve> {
    let axes = Axes::read(card, cx);
    match card.choice("DEFINITION") {
        Some("SMOOTH STEP") => points(tabulated(card, cx), axes, cx).map(Curve::SmoothStep),
        Some("EQUALLY SPACED") => points(equally_spaced(card, cx), axes, cx).map(Curve::Linear),
        Some(definition @ ("PERIODIC" | "DECAY" | "MODULATED")) => {
            signal::read(definition, card, axes, cx)
        }
        _ => points(tabulated(card, cx), axes, cx).map(Curve::Linear),
    }
}

/// Time and value as the card gives them, and the field to name in a message.
type Given<'a> = (f64, f64, Text<'a>);

/// The points of a table; reports times that do not increase.
fn points(given: Vec<Given>, axes: Axes, cx: &mut Context) -> Option<Vec<(f64, f64)>> {
    let mut points: Vec<(f64, f64)> = Vec::new();
    for (time, value, field) in given {
        let point = axes.point(time, value);
        if !are_in_reach(&[point.0, point.1]) {
            report_out_of_reach("this point is out of reach", field.span, cx);
            return None;
        }
        if points.last().is_some_and(|last| last.0 >= point.0) {
            let message = format!("the times of an amplitude must increase, found {time:?}");
            cx.error(Code::AmplitudeTable, field.span, message);
            return None;
        }
        points.push(point);
    }
    (!points.is_empty()).then_some(points)
}

/// Numbers that other codes read of a line of a table.
const NUMBERS: usize = 8;

/// Warns about the first line that has more numbers than other codes read.
pub(super) fn report_long_rows(card: &Card, cx: &mut Context) {
    let mut rows = card.rows.iter();
    let long = rows.find_map(|row| row.fields().nth(NUMBERS));
    if let Some(field) = long {
        let message = format!("more than {NUMBERS} numbers on a line of {}", card.title());
        let warning = Diagnostic::warning(Code::LongLine, field.span, message);
        cx.d.push(
            warning
                .help("all are read here; Abaqus and CalculiX leave out those beyond the eighth"),
        );
    }
}

/// `time, value, time, value, ...`
fn tabulated<'a>(card: &'a Card, cx: &mut Context) -> Vec<Given<'a>> {
    report_long_rows(card, cx);
    let mut given = Vec::new();
    for row in card.rows.iter() {
        given.extend(pairs(row, cx));
    }
    given
}

/// `value, value, ...` at BEGIN and every FIXED INTERVAL after it.
fn equally_spaced<'a>(card: &'a Card, cx: &mut Context) -> Vec<Given<'a>> {
    report_long_rows(card, cx);
    let interval = card.required("FIXED INTERVAL", cx.d);
    let begin = card.real("BEGIN", cx.d).unwrap_or(0.0);
    let Some(interval) = interval.and_then(|field| positive(field, "the interval", cx)) else {
        return Vec::new();
    };
    let mut given = Vec::new();
    for field in card.rows.iter().flat_map(Row::fields) {
        let value = if field.is_empty() {
            Some(0.0)
        } else {
            field.real(cx.d)
        };
        let time = begin + given.len() as f64 * interval;
        given.extend(value.map(|value| (time, value, field)));
    }
    given
}

/// Times and values of a row.
fn pairs<'a>(row: Row<'a>, cx: &mut Context) -> Vec<Given<'a>> {
    let mut pairs = Vec::new();
    let count = row.fields().count();
    for index in (0..count).step_by(2) {
        let Some(field) = row.required(index, "a time", cx.d) else {
            break;
        };
        if index + 1 == count {
            cx.error(Code::AmplitudeTable, field.span, "a time without its value");
        }
        let (time, value) = (field.real(cx.d), row.real_or(index + 1, 0.0, cx.d));
        if let (Some(time), Some(value)) = (time, value) {
            pairs.push((time, value, field));
        }
    }
    pairs
}
