//! Damping of materials: ratios of modes, energy, momenta, and the passes.

use crate::blocks::{
    Keep, PAPER, SCHEMES, add_block, add_contact, model, run_to_end, settings, step, stretch, throw,
};
use crate::energies::{energy, largest};
use stickslip::dynamics::IncrementReport;
use stickslip::materials::{Law, NeoHooke};
use stickslip::model::{
    ContactMass, Damping, ElementType, Formulation, LandingRule, Model, Scheme, Settings, Support,
    SupportMotion,
};

fn last(keep: &Keep) -> &IncrementReport {
    &keep.reports[keep.reports.len() - 1]
}

/// Speed at the end of the one-element bar at the start, so small that its strains are linear.
const SPEED: f64 = 1e-7;

/// A bar of one element of side 1 that is held at its left end and across, and is thrown along itself:
/// one mode with omega² = 3 E/rho = 1.
fn one_mode(scheme: Scheme, damping: Damping, dt: f64, increments: usize) -> Keep {
    let mut model = model(1.0, 0.0, 3.0);
    model.materials[0].damping = damping;
    let bar = add_block(&mut model, [0.0, 0.0], [1.0, 1.0], (1, 1), 0.0);
    let fixed = |dof: usize| Support {
        dof,
        motion: SupportMotion::Ramp { to: 0.0 },
    };
    let mut supports: Vec<Support> = Vec::new();
    for node in bar.nodes() {
        let is_held = node == bar.node(0, 0) || node == bar.node(0, 1);
        supports.extend(is_held.then(|| fixed(2 * node)));
        supports.push(fixed(2 * node + 1));
    }
    model.initial_velocity = vec![0.0; model.mesh.dof_count()];
    for j in 0..2 {
        model.initial_velocity[2 * bar.node(1, j)] = SPEED;
    }
    model.steps = vec![step(dt, increments, settings(scheme), supports)];
    run_to_end(&model).0
}

/// One increment of the scheme for x'' + c x' + x = 0 in closed form: displacement and velocity at its
/// end.
fn increment(scheme: Scheme, c: f64, dt: f64, [x, v]: [f64; 2]) -> [f64; 2] {
    let theta2 = match scheme {
        Scheme::EnergyMomentum => 0.5,
        Scheme::Ss22 { theta2, .. } => theta2,
    };
    // (2/dt²) (d - dt v) + c d/dt + x + theta2 d + (theta1 - theta2) dt v = 0, theta1 = theta2
    let d = (2.0 / dt * v - x) / (2.0 / (dt * dt) + c / dt + theta2);
    [x + d, 2.0 * d / dt - v]
}

#[test]
fn a_mode_decays_as_in_closed_form() {
    let dampings = [(0.2, 0.0), (0.0, 0.2), (0.05, 0.1), (0.0, 30.0)];
    for scheme in SCHEMES {
        for dt in [0.05, 0.5, 5.0] {
            for (alpha, beta) in dampings {
                let keep = one_mode(scheme, Damping { alpha, beta }, dt, 60);
                // 2 zeta omega = alpha + beta omega², omega = 1
                let (c, mut expected) = (alpha + beta, [0.0, SPEED]);
                for report in &keep.reports[1..] {
                    expected = increment(scheme, c, dt, expected);
                    let error = (report.state.u[2] - expected[0]).abs();
                    assert!(error < 3e-7 * SPEED, "dt {dt}: {error:e}");
                }
            }
        }
    }
}

#[test]
fn the_damping_ratio_is_that_of_rayleigh() {
    // amplitude after five periods: exp(-zeta omega t), zeta = alpha/(2 omega) + beta omega/2
    for (alpha, beta) in [(0.06, 0.0), (0.0, 0.06)] {
        let errors = [0.1, 0.05].map(|dt| {
            let increments = (10.0 * std::f64::consts::PI / dt).round() as usize;
            let keep = one_mode(
                Scheme::EnergyMomentum,
                Damping { alpha, beta },
                dt,
                increments,
            );
            let (first, last) = (&keep.reports[0], last(&keep));
            let found = (energy(last) / energy(first)).ln() / -2.0;
            found / (0.03 * last.time) - 1.0
        });
        println!("relative errors of the ratio: {errors:?}");
        assert!(errors[0].abs() < 0.005 && errors[1].abs() < 0.005);
    }
}

/// A block that flies, spins and is stretched.
fn flying_block(law: Law, formulation: Formulation, damping: Damping, scheme: Scheme) -> Model {
    let mut model = model(1.0, 0.3, 1.0);
    model.materials[0].law = law;
    model.materials[0].damping = damping;
    let block = add_block(&mut model, [0.0, 0.0], [2.0, 1.0], (6, 3), 0.0);
    throw(&mut model, &block, [0.4, -0.3], 0.8, [1.0, 0.5]);
    stretch(&mut model, &block, 0.3, 1.0);
    for element in &mut model.mesh.elements {
        element.element_type = ElementType {
            formulation,
            ..ElementType::CPE4
        };
    }
    model.steps = vec![step(0.05, 100, settings(scheme), Vec::new())];
    model
}

fn laws() -> [Law; 2] {
    let rubber = NeoHooke { c10: 1.0, d1: 0.2 };
    [Law::elastic(4.0, 0.3), Law::NeoHooke(rubber)]
}

/// Largest errors of the linear and the angular momentum, with what mass-proportional damping took.
fn momentum_errors(keep: &Keep) -> [f64; 2] {
    let first = &keep.reports[0].momentum;
    let linear = largest(&keep.reports, |r| {
        let m = &r.momentum;
        let change = |i: usize| m.linear[i] + m.damped_linear[i] - first.linear[i];
        change(0).hypot(change(1)) / first.linear[0].hypot(first.linear[1])
    });
    let angular = largest(&keep.reports, |r| {
        let m = &r.momentum;
        (m.angular + m.damped_angular - first.angular).abs() / first.angular.abs()
    });
    [linear, angular]
}

#[test]
fn viscosity_keeps_both_momenta_and_takes_what_is_booked() {
    for law in laws() {
        for formulation in [Formulation::Displacement, Formulation::MeanDilatation] {
            for beta in [0.005, 0.05, 0.5] {
                let damping = Damping { alpha: 0.0, beta };
                let scheme = Scheme::EnergyMomentum;
                let (keep, summary) =
                    run_to_end(&flying_block(law.clone(), formulation, damping, scheme));
                let (first, last) = (&keep.reports[0], last(&keep));
                let [linear, angular] = momentum_errors(&keep);
                let lost = energy(first) - energy(last);
                let passes = summary.solver.passes as f64 / 100.0;
                println!(
                    "beta {beta}: linear {linear:.0e} angular {angular:.0e} lost {:.3} passes {passes:.1}",
                    lost / energy(first)
                );
                assert!(linear < 1e-13 && angular < 2e-13);
                assert_eq!(last.momentum.damped_linear, [0.0; 2]);
                assert!(lost > 0.01 * energy(first));
                assert!((last.energy.damping - lost).abs() < 1e-12 * energy(first));
                assert!(last.energy.numerical_dissipation.abs() < 1e-12 * energy(first));
                assert!(largest(&keep.reports, |r| r.energy.balance.abs()) < 1e-12 * energy(first));
                for pair in keep.reports.windows(2) {
                    assert!(pair[1].energy.damping >= pair[0].energy.damping);
                    assert!(energy(&pair[1]) <= energy(&pair[0]) + 1e-12 * energy(first));
                }
                assert!(keep.cutbacks.is_empty());
            }
        }
    }
}

/// A neo-Hookean square with mean dilatation, mu = 1, that is pulled to 1.5 times its length in a time of 10 and may
/// contract: its run without and with BETA = 0.01, and the dof of a pulled node.
fn pulled(bulk: f64, scheme: Scheme) -> ([(Keep, usize); 2], [usize; 2]) {
    let mut model = model(1.0, 0.3, 1e-6);
    let d1 = 2.0 / bulk;
    model.materials[0].law = Law::NeoHooke(NeoHooke { c10: 0.5, d1 });
    let block = add_block(&mut model, [0.0, 0.0], [1.0, 1.0], (1, 1), 0.0);
    model.mesh.elements[0].element_type = ElementType {
        formulation: Formulation::MeanDilatation,
        ..ElementType::CPE4
    };
    let pulled = [0, 1].map(|j| 2 * block.node(1, j));
    let moved = |dof: usize, to: f64| Support {
        dof,
        motion: SupportMotion::Ramp { to },
    };
    let held = [2 * block.node(0, 0), 2 * block.node(0, 1)];
    let below = [0, 1].map(|i| 2 * block.node(i, 0) + 1);
    let supports = held.into_iter().chain(below).map(|dof| moved(dof, 0.0));
    let supports: Vec<Support> = supports.chain(pulled.map(|dof| moved(dof, 0.5))).collect();
    let runs = [0.0, 0.01].map(|beta| {
        model.materials[0].damping = Damping { alpha: 0.0, beta };
        model.steps = vec![step(0.05, 200, settings(scheme), supports.clone())];
        let (keep, summary) = run_to_end(&model);
        (keep, summary.solver.passes)
    });
    (runs, pulled)
}

#[test]
fn the_bulk_modulus_does_not_brake_a_motion_that_keeps_the_volume() {
    for scheme in SCHEMES {
        for bulk in [2.17, 50.0, 1e3, 1e4] {
            let ([(_, elastic), (keep, passes)], pulled) = pulled(bulk, scheme);
            let last = last(&keep);
            let ratio = last.energy.damping / last.energy.strain;
            let force: f64 = pulled.iter().map(|&dof| last.nodal.reaction[dof]).sum();
            println!(
                "K/mu {bulk}: damping {:.4e}, of the strain energy {ratio:.4e}, force {force:.4}, \
                 passes {passes}, without {elastic}",
                last.energy.damping
            );
            assert!((ratio - 1.95e-3).abs() < 0.06e-3, "{ratio}");
            if bulk > 1e3 {
                // at constant volume: 4 beta mu int (dl/dt/l)² dt = 0.002 (1 - 1/1.5), l - l^-3 + 4 beta l'/l²
                assert!((last.energy.damping / (0.002 / 3.0) - 1.0).abs() < 1e-3);
                assert!((force - 1.2046).abs() < 0.01, "{force}");
            }
            assert!(passes < elastic + elastic / 4, "{passes} {elastic}");
            for pair in keep.reports.windows(2) {
                assert!(pair[1].energy.damping >= pair[0].energy.damping);
            }
            assert!(keep.cutbacks.is_empty());
        }
    }
}

#[test]
fn viscosity_needs_no_more_passes_where_it_is_large() {
    let [elastic, _] = laws();
    let passes = [0.0, 0.5].map(|beta| {
        let damping = Damping { alpha: 0.0, beta };
        let model = flying_block(
            elastic.clone(),
            Formulation::Displacement,
            damping,
            Scheme::EnergyMomentum,
        );
        run_to_end(&model).1.solver.passes
    });
    println!("passes in 100 increments: {passes:?}");
    assert!(passes[1] <= passes[0] + 100);
}

#[test]
fn mass_proportional_damping_brakes_the_flight_as_booked() {
    let (alpha, dt) = (0.3, 0.05);
    for scheme in SCHEMES {
        let damping = Damping { alpha, beta: 0.01 };
        let model = flying_block(
            laws()[0].clone(),
            Formulation::Displacement,
            damping,
            scheme,
        );
        let keep = run_to_end(&model).0;
        let (first, last) = (&keep.reports[0], last(&keep));
        // p1 = p0 (1 - alpha dt/2)/(1 + alpha dt/2)
        let factor = ((1.0 - alpha * dt / 2.0) / (1.0 + alpha * dt / 2.0)).powi(100);
        for i in 0..2 {
            let expected = factor * first.momentum.linear[i];
            assert!((last.momentum.linear[i] - expected).abs() < 1e-12 * expected.abs());
        }
        let [linear, angular] = momentum_errors(&keep);
        println!("linear {linear:.0e} angular {angular:.0e}");
        assert!(linear < 1e-13);
        assert!(angular < 2e-13 || scheme == PAPER);
        assert!(largest(&keep.reports, |r| r.energy.balance.abs()) < 1e-12 * energy(first));
        assert!(last.energy.damping > 0.5 * energy(first));
    }
}

#[test]
fn the_balance_holds_in_contact_and_at_moving_supports() {
    for scheme in SCHEMES {
        let mut model = model(1000.0, 0.3, 1.0);
        model.materials[0].damping = Damping {
            alpha: 2.0,
            beta: 2e-3,
        };
        let lower = add_block(&mut model, [0.0, 0.0], [2.0, 1.0], (8, 4), 0.0);
        let upper = add_block(&mut model, [0.5, 1.0], [1.0, 1.0], (5, 5), 0.0);
        add_contact(&mut model, upper.faces(0), lower.faces(2), 0.3);
        model.initial_velocity = vec![0.0; model.mesh.dof_count()];
        let moved = |dof: usize, to: f64| Support {
            dof,
            motion: SupportMotion::Ramp { to },
        };
        let held = (0..=8).flat_map(|i| [0, 1].map(|k| moved(2 * lower.node(i, 0) + k, 0.0)));
        let driven = (0..=5).flat_map(|i| {
            let node = upper.node(i, 5);
            [moved(2 * node, 0.1), moved(2 * node + 1, -0.02)]
        });
        let supports = held.chain(driven).collect();
        model.steps = vec![step(1e-3, 100, settings(scheme), supports)];
        let (keep, summary) = run_to_end(&model);
        let last = last(&keep);
        let largest_energy = largest(&keep.reports, |r| energy(r).max(r.energy.external_work));
        println!("{:?} {} passes", last.energy, summary.solver.passes);
        assert!(last.energy.damping > 1e-3 * largest_energy);
        assert!(last.energy.friction_dissipation > 1e-3 * largest_energy);
        assert!(largest(&keep.reports, |r| r.energy.balance.abs()) < 1e-12 * largest_energy);
    }
}

/// Two damped blocks that collide obliquely.
fn collision(damping: Damping, contact_mass: ContactMass) -> Model {
    let mut model = model(1000.0, 0.3, 1.0);
    model.materials[0].damping = damping;
    let lower = add_block(&mut model, [0.0, 0.0], [2.0, 1.0], (8, 5), 0.0);
    let upper = add_block(&mut model, [0.5, 1.05], [1.0, 1.0], (5, 5), 0.3);
    throw(&mut model, &lower, [0.1, 0.2], 0.0, [0.0; 2]);
    throw(&mut model, &upper, [0.5, -2.0], 0.4, [1.0, 1.5]);
    add_contact(&mut model, upper.faces(0), lower.faces(2), 0.0);
    let settings = Settings {
        landing: LandingRule::Return,
        contact_mass,
        ..Settings::default()
    };
    model.steps = vec![step(5e-3, 150, settings, Vec::new())];
    model
}

#[test]
fn landings_of_damped_bodies_give_back_energy_and_keep_momenta() {
    for mass in [ContactMass::Consistent, ContactMass::Redistributed] {
        for alpha in [0.0, 0.2] {
            let keep = run_to_end(&collision(Damping { alpha, beta: 2e-3 }, mass)).0;
            let (first, last) = (&keep.reports[0], last(&keep));
            let [linear, angular] = momentum_errors(&keep);
            println!("{linear:.0e} {angular:.0e} {:?}", last.energy);
            assert!(linear < 1e-13 && angular < 2e-13);
            assert!(last.energy.landing_return > 1e-4 * energy(first));
            assert!(last.energy.damping > 1e-2 * energy(first));
            assert!(largest(&keep.reports, |r| r.energy.balance.abs()) < 1e-12 * energy(first));
        }
    }
}

#[test]
fn damping_below_round_off_has_no_effect() {
    for tiny in [1e-300, 1e-320] {
        let runs = [(0.0, 0.0), (tiny, 0.0), (0.0, tiny)].map(|(alpha, beta)| {
            let model = collision(Damping { alpha, beta }, ContactMass::Consistent);
            run_to_end(&model).0
        });
        let [none, damped @ ..] = &runs;
        let exact = energy(last(none));
        for keep in damped {
            assert!((energy(last(keep)) - exact).abs() < 1e-9 * exact);
            assert!(keep.cutbacks.len() == none.cutbacks.len());
        }
    }
}
