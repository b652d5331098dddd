use super::geometry::{Projection, position, project};
use super::{ContactSurfaces, PairSite, Search, Territory};

/// How far beyond its ends a segment still takes a projection (in its lengths): what round-off and
/// the tolerance of many increments make of a node that sticks at the end of a surface.
pub(super) const ROUND_OFF: f64 = 1e-6;

/// A segment that a slave node may pair with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// Index of the segment in its contact.
    pub segment: usize,
    /// Distance up to which it pairs (length).
    pub reach: f64,
}

/// All segments of a contact, at any distance: the search without territories.
pub fn all_segments(surfaces: &ContactSurfaces) -> impl Iterator<Item = Candidate> + Clone {
    (0..surfaces.segments.len()).map(|segment| Candidate {
        segment,
        reach: f64::INFINITY,
    })
}

/// The segment that a slave node pairs with in the configuration of displacements `u`, if any of
/// the candidates, which come with increasing segments.
///
/// It is the closest segment that the node projects into, not deeper than the segment's length. In
/// the wedge of a vertex, where the node projects into neither neighbour, it is the one with the
/// larger gap outside a convex vertex (never negative, so that no contact is made up) and the one
/// with the smaller gap inside a concave vertex.
pub fn find_segment(
    surfaces: &ContactSurfaces,
    x: &[[f64; 2]],
    u: &[f64],
    slave: usize,
    candidates: impl Iterator<Item = Candidate>,
) -> Option<usize> {
    let s = position(x, u, slave);
    let on = |[a, b]: [usize; 2]| project(s, position(x, u, a), position(x, u, b));
    let mut closest: Option<(f64, usize)> = None;
    let mut wedge: Option<(f64, usize)> = None;
    for Candidate { segment: i, reach } in candidates {
        let segment = surfaces.segments[i];
        if segment.contains(&slave) {
            continue;
        }
        let p = on(segment);
        if p.gap < -p.length {
            continue;
        }
        if (-ROUND_OFF..=1.0 + ROUND_OFF).contains(&p.xi) {
            if p.gap.abs() <= reach && closest.is_none_or(|(d, _)| p.gap.abs() < d) {
                closest = Some((p.gap.abs(), i));
            }
        } else if p.xi > 1.0
            && let Some(j) = surfaces.next[i]
            && !surfaces.segments[j].contains(&slave)
        {
            let q = on(surfaces.segments[j]);
            let distance = beyond(&p);
            let is_wedge = q.xi < 0.0 && q.gap >= -q.length && distance <= reach;
            if is_wedge && wedge.is_none_or(|(d, _)| distance < d) {
                let outside = p.gap.max(q.gap) > 0.0;
                wedge = Some((distance, if (p.gap >= q.gap) == outside { i } else { j }));
            }
        }
    }
    match (closest, wedge) {
        (Some((distance, _)), Some((d, j))) if d < distance => Some(j),
        (Some((_, i)), _) => Some(i),
        (None, Some((_, j))) => Some(j),
        (None, None) => None,
    }
}

/// How far beyond its ends a segment that is kept may be left (in its lengths).
const KEPT: f64 = 0.1;

/// Segments that the slots had in the pass before.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Pairing {
    /// Segment of every slot, if any; empty before the first pass.
    pub segments: Vec<Option<usize>>,
    /// Whether segments are kept even where others are closer now: passes that go to and fro
    /// across a vertex come to rest with it.
    pub settled: bool,
}

/// The pairs of all contacts in the configuration of displacements `u`, which the search covers.
///
/// A node that has just left its segment by a little and finds no other keeps it: whether it has
/// slid off is decided by the end of the increment, not by one of its passes.
pub fn find_pairs(search: &Search, u: &[f64], before: &Pairing) -> Vec<PairSite> {
    let x = search.coordinates();
    let slaves = search.territories().iter().flat_map(|territory| {
        let slaves = territory.surfaces().slaves.iter().enumerate();
        slaves.map(move |(k, &slave)| (territory, k, slave))
    });
    let site = |(slot, (territory, k, slave)): (usize, (&Territory, usize, usize))| {
        let contact = territory.surfaces();
        let near = |&i: &usize| {
            let [a, b] = contact.segments[i];
            let p = project(position(x, u, slave), position(x, u, a), position(x, u, b));
            (-KEPT..=1.0 + KEPT).contains(&p.xi)
        };
        let kept = || before.segments.get(slot).copied().flatten().filter(near);
        let found = || find_segment(contact, x, u, slave, territory.candidates(k));
        let segment = if before.settled {
            kept().or_else(found)?
        } else {
            found().or_else(kept)?
        };
        let [a, b] = contact.segments[segment];
        Some(PairSite {
            slot,
            segment,
            nodes: [slave, a, b],
            friction: contact.friction,
        })
    };
    slaves.enumerate().filter_map(site).collect()
}

/// Distance of the point from the end b of the segment.
fn beyond(p: &Projection) -> f64 {
    ((p.xi - 1.0) * p.length).hypot(p.gap)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A roof: segments from right to left over the nodes 1, 2, 3 at heights 0, `top`, 0; slave 0.
    fn roof(top: f64) -> (ContactSurfaces, Vec<[f64; 2]>) {
        let surfaces = ContactSurfaces {
            slaves: vec![0],
            segments: vec![[1, 2], [2, 3]],
            next: vec![Some(1), None],
            friction: 0.0,
        };
        (
            surfaces,
            vec![[0.0, 0.0], [2.0, 0.0], [0.0, top], [-2.0, 0.0]],
        )
    }

    fn found(top: f64, s: [f64; 2]) -> Option<usize> {
        let (surfaces, mut x) = roof(top);
        x[0] = s;
        find_segment(&surfaces, &x, &[0.0; 8], 0, all_segments(&surfaces))
    }

    #[test]
    fn the_closest_segment_that_the_node_projects_into() {
        assert_eq!(found(0.0, [1.0, 0.5]), Some(0));
        assert_eq!(found(0.0, [-1.0, -0.5]), Some(1));
        assert_eq!(found(0.0, [3.0, 0.5]), None);
        assert_eq!(
            found(0.0, [1.0, -2.5]),
            None,
            "deeper than the segment's length"
        );
    }

    #[test]
    fn a_node_in_the_wedge_of_a_vertex_keeps_a_pair() {
        assert_eq!(found(1.0, [0.01, 1.5]), Some(0), "outside a convex vertex");
        assert_eq!(found(1.0, [-0.01, 1.5]), Some(1));
        assert_eq!(
            found(-1.0, [0.01, -1.1]),
            Some(0),
            "inside a concave vertex"
        );
        assert_eq!(found(-1.0, [-0.01, -1.1]), Some(1));
    }

    #[test]
    fn a_node_is_no_slave_of_its_own_segment() {
        let (surfaces, x) = roof(1.0);
        let all = all_segments(&surfaces);
        assert_eq!(find_segment(&surfaces, &x, &[0.0; 8], 2, all), None);
    }
}
