//! The complementarity problems, general and frictional (in Delassus form), their solutions and errors.
//! See docs/theory/complementarity.md.

use std::ops::AddAssign;

use nalgebra::{DMatrix, DVector};
use thiserror::Error;

use super::dense::add_product;
use crate::linear::{SMALLEST, larger, largest};

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
    /// w = M z + q, recomputed from the data.
    pub w: DVector<f64>,
    /// Scaled residual of (z, w), see [`residual`](super::residual::residual()).
    pub residual: f64,
    /// Number of basis exchanges.
    pub pivots: usize,
}

/// Reason why a problem was not solved.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum LcpError {
    /// The path of Lemke's method ends on a secondary ray.
    #[error("ray after {pivots} pivots{}", list(.members))]
    Ray {
        /// Number of basis exchanges until then.
        pivots: usize,
        /// Unknowns that grow without bound along the ray: positions in z, or contacts of a frictional problem, which
        /// press against each other.
        members: Vec<usize>,
    },
    /// The path does not end within the allowed number of exchanges.
    #[error("no solution within {pivots} pivots")]
    PivotLimit {
        /// Number of basis exchanges until then.
        pivots: usize,
    },
    /// The point found does not satisfy the conditions.
    #[error("residual {value:e} exceeds {tolerance:e}")]
    Residual {
        /// Residual of the point found.
        value: f64,
        /// Largest residual that is accepted.
        tolerance: f64,
    },
    /// The data, or the scaled data, contain a number that is infinite or NaN.
    #[error("the problem contains a number that is not finite")]
    NotFinite,
    /// The sizes of the data do not agree.
    #[error("{what}: expected size {expected}, found {found}")]
    Size {
        /// Name of the item with the wrong size.
        what: &'static str,
        /// Size required by the rest of the data.
        expected: usize,
        /// Size given.
        found: usize,
    },
    /// A number lies outside its range.
    #[error("{what} must not be {value:e} (entry {index})")]
    Range {
        /// Name of the item that is out of range.
        what: &'static str,
        /// Position of the number.
        index: usize,
        /// Value of the number.
        value: f64,
    },
}

/// Text for the members of a ray; empty if there are none.
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

/// Coulomb friction of n coupled contacts, eq. (8.2) with the law of eq. (3.6). Find Pn, Pt with
///
/// ```text
/// g  = Qnn Pn + Qnt Pt + gap     g >= 0,  Pn >= 0,  g Pn = 0
/// Dt = Qtn Pn + Qtt Pt + slip    |Pt| <= mu Pn,  Dt = 0 while |Pt| < mu Pn,
///                                Dt opposes Pt where |Pt| = mu Pn
/// ```
///
/// Q is a compliance (length/force), positive definite or semidefinite. The proof that a solution is found requires a
/// symmetric Q; the methods also solve problems with other Q.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionalLcp {
    /// Q (2n x 2n): n rows and columns of normal directions, then n of tangential directions.
    pub q: DMatrix<f64>,
    /// Gaps without contact forces (length n), positive when open.
    pub gap: DVector<f64>,
    /// Slips without contact forces (length n).
    pub slip: DVector<f64>,
    /// Friction coefficients (length n), zero or positive.
    pub mu: DVector<f64>,
    /// Unknowns without a sign, on which gaps and slips depend as well.
    pub free: FreeUnknowns,
}

/// Unknowns x without a sign, eq. (8.8), which add to gaps and slips; their forces are in balance with the contact
/// forces.
///
/// ```text
/// (g, Dt) = Q P + D x + (gap, slip),   (S + E) x = L^T P + h
/// ```
///
/// S may be singular; E bounds motions that no contact sees.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeUnknowns {
    /// D (2n x m): gaps, then slips, per unit of each unknown (dimensionless).
    pub motions: DMatrix<f64>,
    /// L (2n x m): weights of the normal, then of the tangential forces in the balance of each unknown (dimensionless).
    pub works: DMatrix<f64>,
    /// S (m x m): stiffness without contact (force/length).
    pub stiffness: DMatrix<f64>,
    /// E (m x m): stiffness that is small compared with that of the contacts (force/length).
    pub regular: DMatrix<f64>,
    /// h: forces without contact (length m, force).
    pub force: DVector<f64>,
}

impl Default for FreeUnknowns {
    /// A problem without free unknowns.
    fn default() -> Self {
        let none = || DMatrix::zeros(0, 0);
        FreeUnknowns {
            motions: none(),
            works: none(),
            stiffness: none(),
            regular: none(),
            force: DVector::zeros(0),
        }
    }
}

impl FreeUnknowns {
    /// Number of unknowns m.
    pub fn len(&self) -> usize {
        self.force.len()
    }

    /// Whether there are no free unknowns.
    pub fn is_empty(&self) -> bool {
        self.force.is_empty()
    }

    /// Largest residual force of the balance (S + E) x = L^T P + h.
    pub(crate) fn left_over(&self, x: &[f64], p: &[f64]) -> f64 {
        if self.is_empty() {
            return 0.0;
        }
        let [x, p] = [x, p].map(DVector::from_column_slice);
        let left = (&self.stiffness + &self.regular) * x - self.works.tr_mul(&p) - &self.force;
        largest(left.as_slice())
    }

    /// The unknowns x that are in balance with forces P.
    pub(crate) fn balanced(&self, p: &[f64]) -> DVector<f64> {
        let force = self.works.tr_mul(&DVector::from_column_slice(p)) + &self.force;
        let x = (&self.stiffness + &self.regular).lu().solve(&force);
        x.unwrap_or_else(|| DVector::zeros(self.len()))
    }

    /// Refuses sizes that do not fit to n contacts, and numbers that are not finite.
    pub(crate) fn check(&self, n: usize) -> Result<(), LcpError> {
        let m = self.len();
        if m == 0 {
            return Ok(());
        }
        for (rows, matrix) in [
            (2 * n, &self.motions),
            (2 * n, &self.works),
            (m, &self.stiffness),
            (m, &self.regular),
        ] {
            expect_size("rows of free unknowns", rows, matrix.nrows())?;
            expect_size("columns of free unknowns", m, matrix.ncols())?;
            expect_finite(matrix.as_slice())?;
        }
        expect_finite(self.force.as_slice())
    }
}

impl FrictionalLcp {
    /// Number of contacts.
    pub fn len(&self) -> usize {
        self.gap.len()
    }

    /// Whether there are no contacts.
    pub fn is_empty(&self) -> bool {
        self.gap.is_empty()
    }

    /// Whether a contact penetrates. An overlap is no penetration if it is so small that the force against it would
    /// lose digits or vanish.
    pub(crate) fn penetrates(&self) -> bool {
        let least = self.smallest_length();
        self.gap.iter().any(|gap| *gap <= -least)
    }

    /// Mean compliance of the contacts, the mean of Qnn_ii; 1 without contacts.
    pub(crate) fn compliance(&self) -> f64 {
        let n = self.len();
        let mean = (0..n).map(|i| self.q[(i, i)]).sum::<f64>() / n as f64;
        match mean > 0.0 && mean.is_finite() {
            true => mean,
            false => 1.0,
        }
    }

    /// Smallest length for which the contact force still has all its digits.
    pub(crate) fn smallest_length(&self) -> f64 {
        SMALLEST * larger(self.compliance(), 1.0)
    }

    /// Refuses wrong sizes, negative mu and numbers that are not finite.
    pub fn check(&self) -> Result<(), LcpError> {
        let n = self.len();
        expect_size("rows of Q", 2 * n, self.q.nrows())?;
        expect_size("columns of Q", 2 * n, self.q.ncols())?;
        expect_size("slip", n, self.slip.len())?;
        expect_size("mu", n, self.mu.len())?;
        for values in [self.q.as_slice(), self.gap.as_slice(), self.slip.as_slice()] {
            expect_finite(values)?;
        }
        expect_finite(self.mu.as_slice())?;
        self.free.check(n)?;
        expect_non_negative("mu", self.mu.as_slice())
    }

    /// Gaps and slips under the forces (pn, pt), with zero free unknowns.
    pub fn motion(&self, pn: &DVector<f64>, pt: &DVector<f64>) -> (DVector<f64>, DVector<f64>) {
        let n = self.len();
        let mut motion: Vec<f64> = self.gap.iter().chain(&self.slip).copied().collect();
        let forces: Vec<f64> = pn.iter().chain(pt).copied().collect();
        add_product(self.q.as_slice(), &forces, &mut motion);
        (
            DVector::from_column_slice(&motion[..n]),
            DVector::from_column_slice(&motion[n..]),
        )
    }

    /// The general problem with three unknowns per contact, z = (Pn, T+, Dt-), w = (g, Dt+, T-),
    /// where Pt = T+ - T-, mu Pn = T+ + T-, Dt = Dt+ - Dt-, eq. (8.3):
    ///
    /// ```text
    /// M = [ Qnn - Qnt mu   2 Qnt   0 ]      q = [ gap  ]
    ///     [ Qtn - Qtt mu   2 Qtt   I ]          [ slip ]
    ///     [ mu             -I      0 ]          [ 0    ]
    /// ```
    ///
    /// Free unknowns are eliminated.
    pub fn to_lcp(&self) -> Lcp {
        if !self.free.is_empty() {
            return self.eliminated().to_lcp();
        }
        let n = self.len();
        let mut m = DMatrix::zeros(3 * n, 3 * n);
        for j in 0..n {
            for i in 0..2 * n {
                m[(i, j)] = self.q[(i, j)] - self.q[(i, n + j)] * self.mu[j];
                m[(i, n + j)] = 2.0 * self.q[(i, n + j)];
            }
            m[(n + j, 2 * n + j)] = 1.0;
            m[(2 * n + j, j)] = self.mu[j];
            m[(2 * n + j, n + j)] = -1.0;
        }
        let q = self.gap.iter().chain(&self.slip).copied();
        let q = DVector::from_iterator(3 * n, q.chain(std::iter::repeat_n(0.0, n)));
        Lcp { m, q }
    }

    /// The problem whose general form is `lcp` with friction coefficients `mu`; `None` if `lcp` does not have the
    /// blocks of [`to_lcp`](Self::to_lcp) to 1e-9 of its largest entry of Q.
    pub fn from_lcp(lcp: &Lcp, mu: &DVector<f64>) -> Option<Self> {
        let n = mu.len();
        if lcp.check().is_err() || lcp.q.len() != 3 * n {
            return None;
        }
        // Qnt and Qtt from the second block column, Qnn from the first, Qtn by symmetry
        let half = |i: usize, j: usize| 0.5 * lcp.m[(i, n + j)];
        let normal = |i: usize, j: usize| lcp.m[(i, j)] + half(i, j) * mu[j];
        let q = DMatrix::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
            (true, true) => 0.5 * (normal(i, j) + normal(j, i)),
            (false, true) => half(j, i - n),
            (_, false) => half(i, j - n),
        });
        let slip = lcp.q.rows(n, n).into_owned();
        let problem = Self {
            q,
            gap: lcp.q.rows(0, n).into_owned(),
            slip,
            mu: mu.clone(),
            free: FreeUnknowns::default(),
        };
        let same = problem.to_lcp();
        let size = problem.q.amax() * (1.0 + mu.amax());
        let friction_rows = same.m.rows(2 * n, n) == lcp.m.rows(2 * n, n);
        let others = (same.m.rows(0, 2 * n) - lcp.m.rows(0, 2 * n)).amax() <= 1e-9 * size;
        (friction_rows && others && same.q == lcp.q).then_some(problem)
    }
}

/// State of a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub enum ContactState {
    /// No force: Pn = Pt = 0, gap >= 0.
    Open,
    /// gap = 0, slip = 0, |Pt| <= mu Pn.
    Stick,
    /// gap = 0, slip >= 0, Pt = -mu Pn.
    SlipPlus,
    /// gap = 0, slip <= 0, Pt = mu Pn.
    SlipMinus,
}

impl ContactState {
    /// Whether the contact may carry a force.
    pub fn is_closed(self) -> bool {
        self != Self::Open
    }

    /// Sign of the slip: 1 or -1, and 0 for a state that does not slide.
    pub fn slip_sign(self) -> f64 {
        match self {
            Self::SlipPlus => 1.0,
            Self::SlipMinus => -1.0,
            Self::Open | Self::Stick => 0.0,
        }
    }

    /// The sliding state for a slip of this sign; stick for zero slip.
    pub(crate) fn sliding(slip: f64) -> Self {
        if slip > 0.0 {
            Self::SlipPlus
        } else if slip < 0.0 {
            Self::SlipMinus
        } else {
            Self::Stick
        }
    }
}

/// Work done by the methods.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counters {
    /// Basis exchanges of Lemke's method.
    pub pivots: usize,
    /// Number of solves of the active set, with one factorisation each.
    pub active_set_iterations: usize,
    /// Number of sweeps of the Gauss-Seidel iteration over all contacts.
    pub gauss_seidel_sweeps: usize,
    /// Number of problems given to Lemke's method.
    pub lemke_calls: usize,
}

impl AddAssign for Counters {
    fn add_assign(&mut self, other: Self) {
        self.pivots += other.pivots;
        self.active_set_iterations += other.active_set_iterations;
        self.gauss_seidel_sweeps += other.gauss_seidel_sweeps;
        self.lemke_calls += other.lemke_calls;
    }
}

/// The method that produced a solution.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// No contact penetrates, so there are no forces.
    Trivial,
    /// Active set on the contact states.
    ActiveSet,
    /// Lemke's method.
    Lemke,
}

/// Solution of a [`FrictionalLcp`](crate::lcp::FrictionalLcp).
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionalSolution {
    /// Normal forces, zero in open contacts.
    pub pn: DVector<f64>,
    /// Tangential forces, exactly -+mu Pn in sliding contacts.
    pub pt: DVector<f64>,
    /// Gaps under these forces.
    pub gap: DVector<f64>,
    /// Slips under these forces.
    pub slip: DVector<f64>,
    /// States of the contacts.
    pub state: Vec<ContactState>,
    /// Free unknowns x.
    pub free: DVector<f64>,
    /// Whether the contacts hold the free unknowns stable.
    pub stability: Stability,
    /// Scaled residual of the contact conditions.
    pub residual: f64,
    /// The method that found the states.
    pub method: Method,
    /// Work done by all methods that were tried.
    pub counters: Counters,
}

/// Whether the contacts of a solution hold its free unknowns stable.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Stability {
    /// No motion of the free unknowns is unstable.
    #[default]
    Stable,
    /// No motion is unstable, after a body has tipped over to another contact.
    Tipped,
    /// A motion is unstable, and no contact was found to which the body tips over.
    Unstable,
}

/// Memory of a solution that is not needed any more, to be used by the next solution.
#[derive(Default)]
pub(super) struct Spare {
    vectors: [Vec<f64>; 4],
    pub states: Vec<ContactState>,
}

impl Spare {
    /// Keeps the memory of a solution.
    pub fn take(&mut self, solution: FrictionalSolution) {
        let FrictionalSolution {
            pn,
            pt,
            gap,
            slip,
            state,
            ..
        } = solution;
        self.vectors = [pn, pt, gap, slip].map(|vector| vector.data.into());
        self.states = state;
    }

    /// A copy of `values` in the i-th kept vector.
    pub fn vector(&mut self, i: usize, values: &[f64]) -> DVector<f64> {
        let mut vector = std::mem::take(&mut self.vectors[i]);
        vector.clear();
        vector.extend_from_slice(values);
        DVector::from_vec(vector)
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

#[cfg(test)]
mod frictional_tests {
    use super::*;

    fn problem() -> FrictionalLcp {
        let a = DMatrix::from_fn(4, 4, |i, j| 1.0 / (1.0 + i as f64 + 2.0 * j as f64));
        FrictionalLcp {
            q: &a * a.transpose() + DMatrix::identity(4, 4),
            gap: DVector::from_row_slice(&[-1.0, 0.5]),
            slip: DVector::from_row_slice(&[0.25, -0.5]),
            mu: DVector::from_row_slice(&[0.3, 0.0]),
            free: FreeUnknowns::default(),
        }
    }

    #[test]
    fn general_form_and_back() {
        let p = problem();
        let back = FrictionalLcp::from_lcp(&p.to_lcp(), &p.mu).unwrap();
        assert!((&back.q - &p.q).amax() < 1e-15);
        assert_eq!((back.gap, back.slip), (p.gap.clone(), p.slip.clone()));
        let mut other = p.to_lcp();
        other.m[(0, 5)] = 1.0;
        assert!(FrictionalLcp::from_lcp(&other, &p.mu).is_none());
        assert!(FrictionalLcp::from_lcp(&p.to_lcp(), &DVector::zeros(1)).is_none());
    }

    #[test]
    fn general_form_states_the_same_motion() {
        // z = (Pn, T+, Dt-) with Pt = 2 T+ - mu Pn gives w = (g, Dt + Dt-, mu Pn - T+).
        let p = problem();
        let (pn, t) = (
            DVector::from_row_slice(&[2.0, 1.0]),
            DVector::from_row_slice(&[0.4, 0.0]),
        );
        let pt = 2.0 * &t - p.mu.component_mul(&pn);
        let (gap, slip) = p.motion(&pn, &pt);
        let z = DVector::from_iterator(6, pn.iter().chain(&t).copied().chain([0.0, 0.0]));
        let w = p.to_lcp().w(&z);
        assert!((w.rows(0, 2) - gap).amax() < 1e-14 && (w.rows(2, 2) - slip).amax() < 1e-14);
        assert_eq!(w[4], p.mu[0] * pn[0] - t[0]);
    }

    #[test]
    fn frictional_problem_captures_errors() {
        let mut p = problem();
        p.mu[1] = -0.5;
        assert!(matches!(
            p.check(),
            Err(LcpError::Range {
                what: "mu",
                index: 1,
                ..
            })
        ));
        let mut p = problem();
        p.slip = DVector::zeros(3);
        assert!(matches!(
            p.check(),
            Err(LcpError::Size { what: "slip", .. })
        ));
        let mut p = problem();
        p.gap[0] = f64::INFINITY;
        assert_eq!(p.check(), Err(LcpError::NotFinite));
    }
}
