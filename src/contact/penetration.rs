use super::{InitialGap, initial_gaps};
use crate::diagnostics::{Code, Diagnostic, Diagnostics};
use crate::model::{Contact, Model};

/// Penetration (in edge lengths) that is a fault of the mesh rather than of its digits.
const FAULT: f64 = 1e-3;
/// Penetration (in edge lengths) that is round-off of the coordinates.
const ROUND_OFF: f64 = 1e-9;

/// Reports slave nodes that start inside the master body: deep ones as errors, shallow ones, which
/// the first increment pushes out, as warnings.
pub fn report_penetrations(model: &Model, d: &mut Diagnostics) {
    for (contact, gaps) in model.contacts.iter().zip(initial_gaps(model)) {
        let depth = |gap: &InitialGap| -gap.gap / gap.edge;
        let inside: Vec<InitialGap> = gaps
            .into_iter()
            .filter(|gap| depth(gap) > ROUND_OFF)
            .collect();
        let deepest = inside.iter().max_by(|a, b| depth(a).total_cmp(&depth(b)));
        if let Some(deepest) = deepest {
            d.push(diagnostic(model, contact, deepest, inside.len()));
        }
    }
}

fn diagnostic(model: &Model, contact: &Contact, deepest: &InitialGap, count: usize) -> Diagnostic {
    let master = match contact.is_self_contact() {
        true => "another body",
        false => &format!("the body of {}", model.surfaces[contact.master].name),
    };
    let message = format!(
        "{count} {} of {} inside {master} at the start; deepest: node {} by {:.3e} \
         ({:.1e} of the edge length)",
        if count == 1 { "node" } else { "nodes" },
        model.surfaces[contact.slave].name,
        model.mesh.node_labels[deepest.slave],
        -deepest.gap,
        -deepest.gap / deepest.edge,
    );
    let code = Code::InitialPenetration;
    if -deepest.gap > FAULT * deepest.edge {
        Diagnostic::error(code, contact.span, message)
            .help("move the bodies apart: pushing the nodes out would add energy")
    } else {
        Diagnostic::warning(code, contact.span, message).help("the first increment pushes them out")
    }
}
