//! Landing return: energy lost by landing pairs in an increment is given back to the velocities at
//! its end. See docs/theory/impacts.md, Landing return.

use nalgebra::DMatrix;

use super::increment::{PairReturn, Solved};
use super::patterns::{
    FrictionLoad, ReturnLoad, RigidBodies, VelocityPattern, pattern, turning_bodies,
};
use super::results::{Cause, State};
use super::shares::{given, shares, signs};
use super::step::{ClosedConstraints, HeldMotions, StepProblem, Workspace, difference, dot, sum};
use crate::contact::tolerances::CLOSED_GAP;
use crate::contact::{ClosedPair, Constraint, ConstraintKey, Rows};

/// Gives back the energy that the landings of a converged increment of length `dt` from `start` have removed, if the
/// step asks for this return (`LANDING=RETURN`).
///
/// # Errors
/// Returns an error if a solve with K* fails.
pub(crate) fn return_landings(
    problem: &StepProblem,
    workspace: &mut Workspace,
    start: &State,
    dt: f64,
    solved: &mut Solved,
) -> Result<(), Cause> {
    if !problem.returns_landings() {
        return Ok(());
    }
    let turns = turning_bodies(problem);
    let landings: Vec<_> = (solved.contact.forces.acting())
        .filter(|(constraint, _)| !touches(problem, &turns, constraint))
        .filter_map(|(constraint, pair)| landing(problem, solved, dt, constraint, pair))
        .collect();
    let (pairs, loads): (Vec<_>, Vec<_>) = landings.into_iter().unzip();
    if !pairs.is_empty() {
        factorize_anew(problem, workspace, start, dt, solved)?;
    }
    let given = give_back(problem, workspace, dt, solved, &loads)?;
    let both = pairs.iter().zip(&loads);
    let shares = both.zip(given.y).zip(given.energies);
    let share = |(((pair, load), y), energy): (((&LandedPair, &ReturnLoad), f64), f64)| {
        pair.share(load, dt, y, energy)
    };
    solved.returned.pairs = shares.filter_map(share).collect();
    solved.returned.support_work = given.support_work;
    Ok(())
}

/// Whether a constraint acts on a body that contains a rigid body that turns; energy of its landings is not given back.
pub(super) fn touches(problem: &StepProblem, turns: &[bool], constraint: &Constraint) -> bool {
    let body_of = problem.parts.of_nodes();
    constraint.nodes().any(|node| turns[body_of[node]])
}

/// Part of the energy of a load below which the energy not yet given back is round-off.
const REST_ROUND_OFF: f64 = 1e-12;

/// A pair that lands.
struct LandedPair {
    key: ConstraintKey,
    /// Pt/Pn.
    ratio: f64,
    /// Length s of the normal row in the increment, eq. (3.31); the factor s makes the impulse zero if all of a force
    /// is taken back.
    stretch: f64,
    /// Rows Gn and Gt at the end, summed over the nodes of the contact's slave surface.
    rows: [[f64; 2]; 2],
}

impl LandedPair {
    /// Return of the pair for the share y of its load: the impulse (dt²/2) y along the normal, and an impulse along the
    /// friction if y takes a part of the contact force back.
    fn share(&self, load: &ReturnLoad, dt: f64, y: f64, energy: f64) -> Option<PairReturn> {
        let normal = dt * dt / 2.0 * y;
        let (tangential, friction) = match &load.friction {
            Some(friction) if y < 0.0 => (normal * self.ratio, -y * friction.work),
            _ => (0.0, 0.0),
        };
        let [n, t] = self.rows;
        (energy != 0.0).then(|| PairReturn {
            key: self.key,
            energy,
            friction,
            normal: self.stretch * normal,
            tangential,
            vector: [0, 1].map(|i| normal * n[i] + tangential * t[i]),
        })
    }
}

/// A pair that lands, with its load; `None` for a pair that was closed at the start.
///
/// The value D = -Pn (Bn d), eq. (6.5), is the energy that the force of the pair has removed. The load is Gn^T at the
/// end, whose forces have no moment in the end positions, and (Pt/Pn) Gt^T for friction.
fn landing(
    problem: &StepProblem,
    solved: &Solved,
    dt: f64,
    constraint: &Constraint,
    pair: &ClosedPair,
) -> Option<(LandedPair, ReturnLoad)> {
    let [pn, pt] = pair.force;
    let travel = -constraint.normal_motion(&solved.d);
    let energy = pn * travel;
    if travel <= CLOSED_GAP * constraint.scale || energy <= 0.0 {
        return None;
    }
    let u1 = &solved.end.u;
    let at_end = constraint.relinearized(&problem.configurations(u1, u1));
    let Rows { normal, tangential } = at_end.derivative_rows();
    let load = |row: &[f64], factor: f64| {
        let mut force = vec![0.0; u1.len()];
        let both = at_end.dofs.iter().zip(row);
        both.for_each(|(&dof, b)| force[dof] += factor * b);
        force
    };
    // (Pt/Pn) Gt^T, c = -dt Pt (Bt d)/(2 Pn), eq. (6.13)
    let ratio = pt / pn;
    let friction = (pt != 0.0).then(|| FrictionLoad {
        force: load(tangential, ratio),
        work: -ratio * constraint.tangential_motion(&solved.d) * dt / 2.0,
    });
    let landed = LandedPair {
        key: pair.key,
        ratio,
        stretch: constraint.stretch,
        rows: [normal, tangential].map(|row| {
            let own = row[..at_end.slave_dofs].chunks(2);
            let sum = own.fold([0.0; 2], |sum, b| [sum[0] + b[0], sum[1] + b[1]]);
            // on a corner of the master the force acts in the opposite direction
            sum.map(|b| if at_end.is_of_master() { -b } else { b })
        }),
    };
    let force = load(normal, 1.0);
    Some((
        landed,
        ReturnLoad {
            force,
            friction,
            energy,
            // (6.11)
            most: 2.0 * pn / dt,
            pulls: true,
        },
    ))
}

/// Factorises K* of the converged increment from `start`, so that results do not depend on the age of the factors.
///
/// # Errors
/// Returns [`Cause::Indefinite`], or the errors of the solver.
pub(super) fn factorize_anew(
    problem: &StepProblem,
    workspace: &mut Workspace,
    start: &State,
    dt: f64,
    solved: &Solved,
) -> Result<(), Cause> {
    let u1 = sum(&start.u, &solved.d);
    let motion = (problem.integration).motion(start, &u1, solved.equilibrium.place());
    let closed = ClosedConstraints {
        acting: solved.contact.forces.acting().collect(),
        at: problem.configurations(&start.u, &u1),
        pairs_stiffen: false,
        followers: &[],
        out_of_balance: &[],
        held: &HeldMotions::default(),
    };
    (workspace.stiffness).write_rows(problem, [&start.u, &solved.d]);
    let factorized = workspace.factorize(problem, dt, motion, &closed);
    factorized.map_err(|error| problem.unsolvable(error))
}

/// Energy given back along the patterns of some loads.
#[derive(Default)]
pub(super) struct GivenBack {
    /// Share y of each pattern in the velocities.
    pub y: Vec<f64>,
    /// Energy that each share has given back.
    pub energies: Vec<f64>,
    /// Work of the supports, which keep their velocity (energy).
    pub support_work: f64,
}

/// Gives back the energy of every load as kinetic energy along its pattern, in the frame of the supports.
///
/// The velocities V1 become V1 + sum y_j w_j, eq. (6.8), with the shares y_j and patterns w_j.
///
/// # Errors
/// Returns an error if a solve with K* fails.
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
    let v_s = bodies.support_velocity(problem, v);
    let relative = difference(v, &v_s);
    // b_j = w_j.M V1 - s_j, s_j = V_s.M w_j - (dt²/2) V_s.f_j, eq. (6.10)
    let motion = |pattern: &VelocityPattern, force: &[f64]| {
        let given = dt * dt / 2.0 * dot(&v_s, force);
        let b = dot(&relative, &pattern.momentum) + given;
        (b, dot(&v_s, &pattern.momentum) - given)
    };
    let mut respond = |force: &[f64]| pattern(problem, workspace, dt, &bodies, force);
    let (mut patterns, mut b, mut s) = (Vec::new(), Vec::new(), Vec::new());
    for load in loads {
        let of_normal = respond(&load.force)?;
        let (b_j, s_j) = motion(&of_normal, &load.force);
        patterns.push(of_normal);
        b.push(b_j);
        s.push(s_j);
    }
    // A_jk = w_j.M w_k
    let products = |patterns: &[VelocityPattern]| {
        let n = patterns.len();
        DMatrix::from_fn(n, n, |j, k| dot(&patterns[j].w, &patterns[k].momentum))
    };
    let energies: Vec<f64> = loads.iter().map(|load| load.energy).collect();
    let signs = signs(&products(&patterns), &b, &energies);
    // a return that takes a force back also takes back its friction, with the work of the friction
    for (j, load) in loads.iter().enumerate() {
        if let Some(friction) = load.friction.as_ref().filter(|_| signs[j] < 0.0) {
            let of_friction = respond(&friction.force)?;
            let (b_j, s_j) = motion(&of_friction, &friction.force);
            patterns[j].add(&of_friction);
            b[j] += b_j + friction.work;
            s[j] += s_j;
        }
    }
    let a = products(&patterns);
    let most = |(load, sign): (&ReturnLoad, &f64)| match load.pulls || *sign > 0.0 {
        true => load.most,
        false => 0.0,
    };
    let most: Vec<f64> = loads.iter().zip(&signs).map(most).collect();
    let y = shares(&a, &b, &energies, &signs, &most);
    for (VelocityPattern { w, .. }, y) in patterns.iter().zip(&y) {
        v.iter_mut().zip(w).for_each(|(v, w)| *v += y * w);
    }
    let mut given = given(&a, &b, &y);
    give_rests(problem, &bodies, v, loads, &mut given);
    Ok(GivenBack {
        support_work: dot(&s, &y),
        energies: given,
        y,
    })
}

/// Gives the rests of the energies of loads, which are not yet in `given`, to the vibration of their free bodies, and
/// adds them to `given`:
///
/// ```text
/// V1 <- V1 + z V',  sum M V' = 0,  sum r x M V' = 0
/// (z + z²/2) V'.M V' = sum (D_j - G_j),   eq. (6.12)
/// ```
///
/// If the sum of these rests is larger than the energy of the vibration, the rests are lost.
fn give_rests(
    problem: &StepProblem,
    bodies: &RigidBodies,
    v: &mut [f64],
    loads: &[ReturnLoad],
    given: &mut [f64],
) {
    let body_of = problem.parts.of_nodes();
    let rests: Vec<f64> = loads
        .iter()
        .zip(&*given)
        .map(|(load, g)| load.energy - g)
        .collect();
    let has_rest = |j: &usize| rests[*j] > REST_ROUND_OFF * loads[*j].energy;
    let mut vibrates = vec![false; body_of.iter().max().map_or(0, |last| last + 1)];
    for j in (0..loads.len()).filter(has_rest) {
        let loaded = loads[j]
            .force
            .iter()
            .enumerate()
            .filter(|(_, f)| **f != 0.0);
        loaded.for_each(|(dof, _)| vibrates[body_of[dof / 2]] = true);
    }
    let mut vibration = bodies.vibration(problem, v);
    let others = vibration.iter_mut().enumerate();
    others
        .filter(|(dof, _)| !vibrates[body_of[dof / 2]])
        .for_each(|(_, v)| *v = 0.0);
    let energy = dot(&vibration, &problem.mass.times(&vibration)) / 2.0;
    let rest: f64 = rests.iter().sum();
    if energy > 0.0 && rest <= energy {
        let z = (1.0 + rest / energy).sqrt() - 1.0;
        v.iter_mut().zip(&vibration).for_each(|(v, w)| *v += z * w);
        given
            .iter_mut()
            .zip(rests)
            .for_each(|(given, rest)| *given += rest);
    }
}
