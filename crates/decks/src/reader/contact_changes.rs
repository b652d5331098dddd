//! `*CHANGE FRICTION` and `*MODEL CHANGE`: the contacts of a deck from step to step.

use super::amplitudes::Amplitudes;
use super::contact::friction_of;
use super::context::Context;
use super::loads::StepContext;
use super::surfaces::Surfaces;
use crate::deck::{Card, Line, Text};
use crate::diagnostics::{Code, Span, shown};
use crate::model::{
    Amplitude, Contact, ContactChanges, FormerFriction, Friction, FrictionChange, TimeBase,
};

/// Largest difference from 1 of an amplitude whose change is complete.
const AT_ITS_END: f64 = 1e-12;

/// State of the contacts after the steps read so far.
pub(crate) struct ContactHistory<'a> {
    contacts: &'a [Contact],
    amplitudes: &'a Amplitudes,
    /// Friction of each contact; during a change, the friction at its end.
    friction: Vec<Friction>,
    /// For each contact, the change of friction by an amplitude that is under way.
    under_way: Vec<Option<ChangeUnderWay>>,
    /// Contacts (indices) that do not act, in increasing order.
    removed: Vec<usize>,
    /// Total time at which the step starts.
    start: f64,
    last_period: f64,
}

/// A change of friction that follows an amplitude.
#[derive(Clone)]
struct ChangeUnderWay {
    from: Friction,
    amplitude: usize,
    /// Place of the name of the amplitude.
    span: Span,
}

impl<'a> ContactHistory<'a> {
    /// State of the contacts before the first step.
    pub fn new(contacts: &'a [Contact], amplitudes: &'a Amplitudes) -> Self {
        let friction = |contact: &Contact| contact.interaction.friction.clone();
        ContactHistory {
            contacts,
            amplitudes,
            friction: contacts.iter().map(friction).collect(),
            under_way: vec![None; contacts.len()],
            removed: Vec::new(),
            start: 0.0,
            last_period: 0.0,
        }
    }

    /// Obeys the cards of a step; returns the changes that the step makes.
    pub fn step(
        &mut self,
        cards: &[&Card],
        context: StepContext,
        surfaces: &Surfaces,
        cx: &mut Context,
    ) -> ContactChanges {
        let before = self.friction.clone();
        self.end_changes(|curve| curve.time == TimeBase::Step, cx);
        for (index, card) in cards.iter().enumerate() {
            match card.keyword.name {
                "CHANGE FRICTION" => {
                    let next = cards.get(index + 1).copied();
                    let given = next.filter(|next| next.keyword.name == "FRICTION");
                    self.change_friction(card, given, &before, cx);
                }
                "MODEL CHANGE" => self.model_change(card, surfaces, cx),
                _ => {}
            }
        }
        let numbered = self.contacts.iter().zip(before).enumerate();
        let changes = numbered.filter_map(|(contact, (own, before))| {
            let friction = self.friction[contact].clone();
            let from = match &self.under_way[contact] {
                Some(change) => Some(FormerFriction {
                    friction: change.from.clone(),
                    amplitude: Some(change.amplitude),
                }),
                None => (context.ramp && before.ramps_to(&friction)).then_some(FormerFriction {
                    friction: before,
                    amplitude: None,
                }),
            };
            let differs = from.is_some() || friction != own.interaction.friction;
            differs.then_some(FrictionChange {
                contact,
                friction,
                from,
            })
        });
        ContactChanges {
            removed: self.removed.clone(),
            friction: changes.collect(),
        }
    }

    /// The friction under `*CHANGE FRICTION` for the contacts of an interaction; with RESET the result is the friction
    /// of the model.
    fn change_friction(
        &mut self,
        card: &Card,
        given: Option<&Card>,
        before: &[Friction],
        cx: &mut Context,
    ) {
        let Some(name) = card.required("INTERACTION", cx.d) else {
            return;
        };
        let resets = card.has("RESET");
        let friction = match (given, resets) {
            (Some(given), true) => {
                let message = "RESET brings back the friction of the model: there is no other one";
                cx.error(Code::ContactChange, given.span, message)
                    .help("leave out *FRICTION, or RESET");
                return;
            }
            (None, false) => {
                let message = "*CHANGE FRICTION needs *FRICTION after it, or RESET";
                cx.error(Code::MissingData, card.span, message);
                return;
            }
            (Some(given), false) if given.faulty => return,
            (Some(given), false) => match friction_of(given, cx) {
                Some(friction) => Some(friction),
                None => return,
            },
            (None, true) => None,
        };
        let Some(wanted) = name.name(cx.d) else {
            return;
        };
        let Ok(amplitude) = self.amplitudes.of(card, cx) else {
            return;
        };
        let span = card.span_of("AMPLITUDE");
        if let Some(curve) = amplitude.and_then(|index| self.amplitudes.named.all.get(index)) {
            check_parts(curve, span, cx);
        }
        let contacts = self.contacts.iter().enumerate();
        let meant = contacts.filter(|(_, contact)| wanted.key == contact.interaction.name);
        let meant: Vec<usize> = meant.map(|(contact, _)| contact).collect();
        let mut follows = amplitude.is_none();
        for &contact in &meant {
            if let Some(change) = self.under_way[contact].take() {
                self.check_end(&change, cx);
            }
            let own = &self.contacts[contact].interaction.friction;
            let now = friction.clone().unwrap_or_else(|| own.clone());
            let from = before[contact].clone();
            if let Some(amplitude) = amplitude.filter(|_| from.ramps_to(&now)) {
                follows = true;
                self.under_way[contact] = Some(ChangeUnderWay {
                    from,
                    amplitude,
                    span,
                });
            }
            self.friction[contact] = now;
        }
        if !follows && !meant.is_empty() {
            let message = "AMPLITUDE has no effect: the coefficient stays, or changes at once";
            cx.d.warning(Code::IgnoredParameter, span, message);
        }
        if meant.is_empty() {
            let mut known: Vec<&str> = (self.contacts.iter())
                .map(|contact| contact.interaction.name.as_str())
                .filter(|name| !name.is_empty())
                .collect();
            known.dedup();
            cx.undefined("surface interaction of a contact", name, known.into_iter());
        }
    }

    /// Ends a step of the given duration.
    pub fn end_step(&mut self, period: f64) {
        self.start += period;
        self.last_period = period;
    }

    /// Ends those changes under way whose amplitudes end.
    fn end_changes(&mut self, ends: impl Fn(&Amplitude) -> bool, cx: &mut Context) {
        for contact in 0..self.under_way.len() {
            let curve = |change: &ChangeUnderWay| self.amplitudes.named.all.get(change.amplitude);
            let change = self.under_way[contact].take_if(|change| curve(change).is_some_and(&ends));
            if let Some(change) = change {
                self.check_end(&change, cx);
            }
        }
    }

    /// Reports a change that its amplitude has not completed at the end of the step before.
    fn check_end(&self, change: &ChangeUnderWay, cx: &mut Context) {
        let Some(curve) = self.amplitudes.named.all.get(change.amplitude) else {
            return;
        };
        let last = curve.at(match curve.time {
            TimeBase::Step => self.last_period,
            TimeBase::Total => self.start,
        });
        if (last - 1.0).abs() > AT_ITS_END {
            let message = format!(
                "this amplitude ends at {}, with a part of the change",
                shown(last)
            );
            cx.error(Code::ContactChange, change.span, message)
                .help("let it end at 1, and give under *FRICTION what the coefficient ends at");
        }
    }

    /// Removes or adds the contact pairs of the rows.
    fn model_change(&mut self, card: &Card, surfaces: &Surfaces, cx: &mut Context) {
        if card.required("TYPE", cx.d).is_none() || card.faulty {
            return;
        }
        let removes = card.has("REMOVE");
        if removes == card.has("ADD") {
            let message = "*MODEL CHANGE needs one of ADD and REMOVE";
            cx.error(Code::ContactChange, card.span, message);
            return;
        }
        for row in card.rows.iter() {
            let Some(contact) = self.pair(row, surfaces, cx) else {
                continue;
            };
            match (self.removed.binary_search(&contact), removes) {
                (Err(place), true) => self.removed.insert(place, contact),
                (Ok(place), false) => {
                    self.removed.remove(place);
                }
                (_, removes) => {
                    let done = if removes {
                        "removed already"
                    } else {
                        "not removed"
                    };
                    let message = format!("this pair is {done}: nothing changes");
                    cx.warning(Code::ContactChange, row.span(), message);
                }
            }
        }
    }

    /// The contact pair of a row `slave, master`, or `surface` for a surface in contact with itself.
    fn pair(&self, row: Line, surfaces: &Surfaces, cx: &mut Context) -> Option<usize> {
        row.at_most(2, cx.d);
        let find = |field: Text, cx: &mut Context| Some(surfaces.find(field, cx)?.0);
        let slave = row.required(0, "the slave surface", cx.d);
        let slave = slave.and_then(|field| find(field, cx));
        let master = match row.get(1) {
            Some(field) => find(field, cx),
            None => slave,
        };
        let (slave, master) = (slave?, master?);
        let is_pair = |contact: &Contact| (contact.slave, contact.master) == (slave, master);
        let found = self.contacts.iter().position(is_pair);
        if found.is_none() {
            let message = "these surfaces are no *CONTACT PAIR in this order";
            cx.error(Code::ContactChange, row.span(), message)
                .help("write slave and master as on the data line of *CONTACT PAIR");
        }
        found
    }
}

/// Reports an amplitude whose values lie outside the range from 0 to 1: these values are parts of a change of friction.
fn check_parts(curve: &Amplitude, span: Span, cx: &mut Context) {
    let [least, most] = curve.bounds();
    if least < 0.0 || most > 1.0 {
        let message = format!(
            "the values of this amplitude go from {} to {}",
            shown(least),
            shown(most)
        );
        cx.error(Code::ContactChange, span, message)
            .help("they are parts of the change of friction: 0 is none of it, 1 the whole");
    }
}
