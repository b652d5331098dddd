//! Material and thickness of the elements (docs/theory.md, sections 1 and 2).

use crate::materials::{Law, Plane, SmallStrainModuli};

/// A material: its law with the constants of the deck, and its density.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Name in the deck.
    pub name: String,
    /// Law of the stress.
    pub law: Law,
    /// Density rho of the reference configuration (mass/length^3).
    pub density: f64,
    /// Damping.
    pub damping: Damping,
}

/// Damping of a material: none by default.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Damping {
    /// Damping in proportion to the mass (1/time).
    pub alpha: f64,
    /// Damping in proportion to the elasticity at small strains (time).
    pub beta: f64,
}

impl Material {
    /// Speed of longitudinal waves (length/time): sqrt(E/((1 - nu^2) rho)) in plane stress,
    /// sqrt(E (1 - nu)/((1 + nu) (1 - 2 nu) rho)) in plane strain.
    pub fn wave_speed(&self, plane: Plane) -> f64 {
        let SmallStrainModuli { young, poisson: nu } = self.law.small_strain();
        let factor = match plane {
            Plane::Stress => 1.0 / (1.0 - nu * nu),
            Plane::Strain => (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)),
        };
        (young * factor / self.density).sqrt()
    }
}

/// Material and thickness of a group of elements.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Index into `Model::materials`.
    pub material: usize,
    /// Thickness t (length).
    pub thickness: f64,
}
