//! Search with territories against the search among all segments.

use crate::scenes::{Body, lattice, scene};
use proptest::prelude::*;
use stickslip::contact::{Candidate, ContactSurfaces, Positions, Search, SlaveNode, project};

fn bodies() -> impl Strategy<Value = Vec<Body>> {
    let body = (
        [-6.0..6.0, -6.0..6.0],
        0.2..2.0,
        3..24_usize,
        prop_oneof![Just(0.0), 0.0..0.6],
    );
    prop::collection::vec(body, 1..8)
}

/// A motion of every body as a whole, with an additional one of its nodes.
fn displacements(bodies: &[Body], moves: &[[f64; 2]], shake: f64) -> Vec<f64> {
    let mut u = Vec::new();
    for (k, &(_, _, count, _)) in bodies.iter().enumerate() {
        for i in 0..count {
            let wave = shake * (1.7 * i as f64 + k as f64).sin();
            u.extend(moves[k % moves.len()].map(|m| m + wave));
        }
    }
    u
}

/// Distance of a point from a segment.
fn distance(s: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let p = project(s, a, b);
    let xi = p.xi.clamp(0.0, 1.0);
    let foot = [0, 1].map(|i| a[i] + xi * (b[i] - a[i]));
    (s[0] - foot[0]).hypot(s[1] - foot[1])
}

/// Every slave node finds the same targets among its candidates as among all segments.
fn finds_all(search: &Search, surfaces: &ContactSurfaces, x: &[[f64; 2]], [u0, u]: [&[f64]; 2]) {
    let territory = &search.territories()[0];
    for slave in 0..surfaces.slaves.len() {
        let all = (0..surfaces.segments.len()).map(|segment| Candidate {
            segment,
            reach: territory.reach(slave, segment),
        });
        let node = SlaveNode {
            surfaces,
            start: Positions::new(x, u0),
            now: Positions::new(x, u),
            slave,
            closed_on: &[],
            allowed: [0.0; 2],
        };
        assert_eq!(
            node.targets(territory.candidates(slave)),
            node.targets(all),
            "slave {slave}"
        );
    }
}

fn mean_length(surfaces: &ContactSurfaces, x: &[[f64; 2]]) -> f64 {
    let length = |[a, b]: &[usize; 2]| (x[*b][0] - x[*a][0]).hypot(x[*b][1] - x[*a][1]);
    surfaces.segments.iter().map(length).sum::<f64>() / surfaces.segments.len() as f64
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn candidates_give_the_same_pairs_as_all_segments(
        bodies in bodies(),
        moves in prop::collection::vec([-0.3..0.3, -0.3..0.3], 8),
        shake in 0.0..0.05,
        dt in 0.0..3.0,
    ) {
        let (surfaces, x) = scene(&bodies);
        let contacts = [surfaces.clone()];
        let mut search = Search::new(&contacts, &x);
        for increment in 0..6 {
            let scale = f64::from(increment);
            let at = |scale: f64| {
                let moves: Vec<_> = moves.iter().map(|m| m.map(|m| m * scale)).collect();
                displacements(&bodies, &moves, shake * scale)
            };
            let (u, v) = (at(scale), at(1.0));
            search.start(&v, dt);
            for pass in 0..3 {
                let iterate = 1.0 + 0.2 * f64::from(pass);
                let iterate: Vec<f64> = u.iter().map(|u| u * iterate).collect();
                search.cover(&iterate);
                finds_all(&search, &surfaces, &x, [&u, &iterate]);
            }
        }
    }

    #[test]
    fn no_segment_that_a_node_meets_on_its_way_is_missing(
        bodies in bodies(),
        ways in prop::collection::vec([-8.0..8.0, -8.0..8.0], 8),
        still in 0..4_usize,
        shake in 0.0..0.3,
    ) {
        let (surfaces, x) = scene(&bodies);
        let near = mean_length(&surfaces, &x) / 2.0; // R of eq. (10.2)
        let contacts = [surfaces.clone()];
        let mut search = Search::new(&contacts, &x);
        let mut ways = ways;
        ways[..still].fill([0.0; 2]);
        let u0 = vec![0.0; 2 * x.len()];
        let u1 = displacements(&bodies, &ways, shake);
        search.cover(&u0);
        search.cover_path(&u0, &u1);
        let territory = &search.territories()[0];
        for (k, &slave) in surfaces.slaves.iter().enumerate() {
            let listed: Vec<usize> = territory.candidates(k).map(|c| c.segment).collect();
            for (i, &[a, b]) in surfaces.segments.iter().enumerate() {
                let meets = (0..=40).any(|j| {
                    let part = f64::from(j) / 40.0;
                    let [s, a, b] = [slave, a, b]
                        .map(|n| [0, 1].map(|i| x[n][i] + part * u1[2 * n + i]));
                    distance(s, a, b) <= near
                });
                let own = slave == a || slave == b;
                prop_assert!(own || !meets || listed.contains(&i), "{} {}", slave, i);
            }
        }
    }

    #[test]
    fn candidates_do_not_change_with_the_scale(bodies in bodies(), power in -30..30) {
        let scale = 2.0_f64.powi(power);
        let lists = |scale: f64| {
            let scaled: Vec<Body> = bodies
                .iter()
                .map(|&(centre, radius, count, depth)| {
                    (centre.map(|c| c * scale), radius * scale, count, depth)
                })
                .collect();
            let (surfaces, x) = scene(&scaled);
            let contacts = [surfaces];
            let mut search = Search::new(&contacts, &x);
            search.cover(&vec![0.0; 2 * x.len()]);
            let territory = &search.territories()[0];
            let list = |k| territory.candidates(k).map(|c| c.segment).collect::<Vec<_>>();
            (0..x.len()).map(list).collect::<Vec<_>>()
        };
        prop_assert_eq!(lists(1.0), lists(scale));
    }
}

#[test]
fn lists_hold_until_a_margin_is_left() {
    let (surfaces, x) = lattice(320);
    let contacts = [surfaces.clone()];
    let mut search = Search::new(&contacts, &x);
    let length = mean_length(&surfaces, &x);
    let still = vec![0.0; 2 * x.len()];
    // One body moves by a hundredth of a segment length per increment.
    for increment in 0..=500 {
        let mut u = still.clone();
        let mut v = still.clone();
        for node in 0..32 {
            (u[2 * node], v[2 * node]) = (0.01 * length * f64::from(increment), 0.01 * length);
        }
        search.start(&v, 1.0);
        search.cover(&u);
        if increment % 50 == 0 {
            finds_all(&search, &surfaces, &x, [&u, &u]);
        }
    }
    let searches = search.searches();
    assert!((9..=12).contains(&searches), "{searches}");
}

#[test]
fn distances_far_beyond_the_segments_give_no_candidate() {
    let (surfaces, x) = scene(&[([0.0, 0.0], 1.0, 16, 0.0), ([50.0, 0.0], 1.0, 16, 0.0)]);
    let contacts = [surfaces];
    let mut search = Search::new(&contacts, &x);
    search.cover(&vec![0.0; 2 * x.len()]);
    let territory = &search.territories()[0];
    let near = |k| {
        territory
            .candidates(k)
            .all(|c| (c.segment < 16) == (k < 16))
    };
    assert!((0..32).all(near));
}

#[test]
fn a_velocity_that_all_bodies_share_brings_no_pair() {
    let (surfaces, x) = scene(&[([0.0, 0.0], 1.0, 16, 0.0), ([5.0, 0.0], 1.0, 16, 0.0)]);
    let contacts = [surfaces];
    let found = |speed: f64| {
        let common: Vec<f64> = x.iter().flat_map(|_| [speed, -speed]).collect();
        let mut search = Search::new(&contacts, &x);
        search.start(&common, 1.0);
        search.cover(&common);
        let territory = &search.territories()[0];
        let list = |k| {
            territory
                .candidates(k)
                .map(|c| c.segment)
                .collect::<Vec<_>>()
        };
        let lists: Vec<_> = (0..x.len()).map(list).collect();
        (lists, territory.reach(0, 1))
    };
    let ((still, near), (moving, nearly)) = (found(0.0), found(1000.0));
    assert_eq!(still, moving);
    assert!((near - nearly).abs() < 1e-9, "{near} {nearly}");
}
