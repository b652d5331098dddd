//! The shapes of elements with their quadrature and mass: the constant-strain triangle T3, the bilinear quadrilateral
//! Q4, the quadratic triangle T6 and the quadratic quadrilateral Q8 (serendipity), all isoparametric.
//! See docs/theory/elements.md.

// Loops over points, nodes and directions: indices are those of the formulas.
#![allow(clippy::needless_range_loop)]

use nalgebra::{Matrix2, SMatrix, SVector};

use crate::materials::Lanes;
use crate::model::Thickness;

/// One integration point of an element in the reference configuration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IntegrationPoint<const N: usize> {
    /// Shape functions h_a.
    pub shape: SVector<f64, N>,
    /// Gradients dh_a/dX_i, row a (1/length).
    pub gradient: SMatrix<f64, N, 2>,
    /// Weight: t det(dX/dr) times the quadrature weight (length^3).
    pub volume: f64,
}

/// The map from natural coordinates r to one integration point; two elements of a shape differ only by this map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jacobian {
    /// (dX/dr)^-1 (1/length).
    pub inverse: Matrix2<f64>,
    /// Weight: t det(dX/dr) times the quadrature weight, with 2 pi R in place of t in a body of revolution, eq. (2.32)
    /// (length^3).
    pub volume: f64,
}

/// Shape functions of N nodes at P integration points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShapeFunctions<const N: usize, const P: usize> {
    /// Shape functions h_a at every point.
    pub values: [[f64; N]; P],
    /// Natural derivatives dh_a/dr_i at every point.
    pub natural: [[[f64; 2]; N]; P],
    /// Quadrature weights of the points.
    pub weights: [f64; P],
}

impl<const N: usize, const P: usize> ShapeFunctions<N, P> {
    /// Maps dX/dr at every point of an element between nodes at `x`, where column a belongs to node
    /// a (length).
    pub fn jacobians(&self, x: &SMatrix<f64, 2, N>, thickness: Thickness) -> [Jacobian; P] {
        std::array::from_fn(|p| {
            let (inverse, det) = inverse_jacobian(x, &self.natural[p]);
            let radius = (0..N).map(|a| self.values[p][a] * x[(0, a)]).sum();
            Jacobian {
                inverse,
                volume: thickness.at(radius) * self.weights[p] * det,
            }
        })
    }

    /// Integrals int h_a h_b dOmega (length^3).
    fn mass(&self, x: &SMatrix<f64, 2, N>, thickness: Thickness) -> SMatrix<f64, N, N> {
        let points = self.points(&self.jacobians(x, thickness));
        let terms = points.iter();
        terms
            .map(|p| p.shape * p.shape.transpose() * p.volume)
            .sum()
    }

    /// Integrals int h_a dOmega (length^3).
    fn nodal_volumes(&self, x: &SMatrix<f64, 2, N>, thickness: Thickness) -> SVector<f64, N> {
        let points = self.points(&self.jacobians(x, thickness));
        points.iter().map(|p| p.shape * p.volume).sum()
    }

    /// The integration points with given maps dX/dr, where dh/dX = dh/dr (dX/dr)^-1.
    pub fn points(&self, jacobians: &[Jacobian; P]) -> [IntegrationPoint<N>; P] {
        let point = |p: usize| IntegrationPoint {
            shape: SVector::from(self.values[p]),
            gradient: gradients(&self.natural[p], &jacobians[p].inverse),
            volume: jacobians[p].volume,
        };
        std::array::from_fn(point)
    }
}

/// Inverse (dX/dr)^-1 and determinant det(dX/dr) at a place, from the natural derivatives dh_a/dr_i there.
fn inverse_jacobian<const N: usize>(
    x: &SMatrix<f64, 2, N>,
    natural: &[[f64; 2]; N],
) -> (Matrix2<f64>, f64) {
    let j: Matrix2<f64> = x * SMatrix::<f64, N, 2>::from_fn(|a, i| natural[a][i]);
    let det = j.determinant();
    (Matrix2::new(j.m22, -j.m12, -j.m21, j.m11) / det, det)
}

/// Gradients dh_a/dX = dh_a/dr (dX/dr)^-1, row a.
fn gradients<const N: usize>(
    natural: &[[f64; 2]; N],
    inverse: &Matrix2<f64>,
) -> SMatrix<f64, N, 2> {
    SMatrix::<f64, N, 2>::from_fn(|a, i| natural[a][i]) * inverse
}

/// Shape functions of N nodes at P integration points, and the two sums over the nodes that a sweep needs, computed
/// with the fewest operations for the shape.
pub trait IntegratedShape<const N: usize, const P: usize> {
    /// The values of the shape functions at the points.
    const FUNCTIONS: ShapeFunctions<N, P>;

    /// Natural derivatives dv/dr_i = sum_a v_a dh_a/dr_i of a field at a point.
    #[inline(always)]
    fn derivative(p: usize, v: &[Lanes; N]) -> [Lanes; 2] {
        let mut sum = [Lanes::ZERO; 2];
        for a in 0..N {
            let [r, s] = Self::FUNCTIONS.natural[p][a];
            sum[0] += v[a] * r;
            sum[1] += v[a] * s;
        }
        sum
    }

    /// Value of a field at a point.
    #[inline(always)]
    fn value(p: usize, v: &[Lanes; N]) -> Lanes {
        let mut value = Lanes::ZERO;
        for a in 0..N {
            value += v[a] * Self::FUNCTIONS.values[p][a];
        }
        value
    }

    /// The sum over all points of q_pi dh_a/dr_i at every node a: the transpose of [`Self::derivative`].
    #[inline(always)]
    fn nodal_sums(q: &[[Lanes; 2]; P]) -> [Lanes; N] {
        let mut sums = [Lanes::ZERO; N];
        for p in 0..P {
            for a in 0..N {
                let [r, s] = Self::FUNCTIONS.natural[p][a];
                sums[a] += q[p][0] * r + q[p][1] * s;
            }
        }
        sums
    }

    /// Consistent mass per density, m_ab = int h_a h_b dOmega (length^3), of an element between nodes at `x`. The
    /// radius of a ring is a further factor, so the quadrature for rings is exact to one degree more than in the plane.
    fn mass(x: &SMatrix<f64, 2, N>, thickness: Thickness) -> SMatrix<f64, N, N>;

    /// Share of each node in a uniform force per volume, int h_a dOmega (length^3).
    fn nodal_volumes(x: &SMatrix<f64, 2, N>, thickness: Thickness) -> SVector<f64, N>;
}

/// The triangle: linear shape functions h = (1 - r - s, r, s), evaluated at its centroid.
pub struct Triangle;

impl IntegratedShape<3, 1> for Triangle {
    const FUNCTIONS: ShapeFunctions<3, 1> = ShapeFunctions {
        values: [[1.0 / 3.0; 3]],
        natural: [[[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]]],
        weights: [0.5],
    };

    #[inline(always)]
    fn derivative(_p: usize, v: &[Lanes; 3]) -> [Lanes; 2] {
        [v[1] - v[0], v[2] - v[0]]
    }

    #[inline(always)]
    fn nodal_sums([[r, s]]: &[[Lanes; 2]; 1]) -> [Lanes; 3] {
        [Lanes::ZERO - *r - *s, *r, *s]
    }

    /// In the plane the mass per density is m_ab = V (1 + delta_ab) / 12.
    fn mass(x: &SMatrix<f64, 2, 3>, thickness: Thickness) -> SMatrix<f64, 3, 3> {
        if thickness == Thickness::Around {
            return Self::RING_MASS.mass(x, thickness);
        }
        let [point] = Self::FUNCTIONS.jacobians(x, thickness);
        (SMatrix::repeat(1.0) + SMatrix::identity()) * (point.volume / 12.0)
    }

    fn nodal_volumes(x: &SMatrix<f64, 2, 3>, thickness: Thickness) -> SVector<f64, 3> {
        match thickness {
            Thickness::Of(_) => Self::FUNCTIONS.nodal_volumes(x, thickness),
            Thickness::Around => Self::RING_MASS.nodal_volumes(x, thickness),
        }
    }
}

/// Natural coordinates of the nodes.
///
/// ```text
///  3 ---- 2   s
///  |      |   ^
///  |      |   |
///  0 ---- 1   +--> r
/// ```
pub(super) const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// Natural coordinate 1/sqrt(3) of the integration points; the nodes have the coordinate 1.
pub(super) const GAUSS: f64 = 0.577_350_269_189_625_8;
/// Half of the linear shape function (1 + GAUSS)/2 of an edge at its nearer integration point; this half is the natural
/// derivative across the edge. `FAR` is half of the linear shape function (1 - GAUSS)/2 at the farther integration
/// point.
const NEAR: f64 = (1.0 + GAUSS) / 4.0;
const FAR: f64 = (1.0 - GAUSS) / 4.0;

/// The quadrilateral: bilinear shape functions h_a = (1 + r_a r)(1 + s_a s)/4 at 2 x 2 Gauss points.
pub struct Quadrilateral;

impl IntegratedShape<4, 4> for Quadrilateral {
    const FUNCTIONS: ShapeFunctions<4, 4> = bilinear(BY_FOUR, [1.0; 4]);

    /// The derivative dv/dr depends only on s, and dv/ds only on r; both come from the differences along the edges.
    #[inline(always)]
    fn derivative(p: usize, v: &[Lanes; 4]) -> [Lanes; 2] {
        let (bottom, top) = (v[1] - v[0], v[2] - v[3]);
        let (left, right) = (v[3] - v[0], v[2] - v[1]);
        let [below, above] = [[NEAR, FAR], [FAR, NEAR]][p / 2];
        let [before, behind] = [[NEAR, FAR], [FAR, NEAR]][usize::from(p == 1 || p == 2)];
        [bottom * below + top * above, left * before + right * behind]
    }

    #[inline(always)]
    fn nodal_sums(q: &[[Lanes; 2]; 4]) -> [Lanes; 4] {
        let r = [q[0][0] + q[1][0], q[2][0] + q[3][0]];
        let s = [q[0][1] + q[3][1], q[1][1] + q[2][1]];
        let (bottom, top) = (r[0] * NEAR + r[1] * FAR, r[0] * FAR + r[1] * NEAR);
        let (left, right) = (s[0] * NEAR + s[1] * FAR, s[0] * FAR + s[1] * NEAR);
        [
            Lanes::ZERO - bottom - left,
            bottom - right,
            top + right,
            left - top,
        ]
    }

    /// The quadrature with 2 x 2 points is exact in the plane, since det(dX/dr) is linear.
    fn mass(x: &SMatrix<f64, 2, 4>, thickness: Thickness) -> SMatrix<f64, 4, 4> {
        match thickness {
            Thickness::Of(_) => Self::FUNCTIONS.mass(x, thickness),
            Thickness::Around => Self::RING_MASS.mass(x, thickness),
        }
    }

    fn nodal_volumes(x: &SMatrix<f64, 2, 4>, thickness: Thickness) -> SVector<f64, 4> {
        match thickness {
            Thickness::Of(_) => Self::FUNCTIONS.nodal_volumes(x, thickness),
            Thickness::Around => Self::RING_MASS.nodal_volumes(x, thickness),
        }
    }
}

/// Natural coordinates of the 2 x 2 Gauss points.
const BY_FOUR: [[f64; 2]; 4] = {
    let mut points = CORNERS;
    let mut p = 0;
    while p < 4 {
        points[p] = [GAUSS * CORNERS[p][0], GAUSS * CORNERS[p][1]];
        p += 1;
    }
    points
};

/// Shape functions of Q4 at the given points.
const fn bilinear<const P: usize>(
    points: [[f64; 2]; P],
    weights: [f64; P],
) -> ShapeFunctions<4, P> {
    let (mut values, mut natural) = ([[0.0; 4]; P], [[[0.0; 2]; 4]; P]);
    let mut k = 0;
    while k < 4 * P {
        let (p, a) = (k / 4, k % 4);
        let [r, s] = points[p];
        let [ra, sa] = CORNERS[a];
        values[p][a] = (1.0 + ra * r) * (1.0 + sa * s) / 4.0;
        natural[p][a] = [ra * (1.0 + sa * s) / 4.0, sa * (1.0 + ra * r) / 4.0];
        k += 1;
    }
    ShapeFunctions {
        values,
        natural,
        weights,
    }
}

/// The quadratic triangle with three points, which are exact for the strains of elements with
/// straight sides.
///
/// ```text
///   2
///   | \        h_0 = L (2 L - 1), h_1 = r (2 r - 1), h_2 = s (2 s - 1), L = 1 - r - s
///   5  4       h_3 = 4 L r,       h_4 = 4 r s,       h_5 = 4 s L
///   0-3-1
/// ```
pub struct QuadraticTriangle;

/// The six points of degree 4 (Dunavant 1985): for three points the value that two of their area coordinates have, and
/// their weight; then the same data of the other three points.
const DUNAVANT: [f64; 4] = [
    0.445_948_490_915_964_9,
    0.223_381_589_678_011_47,
    0.091_576_213_509_770_74,
    0.109_951_743_655_321_87,
];

/// The six points of degree 4 and their weights.
const DEGREE_4: ([[f64; 2]; 6], [f64; 6]) = {
    let [a, wa, b, wb] = DUNAVANT;
    let (c, d) = (1.0 - 2.0 * a, 1.0 - 2.0 * b);
    let points = [[a, a], [c, a], [a, c], [b, b], [d, b], [b, d]];
    let [wa, wb] = [wa / 2.0, wb / 2.0];
    (points, [wa, wa, wa, wb, wb, wb])
};

impl QuadraticTriangle {
    /// Quadrature of mass and body force.
    pub(super) const MASS: ShapeFunctions<6, 6> = quadratic_triangle(DEGREE_4.0, DEGREE_4.1);
}

impl Triangle {
    /// Quadrature of mass and body force of a ring, one degree higher because of the radius.
    pub(super) const RING_MASS: ShapeFunctions<3, 6> = {
        let (points, weights) = DEGREE_4;
        let mut values = [[0.0; 3]; 6];
        let mut p = 0;
        while p < 6 {
            let [r, s] = points[p];
            values[p] = [1.0 - r - s, r, s];
            p += 1;
        }
        ShapeFunctions {
            values,
            natural: [Self::FUNCTIONS.natural[0]; 6],
            weights,
        }
    };
}

impl Quadrilateral {
    /// Quadrature of mass and body force of a ring, one degree higher because of the radius.
    pub(super) const RING_MASS: ShapeFunctions<4, 9> = bilinear(DEGREE_5.0, DEGREE_5.1);
}

impl IntegratedShape<6, 3> for QuadraticTriangle {
    const FUNCTIONS: ShapeFunctions<6, 3> = {
        let (near, far) = (1.0 / 6.0, 2.0 / 3.0);
        quadratic_triangle([[near, near], [far, near], [near, far]], [near; 3])
    };

    fn mass(x: &SMatrix<f64, 2, 6>, thickness: Thickness) -> SMatrix<f64, 6, 6> {
        Self::MASS.mass(x, thickness)
    }

    fn nodal_volumes(x: &SMatrix<f64, 2, 6>, thickness: Thickness) -> SVector<f64, 6> {
        Self::MASS.nodal_volumes(x, thickness)
    }
}

/// Shape functions of T6 at the given points.
const fn quadratic_triangle<const P: usize>(
    points: [[f64; 2]; P],
    weights: [f64; P],
) -> ShapeFunctions<6, P> {
    let (mut values, mut natural) = ([[0.0; 6]; P], [[[0.0; 2]; 6]; P]);
    let mut p = 0;
    while p < P {
        let [r, s] = points[p];
        let l = 1.0 - r - s;
        values[p] = [
            l * (2.0 * l - 1.0),
            r * (2.0 * r - 1.0),
            s * (2.0 * s - 1.0),
            4.0 * l * r,
            4.0 * r * s,
            4.0 * s * l,
        ];
        natural[p] = [
            [1.0 - 4.0 * l, 1.0 - 4.0 * l],
            [4.0 * r - 1.0, 0.0],
            [0.0, 4.0 * s - 1.0],
            [4.0 * (l - r), -4.0 * r],
            [4.0 * s, 4.0 * r],
            [-4.0 * s, 4.0 * (l - s)],
        ];
        p += 1;
    }
    ShapeFunctions {
        values,
        natural,
        weights,
    }
}

/// The quadratic quadrilateral of the serendipity family at 3 x 3 Gauss points.
///
/// ```text
///  3 - 6 - 2   s     h_a = (1 + r_a r)(1 + s_a s)(r_a r + s_a s - 1)/4   at the corners
///  7       5   ^     h_a = (1 - r^2)(1 + s_a s)/2                        where r_a = 0
///  0 - 4 - 1   +> r  h_a = (1 + r_a r)(1 - s^2)/2                        where s_a = 0
/// ```
pub struct Serendipity;

/// The quadratic quadrilateral at 2 x 2 Gauss points.
pub struct ReducedSerendipity;

/// Natural coordinate sqrt(3/5) of the outer of three Gauss points.
const OUTER: f64 = 0.774_596_669_241_483_4;

/// The 3 x 3 Gauss points and their weights, exact up to degree 5 in r and in s.
pub(super) const DEGREE_5: ([[f64; 2]; 9], [f64; 9]) = {
    let (at, of) = ([-OUTER, 0.0, OUTER], [5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0]);
    let (mut points, mut weights) = ([[0.0; 2]; 9], [0.0; 9]);
    let mut p = 0;
    while p < 9 {
        points[p] = [at[p % 3], at[p / 3]];
        weights[p] = of[p % 3] * of[p / 3];
        p += 1;
    }
    (points, weights)
};

impl IntegratedShape<8, 9> for Serendipity {
    const FUNCTIONS: ShapeFunctions<8, 9> = serendipity(DEGREE_5.0, DEGREE_5.1);

    fn mass(x: &SMatrix<f64, 2, 8>, thickness: Thickness) -> SMatrix<f64, 8, 8> {
        Self::FUNCTIONS.mass(x, thickness)
    }

    fn nodal_volumes(x: &SMatrix<f64, 2, 8>, thickness: Thickness) -> SVector<f64, 8> {
        Self::FUNCTIONS.nodal_volumes(x, thickness)
    }
}

impl IntegratedShape<8, 4> for ReducedSerendipity {
    const FUNCTIONS: ShapeFunctions<8, 4> = serendipity(BY_FOUR, [1.0; 4]);

    fn mass(x: &SMatrix<f64, 2, 8>, thickness: Thickness) -> SMatrix<f64, 8, 8> {
        Serendipity::mass(x, thickness)
    }

    fn nodal_volumes(x: &SMatrix<f64, 2, 8>, thickness: Thickness) -> SVector<f64, 8> {
        Serendipity::nodal_volumes(x, thickness)
    }
}

/// Shape functions of Q8 at the given points.
const fn serendipity<const P: usize>(
    points: [[f64; 2]; P],
    weights: [f64; P],
) -> ShapeFunctions<8, P> {
    let (mut values, mut natural) = ([[0.0; 8]; P], [[[0.0; 2]; 8]; P]);
    let mut k = 0;
    while k < 4 * P {
        let (p, a) = (k / 4, k % 4);
        let [r, s] = points[p];
        let [ra, sa] = CORNERS[a];
        let (x, y) = (1.0 + ra * r, 1.0 + sa * s);
        values[p][a] = x * y * (ra * r + sa * s - 1.0) / 4.0;
        natural[p][a] = [
            ra * y * (2.0 * ra * r + sa * s) / 4.0,
            sa * x * (ra * r + 2.0 * sa * s) / 4.0,
        ];
        // between corner a and the next: s_a is that of both on sides 0 and 2, r_a on sides 1 and 3
        let (r2, s2) = (1.0 - r * r, 1.0 - s * s);
        (values[p][4 + a], natural[p][4 + a]) = if a % 2 == 0 {
            (r2 * y / 2.0, [-r * y, sa * r2 / 2.0])
        } else {
            (x * s2 / 2.0, [ra * s2 / 2.0, -s * x])
        };
        k += 1;
    }
    ShapeFunctions {
        values,
        natural,
        weights,
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use nalgebra::Matrix2;

    /// Checks gradients, volume and mass of an element of thickness 0.25 between nodes at `x`, whose corners come
    /// first.
    fn check<S: IntegratedShape<N, P>, const N: usize, const P: usize>(
        x: SMatrix<f64, 2, N>,
        corners: usize,
    ) {
        let t = Thickness::Of(0.25);
        let points = S::FUNCTIONS.points(&S::FUNCTIONS.jacobians(&x, t));
        let places = points.iter().map(|p| &p.gradient);
        for gradient in places {
            // sum_a X_a dh_a/dX = I, sum_a dh_a/dX = 0
            let identity: Matrix2<f64> = x * gradient;
            assert!((identity - Matrix2::identity()).norm() < 1e-13);
            assert!(gradient.row_sum().norm() < 1e-13);
        }
        for p in &points {
            assert!((p.shape.sum() - 1.0).abs() < 1e-15);
        }
        // shoelace formula, and two thirds of the parallelogram between a side and its curve
        let area: f64 = (0..corners)
            .map(|a| {
                let (p, q) = (x.column(a), x.column((a + 1) % corners));
                let chord = (p[0] * q[1] - q[0] * p[1]) / 2.0;
                let bow = if N > corners {
                    let (c, d) = (q - p, x.column(corners + a) - p);
                    2.0 / 3.0 * (d[0] * c[1] - d[1] * c[0])
                } else {
                    0.0
                };
                chord + bow
            })
            .sum();
        let mass = S::mass(&x, t);
        let volume: f64 = points.iter().map(|p| p.volume).sum();
        assert!((volume - 0.25 * area).abs() < 1e-14);
        assert!((mass.sum() - 0.25 * area).abs() < 1e-14);
        // forces of a uniform acceleration are those of a uniform force per volume
        assert!((mass.column_sum() - S::nodal_volumes(&x, t)).norm() < 1e-15);
        let mass = nalgebra::DMatrix::from_column_slice(N, N, mass.as_slice());
        assert!(mass.symmetric_eigenvalues().min() > 0.0);
    }

    /// Nodes of a distorted quadrilateral, three of whose sides are curved.
    pub(in crate::elements) const QUAD8: [[f64; 2]; 8] = [
        [0.0, 0.0],
        [2.0, 0.3],
        [1.7, 1.9],
        [-0.2, 1.2],
        [1.05, 0.0],
        [1.8, 1.15],
        [0.75, 1.55],
        [0.0, 0.55],
    ];

    /// Nodes of a triangle with two curved sides.
    pub(in crate::elements) const TRI6: [[f64; 2]; 6] = [
        [0.1, 0.0],
        [2.0, 0.3],
        [0.7, 1.9],
        [1.0, 0.1],
        [1.45, 1.2],
        [0.4, 0.95],
    ];

    #[test]
    fn linear_fields_volume_and_mass() {
        let quad = [[0.0, 0.0], [2.0, 0.3], [1.7, 1.9], [-0.2, 1.2]];
        check::<Quadrilateral, 4, 4>(SMatrix::from_columns(&quad.map(|p| p.into())), 4);
        let tri = SMatrix::from_columns(&[[0.1, 0.0], [2.0, 0.3], [0.7, 1.9]].map(|p| p.into()));
        check::<Triangle, 3, 1>(tri, 3);
        let volume = 1.9 * 1.9 - 0.6 * 0.3;
        assert!((Triangle::mass(&tri, Thickness::Of(2.0))[(0, 0)] - volume / 6.0).abs() < 1e-14);
        check::<QuadraticTriangle, 6, 3>(SMatrix::from_columns(&TRI6.map(|p| p.into())), 3);
        let quad = SMatrix::from_columns(&QUAD8.map(|p| p.into()));
        check::<Serendipity, 8, 9>(quad, 4);
        check::<ReducedSerendipity, 8, 4>(quad, 4);
    }

    #[test]
    fn shares_of_a_square_and_of_a_right_triangle_by_hand() {
        // corners -1/12, the others 1/3; corners 0, the others 1/3 (Zienkiewicz, The Finite Element Method)
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let between: Vec<[f64; 2]> = (0..4)
            .map(|i| [0, 1].map(|k| (square[i][k] + square[(i + 1) % 4][k]) / 2.0))
            .collect();
        let x = SMatrix::<f64, 2, 8>::from_fn(|i, a| match a {
            0..4 => square[a][i],
            _ => between[a - 4][i],
        });
        let shares = Serendipity::nodal_volumes(&x, Thickness::Of(1.0));
        for a in 0..8 {
            let exact = if a < 4 { -1.0 / 12.0 } else { 1.0 / 3.0 };
            assert!((shares[a] - exact).abs() < 1e-15);
        }
        let right = [
            [0.0, 0.0],
            [1.0, 0.0],
            [0.0, 1.0],
            [0.5, 0.0],
            [0.5, 0.5],
            [0.0, 0.5],
        ];
        let shares = QuadraticTriangle::nodal_volumes(
            &SMatrix::from_columns(&right.map(|p| p.into())),
            Thickness::Of(1.0),
        );
        for a in 0..6 {
            let exact = if a < 3 { 0.0 } else { 1.0 / 6.0 };
            assert!((shares[a] - exact).abs() < 1e-15);
        }
        // int (h_3)^2 over the right triangle: 16 int r^2 L^2 = 16 (2! 2!)/(6!) = 4/45
        let mass = QuadraticTriangle::mass(
            &SMatrix::from_columns(&right.map(|p| p.into())),
            Thickness::Of(1.0),
        );
        assert!((mass[(3, 3)] - 4.0 / 45.0).abs() < 1e-15);
    }
}
