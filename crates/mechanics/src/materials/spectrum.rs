//! Functions of symmetric tensors through their principal values, with derivatives and differences that keep their
//! digits. See docs/theory/materials.md: Plasticity, Ogden's materials and Hencky's material.

use super::symmetric::{Symmetric, Tangent};

/// Principal values of a symmetric tensor, the first two in the plane, and the direction (cos, sin) of the first
/// principal axis.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spectrum {
    pub values: [f64; 3],
    direction: [f64; 2],
}

impl Spectrum {
    /// Spectrum of C - I for a Green-Lagrange strain.
    pub fn of_strain(e: &Symmetric) -> Self {
        Spectrum::new(&(e * 2.0))
    }

    /// Logarithms of the principal stretches, ln(1 + y)/2 for the principal values y.
    pub fn logarithms(&self) -> [f64; 3] {
        self.values.map(|y| y.ln_1p() / 2.0)
    }

    /// The logarithmic strain ln(I + Y)/2.
    pub fn logarithmic_strain(&self) -> Symmetric {
        self.map(|y| y.ln_1p() / 2.0)
    }

    /// Tangent C = dS/dE (force/length^2) of S = (D ln C) : T. The stress T(E_h) depends on the logarithmic strain, and
    /// `change` gives the change of T for a change of E_h:
    ///
    /// ```text
    /// D ln : (dT/dE_h) : D ln + 2 D² ln : T,   column by column
    /// ```
    pub fn tangent(&self, t: &Symmetric, change: impl Fn(&Symmetric) -> Symmetric) -> Tangent {
        Tangent::of_columns(|direction| {
            let change = change(&self.log_derivative(direction));
            self.log_derivative(&change) + self.second_derivative(t, direction) * 2.0
        })
    }

    pub fn new(a: &Symmetric) -> Self {
        let (mean, half) = ((a.x + a.y) / 2.0, (a.x - a.y) / 2.0);
        let radius = half.hypot(a.w);
        let (sin, cos) = (a.w.atan2(half) / 2.0).sin_cos();
        Spectrum {
            values: [mean + radius, mean - radius, a.z],
            direction: [cos, sin],
        }
    }

    /// The tensor whose principal values are a function of the principal values of the given tensor.
    pub fn map(&self, f: impl Fn(f64) -> f64) -> Symmetric {
        let [a, b, c] = self.values.map(f);
        self.back(&Symmetric::new(a, b, c, 0.0))
    }

    /// Components of a tensor in the principal frame.
    pub fn to(&self, a: &Symmetric) -> Symmetric {
        let [c, s] = self.direction;
        Symmetric::new(
            c * c * a.x + s * s * a.y + 2.0 * c * s * a.w,
            s * s * a.x + c * c * a.y - 2.0 * c * s * a.w,
            a.z,
            c * s * (a.y - a.x) + (c * c - s * s) * a.w,
        )
    }

    /// The tensor with the given components in the principal frame.
    pub fn back(&self, a: &Symmetric) -> Symmetric {
        let [c, s] = self.direction;
        Symmetric::new(
            c * c * a.x + s * s * a.y - 2.0 * c * s * a.w,
            s * s * a.x + c * c * a.y + 2.0 * c * s * a.w,
            a.z,
            c * s * (a.x - a.y) + (c * c - s * s) * a.w,
        )
    }

    /// Derivative of ln(I + Y) in the direction A, which has the components A_ij ln[x_i, x_j] in the principal frame.
    pub fn log_derivative(&self, a: &Symmetric) -> Symmetric {
        let (a, [y1, y2, y3]) = (self.to(a), self.values);
        self.back(&Symmetric::new(
            a.x / (1.0 + y1),
            a.y / (1.0 + y2),
            a.z / (1.0 + y3),
            a.w * first_difference(y1, y2),
        ))
    }

    /// Second derivative of ln(I + Y) in the directions A and B, whose components in the principal frame are the sums
    /// over k of (A_ik B_kj + B_ik A_kj) ln[x_i, x_k, x_j].
    pub fn second_derivative(&self, a: &Symmetric, b: &Symmetric) -> Symmetric {
        let ([a, b], [y1, y2, y3]) = ([self.to(a), self.to(b)], self.values);
        let same = |y: f64| -0.5 / ((1.0 + y) * (1.0 + y));
        let (f112, f122) = (second_difference(y1, y2), second_difference(y2, y1));
        self.back(&Symmetric::new(
            2.0 * (same(y1) * a.x * b.x + f112 * a.w * b.w),
            2.0 * (same(y2) * a.y * b.y + f122 * a.w * b.w),
            2.0 * same(y3) * a.z * b.z,
            f112 * (a.x * b.w + b.x * a.w) + f122 * (a.w * b.y + b.w * a.y),
        ))
    }
}

/// Divided difference (ln x_1 - ln x_2)/(x_1 - x_2), with x = 1 + y.
pub(super) fn first_difference(y1: f64, y2: f64) -> f64 {
    let x2 = 1.0 + y2;
    let d = (y1 - y2) / x2;
    if d == 0.0 {
        1.0 / x2
    } else {
        d.ln_1p() / (d * x2)
    }
}

/// Absolute value of d below which [`second_difference`] is computed as a series.
const NEAR: f64 = 0.1;
/// Number of terms of the series of [`second_difference`]; the last term is round-off.
const TERMS: i32 = 17;

/// Divided difference ln[x_1, x_1, x_2] = -(1 - ln(1 + d)/d)/(d x_1²) with d = (x_2 - x_1)/x_1; near d = 0 the
/// difference is the series -sum (-d)^k/(k + 2).
fn second_difference(y1: f64, y2: f64) -> f64 {
    let x1 = 1.0 + y1;
    let d = (y2 - y1) / x1;
    let value = if d.abs() < NEAR {
        (0..TERMS)
            .rev()
            .fold(0.0, |sum, k| 1.0 / f64::from(k + 2) - d * sum)
    } else {
        (1.0 - d.ln_1p() / d) / d
    };
    -value / (x1 * x1)
}

/// The tensor (I + g)^(1/2) - I.
pub(super) fn root(g: &Symmetric) -> Symmetric {
    Spectrum::new(g).map(|g| g / (1.0 + (1.0 + g).sqrt()))
}

/// The product V E V of symmetric tensors.
pub(super) fn between(v: &Symmetric, e: &Symmetric) -> Symmetric {
    let (v2, e2) = (v.in_plane(), e.in_plane());
    let product = v2 * e2 * v2;
    Symmetric::new(
        product.m11,
        product.m22,
        v.z * v.z * e.z,
        (product.m12 + product.m21) / 2.0,
    )
}

/// Largest w = (d/m)² for which [`log_change`] uses a series.
const SERIES: f64 = 0.25;
/// Number of terms of the series in [`log_change`].
const SERIES_TERMS: usize = 30;

/// Change (ln(I + Y1) - ln(I + Y0))/2 of the logarithmic strain, from dY = Y1 - Y0, with round-off relative to dY. In
/// the plane, m is the half trace and D the deviator of X = I + Y, and d² = D:D/2:
///
/// ```text
/// ln X = ln(det X)/2 I + c D,   c = g(w)/m,   g = artanh(sqrt w)/sqrt w = sum w^k/(2 k + 1),   w = d²/m²
/// ```
///
/// Differences of products are computed as a1 b1 - a0 b0 = da (b0 + b1)/2 + (a0 + a1)/2 db.
pub(super) fn log_change(y0: &Symmetric, y1: &Symmetric, dy: &Symmetric) -> Symmetric {
    let half_trace = |y: &Symmetric| 1.0 + (y.x + y.y) / 2.0;
    let dev = |y: &Symmetric| [(y.x - y.y) / 2.0, y.w];
    let ([m0, m1], dm) = ([y0, y1].map(half_trace), (dy.x + dy.y) / 2.0);
    let ([a0, a1], da) = ([y0, y1].map(dev), dev(dy));
    let square = |a: [f64; 2]| a[0] * a[0] + a[1] * a[1];
    // d(d²) and d(det X), det X = m² - d²
    let squares = (0..2).map(|i| (a0[i] + a1[i]) * da[i]).sum::<f64>();
    let (d0, d1) = (square(a0), square(a1));
    let determinant = m0 * m0 - d0;
    let growth = ((dm * (m0 + m1) - squares) / determinant).ln_1p() / 2.0;
    let (w0, w1) = (d0 / (m0 * m0), d1 / (m1 * m1));
    let dw = (squares - w0 * dm * (m0 + m1)) / (m1 * m1);
    let (g0, g1) = (artanh_ratio(w0), artanh_ratio(w1));
    let dg = if w0.max(w1) < SERIES {
        // (w1^k - w0^k)/(w1 - w0) = sum of w1^i w0^(k-1-i)
        let (mut power, mut sum, mut of_w0) = (1.0, 0.0, 1.0);
        for k in 1..SERIES_TERMS {
            sum += power / (2 * k + 1) as f64;
            of_w0 *= w0;
            power = w1 * power + of_w0;
        }
        sum * dw
    } else {
        g1 - g0
    };
    let (c0, c1) = (g0 / m0, g1 / m1);
    let dc = (dg - c0 * dm) / m1;
    let part = |i: usize| (c0 + c1) / 2.0 * da[i] + dc * (a0[i] + a1[i]) / 2.0;
    let (along, shear) = (part(0), part(1));
    let around = (dy.z / (1.0 + y0.z)).ln_1p();
    Symmetric::new(growth + along, growth - along, around, shear) / 2.0
}

/// The value artanh(sqrt w)/sqrt w.
fn artanh_ratio(w: f64) -> f64 {
    if w < SERIES {
        let terms = (0..SERIES_TERMS).rev();
        return terms.fold(0.0, |sum, k| 1.0 / (2 * k + 1) as f64 + w * sum);
    }
    let root = w.sqrt();
    root.atanh() / root
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_change_of_a_logarithm_keeps_its_digits() {
        let y0 = Symmetric::new(0.3, -0.2, 0.1, 0.15);
        for size in [0.3, 1e-3, 1e-8, 1e-14] {
            let dy = Symmetric::new(0.5, -0.3, 0.2, 0.4) * size;
            let y1 = y0 + dy;
            let found = log_change(&y0, &y1, &(y1 - y0));
            let log = |y: &Symmetric| Spectrum::new(y).map(|y| y.ln_1p() / 2.0);
            if size > 0.1 {
                let exact = log(&y1) - log(&y0);
                assert!((found - exact).norm() < 1e-14, "{found:?} {exact:?}");
            } else {
                // the derivative at the mean strain
                let mid = Spectrum::new(&((y0 + y1) / 2.0));
                let exact = mid.log_derivative(&(y1 - y0)) / 2.0;
                let bound = (1e-14 + size * size) * exact.norm();
                assert!(
                    (found - exact).norm() < bound,
                    "{size}: {found:?} {exact:?}"
                );
            }
        }
    }
}
