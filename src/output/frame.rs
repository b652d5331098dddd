//! Contents of a field frame, and the last good state of a run, which becomes its final frame.

use std::sync::Arc;

use crate::dynamics::{IncrementReport, NodalResults, State};
use crate::elements::ElementResult;

/// Contents of a field frame.
#[derive(Default)]
pub(crate) struct Frame {
    pub time: f64,
    pub state: State,
    pub nodal: NodalResults,
    /// Mean stress and mean strain of every element.
    pub elements: Arc<[ElementResult]>,
}

impl Frame {
    /// Copies the results of an increment, reusing the allocated memory.
    fn set(&mut self, report: &IncrementReport) {
        let (state, nodal) = (&report.state, &report.nodal);
        self.time = report.time;
        self.state.u.clone_from(&state.u);
        self.state.v.clone_from(&state.v);
        self.state.a.clone_from(&state.a);
        self.nodal.reaction.clone_from(&nodal.reaction);
        self.nodal.concentrated.clone_from(&nodal.concentrated);
        self.nodal.contact_force.clone_from(&nodal.contact_force);
        self.nodal.gap.clone_from(&nodal.gap);
        self.nodal.status.clone_from(&nodal.status);
        self.nodal.pressure.clone_from(&nodal.pressure);
        self.nodal.slip.clone_from(&nodal.slip);
        self.nodal.mass.clone_from(&nodal.mass);
        self.elements.clone_from(&report.elements);
    }
}

/// The last good state: the final frame of a run that stops.
#[derive(Default)]
pub(super) struct LastState {
    pub frame: Frame,
    /// Whether it is a frame.
    pub is_written: bool,
}

impl LastState {
    /// Stores the end of an increment, which is not yet a frame.
    pub fn set(&mut self, report: &IncrementReport) {
        self.frame.set(report);
        self.is_written = false;
    }

    /// Notes that the state is a frame.
    pub fn set_written(&mut self) {
        self.is_written = true;
    }
}
