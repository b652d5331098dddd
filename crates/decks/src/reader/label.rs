//! Labels of nodes and elements: the number in the deck and the instance of a part; maps and lists of labels.

use std::collections::BTreeMap;

/// Number of bits of a label that hold the number; the bits above hold the instance.
const NUMBER_BITS: u32 = 32;

/// Label of a node or element of the deck: its number and, in higher bits, the instance of a part.
pub(super) fn label(instance: u32, number: u64) -> u64 {
    (u64::from(instance) << NUMBER_BITS) | number
}

/// The number in a label.
pub(super) fn number_of(label: u64) -> u64 {
    label & ((1 << NUMBER_BITS) - 1)
}

/// The instance in a label; 0 outside instances.
pub(super) fn instance_of(label: u64) -> u32 {
    (label >> NUMBER_BITS) as u32
}

/// A map from labels. The map is small and fast for consecutive labels, which most meshes have.
#[derive(Debug, Clone)]
pub(super) struct LabelMap<T> {
    /// Runs of consecutive labels in increasing order: the first label, and the index of its value.
    runs: Vec<(u64, usize)>,
    /// Values of the labels of all runs.
    values: Vec<T>,
    /// The label behind the largest label of the runs.
    next: u64,
    /// Labels that were added after larger labels.
    others: BTreeMap<u64, T>,
}

impl<T> Default for LabelMap<T> {
    fn default() -> LabelMap<T> {
        LabelMap {
            runs: Vec::new(),
            values: Vec::new(),
            next: 0,
            others: BTreeMap::new(),
        }
    }
}

impl<T> LabelMap<T> {
    /// Value of a label.
    pub fn get(&self, label: u64) -> Option<&T> {
        match self.place(label) {
            Some(place) => self.values.get(place),
            None if self.others.is_empty() => None,
            None => self.others.get(&label),
        }
    }

    /// Sets the value of a label; returns the earlier value of the label.
    pub fn insert(&mut self, label: u64, value: T) -> Option<T> {
        if label < self.next {
            return match self.place(label) {
                Some(place) => Some(std::mem::replace(self.values.get_mut(place)?, value)),
                None => self.others.insert(label, value),
            };
        }
        if label > self.next || self.runs.is_empty() {
            self.runs.push((label, self.values.len()));
        }
        self.values.push(value);
        self.next = label + 1;
        None
    }

    /// Makes room for `count` more labels.
    pub fn reserve(&mut self, count: usize) {
        self.values.reserve(count);
    }

    /// All values in any order.
    pub fn values_mut(&mut self) -> impl Iterator<Item = &mut T> {
        self.values.iter_mut().chain(self.others.values_mut())
    }

    /// Index of the value of a label in the runs.
    fn place(&self, label: u64) -> Option<usize> {
        if label >= self.next {
            return None;
        }
        let run = self.runs.partition_point(|&(first, _)| first <= label);
        let &(first, place) = self.runs.get(run.checked_sub(1)?)?;
        let end = self
            .runs
            .get(run)
            .map_or(self.values.len(), |&(_, next)| next);
        let place = place + usize::try_from(label - first).ok()?;
        (place < end).then_some(place)
    }

    /// Labels from `first` to `last` with their values, in order.
    pub fn between(&self, first: u64, last: u64) -> Vec<(u64, &T)> {
        if last < first {
            return Vec::new();
        }
        let others = self.others.range(first..=last);
        let mut all: Vec<(u64, &T)> = others.map(|(&label, value)| (label, value)).collect();
        let is_sorted = all.is_empty();
        let before = self.runs.partition_point(|&(start, _)| start <= first);
        let ends = self.runs.iter().skip(1).map(|&(_, place)| place);
        let ends = ends.chain([self.values.len()]);
        let runs = self.runs.iter().zip(ends).skip(before.saturating_sub(1));
        for (&(start, place), end) in runs.take_while(|((start, _), _)| *start <= last) {
            let values = self.values.get(place..end).unwrap_or_default();
            let labelled = (start..).zip(values);
            let skipped = first.saturating_sub(start) as usize;
            all.extend(
                labelled
                    .skip(skipped)
                    .take_while(|(label, _)| *label <= last),
            );
        }
        if !is_sorted {
            all.sort_unstable_by_key(|(label, _)| *label);
        }
        all
    }
}

/// A list of labels in any order, which is small for consecutive labels.
#[derive(Debug, Clone, Default)]
pub(super) struct LabelList {
    /// Runs of consecutive labels: the first label of each, and the number of labels.
    runs: Vec<(u64, u64)>,
}

impl LabelList {
    /// Adds a label at the end.
    pub fn push(&mut self, label: u64) {
        match self.runs.last_mut() {
            Some((first, count)) if *first + *count == label => *count += 1,
            _ => self.runs.push((label, 1)),
        }
    }

    /// All labels in order.
    pub fn iter(&self) -> impl Iterator<Item = u64> + '_ {
        let runs = self.runs.iter();
        runs.flat_map(|&(first, count)| first..first + count)
    }

    /// Number of labels.
    pub fn len(&self) -> usize {
        self.runs.iter().map(|(_, count)| *count as usize).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_list_keeps_its_order() {
        let labels = [3, 4, 5, 9, 8, 7, 8, label(2, 1), label(2, 2)];
        let mut list = LabelList::default();
        labels.iter().for_each(|&label| list.push(label));
        assert!(list.iter().eq(labels) && list.len() == labels.len());
        assert_eq!(list.runs.len(), 5);
    }

    #[test]
    fn a_label_map_is_a_map_in_order() {
        let (mut ours, mut standard) = (LabelMap::default(), BTreeMap::new());
        let labels = [
            5,
            6,
            7,
            3,
            6,
            9,
            20,
            21,
            8,
            4,
            3,
            label(1, 1),
            22,
            label(1, 2),
        ];
        for (value, label) in labels.into_iter().enumerate() {
            assert_eq!(ours.insert(label, value), standard.insert(label, value));
        }
        for label in 0..30 {
            assert_eq!(ours.get(label), standard.get(&label), "{label}");
        }
        for (first, last) in [(0, u64::MAX), (6, 20), (4, 4), (10, 19), (21, 22), (23, 30)] {
            let expected: Vec<_> = standard.range(first..=last).map(|(&l, v)| (l, v)).collect();
            assert_eq!(ours.between(first, last), expected, "{first} to {last}");
        }
        assert!(ours.between(7, 6).is_empty());
    }
}
