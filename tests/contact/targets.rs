//! Segments and corners that are selected as targets of a slave node.

use stickslip::contact::{ContactSurfaces, ContactTarget, Positions, SlaveNode, all_segments};

/// A closed or open chain of master segments over `points`, the body on their left.
fn chain(points: &[[f64; 2]], closed: bool) -> Vec<[usize; 2]> {
    let count = points.len();
    let last = if closed { count } else { count - 1 };
    (0..last).map(|i| [i, (i + 1) % count]).collect()
}

/// Targets of a node that goes from `from` to `to` near chains of points at rest.
fn targets_near(
    chains: &[&[[f64; 2]]],
    closed: bool,
    from: [f64; 2],
    to: [f64; 2],
) -> Vec<ContactTarget> {
    let mut x = Vec::new();
    let mut segments = Vec::new();
    for points in chains {
        let first = x.len();
        segments.extend(chain(points, closed).iter().map(|s| s.map(|n| first + n)));
        x.extend_from_slice(points);
    }
    let slave = x.len();
    let surfaces = ContactSurfaces::new(vec![slave], &[], segments);
    let (mut start, mut now) = (x.clone(), x);
    start.push(from);
    now.push(to);
    targets_of(&surfaces, &start, &now)
}

/// Targets of the only slave node of surfaces between two sets of positions.
fn targets_of(
    surfaces: &ContactSurfaces,
    start: &[[f64; 2]],
    now: &[[f64; 2]],
) -> Vec<ContactTarget> {
    let still = vec![0.0; 2 * start.len()];
    let node = SlaveNode {
        surfaces,
        start: Positions::new(start, &still),
        now: Positions::new(now, &still),
        slave: 0,
        closed_on: &[],
        allowed: [0.0; 2],
    };
    node.targets(all_segments(surfaces)).into_vec()
}

fn segments(targets: &[ContactTarget]) -> Vec<usize> {
    assert!(targets.iter().all(|target| target.corner.is_none()));
    targets.iter().map(|target| target.segment).collect()
}

/// Targets beside a square from (0, 0) to (1, 1): bottom 0, right 1, top 2, left 3.
fn beside_square(from: [f64; 2], to: [f64; 2]) -> Vec<usize> {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    segments(&targets_near(&[&square], true, from, to))
}

#[test]
fn a_node_is_held_by_the_face_that_it_came_to() {
    assert_eq!(beside_square([0.5, 1.2], [0.5, 1.1]), [2]);
    assert_eq!(beside_square([0.5, 1.2], [0.5, 0.9]), [2]);
    assert_eq!(
        beside_square([0.9, 1.1], [0.95, 0.8]),
        [2],
        "not by the right side, which is nearer"
    );
    assert_eq!(
        beside_square([1.1, 0.9], [0.8, 0.95]),
        [1],
        "nor by the top"
    );
}

#[test]
fn the_other_sides_of_a_body_do_not_hold() {
    let plate = [[0.0, 0.0], [4.0, 0.0], [4.0, 0.1], [0.0, 0.1]];
    let near_plate = |from, to| segments(&targets_near(&[&plate], true, from, to));
    assert_eq!(
        near_plate([2.0, 0.2], [2.0, 0.03]),
        [2],
        "nearer to the bottom"
    );
    assert_eq!(near_plate([2.0, -0.1], [2.0, 0.09]), [0]);
    assert_eq!(
        near_plate([2.0, 0.05], [2.0, 0.06]),
        [0; 0],
        "inside from the start"
    );
    assert_eq!(
        near_plate([2.0, 9.0], [2.0, -9.0]),
        [2],
        "through and far beyond"
    );
}

#[test]
fn a_node_that_slides_round_a_convex_vertex_keeps_its_segment() {
    let slides = beside_square([0.9, 1.0], [1.05, 0.95]);
    assert_eq!(slides, [2], "it was behind the right side at the start");
    let falls = beside_square([1.05, 1.0], [1.05, 0.9]);
    assert_eq!(falls, [1], "past the corner it may fall along the side");
    assert_eq!(
        beside_square([1.2, 1.3], [1.02, 1.04]),
        [2],
        "in the wedge the larger gap"
    );
    assert_eq!(beside_square([1.3, 1.2], [1.04, 1.02]), [1]);
}

#[test]
fn a_corner_that_slides_over_a_corner_is_held_by_the_face_that_its_surface_lies_on() {
    // the right lower corner of a block on the square, past the square's right side; it goes down
    // behind the line of the top, but the block's own bottom lies behind the right side
    let mut start = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let segments = chain(&start, true);
    start.extend([[0.2, 1.0], [1.01, 1.0], [1.01, 2.0]]);
    let mut now = start.clone();
    now[5][1] = 0.99;
    let closed_on = |own: &[[usize; 2]]| {
        let surfaces = ContactSurfaces::new(vec![5], own, segments.clone());
        self::segments(&targets_of(&surfaces, &start, &now))
    };
    assert_eq!(closed_on(&[[4, 5], [5, 6]]), [2]);
    assert_eq!(
        closed_on(&[]),
        [1],
        "a node without a surface falls along the side"
    );
}

#[test]
fn a_corner_that_turns_concave_under_a_node_that_comes_over_it_does_not_let_it_in() {
    // an open node over the segment from (2, 0) to the corner, and behind the line of that from the corner to (0, 0)
    let points = |height: f64| [[2.0, 0.0], [1.0, height], [0.0, 0.0]];
    let (mut start, mut now) = (points(1e-4).to_vec(), points(-0.03).to_vec());
    start.push([1.003, 0.9975e-4]);
    now.push([0.95, -0.03]);
    let segments = chain(&start[..3], false);
    let surfaces = ContactSurfaces::new(vec![3], &[], segments);
    let targets = targets_of(&surfaces, &start, &now);
    let slid_on = targets.iter().find(|target| target.segment == 1);
    assert_eq!(
        slid_on.map(|target| target.from),
        Some(Some(0)),
        "{targets:?}"
    );
}

#[test]
fn both_sides_of_a_concave_corner_are_targets() {
    // a valley over (2, 1), (0, 0), (-2, 1)
    let valley = [[2.0, 1.0], [0.0, 0.0], [-2.0, 1.0]];
    let near_plate = |from, to| segments(&targets_near(&[&valley], false, from, to));
    assert_eq!(near_plate([0.0, 0.5], [0.0, 0.1]), [0, 1]);
    assert_eq!(near_plate([0.0, 0.5], [0.0, -0.2]), [0, 1]);
    assert_eq!(
        near_plate([0.4, 0.2], [0.1, 0.05]),
        [0, 1],
        "near its ground"
    );
    assert_eq!(near_plate([1.5, 0.76], [1.5, 0.75]), [0], "far from it");
    assert_eq!(near_plate([0.4, 0.2], [-0.2, -0.1]), [0, 1], "beyond it");
}

#[test]
fn a_node_far_behind_a_concave_corner_has_no_target() {
    // in the line of the first side, two lengths beyond its end: across the body of a cross
    let arm = [[-1.0, 0.0], [0.0, 0.0], [0.0, -1.0]];
    let across = [2.0, 1e-12];
    assert_eq!(
        segments(&targets_near(&[&arm], false, across, across)),
        [0; 0]
    );
    // a concave corner that has closed, but for round-off to either side: it is no sharp corner
    for x in [1e-16, -1e-16] {
        let closed = [[x, 1.0], [0.0, 0.0], [-x, 1.0]];
        let below = [1e-6, -2.0];
        let targets = targets_near(&[&closed], false, below, below);
        assert_eq!(segments(&targets), [0; 0], "{x}");
    }
}

#[test]
fn a_sharp_corner_differs_from_a_closed_concave_corner() {
    let tip = [[-0.01, -1.0], [0.0, 0.0], [0.01, -1.0]].map(|[x, y]: [f64; 2]| [-x, y]);
    let mut x = tip.to_vec();
    x.push([1e-3, 0.5]);
    let surfaces = ContactSurfaces::new(vec![3], &[], vec![[0, 1], [1, 2]]).with_sharp_corners(&x);
    let mut now = x.clone();
    now[3] = [1e-3, 0.1];
    let targets = targets_of(&surfaces, &x, &now);
    assert_eq!(
        targets.len(),
        1,
        "one side of the tip, or the tip: {targets:?}"
    );
}

#[test]
fn several_bodies_hold_a_node_at_once() {
    let floor = [[4.0, 0.0], [-4.0, 0.0]];
    let wall = [[0.5, -4.0], [0.5, 4.0]];
    let wall_to_the_left: Vec<[f64; 2]> = wall.iter().rev().copied().collect();
    let targets = |wall: &[[f64; 2]]| {
        segments(&targets_near(
            &[&floor, wall],
            false,
            [0.3, 0.2],
            [0.4, 0.1],
        ))
    };
    assert_eq!(targets(&wall_to_the_left), [0, 1]);
    assert_eq!(targets(&wall), [0], "the back of a wall does not hold");
}

/// Between the two segments of a vertex neither one is nearer: the normal of one alone would lean to its side.
#[test]
fn a_node_at_a_vertex_of_a_face_meets_both_its_segments() {
    // from right to left over a vertex at (0, 0), hollow where the ends are higher
    let targets = |height: f64, x: f64| {
        let face = [[1.0, height], [0.0, 0.0], [-1.0, height]];
        targets_near(&[&face], false, [x, 0.1], [x, 0.0])
    };
    for height in [0.0, 1e-9, -1e-9, 1e-4, -1e-4, 4e-3] {
        for x in [0.0, 1e-13, -1e-13] {
            let [target] = targets(height, x)[..] else {
                panic!("{height} {x}");
            };
            let corner = target.corner.map(|corner| (corner.next, corner.weight));
            assert_eq!(
                (target.segment, corner),
                (0, Some((1, 0.5))),
                "{height} {x}"
            );
        }
    }
    assert_eq!(segments(&targets(0.0, 1e-3)), [0], "beside the vertex");
    assert_eq!(segments(&targets(4e-3, 2e-6)), [0], "nearer to the first");
    assert_eq!(segments(&targets(4e-3, -2e-6)), [1], "nearer to the second");
    assert_eq!(segments(&targets(0.02, 0.0)), [0, 1], "in a hollow corner");
}

/// In a bore around a pin a node at a vertex of the pin has no normal that parts it from either side. It meets the vertex with
/// the normal in the middle, and beside it the segment that it is on: a limit at a distance that nodes of fits slide would
/// give neighbours other normals.
#[test]
fn a_node_in_a_bore_meets_a_vertex_of_the_pin_in_the_middle() {
    let targets = |[pin, bore]: [f64; 2], x: f64| {
        let at = vec![
            [1.0, -pin],
            [0.0, 0.0],
            [-1.0, -pin],
            [x - 1.0, -bore],
            [x, 0.0],
            [x + 1.0, -bore],
        ];
        let (pin, bore) = (vec![[0, 1], [1, 2]], [[3, 4], [4, 5]]);
        let surfaces = ContactSurfaces::new(vec![4], &bore, pin);
        targets_of(&surfaces, &at, &at)
    };
    for turn in [[0.05, 0.03], [0.1, 0.08], [0.2, 0.2]] {
        for x in [0.0, 1e-13, -1e-13] {
            let [target] = targets(turn, x)[..] else {
                panic!("{turn:?} {x}");
            };
            let corner = target.corner.map(|corner| (corner.next, corner.weight));
            assert_eq!(
                (target.segment, corner),
                (0, Some((1, 0.5))),
                "{turn:?} {x}"
            );
        }
        for (x, segment) in [(1e-6, 0), (-1e-6, 1)] {
            assert_eq!(
                targets(turn, x),
                [ContactTarget::face(segment)],
                "{turn:?} {x}"
            );
        }
    }
}

#[test]
fn a_mesh_that_starts_a_little_inside_is_held() {
    assert_eq!(beside_square([0.5, 0.999], [0.5, 0.998]), [2]);
    assert_eq!(beside_square([0.5, 0.9], [0.5, 0.9]), [0; 0], "deep inside");
}

/// Targets of the lowest node of a triangle that comes down from `from` to `to`, with the slopes of
/// its two sides, on the tip of a roof at (0, 0) with slopes of 45 degrees.
fn tip_to_tip(from: [f64; 2], to: [f64; 2], sides: [[f64; 2]; 2]) -> Vec<ContactTarget> {
    let mut start = vec![[1.0, -1.0], [0.0, 0.0], [-1.0, -1.0], from];
    start.extend(sides.map(|side| [from[0] + side[0], from[1] + side[1]]));
    let mut now = start.clone();
    for node in &mut now[3..] {
        *node = [0, 1].map(|i| node[i] + to[i] - from[i]);
    }
    // the triangle's way round, body on the left: left upper node, tip, right upper node
    let own = [[4, 3], [3, 5]];
    let surfaces = ContactSurfaces::new(vec![3], &own, vec![[0, 1], [1, 2]]);
    targets_of(&surfaces, &start, &now)
}

#[test]
fn tips_meet_as_node_against_node() {
    let corner = [[-1.0, 1.0], [1.0, 1.0]];
    for aside in [0.0, 1e-6, -1e-6] {
        let targets = tip_to_tip([aside, 0.1], [aside, -0.01], corner);
        let weight = targets[0].corner.map(|corner| corner.weight);
        assert_eq!(targets.len(), 1);
        assert!((weight.unwrap_or(f64::NAN) - 0.5).abs() < 1e-12, "{aside}");
    }
    let aside = tip_to_tip([1e-3, 0.1], [1e-3, -0.01], corner);
    assert_eq!(segments(&aside), [0], "a tip beside the tip meets a face");
}

#[test]
fn flush_tips_meet_with_the_normal_of_their_faces() {
    // a corner whose left side lies flush on the right slope
    let flush = [[-0.1, 1.0], [1.0, -1.0]];
    let targets = tip_to_tip([0.0, 0.0], [0.0, -0.01], flush);
    assert_eq!(segments(&targets), [0]);
}
