//! The proximal point method, which finds states near those of the answer if contacts are nearly redundant: each step
//! solves a problem that holds the forces near those of the previous step. See docs/theory/complementarity.md, The hybrid.

use super::active_set::{Changes, Outcome, active_set};
use super::dense::{List, filled};
use super::joints::Joints;
use super::kept::KeptFactors;
use super::problems::{ContactState, Counters};
use super::scaled::Scaled;

/// Weight of the first step, relative to the diagonal of Q.
const FIRST_WEIGHT: f64 = 0.1;

/// Weight below which the states of a step are taken for those of the answer, relative to the diagonal of Q.
const LEAST_WEIGHT: f64 = 1e-6;

/// Factor of the weight after a step that ends; after a step whose states repeat, the weight is divided by this factor.
const DECREASE: f64 = 0.5;

/// Largest number of steps.
const STEPS: usize = 60;

/// The states after proximal steps from the given states and from zero forces; `None` if the weight does not fall below
/// [`LEAST_WEIGHT`].
///
/// A step is the active set from the states of the previous step. If Q is not positive definite, nearly redundant
/// contacts make the states repeat below some weight. Steps with a larger weight then move the forces on, until one of
/// these contacts opens.
pub(crate) fn proximal_states<'a>(
    scaled: &Scaled<'a>,
    mut states: List<'a, ContactState>,
    counters: &mut Counters,
) -> Option<List<'a, ContactState>> {
    let mut near = scaled.clone();
    let mut p = filled(scaled.arena, 0.0, scaled.size());
    let mut weight = FIRST_WEIGHT;
    let no_joints = Joints::none();
    for _ in 0..STEPS {
        near.set_near(scaled, weight, &p);
        let (from, kept) = (states.clone(), &mut KeptFactors::default());
        match active_set(&near, from, Changes::Alone(&no_joints), (kept, counters)) {
            Outcome::Converged(found, forces) => {
                (states, p) = (found, forces);
                weight *= DECREASE;
            }
            Outcome::Failed(_) => weight /= DECREASE,
        }
        if weight < LEAST_WEIGHT {
            return Some(states);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use bumpalo::Bump;
    use nalgebra::{DMatrix, DVector};

    use super::*;
    use crate::lcp::{FreeUnknowns, FrictionalLcp};

    /// The symmetric part of Qnn = [1, 1.2; 0.8, 1] is singular. With both contacts closed the forces are -2 and 2.5; in
    /// the answer only the second contact is closed.
    #[test]
    fn nearly_redundant_contacts_get_the_states_of_an_answer() {
        let mut q = DMatrix::identity(4, 4);
        for (i, j, entry) in [(0, 1, 1.2), (1, 0, 0.8)] {
            q[(i, j)] = entry;
        }
        let problem = FrictionalLcp {
            q,
            gap: DVector::from_column_slice(&[-1.0, -0.9]),
            slip: DVector::zeros(2),
            mu: DVector::zeros(2),
            free: FreeUnknowns::default(),
        };
        let arena = Bump::new();
        let scaled = Scaled::new(&problem, &arena).expect("finite");
        let open = filled(&arena, ContactState::Open, 2);
        let states = proximal_states(&scaled, open, &mut Counters::default()).expect("an end");
        let again = Changes::Alone(&Joints::none());
        let kept = (&mut KeptFactors::default(), &mut Counters::default());
        let answer = active_set(&scaled, states.clone(), again, kept);
        assert!(matches!(answer, Outcome::Converged(found, _) if found == states));
        assert_eq!(*states, [ContactState::Open, ContactState::SlipPlus]);
    }
}
