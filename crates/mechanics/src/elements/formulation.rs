//! Formulations of elements: how strains and stresses at the integration points depend on the displacements of the
//! nodes. Force, tangent, results, work and internal variables of several elements at a time are computed from the
//! strains and stresses at the points. See docs/theory/elements.md and docs/theory/time.md (paper eq. 12).

use super::block::{
    ElementBlock, Gradient, MatrixLanes, MovedBlock, NodalLanes, PointForces, SymmetricLanes,
};
use super::results::ResultPoint;
use super::shapes::IntegratedShape;
use crate::materials::number::{LANES, Positive};
use crate::materials::{AnyLaw, Lanes, LawInLanes, Number, Strains, StressAtPoints, Tangent};

/// Deformation and stress at an integration point.
pub struct PointState<'a> {
    /// Displacement gradient in the strain-displacement matrix; in the energy-momentum form the gradient of the mid
    /// configuration.
    pub gradient: &'a Gradient,
    /// Strains of the material.
    pub strains: &'a Strains<Lanes>,
    /// Second Piola-Kirchhoff stress that does work on the strains of the displacements (force/length^2).
    pub s: SymmetricLanes,
}

impl PointState<'_> {
    /// Data for the results of a point whose material has the strain of the displacements, with its weight (length^3).
    #[inline(always)]
    pub fn result(&self, weight: Lanes) -> ResultPoint {
        ResultPoint::new(*self.gradient, self.strains.end(), self.s, weight)
    }

    /// Writes the internal variables of a point at the end of an increment of its strains, and returns the energy
    /// dissipated in the increment (force/length^2).
    pub fn update<const HOOP: bool>(
        &self,
        p: usize,
        law: &AnyLaw<HOOP>,
        z1: &mut BlockVariables,
    ) -> Lanes {
        Lanes::of_lanes(|lane| law.update_at(lane, p, &self.strains.lane(lane), &mut z1[lane]))
    }
}

/// A block in the reference configuration.
pub struct PlacedBlock<'a, const N: usize, const P: usize> {
    /// The elements.
    pub block: &'a ElementBlock<N, P>,
    /// Inverse radius 1/R at the points (1/length): zero in plane strain and in plane stress.
    pub over_radius: &'a [Lanes; P],
    /// Places of the integration points (length).
    pub places: &'a [[Lanes; 2]; P],
    /// Tangent of the law at zero strain (force/length^2).
    pub tangent: &'a Tangent,
    /// Tangent of the viscosity at a zero change of the strain, if the material has viscosity
    /// (force time/length^2).
    pub viscous_tangent: Option<&'a Tangent>,
}

/// Internal variables of the elements of a block.
pub type BlockVariables = [Vec<f64>; LANES];

/// A formulation of elements with N nodes and P integration points, in the plane or, with `HOOP`, with all components
/// of the strain. The formulation is chosen at compile time, so a sweep has no dispatch within an element.
pub trait Formulation<const N: usize, const P: usize, const HOOP: bool>:
    Send + Sync + 'static
{
    /// Reference data of elements, except the data of their points.
    type Reference: Send + Sync;

    /// Whether the force is compiled separately for each law with formulas for several elements at a time. A separate
    /// compilation is worth its cost if a call of the law needs a large part of the time.
    const FOR_EACH_LAW: bool = false;

    /// Number of points at which the stress of the material is evaluated.
    const POINTS: usize = P;

    /// Number of variables of an element itself, in addition to the variables of its points, for a metal or for another
    /// material.
    fn own_variables(_is_metal: bool) -> usize {
        0
    }

    /// Reference data of a block.
    fn reference<S: IntegratedShape<N, P>>(placed: &PlacedBlock<N, P>) -> Self::Reference;

    /// Visits every point p with its deformation and stress. The visit is the only evaluation of the material;
    /// all other quantities are computed from the visited states. Returns whether det F is positive at all points.
    fn for_each_state<S: IntegratedShape<N, P>>(
        at: &MovedBlock<N, P, Self::Reference>,
        law: &(impl StressAtPoints<Lanes, HOOP> + ?Sized),
        visit: impl FnMut(usize, &PointState),
    ) -> Positive;

    /// Internal force F = int B_L^T S dOmega, eq. (2.5) (paper eq. 12) (force), and whether det F is positive at all points.
    #[inline(always)]
    fn force<S: IntegratedShape<N, P>>(
        at: &MovedBlock<N, P, Self::Reference>,
        law: &(impl StressAtPoints<Lanes, HOOP> + ?Sized),
    ) -> (NodalLanes<N>, Positive) {
        let mut forces = PointForces::default();
        let positive = Self::for_each_state::<S>(at, law, |p, state| {
            let s = state.s.times(at.block.volume[p]);
            forces.take::<N, HOOP, _>(at, p, state.gradient, &s);
        });
        (forces.sum::<S, N, HOOP>(), positive)
    }

    /// Adds the symmetric tangent K = dF/du (force/length); only entries [a][b] with a <= b are
    /// written.
    fn add_tangent<S: IntegratedShape<N, P>>(
        at: &MovedBlock<N, P, Self::Reference>,
        law: &AnyLaw<HOOP>,
        k: &mut MatrixLanes<N>,
    );

    /// Data for the results of the first [`Self::POINTS`] points at the displacements of the block.
    #[inline(always)]
    fn results<S: IntegratedShape<N, P>>(
        at: &MovedBlock<N, P, Self::Reference>,
        law: &AnyLaw<HOOP>,
    ) -> [ResultPoint; P] {
        let mut points = [ResultPoint::default(); P];
        Self::for_each_state::<S>(at, law, |p, state| {
            points[p] = state.result(at.block.volume[p]);
        });
        points
    }

    /// Stored energy of the hourglass modes at the displacements of the block (force length).
    #[inline(always)]
    fn hourglass_energy<S: IntegratedShape<N, P>>(
        _at: &MovedBlock<N, P, Self::Reference>,
        _law: &AnyLaw<HOOP>,
    ) -> Lanes {
        Lanes::ZERO
    }

    /// Work of the stress on the strains between two configurations, int S:(E1 - E0) dOmega (force length).
    #[inline(always)]
    fn work<S: IntegratedShape<N, P>>(
        at: &MovedBlock<N, P, Self::Reference>,
        law: &AnyLaw<HOOP>,
    ) -> Lanes {
        let mut work = Lanes::ZERO;
        Self::for_each_state::<S>(at, law, |p, state| {
            if let Strains::Between(change) = state.strains {
                let s = law.stress_at(p, state.strains);
                work += s.contract::<HOOP>(&change.change()) * at.block.volume[p];
            }
        });
        work
    }

    /// Writes the internal variables of the points and of the elements at the end of a motion. Returns the energy int D
    /// dOmega dissipated in the motion (force length). `of_variables` gives the law for given variables of the points.
    fn update<'z, S: IntegratedShape<N, P>>(
        at: &MovedBlock<N, P, Self::Reference>,
        law: &AnyLaw<HOOP>,
        _of_variables: impl Fn([&'z [f64]; LANES]) -> LawInLanes<'z>,
        (z1, _own): (&'z mut BlockVariables, &mut BlockVariables),
    ) -> Lanes {
        let mut dissipated = Lanes::ZERO;
        Self::for_each_state::<S>(at, law, |p, state| {
            dissipated += state.update(p, law, z1) * at.block.volume[p];
        });
        dissipated
    }
}
