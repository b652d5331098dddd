//! The material of an element with strains of its own, at these: stresses and derivatives by the strains of the displacements
//! and those of the element. Section 2 of docs/theory.md, Enhanced strains.

use nalgebra::{Matrix3, Matrix4, Vector4};

use super::points::{OfPoints, RingPoint, as_strain};
use crate::elements::stretch::{AddedStrain, Tensor, Variation};
use crate::materials::Symmetric;

/// Where the material of an element has its stresses and its tangents.
#[derive(Debug, Clone)]
pub(super) struct AtStrains {
    /// Strains of the element at all points.
    pub enhanced: OfPoints<AddedStrain<3>>,
    /// Stresses of the material there (force/length^2).
    pub stresses: OfPoints<Symmetric>,
}

/// Components as a tensor.
pub(super) fn tensor(s: &Symmetric) -> Tensor<3> {
    Matrix3::new(s.x, s.w, 0.0, s.w, s.y, 0.0, 0.0, 0.0, s.z)
}

/// The components of a tensor without 13 and 23.
pub(super) fn components(t: &Tensor<3>) -> Symmetric {
    Symmetric::new(t.m11, t.m22, t.m33, t.m12)
}

/// Mean over the volume of the points.
pub(super) fn mean_of(points: &[RingPoint], values: &[Symmetric]) -> Symmetric {
    let volume: f64 = points.iter().map(|p| p.volume).sum();
    let all = points.iter().zip(values);
    all.map(|(point, value)| value * point.volume)
        .sum::<Symmetric>()
        / volume
}

impl AtStrains {
    /// Stresses that do work on the strains of the displacements, T less the mean of R.
    pub fn of_displacements(&self, points: &[RingPoint]) -> OfPoints<Symmetric> {
        let conjugate = self.enhanced.iter().zip(&self.stresses).map(|(e, s)| {
            let both = e.conjugate(&tensor(s));
            both.map(|stress| components(&stress))
        });
        let conjugate: OfPoints<[Symmetric; 2]> = conjugate.collect();
        let on_mean: OfPoints<Symmetric> = conjugate.iter().map(|[_, r]| *r).collect();
        let mean = mean_of(points, &on_mean);
        conjugate.iter().map(|[t, _]| *t - mean).collect()
    }

    /// dE_g (11, 22, 33, 2*12) and B of S : d²E_g at a point, from the change of E + M alpha and that of the mean.
    pub fn column(&self, p: usize, at_point: &Symmetric, of_mean: &Symmetric) -> Column {
        let [at_point, of_mean] = [at_point, of_mean].map(tensor);
        let variation = Variation { at_point, of_mean };
        let [first, second] = self.enhanced[p].variation(&variation);
        (as_strain(&components(&first)), second)
    }

    /// dE_g C dE_g + S : d²E_g of a change at a point beside another.
    pub fn product(&self, p: usize, c: &Matrix4<f64>, left: &Column, right: &Column) -> f64 {
        let s = tensor(&self.stresses[p]);
        let second = self.enhanced[p].second_stress(&right.1, &s);
        left.0.dot(&(c * right.0)) + left.1.dot(&second)
    }
}

/// Change of the strain of the material at a point, and B of its second derivative.
pub(super) type Column = (Vector4<f64>, Tensor<3>);
