//! `*CHANGE FRICTION` and `*MODEL CHANGE`: the contacts of a deck from step to step.

use super::contact::friction_of;
use super::context::Context;
use super::loads::StepContext;
use super::surfaces::Surfaces;
use crate::deck::{Card, Line, Text};
use crate::diagnostics::Code;
use crate::model::{Contact, ContactChanges, Friction, FrictionChange};

/// What the steps so far have made of the contacts.
pub(crate) struct ContactHistory<'a> {
    contacts: &'a [Contact],
    /// Friction of each at the end of the last step.
    friction: Vec<Friction>,
    /// Those that do not act, increasing.
    removed: Vec<usize>,
}

impl<'a> ContactHistory<'a> {
    /// Contacts before the first step.
    pub fn new(contacts: &'a [Contact]) -> Self {
        let friction = |contact: &Contact| contact.interaction.friction.clone();
        ContactHistory {
            contacts,
            friction: contacts.iter().map(friction).collect(),
            removed: Vec::new(),
        }
    }

    /// Takes in the cards of a step; gives what is different in it.
    pub fn step(
        &mut self,
        cards: &[&Card],
        context: StepContext,
        surfaces: &Surfaces,
        cx: &mut Context,
    ) -> ContactChanges {
        let before = self.friction.clone();
        for (index, card) in cards.iter().enumerate() {
            match card.keyword.name {
                "CHANGE FRICTION" => {
                    let next = cards.get(index + 1).copied();
                    let given = next.filter(|next| next.keyword.name == "FRICTION");
                    self.change_friction(card, given, cx);
                }
                "MODEL CHANGE" => self.model_change(card, surfaces, cx),
                _ => {}
            }
        }
        let numbered = self.contacts.iter().zip(before).enumerate();
        let changes = numbered.filter_map(|(contact, (own, before))| {
            let friction = self.friction[contact].clone();
            let ramps = context.ramp && before.ramps_to(&friction);
            let differs = ramps || friction != own.interaction.friction;
            differs.then(|| FrictionChange {
                contact,
                friction,
                from: ramps.then_some(before),
            })
        });
        ContactChanges {
            removed: self.removed.clone(),
            friction: changes.collect(),
        }
    }

    /// The friction under `*CHANGE FRICTION` for the contacts of an interaction, or with RESET that of the model.
    fn change_friction(&mut self, card: &Card, given: Option<&Card>, cx: &mut Context) {
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
        let mut found = false;
        for (contact, now) in self.contacts.iter().zip(&mut self.friction) {
            if wanted.key == contact.interaction.name {
                found = true;
                let own = &contact.interaction.friction;
                *now = friction.clone().unwrap_or_else(|| own.clone());
            }
        }
        if !found {
            let mut known: Vec<&str> = (self.contacts.iter())
                .map(|contact| contact.interaction.name.as_str())
                .filter(|name| !name.is_empty())
                .collect();
            known.dedup();
            cx.undefined("surface interaction of a contact", name, known.into_iter());
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

    /// The contact pair of a row `slave, master`, or `surface` where it touches itself.
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
