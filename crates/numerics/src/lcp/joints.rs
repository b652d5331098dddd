//! Contacts that change their states together: those between the same two bodies. See docs/theory/complementarity.md,
//! The hybrid.

use std::cell::OnceCell;

use super::dense::List;
use super::problems::{ContactState, FrictionalLcp, FrictionalSolution};
use super::scaled::Scaled;

/// Contacts of a joint at most. The problems of larger ones cost what they spare.
const MOST: usize = 32;

/// Solves the problem of a joint from some states; `None` where it has no answer.
pub(crate) type SolveJoint = fn(&FrictionalLcp, &[ContactState]) -> Option<FrictionalSolution>;

/// The joints of a problem: contacts that act at the same place, whose conditions say nearly the same. What the state
/// of one of them has to be, depends on the states of the others first of all.
pub(crate) struct Joints<'k> {
    /// The number of the joint of every contact.
    numbers: &'k dyn Fn() -> Vec<usize>,
    /// The contacts of every joint that has several, increasing; found when they are asked for.
    members: OnceCell<Vec<Vec<usize>>>,
}

impl<'k> Joints<'k> {
    /// Every contact by itself.
    pub fn none() -> Self {
        Joints::of(&Vec::new)
    }

    /// Contacts with equal `numbers` form a joint.
    pub const fn of(numbers: &'k dyn Fn() -> Vec<usize>) -> Self {
        Joints {
            numbers,
            members: OnceCell::new(),
        }
    }

    /// The joints of several contacts, but not of all: the problem of such a joint is the problem itself.
    fn members(&self, contacts: usize) -> &[Vec<usize>] {
        self.members.get_or_init(|| {
            let numbers = (self.numbers)();
            let mut order: Vec<usize> = (0..numbers.len().min(contacts)).collect();
            order.sort_by_key(|&contact| numbers[contact]);
            let all = order.chunk_by(|&i, &j| numbers[i] == numbers[j]);
            let are_solved = |joint: &&[usize]| (2..=MOST.min(contacts - 1)).contains(&joint.len());
            all.filter(are_solved).map(<[usize]>::to_vec).collect()
        })
    }

    /// Whether there are any among so many contacts.
    pub fn are_some(&self, contacts: usize) -> bool {
        !self.members(contacts).is_empty()
    }

    /// Replaces the `next` states of joints with a change by those that solve the problem of the joint alone, the forces
    /// of all other contacts held.
    ///
    /// ```text
    /// P_j = S_j(v_j - Q_jj P_j)    eq. (8.7)
    /// ```
    ///
    /// p are the forces of the `states` of all contacts, v = Q p + b is their motion, and S_j, `solve`, finds the answer of the
    /// contact law of the joint from its present states. The states stay those of single contacts where the joint has no answer, or one without a change.
    pub fn change(
        &self,
        scaled: &Scaled,
        states: &[ContactState],
        next: &mut List<ContactState>,
        ([p, v], solve): ([&[f64]; 2], SolveJoint),
    ) {
        for joint in self.members(scaled.contacts) {
            if joint.iter().all(|&i| states[i] == next[i]) {
                continue;
            }
            let before: Vec<ContactState> = joint.iter().map(|&i| states[i]).collect();
            let alone = scaled.alone(joint, [p, v]);
            if let Some(solved) = solve(&alone, &before)
                && solved.state != before
            {
                for (&i, state) in joint.iter().zip(solved.state) {
                    next[i] = state;
                }
            }
        }
    }
}
