//! The subcommand `explain`.

use crate::cli::args::ExplainArgs;
use crate::cli::error::CliError;
use crate::cli::exit::Exit;
use crate::cli::terminal::print;
use crate::deck::{find_keyword, keywords};
use crate::diagnostics::{Code, closest, wrapped};

/// The page that has an example of every code.
const MESSAGES: &str = include_str!("../../../docs/messages.md");

/// Explains a keyword or the code of a message.
pub(in crate::cli) fn explain(args: &ExplainArgs) -> Result<Exit, CliError> {
    let typed = args.words.join(" ");
    let word = typed.trim_start_matches('*').trim();
    let code = Code::ALL
        .iter()
        .find(|code| code.id().eq_ignore_ascii_case(word));
    let text = match (code, find_keyword(word)) {
        (Some(code), _) => explanation(*code),
        (None, Some(keyword)) => keyword.explanation(),
        (None, None) => return Err(unknown(&typed, word)),
    };
    print(&[text.trim_end().to_string()])?;
    Ok(Exit::Finished)
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

/// The error of a word that is neither a keyword nor a code.
fn unknown(typed: &str, word: &str) -> CliError {
    let codes = Code::ALL.iter().map(|code| code.id());
    let meant = closest(word, keywords().map(|keyword| keyword.name).chain(codes));
    CliError::Unexplained {
        word: typed.to_string(),
        meant,
    }
}
