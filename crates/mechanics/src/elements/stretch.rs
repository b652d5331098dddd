//! Strains that differ from the mean of an element, in the strain measure in which the energy of its material is
//! convex. See docs/theory/elements.md, Enhanced strains.
//!
//! # Derivation
//!
//! With the mean Ebar of the displacement strains and Cbar = I + 2 Ebar, the strain beyond the mean is A = E + M
//! alpha - Ebar. In the Green-Lagrange measure the strain of the element is Ebar + A. In the logarithmic measure the
//! strain of the element belongs to the right Cauchy-Green tensor Cbar exp(2 Cbar^-1 A), so logarithmic strains are
//! added. Cayley's approximation agrees with the exponential up to the second order:
//!
//! ```text
//! I + 2 E_g = Cbar (1 - Q)^-1 (1 + Q),   Q = Cbar^-1 A
//! E_g = Ebar + A + A H A,   H = (Cbar - A)^-1, or 0 in the measure of Green and Lagrange
//! ```
//!
//! The approximation of the exponential is singular where Cbar + A is singular. Where Cbar + A is singular, the
//! displacements, whose strain is linear in q (eq. 2.27), turn a point of a parallelogram inside out, so the energy of
//! the material grows before such a state is reached. With N = H A, W = 1 + N and dH = -H (2 dEbar - dA) H, the
//! derivatives are
//!
//! ```text
//! dE_g  = dEbar + W^T dA W - 2 N^T dEbar N = dEbar + dA + dA N + N^T B,   B = dA W - 2 dEbar N
//! d²E_g = B_1^T H B_2 + its transpose
//! ```

use std::array::from_fn;

use super::block::{SymmetricLanes, TensorLanes};
use crate::materials::number::Positive;
use crate::materials::{Lanes, Number, StrainMeasure};

/// A tensor whose components 13, 23, 31 and 32 are zero.
#[derive(Clone, Copy, Default)]
pub struct Tensor {
    /// Components of the section, row by row.
    section: TensorLanes,
    /// Component 33, which is not read without `HOOP`.
    z: Lanes,
}

impl Tensor {
    #[inline(always)]
    fn of(s: &SymmetricLanes) -> Self {
        Tensor {
            section: [[s.x, s.w], [s.w, s.y]],
            z: s.z,
        }
    }

    /// A B
    #[inline(always)]
    fn times<const HOOP: bool>(&self, b: &Tensor) -> Tensor {
        let (a, b, z) = (&self.section, &b.section, b.z);
        Tensor {
            section: from_fn(|i| from_fn(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j])),
            z: match HOOP {
                true => self.z * z,
                false => Lanes::ZERO,
            },
        }
    }

    #[inline(always)]
    fn transposed(&self) -> Tensor {
        let [[xx, xy], [yx, yy]] = self.section;
        Tensor {
            section: [[xx, yx], [xy, yy]],
            z: self.z,
        }
    }

    #[inline(always)]
    fn plus(&self, b: &Tensor) -> Tensor {
        Tensor {
            section: from_fn(|i| from_fn(|j| self.section[i][j] + b.section[i][j])),
            z: self.z + b.z,
        }
    }

    /// Symmetric part (A + A^T)/2. The formula avoids the difference between two symmetric tensors, which would have
    /// the round-off of their product.
    #[inline(always)]
    fn symmetric(&self) -> SymmetricLanes {
        let [[xx, xy], [yx, yy]] = self.section;
        SymmetricLanes::new(xx, yy, self.z, (xy + yx) * 0.5)
    }

    /// A:B
    #[inline(always)]
    pub fn contract<const HOOP: bool>(&self, b: &Tensor) -> Lanes {
        let (a, b, z) = (&self.section, &b.section, b.z);
        let row = |i: usize| a[i][0] * b[i][0] + a[i][1] * b[i][1];
        match HOOP {
            true => row(0) + row(1) + self.z * z,
            false => row(0) + row(1),
        }
    }
}

/// Mean strain of an element, and the strain measure in which other strains are added to the mean.
#[derive(Clone, Copy)]
pub struct MeanStrain {
    /// Ebar
    pub strain: SymmetricLanes,
    /// Strain measure of the law.
    pub measure: StrainMeasure,
}

/// The first variation of a strain of the displacements or of the element: at a point, and of the mean over the
/// element.
#[derive(Clone, Copy)]
pub struct Variation {
    /// Variation dE + M dalpha of the strain at the point.
    pub at_point: SymmetricLanes,
    /// dEbar
    pub of_mean: SymmetricLanes,
}

/// Strain of an element at a point, in terms of the mean strain and the strain beyond the mean.
#[derive(Clone, Copy, Default)]
pub struct AddedStrain {
    /// The linear part E + M alpha of the strain.
    linear: SymmetricLanes,
    /// Further tensors of the logarithmic measure; `None` in the Green-Lagrange measure.
    stretched: Option<Stretched>,
}

#[derive(Clone, Copy)]
struct Stretched {
    /// A
    beside: Tensor,
    /// The tensor H; NaN if the point or the mean has turned inside out.
    h: Tensor,
    /// N
    n: Tensor,
}

impl MeanStrain {
    /// Strain of the element: the part of E + M alpha beyond the mean, added to the mean in the strain measure.
    #[inline(always)]
    pub fn add<const HOOP: bool>(&self, linear: &SymmetricLanes) -> AddedStrain {
        let stretched = match self.measure {
            StrainMeasure::Green => None,
            StrainMeasure::Logarithmic => {
                let beside = *linear - self.strain;
                let mean = self.strain.map(|e| e * 2.0).plus_isotropic(Lanes::all(1.0));
                let all = [mean + beside, mean - beside];
                let positive = all.iter().fold(Positive::default(), |positive, c| {
                    let of_section = positive.and(c.x).and(c.x * c.y - c.w * c.w);
                    match HOOP {
                        true => of_section.and(c.z),
                        false => of_section,
                    }
                });
                let c = all[1];
                let over = Lanes::all(1.0) / (c.x * c.y - c.w * c.w);
                let over = positive.or_nan(over);
                let h = Tensor::of(&SymmetricLanes::new(
                    c.y * over,
                    c.x * over,
                    match HOOP {
                        true => positive.or_nan(Lanes::all(1.0) / c.z),
                        false => Lanes::ZERO,
                    },
                    c.w * over * -1.0,
                ));
                let beside = Tensor::of(&beside);
                let n = h.times::<HOOP>(&beside);
                Some(Stretched { beside, h, n })
            }
        };
        AddedStrain {
            linear: *linear,
            stretched,
        }
    }
}

impl AddedStrain {
    /// E_g
    #[inline(always)]
    pub fn strain<const HOOP: bool>(&self) -> SymmetricLanes {
        match &self.stretched {
            None => self.linear,
            Some(Stretched { beside, n, .. }) => self.linear + beside.times::<HOOP>(n).symmetric(),
        }
    }

    /// Difference between the strain E_g and its value at the start of a variation, with a round-off that is relative
    /// to the variation:
    ///
    /// ```text
    /// A1 H1 A1 - A0 H0 A0 = dA H1 A1 + A0 dH A1 + A0 H0 dA,   dH = -H1 (2 dEbar - dA) H0
    /// ```
    #[inline(always)]
    pub fn change<const HOOP: bool>(
        &self,
        start: &Self,
        Variation { at_point, of_mean }: &Variation,
    ) -> SymmetricLanes {
        let (Some(end), Some(start)) = (&self.stretched, &start.stretched) else {
            return *at_point;
        };
        let da = *at_point - *of_mean;
        let less = Tensor::of(&(da - of_mean.map(|e| e * 2.0)));
        let da = Tensor::of(&da);
        let dh = end.h.times::<HOOP>(&less).times::<HOOP>(&start.h);
        let middle = start.beside.times::<HOOP>(&dh).times::<HOOP>(&end.beside);
        let last = start.n.transposed().times::<HOOP>(&da);
        *at_point
            + da.times::<HOOP>(&end.n)
                .plus(&middle)
                .plus(&last)
                .symmetric()
    }

    /// Stresses T and R by which a stress S on E_g does work:
    ///
    /// ```text
    /// S:dE_g = T:(dE + M dalpha) - R:dEbar,   T = W S W^T,   R = T - S + 2 N S N^T
    /// ```
    #[inline(always)]
    pub fn conjugate<const HOOP: bool>(&self, s: &SymmetricLanes) -> [SymmetricLanes; 2] {
        let Some(Stretched { n, .. }) = &self.stretched else {
            return [*s, SymmetricLanes::zeros()];
        };
        let half = n.times::<HOOP>(&Tensor::of(s));
        let square = half.times::<HOOP>(&n.transposed()).symmetric();
        let more = half.symmetric().map(|s| s * 2.0) + square;
        [*s + more, more + square.map(|s| s * 2.0)]
    }

    /// Change dE_g of the strain in a variation, and the tensor B of the variation.
    #[inline(always)]
    pub fn variation<const HOOP: bool>(
        &self,
        Variation { at_point, of_mean }: &Variation,
    ) -> (SymmetricLanes, Tensor) {
        let Some(Stretched { n, .. }) = &self.stretched else {
            return (*at_point, Tensor::default());
        };
        let da = *at_point - *of_mean;
        let less = Tensor::of(&(da - of_mean.map(|e| e * 2.0)));
        let da = Tensor::of(&da);
        let b = da.plus(&less.times::<HOOP>(n));
        let more = da.times::<HOOP>(n).plus(&n.transposed().times::<HOOP>(&b));
        (*at_point + more.symmetric(), b)
    }

    /// The tensor 2 H B S, whose product with another B is S : d²E_g; `None` in the Green-Lagrange measure.
    #[inline(always)]
    pub fn second_stress<const HOOP: bool>(
        &self,
        b: &Tensor,
        s: &SymmetricLanes,
    ) -> Option<Tensor> {
        let Stretched { h, .. } = self.stretched.as_ref()?;
        let twice = Tensor::of(&s.map(|s| s * 2.0));
        Some(h.times::<HOOP>(b).times::<HOOP>(&twice))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::Symmetric;

    /// The components 11, 22, 33, 12 of a tensor.
    type Components = [f64; 4];
    const MEAN: Components = [0.3, -0.1, 0.05, 0.1];
    const LINEAR: Components = [0.35, -0.2, 0.1, 0.14];
    const DIRECTION: Components = [0.3, 0.1, -0.4, -0.2];
    const OF_MEAN: Components = [0.1, -0.2, 0.2, 0.3];
    const STRESS: Components = [2.0, -1.0, 1.3, 0.7];

    fn lanes(of: Components) -> SymmetricLanes {
        let [x, y, z, w] = of.map(Lanes::all);
        SymmetricLanes::new(x, y, z, w)
    }

    fn mean(strain: SymmetricLanes) -> MeanStrain {
        let measure = StrainMeasure::Logarithmic;
        MeanStrain { strain, measure }
    }

    /// The tensor A + t B.
    fn moved(a: Components, t: f64, b: Components) -> SymmetricLanes {
        lanes(a) + lanes(b.map(|b| t * b))
    }

    fn size(e: &SymmetricLanes) -> f64 {
        e.lane(1).norm()
    }

    #[test]
    fn derivatives_are_those_of_the_strain() {
        let added =
            |t: f64| mean(moved(MEAN, t, OF_MEAN)).add::<true>(&moved(LINEAR, t, DIRECTION));
        let at = |t: f64| added(t).strain::<true>();
        let start = added(0.0);
        let by = |size: f64| Variation {
            at_point: lanes(DIRECTION.map(|e| e * size)),
            of_mean: lanes(OF_MEAN.map(|e| e * size)),
        };
        let ((first, b), h) = (start.variation::<true>(&by(1.0)), 1e-4);
        let quotient = (at(h) - at(-h)).map(|e| e * (0.5 / h));
        assert!(size(&(first - quotient)) < 1e-7);
        let stress = lanes(STRESS);
        let [on_all, on_mean] = start.conjugate::<true>(&stress);
        let work =
            on_all.contract::<true>(&lanes(DIRECTION)) - on_mean.contract::<true>(&lanes(OF_MEAN));
        let exact = stress.contract::<true>(&first);
        assert!((work - exact).0[0].abs() < 1e-14);
        let second = (at(h) - at(0.0).map(|e| e * 2.0) + at(-h)).map(|e| e / (Lanes::all(h * h)));
        let found = start
            .second_stress::<true>(&b, &stress)
            .expect("logarithms");
        let found = found.contract::<true>(&b);
        assert!((found - stress.contract::<true>(&second)).0[0].abs() < 1e-6);
        for step in [0.3, 1e-4] {
            let found = added(step).change::<true>(&start, &by(step));
            assert!(size(&(found - (at(step) - at(0.0)))) < 1e-14);
        }
    }

    #[test]
    fn in_the_plane_strains_are_those_without_the_component_33() {
        let plane = |[x, y, _, w]: Components| lanes([x, y, 0.0, w]);
        let mean = mean(plane(MEAN));
        let [with, without] = [
            mean.add::<true>(&plane(LINEAR)).strain::<true>(),
            mean.add::<false>(&plane(LINEAR)).strain::<false>(),
        ];
        assert!(size(&(with - without)) < 1e-15);
    }

    #[test]
    fn logarithms_of_stretches_are_added_up_to_the_second_order() {
        let mean = mean(lanes([1.5, -0.3, 0.0, 0.0]));
        let logarithm = |e: f64| (1.0 + 2.0 * e).ln() / 2.0;
        for size in [1e-2, 1e-3] {
            let linear = lanes([1.5 + 4.0 * size, -0.3, 0.0, 0.0]);
            let strain = mean.add::<true>(&linear).strain::<true>().x.0[0];
            let found = logarithm(strain) - logarithm(1.5) - size;
            assert!(found.abs() < size * size * size, "{found}");
        }
    }

    #[test]
    fn the_material_feels_that_displacements_turn_a_point_inside_out() {
        // a bar of the stretch F that is bent in its plane has the stretch F + q s at s, and a strain that is linear in
        // q
        let stretch: f64 = 1.3;
        let strain = [(stretch * stretch - 1.0) / 2.0, 0.1, 0.2, 0.0];
        let of = |qs: f64| {
            let linear = moved(strain, stretch * qs, [1.0, 0.0, 0.0, 0.0]);
            let e = mean(lanes(strain)).add::<true>(&linear).strain::<true>();
            let Symmetric { x, y, z, w } = e.lane(0) * 2.0;
            ((1.0 + x) * (1.0 + y) - w * w) * (1.0 + z)
        };
        let all: Vec<f64> = (0..20)
            .map(|i| of(-stretch * f64::from(i) / 20.0))
            .collect();
        assert!(all.windows(2).all(|pair| pair[1] < pair[0]), "{all:?}");
        let last = of(-stretch * (1.0 - 1e-12));
        assert!(last > 0.0 && last < 1e-11, "{last}");
        assert!(of(-1.01 * stretch).is_nan());
    }
}
