//! Lemke's method for the general problem, after equilibration by powers of two. Section 8 of
//! docs/theory.md.

use nalgebra::{DMatrix, DVector};

use super::basis::PivotMatrix;
use super::pivoting::follow_path;
use super::settings::LemkeSettings;
use crate::lcp::problems::{
    Equilibration, Lcp, LcpError, LcpSolution, axpy, expect_finite, expect_non_negative,
    expect_size, max_abs, power_of_two, residual,
};

impl PivotMatrix for DMatrix<f64> {
    fn size(&self) -> usize {
        self.nrows()
    }

    fn add_product(&self, z: &[(usize, f64)], out: &mut [f64]) {
        let rows = self.nrows();
        for (j, value) in z {
            axpy(*value, &self.as_slice()[j * rows..(j + 1) * rows], out);
        }
    }

    fn entry(&self, i: usize, j: usize) -> f64 {
        self[(i, j)]
    }
}

/// A covering vector for any problem: ones after the rows of M are scaled to entries near 1.
pub fn covering_vector(lcp: &Lcp) -> DVector<f64> {
    let rows = Equilibration::of(&lcp.m).rows;
    DVector::from_iterator(rows.len(), rows.iter().map(|r| 1.0 / r))
}

/// Solves an [`Lcp`] by Lemke's method with covering vector `d` >= 0 (positive where q is
/// negative), after scaling rows and columns of M, q and d by powers of two.
pub fn lemke(
    lcp: &Lcp,
    d: &DVector<f64>,
    settings: &LemkeSettings,
) -> Result<LcpSolution, LcpError> {
    lcp.check()?;
    expect_size("covering vector", lcp.q.len(), d.len())?;
    expect_finite(d.as_slice())?;
    expect_non_negative("covering vector", d.as_slice())?;
    if let Some(index) = (0..d.len()).find(|i| d[*i] == 0.0 && lcp.q[*i] < 0.0) {
        return Err(LcpError::Range {
            what: "covering vector where q < 0",
            index,
            value: 0.0,
        });
    }
    let factors = Equilibration::of(&lcp.m);
    let m = factors.apply(&lcp.m);
    // Row i times r_i, z_j = c_j z'_j unit; unit and the scale of d bring q' and d' near 1.
    let scaled = |v: &DVector<f64>| -> (Vec<f64>, f64) {
        let rows: Vec<f64> = v.iter().zip(&factors.rows).map(|(v, r)| v * r).collect();
        let unit = power_of_two(max_abs(&rows));
        (rows.iter().map(|v| v / unit).collect(), unit)
    };
    let (q, unit) = scaled(&lcp.q);
    let d = scaled(d).0;
    for values in [m.as_slice(), &q, &d] {
        expect_finite(values)?;
    }
    let vertex = follow_path(&m, &q, &d, settings)?;
    let z = vertex
        .z
        .iter()
        .zip(&factors.columns)
        .map(|(z, c)| z * c * unit);
    let z = DVector::from_iterator(q.len(), z);
    let value = residual(lcp, &z);
    if value > settings.residual_tolerance {
        return Err(LcpError::Residual {
            value,
            tolerance: settings.residual_tolerance,
        });
    }
    Ok(LcpSolution {
        w: lcp.w(&z),
        z,
        residual: value,
        pivots: vertex.pivots,
    })
}
