//! The plane: what elements assume across the thickness, and the moduli of a law near its reference state. Section 2 of
//! docs/theory.md.

/// Kinematic assumption across the thickness.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Plane {
    /// No stress across the thickness (CPS elements).
    Stress,
    /// No strain across the thickness (CPE elements).
    Strain,
    /// A body of revolution around the axis x = 0, which moves without torsion (CAX elements).
    Revolution,
}

/// Moduli of the linear elastic material that a law is near its reference state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SmallStrainModuli {
    /// Young's modulus E (force/length^2).
    pub young: f64,
    /// Poisson's ratio nu.
    pub poisson: f64,
}
