//! States near those of the answer of a problem whose contacts are nearly one: the answer of the proximal point method,
//! which holds every force near that of the step before. See docs/theory/complementarity.md, The hybrid.

use super::dense::{List, filled};
use super::hybrid::{Changes, Outcome, active_set};
use super::joints::Joints;
use super::kept::KeptFactors;
use super::problems::{ContactState, Counters};
use super::scaled::Scaled;

/// Weight of the first step, a part of the diagonal of Q.
const FIRST_WEIGHT: f64 = 0.1;

/// Weight below which the states of a step are as good as those of the answer.
const LEAST_WEIGHT: f64 = 1e-6;

/// Ratio of the weight to that of the step before; its inverse after a step whose states repeat.
const DECREASE: f64 = 0.5;

/// Steps at most.
const STEPS: usize = 60;

/// The states after proximal steps from some states and no forces; none where these come to no end.
///
/// A step is the active set from the states of the step before. Where Q is not positive definite, contacts that are
/// nearly one make its states repeat below some weight; steps with larger ones then move the forces on, until one of
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

    /// Qnn = [1, 1.2; 0.8, 1] is not positive definite: with both contacts closed the forces are -2 and 2.5, the answer
    /// has the second one alone.
    #[test]
    fn contacts_that_are_nearly_one_get_the_states_of_an_answer() {
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
