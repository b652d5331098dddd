//! The ring with the section of a four-node quadrilateral and one point (CAX4R): a potential of its hourglass modes and of
//! the change of its strain around the axis, without which one layer of elements could tilt freely. Section 2 of
//! docs/theory.md, One strain and hourglass stiffness.
//!
//! # Derivation
//!
//! With m the mean of grad h over the volume, F = F0 + q x (grad h - m) exactly, F0 being of the mean gradients. At small
//! strains the element with enhanced strains has, beside the mean strain, those of H = F0^T q and of E_33 less its mean,
//! whose energy with the mean strain is zero. Its energy with C of the law at E = 0, least in alpha, is the potential:
//!
//! ```text
//! y = (H, E_33 - mean E_33 at the four points),   e = sym(H x (grad h - m)) + y_33 e_33 e_33 + M alpha
//! Phi = V W(E0) + y.Kh y/2,   Kh = K_yy - K_ya K_aa^-1 K_ay
//! ```
//!
//! y is quadratic in the displacements, so that dy = (dy/du at halfway) du exactly.

use nalgebra::{Matrix2, SMatrix, SVector, Vector2, Vector4};

use super::enhanced::{Enhanced, STRAINS};
use super::points::{Gradient, OfPoints, RingPoint, StrainPath};
use super::stresses::{StrainRows, size};
use crate::elements::formulation::smaller;
use crate::elements::hourglass::{Amplitudes, ModesInMotion, variables};
use crate::elements::solid::{MAX_DOFS, MAX_NODES};
use crate::materials::{Strains, StressAtPoints, Symmetric};

/// Number of nodes, and of points at which E_33 changes.
const POINTS: usize = 4;
/// Number of deformations: two hourglass modes and E_33 at the points.
pub(super) const MODES: usize = 2 + POINTS;
type ModeAmplitudes = SVector<f64, MODES>;
type ModeStiffness = SMatrix<f64, MODES, MODES>;

/// Hourglass modes of an element in the reference configuration.
#[derive(Debug, Clone)]
pub(super) struct RingHourglass {
    /// The element as one point: mean gradients and the volume.
    mean: RingPoint,
    points: OfPoints<RingPoint>,
    enhanced: Enhanced,
    /// grad h - m at every point (1/length).
    slope: OfPoints<Vector2<f64>>,
}

/// The hourglass modes in a motion.
pub(super) struct RingModes<'a> {
    of: &'a RingHourglass,
    modes: ModesInMotion<'a, MODES>,
    /// F0 and q halfway.
    f: Matrix2<f64>,
    q: Vector2<f64>,
    paths: OfPoints<StrainPath>,
}

impl RingHourglass {
    /// Those of an element with these four points.
    pub fn new(points: &[RingPoint]) -> Self {
        let enhanced = Enhanced::new(points);
        let volume: f64 = points.iter().map(|p| p.volume).sum();
        let mut mean = RingPoint {
            shape: [0.0; MAX_NODES],
            place: Vector2::zeros(),
            gradient: [Vector2::zeros(); MAX_NODES],
            around: [0.0; MAX_NODES],
            area: points.iter().map(|p| p.area).sum(),
            volume,
        };
        let mut mean_slope = Vector2::zeros();
        for (point, slope) in points.iter().zip(&enhanced.slope) {
            let weight = point.volume / volume;
            mean.place += point.place * weight;
            mean_slope += slope * weight;
            for a in 0..POINTS {
                mean.shape[a] += point.shape[a] * weight;
                mean.gradient[a] += point.gradient[a] * weight;
                mean.around[a] += point.around[a] * weight;
            }
        }
        RingHourglass {
            mean,
            points: points.iter().cloned().collect(),
            slope: enhanced.slope.iter().map(|s| s - mean_slope).collect(),
            enhanced,
        }
    }

    /// The element as one point.
    pub fn mean(&self) -> &RingPoint {
        &self.mean
    }

    /// Mean of values at the four points.
    fn mean_of(&self, values: impl Fn(usize) -> f64) -> f64 {
        let all = self.points.iter().enumerate();
        all.map(|(p, point)| point.volume * values(p)).sum::<f64>() / self.mean.volume
    }

    /// The modes of eq. (2.44) between displacements of the nodes at the start and at the end of an increment, or at one configuration.
    pub fn modes<'a>(
        &'a self,
        material: &'a impl StressAtPoints,
        ends: [[Vector2<f64>; MAX_NODES]; 2],
        is_increment: bool,
    ) -> RingModes<'a> {
        let is_viscous = material.is_viscous();
        let c = match is_viscous && !is_increment {
            // a viscosity has no stress at one configuration
            true => nalgebra::Matrix4::zeros(),
            false => material.initial_tangent().matrix(),
        };
        let of_point = |point: &RingPoint| {
            let [start, end] = ends.each_ref().map(|u| point.displacement_gradient(u));
            StrainPath::new(start, end)
        };
        let paths: OfPoints<StrainPath> = self.points.iter().map(of_point).collect();
        let [(f0, q0), (f1, q1)] = ends.each_ref().map(|u| {
            let f = self.mean.displacement_gradient(u).f();
            (f, self.enhanced.q(u))
        });
        let y = |h: Vector2<f64>, gradient: fn(&StrainPath) -> Gradient| {
            let around = |p: usize| gradient(&paths[p]).strain().z;
            let mean = self.mean_of(around);
            ModeAmplitudes::from_fn(|k, _| match k {
                0 | 1 => h[k],
                _ => around(k - 2) - mean,
            })
        };
        let y0 = y(f0.tr_mul(&q0), |path| path.start);
        let y1 = y(f1.tr_mul(&q1), |path| path.end);
        let amplitudes = match (is_increment, is_viscous) {
            (false, _) => Amplitudes::At(y1),
            // the tangent of a viscosity is that by the mean of the strains: twice that by their change
            (true, true) => Amplitudes::Change(y0, y1),
            (true, false) => Amplitudes::Between(y0, y1),
        };
        let strains = ends.each_ref().map(|u| {
            let e = self.mean.displacement_gradient(u).strain();
            Vector4::new(e.x, e.y, e.z, 2.0 * e.w)
        });
        let (stiffness, metal) = (self.stiffness(&c), material.metal(1));
        RingModes {
            of: self,
            modes: ModesInMotion::new(stiffness, metal, self.mean.volume, strains, amplitudes),
            f: (f0 + f1) / 2.0,
            q: (q0 + q1) / 2.0,
            paths,
        }
    }

    /// Kh of the tangent C at small strains (force/length; force and force length with E_33).
    fn stiffness(&self, c: &nalgebra::Matrix4<f64>) -> ModeStiffness {
        let (mut k, mut mixed) = (
            ModeStiffness::zeros(),
            SMatrix::<f64, MODES, STRAINS>::zeros(),
        );
        let mut local = SMatrix::<f64, STRAINS, STRAINS>::zeros();
        for (p, point) in self.points.iter().enumerate() {
            let (s, m) = (self.slope[p], self.enhanced.columns(p));
            let mut columns = SMatrix::<f64, 4, MODES>::zeros();
            (columns[(0, 0)], columns[(3, 0)]) = (s.x, s.y);
            (columns[(1, 1)], columns[(3, 1)]) = (s.y, s.x);
            columns[(2, 2 + p)] = 1.0;
            let stress = c * columns * point.volume;
            k += columns.tr_mul(&stress);
            mixed += stress.tr_mul(&m);
            local += m.tr_mul(&(c * m * point.volume));
        }
        match local.try_inverse() {
            Some(inverse) => k - mixed * inverse * mixed.transpose(),
            None => k,
        }
    }
}

impl RingModes<'_> {
    /// Stored energy, or work of an increment (force length).
    pub fn energy(&self) -> f64 {
        self.modes.energy
    }

    /// S of a metal (force/length^2).
    pub fn metal_stress(&self) -> Option<Symmetric> {
        let components = self.modes.metal_stress?;
        Some(Symmetric::new(
            components.x,
            components.y,
            components.z,
            components.w,
        ))
    }

    /// Writes the variables of a metal's point and of its modes, and returns what is dissipated (force length); none of
    /// another material.
    pub fn update(&self, strains: &Strains, updated: &mut [f64]) -> Option<f64> {
        let (metal, squares) = self.modes.metal()?;
        let (of_point, own) = updated.split_at_mut(updated.len() - variables(MODES));
        let law = metal.law;
        let [dissipated, part] = law.update(strains, metal.of_point, squares, of_point);
        self.modes.update(part, own);
        Some(dissipated * self.of.mean.volume)
    }

    /// Smallest determinant at the four points.
    pub fn determinant(&self) -> f64 {
        let all = self.paths.iter().map(StrainPath::determinant);
        all.fold(f64::INFINITY, smaller)
    }

    /// Rows of dy by the displacements: b_a q_i + F0^T e_i gamma_a, and (1 + h) h_a/R less its mean.
    fn rows(&self) -> [ModeAmplitudes; 2 * POINTS] {
        let RingHourglass {
            mean,
            points,
            enhanced,
            ..
        } = self.of;
        std::array::from_fn(|j| {
            let (a, i) = (j / 2, j % 2);
            let around = |p: usize| match i {
                0 => self.paths[p].halfway.stretch_around() * points[p].around[a],
                _ => 0.0,
            };
            let mean_around = self.of.mean_of(around);
            ModeAmplitudes::from_fn(|k, _| match k {
                0 | 1 => mean.gradient[a][k] * self.q[i] + self.f[(i, k)] * enhanced.gamma[a],
                _ => around(k - 2) - mean_around,
            })
        })
    }

    /// Adds dy.f.
    pub fn add_force(&self, force: &mut [f64; MAX_DOFS]) {
        for (force, row) in force.iter_mut().zip(self.rows()) {
            *force += row.dot(&self.modes.stress);
        }
    }

    /// Adds dy.Kh dy + f.D²y, D²H_k = b_ak gamma_b + gamma_a b_bk in both directions, D²E_33 = h_a h_b/R² in that of the
    /// radius.
    /// Of a metal, with the rows of dE in `strains`, that of its point too.
    pub fn add_tangent(&self, strains: &StrainRows, k: &mut [f64]) {
        let (d, rows) = (size(k), self.rows());
        if let Some(of_both) = self.modes.metal_tangent() {
            for (col, (e, y)) in strains.iter().zip(&rows).enumerate() {
                let stress = of_both.ee * e + of_both.ey * y;
                let of_modes = of_both.ey.tr_mul(e) + of_both.yy * y;
                for (row, (e, y)) in strains.iter().zip(&rows).enumerate() {
                    k[col * d + row] += e.dot(&stress) + y.dot(&of_modes);
                }
            }
        }
        let stiffness = self.modes.stiffness();
        let RingHourglass {
            mean,
            points,
            enhanced,
            ..
        } = self.of;
        for (col, of_col) in rows.iter().enumerate() {
            let stress = stiffness * of_col;
            for (row, of_row) in rows.iter().enumerate() {
                k[col * d + row] += of_row.dot(&stress);
            }
        }
        let along =
            |a: usize| mean.gradient[a].dot(&self.modes.stress.fixed_rows::<2>(0).into_owned());
        for (a, b) in (0..POINTS).flat_map(|a| (0..POINTS).map(move |b| (a, b))) {
            let second = along(a) * enhanced.gamma[b] + enhanced.gamma[a] * along(b);
            let square = |p: usize| points[p].around[a] * points[p].around[b];
            let mean = self.of.mean_of(square);
            let around = (0..POINTS).map(|p| self.modes.stress[2 + p] * (square(p) - mean));
            k[2 * a * d + 2 * b] += second + around.sum::<f64>();
            k[(2 * a + 1) * d + 2 * b + 1] += second;
        }
    }
}
