//! Tests of the tunnelling check: a node at a thin plate, a concave corner, a sinking roof.

use super::closed_pairs::ClosedPairs;
use super::geometry::ContactSurfaces;
use super::keys::NodeAtSegment;
use super::search::Search;
use super::testing::{closed_pair, key};
use super::tunnelling::find_penetration;

/// Surfaces and node positions of a plate from (0, 0) to (8, 0.5) with segments of length 1 along
/// and 0.5 across, the body on the left; node 0 is the slave.
fn plate(closed: bool) -> (ContactSurfaces, Vec<[f64; 2]>) {
    let mut x = vec![[0.0, 0.0]];
    x.extend((0..=8).map(|i| [f64::from(i), 0.0]));
    x.extend((0..=8).rev().map(|i| [f64::from(i), 0.5]));
    let count = if closed { 18 } else { 17 };
    let segments: Vec<[usize; 2]> = (0..count).map(|i| [i + 1, (i + 1) % 18 + 1]).collect();
    let surfaces = ContactSurfaces::new(vec![0], &[], segments);
    (surfaces, x)
}

fn passes_of(closed: bool, from: [f64; 2], to: [f64; 2], contact: Contact) -> Option<[usize; 2]> {
    let (surfaces, mut x) = plate(closed);
    x[0] = from;
    let u0 = vec![0.0; 2 * x.len()];
    let mut u1 = u0.clone();
    (u1[0], u1[1]) = (to[0] - from[0], to[1] - from[1]);
    let contacts = [surfaces];
    let mut search = Search::new(&contacts, &x);
    search.cover_path(&u0, &u1);
    find_penetration(
        &search,
        [&u0, &u1],
        contact.closed().each_ref(),
        &vec![0.0; x.len()],
    )
    .map(
        |NodeAtSegment {
             nodes: [_, a, b], ..
         }| [a, b],
    )
}

fn passes(from: [f64; 2], to: [f64; 2], contact: Contact) -> Option<[usize; 2]> {
    passes_of(true, from, to, contact)
}

/// Contact of the slave node: whether the node was closed before, and on which segment it is closed at the end.
#[derive(Clone, Copy)]
struct Contact {
    before: bool,
    now: Option<usize>,
}

impl Contact {
    fn closed(self) -> [ClosedPairs; 2] {
        let before = self.before.then(|| closed_pair(0, 0));
        let now = self.now.map(|segment| closed_pair(0, segment));
        [before, now].map(|pair| pair.into_iter().collect())
    }
}

const FREE: Contact = Contact {
    before: false,
    now: None,
};
/// The node was in contact before the increment, but is not at the end.
const LEAVES: Contact = Contact {
    before: true,
    now: None,
};
/// Numbers of two segments: on top from (5, 0.5) to (4, 0.5), below from (4, 0) to (5, 0).
const TOP: [usize; 2] = [13, 14];
const BOTTOM: [usize; 2] = [5, 6];

fn held(before: bool, now: usize) -> Contact {
    let now = Some(now);
    Contact { before, now }
}

#[test]
fn a_free_node_may_not_end_inside_nor_go_through() {
    assert_eq!(passes([4.5, 2.0], [4.5, 0.6], FREE), None);
    assert_eq!(passes([4.5, 2.0], [4.5, 0.4], FREE), Some(TOP));
    assert_eq!(passes([4.5, 2.0], [4.5, -70.0], FREE), Some(TOP));
    assert_eq!(passes([4.5, -20.0], [4.5, 90.0], FREE), Some(BOTTOM));
    assert_eq!(passes([4.5, 0.4], [4.5, 0.1], FREE), None, "was inside");
    assert_eq!(
        passes([4.5, 2.0], [4.5, 0.5 - 1e-12], FREE),
        None,
        "round-off"
    );
}

#[test]
fn what_other_bodies_leave_unsolved_is_no_excuse() {
    let (surfaces, mut x) = plate(true);
    x[0] = [4.5, 2.0];
    let u0 = vec![0.0; 2 * x.len()];
    let mut u1 = u0.clone();
    u1[1] = -1.6;
    let contacts = [surfaces];
    let mut search = Search::new(&contacts, &x);
    search.cover_path(&u0, &u1);
    let entry = |fast: usize| {
        let mut unsolved = vec![0.0; x.len()];
        unsolved[fast] = 0.2;
        let closed = FREE.closed();
        find_penetration(&search, [&u0, &u1], closed.each_ref(), &unsolved).map(
            |NodeAtSegment {
                 nodes: [_, a, b], ..
             }| [a, b],
        )
    };
    // 0.1 deep: a node far away, those of the segment, the node itself
    assert_eq!(entry(1), Some(TOP));
    assert_eq!([entry(TOP[0]), entry(TOP[1]), entry(0)], [None; 3]);
}

#[test]
fn a_node_that_the_other_side_holds_has_gone_through() {
    let (top, bottom) = (12, 4);
    assert_eq!(
        passes([4.5, 2.0], [4.5, 0.0], held(false, bottom)),
        Some(TOP)
    );
    assert_eq!(
        passes([4.5, 0.5], [4.5, 0.0], held(true, bottom)),
        Some(TOP)
    );
    assert_eq!(
        passes([4.5, 2.0], [4.5, 0.5 - 1e-6], held(false, top)),
        None
    );
}

#[test]
fn corners_may_be_cut_in_contact() {
    // The right side runs from (8, 0) to (8, 0.5), segment 8; the last one on top is 9.
    let (on_top, on_side) = ([7.9, 0.5], [8.0, 0.4]);
    assert_eq!(passes(on_top, on_side, held(true, 8)), None, "slides round");
    assert_eq!(passes(on_side, on_top, held(true, 9)), None);
    let beyond = [8.1, 0.3];
    assert_eq!(passes(on_top, beyond, LEAVES), None, "slides off");
    assert!(
        passes([7.7, 0.6], [8.1, 0.2], FREE).is_some(),
        "flies through"
    );
    assert_eq!(passes([7.985, 0.51], [8.015, 0.48], FREE), None, "clips");
    let lands = held(false, 8);
    assert_eq!(passes([7.95, 0.55], [8.0, 0.48], lands), None);
    assert_eq!(
        passes([8.1, 0.4985], [7.9, 0.5], FREE),
        None,
        "clips, then on top"
    );
    assert!(
        passes([8.1, 0.47], [7.9, 0.5], FREE).is_some(),
        "cuts the corner off"
    );
}

#[test]
fn a_node_on_a_vertex_may_go_anywhere_outside() {
    let corner = [8.0, 0.5 - 1e-16];
    assert_eq!(passes(corner, [8.1, 0.4], FREE), None);
    assert_eq!(passes(corner, [7.9, 0.6], FREE), None);
    assert_eq!(passes(corner, [8.3, 0.6], FREE), None);
    assert!(passes(corner, [7.9, 0.3], FREE).is_some());
}

#[test]
fn a_node_may_slide_off_the_end_of_an_open_surface() {
    // Without the left side the top ends at (0, 0.5).
    let off = |contact| passes_of(false, [0.1, 0.5], [-0.1, 0.3], contact);
    assert_eq!(off(LEAVES), None);
    assert!(off(FREE).is_some());
    assert!(passes_of(false, [4.5, 0.5], [4.4, 0.3], LEAVES).is_some());
}

#[test]
fn a_node_may_slide_over_several_segments() {
    let slides = held(true, 9);
    assert_eq!(passes([3.5, 0.5], [7.4, 0.5 - 1e-15], slides), None);
}

#[test]
fn a_hollow_corner_holds_a_node_with_both_sides() {
    // A valley over (2, 1), (0, 0), (-2, 1): the node goes on along the line of its left slope.
    let surfaces = ContactSurfaces::new(vec![0], &[], vec![[1, 2], [2, 3]]);
    let entry = |travel: f64| {
        let x = [[0.2, 0.1], [2.0, 1.0], [0.0, 0.0], [-2.0, 1.0]];
        let u0 = [0.0; 8];
        let mut u1 = u0;
        (u1[0], u1[1]) = (-travel, -travel / 2.0);
        let contacts = [surfaces.clone()];
        let mut search = Search::new(&contacts, &x);
        search.cover_path(&u0, &u1);
        let closed = held(true, 0).closed();
        find_penetration(&search, [&u0, &u1], closed.each_ref(), &[0.0; 4])
    };
    let through = NodeAtSegment {
        key: key(0, 1),
        nodes: [0, 2, 3],
    };
    assert_eq!(entry(0.1), None);
    assert_eq!(entry(0.21), Some(through));
    assert_eq!(entry(0.6), Some(through));
}

#[test]
fn a_node_may_not_end_inside_a_vertex_that_has_become_a_hollow() {
    // The node touches the roof near its top, which sinks until the corner is concave; it ends on
    // the line of the first side, behind the second.
    let x = [[0.05, -0.05], [1.0, -1.0], [0.0, 0.0], [-1.0, -0.9]];
    let surfaces = ContactSurfaces::new(vec![0], &[], vec![[1, 2], [2, 3]]);
    let end = [[-0.2, -0.36], [1.0, 0.0], [0.0, -0.3], [-1.0, 0.0]];
    let contacts = [surfaces];
    let mut search = Search::new(&contacts, &x);
    let u0 = vec![0.0; 8];
    let move_to = |end: [[f64; 2]; 4]| -> Vec<f64> {
        let pairs = end.iter().zip(&x);
        pairs
            .flat_map(|(e, x)| [e[0] - x[0], e[1] - x[1]])
            .collect()
    };
    let closed = LEAVES.closed();
    let u1 = move_to(end);
    search.cover_path(&u0, &u1);
    let entry = find_penetration(&search, [&u0, &u1], closed.each_ref(), &[0.0; 4]);
    assert_eq!(entry.map(|p| p.nodes), Some([0, 2, 3]));
    // in the concave corner
    let above = [[-0.2, -0.2], end[1], end[2], end[3]];
    let u1 = move_to(above);
    search.cover_path(&u0, &u1);
    let entry = find_penetration(&search, [&u0, &u1], closed.each_ref(), &[0.0; 4]);
    assert_eq!(entry, None);
}
