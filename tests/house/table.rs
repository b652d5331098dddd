//! The table of docs/architecture.md that leads from the main equations to the items of the source that evaluate them.

use super::names::Tree;
use super::numbers::{Number, citations};

/// Heading of the section that holds the table.
pub const HEADING: &str = "## Where the equations are";

/// The document with the right items in its table.
#[derive(Debug)]
pub struct Table {
    pub text: String,
    /// What the equations of the rows are.
    pub subjects: Vec<String>,
}

/// A row ``| (2.2) | strain | [`strain`](../src/a.rs) in `src/a.rs` |``: the item at which the source cites the equation.
struct Row<'a> {
    number: Number,
    subject: &'a str,
    item: &'a str,
    path: &'a str,
}

impl<'a> Row<'a> {
    fn parse(text: &'a str) -> Option<Self> {
        let cells: Vec<&str> = text.split('|').map(str::trim).collect();
        let [_, number, subject, place, _] = cells[..] else {
            return None;
        };
        let number = Number::parse(number.strip_prefix('(')?.strip_suffix(')')?)?;
        let (item, rest) = place.strip_prefix("[`")?.split_once("`]")?;
        let (_, path) = rest.split_once(") in `")?;
        Some(Row {
            number,
            subject,
            item,
            path: path.strip_suffix('`')?,
        })
    }

    fn text(&self, (path, item): (&str, &str)) -> String {
        let Row {
            number, subject, ..
        } = self;
        format!("| {number} | {subject} | [`{item}`](../{path}) in `{path}` |")
    }

    /// File and item of the citation: those of the row, the only ones of the row's file, or the only ones elsewhere.
    fn place<'t>(&self, tree: &'t Tree) -> Result<(&'t str, &'t str), String> {
        let mut cited: Vec<(&str, &str)> = tree
            .sources()
            .flat_map(|(path, text)| {
                let own = citations(text).into_iter();
                let own = own.filter(|(_, number)| *number == Ok(self.number));
                own.filter_map(move |(line, _)| Some((path, item_at(text, line)?)))
            })
            .collect();
        cited.dedup();
        let here: Vec<_> = (cited.iter().filter(|(path, _)| *path == self.path)).collect();
        let same = here.iter().find(|(_, item)| *item == self.item);
        match (same, &here[..], &cited[..]) {
            (Some(place), ..) | (None, [place], _) => Ok(**place),
            (None, [], [place]) => Ok(*place),
            _ => Err(format!(
                "{} does not cite eq. {} at `{}`; cited in {cited:?}",
                self.path, self.number, self.item
            )),
        }
    }
}

/// The item that a line of a source belongs to, counted from one: that below a line of its documentation, else the function
/// around the line.
fn item_at(text: &str, line: usize) -> Option<&str> {
    let lines: Vec<&str> = text.lines().collect();
    let (before, after) = lines.split_at(line.min(lines.len()));
    match before.last()?.trim_start().starts_with("///") {
        true => after.iter().find_map(|line| declared(line)),
        false => {
            let mut around = before.iter().rev().filter(|line| line.contains("fn "));
            around.find_map(|line| declared(line))
        }
    }
}

/// Name of the item that a line declares.
fn declared(line: &str) -> Option<&str> {
    let line = line.trim_start();
    if line.starts_with("//") {
        return None;
    }
    let mut words = line.split(|c: char| !c.is_alphanumeric() && c != '_');
    let kinds = ["fn", "struct", "enum", "const", "trait", "type", "static"];
    words.find(|word| kinds.contains(word))?;
    // a constant function is one
    words.find(|word| !word.is_empty() && *word != "fn")
}

/// The document with the items of its table as they are in the source.
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
                    Ok(place) => {
                        new = row.text(place);
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
            (
                "src/a.rs",
                "/// x, eq. (1.1)\npub(crate) fn x() {\n}\nfn y() {\n    // y, eq. (1.1)\n}\n",
            ),
            (
                "src/b.rs",
                "/// z, eq. (1.2)\n#[derive(Debug)]\nstruct Z<T>(T);\n// eq. (1.1)\n",
            ),
        ])
    }

    fn document(row: &str) -> String {
        format!("| (9.9) | elsewhere |\n{HEADING}\n\n{row}\n")
    }

    #[test]
    fn items_follow_the_source() {
        let right = |row: &str| updated(&document(row), &tree()).map(|table| table.text);
        let row = |number: &str, path: &str, item: &str| {
            format!("| {number} | x | [`{item}`](../{path}) in `{path}` |")
        };
        for item in ["x", "y"] {
            let row = row("(1.1)", "src/a.rs", item);
            assert_eq!(right(&row), Ok(document(&row)));
        }
        let found = document(&row("(1.2)", "src/b.rs", "Z"));
        for (path, item) in [("src/gone.rs", "Z"), ("src/b.rs", "z")] {
            assert_eq!(right(&row("(1.2)", path, item)), Ok(found.clone()));
        }
    }

    #[test]
    fn rows_without_a_citation_are_found() {
        for wrong in [
            "| (1.3) | x | [`x`](../src/a.rs) in `src/a.rs` |",
            "| (1.1) | x | [`z`](../src/a.rs) in `src/a.rs` |",
            "| (1.1) | x | src/a.rs |",
        ] {
            assert_eq!(updated(&document(wrong), &tree()).unwrap_err().len(), 1);
        }
    }
}
