//! Amplitudes that increments cannot follow: features shorter than an increment, and prescribed
//! displacements that jump at the start of a step.

use crate::diagnostics::{Code, Span};
use crate::model::{
    Amplitude, Curve, Load, Model, Rate, Signal, Step, Support, SupportMotion, TimeBase, Variation,
};
use crate::reader::context::Context;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{LN_2, PI};

/// Height of a feature, relative to the range of the amplitude in the step, below which the feature counts as noise.
const NOISE: f64 = 0.05;

/// Largest jump of a displacement that counts as round-off, relative to the largest displacement of the amplitude.
const ROUND_OFF: f64 = 1e-9;

/// A feature of a curve: a rise followed by a fall, or a fall followed by a rise.
struct Feature {
    /// Time of the top of the feature, in the time of the amplitude.
    time: f64,
    /// Duration for which the curve is beyond half of the height of the feature.
    width: f64,
}

/// Warns about features of amplitudes that are shorter than the increment of a step, and about prescribed displacements
/// that jump at the start of a step; each amplitude is named once. `spans` are the places of the amplitudes.
pub(crate) fn amplitudes(model: &Model, spans: &[Span], cx: &mut Context) {
    let (mut warned, mut start) = (BTreeSet::new(), 0.0);
    let mut before = Displacements::of_rest();
    for (index, step) in model.steps.iter().enumerate() {
        for used in followed(step) {
            let (Some(amplitude), Some(&span)) = (model.amplitudes.get(used), spans.get(used))
            else {
                continue;
            };
            let dt = step.increments.dt;
            let feature = shortest_feature(amplitude, window(amplitude, step, start), index == 0);
            let short = feature.filter(|feature| feature.width < dt && warned.insert(used));
            if let Some(Feature { time, width }) = short {
                let message = format!(
                    "amplitude {} has a feature of {width:.2e} at time {time:.2e}, shorter than the \
                     increment of {dt:.2e}",
                    amplitude.name
                );
                cx.warning(Code::ShortFeature, span, message).help(
                    "an increment sees the values at its two ends only, and may miss what lies \
                     between them",
                );
            }
        }
        report_jumps(model, (step, index, start), &before, spans, cx);
        before = before.after(model, step, start);
        start += step.increments.period;
    }
}

/// Start and end of a step in the time of an amplitude.
fn window(amplitude: &Amplitude, step: &Step, start: f64) -> [f64; 2] {
    let from = match amplitude.time {
        TimeBase::Step => 0.0,
        TimeBase::Total => start,
    };
    [from, from + step.increments.period]
}

/// Indices of the amplitudes that loads and prescribed displacements of a step follow. The list leaves out amplitudes
/// of prescribed rates, because rates are integrated exactly.
fn followed(step: &Step) -> BTreeSet<usize> {
    fn of_loads<T>(loads: &[Load<T>]) -> impl Iterator<Item = usize> + '_ {
        let acting = loads.iter().filter(|load| load.magnitude != 0.0);
        acting.filter_map(|load| match load.variation {
            Variation::Amplitude(index) => Some(index),
            Variation::Constant | Variation::Ramp { .. } => None,
        })
    }
    let supports = step.supports.iter();
    let of_supports = supports.filter_map(|support| match support.motion {
        SupportMotion::Amplitude { value, amplitude } if value != 0.0 => Some(amplitude),
        _ => None,
    });
    (of_loads(&step.point_loads))
        .chain(of_loads(&step.body_forces))
        .chain(of_loads(&step.centrifugal_forces))
        .chain(of_loads(&step.pressures))
        .chain(of_loads(&step.tractions))
        .chain(of_loads(&step.interferences))
        .chain(of_supports)
        .collect()
}

/// The shortest feature of an amplitude between two times; before the analysis the amplitude is zero.
fn shortest_feature(amplitude: &Amplitude, window: [f64; 2], is_first: bool) -> Option<Feature> {
    match &amplitude.curve {
        Curve::Linear(table) | Curve::SmoothStep(table) => {
            let [from, to] = window;
            let mut points = Vec::with_capacity(table.len() + 3);
            points.extend(is_first.then_some((from, 0.0)));
            points.push((from, amplitude.at(from)));
            points.extend(table.iter().filter(|point| from < point.0 && point.0 < to));
            points.push((to, amplitude.at(to)));
            features(&points).min_by(|a, b| a.width.total_cmp(&b.width))
        }
        Curve::Signal { start, signal, .. } => feature_of(signal, *start, window),
    }
}

/// The features of a curve that is linear between its points.
fn features(points: &[(f64, f64)]) -> impl Iterator<Item = Feature> + '_ {
    let values = || points.iter().map(|point| point.1);
    let range = values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min);
    let tops = tops(points);
    let ends = [0, points.len() - 1].map(|end| [end, end]);
    let all: Vec<[usize; 2]> = std::iter::once(ends[0])
        .chain(tops)
        .chain(std::iter::once(ends[1]))
        .collect();
    let triples: Vec<[[usize; 2]; 3]> = all.windows(3).map(|w| [w[0], w[1], w[2]]).collect();
    triples.into_iter().filter_map(move |[left, top, right]| {
        let (time, value) = points[top[0]];
        // the smaller one of rise and fall is the height
        let [rise, fall] = [left[1], right[0]].map(|base| value - points[base].1);
        let height = if rise.abs() < fall.abs() { rise } else { fall };
        let half = value - height / 2.0;
        let before = crossing(points, (left[1]..top[0]).rev(), half)?;
        let after = crossing(points, top[1]..right[0], half)?;
        let width = after - before;
        (height.abs() > NOISE * range).then_some(Feature { time, width })
    })
}

/// First and last point (indices) of every stretch, away from the ends, where a curve changes between rising and
/// falling.
fn tops(points: &[(f64, f64)]) -> Vec<[usize; 2]> {
    let (mut tops, mut rises, mut first) = (Vec::new(), None, 0);
    for (index, pair) in points.windows(2).enumerate() {
        let change = pair[1].1 - pair[0].1;
        if change == 0.0 {
            continue;
        }
        if rises.is_some_and(|rises| rises != (change > 0.0)) {
            tops.push([first, index]);
        }
        (rises, first) = (Some(change > 0.0), index + 1);
    }
    tops
}

/// Time at which a curve meets a value, in the first of some intervals that contain such a time.
fn crossing(
    points: &[(f64, f64)],
    mut intervals: impl Iterator<Item = usize>,
    value: f64,
) -> Option<f64> {
    intervals.find_map(|index| {
        let [(t0, v0), (t1, v1)] = [points[index], points[index + 1]];
        let share = (value - v0) / (v1 - v0);
        (0.0..=1.0)
            .contains(&share)
            .then_some(t0 + share * (t1 - t0))
    })
}

/// The shortest feature of a signal that begins at `start`: half a period of its highest frequency, or its half-life.
fn feature_of(signal: &Signal, start: f64, [from, to]: [f64; 2]) -> Option<Feature> {
    let wave = |frequency: f64| Feature {
        time: start.max(from),
        width: PI / frequency.abs(),
    };
    let feature = match signal {
        Signal::Periodic {
            frequency,
            harmonics,
        } => {
            let size = |&(a, b): &(f64, f64)| a.abs() + b.abs();
            let all: f64 = harmonics.iter().map(size).sum();
            let last = harmonics.iter().rposition(|one| size(one) > NOISE * all)?;
            wave((last + 1) as f64 * frequency)
        }
        Signal::Modulated {
            frequencies: [w1, w2],
            size,
        } => {
            let is_zero = [*size, *w1, *w2].contains(&0.0);
            (!is_zero).then(|| wave(w1.abs() + w2.abs()))?
        }
        Signal::Decay { size, time } => (*size != 0.0 && start >= from).then(|| Feature {
            time: start,
            width: LN_2 * time,
        })?,
    };
    (start < to).then_some(feature)
}

/// Displacements that are known at the start of a step.
struct Displacements {
    /// Displacements of the supports of the step before; `None` before the first step, where all displacements are
    /// zero.
    prescribed: Option<BTreeMap<usize, f64>>,
}

impl Displacements {
    /// Displacements before the first step, which are all zero.
    fn of_rest() -> Self {
        Displacements { prescribed: None }
    }

    fn of(&self, dof: usize) -> Option<f64> {
        match &self.prescribed {
            None => Some(0.0),
            Some(prescribed) => prescribed.get(&dof).copied(),
        }
    }

    /// Displacements at the end of a step that starts at a given time.
    fn after(&self, model: &Model, step: &Step, start: f64) -> Self {
        let end = |&Support { dof, motion }: &Support| {
            let u = match motion {
                SupportMotion::Ramp { to } => to,
                SupportMotion::Amplitude { value, amplitude } => {
                    let amplitude = model.amplitudes.get(amplitude)?;
                    value * amplitude.at(window(amplitude, step, start)[1])
                }
                SupportMotion::Rate {
                    rate: Rate::Velocity,
                    value,
                    amplitude,
                } => {
                    let travel = match amplitude {
                        None => step.increments.period,
                        Some(index) => {
                            let amplitude = model.amplitudes.get(index)?;
                            let ends = window(amplitude, step, start);
                            let [from, to] = ends.map(|t| amplitude.integrals(t)[0]);
                            to - from
                        }
                    };
                    self.of(dof)? + value * travel
                }
                SupportMotion::Rate {
                    rate: Rate::Acceleration,
                    ..
                } => return None,
            };
            Some((dof, u))
        };
        Displacements {
            prescribed: Some(step.supports.iter().filter_map(end).collect()),
        }
    }
}

/// Warns about displacements that jump at the start of a step; each amplitude is named once.
fn report_jumps(
    model: &Model,
    (step, index, start): (&Step, usize, f64),
    before: &Displacements,
    spans: &[Span],
    cx: &mut Context,
) {
    let mut warned = BTreeSet::new();
    for support in &step.supports {
        let SupportMotion::Amplitude { value, amplitude } = support.motion else {
            continue;
        };
        let (Some(curve), Some(&span)) = (model.amplitudes.get(amplitude), spans.get(amplitude))
        else {
            continue;
        };
        let Some(from) = before.of(support.dof) else {
            continue;
        };
        let jump = value * curve.at(window(curve, step, start)[0]) - from;
        let is_jump = jump.abs() > ROUND_OFF * (value * size(&curve.curve)).abs().max(from.abs());
        if is_jump && warned.insert(amplitude) {
            let label = model.mesh.node_labels.get(support.dof / 2);
            let node = label.map_or(String::new(), |&label| cx.named(label));
            let message = format!(
                "amplitude {} moves direction {} of node {node} by {jump:.2e} at once at the start of \
                 step {}",
                curve.name,
                support.dof % 2 + 1,
                index + 1
            );
            cx.warning(Code::StartJump, span, message).help(format!(
                "the node makes this way in the first increment; it goes on from where it is if the \
                 displacement starts at {from:.2e}"
            ));
        }
    }
}

/// An upper bound of the absolute values of a curve.
fn size(curve: &Curve) -> f64 {
    match curve {
        Curve::Linear(points) | Curve::SmoothStep(points) => points
            .iter()
            .fold(0.0, |most: f64, point| most.max(point.1.abs())),
        Curve::Signal { base, signal, .. } => {
            let size = match signal {
                Signal::Periodic { harmonics, .. } => {
                    harmonics.iter().map(|(a, b)| a.abs() + b.abs()).sum()
                }
                Signal::Decay { size, .. } | Signal::Modulated { size, .. } => size.abs(),
            };
            base.abs() + size
        }
    }
}
