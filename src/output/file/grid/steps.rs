//! Group `/VTKHDF/Steps`: the times of the frames and where their geometry starts.

use hdf5::{Attribute, Group};

use crate::output::file::column::{Column, Growing};
use crate::output::file::dataset::{counter, group, meaning};

/// The steps of the grid: their times and where their geometry starts (always at 0).
pub(super) struct Steps {
    group: Group,
    /// Number of frames in the file.
    count: Attribute,
    values: Column<f64>,
    parts: Column<i64>,
    zeros: Vec<Column<i64>>,
}

impl Steps {
    pub fn create(grid: &Group) -> hdf5::Result<Self> {
        let steps = group(grid, "Steps")?;
        let column = |name, row: &[usize], text| {
            Column::<i64>::series(&steps, name, row, meaning(text, "1"))
        };
        Ok(Steps {
            count: counter(&steps, "NSteps")?,
            values: Column::series(&steps, "Values", &[], meaning("time of the frame", "time"))?,
            parts: column("NumberOfParts", &[], "grids of the frame")?,
            zeros: vec![
                column("PartOffsets", &[], "first grid of the frame")?,
                column("PointOffsets", &[], "first node of the frame's grid")?,
                column("CellOffsets", &[1], "first cell of the frame's grid")?,
                column(
                    "ConnectivityIdOffsets",
                    &[1],
                    "first entry of the frame's connectivity",
                )?,
            ],
            group: steps,
        })
    }

    pub fn group(&self) -> &Group {
        &self.group
    }

    /// Frames appended.
    pub fn count(&self) -> usize {
        self.values.rows()
    }

    /// Appends a frame.
    pub fn push(&mut self, time: f64) {
        for column in &mut self.zeros {
            column.push([0]);
        }
        self.parts.push([1]);
        self.values.push([time]);
    }

    /// Writes the frames that wait, but not their number.
    pub fn flush(&mut self) -> hdf5::Result<()> {
        self.zeros.iter_mut().try_for_each(Growing::flush)?;
        self.parts.flush()?;
        self.values.flush()
    }

    /// Writes the number of frames.
    pub fn note_count(&self) -> hdf5::Result<()> {
        self.count.write_scalar(&(self.count() as i64))
    }

    /// Bytes by which the file may grow for a number of frames.
    pub fn growth(&self, frames: usize) -> u64 {
        let of_each = self.values.growth(frames);
        (2 + self.zeros.len() as u64) * of_each
    }
}
