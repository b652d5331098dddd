//! The mean dilatation formulation (Q1P0; Simo, Taylor & Pister 1985), for nearly incompressible
//! materials in plane strain: all integration points of an element have the volume ratio theta = v/V of
//! the whole element, and the stored energy is that of the modified deformation gradient
//!
//! ```text
//! Fbar = (theta/J)^(1/2) F,  det Fbar = theta
//! ```
//!
//! eq. (2.9). The exponent is that of plane strain (de Souza Neto et al. 1996): F_zz stays 1, so that the material
//! keeps its plane strain law. Section 2 of docs/theory.md.

use nalgebra::{Matrix2, SMatrix, SVector, Vector3};

use super::formulation::{
    Configuration, ElementFormulation, IntegrationPoint, PointState, Reference, add_geometric,
    determinant, displacement_gradient, green_lagrange, of_plane, smaller, strain_displacement,
    voigt,
};
use crate::materials::{Strains, StressAtPoints};

/// The volume ratio of the whole element at every integration point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeanDilatation;

/// Deformation of an integration point at the start and the end of the motion, which are the same at
/// one configuration.
#[derive(Clone, Copy)]
struct PointMotion {
    h: [Matrix2<f64>; 2],
    /// Green-Lagrange strain of the displacements.
    strain: [Matrix2<f64>; 2],
    /// J - 1.
    dilatation: [f64; 2],
}

/// Stress of an integration point with mean quantities of the motion.
#[derive(Clone, Copy)]
struct PointStress {
    /// Displacement gradient of the mid configuration.
    h: Matrix2<f64>,
    /// C_m/2: half the mean of the right Cauchy-Green tensors.
    half_c: Matrix2<f64>,
    /// K = det F_m (F_m^T F_m)^-1, so that J1 - J0 = K : (E1 - E0).
    k: Matrix2<f64>,
    /// Strains that the material has.
    strains: Strains,
    /// Stress that does work on the strain that the material has.
    s: Matrix2<f64>,
    /// Mean of theta/J.
    ratio: f64,
    /// Mean of J, over J0 J1.
    inverse_j: f64,
    /// Mean of theta, over J0 J1.
    theta_over_jj: f64,
    /// A - a theta_m: factor of K in the stress that does work on the strain of the displacements.
    pressure: f64,
}

impl PointMotion {
    #[inline(always)]
    fn new<const N: usize>(point: &IntegrationPoint<N>, u: [&SMatrix<f64, 2, N>; 2]) -> Self {
        let h = u.map(|u| displacement_gradient(point, u));
        PointMotion {
            h,
            strain: h.map(|h| green_lagrange(&h)),
            dilatation: h.map(|h| h.trace() + h.determinant()),
        }
    }

    /// Strain that the material has, with r = theta/J: Ebar = r E + (r - 1)/2 I, eq. (2.10).
    #[inline(always)]
    fn material_strain(&self, theta: [f64; 2]) -> [Matrix2<f64>; 2] {
        std::array::from_fn(|i| {
            let excess = (theta[i] - self.dilatation[i]) / (1.0 + self.dilatation[i]);
            self.strain[i] + (self.strain[i] + Matrix2::identity() / 2.0) * excess
        })
    }

    #[inline(always)]
    fn stress(&self, theta: [f64; 2], strains: Strains, s: Matrix2<f64>) -> PointStress {
        let [j0, j1] = self.dilatation.map(|j| 1.0 + j);
        let [t0, t1] = theta.map(|t| 1.0 + t);
        let h = (self.h[0] + self.h[1]) / 2.0;
        let f = Matrix2::identity() + h;
        let c = f.transpose() * f;
        PointStress {
            h,
            half_c: (Matrix2::identity() + self.strain[0] + self.strain[1]) / 2.0,
            k: Matrix2::new(c.m22, -c.m12, -c.m21, c.m11) / f.determinant(),
            strains,
            s,
            ratio: (t0 / j0 + t1 / j1) / 2.0,
            inverse_j: (j0 + j1) / 2.0 / (j0 * j1),
            theta_over_jj: (t0 + t1) / 2.0 / (j0 * j1),
            pressure: 0.0,
        }
    }
}

impl PointStress {
    /// S : C_m/2, the mean Kirchhoff stress of the material in the plane over theta/J.
    fn kirchhoff(&self) -> f64 {
        self.s.dot(&self.half_c)
    }

    /// Stress that does work on the strain of the displacements, eq. (2.11).
    fn effective(&self) -> Matrix2<f64> {
        self.s * self.ratio + self.k * self.pressure
    }
}

/// Motion and stresses of all points: the one evaluation of the material.
///
/// The changes of the products r C and theta/J between two configurations are exact with mean
/// quantities,
///
/// ```text
/// dEbar = r_m dE + C_m/2 dr,  dr = (J_m dtheta - theta_m dJ)/(J0 J1),  dJ = K : dE
/// ```
///
/// so that S : dEbar = W1 - W0 at every point makes the work of the internal force that of the
/// stored energy of the element, eq. (2.11).
#[inline(always)]
fn stresses<const N: usize, const P: usize>(
    element: &Reference<N, P>,
    material: &impl StressAtPoints,
    configuration: &Configuration<N>,
) -> ([PointMotion; P], [PointStress; P], [f64; 2]) {
    let u = match configuration {
        Configuration::At(u) => [u, u],
        Configuration::Between(u0, u1) => [u0, u1],
    };
    let motions = std::array::from_fn(|p| PointMotion::new(&element.points[p], u));
    let mean = |value: &dyn Fn(usize) -> f64| {
        let weighted = element.points.iter().enumerate();
        weighted
            .map(|(p, point)| value(p) * point.volume)
            .sum::<f64>()
            / element.volume()
    };
    // theta - 1 = int (J - 1) dOmega / V
    let theta = [0, 1].map(|i| mean(&|p| motions[p].dilatation[i]));
    let strains: [Strains; P] = std::array::from_fn(|p| {
        let [e0, e1] = motions[p].material_strain(theta).map(|e| of_plane(&e));
        match configuration {
            Configuration::At(_) => Strains::At(e1),
            Configuration::Between(..) => Strains::between(&e0, &e1),
        }
    });
    let mut stresses: [PointStress; P] = std::array::from_fn(|p| {
        let s = material.stress_at(p, &strains[p]).in_plane();
        motions[p].stress(theta, strains[p], s)
    });
    // a = S : C_m/2 / (J0 J1),  A = int a J_m dOmega / V
    let shared = mean(&|p| stresses[p].kirchhoff() * stresses[p].inverse_j);
    for stress in &mut stresses {
        stress.pressure = shared - stress.kirchhoff() * stress.theta_over_jj;
    }
    (motions, stresses, theta)
}

impl ElementFormulation for MeanDilatation {
    fn for_each_state<const N: usize, const P: usize>(
        element: &Reference<N, P>,
        material: &impl StressAtPoints,
        configuration: &Configuration<N>,
        mut visit: impl FnMut(usize, &PointState),
    ) {
        let (motions, stresses, theta) = stresses(element, material, configuration);
        for (p, stress) in stresses.iter().enumerate() {
            let state = PointState {
                h: stress.h,
                strains: stress.strains,
                material_determinant: 1.0 + theta[1],
                s: stress.effective(),
                determinant: smaller(determinant(&stress.h), 1.0 + motions[p].dilatation[1]),
            };
            visit(p, &state);
        }
    }

    /// Second derivative of the stored energy, eq. (2.12); in the energy-momentum form with mean
    /// quantities.
    fn tangent<const N: usize, const P: usize, const D: usize>(
        element: &Reference<N, P>,
        material: &impl StressAtPoints,
        configuration: &Configuration<N>,
    ) -> SMatrix<f64, D, D> {
        let (_, stresses, _) = stresses(element, material, configuration);
        let b: [SMatrix<f64, 3, D>; P] = std::array::from_fn(|p| {
            let f = Matrix2::identity() + stresses[p].h;
            strain_displacement::<N, D>(&element.points[p], &f)
        });
        // DJ = B^T K, Dtheta = int DJ dOmega / V
        let dj: [SVector<f64, D>; P] =
            std::array::from_fn(|p| b[p].transpose() * work_conjugate(&stresses[p].k));
        let mut dtheta = SVector::<f64, D>::zeros();
        for (point, dj) in element.points.iter().zip(&dj) {
            dtheta += dj * (point.volume / element.volume());
        }
        let mut k = SMatrix::<f64, D, D>::zeros();
        for (p, point) in element.points.iter().enumerate() {
            let stress = &stresses[p];
            let c = voigt(&material.tangent_at(p, &stress.strains));
            // Dr = (J_m Dtheta - theta_m DJ)/(J0 J1), DEbar = r B + C/2 Dr
            let dr = dtheta * stress.inverse_j - dj[p] * stress.theta_over_jj;
            let half_c = &stress.half_c;
            let half_c = Vector3::new(half_c.m11, half_c.m22, 2.0 * half_c.m12);
            let b_bar = b[p] * stress.ratio + half_c * dr.transpose();
            k += b_bar.transpose() * (c * b_bar) * point.volume;
            // S : D2Ebar without the second derivatives of J and theta
            let s = b[p].transpose() * work_conjugate(&stress.s)
                - dj[p] * (stress.kirchhoff() * stress.inverse_j);
            let mixed = s * dr.transpose() * point.volume;
            k += mixed + mixed.transpose();
            add_geometric(&mut k, point, &(stress.s * stress.ratio));
            add_second_of_volume(&mut k, point, stress.pressure);
        }
        k
    }
}

/// A stress as the vector whose product with the strain vector (xx, yy, 2 xy) is the work.
fn work_conjugate(s: &Matrix2<f64>) -> Vector3<f64> {
    Vector3::new(s.m11, s.m22, s.m12)
}

/// Adds p D2J dOmega of a point: J = det F is bilinear in the displacements x and y.
fn add_second_of_volume<const N: usize, const D: usize>(
    k: &mut SMatrix<f64, D, D>,
    point: &IntegrationPoint<N>,
    pressure: f64,
) {
    let g = &point.gradient;
    for a in 0..N {
        for b in 0..N {
            let cross = g[(a, 0)] * g[(b, 1)] - g[(a, 1)] * g[(b, 0)];
            k[(2 * a, 2 * b + 1)] += pressure * cross * point.volume;
            k[(2 * b + 1, 2 * a)] += pressure * cross * point.volume;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::MeanDilatation;
    use crate::elements::testing::quad;
    use crate::materials::{Law, Plane};

    #[test]
    fn nearly_incompressible_elements_fulfil_what_all_have_to() {
        let law = Law::elastic(1000.0, 0.49).in_plane(Plane::Strain);
        quad().check_all::<MeanDilatation, 8>(&law);
    }
}
