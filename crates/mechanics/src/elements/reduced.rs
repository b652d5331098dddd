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

use nalgebra::{Matrix2, Matrix3, SMatrix, Vector2, Vector4};

use super::enhanced_strain::Modes;
use super::formulation::{
    Configuration, ElementFormulation, IntegrationPoint, PointState, Reference, add_geometric,
    determinant, green_lagrange, of_plane, smaller, strain_displacement, voigt,
};
use super::hourglass::{Amplitudes, ModesInMotion, variables};
use crate::materials::{Committed, Strains, StressAtPoints};

/// One strain of the element and hourglass stiffness. All points of the quadrilateral have that strain: they give the
/// weights and the hourglass modes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReducedIntegration;

/// What the hourglass modes of a configuration give, the potential of eq. (2.42) and its stress.
struct Hourglass<'a> {
    modes: ModesInMotion<'a, 2>,
    /// F0 and q at the displacements of the strain-displacement matrix.
    f: Matrix2<f64>,
    q: Vector2<f64>,
}

impl<'a> Hourglass<'a> {
    fn new<const N: usize, const P: usize>(
        element: &Reference<N, P>,
        modes: &Modes<N, P>,
        material: &'a impl StressAtPoints,
        configuration: &Configuration<N>,
    ) -> Self {
        let c = match configuration {
            // a viscosity has no stress at one configuration
            Configuration::At(_) if material.is_viscous() => Matrix3::zeros(),
            _ => voigt(&material.initial_tangent()),
        };
        let of = |u: &SMatrix<f64, 2, N>| (Matrix2::identity() + u * modes.mean, u * modes.gamma);
        let h = |(f, q): (Matrix2<f64>, Vector2<f64>)| f.tr_mul(&q);
        let (ends, amplitudes) = match configuration {
            Configuration::At(u) => ([u, u], Amplitudes::At(h(of(u)))),
            Configuration::Between(u0, u1) => {
                let [h0, h1] = [u0, u1].map(|u| h(of(u)));
                // the tangent of a viscosity is that by the mean of the strains: twice that by their change
                let amplitudes = match material.is_viscous() {
                    true => Amplitudes::Change(h0, h1),
                    false => Amplitudes::Between(h0, h1),
                };
                ([u0, u1], amplitudes)
            }
        };
        let strains = ends.map(|u| {
            let e = green_lagrange(&(u * modes.mean));
            Vector4::new(e.m11, e.m22, 0.0, 2.0 * e.m12)
        });
        let (stiffness, metal) = (stiffness(element, modes, &c), material.metal(P));
        let (f, q) = of(&((ends[0] + ends[1]) / 2.0));
        Hourglass {
            modes: ModesInMotion::new(stiffness, metal, element.volume(), strains, amplitudes),
            f,
            q,
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
    hourglass: &Hourglass,
    configuration: &Configuration<N>,
) -> PointState {
    let of = |u: &SMatrix<f64, 2, N>| u * modes.mean;
    let (h, strains, least) = match configuration {
        Configuration::At(u) => {
            let h = of(u);
            (
                h,
                Strains::At(of_plane(&green_lagrange(&h))),
                determinant(&h),
            )
        }
        Configuration::Between(u0, u1) => {
            let [h0, h1] = [u0, u1].map(of);
            let h = (h0 + h1) / 2.0;
            let [e0, e1] = [h0, h1].map(|h| of_plane(&green_lagrange(&h)));
            let strains = Strains::between(&e0, &e1);
            (h, strains, smaller(determinant(&h), determinant(&h1)))
        }
    };
    PointState {
        h,
        strains,
        material_determinant: determinant(&h),
        s: match hourglass.modes.metal_stress {
            Some(s) => Matrix2::new(s.x, s.w, s.w, s.y),
            None => material.stress_at(0, &strains).in_plane(),
        },
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
        let modes = Modes::new(element);
        let hourglass = Hourglass::new(element, &modes, material, configuration);
        let state = state(&modes, material, &hourglass, configuration);
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
        let hourglass = Hourglass::new(element, &modes, material, configuration);
        let state = state(&modes, material, &hourglass, configuration);
        let (f, q, stress) = (&hourglass.f, &hourglass.q, &hourglass.modes.stress);
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
        let hourglass = Hourglass::new(element, &modes, material, configuration);
        let strains = state(&modes, material, &hourglass, configuration).strains;
        let mut dissipated = 0.0;
        let Some((metal, squares)) = hourglass.modes.metal() else {
            for (p, point) in element.points.iter().enumerate() {
                dissipated += material.update(p, &strains, updated) * point.volume;
            }
            return dissipated;
        };
        let (of_points, own) = updated.split_at_mut(updated.len() - variables(2));
        let count = of_points.len() / P;
        let mut part = 0.0;
        for (z1, point) in of_points.chunks_exact_mut(count).zip(&element.points) {
            let [of_point, flows] = metal.law.update(&strains, metal.of_point, squares, z1);
            dissipated += of_point * point.volume;
            part = flows;
        }
        hourglass.modes.update(part, own);
        dissipated
    }

    fn hourglass_energy<const N: usize, const P: usize>(
        element: &Reference<N, P>,
        material: &impl StressAtPoints,
        configuration: &Configuration<N>,
    ) -> f64 {
        let modes = Modes::new(element);
        (Hourglass::new(element, &modes, material, configuration).modes).energy
    }

    /// K = V B^T C B + int B_NL^T S B_NL + G^T Kh G + f.D^2 H, G the rows of dH, D^2 H_k = b_ak gamma_b + gamma_a b_bk
    /// in both directions; in a metal C and Kh are those of one potential, with what they have in common.
    fn tangent<const N: usize, const P: usize, const D: usize>(
        element: &Reference<N, P>,
        material: &impl StressAtPoints,
        configuration: &Configuration<N>,
    ) -> SMatrix<f64, D, D> {
        let modes = Modes::new(element);
        let hourglass = Hourglass::new(element, &modes, material, configuration);
        let (point, state) = (
            center(element, &modes),
            state(&modes, material, &hourglass, configuration),
        );
        let b = strain_displacement::<N, D>(&point, &state.f());
        let rows = hourglass.rows::<N, P, D>(&modes);
        let mut k = rows.transpose() * (hourglass.modes.stiffness() * rows);
        match hourglass.modes.metal_tangent() {
            None => {
                let c = voigt(&material.tangent_at(0, &state.strains));
                k += b.transpose() * (c * b) * point.volume;
            }
            Some(of_both) => {
                let b = SMatrix::<f64, 4, D>::from_fn(|i, j| match i {
                    2 => 0.0,
                    3 => b[(2, j)],
                    _ => b[(i, j)],
                });
                let mixed = b.transpose() * (of_both.ey * rows);
                k += b.transpose() * (of_both.ee * b) + rows.transpose() * (of_both.yy * rows);
                k += mixed + mixed.transpose();
            }
        }
        add_geometric(&mut k, &point, &state.s);
        let along = modes.mean * hourglass.modes.stress;
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
    use crate::elements::formulation::evaluate;
    use crate::elements::testing::{Sample, check_compressed, laws, quad};
    use crate::materials::{Law, Plane, Plastic, SmallStrainModuli};

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

    #[test]
    fn a_metal_keeps_its_force_and_its_energy_when_an_increment_is_committed() {
        let metal = Law::Plastic(Plastic {
            moduli: SmallStrainModuli {
                young: 1000.0,
                poisson: 0.3,
            },
            hardening: [[0.0, 2.0], [1.0, 2.1]].into(),
            kinematic: 0.0,
        });
        let Sample { x, element } = quad();
        let energy = |material: &Committed, u: &SMatrix<f64, 2, 4>| {
            evaluate::<ReducedIntegration, 4, 4>(&element, material, u).energy
        };
        for law in [Plane::Strain, Plane::Stress].map(|plane| metal.in_plane(plane)) {
            // drawn and bent
            for [draw, bend] in [[0.2, 0.05], [0.02, 0.05], [0.0, 0.05], [0.3, 0.005]] {
                let d = SMatrix::<f64, 2, 4>::from_fn(|i, a| {
                    let side = if a % 2 == 0 { bend } else { -bend };
                    [
                        draw * x[(0, a)] + side,
                        -draw * x[(1, a)] / 2.0 + side / 3.0,
                    ][i]
                });
                let mut z = vec![0.0; 4 * law.variables() + variables(2)];
                for step in 0..20 {
                    let [u0, u1] = [step, step + 1].map(|k| d * (f64::from(k) / 20.0));
                    let (increment, mut updated) = (Configuration::Between(u0, u1), z.clone());
                    let material = Committed::new(&law, &z);
                    let dissipated =
                        ReducedIntegration::update(&element, &material, &increment, &mut updated);
                    let after = Committed::new(&law, &updated);
                    let force = |material: &Committed, configuration: &Configuration<4>| {
                        ReducedIntegration::internal_force(&element, material, configuration).0
                    };
                    let work = force(&material, &increment).dot(&(u1 - u0));
                    let change = energy(&after, &u1) - energy(&material, &u0) + dissipated;
                    assert!(dissipated >= 0.0);
                    assert!(
                        (work - change).abs() < 1e-12 * work.abs(),
                        "{work} {change}"
                    );
                    let end = Configuration::At(u1);
                    let (before, after) = (force(&material, &end), force(&after, &end));
                    let jump = (before - after).norm();
                    assert!(jump < 1e-11 * before.norm(), "{draw} {bend} {step}: {jump}");
                    z = updated;
                }
            }
        }
    }
}
