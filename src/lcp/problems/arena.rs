//! Lists of a solve. They lie one behind the other in an arena, which the next solve uses again, so that the solves of
//! the passes take no memory from the system.

use bumpalo::Bump;

/// A list in an arena.
pub(crate) type List<'a, T> = bumpalo::collections::Vec<'a, T>;

/// A list of all that comes.
pub(crate) fn list<T>(arena: &Bump, values: impl IntoIterator<Item = T>) -> List<'_, T> {
    List::from_iter_in(values, arena)
}

/// A list of the same values.
pub(crate) fn copy<'a, T: Copy>(arena: &'a Bump, values: &[T]) -> List<'a, T> {
    let mut list = List::with_capacity_in(values.len(), arena);
    list.extend_from_slice_copy(values);
    list
}

/// A list of so many times the same value.
pub(crate) fn filled<T: Copy>(arena: &Bump, value: T, length: usize) -> List<'_, T> {
    bumpalo::vec![in arena; value; length]
}
