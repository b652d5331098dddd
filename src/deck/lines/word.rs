//! Matching of keywords, parameters and words: case and blanks aside, a unique beginning of at
//! least four letters suffices, and a likely typing error gets a suggestion.

use crate::diagnostics::closest;

/// Shortest abbreviation that is understood.
const SHORTEST: usize = 4;

/// How a typed word matches a list of known words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Match {
    /// It is this one.
    Exact(&'static str),
    /// It is the beginning of this one and of no other.
    Abbreviation(&'static str),
    /// It is none of them; the one probably meant.
    Unknown(Option<&'static str>),
}

/// Upper case without blanks: how words and unquoted names are compared.
pub(crate) fn fold(word: &str) -> String {
    folded(word).collect()
}

fn folded(word: &str) -> impl Iterator<Item = char> {
    let visible = word.chars().filter(|c| !c.is_whitespace());
    visible.flat_map(char::to_uppercase)
}

/// Looks a word up among known ones, blanks and case aside.
pub(crate) fn find(word: &str, known: impl Iterator<Item = &'static str> + Clone) -> Match {
    match find_known(word, known.clone()) {
        Match::Unknown(_) => Match::Unknown(suggestion(&fold(word), known)),
        found => found,
    }
}

/// As [`find`], without a suggestion for an unknown word.
pub(crate) fn find_known(word: &str, known: impl Iterator<Item = &'static str> + Clone) -> Match {
    let short = fold(word);
    if let Some(exact) = known.clone().find(|k| folded(k).eq(short.chars())) {
        return Match::Exact(exact);
    }
    let size = short.chars().count();
    let begins = |k: &&str| folded(k).take(size).eq(short.chars());
    let mut longer = known.filter(begins);
    match (longer.next(), longer.next()) {
        (Some(only), None) if size >= SHORTEST => Match::Abbreviation(only),
        _ => Match::Unknown(None),
    }
}

/// The known word at the smallest edit distance, if that is small.
fn suggestion(
    short: &str,
    known: impl Iterator<Item = &'static str> + Clone,
) -> Option<&'static str> {
    let pairs: Vec<(String, &'static str)> = known.map(|k| (fold(k), k)).collect();
    let best = closest(short, pairs.iter().map(|(f, _)| f.as_str()))?;
    pairs.iter().find(|(f, _)| f == best).map(|&(_, k)| k)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_match_without_blanks_and_case() {
        let known = ["NODE", "NODE FILE", "AMPLITUDE", "END STEP"].into_iter();
        assert_eq!(find("endstep", known.clone()), Match::Exact("END STEP"));
        assert_eq!(
            find("AMPL", known.clone()),
            Match::Abbreviation("AMPLITUDE")
        );
        assert_eq!(find("AMP", known.clone()), Match::Unknown(None));
        assert_eq!(find("AMPLITUDEXYZ", known.clone()), Match::Unknown(None));
        assert_eq!(find("AMPLTUDE", known), Match::Unknown(Some("AMPLITUDE")));
    }
}
