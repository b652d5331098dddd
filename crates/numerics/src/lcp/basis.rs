//! The revised basis of Lemke's method, of which only the inverse of the kernel is formed, and the lexicographic ratio
//! test.
//!
//! In the system  w - M z - d z0 = q  let beta be the rows whose w is not basic, alpha the columns
//! whose z is. The basic z and z0 solve the small system K y = b_beta with the kernel
//! K = -[M_beta,alpha  d_beta]; the basic w follow from their rows: w = b + M_alpha y + d y0. Every
//! exchange changes K by a column, a row, or both, and its inverse by one outer product.
//!
//! The right-hand side is perturbed to q + eps p + eps^2 e_1 + eps^3 e_2 + ..., p > 0, with an infinitesimal eps:
//! ratios that tie on q are compared on p, then on the columns of the inverse basis. The entries of p are made with the
//! golden ratio, so the comparison on p almost always decides.

use super::dense::{Factors, axpy, dot, max_abs};

/// Marks an index outside the kernel.
const NONE: usize = usize::MAX;

/// The operations on the matrix M that pivoting needs.
pub(crate) trait PivotMatrix {
    /// Number of rows and columns.
    fn size(&self) -> usize;
    /// out += M z, where z is given as pairs (column, value).
    fn add_product(&self, z: &[(usize, f64)], out: &mut [f64]);
    /// M_ij.
    fn entry(&self, i: usize, j: usize) -> f64;
}

/// A variable of the enlarged problem.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Variable {
    /// w_i.
    W(usize),
    /// z_i.
    Z(usize),
    /// The artificial variable of the covering vector.
    Z0,
}

/// Values of the variables; those that are not basic are zero.
pub(crate) struct Values {
    /// z, followed by z0.
    pub z: Vec<f64>,
    /// w.
    pub w: Vec<f64>,
}

impl Values {
    /// The value of a variable.
    pub fn get(&self, variable: Variable) -> f64 {
        match variable {
            Variable::W(i) => self.w[i],
            Variable::Z(i) => self.z[i],
            Variable::Z0 => self.z[self.w.len()],
        }
    }

    /// Mutable value of a variable.
    pub fn at(&mut self, variable: Variable) -> &mut f64 {
        match variable {
            Variable::W(i) => &mut self.w[i],
            Variable::Z(i) => &mut self.z[i],
            Variable::Z0 => &mut self.z[self.w.len()],
        }
    }
}

/// Basis of the path: which variables are basic, and the inverse of the kernel.
pub(crate) struct Basis<'a, M> {
    matrix: &'a M,
    d: &'a [f64],
    /// Rows of the kernel, in the order of the columns of its inverse.
    rows: Vec<usize>,
    /// Columns of the kernel (`size` stands for z0), in the order of the rows of its inverse.
    columns: Vec<usize>,
    /// Inverse of the kernel, stored by columns.
    inverse: Vec<Vec<f64>>,
    /// Position of each row in `rows`.
    row_place: Vec<usize>,
    /// Position of each column in `columns`.
    column_place: Vec<usize>,
}

impl<'a, M: PivotMatrix> Basis<'a, M> {
    /// The basis of all w except row `s`, where z0 is basic.
    pub fn new(matrix: &'a M, d: &'a [f64], s: usize) -> Self {
        let size = matrix.size();
        let mut basis = Self {
            matrix,
            d,
            rows: vec![s],
            columns: vec![size],
            inverse: vec![vec![-1.0 / d[s]]],
            row_place: vec![NONE; size],
            column_place: vec![NONE; size + 1],
        };
        basis.row_place[s] = 0;
        basis.column_place[size] = 0;
        basis
    }

    /// Number of rows of the problem.
    pub fn size(&self) -> usize {
        self.d.len()
    }

    /// Whether a variable is basic.
    pub fn contains(&self, variable: Variable) -> bool {
        match variable {
            Variable::W(i) => self.row_place[i] == NONE,
            Variable::Z(i) => self.column_place[i] != NONE,
            Variable::Z0 => self.column_place[self.size()] != NONE,
        }
    }

    /// All basic variables, in a fixed order.
    pub fn variables(&self) -> impl Iterator<Item = Variable> + '_ {
        let size = self.size();
        let kernel = (0..=size).filter(|j| self.column_place[*j] != NONE);
        let kernel = kernel.map(move |j| {
            if j == size {
                Variable::Z0
            } else {
                Variable::Z(j)
            }
        });
        let slack = (0..size)
            .filter(|i| self.row_place[*i] == NONE)
            .map(Variable::W);
        kernel.chain(slack)
    }

    /// Column of a variable in w - M z - d z0 = q.
    pub fn column(&self, variable: Variable) -> Vec<f64> {
        let mut column = vec![0.0; self.size()];
        match variable {
            Variable::W(i) => column[i] = 1.0,
            Variable::Z(j) => self.matrix.add_product(&[(j, -1.0)], &mut column),
            Variable::Z0 => axpy(-1.0, self.d, &mut column),
        }
        column
    }

    /// B^-1 b.
    pub fn solve(&self, b: &[f64]) -> Values {
        self.complete(b, &self.kernel_solve(|i| b[i])).0
    }

    /// B^-1 b with one correction by the residual, and the largest residual before and after the correction.
    pub fn solve_refined(&self, b: &[f64]) -> (Values, f64, f64) {
        let mut y = self.kernel_solve(|i| b[i]);
        let (_, residual) = self.complete(b, &y);
        // K dy = b - K y on the rows of the kernel
        let correction = self.kernel_solve(|i| residual[i]);
        y.iter_mut().zip(&correction).for_each(|(y, c)| *y += c);
        let before = max_abs(&residual);
        let (values, residual) = self.complete(b, &y);
        (values, before, max_abs(&residual))
    }

    /// K^-1 c.
    fn kernel_solve(&self, c: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut y = vec![0.0; self.columns.len()];
        for (row, column) in self.rows.iter().zip(&self.inverse) {
            axpy(c(*row), column, &mut y);
        }
        y
    }

    /// The basic w that belong to the kernel values y, and the residual of the kernel rows.
    fn complete(&self, b: &[f64], y: &[f64]) -> (Values, Vec<f64>) {
        let size = self.size();
        let mut values = Values {
            z: vec![0.0; size + 1],
            w: b.to_vec(),
        };
        let mut terms = Vec::with_capacity(y.len());
        for (column, value) in self.columns.iter().zip(y) {
            values.z[*column] = *value;
            if *column < size {
                terms.push((*column, *value));
            }
        }
        // w = b + M_alpha y + d y0, eq. (8.5)
        self.matrix.add_product(&terms, &mut values.w);
        axpy(values.z[size], self.d, &mut values.w);
        let mut residual = vec![0.0; size];
        for row in &self.rows {
            std::mem::swap(&mut residual[*row], &mut values.w[*row]);
        }
        (values, residual)
    }

    /// Exchanges `leaving` for `entering`, whose column in the basis is y = B^-1 a.
    pub fn exchange(&mut self, entering: Variable, leaving: Variable, y: &Values) {
        let kernel: Vec<f64> = self.columns.iter().map(|j| y.z[*j]).collect();
        match (entering, leaving) {
            (Variable::W(s), Variable::W(r)) => self.replace_row(s, r, &kernel, y.w[r]),
            (Variable::W(s), _) => self.shrink(s, self.column_of(leaving)),
            (_, Variable::W(r)) => self.grow(self.column_of(entering), r, &kernel, y.w[r]),
            _ => self.replace_column(self.column_of(entering), self.column_of(leaving), &kernel),
        }
    }

    /// Kernel column of z_j or z0.
    fn column_of(&self, variable: Variable) -> usize {
        match variable {
            Variable::W(i) | Variable::Z(i) => i,
            Variable::Z0 => self.size(),
        }
    }

    /// Row i of the kernel, -[M_i,alpha  d_i].
    fn kernel_row(&self, i: usize) -> Vec<f64> {
        let entry = |j: &usize| {
            if *j == self.size() {
                self.d[i]
            } else {
                self.matrix.entry(i, *j)
            }
        };
        self.columns.iter().map(|j| -entry(j)).collect()
    }

    /// Adds column j and row r. With u = k_r K^-1 and the pivot p = a_r - u a, the inverse K^-1 becomes [K^-1 + y u /
    /// p, -y / p; -u / p, 1 / p].
    fn grow(&mut self, j: usize, r: usize, y: &[f64], pivot: f64) {
        let row = self.kernel_row(r);
        for column in &mut self.inverse {
            let u = dot(&row, column) / pivot;
            axpy(u, y, column);
            column.push(-u);
        }
        let mut last: Vec<f64> = y.iter().map(|v| -v / pivot).collect();
        last.push(1.0 / pivot);
        self.inverse.push(last);
        self.row_place[r] = self.rows.len();
        self.rows.push(r);
        self.column_place[j] = self.columns.len();
        self.columns.push(j);
    }

    /// Puts column j in the place of column `old`: v - (y - e_p) v_p / y_p for every column v.
    fn replace_column(&mut self, j: usize, old: usize, y: &[f64]) {
        let place = self.column_place[old];
        for column in &mut self.inverse {
            let factor = column[place] / y[place];
            axpy(-factor, y, column);
            column[place] = factor;
        }
        self.column_place[old] = NONE;
        self.column_place[j] = place;
        self.columns[place] = j;
    }

    /// Puts row r in the place of row s, whose column of the inverse is y. Every other column v becomes v - y (k_r v) /
    /// (k_r y), and y becomes y / (k_r y).
    fn replace_row(&mut self, s: usize, r: usize, y: &[f64], w_r: f64) {
        let place = self.row_place[s];
        let row = self.kernel_row(r);
        let pivot = -w_r;
        for (k, column) in self.inverse.iter_mut().enumerate() {
            if k == place {
                column.iter_mut().for_each(|v| *v /= pivot);
            } else {
                axpy(-dot(&row, column) / pivot, y, column);
            }
        }
        self.row_place[s] = NONE;
        self.row_place[r] = place;
        self.rows[place] = r;
    }

    /// Removes row s and column j. With v, the column of the inverse for row s, every other column x becomes x - v x_j
    /// / v_j and loses its entry j.
    fn shrink(&mut self, s: usize, j: usize) {
        let (row, place) = (self.row_place[s], self.column_place[j]);
        let removed = self.inverse.swap_remove(row);
        for column in &mut self.inverse {
            axpy(-column[place] / removed[place], &removed, column);
            column.swap_remove(place);
        }
        self.rows.swap_remove(row);
        self.columns.swap_remove(place);
        self.row_place[s] = NONE;
        self.column_place[j] = NONE;
        if let Some(moved) = self.rows.get(row) {
            self.row_place[*moved] = row;
        }
        if let Some(moved) = self.columns.get(place) {
            self.column_place[*moved] = place;
        }
    }

    /// Recomputes the inverse of the kernel. If the kernel is singular, the old inverse stays and the result is false.
    pub fn reinvert(&mut self) -> bool {
        let size = self.columns.len();
        let mut kernel = vec![0.0; size * size];
        for (i, row) in self.rows.iter().enumerate() {
            for (j, value) in self.kernel_row(*row).into_iter().enumerate() {
                kernel[i + j * size] = value;
            }
        }
        let Some(factors) = Factors::lu(kernel, size) else {
            return false;
        };
        for (j, column) in self.inverse.iter_mut().enumerate() {
            column.fill(0.0);
            column[j] = 1.0;
            factors.solve(column);
        }
        true
    }
}

/// The first perturbation p, of length n: 1 + fractional part of i / golden ratio.
pub(crate) fn perturbation(n: usize) -> Vec<f64> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    (1..=n).map(|i| 1.0 + (i as f64 * GOLDEN).fract()).collect()
}

/// Candidates of a ratio test, each with the column entry that divides its value.
pub(crate) struct Candidates {
    rows: Vec<(Variable, f64)>,
    tolerance: f64,
}

impl Candidates {
    /// Variables that may leave the basis, with positive divisors; ratios that differ by less than `tolerance` are
    /// tied.
    pub fn new(rows: Vec<(Variable, f64)>, tolerance: f64) -> Self {
        Self { rows, tolerance }
    }

    /// Keeps the candidates whose ratio value / divisor ties with the smallest.
    pub fn keep_smallest(&mut self, value: impl Fn(Variable) -> f64) {
        let ratios: Vec<f64> = self.rows.iter().map(|(v, y)| value(*v) / y).collect();
        let smallest = ratios.iter().copied().fold(f64::INFINITY, f64::min);
        let limit = smallest + self.tolerance * smallest.abs().max(1.0);
        let mut ratio = ratios.into_iter();
        self.rows
            .retain(|_| ratio.next().is_some_and(|r| r <= limit));
    }

    /// Whether a variable is still a candidate.
    pub fn contains(&self, variable: Variable) -> bool {
        self.rows.iter().any(|(v, _)| *v == variable)
    }

    /// The first of the remaining candidates.
    pub fn first(&self) -> Option<Variable> {
        self.rows.first().map(|(v, _)| *v)
    }

    /// The candidate that remains after ties have been broken, first by the values for p and then by the columns of the
    /// inverse basis.
    pub fn break_ties<M: PivotMatrix>(
        mut self,
        basis: &Basis<M>,
        perturbed: &Values,
    ) -> Option<Variable> {
        if self.rows.len() > 1 {
            self.keep_smallest(|v| perturbed.get(v));
        }
        for j in 0..basis.size() {
            if self.rows.len() < 2 {
                break;
            }
            let column = basis.solve(&basis.column(Variable::W(j)));
            self.keep_smallest(|v| column.get(v));
        }
        self.first()
    }
}
