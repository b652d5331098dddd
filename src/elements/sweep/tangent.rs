//! Tangent of a block of elements. Section 2 of docs/theory.md.

use super::block::{
    Block, BlockMotion, Deformation, TensorLanes, deformation_gradient, green_lagrange, scaled,
};
use super::shape::Shape;
use crate::materials::lanes::{Lanes, Positive, SymmetricLanes};
use crate::materials::{LawInLanes, TangentLanes};

/// Matrix between the nodes: entry [a][b] is the 2 x 2 block of the directions of a and b.
pub type MatrixLanes<const N: usize> = [[TensorLanes; N]; N];

impl Deformation {
    /// Tangent of [`Self::stress`] in Voigt order.
    #[inline(always)]
    fn tangent(&self, law: &impl LawInLanes) -> TangentLanes {
        match self {
            Self::At(h) => law.tangent(&green_lagrange(h)),
            Self::Between(_, change) => law.mean_tangent(change),
        }
    }
}

impl<const N: usize, const P: usize> Block<N, P> {
    /// Adds K = int B_L^T C B_L + B_NL^T S B_NL dOmega, eq. (2.6) (force/length), in the energy-momentum form
    /// with B_L of the mid configuration, symmetric: entries [a][b] with a <= b.
    ///
    /// With A = dP/dF, the derivative of the first Piola-Kirchhoff stress, K_ab = dh_a/dX . A . dh_b/dX.
    #[inline(always)]
    pub fn add_tangent<S: Shape<N, P>>(
        &self,
        law: &impl LawInLanes,
        motion: &BlockMotion<N>,
        k: &mut MatrixLanes<N>,
    ) {
        let u = motion.derivatives::<S, P>();
        for p in 0..P {
            let deformation = self.deformation(p, &u, &mut Positive::default());
            let s = scaled(&deformation.stress(law), self.volume[p]);
            let c = deformation.tangent(law);
            let c = [
                scaled(&c[0], self.volume[p]),
                scaled(&c[1], self.volume[p]),
                scaled(&c[2], self.volume[p]),
            ];
            let a = elasticity(&deformation_gradient(deformation.h()), &s, &c);
            add_products(k, &self.gradients::<S>(p), &a);
        }
    }

    /// Gradients dh_a/dX = dh_a/dr J^-1 of the nodes at a point.
    #[inline(always)]
    fn gradients<S: Shape<N, P>>(&self, p: usize) -> [[Lanes; 2]; N] {
        let [r, s] = &self.inverse[p];
        let mut gradients = [[Lanes::ZERO; 2]; N];
        for (gradient, &[hr, hs]) in gradients.iter_mut().zip(&S::FUNCTIONS.natural[p]) {
            *gradient = [r[0] * hr + s[0] * hs, r[1] * hr + s[1] * hs];
        }
        gradients
    }
}

/// Elasticity A = dP/dF, P = F S, of the first Piola-Kirchhoff stress.
///
/// A_iIjJ = F_iK C_KILJ F_jL + delta_ij S_IJ; entry [2 j + J] of the stress of row i, [I].
type Elasticity = [[[Lanes; 2]; 4]; 2];

/// A of a deformation gradient, a stress and its tangent in Voigt order.
#[inline(always)]
fn elasticity(f: &TensorLanes, s: &SymmetricLanes, c: &TangentLanes) -> Elasticity {
    let mut a = [[[Lanes::ZERO; 2]; 4]; 2];
    for j in 0..2 {
        let [x, y] = f[j];
        // dE in Voigt order is (F_jX, 0, F_jY) for dF_jX, (0, F_jY, F_jX) for dF_jY
        for k in 0..2 {
            let along = [x, y][k];
            let across = [y, x][k];
            let ds = |i: usize| c[i][k] * along + c[i][2] * across;
            let ds = [ds(0), ds(1), ds(2)];
            for i in 0..2 {
                a[i][2 * j + k] = times(&ds, &f[i]);
            }
        }
    }
    let [xx, yy, xy] = *s;
    for i in 0..2 {
        let geometric = [[xx, xy], [xy, yy]];
        for k in 0..2 {
            a[i][2 * i + k][0] += geometric[k][0];
            a[i][2 * i + k][1] += geometric[k][1];
        }
    }
    a
}

/// S v with a symmetric S.
#[inline(always)]
fn times(&[xx, yy, xy]: &SymmetricLanes, &[x, y]: &[Lanes; 2]) -> [Lanes; 2] {
    [xx * x + xy * y, xy * x + yy * y]
}

/// Adds g_a . A . g_b for a <= b.
#[inline(always)]
fn add_products<const N: usize>(k: &mut MatrixLanes<N>, g: &[[Lanes; 2]; N], a: &Elasticity) {
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
