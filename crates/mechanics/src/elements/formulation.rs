//! What a formulation of an element is: how strains and stresses at the integration points follow from the displacements of
//! its nodes. Force, tangent, results, work and internal variables of elements side by side follow from these.
//! See docs/theory/elements.md and docs/theory/time.md (paper eq. 12).

use super::block::{
    ElementBlock, Gradient, MatrixLanes, MovedBlock, NodalLanes, PointForces, SymmetricLanes,
};
use super::results::ResultPoint;
use super::shapes::IntegratedShape;
use crate::materials::number::{LANES, Positive};
use crate::materials::{AnyLaw, Lanes, LawInLanes, Number, Strains, StressAtPoints, Tangent};

/// Deformation and stress at an integration point.
pub struct PointState<'a> {
    /// Displacement gradient of the strain-displacement matrix: that of the mid configuration in the energy-momentum form.
    pub gradient: &'a Gradient,
    /// Strains that the material has.
    pub strains: &'a Strains<Lanes>,
    /// Second Piola-Kirchhoff stress that does work on the strains of the displacements (force/length^2).
    pub s: SymmetricLanes,
}

impl PointState<'_> {
    /// The results of a point whose material has the strain of the displacements, with its weight (length^3).
    #[inline(always)]
    pub fn result(&self, weight: Lanes) -> ResultPoint {
        ResultPoint::new(*self.gradient, self.strains.end(), self.s, weight)
    }

    /// Writes the internal variables of a point at the end of its strains, and gives the energy dissipated on the way to them
    /// (force/length^2).
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
    /// 1/R at the points: zero in plane strain and in plane stress (1/length).
    pub over_radius: &'a [Lanes; P],
    /// Places of the points (length).
    pub places: &'a [[Lanes; 2]; P],
    /// Tangent of the law at no strain (force/length^2).
    pub tangent: &'a Tangent,
    /// That of the viscosity at no change of the strain, where there is one (force time/length^2).
    pub viscous_tangent: Option<&'a Tangent>,
}

/// Internal variables of the elements of a block.
pub type BlockVariables = [Vec<f64>; LANES];

/// A formulation of elements with N nodes and P integration points, in the plane or, with `HOOP`, with all components of the
/// strain. Chosen at compile time: a sweep has no dispatch within an element.
pub trait Formulation<const N: usize, const P: usize, const HOOP: bool>:
    Send + Sync + 'static
{
    /// What elements have beside their points in the reference configuration.
    type Reference: Send + Sync;

    /// Whether the force is compiled for each law that has formulas for elements side by side, as where a call of the law
    /// takes a good part of its time.
    const FOR_EACH_LAW: bool = false;

    /// Points at which the material has its stress.
    const POINTS: usize = P;

    /// Number of variables of an element beside those of its points, of a metal or of another material.
    fn own_variables(_is_metal: bool) -> usize {
        0
    }

    /// Reference data of a block.
    fn reference<S: IntegratedShape<N, P>>(placed: &PlacedBlock<N, P>) -> Self::Reference;

    /// Visits every point p with its deformation and stress: the one evaluation of the material, from which all else
    /// follows. Gives whether det F is positive at all points.
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

    /// Adds the symmetric tangent K = dF/du (force/length): entries [a][b] with a <= b.
    fn add_tangent<S: IntegratedShape<N, P>>(
        at: &MovedBlock<N, P, Self::Reference>,
        law: &AnyLaw<HOOP>,
        k: &mut MatrixLanes<N>,
    );

    /// What the results of the first [`Self::POINTS`] points at displacements follow from.
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

    /// Stored energy of the hourglass modes at displacements (force length).
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

    /// Writes the internal variables at the end of a motion: those of the points, and those of the elements. Gives the energy
    /// dissipated on the way to them, int D dOmega (force length). `of_variables` gives the law with variables of the points.
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
