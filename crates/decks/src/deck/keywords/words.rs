//! Words of engineers and of other programs that are no keywords, from `words.txt`: what stands in their place.
//!
//! ```text
//! - bolt, preload                       the words, in small letters
//! Bolts are tightened by a section.     what is said about them
//! > *PRE-TENSION SECTION, NODE=900      lines of a deck that use it
//! ```
//!
//! Lines are continued and commented as in the table of keywords.

use super::documents::push;
use super::table::lines;
use crate::deck::text::fold;
use crate::diagnostics::wrapped;
use std::sync::LazyLock;

/// Words for one thing, which is done by other means or not at all.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Word {
    /// All words for it.
    pub names: Vec<&'static str>,
    /// Whether it is done, and what to use.
    pub text: &'static str,
    /// Lines of a deck, or nothing.
    pub example: String,
}

static ALL: LazyLock<Vec<Word>> = LazyLock::new(|| {
    let all = lines(include_str!("words.txt"));
    let entries = all.chunk_by(|_, line| !line.starts_with("- "));
    entries.map(entry).collect()
});

/// All of them.
pub fn words() -> impl Iterator<Item = &'static Word> {
    ALL.iter()
}

/// The entry of a word, blanks, hyphens and case aside; an `s` at its end may be too much.
pub fn find_word(typed: &str) -> Option<&'static Word> {
    let typed = folded(typed);
    let has = |typed: &str| words().find(|word| word.names.iter().any(|n| folded(n) == typed));
    has(&typed).or_else(|| has(typed.strip_suffix('S')?))
}

/// A word without blanks and hyphens, in capitals.
fn folded(word: &str) -> String {
    fold(&word.replace(['-', '_'], " "))
}

/// The lines of one entry.
fn entry(lines: &[&'static str]) -> Word {
    let with = |mark: &'static str| lines.iter().filter_map(move |line| line.strip_prefix(mark));
    let is_sentence = |line: &&&str| !line.starts_with(['-', '>']);
    Word {
        names: with("- ").flat_map(|names| names.split(", ")).collect(),
        text: lines.iter().find(is_sentence).unwrap_or(&""),
        example: with("> ").map(|line| format!("  {line}\n")).collect(),
    }
}

impl Word {
    /// Text for the screen: the words, what is said about them, and an example.
    pub fn explanation(&self) -> String {
        let names = wrapped(&self.names.join(", "), 2);
        let mut text = format!("{names}\n{}", wrapped(self.text, 0));
        push(&mut text, "in its place", &self.example);
        text
    }
}
