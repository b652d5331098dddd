/// The candidate that `word` is probably meant to be: the one with the fewest typing errors, if
/// they are few for the word's length.
pub fn closest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word = word.to_uppercase();
    let allowed = (word.chars().count() / 3).min(2);
    candidates
        .into_iter()
        .map(|candidate| (typing_errors(&word, &candidate.to_uppercase()), candidate))
        .filter(|&(errors, _)| errors <= allowed)
        .min_by_key(|&(errors, _)| errors)
        .map(|(_, candidate)| candidate)
}

/// Insertions, deletions, replacements and exchanges of neighbours between two words.
fn typing_errors(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    if a.len().abs_diff(b.len()) > 2 {
        return usize::MAX;
    }
    let mut before_last = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 0..a.len() {
        let mut row = vec![i + 1];
        for j in 0..b.len() {
            let replace = last[j] + usize::from(a[i] != b[j]);
            let mut best = replace.min(last[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j] {
                best = best.min(before_last[j - 1] + 1);
            }
            row.push(best);
        }
        before_last = std::mem::replace(&mut last, row);
    }
    last[b.len()]
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
    }
}
