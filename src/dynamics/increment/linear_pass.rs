//! The linear problem of a pass: its vectors, K* with its contact problems, and hinges.

use super::contact_system::ContactSystem;
use super::convergence::Residual;
use crate::dynamics::results::Cause;
use crate::dynamics::step::{Equilibrium, StepProblem, Workspace, sum};

/// Vectors of the passes of an increment.
#[derive(Default)]
pub(super) struct Vectors {
    /// Forces of the iterate.
    pub equilibrium: Equilibrium,
    /// Displacement U of the iterate.
    pub u: Vec<f64>,
    /// What the predictor leaves of the supports' motion, d_p.
    pub d_p: Vec<f64>,
    /// Its force theta2 K d_p.
    pub support_force: Vec<f64>,
    /// r - theta2 K d_p
    pub load: Vec<f64>,
    /// d_p with the motion that closes the hinges.
    pub closing: Vec<f64>,
    /// Correction dU.
    pub du: Vec<f64>,
    /// Displacement increment after the first pass.
    pub tangent: Vec<f64>,
    pub residual: Residual,
}

/// K* of a step with its contact problems.
pub(super) fn k_star<'w>(problem: &StepProblem, workspace: &'w mut Workspace) -> ContactSystem<'w> {
    ContactSystem {
        system: workspace.k(),
        method: problem.method(),
    }
}

/// Writes d_p with the motion that closes the gaps of the hinges; gives the forces that make it.
///
/// ```text
/// y = d_p + T_1 V mu,  mu = -S^-1 (C U + C d_p)      eq. (11.8)
/// ```
pub(super) fn close_hinges(
    problem: &StepProblem,
    workspace: &mut Workspace,
    v: &mut Vectors,
) -> Result<Vec<f64>, Cause> {
    let hinges = &problem.hinges;
    v.closing.clone_from(&v.d_p);
    if hinges.are_none() {
        return Ok(Vec::new());
    }
    let gaps = sum(&hinges.gaps(&v.u), &hinges.gaps(&v.d_p));
    let (forces, motion) = workspace.k().close(&gaps)?;
    let both = v.closing.iter_mut().zip(&motion);
    both.for_each(|(y, m)| *y += m);
    Ok(forces)
}
