//! Predictor of the passes: bodies that are free, or turn about one node, go on as rigid bodies with finite rotation.
//! All other bodies move with the supports of the model if these supports all move alike. See docs/theory/time.md,
//! Predictor.

use crate::dynamics::results::State;
use crate::dynamics::step::{Hold, Interval, StepProblem, holds};
use crate::vectors::{cross, difference};

/// Relative difference of the displacement increments of two supports up to which they count as alike: the difference
/// is round-off.
const ALIKE: f64 = 64.0 * f64::EPSILON;

/// Rigid motion of a body, from sums over its nodes.
#[derive(Debug, Clone, Copy, Default)]
struct RigidMotion {
    mass: f64,
    /// Point about which the body turns: its centre of mass, or the pin.
    pole: [f64; 2],
    /// Displacement of the pole.
    shift: [f64; 2],
    /// Angular momentum about the pole.
    momentum: f64,
    /// Moment of inertia about the pole.
    inertia: f64,
}

/// Displacement increment, over all dofs, of the bodies that may move as rigid bodies:
///
/// ```text
/// d = shift + (R - 1) r,  R the rotation by 2 atan(omega dt/2),  omega = H/I
/// ```
///
/// Here r is the vector from the centre of mass, which moves by dt v_c, or from the pin. The first pass is linear about
/// the configuration of the predictor; a first pass about U0 would stretch a body that turns by the angle phi by
/// phi²/2. The bodies that cannot move as rigid bodies have the increment that all supports of the model share, or
/// zero.
pub(super) fn rigid_predictor(
    problem: &StepProblem,
    start: &State,
    interval: Interval,
) -> Vec<f64> {
    let mut d = vec![0.0; start.u.len()];
    if start.v.iter().all(|&v| v == 0.0) {
        return d;
    }
    let (body_of, dt) = (problem.parts.of_nodes(), interval.dt);
    let holds = holds(problem);
    let prescribed = (problem.unknowns).prescribed_increment([&start.u; 2], interval.end);
    let motions = motions(problem, &holds, start, dt, &prescribed);
    let of_supports = of_all_supports(problem, &start.u, &prescribed);
    for (node, &body) in body_of.iter().enumerate() {
        let RigidMotion {
            mass,
            pole,
            shift,
            momentum,
            inertia,
        } = motions[body];
        if holds[body] == Hold::Held {
            if node < problem.model.mesh.node_count() {
                (0..2).for_each(|i| d[2 * node + i] = of_supports[i]);
            }
            continue;
        }
        // a body without mass has no motion to continue
        if !(mass > 0.0 && inertia > 0.0) {
            continue;
        }
        let (sin, cos) = (2.0 * (momentum / inertia * dt / 2.0).atan()).sin_cos();
        let [x, y] = difference(pole, problem.position(&start.u, node));
        d[2 * node] = shift[0] + (cos - 1.0) * x - sin * y;
        d[2 * node + 1] = shift[1] + sin * x + (cos - 1.0) * y;
    }
    let is_prescribed = |dof: usize| problem.unknowns.is_prescribed(dof);
    (problem.unknowns.turning).predict(&start.v, dt, &mut d, is_prescribed);
    problem.unknowns.follow(&mut d);
    d
}

/// Displacement increment, along both axes, that all supports of the model share; zero if the supports move
/// differently. `prescribed` are the increments of the supports over all dofs.
fn of_all_supports(problem: &StepProblem, u0: &[f64], prescribed: &[f64]) -> [f64; 2] {
    let nodes = problem.model.mesh.node_count();
    [0, 1].map(|axis| {
        let supports = problem.unknowns.prescribed();
        let mut along = supports.filter(|dof| dof / 2 < nodes && dof % 2 == axis);
        let Some(first) = along.next().map(|dof| prescribed[dof]) else {
            return 0.0;
        };
        let is_alike = |dof: usize| {
            let least = ALIKE * (u0[dof].abs() + prescribed[dof].abs());
            (prescribed[dof] - first).abs() <= least
        };
        if along.all(is_alike) { first } else { 0.0 }
    })
}

/// Rigid motion of every body in an increment of length `dt`; `prescribed` are the displacement increments of the
/// supports.
fn motions(
    problem: &StepProblem,
    holds: &[Hold],
    start: &State,
    dt: f64,
    prescribed: &[f64],
) -> Vec<RigidMotion> {
    let body_of = problem.parts.of_nodes();
    let mut motions = vec![RigidMotion::default(); holds.len()];
    let mut rates = start.v.clone();
    for (node, &body) in body_of.iter().enumerate() {
        let motion = &mut motions[body];
        let (m, x) = (problem.mass.shares[node], problem.position(&start.u, node));
        motion.mass += m;
        for (i, x) in x.into_iter().enumerate() {
            motion.pole[i] += m * x;
            motion.shift[i] += m * start.v[2 * node + i];
        }
    }
    let with_mass = motions.iter_mut().zip(holds);
    for (motion, &hold) in with_mass.filter(|(motion, _)| motion.mass > 0.0) {
        let mass = motion.mass;
        motion.pole = motion.pole.map(|sum| sum / mass);
        motion.shift = motion.shift.map(|sum| dt * sum / mass);
        if let Hold::Pinned(pin) = hold {
            motion.pole = problem.position(&start.u, pin);
            motion.shift = [prescribed[2 * pin], prescribed[2 * pin + 1]];
        }
    }
    // H = sum r x M (v - v_pole), I = sum r.M r
    let mut arms = vec![0.0; start.u.len()];
    for (node, &body) in body_of.iter().enumerate() {
        let r = difference(motions[body].pole, problem.position(&start.u, node));
        for i in 0..2 {
            arms[2 * node + i] = r[i];
            rates[2 * node + i] -= motions[body].shift[i] / dt;
        }
    }
    let (p, weighted) = (problem.mass.times(&rates), problem.mass.times(&arms));
    for (node, &body) in body_of.iter().enumerate() {
        let at = |v: &[f64]| [v[2 * node], v[2 * node + 1]];
        motions[body].momentum += cross(at(&arms), at(&p));
        motions[body].inertia += crate::vectors::dot(at(&arms), at(&weighted));
    }
    motions
}
