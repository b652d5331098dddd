//! Lists whose memory is used again. Every pass drops the constraints of the last pass and makes new ones with about as
//! many points and dofs. A new list begins in the memory of a list that was dropped.

use std::cell::RefCell;
use std::fmt;
use std::ops::{Deref, DerefMut};
use std::thread::LocalKey;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Largest number of spare lists that a thread keeps for each type of entry.
const MOST_SPARE: usize = 1 << 16;

/// The spare lists of a thread.
type Spare<T> = RefCell<Vec<Vec<T>>>;

/// Type of the entries of recycled lists.
pub trait Entry: Copy + 'static {
    /// The spare lists of the current thread.
    fn spare() -> &'static LocalKey<Spare<Self>>;
}

/// Defines the spare lists of the given types.
macro_rules! entries {
    ($($kind:ty),* $(,)?) => {
        $(impl $crate::contact::lists::Entry for $kind {
            fn spare() -> &'static std::thread::LocalKey<std::cell::RefCell<Vec<Vec<Self>>>> {
                thread_local! {
                    static SPARE: std::cell::RefCell<Vec<Vec<$kind>>> = const { std::cell::RefCell::new(Vec::new()) };
                }
                &SPARE
            }
        })*
    };
}
pub(super) use entries;

entries!(f64, usize);

/// A list that begins in the memory of a list that was dropped in the same thread.
pub struct Recycled<T: Entry>(Vec<T>);

impl<T: Entry> Recycled<T> {
    /// An empty list with some memory, for entries that will be added.
    pub fn with_room() -> Self {
        let taken = T::spare().try_with(|spare| spare.borrow_mut().pop());
        Recycled(taken.ok().flatten().unwrap_or_default())
    }
}

impl<T: Entry> Drop for Recycled<T> {
    fn drop(&mut self) {
        if self.0.capacity() == 0 {
            return;
        }
        let mut list = std::mem::take(&mut self.0);
        list.clear();
        // a thread that ends has lost its lists already
        let _ = T::spare().try_with(|spare| {
            let mut spare = spare.borrow_mut();
            if spare.len() < MOST_SPARE {
                spare.push(list);
            }
        });
    }
}

/// An empty list without memory.
impl<T: Entry> Default for Recycled<T> {
    fn default() -> Self {
        Recycled(Vec::new())
    }
}

impl<T: Entry> Clone for Recycled<T> {
    fn clone(&self) -> Self {
        match self.is_empty() {
            true => Recycled::default(),
            false => self.iter().copied().collect(),
        }
    }
}

impl<T: Entry> FromIterator<T> for Recycled<T> {
    fn from_iter<I: IntoIterator<Item = T>>(entries: I) -> Self {
        let mut list = Recycled::with_room();
        list.extend(entries);
        list
    }
}

impl<T: Entry> Deref for Recycled<T> {
    type Target = Vec<T>;

    fn deref(&self) -> &Vec<T> {
        &self.0
    }
}

impl<T: Entry> DerefMut for Recycled<T> {
    fn deref_mut(&mut self) -> &mut Vec<T> {
        &mut self.0
    }
}

impl<T: Entry + PartialEq> PartialEq for Recycled<T> {
    fn eq(&self, other: &Self) -> bool {
        self.0 == other.0
    }
}

impl<T: Entry + fmt::Debug> fmt::Debug for Recycled<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl<T: Entry + Serialize> Serialize for Recycled<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl<'de, T: Entry + Deserialize<'de>> Deserialize<'de> for Recycled<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Vec::deserialize(deserializer).map(Recycled)
    }
}

/// Number of values that are stored in place: one for each of the eight dofs of a corner.
pub(super) const IN_PLACE: usize = 8;

/// One value for every dof of a constraint: up to eight values (corner) are stored in place, more values in a list.
#[derive(Clone)]
pub enum PerDof<T: Entry> {
    /// Up to eight values, in place, and their number.
    Short([T; IN_PLACE], usize),
    /// More than eight values, in a list.
    Long(Recycled<T>),
}

impl<T: Entry + Default> PerDof<T> {
    /// The values of `N` dofs, with N at most 8.
    #[inline]
    pub(super) fn of<const N: usize>(values: [T; N]) -> Self {
        const { assert!(N <= IN_PLACE) };
        let mut all = [T::default(); IN_PLACE];
        all[..N].copy_from_slice(&values);
        PerDof::Short(all, N)
    }

    /// `count` zeros.
    pub(super) fn zeros(count: usize) -> Self {
        std::iter::repeat_n(T::default(), count).collect()
    }
}

impl<T: Entry + Default> FromIterator<T> for PerDof<T> {
    #[inline]
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Self {
        let (mut first, mut count) = ([T::default(); IN_PLACE], 0);
        let mut values = values.into_iter();
        while let Some(value) = values.next() {
            if count == IN_PLACE {
                let all = first.into_iter().chain([value]).chain(values);
                return PerDof::Long(all.collect());
            }
            first[count] = value;
            count += 1;
        }
        PerDof::Short(first, count)
    }
}

impl<T: Entry> Deref for PerDof<T> {
    type Target = [T];

    #[inline]
    fn deref(&self) -> &[T] {
        match self {
            PerDof::Short(values, count) => &values[..*count],
            PerDof::Long(values) => values,
        }
    }
}

impl<T: Entry> DerefMut for PerDof<T> {
    #[inline]
    fn deref_mut(&mut self) -> &mut [T] {
        match self {
            PerDof::Short(values, count) => &mut values[..*count],
            PerDof::Long(values) => values,
        }
    }
}

impl<'a, T: Entry> IntoIterator for &'a PerDof<T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    #[inline]
    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<T: Entry + PartialEq> PartialEq for PerDof<T> {
    fn eq(&self, other: &Self) -> bool {
        self[..] == other[..]
    }
}

impl<T: Entry + fmt::Debug> fmt::Debug for PerDof<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self[..].fmt(f)
    }
}

impl<T: Entry + Serialize> Serialize for PerDof<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self[..].serialize(serializer)
    }
}

impl<'de, T: Entry + Default + Deserialize<'de>> Deserialize<'de> for PerDof<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let values: Vec<T> = Vec::deserialize(deserializer)?;
        Ok(values.into_iter().collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_begins_in_the_memory_of_the_last_one() {
        let first: Recycled<f64> = (0..40).map(f64::from).collect();
        let place = first.as_ptr();
        drop(first);
        let second = Recycled::<f64>::with_room();
        assert!(second.is_empty());
        assert_eq!((second.as_ptr(), second.capacity() >= 40), (place, true));
        assert_eq!(Recycled::<f64>::default().capacity(), 0);
    }

    #[test]
    fn values_per_dof_are_the_same_in_place_and_in_a_list() {
        for count in [0, 3, IN_PLACE, IN_PLACE + 1, 30] {
            let values: Vec<usize> = (0..count).collect();
            let mut all: PerDof<usize> = values.iter().copied().collect();
            assert_eq!(all[..], values[..]);
            assert_eq!(matches!(all, PerDof::Short(..)), count <= IN_PLACE);
            let text = serde_json::to_string(&all).expect("text");
            assert_eq!(text, serde_json::to_string(&values).expect("text"));
            let read: PerDof<usize> = serde_json::from_str(&text).expect("read");
            assert_eq!(read, all);
            all.iter_mut().for_each(|value| *value += 1);
            assert_eq!(all == read, count == 0);
        }
    }
}
