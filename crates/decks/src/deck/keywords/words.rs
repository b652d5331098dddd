//! Words of engineers and of other programs that are no keywords, and the cards to use in place of these words, from
//! `words.txt`.
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

/// Words for one task, which other cards do or the program does not do.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Word {
    /// All words for the task.
    pub names: Vec<&'static str>,
    /// Sentence that says whether the program does the task, and which cards to use.
    pub text: &'static str,
    /// Lines of a deck that do the task; empty if there are no such lines.
    pub example: String,
}

static ALL: LazyLock<Vec<Word>> = LazyLock::new(|| {
    let all = lines(include_str!("words.txt"));
    let entries = all.chunk_by(|_, line| !line.starts_with("- "));
    entries.map(entry).collect()
});

/// All entries.
pub fn words() -> impl Iterator<Item = &'static Word> {
    ALL.iter()
}

/// The entry of a word. Blanks, hyphens, case and an `s` at the end of the word do not matter.
pub fn find_word(typed: &str) -> Option<&'static Word> {
    let typed = folded(typed);
    let has = |typed: &str| words().find(|word| word.names.iter().any(|n| folded(n) == typed));
    has(&typed).or_else(|| has(typed.strip_suffix('S')?))
}

/// A word in capitals, with blanks in place of hyphens and underscores, in the form in which words are compared.
fn folded(word: &str) -> String {
    fold(&word.replace(['-', '_'], " "))
}

/// Makes an entry from its lines.
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
    /// Text of an entry for the screen: the words, the sentence about these words, and an example.
    pub fn explanation(&self) -> String {
        let names = wrapped(&self.names.join(", "), 2);
        let mut text = format!("{names}\n{}", wrapped(self.text, 0));
        push(&mut text, "in its place", &self.example);
        text
    }
}
