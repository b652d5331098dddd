//! Building blocks of the result file: HDF5 groups, attributes, constant datasets, and datasets
//! that grow along their first axis.

use hdf5::types::VarLenUnicode;
use hdf5::{Dataset, Extent, Extents, Group, H5Type, Hyperslab, Location, SliceOrIndex};
use ndarray::{ArrayView, IxDyn};

/// Rows of a chunk of a dataset that grows by one row per increment.
const CHUNK_ROWS: usize = 64;

/// Frames of fewer bytes are not compressed: it would take longer than writing them.
const LEAST_COMPRESSED: usize = 1 << 12;

/// Largest chunk in bytes of a dataset that grows by one row per increment: well inside the
/// library's chunk cache.
const CHUNK_BYTES: usize = 1 << 18;

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
    let clean = text.replace('\0', "\u{fffd}");
    let value: VarLenUnicode = clean
        .parse()
        .map_err(|_| hdf5::Error::from("text with a NUL character"))?;
    set_attribute(at, name, value)
}

/// Writes the scalar attribute `name`, a new one or over the old value.
pub(crate) fn set_attribute<T: H5Type>(at: &Location, name: &str, value: T) -> hdf5::Result<()> {
    if let Ok(attribute) = at.attr(name) {
        return attribute.write_scalar(&value);
    }
    at.new_attr::<T>().create(name)?.write_scalar(&value)
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

fn describe(dataset: &Dataset, meaning: Meaning) -> hdf5::Result<()> {
    text_attribute(dataset, "description", meaning.description)?;
    text_attribute(dataset, "dimension", meaning.dimension)
}

/// A dataset that grows by rows, buffered in memory until [`Column::flush`] or a full chunk.
pub(crate) struct Column<T> {
    dataset: Dataset,
    /// Shape of a row; empty for a scalar.
    row: Vec<usize>,
    /// Rows in the file.
    written: usize,
    /// Rows not in the file yet, one after the other.
    pending: Vec<T>,
    /// Number of rows at which the buffer is written.
    capacity: usize,
}

impl<T: H5Type + Copy> Column<T> {
    /// A dataset with one row per increment (or per event): small chunks, no compression.
    pub fn series(
        parent: &Group,
        name: &str,
        row: &[usize],
        meaning: Meaning,
    ) -> hdf5::Result<Self> {
        let bytes = row.iter().product::<usize>() * size_of::<T>();
        let rows = (CHUNK_BYTES / bytes.max(1)).clamp(1, CHUNK_ROWS);
        Self::create(parent, name, row, rows, false, meaning)
    }

    /// A dataset to which whole frames of `rows` rows are appended: a chunk is a frame.
    pub fn frames(
        parent: &Group,
        name: &str,
        row: &[usize],
        rows: usize,
        meaning: Meaning,
    ) -> hdf5::Result<Self> {
        let bytes = rows * row.iter().product::<usize>() * size_of::<T>();
        let compress = bytes >= LEAST_COMPRESSED && hdf5::filters::deflate_available();
        Self::create(parent, name, row, rows.max(1), compress, meaning)
    }

    fn create(
        parent: &Group,
        name: &str,
        row: &[usize],
        chunk_rows: usize,
        compress: bool,
        meaning: Meaning,
    ) -> hdf5::Result<Self> {
        let mut extents = vec![Extent::resizable(0)];
        extents.extend(row.iter().map(|&n| Extent::fixed(n)));
        let mut chunk = vec![chunk_rows];
        chunk.extend_from_slice(row);
        let mut builder = parent
            .new_dataset_builder()
            .obj_track_times(false)
            .chunk(chunk);
        if compress {
            builder = builder.shuffle().deflate(1);
        }
        let dataset = builder
            .empty::<T>()
            .shape(Extents::simple(extents))
            .create(name)?;
        describe(&dataset, meaning)?;
        Ok(Column {
            dataset,
            row: row.to_vec(),
            written: 0,
            pending: Vec::new(),
            capacity: chunk_rows,
        })
    }

    /// Appends whole rows; the number of values is a multiple of the row's size.
    pub fn push(&mut self, values: impl IntoIterator<Item = T>) -> hdf5::Result<()> {
        self.pending.extend(values);
        if self.pending_rows() >= self.capacity {
            self.flush()?;
        }
        Ok(())
    }

    /// Writes the buffered rows to the dataset.
    pub fn flush(&mut self) -> hdf5::Result<()> {
        let rows = self.pending_rows();
        if rows == 0 {
            return Ok(());
        }
        let start = self.written;
        self.dataset.resize(self.shape(start + rows))?;
        let shape = self.shape(rows);
        let view = ArrayView::from_shape(IxDyn(&shape), &self.pending)
            .map_err(|error| hdf5::Error::from(error.to_string()))?;
        self.dataset.write_slice(view, block(start, &shape))?;
        self.written += rows;
        self.pending.clear();
        Ok(())
    }

    /// Rows appended so far.
    pub fn rows(&self) -> usize {
        self.written + self.pending_rows()
    }

    fn pending_rows(&self) -> usize {
        self.pending.len() / self.row.iter().product::<usize>().max(1)
    }

    fn shape(&self, rows: usize) -> Vec<usize> {
        let mut shape = vec![rows];
        shape.extend_from_slice(&self.row);
        shape
    }
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
