//! Return of the energy that releases remove from nodes without mass, to the velocities at the end.
//! See docs/theory/impacts.md, Releases.

use super::increment::{PairReturn, Release, Solved};
use super::landing::{factorize_anew, give_back, touches};
use super::patterns::{ReturnLoad, turning_bodies};
use super::results::{Cause, State};
use super::step::{StepProblem, Workspace};
use crate::contact::Constraint;

/// Enters the release of pairs at the end of an increment of length `dt` from `start`. If the step asks for returns
/// (`LANDING=RETURN`), the lost energy is given back along the pattern of the earlier forces of the opened pairs, in
/// proportion to their normal forces.
///
/// # Errors
/// Returns an error if a solve with K* fails.
pub(crate) fn return_release(
    problem: &StepProblem,
    workspace: &mut Workspace,
    start: &State,
    dt: f64,
    solved: &mut Solved,
    release: Release,
) -> Result<(), Cause> {
    let turns = turning_bodies(problem);
    let gives = (release.opened.iter()).all(|(pair, _)| !touches(problem, &turns, pair));
    if problem.returns_landings() && release.loss > 0.0 && gives {
        if solved.returned.pairs.is_empty() {
            factorize_anew(problem, workspace, start, dt, solved)?;
        }
        let mut force = vec![0.0; solved.d.len()];
        for (constraint, pair) in &release.opened {
            constraint.add_force(*pair, &mut force);
        }
        let energy = release.loss;
        let given = give_back(
            problem,
            workspace,
            dt,
            solved,
            &[ReturnLoad {
                force,
                friction: None,
                energy,
                most: 2.0 / dt,
                pulls: false,
            }],
        )?;
        solved.returned.support_work += given.support_work;
        let impulse = dt * dt / 2.0 * given.y[0];
        (solved.returned.pairs).extend(parts(&release, impulse, given.energies[0]));
    }
    solved.returned.release = release;
    Ok(())
}

/// Parts of the opened pairs in a return of `energy`, whose load is `factor` times the earlier
/// forces of the pairs.
fn parts(release: &Release, factor: f64, energy: f64) -> Vec<PairReturn> {
    if energy == 0.0 {
        return Vec::new();
    }
    let whole: f64 = release.opened.iter().map(|(_, force)| force[0]).sum();
    let part = |(constraint, force): &(Constraint, [f64; 2])| {
        let mut vector = [0.0; 2];
        for (_, [x, y]) in constraint.forces_on_slave_surface(*force) {
            vector = [vector[0] + factor * x, vector[1] + factor * y];
        }
        let [normal, tangential] = constraint.normal_and_tangential(*force);
        PairReturn {
            key: constraint.key,
            energy: energy * force[0] / whole,
            friction: 0.0,
            normal: factor * normal,
            tangential: factor * tangential,
            vector,
        }
    };
    release.opened.iter().map(part).collect()
}
