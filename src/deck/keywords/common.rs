//! Parameters and sentences that rows of several families share.

use super::types::Parameter as P;

pub(super) const INPUT: P = P::value("INPUT", "file that holds the data lines");
pub(super) const NAME: P = P::value("NAME", "name");
pub(super) const CAE: &str = "written by Abaqus/CAE for its own use";
pub(super) const OTHER_SOLVER: &str = "a number for another solver";
pub(super) const OTHER_NUMBERS: &str = "Its numbers belong to another solver.";
pub(super) const HARMLESS: &str = "It does not touch the answer.";
