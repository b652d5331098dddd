//! Friction that depends on slip rate and pressure: a sliding block against closed forms, and Coulomb's law with the
//! coefficient of its own slip rate and pressure at every node.

use stickslip::dynamics::IncrementReport;
use stickslip::model::{Friction, FrictionCurve, FrictionLaw, LcpMethod, Model, Scheme};

use crate::blocks::{Block, SCHEMES, run_to_end, throw};
use crate::friction::block_on_base;

const GRAVITY: f64 = 10.0;
const SPEED: f64 = 1.0;

/// The block of [`block_on_base`] thrown along the base.
fn thrown(scheme: Scheme, friction: &Friction, speed: f64) -> (Model, Block) {
    let (mut model, block) = block_on_base(0.0, [0.0, -1.0], scheme);
    model.contacts[0].interaction.friction = friction.clone();
    throw(&mut model, &block, [speed, 0.0], 0.0, [0.0, 0.0]);
    (model, block)
}

fn curve(pressure: f64, points: &[[f64; 2]]) -> FrictionCurve {
    FrictionCurve {
        pressure,
        points: points.to_vec(),
    }
}

fn decay() -> Friction {
    FrictionLaw::Decay {
        at_rest: 0.3,
        sliding: 0.1,
        decay: 2.0,
    }
    .into()
}

/// s = int g dt/g with g growing over 0.2.
fn grown(t: f64) -> f64 {
    if t < 0.2 { t * t / 0.4 } else { t - 0.1 }
}

/// Velocity of a rigid block: dv/dt = -mu(v) g(t) with [`decay`],
///
/// ```text
/// mu_k exp(d v) + mu_s - mu_k = (mu_k exp(d v0) + mu_s - mu_k) exp(-mu_k d g s)
/// ```
fn decayed(t: f64) -> f64 {
    let [at_rest, sliding, decay] = [0.3, 0.1, 2.0_f64];
    let fall = at_rest - sliding;
    let start = sliding * (decay * SPEED).exp() + fall;
    let now = start * (-sliding * decay * GRAVITY * grown(t)).exp();
    ((now - fall) / sliding).max(1.0).ln() / decay
}

/// The same with mu = m_i + k_i (v - v_i) between rows: there v + m_i/k_i - v_i falls as exp(-k_i g s).
fn between_rows(rows: &[[f64; 2]], speed: f64, t: f64) -> f64 {
    let (mut v, mut left) = (speed, GRAVITY * grown(t));
    for row in rows.windows(2).rev() {
        let [[v0, m0], [v1, m1]] = [row[0], row[1]];
        if v <= v0 {
            continue;
        }
        let k = (m1 - m0) / (v1 - v0);
        let still = v0 - m0 / k;
        let to_next = ((v - still) / (v0 - still)).ln() / k;
        if to_next > left {
            return still + (v - still) * (-k * left).exp();
        }
        (v, left) = (v0, left - to_next);
    }
    0.0
}

/// Velocity of the block's centre of mass along x: all that moves has the mass 2.
fn speed(report: &IncrementReport) -> f64 {
    report.momentum.linear[0] / 2.0
}

/// Runs a thrown block and compares its speed until 0.6; returns the last report.
fn slides_as(
    friction: &Friction,
    start: f64,
    expected: impl Fn(f64) -> f64,
    what: &str,
) -> Vec<IncrementReport> {
    let mut last = Vec::new();
    for scheme in SCHEMES {
        let (model, _) = thrown(scheme, friction, start);
        let (keep, summary) = run_to_end(&model);
        let error = |report: &&IncrementReport| (speed(report) - expected(report.time)).abs();
        let sliding = keep.reports.iter().filter(|report| report.time < 0.6);
        let largest = sliding.map(|report| error(&report)).fold(0.0, f64::max);
        println!("{what}, {scheme:?}: largest error of the speed {largest:.2e}");
        assert!(largest < 0.01 * SPEED, "{what} {scheme:?} {largest}");
        assert_eq!(summary.cutbacks, 0, "{what} {scheme:?}");
        let kinetic = keep
            .reports
            .iter()
            .map(|r| r.energy.kinetic + r.energy.strain - r.energy.external_work);
        let rises = kinetic
            .collect::<Vec<_>>()
            .windows(2)
            .map(|e| e[1] - e[0])
            .fold(0.0, f64::max);
        assert!(
            rises < 1e-9 * start * start,
            "{what} {scheme:?}: energy rises by {rises:e}"
        );
        last.extend(keep.reports.last().cloned());
    }
    last
}

#[test]
fn a_block_slows_down_as_the_closed_form_says() {
    for last in slides_as(&decay(), SPEED, decayed, "decay") {
        assert!(last.contacts[0].sticking > 0, "it rests");
        assert_eq!(last.contacts[0].friction_coefficient, 0.3);
    }
    let rows = [[0.0, 0.3], [0.4, 0.1], [1.0, 0.2]];
    let table: Friction = FrictionLaw::Table(vec![curve(0.0, &rows)]).into();
    let expected = |t| between_rows(&rows, SPEED, t);
    for last in slides_as(&table, SPEED, expected, "table") {
        assert!(last.contacts[0].sticking > 0, "it rests");
    }
}

#[test]
fn a_coefficient_that_falls_to_zero_lets_fast_bodies_go_and_stops_slow_ones() {
    let rows = [[0.0, 0.3], [1.0, 0.0]];
    let friction: Friction = FrictionLaw::Table(vec![curve(0.0, &rows)]).into();
    for last in slides_as(&friction, 1.5, |_| 1.5, "fast") {
        assert!((speed(&last) - 1.5).abs() < 1e-9);
        assert!(last.energy.friction_dissipation.abs() < 1e-9);
    }
    let slow = |t| between_rows(&rows, 0.5, t);
    for last in slides_as(&friction, 0.5, slow, "slow") {
        assert!(last.contacts[0].sticking > 0, "it rests");
    }
}

#[test]
fn the_coefficient_follows_the_pressure_and_shear_stress_has_its_limit() {
    // mu = 0.4 (1 - p/10): mu g(t) = 0.4 (1 - t/0.4) g t/0.2 while gravity grows to p = 5
    let curves = vec![curve(0.0, &[[0.0, 0.4]]), curve(10.0, &[[0.0, 0.0]])];
    let falling: Friction = FrictionLaw::Table(curves).into();
    let expected = |t: f64| {
        let r = t.min(0.2);
        let growing = 0.4 * GRAVITY * (r * r / 0.4 - r.powi(3) / 0.24);
        2.0 - growing - 0.2 * GRAVITY * (t - r)
    };
    for last in slides_as(&falling, 2.0, expected, "pressure") {
        let found = last.contacts[0].friction_coefficient;
        assert!((found - 0.2).abs() < 2e-3, "{found}");
    }
    // mu p = 1.5 t/0.2 up to the limit 1, which it reaches at 2/15
    let limited = Friction {
        shear_limit: 1.0,
        ..Friction::constant(0.3)
    };
    let expected = |t: f64| {
        let r = t.min(2.0 / 15.0);
        2.0 - (0.3 * GRAVITY * r * r / 0.4 + (t - r) * 1.0 * 4.0 / 2.0)
    };
    for last in slides_as(&limited, 2.0, expected, "limit") {
        assert!(last.contacts[0].tangential.abs() <= 4.0 * (1.0 + 1e-3));
    }
}

#[test]
fn every_node_has_the_friction_of_its_own_slip_rate_and_pressure() {
    let curves = vec![
        curve(2.0, &[[0.0, 0.4], [1.0, 0.2]]),
        curve(6.0, &[[0.0, 0.3], [0.5, 0.05]]),
    ];
    let table = Friction {
        law: FrictionLaw::Table(curves),
        shear_limit: 1.2,
    };
    for (scheme, friction) in SCHEMES
        .into_iter()
        .flat_map(|s| [(s, decay()), (s, table.clone())])
    {
        let (model, block) = thrown(scheme, &friction, SPEED);
        let (keep, _) = run_to_end(&model);
        let mut checked = 0;
        for pair in keep.reports.windows(2) {
            let [before, now] = [&pair[0], &pair[1]];
            let bottom: Vec<usize> = (0..=block.nx).map(|i| block.node(i, 0)).collect();
            let at = |node: usize| model.mesh.coordinates[node][0] + before.state.u[2 * node];
            let most = bottom.iter().map(|&n| now.nodal.contact_force[2 * n + 1]);
            let most = most.fold(0.0, f64::max);
            for (i, &node) in bottom.iter().enumerate() {
                let x = 2 * node;
                let [pt, pn] = [0, 1].map(|i| now.nodal.contact_force[x + i]);
                let rate = (now.state.u[x] - before.state.u[x]) / now.dt;
                if rate.abs() < 1e-3 * SPEED || pn <= 0.0 {
                    continue;
                }
                let [left, right] = [i.saturating_sub(1), (i + 1).min(block.nx)];
                let pressure = pn / ((at(bottom[right]) - at(bottom[left])) / 2.0);
                let mu = friction.at(rate, pressure);
                let coulomb = -rate.signum() * mu * pn;
                // the faces of the block stay level to its strain, some 1e-4
                assert!(
                    (pt - coulomb).abs() < 1e-6 * most,
                    "{scheme:?} {}: {pt} {coulomb}",
                    now.time
                );
                assert!((now.nodal.friction.coefficient[node] - mu).abs() < 1e-6);
                checked += 1;
            }
        }
        assert!(checked > 1000, "{checked}");
    }
}

#[test]
fn rough_surfaces_do_not_slip_on_a_slope_on_which_others_do() {
    let slope: f64 = 40.0_f64.to_radians();
    let down = [slope.sin(), -slope.cos()];
    for scheme in SCHEMES {
        for lcp in [LcpMethod::Hybrid, LcpMethod::Lemke] {
            let (mut model, block) = block_on_base(0.5, down, scheme);
            model.steps[0].settings.lcp = lcp;
            model.contacts[0].interaction.friction = FrictionLaw::Rough.into();
            let (keep, _) = run_to_end(&model);
            let last = keep.reports.last().expect("reports");
            let slid = |report: &IncrementReport| {
                let slip = block.nodes().map(|node| report.nodal.slip[node]);
                slip.filter(|slip| !slip.is_nan()).fold(0.0, f64::max)
            };
            println!("{scheme:?} {lcp:?}: slip {:e}", slid(last));
            assert!(slid(last) < 1e-12, "{scheme:?} {lcp:?}: {}", slid(last));
            assert!(last.energy.friction_dissipation < 1e-12);
            assert!(last.contacts[0].sticking > 0);
        }
    }
}
