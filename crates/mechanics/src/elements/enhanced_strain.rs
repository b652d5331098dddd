//! Enhanced strains of the four-node quadrilateral (CPE4I, CPS4I; Simo & Rifai 1990) and of the ring with its section
//! (CAX4I), which bend without locking. The element adds four own strains to the strains of the displacements, and in a
//! ring a fifth own strain around the axis. The own strains minimise the stored energy of the element. Own strains are
//! not part of the state: Newton's method in the element, eq. (2.28), computes them from the displacements, starting
//! with the own strains of the last increment. See docs/theory/elements.md.
//!
//! # Derivation
//!
//! Let Phi(E) be a potential of the displacement strains of all points, minimised over all local variables. Like a
//! stored energy the potential Phi has a discrete gradient (eq. 4.8), with sums over the element in place of one point:
//!
//! ```text
//! S_g = S_g(E_m) + f/(sum v dE:dE) dE_g,   f = Phi(E1) - Phi(E0) - sum v S(E_m):dE
//! ```
//!
//! Here S does work on the displacement strains E, whereas the stress of the material does work on its own strain E_g
//! (eq. 2.28).
//!
//! The strain E is quadratic in the displacements, so B(U_m) d = dE and d.F = Phi(E1) - Phi(E0) hold exactly. Since Phi
//! is a minimum over the local variables alpha, only the square of an error of the local solution enters the factor f.

// Loops over points, nodes and directions: indices are those of the formulas.
#![allow(clippy::needless_range_loop)]

use std::array::from_fn;

use super::block::{
    BlockMotion, Deformation, Gradient, MatrixLanes, MovedBlock, NodalLanes, SymmetricLanes,
    TangentLanes, deformation_gradient, dot, sum,
};
use super::formulation::{BlockVariables, Formulation, PlacedBlock, PointState};
use super::local_solution::{Alpha, LAST_STEP, Stiffness, Wanted, least, solved, zero};
use super::results::ResultPoint;
use super::shapes::{CORNERS, IntegratedShape};
use super::stretch::{AddedStrain, MeanStrain, Tensor, Variation};
use crate::materials::number::{LANES, Positive};
use crate::materials::{AnyLaw, Lanes, LawInLanes, Number, Strains, StressAtPoints, Tangent};

/// Formulation with the strains of the displacements and A own strains: four, or five in a body of revolution.
pub struct EnhancedStrain<const A: usize>;

/// Number of nodes of the quadrilateral, and of its integration points; each point is next to a node.
const N: usize = 4;

/// The pattern (1, -1, 1, -1) of the nodes.
pub fn alternating(a: usize) -> f64 {
    [1.0, -1.0][a % 2]
}

/// Hourglass pattern and own strains of elements, in the reference configuration.
pub struct Modes<const A: usize> {
    /// Hourglass pattern gamma of eq. (2.26), with which q = sum gamma_a u_a.
    pub gamma: [Lanes; N],
    /// Gradient grad h of the function h = r s at every point (1/length).
    pub slope: [[Lanes; 2]; N],
    /// The own strains M at every point.
    strains: [[SymmetricLanes; A]; N],
    /// Weights of the points divided by the volume of the element.
    pub parts: [Lanes; N],
}

impl<const A: usize> Modes<A> {
    /// Modes of elements, from their gradients g at the points and the mean b of g over the area:
    ///
    /// ```text
    /// grad h = sum +-1 g,  g = b + gamma grad h,  dxi/dX = 4 n^T b,  n_a = (r_a, s_a)/4
    /// M = j0 R0/(j R) T0 M_xi,   M_xi: r in 11; s in 22; r, s in 12; r s in 33
    /// ```
    pub fn new<S: IntegratedShape<N, N>>(placed: &PlacedBlock<N, N>) -> Self {
        let weights = &placed.block.volume;
        let gradients: [[[Lanes; 2]; N]; N] = from_fn(|p| placed.block.gradients::<S>(p));
        let volume = sum::<N>(|p| weights[p]);
        let areas: [Lanes; N] = from_fn(|p| match A > PLANE_STRAINS {
            true => weights[p] * placed.over_radius[p],
            false => weights[p],
        });
        let area = sum::<N>(|p| areas[p]);
        let mean: [[Lanes; 2]; N] =
            from_fn(|a| from_fn(|i| sum::<N>(|p| gradients[p][a][i] * (areas[p] / area))));
        let slope: [[Lanes; 2]; N] =
            from_fn(|p| from_fn(|i| sum::<N>(|a| gradients[p][a][i] * alternating(a))));
        let squares = sum::<N>(|p| slope[p][0] * slope[p][0] + slope[p][1] * slope[p][1]);
        let gamma = from_fn(|a| {
            let along = |p: usize, i: usize| (gradients[p][a][i] - mean[a][i]) * slope[p][i];
            sum::<N>(|p| along(p, 0) + along(p, 1)) / squares
        });
        // row i: dxi_i/dX
        let natural: [[Lanes; 2]; 2] =
            from_fn(|i| from_fn(|j| sum::<N>(|a| mean[a][j] * CORNERS[a][i])));
        let mut strains: [[SymmetricLanes; A]; N] = from_fn(|p| {
            let ([r, s], shrunk) = (CORNERS[p], volume / weights[p]);
            from_fn(|k| match k {
                0 => product(&natural[0], &natural[0]).times(shrunk * r),
                1 => product(&natural[1], &natural[1]).times(shrunk * s),
                2 | 3 => {
                    let both = product(&natural[0], &natural[1]).map(|m| m * 2.0);
                    both.times(shrunk * [r, s][k - 2])
                }
                _ => SymmetricLanes {
                    z: shrunk * (r * s),
                    ..SymmetricLanes::default()
                },
            })
        });
        for k in 0..A {
            let square = |p: usize| strains[p][k].contract::<true>(&strains[p][k]);
            let size = (sum::<N>(|p| weights[p] * square(p)) / volume).sqrt();
            let over_size = Lanes::all(1.0) / size;
            strains
                .iter_mut()
                .for_each(|m| m[k] = m[k].times(over_size));
        }
        Modes {
            gamma,
            slope,
            strains,
            parts: from_fn(|p| weights[p] / volume),
        }
    }

    /// The product grad h x grad h at a point.
    #[inline(always)]
    fn square(&self, p: usize) -> SymmetricLanes {
        product(&self.slope[p], &self.slope[p])
    }

    /// Mean of tensors over the volume.
    #[inline(always)]
    fn mean_of(&self, of_point: impl Fn(usize) -> SymmetricLanes) -> SymmetricLanes {
        let mut mean = SymmetricLanes::zeros();
        for p in 0..N {
            mean += of_point(p).times(self.parts[p]);
        }
        mean
    }

    /// Own strain M alpha at a point.
    #[inline(always)]
    fn strain(&self, p: usize, alpha: &Alpha<A>) -> SymmetricLanes {
        let mut strain = SymmetricLanes::zeros();
        for k in 0..A {
            strain += self.strains[p][k].times(alpha[k]);
        }
        strain
    }

    /// Stiffness Kh of the amplitudes y for a tangent C, minimised over the own strains alpha: K_yy - K_ya K_aa^-1
    /// K_ay, eq. (2.42); `columns` gives the strain at a point for each amplitude.
    pub fn condensed<const M: usize>(
        &self,
        c: &Tangent,
        weights: &[Lanes; N],
        columns: impl Fn(usize, usize) -> SymmetricLanes,
    ) -> [[Lanes; M]; M] {
        let c = TangentLanes::of(|i, j| Lanes::all(c.0[i][j]));
        let (mut own, mut mixed) = ([[Lanes::ZERO; A]; A], [[Lanes::ZERO; A]; M]);
        let mut k = [[Lanes::ZERO; M]; M];
        for p in 0..N {
            let stress = |m: &SymmetricLanes| c.times::<true>(m).times(weights[p]);
            let stresses: [SymmetricLanes; A] = from_fn(|k| stress(&self.strains[p][k]));
            for i in 0..A {
                for j in 0..A {
                    own[i][j] += self.strains[p][i].contract::<true>(&stresses[j]);
                }
            }
            for i in 0..M {
                let column = columns(p, i);
                for j in 0..A {
                    mixed[i][j] += column.contract::<true>(&stresses[j]);
                }
                let stress = stress(&column);
                for j in 0..M {
                    k[j][i] += columns(p, j).contract::<true>(&stress);
                }
            }
        }
        let along = solved(&own, &mixed);
        for i in 0..M {
            for j in 0..M {
                k[i][j] = k[i][j] - dot(&mixed[i], &along[j]);
            }
        }
        k
    }
}

/// All elements.
const ALL: Wanted = [true; LANES];
/// Number of own strains of the element in the plane.
const PLANE_STRAINS: usize = 4;

/// Hourglass displacement q = sum gamma_a u_a, eq. (2.26), for displacements u of the nodes (length).
#[inline(always)]
pub fn hourglass(gamma: &[Lanes; N], u: &NodalLanes<N>) -> [Lanes; 2] {
    from_fn(|i| dot(&u[i], gamma))
}

/// Symmetric part of the product a x b of two vectors in the plane of the section.
#[inline(always)]
fn product(a: &[Lanes; 2], b: &[Lanes; 2]) -> SymmetricLanes {
    let shear = (a[0] * b[1] + a[1] * b[0]) * 0.5;
    SymmetricLanes::new(a[0] * b[0], a[1] * b[1], Lanes::ZERO, shear)
}

/// A block with enhanced strains in a motion under a law.
struct Solution<'a, 'b, const A: usize, const HOOP: bool, L: ?Sized> {
    at: &'a MovedBlock<'b, N, N, Modes<A>>,
    law: &'a L,
}

/// Strains of the displacements at all points, and their mean, in the strain measure of the
/// material.
struct Measured {
    compatible: [SymmetricLanes; N],
    mean: MeanStrain,
}

/// Strains of the displacements, eq. (2.27), at the start, in the mid configuration and at the end of a motion, and the
/// change of the strains, computed without the round-off of a difference. For a single configuration the strains at
/// start, middle and end are the same.
struct Compatible {
    start: [SymmetricLanes; N],
    halfway: [SymmetricLanes; N],
    end: [SymmetricLanes; N],
    change: [SymmetricLanes; N],
    gradients: [Gradient; N],
    /// Hourglass displacement q in the mid configuration (length).
    q: [Lanes; 2],
    positive: Positive,
}

impl Compatible {
    #[inline(always)]
    fn new<S: IntegratedShape<N, N>, const A: usize, const HOOP: bool>(
        at: &MovedBlock<N, N, Modes<A>>,
    ) -> Self {
        let modes = at.reference;
        let (q, half) = match &at.motion {
            BlockMotion::At(u) => (hourglass(&modes.gamma, u), [Lanes::ZERO; 2]),
            BlockMotion::Between(mid, half) => {
                (hourglass(&modes.gamma, mid), hourglass(&modes.gamma, half))
            }
        };
        let along = |a: &[Lanes; 2], b: &[Lanes; 2]| a[0] * b[0] + a[1] * b[1];
        let (of_q, of_half, mixed) = (along(&q, &q), along(&half, &half), along(&q, &half));
        let mut all = Compatible {
            start: [SymmetricLanes::default(); N],
            halfway: [SymmetricLanes::default(); N],
            end: [SymmetricLanes::default(); N],
            change: [SymmetricLanes::default(); N],
            gradients: [Gradient::default(); N],
            q,
            positive: Positive::default(),
        };
        for p in 0..N {
            let Deformation { gradient, strains } = at.deformation::<S, HOOP>(p, &mut all.positive);
            let square = modes.square(p);
            all.gradients[p] = gradient;
            match strains {
                Strains::At(e) => {
                    let e = e - square.times(of_q * 0.5);
                    (all.start[p], all.halfway[p], all.end[p]) = (e, e, e);
                }
                // |q|²/2 of start and end: their mean, and half their change
                Strains::Between(change) => {
                    let mean = change.mean - square.times((of_q + of_half) * 0.5);
                    let half = change.half - square.times(mixed);
                    (all.start[p], all.halfway[p], all.end[p]) = (mean - half, mean, mean + half);
                    all.change[p] = half.map(|e| e * 2.0);
                }
            }
        }
        all
    }
}

impl<const A: usize, const HOOP: bool, L: StressAtPoints<Lanes, HOOP> + ?Sized>
    Solution<'_, '_, A, HOOP, L>
{
    fn modes(&self) -> &Modes<A> {
        self.at.reference
    }

    /// Strains of the displacements and their mean, in the strain measure of the material.
    fn measured(&self, compatible: &[SymmetricLanes; N]) -> Measured {
        Measured {
            mean: MeanStrain {
                strain: self.modes().mean_of(|p| compatible[p]),
                measure: self.law.convex_in(),
            },
            compatible: *compatible,
        }
    }

    /// Strains of the material at all points, including the element's own strains.
    fn enhanced(&self, measured: &Measured, alpha: &Alpha<A>) -> [AddedStrain; N] {
        from_fn(|p| {
            let linear = measured.compatible[p] + self.modes().strain(p, alpha);
            measured.mean.add::<HOOP>(&linear)
        })
    }

    /// Derivatives of the energy with respect to alpha, the first derivative sum v M:T and `factor` times the second
    /// derivative K_aa, at strains of the material.
    fn derivatives(
        &self,
        enhanced: &[AddedStrain; N],
        (strains, factor): (&[Strains<Lanes>; N], f64),
        wanted: Wanted,
    ) -> (Alpha<A>, Stiffness<A>) {
        let (mut slope, mut stiffness) = ([Lanes::ZERO; A], [[Lanes::ZERO; A]; A]);
        for p in 0..N {
            let point = self.point(p, (&enhanced[p], &strains[p]), factor, wanted);
            let own = point.own_columns(self.modes());
            for (k, column) in own.iter().enumerate() {
                slope[k] += column.first.contract::<HOOP>(&point.s);
            }
            for l in 0..A {
                let stress = point.stress(&own[l]);
                for k in 0..l + 1 {
                    stiffness[k][l] += own[k].product::<HOOP>(&stress);
                }
            }
        }
        for l in 0..A {
            for k in 0..l {
                stiffness[l][k] = stiffness[k][l];
            }
        }
        (slope, stiffness)
    }

    /// Stress and tangent of the material at a point, multiplied by the weight of the point; the tangent is also
    /// multiplied by `factor`.
    #[inline(always)]
    fn point<'c>(
        &self,
        p: usize,
        (enhanced, strains): (&'c AddedStrain, &Strains<Lanes>),
        factor: f64,
        wanted: Wanted,
    ) -> PointMaterial<'c, HOOP> {
        let weight = self.at.block.volume[p];
        let c = self.law.tangent_where(wanted, p, strains);
        let of_c = weight * factor;
        PointMaterial {
            number: p,
            enhanced,
            s: self.law.stress_where(wanted, p, strains).times(weight),
            c: TangentLanes::of(|i, j| c.0[i][j] * of_c),
        }
    }

    /// The own strains alpha that minimise the energy at strains of the displacements, eq. (2.28); the search starts at
    /// `first`. The own strains alpha are NaN if the local solution does not converge.
    fn least(&self, measured: &Measured, first: &Alpha<A>) -> Alpha<A> {
        let last = largest(&measured.compatible) * LAST_STEP + f64::EPSILON;
        let derivatives = |alpha: &Alpha<A>, wanted: Wanted| {
            let e = self.enhanced(measured, alpha);
            let strains = e.map(|e| Strains::At(e.strain::<HOOP>()));
            self.derivatives(&e, (&strains, 1.0), wanted)
        };
        let none = [SymmetricLanes::zeros(); N];
        let change = |from: &Alpha<A>, to: &Alpha<A>, wanted: Wanted| {
            self.energy_change([(measured, from), (measured, to)], &none, wanted)
        };
        least(*first, derivatives, change, last)
    }

    /// The own strains alpha at the end of an increment for which viscous stresses do no work on these own strains,
    /// from the strains of the displacements at start and end. The own strains alpha are NaN if Newton's method does
    /// not converge.
    fn of_rates(&self, compatible: &Compatible, end: &Measured) -> Alpha<A> {
        let last = largest(&compatible.change) * LAST_STEP
            + largest(&compatible.end) * f64::EPSILON
            + f64::MIN_POSITIVE;
        let derivatives = |alpha: &Alpha<A>, wanted: Wanted| {
            let e = self.enhanced(end, alpha);
            let strains =
                from_fn(|p| Strains::between(&compatible.start[p], &e[p].strain::<HOOP>()));
            self.derivatives(&e, (&strains, 0.5), wanted)
        };
        zero(derivatives, last)
    }

    /// Own strains alpha of the last committed increment, at which the next search starts: the energy may have several
    /// minima, and the element follows one minimum.
    fn committed(&self) -> Alpha<A> {
        let of = |k: usize, lane: usize| self.at.own_variables[lane].get(k).copied();
        from_fn(|k| Lanes::of_lanes(|lane| of(k, lane).unwrap_or_default()))
    }

    /// Change of energy sum v (W(E1) - W(E0)) between two strains with their own strains alpha, whose displacement
    /// strains differ by `changes`. The round-off of this change of energy is relative to `changes`, whereas the
    /// difference of the two strains has the round-off of the strains.
    fn energy_change(
        &self,
        [(start, alpha0), (end, alpha1)]: [(&Measured, &Alpha<A>); 2],
        changes: &[SymmetricLanes; N],
        wanted: Wanted,
    ) -> Lanes {
        let (e0, e1) = (self.enhanced(start, alpha0), self.enhanced(end, alpha1));
        let of_mean = self.modes().mean_of(|p| changes[p]);
        let by = from_fn(|k| alpha1[k] - alpha0[k]);
        let mut change = Lanes::ZERO;
        for p in 0..N {
            let variation = Variation {
                at_point: changes[p] + self.modes().strain(p, &by),
                of_mean,
            };
            let strains = Strains::between(&e0[p].strain::<HOOP>(), &e1[p].strain::<HOOP>());
            let s = self.law.stress_where(wanted, p, &strains);
            let of_point = e1[p].change::<HOOP>(&e0[p], &variation);
            change += s.contract::<HOOP>(&of_point) * self.at.block.volume[p];
        }
        change
    }

    /// Stored energy int W dOmega with the element's own strains.
    fn stored(&self, measured: &Measured, alpha: &Alpha<A>) -> Lanes {
        let e = self.enhanced(measured, alpha);
        sum::<N>(|p| self.law.energy_at(p, &e[p].strain::<HOOP>()) * self.at.block.volume[p])
    }

    /// Strains and stresses of all points; between two configurations eq. (2.29) gives the stresses.
    fn states<S: IntegratedShape<N, N>>(&self) -> States<A> {
        let compatible = Compatible::new::<S, A, HOOP>(self.at);
        let first = self.committed();
        let solved = |compatible: &[SymmetricLanes; N]| {
            let measured = self.measured(compatible);
            let alpha = self.least(&measured, &first);
            let enhanced = self.enhanced(&measured, &alpha);
            (measured, alpha, enhanced)
        };
        let strain = |e: &AddedStrain| e.strain::<HOOP>();
        let (mut work, mut solutions) = (None, None);
        let (enhanced, strains, tangent_at): (_, [Strains<Lanes>; N], [Strains<Lanes>; N]);
        match self.at.motion {
            BlockMotion::At(_) => {
                let (end, alpha, e1) = solved(&compatible.end);
                enhanced = e1;
                strains = from_fn(|p| Strains::At(strain(&enhanced[p])));
                tangent_at = strains;
                solutions = Some((None, (end, alpha)));
            }
            BlockMotion::Between(..) if self.law.is_viscous() => {
                let end = self.measured(&compatible.end);
                let alpha = self.of_rates(&compatible, &end);
                enhanced = self.enhanced(&end, &alpha);
                strains =
                    from_fn(|p| Strains::between(&compatible.start[p], &strain(&enhanced[p])));
                tangent_at = strains;
            }
            BlockMotion::Between(..) => {
                let (start, alpha0, e0) = solved(&compatible.start);
                let (end, alpha1, e1) = solved(&compatible.end);
                (_, _, enhanced) = solved(&compatible.halfway);
                strains = from_fn(|p| Strains::between(&strain(&e0[p]), &strain(&e1[p])));
                tangent_at = from_fn(|p| Strains::At(strain(&enhanced[p])));
                let ends = [(&start, &alpha0), (&end, &alpha1)];
                work = Some(self.energy_change(ends, &compatible.change, ALL));
                solutions = Some((Some((start, alpha0)), (end, alpha1)));
            }
        }
        let of_material: [SymmetricLanes; N] = from_fn(|p| self.law.stress_at(p, &tangent_at[p]));
        // T less the mean of R
        let conjugate: [[SymmetricLanes; 2]; N] =
            from_fn(|p| enhanced[p].conjugate::<HOOP>(&of_material[p]));
        let mean = self.modes().mean_of(|p| conjugate[p][1]);
        let mut s: [SymmetricLanes; N] = from_fn(|p| conjugate[p][0] - mean);
        if let Some(work) = work {
            self.do_work(work, &compatible.change, &mut s);
        }
        let mut positive = compatible.positive;
        for s in &s {
            // the value is positive unless the stress is NaN
            positive = positive.and(s.x * s.x + 1.0);
        }
        States {
            enhanced,
            strains,
            tangent_at,
            of_material,
            s,
            positive,
            compatible,
            solutions,
        }
    }

    /// Changes the stresses S into S + f/(sum v dE:dE) dE with f = work - sum v S:dE, eq. (2.29), which do the given
    /// work in an increment.
    fn do_work(&self, work: Lanes, changes: &[SymmetricLanes; N], s: &mut [SymmetricLanes; N]) {
        let weights = &self.at.block.volume;
        let of = |stress: &[SymmetricLanes; N]| {
            sum::<N>(|p| stress[p].contract::<HOOP>(&changes[p]) * weights[p])
        };
        let (f, squares) = (work - of(s), of(changes));
        let volume = sum::<N>(|p| weights[p]);
        let factor = Lanes::of_lanes(|lane| {
            let squares = squares.0[lane];
            match (squares / volume.0[lane]).sqrt() > f64::EPSILON {
                true => f.0[lane] / squares,
                false => 0.0,
            }
        });
        for (s, change) in s.iter_mut().zip(changes) {
            *s += change.times(factor);
        }
    }
}

/// Strains of the displacements, each with the own strains alpha that minimise the energy: at the start (only between
/// two configurations) and at the end.
type Solutions<const A: usize> = (Option<(Measured, Alpha<A>)>, (Measured, Alpha<A>));

/// Strains and stresses of a motion at all points.
struct States<const A: usize> {
    /// Strains, including the element's own strains, at which the tangent of the material is
    /// evaluated.
    enhanced: [AddedStrain; N],
    /// Strains of the material.
    strains: [Strains<Lanes>; N],
    /// Strains at which the tangent of the material is evaluated.
    tangent_at: [Strains<Lanes>; N],
    /// Stresses of the material at `tangent_at` (force/length^2).
    of_material: [SymmetricLanes; N],
    /// Stresses that do work on the strains of the displacements (force/length^2).
    s: [SymmetricLanes; N],
    /// Whether det F is positive and the local solution has converged.
    positive: Positive,
    compatible: Compatible,
    /// Strains at the start (only between two configurations) and at the end of a motion, for a material that stores
    /// energy.
    solutions: Option<Solutions<A>>,
}

impl<const A: usize> States<A> {
    fn at(&self, p: usize) -> PointState<'_> {
        PointState {
            gradient: &self.compatible.gradients[p],
            strains: &self.strains[p],
            s: self.s[p],
        }
    }

    /// Work of the stresses on the strains of the displacements, with the weights of the points (force length).
    fn work<const HOOP: bool>(&self, weights: &[Lanes; N]) -> Lanes {
        sum::<N>(|p| self.s[p].contract::<HOOP>(&self.compatible.change[p]) * weights[p])
    }
}

/// Stress and tangent of the material at a point.
struct PointMaterial<'a, const HOOP: bool> {
    number: usize,
    enhanced: &'a AddedStrain,
    /// Stress times the weight of the point.
    s: SymmetricLanes,
    /// Tangent of the material times the weight of the point.
    c: TangentLanes,
}

/// Change of the material's strain at a point by one displacement of the element or by one own strain alpha.
struct Column {
    /// dE_g
    first: SymmetricLanes,
    /// Tensor B by which the change enters the second derivative S : d²E_g.
    second: Tensor,
}

impl Column {
    /// The second derivative dE_g C dE_g + S : d²E_g for two changes of the strain; one of the changes is given by its
    /// stresses.
    #[inline(always)]
    fn product<const HOOP: bool>(
        &self,
        (stress, second): &(SymmetricLanes, Option<Tensor>),
    ) -> Lanes {
        let of_first = self.first.contract::<HOOP>(stress);
        match second {
            None => of_first,
            Some(second) => of_first + self.second.contract::<HOOP>(second),
        }
    }
}

impl<const HOOP: bool> PointMaterial<'_, HOOP> {
    /// Change of the material's strain for a change `at_point` of E + M alpha at the point and a change `of_mean` of
    /// the mean strain.
    #[inline(always)]
    fn column(&self, at_point: SymmetricLanes, of_mean: SymmetricLanes) -> Column {
        let variation = Variation { at_point, of_mean };
        let (first, second) = self.enhanced.variation::<HOOP>(&variation);
        Column { first, second }
    }

    /// Changes of the material's strain by each own strain alpha.
    #[inline(always)]
    fn own_columns<const A: usize>(&self, modes: &Modes<A>) -> [Column; A] {
        let of = |k: usize| modes.strains[self.number][k];
        from_fn(|k| self.column(of(k), SymmetricLanes::zeros()))
    }

    /// The stress C dE_g of a change of the strain, and the stress that acts on the tensor B of the change.
    #[inline(always)]
    fn stress(&self, column: &Column) -> (SymmetricLanes, Option<Tensor>) {
        (
            self.c.times::<HOOP>(&column.first),
            self.enhanced.second_stress::<HOOP>(&column.second, &self.s),
        )
    }
}

/// Largest absolute component of the strains in every element.
fn largest(e: &[SymmetricLanes; N]) -> Lanes {
    Lanes::of_lanes(|lane| e.iter().fold(0.0, |most, e| most.max(e.lane(lane).amax())))
}

impl<const A: usize, const HOOP: bool> Formulation<N, N, HOOP> for EnhancedStrain<A> {
    type Reference = Modes<A>;

    fn own_variables(_is_metal: bool) -> usize {
        A
    }

    fn reference<S: IntegratedShape<N, N>>(placed: &PlacedBlock<N, N>) -> Modes<A> {
        Modes::new::<S>(placed)
    }

    #[inline(always)]
    fn for_each_state<S: IntegratedShape<N, N>>(
        at: &MovedBlock<N, N, Modes<A>>,
        law: &(impl StressAtPoints<Lanes, HOOP> + ?Sized),
        mut visit: impl FnMut(usize, &PointState),
    ) -> Positive {
        let states = Solution { at, law }.states::<S>();
        (0..N).for_each(|p| visit(p, &states.at(p)));
        states.positive
    }

    /// Force sum v (F S grad h_a - (grad h.S grad h) gamma_a q) at node a: the strain of eq. (2.27) does not contain
    /// |q|^2.
    #[inline(always)]
    fn force<S: IntegratedShape<N, N>>(
        at: &MovedBlock<N, N, Modes<A>>,
        law: &(impl StressAtPoints<Lanes, HOOP> + ?Sized),
    ) -> (NodalLanes<N>, Positive) {
        let (states, weights) = (Solution { at, law }.states::<S>(), &at.block.volume);
        let modes = at.reference;
        let mut force = at.nodal_forces::<S, HOOP>(|p| {
            (
                &states.compatible.gradients[p],
                states.s[p].times(weights[p]),
            )
        });
        let along = sum::<N>(|p| modes.square(p).contract::<false>(&states.s[p]) * weights[p]);
        for i in 0..2 {
            for a in 0..N {
                force[i][a] = force[i][a] - along * states.compatible.q[i] * modes.gamma[a];
            }
        }
        (force, states.positive)
    }

    /// The tangent K = K_uu - K_ua K_aa^-1 K_au, eq. (2.30); in the energy-momentum form at the strain E_m.
    #[inline(always)]
    fn add_tangent<S: IntegratedShape<N, N>>(
        at: &MovedBlock<N, N, Modes<A>>,
        law: &AnyLaw<HOOP>,
        k: &mut MatrixLanes<N>,
    ) {
        let solution = Solution { at, law };
        let (states, modes) = (solution.states::<S>(), at.reference);
        let q = states.compatible.q;
        let gradients: [[[Lanes; 2]; N]; N] = from_fn(|p| at.block.gradients::<S>(p));
        let hoop: [[Lanes; N]; N] = from_fn(|p| match HOOP {
            true => at.hoop_row::<S>(p),
            false => [Lanes::ZERO; N],
        });
        // dE by displacement i of node a, at place 2 a + i
        let rows: [[SymmetricLanes; 2 * N]; N] = from_fn(|p| {
            let gradient = &states.compatible.gradients[p];
            let (f, square) = (deformation_gradient(&gradient.h), modes.square(p));
            let stretch = gradient.stretch_around();
            from_fn(|j| {
                let (a, i) = (j / 2, j % 2);
                let of_f = product(&f[i], &gradients[p][a]);
                let row = of_f - square.times(modes.gamma[a] * q[i]);
                match HOOP && i == 0 {
                    true => SymmetricLanes {
                        z: stretch * hoop[p][a],
                        ..row
                    },
                    false => row,
                }
            })
        });
        let of_mean: [SymmetricLanes; 2 * N] = from_fn(|j| modes.mean_of(|p| rows[p][j]));
        let mut mixed = [[Lanes::ZERO; A]; 2 * N];
        let mut stiffness = [[Lanes::ZERO; A]; A];
        for p in 0..N {
            let point = solution.point(p, (&states.enhanced[p], &states.tangent_at[p]), 1.0, ALL);
            let columns: [Column; 2 * N] = from_fn(|j| point.column(rows[p][j], of_mean[j]));
            let own = point.own_columns(modes);
            for (j, column) in columns.iter().enumerate() {
                let stress = point.stress(column);
                for (i, other) in columns[..j + 1].iter().enumerate() {
                    k[i / 2][j / 2][i % 2][j % 2] += other.product::<HOOP>(&stress);
                }
                for (l, own) in own.iter().enumerate() {
                    mixed[j][l] += own.product::<HOOP>(&stress);
                }
            }
            for (j, column) in own.iter().enumerate() {
                let stress = point.stress(column);
                for (i, other) in own.iter().enumerate() {
                    stiffness[i][j] += other.product::<HOOP>(&stress);
                }
            }
            // S : D²E
            let s = states.s[p].times(at.block.volume[p]);
            let along = modes.square(p).contract::<false>(&s);
            for b in 0..N {
                let [x, y] = gradients[p][b];
                let stress = [s.x * x + s.w * y, s.w * x + s.y * y];
                for a in 0..b + 1 {
                    let of_section = gradients[p][a][0] * stress[0]
                        + gradients[p][a][1] * stress[1]
                        - along * modes.gamma[a] * modes.gamma[b];
                    k[a][b][0][0] += of_section;
                    k[a][b][1][1] += of_section;
                    if HOOP {
                        k[a][b][0][0] += s.z * hoop[p][a] * hoop[p][b];
                    }
                }
            }
        }
        let along = solved(&stiffness, &mixed);
        for j in 0..2 * N {
            for i in 0..j + 1 {
                let entry = &mut k[i / 2][j / 2][i % 2][j % 2];
                *entry = *entry - dot(&mixed[i], &along[j]);
            }
        }
        // the diagonal blocks of nodes are read completely
        for a in 0..N {
            k[a][a][1][0] = k[a][a][0][1];
        }
    }

    /// The reported stresses are the stresses of the material, not the stresses that do work on the strains of the
    /// displacements.
    #[inline(always)]
    fn results<S: IntegratedShape<N, N>>(
        at: &MovedBlock<N, N, Modes<A>>,
        law: &AnyLaw<HOOP>,
    ) -> [ResultPoint; N] {
        let states = Solution { at, law }.states::<S>();
        from_fn(|p| {
            let strain = states.strains[p].end();
            let c = strain.map(|e| e * 2.0).plus_isotropic(Lanes::all(1.0));
            ResultPoint {
                gradient: states.compatible.gradients[p],
                strain,
                determinant: (c.x * c.y - c.w * c.w).sqrt(),
                s: states.of_material[p],
                weight: at.block.volume[p],
            }
        })
    }

    /// Work of the stress on the strains of the displacements.
    fn work<S: IntegratedShape<N, N>>(
        at: &MovedBlock<N, N, Modes<A>>,
        law: &AnyLaw<HOOP>,
    ) -> Lanes {
        Solution { at, law }
            .states::<S>()
            .work::<HOOP>(&at.block.volume)
    }

    /// The element stores its own strains alpha at the end: with the new variables or, if these alpha are not found,
    /// with the old variables. If a point has flowed, the dissipated energy D is the change of Phi beyond the change of
    /// the stored energy. The dissipation of the points alone would have an error of first order in alpha.
    fn update<'z, S: IntegratedShape<N, N>>(
        at: &MovedBlock<N, N, Modes<A>>,
        law: &AnyLaw<HOOP>,
        of_variables: impl Fn([&'z [f64]; LANES]) -> LawInLanes<'z>,
        (z1, own): (&'z mut BlockVariables, &mut BlockVariables),
    ) -> Lanes {
        let before = Solution { at, law };
        let states = before.states::<S>();
        let mut dissipated = Lanes::ZERO;
        for p in 0..N {
            dissipated += states.at(p).update(p, law, z1) * at.block.volume[p];
        }
        let Some((start, (end, alpha1))) = &states.solutions else {
            return dissipated;
        };
        let (mut alpha, has_flown) = (*alpha1, dissipated.0.map(|dissipated| dissipated != 0.0));
        if has_flown != [false; LANES] {
            let law = of_variables(z1.each_ref().map(Vec::as_slice));
            let after = Solution {
                at,
                law: law.any::<HOOP>(),
            };
            let flown = after.least(end, alpha1);
            let is_found = |lane: usize| flown.iter().all(|a| a.0[lane].is_finite());
            for lane in (0..LANES).filter(|&lane| has_flown[lane] && is_found(lane)) {
                (0..A).for_each(|k| alpha[k].0[lane] = flown[k].0[lane]);
            }
            let stored = after.stored(end, &alpha);
            let potential = match start {
                Some((start, alpha0)) => {
                    before.stored(start, alpha0) + states.work::<HOOP>(&at.block.volume)
                }
                None => after.stored(end, alpha1) + dissipated,
            };
            dissipated = (potential - stored).where_kept(|lane| has_flown[lane]);
        }
        for (lane, own) in own.iter_mut().enumerate() {
            let alpha = alpha.iter().map(|alpha| alpha.0[lane]);
            own.iter_mut()
                .zip(alpha)
                .for_each(|(own, alpha)| *own = alpha);
        }
        dissipated
    }
}
