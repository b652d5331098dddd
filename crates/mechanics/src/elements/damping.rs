//! Mass-proportional damping of an element: impulse in an increment, damping matrix. Damping by viscosity is a sweep
//! over the element's chunk. See docs/theory/time.md, Damping.

use super::MAX_DOFS;
use super::motion::{ElementMatrix, ElementVector, Increment, Motion, NO_MATRIX, dofs};

/// Mass-proportional damping of an element.
pub(super) struct MassDamping {
    /// Element (index).
    pub element: usize,
    /// Damping matrix alpha M per direction, n x n column by column (mass/time).
    pub mass: Vec<f64>,
}

impl MassDamping {
    /// Impulse alpha M d at the nodes of the element for a displacement increment d, eq. (4.16).
    pub fn impulse(&self, nodes: &[usize], d: &[f64]) -> ElementVector {
        let mut impulse = [0.0; MAX_DOFS];
        for (a, b, m) in self.entries(nodes.len()) {
            for i in 0..2 {
                impulse[2 * a + i] += m * d[2 * nodes[b] + i];
            }
        }
        impulse
    }

    /// Work d.(alpha M d) of the impulse on the displacement increment d, eq. (4.18).
    pub fn work(&self, nodes: &[usize], d: &[f64]) -> f64 {
        let impulse = self.impulse(nodes, d);
        let terms = dofs(nodes).zip(impulse);
        terms.map(|(dof, p)| p * d[dof]).sum()
    }

    /// Damping matrix alpha M for `n` nodes, eq. (4.19).
    pub fn matrix(&self, n: usize) -> ElementMatrix {
        let mut matrix = NO_MATRIX;
        for (a, b, m) in self.entries(n) {
            for i in 0..2 {
                matrix[(2 * b + i) * 2 * n + 2 * a + i] += m;
            }
        }
        matrix
    }

    /// Entries of the damping matrix alpha M for `n` nodes: row, column, value.
    fn entries(&self, n: usize) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        let entries = self.mass.iter().enumerate();
        entries.map(move |(k, &m)| (k % n, k / n, m))
    }
}

/// The motion in which viscosity acts: the motion of the increment, in every integration scheme.
pub(super) fn between([u0, u1]: Increment) -> Motion {
    Motion {
        start: Some(u0),
        ..Motion::at(u1, &[])
    }
}

#[cfg(test)]
mod tests {
    use crate::elements::{Elements, TangentPart};
    use crate::materials::yielding::Yielding;
    use crate::materials::{Law, NeoHooke};
    use crate::model::{Damping, Element, ElementType, Formulation, Material, Model, Section};

    const DAMPING: Damping = Damping {
        alpha: 0.7,
        beta: 0.3,
    };
    /// Reference positions of five nodes.
    const X: [[f64; 2]; 5] = [[0.0, 0.0], [1.0, 0.1], [1.2, 1.1], [-0.1, 0.9], [0.6, 1.8]];
    const DOFS: usize = 2 * X.len();

    /// A quadrilateral with a triangle on its upper side.
    fn elements(law: Law, quad: ElementType, damping: Damping) -> Elements {
        let mut model = Model::default();
        let name = "M".into();
        model.materials.push(Material {
            name,
            law,
            density: 1.5,
            damping,
            expansion: None,
        });
        model.sections.push(Section {
            material: 0,
            thickness: 2.0,
        });
        model.mesh.coordinates = X.to_vec();
        let tri = ElementType {
            plane: quad.plane,
            ..ElementType::CPE3
        };
        for (element_type, nodes) in [(quad, vec![0, 1, 2, 3]), (tri, vec![3, 2, 4])] {
            model.mesh.elements.push(Element {
                label: 1,
                element_type,
                nodes: nodes.into(),
                section: 0,
            });
        }
        Elements::new(&model)
    }

    /// Elements of all laws in all formulations available for these laws.
    fn all(damping: Damping) -> Vec<Elements> {
        let mean = ElementType {
            formulation: Formulation::MeanDilatation,
            ..ElementType::CPE4
        };
        let elastic = Law::elastic(100.0, 0.3);
        let rubber = Law::NeoHooke(NeoHooke {
            c10: 20.0,
            d1: 0.02,
        });
        let yielding = Law::Yielding(Yielding {
            g: 50.0,
            y: 0.02,
            r: 0.3,
            c: 0.05,
        });
        let cases = [
            (elastic.clone(), ElementType::CPS4),
            (elastic.clone(), ElementType::CPE4),
            (elastic, mean),
            (rubber.clone(), ElementType::CPE4),
            (rubber, mean),
            (yielding, ElementType::CPE4),
        ];
        let elements = cases.map(|(law, quad)| elements(law, quad, damping));
        elements.into()
    }

    fn wave(scale: f64, k: f64) -> Vec<f64> {
        (0..DOFS).map(|i| scale * (k * i as f64).sin()).collect()
    }

    /// The displacements `u` of the nodes, followed by a rotation of all nodes by an angle.
    fn turned(u: &[f64], angle: f64) -> Vec<f64> {
        let (sin, cos) = angle.sin_cos();
        let turn = |n: usize| {
            let [x, y] = [X[n][0] + u[2 * n], X[n][1] + u[2 * n + 1]];
            [cos * x - sin * y - X[n][0], sin * x + cos * y - X[n][1]]
        };
        (0..X.len()).flat_map(turn).collect()
    }

    fn impulse(elements: &Elements, u0: &[f64], u1: &[f64]) -> Vec<f64> {
        let d: Vec<f64> = u1.iter().zip(u0).map(|(u1, u0)| u1 - u0).collect();
        elements.damping_force([u0, u1], &d, 1.0)
    }

    fn norm(v: &[f64]) -> f64 {
        v.iter().map(|x| x * x).sum::<f64>().sqrt()
    }

    #[test]
    fn what_it_dissipates_is_the_work_of_its_force_and_never_negative() {
        for elements in all(DAMPING) {
            for k in 1..20 {
                let (u0, u1) = (wave(0.1, f64::from(k)), wave(0.12, 0.37 * f64::from(k)));
                let d: Vec<f64> = u1.iter().zip(&u0).map(|(u1, u0)| u1 - u0).collect();
                let impulse = impulse(&elements, &u0, &u1);
                let work: f64 = impulse.iter().zip(&d).map(|(p, d)| p * d).sum();
                let dissipated = elements.damping_dissipation([&u0, &u1], &d, 0.5);
                assert!(dissipated > 0.0);
                assert!((work - dissipated * 0.5).abs() < 1e-13 * work, "{work}");
            }
        }
    }

    #[test]
    fn viscosity_keeps_momenta_and_is_silent_in_rigid_motion() {
        let viscous = Damping {
            alpha: 0.0,
            ..DAMPING
        };
        for elements in all(viscous) {
            let (u0, u1) = (wave(0.1, 1.3), wave(0.12, 2.9));
            let force = impulse(&elements, &u0, &u1);
            let (mut sum, mut moment) = ([0.0; 2], 0.0);
            for n in 0..X.len() {
                let [fx, fy] = [force[2 * n], force[2 * n + 1]];
                let halfway = |i: usize| X[n][i] + (u0[2 * n + i] + u1[2 * n + i]) / 2.0;
                sum = [sum[0] + fx, sum[1] + fy];
                moment += halfway(0) * fy - halfway(1) * fx;
            }
            assert!(sum[0].hypot(sum[1]) < 1e-14 * norm(&force));
            assert!(moment.abs() < 1e-14 * norm(&force));
            // a strained body that turns, by any angle
            for angle in [0.1, 1.0, 2.0] {
                let rigid = impulse(&elements, &u0, &turned(&u0, angle));
                assert!(norm(&rigid) < 1e-14 * norm(&force), "{}", norm(&rigid));
            }
        }
    }

    #[test]
    fn the_damping_matrix_is_the_derivative_of_the_impulse() {
        for elements in all(DAMPING) {
            // the matrix is exact if the strain does not change; otherwise the exact derivative has
            // B_L of the end on the right
            let u = wave(0.1, 1.3);
            let mut matrix = vec![0.0; DOFS * DOFS];
            elements.for_each_damping(([&u, &u], 1.0), TangentPart::Whole, |element, c| {
                let nodes = elements.nodes(element).iter();
                let dofs: Vec<usize> = nodes.flat_map(|n| [2 * n, 2 * n + 1]).collect();
                for (j, &column) in dofs.iter().enumerate() {
                    for (i, &row) in dofs.iter().enumerate() {
                        matrix[column * DOFS + row] += c[j * dofs.len() + i];
                    }
                }
            });
            for j in 0..DOFS {
                let at = |h: f64| {
                    let mut u1 = u.clone();
                    u1[j] += h;
                    impulse(&elements, &u, &u1)
                };
                let (ahead, behind) = (at(1e-6), at(-1e-6));
                for i in 0..DOFS {
                    let quotient = (ahead[i] - behind[i]) / 2e-6;
                    let error = (matrix[j * DOFS + i] - quotient).abs();
                    assert!(error < 1e-8 * norm(&matrix), "({i},{j}): {error}");
                }
            }
        }
    }

    #[test]
    fn without_damping_there_is_no_force() {
        for elements in all(Damping::default()) {
            let (u0, u1) = (wave(0.1, 1.3), wave(0.12, 2.9));
            assert!(!elements.has_damping());
            assert!(impulse(&elements, &u0, &u1).iter().all(|&p| p == 0.0));
        }
    }
}
