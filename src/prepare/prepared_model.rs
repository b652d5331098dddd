//! A model that is ready to run, and its preparation: nodes adjusted, contact surfaces and initial
//! gaps computed, initial penetration reported. Program and library both use it.

use super::adjustment::{Adjusted, adjust, report_adjusted};
use super::initial_gaps::{InitialGap, gaps};
use super::initial_penetration::report_penetrations;
use super::redistribution::Redistribution;
use crate::contact::{ContactSurfaces, contact_surfaces};
use crate::diagnostics::Diagnostics;
use crate::model::Model;

/// A model with its nodes adjusted, its contact surfaces and the initial gaps between them. Mesh and
/// contacts stay as they are from here on; the settings of steps may change.
#[derive(Debug, Clone, PartialEq)]
pub struct PreparedModel {
    /// The model, nodes adjusted.
    pub model: Model,
    /// Surfaces of every contact.
    pub surfaces: Vec<ContactSurfaces>,
    /// Gaps of the slave nodes of each contact in the reference configuration; nodes that face no
    /// segment are left out.
    pub gaps: Vec<Vec<InitialGap>>,
    /// Moved nodes, contact by contact.
    pub adjusted: Vec<Adjusted>,
    /// Nodes without mass, and those that carry it.
    pub redistribution: Redistribution,
}

/// Prepares a model; reports adjusted nodes, elements that the adjustment spoils, and initial
/// penetration. `None` if there are errors.
pub fn prepare(model: Model, d: &mut Diagnostics) -> Option<PreparedModel> {
    let prepared = PreparedModel::new(model);
    report_adjusted(&prepared.model, &prepared.adjusted, d);
    if !d.has_errors() {
        report_penetrations(&prepared.model, &prepared.surfaces, &prepared.gaps, d);
    }
    (!d.has_errors()).then_some(prepared)
}

impl PreparedModel {
    /// Prepares a model without the checks that [`prepare`] makes.
    pub fn new(mut model: Model) -> Self {
        let bodies = model.mesh.bodies();
        let mut surfaces = contact_surfaces(&model, &bodies);
        let adjusted = adjust(&mut model, &surfaces);
        let x = &model.mesh.coordinates;
        if !adjusted.is_empty() {
            let moved = surfaces.into_iter();
            surfaces = moved.map(|contact| contact.with_sharp_corners(x)).collect();
        }
        let redistribution = match model.redistributes_mass() {
            true => Redistribution::new(&model, &surfaces),
            false => Redistribution::default(),
        };
        let of_contact = |contact: &ContactSurfaces| gaps(contact, x, &bodies);
        PreparedModel {
            gaps: surfaces.iter().map(of_contact).collect(),
            surfaces,
            adjusted,
            redistribution,
            model,
        }
    }
}
