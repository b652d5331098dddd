//! The formulas of the neo-Hookean material in plane strain, for several elements or points side by side, in which
//! stress, tangent and energies share what they have in common. Section 2 of docs/theory.md, and docs/numerics.md, Sweeps
//! over elements.

use std::array::from_fn;

use super::NeoHooke;
use super::hyperelastic::{NO_CHANGE, NO_CHANGE_OF_TANGENT};
use super::lanes::{
    Lanes, LawInLanes, StrainChange, SymmetricLanes, TangentLanes, combined, contract, times,
};

/// Measures of the change of volume and shape at a strain.
struct Dilatation {
    /// t = 2 tr E, so that I1 = 3 + t.
    t: Lanes,
    /// q = 4 det E.
    q: Lanes,
    /// J = sqrt(1 + t + q).
    j: Lanes,
    /// J - 1 = (t + q)/(J + 1).
    grown: Lanes,
    /// a = J^(2/3).
    a: Lanes,
    /// b = a - 1 = (t + q)/(a² + a + 1).
    b: Lanes,
    /// 1/a and 1/J².
    over_a: Lanes,
    over_square: Lanes,
}

impl Dilatation {
    #[inline(always)]
    fn new([xx, yy, xy]: &SymmetricLanes) -> Self {
        let t = (*xx + *yy) * 2.0;
        let q = (*xx * *yy - *xy * *xy) * 4.0;
        let (change, square) = (t + q, t + q + 1.0);
        // J^(-2/3) once, and no division but one: divisions take as long as all else
        let (j, over_a) = (square.sqrt(), square.inverse_cbrt());
        let a = square * over_a * over_a;
        let (of_j, of_a) = (j + 1.0, a * a + a + 1.0);
        let both = change / (of_j * of_a);
        Dilatation {
            t,
            q,
            j,
            grown: both * of_a,
            a,
            b: both * of_j,
            over_a,
            over_square: over_a * over_a * over_a,
        }
    }

    /// a (Ibar1 - 3)
    #[inline(always)]
    fn distortion(&self) -> Lanes {
        self.b * self.b * (self.b + 3.0) - self.q
    }
}

impl NeoHooke {
    /// S = 2 C10 J^(-2/3) (I - I1/3 C^-1) + p J C^-1, eq. (2.15), by eq. (2.16), cof C = I + 2 cof E and J C^-1 = cof C/J.
    #[inline(always)]
    fn stress_in_lanes(&self, [xx, yy, xy]: &SymmetricLanes, v: &Dilatation) -> SymmetricLanes {
        let diagonal = v.t * (2.0 / 3.0) + v.q;
        let part = v.t * (1.0 / 3.0) + 1.0;
        let cof = [*yy * 2.0, *xx * 2.0, *xy * -2.0];
        let shape = v.over_a * v.over_square * (2.0 * self.c10);
        let p = v.grown * (2.0 / self.d1) * v.j * v.over_square;
        [
            (diagonal - cof[0] * part) * shape + (cof[0] + 1.0) * p,
            (diagonal - cof[1] * part) * shape + (cof[1] + 1.0) * p,
            cof[2] * (p - part * shape),
        ]
    }

    #[inline(always)]
    fn tangent_in_lanes(&self, [xx, yy, xy]: &SymmetricLanes, v: &Dilatation) -> TangentLanes {
        let over = v.over_square;
        let c = [
            (*yy * 2.0 + 1.0) * over,
            (*xx * 2.0 + 1.0) * over,
            *xy * -2.0 * over,
        ];
        let p = v.grown * (2.0 / self.d1);
        let shape = v.over_a * (4.0 * self.c10 / 3.0);
        let i1 = v.t + 3.0;
        // factors of C^-1 o C^-1 and of C^-1 x C^-1
        let of_product = shape * i1 - p * v.j * 2.0;
        let of_square = shape * i1 * (1.0 / 3.0) + (p + v.j * (2.0 / self.d1)) * v.j;
        let product = [
            [c[0] * c[0], c[2] * c[2], c[0] * c[2]],
            [c[2] * c[2], c[1] * c[1], c[1] * c[2]],
            [c[0] * c[2], c[1] * c[2], (c[0] * c[1] + c[2] * c[2]) * 0.5],
        ];
        let one = [1.0, 1.0, 0.0];
        from_fn(|i| {
            from_fn(|j| {
                let mixed = c[j] * one[i] + c[i] * one[j];
                product[i][j] * of_product + c[i] * c[j] * of_square - mixed * shape
            })
        })
    }

    /// W1 - W0 of two strains.
    #[inline(always)]
    pub(super) fn energy_change_in_lanes(&self, change: &StrainChange) -> Lanes {
        let [v0, v1] = change.ends().map(|e| Dilatation::new(&e));
        self.energy_change_between(change, [&v0, &v1])
    }

    /// The differences of t, q, J², a, J and b one after the other from dE, det being quadratic:
    ///
    /// ```text
    /// dq = 4 cof(E_m):dE                        da = db = (dt + dq)/(a1² + a1 a0 + a0²)
    /// d(b³ + 3 b²) = da (b1² + b1 b0 + b0² + 3 (b1 + b0))
    /// dJ = (dt + dq)/(J1 + J0)                  d(N/a) = (dN - N0/a0 da)/a1
    /// ```
    #[inline(always)]
    fn energy_change_between(&self, change: &StrainChange, [v0, v1]: [&Dilatation; 2]) -> Lanes {
        let StrainChange { mean, half } = change;
        let along = mean[1] * half[0] + mean[0] * half[1] - mean[2] * half[2] * 2.0;
        let dq = along * 8.0;
        let squared = (half[0] + half[1]) * 4.0 + dq;
        let (of_a, of_j) = (v1.a * v1.a + v1.a * v0.a + v0.a * v0.a, v1.j + v0.j);
        let both = squared / (of_a * of_j);
        let (da, dj) = (both * of_j, both * of_a);
        let cubic = v1.b * v1.b + v1.b * v0.b + v0.b * v0.b + (v1.b + v0.b) * 3.0;
        let shape = (da * cubic - dq - v0.distortion() * v0.over_a * da) * v1.over_a;
        shape * self.c10 + dj * (v1.grown + v0.grown) * (1.0 / self.d1)
    }
}

/// f/(n:n), or 0 where |n| is not above a bound.
#[inline(always)]
fn over(f: Lanes, squared: Lanes, bound: f64) -> Lanes {
    let quotient = f / squared;
    let of = |i: usize| match squared.0[i] <= bound * bound {
        true => 0.0,
        false => quotient.0[i],
    };
    Lanes(from_fn(of))
}

impl LawInLanes for NeoHooke {
    #[inline(always)]
    fn stress(&self, e: &SymmetricLanes) -> SymmetricLanes {
        self.stress_in_lanes(e, &Dilatation::new(e))
    }

    /// S(E_m) + f/(dE:dE) dE, eq. (4.8)
    #[inline(always)]
    fn mean_stress(&self, change: &StrainChange) -> SymmetricLanes {
        let StrainChange { mean, half } = change;
        let [v0, v1] = change.ends().map(|e| Dilatation::new(&e));
        let s = LawInLanes::stress(self, mean);
        let f = self.energy_change_between(change, [&v0, &v1]) - contract(&s, half) * 2.0;
        let factor = over(f, contract(half, half) * 4.0, NO_CHANGE) * 2.0;
        combined(&s, half, |s, h| s + h * factor)
    }

    #[inline(always)]
    fn tangent(&self, e: &SymmetricLanes) -> TangentLanes {
        self.tangent_in_lanes(e, &Dilatation::new(e))
    }

    /// C + 2 f/(n:n) (I - 2 n n/(n:n)) + (n g + g n)/(n:n), n = dE, g = S(E1) - S(E_m) - C:n/2
    #[inline(always)]
    fn mean_tangent(&self, change: &StrainChange) -> TangentLanes {
        let StrainChange { mean, half } = change;
        let [e0, e1] = change.ends();
        let [v0, v1, vm] = [&e0, &e1, mean].map(Dilatation::new);
        let c = self.tangent_in_lanes(mean, &vm);
        let s = self.stress_in_lanes(mean, &vm);
        let f = self.energy_change_between(change, [&v0, &v1]) - contract(&s, half) * 2.0;
        let (end, along) = (self.stress_in_lanes(&e1, &v1), times(&c, half));
        let g: SymmetricLanes = from_fn(|i| end[i] - s[i] - along[i]);
        let n = half.map(|h| h * 2.0);
        let squared = contract(&n, &n);
        let of_mixed = over(Lanes::all(1.0), squared, NO_CHANGE_OF_TANGENT);
        let of_unit = f * of_mixed * 2.0;
        let of_square = of_unit * of_mixed * -2.0;
        let unit = [1.0, 1.0, 0.5];
        from_fn(|i| {
            from_fn(|j| {
                let mixed = (n[i] * g[j] + g[i] * n[j]) * of_mixed;
                let own = c[i][j] + n[i] * n[j] * of_square + mixed;
                match i == j {
                    true => own + of_unit * unit[i],
                    false => own,
                }
            })
        })
    }

    /// W = C10 (Ibar1 - 3) + (J - 1)²/D1, eq. (2.14), by eq. (2.16)
    #[inline(always)]
    fn stored_energy(&self, e: &SymmetricLanes) -> Lanes {
        let v = Dilatation::new(e);
        v.distortion() * v.over_a * self.c10 + v.grown * v.grown * (1.0 / self.d1)
    }

    /// F_zz = 1, S_zz = 2 C10 J^(-2/3) (1 - I1/3) + p J
    #[inline(always)]
    fn across(&self, e: &SymmetricLanes) -> [Lanes; 2] {
        let v = Dilatation::new(e);
        let shape = v.t * v.over_a * (2.0 / 3.0 * self.c10);
        [Lanes::all(1.0), v.grown * (2.0 / self.d1) * v.j - shape]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::{OneByOne, Plane, PlanePolynomial};

    #[test]
    fn stresses_tangents_and_energies_are_those_of_a_polynomial_of_one_constant() {
        let law = NeoHooke {
            c10: 200.0,
            d1: 2e-3,
        };
        let polynomial = PlanePolynomial {
            law: law.into(),
            plane: Plane::Strain,
        };
        let one = OneByOne(&polynomial);
        let near = |a: Lanes, b: Lanes, size: f64| {
            let is_near = |(a, b): (f64, f64)| (a - b).abs() <= 1e-13 * size;
            a.0.into_iter().zip(b.0).all(is_near)
        };
        for (size, step) in [
            (0.2, 0.1),
            (1.0, 0.2),
            (0.1, 1e-7),
            (0.1, 1e-17),
            (0.0, 0.0),
        ] {
            let mean =
                [Lanes([0.7, -0.2]), Lanes([-0.2, 0.9]), Lanes([0.3, 0.1])].map(|e| e * size);
            let half =
                [Lanes([0.1, -0.3]), Lanes([0.4, 0.2]), Lanes([-0.2, 0.1])].map(|e| e * step);
            let change = StrainChange { mean, half };
            let stresses = [
                [LawInLanes::stress(&law, &mean), one.stress(&mean)],
                [law.mean_stress(&change), one.mean_stress(&change)],
            ];
            for ([found, expected], i) in stresses.iter().flat_map(|s| [(s, 0), (s, 1), (s, 2)]) {
                assert!(
                    near(found[i], expected[i], 2000.0 * (size + 1e-300)),
                    "{size} {i}"
                );
            }
            let tangents = [
                [LawInLanes::tangent(&law, &mean), one.tangent(&mean)],
                [law.mean_tangent(&change), one.mean_tangent(&change)],
            ];
            // what the energy lacks is known to a part of about eps/|dE|
            let lost = [1.0, if step < 1e-6 { 1e6 } else { 10.0 }];
            for ([found, expected], lost) in tangents.iter().zip(lost) {
                for k in 0..9 {
                    let [a, b] = [found, expected].map(|c| c[k / 3][k % 3]);
                    assert!(near(a, b, 1e4 * lost), "{size} {step} {k}: {a:?} {b:?}");
                }
            }
            let energies = [
                LawInLanes::stored_energy(&law, &mean),
                one.stored_energy(&mean),
            ];
            assert!(near(
                energies[0],
                energies[1],
                1000.0 * (size * size + 1e-300)
            ));
            let [found, expected] = [LawInLanes::across(&law, &mean), one.across(&mean)];
            assert!(near(found[0], expected[0], 1.0) && near(found[1], expected[1], 2000.0));
        }
    }
}
