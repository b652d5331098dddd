//! Which module names items of which other: paths of the source, resolved through re-exports.

use crate::sources::{Source, within_package};
use proc_macro2::{TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet};
use std::slice;
use syn::visit::{self, Visit};
use syn::{Item, UseTree, Visibility};

/// Names from the root of the crate on, without `crate`.
pub type Path = Vec<String>;

/// A path that a module names.
pub struct Reference {
    /// The path from the root of the crate.
    pub path: Path,
    /// `file:line` of it.
    pub at: String,
    /// Is it a re-export?
    is_reexport: bool,
}

/// A `use` of a module: what the name stands for.
struct Alias {
    /// The name, `None` for `*`.
    name: Option<String>,
    target: Path,
    is_reexport: bool,
}

/// What a module declares and names.
#[derive(Default)]
struct Module {
    children: BTreeSet<String>,
    items: BTreeSet<String>,
    aliases: Vec<Alias>,
    references: Vec<Reference>,
}

/// The modules of a crate by path.
#[derive(Default)]
pub struct Modules(BTreeMap<Path, Module>);

/// Imports between the parts of a folder: by importing and imported part, the lines.
pub type Imports = BTreeMap<(String, String), Vec<String>>;

/// The part of a folder that is the file `mod.rs`.
const ROOT: &str = "mod.rs";

impl Modules {
    /// The modules of a library, tests left out.
    pub fn new(sources: &[Source]) -> Modules {
        let files: Vec<(&Source, Path)> = sources
            .iter()
            .filter(|source| !source.is_test)
            .filter_map(|source| Some((source, module_path(&source.path)?)))
            .collect();
        let mut modules = Modules::default();
        for (source, path) in &files {
            modules.declare(path, &source.items);
        }
        for (source, path) in files {
            let mut reader = Reader {
                modules: &mut modules,
                module: path,
                file: &source.path,
            };
            for item in &source.items {
                reader.visit_item(item);
            }
        }
        modules
    }

    fn declare(&mut self, path: &[String], items: &[Item]) {
        for item in items {
            let module = self.0.entry(path.to_vec()).or_default();
            let name = match item {
                Item::Mod(child) => {
                    let name = child.ident.to_string();
                    module.children.insert(name.clone());
                    if let Some((_, items)) = &child.content {
                        self.declare(&joined(path, &[name]), items);
                    }
                    continue;
                }
                Item::Const(item) => &item.ident,
                Item::Enum(item) => &item.ident,
                Item::Fn(item) => &item.sig.ident,
                Item::Static(item) => &item.ident,
                Item::Struct(item) => &item.ident,
                Item::Trait(item) => &item.ident,
                Item::Type(item) => &item.ident,
                _ => continue,
            };
            module.items.insert(name.to_string());
        }
    }

    /// Every path that a module names, with the path of the module.
    pub fn references(&self) -> impl Iterator<Item = (&Path, &Reference)> {
        let modules = self.0.iter();
        modules.flat_map(|(path, module)| module.references.iter().map(move |r| (path, r)))
    }

    /// Modules that have children, the root of the crate left out.
    pub fn folders(&self) -> impl Iterator<Item = &Path> {
        let modules = self.0.iter();
        let parents =
            modules.filter(|(path, module)| !path.is_empty() && !module.children.is_empty());
        parents.map(|(path, _)| path)
    }

    /// Has a folder sub-folders, that is children which have children?
    pub fn has_rooms(&self, folder: &[String]) -> bool {
        let children = self.0[folder].children.iter();
        let mut children = children.map(|child| joined(folder, slice::from_ref(child)));
        children.any(|child| self.0.get(&child).is_some_and(|m| !m.children.is_empty()))
    }

    /// The path of the module that defines what a path names; that of a module is its own.
    fn resolve(&self, path: &[String], depth: usize) -> Path {
        let mut at = Vec::new();
        for (i, name) in path.iter().enumerate() {
            let Some(module) = self.0.get(&at) else {
                return at;
            };
            if module.children.contains(name) {
                at.push(name.clone());
            } else if !module.items.contains(name)
                && depth < 20
                && let Some(alias) = self.alias(module, name)
            {
                return self.resolve(&joined(&alias, &path[i + 1..]), depth + 1);
            } else {
                return at;
            }
        }
        at
    }

    /// What a name that a module imports stands for.
    fn alias(&self, module: &Module, name: &String) -> Option<Path> {
        let named = |alias: &&Alias| alias.name.as_ref() == Some(name);
        if let Some(alias) = module.aliases.iter().find(named) {
            return Some(alias.target.clone());
        }
        let all = module.aliases.iter().filter(|alias| alias.name.is_none());
        let mut all = all.map(|alias| self.resolve(&alias.target, 0));
        let source = all.find(|source| {
            let source = self.0.get(source);
            source.is_some_and(|m| m.items.contains(name) || m.children.contains(name))
        });
        source.map(|source| joined(&source, slice::from_ref(name)))
    }

    /// Imports between the parts of a folder: its sub-folders, its files and `mod.rs`.
    pub fn imports_within(&self, folder: &[String]) -> Imports {
        let mut imports = Imports::new();
        for (module, reference) in self.references() {
            let target = self.resolve(&reference.path, 0);
            let is_namespace = target == reference.path && module.starts_with(&target);
            let own_reexport = reference.is_reexport && target.starts_with(module);
            if is_namespace || own_reexport {
                continue;
            }
            if let Some(from) = part(folder, module)
                && let Some(to) = part(folder, &target)
                && from != to
            {
                let line = format!("{}: {}", reference.at, reference.path.join("::"));
                imports.entry((from, to)).or_default().push(line);
            }
        }
        imports
    }
}

/// The module path of a file of the library.
fn module_path(file: &str) -> Option<Path> {
    let inner = within_package(file)?.strip_suffix(".rs")?;
    let mut names: Path = inner.split('/').map(str::to_owned).collect();
    match names.last().map(String::as_str) {
        Some("main") if names.len() == 1 => return None,
        Some("lib") if names.len() == 1 => names.clear(),
        Some("mod") => drop(names.pop()),
        _ => {}
    }
    Some(names)
}

/// The part of a folder in which a module lies.
fn part(folder: &[String], module: &[String]) -> Option<String> {
    let inner = module.strip_prefix(folder)?;
    Some(inner.first().map_or(ROOT.to_owned(), Clone::clone))
}

fn joined(head: &[String], tail: &[String]) -> Path {
    [head, tail].concat()
}

/// Reads the paths of one module.
struct Reader<'a> {
    modules: &'a mut Modules,
    module: Path,
    file: &'a str,
}

impl Reader<'_> {
    fn module(&mut self) -> &mut Module {
        self.modules.0.entry(self.module.clone()).or_default()
    }

    /// The path from the root that names stand for; `None` of another crate and of local names.
    fn absolute(&mut self, names: &[String]) -> Option<Path> {
        let first = names.first()?;
        match first.as_str() {
            "crate" => Some(names[1..].to_vec()),
            "self" => {
                let names = &names[1..];
                let supers = supers(names);
                self.above(supers, &names[supers..])
            }
            "super" => self.above(supers(names), &names[supers(names)..]),
            _ => {
                let own = self.module.clone();
                let module = self.module();
                if module.children.contains(first) {
                    return Some(joined(&own, names));
                }
                let mut aliases = module.aliases.iter();
                let alias = aliases.find(|alias| alias.name.as_ref() == Some(first))?;
                // A type that is imported is counted where it is imported.
                let counted = !alias.is_reexport && first.starts_with(char::is_uppercase);
                (!counted).then(|| joined(&alias.target, &names[1..]))
            }
        }
    }

    fn above(&self, levels: usize, rest: &[String]) -> Option<Path> {
        let head = self.module.len().checked_sub(levels)?;
        Some(joined(&self.module[..head], rest))
    }

    fn add(&mut self, names: &[String], line: usize, is_reexport: bool) {
        if let Some(path) = self.absolute(names) {
            let at = format!("{}:{line}", self.file);
            self.module().references.push(Reference {
                path,
                at,
                is_reexport,
            });
        }
    }

    fn add_use(&mut self, head: &[String], tree: &UseTree, is_reexport: bool) {
        let line = syn::spanned::Spanned::span(tree).start().line;
        match tree {
            UseTree::Path(path) => {
                let head = joined(head, &[path.ident.to_string()]);
                self.add_use(&head, &path.tree, is_reexport);
            }
            UseTree::Group(group) => {
                for tree in &group.items {
                    self.add_use(head, tree, is_reexport);
                }
            }
            UseTree::Name(leaf) => {
                let names = with_leaf(head, &leaf.ident);
                self.add_alias(&names, names.last().cloned(), is_reexport, line);
            }
            UseTree::Rename(leaf) => {
                let names = with_leaf(head, &leaf.ident);
                self.add_alias(&names, Some(leaf.rename.to_string()), is_reexport, line);
            }
            UseTree::Glob(_) => self.add_alias(head, None, is_reexport, line),
        }
    }

    /// Adds one imported path with the name that it gets here.
    fn add_alias(
        &mut self,
        names: &[String],
        name: Option<String>,
        is_reexport: bool,
        line: usize,
    ) {
        self.add(names, line, is_reexport);
        if let Some(target) = self.absolute(names) {
            self.module().aliases.push(Alias {
                name,
                target,
                is_reexport,
            });
        }
    }

    /// Adds the paths among the tokens of a macro.
    fn add_tokens(&mut self, tokens: TokenStream) {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let mut at = 0;
        while at < tokens.len() {
            let line = tokens[at].span().start().line;
            if let TokenTree::Group(group) = &tokens[at] {
                self.add_tokens(group.stream());
            }
            let names = path_of_tokens(&tokens[at..]);
            at += (3 * names.len()).max(3) - 2;
            if names.len() > 1 {
                self.add(&names, line, false);
            }
        }
    }
}

/// The path of a leaf of a `use` tree; `self` is the module itself.
fn with_leaf(head: &[String], leaf: &syn::Ident) -> Path {
    let mut names = head.to_vec();
    if leaf != "self" {
        names.push(leaf.to_string());
    }
    names
}

/// Number of `super` with which a path begins.
fn supers(names: &[String]) -> usize {
    names.iter().take_while(|name| *name == "super").count()
}

/// The names joined by `::` with which tokens begin.
fn path_of_tokens(tokens: &[TokenTree]) -> Path {
    let mut names = Vec::new();
    let mut rest = tokens;
    while let [TokenTree::Ident(name), ..] = rest {
        names.push(name.to_string());
        let is_colon =
            |token: &TokenTree| matches!(token, TokenTree::Punct(p) if p.as_char() == ':');
        match &rest[1..] {
            [first, second, tail @ ..] if is_colon(first) && is_colon(second) => rest = tail,
            _ => break,
        }
    }
    names
}

impl<'ast> Visit<'ast> for Reader<'_> {
    fn visit_item_mod(&mut self, module: &'ast syn::ItemMod) {
        self.module.push(module.ident.to_string());
        visit::visit_item_mod(self, module);
        self.module.pop();
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        let is_reexport = !matches!(item.vis, Visibility::Inherited);
        if item.leading_colon.is_none() {
            self.add_use(&[], &item.tree, is_reexport);
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let names: Path = path.segments.iter().map(|s| s.ident.to_string()).collect();
        let is_type = names[0].starts_with(char::is_uppercase);
        if path.leading_colon.is_none() && (names.len() > 1 || is_type) {
            let line = path.segments[0].ident.span().start().line;
            self.add(&names, line, false);
        }
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, found: &'ast syn::Macro) {
        self.add_tokens(found.tokens.clone());
    }

    /// Neither `pub(super)` nor an attribute names what is imported.
    fn visit_visibility(&mut self, _: &'ast Visibility) {}

    fn visit_attribute(&mut self, _: &'ast syn::Attribute) {}
}
