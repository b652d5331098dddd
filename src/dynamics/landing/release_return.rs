//! What releases take of nodes without mass, given back to the velocities of the end. Section 6 of
//! docs/theory.md, Releases.

use super::landing_return::{GivenBack, factorize_anew, give_back};
use super::pattern::ReturnLoad;
use crate::contact::Constraint;
use crate::dynamics::increment::{PairReturn, Release, Returned, Solved};
use crate::dynamics::results::{Cause, State};
use crate::dynamics::step::{StepProblem, Workspace};
use crate::model::LandingRule;

/// Enters the release at the end of an increment of length `dt` from `start` and, where the step asks for it
/// (`LANDING=RETURN`), gives back what it has taken: along the pattern of the forces that the opened pairs
/// carried before, each by its normal force.
///
/// # Errors
/// Solves with K* that fail.
pub(crate) fn return_release(
    problem: &StepProblem,
    workspace: &mut Workspace,
    (start, dt): (&State, f64),
    solved: &mut Solved,
    (release, returned): (Release, &mut Returned),
) -> Result<(), Cause> {
    if problem.settings.landing == LandingRule::Return && release.loss > 0.0 {
        if returned.pairs.is_empty() {
            factorize_anew(problem, workspace, (start, dt), solved)?;
        }
        let mut force = vec![0.0; solved.d.len()];
        for (constraint, pair) in &release.opened {
            constraint.add_force(*pair, &mut force);
        }
        let energy = release.loss;
        let GivenBack { y, support_work } = give_back(
            problem,
            workspace,
            dt,
            solved,
            &[ReturnLoad {
                force,
                friction: None,
                energy,
                least: 0.0,
            }],
        )?;
        returned.support_work += support_work;
        returned.pairs.extend(parts(&release, dt * dt / 2.0 * y[0]));
    }
    returned.release = release;
    Ok(())
}

/// What every pair has of a return whose load is `factor` times the forces before.
fn parts(release: &Release, factor: f64) -> Vec<PairReturn> {
    if factor == 0.0 {
        return Vec::new();
    }
    let whole: f64 = release.opened.iter().map(|(_, force)| force[0]).sum();
    let part = |(constraint, force): &(Constraint, [f64; 2])| {
        let mut vector = [0.0; 2];
        for (_, [x, y]) in constraint.slave_forces(*force) {
            vector = [vector[0] + factor * x, vector[1] + factor * y];
        }
        PairReturn {
            key: constraint.key,
            energy: release.loss * force[0] / whole,
            friction: 0.0,
            normal: factor * force[0],
            tangential: factor * force[1],
            vector,
        }
    };
    release.opened.iter().map(part).collect()
}
