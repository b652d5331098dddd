//! Internal force, tangent, mass and strain energy of a total-Lagrangian solid element with any
//! number of nodes and integration points. Section 2 of docs/theory.md (paper eq. 12).

use nalgebra::{SMatrix, Vector3};

use super::kinematics::{
    Configuration, PointState, displacement_gradient, green_lagrange, smaller,
};
use super::reference::Reference;
use super::voigt::{Elasticity, stress};

/// Consistent mass per direction, int rho h_a h_b dOmega (mass), eq. (2.7).
pub fn mass<const N: usize, const P: usize>(
    element: &Reference<N, P>,
    density: f64,
) -> SMatrix<f64, N, N> {
    element.mass * density
}

/// Strain energy W = int E : C : E/2 dOmega, eq. (2.4), at displacements `u` (force length).
pub fn strain_energy<const N: usize, const P: usize>(
    element: &Reference<N, P>,
    c: &Elasticity,
    u: &SMatrix<f64, 2, N>,
) -> f64 {
    let at_point = |p: &super::Point<N>| {
        let e = green_lagrange(&displacement_gradient(p, u));
        stress(c, &e).dot(&e) / 2.0 * p.volume
    };
    element.points.iter().map(at_point).sum()
}

/// Largest absolute principal value of the Green-Lagrange strain in the plane at the integration
/// points; NaN when there is one.
///
/// ```text
/// E_1,2 = (E_xx + E_yy)/2 +- sqrt((E_xx - E_yy)²/4 + E_xy²)
/// ```
pub fn largest_strain<const N: usize, const P: usize>(
    element: &Reference<N, P>,
    u: &SMatrix<f64, 2, N>,
) -> f64 {
    let mut largest = 0.0;
    for point in &element.points {
        let e = green_lagrange(&displacement_gradient(point, u));
        let (mean, half) = ((e.m11 + e.m22) / 2.0, (e.m11 - e.m22) / 2.0);
        largest = -smaller(-largest, -(mean.abs() + half.hypot(e.m12)));
    }
    largest
}

/// Internal force F = int B_L^T S dOmega, eq. (2.5) (paper eq. 12), 2 x N (force), with the smallest
/// determinant of the deformation gradient.
pub fn internal_force<const N: usize, const P: usize>(
    element: &Reference<N, P>,
    c: &Elasticity,
    configuration: &Configuration<N>,
) -> (SMatrix<f64, 2, N>, f64) {
    let mut force = SMatrix::<f64, 2, N>::zeros();
    let mut determinant = f64::INFINITY;
    for point in &element.points {
        let PointState {
            f,
            s,
            determinant: det,
        } = configuration.state(point, c);
        // B_L^T S of node a is F S dh_a/dX: the first Piola-Kirchhoff stress times the gradient.
        force += f * s * point.gradient.transpose() * point.volume;
        determinant = smaller(determinant, det);
    }
    (force, determinant)
}

/// Tangent K = int B_L^T C B_L + B_NL^T S B_NL dOmega, eq. (2.6) (paper eq. 12), D x D (force/length).
///
/// In the energy-momentum form B_L is that of the mid configuration on both sides and S the mean
/// stress: a symmetric approximation of the exact tangent, which has B_L of the end on the right; up to
/// the factor theta2 = 1/2.
pub fn tangent<const N: usize, const P: usize, const D: usize>(
    element: &Reference<N, P>,
    c: &Elasticity,
    configuration: &Configuration<N>,
) -> SMatrix<f64, D, D> {
    let mut k = SMatrix::<f64, D, D>::zeros();
    for point in &element.points {
        let PointState { f, s, .. } = configuration.state(point, c);
        // B_L: delta E (xx, yy, 2 xy) per nodal displacement
        let b = SMatrix::<f64, 3, D>::from_columns(&std::array::from_fn::<_, D, _>(|j| {
            let (a, i) = (j / 2, j % 2);
            let (gx, gy) = (point.gradient[(a, 0)], point.gradient[(a, 1)]);
            Vector3::new(
                f[(i, 0)] * gx,
                f[(i, 1)] * gy,
                f[(i, 0)] * gy + f[(i, 1)] * gx,
            )
        }));
        k += b.transpose() * (c * b) * point.volume;
        // B_NL^T S B_NL: dh_a/dX . S dh_b/dX on both directions
        let geometric = point.gradient * s * point.gradient.transpose() * point.volume;
        for a in 0..N {
            for b in 0..N {
                k[(2 * a, 2 * b)] += geometric[(a, b)];
                k[(2 * a + 1, 2 * b + 1)] += geometric[(a, b)];
            }
        }
    }
    k
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::{quad4, tri3};
    use nalgebra::{Matrix2, Matrix3};

    /// Plane strain, E = 1000, nu = 0.3.
    fn plane_strain() -> Elasticity {
        let c = 1000.0 / (1.3 * 0.4);
        Matrix3::new(
            0.7 * c,
            0.3 * c,
            0.0,
            0.3 * c,
            0.7 * c,
            0.0,
            0.0,
            0.0,
            0.2 * c,
        )
    }

    fn quad() -> Reference<4, 4> {
        let x = [[0.0, 0.0], [2.0, 0.3], [1.7, 1.9], [-0.2, 1.2]];
        quad4(&SMatrix::from_columns(&x.map(|p| p.into())), 0.5)
    }

    fn tri() -> Reference<3, 1> {
        tri3(
            &SMatrix::from_columns(&[[0.1, 0.0], [2.0, 0.3], [0.7, 1.9]].map(|p| p.into())),
            0.5,
        )
    }

    /// Some displacements of moderate size, the same for every run.
    fn displacements<const N: usize>(seed: usize) -> SMatrix<f64, 2, N> {
        SMatrix::from_fn(|i, a| (((seed + 7 * a + 3 * i) * 37) % 23) as f64 / 100.0 - 0.11)
    }

    fn check_tangent<const N: usize, const P: usize, const D: usize>(element: &Reference<N, P>) {
        let c = plane_strain();
        let u = displacements::<N>(5);
        let k = tangent::<N, P, D>(element, &c, &Configuration::At(u));
        let h = 1e-6;
        for j in 0..D {
            let mut du = SMatrix::<f64, 2, N>::zeros();
            du[j] = h;
            let plus = internal_force(element, &c, &Configuration::At(u + du)).0;
            let minus = internal_force(element, &c, &Configuration::At(u - du)).0;
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
    }

    fn check_gradient<const N: usize, const P: usize>(element: &Reference<N, P>) {
        let (c, u, h) = (plane_strain(), displacements::<N>(5), 1e-6);
        let force = internal_force(element, &c, &Configuration::At(u)).0;
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
    }

    #[test]
    fn averaged_force_does_exactly_the_work_of_the_strain_energy() {
        let (c, element) = (plane_strain(), quad());
        let (u0, u1) = (displacements::<4>(5), displacements::<4>(11));
        let (force, _) = internal_force(&element, &c, &Configuration::Between(u0, u1));
        let work = force.dot(&(u1 - u0));
        let difference = strain_energy(&element, &c, &u1) - strain_energy(&element, &c, &u0);
        assert!((work - difference).abs() < 1e-14 * force.norm());
    }

    fn check_rotation<const N: usize, const P: usize>(
        element: &Reference<N, P>,
        x: &SMatrix<f64, 2, N>,
    ) {
        let c = plane_strain();
        for degrees in (0..=360).step_by(15) {
            let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
            let u = Matrix2::new(cos, -sin, sin, cos) * x - x;
            let (force, det) = internal_force(element, &c, &Configuration::At(u));
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
            let found = largest_strain(&element, &(f * x - x));
            assert!((found - expected).abs() < 1e-14, "{found}");
        }
        // compression to 0.6: E = (0.36 - 1)/2
        let f = Matrix2::new(0.6, 0.0, 0.0, 1.0);
        assert!((largest_strain(&element, &(f * x - x)) - 0.32).abs() < 1e-14);
        assert!(largest_strain(&element, &(f * x * f64::NAN)).is_nan());
    }

    #[test]
    fn homogeneous_deformation_by_hand() {
        // F = [[1.2, .3], [.1, .9]], plane strain E = 1000, nu = 0.3:
        // S = [274.038462, 62.5, 173.076923 (12)], W = 68.209135 per volume.
        let gradient = Matrix2::new(0.2, 0.3, 0.1, -0.1);
        let x = SMatrix::from_columns(
            &[[0.0, 0.0], [2.0, 0.3], [1.7, 1.9], [-0.2, 1.2]].map(|p| p.into()),
        );
        let (c, element) = (plane_strain(), quad());
        let u = gradient * x;
        for point in &element.points {
            let state = Configuration::At(u).state(point, &c);
            let s = Matrix2::new(274.038462, 173.076923, 173.076923, 62.5);
            let p = Matrix2::new(380.769231, 226.442308, 183.173077, 73.557692);
            assert!((state.s - s).amax() < 1e-6);
            assert!((state.f * state.s - p).amax() < 1e-6);
        }
        let energy = strain_energy(&element, &c, &u) / element.volume();
        assert!((energy - 68.209135).abs() < 1e-6);
    }
}
