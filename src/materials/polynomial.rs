//! Compressible hyperelastic materials of Mooney-Rivlin and Yeoh: polynomials of the invariants of the shape, and of the
//! volume (Holzapfel, Nonlinear Solid Mechanics, sections 6.4 to 6.6; Yeoh, Rubber Chem. Technol. 63, 1990), in plane
//! strain and in plane stress. Section 2 of docs/theory.md.

use nalgebra::{Matrix2, Matrix3, Matrix4, Vector4};

use super::symmetric::{IDENTITY, Symmetric, both, cofactor, contract, dyad, product};
use super::{Across, Hyperelastic, LawCard, NeoHooke, Plane, SmallStrainModuli, SolidHyperelastic};

/// Hyperelastic material, `*HYPERELASTIC`; a Neo-Hookean one in plane stress too.
///
/// With C = I + 2 E, I1, I2 and I3 = J² its invariants, a = J^(2/3), x = I1/a - 3, y = I2/a² - 3 and P = C^-1:
///
/// ```text
/// energy   W = w(x) + C01 y + U(J),   w = C10 x + C20 x² + C30 x³,   U = sum_i (J - 1)^2i/D_i
/// stress   S = 2 w' (I - I1/3 P)/a + 2 C01 (I1 I - C - 2 I2/3 P)/a² + U' J P
/// domain   J > 0
/// moduli   mu = 2 (C10 + C01),  K = 2/D1
/// ```
///
/// Terms are arranged so that small strains keep their digits: with G = 2 E, i = tr G, m and n the sum of its principal
/// minors and its determinant, s = i + m + n, a = (1 + s)^(1/3) and b = a - 1,
///
/// ```text
/// x = (b² (b + 3) - m - n)/a,     y = (b² (2 b + 3) - m - 2 n)/a²
/// (I - I1/3 P) I3 = G + (m + n) I - cof G - i/3 cof C
/// (I1 I - C - 2 I2/3 P) I3 = G - i I - 2 cof G + s (2 I + i I - G) - 2/3 (2 i + m) cof C
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Polynomial {
    /// C10, C20, C30 of x, x², x³ (force/length^2).
    pub shape: [f64; 3],
    /// C01 of y (force/length^2).
    pub c01: f64,
    /// D1, D2, D3 of (J - 1)², (J - 1)^4, (J - 1)^6 (length^2/force); the first is positive, zeros are no terms.
    pub d: [f64; 3],
}

impl From<NeoHooke> for Polynomial {
    fn from(NeoHooke { c10, d1 }: NeoHooke) -> Self {
        Polynomial {
            shape: [c10, 0.0, 0.0],
            c01: 0.0,
            d: [d1, 0.0, 0.0],
        }
    }
}

/// Measures of the change of volume and shape at a strain.
struct Invariants {
    /// G = 2 E.
    g: Symmetric,
    /// tr G, the sum of its principal minors and its determinant.
    i: f64,
    m: f64,
    n: f64,
    /// s = i + m + n, so that J² = 1 + s.
    s: f64,
    j: f64,
    /// J - 1 = s/(J + 1).
    grown: f64,
    /// a = J^(2/3).
    a: f64,
    /// b = a - 1 = s/(a² + a + 1).
    b: f64,
}

impl Invariants {
    fn new(e: &Symmetric) -> Self {
        let g = e * 2.0;
        let i = g.x + g.y + g.z;
        let q = g.x * g.y - g.w * g.w;
        let (m, n) = (q + g.z * (g.x + g.y), g.z * q);
        let s = i + m + n;
        let (j, a) = ((1.0 + s).sqrt(), (1.0 + s).cbrt());
        Invariants {
            g,
            i,
            m,
            n,
            s,
            j,
            grown: s / (j + 1.0),
            a,
            b: s / (a * a + a + 1.0),
        }
    }

    /// x = I1/a - 3
    fn x(&self) -> f64 {
        let b = self.b;
        (b * b * (b + 3.0) - self.m - self.n) / self.a
    }

    /// y = I2/a² - 3
    fn y(&self) -> f64 {
        let b = self.b;
        (b * b * (2.0 * b + 3.0) - self.m - 2.0 * self.n) / (self.a * self.a)
    }

    /// cof C = I3 C^-1
    fn cofactor(&self) -> Symmetric {
        cofactor(&(IDENTITY + self.g))
    }
}

impl Polynomial {
    /// `*HYPERELASTIC, MOONEY-RIVLIN`, or YEOH where C01 is zero.
    pub fn cards(&self) -> Vec<LawCard> {
        let ([c10, c20, c30], [d1, d2, d3]) = (self.shape, self.d);
        let (form, row) = match self.c01 != 0.0 {
            true => ("MOONEY-RIVLIN", vec![c10, self.c01, d1]),
            false => ("YEOH", vec![c10, c20, c30, d1, d2, d3]),
        };
        vec![LawCard {
            keyword: "HYPERELASTIC",
            parameter: Some(form),
            rows: vec![row],
        }]
    }

    /// mu = 2 (C10 + C01) and K = 2/D1, E = 9 K mu/(3 K + mu), nu = (3 K - 2 mu)/(2 (3 K + mu)).
    pub fn small_strain(&self) -> SmallStrainModuli {
        let (mu, k) = (2.0 * (self.shape[0] + self.c01), 2.0 / self.d[0]);
        SmallStrainModuli {
            young: 9.0 * k * mu / (3.0 * k + mu),
            poisson: (3.0 * k - 2.0 * mu) / (2.0 * (3.0 * k + mu)),
        }
    }

    /// 1/D1, 1/D2, 1/D3, zero without the term.
    fn stiffnesses(&self) -> [f64; 3] {
        self.d.map(|d| if d > 0.0 { 1.0 / d } else { 0.0 })
    }

    /// w' and w'' at x.
    fn of_shape(&self, x: f64) -> [f64; 2] {
        let [c10, c20, c30] = self.shape;
        [
            c10 + x * (2.0 * c20 + x * 3.0 * c30),
            2.0 * c20 + 6.0 * c30 * x,
        ]
    }

    /// U' and U'' at J, given J - 1.
    fn of_volume(&self, grown: f64) -> [f64; 2] {
        let [k1, k2, k3] = self.stiffnesses();
        let squared = grown * grown;
        [
            2.0 * grown * (k1 + squared * (2.0 * k2 + squared * 3.0 * k3)),
            2.0 * (k1 + squared * (6.0 * k2 + squared * 15.0 * k3)),
        ]
    }

    /// S_33 and C_3333, the components across of stress and tangent (force/length^2).
    fn across(&self, e: &Symmetric) -> [f64; 2] {
        let v = Invariants::new(e);
        let q = v.g.x * v.g.y - v.g.w * v.g.w;
        let (cof, square) = (1.0 + v.g.x + v.g.y + q, 1.0 + v.s);
        let [of_x, of_xx] = self.of_shape(v.x());
        let [p, stiff] = self.of_volume(v.grown);
        let first = v.g.z + v.m + v.n - q - cof * (v.i / 3.0);
        let second = v.g.z - v.i - q * 2.0 + (2.0 + v.i - v.g.z) * v.s
            - cof * (2.0 / 3.0 * (2.0 * v.i + v.m));
        let of_y = self.c01 / (v.a * v.a);
        let stress = 2.0 * (first * of_x / v.a + second * of_y) / square + cof * (p / v.j);
        let inverse = cof / square;
        let (i1, i2) = (3.0 + v.i, 3.0 + 2.0 * v.i + v.m);
        let slope = (1.0 - inverse * (i1 / 3.0)) / v.a;
        let first = inverse * (inverse * i1 * 4.0 / 9.0 - 2.0 / 3.0);
        let b = 2.0 + v.i - v.g.z;
        let second = inverse * (inverse * i2 * 10.0 / 9.0 - b * 4.0 / 3.0);
        let tangent = 4.0 * (of_xx * slope * slope + of_x / v.a * first + of_y * second)
            + inverse * inverse * v.j * (stiff * v.j - p);
        [stress, tangent]
    }
}

impl SolidHyperelastic for Polynomial {
    /// W = w(x) + C01 y + U(J), eq. (2.23) (force/length^2).
    fn energy(&self, e: &Symmetric) -> f64 {
        let v = Invariants::new(e);
        let ([c10, c20, c30], [k1, k2, k3]) = (self.shape, self.stiffnesses());
        let (x, squared) = (v.x(), v.grown * v.grown);
        x * (c10 + x * (c20 + x * c30))
            + self.c01 * v.y()
            + squared * (k1 + squared * (k2 + squared * k3))
    }

    /// W(E1) - W(E0) (force/length^2), from dE, m being quadratic and n cubic:
    ///
    /// ```text
    /// dm = (tr(G_m) I - G_m):dG                 dq = (cof of G_m in the plane):dG,  n = G_33 q
    /// ds = di + dm + dn                         da = db = ds/(a1² + a1 a0 + a0²)
    /// dx = (d(b³ + 3 b²) - dm - dn - x0 da)/a1  dy = (d(2 b³ + 3 b²) - dm - 2 dn - y0 d(a²))/a1²
    /// ```
    fn energy_change(&self, e0: &Symmetric, e1: &Symmetric) -> f64 {
        let (v0, v1) = (Invariants::new(e0), Invariants::new(e1));
        let (mean, dg) = (e0 + e1, (e1 - e0) * 2.0);
        let di = dg.x + dg.y + dg.z;
        let dm = (mean.x + mean.y + mean.z) * di - contract(&mean, &dg);
        let dq = mean.y * dg.x + mean.x * dg.y - 2.0 * mean.w * dg.w;
        let [q0, q1] = [&v0.g, &v1.g].map(|g| g.x * g.y - g.w * g.w);
        let dn = dg.z * (q0 + q1) / 2.0 + mean.z * dq;
        let ds = di + dm + dn;
        let da = ds / (v1.a * v1.a + v1.a * v0.a + v0.a * v0.a);
        let squares = da * (v1.b + v0.b);
        let cubes = da * (v1.b * v1.b + v1.b * v0.b + v0.b * v0.b);
        let (x0, x1, y0) = (v0.x(), v1.x(), v0.y());
        let dx = (cubes + 3.0 * squares - dm - dn - x0 * da) / v1.a;
        let dy =
            (2.0 * cubes + 3.0 * squares - dm - 2.0 * dn - y0 * da * (v1.a + v0.a)) / (v1.a * v1.a);
        let [c10, c20, c30] = self.shape;
        let shape = dx * (c10 + c20 * (x1 + x0) + c30 * (x1 * x1 + x1 * x0 + x0 * x0));
        let [k1, k2, k3] = self.stiffnesses();
        let [r0, r1] = [v0.grown * v0.grown, v1.grown * v1.grown];
        let dr = ds / (v1.j + v0.j) * (v1.grown + v0.grown);
        let volume = dr * (k1 + k2 * (r1 + r0) + k3 * (r1 * r1 + r1 * r0 + r0 * r0));
        shape + self.c01 * dy + volume
    }

    /// S = 2 w' (I - I1/3 P)/a + 2 C01 (I1 I - C - 2 I2/3 P)/a² + U' J P, eq. (2.24) (force/length^2).
    fn stress(&self, e: &Symmetric) -> Symmetric {
        let v = Invariants::new(e);
        let (cof, cof_g) = (v.cofactor(), cofactor(&v.g));
        let [of_x, _] = self.of_shape(v.x());
        let [p, _] = self.of_volume(v.grown);
        let first = v.g + IDENTITY * (v.m + v.n) - cof_g - cof * (v.i / 3.0);
        let second = v.g - IDENTITY * v.i - cof_g * 2.0 + (IDENTITY * (2.0 + v.i) - v.g) * v.s
            - cof * (2.0 / 3.0 * (2.0 * v.i + v.m));
        (first * (2.0 * of_x / v.a) + second * (2.0 * self.c01 / (v.a * v.a))) / (1.0 + v.s)
            + cof * (p / v.j)
    }

    /// C = 4 d²W/dC², on strains (11, 22, 33, 2*12) (force/length^2):
    ///
    /// ```text
    /// x' = (I - I1/3 P)/a,  B = I1 I - C
    /// C = 4 w''  x' x x'
    ///     + 4 w'/a   [ I1/3 P o P + I1/9 P x P - (I x P + P x I)/3 ]
    ///     + 4 C01/a² [ I x I - I o I - 2/3 (B x P + P x B) + 4 I2/9 P x P + 2 I2/3 P o P ]
    ///     + (U'' J² + U' J) P x P - 2 U' J P o P
    /// ```
    fn tangent(&self, e: &Symmetric) -> Matrix4<f64> {
        let v = Invariants::new(e);
        let inverse = v.cofactor() / (1.0 + v.s);
        let (square, around) = (dyad(&inverse, &inverse), product(&inverse));
        let (i1, i2) = (3.0 + v.i, 3.0 + 2.0 * v.i + v.m);
        let [of_x, of_xx] = self.of_shape(v.x());
        let [p, stiff] = self.of_volume(v.grown);
        let slope = (IDENTITY - inverse * (i1 / 3.0)) / v.a;
        let first = around * (i1 / 3.0) + square * (i1 / 9.0) - both(&IDENTITY, &inverse) / 3.0;
        let b = IDENTITY * (2.0 + v.i) - v.g;
        let second =
            dyad(&IDENTITY, &IDENTITY) - product(&IDENTITY) - both(&b, &inverse) * (2.0 / 3.0)
                + square * (4.0 * i2 / 9.0)
                + around * (2.0 * i2 / 3.0);
        dyad(&slope, &slope) * (4.0 * of_xx)
            + first * (4.0 * of_x / v.a)
            + second * (4.0 * self.c01 / (v.a * v.a))
            + square * ((stiff * v.j + p) * v.j)
            - around * (2.0 * p * v.j)
    }
}

/// A hyperelastic material in plane strain or in plane stress.
///
/// In plane stress the stretch across, F_33 = exp(l), makes W least, S_33 C_33 = 0, so that W is that of the strains in
/// the plane alone, eq. (2.25), and its tangent the one without the row across: C_ab - C_a3 C_3b/C_33.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanePolynomial {
    /// The material.
    pub law: Polynomial,
    /// Plane strain or plane stress.
    pub plane: Plane,
}

/// Most steps of Newton's method for the stretch across.
const MOST_STEPS: usize = 60;
/// Change of l, beside itself and the strains, that is round-off.
const ROUND_OFF: f64 = 2.0 * f64::EPSILON;

impl PlanePolynomial {
    /// The strain with its component across.
    fn complete(&self, e: &Matrix2<f64>) -> Symmetric {
        let across = match self.plane {
            Plane::Strain | Plane::Revolution => 0.0,
            Plane::Stress => self.strain_across(e),
        };
        Vector4::new(e.m11, e.m22, across, e.m12)
    }

    /// E_33 = (exp(2 l) - 1)/2 of plane stress by Newton's method in l, with the derivatives of W
    ///
    /// ```text
    /// W' = S_33 C_33,   W'' = C_3333 C_33² + 2 S_33 C_33
    /// ```
    ///
    /// A step that does not lower |W'| is halved. It starts at the stretch of linear elasticity in ln det F.
    fn strain_across(&self, e: &Matrix2<f64>) -> f64 {
        let at = |l: f64| Vector4::new(e.m11, e.m22, (2.0 * l).exp_m1() / 2.0, e.m12);
        // W' and W''
        let slopes = |l: f64| {
            let ([s33, c3333], c33) = (self.law.across(&at(l)), (2.0 * l).exp());
            [s33 * c33, (c3333 * c33 + 2.0 * s33) * c33]
        };
        let nu = self.law.small_strain().poisson;
        let squared = 2.0 * e.trace() + 4.0 * e.determinant();
        let mut l = -nu / (1.0 - nu) * squared.ln_1p() / 2.0;
        let [mut w1, mut w2] = slopes(l);
        for _ in 0..MOST_STEPS {
            let mut step = -w1 / w2.abs();
            let mut next = slopes(l + step);
            while next[0].abs() > w1.abs() && step.abs() > ROUND_OFF * (l.abs() + e.norm()) {
                step /= 2.0;
                next = slopes(l + step);
            }
            l += step;
            [w1, w2] = next;
            // what is no number is not far either
            let is_far = step.abs() > ROUND_OFF * (l.abs() + e.norm());
            if !is_far {
                break;
            }
        }
        (2.0 * l).exp_m1() / 2.0
    }
}

/// The part of a symmetric tensor in the plane.
fn in_plane(s: &Symmetric) -> Matrix2<f64> {
    Matrix2::new(s.x, s.w, s.w, s.y)
}

impl Hyperelastic for PlanePolynomial {
    fn stored_energy(&self, e: &Matrix2<f64>) -> f64 {
        self.law.energy(&self.complete(e))
    }

    /// An error of E_33 enters squared, as W is least there.
    fn energy_change(&self, e0: &Matrix2<f64>, e1: &Matrix2<f64>) -> f64 {
        (self.law).energy_change(&self.complete(e0), &self.complete(e1))
    }

    /// In plane stress S_ab - C_ab33/C_3333 S_33, in which the round-off of a large pressure drops out.
    fn stress(&self, e: &Matrix2<f64>) -> Matrix2<f64> {
        let e = self.complete(e);
        let s = self.law.stress(&e);
        in_plane(&match self.plane {
            Plane::Strain | Plane::Revolution => s,
            Plane::Stress => {
                let across = self.law.tangent(&e).column(2).into_owned();
                s - across * (s.z / across.z)
            }
        })
    }

    fn tangent(&self, e: &Matrix2<f64>) -> Matrix3<f64> {
        let c = self.law.tangent(&self.complete(e));
        const PLANE: [usize; 3] = [0, 1, 3];
        let condensed = match self.plane {
            Plane::Strain | Plane::Revolution => 0.0,
            Plane::Stress => 1.0 / c[(2, 2)],
        };
        Matrix3::from_fn(|i, j| {
            let (i, j) = (PLANE[i], PLANE[j]);
            c[(i, j)] - c[(i, 2)] * c[(2, j)] * condensed
        })
    }

    fn across(&self, e: &Matrix2<f64>) -> Across {
        let strain = self.complete(e);
        Across {
            stretch: (1.0 + 2.0 * strain.z).sqrt(),
            stress: match self.plane {
                Plane::Strain | Plane::Revolution => self.law.stress(&strain).z,
                Plane::Stress => 0.0,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::{ConstitutiveLaw, SaintVenantKirchhoff, Strains};
    use nalgebra::Vector3;

    /// mu = 400, K = 1000.
    const MOONEY_RIVLIN: Polynomial = Polynomial {
        shape: [150.0, 0.0, 0.0],
        c01: 50.0,
        d: [2e-3, 0.0, 0.0],
    };
    const YEOH: Polynomial = Polynomial {
        shape: [200.0, -20.0, 5.0],
        c01: 0.0,
        d: [2e-3, 1e-2, 3e-2],
    };
    const NEO_HOOKE: NeoHooke = NeoHooke {
        c10: 200.0,
        d1: 2e-3,
    };

    fn laws() -> [Polynomial; 3] {
        [NEO_HOOKE.into(), MOONEY_RIVLIN, YEOH]
    }

    fn planes() -> impl Iterator<Item = PlanePolynomial> {
        let each = |law| [Plane::Strain, Plane::Stress].map(|plane| PlanePolynomial { law, plane });
        laws().into_iter().flat_map(each)
    }

    fn strain(f: &Matrix2<f64>) -> Matrix2<f64> {
        (f.transpose() * f - Matrix2::identity()) / 2.0
    }

    fn strains() -> [Matrix2<f64>; 3] {
        [
            Matrix2::new(1.0, 0.0, 0.0, 1.0),
            Matrix2::new(1.4, 0.3, -0.5, 0.8),
            Matrix2::new(0.5, 0.4, 0.1, 0.9),
        ]
        .map(|f| strain(&f))
    }

    #[test]
    fn with_one_constant_it_is_the_neo_hookean_material() {
        let law = PlanePolynomial {
            law: NEO_HOOKE.into(),
            plane: Plane::Strain,
        };
        for e in strains() {
            let (s, c) = (
                Hyperelastic::stress(&law, &e),
                Hyperelastic::tangent(&law, &e),
            );
            assert!((s - Hyperelastic::stress(&NEO_HOOKE, &e)).norm() < 1e-13 * c.norm());
            assert!((c - Hyperelastic::tangent(&NEO_HOOKE, &e)).norm() < 1e-13 * c.norm());
            let (w, expected) = (
                Hyperelastic::stored_energy(&law, &e),
                Hyperelastic::stored_energy(&NEO_HOOKE, &e),
            );
            assert!((w - expected).abs() <= 1e-13 * c.norm());
            let [own, other] = [
                Hyperelastic::across(&law, &e),
                Hyperelastic::across(&NEO_HOOKE, &e),
            ];
            assert!((own.stress - other.stress).abs() < 1e-13 * c.norm());
        }
    }

    #[test]
    fn simple_shear_in_closed_form() {
        // F = I + g e_x e_y: I1 = I2 = 3 + g², J = 1, sigma_xy = 2 (w' + C01) g
        let g = 0.7_f64;
        let f = Matrix2::new(1.0, g, 0.0, 1.0);
        for law in laws() {
            let plane = PlanePolynomial {
                law,
                plane: Plane::Strain,
            };
            let [c10, c20, c30] = law.shape;
            let x = g * g;
            let energy = x * (c10 + x * (c20 + x * c30)) + law.c01 * x;
            assert!(
                (Hyperelastic::stored_energy(&plane, &strain(&f)) - energy).abs() < 1e-12 * energy
            );
            let slope = c10 + x * (2.0 * c20 + x * 3.0 * c30) + law.c01;
            let sigma = f * Hyperelastic::stress(&plane, &strain(&f)) * f.transpose();
            assert!((sigma.m12 - 2.0 * slope * g).abs() < 1e-12 * energy);
        }
    }

    #[test]
    fn stress_and_tangent_are_derivatives() {
        let h = 1e-6;
        for law in planes() {
            for e in strains() {
                let (s, c) = (
                    Hyperelastic::stress(&law, &e),
                    Hyperelastic::tangent(&law, &e),
                );
                let units = [
                    Matrix2::new(1.0, 0.0, 0.0, 0.0),
                    Matrix2::new(0.0, 0.0, 0.0, 1.0),
                    Matrix2::new(0.0, 0.5, 0.5, 0.0),
                ];
                for (k, unit) in units.iter().enumerate() {
                    let energy = |h: f64| Hyperelastic::stored_energy(&law, &(e + unit * h));
                    let slope = (energy(h) - energy(-h)) / (2.0 * h);
                    assert!((slope - s.dot(unit)).abs() < 1e-7 * c.norm(), "{law:?} {e}");
                    let stress = |h: f64| Hyperelastic::stress(&law, &(e + unit * h));
                    let d = (stress(h) - stress(-h)) / (2.0 * h);
                    let column = Vector3::new(d.m11, d.m22, d.m12);
                    assert!(
                        (column - c.column(k)).norm() < 1e-7 * c.norm(),
                        "{law:?} {e}"
                    );
                }
                assert!((c - c.transpose()).norm() < 1e-15 * c.norm());
            }
        }
    }

    #[test]
    fn small_strains_are_those_of_linear_elasticity_with_all_digits() {
        for PlanePolynomial { law, plane } in planes() {
            let SmallStrainModuli { young, poisson } = law.small_strain();
            let linear = SaintVenantKirchhoff { young, poisson }.in_plane(plane);
            let law = PlanePolynomial { law, plane };
            let c = Hyperelastic::tangent(&linear, &Matrix2::zeros());
            let own = Hyperelastic::tangent(&law, &Matrix2::zeros());
            assert!((own - c).norm() < 1e-14 * c.norm());
            let e = Matrix2::new(3.0, -1.0, -1.0, 2.0) * 1e-14;
            let [s, expected] = [
                Hyperelastic::stress(&law, &e),
                Hyperelastic::stress(&linear, &e),
            ];
            assert!((s - expected).norm() < 1e-12 * expected.norm(), "{law:?}");
            let expected = Hyperelastic::stored_energy(&linear, &e);
            let w = Hyperelastic::stored_energy(&law, &e);
            assert!((w - expected).abs() < 1e-12 * expected);
            let change = Hyperelastic::energy_change(&law, &e, &(e * 3.0));
            assert!((change - 8.0 * expected).abs() < 1e-11 * expected);
        }
    }

    #[test]
    fn the_work_of_the_energy_momentum_stress_is_the_change_of_energy() {
        for law in planes() {
            for size in [0.3, 1e-3, 1e-6, 1e-9, 1e-12] {
                let e0 = Matrix2::new(0.2, 0.15, 0.15, -0.1);
                let e1 = e0 + Matrix2::new(-0.7, 0.4, 0.4, 0.5) * size;
                let de = e1 - e0;
                let s = law.mean_stress(&e0, &e1);
                let change = Hyperelastic::energy_change(&law, &e0, &e1);
                assert!((s.dot(&de) - change).abs() <= 16.0 * f64::EPSILON * s.norm() * de.norm());
                // all digits of the change, beside the mean of the stresses
                let mean =
                    ConstitutiveLaw::stress(&law, &Strains::At((e0 + e1) / 2.0), &[], &mut []);
                let third_order = size * size * 1e4 + 1e-13;
                assert!(
                    (change / mean.dot(&de) - 1.0).abs() < third_order,
                    "{law:?} {size}"
                );
            }
            let [e0, e1] = [1, 2].map(|k| strains()[k]);
            let [w0, w1] = [e0, e1].map(|e| Hyperelastic::stored_energy(&law, &e));
            let change = Hyperelastic::energy_change(&law, &e0, &e1);
            assert!((change - (w1 - w0)).abs() < 1e-13 * (w0 + w1));
        }
    }

    #[test]
    fn uniaxial_and_biaxial_tension_of_an_incompressible_material() {
        // K/mu = 1e4: nominal stress of stretch l is 2 (w' + C01/l) (l - l^-2), of equal stretches 2 (w' + C01 l²) (l - l^-5)
        for law in [MOONEY_RIVLIN, YEOH] {
            let mu = 2.0 * (law.shape[0] + law.c01);
            let law = Polynomial {
                d: [2.0 / (1e4 * mu), 0.0, 0.0],
                ..law
            };
            let [c10, c20, c30] = law.shape;
            let slope = |x: f64| c10 + x * (2.0 * c20 + x * 3.0 * c30);
            let plane = PlanePolynomial {
                law,
                plane: Plane::Stress,
            };
            for l in [0.8_f64, 1.5] {
                let x = 2.0 * l * l + l.powi(-4) - 3.0;
                let biaxial = 2.0 * (slope(x) + law.c01 * l * l) * (l - l.powi(-5));
                let s =
                    Hyperelastic::stress(&plane, &(Matrix2::identity() * ((l * l - 1.0) / 2.0)));
                assert!(
                    (s.m11 * l / biaxial - 1.0).abs() < 3e-4,
                    "{law:?} {l} {}",
                    s.m11 * l / biaxial - 1.0
                );
            }
            for l in [0.5_f64, 1.5] {
                // the side of a bar that is free
                let mut side = 1.0 / l.sqrt();
                for _ in 0..50 {
                    let e = Matrix2::new((l * l - 1.0) / 2.0, 0.0, 0.0, (side * side - 1.0) / 2.0);
                    let (s, c) = (
                        Hyperelastic::stress(&plane, &e),
                        Hyperelastic::tangent(&plane, &e),
                    );
                    side -= s.m22 / (c.m22 * side);
                }
                let e = Matrix2::new((l * l - 1.0) / 2.0, 0.0, 0.0, (side * side - 1.0) / 2.0);
                let s = Hyperelastic::stress(&plane, &e);
                let x = l * l + 2.0 / l - 3.0;
                let expected = 2.0 * (slope(x) + law.c01 / l) * (l - 1.0 / (l * l));
                assert!(
                    (s.m11 * l / expected - 1.0).abs() < 1e-4,
                    "{law:?} {l} {}",
                    s.m11 * l / expected - 1.0
                );
                let across = Hyperelastic::across(&plane, &e);
                assert!((across.stretch - side).abs() < 1e-12, "isotropic");
            }
        }
    }
}
