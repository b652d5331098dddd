//! The general problem, its solution and the errors of the solvers.

use nalgebra::{DMatrix, DVector};
use thiserror::Error;

use crate::linear::largest;

/// Find z >= 0 with w = M z + q >= 0 and z.w = 0, eq. (8.1).
#[derive(Debug, Clone, PartialEq)]
pub struct Lcp {
    /// Square matrix M.
    pub m: DMatrix<f64>,
    /// Right-hand side q.
    pub q: DVector<f64>,
}

/// Solution of an [`Lcp`].
#[derive(Debug, Clone, PartialEq)]
pub struct LcpSolution {
    /// The non-negative unknowns.
    pub z: DVector<f64>,
    /// w = M z + q, recomputed from M, q and z.
    pub w: DVector<f64>,
    /// Scaled residual of (z, w), see [`residual`](super::residual()).
    pub residual: f64,
    /// Number of basis exchanges.
    pub pivots: usize,
}

/// Why a problem was not solved.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum LcpError {
    /// The path of Lemke's method ended on a secondary ray.
    #[error("ray after {pivots} pivots{}", list(.members))]
    Ray {
        /// Basis exchanges until then.
        pivots: usize,
        /// Unknowns that grow without bound along the ray: positions in z, or contacts of a
        /// frictional problem (those that press against each other).
        members: Vec<usize>,
    },
    /// The path did not end within the allowed number of exchanges.
    #[error("no solution within {pivots} pivots")]
    PivotLimit {
        /// Basis exchanges until then.
        pivots: usize,
    },
    /// The point found does not satisfy the conditions.
    #[error("residual {value:e} exceeds {tolerance:e}")]
    Residual {
        /// Residual of the point found.
        value: f64,
        /// Largest residual accepted.
        tolerance: f64,
    },
    /// The data, or the data after scaling, contain an infinite number or one that is not a number.
    #[error("the problem contains a number that is not finite")]
    NotFinite,
    /// The sizes of the data do not agree.
    #[error("{what}: expected size {expected}, found {found}")]
    Size {
        /// The item of the wrong size.
        what: &'static str,
        /// Size required by the rest of the data.
        expected: usize,
        /// Size given.
        found: usize,
    },
    /// A number lies outside its range.
    #[error("{what} must not be {value:e} (entry {index})")]
    Range {
        /// The item out of range.
        what: &'static str,
        /// Its position.
        index: usize,
        /// Its value.
        value: f64,
    },
}

/// Text for the members of a ray: nothing when there are none.
fn list(members: &[usize]) -> String {
    let shown: Vec<String> = members.iter().take(20).map(usize::to_string).collect();
    match (members.len(), shown.len()) {
        (0, _) => String::new(),
        (all, few) if all > few => format!(" through {}, ... ({all} in all)", shown.join(", ")),
        _ => format!(" through {}", shown.join(", ")),
    }
}

impl Lcp {
    /// w = M z + q.
    pub fn w(&self, z: &DVector<f64>) -> DVector<f64> {
        &self.m * z + &self.q
    }

    /// Refuses wrong sizes and numbers that are not finite.
    pub fn check(&self) -> Result<(), LcpError> {
        let size = self.q.len();
        expect_size("rows of M", size, self.m.nrows())?;
        expect_size("columns of M", size, self.m.ncols())?;
        expect_finite(self.m.as_slice())?;
        expect_finite(self.q.as_slice())
    }
}

/// Fails unless `found` is `expected`.
pub(crate) fn expect_size(
    what: &'static str,
    expected: usize,
    found: usize,
) -> Result<(), LcpError> {
    if expected == found {
        Ok(())
    } else {
        Err(LcpError::Size {
            what,
            expected,
            found,
        })
    }
}

/// Fails unless every number is finite.
pub(crate) fn expect_finite(values: &[f64]) -> Result<(), LcpError> {
    if largest(values).is_finite() {
        Ok(())
    } else {
        Err(LcpError::NotFinite)
    }
}

/// Fails unless every number is zero or positive.
pub(crate) fn expect_non_negative(what: &'static str, values: &[f64]) -> Result<(), LcpError> {
    match values.iter().position(|v| *v < 0.0) {
        None => Ok(()),
        Some(index) => Err(LcpError::Range {
            what,
            index,
            value: values[index],
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn problem_captures_errors() {
        let lcp = Lcp {
            m: DMatrix::zeros(2, 3),
            q: DVector::zeros(2),
        };
        assert_eq!(
            lcp.check().unwrap_err().to_string(),
            "columns of M: expected size 2, found 3"
        );
        let lcp = Lcp {
            m: DMatrix::zeros(1, 1),
            q: DVector::from_element(1, f64::NAN),
        };
        assert_eq!(lcp.check().unwrap_err(), LcpError::NotFinite);
        assert_eq!(
            expect_non_negative("mu", &[0.0, -1.0])
                .unwrap_err()
                .to_string(),
            "mu must not be -1e0 (entry 1)"
        );
    }

    #[test]
    fn a_ray_names_its_members() {
        let ray = |members: Vec<usize>| LcpError::Ray { pivots: 3, members }.to_string();
        assert_eq!(ray(vec![]), "ray after 3 pivots");
        assert_eq!(ray(vec![4, 7]), "ray after 3 pivots through 4, 7");
        assert!(ray((0..50).collect()).ends_with("19, ... (50 in all)"));
    }
}
