use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::LdltRegularization;
use faer::sparse::SparseColMatRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::supernodal::SupernodalLdltRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LdltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::{Conj, MatMut, Par, Side, Spec};
use sprs::CsMatView;

use super::ordering::pattern;
use super::solver::check_pivots;
use super::{LinearError, LinearSolver};

/// Supernodal LDL^T of faer with an approximate minimum degree order, on one thread (a second one
/// makes matrices of this kind slower).
#[derive(Default)]
pub struct FaerLdl {
    symbolic: Option<SymbolicCholesky<usize>>,
    values: Vec<f64>,
    memory: Option<MemBuffer>,
}

fn library(error: impl std::fmt::Debug) -> LinearError {
    LinearError::Library(format!("{error:?}"))
}

/// Supernodal at every size: the automatic choice prefers the slower simplicial form below some
/// ten thousand unknowns.
fn analyse(
    n: usize,
    starts: &[usize],
    rows: &[usize],
) -> Result<SymbolicCholesky<usize>, LinearError> {
    let parameters = CholeskySymbolicParams {
        supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
        ..Default::default()
    };
    factorize_symbolic_cholesky(
        pattern(n, starts, rows),
        Side::Lower,
        SymmetricOrdering::Amd,
        parameters,
    )
    .map_err(library)
}

impl LinearSolver for FaerLdl {
    fn factorize(&mut self, a: CsMatView<'_, f64>) -> Result<(), LinearError> {
        let n = a.cols();
        let starts = a.indptr().to_proper().to_vec();
        let symbolic = match self.symbolic.take() {
            Some(symbolic) => symbolic,
            None => analyse(n, &starts, a.indices())?,
        };
        let symbolic = self.symbolic.insert(symbolic);
        self.values.resize(symbolic.len_val(), 0.0);
        let parameters = Spec::default();
        let scratch = symbolic.factorize_numeric_ldlt_scratch::<f64>(Par::Seq, parameters);
        let mut memory = MemBuffer::try_new(scratch).map_err(library)?;
        symbolic
            .factorize_numeric_ldlt(
                &mut self.values,
                SparseColMatRef::new(pattern(n, &starts, a.indices()), a.data()),
                Side::Lower,
                LdltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut memory),
                parameters,
            )
            .map_err(library)?;
        check_pivots(pivots(symbolic, &self.values))
    }

    fn solve(&mut self, b: &mut [f64]) {
        let Some(symbolic) = &self.symbolic else {
            return;
        };
        let n = symbolic.nrows();
        if n == 0 || b.is_empty() {
            return;
        }
        let columns = b.len() / n;
        let scratch = symbolic.solve_in_place_scratch::<f64>(columns, Par::Seq);
        let memory = match self.memory.take() {
            Some(memory) if memory.len() >= scratch.unaligned_bytes_required() => memory,
            _ => MemBuffer::new(scratch),
        };
        let memory = self.memory.insert(memory);
        LdltRef::new(symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(b, n, columns),
            Par::Seq,
            MemStack::new(memory),
        );
    }
}

/// Diagonal of D with the unknowns it belongs to.
fn pivots<'a>(
    symbolic: &'a SymbolicCholesky<usize>,
    values: &'a [f64],
) -> Box<dyn Iterator<Item = (usize, f64)> + 'a> {
    let SymbolicCholeskyRaw::Supernodal(supernodal) = symbolic.raw() else {
        return Box::new(std::iter::empty());
    };
    let factor = SupernodalLdltRef::new(supernodal, values);
    let order = symbolic.perm().map(|p| p.arrays().0);
    Box::new((0..supernodal.n_supernodes()).flat_map(move |s| {
        let node = factor.supernode(s);
        let block = node.val();
        (0..block.ncols()).map(move |j| {
            let position = node.start() + j;
            (
                order.map_or(position, |order| order[position]),
                block[(j, j)],
            )
        })
    }))
}
