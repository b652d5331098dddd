//! The table of docs/architecture.md that leads from the main equations to lines of the source.

use super::names::Tree;
use super::numbers::{Number, citations};

/// Heading of the section that holds the table.
pub const HEADING: &str = "## Where the equations are";

/// The document with the right lines in its table.
#[derive(Debug)]
pub struct Table {
    pub text: String,
    /// What the equations of the rows are.
    pub subjects: Vec<String>,
}

/// A row `| (2.2) | strain | [src/a.rs:3](../src/a.rs#L3) |`.
struct Row<'a> {
    number: Number,
    subject: &'a str,
    path: &'a str,
    line: usize,
}

impl<'a> Row<'a> {
    fn parse(text: &'a str) -> Option<Self> {
        let cells: Vec<&str> = text.split('|').map(str::trim).collect();
        let [_, number, subject, place, _] = cells[..] else {
            return None;
        };
        let number = Number::parse(number.strip_prefix('(')?.strip_suffix(')')?)?;
        let (place, _) = place
            .trim_start_matches(['[', '`'])
            .split_once(['`', ']'])?;
        let (path, line) = place.rsplit_once(':')?;
        Some(Row {
            number,
            subject,
            path,
            line: line.parse().ok()?,
        })
    }

    fn text(&self, path: &str, line: usize) -> String {
        let Row {
            number, subject, ..
        } = self;
        format!("| {number} | {subject} | [`{path}:{line}`](../{path}#L{line}) |")
    }

    /// File and line of the citation: that of the row's file which is nearest to the row's line, or
    /// the only one elsewhere.
    fn place<'t>(&self, tree: &'t Tree) -> Result<(&'t str, usize), String> {
        let cited: Vec<(&str, usize)> = tree
            .sources()
            .flat_map(|(path, text)| {
                let own = citations(text).into_iter();
                let own = own.filter(|(_, number)| *number == Ok(self.number));
                own.map(move |(line, _)| (path, line))
            })
            .collect();
        let here = cited.iter().filter(|(path, _)| *path == self.path);
        let nearest = here.min_by_key(|(_, line)| line.abs_diff(self.line));
        match (nearest, &cited[..]) {
            (Some(place), _) | (None, [place]) => Ok(*place),
            (None, others) => Err(format!(
                "{} does not cite eq. {}; cited in {others:?}",
                self.path, self.number
            )),
        }
    }
}

/// The document with the lines of its table as they are in the source.
///
/// # Errors
/// Rows that cannot be read, or whose equation is not cited where they say.
pub fn updated(document: &str, tree: &Tree) -> Result<Table, Vec<String>> {
    let (mut lines, mut subjects, mut offences) = (Vec::new(), Vec::new(), Vec::new());
    let mut is_inside = false;
    for line in document.lines() {
        if line.starts_with("## ") {
            is_inside = line == HEADING;
        }
        let mut new = line.to_string();
        if is_inside && line.starts_with("| (") {
            match Row::parse(line).ok_or(format!("no row: {line}")) {
                Ok(row) => match row.place(tree) {
                    Ok((path, at)) => {
                        new = row.text(path, at);
                        subjects.push(row.subject.to_string());
                    }
                    Err(offence) => offences.push(offence),
                },
                Err(offence) => offences.push(offence),
            }
        }
        lines.push(new + "\n");
    }
    match offences.is_empty() {
        true => Ok(Table {
            text: lines.concat(),
            subjects,
        }),
        false => Err(offences),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tree() -> Tree {
        Tree::of(&[
            ("src/a.rs", "//\n// x, eq. (1.1)\n\n\n// y, eq. (1.1)\n"),
            ("src/b.rs", "// z, eq. (1.2)\n// eq. (1.1)\n"),
        ])
    }

    fn document(row: &str) -> String {
        format!("| (9.9) | elsewhere |\n{HEADING}\n\n{row}\n")
    }

    #[test]
    fn lines_follow_the_source() {
        let right = |row: &str| updated(&document(row), &tree()).map(|table| table.text);
        let row =
            |path: &str, line| format!("| (1.1) | x | [`{path}:{line}`](../{path}#L{line}) |");
        for (old, new) in [(2, 2), (1, 2), (9, 5), (4, 5)] {
            assert_eq!(
                right(&row("src/a.rs", old)),
                Ok(document(&row("src/a.rs", new)))
            );
        }
        let moved = right("| (1.2) | z | [`src/gone.rs:7`](../src/gone.rs#L7) |");
        let found = document("| (1.2) | z | [`src/b.rs:1`](../src/b.rs#L1) |");
        assert_eq!(moved, Ok(found));
    }

    #[test]
    fn rows_without_a_citation_are_found() {
        for wrong in [
            "| (1.3) | x | [`src/a.rs:2`](../src/a.rs#L2) |",
            "| (1.1) | x | [`src/gone.rs:2`](../src/gone.rs#L2) |",
            "| (1.1) | x | src/a.rs |",
        ] {
            assert_eq!(updated(&document(wrong), &tree()).unwrap_err().len(), 1);
        }
    }
}
