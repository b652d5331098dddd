//! Accounts of bodies and contacts against the ledger, the momenta and closed forms.

use stickslip::dynamics::{ContactOnBody, Energy, IncrementReport, NodeStatus, SolverCounts};
use stickslip::model::{
    Bodies, Contact, LandingRule, LcpMethod, Model, Scheme, Settings, Support, SupportMotion,
    SurfaceKind,
};

use stickslip::vectors::cross;

use crate::blocks::{add_block, add_contact, fixed, model, run_to_end, step, throw};
use crate::energies::{energy, largest};
use crate::friction::block_on_base;
use crate::invariants::oblique_impact;

const SS22: Scheme = Scheme::Ss22 {
    theta1: 0.5,
    theta2: 0.5,
};

/// `a` and `b` agree to round-off of `scale`.
pub fn near(a: f64, b: f64, scale: f64) {
    assert!((a - b).abs() <= 1e-12 * scale, "{a:e} is not {b:e}");
}

/// Masses of the beams of [`oblique_impact`].
pub const MASSES: [f64; 2] = [3.2, 2.4];

#[test]
fn bodies_start_as_they_are_thrown() {
    let model = oblique_impact(0.3, Scheme::EnergyMomentum);
    let mut first = model.clone();
    first.steps[0].increments.period = first.steps[0].increments.dt;
    let (kept, _) = run_to_end(&first);
    let [lower, upper] = [&kept.reports[0].bodies[0], &kept.reports[0].bodies[1]];
    near(lower.center[0], 2.0, 1.0);
    near(lower.center[1], 0.4, 1.0);
    near(lower.velocity[0], 0.3, 1.0);
    near(lower.velocity[1], 0.5, 1.0);
    near(lower.angular_velocity, 0.05, 1.0);
    // its corner at (0.7, 1), 3 x 0.8, turned by 0.1; thrown about (2.2, 1.5)
    let (sin, cos) = 0.1_f64.sin_cos();
    let center = [0.7 + 1.5 * cos - 0.4 * sin, 1.0 + 1.5 * sin + 0.4 * cos];
    for (value, expected) in upper.center.iter().zip(center) {
        near(*value, expected, 1.0);
    }
    near(upper.angular_velocity, -0.2, 1.0);
    near(upper.velocity[0], -0.8 + 0.2 * (center[1] - 1.5), 1.0);
    near(upper.velocity[1], -1.5 - 0.2 * (center[0] - 2.2), 1.0);
}

#[test]
fn bodies_and_contacts_add_up_to_the_ledger() {
    for scheme in [Scheme::EnergyMomentum, SS22] {
        let (kept, _) = run_to_end(&oblique_impact(0.3, scheme));
        let scale = largest(&kept.reports, energy);
        for report in &kept.reports {
            let sum = |f: fn(&stickslip::dynamics::BodyResult) -> f64| -> f64 {
                report.bodies.iter().map(f).sum()
            };
            near(sum(|b| b.kinetic), report.energy.kinetic, scale);
            near(sum(|b| b.strain), report.energy.strain, scale);
            for i in 0..2 {
                let momenta = report.bodies.iter().zip(MASSES);
                let momentum: f64 = momenta.map(|(body, mass)| mass * body.velocity[i]).sum();
                near(momentum, report.momentum.linear[i], 10.0);
            }
            let contact = &report.contacts[0];
            near(
                contact.normal_work,
                report.energy.normal_contact_work,
                scale,
            );
            let dissipation = report.energy.friction_dissipation;
            near(contact.friction_dissipation, dissipation, scale);
        }
        let last = kept.reports.last().expect("reports");
        assert!(last.energy.friction_dissipation > 1e-3 * scale);
        assert!(last.energy.normal_contact_work.abs() > 1e-4 * scale);
    }
}

/// The impulse of the contact on the upper beam since the start is its change of momentum, linear
/// and about its centre.
#[test]
fn impulses_are_the_change_of_momentum() {
    let (kept, _) = run_to_end(&oblique_impact(0.3, Scheme::EnergyMomentum));
    let start = kept.reports[0].bodies[1];
    let (mut vector, mut normal, mut impacts, mut forces) = ([0.0; 2], 0.0, 0.0, 0.0);
    for report in &kept.reports {
        let (body, contact) = (&report.bodies[1], &report.contacts[0]);
        let impulse = contact.impulse;
        for (i, sum) in vector.iter_mut().enumerate() {
            let change = MASSES[1] * (body.velocity[i] - start.velocity[i]);
            near(contact.impulse_sum.vector[i], change, 100.0);
            near(body.contact_force[i], contact.force[i], 1e3);
            *sum += impulse.vector[i];
            near(*sum, contact.impulse_sum.vector[i], 10.0);
        }
        normal += impulse.normal;
        impacts += impulse.impact_normal;
        forces += report.dt * contact.normal;
        near(normal, contact.impulse_sum.normal, 10.0);
        near(impacts + forces, normal, 10.0);
        assert!(impulse.tangential.abs() <= 0.3 * impulse.normal * (1.0 + 1e-9) + 1e-12);
    }
    assert!(impacts > 0.01 * normal && forces > 0.01 * normal);
}

/// The beams of [`oblique_impact`] in general contact.
pub fn all_exterior() -> Model {
    let mut model = oblique_impact(0.3, Scheme::EnergyMomentum);
    let faces = model.mesh.exterior_faces();
    model.surfaces[0].kind = SurfaceKind::Faces(faces);
    model.contacts = vec![Contact {
        slave: 0,
        master: 0,
        ..model.contacts[0].clone()
    }];
    model.steps[0].increments.period = 100.0 * model.steps[0].increments.dt;
    model
}

#[test]
fn general_contact_has_a_resultant_for_every_body_and_they_cancel() {
    let (kept, _) = run_to_end(&all_exterior());
    let on_bodies = |r: &IncrementReport| r.contacts[0].bodies.clone();
    let size = |body: &ContactOnBody| body.force[0].hypot(body.force[1]);
    let all = kept.reports.iter().flat_map(on_bodies);
    let scale = all.map(|body| size(&body)).fold(0.0, f64::max);
    assert!(scale > 0.0);
    for report in &kept.reports {
        let [lower, upper] = report.contacts[0].bodies[..] else {
            panic!("two bodies")
        };
        for i in 0..2 {
            near(lower.force[i], -upper.force[i], scale);
            near(report.bodies[0].contact_force[i], lower.force[i], scale);
        }
        near(lower.moment, -upper.moment, 10.0 * scale);
    }
    // the momentum that the upper beam gains in an increment without impact
    let pair = kept.reports.windows(2).find(|pair| {
        let impulse = pair[1].contacts[0].impulse;
        impulse.normal > 0.0 && impulse.impact_normal == 0.0
    });
    let [before, after] = pair.expect("an increment with contact") else {
        unreachable!("windows of two")
    };
    let change = after.bodies[1].velocity[1] - before.bodies[1].velocity[1];
    let force = after.contacts[0].bodies[1].force[1];
    near(MASSES[1] * change, after.dt * force, 1.0);
    // and its angular momentum, about the centre of mass: less x cross m v
    let spin = |report: &IncrementReport| {
        let momenta = report.bodies.iter().zip(MASSES);
        let orbits = momenta.map(|(b, mass)| mass * cross(b.center, b.velocity));
        report.momentum.angular - orbits.sum::<f64>()
    };
    let moments = after.bodies.iter().map(|body| body.contact_moment);
    near(
        spin(after) - spin(before),
        after.dt * moments.sum::<f64>(),
        10.0,
    );
}

/// A block slides without friction on its base, pressed on by its weight, grown to 10 x 0.5 per
/// length.
#[test]
fn pressure_is_uniform_below_a_flat_block_and_slip_is_the_way() {
    let slave_sides: [&[usize]; 2] = [&[0], &[0, 1, 2, 3]];
    for sides in slave_sides {
        let (mut model, block) = block_on_base(0.0, [0.1, -1.0], Scheme::EnergyMomentum);
        model.sections[0].thickness = 0.5;
        let faces = sides.iter().flat_map(|&side| block.faces(side)).collect();
        model.surfaces[0].kind = SurfaceKind::Faces(faces);
        check_pressure_and_slip(&model, sides.len() > 1);
    }
    // a surface of nodes takes the exterior faces of the block
    let (mut model, block) = block_on_base(0.0, [0.1, -1.0], Scheme::EnergyMomentum);
    let nodes = (0..=block.nx).map(|i| block.node(i, 0)).collect();
    model.surfaces[0].kind = SurfaceKind::Nodes(nodes);
    check_pressure_and_slip(&model, false);
}

fn check_pressure_and_slip(model: &Model, all_nodes: bool) {
    let (kept, _) = run_to_end(model);
    let bottom = |node: usize| model.mesh.coordinates[node][1] == 0.0 && node > 17;
    let nodes = model.mesh.node_count();
    let mut slid = vec![0.0; nodes];
    for pair in kept.reports.windows(2) {
        let (before, after) = (&pair[0], &pair[1]);
        let nodal = &after.nodal;
        for (node, slid) in slid.iter_mut().enumerate() {
            if nodal.status[node] >= NodeStatus::Stick {
                *slid += (after.state.u[2 * node] - before.state.u[2 * node]).abs();
            }
            if bottom(node) {
                near(nodal.slip[node], *slid, 1.0);
                // all of the block lies on its bottom
                let thickness = model.sections[0].thickness;
                let mean = after.contacts[0].normal / (4.0 * thickness);
                assert!((nodal.pressure[node] - mean).abs() < 1e-7 * 5.0);
            } else {
                assert!(all_nodes || nodal.slip[node].is_nan());
                assert_eq!(nodal.slip[node].is_nan(), nodal.pressure[node].is_nan());
                assert!(nodal.pressure[node].is_nan() || nodal.pressure[node] == 0.0);
            }
        }
    }
    let last = kept.reports.last().expect("reports");
    let node = (0..nodes).find(|&node| bottom(node)).expect("a node");
    assert!((last.nodal.pressure[node] - 5.0).abs() < 0.25, "the weight");
    assert!(last.nodal.slip[node] > 0.1, "{}", last.nodal.slip[node]);
}

/// A concentrated load is reported at the middle of the increment, where it acts.
#[test]
fn concentrated_loads_are_those_of_the_increment() {
    use stickslip::model::{Load, PointLoad, Variation};
    let (mut model, block) = block_on_base(0.3, [0.0, -1.0], Scheme::EnergyMomentum);
    let dof = 2 * block.node(3, 1) + 1;
    let period = model.steps[0].increments.period;
    model.steps[0].point_loads = vec![Load {
        at: PointLoad { dof },
        magnitude: -4.0,
        variation: Variation::Ramp { from: 0.0 },
    }];
    let held = 2 * block.node(3, 1);
    model.steps[0].supports.push(fixed(held));
    model.steps[0].increments.dt = period / 20.0;
    let (kept, _) = run_to_end(&model);
    for (k, report) in kept.reports.iter().enumerate().skip(1) {
        let load = &report.nodal.concentrated;
        near(load[dof], -4.0 * (k as f64 - 0.5) / 20.0, 1.0);
        assert_eq!(load.iter().filter(|&&f| f != 0.0).count(), 1);
    }
    assert!(kept.reports[0].nodal.concentrated.iter().all(|&f| f == 0.0));
    assert_eq!(Bodies::new(&model.mesh).count, kept.reports[0].bodies.len());
}

/// Totals of a run are the sums over its increments, and the largest of problems and residuals.
#[test]
fn the_work_of_a_run_is_that_of_its_increments() {
    for lcp in [LcpMethod::Hybrid, LcpMethod::Lemke] {
        let mut model = oblique_impact(0.3, SS22);
        model.steps[0].settings.lcp = lcp;
        let (kept, summary) = run_to_end(&model);
        let total = summary.solver;
        let all = || kept.reports.iter().map(|report| report.solver);
        let sum = |f: fn(SolverCounts) -> usize| all().map(f).sum::<usize>();
        assert!(total.converged && all().all(|counts| counts.converged));
        assert_eq!(total.passes, sum(|s| s.passes));
        assert_eq!(total.lcps, sum(|s| s.lcps));
        assert_eq!(total.pivots, sum(|s| s.pivots));
        assert_eq!(
            total.active_set_iterations,
            sum(|s| s.active_set_iterations)
        );
        assert_eq!(total.gauss_seidel_sweeps, sum(|s| s.gauss_seidel_sweeps));
        assert_eq!(total.lemke_calls, sum(|s| s.lemke_calls));
        assert_eq!(total.factorizations, sum(|s| s.factorizations));
        assert_eq!(Some(total.lcp_size), all().map(|s| s.lcp_size).max());
        let residual = all().map(|s| s.residual).fold(0.0, f64::max);
        assert_eq!(total.residual, residual);
    }
}

/// Without a node near the other surface there is no smallest gap, at the start or later; it is
/// that of the nearest node as soon as one is near.
#[test]
fn the_smallest_gap_is_that_of_the_nearest_node_or_unknown() {
    let mut model = model(1e3, 0.3, 1.0);
    let plate = add_block(&mut model, [0.0, 0.0], [2.0, 0.5], (2, 1), 0.0);
    let near = add_block(&mut model, [0.5, 0.7], [1.0, 0.5], (2, 1), 0.0);
    let far = add_block(&mut model, [0.5, 50.0], [1.0, 0.5], (2, 1), 0.0);
    throw(&mut model, &near, [0.0, -0.1], 0.0, [0.0; 2]);
    for block in [near, far] {
        add_contact(&mut model, block.faces(0), plate.faces(2), 0.0);
    }
    model.steps = vec![step(0.1, 10, Settings::default(), Vec::new())];
    let (kept, _) = run_to_end(&model);
    for report in &kept.reports {
        let [near, far] = [0, 1].map(|i| report.contacts[i].min_gap);
        let expected = 0.2 - 0.1 * report.time;
        assert!(far.is_nan() && (near.is_nan() || (near - expected).abs() < 1e-12));
    }
    assert!(kept.reports[0].contacts[0].min_gap.is_nan());
    assert!(kept.reports[10].contacts[0].min_gap > 0.0);
}

/// A block that falls askew on a plate with a supported bottom, all of which moves with the velocity `c`.
fn landing_in_frame(c: [f64; 2], settings: Settings) -> Model {
    let mut model = model(1e3, 0.3, 1.0);
    let plate = add_block(&mut model, [-1.0, -1.0], [4.0, 1.0], (8, 4), 0.0);
    let block = add_block(&mut model, [0.0, 0.03], [2.0, 1.0], (6, 5), 0.03);
    throw(&mut model, &plate, c, 0.0, [0.0; 2]);
    throw(&mut model, &block, [c[0] + 0.4, c[1] - 2.0], 0.0, [0.0; 2]);
    add_contact(&mut model, block.faces(0), plate.faces(2), 0.3);
    let (dt, count) = (0.005, 60);
    let support = |dof: usize| Support {
        dof,
        motion: SupportMotion::Ramp {
            to: c[dof % 2] * dt * count as f64,
        },
    };
    let bottom = (0..=plate.nx).map(|i| plate.node(i, 0));
    let dofs = bottom.flat_map(|node| [2 * node, 2 * node + 1]);
    model.steps = vec![step(dt, count, settings, dofs.map(support).collect())];
    model
}

/// Whatever the velocity with which everything moves, landings, impulses, friction and scheme take the same:
/// what supports do to keep their velocity is external work.
#[test]
fn losses_do_not_depend_on_the_frame() {
    let returned = Settings {
        landing: LandingRule::Return,
        ..Settings::default()
    };
    for settings in [Settings::default(), returned] {
        let runs = [[0.0, 0.0], [10.0, 7.0], [-3.0, 40.0]].map(|c| {
            let (kept, _) = run_to_end(&landing_in_frame(c, settings));
            kept
        });
        let scale = largest(&runs[0].reports, energy);
        let last = runs[0].reports.last().expect("reports").energy;
        let lost = last.impact_loss - last.normal_contact_work + last.release_loss;
        assert!(lost > 1e-2 * scale, "{last:?}");
        for moving in &runs[1..] {
            assert_eq!(moving.reports.len(), runs[0].reports.len());
            for (still, moving) in runs[0].reports.iter().zip(&moving.reports) {
                let losses = |e: &Energy| {
                    [
                        e.strain,
                        e.normal_contact_work,
                        e.friction_dissipation,
                        e.impact_loss,
                        e.landing_return,
                        e.release_loss,
                        e.numerical_dissipation,
                        e.balance,
                    ]
                };
                let both = losses(&still.energy)
                    .into_iter()
                    .zip(losses(&moving.energy));
                for (k, (a, b)) in both.enumerate() {
                    let what = (settings.landing, settings.contact_mass, k, still.time);
                    assert!((a - b).abs() < 1e-9 * scale, "{what:?}: {a} {b}");
                }
            }
        }
    }
}
