//! Energy check of contact in the energy-momentum scheme: positive normal work at corners that
//! turn concave under a sliding node. Section 7 of docs/theory.md.

use super::energy::{CONTACT_WORK_ROUND_OFF, Ledger};
use crate::contact::Constraint;
use crate::contact::tolerances::CLOSED_GAP;
use crate::dynamics::increment::Solved;
use crate::dynamics::results::{Cause, State};
use crate::dynamics::step::StepProblem;

/// Checks that contact puts no energy in, in a converged increment from `start`, that counts beside
/// the largest energy that the bodies in contact have had so far.
///
/// # Errors
/// [`Cause::GainedEnergy`]: in halves of the increment a node passes a corner before or after the
/// corner turns concave.
pub(crate) fn check_energy_gain(
    problem: &StepProblem,
    start: &State,
    ledger: &Ledger,
    solved: &Solved,
) -> Result<(), Cause> {
    let part = gain(problem, start, ledger, solved);
    if part <= CONTACT_WORK_ROUND_OFF {
        return Ok(());
    }
    Err(Cause::GainedEnergy { part })
}

/// Energy that contact puts in because nodes slide on to segments that they were behind: the sum over
/// the pairs, each relative to the largest energy of its bodies.
///
/// With energy-momentum rows a pair does the work Pn (g1 - g0). It is positive where a node slides over
/// a convex corner on to a segment with g0 < 0, and that segment holds it because the corner turns
/// concave in the same increment. Nodes that the mesh places inside are left out.
fn gain(problem: &StepProblem, start: &State, ledger: &Ledger, solved: &Solved) -> f64 {
    if !problem.weights.energy_momentum {
        return 0.0;
    }
    let Solved { d, forces, .. } = solved;
    let works = forces.acting().map(|(constraint, pair)| {
        let [slave, a, b, _] = constraint.source.nodes;
        let p = problem.place(&start.u, [slave, a, b]);
        let was_beyond = !(0.0..=1.0).contains(&p.xi) && p.gap < -CLOSED_GAP * p.length;
        // Pn (Bn d) of a pair that was behind, beyond the ends, eq. (7.7)
        let work = if was_beyond {
            pair.force[0] * constraint.normal_motion(d)
        } else {
            0.0
        };
        (constraint, work)
    });
    let largest = |c: &Constraint| problem.parts.most(&ledger.largest, c.nodes());
    let parts = works.filter(|&(_, work)| work > 0.0);
    parts
        .map(|(constraint, work)| work / largest(constraint))
        .sum()
}
