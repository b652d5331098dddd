//! Normals of the closed pairs of a body along its rigid motions, and facets of its contact surfaces. See
//! docs/theory/bodies.md, Neutral motions.

use std::collections::HashMap;

use nalgebra::{DMatrix, DVector};

use crate::contact::tolerances::CORNER_COSINE;
use crate::model::Model;
use crate::vectors::{cross, difference, dot, length};

/// Largest mean slope that the normals of pairs may have along a motion that counts as free.
const SLOPE: f64 = 0.25;

/// The pairs of a body along its free rigid motions.
pub(super) struct Normals(pub Vec<Normal>);

/// Normal of a pair.
pub(super) struct Normal {
    /// Rows Gn Z and Gt Z: derivatives of the gap and of the slip along the free rigid motions Z.
    pub row: DVector<f64>,
    pub tangent: DVector<f64>,
    /// The square |Gn Z0|², where Z0 are all rigid motions of the body, including motions that supports hold.
    pub size: f64,
    /// Largest sine of the angle between neighbouring segments at the nodes of the pair.
    pub kink: f64,
    /// Pn
    pub force: f64,
    /// Length of the segment.
    pub scale: f64,
    pub has_friction: bool,
}

impl Normals {
    /// Sum of the normal forces Pn.
    pub fn force(&self) -> f64 {
        self.0.iter().map(|normal| normal.force).sum()
    }

    /// Orthogonal motions that pairs without friction do not resist.
    ///
    /// ```text
    /// sum_j (Gn_j z)² <= (1/4)² sum_j |Gn_j Z0|²      eq. (12.10)
    /// ```
    pub fn free(&self) -> Vec<DVector<f64>> {
        let Some(first) = self.0.first() else {
            return Vec::new();
        };
        if self.0.iter().any(|normal| normal.has_friction) {
            return Vec::new();
        }
        let m = first.row.len();
        let (mut all, mut most) = (DMatrix::zeros(m, m), 0.0);
        for normal in &self.0 {
            all += &normal.row * normal.row.transpose();
            most += SLOPE * SLOPE * normal.size;
        }
        let eigen = all.symmetric_eigen();
        let is_free = |k: &usize| eigen.eigenvalues[*k] <= most;
        let columns = (0..m).filter(is_free);
        columns
            .map(|k| eigen.eigenvectors.column(k).into_owned())
            .collect()
    }

    /// Force along a motion that facets may cause, since their normals differ from the normals of a smooth surface by
    /// up to half the angle between neighbouring segments.
    ///
    /// ```text
    /// f_e = sum_j Pn_j |Gt_j z| sin(beta_j)/2      eq. (12.12)
    /// ```
    pub fn resolution(&self, m: &DVector<f64>) -> f64 {
        let of_pair =
            |normal: &Normal| normal.force * normal.tangent.dot(m).abs() * normal.kink / 2.0;
        self.0.iter().map(of_pair).sum()
    }

    /// Stiffness against a motion that facets may cause, since their normals change by the angle between neighbouring
    /// segments within a segment length.
    ///
    /// ```text
    /// k_e = sum_j Pn_j (Gt_j z)² sin(beta_j)/l_j      eq. (12.13)
    /// ```
    pub fn stiffness(&self, m: &DVector<f64>) -> f64 {
        let of_pair = |normal: &Normal| {
            normal.force * normal.kink * normal.tangent.dot(m).powi(2) / normal.scale
        };
        self.0.iter().map(of_pair).sum()
    }
}

/// The nodes before and after every node at which the contact surfaces are smooth.
#[derive(Default)]
pub(super) struct Vertices(HashMap<usize, [Option<usize>; 2]>);

impl Vertices {
    /// Neighbours of the nodes of the contacts of a model.
    pub fn new(model: &Model) -> Self {
        let mut all: HashMap<usize, [Option<usize>; 2]> = HashMap::new();
        for contact in &model.contacts {
            for surface in [contact.slave, contact.master] {
                for [a, b] in model.surfaces[surface].segments(&model.mesh) {
                    all.entry(b).or_default()[0] = Some(a);
                    all.entry(a).or_default()[1] = Some(b);
                }
            }
        }
        let x = &model.mesh.coordinates;
        all.retain(|&node, [before, after]| match (before, after) {
            (Some(before), Some(after)) => {
                let (e, f) = (
                    difference(x[*before], x[node]),
                    difference(x[node], x[*after]),
                );
                dot(e, f) > CORNER_COSINE * length(e) * length(f)
            }
            _ => false,
        });
        Vertices(all)
    }

    /// Sine of the angle between the segments at a node.
    pub fn kink(&self, node: usize, at: &dyn Fn(usize) -> [f64; 2]) -> f64 {
        let Some(&[Some(before), Some(after)]) = self.0.get(&node) else {
            return 0.0;
        };
        let (e, f) = (
            difference(at(before), at(node)),
            difference(at(node), at(after)),
        );
        cross(e, f).abs() / (length(e) * length(f))
    }
}
