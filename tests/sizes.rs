//! Sizes of functions, structs, files and folders of the source, outside of tests.

#[path = "source_support/sources.rs"]
mod sources;

use sources::{Source, parse_sources, read_sources};
use std::collections::BTreeMap;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{Fields, FnArg, ItemStruct, Signature, Type, Visibility};

const MEDIAN_LINES: usize = 10;
const P90_LINES: usize = 30;
const MOST_ARGUMENTS: usize = 6;
const MOST_FIELDS: usize = 12;
/// Lines of the function `passes`, the solution of one increment.
const PASSES_LINES: usize = 60;
const FILE_LINES: usize = 400;
const MOST_FILES: usize = 12;

/// Structs that may have more fields: plain records of results, each with the reason.
const RESULT_RECORDS: [(&str, &str); 3] = [
    (
        "ContactResultant",
        "the figures of one contact in one increment, as the history holds them",
    ),
    (
        "IncrementReport",
        "what is known of an accepted increment, one figure per field",
    ),
    (
        "ResultSummary",
        "the figures at the end of a run, one per line of the summary",
    ),
];

/// A function with a body.
struct Function {
    name: String,
    /// `file:line` of its signature.
    at: String,
    /// Lines from the signature to the closing brace.
    lines: usize,
    /// Number of arguments besides `self`, a tuple for as many as it has parts.
    arguments: usize,
}

struct Struct {
    name: String,
    at: String,
    fields: usize,
    /// Are all fields visible outside of its file, without mutable references or trait objects?
    is_plain: bool,
}

/// Functions and structs of source files.
#[derive(Default)]
struct Survey {
    path: String,
    functions: Vec<Function>,
    structs: Vec<Struct>,
}

impl Survey {
    fn new(sources: &[Source]) -> Survey {
        let mut survey = Survey::default();
        for source in sources.iter().filter(|source| !source.is_test) {
            survey.path.clone_from(&source.path);
            for item in &source.items {
                survey.visit_item(item);
            }
        }
        survey
    }

    fn at(&self, node: &impl Spanned) -> String {
        format!("{}:{}", self.path, node.span().start().line)
    }

    fn add_function(&mut self, signature: &Signature, block: &syn::Block) {
        let end = block.brace_token.span.close().start().line;
        self.functions.push(Function {
            name: signature.ident.to_string(),
            at: self.at(signature),
            lines: end - signature.span().start().line + 1,
            arguments: signature.inputs.iter().map(argument_count).sum(),
        });
    }

    fn function_lines(&self) -> Vec<usize> {
        let mut lines: Vec<usize> = self.functions.iter().map(|f| f.lines).collect();
        lines.sort_unstable();
        lines
    }
}

impl<'ast> Visit<'ast> for Survey {
    fn visit_item_fn(&mut self, function: &'ast syn::ItemFn) {
        self.add_function(&function.sig, &function.block);
        visit::visit_item_fn(self, function);
    }

    fn visit_impl_item_fn(&mut self, function: &'ast syn::ImplItemFn) {
        self.add_function(&function.sig, &function.block);
        visit::visit_impl_item_fn(self, function);
    }

    fn visit_trait_item_fn(&mut self, function: &'ast syn::TraitItemFn) {
        if let Some(block) = &function.default {
            self.add_function(&function.sig, block);
        }
        visit::visit_trait_item_fn(self, function);
    }

    fn visit_item_struct(&mut self, item: &'ast ItemStruct) {
        self.structs.push(Struct {
            name: item.ident.to_string(),
            at: self.at(&item.ident),
            fields: item.fields.len(),
            is_plain: is_plain(&item.fields),
        });
        visit::visit_item_struct(self, item);
    }
}

fn argument_count(argument: &FnArg) -> usize {
    match argument {
        FnArg::Receiver(_) => 0,
        FnArg::Typed(argument) => match &*argument.ty {
            Type::Tuple(tuple) => tuple.elems.len(),
            _ => 1,
        },
    }
}

fn is_plain(fields: &Fields) -> bool {
    let mut handles = Handles(false);
    handles.visit_fields(fields);
    let visible = |field: &syn::Field| !matches!(field.vis, Visibility::Inherited);
    fields.iter().all(visible) && !handles.0
}

/// Does a type hold a mutable reference or a trait object?
struct Handles(bool);

impl<'ast> Visit<'ast> for Handles {
    fn visit_type(&mut self, found: &'ast Type) {
        self.0 |= match found {
            Type::TraitObject(_) => true,
            Type::Reference(reference) => reference.mutability.is_some(),
            _ => false,
        };
        visit::visit_type(self, found);
    }
}

/// The smallest value that at least `share` of the sorted values do not exceed.
fn percentile(sorted: &[usize], share: f64) -> usize {
    let rank = (share * sorted.len() as f64).ceil() as usize;
    sorted[rank.max(1) - 1]
}

/// Lines `figure place name` of all that exceed the limit, largest first.
fn larger<'a>(
    most: usize,
    measured: impl Iterator<Item = (usize, &'a str, &'a str)>,
) -> Vec<String> {
    let mut found: Vec<_> = measured.filter(|(figure, ..)| *figure > most).collect();
    found.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(b.1)));
    let line = |(figure, at, name)| format!("{figure:5}  {at}  {name}").trim_end().to_owned();
    found.into_iter().map(line).collect()
}

fn by_lines(functions: &[Function], most: usize) -> Vec<String> {
    let measured = functions.iter().map(|f| (f.lines, &*f.at, &*f.name));
    larger(most, measured)
}

fn by_arguments(functions: &[Function], most: usize) -> Vec<String> {
    let measured = functions.iter().map(|f| (f.arguments, &*f.at, &*f.name));
    larger(most, measured)
}

fn by_fields<'a>(structs: impl Iterator<Item = &'a Struct>) -> Vec<String> {
    larger(MOST_FIELDS, structs.map(|s| (s.fields, &*s.at, &*s.name)))
}

fn is_record(name: &str) -> bool {
    RESULT_RECORDS.iter().any(|(record, _)| *record == name)
}

/// Lines of a file outside of tests.
fn line_count(source: &Source) -> usize {
    source.text.lines().count() - source.test_lines
}

fn long_files(sources: &[Source]) -> Vec<String> {
    let lengths = sources
        .iter()
        .filter(|source| !source.is_test)
        .map(|source| (line_count(source), &*source.path, ""));
    larger(FILE_LINES, lengths)
}

/// Folders with too many files; `mod.rs` and files of tests are not counted.
fn full_folders(sources: &[Source]) -> Vec<String> {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for source in sources.iter().filter(|source| !source.is_test) {
        let (folder, name) = source.path.rsplit_once('/').expect("a file in a folder");
        *counts.entry(folder).or_default() += usize::from(name != "mod.rs");
    }
    let counts = counts
        .into_iter()
        .map(|(folder, count)| (count, folder, ""));
    larger(MOST_FILES, counts)
}

#[track_caller]
fn assert_none(what: &str, offenders: &[String]) {
    assert!(offenders.is_empty(), "{what}:\n{}", offenders.join("\n"));
}

#[test]
fn half_of_the_functions_are_short_and_nine_tenths_not_long() {
    let survey = Survey::new(&read_sources());
    let lines = survey.function_lines();
    let [median, p90, p99] = [0.5, 0.9, 0.99].map(|share| percentile(&lines, share));
    let long = by_lines(&survey.functions, P90_LINES);
    println!(
        "{} functions; lines: median {median}, p90 {p90}, p99 {p99}, max {}\n\
         {} functions of more than {P90_LINES} lines:\n{}",
        lines.len(),
        percentile(&lines, 1.0),
        long.len(),
        long.join("\n"),
    );
    assert!(
        median <= MEDIAN_LINES,
        "the median function has {median} lines:\n{}",
        by_lines(&survey.functions, MEDIAN_LINES).join("\n")
    );
    assert!(
        p90 <= P90_LINES,
        "{} of {} functions have more than {P90_LINES} lines:\n{}",
        long.len(),
        lines.len(),
        long.join("\n")
    );
}

#[test]
fn no_function_takes_many_arguments() {
    let functions = Survey::new(&read_sources()).functions;
    assert_none(
        &format!("functions with more than {MOST_ARGUMENTS} arguments"),
        &by_arguments(&functions, MOST_ARGUMENTS),
    );
}

#[test]
fn the_passes_of_an_increment_read_in_one_screen() {
    let mut functions = Survey::new(&read_sources()).functions;
    functions.retain(|function| function.name == "passes");
    assert!(!functions.is_empty(), "no function `passes`");
    assert_none(
        &format!("`passes` of more than {PASSES_LINES} lines"),
        &by_lines(&functions, PASSES_LINES),
    );
}

#[test]
fn only_records_of_results_have_many_fields() {
    let structs = Survey::new(&read_sources()).structs;
    assert_none(
        &format!("structs with more than {MOST_FIELDS} fields"),
        &by_fields(structs.iter().filter(|s| !is_record(&s.name))),
    );
}

#[test]
fn records_of_results_are_plain_and_need_their_exception() {
    let structs = Survey::new(&read_sources()).structs;
    for (name, _) in RESULT_RECORDS {
        let mut found = structs.iter().filter(|s| s.name == name);
        let record = found.next().unwrap_or_else(|| panic!("no struct {name}"));
        assert!(found.next().is_none(), "two structs {name}");
        assert!(record.is_plain, "{} {name} is no plain record", record.at);
        assert!(record.fields > MOST_FIELDS, "{name} needs no exception");
    }
}

#[test]
fn no_file_is_long() {
    let what = format!("files of more than {FILE_LINES} lines");
    assert_none(&what, &long_files(&read_sources()));
}

#[test]
fn no_folder_is_full() {
    assert_none(
        &format!("folders with more than {MOST_FILES} files"),
        &full_folders(&read_sources()),
    );
}

#[test]
fn every_file_opens_with_what_it_holds() {
    let sources = read_sources();
    let without = sources
        .iter()
        .filter(|source| !source.text.starts_with("//!"));
    let without: Vec<String> = without.map(|source| format!("{}:1", source.path)).collect();
    assert_none("files that do not open with `//!`", &without);
}

/// A survey of one made-up file.
fn survey_of(text: &str) -> Survey {
    let texts = BTreeMap::from([("src/lib.rs".to_owned(), text.to_owned())]);
    Survey::new(&parse_sources(&texts))
}

#[test]
fn a_function_is_measured_from_its_signature_without_comments_above() {
    let survey = survey_of(
        "/// Comment.\n#[inline]\npub fn first(\n    a: f64,\n    b: f64,\n) -> f64 {\n    a + b\n}\n\
         struct S;\nimpl S {\n    fn second(&self, (x, y): (f64, f64)) {}\n}\n",
    );
    let measured: Vec<_> = survey
        .functions
        .iter()
        .map(|f| (&*f.name, &*f.at, f.lines, f.arguments))
        .collect();
    assert_eq!(
        measured,
        [
            ("first", "src/lib.rs:3", 6, 2),
            ("second", "src/lib.rs:11", 1, 2)
        ]
    );
}

#[test]
fn tests_are_not_measured() {
    let text = "fn kept() {}\n\
                impl S {\n    #[cfg(test)]\n    fn helper() {\n    }\n}\n\
                #[cfg(test)]\nmod tests {\n    fn left_out() {}\n}\n\
                #[cfg(test)]\nmod apart;\n";
    let texts = [
        ("src/lib.rs", text),
        ("src/apart.rs", "fn left_out() {}\n"),
        ("src/apart_too.rs", "fn kept_too() {}\n"),
    ];
    let texts = texts.map(|(path, text)| (path.to_owned(), text.to_owned()));
    let sources = parse_sources(&BTreeMap::from(texts));
    let survey = Survey::new(&sources);
    let names: Vec<_> = survey.functions.iter().map(|f| &*f.name).collect();
    assert_eq!(names, ["kept_too", "kept"]);
    assert_eq!(line_count(&sources[2]), text.lines().count() - 3 - 4);
}

#[test]
fn a_record_is_plain_without_private_fields_and_handles() {
    let plain =
        |fields: &str| survey_of(&format!("struct S<'a> {{ {fields} }}")).structs[0].is_plain;
    assert!(plain("pub a: &'a [f64], pub(crate) b: Vec<f64>"));
    assert!(!plain("pub a: f64, b: f64"));
    assert!(!plain("pub a: &'a mut f64"));
    assert!(!plain("pub a: Vec<Box<dyn Fn()>>"));
}

#[test]
fn a_percentile_is_a_measured_value() {
    let sorted = [1, 2, 3, 4, 5, 6, 7, 8, 9, 100];
    assert_eq!(percentile(&sorted, 0.5), 5);
    assert_eq!(percentile(&sorted, 0.9), 9);
    assert_eq!(percentile(&sorted, 1.0), 100);
}
