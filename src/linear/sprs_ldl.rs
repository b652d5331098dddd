//! Binding of the sprs-ldl library, a simplicial factorisation independent of faer's; parts of the
//! inverse come from unit right-hand sides.

use sprs::{CsMatView, PermOwned, SymmetryCheck};
use sprs_ldl::{LdlNumeric, LdlSymbolic};

use super::ordering::{Pattern, minimum_degree};
use super::solver::check_pivots;
use super::{LinearError, LinearSolver};

/// Up-looking LDL^T of sprs-ldl with an approximate minimum degree order: the reference
/// implementation beside faer.
#[derive(Default)]
pub struct SprsLdl {
    order: Vec<usize>,
    /// Pattern of the order and the factor.
    pattern: Pattern,
    /// The library needs at least two unknowns; the pivot of a single one.
    single: Option<f64>,
    factor: Option<LdlNumeric<f64, usize>>,
}

impl LinearSolver for SprsLdl {
    fn factorize(&mut self, a: CsMatView<'_, f64>) -> Result<(), LinearError> {
        if a.cols() < 2 {
            self.single = a.data().first().copied();
            return check_pivots(self.single.into_iter().map(|pivot| (0, pivot)));
        }
        let library = |error| LinearError::Library(format!("{error}"));
        let pattern = Pattern::of(a);
        match &mut self.factor {
            Some(factor) if self.pattern == pattern => factor.update(a).map_err(library)?,
            _ => {
                self.order = minimum_degree(a)?;
                let permutation = PermOwned::new(self.order.clone());
                let check = SymmetryCheck::DontCheckSymmetry;
                let symbolic = LdlSymbolic::new_perm(a, permutation, check);
                self.factor = Some(symbolic.factor(a).map_err(library)?);
                self.pattern = pattern;
            }
        }
        let Some(factor) = &self.factor else {
            return Ok(());
        };
        check_pivots(self.order.iter().copied().zip(factor.d().iter().copied()))
    }

    fn solve(&mut self, b: &mut [f64]) {
        if let Some(pivot) = self.single {
            b.iter_mut().for_each(|value| *value /= pivot);
        }
        let Some(factor) = &self.factor else { return };
        let n = factor.problem_size();
        for column in b.chunks_exact_mut(n) {
            let x = factor.solve(&*column);
            column.copy_from_slice(&x);
        }
    }
}
