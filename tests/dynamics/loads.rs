//! Loads and supports with closed forms, and the ledger that must close with them.

use stickslip::dynamics::{IncrementReport, Outcome};
use stickslip::model::{
    Amplitude, Curve, Load, Model, Pressure, Rate, Scheme, Settings, Support, SupportMotion,
    TimeBase, Traction, Variation,
};

use crate::blocks::{
    Block, SCHEMES, add_block, add_contact, fixed, gravity, model, run_to_end, settings, step,
};
use crate::energies::{energy, largest};

/// A free block 2 x 1 of mass 2.
fn free_block() -> (Model, Block) {
    let mut model = model(1000.0, 0.3, 1.0);
    let block = add_block(&mut model, [0.0, 0.0], [2.0, 1.0], (4, 2), 0.0);
    (model, block)
}

fn balance_closes(reports: &[IncrementReport]) {
    let energy = largest(reports, energy);
    let balance = largest(reports, |r| r.energy.balance.abs());
    assert!(balance < 1e-9 * energy, "{balance:e} of {energy:e}");
}

#[test]
fn gravity_and_dead_traction_give_the_momentum_of_their_resultant() {
    for scheme in SCHEMES {
        let (mut model, block) = free_block();
        let mut step = step(0.01, 50, settings(scheme), Vec::new());
        step.body_forces = (0..8).map(|element| gravity(element, 9.81)).collect();
        step.tractions = block
            .faces(1)
            .into_iter()
            .map(|face| Load {
                at: Traction {
                    face,
                    direction: [1.0, 0.0],
                },
                magnitude: 3.0,
                variation: Variation::Ramp { from: 1.0 },
            })
            .collect();
        model.steps = vec![step];
        let (keep, _) = run_to_end(&model);
        let last = keep.reports.last().unwrap();
        // m g t = 2 9.81 0.5; int (1 + 2 t/T) dt over T = 0.5 is 1 (theta = 1 takes the end value)
        assert!((last.momentum.linear[1] + 9.81).abs() < 1e-10);
        let expected = match scheme {
            Scheme::EnergyMomentum => 1.0,
            Scheme::Ss22 { .. } => 1.0 + 0.01,
        };
        assert!((last.momentum.linear[0] - expected).abs() < 1e-10);
        balance_closes(&keep.reports);
    }
}

/// The first pass finds where a falling block is, and its forces then balance: that an iterate that has just moved by
/// as much as the increment is the solution, a second pass shows.
#[test]
fn increments_end_after_a_small_correction() {
    for scheme in SCHEMES {
        let (mut model, _) = free_block();
        let mut step = step(0.05, 10, settings(scheme), Vec::new());
        step.body_forces = (0..8).map(|element| gravity(element, 9.81)).collect();
        model.steps = vec![step];
        let (keep, _) = run_to_end(&model);
        for report in &keep.reports[1..] {
            let corrections: Vec<f64> = report.passes.iter().map(|p| p.correction).collect();
            let last = corrections[corrections.len() - 1];
            assert!(corrections[0] > 1e-2 && last < 1e-4, "{corrections:?}");
        }
    }
}

#[test]
fn pressure_all_around_has_no_resultant_and_follows_the_surface() {
    for scheme in SCHEMES {
        let (mut model, block) = free_block();
        let mut step = step(0.01, 50, settings(scheme), Vec::new());
        let faces = (0..4).flat_map(|side| block.faces(side));
        step.pressures = faces
            .map(|face| Load {
                at: Pressure {
                    face,
                    is_shear: false,
                },
                magnitude: 40.0,
                variation: Variation::Constant,
            })
            .collect();
        model.steps = vec![step];
        let (keep, _) = run_to_end(&model);
        let last = keep.reports.last().unwrap();
        assert!(last.momentum.linear[0].abs() < 1e-11 && last.momentum.linear[1].abs() < 1e-11);
        assert!(last.momentum.angular.abs() < 1e-11);
        // It pushes inwards: the block is compressed, by work done on it.
        assert!(last.energy.external_work > 0.0 && last.energy.strain > 0.0);
        let width = 2.0 + last.state.u[2 * block.node(4, 1)] - last.state.u[2 * block.node(0, 1)];
        assert!(width < 2.0);
        balance_closes(&keep.reports);
    }
}

#[test]
fn shear_all_around_spins_a_block_and_has_no_resultant() {
    for scheme in SCHEMES {
        let (mut model, block) = free_block();
        let mut step = step(0.01, 50, settings(scheme), Vec::new());
        let faces = (0..4).flat_map(|side| block.faces(side));
        let shear = |face| Load {
            at: Pressure {
                face,
                is_shear: true,
            },
            magnitude: 40.0,
            variation: Variation::Constant,
        };
        step.pressures = faces.map(shear).collect();
        model.steps = vec![step];
        let (keep, _) = run_to_end(&model);
        let last = keep.reports.last().unwrap();
        assert!(last.momentum.linear[0].abs() < 1e-11 && last.momentum.linear[1].abs() < 1e-11);
        // counter-clockwise, as faces run from corner to corner
        assert!(last.momentum.angular > 0.1, "{}", last.momentum.angular);
        assert!(last.energy.external_work > 0.0);
        balance_closes(&keep.reports);
    }
}

#[test]
fn pressure_acts_on_the_face_as_it_is_now() {
    for scheme in SCHEMES {
        let (mut model, block) = free_block();
        // all nodes go straight to where a quarter turn takes them
        let moved = |node: usize| {
            let [x, y] = model.mesh.coordinates[node];
            [(2 * node, -y - x), (2 * node + 1, x - y)]
        };
        let supports = block.nodes().flat_map(moved).map(|(dof, to)| Support {
            dof,
            motion: SupportMotion::Ramp { to },
        });
        let mut step = step(0.01, 20, settings(scheme), supports.collect());
        let pressure = |face| Load {
            at: Pressure {
                face,
                is_shear: false,
            },
            magnitude: 40.0,
            variation: Variation::Constant,
        };
        step.pressures = block.faces(1).into_iter().map(pressure).collect();
        model.steps = vec![step];
        let (keep, _) = run_to_end(&model);
        // the supports of constant velocity hold the pressure alone: p t (e_y, -e_x), e along the right side
        let reaction = |report: &IncrementReport| {
            let of = |i: usize| {
                block
                    .nodes()
                    .map(|n| report.nodal.reaction[2 * n + i])
                    .sum()
            };
            let force: [f64; 2] = [of(0), of(1)];
            force
        };
        for pair in keep.reports[1..].windows(2) {
            let [before, now] = pair else { unreachable!() };
            let x = |node: usize, i: usize| {
                let [u0, u1] = [before, now].map(|report| report.state.u[2 * node + i]);
                let u = match scheme {
                    Scheme::EnergyMomentum => (u0 + u1) / 2.0,
                    Scheme::Ss22 { .. } => u1,
                };
                model.mesh.coordinates[node][i] + u
            };
            let e = [0, 1].map(|i| x(block.node(4, 2), i) - x(block.node(4, 0), i));
            let [fx, fy] = reaction(now);
            let off = (fx - 40.0 * e[1]).hypot(fy + 40.0 * e[0]);
            assert!(off < 1e-8, "{off:e}");
        }
        // at the end the right side is the upper one; half an increment before it in the default scheme
        let [fx, fy] = reaction(keep.reports.last().unwrap());
        assert!((fy - 40.0).abs() < 1.5 && fx.abs() < 1.5, "{fx} {fy}");
    }
}

#[test]
fn a_dead_traction_does_not_follow_the_face() {
    for scheme in SCHEMES {
        let (mut model, block) = free_block();
        // stretched to twice its height, which changes neither the force of the traction nor its direction
        let moved = |node: usize| {
            let [_, y] = model.mesh.coordinates[node];
            [(2 * node, 0.5 * y), (2 * node + 1, y)]
        };
        let supports = block.nodes().flat_map(moved).map(|(dof, to)| Support {
            dof,
            motion: SupportMotion::Ramp { to },
        });
        let mut step = step(0.01, 20, settings(scheme), supports.collect());
        let traction = |face| Load {
            at: Traction {
                face,
                direction: [0.6, 0.8],
            },
            magnitude: 30.0,
            variation: Variation::Constant,
        };
        step.tractions = block.faces(1).into_iter().map(traction).collect();
        model.steps = vec![step];
        let (keep, _) = run_to_end(&model);
        for report in &keep.reports[2..] {
            let of = |i: usize| {
                block
                    .nodes()
                    .map(|n| report.nodal.reaction[2 * n + i])
                    .sum()
            };
            let [fx, fy]: [f64; 2] = [of(0), of(1)];
            assert!((fx + 18.0).hypot(fy + 24.0) < 1e-8, "{fx} {fy}");
        }
    }
}

#[test]
fn a_shaken_support_moves_as_its_amplitude_says() {
    for scheme in SCHEMES {
        let (mut model, block) = free_block();
        model.amplitudes = vec![Amplitude {
            name: "SHAKE".into(),
            time: TimeBase::Step,
            curve: Curve::Linear(vec![(0.0, 0.0), (0.2, 1.0), (0.4, -1.0), (0.6, 0.0)]),
        }];
        let mut supports: Vec<Support> = Vec::new();
        for j in 0..=2 {
            let dof = 2 * block.node(0, j);
            let motion = SupportMotion::Amplitude {
                value: 0.1,
                amplitude: 0,
            };
            supports.extend([Support { dof, motion }, fixed(dof + 1)]);
        }
        model.steps = vec![step(0.01, 60, settings(scheme), supports)];
        let (keep, _) = run_to_end(&model);
        let dof = 2 * block.node(0, 1);
        let at = |k: usize| (keep.reports[k].state.u[dof], keep.reports[k].state.v[dof]);
        for (k, u, v) in [
            (10, 0.05, 0.5),
            (20, 0.1, 0.5),
            (30, 0.0, -1.0),
            (60, 0.0, 0.5),
        ] {
            assert!(
                (at(k).0 - u).abs() < 1e-15 && (at(k).1 - v).abs() < 1e-14,
                "{k}: {:?}",
                at(k)
            );
        }
        assert!(keep.reports.last().unwrap().energy.external_work > 0.0);
        balance_closes(&keep.reports);
        // Newton: the impulse of the reactions is the change of momentum, but for the supports'
        // own.
        let last = keep.reports.last().unwrap();
        assert!(
            last.nodal.reaction[dof] != 0.0 && last.nodal.reaction[2 * block.node(4, 1)] == 0.0
        );
    }
}

#[test]
fn a_body_whose_nodes_are_all_supported_costs_no_unknowns() {
    let (mut model, block) = free_block();
    let supports = block
        .nodes()
        .flat_map(|n| [fixed(2 * n), fixed(2 * n + 1)])
        .collect();
    model.steps = vec![step(0.01, 3, Settings::default(), supports)];
    let (keep, summary) = run_to_end(&model);
    assert_eq!(
        (keep.reports.len(), summary.outcome),
        (4, Outcome::Finished)
    );
}

/// A block pressed on another by gravity, both orders of the two surfaces as pairs.
#[test]
fn both_orders_of_two_surfaces_carry_the_weight_together() {
    for scheme in SCHEMES {
        let mut model = model(1e4, 0.3, 1.0);
        let base = add_block(&mut model, [-1.0, -1.0], [4.0, 1.0], (8, 2), 0.0);
        let block = add_block(&mut model, [0.0, 0.0], [2.0, 1.0], (4, 2), 0.0);
        let (lower, upper) = (block.faces(0), base.faces(2));
        add_contact(&mut model, lower.clone(), upper.clone(), 0.3);
        add_contact(&mut model, upper, lower, 0.3);
        let supports = (0..=8)
            .flat_map(|i| [fixed(2 * base.node(i, 0)), fixed(2 * base.node(i, 0) + 1)])
            .collect();
        let mut step = step(0.01, 100, settings(scheme), supports);
        step.body_forces = (16..24).map(|element| gravity(element, 10.0)).collect();
        model.steps = vec![step];
        let (keep, summary) = run_to_end(&model);
        println!("{scheme:?} {summary:?}");
        assert_eq!(keep.cutbacks.len(), 0);
        let mean: f64 = keep.reports[50..]
            .iter()
            .map(|r| r.contacts[0].force[1] - r.contacts[1].force[1])
            .sum::<f64>()
            / 51.0;
        assert!((mean - 20.0).abs() < 1.0, "the weight is 20: {mean}");
        let gap = keep
            .reports
            .iter()
            .flat_map(|r| &r.contacts)
            .map(|c| c.min_gap);
        assert!(gap.fold(f64::INFINITY, f64::min) > -1e-9 * 0.5);
        balance_closes(&keep.reports);
    }
}

#[test]
fn a_ramped_support_moves_with_the_velocity_of_its_ramp() {
    for scheme in SCHEMES {
        let (mut model, block) = free_block();
        let held = |to: f64| -> Vec<Support> {
            let motion = SupportMotion::Ramp { to };
            let along = block.nodes().map(|n| Support { dof: 2 * n, motion });
            let across = block.nodes().map(|n| fixed(2 * n + 1));
            along.chain(across).collect()
        };
        // to 0.3 within 0.6, then back to 0.1 within 0.4: the mass 2 with the velocities 0.5 and
        // -0.5
        model.steps = vec![
            step(0.1, 6, settings(scheme), held(0.3)),
            step(0.05, 8, settings(scheme), held(0.1)),
        ];
        let (keep, _) = run_to_end(&model);
        for report in &keep.reports {
            let (v, u) = match report.time {
                t if t < 0.6 + 1e-9 => (0.5, 0.5 * t),
                t => (-0.5, 0.6 - 0.5 * t),
            };
            for node in block.nodes() {
                assert!((report.state.v[2 * node] - v).abs() < 1e-14);
                assert!((report.state.u[2 * node] - u).abs() < 1e-14);
            }
            assert!((report.energy.kinetic - 0.25).abs() < 1e-14);
        }
        balance_closes(&keep.reports);
    }
}

#[test]
fn prescribed_rates_are_integrated_from_the_start_of_the_step() {
    for scheme in SCHEMES {
        let (mut model, block) = free_block();
        model.amplitudes = vec![Amplitude {
            name: "GROW".into(),
            time: TimeBase::Total,
            curve: Curve::Linear(vec![(0.0, 0.0), (0.4, 2.0)]),
        }];
        let held = |rate, value, amplitude| -> Vec<Support> {
            let motion = SupportMotion::Rate {
                rate,
                value,
                amplitude,
            };
            let along = block.nodes().map(|n| Support { dof: 2 * n, motion });
            let across = block.nodes().map(|n| fixed(2 * n + 1));
            along.chain(across).collect()
        };
        model.steps = vec![
            step(0.1, 6, settings(scheme), held(Rate::Velocity, 0.5, Some(0))),
            step(
                0.05,
                8,
                settings(scheme),
                held(Rate::Acceleration, -1.25, None),
            ),
            step(0.05, 8, settings(scheme), held(Rate::Velocity, 0.0, None)),
        ];
        let (keep, _) = run_to_end(&model);
        for report in &keep.reports {
            // 2.5 t up to 0.4, then 1; from 0.6 on 1 - 1.25 s, and 0 from 1.0 on
            let s = report.step_time;
            let (v, u) = match (report.step, report.time) {
                (1, t) if t < 0.4 + 1e-9 => (2.5 * t, 1.25 * t * t),
                (1, t) => (1.0, 0.2 + t - 0.4),
                (2, _) => (1.0 - 1.25 * s, 0.4 + s - 0.625 * s * s),
                _ => (0.0, 0.7),
            };
            for node in block.nodes() {
                let (du, dv) = (report.state.u[2 * node] - u, report.state.v[2 * node] - v);
                assert!(du.abs().max(dv.abs()) < 1e-14, "{} {du} {dv}", report.time);
            }
        }
        balance_closes(&keep.reports);
    }
}
