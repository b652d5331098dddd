//! A law at the integration points of one element, with the internal variables that the last accepted
//! increment has committed. Section 2 of docs/theory.md.

use nalgebra::{Matrix2, Matrix3};

use super::{Across, ConstitutiveLaw, PlaneLaw};

/// A law with the committed internal variables of the integration points of an element, point after
/// point.
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

    /// Internal variables of a point.
    fn at(&self, point: usize) -> &[f64] {
        let count = self.law.variables();
        &self.variables[point * count..(point + 1) * count]
    }

    /// Stored energy W(E, z) of a point per volume (force/length^2).
    pub fn stored_energy(&self, point: usize, e: &Matrix2<f64>) -> f64 {
        self.law.stored_energy(e, self.at(point))
    }

    /// Second Piola-Kirchhoff stress at a point (force/length^2).
    pub fn stress(&self, point: usize, e: &Matrix2<f64>) -> Matrix2<f64> {
        self.law.stress(e, self.at(point))
    }

    /// Energy-momentum stress at a point (force/length^2).
    pub fn mean_stress(&self, point: usize, [e0, e1]: [&Matrix2<f64>; 2]) -> Matrix2<f64> {
        self.law.mean_stress(e0, e1, self.at(point))
    }

    /// Tangent at a point in Voigt order (force/length^2).
    pub fn tangent(&self, point: usize, e: &Matrix2<f64>) -> Matrix3<f64> {
        self.law.tangent(e, self.at(point))
    }

    /// Tangent of the energy-momentum stress at a point in Voigt order (force/length^2).
    pub fn mean_tangent(&self, point: usize, [e0, e1]: [&Matrix2<f64>; 2]) -> Matrix3<f64> {
        self.law.mean_tangent(e0, e1, self.at(point))
    }

    /// Stretch and stress across the thickness at a point.
    pub fn across(&self, point: usize, e: &Matrix2<f64>) -> Across {
        self.law.across(e, self.at(point))
    }

    /// Internal variables of a point at the strain of the end of an increment, written to `updated`, and
    /// the energy dissipated on the way to them per volume (force/length^2).
    pub fn update(&self, point: usize, e: &Matrix2<f64>, updated: &mut [f64]) -> f64 {
        let count = self.law.variables();
        let updated = &mut updated[point * count..(point + 1) * count];
        self.law.update(e, self.at(point), updated)
    }
}
