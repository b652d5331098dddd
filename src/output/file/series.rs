//! Scalar time histories: tables of name, meaning and value, each entry a growing dataset of the
//! result file.

use hdf5::{Group, H5Type};

use super::dataset::{Column, Meaning, meaning};

/// A scalar of a report `R`: name, meaning and value.
pub(crate) type Scalar<R, T> = (&'static str, Meaning, fn(&R) -> T);

/// Shorthand for a [`Scalar`].
pub(crate) const fn scalar<R, T>(
    name: &'static str,
    description: &'static str,
    dimension: &'static str,
    value: fn(&R) -> T,
) -> Scalar<R, T> {
    (name, meaning(description, dimension), value)
}

/// A dataset and the value of a report `R` that it holds.
type Shown<R, T> = (Column<T>, fn(&R) -> T);

/// Datasets with one scalar of a report `R` each, a row per increment.
pub(crate) struct Series<R, T> {
    columns: Vec<Shown<R, T>>,
}

impl<R, T: H5Type + Copy> Series<R, T> {
    /// Creates one dataset per scalar.
    pub fn create(at: &Group, scalars: &[Scalar<R, T>]) -> hdf5::Result<Self> {
        let columns = (scalars.iter())
            .map(|&(name, text, value)| Ok((Column::series(at, name, &[], text)?, value)))
            .collect::<hdf5::Result<_>>()?;
        Ok(Series { columns })
    }

    /// Appends a row to each.
    pub fn push(&mut self, report: &R) -> hdf5::Result<()> {
        (self.columns.iter_mut()).try_for_each(|(column, value)| column.push([value(report)]))
    }

    /// Writes the buffered rows of each.
    pub fn flush(&mut self) -> hdf5::Result<()> {
        (self.columns.iter_mut()).try_for_each(|(column, _)| column.flush())
    }
}
