//! A law at one integration point of several elements at once: what the sweeps over blocks of
//! elements ask of a material without internal variables. Section 2 of docs/theory.md.

use std::array::from_fn;

use nalgebra::{Matrix2, Matrix3};

use super::lanes::{LANES, Lanes, SymmetricLanes, tensor_of, tensors};
use super::{Across, ConstitutiveLaw, PlaneSaintVenantKirchhoff};

/// Tangent in Voigt order.
pub type TangentLanes = [[Lanes; 3]; 3];

/// Strains between which a stress is taken: (E0 + E1)/2 and (E1 - E0)/2.
#[derive(Clone, Copy)]
pub struct StrainChange {
    /// Mean strain.
    pub mean: SymmetricLanes,
    /// Half the change of the strain.
    pub half: SymmetricLanes,
}

impl StrainChange {
    /// Strains of start and end of one element.
    fn of(&self, lane: usize) -> [Matrix2<f64>; 2] {
        let [mean, half] = [&self.mean, &self.half].map(|strain| tensor_of(lane, strain));
        [mean - half, mean + half]
    }
}

/// Stress and tangent of [`ConstitutiveLaw`] for several elements.
pub trait LawInLanes {
    /// Second Piola-Kirchhoff stress, eq. (2.3) (force/length^2).
    fn stress(&self, e: &SymmetricLanes) -> SymmetricLanes;

    /// Energy-momentum stress, eq. (4.8) (force/length^2).
    fn mean_stress(&self, change: &StrainChange) -> SymmetricLanes;

    /// Tangent of [`Self::stress`] (force/length^2).
    fn tangent(&self, e: &SymmetricLanes) -> TangentLanes;

    /// Symmetric part of 2 dS/dE1 of [`Self::mean_stress`] (force/length^2).
    fn mean_tangent(&self, change: &StrainChange) -> TangentLanes;

    /// Stored energy W, eq. (2.4) (force/length^2).
    fn stored_energy(&self, e: &SymmetricLanes) -> Lanes;

    /// Stretch F_zz and stress S_zz (force/length^2) across the thickness.
    fn across(&self, e: &SymmetricLanes) -> [Lanes; 2];
}

impl LawInLanes for PlaneSaintVenantKirchhoff {
    /// S = C:E, eq. (2.13)
    #[inline(always)]
    fn stress(&self, &[xx, yy, xy]: &SymmetricLanes) -> SymmetricLanes {
        let c = self.elasticity();
        [
            xx * c.m11 + yy * c.m12,
            xx * c.m21 + yy * c.m22,
            xy * (2.0 * c.m33),
        ]
    }

    #[inline(always)]
    fn mean_stress(&self, change: &StrainChange) -> SymmetricLanes {
        LawInLanes::stress(self, &change.mean)
    }

    #[inline(always)]
    fn tangent(&self, _e: &SymmetricLanes) -> TangentLanes {
        from_fn(|i| from_fn(|j| Lanes::all(self.elasticity()[(i, j)])))
    }

    #[inline(always)]
    fn mean_tangent(&self, change: &StrainChange) -> TangentLanes {
        LawInLanes::tangent(self, &change.mean)
    }

    /// W = S:E/2, eq. (2.13)
    #[inline(always)]
    fn stored_energy(&self, e: &SymmetricLanes) -> Lanes {
        let [xx, yy, xy] = LawInLanes::stress(self, e);
        (xx * e[0] + yy * e[1]) * 0.5 + xy * e[2]
    }

    /// F_zz² = 1 + 2 E_zz
    #[inline(always)]
    fn across(&self, e: &SymmetricLanes) -> [Lanes; 2] {
        let ([xx, yy, _], ratios) = (LawInLanes::stress(self, e), self.across_ratios());
        let [contraction, across] = ratios;
        let stretch = (e[0] + e[1]) * (-2.0 * contraction) + 1.0;
        [stretch.sqrt(), (xx + yy) * across]
    }
}

/// A law without internal variables that is evaluated for one element after the other.
pub struct OneByOne<'a, L>(pub &'a L);

impl<L: ConstitutiveLaw> LawInLanes for OneByOne<'_, L> {
    fn stress(&self, e: &SymmetricLanes) -> SymmetricLanes {
        tensors(|lane| self.0.stress(&tensor_of(lane, e), &[]))
    }

    fn mean_stress(&self, change: &StrainChange) -> SymmetricLanes {
        tensors(|lane| {
            let [e0, e1] = change.of(lane);
            self.0.mean_stress(&e0, &e1, &[])
        })
    }

    fn tangent(&self, e: &SymmetricLanes) -> TangentLanes {
        tangents(|lane| self.0.tangent(&tensor_of(lane, e), &[]))
    }

    fn mean_tangent(&self, change: &StrainChange) -> TangentLanes {
        tangents(|lane| {
            let [e0, e1] = change.of(lane);
            self.0.mean_tangent(&e0, &e1, &[])
        })
    }

    fn stored_energy(&self, e: &SymmetricLanes) -> Lanes {
        Lanes(from_fn(|lane| {
            self.0.stored_energy(&tensor_of(lane, e), &[])
        }))
    }

    fn across(&self, e: &SymmetricLanes) -> [Lanes; 2] {
        let all: [Across; LANES] = from_fn(|lane| self.0.across(&tensor_of(lane, e), &[]));
        [Lanes(all.map(|a| a.stretch)), Lanes(all.map(|a| a.stress))]
    }
}

/// The tangents of all elements, given that of each.
fn tangents(of_lane: impl Fn(usize) -> Matrix3<f64>) -> TangentLanes {
    let all: [Matrix3<f64>; LANES] = from_fn(of_lane);
    from_fn(|i| from_fn(|j| Lanes(all.map(|tangent| tangent[(i, j)]))))
}

/// Evaluates an expression for a plane law without internal variables as a [`LawInLanes`].
macro_rules! in_lanes {
    ($law:expr, $in_lanes:ident => $value:expr) => {
        match $law {
            $crate::materials::PlaneLaw::SaintVenantKirchhoff($in_lanes) => $value,
            law => {
                let $in_lanes = &$crate::materials::OneByOne(law);
                $value
            }
        }
    };
}
pub(crate) use in_lanes;
