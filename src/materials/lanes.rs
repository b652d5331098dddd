//! Numbers of several elements side by side, on which one instruction of the processor acts, and a material without
//! internal variables at one integration point of each of them. docs/numerics.md, Sweeps over elements.

use std::array::from_fn;
use std::ops::{Add, AddAssign, Div, Mul, Sub};

use nalgebra::{Matrix2, Matrix3};

use super::{Across, ConstitutiveLaw, PlaneSaintVenantKirchhoff, Strains};

/// Elements side by side: as many numbers as an instruction of any x86-64 processor takes. More would
/// not fit its registers.
pub const LANES: usize = 2;

/// A number of every element of a block; the default is zero.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Lanes(pub [f64; LANES]);

/// Components xx, yy, xy of a symmetric tensor.
pub type SymmetricLanes = [Lanes; 3];

/// Which elements have had positive numbers only: all bits of their entry are set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Positive([u64; LANES]);

impl Lanes {
    /// Zero.
    pub const ZERO: Lanes = Lanes([0.0; LANES]);

    /// The same number for every element.
    #[inline(always)]
    pub fn all(value: f64) -> Lanes {
        Lanes([value; LANES])
    }

    /// Square root.
    #[inline(always)]
    pub fn sqrt(self) -> Lanes {
        let [a, b] = self.0;
        Lanes([a.sqrt(), b.sqrt()])
    }

    /// 1/x, and a large number for x = 0.
    #[inline(always)]
    pub fn inverse(self) -> Lanes {
        Lanes(self.0.map(|x| 1.0 / x.max(f64::MIN_POSITIVE)))
    }

    /// 1/x^(1/3) of positive numbers that are not subnormal; NaN of others. A third of the exponent gives a start r within 4 %,
    /// and each step the next digits to the fourth power, with h = 1 - x r³:
    ///
    /// ```text
    /// r <- r (1 + h/3 + 2 h²/9 + 14 h³/81)
    /// ```
    #[inline(always)]
    pub fn inverse_cbrt(self) -> Lanes {
        let start = |x: f64| match x >= f64::MIN_POSITIVE {
            true => f64::from_bits(INVERSE_CUBE_ROOT.wrapping_sub(x.to_bits() / 3)),
            false => f64::NAN,
        };
        let mut r = Lanes(self.0.map(start));
        for _ in 0..2 {
            let h = Lanes::all(1.0) - self * (r * r * r);
            r = r + r * (h * (h * (h * (14.0 / 81.0) + 2.0 / 9.0) + 1.0 / 3.0));
        }
        r
    }
}

/// Four thirds of the bits of 1, less what makes the largest error of the start least.
const INVERSE_CUBE_ROOT: u64 = 0x553e_f0ff_289d_d796;

/// An operation between numbers of the same elements, and with one number for all.
macro_rules! operation {
    ($operation:ident, $function:ident, $symbol:tt) => {
        impl $operation for Lanes {
            type Output = Lanes;

            #[inline(always)]
            fn $function(self, other: Lanes) -> Lanes {
                let ([a, b], [c, d]) = (self.0, other.0);
                Lanes([a $symbol c, b $symbol d])
            }
        }

        impl $operation<f64> for Lanes {
            type Output = Lanes;

            #[inline(always)]
            fn $function(self, other: f64) -> Lanes {
                let [a, b] = self.0;
                Lanes([a $symbol other, b $symbol other])
            }
        }
    };
}

operation!(Add, add, +);
operation!(Sub, sub, -);
operation!(Mul, mul, *);
operation!(Div, div, /);

impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, other: Lanes) {
        *self = *self + other;
    }
}

impl Default for Positive {
    /// No number seen yet.
    #[inline(always)]
    fn default() -> Self {
        Positive([u64::MAX; LANES])
    }
}

impl Positive {
    /// The numbers seen so far and another of every element; NaN is not positive.
    #[inline(always)]
    #[must_use]
    pub fn and(self, value: Lanes) -> Positive {
        let at = |i: usize| if value.0[i] > 0.0 { self.0[i] } else { 0 };
        Positive([at(0), at(1)])
    }

    /// Numbers that two sets of elements have had.
    #[inline(always)]
    #[must_use]
    pub fn both(self, other: Positive) -> Positive {
        Positive([self.0[0] & other.0[0], self.0[1] & other.0[1]])
    }

    /// Whether all elements have had positive numbers only.
    pub fn everywhere(self) -> bool {
        self == Positive::default()
    }
}

/// The symmetric tensor of one element as a matrix.
pub fn tensor_of(lane: usize, [xx, yy, xy]: &SymmetricLanes) -> Matrix2<f64> {
    let [xx, yy, xy] = [xx.0[lane], yy.0[lane], xy.0[lane]];
    Matrix2::new(xx, xy, xy, yy)
}

/// The symmetric tensors of all elements, given that of each.
pub fn tensors(of_lane: impl Fn(usize) -> Matrix2<f64>) -> SymmetricLanes {
    let all: [Matrix2<f64>; LANES] = from_fn(of_lane);
    [(0, 0), (1, 1), (0, 1)].map(|entry| Lanes(all.map(|tensor| tensor[entry])))
}

/// A tensor whose components follow from those of two others.
#[inline(always)]
pub fn combined(
    a: &SymmetricLanes,
    b: &SymmetricLanes,
    of: impl Fn(Lanes, Lanes) -> Lanes,
) -> SymmetricLanes {
    from_fn(|i| of(a[i], b[i]))
}

/// Tangent in Voigt order.
pub type TangentLanes = [[Lanes; 3]; 3];

/// S:E of symmetric tensors.
#[inline(always)]
pub fn contract(s: &SymmetricLanes, e: &SymmetricLanes) -> Lanes {
    s[0] * e[0] + s[1] * e[1] + s[2] * e[2] * 2.0
}

/// C:E in Voigt order.
#[inline(always)]
pub fn times(c: &TangentLanes, [xx, yy, xy]: &SymmetricLanes) -> SymmetricLanes {
    from_fn(|i| c[i][0] * *xx + c[i][1] * *yy + c[i][2] * (*xy * 2.0))
}

/// Strains between which a stress is taken: (E0 + E1)/2 and (E1 - E0)/2.
#[derive(Clone, Copy)]
pub struct StrainChange {
    /// Mean strain.
    pub mean: SymmetricLanes,
    /// Half the change of the strain.
    pub half: SymmetricLanes,
}

impl StrainChange {
    /// That from some strains to others.
    #[inline(always)]
    pub fn between(e0: &SymmetricLanes, e1: &SymmetricLanes) -> Self {
        StrainChange {
            mean: combined(e0, e1, |a, b| (a + b) * 0.5),
            half: combined(e0, e1, |a, b| (b - a) * 0.5),
        }
    }

    /// Strains of start and end.
    #[inline(always)]
    pub fn ends(&self) -> [SymmetricLanes; 2] {
        let StrainChange { mean, half } = self;
        [
            combined(mean, half, |m, h| m - h),
            combined(mean, half, |m, h| m + h),
        ]
    }

    /// Strains of start and end of one element.
    fn of(&self, lane: usize) -> Strains {
        let [mean, half] = [&self.mean, &self.half].map(|strain| tensor_of(lane, strain));
        Strains::Between(mean - half, mean + half)
    }
}

/// Stress and tangent of [`ConstitutiveLaw`] for several elements.
pub trait LawInLanes {
    /// Second Piola-Kirchhoff stress, eq. (2.3) (force/length^2).
    fn stress(&self, e: &SymmetricLanes) -> SymmetricLanes;

    /// Energy-momentum stress, eq. (4.8) (force/length^2).
    fn mean_stress(&self, change: &StrainChange) -> SymmetricLanes;

    /// Tangent of [`Self::stress`] (force/length^2).
    fn tangent(&self, e: &SymmetricLanes) -> TangentLanes;

    /// Symmetric part of 2 dS/dE1 of [`Self::mean_stress`] (force/length^2).
    fn mean_tangent(&self, change: &StrainChange) -> TangentLanes;

    /// Stored energy W, eq. (2.4) (force/length^2).
    fn stored_energy(&self, e: &SymmetricLanes) -> Lanes;

    /// Stretch F_zz and stress S_zz (force/length^2) across the thickness.
    fn across(&self, e: &SymmetricLanes) -> [Lanes; 2];
}

impl LawInLanes for PlaneSaintVenantKirchhoff {
    /// S = C:E, eq. (2.13)
    #[inline(always)]
    fn stress(&self, &[xx, yy, xy]: &SymmetricLanes) -> SymmetricLanes {
        let c = self.elasticity();
        [
            xx * c.m11 + yy * c.m12,
            xx * c.m21 + yy * c.m22,
            xy * (2.0 * c.m33),
        ]
    }

    #[inline(always)]
    fn mean_stress(&self, change: &StrainChange) -> SymmetricLanes {
        LawInLanes::stress(self, &change.mean)
    }

    #[inline(always)]
    fn tangent(&self, _e: &SymmetricLanes) -> TangentLanes {
        from_fn(|i| from_fn(|j| Lanes::all(self.elasticity()[(i, j)])))
    }

    #[inline(always)]
    fn mean_tangent(&self, change: &StrainChange) -> TangentLanes {
        LawInLanes::tangent(self, &change.mean)
    }

    /// W = S:E/2, eq. (2.13)
    #[inline(always)]
    fn stored_energy(&self, e: &SymmetricLanes) -> Lanes {
        let [xx, yy, xy] = LawInLanes::stress(self, e);
        (xx * e[0] + yy * e[1]) * 0.5 + xy * e[2]
    }

    /// F_zz² = 1 + 2 E_zz
    #[inline(always)]
    fn across(&self, e: &SymmetricLanes) -> [Lanes; 2] {
        let ([xx, yy, _], ratios) = (LawInLanes::stress(self, e), self.across_ratios());
        let [contraction, across] = ratios;
        let stretch = (e[0] + e[1]) * (-2.0 * contraction) + 1.0;
        [stretch.sqrt(), (xx + yy) * across]
    }
}

/// A law without internal variables that is evaluated for one element after the other.
pub struct OneByOne<'a, L>(pub &'a L);

impl<L: ConstitutiveLaw> LawInLanes for OneByOne<'_, L> {
    fn stress(&self, e: &SymmetricLanes) -> SymmetricLanes {
        tensors(|lane| {
            self.0
                .stress(&Strains::At(tensor_of(lane, e)), &[], &mut [])
        })
    }

    fn mean_stress(&self, change: &StrainChange) -> SymmetricLanes {
        tensors(|lane| {
            let strains = change.of(lane);
            self.0.stress(&strains, &[], &mut [])
        })
    }

    fn tangent(&self, e: &SymmetricLanes) -> TangentLanes {
        tangents(|lane| self.0.tangent(&Strains::At(tensor_of(lane, e)), &[]))
    }

    fn mean_tangent(&self, change: &StrainChange) -> TangentLanes {
        tangents(|lane| self.0.tangent(&change.of(lane), &[]))
    }

    fn stored_energy(&self, e: &SymmetricLanes) -> Lanes {
        Lanes(from_fn(|lane| {
            self.0.stored_energy(&tensor_of(lane, e), &[])
        }))
    }

    fn across(&self, e: &SymmetricLanes) -> [Lanes; 2] {
        let all: [Across; LANES] = from_fn(|lane| self.0.across(&tensor_of(lane, e), &[]));
        [Lanes(all.map(|a| a.stretch)), Lanes(all.map(|a| a.stress))]
    }
}

/// The tangent of one element as a matrix.
pub fn tangent_of(lane: usize, c: &TangentLanes) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| c[i][j].0[lane])
}

/// Values at points, which stand in the lanes side by side, the last one in all that are left. `at` gives those of strains,
/// `between` those of changes; all strains are of the kind of the first.
#[inline(always)]
pub fn points_side_by_side<V, T>(
    strains: &[Strains],
    values: &mut [T],
    at: impl Fn(&SymmetricLanes) -> V,
    between: impl Fn(&StrainChange) -> V,
    of_lane: impl Fn(usize, &V) -> T,
) {
    for (strains, values) in strains.chunks(LANES).zip(values.chunks_mut(LANES)) {
        let of = |lane: usize| &strains[lane.min(strains.len() - 1)];
        let end = tensors(|lane| *of(lane).end());
        let all = match strains[0] {
            Strains::At(_) => at(&end),
            Strains::Between(..) => {
                let start = tensors(|lane| match of(lane) {
                    Strains::At(e) | Strains::Between(e, _) => *e,
                });
                between(&StrainChange::between(&start, &end))
            }
        };
        for (lane, value) in values.iter_mut().enumerate() {
            *value = of_lane(lane, &all);
        }
    }
}

/// The tangents of all elements, given that of each.
fn tangents(of_lane: impl Fn(usize) -> Matrix3<f64>) -> TangentLanes {
    let all: [Matrix3<f64>; LANES] = from_fn(of_lane);
    from_fn(|i| from_fn(|j| Lanes(all.map(|tangent| tangent[(i, j)]))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_number_that_is_not_positive_is_not_forgotten() {
        let [some, other] = [Lanes::all(2.0), Lanes([1.0, 0.5])];
        assert!(Positive::default().and(some).and(other).everywhere());
        for bad in [0.0, -1.0, f64::NAN] {
            let [first, last] = [Lanes([bad, 1.0]), Lanes([1.0, bad])];
            assert!(!Positive::default().and(first).and(some).everywhere());
            assert!(!Positive::default().and(some).and(last).everywhere());
        }
    }

    #[test]
    fn cube_roots_are_round_off_away() {
        let mut x = 1e-300_f64;
        while x < 1e300 {
            let near_one = 1.0 + 1e-3 * x.ln().sin();
            let all = [x, near_one];
            let found = Lanes(all).inverse_cbrt().0;
            for (x, root) in all.into_iter().zip(found) {
                assert!((root * x.cbrt() - 1.0).abs() < 4.0 * f64::EPSILON, "{x}");
            }
            x *= 1.37;
        }
        let wrong = Lanes([-1.0, 0.0]).inverse_cbrt().0;
        assert!(wrong.iter().all(|root| root.is_nan()));
    }

    #[test]
    fn tensors_and_lanes_are_inverse() {
        let tensor = |lane| Matrix2::new(1.0, 3.0, 3.0, 2.0) * (1.0 + lane as f64);
        let lanes = tensors(tensor);
        assert!((0..LANES).all(|lane| tensor_of(lane, &lanes) == tensor(lane)));
    }
}
