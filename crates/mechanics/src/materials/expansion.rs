//! Thermal expansion: a temperature stretches a material equally in all directions; any law describes the additional
//! deformation. See docs/theory/materials.md, Temperature.
//!
//! # Derivation
//!
//! The deformation gradient is the product F = theta F_m of a stress-free stretch theta and the part F_m that the law
//! sees (Stojanovic, Djuric & Vujosevic 1964; Lu & Pister 1975). With C_m = C/theta² and a stored energy W_m per volume
//! of the heated, stress-free body, which is theta³ times its reference volume:
//!
//! ```text
//! E_m = (E - E_theta I)/theta²,   E_theta = (theta² - 1)/2
//! W = theta³ W_m(E_m),   S = dW/dE = theta S_m(E_m),   dS/dE = C_m(E_m)/theta
//! ```
//!
//! The law thus gives the true stress of the heated body, since F S F^T/J = F_m S_m F_m^T/J_m.

use super::constitutive_law::{AnyLaw, BentTangent, Metal, MetalLaw};
use super::number::{LANES, Lanes, Number};
use super::strains::{Across, StrainChange, StrainMeasure, Strains};
use super::symmetric::{Symmetric, Tangent};
use super::{Plane, StressAtPoints};

/// Largest number of points of an element.
const MAX_POINTS: usize = 9;

/// Thermal expansion of a material (`*EXPANSION`): the coefficient alpha is the mean expansion from a temperature T0
/// (the secant rule of Abaqus and CalculiX).
#[derive(Debug, Clone, PartialEq)]
pub struct Expansion {
    /// Temperature T0 from which the mean expansion alpha is measured.
    pub zero: f64,
    /// Increasing temperatures, each with alpha (1/temperature); alpha is linear between these temperatures and
    /// constant outside.
    pub table: Vec<[f64; 2]>,
}

impl Expansion {
    /// Coefficient alpha at a temperature (1/temperature).
    fn coefficient(&self, temperature: f64) -> f64 {
        let above = self.table.partition_point(|row| row[0] < temperature);
        match (
            above.checked_sub(1).map(|k| self.table[k]),
            self.table.get(above),
        ) {
            (Some([t0, a0]), Some([t1, a1])) => a0 + (a1 - a0) * ((temperature - t0) / (t1 - t0)),
            (Some([_, alpha]), None) | (None, Some(&[_, alpha])) => alpha,
            (None, None) => 0.0,
        }
    }

    /// Strain of a free body since the start, at which the temperature was T_I, eq. (2.52):
    ///
    /// ```text
    /// alpha(T) (T - T0) - alpha(T_I) (T_I - T0)
    /// ```
    pub fn strain(&self, initial: f64, temperature: f64) -> f64 {
        if initial == temperature {
            return 0.0;
        }
        let [first, alpha] = [initial, temperature].map(|t| self.coefficient(t));
        match first == alpha {
            true => alpha * (temperature - initial),
            false => alpha * (temperature - self.zero) - first * (initial - self.zero),
        }
    }
}

/// The stretch theta, with numbers computed from theta.
#[derive(Debug, Clone, Copy)]
struct Stretch<T> {
    /// theta
    theta: T,
    /// 1/theta²
    over_square: T,
    /// E_theta
    strain: T,
}

impl Stretch<Lanes> {
    /// The stretch of one element.
    fn lane(&self, lane: usize) -> Stretch<f64> {
        Stretch {
            theta: self.theta.lane(lane),
            over_square: self.over_square.lane(lane),
            strain: self.strain.lane(lane),
        }
    }
}

impl<T: Number> Stretch<T> {
    /// The stretch of a thermal strain e = theta - 1: E_theta = e + e²/2.
    fn of(strain: T) -> Self {
        let theta = strain + 1.0;
        Stretch {
            theta,
            over_square: T::all(1.0) / (theta * theta),
            strain: strain + strain * strain * 0.5,
        }
    }

    /// theta³
    fn volume(&self) -> T {
        self.theta * self.theta * self.theta
    }

    /// Strain E_m of the law for a strain E, eq. (2.53). In plane stress the law determines the strain across the
    /// plane.
    fn relative(&self, e: &Symmetric<T>, plane: Plane) -> Symmetric<T> {
        let normal = |e: T| (e - self.strain) * self.over_square;
        Symmetric {
            x: normal(e.x),
            y: normal(e.y),
            z: match plane {
                Plane::Stress => e.z,
                Plane::Strain | Plane::Revolution => normal(e.z),
            },
            w: e.w * self.over_square,
        }
    }

    /// Strains E_m of the law for the strains of an increment.
    fn relative_change(&self, change: &StrainChange<T>, plane: Plane) -> StrainChange<T> {
        let relative = |e: &Symmetric<T>| self.relative(e, plane);
        StrainChange {
            start: relative(&change.start),
            end: relative(&change.end),
            mean: relative(&change.mean),
            half: change.half.times(self.over_square),
        }
    }

    fn relative_strains(&self, strains: &Strains<T>, plane: Plane) -> Strains<T> {
        match strains {
            Strains::At(e) => Strains::At(self.relative(e, plane)),
            Strains::Between(change) => Strains::Between(self.relative_change(change, plane)),
        }
    }
}

/// The law of several elements at a time, each with a thermal stretch at every point.
pub struct Expanded<'a> {
    law: Box<AnyLaw<'a, true>>,
    plane: Plane,
    stretches: [Stretch<Lanes>; MAX_POINTS],
    metals: [Option<(ExpandedMetal<'a>, &'a [f64])>; LANES],
}

impl<'a> Expanded<'a> {
    /// A law in a plane, with the thermal strain theta - 1 at every point; for metals also the variables of their first
    /// points.
    pub fn new(
        law: Box<AnyLaw<'a, true>>,
        metals: [Option<(&'a dyn MetalLaw, &'a [f64])>; LANES],
        plane: Plane,
        strains: &[Lanes],
    ) -> Self {
        let mut stretches = [Stretch::of(Lanes::ZERO); MAX_POINTS];
        for (stretch, strain) in stretches.iter_mut().zip(strains) {
            *stretch = Stretch::of(*strain);
        }
        let metal = |lane: usize| {
            let (law, of_point) = metals[lane]?;
            let stretch = stretches[0].lane(lane);
            let metal = ExpandedMetal {
                law,
                plane,
                stretch,
            };
            Some((metal, of_point))
        };
        Expanded {
            law,
            plane,
            stretches,
            metals: std::array::from_fn(metal),
        }
    }
}

/// In plane strain the temperature causes a strain of the law across the plane, so the law is evaluated with all
/// components.
impl<const HOOP: bool> StressAtPoints<Lanes, HOOP> for Expanded<'_> {
    fn stress_at(&self, point: usize, strains: &Strains<Lanes>) -> Symmetric<Lanes> {
        StressAtPoints::<Lanes, HOOP>::stress_where(self, [true; LANES], point, strains)
    }

    fn tangent_at(&self, point: usize, strains: &Strains<Lanes>) -> Tangent<Lanes> {
        StressAtPoints::<Lanes, HOOP>::tangent_where(self, [true; LANES], point, strains)
    }

    /// The stress S = theta S_m, eq. (2.54).
    fn stress_where(
        &self,
        wanted: [bool; LANES],
        point: usize,
        strains: &Strains<Lanes>,
    ) -> Symmetric<Lanes> {
        let stretch = &self.stretches[point];
        let strains = stretch.relative_strains(strains, self.plane);
        let s = self.law.stress_where(wanted, point, &strains);
        s.times(stretch.theta)
    }

    /// The tangent C = C_m/theta.
    fn tangent_where(
        &self,
        wanted: [bool; LANES],
        point: usize,
        strains: &Strains<Lanes>,
    ) -> Tangent<Lanes> {
        let stretch = &self.stretches[point];
        let strains = stretch.relative_strains(strains, self.plane);
        let c = self.law.tangent_where(wanted, point, &strains);
        let over = Lanes::all(1.0) / stretch.theta;
        Tangent::of(|i, j| c.0[i][j] * over)
    }

    /// The stored energy W = theta³ W_m.
    fn energy_at(&self, point: usize, e: &Symmetric<Lanes>) -> Lanes {
        let stretch = &self.stretches[point];
        let e = stretch.relative(e, self.plane);
        self.law.energy_at(point, &e) * stretch.volume()
    }

    fn across_at(&self, point: usize, e: &Symmetric<Lanes>) -> Across<Lanes> {
        let stretch = &self.stretches[point];
        let e = stretch.relative(e, self.plane);
        let across = self.law.across_at(point, &e);
        Across {
            stretch: across.stretch * stretch.theta,
            stress: across.stress * stretch.theta,
        }
    }

    fn convex_in(&self) -> StrainMeasure {
        self.law.convex_in()
    }

    fn stiffness_factor(&self) -> Option<Lanes> {
        Some(Lanes::all(1.0) / self.stretches[0].theta)
    }

    fn metal(&self, lane: usize) -> Option<Metal<'_>> {
        let (law, of_point) = self.metals[lane].as_ref()?;
        Some(Metal { law, of_point })
    }

    fn plastic_strain_at(&self, lane: usize, point: usize) -> f64 {
        self.law.plastic_strain_at(lane, point)
    }

    fn update_at(&self, lane: usize, point: usize, strains: &Strains, z1: &mut [f64]) -> f64 {
        let stretch = self.stretches[point].lane(lane);
        let strains = stretch.relative_strains(strains, self.plane);
        self.law.update_at(lane, point, &strains, z1) * stretch.volume()
    }
}

/// A metal with a thermal stretch. The modes of its element have the stiffness Kh/theta and the amplitudes y/theta², so
/// the modes add m/theta³ to the square q² of the law.
#[derive(Debug, Clone, Copy)]
struct ExpandedMetal<'a> {
    law: &'a dyn MetalLaw,
    plane: Plane,
    stretch: Stretch<f64>,
}

impl ExpandedMetal<'_> {
    /// The squares m in the form in which the law of the metal uses them.
    fn relative_modes(&self, modes: [f64; 2]) -> [f64; 2] {
        modes.map(|m| m / self.stretch.volume())
    }
}

impl MetalLaw for ExpandedMetal<'_> {
    fn moduli(&self) -> [f64; 2] {
        self.law.moduli()
    }

    fn update(&self, strains: &Strains, z0: &[f64], modes: [f64; 2], z1: &mut [f64]) -> [f64; 2] {
        let strains = self.stretch.relative_strains(strains, self.plane);
        let modes = self.relative_modes(modes);
        let [dissipated, part] = self.law.update(&strains, z0, modes, z1);
        [dissipated * self.stretch.volume(), part]
    }

    fn change(&self, z0: &[f64], strains: &StrainChange, modes: [f64; 2], by: f64) -> f64 {
        let strains = self.stretch.relative_change(strains, self.plane);
        let volume = self.stretch.volume();
        let modes = self.relative_modes(modes);
        self.law.change(z0, &strains, modes, by / volume) * volume
    }

    fn bent_stress(&self, z0: &[f64], e: &Symmetric, modes: f64) -> (Symmetric, f64) {
        let e = self.stretch.relative(e, self.plane);
        let modes = modes / self.stretch.volume();
        let (s, by_modes) = self.law.bent_stress(z0, &e, modes);
        (s * self.stretch.theta, by_modes)
    }

    fn bent_tangent(&self, z0: &[f64], e: &Symmetric, modes: f64) -> BentTangent {
        let e = self.stretch.relative(e, self.plane);
        let (theta, volume) = (self.stretch.theta, self.stretch.volume());
        let BentTangent {
            tangent,
            by_modes: [slope, second],
            stress_by_modes,
        } = self.law.bent_tangent(z0, &e, modes / volume);
        BentTangent {
            tangent: Tangent::of(|i, j| tangent.0[i][j] / theta),
            by_modes: [slope, second / volume],
            stress_by_modes: stress_by_modes * (theta / volume),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::Law;

    #[test]
    fn strains_follow_the_secant_rule() {
        let expansion = Expansion {
            zero: 20.0,
            table: vec![[20.0, 1e-5], [120.0, 2e-5]],
        };
        // alpha(70) = 1.5e-5 and alpha(45) = 1.25e-5, constant beyond the table
        let rows = [
            (45.0, 70.0, 1.5e-5 * 50.0 - 1.25e-5 * 25.0),
            (20.0, 220.0, 2e-5 * 200.0),
            (0.0, -30.0, -1e-5 * 30.0),
        ];
        for (initial, temperature, exact) in rows {
            let found = expansion.strain(initial, temperature);
            assert!(
                (found - exact).abs() < 1e-15 * exact.abs(),
                "{found} {exact}"
            );
        }
        assert_eq!(expansion.strain(70.0, 70.0), 0.0);
    }

    #[test]
    fn the_heated_body_has_the_true_stress_of_the_law() {
        // F = theta F_m: F S F^T/J is F_m S_m F_m^T/J_m
        let plane_law = Law::elastic(1000.0, 0.3).in_plane(Plane::Revolution);
        let none: [&[f64]; LANES] = [&[]; LANES];
        let theta = 1.1_f64;
        let heated = plane_law.expanded(none, Plane::Revolution, &[Lanes::all(0.1)]);
        let cold = plane_law.in_lanes(none);
        let stretches = [1.2_f64, 0.9, 1.05];
        let strain = |factor: f64| {
            let [x, y, z] = stretches.map(|l| Lanes::all(((factor * l).powi(2) - 1.0) / 2.0));
            Symmetric::new(x, y, z, Lanes::ZERO)
        };
        let of = |law: &dyn StressAtPoints<Lanes, true>, factor: f64| {
            let s = law.stress_at(0, &Strains::At(strain(factor)));
            let l = stretches.map(|l| l * factor);
            let j: f64 = l.iter().product();
            [s.x.lane(0) * l[0] * l[0] / j, s.z.lane(0) * l[2] * l[2] / j]
        };
        let (found, exact) = (of(heated.any::<true>(), theta), of(cold.any::<true>(), 1.0));
        for (found, exact) in found.iter().zip(exact) {
            assert!(
                (found - exact).abs() < 1e-12 * exact.abs(),
                "{found} {exact}"
            );
        }
        // the energy per reference volume is theta^3 times W_m
        let energies = [
            heated.any::<true>().energy_at(0, &strain(theta)),
            cold.any::<true>().energy_at(0, &strain(1.0)),
        ];
        let [found, exact] = energies.map(|energy| energy.lane(0));
        assert!((found - theta.powi(3) * exact).abs() < 1e-12 * found);
    }
}
