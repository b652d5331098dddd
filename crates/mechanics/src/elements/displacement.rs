//! The displacement formulation: strains of the displacements at every integration point. Section 2
//! of docs/theory.md (paper eq. 12).

use nalgebra::SMatrix;

use super::formulation::{
    Configuration, ElementFormulation, PointState, Reference, add_geometric, determinant,
    displacement_gradient, green_lagrange, of_plane, smaller, strain_displacement, voigt,
};
use crate::materials::{Strains, StressAtPoints};

/// Strains of the displacements, E = (F^T F - I)/2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Displacement;

impl ElementFormulation for Displacement {
    #[inline]
    fn for_each_state<const N: usize, const P: usize>(
        element: &Reference<N, P>,
        material: &impl StressAtPoints,
        configuration: &Configuration<N>,
        mut visit: impl FnMut(usize, &PointState),
    ) {
        for p in 0..P {
            visit(p, &state(element, p, material, configuration));
        }
    }

    /// K = int B_L^T C B_L + B_NL^T S B_NL dOmega, eq. (2.6) (paper eq. 12).
    ///
    /// In the energy-momentum form B_L is that of the mid configuration on both sides, S the
    /// energy-momentum stress and C the symmetric part of its own tangent: a symmetric approximation of
    /// the exact tangent, which has B_L of the end on the right; up to the factor theta2 = 1/2.
    fn tangent<const N: usize, const P: usize, const D: usize>(
        element: &Reference<N, P>,
        material: &impl StressAtPoints,
        configuration: &Configuration<N>,
    ) -> SMatrix<f64, D, D> {
        let mut k = SMatrix::<f64, D, D>::zeros();
        for (p, point) in element.points.iter().enumerate() {
            let state = state(element, p, material, configuration);
            let c = voigt(&material.tangent_at(p, &state.strains));
            let b = strain_displacement::<N, D>(point, &state.f());
            k += b.transpose() * (c * b) * point.volume;
            add_geometric(&mut k, point, &state.s);
        }
        k
    }
}

/// Deformation and stress at a point: the one evaluation of the material.
#[inline(always)]
fn state<const N: usize, const P: usize>(
    element: &Reference<N, P>,
    p: usize,
    material: &impl StressAtPoints,
    configuration: &Configuration<N>,
) -> PointState {
    let point = &element.points[p];
    match configuration {
        Configuration::At(u) => {
            let h = displacement_gradient(point, u);
            let (strains, determinant) =
                (Strains::At(of_plane(&green_lagrange(&h))), determinant(&h));
            PointState {
                h,
                strains,
                material_determinant: determinant,
                s: material.stress_at(p, &strains).in_plane(),
                determinant,
            }
        }
        Configuration::Between(u0, u1) => {
            let [h0, h1] = [u0, u1].map(|u| displacement_gradient(point, u));
            let [e0, e1] = [h0, h1].map(|h| of_plane(&green_lagrange(&h)));
            let strains = Strains::between(&e0, &e1);
            let h = (h0 + h1) / 2.0;
            let mid = determinant(&h);
            PointState {
                h,
                strains,
                material_determinant: mid,
                s: material.stress_at(p, &strains).in_plane(),
                determinant: smaller(mid, determinant(&h1)),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::formulation::evaluate;
    use crate::elements::shapes::tests::{QUAD8, TRI6};
    use crate::elements::shapes::{QuadraticTriangle, ReducedSerendipity, Serendipity, Triangle};
    use crate::elements::testing::{Sample, laws, quad};
    use crate::materials::{Committed, Law, Plane, PlaneLaw};
    use nalgebra::Matrix2;

    /// Plane strain, E = 1000, nu = 0.3.
    fn plane_strain() -> PlaneLaw {
        Law::elastic(1000.0, 0.3).in_plane(Plane::Strain)
    }

    fn check<const N: usize, const P: usize, const D: usize>(sample: &Sample<N, P>) {
        for law in laws() {
            sample.check_derivatives::<Displacement, D>(&law);
            sample.check_work::<Displacement>(&law);
            sample.check_rotation::<Displacement>(&law);
        }
    }

    #[test]
    fn elements_of_all_shapes_fulfil_what_all_have_to() {
        check::<4, 4, 8>(&quad());
        check::<3, 1, 6>(&Sample::new::<Triangle>([
            [0.1, 0.0],
            [2.0, 0.3],
            [0.7, 1.9],
        ]));
        check::<6, 3, 12>(&Sample::new::<QuadraticTriangle>(TRI6));
        check::<8, 9, 16>(&Sample::new::<Serendipity>(QUAD8));
        check::<8, 4, 16>(&Sample::new::<ReducedSerendipity>(QUAD8));
    }

    #[test]
    fn principal_strain_by_hand() {
        let principal_strain = |f: Matrix2<f64>| {
            let (law, Sample { x, element }) = (plane_strain(), quad());
            let material = Committed::new(&law, &[]);
            evaluate::<Displacement, _, _>(&element, &material, &(f * x - x)).principal_strain
        };
        // simple shear g: E = [[0, g/2], [g/2, g²/2]], turned by any angle
        let g = 0.3_f64;
        let expected = g * g / 4.0 + (g * g / 4.0).hypot(g / 2.0);
        for degrees in [0.0_f64, 40.0, 200.0] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let f = Matrix2::new(cos, -sin, sin, cos) * Matrix2::new(1.0, g, 0.0, 1.0);
            let found = principal_strain(f);
            assert!((found - expected).abs() < 1e-14, "{found}");
        }
        // compression to 0.6: E = (0.36 - 1)/2
        let compressed = principal_strain(Matrix2::new(0.6, 0.0, 0.0, 1.0));
        assert!((compressed - 0.32).abs() < 1e-14);
        assert!(principal_strain(Matrix2::identity() * f64::NAN).is_nan());
    }

    #[test]
    fn homogeneous_deformation_by_hand() {
        // F = [[1.2, .3], [.1, .9]], plane strain E = 1000, nu = 0.3:
        // S = [274.038462, 62.5, 173.076923 (12)], W = 68.209135 per volume.
        let (law, sample) = (plane_strain(), quad());
        let u = Matrix2::new(0.2, 0.3, 0.1, -0.1) * sample.x;
        for p in 0..4 {
            let material = Committed::new(&law, &[]);
            let state = state(&sample.element, p, &material, &Configuration::At(u));
            let s = Matrix2::new(274.038462, 173.076923, 173.076923, 62.5);
            let p = Matrix2::new(380.769231, 226.442308, 183.173077, 73.557692);
            assert!((state.s - s).amax() < 1e-6);
            assert!((state.f() * state.s - p).amax() < 1e-6);
        }
        let energy = sample.energy::<Displacement>(&law, &u) / sample.element.volume();
        assert!((energy - 68.209135).abs() < 1e-6);
    }
}
