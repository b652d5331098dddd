//! Numbers of equations: their definitions in the theory and their citations.

use std::fmt;

/// Number (section.equation) of an equation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Number {
    section: usize,
    equation: usize,
}

impl Number {
    /// The number in "3.2".
    pub fn parse(text: &str) -> Option<Self> {
        let (section, equation) = text.split_once('.')?;
        let is_number = |s: &str| !s.is_empty() && s.bytes().all(|b| b.is_ascii_digit());
        (is_number(section) && is_number(equation)).then_some(())?;
        Some(Number {
            section: section.parse().ok()?,
            equation: equation.parse().ok()?,
        })
    }
}

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "({}.{})", self.section, self.equation)
    }
}

/// The equations of the theory with their lines: numbers at the right end of indented lines.
pub fn equations(theory: &str) -> Vec<(usize, Number)> {
    let number = |line: &str| {
        let (formula, rest) = line.strip_prefix("    ")?.rsplit_once("  (")?;
        (!formula.trim().is_empty()).then_some(())?;
        Number::parse(rest.strip_suffix(')')?)
    };
    let lines = theory.lines().enumerate();
    lines
        .filter_map(|(k, line)| Some((k + 1, number(line)?)))
        .collect()
}

/// Places in which the numbers of a section, over all chapters, do not count from 1 without gaps and doubles. A chapter
/// is its path and its text.
pub fn misnumbered(chapters: &[(&str, &str)]) -> Vec<String> {
    let mut all: Vec<(Number, &str, usize)> = chapters
        .iter()
        .flat_map(|(path, text)| {
            equations(text)
                .into_iter()
                .map(|(line, n)| (n, *path, line))
        })
        .collect();
    all.sort();
    let mut offences = Vec::new();
    let mut before: Option<Number> = None;
    for (number, path, line) in all {
        let before = before.replace(number);
        let before = before.filter(|before| before.section == number.section);
        let next = before.map_or(1, |before| before.equation + 1);
        if number.equation != next {
            offences.push(format!(
                "{path}:{line}: {number} has the place of number {next}"
            ));
        }
    }
    offences
}

/// Citations `eq. (3.2)` in comments of a source text, with their lines; in the place of a number
/// citations in another form, such as `eqs (3.2)`.
pub fn citations(source: &str) -> Vec<(usize, Result<Number, String>)> {
    let mut found = Vec::new();
    for (k, line) in source.lines().enumerate() {
        let Some((_, comment)) = line.split_once("//") else {
            continue;
        };
        for (before, number) in numbers(comment) {
            let word = before.trim_end().rsplit([' ', '(']).next().unwrap_or("");
            if before.ends_with("eq. ") {
                found.push((k + 1, Ok(number)));
            } else if ["eq", "eq.", "eqs", "eqs.", "equation"].contains(&word) {
                found.push((k + 1, Err(format!("{word} {number}"))));
            }
        }
    }
    found
}

/// Numbers of equations in the running text of a document, with their lines.
pub fn references(document: &str) -> Vec<(usize, Result<Number, String>)> {
    let own = equations(document);
    let lines = document.lines().enumerate();
    let text = lines.filter(|(k, _)| !own.iter().any(|(line, _)| *line == k + 1));
    text.flat_map(|(k, line)| numbers(line).map(move |(_, number)| (k + 1, Ok(number))))
        .collect()
}

/// All "(3.2)" of a line with the text before them.
fn numbers(line: &str) -> impl Iterator<Item = (&str, Number)> {
    line.match_indices('(').filter_map(|(at, _)| {
        let (number, _) = line[at + 1..].split_once(')')?;
        Some((&line[..at], Number::parse(number)?))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(section: usize, equation: usize) -> Number {
        Number { section, equation }
    }

    #[test]
    fn equations_stand_at_the_right_end_of_indented_lines() {
        let theory =
            "see (3.1)  (3.2)\n    a = b   (3.2)\n    f(3.1) = c\n       d  (10.11)\n      (3.3)\n";
        let found = [(2, number(3, 2)), (4, number(10, 11))];
        assert_eq!(equations(theory), found);
        assert_eq!(references(theory)[0], (1, Ok(number(3, 1))));
    }

    #[test]
    fn wrong_numbers_are_found() {
        let found = |a: &[&str], b: &[&str]| {
            let text = |numbers: &[&str]| -> String {
                numbers.iter().map(|n| format!("    f  ({n})\n")).collect()
            };
            misnumbered(&[("a.md", &text(a)), ("b.md", &text(b))]).len()
        };
        assert_eq!(found(&["2.1", "2.3", "3.1"], &["2.2", "4.1"]), 0);
        assert_eq!(found(&["2.1", "2.1"], &[]), 1);
        assert_eq!(found(&["2.1"], &["2.1"]), 1);
        assert_eq!(found(&["2.1", "2.3"], &[]), 1);
        assert_eq!(found(&["2.1"], &["3.2"]), 1);
    }

    #[test]
    fn citations_have_one_form_and_stand_in_comments() {
        let source = "/// a, eq. (3.2) and eq. (3.4)\nf(3.1); // eq. (3.5)\nf(eq. (3.9));\n// paper eq. 12, a (1.5)\n";
        let found = [(1, 3, 2), (1, 3, 4), (2, 3, 5)];
        let found = found.map(|(line, section, equation)| (line, Ok(number(section, equation))));
        assert_eq!(citations(source), found);
        for wrong in ["eqs (3.2)", "eq (3.2)", "(eqs. (3.2))", "equation (3.2)"] {
            let found = citations(&format!("// {wrong}"));
            assert!(matches!(found[..], [(1, Err(_))]), "{wrong}: {found:?}");
        }
    }
}
