//! Compressible hyperelastic material of Ogden: powers of the principal stretches of the distortion, and the volume
//! (Ogden 1972; Holzapfel, Nonlinear Solid Mechanics, section 6.5). See docs/theory/materials.md.

use super::hyperelastic::Hyperelastic;
use super::invariants::VolumeEnergy;
use super::spectrum::{Spectrum, log_change};
use super::strains::StrainChange;
use super::symmetric::{Symmetric, Tangent};
use super::{LawCard, SmallStrainModuli};

/// Hyperelastic material, `*HYPERELASTIC, OGDEN`.
///
/// For the principal stretches l_i let e_i = ln l_i; then ln J is the sum of the e_i, and d_i = e_i - ln J/3 are the
/// logarithmic strains of the distortion:
///
/// ```text
/// energy   W = sum_k 2 mu_k/alpha_k² (sum_i exp(alpha_k d_i) - 3) + U(J)
/// stress   S = (D ln C) : T,  T = sum_i beta_i n_i x n_i
///          beta_i = dW/de_i = sum_k 2 mu_k/alpha_k (x_ik - sum_j x_jk/3) + J U',   x_ik = exp(alpha_k d_i)
/// tangent  dbeta_i/de_j = sum_k 2 mu_k (x_ik delta_ij - (x_ik + x_jk)/3 + sum_l x_lk/9) + J U' + J² U''
/// domain   J > 0
/// moduli   mu = sum_k mu_k,  K = 2/D1
/// ```
///
/// Small strains keep their digits: the sum of the d_i is zero, so exp(x) - 1 - x is used in place of exp(x).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ogden {
    /// Constants mu_k (force/length^2) and alpha_k of up to three terms; missing terms are zero.
    pub terms: [[f64; 2]; 3],
    /// The energy of the volume.
    pub volume: VolumeEnergy,
}

/// A strain in terms of its principal values.
struct Principal {
    spectrum: Spectrum,
    /// ln J.
    volume: f64,
    /// Logarithmic strains d_i of the distortion.
    shape: [f64; 3],
}

impl Principal {
    fn new(e: &Symmetric) -> Self {
        let spectrum = Spectrum::of_strain(e);
        let logarithms = spectrum.logarithms();
        let volume: f64 = logarithms.iter().sum();
        Principal {
            spectrum,
            volume,
            shape: logarithms.map(|e| e - volume / 3.0),
        }
    }
}

/// The value exp(x) - 1 - x.
fn rest(x: f64) -> f64 {
    if x.abs() > 0.3 {
        return x.exp_m1() - x;
    }
    // sum of x^n/n! from n = 2 on
    let terms = (3..16).rev().map(f64::from);
    x * x / 2.0 * terms.fold(1.0, |sum, n| 1.0 + x / n * sum)
}

impl Ogden {
    /// `*HYPERELASTIC, OGDEN`.
    pub fn cards(&self) -> Vec<LawCard> {
        let count = self.count().max(1);
        let d = self.volume.d;
        let mut constants: Vec<f64> = self.terms[..count].as_flattened().to_vec();
        constants.extend(&d[..count]);
        let rows = constants.chunks(8).map(<[f64]>::to_vec);
        vec![LawCard {
            keyword: "HYPERELASTIC",
            parameter: Some(["OGDEN, N=1", "OGDEN, N=2", "OGDEN, N=3"][count - 1]),
            rows: rows.collect(),
        }]
    }

    /// Number of terms.
    fn count(&self) -> usize {
        let is_term = |[mu, _]: &[f64; 2]| *mu != 0.0;
        self.terms.iter().rposition(is_term).map_or(0, |k| k + 1)
    }

    /// Moduli at small strains, from mu = sum mu_k and K = 2/D1.
    pub fn small_strain(&self) -> SmallStrainModuli {
        let mu = self.terms.iter().map(|[mu, _]| mu).sum();
        SmallStrainModuli::of_shear_and_bulk(mu, 2.0 / self.volume.d[0])
    }

    fn of_terms(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.terms.iter().copied().filter(|[mu, _]| *mu != 0.0)
    }

    /// The derivatives beta_i of the energy, and J U' + J² U''.
    fn slopes(&self, at: &Principal) -> ([f64; 3], f64) {
        let grown = at.volume.exp_m1();
        let ([p, stiff], j) = (self.volume.slopes(grown), 1.0 + grown);
        let mut beta = [j * p; 3];
        for [mu, alpha] in self.of_terms() {
            let x = at.shape.map(|d| (alpha * d).exp_m1());
            let mean = x.iter().sum::<f64>() / 3.0;
            for (beta, x) in beta.iter_mut().zip(x) {
                *beta += 2.0 * mu / alpha * (x - mean);
            }
        }
        (beta, j * (p + j * stiff))
    }

    /// Change of the stress T for a change of the logarithmic strain, both in the principal frame. The off-diagonal
    /// factor of the change of T is (beta_1 - beta_2)/(e_1 - e_2).
    fn stress_change(&self, at: &Principal, of_volume: f64, a: &Symmetric) -> Symmetric {
        let change = [a.x, a.y, a.z];
        let trace = a.x + a.y + a.z;
        let (mut diagonal, mut shear) = ([of_volume * trace; 3], 0.0);
        let apart = at.shape[0] - at.shape[1];
        for [mu, alpha] in self.of_terms() {
            let x = at.shape.map(|d| (alpha * d).exp());
            let along: f64 = x.iter().zip(change).map(|(x, a)| x * a).sum();
            let sum: f64 = x.iter().sum();
            for i in 0..3 {
                let mixed = (x[i] * trace + along) / 3.0 - sum * trace / 9.0;
                diagonal[i] += 2.0 * mu * (x[i] * change[i] - mixed);
            }
            let ratio = match apart == 0.0 {
                true => 1.0,
                false => (alpha * apart).exp_m1() / (alpha * apart),
            };
            shear += 2.0 * mu * x[1] * ratio;
        }
        let [x, y, z] = diagonal;
        Symmetric::new(x, y, z, shear * a.w)
    }
}

/// Changes of the principal values (mean +- radius, 33) of a tensor.
fn principal_change(from: &Symmetric, by: &Symmetric) -> [f64; 3] {
    let half = |a: &Symmetric| [(a.x - a.y) / 2.0, a.w];
    let (start, direction) = (half(from), half(by));
    let end = [start[0] + direction[0], start[1] + direction[1]];
    let both = start[0].hypot(start[1]) + end[0].hypot(end[1]);
    let along = (start[0] + end[0]) * direction[0] + (start[1] + end[1]) * direction[1];
    let radius = if both > 0.0 { along / both } else { 0.0 };
    let mean = (by.x + by.y) / 2.0;
    [mean + radius, mean - radius, by.z]
}

impl Hyperelastic for Ogden {
    /// Stored energy W, eq. (2.50).
    fn energy(&self, e: &Symmetric) -> f64 {
        let at = Principal::new(e);
        let of_term = |[mu, alpha]: [f64; 2]| {
            let sum: f64 = at.shape.iter().map(|d| rest(alpha * d)).sum();
            2.0 * mu / (alpha * alpha) * sum
        };
        self.of_terms().map(of_term).sum::<f64>() + self.volume.energy(at.volume.exp_m1())
    }

    /// Change of the stored energy, W(E1) - W(E0), from the changes of the d_i and of ln J:
    ///
    /// ```text
    /// exp(x1) - exp(x0) = (exp(x0) - 1)(exp(dx) - 1) + (exp(dx) - 1 - dx) + dx,   the sum of the dx is zero
    /// ```
    fn energy_change(&self, change: &StrainChange) -> f64 {
        let StrainChange {
            start: e0,
            end: e1,
            half,
            ..
        } = *change;
        let start = Principal::new(&e0);
        let by = log_change(&(e0 * 2.0), &(e1 * 2.0), &(half * 4.0));
        let from = start.spectrum.logarithmic_strain();
        let principal = principal_change(&from, &by);
        let volume: f64 = principal.iter().sum();
        let shape = principal.map(|e| e - volume / 3.0);
        let of_term = |[mu, alpha]: [f64; 2]| {
            let pairs = start.shape.iter().zip(shape);
            let sum: f64 = pairs
                .map(|(d, by)| (alpha * d).exp_m1() * (alpha * by).exp_m1() + rest(alpha * by))
                .sum();
            2.0 * mu / (alpha * alpha) * sum
        };
        let grown = [start.volume, start.volume + volume].map(f64::exp_m1);
        let dj = (1.0 + grown[0]) * volume.exp_m1();
        self.of_terms().map(of_term).sum::<f64>() + dj * self.volume.quotient(grown[0], grown[1])
    }

    /// Stress S = (D ln C) : T, eq. (2.50).
    fn stress(&self, e: &Symmetric) -> Symmetric {
        let at = Principal::new(e);
        let ([x, y, z], _) = self.slopes(&at);
        let t = at.spectrum.back(&Symmetric::new(x, y, z, 0.0));
        at.spectrum.log_derivative(&t)
    }

    fn tangent(&self, e: &Symmetric) -> Tangent {
        let at = Principal::new(e);
        let ([x, y, z], of_volume) = self.slopes(&at);
        let spectrum = &at.spectrum;
        let t = spectrum.back(&Symmetric::new(x, y, z, 0.0));
        spectrum.tangent(&t, |strain| {
            spectrum.back(&self.stress_change(&at, of_volume, &spectrum.to(strain)))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::{NeoHooke, PlaneStress, Polynomial};

    const OGDEN: Ogden = Ogden {
        terms: [[300.0, 1.3], [1.2, 5.0], [10.0, -2.0]],
        volume: VolumeEnergy {
            d: [2e-3, 0.0, 3e-2],
        },
    };

    fn strains() -> [Symmetric; 5] {
        [
            Symmetric::zeros(),
            Symmetric::new(0.2, -0.1, 0.3, 0.15),
            Symmetric::new(-0.3, 0.9, -0.2, 0.2),
            // equal principal values
            Symmetric::new(0.4, 0.4, 0.4, 0.0),
            Symmetric::new(1e-9, -2e-9, 3e-9, 1e-9),
        ]
    }

    #[test]
    fn of_the_power_two_it_is_the_neo_hookean_material_and_with_minus_two_that_of_mooney() {
        // W = mu/2 (I1/a - 3) and mu/2 (I2/a² - 3)
        let volume = VolumeEnergy {
            d: [2e-3, 0.0, 0.0],
        };
        let pairs: [(Ogden, Box<dyn Hyperelastic>); 2] = [
            (
                Ogden {
                    terms: [[400.0, 2.0], [0.0; 2], [0.0; 2]],
                    volume,
                },
                Box::new(NeoHooke {
                    c10: 200.0,
                    d1: 2e-3,
                }),
            ),
            (
                Ogden {
                    terms: [[300.0, 2.0], [100.0, -2.0], [0.0; 2]],
                    volume,
                },
                Box::new(Polynomial {
                    shape: [150.0, 0.0, 0.0],
                    c01: 50.0,
                    d: [2e-3, 0.0, 0.0],
                }),
            ),
        ];
        for (ogden, other) in pairs {
            for e in strains() {
                let c = other.tangent(&e).matrix();
                let difference = (ogden.stress(&e) - other.stress(&e)).norm();
                assert!(difference <= 1e-13 * (other.stress(&e).norm() + e.norm() * c.norm()));
                assert!((ogden.tangent(&e).matrix() - c).norm() < 1e-12 * c.norm());
                let (own, exact) = (ogden.energy(&e), other.energy(&e));
                assert!((own - exact).abs() <= 1e-13 * exact, "{own} {exact}");
                for f in strains() {
                    let change = StrainChange::between(&e, &f);
                    let [own, exact] = [ogden.energy_change(&change), other.energy_change(&change)];
                    let scale = other.energy(&e).max(other.energy(&f));
                    assert!((own - exact).abs() <= 2e-14 * scale, "{own} {exact}");
                }
            }
        }
    }

    #[test]
    fn stress_and_tangent_are_derivatives() {
        let h = 1e-6;
        for e in strains() {
            let c = OGDEN.tangent(&e).matrix();
            let found = Tangent::of_columns(|unit| {
                let [ahead, behind] = [h, -h].map(|h| OGDEN.stress(&(e + *unit * h)));
                (ahead - behind) / (2.0 * h)
            });
            assert!((found.matrix() - c).norm() < 1e-8 * c.norm(), "{e:?}");
            let direction = Symmetric::new(0.3, -0.2, 0.4, 0.5);
            let change = StrainChange::about(e, direction * h);
            let slope = OGDEN.energy_change(&change) / (2.0 * h);
            let work = OGDEN.stress(&e).contract::<true>(&direction);
            assert!((slope - work).abs() < 1e-9 * c.norm(), "{slope} {work}");
        }
    }

    #[test]
    fn changes_of_energy_keep_their_digits() {
        let (e0, direction) = (
            Symmetric::new(0.2, -0.1, 0.3, 0.15),
            Symmetric::new(-0.4, 0.3, 0.5, 0.2),
        );
        for size in [0.5, 1e-3, 1e-6, 1e-9, 1e-12] {
            let half = direction * (size / 2.0);
            let change = StrainChange::about(e0 + half, half);
            let exact = OGDEN
                .stress(&change.mean)
                .contract::<true>(&change.change());
            let found = OGDEN.energy_change(&change);
            let bound = 10.0 * size * size + 1e-13;
            assert!(
                (found / exact - 1.0).abs() < bound,
                "{size}: {found} {exact}"
            );
        }
        let moduli = OGDEN.small_strain();
        let linear: &dyn Hyperelastic = &crate::materials::SaintVenantKirchhoff {
            young: moduli.young,
            poisson: moduli.poisson,
        }
        .in_plane(crate::materials::Plane::Strain);
        let e = Symmetric::new(3.0, 2.0, 0.0, -1.0) * 1e-14;
        let (w, exact) = (OGDEN.energy(&e), linear.energy(&e));
        assert!((w - exact).abs() < 1e-12 * exact, "{w} {exact}");
        let change = OGDEN.energy_change(&StrainChange::between(&e, &(e * 3.0)));
        assert!((change - 8.0 * exact).abs() < 1e-11 * exact);
    }

    #[test]
    fn uniaxial_and_equibiaxial_stress_in_closed_form() {
        // free of stress across: at every volume ratio, with l_1 = l and l_2 = l_3 = sqrt(J/l), or l_1 = l_2 = l
        let law = OGDEN;
        let poisson = law.small_strain().poisson;
        let plane: &dyn Hyperelastic = &PlaneStress { law, poisson };
        for l in [0.7_f64, 1.0, 1.4, 2.5] {
            let e = (l * l - 1.0) / 2.0;
            let both = Symmetric::new(e, e, 0.0, 0.0);
            let side = (1.0 + 2.0 * plane.strain_across(&both)).sqrt();
            let j = l * l * side;
            let shape = |l: f64| l / j.cbrt();
            // beta_1 - beta_3 = sum 2 mu/alpha (x_1 - x_3), beta_3 = 0
            let of = |[mu, alpha]: [f64; 2]| {
                2.0 * mu / alpha * (shape(l).powf(alpha) - shape(side).powf(alpha))
            };
            let exact: f64 = law.terms.iter().copied().map(of).sum();
            let found = plane.stress(&both);
            assert!((found.x * l * l - exact).abs() < 1e-9 * exact.abs().max(1.0));
            assert!((found.y - found.x).abs() < 1e-12 * exact.abs().max(1.0));
        }
    }
}
