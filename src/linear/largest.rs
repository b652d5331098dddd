//! Largest values, NaN where one of the values is.

/// Largest absolute value, 0 without values; NaN when one is. In eight interleaved parts, which the compiler
/// turns into vector instructions.
pub fn largest(values: &[f64]) -> f64 {
    let (mut most, mut zeros) = ([0.0_f64; 8], [0.0_f64; 8]);
    let chunks = values.chunks_exact(8);
    let rest = chunks.remainder();
    for chunk in chunks {
        for ((most, zero), value) in most.iter_mut().zip(&mut zeros).zip(chunk) {
            let value = value.abs();
            *most = if value > *most { value } else { *most };
            *zero += 0.0 * value;
        }
    }
    // a part that is not zero tells of a value that is not finite
    let finite = most.into_iter().chain(rest.iter().map(|value| value.abs()));
    match zeros == [0.0; 8] {
        true => finite.fold(0.0, larger),
        false => values
            .iter()
            .fold(0.0, |most, value| larger(most, value.abs())),
    }
}

/// The larger of two values; NaN when one is.
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
