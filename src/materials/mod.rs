//! Materials: strain energy, second Piola-Kirchhoff stress and tangent at one integration point, as
//! functions of the Green-Lagrange strain and of internal variables. Section 2 of
//! docs/theory.md.
//!
//! A deformation gradient F enters through E = (F^T F - I)/2 alone, so that every material is
//! objective; det F > 0 is checked by the elements. Symmetric tensors of the plane are 2 x 2
//! matrices; tangents act on strains in Voigt order (E_xx, E_yy, 2 E_xy). A [`Law`] has the constants
//! of the deck, a [`PlaneLaw`] is the same reduced to the plane of the elements; in bodies of revolution it has the
//! components of a [`Symmetric`] tensor.

mod constitutive_law;
mod hyperelastic;
pub mod lanes;
mod law;
mod law_card;
mod neo_hooke;
mod neo_hooke_lanes;
mod plane;
mod plastic;
mod polynomial;
mod saint_venant_kirchhoff;
mod solid;
mod solid_laws;
pub mod symmetric;
mod viscosity;
mod viscosity_lanes;
mod yield_curve;
#[cfg(test)]
pub(crate) mod yielding;

pub use constitutive_law::{
    Across, BentLaw, BentTangent, ConstitutiveLaw, Metal, MetalLaw, StrainMeasure, Strains,
    StressAtPoints,
};
pub use hyperelastic::Hyperelastic;
pub use lanes::{LawInLanes, OneByOne, StrainChange, TangentLanes};
pub(crate) use law::in_lanes;
pub use law::{Committed, Law, PlaneLaw};
pub use law_card::LawCard;
pub use neo_hooke::NeoHooke;
pub use plane::{Plane, SmallStrainModuli};
pub use plastic::{PlanePlastic, Plastic};
pub use polynomial::{PlanePolynomial, Polynomial};
pub use saint_venant_kirchhoff::{PlaneSaintVenantKirchhoff, SaintVenantKirchhoff};
pub use solid::{RingLaw, RingStressAtPoints, SolidHyperelastic};
pub use symmetric::{Symmetric, contract};
pub use viscosity::Viscosity;
