//! Slave nodes that contact cannot move.

use crate::diagnostics::{Code, Diagnostic};
use crate::model::{ALL_EXTERIOR, Model, Step};
use crate::reader::context::Context;
use std::collections::BTreeSet;

/// Warns about contact pairs of which more than half of the slave nodes are prescribed in both
/// directions throughout. The clamped end of a surface is common, and does no harm.
pub(crate) fn fixed_slaves(model: &Model, cx: &mut Context) {
    if cx.d.has_errors() {
        return;
    }
    let prescribed = prescribed_throughout(&model.steps);
    let is_fixed = |node: &usize| [0, 1].iter().all(|i| prescribed.contains(&(2 * node + i)));
    for contact in &model.contacts {
        let slave = &model.surfaces[contact.slave];
        if contact.is_self_contact() || slave.name == ALL_EXTERIOR {
            continue;
        }
        let nodes = slave.nodes(&model.mesh);
        let fixed = nodes.iter().filter(|node| is_fixed(node)).count();
        if 2 * fixed <= nodes.len() {
            continue;
        }
        let message = format!(
            "{fixed} of the {} slave nodes of {} are prescribed in both directions",
            nodes.len(),
            slave.name,
        );
        let warning = Diagnostic::warning(Code::FixedSlave, contact.span, message);
        cx.d.push(warning.help("contact cannot move them: make the free surface the slave"));
    }
}

/// Dofs that are prescribed in all steps.
fn prescribed_throughout(steps: &[Step]) -> BTreeSet<usize> {
    let of = |step: &Step| step.supports.iter().map(|support| support.dof).collect();
    let sets = steps.iter().map(of);
    let common = sets.reduce(|common: BTreeSet<usize>, of| &common & &of);
    common.unwrap_or_default()
}
