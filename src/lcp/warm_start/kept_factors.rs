//! Factors of a system of some states, kept for similar ones: the same with Q a little different, with other states of
//! some contacts, or with some contacts more or less. Section 8 of docs/theory.md, The hybrid.

use crate::lcp::pivots::Factors;
use crate::lcp::problems::{ContactState, Scaled};

/// What tells a contact from others through a row of similar problems.
pub type ContactName = [usize; 2];

/// Factors of the system of some states.
#[derive(Default)]
pub struct KeptFactors {
    /// Names of the contacts of the next problem. Without names, factors serve systems of the same states only.
    names: Vec<ContactName>,
    kept: Option<Kept>,
}

/// Factors with the system that they are of.
pub(super) struct Kept {
    pub of: System,
    /// Contact of every unknown, and whether it is the tangential force.
    pub unknowns: Vec<(usize, bool)>,
    pub factors: Factors,
}

/// A system: its contacts with their states, and the units that its entries are in.
pub(super) struct System {
    names: Vec<ContactName>,
    pub states: Vec<ContactState>,
    /// Pt = slide Pn where a contact slides, else zero.
    pub slides: Vec<f64>,
    pub weights: Vec<f64>,
    pub compliance: f64,
}

impl System {
    /// Place of each of its contacts among those of another system, if it has them.
    pub fn places_in(&self, other: &System) -> Vec<Option<usize>> {
        if self.names == other.names {
            return (0..self.names.len()).map(Some).collect();
        }
        let mut by_name: Vec<(ContactName, usize)> = other.names.iter().copied().zip(0..).collect();
        by_name.sort_unstable();
        let place = |name: &ContactName| {
            let found = by_name.binary_search_by_key(name, |(name, _)| *name);
            found.ok().map(|at| by_name[at].1)
        };
        self.names.iter().map(place).collect()
    }
}

impl KeptFactors {
    /// Names the contacts of the next problem, each differently.
    pub fn name_contacts(&mut self, names: impl Iterator<Item = ContactName>) {
        self.names.clear();
        self.names.extend(names);
    }

    /// Forgets factors and names, so that other systems have factors of their own; whether there were names.
    pub(super) fn forget(&mut self) -> bool {
        self.kept = None;
        !std::mem::take(&mut self.names).is_empty()
    }

    /// The system of states of the next problem.
    fn system(&self, scaled: &Scaled, states: &[ContactState]) -> System {
        let n = scaled.contacts;
        System {
            names: match self.names.len() == n {
                true => self.names.clone(),
                false => (0..n).map(|i| [i, 0]).collect(),
            },
            states: states.to_vec(),
            slides: (0..n).map(|i| slide(scaled, states, i)).collect(),
            weights: scaled.weights.clone(),
            compliance: scaled.compliance,
        }
    }

    /// The factors, if they are of a system of the same contacts with the same states in the same units.
    pub(super) fn same(&self, scaled: &Scaled, states: &[ContactState]) -> Option<&Factors> {
        let Kept { of, factors, .. } = self.kept.as_ref()?;
        let are_same = (self.names.is_empty() || of.names == self.names)
            && of.states == states
            && (of.weights == scaled.weights && of.compliance == scaled.compliance)
            && (0..scaled.contacts).all(|i| of.slides[i] == slide(scaled, states, i));
        are_same.then_some(factors)
    }

    /// The factors that may serve the system of the given states, which comes with them.
    pub(super) fn serving(
        &self,
        scaled: &Scaled,
        states: &[ContactState],
    ) -> Option<(&Kept, System)> {
        let kept = self.kept.as_ref()?;
        let may_serve = !self.names.is_empty() || kept.of.states == states;
        may_serve.then(|| (kept, self.system(scaled, states)))
    }

    /// Keeps the factors of the system of the given states and unknowns.
    pub(super) fn keep(
        &mut self,
        scaled: &Scaled,
        states: &[ContactState],
        unknowns: &[usize],
        factors: Factors,
    ) {
        let of = |k: &usize| match k.checked_sub(scaled.contacts) {
            None => (*k, false),
            Some(tangent) => (scaled.owners[tangent], true),
        };
        self.kept = Some(Kept {
            of: self.system(scaled, states),
            unknowns: unknowns.iter().map(of).collect(),
            factors,
        });
    }
}

/// The factor in Pt = factor Pn of contact i, zero where it does not slide.
pub(super) fn slide(scaled: &Scaled, states: &[ContactState], i: usize) -> f64 {
    -states[i].slip_sign() * scaled.mu[i]
}
