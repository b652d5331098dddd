//! A model that is ready to run, and its preparation: nodes adjusted, contact surfaces and initial
//! gaps computed, initial penetration reported. Both the program and users of the library start
//! from a prepared model.

use super::adjustment::{Adjusted, adjust, report_adjusted};
use super::initial_gaps::{InitialGap, gaps};
use super::initial_penetration::report_penetrations;
use super::redistribution::Redistribution;
use crate::contact::{ContactSurfaces, contact_surfaces};
use crate::diagnostics::Diagnostics;
use crate::model::Model;
use std::collections::HashMap;

/// A model with its nodes adjusted, its contact surfaces and the initial gaps between them. Mesh and contacts of a
/// prepared model do not change any more; the settings of steps may change.
#[derive(Debug, Clone, PartialEq)]
pub struct PreparedModel {
    /// The model with adjusted nodes.
    pub model: Model,
    /// Surfaces of every contact.
    pub surfaces: Vec<ContactSurfaces>,
    /// Gaps of the slave nodes of each contact in the reference configuration, without nodes that
    /// face no segment.
    pub gaps: Vec<Vec<InitialGap>>,
    /// Overlaps of all slave nodes of contacts that remove overlaps in the first step (length); empty for other
    /// contacts.
    pub overlaps: Vec<Vec<f64>>,
    /// Moved nodes, one contact after the other.
    pub adjusted: Vec<Adjusted>,
    /// Nodes without mass, and the nodes that carry their mass.
    pub redistribution: Redistribution,
}

/// Prepares a model; reports adjusted nodes, elements that the adjustment spoils, and initial
/// penetration. `None` if there are errors.
pub fn prepare(model: Model, d: &mut Diagnostics) -> Option<PreparedModel> {
    let prepared = PreparedModel::new(model);
    report_adjusted(&prepared.model, &prepared.adjusted, d);
    if !d.has_errors() {
        let PreparedModel {
            model,
            surfaces,
            gaps,
            overlaps,
            ..
        } = &prepared;
        report_penetrations(model, surfaces, (gaps, overlaps), d);
    }
    (!d.has_errors()).then_some(prepared)
}

/// Overlaps of all slave nodes of a contact (length): the depths of the nodes in a body that the surface of the nodes
/// faces.
fn overlaps(contact: &ContactSurfaces, gaps: &[InitialGap], x: &[[f64; 2]]) -> Vec<f64> {
    let inside = gaps.iter().filter(|gap| gap.is_inside(contact, x));
    let depths: HashMap<usize, f64> = inside.map(|gap| (gap.slave, -gap.gap)).collect();
    let slaves = contact.slaves.iter();
    slaves
        .map(|slave| depths.get(slave).copied().unwrap_or(0.0))
        .collect()
}

impl PreparedModel {
    /// Prepares a model without the checks that [`prepare`] makes.
    pub fn new(mut model: Model) -> Self {
        let bodies = model.mesh.bodies();
        let mut surfaces = contact_surfaces(&model, &bodies);
        let adjusted = adjust(&mut model, &surfaces);
        if !adjusted.is_empty() {
            surfaces = contact_surfaces(&model, &bodies);
        }
        let x = &model.mesh.coordinates;
        let redistribution = match model.redistributes_mass() {
            true => Redistribution::new(&model, &surfaces),
            false => Redistribution::default(),
        };
        let shrinks = |contact: usize| model.shrinks(contact);
        let numbered = surfaces.iter().enumerate();
        let gaps: Vec<Vec<InitialGap>> = numbered
            .map(|(i, contact)| gaps(contact, x, &bodies, shrinks(i)))
            .collect();
        let of_contact = surfaces.iter().zip(&gaps).enumerate();
        PreparedModel {
            overlaps: of_contact
                .map(|(i, (contact, gaps))| match shrinks(i) {
                    true => overlaps(contact, gaps, x),
                    false => Vec::new(),
                })
                .collect(),
            gaps,
            surfaces,
            adjusted,
            redistribution,
            model,
        }
    }
}
