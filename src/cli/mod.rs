//! Command line: `run`, `check`, `info` and `lcp`.

mod args;
mod check;
mod connect;
mod error;
mod exit;
#[cfg(test)]
mod files_tests;
mod info;
mod lcp;
mod overrides;
mod run;
#[cfg(test)]
mod run_tests;
mod signals;
mod version;

use std::ffi::OsString;
use std::io::{self, IsTerminal, Write};

use clap::Parser;
use clap::error::ErrorKind;

use args::{Args, Command};
use connect::Numerics;
use error::CliError;
pub use exit::Exit;

/// Runs the program with its arguments, the program's name first.
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
        Command::Check(args) => check::check(args, &numerics),
        Command::Info(args) => info::info(args),
        Command::Lcp(args) => lcp::lcp(args),
    };
    done.unwrap_or_else(|error| {
        complain(&format!("error: {error}"));
        error.exit()
    })
}

/// Help and version are no errors.
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

/// The command as typed, with the program's bare name; arguments with blanks in quotes.
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

/// Prints to the standard output, unless that is a closed pipe.
fn print(lines: &[String]) -> Result<(), CliError> {
    let mut out = io::stdout().lock();
    let mut lines = lines.iter();
    let printed = lines.try_for_each(|line| writeln!(out, "{line}"));
    on_screen(printed.and_then(|()| out.flush()))
}

/// What became of printing; a closed pipe is nobody's error.
fn on_screen(printed: io::Result<()>) -> Result<(), CliError> {
    match printed {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(CliError::Screen(error)),
        _ => Ok(()),
    }
}

/// Prints to the standard error, unless that is a closed pipe.
fn complain(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{}", text.trim_end());
}

/// Whether messages on the standard error are coloured.
fn coloured() -> bool {
    io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}
