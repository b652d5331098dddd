//! Loads as they are carried from step to step.

use crate::deck::Card;
use crate::diagnostics::{Code, Diagnostic};
use crate::model::{Amplitude, Face, Load, TimeBase, Variation};
use crate::reader::context::Context;
use smallvec::{SmallVec, smallvec};
use std::collections::BTreeMap;

/// How a load without amplitude reaches its magnitude, and the step it is given in.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StepContext {
    /// Number of the step, from 1; 0 is model data.
    pub step: usize,
    /// Whether loads without amplitude grow linearly (`*STEP, AMPLITUDE=RAMP`).
    pub ramp: bool,
}

/// Whether a step keeps the loads of earlier steps (`OP`); the first card of its kind decides.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Operation {
    step: usize,
    new: bool,
}

impl Operation {
    /// Enters a card; true if it removes all loads of earlier steps.
    pub fn starts_anew(&mut self, card: &Card, step: usize, cx: &mut Context) -> bool {
        let typed = card.choice("OP");
        let new = typed == Some("NEW");
        if self.step == step {
            if typed.is_some() && new != self.new {
                let message = format!("OP of the first {} in this step holds", card.title());
                let span = card.span_of("OP");
                cx.d.push(Diagnostic::warning(Code::MixedOperation, span, message));
            }
            return false;
        }
        *self = Operation { step, new };
        new
    }
}

/// Loads of one kind by their keys.
pub(crate) struct LoadHistory<K, T> {
    parts: BTreeMap<K, SmallVec<[Part<T>; 1]>>,
}

#[derive(Clone, Copy)]
struct Part<T> {
    load: Load<T>,
    /// Step that gave it.
    step: usize,
    /// Magnitude at the end of the step before.
    end: f64,
}

impl<K, T> Default for LoadHistory<K, T> {
    fn default() -> Self {
        LoadHistory {
            parts: BTreeMap::new(),
        }
    }
}

impl<K: Ord + Copy, T: Copy + PartialEq> LoadHistory<K, T> {
    /// All loads of the current step.
    pub fn list(&self) -> Vec<Load<T>> {
        let mut list = Vec::with_capacity(self.parts.len());
        let as_simple = |load: Load<T>| load.ends().map_or(load, |ends| load.between(ends));
        let parts = self.parts.values().flatten();
        list.extend(parts.map(|part| as_simple(part.load)));
        list
    }

    /// Removes all loads; where loads ramp they fade out over the step.
    pub fn clear(&mut self, context: StepContext) {
        if !context.ramp {
            self.parts.clear();
        }
        for part in self.parts.values_mut().flatten() {
            part.fade();
        }
    }

    /// Adds a load; it replaces those of earlier steps under the same key.
    pub fn add(
        &mut self,
        key: K,
        at: T,
        magnitude: f64,
        amplitude: Option<usize>,
        context: StepContext,
    ) {
        let parts = self.parts.entry(key).or_default();
        let mut from = 0.0;
        if context.ramp && amplitude.is_none() {
            for part in parts.iter_mut().filter(|part| part.step < context.step) {
                match part.load.at == at {
                    true => from += part.end,
                    false => part.fade(),
                }
            }
            parts.retain(|part| part.step == context.step || part.load.at != at);
        } else {
            parts.retain(|part| part.step == context.step);
        }
        let part = Part::new(at, magnitude, amplitude, context);
        parts.push(part.rising_from(from));
    }

    /// Adds a load under each key, as [`Self::add`]; no key may appear twice.
    pub fn add_all(
        &mut self,
        loads: impl Iterator<Item = (K, T)>,
        magnitude: f64,
        amplitude: Option<usize>,
        context: StepContext,
    ) {
        if self.parts.is_empty() {
            let part = |at| Part::new(at, magnitude, amplitude, context);
            let parts = loads.map(|(key, at)| (key, smallvec![part(at)]));
            self.parts = parts.collect();
            return;
        }
        for (key, at) in loads {
            self.add(key, at, magnitude, amplitude, context);
        }
    }

    /// Ends a step: loads keep the magnitude they have reached, unless they follow the total time.
    pub fn end_step(&mut self, period: f64, total: f64, amplitudes: &[Amplitude]) {
        for part in self.parts.values_mut().flatten() {
            part.end_step(period, total, amplitudes);
        }
        self.parts.retain(|_, parts| {
            add_up(parts);
            parts.retain(|part| part.load.magnitude != 0.0);
            !parts.is_empty()
        });
    }
}

/// Loads on faces in the order of the faces, on each those without amplitude first, which are one load where
/// they have one direction.
pub(super) fn joined<T: Copy + PartialEq>(
    mut loads: Vec<Load<T>>,
    face: fn(&Load<T>) -> Face,
) -> Vec<Load<T>> {
    loads.sort_by_key(|load| (face(load), load.ends().is_none()));
    let mut all: Vec<Load<T>> = Vec::with_capacity(loads.len());
    for load in loads {
        let before = all.iter_mut().rev();
        let mut on_face = before.take_while(|known| face(known) == face(&load));
        let same = on_face.find(|known| known.at == load.at && known.ends().is_some());
        match same.and_then(|known| Some((known.ends()?, load.ends()?, known))) {
            Some(([from, to], [more, end], known)) => {
                *known = known.between([from + more, to + end]);
            }
            None => all.push(load),
        }
    }
    all
}

/// Joins constant loads at the same place and in the same direction.
fn add_up<T: Copy + PartialEq>(parts: &mut SmallVec<[Part<T>; 1]>) {
    let mut sums: SmallVec<[Part<T>; 1]> = SmallVec::new();
    for part in parts.drain(..) {
        let joins = |sum: &&mut Part<T>| {
            let both = [sum.load.variation, part.load.variation];
            sum.load.at == part.load.at && both == [Variation::Constant; 2]
        };
        match sums.iter_mut().find(joins) {
            Some(sum) => {
                sum.load.magnitude += part.load.magnitude;
                sum.end += part.end;
            }
            None => sums.push(part),
        }
    }
    *parts = sums;
}

impl<T> Part<T> {
    /// A load that reaches its magnitude from zero where it ramps.
    fn new(at: T, magnitude: f64, amplitude: Option<usize>, context: StepContext) -> Part<T> {
        let variation = match amplitude {
            Some(index) => Variation::Amplitude(index),
            None if context.ramp => Variation::Ramp { from: 0.0 },
            None => Variation::Constant,
        };
        let load = Load {
            at,
            magnitude,
            variation,
        };
        Part {
            load,
            step: context.step,
            end: 0.0,
        }
    }

    /// The same load, from another magnitude where it ramps.
    fn rising_from(mut self, from: f64) -> Part<T> {
        if let Variation::Ramp { .. } = self.load.variation {
            self.load.variation = Variation::Ramp { from };
        }
        self
    }

    fn fade(&mut self) {
        self.load.magnitude = 0.0;
        self.load.variation = Variation::Ramp { from: self.end };
    }

    fn end_step(&mut self, period: f64, total: f64, amplitudes: &[Amplitude]) {
        let load = &mut self.load;
        let curve = match load.variation {
            Variation::Amplitude(index) => amplitudes.get(index),
            Variation::Constant | Variation::Ramp { .. } => None,
        };
        match curve {
            Some(curve) if curve.time == TimeBase::Total => {
                self.end = load.magnitude * curve.at(total);
                return;
            }
            Some(curve) => load.magnitude *= curve.at(period),
            None => {}
        }
        load.variation = Variation::Constant;
        self.end = load.magnitude;
    }
}
