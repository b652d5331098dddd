//! Contact states and counters.

use std::ops::AddAssign;

/// State of a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ContactState {
    /// No force: Pn = Pt = 0, gap >= 0.
    Open,
    /// gap = 0, slip = 0, |Pt| <= mu Pn.
    Stick,
    /// gap = 0, slip >= 0, Pt = -mu Pn.
    SlipPlus,
    /// gap = 0, slip <= 0, Pt = mu Pn.
    SlipMinus,
}

impl ContactState {
    /// Whether the contact may carry a force.
    pub fn is_closed(self) -> bool {
        self != Self::Open
    }

    /// Sign of the slip: 1, -1, or 0 where the state does not slide.
    pub fn slip_sign(self) -> f64 {
        match self {
            Self::SlipPlus => 1.0,
            Self::SlipMinus => -1.0,
            Self::Open | Self::Stick => 0.0,
        }
    }

    /// The sliding state for a slip of that sign, stick for zero.
    pub(crate) fn sliding(slip: f64) -> Self {
        if slip > 0.0 {
            Self::SlipPlus
        } else if slip < 0.0 {
            Self::SlipMinus
        } else {
            Self::Stick
        }
    }
}

/// Work done by the methods.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counters {
    /// Basis exchanges of Lemke's method.
    pub pivots: usize,
    /// Solves of the active set, one factorisation each.
    pub active_set_iterations: usize,
    /// Sweeps over all contacts of the Gauss-Seidel iteration.
    pub gauss_seidel_sweeps: usize,
    /// Problems given to Lemke's method.
    pub lemke_calls: usize,
}

impl AddAssign for Counters {
    fn add_assign(&mut self, other: Self) {
        self.pivots += other.pivots;
        self.active_set_iterations += other.active_set_iterations;
        self.gauss_seidel_sweeps += other.gauss_seidel_sweeps;
        self.lemke_calls += other.lemke_calls;
    }
}
