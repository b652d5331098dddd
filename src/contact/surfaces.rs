use std::collections::HashMap;

use crate::model::Model;

/// The two sides of a contact of the model, as nodes and segments.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactSurfaces {
    /// Slave nodes.
    pub slaves: Vec<usize>,
    /// Master segments [a, b], the body on the left of the way from a to b.
    pub segments: Vec<[usize; 2]>,
    /// For every segment the one that starts where it ends, if any.
    pub next: Vec<Option<usize>>,
    /// Coefficient of friction mu.
    pub friction: f64,
}

/// The contacts of a model.
pub fn contact_surfaces(model: &Model) -> Vec<ContactSurfaces> {
    let of_contact = |contact: &crate::model::Contact| {
        let segments = model.surfaces[contact.master].segments(&model.mesh);
        let starts: HashMap<usize, usize> = segments
            .iter()
            .enumerate()
            .map(|(i, [a, _])| (*a, i))
            .collect();
        ContactSurfaces {
            slaves: model.surfaces[contact.slave].nodes(&model.mesh),
            next: segments
                .iter()
                .map(|[_, b]| starts.get(b).copied())
                .collect(),
            segments,
            friction: model.friction(contact),
        }
    };
    model.contacts.iter().map(of_contact).collect()
}
