//! Formulations with volume ratios of the element in place of the volume ratios of its points (CPE4H, CAX4H, CPE8H,
//! CPE8RH, CAX8H, CAX8RH; Simo, Taylor & Pister 1985), for nearly incompressible materials. The stored energy is the
//! energy of the modified deformation gradient, eq. (2.9):
//!
//! ```text
//! Fbar = (theta/J)^(1/n) F,  det Fbar = theta
//! ```
//!
//! Here the volume ratio theta is the mean of J over the element, or linear in the element. See
//! docs/theory/elements.md. Without strain across the plane n is 2, since F_zz stays 1 and the material keeps its plane
//! strain law (de Souza Neto et al. 1996); with all components of the strain n is 3.
//!
//! # Derivation
//!
//! The volume ratio is theta = sum psi_k int psi_k J dOmega/V, with orthogonal functions psi_k whose squares have the
//! volume V of the element as integral. The strain of the material is Ebar = r E + (r - 1)/2 I, with r = rho^(2/n) and
//! rho = theta/J. The changes of the products in Ebar between two configurations are exact with mean quantities:
//!
//! ```text
//! dEbar = r_m dE + C_m/2 dr,  dr = g drho,  drho = (J_m dtheta - theta_m dJ)/(J0 J1),  dJ = K : dE
//! g = 1 with n = 2,  g = (c0 + c1)/(c0² + c0 c1 + c1²), c = rho^(1/3), with n = 3
//! ```
//!
//! With S : dEbar = W1 - W0 at every point, the work of the internal force is therefore the change of the stored energy
//! of the element.

// Loops over points, nodes and directions: indices are those of the formulas.
#![allow(clippy::needless_range_loop)]

use std::array::from_fn;

use super::block::{
    BlockMotion, Gradient, MatrixLanes, MovedBlock, SymmetricLanes, TangentLanes, TensorLanes,
    add_hoop, add_products, deformation_gradient, determinant, elasticity,
};
use super::formulation::{Formulation, PlacedBlock, PointState};
use super::results::ResultPoint;
use super::shapes::IntegratedShape;
use crate::materials::number::Positive;
use crate::materials::{AnyLaw, Lanes, Number, Strains, StressAtPoints};

/// Formulation with a volume ratio of the element at every integration point: a combination of the first K of 1, x and
/// y, made orthogonal.
pub struct Dilatation<const K: usize>;

/// Functions of the volume ratio for the elements of a block.
pub struct VolumeFunctions<const K: usize, const P: usize> {
    /// Functions psi_k at every point; psi_1 is 1.
    values: [[Lanes; K]; P],
    /// Functions psi_k times the weight of the point, divided by the volume of the element.
    weighted: [[Lanes; K]; P],
}

/// An integration point with mean quantities of a motion. If there is only one configuration, start and end are the
/// same.
#[derive(Clone, Copy, Default)]
struct DilatedPoint {
    /// Displacement gradient of the mid configuration.
    gradient: Gradient,
    /// Green-Lagrange strains of the displacements at start and end; after [`Self::take_volume`] the strains of the
    /// material.
    strains: [SymmetricLanes; 2],
    /// Change of volume J - 1 at start and end.
    dilatation: [Lanes; 2],
    /// Volume ratio theta at the end.
    theta: Lanes,
    /// Tensor C_m/2: half the mean of the right Cauchy-Green tensors at start and end.
    half_c: SymmetricLanes,
    /// Tensor K, which satisfies J1 - J0 = K : (E1 - E0), eq. (2.46).
    k: SymmetricLanes,
    /// Stress that does work on the strain of the material.
    s: SymmetricLanes,
    /// Mean of the factor r at start and end.
    ratio: Lanes,
    /// The factor g, and the second derivative of r with respect to rho.
    slopes: [Lanes; 2],
    /// Mean of J at start and end, divided by J0 J1.
    inverse_j: Lanes,
    /// Mean of theta at start and end, divided by J0 J1.
    theta_over_jj: Lanes,
    /// Factor A - a theta_m of K in the stress that does work on the strain of the displacements.
    pressure: Lanes,
}

impl<const K: usize, const P: usize> VolumeFunctions<K, P> {
    /// Functions for elements with points at the given places, by Gram-Schmidt orthogonalisation of 1, x and y about
    /// the centre.
    fn new(weights: &[Lanes; P], places: &[[Lanes; 2]; P]) -> Self {
        let volume = weights.iter().fold(Lanes::ZERO, |sum, v| sum + *v);
        let over_volume = volume.inverse();
        let mean = |of: &dyn Fn(usize) -> Lanes| {
            let sum = (0..P).fold(Lanes::ZERO, |sum, p| sum + weights[p] * of(p));
            sum * over_volume
        };
        let centre: [Lanes; 2] = from_fn(|i| mean(&|p| places[p][i]));
        let mut values: [[Lanes; K]; P] = from_fn(|p| {
            from_fn(|k| match k {
                0 => Lanes::all(1.0),
                _ => places[p][k - 1] - centre[k - 1],
            })
        });
        for k in 1..K {
            for l in 0..k {
                let part = mean(&|p| values[p][k] * values[p][l]);
                for psi in &mut values {
                    psi[k] = psi[k] - part * psi[l];
                }
            }
            let size = mean(&|p| values[p][k] * values[p][k]).sqrt();
            values.iter_mut().for_each(|psi| psi[k] = psi[k] / size);
        }
        VolumeFunctions {
            weighted: from_fn(|p| from_fn(|k| values[p][k] * (weights[p] * over_volume))),
            values,
        }
    }

    /// The value at a point of the sum of psi_k f_k.
    #[inline(always)]
    fn at(&self, p: usize, of_functions: &[Lanes; K]) -> Lanes {
        let mut sum = of_functions[0];
        for k in 1..K {
            sum += self.values[p][k] * of_functions[k];
        }
        sum
    }
}

impl DilatedPoint {
    /// Sets the strains of the motion from the displacement gradient H of the mid configuration and half the change of
    /// H.
    #[inline(always)]
    fn take_motion<const HOOP: bool>(&mut self, gradient: Gradient, half: &Gradient) {
        let back = Gradient {
            h: [
                [half.h[0][0] * -1.0, half.h[0][1] * -1.0],
                [half.h[1][0] * -1.0, half.h[1][1] * -1.0],
            ],
            around: half.around * -1.0,
        };
        let ends = [gradient.plus(&back), gradient.plus(half)];
        self.gradient = gradient;
        self.strains = [ends[0].strain::<HOOP>(), ends[1].strain::<HOOP>()];
        let grown = |&[[xx, xy], [yx, yy]]: &TensorLanes| xx + yy + (xx * yy - xy * yx);
        let of_section = [grown(&ends[0].h), grown(&ends[1].h)];
        self.dilatation = of_section;
        let [[xx, xy], [yx, yy]] = deformation_gradient(&gradient.h);
        let over_j = Lanes::all(1.0) / determinant(&gradient.h);
        // K of the section, det F_m (F_m^T F_m)^-1
        self.k = SymmetricLanes::new(
            (xy * xy + yy * yy) * over_j,
            (xx * xx + yx * yx) * over_j,
            Lanes::ZERO,
            (xx * xy + yx * yy) * over_j * -1.0,
        );
        let mean = (self.strains[0]).with(&self.strains[1], |e0, e1| (e0 + e1) * 0.5);
        self.half_c = SymmetricLanes::new(mean.x + 0.5, mean.y + 0.5, Lanes::ZERO, mean.w);
        if HOOP {
            // J = J_section (1 + h): dJ = (1 + h_m) dJ_section + (mean of J_section) dh,  dE_33 = (1 + h_m) dh
            let stretch = gradient.stretch_around();
            let mean_j = (of_section[0] + of_section[1]) * 0.5 + 1.0;
            for i in 0..2 {
                let around = ends[i].around;
                self.dilatation[i] = of_section[i] + around + of_section[i] * around;
            }
            self.half_c.z = mean.z + 0.5;
            self.k = self.k.times(stretch);
            self.k.z = mean_j / stretch;
        }
    }

    /// Sets the strain of the material, eq. (2.10), and the mean quantities of the motion; `theta` holds theta - 1 at
    /// start and end.
    #[inline(always)]
    fn take_volume<const HOOP: bool>(&mut self, theta: [Lanes; 2]) {
        let [j0, j1] = [self.dilatation[0] + 1.0, self.dilatation[1] + 1.0];
        let inverse = Lanes::all(1.0) / (j0 * j1);
        // rho - 1
        let mut excess = [
            (theta[0] - self.dilatation[0]) * j1 * inverse,
            (theta[1] - self.dilatation[1]) * j0 * inverse,
        ];
        self.slopes = [Lanes::all(1.0), Lanes::ZERO];
        if HOOP {
            // c² - 1 = (c - 1)(c + 1) with c - 1 = (rho - 1)/(c² + c + 1)
            let cube_root = |excess: Lanes| {
                let rho = excess + 1.0;
                let inverse = rho.inverse_cbrt();
                rho * (inverse * inverse)
            };
            let c = [cube_root(excess[0]), cube_root(excess[1])];
            for i in 0..2 {
                excess[i] = excess[i] * (c[i] + 1.0) / (c[i] * c[i] + c[i] + 1.0);
            }
            let mean = (c[0] + c[1]) * 0.5;
            self.slopes = [
                (c[0] + c[1]) / (c[0] * c[0] + c[0] * c[1] + c[1] * c[1]),
                Lanes::all(-2.0 / 9.0) / (mean * mean * (mean * mean)),
            ];
        }
        for (e, excess) in self.strains.iter_mut().zip(excess) {
            let grown = |e: Lanes| e + (e + 0.5) * excess;
            *e = SymmetricLanes::new(
                grown(e.x),
                grown(e.y),
                match HOOP {
                    true => grown(e.z),
                    false => Lanes::ZERO,
                },
                e.w + e.w * excess,
            );
        }
        self.theta = theta[1] + 1.0;
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
            BlockMotion::Between(..) => Strains::between(e0, e1),
        }
    }

    /// Derivative g S : C_m/2 of the stored energy with respect to rho.
    #[inline(always)]
    fn by_rho<const HOOP: bool>(&self) -> Lanes {
        let of_c = self.s.contract::<HOOP>(&self.half_c);
        match HOOP {
            true => of_c * self.slopes[0],
            false => of_c,
        }
    }

    /// Stress that does work on the strain of the displacements, eq. (2.11).
    #[inline(always)]
    fn effective(&self) -> SymmetricLanes {
        (self.s).with(&self.k, |s, k| s * self.ratio + k * self.pressure)
    }
}

/// Motion and stresses of all points, with one evaluation of the material at each; the determinant det F is entered in
/// `positive`.
#[inline(always)]
fn stresses<S, const K: usize, const N: usize, const P: usize, const HOOP: bool>(
    at: &MovedBlock<N, P, VolumeFunctions<K, P>>,
    law: &(impl StressAtPoints<Lanes, HOOP> + ?Sized),
    positive: &mut Positive,
) -> [DilatedPoint; P]
where
    S: IntegratedShape<N, P>,
{
    let mut points = [DilatedPoint::default(); P];
    let mut theta = [[Lanes::ZERO; K]; 2];
    let functions = at.reference;
    for p in 0..P {
        let gradient = |u| at.gradient::<S, HOOP>(p, u);
        let point = &mut points[p];
        match &at.motion {
            BlockMotion::At(u) => point.take_motion::<HOOP>(gradient(u), &Gradient::default()),
            BlockMotion::Between(mid, half) => {
                point.take_motion::<HOOP>(gradient(mid), &gradient(half));
            }
        }
        let dilatation = point.dilatation;
        *positive = point.gradient.is_positive::<HOOP>(*positive);
        *positive = positive.and(dilatation[1] + 1.0);
        // theta - 1 = sum psi_k int psi_k (J - 1) dOmega/V, eq. (2.45)
        for (theta, j) in theta.iter_mut().zip(dilatation) {
            for k in 0..K {
                theta[k] += j * functions.weighted[p][k];
            }
        }
    }
    // a = g S : C_m/2 / (J0 J1),  A = sum psi_k int psi_k a J_m dOmega/V
    let mut shared = [Lanes::ZERO; K];
    for p in 0..P {
        let theta = [functions.at(p, &theta[0]), functions.at(p, &theta[1])];
        let point = &mut points[p];
        point.take_volume::<HOOP>(theta);
        if HOOP {
            *positive = positive.and(point.theta);
        }
        point.s = law.stress_at(p, &point.strains_in(&at.motion));
        for k in 0..K {
            shared[k] += point.by_rho::<HOOP>() * point.inverse_j * functions.weighted[p][k];
        }
    }
    for p in 0..P {
        let point = &mut points[p];
        point.pressure = functions.at(p, &shared) - point.by_rho::<HOOP>() * point.theta_over_jj;
    }
    points
}

impl<const K: usize, const N: usize, const P: usize, const HOOP: bool> Formulation<N, P, HOOP>
    for Dilatation<K>
{
    type Reference = VolumeFunctions<K, P>;

    const FOR_EACH_LAW: bool = K == 1 && !HOOP;

    fn reference<S: IntegratedShape<N, P>>(placed: &PlacedBlock<N, P>) -> Self::Reference {
        VolumeFunctions::new(&placed.block.volume, placed.places)
    }

    #[inline(always)]
    fn for_each_state<S: IntegratedShape<N, P>>(
        at: &MovedBlock<N, P, Self::Reference>,
        law: &(impl StressAtPoints<Lanes, HOOP> + ?Sized),
        mut visit: impl FnMut(usize, &PointState),
    ) -> Positive {
        let mut positive = Positive::default();
        let points = stresses::<S, K, N, P, HOOP>(at, law, &mut positive);
        for (p, point) in points.iter().enumerate() {
            let state = PointState {
                gradient: &point.gradient,
                strains: &point.strains_in(&at.motion),
                s: point.effective(),
            };
            visit(p, &state);
        }
        positive
    }

    /// Second derivative of the stored energy, eq. (2.12), in terms of B_L and Dtheta_k = int psi_k B_L^T K dOmega/V;
    /// in the energy-momentum form all quantities are means over the motion. For each point, alpha = J_m/(J0 J1), beta
    /// = theta_m/(J0 J1), h = C_m/2, y = C:h, kappa = g² h:C:h + r'' S:h,
    ///
    /// ```text
    /// z = g (r y + S) - g (S:h) alpha K - beta kappa K/2
    /// K = int B_L^T (r² C - beta (z K + K z)) B_L + B_NL^T r S B_NL + p D2J dOmega + sum X_k Dtheta_k^T + Dtheta_k X_k^T
    /// X_k = int psi_k alpha B_L^T (z - beta kappa K/2) + psi_k alpha² kappa/2 sum psi_l Dtheta_l dOmega
    /// ```
    #[inline(always)]
    fn add_tangent<S: IntegratedShape<N, P>>(
        at: &MovedBlock<N, P, Self::Reference>,
        law: &AnyLaw<HOOP>,
        k: &mut MatrixLanes<N>,
    ) {
        let points = stresses::<S, K, N, P, HOOP>(at, law, &mut Positive::default());
        let functions = at.reference;
        let mut mixed = [SymmetricLanes::default(); P];
        let mut of_squares = [[Lanes::ZERO; K]; K];
        for p in 0..P {
            let (point, volume) = (&points[p], at.block.volume[p]);
            let (r, alpha, beta) = (point.ratio, point.inverse_j, point.theta_over_jj);
            let c = law.tangent_at(p, &point.strains_in(&at.motion));
            let y = c.times::<HOOP>(&point.half_c);
            let mut kappa = y.contract::<HOOP>(&point.half_c);
            let mut z = y.map(|y| r * y) + point.s;
            if HOOP {
                let [g, second] = point.slopes;
                let of_c = point.s.contract::<HOOP>(&point.half_c);
                kappa = kappa * (g * g) + second * of_c;
                z = z.times(g);
            }
            let half = beta * kappa * 0.5;
            let of_k = point.by_rho::<HOOP>() * alpha + half;
            let z = z - point.k.times(of_k);
            mixed[p] = z.with(&point.k, |z, k| (z - half * k) * alpha * volume);
            let of_square = alpha * alpha * kappa * volume;
            for first in 0..K {
                for second in 0..K {
                    let of_first = match first {
                        0 => of_square,
                        _ => of_square * functions.values[p][first],
                    };
                    of_squares[first][second] += match second {
                        0 => of_first,
                        _ => of_first * functions.values[p][second],
                    };
                }
            }
            let (of_c, of_z) = (r * r * volume, beta * volume);
            let (z, of_volume) = (z.components(), point.k.components());
            let c = TangentLanes::of(|i, j| {
                let both = z[i] * of_volume[j] + of_volume[i] * z[j];
                c.0[i][j] * of_c - both * of_z
            });
            let s = point.s.times(r * volume);
            let f = deformation_gradient(&point.gradient.h);
            let mut a = elasticity(&f, &s, &c);
            let stretch = point.gradient.stretch_around();
            let pressure = point.pressure * volume;
            // J = (F_xx F_yy - F_xy F_yx) (1 + h)
            let of_section = match HOOP {
                true => pressure * stretch,
                false => pressure,
            };
            a[0][3][0] += of_section;
            a[1][0][1] += of_section;
            a[0][2][1] = a[0][2][1] - of_section;
            a[1][1][0] = a[1][1][0] - of_section;
            let gradients = at.block.gradients::<S>(p);
            add_products(k, &gradients, &a);
            if HOOP {
                let rows = at.hoop_row::<S>(p);
                add_hoop(k, (&gradients, &rows), (&f, stretch), (s.z, &c.0[2]));
                let [[xx, xy], [yx, yy]] = f;
                let of_node = |[x, y]: [Lanes; 2]| {
                    [(yy * x - yx * y) * pressure, (xx * y - xy * x) * pressure]
                };
                for b in 0..N {
                    for a in 0..b + 1 {
                        let (first, second) = (of_node(gradients[a]), of_node(gradients[b]));
                        for i in 0..2 {
                            k[a][b][i][0] += first[i] * rows[b];
                            k[a][b][0][i] += rows[a] * second[i];
                        }
                    }
                }
            }
        }
        let mut theta = [[[Lanes::ZERO; N]; 2]; K];
        for number in 0..K {
            theta[number] = at.nodal_forces::<S, HOOP>(|p| {
                let weight = functions.weighted[p][number];
                (&points[p].gradient, points[p].k.times(weight))
            });
        }
        for number in 0..K {
            let mut x = at.nodal_forces::<S, HOOP>(|p| {
                let of_function = match number {
                    0 => mixed[p],
                    _ => mixed[p].times(functions.values[p][number]),
                };
                (&points[p].gradient, of_function)
            });
            for i in 0..2 {
                for a in 0..N {
                    for other in 0..K {
                        x[i][a] += theta[other][i][a] * of_squares[number][other] * 0.5;
                    }
                }
            }
            let theta = &theta[number];
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
    }

    #[inline(always)]
    fn results<S: IntegratedShape<N, P>>(
        at: &MovedBlock<N, P, Self::Reference>,
        law: &AnyLaw<HOOP>,
    ) -> [ResultPoint; P] {
        let points = stresses::<S, K, N, P, HOOP>(at, law, &mut Positive::default());
        from_fn(|p| ResultPoint {
            gradient: points[p].gradient,
            strain: points[p].strains[1],
            determinant: points[p].theta,
            s: points[p].effective(),
            weight: at.block.volume[p],
        })
    }
}
