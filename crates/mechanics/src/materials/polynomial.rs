//! Compressible hyperelastic materials of Mooney-Rivlin and Yeoh: polynomials of the invariants of the distortion, and
//! of the volume (Holzapfel, Nonlinear Solid Mechanics, sections 6.4 to 6.6; Yeoh 1990). See docs/theory/materials.md.

use super::invariants::{InvariantEnergy, VolumeEnergy};
use super::number::Number;
use super::{LawCard, NeoHooke, SmallStrainModuli};

/// Hyperelastic material, `*HYPERELASTIC` with `MOONEY-RIVLIN` or `YEOH`.
///
/// In terms of the invariants x and y of [`InvariantEnergy`] the energy is:
///
/// ```text
/// energy   W = w(x) + C01 y + U(J),   w = C10 x + C20 x² + C30 x³,   U = sum_i (J - 1)^2i/D_i
/// domain   J > 0
/// moduli   mu = 2 (C10 + C01),  K = 2/D1
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Polynomial {
    /// Factors C10, C20, C30 of x, x², x³ (force/length^2).
    pub shape: [f64; 3],
    /// Factor C01 of y (force/length^2).
    pub c01: f64,
    /// Constants D1, D2, D3 of the terms (J - 1)², (J - 1)^4, (J - 1)^6 (length^2/force); D1 is positive, and a
    /// constant of zero means that there is no such term.
    pub d: [f64; 3],
}

impl From<NeoHooke> for Polynomial {
    fn from(NeoHooke { c10, d1 }: NeoHooke) -> Self {
        Polynomial {
            shape: [c10, 0.0, 0.0],
            c01: 0.0,
            d: [d1, 0.0, 0.0],
        }
    }
}

impl Polynomial {
    /// `*HYPERELASTIC, MOONEY-RIVLIN`, or `YEOH` if C01 is zero.
    pub fn cards(&self) -> Vec<LawCard> {
        let ([c10, c20, c30], [d1, d2, d3]) = (self.shape, self.d);
        let (form, row) = match self.c01 != 0.0 {
            true => ("MOONEY-RIVLIN", vec![c10, self.c01, d1]),
            false => ("YEOH", vec![c10, c20, c30, d1, d2, d3]),
        };
        vec![LawCard {
            keyword: "HYPERELASTIC",
            parameter: Some(form),
            rows: vec![row],
        }]
    }

    /// Moduli at small strains, from mu = 2 (C10 + C01) and K = 2/D1.
    pub fn small_strain(&self) -> SmallStrainModuli {
        SmallStrainModuli::of_shear_and_bulk(2.0 * (self.shape[0] + self.c01), 2.0 / self.d[0])
    }
}

impl InvariantEnergy for Polynomial {
    const LINEAR: bool = false;
    const SECOND: bool = true;

    #[inline(always)]
    fn c01(&self) -> f64 {
        self.c01
    }

    #[inline(always)]
    fn shape<T: Number>(&self, x: T) -> T {
        let [c10, c20, c30] = self.shape;
        x * (x * (x * c30 + c20) + c10)
    }

    #[inline(always)]
    fn shape_slopes<T: Number>(&self, x: T) -> [T; 2] {
        let [c10, c20, c30] = self.shape;
        [
            x * (x * (3.0 * c30) + 2.0 * c20) + c10,
            x * (6.0 * c30) + 2.0 * c20,
        ]
    }

    #[inline(always)]
    fn shape_quotient<T: Number>(&self, x0: T, x1: T) -> T {
        let [c10, c20, c30] = self.shape;
        (x1 + x0) * c20 + (x1 * x1 + x1 * x0 + x0 * x0) * c30 + c10
    }

    #[inline(always)]
    fn volume(&self) -> VolumeEnergy {
        VolumeEnergy { d: self.d }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::{Hyperelastic, PlaneStress, Symmetric};
    use nalgebra::Matrix2;

    /// A material with mu = 400 and K = 1000.
    const MOONEY_RIVLIN: Polynomial = Polynomial {
        shape: [150.0, 0.0, 0.0],
        c01: 50.0,
        d: [2e-3, 0.0, 0.0],
    };
    const YEOH: Polynomial = Polynomial {
        shape: [200.0, -20.0, 5.0],
        c01: 0.0,
        d: [2e-3, 1e-2, 3e-2],
    };
    const NEO_HOOKE: NeoHooke = NeoHooke {
        c10: 200.0,
        d1: 2e-3,
    };

    fn laws() -> [Polynomial; 3] {
        [NEO_HOOKE.into(), MOONEY_RIVLIN, YEOH]
    }

    fn strain(f: &Matrix2<f64>) -> Symmetric {
        Symmetric::of_plane(&((f.transpose() * f - Matrix2::identity()) / 2.0), 0.0)
    }

    fn strains() -> [Symmetric; 3] {
        [
            Matrix2::new(1.0, 0.0, 0.0, 1.0),
            Matrix2::new(1.4, 0.3, -0.5, 0.8),
            Matrix2::new(0.5, 0.4, 0.1, 0.9),
        ]
        .map(|f| strain(&f))
    }

    #[test]
    fn with_one_constant_it_is_the_neo_hookean_material() {
        let (law, own): (Polynomial, &dyn Hyperelastic) = (NEO_HOOKE.into(), &NEO_HOOKE);
        let law: &dyn Hyperelastic = &law;
        for e in strains() {
            let c = own.tangent(&e).matrix();
            assert!((law.stress(&e) - own.stress(&e)).norm() < 1e-13 * c.norm());
            assert!((law.tangent(&e).matrix() - c).norm() < 1e-13 * c.norm());
            assert!((law.energy(&e) - own.energy(&e)).abs() <= 1e-13 * c.norm());
        }
    }

    #[test]
    fn simple_shear_in_closed_form() {
        // F = I + g e_x e_y: I1 = I2 = 3 + g², J = 1, sigma_xy = 2 (w' + C01) g
        let g = 0.7_f64;
        let f = Matrix2::new(1.0, g, 0.0, 1.0);
        for law in laws() {
            let plane: &dyn Hyperelastic = &law;
            let [c10, c20, c30] = law.shape;
            let x = g * g;
            let energy = x * (c10 + x * (c20 + x * c30)) + law.c01 * x;
            assert!((plane.energy(&strain(&f)) - energy).abs() < 1e-12 * energy);
            let slope = c10 + x * (2.0 * c20 + x * 3.0 * c30) + law.c01;
            let sigma = f * plane.stress(&strain(&f)).in_plane() * f.transpose();
            assert!((sigma.m12 - 2.0 * slope * g).abs() < 1e-12 * energy);
        }
    }

    fn bar(l: f64, side: f64) -> Symmetric {
        Symmetric::new((l * l - 1.0) / 2.0, (side * side - 1.0) / 2.0, 0.0, 0.0)
    }

    #[test]
    fn uniaxial_and_biaxial_tension_of_an_incompressible_material() {
        // K/mu = 1e4: nominal stress of stretch l is 2 (w' + C01/l) (l - l^-2), of equal stretches 2 (w' + C01 l²) (l - l^-5)
        for law in [MOONEY_RIVLIN, YEOH] {
            let mu = 2.0 * (law.shape[0] + law.c01);
            let law = Polynomial {
                d: [2.0 / (1e4 * mu), 0.0, 0.0],
                ..law
            };
            let [c10, c20, c30] = law.shape;
            let slope = |x: f64| c10 + x * (2.0 * c20 + x * 3.0 * c30);
            let poisson = law.small_strain().poisson;
            let plane: &dyn Hyperelastic = &PlaneStress { law, poisson };
            for l in [0.8_f64, 1.5] {
                let x = 2.0 * l * l + l.powi(-4) - 3.0;
                let biaxial = 2.0 * (slope(x) + law.c01 * l * l) * (l - l.powi(-5));
                let strain = (l * l - 1.0) / 2.0;
                let s = plane.stress(&Symmetric::new(strain, strain, 0.0, 0.0));
                assert!(
                    (s.x * l / biaxial - 1.0).abs() < 3e-4,
                    "{law:?} {l} {}",
                    s.x * l / biaxial - 1.0
                );
            }
            for l in [0.5_f64, 1.5] {
                // the lateral stretch of a bar without lateral stress, by Newton's method
                let mut side = 1.0 / l.sqrt();
                for _ in 0..50 {
                    let e = bar(l, side);
                    side -= plane.stress(&e).y / (plane.tangent(&e).0[1][1] * side);
                }
                let e = bar(l, side);
                let s = plane.stress(&e);
                let x = l * l + 2.0 / l - 3.0;
                let expected = 2.0 * (slope(x) + law.c01 / l) * (l - 1.0 / (l * l));
                assert!(
                    (s.x * l / expected - 1.0).abs() < 1e-4,
                    "{law:?} {l} {}",
                    s.x * l / expected - 1.0
                );
                let across = plane.across(&e);
                assert!((across.stretch - side).abs() < 1e-12, "isotropic");
            }
        }
    }
}
