//! Rows of plain numbers, as nearly all rows of a mesh are: read in one go, without the places of
//! their fields. What is not plain is read field by field.

use super::number;
use super::text::LONGEST_NUMBER;
use smallvec::SmallVec;

/// Digits of a plain integer at most.
const MOST_DIGITS: usize = 18;

/// The numbers of a row that holds integers without sign only, with nothing but blanks between them
/// and the commas.
pub(crate) fn integers(row: &str) -> Option<SmallVec<[u64; 5]>> {
    let mut numbers = SmallVec::new();
    let mut text = after_blanks(row.as_bytes());
    loop {
        let (number, rest) = integer(text)?;
        numbers.push(number);
        text = match after_blanks(rest) {
            [] => return Some(numbers),
            [b',', rest @ ..] => after_blanks(rest),
            _ => return None,
        };
        if text.is_empty() {
            return Some(numbers);
        }
    }
}

/// The integer without sign and the one to three numbers of a row; numbers that are missing are 0.
pub(crate) fn point(row: &str) -> Option<(u64, [f64; 3])> {
    let (label, rest) = integer(after_blanks(row.as_bytes()))?;
    let rest = after_blanks(rest).strip_prefix(b",")?;
    let mut fields = rest.split(|&byte| byte == b',');
    let mut at = [0.0; 3];
    for (x, field) in at.iter_mut().zip(&mut fields) {
        let field = after_blanks(field).trim_ascii_end();
        *x = number::plain_real(field).filter(|_| field.len() <= LONGEST_NUMBER)?;
    }
    fields.next().is_none().then_some((label, at))
}

/// The integer without sign at the start of a text, and what follows it.
fn integer(text: &[u8]) -> Option<(u64, &[u8])> {
    let (value, rest) = number::digits(0, text);
    let count = text.len() - rest.len();
    (1..=MOST_DIGITS).contains(&count).then_some((value, rest))
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

    #[test]
    fn plain_rows_are_what_their_fields_are() {
        let rows = [
            "1, 2, 3",
            "1,2,3,",
            " 7 , 8 , ",
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
        ];
        for row in rows {
            let fields = Fields::new(row).map(|(start, end)| number::integer(&row[start..end]));
            let fields: Option<Vec<_>> = fields
                .map(|number| u64::try_from(number.ok()?).ok())
                .collect();
            let found = integers(row).map(|found| found.to_vec());
            assert!(
                found.is_none() || found == fields,
                "{row}: {found:?}, not {fields:?}"
            );
        }
        let plain = rows.iter().filter(|row| integers(row).is_some());
        assert_eq!(plain.count(), 4);
    }

    #[test]
    fn plain_points_have_finite_numbers() {
        assert_eq!(point("1, -.5, 2.,+3e2 "), Some((1, [-0.5, 2.0, 300.0])));
        assert_eq!(point(" 9 ,1,1e-3"), Some((9, [1.0, 1e-3, 0.0])));
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
            "a, 1, 1",
            "-1, 0, 0",
            "1, 0.0000000000000000000001",
            "1, 1 2",
        ] {
            assert_eq!(point(row), None, "{row}");
        }
    }
}
