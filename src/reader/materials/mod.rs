//! `*MATERIAL` with its cards, and `*SOLID SECTION`.

mod constant;
mod damping;
mod law;
mod material;
mod section;
mod suitability;

pub(super) use section::Properties;

use super::context::Context;
use super::mesh::{MeshIndex, Outline, Sets};
use material::Drafts;

/// Reads materials and sections.
pub(super) fn read(
    outline: &Outline,
    mesh_index: &MeshIndex,
    sets: &Sets,
    cx: &mut Context,
) -> Properties {
    let drafts = Drafts::read(outline, cx);
    let mut properties = Properties::new(&mesh_index.mesh.elements, drafts.spans());
    properties.read_sections(outline, &drafts.names, (mesh_index, sets), cx);
    drafts.report_incomplete(&properties.sections, cx);
    let poisson_spans = drafts.poisson_spans();
    properties.damping_spans = drafts.damping_spans();
    properties.materials = drafts.complete(cx);
    properties.report_plane_stress(mesh_index, cx);
    properties.report_locking(&poisson_spans, cx);
    properties
}
