//! The displacement formulation: strains of the displacements at every integration point.
//! See docs/theory/elements.md (paper eq. 12).

use super::block::{
    MatrixLanes, MovedBlock, TangentLanes, add_hoop, add_products, deformation_gradient, elasticity,
};
use super::formulation::{Formulation, PlacedBlock, PointState};
use super::shapes::IntegratedShape;
use crate::materials::number::Positive;
use crate::materials::{AnyLaw, Lanes, StressAtPoints};

/// Strains of the displacements, E = (F^T F - I)/2, with E_33 = h + h²/2 for h = u_r/R in a body of revolution, eq. (2.31).
pub struct Displacement;

impl<const N: usize, const P: usize, const HOOP: bool> Formulation<N, P, HOOP> for Displacement {
    type Reference = ();

    const FOR_EACH_LAW: bool = true;

    fn reference<S: IntegratedShape<N, P>>(_placed: &PlacedBlock<N, P>) {}

    #[inline(always)]
    fn for_each_state<S: IntegratedShape<N, P>>(
        at: &MovedBlock<N, P, ()>,
        law: &(impl StressAtPoints<Lanes, HOOP> + ?Sized),
        mut visit: impl FnMut(usize, &PointState),
    ) -> Positive {
        let mut positive = Positive::default();
        for p in 0..P {
            let deformation = at.deformation::<S, HOOP>(p, &mut positive);
            let state = PointState {
                gradient: &deformation.gradient,
                strains: &deformation.strains,
                s: law.stress_at(p, &deformation.strains),
            };
            visit(p, &state);
        }
        positive
    }

    /// The tangent is K = int B_L^T C B_L + B_NL^T S B_NL dOmega, eq. (2.6) (paper eq. 12). In a body of revolution B_L
    /// has the row (1 + h) h_a/R, and S_33 h_a h_b/R² is added, eq. (2.34).
    ///
    /// In the energy-momentum form, B_L on both sides belongs to the mid configuration, S is the energy-momentum
    /// stress, and C is the symmetric part of the tangent of S. Up to the factor theta2 = 1/2 the matrix K is a
    /// symmetric approximation of the exact tangent, which has B_L of the end on the right.
    ///
    /// With A = dP/dF, the derivative of the first Piola-Kirchhoff stress, K_ab = dh_a/dX . A . dh_b/dX.
    #[inline(always)]
    fn add_tangent<S: IntegratedShape<N, P>>(
        at: &MovedBlock<N, P, ()>,
        law: &AnyLaw<HOOP>,
        k: &mut MatrixLanes<N>,
    ) {
        for p in 0..P {
            let deformation = at.deformation::<S, HOOP>(p, &mut Positive::default());
            let volume = at.block.volume[p];
            let s = law.stress_at(p, &deformation.strains).times(volume);
            let c = law.tangent_at(p, &deformation.strains);
            let c = TangentLanes::of(|i, j| c.0[i][j] * volume);
            let gradient = &deformation.gradient;
            let f = deformation_gradient(&gradient.h);
            let gradients = at.block.gradients::<S>(p);
            add_products(k, &gradients, &elasticity(&f, &s, &c));
            if HOOP {
                let (rows, stretch) = (at.hoop_row::<S>(p), gradient.stretch_around());
                add_hoop(k, (&gradients, &rows), (&f, stretch), (s.z, &c.0[2]));
            }
        }
    }
}
