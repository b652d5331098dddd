//! Command line: `run`, `check` and `info`.

mod args;
mod check;
mod connect;
mod error;
mod exit;
mod info;
mod overrides;
mod run;
#[cfg(test)]
mod run_tests;
mod version;

use std::ffi::OsString;
use std::io::{self, IsTerminal, Write};

use clap::Parser;
use clap::error::ErrorKind;

use args::{Args, Command};
use connect::Numerics;
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
        Command::Run(args) => run::run(args, &typed(&arguments), &numerics),
        Command::Check(args) => check::check(args, &numerics),
        Command::Info(args) => info::info(args),
    };
    done.unwrap_or_else(|error| {
        complain(&format!("error: {error}"));
        error.exit()
    })
}

/// Help and version are no errors.
fn usage(error: &clap::Error) -> Exit {
    // The screen may be a closed pipe, which is nobody's error.
    let _ = error.print();
    match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => Exit::Finished,
        _ => Exit::Usage,
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
fn print(lines: &[String]) {
    let mut out = io::stdout().lock();
    for line in lines {
        if writeln!(out, "{line}").is_err() {
            return;
        }
    }
    let _ = out.flush();
}

/// Prints to the standard error, unless that is a closed pipe.
fn complain(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{}", text.trim_end());
}

/// Whether messages on the standard error are coloured.
fn coloured() -> bool {
    io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}
