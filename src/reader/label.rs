//! Labels of nodes and elements: the number in the deck and the instance of a part.

/// Bits of a label that hold the number; those above hold the instance.
const NUMBER_BITS: u32 = 32;

/// What distinguishes the nodes and the elements of the deck: the number and, above it, the instance
/// of a part.
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
