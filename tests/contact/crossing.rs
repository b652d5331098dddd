//! Crossings of moving nodes and segments against dense sampling.

use crate::random::Random;
use stickslip::contact::{CrossingSense, QuadraticMotion, crossings, project};

const CASES: usize = 100_000;
const SAMPLES: usize = 2000;
/// Of the cross products of nodes within a distance of some units.
const ROUND_OFF: f64 = 1e-13;

fn vector(random: &mut Random, size: f64) -> [f64; 2] {
    [(); 2].map(|()| random.range(-size, size))
}

/// Kinds of motions: everything at random, no accelerations, all flying together, the node near an
/// end of the segment, the node thrown so that it grazes the segment or nearly so, round numbers.
fn case(random: &mut Random, kind: usize) -> [QuadraticMotion; 3] {
    let mut motion = || QuadraticMotion {
        position: vector(random, 1.0),
        velocity: vector(random, 2.0),
        acceleration: vector(random, 4.0),
    };
    let mut nodes = [motion(), motion(), motion()];
    match kind {
        1 => nodes.iter_mut().for_each(|m| m.acceleration = [0.0; 2]),
        2 => {
            let v = vector(random, 50.0);
            let flying =
                |m: &mut QuadraticMotion| m.velocity = [0, 1].map(|i| m.velocity[i] + v[i]);
            nodes.iter_mut().for_each(flying);
        }
        3 => {
            let end = nodes[1 + random.below(2)];
            let offset = vector(random, 0.02);
            nodes[0].position = [0, 1].map(|i| end.position[i] + offset[i]);
            nodes[0].velocity = end.velocity;
        }
        4 => {
            // y = h + k (t - t0)² above a segment at rest on the x axis, h tiny or zero
            let (k, t0) = (random.range(0.5, 4.0), random.range(0.1, 0.9));
            let h = [0.0, 1e-3, -1e-3, -1e-6][random.below(4)];
            nodes = [
                QuadraticMotion {
                    position: [random.range(-0.8, 0.8), h + k * t0 * t0],
                    velocity: [0.0, -2.0 * k * t0],
                    acceleration: [0.0, 2.0 * k],
                },
                QuadraticMotion {
                    position: [1.0, 0.0],
                    ..QuadraticMotion::default()
                },
                QuadraticMotion {
                    position: [-1.0, 0.0],
                    ..QuadraticMotion::default()
                },
            ];
        }
        5 => {
            for m in &mut nodes {
                for part in [&mut m.position, &mut m.velocity, &mut m.acceleration] {
                    *part = part.map(|p| (4.0 * p).round() / 4.0);
                }
            }
        }
        _ => {}
    }
    nodes
}

/// Gap times the length of the segment, and xi.
fn place(nodes: &[QuadraticMotion; 3], t: f64) -> (f64, f64) {
    let [s, a, b] = nodes.map(|m| m.at(t));
    let (r, e) = ([s[0] - a[0], s[1] - a[1]], [b[0] - a[0], b[1] - a[1]]);
    let square = e[0] * e[0] + e[1] * e[1];
    (
        r[0] * e[1] - r[1] * e[0],
        (r[0] * e[0] + r[1] * e[1]) / square,
    )
}

#[test]
fn no_crossing_is_missed() {
    let mut random = Random(11);
    let (mut sampled, mut reported) = (0, 0);
    for case_number in 0..CASES {
        let nodes = case(&mut random, case_number % 6);
        let found = crossings(&nodes, 1.0);
        reported += found.len();
        let mut before = place(&nodes, 0.0);
        for k in 1..=SAMPLES {
            let times = [k - 1, k].map(|k| k as f64 / SAMPLES as f64);
            let after = place(&nodes, times[1]);
            // xi may leave the segment between two samples: only clear crossings count
            let steady = (before.1 - after.1).abs();
            let clear = |xi: f64| xi > 2.0 * steady && xi < 1.0 - 2.0 * steady;
            if (before.0 > 0.0) != (after.0 > 0.0)
                && before.0.abs().min(after.0.abs()) > ROUND_OFF
                && clear(before.1)
                && clear(after.1)
            {
                sampled += 1;
                let direction = match before.0 > 0.0 {
                    true => CrossingSense::Entering,
                    false => CrossingSense::Leaving,
                };
                let within = times[0] - 1e-12..=times[1] + 1e-12;
                assert!(
                    found
                        .iter()
                        .any(|c| c.direction == direction && within.contains(&c.time)),
                    "case {case_number} at {times:?}: {nodes:?} {found:?}"
                );
            }
            before = after;
        }
        // and what is reported is so
        for crossing in found {
            let [s, a, b] = nodes.map(|m| m.at(crossing.time));
            let foot = [0, 1].map(|i| a[i] + crossing.xi * (b[i] - a[i]));
            let distance = (s[0] - foot[0]).hypot(s[1] - foot[1]);
            assert!(
                distance < 1e-7,
                "case {case_number}: {crossing:?} {distance:e}"
            );
            assert!((0.0..=1.0).contains(&crossing.time) && (0.0..=1.0).contains(&crossing.xi));
        }
    }
    println!("{sampled} sampled, {reported} reported");
    assert!(sampled > CASES / 4 && reported >= sampled);
}

#[test]
fn grazing_is_reported_and_a_near_miss_is_not() {
    for (h, expected) in [(0.0, 1), (1e-9, 0), (-1e-9, 2)] {
        // y = h + (t - 0.3)² above a segment at rest
        let s = QuadraticMotion {
            position: [0.1, h + 0.09],
            velocity: [0.0, -0.6],
            acceleration: [0.0, 2.0],
        };
        let rest = |x: f64| QuadraticMotion {
            position: [x, 0.0],
            ..QuadraticMotion::default()
        };
        let found = crossings(&[s, rest(1.0), rest(-1.0)], 1.0);
        assert_eq!(found.len(), expected, "{h}: {found:?}");
    }
}

#[test]
fn scaling_by_powers_of_two_changes_times_and_places_by_no_bit() {
    let mut random = Random(5);
    let (length, time) = (2.0_f64.powi(-37), 2.0_f64.powi(21));
    for kind in (0..6).cycle().take(3000) {
        let nodes = case(&mut random, kind);
        let scaled = nodes.map(|m| QuadraticMotion {
            position: m.position.map(|x| x * length),
            velocity: m.velocity.map(|v| v * length / time),
            acceleration: m.acceleration.map(|a| a * length / time / time),
        });
        let found = crossings(&nodes, 1.0);
        let found_scaled = crossings(&scaled, time);
        assert_eq!(found.len(), found_scaled.len());
        for (c, d) in found.iter().zip(&found_scaled) {
            assert_eq!(
                (c.time * time, c.xi, c.direction),
                (d.time, d.xi, d.direction)
            );
        }
    }
}

#[test]
fn the_gap_has_the_sign_of_the_cross_product() {
    let nodes = case(&mut Random(3), 0);
    let [s, a, b] = nodes.map(|m| m.position);
    let p = project(s, a, b);
    assert!((place(&nodes, 0.0).0 - p.gap * p.length).abs() < 1e-14);
}
