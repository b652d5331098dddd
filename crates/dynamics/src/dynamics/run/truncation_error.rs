//! Truncation error of an increment, from the third derivative of the motion. See docs/theory/time.md, Automatic
//! increments.

use crate::dynamics::step::{Seen, StepProblem, System, dot};
use crate::linear::{LinearError, larger};
use crate::vectors::distance;

/// Data from which the truncation error of the increments of a step is computed.
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct TruncationError {
    /// Displacement at the start of the step.
    start: Vec<f64>,
    /// Largest displacement since the start of the step so far; its least value is the length by which fits separate
    /// surfaces in the step.
    travel: f64,
    /// Truncation error that the step allows.
    tolerance: f64,
    /// The last two increments, the latest last; at first the list holds only the start of the step, as an increment of
    /// length 0.
    last: Vec<Past>,
}

/// An increment whose result is known.
#[derive(serde::Serialize, serde::Deserialize)]
struct Past {
    /// Mean acceleration, including impulses and landing returns.
    acceleration: Vec<f64>,
    /// Length (time).
    dt: f64,
}

/// Data of an increment: displacement at its end, and velocities before and after.
pub(crate) struct Ends<'a> {
    pub u1: &'a [f64],
    pub v0: &'a [f64],
    pub v1: &'a [f64],
    pub dt: f64,
}

impl Ends<'_> {
    /// Mean acceleration A = (V1 - V0)/dt.
    fn acceleration(&self) -> impl Iterator<Item = f64> {
        let both = self.v1.iter().zip(self.v0);
        both.map(|(v1, v0)| (v1 - v0) / self.dt)
    }
}

impl TruncationError {
    /// Data at the start of a step: displacement and acceleration there, the length `parted` by which the fits of the
    /// step separate surfaces, and the error that the step allows.
    pub fn new([u, a]: [&[f64]; 2], parted: f64, tolerance: f64) -> Self {
        TruncationError {
            start: u.to_vec(),
            travel: parted,
            tolerance,
            last: vec![Past {
                acceleration: a.to_vec(),
                dt: 0.0,
            }],
        }
    }

    /// Truncation error of an increment in the displacements:
    ///
    /// ```text
    /// e = (dt³/12) (A - A_2)/(dt/2 + dt_1 + dt_2/2)    eq. (4.22)
    /// ```
    ///
    /// Here the index 1 is the last increment and 2 the increment before it: a motion that is too stiff for the
    /// increments changes its sign in each increment.
    pub fn of(&self, problem: &StepProblem, ends: &Ends) -> Vec<f64> {
        let (before, since) = match &self.last[..] {
            [earlier, later] => (earlier, later.dt + earlier.dt / 2.0),
            others => (&others[0], 0.0),
        };
        let factor = ends.dt.powi(3) / (12.0 * (ends.dt / 2.0 + since));
        let both = ends.acceleration().zip(&before.acceleration);
        let mut e: Vec<f64> = both.map(|(a, last)| factor * (a - last)).collect();
        (problem.unknowns.prescribed()).for_each(|dof| e[dof] = 0.0);
        e
    }

    /// The part of an error that is not too stiff for increments of length `dt`, where `k` is the K* of these
    /// increments.
    ///
    /// ```text
    /// e <- K*^-1 (2/dt²) M e    eq. (4.24)
    /// ```
    ///
    /// # Errors
    /// The factors of K* cannot be used.
    pub fn filter(
        problem: &StepProblem,
        mut k: System,
        dt: f64,
        e: &[f64],
    ) -> Result<Vec<f64>, LinearError> {
        let m_e = problem.mass.times(e);
        let c = problem.integration.mass_factor(dt);
        let force: Vec<f64> = m_e.iter().map(|m_e| c * m_e).collect();
        let mut e = k.respond(&force)?;
        (problem.unknowns.prescribed()).for_each(|dof| e[dof] = 0.0);
        Ok(e)
    }

    /// The largest error of a body, in the norm of the body's mass, relative to the largest displacement of the step so
    /// far. An error in a body's displacements that the passes do not resolve counts as within the tolerance.
    ///
    /// ```text
    /// sqrt(e.M e/m)/max |U - U_start|    eq. (4.23)
    /// ```
    pub fn relative(&self, problem: &StepProblem, seen: &Seen, ends: &Ends, e: &[f64]) -> f64 {
        let StepProblem { mass, parts, .. } = problem;
        let m_e = mass.times(e);
        let mut of_bodies = vec![[0.0; 2]; parts.bodies()];
        for (node, &body) in parts.of_nodes().iter().enumerate() {
            let dofs = 2 * node..2 * node + 2;
            of_bodies[body][0] += dot(&e[dofs.clone()], &m_e[dofs]);
            of_bodies[body][1] += mass.shares[node];
        }
        let travel = larger(self.travel, self.travel_to(ends.u1));
        let unresolved = seen.unresolved(problem, ends.u1);
        let of_body = |([e_m_e, m], unresolved): (&[f64; 2], &f64)| {
            let error = if *m > 0.0 { (e_m_e / m).sqrt() } else { 0.0 };
            match larger(travel, unresolved / self.tolerance) {
                0.0 => 0.0,
                travel => error / travel,
            }
        };
        let all = of_bodies.iter().zip(&unresolved);
        all.map(of_body).fold(0.0, larger)
    }

    /// Enters an accepted increment with its motion.
    pub fn accept(&mut self, ends: &Ends) {
        self.travel = larger(self.travel, self.travel_to(ends.u1));
        if self.last.len() == 2 {
            self.last.remove(0);
        }
        self.last.push(Past {
            acceleration: ends.acceleration().collect(),
            dt: ends.dt,
        });
    }

    /// Largest displacement from the start of the step.
    fn travel_to(&self, u: &[f64]) -> f64 {
        let of_node = |dofs: (&[f64], &[f64])| match dofs {
            ([x, y], [x0, y0]) => distance([*x0, *y0], [*x, *y]),
            _ => 0.0,
        };
        let nodes = u.chunks_exact(2).zip(self.start.chunks_exact(2));
        nodes.map(of_node).fold(0.0, larger)
    }
}
