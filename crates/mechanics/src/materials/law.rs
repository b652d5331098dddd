//! The materials that a deck may name, each in a file of its own, and their reduction to the plane. A new material is a
//! variant of [`Law`] and of [`PlaneLaw`]. A law with the internal variables that the last accepted increment has
//! committed. See docs/theory/materials.md.

use std::ops::Range;

use super::hyperelastic::Hyperelastic;
use super::number::LANES;
use super::plane_stress::PlaneStress;
use super::strains::Strains;
use super::symmetric::{Symmetric, Tangent};
#[cfg(any(test, feature = "testing"))]
use super::yielding::Yielding;
use super::{
    Across, AnyLaw, Elastic, Expanded, Flow, Hencky, Lanes, LawCard, Metal, MetalLaw, NeoHooke,
    Ogden, OneByOne, Plane, PlanePlastic, PlaneSaintVenantKirchhoff, Plastic, Polynomial,
    SaintVenantKirchhoff, SmallStrainModuli, StrainMeasure, StressAtPoints,
};

/// Law of a material with the constants from the deck.
#[derive(Debug, Clone, PartialEq)]
pub enum Law {
    /// `*ELASTIC`
    SaintVenantKirchhoff(SaintVenantKirchhoff),
    /// `*ELASTIC, TYPE=HENCKY`
    Hencky(Hencky),
    /// `*HYPERELASTIC, NEO HOOKE`
    NeoHooke(NeoHooke),
    /// Other forms of `*HYPERELASTIC` than `NEO HOOKE`.
    Polynomial(Polynomial),
    /// `*HYPERELASTIC, OGDEN`
    Ogden(Ogden),
    /// `*PLASTIC`
    Plastic(Plastic),
    /// A law with internal variables.
    #[cfg(any(test, feature = "testing"))]
    Yielding(Yielding),
}

impl Law {
    /// St. Venant-Kirchhoff material with Young's modulus (force/length^2) and Poisson's ratio.
    pub fn elastic(young: f64, poisson: f64) -> Self {
        Law::SaintVenantKirchhoff(SaintVenantKirchhoff { young, poisson })
    }

    /// Moduli of the law at small strains.
    pub fn small_strain(&self) -> SmallStrainModuli {
        match self {
            Law::SaintVenantKirchhoff(law) => law.small_strain(),
            Law::Hencky(law) => law.moduli,
            Law::NeoHooke(law) => law.small_strain(),
            Law::Polynomial(law) => law.small_strain(),
            Law::Ogden(law) => law.small_strain(),
            Law::Plastic(law) => law.small_strain(),
            #[cfg(any(test, feature = "testing"))]
            Law::Yielding(law) => law.small_strain(),
        }
    }

    /// Cards of a deck that define the law.
    pub fn cards(&self) -> Vec<LawCard> {
        match self {
            Law::SaintVenantKirchhoff(law) => law.cards(),
            Law::Hencky(law) => law.cards(),
            Law::NeoHooke(law) => law.cards(),
            Law::Polynomial(law) => law.cards(),
            Law::Ogden(law) => law.cards(),
            Law::Plastic(law) => law.cards(),
            #[cfg(any(test, feature = "testing"))]
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
            Law::Ogden(_) => 4,
            Law::Hencky(_) => 5,
            #[cfg(any(test, feature = "testing"))]
            Law::Yielding(_) => u8::MAX,
        }
    }

    /// Constants of a hyperelastic law; zero for other laws.
    pub fn constants(&self) -> Constants {
        let of_invariants = |Polynomial { shape, c01, d }: Polynomial| {
            let [c10, c20, c30] = shape;
            Constants {
                invariants: [c10, c20, c30, c01],
                compressibility: d,
                ..Constants::default()
            }
        };
        match *self {
            Law::NeoHooke(law) => of_invariants(law.into()),
            Law::Polynomial(law) => of_invariants(law),
            Law::Ogden(law) => Constants {
                compressibility: law.volume.d,
                powers: law.terms,
                ..Constants::default()
            },
            Law::SaintVenantKirchhoff(_) | Law::Hencky(_) | Law::Plastic(_) => Constants::default(),
            #[cfg(any(test, feature = "testing"))]
            Law::Yielding(_) => Constants::default(),
        }
    }

    /// Whether the law is meant only for strains that are small against 1.
    pub fn is_for_small_strains(&self) -> bool {
        matches!(self, Law::SaintVenantKirchhoff(_))
    }

    /// The law in the plane.
    pub fn in_plane(&self, plane: Plane) -> PlaneLaw {
        let poisson = self.small_strain().poisson;
        let in_stress = plane == Plane::Stress;
        match self {
            Law::SaintVenantKirchhoff(law) => PlaneLaw::SaintVenantKirchhoff(law.in_plane(plane)),
            &Law::Hencky(law) if in_stress => {
                PlaneLaw::HenckyInPlaneStress(PlaneStress { law, poisson })
            }
            &Law::Hencky(law) => PlaneLaw::Hencky(law),
            &Law::NeoHooke(law) if in_stress => {
                let law = law.into();
                PlaneLaw::PolynomialInPlaneStress(PlaneStress { law, poisson })
            }
            &Law::NeoHooke(law) => PlaneLaw::NeoHooke(law),
            &Law::Polynomial(law) if in_stress => {
                PlaneLaw::PolynomialInPlaneStress(PlaneStress { law, poisson })
            }
            &Law::Polynomial(law) => PlaneLaw::Polynomial(law),
            &Law::Ogden(law) if in_stress => {
                PlaneLaw::OgdenInPlaneStress(PlaneStress { law, poisson })
            }
            &Law::Ogden(law) => PlaneLaw::Ogden(law),
            Law::Plastic(law) => PlaneLaw::Plastic(law.in_plane(plane)),
            #[cfg(any(test, feature = "testing"))]
            &Law::Yielding(law) => PlaneLaw::Yielding(law),
        }
    }
}

/// Constants of a hyperelastic law.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Constants {
    /// The constants C10, C20, C30, C01 (force/length^2).
    pub invariants: [f64; 4],
    /// The constants D1, D2, D3 (length^2/force).
    pub compressibility: [f64; 3],
    /// The constants mu_k (force/length^2) and alpha_k.
    pub powers: [[f64; 2]; 3],
}

/// Law of a material in the plane of the elements.
#[derive(Debug, Clone, PartialEq)]
pub enum PlaneLaw {
    /// St. Venant-Kirchhoff material in any plane.
    SaintVenantKirchhoff(PlaneSaintVenantKirchhoff),
    /// Hencky's material in plane strain and in bodies of revolution.
    Hencky(Hencky),
    /// Hencky's material in plane stress.
    HenckyInPlaneStress(PlaneStress<Hencky>),
    /// Neo-Hookean material in plane strain and in bodies of revolution.
    NeoHooke(NeoHooke),
    /// Polynomial material in plane strain and in bodies of revolution.
    Polynomial(Polynomial),
    /// Polynomial or neo-Hookean material in plane stress.
    PolynomialInPlaneStress(PlaneStress<Polynomial>),
    /// Ogden's material in plane strain and in bodies of revolution.
    Ogden(Ogden),
    /// Ogden's material in plane stress.
    OgdenInPlaneStress(PlaneStress<Ogden>),
    /// A metal in any plane.
    Plastic(PlanePlastic),
    /// A law with internal variables.
    #[cfg(any(test, feature = "testing"))]
    Yielding(Yielding),
}

/// A law, sorted by the data that it needs.
enum Kind<'a> {
    /// A law that needs only the strain.
    Elastic(&'a dyn Hyperelastic),
    /// Internal variables.
    Flow(&'a dyn Flow),
}

impl PlaneLaw {
    fn kind(&self) -> Kind<'_> {
        match self {
            PlaneLaw::SaintVenantKirchhoff(law) => Kind::Elastic(law),
            PlaneLaw::Hencky(law) => Kind::Elastic(law),
            PlaneLaw::HenckyInPlaneStress(law) => Kind::Elastic(law),
            PlaneLaw::NeoHooke(law) => Kind::Elastic(law),
            PlaneLaw::Polynomial(law) => Kind::Elastic(law),
            PlaneLaw::PolynomialInPlaneStress(law) => Kind::Elastic(law),
            PlaneLaw::Ogden(law) => Kind::Elastic(law),
            PlaneLaw::OgdenInPlaneStress(law) => Kind::Elastic(law),
            PlaneLaw::Plastic(law) => Kind::Flow(law),
            #[cfg(any(test, feature = "testing"))]
            PlaneLaw::Yielding(law) => Kind::Flow(law),
        }
    }

    /// Number of internal variables at a point.
    pub fn variables(&self) -> usize {
        match self.kind() {
            Kind::Elastic(_) => 0,
            Kind::Flow(law) => law.variables(),
        }
    }

    /// Tangent at zero strain and zero internal variables (force/length^2).
    pub fn initial_tangent(&self) -> Tangent {
        match self.kind() {
            Kind::Elastic(law) => law.tangent(&Symmetric::zeros()),
            Kind::Flow(law) => {
                let z0 = vec![0.0; law.variables()];
                law.tangent(&Strains::At(Symmetric::zeros()), &z0)
            }
        }
    }

    /// The law with the functions of a metal, if it is a metal.
    pub fn as_metal(&self) -> Option<&dyn MetalLaw> {
        match self.kind() {
            Kind::Elastic(_) => None,
            Kind::Flow(law) => law.as_metal(),
        }
    }
}

/// A law for several elements at a time, with the internal variables of the elements' points.
pub enum LawInLanes<'a> {
    /// St. Venant-Kirchhoff material.
    SaintVenantKirchhoff(Elastic<'a, PlaneSaintVenantKirchhoff>),
    /// Neo-Hookean material.
    NeoHooke(Elastic<'a, NeoHooke>),
    /// A law that is evaluated for one element after the other.
    OneByOne(OneByOne<Committed<'a>>),
    /// Any plane law at the temperatures of the points.
    Expanded(Box<Expanded<'a>>),
}

impl PlaneLaw {
    /// The law for several elements at a time, with the variables of all their points.
    #[inline(always)]
    pub fn in_lanes<'a>(&'a self, variables: [&'a [f64]; LANES]) -> LawInLanes<'a> {
        match self {
            PlaneLaw::SaintVenantKirchhoff(law) => LawInLanes::SaintVenantKirchhoff(Elastic(law)),
            PlaneLaw::NeoHooke(law) => LawInLanes::NeoHooke(Elastic(law)),
            law => LawInLanes::OneByOne(Committed::side_by_side(law, variables)),
        }
    }

    /// The same law with the thermal strain at every point, in a plane.
    pub fn expanded<'a>(
        &'a self,
        variables: [&'a [f64]; LANES],
        plane: Plane,
        strains: &[Lanes],
    ) -> LawInLanes<'a> {
        let law: Box<AnyLaw<'a, true>> = match self {
            PlaneLaw::SaintVenantKirchhoff(law) => Box::new(Elastic(law)),
            PlaneLaw::NeoHooke(law) => Box::new(Elastic(law)),
            law => Box::new(Committed::side_by_side(law, variables)),
        };
        let metals = variables.map(|all| Some((self.as_metal()?, all.get(..self.variables())?)));
        LawInLanes::Expanded(Box::new(Expanded::new(law, metals, plane, strains)))
    }
}

impl LawInLanes<'_> {
    /// The functions of the law.
    #[inline(always)]
    pub fn any<const HOOP: bool>(&self) -> &AnyLaw<'_, HOOP> {
        match self {
            LawInLanes::SaintVenantKirchhoff(law) => law,
            LawInLanes::NeoHooke(law) => law,
            LawInLanes::OneByOne(law) => law,
            LawInLanes::Expanded(law) => &**law,
        }
    }
}

/// A law with the internal variables that the last accepted increment has committed at the integration points of an
/// element, one point after the other.
#[derive(Debug, Clone, Copy)]
pub struct Committed<'a> {
    law: &'a PlaneLaw,
    variables: &'a [f64],
}

impl<'a> Committed<'a> {
    /// A law with the variables of all points of an element.
    pub fn new(law: &'a PlaneLaw, variables: &'a [f64]) -> Self {
        Committed { law, variables }
    }

    /// A law with the variables of all points of several elements.
    pub fn side_by_side(law: &'a PlaneLaw, variables: [&'a [f64]; LANES]) -> OneByOne<Self> {
        OneByOne(variables.map(|z| Committed::new(law, z)))
    }

    /// Internal variables of a point, among the variables of the element.
    fn of_point(&self, point: usize) -> Range<usize> {
        let count = self.law.variables();
        point * count..(point + 1) * count
    }

    fn at(&self, point: usize) -> &[f64] {
        &self.variables[self.of_point(point)]
    }
}

impl StressAtPoints for Committed<'_> {
    fn stress_at(&self, point: usize, strains: &Strains) -> Symmetric {
        match self.law.kind() {
            Kind::Elastic(law) => law.stress_of(strains),
            Kind::Flow(law) => law.stress(strains, self.at(point)),
        }
    }

    fn tangent_at(&self, point: usize, strains: &Strains) -> Tangent {
        match self.law.kind() {
            Kind::Elastic(law) => law.tangent_of(strains),
            Kind::Flow(law) => law.tangent(strains, self.at(point)),
        }
    }

    fn energy_at(&self, point: usize, e: &Symmetric) -> f64 {
        match self.law.kind() {
            Kind::Elastic(law) => law.energy(e),
            Kind::Flow(law) => law.stored_energy(e, self.at(point)),
        }
    }

    fn across_at(&self, point: usize, e: &Symmetric) -> Across {
        match self.law.kind() {
            Kind::Elastic(law) => law.across(e),
            Kind::Flow(law) => law.across(e, self.at(point)),
        }
    }

    fn convex_in(&self) -> StrainMeasure {
        match self.law.kind() {
            Kind::Elastic(law) => law.convex_in(),
            Kind::Flow(law) => law.convex_in(),
        }
    }

    fn metal(&self, _lane: usize) -> Option<Metal<'_>> {
        self.law.as_metal().map(|law| Metal {
            law,
            of_point: self.at(0),
        })
    }

    fn plastic_strain_at(&self, _lane: usize, point: usize) -> f64 {
        match self.law.kind() {
            Kind::Elastic(_) => 0.0,
            Kind::Flow(law) => law.plastic_strain(self.at(point)),
        }
    }

    fn update_at(&self, _lane: usize, point: usize, strains: &Strains, z1: &mut [f64]) -> f64 {
        match self.law.kind() {
            Kind::Elastic(_) => 0.0,
            Kind::Flow(law) => {
                let z0 = self.at(point);
                law.update(strains, z0, &mut z1[self.of_point(point)]);
                law.dissipation(strains, z0)
            }
        }
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
    const PLANE_LAW: PlaneLaw = PlaneLaw::Yielding(LAW);
    /// Internal variables of two points.
    type Variables = [f64; 8];

    /// State of a body of two points at one time, like the state of a run.
    #[derive(Clone, Debug, PartialEq)]
    struct State {
        strains: [Symmetric; 2],
        committed: Variables,
    }

    /// An increment to new strains: the state at the end of the increment, the work of the stresses, and the energy
    /// dissipated; `None` if the strain has changed too much at once.
    fn attempt(start: &State, strains: [Symmetric; 2]) -> Option<(State, f64, f64)> {
        let material = Committed::new(&PLANE_LAW, &start.committed);
        let (mut work, mut dissipated, mut committed) = (0.0, 0.0, [0.0; 8]);
        for (p, (e0, e1)) in start.strains.iter().zip(&strains).enumerate() {
            let strains = Strains::between(e0, e1);
            work += material.stress_at(p, &strains).contract::<true>(&(e1 - e0));
            dissipated += material.update_at(0, p, &strains, &mut committed);
        }
        let step = strains[0] - start.strains[0];
        let end = State { strains, committed };
        (step.norm() < 0.03).then_some((end, work, dissipated))
    }

    fn energy(state: &State) -> f64 {
        let material = Committed::new(&PLANE_LAW, &state.committed);
        let at = |p: usize| material.energy_at(p, &state.strains[p]);
        at(0) + at(1)
    }

    /// Strains of the two points at a time; the strain of the second point is a quarter of the first, with other signs.
    fn path(time: f64) -> [Symmetric; 2] {
        let e = Symmetric::new(0.06, -0.03, 0.0, 0.01) * (2.0 * time).sin();
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
            // the increment is too long at first and is then halved; a failed attempt changes
            // nothing
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
        let material = Committed::new(&PLANE_LAW, &start);
        let strains = Strains::At(Symmetric::new(0.05, 0.01, 0.0, 0.0));
        let mut updated = [0.0; 8];
        material.update_at(0, 0, &strains, &mut updated);
        let (now, after) = (
            material.stress_at(0, &strains),
            Committed::new(&PLANE_LAW, &updated).stress_at(0, &strains),
        );
        assert!((now - after).norm() < 1e-13 * now.norm() && updated[3] > 0.01);
    }
}
