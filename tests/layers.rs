//! A module imports only from the layers before its own.

use std::fs;
use std::path::{Path, PathBuf};

/// The layers, lowest first.
const LAYERS: [&str; 12] = [
    "diagnostics",
    "deck",
    "model",
    "reader",
    "elements",
    "linear",
    "lcp",
    "contact",
    "prepare",
    "dynamics",
    "output",
    "cli",
];

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).expect("a source folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files
}

/// Names of the layers that a source text names after `crate::`.
fn imports(text: &str) -> impl Iterator<Item = &str> {
    text.match_indices("crate::").map(|(at, found)| {
        let rest = &text[at + found.len()..];
        rest.split(|c: char| !(c.is_alphanumeric() || c == '_'))
            .next()
            .unwrap_or("")
    })
}

#[test]
fn modules_import_only_from_lower_layers() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut offences = Vec::new();
    for (rank, layer) in LAYERS.iter().enumerate() {
        for file in rust_files(&source.join(layer)) {
            let text = fs::read_to_string(&file).expect("a source file");
            for name in imports(&text) {
                if let Some(other) = LAYERS.iter().position(|layer| *layer == name)
                    && other > rank
                {
                    offences.push(format!("{} imports {name}", file.display()));
                }
            }
        }
    }
    assert!(offences.is_empty(), "{}", offences.join("\n"));
}

#[test]
fn every_module_has_a_layer() {
    let library = include_str!("../src/lib.rs");
    let modules = library
        .lines()
        .filter_map(|line| line.strip_prefix("pub mod "));
    let modules: Vec<&str> = modules.map(|name| name.trim_end_matches(';')).collect();
    assert_eq!(modules.len(), LAYERS.len());
    assert!(modules.iter().all(|module| LAYERS.contains(module)));
}
