//! Stress recovery: Cauchy stress and Green-Lagrange strain averaged over each element, and the
//! von Mises stress of these averages. Section 2 of docs/theory.md.

use nalgebra::{Matrix2, SMatrix};

use super::body::gather;
use super::kinematics::{displacement_gradient, green_lagrange};
use super::reference::Reference;
use super::voigt::{Elasticity, elasticity, stress};
use crate::elements::{quad4, tri3};
use crate::model::{Cell, Element, Model, Plane};

/// Stress and strain of one element, averaged over its volume.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElementMeans {
    /// Cauchy stress xx, yy, xy (force/length^2).
    pub stress: [f64; 3],
    /// Cauchy stress zz across the thickness (force/length^2).
    pub across: f64,
    /// Green-Lagrange strain xx, yy, xy (tensor shear).
    pub strain: [f64; 3],
}

impl ElementMeans {
    /// Von Mises stress of the mean stresses, zz included (force/length^2):
    ///
    /// ```text
    /// sqrt(((sxx - syy)^2 + (syy - szz)^2 + (szz - sxx)^2)/2 + 3 sxy^2)
    /// ```
    pub fn von_mises(&self) -> f64 {
        let [xx, yy, xy] = self.stress;
        let [a, b, c] = [xx - yy, yy - self.across, self.across - xx];
        ((a * a + b * b + c * c) / 2.0 + 3.0 * xy * xy).sqrt()
    }
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
            across: match element.plane {
                Plane::Stress => 0.0,
                Plane::Strain => material.poisson,
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

/// Elasticity, and what happens across the thickness: E_zz = -contraction (E_xx + E_yy) and
/// S_zz = across (S_xx + S_yy).
///
/// In plane strain S_zz = lambda (E_xx + E_yy) and S_xx + S_yy = 2 (lambda + mu) (E_xx + E_yy), so that
/// the factor is nu = lambda/(2 (lambda + mu)).
struct Law {
    c: Elasticity,
    contraction: f64,
    across: f64,
}

/// Volume means of sigma = F S F^T/J, eq. (2.8), and E, with J = det F sqrt(1 + 2 E_zz). Across the thickness
/// F_zz² is 1 in plane strain, so that sigma_zz = S_zz / J; in plane stress S_zz is 0.
fn means<const N: usize, const P: usize>(
    element: &Reference<N, P>,
    law: &Law,
    u: &SMatrix<f64, 2, N>,
) -> ElementMeans {
    let (mut sigma, mut strain) = (Matrix2::zeros(), Matrix2::zeros());
    let mut across = 0.0;
    for point in &element.points {
        let h = displacement_gradient(point, u);
        let (f, e) = (Matrix2::identity() + h, green_lagrange(&h));
        let stretch = (1.0 - 2.0 * law.contraction * e.trace()).sqrt();
        let j = f.determinant() * stretch;
        let s = stress(&law.c, &e);
        sigma += f * s * f.transpose() / j * point.volume;
        across += law.across * s.trace() / j * point.volume;
        strain += e * point.volume;
    }
    let volume = element.volume();
    let voigt = |m: Matrix2<f64>| [m.m11 / volume, m.m22 / volume, m.m12 / volume];
    ElementMeans {
        stress: voigt(sigma),
        across: across / volume,
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
    fn stress_across_the_thickness_by_hand() {
        // Plane strain, stretch 1.2 along x: E_xx = 0.22; E = 100, nu = 1/4: lambda = mu = 40,
        // S = (26.4, 8.8), S_zz = 8.8, J = 1.2: sigma = (26.4 1.2, 8.8/1.2, 8.8/1.2).
        let u = [0.0, 0.0, 0.2, 0.0, 0.2, 0.0, 0.0, 0.0];
        let means = element_means(&square(Plane::Strain), &u)[0];
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert!(near(means.stress[0], 31.68) && near(means.stress[1], 8.8 / 1.2));
        assert!(near(means.across, 8.8 / 1.2));
        // the other two are alike: von Mises is their difference to the first
        assert!(near(means.von_mises(), 31.68 - 8.8 / 1.2));
        let means = element_means(&square(Plane::Stress), &u)[0];
        assert_eq!(means.across, 0.0);
        let [xx, yy, _] = means.stress;
        assert!(near(
            means.von_mises(),
            (xx * xx - xx * yy + yy * yy).sqrt()
        ));
    }

    #[test]
    fn von_mises_of_shear_and_of_pressure() {
        let means = |stress, across| ElementMeans {
            stress,
            across,
            strain: [0.0; 3],
        };
        assert!((means([0.0, 0.0, 2.0], 0.0).von_mises() - 12.0_f64.sqrt()).abs() < 1e-15);
        assert_eq!(means([-3.0, -3.0, 0.0], -3.0).von_mises(), 0.0);
        assert_eq!(means([-3.0, -3.0, 0.0], 0.0).von_mises(), 3.0);
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
