//! Increments that end at impacts: `*STICKSLIP, IMPACT TIME=EVENT`.
//!
//! ```text
//!        +------+
//!        |      |  block of 1 x 1
//!        +------+
//!            |  v
//!            v
//!   |================|  fixed plate
//! ```

use crate::blocks::{
    Block, Keep, PAPER, SCHEMES, add_block, add_contact, fixed, gravity, model, run_to_end, step,
    throw,
};
use crate::energies::energy;
use stickslip::dynamics::{IncrementReport, Landing, RunSummary};
use stickslip::model::{ContactFormulation, ImpactTime, Model, Scheme, Settings};

const FORMULATIONS: [ContactFormulation; 2] = [
    ContactFormulation::NodeToSegment,
    ContactFormulation::SurfaceToSurface,
];

fn settings(scheme: Scheme, impact_time: ImpactTime) -> Settings {
    Settings {
        scheme,
        impact_time,
        ..Settings::default()
    }
}

/// A block at some height above a fixed plate, turned by `angle` about its lower left corner,
/// thrown down.
struct Fall {
    model: Model,
    block: Block,
    plate: Block,
}

const HEIGHT: f64 = 0.1;
const SPEED: f64 = 2.0;

impl Fall {
    fn new(young: f64, friction: f64, angle: f64) -> Self {
        let mut model = model(young, 0.2, 1.0);
        let plate = add_block(&mut model, [-1.0, -0.5], [3.0, 0.5], (3, 1), 0.0);
        let block = add_block(&mut model, [0.0, HEIGHT], [1.0, 1.0], (2, 2), angle);
        throw(&mut model, &block, [0.0, -SPEED], 0.0, [0.0; 2]);
        add_contact(&mut model, block.faces(0), plate.faces(2), friction);
        Fall {
            model,
            block,
            plate,
        }
    }

    fn with(mut self, formulation: ContactFormulation) -> Self {
        self.model.contacts[0].formulation = formulation;
        self
    }

    fn run(&mut self, settings: Settings, dt: f64, count: usize) -> (Keep, RunSummary) {
        let nodes = self.plate.nodes();
        let supports = nodes.flat_map(|n| [fixed(2 * n), fixed(2 * n + 1)]);
        let mut last = step(dt, count, settings, supports.collect());
        if let Some(mut old) = self.model.steps.pop() {
            last.body_forces.append(&mut old.body_forces);
        }
        self.model.steps = vec![last];
        run_to_end(&self.model)
    }
}

fn landings(keep: &Keep) -> Vec<Landing> {
    let all = keep.reports.iter().flat_map(|r| &r.landings);
    all.copied().collect()
}

/// Energy never rises, and the gaps at the ends of all increments are closed but for round-off.
fn check(keep: &Keep, what: &str) {
    let scale = keep.reports.iter().map(energy).fold(0.0, f64::max);
    for pair in keep.reports.windows(2) {
        let rise = energy(&pair[1]) - energy(&pair[0]);
        let work = pair[1].energy.external_work - pair[0].energy.external_work;
        assert!(
            rise - work <= 1e-9 * scale,
            "{what}: energy rises by {rise:e} at {}",
            pair[1].time
        );
        let jump = pair[1].energy.impact_loss - pair[0].energy.impact_loss;
        assert!(jump >= -1e-12 * scale, "{what}: a jump adds {jump:e}");
        for contact in &pair[1].contacts {
            let gap = contact.min_gap;
            assert!(gap.is_nan() || gap >= -1e-9, "{what}: gap {gap:e}");
        }
    }
}

#[test]
fn a_flat_block_lands_at_the_time_of_its_fall() {
    let expected = HEIGHT / SPEED;
    for (scheme, formulation) in SCHEMES
        .into_iter()
        .flat_map(|s| FORMULATIONS.map(|f| (s, f)))
    {
        for (dt, count) in [(0.007, 12), (0.0113, 8), (0.03, 3), (0.09, 1)] {
            let mut fall = Fall::new(1e5, 0.0, 0.0).with(formulation);
            let (keep, summary) = fall.run(settings(scheme, ImpactTime::Event), dt, count);
            let landings = landings(&keep);
            let worst = landings[..3]
                .iter()
                .map(|l| (l.time - expected).abs() / dt)
                .fold(0.0, f64::max);
            println!(
                "{scheme:?} dt {dt}: error {worst:.1e} dt, {} events, {} increments, {} cutbacks",
                summary.events, summary.increments, summary.cutbacks
            );
            assert!(worst < 1e-8, "{worst:e}");
            let end = keep
                .reports
                .iter()
                .find(|r| (r.time - expected).abs() < 1e-8 * dt);
            assert!(end.is_some(), "an increment ends there");
            assert!(
                landings[..3]
                    .iter()
                    .all(|l| (l.approach_speed - SPEED).abs() < 1e-6)
            );
            assert_eq!(keep.reports.last().unwrap().step_time, dt * count as f64);
            check(&keep, "flat");
        }
    }
}

#[test]
fn the_nodes_of_a_tilted_block_land_one_after_the_other() {
    let (dt, tilt) = (0.02, 0.002);
    for scheme in SCHEMES {
        for friction in [0.0, 0.3] {
            let mut fall = Fall::new(1e5, friction, tilt);
            let (keep, summary) = fall.run(settings(scheme, ImpactTime::Event), dt, 10);
            let landings = landings(&keep);
            println!(
                "{scheme:?} {friction}: {} events, {} increments, {} cutbacks, {:?}",
                summary.events,
                summary.increments,
                summary.cutbacks,
                landings
                    .iter()
                    .map(|l| (l.slave, l.time))
                    .collect::<Vec<_>>()
            );
            // the first is that of the lower corner, before the block feels anything
            let corner = fall.block.node(0, 0);
            let first = landings[0];
            assert!(first.slave == corner && (first.time - HEIGHT / SPEED).abs() < 1e-8 * dt);
            let times: Vec<f64> = keep.reports.iter().map(|r| r.time).collect();
            for landing in &landings {
                let is_end = times.iter().any(|t| (t - landing.time).abs() < 1e-3 * dt);
                assert!(is_end, "an increment ends at {}", landing.time);
            }
            let three: Vec<usize> = (0..3).map(|i| fall.block.node(i, 0)).collect();
            assert!(three.iter().all(|n| landings.iter().any(|l| l.slave == *n)));
            assert!(summary.events >= 3);
            check(&keep, "tilted");
        }
    }
}

#[test]
fn free_bodies_keep_their_momenta_through_impacts() {
    for friction in [0.0, 0.3] {
        for (scheme, formulation) in SCHEMES
            .into_iter()
            .flat_map(|s| FORMULATIONS.map(|f| (s, f)))
        {
            let mut model = crate::invariants::oblique_impact(friction, scheme);
            model.contacts[0].formulation = formulation;
            model.steps[0].settings.impact_time = ImpactTime::Event;
            let (keep, summary) = run_to_end(&model);
            let first = &keep.reports[0];
            let scale = (2.0 * energy(first)).sqrt();
            let worst = keep
                .reports
                .iter()
                .fold([0.0_f64; 2], |[linear, angular], r| {
                    let d = |i: usize| r.momentum.linear[i] - first.momentum.linear[i];
                    let a = r.momentum.angular - first.momentum.angular;
                    [
                        linear.max(d(0).hypot(d(1)) / scale),
                        angular.max(a.abs() / scale),
                    ]
                });
            let last = keep.reports.last().unwrap();
            println!(
                "{scheme:?} {friction}: linear {:.1e} angular {:.1e}, {} events, {} increments, \
                 {} landings, energy kept {:.4}, normal work {:.1e}",
                worst[0],
                worst[1],
                summary.events,
                summary.increments,
                landings(&keep).len(),
                energy(last) / energy(first),
                last.energy.normal_contact_work / energy(first),
            );
            assert!(summary.events > 3 && worst[0] < 1e-9);
            assert!(scheme == PAPER || worst[1] < 1e-9);
            assert!(last.energy.balance.abs() < 1e-8 * energy(first));
            if scheme == Scheme::EnergyMomentum {
                check(&keep, "oblique");
                // the default rule takes a thirtieth of the energy here
                let work = last.energy.normal_contact_work;
                assert!(work.abs() < 1e-5 * energy(first), "{work:e}");
            }
        }
    }
}

/// From surface to surface a face of length h that leans by an angle a has the mean gap g + (h/3) sin a at its lower end, g being
/// the gap of the corner there. The corner may sink by 3e-5 h, so it lands first where the face leans by more than 9e-5.
#[test]
fn a_leaning_face_lands_when_its_mean_gap_is_zero() {
    let (face, dt) = (0.5, 0.02);
    for (angle, of_mean) in [(5e-5_f64, true), (0.2, false)] {
        let gap = match of_mean {
            true => HEIGHT + face / 3.0 * angle.sin(),
            false => HEIGHT + 3e-5 * face,
        };
        for (scheme, friction) in SCHEMES
            .into_iter()
            .flat_map(|s| [0.0, 0.3].map(|mu| (s, mu)))
        {
            let mut fall =
                Fall::new(1e5, friction, angle).with(ContactFormulation::SurfaceToSurface);
            let (keep, summary) = fall.run(settings(scheme, ImpactTime::Event), dt, 5);
            let off = |r: &IncrementReport| (r.time - gap / SPEED).abs();
            let nearest = keep.reports.iter().map(off).fold(f64::INFINITY, f64::min);
            let first = landings(&keep)[0];
            println!(
                "{angle} {scheme:?} {friction}: off by {nearest:.1e}, {first:?}, {} events",
                summary.events
            );
            assert!(nearest < 1e-8 * dt, "an increment ends there: {nearest:e}");
            assert_eq!(first.slave, fall.block.node(0, 0));
            if of_mean {
                assert!((first.time - gap / SPEED).abs() < 1e-8 * dt);
                assert!((first.approach_speed - SPEED).abs() < 1e-6);
            }
            assert!(summary.events >= 1);
        }
    }
}

/// Two bars of unlike mesh fly at each other, with friction: the event is in the increment where they meet, and nothing is lost
/// but to the impulses.
#[test]
fn bars_of_unlike_mesh_meet_at_their_time() {
    let (gap, closing, dt) = (0.05, 1.3, 0.02);
    for scheme in SCHEMES {
        let mut model = model(1e3, 0.0, 1.0);
        let lower = add_block(&mut model, [0.0, 0.0], [1.0, 1.0], (4, 5), 0.0);
        let upper = add_block(&mut model, [0.0, 1.0 + gap], [1.0, 1.0], (3, 5), 0.0);
        throw(&mut model, &lower, [0.2, 0.3], 0.0, [0.5; 2]);
        throw(&mut model, &upper, [0.2, 0.3 - closing], 0.0, [0.5; 2]);
        add_contact(&mut model, upper.faces(0), lower.faces(2), 0.3);
        model.contacts[0].formulation = ContactFormulation::SurfaceToSurface;
        let settings = settings(scheme, ImpactTime::Event);
        model.steps = vec![step(dt, 20, settings, Vec::new())];
        let (keep, summary) = run_to_end(&model);
        let landings = landings(&keep);
        let off = |l: &Landing| (l.time - gap / closing).abs();
        let worst = landings[..4].iter().map(off).fold(0.0, f64::max);
        let (first, last) = (&keep.reports[0], keep.reports.last().unwrap());
        let [start, end] = [first, last].map(energy);
        let drift = |r: &IncrementReport| {
            let d = |i: usize| r.momentum.linear[i] - first.momentum.linear[i];
            d(0).hypot(d(1))
        };
        let drift = keep.reports.iter().map(drift).fold(0.0, f64::max);
        println!(
            "{scheme:?}: off by {worst:.1e}, kept {:.5}, impulses {:.5}, work {:.1e}, balance {:.1e}, momentum {drift:.1e}, {} events",
            end / start,
            last.energy.impact_loss / start,
            last.energy.normal_contact_work / start,
            last.energy.balance / start,
            summary.events
        );
        assert!(worst < 1e-8 * dt, "{worst:e}");
        assert!(drift < 1e-12 && last.energy.balance.abs() < 1e-12 * start);
        if scheme == Scheme::EnergyMomentum {
            check(&keep, "bars");
            let lost = last.energy.impact_loss - last.energy.normal_contact_work;
            assert!((start - end - lost).abs() < 1e-12 * start);
            assert!(last.energy.normal_contact_work.abs() < 1e-12 * start);
        }
    }
}

fn weigh(fall: &mut Fall, g: f64, settings: Settings, dt: f64, count: usize) -> (Keep, RunSummary) {
    let first = fall.block.first_element;
    let mut weighed = step(dt, count, settings, Vec::new());
    let pull = |element| gravity(element, g);
    weighed.body_forces = (first..first + 4).map(pull).collect();
    fall.model.steps = vec![weighed];
    fall.run(settings, dt, count)
}

/// A block at rest on the plate, pressed on by its weight.
fn at_rest(friction: f64) -> Fall {
    let mut fall = Fall::new(1e5, friction, 0.0);
    for node in fall.block.nodes() {
        fall.model.mesh.coordinates[node][1] -= HEIGHT;
    }
    fall.model.initial_velocity.fill(0.0);
    fall
}

#[test]
fn a_resting_block_costs_no_subincrements() {
    for scheme in SCHEMES {
        for (friction, formulation) in [0.0, 0.3].into_iter().zip(FORMULATIONS) {
            let mut fall = at_rest(friction).with(formulation);
            let settings = settings(scheme, ImpactTime::Event);
            let (keep, summary) = weigh(&mut fall, 1.0, settings, 0.01, 100);
            println!(
                "{scheme:?} {friction}: {} events, {} factorisations",
                summary.events, summary.solver.factorizations
            );
            assert_eq!((summary.events, summary.increments), (0, 100));
            check(&keep, "at rest");
        }
    }
}

#[test]
fn a_bouncing_block_comes_to_the_end_of_its_step() {
    for scheme in SCHEMES {
        for angle in [0.0, 0.3] {
            let mut fall = Fall::new(1e4, 0.2, angle);
            let settings = settings(scheme, ImpactTime::Event);
            let (keep, summary) = weigh(&mut fall, 20.0, settings, 0.02, 100);
            println!(
                "{scheme:?} {angle}: {} events, {} increments, {} cutbacks, {} landings, energy {:.3}",
                summary.events,
                summary.increments,
                summary.cutbacks,
                landings(&keep).len(),
                keep.reports.last().unwrap().energy.kinetic,
            );
            check(&keep, "bouncing");
            let grid: Vec<f64> = (1..=100).map(|i| 0.02 * i as f64).collect();
            for time in &grid[..99] {
                assert!(keep.reports.iter().any(|r| r.step_time == *time), "{time}");
            }
        }
    }
}

#[test]
fn two_runs_are_the_same_to_the_last_bit() {
    let run = || Fall::new(1e4, 0.3, 0.1).run(settings(PAPER, ImpactTime::Event), 0.01, 60);
    let (one, other) = (run().0, run().0);
    assert_eq!(one.reports.len(), other.reports.len());
    for (a, b) in one.reports.iter().zip(&other.reports) {
        assert_eq!(
            (&a.state, a.time, &a.landings),
            (&b.state, b.time, &b.landings)
        );
    }
}

/// Between impacts the motion is not that of the start, so that the time of an impact is searched
/// for: a node that lands is on the plate at the end of its subincrement, to the accuracy of that
/// search.
#[test]
fn a_node_that_lands_is_on_the_plate_when_its_piece_ends() {
    let dt = 0.02;
    for scheme in SCHEMES {
        let mut fall = Fall::new(1e3, 0.0, 0.03);
        // it swings as it falls
        for node in fall.block.nodes() {
            let [x, y] = fall.model.mesh.coordinates[node];
            fall.model.initial_velocity[2 * node] += 0.4 * x;
            fall.model.initial_velocity[2 * node + 1] += 0.5 * (y - HEIGHT);
        }
        let (keep, summary) = fall.run(settings(scheme, ImpactTime::Event), dt, 10);
        let at_landing = |l: &Landing| {
            let ends = |r: &&IncrementReport| (r.time - l.time).abs() < 1e-9 * dt;
            let report = keep.reports.iter().find(ends)?;
            let u = &report.state.u;
            Some(fall.model.mesh.coordinates[l.slave][1] + u[2 * l.slave + 1])
        };
        let gaps: Vec<f64> = landings(&keep).iter().filter_map(at_landing).collect();
        let worst = gaps.iter().fold(0.0, |m: f64, gap| m.max(gap.abs()));
        println!(
            "{scheme:?}: {} gaps, worst {worst:.1e}, {} events",
            gaps.len(),
            summary.events
        );
        assert!(gaps.len() >= 2 && worst <= 1e-10 * dt * SPEED, "{worst:e}");
    }
}

/// Whether a node is struck depends on the velocities of its two bodies only.
#[test]
fn a_slow_body_lands_beside_a_fast_one() {
    let run = |scheme: Scheme, passing_speed: f64| {
        let mut fall = Fall::new(1e3, 0.0, 0.01);
        let passing = add_block(&mut fall.model, [0.0, 1e3], [0.5, 0.5], (1, 1), 0.0);
        // the block again: adding another body has stopped it
        throw(&mut fall.model, &fall.block, [0.0, -SPEED], 0.0, [0.0; 2]);
        let up = [0.0, passing_speed];
        throw(&mut fall.model, &passing, up, 0.0, [0.0; 2]);
        let (keep, _) = fall.run(settings(scheme, ImpactTime::Event), 0.002, 100);
        let landings = landings(&keep);
        landings
            .iter()
            .map(|l| (l.slave, l.time))
            .collect::<Vec<_>>()
    };
    for scheme in SCHEMES {
        let (alone, beside) = (run(scheme, 0.0), run(scheme, 1e10 * SPEED));
        println!(
            "{scheme:?}: {} landings, {} beside",
            alone.len(),
            beside.len()
        );
        assert_eq!(alone.len(), beside.len());
        for ((slave, time), (other, at)) in alone.iter().zip(&beside) {
            assert!(slave == other && (time - at).abs() < 1e-9 * time);
        }
    }
}
