//! Velocities at the end of an increment of bodies that turn: those of a rigid motion. Section 11 of docs/theory.md.

use crate::dynamics::results::Cause;
use crate::dynamics::step::{StepProblem, Workspace, difference, dot, sum};

/// What makes the velocities at the end of an increment those of rigid motions.
#[derive(Debug, Clone, Default)]
pub(crate) struct RigidImpulse {
    /// Mean force J/dt of its impulse J = M (V - V1) over all dofs; empty where no body may leave a rigid motion.
    pub force: Vec<f64>,
    /// Kinetic energy (V - V1).M (V - V1)/2 that it takes.
    pub loss: f64,
}

/// Makes the velocities `v` at the displacements `u` of the end of an increment those of bodies that turn as rigid ones,
/// by an impulse that does no work in any motion of the model; the accelerations `a` lead to them:
///
/// ```text
/// V = Vr + T M^-1 T^T M (V1 - Vr),  A += (V - V1)/dt      eq. (11.5)
/// ```
///
/// V1 = V0+ + dt A, Vr any rigid motion with what is prescribed, T the rows (11.3) of the end. With hinges V1 stays.
pub(super) fn make_rigid(
    problem: &StepProblem,
    workspace: &mut Workspace,
    (v0p, dt): (&[f64], f64),
    (u, v, a): (&[f64], &mut Vec<f64>, &mut [f64]),
) -> Result<RigidImpulse, Cause> {
    let turning = &problem.unknowns.turning;
    if turning.is_empty() {
        return Ok(RigidImpulse::default());
    }
    for [dof, ..] in turning.followers() {
        v[dof] = v0p[dof] + dt * a[dof];
    }
    problem.unknowns.move_bodies(u, v);
    if !turning.carry_elements() || !problem.hinges.are_none() {
        return Ok(RigidImpulse::default());
    }
    let mut rigid = v.clone();
    turning.move_with_poles(u, &mut rigid);
    workspace.stiffness.start(problem, u);
    let mut mass = workspace.m();
    mass.factorize()?;
    let response = mass.respond(&problem.mass.times(&difference(v, &rigid)))?;
    let end = sum(&rigid, &response);
    let change = difference(&end, v);
    *v = end;
    a.iter_mut().zip(&change).for_each(|(a, c)| *a += c / dt);
    let impulse = problem.mass.times(&change);
    Ok(RigidImpulse {
        loss: dot(&change, &impulse) / 2.0,
        force: impulse.iter().map(|j| j / dt).collect(),
    })
}
