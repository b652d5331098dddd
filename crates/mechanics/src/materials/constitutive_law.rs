//! Functions of a material at an integration point that elements call. See docs/theory/materials.md and
//! docs/theory/time.md.

use std::array::from_fn;

use super::hyperelastic::Hyperelastic;
use super::number::{LANES, Lanes, Number};
use super::strains::{Across, StrainChange, StrainMeasure, Strains};
use super::symmetric::{Symmetric, Tangent};

/// A law with internal variables. From the strains of an iterate and the internal variables z0, which the last accepted
/// increment has committed, the law computes the stress, the tangent, and the internal variables z1 of the iterate. The
/// law computes z1 by a local solution (return mapping).
///
/// Energies are per reference volume (force/length^2); the stored energy is kept apart from the dissipated energy.
pub trait Flow {
    /// Number of internal variables at a point.
    fn variables(&self) -> usize;

    /// Second Piola-Kirchhoff stress S, eq. (2.3), or energy-momentum stress, eq. (4.8) (force/length^2).
    fn stress(&self, strains: &Strains, z0: &[f64]) -> Symmetric;

    /// Writes the internal variables z1 at the end of the strains.
    fn update(&self, strains: &Strains, z0: &[f64], z1: &mut [f64]);

    /// Tangent dS/dE of [`Self::stress`], or in the energy-momentum form the symmetric part of 2 dS/dE1. The tangent
    /// acts on strains (11, 22, 33, 2*12) and includes the dependence of z1 on the strain (force/length^2).
    fn tangent(&self, strains: &Strains, z0: &[f64]) -> Tangent;

    /// Stored energy W(E, z).
    fn stored_energy(&self, e: &Symmetric, z: &[f64]) -> f64;

    /// Energy D >= 0 dissipated as the variables change from z0 to the z1 of the strains.
    fn dissipation(&self, strains: &Strains, z0: &[f64]) -> f64;

    /// Stretch and stress across the plane.
    fn across(&self, e: &Symmetric, z: &[f64]) -> Across;

    /// Accumulated plastic strain.
    fn plastic_strain(&self, z: &[f64]) -> f64;

    /// The measure of strain in which the potential of an increment is convex.
    fn convex_in(&self) -> StrainMeasure {
        StrainMeasure::Logarithmic
    }

    /// The law with the functions of a metal, if it is a metal.
    fn as_metal(&self) -> Option<&dyn MetalLaw> {
        None
    }
}

/// Functions of a metal that elements with hourglass modes call: a potential W(E; m), without the elastic energy of the
/// modes. The argument m is the part that the modes add to the square q² of the von Mises stress (force^2/length^4),
/// eq. (2.48).
pub trait MetalLaw: std::fmt::Debug {
    /// The moduli 3 mu and H_k (force/length^2).
    fn moduli(&self) -> [f64; 2];

    /// Writes the internal variables at the end of the strains of an increment, with the squares m of the modes at its
    /// start and at its end. Returns the dissipated energy (force/length^2) and the part r of the trial strain that
    /// flows.
    fn update(&self, strains: &Strains, z0: &[f64], modes: [f64; 2], z1: &mut [f64]) -> [f64; 2];

    /// Change of the potential W between two strains with their squares m, with a round-off that is relative to the
    /// changes (force/length^2); `by` is the difference of m.
    fn change(&self, z0: &[f64], strains: &StrainChange, modes: [f64; 2], by: f64) -> f64;

    /// The stress S (force/length^2) and the derivative dW/dm.
    fn bent_stress(&self, z0: &[f64], e: &Symmetric, modes: f64) -> (Symmetric, f64);

    /// Second derivatives of the potential.
    fn bent_tangent(&self, z0: &[f64], e: &Symmetric, modes: f64) -> BentTangent;
}

/// Second derivatives of a potential W(E; m), and its first derivative with respect to m.
#[derive(Debug, Clone, Copy)]
pub struct BentTangent {
    /// C (force/length^2).
    pub tangent: Tangent,
    /// Derivatives dW/dm and d²W/dm².
    pub by_modes: [f64; 2],
    /// dS/dm.
    pub stress_by_modes: Symmetric,
}

/// A metal with the internal variables of a point.
#[derive(Debug, Clone, Copy)]
pub struct Metal<'a> {
    /// The law.
    pub law: &'a dyn MetalLaw,
    /// Internal variables of the point.
    pub of_point: &'a [f64],
}

/// A stress that depends on the strains at the integration points of elements: the stress of the material, or of its
/// viscosity.
pub trait StressAtPoints<T = f64, const HOOP: bool = true> {
    /// Second Piola-Kirchhoff stress at a point, eq. (2.3), or energy-momentum stress, eq. (4.8) (force/length^2).
    fn stress_at(&self, point: usize, strains: &Strains<T>) -> Symmetric<T>;

    /// Tangent of [`Self::stress_at`] at a point, or the symmetric part of twice its derivative with respect to E1
    /// (force/length^2).
    fn tangent_at(&self, point: usize, strains: &Strains<T>) -> Tangent<T>;

    /// [`Self::stress_at`] for the elements that are wanted; the values of other elements are arbitrary.
    fn stress_where(
        &self,
        _wanted: [bool; LANES],
        point: usize,
        strains: &Strains<T>,
    ) -> Symmetric<T> {
        self.stress_at(point, strains)
    }

    /// [`Self::tangent_at`] for the elements that are wanted; the values of other elements are arbitrary.
    fn tangent_where(
        &self,
        _wanted: [bool; LANES],
        point: usize,
        strains: &Strains<T>,
    ) -> Tangent<T> {
        self.tangent_at(point, strains)
    }

    /// Stored energy W at a point (force/length^2).
    fn energy_at(&self, point: usize, e: &Symmetric<T>) -> T;

    /// Stretch and stress across the plane at a point.
    fn across_at(&self, point: usize, e: &Symmetric<T>) -> Across<T>;

    /// Whether the stress depends on a change of the strains and stores no energy (viscosity).
    fn is_viscous(&self) -> bool {
        false
    }

    /// The measure of strain in which the potential of the stress is convex; the measure is logarithmic if the law
    /// fulfils Hill's inequality. The potential of a viscosity is quadratic in the Green-Lagrange strains.
    fn convex_in(&self) -> StrainMeasure {
        StrainMeasure::Green
    }

    /// Factor on the tangent at zero strain, from which the hourglass stiffness is made; `None` if it is 1.
    fn stiffness_factor(&self) -> Option<T> {
        None
    }

    /// The metal at the first point of an element.
    fn metal(&self, _lane: usize) -> Option<Metal<'_>> {
        None
    }

    /// Accumulated plastic strain at a point of an element.
    fn plastic_strain_at(&self, _lane: usize, _point: usize) -> f64 {
        0.0
    }

    /// Computes the internal variables at the end of the strains of one point, writes them to all points of the
    /// element, and returns the energy dissipated in the increment (force/length^2).
    fn update_at(&self, _lane: usize, _point: usize, _strains: &Strains, _z1: &mut [f64]) -> f64 {
        0.0
    }
}

/// The stress of several elements at a time, by any law.
pub type AnyLaw<'a, const HOOP: bool> = dyn StressAtPoints<Lanes, HOOP> + 'a;

/// The stresses of an elastic law.
pub struct Elastic<'a, L>(pub &'a L);

impl<T: Number, const HOOP: bool, L: Hyperelastic<T, HOOP>> StressAtPoints<T, HOOP>
    for Elastic<'_, L>
{
    #[inline(always)]
    fn stress_at(&self, _point: usize, strains: &Strains<T>) -> Symmetric<T> {
        self.0.stress_of(strains)
    }

    #[inline(always)]
    fn tangent_at(&self, _point: usize, strains: &Strains<T>) -> Tangent<T> {
        self.0.tangent_of(strains)
    }

    #[inline(always)]
    fn energy_at(&self, _point: usize, e: &Symmetric<T>) -> T {
        self.0.energy(e)
    }

    #[inline(always)]
    fn across_at(&self, _point: usize, e: &Symmetric<T>) -> Across<T> {
        self.0.across(e)
    }

    fn convex_in(&self) -> StrainMeasure {
        self.0.convex_in()
    }
}

/// Several elements whose stresses are evaluated one after the other.
pub struct OneByOne<S>(pub [S; LANES]);

impl<T: Number, const HOOP: bool, S: StressAtPoints> StressAtPoints<T, HOOP> for OneByOne<S> {
    fn stress_at(&self, point: usize, strains: &Strains<T>) -> Symmetric<T> {
        Symmetric::of_lanes(|lane| self.0[lane].stress_at(point, &strains.lane(lane)))
    }

    fn tangent_at(&self, point: usize, strains: &Strains<T>) -> Tangent<T> {
        Tangent::of_lanes(|lane| self.0[lane].tangent_at(point, &strains.lane(lane)))
    }

    fn stress_where(
        &self,
        wanted: [bool; LANES],
        point: usize,
        strains: &Strains<T>,
    ) -> Symmetric<T> {
        Symmetric::of_lanes(|lane| match wanted[lane] {
            true => self.0[lane].stress_at(point, &strains.lane(lane)),
            false => Symmetric::zeros(),
        })
    }

    fn tangent_where(
        &self,
        wanted: [bool; LANES],
        point: usize,
        strains: &Strains<T>,
    ) -> Tangent<T> {
        Tangent::of_lanes(|lane| match wanted[lane] {
            true => self.0[lane].tangent_at(point, &strains.lane(lane)),
            false => Tangent::default(),
        })
    }

    fn energy_at(&self, point: usize, e: &Symmetric<T>) -> T {
        T::of_lanes(|lane| self.0[lane].energy_at(point, &e.lane(lane)))
    }

    fn across_at(&self, point: usize, e: &Symmetric<T>) -> Across<T> {
        let all: [Across; LANES] = from_fn(|lane| match lane < T::ELEMENTS {
            true => self.0[lane].across_at(point, &e.lane(lane)),
            false => Across::default(),
        });
        Across {
            stretch: T::of_lanes(|lane| all[lane].stretch),
            stress: T::of_lanes(|lane| all[lane].stress),
        }
    }

    fn convex_in(&self) -> StrainMeasure {
        self.0[0].convex_in()
    }

    fn metal(&self, lane: usize) -> Option<Metal<'_>> {
        self.0[lane].metal(0)
    }

    fn plastic_strain_at(&self, lane: usize, point: usize) -> f64 {
        self.0[lane].plastic_strain_at(0, point)
    }

    fn update_at(&self, lane: usize, point: usize, strains: &Strains, z1: &mut [f64]) -> f64 {
        self.0[lane].update_at(0, point, strains, z1)
    }
}
