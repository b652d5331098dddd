//! `*TIME POINTS`.

use crate::deck::{Row, Text};
use crate::diagnostics::{Code, shown};
use crate::model::TimeBase;
use crate::reader::context::Context;
use crate::reader::names::Names;
use crate::reader::steps::amplitude::{report_long_rows, time_base};

/// Largest number of frames a deck may generate.
const MOST_TIMES: f64 = 1e6;

/// Named lists of times.
pub(super) struct TimePoints {
    names: Names,
    all: Vec<(TimeBase, Vec<f64>)>,
}

impl TimePoints {
    /// The list that a field names.
    pub fn find(&self, name: Text, cx: &mut Context) -> Option<&(TimeBase, Vec<f64>)> {
        let index = self.names.find(name, cx)?;
        self.all.get(index)
    }
}

/// Reads all `*TIME POINTS`.
pub(super) fn time_points(cx: &mut Context) -> TimePoints {
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
