//! Groups, attributes and datasets of the result file. Some datasets never change; others grow by rows, which wait in
//! memory.

use hdf5::plist::dataset_create::{AllocTime, FillTime};
use hdf5::types::VarLenUnicode;
use hdf5::{
    Attribute, Dataset, Extent, Extents, File, Group, H5Type, Hyperslab, Location, SliceOrIndex,
};
use ndarray::{ArrayD, ArrayView, IxDyn};

/// Meaning of a dataset: the dimension of its values, such as "length/time" ("1" for a pure number), and a sentence.
/// Dimension and sentence become the attributes `dimension` and `description` of the dataset.
pub(crate) type Meaning = (&'static str, &'static str);

/// The attribute of `/history`, and of its groups of events, that counts their complete rows.
pub(crate) const ROWS: &str = "rows";

/// Creates a group that stores no modification time.
pub(crate) fn group(parent: &Group, name: &str) -> hdf5::Result<Group> {
    let builder = parent.create_group_builder();
    builder.obj_track_times(false).create(name)
}

/// A text in the form of HDF5; a NUL, which HDF5 cannot store in a text, becomes U+FFFD.
pub(crate) fn hdf5_text(text: &str) -> hdf5::Result<VarLenUnicode> {
    let clean = text.replace('\0', "\u{fffd}").parse::<VarLenUnicode>();
    clean.map_err(|_| hdf5::Error::from("text with a NUL character"))
}

/// Writes the new text attribute `name`.
pub(crate) fn text_attribute(at: &Location, name: &str, text: &str) -> hdf5::Result<()> {
    new_attribute(at, name, hdf5_text(text)?)
}

/// Writes the new scalar attribute `name`.
pub(crate) fn new_attribute<T: H5Type>(at: &Location, name: &str, value: T) -> hdf5::Result<()> {
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
    let builder = parent.new_dataset_builder().empty::<T>();
    let builder = builder.shape(shape.to_vec()).obj_track_times(false);
    let dataset = builder.create(name)?;
    describe(&dataset, meaning)?;
    match data.is_empty() {
        true => Ok(()),
        false => dataset.write_raw(data),
    }
}

/// Gives a new dataset its attributes `dimension` and `description`.
fn describe(dataset: &Dataset, (dimension, description): Meaning) -> hdf5::Result<()> {
    text_attribute(dataset, "description", description)?;
    text_attribute(dataset, "dimension", dimension)
}

/// Number of rows of a chunk of a dataset that grows by one row per increment; a chunk has many rows because each chunk
/// costs a system call.
const CHUNK_ROWS: usize = 256;

/// Size of the largest chunk (bytes), well below the chunk cache of the library.
const CHUNK_BYTES: usize = 1 << 16;

/// Size of the largest chunk (bytes) of a field that has the same value at most nodes; it is small, because chunks with
/// only this value are not stored.
const SPARSE_CHUNK_BYTES: usize = 1 << 11;

/// Size of the largest chunk (bytes) of such a field in a small model, whose frames have at most [`SMALL_FRAME_BYTES`]:
/// there the number of chunks matters.
const SMALL_CHUNK_BYTES: usize = 1 << 14;
const SMALL_FRAME_BYTES: usize = 1 << 12;

/// Number of bytes by which the index of a dataset may grow when rows are appended: a node in the chunk tree of the
/// library and one node for each level above it (3.1 kB each with three dimensions).
const INDEX: usize = 3 * 3200;

/// Number of bytes of the index for a chunk: its part of a half-filled node.
const INDEX_OF_CHUNK: usize = 100;

/// A number of a dataset, with the value of rows that are not written.
pub(crate) trait Number: H5Type + Copy + Default + PartialEq {
    /// The value of rows that are not written.
    fn left_out(_nan: bool) -> Self {
        Self::default()
    }

    /// Whether the number is zero, or NaN if that is the value of rows that are not written.
    fn is_left_out(&self, _nan: bool) -> bool {
        *self == Self::default()
    }
}

impl Number for u8 {}

impl Number for i64 {}

impl Number for f64 {
    fn left_out(nan: bool) -> Self {
        if nan { f64::NAN } else { 0.0 }
    }

    fn is_left_out(&self, nan: bool) -> bool {
        match nan {
            true => self.is_nan(),
            false => self.to_bits() == 0,
        }
    }
}

/// The value in most rows of a dataset; chunks with only this value need no space in the file.
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

/// Shape of the rows of a dataset, and how the file stores them.
pub(crate) struct Layout {
    /// Shape of a row in the file; empty for a scalar.
    row: Vec<usize>,
    /// Shape of the part of a row that is written; the rest is zero.
    given: Vec<usize>,
    /// Number of rows of a chunk.
    chunk_rows: usize,
    /// Number of rows of a report; for a dataset of events, the smallest number.
    rows: usize,
    /// Whether the library keeps chunks in its memory until it is flushed. Rows that are written once, in large pieces,
    /// need no such copy.
    is_cached: bool,
    mostly: Mostly,
}

impl Layout {
    /// Rows that come one by one, with each increment or each event. Rows of events have their chunk tree from the
    /// start, because the first event can come late ([`Mostly::Late`]).
    pub fn one_by_one<T: Number>(row: &[usize], mostly: Mostly) -> Self {
        let bytes = row.iter().product::<usize>() * size_of::<T>();
        Layout {
            row: row.to_vec(),
            given: row.to_vec(),
            chunk_rows: (CHUNK_BYTES / bytes.max(1)).clamp(1, CHUNK_ROWS),
            rows: 1,
            is_cached: true,
            mostly,
        }
    }

    /// Rows that come in frames of `rows`, up to `frames` of them in a chunk. Only the `given` components of a row are
    /// written; the others are zero.
    pub fn in_frames<T: Number>(
        row: &[usize],
        given: &[usize],
        mostly: Mostly,
        [rows, frames]: [usize; 2],
    ) -> Self {
        let bytes = given.iter().product::<usize>() * size_of::<T>();
        let most = match mostly {
            Mostly::Varied | Mostly::Late => CHUNK_BYTES,
            _ if rows * bytes <= SMALL_FRAME_BYTES => SMALL_CHUNK_BYTES,
            Mostly::Zero | Mostly::Nan => SPARSE_CHUNK_BYTES,
        };
        Layout {
            row: row.to_vec(),
            given: given.to_vec(),
            chunk_rows: (most / bytes.max(1)).clamp(1, (frames * rows).max(1)),
            rows,
            is_cached: false,
            mostly,
        }
    }

    /// Number of written values of a row.
    fn size(&self) -> usize {
        self.given.iter().product()
    }

    /// Creates a dataset without rows.
    fn create<T: Number>(
        &self,
        parent: &Group,
        name: &str,
        meaning: Meaning,
    ) -> hdf5::Result<Dataset> {
        // The tree of chunks is made with the first row, and stays when that is taken away.
        let is_late = self.mostly == Mostly::Late;
        let mut extents = vec![Extent::resizable(usize::from(is_late))];
        // a model without deformable bodies has rows of none, which chunks must not have
        let extent = |&n: &usize| match n {
            0 => Extent::resizable(0),
            n => Extent::fixed(n),
        };
        extents.extend(self.row.iter().map(extent));
        let chunk: Vec<usize> = self.given.iter().map(|&n| n.max(1)).collect();
        let (alloc_time, fill_time) = match is_late {
            true => (AllocTime::Early, FillTime::Never),
            false => (AllocTime::Incr, FillTime::IfSet),
        };
        let mut builder = parent.new_dataset_builder();
        if !self.is_cached {
            builder = builder.chunk_cache(1, 0, 1.0);
        }
        let dataset = builder
            .obj_track_times(false)
            .chunk(rows_of(self.chunk_rows, &chunk))
            .fill_value(T::left_out(self.mostly == Mostly::Nan))
            .alloc_time(Some(alloc_time))
            .fill_time(fill_time)
            .empty::<T>()
            .shape(Extents::simple(extents))
            .create(name)?;
        if is_late {
            dataset.resize(rows_of(0, &self.row))?;
        }
        describe(&dataset, meaning)?;
        Ok(dataset)
    }
}

/// Shape of `rows` rows.
fn rows_of(rows: usize, row: &[usize]) -> Vec<usize> {
    [&[rows], row].concat()
}

/// Function that appends the rows of a report to a list of values. The function is boxed and not a type parameter of
/// [`Column`], because otherwise the same code would be compiled for each of about 160 datasets.
type Values<'m, R, T> = Box<dyn FnMut(&R, &mut Vec<T>) + 'm>;

/// A dataset that grows by rows. The function `values` appends the rows of a report to the rows that wait in memory.
struct Column<'m, R, T> {
    dataset: Dataset,
    layout: Layout,
    values: Values<'m, R, T>,
    /// Number of rows in the file.
    written: usize,
    /// Values of the rows not in the file yet, one row after the other.
    pending: Vec<T>,
}

impl<R, T: Number> Column<'_, R, T> {
    /// The next rows from `first` on, up to the end of a chunk, that must be written. The first chunk is never left
    /// out. With it the dataset gets its chunk tree and a header that points to the tree, before there are frames that
    /// a run killed in the middle of a write could make unreadable.
    fn next_block(&self, first: usize, end: usize) -> Option<[usize; 2]> {
        let chunk_rows = self.layout.chunk_rows;
        let border = |row: usize| ((row / chunk_rows + 1) * chunk_rows).min(end);
        let nan = self.layout.mostly == Mostly::Nan;
        let is_left_out = |start: usize| {
            let mut values = self.values(start, border(start)).iter();
            start > 0 && values.all(|value| value.is_left_out(nan))
        };
        let mut start = first;
        while start < end && is_left_out(start) {
            start = border(start);
        }
        let mut stop = start;
        while stop < end && !is_left_out(stop) {
            stop = border(stop);
        }
        (start < end).then_some([start, stop])
    }

    /// Values of the waiting rows from `start` to `stop`.
    fn values(&self, start: usize, stop: usize) -> &[T] {
        let size = self.layout.size();
        &self.pending[(start - self.written) * size..(stop - self.written) * size]
    }

    fn write(&self, start: usize, stop: usize) -> hdf5::Result<()> {
        let shape = rows_of(stop - start, &self.layout.given);
        let view = ArrayView::from_shape(IxDyn(&shape), self.values(start, stop))
            .map_err(|error| hdf5::Error::from(error.to_string()))?;
        let mut ranges = vec![SliceOrIndex::from(start..stop)];
        ranges.extend(self.layout.given.iter().map(|&n| SliceOrIndex::from(0..n)));
        self.dataset.write_slice(view, Hyperslab::from(ranges))
    }
}

/// A dataset that grows with the reports `R`, with any type of numbers.
trait Growing<R> {
    /// Appends the rows of a report, which wait in memory; returns the number of usual reports that have as many rows.
    fn push(&mut self, report: &R) -> usize;

    /// Writes the rows that wait in memory.
    fn flush(&mut self) -> hdf5::Result<()>;

    /// Number of bytes by which the file may grow when the rows of `reports` reports are written.
    fn growth(&self, reports: usize) -> usize;

    /// Number of bytes of the rows of a report.
    fn report_bytes(&self) -> usize;

    /// Number of rows in the file.
    fn written(&self) -> usize;

    /// Writes the first rows of the same dataset of an earlier file.
    fn copy(&mut self, earlier: &File, rows: usize) -> hdf5::Result<()>;
}

impl<R, T: Number> Growing<R> for Column<'_, R, T> {
    fn push(&mut self, report: &R) -> usize {
        let before = self.pending.len();
        (self.values)(report, &mut self.pending);
        let values = self.layout.rows * self.layout.size();
        (self.pending.len() - before).div_ceil(values.max(1))
    }

    fn flush(&mut self) -> hdf5::Result<()> {
        let rows = self.pending.len() / self.layout.size().max(1);
        if rows == 0 {
            return Ok(());
        }
        let end = self.written + rows;
        self.dataset.resize(rows_of(end, &self.layout.row))?;
        let mut first = self.written;
        while let Some([start, stop]) = self.next_block(first, end) {
            self.write(start, stop)?;
            first = stop;
        }
        self.written = end;
        self.pending.clear();
        Ok(())
    }

    fn growth(&self, reports: usize) -> usize {
        let Layout {
            chunk_rows, rows, ..
        } = self.layout;
        let chunks = reports * rows / chunk_rows + 2;
        chunks * (chunk_rows * self.layout.size() * size_of::<T>() + INDEX_OF_CHUNK) + INDEX
    }

    fn report_bytes(&self) -> usize {
        self.layout.rows * self.layout.size() * size_of::<T>()
    }

    fn written(&self) -> usize {
        self.written
    }

    fn copy(&mut self, earlier: &File, rows: usize) -> hdf5::Result<()> {
        let source = earlier.dataset(&self.dataset.name())?;
        let Layout {
            chunk_rows, given, ..
        } = &self.layout;
        let bytes = chunk_rows * self.layout.size() * size_of::<T>();
        let piece = chunk_rows * (COPIED_BYTES / bytes.max(1)).max(1);
        let given = given.clone();
        while self.written < rows {
            let end = rows.min(self.written + piece);
            let mut ranges = vec![SliceOrIndex::from(self.written..end)];
            ranges.extend(given.iter().map(|&n| SliceOrIndex::from(0..n)));
            let values: ArrayD<T> = source.read_slice(Hyperslab::from(ranges))?;
            self.pending = values.iter().copied().collect();
            self.flush()?;
        }
        Ok(())
    }
}

/// Number of bytes of a dataset that are copied at a time.
const COPIED_BYTES: usize = 1 << 22;

/// A number of rows on which readers rely: it is written after all rows that it counts.
struct Count<R> {
    attribute: Attribute,
    /// Rows appended.
    rows: usize,
    /// Function that returns the number of rows of a report.
    of: fn(&R) -> usize,
}

/// Datasets that grow together: each report `R` appends rows to each of them.
pub(crate) struct GrowingColumns<'m, R> {
    all: Vec<Box<dyn Growing<R> + 'm>>,
    counts: Vec<Count<R>>,
    /// Number of reports whose rows wait in memory; a report with many events counts as several.
    waiting: usize,
    /// Largest number of reports that wait.
    most: usize,
}

impl<'m, R: 'm> GrowingColumns<'m, R> {
    /// An empty set of datasets.
    pub fn new() -> Self {
        GrowingColumns {
            all: Vec::new(),
            counts: Vec::new(),
            waiting: 0,
            most: 1,
        }
    }

    /// Lets rows of up to `bytes` bytes wait in memory, but at least those of one report.
    pub fn let_wait(&mut self, bytes: usize) {
        let report: usize = self.all.iter().map(|column| column.report_bytes()).sum();
        self.most = (bytes / report.max(1)).max(1);
    }

    /// Whether rows wait in memory.
    pub fn is_waiting(&self) -> bool {
        self.waiting > 0
    }

    /// Whether no further rows may wait in memory.
    pub fn is_full(&self) -> bool {
        self.waiting >= self.most
    }

    /// Creates a dataset; `values` appends whole rows of a report.
    pub fn add<T: Number + 'm>(
        &mut self,
        at: &Group,
        name: &str,
        layout: Layout,
        meaning: Meaning,
        values: impl FnMut(&R, &mut Vec<T>) + 'm,
    ) -> hdf5::Result<()> {
        self.add_column(at, name, layout, meaning, Box::new(values))
    }

    fn add_column<T: Number + 'm>(
        &mut self,
        at: &Group,
        name: &str,
        layout: Layout,
        meaning: Meaning,
        values: Values<'m, R, T>,
    ) -> hdf5::Result<()> {
        self.all.push(Box::new(Column {
            dataset: layout.create::<T>(at, name, meaning)?,
            layout,
            values,
            written: 0,
            pending: Vec::new(),
        }));
        Ok(())
    }

    /// Creates the attribute `name` of a group, which counts rows.
    pub fn count(&mut self, at: &Group, name: &str, of: fn(&R) -> usize) -> hdf5::Result<()> {
        let attribute = at.new_attr::<i64>().create(name)?;
        attribute.write_scalar(&0_i64)?;
        let rows = 0;
        self.counts.push(Count {
            attribute,
            rows,
            of,
        });
        Ok(())
    }

    /// Appends the rows of a report, which wait in memory.
    pub fn push(&mut self, report: &R) {
        let reports = self.all.iter_mut().map(|column| column.push(report));
        self.waiting += reports.fold(1, usize::max);
        for count in &mut self.counts {
            count.rows += (count.of)(report);
        }
    }

    /// Writes the rows that wait in memory, but not yet their number.
    pub fn flush(&mut self) -> hdf5::Result<()> {
        self.waiting = 0;
        self.all.iter_mut().try_for_each(|column| column.flush())
    }

    /// Numbers of rows of all datasets in the file, then the counts.
    pub fn written(&self) -> Vec<usize> {
        let rows = self.all.iter().map(|column| column.written());
        rows.chain(self.counts.iter().map(|count| count.rows))
            .collect()
    }

    /// Copies as many rows from an earlier file of the same model as `written` gives (see [`Self::written`]).
    pub fn copy(&mut self, earlier: &File, written: &[usize]) -> hdf5::Result<()> {
        let sizes = (self.all.len() + self.counts.len(), written.len());
        if sizes.0 != sizes.1 {
            return Err(format!("{} datasets, not {}", sizes.1, sizes.0).into());
        }
        let (rows, counts) = written.split_at(self.all.len());
        for (column, rows) in self.all.iter_mut().zip(rows) {
            column.copy(earlier, *rows)?;
        }
        for (count, rows) in self.counts.iter_mut().zip(counts) {
            count.rows = *rows;
        }
        Ok(())
    }

    /// Writes the numbers of rows.
    pub fn note_counts(&self) -> hdf5::Result<()> {
        let mut counts = self.counts.iter();
        counts.try_for_each(|count| count.attribute.write_scalar(&(count.rows as i64)))
    }

    /// Number of bytes by which the file may grow until all waiting rows are written.
    pub fn growth(&self) -> u64 {
        let growth = self.all.iter().map(|column| column.growth(self.most));
        growth.sum::<usize>() as u64
    }
}
