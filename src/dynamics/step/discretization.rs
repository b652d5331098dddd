//! Discretization of a model, constant over a run: elements, mass, bodies with their parts, contact
//! surfaces.

use super::mass::Mass;
use super::parts::Parts;
use crate::contact::ContactSurfaces;
use crate::elements::Elements;
use crate::model::Model;
use crate::prepare::PreparedModel;

/// A prepared model with its elements, their mass, and the bodies and parts that scale convergence.
pub(crate) struct Discretization<'m> {
    pub model: &'m Model,
    pub contacts: &'m [ContactSurfaces],
    pub elements: Elements,
    pub mass: Mass,
    pub parts: Parts,
}

impl<'m> Discretization<'m> {
    /// The discretization of a model.
    pub fn new(prepared: &'m PreparedModel) -> Self {
        let model = prepared.model();
        let elements = Elements::new(model);
        Discretization {
            model,
            contacts: prepared.contact_surfaces(),
            mass: Mass::new(&elements, model.mesh.node_count()),
            parts: Parts::new(model),
            elements,
        }
    }
}
