//! Elastic constants, density, thickness, and plane stress or plane strain (docs/theory.md,
//! sections 1 and 2).

/// St. Venant-Kirchhoff material: second Piola-Kirchhoff stress linear in the Green-Lagrange strain.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Name in the deck.
    pub name: String,
    /// Young's modulus E (force/length^2).
    pub young: f64,
    /// Poisson's ratio nu.
    pub poisson: f64,
    /// Density rho of the reference configuration (mass/length^3).
    pub density: f64,
}

impl Material {
    /// Speed of longitudinal waves (length/time): sqrt(E/((1 - nu^2) rho)) in plane stress,
    /// sqrt(E (1 - nu)/((1 + nu) (1 - 2 nu) rho)) in plane strain.
    pub fn wave_speed(&self, plane: Plane) -> f64 {
        let nu = self.poisson;
        let factor = match plane {
            Plane::Stress => 1.0 / (1.0 - nu * nu),
            Plane::Strain => (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)),
        };
        (self.young * factor / self.density).sqrt()
    }
}

/// Kinematic assumption across the thickness.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Plane {
    /// No stress across the thickness (CPS elements).
    Stress,
    /// No strain across the thickness (CPE elements).
    Strain,
}

/// Material and thickness of a group of elements.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Index into `Model::materials`.
    pub material: usize,
    /// Thickness t (length).
    pub thickness: f64,
}
