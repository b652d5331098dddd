//! What the formulations of an element have in common: internal force, strain-displacement matrix,
//! geometric stiffness, and the evaluation of stress, strain and energy. Section 2 of
//! docs/theory.md (paper eq. 12).

use nalgebra::{SMatrix, Vector3};

use super::integration_point::{Point, PointState, Reference, Strains};
use super::kinematics::{Configuration, smaller};
use super::recovery::{ElementResult, PointResult};
use crate::materials::{Committed, StressAtPoints};

/// How strains and stresses at the integration points follow from the displacements of an element.
/// Chosen at compile time: a sweep has no dispatch within an element.
pub trait Formulation {
    /// Visits every integration point p with its deformation and stress: the one evaluation of the
    /// material, from which force, tangent and output follow.
    fn for_each_state<const N: usize, const P: usize>(
        element: &Reference<N, P>,
        material: &impl StressAtPoints,
        configuration: &Configuration<N>,
        visit: impl FnMut(usize, &PointState),
    );

    /// Tangent K = dF/du, D x D (force/length); symmetric.
    fn tangent<const N: usize, const P: usize, const D: usize>(
        element: &Reference<N, P>,
        material: &impl StressAtPoints,
        configuration: &Configuration<N>,
    ) -> SMatrix<f64, D, D>;
}

/// Internal force F = int B_L^T S dOmega, eq. (2.5) (paper eq. 12), 2 x N (force), with the smallest
/// determinant of the deformation gradient.
pub fn internal_force<F: Formulation, const N: usize, const P: usize>(
    element: &Reference<N, P>,
    material: &impl StressAtPoints,
    configuration: &Configuration<N>,
) -> (SMatrix<f64, 2, N>, f64) {
    let mut force = SMatrix::<f64, 2, N>::zeros();
    let mut determinant = f64::INFINITY;
    F::for_each_state(element, material, configuration, |p, state| {
        let point = &element.points[p];
        // B_L^T S of node a is F S dh_a/dX: the first Piola-Kirchhoff stress times the gradient.
        force += state.f() * state.s * point.gradient.transpose() * point.volume;
        determinant = smaller(determinant, state.determinant);
    });
    (force, determinant)
}

/// Work of the stress on the strains between two configurations, int S:(E1 - E0) dOmega (force length).
pub fn work<F: Formulation, const N: usize, const P: usize>(
    element: &Reference<N, P>,
    material: &impl StressAtPoints,
    configuration: &Configuration<N>,
) -> f64 {
    let mut work = 0.0;
    F::for_each_state(element, material, configuration, |p, state| {
        if let Strains::Between(e0, e1) = state.strains {
            let s = material.mean_stress(p, [&e0, &e1]);
            work += s.dot(&(e1 - e0)) * element.points[p].volume;
        }
    });
    work
}

/// Strain energy, stress and strain of an element at displacements `u`.
pub fn evaluate<F: Formulation, const N: usize, const P: usize>(
    element: &Reference<N, P>,
    material: &Committed,
    u: &SMatrix<f64, 2, N>,
) -> ElementResult {
    let mut results = [PointResult::default(); P];
    F::for_each_state(element, material, &Configuration::At(*u), |p, state| {
        results[p] = PointResult::new(state, material, p);
    });
    let weights = element.points.iter().map(|point| point.volume);
    ElementResult::of_points(results.into_iter().zip(weights))
}

/// Internal variables of all points at displacements `u`, written to `updated`, and the energy
/// dissipated on the way to them, int D dOmega (force length).
pub fn update<F: Formulation, const N: usize, const P: usize>(
    element: &Reference<N, P>,
    material: &Committed,
    u: &SMatrix<f64, 2, N>,
    updated: &mut [f64],
) -> f64 {
    let mut dissipated = 0.0;
    F::for_each_state(element, material, &Configuration::At(*u), |p, state| {
        let volume = element.points[p].volume;
        dissipated += material.update(p, state.strains.end(), updated) * volume;
    });
    dissipated
}

/// B_L: delta E (xx, yy, 2 xy) per nodal displacement (1/length).
pub(super) fn strain_displacement<const N: usize, const D: usize>(
    point: &Point<N>,
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
    point: &Point<N>,
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
