//! Floating-point numbers in messages.

/// Magnitudes that are written with all their digits.
const PLAIN: std::ops::Range<f64> = 1e-6..1e16;

/// A number in a message, with an exponent when it would otherwise be a long row of zeros.
pub fn shown(x: f64) -> String {
    match x == 0.0 || PLAIN.contains(&x.abs()) {
        true => x.to_string(),
        false => format!("{x:e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::shown;

    #[test]
    fn no_number_fills_a_line() {
        let cases = [
            (0.0, "0"),
            (-0.4, "-0.4"),
            (180.0, "180"),
            (-1e-300, "-1e-300"),
            (1.5e308, "1.5e308"),
            (f64::NAN, "NaN"),
        ];
        for (x, text) in cases {
            assert_eq!(shown(x), text);
        }
    }
}
