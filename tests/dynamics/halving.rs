//! Increments that do not converge are halved, as often as necessary.
//!
//! ```text
//!        | | |  pushed down by its upper face
//!     +--+-+-+--+
//!     |         |  a column of Q4, its foot held
//!     +---------+
//! ```

use crate::blocks::{Block, add_block, fixed, model, run_to_end, step};
use stickslip::dynamics::{Cause, Cutback};
use stickslip::model::{Amplitude, Curve, Model, Settings, Support, SupportMotion, TimeBase};

/// A block elsewhere, and a column of 1 x `ny` Q4 whose top goes down by `depth` times an amplitude.
fn pushed(ny: usize, depth: f64, points: &[(f64, f64)]) -> (Model, Block) {
    let mut model = model(1e3, 0.3, 1e-6);
    add_block(&mut model, [9.0, 0.0], [1.0, 1.0], (1, 1), 0.0);
    let height = ny as f64;
    let column = add_block(&mut model, [0.0, 0.0], [1.0, height], (1, ny), 0.0);
    model.amplitudes.push(Amplitude {
        name: "A".into(),
        time: TimeBase::Step,
        curve: Curve::Linear(points.to_vec()),
    });
    let motion = SupportMotion::Amplitude {
        value: -depth,
        amplitude: 0,
    };
    let ends = |j: usize| [column.node(0, j), column.node(1, j)];
    let mut supports: Vec<Support> = ends(0)
        .into_iter()
        .flat_map(|n| [2 * n, 2 * n + 1])
        .map(fixed)
        .collect();
    supports.extend(ends(ny).map(|n| fixed(2 * n)));
    supports.extend(ends(ny).map(|n| Support {
        dof: 2 * n + 1,
        motion,
    }));
    model.steps = vec![step(1.0, 2, Settings::default(), supports)];
    (model, column)
}

/// A subincrement is half as long as one that failed at its start, or as long as its place in the
/// increment allows: what is hard at the start costs no short subincrements later.
#[test]
fn after_halved_subincrements_come_longer_ones_again() {
    let (mut model, _) = pushed(2, 0.4, &[(0.0, 0.0), (0.5, 1.0), (2.0, 1.0)]);
    model.steps[0].settings.max_passes = 6;
    let (keep, summary) = run_to_end(&model);
    let parts = keep.reports[1..].iter().map(|r| (r.time - r.dt, r.dt));
    let parts: Vec<(f64, f64)> = parts.collect();
    println!("{parts:?}");
    let shortest = parts.iter().map(|part| part.1).fold(1.0, f64::min);
    assert!(shortest < 0.2 && summary.cutbacks == keep.cutbacks.len());
    assert_eq!(parts[parts.len() - 2..], [(0.5, 0.5), (1.0, 1.0)]);
    for &(start, dt) in &parts {
        let failed = |c: &Cutback| (c.failure.time, c.failure.dt) == (start, 2.0 * dt);
        let fits = start % (2.0 * dt) == 0.0 && dt < 1.0;
        assert_eq!(keep.cutbacks.iter().any(failed), fits, "{dt} at {start}");
    }
}

/// Beyond its Euler load the straight column is an equilibrium at which K* is indefinite; 1e-5 of its
/// width aside, it buckles.
#[test]
fn a_column_that_buckles_goes_aside() {
    let (mut model, column) = pushed(10, 1.0, &[(0.0, 0.0), (2.0, 1.0)]);
    for j in 1..10 {
        for node in [column.node(0, j), column.node(1, j)] {
            model.mesh.coordinates[node][0] += 1e-5;
        }
    }
    let (keep, _) = run_to_end(&model);
    let last = &keep.reports[keep.reports.len() - 1];
    let aside = last.state.u[2 * column.node(0, 5)];
    assert!(aside.abs() > 1.0, "{aside}");
    assert!(last.energy.balance.abs() < 1e-9 * last.energy.strain);
    let is_indefinite = |c: &Cutback| matches!(c.failure.cause, Cause::Indefinite { .. });
    assert!(!keep.cutbacks.iter().any(is_indefinite));
}
