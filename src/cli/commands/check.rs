//! The subcommand `check`, and the reading of a deck that it shares with `run`.

use std::path::Path;

use crate::cli::args::{CheckArgs, DeckArgs};
use crate::cli::connect::{Loaded, Numerics};
use crate::cli::error::CliError;
use crate::cli::exit::Exit;
use crate::cli::file::write_file;
use crate::cli::terminal::{coloured, complain, print};
use crate::output::{ModelEcho, check_names, deck_line, picture, regular_file};
use crate::prepare::PreparedModel;

/// Reads a deck and describes its model.
pub(in crate::cli) fn check(args: &CheckArgs, numerics: &Numerics) -> Result<Exit, CliError> {
    let loaded = load(&args.deck, numerics)?;
    complain_of(&loaded.all_messages);
    let Some(model) = &loaded.model else {
        print(&[deck_line_of(&args.deck.path, &loaded, None)])?;
        return Ok(Exit::Rejected);
    };
    describe(&args.deck, &loaded, model)?;
    if let Some(path) = &args.picture {
        write_file(path, &picture(model.model(), args.window), args.overwrite)?;
    }
    Ok(Exit::Finished)
}

/// Prints what a deck holds and what it says about the increment.
pub(super) fn describe(
    deck: &DeckArgs,
    loaded: &Loaded,
    model: &PreparedModel,
) -> Result<(), CliError> {
    print(&[deck_line_of(&deck.path, loaded, None)])?;
    check_names(model.model())?;
    let echo = ModelEcho::new(model.model());
    print(&echo.lines(model))?;
    print(&echo.guide())
}

/// Reads a deck; a deck that cannot be opened is an error of the file system.
pub(super) fn load(deck: &DeckArgs, numerics: &Numerics) -> Result<Loaded, CliError> {
    openable(&deck.path)?;
    Ok((numerics.load)(&deck.path, deck.strictness(), coloured()))
}

/// Refuses a deck that cannot be opened.
pub(super) fn openable(path: &Path) -> Result<(), CliError> {
    let opened = regular_file(path).map(|_| ());
    opened.map_err(|source| CliError::Deck {
        path: path.to_owned(),
        source,
    })
}

/// Prints the errors and warnings of a deck.
pub(super) fn complain_of(messages: &str) {
    if !messages.is_empty() {
        complain(messages);
    }
}

/// The line about the deck; `log` names the file that holds its warnings.
pub(super) fn deck_line_of(deck: &Path, loaded: &Loaded, log: Option<&Path>) -> String {
    deck_line(
        deck,
        loaded.sources.files().len().saturating_sub(1),
        loaded.sources.line_count(),
        loaded.errors,
        loaded.warnings,
        log,
    )
}
