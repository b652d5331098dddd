//! Viscosity of a material (`*DAMPING, BETA=`): a stress beside that of the law that follows the rates
//! of its shape and of its volume. Section 4 of docs/theory.md, Damping.

use nalgebra::{Matrix2, Matrix3, Matrix4};

use super::plane::{dyad, product};
use super::symmetric::{self, IDENTITY, Symmetric, contract};
use super::{
    Hyperelastic, Plane, SaintVenantKirchhoff, SmallStrainModuli, Strains, StressAtPoints,
};

/// Stiffness-proportional viscosity of a material in the plane, over an increment with dE = E1 - E0.
///
/// ```text
/// G = cof(C_m)/J_m,  C_m = I + E0 + E1,  J_m = (J0 + J1)/2     J C^-1 halfway
/// dJ = G : dE = J1 - J0                                        change of the volume ratio
/// dS = G dE G - (dJ/2) G                                       change of the shape
/// S_d dt = beta/J_m (2 mu dS + kappa dJ G)                     the stress
/// S_d : dE >= 0                                                what it dissipates
/// ```
///
/// mu and kappa are the moduli of shear and of the area at small strains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viscosity {
    /// 2 beta mu (force time/length^2).
    pub(super) shape: f64,
    /// beta (kappa - mu), since dS has the part -(dJ/2) G (force time/length^2).
    pub(super) volume: f64,
}

impl Viscosity {
    /// Viscosity as of [`Self::new`] where `beta` is positive.
    pub fn of(beta: f64, moduli: SmallStrainModuli, plane: Plane) -> Option<Self> {
        (beta > 0.0).then(|| Self::new(beta, moduli, plane))
    }

    /// Viscosity of `beta` (time) of a material with these moduli at small strains.
    pub fn new(beta: f64, moduli: SmallStrainModuli, plane: Plane) -> Self {
        let SmallStrainModuli { young, poisson } = moduli;
        let linear = SaintVenantKirchhoff { young, poisson }.in_plane(plane);
        // 2 mu E + (kappa - mu) tr(E) I at small strains
        let c0 = linear.tangent(&Matrix2::zeros());
        Viscosity {
            shape: beta * 2.0 * c0.m33,
            volume: beta * c0.m12,
        }
    }

    /// S_d dt of a ring, eq. (2.36), with P = C_m^-1 in all components (force time/length^2).
    pub fn stress_of_ring(&self, e0: &Symmetric, e1: &Symmetric) -> Symmetric {
        let ((p, j), de) = (Self::halfway_of_ring(e0, e1), e1 - e0);
        let shape = symmetric::product(&p) * Symmetric::new(de.x, de.y, de.z, 2.0 * de.w);
        (shape * self.shape + p * (self.volume * contract(&p, &de))) * j
    }

    /// 2 V of a ring, positive definite: without the change of P and J_m.
    pub fn tangent_of_ring(&self, e0: &Symmetric, e1: &Symmetric) -> Matrix4<f64> {
        let (p, j) = Self::halfway_of_ring(e0, e1);
        (symmetric::product(&p) * self.shape + symmetric::dyad(&p, &p) * self.volume) * (2.0 * j)
    }

    /// P and J_m of a ring between two strains.
    fn halfway_of_ring(e0: &Symmetric, e1: &Symmetric) -> (Symmetric, f64) {
        let c = IDENTITY + e0 + e1;
        let cofactor = symmetric::cofactor(&c);
        let square = c.z * cofactor.z;
        (cofactor / square, square.sqrt())
    }

    /// G and 1/J_m of eq. (4.17) between two strains.
    #[inline]
    fn halfway(e0: &Matrix2<f64>, e1: &Matrix2<f64>) -> (Matrix2<f64>, f64) {
        let ratio = |e: &Matrix2<f64>| (1.0 + 2.0 * e.trace() + 4.0 * e.determinant()).sqrt();
        let inverse = 2.0 / (ratio(e0) + ratio(e1));
        // cof is linear in the plane: cof(I + A) = I + cof A, A = E0 + E1
        let (xx, yy) = (1.0 + e0.m22 + e1.m22, 1.0 + e0.m11 + e1.m11);
        let xy = -(e0.m12 + e1.m12);
        (Matrix2::new(xx, xy, xy, yy) * inverse, inverse)
    }
}

/// Stresses are taken over the length of the increment (force time/length^2). There are none at a strain that does not
/// change.
impl StressAtPoints for Viscosity {
    /// S_d dt, eq. (4.17)
    #[inline(always)]
    fn stress(&self, _point: usize, strains: &Strains) -> Matrix2<f64> {
        let Strains::Between(e0, e1) = strains else {
            return Matrix2::zeros();
        };
        let ((g, inverse), de) = (Self::halfway(e0, e1), e1 - e0);
        let (row, dj) = (g * de, g.dot(&de));
        // a component of G dE G and of G, both symmetric
        let s = |gdeg: f64, g: f64| (self.shape * gdeg + self.volume * dj * g) * inverse;
        let xy = s(row.m11 * g.m12 + row.m12 * g.m22, g.m12);
        Matrix2::new(
            s(row.m11 * g.m11 + row.m12 * g.m12, g.m11),
            xy,
            xy,
            s(row.m21 * g.m12 + row.m22 * g.m22, g.m22),
        )
    }

    /// 2 V of eq. (4.19), positive definite: without the change of G and J_m, which is of first order in dE.
    #[inline(always)]
    fn tangent(&self, _point: usize, strains: &Strains) -> Matrix3<f64> {
        let Strains::Between(e0, e1) = strains else {
            return Matrix3::zeros();
        };
        let (g, inverse) = Self::halfway(e0, e1);
        product(&g) * (2.0 * self.shape * inverse) + dyad(&g) * (2.0 * self.volume * inverse)
    }

    fn is_viscous(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BETA: f64 = 0.3;

    /// Viscosity with these moduli of shear and volume in plane strain.
    fn viscosity(mu: f64, bulk: f64) -> Viscosity {
        let moduli = SmallStrainModuli {
            young: 9.0 * bulk * mu / (3.0 * bulk + mu),
            poisson: (3.0 * bulk - 2.0 * mu) / (2.0 * (3.0 * bulk + mu)),
        };
        Viscosity::new(BETA, moduli, Plane::Strain)
    }

    fn strain(f: &Matrix2<f64>) -> Matrix2<f64> {
        (f.transpose() * f - Matrix2::identity()) / 2.0
    }

    fn some() -> Matrix2<f64> {
        Matrix2::new(1.4, 0.3, -0.5, 0.8)
    }

    #[test]
    fn the_bulk_modulus_is_not_felt_at_constant_volume_nor_the_shear_modulus_at_constant_shape() {
        let f = some();
        // of one volume ratio, however large the change
        let stretched = f * Matrix2::new(1.5, 0.0, 0.4, 1.0 / 1.5);
        let ends = [strain(&f), strain(&stretched)];
        let of =
            |v: Viscosity, &[e0, e1]: &[Matrix2<f64>; 2]| v.stress(0, &Strains::Between(e0, e1));
        let [soft, hard] = [2.0, 2e6].map(|bulk| of(viscosity(1.0, bulk), &ends));
        assert!((soft - hard).norm() < 1e-8 * soft.norm(), "{soft} {hard}");
        // of one shape, turned; kappa = K + mu/3 is the same
        let turned = Matrix2::new(0.6, 0.8, -0.8, 0.6) * f * 1.7;
        let ends = [strain(&f), strain(&turned)];
        let [one, other] =
            [(1.0, 3.0), (3.0, 3.0 - 2.0 / 3.0)].map(|(mu, bulk)| of(viscosity(mu, bulk), &ends));
        assert!((one - other).norm() < 1e-14 * one.norm(), "{one} {other}");
    }

    #[test]
    fn in_a_short_increment_it_is_the_spatial_law() {
        // sigma = beta (2 mu D + lambda tr(D) I), S = J F^-1 sigma F^-T
        let (f, rate, (mu, bulk)) = (some(), Matrix2::new(0.2, -0.7, 0.4, 0.5), (1.3, 4.0));
        let gradient = rate * f.try_inverse().expect("an inverse");
        let d = (gradient + gradient.transpose()) / 2.0;
        let lambda = bulk - 2.0 * mu / 3.0;
        let sigma = (d * (2.0 * mu) + Matrix2::identity() * (lambda * d.trace())) * BETA;
        let inverse = f.try_inverse().expect("an inverse");
        let exact = inverse * sigma * inverse.transpose() * f.determinant();
        let h = 1e-5;
        let [e0, e1] = [-h, h].map(|h| strain(&(f + rate * h)));
        let found = viscosity(mu, bulk).stress(0, &Strains::Between(e0, e1)) / (2.0 * h);
        assert!(
            (found - exact).norm() < 1e-9 * exact.norm(),
            "{found} {exact}"
        );
    }

    #[test]
    fn it_never_gives_energy_back() {
        for bulk in [0.1, 3.0, 1e6] {
            let v = viscosity(1.0, bulk);
            for k in 0..200 {
                let at = |i: usize| (f64::from(k) * 1.7 + i as f64 * 2.3).sin();
                let f = |i: usize| {
                    Matrix2::new(1.0 + 0.9 * at(i), at(i + 1), at(i + 2), 1.5 + at(i + 3))
                };
                let [f0, f1] = [f(0), f(4)];
                if f0.determinant() > 0.0 && f1.determinant() > 0.0 {
                    let [e0, e1] = [strain(&f0), strain(&f1)];
                    let work = v.stress(0, &Strains::Between(e0, e1)).dot(&(e1 - e0));
                    assert!(work > 0.0, "{work}");
                }
            }
        }
    }

    #[test]
    fn plane_stress_keeps_its_own_moduli() {
        let moduli = SmallStrainModuli {
            young: 100.0,
            poisson: 0.3,
        };
        let v = Viscosity::new(BETA, moduli, Plane::Stress);
        let e = Matrix2::new(3e-9, 1e-9, 1e-9, -2e-9);
        let linear = SaintVenantKirchhoff {
            young: 100.0,
            poisson: 0.3,
        };
        let exact = linear.in_plane(Plane::Stress).stress(&e) * BETA;
        let found = v.stress(0, &Strains::Between(Matrix2::zeros(), e));
        assert!((found - exact).norm() < 1e-8 * exact.norm());
    }
}
