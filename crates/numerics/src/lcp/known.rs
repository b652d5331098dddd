//! Data known about a frictional problem before its solution. See docs/theory/complementarity.md, The hybrid.

use super::problems::ContactState;

/// Data known about a problem before its solution.
#[derive(Clone, Copy)]
pub struct Known<'k> {
    /// States of a similar problem, with which the search begins.
    pub states: &'k [ContactState],
    /// Function that returns the number of the joint of every contact (contacts between the same bodies change their
    /// states together), or an empty list if there are no joints. The function is called only if changing single
    /// contacts does not end.
    pub joints: &'k dyn Fn() -> Vec<usize>,
}

impl<'k> Known<'k> {
    /// Only states are known.
    pub fn of_states(states: &'k [ContactState]) -> Self {
        let joints = &Vec::new;
        Known { states, joints }
    }
}
