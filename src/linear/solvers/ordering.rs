//! Fill-reducing ordering: approximate minimum degree (Amestoy, Davis & Duff 1996) by faer.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;
use sprs::CsMatView;

use super::LinearError;

/// Where a matrix has entries.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Pattern {
    starts: Vec<usize>,
    rows: Vec<usize>,
}

impl Pattern {
    /// The pattern of a matrix by columns.
    pub fn of(a: CsMatView<'_, f64>) -> Self {
        Pattern {
            starts: a.indptr().to_proper().to_vec(),
            rows: a.indices().to_vec(),
        }
    }

    /// Whether it is that of a matrix.
    pub fn is_of(&self, a: CsMatView<'_, f64>) -> bool {
        self.starts == a.indptr().raw_storage() && self.rows == a.indices()
    }

    /// The pattern whose column k has entries in the rows `neighbours[k]`, in increasing order.
    pub fn of_graph(neighbours: &[Vec<usize>]) -> Self {
        let mut starts = vec![0];
        for rows in neighbours {
            starts.push(starts[starts.len() - 1] + rows.len());
        }
        let rows = neighbours.concat();
        Pattern { starts, rows }
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.starts.len().max(1) - 1
    }

    /// Rows of the entries of a column.
    fn column(&self, k: usize) -> &[usize] {
        &self.rows[self.starts[k]..self.starts[k + 1]]
    }

    /// First unknown of every group of unknowns next to each other with the same entries, and their number.
    fn starts_of_groups(&self) -> Vec<usize> {
        let begins = |&k: &usize| k == 0 || self.column(k) != self.column(k - 1);
        let mut starts: Vec<usize> = (0..self.size()).filter(begins).collect();
        starts.push(self.size());
        starts
    }

    /// The pattern between groups of unknowns, given by the first unknown of each, and their number.
    fn quotient(&self, groups: &[usize]) -> Pattern {
        let mut group_of = vec![0; self.size()];
        for (group, ends) in groups.windows(2).enumerate() {
            group_of[ends[0]..ends[1]].fill(group);
        }
        let mut quotient = Pattern {
            starts: vec![0],
            rows: Vec::new(),
        };
        for &first in &groups[..groups.len() - 1] {
            let column = self.column(first).iter().map(|&row| group_of[row]);
            let mut last = None;
            quotient
                .rows
                .extend(column.filter(|&group| last.replace(group) != Some(group)));
            quotient.starts.push(quotient.rows.len());
        }
        quotient
    }

    /// The pattern in faer's form.
    pub fn symbolic(&self) -> SymbolicSparseColMatRef<'_, usize> {
        let n = self.size();
        SymbolicSparseColMatRef::new_checked(n, n, self.starts(), None, &self.rows)
    }

    /// Starts of the columns, and the end of the last one.
    fn starts(&self) -> &[usize] {
        match self.starts.is_empty() {
            true => &[0],
            false => &self.starts,
        }
    }
}

/// Approximate minimum degree order of a symmetric pattern: entry k is the unknown of pivot k. Unknowns next to each
/// other with the same entries, as those of a node, are ordered as one, and stay next to each other.
pub(super) fn minimum_degree(pattern: &Pattern) -> Result<Vec<usize>, LinearError> {
    let starts = pattern.starts_of_groups();
    let quotient = pattern.quotient(&starts);
    let groups = starts.len() - 1;
    let (mut order, mut inverse) = (vec![0; groups], vec![0; groups]);
    let scratch = amd::order_scratch::<usize>(groups, quotient.rows.len());
    amd::order(
        &mut order,
        &mut inverse,
        quotient.symbolic(),
        amd::Control::default(),
        MemStack::new(&mut MemBuffer::new(scratch)),
    )
    .map_err(|error| LinearError::Library(format!("{error:?}")))?;
    let unknowns = |group: usize| starts[group]..starts[group + 1];
    Ok(order.into_iter().flat_map(unknowns).collect())
}
