//! Potential of the hourglass modes of an element with one strain: elastic, and limited where the material is a metal, which
//! would carry moments of any size otherwise. Section 2 of docs/theory.md, Hourglass modes of metals.

use nalgebra::{SMatrix, SVector};

/// Factor of the limit, of the moment that a section carries when all of it flows beside that at its first yield.
const FULL_SECTION: f64 = 1.5;
/// Least part of the limit that is left where the strain of the element uses all of the yield stress.
const LEAST_PART: f64 = 0.05;

/// Amplitudes of the modes in a motion.
#[derive(Debug, Clone, Copy)]
pub(super) enum Amplitudes<const M: usize> {
    /// At one configuration.
    At(SVector<f64, M>),
    /// At the start and at the end of an increment.
    Between(SVector<f64, M>, SVector<f64, M>),
    /// The same, of a viscosity.
    Change(SVector<f64, M>, SVector<f64, M>),
}

impl<const M: usize> Amplitudes<M> {
    /// Those at the end.
    pub fn end(&self) -> &SVector<f64, M> {
        match self {
            Amplitudes::At(y) | Amplitudes::Between(_, y) | Amplitudes::Change(_, y) => y,
        }
    }
}

/// The potential: with x = y - y_p and s² = x.Kh x, s²/2 up to s = s_y and s_y (s - s_y/2) beyond, eq. (2.47).
#[derive(Debug, Clone, Copy)]
pub(super) struct HourglassPotential<const M: usize> {
    /// Kh (energy over the square of the amplitudes).
    stiffness: SMatrix<f64, M, M>,
    /// y_p, the amplitudes that have flown.
    flown: SVector<f64, M>,
    /// s_y² (energy); infinite in elastic materials.
    limit: f64,
}

/// Internal variables of the modes: y_p, and the part of its strength that the element uses.
pub(super) const fn variables(modes: usize) -> usize {
    modes + 1
}

/// s_y² of an element with a volume and a modulus E' of its plane, where the strain uses a part of the yield stress. It is
/// kept as an energy: the root of one has other bits in units that differ by a power of two.
///
/// ```text
/// s_y = 3/2 max(1/20, 1 - used²) sigma_y sqrt(V/(3 E'))
/// ```
fn limit(yield_stress: f64, used: f64, volume: f64, modulus: f64) -> f64 {
    let part = (1.0 - used * used).max(LEAST_PART);
    let stress = FULL_SECTION * part * yield_stress;
    stress * stress * volume / (3.0 * modulus)
}

impl<const M: usize> HourglassPotential<M> {
    /// That of a stiffness Kh, for an element with a volume and a modulus E' of its plane (force/length^2); `yielding` has the
    /// yield stress of a metal and the variables of the modes.
    pub fn new(
        stiffness: SMatrix<f64, M, M>,
        [volume, modulus]: [f64; 2],
        yielding: Option<(f64, &[f64])>,
    ) -> Self {
        match yielding {
            None => HourglassPotential {
                stiffness,
                flown: SVector::zeros(),
                limit: f64::INFINITY,
            },
            Some((yield_stress, own)) => HourglassPotential {
                stiffness,
                flown: SVector::from_fn(|k, _| own[k]),
                limit: limit(yield_stress, own[M], volume, modulus),
            },
        }
    }

    /// s/s_y at some amplitudes, and Kh x.
    fn size(&self, y: &SVector<f64, M>) -> (f64, SVector<f64, M>) {
        let x = y - self.flown;
        let stress = self.stiffness * x;
        ((stress.dot(&x).max(0.0) / self.limit).sqrt(), stress)
    }

    /// Stress f = d Phi/dy.
    fn stress_at(&self, y: &SVector<f64, M>) -> SVector<f64, M> {
        let (size, stress) = self.size(y);
        if size <= 1.0 { stress } else { stress / size }
    }

    /// Kh, or s_y/s (Kh - Kh x x Kh/s²) beyond the limit.
    fn tangent_at(&self, y: &SVector<f64, M>) -> SMatrix<f64, M, M> {
        let (size, stress) = self.size(y);
        if size <= 1.0 {
            return self.stiffness;
        }
        let along = stress * stress.transpose() / (size * size * self.limit);
        (self.stiffness - along) / size
    }

    fn energy_at(&self, y: &SVector<f64, M>) -> f64 {
        let (size, stress) = self.size(y);
        if size <= 1.0 {
            stress.dot(&(y - self.flown)) / 2.0
        } else {
            self.limit * (size - 0.5)
        }
    }

    /// Phi(y1) - Phi(y0) without loss of digits where one is beyond the limit: with s1 - s0 = dy.Kh (x0 + x1)/(s0 + s1),
    ///
    /// ```text
    /// s_y (s1 - s0) - (max(s_y - s0, 0)² - max(s_y - s1, 0)²)/2
    /// ```
    ///
    /// `None` where both are within.
    fn change(&self, y0: &SVector<f64, M>, y1: &SVector<f64, M>) -> Option<f64> {
        let ((s0, f0), (s1, f1)) = (self.size(y0), self.size(y1));
        if s0.max(s1) <= 1.0 {
            return None;
        }
        let change = (f0 + f1).dot(&(y1 - y0)) / (s0 + s1);
        let [below0, below1] = [s0, s1].map(|s| (1.0 - s).max(0.0));
        Some(change - self.limit * (below0 * below0 - below1 * below1) / 2.0)
    }

    /// Stress that does work on the amplitudes, and the energy, or the work between two configurations: with n = y1 - y0,
    ///
    /// ```text
    /// f = f(y_m) + phi/(n.Kh n) Kh n,  phi = Phi(y1) - Phi(y0) - f(y_m).n
    /// ```
    pub fn stress(&self, amplitudes: &Amplitudes<M>) -> (SVector<f64, M>, f64) {
        match amplitudes {
            Amplitudes::At(y) => (self.stress_at(y), self.energy_at(y)),
            Amplitudes::Change(y0, y1) => {
                let stress = self.stiffness * (y1 - y0) / 2.0;
                (stress, stress.dot(&(y1 - y0)))
            }
            Amplitudes::Between(y0, y1) => {
                let n = y1 - y0;
                let stress = match self.correction(y0, y1) {
                    None => self.stiffness * (y0 + y1 - self.flown * 2.0) / 2.0,
                    Some((phi, squared)) => {
                        self.stress_at(&((y0 + y1) / 2.0)) + self.stiffness * n * (phi / squared)
                    }
                };
                (stress, stress.dot(&n))
            }
        }
    }

    /// phi and n.Kh n; none where both ends are within the limit.
    fn correction(&self, y0: &SVector<f64, M>, y1: &SVector<f64, M>) -> Option<(f64, f64)> {
        let change = self.change(y0, y1)?;
        let n = y1 - y0;
        let squared = n.dot(&(self.stiffness * n));
        let stress = self.stress_at(&((y0 + y1) / 2.0));
        let phi = change - stress.dot(&n);
        Some(if squared > 0.0 {
            (phi, squared)
        } else {
            (0.0, 1.0)
        })
    }

    /// Tangent of [`Self::stress`], or the symmetric part of twice its derivative by y1: with m = Kh n, N = n.m and
    /// g = f(y1) - f(y_m) - C(y_m) n/2,
    ///
    /// ```text
    /// C(y_m) + 2 phi/N (Kh - 2 m m/N) + (m g + g m)/N
    /// ```
    pub fn tangent(&self, amplitudes: &Amplitudes<M>) -> SMatrix<f64, M, M> {
        match amplitudes {
            Amplitudes::At(y) => self.tangent_at(y),
            Amplitudes::Change(..) => self.stiffness,
            Amplitudes::Between(y0, y1) => {
                let Some((phi, squared)) = self.correction(y0, y1) else {
                    return self.stiffness;
                };
                let (mean, n) = ((y0 + y1) / 2.0, y1 - y0);
                let c = self.tangent_at(&mean);
                let m = self.stiffness * n;
                let g = self.stress_at(y1) - self.stress_at(&mean) - c * n / 2.0;
                let mixed = m * g.transpose();
                c + (self.stiffness - m * m.transpose() * (2.0 / squared)) * (2.0 * phi / squared)
                    + (mixed + mixed.transpose()) / squared
            }
        }
    }

    /// Writes the variables at the end of an increment, where the element has a yield stress and uses a part of it, and
    /// returns what is dissipated: y_p returns to the limit of the increment, then to that of its end, eq. (2.48).
    pub fn update(
        &self,
        end: &SVector<f64, M>,
        [volume, modulus]: [f64; 2],
        [yield_stress, used]: [f64; 2],
        updated: &mut [f64],
    ) -> f64 {
        let (size, _) = self.size(end);
        let next = limit(yield_stress, used, volume, modulus);
        let left = size.min(1.0).min((next / self.limit).sqrt());
        let flown = match left < size {
            true => end - (end - self.flown) * (left / size),
            false => self.flown,
        };
        updated[..M].copy_from_slice(flown.as_slice());
        updated[M] = used;
        match left < size {
            true => self.energy_at(end) - self.limit * left * left / 2.0,
            false => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix2, Vector2};

    const SIZES: [f64; 2] = [0.7, 1000.0];

    fn potential(limit: f64) -> HourglassPotential<2> {
        HourglassPotential {
            stiffness: Matrix2::new(3.0, 0.4, 0.4, 2.0),
            flown: Vector2::new(0.02, -0.01),
            limit: limit * limit,
        }
    }

    /// Amplitudes within and beyond a limit of 0.1.
    fn ends() -> Vec<[Vector2<f64>; 2]> {
        let (within, beyond) = (Vector2::new(0.03, 0.01), Vector2::new(0.2, -0.15));
        let far = Vector2::new(0.25, 0.3);
        let near = beyond + Vector2::new(1e-9, 2e-9);
        vec![
            [within, within * 1.5],
            [within, beyond],
            [beyond, within],
            [beyond, far],
            [beyond, near],
        ]
    }

    #[test]
    fn stress_is_the_derivative_and_does_exactly_the_work_of_the_potential() {
        let own = potential(0.1);
        for [y0, y1] in ends() {
            let (stress, work) = own.stress(&Amplitudes::Between(y0, y1));
            let change = own.energy_at(&y1) - own.energy_at(&y0);
            assert!((work - change).abs() < 1e-16, "{work} {change}");
            assert!((stress.dot(&(y1 - y0)) - work).abs() < 1e-16);
            let quotient = |f: &dyn Fn(Vector2<f64>) -> f64, k: usize| {
                let mut h = Vector2::zeros();
                h[k] = 1e-6;
                (f(y1 + h) - f(y1 - h)) / 2e-6
            };
            let (at, k) = (own.stress_at(&y1), own.tangent_at(&y1));
            for j in 0..2 {
                assert!((quotient(&|y| own.energy_at(&y), j) - at[j]).abs() < 1e-8);
                for i in 0..2 {
                    assert!((quotient(&|y| own.stress_at(&y)[i], j) - k[(i, j)]).abs() < 1e-8);
                }
            }
            if (y1 - y0).norm() > 1e-3 {
                let k = own.tangent(&Amplitudes::Between(y0, y1));
                let stress = |y: Vector2<f64>| own.stress(&Amplitudes::Between(y0, y)).0;
                let slope = Matrix2::from_fn(|i, j| 2.0 * quotient(&|y| stress(y)[i], j));
                let symmetric = (slope + slope.transpose()) / 2.0;
                assert!((symmetric - k).norm() < 1e-7, "{symmetric} {k}");
            }
        }
    }

    #[test]
    fn what_the_update_dissipates_is_missing_in_the_stored_energy() {
        for [y0, y1] in ends() {
            let own = potential(limit(2.0, 0.0, SIZES[0], SIZES[1]).sqrt());
            let mut updated = [0.0; 3];
            let dissipated = own.update(&y1, SIZES, [2.1, 0.6], &mut updated);
            let after = HourglassPotential::new(own.stiffness, SIZES, Some((2.1, &updated)));
            assert!(dissipated >= 0.0 && after.size(&y1).0 <= 1.0 + 1e-14);
            let missing = own.energy_at(&y1) - after.energy_at(&y1);
            assert!(
                (missing - dissipated).abs() < 1e-15,
                "{y0} {missing} {dissipated}"
            );
        }
    }

    #[test]
    fn units_that_differ_by_a_power_of_two_change_no_bit() {
        let k = Matrix2::new(3.0, 0.4, 0.4, 2.0);
        let in_units = |factor: f64| {
            let own = [0.02, -0.01, 0.3];
            let sizes = [SIZES[0], SIZES[1] * factor];
            HourglassPotential::new(k * factor, sizes, Some((5.0 * factor, &own)))
        };
        for [y0, y1] in ends() {
            let amplitudes = Amplitudes::Between(y0, y1);
            let (stress, work) = in_units(1.0).stress(&amplitudes);
            for factor in [2.0, 2.0_f64.powi(-11)] {
                let found = in_units(factor).stress(&amplitudes);
                assert_eq!(found, (stress * factor, work * factor), "{factor}");
            }
        }
    }

    #[test]
    fn the_limit_is_the_moment_of_a_section_that_flows() {
        // one layer of squares of height 1, thickness 1: energy of the moment M is M²/(2 E' I) per length, I = 1/12, and
        // M_p = sigma_y/4 = 3/2 of sigma_y/6: s = M_p/sqrt(E' I) = 3/2 sigma_y sqrt(1/(3 E'))
        let found = limit(2.0, 0.0, 1.0, 1000.0).sqrt();
        assert!((found - 2.0 / 4.0 * (12.0_f64 / 1000.0).sqrt()).abs() < 1e-15);
        let least = limit(2.0, 1.0, 1.0, 1000.0).sqrt();
        assert!((least - found * LEAST_PART).abs() < 1e-15 * found);
    }
}
