//! A face of an element that is squeezed to a point: the run stops, and says where.

use crate::blocks::{Keep, add_block, add_contact, fixed, model, step};
use stickslip::dynamics::{Cause, Outcome, run};
use stickslip::model::{Settings, Support, SupportMotion};

#[test]
fn a_segment_without_length_stops_the_run() {
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
    model.steps = vec![step(0.1, 10, Settings::default(), supports)];

    let mut keep = Keep::default();
    let summary = run(&model, &mut keep).expect("the observer never fails");
    let Outcome::Stopped(failure) = summary.outcome else {
        panic!("not stopped");
    };
    let segment = [held, moved];
    assert_eq!(failure.cause, Cause::Collapsed { segment });
    let last = keep.reports.last().expect("frames");
    assert!(last.time > 0.999 && last.state.u.iter().all(|u| u.is_finite()));
}
