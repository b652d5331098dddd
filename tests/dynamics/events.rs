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

use crate::blocks::{Block, Keep, add_block, add_contact, fixed, model, run_to_end, step, throw};
use stickslip::dynamics::{IncrementReport, Landing, RunSummary};
use stickslip::model::{BodyForce, ImpactTime, Load, Model, Scheme, Settings, Variation};

const PAPER: Scheme = Scheme::Ss22 {
    theta1: 1.0,
    theta2: 1.0,
};
const SCHEMES: [Scheme; 2] = [PAPER, Scheme::EnergyMomentum];

fn settings(scheme: Scheme, impact_time: ImpactTime) -> Settings {
    Settings {
        scheme,
        impact_time,
        ..Settings::default()
    }
}

/// A block at some height above a fixed plate, turned by `angle` about its lower left corner, thrown
/// down.
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

fn total(report: &IncrementReport) -> f64 {
    report.energy.kinetic + report.energy.strain
}

/// Energy never rises, and the gaps at the ends of all increments are closed but for round-off.
fn check(keep: &Keep, what: &str) {
    let scale = total(&keep.reports[0]);
    for pair in keep.reports.windows(2) {
        let rise = total(&pair[1]) - total(&pair[0]);
        let work = pair[1].energy.external_work - pair[0].energy.external_work;
        assert!(
            rise - work <= 1e-9 * scale.max(1e-3),
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
    for scheme in SCHEMES {
        for (dt, count) in [(0.007, 12), (0.0113, 8), (0.03, 3), (0.09, 1)] {
            let mut fall = Fall::new(1e5, 0.0, 0.0);
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
