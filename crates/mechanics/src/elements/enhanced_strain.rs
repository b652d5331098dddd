//! Enhanced strains of the four-node quadrilateral (CPE4I, CPS4I; Simo & Rifai 1990), which bends without locking: four
//! strains of the element beside those of the displacements make its stored energy least. They are no state: they
//! follow from the displacements by Newton's method in the element, eq. (2.28), which begins with those of the last
//! increment. Section 2 of docs/theory.md.
//!
//! # Derivation
//!
//! A potential Phi(E) of the displacement strains of all points, in which everything local has been made least, has a
//! discrete gradient as a stored energy has (eq. 4.8), with sums over the element in place of one point:
//!
//! ```text
//! S_g = S_g(E_m) + f/(sum v dE:dE) dE_g,   f = Phi(E1) - Phi(E0) - sum v S(E_m):dE
//! ```
//!
//! S is what does work on the displacement strains E, beside the stress of the material on its own E_g (eq. 2.28).
//!
//! E is quadratic in the displacements, so that B(U_m) d = dE and d.F = Phi(E1) - Phi(E0) exactly. Because Phi is least
//! in alpha, errors of the local solution enter f squared.

use nalgebra::{Matrix2, Matrix3, Matrix4, SMatrix, SVector, Vector2, Vector3, Vector4};

use super::formulation::{
    Configuration, ElementFormulation, IntegrationPoint, PointState, Reference, add_geometric,
    determinant, displacement_gradient, green_lagrange, of_plane, smaller, strain_displacement,
    voigt,
};
use super::local_solution::{LAST_STEP, least, zero};
use super::stretch::{AddedStrain, MeanStrain, Variation};
use crate::materials::{Committed, Strains, StressAtPoints, Symmetric, Tangent};

/// Number of strains of the element.
pub(super) const STRAINS: usize = 4;

/// Strains of the displacements and four of the element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnhancedStrain;

/// The pattern (1, -1, 1, -1) of the nodes.
pub(super) fn alternating(a: usize) -> f64 {
    [1.0, -1.0][a % 2]
}

/// Natural signs r_a, s_a of a node, and of the integration point next to it.
pub(super) fn signs(a: usize) -> [f64; 2] {
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]][a % 4]
}

/// Hourglass pattern and strains of an element, in the reference configuration.
pub(super) struct Modes<const N: usize, const P: usize> {
    /// Mean gradients b of the shape functions, row a (1/length).
    pub mean: SMatrix<f64, N, 2>,
    /// gamma of eq. (2.26), so that q = sum gamma_a u_a.
    pub gamma: SVector<f64, N>,
    /// grad h of h = r s at every point (1/length).
    pub slope: [Vector2<f64>; P],
    /// The four strains M at every point.
    strains: [[Matrix2<f64>; 4]; P],
}

impl<const N: usize, const P: usize> Modes<N, P> {
    /// Those of an element, from its gradients g at the points:
    ///
    /// ```text
    /// b = sum v g/V,  grad h = sum +-1 g,  g = b + gamma grad h,  dxi/dX = 4 n^T b,  n_a = (r_a, s_a)/4
    /// ```
    pub fn new(element: &Reference<N, P>) -> Self {
        let (points, volume) = (&element.points, element.volume());
        let mut b = SMatrix::<f64, N, 2>::zeros();
        for point in points {
            b += point.gradient * (point.volume / volume);
        }
        let pattern = SVector::<f64, N>::from_fn(|a, _| alternating(a));
        let natural = SMatrix::<f64, N, 2>::from_fn(|a, i| signs(a)[i]);
        let slope = points.each_ref().map(|p| p.gradient.transpose() * pattern);
        let (mut gamma, mut squares) = (SVector::<f64, N>::zeros(), 0.0);
        for (point, slope) in points.iter().zip(&slope) {
            gamma += (point.gradient - b) * slope;
            squares += slope.norm_squared();
        }
        let inverse: Matrix2<f64> = natural.transpose() * b;
        let mut strains: [[Matrix2<f64>; 4]; P] = std::array::from_fn(|p| {
            let ([r, s], shrunk) = (signs(p), volume / points[p].volume);
            let shapes = [(r, 0.0, 0.0), (0.0, s, 0.0), (0.0, 0.0, r), (0.0, 0.0, s)];
            shapes.map(|(xx, yy, xy)| {
                inverse.transpose() * Matrix2::new(xx, xy, xy, yy) * inverse * shrunk
            })
        });
        for k in 0..4 {
            let squares = points.iter().zip(&strains);
            let mean = squares
                .map(|(p, m)| p.volume * m[k].norm_squared())
                .sum::<f64>()
                / volume;
            strains.iter_mut().for_each(|m| m[k] /= mean.sqrt());
        }
        Modes {
            mean: b,
            gamma: gamma / squares,
            slope,
            strains,
        }
    }

    /// Strains of the displacements at all points, eq. (2.27).
    fn compatible(&self, element: &Reference<N, P>, u: &SMatrix<f64, 2, N>) -> [Matrix2<f64>; P] {
        let half = (u * self.gamma).norm_squared() / 2.0;
        std::array::from_fn(|p| {
            let e = green_lagrange(&displacement_gradient(&element.points[p], u));
            e - self.slope[p] * self.slope[p].transpose() * half
        })
    }

    /// Mean of strains over the volume.
    fn mean_of(element: &Reference<N, P>, strains: &[Matrix2<f64>; P]) -> Matrix2<f64> {
        let all = element.points.iter().zip(strains);
        all.map(|(point, e)| e * point.volume).sum::<Matrix2<f64>>() / element.volume()
    }

    /// Strains of the displacements with their mean, in the measure of a material.
    fn measured(
        &self,
        element: &Reference<N, P>,
        material: &impl StressAtPoints,
        compatible: [Matrix2<f64>; P],
    ) -> Measured<P> {
        let strain = Self::mean_of(element, &compatible);
        let measure = material.convex_in();
        Measured {
            compatible,
            mean: MeanStrain { strain, measure },
        }
    }

    /// Strains of the material at all points, with the element's own.
    fn enhanced(&self, measured: &Measured<P>, alpha: &Vector4<f64>) -> [AddedStrain<2>; P] {
        std::array::from_fn(|p| (measured.mean).add(measured.compatible[p] + self.strain(p, alpha)))
    }

    fn strain(&self, p: usize, alpha: &Vector4<f64>) -> Matrix2<f64> {
        let terms = self.strains[p].iter().zip(alpha.iter());
        terms.map(|(m, a)| m * *a).sum()
    }

    /// Columns (xx, yy, 2 xy) of the strains of a point.
    pub fn columns(&self, p: usize) -> SMatrix<f64, 3, 4> {
        let m = &self.strains[p];
        SMatrix::from_columns(&m.each_ref().map(as_strain))
    }

    /// K_aa = sum v M C M
    pub fn stiffness(
        &self,
        element: &Reference<N, P>,
        c: impl Fn(usize) -> Matrix3<f64>,
    ) -> Matrix4<f64> {
        let mut k = Matrix4::zeros();
        for (p, point) in element.points.iter().enumerate() {
            let m = self.columns(p);
            k += m.transpose() * (c(p) * m) * point.volume;
        }
        k
    }

    /// Derivatives of the energy by alpha, sum v M:T and K_aa, this times a factor, at strains of the material.
    fn derivatives(
        &self,
        element: &Reference<N, P>,
        material: &impl StressAtPoints,
        enhanced: &[AddedStrain<2>; P],
        (strains, factor): (&[Strains; P], f64),
    ) -> (Vector4<f64>, Matrix4<f64>) {
        let s: [Matrix2<f64>; P] = stresses_at(material, strains);
        let mut tangents = [Tangent::default(); P];
        material.tangents_at(strains, &mut tangents);
        let (mut slope, mut stiffness) = (Vector4::zeros(), Matrix4::zeros());
        for (p, point) in element.points.iter().enumerate() {
            let [stress, _] = enhanced[p].conjugate(&s[p]);
            let stress = stress * point.volume;
            slope += Vector4::from_fn(|k, _| self.strains[p][k].dot(&stress));
            let own = self.strains[p].map(|m| Columns::new(&enhanced[p], m, None));
            let c = voigt(&tangents[p]) * factor;
            let at = (&enhanced[p], &s[p], &c);
            add_products(&own, &own, at, |k, l, value| {
                stiffness[(k, l)] += value * point.volume;
            });
        }
        (slope, stiffness)
    }

    /// alpha with which the energy is least at strains of the displacements, eq. (2.28), sought from a first one on. NaN
    /// where the local solution does not converge.
    fn least(
        &self,
        element: &Reference<N, P>,
        material: &impl StressAtPoints,
        (measured, first): (&Measured<P>, Vector4<f64>),
    ) -> Vector4<f64> {
        let last = LAST_STEP * largest(&measured.compatible) + f64::EPSILON;
        let derivatives = |alpha: &Vector4<f64>| {
            let e = self.enhanced(measured, alpha);
            let strains = e.map(|e| Strains::At(of_plane(&e.strain())));
            self.derivatives(element, material, &e, (&strains, 1.0))
        };
        let change = |from: &Vector4<f64>, to: &Vector4<f64>| {
            let none = [Matrix2::zeros(); P];
            self.energy_change(
                element,
                material,
                &[(measured, from), (measured, to)],
                &none,
            )
        };
        least(first, derivatives, change, last).unwrap_or(Vector4::from_element(f64::NAN))
    }

    /// alpha of the end of an increment with which the stresses of a viscosity do no work on the element's own strains,
    /// from the strains of the displacements of start and end. NaN where Newton's method does not converge.
    fn of_rates(
        &self,
        element: &Reference<N, P>,
        viscosity: &impl StressAtPoints,
        (e0, end): (&[Matrix2<f64>; P], &Measured<P>),
    ) -> Vector4<f64> {
        let e1 = &end.compatible;
        let change: [Matrix2<f64>; P] = std::array::from_fn(|p| e1[p] - e0[p]);
        let last = LAST_STEP * largest(&change) + f64::EPSILON * largest(e1) + f64::MIN_POSITIVE;
        let derivatives = |alpha: &Vector4<f64>| {
            let e = self.enhanced(end, alpha);
            let strains = std::array::from_fn(|p| between(&e0[p], &e[p].strain()));
            self.derivatives(element, viscosity, &e, (&strains, 0.5))
        };
        zero(derivatives, last).unwrap_or(Vector4::from_element(f64::NAN))
    }

    /// Stresses that do work on the strains of the displacements, T less the mean of R, from those of the material.
    fn stresses(
        &self,
        element: &Reference<N, P>,
        enhanced: &[AddedStrain<2>; P],
        of_material: &[Matrix2<f64>; P],
    ) -> [Matrix2<f64>; P] {
        let conjugate: [[Matrix2<f64>; 2]; P] =
            std::array::from_fn(|p| enhanced[p].conjugate(&of_material[p]));
        let mean = Self::mean_of(element, &conjugate.map(|[_, on_mean]| on_mean));
        conjugate.map(|[on_all, _]| on_all - mean)
    }

    /// sum v (W(E1) - W(E0)) between strains with alpha, the displacement strains of which change by `changes`. Its round-off
    /// is relative to the changes: the difference of the two strains has the round-off of the strains.
    fn energy_change(
        &self,
        element: &Reference<N, P>,
        material: &impl StressAtPoints,
        [(start, alpha0), (end, alpha1)]: &[(&Measured<P>, &Vector4<f64>); 2],
        changes: &[Matrix2<f64>; P],
    ) -> f64 {
        let (e0, e1) = (self.enhanced(start, alpha0), self.enhanced(end, alpha1));
        let strains: [Strains; P] =
            std::array::from_fn(|p| between(&e0[p].strain(), &e1[p].strain()));
        let s = stresses_at(material, &strains);
        let of_mean = Self::mean_of(element, changes);
        let of_point = |(p, point): (usize, &IntegrationPoint<N>)| {
            let at_point = changes[p] + self.strain(p, &(*alpha1 - *alpha0));
            let variation = Variation { at_point, of_mean };
            s[p].dot(&e1[p].change(&e0[p], &variation)) * point.volume
        };
        element.points.iter().enumerate().map(of_point).sum()
    }
}

/// The strains of a material from one to another.
fn between(e0: &Matrix2<f64>, e1: &Matrix2<f64>) -> Strains {
    Strains::between(&of_plane(e0), &of_plane(e1))
}

/// Stresses of a material at strains of all points (force/length^2).
fn stresses_at<const P: usize>(
    material: &impl StressAtPoints,
    strains: &[Strains; P],
) -> [Matrix2<f64>; P] {
    let mut s = [Symmetric::zeros(); P];
    material.stresses_at(strains, &mut s);
    s.map(|s| s.in_plane())
}

/// Strains of the displacements of all points, and their mean in the measure of a material.
struct Measured<const P: usize> {
    compatible: [Matrix2<f64>; P],
    mean: MeanStrain<2>,
}

/// The vector (xx, yy, 2 xy) of a strain.
fn as_strain(e: &Matrix2<f64>) -> Vector3<f64> {
    Vector3::new(e.m11, e.m22, 2.0 * e.m12)
}

/// Change of the strain of the material at a point by one displacement of the element or one alpha.
struct Columns {
    /// dE_g (xx, yy, 2 xy).
    first: Vector3<f64>,
    /// B of S : d²E_g.
    second: Matrix2<f64>,
}

impl Columns {
    /// From the change of E + M alpha at the point, and of the mean where the displacements change.
    fn new(
        enhanced: &AddedStrain<2>,
        at_point: Matrix2<f64>,
        of_mean: Option<Matrix2<f64>>,
    ) -> Self {
        let of_mean = of_mean.unwrap_or_default();
        let variation = Variation { at_point, of_mean };
        let [first, second] = enhanced.variation(&variation);
        Columns {
            first: as_strain(&first),
            second,
        }
    }
}

/// dE_g C dE_g + S : d²E_g at a point for each of some changes and each of others.
fn add_products(
    left: &[Columns],
    right: &[Columns],
    (enhanced, s, c): (&AddedStrain<2>, &Matrix2<f64>, &Matrix3<f64>),
    mut add: impl FnMut(usize, usize, f64),
) {
    for (l, right) in right.iter().enumerate() {
        let (stress, second) = (c * right.first, enhanced.second_stress(&right.second, s));
        for (k, left) in left.iter().enumerate() {
            add(k, l, left.first.dot(&stress) + left.second.dot(&second));
        }
    }
}

/// alpha of the variables after an increment, or alpha of the increment's own end where the former has not converged. An
/// alpha that is kept is never NaN.
pub(super) fn finite_or<const A: usize>(
    after: SVector<f64, A>,
    at_end: SVector<f64, A>,
) -> SVector<f64, A> {
    if after.iter().all(|a| a.is_finite()) {
        after
    } else {
        at_end
    }
}

/// Largest component of strains.
fn largest(e: &[Matrix2<f64>]) -> f64 {
    e.iter().fold(0.0, |most, e| most.max(e.amax()))
}

/// alpha of the last committed increment, from which the next is sought: the energy may have several minima, and the
/// element follows one.
fn committed<const P: usize>(material: &impl StressAtPoints) -> Vector4<f64> {
    match material.beyond(P) {
        [] => Vector4::zeros(),
        own => Vector4::from_column_slice(own),
    }
}

/// What a configuration gives at all points.
struct States<const P: usize> {
    states: [PointState; P],
    /// Strains at which the material has its tangent.
    enhanced: [AddedStrain<2>; P],
    /// The same for the material.
    tangent_at: [Strains; P],
    /// Its stresses there (force/length^2).
    of_material: [Matrix2<f64>; P],
}

/// Strains and stresses of all points, eq. (2.29) between two configurations.
fn states<const N: usize, const P: usize>(
    modes: &Modes<N, P>,
    element: &Reference<N, P>,
    material: &impl StressAtPoints,
    configuration: &Configuration<N>,
) -> States<P> {
    let u = match configuration {
        Configuration::At(u) => [u, u],
        Configuration::Between(u0, u1) => [u0, u1],
    };
    let [c0, c1] = u.map(|u| modes.compatible(element, u));
    let first = committed::<P>(material);
    let solved = |compatible: [Matrix2<f64>; P]| {
        let measured = modes.measured(element, material, compatible);
        let alpha = modes.least(element, material, (&measured, first));
        let enhanced = modes.enhanced(&measured, &alpha);
        (measured, alpha, enhanced)
    };
    let mut work = None;
    let at = |enhanced: &[AddedStrain<2>; P]| enhanced.map(|e| Strains::At(of_plane(&e.strain())));
    let (enhanced, strains, tangent_at): (_, [Strains; P], [Strains; P]);
    match configuration {
        Configuration::At(_) => {
            (_, _, enhanced) = solved(c1);
            strains = at(&enhanced);
            tangent_at = strains;
        }
        Configuration::Between(..) if material.is_viscous() => {
            let end = modes.measured(element, material, c1);
            let alpha = modes.of_rates(element, material, (&c0, &end));
            enhanced = modes.enhanced(&end, &alpha);
            strains = std::array::from_fn(|p| between(&c0[p], &enhanced[p].strain()));
            tangent_at = strains;
        }
        Configuration::Between(..) => {
            let (start, alpha0, e0) = solved(c0);
            let (end, alpha1, e1) = solved(c1);
            (_, _, enhanced) = solved(std::array::from_fn(|p| (c0[p] + c1[p]) / 2.0));
            strains = std::array::from_fn(|p| between(&e0[p].strain(), &e1[p].strain()));
            tangent_at = at(&enhanced);
            let changes = std::array::from_fn(|p| c1[p] - c0[p]);
            let ends = [(&start, &alpha0), (&end, &alpha1)];
            work = Some(modes.energy_change(element, material, &ends, &changes));
        }
    }
    let of_material = stresses_at(material, &tangent_at);
    let mut s = modes.stresses(element, &enhanced, &of_material);
    if let Some(mut f) = work {
        let mut squares = 0.0;
        for (p, point) in element.points.iter().enumerate() {
            let change = c1[p] - c0[p];
            f -= s[p].dot(&change) * point.volume;
            squares += change.norm_squared() * point.volume;
        }
        if (squares / element.volume()).sqrt() > f64::EPSILON {
            for p in 0..P {
                s[p] += (c1[p] - c0[p]) * (f / squares);
            }
        }
    }
    let states = std::array::from_fn(|p| {
        let point = &element.points[p];
        let [h0, h1] = u.map(|u| displacement_gradient(point, u));
        let h = (h0 + h1) / 2.0;
        let own = Matrix2::identity() + strains[p].end().in_plane() * 2.0;
        let least = smaller(determinant(&h), determinant(&h1));
        PointState {
            h,
            strains: strains[p],
            material_determinant: own.determinant().sqrt(),
            s: s[p],
            determinant: if s[p].m11.is_nan() { f64::NAN } else { least },
        }
    });
    States {
        states,
        enhanced,
        tangent_at,
        of_material,
    }
}

/// q of a configuration, eq. (2.26) (length).
fn hourglass<const N: usize, const P: usize>(
    modes: &Modes<N, P>,
    configuration: &Configuration<N>,
) -> Vector2<f64> {
    match configuration {
        Configuration::At(u) => u * modes.gamma,
        Configuration::Between(u0, u1) => (u0 + u1) / 2.0 * modes.gamma,
    }
}

/// int W dOmega with the element's own strains.
fn stored<const N: usize, const P: usize>(
    modes: &Modes<N, P>,
    element: &Reference<N, P>,
    material: &Committed,
    (measured, alpha): (&Measured<P>, &Vector4<f64>),
) -> f64 {
    let e = modes.enhanced(measured, alpha);
    let points = element.points.iter().enumerate();
    points
        .map(|(p, point)| material.energy_at(p, &of_plane(&e[p].strain())) * point.volume)
        .sum()
}

impl ElementFormulation for EnhancedStrain {
    /// Between two configurations D is what Phi has more than the stored energy: that of the points alone would have an
    /// error of first order in alpha. alpha is written behind the variables of the points.
    fn update<const N: usize, const P: usize>(
        element: &Reference<N, P>,
        material: &Committed,
        configuration: &Configuration<N>,
        updated: &mut [f64],
    ) -> f64 {
        let modes = Modes::new(element);
        let states = states(&modes, element, material, configuration).states;
        let (mut of_points, mut work) = (0.0, 0.0);
        for (p, (point, state)) in element.points.iter().zip(&states).enumerate() {
            of_points += material.update(p, &state.strains, updated) * point.volume;
            if let Strains::Between(change) = state.strains {
                let s = material.stress_at(p, &state.strains);
                work += s.contract::<false>(&change.change()) * point.volume;
            }
        }
        let (Configuration::Between(u0, u1), Some(own)) =
            (configuration, updated.len().checked_sub(STRAINS))
        else {
            return of_points;
        };
        let [c0, c1] =
            [u0, u1].map(|u| modes.measured(element, material, modes.compatible(element, u)));
        let first = committed::<P>(material);
        let mut alpha = modes.least(element, material, (&c1, first));
        let mut dissipated = 0.0;
        if !material.are_first_variables(&updated[..own]) {
            let after = material.with(updated);
            alpha = finite_or(modes.least(element, &after, (&c1, alpha)), alpha);
            let before = modes.least(element, material, (&c0, first));
            dissipated = work + stored(&modes, element, material, (&c0, &before))
                - stored(&modes, element, &after, (&c1, &alpha));
        }
        updated[own..].copy_from_slice(alpha.as_slice());
        dissipated
    }

    /// The stresses visited are those of the material.
    fn for_each_state<const N: usize, const P: usize>(
        element: &Reference<N, P>,
        material: &impl StressAtPoints,
        configuration: &Configuration<N>,
        mut visit: impl FnMut(usize, &PointState),
    ) {
        let states = states(&Modes::new(element), element, material, configuration);
        for (p, state) in states.states.iter().enumerate() {
            let s = states.of_material[p];
            visit(p, &PointState { s, ..*state });
        }
    }

    /// sum v (F S grad h_a - (grad h . S grad h) gamma_a q): the strain of eq. (2.27) has no |q|^2.
    fn internal_force<const N: usize, const P: usize>(
        element: &Reference<N, P>,
        material: &impl StressAtPoints,
        configuration: &Configuration<N>,
    ) -> (SMatrix<f64, 2, N>, f64) {
        let modes = Modes::new(element);
        let q = hourglass(&modes, configuration);
        let (mut force, mut determinant) = (SMatrix::<f64, 2, N>::zeros(), f64::INFINITY);
        let states = states(&modes, element, material, configuration).states;
        for ((point, state), slope) in element.points.iter().zip(&states).zip(&modes.slope) {
            let along_q = q * slope.dot(&(state.s * slope));
            force += (state.f() * state.s * point.gradient.transpose()
                - along_q * modes.gamma.transpose())
                * point.volume;
            determinant = smaller(determinant, state.determinant);
        }
        (force, determinant)
    }

    /// K = K_uu - K_ua K_aa^-1 K_au, eq. (2.30), at E_m in the energy-momentum form.
    fn tangent<const N: usize, const P: usize, const D: usize>(
        element: &Reference<N, P>,
        material: &impl StressAtPoints,
        configuration: &Configuration<N>,
    ) -> SMatrix<f64, D, D> {
        let modes = Modes::new(element);
        let states = states(&modes, element, material, configuration);
        let q = hourglass(&modes, configuration);
        let along_q = SMatrix::<f64, 1, D>::from_fn(|_, j| q[j % 2] * modes.gamma[j / 2]);
        let rows: [[Matrix2<f64>; D]; P] = std::array::from_fn(|p| {
            let (x, y) = (modes.slope[p].x, modes.slope[p].y);
            let b = strain_displacement::<N, D>(&element.points[p], &states.states[p].f())
                - Vector3::new(x * x, y * y, 2.0 * x * y) * along_q;
            let half = |j: usize| b[(2, j)] / 2.0;
            std::array::from_fn(|j| Matrix2::new(b[(0, j)], half(j), half(j), b[(1, j)]))
        });
        let of_mean: [Matrix2<f64>; D] =
            std::array::from_fn(|j| Modes::mean_of(element, &std::array::from_fn(|p| rows[p][j])));
        let (mut k, mut mixed) = (SMatrix::<f64, D, D>::zeros(), SMatrix::<f64, D, 4>::zeros());
        let mut stiffness = Matrix4::zeros();
        for (p, point) in element.points.iter().enumerate() {
            let (slope, state) = (modes.slope[p], &states.states[p]);
            let enhanced = &states.enhanced[p];
            let of_displacements: [Columns; D] =
                std::array::from_fn(|j| Columns::new(enhanced, rows[p][j], Some(of_mean[j])));
            let own = modes.strains[p].map(|m| Columns::new(enhanced, m, None));
            let c = voigt(&material.tangent_at(p, &states.tangent_at[p]));
            let at = (enhanced, &states.of_material[p], &c);
            let v = point.volume;
            add_products(&of_displacements, &of_displacements, at, |i, j, value| {
                k[(i, j)] += value * v;
            });
            add_products(&of_displacements, &own, at, |i, j, value| {
                mixed[(i, j)] += value * v;
            });
            add_products(&own, &own, at, |i, j, value| stiffness[(i, j)] += value * v);
            add_geometric(&mut k, point, &state.s);
            let stress = slope.dot(&(state.s * slope)) * v;
            for (a, b) in (0..N).flat_map(|a| (0..N).map(move |b| (a, b))) {
                for i in 0..2 {
                    k[(2 * a + i, 2 * b + i)] -= stress * modes.gamma[a] * modes.gamma[b];
                }
            }
        }
        match stiffness.try_inverse() {
            Some(inverse) => k - mixed * inverse * mixed.transpose(),
            None => k,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::formulation::evaluate;
    use crate::elements::testing::{check_compressed, displacements, laws, quad};
    use crate::materials::{Committed, Law, Plane, Plastic, SmallStrainModuli};

    #[test]
    fn elements_with_enhanced_strains_fulfil_what_all_have_to() {
        for law in laws() {
            quad().check_all::<EnhancedStrain, 8>(&law);
        }
        check_compressed::<EnhancedStrain>();
    }

    #[test]
    fn the_force_of_a_small_increment_has_the_round_off_of_the_force() {
        // The difference of two strains has the round-off of the strains: up to 1e-7 of the force.
        for law in laws() {
            for size in [1e-8, 1e-9, 1e-10] {
                let (u0, d) = (displacements(5), displacements(11) * size);
                let found =
                    quad().force::<EnhancedStrain>(&law, &Configuration::Between(u0, u0 + d));
                let exact = quad().force::<EnhancedStrain>(&law, &Configuration::At(u0 + d / 2.0));
                assert!((found - exact).norm() < 1e-13 * exact.norm(), "{size}");
            }
        }
    }

    #[test]
    fn a_metal_that_hardens_little_flows_in_all_points() {
        // the yield strain is 0.002, that of the element up to 0.1
        let metal = |kinematic: f64| Plastic {
            moduli: SmallStrainModuli {
                young: 1000.0,
                poisson: 0.3,
            },
            hardening: [[0.0, 2.0], [1.0, 2.1]].into(),
            kinematic,
        };
        let metals = [metal(0.0), metal(0.5)].map(Law::Plastic);
        let planes = [Plane::Strain, Plane::Stress];
        for law in (metals.iter()).flat_map(|law| planes.map(|plane| law.in_plane(plane))) {
            let z0 = vec![0.0; 4 * law.variables() + STRAINS];
            let material = Committed::new(&law, &z0);
            let force = |configuration: &Configuration<4>| {
                EnhancedStrain::internal_force::<4, 4>(&quad().element, &material, configuration).0
            };
            let u = displacements(5) * 0.5;
            let k = EnhancedStrain::tangent::<4, 4, 8>(
                &quad().element,
                &material,
                &Configuration::At(u),
            );
            for j in 0..8 {
                let mut du = SMatrix::<f64, 2, 4>::zeros();
                du[j] = 1e-6;
                let [more, less] = [u + du, u - du].map(|u| force(&Configuration::At(u)));
                for i in 0..8 {
                    let slope = (more[i] - less[i]) / 2e-6;
                    assert!((k[(i, j)] - slope).abs() < 1e-5 * k.norm(), "({i},{j})");
                }
            }
            // the work of an increment is the change of the stored energy and what is dissipated
            let (mut z, u0) = (z0.clone(), SMatrix::zeros());
            let increment = Configuration::Between(u0, u);
            let dissipated =
                EnhancedStrain::update::<4, 4>(&quad().element, &material, &increment, &mut z);
            let energy = |z: &[f64], u: &SMatrix<f64, 2, 4>| {
                evaluate::<EnhancedStrain, 4, 4>(&quad().element, &Committed::new(&law, z), u)
                    .energy
            };
            let work = force(&increment).dot(&u);
            let error = work - (energy(&z, &u) - energy(&z0, &u0)) - dissipated;
            assert!(dissipated > 0.02 * work, "{dissipated} {work}");
            assert!(error.abs() < 1e-12 * work, "{error}");
        }
    }
}
