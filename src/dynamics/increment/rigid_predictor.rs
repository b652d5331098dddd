//! Predictor of the passes: bodies that are free, or turn about one node, go on as rigid bodies with
//! finite rotation; bodies whose supports all move alike move with them. Section 4 of docs/theory.md, Predictor.

use crate::dynamics::results::State;
use crate::dynamics::step::{Hold, Interval, StepProblem, holds};
use crate::vectors::{cross, difference};

/// Displacement increments of two supports that differ by this part of their displacements are alike: they differ by round-off.
const ALIKE: f64 = 64.0 * f64::EPSILON;

/// Sums over the nodes of a body.
#[derive(Debug, Clone, Copy, Default)]
struct RigidMotion {
    mass: f64,
    /// What the body turns about: its centre of mass, or the pin.
    pole: [f64; 2],
    /// Displacement of the pole.
    shift: [f64; 2],
    /// Angular momentum about the pole.
    momentum: f64,
    /// Moment of inertia about the pole.
    inertia: f64,
}

/// Displacement increment, over all dofs, of the bodies that may move as rigid bodies; zero elsewhere.
///
/// ```text
/// d = shift + (R - 1) r,  R the rotation by 2 atan(omega dt/2),  omega = H/I
/// ```
///
/// r from the centre of mass, which moves by dt v_c, or from the pin. The first pass is linear about
/// this configuration: from U0 a body that turns by the angle phi would be stretched by phi²/2.
pub(super) fn rigid_predictor(
    problem: &StepProblem,
    start: &State,
    interval: Interval,
) -> Vec<f64> {
    let mut d = vec![0.0; start.u.len()];
    let is_prescribed = |dof: usize| problem.unknowns.is_prescribed(dof);
    (problem.unknowns.turning).predict(&start.v, interval.dt, &mut d, is_prescribed);
    if start.v.iter().all(|&v| v == 0.0) {
        return d;
    }
    let (body_of, dt) = (problem.parts.of_nodes(), interval.dt);
    let holds = holds(problem);
    let prescribed = (problem.unknowns).prescribed_increment([&start.u; 2], interval.end);
    let motions = motions(problem, &holds, start, dt, &prescribed);
    let of_supports = of_supports(problem, &start.u, &prescribed);
    let leading = problem.unknowns.turning.leading();
    leading
        .filter(|&dof| is_prescribed(dof))
        .for_each(|dof| d[dof] = prescribed[dof]);
    for (node, &body) in body_of.iter().enumerate() {
        let RigidMotion {
            mass,
            pole,
            shift,
            momentum,
            inertia,
        } = motions[body];
        if holds[body] == Hold::Held {
            let of_nodes = 0..problem.model.mesh.node_count();
            for i in (0..2).filter(|_| of_nodes.contains(&node)) {
                if let Shift::Alike(shift) = of_supports[body][i] {
                    d[2 * node + i] = shift;
                }
            }
            continue;
        }
        // without mass there is no motion to go on with
        if !(mass > 0.0 && inertia > 0.0) {
            continue;
        }
        let (sin, cos) = (2.0 * (momentum / inertia * dt / 2.0).atan()).sin_cos();
        let [x, y] = difference(pole, problem.position(&start.u, node));
        d[2 * node] = shift[0] + (cos - 1.0) * x - sin * y;
        d[2 * node + 1] = shift[1] + sin * x + (cos - 1.0) * y;
    }
    problem.unknowns.follow(&mut d);
    d
}

/// What the supports of a body do along an axis in an increment.
#[derive(Debug, Clone, Copy, Default)]
enum Shift {
    /// There are none.
    #[default]
    Unsupported,
    /// All have this displacement increment (length).
    Alike(f64),
    /// They have several.
    Unlike,
}

/// Displacement increments of the supports of every body along both axes: those of `prescribed`, over all dofs.
fn of_supports(problem: &StepProblem, u0: &[f64], prescribed: &[f64]) -> Vec<[Shift; 2]> {
    let mut shifts = vec![[Shift::Unsupported; 2]; problem.parts.bodies()];
    let of_nodes = 0..2 * problem.model.mesh.node_count();
    let supports = problem.unknowns.prescribed();
    for dof in supports.filter(|dof| of_nodes.contains(dof)) {
        let shift = &mut shifts[problem.parts.of_nodes()[dof / 2]][dof % 2];
        let least = ALIKE * (u0[dof].abs() + prescribed[dof].abs());
        *shift = match *shift {
            Shift::Unsupported => Shift::Alike(prescribed[dof]),
            Shift::Alike(other) if (prescribed[dof] - other).abs() <= least => Shift::Alike(other),
            _ => Shift::Unlike,
        };
    }
    shifts
}

/// Rigid motion of every body in an increment of length `dt`; `prescribed` are the increments of the supports.
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
