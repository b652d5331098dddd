//! Angles of bodies by which the factors of K* turn with them; see docs/numerics.md, Turned
//! factors.
//!
//! Ways in which supports and equations hold bodies.

use smallvec::{SmallVec, smallvec};

use super::PerBody;
use super::step_problem::StepProblem;
use crate::archive::{Archive, ArchiveError};
use crate::elements::Motion;
use crate::vectors::{cross, difference, dot};

/// Angles, in the configuration in which K* was assembled, of the bodies that are free or turn
/// about one node. Bodies held in another way have the angle 0, since their supports do not turn with them.
pub(crate) struct BodyAngles {
    /// Nodes of the bodies that turn, each with its arm r0 from the centre of mass of the body times its mass (mass
    /// length).
    arms: Vec<(usize, [f64; 2])>,
    /// Angle of every body at the assembly (rad).
    assembled: PerBody,
}

impl BodyAngles {
    /// The bodies of a step, at the angle 0.
    pub fn new(problem: &StepProblem) -> Self {
        let (x, body_of) = (&problem.coordinates, problem.parts.of_nodes());
        let mass = &problem.mass.shares;
        let centres = centres(problem, mass);
        let holds = holds(problem);
        let arm = |(node, &body): (usize, &usize)| {
            let turns = holds[body] != Hold::Held && mass[node] != 0.0;
            let r0 = difference(centres[body], x[node]);
            turns.then(|| (node, r0.map(|r| mass[node] * r)))
        };
        BodyAngles {
            arms: body_of.iter().enumerate().filter_map(arm).collect(),
            assembled: smallvec![0.0; holds.len()],
        }
    }

    /// Transfers the angles of the configuration in which K* was assembled to or from an archive.
    pub fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        archive.transfer_values(&mut self.assembled)
    }

    /// Notes that K* is assembled in the configuration of a motion.
    pub fn assemble(&mut self, problem: &StepProblem, motion: Motion) {
        self.assembled = self.angles(problem, motion);
    }

    /// Rotations of the bodies from the configuration in which K* was assembled to the configuration of a motion (rad).
    pub fn since_assembly(&self, problem: &StepProblem, motion: Motion) -> PerBody {
        let angles = self.angles(problem, motion);
        let since = angles.iter().zip(&self.assembled).map(|(a, b)| a - b);
        since.collect()
    }

    /// Mean rotation of every body in the configuration of a motion (rad); in the energy-momentum form it is evaluated
    /// in the mid configuration.
    ///
    /// The rotation is phi = atan2(sum m r0 x r, sum m r0.r), with r from any point, since sum m r0 = 0.
    fn angles(&self, problem: &StepProblem, motion: Motion) -> PerBody {
        let u = |dof: usize| match motion.start {
            Some(start) => (start[dof] + motion.end[dof]) / 2.0,
            None => motion.end[dof],
        };
        let (x, body_of) = (&problem.coordinates, problem.parts.of_nodes());
        let mut sums: SmallVec<[[f64; 2]; 8]> = smallvec![[0.0; 2]; self.assembled.len()];
        for &(node, arm) in &self.arms {
            let r = [x[node][0] + u(2 * node), x[node][1] + u(2 * node + 1)];
            let sum = &mut sums[body_of[node]];
            sum[0] += cross(arm, r);
            sum[1] += dot(arm, r);
        }
        sums.iter().map(|[sin, cos]| sin.atan2(*cos)).collect()
    }
}

/// Reference position of the centre of mass of every body; `mass` are the masses of the nodes, over
/// all dofs.
fn centres(problem: &StepProblem, mass: &[f64]) -> Vec<[f64; 2]> {
    let mut sums = vec![[0.0; 3]; problem.parts.bodies()];
    for (node, &body) in problem.parts.of_nodes().iter().enumerate() {
        let (m, [x, y]) = (mass[node], problem.coordinates[node]);
        for (sum, term) in sums[body].iter_mut().zip([m, m * x, m * y]) {
            *sum += term;
        }
    }
    let centre = |&[m, x, y]: &[f64; 3]| match m > 0.0 {
        true => [x / m, y / m],
        false => [0.0; 2],
    };
    sums.iter().map(centre).collect()
}

/// Way in which supports and equations hold a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Hold {
    /// Neither supports nor equations hold the body.
    Free,
    /// Both dofs of one node of the body are prescribed, and no other dofs.
    Pinned(usize),
    /// More dofs are prescribed, equations tie the body, or the body is a body of revolution.
    Held,
}

/// Way in which each body of a step is held; bodies of revolution can only move along their axis.
pub(crate) fn holds(problem: &StepProblem) -> Vec<Hold> {
    let (parts, unknowns) = (problem.parts, &problem.unknowns);
    if problem.model.mesh.is_axisymmetric() {
        return vec![Hold::Held; parts.bodies()];
    }
    let mut holds = vec![Hold::Free; parts.bodies()];
    let mut constrained = unknowns.constrained().iter().peekable();
    while let Some(&dof) = constrained.next() {
        let body = parts.of_nodes()[dof / 2];
        let both = dof % 2 == 0 && constrained.next_if(|next| **next == dof + 1).is_some();
        holds[body] = match holds[body] {
            Hold::Free if both => Hold::Pinned(dof / 2),
            _ => Hold::Held,
        };
    }
    for dof in problem
        .model
        .equations
        .iter()
        .flat_map(|equation| equation.dofs())
    {
        holds[parts.of_nodes()[dof / 2]] = Hold::Held;
    }
    holds
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Constraint, ConstraintGroup, Rows, testing};
    use crate::dynamics::step::{ClosedConstraints, Discretization, HeldMotions, Seen, Workspace};
    use crate::materials::Law;
    use crate::model::{Element, ElementType, Increments, Model, Step, Support, SupportMotion};
    use crate::prepare::PreparedModel;

    /// Number of nodes along a side of a block.
    const SIDE: usize = 3;
    /// Number of nodes of a block.
    const NODES: usize = SIDE * SIDE;
    const DOFS: usize = 4 * NODES;
    /// Dofs of a constraint between the two blocks.
    const CONSTRAINED: [usize; 6] = [10, 11, 2 * NODES, 2 * NODES + 1, DOFS - 2, DOFS - 1];

    /// Two blocks next to each other.
    fn blocks() -> PreparedModel {
        let mut model = Model::default();
        model.add_section(Law::elastic(100.0, 0.3), 1.0, 1.0);
        for node in 0..2 * NODES {
            let (i, j) = (node % NODES % SIDE, node % NODES / SIDE);
            let x = [i as f64 + 5.0 * (node / NODES) as f64, 0.7 * j as f64];
            model.mesh.node_labels.push(node as u64 + 1);
            model.mesh.coordinates.push(x);
            if i + 1 < SIDE && j + 1 < SIDE {
                model.mesh.elements.push(Element {
                    label: node as u64 + 1,
                    element_type: ElementType::CPE4,
                    nodes: vec![node, node + 1, node + 1 + SIDE, node + SIDE].into(),
                    section: 0,
                });
            }
        }
        PreparedModel::new(model)
    }

    fn step(supports: &[usize]) -> Step {
        let support = |&dof: &usize| Support {
            dof,
            motion: SupportMotion::Ramp { to: 0.0 },
        };
        Step {
            supports: supports.iter().map(support).collect(),
            ..Step::new(Increments::fixed(0.1, 1.0))
        }
    }

    /// Displacements of a rotation of the first block by an angle about its first node.
    fn turned(prepared: &PreparedModel, angle: f64) -> Vec<f64> {
        let (x, [sin, cos]) = (&prepared.model.mesh.coordinates, [angle.sin(), angle.cos()]);
        let turn = |[x, y]: &[f64; 2]| [(cos - 1.0) * x - sin * y, sin * x + (cos - 1.0) * y];
        let mut u: Vec<f64> = x.iter().take(NODES).flat_map(turn).collect();
        u.resize(DOFS, 0.0);
        u
    }

    /// A constraint between the two blocks with its own derivative rows.
    fn constraint() -> Constraint {
        let rows = |shift: f64| {
            let row =
                |phase: f64| [0.0, 1.0, 2.0, 3.0, 4.0, 5.0].map(|k| (phase + shift + k).sin());
            Rows::new(&row(0.1), &row(0.8))
        };
        let mut constraint = testing::made_up(&CONSTRAINED, rows(0.0));
        constraint.other_derivative_rows = Some(rows(0.3));
        constraint
    }

    /// The response to unit forces at all dofs, column by column, and the Delassus matrix of a
    /// constraint.
    fn responses(workspace: &mut Workspace) -> Vec<f64> {
        let mut all = Vec::new();
        for dof in 0..DOFS {
            let mut force = vec![0.0; DOFS];
            force[dof] = 1.0;
            let response = workspace.k().respond(&force);
            all.extend(response.expect("solved"));
        }
        let constraint = constraint();
        let lcp =
            (workspace.k()).frictional_lcp(&ConstraintGroup::All, &[&constraint], &[[0.0; 2]]);
        all.extend(lcp.expect("prepared").q.iter());
        all
    }

    /// Largest difference, relative to the largest entry, between the responses of turned factors and the responses of
    /// K* assembled in the turned configuration. The first block has turned by `angle` since the assembly, and turns by
    /// `increment` within an increment.
    fn error_of_turned_factors(supports: &[usize], angle: f64, increment: f64) -> f64 {
        let prepared = blocks();
        let discretization = Discretization::new(&prepared);
        let step = step(supports);
        let problem = StepProblem::new(&discretization, &step, [&[0.0; DOFS], &[0.0; DOFS]]);
        let ends = [0.0, increment, angle, angle + increment];
        let [u0, u1, v0, v1] = ends.map(|angle| turned(&prepared, angle));
        let motion = |start, end| Motion {
            start: Some(start),
            ..Motion::at(end, &[])
        };
        let (before, after) = (motion(&u0[..], &u1[..]), motion(&v0[..], &v1[..]));
        let (mut kept, mut fresh) = (
            Workspace::new(&problem, Seen::new(problem.parts)),
            Workspace::new(&problem, Seen::new(problem.parts)),
        );
        let contact = ClosedConstraints {
            acting: vec![],
            at: problem.configurations(&u0, &u1),
            pairs_stiffen: false,
            followers: &[],
            out_of_balance: &[],
            held: &HeldMotions::default(),
        };
        let first = kept.factorize(&problem, 0.1, before, &contact);
        let second = fresh.factorize(&problem, 0.1, after, &contact);
        first.and(second).expect("positive definite");
        kept.turn(&problem, after);
        let [kept, fresh] = [&mut kept, &mut fresh].map(|w| responses(w));
        let size = fresh.iter().fold(0.0_f64, |most, w| most.max(w.abs()));
        let differences = kept.iter().zip(&fresh).map(|(a, b)| (a - b).abs());
        differences.fold(0.0, f64::max) / size
    }

    #[test]
    fn turned_factors_are_those_of_the_turned_bodies() {
        for pin in [&[][..], &[0, 1]] {
            for (angle, increment) in [(0.7, 0.0), (2.9, 0.0), (-1.3, 0.2)] {
                let error = error_of_turned_factors(pin, angle, increment);
                assert!(error < 1e-12, "{pin:?} {angle}: {error:e}");
            }
        }
    }

    #[test]
    fn bodies_that_are_held_do_not_turn() {
        for supports in [&[0][..], &[0, 1, 2], &[0, 3]] {
            let error = error_of_turned_factors(supports, 0.7, 0.0);
            assert!(error > 1e-3, "{supports:?}: {error:e}");
        }
    }

    #[test]
    fn the_angle_of_a_body_is_that_by_which_it_has_turned() {
        let prepared = blocks();
        let discretization = Discretization::new(&prepared);
        let step = step(&[]);
        let problem = StepProblem::new(&discretization, &step, [&[0.0; DOFS], &[0.0; DOFS]]);
        let angles = BodyAngles::new(&problem);
        for angle in [0.0, 1e-9, -0.4, 3.0] {
            let u = turned(&prepared, angle);
            let [first, second] = angles.angles(&problem, Motion::at(&u, &[]))[..] else {
                panic!("two bodies");
            };
            assert!((first - angle).abs() < 1e-14, "{first} {angle}");
            assert!(second.abs() < 1e-15, "{second}");
        }
    }
}
