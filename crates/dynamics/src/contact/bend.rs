//! Rows of contact with a curved face, made from the rows of its chord. See docs/theory/geometry.md, Curved faces.

use super::bulge::Bulge;
use super::constraint::{RowForm, RowPair, product, sum_of};
use super::projection::Projection;

/// Rows of the chord, and derivatives of its quantities with respect to the positions of s, a and b.
#[derive(Debug, Clone, Copy)]
pub(super) struct OfChord {
    /// Force rows and derivative rows of the chord.
    pub rows: [RowPair<6>; 2],
    /// Derivative of the projection xi (1/length).
    pub xi: [f64; 6],
    /// Derivative of the length l of the chord.
    pub length: [f64; 6],
    /// Derivative of the normal motion Bn d.
    pub normal_motion: [f64; 6],
}

/// Difference between the force rows Bn', Bt' of a curved face and the rows Bn, Bt of its chord, with L = (l0 + l1)/2:
///
/// ```text
/// beta = D/L,  s = sqrt(1 + beta²)
/// Bn' = Bn - beta Bt,  Bt' = (Bt + beta Bn)/s    eq. (3.30)
/// ```
///
/// The normal row of the face gives the change of the gap: Bn' d = G1 - G0. For end rows (`RowForm::End`) the slope of
/// the face is beta = b'(xi)/l.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bend {
    /// beta
    slope: f64,
    /// s
    pub stretch: f64,
    /// Force rows and derivative rows of the chord.
    pub chord: [RowPair<6>; 2],
    /// Derivative of the slope beta (1/length).
    of_slope: [f64; 6],
    /// Derivative of the normal motion Bn d of the chord.
    of_normal_motion: [f64; 6],
    /// Derivative of the height b(xi) (dimensionless).
    pub of_height: [f64; 6],
}

impl Bend {
    /// Bend of a face between the projections `p` at the start and in the iterate.
    pub fn new(bulge: &Bulge, p: [&Projection; 2], of_chord: OfChord, form: RowForm) -> Self {
        let [start, now] = p;
        let OfChord {
            rows: chord,
            xi: of_xi,
            length: of_length,
            normal_motion: of_normal_motion,
        } = of_chord;
        let ([secant, change], length, part) = match form {
            RowForm::End => (
                [bulge.slope(now.xi), bulge.second_derivative(now.xi)],
                now.length,
                1.0,
            ),
            RowForm::DiscreteGradient => (
                bulge.secant(start.xi, now.xi),
                (start.length + now.length) / 2.0,
                0.5,
            ),
        };
        let slope = secant / length;
        Bend {
            slope,
            stretch: slope.hypot(1.0),
            chord,
            of_slope: sum_of(change / length, &of_xi, -slope * part / length, &of_length),
            of_normal_motion,
            of_height: of_xi.map(|row| bulge.slope(now.xi) * row),
        }
    }

    /// Force rows and derivative rows of the face, `d` being the displacement of s, a and b since the start. The slip has the
    /// derivative
    ///
    /// ```text
    /// Gt' = (Gt + beta d(Bn d))/s + (Bn' d)/s³ dbeta
    /// ```
    pub fn rows(&self, d: &[f64; 6]) -> [RowPair<6>; 2] {
        let [force, derivative] = self.chord;
        let (beta, s) = (self.slope, self.stretch);
        let bent = RowPair {
            normal: sum_of(1.0, &force.normal, -beta, &force.tangential),
            tangential: sum_of(1.0 / s, &force.tangential, beta / s, &force.normal),
        };
        let along = sum_of(
            1.0 / s,
            &derivative.tangential,
            beta / s,
            &self.of_normal_motion,
        );
        let turned = product(&bent.normal, d) / s.powi(3);
        let of_bent = RowPair {
            normal: sum_of(1.0, &derivative.normal, -1.0, &self.of_height),
            tangential: sum_of(1.0, &along, turned, &self.of_slope),
        };
        [bent, of_bent]
    }

    /// The forces at the chord that together equal Pn and Pt at the face: Pn + beta Pt/s along the normal, Pt/s - beta
    /// Pn along the tangent.
    pub fn at_chord(&self, [pn, pt]: [f64; 2]) -> [f64; 2] {
        let (beta, s) = (self.slope, self.stretch);
        [pn + beta * pt / s, pt / s - beta * pn]
    }

    /// The part of the change of the force that comes from the change of beta, (Pt/s³ Bn' - Pn Bt) dbeta, as its two
    /// factors.
    pub fn change(&self, [pn, pt]: [f64; 2]) -> [[f64; 6]; 2] {
        let [force, _] = self.chord;
        let turned = pt / self.stretch.powi(3);
        let row = sum_of(
            turned,
            &force.normal,
            -turned * self.slope - pn,
            &force.tangential,
        );
        [row, self.of_slope]
    }
}
