//! Symmetric tensors whose components 13 and 23 are zero, as in the plane and in bodies of revolution. Their products
//! are matrices that act on strains (11, 22, 33, 2*12). See docs/theory/materials.md.
//!
//! With `HOOP` the component 33 is used. Without `HOOP` the strain 33 is zero, as in plane strain, and formulas omit
//! its products.

use std::array::from_fn;
use std::ops::{Add, AddAssign, Div, Mul, Sub, SubAssign};

use nalgebra::{Matrix2, Matrix4, Vector4};

use super::number::{LANES, Number};

/// A symmetric tensor.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Symmetric<T = f64> {
    /// Component 11.
    pub x: T,
    /// Component 22.
    pub y: T,
    /// Component 33: across the plane, or around the axis of a body of revolution.
    pub z: T,
    /// Component 12.
    pub w: T,
}

impl<T: Number> Symmetric<T> {
    /// A tensor with the components 11, 22, 33 and 12.
    #[inline(always)]
    pub fn new(x: T, y: T, z: T, w: T) -> Self {
        Symmetric { x, y, z, w }
    }

    /// 0
    #[inline(always)]
    pub fn zeros() -> Self {
        Self::default()
    }

    /// I
    #[inline(always)]
    pub fn identity() -> Self {
        let one = T::all(1.0);
        Symmetric::new(one, one, one, T::default())
    }

    /// The tensor of a function of every component.
    #[inline(always)]
    pub fn map<U: Number>(&self, of: impl Fn(T) -> U) -> Symmetric<U> {
        Symmetric::new(of(self.x), of(self.y), of(self.z), of(self.w))
    }

    /// A tensor each of whose components is a function of the components of two tensors.
    #[inline(always)]
    pub fn with(&self, b: &Self, of: impl Fn(T, T) -> T) -> Self {
        let (x, y) = (of(self.x, b.x), of(self.y, b.y));
        Symmetric::new(x, y, of(self.z, b.z), of(self.w, b.w))
    }

    /// The product of the tensor and a number.
    #[inline(always)]
    pub fn times(&self, factor: T) -> Self {
        self.map(|a| a * factor)
    }

    /// The sum A + a I.
    #[inline(always)]
    pub fn plus_isotropic(&self, a: T) -> Self {
        Symmetric::new(self.x + a, self.y + a, self.z + a, self.w)
    }

    /// The components 11, 22, 33, 12.
    #[inline(always)]
    pub fn components(&self) -> [T; 4] {
        [self.x, self.y, self.z, self.w]
    }

    /// The tensor of one element.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> Symmetric {
        self.map(|a| a.lane(lane))
    }

    /// Tensors for all elements, each given by a function.
    #[inline(always)]
    pub fn of_lanes(of: impl Fn(usize) -> Symmetric) -> Self {
        let all = each_element::<T, Symmetric>(of);
        let at = |component: fn(&Symmetric) -> f64| T::of_lanes(|lane| component(&all[lane]));
        Symmetric::new(at(|a| a.x), at(|a| a.y), at(|a| a.z), at(|a| a.w))
    }

    /// A:B
    #[inline(always)]
    pub fn contract<const HOOP: bool>(&self, b: &Self) -> T {
        let of_plane = self.x * b.x + self.y * b.y;
        let shear = self.w * b.w * 2.0;
        match HOOP {
            true => of_plane + self.z * b.z + shear,
            false => of_plane + shear,
        }
    }
}

impl Symmetric {
    /// The components in the plane as a matrix.
    pub fn in_plane(&self) -> Matrix2<f64> {
        Matrix2::new(self.x, self.w, self.w, self.y)
    }

    /// The components 11, 22, 33, 12 as a vector, whose product with strains (11, 22, 33, 2*12) is A:E.
    pub fn vector(&self) -> Vector4<f64> {
        self.components().into()
    }

    /// The tensor with the given components in the plane and the component 33.
    pub fn of_plane(a: &Matrix2<f64>, z: f64) -> Self {
        Symmetric::new(a.m11, a.m22, z, a.m12)
    }

    /// Largest absolute component.
    pub fn amax(&self) -> f64 {
        let sizes = self.components().map(f64::abs);
        sizes.into_iter().fold(0.0, f64::max)
    }

    /// (A:A)^(1/2)
    pub fn norm(&self) -> f64 {
        contract(self, self).sqrt()
    }
}

impl<T: Number> Add for Symmetric<T> {
    type Output = Self;

    #[inline(always)]
    fn add(self, b: Self) -> Self {
        self.with(&b, |a, b| a + b)
    }
}

impl<T: Number> Sub for Symmetric<T> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        self.with(&b, |a, b| a - b)
    }
}

impl<T: Number> AddAssign for Symmetric<T> {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl<T: Number> SubAssign for Symmetric<T> {
    #[inline(always)]
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}

impl<T: Number> Add for &Symmetric<T> {
    type Output = Symmetric<T>;

    #[inline(always)]
    fn add(self, b: Self) -> Symmetric<T> {
        *self + *b
    }
}

impl<T: Number> Sub for &Symmetric<T> {
    type Output = Symmetric<T>;

    #[inline(always)]
    fn sub(self, b: Self) -> Symmetric<T> {
        *self - *b
    }
}

impl Mul<f64> for Symmetric {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        self.times(factor)
    }
}

impl Mul<f64> for &Symmetric {
    type Output = Symmetric;

    fn mul(self, factor: f64) -> Symmetric {
        self.times(factor)
    }
}

impl std::iter::Sum for Symmetric {
    fn sum<I: Iterator<Item = Symmetric>>(all: I) -> Symmetric {
        all.fold(Symmetric::zeros(), |sum, a| sum + a)
    }
}

impl Div<f64> for Symmetric {
    type Output = Self;

    fn div(self, by: f64) -> Self {
        self.map(|a| a / by)
    }
}

/// The identity I as a symmetric tensor.
pub const IDENTITY: Symmetric = Symmetric {
    x: 1.0,
    y: 1.0,
    z: 1.0,
    w: 0.0,
};

/// The product A:B of two symmetric tensors.
pub fn contract(a: &Symmetric, b: &Symmetric) -> f64 {
    a.contract::<true>(b)
}

/// Determinant of the part in the plane.
#[inline(always)]
pub fn minor<T: Number>(a: &Symmetric<T>) -> T {
    a.x * a.y - a.w * a.w
}

/// Cofactor tensor det(A) A^-1.
#[inline(always)]
pub fn cofactor<T: Number>(a: &Symmetric<T>) -> Symmetric<T> {
    Symmetric::new(a.y * a.z, a.x * a.z, minor(a), a.w * a.z * -1.0)
}

/// A matrix that acts on strains (11, 22, 33, 2*12), for example the tangent dS/dE of a law.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tangent<T = f64>(pub [[T; 4]; 4]);

impl<T: Number> Tangent<T> {
    /// The matrix with the given entries.
    #[inline(always)]
    pub fn of(entry: impl Fn(usize, usize) -> T) -> Self {
        Tangent(square(entry))
    }

    /// C:E
    #[inline(always)]
    pub fn times<const HOOP: bool>(&self, e: &Symmetric<T>) -> Symmetric<T> {
        let row = |c: &[T; 4]| {
            let of_plane = c[0] * e.x + c[1] * e.y;
            let shear = c[3] * (e.w * 2.0);
            match HOOP {
                true => of_plane + c[2] * e.z + shear,
                false => of_plane + shear,
            }
        };
        let [x, y, z, w] = &self.0;
        Symmetric::new(row(x), row(y), row(z), row(w))
    }

    /// The matrix of one element.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> Tangent {
        Tangent::of(|i, j| self.0[i][j].lane(lane))
    }

    /// Matrices for all elements, each given by a function.
    pub fn of_lanes(of: impl Fn(usize) -> Tangent) -> Self {
        let all = each_element::<T, Tangent>(of);
        Tangent::of(|i, j| T::of_lanes(|lane| all[lane].0[i][j]))
    }
}

impl Tangent {
    /// The matrix whose columns are the changes of a stress for unit strains 11, 22, 33 and 2*12.
    pub fn of_columns(of: impl Fn(&Symmetric) -> Symmetric) -> Self {
        let columns: [[f64; 4]; 4] = from_fn(|k| {
            let mut unit = [0.0; 4];
            unit[k] = if k == 3 { 0.5 } else { 1.0 };
            let [x, y, z, w] = unit;
            of(&Symmetric::new(x, y, z, w)).components()
        });
        Tangent::of(|i, j| columns[j][i])
    }

    /// The entries as a matrix.
    pub fn matrix(&self) -> Matrix4<f64> {
        Matrix4::from_fn(|i, j| self.0[i][j])
    }
}

/// One value for every element.
fn each_element<T: Number, V: Default>(of: impl Fn(usize) -> V) -> [V; LANES] {
    from_fn(|lane| match lane < T::ELEMENTS {
        true => of(lane),
        false => V::default(),
    })
}

/// A matrix from its entries, written without a loop, so that unused entries need no time.
#[inline(always)]
fn square<T>(at: impl Fn(usize, usize) -> T) -> [[T; 4]; 4] {
    [
        [at(0, 0), at(0, 1), at(0, 2), at(0, 3)],
        [at(1, 0), at(1, 1), at(1, 2), at(1, 3)],
        [at(2, 0), at(2, 1), at(2, 2), at(2, 3)],
        [at(3, 0), at(3, 1), at(3, 2), at(3, 3)],
    ]
}

/// The matrix A x B, row by row, which maps E to (B:E) A.
#[inline(always)]
pub fn dyad<T: Number>(a: &Symmetric<T>, b: &Symmetric<T>) -> [[T; 4]; 4] {
    let (a, b) = (a.components(), b.components());
    square(|i, j| a[i] * b[j])
}

/// The matrix I x A + A x I, row by row.
#[inline(always)]
pub fn with_identity<T: Number>(a: &Symmetric<T>) -> [[T; 4]; 4] {
    let a = a.components();
    square(|i, j| match (i < 3, j < 3) {
        (true, true) => a[i] + a[j],
        (true, false) => a[j],
        (false, true) => a[i],
        (false, false) => T::default(),
    })
}

/// The matrix A o A, row by row, which maps E to A E A.
#[inline(always)]
pub fn product<T: Number>(a: &Symmetric<T>) -> [[T; 4]; 4] {
    let Symmetric { x, y, z, w } = *a;
    let (xx, yy, ww) = (x * x, y * y, w * w);
    let (xw, yw, zero) = (x * w, y * w, T::default());
    [
        [xx, ww, zero, xw],
        [ww, yy, zero, yw],
        [zero, zero, z * z, zero],
        [xw, yw, zero, (x * y + ww) * 0.5],
    ]
}
