//! Command line: commands of the program, and commands of the Python package, which it hands over.

mod allocator;
mod args;
mod commands;
mod error;
mod manual;
mod package;
mod run;
mod signals;
mod terminal;

use std::ffi::OsString;
use std::io::{self, Write};

use clap::Parser;
use clap::error::ErrorKind;

pub use allocator::Allocator;
use args::{Args, Command};
use commands::Numerics;
use error::CliError;
pub use error::Exit;
pub use manual::manual;
use terminal::{complain, on_screen, print};

/// Runs the program with its arguments; the first one is the name of the program.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> Exit {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let args = match Args::try_parse_from(&arguments) {
        Ok(args) => args,
        Err(error) => return usage(&error),
    };
    let numerics = Numerics::connected();
    let done = match &args.command {
        Command::Run(args) => (signals::receive().map_err(CliError::Signals))
            .and_then(|interrupt| run::run(args, &typed(&arguments), &numerics, &interrupt)),
        Command::Flatten(args) => commands::flatten(args),
        Command::Check(args) => commands::check(args, &numerics),
        Command::Explain(args) => commands::explain(args),
        Command::Info(args) => commands::info(args),
        Command::Lsp(args) => commands::lsp(args),
        Command::Lcp(args) => commands::lcp(args),
        Command::Package(command) => package::run(command),
        Command::Completion(args) => printed(&manual::completion(args.shell)),
        Command::Manual => printed(&manual()),
    };
    done.unwrap_or_else(|error| {
        complain(&format!("error: {error}"));
        error.exit()
    })
}

/// Prints a text and returns the exit code.
fn printed(text: &str) -> Result<Exit, CliError> {
    print(&[text.trim_end().to_owned()])?;
    Ok(Exit::Finished)
}

/// Prints help, version or the error of the command line, and returns the exit code.
fn usage(error: &clap::Error) -> Exit {
    let is_asked_for = matches!(
        error.kind(),
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion
    );
    let printed = error.print().and_then(|()| io::stdout().flush());
    match (is_asked_for, on_screen(printed)) {
        (true, Ok(())) => Exit::Finished,
        (true, Err(error)) => {
            complain(&format!("error: {error}"));
            error.exit()
        }
        (false, _) => Exit::Usage,
    }
}

/// The command as typed, with the name of the program without folders; arguments with blanks are in quotes.
fn typed(arguments: &[OsString]) -> String {
    let quoted = |argument: &OsString| {
        let text = argument.to_string_lossy();
        match text.is_empty() || text.contains(char::is_whitespace) {
            true => format!("'{text}'"),
            false => text.into_owned(),
        }
    };
    let rest = arguments.iter().skip(1).map(quoted);
    let words: Vec<String> = std::iter::once("stickslip".to_owned())
        .chain(rest)
        .collect();
    words.join(" ")
}
