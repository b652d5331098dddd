//! Energy checks of a converged increment: positive normal work of contact in the energy-momentum scheme, at
//! corners that turn concave under a sliding node (docs/theory/contact.md, Energy-momentum contact), and the balance of the ledger
//! (docs/theory/impacts.md, Ledger).

use super::energy::{CONTACT_WORK_ROUND_OFF, Ledger};
use crate::contact::tolerances::CLOSED_GAP;
use crate::contact::{ClosedPair, Constraint};
use crate::dynamics::increment::{PartNoise, Solved};
use crate::dynamics::results::{Cause, Energy, State};
use crate::dynamics::step::{StepProblem, Workspace};
use crate::linear::larger;

/// Energy balance, relative to the largest energy, above which the results of a run are useless and the run stops.
const UNBALANCED: f64 = 1e-3;

/// Checks that contact adds no energy in a converged increment from `start` that is significant
/// against the largest energy of the bodies in contact up to its end.
///
/// # Errors
/// Returns [`Cause::GainedEnergy`]: if the increment is halved, a node passes the corner before or
/// after the corner turns concave.
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
    let of_pair = |(constraint, pair): (&Constraint, &ClosedPair)| {
        let work = pair.force[0] * (constraint.normal_motion(&solved.d) - constraint.shrinkage);
        (work, constraint.pair().nodes)
    };
    let acting = solved.contact.forces.acting().map(of_pair);
    let worst = acting.max_by(|p, q| p.0.total_cmp(&q.0));
    let pair = worst.map(|(_, nodes)| nodes);
    Err(Cause::GainedEnergy { part, pair })
}

/// Checks that the energy balance is negligible against the largest energy so far.
///
/// Round-off of positions causes forces n that cannot be balanced. No balance is demanded of a motion with so little
/// energy that the round-off forces n exceed a thousandth of the forces of the motion:
///
/// ```text
/// |balance| <= 1e-3 E,   or   E <= max n²/(1e-3² (K_ii + (2/dt²) M_ii))      eq. (9.13)
/// ```
///
/// Here E is the largest energy so far; the symbols n, K_ii and M_ii have the meaning of eq. (4.10). In a static step
/// no balance is demanded if the work of the forces n exceeds a thousandth of E, since the bodies then move almost as
/// rigid bodies.
///
/// # Errors
/// [`Cause::Unbalanced`].
pub(crate) fn check_balance(
    problem: &StepProblem,
    workspace: &Workspace,
    ledger: &Ledger,
    solved: &Solved,
) -> Result<(), Cause> {
    let Energy {
        scale: energy,
        round_off,
        ..
    } = ledger.energy;
    let balance = ledger.energy.balance.abs();
    if balance <= UNBALANCED * energy {
        return Ok(());
    }
    let noise = solved.noise(problem, workspace);
    // max n²/(1e-3² (K_ii + (2/dt²) M_ii)), eq. (9.13)
    let of_part = |noise: &PartNoise| match noise.force {
        0.0 => 0.0,
        force => (force / UNBALANCED).powi(2) / noise.stiffness,
    };
    if energy <= noise.iter().map(of_part).fold(0.0, larger) {
        return Ok(());
    }
    if !problem.integration.has_rates && round_off > UNBALANCED * energy {
        return Ok(());
    }
    let is_round_off = |noise: &PartNoise| noise.force * noise.travel > UNBALANCED * energy;
    let is_round_off = noise.iter().any(is_round_off);
    Err(Cause::Unbalanced {
        part: balance / energy,
        is_round_off,
    })
}

/// Energy that contact adds because nodes slide on to segments behind which they were: the sum over the pairs, where
/// the work of a pair is relative to the largest energy of its bodies.
///
/// With energy-momentum rows a pair does the work Pn (g1 - g0), for gaps g0 at the start and g1 at the end. The work Pn
/// (g1 - g0) of a pair is positive if its node slides over a convex corner on to a segment with the gap g0 < 0 at the
/// start, and the segment stops the node because the corner turns concave in the same increment. Nodes that the mesh
/// places inside a body do not count.
fn gain(problem: &StepProblem, start: &State, ledger: &Ledger, solved: &Solved) -> f64 {
    if !problem.integration.energy_momentum {
        return 0.0;
    }
    let works = (solved.contact.forces.acting()).map(|(constraint, pair)| {
        let p = problem.positions(&start.u).place(constraint.pair().nodes);
        let was_beyond = match constraint.lift_at_start() {
            None => constraint.start_gap < -CLOSED_GAP * constraint.scale,
            Some(lift) => !(0.0..=1.0).contains(&p.xi) && lift.of(p).gap < -CLOSED_GAP * p.length,
        };
        // Pn (Bn d) of a pair whose node was behind the line of the segment, beyond its ends, eq.
        // (7.7)
        let work = if was_beyond {
            pair.force[0] * (constraint.normal_motion(&solved.d) - constraint.shrinkage)
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
