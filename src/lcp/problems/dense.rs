//! Vector kernels of the inner loops, with the vector instructions of the processor. They do the same
//! operations in the same order on all of them.

use pulp::Arch;

/// Sum of a_i b_i over the shorter length, in eight interleaved partial sums (which the compiler
/// turns into vector instructions).
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    Arch::new().dispatch(
        #[inline(always)]
        || interleaved_dot(a, b),
    )
}

#[inline(always)]
fn interleaved_dot(a: &[f64], b: &[f64]) -> f64 {
    let length = a.len().min(b.len());
    let (a, b) = (&a[..length], &b[..length]);
    let mut sums = [0.0; 8];
    let (mut chunks_a, mut chunks_b) = (a.chunks_exact(8), b.chunks_exact(8));
    for (x, y) in (&mut chunks_a).zip(&mut chunks_b) {
        for (sum, (x, y)) in sums.iter_mut().zip(x.iter().zip(y)) {
            *sum += x * y;
        }
    }
    let rest = chunks_a.remainder().iter().zip(chunks_b.remainder());
    sums.iter().sum::<f64>() + rest.map(|(x, y)| x * y).sum::<f64>()
}

/// y += a x.
pub(crate) fn axpy(a: f64, x: &[f64], y: &mut [f64]) {
    if a != 0.0 {
        Arch::new().dispatch(
            #[inline(always)]
            || y.iter_mut().zip(x).for_each(|(y, x)| *y += a * x),
        );
    }
}

/// y += |a x|, entry by entry.
pub(crate) fn add_sizes(a: f64, x: &[f64], y: &mut [f64]) {
    if a != 0.0 {
        Arch::new().dispatch(
            #[inline(always)]
            || y.iter_mut().zip(x).for_each(|(y, x)| *y += (a * x).abs()),
        );
    }
}

/// Appends v_i (w_i c) to `out`.
pub(crate) fn extend_scaled(out: &mut Vec<f64>, v: &[f64], w: &[f64], c: f64) {
    let start = out.len();
    out.extend_from_slice(v);
    let scaled = &mut out[start..];
    Arch::new().dispatch(
        #[inline(always)]
        || scaled.iter_mut().zip(w).for_each(|(v, w)| *v *= w * c),
    );
}

/// Largest absolute value, 0 for an empty slice.
pub(crate) fn max_abs(values: &[f64]) -> f64 {
    values
        .iter()
        .fold(0.0, |largest: f64, v| largest.max(v.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kernels_match_their_definitions() {
        let a: Vec<f64> = (0..19).map(f64::from).collect();
        let b: Vec<f64> = (0..19).map(|i| f64::from(i) - 9.0).collect();
        let sum: f64 = a.iter().zip(&b).map(|(x, y)| x * y).sum();
        assert_eq!(dot(&a, &b), sum);
        let mut y = b.clone();
        axpy(2.0, &a, &mut y);
        assert_eq!(y[18], 9.0 + 36.0);
        add_sizes(-2.0, &a, &mut y);
        assert_eq!(y[18], 9.0 + 72.0);
        assert_eq!(max_abs(&b), 9.0);
        assert_eq!(max_abs(&[]), 0.0);
    }
}
