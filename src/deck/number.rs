//! Numbers of a deck: parsed from whole fields, and from rows of plain numbers, as nearly all rows of
//! a mesh are. Such a row is read in one go, without the places of its fields; what is not plain is
//! read field by field.

use memchr::memchr3;
use nom::branch::alt;
use nom::bytes::complete::take_while1;
use nom::character::complete::{digit0, digit1, one_of};
use nom::combinator::{opt, recognize};
use nom::{IResult, Parser};
use nom_locate::LocatedSpan;
use smallvec::SmallVec;

type Input<'a> = LocatedSpan<&'a str>;

/// A real number and how it was written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Real {
    /// Its value.
    pub value: f64,
    /// Whether its exponent lacks the letter, as in `1.5-5`.
    pub letterless: bool,
}

/// Longest number other codes read.
pub(super) const LONGEST_NUMBER: usize = 20;

/// Digits that a 64-bit integer holds whatever they are.
const MOST_DIGITS: usize = 18;

/// Largest whole number up to which all are stored exactly.
const MOST_EXACT: u64 = 1 << 53;

/// Powers of ten that are stored exactly.
const POWERS_OF_TEN: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// Powers of ten up to that of eight digits.
const WHOLE_POWERS_OF_TEN: [u64; 9] = [
    1,
    10,
    100,
    1000,
    10_000,
    100_000,
    1_000_000,
    10_000_000,
    100_000_000,
];

/// A word of bytes 1.
const EACH_BYTE: u64 = 0x0101_0101_0101_0101;

/// Why a field is not a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NotANumber {
    /// This character does not belong.
    Unexpected(char),
    /// The field ends too early.
    Incomplete,
    /// It is an exponent with no number before it.
    BareExponent,
    /// The value is too large to be stored.
    TooLarge,
}

/// `[+-]digits`
pub(crate) fn integer(text: &str) -> Result<i64, NotANumber> {
    if let Some(value) = short_integer(text.as_bytes()) {
        return Ok(value);
    }
    let mut number = recognize((opt(one_of("+-")), digit1));
    let parsed: IResult<Input, Input> = number.parse(Input::new(text));
    let digits = whole(text, parsed)?;
    digits.parse().map_err(|_| NotANumber::TooLarge)
}

/// `[+-]digits[.digits][(E|D)[+-]digits]`, `.5`, `1.`, and `1.5-5` for `1.5E-5`
pub(crate) fn real(text: &str) -> Result<Real, NotANumber> {
    if let Some(value) = plain_real(text.as_bytes()) {
        let letterless = false;
        return Ok(Real { value, letterless });
    }
    let parsed = (mantissa, opt(exponent)).parse(Input::new(text));
    let (mantissa, exponent) = whole(text, parsed).map_err(|why| match is_exponent(text) {
        true => NotANumber::BareExponent,
        false => why,
    })?;
    let (digits, letterless) = exponent.unwrap_or((Input::new("0"), false));
    let standard = format!("{mantissa}e{digits}");
    match standard.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(Real { value, letterless }),
        _ => Err(NotANumber::TooLarge),
    }
}

/// The value of up to 18 digits without a sign, as most numbers of a mesh are.
fn short_integer(digits: &[u8]) -> Option<i64> {
    if digits.is_empty() || digits.len() > 18 {
        return None;
    }
    digits.iter().try_fold(0, |value, byte| {
        let is_digit = byte.is_ascii_digit();
        is_digit.then(|| 10 * value + i64::from(byte - b'0'))
    })
}

/// The value of a number without `D`, whose exponent has its letter: the standard library reads
/// these as they are. What it reads besides them is not finite: `inf` and `nan`.
pub(super) fn plain_real(text: &[u8]) -> Option<f64> {
    let of_standard = || std::str::from_utf8(text).ok()?.parse().ok();
    let value: Option<f64> = decimal(text).or_else(of_standard);
    value.filter(|value| value.is_finite())
}

/// The value of `[-]digits[.digits]` with few digits.
fn decimal(text: &[u8]) -> Option<f64> {
    let (value, rest) = leading_decimal(text)?;
    rest.is_empty().then_some(value)
}

/// The value of `[-]digits[.digits]` with few digits at the start of a text, and what follows it:
/// without the point they are a whole number that is stored exactly, as is the power of ten that
/// divides it, so that one division rounds once (Clinger, 1990).
pub(super) fn leading_decimal(text: &[u8]) -> Option<(f64, &[u8])> {
    let number = text.strip_prefix(b"-").unwrap_or(text);
    let (whole, mut rest) = digits(0, number);
    let (mut all, mut count, mut decimals) = (whole, number.len() - rest.len(), 0);
    if let (1.., [b'.', after @ ..]) = (count, rest) {
        (all, rest) = digits(whole, after);
        decimals = after.len() - rest.len();
        count += decimals;
    }
    let divisor = POWERS_OF_TEN.get(decimals)?;
    if count == 0 || count > MOST_DIGITS || all > MOST_EXACT {
        return None;
    }
    let value = all as f64 / divisor;
    let is_negative = number.len() < text.len();
    Some((if is_negative { -value } else { value }, rest))
}

/// `value` with the digits at the start of a text added behind it, and what follows them; wrong
/// beyond 19 digits.
pub(super) fn digits(mut value: u64, mut text: &[u8]) -> (u64, &[u8]) {
    loop {
        let (count, next) = up_to_eight_digits(text);
        value = value
            .wrapping_mul(WHOLE_POWERS_OF_TEN[count])
            .wrapping_add(next);
        text = text.get(count..).unwrap_or_default();
        if count < 8 {
            return (value, text);
        }
    }
}

/// Number and value of the digits at the start of a text, of the first eight of them at most: all
/// bytes of a word at once (Lemire, 2021).
fn up_to_eight_digits(text: &[u8]) -> (usize, u64) {
    let bytes = text.first_chunk().copied().unwrap_or_else(|| {
        let mut bytes = [0; 8];
        bytes
            .iter_mut()
            .zip(text)
            .for_each(|(to, from)| *to = *from);
        bytes
    });
    // the digits, in bytes from the lowest on
    let digits = u64::from_le_bytes(bytes) ^ (EACH_BYTE * u64::from(b'0'));
    // the highest bit of the first byte that is above 9 is set, and of none before it
    let others = (digits.wrapping_add(EACH_BYTE * (0x80 - 10)) | digits) & (EACH_BYTE * 0x80);
    let count = others.trailing_zeros() as usize / 8;
    if count == 0 {
        return (0, 0);
    }
    // zeros before them, then numbers of two, four and eight digits
    let ones = digits << (64 - 8 * count);
    let twos = (10 * ones).wrapping_add(ones >> 8) & 0x00FF_00FF_00FF_00FF;
    let fours = (100 * twos).wrapping_add(twos >> 16) & 0x0000_FFFF_0000_FFFF;
    let eight = (10_000 * fours).wrapping_add(fours >> 32) & 0xFFFF_FFFF;
    (count, eight)
}

fn mantissa(input: Input) -> IResult<Input, Input> {
    let dot = || one_of(".");
    let digits = alt((
        recognize((digit1, opt((dot(), digit0)))),
        recognize((dot(), digit1)),
    ));
    recognize((opt(one_of("+-")), digits)).parse(input)
}

/// Sign and digits of the exponent, and whether its letter is missing.
fn exponent(input: Input) -> IResult<Input, (Input, bool)> {
    let signed = recognize((opt(one_of("+-")), digit1));
    let lettered = (one_of("EeDd"), signed).map(|(_, digits)| (digits, false));
    let letterless = recognize((one_of("+-"), digit1)).map(|digits| (digits, true));
    alt((lettered, letterless)).parse(input)
}

/// `(E|D)[+-]digits`, the second field of `1,E6` written with a decimal comma
fn is_exponent(text: &str) -> bool {
    let lettered = text.starts_with(|c: char| c.is_ascii_alphabetic());
    let parsed = exponent(Input::new(text));
    lettered && parsed.is_ok_and(|(rest, _)| rest.fragment().is_empty())
}

/// The parsed value, if nothing of `text` is left over.
fn whole<'a, T>(text: &'a str, parsed: IResult<Input<'a>, T>) -> Result<T, NotANumber> {
    match parsed {
        Ok((rest, value)) if rest.fragment().is_empty() => Ok(value),
        Ok((rest, _)) => Err(unexpected(text, rest.location_offset())),
        Err(nom::Err::Error(error) | nom::Err::Failure(error)) => {
            Err(unexpected(text, error.input.location_offset()))
        }
        Err(nom::Err::Incomplete(_)) => Err(NotANumber::Incomplete),
    }
}

/// The first character from `offset` on that cannot continue a number.
fn unexpected(text: &str, offset: usize) -> NotANumber {
    let rest = text.get(offset..).unwrap_or("");
    let begun = take_while1::<_, _, nom::error::Error<&str>>(|c: char| "+-.eEdD".contains(c));
    let mut beginning = opt(begun);
    let after = beginning.parse(rest).map_or(rest, |(after, _)| after);
    match after.chars().next().or_else(|| rest.chars().nth(1)) {
        Some(character) => NotANumber::Unexpected(character),
        None => NotANumber::Incomplete,
    }
}

/// The numbers of a row of integers.
pub type Integers = SmallVec<[u64; 5]>;

/// The number and the coordinates of a row.
pub(crate) type Point = (u64, [f64; 3]);

/// Reads the numbers of the row at the start of a text, if it holds integers without sign only, with
/// nothing but blanks between them and the commas; returns what follows it.
pub(crate) fn integers<'t>(text: &'t [u8], numbers: &mut Integers) -> Option<&'t [u8]> {
    numbers.clear();
    let mut text = after_blanks(text);
    loop {
        let (number, rest) = leading_integer(text)?;
        numbers.push(number);
        text = after_blanks(rest);
        if let [b',', rest @ ..] = text {
            text = after_blanks(rest);
            if !ends(text) {
                continue;
            }
        }
        return ends(text).then_some(text);
    }
}

/// The integer without sign and the one to three numbers of the row at the start of a text, and what
/// follows it; numbers that are missing are 0.
pub(crate) fn point(text: &[u8]) -> Option<(Point, &[u8])> {
    let (label, mut rest) = leading_integer(after_blanks(text))?;
    let mut at = [0.0; 3];
    for (index, x) in at.iter_mut().enumerate() {
        rest = match after_blanks(rest) {
            [b',', rest @ ..] => rest,
            _ if index > 0 => break,
            _ => return None,
        };
        (*x, rest) = leading_real(after_blanks(rest))?;
    }
    let rest = after_blanks(rest);
    ends(rest).then_some(((label, at), rest))
}

/// The integer without sign at the start of a text, and what follows it.
fn leading_integer(text: &[u8]) -> Option<(u64, &[u8])> {
    let (value, rest) = digits(0, text);
    let count = text.len() - rest.len();
    (1..=MOST_DIGITS).contains(&count).then_some((value, rest))
}

/// The number at the start of a text and what follows it.
fn leading_real(text: &[u8]) -> Option<(f64, &[u8])> {
    let decimal = leading_decimal(text);
    let decimal =
        decimal.filter(|(_, rest)| matches!(rest, [] | [b',' | b' ' | b'\r' | b'\n', ..]));
    decimal.or_else(|| {
        let end = memchr3(b',', b'\r', b'\n', text).unwrap_or(text.len());
        let (field, rest) = text.split_at_checked(end)?;
        let field = field.trim_ascii_end();
        let value = plain_real(field)?;
        (field.len() <= LONGEST_NUMBER).then_some((value, rest))
    })
}

/// Whether a text begins with the end of a line.
fn ends(text: &[u8]) -> bool {
    matches!(text, [] | [b'\n', ..] | [b'\r', b'\n', ..])
}

fn after_blanks(mut text: &[u8]) -> &[u8] {
    while let [b' ', rest @ ..] = text {
        text = rest;
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deck::lines::Fields;
    use proptest::prelude::*;

    #[test]
    fn whole_numbers() {
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
    fn decimals_are_read_as_by_the_standard_library() {
        let mut state = 1u64;
        for _ in 0..20_000 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            let (digits, decimals) = (state >> (state % 60), (state >> 32) as usize % 20);
            let text = format!("{:.decimals$}", digits as f64 * 1e-9 - 1e3);
            let value = text.parse().ok();
            assert_eq!(plain_real(text.as_bytes()), value, "{text}");
            let read = decimal(text.as_bytes());
            assert!(read.is_none() || read == value, "{text}: {read:?}");
        }
        for (text, value) in [
            ("0.1", 0.1),
            ("-0.0", 0.0),
            ("9007199254740992", 9_007_199_254_740_992.0),
            ("3.", 3.0),
        ] {
            assert_eq!(decimal(text.as_bytes()), Some(value));
        }
        for text in [
            "",
            "-",
            ".",
            "-.5",
            "1e3",
            "+1",
            "9007199254740993",
            "1.2.3",
        ] {
            assert_eq!(decimal(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn digits_are_read_in_words() {
        let all = "0123456789012345678";
        for count in 0..=19 {
            for rest in ["", ",", "/1234567", ":", " 12", "\u{e9}\u{80}", "\0", "e5"] {
                let text = format!("{}{rest}", &all[..count]);
                let value = all[..count].parse().unwrap_or(0);
                assert_eq!(
                    digits(0, text.as_bytes()),
                    (value, rest.as_bytes()),
                    "{text}"
                );
            }
        }
        assert_eq!(digits(12, b"34."), (1234, &b"."[..]));
    }

    #[test]
    fn not_reals() {
        for text in [
            "nan", "inf", "0x1p3", "1_000", "1.2.3", "e5", "1e", "", "-", ".", "1e999",
        ] {
            assert!(real(text).is_err(), "{text}");
        }
        assert_eq!(real("e5"), Err(NotANumber::BareExponent));
        assert_eq!(real("E"), Err(NotANumber::Incomplete));
        assert_eq!(real("e5x"), Err(NotANumber::Unexpected('5')));
    }

    /// The first line of a text as its fields are read one by one.
    fn fields(text: &str) -> Vec<&str> {
        let line = text.split('\n').next().unwrap_or_default();
        let line = line.strip_suffix('\r').unwrap_or(line);
        Fields::new(line)
            .map(|(start, end)| &line[start..end])
            .collect()
    }

    /// What is not of the first line.
    fn rest(text: &str) -> &[u8] {
        let line = text.split('\n').next().unwrap_or_default();
        let cut = usize::from(line.ends_with('\r') && line.len() < text.len());
        &text.as_bytes()[line.len() - cut..]
    }

    fn assert_integers_are_fields(text: &str) {
        let fields: Option<Vec<u64>> = (fields(text).iter())
            .map(|field| u64::try_from(integer(field).ok()?).ok())
            .collect();
        let mut found = Integers::new();
        if let Some(after) = integers(text.as_bytes(), &mut found) {
            assert_eq!(
                (Some(found.to_vec()), after),
                (fields, rest(text)),
                "{text}"
            );
        }
    }

    fn assert_point_is_fields(text: &str) {
        let fields = fields(text);
        if let Some(((label, at), after)) = point(text.as_bytes()) {
            let real = |field: &&str| real(field).expect("a number").value.to_bits();
            let mut expected: Vec<u64> = fields[1..].iter().map(real).collect();
            expected.resize(3, 0.0_f64.to_bits());
            assert_eq!(integer(fields[0]), Ok(label as i64), "{text}");
            assert_eq!(at.map(f64::to_bits).to_vec(), expected, "{text}");
            assert_eq!(after, rest(text), "{text}");
        }
    }

    proptest! {
        #[test]
        fn any_row_is_what_its_fields_are(text in "[0-9]{1,4}( ?[0-9., \r\n+eE-]{0,3}){0,12}") {
            assert_integers_are_fields(&text);
            assert_point_is_fields(&text);
        }

        #[test]
        fn decimals_have_the_bits_of_the_standard_library(
            text in "[0-9]{1,9}, ?-?[0-9]{1,10}\\.[0-9]{0,17}(, *[0-9]{1,3}(\\.[0-9]{1,9}(E[+-]?[0-9]{1,2})?)?){1,2} ?\r?\n9"
        ) {
            let is_short = fields(&text).iter().all(|field| field.len() <= LONGEST_NUMBER);
            prop_assert_eq!(point(text.as_bytes()).is_some(), is_short);
            assert_point_is_fields(&text);
        }
    }

    #[test]
    fn rows_of_integers_are_what_their_fields_are() {
        let rows = [
            "1, 2, 3",
            "1,2,3,",
            " 7 , 8 , ",
            "12345678, 123456789\r\n1",
            "7,\t8",
            "12",
            "1,,2",
            ",",
            "1,2,,",
            "-1, 2",
            "1 2, 3",
            "1, a",
            "1.0, 2",
            "\"1\", 2",
            "1, 9999999999999999999",
            "1; 2",
            "1, 2\r",
        ];
        rows.iter().for_each(|row| assert_integers_are_fields(row));
        let plain = rows
            .iter()
            .filter(|row| integers(row.as_bytes(), &mut Integers::new()).is_some());
        assert_eq!(plain.count(), 5);
    }

    #[test]
    fn plain_points_have_finite_numbers() {
        let at = |row: &'static str| point(row.as_bytes());
        let rest = |rest: &'static str| rest.as_bytes();
        let (a, b) = ([-0.5, 2.0, 300.0], [1.0, 1e-3, 0.0]);
        assert_eq!(at("1, -.5, 2.,+3e2 "), Some(((1, a), rest(""))));
        assert_eq!(at(" 9 ,1,1e-3\r\n2, 3"), Some(((9, b), rest("\r\n2, 3"))));
        for row in [
            "1",
            "1,",
            "1,,2",
            "1,2,",
            "1, nan",
            "1, inf, 0",
            "1, 1e999",
            "1, 1.5D3",
            "1, 1, 1, 1, 1",
            "1, 1, 1, 1,",
            "a, 1, 1",
            "-1, 0, 0",
            "1, 0.0000000000000000000001",
            "1, 1 2",
            "1, 1\r",
            "1\n, 2, 3",
        ] {
            assert_eq!(at(row), None, "{row}");
        }
    }
}
