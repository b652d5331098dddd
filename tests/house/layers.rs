//! A module imports only from the layers before its own, and within a layer its folders and files
//! import one way.

use crate::circles::{circles, describe_circles};
use crate::imports::Modules;
use crate::sources::{parse_sources, read_sources, within_package};
use std::collections::BTreeMap;

/// The layers, lowest first.
const LAYERS: [&str; 18] = [
    "system",
    "archive",
    "linear",
    "lcp",
    "vectors",
    "diagnostics",
    "materials",
    "model",
    "elements",
    "deck",
    "reader",
    "flat_deck",
    "editor",
    "contact",
    "prepare",
    "dynamics",
    "output",
    "cli",
];

/// Names of the layers that a source text names after `crate::`, comments and tests included.
fn imports_of(text: &str) -> impl Iterator<Item = &str> {
    text.match_indices("crate::").map(|(at, found)| {
        let rest = &text[at + found.len()..];
        rest.split(|c: char| !(c.is_alphanumeric() || c == '_'))
            .next()
            .unwrap_or("")
    })
}

fn rank(name: &str) -> Option<usize> {
    LAYERS.iter().position(|layer| *layer == name)
}

/// The layer of a source file, which lies in its folder or is the layer itself; none of `lib.rs` and
/// `main.rs`.
fn layer_of(path: &str) -> Option<&str> {
    let layer = within_package(path)?.split(['/', '.']).next();
    layer.filter(|layer| rank(layer).is_some())
}

#[test]
fn modules_import_only_from_lower_layers() {
    let mut offences = Vec::new();
    for source in read_sources() {
        let Some(layer) = layer_of(&source.path) else {
            continue;
        };
        for name in imports_of(&source.text).filter(|name| rank(name) > rank(layer)) {
            offences.push(format!("{} imports {name}", source.path));
        }
    }
    assert!(offences.is_empty(), "{}", offences.join("\n"));
}

#[test]
fn relative_paths_lead_only_to_lower_layers() {
    let modules = Modules::new(&read_sources());
    let upward = modules.references().filter(|(module, reference)| {
        let ranks = [module, &reference.path].map(|path| path.first().and_then(|name| rank(name)));
        matches!(ranks, [Some(own), Some(other)] if other > own)
    });
    let upward: Vec<String> = upward
        .map(|(_, reference)| format!("{} imports {}", reference.at, reference.path.join("::")))
        .collect();
    assert!(upward.is_empty(), "{}", upward.join("\n"));
}

#[test]
fn every_module_has_a_layer() {
    let sources = read_sources();
    let roots = (sources.iter()).filter(|source| within_package(&source.path) == Some("lib.rs"));
    let lines = roots.flat_map(|root| root.text.lines());
    let modules = lines.filter_map(|line| line.strip_prefix("pub mod "));
    let modules: Vec<&str> = modules.map(|name| name.trim_end_matches(';')).collect();
    assert_eq!(modules.len(), LAYERS.len());
    assert!(modules.iter().all(|module| LAYERS.contains(module)));
}

/// Circles by folder: in the folders that have sub-folders, or in the others.
fn circles_by_folder(with_rooms: bool) -> BTreeMap<String, Vec<String>> {
    let modules = Modules::new(&read_sources());
    let folders = modules
        .folders()
        .filter(|folder| modules.has_rooms(folder) == with_rooms);
    let circles = folders.map(|folder| {
        let circles = describe_circles(folder, &modules.imports_within(folder));
        (folder.join("/"), circles)
    });
    circles.filter(|(_, circles)| !circles.is_empty()).collect()
}

#[test]
fn rooms_of_a_layer_import_one_way() {
    let circles = circles_by_folder(true).into_values().flatten();
    let circles: Vec<String> = circles.collect();
    assert!(circles.is_empty(), "{}", circles.join("\n"));
}

#[test]
fn files_of_a_folder_import_one_way() {
    let circles = circles_by_folder(false).into_values().flatten();
    let circles: Vec<String> = circles.collect();
    assert!(circles.is_empty(), "{}", circles.join("\n"));
}

/// Circles in a folder of a made-up library, as lists of its parts.
fn circles_of<const N: usize>(folder: &str, files: [(&str, &str); N]) -> Vec<Vec<String>> {
    let texts = files.map(|(path, text)| (path.to_owned(), text.to_owned()));
    let modules = Modules::new(&parse_sources(&BTreeMap::from(texts)));
    let folder: Vec<String> = folder.split('/').map(str::to_owned).collect();
    let circles = circles(&modules.imports_within(&folder));
    circles.into_iter().collect()
}

/// A library with a layer of two rooms, `low` and `high`; `high` imports from `low`. `text` is
/// added to the file `low/floor.rs`.
fn circles_with(text: &str) -> Vec<Vec<String>> {
    let floor = format!("pub struct Floor;\npub struct Door;\n{text}");
    let files = [
        ("src/lib.rs", "pub mod layer;\npub mod other;"),
        ("src/other.rs", "pub struct Far;"),
        (
            "src/layer/mod.rs",
            "mod low;\nmod high;\npub use low::Floor;\npub use high::{Roof, tile as roof_tile};",
        ),
        (
            "src/layer/low/mod.rs",
            "mod floor;\npub use floor::{Door, Floor};",
        ),
        ("src/layer/low/floor.rs", &floor),
        (
            "src/layer/high/mod.rs",
            "mod roof;\npub(crate) use roof::*;",
        ),
        (
            "src/layer/high/roof.rs",
            "use crate::layer::Floor;\nuse crate::{other::Far, layer::low::{Door}};\n\
             pub struct Roof(Floor);\npub fn tile() {}\npub const SLOPE: f64 = 1.0;",
        ),
    ];
    circles_of("layer", files)
}

#[test]
fn rooms_that_import_one_way_make_no_circle() {
    assert_eq!(circles_with(""), [[""; 0]; 0]);
    assert_eq!(
        circles_with("use crate::other::Far; use super::super::low::Door;"),
        [[""; 0]; 0]
    );
    assert_eq!(
        circles_with("use serde::layer::high::Roof; pub(super) fn f() {}"),
        [[""; 0]; 0]
    );
    assert_eq!(
        circles_with("#[cfg(test)] mod tests { use crate::layer::Roof; }"),
        [[""; 0]; 0]
    );
}

#[test]
fn a_circle_of_rooms_is_found_however_the_import_is_written() {
    for text in [
        "use crate::layer::high::Roof;",
        "use crate::layer::Roof;",
        "use crate::{other::{self, Far}, layer::{Floor as _, roof_tile}};",
        "use super::super::high::SLOPE;",
        "use crate::layer; fn f(_: layer::Roof) {}",
        "use super::super as up; fn f() { up::high::tile() }",
        "fn f() -> f64 { crate::layer::high::SLOPE }",
        "fn f(_: &[crate::layer::Roof]) {}",
        "fn f() { println!(\"{}\", (1.0, crate::layer::high::SLOPE)); }",
        "mod inner { fn f() { super::super::super::high::tile() } }",
    ] {
        assert_eq!(circles_with(text), [["high", "low"]], "{text}");
    }
}

#[test]
fn a_circle_of_files_goes_also_through_the_root_of_their_folder() {
    let files = |root| {
        [
            ("src/lib.rs", "pub mod layer;"),
            ("src/layer/mod.rs", root),
            ("src/layer/a.rs", "use super::B;\npub struct A;"),
            ("src/layer/b.rs", "use super::c::C;\npub struct B;"),
            ("src/layer/c.rs", "use super::shared;\npub struct C;"),
        ]
    };
    let declared = "mod a;\nmod b;\nmod c;\npub use a::A;\npub use b::B;\npub fn shared() {}\n";
    assert_eq!(circles_of("layer", files(declared)), [[""; 0]; 0]);
    let uses_a = declared.to_owned() + "fn f() { a::A; }";
    assert_eq!(
        circles_of("layer", files(&uses_a)),
        [["a", "b", "c", "mod.rs"]]
    );
    let type_of_a = declared.to_owned() + "fn f(_: A) {}";
    assert_eq!(
        circles_of("layer", files(&type_of_a)),
        [["a", "b", "c", "mod.rs"]]
    );
}
