//! Printing on standard output and standard error, with closed pipes and colours.

use std::io::{self, IsTerminal, Write};

use super::error::CliError;

/// Prints to the standard output; a closed pipe is ignored.
pub(super) fn print(lines: &[String]) -> Result<(), CliError> {
    let mut out = io::stdout().lock();
    let mut lines = lines.iter();
    let printed = lines.try_for_each(|line| writeln!(out, "{line}"));
    on_screen(printed.and_then(|()| out.flush()))
}

/// The result of printing, where a closed pipe is not an error.
pub(super) fn on_screen(printed: io::Result<()>) -> Result<(), CliError> {
    match printed {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(CliError::Screen(error)),
        _ => Ok(()),
    }
}

/// Prints a text, if there is one, to the standard error; failures are ignored.
pub(super) fn complain(text: &str) {
    if !text.is_empty() {
        let _ = writeln!(io::stderr().lock(), "{}", text.trim_end());
    }
}

/// Whether messages on the standard error are coloured.
pub(super) fn coloured() -> bool {
    io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}
