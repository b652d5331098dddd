//! Rows of plain numbers, as nearly all rows of a mesh are: read in one go, without the places of
//! their fields. What is not plain is read field by field.

use super::number;
use super::text::LONGEST_NUMBER;
use smallvec::SmallVec;

/// Digits of a plain integer at most.
const MOST_DIGITS: usize = 18;

/// The numbers of a row that holds integers without sign only.
pub(crate) fn integers(row: &str) -> Option<SmallVec<[u64; 5]>> {
    let mut numbers = SmallVec::new();
    let mut rest = row;
    loop {
        let (number, after) = integer(rest)?;
        numbers.push(number);
        rest = after.strip_prefix(',').unwrap_or(after).trim_ascii_start();
        if rest.is_empty() {
            return Some(numbers);
        }
        if rest.len() == after.len() {
            return None;
        }
    }
}

/// The integer without sign and the one to three numbers of a row; numbers that are missing are 0.
pub(crate) fn point(row: &str) -> Option<(u64, [f64; 3])> {
    let (label, rest) = integer(row)?;
    let mut fields = rest.strip_prefix(',')?.split(',');
    let mut at = [0.0; 3];
    for (x, field) in at.iter_mut().zip(&mut fields) {
        let field = field.trim_ascii();
        *x = number::plain_real(field).filter(|_| field.len() <= LONGEST_NUMBER)?;
    }
    fields.next().is_none().then_some((label, at))
}

/// The integer without sign at the start of a text, and what follows it and blanks.
fn integer(text: &str) -> Option<(u64, &str)> {
    let text = text.trim_ascii_start();
    let digits = text.bytes().take(MOST_DIGITS + 1);
    let count = digits.take_while(u8::is_ascii_digit).count();
    let (digits, rest) = text.split_at(count);
    let value = |sum: u64, byte: u8| 10 * sum + u64::from(byte - b'0');
    let is_plain = (1..=MOST_DIGITS).contains(&count);
    is_plain.then(|| (digits.bytes().fold(0, value), rest.trim_ascii_start()))
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
            " 7 ,\t8 , ",
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
