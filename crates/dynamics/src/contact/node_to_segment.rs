//! Constraint of a slave node at a segment: projection, gap, force rows of the end configuration
//! or as discrete gradients, and derivative rows. See docs/theory/contact.md.

use super::bend::{Bend, OfChord};
use super::bulge::Bulge;
use super::constraint::{Configurations, Constraint, RowForm, RowPair, product, sum_of};
use super::projection::{Projection, position_round_off, project, rise};
use super::target::{Pair, PairTarget, SegmentContact, Target};
use crate::vectors::{cross, difference, dot};

/// Force rows and derivative rows of a node at a segment.
pub(super) struct SegmentRows {
    /// Projection of the node on the chord.
    pub projection: Projection,
    /// Gap to the face (length).
    pub gap: f64,
    pub force: RowPair<6>,
    pub derivative: RowPair<6>,
    /// Bend of the face, if it is curved.
    pub bend: Option<Bend>,
}

impl SegmentRows {
    /// Force rows and derivative rows of the chord.
    pub fn chord(&self) -> [RowPair<6>; 2] {
        (self.bend.as_ref()).map_or([self.force, self.derivative], |bend| bend.chord)
    }

    /// Length of the normal row relative to the length for a straight face: factor of the friction bound, eq. (3.31).
    pub fn stretch(&self) -> f64 {
        self.bend.as_ref().map_or(1.0, |bend| bend.stretch)
    }
}

/// Start or end of the increment: r = x_s - x_a, e = x_b - x_a and the quantities that follow from
/// them.
struct Arms {
    r: [f64; 2],
    e: [f64; 2],
    /// |e|
    length: f64,
    /// Product pi1 = r.e
    dot: f64,
    /// Product pi2 = r x e
    cross: f64,
}

impl SegmentContact {
    /// The slave node s and the ends a and b.
    pub(super) fn nodes(&self, pair: &Pair) -> [usize; 3] {
        let [a, b] = self.segment.ends;
        [pair.slave, a, b]
    }

    pub(super) fn rows(&self, pair: &Pair, at: &Configurations) -> SegmentRows {
        segment_rows(self.nodes(pair), (self.segment.bulge, pair.allowed), at)
    }

    /// The constraint of the slave node s at the segment from a to b; its nodes are s, a, b.
    pub(super) fn constraint(self, pair: Pair, at: &Configurations) -> Constraint {
        let mut rows = self.rows(&pair, at);
        let kappa = self.tilt(&pair, at);
        if kappa != 0.0 {
            let [chord, _] = rows.chord();
            rows.force.normal = sum_of(1.0, &rows.force.normal, kappa, &chord.tangential);
        }
        let gap = (rows.gap, rows.projection.length, pair.allowed);
        let target = Target::Segment(self);
        let source = PairTarget { pair, target };
        let both = [rows.force, rows.derivative];
        Constraint {
            stretch: rows.stretch(),
            ..Constraint::of_nodes(source, &self.nodes(&pair), both, gap, at)
        }
    }

    /// Gap of the constraint, and the length to which this gap is relative.
    pub(super) fn gap_and_scale(&self, pair: &Pair, at: &Configurations) -> (f64, f64) {
        let [s, a, b] = at.iterate(self.nodes(pair));
        let projection = self.segment.bulge.below(project(s, a, b));
        (projection.gap + pair.allowed[1], projection.length)
    }

    /// Tilt of the force on a node that has slid on from another segment, eq. (7.6); zero for other nodes:
    ///
    /// ```text
    /// Bn <- Bn + kappa Bt,   kappa = (g0 - h0)/(Bt d),   h0 = max(min(g0, g0_i), 0)
    /// ```
    ///
    /// With the tilted row, Bn d = g1 - h0 (end gap less start gap as the node is counted), so contact adds no energy.
    pub(super) fn tilt(&self, pair: &Pair, at: &Configurations) -> f64 {
        let from = self.from.filter(|_| at.form == RowForm::DiscreteGradient);
        let Some(from) = from else { return 0.0 };
        let nodes = self.nodes(pair);
        let [start, end] = [at.start(nodes), at.iterate(nodes)]
            .map(|[s, a, b]| self.segment.bulge.below(project(s, a, b)));
        let [i, j] = from.ends;
        let [s, i, j] = at.start([pair.slave, i, j]);
        let allowed = pair.allowed[0];
        let before = from.bulge.below(project(s, i, j)).raised(allowed);
        let rise = rise((start.gap + allowed, start.length), before.gap, s);
        let slip = (start.length + end.length) / 2.0 * (end.xi - start.xi);
        // the force on a node that has not moved has no direction in which to tilt
        match rise != 0.0 && slip.abs() > position_round_off(s) {
            true => rise / slip,
            false => 0.0,
        }
    }
}

/// Projection and rows of the node s on the segment from a to b, whose face may have a bulge and an allowed overlap.
pub(super) fn segment_rows(
    nodes: [usize; 3],
    (bulge, [_, allowed]): (Bulge, [f64; 2]),
    at: &Configurations,
) -> SegmentRows {
    let places = [at.start(nodes), at.iterate(nodes)];
    if bulge.is_flat() {
        return rows_between(places, (-allowed, &bulge), at.form);
    }
    let [s, a, b] = places[1];
    let projection = project(s, a, b);
    let height = bulge.at(projection.xi) - allowed;
    let mut rows = rows_between(places, (height, &bulge), at.form);
    if let (RowForm::End, Some(bend)) = (at.form, &rows.bend) {
        // the couple of friction changes with the height of the node when the gap is closed
        let turned = product(&couple(&projection), &displacements(&places)) / bend.stretch;
        let tangential = &mut rows.derivative.tangential;
        *tangential = sum_of(1.0, tangential, turned, &bend.of_height);
    }
    rows
}

/// Projection and rows between the positions of s, a and b at start and end. `height` is the distance of s from the
/// segment when the constraint is closed; end rows use this height, discrete gradients do not.
pub(super) fn rows_between(
    places: [[[f64; 2]; 3]; 2],
    (height, bulge): (f64, &Bulge),
    form: RowForm,
) -> SegmentRows {
    let [start, end] = places;
    let [s, a, b] = end;
    let projection = project(s, a, b);
    let (force, derivative) = match form {
        RowForm::End => end_rows(&projection, height, [start, end]),
        RowForm::DiscreteGradient => {
            let (start, end) = (Arms::new(start), Arms::new(end));
            (
                discrete_gradient_rows(&start, &end),
                derivatives_of_differences(&start, &end),
            )
        }
    };
    let mut rows = SegmentRows {
        projection,
        gap: projection.gap,
        force,
        derivative,
        bend: None,
    };
    if !bulge.is_flat() {
        let [s, a, b] = start;
        let before = project(s, a, b);
        let d = displacements(&places);
        let of_chord = of_chord(&rows, (form, &d));
        let bend = Bend::new(bulge, [&before, &projection], of_chord, form);
        rows.gap -= bulge.at(projection.xi);
        [rows.force, rows.derivative] = bend.rows(&d);
        rows.bend = Some(bend);
    }
    rows
}

/// Displacements of s, a and b since the start.
fn displacements([start, end]: &[[[f64; 2]; 3]; 2]) -> [f64; 6] {
    std::array::from_fn(|k| end[k / 2][k % 2] - start[k / 2][k % 2])
}

/// Derivatives of xi, l and Bn d, where d is the displacement of s, a and b since the start,
///
/// ```text
/// dxi = (e_t.dr - xi e_t.de)/l + g (e_n.de)/l²,  dl = e_t.de
/// ```
///
/// With discrete gradients the derivatives follow from differences of the gap rows. End rows turn with the segment, so
/// the derivative of Bn d is dBn d = Bn - (e_t.w)/l D - (e_n.d_e) dxi.
fn of_chord(rows: &SegmentRows, (form, d): (RowForm, &[f64; 6])) -> OfChord {
    let ([force, derivative], p) = (rows.chord(), &rows.projection);
    let (l, [t, n]) = (p.length, [p.tangent, p.normal]);
    let of_arm = t.map(|t| t / l);
    let of_edge = [0, 1].map(|i| (p.gap / l * n[i] - p.xi * t[i]) / l);
    let of_xi = nodal(of_arm, of_edge);
    OfChord {
        rows: [force, derivative],
        xi: of_xi,
        length: nodal([0.0; 2], t),
        normal_motion: match form {
            RowForm::DiscreteGradient => derivative.normal,
            RowForm::End => {
                let stretch = [d[4] - d[2], d[5] - d[3]];
                let w = [0, 1].map(|i| d[i] - (1.0 - p.xi) * d[2 + i] - p.xi * d[4 + i]);
                let turned = sum_of(1.0, &force.normal, -dot(t, w), &couple(p));
                sum_of(1.0, &turned, -dot(n, stretch), &of_xi)
            }
        },
    }
}

/// Force rows of the end configuration, eq. (3.4). The normal row is e_n at s, -(1 - xi) e_n at a, -xi e_n at b. The
/// tangential row is the normal row with e_t for e_n, plus the couple (h/l) D, which cancels the moment of friction at
/// the height h. The normal row is the derivative of the gap; the derivative of the slip is eq. (3.9).
fn end_rows(
    p: &Projection,
    height: f64,
    [start, end]: [[[f64; 2]; 3]; 2],
) -> (RowPair<6>, RowPair<6>) {
    let weights = [1.0, -(1.0 - p.xi), -p.xi];
    let row = |e: [f64; 2]| -> [f64; 6] { std::array::from_fn(|k| weights[k / 2] * e[k % 2]) };
    let (normal, tangential) = (row(p.normal), row(p.tangent));
    // w = d_s - (1 - xi) d_a - xi d_b, d_e = d_b - d_a
    let d = |node: usize, i: usize| end[node][i] - start[node][i];
    let w = [0, 1].map(|i| d(0, i) + weights[1] * d(1, i) + weights[2] * d(2, i));
    let stretch = [0, 1].map(|i| d(2, i) - d(1, i));
    // D = (e_n at b, -e_n at a), T = (e_t at b, -e_t at a)
    let [turn, stretched] = [p.normal, p.tangent].map(|e| nodal([0.0; 2], e));
    // Gt = Bt + (e_n.w)/l D - (e_t.d_e)/l (Bt + (g/l) D) - (e_n.d_e) h/l² T, eq. (3.9)
    let across = dot(p.normal, w) / p.length;
    let [turned, along] = [p.normal, p.tangent].map(|e| dot(e, stretch) / p.length);
    let lean = height / p.length;
    let tangential = sum_of(1.0, &tangential, lean, &turn);
    let slope = std::array::from_fn(|k| {
        tangential[k] + across * turn[k]
            - along * (tangential[k] + p.gap / p.length * turn[k])
            - turned * lean * stretched[k]
    });
    let force = RowPair { normal, tangential };
    let derivative = RowPair {
        normal,
        tangential: slope,
    };
    (force, derivative)
}

/// Couple D/l = (e_n at b, -e_n at a)/l of the end rows for a force at unit height.
pub(super) fn couple(p: &Projection) -> [f64; 6] {
    nodal([0.0; 2], p.normal.map(|n| n / p.length))
}

/// Discrete gradients between the start and the end of the increment.
///
/// The gap g = pi2/sqrt(pi3) and the projection xi = pi1/pi3 depend on pi1 = r.e, pi2 = r x e,
/// pi3 = e.e, eq. (7.1), which are quadratic in the positions. The gradients of pi1, pi2 and pi3 at the mid
/// configuration are therefore exact difference quotients.
fn discrete_gradient_rows(start: &Arms, end: &Arms) -> RowPair<6> {
    let mean = |p: [f64; 2], q: [f64; 2]| [(p[0] + q[0]) / 2.0, (p[1] + q[1]) / 2.0];
    let (l0, l1) = (start.length, end.length);
    let [pi1, pi2, pi3] = gradients(mean(start.r, end.r), mean(start.e, end.e));

    // Bn = alpha grad pi2 + beta grad pi3, alpha = (1/l0 + 1/l1)/2,
    // beta = -(pi2_0 + pi2_1)/2 / (l0 l1 (l0 + l1)), eq. (7.2)
    let alpha = (1.0 / l0 + 1.0 / l1) / 2.0;
    let beta = -(start.cross + end.cross) / 2.0 / (l0 * l1 * (l0 + l1));

    // Bt = gamma grad pi1 + delta grad pi3, gamma = L (1/l0² + 1/l1²)/2,
    // delta = -L (pi1_0 + pi1_1)/2 / (l0² l1²), L = (l0 + l1)/2, eq. (7.3)
    let length = (l0 + l1) / 2.0;
    let gamma = length * (1.0 / (l0 * l0) + 1.0 / (l1 * l1)) / 2.0;
    let delta = -length * (start.dot + end.dot) / 2.0 / (l0 * l0 * l1 * l1);
    RowPair {
        normal: sum_of(alpha, &pi2, beta, &pi3),
        tangential: sum_of(gamma, &pi1, delta, &pi3),
    }
}

/// Derivatives of the gap g1 and of the slip L (xi1 - xi0) with respect to the end positions.
fn derivatives_of_differences(start: &Arms, end: &Arms) -> RowPair<6> {
    let (l0, l1) = (start.length, end.length);
    let [pi1, pi2, pi3] = gradients(end.r, end.e);
    // Gn = grad pi2/l1 - pi2_1/(2 l1³) grad pi3, eq. (7.4)
    let normal = sum_of(1.0 / l1, &pi2, -end.cross / (2.0 * l1.powi(3)), &pi3);
    // Gt = L (grad pi1/l1² - pi1_1/l1⁴ grad pi3) + (xi1 - xi0)/(4 l1) grad pi3, eq. (7.5)
    let length = (l0 + l1) / 2.0;
    let moved = end.dot / (l1 * l1) - start.dot / (l0 * l0);
    let of_length = -length * end.dot / l1.powi(4) + moved / (4.0 * l1);
    let tangential = sum_of(length / (l1 * l1), &pi1, of_length, &pi3);
    RowPair { normal, tangential }
}

impl Arms {
    /// The arms r and e for the positions of s, a and b.
    fn new([s, a, b]: [[f64; 2]; 3]) -> Self {
        let (r, e) = (difference(a, s), difference(a, b));
        Arms {
            r,
            e,
            length: dot(e, e).sqrt(),
            dot: dot(r, e),
            cross: cross(r, e),
        }
    }
}

/// Gradients of pi1 = r.e, pi2 = r x e and pi3 = e.e at s, a and b.
fn gradients(r: [f64; 2], e: [f64; 2]) -> [[f64; 6]; 3] {
    let pi1 = nodal(e, r);
    let pi2 = nodal([e[1], -e[0]], [-r[1], r[0]]);
    let pi3 = nodal([0.0; 2], [2.0 * e[0], 2.0 * e[1]]);
    [pi1, pi2, pi3]
}

/// Row at the nodes from its parts with respect to r and e: the r-part at s, minus both parts at a,
/// the e-part at b.
fn nodal(r: [f64; 2], e: [f64; 2]) -> [f64; 6] {
    [r[0], r[1], -r[0] - e[0], -r[1] - e[1], e[0], e[1]]
}

#[cfg(test)]
mod tests {
    use super::super::constraint::Rows;
    use super::*;
    use crate::contact::target::Segment;
    use crate::contact::{position, testing};

    const X: [[f64; 2]; 3] = [[0.7, 0.4], [2.0, 0.1], [-0.5, -0.2]];
    const U0: [f64; 6] = [0.1, -0.05, 0.02, 0.07, -0.03, 0.01];
    const U1: [f64; 6] = [-0.4, -0.35, 0.3, 0.2, 0.25, -0.3];

    fn between(form: RowForm, u0: &[f64], u: &[f64]) -> Constraint {
        of(testing::face(), form, u0, u)
    }

    fn of(source: PairTarget, form: RowForm, u0: &[f64], u: &[f64]) -> Constraint {
        let x = &X;
        Constraint::new(source, &Configurations { form, x, u0, u })
    }

    /// A pair that is closed at U1 with the overlap allowed there, at a distance from the segment.
    fn fit() -> PairTarget {
        let gap = projected(&U1).gap;
        assert!(gap.abs() > 0.1);
        let mut source = testing::face();
        source.pair.allowed = [-gap; 2];
        source
    }

    /// Node 0 at the curved face from node 1 to node 2.
    fn bent(bulge: Bulge) -> PairTarget {
        testing::at_segment(Segment {
            bulge,
            ..testing::segment(0, [1, 2])
        })
    }

    fn closed(form: RowForm, u0: &[f64]) -> Constraint {
        let constraint = of(fit(), form, u0, &U1);
        assert_eq!(constraint.gap, 0.0);
        constraint
    }

    fn projected(u: &[f64]) -> Projection {
        project(position(&X, u, 0), position(&X, u, 1), position(&X, u, 2))
    }

    #[test]
    fn derivative_rows_are_the_derivatives_of_gap_and_slip() {
        let bulges = [Bulge::FLAT, Bulge::steep(2.5)];
        let forms = [RowForm::End, RowForm::DiscreteGradient];
        for (form, bulge) in forms.map(|form| bulges.map(|bulge| (form, bulge))).concat() {
            let source = bent(bulge);
            let between = |form, u0: &[f64], u: &[f64]| of(source.clone(), form, u0, u);
            let constraint = between(form, &U0, &U1);
            assert_eq!(constraint.gap, bulge.below(projected(&U1)).gap);
            assert_eq!(constraint.dofs[..], [0, 1, 2, 3, 4, 5]);
            let rows = constraint.derivative_rows();
            for k in 0..6 {
                let moved = |by: f64| {
                    let mut u = U1;
                    u[k] += by;
                    between(form, &U0, &u)
                };
                let (p, q) = (moved(1e-6), moved(-1e-6));
                let gap = (p.gap - q.gap) / 2e-6;
                let slip = (p.slip - q.slip) / 2e-6;
                assert!((rows.normal[k] - gap).abs() < 1e-9, "{form:?} {k}");
                assert!((rows.tangential[k] - slip).abs() < 1e-9, "{form:?} {k}");
            }
        }
    }

    #[test]
    fn rows_of_curved_faces_are_exact_differences_normal_to_each_other() {
        let bulge = Bulge::steep(2.5);
        let source = bent(bulge);
        for form in [RowForm::End, RowForm::DiscreteGradient] {
            let constraint = of(source.clone(), form, &U0, &U1);
            let Rows { normal, tangential } = &constraint.force_rows;
            // the normal row at the node has the length s, the tangential row the length 1
            let [n, t] = [normal, tangential].map(|row| [row[0], row[1]]);
            if form == RowForm::End {
                assert!(dot(n, t).abs() < 1e-15 && (dot(t, t) - 1.0).abs() < 1e-15);
                assert!((dot(n, n).sqrt() - constraint.stretch).abs() < 1e-15);
                assert!(constraint.stretch > 1.0);
                continue;
            }
            let start = bulge.below(projected(&U0)).gap;
            assert!((constraint.start_gap - start).abs() < 1e-14);
            for row in [normal, tangential] {
                let moment: f64 = (0..3)
                    .map(|n| {
                        let [p, q] = [&U0, &U1].map(|u| position(&X, u, n));
                        cross(
                            [0, 1].map(|i| (p[i] + q[i]) / 2.0),
                            [row[2 * n], row[2 * n + 1]],
                        )
                    })
                    .sum();
                assert!(moment.abs() < 1e-15, "{moment}");
            }
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
    fn a_node_that_has_come_back_is_not_tilted_by_round_off() {
        // s lies at the corner a between the segments from i to a and from a to b, but for round-off
        let rise_and_slip = |height: f64, slip: f64| {
            let x = [[0.0, height], [0.0; 2], [-1.0, 0.0], [1.0, 0.0]];
            let u = [-slip, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
            let contact = SegmentContact {
                segment: testing::segment(0, [1, 2]),
                from: Some(testing::segment(1, [3, 1])),
            };
            let pair = testing::face().pair;
            let form = RowForm::DiscreteGradient;
            let u0 = &[0.0; 8];
            let x = &x;
            contact.tilt(&pair, &Configurations { form, x, u0, u: &u })
        };
        // a gap gives no rise, an overlap gives one
        assert_eq!(rise_and_slip(1e-3, 1e-2), 0.0);
        assert!((rise_and_slip(-1e-3, 1e-2) + 0.1).abs() < 1e-15);
        for slip in [0.0, 1e-16, -1e-12, 1e-9] {
            assert_eq!(rise_and_slip(-1e-16, slip), 0.0, "{slip:e}");
        }
    }

    #[test]
    fn forces_of_a_closed_pair_keep_both_momenta() {
        // the moments of end rows are about the end positions
        for (form, from) in [(RowForm::DiscreteGradient, &U0), (RowForm::End, &U1)] {
            let Rows { normal, tangential } = closed(form, &U0).force_rows;
            for row in [normal, tangential] {
                assert!((row[0] + row[2] + row[4]).abs() < 1e-15);
                assert!((row[1] + row[3] + row[5]).abs() < 1e-15);
                let moment: f64 = (0..3)
                    .map(|n| {
                        let [p, q] = [from, &U1].map(|u| position(&X, u, n));
                        let [x, y] = [0, 1].map(|i| (p[i] + q[i]) / 2.0);
                        x * row[2 * n + 1] - y * row[2 * n]
                    })
                    .sum();
                assert!(moment.abs() < 1e-15, "{form:?}");
            }
        }
    }

    #[test]
    fn both_forms_of_a_closed_pair_agree_when_nothing_moves() {
        let rows = |form| closed(form, &U1).force_rows;
        let (p, q) = (rows(RowForm::End), rows(RowForm::DiscreteGradient));
        for (p, q) in [(p.normal, q.normal), (p.tangential, q.tangential)] {
            assert!(p.iter().zip(&q).all(|(p, q)| (p - q).abs() < 1e-15));
        }
    }

    #[test]
    fn rows_of_a_fit_are_derivatives_too() {
        let slip = |u: &[f64]| of(fit(), RowForm::End, &U0, u).slip;
        let found = closed(RowForm::End, &U0);
        for k in 0..6 {
            let [mut plus, mut minus] = [U1; 2];
            (plus[k], minus[k]) = (plus[k] + 1e-6, minus[k] - 1e-6);
            let quotient = (slip(&plus) - slip(&minus)) / 2e-6;
            let error = found.derivative_rows().tangential[k] - quotient;
            assert!(error.abs() < 1e-9, "{k} {error}");
        }
    }
}
