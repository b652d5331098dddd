//! Enhanced strains of a ring with the section of a four-node quadrilateral (CAX4I): as
//! [`crate::elements::enhanced_strain`] with a fifth strain, around the axis. Section 2 of docs/theory.md.

use nalgebra::{Matrix2, Matrix4, SMatrix, SVector, Vector2, Vector4};

use super::at_strains::{AtStrains, Column, components, mean_of, tensor};
use super::points::{OfPoints, RingPoint, as_strain, section};
use super::stresses::{Compatible, StrainRows, Stresses, energy_change, size};
use crate::elements::enhanced_strain::{alternating, finite_or, signs};
use crate::elements::local_solution::{LAST_STEP, least, zero};
use crate::elements::solid::{MAX_DOFS, MAX_NODES};
use crate::elements::stretch::{AddedStrain, MeanStrain, Variation};
use crate::materials::{Committed, Strains, StressAtPoints, Symmetric, contract};

/// Number of strains of the element.
pub(super) const STRAINS: usize = 5;
type Alpha = SVector<f64, STRAINS>;
type StrainStiffness = SMatrix<f64, STRAINS, STRAINS>;

/// Hourglass pattern and strains of an element, in the reference configuration.
#[derive(Debug, Clone)]
pub(super) struct Enhanced {
    /// gamma of eq. (2.26), so that q = sum gamma_a u_a.
    pub gamma: [f64; MAX_NODES],
    /// grad h of h = r s at every point (1/length).
    pub slope: OfPoints<Vector2<f64>>,
    /// The strains M at every point.
    pub strains: OfPoints<[Symmetric; STRAINS]>,
}

/// Number of nodes of the quadrilateral.
const NODES: usize = 4;

/// Strains of the displacements of all points, and their mean in the measure of a material.
struct Measured {
    compatible: OfPoints<Symmetric>,
    mean: MeanStrain<3>,
}

/// Strains of the material.
fn of_material(enhanced: &[AddedStrain<3>]) -> OfPoints<Symmetric> {
    enhanced.iter().map(|e| components(&e.strain())).collect()
}

impl Enhanced {
    /// Those of an element at its four points, b being the mean of the gradients over the area:
    ///
    /// ```text
    /// g = b + gamma grad h,   M = j0 R0/(j R) T0 M_xi,   M_xi: r in 11; s in 22; r, s in 12; r s in 33
    /// ```
    pub fn new(points: &[RingPoint]) -> Self {
        let area: f64 = points.iter().map(|p| p.area).sum();
        let volume: f64 = points.iter().map(|p| p.volume).sum();
        let mut centre = [Vector2::zeros(); MAX_NODES];
        let slope = |point: &RingPoint| {
            let nodes = (0..NODES).map(|a| point.gradient[a] * alternating(a));
            nodes.fold(Vector2::zeros(), |sum, g| sum + g)
        };
        let slope: OfPoints<Vector2<f64>> = points.iter().map(slope).collect();
        let squares: f64 = slope.iter().map(Vector2::norm_squared).sum();
        let (mut gamma, mut inverse) = ([0.0; MAX_NODES], Matrix2::zeros());
        for a in 0..NODES {
            for point in points {
                centre[a] += point.gradient[a] * (point.area / area);
            }
            for (point, slope) in points.iter().zip(&slope) {
                gamma[a] += (point.gradient[a] - centre[a]).dot(slope) / squares;
            }
            // dxi/dX = sum n_a b_a, n_a = (r_a, s_a)/4 times 4
            inverse += Vector2::from(signs(a)) * centre[a].transpose();
        }
        let of_point = |(p, point): (usize, &RingPoint)| {
            let ([r, s], shrunk) = (signs(p), volume / point.volume);
            let shapes = [(r, 0.0, 0.0), (0.0, s, 0.0), (0.0, 0.0, r), (0.0, 0.0, s)];
            let mut strains = [Symmetric::zeros(); STRAINS];
            for (strain, (xx, yy, xy)) in strains.iter_mut().zip(shapes) {
                let m = inverse.transpose() * Matrix2::new(xx, xy, xy, yy) * inverse * shrunk;
                *strain = Symmetric::of_plane(&m, 0.0);
            }
            strains[STRAINS - 1].z = r * s * shrunk;
            strains
        };
        let all = points.iter().enumerate();
        let mut strains: OfPoints<[Symmetric; STRAINS]> = all.map(of_point).collect();
        for k in 0..STRAINS {
            let squares = points.iter().zip(&strains);
            let squares = squares.map(|(p, m)| p.volume * contract(&m[k], &m[k]));
            let size = (squares.sum::<f64>() / volume).sqrt();
            strains.iter_mut().for_each(|m| m[k] = m[k] / size);
        }
        Enhanced {
            gamma,
            slope,
            strains,
        }
    }

    /// q = sum gamma_a u_a, eq. (2.26) (length).
    pub fn q(&self, u: &[Vector2<f64>; MAX_NODES]) -> Vector2<f64> {
        let terms = u.iter().zip(&self.gamma).map(|(u, gamma)| u * *gamma);
        terms.fold(Vector2::zeros(), |sum, q| sum + q)
    }

    /// q halfway between two configurations.
    pub fn q_halfway(&self, [u0, u1]: [[Vector2<f64>; MAX_NODES]; 2]) -> Vector2<f64> {
        (self.q(&u0) + self.q(&u1)) / 2.0
    }

    /// Takes |q|²/2 grad h x grad h from the strains of displacements, eq. (2.27).
    pub fn correct_strains(&self, u: &[Vector2<f64>; MAX_NODES], strains: &mut [Symmetric]) {
        let half = self.q(u).norm_squared() / 2.0;
        for (strain, s) in strains.iter_mut().zip(&self.slope) {
            *strain -= Symmetric::new(s.x * s.x, s.y * s.y, 0.0, s.x * s.y) * half;
        }
    }

    /// Takes grad h x grad h gamma_a q from the rows of dE.
    pub fn correct_rows(&self, q: Vector2<f64>, rows: &mut [StrainRows]) {
        for (rows, s) in rows.iter_mut().zip(&self.slope) {
            let square = Vector4::new(s.x * s.x, s.y * s.y, 0.0, 2.0 * s.x * s.y);
            for a in 0..NODES {
                rows[2 * a] -= square * (self.gamma[a] * q.x);
                rows[2 * a + 1] -= square * (self.gamma[a] * q.y);
            }
        }
    }

    /// Takes the work of the stress on that part from the force.
    pub fn add_force(
        &self,
        points: &[RingPoint],
        q: Vector2<f64>,
        s: &[Symmetric],
        force: &mut [f64; MAX_DOFS],
    ) {
        let along = q * self.stress_along(points, s);
        for a in 0..NODES {
            force[2 * a] -= along.x * self.gamma[a];
            force[2 * a + 1] -= along.y * self.gamma[a];
        }
    }

    /// The second derivative of that part.
    pub fn add_geometric(&self, points: &[RingPoint], s: &[Symmetric], k: &mut [f64]) {
        let (d, along) = (size(k), self.stress_along(points, s));
        for (a, b) in (0..NODES).flat_map(|a| (0..NODES).map(move |b| (a, b))) {
            for i in 0..2 {
                k[(2 * a + i) * d + 2 * b + i] -= along * self.gamma[a] * self.gamma[b];
            }
        }
    }

    /// sum v grad h . S grad h
    fn stress_along(&self, points: &[RingPoint], s: &[Symmetric]) -> f64 {
        let all = points.iter().zip(s).zip(&self.slope);
        all.map(|((point, s), slope)| point.volume * slope.dot(&(section(s) * slope)))
            .sum()
    }

    /// The strains M of a point as columns (11, 22, 33, 2*12).
    pub fn columns(&self, p: usize) -> SMatrix<f64, 4, STRAINS> {
        SMatrix::from_columns(&self.strains[p].map(|m| as_strain(&m)))
    }

    /// E + M alpha at all points.
    fn linear(&self, compatible: &[Symmetric], alpha: &Alpha) -> OfPoints<Symmetric> {
        let of_point = |(e, m): (&Symmetric, &[Symmetric; STRAINS])| {
            m.iter().zip(alpha.iter()).fold(*e, |e, (m, a)| e + m * *a)
        };
        compatible.iter().zip(&self.strains).map(of_point).collect()
    }

    /// Strains of the displacements with their mean, in the measure of a material.
    fn measured(
        &self,
        points: &[RingPoint],
        material: &impl StressAtPoints,
        compatible: &[Symmetric],
    ) -> Measured {
        let mean = MeanStrain {
            strain: tensor(&mean_of(points, compatible)),
            measure: material.convex_in(),
        };
        Measured {
            compatible: compatible.into(),
            mean,
        }
    }

    /// Strains of the material at all points, with the element's own.
    fn enhanced(&self, measured: &Measured, alpha: &Alpha) -> OfPoints<AddedStrain<3>> {
        let linear = self.linear(&measured.compatible, alpha);
        let of_point = |linear| measured.mean.add(tensor(linear));
        linear.iter().map(of_point).collect()
    }

    /// The material at strains.
    fn at(
        material: &impl StressAtPoints,
        enhanced: OfPoints<AddedStrain<3>>,
        strains: impl Fn(usize) -> Strains,
    ) -> AtStrains {
        let stress = |p: usize| material.stress_at(p, &strains(p));
        AtStrains {
            stresses: (0..enhanced.len()).map(stress).collect(),
            enhanced,
        }
    }

    /// Changes of the strain of the material at a point by the alpha.
    fn own_columns(&self, at: &AtStrains, p: usize) -> [Column; STRAINS] {
        (self.strains[p].each_ref()).map(|m| at.column(p, m, &Symmetric::zeros()))
    }

    /// Derivatives of the energy by alpha, sum v M:T and K_aa, this times a factor, at strains of the material.
    fn derivatives(
        &self,
        points: &[RingPoint],
        material: &impl StressAtPoints,
        enhanced: OfPoints<AddedStrain<3>>,
        (strains, factor): (impl Fn(usize) -> Strains, f64),
    ) -> (Alpha, StrainStiffness) {
        let at = Self::at(material, enhanced, &strains);
        let (mut slope, mut stiffness) = (Alpha::zeros(), StrainStiffness::zeros());
        for (p, point) in points.iter().enumerate() {
            let own = self.own_columns(&at, p);
            let stress = at.stresses[p].vector() * point.volume;
            let c = material.tangent_at(p, &strains(p)).matrix() * factor;
            slope += Alpha::from_fn(|k, _| own[k].0.dot(&stress));
            stiffness +=
                StrainStiffness::from_fn(|k, l| at.product(p, &c, &own[k], &own[l]) * point.volume);
        }
        (slope, stiffness)
    }

    /// alpha of the last committed increment, from which the next is sought.
    fn committed(&self, material: &impl StressAtPoints) -> Alpha {
        match material.beyond(self.strains.len()) {
            [] => Alpha::zeros(),
            own => Alpha::from_column_slice(own),
        }
    }

    /// alpha with which the energy is least at strains of the displacements, eq. (2.28), sought from a first one on. NaN
    /// where the local solution does not converge.
    fn least(
        &self,
        points: &[RingPoint],
        material: &impl StressAtPoints,
        (measured, first): (&Measured, Alpha),
    ) -> Alpha {
        let last = LAST_STEP * largest(&measured.compatible) + f64::EPSILON;
        let derivatives = |alpha: &Alpha| {
            let e = self.enhanced(measured, alpha);
            let of_material = of_material(&e);
            let strains = |p: usize| Strains::At(of_material[p]);
            self.derivatives(points, material, e, (strains, 1.0))
        };
        let none = OfPoints::from_elem(Symmetric::zeros(), points.len());
        let change = |from: &Alpha, to: &Alpha| {
            self.energy_change(points, material, [(measured, from), (measured, to)], &none)
        };
        least(first, derivatives, change, last).unwrap_or(Alpha::from_element(f64::NAN))
    }

    /// alpha of the end of an increment with which the stresses of a viscosity do no work on the element's own strains.
    fn of_rates(
        &self,
        points: &[RingPoint],
        viscosity: &impl StressAtPoints,
        (start, end): (&[Symmetric], &Measured),
    ) -> Alpha {
        let changes = end.compatible.iter().zip(start).map(|(e1, e0)| e1 - e0);
        let change = changes.fold(0.0_f64, |most, e| most.max(e.amax()));
        let round_off = f64::EPSILON * largest(&end.compatible);
        let last = LAST_STEP * change + round_off + f64::MIN_POSITIVE;
        let derivatives = |alpha: &Alpha| {
            let e = self.enhanced(end, alpha);
            let of_material = of_material(&e);
            let strains = |p: usize| Strains::between(&start[p], &of_material[p]);
            self.derivatives(points, viscosity, e, (strains, 0.5))
        };
        zero(derivatives, last).unwrap_or(Alpha::from_element(f64::NAN))
    }

    /// sum v (W(E1) - W(E0)) between strains with alpha, the displacement strains of which change by `changes`.
    fn energy_change(
        &self,
        points: &[RingPoint],
        material: &impl StressAtPoints,
        [(start, alpha0), (end, alpha1)]: [(&Measured, &Alpha); 2],
        changes: &[Symmetric],
    ) -> f64 {
        let of_mean = tensor(&mean_of(points, changes));
        let [e0, e1] = [self.enhanced(start, alpha0), self.enhanced(end, alpha1)];
        let at_points = self.linear(changes, &(alpha1 - alpha0));
        let of_point = |(p, change): (usize, &Symmetric)| {
            let variation = Variation {
                at_point: tensor(change),
                of_mean,
            };
            components(&e1[p].change(&e0[p], &variation))
        };
        let changes: OfPoints<Symmetric> = at_points.iter().enumerate().map(of_point).collect();
        let ends = [&e0, &e1].map(|e| of_material(e));
        energy_change(points, material, between(&ends), &changes)
    }

    /// Strains and stresses of all points, eq. (2.29) between two configurations.
    pub fn stresses(
        &self,
        points: &[RingPoint],
        material: &impl StressAtPoints,
        compatible: &Compatible,
    ) -> Stresses {
        let first = self.committed(material);
        let solved = |compatible: &[Symmetric]| {
            let measured = self.measured(points, material, compatible);
            let alpha = self.least(points, material, (&measured, first));
            let enhanced = self.enhanced(&measured, &alpha);
            (measured, alpha, enhanced)
        };
        let (strains, tangent_at): (OfPoints<Strains>, OfPoints<Strains>);
        let at = |e: &OfPoints<AddedStrain<3>>| of_material(e).into_iter().map(Strains::At);
        let enhanced;
        let mut work = None;
        if !compatible.is_increment {
            (_, _, enhanced) = solved(&compatible.end);
            strains = at(&enhanced).collect();
            tangent_at = strains.clone();
        } else if material.is_viscous() {
            let end = self.measured(points, material, &compatible.end);
            let alpha = self.of_rates(points, material, (&compatible.start, &end));
            enhanced = self.enhanced(&end, &alpha);
            strains = compatible.strains(compatible.start.iter(), of_material(&enhanced).iter());
            tangent_at = strains.clone();
        } else {
            let (start, alpha0, e0) = solved(&compatible.start);
            let (end, alpha1, e1) = solved(&compatible.end);
            (_, _, enhanced) = solved(&compatible.halfway());
            strains = compatible.strains(of_material(&e0).iter(), of_material(&e1).iter());
            tangent_at = at(&enhanced).collect();
            let ends = [(&start, &alpha0), (&end, &alpha1)];
            work = Some(self.energy_change(points, material, ends, &compatible.changes()));
        }
        let at = Self::at(material, enhanced, |p| tangent_at[p]);
        let mut s = at.of_displacements(points);
        if let Some(work) = work {
            compatible.do_work(work, points, &mut s);
        }
        let is_number = s.iter().all(|s| s.components().iter().all(|s| !s.is_nan()));
        Stresses {
            strains,
            tangent_at,
            s,
            of_material: Some(at),
            determinant: if is_number { f64::INFINITY } else { f64::NAN },
        }
    }

    /// Adds K_uu - K_ua K_aa^-1 K_au, eq. (2.30), but for the part of the stress on the second derivatives of the strains of
    /// the displacements. `rows` are those of these strains.
    pub fn add_tangent(
        &self,
        points: &[RingPoint],
        (at, c): (&AtStrains, impl Fn(usize) -> Matrix4<f64>),
        rows: &[StrainRows],
        k: &mut [f64],
    ) {
        let d = size(k);
        let of_row = |row: &Vector4<f64>| Symmetric::new(row.x, row.y, row.z, row.w / 2.0);
        let of_mean: OfPoints<Symmetric> = (0..d)
            .map(|j| {
                let all: OfPoints<Symmetric> = rows.iter().map(|r| of_row(&r[j])).collect();
                mean_of(points, &all)
            })
            .collect();
        let mut stiffness = StrainStiffness::zeros();
        let mut mixed = [Alpha::zeros(); MAX_DOFS];
        for (p, (point, rows)) in points.iter().zip(rows).enumerate() {
            let (c, own) = (c(p), self.own_columns(at, p));
            let at_point = |j: usize| at.column(p, &of_row(&rows[j]), &of_mean[j]);
            let all: OfPoints<Column> = (0..d).map(at_point).collect();
            let product =
                |left: &Column, right: &Column| at.product(p, &c, left, right) * point.volume;
            stiffness += StrainStiffness::from_fn(|i, j| product(&own[i], &own[j]));
            for (j, column) in all.iter().enumerate() {
                mixed[j] += Alpha::from_fn(|i, _| product(&own[i], column));
                for (i, other) in all.iter().enumerate() {
                    k[j * d + i] += product(other, column);
                }
            }
        }
        if let Some(inverse) = stiffness.try_inverse() {
            for col in 0..d {
                let along = inverse * mixed[col];
                for row in 0..d {
                    k[col * d + row] -= mixed[row].dot(&along);
                }
            }
        }
    }

    /// D of an increment, what the potential has more than the stored energy: that of the points alone would have an error
    /// of first order in alpha (force length). `updated` has the variables of the points at the end already; alpha is written
    /// behind them.
    pub fn update(
        &self,
        points: &[RingPoint],
        (material, updated): (&Committed, &mut [f64]),
        compatible: &Compatible,
        stresses: &Stresses,
    ) -> f64 {
        let Some(own) = updated.len().checked_sub(STRAINS) else {
            return 0.0;
        };
        let first = self.committed(material);
        let [start, end] = [&compatible.start, &compatible.end]
            .map(|compatible| self.measured(points, material, compatible));
        let mut alpha = self.least(points, material, (&end, first));
        let mut dissipated = 0.0;
        if !material.are_first_variables(&updated[..own]) {
            let after = material.with(updated);
            alpha = finite_or(self.least(points, &after, (&end, alpha)), alpha);
            let before = self.least(points, material, (&start, first));
            let strains = stresses.strains.iter().enumerate();
            let work = strains.map(|(p, strains)| match strains {
                Strains::At(_) => 0.0,
                Strains::Between(change) => {
                    let s = material.stress_at(p, strains);
                    contract(&s, &change.change()) * points[p].volume
                }
            });
            let stored = |material: &Committed, measured: &Measured, alpha: &Alpha| -> f64 {
                let e = of_material(&self.enhanced(measured, alpha));
                let energies = points.iter().zip(&e).enumerate();
                energies
                    .map(|(p, (point, e))| material.energy_at(p, e) * point.volume)
                    .sum()
            };
            dissipated = work.sum::<f64>() + stored(material, &start, &before)
                - stored(&after, &end, &alpha);
        }
        updated[own..].copy_from_slice(alpha.as_slice());
        dissipated
    }
}

/// From the strains at the start to those at the end.
fn between([e0, e1]: &[OfPoints<Symmetric>; 2]) -> impl Iterator<Item = Strains> {
    let ends = e0.iter().zip(e1);
    ends.map(|(e0, e1)| Strains::between(e0, e1))
}

/// Largest component of strains.
fn largest(e: &[Symmetric]) -> f64 {
    e.iter().fold(0.0, |most, e| most.max(e.amax()))
}
