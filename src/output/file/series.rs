//! Scalar time histories: tables of name, meaning and value, each entry a growing dataset of the
//! result file.

use hdf5::Group;

use super::column::{Column, Columns, Growing, Value};
use super::dataset::{Meaning, meaning};

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

/// Datasets with one scalar of a report `R` each, a row per increment or event.
pub(crate) struct Series<R, T> {
    columns: Vec<Shown<R, T>>,
}

impl<R, T: Value> Series<R, T> {
    /// Creates one dataset per scalar.
    pub fn create(at: &Group, scalars: &[Scalar<R, T>]) -> hdf5::Result<Self> {
        let columns = (scalars.iter())
            .map(|&(name, text, value)| Ok((Column::series(at, name, &[], text)?, value)))
            .collect::<hdf5::Result<_>>()?;
        Ok(Series { columns })
    }

    /// Creates one dataset per scalar, with a row per event.
    pub fn of_events(at: &Group, scalars: &[Scalar<R, T>]) -> hdf5::Result<Self> {
        let columns = (scalars.iter())
            .map(|&(name, text, value)| Ok((Column::events(at, name, &[], text)?, value)))
            .collect::<hdf5::Result<_>>()?;
        Ok(Series { columns })
    }

    /// Appends a row to each.
    pub fn push(&mut self, report: &R) {
        for (column, value) in &mut self.columns {
            column.push([value(report)]);
        }
    }

    /// Its datasets.
    pub fn columns<'a>(&'a mut self, all: &mut Columns<'a>) {
        all.extend(growing(&mut self.columns));
    }
}

/// The datasets of a table.
pub(crate) fn growing<'a, T: Value, V>(
    table: &'a mut [(Column<T>, V)],
) -> impl Iterator<Item = &'a mut dyn Growing> + use<'a, T, V> {
    (table.iter_mut()).map(|(column, _)| -> &mut dyn Growing { column })
}
