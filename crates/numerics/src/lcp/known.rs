//! What is known of a frictional problem before its solution. See docs/theory/complementarity.md, The hybrid.

use super::problems::ContactState;

/// What is known of a problem before its solution.
#[derive(Clone, Copy)]
pub struct Known<'k> {
    /// States of a similar problem, from which the search begins.
    pub states: &'k [ContactState],
    /// The number of the joint of every contact: contacts between the same bodies, which change their states together. An
    /// empty list leaves every contact by itself. It is asked for only where single contacts come to no end.
    pub joints: &'k dyn Fn() -> Vec<usize>,
}

impl<'k> Known<'k> {
    /// States alone.
    pub fn of_states(states: &'k [ContactState]) -> Self {
        let joints = &Vec::new;
        Known { states, joints }
    }
}
