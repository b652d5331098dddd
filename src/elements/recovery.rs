use nalgebra::{Matrix2, SMatrix};

use super::body::gather;
use super::kinematics::{displacement_gradient, green_lagrange};
use super::voigt::stress;
use super::{Elasticity, Reference, elasticity, quad4, tri3};
use crate::model::{Cell, Model};

/// Stress and strain of one element, averaged over its volume.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElementMeans {
    /// Cauchy stress xx, yy, xy (force/length^2).
    pub stress: [f64; 3],
    /// Green-Lagrange strain xx, yy, xy (tensor shear).
    pub strain: [f64; 3],
}

/// Volume means of stress and strain of every element at displacements `u` (2 N entries).
pub fn element_means(model: &Model, u: &[f64]) -> Vec<ElementMeans> {
    let x = &model.mesh.coordinates;
    let of_element = |element: &crate::model::Element| {
        let section = &model.sections[element.section];
        let c = elasticity(&model.materials[section.material], element.plane);
        match element.cell {
            Cell::Tri3(n) => means(
                &tri3(&SMatrix::from_fn(|i, a| x[n[a]][i]), 1.0),
                &c,
                &gather(&n, u),
            ),
            Cell::Quad4(n) => means(
                &quad4(&SMatrix::from_fn(|i, a| x[n[a]][i]), 1.0),
                &c,
                &gather(&n, u),
            ),
        }
    };
    model.mesh.elements.iter().map(of_element).collect()
}

/// Volume means: sigma = F S F^T / det F (in plane: the thickness stays), E.
fn means<const N: usize, const P: usize>(
    element: &Reference<N, P>,
    c: &Elasticity,
    u: &SMatrix<f64, 2, N>,
) -> ElementMeans {
    let (mut sigma, mut strain) = (Matrix2::zeros(), Matrix2::zeros());
    for point in &element.points {
        let h = displacement_gradient(point, u);
        let (f, e) = (Matrix2::identity() + h, green_lagrange(&h));
        sigma += f * stress(c, &e) * f.transpose() / f.determinant() * point.volume;
        strain += e * point.volume;
    }
    let volume = element.volume();
    let voigt = |m: Matrix2<f64>| [m.m11 / volume, m.m22 / volume, m.m12 / volume];
    ElementMeans {
        stress: voigt(sigma),
        strain: voigt(strain),
    }
}
