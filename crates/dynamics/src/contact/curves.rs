//! Curved faces: a bulge for every segment of a surface, found from the turns between segments in the reference
//! configuration. See docs/theory/geometry.md, Curved faces.

use std::collections::HashMap;

use super::bulge::Bulge;
use super::tolerances::{CORNER_COSINE, LEAST_TURN, LONGEST_BENT, UNLIKE_TURNS};
use crate::vectors::{cross, difference, dot, length};

/// Data on the shapes of faces in addition to the places of their nodes.
#[derive(Debug, Clone, Default)]
pub struct FaceShapes {
    /// For every mid-side node, the ends of its side.
    pub middles: HashMap<usize, [usize; 2]>,
    /// Centres of the circles on which segments lie, by the ends of the segment.
    pub centres: HashMap<[usize; 2], [f64; 2]>,
}

/// The segments of a surface with their neighbours.
pub struct Chain<'a> {
    /// The nodes at the ends of each segment.
    pub segments: &'a [[usize; 2]],
    /// For every segment the segment that starts at its end, if any.
    pub next: &'a [Option<usize>],
    /// For every segment the segment that ends at its start, if any.
    pub previous: &'a [Option<usize>],
}

impl Chain<'_> {
    /// Bulges of the segments at the reference coordinates `x`.
    pub fn bulges(&self, x: &[[f64; 2]], shapes: &FaceShapes) -> Vec<Bulge> {
        let halves = (self.segments.iter()).map(|&ends| of_half_side(ends, x, &shapes.middles));
        let sides: Vec<Option<Bulge>> = halves.collect();
        let turns = Turns {
            chain: self,
            x,
            is_half: sides.iter().map(Option::is_some).collect(),
        };
        let slopes = turns.slopes();
        let of = |i: usize, slopes: Option<[f64; 2]>| {
            let ends = self.segments[i];
            let centre = shapes.centres.get(&ends);
            let about = centre.and_then(|&centre| slopes_about(centre, ends.map(|node| x[node])));
            about.or(slopes).map_or(Bulge::FLAT, |slopes| {
                Bulge::of_slopes(length(turns.edge(i)), slopes)
            })
        };
        (sides.into_iter().zip(slopes).enumerate())
            .map(|(i, (side, slopes))| side.unwrap_or_else(|| of(i, slopes)))
            .collect()
    }
}

/// Slopes, against its chord, of a circle about `centre` through the ends of a segment. `None` if the tangents of the
/// circle turn from the chord by more than 45 degrees.
fn slopes_about(centre: [f64; 2], [a, b]: [[f64; 2]; 2]) -> Option<[f64; 2]> {
    let e = difference(a, b);
    // r = x - c is normal to the tangent: b' = -(r.e)/(r x e)
    let slope = |x: [f64; 2]| {
        let r = difference(centre, x);
        -dot(r, e) / cross(r, e)
    };
    let [start, end] = [slope(a), -slope(b)];
    (start.abs() <= 1.0 && end.abs() <= 1.0).then_some([start, end])
}

/// The bulge of a segment that is half of a side with a mid-side node: the side is a parabola.
fn of_half_side(
    [a, b]: [usize; 2],
    x: &[[f64; 2]],
    middles: &HashMap<usize, [usize; 2]>,
) -> Option<Bulge> {
    let first = middles.get(&b).filter(|ends| ends.contains(&a));
    let second = || middles.get(&a).filter(|ends| ends.contains(&b));
    let (is_first, middle, [p, q]) = match first {
        Some(&ends) => (true, b, ends),
        None => (false, a, *second()?),
    };
    // ends of the side in the direction of the segment
    let ends = match (is_first, p == a, q == b) {
        (true, true, _) | (false, _, true) => [p, q],
        _ => [q, p],
    };
    let [p, q] = ends.map(|node| x[node]);
    let e = difference(p, q);
    let length = length(e);
    let rise = cross(difference(p, x[middle]), e) / length;
    let is_flat = 4.0 * rise.abs() <= LEAST_TURN * length;
    Some(match is_flat {
        true => Bulge::FLAT,
        false => Bulge::of_side(rise),
    })
}

/// Turns from segment to segment in the reference configuration, where some segments are halves of
/// sides.
struct Turns<'a> {
    chain: &'a Chain<'a>,
    x: &'a [[f64; 2]],
    is_half: Vec<bool>,
}

/// Turn of a chain from one segment to the next.
#[derive(Clone, Copy, PartialEq)]
enum Turn {
    /// The chain ends, has a corner, or goes on with a side whose shape is given.
    End,
    /// The next segment has the same direction.
    Straight,
    /// The chain turns smoothly, to the left or to the right.
    Smooth { to_left: bool },
}

impl Turns<'_> {
    fn edge(&self, i: usize) -> [f64; 2] {
        let [a, b] = self.chain.segments[i].map(|node| self.x[node]);
        difference(a, b)
    }

    fn turn(&self, before: Option<usize>, after: Option<usize>) -> Turn {
        let (Some(i), Some(j)) = (before, after) else {
            return Turn::End;
        };
        let (e, f) = (self.edge(i), self.edge(j));
        let (sine, cosine, size) = (cross(e, f), dot(e, f), length(e) * length(f));
        let is_corner =
            cosine.partial_cmp(&(CORNER_COSINE * size)) != Some(std::cmp::Ordering::Greater);
        match self.is_half[i] || self.is_half[j] || is_corner {
            true => Turn::End,
            false if sine.abs() <= LEAST_TURN * size => Turn::Straight,
            false => Turn::Smooth {
                to_left: sine > 0.0,
            },
        }
    }

    /// Sine of the turn between two segments.
    fn sine(&self, i: usize, j: usize) -> f64 {
        let (e, f) = (self.edge(i), self.edge(j));
        cross(e, f).abs() / (length(e) * length(f))
    }

    /// Slopes at the ends of every segment that bends, against its chord.
    ///
    /// A segment bends between two smooth turns to the same side. A segment also bends if it lies between the end of
    /// the chain, or a corner, and a smooth turn to a segment that bends to the same side. A segment that is much
    /// longer than a neighbour stays straight: it is a straight side that ends in a fillet. If a segment turns far more
    /// at one end than at the other, like the last chord of a flank at a coarse fillet, its neighbour at that end bends
    /// for the whole turn.
    fn slopes(&self) -> Vec<Option<[f64; 2]>> {
        let count = self.chain.segments.len();
        let ends = |i: usize| {
            let [before, after] = [self.chain.previous[i], self.chain.next[i]];
            [
                (before, self.turn(before, Some(i))),
                (after, self.turn(Some(i), after)),
            ]
        };
        let is_long = |i: usize, neighbour: Option<usize>| {
            neighbour.is_some_and(|j| length(self.edge(i)) > LONGEST_BENT * length(self.edge(j)))
        };
        let is_between = |i: usize| {
            let [(before, at_a), (after, at_b)] = ends(i);
            matches!(at_a, Turn::Smooth { .. })
                && at_a == at_b
                && !is_long(i, before)
                && !is_long(i, after)
        };
        let between: Vec<bool> = (0..count)
            .map(|i| !self.is_half[i] && is_between(i))
            .collect();
        let is_beside = |i: usize| {
            let goes_on = |(neighbour, turn): (Option<usize>, Turn)| {
                matches!(turn, Turn::Smooth { .. })
                    && neighbour.is_some_and(|j| between[j])
                    && !is_long(i, neighbour)
            };
            let [at_a, at_b] = ends(i);
            (at_a.1 == Turn::End && goes_on(at_b)) || (at_b.1 == Turn::End && goes_on(at_a))
        };
        let bends: Vec<bool> = (0..count)
            .map(|i| !self.is_half[i] && (between[i] || is_beside(i)))
            .collect();
        // whether a segment bends for a part of the turn at its end; it does not if it turns far less at its other end
        let takes_part = |i: usize, (neighbour, turn): (Option<usize>, Turn)| {
            let sine = |(neighbour, turn): (Option<usize>, Turn)| match turn {
                Turn::Smooth { .. } => neighbour.map(|j| self.sine(i, j)),
                _ => None,
            };
            let sines = ends(i).map(sine);
            let own = sine((neighbour, turn));
            let least = sines.into_iter().flatten().fold(f64::INFINITY, f64::min);
            bends[i] && own.is_some_and(|own| own <= UNLIKE_TURNS * least)
        };
        // slope of the circle through three nodes, eq. (3.28), or of all of the turn if the neighbour does not bend for
        // it
        let slope = |i: usize, (neighbour, turn): (Option<usize>, Turn)| {
            let neighbour = neighbour.filter(|_| takes_part(i, (neighbour, turn)))?;
            let (e, f) = (self.edge(i), self.edge(neighbour));
            let other = match takes_part(neighbour, (Some(i), turn)) {
                true => dot(f, f),
                false => 0.0,
            };
            Some(cross(e, f).abs() / (other + dot(e, f)))
        };
        (0..count)
            .map(|i| {
                let [at_a, at_b] = ends(i);
                let slopes = [slope(i, at_a), slope(i, at_b)];
                let to_left = [at_a.1, at_b.1].contains(&Turn::Smooth { to_left: true });
                let sign = if to_left { 1.0 } else { -1.0 };
                let [a, b] = slopes.map(|slope| slope.map(|slope| sign * slope));
                match (a.or(b), b.or(a)) {
                    (Some(a), Some(b)) if bends[i] => Some([a, b]),
                    _ => None,
                }
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::geometry::ContactSurfaces;
    use super::*;

    /// The bulges of a closed or open polygon through the given points, which are the nodes.
    fn of_polygon(x: &[[f64; 2]], is_closed: bool) -> Vec<Bulge> {
        let count = if is_closed { x.len() } else { x.len() - 1 };
        let segments = (0..count).map(|i| [i, (i + 1) % x.len()]).collect();
        let surfaces = ContactSurfaces::new(Vec::new(), &[], segments);
        surfaces.chain().bulges(x, &FaceShapes::default())
    }

    fn on_circle(angle: f64) -> [f64; 2] {
        [angle.cos(), angle.sin()]
    }

    /// Largest distance of the faces from the circle of radius one about the origin.
    fn off_circle(x: &[[f64; 2]], bulges: &[Bulge]) -> f64 {
        let mut most = 0.0_f64;
        for (i, bulge) in bulges.iter().enumerate() {
            let (a, b) = (x[i], x[(i + 1) % x.len()]);
            let (e, l) = (difference(a, b), length(difference(a, b)));
            for k in 0..=10 {
                let xi = f64::from(k) / 10.0;
                let rise = bulge.at(xi) / l;
                let place = [
                    a[0] + xi * e[0] + rise * e[1],
                    a[1] + xi * e[1] - rise * e[0],
                ];
                most = most.max((length(place) - 1.0).abs());
            }
        }
        most
    }

    #[test]
    fn a_polygon_of_nodes_on_a_circle_is_the_circle_to_the_fourth_order() {
        let error = |count: usize| {
            let angle = |i: usize| std::f64::consts::TAU * i as f64 / count as f64;
            let x: Vec<[f64; 2]> = (0..count).map(|i| on_circle(angle(i))).collect();
            off_circle(&x, &of_polygon(&x, true))
        };
        let [coarse, fine] = [16, 32].map(error);
        assert!(coarse < 4e-5 && coarse / fine > 14.0, "{coarse:e} {fine:e}");
        // unlike sides, and an open chain
        let angles = [0.0, 0.2, 0.5, 0.7, 0.95, 1.1];
        let x: Vec<[f64; 2]> = angles.map(on_circle).into();
        let found = off_circle(&x, &of_polygon(&x, false));
        assert!(found < 1e-4, "{found:e}");
        // body outside of a bore
        let bore: Vec<[f64; 2]> = x.iter().rev().copied().collect();
        let found = off_circle(&bore, &of_polygon(&bore, false));
        assert!(found < 1e-4, "{found:e}");
    }

    #[test]
    fn straight_sides_corners_and_single_kinks_stay_straight() {
        let straight = [[0.0, 0.0], [1.0, 0.0], [2.5, 0.0], [3.0, 0.0]];
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let kink = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.1]];
        for (x, is_closed) in [(&straight[..], false), (&square, true), (&kink, false)] {
            assert!(of_polygon(x, is_closed).iter().all(Bulge::is_flat), "{x:?}");
        }
    }

    #[test]
    fn a_fillet_takes_all_of_the_turn_to_a_straight_side() {
        // two straight sides and a quarter of a circle of five chords
        let mut x = vec![[0.0, -3.0], [0.5, -2.0], [1.0, -1.0]]
            .into_iter()
            .map(|[_, y]| [1.0, y])
            .collect::<Vec<_>>();
        x.extend((0..=5).map(|i| on_circle(f64::from(i) * 18_f64.to_radians())));
        x.extend([[-1.0, 1.0], [-2.0, 1.0]]);
        let found = of_polygon(&x, false);
        let bent: Vec<bool> = found.iter().map(|bulge| !bulge.is_flat()).collect();
        assert_eq!(
            bent,
            [
                false, false, false, true, true, true, true, true, false, false
            ]
        );
        assert!(off_circle(&x[3..9], &found[3..8]) < 1e-4);
    }

    #[test]
    fn a_fine_flank_does_not_bend_into_a_coarse_fillet() {
        // chords of half a degree, one chord of a fillet that turns by 17 degrees at both ends, a straight side
        let mut angles: Vec<f64> = (0..10).map(|i| 0.5 * f64::from(i)).collect();
        angles.extend([21.5, 38.5, 38.5]);
        let lengths = [[0.1; 10].as_slice(), &[0.25, 2.0, 2.0]].concat();
        let mut x = vec![[0.0, 0.0]];
        for (angle, length) in angles.iter().zip(&lengths) {
            let ([px, py], (sin, cos)) = (x[x.len() - 1], angle.to_radians().sin_cos());
            x.push([px + length * cos, py + length * sin]);
        }
        let found = of_polygon(&x, false);
        let rise = |i: usize| found[i].at(0.5) / lengths[i];
        let of_flank = (0.25_f64).to_radians().tan() / 4.0;
        assert!((0..10).all(|i| (rise(i) / of_flank - 1.0).abs() < 0.01));
        let of_fillet = (17_f64).to_radians().tan() / 4.0;
        assert!((rise(10) / of_fillet - 1.0).abs() < 0.03, "{}", rise(10));
        assert!(found[11].is_flat() && found[12].is_flat());
    }

    #[test]
    fn a_side_with_a_node_between_is_its_parabola_for_nodes_and_for_points() {
        let x = [[0.0, 0.0], [1.0, -0.1], [2.0, 0.0]];
        let shapes = FaceShapes {
            middles: HashMap::from([(1, [0, 2])]),
            ..FaceShapes::default()
        };
        let surfaces = ContactSurfaces::new(Vec::new(), &[], vec![[0, 1], [1, 2]]);
        let found = surfaces.chain().bulges(&x, &shapes);
        // y = -0.1 (1 - (x - 1)²) at a quarter of the side is 0.025 beyond the chord
        let chord = 1.01_f64.sqrt();
        assert!((found[0].at(0.5) - 0.025).abs() < 1e-3 && (chord - 1.0) < 0.01);
        assert_eq!(found[0], found[1]);
        // the two lines of points begin and end at the corners, and have the middle a third of the rise inside
        let [first, second] = [[false, true], [true, false]].map(|half| found[0].of_points(half));
        assert_eq!(first.at(0.0), 0.0);
        assert!(second.at(1.0).abs() < 1e-15);
        assert!((first.at(1.0) - second.at(0.0)).abs() < 1e-15);
        assert!((first.at(1.0) + found[0].slope(0.0) / 3.0).abs() < 1e-15);
    }
}
