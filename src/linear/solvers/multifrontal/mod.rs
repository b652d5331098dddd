//! Multifrontal LDL^T factorisation (Duff & Reid 1983), substitutions and parts of the inverse, branch by branch of the
//! elimination forest. Section 5 of docs/theory.md, One solve and Branches.

mod assembly;
mod elimination;
mod entries;
mod factor;
mod front;
mod limbs;
mod partial_inverse;
mod substitution;
mod supernode;
mod supernodes;

pub use elimination::Elimination;
pub use factor::Factor;
pub use partial_inverse::{InverseSpace, inverse_at};
pub use substitution::Substitution;
pub use supernodes::Supernodes;
