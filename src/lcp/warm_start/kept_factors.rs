//! Factors of a system of some states, kept for similar ones: the same with Q a little different, with other states of
//! some contacts, or with some contacts more or less. Section 8 of docs/theory.md, The hybrid.

use bumpalo::Bump;

use super::solution::{FrictionalSolution, Spare};
use crate::lcp::pivots::Factors;
use crate::lcp::problems::{ContactState, List, Scaled, list};

/// What tells a contact from others through a row of similar problems.
pub type ContactName = [usize; 2];

/// Factors of the system of some states, and the memory of the solves.
#[derive(Default)]
pub struct KeptFactors {
    /// Names of the contacts of the next problem. Without names, factors serve systems of the same states only.
    names: Vec<ContactName>,
    kept: Option<Kept>,
    /// Where the lists of a solve lie.
    pub(super) arena: Bump,
    pub(super) spare: Spare,
}

/// Factors with the system that they are of.
pub(super) struct Kept {
    names: Vec<ContactName>,
    states: Vec<ContactState>,
    slides: Vec<f64>,
    weights: Vec<f64>,
    compliance: f64,
    /// Contact of every unknown, and whether it is the tangential force.
    pub unknowns: Vec<(usize, bool)>,
    pub factors: Factors,
}

impl Kept {
    /// The system that the factors are of.
    pub fn of(&self) -> System<'_> {
        System {
            names: &self.names,
            states: &self.states,
            slides: &self.slides,
            weights: &self.weights,
            compliance: self.compliance,
        }
    }
}

/// A system: its contacts with their states, and the units that its entries are in.
pub(super) struct System<'a> {
    names: &'a [ContactName],
    pub states: &'a [ContactState],
    /// Pt = slide Pn where a contact slides, else zero.
    pub slides: &'a [f64],
    pub weights: &'a [f64],
    pub compliance: f64,
}

impl<'a> System<'a> {
    /// The system of some states of contacts with the given names, or without.
    fn new(names: &'a [ContactName], scaled: &'a Scaled, states: &'a [ContactState]) -> Self {
        let n = scaled.contacts;
        let slides = list(scaled.arena, (0..n).map(|i| slide(scaled, states, i)));
        System {
            names: match names.len() == n {
                true => names,
                false => list(scaled.arena, (0..n).map(|i| [i, 0])).into_bump_slice(),
            },
            states,
            slides: slides.into_bump_slice(),
            weights: &scaled.weights,
            compliance: scaled.compliance,
        }
    }

    /// Place of each of its contacts among those of another system, if it has them.
    pub fn places_in<'l>(&self, other: &System, arena: &'l Bump) -> List<'l, Option<usize>> {
        if self.names == other.names {
            return list(arena, (0..self.names.len()).map(Some));
        }
        let mut by_name = list(arena, other.names.iter().copied().zip(0..));
        by_name.sort_unstable();
        let place = |name: &ContactName| {
            let found = by_name.binary_search_by_key(name, |(name, _)| *name);
            found.ok().map(|at| by_name[at].1)
        };
        list(arena, self.names.iter().map(place))
    }
}

impl KeptFactors {
    /// Names the contacts of the next problem, each differently.
    pub fn name_contacts(&mut self, names: impl Iterator<Item = ContactName>) {
        self.names.clear();
        self.names.extend(names);
    }

    /// Takes the memory of a solution that is not needed any more.
    pub fn take(&mut self, solution: FrictionalSolution) {
        self.spare.take(solution);
    }

    /// Forgets factors and names, so that other systems have factors of their own; whether there were names.
    pub(super) fn forget(&mut self) -> bool {
        self.kept = None;
        !std::mem::take(&mut self.names).is_empty()
    }

    /// The factors, if they are of a system of the same contacts with the same states in the same units.
    pub(super) fn same(&self, scaled: &Scaled, states: &[ContactState]) -> Option<&Factors> {
        let kept = self.kept.as_ref()?;
        let of = kept.of();
        let are_same = (self.names.is_empty() || of.names == self.names)
            && of.states == states
            && (*of.weights == *scaled.weights && of.compliance == scaled.compliance)
            && (0..scaled.contacts).all(|i| of.slides[i] == slide(scaled, states, i));
        are_same.then_some(&kept.factors)
    }

    /// The factors that may serve the system of the given states, which comes with them.
    pub(super) fn serving<'a>(
        &'a self,
        scaled: &'a Scaled,
        states: &'a [ContactState],
    ) -> Option<(&'a Kept, System<'a>)> {
        let kept = self.kept.as_ref()?;
        let may_serve = !self.names.is_empty() || kept.states == states;
        may_serve.then(|| (kept, System::new(&self.names, scaled, states)))
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
        let system = System::new(&self.names, scaled, states);
        self.kept = Some(Kept {
            names: system.names.to_vec(),
            states: states.to_vec(),
            slides: system.slides.to_vec(),
            weights: system.weights.to_vec(),
            compliance: system.compliance,
            unknowns: unknowns.iter().map(of).collect(),
            factors,
        });
    }
}

/// The factor in Pt = factor Pn of contact i, zero where it does not slide.
pub(super) fn slide(scaled: &Scaled, states: &[ContactState], i: usize) -> f64 {
    -states[i].slip_sign() * scaled.mu[i]
}
