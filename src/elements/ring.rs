//! Rings: elements of bodies of revolution around the axis x = 0 that move without torsion. The section of a ring is an
//! element of the plane; its strain around the axis is that of the radial displacement. Section 2 of docs/theory.md,
//! Bodies of revolution.

use std::f64::consts::TAU;

use nalgebra::{Matrix2, Matrix4, Vector2, Vector4};

use super::block::Shape;
use super::formulation::{ElementResult, PointResult, ShapeFunctions, green_lagrange, smaller};
use super::shapes::{QuadraticTriangle, Quadrilateral, ReducedSerendipity, Serendipity, Triangle};
use super::solid::{ElementMatrix, ElementVector, MAX_DOFS, MAX_NODES, Motion, take_positive_part};
use crate::materials::{Committed, RingStressAtPoints, Strains, Symmetric, contract};
use crate::model::{self, ElementType, Formulation, Nodes};

/// Shape functions, gradients and weights of a ring at some points.
#[derive(Debug, Clone)]
struct Points {
    nodes: usize,
    /// Shape functions h_a.
    values: Vec<[f64; MAX_NODES]>,
    /// Natural derivatives dh_a/dr_i.
    natural: Vec<[[f64; 2]; MAX_NODES]>,
    /// Quadrature weights.
    weights: Vec<f64>,
}

impl Points {
    fn new<const N: usize, const P: usize>(functions: &ShapeFunctions<N, P>) -> Self {
        let values = functions.values.iter().map(|all| {
            let mut padded = [0.0; MAX_NODES];
            padded[..N].copy_from_slice(all);
            padded
        });
        let natural = functions.natural.iter().map(|all| {
            let mut padded = [[0.0; 2]; MAX_NODES];
            padded[..N].copy_from_slice(all);
            padded
        });
        Points {
            nodes: N,
            values: values.collect(),
            natural: natural.collect(),
            weights: functions.weights.to_vec(),
        }
    }

    /// Those of stress and internal force of an element type.
    fn of_stress(element_type: ElementType) -> Self {
        match (element_type.shape, element_type.formulation) {
            (model::Shape::Tri3, _) => Points::new(&Triangle::FUNCTIONS),
            (model::Shape::Quad4, _) => Points::new(&Quadrilateral::FUNCTIONS),
            (model::Shape::Tri6, _) => Points::new(&QuadraticTriangle::FUNCTIONS),
            (model::Shape::Quad8, Formulation::Reduced) => {
                Points::new(&ReducedSerendipity::FUNCTIONS)
            }
            (model::Shape::Quad8, _) => Points::new(&Serendipity::FUNCTIONS),
        }
    }

    /// Those of mass and body force: of a degree higher by that of the radius than in the plane.
    fn of_mass(shape: model::Shape) -> Self {
        match shape {
            model::Shape::Tri3 => Points::new(&Triangle::RING_MASS),
            model::Shape::Quad4 => Points::new(&Quadrilateral::RING_MASS),
            model::Shape::Tri6 => Points::new(&QuadraticTriangle::MASS),
            model::Shape::Quad8 => Points::new(&Serendipity::FUNCTIONS),
        }
    }

    /// The points of a section with nodes at `x`.
    fn map(&self, x: &[[f64; 2]]) -> Vec<Point> {
        let point = |p: usize| {
            let natural = &self.natural[p][..self.nodes];
            let mut j = Matrix2::zeros();
            for (x, h) in x.iter().zip(natural) {
                j += Vector2::from(*x) * Vector2::from(*h).transpose();
            }
            let det = j.determinant();
            let inverse = Matrix2::new(j.m22, -j.m12, -j.m21, j.m11) / det;
            let shape = self.values[p];
            let radius: f64 = x.iter().zip(&shape).map(|(x, h)| x[0] * h).sum();
            let (mut gradient, mut around) = ([Vector2::zeros(); MAX_NODES], [0.0; MAX_NODES]);
            for (a, h) in natural.iter().enumerate() {
                gradient[a] = inverse.tr_mul(&Vector2::from(*h));
                around[a] = shape[a] / radius;
            }
            Point {
                shape,
                gradient,
                around,
                volume: TAU * radius * det * self.weights[p],
            }
        };
        (0..self.weights.len()).map(point).collect()
    }
}

/// One integration point in the reference configuration; the first entries belong to the nodes of the element.
#[derive(Debug, Clone)]
struct Point {
    /// Shape functions h_a.
    shape: [f64; MAX_NODES],
    /// Gradients dh_a/dX (1/length).
    gradient: [Vector2<f64>; MAX_NODES],
    /// h_a/R (1/length).
    around: [f64; MAX_NODES],
    /// Weight 2 pi R det(dX/dr) times the quadrature weight, eq. (2.32) (length^3).
    volume: f64,
}

/// Displacement gradient at a point.
#[derive(Clone, Copy)]
struct Gradient {
    /// H = du/dX in the section.
    h: Matrix2<f64>,
    /// h = u_r/R around the axis.
    around: f64,
}

impl Gradient {
    /// E = (H + H^T + H^T H)/2 and E_33 = h + h²/2, eq. (2.2) and eq. (2.31).
    fn strain(&self) -> Symmetric {
        let e = green_lagrange(&self.h);
        let around = self.around + self.around * self.around / 2.0;
        Vector4::new(e.m11, e.m22, around, e.m12)
    }

    /// det F in the section, or its product with the stretch around the axis where one of both is not positive.
    fn determinant(&self) -> f64 {
        let of_section = (Matrix2::identity() + self.h).determinant();
        smaller(of_section, of_section * (1.0 + self.around))
    }
}

/// Deformation at a point of a ring: between two configurations that halfway.
struct State {
    gradient: Gradient,
    strains: Strains<Symmetric>,
    /// Smallest determinant met.
    determinant: f64,
}

/// A ring of an element type in the displacement formulation.
#[derive(Debug, Clone)]
pub(super) struct Ring {
    nodes: Nodes,
    points: Vec<Point>,
}

impl Ring {
    /// The ring between nodes at the coordinates `x` of all nodes.
    pub fn new(element: &model::Element, x: &[[f64; 2]]) -> Self {
        let own: Vec<[f64; 2]> = element.nodes.iter().map(|&node| x[node]).collect();
        let element_type = element.element_type;
        Ring {
            nodes: element.nodes.clone(),
            points: Points::of_stress(element_type).map(&own),
        }
    }

    /// Node indices, counter-clockwise.
    pub fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    /// Number of integration points.
    pub fn points(&self) -> usize {
        self.points.len()
    }

    /// Internal force with the smallest determinant of the deformation gradient at the points:
    ///
    /// ```text
    /// F_a = sum over the points of v (F S dh_a/dX + (1 + h) S_33 h_a/R e_r)      eq. (2.33)
    /// ```
    pub fn force(
        &self,
        material: &impl RingStressAtPoints,
        motion: Motion,
    ) -> (ElementVector, f64) {
        let mut force = [0.0; MAX_DOFS];
        let mut determinant = f64::INFINITY;
        for (p, point) in self.points.iter().enumerate() {
            let state = self.state(point, motion);
            let s = material.ring_stress(p, &state.strains);
            let piola = state.f() * section(&s) * point.volume;
            let hoop = state.stretch_around() * s.z * point.volume;
            for a in 0..self.nodes.len() {
                let of_node = piola * point.gradient[a];
                force[2 * a] += of_node.x + hoop * point.around[a];
                force[2 * a + 1] += of_node.y;
            }
            determinant = smaller(determinant, state.determinant);
        }
        (force, determinant)
    }

    /// Tangent, D x D (force/length), symmetric: as that of [`super::displacement::Displacement`] with the row
    /// (1 + h) h_a/R of B_L and the part S_33 h_a h_b/R² of the stress around the axis, eq. (2.34).
    pub fn tangent(&self, material: &impl RingStressAtPoints, motion: Motion) -> ElementMatrix {
        let (n, mut k) = (self.nodes.len(), [0.0; MAX_DOFS * MAX_DOFS]);
        let mut b = [Vector4::zeros(); MAX_DOFS];
        for (p, point) in self.points.iter().enumerate() {
            let state = self.state(point, motion);
            let s = material.ring_stress(p, &state.strains);
            let c: Matrix4<f64> = material.ring_tangent(p, &state.strains) * point.volume;
            let (f, around) = (state.f(), state.stretch_around());
            for a in 0..n {
                let (g, ring) = (point.gradient[a], around * point.around[a]);
                b[2 * a] = Vector4::new(f.m11 * g.x, f.m12 * g.y, ring, f.m11 * g.y + f.m12 * g.x);
                b[2 * a + 1] =
                    Vector4::new(f.m21 * g.x, f.m22 * g.y, 0.0, f.m21 * g.y + f.m22 * g.x);
            }
            let stressed = section(&s) * point.volume;
            for col in 0..2 * n {
                let cb = c * b[col];
                for row in 0..2 * n {
                    k[col * 2 * n + row] += b[row].dot(&cb);
                }
                let (a, i) = (col / 2, col % 2);
                let sg = stressed * point.gradient[a];
                for other in 0..n {
                    let mut geometric = point.gradient[other].dot(&sg);
                    if i == 0 {
                        geometric += s.z * point.around[a] * point.around[other] * point.volume;
                    }
                    k[col * 2 * n + 2 * other + i] += geometric;
                }
            }
        }
        k
    }

    /// Positive part of the tangent.
    pub fn positive_tangent(
        &self,
        material: &impl RingStressAtPoints,
        motion: Motion,
    ) -> ElementMatrix {
        let (d, mut k) = (2 * self.nodes.len(), self.tangent(material, motion));
        take_positive_part(&mut k[..d * d], d);
        k
    }

    /// Work of the stress on the strains of a motion from its start to its end (force length).
    pub fn work(&self, material: &impl RingStressAtPoints, motion: Motion) -> f64 {
        let of_point = |(p, point): (usize, &Point)| {
            let strains = self.state(point, motion).strains;
            let s = material.ring_stress(p, &strains);
            match strains {
                Strains::At(_) => 0.0,
                Strains::Between(e0, e1) => contract(&s, &(e1 - e0)) * point.volume,
            }
        };
        self.points.iter().enumerate().map(of_point).sum()
    }

    /// Strain energy, stress and strain at displacements `u`; the stress around the axis is that across the plane:
    ///
    /// ```text
    /// sigma = F S F^T/J,  sigma_33 = (1 + h)² S_33/J,  J = det F (1 + h)
    /// ```
    pub fn evaluate(&self, material: &Committed, u: &[f64]) -> ElementResult {
        let of_point = |(p, point): (usize, &Point)| {
            let state = self.state(point, Motion::at(u, &[]));
            let (e, f, stretch) = (state.strains.end(), state.f(), state.stretch_around());
            let s = material.ring_stress(p, &state.strains);
            let determinant = f.determinant();
            let result = PointResult {
                energy: material.ring_energy(p, e),
                sigma: f * section(&s) * f.transpose() / (determinant * stretch),
                across: s.z * stretch / determinant,
                strain: section(e),
                strain_around: e.z,
                plastic_strain: material.plastic_strain(p),
            };
            (result, point.volume)
        };
        ElementResult::of_points(self.points.iter().enumerate().map(of_point))
    }

    /// Internal variables at the end of a motion, written to `updated`, and the energy dissipated on the way to them
    /// (force length).
    pub fn update(&self, material: &Committed, motion: Motion, updated: &mut [f64]) -> f64 {
        let mut dissipated = 0.0;
        for (p, point) in self.points.iter().enumerate() {
            let strains = self.state(point, motion).strains;
            dissipated += material.ring_update(p, &strains, updated) * point.volume;
        }
        dissipated
    }

    /// H and h of displacements at a point.
    fn gradient(&self, point: &Point, u: &[f64]) -> Gradient {
        let (mut h, mut around) = (Matrix2::zeros(), 0.0);
        for (a, &node) in self.nodes.iter().enumerate() {
            let own = Vector2::new(u[2 * node], u[2 * node + 1]);
            h += own * point.gradient[a].transpose();
            around += own.x * point.around[a];
        }
        Gradient { h, around }
    }

    fn state(&self, point: &Point, motion: Motion) -> State {
        let end = self.gradient(point, motion.end);
        let Some(start) = motion.start else {
            return State {
                gradient: end,
                strains: Strains::At(end.strain()),
                determinant: end.determinant(),
            };
        };
        let start = self.gradient(point, start);
        let mid = Gradient {
            h: (start.h + end.h) / 2.0,
            around: (start.around + end.around) / 2.0,
        };
        State {
            gradient: mid,
            strains: Strains::Between(start.strain(), end.strain()),
            determinant: smaller(mid.determinant(), end.determinant()),
        }
    }
}

impl State {
    /// Deformation gradient F in the section.
    fn f(&self) -> Matrix2<f64> {
        Matrix2::identity() + self.gradient.h
    }

    /// Stretch 1 + h around the axis.
    fn stretch_around(&self) -> f64 {
        1.0 + self.gradient.around
    }
}

/// The part of a symmetric tensor in the section.
fn section(s: &Symmetric) -> Matrix2<f64> {
    Matrix2::new(s.x, s.w, s.w, s.y)
}

/// int rho h_a h_b dOmega of a ring, n x n column by column (mass).
pub(super) fn mass(shape: model::Shape, x: &[[f64; 2]], density: f64) -> Vec<f64> {
    let (n, points) = (x.len(), Points::of_mass(shape).map(x));
    let entry = |k: usize| {
        let (a, b) = (k % n, k / n);
        let terms = points.iter().map(|p| p.shape[a] * p.shape[b] * p.volume);
        density * terms.sum::<f64>()
    };
    (0..n * n).map(entry).collect()
}

/// int h_a dOmega of a ring (length^3).
pub(super) fn nodal_volumes(shape: model::Shape, x: &[[f64; 2]]) -> [f64; MAX_NODES] {
    let points = Points::of_mass(shape).map(x);
    let of_node = |a: usize| points.iter().map(|p| p.shape[a] * p.volume).sum();
    std::array::from_fn(of_node)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::shapes::tests::{QUAD8, TRI6};
    use crate::materials::{Law, NeoHooke, Plane, Viscosity};
    use crate::model::{Element, Mesh};

    /// Rings of all types between distorted nodes off the axis, with their nodes.
    fn rings() -> Vec<(Ring, Mesh)> {
        let quad = vec![[0.0, 0.0], [2.0, 0.3], [1.7, 1.9], [-0.2, 1.2]];
        let tri = vec![[0.1, 0.0], [2.0, 0.3], [0.7, 1.9]];
        let types = ElementType::NAMED.into_iter().filter(|t| t.is_ring());
        let ring = |element_type: ElementType| {
            let mut x = match element_type.shape {
                model::Shape::Tri3 => tri.clone(),
                model::Shape::Quad4 => quad.clone(),
                model::Shape::Tri6 => TRI6.to_vec(),
                model::Shape::Quad8 => QUAD8.to_vec(),
            };
            x.iter_mut().for_each(|x| x[0] += 0.5);
            let element = Element {
                label: 1,
                element_type,
                nodes: (0..x.len()).collect(),
                section: 0,
            };
            let ring = Ring::new(&element, &x);
            let mesh = Mesh {
                node_labels: (1..).take(x.len()).collect(),
                coordinates: x,
                elements: vec![element],
            };
            (ring, mesh)
        };
        types.map(ring).collect()
    }

    fn laws() -> [Law; 2] {
        let rubber = NeoHooke {
            c10: 200.0,
            d1: 2e-3,
        };
        [Law::elastic(1000.0, 0.3), Law::NeoHooke(rubber)]
    }

    fn displacements(n: usize, seed: usize) -> Vec<f64> {
        let value = |i: usize| (((seed + 7 * i) * 37) % 23) as f64 / 300.0 - 0.037;
        (0..2 * n).map(value).collect()
    }

    #[test]
    fn volume_and_mass_are_those_of_the_ring() {
        for (ring, mesh) in rings() {
            let volume = mesh.volume(&mesh.elements[0], 1.0);
            let shape = mesh.elements[0].element_type.shape;
            let of_points: f64 = ring.points.iter().map(|p| p.volume).sum();
            let shares = nodal_volumes(shape, &mesh.coordinates);
            let of_mass = mass(shape, &mesh.coordinates, 3.0).iter().sum::<f64>() / 3.0;
            let is_curved = mesh.elements[0].element_type.is_quadratic();
            // the points of stress are exact where the sides are straight
            if !is_curved || ring.points() == 9 {
                assert!((of_points - volume).abs() < 1e-13 * volume);
            }
            let of_shares: f64 = shares.iter().sum();
            for found in [of_shares, of_mass] {
                assert!((found - volume).abs() < 1e-13 * volume, "{found} {volume}");
            }
        }
    }

    #[test]
    fn force_is_the_derivative_of_the_energy_and_the_tangent_that_of_the_force() {
        let h = 1e-6;
        for (ring, _) in rings() {
            for law in laws() {
                let law = law.in_plane(Plane::Revolution);
                let c = Committed::new(&law, &[]);
                let (n, u) = (ring.nodes.len(), displacements(ring.nodes.len(), 5));
                let (force, det) = ring.force(&c, Motion::at(&u, &[]));
                assert!(det > 0.0);
                let k = ring.tangent(&c, Motion::at(&u, &[]));
                let size = force.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
                let stiff = k.iter().fold(0.0, |most: f64, k| most.max(k.abs()));
                for j in 0..2 * n {
                    let moved = |by: f64| {
                        let mut u = u.clone();
                        u[j] += by;
                        u
                    };
                    let (ahead, behind) = (moved(h), moved(-h));
                    let energy = |u: &[f64]| ring.evaluate(&c, u).energy;
                    let slope = (energy(&ahead) - energy(&behind)) / (2.0 * h);
                    assert!((slope - force[j]).abs() < 1e-7 * size);
                    let at = |u: &[f64]| ring.force(&c, Motion::at(u, &[])).0;
                    let (ahead, behind) = (at(&ahead), at(&behind));
                    for i in 0..2 * n {
                        let slope = (ahead[i] - behind[i]) / (2.0 * h);
                        assert!((slope - k[j * 2 * n + i]).abs() < 1e-7 * stiff, "({i},{j})");
                    }
                }
            }
        }
    }

    #[test]
    fn between_two_configurations_the_force_does_the_work_of_the_energy() {
        for (ring, _) in rings() {
            for law in laws() {
                let law = law.in_plane(Plane::Revolution);
                let c = Committed::new(&law, &[]);
                let n = ring.nodes.len();
                let (u0, u1) = (displacements(n, 5), displacements(n, 11));
                let between = Motion {
                    start: Some(&u0),
                    ..Motion::at(&u1, &[])
                };
                let (force, _) = ring.force(&c, between);
                let work: f64 = (0..2 * n).map(|i| force[i] * (u1[i] - u0[i])).sum();
                let energy = |u: &[f64]| ring.evaluate(&c, u).energy;
                let change = energy(&u1) - energy(&u0);
                let size = force.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
                assert!((work - change).abs() < 1e-13 * size, "{work} {change}");
                assert!((ring.work(&c, between) - change).abs() < 1e-13 * size);
                // along the axis the forces have no resultant
                let axial: f64 = (0..n).map(|a| force[2 * a + 1]).sum();
                assert!(axial.abs() < 1e-13 * size);
            }
        }
    }

    #[test]
    fn viscosity_dissipates_what_its_force_takes() {
        for (ring, _) in rings() {
            let moduli = laws()[0].small_strain();
            let v = Viscosity::new(0.3, moduli, Plane::Revolution);
            let n = ring.nodes.len();
            let (u0, u1) = (displacements(n, 5), displacements(n, 11));
            let between = Motion {
                start: Some(&u0),
                ..Motion::at(&u1, &[])
            };
            let (force, _) = ring.force(&v, between);
            let work: f64 = (0..2 * n).map(|i| force[i] * (u1[i] - u0[i])).sum();
            assert!(work > 0.0);
            assert!((ring.work(&v, between) - work).abs() < 1e-13 * work);
        }
    }

    #[test]
    fn a_ring_beyond_the_axis_or_folded_is_turned_inside_out() {
        let (ring, mesh) = &rings()[1];
        let law = laws()[0].in_plane(Plane::Revolution);
        let c = Committed::new(&law, &[]);
        // mirrored at the axis and along it: det F = 1 in the section
        let u: Vec<f64> = mesh
            .coordinates
            .iter()
            .flat_map(|x| x.map(|x| -2.0 * x))
            .collect();
        assert!(ring.force(&c, Motion::at(&u, &[])).1 < 0.0);
        // pushed through the axis
        let u = [-5.0, 0.0].repeat(4);
        assert!(ring.force(&c, Motion::at(&u, &[])).1 < 0.0);
    }

    #[test]
    fn a_uniform_stretch_has_the_stress_of_the_law() {
        // F = diag(1.1, 1.1, 1.1): neo-Hooke, sigma = 2 (J - 1)/D1 I
        let law = laws()[1].in_plane(Plane::Revolution);
        let c = Committed::new(&law, &[]);
        for (ring, mesh) in rings() {
            let u: Vec<f64> = mesh
                .coordinates
                .iter()
                .flat_map(|x| x.map(|x| 0.1 * x))
                .collect();
            let result = ring.evaluate(&c, &u);
            let p = 2.0 * (1.1_f64.powi(3) - 1.0) / 2e-3;
            for stress in [result.stress[0], result.stress[1], result.across] {
                assert!((stress - p).abs() < 1e-11 * p, "{stress} {p}");
            }
            assert!(result.stress[2].abs() < 1e-11 * p);
            assert!((result.principal_strain - 0.105).abs() < 1e-13);
        }
    }
}
