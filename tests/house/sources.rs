//! The source files of the program, parsed; what is compiled for tests only is left out.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use syn::{Attribute, ImplItem, Item, Meta};

/// A source file.
pub struct Source {
    /// Path from the root of the package, with `/`.
    pub path: String,
    /// The whole text, tests included.
    pub text: String,
    /// Items outside of tests.
    pub items: Vec<Item>,
    /// Is the whole file a module of tests?
    pub is_test: bool,
}

/// The source files of all packages, in the order of their paths.
pub fn read_sources() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut texts = BTreeMap::new();
    for folder in ["src", "crates"] {
        read_folder(root, folder, &mut texts);
    }
    parse_sources(&texts)
}

fn read_folder(root: &Path, folder: &str, texts: &mut BTreeMap<String, String>) {
    for entry in fs::read_dir(root.join(folder)).expect("a source folder") {
        let entry = entry.expect("an entry");
        let path = format!("{folder}/{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            read_folder(root, &path, texts);
        } else if path.ends_with(".rs") {
            let text = fs::read_to_string(entry.path()).expect("a source file");
            texts.insert(path, text);
        }
    }
}

/// Path below the folder `src` of a package.
pub fn within_package(path: &str) -> Option<&str> {
    let package = path.strip_prefix("crates/");
    let path = package
        .and_then(|path| path.split_once('/'))
        .map_or(path, |(_, path)| path);
    path.strip_prefix("src/")
}

/// Parses source texts given by path.
pub fn parse_sources(texts: &BTreeMap<String, String>) -> Vec<Source> {
    let mut test_modules = Vec::new();
    let mut sources: Vec<Source> = texts
        .iter()
        .map(|(path, text)| parse(path, text, &mut test_modules))
        .collect();
    for source in &mut sources {
        let module = source.path.trim_end_matches(".rs").to_owned() + "/";
        source.is_test = test_modules.iter().any(|test| module.starts_with(test));
    }
    sources
}

/// Parses one file; adds the modules that it declares for tests, as `folder/name/`.
fn parse(path: &str, text: &str, test_modules: &mut Vec<String>) -> Source {
    let file = syn::parse_file(text).unwrap_or_else(|error| panic!("{path}: {error}"));
    let mut items = file.items;
    let mut modules = Vec::new();
    remove_tests(&mut items, &mut modules);
    let folder = children_folder(path);
    test_modules.extend(modules.iter().map(|name| format!("{folder}{name}/")));
    Source {
        path: path.to_owned(),
        text: text.to_owned(),
        items,
        is_test: false,
    }
}

/// Folder, with its `/`, in which the child modules of a file lie.
fn children_folder(path: &str) -> String {
    let (folder, name) = path.rsplit_once('/').expect("a file in a folder");
    match name {
        "lib.rs" | "main.rs" | "mod.rs" => format!("{folder}/"),
        _ => format!("{folder}/{}/", name.trim_end_matches(".rs")),
    }
}

/// Takes out what is for tests only; adds the modules among it that are files of their own.
fn remove_tests(items: &mut Vec<Item>, modules: &mut Vec<String>) {
    items.retain_mut(|item| {
        if is_for_tests(attributes(item)) {
            if let Item::Mod(module) = item
                && module.content.is_none()
            {
                modules.push(module.ident.to_string());
            }
            return false;
        }
        match item {
            Item::Mod(module) => {
                if let Some((_, items)) = &mut module.content {
                    remove_tests(items, modules);
                }
            }
            Item::Impl(block) => block.items.retain(
                |item| !matches!(item, ImplItem::Fn(function) if is_for_tests(&function.attrs)),
            ),
            _ => {}
        }
        true
    });
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

/// `#[cfg(test)]`, or `#[cfg(all(test, ...))]`.
fn is_for_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg")
            && attribute
                .parse_args::<Meta>()
                .is_ok_and(|meta| asks_test(&meta))
    })
}

fn asks_test(meta: &Meta) -> bool {
    match meta {
        Meta::Path(path) => path.is_ident("test"),
        Meta::List(list) if list.path.is_ident("all") => {
            let parse = syn::punctuated::Punctuated::<Meta, syn::Token![,]>::parse_terminated;
            list.parse_args_with(parse)
                .is_ok_and(|parts| parts.iter().any(asks_test))
        }
        _ => false,
    }
}
