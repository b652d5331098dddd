//! Contact pressure at slave nodes: normal force over the area of a node.

use crate::dynamics::increment::ContactForces;
use crate::dynamics::step::StepProblem;
use crate::model::{Face, Model, Segment, SurfaceKind};
use std::collections::BTreeSet;

/// A segment of a face on which slave nodes take pressure.
struct SlaveFace {
    nodes: Segment,
    /// Which of its two nodes take it.
    counts: [bool; 2],
    thickness: f64,
}

/// The slave nodes of all contacts with their faces.
pub(crate) struct SlaveFaces {
    /// 0 at slave nodes, NaN at others, `N` entries.
    pub start: Vec<f64>,
    faces: Vec<SlaveFace>,
}

impl SlaveFaces {
    /// Faces of the slave surfaces; slave nodes without such a face take the exterior faces of their
    /// elements.
    pub fn new(model: &Model) -> Self {
        let mesh = &model.mesh;
        let (mut start, mut own) = (vec![f64::NAN; mesh.node_count()], BTreeSet::new());
        for contact in &model.contacts {
            let slave = &model.surfaces[contact.slave];
            if let SurfaceKind::Faces(faces) = &slave.kind {
                own.extend(faces.iter().copied());
            }
            for node in slave.nodes(mesh) {
                start[node] = 0.0;
            }
        }
        let mut is_bare: Vec<bool> = start.iter().map(|start| !start.is_nan()).collect();
        for node in own.iter().flat_map(|face| face.nodes(mesh)) {
            is_bare[node] = false;
        }
        let slave_faces = |face: &Face, counts: &dyn Fn(usize) -> bool| -> Vec<SlaveFace> {
            let of_segment = |nodes: Segment| SlaveFace {
                nodes,
                counts: nodes.map(counts),
                thickness: thickness(model, face),
            };
            face.segments(mesh).into_iter().map(of_segment).collect()
        };
        let mut faces: Vec<SlaveFace> = (own.iter())
            .flat_map(|face| slave_faces(face, &|_| true))
            .collect();
        if is_bare.contains(&true) {
            let exterior = mesh.exterior_faces().into_iter();
            let bare = exterior.flat_map(|face| slave_faces(&face, &|node| is_bare[node]));
            faces.extend(bare.filter(|face| face.counts.contains(&true)));
        }
        SlaveFaces { start, faces }
    }

    /// Pressure |N| / A of every node, `N` entries (force/length^2), in the configuration of
    /// displacements `u`; NaN without area, and at all nodes but slave nodes.
    ///
    /// ```text
    /// N = sum Bn^T Pn,  A = sum over the faces max(-n.N/|N|, 0) t l/2,  p = |N|/A    eq. (9.8)
    /// ```
    ///
    /// The sum of N runs over all pairs of the node; n, l and t are outward normal, current length
    /// and thickness of a face.
    pub fn pressure(&self, problem: &StepProblem, u: &[f64], forces: &ContactForces) -> Vec<f64> {
        let mut pressure = self.start.clone();
        let mut normal = vec![0.0; u.len()];
        for (constraint, pair) in forces.acting() {
            constraint.add_force([pair.force[0], 0.0], &mut normal);
        }
        let of_node = |node: usize| [normal[2 * node], normal[2 * node + 1]];
        let size = |[x, y]: [f64; 2]| x.hypot(y);
        let mut area = vec![0.0; pressure.len()];
        for face in &self.faces {
            let [a, b] = face.nodes.map(|node| problem.position(u, node));
            // n l = (e_y, -e_x): on the right of the direction from a to b
            let e = [b[0] - a[0], b[1] - a[1]];
            for (node, _) in (face.nodes.iter().zip(face.counts)).filter(|(_, counts)| *counts) {
                let force = of_node(*node);
                let against = force[1] * e[0] - force[0] * e[1];
                if against > 0.0 {
                    area[*node] += face.thickness * against / size(force) / 2.0;
                }
            }
        }
        for (node, pressure) in pressure.iter_mut().enumerate() {
            let force = size(of_node(node));
            if force > 0.0 {
                *pressure += if area[node] > 0.0 {
                    force / area[node]
                } else {
                    f64::NAN
                };
            }
        }
        pressure
    }
}

fn thickness(model: &Model, face: &Face) -> f64 {
    let section = model.mesh.elements[face.element].section;
    model.sections[section].thickness
}
