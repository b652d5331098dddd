//! Materials: strain energy, second Piola-Kirchhoff stress and tangent at one integration point, as
//! functions of the Green-Lagrange strain and of internal variables.
//! See docs/theory/materials.md.
//!
//! A deformation gradient F enters only through E = (F^T F - I)/2, so every material is objective; elements check that
//! det F > 0. A material point has the components 11, 22, 33 and 12 of a [`Symmetric`] tensor: 33 is across the plane,
//! or around the axis of a body of revolution. Laws are written once, for any [`Number`]: the number of one element, or
//! the numbers of several elements at a time. A [`Law`] has the constants of the deck; a [`PlaneLaw`] is the same law
//! in the plane of the elements.

mod constitutive_law;
mod expansion;
mod hencky;
mod hyperelastic;
mod invariants;
mod law;
mod law_card;
mod neo_hooke;
pub mod number;
mod ogden;
mod plane;
mod plane_stress;
mod plastic;
mod polynomial;
mod saint_venant_kirchhoff;
mod spectrum;
mod strains;
pub mod symmetric;
mod viscosity;
mod yield_curve;
#[cfg(any(test, feature = "testing"))]
pub mod yielding;

pub use constitutive_law::{
    AnyLaw, BentTangent, Elastic, Flow, Metal, MetalLaw, OneByOne, StressAtPoints,
};
pub use expansion::{Expanded, Expansion};
pub use hencky::Hencky;
pub use hyperelastic::Hyperelastic;
pub use invariants::{InvariantEnergy, VolumeEnergy};
pub use law::{Committed, Constants, Law, LawInLanes, PlaneLaw};
pub use law_card::LawCard;
pub use neo_hooke::NeoHooke;
pub use number::{Lanes, Number};
pub use ogden::Ogden;
pub use plane::{Plane, SmallStrainModuli};
pub use plane_stress::PlaneStress;
pub use plastic::{PlanePlastic, Plastic};
pub use polynomial::Polynomial;
pub use saint_venant_kirchhoff::{PlaneSaintVenantKirchhoff, SaintVenantKirchhoff};
pub use strains::{Across, StrainChange, StrainMeasure, Strains};
pub use symmetric::{Symmetric, Tangent, contract};
pub use viscosity::Viscosity;
