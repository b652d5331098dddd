//! Diagnostics as JSON, for editors. See docs/output.md, Messages as JSON.

use super::{Diagnostic, Diagnostics, Severity, Sources, Span};
use serde_json::{Value, json};

impl Diagnostics {
    /// All diagnostics in the order of their places, as one JSON object.
    pub fn json(&self, sources: &Sources) -> String {
        let all: Vec<Value> = self
            .sorted()
            .into_iter()
            .map(|item| object(item, sources))
            .collect();
        let counts = [Severity::Error, Severity::Warning].map(|severity| self.count(severity));
        let whole = json!({
            "diagnostics": all,
            "errors": counts[0],
            "warnings": counts[1],
        });
        format!("{whole:#}")
    }
}

fn object(item: &Diagnostic, sources: &Sources) -> Value {
    let severity = match item.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Note => "note",
    };
    let chain = item.span.map(|span| sources.include_chain(span));
    let instance = item.span.and_then(|span| sources.instance_of(span));
    json!({
        "severity": severity,
        "code": item.code.id(),
        "message": item.message,
        "label": item.label,
        "help": item.help,
        "other": item.other.as_ref().map(|(what, span)| json!({"what": what, "place": place(*span, sources)})),
        "place": item.span.map(|span| place(span, sources)),
        "included_from": chain.unwrap_or_default().into_iter().map(|span| place(span, sources)).collect::<Vec<_>>(),
        "instance": instance.map(|(name, _)| name),
    })
}

/// File and range of a diagnostic: lines and columns count from 1, columns in characters; the end is the column after
/// the last character.
fn place(span: Span, sources: &Sources) -> Value {
    let span = sources.typed(span);
    json!({
        "file": sources.get(span.file).map_or("", |source| source.name()),
        "start": {"line": span.line, "column": span.column},
        "end": {"line": span.line, "column": span.column + span.length},
    })
}
