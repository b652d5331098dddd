//! The linear problem of a pass: its vectors, K* with its contact problems, and hinges.

use nalgebra::DMatrix;

use super::pass::Residual;
use crate::dynamics::results::Cause;
use crate::dynamics::step::{Equilibrium, ForceChange, StepProblem, Workspace, difference, sum};
use crate::linear::largest;

/// Change of the force N dU, relative to the other forces, up to which this change counts as zero.
const NO_CHANGE: f64 = 1e-13;
/// Largest part of the first change of the force N dU that is left to the next pass.
const MOST_LEFT: f64 = 1e-3;
/// Largest number of changes of the force N dU in a pass.
const MOST_CHANGES: usize = 3;
/// Ratio below which successive changes of the force N dU must stay, unless these changes are round-off.
const FALLS: f64 = 0.5;

/// Vectors of the passes of an increment.
#[derive(Default)]
pub(super) struct Vectors {
    /// Forces of the iterate.
    pub equilibrium: Equilibrium,
    /// Displacement U of the iterate.
    pub u: Vec<f64>,
    /// Prescribed motion d_p of the supports that the predictor leaves to the passes.
    pub d_p: Vec<f64>,
    /// Force theta2 K d_p of the prescribed motion.
    pub support_force: Vec<f64>,
    /// Load r - theta2 K d_p of the pass.
    pub load: Vec<f64>,
    /// Prescribed motion d_p plus the motion that closes the gaps of the hinges.
    pub closing: Vec<f64>,
    /// Correction dU.
    pub du: Vec<f64>,
    /// Displacement increment after the first pass.
    pub tangent: Vec<f64>,
    pub residual: Residual,
    pub skew: SkewPart,
}

/// The part N dU of the change of the forces in a static step that K* omits. The matrix N holds the skew parts of the
/// changes of contact forces and of loads that follow the iterate. See docs/theory/bodies.md, Static steps.
#[derive(Default)]
pub(super) struct SkewPart {
    /// Dofs of each skew part, and N over these dofs.
    parts: Vec<(Vec<usize>, DMatrix<f64>)>,
    /// Part N dU of the change of the forces, over all dofs (force).
    force: Vec<f64>,
    /// Part of the first change of N dU that is left to the next pass.
    left: f64,
    /// Number of changes of N dU so far, and the first and the last change (force).
    changes: (usize, [f64; 2]),
}

impl SkewPart {
    /// The skew parts of the given changes, with dU = 0. The square of `correction`, the relative correction of the
    /// last pass, is the part of the first change that is left to the next pass.
    pub fn new(all: &[ForceChange], correction: f64) -> Self {
        let skew = |change: &ForceChange| (change.dofs.clone(), change.skew());
        SkewPart {
            parts: all.iter().map(skew).collect(),
            left: correction.powi(2).clamp(NO_CHANGE, MOST_LEFT),
            ..SkewPart::default()
        }
    }

    /// Adds the force N dU to a load.
    pub fn add_to(&self, load: &mut [f64]) {
        load.iter_mut().zip(&self.force).for_each(|(r, f)| *r += f);
    }

    /// The product N x for a motion x of all dofs.
    pub fn product(&self, x: &[f64]) -> Vec<f64> {
        let mut force = vec![0.0; x.len()];
        for (dofs, skew) in &self.parts {
            for (i, &row) in dofs.iter().enumerate() {
                let products = dofs.iter().enumerate().map(|(j, &d)| skew[(i, j)] * x[d]);
                force[row] += products.sum::<f64>();
            }
        }
        force
    }

    /// Enters the correction dU of another solve. Returns whether the force N dU has converged, relative to the other
    /// forces, or cannot converge further because of round-off.
    pub fn take_in(&mut self, du: &[f64], others: f64) -> bool {
        let force = self.product(du);
        self.force.resize(du.len(), 0.0);
        let change = largest(&difference(&force, &self.force));
        self.force = force;
        let (count, [first, last]) = match self.changes {
            (0, _) => (1, [change, f64::INFINITY]),
            (count, changes) => (count + 1, changes),
        };
        self.changes = (count, [first, change]);
        let is_small = change <= NO_CHANGE * others || change <= self.left * first;
        is_small || change > FALLS * last || count >= MOST_CHANGES
    }
}

/// Writes the prescribed motion d_p plus the motion that closes the gaps of the hinges; returns the hinge forces of the
/// closing motion.
///
/// ```text
/// y = d_p + T_1 V mu,  mu = -S^-1 (C U + C d_p)      eq. (11.10)
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
