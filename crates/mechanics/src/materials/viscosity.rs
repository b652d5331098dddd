//! Viscosity of a material (`*DAMPING, BETA=`): a stress, added to the stress of the law, that depends on the rates of
//! distortion and volume. See docs/theory/time.md, Damping.

use super::number::Number;
use super::strains::{StrainChange, Strains};
use super::symmetric::{Symmetric, Tangent, cofactor, dyad, minor, product};
use super::{Across, Plane, SaintVenantKirchhoff, SmallStrainModuli, StressAtPoints};

/// Stiffness-proportional viscosity of a material, over an increment with dE = E1 - E0.
///
/// ```text
/// D = cof(C_m) + cof(dE)/3,  C_m = I + E0 + E1                 D : 2 dE = J1² - J0² exactly
/// G = D/J_m,  J_m = (J0 + J1)/2                                J C^-1 halfway
/// dJ = G : dE = J1 - J0                                        change of the volume ratio
/// S_d dt = beta/J_m (2 mu G dE G + lambda dJ G)                the stress
/// S_d : dE >= 0                                                what it dissipates
/// ```
///
/// The tensor D is the mean of the cofactors of C on the straight path from C0 to C1, so D is positive definite. Here
/// mu and lambda are the moduli at small strains. With the part dJ/2 G (in the plane) of the first term, the stress
/// splits into a stress of distortion and a stress of volume. The stress of distortion and the stress of volume depend
/// on only one of the two moduli each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viscosity {
    /// Viscosity of distortion, 2 beta mu (force time/length^2).
    shape: f64,
    /// Viscosity of volume, beta lambda (force time/length^2).
    volume: f64,
}

/// Tensor G and factor 1/J_m of eq. (4.17) between two strains.
#[inline(always)]
fn halfway<T: Number, const HOOP: bool>(change: &StrainChange<T>) -> (Symmetric<T>, T) {
    let ratio = |e: Symmetric<T>| {
        let (of_plane, q) = ((e.x + e.y) * 2.0, minor(&e) * 4.0);
        let square = match HOOP {
            true => (of_plane + q + 1.0) * (e.z * 2.0 + 1.0),
            false => of_plane + q + 1.0,
        };
        square.sqrt()
    };
    let inverse = T::all(2.0) / (ratio(change.start) + ratio(change.end));
    let c = change.mean.map(|e| e * 2.0).plus_isotropic(T::all(1.0));
    let g = match HOOP {
        true => cofactor(&c) + cofactor(&change.half).map(|d| d * (4.0 / 3.0)),
        false => Symmetric::new(c.y, c.x, T::default(), c.w * -1.0),
    };
    (g.times(inverse), inverse)
}

impl Viscosity {
    /// Viscosity as from [`Self::new`] if `beta` is positive, else `None`.
    pub fn of(beta: f64, moduli: SmallStrainModuli, plane: Plane) -> Option<Self> {
        (beta > 0.0).then(|| Self::new(beta, moduli, plane))
    }

    /// Viscosity with the factor `beta` (time) for a material with the given moduli at small strains.
    pub fn new(beta: f64, moduli: SmallStrainModuli, plane: Plane) -> Self {
        let SmallStrainModuli { young, poisson } = moduli;
        let (lambda, mu) = SaintVenantKirchhoff { young, poisson }
            .in_plane(plane)
            .lame();
        Viscosity {
            shape: beta * 2.0 * mu,
            volume: beta * lambda,
        }
    }
}

impl Viscosity {
    /// Tangent of the viscous stress at a zero change of the strains (force time/length^2).
    pub fn initial_tangent(&self) -> Tangent {
        let none = Strains::Between(StrainChange::default());
        StressAtPoints::<f64, true>::tangent_at(self, 0, &none)
    }
}

/// The viscous stresses are multiplied by the length of the increment (force time/length^2). The viscous stresses are
/// zero if the strain does not change; they store no energy, and there is no stress across the plane.
impl<T: Number, const HOOP: bool> StressAtPoints<T, HOOP> for Viscosity {
    /// Viscous stress times the length of the increment, S_d dt, eq. (4.17).
    #[inline(always)]
    fn stress_at(&self, _point: usize, strains: &Strains<T>) -> Symmetric<T> {
        let Strains::Between(change) = strains else {
            return Symmetric::zeros();
        };
        let ((g, inverse), de) = (halfway::<T, HOOP>(change), change.change());
        let dj = g.contract::<HOOP>(&de) * self.volume;
        // G dE and G dE G
        let (xx, xy) = (g.x * de.x + g.w * de.w, g.x * de.w + g.w * de.y);
        let (yx, yy) = (g.w * de.x + g.y * de.w, g.w * de.w + g.y * de.y);
        let around = match HOOP {
            true => g.z * de.z * g.z,
            false => T::default(),
        };
        let gdeg = Symmetric::new(
            xx * g.x + xy * g.w,
            yx * g.w + yy * g.y,
            around,
            xx * g.w + xy * g.y,
        );
        gdeg.with(&g, |gdeg, g| (gdeg * self.shape + dj * g) * inverse)
    }

    /// Tangent 2 V of eq. (4.19), which is positive definite. The tangent omits the change of G and J_m, which is of
    /// first order in dE.
    #[inline(always)]
    fn tangent_at(&self, _point: usize, strains: &Strains<T>) -> Tangent<T> {
        let Strains::Between(change) = strains else {
            return Tangent::default();
        };
        let (g, inverse) = halfway::<T, HOOP>(change);
        let (product, dyad) = (product(&g), dyad(&g, &g));
        let (shape, volume) = (inverse * (2.0 * self.shape), inverse * (2.0 * self.volume));
        Tangent::of(|i, j| product[i][j] * shape + dyad[i][j] * volume)
    }

    fn energy_at(&self, _point: usize, _e: &Symmetric<T>) -> T {
        T::default()
    }

    fn across_at(&self, _point: usize, _e: &Symmetric<T>) -> Across<T> {
        Across {
            stretch: T::all(1.0),
            stress: T::default(),
        }
    }

    fn is_viscous(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::Hyperelastic;
    use nalgebra::Matrix2;

    const BETA: f64 = 0.3;

    /// Viscosity in plane strain with the given moduli of shear and volume.
    fn viscosity(mu: f64, bulk: f64) -> Viscosity {
        let moduli = SmallStrainModuli {
            young: 9.0 * bulk * mu / (3.0 * bulk + mu),
            poisson: (3.0 * bulk - 2.0 * mu) / (2.0 * (3.0 * bulk + mu)),
        };
        Viscosity::new(BETA, moduli, Plane::Strain)
    }

    fn strain(f: &Matrix2<f64>) -> Symmetric {
        Symmetric::of_plane(&((f.transpose() * f - Matrix2::identity()) / 2.0), 0.0)
    }

    fn stress(v: Viscosity, [e0, e1]: &[Symmetric; 2]) -> Symmetric {
        StressAtPoints::<f64, true>::stress_at(&v, 0, &Strains::between(e0, e1))
    }

    fn in_plane(v: Viscosity, ends: &[Symmetric; 2]) -> Matrix2<f64> {
        stress(v, ends).in_plane()
    }

    fn some() -> Matrix2<f64> {
        Matrix2::new(1.4, 0.3, -0.5, 0.8)
    }

    #[test]
    fn the_bulk_modulus_is_not_felt_at_constant_volume_nor_the_shear_modulus_at_constant_shape() {
        let f = some();
        // start and end have the same volume ratio, however large the change
        let stretched = f * Matrix2::new(1.5, 0.0, 0.4, 1.0 / 1.5);
        let ends = [strain(&f), strain(&stretched)];
        let [soft, hard] = [2.0, 2e6].map(|bulk| in_plane(viscosity(1.0, bulk), &ends));
        assert!((soft - hard).norm() < 1e-8 * soft.norm(), "{soft} {hard}");
        // start and end have the same shape, turned; kappa = K + mu/3 is the same in both cases
        let turned = Matrix2::new(0.6, 0.8, -0.8, 0.6) * f * 1.7;
        let ends = [strain(&f), strain(&turned)];
        let [one, other] = [(1.0, 3.0), (3.0, 3.0 - 2.0 / 3.0)]
            .map(|(mu, bulk)| in_plane(viscosity(mu, bulk), &ends));
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
        let found = in_plane(viscosity(mu, bulk), &[e0, e1]) / (2.0 * h);
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
                    let work = in_plane(v, &[e0, e1]).dot(&(e1 - e0).in_plane());
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
        let e = Symmetric::new(3e-9, -2e-9, 0.0, 1e-9);
        let linear = SaintVenantKirchhoff {
            young: 100.0,
            poisson: 0.3,
        };
        let linear: &dyn Hyperelastic = &linear.in_plane(Plane::Stress);
        let exact = linear.stress(&e).in_plane() * BETA;
        let found = in_plane(v, &[Symmetric::zeros(), e]);
        assert!((found - exact).norm() < 1e-8 * exact.norm());
    }

    #[test]
    fn in_a_ring_it_takes_energy_and_has_the_spatial_law_in_a_short_increment() {
        let moduli = SmallStrainModuli {
            young: 1000.0,
            poisson: 0.3,
        };
        let (e0, direction) = (
            Symmetric::new(0.2, -0.1, 0.3, 0.15),
            Symmetric::new(-0.4, 0.3, 0.5, 0.2),
        );
        let v = Viscosity::new(BETA, moduli, Plane::Revolution);
        for size in [0.5, -0.3, 1e-3] {
            let s = stress(v, &[e0, e0 + direction * size]);
            assert!(s.contract::<true>(&(direction * size)) > 0.0);
        }
        // near E = 0 it is beta C dE
        let linear: &dyn Hyperelastic = &SaintVenantKirchhoff {
            young: 1000.0,
            poisson: 0.3,
        }
        .in_plane(Plane::Revolution);
        let de = direction * 1e-8;
        let found = stress(v, &[de * -0.5, de * 0.5]);
        let exact = linear.stress(&de) * BETA;
        assert!((found - exact).norm() < 1e-12 * exact.norm());
        // with a change of volume alone, C1 = s^2 C0, the stress does not contain the shear modulus
        let grown = (e0 * 1.44).plus_isotropic(0.22);
        let bulk = 1000.0 / (3.0 * 0.4);
        let with_shear = |mu: f64| {
            let moduli = SmallStrainModuli {
                young: 9.0 * bulk * mu / (3.0 * bulk + mu),
                poisson: (3.0 * bulk - 2.0 * mu) / (2.0 * (3.0 * bulk + mu)),
            };
            Viscosity::new(BETA, moduli, Plane::Revolution)
        };
        let [one, other] = [400.0, 1800.0].map(|mu| stress(with_shear(mu), &[e0, grown]));
        assert!((one - other).norm() < 1e-12 * one.norm());
        // with a change of shape alone, of any size, det C1 = det C0, the stress does not contain
        // the bulk modulus
        let stretched = |by: f64| {
            let c = (e0 * 2.0).plus_isotropic(1.0);
            let c = Symmetric::new(c.x * by, c.y * by, c.z / (by * by), c.w * by);
            c.plus_isotropic(-1.0) / 2.0
        };
        let [soft, hard] = [0.1, 1e6].map(|lambda| {
            let v = Viscosity {
                shape: 1.0,
                volume: lambda,
            };
            stress(v, &[e0, stretched(1.5)])
        });
        assert!(
            (soft - hard).norm() < 1e-8 * soft.norm(),
            "{soft:?} {hard:?}"
        );
    }
}
