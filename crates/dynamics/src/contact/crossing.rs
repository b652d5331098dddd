//! Times at which a moving node meets a moving segment: zeros of the cross product of their
//! relative positions, a quartic for second-order motion. See docs/theory/geometry.md, Crossing
//! (paper eq. 50 without its frozen normal).
//!
//! Zeros of a quartic polynomial on [0, 1]: bisection between extrema, which the zeros of the
//! higher derivatives separate. See docs/theory/geometry.md, Crossing.

use super::tolerances::{CLEAR_PRODUCT, CROSS_ROUND_OFF, CROSSING_BEYOND_ENDS};
use crate::vectors::{cross, difference, dot};

/// Motion of a node: x + v t + a t^2/2.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct QuadraticMotion {
    /// Position x at t = 0.
    pub position: [f64; 2],
    /// Velocity v at t = 0.
    pub velocity: [f64; 2],
    /// Acceleration a.
    pub acceleration: [f64; 2],
}

impl QuadraticMotion {
    /// The straight path from one position to another within a time of 1.
    pub fn straight(from: [f64; 2], to: [f64; 2]) -> Self {
        QuadraticMotion {
            position: from,
            velocity: difference(from, to),
            acceleration: [0.0; 2],
        }
    }

    /// Position at a time.
    pub fn at(&self, t: f64) -> [f64; 2] {
        [0, 1].map(|i| self.position[i] + (self.velocity[i] + self.acceleration[i] * t / 2.0) * t)
    }

    /// Velocity at a time.
    pub fn velocity_at(&self, t: f64) -> [f64; 2] {
        [0, 1].map(|i| self.velocity[i] + self.acceleration[i] * t)
    }
}

/// Sense in which a node crosses the line of a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CrossingSense {
    /// From outside the body to its inside.
    Entering,
    /// From inside the body to its outside.
    Leaving,
    /// The node meets the line and stays on its side: it grazes the line, ends on it, or moves
    /// along it.
    Touching,
}

/// A node on the line of a segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Time.
    pub time: f64,
    /// Position xi on the segment, 0 at a and 1 at b.
    pub xi: f64,
    /// Sense.
    pub direction: CrossingSense,
}

/// All times within [0, dt] at which the node s meets the segment from a to b, increasing.
///
/// ```text
/// r x e = 0,   0 <= xi = r.e/e.e <= 1,   r = x_s - x_a, e = x_b - x_a    eq. (10.5)
/// ```
///
/// For motion of second order r x e is a quartic in time with the sign of the gap. A node that
/// moves along the line of the segment meets the segment once, when the node reaches one of the ends.
pub fn crossings(nodes: &[QuadraticMotion; 3], dt: f64) -> Vec<Crossing> {
    if is_clear(nodes, dt) {
        return Vec::new();
    }
    let mut found = line_crossings(nodes, dt);
    found.retain_mut(|crossing| {
        let is_on = (-CROSSING_BEYOND_ENDS..=1.0 + CROSSING_BEYOND_ENDS).contains(&crossing.xi);
        crossing.xi = crossing.xi.clamp(0.0, 1.0);
        is_on
    });
    found
}

/// Whether a node on a straight path stays clearly on one side of the line of the segment, before its end a, or beyond
/// b, at all times.
///
/// On a straight path r x e, -r.e and (r - e).e are quadratic in time. A quadratic function is positive if its
/// Bernstein coefficients are positive; for r x e the coefficients are r0 x e0, (r0 x e1 + r1 x e0)/2 and r1 x e1.
fn is_clear(nodes: &[QuadraticMotion; 3], dt: f64) -> bool {
    if nodes.iter().any(|node| node.acceleration != [0.0; 2]) {
        return false;
    }
    let end = |node: &QuadraticMotion| [0, 1].map(|i| node.position[i] + node.velocity[i] * dt);
    let [s, a, b] = nodes;
    let between = |p: &QuadraticMotion, q: &QuadraticMotion| {
        [
            difference(p.position, q.position),
            difference(end(p), end(q)),
        ]
    };
    let [r, e, beyond] = [between(a, s), between(a, b), between(b, s)];
    let size = |p: [[f64; 2]; 2]| p.as_flattened().iter().map(|x| x.abs()).sum::<f64>();
    let clear = CLEAR_PRODUCT * (size(r) + size(e)) * size(e);
    let least = |sign: f64, of: fn([f64; 2], [f64; 2]) -> f64, p: [[f64; 2]; 2]| {
        let middle = (of(p[0], e[1]) + of(p[1], e[0])) / 2.0;
        let [first, last] = [of(p[0], e[0]), of(p[1], e[1])];
        (sign * first).min(sign * middle).min(sign * last)
    };
    least(1.0, cross, r) > clear
        || least(-1.0, dot, r) > clear
        || least(1.0, dot, beyond) > clear
        || least(-1.0, cross, r) > clear
}

/// The crossings with the infinite line through the segment.
pub fn line_crossings(nodes: &[QuadraticMotion; 3], dt: f64) -> Vec<Crossing> {
    let relative = Relative::new(nodes, dt);
    match relative.cross().zeros() {
        Zeros::At(zeros) => {
            let crossing = |zero: Zero| {
                relative.xi(zero.t).map(|xi| Crossing {
                    time: zero.t * dt,
                    xi,
                    direction: direction(zero),
                })
            };
            zeros.into_iter().filter_map(crossing).collect()
        }
        Zeros::Everywhere => relative.first_on_segment(dt).into_iter().collect(),
    }
}

fn direction(zero: Zero) -> CrossingSense {
    match (zero.before, zero.after) {
        (0 | 1, -1) => CrossingSense::Entering,
        (0 | -1, 1) => CrossingSense::Leaving,
        _ => CrossingSense::Touching,
    }
}

/// Motion of the node and of the end b relative to the end a, as coefficients of the powers of t/dt.
struct Relative {
    /// Vector r = x_s - x_a from the end a to the node
    r: [[f64; 2]; 3],
    /// Vector e = x_b - x_a of the segment
    e: [[f64; 2]; 3],
}

impl Relative {
    fn new([s, a, b]: &[QuadraticMotion; 3], dt: f64) -> Self {
        let coefficients = |p: &QuadraticMotion| {
            let part = |of: fn(&QuadraticMotion) -> [f64; 2], factor: f64| {
                let (p, a) = (of(p), of(a));
                [(p[0] - a[0]) * factor, (p[1] - a[1]) * factor]
            };
            [
                part(|m| m.position, 1.0),
                part(|m| m.velocity, dt),
                part(|m| m.acceleration, dt * dt / 2.0),
            ]
        };
        Relative {
            r: coefficients(s),
            e: coefficients(b),
        }
    }

    /// Cross product r x e, eq. (10.5)
    fn cross(&self) -> Quartic {
        self.product(cross)
    }

    /// A bilinear product of r and e.
    fn product(&self, of: fn([f64; 2], [f64; 2]) -> f64) -> Quartic {
        let mut c = [0.0; 5];
        for (i, r) in self.r.iter().enumerate() {
            for (j, e) in self.e.iter().enumerate() {
                c[i + j] += of(*r, *e);
            }
        }
        Quartic {
            c,
            tolerance: CROSS_ROUND_OFF * size(&self.r) * size(&self.e),
        }
    }

    /// The place xi = r.e/e.e. For a segment of zero length xi is 0 if the node coincides with the segment, else
    /// `None`.
    fn xi(&self, t: f64) -> Option<f64> {
        let [r, e] =
            [&self.r, &self.e].map(|c| [0, 1].map(|i| c[0][i] + (c[1][i] + c[2][i] * t) * t));
        let scale = CROSS_ROUND_OFF * (size(&self.r) + size(&self.e));
        let (along, square) = (dot(r, e), dot(e, e));
        if square > scale * scale {
            Some(along / square)
        } else {
            (dot(r, r) <= scale * scale).then_some(0.0)
        }
    }

    /// First time at which a node that is on the line of the segment at all times is on the segment
    /// itself.
    fn first_on_segment(&self, dt: f64) -> Option<Crossing> {
        // r.e = 0 at the end a, (r - e).e = 0 at b, r.(dr/dt) = 0 where r may vanish
        let to_b = Relative {
            r: [0, 1, 2].map(|k| [0, 1].map(|i| self.r[k][i] - self.e[k][i])),
            e: self.e,
        };
        let rate = Relative {
            r: self.r,
            e: [self.r[1], self.r[2].map(|r| 2.0 * r), [0.0; 2]],
        };
        let mut times = vec![0.0];
        for relative in [self, &to_b, &rate] {
            if let Zeros::At(zeros) = relative.product(dot).zeros() {
                times.extend(zeros.iter().map(|zero| zero.t));
            }
        }
        times.sort_by(f64::total_cmp);
        let on = |t: f64| {
            let xi = self.xi(t)?;
            (-CROSSING_BEYOND_ENDS..=1.0 + CROSSING_BEYOND_ENDS)
                .contains(&xi)
                .then_some(Crossing {
                    time: t * dt,
                    xi,
                    direction: CrossingSense::Touching,
                })
        };
        times.into_iter().find_map(on)
    }
}

/// Bound of all values of a vector polynomial on [0, 1].
fn size(c: &[[f64; 2]; 3]) -> f64 {
    c.iter().flatten().map(|c| c.abs()).sum()
}

/// Number of halvings after which an interval of [0, 1] is no longer than its round-off.
const HALVINGS: usize = 60;

/// A polynomial with the coefficients c0 to c4 on [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Quartic {
    /// Coefficients.
    pub c: [f64; 5],
    /// Absolute value up to which the polynomial counts as zero.
    pub tolerance: f64,
}

/// A zero of the polynomial with the signs before and after the zero; beyond the ends of [0, 1] the sign is 0.
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
    /// The zeros in increasing order; a double zero has equal signs on both sides.
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
    /// signs, a double zero at an extremum that is zero.
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

    /// Increasing list of points that contains 0, 1 and the extrema of the polynomial between them.
    /// The zeros of the third derivative separate the zeros of the second derivative, which separate the zeros of the
    /// first.
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

    /// Start a of a segment at rest from (1, 0) to (-1, 0), with the body below it.
    const A: [f64; 2] = [1.0, 0.0];
    const B: [f64; 2] = [-1.0, 0.0];

    fn still(position: [f64; 2]) -> QuadraticMotion {
        QuadraticMotion {
            position,
            ..QuadraticMotion::default()
        }
    }

    fn node(
        position: [f64; 2],
        velocity: [f64; 2],
        acceleration: [f64; 2],
    ) -> [QuadraticMotion; 3] {
        let s = QuadraticMotion {
            position,
            velocity,
            acceleration,
        };
        [s, still(A), still(B)]
    }

    fn times(nodes: &[QuadraticMotion; 3], dt: f64) -> Vec<(f64, CrossingSense)> {
        let found = crossings(nodes, dt);
        found.iter().map(|c| (c.time, c.direction)).collect()
    }

    #[test]
    fn straight_motion_enters_and_leaves() {
        use CrossingSense::{Entering, Leaving};
        let down = node([0.5, 1.0], [0.0, -2.0], [0.0; 2]);
        assert_eq!(
            crossings(&down, 4.0),
            [Crossing {
                time: 0.5,
                xi: 0.25,
                direction: Entering
            }]
        );
        let up = node([0.0, -1.0], [0.0, 1.0], [0.0; 2]);
        assert_eq!(times(&up, 4.0), [(1.0, Leaving)]);
        assert!(times(&up, 0.9).is_empty(), "too early");
        assert!(times(&node([1.5, 1.0], [0.0, -2.0], [0.0; 2]), 4.0).is_empty());
        assert_eq!(
            line_crossings(&node([1.5, 1.0], [0.0, -2.0], [0.0; 2]), 4.0).len(),
            1
        );
    }

    #[test]
    fn a_thrown_node_has_both_roots_or_grazes() {
        use CrossingSense::{Entering, Leaving, Touching};
        // y = 1 - 3 t + 2 t²
        let found = times(&node([0.0, 1.0], [0.0, -3.0], [0.0, 4.0]), 2.0);
        assert_eq!(found.len(), 2);
        assert!((found[0].0 - 0.5).abs() < 1e-15 && found[0].1 == Entering);
        assert!((found[1].0 - 1.0).abs() < 1e-15 && found[1].1 == Leaving);
        // y = (1 - t)²
        let found = times(&node([0.0, 1.0], [0.0, -2.0], [0.0, 2.0]), 3.0);
        assert_eq!(found.len(), 1);
        assert!((found[0].0 - 1.0).abs() < 1e-7 && found[0].1 == Touching);
    }

    #[test]
    fn ends_belong_to_the_segment() {
        for (x, xi) in [(1.0, 0.0), (-1.0, 1.0)] {
            let found = crossings(&node([x, 1.0], [0.0, -1.0], [0.0; 2]), 2.0);
            assert_eq!((found.len(), found[0].xi), (1, xi));
        }
        let outside = node([1.0 + 1e-8, 1.0], [0.0, -1.0], [0.0; 2]);
        assert!(crossings(&outside, 2.0).is_empty());
    }

    #[test]
    fn start_and_end_of_the_time_belong_to_it() {
        use CrossingSense::{Entering, Leaving, Touching};
        assert_eq!(
            times(&node([0.0; 2], [0.0, -1.0], [0.0; 2]), 1.0),
            [(0.0, Entering)]
        );
        assert_eq!(
            times(&node([0.0; 2], [0.0, 1.0], [0.0; 2]), 1.0),
            [(0.0, Leaving)]
        );
        assert_eq!(
            times(&node([0.0, 1.0], [0.0, -1.0], [0.0; 2]), 1.0),
            [(1.0, Touching)]
        );
    }

    #[test]
    fn a_node_in_the_line_of_the_segment_meets_its_end() {
        use CrossingSense::Touching;
        let inwards = node([3.0, 0.0], [-1.0, 0.0], [0.0; 2]);
        assert_eq!(times(&inwards, 9.0).len(), 1);
        let [(time, direction)] = times(&inwards, 9.0)[..] else {
            panic!("one")
        };
        assert!((time - 2.0).abs() < 1e-14 && direction == Touching);
        assert!(times(&node([3.0, 0.0], [1.0, 0.0], [0.0; 2]), 9.0).is_empty());
        assert_eq!(
            times(&node([0.5, 0.0], [0.0; 2], [0.0; 2]), 9.0),
            [(0.0, Touching)]
        );
        let parallel = node([3.0, 0.1], [-1.0, 0.0], [0.0; 2]);
        assert!(times(&parallel, 9.0).is_empty());
    }

    #[test]
    fn a_segment_without_length_is_met_as_a_point() {
        let point = still([0.0, 0.0]);
        let meets = |velocity: [f64; 2]| {
            let s = QuadraticMotion {
                position: [2.0, 2.0],
                velocity,
                acceleration: [0.0; 2],
            };
            crossings(&[s, point, point], 4.0)
        };
        assert!(meets([-1.0, -0.9]).is_empty());
        let found = meets([-1.0, -1.0]);
        assert!(found.len() == 1 && (found[0].time - 2.0).abs() < 1e-13);
    }

    #[test]
    fn a_segment_that_turns_inside_out_is_not_met_from_afar() {
        // b passes through a at t = 1; the node stays away from the line
        let b = QuadraticMotion {
            position: [-1.0, 0.0],
            velocity: [1.0, 0.0],
            acceleration: [0.0; 2],
        };
        assert!(crossings(&[still([0.5, 0.7]), still([0.0; 2]), b], 2.0).is_empty());
    }

    #[test]
    fn both_sides_may_move() {
        // plate and node fly along together; the node falls on it
        let fly = |position: [f64; 2], down: f64| QuadraticMotion {
            position,
            velocity: [1e3, -down],
            acceleration: [7.0, 0.0],
        };
        let nodes = [fly([0.0, 1.0], 1.0), fly(A, 0.0), fly(B, 0.0)];
        let found = crossings(&nodes, 2.0);
        assert!((found[0].time - 1.0).abs() < 1e-12 && (found[0].xi - 0.5).abs() < 1e-12);
    }
}

#[cfg(test)]
mod quartic_tests {
    use super::*;

    /// The polynomial k (t - r1) (t - r2) ...
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
