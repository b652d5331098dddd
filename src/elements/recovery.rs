//! Stress recovery: what the evaluation of an element gives beside its force. Cauchy stress and
//! Green-Lagrange strain averaged over each element, the von Mises stress of these averages, strain
//! energy and largest principal strain. Section 2 of docs/theory.md.

use nalgebra::Matrix2;

use super::integration_point::PointState;
use super::kinematics::{green_lagrange, smaller};
use crate::materials::{Across, Committed};

/// Strain energy of one element, and its stress and strain averaged over the volume.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ElementResult {
    /// Strain energy (force length).
    pub energy: f64,
    /// Cauchy stress xx, yy, xy (force/length^2).
    pub stress: [f64; 3],
    /// Cauchy stress zz across the thickness (force/length^2).
    pub across: f64,
    /// Green-Lagrange strain xx, yy, xy (tensor shear).
    pub strain: [f64; 3],
    /// Largest absolute principal value of the Green-Lagrange strain in the plane at the integration
    /// points; NaN when there is one.
    pub principal_strain: f64,
}

/// The element with the largest principal strain.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Strained {
    /// Element (index).
    pub element: usize,
    /// Largest absolute principal value of its Green-Lagrange strain in the plane.
    pub strain: f64,
}

/// The first element with the largest principal strain.
pub fn most_strained(results: &[ElementResult]) -> Strained {
    let mut most = Strained::default();
    for (element, result) in results.iter().enumerate() {
        let strain = result.principal_strain;
        if strain > most.strain || strain.is_nan() {
            most = Strained { element, strain };
        }
    }
    most
}

/// Strain energy per volume, stress and strain at one integration point.
#[derive(Clone, Copy, Default)]
pub(super) struct PointResult {
    energy: f64,
    sigma: Matrix2<f64>,
    across: f64,
    strain: Matrix2<f64>,
}

impl PointResult {
    /// sigma = F S F^T/J, eq. (2.8), with J = det F F_zz, and sigma_zz = F_zz S_zz F_zz / J.
    pub fn new(state: &PointState, material: &Committed, point: usize) -> Self {
        let (f, e) = (state.f(), state.strains.end());
        let Across { stretch, stress } = material.across(point, e);
        PointResult {
            energy: material.stored_energy(point, e),
            sigma: f * state.s * f.transpose() / (state.determinant * stretch),
            across: stress * stretch / state.material_determinant,
            strain: green_lagrange(&state.h),
        }
    }

    /// Largest absolute principal value of the strain in the plane.
    ///
    /// ```text
    /// E_1,2 = (E_xx + E_yy)/2 +- sqrt((E_xx - E_yy)²/4 + E_xy²)
    /// ```
    fn principal_strain(&self) -> f64 {
        let e = &self.strain;
        let (mean, half) = ((e.m11 + e.m22) / 2.0, (e.m11 - e.m22) / 2.0);
        mean.abs() + half.hypot(e.m12)
    }
}

impl ElementResult {
    /// Energy int W dOmega, eq. (2.4), and volume means of integration points with their weights (length^3).
    pub(super) fn of_points(points: impl Iterator<Item = (PointResult, f64)>) -> Self {
        let (mut sigma, mut strain) = (Matrix2::zeros(), Matrix2::zeros());
        let (mut energy, mut across, mut volume, mut principal) = (0.0, 0.0, 0.0, 0.0);
        for (point, weight) in points {
            energy += point.energy * weight;
            sigma += point.sigma * weight;
            across += point.across * weight;
            strain += point.strain * weight;
            principal = -smaller(-principal, -point.principal_strain());
            volume += weight;
        }
        let voigt = |m: Matrix2<f64>| [m.m11 / volume, m.m22 / volume, m.m12 / volume];
        ElementResult {
            energy,
            stress: voigt(sigma),
            across: across / volume,
            strain: voigt(strain),
            principal_strain: principal,
        }
    }

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::Elements;
    use crate::materials::Law;
    use crate::model::{Damping, Element, ElementType, Material, Mesh, Model, Section};

    /// A unit square of E = 100, nu = 0.25.
    fn square(element_type: ElementType) -> Model {
        let coordinates = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let elements = vec![Element {
            label: 1,
            element_type,
            nodes: vec![0, 1, 2, 3].into(),
            section: 0,
        }];
        let material = Material {
            name: "M".into(),
            law: Law::elastic(100.0, 0.25),
            density: 1.0,
            damping: Damping::default(),
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

    fn evaluate(model: &Model, u: &[f64]) -> Vec<ElementResult> {
        Elements::new(model).evaluate(u, &[])
    }

    #[test]
    fn cauchy_stress_is_the_force_per_current_area() {
        // Stretch 1.2 along x, free laterally in plane stress: E_xx = 0.22, E_yy = E_zz = -0.055,
        // S = 22, sigma = F_x S / (F_y F_z) = 1.2 S / (1 - 0.11).
        let lateral = (1.0_f64 - 0.11).sqrt() - 1.0;
        let u = [0.0, 0.0, 0.2, 0.0, 0.2, lateral, 0.0, lateral];
        let means = evaluate(&square(ElementType::CPS4), &u);
        assert!((means[0].stress[0] - 1.2 * 22.0 / 0.89).abs() < 1e-12);
        assert!(means[0].stress[1].abs() < 1e-13 && means[0].stress[2].abs() < 1e-13);
        assert!((means[0].strain[0] - 0.22).abs() < 1e-15);
    }

    #[test]
    fn stress_across_the_thickness_by_hand() {
        // Plane strain, stretch 1.2 along x: E_xx = 0.22; E = 100, nu = 1/4: lambda = mu = 40,
        // S = (26.4, 8.8), S_zz = 8.8, J = 1.2: sigma = (26.4 1.2, 8.8/1.2, 8.8/1.2).
        let u = [0.0, 0.0, 0.2, 0.0, 0.2, 0.0, 0.0, 0.0];
        let means = evaluate(&square(ElementType::CPE4), &u)[0];
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert!(near(means.stress[0], 31.68) && near(means.stress[1], 8.8 / 1.2));
        assert!(near(means.across, 8.8 / 1.2));
        // the other two are alike: von Mises is their difference to the first
        assert!(near(means.von_mises(), 31.68 - 8.8 / 1.2));
        let means = evaluate(&square(ElementType::CPS4), &u)[0];
        assert_eq!(means.across, 0.0);
        let [xx, yy, _] = means.stress;
        assert!(near(
            means.von_mises(),
            (xx * xx - xx * yy + yy * yy).sqrt()
        ));
    }

    #[test]
    fn von_mises_of_shear_and_of_pressure() {
        let means = |stress, across| ElementResult {
            stress,
            across,
            ..ElementResult::default()
        };
        assert!((means([0.0, 0.0, 2.0], 0.0).von_mises() - 12.0_f64.sqrt()).abs() < 1e-15);
        assert_eq!(means([-3.0, -3.0, 0.0], -3.0).von_mises(), 0.0);
        assert_eq!(means([-3.0, -3.0, 0.0], 0.0).von_mises(), 3.0);
    }

    #[test]
    fn a_rotation_turns_the_stress_of_plane_strain_with_the_body() {
        // Simple dilatation 1 %, then a quarter turn: sigma_xx becomes sigma_yy.
        let model = square(ElementType::CPE4);
        let stretched = [0.0, 0.0, 0.01, 0.0, 0.01, 0.0, 0.0, 0.0];
        let turned = [0.0, 0.0, -1.0, 1.01, -2.0, 0.01, -1.0, -1.0];
        let (a, b) = (
            evaluate(&model, &stretched)[0],
            evaluate(&model, &turned)[0],
        );
        assert!((a.stress[0] - b.stress[1]).abs() < 1e-12 * a.stress[0]);
        assert!((a.stress[1] - b.stress[0]).abs() < 1e-12 * a.stress[0]);
        assert!(
            (a.strain[0] - b.strain[0]).abs() < 1e-14,
            "E does not see the rotation"
        );
    }
}
