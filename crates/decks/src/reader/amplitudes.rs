//! `*AMPLITUDE`: tables of points, and functions of the time since the start of the function.

use super::context::Context;
use super::names::Named;
use crate::deck::{Card, Line, Text};
use crate::diagnostics::{Code, Span};
use crate::model::{Amplitude, Curve, Signal, TimeBase};

/// All amplitudes.
pub(crate) struct Amplitudes {
    /// The amplitudes by their names.
    pub named: Named<Amplitude>,
    /// Places of the amplitudes.
    pub spans: Vec<Span>,
}

impl Amplitudes {
    /// Index of the amplitude that a card names with `AMPLITUDE=`; `Err` after a reported error.
    pub fn of(&self, card: &Card, cx: &mut Context) -> Result<Option<usize>, ()> {
        match card.value("AMPLITUDE") {
            Some(name) => self.named.names.find(name, cx).map(Some).ok_or(()),
            None => Ok(None),
        }
    }
}

/// Reads all amplitudes, including amplitudes in steps.
pub(crate) fn read(cx: &mut Context) -> Amplitudes {
    let (mut named, mut spans) = (Named::new("amplitude"), Vec::new());
    let deck = cx.deck;
    for card in deck.cards_of("AMPLITUDE") {
        named.add(card, cx, |name, cx| {
            Some(Amplitude {
                name: name.typed.clone(),
                time: time_base(card),
                curve: cx.sound(card, |cx| curve(card, cx))?,
            })
        });
        spans.resize(named.all.len(), card.span_of("NAME"));
    }
    Amplitudes { named, spans }
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
            signal(definition, card, axes, cx)
        }
        _ => points(tabulated(card, cx), axes, cx).map(Curve::Linear),
    }
}

/// Time and value as given on the card, and the field that messages refer to.
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

/// Number of fields that other codes read on a line of a table.
const NUMBERS: usize = 8;

/// Warns about the first line that has more numbers than other codes read.
pub(super) fn report_long_rows(card: &Card, cx: &mut Context) {
    let mut rows = card.rows.iter();
    let long = rows.find_map(|row| row.fields().nth(NUMBERS));
    if let Some(field) = long {
        let message = format!("more than {NUMBERS} numbers on a line of {}", card.title());
        cx.warning(Code::LongLine, field.span, message)
            .help("all are read here; Abaqus and CalculiX leave out those beyond the eighth");
    }
}

/// Reads rows `time, value, time, value, ...`.
fn tabulated<'a>(card: &'a Card, cx: &mut Context) -> Vec<Given<'a>> {
    report_long_rows(card, cx);
    let mut given = Vec::new();
    for row in card.rows.iter() {
        given.extend(pairs(row, cx));
    }
    given
}

/// Reads rows `value, value, ...`: values at BEGIN and after every FIXED INTERVAL.
fn equally_spaced<'a>(card: &'a Card, cx: &mut Context) -> Vec<Given<'a>> {
    report_long_rows(card, cx);
    let interval = card.required("FIXED INTERVAL", cx.d);
    let begin = card.real("BEGIN", cx.d).unwrap_or(0.0);
    let Some(interval) = interval.and_then(|field| positive(field, "the interval", cx)) else {
        return Vec::new();
    };
    let mut given = Vec::new();
    for field in card.rows.iter().flat_map(Line::fields) {
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

/// Pairs of time and value of a row.
fn pairs<'a>(row: Line<'a>, cx: &mut Context) -> Vec<Given<'a>> {
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

/// Largest time, value or frequency of an amplitude, for which products of a few such numbers do not overflow.
const LARGEST: f64 = 1e100;

/// Whether numbers of an amplitude are small enough for computing.
pub(super) fn are_in_reach(numbers: &[f64]) -> bool {
    numbers.iter().all(|number| number.abs() <= LARGEST)
}

/// Reports numbers of an amplitude that are too large to be computed with.
pub(super) fn report_out_of_reach(what: &str, span: Span, cx: &mut Context) {
    let message = format!("{what}: the numbers of an amplitude end at {LARGEST:e}");
    cx.error(Code::AmplitudeTable, span, message)
        .help("before its first point and after its last one a table is constant");
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
    /// Reads the parameters for scale and shift of an amplitude.
    pub fn read(card: &Card, cx: &mut Context) -> Axes {
        let mut number = |name: &str, default: f64| card.real(name, cx.d).unwrap_or(default);
        Axes {
            scale: [number("SCALEX", 1.0), number("SCALEY", 1.0)],
            shift: [number("SHIFTX", 0.0), number("SHIFTY", 0.0)],
        }
    }

    /// The time and value of the curve, scaled and shifted, for a time and value of the card.
    pub fn point(self, time: f64, value: f64) -> (f64, f64) {
        (
            time * self.scale[0] + self.shift[0],
            value * self.scale[1] + self.shift[1],
        )
    }
}

/// Reads the function that `definition` names, with its times and values scaled and shifted.
pub(super) fn signal(definition: &str, card: &Card, axes: Axes, cx: &mut Context) -> Option<Curve> {
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

/// Reads `N, w, t0, A0`, and `A1, B1, A2, B2, ...` on further lines; returns t0, A0 and the signal.
fn periodic<'a>(
    row: Line,
    more: &mut impl Iterator<Item = Line<'a>>,
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

/// Reads `A0, A, t0, td`; returns t0, A0 and the signal.
fn decay(row: Line, axes: Axes, cx: &mut Context) -> Option<(f64, f64, Signal)> {
    row.at_most(4, cx.d);
    let [base, size, start] = first_three(row, cx)?;
    let time = row.required(3, "the time of decay", cx.d)?;
    let signal = Signal::Decay {
        size: size * axes.scale[1],
        time: positive(time, "the time of decay", cx)? * axes.scale[0],
    };
    Some((start, base, signal))
}

/// Reads `A0, A, t0, w1, w2`; returns t0, A0 and the signal.
fn modulated(row: Line, axes: Axes, cx: &mut Context) -> Option<(f64, f64, Signal)> {
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

/// Reads the first three fields, `A0, A, t0`.
fn first_three(row: Line, cx: &mut Context) -> Option<[f64; 3]> {
    let [base, size, start] = [0, 1, 2].map(|index| row.real_or(index, 0.0, cx.d));
    Some([base?, size?, start?])
}

/// The number of a field, which must be positive; messages call the field `what`.
fn positive(field: Text, what: &str, cx: &mut Context) -> Option<f64> {
    let rule = format!("{what} must be positive");
    field.real_that(|x| x > 0.0, &rule, Code::AmplitudeTable, cx.d)
}
