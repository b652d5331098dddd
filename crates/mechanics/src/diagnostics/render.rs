//! Diagnostics as text: message, source line with caret, chain of includes and advice, laid out by
//! annotate-snippets in the style of rustc.

use super::diagnostic::SHOWN;
use super::{Diagnostic, Diagnostics, Severity, Sources, Span};
use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};
use std::ops::Range;

impl Diagnostics {
    /// Text of the diagnostics in the order of their places: at most 20 of each severity, then the number of further
    /// diagnostics.
    pub fn render(&self, sources: &Sources, colour: bool) -> String {
        let renderer = match colour {
            true => Renderer::styled(),
            false => Renderer::plain(),
        };
        let mut text = String::new();
        let mut shown = [0; 3];
        for item in self.sorted() {
            let count = &mut shown[item.severity as usize];
            *count += 1;
            if *count <= SHOWN {
                text.push_str(&renderer.render(&[group(item, sources)]));
                text.push_str("\n\n");
            }
        }
        text + &self.rest(&renderer)
    }

    /// One line for each severity with more diagnostics than are shown.
    fn rest(&self, renderer: &Renderer) -> String {
        let mut text = String::new();
        for severity in [Severity::Error, Severity::Warning, Severity::Note] {
            let more = self.count(severity).saturating_sub(SHOWN);
            if more > 0 {
                let title = format!("{more} more of these are not shown");
                let title = level(severity).primary_title(title);
                text.push_str(&renderer.render(&[Group::with_title(title)]));
                text.push('\n');
            }
        }
        text
    }
}

fn level(severity: Severity) -> Level<'static> {
    match severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
        Severity::Note => Level::NOTE,
    }
}

/// The parts of a message: title, source line with caret, place of inclusion of the file, advice.
fn group<'a>(item: &'a Diagnostic, sources: &'a Sources) -> Group<'a> {
    let title = level(item.severity).primary_title(item.message.as_str());
    let mut group = Group::with_title(title.id(item.code.id()));
    if let Some(span) = item.span.map(|span| sources.typed(span)) {
        group = match snippet(span, item, sources) {
            Some(snippet) => group.element(snippet),
            None => group.elements(origin(span, sources)),
        };
        for place in sources.include_chain(span) {
            group = group.element(Level::NOTE.message(included_from(place, sources)));
        }
        if let Some((name, place)) = sources.instance_of(span) {
            group = group.element(Level::NOTE.message(in_instance(name, place, sources)));
        }
    }
    if let Some((what, place)) = &item.other {
        let text = format!("{what} stands at {}", position(*place, sources));
        group = group.element(Level::NOTE.message(text));
    }
    match &item.help {
        Some(help) => group.element(Level::HELP.message(help.as_str())),
        None => group,
    }
}

fn snippet<'a>(
    span: Span,
    item: &'a Diagnostic,
    sources: &'a Sources,
) -> Option<Snippet<'a, annotate_snippets::Annotation<'a>>> {
    let source = sources.get(span.file)?;
    let line = source.line(span.line)?;
    let mark = AnnotationKind::Primary.span(byte_range(line, span));
    Some(
        Snippet::source(line)
            .path(source.name())
            .line_start(span.line as usize)
            .annotation(mark.label(item.label.as_deref())),
    )
}

/// The place without source text, for a file that does not have the line, for example an empty file.
fn origin(span: Span, sources: &Sources) -> Option<Origin<'_>> {
    let source = sources.get(span.file)?;
    let origin = Origin::path(source.name()).line(span.line as usize);
    Some(origin.char_column(span.column as usize))
}

fn included_from(place: Span, sources: &Sources) -> String {
    format!("included from {}", position(place, sources))
}

fn in_instance(name: &str, place: Span, sources: &Sources) -> String {
    format!("in the instance {name} of {}", position(place, sources))
}

fn position(place: Span, sources: &Sources) -> String {
    let place = sources.typed(place);
    let name = sources.get(place.file).map_or("", |source| source.name());
    format!("{name}:{}:{}", place.line, place.column)
}

/// Range of bytes of `line` with the characters of `span`.
fn byte_range(line: &str, span: Span) -> Range<usize> {
    let byte_at = |character: usize| {
        let mut starts = line.char_indices().map(|(at, _)| at);
        starts.nth(character).unwrap_or(line.len())
    };
    let first = (span.column as usize).saturating_sub(1);
    byte_at(first)..byte_at(first + span.length as usize)
}

#[cfg(test)]
mod tests {
    use crate::diagnostics::{Code, Diagnostic, Diagnostics, FileId, Sources, Span};

    #[test]
    fn shows_line_caret_include_and_help() {
        let mut sources = Sources::new();
        let place = |file, line, column, length| Span {
            file: FileId(file),
            line,
            column,
            length,
            instance: 0,
        };
        sources.add("slope.inp", "*HEADING\n*INCLUDE, INPUT=bc.inp\n", None);
        sources.add("bc.inp", "*BONDARY, OP=NEW\n", Some(place(0, 2, 1, 8)));
        let mut diagnostics = Diagnostics::new();
        diagnostics.push(
            Diagnostic::error(
                Code::UnknownKeyword,
                place(1, 1, 1, 8),
                "unknown keyword *BONDARY",
            )
            .suggest(Some("*BOUNDARY"))
            .help("unknown keywords stop the run"),
        );
        let text = diagnostics.render(&sources, false);
        let wanted = "\
error[D103]: unknown keyword *BONDARY
 --> bc.inp:1:1
  |
1 | *BONDARY, OP=NEW
  | ^^^^^^^^ did you mean *BOUNDARY?
  |
  = note: included from slope.inp:2:1
  = help: unknown keywords stop the run
";
        assert_eq!(text.trim_end(), wanted.trim_end());
    }
}
