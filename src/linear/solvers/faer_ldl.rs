//! The direct solver: order and symbolic analysis by faer, once for each pattern, numeric factors and what is done
//! with them.

use std::sync::{Arc, Mutex, PoisonError};

use faer::Side;
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::linalg::{SupernodalThreshold, SymbolicSupernodalParams};
use rayon::prelude::*;
use sprs::CsMatView;

use super::multifrontal::{
    Elimination, Factor, InverseSpace, Substitution, Supernodes, inverse_at,
};
use super::ordering::{Groups, Pattern};
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
    inverse_space: InverseSpace,
}

fn library(error: impl std::fmt::Debug) -> LinearError {
    LinearError::Library(format!("{error:?}"))
}

/// Two supernodes one above the other with at most so many groups of unknowns are merged where less than this part of
/// their entries is zero: as faer does it, with a group, which is mostly a node, for two unknowns.
const MERGED: [(usize, f64); 4] = [(2, 1.0), (8, 0.8), (24, 0.1), (usize::MAX, 0.05)];

/// Supernodes of the factors of a matrix, and the unknown of every pivot. Unknowns with the same entries, as those of a
/// node, are analysed as one.
///
/// Supernodal at every size: the automatic choice prefers the slower simplicial form below some
/// ten thousand unknowns, and the library's own threshold for all still leaves it diagonal matrices,
/// whose factorisation takes no operations.
fn analyse(pattern: &Pattern) -> Result<(Supernodes, Vec<usize>), LinearError> {
    if pattern.size() == 0 {
        return Ok((Supernodes::default(), Vec::new()));
    }
    let parameters = CholeskySymbolicParams {
        supernodal_flop_ratio_threshold: SupernodalThreshold(-1.0),
        supernodal_params: SymbolicSupernodalParams {
            relax: Some(&MERGED),
        },
        ..Default::default()
    };
    let groups = Groups::of(pattern);
    let pivots = groups.minimum_degree()?;
    let mut positions = vec![0; pivots.len()];
    for (position, &group) in pivots.iter().enumerate() {
        positions[group] = position;
    }
    let order = PermRef::new_checked(&pivots, &positions, pivots.len());
    let order = SymmetricOrdering::Custom(order);
    let pattern = groups.pattern.symbolic();
    let symbolic = factorize_symbolic_cholesky(pattern, Side::Lower, order, parameters);
    let symbolic = symbolic.map_err(library)?;
    match (symbolic.raw(), symbolic.perm()) {
        (SymbolicCholeskyRaw::Supernodal(raw), Some(order)) => {
            let order = order.arrays().0;
            let supernodes = Supernodes::of_groups(raw, &groups.offsets(order));
            Ok((supernodes, groups.unknowns(order).collect()))
        }
        _ => Err(LinearError::Library("analysis without supernodes".into())),
    }
}

/// Entries of the factor L of a matrix with one unknown per node, `neighbours` being the other nodes
/// that each node is coupled with, in increasing order, and itself; 0 where the analysis fails.
pub fn factor_entries(neighbours: &[Vec<usize>]) -> usize {
    let pattern = Pattern::of_graph(neighbours);
    let entries = |supernodes: Supernodes| {
        let all = 0..supernodes.count();
        all.map(|s| supernodes.entries(s)).sum()
    };
    analyse(&pattern).map_or(0, |(supernodes, _)| entries(supernodes))
}

impl Analysis {
    /// Analyses the pattern of a matrix; the room for its factors has no memory yet.
    fn new(a: CsMatView<'_, f64>) -> Result<Self, LinearError> {
        let pattern = Pattern::of(a);
        let (supernodes, unknowns) = analyse(&pattern)?;
        let factor = Factor::new(&supernodes, &unknowns);
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
        let (factor, space) = (&self.analysis.factor, &mut self.inverse_space);
        if unknowns.len() > 1 && factor.is_factorised_on_threads() {
            let of_list = |list: &&[usize]| inverse_at(factor, list, &mut InverseSpace::default());
            return unknowns.par_iter().map(of_list).collect();
        }
        let lists = unknowns.iter();
        lists.map(|list| inverse_at(factor, list, space)).collect()
    }
}
