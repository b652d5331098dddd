//! The direct solver: order and symbolic analysis by faer, once for each pattern, numeric factors and what is done
//! with them.

use std::sync::{Arc, Mutex, PoisonError};

use faer::Side;
use faer::perm::PermRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use rayon::prelude::*;
use sprs::CsMatView;

use super::multifrontal::{Elimination, Factor, Substitution, inverse_at};
use super::ordering::{Pattern, minimum_degree};
use super::solver::check_pivots;
use super::{LinearError, LinearSolver};

/// What matrices of one pattern have in common.
#[derive(Default)]
struct Analysis {
    pattern: Pattern,
    /// Room for their factors.
    factor: Factor,
    elimination: Elimination,
}

impl Analysis {
    /// The same, as yet without factors.
    fn again(&self) -> Self {
        Analysis {
            pattern: self.pattern.clone(),
            factor: self.factor.without_values(),
            elimination: self.elimination.again(),
        }
    }
}

/// Place where the first of two solvers that analyses a pattern leaves the analysis for the other.
type Handover = Arc<Mutex<Option<Analysis>>>;

/// Multifrontal LDL^T with an approximate minimum degree order and the supernodes of faer's analysis.
#[derive(Default)]
pub struct FaerLdl {
    analysis: Analysis,
    /// Until it has been used.
    handover: Option<Handover>,
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
    let pivots = minimum_degree(pattern)?;
    let mut positions = vec![0; pivots.len()];
    for (position, &unknown) in pivots.iter().enumerate() {
        positions[unknown] = position;
    }
    let order = PermRef::new_checked(&pivots, &positions, pivots.len());
    let order = SymmetricOrdering::Custom(order);
    factorize_symbolic_cholesky(pattern.symbolic(), Side::Lower, order, parameters).map_err(library)
}

/// Entries of the factor L of a matrix with one unknown per node, `neighbours` being the other nodes
/// that each node is coupled with, in increasing order, and itself; 0 where the analysis fails.
pub fn factor_entries(neighbours: &[Vec<usize>]) -> usize {
    let pattern = Pattern::of_graph(neighbours);
    analyse(&pattern).map_or(0, |symbolic| symbolic.len_val())
}

impl Analysis {
    /// Analyses the pattern of a matrix; the room for its factors has no memory yet.
    fn new(a: CsMatView<'_, f64>) -> Result<Self, LinearError> {
        let pattern = Pattern::of(a);
        let symbolic = analyse(&pattern)?;
        let factor = match (symbolic.raw(), symbolic.perm()) {
            (SymbolicCholeskyRaw::Supernodal(raw), Some(order)) => {
                Factor::new(raw, order.arrays().0)
            }
            _ if pattern.size() == 0 => Factor::default(),
            _ => return Err(LinearError::Library("analysis without supernodes".into())),
        };
        Ok(Analysis {
            elimination: Elimination::new(&factor, a),
            factor,
            pattern,
        })
    }
}

impl FaerLdl {
    /// Two solvers, one of which takes over the analysis of the other where both begin with the same pattern.
    pub fn two() -> [Self; 2] {
        let handover = Handover::default();
        [(); 2].map(|()| FaerLdl {
            handover: Some(Arc::clone(&handover)),
            ..FaerLdl::default()
        })
    }

    /// Analyses the pattern of a matrix.
    fn analyse(&mut self, a: CsMatView<'_, f64>) -> Result<(), LinearError> {
        // The factors of another pattern go first: two take much memory.
        self.analysis = Analysis::default();
        self.analysis = match self.handover.take() {
            None => Analysis::new(a)?,
            Some(handover) => {
                let mut left = handover.lock().unwrap_or_else(PoisonError::into_inner);
                match left.take().filter(|left| left.pattern.is_of(a)) {
                    Some(left) => left,
                    None => {
                        let analysis = Analysis::new(a)?;
                        let is_awaited = Arc::strong_count(&handover) > 1;
                        *left = is_awaited.then(|| analysis.again());
                        analysis
                    }
                }
            }
        };
        self.analysis.factor.make_room();
        Ok(())
    }
}

impl LinearSolver for FaerLdl {
    fn factorize(&mut self, a: CsMatView<'_, f64>) -> Result<(), LinearError> {
        if !self.analysis.pattern.is_of(a) {
            self.analyse(a)?;
        }
        let Analysis {
            factor,
            elimination,
            ..
        } = &mut self.analysis;
        elimination.eliminate(a.data(), factor);
        self.substitution.adapt(factor);
        check_pivots(factor.pivots())
    }

    fn begin(&mut self, b: &[f64]) {
        self.substitution.begin(&self.analysis.factor, b);
    }

    fn watch(&mut self, unknowns: &[usize]) {
        if self.substitution.has_paths() && self.watched == unknowns {
            return;
        }
        self.watched.clear();
        self.watched.extend_from_slice(unknowns);
        let places = unknowns
            .iter()
            .map(|&unknown| self.analysis.factor.places[unknown]);
        self.substitution.set_paths(&self.analysis.factor, places);
    }

    fn watched(&mut self, watched: &mut Vec<f64>) {
        self.substitution.on_paths(&self.analysis.factor);
        let places = self.watched.iter().map(|&u| self.analysis.factor.places[u]);
        watched.clear();
        watched.extend(places.map(|place| self.substitution.x(place)));
    }

    fn add(&mut self, b: &[(usize, f64)]) {
        let places = &self.analysis.factor.places;
        let entries = b.iter().map(|&(unknown, value)| (places[unknown], value));
        self.substitution.add(&self.analysis.factor, entries);
    }

    fn end(&mut self, x: &mut [f64]) {
        self.substitution.end(&self.analysis.factor, x);
    }

    fn inverse_at(&mut self, unknowns: &[&[usize]], _n: usize) -> Vec<Vec<f64>> {
        let factor = &self.analysis.factor;
        match factor.is_factorised_on_threads() {
            true => (unknowns.par_iter().map(|list| inverse_at(factor, list))).collect(),
            false => (unknowns.iter().map(|list| inverse_at(factor, list))).collect(),
        }
    }
}
