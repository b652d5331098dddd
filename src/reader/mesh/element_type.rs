//! Reads element types; explains why the types of other codes cannot be used.

use crate::deck::Text;
use crate::diagnostics::{Code, Diagnostic, closest};
use crate::model::ElementType;
use crate::reader::context::Context;

/// Kind of an element of the deck.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A plane element.
    Plane(ElementType),
    /// Two nodes that name a side of a plane element.
    Line,
}

impl Kind {
    /// Number of nodes.
    pub fn nodes(self) -> usize {
        match self {
            Kind::Plane(element_type) => element_type.topology().nodes,
            Kind::Line => 2,
        }
    }
}

/// The kind of elements with this name.
pub(super) fn read(name: Text, cx: &mut Context) -> Option<Kind> {
    let folded = name.name_key();
    if ["T2D2", "T3D2", "B21", "B31"].contains(&folded.as_str()) {
        return Some(Kind::Line);
    }
    let known = ElementType::from_name(&folded).or_else(|| unusable(name, &folded, cx));
    known.map(Kind::Plane)
}

/// Reports a type; lenient reading replaces reduced by full integration of 4-node elements.
fn unusable(name: Text, folded: &str, cx: &mut Context) -> Option<ElementType> {
    let full = folded.strip_suffix('R').and_then(ElementType::from_name);
    if let Some(full) = full.filter(|full| full.topology().nodes == 4 && cx.d.is_lenient()) {
        let message = format!("{} is integrated with 2 x 2 points", name.text);
        cx.d.push_once(Diagnostic::warning(Code::ElementType, name.span, message));
        return Some(full);
    }
    let message = format!("element type {} cannot be used", name.text);
    let error = Diagnostic::error(Code::ElementType, name.span, message);
    let meant = closest(folded, ["CPS3", "CPE3", "CPS4", "CPE4"]);
    cx.d.push(match reason(folded) {
        Some(reason) => error.help(reason),
        None => error.suggest(meant).help("use CPS3, CPE3, CPS4 or CPE4"),
    });
    None
}

/// Why a type that other codes know cannot be used.
fn reason(folded: &str) -> Option<&'static str> {
    let starts = |prefixes: &[&str]| prefixes.iter().any(|prefix| folded.starts_with(prefix));
    if starts(&["CPE4R", "CPS4R"]) && folded.len() == 5 {
        Some(
            "elements with one integration point are not supported: write CPE4 or CPS4; --lenient takes \
             them as these",
        )
    } else if starts(&["CPE4", "CPS4", "CPE3", "CPS3"]) && folded.len() > 4 {
        Some("write CPE3, CPS3, CPE4 or CPS4: other formulations are not supported")
    } else if starts(&["CPE6", "CPS6", "CPE8", "CPS8"]) {
        Some("quadratic elements are not supported: split them into linear ones")
    } else if starts(&["CAX"]) {
        Some("axisymmetric elements are not supported")
    } else if starts(&["T2D", "T3D", "B2", "B3", "R2D"]) {
        Some("line elements only name sides of plane elements: use T3D2 with two nodes")
    } else if starts(&["C3D", "S3", "S4", "S6", "S8", "M3D", "R3D"]) {
        Some("the program is plane: use CPS3, CPE3, CPS4 or CPE4")
    } else {
        None
    }
}
