//! Diagnostics of decks as `stickslip check` finds them, computed in a thread of their own. Texts of the editor replace
//! files that are not saved, and a check that has become obsolete ends early.

use super::document::position;
use super::files::path_of;
use crate::diagnostics::{
    Diagnostic as Finding, Diagnostics, Interrupt, Severity, Sources, Span, whole_path,
};
use crossbeam_channel::{Receiver, Sender, bounded, unbounded};
use lsp_types::{
    Diagnostic, DiagnosticRelatedInformation, DiagnosticSeverity, Location, NumberOrString, Range,
    Url,
};
use ropey::Rope;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::thread;

/// Function that reads a deck and returns the diagnostics of `stickslip check`.
pub type Check = fn(&Path, &mut Sources) -> Diagnostics;

/// Largest number of diagnostics of a file that the editor gets.
const MOST: usize = 1000;

/// A deck that is to be checked.
pub(super) struct Job {
    /// Main file of the deck.
    pub root: PathBuf,
    /// Texts of files that are open in the editor, by their whole paths.
    pub unsaved: BTreeMap<PathBuf, Rope>,
    /// Addresses (URIs) that the editor uses for the files.
    pub addresses: BTreeMap<PathBuf, Url>,
    /// Signal that ends the check early.
    pub interrupt: Interrupt,
}

/// Outcome of a check.
pub(super) struct Outcome {
    /// Main file of the deck.
    pub root: PathBuf,
    /// Diagnostics by file; every file of the deck has an entry. `None` if the check was ended early.
    pub found: Option<BTreeMap<PathBuf, Vec<Diagnostic>>>,
}

/// Data of a diagnostic that a quick fix needs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Fix {
    /// Text at the range of the diagnostic.
    pub found: String,
    /// Text that was probably meant.
    pub meant: String,
}

/// Starts a thread that checks one deck after the other.
pub(super) fn start(check: Check) -> (Sender<Job>, Receiver<Outcome>) {
    let (to_do, jobs) = bounded::<Job>(1);
    let (done, outcomes) = unbounded();
    thread::spawn(move || {
        for job in jobs {
            let (root, interrupt) = (job.root.clone(), job.interrupt.clone());
            let found = catch_unwind(AssertUnwindSafe(|| run(check, job)));
            let found = match found {
                Ok(found) => found,
                Err(_) if interrupt.is_asked() => None,
                Err(_) => Some(BTreeMap::from([(root.clone(), vec![broken()])])),
            };
            if done.send(Outcome { root, found }).is_err() {
                return;
            }
        }
    });
    (to_do, outcomes)
}

/// The diagnostic that the editor gets if a check itself fails.
fn broken() -> Diagnostic {
    let message = "stickslip has a fault: this deck could not be checked".to_owned();
    Diagnostic {
        source: Some("stickslip".to_owned()),
        ..Diagnostic::new_simple(Range::default(), message)
    }
}

fn run(check: Check, job: Job) -> Option<BTreeMap<PathBuf, Vec<Diagnostic>>> {
    let texts = job.unsaved.into_iter();
    let texts = texts.map(|(path, rope)| (path, rope.to_string())).collect();
    let mut sources = Sources::with_unsaved(texts, job.interrupt.clone());
    let d = check(&job.root, &mut sources);
    if job.interrupt.is_asked() {
        return None;
    }
    let texts = Texts {
        sources: &sources,
        addresses: &job.addresses,
    };
    let mut found: BTreeMap<PathBuf, Vec<Diagnostic>> = BTreeMap::new();
    found.insert(job.root.clone(), Vec::new());
    for source in sources.files() {
        found
            .entry(whole_path(Path::new(source.name())))
            .or_default();
    }
    for item in d.sorted() {
        let file = item.span.and_then(|span| sources.get(span.file));
        let path = file.map_or(job.root.clone(), |file| whole_path(Path::new(file.name())));
        found.entry(path).or_default().push(texts.diagnostic(item));
    }
    found.values_mut().for_each(shorten);
    Some(found)
}

/// Cuts a list of diagnostics that is too long for an editor, and states the number left out.
fn shorten(all: &mut Vec<Diagnostic>) {
    let more = all.len().saturating_sub(MOST);
    all.truncate(MOST);
    if more > 0
        && let Some(last) = all.last_mut()
    {
        last.message += &format!("\n{more} more of this file are not shown");
    }
}

/// The texts that diagnostics refer to.
struct Texts<'s> {
    sources: &'s Sources,
    addresses: &'s BTreeMap<PathBuf, Url>,
}

impl Texts<'_> {
    fn diagnostic(&self, item: &Finding) -> Diagnostic {
        let parts = [item.label.as_ref(), item.help.as_ref()];
        let parts = [Some(&item.message)].into_iter().chain(parts).flatten();
        let message = parts.map(String::as_str).collect::<Vec<_>>().join("\n");
        let span = item.span.map(|span| self.sources.typed(span));
        let fix = span.zip(item.suggestion.clone()).map(|(span, meant)| Fix {
            found: self.text(span),
            meant,
        });
        Diagnostic {
            range: span.map(|span| self.range(span)).unwrap_or_default(),
            severity: Some(match item.severity {
                Severity::Error => DiagnosticSeverity::ERROR,
                Severity::Warning => DiagnosticSeverity::WARNING,
                Severity::Note => DiagnosticSeverity::INFORMATION,
            }),
            code: Some(NumberOrString::String(item.code.id().to_owned())),
            source: Some("stickslip".to_owned()),
            message,
            related_information: Some(self.related(item)).filter(|all| !all.is_empty()),
            data: fix.and_then(|fix| serde_json::to_value(fix).ok()),
            ..Diagnostic::default()
        }
    }

    /// Places related to a diagnostic: where the file is included, where the instance is placed, and the other card.
    fn related(&self, item: &Finding) -> Vec<DiagnosticRelatedInformation> {
        let chain = item.span.map(|span| self.sources.include_chain(span));
        let chain = chain.into_iter().flatten();
        let included = chain.map(|span| ("included here".to_owned(), span));
        let instance = item.span.and_then(|span| self.sources.instance_of(span));
        let instance = instance.map(|(name, span)| (format!("in the instance {name}"), span));
        let all = included.chain(instance).chain(item.other.clone());
        all.filter_map(|(message, span)| {
            let location = self.location(span)?;
            Some(DiagnosticRelatedInformation { location, message })
        })
        .collect()
    }

    fn location(&self, span: Span) -> Option<Location> {
        let path = whole_path(Path::new(self.sources.get(span.file)?.name()));
        let open = self.addresses.get(&path).cloned();
        let uri = open.or_else(|| Url::from_file_path(&path).ok())?;
        let range = self.range(span);
        Some(Location { uri, range })
    }

    fn line(&self, span: Span) -> &str {
        let source = self.sources.get(span.file);
        source
            .and_then(|source| source.line(span.line))
            .unwrap_or("")
    }

    fn range(&self, span: Span) -> Range {
        let (text, line) = (self.line(span), span.line as usize - 1);
        let start = span.column as usize - 1;
        let [start, end] = [start, start + span.length as usize];
        let [start, end] = [start, end].map(|column| position(text, line, column));
        Range { start, end }
    }

    fn text(&self, span: Span) -> String {
        let characters = self.line(span).chars();
        let skipped = characters.skip(span.column as usize - 1);
        skipped.take(span.length as usize).collect()
    }
}

/// Whole paths of files by the addresses that the editor uses, for the diagnostics of a deck.
pub(super) fn addresses<'u>(open: impl Iterator<Item = &'u Url>) -> BTreeMap<PathBuf, Url> {
    open.map(|uri| (path_of(uri), uri.clone())).collect()
}
