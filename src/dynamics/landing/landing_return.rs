//! What landing pairs lose in an increment, given back to the velocities of its end. Section 6 of
//! docs/theory.md, Landing return.

use nalgebra::DMatrix;

use super::pattern::{Pattern, ReturnLoad, RigidBodies, patterns};
use super::shares::shares;
use crate::contact::tolerances::CLOSED_GAP;
use crate::contact::{ClosedPair, Constraint};
use crate::dynamics::increment::{PairReturn, Returned, Solved};
use crate::dynamics::results::Cause;
use crate::dynamics::step::{StepProblem, Workspace, difference, dot};
use crate::model::LandingRule;

/// Gives back what the landings of a converged increment of length `dt` have taken, where the step
/// asks for it (`LANDING=RETURN`).
///
/// # Errors
/// Solves with K* that fail.
pub(crate) fn return_landings(
    problem: &StepProblem,
    workspace: &mut Workspace,
    dt: f64,
    solved: &mut Solved,
) -> Result<Returned, Cause> {
    if problem.settings.landing == LandingRule::Plastic {
        return Ok(Returned::default());
    }
    let landings: Vec<_> = (solved.forces.acting())
        .filter_map(|(constraint, pair)| landing(problem, solved, constraint, pair))
        .collect();
    let (pairs, loads): (Vec<_>, Vec<_>) = landings.into_iter().unzip();
    let GivenBack { y, support_work } = give_back(problem, workspace, dt, solved, &loads)?;
    let returned = pairs.into_iter().zip(y).filter(|&(_, y)| y != 0.0);
    let times = |(pair, y): (PairReturn, f64)| {
        let factor = dt * dt / 2.0 * y;
        PairReturn {
            normal: factor * pair.normal,
            vector: pair.vector.map(|v| factor * v),
            ..pair
        }
    };
    Ok(Returned {
        pairs: returned.map(times).collect(),
        support_work,
        ..Returned::default()
    })
}

/// A pair that lands, with its load and a unit impulse; none of one that was closed at the start.
///
/// D = -Pn (Bn d), eq. (6.5), is what its force has taken; the load is Gn^T of the end, whose moments
/// about the positions of the end cancel.
fn landing(
    problem: &StepProblem,
    solved: &Solved,
    constraint: &Constraint,
    pair: &ClosedPair,
) -> Option<(PairReturn, ReturnLoad)> {
    let way = -constraint.normal_motion(&solved.d);
    let energy = pair.force[0] * way;
    if way <= CLOSED_GAP * constraint.scale || energy <= 0.0 {
        return None;
    }
    let u1 = &solved.end.u;
    let at_end = constraint.relinearized(&problem.configurations(u1, u1));
    let normal = &at_end.derivative_rows().normal;
    let mut force = vec![0.0; u1.len()];
    let both = at_end.dofs.iter().zip(normal);
    both.for_each(|(&dof, n)| force[dof] += n);
    let returned = PairReturn {
        key: pair.key,
        energy,
        normal: 1.0,
        vector: [normal[0], normal[1]],
    };
    Some((returned, ReturnLoad { force, energy }))
}

/// What was given back along the patterns of some loads.
#[derive(Default)]
pub(super) struct GivenBack {
    /// Share of every pattern.
    pub y: Vec<f64>,
    /// Work of the supports, which hold their velocity (energy).
    pub support_work: f64,
}

/// Gives back the energy of every load as kinetic energy along its pattern, in the frame of the supports.
///
/// V1 <- V1 + sum y_j w_j, eq. (6.8)
///
/// # Errors
/// Solves with K* that fail.
pub(super) fn give_back(
    problem: &StepProblem,
    workspace: &mut Workspace,
    dt: f64,
    solved: &mut Solved,
    loads: &[ReturnLoad],
) -> Result<GivenBack, Cause> {
    if loads.is_empty() {
        return Ok(GivenBack::default());
    }
    let (u, v) = (&solved.end.u, &mut solved.end.v);
    let bodies = RigidBodies::new(problem, u);
    let patterns = patterns(problem, workspace, dt, &bodies, loads)?;
    let n = patterns.len();
    // A_jk = w_j.M w_k, b_j = w_j.M V1 less the part -s_j of the supports, eq. (6.9)
    let a = DMatrix::from_fn(n, n, |j, k| dot(&patterns[j].w, &patterns[k].momentum));
    let v_s = bodies.support_velocity(problem, v);
    let relative = difference(v, &v_s);
    // s_j = V_s.M w_j - (dt²/2) V_s.f_j, eq. (6.10)
    let both = patterns.iter().zip(loads);
    let s: Vec<f64> = (both.clone())
        .map(|(pattern, load)| {
            dot(&v_s, &pattern.momentum) - dt * dt / 2.0 * dot(&v_s, &load.force)
        })
        .collect();
    let b: Vec<f64> = both
        .map(|(pattern, load)| {
            dot(&relative, &pattern.momentum) + dt * dt / 2.0 * dot(&v_s, &load.force)
        })
        .collect();
    let energies: Vec<f64> = loads.iter().map(|load| load.energy).collect();
    let y = shares(&a, &b, &energies);
    for (Pattern { w, .. }, y) in patterns.iter().zip(&y) {
        v.iter_mut().zip(w).for_each(|(v, w)| *v += y * w);
    }
    Ok(GivenBack {
        support_work: dot(&s, &y),
        y,
    })
}
