//! The materials a deck may name, each in a file of its own, and their reduction to the plane: a new one is a variant of
//! [`Law`] and of [`PlaneLaw`]. A law with the internal variables that the last accepted increment has committed.
//! Section 2 of docs/theory.md.

use std::ops::Range;

use nalgebra::{Matrix2, Matrix3, Matrix4};
use smallvec::SmallVec;

#[cfg(test)]
use super::yielding::Yielding;
use super::{
    Across, ConstitutiveLaw, LawCard, Metal, MetalLaw, NeoHooke, Plane, PlanePlastic,
    PlanePolynomial, PlaneSaintVenantKirchhoff, Plastic, Polynomial, RingStressAtPoints,
    SaintVenantKirchhoff, SmallStrainModuli, StrainMeasure, Strains, StressAtPoints, Symmetric,
};

/// Law of a material with the constants of the deck.
#[derive(Debug, Clone, PartialEq)]
pub enum Law {
    /// `*ELASTIC`
    SaintVenantKirchhoff(SaintVenantKirchhoff),
    /// `*HYPERELASTIC, NEO HOOKE`
    NeoHooke(NeoHooke),
    /// `*HYPERELASTIC` of other forms.
    Polynomial(Polynomial),
    /// `*PLASTIC`
    Plastic(Plastic),
    /// A law with internal variables.
    #[cfg(test)]
    Yielding(Yielding),
}

impl Law {
    /// St. Venant-Kirchhoff material of Young's modulus (force/length^2) and Poisson's ratio.
    pub fn elastic(young: f64, poisson: f64) -> Self {
        Law::SaintVenantKirchhoff(SaintVenantKirchhoff { young, poisson })
    }

    /// Moduli at small strains.
    pub fn small_strain(&self) -> SmallStrainModuli {
        match self {
            Law::SaintVenantKirchhoff(law) => law.small_strain(),
            Law::NeoHooke(law) => law.small_strain(),
            Law::Polynomial(law) => law.small_strain(),
            Law::Plastic(law) => law.small_strain(),
            #[cfg(test)]
            Law::Yielding(law) => law.small_strain(),
        }
    }

    /// Cards from which a deck has the law.
    pub fn cards(&self) -> Vec<LawCard> {
        match self {
            Law::SaintVenantKirchhoff(law) => law.cards(),
            Law::NeoHooke(law) => law.cards(),
            Law::Polynomial(law) => law.cards(),
            Law::Plastic(law) => law.cards(),
            #[cfg(test)]
            Law::Yielding(_) => Vec::new(),
        }
    }

    /// Number of the law in result files (docs/output.md).
    pub fn number(&self) -> u8 {
        match self {
            Law::SaintVenantKirchhoff(_) => 0,
            Law::NeoHooke(_) => 1,
            Law::Polynomial(_) => 2,
            Law::Plastic(_) => 3,
            #[cfg(test)]
            Law::Yielding(_) => u8::MAX,
        }
    }

    /// Constants of the invariants of a hyperelastic law, zero of others.
    pub fn constants_of_invariants(&self) -> Polynomial {
        match *self {
            Law::NeoHooke(law) => law.into(),
            Law::Polynomial(law) => law,
            _ => Polynomial::default(),
        }
    }

    /// Whether the law is no guide at strains that are not small against 1.
    pub fn is_for_small_strains(&self) -> bool {
        matches!(self, Law::SaintVenantKirchhoff(_))
    }

    /// The law in the plane.
    pub fn in_plane(&self, plane: Plane) -> PlaneLaw {
        let polynomial = |law| PlaneLaw::Polynomial(PlanePolynomial { law, plane });
        match self {
            Law::SaintVenantKirchhoff(law) => PlaneLaw::SaintVenantKirchhoff(law.in_plane(plane)),
            &Law::NeoHooke(law) => match plane {
                Plane::Strain | Plane::Revolution => PlaneLaw::NeoHooke(law),
                Plane::Stress => polynomial(law.into()),
            },
            &Law::Polynomial(law) => polynomial(law),
            Law::Plastic(law) => PlaneLaw::Plastic(law.in_plane(plane)),
            #[cfg(test)]
            &Law::Yielding(law) => PlaneLaw::Yielding(law),
        }
    }
}

/// Law of a material in the plane of the elements.
#[derive(Debug, Clone, PartialEq)]
pub enum PlaneLaw {
    /// In plane stress or plane strain.
    SaintVenantKirchhoff(PlaneSaintVenantKirchhoff),
    /// In plane strain.
    NeoHooke(NeoHooke),
    /// In plane stress or plane strain.
    Polynomial(PlanePolynomial),
    /// A metal.
    Plastic(PlanePlastic),
    /// A law with internal variables.
    #[cfg(test)]
    Yielding(Yielding),
}

impl PlaneLaw {
    /// The law in all components of the strain of a ring.
    fn of_ring(&self) -> &dyn super::RingLaw {
        match self {
            PlaneLaw::SaintVenantKirchhoff(law) => law,
            PlaneLaw::NeoHooke(law) => law,
            PlaneLaw::Polynomial(PlanePolynomial { law, .. }) => law,
            PlaneLaw::Plastic(law) => law,
            #[cfg(test)]
            PlaneLaw::Yielding(law) => law,
        }
    }
}

/// The same function of the law that it is.
macro_rules! of_each {
    ($self:ident, $law:ident => $value:expr) => {
        match $self {
            PlaneLaw::SaintVenantKirchhoff($law) => $value,
            PlaneLaw::NeoHooke($law) => $value,
            PlaneLaw::Polynomial($law) => $value,
            PlaneLaw::Plastic($law) => $value,
            #[cfg(test)]
            PlaneLaw::Yielding($law) => $value,
        }
    };
}

impl ConstitutiveLaw for PlaneLaw {
    #[inline]
    fn variables(&self) -> usize {
        of_each!(self, law => law.variables())
    }

    #[inline]
    fn stress(&self, strains: &Strains, z0: &[f64], z1: &mut [f64]) -> Matrix2<f64> {
        of_each!(self, law => law.stress(strains, z0, z1))
    }

    #[inline]
    fn tangent(&self, strains: &Strains, z0: &[f64]) -> Matrix3<f64> {
        of_each!(self, law => law.tangent(strains, z0))
    }

    fn stresses(&self, strains: &[Strains], z0: &[f64], s: &mut [Matrix2<f64>]) {
        of_each!(self, law => ConstitutiveLaw::stresses(law, strains, z0, s));
    }

    fn tangents(&self, strains: &[Strains], z0: &[f64], c: &mut [Matrix3<f64>]) {
        of_each!(self, law => ConstitutiveLaw::tangents(law, strains, z0, c));
    }

    fn stored_energy(&self, e: &Matrix2<f64>, z: &[f64]) -> f64 {
        of_each!(self, law => law.stored_energy(e, z))
    }

    fn dissipation(&self, strains: &Strains, z0: &[f64]) -> f64 {
        of_each!(self, law => law.dissipation(strains, z0))
    }

    fn across(&self, e: &Matrix2<f64>, z: &[f64]) -> Across {
        of_each!(self, law => law.across(e, z))
    }

    fn plastic_strain(&self, z: &[f64]) -> f64 {
        of_each!(self, law => law.plastic_strain(z))
    }

    fn as_metal(&self) -> Option<&dyn MetalLaw> {
        of_each!(self, law => law.as_metal())
    }

    fn convex_in(&self) -> StrainMeasure {
        match self {
            PlaneLaw::SaintVenantKirchhoff(_) => StrainMeasure::Green,
            PlaneLaw::NeoHooke(_) | PlaneLaw::Polynomial(_) | PlaneLaw::Plastic(_) => {
                StrainMeasure::Logarithmic
            }
            #[cfg(test)]
            PlaneLaw::Yielding(_) => StrainMeasure::Green,
        }
    }
}

/// Evaluates an expression for a plane law without internal variables as a [`super::LawInLanes`].
macro_rules! in_lanes {
    ($law:expr, $in_lanes:ident => $value:expr) => {
        match $law {
            $crate::materials::PlaneLaw::SaintVenantKirchhoff($in_lanes) => $value,
            $crate::materials::PlaneLaw::NeoHooke($in_lanes) => $value,
            law => {
                let $in_lanes = &$crate::materials::OneByOne(law);
                $value
            }
        }
    };
}
pub(crate) use in_lanes;

/// A law with the internal variables that the last accepted increment has committed at the integration points of an
/// element, point after point.
#[derive(Debug, Clone, Copy)]
pub struct Committed<'a, L = PlaneLaw> {
    law: &'a L,
    variables: &'a [f64],
}

impl<'a, L: ConstitutiveLaw> Committed<'a, L> {
    /// A law with the variables of all points of an element.
    pub fn new(law: &'a L, variables: &'a [f64]) -> Self {
        Committed { law, variables }
    }

    /// The law with other variables.
    pub fn with<'b>(&self, variables: &'b [f64]) -> Committed<'b, L>
    where
        'a: 'b,
    {
        Committed::new(self.law, variables)
    }

    /// Whether the internal variables of the element begin with some.
    pub fn are_first_variables(&self, variables: &[f64]) -> bool {
        self.variables.starts_with(variables)
    }

    /// Internal variables of a point among those of the element.
    #[inline]
    fn of_point(&self, point: usize) -> Range<usize> {
        let count = self.law.variables();
        point * count..(point + 1) * count
    }

    #[inline]
    fn at(&self, point: usize) -> &[f64] {
        &self.variables[self.of_point(point)]
    }

    /// Stored energy W(E, z) of a point per volume (force/length^2).
    pub fn stored_energy(&self, point: usize, e: &Matrix2<f64>) -> f64 {
        self.law.stored_energy(e, self.at(point))
    }

    /// Stretch and stress across the thickness at a point.
    pub fn across(&self, point: usize, e: &Matrix2<f64>) -> Across {
        self.law.across(e, self.at(point))
    }

    /// The variables behind those of the points.
    fn behind(&self, points: usize) -> &[f64] {
        let own = self.variables.get(points * self.law.variables()..);
        own.unwrap_or_default()
    }

    /// A metal with the variables of the first point and those behind all points, where there are some.
    fn metal_with_modes(&self, points: usize) -> Option<Metal<'_>> {
        let law = self.law.as_metal()?;
        let of_modes = self.behind(points);
        (!of_modes.is_empty()).then(|| Metal {
            law,
            of_point: self.at(0),
            of_modes,
        })
    }

    /// Accumulated plastic strain of a point.
    pub fn plastic_strain(&self, point: usize) -> f64 {
        self.law.plastic_strain(self.at(point))
    }

    /// Internal variables of a point at the end of the strains, written to `updated`, and the energy dissipated on
    /// the way to them per volume (force/length^2).
    pub fn update(&self, point: usize, strains: &Strains, updated: &mut [f64]) -> f64 {
        let z0 = self.at(point);
        self.law
            .stress(strains, z0, &mut updated[self.of_point(point)]);
        self.law.dissipation(strains, z0)
    }
}

impl<L: ConstitutiveLaw> StressAtPoints for Committed<'_, L> {
    #[inline]
    fn stress(&self, point: usize, strains: &Strains) -> Matrix2<f64> {
        let z0 = self.at(point);
        let mut z1: SmallVec<[f64; 8]> = SmallVec::from_slice(z0);
        self.law.stress(strains, z0, &mut z1)
    }

    #[inline]
    fn tangent(&self, point: usize, strains: &Strains) -> Matrix3<f64> {
        self.law.tangent(strains, self.at(point))
    }

    fn stresses<const P: usize>(&self, strains: &[Strains; P]) -> [Matrix2<f64>; P] {
        let mut s = [Matrix2::zeros(); P];
        self.law.stresses(strains, self.variables, &mut s);
        s
    }

    fn tangents<const P: usize>(&self, strains: &[Strains; P]) -> [Matrix3<f64>; P] {
        let mut c = [Matrix3::zeros(); P];
        self.law.tangents(strains, self.variables, &mut c);
        c
    }

    fn initial_tangent(&self) -> Matrix3<f64> {
        let z0: SmallVec<[f64; 16]> = SmallVec::from_elem(0.0, self.law.variables());
        self.law.tangent(&Strains::At(Matrix2::zeros()), &z0)
    }

    fn convex_in(&self) -> StrainMeasure {
        self.law.convex_in()
    }

    fn beyond(&self, points: usize) -> &[f64] {
        self.behind(points)
    }

    fn metal(&self, points: usize) -> Option<Metal<'_>> {
        self.metal_with_modes(points)
    }
}

impl Committed<'_> {
    /// Stored energy W(E, z) of a point of a ring per volume (force/length^2).
    pub fn ring_energy(&self, point: usize, e: &Symmetric) -> f64 {
        self.law.of_ring().stored_energy(e, self.at(point))
    }

    /// As [`Self::update`] at a point of a ring.
    pub fn ring_update(
        &self,
        point: usize,
        strains: &Strains<Symmetric>,
        updated: &mut [f64],
    ) -> f64 {
        let (law, z0) = (self.law.of_ring(), self.at(point));
        law.stress(strains, z0, &mut updated[self.of_point(point)]);
        law.dissipation(strains, z0)
    }
}

impl RingStressAtPoints for Committed<'_> {
    fn ring_initial_tangent(&self) -> Matrix4<f64> {
        let z0: SmallVec<[f64; 16]> = SmallVec::from_elem(0.0, self.law.variables());
        let zero = Strains::At(Symmetric::zeros());
        self.law.of_ring().tangent(&zero, &z0)
    }

    fn ring_convex_in(&self) -> StrainMeasure {
        self.law.convex_in()
    }

    fn ring_beyond(&self, points: usize) -> &[f64] {
        self.behind(points)
    }

    fn ring_metal(&self, points: usize) -> Option<Metal<'_>> {
        self.metal_with_modes(points)
    }

    fn ring_stress(&self, point: usize, strains: &Strains<Symmetric>) -> Symmetric {
        let z0 = self.at(point);
        let mut z1: SmallVec<[f64; 8]> = SmallVec::from_slice(z0);
        self.law.of_ring().stress(strains, z0, &mut z1)
    }

    fn ring_tangent(&self, point: usize, strains: &Strains<Symmetric>) -> Matrix4<f64> {
        self.law.of_ring().tangent(strains, self.at(point))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::yielding::{Yielding, plastic};

    const LAW: Yielding = Yielding {
        g: 50.0,
        y: 0.02,
        r: 0.3,
        c: 0.05,
    };
    /// Internal variables of two points.
    type Variables = [f64; 8];

    /// What a body of two points has at one time, as the state of a run.
    #[derive(Clone, Debug, PartialEq)]
    struct State {
        strains: [Matrix2<f64>; 2],
        committed: Variables,
    }

    /// An increment to new strains: the state at its end, the work of the stresses and the energy
    /// dissipated; `None` if the strain has gone too far at once.
    fn attempt(start: &State, strains: [Matrix2<f64>; 2]) -> Option<(State, f64, f64)> {
        let material = Committed::new(&LAW, &start.committed);
        let (mut work, mut dissipated, mut committed) = (0.0, 0.0, [0.0; 8]);
        for (p, (e0, e1)) in start.strains.iter().zip(&strains).enumerate() {
            let strains = Strains::Between(*e0, *e1);
            work += material.stress(p, &strains).dot(&(e1 - e0));
            dissipated += material.update(p, &strains, &mut committed);
        }
        let step = strains[0] - start.strains[0];
        let end = State { strains, committed };
        (step.norm() < 0.03).then_some((end, work, dissipated))
    }

    fn energy(state: &State) -> f64 {
        let material = Committed::new(&LAW, &state.committed);
        let at = |p: usize| material.stored_energy(p, &state.strains[p]);
        at(0) + at(1)
    }

    /// Strains of the two points at a time, the second with a quarter of the first and other signs.
    fn path(time: f64) -> [Matrix2<f64>; 2] {
        let e = Matrix2::new(0.06, 0.01, 0.01, -0.03) * (2.0 * time).sin();
        [e, e * -0.25]
    }

    #[test]
    fn variables_are_committed_with_an_accepted_increment_and_dropped_with_a_failed_one() {
        let mut state = State {
            strains: path(0.0),
            committed: [0.0; 8],
        };
        let (mut time, mut failed, mut total) = (0.0, 0, 0.0);
        while time < 3.0 {
            // too long at first, then in halves: a failed attempt leaves nothing behind
            let mut dt = 0.5;
            let (end, work, dissipated) = loop {
                let before = state.clone();
                let found = attempt(&state, path(time + dt));
                assert_eq!(state, before);
                match found {
                    Some(found) => break found,
                    None => (dt, failed) = (dt / 2.0, failed + 1),
                }
            };
            // work = W1 - W0 + D with D >= 0
            let change = energy(&end) - energy(&state);
            assert!((work - change - dissipated).abs() < 1e-14 && dissipated >= 0.0);
            (time, total, state) = (time + dt, total + dissipated, end);
        }
        assert!(failed > 3 && total > 0.01);
        // the first point has yielded; the second, with a quarter of its strain, has not
        assert!(state.committed[0].abs() > 0.01 && state.committed[4..] == [0.0; 4]);
        // the end is on its own yield surface or within
        let z = &state.committed;
        let stress = (state.strains[0] - plastic(z)).norm() * LAW.g;
        let most = LAW.g * LAW.y + LAW.r * (1.0 - (-z[3] / LAW.c).exp());
        assert!(stress <= most * (1.0 + 1e-14));
    }

    #[test]
    fn stresses_are_those_of_the_iterate() {
        let start = [0.01, -0.02, 0.005, 0.0, 0.0, 0.0, 0.0, 0.0];
        let material = Committed::new(&LAW, &start);
        let strains = Strains::At(Matrix2::new(0.05, 0.0, 0.0, 0.01));
        let mut updated = [0.0; 8];
        material.update(0, &strains, &mut updated);
        let (now, after) = (
            material.stress(0, &strains),
            Committed::new(&LAW, &updated).stress(0, &strains),
        );
        assert!((now - after).norm() < 1e-13 * now.norm() && updated[3] > 0.01);
    }
}
