//! Building blocks of the result file: HDF5 groups, attributes and constant datasets.

use hdf5::types::VarLenUnicode;
use hdf5::{Attribute, Dataset, Group, H5Type, Location};

/// The attribute of `/history`, and of its groups of events, that counts their complete rows.
pub(crate) const ROWS: &str = "rows";

/// What a dataset holds: its attributes `description` and `dimension`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Meaning {
    /// One sentence.
    pub description: &'static str,
    /// Dimension of the values, such as "length/time"; "1" for a pure number.
    pub dimension: &'static str,
}

/// Shorthand for a [`Meaning`].
pub(crate) const fn meaning(description: &'static str, dimension: &'static str) -> Meaning {
    Meaning {
        description,
        dimension,
    }
}

/// Creates a group that stores no modification time.
pub(crate) fn group(parent: &Group, name: &str) -> hdf5::Result<Group> {
    parent
        .create_group_builder()
        .obj_track_times(false)
        .create(name)
}

/// Writes the text attribute `name`; a NUL, which HDF5 cannot hold, becomes U+FFFD.
pub(crate) fn text_attribute(at: &Location, name: &str, text: &str) -> hdf5::Result<()> {
    set_attribute(at, name, unicode(text)?)
}

fn unicode(text: &str) -> hdf5::Result<VarLenUnicode> {
    let clean = text.replace('\0', "\u{fffd}");
    (clean.parse()).map_err(|_| hdf5::Error::from("text with a NUL character"))
}

/// Writes the scalar attribute `name`, a new one or over the old value.
pub(crate) fn set_attribute<T: H5Type>(at: &Location, name: &str, value: T) -> hdf5::Result<()> {
    if let Ok(attribute) = at.attr(name) {
        return attribute.write_scalar(&value);
    }
    at.new_attr::<T>().create(name)?.write_scalar(&value)
}

/// Creates the attribute `name`, a number by which readers go: it is written after all that it counts.
pub(crate) fn counter(at: &Location, name: &str) -> hdf5::Result<Attribute> {
    let count = at.new_attr::<i64>().create(name)?;
    count.write_scalar(&0_i64)?;
    Ok(count)
}

/// Writes a dataset that never changes; the shape's product is the length of `data`.
pub(crate) fn constant<T: H5Type>(
    parent: &Group,
    name: &str,
    shape: &[usize],
    data: &[T],
    meaning: Meaning,
) -> hdf5::Result<()> {
    let dataset = parent
        .new_dataset_builder()
        .empty::<T>()
        .shape(shape.to_vec())
        .obj_track_times(false)
        .create(name)?;
    describe(&dataset, meaning)?;
    if !data.is_empty() {
        dataset.write_raw(data)?;
    }
    Ok(())
}

/// Gives a new dataset its two attributes.
pub(super) fn describe(dataset: &Dataset, meaning: Meaning) -> hdf5::Result<()> {
    let Meaning {
        description,
        dimension,
    } = meaning;
    for (name, text) in [("description", description), ("dimension", dimension)] {
        let attribute = dataset.new_attr::<VarLenUnicode>().create(name)?;
        attribute.write_scalar(&unicode(text)?)?;
    }
    Ok(())
}
