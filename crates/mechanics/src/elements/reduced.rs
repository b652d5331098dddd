//! The four-node quadrilateral with the one strain of its mean gradients (CPE4R, CPS4R), and the ring with this section
//! (CAX4R). The hourglass modes of CPE4R, CPS4R and CAX4R have a potential. In a ring the variation of the strain
//! around the axis also has a potential, since one layer of elements could otherwise tilt freely. See
//! docs/theory/elements.md, One strain and hourglass stiffness.
//!
//! # Derivation
//!
//! With u = sum u_a h_a, the mean gradients b, and the mean m of grad h over the volume, the deformation gradient is
//! exactly F = F0 + q x (grad h - m), with F0 = I + sum u_a x b_a and q = sum gamma_a u_a. At small strains the element
//! with enhanced strains has, in addition to the mean strain, the strains from H = F0^T q and from E_33 less its mean.
//! The energy products of the hourglass strains with the mean strain are zero. The potential is the energy of the
//! hourglass strains with the tangent C of the law at E = 0, minimised over the own strains alpha:
//!
//! ```text
//! y = (H, E_33 - mean E_33 at the four points),   e = sym(H x (grad h - m)) + y_33 e_33 e_33 + M alpha
//! Phi = V W(E0) + y.Kh y/2,   Kh = K_yy - K_ya K_aa^-1 K_ay
//! ```
//!
//! The amplitudes y do not change when the element turns. The amplitudes y are quadratic in the displacements u, so
//! between two configurations their change is exactly dy = (dy/du in the mid configuration) du. The force with Kh (y0 +
//! y1)/2 in the mid configuration therefore does work equal to the change of the hourglass energy.

// Loops over points, nodes and directions: indices are those of the formulas.
#![allow(clippy::needless_range_loop)]

use std::array::from_fn;

use super::block::{
    BlockMotion, Deformation, Gradient, MatrixLanes, MovedBlock, NodalLanes, SymmetricLanes,
    TangentLanes, add_hoop, add_products, deformation_gradient, dot, elasticity, sum,
};
use super::enhanced_strain::{Modes, hourglass};
use super::formulation::{BlockVariables, Formulation, PlacedBlock, PointState};
use super::hourglass::{Amplitudes, HourglassPotential, ModeStiffness, ModesInMotion};
use super::results::ResultPoint;
use super::shapes::IntegratedShape;
use crate::materials::number::{LANES, Positive};
use crate::materials::{AnyLaw, Lanes, LawInLanes, Number, Strains, StressAtPoints, Tangent};

/// Formulation with one strain and a potential of M modes: two modes in the plane, and in a ring four more from E_33.
/// The stiffness of the modes is computed with A enhanced strains.
pub struct ReducedIntegration<const M: usize, const A: usize>;

/// Number of nodes of the quadrilateral; also the number of points at which its modes and det F are evaluated.
const N: usize = 4;
/// Number of hourglass modes in the plane.
const PLANE_MODES: usize = 2;

/// Elements with one point each and their hourglass modes, in the reference configuration.
pub struct OnePoint<const M: usize> {
    /// Mean gradients b (1/length).
    mean: [[Lanes; 2]; N],
    /// Means of h_a/R over the element (1/length).
    around: [Lanes; N],
    /// Values h_a/R at the four points, less their means.
    around_at: [[Lanes; N]; N],
    /// The hourglass vector gamma of eq. (2.26).
    gamma: [Lanes; N],
    /// Weights of the four points divided by the volume.
    parts: [Lanes; N],
    /// Volume (length^3).
    volume: Lanes,
    /// Stiffness Kh of the modes from the law.
    stiffness: ModeStiffness<M>,
    /// Stiffness Kh of the modes from the viscosity.
    viscous_stiffness: ModeStiffness<M>,
}

/// Elements with one point each and their modes, in a motion.
struct Moved<'a, const M: usize> {
    deformation: Deformation,
    /// Whether the determinant det F is positive, for the mean gradient and at the four points.
    positive: Positive,
    modes: ModesInMotion<'a, M>,
    /// Mean deformation gradient F0 and hourglass displacement q at the displacements of the strain-displacement
    /// matrix.
    f: [[Lanes; 2]; 2],
    q: [Lanes; 2],
    /// Stretches around the axis at the four points, in the mid configuration.
    stretches: [Lanes; N],
}

impl<const M: usize> OnePoint<M> {
    fn new<S: IntegratedShape<N, N>, const A: usize>(placed: &PlacedBlock<N, N>) -> Self {
        let modes = Modes::<A>::new::<S>(placed);
        let (weights, parts) = (&placed.block.volume, modes.parts);
        let gradients: [[[Lanes; 2]; N]; N] = from_fn(|p| placed.block.gradients::<S>(p));
        let hoop: [[Lanes; N]; N] =
            from_fn(|p| from_fn(|a| placed.over_radius[p] * S::FUNCTIONS.values[p][a]));
        let around = from_fn(|a| sum::<N>(|p| hoop[p][a] * parts[p]));
        let mean_slope: [Lanes; 2] = from_fn(|i| sum::<N>(|p| modes.slope[p][i] * parts[p]));
        let column = |p: usize, k: usize| {
            let [x, y]: [Lanes; 2] = from_fn(|i| modes.slope[p][i] - mean_slope[i]);
            let (zero, half) = (Lanes::ZERO, Lanes::all(0.5));
            match k {
                0 => SymmetricLanes::new(x, zero, zero, y * half),
                1 => SymmetricLanes::new(zero, y, zero, x * half),
                _ => SymmetricLanes {
                    z: Lanes::all(f64::from(u8::from(k - PLANE_MODES == p))),
                    ..SymmetricLanes::default()
                },
            }
        };
        let stiffness = |c: &Tangent| modes.condensed::<M>(c, weights, column);
        OnePoint {
            mean: from_fn(|a| from_fn(|i| sum::<N>(|p| gradients[p][a][i] * parts[p]))),
            around_at: from_fn(|p| from_fn(|a| hoop[p][a] - around[a])),
            around,
            gamma: modes.gamma,
            parts,
            volume: sum::<N>(|p| weights[p]),
            stiffness: stiffness(placed.tangent),
            viscous_stiffness: placed
                .viscous_tangent
                .map_or([[Lanes::ZERO; M]; M], stiffness),
        }
    }

    /// Mean displacement gradient for displacements of the nodes.
    #[inline(always)]
    fn gradient<const HOOP: bool>(&self, u: &NodalLanes<N>) -> Gradient {
        Gradient {
            h: from_fn(|i| from_fn(|j| sum::<N>(|a| u[i][a] * self.mean[a][j]))),
            around: match HOOP {
                true => sum::<N>(|a| u[0][a] * self.around[a]),
                false => Lanes::ZERO,
            },
        }
    }
}

impl<'a, const M: usize> Moved<'a, M> {
    /// The changes of the strain and of the amplitudes in a motion, eq. (2.44).
    #[inline(always)]
    fn new<S: IntegratedShape<N, N>, const HOOP: bool>(
        at: &MovedBlock<N, N, OnePoint<M>>,
        law: &'a (impl StressAtPoints<Lanes, HOOP> + ?Sized),
    ) -> Self {
        let one = at.reference;
        let mut positive = Positive::default();
        let (mid, half) = match &at.motion {
            BlockMotion::At(u) => (one.gradient::<HOOP>(u), Gradient::default()),
            BlockMotion::Between(mid, half) => {
                (one.gradient::<HOOP>(mid), one.gradient::<HOOP>(half))
            }
        };
        let (q, half_q) = match &at.motion {
            BlockMotion::At(u) => (hourglass(&one.gamma, u), [Lanes::ZERO; 2]),
            BlockMotion::Between(mid, half) => {
                (hourglass(&one.gamma, mid), hourglass(&one.gamma, half))
            }
        };
        let deformation = match &at.motion {
            BlockMotion::At(_) => Deformation::at::<HOOP>(mid, &mut positive),
            BlockMotion::Between(..) => Deformation::between::<HOOP>(mid, &half, &mut positive),
        };
        // H = F0^T q at the start and at the end
        let f = deformation_gradient(&mid.h);
        let [h0, h1]: [[Lanes; 2]; 2] = [-1.0, 1.0].map(|side| {
            let f: [[Lanes; 2]; 2] = from_fn(|i| from_fn(|k| f[i][k] + half.h[i][k] * side));
            let q: [Lanes; 2] = from_fn(|i| q[i] + half_q[i] * side);
            from_fn(|k| f[0][k] * q[0] + f[1][k] * q[1])
        });
        // E_33 at the four points at the start and at the end
        let (mut around, mut stretches) = ([[Lanes::ZERO; N]; 2], [Lanes::all(1.0); N]);
        for p in 0..N {
            let deformation = at.deformation::<S, HOOP>(p, &mut positive);
            if HOOP {
                let (start, end) = match deformation.strains {
                    Strains::At(e) => (e.z, e.z),
                    Strains::Between(change) => (change.start.z, change.end.z),
                };
                (around[0][p], around[1][p]) = (start, end);
                stretches[p] = deformation.gradient.stretch_around();
            }
        }
        let amplitudes = |h: &[Lanes; 2], around: &[Lanes; N]| {
            let mean = sum::<N>(|p| around[p] * one.parts[p]);
            from_fn(|k| match k < PLANE_MODES {
                true => h[k],
                false => around[k - PLANE_MODES] - mean,
            })
        };
        let (y0, y1) = (amplitudes(&h0, &around[0]), amplitudes(&h1, &around[1]));
        let (amplitudes, strains) = match deformation.strains {
            Strains::At(e) => (Amplitudes::At(y1), [e, e]),
            Strains::Between(change) => {
                // a viscosity is differentiated with respect to the mean strain, which gives twice the derivative with
                // respect to the change
                let amplitudes = match law.is_viscous() {
                    true => Amplitudes::Change(y0, y1),
                    false => Amplitudes::Between(y0, y1),
                };
                (amplitudes, [change.start, change.end])
            }
        };
        let mut stiffness = match law.is_viscous() {
            true => one.viscous_stiffness,
            false => one.stiffness,
        };
        if let Some(factor) = law.stiffness_factor() {
            stiffness = stiffness.map(|row| row.map(|k| k * factor));
        }
        let metals = from_fn(|lane| law.metal(lane));
        let potential = HourglassPotential::new(stiffness, &metals, &at.own_variables);
        Moved {
            modes: ModesInMotion::new(potential, metals, one.volume, &strains, &amplitudes),
            deformation,
            positive,
            f,
            q,
            stretches,
        }
    }

    /// Stress S of the point times the volume.
    #[inline(always)]
    fn weighted_stress<const HOOP: bool>(
        &self,
        one: &OnePoint<M>,
        law: &(impl StressAtPoints<Lanes, HOOP> + ?Sized),
    ) -> SymmetricLanes {
        match self.modes.metal_stress {
            Some(s) => s,
            None => law
                .stress_at(0, &self.deformation.strains)
                .times(one.volume),
        }
    }

    /// Derivatives dy of the amplitudes with respect to displacement i of node a: b_a q_i + F0^T e_i gamma_a, and (1 +
    /// h) h_a/R less its mean.
    #[inline(always)]
    fn row(&self, one: &OnePoint<M>, a: usize, i: usize) -> [Lanes; M] {
        let around = |p: usize| self.stretches[p] * (one.around_at[p][a] + one.around[a]);
        let mean = match M > PLANE_MODES && i == 0 {
            true => sum::<N>(|p| around(p) * one.parts[p]),
            false => Lanes::ZERO,
        };
        from_fn(|k| match (k < PLANE_MODES, i) {
            (true, _) => one.mean[a][k] * self.q[i] + self.f[i][k] * one.gamma[a],
            (false, 0) => around(k - PLANE_MODES) - mean,
            (false, _) => Lanes::ZERO,
        })
    }
}

impl<const M: usize, const A: usize, const HOOP: bool> Formulation<N, N, HOOP>
    for ReducedIntegration<M, A>
{
    type Reference = OnePoint<M>;

    const POINTS: usize = 1;

    fn own_variables(is_metal: bool) -> usize {
        match is_metal {
            true => M,
            false => 0,
        }
    }

    fn reference<S: IntegratedShape<N, N>>(placed: &PlacedBlock<N, N>) -> OnePoint<M> {
        OnePoint::new::<S, A>(placed)
    }

    #[inline(always)]
    fn for_each_state<S: IntegratedShape<N, N>>(
        at: &MovedBlock<N, N, OnePoint<M>>,
        law: &(impl StressAtPoints<Lanes, HOOP> + ?Sized),
        mut visit: impl FnMut(usize, &PointState),
    ) -> Positive {
        let moved = Moved::new::<S, HOOP>(at, law);
        let over_volume = Lanes::all(1.0) / at.reference.volume;
        let state = PointState {
            gradient: &moved.deformation.gradient,
            strains: &moved.deformation.strains,
            s: moved
                .weighted_stress::<HOOP>(at.reference, law)
                .times(over_volume),
        };
        visit(0, &state);
        moved.positive
    }

    /// Force V F0 S b_a + dy.f at node a, eq. (2.43), and whether det F is positive at all points.
    #[inline(always)]
    fn force<S: IntegratedShape<N, N>>(
        at: &MovedBlock<N, N, OnePoint<M>>,
        law: &(impl StressAtPoints<Lanes, HOOP> + ?Sized),
    ) -> (NodalLanes<N>, Positive) {
        let (moved, one) = (Moved::new::<S, HOOP>(at, law), at.reference);
        let s = moved.weighted_stress::<HOOP>(one, law);
        let f = &moved.f;
        let piola: [[Lanes; 2]; 2] =
            from_fn(|i| [f[i][0] * s.x + f[i][1] * s.w, f[i][0] * s.w + f[i][1] * s.y]);
        let hoop = moved.deformation.gradient.stretch_around() * s.z;
        let force = from_fn(|i| {
            from_fn(|a| {
                let [x, y] = one.mean[a];
                let of_modes = dot(&moved.row(one, a, i), &moved.modes.stress);
                let of_section = piola[i][0] * x + piola[i][1] * y + of_modes;
                match HOOP && i == 0 {
                    true => of_section + hoop * one.around[a],
                    false => of_section,
                }
            })
        });
        (force, moved.positive)
    }

    /// The tangent is K = V B^T C B + int B_NL^T S B_NL + G^T Kh G + f.D²y, where G has the derivatives dy as rows. The
    /// second derivative D²H_k = b_ak gamma_b + gamma_a b_bk acts in both directions, and D²E_33 = h_a h_b/R² acts
    /// along the radius. In a metal C and Kh come from one potential, whose mixed derivatives are also added.
    #[inline(always)]
    fn add_tangent<S: IntegratedShape<N, N>>(
        at: &MovedBlock<N, N, OnePoint<M>>,
        law: &AnyLaw<HOOP>,
        k: &mut MatrixLanes<N>,
    ) {
        let (moved, one) = (Moved::new::<S, HOOP>(at, law), at.reference);
        let of_both = moved.modes.metal_tangent();
        let c = match &of_both {
            Some(of_both) => of_both.ee,
            None => {
                let c = law.tangent_at(0, &moved.deformation.strains);
                TangentLanes::of(|i, j| c.0[i][j] * one.volume)
            }
        };
        let s = moved.weighted_stress::<HOOP>(one, law);
        let stretch = moved.deformation.gradient.stretch_around();
        add_products(k, &one.mean, &elasticity(&moved.f, &s, &c));
        if HOOP {
            add_hoop(
                k,
                (&one.mean, &one.around),
                (&moved.f, stretch),
                (s.z, &c.0[2]),
            );
        }
        let rows: [[[Lanes; M]; 2]; N] = from_fn(|a| from_fn(|i| moved.row(one, a, i)));
        let mut stiffness = *moved.modes.stiffness();
        if let Some(of_both) = &of_both {
            for l in 0..M {
                for m in 0..M {
                    stiffness[l][m] += of_both.yy[l][m];
                }
            }
        }
        for b in 0..N {
            for j in 0..2 {
                let stress: [Lanes; M] = from_fn(|m| dot(&stiffness[m], &rows[b][j]));
                for a in 0..b + 1 {
                    for i in 0..2 {
                        k[a][b][i][j] += dot(&rows[a][i], &stress);
                    }
                }
            }
        }
        if let Some(of_both) = &of_both {
            // ey y for every displacement, and its work on the strain (11, 22, 33, 2*12) of another
            // displacement
            let of_strain: [[[Lanes; 4]; 2]; N] =
                from_fn(|a| from_fn(|i| from_fn(|e| dot(&of_both.ey[e], &rows[a][i]))));
            let (f, mean) = (&moved.f, &one.mean);
            let work = |a: usize, i: usize, stress: &[Lanes; 4]| {
                let ([x, y], [fx, fy]) = (mean[a], f[i]);
                let of_section =
                    stress[0] * (fx * x) + stress[1] * (fy * y) + stress[3] * (fx * y + fy * x);
                match HOOP && i == 0 {
                    true => of_section + stress[2] * (stretch * one.around[a]),
                    false => of_section,
                }
            };
            for b in 0..N {
                for a in 0..b + 1 {
                    for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                        k[a][b][i][j] +=
                            work(a, i, &of_strain[b][j]) + work(b, j, &of_strain[a][i]);
                    }
                }
            }
        }
        let stress = &moved.modes.stress;
        let along = |a: usize| one.mean[a][0] * stress[0] + one.mean[a][1] * stress[1];
        for b in 0..N {
            for a in 0..b + 1 {
                let second = along(a) * one.gamma[b] + one.gamma[a] * along(b);
                k[a][b][0][0] += second;
                k[a][b][1][1] += second;
                if HOOP {
                    let square = |p: usize| {
                        (one.around_at[p][a] + one.around[a])
                            * (one.around_at[p][b] + one.around[b])
                    };
                    let mean = sum::<N>(|p| square(p) * one.parts[p]);
                    k[a][b][0][0] += sum::<N>(|p| stress[PLANE_MODES + p] * (square(p) - mean));
                }
            }
        }
    }

    #[inline(always)]
    fn results<S: IntegratedShape<N, N>>(
        at: &MovedBlock<N, N, OnePoint<M>>,
        law: &AnyLaw<HOOP>,
    ) -> [ResultPoint; N] {
        let mut points = [ResultPoint::default(); N];
        Self::for_each_state::<S>(at, law, |_, state| {
            points[0] = state.result(at.reference.volume);
        });
        points
    }

    #[inline(always)]
    fn hourglass_energy<S: IntegratedShape<N, N>>(
        at: &MovedBlock<N, N, OnePoint<M>>,
        law: &AnyLaw<HOOP>,
    ) -> Lanes {
        Moved::new::<S, HOOP>(at, law).modes.energy
    }

    fn work<S: IntegratedShape<N, N>>(
        at: &MovedBlock<N, N, OnePoint<M>>,
        law: &AnyLaw<HOOP>,
    ) -> Lanes {
        let moved = Moved::new::<S, HOOP>(at, law);
        let s = moved.weighted_stress::<HOOP>(at.reference, law);
        match moved.deformation.strains {
            Strains::At(_) => Lanes::ZERO,
            Strains::Between(change) => s.contract::<HOOP>(&change.change()) + moved.modes.energy,
        }
    }

    fn update<'z, S: IntegratedShape<N, N>>(
        at: &MovedBlock<N, N, OnePoint<M>>,
        law: &AnyLaw<HOOP>,
        _of_variables: impl Fn([&'z [f64]; LANES]) -> LawInLanes<'z>,
        (z1, own): (&'z mut BlockVariables, &mut BlockVariables),
    ) -> Lanes {
        let (moved, volume) = (Moved::new::<S, HOOP>(at, law), at.reference.volume);
        let mut dissipated = Lanes::ZERO;
        for lane in 0..LANES {
            let strains = moved.deformation.strains.lane(lane);
            let of_point = match moved.modes.metal(lane) {
                None => law.update_at(lane, 0, &strains, &mut z1[lane]),
                Some((metal, squares)) => {
                    let z0 = metal.of_point;
                    let [dissipated, part] = metal.law.update(&strains, z0, squares, &mut z1[lane]);
                    moved.modes.update(lane, part, &mut own[lane]);
                    dissipated
                }
            };
            dissipated.0[lane] = of_point * volume.0[lane];
        }
        dissipated
    }
}
