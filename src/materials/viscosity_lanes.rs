//! The stress of the viscosity of a material and its tangent, for several elements side by side. Section 4 of
//! docs/theory.md, Damping; docs/numerics.md, Sweeps over elements.

use std::array::from_fn;

use super::Viscosity;
use super::lanes::{Lanes, LawInLanes, StrainChange, SymmetricLanes, TangentLanes};

/// The formulas of [`super::StressAtPoints`]. Nothing is stored, and there is no stress across the thickness.
impl LawInLanes for Viscosity {
    fn stress(&self, _e: &SymmetricLanes) -> SymmetricLanes {
        [Lanes::ZERO; 3]
    }

    #[inline(always)]
    fn mean_stress(&self, change: &StrainChange) -> SymmetricLanes {
        let ([gxx, gyy, gxy], inverse) = halfway_in_lanes(change);
        let [xx, yy, xy] = change.half.map(|half| half * 2.0);
        let dj = (gxx * xx + gyy * yy + gxy * xy * 2.0) * self.volume;
        let (x, y) = (
            [gxx * xx + gxy * xy, gxx * xy + gxy * yy],
            gxy * xy + gyy * yy,
        );
        let s = |gdeg: Lanes, g: Lanes| (gdeg * self.shape + dj * g) * inverse;
        [
            s(x[0] * gxx + x[1] * gxy, gxx),
            s((gxy * xx + gyy * xy) * gxy + y * gyy, gyy),
            s(x[0] * gxy + x[1] * gyy, gxy),
        ]
    }

    fn tangent(&self, _e: &SymmetricLanes) -> TangentLanes {
        [[Lanes::ZERO; 3]; 3]
    }

    #[inline(always)]
    fn mean_tangent(&self, change: &StrainChange) -> TangentLanes {
        let (g, inverse) = halfway_in_lanes(change);
        let [xx, yy, xy] = g;
        let product = [
            [xx * xx, xy * xy, xx * xy],
            [xy * xy, yy * yy, yy * xy],
            [xx * xy, yy * xy, (xx * yy + xy * xy) * 0.5],
        ];
        let (shape, volume) = (inverse * (2.0 * self.shape), inverse * (2.0 * self.volume));
        from_fn(|i| from_fn(|j| product[i][j] * shape + g[i] * g[j] * volume))
    }

    fn stored_energy(&self, _e: &SymmetricLanes) -> Lanes {
        Lanes::ZERO
    }

    fn across(&self, _e: &SymmetricLanes) -> [Lanes; 2] {
        [Lanes::all(1.0), Lanes::ZERO]
    }
}

/// G and 1/J_m of eq. (4.17) for several elements.
#[inline(always)]
fn halfway_in_lanes(change: &StrainChange) -> (SymmetricLanes, Lanes) {
    let [j0, j1] = change
        .ends()
        .map(|[xx, yy, xy]| ((xx + yy) * 2.0 + (xx * yy - xy * xy) * 4.0 + 1.0).sqrt());
    let inverse = Lanes::all(2.0) / (j0 + j1);
    let [xx, yy, xy] = change.mean.map(|mean| mean * 2.0);
    let g = [yy + 1.0, xx + 1.0, xy * -1.0];
    (g.map(|g| g * inverse), inverse)
}
