//! Velocity jump at the start of an increment: the set of pairs that take impact impulses,
//! iterated along with the passes. Section 6 of docs/theory.md (paper eq. 30).

use super::closed_pairs::ClosedPairs;
use super::contact_forces::ContactForces;
use crate::contact::{Pair, PairTarget};
use crate::dynamics::results::{Cause, State};
use crate::dynamics::step::{StepProblem, Workspace};
use crate::model::Impact;

/// Changes of the set of pairs with impulses after which it is kept.
const SET_CHANGES: usize = 5;

/// The impact impulses of an increment: they act on the pairs that carry force at its end, and on
/// those that touch at its start where an impact ended the piece before.
pub(crate) struct Impulses {
    /// Slots and segments of these pairs, increasing: those of the last pass.
    keys: Vec<[usize; 2]>,
    /// Slots and segments, increasing, of pairs on which they act in any case.
    pub touching: Vec<[usize; 2]>,
    changes: usize,
    /// V0+ of the last pass with the pairs it is for.
    last: Option<(Vec<PairTarget>, Vec<f64>)>,
    /// Phi, Psi of the last pass.
    pub acting: ContactForces,
}

impl Impulses {
    /// Starts with the pairs that were closed in the last increment; those of `touching` have
    /// impulses in any case.
    pub fn new(contact: &ClosedPairs, touching: Vec<[usize; 2]>) -> Self {
        Impulses {
            keys: contact.keys(),
            touching,
            changes: 0,
            last: None,
            acting: ContactForces::default(),
        }
    }

    /// Velocity V0+ = V0 + M^-1 (Bn^T Phi + Bt^T Psi), eq. (6.1), for the pairs of the iterate.
    pub fn velocity(
        &mut self,
        problem: &StepProblem,
        workspace: &mut Workspace,
        pairs: &[Pair],
        start: &State,
        dt: f64,
    ) -> Result<Vec<f64>, Cause> {
        if problem.settings.impact == Impact::None {
            return Ok(start.v.clone());
        }
        let struck = pairs.iter().filter(|pair| self.strikes(&pair.target));
        let targets: Vec<PairTarget> = struck.clone().map(|pair| pair.target).collect();
        let at_start = problem.weights.impulses_at_start();
        if let Some((last, v0p)) = &self.last
            && at_start
            && *last == targets
        {
            // rows of the start do not change with the iterate
            return Ok(v0p.clone());
        }
        let (x, u0) = (&problem.model.mesh.coordinates, &start.u);
        let form = problem.weights.row_form();
        let rows = |pair: &Pair| match at_start {
            true => Pair::new(pair.target, form, x, u0, u0),
            false => *pair,
        };
        let struck: Vec<Pair> = struck.map(rows).collect();
        let (m, method) = (workspace.m(), problem.method());
        let (v0p, acting) =
            ContactForces::impulses(struck, &start.v, dt, &problem.unknowns, m, method)?;
        self.acting = acting;
        self.last = Some((targets, v0p.clone()));
        Ok(v0p)
    }

    /// Takes over the pairs in contact after a pass; whether they are the same as before. After
    /// some changes the set is kept: impulses of any set take energy, never give it.
    pub fn rest(&mut self, problem: &StepProblem, contact: &ClosedPairs) -> bool {
        let keys = contact.keys();
        let others = |keys: &[[usize; 2]]| -> Vec<[usize; 2]> {
            let touches = |key: &[usize; 2]| self.touching.binary_search(key).is_ok();
            keys.iter().copied().filter(|key| !touches(key)).collect()
        };
        let rest = problem.settings.impact == Impact::None
            || others(&keys) == others(&self.keys)
            || self.changes >= SET_CHANGES;
        if !rest {
            self.keys = keys;
            self.changes += 1;
        }
        rest
    }

    fn strikes(&self, at: &PairTarget) -> bool {
        let mut segments = at.target.segments();
        self.keys.binary_search(&at.key()).is_ok()
            || segments.any(|i| self.touching.binary_search(&[at.slave_index, i]).is_ok())
    }
}
