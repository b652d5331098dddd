//! Numbers for which a law is written: one number, or the numbers of several elements, on which one instruction of the
//! processor acts. See docs/numerics.md, Sweeps over elements.

use std::array::from_fn;
use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, Sub};

/// Number of elements that are evaluated together: as many numbers as an instruction of any x86-64 processor handles.
/// With more elements the numbers would not fit into the registers of the processor.
pub const LANES: usize = 2;

/// Numbers for which formulas of laws and elements are written.
pub trait Number:
    Copy
    + Debug
    + Default
    + PartialEq
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + AddAssign
{
    /// Number of elements.
    const ELEMENTS: usize;

    /// The same number for every element.
    fn all(value: f64) -> Self;

    /// Number whose value in each element is given.
    fn of_lanes(of: impl FnMut(usize) -> f64) -> Self;

    /// The number of one element.
    fn lane(self, lane: usize) -> f64;

    /// Square root.
    fn sqrt(self) -> Self;

    /// Inverse cube root 1/x^(1/3) of positive numbers that are not subnormal; NaN for other numbers. A third of the
    /// exponent gives a start value r with an error of at most 4 %. Each step raises the relative error of r to the
    /// fourth power, with h = 1 - x r³:
    ///
    /// ```text
    /// r <- r (1 + h/3 + 2 h²/9 + 14 h³/81)
    /// ```
    #[inline(always)]
    fn inverse_cbrt(self) -> Self {
        let start = |x: f64| match x >= f64::MIN_POSITIVE {
            true => f64::from_bits(INVERSE_CUBE_ROOT.wrapping_sub(x.to_bits() / 3)),
            false => f64::NAN,
        };
        let mut r = self.each(start);
        for _ in 0..2 {
            let h = Self::all(1.0) - self * (r * r * r);
            r = r + r * (h * (h * (h * (14.0 / 81.0) + 2.0 / 9.0) + 1.0 / 3.0));
        }
        r
    }

    /// Applies a function to the number of every element.
    #[inline(always)]
    fn each(self, of: impl Fn(f64) -> f64) -> Self {
        Self::of_lanes(|lane| of(self.lane(lane)))
    }

    /// The numbers for which `keep` is true, and zero in place of other numbers.
    #[inline(always)]
    fn where_kept(self, keep: impl Fn(usize) -> bool) -> Self {
        Self::of_lanes(|lane| match keep(lane) {
            true => self.lane(lane),
            false => 0.0,
        })
    }
}

/// Four thirds of the bits of 1, reduced by the amount that makes the largest error of the start value least.
const INVERSE_CUBE_ROOT: u64 = 0x553e_f0ff_289d_d796;

impl Number for f64 {
    const ELEMENTS: usize = 1;

    #[inline(always)]
    fn all(value: f64) -> f64 {
        value
    }

    #[inline(always)]
    fn of_lanes(mut of: impl FnMut(usize) -> f64) -> f64 {
        of(0)
    }

    #[inline(always)]
    fn lane(self, _lane: usize) -> f64 {
        self
    }

    #[inline(always)]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }
}

/// One number for every element of a block; the default is zero.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(align(16))]
pub struct Lanes(pub [f64; LANES]);

/// A flag for every element in the lanes: all bits are set as long as all numbers of the element were positive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Positive([u64; LANES]);

impl Lanes {
    /// Zero.
    pub const ZERO: Lanes = Lanes([0.0; LANES]);

    /// Inverse 1/x, and a large number for x = 0.
    #[inline(always)]
    pub fn inverse(self) -> Lanes {
        Lanes(self.0.map(|x| 1.0 / x.max(f64::MIN_POSITIVE)))
    }
}

impl Number for Lanes {
    const ELEMENTS: usize = LANES;

    #[inline(always)]
    fn all(value: f64) -> Lanes {
        Lanes([value; LANES])
    }

    #[inline(always)]
    fn of_lanes(of: impl FnMut(usize) -> f64) -> Lanes {
        Lanes(from_fn(of))
    }

    #[inline(always)]
    fn lane(self, lane: usize) -> f64 {
        self.0[lane]
    }

    #[inline(always)]
    fn sqrt(self) -> Lanes {
        let [a, b] = self.0;
        Lanes([a.sqrt(), b.sqrt()])
    }
}

/// Defines an operation between numbers of the same elements, and between these numbers and one number for all
/// elements.
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
    /// The state before any number is added.
    #[inline(always)]
    fn default() -> Self {
        Positive([u64::MAX; LANES])
    }
}

impl Positive {
    /// Adds one more number of every element; NaN is not positive.
    #[inline(always)]
    #[must_use]
    pub fn and(self, value: Lanes) -> Positive {
        let at = |i: usize| if value.0[i] > 0.0 { self.0[i] } else { 0 };
        Positive([at(0), at(1)])
    }

    /// Combines two states: all numbers of both states must be positive.
    #[inline(always)]
    #[must_use]
    pub fn both(self, other: Positive) -> Positive {
        Positive([self.0[0] & other.0[0], self.0[1] & other.0[1]])
    }

    /// Whether all numbers of an element were positive.
    pub fn at(self, lane: usize) -> bool {
        self.0[lane] == u64::MAX
    }

    /// The values of the elements whose numbers were all positive, and NaN for other elements.
    #[inline(always)]
    pub fn or_nan(self, value: Lanes) -> Lanes {
        Lanes::of_lanes(|lane| match self.at(lane) {
            true => value.0[lane],
            false => f64::NAN,
        })
    }

    /// Whether all numbers of all elements were positive.
    pub fn everywhere(self) -> bool {
        self == Positive::default()
    }
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
}
