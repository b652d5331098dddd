//! A face of an element that is squeezed to a point: the run stops, and says where.

use std::io;

use crate::blocks::{Keep, add_block, add_contact, fixed, model, run, step};
use stickslip::dynamics::{Cause, Cutback, IncrementReport, Observer, Outcome};
use stickslip::model::{ImpactTime, Model, Settings, Support, SupportMotion};

/// A block whose upper face loses its length, and the ends of that face.
fn squeezed(settings: Settings) -> (Model, [usize; 2]) {
    let mut model = model(1e3, 0.3, 1.0);
    let floor = add_block(&mut model, [-1.0, -1.0], [4.0, 0.5], (1, 1), 0.0);
    let block = add_block(&mut model, [0.0, 0.0], [2.0, 1.0], (2, 1), 0.0);
    add_contact(&mut model, floor.faces(2), block.faces(2), 0.0);
    let (moved, held) = (block.node(1, 1), block.node(2, 1));
    let mut supports: Vec<Support> = floor
        .nodes()
        .flat_map(|n| [2 * n, 2 * n + 1])
        .map(fixed)
        .collect();
    supports.extend([2 * moved + 1, 2 * held, 2 * held + 1].map(fixed));
    let to_the_corner = SupportMotion::Ramp { to: 1.0 };
    supports.push(Support {
        dof: 2 * moved,
        motion: to_the_corner,
    });
    model.steps = vec![step(0.1, 10, settings, supports)];
    (model, [held, moved])
}

#[test]
fn a_segment_without_length_stops_the_run() {
    let (model, segment) = squeezed(Settings::default());
    let mut keep = Keep::default();
    let summary = run(&model, &mut keep).expect("the observer never fails");
    let Outcome::Stopped(failure) = summary.outcome else {
        panic!("not stopped");
    };
    assert_eq!(failure.cause, Cause::Collapsed { segment });
    let last = keep.reports.last().expect("frames");
    assert!(last.time > 0.999 && last.state.u.iter().all(|u| u.is_finite()));
}

/// Wants no more after so many increments, or cutbacks.
#[derive(Default)]
struct Impatient {
    keep: Keep,
    increments: usize,
    cutbacks: usize,
}

impl Observer for Impatient {
    fn increment(&mut self, report: &IncrementReport) -> io::Result<()> {
        self.keep.increment(report)
    }

    fn cutback(&mut self, cutback: &Cutback) -> io::Result<()> {
        self.keep.cutback(cutback)
    }

    fn wants_stop(&self) -> bool {
        let (increments, cutbacks) = (self.keep.reports.len() - 1, self.keep.cutbacks.len());
        increments == self.increments || cutbacks == self.cutbacks
    }
}

#[test]
fn an_observer_ends_the_run_between_increments_and_at_cutbacks() {
    for impact_time in [ImpactTime::Increment, ImpactTime::Event] {
        let (model, _) = squeezed(Settings {
            impact_time,
            ..Settings::default()
        });
        let mut keep = Keep::default();
        run(&model, &mut keep).expect("the observer never fails");
        for (increments, cutbacks) in [(0, 100), (3, 100), (1000, 2)] {
            let mut observer = Impatient {
                increments,
                cutbacks,
                ..Impatient::default()
            };
            let summary = run(&model, &mut observer).expect("the observer never fails");
            assert_eq!(summary.outcome, Outcome::Interrupted);
            let seen = (
                observer.keep.reports.len() - 1,
                observer.keep.cutbacks.len(),
            );
            assert_eq!(seen, (summary.increments, summary.cutbacks));
            assert!(seen.0 == increments || seen.1 == cutbacks, "{seen:?}");
            let mut pairs = keep.reports.iter().zip(&observer.keep.reports);
            assert!(pairs.all(|(all, part)| all.state == part.state));
        }
    }
}
