//! `*AMPLITUDE` with DEFINITION=PERIODIC, DECAY or MODULATED: functions of the time since their start;
//! scale and shift of all definitions.

use crate::deck::{Card, Row, Text};
use crate::diagnostics::{Code, Diagnostic, Span};
use crate::model::{Curve, Signal};
use crate::reader::context::Context;

/// Largest time, value or frequency of an amplitude: products of a few of them do not overflow.
const LARGEST: f64 = 1e100;

/// Whether numbers of an amplitude can be computed with.
pub(super) fn are_in_reach(numbers: &[f64]) -> bool {
    numbers.iter().all(|number| number.abs() <= LARGEST)
}

/// Reports numbers of an amplitude that cannot be computed with.
pub(super) fn report_out_of_reach(what: &str, span: Span, cx: &mut Context) {
    let message = format!("{what}: the numbers of an amplitude end at {LARGEST:e}");
    let error = Diagnostic::error(Code::AmplitudeTable, span, message);
    cx.d.push(error.help("before its first point and after its last one a table is constant"));
}

/// Scale and shift of times and values: time * SCALEX + SHIFTX, value * SCALEY + SHIFTY.
#[derive(Clone, Copy)]
pub(super) struct Axes {
    /// SCALEX and SCALEY.
    pub scale: [f64; 2],
    /// SHIFTX and SHIFTY.
    pub shift: [f64; 2],
}

impl Axes {
    /// Reads the parameters.
    pub fn read(card: &Card, cx: &mut Context) -> Axes {
        let mut number = |name: &str, default: f64| card.real(name, cx.d).unwrap_or(default);
        Axes {
            scale: [number("SCALEX", 1.0), number("SCALEY", 1.0)],
            shift: [number("SHIFTX", 0.0), number("SHIFTY", 0.0)],
        }
    }

    /// The time and value of the curve that stand for these of the card.
    pub fn point(self, time: f64, value: f64) -> (f64, f64) {
        (
            time * self.scale[0] + self.shift[0],
            value * self.scale[1] + self.shift[1],
        )
    }
}

/// Reads the function that `definition` names, with its times and values scaled and shifted.
pub(super) fn read(definition: &str, card: &Card, axes: Axes, cx: &mut Context) -> Option<Curve> {
    if axes.scale[0] <= 0.0 {
        let span = card.span_of("SCALEX");
        cx.error(Code::AmplitudeTable, span, "SCALEX must be positive");
        return None;
    }
    let mut more = card.rows.iter();
    let row = more.next()?;
    let (start, base, signal) = match definition {
        "PERIODIC" => periodic(row, &mut more, axes, cx)?,
        "DECAY" => decay(row, axes, cx)?,
        _ => modulated(row, axes, cx)?,
    };
    if let Some(extra) = more.next().filter(|_| definition != "PERIODIC") {
        let message = format!("DEFINITION={definition} has one data line");
        cx.error(Code::StrayData, extra.span(), message);
    }
    let (start, base) = axes.point(start, base);
    if !(are_in_reach(&[start, base]) && are_in_reach(&signal.numbers())) {
        report_out_of_reach("this curve is out of reach", row.span(), cx);
    }
    Some(Curve::Signal {
        start,
        base,
        signal,
    })
}

/// `N, w, t0, A0`, and `A1, B1, A2, B2, ...` on further lines; returns t0, A0 and the signal.
fn periodic<'a>(
    row: Row,
    more: &mut impl Iterator<Item = Row<'a>>,
    axes: Axes,
    cx: &mut Context,
) -> Option<(f64, f64, Signal)> {
    row.at_most(4, cx.d);
    let count = row.required(0, "the number of harmonics", cx.d)?;
    let wanted = count.integer(cx.d)?;
    let frequency = row.real(1, "the angular frequency", cx.d)?;
    let (start, base) = (row.real_or(2, 0.0, cx.d)?, row.real_or(3, 0.0, cx.d)?);
    let mut harmonics = Vec::new();
    for row in more {
        for index in (0..row.fields().count()).step_by(2) {
            let (a, b) = (
                row.real_or(index, 0.0, cx.d)?,
                row.real_or(index + 1, 0.0, cx.d)?,
            );
            harmonics.push((a * axes.scale[1], b * axes.scale[1]));
        }
    }
    let found = harmonics.len();
    if i64::try_from(found) != Ok(wanted) {
        let message = format!("{wanted} harmonics are announced, found {found} pairs A, B");
        cx.error(Code::AmplitudeTable, count.span, message);
    }
    let signal = Signal::Periodic {
        frequency: frequency / axes.scale[0],
        harmonics,
    };
    Some((start, base, signal))
}

/// `A0, A, t0, td`; returns t0, A0 and the signal.
fn decay(row: Row, axes: Axes, cx: &mut Context) -> Option<(f64, f64, Signal)> {
    row.at_most(4, cx.d);
    let [base, size, start] = first_three(row, cx)?;
    let time = row.required(3, "the time of decay", cx.d)?;
    let signal = Signal::Decay {
        size: size * axes.scale[1],
        time: positive(time, "the time of decay", cx)? * axes.scale[0],
    };
    Some((start, base, signal))
}

/// `A0, A, t0, w1, w2`; returns t0, A0 and the signal.
fn modulated(row: Row, axes: Axes, cx: &mut Context) -> Option<(f64, f64, Signal)> {
    row.at_most(5, cx.d);
    let [base, size, start] = first_three(row, cx)?;
    let mut frequency = |index: usize| {
        let value = row.real(index, "an angular frequency", cx.d)?;
        Some(value / axes.scale[0])
    };
    let signal = Signal::Modulated {
        size: size * axes.scale[1],
        frequencies: [frequency(3)?, frequency(4)?],
    };
    Some((start, base, signal))
}

/// `A0, A, t0`
fn first_three(row: Row, cx: &mut Context) -> Option<[f64; 3]> {
    let [base, size, start] = [0, 1, 2].map(|index| row.real_or(index, 0.0, cx.d));
    Some([base?, size?, start?])
}

/// The number of a field, which must be positive; `what` it is.
pub(super) fn positive(field: Text, what: &str, cx: &mut Context) -> Option<f64> {
    let value = field.real(cx.d)?;
    if value > 0.0 {
        return Some(value);
    }
    let message = format!("{what} must be positive, found {}", field.text);
    cx.error(Code::AmplitudeTable, field.span, message);
    None
}
