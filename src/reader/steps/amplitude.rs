//! `*AMPLITUDE`.

use crate::deck::{Card, Row, Text};
use crate::diagnostics::Code;
use crate::model::{Amplitude, TimeBase};
use crate::reader::context::Context;
use crate::reader::names::Names;

/// All amplitudes.
pub(crate) struct Amplitudes {
    /// Their names.
    pub names: Names,
    /// Amplitudes in the order of their names.
    pub all: Vec<Amplitude>,
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
        let points = points(card, cx);
        if card.faulty || cx.errors() > errors || points.is_empty() {
            amplitudes.names.spoil(&name);
            continue;
        }
        amplitudes.all.push(Amplitude {
            name: name.typed.clone(),
            time: time_base(card),
            points,
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

/// The table: time * SCALEX + SHIFTX, value * SCALEY + SHIFTY.
fn points(card: &Card, cx: &mut Context) -> Vec<(f64, f64)> {
    let mut number = |name: &str, default: f64| card.real(name, cx.d).unwrap_or(default);
    let (scale_x, shift_x) = (number("SCALEX", 1.0), number("SHIFTX", 0.0));
    let (scale_y, shift_y) = (number("SCALEY", 1.0), number("SHIFTY", 0.0));
    let mut points: Vec<(f64, f64)> = Vec::new();
    for row in &card.rows {
        for (time, value) in pairs(row, cx) {
            let point = (time.0 * scale_x + shift_x, value * scale_y + shift_y);
            if !(point.0.is_finite() && point.1.is_finite()) {
                cx.error(
                    Code::AmplitudeTable,
                    time.1.span,
                    "this point lies at infinity",
                );
                return Vec::new();
            }
            if points.last().is_some_and(|last| last.0 >= point.0) {
                let text = time.1.text;
                let message = format!("the times of an amplitude must increase, found {text}");
                cx.error(Code::AmplitudeTable, time.1.span, message);
                return Vec::new();
            }
            points.push(point);
        }
    }
    points
}

/// Times, as numbers and as typed, and values of a row.
fn pairs<'a>(row: &'a Row, cx: &mut Context) -> Vec<((f64, Text<'a>), f64)> {
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
            pairs.push(((time, field), value));
        }
    }
    pairs
}
