//! Elements of one shape next to each other, and their kinematics: displacement gradients and strains at the
//! integration points, in one configuration or between two configurations (energy-momentum form). Also the sums over
//! the integration points that give force and tangent. See docs/theory/elements.md and docs/numerics.md, Sweeps over
//! elements.

// Loops over points, nodes and directions: indices are those of the formulas.
#![allow(clippy::needless_range_loop)]

use std::array::from_fn;

use super::shapes::{IntegratedShape, Jacobian};
use crate::materials::number::{LANES, Positive};
use crate::materials::{Lanes, StrainChange, Strains};

/// A symmetric tensor for several elements.
pub type SymmetricLanes = crate::materials::Symmetric<Lanes>;
/// A material tangent for several elements.
pub type TangentLanes = crate::materials::Tangent<Lanes>;

/// A tensor of the plane, row by row, for several elements.
pub type TensorLanes = [[Lanes; 2]; 2];
/// Values at the nodes for several elements, x before y.
pub type NodalLanes<const N: usize> = [[Lanes; N]; 2];

/// Elements of one shape next to each other.
pub struct ElementBlock<const N: usize, const P: usize> {
    /// Nodes of the elements, numbered within the chunk.
    pub nodes: [[u16; LANES]; N],
    /// Inverse maps (dX/dr)^-1 at the integration points (1/length).
    pub inverse: [TensorLanes; P],
    /// Weights of the integration points (length^3).
    pub volume: [Lanes; P],
}

/// Displacements of the nodes at which a block is evaluated (length).
#[derive(Clone, Copy)]
pub enum BlockMotion<const N: usize> {
    /// Displacements u.
    At(NodalLanes<N>),
    /// Energy-momentum form: the mid configuration (u0 + u1)/2, and half the displacement increment
    /// (u1 - u0)/2.
    Between(NodalLanes<N>, NodalLanes<N>),
}

/// Displacement gradient at a point.
#[derive(Clone, Copy, Default)]
pub struct Gradient {
    /// Displacement gradient H in the plane of the section.
    pub h: TensorLanes,
    /// Strain h = u_r/R around the axis, in a body of revolution.
    pub around: Lanes,
}

/// Deformation at one integration point.
#[derive(Clone, Copy)]
pub struct Deformation {
    /// Displacement gradient in the strain-displacement matrix; in the energy-momentum form the gradient of the mid
    /// configuration.
    pub gradient: Gradient,
    /// Strains at which the material is evaluated.
    pub strains: Strains<Lanes>,
}

/// A block in a motion, with the reference data of its formulation.
pub struct MovedBlock<'a, const N: usize, const P: usize, R> {
    /// The elements.
    pub block: &'a ElementBlock<N, P>,
    /// Inverse radius 1/R at the integration points (1/length). The radius is infinite in plane strain, so 1/R is zero;
    /// elements of the plane do not read this value.
    pub over_radius: &'a [Lanes; P],
    /// Reference data of the formulation, except the data of the points.
    pub reference: &'a R,
    /// Displacements of the nodes.
    pub motion: BlockMotion<N>,
    /// Variables of the elements (not of their points) that the last accepted increment has committed; empty at the
    /// start.
    pub own_variables: [&'a [f64]; LANES],
}

impl<const N: usize> BlockMotion<N> {
    /// The motion between two configurations.
    #[inline(always)]
    pub fn between(u0: &NodalLanes<N>, u1: &NodalLanes<N>) -> Self {
        let (mut mid, mut half) = ([[Lanes::ZERO; N]; 2], [[Lanes::ZERO; N]; 2]);
        for i in 0..2 {
            for a in 0..N {
                mid[i][a] = (u1[i][a] + u0[i][a]) * 0.5;
                half[i][a] = (u1[i][a] - u0[i][a]) * 0.5;
            }
        }
        Self::Between(mid, half)
    }
}

impl<const N: usize, const P: usize> ElementBlock<N, P> {
    /// A block of elements with the given nodes and maps.
    pub fn new(nodes: [[u16; N]; LANES], maps: &[[Jacobian; P]; LANES]) -> Self {
        let of = |p: usize, value: &dyn Fn(&Jacobian) -> f64| {
            Lanes(from_fn(|lane| value(&maps[lane][p])))
        };
        ElementBlock {
            nodes: from_fn(|a| from_fn(|lane| nodes[lane][a])),
            inverse: from_fn(|p| from_fn(|i| from_fn(|j| of(p, &|at| at.inverse[(i, j)])))),
            volume: from_fn(|p| of(p, &|at| at.volume)),
        }
    }
}

impl<const N: usize, const P: usize, R> MovedBlock<'_, N, P, R> {
    /// Displacement gradient H = du/dr J^-1 at a point, eq. (2.1), from displacements of the nodes.
    #[inline(always)]
    pub fn gradient<S: IntegratedShape<N, P>, const HOOP: bool>(
        &self,
        p: usize,
        u: &NodalLanes<N>,
    ) -> Gradient {
        let [r, s] = &self.block.inverse[p];
        let row = |[dr, ds]: [Lanes; 2]| [dr * r[0] + ds * s[0], dr * r[1] + ds * s[1]];
        Gradient {
            h: [row(S::derivative(p, &u[0])), row(S::derivative(p, &u[1]))],
            around: match HOOP {
                true => S::value(p, &u[0]) * self.over_radius[p],
                false => Lanes::ZERO,
            },
        }
    }

    /// Deformation at a point; the determinant det F is entered in `positive`.
    #[inline(always)]
    pub fn deformation<S: IntegratedShape<N, P>, const HOOP: bool>(
        &self,
        p: usize,
        positive: &mut Positive,
    ) -> Deformation {
        let gradient = |u| self.gradient::<S, HOOP>(p, u);
        match &self.motion {
            BlockMotion::At(u) => Deformation::at::<HOOP>(gradient(u), positive),
            BlockMotion::Between(mid, half) => {
                Deformation::between::<HOOP>(gradient(mid), &gradient(half), positive)
            }
        }
    }

    /// Row h_a/R of the nodes at a point.
    #[inline(always)]
    pub fn hoop_row<S: IntegratedShape<N, P>>(&self, p: usize) -> [Lanes; N] {
        from_fn(|a| self.over_radius[p] * S::FUNCTIONS.values[p][a])
    }

    /// Forces sum_p B_L^T S for stresses that were multiplied by their weights and stored in displacement gradients
    /// (force).
    #[inline(always)]
    pub fn nodal_forces<'a, S: IntegratedShape<N, P>, const HOOP: bool>(
        &self,
        gradient_and_stress: impl Fn(usize) -> (&'a Gradient, SymmetricLanes),
    ) -> NodalLanes<N> {
        let mut forces = PointForces::<P>::default();
        for p in 0..P {
            let (gradient, s) = gradient_and_stress(p);
            forces.take::<N, HOOP, R>(self, p, gradient, &s);
        }
        forces.sum::<S, N, HOOP>()
    }

    /// Smallest determinant det F at the points, in the mid configuration and at the end; NaN if one determinant is
    /// NaN.
    pub fn least_determinant<S: IntegratedShape<N, P>, const HOOP: bool>(&self) -> [f64; LANES] {
        let mut least = [f64::INFINITY; LANES];
        let mut take_in = |gradient: &Gradient| {
            let (section, stretch) = (determinant(&gradient.h), gradient.stretch_around());
            for (lane, least) in least.iter_mut().enumerate() {
                let of_section = section.0[lane];
                *least = smaller(*least, of_section);
                if HOOP {
                    *least = smaller(*least, of_section * stretch.0[lane]);
                }
            }
        };
        for p in 0..P {
            let gradient = |u| self.gradient::<S, HOOP>(p, u);
            match &self.motion {
                BlockMotion::At(u) => take_in(&gradient(u)),
                BlockMotion::Between(mid, half) => {
                    let mid = gradient(mid);
                    take_in(&mid);
                    take_in(&mid.plus(&gradient(half)));
                }
            }
        }
        least
    }
}

/// Stresses at the points, in the form from which forces are computed.
pub struct PointForces<const P: usize> {
    /// The product F S J^-T times the weight of the point, row by row.
    q: [[[Lanes; 2]; P]; 2],
    /// The value (1 + h) S_33/R times the weight of the point, which only bodies of revolution use.
    hoop: [Lanes; P],
}

impl<const P: usize> Default for PointForces<P> {
    #[inline(always)]
    fn default() -> Self {
        PointForces {
            q: [[[Lanes::ZERO; 2]; P]; 2],
            hoop: [Lanes::ZERO; P],
        }
    }
}

impl<const P: usize> PointForces<P> {
    /// Stores the stress of a point, multiplied by its weight, in a displacement gradient.
    #[inline(always)]
    pub fn take<const N: usize, const HOOP: bool, R>(
        &mut self,
        at: &MovedBlock<N, P, R>,
        p: usize,
        gradient: &Gradient,
        s: &SymmetricLanes,
    ) {
        // B_L^T S of node a is F S dh_a/dX = (F S J^-T) dh_a/dr, J = dX/dr
        let piola = times_symmetric(&deformation_gradient(&gradient.h), s);
        [self.q[0][p], self.q[1][p]] = times_transposed(&piola, &at.block.inverse[p]);
        if HOOP {
            self.hoop[p] = gradient.stretch_around() * s.z * at.over_radius[p];
        }
    }

    /// Forces sum_p B_L^T S (force); in a body of revolution (1 + h) S_33 h_a/R is added along the radius, eq. (2.33).
    #[inline(always)]
    pub fn sum<S: IntegratedShape<N, P>, const N: usize, const HOOP: bool>(&self) -> NodalLanes<N> {
        let mut force = [S::nodal_sums(&self.q[0]), S::nodal_sums(&self.q[1])];
        if HOOP {
            for p in 0..P {
                for a in 0..N {
                    force[0][a] += self.hoop[p] * S::FUNCTIONS.values[p][a];
                }
            }
        }
        force
    }
}

/// Sum of N terms, of nodes, points or components.
#[inline(always)]
pub fn sum<const N: usize>(of: impl Fn(usize) -> Lanes) -> Lanes {
    let mut sum = Lanes::ZERO;
    for k in 0..N {
        sum += of(k);
    }
    sum
}

/// a.b
#[inline(always)]
pub fn dot<const M: usize>(a: &[Lanes; M], b: &[Lanes; M]) -> Lanes {
    sum::<M>(|k| a[k] * b[k])
}

/// The smaller of two values; NaN if one value is NaN.
pub fn smaller(a: f64, b: f64) -> f64 {
    if a < b || a.is_nan() { a } else { b }
}

impl Deformation {
    /// The deformation of one configuration.
    #[inline(always)]
    pub fn at<const HOOP: bool>(gradient: Gradient, positive: &mut Positive) -> Self {
        *positive = gradient.is_positive::<HOOP>(*positive);
        Deformation {
            gradient,
            strains: Strains::At(gradient.strain::<HOOP>()),
        }
    }

    /// The deformation between two configurations, from the displacement gradient H of the mid configuration and half
    /// the change of H.
    #[inline(always)]
    pub fn between<const HOOP: bool>(
        mid: Gradient,
        half: &Gradient,
        positive: &mut Positive,
    ) -> Self {
        *positive = mid.is_positive::<HOOP>(*positive);
        *positive = mid.plus(half).is_positive::<HOOP>(*positive);
        Deformation {
            gradient: mid,
            strains: Strains::Between(mid.strain_change::<HOOP>(half)),
        }
    }
}

impl Gradient {
    /// Sum of two displacement gradients.
    #[inline(always)]
    pub fn plus(&self, other: &Gradient) -> Gradient {
        Gradient {
            h: plus(&self.h, &other.h),
            around: self.around + other.around,
        }
    }

    /// Stretch 1 + h around the axis.
    #[inline(always)]
    pub fn stretch_around(&self) -> Lanes {
        self.around + 1.0
    }

    /// Green-Lagrange strain E = (H + H^T + H^T H)/2 and E_33 = h + h²/2, eq. (2.2) and eq. (2.31).
    #[inline(always)]
    pub fn strain<const HOOP: bool>(&self) -> SymmetricLanes {
        let e = green_lagrange(&self.h);
        match HOOP {
            true => SymmetricLanes {
                z: self.around + self.around * self.around * 0.5,
                ..e
            },
            false => e,
        }
    }

    /// Means and half differences of the strains of F - G and F + G, where G is half the change of
    /// F.
    #[inline(always)]
    pub fn strain_change<const HOOP: bool>(&self, direction: &Gradient) -> StrainChange<Lanes> {
        let (mean, half) = strain_change(&self.h, &direction.h);
        if !HOOP {
            return StrainChange::about(mean, half);
        }
        let (h, g) = (self.around, direction.around);
        StrainChange::about(
            SymmetricLanes {
                z: h + (h * h + g * g) * 0.5,
                ..mean
            },
            SymmetricLanes {
                z: self.stretch_around() * g,
                ..half
            },
        )
    }

    /// Enters det F, and in bodies of revolution also the stretch around the axis.
    #[inline(always)]
    pub fn is_positive<const HOOP: bool>(&self, others: Positive) -> Positive {
        let with_section = others.and(determinant(&self.h));
        match HOOP {
            true => with_section.and(self.stretch_around()),
            false => with_section,
        }
    }
}

/// Deformation gradient F = I + H.
#[inline(always)]
pub fn deformation_gradient([[xx, xy], [yx, yy]]: &TensorLanes) -> TensorLanes {
    [[*xx + 1.0, *xy], [*yx, *yy + 1.0]]
}

/// Determinant det F = det(I + H).
#[inline(always)]
pub fn determinant(h: &TensorLanes) -> Lanes {
    let [[xx, xy], [yx, yy]] = deformation_gradient(h);
    xx * yy - xy * yx
}

/// Green-Lagrange strain E = (H + H^T + H^T H)/2, eq. (2.2).
#[inline(always)]
pub fn green_lagrange(h: &TensorLanes) -> SymmetricLanes {
    let [xx, yy, xy] = half_of_square(h);
    let shear = (h[0][1] + h[1][0]) * 0.5 + xy;
    in_plane([h[0][0] + xx, h[1][1] + yy, shear])
}

/// Mean (E0 + E1)/2 and half difference (E1 - E0)/2 of the strains of F0 = F - G and F1 = F + G with F = I + H: E0 + E1
/// = 2 E(H) + G^T G, E1 - E0 = 2 (F^T G + G^T F).
#[inline(always)]
fn strain_change(h: &TensorLanes, g: &TensorLanes) -> (SymmetricLanes, SymmetricLanes) {
    let (e, square, f) = (
        green_lagrange(h),
        half_of_square(g),
        deformation_gradient(h),
    );
    let product = |i: usize, j: usize| f[0][i] * g[0][j] + f[1][i] * g[1][j];
    (
        in_plane([e.x + square[0], e.y + square[1], e.w + square[2]]),
        in_plane([
            product(0, 0),
            product(1, 1),
            (product(0, 1) + product(1, 0)) * 0.5,
        ]),
    )
}

/// A symmetric tensor with the components 11, 22 and 12.
#[inline(always)]
pub fn in_plane([x, y, w]: [Lanes; 3]) -> SymmetricLanes {
    SymmetricLanes::new(x, y, Lanes::ZERO, w)
}

/// The tensor A^T A/2, as components 11, 22 and 12.
#[inline(always)]
fn half_of_square(a: &TensorLanes) -> [Lanes; 3] {
    let product = |i: usize, j: usize| (a[0][i] * a[0][j] + a[1][i] * a[1][j]) * 0.5;
    [product(0, 0), product(1, 1), product(0, 1)]
}

/// The sum A + B.
#[inline(always)]
pub fn plus(a: &TensorLanes, b: &TensorLanes) -> TensorLanes {
    [
        [a[0][0] + b[0][0], a[0][1] + b[0][1]],
        [a[1][0] + b[1][0], a[1][1] + b[1][1]],
    ]
}

/// The product A S with a symmetric S.
#[inline(always)]
pub fn times_symmetric(a: &TensorLanes, s: &SymmetricLanes) -> TensorLanes {
    let row = |[x, y]: [Lanes; 2]| [x * s.x + y * s.w, x * s.w + y * s.y];
    [row(a[0]), row(a[1])]
}

/// A B^T.
#[inline(always)]
pub fn times_transposed(a: &TensorLanes, b: &TensorLanes) -> TensorLanes {
    let row = |[x, y]: [Lanes; 2]| [x * b[0][0] + y * b[0][1], x * b[1][0] + y * b[1][1]];
    [row(a[0]), row(a[1])]
}

/// Matrix between the nodes: entry [a][b] is the 2 x 2 block of the directions of a and b.
pub type MatrixLanes<const N: usize> = [[TensorLanes; N]; N];

/// Adds the part of the strain around the axis to the tangent of a point, for a <= b. The row of B_L for the strain
/// around the axis is b_a = (1 + h) h_a/R, which acts on displacements along the radius. The array `c` holds the moduli
/// between component 33 and each component of the strain,
///
/// ```text
/// b_a C_33,. B_b + its transpose + b_a b_b C_3333 + S_33 h_a h_b/R²
/// ```
#[inline(always)]
pub fn add_hoop<const N: usize>(
    k: &mut MatrixLanes<N>,
    (gradients, rows): (&[[Lanes; 2]; N], &[Lanes; N]),
    (f, stretch): (&TensorLanes, Lanes),
    (s, c): (Lanes, &[Lanes; 4]),
) {
    // (1 + h) times the change of S_33 with the strains in the section of a displacement j of node b
    let mut of_section = [[Lanes::ZERO; 2]; N];
    for (of_section, [x, y]) in of_section.iter_mut().zip(gradients) {
        for j in 0..2 {
            let shear = f[j][0] * *y + f[j][1] * *x;
            let change = c[0] * (f[j][0] * *x) + c[1] * (f[j][1] * *y) + c[3] * shear;
            of_section[j] = stretch * change;
        }
    }
    let both = stretch * stretch * c[2] + s;
    for second in 0..N {
        for first in 0..second + 1 {
            let block = &mut k[first][second];
            block[0][0] += rows[first] * rows[second] * both;
            for j in 0..2 {
                block[0][j] += rows[first] * of_section[second][j];
                block[j][0] += rows[second] * of_section[first][j];
            }
        }
    }
}

impl<const N: usize, const P: usize> ElementBlock<N, P> {
    /// Gradients dh_a/dX = dh_a/dr J^-1 of the nodes at a point.
    #[inline(always)]
    pub fn gradients<S: IntegratedShape<N, P>>(&self, p: usize) -> [[Lanes; 2]; N] {
        let [r, s] = &self.inverse[p];
        let mut gradients = [[Lanes::ZERO; 2]; N];
        for (gradient, &[hr, hs]) in gradients.iter_mut().zip(&S::FUNCTIONS.natural[p]) {
            *gradient = [r[0] * hr + s[0] * hs, r[1] * hr + s[1] * hs];
        }
        gradients
    }
}

/// Elasticity A = dP/dF of the first Piola-Kirchhoff stress P = F S.
///
/// Its components are A_iIjJ = F_iK C_KILJ F_jL + delta_ij S_IJ, in the entries [i][2 j + J][I].
pub type Elasticity = [[[Lanes; 2]; 4]; 2];

/// Elasticity A for a deformation gradient, a stress and its tangent in Voigt order.
#[inline(always)]
pub fn elasticity(f: &TensorLanes, s: &SymmetricLanes, c: &TangentLanes) -> Elasticity {
    let mut a = [[[Lanes::ZERO; 2]; 4]; 2];
    for j in 0..2 {
        let [x, y] = f[j];
        // dE in Voigt order is (F_jX, 0, F_jY) for dF_jX, (0, F_jY, F_jX) for dF_jY
        for k in 0..2 {
            let along = [x, y][k];
            let across = [y, x][k];
            let ds = |i: usize| c.0[i][k] * along + c.0[i][3] * across;
            let ds = in_plane([ds(0), ds(1), ds(3)]);
            for i in 0..2 {
                a[i][2 * j + k] = times(&ds, &f[i]);
            }
        }
    }
    for i in 0..2 {
        let geometric = [[s.x, s.w], [s.w, s.y]];
        for k in 0..2 {
            a[i][2 * i + k][0] += geometric[k][0];
            a[i][2 * i + k][1] += geometric[k][1];
        }
    }
    a
}

/// The product S v with a symmetric S.
#[inline(always)]
fn times(s: &SymmetricLanes, &[x, y]: &[Lanes; 2]) -> [Lanes; 2] {
    [s.x * x + s.w * y, s.w * x + s.y * y]
}

/// Adds the products g_a A g_b of the gradients for a <= b.
#[inline(always)]
pub fn add_products<const N: usize>(k: &mut MatrixLanes<N>, g: &[[Lanes; 2]; N], a: &Elasticity) {
    for second in 0..N {
        let [x, y] = g[second];
        for i in 0..2 {
            for j in 0..2 {
                let [ax, ay] = [a[i][2 * j], a[i][2 * j + 1]];
                let stress = [ax[0] * x + ay[0] * y, ax[1] * x + ay[1] * y];
                for first in 0..second + 1 {
                    k[first][second][i][j] += g[first][0] * stress[0] + g[first][1] * stress[1];
                }
            }
        }
    }
}
