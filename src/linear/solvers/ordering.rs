//! Fill-reducing ordering: approximate minimum degree (Amestoy, Davis & Duff 1996) by faer.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;
use sprs::CsMatView;

use super::LinearError;

/// The pattern of a matrix in faer's form.
pub(super) fn pattern<'a>(
    n: usize,
    starts: &'a [usize],
    rows: &'a [usize],
) -> SymbolicSparseColMatRef<'a, usize> {
    SymbolicSparseColMatRef::new_checked(n, n, starts, None, rows)
}

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

    /// The pattern whose column k has entries in the rows `neighbours[k]`, in increasing order.
    pub fn of_graph(neighbours: &[Vec<usize>]) -> Self {
        let mut starts = vec![0];
        for rows in neighbours {
            starts.push(starts[starts.len() - 1] + rows.len());
        }
        let rows = neighbours.concat();
        Pattern { starts, rows }
    }

    /// The pattern in faer's form.
    pub fn symbolic(&self) -> SymbolicSparseColMatRef<'_, usize> {
        let n = self.starts.len().max(1) - 1;
        pattern(n, &self.starts, &self.rows)
    }
}

/// Approximate minimum degree order of a symmetric matrix: entry k is the unknown of pivot k.
pub(super) fn minimum_degree(a: CsMatView<'_, f64>) -> Result<Vec<usize>, LinearError> {
    let n = a.cols();
    let starts = a.indptr().to_proper().to_vec();
    let (mut order, mut inverse) = (vec![0; n], vec![0; n]);
    let mut memory = MemBuffer::new(amd::order_scratch::<usize>(n, a.nnz()));
    amd::order(
        &mut order,
        &mut inverse,
        pattern(n, &starts, a.indices()),
        amd::Control::default(),
        MemStack::new(&mut memory),
    )
    .map_err(|error| LinearError::Library(format!("{error:?}")))?;
    Ok(order)
}
