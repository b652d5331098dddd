//! Multifrontal LDL^T factorisation (Duff & Reid 1983), substitutions and parts of the inverse, by branches of the
//! elimination forest. The approximate minimum degree order (Amestoy, Davis & Duff 1996) and the symbolic analysis come
//! from faer, once for each pattern. docs/numerics.md, Factorisation.
//!
//! The numerical part is own code for its speed. For the matrix of two blocks with 132 612 dofs a factorisation needs
//! 86 ms (faer: 152 ms), and 45 ms on two threads (faer: no gain); a solve needs 6.9 ms (faer: 20 ms)
//! (docs/numerics.md).

mod elimination;
mod factor;
mod front;
mod partial_inverse;
mod substitution;
mod supernodes;
#[cfg(test)]
mod tests;

use std::ops::Range;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use faer::Side;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::linalg::{SupernodalThreshold, SymbolicSupernodalParams, amd};
use rayon::prelude::*;

use super::solver::{LinearError, LinearSolver, check_pivots};
use super::symmetric::{Pattern, SymmetricMatrix};
pub use elimination::{Elimination, FrontSpace};
pub use factor::{Factor, FactorLayout};
pub use partial_inverse::inverse_at;
pub use substitution::Substitution;
pub use supernodes::Supernodes;

/// Analysis that all matrices of one pattern share.
#[derive(Default)]
struct Analysis {
    pattern: Pattern,
    layout: Arc<FactorLayout>,
    elimination: Elimination,
}

/// Data that two solvers share.
#[derive(Default)]
struct Shared {
    /// Memory of the factorisations.
    space: FrontSpace,
    /// The last analysis of either solver.
    analysis: Option<Arc<Analysis>>,
}

/// Multifrontal LDL^T with an approximate minimum degree order and the supernodes of faer's analysis.
#[derive(Default)]
pub struct MultifrontalLdl {
    analysis: Arc<Analysis>,
    factor: Factor,
    shared: Arc<Mutex<Shared>>,
    substitution: Substitution,
    /// Unknowns whose paths the substitution follows.
    watched: Vec<usize>,
}

fn library(error: impl std::fmt::Debug) -> LinearError {
    LinearError::Library(format!("{error:?}"))
}

/// Rule for merging a supernode with its parent: if both have at most this many groups of unknowns, they are merged if
/// less than this part of their entries is zero. The rule for merging supernodes is that of faer, with one group
/// (mostly a node) in place of two unknowns.
const MERGED: [(usize, f64); 4] = [(2, 1.0), (8, 0.8), (24, 0.1), (usize::MAX, 0.05)];

/// Supernodes of the factors of a matrix, and the unknown of every pivot. Unknowns with the same entries, such as those
/// of a node, are analysed as one group.
///
/// The supernodal form is forced at every size. The automatic choice of the library prefers the slower simplicial form
/// below about ten thousand unknowns; even its threshold for the supernodal form leaves out diagonal matrices, whose
/// factorisation needs no operations.
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
    let pattern = groups.quotient.symbolic();
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

/// Number of entries of the factor L of a matrix with one unknown per node; 0 if the analysis fails. `neighbours`
/// lists, for each node, the node itself and the nodes that it is coupled with, in increasing order.
pub fn factor_entries(neighbours: &[Vec<usize>]) -> usize {
    let pattern = Pattern::of_graph(neighbours);
    let entries = |supernodes: Supernodes| {
        let all = 0..supernodes.count();
        all.map(|s| supernodes.entries(s)).sum()
    };
    analyse(&pattern).map_or(0, |(supernodes, _)| entries(supernodes))
}

impl Analysis {
    /// Analyses the pattern of a matrix.
    fn new(pattern: &Pattern) -> Result<Self, LinearError> {
        let (supernodes, unknowns) = analyse(pattern)?;
        let layout = FactorLayout::new(&supernodes, &unknowns);
        drop(supernodes);
        Ok(Analysis {
            elimination: Elimination::new(&layout, pattern),
            layout: Arc::new(layout),
            pattern: pattern.clone(),
        })
    }
}

impl MultifrontalLdl {
    /// Two solvers that share memory. If the pattern is the same, a solver uses the last analysis of the other one.
    pub fn two() -> [Self; 2] {
        let shared = Arc::default();
        [(); 2].map(|()| MultifrontalLdl {
            shared: Arc::clone(&shared),
            ..MultifrontalLdl::default()
        })
    }

    /// Analyses a pattern and makes room for its factors.
    fn analyse(&mut self, pattern: &Pattern) -> Result<(), LinearError> {
        // The factors of another pattern go first, but for their memory.
        let memory = std::mem::take(&mut self.factor).into_memory();
        self.analysis = Arc::default();
        let last = locked(&self.shared).analysis.take();
        self.analysis = match last.filter(|last| last.pattern == *pattern) {
            Some(last) => last,
            None => Arc::new(Analysis::new(pattern)?),
        };
        locked(&self.shared).analysis = Some(Arc::clone(&self.analysis));
        self.factor = Factor::new(Arc::clone(&self.analysis.layout), memory);
        Ok(())
    }
}

/// The shared data, locked for one solver.
fn locked(shared: &Mutex<Shared>) -> MutexGuard<'_, Shared> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

impl LinearSolver for MultifrontalLdl {
    fn factorize(&mut self, a: &SymmetricMatrix) -> Result<(), LinearError> {
        if self.analysis.pattern != a.pattern {
            self.analyse(&a.pattern)?;
        }
        let Self {
            analysis,
            factor,
            shared,
            ..
        } = self;
        let space = &mut locked(shared).space;
        analysis.elimination.eliminate(&a.values, factor, space);
        self.substitution.adapt(&self.factor);
        check_pivots(self.factor.pivots())
    }

    fn give_up_factors(&mut self) {
        let shared = Arc::clone(&self.shared);
        *self = MultifrontalLdl {
            shared,
            ..MultifrontalLdl::default()
        };
    }

    fn begin(&mut self, b: &[f64]) {
        self.substitution.begin(&self.factor, b);
    }

    fn watch(&mut self, unknowns: &[usize]) {
        if self.substitution.has_paths() && self.watched == unknowns {
            return;
        }
        self.watched.clear();
        self.watched.extend_from_slice(unknowns);
        let places = unknowns.iter().map(|&unknown| self.factor.places[unknown]);
        self.substitution.set_paths(&self.factor, places);
    }

    fn watched(&mut self, watched: &mut Vec<f64>) {
        self.substitution.on_paths(&self.factor);
        let places = self.watched.iter().map(|&u| self.factor.places[u]);
        watched.clear();
        watched.extend(places.map(|place| self.substitution.x(place)));
    }

    fn add(&mut self, b: &[(usize, f64)]) {
        let places = &self.factor.places;
        let entries = b.iter().map(|&(unknown, value)| (places[unknown], value));
        self.substitution.add(&self.factor, entries);
    }

    fn end(&mut self, x: &mut [f64]) {
        self.substitution.end(&self.factor, x);
    }

    fn inverse_at(&mut self, unknowns: &[&[usize]], _n: usize) -> Vec<Vec<f64>> {
        let factor = &self.factor;
        let of_list = |list: &&[usize]| inverse_at(factor, list);
        match unknowns.len() > 1 && factor.is_factorised_on_threads() {
            true => unknowns.par_iter().map(of_list).collect(),
            false => unknowns.iter().map(of_list).collect(),
        }
    }
}

/// Groups of unknowns next to each other with the same entries, such as those of a node; a group is ordered as one
/// unknown.
pub(super) struct Groups {
    /// First unknown of every group, and the number of unknowns.
    starts: Vec<usize>,
    /// The pattern between groups.
    quotient: Quotient,
}

/// A pattern between groups of unknowns, in the form of faer.
struct Quotient {
    /// First entry of every column, and the number of entries at the end.
    starts: Vec<usize>,
    /// Rows of the entries, column after column, in increasing order.
    rows: Vec<usize>,
}

impl Quotient {
    /// The pattern between groups; `groups` holds the first unknown of each group, and the number of unknowns at the
    /// end.
    fn new(pattern: &Pattern, groups: &[usize]) -> Self {
        let mut group_of = vec![0; pattern.size()];
        for (group, ends) in groups.windows(2).enumerate() {
            group_of[ends[0]..ends[1]].fill(group);
        }
        let mut quotient = Quotient {
            starts: vec![0],
            rows: Vec::new(),
        };
        for &first in &groups[..groups.len() - 1] {
            let column = pattern
                .rows(first)
                .iter()
                .map(|&row| group_of[row as usize]);
            let mut last = None;
            quotient
                .rows
                .extend(column.filter(|&group| last.replace(group) != Some(group)));
            quotient.starts.push(quotient.rows.len());
        }
        quotient
    }

    /// The pattern in the form of the library.
    fn symbolic(&self) -> SymbolicSparseColMatRef<'_, usize> {
        let n = self.starts.len() - 1;
        SymbolicSparseColMatRef::new_checked(n, n, &self.starts, None, &self.rows)
    }
}

impl Groups {
    /// The groups of a pattern.
    pub fn of(pattern: &Pattern) -> Self {
        let begins = |&k: &usize| k == 0 || pattern.rows(k) != pattern.rows(k - 1);
        let mut starts: Vec<usize> = (0..pattern.size()).filter(begins).collect();
        starts.push(pattern.size());
        Groups {
            quotient: Quotient::new(pattern, &starts),
            starts,
        }
    }

    /// Approximate minimum degree order: entry k is the group of pivot k.
    pub fn minimum_degree(&self) -> Result<Vec<usize>, LinearError> {
        let count = self.starts.len() - 1;
        let (mut order, mut inverse) = (vec![0; count], vec![0; count]);
        let scratch = amd::order_scratch::<usize>(count, self.quotient.rows.len());
        amd::order(
            &mut order,
            &mut inverse,
            self.quotient.symbolic(),
            amd::Control::default(),
            MemStack::new(&mut MemBuffer::new(scratch)),
        )
        .map_err(|error| LinearError::Library(format!("{error:?}")))?;
        Ok(order)
    }

    fn unknowns_of(&self, group: usize) -> Range<usize> {
        self.starts[group]..self.starts[group + 1]
    }

    /// The unknowns of the groups, in this order of the groups.
    pub fn unknowns(&self, order: &[usize]) -> impl Iterator<Item = usize> {
        order.iter().flat_map(|&group| self.unknowns_of(group))
    }

    /// Place of the first unknown of every group, in this order of the groups, and the number of unknowns at the end.
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
