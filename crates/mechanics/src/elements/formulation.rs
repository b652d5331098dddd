//! What the formulations of an element have in common: finite-strain kinematics at one configuration or between two
//! (energy-momentum form), integration points with their precomputed gradients and weights (total-Lagrangian form),
//! internal force, strain-displacement matrix, geometric stiffness, and what an evaluation gives beside the force:
//! strain energy, Cauchy stress and Green-Lagrange strain averaged over the element, the von Mises stress of these
//! averages, largest principal strain. Sections 2 and 4 of docs/theory.md (paper eq. 12).

use nalgebra::{Matrix2, Matrix3, SMatrix, SVector, Vector3};
use smallvec::SmallVec;

use crate::materials::{Across, Committed, Strains, StressAtPoints, Symmetric, Tangent};

/// How strains and stresses at the integration points follow from the displacements of an element.
/// Chosen at compile time: a sweep has no dispatch within an element.
pub trait ElementFormulation {
    /// Visits every integration point p with its deformation and stress: the one evaluation of the
    /// material, from which force, tangent and output follow.
    fn for_each_state<const N: usize, const P: usize>(
        element: &Reference<N, P>,
        material: &impl StressAtPoints,
        configuration: &Configuration<N>,
        visit: impl FnMut(usize, &PointState),
    );

    /// Internal force F = int B_L^T S dOmega, eq. (2.5) (paper eq. 12), 2 x N (force), with the smallest
    /// determinant of the deformation gradient at the points.
    #[inline]
    fn internal_force<const N: usize, const P: usize>(
        element: &Reference<N, P>,
        material: &impl StressAtPoints,
        configuration: &Configuration<N>,
    ) -> (SMatrix<f64, 2, N>, f64) {
        let mut force = SMatrix::<f64, 2, N>::zeros();
        let mut determinant = f64::INFINITY;
        Self::for_each_state(element, material, configuration, |p, state| {
            let point = &element.points[p];
            // B_L^T S of node a is F S dh_a/dX: the first Piola-Kirchhoff stress times the gradient.
            force += state.f() * state.s * point.gradient.transpose() * point.volume;
            determinant = smaller(determinant, state.determinant);
        });
        (force, determinant)
    }

    /// Internal variables of all points at the end of a configuration, written to `updated`, and the energy dissipated
    /// on the way to them, int D dOmega (force length).
    fn update<const N: usize, const P: usize>(
        element: &Reference<N, P>,
        material: &Committed,
        configuration: &Configuration<N>,
        updated: &mut [f64],
    ) -> f64 {
        let mut dissipated = 0.0;
        Self::for_each_state(element, material, configuration, |p, state| {
            let volume = element.points[p].volume;
            dissipated += material.update(p, &state.strains, updated) * volume;
        });
        dissipated
    }

    /// Stored energy of the hourglass modes of a configuration, or the work of their viscous stress between two (force
    /// length).
    fn hourglass_energy<const N: usize, const P: usize>(
        _element: &Reference<N, P>,
        _material: &impl StressAtPoints,
        _configuration: &Configuration<N>,
    ) -> f64 {
        0.0
    }

    /// Tangent K = dF/du, D x D (force/length); symmetric.
    fn tangent<const N: usize, const P: usize, const D: usize>(
        element: &Reference<N, P>,
        material: &impl StressAtPoints,
        configuration: &Configuration<N>,
    ) -> SMatrix<f64, D, D>;
}

/// Work of the stress on the strains between two configurations, int S:(E1 - E0) dOmega (force length).
pub fn work<F: ElementFormulation, const N: usize, const P: usize>(
    element: &Reference<N, P>,
    material: &impl StressAtPoints,
    configuration: &Configuration<N>,
) -> f64 {
    let mut work = F::hourglass_energy(element, material, configuration);
    F::for_each_state(element, material, configuration, |p, state| {
        if let Strains::Between(change) = state.strains {
            let s = material.stress_at(p, &state.strains);
            work += s.contract::<false>(&change.change()) * element.points[p].volume;
        }
    });
    work
}

/// Results of the points of an element at displacements `u`, with their weights.
pub(super) fn at_points<F: ElementFormulation, const N: usize, const P: usize>(
    element: &Reference<N, P>,
    material: &Committed,
    u: &SMatrix<f64, 2, N>,
) -> PointResults {
    let weights = element.points.iter().map(|point| point.volume);
    let mut results: PointResults = weights.map(|v| (PointResult::default(), v)).collect();
    F::for_each_state(element, material, &Configuration::At(*u), |p, state| {
        results[p].0 = PointResult::new(state, material, p);
    });
    results
}

/// Strain energy, stress and strain of an element at displacements `u`.
pub fn evaluate<F: ElementFormulation, const N: usize, const P: usize>(
    element: &Reference<N, P>,
    material: &Committed,
    u: &SMatrix<f64, 2, N>,
) -> ElementResult {
    let points = at_points::<F, N, P>(element, material, u);
    let mut result = ElementResult::of_points(points.into_iter());
    result.hourglass_energy = F::hourglass_energy(element, material, &Configuration::At(*u));
    result.energy += result.hourglass_energy;
    result
}

/// B_L: delta E (xx, yy, 2 xy) per nodal displacement (1/length).
pub(super) fn strain_displacement<const N: usize, const D: usize>(
    point: &IntegrationPoint<N>,
    f: &nalgebra::Matrix2<f64>,
) -> SMatrix<f64, 3, D> {
    SMatrix::<f64, 3, D>::from_columns(&std::array::from_fn::<_, D, _>(|j| {
        let (a, i) = (j / 2, j % 2);
        let (gx, gy) = (point.gradient[(a, 0)], point.gradient[(a, 1)]);
        Vector3::new(
            f[(i, 0)] * gx,
            f[(i, 1)] * gy,
            f[(i, 0)] * gy + f[(i, 1)] * gx,
        )
    }))
}

/// Adds int B_NL^T S B_NL dOmega of a point: dh_a/dX . S dh_b/dX in both directions.
pub(super) fn add_geometric<const N: usize, const D: usize>(
    k: &mut SMatrix<f64, D, D>,
    point: &IntegrationPoint<N>,
    s: &nalgebra::Matrix2<f64>,
) {
    let geometric = point.gradient * s * point.gradient.transpose() * point.volume;
    for a in 0..N {
        for b in 0..N {
            k[(2 * a, 2 * b)] += geometric[(a, b)];
            k[(2 * a + 1, 2 * b + 1)] += geometric[(a, b)];
        }
    }
}

/// One integration point in the reference configuration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IntegrationPoint<const N: usize> {
    /// Shape functions h_a.
    pub shape: SVector<f64, N>,
    /// Gradients dh_a/dX_i, row a (1/length).
    pub gradient: SMatrix<f64, N, 2>,
    /// Weight: t det(dX/dr) times the quadrature weight (length^3).
    pub volume: f64,
}

/// The map to one integration point from its natural coordinates r: all that differs between two
/// elements of a shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jacobian {
    /// (dX/dr)^-1 (1/length).
    pub inverse: Matrix2<f64>,
    /// Weight: t det(dX/dr) times the quadrature weight (length^3).
    pub volume: f64,
}

/// Shape functions of N nodes at P integration points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShapeFunctions<const N: usize, const P: usize> {
    /// Shape functions h_a at every point.
    pub values: [[f64; N]; P],
    /// Natural derivatives dh_a/dr_i at every point.
    pub natural: [[[f64; 2]; N]; P],
    /// Quadrature weights of the points.
    pub weights: [f64; P],
}

impl<const N: usize, const P: usize> ShapeFunctions<N, P> {
    /// dX/dr at every point of an element between nodes at `x` (column a for node a), of thickness `t`.
    pub fn jacobians(&self, x: &SMatrix<f64, 2, N>, t: f64) -> [Jacobian; P] {
        std::array::from_fn(|p| {
            let (inverse, det) = inverse_jacobian(x, &self.natural[p]);
            Jacobian {
                inverse,
                volume: t * self.weights[p] * det,
            }
        })
    }

    /// The integration points with these jacobians, dh/dX = dh/dr (dX/dr)^-1.
    pub fn points(&self, jacobians: &[Jacobian; P]) -> [IntegrationPoint<N>; P] {
        let point = |p: usize| IntegrationPoint {
            shape: SVector::from(self.values[p]),
            gradient: gradients(&self.natural[p], &jacobians[p].inverse),
            volume: jacobians[p].volume,
        };
        std::array::from_fn(point)
    }
}

/// (dX/dr)^-1 and det(dX/dr) at a place with the natural derivatives dh_a/dr_i.
fn inverse_jacobian<const N: usize>(
    x: &SMatrix<f64, 2, N>,
    natural: &[[f64; 2]; N],
) -> (Matrix2<f64>, f64) {
    let j: Matrix2<f64> = x * SMatrix::<f64, N, 2>::from_fn(|a, i| natural[a][i]);
    let det = j.determinant();
    (Matrix2::new(j.m22, -j.m12, -j.m21, j.m11) / det, det)
}

/// Gradients dh_a/dX = dh_a/dr (dX/dr)^-1, row a.
fn gradients<const N: usize>(
    natural: &[[f64; 2]; N],
    inverse: &Matrix2<f64>,
) -> SMatrix<f64, N, 2> {
    SMatrix::<f64, N, 2>::from_fn(|a, i| natural[a][i]) * inverse
}

/// An element with N nodes and P integration points in the reference configuration.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference<const N: usize, const P: usize> {
    /// Integration points of stress and internal force.
    pub points: [IntegrationPoint<N>; P],
}

impl<const N: usize, const P: usize> Reference<N, P> {
    /// Volume of the element (length^3).
    pub fn volume(&self) -> f64 {
        self.points.iter().map(|p| p.volume).sum()
    }
}

/// Deformation and stress at an integration point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointState {
    /// Displacement gradient H = F - I of the strain-displacement matrix.
    pub h: Matrix2<f64>,
    /// Green-Lagrange strain that the material has, or strains.
    pub strains: Strains,
    /// Determinant of the deformation gradient in the plane that the material has.
    pub material_determinant: f64,
    /// Second Piola-Kirchhoff stress S that does work on the strain of the displacements
    /// (force/length^2).
    pub s: Matrix2<f64>,
    /// Smallest determinant of F met: of the configuration, and of the end in the energy-momentum
    /// form.
    pub determinant: f64,
}

impl PointState {
    /// Deformation gradient F.
    pub fn f(&self) -> Matrix2<f64> {
        Matrix2::identity() + self.h
    }
}

/// The configuration in which internal force and tangent are evaluated; displacements of the
/// element's nodes are 2 x N (length).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Configuration<const N: usize> {
    /// Displacements u: F(u), S = dW/dE at E(u).
    At(SMatrix<f64, 2, N>),
    /// Energy-momentum form between start u0 and end u1: F at the mid configuration (u0 + u1)/2 and
    /// a stress that does the work of the strain energy (Simo & Tarnow 1992).
    Between(SMatrix<f64, 2, N>, SMatrix<f64, 2, N>),
}

/// The smaller of two values; NaN when one is.
pub(super) fn smaller(a: f64, b: f64) -> f64 {
    if a < b || a.is_nan() { a } else { b }
}

/// Displacement gradient H = du/dX, eq. (2.1).
#[inline]
pub fn displacement_gradient<const N: usize>(
    point: &IntegrationPoint<N>,
    u: &SMatrix<f64, 2, N>,
) -> Matrix2<f64> {
    u * point.gradient
}

/// Green-Lagrange strain E = (H + H^T + H^T H)/2, eq. (2.2), from H so that small strains keep their
/// digits.
#[inline]
pub fn green_lagrange(h: &Matrix2<f64>) -> Matrix2<f64> {
    (h + h.transpose() + h.transpose() * h) / 2.0
}

/// A strain of the plane with all its components.
#[inline]
pub(super) fn of_plane(e: &Matrix2<f64>) -> Symmetric {
    Symmetric::of_plane(e, 0.0)
}

/// A tangent in Voigt order (11, 22, 2*12).
pub(super) fn voigt(c: &Tangent) -> Matrix3<f64> {
    const PLANE: [usize; 3] = [0, 1, 3];
    Matrix3::from_fn(|i, j| c.0[PLANE[i]][PLANE[j]])
}

/// det F = det(I + H).
#[inline]
pub(super) fn determinant(h: &Matrix2<f64>) -> f64 {
    (Matrix2::identity() + h).determinant()
}

/// Strain energy of one element, and its stress and strain averaged over the volume.
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
    /// Largest absolute principal value of the Green-Lagrange strain in the plane at the integration
    /// points; NaN when there is one.
    pub principal_strain: f64,
    /// Accumulated plastic strain, mean over the element.
    pub plastic_strain: f64,
    /// Green-Lagrange strain around the axis of a body of revolution; 0 in the plane.
    pub strain_around: f64,
    /// The part of the strain energy in hourglass modes (force length).
    pub hourglass_energy: f64,
}

/// The element with the largest principal strain.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
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

/// Results of the points of an element, with their weights (length^3).
pub(super) type PointResults = SmallVec<[(PointResult, f64); 9]>;

/// Strain energy per volume, stress and strain at one integration point.
#[derive(Clone, Copy, Default)]
pub(super) struct PointResult {
    /// Strain energy per volume (force/length^2).
    pub energy: f64,
    /// Cauchy stress in the plane (force/length^2).
    pub sigma: Matrix2<f64>,
    /// Cauchy stress across (force/length^2).
    pub across: f64,
    /// Green-Lagrange strain in the plane.
    pub strain: Matrix2<f64>,
    /// Green-Lagrange strain around the axis of a body of revolution; 0 in the plane.
    pub strain_around: f64,
    /// Accumulated plastic strain.
    pub plastic_strain: f64,
    /// Displacement gradient H in the plane.
    pub gradient: Matrix2<f64>,
}

impl PointResult {
    /// sigma = F S F^T/J, eq. (2.8), with J = det F F_zz, and sigma_zz = F_zz S_zz F_zz / J.
    pub fn new(state: &PointState, material: &Committed, point: usize) -> Self {
        let (f, e) = (state.f(), state.strains.end());
        let Across { stretch, stress } = material.across_at(point, &e);
        PointResult {
            energy: material.energy_at(point, &e),
            sigma: f * state.s * f.transpose() / (state.determinant * stretch),
            across: stress * stretch / state.material_determinant,
            strain: green_lagrange(&state.h),
            strain_around: 0.0,
            plastic_strain: material.plastic_strain(point),
            gradient: state.h,
        }
    }

    /// Largest absolute principal value of the strain in the plane, and of that around the axis.
    ///
    /// ```text
    /// E_1,2 = (E_xx + E_yy)/2 +- sqrt((E_xx - E_yy)²/4 + E_xy²)
    /// ```
    fn principal_strain(&self) -> f64 {
        let e = &self.strain;
        let (mean, half) = ((e.m11 + e.m22) / 2.0, (e.m11 - e.m22) / 2.0);
        -smaller(-(mean.abs() + half.hypot(e.m12)), -self.strain_around.abs())
    }
}

impl ElementResult {
    /// Energy int W dOmega, eq. (2.4), and volume means of integration points with their weights (length^3).
    pub(super) fn of_points(points: impl Iterator<Item = (PointResult, f64)>) -> Self {
        let (mut sigma, mut strain) = (Matrix2::zeros(), Matrix2::zeros());
        let (mut energy, mut across, mut volume, mut principal) = (0.0, 0.0, 0.0, 0.0);
        let (mut plastic, mut around) = (0.0, 0.0);
        for (point, weight) in points {
            energy += point.energy * weight;
            sigma += point.sigma * weight;
            across += point.across * weight;
            strain += point.strain * weight;
            plastic += point.plastic_strain * weight;
            around += point.strain_around * weight;
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
            plastic_strain: plastic / volume,
            strain_around: around / volume,
            hourglass_energy: 0.0,
        }
    }

    /// Sum of results times factors, as of means and of values between points.
    pub fn weighted<'a>(terms: impl Iterator<Item = (f64, &'a ElementResult)>) -> Self {
        let mut sum = ElementResult::default();
        for (factor, term) in terms {
            sum.energy += factor * term.energy;
            sum.across += factor * term.across;
            sum.principal_strain += factor * term.principal_strain;
            sum.plastic_strain += factor * term.plastic_strain;
            sum.strain_around += factor * term.strain_around;
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

    /// Principal values of the mean stresses, the smallest first (force/length^2): szz and
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
