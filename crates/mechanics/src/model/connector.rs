//! Springs and dashpots: forces between two nodes, or between a node and the ground, that depend on their distance or
//! on its rate. See docs/theory/elements.md.

use smallvec::SmallVec;

/// A spring or dashpot (`*SPRING`, `*DASHPOT`).
#[derive(Debug, Clone, PartialEq)]
pub struct Connector {
    /// Element number in the deck.
    pub label: u64,
    /// The two nodes of the connector, or its one node if the other end is the ground.
    pub nodes: SmallVec<[usize; 2]>,
    /// Direction in which the elongation is measured.
    pub direction: ConnectorDirection,
    /// Quantity on which the force depends.
    pub law: ConnectorLaw,
    /// Its force.
    pub curve: ForceCurve,
}

impl Connector {
    /// Whether the forces of the connector on its nodes have no resultant.
    pub fn has_no_resultant(&self) -> bool {
        let alike = match self.direction {
            ConnectorDirection::Line | ConnectorDirection::Angle => true,
            ConnectorDirection::Fixed([first, second]) => first == second,
        };
        alike && self.nodes.len() == 2
    }

    /// Name of the connector's type: `SPRINGA`, `DASHPOT1` ...
    pub fn type_name(&self) -> String {
        let family = match self.law {
            ConnectorLaw::Spring => "SPRING",
            ConnectorLaw::Dashpot => "DASHPOT",
        };
        let form = match (self.direction, self.nodes.len()) {
            (ConnectorDirection::Line, _) => "A",
            (_, 1) => "1",
            (_, _) => "2",
        };
        format!("{family}{form}")
    }
}

/// Direction in which the elongation of a connector is measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ConnectorDirection {
    /// Along the line between the nodes, which turns with the nodes: their distance less their distance in the
    /// reference configuration.
    Line,
    /// The displacement of the first node in the first direction, a unit vector, less the displacement of the second
    /// node in the second direction.
    Fixed([[f64; 2]; 2]),
    /// The rotation of the rigid body whose reference node is the first node, less the rotation of the body of the
    /// second node; the force is a moment.
    Angle,
}

/// Quantity on which the force of a connector depends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ConnectorLaw {
    /// A spring: the force depends on the elongation, and the work of the force is stored.
    Spring,
    /// A dashpot: the force depends on the rate of the elongation, and the work of the force is dissipated.
    Dashpot,
}

/// Force as a function of the elongation (length) or its rate (length/time); between angles, moment as a function of
/// the angle or its rate (1/time).
#[derive(Debug, Clone, PartialEq)]
pub enum ForceCurve {
    /// Proportional, with the factor k (force/length) or c (force time/length).
    Linear(f64),
    /// Piecewise linear between points (elongation or rate, force) in increasing order; constant beyond the points.
    Table(Vec<[f64; 2]>),
}

impl ForceCurve {
    /// F(x).
    pub fn at(&self, x: f64) -> f64 {
        match self {
            ForceCurve::Linear(k) => k * x,
            ForceCurve::Table(points) => {
                let next = points.partition_point(|[at, _]| *at <= x);
                match (
                    next.checked_sub(1).map(|last| points[last]),
                    points.get(next),
                ) {
                    (Some([a, f]), Some([b, g])) => f + (g - f) * ((x - a) / (b - a)),
                    (Some([_, f]), None) => f,
                    (None, Some([_, f])) => *f,
                    (None, None) => 0.0,
                }
            }
        }
    }

    /// Slope dF/dx; at a point of the table the slope to the right of the point.
    pub fn slope(&self, x: f64) -> f64 {
        match self {
            ForceCurve::Linear(k) => *k,
            ForceCurve::Table(points) => {
                let next = points.partition_point(|[at, _]| *at <= x);
                match (
                    next.checked_sub(1).map(|last| points[last]),
                    points.get(next),
                ) {
                    (Some([a, f]), Some([b, g])) => (g - f) / (b - a),
                    _ => 0.0,
                }
            }
        }
    }

    /// The integral of F from `a` to `b`.
    pub fn integral(&self, a: f64, b: f64) -> f64 {
        if a > b {
            return -self.integral(b, a);
        }
        match self {
            ForceCurve::Linear(k) => k * (b - a) * (b / 2.0 + a / 2.0),
            ForceCurve::Table(points) => {
                let between = points
                    .iter()
                    .map(|[at, _]| *at)
                    .filter(|&at| a < at && at < b);
                let mut from = a;
                let mut sum = 0.0;
                for to in between.chain([b]) {
                    sum += (to - from) * (self.at(from) + self.at(to)) / 2.0;
                    from = to;
                }
                sum
            }
        }
    }

    /// The mean of F between `a` and `b`.
    pub fn mean(&self, a: f64, b: f64) -> f64 {
        let within = match self {
            ForceCurve::Linear(_) => true,
            ForceCurve::Table(points) => {
                let (low, high) = (a.min(b), a.max(b));
                !points.iter().any(|&[at, _]| low < at && at < high)
            }
        };
        match within {
            // exact within one linear piece, also if a and b are near each other
            true => (self.at(a) + self.at(b)) / 2.0,
            false => self.integral(a, b) / (b - a),
        }
    }

    /// Derivative d mean(a, b)/db = (F(b) - mean)/(b - a) of the mean of F; half the slope of F if a = b.
    pub fn mean_slope(&self, a: f64, b: f64) -> f64 {
        let slope = (self.at(b) - self.mean(a, b)) / (b - a);
        match slope.is_finite() {
            true => slope,
            false => self.slope(b) / 2.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_means_and_energies_of_a_table() {
        let curve = ForceCurve::Table(vec![[-1.0, -4.0], [0.0, 0.0], [2.0, 2.0]]);
        for (x, f, slope) in [
            (-2.0, -4.0, 0.0),
            (-0.5, -2.0, 4.0),
            (1.0, 1.0, 1.0),
            (3.0, 2.0, 0.0),
        ] {
            assert_eq!((curve.at(x), curve.slope(x)), (f, slope));
        }
        // areas: 1/2 * 4 * 1 below the axis, 1/2 * 2 * 2 + 2 * 1 above it
        assert_eq!(curve.integral(-1.0, 0.0), -2.0);
        assert_eq!(curve.integral(0.0, 3.0), 4.0);
        assert_eq!(curve.integral(3.0, -1.0), -2.0);
        assert_eq!(curve.mean(-1.0, 3.0), 0.5);
        assert_eq!(curve.mean(0.5, 0.5), 0.5);
        let (a, b, h) = (-0.7, 1.3, 1e-6);
        let difference = (curve.mean(a, b + h) - curve.mean(a, b - h)) / (2.0 * h);
        assert!((curve.mean_slope(a, b) - difference).abs() < 1e-9);
        assert_eq!(curve.mean_slope(1.0, 1.0), 0.5);
        assert_eq!(ForceCurve::Linear(3.0).integral(1.0, 2.0), 4.5);
    }
}
