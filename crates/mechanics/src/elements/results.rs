//! Results of elements: strain energy, Cauchy stress and Green-Lagrange strain as means over an element, the von Mises
//! stress of these means, and the largest principal strain. See docs/theory/elements.md.

use super::block::{
    Gradient, SymmetricLanes, deformation_gradient, determinant, smaller, times_symmetric,
    times_transposed,
};
use crate::materials::number::LANES;
use crate::materials::{Across, AnyLaw, Lanes, Number};

/// Strain energy of one element, and means of its stress and strain over the volume.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct ElementResult {
    /// Strain energy (force length).
    pub energy: f64,
    /// Cauchy stress xx, yy, xy (force/length^2).
    pub stress: [f64; 3],
    /// Cauchy stress zz across the thickness (force/length^2).
    pub across: f64,
    /// Green-Lagrange strain xx, yy, xy (tensor shear).
    pub strain: [f64; 3],
    /// Largest absolute principal value of the Green-Lagrange strain in the plane at the integration points; NaN if one
    /// value is NaN.
    pub principal_strain: f64,
    /// Mean of the accumulated plastic strain over the element.
    pub plastic_strain: f64,
    /// Green-Lagrange strain zz across the thickness, or around the axis of a body of revolution.
    pub strain_across: f64,
    /// Part of the strain energy in hourglass modes (force length).
    pub hourglass_energy: f64,
}

/// The element with the largest principal strain.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct Strained {
    /// Element (index).
    pub element: usize,
    /// Largest absolute principal value of the Green-Lagrange strain of the element in the plane.
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

/// Results of one integration point; the energy is per volume (force/length^2).
pub struct PointResult {
    /// Results.
    pub result: ElementResult,
    /// Displacement gradient H in the section, row by row.
    pub gradient: [[f64; 2]; 2],
}

/// Data from which the results of an integration point are computed.
#[derive(Clone, Copy, Default)]
pub struct ResultPoint {
    /// Displacement gradient.
    pub gradient: Gradient,
    /// Strain of the material.
    pub strain: SymmetricLanes,
    /// Determinant, in the plane, of the material's deformation gradient.
    pub determinant: Lanes,
    /// Stress that is reported for the point. The reported stress does work on the strain of the displacements, or, in
    /// elements with own strains, on the strain of the material (force/length^2).
    pub s: SymmetricLanes,
    /// Weight of the point (length^3).
    pub weight: Lanes,
}

impl ResultPoint {
    /// Data of a point whose material has the strain of the displacements, with its stress (force/length^2) and its
    /// weight (length^3).
    #[inline(always)]
    pub fn new(
        gradient: Gradient,
        strain: SymmetricLanes,
        s: SymmetricLanes,
        weight: Lanes,
    ) -> Self {
        ResultPoint {
            gradient,
            strain,
            determinant: determinant(&gradient.h),
            s,
            weight,
        }
    }
}

/// Sums over the integration points, each times its weight: the energy int W dOmega, eq. (2.4), and the sums for means.
#[derive(Clone, Copy)]
pub struct Sums {
    energy: Lanes,
    /// Stress components 11, 22 and 12.
    stress: [Lanes; 3],
    across: Lanes,
    /// Strain components 11, 22 and 12.
    strain: [Lanes; 3],
    volume: Lanes,
    strain_across: Lanes,
    plastic: Lanes,
    /// Largest absolute principal strain so far.
    principal: [f64; LANES],
}

impl Sums {
    /// No points.
    #[inline(always)]
    pub fn new() -> Self {
        Sums {
            energy: Lanes::ZERO,
            stress: [Lanes::ZERO; 3],
            across: Lanes::ZERO,
            strain: [Lanes::ZERO; 3],
            volume: Lanes::ZERO,
            strain_across: Lanes::ZERO,
            plastic: Lanes::ZERO,
            principal: [0.0; LANES],
        }
    }

    /// Adds a point: sigma = F S F^T/J, eq. (2.8), with J = det F F_zz, sigma_zz = F_zz S_zz F_zz/J and E_zz = (F_zz² -
    /// 1)/2. In a body of revolution F_zz is the stretch 1 + h of the displacements; in the plane F_zz and S_zz come
    /// from the material.
    #[inline(always)]
    pub fn add<const HOOP: bool>(
        &mut self,
        p: usize,
        law: &AnyLaw<HOOP>,
        point: &ResultPoint,
        weight: Lanes,
    ) {
        let h = &point.gradient.h;
        let (f, e) = (deformation_gradient(h), point.gradient.strain::<HOOP>());
        let (stretch, across, strain_across) = match HOOP {
            true => {
                let stretch = point.gradient.stretch_around();
                (stretch, point.s.z * stretch / determinant(h), e.z)
            }
            false => {
                let Across { stretch, stress } = law.across_at(p, &point.strain);
                let strain = (stretch * stretch - 1.0) * 0.5;
                (stretch, stress * stretch / point.determinant, strain)
            }
        };
        let sigma = times_transposed(&times_symmetric(&f, &point.s), &f);
        let over_j = weight / (determinant(h) * stretch);
        self.energy += law.energy_at(p, &point.strain) * weight;
        self.stress[0] += sigma[0][0] * over_j;
        self.stress[1] += sigma[1][1] * over_j;
        self.stress[2] += sigma[0][1] * over_j;
        self.across += across * weight;
        for (sum, e) in self.strain.iter_mut().zip([e.x, e.y, e.w]) {
            *sum += e * weight;
        }
        self.strain_across += strain_across * weight;
        self.plastic += Lanes::of_lanes(|lane| law.plastic_strain_at(lane, p)) * weight;
        self.volume += weight;
        self.take_principal(&e);
    }

    /// Enters the largest absolute principal strain of a point.
    ///
    /// ```text
    /// E_1,2 = (E_xx + E_yy)/2 +- sqrt((E_xx - E_yy)²/4 + E_xy²)
    /// ```
    #[inline(always)]
    fn take_principal(&mut self, e: &SymmetricLanes) {
        let (mean, half) = ((e.x + e.y) * 0.5, (e.x - e.y) * 0.5);
        let shear = (half * half + e.w * e.w).sqrt();
        for (lane, most) in self.principal.iter_mut().enumerate() {
            let strain = mean.0[lane].abs() + shear.0[lane];
            *most = -smaller(-*most, -strain);
            *most = -smaller(-*most, -e.z.0[lane].abs());
        }
    }

    /// The mean results of one element.
    #[inline(always)]
    pub fn result(&self, lane: usize) -> ElementResult {
        let volume = self.volume.0[lane];
        let means = |sums: &[Lanes; 3]| {
            [
                sums[0].0[lane] / volume,
                sums[1].0[lane] / volume,
                sums[2].0[lane] / volume,
            ]
        };
        ElementResult {
            energy: self.energy.0[lane],
            stress: means(&self.stress),
            across: self.across.0[lane] / volume,
            strain: means(&self.strain),
            principal_strain: self.principal[lane],
            plastic_strain: self.plastic.0[lane] / volume,
            strain_across: self.strain_across.0[lane] / volume,
            hourglass_energy: 0.0,
        }
    }
}

impl ElementResult {
    /// Sum of results times factors, for means and for values between points.
    pub fn weighted<'a>(terms: impl Iterator<Item = (f64, &'a ElementResult)>) -> Self {
        let mut sum = ElementResult::default();
        for (factor, term) in terms {
            sum.energy += factor * term.energy;
            sum.across += factor * term.across;
            sum.principal_strain += factor * term.principal_strain;
            sum.plastic_strain += factor * term.plastic_strain;
            sum.strain_across += factor * term.strain_across;
            sum.hourglass_energy += factor * term.hourglass_energy;
            for i in 0..3 {
                sum.stress[i] += factor * term.stress[i];
                sum.strain[i] += factor * term.strain[i];
            }
        }
        sum
    }

    /// Pressure of the mean stresses, -(sxx + syy + szz)/3 (force/length^2).
    pub fn pressure(&self) -> f64 {
        let [xx, yy, _] = self.stress;
        -(xx + yy + self.across) / 3.0
    }

    /// Principal values of the mean stresses, the smallest first (force/length^2): szz, and
    ///
    /// ```text
    /// (sxx + syy)/2 -+ sqrt((sxx - syy)²/4 + sxy²)
    /// ```
    pub fn principal_stresses(&self) -> [f64; 3] {
        let [xx, yy, xy] = self.stress;
        let (mean, half) = ((xx + yy) / 2.0, ((xx - yy) / 2.0).hypot(xy));
        let mut values = [mean - half, mean + half, self.across];
        values.sort_by(f64::total_cmp);
        values
    }

    /// Von Mises stress of the mean stresses, including zz (force/length^2):
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
    use crate::elements::{Elements, Motion};
    use crate::materials::Law;
    use crate::model::{Damping, Element, ElementType, Material, Mesh, Model, Section};

    /// Model of a unit square with E = 100 and nu = 0.25.
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
            expansion: None,
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
        Elements::new(model).evaluate(Motion::at(u, &[])).to_vec()
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
        // the other two principal stresses are equal, so the von Mises stress is their difference
        // from the first
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
    fn principal_stresses_and_pressure_by_hand() {
        let means = |stress, across| ElementResult {
            stress,
            across,
            ..ElementResult::default()
        };
        // (5 + 1)/2 -+ 5/2 sqrt(...) with half difference 2 and shear 1.5: 3 -+ 2.5
        let result = means([5.0, 1.0, 1.5], 2.0);
        assert_eq!(result.principal_stresses(), [0.5, 2.0, 5.5]);
        assert!((result.pressure() + 8.0 / 3.0).abs() < 1e-15);
        let shear = means([0.0, 0.0, -4.0], -7.0);
        assert_eq!(shear.principal_stresses(), [-7.0, -4.0, 4.0]);
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
