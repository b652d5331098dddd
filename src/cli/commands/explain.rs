//! The subcommand `explain`.

use crate::cli::args::ExplainArgs;
use crate::cli::error::CliError;
use crate::cli::exit::Exit;
use crate::cli::terminal::print;
use crate::deck::{find_keyword, keywords};
use crate::diagnostics::{Code, closest, wrapped};

/// The page that has an example of every code.
const MESSAGES: &str = include_str!("../../../docs/messages.md");

/// Explains keywords and codes of messages, one after the other: the longest beginning of the words is
/// taken that is one of them.
pub(in crate::cli) fn explain(args: &ExplainArgs) -> Result<Exit, CliError> {
    let mut rest = &args.words[..];
    let mut texts = Vec::new();
    while !rest.is_empty() {
        let beginnings = (1..=rest.len()).rev().map(|count| rest.split_at(count));
        let known = |(words, others): (&[String], _)| Some((explained(words)?, others));
        let (text, others) = (beginnings.filter_map(known).next()).ok_or_else(|| unknown(rest))?;
        texts.push(text.trim_end().to_owned());
        rest = others;
    }
    print(&[texts.join("\n\n")])?;
    Ok(Exit::Finished)
}

/// What some words mean: a code, or a keyword with or without its star.
fn explained(words: &[String]) -> Option<String> {
    let name = name(words);
    let is_named = |code: &&Code| code.id().eq_ignore_ascii_case(&name);
    let code = Code::ALL.iter().find(is_named);
    let keyword = || find_keyword(&name).or_else(|| find_keyword(&name.replace(['-', '_'], " ")));
    code.map(|code| explanation(*code))
        .or_else(|| keyword().map(|keyword| keyword.explanation()))
}

/// The words as one, without the star of a keyword.
fn name(words: &[String]) -> String {
    let typed = words.join(" ");
    typed.trim_start_matches('*').trim().to_owned()
}

/// Meaning, cause, cure and example of a code.
fn explanation(code: Code) -> String {
    let head = format!("{}: {}", code.id(), code.meaning());
    let texts = [&head, code.cause(), code.cure()];
    let text = texts.map(|text| wrapped(text, 0)).join("\n");
    match example(code) {
        Some(example) => format!("{text}\nexample (docs/messages.md has the decks)\n{example}"),
        None => text,
    }
}

/// The example of a code: a deck, or a change of one, and what the program says about it.
fn example(code: Code) -> Option<String> {
    let (_, entry) = MESSAGES.split_once(&format!("\n### {}\n", code.id()))?;
    let entry = entry.split("\n### ").next()?;
    // behind the paragraph of the cure
    let (_, example) = entry.split_once("\n\nCure: ")?.1.split_once("\n\n")?;
    let lines = example.lines().filter(|line| !line.starts_with("```"));
    Some(lines.map(|line| format!("  {line}\n")).collect())
}

/// The error of words that begin with neither a keyword nor a code: all of them where they are like one,
/// or the first.
fn unknown(words: &[String]) -> CliError {
    let known = || {
        let codes = Code::ALL.iter().map(|code| code.id());
        keywords().map(|keyword| keyword.name).chain(codes)
    };
    let beginnings = (1..=words.len()).rev().map(|count| &words[..count]);
    let meant = |words: &[String]| closest(&name(words), known()).map(|meant| (words.len(), meant));
    let (count, meant) = beginnings.filter_map(meant).next().unzip();
    CliError::Unexplained {
        word: words[..count.unwrap_or(1)].join(" "),
        meant,
    }
}
