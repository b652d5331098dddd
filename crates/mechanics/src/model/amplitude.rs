//! Amplitudes: functions of time with their value and exact rate. The rate of an amplitude is the
//! velocity of a prescribed displacement (docs/theory/time.md, Supports).

/// Relative difference up to which two times are equal: the round-off of products k dt.
const SAME_TIME: f64 = 16.0 * f64::EPSILON;

/// Time on which an amplitude depends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TimeBase {
    /// Time since the start of the step.
    Step,
    /// Time since the start of the analysis.
    Total,
}

/// A function of time.
#[derive(Debug, Clone, PartialEq)]
pub struct Amplitude {
    /// Name in the deck.
    pub name: String,
    /// Its time.
    pub time: TimeBase,
    /// Its values.
    pub curve: Curve,
}

/// Values of an amplitude.
#[derive(Debug, Clone, PartialEq)]
pub enum Curve {
    /// Linear between points (time, value), constant outside; times strictly increase, and there is
    /// at least one point.
    Linear(Vec<(f64, f64)>),
    /// Smooth steps between points (time, value), with zero rate and zero second derivative at each
    /// point.
    SmoothStep(Vec<(f64, f64)>),
    /// `base` up to the time `start`, and `base + signal(t - start)` from this time on.
    Signal {
        /// Time at which the signal begins.
        start: f64,
        /// Value of the amplitude without the signal.
        base: f64,
        /// The signal.
        signal: Signal,
    },
}

/// A function of the time since the start of the signal.
#[derive(Debug, Clone, PartialEq)]
pub enum Signal {
    /// `sum over n >= 1 of A_n cos(n w t) + B_n sin(n w t)`
    Periodic {
        /// Angular frequency w (1/time).
        frequency: f64,
        /// Coefficients (A_n, B_n).
        harmonics: Vec<(f64, f64)>,
    },
    /// `size exp(-t / time)`
    Decay {
        /// Value at the start of the signal.
        size: f64,
        /// Time in which the value falls to 1/e, positive.
        time: f64,
    },
    /// `size sin(w1 t) sin(w2 t)`
    Modulated {
        /// Largest value.
        size: f64,
        /// Angular frequencies w1 and w2 (1/time).
        frequencies: [f64; 2],
    },
}

impl Amplitude {
    /// Value at time `t`, which is step or total time according to `self.time`.
    pub fn at(&self, t: f64) -> f64 {
        self.value_and_rate(t)[0]
    }

    /// Derivative of the amplitude at `t`. Where the derivative jumps at a point of a table, the result is the
    /// derivative in the interval before the jump. At the first point and at the start of a signal the result is the
    /// derivative after the jump.
    pub fn rate(&self, t: f64) -> f64 {
        self.value_and_rate(t)[1]
    }

    /// Derivative of the amplitude at `t`; where the derivative jumps, the result is the derivative in the interval
    /// after the jump.
    pub fn rate_after(&self, t: f64) -> f64 {
        match &self.curve {
            Curve::Linear(points) => rate_after_point(points, t, |x| [x, 1.0]),
            Curve::SmoothStep(points) => rate_after_point(points, t, smooth_step),
            Curve::Signal { .. } => self.rate(t),
        }
    }

    /// First and second integral at `t` (time, time^2), from the first point or the start of the signal.
    pub fn integrals(&self, t: f64) -> [f64; 2] {
        match &self.curve {
            Curve::Linear(points) => {
                integrals_of_table(points, t, |x| [x * x / 2.0, x.powi(3) / 6.0])
            }
            Curve::SmoothStep(points) => integrals_of_table(points, t, smooth_step_integrals),
            Curve::Signal {
                start,
                base,
                signal,
            } => {
                let t = t - start;
                let constant = [base * t, base * t * t / 2.0];
                match t > 0.0 {
                    true => added(constant, signal.integrals(t)),
                    false => constant,
                }
            }
        }
    }

    /// A lower and an upper bound of all values.
    pub fn bounds(&self) -> [f64; 2] {
        match &self.curve {
            Curve::Linear(points) | Curve::SmoothStep(points) => {
                let least_and_most =
                    |[least, most]: [f64; 2], p: &(f64, f64)| [least.min(p.1), most.max(p.1)];
                let none = [f64::INFINITY, f64::NEG_INFINITY];
                points.iter().fold(none, least_and_most)
            }
            Curve::Signal { base, signal, .. } => {
                let [below, above] = match signal {
                    Signal::Periodic { harmonics, .. } => {
                        let size: f64 = harmonics.iter().map(|(a, b)| a.hypot(*b)).sum();
                        [-size, size]
                    }
                    Signal::Decay { size, .. } => [size.min(0.0), size.max(0.0)],
                    Signal::Modulated { size, .. } => [-size.abs(), size.abs()],
                };
                [base + below, base + above]
            }
        }
    }

    fn value_and_rate(&self, t: f64) -> [f64; 2] {
        match &self.curve {
            Curve::Linear(points) => in_table(points, t, |x| [x, 1.0]),
            Curve::SmoothStep(points) => in_table(points, t, smooth_step),
            Curve::Signal {
                start,
                base,
                signal,
            } => {
                let t = if is_same_time(t, *start) { *start } else { t };
                if t < *start {
                    return [*base, 0.0];
                }
                let [value, rate] = signal.value_and_rate(t - start);
                [base + value, rate]
            }
        }
    }
}

impl Signal {
    /// All numbers that define the curve.
    pub fn numbers(&self) -> Vec<f64> {
        match self {
            Signal::Periodic {
                frequency,
                harmonics,
            } => {
                let harmonics = harmonics.iter().flat_map(|&(a, b)| [a, b]);
                harmonics.chain([*frequency]).collect()
            }
            Signal::Decay { size, time } => vec![*size, *time],
            Signal::Modulated {
                size,
                frequencies: [w1, w2],
            } => vec![*size, *w1, *w2],
        }
    }

    /// First and second integral from 0 to `t >= 0`.
    fn integrals(&self, t: f64) -> [f64; 2] {
        match self {
            Signal::Periodic {
                frequency,
                harmonics,
            } => {
                let terms = harmonics.iter().zip(1_u32..).map(|(&(a, b), n)| {
                    let w = f64::from(n) * frequency;
                    let (cosine, sine) = (cosine_integrals(w, t), sine_integrals(w, t));
                    [0, 1].map(|i| a * cosine[i] + b * sine[i])
                });
                terms.fold([0.0; 2], added)
            }
            Signal::Decay { size, time } => {
                let fallen = -(-t / time).exp_m1();
                [size * time * fallen, size * time * (t - time * fallen)]
            }
            // sin(w1 t) sin(w2 t) = (cos((w1 - w2) t) - cos((w1 + w2) t))/2
            Signal::Modulated {
                size,
                frequencies: [w1, w2],
            } => {
                let (slow, fast) = (cosine_integrals(w1 - w2, t), cosine_integrals(w1 + w2, t));
                [0, 1].map(|i| size * (slow[i] - fast[i]) / 2.0)
            }
        }
    }

    /// Value and rate at `t >= 0`.
    fn value_and_rate(&self, t: f64) -> [f64; 2] {
        match self {
            Signal::Periodic {
                frequency,
                harmonics,
            } => {
                let terms = harmonics.iter().zip(1_u32..).map(|(&(a, b), n)| {
                    let w = f64::from(n) * frequency;
                    let (sin, cos) = (w * t).sin_cos();
                    [a * cos + b * sin, w * (b * cos - a * sin)]
                });
                terms.fold([0.0; 2], added)
            }
            Signal::Decay { size, time } => {
                let value = size * (-t / time).exp();
                [value, -value / time]
            }
            Signal::Modulated {
                size,
                frequencies: [w1, w2],
            } => {
                let ((s1, c1), (s2, c2)) = ((w1 * t).sin_cos(), (w2 * t).sin_cos());
                [size * s1 * s2, size * (w1 * c1 * s2 + w2 * s1 * c2)]
            }
        }
    }
}

/// First and second integral from 0 to `t` of `cos(w t)`.
fn cosine_integrals(w: f64, t: f64) -> [f64; 2] {
    match w {
        0.0 => [t, t * t / 2.0],
        _ => [(w * t).sin() / w, 2.0 * ((w * t / 2.0).sin() / w).powi(2)],
    }
}

/// First and second integral from 0 to `t` of `sin(w t)`.
fn sine_integrals(w: f64, t: f64) -> [f64; 2] {
    match w {
        0.0 => [0.0; 2],
        _ => {
            let half = (w * t / 2.0).sin();
            [2.0 * half * half / w, (t - (w * t).sin() / w) / w]
        }
    }
}

fn added(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

/// First and second integral of [`smooth_step`] from 0 to `x`.
fn smooth_step_integrals(x: f64) -> [f64; 2] {
    [
        x.powi(4) * (2.5 - 3.0 * x + x * x),
        x.powi(5) * (0.5 - 0.5 * x + x * x / 7.0),
    ]
}

/// First and second integral at `t`, from the first point, of a table that is constant outside. Between two points the
/// values of the table follow a step, whose integrals from 0 to `0 <= x <= 1` are `step`.
fn integrals_of_table(points: &[(f64, f64)], t: f64, step: impl Fn(f64) -> [f64; 2]) -> [f64; 2] {
    let constant = |value: f64, s: f64| [value * s, value * s * s / 2.0];
    let (first, last) = (points[0], points[points.len() - 1]);
    if t < first.0 {
        return constant(first.1, t - first.0);
    }
    // integrals up to the end of an interval, or to t in it, with J1 and J2 at its start and s
    // counted from there: I1 = J1 + a s + (b - a) h step1, I2 = J2 + J1 s + a s^2/2 + (b - a) h^2
    // step2
    let on = |[j1, j2]: [f64; 2], s: f64, value: f64| added([j1, j2 + j1 * s], constant(value, s));
    let mut integrals = [0.0; 2];
    for pair in points.windows(2).take_while(|pair| pair[0].0 < t) {
        let (p, q) = (pair[0], pair[1]);
        let (s, h) = (t.min(q.0) - p.0, q.0 - p.0);
        let [first, second] = step(s / h);
        // the factors h are applied one at a time: h² may overflow although the step is zero
        let rise = [h * first, h * (h * second)].map(|share| (q.1 - p.1) * share);
        integrals = added(on(integrals, s, p.1), rise);
    }
    match t > last.0 {
        true => on(integrals, t - last.0, last.1),
        false => integrals,
    }
}

/// `[x^3 (10 - 15 x + 6 x^2), 30 x^2 (1 - x)^2]`: a function that goes from 0 to 1 as `x` does, and
/// its derivative.
fn smooth_step(x: f64) -> [f64; 2] {
    [
        x.powi(3) * (10.0 - 15.0 * x + 6.0 * x * x),
        30.0 * (x * (1.0 - x)).powi(2),
    ]
}

/// Value and rate at `t` of a table that is constant outside. Between two points the values of the table follow `step`,
/// which gives the covered part of the difference, and the derivative of this part, at `0 <= x <= 1`.
fn in_table(points: &[(f64, f64)], t: f64, step: impl Fn(f64) -> [f64; 2]) -> [f64; 2] {
    let (first, last) = (points[0], points[points.len() - 1]);
    let t = at_point(points, t);
    if points.len() == 1 || t < first.0 || t > last.0 {
        return [if t < first.0 { first.1 } else { last.1 }, 0.0];
    }
    let (p, q) = interval(points, t);
    let [share, slope] = step((t - p.0) / (q.0 - p.0));
    let value = match t {
        _ if t == first.0 => first.1,
        _ if t == last.0 => last.1,
        _ => p.1 + (q.1 - p.1) * share,
    };
    [value, (q.1 - p.1) / (q.0 - p.0) * slope]
}

/// Slope of a table in the interval that contains `t` or begins at `t`; zero before the first point and from the last
/// point on.
fn rate_after_point(points: &[(f64, f64)], t: f64, step: impl Fn(f64) -> [f64; 2]) -> f64 {
    let t = at_point(points, t);
    let next = points.partition_point(|p| p.0 <= t);
    if next == 0 || next == points.len() {
        return 0.0;
    }
    let (p, q) = (points[next - 1], points[next]);
    let [_, slope] = step((t - p.0) / (q.0 - p.0));
    (q.1 - p.1) / (q.0 - p.0) * slope
}

/// The time of the table point that equals `t` up to round-off; without such a point `t` itself. So the side of a kink
/// on which an increment ends does not depend on the unit of time.
fn at_point(points: &[(f64, f64)], t: f64) -> f64 {
    let next = points.partition_point(|p| p.0 < t);
    let around = &points[next.saturating_sub(1)..points.len().min(next + 1)];
    let same = around.iter().find(|p| is_same_time(p.0, t));
    same.map_or(t, |p| p.0)
}

fn is_same_time(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME_TIME * a.abs().max(b.abs())
}

/// The interval (p, q] of a table with p.0 < t <= q.0, else the first interval.
fn interval(points: &[(f64, f64)], t: f64) -> ((f64, f64), (f64, f64)) {
    let end = points
        .partition_point(|p| p.0 < t)
        .clamp(1, points.len() - 1);
    (points[end - 1], points[end])
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{E, PI};

    fn amplitude(curve: Curve) -> Amplitude {
        Amplitude {
            name: "A".into(),
            time: TimeBase::Step,
            curve,
        }
    }

    #[test]
    fn round_off_of_the_time_does_not_choose_the_side_of_a_kink() {
        let points = vec![(0.1, 0.0), (0.3, 1.0), (0.7, 5.0)];
        let table = amplitude(Curve::Linear(points.clone()));
        let steps = amplitude(Curve::SmoothStep(points));
        let decay = signal(Signal::Decay {
            size: 1.0,
            time: 3.0,
        });
        for (amplitude, time) in [
            (&table, 0.1),
            (&table, 0.3),
            (&table, 0.7),
            (&steps, 0.3),
            (&decay, 1.0),
        ] {
            let time: f64 = time;
            for t in [
                time.next_down(),
                time.next_up(),
                time * (1.0 + 8.0 * f64::EPSILON),
            ] {
                assert_eq!(amplitude.at(t), amplitude.at(time), "{t}");
                assert_eq!(amplitude.rate(t), amplitude.rate(time), "{t}");
                assert_eq!(amplitude.rate_after(t), amplitude.rate_after(time), "{t}");
            }
        }
        assert_eq!(table.rate(0.3), 1.0 / (0.3 - 0.1));
        let after = [0.0, 0.1, 0.3, 0.5, 0.7, 1.0].map(|t| table.rate_after(t));
        let [first, second] = [1.0 / (0.3 - 0.1), 4.0 / (0.7 - 0.3)];
        assert_eq!(after, [0.0, first, second, second, 0.0, 0.0]);
    }

    fn signal(signal: Signal) -> Amplitude {
        amplitude(Curve::Signal {
            start: 1.0,
            base: 2.0,
            signal,
        })
    }

    fn periodic() -> Amplitude {
        signal(Signal::Periodic {
            frequency: PI,
            harmonics: vec![(0.5, 3.0), (-1.0, 0.25)],
        })
    }

    fn modulated() -> Amplitude {
        signal(Signal::Modulated {
            size: 3.0,
            frequencies: [PI, 2.0 * PI],
        })
    }

    fn decay() -> Amplitude {
        signal(Signal::Decay {
            size: 3.0,
            time: 0.5,
        })
    }

    fn smooth() -> Amplitude {
        amplitude(Curve::SmoothStep(vec![(1.0, 0.0), (2.0, 4.0), (4.0, 0.0)]))
    }

    #[track_caller]
    fn close(found: f64, wanted: f64) {
        assert!(
            (found - wanted).abs() <= 1e-14 * wanted.abs().max(1.0),
            "{found} {wanted}"
        );
    }

    #[test]
    fn piecewise_linear_with_constant_ends() {
        let a = amplitude(Curve::Linear(vec![(1.0, 0.0), (2.0, 4.0), (4.0, 0.0)]));
        let values: Vec<f64> = [0.0, 1.0, 1.5, 2.0, 3.0, 9.0].map(|t| a.at(t)).to_vec();
        assert_eq!(values, [0.0, 0.0, 2.0, 4.0, 2.0, 0.0]);
        let rates: Vec<f64> = [0.0, 1.0, 1.5, 2.0, 3.0, 9.0].map(|t| a.rate(t)).to_vec();
        assert_eq!(rates, [0.0, 4.0, 4.0, 4.0, -2.0, 0.0]);
    }

    #[test]
    fn smooth_steps_rest_at_their_points() {
        let a = smooth();
        let values = [0.0, 1.0, 1.5, 2.0, 3.0, 4.0, 9.0].map(|t| a.at(t));
        assert_eq!(values, [0.0, 0.0, 2.0, 4.0, 2.0, 0.0, 0.0]);
        let rates = [0.0, 1.0, 1.5, 2.0, 3.0, 4.0, 9.0].map(|t| a.rate(t));
        assert_eq!(rates, [0.0, 0.0, 7.5, 0.0, -3.75, 0.0, 0.0]);
        // 4 * 0.25^3 (10 - 15 / 4 + 6 / 16)
        close(a.at(1.25), 0.4140625);
    }

    #[test]
    fn signals_at_points_known_in_closed_form() {
        let a = periodic();
        for (t, wanted) in [(0.0, 2.0), (1.0, 1.5), (1.5, 6.0), (2.0, 0.5), (3.0, 1.5)] {
            close(a.at(t), wanted);
        }
        close(a.rate(1.0), PI * 3.5);
        close(decay().at(0.9), 2.0);
        close(decay().at(1.5), 2.0 + 3.0 / E);
        close(decay().rate(1.0), -6.0);
        close(modulated().at(1.25), 2.0 + 1.5 * 2.0_f64.sqrt());
        close(modulated().at(1.0), 2.0);
        close(modulated().rate(1.0), 0.0);
    }

    #[test]
    fn values_are_derivatives_of_the_integrals() {
        let h = 1e-4;
        let table = amplitude(Curve::Linear(vec![(1.0, 1.0), (2.0, 4.0), (4.0, 0.5)]));
        for a in [table, smooth(), periodic(), decay(), modulated()] {
            for t in [0.3, 1.1, 1.3, 1.77, 2.4, 3.9, 5.0] {
                let [before, at, after] = [t - h, t, t + h].map(|t| a.integrals(t));
                let first = (after[0] - before[0]) / (2.0 * h);
                let second = (after[1] - before[1]) / (2.0 * h);
                assert!((a.at(t) - first).abs() < 1e-6, "{a:?} at {t}: {first}");
                assert!((at[0] - second).abs() < 1e-6, "{a:?} at {t}: {second}");
            }
        }
    }

    #[test]
    fn integrals_known_in_closed_form() {
        let table = amplitude(Curve::Linear(vec![(1.0, 0.0), (2.0, 4.0)]));
        assert_eq!(table.integrals(2.0), [2.0, 2.0 / 3.0]);
        assert_eq!(
            table.integrals(4.0),
            [10.0, 2.0 / 3.0 + 2.0 * 2.0 + 4.0 * 2.0]
        );
        assert_eq!(table.integrals(0.0), [0.0, 0.0]);
        let step = amplitude(Curve::SmoothStep(vec![(0.0, 0.0), (2.0, 3.0)]));
        close(step.integrals(2.0)[0], 3.0);
        close(step.integrals(2.0)[1], 12.0 / 7.0);
        close(decay().integrals(1.5)[0], 1.0 + 1.5 * (1.0 - 1.0 / E));
        close(periodic().integrals(3.0)[0], 4.0);
    }

    #[test]
    fn rates_are_derivatives_of_the_values() {
        let h = 1e-5;
        for a in [smooth(), periodic(), decay(), modulated()] {
            for t in [0.3, 1.1, 1.3, 1.77, 2.4, 3.9, 5.0] {
                let difference = (a.at(t + h) - a.at(t - h)) / (2.0 * h);
                assert!((a.rate(t) - difference).abs() < 1e-7, "{a:?} at {t}");
            }
        }
    }
}
