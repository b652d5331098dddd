//! Binding of faer's sparse Cholesky module: symbolic analysis once for each pattern, numeric factors, their pivots
//! and parts of the inverse.

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

use super::ordering::Pattern;
use super::partial_inverse::inverse_at;
use super::solver::check_pivots;
use super::{LinearError, LinearSolver};

/// Supernodal LDL^T of faer with an approximate minimum degree order, on one thread (a second one
/// makes matrices of this kind slower).
#[derive(Default)]
pub struct FaerLdl {
    symbolic: Option<SymbolicCholesky<usize>>,
    /// Pattern of the symbolic analysis.
    pattern: Pattern,
    values: Vec<f64>,
    memory: Option<MemBuffer>,
}

fn library(error: impl std::fmt::Debug) -> LinearError {
    LinearError::Library(format!("{error:?}"))
}

/// Supernodal at every size: the automatic choice prefers the slower simplicial form below some
/// ten thousand unknowns, and the library's own threshold for all still leaves it diagonal matrices,
/// whose factorisation takes no operations.
fn analyse(pattern: &Pattern) -> Result<SymbolicCholesky<usize>, LinearError> {
    let parameters = CholeskySymbolicParams {
        supernodal_flop_ratio_threshold: SupernodalThreshold(-1.0),
        ..Default::default()
    };
    factorize_symbolic_cholesky(
        pattern.symbolic(),
        Side::Lower,
        SymmetricOrdering::Amd,
        parameters,
    )
    .map_err(library)
}

/// Entries of the factor L of a matrix with one unknown per node, `neighbours` being the other nodes
/// that each node is coupled with, in increasing order, and itself; 0 where the analysis fails.
pub fn factor_entries(neighbours: &[Vec<usize>]) -> usize {
    let pattern = Pattern::of_graph(neighbours);
    analyse(&pattern).map_or(0, |symbolic| symbolic.len_val())
}

impl LinearSolver for FaerLdl {
    fn factorize(&mut self, a: CsMatView<'_, f64>) -> Result<(), LinearError> {
        let pattern = Pattern::of(a);
        let symbolic = match self.symbolic.take() {
            Some(symbolic) if self.pattern == pattern => symbolic,
            _ => analyse(&pattern)?,
        };
        self.pattern = pattern;
        let symbolic = self.symbolic.insert(symbolic);
        self.values.resize(symbolic.len_val(), 0.0);
        let parameters = Spec::default();
        let scratch = symbolic.factorize_numeric_ldlt_scratch::<f64>(Par::Seq, parameters);
        let mut memory = MemBuffer::try_new(scratch).map_err(library)?;
        symbolic
            .factorize_numeric_ldlt(
                &mut self.values,
                SparseColMatRef::new(self.pattern.symbolic(), a.data()),
                Side::Lower,
                LdltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut memory),
                parameters,
            )
            .map_err(library)?;
        check_pivots(pivots(symbolic, &self.values).into_iter())
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

    fn inverse_at(&mut self, unknowns: &[usize], _n: usize) -> Vec<f64> {
        let Some((symbolic, factor)) = self
            .symbolic
            .as_ref()
            .and_then(|symbolic| Some((symbolic, supernodal(symbolic, &self.values)?)))
        else {
            return Vec::new();
        };
        let position = |&unknown: &usize| match symbolic.perm() {
            Some(order) => order.arrays().1[unknown],
            None => unknown,
        };
        let positions: Vec<usize> = unknowns.iter().map(position).collect();
        inverse_at(factor, &positions)
    }
}

/// The factors of a supernodal analysis, which [`analyse`] always asks for.
fn supernodal<'a>(
    symbolic: &'a SymbolicCholesky<usize>,
    values: &'a [f64],
) -> Option<SupernodalLdltRef<'a, usize, f64>> {
    match symbolic.raw() {
        SymbolicCholeskyRaw::Supernodal(raw) => Some(SupernodalLdltRef::new(raw, values)),
        SymbolicCholeskyRaw::Simplicial(_) => None,
    }
}

/// Diagonal of D with the unknowns it belongs to.
fn pivots(symbolic: &SymbolicCholesky<usize>, values: &[f64]) -> Vec<(usize, f64)> {
    let Some(factor) = supernodal(symbolic, values) else {
        return Vec::new();
    };
    let order = symbolic.perm().map(|p| p.arrays().0);
    let of_node = |s: usize| {
        let node = factor.supernode(s);
        let block = node.val();
        (0..block.ncols()).map(move |j| {
            let position = node.start() + j;
            (
                order.map_or(position, |order| order[position]),
                block[(j, j)],
            )
        })
    };
    (0..factor.symbolic().n_supernodes())
        .flat_map(of_node)
        .collect()
}
