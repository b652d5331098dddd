//! Constraint of a slave node at a segment: projection, gap and rows of Bn and Bt, of the end
//! configuration (section 3 of docs/theory.md) or as discrete gradients (section 7).

use super::configurations::{Configurations, RowForm};
use super::constraint::{Constraint, Rows};
use crate::contact::geometry::{Projection, project};
use crate::contact::targets::PairTarget;

/// A node on a segment, with the rows at s, a and b.
pub(super) struct SegmentRows {
    pub projection: Projection,
    pub normal: [f64; 6],
    pub tangential: [f64; 6],
}

/// The constraint of the slave node s at the segment from a to b; nodes s, a, b.
pub(super) fn constraint(source: PairTarget, at: &Configurations) -> Constraint {
    let [s, a, b, _] = source.nodes;
    let SegmentRows {
        projection,
        normal,
        tangential,
    } = segment_rows([s, a, b], at);
    let rows = Rows::new(&normal, &tangential);
    let gap_and_scale = (projection.gap, projection.length);
    Constraint::of_nodes(source, &[s, a, b], rows, gap_and_scale, at)
}

/// Projection and rows of the node s on the segment from a to b.
pub(super) fn segment_rows(nodes: [usize; 3], at: &Configurations) -> SegmentRows {
    let end = at.iterate(nodes);
    let (normal, tangential) = match at.form {
        RowForm::End => end_rows(end),
        RowForm::DiscreteGradient => discrete_gradient_rows(at.start(nodes), end),
    };
    let [s, a, b] = end;
    SegmentRows {
        projection: project(s, a, b),
        normal,
        tangential,
    }
}

/// Rows of the end configuration, eq. (3.4): e_n at s, -(1 - xi) e_n at a, -xi e_n at b; the same with
/// e_t.
fn end_rows([s, a, b]: [[f64; 2]; 3]) -> ([f64; 6], [f64; 6]) {
    let p = project(s, a, b);
    let weights = [1.0, -(1.0 - p.xi), -p.xi];
    let row = |e: [f64; 2]| std::array::from_fn(|k| weights[k / 2] * e[k % 2]);
    (row(p.normal), row(p.tangent))
}

/// Discrete gradients between the positions `start` and `end` of s, a and b.
///
/// With a = x_s - x_a, e = x_b - x_a the gap g = pi2/sqrt(pi3) and the projection xi = pi1/pi3 are
/// functions of pi1 = a.e, pi2 = a x e, pi3 = e.e, eq. (7.1), quadratic in the positions: their
/// gradients at the mid configuration are exact difference quotients.
fn discrete_gradient_rows(start: [[f64; 2]; 3], end: [[f64; 2]; 3]) -> ([f64; 6], [f64; 6]) {
    let arms = |[s, a, b]: [[f64; 2]; 3]| ([s[0] - a[0], s[1] - a[1]], [b[0] - a[0], b[1] - a[1]]);
    let ((a0, e0), (a1, e1)) = (arms(start), arms(end));
    let dot = |p: [f64; 2], q: [f64; 2]| p[0] * q[0] + p[1] * q[1];
    let cross = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
    let mean = |p: [f64; 2], q: [f64; 2]| [(p[0] + q[0]) / 2.0, (p[1] + q[1]) / 2.0];
    let (a, e) = (mean(a0, a1), mean(e0, e1));
    let (l0, l1) = (dot(e0, e0).sqrt(), dot(e1, e1).sqrt());

    // gradients of pi1, pi2, pi3 with respect to (a, e)
    let (pi1_a, pi1_e) = (e, a);
    let (pi2_a, pi2_e) = ([e[1], -e[0]], [-a[1], a[0]]);
    let pi3_e = [2.0 * e[0], 2.0 * e[1]];

    // Bn = alpha grad pi2 + beta grad pi3, alpha = (1/l0 + 1/l1)/2,
    // beta = -(pi2_0 + pi2_1)/2 / (l0 l1 (l0 + l1)), eq. (7.2)
    let alpha = (1.0 / l0 + 1.0 / l1) / 2.0;
    let beta = -(cross(a0, e0) + cross(a1, e1)) / 2.0 / (l0 * l1 * (l0 + l1));
    let normal = nodal(
        [alpha * pi2_a[0], alpha * pi2_a[1]],
        [
            alpha * pi2_e[0] + beta * pi3_e[0],
            alpha * pi2_e[1] + beta * pi3_e[1],
        ],
    );

    // Bt = gamma grad pi1 + delta grad pi3, gamma = L (1/l0² + 1/l1²)/2,
    // delta = -L (pi1_0 + pi1_1)/2 / (l0² l1²), L = (l0 + l1)/2, eq. (7.3)
    let length = (l0 + l1) / 2.0;
    let gamma = length * (1.0 / (l0 * l0) + 1.0 / (l1 * l1)) / 2.0;
    let delta = -length * (dot(a0, e0) + dot(a1, e1)) / 2.0 / (l0 * l0 * l1 * l1);
    let tangent = nodal(
        [gamma * pi1_a[0], gamma * pi1_a[1]],
        [
            gamma * pi1_e[0] + delta * pi3_e[0],
            gamma * pi1_e[1] + delta * pi3_e[1],
        ],
    );
    (normal, tangent)
}

/// From parts with respect to (a, e) to the nodes: s: a-part, a: -(a-part) - (e-part), b: e-part.
fn nodal(a: [f64; 2], e: [f64; 2]) -> [f64; 6] {
    [a[0], a[1], -a[0] - e[0], -a[1] - e[1], e[0], e[1]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::geometry::position;
    use crate::contact::targets::ContactTarget;

    const X: [[f64; 2]; 3] = [[0.7, 0.4], [2.0, 0.1], [-0.5, -0.2]];
    const U0: [f64; 6] = [0.1, -0.05, 0.02, 0.07, -0.03, 0.01];
    const U1: [f64; 6] = [-0.4, -0.35, 0.3, 0.2, 0.25, -0.3];

    fn between(form: RowForm, u0: &[f64], u: &[f64]) -> Constraint {
        let source = PairTarget {
            slave_index: 0,
            target: ContactTarget {
                segment: 0,
                corner: None,
            },
            nodes: [0, 1, 2, 2],
            friction: 0.3,
        };
        let x = &X;
        Constraint::new(source, &Configurations { form, x, u0, u })
    }

    fn projected(u: &[f64]) -> Projection {
        project(position(&X, u, 0), position(&X, u, 1), position(&X, u, 2))
    }

    #[test]
    fn end_rows_are_the_derivative_of_the_gap() {
        let constraint = between(RowForm::End, &U0, &U1);
        assert_eq!(constraint.gap, projected(&U1).gap);
        assert_eq!(constraint.dofs[..], [0, 1, 2, 3, 4, 5]);
        for k in 0..6 {
            let mut u = [U1, U1];
            u[0][k] += 1e-6;
            u[1][k] -= 1e-6;
            let quotient = (projected(&u[0]).gap - projected(&u[1]).gap) / 2e-6;
            let row = &constraint.derivative_rows().normal;
            assert!((row[k] - quotient).abs() < 1e-9, "{k}");
        }
    }

    #[test]
    fn discrete_gradients_are_exact_differences() {
        let constraint = between(RowForm::DiscreteGradient, &U0, &U1);
        let (start, end) = (projected(&U0), projected(&U1));
        assert!((constraint.start_gap - start.gap).abs() < 1e-14);
        let length = (start.length + end.length) / 2.0;
        assert!((constraint.slip - length * (end.xi - start.xi)).abs() < 1e-14);
    }

    #[test]
    fn discrete_gradients_keep_momentum() {
        let constraint = between(RowForm::DiscreteGradient, &U0, &U1);
        let Rows { normal, tangential } = &constraint.force_rows;
        for row in [normal, tangential] {
            assert!((row[0] + row[2] + row[4]).abs() < 1e-15);
            assert!((row[1] + row[3] + row[5]).abs() < 1e-15);
            let moment: f64 = (0..3)
                .map(|n| {
                    let x = position(&X, &U0, n)[0] / 2.0 + position(&X, &U1, n)[0] / 2.0;
                    let y = position(&X, &U0, n)[1] / 2.0 + position(&X, &U1, n)[1] / 2.0;
                    x * row[2 * n + 1] - y * row[2 * n]
                })
                .sum();
            assert!(moment.abs() < 1e-15);
        }
    }

    #[test]
    fn both_forms_agree_when_nothing_moves() {
        let rows = |form| between(form, &U1, &U1).force_rows;
        let (p, q) = (rows(RowForm::End), rows(RowForm::DiscreteGradient));
        for (p, q) in p.normal.iter().zip(&q.normal) {
            assert!((p - q).abs() < 1e-15);
        }
        // The tangents agree at the slave node; on the segment they differ by the gap.
        assert!((p.tangential[0] - q.tangential[0]).abs() < 1e-15);
        assert!((p.tangential[1] - q.tangential[1]).abs() < 1e-15);
    }
}
