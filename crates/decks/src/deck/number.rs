//! Numbers of a deck, parsed from whole fields.

/// Length of the longest number that other codes read.
pub(super) const LONGEST_NUMBER: usize = 20;

/// A real number, and whether its exponent has a letter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Real {
    /// Value of the number.
    pub value: f64,
    /// Whether the exponent lacks its letter, as in `1.5-5`.
    pub letterless: bool,
}

/// Reason why a field is not a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NotANumber {
    /// The given character does not belong to a number.
    Unexpected(char),
    /// The field ends before the number is complete.
    Incomplete,
    /// The field is an exponent without a number before it.
    BareExponent,
    /// The value is too large to be stored.
    TooLarge,
}

/// `[+-]digits`
pub(crate) fn integer(text: &str) -> Result<i64, NotANumber> {
    let first = after_sign(text, 0);
    let end = after_digits(text, first);
    if end == first || end < text.len() {
        return Err(unexpected(text, end));
    }
    text.parse().map_err(|_| NotANumber::TooLarge)
}

/// Reads a real number: `[+-]digits[.digits][(E|D)[+-]digits]`, `.5`, `1.`, or `1.5-5` for `1.5E-5`.
pub(crate) fn real(text: &str) -> Result<Real, NotANumber> {
    if let Some(value) = plain_real(text) {
        let letterless = false;
        return Ok(Real { value, letterless });
    }
    if let Some((_, false, end)) = exponent(text, 0)
        && end == text.len()
    {
        return Err(NotANumber::BareExponent);
    }
    let end = after_mantissa(text).map_err(|fault| unexpected(text, fault))?;
    let (digits, letterless, rest) = exponent(text, end).unwrap_or(("0", false, end));
    if rest < text.len() {
        return Err(unexpected(text, rest));
    }
    let standard = format!("{}e{digits}", text.get(..end).unwrap_or(""));
    match standard.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(Real { value, letterless }),
        _ => Err(NotANumber::TooLarge),
    }
}

/// The value of a number in a form that the standard library reads: without `D`, and with the letter of the exponent.
/// The words `inf` and `nan`, which the standard library also reads, are not finite and give `None`.
pub(super) fn plain_real(text: &str) -> Option<f64> {
    text.parse().ok().filter(|value: &f64| value.is_finite())
}

/// Byte behind the sign that stands at a byte; without a sign, this byte itself.
fn after_sign(text: &str, at: usize) -> usize {
    at + usize::from(matches!(text.as_bytes().get(at), Some(b'+' | b'-')))
}

/// Byte behind the digits that begin at a byte.
fn after_digits(text: &str, at: usize) -> usize {
    let rest = text.as_bytes().iter().skip(at);
    at + rest.take_while(|byte| byte.is_ascii_digit()).count()
}

/// Byte behind `[+-]digits[.digits]` or `[+-].digits`; `Err` with the byte where the text differs from both forms.
fn after_mantissa(text: &str) -> Result<usize, usize> {
    let first = after_sign(text, 0);
    let whole = after_digits(text, first);
    if text.as_bytes().get(whole) != Some(&b'.') {
        return if whole > first { Ok(whole) } else { Err(first) };
    }
    let end = after_digits(text, whole + 1);
    if end > first + 1 { Ok(end) } else { Err(end) }
}

/// Sign and digits of the exponent at a byte, whether the letter of the exponent is missing, and the byte behind the
/// exponent.
fn exponent(text: &str, at: usize) -> Option<(&str, bool, usize)> {
    let has_letter = matches!(text.as_bytes().get(at), Some(b'E' | b'e' | b'D' | b'd'));
    let sign = at + usize::from(has_letter);
    let first = after_sign(text, sign);
    let end = after_digits(text, first);
    let is_exponent = end > first && (has_letter || first > sign);
    is_exponent.then_some((text.get(sign..end)?, !has_letter, end))
}

/// The first character, at a byte or behind it, that cannot belong to a number.
fn unexpected(text: &str, at: usize) -> NotANumber {
    let rest = text.get(at..).unwrap_or("");
    let after = rest.trim_start_matches(|c| "+-.eEdD".contains(c));
    match after.chars().next().or_else(|| rest.chars().nth(1)) {
        Some(character) => NotANumber::Unexpected(character),
        None => NotANumber::Incomplete,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers() {
        assert_eq!(integer("-12"), Ok(-12));
        assert_eq!(integer("+7"), Ok(7));
        assert_eq!(integer("1."), Err(NotANumber::Incomplete));
        assert_eq!(integer("1x"), Err(NotANumber::Unexpected('x')));
        assert_eq!(integer("99999999999999999999"), Err(NotANumber::TooLarge));
    }

    #[test]
    fn reals() {
        let value = |text| real(text).map(|r| r.value);
        assert_eq!(value("1.5D-5"), Ok(1.5e-5));
        assert_eq!(value("+.5e+3"), Ok(500.0));
        assert_eq!(value("7"), Ok(7.0));
        assert_eq!(value("-1."), Ok(-1.0));
        assert_eq!(value("0.10000000000000000000E+04"), Ok(1000.0));
        let fortran = Real {
            value: 1.5e-5,
            letterless: true,
        };
        assert_eq!(real("1.5-5"), Ok(fortran));
    }

    #[test]
    fn not_reals() {
        for text in [
            "nan", "inf", "0x1p3", "1_000", "1.2.3", "e5", "1e", "", "-", ".", "1e999",
        ] {
            assert!(real(text).is_err(), "{text}");
        }
        let found = [
            ("e5", NotANumber::BareExponent),
            ("E", NotANumber::Incomplete),
            ("e5x", NotANumber::Unexpected('5')),
            ("-.", NotANumber::Incomplete),
            ("..", NotANumber::Incomplete),
            ("1e+x", NotANumber::Unexpected('x')),
            ("1.2.3", NotANumber::Unexpected('3')),
            ("+5-", NotANumber::Incomplete),
            ("5 6", NotANumber::Unexpected(' ')),
            ("1,5", NotANumber::Unexpected(',')),
            ("1e9999", NotANumber::TooLarge),
        ];
        for (text, fault) in found {
            assert_eq!(real(text), Err(fault), "{text}");
        }
    }
}
