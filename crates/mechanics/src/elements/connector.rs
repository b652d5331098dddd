//! Springs and dashpots: force, tangent, stored and dissipated energy. See docs/theory/elements.md, Springs and
//! dashpots.
//!
//! Vectors of a connector have two entries for each of its nodes, like the vectors of an element.

use nalgebra::{Matrix2, Vector2};
use smallvec::SmallVec;

use super::motion::{Increment, Motion, TangentPart};
use crate::model::{Connector, ConnectorDirection, ConnectorLaw, Model};

/// Two entries for each node of a connector.
pub(super) type ConnectorVector = SmallVec<[f64; 4]>;
/// Matrix with D x D entries, column by column.
pub(super) type ConnectorMatrix = SmallVec<[f64; 16]>;

/// Elongation of a connector, and its derivative with respect to the displacements of the nodes; for a connector along
/// a line the derivatives at both nodes are opposite.
struct Elongation {
    /// Elongation l - L (length).
    value: f64,
    /// Gradient of the elongation at each node.
    gradient: [Vector2<f64>; 2],
    /// Vector r = x_2 - x_1 and its length, for a connector along a line.
    line: Option<(Vector2<f64>, f64)>,
}

/// Elongations from the start to the end of a motion.
struct Between {
    /// Elongations at the start and at the end of the motion.
    ends: [f64; 2],
    /// Change l1 - l0 of the elongation, with only the round-off of the displacement increment d.
    change: f64,
    /// Discrete gradient at each node: the vector g with g.d = l1 - l0.
    gradient: [Vector2<f64>; 2],
    /// Derivative of the elongation l1 with respect to the increment d at each node.
    derivative: [Vector2<f64>; 2],
    /// Derivative of the discrete gradient g with respect to the increment at each node, for connectors between angles.
    bend: [f64; 2],
}

/// State of a connector at one time.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ConnectorState {
    /// Elongation (length); between angles the difference of the angles.
    pub elongation: f64,
    /// Rate of the elongation (length/time), or of the difference of the angles (1/time).
    pub rate: f64,
    /// Force, positive if it pulls the nodes together (force); between angles a moment (force length).
    pub force: f64,
}

/// A connector between nodes at their reference positions.
#[derive(Debug, Clone)]
pub struct PlacedConnector {
    connector: Connector,
    /// Nodes of the connector; between angles, the pairs of dofs to which the angles belong.
    nodes: SmallVec<[usize; 2]>,
    /// The lengths L of the bodies of both angles: the displacement at the dof of an angle theta is
    /// L theta.
    lengths: [f64; 2],
    /// Vector X_2 - X_1 between the nodes in the reference configuration (length).
    reference: Vector2<f64>,
}

impl PlacedConnector {
    /// A connector of a model.
    pub fn new(connector: &Connector, model: &Model) -> Self {
        let at = |node: usize| Vector2::from(model.mesh.coordinates[node]);
        let angle_at = |node: &usize| {
            let mut bodies = model.rigid_bodies.iter();
            let found = bodies.find(|body| body.reference == *node);
            found.map_or(*node, |body| model.angle_of(body) / 2)
        };
        let nodes = match connector.direction {
            ConnectorDirection::Angle => connector.nodes.iter().map(angle_at).collect(),
            ConnectorDirection::Line | ConnectorDirection::Fixed(_) => connector.nodes.clone(),
        };
        let reference = match connector.nodes[..] {
            [a, b] => at(b) - at(a),
            _ => Vector2::zeros(),
        };
        PlacedConnector {
            connector: connector.clone(),
            nodes,
            lengths: [1.0; 2],
            reference,
        }
    }

    /// Nodes of the connector; between angles the pairs of dofs to which the angles belong.
    pub(super) fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    /// Sets the length of the body whose angle is the first dof of a pair.
    pub(super) fn measure_angle(&mut self, pair: usize, length: f64) {
        if self.connector.direction == ConnectorDirection::Angle {
            let all = self.nodes.iter().zip(&mut self.lengths);
            let own = all.filter(|(node, _)| **node == pair);
            own.for_each(|(_, own)| *own = length);
        }
    }

    /// Whether the connector is a dashpot.
    pub(super) fn is_dashpot(&self) -> bool {
        self.connector.law == ConnectorLaw::Dashpot
    }

    /// Elongation of the connector, its rate, and the force at displacements `u` and velocities
    /// `v`.
    pub fn state(&self, u: &[f64], v: &[f64]) -> ConnectorState {
        let at = self.at(u);
        let along = self.nodes().iter().zip(&at.gradient);
        let rate = along.map(|(&node, g)| g.x * v[2 * node] + g.y * v[2 * node + 1]);
        let rate = rate.sum();
        let follows = if self.is_dashpot() { rate } else { at.value };
        ConnectorState {
            elongation: at.value,
            rate,
            force: self.connector.curve.at(follows),
        }
    }

    fn at(&self, u: &[f64]) -> Elongation {
        let nodes = self.nodes();
        let of = |node: usize| Vector2::new(u[2 * node], u[2 * node + 1]);
        match (self.connector.direction, nodes) {
            (ConnectorDirection::Line, &[a, b]) => {
                let w = of(b) - of(a);
                let r = self.reference + w;
                let l = r.norm();
                let n = r / l;
                // l - L = w.(R + r)/(L + l), whose round-off is that of w and not of l
                let elongation = w.dot(&(self.reference + r)) / (self.reference.norm() + l);
                Elongation {
                    value: elongation,
                    gradient: [-n, n],
                    line: Some((r, l)),
                }
            }
            (ConnectorDirection::Fixed(both), nodes) => {
                let [e, f] = both.map(Vector2::from);
                let first = nodes.first().map_or(0.0, |&node| e.dot(&of(node)));
                let second = nodes.get(1).map_or(0.0, |&node| f.dot(&of(node)));
                Elongation {
                    value: first - second,
                    gradient: [e, -f],
                    line: None,
                }
            }
            (ConnectorDirection::Angle, nodes) => {
                let [a, b] = self.lengths.map(|length| 1.0 / length);
                let angle = |k: usize, part: f64| nodes.get(k).map_or(0.0, |n| u[2 * n] * part);
                Elongation {
                    value: angle(0, a) - angle(1, b),
                    gradient: [Vector2::x() * a, -Vector2::x() * b],
                    line: None,
                }
            }
            (ConnectorDirection::Line, _) => Elongation {
                value: 0.0,
                gradient: [Vector2::zeros(); 2],
                line: None,
            },
        }
    }

    /// The elongations l0 and l1 at the ends of a motion, and a vector g at each node with g.d = l1 - l0, the
    /// discrete gradient of the elongation, eq. (2.20):
    ///
    /// ```text
    /// along a line    (r0 + r1)/(|r0| + |r1|)
    /// between angles  dtheta/(L c),  c = 2 tan(dtheta/2)
    /// ```
    fn between(&self, u0: &[f64], u1: &[f64]) -> Between {
        let [start, end] = [self.at(u0), self.at(u1)];
        let mut between = Between {
            ends: [start.value, end.value],
            change: end.value - start.value,
            gradient: end.gradient,
            derivative: end.gradient,
            bend: [0.0; 2],
        };
        if let (Some((r0, l0)), Some((r1, l1))) = (start.line, end.line) {
            let n = (r0 + r1) / (l0 + l1);
            between.gradient = [-n, n];
            let d = |node: usize| {
                Vector2::new(
                    u1[2 * node] - u0[2 * node],
                    u1[2 * node + 1] - u0[2 * node + 1],
                )
            };
            let both = self.nodes().iter().zip(&between.gradient);
            between.change = both.map(|(&node, g)| g.dot(&d(node))).sum();
        }
        if self.connector.direction == ConnectorDirection::Angle {
            for (k, &node) in self.nodes.iter().enumerate() {
                let half = (u1[2 * node] - u0[2 * node]) / self.lengths[k] / 2.0;
                // dtheta/c and d theta_1/dc = 1/(1 + c²/4)
                let (mean, slope) = match half {
                    0.0 => (1.0, 1.0),
                    half => (half / half.tan(), half.cos().powi(2)),
                };
                // d(dtheta/c)/dc = (slope - mean)/c
                let bend = if half.abs() < f64::EPSILON.sqrt() {
                    0.0
                } else {
                    (slope - mean) / (2.0 * half.tan() * self.lengths[k])
                };
                between.bend[k] = end.gradient[k].x * bend;
                between.gradient[k] *= mean;
                between.derivative[k] *= slope;
            }
        }
        between
    }

    fn vector(&self, factor: f64, gradient: &[Vector2<f64>; 2]) -> ConnectorVector {
        let nodes = gradient.iter().take(self.nodes().len());
        nodes.flat_map(|g| [factor * g.x, factor * g.y]).collect()
    }

    /// The matrix of a connector, made from 2 x 2 blocks: `block(a, b)` belongs to the nodes a and b.
    fn matrix(&self, block: impl Fn(usize, usize) -> Matrix2<f64>) -> ConnectorMatrix {
        let count = self.nodes().len();
        let mut matrix = SmallVec::new();
        for b in 0..count {
            for j in 0..2 {
                for a in 0..count {
                    for i in 0..2 {
                        matrix.push(block(a, b)[(i, j)]);
                    }
                }
            }
        }
        matrix
    }

    /// Internal force of a spring at the end of a motion, F(l1) dl/du, or the energy-momentum form from start to end,
    /// eq. (2.20): the mean of F between l0 and l1, along the discrete gradient.
    pub(super) fn force(&self, motion: Motion) -> ConnectorVector {
        let curve = &self.connector.curve;
        if self.is_dashpot() {
            return self.vector(0.0, &[Vector2::zeros(); 2]);
        }
        match (motion.start, motion.increment) {
            (Some(start), _) => {
                let between = self.between(start, motion.end);
                let [l0, l1] = between.ends;
                self.vector(curve.mean(l0, l1), &between.gradient)
            }
            (None, Some([u0, u1])) if self.connector.direction == ConnectorDirection::Angle => {
                let gradient = self.between(u0, u1).gradient;
                self.vector(curve.at(self.at(motion.end).value), &gradient)
            }
            (None, _) => {
                let at = self.at(motion.end);
                self.vector(curve.at(at.value), &at.gradient)
            }
        }
    }

    /// Symmetric part of the tangent of [`Self::force`], or the positive part of this matrix, eq. (2.21). In the
    /// energy-momentum form the result is twice the tangent, as for elements.
    pub(super) fn tangent(&self, motion: Motion, part: TangentPart) -> ConnectorMatrix {
        let curve = &self.connector.curve;
        if self.is_dashpot() {
            return self.matrix(|_, _| Matrix2::zeros());
        }
        let at = self.at(motion.end);
        let (mut derivative, mut bend) = (at.gradient, [0.0; 2]);
        let (slope, force, direction, length) = match motion.start {
            Some(start) => {
                let between = self.between(start, motion.end);
                let [l0, l1] = between.ends;
                derivative = between.derivative;
                bend = between.bend.map(|bend| 2.0 * bend);
                let length = match (self.at(start).line, at.line) {
                    (Some((_, l0)), Some((_, l1))) => (l0 + l1) / 2.0,
                    _ => f64::INFINITY,
                };
                let slope = 2.0 * curve.mean_slope(l0, l1);
                (slope, curve.mean(l0, l1), between.gradient, length)
            }
            None => {
                let length = at.line.map_or(f64::INFINITY, |(_, l)| l);
                (
                    curve.slope(at.value),
                    curve.at(at.value),
                    at.gradient,
                    length,
                )
            }
        };
        let (slope, geometric) = match part {
            TangentPart::Whole => (slope, force / length),
            TangentPart::Positive => (slope.max(0.0), (force / length).max(0.0)),
        };
        let fixed = at.line.is_none();
        let own = |k: f64| match part {
            TangentPart::Whole => k,
            TangentPart::Positive => k.max(0.0),
        };
        self.matrix(|a, b| {
            // F' g g1^T + F/l (1 - g g1^T), its symmetric part
            let both = direction[a] * derivative[b].transpose();
            let both = (both + derivative[a] * direction[b].transpose()) / 2.0;
            let sign = if a == b { 1.0 } else { -1.0 };
            match fixed {
                true if a == b => slope * both + Matrix2::new(own(force * bend[a]), 0.0, 0.0, 0.0),
                true => slope * both,
                false => (slope - geometric) * both + Matrix2::identity() * (sign * geometric),
            }
        })
    }

    /// Energy that a spring stores at displacements `u` (force length).
    pub(super) fn energy(&self, u: &[f64]) -> f64 {
        match self.connector.law {
            ConnectorLaw::Spring => self.connector.curve.integral(0.0, self.at(u).value),
            ConnectorLaw::Dashpot => 0.0,
        }
    }

    /// Impulse dt F((l1 - l0)/dt) of a dashpot, along the discrete gradient, in an increment of length `dt`, eq. (2.22)
    /// (force time).
    pub(super) fn impulse(&self, [u0, u1]: Increment, dt: f64) -> ConnectorVector {
        let between = self.between(u0, u1);
        let force = self.connector.curve.at(between.change / dt);
        self.vector(dt * force, &between.gradient)
    }

    /// Energy that a dashpot dissipates in an increment of length `dt`, multiplied by `dt`: (l1 - l0) F dt.
    pub(super) fn work(&self, [u0, u1]: Increment, dt: f64) -> f64 {
        let change = self.between(u0, u1).change;
        change * dt * self.connector.curve.at(change / dt)
    }

    /// Damping matrix dF/dv g g^T of a dashpot: the part of the derivative of eq. (2.22) that is never indefinite
    /// (force time/length).
    pub(super) fn damping(&self, [u0, u1]: Increment, dt: f64) -> ConnectorMatrix {
        let Between {
            change, gradient, ..
        } = self.between(u0, u1);
        let slope = self.connector.curve.slope(change / dt).max(0.0);
        self.matrix(|a, b| slope * gradient[a] * gradient[b].transpose())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::ForceCurve;

    const X: [[f64; 2]; 2] = [[0.3, -0.2], [1.1, 0.7]];
    const U0: [f64; 4] = [0.1, 0.05, -0.2, 0.3];
    const U1: [f64; 4] = [-0.3, 0.4, 0.6, -0.1];

    fn connectors(law: ConnectorLaw) -> Vec<PlacedConnector> {
        let table = ForceCurve::Table(vec![[-2.0, -3.0], [-0.05, -0.5], [0.1, 0.4], [2.0, 1.0]]);
        let fixed = [[0.6, 0.8], [0.0, -1.0]];
        let directions = [ConnectorDirection::Line, ConnectorDirection::Fixed(fixed)];
        let mut model = Model::default();
        model.mesh.coordinates = X.to_vec();
        let of = |direction| {
            [ForceCurve::Linear(7.0), table.clone()].map(|curve| {
                let nodes = SmallVec::from_slice(&[0, 1]);
                let connector = Connector {
                    label: 1,
                    nodes,
                    direction,
                    law,
                    curve,
                };
                PlacedConnector::new(&connector, &model)
            })
        };
        let mut all: Vec<PlacedConnector> = directions.into_iter().flat_map(of).collect();
        let mut grounded = all[2].clone();
        grounded.connector.nodes.truncate(1);
        all.push(grounded);
        all
    }

    fn between() -> Motion<'static> {
        Motion {
            start: Some(&U0),
            ..Motion::at(&U1, &[])
        }
    }

    fn dot(a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).map(|(a, b)| a * b).sum()
    }

    /// The displacement increment d from U0 to U1.
    fn d() -> Vec<f64> {
        U1.iter().zip(U0).map(|(a, b)| a - b).collect()
    }

    #[test]
    fn energy_momentum_forces_do_the_work_that_is_stored_or_dissipated() {
        for spring in connectors(ConnectorLaw::Spring) {
            let work = dot(&d(), &spring.force(between()));
            assert!((work - (spring.energy(&U1) - spring.energy(&U0))).abs() < 1e-14);
        }
        for dashpot in connectors(ConnectorLaw::Dashpot) {
            let (work, dt) = (dashpot.work([&U0, &U1], 0.1), 0.1);
            assert!((dot(&d(), &dashpot.impulse([&U0, &U1], dt)) - work).abs() < 1e-14);
            assert_eq!(dashpot.energy(&U1), 0.0);
            assert!(dashpot.force(between()).iter().all(|f| *f == 0.0));
        }
    }

    /// For small displacements, and for small changes of large displacements, forces keep their digits: forces do not
    /// contain the round-off of coordinates.
    #[test]
    fn forces_along_a_line_keep_their_digits() {
        let [spring, dashpot] =
            [ConnectorLaw::Spring, ConnectorLaw::Dashpot].map(|law| connectors(law).swap_remove(0));
        for size in [1e-3, 1e-6, 1e-9, 1e-12, 1e-15] {
            let small = U1.map(|u| size * u);
            let pull = spring.force(Motion::at(&small, &[]))[2];
            // the force divided by the size is its linear part plus a term of first order in the
            // size
            let r = [X[1][0] - X[0][0], X[1][1] - X[0][1]];
            let l = r[0].hypot(r[1]);
            let linear = 7.0 * (r[0] * (U1[2] - U1[0]) + r[1] * (U1[3] - U1[1])) / l * r[0] / l;
            assert!(
                (pull / size - linear).abs() < 20.0 * size + 1e-13,
                "{size:e}"
            );
            let later: Vec<f64> = U0.iter().zip(U1).map(|(u0, u1)| u0 + size * u1).collect();
            let d: Vec<f64> = later.iter().zip(U0).map(|(u1, u0)| u1 - u0).collect();
            let force = dashpot.impulse([&U0, &later], 1.0);
            let between = dashpot.between(&U0, &later);
            let [from, to] = between.gradient.map(|g| [g.x, g.y]);
            let change = dot(&d, &[from, to].concat());
            assert!((force[2] - 7.0 * change * to[0]).abs() <= 1e-14 * force[2].abs());
        }
    }

    #[test]
    fn forces_along_a_line_have_no_resultant_and_no_moment() {
        let [spring, dashpot] =
            [ConnectorLaw::Spring, ConnectorLaw::Dashpot].map(|law| connectors(law).swap_remove(1));
        for f in [spring.force(between()), dashpot.impulse([&U0, &U1], 0.1)] {
            let mid = |i: usize| X[i / 2][i % 2] + (U0[i] + U1[i]) / 2.0;
            let moment = mid(0) * f[1] - mid(1) * f[0] + mid(2) * f[3] - mid(3) * f[2];
            assert!((f[0] + f[2]).abs() + (f[1] + f[3]).abs() < 1e-15 && moment.abs() < 1e-15);
            assert!(f[0].abs() > 0.01);
        }
    }

    /// Symmetric part of the derivative of a vector with respect to the displacements of the end.
    fn symmetric_derivative(of: impl Fn(&[f64]) -> ConnectorVector) -> Vec<f64> {
        let n = of(&U1).len();
        let h = 1e-6;
        let column = |j: usize| {
            let at = |step: f64| {
                let mut u = U1;
                u[j] += step;
                of(&u)
            };
            let (up, down) = (at(h), at(-h));
            (0..n)
                .map(|i| (up[i] - down[i]) / (2.0 * h))
                .collect::<Vec<_>>()
        };
        let columns: Vec<Vec<f64>> = (0..n).map(column).collect();
        let both = |k: usize| (columns[k / n][k % n] + columns[k % n][k / n]) / 2.0;
        (0..n * n).map(both).collect()
    }

    fn assert_near(k: &[f64], derivative: &[f64], factor: f64) {
        for (k, derivative) in k.iter().zip(derivative) {
            assert!((k - factor * derivative).abs() < 1e-7, "{k} {derivative}");
        }
    }

    #[test]
    fn tangents_are_derivatives_of_forces() {
        for spring in connectors(ConnectorLaw::Spring) {
            let k = spring.tangent(Motion::at(&U1, &[]), TangentPart::Whole);
            let force = |u: &[f64]| spring.force(Motion::at(u, &[]));
            assert_near(&k, &symmetric_derivative(force), 1.0);
            let k = spring.tangent(between(), TangentPart::Whole);
            let force = |u: &[f64]| {
                spring.force(Motion {
                    start: Some(&U0),
                    ..Motion::at(u, &[])
                })
            };
            assert_near(&k, &symmetric_derivative(force), 2.0);
        }
        // the matrix of dashpots omits the rotation of their line
        for dashpot in connectors(ConnectorLaw::Dashpot).drain(2..) {
            let c = dashpot.damping([&U0, &U1], 0.1);
            let impulse = |u: &[f64]| dashpot.impulse([&U0, u], 0.1);
            assert_near(&c, &symmetric_derivative(impulse), 1.0);
        }
    }

    #[test]
    fn state_has_the_rate_of_the_elongation() {
        let spring = &connectors(ConnectorLaw::Spring)[0];
        let (v, h) = ([0.3, -0.1, 0.2, 0.5], 1e-6);
        let moved: Vec<f64> = U1.iter().zip(v).map(|(u, v)| u + h * v).collect();
        let [now, then] = [&U1[..], &moved].map(|u| spring.state(u, &v));
        assert!(((then.elongation - now.elongation) / h - now.rate).abs() < 1e-5);
        assert!((now.force - 7.0 * now.elongation).abs() < 1e-14);
    }
}
