//! Energy that landings take is given back: `*STICKSLIP, LANDING=RETURN`.

use stickslip::dynamics::Touch;
use stickslip::model::{
    Face, Impact, ImpactTime, LandingRule, Model, Scheme, Settings, Support, SupportMotion,
};

use crate::accounts::{MASSES, all_exterior, near};
use crate::blocks::{
    Block, Keep, add_block, add_contact, fixed, gravity, model, run_to_end, step, throw,
};
use crate::energies::energy;
use crate::invariants::{drift, oblique_impact};

fn settings() -> Settings {
    Settings {
        landing: LandingRule::Return,
        ..Settings::default()
    }
}

fn with(mut model: Model, change: impl Fn(&mut Settings)) -> Model {
    for step in &mut model.steps {
        step.settings.landing = LandingRule::Return;
        change(&mut step.settings);
    }
    model
}

/// The balance is round-off, all that normal contact forces take is given back, contact by contact, and
/// energy that nothing brings in never rises. Returns the energy given back as a part of the start.
fn check(keep: &Keep, what: &str) -> f64 {
    check_but_for(keep, what, 0.0)
}

/// The same, where the bounds of the returns lose at most the part `lost` of the energy.
fn check_but_for(keep: &Keep, what: &str, lost: f64) -> f64 {
    let scale = keep.reports.iter().map(energy).fold(0.0, f64::max);
    for pair in keep.reports.windows(2) {
        let (before, after) = (&pair[0].energy, &pair[1].energy);
        assert!(
            after.balance.abs() < 1e-10 * scale,
            "{what}: {:e}",
            after.balance
        );
        let taken = after.normal_contact_work + after.landing_return;
        let least = -(1e-10 + lost) * scale;
        assert!(taken > least && taken < 1e-10 * scale, "{what}: {taken:e}");
        let work = after.external_work - before.external_work;
        let rise = energy(&pair[1]) - energy(&pair[0]) - work;
        assert!(rise < 1e-10 * scale, "{what}: {rise:e}");
        let of_contacts = pair[1].contacts.iter().map(|c| c.landing_return);
        near(of_contacts.sum(), after.landing_return, scale);
        for contact in &pair[1].contacts {
            let outside = contact.impulse_cone_violation;
            assert!(outside < 2e-9, "{what}: {outside:e} at {}", pair[1].time);
        }
    }
    keep.reports.last().expect("reports").energy.landing_return / energy(&keep.reports[0])
}

/// A square of one stiff element falls flat with the speed 2 on a fixed plate, `way` increments away.
fn falling_square(young: f64, way: f64, dt: f64, friction: f64) -> (Model, Block) {
    let mut model = model(young, 0.0, 1.0);
    let plate = add_block(&mut model, [-1.0, -0.5], [3.0, 0.5], (1, 1), 0.0);
    let square = add_block(&mut model, [0.0, way * 2.0 * dt], [1.0, 1.0], (1, 1), 0.0);
    throw(&mut model, &square, [0.5, -2.0], 0.0, [0.0; 2]);
    add_contact(&mut model, square.faces(0), plate.faces(2), friction);
    let supports = plate.nodes().flat_map(|n| [fixed(2 * n), fixed(2 * n + 1)]);
    let settings = Settings {
        impact: Impact::None,
        ..settings()
    };
    model.steps = vec![step(dt, 6, settings, supports.collect())];
    (model, square)
}

/// Wherever within an increment a stiff square lands, it bounces with its speed, and does not spin.
#[test]
fn a_stiff_element_bounces_like_a_point_mass() {
    for way in [2.0625, 2.25, 2.5, 2.75, 2.9375] {
        let (model, _) = falling_square(1e12, way, 0.01, 0.0);
        let (keep, _) = run_to_end(&model);
        // to bounce with all of its energy, the elastic square would have to pull by 3e-8 of its force
        check_but_for(&keep, "square", 5e-8);
        let last = keep.reports.last().expect("reports");
        let body = last.bodies[1];
        println!("{way}: {body:?}");
        assert!((body.velocity[1] - 2.0).abs() < 1e-6, "{way}: {body:?}");
        assert!((body.velocity[0] - 0.5).abs() < 1e-12, "{way}: {body:?}");
        assert!(body.angular_velocity.abs() < 1e-9, "{way}: {body:?}");
        // one touch of both nodes, with the energy of the fall
        let touches: Vec<Touch> = keep
            .reports
            .iter()
            .flat_map(|r| r.touches.clone())
            .collect();
        let [touch] = &touches[..] else {
            panic!("{way}: {touches:?}");
        };
        assert!((touch.energy - 2.0).abs() < 1e-5, "{touch:?}");
        assert!(
            (touch.impulse - 4.0).abs() < 1e-5 && touch.is_at_corner,
            "{touch:?}"
        );
        assert!(
            touch.first == 3 && touch.last <= 4 && touch.nodes == 2,
            "{touch:?}"
        );
        assert!(last.contacts[0].handover_work == 0.0);
        let mut plastic = model.clone();
        plastic.steps[0].settings.landing = LandingRule::Plastic;
        let (keep, _) = run_to_end(&plastic);
        let speed = keep.reports.last().expect("reports").bodies[1].velocity[1];
        // it lands after the part s of the increment and leaves it with |1 - 2 s| of its speed
        let expected = 2.0 * (1.0 - 2.0 * (way - 2.0)).abs();
        assert!((speed - expected).abs() < 1e-4, "{way}: {speed} {expected}");
    }
}

/// Wherever within an increment a square lands that slides, the impulses of every increment stay in Coulomb's cone, and
/// so does their sum: what takes a force back takes its friction back.
#[test]
fn impulses_of_landings_stay_in_the_cone() {
    let friction = 0.1;
    for way in [2.0625, 2.25, 2.5, 2.75, 2.9375] {
        for young in [1e4, 1e8] {
            let (model, _) = falling_square(young, way, 0.01, friction);
            let (keep, _) = run_to_end(&model);
            check(&keep, "sliding square");
            let mut friction_dissipation = 0.0;
            for report in &keep.reports {
                let contact = &report.contacts[0];
                for impulse in [&contact.impulse, &contact.impulse_sum] {
                    let most = friction * impulse.normal + 1e-12;
                    assert!(
                        impulse.tangential.abs() <= most,
                        "{way} {young}: {impulse:?}"
                    );
                }
                for pair in &report.returns {
                    assert!(
                        pair.tangential.abs() <= friction * pair.normal + 1e-12,
                        "{pair:?}"
                    );
                }
                let total = report.energy.friction_dissipation;
                assert!(total >= friction_dissipation - 1e-12);
                friction_dissipation = total;
            }
            let returned = keep.reports.iter().map(|r| r.returns.len()).sum::<usize>();
            assert!(returned > 0 && friction_dissipation > 0.0);
        }
    }
}

/// Both momenta of free bodies stay, and those of each body change by the impulses of the contact.
#[test]
fn momenta_are_kept_and_impulses_are_their_change() {
    for friction in [0.0, 0.3] {
        let model = with(oblique_impact(friction, Scheme::EnergyMomentum), |_| {});
        let (keep, _) = run_to_end(&model);
        let returned = check(&keep, "beams");
        let [_, linear, angular] = drift(&keep);
        println!("mu {friction}: returned {returned:.1e}, {linear:.1e} {angular:.1e}");
        assert!(returned > 1e-3, "{returned}");
        assert!(linear < 1e-13 && angular < 1e-13);
        let start = keep.reports[0].bodies[1];
        let mut sum = 0.0;
        for report in &keep.reports {
            let contact = &report.contacts[0];
            let change = [0, 1].map(|i| report.bodies[1].velocity[i] - start.velocity[i]);
            near(contact.impulse_sum.vector[0], MASSES[1] * change[0], 10.0);
            near(contact.impulse_sum.vector[1], MASSES[1] * change[1], 10.0);
            sum += contact.impulse.landing_return;
            near(sum, contact.impulse_sum.landing_return, 10.0);
        }
        assert!(sum.abs() > 0.0);
    }
}

#[test]
fn impacts_as_events_and_general_contact_give_back_alike() {
    let event = |s: &mut Settings| s.impact_time = ImpactTime::Event;
    let beams = || oblique_impact(0.3, Scheme::EnergyMomentum);
    let factors = |s: &mut Settings| s.factorization = stickslip::model::Factorization::EveryPass;
    for (what, model) in [
        ("events", with(beams(), event)),
        ("general contact", with(all_exterior(), |_| {})),
        ("factors", with(beams(), factors)),
        ("no impulses", with(beams(), |s| s.impact = Impact::None)),
    ] {
        let (keep, _) = run_to_end(&model);
        let returned = check(&keep, what);
        let [_, linear, angular] = drift(&keep);
        println!("{what}: returned {returned:.1e}, {linear:.1e} {angular:.1e}");
        // events leave no way to land
        assert_eq!(returned > 0.0, what != "events", "{what}");
        assert!(linear < 1e-13 && angular < 1e-13, "{what}");
    }
}

/// A block falls askew on a plate that a support moves up at constant speed, in two steps.
#[test]
fn a_moving_support_works_and_is_not_moved() {
    let mut model = model(1e4, 0.3, 1.0);
    let plate = add_block(&mut model, [-1.0, -0.5], [3.0, 0.5], (3, 1), 0.0);
    let block = add_block(&mut model, [0.0, 0.1], [1.0, 1.0], (3, 3), 0.1);
    throw(&mut model, &block, [0.3, -2.0], 0.0, [0.0; 2]);
    throw(&mut model, &plate, [0.0, 0.5], 0.0, [0.0; 2]);
    add_contact(&mut model, block.faces(0), plate.faces(2), 0.2);
    add_contact(&mut model, plate.faces(2), block.faces(0), 0.2);
    let (dt, count) = (0.005, 30);
    let supports = |step: f64| -> Vec<Support> {
        let bottom = (0..=plate.nx).map(|i| plate.node(i, 0));
        let motion = SupportMotion::Ramp {
            to: 0.5 * dt * count as f64 * step,
        };
        let pair = |n: usize| {
            let up = Support {
                dof: 2 * n + 1,
                motion,
            };
            [fixed(2 * n), up]
        };
        bottom.flat_map(pair).collect()
    };
    model.steps = [1.0, 2.0]
        .map(|k| step(dt, count, settings(), supports(k)))
        .to_vec();
    let (keep, _) = run_to_end(&model);
    let returned = check(&keep, "moving plate");
    println!("returned {returned:.1e}");
    assert!(returned > 1e-3);
    for report in &keep.reports {
        for i in 0..=plate.nx {
            let [x, y] = [0, 1].map(|k| report.state.v[2 * plate.node(i, 0) + k]);
            assert!(x == 0.0 && (y - 0.5).abs() < 1e-14);
        }
    }
}

/// A disc of blocks mirrored about its vertical axis stays so: nodes that land together share alike.
#[test]
fn what_is_symmetric_stays_symmetric() {
    let mut model = model(1e3, 0.3, 1.0);
    let plate = add_block(&mut model, [-3.0, -0.5], [6.0, 0.5], (5, 1), 0.0);
    let block = add_block(&mut model, [-1.0, 0.1], [2.0, 1.0], (4, 2), 0.0);
    throw(&mut model, &block, [0.0, -2.0], 0.0, [0.0; 2]);
    for i in 0..=4 {
        // the bottom is a shallow arch
        let node = block.node(i, 0);
        model.mesh.coordinates[node][1] += [0.0, 0.004, 0.005, 0.004, 0.0][i];
    }
    add_contact(&mut model, block.faces(0), plate.faces(2), 0.2);
    let supports = plate.nodes().flat_map(|n| [fixed(2 * n), fixed(2 * n + 1)]);
    model.steps = vec![step(0.008, 40, settings(), supports.collect())];
    let (keep, _) = run_to_end(&model);
    assert!(check(&keep, "arch") > 1e-3);
    for report in &keep.reports {
        let body = &report.bodies[1];
        assert!(body.angular_velocity.abs() < 1e-9 && body.velocity[0].abs() < 1e-10);
    }
}

/// A disc of a mapped block rolls on a plate, on which its weight presses it: nodes hand over to each other.
#[test]
fn nodes_of_a_rolling_disc_hand_over() {
    let mut model = model(1e4, 0.3, 1.0);
    let plate = add_block(&mut model, [-1.0, -0.5], [8.0, 0.5], (8, 1), 0.0);
    let disc = add_block(&mut model, [-1.0, -1.0], [2.0, 2.0], (6, 6), 0.0);
    for node in disc.nodes() {
        let [x, y] = model.mesh.coordinates[node];
        let round = |a: f64, b: f64| a * (1.0 - b * b / 2.0).sqrt();
        model.mesh.coordinates[node] = [round(x, y), round(y, x) + 1.0];
    }
    throw(&mut model, &disc, [1.0, 0.0], -1.0, [0.0, 1.0]);
    let skin: Vec<Face> = (0..4).flat_map(|side| disc.faces(side)).collect();
    add_contact(&mut model, skin, plate.faces(2), 0.5);
    let supports = plate.nodes().flat_map(|n| [fixed(2 * n), fixed(2 * n + 1)]);
    let mut roll = step(0.01, 150, Settings::default(), supports.collect());
    roll.body_forces = (plate.nx * plate.ny..model.mesh.elements.len())
        .map(|element| gravity(element, 100.0))
        .collect();
    model.steps = vec![roll];
    let (keep, _) = run_to_end(&model);
    let last = keep.reports.last().expect("reports");
    let contact = &last.contacts[0];
    println!(
        "handover {} of {}",
        contact.handover_work, contact.normal_work
    );
    assert!(last.bodies[1].center[0] > 0.9);
    assert!(contact.handover_work < 0.5 * contact.normal_work && contact.normal_work < 0.0);
}
