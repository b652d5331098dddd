//! Constraint of a slave node at a corner, from the constraints at the two segments that meet
//! there. See docs/theory/geometry.md, Corner against corner.

use super::constraint::{Configurations, Constraint, RowForm, RowPair};
use super::node_to_segment::{SegmentRows, segment_rows};
use super::target::{Corner, CornerContact, Pair, PairTarget, Target};

impl CornerContact {
    /// Rows at the segments before and behind the corner, each over three nodes, and the lengths of the blended rows.
    pub(super) fn rows(&self, pair: &Pair, at: &Configurations) -> ([SegmentRows; 2], [f64; 2]) {
        let rows = [self.before, self.behind].map(|segment| {
            let [a, b] = segment.ends;
            segment_rows([pair.slave, a, b], (segment.bulge, pair.allowed), at)
        });
        let lengths = lengths_of_rows(self.corner(), &rows);
        (rows, lengths)
    }

    /// The constraint of a slave node at the corner b between the segments from a to b and from b to c; its nodes are
    /// s, a, b, c.
    ///
    /// With the weight w, the segment i before and the segment j behind the corner, gap and rows are, eq. (10.3):
    ///
    /// ```text
    /// g  = ((1 - w) g_i + w g_j)/m        m = |(1 - w) n_i + w n_j|
    /// Bn = ((1 - w) Bn_i + w Bn_j)/m      Bt = ((1 - w) Bt_i + w Bt_j)/m
    /// ```
    ///
    /// The blended normal has the length 1. The gaps g_i and g_j to both segments contain the overlap a that a fit
    /// allows, eq. (3.15). The weights are constant in a pass, so rows and gap stay exact differences. With other
    /// weights than in the last increment, a closed corner may begin with a small overlap; this overlap stays, since
    /// pushing the node out would do work.
    pub(super) fn constraint(self, pair: Pair, at: &Configurations) -> Constraint {
        // g = ((1 - w) g_i + w g_j)/m, Bn and Bt likewise, eq. (10.3)
        let corner = self.corner();
        let ([before, behind], [m, along]) = self.rows(&pair, at);
        let blend = |row: [f64; 6], next: [f64; 6], m: f64| -> [f64; 8] {
            let (row, next) = (at_first_nodes(row), at_last_nodes(next));
            std::array::from_fn(|k| corner.blend(row[k], next[k]) / m)
        };
        let both = |p: RowPair<6>, q: RowPair<6>| RowPair {
            normal: blend(p.normal, q.normal, m),
            tangential: blend(p.tangential, q.tangential, along),
        };
        let rows = [
            both(before.force, behind.force),
            both(before.derivative, behind.derivative),
        ];
        let gap = corner.blend(before.gap, behind.gap) / m;
        let gap = (gap, before.projection.length, pair.allowed.map(|a| a / m));
        let ([a, b], [_, c]) = (self.before.ends, self.behind.ends);
        let target = Target::Corner(self);
        let source = PairTarget { pair, target };
        let mut constraint = Constraint::of_nodes(source, &[pair.slave, a, b, c], rows, gap, at);
        if at.form == RowForm::DiscreteGradient && constraint.start_gap < 0.0 {
            constraint.gap -= constraint.start_gap;
            constraint.start_gap = 0.0;
        }
        constraint
    }
}

/// Lengths m of the blended normal and tangential rows at s; with straight faces both lengths are 1.
fn lengths_of_rows(corner: Corner, sides: &[SegmentRows; 2]) -> [f64; 2] {
    let length = |of: fn(&SegmentRows) -> [f64; 2]| {
        let [p, q] = sides.each_ref().map(of);
        let [x, y] = [0, 1].map(|i| corner.blend(p[i], q[i]));
        x.hypot(y)
    };
    let of_normals = length(|rows| match &rows.bend {
        None => rows.projection.normal,
        Some(_) => [rows.force.normal[0], rows.force.normal[1]],
    });
    match sides.iter().all(|rows| rows.bend.is_none()) {
        true => [of_normals; 2],
        false => [
            of_normals,
            length(|rows| [rows.force.tangential[0], rows.force.tangential[1]]),
        ],
    }
}

/// Extends a row at s, a, b to one at s, a, b, c.
fn at_first_nodes([sx, sy, ax, ay, bx, by]: [f64; 6]) -> [f64; 8] {
    [sx, sy, ax, ay, bx, by, 0.0, 0.0]
}

/// Extends a row at s, b, c to one at s, a, b, c.
fn at_last_nodes([sx, sy, bx, by, cx, cy]: [f64; 6]) -> [f64; 8] {
    [sx, sy, 0.0, 0.0, bx, by, cx, cy]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{RowForm, project, testing};
    use crate::vectors::dot;

    /// Displaced corner of a roof, on which the node 0 has come to lie.
    const ROOF: [[f64; 2]; 4] = [[0.3, 1.1], [2.0, 0.1], [0.3, 1.1], [-0.8, 0.9]];

    fn at_corner(form: RowForm, u: &[f64]) -> Constraint {
        at(&ROOF, form, u)
    }

    fn at(x: &[[f64; 2]], form: RowForm, u: &[f64]) -> Constraint {
        let u0 = &[0.0; 8];
        Constraint::new(source(), &Configurations { form, x, u0, u })
    }

    /// Pair of node 0 and the corner of the segments from node 1 to 2 and from 2 to 3.
    fn source() -> PairTarget {
        testing::corner([1, 2, 3], 0.3)
    }

    #[test]
    fn end_rows_are_the_derivative_of_the_gap() {
        let constraint = at_corner(RowForm::End, &[0.0; 8]);
        assert!(constraint.gap.abs() < 1e-15);
        assert_eq!(constraint.dofs[..], [0, 1, 2, 3, 4, 5, 6, 7]);
        for k in 0..8 {
            let moved = |by: f64| {
                let mut u = [0.0; 8];
                u[k] = by;
                at_corner(RowForm::End, &u).gap
            };
            let quotient = (moved(1e-6) - moved(-1e-6)) / 2e-6;
            let row = &constraint.derivative_rows().normal;
            assert!((row[k] - quotient).abs() < 1e-9, "{k}");
        }
    }

    #[test]
    fn a_small_overlap_at_the_start_stays_without_work() {
        for form in [RowForm::End, RowForm::DiscreteGradient] {
            // the slave node starts on the corner and moves along the bisector of both normals
            let starts_at = |depth: f64| {
                let mut x = ROOF;
                x[0][1] -= depth;
                let u = [0.0, 0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
                at(&x, form, &u)
            };
            let [touching, overlapping] = [0.0, 1e-10].map(starts_at);
            let is_kept = form == RowForm::DiscreteGradient;
            assert_eq!(overlapping.start_gap >= 0.0, is_kept);
            assert_eq!((overlapping.gap - touching.gap).abs() < 1e-14, is_kept);
        }
    }

    #[test]
    fn a_fit_allows_the_same_overlap_behind_both_segments() {
        for form in [RowForm::End, RowForm::DiscreteGradient] {
            // the node is behind both segments by the allowed overlap: where their lines, moved by
            // this overlap, meet
            let depths = [0.02, 0.01];
            let [_, a, tip, c] = ROOF;
            let [p, q] = [[a, tip], [tip, c]].map(|[a, b]| project(a, a, b).normal);
            let place =
                |depth: f64| [0, 1].map(|i| tip[i] - depth * (p[i] + q[i]) / (1.0 + dot(p, q)));
            let [start, end] = depths.map(place);
            let mut x = ROOF;
            x[0] = start;
            let mut u = [0.0; 8];
            u[..2].copy_from_slice(&[0, 1].map(|i| end[i] - start[i]));
            let mut source = source();
            source.pair.allowed = depths;
            let (x, u0, u) = (&x, &[0.0; 8], &u);
            let constraint = Constraint::new(source, &Configurations { form, x, u0, u });
            assert!(constraint.gap.abs() < 1e-15, "{form:?} {}", constraint.gap);
            assert!(constraint.start_gap.abs() < 1e-15, "{form:?}");
            let moved = constraint.normal_motion(u);
            assert!((moved - constraint.shrinkage).abs() < 1e-15, "{form:?}");
        }
    }

    #[test]
    fn forces_on_both_bodies_are_opposite() {
        let u = [0.1, -0.05, 0.02, 0.07, -0.03, 0.01, 0.04, -0.02];
        for form in [RowForm::End, RowForm::DiscreteGradient] {
            for force in [[1.0, 0.0], [0.0, 1.0]] {
                let constraint = at_corner(form, &u);
                let (mut sum, mut on_slave) = ([0.0; 2], [0.0; 2]);
                for (node, [x, y]) in constraint.nodal_forces(force) {
                    sum = [sum[0] + x, sum[1] + y];
                    if node == 0 {
                        on_slave = [x, y];
                    }
                }
                assert!(on_slave[0].hypot(on_slave[1]) > 0.5);
                assert!(sum[0].hypot(sum[1]) < 1e-15, "{form:?} {sum:?}");
            }
        }
    }
}
