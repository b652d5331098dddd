//! Fits: the overlaps that contacts allow in an increment, eq. (3.15). See docs/theory/contact.md.

use std::borrow::Cow;

use super::loads::Interval;
use crate::linear::{larger, largest};
use crate::model::{Interference, Load, Model, Step};

/// The contacts of a step that allow an overlap.
pub(crate) struct Fits<'m> {
    model: &'m Model,
    all: Vec<Fit<'m>>,
}

/// A contact that allows an overlap.
struct Fit<'m> {
    load: &'m Load<Interference>,
    /// Factor at every slave node by which the magnitude of the fit is multiplied: the overlap at the start of the
    /// analysis (length), or 1.
    nodes: Cow<'m, [f64]>,
}

impl<'m> Fits<'m> {
    /// Fits of a step. `overlaps` are the overlaps of the slave nodes at the start of the analysis, and `slaves` is the
    /// number of slave nodes of every contact.
    pub fn new(
        model: &'m Model,
        step: &'m Step,
        overlaps: &'m [Vec<f64>],
        slaves: impl Fn(usize) -> usize,
    ) -> Self {
        let fit = |load: &'m Load<Interference>| {
            let contact = load.at.contact;
            let nodes = match load.at.is_shrink {
                true => Cow::Borrowed(overlaps[contact].as_slice()),
                false => Cow::Owned(vec![1.0; slaves(contact)]),
            };
            Fit { load, nodes }
        };
        Fits {
            model,
            all: step.interferences.iter().map(fit).collect(),
        }
    }

    /// Whether no contact allows an overlap.
    pub fn are_none(&self) -> bool {
        self.all.is_empty()
    }

    /// Overlaps that the slave nodes of every contact may have at the start and at the end of an increment (length);
    /// empty for a contact without a fit.
    pub fn allowed(&self, interval: Interval) -> Vec<Vec<[f64; 2]>> {
        let mut allowed = vec![Vec::new(); self.model.contacts.len()];
        for Fit { load, nodes } in &self.all {
            // a = s o, eq. (3.15)
            let part = [interval.start, interval.end].map(|time| time.magnitude(self.model, load));
            allowed[load.at.contact] = nodes.iter().map(|o| part.map(|part| part * o)).collect();
        }
        allowed
    }

    /// The largest length by which the fits separate surfaces in an interval of time.
    pub fn travel(&self, interval: Interval) -> f64 {
        let allowed = self.allowed(interval);
        let ways = allowed.iter().flatten().map(|[a0, a1]| (a0 - a1).abs());
        ways.fold(0.0, larger)
    }

    /// Contacts with a fit, each with the largest overlap at the start of the analysis that the fit removes (length).
    pub fn largest(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let shrinks = self.all.iter().filter(|fit| fit.load.at.is_shrink);
        shrinks.map(|fit| (fit.load.at.contact, largest(&fit.nodes)))
    }
}
