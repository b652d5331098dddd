//! The four-node quadrilateral with one strain (CPE4R, CPS4R), that of its mean gradients, and a potential of its
//! hourglass modes. Section 2 of docs/theory.md.
//!
//! # Derivation
//!
//! With u = sum u_a h_a, F = F0 + q x grad h exactly: F0 = I + sum u_a x b_a, q = sum gamma_a u_a. H = F0^T q does not
//! change when the element turns. The potential is that of the element with enhanced strains at small strains:
//!
//! ```text
//! Phi = V W(E0) + H.Kh H/2,  Kh = K_HH - K_Ha K_aa^-1 K_aH
//! ```
//!
//! H is quadratic in the displacements, so that dH = F0m^T dq + dF0^T qm holds exactly between two configurations, and
//! the force with Kh (H0 + H1)/2 at halfway does exactly the work of the hourglass energy.

use nalgebra::{Matrix2, Matrix3, SMatrix, Vector2};

use super::enhanced_strain::Modes;
use super::formulation::{
    Configuration, ElementFormulation, IntegrationPoint, PointState, Reference, add_geometric,
    determinant, green_lagrange, smaller, strain_displacement,
};
use super::hourglass::{Amplitudes, HourglassPotential};
use crate::materials::{Committed, Strains, StressAtPoints};

/// One strain of the element and hourglass stiffness. All points of the quadrilateral have that strain: they give the
/// weights and the hourglass modes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReducedIntegration;

/// What the hourglass modes of a configuration give, the potential of eq. (2.42) and its stress.
struct Hourglass {
    potential: HourglassPotential<2>,
    /// H, at one configuration or at the start and at the end.
    amplitudes: Amplitudes<2>,
    /// Volume (length^3) and modulus E' of the plane (force/length^2).
    sizes: [f64; 2],
    /// F0 and q at the displacements of the strain-displacement matrix.
    f: Matrix2<f64>,
    q: Vector2<f64>,
    /// Stress f that does work on H (force).
    stress: Vector2<f64>,
    /// Energy, or work between two configurations (force length).
    energy: f64,
}

impl Hourglass {
    fn new<const N: usize, const P: usize>(
        element: &Reference<N, P>,
        modes: &Modes<N, P>,
        material: &impl StressAtPoints,
        configuration: &Configuration<N>,
    ) -> Self {
        let c = match configuration {
            // a viscosity has no stress at one configuration
            Configuration::At(_) if material.is_viscous() => Matrix3::zeros(),
            _ => material.initial_tangent(),
        };
        let sizes = [element.volume(), c.m11 - c.m12 * c.m12 / c.m22];
        let stiffness = stiffness(element, modes, &c);
        let potential = HourglassPotential::new(stiffness, sizes, material.yielding(P));
        let of = |u: &SMatrix<f64, 2, N>| (Matrix2::identity() + u * modes.mean, u * modes.gamma);
        let h = |(f, q): (Matrix2<f64>, Vector2<f64>)| f.tr_mul(&q);
        let (u, amplitudes) = match configuration {
            Configuration::At(u) => (*u, Amplitudes::At(h(of(u)))),
            Configuration::Between(u0, u1) => {
                let [h0, h1] = [u0, u1].map(|u| h(of(u)));
                // the tangent of a viscosity is that by the mean of the strains: twice that by their change
                let amplitudes = match material.is_viscous() {
                    true => Amplitudes::Change(h0, h1),
                    false => Amplitudes::Between(h0, h1),
                };
                ((u0 + u1) / 2.0, amplitudes)
            }
        };
        let ((f, q), (stress, energy)) = (of(&u), potential.stress(&amplitudes));
        Hourglass {
            potential,
            amplitudes,
            sizes,
            f,
            q,
            stress,
            energy,
        }
    }

    /// Rows of dH by the displacements: b_a q_i + F0^T e_i gamma_a.
    fn rows<const N: usize, const P: usize, const D: usize>(
        &self,
        modes: &Modes<N, P>,
    ) -> SMatrix<f64, 2, D> {
        SMatrix::from_fn(|k, j| {
            let (a, i) = (j / 2, j % 2);
            modes.mean[(a, k)] * self.q[i] + self.f[(i, k)] * modes.gamma[a]
        })
    }
}

/// Kh of the tangent C at small strains: the energy of sym(H x grad h) + M alpha, least in alpha (force/length).
fn stiffness<const N: usize, const P: usize>(
    element: &Reference<N, P>,
    modes: &Modes<N, P>,
    c: &Matrix3<f64>,
) -> Matrix2<f64> {
    let (mut k, mut mixed) = (Matrix2::zeros(), SMatrix::<f64, 2, 4>::zeros());
    for (p, point) in element.points.iter().enumerate() {
        let slope = modes.slope[p];
        let b = SMatrix::<f64, 3, 2>::new(slope.x, 0.0, 0.0, slope.y, slope.y, slope.x);
        let cb = c * b * point.volume;
        k += b.transpose() * cb;
        mixed += cb.transpose() * modes.columns(p);
    }
    match modes.stiffness(element, |_| *c).try_inverse() {
        Some(inverse) => k - mixed * inverse * mixed.transpose(),
        None => k,
    }
}

/// The element as one point: mean gradients and volume.
fn center<const N: usize, const P: usize>(
    element: &Reference<N, P>,
    modes: &Modes<N, P>,
) -> IntegrationPoint<N> {
    IntegrationPoint {
        shape: element.points[0].shape,
        gradient: modes.mean,
        volume: element.volume(),
    }
}

/// Deformation and stress of the element.
fn state<const N: usize, const P: usize>(
    modes: &Modes<N, P>,
    material: &impl StressAtPoints,
    configuration: &Configuration<N>,
) -> PointState {
    let of = |u: &SMatrix<f64, 2, N>| u * modes.mean;
    let (h, strains, least) = match configuration {
        Configuration::At(u) => {
            let h = of(u);
            (h, Strains::At(green_lagrange(&h)), determinant(&h))
        }
        Configuration::Between(u0, u1) => {
            let [h0, h1] = [u0, u1].map(of);
            let h = (h0 + h1) / 2.0;
            let strains = Strains::Between(green_lagrange(&h0), green_lagrange(&h1));
            (h, strains, smaller(determinant(&h), determinant(&h1)))
        }
    };
    PointState {
        h,
        strains,
        material_determinant: determinant(&h),
        s: material.stress(0, &strains),
        determinant: least,
    }
}

impl ElementFormulation for ReducedIntegration {
    /// The one state of the element for each of its points.
    fn for_each_state<const N: usize, const P: usize>(
        element: &Reference<N, P>,
        material: &impl StressAtPoints,
        configuration: &Configuration<N>,
        mut visit: impl FnMut(usize, &PointState),
    ) {
        let state = state(&Modes::new(element), material, configuration);
        for p in 0..P {
            visit(p, &state);
        }
    }

    /// V F0 S b_a + q (b_a.f) + F0 f gamma_a, eq. (2.43), with the smallest determinant of F at the points too.
    fn internal_force<const N: usize, const P: usize>(
        element: &Reference<N, P>,
        material: &impl StressAtPoints,
        configuration: &Configuration<N>,
    ) -> (SMatrix<f64, 2, N>, f64) {
        let modes = Modes::new(element);
        let state = state(&modes, material, configuration);
        let hourglass = Hourglass::new(element, &modes, material, configuration);
        let Hourglass { f, q, stress, .. } = &hourglass;
        let force = state.f() * state.s * modes.mean.transpose() * element.volume()
            + q * (modes.mean * stress).transpose()
            + f * stress * modes.gamma.transpose();
        let end = match configuration {
            Configuration::At(u) | Configuration::Between(_, u) => u,
        };
        let of_points = element
            .points
            .iter()
            .map(|p| determinant(&(end * p.gradient)));
        let least = of_points.fold(state.determinant, |least, det| smaller(det, least));
        (force, least)
    }

    /// The variables of the one strain at all points, and those of the hourglass modes of a metal behind them.
    fn update<const N: usize, const P: usize>(
        element: &Reference<N, P>,
        material: &Committed,
        configuration: &Configuration<N>,
        updated: &mut [f64],
    ) -> f64 {
        let modes = Modes::new(element);
        let state = state(&modes, material, configuration);
        let mut dissipated = 0.0;
        for (p, point) in element.points.iter().enumerate() {
            dissipated += material.update(p, &state.strains, updated) * point.volume;
        }
        let after = material.with(updated);
        let Some((yield_stress, own)) = after.yielding(P) else {
            return dissipated;
        };
        let strength = [yield_stress, after.used_strength(state.strains.end())];
        let first = updated.len() - own.len();
        let hourglass = Hourglass::new(element, &modes, material, configuration);
        let (end, own) = (hourglass.amplitudes.end(), &mut updated[first..]);
        dissipated + (hourglass.potential).update(end, hourglass.sizes, strength, own)
    }

    fn hourglass_energy<const N: usize, const P: usize>(
        element: &Reference<N, P>,
        material: &impl StressAtPoints,
        configuration: &Configuration<N>,
    ) -> f64 {
        Hourglass::new(element, &Modes::new(element), material, configuration).energy
    }

    /// K = V B^T C B + int B_NL^T S B_NL + G^T Kh G + f.D^2 H, G the rows of dH, D^2 H_k = b_ak gamma_b + gamma_a b_bk
    /// in both directions.
    fn tangent<const N: usize, const P: usize, const D: usize>(
        element: &Reference<N, P>,
        material: &impl StressAtPoints,
        configuration: &Configuration<N>,
    ) -> SMatrix<f64, D, D> {
        let modes = Modes::new(element);
        let (point, state) = (
            center(element, &modes),
            state(&modes, material, configuration),
        );
        let b = strain_displacement::<N, D>(&point, &state.f());
        let mut k = b.transpose() * (material.tangent(0, &state.strains) * b) * point.volume;
        add_geometric(&mut k, &point, &state.s);
        let hourglass = Hourglass::new(element, &modes, material, configuration);
        let rows = hourglass.rows::<N, P, D>(&modes);
        k += rows.transpose() * (hourglass.potential.tangent(&hourglass.amplitudes) * rows);
        let along = modes.mean * hourglass.stress;
        for (a, b) in (0..N).flat_map(|a| (0..N).map(move |b| (a, b))) {
            let second = along[a] * modes.gamma[b] + modes.gamma[a] * along[b];
            for i in 0..2 {
                k[(2 * a + i, 2 * b + i)] += second;
            }
        }
        k
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::enhanced_strain::EnhancedStrain;
    use crate::elements::testing::{check_compressed, laws, quad};

    #[test]
    fn elements_of_one_strain_fulfil_what_all_have_to() {
        for law in laws() {
            quad().check_all::<ReducedIntegration, 8>(&law);
        }
        check_compressed::<ReducedIntegration>();
    }

    #[test]
    fn small_strains_are_those_of_enhanced_strains() {
        for law in laws() {
            let found = quad().tangent::<ReducedIntegration, 8>(&law, SMatrix::zeros());
            let exact = quad().tangent::<EnhancedStrain, 8>(&law, SMatrix::zeros());
            assert!((found - exact).norm() < 1e-13 * exact.norm());
        }
    }
}
