//! Stiffness of contacts against the free unknowns of a frictional problem, and elimination of these unknowns. See
//! docs/theory/complementarity.md, Free unknowns.

use nalgebra::{DMatrix, DVector};

use super::problems::{ContactState, FreeUnknowns, FrictionalLcp, FrictionalSolution};
use crate::linear::largest;

/// Increase of the diagonal, relative to its largest entry: contacts with identical conditions then share the load.
const SHIFT: f64 = 1e-10;

/// Negative stiffness, in units of E, that counts as none.
const COVERED: f64 = 10.0;

impl FrictionalLcp {
    /// The problem with `part` times E in place of E; this stiffness resists motion away from x = `from`.
    ///
    /// ```text
    /// (S + part E) x = L^T P + h + part E x_from    eq. (8.9)
    /// ```
    pub(crate) fn resisted(&self, part: f64, from: Option<&DVector<f64>>) -> Self {
        let mut resisted = self.clone();
        let free = &mut resisted.free;
        free.regular *= part;
        if let Some(x) = from {
            free.force += &free.regular * x;
        }
        resisted
    }

    /// The problem without free unknowns.
    ///
    /// ```text
    /// Q + D K^-1 L^T,   (gap, slip) + D K^-1 h,   K = S + E
    /// ```
    pub fn eliminated(&self) -> Self {
        let (n, free) = (self.len(), &self.free);
        let factors = (&free.stiffness + &free.regular).lu();
        let mut eliminated = FrictionalLcp {
            free: FreeUnknowns::default(),
            ..self.clone()
        };
        let solved = factors.solve(&free.works.transpose());
        if let (Some(by_forces), Some(alone)) = (solved, factors.solve(&free.force)) {
            eliminated.q += &free.motions * by_forces;
            let moved = &free.motions * alone;
            for i in 0..n {
                eliminated.gap[i] += moved[i];
                eliminated.slip[i] += moved[n + i];
            }
        }
        eliminated
    }

    /// The motion of the free unknowns with the most negative stiffness (8.10). `None` if E, times a factor, makes up
    /// for any negative stiffness. Contacts have the given states; closed ones with friction stick.
    pub(crate) fn unstable_motion(&self, states: &[ContactState]) -> Option<DVector<f64>> {
        if self.free.is_empty() {
            return None;
        }
        let held = |(state, mu): (&ContactState, &f64)| match state.is_closed() && *mu > 0.0 {
            true => ContactState::Stick,
            false => *state,
        };
        let held: Vec<ContactState> = states.iter().zip(&self.mu).map(held).collect();
        let stiffness = self.stiffness_under_contact(&held);
        let symmetric = (&stiffness + stiffness.transpose()) / 2.0;
        let covered = symmetric + &self.free.regular * COVERED;
        if covered.clone().cholesky().is_some() {
            return None;
        }
        let eigen = covered.symmetric_eigen();
        let least = eigen.eigenvalues.imin();
        Some(eigen.eigenvectors.column(least).into_owned())
    }

    /// States after an unstable body has tipped over: it moves along the motion n of the free unknowns until the first
    /// open contact closes.
    pub(crate) fn tipped(
        &self,
        solution: &FrictionalSolution,
        n: &DVector<f64>,
    ) -> Option<Vec<ContactState>> {
        let states = &solution.state;
        let open = (0..self.len()).filter(|&i| !states[i].is_closed());
        let rate = |row: usize| -> f64 {
            let terms = (0..n.len()).map(|k| self.free.motions[(row, k)] * n[k]);
            terms.sum()
        };
        // n goes on by -gap/rate
        let travel = |i: usize| -solution.gap[i].max(0.0) / rate(i);
        let first = open.min_by(|&i, &k| travel(i).abs().total_cmp(&travel(k).abs()))?;
        if !travel(first).is_finite() {
            return None;
        }
        let slip = solution.slip[first] + travel(first) * rate(self.len() + first);
        let mut tipped = states.clone();
        tipped[first] = ContactState::sliding(slip);
        Some(tipped)
    }

    /// Stiffness against the free unknowns with contacts in the given states.
    ///
    /// ```text
    /// S + L_a^T Q_aa^-1 D_a    eq. (8.10)
    /// ```
    ///
    /// Here a are the gaps of closed contacts and the slips of sticking ones; the normal force of a sliding contact
    /// includes its friction.
    pub fn stiffness_under_contact(&self, states: &[ContactState]) -> DMatrix<f64> {
        let (n, free) = (self.len(), &self.free);
        let closed = (0..n).filter(|&i| states[i].is_closed());
        let sticks = |&i: &usize| states[i] == ContactState::Stick && self.mu[i] > 0.0;
        let rows: Vec<usize> = closed.chain((0..n).filter(sticks).map(|i| n + i)).collect();
        if rows.is_empty() {
            return free.stiffness.clone();
        }
        // part of the friction in the column of a normal force
        let slide = |k: usize| match k < n {
            true => -states[k].slip_sign() * self.mu[k],
            false => 0.0,
        };
        let at = |matrix: &DMatrix<f64>, i: usize, k: usize| {
            let own = matrix[(i, k)];
            match slide(k) {
                0.0 => own,
                part => own + part * matrix[(i, n + k)],
            }
        };
        let size = rows.len();
        let mut q = DMatrix::from_fn(size, size, |i, k| at(&self.q, rows[i], rows[k]));
        let d = DMatrix::from_fn(size, free.len(), |i, k| free.motions[(rows[i], k)]);
        let works = free.works.transpose();
        let l = DMatrix::from_fn(free.len(), size, |i, k| at(&works, i, rows[k]));
        let shift = SHIFT * largest(q.diagonal().as_slice());
        (0..size).for_each(|i| q[(i, i)] += shift);
        match q.lu().solve(&d) {
            Some(forces) => &free.stiffness + l * forces,
            None => free.stiffness.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lcp::{LcpMethod, Method, Stability, solve_frictional};

    const WEIGHT: f64 = 3.0;

    /// A block on two elastic points at -1 and 1 from its middle, which may move up, along the ground, and turn. The
    /// weight of the block acts at `x`; the part `slope` of the weight acts along the ground. Each point yields by 1
    /// under a force of 1; its initial gap is `gap`.
    fn block(x: f64, slope: f64, gap: f64, mu: f64) -> FrictionalLcp {
        // gaps: y - x_i turn; slips: those of the motion along the ground
        let motions = DMatrix::from_row_slice(
            4,
            3,
            &[1.0, 0.0, -1.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0],
        );
        FrictionalLcp {
            q: DMatrix::identity(4, 4),
            gap: DVector::from_element(2, gap),
            slip: DVector::zeros(2),
            mu: DVector::from_element(2, mu),
            free: FreeUnknowns {
                works: motions.clone(),
                motions,
                stiffness: DMatrix::zeros(3, 3),
                regular: DMatrix::identity(3, 3) * 1e-10,
                force: DVector::from_row_slice(&[-WEIGHT, slope * WEIGHT, -x * WEIGHT]),
            },
        }
    }

    #[test]
    fn a_block_sinks_in_by_its_weight_from_any_height() {
        for gap in [0.0, 0.5, 100.0] {
            for method in [LcpMethod::Hybrid, LcpMethod::Lemke] {
                let found = solve_frictional(&block(0.5, 0.1, gap, 0.3), None, method);
                let found = found.expect("solved");
                // lever rule: W (1 -+ x)/2, and it turns by the difference of what the points yield
                for (pn, expected) in found.pn.iter().zip([WEIGHT / 4.0, 3.0 * WEIGHT / 4.0]) {
                    assert!((pn - expected).abs() < 1e-7 * (1.0 + gap), "{pn} {gap}");
                }
                let [y, _, turn] = [0, 1, 2].map(|k| found.free[k]);
                assert!(
                    (y + gap + WEIGHT / 2.0).abs() < 1e-7 * (1.0 + gap),
                    "{y} {gap}"
                );
                assert!((turn + WEIGHT / 4.0).abs() < 1e-7 * (1.0 + gap), "{turn}");
                assert!((found.pt.sum() + 0.1 * WEIGHT).abs() < 1e-7 * (1.0 + gap));
                assert_ne!(found.method, Method::Trivial);
            }
        }
    }

    #[test]
    fn what_contact_does_not_resist_moves_until_the_small_stiffness_holds_it() {
        // friction takes 0.3 of 0.5 of the weight
        let problem = block(0.0, 0.5, 0.0, 0.3);
        let found = solve_frictional(&problem, None, LcpMethod::Hybrid).expect("solved");
        let expected = 0.2 * WEIGHT / 1e-10;
        assert!((found.free[1] - expected).abs() < 1e-6 * expected);
        assert!(
            found
                .state
                .iter()
                .all(|state| *state == ContactState::SlipPlus)
        );
        let left = problem.stiffness_under_contact(&found.state);
        assert!((left[(0, 0)] - 2.0).abs() < 1e-8 && (left[(2, 2)] - 2.0).abs() < 1e-8);
        assert_eq!(left[(1, 1)], 0.0, "nothing resists the slide");
        let sticks = [ContactState::Stick; 2];
        let held = problem.stiffness_under_contact(&sticks);
        assert!((held[(1, 1)] - 2.0).abs() < 1e-8, "{held}");
    }

    #[test]
    fn beside_its_points_it_tips_over() {
        let problem = block(1.5, 0.0, 0.0, 0.3);
        let found = solve_frictional(&problem, None, LcpMethod::Hybrid).expect("solved");
        // about the second point, by the moment 0.5 W, which the small stiffness takes
        assert_eq!(found.pn[0], 0.0);
        assert!(found.free[2] < -1e8 && found.gap[0] > 1e8, "{}", found.free);
    }

    #[test]
    fn a_block_that_stands_on_one_point_tips_over_to_the_other() {
        // its weight is over the second point, and turns it on; the first one is open
        let on_a_point = |resists: f64| {
            let mut problem = block(1.0, 0.0, 0.0, 0.3);
            problem.gap[0] = 10.0;
            problem.free.stiffness[(2, 2)] = resists;
            let warm = [ContactState::Open, ContactState::Stick];
            solve_frictional(&problem, Some(&warm), LcpMethod::Hybrid).expect("solved")
        };
        let stands = on_a_point(1e2);
        assert_eq!(stands.stability, Stability::Stable);
        assert_eq!(stands.pn[0], 0.0);
        let tips = on_a_point(-0.5);
        assert_eq!(tips.stability, Stability::Tipped);
        assert!(tips.pn.iter().all(|pn| *pn > 0.0), "{}", tips.pn);
        assert!((tips.pn.sum() - WEIGHT).abs() < 1e-7);
    }

    #[test]
    fn eliminated_unknowns_leave_the_same_forces() {
        let problem = block(0.5, 0.1, 0.0, 0.3);
        let own = solve_frictional(&problem, None, LcpMethod::Hybrid).expect("solved");
        let stiff = problem.resisted(1e8, None);
        let with = solve_frictional(&stiff, None, LcpMethod::Hybrid).expect("solved");
        let without = solve_frictional(&stiff.eliminated(), None, LcpMethod::Lemke);
        let without = without.expect("solved");
        assert!((&with.pn - &without.pn).amax() < 1e-9 * WEIGHT);
        assert!((&with.pn - &own.pn).amax() > 1e-3, "another problem");
    }
}
