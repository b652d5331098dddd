//! Binding of faer's sparse Cholesky module: symbolic analysis once for each pattern, numeric factors, their pivots
//! and parts of the inverse.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::LdltRegularization;
use faer::sparse::SparseColMatRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::supernodal::SupernodalLdltRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::{Par, Side, Spec};
use sprs::CsMatView;

use super::ordering::Pattern;
use super::partial_inverse::inverse_at;
use super::solver::check_pivots;
use super::substitution::Substitution;
use super::{LinearError, LinearSolver};

/// Supernodal LDL^T of faer with an approximate minimum degree order, on one thread (a second one
/// makes matrices of this kind slower).
#[derive(Default)]
pub struct FaerLdl {
    symbolic: Option<SymbolicCholesky<usize>>,
    /// Pattern of the symbolic analysis.
    pattern: Pattern,
    values: Vec<f64>,
    substitution: Substitution,
    /// Unknowns of the paths of the substitution.
    watched: Vec<usize>,
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
        self.substitution.forget_paths();
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

    fn begin(&mut self, b: &[f64]) {
        let Self {
            symbolic,
            values,
            substitution,
            ..
        } = self;
        if let Some((factor, order)) = factor_and_order(symbolic, values) {
            substitution.begin(factor, order.pivots.iter().map(|&unknown| b[unknown]));
        }
    }

    fn watch(&mut self, unknowns: &[usize]) {
        if self.substitution.has_paths() && self.watched == unknowns {
            return;
        }
        self.watched.clear();
        self.watched.extend_from_slice(unknowns);
        if let Some((factor, order)) = factor_and_order(&self.symbolic, &self.values) {
            let positions: Vec<usize> = unknowns.iter().map(|&u| order.positions[u]).collect();
            self.substitution.set_paths(factor, &positions);
        }
    }

    fn watched(&mut self, watched: &mut Vec<f64>) {
        watched.clear();
        if let Some((factor, order)) = factor_and_order(&self.symbolic, &self.values) {
            let x = self.substitution.on_paths(factor);
            watched.extend(
                self.watched
                    .iter()
                    .map(|&unknown| x[order.positions[unknown]]),
            );
        }
    }

    fn add(&mut self, b: &[(usize, f64)]) {
        if let Some((factor, order)) = factor_and_order(&self.symbolic, &self.values) {
            let entries = b
                .iter()
                .map(|&(unknown, value)| (order.positions[unknown], value));
            self.substitution.add(factor, entries);
        }
    }

    fn end(&mut self, x: &mut [f64]) {
        if let Some((factor, order)) = factor_and_order(&self.symbolic, &self.values) {
            let solution = self.substitution.end(factor);
            for (&unknown, value) in order.pivots.iter().zip(solution) {
                x[unknown] = *value;
            }
        }
    }

    fn inverse_at(&mut self, unknowns: &[usize], _n: usize) -> Vec<f64> {
        let Some((factor, order)) = factor_and_order(&self.symbolic, &self.values) else {
            return Vec::new();
        };
        let positions: Vec<usize> = unknowns.iter().map(|&u| order.positions[u]).collect();
        inverse_at(factor, &positions)
    }
}

/// The order of pivots.
#[derive(Clone, Copy)]
struct Order<'a> {
    /// Unknown of every pivot.
    pivots: &'a [usize],
    /// Pivot of every unknown.
    positions: &'a [usize],
}

/// The factors and their order, if there are any.
fn factor_and_order<'a>(
    symbolic: &'a Option<SymbolicCholesky<usize>>,
    values: &'a [f64],
) -> Option<(SupernodalLdltRef<'a, usize, f64>, Order<'a>)> {
    let symbolic = symbolic.as_ref()?;
    let (pivots, positions) = symbolic.perm()?.arrays();
    let factor = supernodal(symbolic, values)?;
    Some((factor, Order { pivots, positions }))
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
