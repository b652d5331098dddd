//! The materials a deck may name, and their reduction to the plane. One file per material; a new one
//! is a variant here.

use nalgebra::{Matrix2, Matrix3};

#[cfg(test)]
use super::yielding::Yielding;
use super::{
    Across, ConstitutiveLaw, NeoHooke, Plane, PlaneSaintVenantKirchhoff, SaintVenantKirchhoff,
    SmallStrainModuli,
};

/// Law of a material with the constants of the deck.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    /// `*ELASTIC`
    SaintVenantKirchhoff(SaintVenantKirchhoff),
    /// `*HYPERELASTIC, NEO HOOKE`
    NeoHooke(NeoHooke),
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
            #[cfg(test)]
            Law::Yielding(law) => law.small_strain(),
        }
    }

    /// Whether the law is no guide at strains that are not small against 1.
    pub fn is_for_small_strains(&self) -> bool {
        matches!(self, Law::SaintVenantKirchhoff(_))
    }

    /// Whether the law can be used in plane stress.
    pub fn has_plane_stress(&self) -> bool {
        match self {
            Law::SaintVenantKirchhoff(_) => true,
            Law::NeoHooke(_) => false,
            #[cfg(test)]
            Law::Yielding(_) => false,
        }
    }

    /// The law in the plane, which must not be [`Plane::Stress`] without [`Self::has_plane_stress`].
    pub fn in_plane(&self, plane: Plane) -> PlaneLaw {
        debug_assert!(
            plane == Plane::Strain || self.has_plane_stress(),
            "this material is for plane strain only"
        );
        match self {
            Law::SaintVenantKirchhoff(law) => PlaneLaw::SaintVenantKirchhoff(law.in_plane(plane)),
            Law::NeoHooke(law) => PlaneLaw::NeoHooke(*law),
            #[cfg(test)]
            Law::Yielding(law) => PlaneLaw::Yielding(*law),
        }
    }
}

/// Law of a material in the plane of the elements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PlaneLaw {
    /// In plane stress or plane strain.
    SaintVenantKirchhoff(PlaneSaintVenantKirchhoff),
    /// In plane strain.
    NeoHooke(NeoHooke),
    /// A law with internal variables.
    #[cfg(test)]
    Yielding(Yielding),
}

/// The same function of the law that it is.
macro_rules! of_each {
    ($self:ident, $law:ident => $value:expr) => {
        match $self {
            PlaneLaw::SaintVenantKirchhoff($law) => $value,
            PlaneLaw::NeoHooke($law) => $value,
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

    fn stored_energy(&self, e: &Matrix2<f64>, z: &[f64]) -> f64 {
        of_each!(self, law => law.stored_energy(e, z))
    }

    fn energy_change(&self, e0: &Matrix2<f64>, e1: &Matrix2<f64>, z: &[f64]) -> f64 {
        of_each!(self, law => law.energy_change(e0, e1, z))
    }

    #[inline]
    fn stress(&self, e: &Matrix2<f64>, z: &[f64]) -> Matrix2<f64> {
        of_each!(self, law => law.stress(e, z))
    }

    #[inline]
    fn tangent(&self, e: &Matrix2<f64>, z: &[f64]) -> Matrix3<f64> {
        of_each!(self, law => law.tangent(e, z))
    }

    fn across(&self, e: &Matrix2<f64>, z: &[f64]) -> Across {
        of_each!(self, law => law.across(e, z))
    }

    #[inline]
    fn mean_stress(&self, e0: &Matrix2<f64>, e1: &Matrix2<f64>, z: &[f64]) -> Matrix2<f64> {
        of_each!(self, law => law.mean_stress(e0, e1, z))
    }

    #[inline]
    fn mean_tangent(&self, e0: &Matrix2<f64>, e1: &Matrix2<f64>, z: &[f64]) -> Matrix3<f64> {
        of_each!(self, law => law.mean_tangent(e0, e1, z))
    }

    fn update(&self, e: &Matrix2<f64>, z: &[f64], updated: &mut [f64]) -> f64 {
        of_each!(self, law => law.update(e, z, updated))
    }
}
