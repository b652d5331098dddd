//! The first lines of the screen.

use std::path::Path;

use crate::output::file::{RunRecord, utc_now};
use crate::output::text::{counted, label, wrap};

/// Program, job, time, threads and the deck's heading.
pub fn program_lines(record: &RunRecord, profile: &str, job: &str, title: &str) -> Vec<String> {
    let pieces = [
        format!(" {} ({}, {profile})", record.version, record.commit),
        format!("job {job}"),
        utc_now(),
        counted(record.threads, "thread"),
    ];
    let mut lines = wrap("stickslip", &pieces);
    if !title.trim().is_empty() {
        lines.push(label("title", title.trim()));
    }
    lines
}

/// The deck with its size and the number of errors and warnings; `log` holds the warnings.
pub fn deck_line(
    deck: &Path,
    includes: usize,
    lines: usize,
    errors: usize,
    warnings: usize,
    log: Option<&Path>,
) -> String {
    let name = deck.file_name().unwrap_or_default().to_string_lossy();
    let included = match includes {
        0 => String::new(),
        count => format!(" + {}", counted(count, "include")),
    };
    let log = match log.and_then(Path::file_name) {
        Some(log) if warnings > 0 => format!(" (see {})", log.to_string_lossy()),
        _ => String::new(),
    };
    let text = format!(
        "{name}{included}, {}: {}, {}{log}",
        counted(lines, "line"),
        counted(errors, "error"),
        counted(warnings, "warning"),
    );
    label("deck", &text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_line_is_no_lines() {
        let line = |lines, errors| deck_line(Path::new("a/b.inp"), 1, lines, errors, 0, None);
        assert!(line(1, 1).ends_with("b.inp + 1 include, 1 line: 1 error, 0 warnings"));
        assert!(line(2, 0).ends_with("b.inp + 1 include, 2 lines: 0 errors, 0 warnings"));
    }
}
