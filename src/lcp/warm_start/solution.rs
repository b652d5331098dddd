//! Solution of a frictional problem, in memory that the next one uses again. Section 8 of docs/theory.md.

use nalgebra::DVector;

use crate::lcp::problems::{ContactState, Counters};

/// The method that produced a solution.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// No contact penetrates: no forces.
    Trivial,
    /// Active set on the contact states.
    ActiveSet,
    /// Lemke's method.
    Lemke,
}

/// Solution of a [`FrictionalLcp`](crate::lcp::FrictionalLcp).
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionalSolution {
    /// Normal forces, zero where open.
    pub pn: DVector<f64>,
    /// Tangential forces, exactly -+mu Pn where sliding.
    pub pt: DVector<f64>,
    /// Gaps under these forces.
    pub gap: DVector<f64>,
    /// Slips under these forces.
    pub slip: DVector<f64>,
    /// States of the contacts.
    pub state: Vec<ContactState>,
    /// Scaled residual of the contact conditions.
    pub residual: f64,
    /// The method that found the states.
    pub method: Method,
    /// Work done, by all methods tried.
    pub counters: Counters,
}

/// Memory of a solution that is not needed any more, for the next one.
#[derive(Default)]
pub(super) struct Spare {
    vectors: [Vec<f64>; 4],
    pub states: Vec<ContactState>,
}

impl Spare {
    /// Takes the memory of a solution.
    pub fn take(&mut self, solution: FrictionalSolution) {
        let FrictionalSolution {
            pn,
            pt,
            gap,
            slip,
            state,
            ..
        } = solution;
        self.vectors = [pn, pt, gap, slip].map(|vector| vector.data.into());
        self.states = state;
    }

    /// A vector of a solution, the i-th.
    pub fn vector(&mut self, i: usize, values: &[f64]) -> DVector<f64> {
        let mut vector = std::mem::take(&mut self.vectors[i]);
        vector.clear();
        vector.extend_from_slice(values);
        DVector::from_vec(vector)
    }
}
