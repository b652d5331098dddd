//! Loads, motions and velocities of nodes without element. Actions on nodes without element are kept with their places
//! until all cards are read, because the card that gives such a node a displacement may stand behind the actions.

use crate::diagnostics::Span;

/// An action on a displacement of a node: load, motion or velocity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Action {
    Load,
    Motion,
    Velocity,
}

/// Dofs of nodes without element on which something other than zero acts, with the places of the rows.
#[derive(Default)]
pub(crate) struct Actions {
    pub all: Vec<(usize, Action, Span)>,
}

impl Actions {
    /// Enters an action on a dof; `has_element` says for each node whether it belongs to a plane element.
    pub fn enter(&mut self, dof: usize, action: Action, span: Span, has_element: &[bool]) {
        let is_of_element = has_element.get(dof / 2) != Some(&false);
        if !is_of_element {
            self.all.push((dof, action, span));
        }
    }
}
