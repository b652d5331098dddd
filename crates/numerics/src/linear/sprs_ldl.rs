//! Binding of the library sprs-ldl, a simplicial factorisation that shares no code with the multifrontal one. Parts of
//! the inverse come from solves with unit right-hand sides.

use sprs::{CsMat, PermOwned, SymmetryCheck};
use sprs_ldl::{LdlNumeric, LdlSymbolic};

use super::multifrontal::minimum_degree;
use super::solver::{LinearError, LinearSolver, check_pivots};
use super::symmetric::{Pattern, SymmetricMatrix};

/// Up-looking LDL^T of sprs-ldl with an approximate minimum degree order: the reference for the multifrontal
/// implementation.
#[derive(Default)]
pub struct SprsLdl {
    order: Vec<usize>,
    /// Pattern of the order and the factor.
    pattern: Pattern,
    /// The pivot of a matrix of one unknown: the library needs at least two unknowns.
    single: Option<f64>,
    factor: Option<LdlNumeric<f64, usize>>,
    /// Right-hand side of a solve.
    b: Vec<f64>,
    watched: Vec<usize>,
}

impl LinearSolver for SprsLdl {
    fn factorize(&mut self, a: &SymmetricMatrix) -> Result<(), LinearError> {
        if a.size() < 2 {
            self.single = a.values.first().copied();
            return check_pivots(self.single.into_iter().map(|pivot| (0, pivot)));
        }
        let library = |error| LinearError::Library(format!("{error}"));
        let matrix = of_library(a);
        let matrix = matrix.view();
        match &mut self.factor {
            Some(factor) if self.pattern == a.pattern => factor.update(matrix).map_err(library)?,
            _ => {
                self.order = minimum_degree(&a.pattern)?;
                let permutation = PermOwned::new(self.order.clone());
                let check = SymmetryCheck::DontCheckSymmetry;
                let symbolic = LdlSymbolic::new_perm(matrix, permutation, check);
                self.factor = Some(symbolic.factor(matrix).map_err(library)?);
                self.pattern = a.pattern.clone();
            }
        }
        let Some(factor) = &self.factor else {
            return Ok(());
        };
        check_pivots(self.order.iter().copied().zip(factor.d().iter().copied()))
    }

    fn give_up_factors(&mut self) {
        *self = SprsLdl::default();
    }

    fn begin(&mut self, b: &[f64]) {
        self.b = b.to_vec();
    }

    fn watch(&mut self, unknowns: &[usize]) {
        self.watched = unknowns.to_vec();
    }

    fn watched(&mut self, values: &mut Vec<f64>) {
        let x = self.solution();
        values.clear();
        values.extend(self.watched.iter().map(|&unknown| x[unknown]));
    }

    fn add(&mut self, b: &[(usize, f64)]) {
        b.iter()
            .for_each(|&(unknown, value)| self.b[unknown] += value);
    }

    fn end(&mut self, x: &mut [f64]) {
        x.copy_from_slice(&self.solution());
    }
}

/// A matrix in the form of the library.
fn of_library(a: &SymmetricMatrix) -> CsMat<f64> {
    let of_library = |all: &[u32]| all.iter().map(|&index| index as usize).collect();
    let starts = of_library(a.pattern.starts());
    let rows = of_library(a.pattern.all_rows());
    CsMat::new_csc((a.size(), a.size()), starts, rows, a.values.clone())
}

impl SprsLdl {
    fn solution(&self) -> Vec<f64> {
        match (&self.factor, self.single) {
            (Some(factor), _) => factor.solve(&self.b),
            (None, Some(pivot)) => self.b.iter().map(|value| value / pivot).collect(),
            (None, None) => Vec::new(),
        }
    }
}
