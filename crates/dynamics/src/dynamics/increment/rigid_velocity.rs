//! Velocities of bodies that turn: the velocities of their nodes at the end of an increment, and the velocities from
//! which impulses start at the beginning of the increment. See docs/theory/bodies.md, Rigid bodies that turn.

use std::borrow::Cow;

use crate::dynamics::results::{Cause, State};
use crate::dynamics::step::{StepProblem, Workspace, difference, sum};

/// Sets the velocities of the nodes of bodies that turn to V1 = V0+ + dt A, eq. (11.4), with their accelerations A.
/// Nodes without mass of elements get the velocity of their body at the displacements `u`.
pub(super) fn carry_nodes(
    problem: &StepProblem,
    (v0p, dt): (&[f64], f64),
    (u, a): (&[f64], &[f64]),
    v: &mut [f64],
) {
    for [dof, ..] in problem.unknowns.turning.followers() {
        v[dof] = v0p[dof] + dt * a[dof];
    }
    problem.unknowns.move_bodies(u, v);
}

/// The velocity V from which impulses of contact start in place of V0 is a motion of the model:
///
/// ```text
/// V = Vr + T_0 (T_0^T M T_0)^-1 T_0^T M (V0 - Vr)      eq. (11.5)
/// ```
///
/// Here Vr is any motion of the model with the prescribed values, and T_0 holds the rows (11.3) at the start. The
/// difference V0 - V does no work with impulses, (V0 - V).M V = 0, so impulses add no energy.
pub(super) fn agreeing<'a>(
    problem: &StepProblem,
    workspace: &mut Workspace,
    start: &'a State,
) -> Result<Cow<'a, [f64]>, Cause> {
    let (turning, hinges) = (&problem.unknowns.turning, &problem.hinges);
    if !turning.carry_elements() && hinges.are_none() {
        return Ok(Cow::Borrowed(&start.v));
    }
    let mut mass = workspace.m();
    if !mass.is_factorized() {
        mass.factorize()?;
    }
    let mut motion = start.v.clone();
    if turning.carry_elements() {
        problem.unknowns.move_with_poles(&start.u, &mut motion);
    }
    if !hinges.are_none() {
        let (_, change) = mass.close(&hinges.gaps(&motion))?;
        motion = sum(&motion, &change);
    }
    if turning.carry_elements() {
        let rest = problem.mass.times(&difference(&start.v, &motion));
        motion = sum(&motion, &mass.respond(&rest)?);
    }
    Ok(Cow::Owned(motion))
}
