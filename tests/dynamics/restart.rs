//! A run that goes on from a checkpoint has the same bits as one that was never stopped.

use std::io;
use std::path::Path;

use stickslip::diagnostics::{Diagnostics, Sources};
use stickslip::dynamics::{Cutback, IncrementReport, Observer, RunSummary, resume, run};
use stickslip::prepare::{PreparedModel, prepare};
use stickslip::reader;

/// All that a run reports, as text with all digits, and its checkpoints.
#[derive(Default)]
struct Record {
    /// Reports of the increments.
    reports: Vec<String>,
    /// Increments between two checkpoints; none without.
    every: usize,
    /// Number of the last increment of a stopped run.
    last: Option<usize>,
    /// Checkpoints with the number of reports before them.
    checkpoints: Vec<(usize, Vec<u8>)>,
}

impl Observer for Record {
    fn increment(&mut self, report: &IncrementReport) -> io::Result<()> {
        self.reports.push(format!("{report:?}"));
        Ok(())
    }

    fn cutback(&mut self, _: &Cutback) -> io::Result<()> {
        Ok(())
    }

    fn wants_stop(&self) -> bool {
        self.last.is_some_and(|last| self.reports.len() > last)
    }

    fn wants_checkpoint(&self) -> bool {
        let done = self.checkpoints.last().map_or(0, |(reports, _)| *reports);
        self.every > 0 && self.reports.len() >= done + self.every
    }

    fn checkpoint(&mut self, checkpoint: Vec<u8>) -> io::Result<()> {
        self.checkpoints.push((self.reports.len(), checkpoint));
        Ok(())
    }
}

/// The model of a deck of the repository, whose steps end after so many increments.
fn model(deck: &str, increments: usize) -> PreparedModel {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(deck);
    let (mut sources, mut d) = (Sources::new(), Diagnostics::new());
    let model = reader::read_model(&path, &mut sources, &mut d);
    let mut model = model.unwrap_or_else(|| panic!("{}", d.render(&sources, false)));
    for step in &mut model.steps {
        let most = increments as f64 * step.increments.dt;
        step.increments.period = step.increments.period.min(most);
    }
    prepare(model, &mut d).expect("sound")
}

fn counts(summary: &RunSummary) -> String {
    format!(
        "{} {} {:?}",
        summary.increments, summary.cutbacks, summary.solver
    )
}

/// Every checkpoint of a run leads to the same end, and making them changes nothing.
fn check(deck: &str, increments: usize, every: usize) {
    let model = model(deck, increments);
    let mut whole = Record::default();
    let summary = run(&model, &mut whole).expect("the observer never fails");
    let mut stopping = Record {
        every,
        ..Record::default()
    };
    run(&model, &mut stopping).expect("the observer never fails");
    let first = |one: &[String], other: &[String]| one.iter().zip(other).position(|(a, b)| a != b);
    assert_eq!(
        first(&whole.reports, &stopping.reports),
        None,
        "{deck}: with checkpoints"
    );
    assert!(
        stopping.checkpoints.len() > 3,
        "{deck}: {}",
        whole.reports.len()
    );
    for (reports, checkpoint) in &stopping.checkpoints {
        let mut rest = Record::default();
        let resumed = resume(&model, checkpoint, 0.0, &mut rest).expect("its own checkpoint");
        let expected = &whole.reports[*reports..];
        assert_eq!(
            first(expected, &rest.reports),
            None,
            "{deck}: after {reports}"
        );
        assert_eq!(
            expected.len(),
            rest.reports.len(),
            "{deck}: after {reports}"
        );
        assert_eq!(
            counts(&resumed),
            counts(&summary),
            "{deck}: after {reports}"
        );
    }
    // a run that is stopped goes on, too
    let mut stopped = Record {
        last: Some(whole.reports.len() / 2),
        ..Record::default()
    };
    run(&model, &mut stopped).expect("the observer never fails");
    let (reports, checkpoint) = &stopped.checkpoints[0];
    let mut rest = Record::default();
    resume(&model, checkpoint, 0.0, &mut rest).expect("its own checkpoint");
    assert_eq!(
        first(&whole.reports[*reports..], &rest.reports),
        None,
        "{deck}: stopped"
    );
}

#[test]
fn contact_with_friction_and_kept_factors() {
    check("input/two_cantilevers/A_mu04.inp", 200, 37);
}

#[test]
fn impacts_that_end_increments() {
    check("tests/decks/beam_lands_with_events.inp", 200, 37);
}

#[test]
fn redistributed_mass_with_landing_returns() {
    check("input/bouncing_discs/discs_return.inp", 150, 31);
}

#[test]
fn rubber_in_self_contact() {
    check("input/rubber_ring/rubber_ring_mu05.inp", 120, 29);
}

#[test]
fn static_steps_with_automatic_increments() {
    check("tests/decks/static_steps.inp", 1000, 2);
}

#[test]
fn fits_that_shrink() {
    check("tests/decks/fits.inp", 1000, 3);
}

#[test]
fn bodies_that_turn() {
    check("verification/rigid_bodies/boxes.inp", 200, 41);
    check("tests/decks/hinges.inp", 120, 23);
}

#[test]
fn bodies_that_fly_and_land() {
    check("input/bouncing_discs/discs_plastic.inp", 120, 25);
}

#[test]
fn a_checkpoint_of_another_model_is_refused() {
    let mut record = Record {
        last: Some(1),
        ..Record::default()
    };
    let own = model("tests/decks/square.inp", 5);
    run(&own, &mut record).expect("the observer never fails");
    let (_, checkpoint) = &record.checkpoints[0];
    let other = model("tests/decks/drop.inp", 5);
    assert!(resume(&other, checkpoint, 0.0, &mut Record::default()).is_err());
    for cut in [0, 1, checkpoint.len() / 2, checkpoint.len() - 1] {
        assert!(resume(&own, &checkpoint[..cut], 0.0, &mut Record::default()).is_err());
    }
}

#[test]
fn friction_and_contacts_that_steps_change() {
    check("tests/decks/friction.inp", 100, 4);
}
