//! Inverses that differ from the inverse of a factorised matrix by a few columns: inverses of matrices whose solutions
//! keep hinges closed. See docs/theory/bodies.md, Hinges.

use nalgebra::{DMatrix, DVector};

use crate::contact::Constraint;
use crate::linear::{Rotation, Transformation};

/// The inverse W b = A^-1 b - V C Y^T b, where A^-1 is the inverse of the factors.
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct RankUpdate {
    /// Columns of V and of Y.
    columns: [UpdateColumns; 2],
    /// C.
    c: DMatrix<f64>,
    /// Products Y^T b of the columns Y with the right-hand side b of the present solve.
    projected: Vec<f64>,
}

/// Columns of an update.
#[derive(Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct UpdateColumns {
    /// The columns over the unknowns.
    pub of_unknowns: Vec<Vec<f64>>,
    /// The columns over all dofs.
    pub of_dofs: Vec<Vec<f64>>,
}

impl UpdateColumns {
    /// Motions over the dofs of columns over the unknowns: R T times the columns, with T of the derivative rows.
    pub fn motions(
        of_unknowns: Vec<Vec<f64>>,
        (map, rotation): (&Transformation, &Rotation),
    ) -> Self {
        UpdateColumns::turned(of_unknowns, |column| map.motion(column), rotation)
    }

    /// Columns over the unknowns in the form of the work of forces over the dofs: R T times the
    /// columns, with T of the force rows.
    pub fn works(
        of_unknowns: Vec<Vec<f64>>,
        (map, rotation): (&Transformation, &Rotation),
    ) -> Self {
        UpdateColumns::turned(of_unknowns, |column| map.work(column), rotation)
    }

    fn turned(
        of_unknowns: Vec<Vec<f64>>,
        expand: impl Fn(&[f64]) -> Vec<f64>,
        rotation: &Rotation,
    ) -> Self {
        let turned = |column: &Vec<f64>| {
            let mut all = expand(column);
            rotation.turn(&mut all);
            all
        };
        UpdateColumns {
            of_dofs: of_unknowns.iter().map(turned).collect(),
            of_unknowns,
        }
    }

    /// Products of all columns with a vector over the unknowns.
    fn products(&self, b: &[f64]) -> Vec<f64> {
        let columns = self.of_unknowns.iter();
        columns
            .map(|column| column.iter().zip(b).map(|(y, b)| y * b).sum())
            .collect()
    }
}

/// A vector over the unknowns less `parts` times the columns.
fn less(vector: &[f64], columns: &UpdateColumns, parts: &[f64]) -> Vec<f64> {
    let mut left = vector.to_vec();
    for (part, column) in parts.iter().zip(&columns.of_unknowns) {
        for (value, v) in left.iter_mut().zip(column) {
            *value -= part * v;
        }
    }
    left
}

impl RankUpdate {
    /// The update with the columns V and Y, and the matrix C.
    pub fn new(columns: [UpdateColumns; 2], c: DMatrix<f64>) -> Self {
        RankUpdate {
            columns,
            projected: vec![0.0; c.nrows()],
            c,
        }
    }

    /// Begins a solve with a right-hand side over the unknowns.
    pub fn begin(&mut self, b: &[f64]) {
        self.projected = self.columns[1].products(b);
    }

    /// Adds values to the right-hand side (unknown, value).
    pub fn add(&mut self, b: &[(usize, f64)]) {
        for (projected, column) in self.projected.iter_mut().zip(&self.columns[1].of_unknowns) {
            *projected += b.iter().map(|&(at, value)| column[at] * value).sum::<f64>();
        }
    }

    /// C p
    fn weighted(&self, p: &[f64]) -> Vec<f64> {
        let row = |i: usize| (0..p.len()).map(|k| self.c[(i, k)] * p[k]).sum();
        (0..p.len()).map(row).collect()
    }

    /// Factors p = C Y^T b of the columns V.
    pub fn parts(&self) -> Vec<f64> {
        self.weighted(&self.projected)
    }

    /// Forces -C p of the update, and the motion V (-C p) over all dofs.
    pub fn answer(&self, p: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let parts: Vec<f64> = self.weighted(p).iter().map(|part| -part).collect();
        let columns = &self.columns[0].of_dofs;
        let mut motion = vec![0.0; columns.first().map_or(0, Vec::len)];
        for (part, column) in parts.iter().zip(columns) {
            motion
                .iter_mut()
                .zip(column)
                .for_each(|(m, v)| *m += part * v);
        }
        (parts, motion)
    }

    /// Changes the solution A^-1 b at some unknowns into the solution W b.
    pub fn correct(&self, unknowns: &[usize], values: &mut [f64]) {
        for (part, column) in self.parts().iter().zip(&self.columns[0].of_unknowns) {
            for (&at, value) in unknowns.iter().zip(values.iter_mut()) {
                *value -= part * column[at];
            }
        }
    }

    /// The product W^T b over all unknowns, from b and A^-1 b; A is symmetric.
    pub fn transposed(&self, b: &[f64], solution: &[f64]) -> Vec<f64> {
        let [v, y] = self.columns.each_ref();
        let products = v.products(b);
        let parts = self.c.tr_mul(&DVector::from_vec(products));
        less(solution, y, parts.as_slice())
    }

    /// The solution W b over all unknowns, from A^-1 b.
    pub fn corrected(&self, solution: &[f64]) -> Vec<f64> {
        less(solution, &self.columns[0], &self.parts())
    }

    /// Changes the Delassus matrix G A^-1 B^T of some constraints into G W B^T.
    pub fn change(&self, constraints: &[&Constraint], q: &mut DMatrix<f64>) {
        let (n, m) = (constraints.len(), self.c.nrows());
        type Row = fn(&Constraint, &[f64]) -> f64;
        let [motions, works] = self.columns.each_ref();
        let seen = |normal: Row, tangential: Row, columns: &UpdateColumns| {
            DMatrix::from_fn(2 * n, m, |i, k| match i < n {
                true => normal(constraints[i], &columns.of_dofs[k]),
                false => tangential(constraints[i - n], &columns.of_dofs[k]),
            })
        };
        let g = seen(Constraint::gap_change, Constraint::slip_change, motions);
        let b = seen(
            Constraint::normal_motion,
            Constraint::tangential_motion,
            works,
        );
        *q -= g * &self.c * b.transpose();
    }
}
