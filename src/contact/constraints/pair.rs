//! Contact constraints: gap, slip and rows of Bn and Bt, of the end configuration (section 3 of
//! docs/theory.md) or as discrete gradients (section 7).

use crate::contact::geometry::{position, project};
use crate::contact::targets::PairTarget;

/// How the rows Bn and Bt of a pair are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RowForm {
    /// Normal and tangent of the end configuration (SS22).
    End,
    /// Discrete gradients of gap and projection between start and end: Bn d = g1 - g0 and
    /// Bt d = L (xi1 - xi0) exactly, and both momenta are kept (energy-momentum form).
    DiscreteGradient,
}

/// A slave node with its master segment or corner, linearised at the current iterate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Its place.
    pub target: PairTarget,
    /// Length of the segment, at a corner that before it.
    pub length: f64,
    /// Gap g of the iterate (length).
    pub gap: f64,
    /// Gap of the start in the sense of the rows, g - Bn d (length).
    pub start_gap: f64,
    /// Slip Dt = Bt d since the start of the increment (length), eq. (3.5).
    pub slip: f64,
    /// Row of Bn at the dofs of s, a, b and c.
    pub normal: [f64; 8],
    /// Row of Bt at the same dofs.
    pub tangent: [f64; 8],
}

impl Pair {
    /// The pair at `target` between the displacements `u0` of the start and `u` of the iterate.
    pub fn new(target: PairTarget, form: RowForm, x: &[[f64; 2]], u0: &[f64], u: &[f64]) -> Self {
        let [s, a, b, c] = target.nodes;
        let face = |nodes: [usize; 3]| {
            let end = nodes.map(|n| position(x, u, n));
            let (normal, tangent) = match form {
                RowForm::End => end_rows(end),
                RowForm::DiscreteGradient => {
                    discrete_gradient_rows(nodes.map(|n| position(x, u0, n)), end)
                }
            };
            (project(end[0], end[1], end[2]), normal, tangent)
        };
        let (p, normal, tangent) = face([s, a, b]);
        let length = p.length;
        let (gap, normal, tangent) = match target.target.corner {
            None => (p.gap, wide(normal), wide(tangent)),
            // g = ((1 - w) g_i + w g_j)/|(1 - w) n_i + w n_j|, Bn and Bt likewise, eq. (10.3)
            Some(corner) => {
                let (q, next_normal, next_tangent) = face([s, b, c]);
                let n = [0, 1].map(|i| corner.blend(p.normal[i], q.normal[i]));
                let size = n[0].hypot(n[1]);
                let blend = |row: [f64; 6], next: [f64; 6]| {
                    let (row, next) = (wide(row), beyond(next));
                    std::array::from_fn(|k| corner.blend(row[k], next[k]) / size)
                };
                (
                    corner.blend(p.gap, q.gap) / size,
                    blend(normal, next_normal),
                    blend(tangent, next_tangent),
                )
            }
        };
        let mut pair = Pair {
            target,
            length,
            gap,
            start_gap: gap,
            slip: 0.0,
            normal,
            tangent,
        };
        // g0 = g - Bn d; Dt = Bt d, eq. (3.5)
        let d = pair.dofs().map(|dof| u[dof] - u0[dof]);
        pair.start_gap = gap - dot(&normal, &d);
        pair.slip = dot(&tangent, &d);
        pair
    }

    /// Dofs of s, a, b and c.
    pub fn dofs(&self) -> [usize; 8] {
        std::array::from_fn(|k| 2 * self.target.nodes[k / 2] + k % 2)
    }

    /// Bn v for a vector over all dofs.
    pub fn normal_of(&self, v: &[f64]) -> f64 {
        dot(&self.normal, &self.dofs().map(|dof| v[dof]))
    }

    /// Bt v for a vector over all dofs.
    pub fn tangent_of(&self, v: &[f64]) -> f64 {
        dot(&self.tangent, &self.dofs().map(|dof| v[dof]))
    }
}

fn dot(row: &[f64; 8], v: &[f64; 8]) -> f64 {
    row.iter().zip(v).map(|(b, v)| b * v).sum()
}

/// A row at s, a, b as one at s, a, b, c.
fn wide([sx, sy, ax, ay, bx, by]: [f64; 6]) -> [f64; 8] {
    [sx, sy, ax, ay, bx, by, 0.0, 0.0]
}

/// A row at s, b, c as one at s, a, b, c.
fn beyond([sx, sy, bx, by, cx, cy]: [f64; 6]) -> [f64; 8] {
    [sx, sy, 0.0, 0.0, bx, by, cx, cy]
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
    use crate::contact::targets::ContactTarget;
    use crate::contact::targets::Corner;

    const X: [[f64; 2]; 3] = [[0.7, 0.4], [2.0, 0.1], [-0.5, -0.2]];
    const U0: [f64; 6] = [0.1, -0.05, 0.02, 0.07, -0.03, 0.01];
    const U1: [f64; 6] = [-0.4, -0.35, 0.3, 0.2, 0.25, -0.3];

    const SITE: PairTarget = PairTarget {
        slave_index: 0,
        target: ContactTarget {
            segment: 0,
            corner: None,
        },
        nodes: [0, 1, 2, 2],
        friction: 0.3,
    };

    fn pair(form: RowForm) -> Pair {
        Pair::new(SITE, form, &X, &U0, &U1)
    }

    fn at(u: &[f64]) -> crate::contact::Projection {
        project(position(&X, u, 0), position(&X, u, 1), position(&X, u, 2))
    }

    #[test]
    fn end_rows_are_the_derivative_of_the_gap() {
        let p = pair(RowForm::End);
        assert_eq!(p.gap, at(&U1).gap);
        for k in 0..6 {
            let mut u = [U1, U1];
            u[0][k] += 1e-6;
            u[1][k] -= 1e-6;
            let quotient = (at(&u[0]).gap - at(&u[1]).gap) / 2e-6;
            assert!((p.normal[k] - quotient).abs() < 1e-9, "{k}");
        }
    }

    #[test]
    fn discrete_gradients_are_exact_differences() {
        let p = pair(RowForm::DiscreteGradient);
        let (start, end) = (at(&U0), at(&U1));
        assert!((p.start_gap - start.gap).abs() < 1e-14);
        let length = (start.length + end.length) / 2.0;
        assert!((p.slip - length * (end.xi - start.xi)).abs() < 1e-14);
    }

    #[test]
    fn discrete_gradients_keep_momentum() {
        let p = pair(RowForm::DiscreteGradient);
        for row in [p.normal, p.tangent] {
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
        let still = |form| Pair::new(SITE, form, &X, &U1, &U1);
        let (p, q) = (still(RowForm::End), still(RowForm::DiscreteGradient));
        for k in 0..6 {
            assert!((p.normal[k] - q.normal[k]).abs() < 1e-15);
        }
        // The tangents agree at the slave node; on the segment they differ by the gap.
        assert!((p.tangent[0] - q.tangent[0]).abs() < 1e-15);
        assert!((p.tangent[1] - q.tangent[1]).abs() < 1e-15);
    }

    /// Corner of a roof, displaced, on which the node 0 has come to lie.
    const ROOF: [[f64; 2]; 4] = [[0.3, 1.1], [2.0, 0.1], [0.3, 1.1], [-0.8, 0.9]];

    fn pair_at_vertex(form: RowForm, u: &[f64]) -> Pair {
        let mut at = SITE;
        at.nodes = [0, 1, 2, 3];
        at.target.corner = Some(Corner {
            next: 1,
            weight: 0.3,
        });
        Pair::new(at, form, &ROOF, &[0.0; 8], u)
    }

    #[test]
    fn at_a_vertex_the_end_rows_are_the_derivative_of_the_gap() {
        let p = pair_at_vertex(RowForm::End, &[0.0; 8]);
        assert!(p.gap.abs() < 1e-15);
        for k in 0..8 {
            let moved = |by: f64| {
                let mut u = [0.0; 8];
                u[k] = by;
                pair_at_vertex(RowForm::End, &u).gap
            };
            let quotient = (moved(1e-6) - moved(-1e-6)) / 2e-6;
            assert!((p.normal[k] - quotient).abs() < 1e-9, "{k}");
        }
    }

    #[test]
    fn at_a_vertex_the_forces_on_both_bodies_are_opposite() {
        let u = [0.1, -0.05, 0.02, 0.07, -0.03, 0.01, 0.04, -0.02];
        for form in [RowForm::End, RowForm::DiscreteGradient] {
            let p = pair_at_vertex(form, &u);
            for row in [p.normal, p.tangent] {
                assert!(row[0].hypot(row[1]) > 0.5);
                for i in 0..2 {
                    let sum = row[i] + row[2 + i] + row[4 + i] + row[6 + i];
                    assert!(sum.abs() < 1e-15, "{form:?} {sum:e}");
                }
            }
        }
    }
}
