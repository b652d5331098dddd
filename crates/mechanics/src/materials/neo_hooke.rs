//! Compressible neo-Hookean material whose energy is split into an isochoric and a volumetric part
//! (Holzapfel, Nonlinear Solid Mechanics, sections 6.4 and 6.5; Bonet & Wood, Nonlinear Continuum
//! Mechanics for Finite Element Analysis, section 6.5). See docs/theory/materials.md.

use super::invariants::{InvariantEnergy, VolumeEnergy};
use super::number::Number;
use super::{LawCard, SmallStrainModuli};

/// Neo-Hookean material, `*HYPERELASTIC, NEO HOOKE`.
///
/// With C = I + 2 E, I1 = tr C, J = det F, Ibar1 = J^(-2/3) I1:
///
/// ```text
/// energy   W = C10 (Ibar1 - 3) + (J - 1)²/D1
/// stress   S = 2 C10 J^(-2/3) (I - I1/3 C^-1) + p J C^-1,     p = 2 (J - 1)/D1
/// tangent  C = 4 C10/3 J^(-2/3) [ I1 C^-1 o C^-1 + I1/3 C^-1 x C^-1 - I x C^-1 - C^-1 x I ]
///              + (p + 2 J/D1) J C^-1 x C^-1 - 2 p J C^-1 o C^-1
/// domain   J > 0; the pressure stays below 2/D1 in compression
/// moduli   mu = 2 C10,  K = 2/D1
/// ```
///
/// The product A o A has the components (A o A)_ijkl = (A_ik A_jl + A_il A_jk)/2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NeoHooke {
    /// Shear constant C10 (force/length^2, > 0).
    pub c10: f64,
    /// Compressibility D1 (length^2/force, > 0).
    pub d1: f64,
}

impl NeoHooke {
    /// The material whose Young's modulus (force/length^2) and Poisson's ratio at small strains are given: C10 = mu/2,
    /// D1 = 2/K, mu = E/(2 (1 + nu)), K = E/(3 (1 - 2 nu)).
    pub fn of_small_strain(SmallStrainModuli { young, poisson }: SmallStrainModuli) -> Self {
        NeoHooke {
            c10: young / (4.0 * (1.0 + poisson)),
            d1: 6.0 * (1.0 - 2.0 * poisson) / young,
        }
    }

    /// `*HYPERELASTIC, NEO HOOKE`
    pub fn cards(&self) -> Vec<LawCard> {
        vec![LawCard {
            keyword: "HYPERELASTIC",
            parameter: Some("NEO HOOKE"),
            rows: vec![vec![self.c10, self.d1]],
        }]
    }

    /// Moduli at small strains, from mu = 2 C10 and K = 2/D1.
    pub fn small_strain(&self) -> SmallStrainModuli {
        SmallStrainModuli::of_shear_and_bulk(2.0 * self.c10, 2.0 / self.d1)
    }
}

/// The energy parts are w = C10 x and U = (J - 1)²/D1, eq. (2.14).
impl InvariantEnergy for NeoHooke {
    const LINEAR: bool = true;
    const SECOND: bool = false;

    #[inline(always)]
    fn c01(&self) -> f64 {
        0.0
    }

    #[inline(always)]
    fn shape<T: Number>(&self, x: T) -> T {
        x * self.c10
    }

    #[inline(always)]
    fn shape_slopes<T: Number>(&self, _x: T) -> [T; 2] {
        [T::all(self.c10), T::default()]
    }

    #[inline(always)]
    fn shape_quotient<T: Number>(&self, _x0: T, _x1: T) -> T {
        T::all(self.c10)
    }

    #[inline(always)]
    fn volume(&self) -> VolumeEnergy {
        VolumeEnergy {
            d: [self.d1, 0.0, 0.0],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::{Hyperelastic, Symmetric};
    use nalgebra::Matrix2;

    const MATERIAL: NeoHooke = NeoHooke {
        c10: 200.0,
        d1: 2e-3,
    };

    fn strain(f: &Matrix2<f64>) -> Symmetric {
        Symmetric::of_plane(&((f.transpose() * f - Matrix2::identity()) / 2.0), 0.0)
    }

    fn stress(f: &Matrix2<f64>) -> Matrix2<f64> {
        Hyperelastic::<f64, true>::stress(&MATERIAL, &strain(f)).in_plane()
    }

    /// Cauchy stress F S F^T/J.
    fn cauchy(f: &Matrix2<f64>) -> Matrix2<f64> {
        f * stress(f) * f.transpose() / f.determinant()
    }

    #[test]
    fn simple_shear_in_closed_form() {
        // F = I + g e_x e_y: J = 1, sigma = 2 C10 dev(F F^T): xy: mu g, xx: mu g² 2/3, yy = zz: -mu g²/3
        let (mu, g) = (2.0 * MATERIAL.c10, 0.7);
        let f = Matrix2::new(1.0, g, 0.0, 1.0);
        let sigma = cauchy(&f);
        let expected = Matrix2::new(2.0 * g / 3.0, 1.0, 1.0, -g / 3.0) * (mu * g);
        assert!((sigma - expected).norm() < 1e-13 * mu);
        let across = Hyperelastic::<f64, true>::across(&MATERIAL, &strain(&f));
        assert!((across.stress + mu * g * g / 3.0).abs() < 1e-13 * mu);
        let energy = Hyperelastic::<f64, true>::energy(&MATERIAL, &strain(&f));
        assert!((energy - MATERIAL.c10 * g * g).abs() < 1e-13 * mu);
    }

    #[test]
    fn uniaxial_strain_in_closed_form() {
        // F = diag(l, 1, 1): J = l, b = diag(l², 1, 1),
        // sigma_xx = 2 C10 l^(-5/3) 2/3 (l² - 1) + 2 (l - 1)/D1, the others -1/2 of the first part
        for l in [0.4_f64, 0.9, 1.0, 1.5, 3.0] {
            let f = Matrix2::new(l, 0.0, 0.0, 1.0);
            let shape = 2.0 * MATERIAL.c10 * l.powf(-5.0 / 3.0) * (l * l - 1.0) * 2.0 / 3.0;
            let p = 2.0 * (l - 1.0) / MATERIAL.d1;
            let expected = Matrix2::new(shape + p, 0.0, 0.0, p - shape / 2.0);
            assert!((cauchy(&f) - expected).norm() < 1e-12 * (1.0 + expected.norm()));
            let across = Hyperelastic::<f64, true>::across(&MATERIAL, &strain(&f));
            assert!((across.stress / l - expected.m22).abs() < 1e-12 * (1.0 + expected.norm()));
        }
    }
}
