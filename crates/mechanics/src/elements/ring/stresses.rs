//! Strains and stresses of all points of an element, and sums over its points. Section 2 of docs/theory.md, Bodies of
//! revolution.

use nalgebra::{Matrix4, Vector4};

use super::at_strains::AtStrains;
use super::points::{OfPoints, RingPoint};
use crate::elements::solid::MAX_DOFS;
use crate::materials::{Strains, StressAtPoints, Symmetric, contract};

/// Strains of the displacements of all points at the start and at the end of a motion, twice the same at one
/// configuration.
pub(super) struct Compatible {
    pub start: OfPoints<Symmetric>,
    pub end: OfPoints<Symmetric>,
    pub is_increment: bool,
}

impl Compatible {
    /// E_m = (E0 + E1)/2
    pub fn halfway(&self) -> OfPoints<Symmetric> {
        let ends = self.start.iter().zip(&self.end);
        ends.map(|(e0, e1)| (e0 + e1) / 2.0).collect()
    }

    /// dE = E1 - E0
    pub fn changes(&self) -> OfPoints<Symmetric> {
        let ends = self.start.iter().zip(&self.end);
        ends.map(|(e0, e1)| e1 - e0).collect()
    }

    /// Strains of a material from one list to another, those of the start and of the end.
    pub fn strains<'a>(
        &self,
        start: impl Iterator<Item = &'a Symmetric>,
        end: impl Iterator<Item = &'a Symmetric>,
    ) -> OfPoints<Strains> {
        let of_point = |(e0, e1): (&Symmetric, &Symmetric)| match self.is_increment {
            true => Strains::between(e0, e1),
            false => Strains::At(*e1),
        };
        start.zip(end).map(of_point).collect()
    }

    /// S_g = S_g + f/(sum v dE:dE) dE_g, f = work - sum v S:dE, eq. (2.29): stresses that do a work in an increment.
    pub fn do_work(&self, work: f64, points: &[RingPoint], s: &mut [Symmetric]) {
        let changes = self.changes();
        let (mut f, mut squares, mut volume) = (work, 0.0, 0.0);
        for ((point, change), s) in points.iter().zip(&changes).zip(s.iter()) {
            f -= contract(s, change) * point.volume;
            squares += contract(change, change) * point.volume;
            volume += point.volume;
        }
        if (squares / volume).sqrt() > f64::EPSILON {
            for (s, change) in s.iter_mut().zip(&changes) {
                *s += change * (f / squares);
            }
        }
    }
}

/// Stresses of all points of an element in a motion.
pub(super) struct Stresses {
    /// Strains of the material.
    pub strains: OfPoints<Strains>,
    /// Strains at which the material has its tangent.
    pub tangent_at: OfPoints<Strains>,
    /// Second Piola-Kirchhoff stress that does work on the strains of the displacements (force/length^2).
    pub s: OfPoints<Symmetric>,
    /// The material of an element with strains of its own at those of the tangent.
    pub of_material: Option<AtStrains>,
    /// Smallest determinant met; NaN where there is no stress.
    pub determinant: f64,
}

impl Stresses {
    /// Those of the law at the strains of the displacements, or that of the one point of a metal with hourglass modes.
    pub fn of_displacements(
        material: &impl StressAtPoints,
        compatible: &Compatible,
        of_metal: Option<Symmetric>,
    ) -> Self {
        let strains = compatible.strains(compatible.start.iter(), compatible.end.iter());
        let stress = |(p, e)| of_metal.unwrap_or_else(|| material.stress_at(p, e));
        Stresses {
            s: strains.iter().enumerate().map(stress).collect(),
            tangent_at: strains.clone(),
            strains,
            of_material: None,
            determinant: f64::INFINITY,
        }
    }
}

/// sum v (W(E1) - W(E0)), with a round-off that is relative to the changes of the strains. They are given beside the
/// strains, whose difference has the round-off of the strains.
pub(super) fn energy_change(
    points: &[RingPoint],
    material: &impl StressAtPoints,
    strains: impl Iterator<Item = Strains>,
    changes: &[Symmetric],
) -> f64 {
    let all = points.iter().zip(changes).zip(strains).enumerate();
    let terms = all.map(|(p, ((point, change), strains))| {
        contract(&material.stress_at(p, &strains), change) * point.volume
    });
    terms.sum()
}

/// Rows of dE (11, 22, 33, 2*12) by the displacements of an element, one vector for each.
pub(super) type StrainRows = [Vector4<f64>; MAX_DOFS];

/// Number of rows of a square matrix of an element.
pub(super) fn size(k: &[f64]) -> usize {
    k.len().isqrt()
}

/// Adds B^T C B.
pub(super) fn add_products(rows: &StrainRows, c: &Matrix4<f64>, k: &mut [f64]) {
    let d = size(k);
    for col in 0..d {
        let stress = c * rows[col];
        for row in 0..d {
            k[col * d + row] += rows[row].dot(&stress);
        }
    }
}
