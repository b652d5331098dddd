//! Zeros of a quartic polynomial on [0, 1]: bisection between extrema, which the zeros of the
//! higher derivatives separate. Section 10 of docs/theory.md, Crossing.

/// Halvings that leave an interval of [0, 1] no longer than its round-off.
const HALVINGS: usize = 60;

/// A polynomial c0 + c1 t + ... + c4 t^4 on [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Quartic {
    /// Coefficients.
    pub c: [f64; 5],
    /// Absolute value up to which the polynomial counts as zero.
    pub tolerance: f64,
}

/// A zero with the signs of the polynomial before and after it; 0 beyond the ends of [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Zero {
    /// Position t.
    pub t: f64,
    /// Sign before.
    pub before: i8,
    /// Sign after.
    pub after: i8,
}

/// The zeros of a polynomial on [0, 1].
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Zeros {
    /// In increasing order, with double zeros (equal signs on both sides).
    At(Vec<Zero>),
    /// The polynomial is zero on all of [0, 1].
    Everywhere,
}

impl Quartic {
    /// Value at t.
    pub fn at(&self, t: f64) -> f64 {
        value(&self.c, t)
    }

    /// All zeros.
    ///
    /// Between its extrema the polynomial is monotone: a zero lies between two extrema of different
    /// signs, a double one at an extremum that is zero.
    pub fn zeros(&self) -> Zeros {
        if self.keeps_its_sign() {
            return Zeros::At(Vec::new());
        }
        let points = self.extrema();
        let mut found = Vec::new();
        // The last point that is not zero and its sign; the smallest of the zeros since then.
        let mut last: Option<(f64, i8)> = None;
        let mut flat: Option<f64> = None;
        for &t in &points {
            let sign = self.sign(t);
            if sign == 0 {
                let is_smaller = |f: &f64| self.at(t).abs() < self.at(*f).abs();
                if flat.as_ref().is_none_or(is_smaller) {
                    flat = Some(t);
                }
                continue;
            }
            let zero = match (last, flat) {
                (None, Some(_)) => Some((0.0, 0)),
                (None, None) => None,
                (Some((from, before)), _) if before != sign => {
                    Some((bisect(&self.c, from, t), before))
                }
                (Some((_, before)), Some(flat)) => Some((flat, before)),
                (Some(_), None) => None,
            };
            found.extend(zero.map(|(t, before)| Zero {
                t,
                before,
                after: sign,
            }));
            (last, flat) = (Some((t, sign)), None);
        }
        match (last, flat) {
            (None, _) => return Zeros::Everywhere,
            (Some((_, before)), Some(t)) => found.push(Zero {
                t,
                before,
                after: 0,
            }),
            _ => {}
        }
        Zeros::At(found)
    }

    /// Whether all Bernstein coefficients on [0, 1] have one sign: then there is no zero.
    fn keeps_its_sign(&self) -> bool {
        let [c0, c1, c2, c3, c4] = self.c;
        let b = [
            c0,
            c0 + c1 / 4.0,
            c0 + c1 / 2.0 + c2 / 6.0,
            c0 + 0.75 * c1 + c2 / 2.0 + c3 / 4.0,
            c0 + c1 + c2 + c3 + c4,
        ];
        b.iter().all(|b| *b > self.tolerance) || b.iter().all(|b| *b < -self.tolerance)
    }

    /// 0, 1 and the extrema between them, among other points, increasing: the zeros of the third
    /// derivative separate those of the second, these those of the first.
    fn extrema(&self) -> Vec<f64> {
        let first = derivative(&self.c);
        let second = derivative(&first);
        let third = derivative(&second);
        let mut points = vec![0.0, 1.0];
        for c in [third, second, first] {
            let between = |ends: &[f64]| {
                let [from, to] = [ends[0], ends[1]];
                let changes = (value(&c, from) < 0.0) != (value(&c, to) < 0.0);
                changes.then(|| bisect(&c, from, to))
            };
            let zeros: Vec<f64> = points.windows(2).filter_map(between).collect();
            points.extend(zeros);
            points.sort_by(f64::total_cmp);
        }
        points
    }

    fn sign(&self, t: f64) -> i8 {
        let value = self.at(t);
        i8::from(value > self.tolerance) - i8::from(value < -self.tolerance)
    }
}

fn value(c: &[f64; 5], t: f64) -> f64 {
    c.iter().rev().fold(0.0, |sum, c| sum * t + c)
}

fn derivative(c: &[f64; 5]) -> [f64; 5] {
    [c[1], 2.0 * c[2], 3.0 * c[3], 4.0 * c[4], 0.0]
}

/// A change of sign between two points of different signs.
fn bisect(c: &[f64; 5], mut from: f64, mut to: f64) -> f64 {
    let is_negative = value(c, from) < 0.0;
    for _ in 0..HALVINGS {
        let middle = from + (to - from) / 2.0;
        let found = value(c, middle);
        if found == 0.0 {
            return middle;
        }
        if (found < 0.0) == is_negative {
            from = middle;
        } else {
            to = middle;
        }
    }
    to
}

#[cfg(test)]
mod tests {
    use super::*;

    /// k (t - r1) (t - r2) ...
    fn product(k: f64, roots: &[f64]) -> Quartic {
        let mut c = [k, 0.0, 0.0, 0.0, 0.0];
        for r in roots {
            let mut next = [0.0; 5];
            for i in 0..5 {
                next[i] = -r * c[i] + if i > 0 { c[i - 1] } else { 0.0 };
            }
            c = next;
        }
        let tolerance = 1e-15 * c.iter().map(|c| c.abs()).sum::<f64>();
        Quartic { c, tolerance }
    }

    fn zeros(k: f64, roots: &[f64]) -> Vec<Zero> {
        match product(k, roots).zeros() {
            Zeros::At(zeros) => zeros,
            Zeros::Everywhere => panic!("not zero"),
        }
    }

    #[test]
    fn simple_zeros_are_found_with_their_signs() {
        let found = zeros(3.0, &[0.2, 0.7, 0.3, 0.9]);
        for (zero, t) in found.iter().zip([0.2, 0.3, 0.7, 0.9]) {
            assert!((zero.t - t).abs() < 1e-14, "{zero:?}");
            assert_eq!(zero.before, -zero.after);
        }
        assert_eq!((found.len(), found[0].before), (4, 1));
        assert!(zeros(1.0, &[-0.1, 1.1, 2.0]).is_empty());
    }

    #[test]
    fn double_zeros_are_found() {
        for t in [0.1, 0.5, 1.0 / 3.0, 0.99] {
            for (k, others) in [(1.0, vec![]), (-2.0, vec![1.5]), (1.0, vec![-0.5, 3.0])] {
                let roots = [vec![t, t], others].concat();
                let found = zeros(k, &roots);
                assert_eq!(found.len(), 1, "{roots:?}");
                assert!((found[0].t - t).abs() < 1e-6, "{found:?}");
                assert_eq!(found[0].before, found[0].after);
            }
        }
        let found = zeros(1.0, &[0.25, 0.25, 0.75, 0.75]);
        assert_eq!(found.len(), 2);
    }

    #[test]
    fn zeros_at_the_ends_have_no_sign_beyond() {
        let found = zeros(1.0, &[0.0, 1.0]);
        let signs: Vec<(i8, i8)> = found.iter().map(|z| (z.before, z.after)).collect();
        assert_eq!(signs, [(0, -1), (-1, 0)]);
    }

    #[test]
    fn nothing_is_zero_everywhere() {
        assert_eq!(product(0.0, &[]).zeros(), Zeros::Everywhere);
        let flat = Quartic {
            c: [1e-20, -1e-20, 0.0, 1e-20, 0.0],
            tolerance: 1e-18,
        };
        assert_eq!(flat.zeros(), Zeros::Everywhere);
    }
}
