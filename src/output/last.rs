//! The last good state of a run, which becomes its final frame.

use crate::dynamics::{IncrementReport, NodalResults, State};

/// The last good state: the final frame of a run that stops.
#[derive(Default)]
pub(super) struct LastState {
    pub time: f64,
    pub state: State,
    pub nodal: NodalResults,
    /// Whether it is in the file.
    pub written: bool,
    /// Time of the last frame in the file.
    pub frame: f64,
}

impl LastState {
    /// Copies the state into the memory at hand.
    pub fn set(&mut self, report: &IncrementReport, written: bool) {
        let (state, nodal) = (&report.state, &report.nodal);
        self.time = report.time;
        self.state.u.clone_from(&state.u);
        self.state.v.clone_from(&state.v);
        self.state.a.clone_from(&state.a);
        self.nodal.reaction.clone_from(&nodal.reaction);
        self.nodal.contact_force.clone_from(&nodal.contact_force);
        self.nodal.gap.clone_from(&nodal.gap);
        self.nodal.status.clone_from(&nodal.status);
        self.nodal.pressure.clone_from(&nodal.pressure);
        self.nodal.slip.clone_from(&nodal.slip);
        self.written = written;
        if written {
            self.frame = report.time;
        }
    }
}
