//! What every formulation of an element has to fulfil, for its tests. Section 2 of docs/theory.md.

use nalgebra::{Matrix2, SMatrix, SVector};

use super::block::IntegratedShape;
use super::displacement::Displacement;
use super::enhanced_strain::alternating;
use super::formulation::{Configuration, ElementFormulation, Reference, evaluate};
use super::shapes::Quadrilateral;
use crate::materials::{Committed, Law, NeoHooke, Plane, PlaneLaw};

/// Corners of a distorted quadrilateral.
const CORNERS: [[f64; 2]; 4] = [[0.0, 0.0], [2.0, 0.3], [1.7, 1.9], [-0.2, 1.2]];

/// An element between its nodes.
pub(super) struct Sample<const N: usize, const P: usize> {
    pub x: SMatrix<f64, 2, N>,
    pub element: Reference<N, P>,
}

/// A distorted quadrilateral.
pub(super) fn quad() -> Sample<4, 4> {
    Sample::new::<Quadrilateral>(CORNERS)
}

/// Steel and rubber in plane strain and plane stress.
pub(super) fn laws() -> Vec<PlaneLaw> {
    let laws = [Law::elastic(1000.0, 0.3), rubber()];
    let planes = [Plane::Strain, Plane::Stress];
    let in_planes = |law: &Law| planes.map(|plane| law.in_plane(plane));
    laws.iter().flat_map(in_planes).collect()
}

/// A compressible neo-Hookean law.
pub(super) fn rubber() -> Law {
    Law::NeoHooke(NeoHooke {
        c10: 200.0,
        d1: 2e-3,
    })
}

/// Some displacements of moderate size, the same for every run.
pub(super) fn displacements<const N: usize>(seed: usize) -> SMatrix<f64, 2, N> {
    SMatrix::from_fn(|i, a| (((seed + 7 * a + 3 * i) * 37) % 23) as f64 / 100.0 - 0.11)
}

/// Difference quotient of a function of the displacements by the dof j, at `displacements(5)`.
fn quotient<T, const N: usize>(f: impl Fn(SMatrix<f64, 2, N>) -> T, j: usize) -> T
where
    T: std::ops::Sub<Output = T> + std::ops::Div<f64, Output = T>,
{
    let (u, h) = (displacements::<N>(5), 1e-6);
    let mut du = SMatrix::<f64, 2, N>::zeros();
    du[j] = h;
    (f(u + du) - f(u - du)) / (2.0 * h)
}

impl<const N: usize, const P: usize> Sample<N, P> {
    pub fn new<S: IntegratedShape<N, P>>(x: [[f64; 2]; N]) -> Self {
        let x = SMatrix::from_columns(&x.map(|p| p.into()));
        let element = S::reference(&S::map(&x, 0.5));
        Sample { x, element }
    }

    pub fn force<F: ElementFormulation>(
        &self,
        law: &PlaneLaw,
        configuration: &Configuration<N>,
    ) -> SMatrix<f64, 2, N> {
        F::internal_force::<N, P>(&self.element, &Committed::new(law, &[]), configuration).0
    }

    pub fn energy<F: ElementFormulation>(&self, law: &PlaneLaw, u: &SMatrix<f64, 2, N>) -> f64 {
        evaluate::<F, N, P>(&self.element, &Committed::new(law, &[]), u).energy
    }

    pub fn tangent<F: ElementFormulation, const D: usize>(
        &self,
        law: &PlaneLaw,
        u: SMatrix<f64, 2, N>,
    ) -> SMatrix<f64, D, D> {
        let material = Committed::new(law, &[]);
        F::tangent::<N, P, D>(&self.element, &material, &Configuration::At(u))
    }

    /// All of the following.
    pub fn check_all<F: ElementFormulation, const D: usize>(&self, law: &PlaneLaw) {
        self.check_derivatives::<F, D>(law);
        self.check_work::<F>(law);
        self.check_rotation::<F>(law);
        self.check_homogeneous::<F>(law);
        self.check_rank::<F, D>(law);
    }

    /// The force is the derivative of the strain energy, and the tangent that of the force.
    pub fn check_derivatives<F: ElementFormulation, const D: usize>(&self, law: &PlaneLaw) {
        let found = self.force::<F>(law, &Configuration::At(displacements(5)));
        let k = self.tangent::<F, D>(law, displacements(5));
        for j in 0..D {
            let slope = quotient(|u| self.energy::<F>(law, &u), j);
            assert!((found[j] - slope).abs() < 1e-8 * found.norm(), "{j}");
            let column = quotient(|u| self.force::<F>(law, &Configuration::At(u)), j);
            for i in 0..D {
                let error = (k[(i, j)] - column[i]).abs();
                assert!(error < 1e-8 * k.norm(), "({i},{j})");
            }
        }
        assert!((k - k.transpose()).norm() < 1e-14 * k.norm());
    }

    /// The force between two configurations does the work of the strain energy, and has neither resultant nor moment.
    pub fn check_work<F: ElementFormulation>(&self, law: &PlaneLaw) {
        for size in [1.0, 1e-3, 1e-6] {
            let u0 = displacements(5) * 0.3;
            let u1 = u0 + displacements(11) * (0.3 * size);
            let force = self.force::<F>(law, &Configuration::Between(u0, u1));
            let [before, after] = [u0, u1].map(|u| self.energy::<F>(law, &u));
            let error = force.dot(&(u1 - u0)) - (after - before);
            assert!(error.abs() < 1e-13 * after, "{size}: {error}");
            let x = self.x + (u0 + u1) / 2.0;
            let moments = (0..N).map(|a| x[(0, a)] * force[(1, a)] - x[(1, a)] * force[(0, a)]);
            assert!(force.column_sum().norm() < 1e-13 * force.norm());
            assert!(moments.sum::<f64>().abs() < 1e-13 * force.norm());
        }
    }

    /// A rigid rotation gives no force and no change of volume.
    pub fn check_rotation<F: ElementFormulation>(&self, law: &PlaneLaw) {
        for degrees in (0..=360).step_by(15) {
            let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
            let u = Matrix2::new(cos, -sin, sin, cos) * self.x - self.x;
            let material = Committed::new(law, &[]);
            let (force, determinant) =
                F::internal_force::<N, P>(&self.element, &material, &Configuration::At(u));
            assert!(force.amax() < 1e-11 * 1000.0, "{degrees}: {}", force.amax());
            assert!((determinant - 1.0).abs() < 1e-14, "{degrees}");
        }
    }

    /// A homogeneous deformation has the energy, stress and force of elements without further strains (patch test).
    fn check_homogeneous<F: ElementFormulation>(&self, law: &PlaneLaw) {
        let u = Matrix2::new(0.2, 0.3, 0.1, -0.1) * self.x;
        let material = Committed::new(law, &[]);
        let found = evaluate::<F, N, P>(&self.element, &material, &u);
        let exact = evaluate::<Displacement, N, P>(&self.element, &material, &u);
        assert!((found.energy - exact.energy).abs() < 1e-13 * exact.energy);
        assert!((found.across - exact.across).abs() <= 1e-13 * exact.across.abs());
        for (a, b) in found.stress.iter().zip(exact.stress) {
            assert!((a - b).abs() < 1e-12 * exact.von_mises());
        }
        let at = Configuration::At(u);
        let exact = self.force::<Displacement>(law, &at);
        assert!((self.force::<F>(law, &at) - exact).norm() < 1e-12 * exact.norm());
    }

    /// Only the three rigid motions have no stiffness.
    fn check_rank<F: ElementFormulation, const D: usize>(&self, law: &PlaneLaw) {
        let k = self.tangent::<F, D>(law, SMatrix::zeros());
        // nalgebra asks for bounds that a generic size cannot show
        let values =
            nalgebra::DMatrix::from_iterator(D, D, k.iter().copied()).symmetric_eigenvalues();
        let zero = values.iter().filter(|v| v.abs() < 1e-12 * k.norm());
        assert_eq!(zero.count(), 3, "{values}");
        assert!(values.iter().all(|&v| v > -1e-12 * k.norm()));
    }
}

/// A square of rubber that is compressed to a fifth resists its hourglass modes.
pub(super) fn check_compressed<F: ElementFormulation>() {
    let law = rubber().in_plane(Plane::Strain);
    let square = Sample::new::<Quadrilateral>([[0., 0.], [1., 0.], [1., 1.], [0., 1.]]);
    for percent in (20..=95).step_by(5) {
        let u = Matrix2::new(0.0, 0.0, 0.0, f64::from(percent) / 100.0 - 1.0) * square.x;
        let k = square.tangent::<F, 8>(&law, u);
        for i in 0..2 {
            let mode = SVector::<f64, 8>::from_fn(|j, _| match j % 2 == i {
                true => alternating(j / 2),
                false => 0.0,
            });
            assert!(mode.dot(&(k * mode)) > 0.0, "{percent} {i}");
        }
    }
}
