//! Vectors of the plane: products, lengths and angles; bounding circles and their binary hierarchies, for
//! overlaps and nearest neighbours: the territories of Zhong & Nilsson (1989),
//! docs/theory/geometry.md.

/// Vector q - p from `p` to `q`.
#[inline]
pub fn difference(p: [f64; 2], q: [f64; 2]) -> [f64; 2] {
    [q[0] - p[0], q[1] - p[1]]
}

/// Scalar product p.q.
#[inline]
pub fn dot(p: [f64; 2], q: [f64; 2]) -> f64 {
    p[0] * q[0] + p[1] * q[1]
}

/// Cross product p x q, the component out of the plane; the product is positive if q points to the left of p.
#[inline]
pub fn cross(p: [f64; 2], q: [f64; 2]) -> f64 {
    p[0] * q[1] - p[1] * q[0]
}

/// Length sqrt(p.p), for lengths whose squares neither overflow nor underflow.
#[inline]
pub fn length(p: [f64; 2]) -> f64 {
    dot(p, p).sqrt()
}

/// Distance of two points, also if its square underflows or overflows.
#[inline]
pub fn distance(p: [f64; 2], q: [f64; 2]) -> f64 {
    let d = difference(p, q);
    match dot(d, d) {
        square if square.is_normal() => square.sqrt(),
        _ => d[0].hypot(d[1]),
    }
}

/// Angle from p to q, between -pi and pi, positive to the left (rad).
#[inline]
pub fn angle(p: [f64; 2], q: [f64; 2]) -> f64 {
    cross(p, q).atan2(dot(p, q))
}

/// Area of a polygon with the given corners, counter-clockwise: sum (p_i - p_0) x (p_i+1 - p_0) / 2.
pub fn polygon_area(corners: impl IntoIterator<Item = [f64; 2]>) -> f64 {
    let mut corners = corners.into_iter();
    let Some(first) = corners.next() else {
        return 0.0;
    };
    // positions are relative to the first corner, so the terms of the first and the last side are
    // zero
    let mut last = [0.0; 2];
    let terms = corners.map(|corner| {
        let side = [last, difference(first, corner)];
        last = side[1];
        cross(side[0], side[1])
    });
    terms.sum::<f64>() / 2.0
}

/// Smallest and largest coordinates of some points; infinite without points.
pub fn extents(points: impl IntoIterator<Item = [f64; 2]>) -> [[f64; 2]; 2] {
    let nothing = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    points.into_iter().fold(nothing, |[low, high], x| {
        [
            [0, 1].map(|i| f64::min(low[i], x[i])),
            [0, 1].map(|i| f64::max(high[i], x[i])),
        ]
    })
}

/// Number of members up to which a group of the hierarchy is not split further.
const GROUP: usize = 8;
/// Relative growth of a distance that covers its round-off.
const DISTANCE_ROUND_OFF: f64 = 8.0 * f64::EPSILON;

#[cfg(any(test, feature = "testing"))]
thread_local! {
    /// Number of pairs of circles that this thread has compared.
    pub static COMPARED: std::cell::Cell<usize> = const { std::cell::Cell::new(0) };
}

/// A territory: all points within `radius` of `centre`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Circle {
    /// Centre.
    pub centre: [f64; 2],
    /// Radius (length).
    pub radius: f64,
}

impl Circle {
    /// Whether the two circles have a point in common: |c1 - c2| <= r1 + r2.
    fn overlaps(&self, other: &Circle) -> bool {
        #[cfg(any(test, feature = "testing"))]
        COMPARED.set(COMPARED.get() + 1);
        let d = difference(other.centre, self.centre);
        let reach = (self.radius + other.radius) * (1.0 + DISTANCE_ROUND_OFF);
        dot(d, d) <= reach * reach
    }

    /// Lower bound of the distance of a point from the circle, negative inside (length).
    fn distance(&self, point: [f64; 2]) -> f64 {
        length(difference(self.centre, point)) * (1.0 - DISTANCE_ROUND_OFF) - self.radius
    }

    /// A circle that contains some circles, with its centre at the middle of their extent.
    fn around(circles: impl Iterator<Item = Circle> + Clone) -> Circle {
        let extent = |i: usize| {
            let bounds = |(low, high): (f64, f64), c: Circle| {
                let [below, above] = [c.centre[i] - c.radius, c.centre[i] + c.radius];
                (low.min(below), high.max(above))
            };
            circles
                .clone()
                .fold((f64::INFINITY, f64::NEG_INFINITY), bounds)
        };
        let centre = [0, 1].map(|i| {
            let (low, high) = extent(i);
            low + (high - low) / 2.0
        });
        let farthest =
            |radius: f64, c: Circle| radius.max(length(difference(centre, c.centre)) + c.radius);
        Circle {
            centre,
            radius: circles.fold(0.0, farthest) * (1.0 + DISTANCE_ROUND_OFF),
        }
    }
}

/// A binary hierarchy of circles: all members, halves, quarters, and so on down to small groups.
///
/// Groups are split at the median of the centres along their longer extent, with ties by index, so
/// the hierarchy depends only on the circles.
#[derive(Debug, Default)]
pub struct CircleTree {
    /// The members with their indices; every group is a range of the list.
    members: Vec<(Circle, u32)>,
    /// Circle and range of every group: group 1 contains all members, and the groups 2k and 2k + 1 are the halves of
    /// group k.
    groups: Vec<(Circle, [usize; 2])>,
}

impl CircleTree {
    /// The hierarchy of some circles.
    pub fn new(members: impl IntoIterator<Item = Circle>) -> Self {
        let mut tree = CircleTree::default();
        tree.rebuild(members);
        tree
    }

    /// Replaces the circles and uses the same memory.
    pub fn rebuild(&mut self, members: impl IntoIterator<Item = Circle>) {
        self.members.clear();
        self.members.extend(members.into_iter().zip(0..));
        let count = self.members.len();
        let last_level = count.div_ceil(GROUP).next_power_of_two();
        self.groups
            .resize(2 * last_level, (Circle::default(), [0, 0]));
        self.split(1, 0, count);
    }

    fn split(&mut self, group: usize, from: usize, to: usize) {
        let is_smallest = self.is_smallest(group);
        let range = &mut self.members[from..to];
        let circle = Circle::around(range.iter().map(|(circle, _)| *circle));
        self.groups[group] = (circle, [from, to]);
        if is_smallest {
            return;
        }
        let spread = |axis: usize| {
            let centres = range.iter().map(|(circle, _)| circle.centre[axis]);
            let (low, high) = centres.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), c| {
                (l.min(c), h.max(c))
            });
            high - low
        };
        let axis = usize::from(spread(1) > spread(0));
        let middle = from + (to - from) / 2;
        range.select_nth_unstable_by(middle - from, |(c, i), (d, j)| {
            let along = c.centre[axis].total_cmp(&d.centre[axis]);
            along.then(i.cmp(j))
        });
        self.split(2 * group, from, middle);
        self.split(2 * group + 1, middle, to);
    }

    fn is_smallest(&self, group: usize) -> bool {
        2 * group >= self.groups.len()
    }

    fn members_of(&self, group: usize) -> &[(Circle, u32)] {
        let [from, to] = self.groups[group].1;
        &self.members[from..to]
    }

    /// A value for every group, joined from the values of its members; `None` for an empty group.
    pub fn of_groups<T: Copy>(
        &self,
        of_member: impl Fn(usize) -> T,
        join: impl Fn(T, T) -> T,
    ) -> Vec<Option<T>> {
        let mut values: Vec<Option<T>> = vec![None; self.groups.len()];
        for group in (1..self.groups.len()).rev() {
            values[group] = if self.is_smallest(group) {
                let members = self.members_of(group).iter();
                members.map(|(_, i)| of_member(*i as usize)).reduce(&join)
            } else {
                let halves = [values[2 * group], values[2 * group + 1]];
                halves.into_iter().flatten().reduce(&join)
            };
        }
        values
    }

    /// Visits members approximately in the order of their distance from a point, until all other members are further
    /// away than the limit (length) that the last visit returned. Groups for which `is_admitted` is false, by number
    /// and circle, are skipped with all their members.
    pub fn visit_near(
        &self,
        point: [f64; 2],
        is_admitted: impl Fn(usize, &Circle) -> bool,
        mut visit: impl FnMut(usize) -> f64,
    ) {
        if self.members.is_empty() {
            return;
        }
        let distance = |group: usize| self.groups[group].0.distance(point);
        let mut limit = f64::INFINITY;
        let mut open = vec![1];
        while let Some(group) = open.pop() {
            if distance(group) > limit || !is_admitted(group, &self.groups[group].0) {
                continue;
            }
            if self.is_smallest(group) {
                for (circle, i) in self.members_of(group) {
                    if circle.distance(point) <= limit {
                        limit = visit(*i as usize);
                    }
                }
            } else {
                let halves = [2 * group, 2 * group + 1];
                let nearer_first = distance(halves[0]) <= distance(halves[1]);
                // the last group of the list is visited first
                open.extend(if nearer_first {
                    [halves[1], halves[0]]
                } else {
                    halves
                });
            }
        }
    }

    /// Appends all overlapping pairs of a member of this hierarchy and a member of another hierarchy; two groups are
    /// compared only when their circles overlap.
    pub fn overlaps(&self, other: &CircleTree, found: &mut Vec<[u32; 2]>) {
        if self.members.is_empty() || other.members.is_empty() {
            return;
        }
        let mut open = vec![[1, 1]];
        while let Some([k, l]) = open.pop() {
            let (circle, other_circle) = (&self.groups[k].0, &other.groups[l].0);
            if !circle.overlaps(other_circle) {
                continue;
            }
            match (self.is_smallest(k), other.is_smallest(l)) {
                (true, true) => {
                    for (circle, i) in self.members_of(k) {
                        let near = other.members_of(l).iter();
                        let near = near.filter(|(c, _)| circle.overlaps(c));
                        found.extend(near.map(|(_, j)| [*i, *j]));
                    }
                }
                (true, false) => open.extend([[k, 2 * l], [k, 2 * l + 1]]),
                (false, true) => open.extend([[2 * k, l], [2 * k + 1, l]]),
                // the larger of the two is split
                (false, false) if circle.radius >= other_circle.radius => {
                    open.extend([[2 * k, l], [2 * k + 1, l]]);
                }
                (false, false) => open.extend([[k, 2 * l], [k, 2 * l + 1]]),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn products_of_vectors_by_hand() {
        let (p, q) = ([3.0, 4.0], [-4.0, 3.0]);
        assert_eq!((dot(p, q), cross(p, q), cross(q, p)), (0.0, 25.0, -25.0));
        assert_eq!((length(p), difference(p, q)), (5.0, [-7.0, -1.0]));
        assert_eq!(angle(p, q), std::f64::consts::FRAC_PI_2);
        assert_eq!(angle(q, p), -std::f64::consts::FRAC_PI_2);
        for scale in [1.0, 1e-200, 1e200] {
            let [p, q] = [p, q].map(|p| p.map(|x| x * scale));
            assert_eq!(distance(p, q), 50f64.sqrt() * scale);
        }
    }

    fn circles(most: usize) -> impl Strategy<Value = Vec<Circle>> {
        let circle = ((-10.0..10.0), (-10.0..10.0), 0.0..1.5).prop_map(|(x, y, radius)| Circle {
            centre: [x, y],
            radius,
        });
        prop::collection::vec(circle, 0..most)
    }

    proptest! {
        #[test]
        fn the_hierarchy_finds_all_overlaps(a in circles(60), b in circles(200)) {
            let mut expected = Vec::new();
            for (i, p) in a.iter().enumerate() {
                let near = (0..b.len()).filter(|&j| p.overlaps(&b[j]));
                expected.extend(near.map(|j| [i as u32, j as u32]));
            }
            let mut found = Vec::new();
            CircleTree::new(a).overlaps(&CircleTree::new(b), &mut found);
            found.sort_unstable();
            prop_assert_eq!(found, expected);
        }

        #[test]
        fn the_nearest_member_is_visited(all in circles(60), x in -12.0..12.0, y in -12.0..12.0) {
            let distance = |i: usize| all[i].distance([x, y]);
            let expected = (0..all.len()).map(distance).fold(f64::INFINITY, f64::min);
            let mut nearest = f64::INFINITY;
            CircleTree::new(all.clone()).visit_near([x, y], |_, _| true, |i| {
                nearest = nearest.min(distance(i));
                nearest
            });
            prop_assert_eq!(nearest, expected);
        }
    }

    #[test]
    fn all_of_the_nearest_members_are_visited() {
        // in two groups, at exactly the same distance
        let at = |x: f64| Circle {
            centre: [x, 0.0],
            radius: 0.0,
        };
        let members = [at(-1.0); GROUP].into_iter().chain([at(1.0); GROUP]);
        let all: Vec<Circle> = members.collect();
        let mut visited = Vec::new();
        CircleTree::new(all.clone()).visit_near(
            [0.0, 0.0],
            |_, _| true,
            |i| {
                visited.push(i);
                all[i].distance([0.0, 0.0])
            },
        );
        visited.sort_unstable();
        assert_eq!(visited, (0..2 * GROUP).collect::<Vec<_>>());
    }
}
