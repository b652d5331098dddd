//! Delassus matrix of an elastic block.
//!
//! ```text
//!   +--+--+--+--+   ny rows of square 4-node elements (plane strain, nu = 0.3, consistent mass)
//!   +--+--+--+--+
//!   o--o--o--o--o   n contact nodes on the bottom edge, normal up, tangent to the right
//! ```

use nalgebra::{DMatrix, SMatrix};

/// Q = B K*^-1 B^T (2n x 2n) with K* = K + 2/dt^2 M, E = rho = h = 1 and dt = courant h / c.
pub fn block_delassus(n: usize, ny: usize, courant: f64) -> DMatrix<f64> {
    let (stiffness, mass, wave_speed) = element();
    let dt = courant / wave_speed;
    let effective = stiffness + mass * (2.0 / (dt * dt));
    let column = 2 * (ny + 1);
    let size = n * column;
    let band = column + 4;
    // Lower band: band_matrix[i * band + (i - j)] = K*_ij, numbered upwards, column by column.
    let mut matrix = vec![0.0; size * band];
    for ex in 0..n.saturating_sub(1) {
        for ey in 0..ny {
            let node = |dx: usize, dy: usize| (ex + dx) * column + 2 * (ey + dy);
            let nodes = [node(0, 0), node(1, 0), node(1, 1), node(0, 1)];
            let dof = |a: usize| nodes[a / 2] + a % 2;
            for a in 0..8 {
                for b in 0..8 {
                    if dof(a) >= dof(b) {
                        matrix[dof(a) * band + dof(a) - dof(b)] += effective[(a, b)];
                    }
                }
            }
        }
    }
    factor(&mut matrix, size, band);
    let mut q = DMatrix::zeros(2 * n, 2 * n);
    // Contact i moves up with dof y (1) and right with dof x (0) of its node.
    let dof = |k: usize| {
        if k < n {
            k * column + 1
        } else {
            (k - n) * column
        }
    };
    for k in 0..2 * n {
        let mut x = vec![0.0; size];
        x[dof(k)] = 1.0;
        solve(&matrix, size, band, dof(k), &mut x);
        for r in 0..2 * n {
            q[(r, k)] = x[dof(r)];
        }
    }
    0.5 * (&q + q.transpose())
}

/// Stiffness, consistent mass and speed of pressure waves of a unit square.
fn element() -> (SMatrix<f64, 8, 8>, SMatrix<f64, 8, 8>, f64) {
    let nu = 0.3;
    let factor = 1.0 / ((1.0 + nu) * (1.0 - 2.0 * nu));
    let c = SMatrix::<f64, 3, 3>::new(1.0 - nu, nu, 0.0, nu, 1.0 - nu, 0.0, 0.0, 0.0, 0.5 - nu)
        * factor;
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let point = 1.0 / 3f64.sqrt();
    let (mut stiffness, mut mass) = (SMatrix::zeros(), SMatrix::zeros());
    for (px, py) in corners {
        let (xi, eta) = (px * point, py * point);
        let mut b = SMatrix::<f64, 3, 8>::zeros();
        let mut h = SMatrix::<f64, 2, 8>::zeros();
        for (a, (cx, cy)) in corners.iter().enumerate() {
            // Derivatives with respect to x = xi/2, y = eta/2.
            let (dx, dy) = (0.5 * cx * (1.0 + cy * eta), 0.5 * cy * (1.0 + cx * xi));
            b[(0, 2 * a)] = dx;
            b[(1, 2 * a + 1)] = dy;
            b[(2, 2 * a)] = dy;
            b[(2, 2 * a + 1)] = dx;
            let shape = 0.25 * (1.0 + cx * xi) * (1.0 + cy * eta);
            h[(0, 2 * a)] = shape;
            h[(1, 2 * a + 1)] = shape;
        }
        stiffness += b.transpose() * c * b * 0.25;
        mass += h.transpose() * h * 0.25;
    }
    (stiffness, mass, c[(0, 0)].sqrt())
}

/// Cholesky factor of a band matrix, in place.
fn factor(m: &mut [f64], size: usize, band: usize) {
    for i in 0..size {
        for j in i.saturating_sub(band - 1)..=i {
            let start = i.saturating_sub(band - 1).max(j.saturating_sub(band - 1));
            let sum: f64 = (start..j)
                .map(|k| m[i * band + i - k] * m[j * band + j - k])
                .sum();
            let value = m[i * band + i - j] - sum;
            m[i * band + i - j] = if i == j {
                value.sqrt()
            } else {
                value / m[j * band]
            };
        }
    }
}

/// Solves with the factor; the right-hand side is zero before `first`.
fn solve(m: &[f64], size: usize, band: usize, first: usize, x: &mut [f64]) {
    for i in first..size {
        let start = i.saturating_sub(band - 1).max(first);
        let sum: f64 = (start..i).map(|k| m[i * band + i - k] * x[k]).sum();
        x[i] = (x[i] - sum) / m[i * band];
    }
    for i in (0..size).rev() {
        x[i] /= m[i * band];
        for k in i.saturating_sub(band - 1)..i {
            x[k] -= m[i * band + i - k] * x[i];
        }
    }
}
