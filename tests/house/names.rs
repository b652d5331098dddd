//! Names of modules, items and files in backticks, and whether the tree has them.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Folders whose files documents name.
const FOLDERS: [&str; 8] = [
    "src/",
    "crates/",
    "tests/",
    "docs/",
    "scripts/",
    "input/",
    "verification/",
    "benches/",
];

/// Folders that hold the sources of the packages.
const SOURCES: [&str; 2] = ["src/", "crates/"];

/// Words of the language in backticks.
const LANGUAGE: [&str; 5] = ["use", "crate", "pub", "mod", "unwrap"];

/// The files of the repository by path; texts of Rust files.
pub struct Tree(BTreeMap<String, String>);

impl Tree {
    /// The files below a root.
    pub fn read(root: &Path) -> Self {
        let mut files = BTreeMap::new();
        for folder in FOLDERS {
            collect(root, folder, &mut files);
        }
        Tree(files)
    }

    /// Files with given texts.
    #[cfg(test)]
    pub fn of(files: &[(&str, &str)]) -> Self {
        let owned = |(path, text): &(&str, &str)| (path.to_string(), text.to_string());
        Tree(files.iter().map(owned).collect())
    }

    /// Rust files whose paths start so, with their texts.
    pub fn rust_files(&self, start: &str) -> impl Iterator<Item = (&str, &str)> {
        let files = self
            .0
            .iter()
            .map(|(path, text)| (path.as_str(), text.as_str()));
        files.filter(move |(path, _)| path.starts_with(start) && path.ends_with(".rs"))
    }

    /// Rust files of all packages, with their texts.
    pub fn sources(&self) -> impl Iterator<Item = (&str, &str)> {
        let packages = SOURCES.iter();
        packages.flat_map(|folder| self.rust_files(folder))
    }

    /// The paths that start so.
    pub fn paths(&self, start: &str) -> impl Iterator<Item = &str> {
        let paths = self.0.keys().map(String::as_str);
        paths.filter(move |path| path.starts_with(start))
    }

    /// Whether there is a file or a folder with this path.
    pub fn has_path(&self, path: &str) -> bool {
        let folder = format!("{}/", path.trim_end_matches('/'));
        let mut paths = self.0.keys();
        paths.any(|own| own == path || own.starts_with(&folder))
    }

    /// Whether a path of modules and items exists in one of the packages.
    fn is_item(&self, segments: &[&str]) -> bool {
        let mut packages = SOURCES.iter();
        packages.any(|folder| self.has_item(folder, segments))
    }

    /// Whether a path of modules and items exists below the modules whose files start with `start`.
    /// Re-exports are followed: an item may be in any file of the module.
    fn has_item(&self, start: &str, segments: &[&str]) -> bool {
        let [name, rest @ ..] = segments else {
            return true;
        };
        let (file, folder) = (format!("/{name}.rs"), format!("/{name}/"));
        let leads_on = |(path, text): (&str, &str)| {
            let below = &path[start.len() - 1..];
            let module = match below.find(&folder) {
                Some(at) => Some(&path[..start.len() - 1 + at + folder.len()]),
                None => path.ends_with(&file).then_some(path),
            };
            module.is_some_and(|module| match rest {
                [] => true,
                rest if module.ends_with('/') => self.has_item(module, rest),
                [item] => defines(text, item),
                [owner, member] => self.has_member(owner, member),
                _ => false,
            }) || match rest {
                [] => defines(text, name),
                [member] => defines(text, name) && self.has_member(name, member),
                _ => false,
            }
        };
        self.rust_files(start).any(leads_on)
    }

    /// Whether a type has a function, a variant or a field of this name.
    fn has_member(&self, owner: &str, member: &str) -> bool {
        let is_impl = |line: &str| line.starts_with("impl") && has_word(line, owner);
        let mut files = self.sources();
        files.any(|(_, text)| {
            let mut blocks = blocks(text, |line| is_impl(line) || defined(line) == Some(owner));
            blocks.any(|line| {
                let name = line.trim_start().trim_start_matches("pub ");
                let ends = |rest: &str| rest.starts_with([',', ':', '(', ' ']) || rest.is_empty();
                defined(line) == Some(member) || name.strip_prefix(member).is_some_and(ends)
            })
        })
    }
}

fn collect(root: &Path, folder: &str, files: &mut BTreeMap<String, String>) {
    let entries = fs::read_dir(root.join(folder)).expect("a folder");
    for entry in entries {
        let entry = entry.expect("an entry");
        let name = entry.file_name().to_string_lossy().into_owned();
        let path = format!("{folder}{name}");
        if entry.path().is_dir() {
            collect(root, &format!("{path}/"), files);
        } else if name.ends_with(".rs") {
            let text = fs::read_to_string(entry.path()).expect("a source text");
            files.insert(path, text);
        } else {
            files.insert(path, String::new());
        }
    }
}

/// The lines of the blocks that begin with some lines and end with a brace at their indentation.
fn blocks(text: &str, begins: impl Fn(&str) -> bool) -> impl Iterator<Item = &str> {
    let mut end: Option<usize> = None;
    let indentation = |line: &str| line.len() - line.trim_start().len();
    text.lines().filter(move |line| {
        if begins(line) && line.ends_with('{') {
            end = Some(indentation(line));
        } else if end.is_some_and(|end| line.trim() == "}" && indentation(line) == end) {
            end = None;
        }
        end.is_some()
    })
}

fn defines(text: &str, name: &str) -> bool {
    text.lines().any(|line| defined(line) == Some(name))
}

/// The name of the item that a line defines.
fn defined(line: &str) -> Option<&str> {
    let mut words = line.trim_start().split(' ').peekable();
    words.next_if(|word| word.starts_with("pub"));
    if words.peek() == Some(&"const") && line.contains(" fn ") {
        words.next();
    }
    let kinds = [
        "fn", "struct", "enum", "trait", "const", "static", "type", "mod",
    ];
    words.next_if(|word| kinds.contains(word))?;
    let name = words.next()?;
    let end = name.find(|c: char| !is_letter(c)).unwrap_or(name.len());
    Some(&name[..end])
}

fn has_word(line: &str, word: &str) -> bool {
    line.split(|c: char| !is_letter(c)).any(|own| own == word)
}

fn is_letter(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

/// Names in backticks that the tree does not have, with their lines.
pub fn missing(document: &str, tree: &Tree) -> Vec<(usize, String)> {
    let mut is_fenced = false;
    let mut found = Vec::new();
    for (k, line) in document.lines().enumerate() {
        is_fenced ^= line.starts_with("```");
        if is_fenced || line.starts_with("    ") {
            continue;
        }
        let names = line.split('`').skip(1).step_by(2);
        let absent = names.filter(|name| !exists(name, tree));
        found.extend(absent.map(|name| (k + 1, name.to_string())));
    }
    found
}

/// Whether a name in backticks exists, or is none of a file, module or item.
fn exists(name: &str, tree: &Tree) -> bool {
    let path = name.split(':').next().unwrap_or(name);
    if FOLDERS.iter().any(|folder| path.starts_with(folder)) {
        return tree.has_path(path);
    }
    if let Some(module) = name.strip_suffix(".rs") {
        return !module.chars().all(is_letter) || tree.is_item(&[module]);
    }
    let segments: Vec<&str> = name.trim_end_matches("()").split("::").collect();
    let is_word = |s: &&str| !s.is_empty() && s.chars().all(is_letter);
    // deck words are in capitals
    let is_item = match segments[..] {
        [word] => word.contains('_') || word.chars().any(|c| c.is_ascii_lowercase()),
        _ => true,
    };
    if !segments.iter().all(is_word) || !is_item || LANGUAGE.contains(&name) {
        return true;
    }
    tree.is_item(&segments)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tree() -> Tree {
        let gap = "pub struct Gap {\n    pub size: f64,\n}\n\nimpl Gap {\n    pub const fn open(&self) {}\n}\n";
        let kind = "pub(crate) enum Kind {\n    Stick,\n    Slip(f64),\n}\nfn stray() {}\nconst LEAST_GAP: f64 = 1.0;\n";
        Tree::of(&[
            ("src/contact/mod.rs", "mod geometry;"),
            ("src/contact/geometry/gap.rs", gap),
            ("src/contact/kind.rs", kind),
            ("src/linear/solve.rs", "pub fn solve() {}"),
            ("docs/theory/time.md", ""),
        ])
    }

    #[test]
    fn items_files_and_modules_that_exist() {
        for name in [
            "contact",
            "contact::geometry",
            "contact::geometry::gap::Gap",
            "contact::Gap",
            "Gap",
            "Gap::open",
            "Gap::size",
            "contact::kind::Kind::Slip",
            "Kind::Stick",
            "LEAST_GAP",
            "stray()",
            "gap.rs",
            "src/contact/kind.rs",
            "src/contact/kind.rs:3",
            "src/contact/",
            "linear::solve::solve",
            "docs/theory/time.md",
            "CONTACT PAIR",
            "TOLERANCE",
            "use",
            "SCHEME=SS22, THETA1=1.",
        ] {
            assert!(exists(name, &tree()), "{name}");
        }
    }

    #[test]
    fn items_files_and_modules_that_do_not_exist() {
        for name in [
            "pressure",
            "contact::solve",
            "contact::Slip",
            "linear::Gap",
            "Gap::closed",
            "Kind::open",
            "Kind::stray",
            "Gaps",
            "MOST_GAP",
            "closed()",
            "gaps.rs",
            "src/contact/gap.rs",
            "src/friction/",
            "contact::geometry::kind::Kind",
            "docs/practice.md",
        ] {
            assert!(!exists(name, &tree()), "{name}");
        }
    }

    #[test]
    fn names_in_blocks_are_no_names() {
        let document =
            "a `Gap` and `Gaps`\n```text\n`Other`\n```\n    `Third`\n`solve`, `resolve`\n";
        let found = [(1, "Gaps".to_string()), (6, "resolve".to_string())];
        assert_eq!(missing(document, &tree()), found);
    }
}
