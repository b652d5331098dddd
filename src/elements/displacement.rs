//! The displacement formulation: strains of the displacements at every integration point. Section 2
//! of docs/theory.md (paper eq. 12).

use nalgebra::SMatrix;

use super::formulation::{
    Configuration, Formulation, PointState, Reference, add_geometric, determinant,
    displacement_gradient, green_lagrange, smaller, strain_displacement,
};
use crate::materials::{Strains, StressAtPoints};

/// Strains of the displacements, E = (F^T F - I)/2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Displacement;

impl Formulation for Displacement {
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
            let c = material.tangent(p, &state.strains);
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
            let (strains, determinant) = (Strains::At(green_lagrange(&h)), determinant(&h));
            PointState {
                h,
                strains,
                material_determinant: determinant,
                s: material.stress(p, &strains),
                determinant,
            }
        }
        Configuration::Between(u0, u1) => {
            let [h0, h1] = [u0, u1].map(|u| displacement_gradient(point, u));
            let strains = Strains::Between(green_lagrange(&h0), green_lagrange(&h1));
            let h = (h0 + h1) / 2.0;
            let mid = determinant(&h);
            PointState {
                h,
                strains,
                material_determinant: mid,
                s: material.stress(p, &strains),
                determinant: smaller(mid, determinant(&h1)),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::block::Shape;
    use crate::elements::formulation::evaluate;
    use crate::elements::shapes::tests::{QUAD8, TRI6};
    use crate::elements::shapes::{
        QuadraticTriangle, Quadrilateral, ReducedSerendipity, Serendipity, Triangle,
    };
    use crate::materials::{Committed, Law, NeoHooke, Plane, PlaneLaw};
    use nalgebra::Matrix2;

    /// Plane strain, E = 1000, nu = 0.3.
    fn plane_strain() -> PlaneLaw {
        Law::elastic(1000.0, 0.3).in_plane(Plane::Strain)
    }

    fn strain_energy<const N: usize, const P: usize>(
        element: &Reference<N, P>,
        c: &Committed,
        u: &SMatrix<f64, 2, N>,
    ) -> f64 {
        evaluate::<Displacement, N, P>(element, c, u).energy
    }

    fn quad() -> Reference<4, 4> {
        let x = [[0.0, 0.0], [2.0, 0.3], [1.7, 1.9], [-0.2, 1.2]];
        let x = SMatrix::from_columns(&x.map(|p| p.into()));
        Quadrilateral::reference(&Quadrilateral::map(&x, 0.5))
    }

    fn tri() -> Reference<3, 1> {
        let x = SMatrix::from_columns(&[[0.1, 0.0], [2.0, 0.3], [0.7, 1.9]].map(|p| p.into()));
        Triangle::reference(&Triangle::map(&x, 0.5))
    }

    fn tri6() -> Reference<6, 3> {
        let x = SMatrix::from_columns(&TRI6.map(|p| p.into()));
        QuadraticTriangle::reference(&QuadraticTriangle::map(&x, 0.5))
    }

    fn quad8() -> Reference<8, 9> {
        let x = SMatrix::from_columns(&QUAD8.map(|p| p.into()));
        Serendipity::reference(&Serendipity::map(&x, 0.5))
    }

    fn quad8_reduced() -> Reference<8, 4> {
        let x = SMatrix::from_columns(&QUAD8.map(|p| p.into()));
        ReducedSerendipity::reference(&ReducedSerendipity::map(&x, 0.5))
    }

    /// Some displacements of moderate size, the same for every run.
    fn displacements<const N: usize>(seed: usize) -> SMatrix<f64, 2, N> {
        SMatrix::from_fn(|i, a| (((seed + 7 * a + 3 * i) * 37) % 23) as f64 / 100.0 - 0.11)
    }

    fn check_tangent<const N: usize, const P: usize, const D: usize>(element: &Reference<N, P>) {
        let law = plane_strain();
        let c = Committed::new(&law, &[]);
        let u = displacements::<N>(5);
        let k = Displacement::tangent::<N, P, D>(element, &c, &Configuration::At(u));
        let h = 1e-6;
        for j in 0..D {
            let mut du = SMatrix::<f64, 2, N>::zeros();
            du[j] = h;
            let plus = Displacement::internal_force(element, &c, &Configuration::At(u + du)).0;
            let minus = Displacement::internal_force(element, &c, &Configuration::At(u - du)).0;
            let column = (plus - minus) / (2.0 * h);
            for i in 0..D {
                assert!((k[(i, j)] - column[i]).abs() < 1e-7 * k.norm(), "({i},{j})");
            }
        }
        assert!((k - k.transpose()).norm() < 1e-13 * k.norm());
    }

    #[test]
    fn tangent_is_the_derivative_of_the_internal_force() {
        check_tangent::<4, 4, 8>(&quad());
        check_tangent::<3, 1, 6>(&tri());
        check_tangent::<6, 3, 12>(&tri6());
        check_tangent::<8, 9, 16>(&quad8());
        check_tangent::<8, 4, 16>(&quad8_reduced());
    }

    fn check_gradient<const N: usize, const P: usize>(element: &Reference<N, P>) {
        let law = plane_strain();
        let (c, u, h) = (Committed::new(&law, &[]), displacements::<N>(5), 1e-6);
        let force = Displacement::internal_force(element, &c, &Configuration::At(u)).0;
        for j in 0..2 * N {
            let mut du = SMatrix::<f64, 2, N>::zeros();
            du[j] = h;
            let plus = strain_energy(element, &c, &(u + du));
            let minus = strain_energy(element, &c, &(u - du));
            assert!(((plus - minus) / (2.0 * h) - force[j]).abs() < 1e-7 * force.norm());
        }
    }

    #[test]
    fn internal_force_is_the_derivative_of_the_strain_energy() {
        check_gradient(&quad());
        check_gradient(&tri());
        check_gradient(&tri6());
        check_gradient(&quad8());
        check_gradient(&quad8_reduced());
    }

    fn check_work<const N: usize, const P: usize>(element: &Reference<N, P>, law: &PlaneLaw) {
        let c = Committed::new(law, &[]);
        let (u0, u1) = (displacements::<N>(5) * 0.3, displacements::<N>(11) * 0.3);
        let (force, _) = Displacement::internal_force(element, &c, &Configuration::Between(u0, u1));
        let work = force.dot(&(u1 - u0));
        let difference = strain_energy(element, &c, &u1) - strain_energy(element, &c, &u0);
        assert!((work - difference).abs() < 1e-14 * force.norm());
    }

    #[test]
    fn averaged_force_does_exactly_the_work_of_the_strain_energy() {
        let rubber = Law::NeoHooke(NeoHooke {
            c10: 200.0,
            d1: 2e-3,
        });
        for law in [plane_strain(), rubber.in_plane(Plane::Strain)] {
            check_work(&quad(), &law);
            check_work(&tri6(), &law);
            check_work(&quad8(), &law);
            check_work(&quad8_reduced(), &law);
        }
    }

    fn check_rotation<const N: usize, const P: usize>(
        element: &Reference<N, P>,
        x: &SMatrix<f64, 2, N>,
    ) {
        let law = plane_strain();
        let c = Committed::new(&law, &[]);
        for degrees in (0..=360).step_by(15) {
            let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
            let u = Matrix2::new(cos, -sin, sin, cos) * x - x;
            let (force, det) = Displacement::internal_force(element, &c, &Configuration::At(u));
            assert!(force.amax() < 1e-12 * 1000.0, "{degrees}: {}", force.amax());
            assert!((det - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn rigid_rotation_gives_no_internal_force() {
        let x = SMatrix::from_columns(
            &[[0.0, 0.0], [2.0, 0.3], [1.7, 1.9], [-0.2, 1.2]].map(|p| p.into()),
        );
        check_rotation(&quad(), &x);
        let x = SMatrix::from_columns(&[[0.1, 0.0], [2.0, 0.3], [0.7, 1.9]].map(|p| p.into()));
        check_rotation(&tri(), &x);
        check_rotation(&tri6(), &SMatrix::from_columns(&TRI6.map(|p| p.into())));
        let x = SMatrix::from_columns(&QUAD8.map(|p| p.into()));
        check_rotation(&quad8(), &x);
        check_rotation(&quad8_reduced(), &x);
    }

    #[test]
    fn principal_strain_by_hand() {
        // simple shear g: E = [[0, g/2], [g/2, g²/2]], turned by any angle
        let (g, element) = (0.3_f64, quad());
        let expected = g * g / 4.0 + (g * g / 4.0).hypot(g / 2.0);
        let x = SMatrix::from_columns(
            &[[0.0, 0.0], [2.0, 0.3], [1.7, 1.9], [-0.2, 1.2]].map(|p| p.into()),
        );
        for degrees in [0.0_f64, 40.0, 200.0] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let f = Matrix2::new(cos, -sin, sin, cos) * Matrix2::new(1.0, g, 0.0, 1.0);
            let found = evaluate::<Displacement, _, _>(
                &element,
                &Committed::new(&plane_strain(), &[]),
                &(f * x - x),
            )
            .principal_strain;
            assert!((found - expected).abs() < 1e-14, "{found}");
        }
        // compression to 0.6: E = (0.36 - 1)/2
        let f = Matrix2::new(0.6, 0.0, 0.0, 1.0);
        assert!(
            (evaluate::<Displacement, _, _>(
                &element,
                &Committed::new(&plane_strain(), &[]),
                &(f * x - x)
            )
            .principal_strain
                - 0.32)
                .abs()
                < 1e-14
        );
        assert!(
            evaluate::<Displacement, _, _>(
                &element,
                &Committed::new(&plane_strain(), &[]),
                &(f * x * f64::NAN)
            )
            .principal_strain
            .is_nan()
        );
    }

    #[test]
    fn homogeneous_deformation_by_hand() {
        // F = [[1.2, .3], [.1, .9]], plane strain E = 1000, nu = 0.3:
        // S = [274.038462, 62.5, 173.076923 (12)], W = 68.209135 per volume.
        let gradient = Matrix2::new(0.2, 0.3, 0.1, -0.1);
        let x = SMatrix::from_columns(
            &[[0.0, 0.0], [2.0, 0.3], [1.7, 1.9], [-0.2, 1.2]].map(|p| p.into()),
        );
        let law = plane_strain();
        let (c, element) = (Committed::new(&law, &[]), quad());
        let u = gradient * x;
        for p in 0..4 {
            let state = state(&element, p, &c, &Configuration::At(u));
            let s = Matrix2::new(274.038462, 173.076923, 173.076923, 62.5);
            let p = Matrix2::new(380.769231, 226.442308, 183.173077, 73.557692);
            assert!((state.s - s).amax() < 1e-6);
            assert!((state.f() * state.s - p).amax() < 1e-6);
        }
        let energy = strain_energy(&element, &c, &u) / element.volume();
        assert!((energy - 68.209135).abs() < 1e-6);
    }
}
