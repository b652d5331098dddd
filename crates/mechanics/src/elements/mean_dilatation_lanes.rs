//! The mean dilatation formulation ([`MeanDilatation`]) for elements side by side. Section 2 of docs/theory.md;
//! docs/numerics.md, Sweeps over elements.

// Loops over points, nodes and directions: indices are those of the formulas.
#![allow(clippy::needless_range_loop)]

use std::array::from_fn;

use super::block::{
    BlockFormulation, BlockMotion, Derivatives, ElementBlock, IntegratedShape, MatrixLanes,
    NodalLanes, PlacedBlock, ResultPoint, Sums, SymmetricLanes, TangentLanes, TensorLanes,
    add_products, deformation_gradient, determinant, elasticity, green_lagrange, in_plane, plus,
};
use super::formulation::ElementResult;
use super::mean_dilatation::MeanDilatation;
use crate::materials::number::{LANES, Positive};
use crate::materials::{Lanes, Number, StrainChange, Strains, StressAtPoints};

/// An integration point with mean quantities of the motion. Start and end are the same at one configuration.
#[derive(Clone, Copy, Default)]
struct PointLanes {
    /// Displacement gradient of the mid configuration.
    h: TensorLanes,
    /// Green-Lagrange strains of the displacements at start and end, and then those that the material has.
    strains: [SymmetricLanes; 2],
    /// J - 1 at start and end.
    dilatation: [Lanes; 2],
    /// C_m/2: half the mean of the right Cauchy-Green tensors.
    half_c: SymmetricLanes,
    /// K = det F_m (F_m^T F_m)^-1, so that J1 - J0 = K : (E1 - E0).
    k: SymmetricLanes,
    /// Stress that does work on the strain that the material has.
    s: SymmetricLanes,
    /// Mean of theta/J.
    ratio: Lanes,
    /// Mean of J, over J0 J1.
    inverse_j: Lanes,
    /// Mean of theta, over J0 J1.
    theta_over_jj: Lanes,
    /// A - a theta_m: factor of K in the stress that does work on the strain of the displacements.
    pressure: Lanes,
}

impl PointLanes {
    /// The motion of a point with H of the mid configuration and half its change.
    #[inline(always)]
    fn new(h: TensorLanes, half: &TensorLanes) -> Self {
        let ends = [
            plus(&h, &half.map(|row| row.map(|g| g * -1.0))),
            plus(&h, half),
        ];
        let strains = ends.map(|h| green_lagrange(&h));
        let [[xx, xy], [yx, yy]] = deformation_gradient(&h);
        let over_j = Lanes::all(1.0) / determinant(&h);
        let mean = strains[0].with(&strains[1], |e0, e1| (e0 + e1) * 0.5);
        PointLanes {
            h,
            strains,
            dilatation: ends.map(|[[xx, xy], [yx, yy]]| xx + yy + (xx * yy - xy * yx)),
            half_c: in_plane([mean.x + 0.5, mean.y + 0.5, mean.w]),
            k: in_plane([
                (xy * xy + yy * yy) * over_j,
                (xx * xx + yx * yx) * over_j,
                (xx * xy + yx * yy) * over_j * -1.0,
            ]),
            ..PointLanes::default()
        }
    }

    /// Takes the strain that the material has, Ebar = r E + (r - 1)/2 I, eq. (2.10), and the means, with theta - 1 of
    /// start and end.
    #[inline(always)]
    fn take_volume(&mut self, theta: [Lanes; 2]) {
        let [j0, j1] = self.dilatation.map(|j| j + 1.0);
        let inverse = Lanes::all(1.0) / (j0 * j1);
        let excess: [Lanes; 2] =
            from_fn(|i| (theta[i] - self.dilatation[i]) * [j1, j0][i] * inverse);
        for (e, excess) in self.strains.iter_mut().zip(excess) {
            *e = in_plane([
                e.x + (e.x + 0.5) * excess,
                e.y + (e.y + 0.5) * excess,
                e.w + e.w * excess,
            ]);
        }
        self.ratio = (excess[0] + excess[1]) * 0.5 + 1.0;
        self.inverse_j = (j0 + j1) * 0.5 * inverse;
        self.theta_over_jj = ((theta[0] + theta[1]) * 0.5 + 1.0) * inverse;
    }

    /// Strains at which the material is evaluated.
    #[inline(always)]
    fn strains_in<const N: usize>(&self, motion: &BlockMotion<N>) -> Strains<Lanes> {
        let [e0, e1] = &self.strains;
        match motion {
            BlockMotion::At(_) => Strains::At(*e1),
            BlockMotion::Between(..) => Strains::Between(StrainChange::between(e0, e1)),
        }
    }

    /// S : C_m/2, the mean Kirchhoff stress of the material in the plane over theta/J.
    #[inline(always)]
    fn kirchhoff(&self) -> Lanes {
        self.s.contract::<false>(&self.half_c)
    }

    /// Stress that does work on the strain of the displacements, eq. (2.11).
    #[inline(always)]
    fn effective(&self) -> SymmetricLanes {
        (self.s).with(&self.k, |s, k| s * self.ratio + k * self.pressure)
    }
}

/// Motion and stresses of all points, and their weights over the volume of the element; `positive` takes in det F.
#[inline(always)]
fn stresses<S: IntegratedShape<N, P>, const N: usize, const P: usize>(
    block: &ElementBlock<N, P>,
    law: &impl StressAtPoints<Lanes, false>,
    motion: &BlockMotion<N>,
    positive: &mut Positive,
) -> ([PointLanes; P], [Lanes; P]) {
    let mut points = [PointLanes::default(); P];
    let mut weights = block.volume;
    let volume = weights.iter().fold(Lanes::ZERO, |sum, v| sum + *v);
    let over_volume = volume.inverse();
    let mut theta = [Lanes::ZERO; 2];
    let u = motion.derivatives::<S, P, false>();
    for p in 0..P {
        points[p] = match &u {
            Derivatives::At(u) => PointLanes::new(block.gradient(p, u), &Default::default()),
            Derivatives::Between(mid, half) => {
                PointLanes::new(block.gradient(p, mid), &block.gradient(p, half))
            }
        };
        let dilatation = points[p].dilatation;
        *positive = positive
            .and(determinant(&points[p].h))
            .and(dilatation[1] + 1.0);
        weights[p] = weights[p] * over_volume;
        // theta - 1 = int (J - 1) dOmega / V
        for (theta, j) in theta.iter_mut().zip(dilatation) {
            *theta += j * weights[p];
        }
    }
    // a = S : C_m/2 / (J0 J1),  A = int a J_m dOmega / V
    let mut shared = Lanes::ZERO;
    for (p, (point, weight)) in points.iter_mut().zip(weights).enumerate() {
        point.take_volume(theta);
        point.s = law.stress_at(p, &point.strains_in(motion));
        shared += point.kirchhoff() * point.inverse_j * weight;
    }
    for point in &mut points {
        point.pressure = shared - point.kirchhoff() * point.theta_over_jj;
    }
    (points, weights)
}

impl BlockFormulation<false> for MeanDilatation {
    #[inline(always)]
    fn force<S: IntegratedShape<N, P>, const N: usize, const P: usize>(
        placed: &PlacedBlock<N, P>,
        law: &impl StressAtPoints<Lanes, false>,
        motion: &BlockMotion<N>,
    ) -> (NodalLanes<N>, Positive) {
        let mut positive = Positive::default();
        let (points, _) = stresses::<S, N, P>(placed.block, law, motion, &mut positive);
        let force = placed.block.nodal_forces::<S>(|p| {
            let s = points[p].effective().times(placed.block.volume[p]);
            (points[p].h, s)
        });
        (force, positive)
    }

    /// Second derivative of the stored energy, eq. (2.12), sorted by B_L and Dtheta = int B_L^T K dOmega/V. With
    /// alpha = J_m/(J0 J1), beta = theta_m/(J0 J1), h = C_m/2, y = C:h and kappa = h:C:h of a point,
    ///
    /// ```text
    /// z = r y + S - (S:h) alpha K - beta kappa K/2
    /// K = int B_L^T (r² C - beta (z K + K z)) B_L + B_NL^T r S B_NL + p D2J dOmega + X Dtheta^T + Dtheta X^T
    /// X = int alpha B_L^T (z - beta kappa K/2) + alpha² kappa/2 Dtheta dOmega
    /// ```
    #[inline(always)]
    fn add_tangent<S: IntegratedShape<N, P>, const N: usize, const P: usize>(
        placed: &PlacedBlock<N, P>,
        law: &impl StressAtPoints<Lanes, false>,
        motion: &BlockMotion<N>,
        k: &mut MatrixLanes<N>,
    ) {
        let (points, weights) =
            stresses::<S, N, P>(placed.block, law, motion, &mut Positive::default());
        let mut mixed = [SymmetricLanes::default(); P];
        let mut of_square = Lanes::ZERO;
        for p in 0..P {
            let (point, volume) = (&points[p], placed.block.volume[p]);
            let (r, alpha, beta) = (point.ratio, point.inverse_j, point.theta_over_jj);
            let c = law.tangent_at(p, &point.strains_in(motion));
            let y = c.times::<false>(&point.half_c);
            let kappa = y.contract::<false>(&point.half_c);
            let half = beta * kappa * 0.5;
            let of_k = point.kirchhoff() * alpha + half;
            let z = y.map(|y| r * y) + point.s - point.k.times(of_k);
            mixed[p] = z.with(&point.k, |z, k| (z - half * k) * alpha * volume);
            of_square += alpha * alpha * kappa * volume;
            let (of_c, of_z) = (r * r * volume, beta * volume);
            let (z, of_volume) = (z.components(), point.k.components());
            let c = TangentLanes::of(|i, j| {
                let both = z[i] * of_volume[j] + of_volume[i] * z[j];
                c.0[i][j] * of_c - both * of_z
            });
            let s = point.s.times(r * volume);
            let mut a = elasticity(&deformation_gradient(&point.h), &s, &c);
            // J = F_xx F_yy - F_xy F_yx
            let pressure = point.pressure * volume;
            a[0][3][0] += pressure;
            a[1][0][1] += pressure;
            a[0][2][1] = a[0][2][1] - pressure;
            a[1][1][0] = a[1][1][0] - pressure;
            add_products(k, &placed.block.gradients::<S>(p), &a);
        }
        let theta = placed
            .block
            .nodal_forces::<S>(|p| (points[p].h, points[p].k.times(weights[p])));
        let mut x = placed.block.nodal_forces::<S>(|p| (points[p].h, mixed[p]));
        for i in 0..2 {
            for a in 0..N {
                x[i][a] += theta[i][a] * of_square * 0.5;
            }
        }
        for b in 0..N {
            for a in 0..b + 1 {
                for i in 0..2 {
                    for j in 0..2 {
                        k[a][b][i][j] += x[i][a] * theta[j][b] + theta[i][a] * x[j][b];
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn evaluate<S: IntegratedShape<N, P>, const N: usize, const P: usize>(
        placed: &PlacedBlock<N, P>,
        law: &impl StressAtPoints<Lanes, false>,
        motion: &BlockMotion<N>,
    ) -> [ElementResult; LANES] {
        let (points, weights) =
            stresses::<S, N, P>(placed.block, law, motion, &mut Positive::default());
        let mut theta = Lanes::all(1.0);
        for p in 0..P {
            theta += points[p].dilatation[1] * weights[p];
        }
        let mut sums = Sums::new();
        for p in 0..P {
            let point = ResultPoint {
                h: points[p].h,
                strain: points[p].strains[1],
                determinant: theta,
                s: points[p].effective(),
                around: Lanes::ZERO,
            };
            sums.add(p, law, &point, placed.block.volume[p]);
        }
        sums.results()
    }
}
