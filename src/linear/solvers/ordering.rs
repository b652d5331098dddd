//! Fill-reducing ordering: approximate minimum degree (Amestoy, Davis & Duff 1996) by faer.

use std::ops::Range;

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

/// Groups of unknowns next to each other with the same entries, as those of a node, which are ordered as one.
pub(super) struct Groups {
    /// First unknown of every group, and the number of unknowns.
    starts: Vec<usize>,
    /// The pattern between them.
    pub pattern: Pattern,
}

impl Groups {
    /// The groups of a pattern.
    pub fn of(pattern: &Pattern) -> Self {
        let starts = pattern.starts_of_groups();
        Groups {
            pattern: pattern.quotient(&starts),
            starts,
        }
    }

    /// Approximate minimum degree order: entry k is the group of pivot k.
    pub fn minimum_degree(&self) -> Result<Vec<usize>, LinearError> {
        let count = self.starts.len() - 1;
        let (mut order, mut inverse) = (vec![0; count], vec![0; count]);
        let scratch = amd::order_scratch::<usize>(count, self.pattern.rows.len());
        amd::order(
            &mut order,
            &mut inverse,
            self.pattern.symbolic(),
            amd::Control::default(),
            MemStack::new(&mut MemBuffer::new(scratch)),
        )
        .map_err(|error| LinearError::Library(format!("{error:?}")))?;
        Ok(order)
    }

    fn unknowns_of(&self, group: usize) -> Range<usize> {
        self.starts[group]..self.starts[group + 1]
    }

    /// The unknowns of groups in an order.
    pub fn unknowns(&self, order: &[usize]) -> impl Iterator<Item = usize> {
        order.iter().flat_map(|&group| self.unknowns_of(group))
    }

    /// Place of the first unknown of every group in an order, and the number of unknowns.
    pub fn offsets(&self, order: &[usize]) -> Vec<usize> {
        let mut offsets = vec![0];
        let mut end = 0;
        offsets.extend(order.iter().map(|&group| {
            end += self.unknowns_of(group).len();
            end
        }));
        offsets
    }
}

/// Approximate minimum degree order of a symmetric pattern: entry k is the unknown of pivot k. The unknowns of a group
/// stay next to each other.
pub(super) fn minimum_degree(pattern: &Pattern) -> Result<Vec<usize>, LinearError> {
    let groups = Groups::of(pattern);
    let order = groups.minimum_degree()?;
    Ok(groups.unknowns(&order).collect())
}
