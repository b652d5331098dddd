//! Rows of plain numbers, as nearly all rows of a mesh are: read in one go, without the places of
//! their fields. What is not plain is read field by field.

use super::number;
use super::text::LONGEST_NUMBER;
use memchr::memchr3;
use smallvec::SmallVec;

/// Digits of a plain integer at most.
const MOST_DIGITS: usize = 18;

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
        let (number, rest) = integer(text)?;
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
    let (label, mut rest) = integer(after_blanks(text))?;
    let mut at = [0.0; 3];
    for (index, x) in at.iter_mut().enumerate() {
        rest = match after_blanks(rest) {
            [b',', rest @ ..] => rest,
            _ if index > 0 => break,
            _ => return None,
        };
        (*x, rest) = real(after_blanks(rest))?;
    }
    let rest = after_blanks(rest);
    ends(rest).then_some(((label, at), rest))
}

/// The integer without sign at the start of a text, and what follows it.
fn integer(text: &[u8]) -> Option<(u64, &[u8])> {
    let (value, rest) = number::digits(0, text);
    let count = text.len() - rest.len();
    (1..=MOST_DIGITS).contains(&count).then_some((value, rest))
}

/// The number at the start of a text and what follows it.
fn real(text: &[u8]) -> Option<(f64, &[u8])> {
    let decimal = number::leading_decimal(text);
    let decimal =
        decimal.filter(|(_, rest)| matches!(rest, [] | [b',' | b' ' | b'\r' | b'\n', ..]));
    decimal.or_else(|| {
        let end = memchr3(b',', b'\r', b'\n', text).unwrap_or(text.len());
        let (field, rest) = text.split_at_checked(end)?;
        let field = field.trim_ascii_end();
        let value = number::plain_real(field)?;
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
            .map(|field| u64::try_from(number::integer(field).ok()?).ok())
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
            let real = |field: &&str| number::real(field).expect("a number").value.to_bits();
            let mut expected: Vec<u64> = fields[1..].iter().map(real).collect();
            expected.resize(3, 0.0_f64.to_bits());
            assert_eq!(number::integer(fields[0]), Ok(label as i64), "{text}");
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
