//! The fields of nodes and those of cells, and where each frame starts in them.

use hdf5::Group;

use crate::output::file::column::{Column, Growing, Mostly, Row, Value};
use crate::output::file::dataset::{Meaning, group, meaning};

/// Row of a field of scalars.
pub(super) const SCALAR: Row = Row {
    shape: &[],
    given: 1,
};
/// Row of a field of symmetric tensors in the plane: xx yy xy.
pub(super) const PLANE_TENSOR: Row = Row {
    shape: &[3],
    given: 3,
};
/// Row of a field of vectors in the plane, whose third component is zero.
pub(super) const IN_SPACE: Row = Row {
    shape: &[3],
    given: 2,
};

pub(super) const OFFSETS: Meaning = meaning("first row of the frame", "1");

/// Most frames of a chunk: each chunk costs a call of the system.
const CHUNK_FRAMES: usize = 32;

/// The groups of one kind of fields: `PointData` or `CellData`.
pub(super) struct Place {
    pub data: Group,
    pub offsets: Offsets,
}

/// First rows of the frames: one dataset, linked under the name of every field of one kind.
pub(super) struct Offsets {
    pub group: Group,
    /// The first name, and the dataset.
    column: Option<(String, Column<i64>)>,
    /// Rows of a frame.
    pub rows: usize,
    /// Frames of a chunk of the fields, where these are short.
    chunk: usize,
}

impl Offsets {
    /// Gives the dataset the name of a further field.
    fn add(&mut self, name: &str) -> hdf5::Result<()> {
        match &self.column {
            Some((first, _)) => self.group.link_hard(first, name),
            None => {
                let column = Column::series(&self.group, name, &[], OFFSETS)?;
                self.column = Some((name.to_owned(), column));
                Ok(())
            }
        }
    }

    /// Appends a frame.
    pub fn push(&mut self) {
        if let Some((_, column)) = &mut self.column {
            column.push([(column.rows() * self.rows) as i64]);
        }
    }

    /// Writes the frames that wait.
    pub fn flush(&mut self) -> hdf5::Result<()> {
        (self.column.iter_mut()).try_for_each(|(_, column)| column.flush())
    }
}

impl Place {
    /// The groups for about `frames` frames of `rows` rows.
    pub fn new(
        [grid, steps]: [&Group; 2],
        kind: &str,
        rows: usize,
        frames: usize,
    ) -> hdf5::Result<Self> {
        Ok(Place {
            data: group(grid, &format!("{kind}Data"))?,
            offsets: Offsets {
                group: group(steps, &format!("{kind}DataOffsets"))?,
                column: None,
                rows,
                chunk: even_part(frames, CHUNK_FRAMES),
            },
        })
    }

    /// A field with its first rows.
    pub fn field<T: Value>(
        &mut self,
        name: &str,
        row: Row,
        mostly: Mostly,
        text: Meaning,
    ) -> hdf5::Result<Column<T>> {
        self.offsets.add(name)?;
        let Offsets { rows, chunk, .. } = self.offsets;
        Column::frames(&self.data, name, (row, [rows, chunk]), mostly, text)
    }
}

/// Size of each part when `count` is divided evenly into as few parts as there can be of up to `most`.
fn even_part(count: usize, most: usize) -> usize {
    let parts = count.div_ceil(most).max(1);
    count.div_ceil(parts).max(1)
}

#[cfg(test)]
mod tests {
    use super::even_part;

    #[test]
    fn frames_are_divided_evenly_into_few_chunks() {
        let cases = [(0, 1), (1, 1), (32, 32), (33, 17), (101, 26), (1001, 32)];
        for (frames, expected) in cases {
            assert_eq!(even_part(frames, 32), expected, "{frames}");
        }
    }
}
