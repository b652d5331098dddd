//! Joints: contacts between the same two bodies, which change their states together. See
//! docs/theory/complementarity.md, The hybrid.

use std::cell::OnceCell;

use super::dense::List;
use super::problems::{ContactState, FrictionalLcp, FrictionalSolution};
use super::scaled::Scaled;

/// Largest number of contacts of a joint: larger joints cost as much time as they save.
const MOST: usize = 32;

/// Function that solves the problem of a joint from some states; `None` if it finds no answer.
pub(crate) type SolveJoint = fn(&FrictionalLcp, &[ContactState]) -> Option<FrictionalSolution>;

/// The joints of a problem: a joint has several contacts between the same two bodies, whose conditions depend strongly
/// on each other. The state of one contact of a joint depends mainly on the states of the others.
pub(crate) struct Joints<'k> {
    /// Function that returns the number of the joint of every contact.
    numbers: &'k dyn Fn() -> Vec<usize>,
    /// The contacts of every joint of several contacts, in increasing order; found when they are first needed.
    members: OnceCell<Vec<Vec<usize>>>,
}

impl<'k> Joints<'k> {
    /// No joints: every contact stands by itself.
    pub fn none() -> Self {
        Joints::of(&Vec::new)
    }

    /// Joints of contacts with equal `numbers`.
    pub const fn of(numbers: &'k dyn Fn() -> Vec<usize>) -> Self {
        Joints {
            numbers,
            members: OnceCell::new(),
        }
    }

    /// The joints of more than one contact. A joint of all contacts is left out, because its problem is the whole
    /// problem.
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

    /// Whether there are joints among `contacts` contacts.
    pub fn are_some(&self, contacts: usize) -> bool {
        !self.members(contacts).is_empty()
    }

    /// Replaces the `next` states of every joint with a changed state by states that solve the problem of this joint
    /// alone, with the forces of all other contacts held.
    ///
    /// ```text
    /// P_j = S_j(v_j - Q_jj P_j)    eq. (8.7)
    /// ```
    ///
    /// Here p are the forces of the `states` of all contacts, v = Q p + b is the motion, and S_j (`solve`) finds the
    /// answer of the contact law of the joint from its present states. If the joint has no answer, or an answer without
    /// a change, the states of the single contacts stay.
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
