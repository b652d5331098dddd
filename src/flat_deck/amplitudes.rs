//! Amplitudes.

use super::lines::{Lines, named, number, set};
use crate::model::{Amplitude, Curve, Signal, TimeBase};

/// Points on a data line.
const POINTS: usize = 4;

/// Writes all amplitudes.
pub(super) fn write(amplitudes: &[Amplitude], lines: &mut Lines) {
    for Amplitude { name, time, curve } in amplitudes {
        let time = match time {
            TimeBase::Step => "STEP TIME",
            TimeBase::Total => "TOTAL TIME",
        };
        let parameters = [
            named("NAME", name),
            set("TIME", time),
            set("DEFINITION", definition(curve)),
        ];
        lines.card("AMPLITUDE", parameters);
        match curve {
            Curve::Linear(points) | Curve::SmoothStep(points) => pairs(points, lines),
            Curve::Signal {
                start,
                base,
                signal,
            } => write_signal(*start, *base, signal, lines),
        }
    }
}

fn definition(curve: &Curve) -> &'static str {
    match curve {
        Curve::Linear(_) => "TABULAR",
        Curve::SmoothStep(_) => "SMOOTH STEP",
        Curve::Signal { signal, .. } => match signal {
            Signal::Periodic { .. } => "PERIODIC",
            Signal::Decay { .. } => "DECAY",
            Signal::Modulated { .. } => "MODULATED",
        },
    }
}

fn pairs(pairs: &[(f64, f64)], lines: &mut Lines) {
    for pairs in pairs.chunks(POINTS) {
        lines.row(pairs.iter().flat_map(|&(a, b)| [a, b]).map(number));
    }
}

fn write_signal(start: f64, base: f64, signal: &Signal, lines: &mut Lines) {
    match signal {
        Signal::Periodic {
            frequency,
            harmonics,
        } => {
            let numbers = [*frequency, start, base].map(number);
            lines.row([harmonics.len().to_string()].into_iter().chain(numbers));
            pairs(harmonics, lines);
        }
        Signal::Decay { size, time } => lines.row([base, *size, start, *time].map(number)),
        Signal::Modulated {
            size,
            frequencies: [w1, w2],
        } => {
            lines.row([base, *size, start, *w1, *w2].map(number));
        }
    }
}
