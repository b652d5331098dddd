//! Compressible hyperelastic materials whose energy depends on the invariants of the distortion and on the volume
//! (Holzapfel, Nonlinear Solid Mechanics, sections 6.4 to 6.6). See docs/theory/materials.md.

use super::hyperelastic::Hyperelastic;
use super::number::Number;
use super::strains::StrainChange;
use super::symmetric::{Symmetric, Tangent, cofactor, dyad, minor, product, with_identity};

/// The energy of the change of volume:
///
/// ```text
/// U(J) = (J - 1)²/D1 + (J - 1)^4/D2 + (J - 1)^6/D3,   K = 2/D1
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct VolumeEnergy {
    /// Constants D1, D2, D3 (length^2/force); D1 is positive, and a constant of zero means that there is no such term.
    pub d: [f64; 3],
}

impl VolumeEnergy {
    /// Inverses 1/D1, 1/D2, 1/D3; zero for a missing term.
    #[inline(always)]
    fn stiffnesses(&self) -> [f64; 3] {
        self.d.map(|d| if d > 0.0 { 1.0 / d } else { 0.0 })
    }

    /// Whether only the first term exists: the compiler then simplifies the formulas, since it
    /// knows which constants are zero.
    #[inline(always)]
    fn is_quadratic(&self) -> bool {
        self.d[1] == 0.0 && self.d[2] == 0.0
    }

    /// Energy U as a function of J - 1 (force/length^2).
    #[inline(always)]
    pub fn energy<T: Number>(&self, grown: T) -> T {
        let ([k1, k2, k3], r) = (self.stiffnesses(), grown * grown);
        match self.is_quadratic() {
            true => r * k1,
            false => r * (r * (r * k3 + k2) + k1),
        }
    }

    /// Derivatives U' and U'' (force/length^2).
    #[inline(always)]
    pub fn slopes<T: Number>(&self, grown: T) -> [T; 2] {
        let ([k1, k2, k3], r) = (self.stiffnesses(), grown * grown);
        if self.is_quadratic() {
            return [grown * (2.0 * k1), T::all(2.0 * k1)];
        }
        [
            grown * (r * (r * (3.0 * k3) + 2.0 * k2) + k1) * 2.0,
            (r * (r * (15.0 * k3) + 6.0 * k2) + k1) * 2.0,
        ]
    }

    /// Difference quotient (U(J1) - U(J0))/(J1 - J0) (force/length^2).
    #[inline(always)]
    pub fn quotient<T: Number>(&self, grown0: T, grown1: T) -> T {
        let [k1, k2, k3] = self.stiffnesses();
        if self.is_quadratic() {
            return (grown1 + grown0) * k1;
        }
        let [r0, r1] = [grown0 * grown0, grown1 * grown1];
        (grown1 + grown0) * ((r1 + r0) * k2 + (r1 * r1 + r1 * r0 + r0 * r0) * k3 + k1)
    }
}

/// An energy W = w(x) + C01 y + U(J) of invariants.
///
/// The tensor C = I + 2 E has the invariants I1, I2 and I3 = J²; with a = J^(2/3), x = I1/a - 3, y = I2/a² - 3 and P =
/// C^-1 the energy and the stress are:
///
/// ```text
/// stress   S = 2 w' (I - I1/3 P)/a + 2 C01 (I1 I - C - 2 I2/3 P)/a² + U' J P
/// ```
///
/// Terms are arranged so that small strains keep their digits. For G = 2 E let i = tr G, m the sum of its principal
/// minors and n its determinant; then s = i + m + n, a = (1 + s)^(1/3) and b = a - 1,
///
/// ```text
/// x = (b² (b + 3) - m - n)/a,     y = (b² (2 b + 3) - m - 2 n)/a²
/// (I - I1/3 P) I3 = G + (m + n) I - cof G - i/3 cof C
/// (I1 I - C - 2 I2/3 P) I3 = G - i I - 2 cof G + s (2 I + i I - G) - 2/3 (2 i + m) cof C
/// ```
pub trait InvariantEnergy {
    /// Whether w is linear in x.
    const LINEAR: bool;
    /// Whether the term with C01 exists.
    const SECOND: bool;

    /// C01 (force/length^2).
    fn c01(&self) -> f64;

    /// Value of w at x (force/length^2).
    fn shape<T: Number>(&self, x: T) -> T;

    /// Derivatives w' and w'' (force/length^2).
    fn shape_slopes<T: Number>(&self, x: T) -> [T; 2];

    /// Difference quotient (w(x1) - w(x0))/(x1 - x0) (force/length^2).
    fn shape_quotient<T: Number>(&self, x0: T, x1: T) -> T;

    /// U(J).
    fn volume(&self) -> VolumeEnergy;
}

/// Measures of the change of volume and shape at a strain.
struct Invariants<T> {
    /// Tensor G = 2 E.
    g: Symmetric<T>,
    /// Invariants i, m and n of G: its trace, the sum of its principal minors, and its determinant.
    i: T,
    m: T,
    n: T,
    /// Sum s = i + m + n of the invariants of G, with J² = 1 + s.
    s: T,
    j: T,
    /// Change of volume J - 1 = s/(J + 1).
    grown: T,
    /// Factor a = J^(2/3).
    a: T,
    /// Difference b = a - 1 = s/(a² + a + 1).
    b: T,
    /// The inverses 1/a and 1/J².
    over_a: T,
    over_square: T,
}

impl<T: Number> Invariants<T> {
    #[inline(always)]
    fn new<const HOOP: bool>(e: &Symmetric<T>) -> Self {
        let g = e.map(|e| e * 2.0);
        let (of_plane, q) = (g.x + g.y, minor(&g));
        let (i, m, n) = match HOOP {
            true => (of_plane + g.z, q + g.z * of_plane, g.z * q),
            false => (of_plane, q, T::default()),
        };
        let s = match HOOP {
            true => i + m + n,
            false => i + q,
        };
        let square = s + 1.0;
        // J^(-2/3) is computed once, with a single division: divisions take as long as everything
        // else
        let (j, over_a) = (square.sqrt(), square.inverse_cbrt());
        let a = square * over_a * over_a;
        let (of_j, of_a) = (j + 1.0, a * a + a + 1.0);
        let both = s / (of_j * of_a);
        Invariants {
            g,
            i,
            m,
            n,
            s,
            j,
            grown: both * of_a,
            a,
            b: both * of_j,
            over_a,
            over_square: over_a * over_a * over_a,
        }
    }

    /// Product a x = a (I1/a - 3).
    #[inline(always)]
    fn distortion(&self) -> T {
        self.b * self.b * (self.b + 3.0) - self.m - self.n
    }

    /// Invariant x = I1/a - 3 of the distortion.
    #[inline(always)]
    fn x(&self) -> T {
        self.distortion() * self.over_a
    }

    /// Invariant y = I2/a² - 3 of the distortion.
    #[inline(always)]
    fn y(&self) -> T {
        let b = self.b;
        (b * b * (b * 2.0 + 3.0) - self.m - self.n * 2.0) * (self.over_a * self.over_a)
    }

    /// Difference cof C - I = tr(G) I - G + cof G; without `HOOP` C_33 = 1.
    #[inline(always)]
    fn change_of_cofactor<const HOOP: bool>(&self) -> Symmetric<T> {
        let Symmetric { x, y, z, w } = self.g;
        let across = x + y + minor(&self.g);
        match HOOP {
            true => Symmetric::new(y + z + y * z, x + z + x * z, across, (w + w * z) * -1.0),
            false => Symmetric::new(y, x, across, w * -1.0),
        }
    }

    /// Cofactor tensor cof C = I3 C^-1.
    #[inline(always)]
    fn cofactor<const HOOP: bool>(&self) -> Symmetric<T> {
        let change = self.change_of_cofactor::<HOOP>();
        change.plus_isotropic(T::all(1.0))
    }

    /// cof G.
    #[inline(always)]
    fn cofactor_of_change<const HOOP: bool>(&self) -> Symmetric<T> {
        match HOOP {
            true => cofactor(&self.g),
            false => Symmetric {
                z: self.m,
                ..Symmetric::zeros()
            },
        }
    }
}

impl<T: Number, const HOOP: bool, L: InvariantEnergy> Hyperelastic<T, HOOP> for L {
    /// Stored energy W = w(x) + C01 y + U(J), eq. (2.14) and eq. (2.23).
    #[inline(always)]
    fn energy(&self, e: &Symmetric<T>) -> T {
        let v = Invariants::new::<HOOP>(e);
        let energy = self.shape(v.x()) + self.volume().energy(v.grown);
        match L::SECOND {
            true => energy + v.y() * self.c01(),
            false => energy,
        }
    }

    /// Change of the stored energy, W(E1) - W(E0), computed from dE; the invariant m is quadratic and n cubic in G:
    ///
    /// ```text
    /// dm = (tr(G_m) I - G_m):dG                 dq = (cof of G_m in the plane):dG,  n = G_33 q
    /// ds = di + dm + dn                         da = db = ds/(a1² + a1 a0 + a0²)
    /// dx = (d(b³ + 3 b²) - dm - dn - x0 da)/a1  dy = (d(2 b³ + 3 b²) - dm - 2 dn - y0 d(a²))/a1²
    /// dJ = ds/(J1 + J0)
    /// ```
    #[inline(always)]
    fn energy_change(&self, change: &StrainChange<T>) -> T {
        let v0 = Invariants::new::<HOOP>(&change.start);
        let v1 = Invariants::new::<HOOP>(&change.end);
        let StrainChange { mean, half, .. } = change;
        let of_plane = half.x + half.y;
        let dq = (mean.y * half.x + mean.x * half.y - mean.w * half.w * 2.0) * 8.0;
        let (di, dm, dn) = match HOOP {
            true => {
                let around = ((mean.x + mean.y) * half.z + mean.z * of_plane) * 8.0;
                let (q0, q1) = (minor(&v0.g), minor(&v1.g));
                let dn = half.z * (q0 + q1) * 2.0 + mean.z * dq * 2.0;
                ((of_plane + half.z) * 4.0, dq + around, dn)
            }
            false => (of_plane * 4.0, dq, T::default()),
        };
        let ds = match HOOP {
            true => di + dm + dn,
            false => di + dm,
        };
        let (of_a, of_j) = (v1.a * v1.a + v1.a * v0.a + v0.a * v0.a, v1.j + v0.j);
        let both = ds / (of_a * of_j);
        let (da, dj) = (both * of_j, both * of_a);
        let (squares, cubes) = (v1.b + v0.b, v1.b * v1.b + v1.b * v0.b + v0.b * v0.b);
        let dx = (da * (cubes + squares * 3.0) - dm - dn - v0.x() * da) * v1.over_a;
        let slope = match L::LINEAR {
            true => self.shape_quotient(T::default(), T::default()),
            false => self.shape_quotient(v0.x(), v1.x()),
        };
        let energy = dx * slope + dj * self.volume().quotient(v0.grown, v1.grown);
        if !L::SECOND {
            return energy;
        }
        let second = da * (cubes * 2.0 + squares * 3.0) - dm - dn * 2.0;
        let dy = (second - v0.y() * da * (v1.a + v0.a)) * (v1.over_a * v1.over_a);
        energy + dy * self.c01()
    }

    /// Stress S = 2 w' (I - I1/3 P)/a + 2 C01 (I1 I - C - 2 I2/3 P)/a² + U' J P, eq. (2.15) and eq. (2.24). With K =
    /// cof C - I the first and the last term of the stress are
    ///
    /// ```text
    /// (shape (2 i/3 + m + n) + p J/J²) I + (p J/J² - shape (1 + i/3)) K,   shape = 2 w'/(a J²)
    /// ```
    #[inline(always)]
    fn stress(&self, e: &Symmetric<T>) -> Symmetric<T> {
        let v = Invariants::new::<HOOP>(e);
        let change = v.change_of_cofactor::<HOOP>();
        let [of_x, _] = self.shape_slopes(v.x());
        let [p, _] = self.volume().slopes(v.grown);
        let shape = of_x * v.over_a * v.over_square * 2.0;
        let pressure = p * v.j * v.over_square;
        let distorted = match HOOP {
            true => v.i * (2.0 / 3.0) + v.m + v.n,
            false => v.i * (2.0 / 3.0) + v.m,
        };
        let of_change = pressure - (v.i * (1.0 / 3.0) + 1.0) * shape;
        let stress = change
            .times(of_change)
            .plus_isotropic(distorted * shape + pressure);
        if !L::SECOND {
            return stress;
        }
        let b = v.g.map(|g| g * -1.0).plus_isotropic(v.i + 2.0);
        let cof_g = v.cofactor_of_change::<HOOP>();
        let second = v.g.plus_isotropic(v.i * -1.0) - cof_g.map(|a| a * 2.0) + b.times(v.s)
            - v.cofactor::<HOOP>().times((v.i * 2.0 + v.m) * (2.0 / 3.0));
        let factor = v.over_a * v.over_a * v.over_square * (2.0 * self.c01());
        stress + second.times(factor)
    }

    /// Tangent C = 4 d²W/dC²:
    ///
    /// ```text
    /// x' = (I - I1/3 P)/a,  B = I1 I - C
    /// C = 4 w''  x' x x'
    ///     + 4 w'/a   [ I1/3 P o P + I1/9 P x P - (I x P + P x I)/3 ]
    ///     + 4 C01/a² [ I x I - I o I - 2/3 (B x P + P x B) + 4 I2/9 P x P + 2 I2/3 P o P ]
    ///     + (U'' J² + U' J) P x P - 2 U' J P o P
    /// ```
    #[inline(always)]
    fn tangent(&self, e: &Symmetric<T>) -> Tangent<T> {
        let v = Invariants::new::<HOOP>(e);
        let inverse = v.cofactor::<HOOP>().times(v.over_square);
        let [of_x, of_xx] = self.shape_slopes(v.x());
        let [p, stiff] = self.volume().slopes(v.grown);
        let (i1, i2) = (v.i + 3.0, v.i * 2.0 + v.m + 3.0);
        let shape = of_x * v.over_a * (4.0 / 3.0);
        let second = v.over_a * v.over_a * (4.0 * self.c01());
        // factors of P o P and of P x P
        let mut of_product = shape * i1 - p * v.j * 2.0;
        let mut of_square = shape * i1 * (1.0 / 3.0) + (p + stiff * v.j) * v.j;
        if L::SECOND {
            of_product += second * i2 * (2.0 / 3.0);
            of_square += second * i2 * (4.0 / 9.0);
        }
        let (around, square) = (product(&inverse), dyad(&inverse, &inverse));
        let mixed = with_identity(&inverse);
        let mut c = Tangent::of(|i, j| {
            let own = around[i][j] * of_product + square[i][j] * of_square;
            own - mixed[i][j] * shape
        });
        if !L::LINEAR {
            let shrunk = inverse.times(i1 * (-1.0 / 3.0));
            let slope = shrunk.plus_isotropic(T::all(1.0)).times(v.over_a);
            let (slopes, factor) = (dyad(&slope, &slope), of_xx * 4.0);
            c = Tangent::of(|i, j| c.0[i][j] + slopes[i][j] * factor);
        }
        if L::SECOND {
            let b = v.g.map(|g| g * -1.0).plus_isotropic(v.i + 2.0);
            let (b, identity) = (dyad(&b, &inverse), Symmetric::<T>::identity());
            let (unit, own) = (dyad(&identity, &identity), product(&identity));
            c = Tangent::of(|i, j| {
                let of_b = (b[i][j] + b[j][i]) * (2.0 / 3.0);
                c.0[i][j] + (unit[i][j] - own[i][j] - of_b) * second
            });
        }
        c
    }
}
