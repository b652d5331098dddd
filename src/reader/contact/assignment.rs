//! Rows under `*CONTACT` that assign something to surfaces: here to all of them.

use crate::deck::{Row, Text};
use crate::diagnostics::{Code, Diagnostic};
use crate::reader::context::Context;

/// The name in `, , name`, where `what` it names; the empty fields stand for all surfaces.
pub(super) fn of_all_surfaces<'a>(row: Row<'a>, what: &str, cx: &mut Context) -> Option<Text<'a>> {
    row.at_most(3, cx.d);
    let mut named = (0..2).filter_map(|i| row.get(i));
    if let Some(field) = named.find(|field| field.name_key() != "ALLEXTERIOR") {
        let message = "only the assignment to all surfaces is supported";
        let error = Diagnostic::error(Code::GeneralContact, field.span, message);
        cx.d.push(error.help("leave the first two fields empty"));
        return None;
    }
    row.required(2, what, cx.d)
}
