//! A small reproducible generator of random numbers (splitmix64).

use nalgebra::{DMatrix, DVector};

pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in [low, high).
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform in 0..n.
    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    pub fn vector(&mut self, n: usize, low: f64, high: f64) -> DVector<f64> {
        DVector::from_fn(n, |_, _| self.range(low, high))
    }

    pub fn matrix(&mut self, rows: usize, columns: usize) -> DMatrix<f64> {
        DMatrix::from_fn(rows, columns, |_, _| self.range(-1.0, 1.0))
    }

    /// A A^T of rank at most `rank`, plus `shift` I.
    pub fn gram(&mut self, n: usize, rank: usize, shift: f64) -> DMatrix<f64> {
        let a = self.matrix(n, rank);
        &a * a.transpose() + DMatrix::identity(n, n) * shift
    }
}
