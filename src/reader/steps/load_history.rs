//! Loads as they are carried from step to step.

use crate::deck::Card;
use crate::diagnostics::{Code, Diagnostic};
use crate::model::{Amplitude, Face, Load, TimeBase, Variation};
use crate::reader::context::Context;

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
    /// The first ones, `sorted` of them, in the order of their keys; then those added since.
    parts: Vec<(K, Part<T>)>,
    sorted: usize,
}

#[derive(Clone, Copy)]
struct Part<T> {
    load: Load<T>,
    /// Magnitude at the end of the step before.
    end: f64,
    /// Step that gave it.
    step: u32,
    /// Whether another one has taken its place.
    replaced: bool,
}

impl<K, T> Default for LoadHistory<K, T> {
    fn default() -> Self {
        LoadHistory {
            parts: Vec::new(),
            sorted: 0,
        }
    }
}

impl<K: Ord + Copy, T: Copy + PartialEq> LoadHistory<K, T> {
    /// All loads of the current step, in the order of their keys; nothing remains after the last
    /// step.
    pub fn list(&mut self, is_last: bool) -> Vec<Load<T>> {
        self.sort();
        let simple = |part: &Part<T>| {
            let load = part.load;
            load.ends().map_or(load, |ends| load.between(ends))
        };
        match is_last {
            // within the same memory
            true => {
                let parts = std::mem::take(self).parts.into_iter();
                parts.map(|(_, part)| simple(&part)).collect()
            }
            false => self.parts.iter().map(|(_, part)| simple(part)).collect(),
        }
    }

    /// Removes all loads; where loads ramp they fade out over the step.
    pub fn clear(&mut self, context: StepContext) {
        if !context.ramp {
            *self = LoadHistory::default();
        }
        for (_, part) in &mut self.parts {
            part.fade();
        }
    }

    /// Makes room for so many loads more.
    pub fn reserve(&mut self, count: usize) {
        self.parts.reserve(count);
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
        let mut from = 0.0;
        let ramps = context.ramp && amplitude.is_none();
        for part in self.earlier(key, context) {
            if ramps && part.load.at != at {
                part.fade();
            } else {
                from += part.end;
                part.replaced = true;
            }
        }
        let part = Part::new(at, magnitude, amplitude, context);
        self.parts.push((key, part.rising_from(from)));
    }

    /// Parts of earlier steps under a key.
    fn earlier(&mut self, key: K, context: StepContext) -> impl Iterator<Item = &mut Part<T>> {
        let sorted = self.parts.get(..self.sorted).unwrap_or_default();
        let first = sorted.partition_point(|(known, _)| *known < key);
        let parts = self.parts.iter_mut().skip(first);
        parts
            .take_while(move |(known, _)| *known == key)
            .map(|(_, part)| part)
            .filter(move |part| (part.step as usize) < context.step && !part.replaced)
    }

    /// Leaves out parts that are replaced, and puts the others in the order of their keys.
    fn sort(&mut self) {
        self.parts.retain(|(_, part)| !part.replaced);
        if !self.parts.is_sorted_by_key(|(key, _)| *key) {
            self.parts.sort_by_key(|(key, _)| *key);
        }
        self.sorted = self.parts.len();
    }

    /// Ends a step: loads keep the magnitude they have reached, unless they follow the total time.
    pub fn end_step(&mut self, period: f64, total: f64, amplitudes: &[Amplitude]) {
        self.sort();
        for (_, part) in &mut self.parts {
            part.end_step(period, total, amplitudes);
        }
        for parts in self.parts.chunk_by_mut(|(a, _), (b, _)| a == b) {
            add_up(parts);
        }
        let acts = |part: &Part<T>| !part.replaced && part.load.magnitude != 0.0;
        self.parts.retain(|(_, part)| acts(part));
        self.sorted = self.parts.len();
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
fn add_up<K, T: Copy + PartialEq>(parts: &mut [(K, Part<T>)]) {
    for index in 1..parts.len() {
        let (before, after) = parts.split_at_mut(index);
        let Some((_, part)) = after.first_mut() else {
            return;
        };
        let joins = |sum: &Part<T>| {
            let both = [sum.load.variation, part.load.variation];
            sum.load.at == part.load.at && both == [Variation::Constant; 2]
        };
        let mut sums = before.iter_mut().map(|(_, sum)| sum);
        if let Some(sum) = sums.find(|sum| !sum.replaced && joins(sum)) {
            sum.load.magnitude += part.load.magnitude;
            sum.end += part.end;
            part.replaced = true;
        }
    }
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
            end: 0.0,
            step: context.step as u32,
            replaced: false,
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
