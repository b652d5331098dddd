//! Loads of a step: the cards that lead to them from the loads of the step before.

use super::lines::{Lines, named, number, set};
use super::mesh::elements_field;
use crate::model::{
    Amplitude, BodyForce, Load, Model, PointLoad, Pressure, Step, TimeBase, Traction, Variation,
};
use std::collections::HashMap;

/// A load as it stands in a data line.
#[derive(Clone, PartialEq)]
struct Entry {
    /// Loaded element, for body forces.
    element: Option<usize>,
    /// Node, unless an element is loaded.
    target: String,
    /// What acts there.
    kind: String,
    /// Fields after the magnitude.
    direction: Vec<String>,
    /// Whether it is a traction.
    is_traction: bool,
    magnitude: f64,
    variation: Variation,
}

/// Loads of the keywords `*CLOAD` and `*DLOAD`.
#[derive(Default)]
pub(super) struct Loads([Vec<Entry>; 2]);

impl Loads {
    /// The loads of a step.
    pub fn of(step: &Step, model: &Model) -> Loads {
        let points = step.point_loads.iter().map(|load| point_load(load, model));
        let bodies = step.body_forces.iter().map(body_force);
        let pressures = step.pressures.iter().map(|load| pressure(load, model));
        let tractions = step.tractions.iter().map(|load| traction(load, model));
        Loads([
            points.collect(),
            bodies.chain(pressures).chain(tractions).collect(),
        ])
    }

    /// Whether loads grow over the step (`*STEP, AMPLITUDE=RAMP`).
    pub fn ramp(&self) -> bool {
        let mut all = self.0.iter().flatten();
        all.any(|entry| matches!(entry.variation, Variation::Ramp { .. }))
    }

    /// Writes the cards of a step that begins with the loads `carried` from the step before.
    pub fn write(&self, carried: &Loads, model: &Model, lines: &mut Lines) {
        let families = self.0.iter().zip(&carried.0);
        for (keyword, (now, carried)) in ["CLOAD", "DLOAD"].into_iter().zip(families) {
            if now == carried {
                continue;
            }
            // Where loads ramp, OP=NEW would fade those that stay.
            let is_new = !carried.is_empty() && !self.ramp();
            let operation = is_new.then(|| set("OP", "NEW"));
            let entries = match is_new {
                true => now.clone(),
                false => at_changed_places(now, carried),
            };
            write_cards(keyword, operation, &grouped(entries, model), model, lines);
        }
    }

    /// The loads that a step of duration `period` leaves to the next one.
    pub fn carried(&self, period: f64, amplitudes: &[Amplitude]) -> Loads {
        let carry = |entries: &Vec<Entry>| {
            let mut carried: Vec<Entry> = Vec::new();
            for entry in entries {
                add(entry.carried(period, amplitudes), &mut carried);
            }
            carried.retain(|entry| entry.magnitude != 0.0);
            carried
        };
        let [points, elements] = &self.0;
        Loads([carry(points), carry(elements)])
    }
}

/// Element or target, and what acts there.
type Key<'e> = (Option<usize>, &'e str, &'e str);

impl Entry {
    fn key(&self) -> Key<'_> {
        (self.element, &self.target, &self.kind)
    }

    fn new<T>(target: String, kind: impl Into<String>, load: &Load<T>) -> Entry {
        Entry {
            element: None,
            target,
            kind: kind.into(),
            direction: Vec::new(),
            is_traction: false,
            magnitude: load.magnitude,
            variation: load.variation,
        }
    }

    /// The load at the end of a step: it keeps what it has reached, unless it follows the total time.
    fn carried(&self, period: f64, amplitudes: &[Amplitude]) -> Entry {
        let mut carried = self.clone();
        if let Variation::Amplitude(index) = self.variation {
            let curve = &amplitudes[index];
            if curve.time == TimeBase::Total {
                return carried;
            }
            carried.magnitude *= curve.at(period);
        }
        carried.variation = Variation::Constant;
        carried
    }

    fn amplitude(&self) -> Option<usize> {
        match self.variation {
            Variation::Amplitude(index) => Some(index),
            Variation::Constant | Variation::Ramp { .. } => None,
        }
    }
}

fn point_load(load: &Load<PointLoad>, model: &Model) -> Entry {
    let PointLoad { dof } = load.at;
    let label = model.mesh.node_labels[dof / 2];
    Entry::new(label.to_string(), (dof % 2 + 1).to_string(), load)
}

fn body_force(load: &Load<BodyForce>) -> Entry {
    let BodyForce {
        element,
        direction,
        per_mass,
    } = load.at;
    let kind = match (per_mass, direction[0] != 0.0) {
        (true, _) => "GRAV",
        (false, true) => "BX",
        (false, false) => "BY",
    };
    Entry {
        element: Some(element),
        direction: if per_mass {
            direction.map(number).to_vec()
        } else {
            Vec::new()
        },
        ..Entry::new(String::new(), kind, load)
    }
}

fn pressure(load: &Load<Pressure>, model: &Model) -> Entry {
    let Pressure { face } = load.at;
    let label = model.mesh.elements[face.element].label;
    Entry::new(label.to_string(), format!("P{}", face.side + 1), load)
}

fn traction(load: &Load<Traction>, model: &Model) -> Entry {
    let Traction { face, direction } = load.at;
    let label = model.mesh.elements[face.element].label;
    Entry {
        direction: direction.map(number).to_vec(),
        is_traction: true,
        ..Entry::new(label.to_string(), format!("TRVEC{}", face.side + 1), load)
    }
}

/// Adds a load; constant loads at the same place and in the same direction are joined.
fn add(entry: Entry, entries: &mut Vec<Entry>) {
    let joins = |known: &&mut Entry| {
        let magnitude = known.magnitude;
        let is_constant = known.variation == Variation::Constant;
        is_constant
            && **known
                == Entry {
                    magnitude,
                    ..entry.clone()
                }
    };
    let mut of_key = entries
        .iter_mut()
        .rev()
        .take_while(|known| known.key() == entry.key());
    match of_key.find(joins) {
        Some(known) => known.magnitude += entry.magnitude,
        None => entries.push(entry),
    }
}

/// All loads of the places where they are not those of the step before: a load that ramps takes the place
/// of all that were there.
fn at_changed_places(entries: &[Entry], carried: &[Entry]) -> Vec<Entry> {
    let (now, before) = (by_key(entries), by_key(carried));
    let is_changed = |entry: &&Entry| {
        let key = entry.key();
        now.get(&key) != before.get(&key)
    };
    entries.iter().filter(is_changed).cloned().collect()
}

fn by_key(entries: &[Entry]) -> HashMap<Key<'_>, Vec<&Entry>> {
    let mut by_key: HashMap<Key, Vec<&Entry>> = HashMap::new();
    for entry in entries {
        by_key.entry(entry.key()).or_default().push(entry);
    }
    by_key
}

/// Loads with body forces that are alike in one entry, where they act on all elements or on a set.
fn grouped(entries: Vec<Entry>, model: &Model) -> Vec<Entry> {
    let mut groups: Vec<(Entry, Vec<usize>)> = Vec::new();
    let mut rest = Vec::new();
    for entry in entries {
        let Some(element) = entry.element else {
            rest.push(entry);
            continue;
        };
        let alike = Entry {
            element: None,
            ..entry
        };
        match groups.iter_mut().find(|(known, _)| *known == alike) {
            Some((_, elements)) => elements.push(element),
            None => groups.push((alike, vec![element])),
        }
    }
    let written = groups.into_iter().flat_map(|(entry, elements)| {
        let field = elements_field(&elements, model);
        let targets = field.map_or_else(
            || {
                elements
                    .iter()
                    .map(|&e| model.mesh.elements[e].label.to_string())
                    .collect()
            },
            |field| vec![field],
        );
        targets.into_iter().map(move |target| Entry {
            target,
            ..entry.clone()
        })
    });
    written.chain(rest).collect()
}

/// Writes loads, those with the same parameters under one card; a card without loads removes all.
fn write_cards(
    keyword: &str,
    operation: Option<String>,
    entries: &[Entry],
    model: &Model,
    lines: &mut Lines,
) {
    let card = |first: Option<&Entry>, lines: &mut Lines| {
        let amplitude = first
            .and_then(Entry::amplitude)
            .map(|index| &model.amplitudes[index]);
        let amplitude = amplitude.map(|amplitude| named("AMPLITUDE", &amplitude.name));
        let is_dead = first.is_some_and(|entry| entry.is_traction);
        let follower = is_dead.then(|| set("FOLLOWER", "NO"));
        let parameters = operation.iter().cloned().chain(amplitude).chain(follower);
        lines.card_of(keyword, &parameters.collect::<Vec<_>>());
    };
    if entries.is_empty() {
        card(None, lines);
    }
    let alike =
        |a: &Entry, b: &Entry| a.amplitude() == b.amplitude() && a.is_traction == b.is_traction;
    for entries in entries.chunk_by(alike) {
        card(entries.first(), lines);
        for entry in entries {
            let fields = [
                entry.target.clone(),
                entry.kind.clone(),
                number(entry.magnitude),
            ];
            lines.row(fields.into_iter().chain(entry.direction.iter().cloned()));
        }
    }
}
