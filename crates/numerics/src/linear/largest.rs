//! Largest absolute values; the result is NaN if one of the values is NaN.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

/// Number of values that are one task for a thread.
const PIECE: usize = 32_768;

/// Smallest number with a meaningful relative error: its round-off is still a normal number.
pub const SMALLEST: f64 = f64::MIN_POSITIVE / f64::EPSILON;

/// Largest absolute value; 0 without values, NaN if one of the values is NaN.
pub fn largest(values: &[f64]) -> f64 {
    match values.len() > PIECE && rayon::current_num_threads() > 1 {
        true => (values.par_chunks(PIECE).map(largest_of)).reduce(|| 0.0, larger),
        false => largest_of(values),
    }
}

/// Largest absolute value, computed on one thread.
fn largest_of(values: &[f64]) -> f64 {
    Arch::new().dispatch(Largest(values)).unwrap_or_else(|| {
        let larger = |most, value: &f64| larger(most, value.abs());
        values.iter().fold(0.0, larger)
    })
}

/// Largest absolute value; `None` if a value is not finite.
struct Largest<'a>(&'a [f64]);

impl WithSimd for Largest<'_> {
    type Output = Option<f64>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Option<f64> {
        let (vectors, rest) = S::as_simd_f64s(self.0);
        let zero = simd.splat_f64s(0.0);
        let (mut most, mut zeros) = (zero, zero);
        for &value in vectors {
            let value = simd.abs_f64s(value);
            most = simd.max_f64s(value, most);
            // stays zero as long as values are finite
            zeros = simd.mul_add_e_f64s(zero, value, zeros);
        }
        let rest_zero: f64 = rest.iter().map(|value| 0.0 * value).sum();
        let rest = rest.iter().map(|value| value.abs());
        let most = rest.fold(simd.reduce_max_f64s(most), f64::max);
        (simd.reduce_sum_f64s(zeros) + rest_zero == 0.0).then_some(most)
    }
}

/// The larger of two values; NaN if one of them is NaN.
pub fn larger(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_of_values_with_a_nan_is_none() {
        assert_eq!(largest(&[]), 0.0);
        assert_eq!(largest(&[1.0, -3.0, 2.0]), 3.0);
        for at in 0..3 {
            let mut values = [1.0, f64::NEG_INFINITY, 2.0];
            values[at] = f64::NAN;
            assert!(largest(&values).is_nan(), "{at}");
        }
        assert_eq!(larger(2.0, 1.0), 2.0);
        assert!(larger(f64::NAN, 1.0).is_nan() && larger(1.0, f64::NAN).is_nan());
    }
}
