use nalgebra::{Matrix2, SMatrix};

use super::body::gather;
use super::kinematics::{displacement_gradient, green_lagrange};
use super::voigt::stress;
use super::{Elasticity, Reference, elasticity, quad4, tri3};
use crate::model::{Cell, Element, Model, Plane};

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
    let of_element = |element: &Element| {
        let material = &model.materials[model.sections[element.section].material];
        let law = Law {
            c: elasticity(material, element.plane),
            contraction: match element.plane {
                Plane::Stress => material.poisson / (1.0 - material.poisson),
                Plane::Strain => 0.0,
            },
        };
        match element.cell {
            Cell::Tri3(n) => means(
                &tri3(&SMatrix::from_fn(|i, a| x[n[a]][i]), 1.0),
                &law,
                &gather(&n, u),
            ),
            Cell::Quad4(n) => means(
                &quad4(&SMatrix::from_fn(|i, a| x[n[a]][i]), 1.0),
                &law,
                &gather(&n, u),
            ),
        }
    };
    model.mesh.elements.iter().map(of_element).collect()
}

/// Elasticity, and the strain across the thickness: E_zz = -contraction (E_xx + E_yy).
struct Law {
    c: Elasticity,
    contraction: f64,
}

/// Volume means of sigma = F S F^T / J and E, with J = det F sqrt(1 + 2 E_zz).
fn means<const N: usize, const P: usize>(
    element: &Reference<N, P>,
    law: &Law,
    u: &SMatrix<f64, 2, N>,
) -> ElementMeans {
    let (mut sigma, mut strain) = (Matrix2::zeros(), Matrix2::zeros());
    for point in &element.points {
        let h = displacement_gradient(point, u);
        let (f, e) = (Matrix2::identity() + h, green_lagrange(&h));
        let stretch = (1.0 - 2.0 * law.contraction * e.trace()).sqrt();
        let j = f.determinant() * stretch;
        sigma += f * stress(&law.c, &e) * f.transpose() / j * point.volume;
        strain += e * point.volume;
    }
    let volume = element.volume();
    let voigt = |m: Matrix2<f64>| [m.m11 / volume, m.m22 / volume, m.m12 / volume];
    ElementMeans {
        stress: voigt(sigma),
        strain: voigt(strain),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Material, Mesh, Section};

    /// A unit square of E = 100, nu = 0.25.
    fn square(plane: Plane) -> Model {
        let coordinates = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let cell = Cell::Quad4([0, 1, 2, 3]);
        let elements = vec![Element {
            label: 1,
            cell,
            plane,
            section: 0,
        }];
        let material = Material {
            name: "M".into(),
            young: 100.0,
            poisson: 0.25,
            density: 1.0,
        };
        Model {
            mesh: Mesh {
                node_labels: vec![1, 2, 3, 4],
                coordinates,
                elements,
            },
            materials: vec![material],
            sections: vec![Section {
                material: 0,
                thickness: 1.0,
            }],
            ..Model::default()
        }
    }

    #[test]
    fn cauchy_stress_is_the_force_per_current_area() {
        // Stretch 1.2 along x, free laterally in plane stress: E_xx = 0.22, E_yy = E_zz = -0.055,
        // S = 22, sigma = F_x S / (F_y F_z) = 1.2 S / (1 - 0.11).
        let lateral = (1.0_f64 - 0.11).sqrt() - 1.0;
        let u = [0.0, 0.0, 0.2, 0.0, 0.2, lateral, 0.0, lateral];
        let means = element_means(&square(Plane::Stress), &u);
        assert!((means[0].stress[0] - 1.2 * 22.0 / 0.89).abs() < 1e-12);
        assert!(means[0].stress[1].abs() < 1e-13 && means[0].stress[2].abs() < 1e-13);
        assert!((means[0].strain[0] - 0.22).abs() < 1e-15);
    }

    #[test]
    fn a_rotation_turns_the_stress_of_plane_strain_with_the_body() {
        // Simple dilatation 1 %, then a quarter turn: sigma_xx becomes sigma_yy.
        let model = square(Plane::Strain);
        let stretched = [0.0, 0.0, 0.01, 0.0, 0.01, 0.0, 0.0, 0.0];
        let turned = [0.0, 0.0, -1.0, 1.01, -2.0, 0.01, -1.0, -1.0];
        let (a, b) = (
            element_means(&model, &stretched)[0],
            element_means(&model, &turned)[0],
        );
        assert!((a.stress[0] - b.stress[1]).abs() < 1e-12 * a.stress[0]);
        assert!((a.stress[1] - b.stress[0]).abs() < 1e-12 * a.stress[0]);
        assert!(
            (a.strain[0] - b.strain[0]).abs() < 1e-14,
            "E does not see the rotation"
        );
    }
}
