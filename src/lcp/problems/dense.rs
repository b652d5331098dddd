//! Vector kernels of the inner loops, with the vector instructions of the processor. They do the same
//! operations in the same order on all of them.

use pulp::{Arch, Simd, WithSimd};

use super::arena::List;

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

/// y += M p, with the columns of M one after the other; those with p = 0 are left out.
pub(crate) fn add_product(columns: &[f64], p: &[f64], y: &mut [f64]) {
    Arch::new().dispatch(Product {
        columns,
        p,
        y,
        sizes: None,
    });
}

/// y += M p and sizes += |M| |p|, with the columns of M one after the other.
pub(crate) fn add_product_and_sizes(columns: &[f64], p: &[f64], y: &mut [f64], sizes: &mut [f64]) {
    let sizes = Some(sizes);
    Arch::new().dispatch(Product {
        columns,
        p,
        y,
        sizes,
    });
}

/// The operation of [`add_product`] and [`add_product_and_sizes`].
struct Product<'a> {
    columns: &'a [f64],
    p: &'a [f64],
    y: &'a mut [f64],
    sizes: Option<&'a mut [f64]>,
}

impl WithSimd for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let length = self.y.len();
        let mut terms = (self.p.iter().enumerate()).filter(|(_, a)| **a != 0.0);
        while let Some((k, a)) = terms.next() {
            // four columns at a time, at the end with the factor zero
            let column = |k: usize| &self.columns[k * length..(k + 1) * length];
            let (mut x, mut factors) = ([column(k); 4], [*a, 0.0, 0.0, 0.0]);
            for ((x, factor), (k, a)) in x.iter_mut().zip(&mut factors).skip(1).zip(&mut terms) {
                (*x, *factor) = (column(k), *a);
            }
            combine(simd, x, factors, self.y);
            if let Some(sizes) = &mut self.sizes {
                combine_terms::<S, true>(simd, x, factors, sizes);
            }
        }
    }
}

/// y += a_0 x_0 + ... + a_3 x_3, term by term.
#[inline(always)]
pub(crate) fn combine<S: Simd>(simd: S, x: [&[f64]; 4], a: [f64; 4], y: &mut [f64]) {
    combine_terms::<S, false>(simd, x, a, y);
}

/// y += the terms a_k x_k, or their sizes.
#[inline(always)]
fn combine_terms<S: Simd, const SIZES: bool>(simd: S, x: [&[f64]; 4], a: [f64; 4], y: &mut [f64]) {
    let length = y.len();
    let [x0, x1, x2, x3] = x;
    let (heads, rest) = S::as_mut_simd_f64s(y);
    let (x0, rest0) = S::as_simd_f64s(&x0[..length]);
    let (x1, rest1) = S::as_simd_f64s(&x1[..length]);
    let (x2, rest2) = S::as_simd_f64s(&x2[..length]);
    let (x3, rest3) = S::as_simd_f64s(&x3[..length]);
    let mut factors = [simd.splat_f64s(0.0); 4];
    for (factor, a) in factors.iter_mut().zip(a) {
        *factor = simd.splat_f64s(a);
    }
    for (y, ((x0, x1), (x2, x3))) in heads
        .iter_mut()
        .zip(x0.iter().zip(x1).zip(x2.iter().zip(x3)))
    {
        *y = add_terms::<S, SIZES>(simd, factors, [*x0, *x1, *x2, *x3], *y);
    }
    if !rest.is_empty() {
        let mut x = [simd.splat_f64s(0.0); 4];
        for (x, rest) in x.iter_mut().zip([rest0, rest1, rest2, rest3]) {
            *x = simd.partial_load_f64s(rest);
        }
        let sum = simd.partial_load_f64s(rest);
        simd.partial_store_f64s(rest, add_terms::<S, SIZES>(simd, factors, x, sum));
    }
}

/// sum + a_0 x_0 + ... + a_3 x_3, or the sizes of these terms.
#[inline(always)]
fn add_terms<S: Simd, const SIZES: bool>(
    simd: S,
    a: [S::f64s; 4],
    x: [S::f64s; 4],
    mut sum: S::f64s,
) -> S::f64s {
    for (a, x) in a.into_iter().zip(x) {
        sum = match SIZES {
            true => simd.add_f64s(sum, simd.abs_f64s(simd.mul_f64s(a, x))),
            false => simd.mul_add_e_f64s(a, x, sum),
        };
    }
    sum
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
pub(crate) fn extend_scaled(out: &mut List<f64>, v: &[f64], w: &[f64], c: f64) {
    let start = out.len();
    out.extend_from_slice_copy(v);
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
        // 6 columns of 19 rows, one of them with the factor zero
        let m: Vec<f64> = (0..6 * 19).map(|i| f64::from(i % 7) - 3.0).collect();
        let p = [1.0, -2.0, 0.0, 3.0, 4.0, -5.0];
        let (mut product, mut sizes, mut both) = (a.clone(), vec![1.0; 19], a.clone());
        add_product(&m, &p, &mut product);
        add_product_and_sizes(&m, &p, &mut both, &mut sizes);
        assert_eq!(product, both);
        for i in 0..19 {
            let terms = p.iter().enumerate().map(|(k, p)| p * m[19 * k + i]);
            assert_eq!(product[i], a[i] + terms.clone().sum::<f64>());
            assert_eq!(sizes[i], 1.0 + terms.map(f64::abs).sum::<f64>());
        }
        assert_eq!(max_abs(&b), 9.0);
        assert_eq!(max_abs(&[]), 0.0);
    }
}
