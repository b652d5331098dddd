//! Numbers as text, and the layout of lines: width, labels in the first columns, wrapping.

use crate::diagnostics::in_lines;

/// `x` in scientific notation with at least two digits of the exponent, such as `1.00e-05`.
pub fn scientific(x: f64, decimals: usize) -> String {
    let text = format!("{x:.decimals$e}");
    match text.split_once('e') {
        Some((mantissa, exponent)) => {
            let (sign, digits) = match exponent.strip_prefix('-') {
                Some(digits) => ('-', digits),
                None => ('+', exponent),
            };
            format!("{mantissa}e{sign}{digits:0>2}")
        }
        None => text.to_lowercase(),
    }
}

/// `x` in scientific notation with its sign, such as `+2.1e-14`.
pub(crate) fn signed(x: f64, decimals: usize) -> String {
    let sign = if x.is_sign_negative() || x.is_nan() {
        ""
    } else {
        "+"
    };
    format!("{sign}{}", scientific(x, decimals))
}

/// `x` with `digits` significant digits, without an exponent if that is short: `0.025`, `-2`, `5.2e+06`.
pub(crate) fn general(x: f64, digits: usize) -> String {
    if x == 0.0 {
        return "0".into();
    }
    if !x.is_finite() {
        return scientific(x, 0);
    }
    let text = scientific(x, digits - 1);
    let exponent: i32 = (text.split_once('e'))
        .and_then(|(_, e)| e.parse().ok())
        .unwrap_or(0);
    if !(-4..4).contains(&exponent) {
        return match text.split_once('e') {
            Some((mantissa, exponent)) => format!("{}e{exponent}", trimmed(mantissa)),
            None => text,
        };
    }
    let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
    trimmed(&format!("{x:.decimals$}")).to_owned()
}

/// A number without trailing zeros of its fraction.
fn trimmed(number: &str) -> &str {
    match number.contains('.') {
        true => number.trim_end_matches('0').trim_end_matches('.'),
        false => number,
    }
}

/// `n` with its digits in groups of three: `4 312`.
pub(crate) fn grouped(n: usize) -> String {
    let digits = n.to_string();
    let first = digits.len() % 3;
    let mut text = digits[..first].to_owned();
    for (i, digit) in digits[first..].chars().enumerate() {
        if i % 3 == 0 && !text.is_empty() {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

/// `count` and its noun: `1 pair`, `2 004 nodes`.
pub(crate) fn counted(count: usize, noun: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{} {noun}{plural}", grouped(count))
}

/// A size in bytes with a decimal prefix: `38 MB`.
pub(crate) fn bytes(size: u64) -> String {
    let mut value = size as f64;
    for unit in ["B", "kB", "MB", "GB"] {
        if value < 999.5 {
            return format!("{} {unit}", general(value, 3));
        }
        value /= 1000.0;
    }
    format!("{} TB", general(value, 3))
}

/// Width of labels in columns.
const LABEL: usize = 9;

/// One line with its label in front.
pub(crate) fn label(label: &str, text: &str) -> String {
    format!("{label:<LABEL$}{text}")
}

/// The items three blanks apart, wrapped into lines, the first one labelled `first`.
pub(crate) fn wrap(first: &str, items: &[String]) -> Vec<String> {
    let items = items.iter().map(String::as_str);
    in_lines(label(first, ""), LABEL, items, "   ")
}

/// The words of a text, wrapped into lines, the first one labelled `first`.
pub(crate) fn wrap_words(first: &str, text: &str) -> Vec<String> {
    in_lines(label(first, ""), LABEL, text.split(' '), " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_have_two_digits() {
        assert_eq!(scientific(1e-5, 3), "1.000e-05");
        assert_eq!(scientific(-2.5e120, 1), "-2.5e+120");
        assert_eq!(scientific(0.0, 1), "0.0e+00");
        assert_eq!(signed(2.1e-14, 1), "+2.1e-14");
        assert_eq!(signed(f64::NAN, 1), "nan");
    }

    #[test]
    fn general_is_short() {
        let cases = [
            (0.025, "0.025"),
            (-2.0, "-2"),
            (5.19e6, "5.19e+06"),
            (100.0, "100"),
            (9.9996, "10"),
            (1e-5, "1e-05"),
            (45_644.0, "4.56e+04"),
        ];
        for (x, text) in cases {
            assert_eq!(general(x, 3), text);
        }
        assert_eq!(general(1000.0, 3), "1000");
    }

    #[test]
    fn counts_and_sizes() {
        assert_eq!(grouped(0), "0");
        assert_eq!(grouped(4312), "4 312");
        assert_eq!(grouped(123_456), "123 456");
        assert_eq!(counted(1, "node"), "1 node");
        assert_eq!(bytes(38_200_000), "38.2 MB");
    }
}
