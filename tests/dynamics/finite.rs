//! Numbers that are not finite: increments with them fail, and the cause says where they are.

use crate::blocks::{Keep, add_block, add_contact, fixed, model, run, settings, step};
use stickslip::dynamics::{Cause, Outcome};
use stickslip::model::{
    Load, Model, PointLoad, Pressure, Scheme, Settings, Support, SupportMotion, TimeBase, Variation,
};

fn run_to_a_stop(model: &Model) -> (Keep, Cause) {
    let mut keep = Keep::default();
    let summary = run(model, &mut keep).expect("the observer never fails");
    let Outcome::Stopped(failure) = summary.outcome else {
        panic!("not stopped");
    };
    (keep, failure.cause)
}

/// A block at rest and one that its supports move along x as an amplitude says, times `speed`.
fn carried(speed: f64, points: &[(f64, f64)]) -> (Model, usize) {
    let mut model = model(1e3, 0.3, 1.0);
    add_block(&mut model, [0.0, 3.0], [1.0, 1.0], (1, 1), 0.0);
    let block = add_block(&mut model, [0.0, 0.0], [1.0, 1.0], (1, 1), 0.0);
    model.amplitudes.push(stickslip::model::Amplitude {
        name: "A".into(),
        time: TimeBase::Total,
        curve: stickslip::model::Curve::Linear(points.to_vec()),
    });
    let motion = SupportMotion::Amplitude {
        value: speed,
        amplitude: 0,
    };
    let along = block.nodes().map(|n| Support { dof: 2 * n, motion });
    let across = block.nodes().map(|n| fixed(2 * n + 1));
    let supports = along.chain(across).collect();
    model.steps = vec![step(0.1, 10, Settings::default(), supports)];
    (model, block.first_node)
}

#[test]
fn a_start_whose_energy_overflows_is_not_reported() {
    let (model, first) = carried(1e200, &[(0.0, 0.0), (1.0, 1.0)]);
    let (keep, cause) = run_to_a_stop(&model);
    assert!(keep.reports.is_empty());
    let Cause::NotFinite { what, node } = cause else {
        panic!("{cause:?}");
    };
    assert!(
        what == "the kinetic energy" && node >= first,
        "{what} {node}"
    );
}

#[test]
fn no_increment_ends_with_an_element_inside_out() {
    // SS22 with both weights 1/2 has its forces halfway, where the element is not
    for theta in [0.5, 0.75, 1.0] {
        let mut model = model(1000.0, 0.3, 1.0);
        let block = add_block(&mut model, [0.0, 0.0], [1.0, 1.0], (1, 1), 0.0);
        let to = |dof: usize| if dof == 5 || dof == 7 { -1.2 } else { 0.0 };
        let supports = (0..8).map(|dof| Support {
            dof,
            motion: SupportMotion::Ramp { to: to(dof) },
        });
        let scheme = Scheme::Ss22 {
            theta1: theta,
            theta2: theta,
        };
        model.steps = vec![step(1.0, 1, settings(scheme), supports.collect())];
        let (keep, cause) = run_to_a_stop(&model);
        assert!(matches!(cause, Cause::Inverted { .. }), "{cause:?}");
        let height = 1.0 + keep.reports.last().unwrap().state.u[2 * block.node(0, 1) + 1];
        assert!(height > 0.0 && height < 0.01, "{height}");
    }
}

#[test]
fn an_increment_whose_energy_overflows_is_not_accepted() {
    let (model, first) = carried(1e200, &[(0.0, 0.0), (0.5, 0.0), (1.0, 1.0)]);
    let (keep, cause) = run_to_a_stop(&model);
    let Cause::NotFinite { what, node } = cause else {
        panic!("{cause:?}");
    };
    assert!(what.contains("energy") && node >= first, "{what} {node}");
    let last = keep.reports.last().expect("the first half");
    assert!((last.time - 0.4).abs() < 0.11);
    for report in &keep.reports {
        let energy = report.energy;
        assert!(energy.balance.is_finite() && energy.kinetic.is_finite());
        assert!(report.state.v.iter().all(|v| v.is_finite()));
    }
}

#[test]
fn passes_that_diverge_are_no_failure_of_the_linear_solver() {
    // blown up by a pressure that no stress balances at once, each pass overshoots to the third
    // power; a huge force turns the elements inside out in the first pass
    for pressure in [0.0, -1e20] {
        let mut model = model(1.0, 0.3, 1.0);
        let block = add_block(&mut model, [0.0, 0.0], [1.0, 1.0], (1, 1), 0.0);
        let mut blown = step(1e3, 1, Settings::default(), Vec::new());
        let faces = (0..4).flat_map(|side| block.faces(side));
        let blow = |face| Load {
            at: Pressure {
                face,
                is_shear: false,
            },
            magnitude: pressure,
            variation: Variation::Constant,
        };
        blown.pressures = faces.map(blow).collect();
        if pressure == 0.0 {
            blown.point_loads = vec![Load {
                at: PointLoad { dof: 3 },
                magnitude: 1e300,
                variation: Variation::Constant,
            }];
        }
        model.steps = vec![blown];
        let (keep, last) = run_to_a_stop(&model);
        let causes = keep.cutbacks.iter().map(|c| &c.failure.cause);
        let causes: Vec<&Cause> = causes.chain([&last]).collect();
        assert!(causes.iter().all(|c| **c == Cause::Diverged), "{causes:?}");
        assert_eq!(last.to_string(), "the passes diverged");
    }
}

#[test]
fn a_matrix_that_overflows_is_a_failure_of_the_linear_solver() {
    let mut model = model(1e308, 0.3, 1.0);
    add_block(&mut model, [0.0, 0.0], [1.0, 1.0], (1, 1), 0.0);
    model.initial_velocity[0] = 1e-9;
    model.sections[0].thickness = 1e3;
    model.steps = vec![step(1e-3, 1, Settings::default(), Vec::new())];
    let (_, cause) = run_to_a_stop(&model);
    assert!(matches!(cause, Cause::LinearSolver(_)), "{cause:?}");
}

#[test]
fn two_prescribed_bodies_that_are_driven_into_each_other() {
    for below_moves in [false, true] {
        let mut model = model(1e3, 0.3, 1.0);
        let below = add_block(&mut model, [0.0, 0.0], [2.0, 1.0], (2, 1), 0.0);
        let above = add_block(&mut model, [0.5, 1.2], [1.0, 1.0], (1, 1), 0.0);
        add_contact(&mut model, above.faces(0), below.faces(2), 0.0);
        let down = SupportMotion::Ramp { to: -0.5 };
        let mut supports: Vec<Support> = below
            .nodes()
            .filter(|&n| !below_moves || n < below.node(0, 1))
            .flat_map(|n| [2 * n, 2 * n + 1])
            .chain(above.nodes().map(|n| 2 * n))
            .map(fixed)
            .collect();
        supports.extend(above.nodes().map(|n| Support {
            dof: 2 * n + 1,
            motion: down,
        }));
        model.steps = vec![step(0.1, 10, Settings::default(), supports)];
        if below_moves {
            crate::blocks::run_to_end(&model);
            continue;
        }
        let (keep, cause) = run_to_a_stop(&model);
        let Cause::Crossed { prescribed, .. } = cause else {
            panic!("{cause:?}");
        };
        assert!(prescribed);
        assert!(keep.reports.last().expect("the way down").time > 0.39);
    }
}
