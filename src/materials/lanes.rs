//! Numbers of several elements side by side, on which one instruction of the processor acts.

use std::array::from_fn;
use std::ops::{Add, AddAssign, Div, Mul, Sub};

use nalgebra::Matrix2;

/// Elements side by side: as many numbers as an instruction of any x86-64 processor takes. More would
/// not fit its registers.
pub const LANES: usize = 2;

/// A number of every element of a block.
#[derive(Debug, Clone, Copy, PartialEq)]
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
}

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
    fn tensors_and_lanes_are_inverse() {
        let tensor = |lane| Matrix2::new(1.0, 3.0, 3.0, 2.0) * (1.0 + lane as f64);
        let lanes = tensors(tensor);
        assert!((0..LANES).all(|lane| tensor_of(lane, &lanes) == tensor(lane)));
    }
}
