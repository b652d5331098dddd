//! Stiffness of a closed constraint in K*: the change of its nodal forces with the iterate, and the stiffening that
//! keeps the constraint closed. See docs/theory/time.md.
//!
//! # Derivation
//!
//! With z = (r, e), r = x_s - x_a, e = x_b - x_a, the products of eq. (7.1) are pi_i = z.H_i z/2 with constant H_i, and
//! grad pi_i = H_i z. The discrete gradients are Bn = alpha H2 zm + beta H3 zm and Bt = gamma H1 zm + delta H3 zm, eq.
//! (7.2), eq. (7.3), with zm = (z0 + z1)/2. The derivatives of the discrete gradients Bn and Bt with respect to the end
//! are (rows: force; columns: d of the end)
//!
//! ```text
//! dBn = (alpha H2 + beta H3)/2 + H2 zm dalpha + H3 zm dbeta
//! dBt = (gamma H1 + delta H3)/2 + H1 zm dgamma + H3 zm ddelta
//! ```
//!
//! The end rows are Bn = (e_n, -xi e_n) and Bt = (e_t, -xi e_t + (h/l) e_n), eq. (3.4). With de_n = -e_t (e_n.de)/l,
//! de_t = e_n (e_n.de)/l and constant h, the derivatives of the end rows are
//!
//! ```text
//! dBn = -(e_t, -xi e_t) (e_n.de)/l - (0, e_n) dxi
//! dBt =  (e_n, -xi e_n) (e_n.de)/l - (0, e_t) (dxi + h (e_n.de)/l²) - (0, e_n) h (e_t.de)/l²
//! dxi = (e_t.dr - xi e_t.de)/l + g (e_n.de)/l²
//! ```

use nalgebra::{DMatrix, DVector, Matrix4, Matrix6, SMatrix, Vector4, Vector6};

use super::bend::Bend;
use super::constraint::{Configurations, Constraint, RowForm, product};
use super::node_to_segment::{SegmentRows, couple};
use super::projection::project;
use super::target::{CornerContact, Pair, Segment, SegmentContact};

/// Places, among the dofs of the constraint, of the dofs of s, a and b, and of the dofs of s, b and c.
const PLACES: [[usize; 6]; 2] = [[0, 1, 2, 3, 4, 5], [0, 1, 4, 5, 6, 7]];

impl SegmentContact {
    /// Derivative of the contact force of the constraint at constant Pn and Pt, over its dofs
    /// (force/length).
    pub(super) fn change(
        &self,
        constraint: &Constraint,
        [pn, pt]: [f64; 2],
        at: &Configurations,
    ) -> DMatrix<f64> {
        // the force of a tilted row is Bn^T Pn + Bt^T (Pt + kappa Pn), eq. (7.6)
        let pair = &constraint.source.pair;
        let (nodes, kappa) = (self.nodes(pair), self.tilt(pair, at));
        let bent = (!self.segment.bulge.is_flat()).then(|| self.rows(pair, at));
        let force = ([pn, pt], kappa * pn);
        let mut k = DMatrix::zeros(6, 6);
        k += changes((nodes, pair.allowed[1]), bent.as_ref(), force, at);
        if kappa != 0.0 {
            // kappa = (g0 - h0)/s: dkappa = -kappa/s Gt, both of the chord
            let column = |row: &[f64]| DVector::from_column_slice(row);
            let (row, change, slip) = match bent {
                None => {
                    let row = column(&constraint.force_rows.tangential);
                    let change = column(&constraint.derivative_rows().tangential);
                    (row, change, constraint.slip)
                }
                Some(bent) => {
                    let [force, derivative] = bent.chord().map(|rows| rows.tangential);
                    let slip = product(&force, &displacements(nodes, at));
                    (column(&force), column(&derivative), slip)
                }
            };
            k -= row * change.transpose() * (pn * kappa / slip);
        }
        k
    }
}

impl CornerContact {
    /// Derivative of the contact force of a corner at constant Pn and Pt, over the dofs of the constraint
    /// (force/length). The weight of the corner and the length of its normal are taken from the iterate, as constants.
    pub(super) fn change(
        &self,
        pair: &Pair,
        [pn, pt]: [f64; 2],
        at: &Configurations,
    ) -> DMatrix<f64> {
        let ([before, behind], [m, along]) = self.rows(pair, at);
        let of = |segment: &Segment, rows: &SegmentRows, weight: f64| {
            let [a, b] = segment.ends;
            let at_segment = ([pair.slave, a, b], pair.allowed[1]);
            let force = [weight * pn / m, weight * pt / along];
            changes(at_segment, Some(rows), (force, 0.0), at)
        };
        let corner = self.corner();
        let blocks = [
            of(&self.before, &before, corner.blend(1.0, 0.0)),
            of(&self.behind, &behind, corner.blend(0.0, 1.0)),
        ];
        let mut k = DMatrix::zeros(8, 8);
        for (block, places) in blocks.iter().zip(&PLACES) {
            add_block(&mut k, block, places);
        }
        k
    }
}

/// Adds the block of three nodes to the matrix over the dofs of a constraint, at their places.
fn add_block(k: &mut DMatrix<f64>, block: &Matrix6<f64>, places: &[usize; 6]) {
    for (j, &column) in places.iter().enumerate() {
        for (i, &row) in places.iter().enumerate() {
            k[(row, column)] += block[(i, j)];
        }
    }
}

impl Constraint {
    /// Matrix Gn^T Gn, plus Gt^T Gt if the constraint `sticks`, by which a closed constraint stiffens K*, eq. (4.13),
    /// over its dofs (dimensionless).
    pub fn stiffening(&self, sticks: bool) -> DMatrix<f64> {
        let rows = self.derivative_rows();
        let normal = DVector::from_column_slice(&rows.normal);
        let tangential = DVector::from_column_slice(&rows.tangential);
        let stiffening = &normal * normal.transpose();
        match sticks {
            true => stiffening + &tangential * tangential.transpose(),
            false => stiffening,
        }
    }
}

/// Derivative of Bn^T Pn + Bt^T (Pt + kappa Pn) with respect to the end, over s, a and b, at constant kappa Pn
/// (`leaning`). The node s is at the segment from a to b and may have an allowed overlap; `rows` are given if the face
/// bends.
fn changes(
    (nodes, allowed): ([usize; 3], f64),
    rows: Option<&SegmentRows>,
    (force, leaning): ([f64; 2], f64),
    at: &Configurations,
) -> Matrix6<f64> {
    let places = [at.start(nodes), at.iterate(nodes)];
    let Some((rows, bend)) = rows.and_then(|rows| Some((rows, rows.bend.as_ref()?))) else {
        return changes_between(places, -allowed, [force[0], force[1] + leaning], at.form);
    };
    let height = rows.projection.gap - rows.gap - allowed;
    let mut k = changes_of_face(places, (height, bend), (force, leaning), at.form);
    if at.form == RowForm::End {
        // the couple of friction has the height b(xi) - a
        let [_, along] = bend.at_chord(force);
        let couple = Vector6::from(couple(&rows.projection)) * along;
        k += couple * Vector6::from(bend.of_height).transpose();
    }
    k
}

/// Derivative of the force at a face that bends, at a constant height over the chord.
pub(super) fn changes_of_face(
    places: [[[f64; 2]; 3]; 2],
    (height, bend): (f64, &Bend),
    (force, leaning): ([f64; 2], f64),
    form: RowForm,
) -> Matrix6<f64> {
    let [pn, pt] = bend.at_chord(force);
    let [row, change] = bend.change(force).map(Vector6::from);
    changes_between(places, height, [pn, pt + leaning], form) + row * change.transpose()
}

/// Displacements of the nodes since the start.
fn displacements(nodes: [usize; 3], at: &Configurations) -> [f64; 6] {
    std::array::from_fn(|k| {
        let dof = 2 * nodes[k / 2] + k % 2;
        at.u[dof] - at.u0[dof]
    })
}

/// Derivative of a contact force at a constant height; the positions are those of s, a and b at start and end.
pub(super) fn changes_between(
    [start, end]: [[[f64; 2]; 3]; 2],
    height: f64,
    force: [f64; 2],
    form: RowForm,
) -> Matrix6<f64> {
    let k = match form {
        RowForm::End => changes_of_end_rows(end, height, force),
        RowForm::DiscreteGradient => changes_of_discrete_gradients(start, end, force),
    };
    // s: r-part, a: -(r-part) - (e-part), b: e-part
    #[rustfmt::skip]
    let nodal = SMatrix::<f64, 6, 4>::from_row_slice(&[
         1.0,  0.0,  0.0,  0.0,
         0.0,  1.0,  0.0,  0.0,
        -1.0,  0.0, -1.0,  0.0,
         0.0, -1.0,  0.0, -1.0,
         0.0,  0.0,  1.0,  0.0,
         0.0,  0.0,  0.0,  1.0,
    ]);
    nodal * k * nodal.transpose()
}

/// Derivative of the force with the rows of the end configuration, over (r, e).
fn changes_of_end_rows([s, a, b]: [[f64; 2]; 3], height: f64, [pn, pt]: [f64; 2]) -> Matrix4<f64> {
    let p = project(s, a, b);
    let row = |e: [f64; 2]| Vector4::new(e[0], e[1], -p.xi * e[0], -p.xi * e[1]);
    let of_e = |e: [f64; 2]| Vector4::new(0.0, 0.0, e[0], e[1]);
    // (e_n.de)/l and dxi = (e_t.dr - xi e_t.de)/l + g (e_n.de)/l²
    let turn = of_e(p.normal) / p.length;
    let dxi = row(p.tangent) / p.length + turn * (p.gap / p.length);
    let normal = -row(p.tangent) * turn.transpose() - of_e(p.normal) * dxi.transpose();
    let lean = height / p.length;
    let tangential = row(p.normal) * turn.transpose()
        - of_e(p.tangent) * (dxi + turn * lean).transpose()
        - of_e(p.normal) * of_e(p.tangent).transpose() * (lean / p.length);
    normal * pn + tangential * pt
}

/// Derivative of the force with the discrete gradients between start and end, over (r, e). Here L =
/// (l0 + l1)/2, D = l0 l1 (l0 + l1), p1 and p2 are the means of pi1 and pi2, and dl = H3 z1/(2 l1):
///
/// ```text
/// dalpha = -dl/(2 l1²)
/// dbeta  = -H2 z1/(2 D) + p2 l0 (l0 + 2 l1)/D² dl
/// dgamma = [(1/l0² + 1/l1²)/4 - L/l1³] dl
/// ddelta = -L H1 z1/(2 (l0 l1)²) + [2 L p1/(l0² l1³) - p1/(2 (l0 l1)²)] dl
/// ```
fn changes_of_discrete_gradients(
    start: [[f64; 2]; 3],
    end: [[f64; 2]; 3],
    [pn, pt]: [f64; 2],
) -> Matrix4<f64> {
    let arms =
        |[s, a, b]: [[f64; 2]; 3]| Vector4::new(s[0] - a[0], s[1] - a[1], b[0] - a[0], b[1] - a[1]);
    let (z0, z1) = (arms(start), arms(end));
    let (zm, [h1, h2, h3]) = ((z0 + z1) / 2.0, products());
    let product = |h: &Matrix4<f64>, z: &Vector4<f64>| z.dot(&(h * z)) / 2.0;
    let [l0, l1] = [z0, z1].map(|z| product(&h3, &z).sqrt());
    let [p1, p2] = [h1, h2].map(|h| (product(&h, &z0) + product(&h, &z1)) / 2.0);
    let (l, d, squared) = ((l0 + l1) / 2.0, l0 * l1 * (l0 + l1), (l0 * l1).powi(2));
    let (inverse, inverse_squares) = (1.0 / l0 + 1.0 / l1, 1.0 / (l0 * l0) + 1.0 / (l1 * l1));
    let dl = h3 * z1 / (2.0 * l1);

    // Bn = alpha grad pi2 + beta grad pi3, eq. (7.2)
    let (alpha, beta) = (inverse / 2.0, -p2 / d);
    let dalpha = -dl / (2.0 * l1 * l1);
    let dbeta = -h2 * z1 / (2.0 * d) + dl * (p2 * l0 * (l0 + 2.0 * l1) / (d * d));
    let normal =
        (h2 * alpha + h3 * beta) / 2.0 + h2 * zm * dalpha.transpose() + h3 * zm * dbeta.transpose();

    // Bt = gamma grad pi1 + delta grad pi3, eq. (7.3)
    let (gamma, delta) = (l * inverse_squares / 2.0, -l * p1 / squared);
    let dgamma = dl * (inverse_squares / 4.0 - l / l1.powi(3));
    let ddelta = -h1 * z1 * (l / (2.0 * squared))
        + dl * (2.0 * l * p1 / (squared * l1) - p1 / (2.0 * squared));
    let tangential = (h1 * gamma + h3 * delta) / 2.0
        + h1 * zm * dgamma.transpose()
        + h3 * zm * ddelta.transpose();
    normal * pn + tangential * pt
}

/// Matrices H1, H2 and H3 of the products pi1 = r.e, pi2 = r x e and pi3 = e.e.
fn products() -> [Matrix4<f64>; 3] {
    #[rustfmt::skip]
    let h1 = Matrix4::new(
        0.0, 0.0, 1.0, 0.0,
        0.0, 0.0, 0.0, 1.0,
        1.0, 0.0, 0.0, 0.0,
        0.0, 1.0, 0.0, 0.0,
    );
    #[rustfmt::skip]
    let h2 = Matrix4::new(
        0.0,  0.0,  0.0, 1.0,
        0.0,  0.0, -1.0, 0.0,
        0.0, -1.0,  0.0, 0.0,
        1.0,  0.0,  0.0, 0.0,
    );
    [
        h1,
        h2,
        Matrix4::from_diagonal(&Vector4::new(0.0, 0.0, 2.0, 2.0)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::bulge::Bulge;
    use crate::contact::target::{PairTarget, Target};
    use crate::contact::testing;

    /// A node at a roof, and the foot of the segment before it.
    const X: [[f64; 2]; 5] = [[0.7, 0.4], [2.0, 0.1], [0.3, 0.9], [-0.8, 0.7], [3.0, -0.6]];
    const U0: [f64; 10] = [0.1, -0.05, 0.02, 0.07, -0.03, 0.01, 0.0, 0.04, 0.02, 0.01];
    const U1: [f64; 10] = [0.3, 0.5, 0.3, 0.2, 0.25, -0.3, 0.1, -0.1, 0.05, -0.02];
    const FORCE: [f64; 2] = [1.3, -0.4];
    const FORMS: [RowForm; 2] = [RowForm::End, RowForm::DiscreteGradient];

    /// Contact of node 0 with the curved face from node 1 to node 2, on to which it may have slid.
    fn bent(from: Option<[usize; 2]>, bulge: Bulge) -> SegmentContact {
        let segment = |number: usize, ends: [usize; 2]| Segment {
            bulge,
            ..testing::segment(number, ends)
        };
        SegmentContact {
            segment: segment(0, [1, 2]),
            from: from.map(|ends| segment(1, ends)),
        }
    }

    fn between(form: RowForm, u: &[f64]) -> Configurations<'_> {
        Configurations {
            form,
            x: &X,
            u0: &U0,
            u,
        }
    }

    /// Central differences of the nodal forces over the dofs of a constraint.
    fn quotients(source: &PairTarget, form: RowForm) -> DMatrix<f64> {
        let force = |u: &[f64]| {
            let constraint = Constraint::new(source.clone(), &between(form, u));
            let mut force = [0.0; 10];
            constraint.add_force(FORCE, &mut force);
            DVector::from_iterator(
                constraint.dofs.len(),
                constraint.dofs.iter().map(|&d| force[d]),
            )
        };
        let dofs = Constraint::new(source.clone(), &between(form, &U1)).dofs;
        let columns: Vec<DVector<f64>> = dofs
            .iter()
            .map(|&dof| {
                let [mut plus, mut minus] = [U1; 2];
                (plus[dof], minus[dof]) = (plus[dof] + 1e-6, minus[dof] - 1e-6);
                (force(&plus) - force(&minus)) / 2e-6
            })
            .collect();
        DMatrix::from_columns(&columns)
    }

    #[test]
    fn the_change_of_the_force_is_its_derivative() {
        for form in FORMS {
            let froms = [None, Some([4, 1])];
            let cases = froms.map(|from| [Bulge::FLAT, Bulge::steep(2.0)].map(|b| (from, b)));
            for (from, bulge) in cases.concat() {
                let target = Target::Segment(bent(from, bulge));
                let source = testing::pair(testing::key(0, 0), 0, target);
                let at = between(form, &U1);
                let found = Constraint::new(source.clone(), &at).change(FORCE, &at);
                let error = (&found - quotients(&source, form)).amax();
                assert!(
                    error < 1e-8 * found.amax(),
                    "{form:?} {from:?} {bulge:?}: {error}"
                );
            }
        }
        let at = between(FORMS[1], &U1);
        let kappa = bent(Some([4, 1]), Bulge::FLAT).tilt(&testing::face().pair, &at);
        assert!(kappa.abs() > 0.1);
    }

    #[test]
    fn contact_stiffness_at_a_corner_is_that_of_its_segments() {
        // a corner of weight 0 or 1 is one of its segments
        for form in FORMS {
            for (weight, ends) in [(0.0, [1, 2]), (1.0, [2, 3])] {
                let at = between(form, &U1);
                let stiffness =
                    |source: PairTarget| Constraint::new(source, &at).stiffness(FORCE, &at);
                let found = stiffness(testing::corner([1, 2, 3], weight));
                let face = stiffness(testing::at_segment(testing::segment(0, ends)));
                let mut expected = DMatrix::zeros(8, 8);
                let block = face.fixed_view::<6, 6>(0, 0).into_owned();
                add_block(&mut expected, &block, &PLACES[weight as usize]);
                assert!((found - expected).amax() < 1e-14, "{form:?} {weight}");
            }
        }
    }

    #[test]
    fn stiffening_resists_gap_and_slip() {
        let at = between(FORMS[1], &U1);
        let constraint = Constraint::new(testing::face(), &at);
        let v: [f64; 6] = [0.3, -0.2, 0.5, 0.1, -0.4, 0.7];
        let (gap, slip) = (constraint.gap_change(&v), constraint.slip_change(&v));
        let v = DVector::from_column_slice(&v);
        let resisted = |sticks: bool| v.dot(&(constraint.stiffening(sticks) * &v));
        assert!((resisted(false) - gap * gap).abs() < 1e-14);
        assert!((resisted(true) - gap * gap - slip * slip).abs() < 1e-14);
    }
}
