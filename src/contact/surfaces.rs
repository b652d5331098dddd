use std::collections::HashMap;

use crate::model::{Contact, Model};

/// The two sides of a contact of the model, as nodes and segments.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactSurfaces {
    /// Slave nodes.
    pub slaves: Vec<usize>,
    /// For every slave node the nodes before and after it on its own surface, where it has both.
    pub beside: Vec<Option<[usize; 2]>>,
    /// Master segments [a, b], the body on the left of the way from a to b.
    pub segments: Vec<[usize; 2]>,
    /// For every segment the one that starts where it ends, if any.
    pub next: Vec<Option<usize>>,
    /// For every segment the one that ends where it starts, if any.
    pub previous: Vec<Option<usize>>,
    /// Coefficient of friction mu.
    pub friction: f64,
}

impl ContactSurfaces {
    /// Slave nodes, which lie on the segments `own` (none if the slave side is nodes only), against
    /// master segments.
    pub fn new(
        slaves: Vec<usize>,
        own: &[[usize; 2]],
        segments: Vec<[usize; 2]>,
        friction: f64,
    ) -> Self {
        // node at the other end of the segment that starts or ends at a node
        let following: HashMap<usize, usize> = own.iter().map(|&[a, b]| (a, b)).collect();
        let preceding: HashMap<usize, usize> = own.iter().map(|&[a, b]| (b, a)).collect();
        let beside = |slave: &usize| Some([*preceding.get(slave)?, *following.get(slave)?]);
        // segment that starts or ends at a node
        let numbered = || segments.iter().enumerate();
        let starting: HashMap<usize, usize> = numbered().map(|(i, &[a, _])| (a, i)).collect();
        let ending: HashMap<usize, usize> = numbered().map(|(i, &[_, b])| (b, i)).collect();
        let at = |of: &HashMap<usize, usize>, node: usize| of.get(&node).copied();
        ContactSurfaces {
            beside: slaves.iter().map(beside).collect(),
            next: segments.iter().map(|&[_, b]| at(&starting, b)).collect(),
            previous: segments.iter().map(|&[a, _]| at(&ending, a)).collect(),
            slaves,
            segments,
            friction,
        }
    }
}

/// The contacts of a model.
pub fn contact_surfaces(model: &Model) -> Vec<ContactSurfaces> {
    let of_contact = |contact: &Contact| {
        let [slave, master] = [contact.slave, contact.master].map(|i| &model.surfaces[i]);
        ContactSurfaces::new(
            slave.nodes(&model.mesh),
            &slave.segments(&model.mesh),
            master.segments(&model.mesh),
            model.friction(contact),
        )
    };
    model.contacts.iter().map(of_contact).collect()
}
