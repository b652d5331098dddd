//! Suggestions for misspelt words: the candidate at the smallest edit distance, with exchanges of
//! neighbouring letters counted as one error (optimal string alignment, a restricted
//! Damerau-Levenshtein distance).

/// Most typing errors for which a suggestion is made.
const MOST_ERRORS: usize = 2;

/// The candidate that `word` is probably meant to be: the one with the fewest typing errors, if
/// they are few for the word's length.
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

/// Insertions, deletions, replacements and exchanges of neighbours between two words, if they are
/// no more than allowed.
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

#[cfg(test)]
mod tests {
    use super::closest;

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
}
