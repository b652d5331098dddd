//! Failed increments: cause, worst node and data of the attempt, for the report of a cutback or a
//! stop.

use std::fmt;

use super::course::Course;
use super::pass_report::PassReport;
use crate::contact::Constraint;
use crate::elements::Inverted;
use crate::lcp::{FrictionalLcp, LcpError};
use crate::linear::LinearError;

/// Cause of a failed increment.
#[derive(Debug, Clone, PartialEq)]
pub enum Cause {
    /// The passes did not converge.
    NotConverged,
    /// The determinant of an element's deformation gradient is not positive.
    Inverted {
        /// Element (index).
        element: usize,
        /// Determinant.
        determinant: f64,
    },
    /// A segment has shrunk to almost no length.
    Collapsed {
        /// Ends of the segment (indices).
        segment: [usize; 2],
    },
    /// A body that only contact holds cannot be in balance with any contact forces.
    Unbalanceable(Box<Unbalanced>),
    /// The equilibrium is not stable.
    Unstable {
        /// Node (index) whose pivot is not positive.
        node: usize,
    },
    /// A static increment leads much farther than the last increment, and so to another equilibrium.
    Jump {
        /// Node (index) that moves most.
        node: usize,
    },
    /// The effective matrix is not positive definite.
    Indefinite {
        /// Node (index) whose pivot is not positive.
        node: usize,
    },
    /// The truncation error of a converged increment is too large.
    Inaccurate {
        /// The truncation error, relative to the displacements.
        error: f64,
        /// Largest truncation error that is accepted.
        tolerance: f64,
    },
    /// The factorisation, or a solve with the factors, failed.
    LinearSolver(LinearError),
    /// The passes diverged until numbers were not finite.
    Diverged,
    /// A node has entered a body through a segment.
    Crossed {
        /// Slave node (index).
        slave: usize,
        /// Ends (indices) of the segment.
        segment: [usize; 2],
        /// Whether supports prescribe the motion of the slave node and of both ends of the segment.
        prescribed: bool,
    },
    /// A contact is added while a slave node is inside the master body.
    Overlaps {
        /// Slave node (index).
        slave: usize,
        /// Ends (indices) of the segment.
        segment: [usize; 2],
        /// Depth of the node inside the body (length).
        depth: f64,
    },
    /// The normal contact forces do positive work, so contact would add energy.
    GainedEnergy {
        /// The added energy, relative to the largest energy.
        part: f64,
        /// Slave node and ends of the segment (indices) of the pair whose force adds the most
        /// energy.
        pair: Option<[usize; 3]>,
    },
    /// The energy balance is off: the residual that the passes have left does significant work.
    Unbalanced {
        /// The balance relative to the largest energy.
        part: f64,
        /// Whether the round-off of positions causes forces whose work in an increment is significant by itself;
        /// halving the increment does not reduce this work.
        is_round_off: bool,
    },
    /// A complementarity problem was not solved.
    Lcp(Box<FailedLcp>),
    /// A quantity is not finite.
    NotFinite {
        /// Which.
        what: &'static str,
        /// Index of the node with the value, or of the node that moves most.
        node: usize,
    },
}

/// A body that is not in balance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unbalanced {
    /// A node (index) of the body that is not in balance.
    pub node: usize,
    /// Resultant force on the body that nothing balances.
    pub force: [f64; 2],
    /// Moment on the body that nothing balances, about the mean of its nodes (force length).
    pub moment: f64,
    /// Rigid motion that the body is about to make: displacement of the mean of the nodes, and angle (length; rad).
    pub motion: [f64; 3],
    /// Distance of the farthest node of the body from the mean of the nodes (length).
    pub size: f64,
}

/// A complementarity problem without solution, of a pass or of the impulses.
#[derive(Debug, Clone, PartialEq)]
pub struct FailedLcp {
    /// Reason why the complementarity problem was not solved.
    pub error: LcpError,
    /// The problem.
    pub problem: FrictionalLcp,
    /// Nodes (indices) of the pairs of the problem: slave, segment ends a and b.
    pub pairs: Vec<[usize; 3]>,
}

impl FailedLcp {
    /// Whether the pairs of the problem contradict each other.
    pub fn is_contradiction(&self) -> bool {
        matches!(self.error, LcpError::Ray { .. })
    }

    /// The failure of the complementarity problem of some constraints.
    pub(crate) fn new(
        error: LcpError,
        problem: FrictionalLcp,
        constraints: &[&Constraint],
    ) -> Self {
        FailedLcp {
            error,
            problem,
            pairs: constraints.iter().map(|c| c.pair().nodes).collect(),
        }
    }
}

/// The node with the largest residual or correction of a failed increment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Worst {
    /// Node (index).
    pub node: usize,
    /// Current position of the node (length).
    pub position: [f64; 2],
    /// Name of the quantity that is worst at the node.
    pub quantity: &'static str,
    /// Value of the quantity relative to the scale to which the tolerance refers.
    pub value: f64,
}

/// A failed attempt at an increment.
#[derive(Debug, Clone, PartialEq)]
pub struct Failure {
    /// Number of the increment, counted over all steps.
    pub increment: usize,
    /// Number of the step, from 1.
    pub step: usize,
    /// Time at the start of the increment.
    pub time: f64,
    /// Length of the attempted increment.
    pub dt: f64,
    /// Why.
    pub cause: Cause,
    /// Course of the passes, if they did not converge.
    pub course: Option<Box<Course>>,
    /// The node with the largest error, if the passes have one.
    pub worst: Option<Worst>,
    /// Passes of the attempt.
    pub passes: Vec<PassReport>,
    /// Number of times that the increment had been halved.
    pub halvings: u32,
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Cause::NotConverged => write!(f, "the passes did not converge"),
            Cause::Inverted { determinant, .. } => {
                write!(
                    f,
                    "an element turned inside out (det F = {determinant:.3e})"
                )
            }
            Cause::Collapsed { .. } => write!(f, "a segment shrank to a point"),
            Cause::Unbalanceable(_) => write!(f, "a body is not in equilibrium"),
            Cause::Unstable { .. } => write!(f, "the equilibrium is not stable"),
            Cause::Jump { .. } => {
                write!(
                    f,
                    "a body jumps to another equilibrium: its load has reached a limit"
                )
            }
            Cause::Indefinite { .. } => write!(f, "the effective matrix is not positive definite"),
            Cause::Crossed { .. } => write!(f, "a node went through a segment"),
            Cause::Overlaps { depth, .. } => write!(
                f,
                "a contact is added while its bodies overlap by {depth:.3e}"
            ),
            Cause::GainedEnergy { part, .. } => {
                write!(f, "contact would put energy in ({part:.1e} of the largest)")
            }
            Cause::Unbalanced { part, .. } => {
                write!(
                    f,
                    "the energy balance would be off by {part:.1e} of the largest energy"
                )
            }
            Cause::Inaccurate { error, tolerance } => {
                write!(
                    f,
                    "its truncation error of {error:.1e} is above {tolerance:.1e} of the displacements"
                )
            }
            Cause::LinearSolver(error) => write!(f, "the linear solver failed: {error}"),
            Cause::Diverged => write!(f, "the passes diverged"),
            Cause::Lcp(failed) => match &failed.error {
                LcpError::Ray { .. } => {
                    write!(
                        f,
                        "no contact forces hold the bodies (an LCP ended on a ray)"
                    )
                }
                error => write!(f, "a complementarity problem was not solved: {error}"),
            },
            Cause::NotFinite { what, .. } => write!(f, "{what} is not finite"),
        }
    }
}

impl From<LinearError> for Cause {
    fn from(error: LinearError) -> Self {
        Cause::LinearSolver(error)
    }
}

impl Cause {
    /// Whether the increment would also fail if it were halved.
    pub fn stays(&self) -> bool {
        matches!(
            self,
            Cause::Unbalanced {
                is_round_off: true,
                ..
            }
        )
    }

    /// Whether the failure says no more than that a number has grown too large.
    pub(crate) fn is_overflow(&self) -> bool {
        match self {
            Cause::LinearSolver(LinearError::NotFinite(_)) | Cause::NotFinite { .. } => true,
            Cause::Inverted { determinant, .. } => !determinant.is_finite(),
            Cause::Lcp(failed) => failed.error == LcpError::NotFinite,
            _ => false,
        }
    }
}

impl From<Inverted> for Cause {
    fn from(
        Inverted {
            element,
            determinant,
        }: Inverted,
    ) -> Self {
        Cause::Inverted {
            element,
            determinant,
        }
    }
}
