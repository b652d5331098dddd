//! Hinges between bodies: forces that keep two nodes at one place together. See docs/theory/bodies.md, Hinges.

use nalgebra::DMatrix;

use super::rank_update::{RankUpdate, UpdateColumns};
use crate::linear::{LinearError, Rotation, Transformation};
use crate::model::{Model, Step};

/// Least eigenvalue of the matrix of hinge compliances, scaled to a unit diagonal, below which some hinges are
/// redundant. The eigenvalues of light bodies between heavy bodies are far above the bound.
const INDEPENDENT: f64 = 1e-12;

/// The rows of all hinges: gaps C u = u_a - u_b, eq. (11.8), first along x and then along y for
/// each hinge.
#[derive(Debug, Clone, Default)]
pub(crate) struct Hinges {
    rows: Vec<Row>,
}

#[derive(Debug, Clone)]
struct Row {
    dofs: [usize; 2],
    /// Whether supports prescribe the same motion for both nodes; such a row has no gap and no
    /// force.
    is_held: bool,
}

impl Hinges {
    /// The hinges of a model in a step.
    pub fn new(model: &Model, step: &Step) -> Self {
        let row = |nodes: [usize; 2], axis: usize| Row {
            dofs: nodes.map(|node| 2 * node + axis),
            is_held: model.are_held_alike(step, nodes, axis),
        };
        let hinges = model.hinges.iter();
        Hinges {
            rows: hinges
                .flat_map(|hinge| [0, 1].map(|axis| row(hinge.nodes, axis)))
                .collect(),
        }
    }

    /// Whether the model has no hinges.
    pub fn are_none(&self) -> bool {
        self.rows.is_empty()
    }

    /// Number of rows of C.
    pub fn count(&self) -> usize {
        self.rows.len()
    }

    /// Pairs of nodes that the hinges join.
    pub fn nodes(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        self.rows
            .iter()
            .step_by(2)
            .map(|row| row.dofs.map(|dof| dof / 2))
    }

    /// C u
    pub fn gaps(&self, u: &[f64]) -> Vec<f64> {
        let gap = |row: &Row| match row.is_held {
            true => 0.0,
            false => u[row.dofs[0]] - u[row.dofs[1]],
        };
        self.rows.iter().map(gap).collect()
    }

    /// Adds the hinge forces C^T lambda to a force over all dofs.
    pub fn add_forces(&self, lambda: &[f64], force: &mut [f64]) {
        let rows = self.rows.iter().zip(lambda);
        for (Row { dofs: [a, b], .. }, lambda) in rows.filter(|(row, _)| !row.is_held) {
            force[*a] += lambda;
            force[*b] -= lambda;
        }
    }

    /// The update by which solutions with a matrix keep the gaps of hinges closed, from the solver of the matrix and
    /// the maps T and R of the iterate:
    ///
    /// ```text
    /// W = A^-1 - V S^-1 Y^T,  V = A^-1 T_m^T C^T,  Y = A^-1 T_1^T C^T,  S = C T_1 V      eq. (11.9)
    /// ```
    ///
    /// # Errors
    /// Returns [`LinearError::Dependent`] with the number of a hinge that other hinges make redundant.
    pub fn hold(
        &self,
        (map, rotation): (&Transformation, &Rotation),
        dofs: usize,
        mut solve: impl FnMut(&[f64]) -> Result<Vec<f64>, LinearError>,
    ) -> Result<RankUpdate, LinearError> {
        let mut columns = [Vec::new(), Vec::new()];
        for row in 0..self.rows.len() {
            let mut lambda = vec![0.0; self.rows.len()];
            lambda[row] = 1.0;
            let mut force = vec![0.0; dofs];
            self.add_forces(&lambda, &mut force);
            rotation.turn_back(&mut force);
            columns[0].push(solve(&map.restrict(&force))?);
            columns[1].push(solve(&map.restrict_derivatives(&force))?);
        }
        let [of_forces, of_motions] = columns;
        let v = UpdateColumns::motions(of_forces, (map, rotation));
        let y = UpdateColumns::works(of_motions, (map, rotation));
        let gaps: Vec<Vec<f64>> = v.of_dofs.iter().map(|column| self.gaps(column)).collect();
        let m = self.rows.len();
        let s = DMatrix::from_fn(m, m, |i, k| match i == k && self.rows[i].is_held {
            true => 1.0,
            false => gaps[k][i],
        });
        let inverse = self.inverse(s)?;
        Ok(RankUpdate::new([v, y], inverse))
    }

    /// The inverse S^-1 of the matrix of hinge compliances, if no row depends on the others.
    fn inverse(&self, s: DMatrix<f64>) -> Result<DMatrix<f64>, LinearError> {
        let m = s.nrows();
        let size: Vec<f64> = (0..m).map(|i| s[(i, i)].abs().sqrt()).collect();
        if let Some(row) = size.iter().position(|size| *size == 0.0) {
            return Err(LinearError::Dependent { number: row / 2 });
        }
        let scaled = DMatrix::from_fn(m, m, |i, k| {
            (s[(i, k)] + s[(k, i)]) / 2.0 / (size[i] * size[k])
        });
        let eigen = scaled.symmetric_eigen();
        let least = eigen.eigenvalues.imin();
        if eigen.eigenvalues[least] <= INDEPENDENT {
            let row = eigen.eigenvectors.column(least).iamax();
            return Err(LinearError::Dependent { number: row / 2 });
        }
        s.try_inverse()
            .ok_or(LinearError::NotFinite("the inverse of a hinge"))
    }
}
