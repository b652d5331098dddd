//! The subcommands `check`, `explain`, `flatten`, `info`, `lsp` and `lcp`, and the reading of a deck, which these
//! commands share with `run`.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::Path;

use super::args::{
    CheckArgs, DeckArgs, ExplainArgs, FlattenArgs, Format, InfoArgs, LcpArgs, LspArgs, VERSION,
};
use super::error::{CliError, Exit};
use super::terminal::{coloured, complain, print};
use crate::deck::{Keyword, Status, find_keyword, find_word, keywords, not_regular, open_regular};
use crate::diagnostics::{Code, Diagnostics, EarlierDeck, Severity, Sources, closest, wrapped};
use crate::dynamics::{Observer, RunError, RunSummary};
use crate::editor::{Program, serve};
use crate::flat_deck::{difference, flat_deck};
use crate::lcp::solve_json;
use crate::output::{
    Checkpoint, Existing, FileError, ModelEcho, ResultSummary, check_names, deck_line,
    is_checkpoint, picture, write_whole,
};
use crate::prepare::{PreparedModel, prepare};
use crate::{dynamics, reader};

/// Reads a deck and describes its model.
pub(super) fn check(args: &CheckArgs, numerics: &Numerics) -> Result<Exit, CliError> {
    let earlier = old_job(&args.deck)?.map(|earlier| earlier.as_earlier_deck());
    let loaded = load(&args.deck, earlier, numerics)?;
    if args.format == Format::Json {
        print(std::slice::from_ref(&loaded.json))?;
        return Ok(match loaded.model {
            Some(_) => Exit::Finished,
            None => Exit::Rejected,
        });
    }
    complain(&loaded.all_messages);
    let Some(model) = &loaded.model else {
        print(&[loaded.line(&args.deck.path, None)])?;
        return Ok(Exit::Rejected);
    };
    describe(&args.deck, &loaded, model)?;
    if let Some(path) = &args.picture {
        write_file(path, &picture(&model.model, args.window), args.overwrite)?;
    }
    Ok(Exit::Finished)
}

/// Prints a description of the model of a deck, and advice on its increments.
pub(super) fn describe(
    deck: &DeckArgs,
    loaded: &Loaded,
    model: &PreparedModel,
) -> Result<(), CliError> {
    print(&[loaded.line(&deck.path, None)])?;
    check_names(&model.model)?;
    let echo = ModelEcho::new(&model.model);
    print(&echo.lines(model))?;
    print(&echo.guide())
}

/// Reads a deck, which may continue an earlier one; a deck that cannot be opened is an error of the file system.
pub(super) fn load(
    deck: &DeckArgs,
    earlier: Option<EarlierDeck>,
    numerics: &Numerics,
) -> Result<Loaded, CliError> {
    openable(&deck.path)?;
    Ok((numerics.load)(deck, earlier, coloured()))
}

/// The checkpoint that the command line names for `*RESTART, READ`.
pub(super) fn old_job(deck: &DeckArgs) -> Result<Option<Checkpoint>, CliError> {
    let Some(job) = &deck.oldjob else {
        return Ok(None);
    };
    let path = match is_checkpoint(job) {
        true => job.clone(),
        false => {
            let mut name = job.clone().into_os_string();
            name.push(".restart");
            name.into()
        }
    };
    let earlier = Checkpoint::read(&path, VERSION)?;
    match earlier.origin.extension > 0.0 {
        true => Err(CliError::Extended(path)),
        false => Ok(Some(earlier)),
    }
}

/// Refuses a deck that cannot be opened.
fn openable(path: &Path) -> Result<(), CliError> {
    open_regular(path).map_err(FileError::new("read the deck", path))?;
    Ok(())
}

/// The page with an example for every code.
const MESSAGES: &str = include_str!("../../docs/messages.md");

/// Explains keywords, codes of messages and words of other programs, one after the other; of the words that remain, the
/// longest known beginning is always explained next.
pub(super) fn explain(args: &ExplainArgs) -> Result<Exit, CliError> {
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

/// Explanation of some words: a code, a keyword with or without its star, or a word that is no keyword.
fn explained(words: &[String]) -> Option<String> {
    let name = name(words);
    let is_named = |code: &&Code| code.id().eq_ignore_ascii_case(&name);
    let code = Code::ALL.iter().find(is_named);
    let keyword = || find_keyword(&name).or_else(|| find_keyword(&name.replace(['-', '_'], " ")));
    code.map(|code| explanation(*code))
        .or_else(|| keyword().map(|keyword| keyword.explanation()))
        .or_else(|| find_word(&name).map(|word| word.explanation()))
}

/// The words as one text, without the star of a keyword.
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

/// The example of a code: a deck, or a change of a deck, and the message of the program about it.
fn example(code: Code) -> Option<String> {
    let (_, entry) = MESSAGES.split_once(&format!("\n### {}\n", code.id()))?;
    let entry = entry.split("\n### ").next()?;
    // behind the paragraph of the cure
    let (_, example) = entry.split_once("\n\nCure: ")?.1.split_once("\n\n")?;
    let lines = example.lines().filter(|line| !line.starts_with("```"));
    Some(lines.map(|line| format!("  {line}\n")).collect())
}

/// The error for words that begin with neither a keyword nor a code. The error names as many of the words as resemble a
/// keyword or a code, else the first word.
fn unknown(words: &[String]) -> CliError {
    let known = || {
        let codes = Code::ALL.iter().map(|code| code.id());
        keywords().map(|keyword| keyword.name).chain(codes)
    };
    let beginnings = (1..=words.len()).rev().map(|count| &words[..count]);
    let meant = |words: &[String]| closest(&name(words), known()).map(|meant| (words.len(), meant));
    let first = words
        .first()
        .map_or("", |word| word.trim_start_matches('*'));
    let about = keywords_about(first);
    let (count, meant) = match about.is_empty() {
        true => beginnings.filter_map(meant).next().unzip(),
        false => (None, None),
    };
    CliError::Unexplained {
        word: words[..count.unwrap_or(1)].join(" "),
        meant,
        about,
    }
}

/// Largest number of keywords that are suggested for a word.
const MOST_ABOUT: usize = 5;

/// Keywords whose name or explanation has a word: keywords that the program reads come first, and among these the
/// keywords with the word in their names.
fn keywords_about(word: &str) -> Vec<&'static str> {
    let word = word.to_lowercase();
    let word = word.strip_suffix('s').unwrap_or(&word);
    let has = |text: &str| {
        let text = text.to_lowercase();
        let mut words = text.split(|c: char| !c.is_alphanumeric());
        words.any(|one| one.starts_with(word))
    };
    let rank = |keyword: &Keyword| {
        let mut texts = keyword.parameters.iter();
        let in_text = has(keyword.text) || texts.any(|parameter| has(parameter.text));
        match (has(keyword.name), in_text, keyword.status) {
            (false, false, _) => None,
            (true, _, Status::Read) => Some(0),
            (false, true, Status::Read) => Some(1),
            _ => Some(2),
        }
    };
    if word.len() < 4 {
        return Vec::new();
    }
    let mut found: Vec<_> = keywords()
        .filter_map(|keyword| Some((rank(keyword)?, keyword.name)))
        .collect();
    found.sort_by_key(|(rank, _)| *rank);
    let names = found.into_iter().map(|(_, name)| name);
    names.take(MOST_ABOUT).collect()
}

/// Writes a deck as one flat deck, after a test that the flat deck reads as the same model. `flatten` rejects a deck
/// that `check` rejects.
pub(super) fn flatten(args: &FlattenArgs) -> Result<Exit, CliError> {
    openable(&args.deck.path)?;
    let earlier = old_job(&args.deck)?.map(|earlier| earlier.as_earlier_deck());
    let mut sources = Sources::with_settings(&args.deck.settings, earlier);
    let mut d = Diagnostics::with_strictness(args.deck.strictness());
    let model = reader::read_model(&args.deck.path, &mut sources, &mut d);
    // the flat deck has the nodes where the deck has them
    let sound = model.filter(|model| prepare(model.clone(), &mut d).is_some());
    let Some(model) = sound else {
        complain(&d.render(&sources, coloured()));
        return Ok(Exit::Rejected);
    };
    check_names(&model)?;
    let text = flat_deck(&model);
    if let Some(what) = difference(&text, &model) {
        complain(&format!(
            "error: this deck cannot be written as a flat deck that reads as the same model: {what} would differ \
             (docs/reliability.md)"
        ));
        return Ok(Exit::Rejected);
    }
    match &args.output {
        Some(path) => write_file(path, &text, args.overwrite)?,
        None => print(&[text.trim_end().to_owned()])?,
    }
    Ok(Exit::Finished)
}

/// Describes a result file.
pub(super) fn info(args: &InfoArgs) -> Result<Exit, CliError> {
    print(&ResultSummary::read(&args.result)?.lines())?;
    Ok(Exit::Finished)
}

/// Serves an editor until it ends.
pub(super) fn lsp(_: &LspArgs) -> Result<Exit, CliError> {
    let program = Program {
        check: |path, sources| {
            let mut d = Diagnostics::new();
            prepared(path, sources, &mut d);
            d
        },
        explain: explanation,
        version: VERSION,
    };
    match serve(program).map_err(CliError::Editor)? {
        true => Ok(Exit::Finished),
        false => Ok(Exit::Stopped),
    }
}

/// Solves a complementarity problem given as JSON and prints the answer as JSON.
pub(super) fn lcp(args: &LcpArgs) -> Result<Exit, CliError> {
    let text = open_regular(&args.problem).and_then(io::read_to_string);
    let text = text.map_err(FileError::new("read", &args.problem))?;
    let answer = solve_json(&text);
    print(&[answer.text])?;
    Ok(if answer.solved {
        Exit::Finished
    } else {
        Exit::Stopped
    })
}

/// Writes a file completely or not at all; an existing file is replaced only if the user asks for it. The function
/// refuses to replace anything but a regular file; it replaces a link by a file.
pub(super) fn write_file(path: &Path, text: &str, overwrite: bool) -> Result<(), CliError> {
    let failed = FileError::new("write", path);
    match fs::symlink_metadata(path) {
        Ok(_) if !overwrite => {
            let path = path.to_owned();
            return Err(CliError::Exists { path });
        }
        // also a link to something else, as /dev/stdout is
        Ok(_) if fs::metadata(path).is_ok_and(|data| !data.is_file()) => {
            return Err(failed(not_regular()).into());
        }
        Err(error) if error.kind() != ErrorKind::NotFound => return Err(failed(error).into()),
        _ => {}
    }
    let existing = match overwrite {
        true => Existing::Replaced,
        false => Existing::Stays,
    };
    Ok(write_whole(path, text, existing).map_err(failed)?)
}

/// A deck after reading.
#[derive(Debug, Clone, Default)]
pub(super) struct Loaded {
    /// The model, ready to run, if the deck has no errors.
    pub model: Option<PreparedModel>,
    /// Errors, warnings and notes for the screen of `check`.
    pub all_messages: String,
    /// Errors, warnings and notes as JSON.
    pub json: String,
    /// Messages for the screen of `run`, without the messages about differences from other codes.
    pub messages: String,
    /// Messages without colour, for the log.
    pub plain_messages: String,
    /// Number of errors.
    pub errors: usize,
    /// Number of warnings.
    pub warnings: usize,
    /// The deck and the files it includes.
    pub sources: Sources,
}

impl Loaded {
    /// The line about the deck; `log` names the file that holds its warnings.
    pub fn line(&self, deck: &Path, log: Option<&Path>) -> String {
        deck_line(deck, &self.sources, [self.errors, self.warnings], log)
    }
}

/// Function that reads a deck; the last argument says whether messages are coloured.
type ReadDeck = fn(&DeckArgs, Option<EarlierDeck>, bool) -> Loaded;
/// Function that solves all steps of a model.
type Solve = fn(&PreparedModel, &mut dyn Observer) -> Result<RunSummary, RunError>;

/// Reader and solver that the commands call; tests replace these functions.
pub(super) struct Numerics {
    pub load: ReadDeck,
    pub solve: Solve,
}

impl Numerics {
    /// The reader and the solver of this program.
    pub fn connected() -> Self {
        Numerics {
            load: read_deck,
            solve: dynamics::run,
        }
    }
}

/// Reads and prepares a deck; there is no model if the deck has errors.
fn prepared(path: &Path, sources: &mut Sources, d: &mut Diagnostics) -> Option<PreparedModel> {
    let model = reader::read_model(path, sources, d);
    let model = model.and_then(|model| prepare(model, d))?;
    match check_names(&model.model) {
        Ok(()) => Some(model),
        Err(error) => {
            d.error_without_place(Code::BadName, error.to_string());
            None
        }
    }
}

/// Reads a deck for the screen.
fn read_deck(deck: &DeckArgs, earlier: Option<EarlierDeck>, colour: bool) -> Loaded {
    let mut sources = Sources::with_settings(&deck.settings, earlier);
    let mut d = Diagnostics::with_strictness(deck.strictness());
    let model = prepared(&deck.path, &mut sources, &mut d);
    let ours = d.without(Code::LongNumber);
    Loaded {
        model,
        all_messages: d.render(&sources, colour),
        json: d.json(&sources),
        messages: ours.render(&sources, colour),
        plain_messages: ours.render(&sources, false),
        errors: d.count(Severity::Error),
        warnings: d.count(Severity::Warning),
        sources,
    }
}
