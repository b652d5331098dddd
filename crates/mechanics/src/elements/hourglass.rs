//! Potential of the hourglass modes of an element with one strain. For a metal, strain and modes flow together: with
//! the elastic stiffness alone the element could carry moments of any size. See docs/theory/materials.md, Hourglass
//! modes of metals.
//!
//! # Derivation
//!
//! The element flows when the root mean square of the von Mises stress q over the element reaches the yield stress. The
//! energy of the modes counts as distortional energy, q²/(6 mu). Strain and modes then form one strain with more
//! components, with one radial return:
//!
//! ```text
//! q² = 3/2 xi:xi + m,   m = 3 mu/V x.Kh x,   x = y - (1 + k) y_p,   k = H_k/(3 mu)
//! dE_p = r xi/(2 mu),   dy_p = r x,   r = 3 mu da/q,   q - (3 mu + H_k) da = sigma_y(a + da)
//! ```
//!
//! Up to a constant, the minimum of the energy over the flow is V W(E; m) + (y - y_p).Kh (y - y_p)/2, with the
//! amplitudes y, their plastic part y_p and the stiffness Kh. The element knows the derivatives of W with respect to E
//! and to m, and m is quadratic in y.

use std::array::from_fn;

use nalgebra::{Matrix4, SMatrix, SVector, Vector4};

use super::block::{SymmetricLanes, TangentLanes, dot};
use crate::materials::number::LANES;
use crate::materials::{Lanes, Metal, Number, StrainChange, Symmetric};

/// Amplitudes of the M modes in a motion.
#[derive(Clone, Copy)]
pub enum Amplitudes<const M: usize> {
    /// Amplitudes in one configuration.
    At([Lanes; M]),
    /// Amplitudes at the start and at the end of an increment.
    Between([Lanes; M], [Lanes; M]),
    /// Amplitudes at the start and at the end of an increment, for a viscosity.
    Change([Lanes; M], [Lanes; M]),
}

/// Stiffness Kh of the modes (energy divided by the square of the amplitudes).
pub type ModeStiffness<const M: usize> = [[Lanes; M]; M];

/// The elastic potential (y - y_p).Kh (y - y_p)/2 + k y_p.Kh y_p/2 of the modes with the amplitudes y.
pub struct HourglassPotential<const M: usize> {
    /// Kh
    pub stiffness: ModeStiffness<M>,
    /// Plastic part y_p of the amplitudes.
    flown: [Lanes; M],
    /// Factor k = H_k/(3 mu) of kinematic hardening.
    kinematic: Lanes,
}

impl<const M: usize> Amplitudes<M> {
    fn ends(&self) -> [&[Lanes; M]; 2] {
        match self {
            Amplitudes::At(y) => [y, y],
            Amplitudes::Between(y0, y1) | Amplitudes::Change(y0, y1) => [y0, y1],
        }
    }
}

impl<const M: usize> HourglassPotential<M> {
    /// Potential with a stiffness Kh; for metals the potential has the plastic amplitudes y_p.
    pub fn new(
        stiffness: ModeStiffness<M>,
        metals: &[Option<Metal>; LANES],
        flown: &[&[f64]; LANES],
    ) -> Self {
        let of = |k: usize, lane: usize| flown[lane].get(k).copied().unwrap_or_default();
        HourglassPotential {
            stiffness,
            flown: from_fn(|k| Lanes::of_lanes(|lane| of(k, lane))),
            kinematic: Lanes::of_lanes(|lane| metals[lane].as_ref().map_or(0.0, hardening)),
        }
    }

    /// Kh x
    fn force(&self, x: &[Lanes; M]) -> [Lanes; M] {
        from_fn(|k| dot(&self.stiffness[k], x))
    }

    /// Stress that does work on the amplitudes.
    pub fn stress(&self, amplitudes: &Amplitudes<M>) -> [Lanes; M] {
        self.force(&from_fn(|k| match amplitudes {
            Amplitudes::At(y) => y[k] - self.flown[k],
            Amplitudes::Change(y0, y1) => (y1[k] - y0[k]) * 0.5,
            Amplitudes::Between(y0, y1) => (y0[k] + y1[k]) * 0.5 - self.flown[k],
        }))
    }

    /// The potential, or the work of `stress` between two configurations.
    pub fn energy(&self, amplitudes: &Amplitudes<M>, stress: &[Lanes; M]) -> Lanes {
        let half = |x: &[Lanes; M]| dot(x, &self.force(x)) * 0.5;
        match amplitudes {
            Amplitudes::At(y) => {
                half(&from_fn(|k| y[k] - self.flown[k])) + self.kinematic * half(&self.flown)
            }
            Amplitudes::Change(y0, y1) | Amplitudes::Between(y0, y1) => {
                dot(stress, &from_fn(|k| y1[k] - y0[k]))
            }
        }
    }
}

/// Factor k = H_k/(3 mu) of a metal.
fn hardening(metal: &Metal) -> f64 {
    let [shear, kinematic] = metal.law.moduli();
    kinematic / shear
}

/// The tensor with the strains (11, 22, 33, 2*12).
fn tensor(e: &Vector4<f64>) -> Symmetric {
    Symmetric::new(e.x, e.y, e.z, e.w / 2.0)
}

/// Strain (11, 22, 33, 2*12) and amplitudes of the modes, or the forces that do work on strain and amplitudes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Joint<const M: usize> {
    /// The strain, or the force that does work on the strain.
    pub e: Vector4<f64>,
    /// The amplitudes of the modes, or the forces that do work on the amplitudes.
    pub y: SVector<f64, M>,
}

impl<const M: usize> Joint<M> {
    fn combined(&self, a: f64, other: &Self, b: f64) -> Self {
        Joint {
            e: self.e * a + other.e * b,
            y: self.y * a + other.y * b,
        }
    }

    fn dot(&self, other: &Self) -> f64 {
        self.e.dot(&other.e) + self.y.dot(&other.y)
    }
}

/// Second derivatives with respect to strain and amplitudes.
#[derive(Debug, Clone, Copy)]
pub(super) struct JointTangent<const M: usize> {
    /// Second derivative with respect to the strain.
    pub ee: Matrix4<f64>,
    /// Mixed second derivative with respect to the strain and the amplitudes.
    pub ey: SMatrix<f64, 4, M>,
    /// Second derivative with respect to the amplitudes.
    pub yy: SMatrix<f64, M, M>,
}

impl<const M: usize> JointTangent<M> {
    fn of(&self, n: &Joint<M>) -> Joint<M> {
        Joint {
            e: self.ee * n.e + self.ey * n.y,
            y: self.ey.tr_mul(&n.e) + self.yy * n.y,
        }
    }

    /// Adds `factor` times the symmetric product (a b + b a)/2.
    fn add_product(&mut self, a: &Joint<M>, b: &Joint<M>, factor: f64) {
        let half = factor / 2.0;
        self.ee += (a.e * b.e.transpose() + b.e * a.e.transpose()) * half;
        self.ey += (a.e * b.y.transpose() + b.e * a.y.transpose()) * half;
        self.yy += (a.y * b.y.transpose() + b.y * a.y.transpose()) * half;
    }
}

/// Strain and amplitudes in one configuration, or at the start and at the end of an increment.
#[derive(Debug, Clone, Copy)]
pub(super) enum JointPath<const M: usize> {
    /// Strain and amplitudes in one configuration.
    At(Joint<M>),
    /// Strain and amplitudes at the start and at the end of an increment.
    Between(Joint<M>, Joint<M>),
}

impl<const M: usize> JointPath<M> {
    /// The path of strain and amplitudes from the start to the end, in the element of a lane.
    fn new(strains: &[SymmetricLanes; 2], amplitudes: &Amplitudes<M>, lane: usize) -> Self {
        let ends = amplitudes.ends();
        let [start, end] = from_fn(|end| {
            let e = strains[end].lane(lane);
            Joint {
                e: Vector4::new(e.x, e.y, e.z, 2.0 * e.w),
                y: SVector::from_fn(|k, _| ends[end][k].0[lane]),
            }
        });
        match amplitudes {
            Amplitudes::At(_) => JointPath::At(end),
            Amplitudes::Between(..) | Amplitudes::Change(..) => JointPath::Between(start, end),
        }
    }
}

/// A metal with the modes of its element: the potential V W(E; m) of strain and amplitudes, eq. (2.48), which is added
/// to the elastic potential of the modes.
#[derive(Debug, Clone, Copy)]
pub(super) struct BentMetal<'a, const M: usize> {
    /// Kh
    stiffness: SMatrix<f64, M, M>,
    /// y_p
    flown: SVector<f64, M>,
    /// k
    kinematic: f64,
    metal: Metal<'a>,
    volume: f64,
}

impl<'a, const M: usize> BentMetal<'a, M> {
    /// Metal and modes of one element, whose volume is given (length^3).
    fn new(potential: &HourglassPotential<M>, metal: Metal<'a>, volume: f64, lane: usize) -> Self {
        BentMetal {
            stiffness: SMatrix::from_fn(|i, j| potential.stiffness[i][j].0[lane]),
            flown: SVector::from_fn(|k, _| potential.flown[k].0[lane]),
            kinematic: potential.kinematic.0[lane],
            metal,
            volume,
        }
    }

    fn shear(&self) -> f64 {
        self.metal.law.moduli()[0]
    }

    /// Amplitudes x = y - (1 + k) y_p, measured from the back stress.
    fn relative(&self, y: &SVector<f64, M>) -> SVector<f64, M> {
        y - self.flown * (1.0 + self.kinematic)
    }

    /// The measure m, a square of the amplitudes y of the modes, and 3 mu/V Kh x: half the derivative of m with respect
    /// to y.
    fn square(&self, y: &SVector<f64, M>) -> (f64, SVector<f64, M>) {
        let x = self.relative(y);
        let half = self.stiffness * x * (self.shear() / self.volume);
        (half.dot(&x).max(0.0), half)
    }

    /// Change of the potential between two states, with a round-off that is relative to the change.
    fn change(&self, start: &Joint<M>, end: &Joint<M>) -> f64 {
        let ((m0, half0), (m1, half1)) = (self.square(&start.y), self.square(&end.y));
        let by = (half0 + half1).dot(&(end.y - start.y));
        let strains = StrainChange::between(&tensor(&start.e), &tensor(&end.e));
        let (law, of_point) = (self.metal.law, self.metal.of_point);
        self.volume * law.change(of_point, &strains, [m0, m1], by)
    }

    fn stress_at(&self, at: &Joint<M>) -> Joint<M> {
        let (m, half) = self.square(&at.y);
        let (law, of_point) = (self.metal.law, self.metal.of_point);
        let (stress, by_modes) = law.bent_stress(of_point, &tensor(&at.e), m);
        Joint {
            e: Vector4::from(stress.components()) * self.volume,
            y: half * (2.0 * by_modes * self.volume),
        }
    }

    fn tangent_at(&self, at: &Joint<M>) -> JointTangent<M> {
        let (m, half) = self.square(&at.y);
        let (law, of_point) = (self.metal.law, self.metal.of_point);
        let state = law.bent_tangent(of_point, &tensor(&at.e), m);
        let [first, second] = state.by_modes;
        JointTangent {
            ee: state.tangent.matrix() * self.volume,
            ey: Vector4::from(state.stress_by_modes.components())
                * half.transpose()
                * (2.0 * self.volume),
            yy: self.stiffness * (2.0 * self.shear() * first)
                + half * half.transpose() * (4.0 * self.volume * second),
        }
    }

    /// Metric of strain and amplitudes: 3 mu V and Kh (energy).
    fn metric(&self, n: &Joint<M>) -> Joint<M> {
        let mut e = n.e * (self.volume * self.shear());
        e.w /= 2.0;
        Joint {
            e,
            y: self.stiffness * n.y,
        }
    }

    /// Whether a motion is too small for a correction; `size` is the bound, relative to a strain of 1.
    fn is_small(&self, squared: f64, size: f64) -> bool {
        squared <= size * size * self.volume * self.shear()
    }

    /// The stress V S, and the stress from the potential D that is added to the stress of the modes. Both stresses are
    /// the derivative of the potential D, or the discrete gradient of D: with n between start and end and its metric m,
    ///
    /// ```text
    /// D'(mean) + phi/(n.m) m,   phi = D(end) - D(start) - D'(mean).n
    /// ```
    pub fn stress(&self, path: &JointPath<M>) -> Joint<M> {
        let (start, end) = match path {
            JointPath::At(at) => return self.stress_at(at),
            JointPath::Between(start, end) => (start, end),
        };
        let n = end.combined(1.0, start, -1.0);
        let (m, stress) = (
            self.metric(&n),
            self.stress_at(&start.combined(0.5, end, 0.5)),
        );
        let squared = n.dot(&m);
        if self.is_small(squared, f64::EPSILON) {
            return stress;
        }
        let phi = self.change(start, end) - stress.dot(&n);
        stress.combined(1.0, &m, phi / squared)
    }

    /// The tangent of [`Self::stress`], or the symmetric part of twice its derivative with respect to the end: with g =
    /// D'(end) - D'(mean) - D''(mean) n/2,
    ///
    /// ```text
    /// D''(mean) + 2 phi/(n.m) (metric - 2 m m/(n.m)) + (m g + g m)/(n.m)
    /// ```
    pub fn tangent(&self, path: &JointPath<M>) -> JointTangent<M> {
        let (start, end) = match path {
            JointPath::At(at) => return self.tangent_at(at),
            JointPath::Between(start, end) => (start, end),
        };
        let n = end.combined(1.0, start, -1.0);
        let (m, mean) = (self.metric(&n), start.combined(0.5, end, 0.5));
        let (squared, mut tangent) = (n.dot(&m), self.tangent_at(&mean));
        if self.is_small(squared, f64::EPSILON.sqrt()) {
            return tangent;
        }
        let stress = self.stress_at(&mean);
        let phi = self.change(start, end) - stress.dot(&n);
        let half = tangent.of(&n);
        let g = (self.stress_at(end).combined(1.0, &stress, -1.0)).combined(1.0, &half, -0.5);
        let factor = 2.0 * phi / squared;
        for k in 0..4 {
            let shear = if k == 3 { 0.5 } else { 1.0 };
            tangent.ee[(k, k)] += factor * self.volume * self.shear() * shear;
        }
        tangent.yy += self.stiffness * factor;
        tangent.add_product(&m, &m, -2.0 * factor / squared);
        tangent.add_product(&m, &g, 2.0 / squared);
        tangent
    }

    /// The squares m of the modes at the start and at the end.
    pub fn squares(&self, path: &JointPath<M>) -> [f64; 2] {
        let (JointPath::At(end) | JointPath::Between(_, end)) = path;
        let (JointPath::At(start) | JointPath::Between(start, _)) = path;
        [start, end].map(|at| self.square(&at.y).0)
    }

    /// Writes the plastic amplitudes y_p at the end of an increment in which the given part of the trial strain flows.
    pub fn update(&self, path: &JointPath<M>, part: f64, updated: &mut [f64]) {
        let (JointPath::At(end) | JointPath::Between(_, end)) = path;
        let flown = self.flown + self.relative(&end.y) * part;
        updated.copy_from_slice(flown.as_slice());
    }
}

/// Second derivatives with respect to strain (11, 22, 33, 2*12) and amplitudes, for the elements of
/// a block.
pub struct BlockTangent<const M: usize> {
    /// Second derivative with respect to the strain.
    pub ee: TangentLanes,
    /// Mixed second derivative with respect to the strain and the amplitudes.
    pub ey: [[Lanes; M]; 4],
    /// Second derivative with respect to the amplitudes.
    pub yy: ModeStiffness<M>,
}

/// The modes of elements in a motion, for metals with the strain of their point.
pub struct ModesInMotion<'a, const M: usize> {
    potential: HourglassPotential<M>,
    metals: [Option<(BentMetal<'a, M>, JointPath<M>)>; LANES],
    /// Stress times volume, V S, of metals (force length).
    pub metal_stress: Option<SymmetricLanes>,
    /// Stress that does work on the amplitudes.
    pub stress: [Lanes; M],
    /// Stored energy of the modes, or the work of their stress (force length).
    pub energy: Lanes,
}

impl<'a, const M: usize> ModesInMotion<'a, M> {
    /// Modes with a potential, for elements with the given volume (length^3) and with the given strains of their point
    /// at the start and at the end.
    pub fn new(
        potential: HourglassPotential<M>,
        metals: [Option<Metal<'a>>; LANES],
        volume: Lanes,
        strains: &[SymmetricLanes; 2],
        amplitudes: &Amplitudes<M>,
    ) -> Self {
        let metals = from_fn(|lane| {
            let bent = BentMetal::new(&potential, metals[lane]?, volume.0[lane], lane);
            Some((bent, JointPath::new(strains, amplitudes, lane)))
        });
        let of_both = metals.each_ref().map(|metal: &Option<(BentMetal<M>, _)>| {
            metal.as_ref().map(|(bent, path)| bent.stress(path))
        });
        let mut stress = potential.stress(amplitudes);
        for (lane, of_both) in of_both.iter().enumerate() {
            for (k, of_modes) in of_both.iter().flat_map(|both| both.y.iter().enumerate()) {
                stress[k].0[lane] += of_modes;
            }
        }
        let of_point = |lane: usize| {
            let e = of_both[lane].map_or(Vector4::zeros(), |both| both.e);
            Symmetric::new(e.x, e.y, e.z, e.w)
        };
        let is_metal = of_both.iter().any(Option::is_some);
        ModesInMotion {
            metal_stress: is_metal.then(|| SymmetricLanes::of_lanes(of_point)),
            energy: potential.energy(amplitudes, &stress),
            stress,
            potential,
            metals,
        }
    }

    /// Kh.
    pub fn stiffness(&self) -> &ModeStiffness<M> {
        &self.potential.stiffness
    }

    /// For metals, the tangent of the stress V S and of the part that flow adds to the stress of the modes.
    pub fn metal_tangent(&self) -> Option<BlockTangent<M>> {
        self.metal_stress?;
        let of = |metal: &Option<(BentMetal<M>, _)>| {
            metal.as_ref().map(|(bent, path)| bent.tangent(path))
        };
        let all = self.metals.each_ref().map(of);
        let entry = |of: &dyn Fn(&JointTangent<M>) -> f64| {
            Lanes::of_lanes(|lane| all[lane].as_ref().map_or(0.0, of))
        };
        Some(BlockTangent {
            ee: TangentLanes::of(|i, j| entry(&|tangent| tangent.ee[(i, j)])),
            ey: from_fn(|i| from_fn(|k| entry(&|tangent| tangent.ey[(i, k)]))),
            yy: from_fn(|i| from_fn(|k| entry(&|tangent| tangent.yy[(i, k)]))),
        })
    }

    /// The metal of an element, and the square m of the modes at the start and at the end of the motion.
    pub fn metal(&self, lane: usize) -> Option<(Metal<'a>, [f64; 2])> {
        let metal = self.metals[lane].as_ref();
        metal.map(|(bent, path)| (bent.metal, bent.squares(path)))
    }

    /// Writes the variables of the modes of an element in which a part of the metal's trial strain flows.
    pub fn update(&self, lane: usize, part: f64, updated: &mut [f64]) {
        if let Some((bent, path)) = &self.metals[lane] {
            bent.update(path, part, updated);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::{Flow, Plane, PlanePlastic, Plastic, SmallStrainModuli};
    use nalgebra::{Matrix2, Vector2};

    const VOLUME: f64 = 0.7;
    const YOUNG: f64 = 1000.0;
    const RING: Vector4<f64> = Vector4::new(2.0, -1.2, -0.5, 0.9);
    const PLANE: Vector4<f64> = Vector4::new(2.0, -1.2, 0.0, 0.9);
    const BENT: Vector2<f64> = Vector2::new(0.03, -0.02);

    /// States of strain and modes, approximately in units of the yield limit for strain alone and for modes alone. The
    /// samples are: at rest; with (almost) only strain; with (almost) only modes; with both; and far beyond the yield
    /// limit.
    const SHARES: [[f64; 2]; 10] = [
        [0.0, 0.0],
        [0.5, 0.3],
        [1.5, 0.0],
        [1.5, 1e-6],
        [0.0, 1.7],
        [1e-6, 1.7],
        [0.9, 1.4],
        [1.2, 1.3],
        [3.0, 0.4],
        [6.0, 9.0],
    ];

    fn joint(direction: Vector4<f64>, [e, y]: [f64; 2]) -> Joint<2> {
        Joint {
            e: direction * (e * 1e-3),
            y: BENT * y,
        }
    }

    /// Metals with and without a back stress, with their variables after some flow, the variables of the modes, and a
    /// direction of strain.
    fn metals(units: f64) -> Vec<(PlanePlastic, [f64; 2], Vector4<f64>)> {
        let law = |kinematic| Plastic {
            moduli: SmallStrainModuli {
                young: YOUNG * units,
                poisson: 0.3,
            },
            hardening: [[0.0, 2.0], [0.004, 2.3], [0.05, 3.0]]
                .map(|[strain, stress]| [strain, stress * units])
                .into(),
            kinematic: kinematic * units,
        };
        let ways = [
            (Plane::Revolution, RING),
            (Plane::Strain, PLANE),
            (Plane::Stress, PLANE),
        ];
        let all = ways.map(|(plane, direction)| {
            [(0.0, [0.0; 2]), (40.0, [0.002, -0.003])]
                .map(|(kinematic, flown)| (law(kinematic).in_plane(plane), flown, direction))
        });
        all.into_iter().flatten().collect()
    }

    fn bent<'a>(law: &'a PlanePlastic, of_modes: &'a [f64], units: f64) -> BentMetal<'a, 2> {
        const AT_REST: [f64; 9] = [0.0; 9];
        let metal = Metal {
            law,
            of_point: &AT_REST[..Flow::variables(law)],
        };
        BentMetal {
            stiffness: Matrix2::new(3.0, 0.4, 0.4, 2.0) * units,
            flown: Vector2::from_column_slice(of_modes),
            kinematic: hardening(&metal),
            metal,
            volume: VOLUME,
        }
    }

    fn unit(j: usize) -> Joint<2> {
        let mut unit = Joint {
            e: SVector::zeros(),
            y: Vector2::zeros(),
        };
        match j < 4 {
            true => unit.e[j] = 1.0,
            false => unit.y[j - 4] = 1.0,
        }
        unit
    }

    /// Steps of difference quotients with respect to strains and amplitudes.
    fn step(j: usize) -> f64 {
        if j < 4 { 1e-8 } else { 1e-7 }
    }

    /// Indices of the components of strain and amplitudes that are free; the strain across the
    /// plane is not.
    fn numbers(direction: &Vector4<f64>) -> Vec<usize> {
        (0..6).filter(|&j| j != 2 || direction.z != 0.0).collect()
    }

    /// Derivatives of the complete potential of strain and modes.
    fn whole(bent: &BentMetal<2>, at: &Joint<2>) -> (Joint<2>, JointTangent<2>) {
        let (mut stress, mut tangent) = (bent.stress_at(at), bent.tangent_at(at));
        stress.y += bent.stiffness * (at.y - bent.flown);
        tangent.yy += bent.stiffness;
        (stress, tangent)
    }

    fn check_potential(bent: &BentMetal<2>, direction: Vector4<f64>) {
        let start = joint(direction, [0.0; 2]);
        for at in SHARES.map(|share| joint(direction, share)) {
            let (stress, tangent) = whole(bent, &at);
            for j in numbers(&direction) {
                let (unit, h) = (unit(j), step(j));
                let [ahead, behind] = [h, -h].map(|h| at.combined(1.0, &unit, h));
                let change = bent.change(&start, &ahead) - bent.change(&start, &behind);
                let (slope, exact) = (change / (2.0 * h), bent.stress_at(&at).dot(&unit));
                let scale = stress.e.norm() + stress.y.norm() + 1e-2;
                assert!(
                    (slope - exact).abs() < 1e-6 * scale,
                    "{at:?} {j}: {slope} {exact}"
                );
                let [s1, s0] = [&ahead, &behind].map(|at| whole(bent, at).0);
                let change = s1.combined(0.5 / h, &s0, -0.5 / h);
                let column = tangent.of(&unit);
                let error = change.combined(1.0, &column, -1.0);
                let most = column.e.norm() + column.y.norm();
                assert!(
                    error.e.norm() + error.y.norm() < 1e-4 * most,
                    "{at:?} {j}: {change:?} {column:?}"
                );
                // the potential is convex
                assert!(unit.dot(&column) > 0.0, "{at:?} {j}: {column:?}");
            }
        }
    }

    fn check_increments(bent: &BentMetal<2>, direction: Vector4<f64>) {
        let joints = SHARES.map(|share| joint(direction, share));
        for (start, end) in joints
            .iter()
            .flat_map(|a| joints.iter().map(move |b| (a, b)))
        {
            let path = JointPath::Between(*start, *end);
            let n = end.combined(1.0, start, -1.0);
            let (work, change) = (bent.stress(&path).dot(&n), bent.change(start, end));
            assert!(
                (work - change).abs() <= 1e-12 * (1e-3 + work.abs()),
                "{work} {change}"
            );
            let (e, y) = (n.e.norm(), n.y.norm());
            if e + y < 1e-4 {
                continue;
            }
            let tangent = bent.tangent(&path);
            let columns: Vec<_> = (0..6)
                .map(|j| {
                    let of = |h: f64| {
                        let end = end.combined(1.0, &unit(j), h);
                        bent.stress(&JointPath::Between(*start, end))
                    };
                    let h = step(j);
                    of(h).combined(1.0 / h, &of(-h), -1.0 / h)
                })
                .collect();
            let numbers = numbers(&direction);
            for (i, j) in numbers
                .iter()
                .flat_map(|&i| numbers.iter().map(move |&j| (i, j)))
            {
                let slope = (columns[j].dot(&unit(i)) + columns[i].dot(&unit(j))) / 2.0;
                let found = unit(i).dot(&tangent.of(&unit(j)));
                assert!(
                    (slope - found).abs() < 1e-4 * VOLUME * YOUNG,
                    "{start:?} {end:?} {i} {j}: {slope} {found}"
                );
            }
        }
    }

    #[test]
    fn strain_and_modes_of_a_metal_have_one_convex_potential() {
        for (law, flown, direction) in metals(1.0) {
            check_potential(&bent(&law, &flown, 1.0), direction);
        }
    }

    #[test]
    fn the_stress_of_an_increment_does_the_work_of_the_potential() {
        for (law, flown, direction) in metals(1.0) {
            check_increments(&bent(&law, &flown, 1.0), direction);
        }
    }

    #[test]
    fn units_that_differ_by_a_power_of_two_change_no_bit() {
        let stresses = |units: f64| {
            let mut all = Vec::new();
            for (law, flown, direction) in metals(units) {
                let bent = bent(&law, &flown, units);
                for share in SHARES {
                    let start = joint(direction, [0.7, 0.2]);
                    let s = bent.stress(&JointPath::Between(start, joint(direction, share)));
                    all.extend(s.e.iter().chain(&s.y).map(|s| s / units));
                }
            }
            all
        };
        for units in [2.0, 2.0_f64.powi(-11)] {
            assert_eq!(stresses(units), stresses(1.0), "{units}");
        }
    }

    #[test]
    fn a_section_of_one_layer_carries_its_full_moment() {
        // an incompressible square of the side 1: the moment M stores M²/(2 E' I) per length, with E' = 4 mu and I =
        // 1/12; the moment of a fully plastic section is 2/sqrt(3) sigma_y/4
        let shear = 100.0;
        let law = Plastic {
            moduli: SmallStrainModuli {
                young: 2.999_999 * shear,
                poisson: 0.499_999_5,
            },
            hardening: [[0.0, 2.0]].into(),
            kinematic: 0.0,
        };
        let (law, stiffness) = (law.in_plane(Plane::Strain), Matrix2::identity());
        let metal = Metal {
            law: &law,
            of_point: &[0.0; 5],
        };
        let bent = BentMetal {
            stiffness,
            flown: Vector2::zeros(),
            kinematic: 0.0,
            metal,
            volume: 1.0,
        };
        let at: Joint<2> = Joint {
            e: Vector4::zeros(),
            y: Vector2::new(30.0, 40.0),
        };
        let found = whole(&bent, &at).0.y.norm();
        let exact = 2.0 / 3.0_f64.sqrt() * 2.0 / 4.0 / (4.0 * shear / 12.0_f64).sqrt();
        assert!((found / exact - 1.0).abs() < 1e-5, "{found} {exact}");
    }
}
