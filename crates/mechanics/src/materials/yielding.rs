//! A law with internal variables, for tests of the state at integration points: associated plasticity with a hardening
//! that saturates, solved by a local return mapping (Simo & Hughes, Computational Inelasticity, section 3.3).

use super::hyperelastic::{corrected_stress, corrected_tangent};
use super::strains::Strains;
use super::symmetric::{Symmetric, Tangent, dyad};
use super::{Across, Flow, SmallStrainModuli, StrainMeasure};

/// The law is elastic up to a yield stress that grows with the accumulated plastic strain a:
///
/// ```text
/// S = G (E - Z),  W = G/2 (E - Z):(E - Z) + U(a),  |S| <= G Y + R(a)
/// R = U' = r (1 - exp(-a/c)),  U = r (a - c (1 - exp(-a/c)))
/// ```
///
/// The internal variables are Z_xx, Z_yy, Z_xy and a; the strain 33 of a ring stays elastic.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Yielding {
    /// Modulus G (force/length^2).
    pub g: f64,
    /// Largest elastic strain Y without hardening.
    pub y: f64,
    /// Largest growth r of the yield stress (force/length^2).
    pub r: f64,
    /// Plastic strain c within which most of the growth is reached.
    pub c: f64,
}

/// The plastic strain Z.
pub fn plastic(z: &[f64]) -> Symmetric {
    Symmetric::new(z[0], z[1], 0.0, z[2])
}

/// Product A:B over the components that flow.
fn in_plane(a: &Symmetric, b: &Symmetric) -> f64 {
    a.contract::<false>(b)
}

/// Result of a return mapping.
struct Returned {
    stress: Symmetric,
    /// Algorithmic tangent dS/dE.
    tangent: Tangent,
    /// Increments dZ of the plastic strain and da of the accumulated plastic strain.
    flow: Symmetric,
    slip: f64,
}

impl Yielding {
    /// Moduli at small strains: lambda = 0 and mu = G/2.
    pub fn small_strain(&self) -> SmallStrainModuli {
        SmallStrainModuli {
            young: self.g,
            poisson: 0.0,
        }
    }

    /// Hardening R(a) and its derivative R'(a).
    fn hardening(&self, a: f64) -> [f64; 2] {
        let left = (-a / self.c).exp();
        [self.r * (1.0 - left), self.r * left / self.c]
    }

    /// U(a).
    fn hardening_energy(&self, a: f64) -> f64 {
        self.r * (a + self.c * (-a / self.c).exp_m1())
    }

    /// Return from the trial stress S* = G (E - Z0) along n = S*/|S*| to the yield surface. Newton's method solves
    /// phi = |S*| - G da - G Y - R(a0 + da) = 0; phi is concave in -da, so every step stays on one side.
    ///
    /// ```text
    /// dZ = da n,   dS/dE = G n n/(1 + G/R') + (1 - G da/|S*|) G (I - n n)
    /// ```
    fn returned(&self, e: &Symmetric, z0: &[f64]) -> Returned {
        let trial = (*e - plastic(z0)) * self.g;
        let size = in_plane(&trial, &trial).sqrt();
        let beyond = |slip: f64| size - self.g * (slip + self.y) - self.hardening(z0[3] + slip)[0];
        let mut slip = 0.0;
        if beyond(0.0) > 0.0 {
            for _ in 0..50 {
                let step = beyond(slip) / (self.g + self.hardening(z0[3] + slip)[1]);
                slip += step;
                if step <= f64::EPSILON * slip {
                    break;
                }
            }
        }
        let identity = |i: usize, j: usize| match i == j {
            true => [1.0, 1.0, 1.0, 0.5][i],
            false => 0.0,
        };
        let elastic = Returned {
            stress: trial,
            tangent: Tangent::of(|i, j| identity(i, j) * self.g),
            flow: Symmetric::zeros(),
            slip,
        };
        if slip <= 0.0 {
            return elastic;
        }
        let n = Symmetric { z: 0.0, ..trial } / size;
        let along = dyad(&n, &n);
        let slope = self.hardening(z0[3] + slip)[1];
        let across = self.g * (1.0 - self.g * slip / size);
        let tangent = |i: usize, j: usize| match i == 2 || j == 2 {
            true => identity(i, j) * self.g,
            false => {
                let stiff = along[i][j] * (self.g * slope / (self.g + slope));
                stiff + (identity(i, j) - along[i][j]) * across
            }
        };
        Returned {
            stress: trial - n * (self.g * slip),
            tangent: Tangent::of(tangent),
            flow: n * slip,
            slip,
        }
    }

    /// The stress at the start of an increment.
    fn start(&self, e0: &Symmetric, z0: &[f64]) -> Symmetric {
        (*e0 - plastic(z0)) * self.g
    }
}

impl Flow for Yielding {
    fn variables(&self) -> usize {
        4
    }

    fn update(&self, strains: &Strains, z0: &[f64], z1: &mut [f64]) {
        let end = self.returned(&strains.end(), z0);
        let z = plastic(z0) + end.flow;
        z1.copy_from_slice(&[z.x, z.y, z.w, z0[3] + end.slip]);
    }

    /// Between two strains the stress is (S0 + S1)/2 plus the correction for W1 - W0 + D - S:dE = (S1 - S0):dZ/2, eq.
    /// (4.8).
    fn stress(&self, strains: &Strains, z0: &[f64]) -> Symmetric {
        let end = self.returned(&strains.end(), z0);
        let Strains::Between(change) = strains else {
            return end.stress;
        };
        let start = self.start(&change.start, z0);
        let mean = (start + end.stress) / 2.0;
        let f = in_plane(&(end.stress - start), &end.flow) / 2.0;
        corrected_stress::<f64, true>(&mean, &change.change(), f)
    }

    /// The derivative of the stress uses dZ/dE = I - (dS/dE)/G.
    fn tangent(&self, strains: &Strains, z0: &[f64]) -> Tangent {
        let end = self.returned(&strains.end(), z0);
        let Strains::Between(change) = strains else {
            return end.tangent;
        };
        let of_stress = end.stress - self.start(&change.start, z0);
        let of_stress = Symmetric {
            z: 0.0,
            ..of_stress
        };
        let times = |e: &Symmetric| end.tangent.times::<true>(e);
        let g = times(&end.flow) + of_stress - times(&of_stress) / self.g;
        let f = in_plane(&of_stress, &end.flow) / 2.0;
        corrected_tangent::<f64, true>(&end.tangent, &change.change(), (f, &(g / 2.0)))
    }

    fn stored_energy(&self, e: &Symmetric, z: &[f64]) -> f64 {
        let elastic = (*e - plastic(z)).norm();
        elastic * elastic * self.g / 2.0 + self.hardening_energy(z[3])
    }

    /// Dissipated energy D = S1:dZ - (U1 - U0).
    fn dissipation(&self, strains: &Strains, z0: &[f64]) -> f64 {
        let end = self.returned(&strains.end(), z0);
        let stored = self.hardening_energy(z0[3] + end.slip) - self.hardening_energy(z0[3]);
        in_plane(&end.stress, &end.flow) - stored
    }

    fn across(&self, _e: &Symmetric, _z: &[f64]) -> Across {
        Across {
            stretch: 1.0,
            stress: 0.0,
        }
    }

    fn plastic_strain(&self, _z: &[f64]) -> f64 {
        0.0
    }

    fn convex_in(&self) -> StrainMeasure {
        StrainMeasure::Green
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: Yielding = Yielding {
        g: 50.0,
        y: 0.02,
        r: 0.7,
        c: 0.03,
    };

    fn strain(xx: f64, yy: f64, xy: f64) -> Symmetric {
        Symmetric::new(xx, yy, 0.0, xy)
    }

    /// Stress and the internal variables of the iterate.
    fn stress(strains: &Strains, z0: &[f64]) -> (Symmetric, [f64; 4]) {
        let mut z1 = [0.0; 4];
        LAW.update(strains, z0, &mut z1);
        (LAW.stress(strains, z0), z1)
    }

    #[test]
    fn the_stress_of_the_iterate_is_on_its_yield_surface() {
        let z0 = [0.01, -0.02, 0.005, 0.03];
        let (s, z1) = stress(&Strains::At(strain(0.08, 0.0, 0.04)), &z0);
        let yield_stress = LAW.g * LAW.y + LAW.r * (1.0 - (-z1[3] / LAW.c).exp());
        assert!(z1[3] > z0[3] + 0.03 && (s.norm() - yield_stress).abs() < 1e-13 * yield_stress);
        // at the strain that it has reached the law is elastic
        let (again, z2) = stress(&Strains::At(strain(0.08, 0.0, 0.04)), &z1);
        assert!((again - s).norm() < 1e-13 * s.norm());
        assert!(z1.iter().zip(z2).all(|(a, b)| (a - b).abs() < 1e-15));
    }

    #[test]
    fn the_tangent_is_the_symmetric_part_of_the_derivative() {
        let (z0, e0) = ([0.01, -0.02, 0.005, 0.01], strain(0.02, -0.01, 0.01));
        let elastic = e0 + strain(0.004, 0.002, 0.001);
        for end in [strain(0.08, 0.0, 0.04), strain(-0.05, 0.01, 0.02), elastic] {
            let at: &dyn Fn(Symmetric) -> Strains = &Strains::At;
            let between: &dyn Fn(Symmetric) -> Strains = &|e| Strains::between(&e0, &e);
            for (strains, factor) in [(at, 1.0), (between, 2.0)] {
                let exact = Tangent::of_columns(|unit| {
                    let s = |h: f64| stress(&strains(end + *unit * h), &z0).0;
                    (s(1e-6) - s(-1e-6)) / 2e-6 * factor
                })
                .matrix();
                let symmetric = (exact + exact.transpose()) / 2.0;
                let found = LAW.tangent(&strains(end), &z0).matrix();
                assert!((found - symmetric).norm() < 1e-7 * exact.norm());
            }
        }
    }

    #[test]
    fn a_long_way_back_dissipates_too() {
        // from yield in one direction to yield in the other, in one increment
        let (_, z0) = stress(&Strains::At(strain(0.1, 0.0, 0.0)), &[0.0; 4]);
        let strains = Strains::between(&strain(0.1, 0.0, 0.0), &strain(-0.2, 0.0, 0.0));
        assert!(LAW.dissipation(&strains, &z0) > LAW.g * LAW.y * 0.1);
    }
}
