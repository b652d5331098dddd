//! Discretization of a model, constant over a run: elements, mass, bodies with their parts, contact
//! surfaces.

use super::mass::Mass;
use super::parts::Parts;
use crate::contact::ContactSurfaces;
use crate::elements::Elements;
use crate::model::Model;
use crate::prepare::{PreparedModel, Redistribution};

/// A prepared model with its elements, their mass, and the bodies and parts that scale convergence.
pub(crate) struct Discretization<'m> {
    pub model: &'m Model,
    pub contacts: &'m [ContactSurfaces],
    pub elements: Elements,
    pub mass: Mass,
    pub redistribution: &'m Redistribution,
    pub parts: Parts,
}

impl<'m> Discretization<'m> {
    /// The discretization of a model.
    pub fn new(prepared: &'m PreparedModel) -> Self {
        let model = prepared.model();
        let elements = Elements::new(model);
        let redistribution = prepared.redistribution();
        Discretization {
            model,
            contacts: prepared.contact_surfaces(),
            mass: Mass::new(&elements, redistribution, model.mesh.node_count()),
            redistribution,
            parts: Parts::new(model),
            elements,
        }
    }
}
