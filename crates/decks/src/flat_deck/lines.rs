//! Writer of a deck: keyword lines, data lines, names and numbers.

use crate::diagnostics::WIDTH;

/// Length up to which a number needs no exponent.
const SHORT: usize = 12;

/// Largest number of entries of a data line that lists numbers.
const MOST_ENTRIES: usize = 16;

/// A deck being written.
#[derive(Default)]
pub(super) struct DeckWriter(String);

impl DeckWriter {
    /// The whole text.
    pub fn text(self) -> String {
        self.0
    }

    /// Writes a keyword line with its parameters; a line that is longer than 80 characters is continued on the next
    /// line.
    pub fn card(&mut self, keyword: &str, parameters: impl IntoIterator<Item = String>) {
        let mut width = 1 + keyword.len();
        self.0.push('*');
        self.0.push_str(keyword);
        for parameter in parameters {
            let length = parameter.chars().count();
            let breaks = width + 3 + length > WIDTH;
            self.0.push_str(if breaks { ",\n" } else { ", " });
            width = length + if breaks { 0 } else { width + 2 };
            self.0.push_str(&parameter);
        }
        self.0.push('\n');
    }

    /// Writes a data line.
    pub fn row(&mut self, fields: impl IntoIterator<Item = String>) {
        let fields: Vec<String> = fields.into_iter().collect();
        self.0.push_str(&fields.join(", "));
        self.0.push('\n');
    }

    /// Writes the entries of a list on data lines.
    pub fn list(&mut self, labels: &[u64]) {
        for labels in labels.chunks(MOST_ENTRIES) {
            self.row(labels.iter().map(u64::to_string));
        }
    }
}

/// A parameter with its value.
pub(super) fn set(parameter: &str, value: impl std::fmt::Display) -> String {
    format!("{parameter}={value}")
}

/// A parameter with a name as its value.
pub(super) fn named(parameter: &str, value: &str) -> String {
    set(parameter, name(value))
}

/// A name, in quotation marks if it would not be read as one name without quotation marks.
pub(super) fn name(typed: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || " _-.+/()".contains(c);
    let begins = typed.starts_with(|c: char| c.is_alphabetic() || c == '_');
    match begins && !typed.ends_with(' ') && typed.chars().all(is_plain) {
        true => typed.to_owned(),
        false => format!("\"{typed}\""),
    }
}

/// A short text that reads as exactly the given number.
pub(super) fn number(value: f64) -> String {
    let (plain, scientific) = (format!("{value:?}"), format!("{value:e}"));
    match plain.len() <= SHORT || plain.len() <= scientific.len() {
        true => plain,
        false => scientific,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_whole() {
        let texts = [1.0, -0.5, 210000.0, 7.8e-9, 1e300, -0.0, 0.00012].map(number);
        assert_eq!(
            texts,
            [
                "1.0", "-0.5", "210000.0", "7.8e-9", "1e300", "-0.0", "0.00012"
            ]
        );
        for value in [0.1 + 0.2, f64::MIN_POSITIVE, 5e-324, f64::MAX, 1.0 / 3.0] {
            assert_eq!(number(value).parse(), Ok(value));
        }
    }

    #[test]
    fn names_that_need_quotation_marks_have_them() {
        let names = [
            "BODY",
            "Stiff Rubber",
            "_S-1.2",
            "12",
            "1e5",
            "A,B",
            " A",
            "A ",
        ]
        .map(name);
        assert_eq!(
            names,
            [
                "BODY",
                "Stiff Rubber",
                "_S-1.2",
                "\"12\"",
                "\"1e5\"",
                "\"A,B\"",
                "\" A\"",
                "\"A \""
            ]
        );
    }

    #[test]
    fn long_keyword_lines_are_continued() {
        let mut lines = DeckWriter::default();
        let parameters = ["A", "B", "C"].map(|name| set(name, "x".repeat(40)));
        lines.card("KEY", parameters.clone());
        let [a, b, c] = parameters;
        assert_eq!(lines.text(), format!("*KEY, {a},\n{b},\n{c}\n"));
    }
}
