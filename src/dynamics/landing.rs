//! What landing pairs lose in an increment, given back to the velocities of its end. Section 6 of
//! docs/theory.md, Landing return.
//!
//! What releases take of nodes without mass, given back to the velocities of the end. Section 6 of
//! docs/theory.md, Releases.

use nalgebra::DMatrix;

use super::increment::{PairReturn, Release, Solved};
use super::patterns::{FrictionLoad, Pattern, ReturnLoad, RigidBodies, pattern, shares, signs};
use super::results::{Cause, State};
use super::step::{ClosedConstraints, StepProblem, Workspace, difference, dot, sum};
use crate::contact::tolerances::CLOSED_GAP;
use crate::contact::{ClosedPair, Constraint, ConstraintKey, Rows};

/// Part of the force of a landing by which a return may pull, as round-off of a force that is taken back as a whole.
const ROUND_OFF: f64 = 1e-9;

/// Gives back what the landings of a converged increment of length `dt` from `start` have taken, where the step
/// asks for it (`LANDING=RETURN`).
///
/// # Errors
/// Solves with K* that fail.
pub(crate) fn return_landings(
    problem: &StepProblem,
    workspace: &mut Workspace,
    (start, dt): (&State, f64),
    solved: &mut Solved,
) -> Result<(), Cause> {
    if !problem.returns_landings() {
        return Ok(());
    }
    let landings: Vec<_> = (solved.contact.forces.acting())
        .filter_map(|(constraint, pair)| landing(problem, solved, dt, constraint, pair))
        .collect();
    let (pairs, loads): (Vec<_>, Vec<_>) = landings.into_iter().unzip();
    if !pairs.is_empty() {
        factorize_anew(problem, workspace, (start, dt), solved)?;
    }
    let GivenBack { y, support_work } = give_back(problem, workspace, dt, solved, &loads)?;
    let both = pairs.into_iter().zip(loads).zip(y);
    let share = |((pair, load), y): ((LandedPair, ReturnLoad), f64)| pair.share(&load, dt, y);
    solved.returned.pairs = both.filter_map(share).collect();
    solved.returned.support_work = support_work;
    Ok(())
}

/// A pair that lands.
struct LandedPair {
    key: ConstraintKey,
    /// Pt/Pn.
    ratio: f64,
    /// Rows Gn and Gt of the end at the slave node.
    rows: [[f64; 2]; 2],
}

impl LandedPair {
    /// What it is given by the share y of its load: the impulse (dt²/2) y along the normal, and along its
    /// friction where y takes a part of its force back.
    fn share(&self, load: &ReturnLoad, dt: f64, y: f64) -> Option<PairReturn> {
        let normal = dt * dt / 2.0 * y;
        let (tangential, friction) = match &load.friction {
            Some(friction) if y < 0.0 => (normal * self.ratio, -y * friction.work),
            _ => (0.0, 0.0),
        };
        let [n, t] = self.rows;
        (y != 0.0).then(|| PairReturn {
            key: self.key,
            energy: load.energy,
            friction,
            normal,
            tangential,
            vector: [0, 1].map(|i| normal * n[i] + tangential * t[i]),
        })
    }
}

/// A pair that lands, with its load; none of one that was closed at the start.
///
/// D = -Pn (Bn d), eq. (6.5), is what its force has taken; the load is Gn^T of the end, whose moments
/// about the positions of the end cancel, and (Pt/Pn) Gt^T for its friction.
fn landing(
    problem: &StepProblem,
    solved: &Solved,
    dt: f64,
    constraint: &Constraint,
    pair: &ClosedPair,
) -> Option<(LandedPair, ReturnLoad)> {
    let [pn, pt] = pair.force;
    let way = -constraint.normal_motion(&solved.d);
    let energy = pn * way;
    if way <= CLOSED_GAP * constraint.scale || energy <= 0.0 {
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
    // (Pt/Pn) Gt^T, c = -dt Pt (Bt d)/(2 Pn), eq. (6.11)
    let ratio = pt / pn;
    let friction = (pt != 0.0).then(|| FrictionLoad {
        force: load(tangential, ratio),
        work: -ratio * constraint.tangential_motion(&solved.d) * dt / 2.0,
    });
    let landed = LandedPair {
        key: pair.key,
        ratio,
        rows: [normal, tangential].map(|row| [row[0], row[1]]),
    };
    let force = load(normal, 1.0);
    Some((
        landed,
        ReturnLoad {
            force,
            friction,
            energy,
            least: -2.0 * pn / dt * (1.0 + ROUND_OFF),
        },
    ))
}

/// Factorises K* of the converged increment from `start`, so that patterns do not depend on the age of the factors.
///
/// # Errors
/// [`Cause::Indefinite`], or those of the solver.
pub(super) fn factorize_anew(
    problem: &StepProblem,
    workspace: &mut Workspace,
    (start, dt): (&State, f64),
    solved: &Solved,
) -> Result<(), Cause> {
    let u1 = sum(&start.u, &solved.d);
    let motion = (problem.integration).motion(start, &u1, &solved.equilibrium.u_theta);
    let closed = ClosedConstraints {
        acting: solved.contact.forces.acting().collect(),
        at: problem.configurations(&start.u, &u1),
    };
    let factorized = workspace.factorize(problem, dt, motion, &closed);
    factorized.map_err(|error| problem.unsolvable(error))
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
    let v_s = bodies.support_velocity(problem, v);
    let relative = difference(v, &v_s);
    // b_j = w_j.M V1 - s_j, s_j = V_s.M w_j - (dt²/2) V_s.f_j, eq. (6.10)
    let motion = |pattern: &Pattern, force: &[f64]| {
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
    let products = |patterns: &[Pattern]| {
        let n = patterns.len();
        DMatrix::from_fn(n, n, |j, k| dot(&patterns[j].w, &patterns[k].momentum))
    };
    let energies: Vec<f64> = loads.iter().map(|load| load.energy).collect();
    let mut signs = signs(&products(&patterns), &b, &energies);
    // what takes a force back takes its friction back, with its work
    let mut alone = Vec::new();
    for (j, load) in loads.iter().enumerate() {
        let friction = load.friction.as_ref().filter(|_| signs[j] < 0.0);
        alone.push(friction.map(|_| (patterns[j].clone(), b[j], s[j])));
        if let Some(friction) = friction {
            let of_friction = respond(&friction.force)?;
            let (b_j, s_j) = motion(&of_friction, &friction.force);
            patterns[j].add(&of_friction);
            b[j] += b_j + friction.work;
            s[j] += s_j;
        }
    }
    // a pair that would have to pull is sent off along its normal instead
    let y = loop {
        let y = shares(&products(&patterns), &b, &energies, &signs);
        let pulls = |&j: &usize| y[j] < loads[j].least;
        let pulling: Vec<usize> = (0..y.len()).filter(pulls).collect();
        if pulling.is_empty() {
            break y;
        }
        for j in pulling {
            signs[j] = 1.0;
            if let Some((pattern, b_j, s_j)) = alone[j].take() {
                (patterns[j], b[j], s[j]) = (pattern, b_j, s_j);
            }
        }
    };
    for (Pattern { w, .. }, y) in patterns.iter().zip(&y) {
        v.iter_mut().zip(w).for_each(|(v, w)| *v += y * w);
    }
    Ok(GivenBack {
        support_work: dot(&s, &y),
        y,
    })
}

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
    release: Release,
) -> Result<(), Cause> {
    if problem.returns_landings() && release.loss > 0.0 {
        if solved.returned.pairs.is_empty() {
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
        solved.returned.support_work += support_work;
        (solved.returned.pairs).extend(parts(&release, dt * dt / 2.0 * y[0]));
    }
    solved.returned.release = release;
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
