//! Datasets of the result file that grow by rows, with the rows buffered in memory.

use hdf5::plist::dataset_create::{AllocTime, FillTime};
use hdf5::{Dataset, Extent, Extents, Group, H5Type, Hyperslab, SliceOrIndex};
use ndarray::{ArrayView, IxDyn};

use super::dataset::{Meaning, describe};

/// Rows of a chunk of a dataset that grows by one row per increment: each chunk costs a call of the system.
const CHUNK_ROWS: usize = 256;

/// Largest chunk in bytes: well inside the library's chunk cache.
const CHUNK_BYTES: usize = 1 << 16;

/// Largest chunk in bytes of a field that most nodes have the same value of: small, since chunks
/// with that value only are left out.
const SPARSE_CHUNK_BYTES: usize = 1 << 11;

/// Largest chunk in bytes of such a field in a small model, whose frames are not larger than the second
/// number: there the number of chunks counts.
const SMALL_CHUNK_BYTES: usize = 1 << 14;
const SMALL_FRAME_BYTES: usize = 1 << 12;

/// Bytes by which the index of a dataset may grow when rows are appended: a node of the library's
/// tree of chunks and one for each of the levels above it (3.1 kB each with three dimensions).
const INDEX: usize = 3 * 3200;

/// Bytes of the index for a chunk: its part of a half-filled node.
const INDEX_OF_CHUNK: usize = 100;

/// A number of a dataset, with the value that rows have which are not written.
pub(crate) trait Value: H5Type + Copy {
    /// Is it zero (or NaN, where that is the value of what is not written)?
    fn is_left_out(&self, nan: bool) -> bool;
    /// The value of what is not written.
    fn left_out(nan: bool) -> Self;
}

impl Value for f64 {
    fn is_left_out(&self, nan: bool) -> bool {
        match nan {
            true => self.is_nan(),
            false => self.to_bits() == 0,
        }
    }

    fn left_out(nan: bool) -> Self {
        if nan { f64::NAN } else { 0.0 }
    }
}

impl Value for u8 {
    fn is_left_out(&self, _: bool) -> bool {
        *self == 0
    }

    fn left_out(_: bool) -> Self {
        0
    }
}

impl Value for i64 {
    fn is_left_out(&self, _: bool) -> bool {
        *self == 0
    }

    fn left_out(_: bool) -> Self {
        0
    }
}

/// What most rows of a field hold; chunks of nothing else take no space in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mostly {
    /// Any value.
    Varied,
    /// Any value, but the first row may come late.
    Late,
    /// Zero.
    Zero,
    /// NaN.
    Nan,
}

/// Shape of a row: its components, and how many of them are given; the others are zero.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row<'a> {
    pub shape: &'a [usize],
    /// Size of the last axis that is given.
    pub given: usize,
}

impl<'a> Row<'a> {
    /// A row whose components are all given.
    pub fn whole(shape: &'a [usize]) -> Self {
        let given = shape.last().copied().unwrap_or(1);
        Row { shape, given }
    }

    /// Shape of the part that is given.
    fn given_shape(&self) -> Vec<usize> {
        let mut shape = self.shape.to_vec();
        if let Some(last) = shape.last_mut() {
            *last = self.given;
        }
        shape
    }
}

/// Chunks of a dataset.
struct Chunks {
    rows: usize,
    /// Whether the library keeps them in its memory until it is flushed. What is written once, in large
    /// pieces, it need not copy.
    kept: bool,
}

/// A dataset that grows by rows, which are kept in memory until [`Growing::flush`].
pub(crate) struct Column<T> {
    dataset: Dataset,
    /// Shape of a row in the file; empty for a scalar.
    row: Vec<usize>,
    /// Shape of the part of a row that is written.
    given: Vec<usize>,
    /// Rows of a chunk.
    chunk_rows: usize,
    /// Whether rows that are not written read as NaN instead of zero.
    nan: bool,
    /// Rows in the file.
    written: usize,
    /// Rows not in the file yet, one after the other.
    pending: Vec<T>,
}

impl<T: Value> Column<T> {
    /// A dataset with one row per increment.
    pub fn series(
        parent: &Group,
        name: &str,
        row: &[usize],
        meaning: Meaning,
    ) -> hdf5::Result<Self> {
        Self::row_by_row(parent, name, row, Mostly::Varied, meaning)
    }

    /// A dataset with one row per event. It has its tree of chunks from the start, since the first
    /// event can come late.
    pub fn events(
        parent: &Group,
        name: &str,
        row: &[usize],
        meaning: Meaning,
    ) -> hdf5::Result<Self> {
        Self::row_by_row(parent, name, row, Mostly::Late, meaning)
    }

    fn row_by_row(
        parent: &Group,
        name: &str,
        row: &[usize],
        mostly: Mostly,
        meaning: Meaning,
    ) -> hdf5::Result<Self> {
        let bytes = row.iter().product::<usize>() * size_of::<T>();
        let rows = (CHUNK_BYTES / bytes.max(1)).clamp(1, CHUNK_ROWS);
        let chunks = Chunks { rows, kept: true };
        Self::create(parent, name, (Row::whole(row), chunks), mostly, meaning)
    }

    /// A dataset to which frames of `rows` rows are appended, up to `frames` of them in a chunk.
    pub fn frames(
        parent: &Group,
        name: &str,
        (row, [rows, frames]): (Row, [usize; 2]),
        mostly: Mostly,
        meaning: Meaning,
    ) -> hdf5::Result<Self> {
        let bytes = row.given_shape().iter().product::<usize>() * size_of::<T>();
        let most = match mostly {
            Mostly::Varied | Mostly::Late => CHUNK_BYTES,
            _ if rows * bytes <= SMALL_FRAME_BYTES => SMALL_CHUNK_BYTES,
            Mostly::Zero | Mostly::Nan => SPARSE_CHUNK_BYTES,
        };
        let chunks = Chunks {
            rows: (most / bytes.max(1)).clamp(1, (frames * rows).max(1)),
            kept: false,
        };
        Self::create(parent, name, (row, chunks), mostly, meaning)
    }

    fn create(
        parent: &Group,
        name: &str,
        (row, chunks): (Row, Chunks),
        mostly: Mostly,
        meaning: Meaning,
    ) -> hdf5::Result<Self> {
        // The tree of chunks is made with the first row, and stays when that is taken away.
        let is_late = mostly == Mostly::Late;
        let mut extents = vec![Extent::resizable(usize::from(is_late))];
        extents.extend(row.shape.iter().map(|&n| Extent::fixed(n)));
        let given = row.given_shape();
        let nan = mostly == Mostly::Nan;
        let mut builder = parent.new_dataset_builder();
        if !chunks.kept {
            builder = builder.chunk_cache(1, 0, 1.0);
        }
        let dataset = builder
            .obj_track_times(false)
            .chunk(rows_of(chunks.rows, &given))
            .fill_value(T::left_out(nan))
            .alloc_time(Some(if is_late {
                AllocTime::Early
            } else {
                AllocTime::Incr
            }))
            .fill_time(if is_late {
                FillTime::Never
            } else {
                FillTime::IfSet
            })
            .empty::<T>()
            .shape(Extents::simple(extents))
            .create(name)?;
        dataset.resize(rows_of(0, row.shape))?;
        describe(&dataset, meaning)?;
        Ok(Column {
            dataset,
            row: row.shape.to_vec(),
            given,
            chunk_rows: chunks.rows,
            nan,
            written: 0,
            pending: Vec::new(),
        })
    }

    /// Appends whole rows; the number of values is a multiple of the row's size.
    pub fn push(&mut self, values: impl IntoIterator<Item = T>) {
        self.pending.extend(values);
    }

    /// Appends whole rows.
    pub fn push_slice(&mut self, values: &[T]) {
        self.pending.extend_from_slice(values);
    }

    /// The next rows from `first` on, up to the border of a chunk, that are not left out. The first
    /// chunk never is: with it the dataset gets its tree of chunks, to which its header then points
    /// before frames are there that a run killed in the middle of a write could make unreadable.
    fn next_block(&self, first: usize) -> Option<[usize; 2]> {
        let end = self.written + self.pending_rows();
        let border = |row: usize| ((row / self.chunk_rows + 1) * self.chunk_rows).min(end);
        let is_left_out = |start: usize, stop: usize| {
            let mut values = self.values(start, stop).iter();
            start > 0 && values.all(|value| value.is_left_out(self.nan))
        };
        let mut start = first;
        while start < end && is_left_out(start, border(start)) {
            start = border(start);
        }
        let mut stop = start;
        while stop < end && !is_left_out(stop, border(stop)) {
            stop = border(stop);
        }
        (start < end).then_some([start, stop])
    }

    /// Buffered values of the rows from `start` to `stop`.
    fn values(&self, start: usize, stop: usize) -> &[T] {
        let size = self.given.iter().product::<usize>();
        &self.pending[(start - self.written) * size..(stop - self.written) * size]
    }

    fn write(&self, start: usize, stop: usize) -> hdf5::Result<()> {
        let shape = rows_of(stop - start, &self.given);
        let view = ArrayView::from_shape(IxDyn(&shape), self.values(start, stop))
            .map_err(|error| hdf5::Error::from(error.to_string()))?;
        self.dataset.write_slice(view, block(start, &shape))
    }

    /// Rows appended so far.
    pub fn rows(&self) -> usize {
        self.written + self.pending_rows()
    }

    fn pending_rows(&self) -> usize {
        self.pending.len() / self.given.iter().product::<usize>().max(1)
    }
}

/// A dataset that grows by rows, whatever its numbers are.
pub(crate) trait Growing {
    /// Writes the buffered rows.
    fn flush(&mut self) -> hdf5::Result<()>;

    /// Bytes by which the file may grow when `rows` rows are written.
    fn growth(&self, rows: usize) -> u64;

    /// Bytes of a row.
    fn row_bytes(&self) -> usize;
}

/// Growing datasets of a group.
pub(crate) type Columns<'a> = Vec<&'a mut dyn Growing>;

impl<T: Value> Growing for Column<T> {
    fn flush(&mut self) -> hdf5::Result<()> {
        let rows = self.pending_rows();
        if rows == 0 {
            return Ok(());
        }
        let end = self.written + rows;
        self.dataset.resize(rows_of(end, &self.row))?;
        let mut first = self.written;
        while let Some([start, stop]) = self.next_block(first) {
            self.write(start, stop)?;
            first = stop;
        }
        self.written = end;
        self.pending.clear();
        Ok(())
    }

    fn growth(&self, rows: usize) -> u64 {
        let chunks = rows / self.chunk_rows + 2;
        (chunks * (self.chunk_rows * self.row_bytes() + INDEX_OF_CHUNK) + INDEX) as u64
    }

    fn row_bytes(&self) -> usize {
        self.given.iter().product::<usize>() * size_of::<T>()
    }
}

/// Shape of a number of rows.
fn rows_of(rows: usize, row: &[usize]) -> Vec<usize> {
    let mut shape = vec![rows];
    shape.extend_from_slice(row);
    shape
}

/// The block of `shape` whose first row is `start`.
fn block(start: usize, shape: &[usize]) -> Hyperslab {
    let range = |start, count| SliceOrIndex::SliceCount {
        start,
        step: 1,
        count,
        block: 1,
    };
    let mut slices = vec![range(start, shape[0])];
    slices.extend(shape[1..].iter().map(|&n| range(0, n)));
    Hyperslab::from(slices)
}
