//! Velocities of bodies that turn: those of their nodes at the end of an increment, and what impulses see of those at its
//! start. See docs/theory/bodies.md, Rigid bodies that turn.

use std::borrow::Cow;

use crate::dynamics::results::{Cause, State};
use crate::dynamics::step::{StepProblem, Workspace, difference, sum};

/// Gives the nodes of bodies that turn the velocities V1 = V0+ + dt A that go with their accelerations, eq. (11.4), and those
/// without mass of elements the ones of their body at the displacements `u`.
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

/// The velocity that impulses of contact see in the place of V0, that of a motion of the model:
///
/// ```text
/// V = Vr + T_0 (T_0^T M T_0)^-1 T_0^T M (V0 - Vr)      eq. (11.5)
/// ```
///
/// Vr being any motion of the model with what is prescribed, T_0 the rows (11.3) of the start. The rest of V0 does no work
/// with impulses, (V0 - V).M V = 0, so that they bring no energy in.
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
