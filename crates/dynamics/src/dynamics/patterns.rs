//! Patterns of velocity along which energy is given back, with the momenta of their loads. See
//! docs/theory/impacts.md, Landing return.

use super::results::Cause;
use super::step::{Hold, StepProblem, Workspace, holds};
use crate::vectors::{cross, difference, dot};

/// A load along whose response energy is given back.
pub(crate) struct ReturnLoad {
    /// Nodal forces over all dofs, at the end positions; for a pair these forces are Gn^T.
    pub force: Vec<f64>,
    /// Friction that is taken back together with the load.
    pub friction: Option<FrictionLoad>,
    /// Energy that is to be given back along the response.
    pub energy: f64,
    /// Largest absolute value of the share, at which the impulse of the return equals the impulse of the force in the
    /// increment.
    pub most: f64,
    /// Whether the share may be negative, which means that a force of the increment is taken back.
    pub pulls: bool,
}

/// The friction of the pair of a load.
pub(crate) struct FrictionLoad {
    /// Nodal forces over all dofs; for a pair these forces are (Pt/Pn) Gt^T.
    pub force: Vec<f64>,
    /// Work c of friction that the share y = -1 takes back (energy).
    pub work: f64,
}

/// A pattern of velocity along which energy is given back.
#[derive(Clone)]
pub(super) struct VelocityPattern {
    /// Velocities w over all dofs.
    pub w: Vec<f64>,
    /// M w.
    pub momentum: Vec<f64>,
}

impl VelocityPattern {
    /// Adds another pattern to the pattern.
    pub fn add(&mut self, other: &VelocityPattern) {
        let add = |sum: &mut [f64], v: &[f64]| sum.iter_mut().zip(v).for_each(|(s, v)| *s += v);
        add(&mut self.w, &other.w);
        add(&mut self.momentum, &other.momentum);
    }
}

/// The velocity pattern of a load at the end of an increment of length `dt`, with the bodies in the configuration
/// `bodies`.
///
/// The pattern w = K*^-1 Gn^T, eq. (6.6), is, up to a factor, the change of the end velocity by the load.
///
/// # Errors
/// Returns an error if a solve with K* fails.
pub(super) fn pattern(
    problem: &StepProblem,
    workspace: &mut Workspace,
    dt: f64,
    bodies: &RigidBodies,
    force: &[f64],
) -> Result<VelocityPattern, Cause> {
    let mut w = (workspace.k()).respond(force)?;
    bodies.correct(problem, dt, force, &mut w);
    bodies.keep_turning(problem, &mut w);
    let momentum = problem.mass.times(&w);
    Ok(VelocityPattern { w, momentum })
}

/// For every body whether it contains a rigid body that turns in the step; a rigid body whose rotation is held moves as
/// other bodies do.
pub(super) fn turning_bodies(problem: &StepProblem) -> Vec<bool> {
    let mut turns = vec![false; problem.parts.bodies()];
    let turning = problem.unknowns.turning.bodies.iter();
    for body in turning.filter(|body| !problem.unknowns.is_held(body.spin)) {
        turns[problem.parts.of_nodes()[body.centre]] = true;
    }
    turns
}

/// The free bodies, regarded as rigid.
pub(super) struct RigidBodies {
    is_free: Vec<bool>,
    /// For every body whether it contains a rigid body that turns.
    turns: Vec<bool>,
    /// Mass and moment of inertia of every body.
    inertia: Vec<[f64; 2]>,
    /// Arms of the nodes from the centres of mass, over all dofs.
    arms: Vec<f64>,
}

impl RigidBodies {
    /// The free bodies at the displacements `u`.
    pub fn new(problem: &StepProblem, u: &[f64]) -> Self {
        let is_free: Vec<bool> = holds(problem).iter().map(|&h| h == Hold::Free).collect();
        let body_of = problem.parts.of_nodes();
        let mut sums = vec![[0.0; 3]; is_free.len()];
        for (node, &body) in body_of.iter().enumerate() {
            let (m, [x, y]) = (problem.mass.shares[node], problem.position(u, node));
            add(&mut sums[body], [m, m * x, m * y]);
        }
        let arm = |(node, &body): (usize, &usize)| match (is_free[body], sums[body]) {
            (true, [m, x, y]) if m > 0.0 => difference([x / m, y / m], problem.position(u, node)),
            _ => [0.0; 2],
        };
        let arms = body_of.iter().enumerate().flat_map(arm).collect();
        let mut bodies = RigidBodies {
            is_free,
            turns: turning_bodies(problem),
            inertia: sums.iter().map(|[m, ..]| [*m, 0.0]).collect(),
            arms,
        };
        let weighted = problem.mass.times(&bodies.arms);
        for (node, &body) in body_of.iter().enumerate() {
            bodies.inertia[body][1] += dot(at(&bodies.arms, node), at(&weighted, node));
        }
        bodies
    }

    /// Velocity V_s of the supports over all dofs, if the dofs have the velocities `v`. The velocity V_s is one vector
    /// for each body. The component of V_s in a direction is the mean velocity of the supports in this direction;
    /// without supports it is the mean velocity of the mass.
    pub fn support_velocity(&self, problem: &StepProblem, v: &[f64]) -> Vec<f64> {
        let body_of = problem.parts.of_nodes();
        // sums of the velocities and their number, and of the momenta and masses
        let mut held = vec![[[0.0; 2]; 2]; self.is_free.len()];
        let mut moving = held.clone();
        let mut is_angle = vec![false; v.len() / 2];
        for body in problem.unknowns.turning.bodies {
            is_angle[body.spin / 2] = true;
        }
        for dof in (problem.unknowns.prescribed()).filter(|dof| !is_angle[dof / 2]) {
            let [sum, number] = &mut held[body_of[dof / 2]][dof % 2];
            (*sum, *number) = (*sum + v[dof], *number + 1.0);
        }
        let all = v.iter().enumerate();
        for (dof, v) in all.filter(|(dof, _)| !is_angle[dof / 2]) {
            let m = problem.mass.shares[dof / 2];
            let [sum, mass] = &mut moving[body_of[dof / 2]][dof % 2];
            (*sum, *mass) = (*sum + m * v, *mass + m);
        }
        let mean = |[sum, number]: [f64; 2]| (number > 0.0).then(|| sum / number);
        let of_dof = |dof: usize| {
            if is_angle[dof / 2] {
                return 0.0;
            }
            let at = |sums: &[[[f64; 2]; 2]]| mean(sums[body_of[dof / 2]][dof % 2]);
            at(&held).or_else(|| at(&moving)).unwrap_or(0.0)
        };
        (0..v.len()).map(of_dof).collect()
    }

    /// Sets a pattern to zero on bodies that contain a rigid body that turns: such bodies are given no energy.
    fn keep_turning(&self, problem: &StepProblem, w: &mut [f64]) {
        let body_of = problem.parts.of_nodes();
        let all = w.iter_mut().enumerate();
        all.filter(|(dof, _)| self.turns[body_of[dof / 2]])
            .for_each(|(_, w)| *w = 0.0);
    }

    /// Vibration: the part of the velocities `v` of the free bodies that is not a rigid motion, over all dofs.
    ///
    /// The vibration has no momenta, and is zero on bodies that are not free.
    pub fn vibration(&self, problem: &StepProblem, v: &[f64]) -> Vec<f64> {
        let mut vibration = v.to_vec();
        self.correct(problem, 0.0, &vec![0.0; v.len()], &mut vibration);
        let body_of = problem.parts.of_nodes();
        let of_dof = |(dof, v): (usize, f64)| {
            if self.is_free[body_of[dof / 2]] {
                v
            } else {
                0.0
            }
        };
        vibration.into_iter().enumerate().map(of_dof).collect()
    }

    /// For every body, the sum of forces or momenta over its dofs, and the sum of their moments.
    fn sums(&self, problem: &StepProblem, v: &[f64]) -> Vec<[f64; 3]> {
        let mut sums = vec![[0.0; 3]; self.is_free.len()];
        for (node, &body) in problem.parts.of_nodes().iter().enumerate() {
            let [x, y] = at(v, node);
            add(&mut sums[body], [x, y, cross(at(&self.arms, node), [x, y])]);
        }
        sums
    }

    /// Adds a rigid motion to every free body so that the body has exactly the momenta of its load,
    ///
    /// ```text
    /// w <- w + dv + domega e_z x r
    /// sum p = (dt²/2) sum f,  sum r x p = (dt²/2) sum r x f,   eq. (6.7)
    /// ```
    ///
    /// Here p = M w is the momentum of the pattern, f is the load, and r is the vector from the centre of mass. The
    /// response of K* alone does not have exactly the momenta of the load, because K* belongs to another configuration,
    /// contains contact stiffness, and may have factors that were turned with the bodies.
    fn correct(&self, problem: &StepProblem, dt: f64, force: &[f64], w: &mut [f64]) {
        let loads = self.sums(problem, force);
        let own = self.sums(problem, &problem.mass.times(w));
        let rates: Vec<[f64; 3]> = (0..loads.len())
            .map(|body| {
                let [mass, inertia] = self.inertia[body];
                let missing = |k: usize| dt * dt / 2.0 * loads[body][k] - own[body][k];
                match self.is_free[body] {
                    true => [missing(0) / mass, missing(1) / mass, missing(2) / inertia],
                    false => [0.0; 3],
                }
            })
            .collect();
        for (node, &body) in problem.parts.of_nodes().iter().enumerate() {
            let ([vx, vy, omega], [x, y]) = (rates[body], at(&self.arms, node));
            w[2 * node] += vx - omega * y;
            w[2 * node + 1] += vy + omega * x;
        }
    }
}

/// The components x and y of a vector at a node.
fn at(v: &[f64], node: usize) -> [f64; 2] {
    [v[2 * node], v[2 * node + 1]]
}

fn add(sum: &mut [f64; 3], term: [f64; 3]) {
    sum.iter_mut()
        .zip(term)
        .for_each(|(sum, term)| *sum += term);
}
