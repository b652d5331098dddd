//! Increments that follow their truncation error: `*DYNAMIC` without `DIRECT`.

use stickslip::dynamics::{Cause, Cutback, IncrementReport, RunSummary};
use stickslip::model::{
    ContactMass, Impact, ImpactTime, Incrementation, Increments, LandingRule, Model, Settings,
};

use crate::blocks::{Keep, add_block, add_contact, fixed, gravity, model, run_to_end, step, throw};
use crate::reading::read;

const TOLERANCE: f64 = 1e-4;

/// Gives the steps of a model increments that follow their error.
fn automatic(model: &mut Model, tolerance: f64) {
    for step in &mut model.steps {
        let Increments { dt, period, .. } = step.increments;
        step.increments = Increments {
            dt_min: 1e-5 * period,
            dt_max: period / 10.0,
            incrementation: Incrementation::Error { tolerance },
            dt,
            period,
        };
    }
}

/// An elastic bar of `count` elements that flies against a wall, and back.
fn flying_bar(count: usize, settings: Settings) -> Model {
    let mut model = model(100.0, 0.0, 1.0);
    let wall = add_block(&mut model, [-0.5, -0.5], [0.5, 1.1], (1, 1), 0.0);
    let bar = add_block(&mut model, [0.3, 0.0], [1.0, 0.1], (count, 1), 0.0);
    throw(&mut model, &bar, [-1.0, 0.0], 0.0, [0.0; 2]);
    add_contact(&mut model, bar.faces(3), wall.faces(1), 0.0);
    let supports = wall.nodes().flat_map(|n| [fixed(2 * n), fixed(2 * n + 1)]);
    model.steps = vec![step(0.004, 250, settings, supports.collect())];
    automatic(&mut model, TOLERANCE);
    model
}

/// A stiff square that falls on a plate and bounces like a point mass.
fn bouncing_square(settings: Settings) -> Model {
    let mut model = model(1e9, 0.0, 1.0);
    let plate = add_block(&mut model, [-1.0, -0.5], [3.0, 0.5], (1, 1), 0.0);
    let square = add_block(&mut model, [0.0, 1.0], [1.0, 1.0], (1, 1), 0.0);
    add_contact(&mut model, square.faces(0), plate.faces(2), 0.0);
    let supports = plate.nodes().flat_map(|n| [fixed(2 * n), fixed(2 * n + 1)]);
    let settings = Settings {
        impact: Impact::None,
        landing: LandingRule::Return,
        ..settings
    };
    model.steps = vec![step(0.02, 200, settings, supports.collect())];
    model.steps[0].body_forces = vec![gravity(square.first_element, 10.0)];
    automatic(&mut model, 1e-3);
    model
}

fn dts(keep: &Keep) -> Vec<f64> {
    keep.reports[1..].iter().map(|report| report.dt).collect()
}

fn total(report: &IncrementReport) -> f64 {
    let e = &report.energy;
    e.kinetic + e.strain - e.external_work
}

/// What holds for every run: increments fill the step, grow by half at most after two of one length, are within their
/// bounds, and have errors below the tolerance unless they were repeated twice; no energy rises, and the ledger is closed.
fn check(model: &Model, keep: &Keep, summary: &RunSummary) {
    let Increments {
        dt_min,
        dt_max,
        period,
        incrementation,
        ..
    } = model.steps[0].increments;
    let Incrementation::Error { tolerance } = incrementation else {
        panic!("increments that follow their error");
    };
    let last = keep.reports.last().expect("reports");
    assert!(last.ends_step && (last.time - period).abs() < 1e-12 * period);
    let all = dts(keep);
    assert!((all.iter().sum::<f64>() - period).abs() < 1e-9 * period);
    assert!(all.iter().all(|&dt| dt <= dt_max * (1.0 + 1e-12)));
    let is_rejection = |c: &&Cutback| matches!(c.failure.cause, Cause::Inaccurate { .. });
    let rejected: Vec<usize> = (keep.cutbacks.iter().filter(is_rejection))
        .map(|cutback| cutback.failure.increment)
        .collect();
    assert_eq!(rejected.len(), summary.rejections);
    let times_of = |number: usize| rejected.iter().filter(|&&n| n == number).count();
    let scale = keep
        .reports
        .iter()
        .map(|r| r.energy.kinetic)
        .fold(0.0, f64::max);
    for (k, pair) in keep.reports.windows(2).enumerate() {
        let now = &pair[1];
        let error = now.truncation_error.expect("an error");
        let counts = error <= tolerance || times_of(k + 1) == 2 || now.dt <= dt_min * (1.0 + 1e-12);
        assert!(counts, "increment {}: {error:e}", k + 1);
        assert!(times_of(k + 1) <= 2, "increment {}", k + 1);
        assert!(
            now.energy.balance.abs() < 1e-9 * scale,
            "{:e}",
            now.energy.balance
        );
        let rise = total(now) - total(&pair[0]);
        assert!(rise < 1e-9 * scale, "increment {}: {rise:e}", k + 1);
    }
    let mut same = 0;
    for pair in all.windows(2) {
        let grows = pair[1] > pair[0] * (1.0 + 1e-9);
        assert!(!grows || pair[1] <= 1.5 * pair[0] * (1.0 + 1e-9) || summary.events > 0);
        assert!(!grows || same >= 1 || summary.events > 0, "{pair:?}");
        same = if (pair[1] - pair[0]).abs() <= 1e-9 * pair[0] {
            same + 1
        } else {
            0
        };
    }
}

/// The mesh has hardly any influence on the increments of a bar that flies, hits a wall and flies back, and they are fewer
/// than in fixed increments with the same error.
#[test]
fn impacts_do_not_collapse_increments_in_finer_meshes() {
    let counts = [20, 80].map(|elements| {
        let model = flying_bar(elements, Settings::default());
        let (keep, summary) = run_to_end(&model);
        check(&model, &keep, &summary);
        println!(
            "{elements}: {} + {}",
            summary.increments, summary.rejections
        );
        summary.increments + summary.rejections
    });
    assert!(
        counts[0] < 250 && counts[1] * 2 <= counts[0] * 3,
        "{counts:?}"
    );
}

/// Smaller tolerances give smaller errors.
#[test]
fn the_error_follows_the_tolerance() {
    let end = |model: &Model| {
        let (keep, _) = run_to_end(model);
        keep.reports.last().expect("reports").bodies[1].center[0]
    };
    let mut exact = flying_bar(20, Settings::default());
    exact.steps[0].increments =
        step(0.004 / 64.0, 250 * 64, Settings::default(), vec![]).increments;
    let exact = end(&exact);
    let errors = [1e-3, 1e-4, 1e-5].map(|tolerance| {
        let mut model = flying_bar(20, Settings::default());
        automatic(&mut model, tolerance);
        (end(&model) - exact).abs()
    });
    println!("{errors:?}");
    assert!(
        errors[1] < errors[0] / 3.0 && errors[2] < errors[1],
        "{errors:?}"
    );
    assert!(errors[1] < 5e-3, "{errors:?}");
}

/// Bounces: the increments before and after each are about the same, and no energy is lost.
#[test]
fn bounces_leave_increments_long() {
    for impact_time in [ImpactTime::Increment, ImpactTime::Event] {
        let model = bouncing_square(Settings {
            impact_time,
            ..Settings::default()
        });
        let (keep, summary) = run_to_end(&model);
        check(&model, &keep, &summary);
        let least = dts(&keep).into_iter().fold(f64::INFINITY, f64::min);
        println!(
            "{impact_time:?}: {} + {}, least {least:.1e}, {} events",
            summary.increments, summary.rejections, summary.events
        );
        assert!(
            summary.increments < 400,
            "{impact_time:?}: {}",
            summary.increments
        );
    }
}

/// With impacts as events, with returns and with redistributed mass the bar goes on to its end.
#[test]
fn increments_go_with_every_rule_of_impacts() {
    let settings = |impact_time, landing, contact_mass| Settings {
        impact_time,
        landing,
        contact_mass,
        ..Settings::default()
    };
    for impact_time in [ImpactTime::Increment, ImpactTime::Event] {
        for landing in [LandingRule::Plastic, LandingRule::Return] {
            for mass in [ContactMass::Consistent, ContactMass::Redistributed] {
                let model = flying_bar(20, settings(impact_time, landing, mass));
                let (keep, summary) = run_to_end(&model);
                println!(
                    "{impact_time:?} {landing:?} {mass:?}: {} + {}, {} events, {} passes",
                    summary.increments, summary.rejections, summary.events, summary.solver.passes
                );
                check(&model, &keep, &summary);
                assert!(summary.increments < 400);
            }
        }
    }
}

/// Waves that are too fast for the increments do not shorten them, however small the tolerance is.
#[test]
fn waves_of_a_stiff_block_leave_increments_long() {
    let mut model = bouncing_square(Settings::default());
    automatic(&mut model, 1e-5);
    model.steps[0].increments.dt_min = 0.0;
    let (_, summary) = run_to_end(&model);
    let attempts = summary.increments + summary.rejections;
    assert!(attempts < 400, "{attempts}");
}

/// The vibrations that a fit begins with are measured beside the fit: a stiff one takes few increments.
#[test]
fn a_fit_takes_few_increments() {
    let deck = include_str!("../decks/fits.inp").replace("1000., 0.3", "1.e9, 0.3");
    let (head, _) = deck.split_once("*STEP").expect("steps");
    let text = format!(
        "{head}*STEP, NLGEOM\n*DYNAMIC\n0.01, 1.\n*CONTACT INTERFERENCE, SHRINK\nFOOT, TOP\n*END STEP\n"
    );
    let (keep, summary) = run_to_end(&read(&text));
    let last = keep.reports.last().expect("reports");
    assert!(last.contacts.iter().any(|contact| contact.closed > 0));
    let attempts = summary.increments + summary.rejections;
    assert!(attempts < 40, "{attempts}");
}
