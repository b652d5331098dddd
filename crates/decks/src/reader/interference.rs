//! `*CONTACT INTERFERENCE`: overlaps that contact pairs and general contact allow, carried from step to step.

use super::boundary::Targets;
use super::context::Context;
use super::loads::{LoadHistory, Operation, StepContext};
use super::surfaces::Surfaces;
use crate::deck::{Card, Line};
use crate::diagnostics::{Code, Span};
use crate::model::{Amplitude, Contact, Interference, Load, TimeBase};
use std::collections::BTreeMap;

/// The allowed overlaps by contacts, as they are carried from step to step.
#[derive(Default)]
pub(crate) struct Interferences {
    all: LoadHistory<usize, Interference>,
    operation: Operation,
    /// For each contact, the last step that gives the contact an overlap, and whether the row names the surfaces in the
    /// order of the contact.
    given: BTreeMap<usize, (usize, bool)>,
}

/// Data for reading the rows of a card.
#[derive(Clone, Copy)]
pub(crate) struct Pairs<'a> {
    pub surfaces: &'a Surfaces,
    pub contacts: &'a [Contact],
    pub targets: Targets<'a>,
    /// Total time at which the step starts.
    pub start: f64,
}

impl Interferences {
    /// Adds the overlap that general contact removes in the first step.
    pub fn first_step(&mut self, contacts: &[Contact]) {
        let fitted = contacts.iter().enumerate();
        for (contact, _) in fitted.filter(|(_, contact)| contact.is_interference_fit) {
            self.shrink(contact, 1);
        }
    }

    fn shrink(&mut self, contact: usize, step: usize) {
        let at = Interference {
            contact,
            is_shrink: true,
        };
        self.all.add_falling(contact, at, 1.0, step);
    }

    /// Reads a card.
    pub fn card(&mut self, card: &Card, step: usize, pairs: Pairs, cx: &mut Context) {
        let context = StepContext { step, ramp: true };
        if self.operation.starts_anew(card, step, cx) {
            self.all.clear(context, |_| true);
        }
        let shrinks = card.has("SHRINK");
        if shrinks && step > 1 {
            let message = "SHRINK presses out the overlap of the mesh, in the first step only";
            cx.error(Code::Interference, card.span_of("SHRINK"), message)
                .help("move the card to the first step, or give the overlap in the third field");
            return;
        }
        if shrinks && card.has("AMPLITUDE") {
            let message = "AMPLITUDE has no effect with SHRINK: the overlap shrinks linearly";
            let span = card.span_of("AMPLITUDE");
            cx.d.warning(Code::IgnoredParameter, span, message);
        }
        let amplitude = match pairs.targets.amplitudes.of(card, cx) {
            Ok(amplitude) => amplitude.filter(|_| !shrinks),
            Err(_) => return,
        };
        let rows = card.rows.iter();
        let read = rows.filter_map(|row| {
            let found = found(row, pairs, cx)?;
            let overlap = match shrinks {
                true => 1.0,
                false => row.real(2, "the overlap that is allowed", cx.d)?,
            };
            row.at_most(if shrinks { 2 } else { 3 }, cx.d);
            Some((row, found, overlap))
        });
        let read: Vec<(Line, [Option<usize>; 2], f64)> = read.collect();
        let named: Vec<usize> = read.iter().filter_map(|(_, [own, _], _)| *own).collect();
        for (row, [own, other], overlap) in read {
            let other = other.filter(|other| !named.contains(other));
            for (contact, is_own) in [(own, true), (other, false)] {
                let Some(contact) = contact else { continue };
                match self.given.get(&contact) {
                    Some(&(last, true)) if last == step && is_own => {
                        let message = "this pair has an overlap in this step already";
                        cx.error(Code::Interference, row.span(), message);
                        continue;
                    }
                    Some(&(last, _)) if last == step && !is_own => continue,
                    Some(&(last, _)) if last == step => self.all.take_back(contact, step),
                    _ => {}
                }
                self.given.insert(contact, (step, is_own));
                if shrinks {
                    self.shrink(contact, step);
                } else {
                    let start = (amplitude, pairs.start);
                    self.add(
                        contact,
                        overlap,
                        start,
                        context,
                        (row.span_at(2), pairs, cx),
                    );
                }
            }
        }
    }

    /// Allows an overlap, which must not begin below the overlap that the step before has left.
    fn add(
        &mut self,
        contact: usize,
        overlap: f64,
        (amplitude, start): (Option<usize>, f64),
        context: StepContext,
        (span, pairs, cx): (Span, Pairs, &mut Context),
    ) {
        let at = Interference {
            contact,
            is_shrink: false,
        };
        let curve = amplitude.and_then(|index| pairs.targets.amplitudes.named.all.get(index));
        let part = curve.map_or(1.0, |curve| match curve.time {
            TimeBase::Step => curve.at(0.0),
            TimeBase::Total => curve.at(start),
        });
        let left = self.all.left(contact, context.step);
        if overlap * part < left {
            let message = match left == 0.0 {
                true => "a negative overlap would part the surfaces at once".to_owned(),
                false => format!("the step before leaves an overlap of {left}"),
            };
            cx.error(Code::Interference, span, message)
                .help("give an AMPLITUDE that begins with what is allowed before, at first with 0");
            return;
        }
        match amplitude {
            Some(_) => self.all.add(contact, at, overlap, amplitude, context),
            None => self.all.add_falling(contact, at, overlap, context.step),
        }
    }

    /// The overlaps of the current step.
    pub fn list(&mut self, is_last: bool) -> Vec<Load<Interference>> {
        self.all.list(is_last)
    }

    /// Ends a step of duration `period` at total time `total`.
    pub fn end_step(&mut self, period: f64, total: f64, amplitudes: &[Amplitude]) {
        self.all.end_step(period, total, amplitudes);
    }
}

/// The contact pair of the surfaces of a row, and the pair with slave and master exchanged.
fn found(row: Line, pairs: Pairs, cx: &mut Context) -> Option<[Option<usize>; 2]> {
    let mut surface = |index: usize, what: &str| {
        let field = row.required(index, what, cx.d)?;
        pairs.surfaces.find(field, cx)
    };
    let (slave, master) = (
        surface(0, "the slave surface"),
        surface(1, "the master surface"),
    );
    let (slave, master) = (slave?.0, master?.0);
    let pair = |slave: usize, master: usize| {
        let is_meant = |contact: &Contact| (contact.slave, contact.master) == (slave, master);
        pairs.contacts.iter().position(is_meant)
    };
    if slave == master {
        let message = "a surface that touches itself has no fit";
        cx.error(Code::Interference, row.span(), message)
            .help("in general contact: *CONTACT INITIALIZATION DATA, INTERFERENCE FIT");
        return None;
    }
    let found = [pair(slave, master), pair(master, slave)];
    if found == [None; 2] {
        let message = "there is no contact pair of these surfaces";
        cx.error(Code::Interference, row.span(), message)
            .help("a *CONTACT PAIR makes one; in general contact give *CONTACT INITIALIZATION DATA, INTERFERENCE FIT");
        return None;
    }
    Some(found)
}
