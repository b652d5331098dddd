//! Words and numbers in messages: suggestions for misspelt words, text in lines of the screen's width, and
//! floating-point numbers.

/// Largest number of typing errors for which a suggestion is made.
const MOST_ERRORS: usize = 2;

/// The candidate that `word` was probably meant to be: the candidate with the fewest typing errors, if they are few
/// relative to the length of the word.
pub fn closest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word: Vec<char> = capitals(word).collect();
    let allowed = (word.len() / 3).min(MOST_ERRORS);
    let mut letters = Vec::new();
    let mut errors = |candidate: &str| {
        letters.clear();
        letters.extend(capitals(candidate).take(word.len() + allowed + 1));
        let is_near = letters.len().abs_diff(word.len()) <= allowed;
        is_near
            .then(|| typing_errors(&word, &letters, allowed))
            .flatten()
    };
    let counted = candidates
        .into_iter()
        .filter_map(|candidate| Some((errors(candidate)?, candidate)));
    counted
        .min_by_key(|&(errors, _)| errors)
        .map(|(_, candidate)| candidate)
}

fn capitals(word: &str) -> impl Iterator<Item = char> {
    word.chars().flat_map(char::to_uppercase)
}

/// Number of insertions, deletions, replacements and exchanges of neighbours between two words;
/// `None` if the number is larger than allowed.
fn typing_errors(a: &[char], b: &[char], allowed: usize) -> Option<usize> {
    let mut before_last = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    let mut row = Vec::new();
    for i in 0..a.len() {
        row.clear();
        row.push(i + 1);
        for j in 0..b.len() {
            let replace = last[j] + usize::from(a[i] != b[j]);
            let mut best = replace.min(last[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j] {
                best = best.min(before_last[j - 1] + 1);
            }
            row.push(best);
        }
        // Counts never decrease from row to row; an exchange refers to the row before the last.
        if last.iter().chain(&row).all(|&errors| errors > allowed) {
            return None;
        }
        std::mem::swap(&mut before_last, &mut last);
        std::mem::swap(&mut last, &mut row);
    }
    Some(last[b.len()]).filter(|&errors| errors <= allowed)
}

/// Largest number of names that a message lists.
const LISTED: usize = 8;

/// Text that lists the defined names, or the first few names if there are many.
pub fn list_of<'n>(kind: &str, names: impl Iterator<Item = &'n str>) -> String {
    let names: Vec<&str> = names.collect();
    let plural = match kind {
        "list of time points" => "lists of time points".to_string(),
        _ => format!("{kind}s"),
    };
    let shown = names.iter().take(LISTED).copied().collect::<Vec<_>>();
    let more = names.len() - shown.len();
    match (names.len(), more) {
        (0, _) => format!("the deck has no {plural}"),
        (1, _) => format!("the only {kind} is {}", shown[0]),
        (_, 0) => format!("the {plural} are {}", shown.join(", ")),
        _ => format!("the {plural} are {} and {more} more", shown.join(", ")),
    }
}

/// Width of the screen, and of text files for the screen (columns).
pub const WIDTH: usize = 80;

/// A text in lines; each line except the first is indented by `blanks` blanks, and the first keeps
/// its own indentation.
pub fn wrapped(text: &str, blanks: usize) -> String {
    let own = text.len() - text.trim_start().len();
    let first = " ".repeat(own);
    in_lines(first, blanks, text.split_whitespace(), " ").join("\n") + "\n"
}

/// Items in lines, separated by `gap`; the first line begins with `head`, the others with `blanks` blanks.
pub fn in_lines<'t>(
    head: String,
    blanks: usize,
    items: impl IntoIterator<Item = &'t str>,
    gap: &str,
) -> Vec<String> {
    let mut lines = vec![];
    let mut line = head;
    let mut is_empty = true;
    for item in items {
        if !is_empty && line.len() + gap.len() + item.len() > WIDTH {
            lines.push(std::mem::replace(&mut line, " ".repeat(blanks)));
            is_empty = true;
        }
        if !is_empty {
            line.push_str(gap);
        }
        line.push_str(item);
        is_empty = false;
    }
    lines.push(line);
    lines
}

/// Range of magnitudes that are written without an exponent.
const PLAIN: std::ops::Range<f64> = 1e-6..1e16;

/// A number in a message, with an exponent if the number would otherwise have a long row of zeros.
pub fn shown(x: f64) -> String {
    match x == 0.0 || PLAIN.contains(&x.abs()) {
        true => x.to_string(),
        false => format!("{x:e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_word_meant() {
        let words = ["BOUNDARY", "ELSET", "NSET"];
        assert_eq!(closest("BONDARY", words), Some("BOUNDARY"));
        assert_eq!(closest("elst", words), Some("ELSET"));
        assert_eq!(closest("NEST", words), Some("NSET"));
        assert_eq!(closest("FRICTION", words), None);
        assert_eq!(closest("", words), None);
        assert_eq!(closest("OBUNDAYR", words), Some("BOUNDARY"));
        assert_eq!(closest("OBUNADYR", words), None);
        assert_eq!(closest(&"BOUNDARY".repeat(1000), words), None);
    }

    #[test]
    fn lines_are_short_and_behind_blanks() {
        let text = wrapped(&format!("  head {}", "word ".repeat(30)), 4);
        assert!(text.starts_with("  head word") && text.contains("\n    word word"));
        assert!(text.lines().all(|line| line.len() <= 80) && text.lines().count() == 3);
    }

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
