//! System matrices of a step: the effective stiffness K* and the mass M, their factors and what is
//! solved with them.

mod effective_stiffness;
mod system;

pub(crate) use effective_stiffness::{
    ClosedConstraints, EffectiveStiffness, FactoredMatrix, ResponseVectors, StiffnessForm,
};
pub(crate) use system::System;
