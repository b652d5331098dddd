//! Amplitudes: tabulated functions of time with their value and rate. The rate is the velocity of a
//! prescribed displacement (docs/theory.md, section 4).

/// Time that an amplitude is a function of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TimeBase {
    /// Time since the start of the step.
    Step,
    /// Time since the start of the analysis.
    Total,
}

/// A piecewise linear function of time, constant outside its table.
#[derive(Debug, Clone, PartialEq)]
pub struct Amplitude {
    /// Name in the deck.
    pub name: String,
    /// Its time.
    pub time: TimeBase,
    /// Points (time, value), times strictly increasing, at least one.
    pub points: Vec<(f64, f64)>,
}

impl Amplitude {
    /// Value at time `t` (step or total time, as `self.time` says).
    pub fn at(&self, t: f64) -> f64 {
        let (first, last) = (self.points[0], self.points[self.points.len() - 1]);
        if t <= first.0 {
            return first.1;
        }
        if t >= last.0 {
            return last.1;
        }
        let (p, q) = self.interval(t);
        p.1 + (q.1 - p.1) * ((t - p.0) / (q.0 - p.0))
    }

    /// Derivative at `t`; at a point of the table the slope of the interval before it, at the first
    /// point of the interval after it.
    pub fn rate(&self, t: f64) -> f64 {
        let (first, last) = (self.points[0], self.points[self.points.len() - 1]);
        if self.points.len() == 1 || t < first.0 || t > last.0 {
            return 0.0;
        }
        let (p, q) = self.interval(t);
        (q.1 - p.1) / (q.0 - p.0)
    }

    /// The interval (p, q] of the table with p.0 < t <= q.0, or the first one.
    fn interval(&self, t: f64) -> ((f64, f64), (f64, f64)) {
        let end = self
            .points
            .partition_point(|p| p.0 < t)
            .clamp(1, self.points.len() - 1);
        (self.points[end - 1], self.points[end])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn piecewise_linear_with_constant_ends() {
        let points = vec![(1.0, 0.0), (2.0, 4.0), (4.0, 0.0)];
        let a = Amplitude {
            name: "A".into(),
            time: TimeBase::Step,
            points,
        };
        let values: Vec<f64> = [0.0, 1.0, 1.5, 2.0, 3.0, 9.0].map(|t| a.at(t)).to_vec();
        assert_eq!(values, [0.0, 0.0, 2.0, 4.0, 2.0, 0.0]);
        let rates: Vec<f64> = [0.0, 1.0, 1.5, 2.0, 3.0, 9.0].map(|t| a.rate(t)).to_vec();
        assert_eq!(rates, [0.0, 4.0, 4.0, 4.0, -2.0, 0.0]);
    }
}
