//! Volume, consistent mass and kinetic energy of a single element. Section 2 of docs/theory.md.

use crate::elements::element::AnyElement;
use crate::model::Model;

/// Volume and consistent mass of an element.
pub struct ElementInertia {
    /// Volume of the undeformed element (length^3).
    pub volume: f64,
    nodes: Vec<usize>,
    /// Mass per direction, n x n column by column (mass).
    mass: Vec<f64>,
}

impl ElementInertia {
    /// That of an element (index) of a model.
    pub fn new(model: &Model, index: usize) -> Self {
        let element = &model.mesh.elements[index];
        let section = &model.sections[element.section];
        let density = model.materials[section.material].density;
        let any = AnyElement::new(element, &model.mesh.coordinates, section.thickness);
        ElementInertia {
            volume: any.nodal_volumes().iter().sum(),
            nodes: any.nodes().to_vec(),
            mass: any.mass(density),
        }
    }

    /// Kinetic energy at the velocities `v`, 2 N entries (length/time):
    ///
    /// ```text
    /// sum over a, b of m_ab v_a . v_b / 2
    /// ```
    pub fn kinetic_energy(&self, v: &[f64]) -> f64 {
        let columns = self.mass.chunks_exact(self.nodes.len());
        let columns = self.nodes.iter().zip(columns);
        let terms = columns.flat_map(|(&b, column)| {
            let rows = self.nodes.iter().zip(column);
            rows.map(move |(&a, m)| m * (v[2 * a] * v[2 * b] + v[2 * a + 1] * v[2 * b + 1]))
        });
        terms.sum::<f64>() / 2.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::Law;
    use crate::model::{Damping, Element, ElementType, Material, Mesh, Section};

    #[test]
    fn volume_and_kinetic_energy_of_a_block_that_turns() {
        // 2 x 1 x 0.5, density 3, mass 3: v = (1, 2) + omega cross (x - c), omega = 4
        let coordinates = vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];
        let model = Model {
            mesh: Mesh {
                node_labels: vec![1, 2, 3, 4],
                elements: vec![Element {
                    label: 1,
                    element_type: ElementType::CPE4,
                    nodes: vec![0, 1, 2, 3].into(),
                    section: 0,
                }],
                coordinates: coordinates.clone(),
            },
            materials: vec![Material {
                name: "M".into(),
                law: Law::elastic(1.0, 0.25),
                density: 3.0,
                damping: Damping::default(),
            }],
            sections: vec![Section {
                material: 0,
                thickness: 0.5,
            }],
            ..Model::default()
        };
        let inertia = ElementInertia::new(&model, 0);
        assert!((inertia.volume - 1.0).abs() < 1e-15);
        let velocity = |&[x, y]: &[f64; 2]| [1.0 - 4.0 * (y - 0.5), 2.0 + 4.0 * (x - 1.0)];
        let v: Vec<f64> = coordinates.iter().flat_map(velocity).collect();
        // m (1 + 4)/2 + omega^2 m (a^2 + b^2)/12 / 2
        let exact = 3.0 * 5.0 / 2.0 + 16.0 * 3.0 * 5.0 / 12.0 / 2.0;
        assert!((inertia.kinetic_energy(&v) - exact).abs() < 1e-14 * exact);
    }
}
