//! Progress of an attempt at an increment, which it leaves behind when it fails.

use super::alternation::ContactHistory;
use super::forces::ContactForces;
use crate::dynamics::results::{Cause, Course, PassReport, Worst};
use crate::model::Settings;

/// Corrections whose mean rate counts at the end of an attempt.
const LAST: usize = 4;
/// Growth of the corrections from their smallest to the last, or of the forces to be balanced from the
/// first to the last, from which on passes diverged.
const GROWTH: f64 = 10.0;
/// Passes for which there is room at the start.
const ROOM: usize = 100;
/// Mean rate from which on the corrections count as not falling.
const STALLED: f64 = 0.9;

/// Why an attempt failed, and how far it came.
pub(crate) struct Failed {
    pub cause: Cause,
    pub course: Option<Box<Course>>,
    pub worst: Option<Worst>,
    pub passes: Vec<PassReport>,
}

/// What an attempt leaves behind even when it fails.
#[derive(Default)]
pub(super) struct Trace {
    pub passes: Vec<PassReport>,
    pub worst: Option<Worst>,
    /// Number of passes before they last began with the predictor.
    earlier: usize,
    contact: ContactHistory,
    /// Largest force that the passes were to balance, of the first pass and of the last.
    unbalanced: Option<[f64; 2]>,
}

impl Trace {
    /// The trace of passes, of which there may be as many as given.
    pub fn new(most_passes: usize) -> Self {
        Trace {
            passes: Vec::with_capacity(most_passes.min(ROOM)),
            ..Trace::default()
        }
    }

    /// The passes begin with the predictor, perhaps anew.
    pub fn begin(&mut self) {
        self.earlier = self.passes.len();
        self.contact.clear();
    }

    /// Takes in the largest force that a pass is to balance.
    pub fn balance(&mut self, force: f64) {
        let [first, _] = self.unbalanced.unwrap_or([force; 2]);
        self.unbalanced = Some([first, force]);
    }

    /// Takes in a pass and its contact forces.
    pub fn add(&mut self, pass: PassReport, contact: &ContactForces) {
        self.passes.push(pass);
        self.contact.add(contact);
    }

    /// Relative correction of the last pass.
    pub fn correction(&self) -> f64 {
        self.passes
            .last()
            .map_or(f64::INFINITY, |pass| pass.correction)
    }

    /// Whether the passes since they last began will have converged within MAX PASSES, at the rate of the
    /// last ones.
    pub fn will_end(&self, settings: &Settings) -> bool {
        let corrections = self.corrections();
        match end_of(&corrections, settings.tolerance) {
            Some(Course::Slow { left, .. }) => corrections.len() + left <= settings.max_passes,
            _ => false,
        }
    }

    /// Relative corrections of the passes since they last began.
    fn corrections(&self) -> Vec<f64> {
        let passes = self.passes[self.earlier..].iter();
        passes.map(|pass| pass.correction).collect()
    }

    /// The iterate of the last pass is solved to the given residual.
    pub fn solved(&mut self, residual: f64) {
        if let Some(pass) = self.passes.last_mut() {
            pass.residual = residual;
        }
    }

    /// The failure of the attempt, `tolerance` being that of the passes.
    pub fn failed(self, cause: Cause, tolerance: f64) -> Failed {
        let cause = self.explain(cause);
        let course = match cause {
            Cause::NotConverged | Cause::Diverged => self.course(tolerance),
            _ => None,
        };
        Failed {
            cause,
            course: course.map(Box::new),
            worst: self.worst,
            passes: self.passes,
        }
    }

    /// How the passes went; none where they were too few to tell.
    fn course(&self, tolerance: f64) -> Option<Course> {
        let alternations = self.contact.alternations();
        let corrections = self.corrections();
        let grown = growth(&corrections).map(|pass| Course::Growing {
            from: self.earlier + pass,
        });
        match alternations.is_empty() {
            true => grown.or_else(|| end_of(&corrections, tolerance)),
            false => Some(Course::Alternating(alternations)),
        }
    }

    /// The cause as it is, or that passes with ever larger forces have made numbers overflow, or K*
    /// indefinite.
    fn explain(&self, cause: Cause) -> Cause {
        let has_grown = |factor: f64| {
            let grown = |[first, last]: [f64; 2]| last > factor * first || last.is_nan();
            self.unbalanced.is_some_and(grown)
        };
        // where an element is wrecked, there are no forces to compare
        let is_wrecked = matches!(cause, Cause::Inverted { .. }) && !self.passes.is_empty();
        let diverged = match cause {
            Cause::Indefinite { .. } => has_grown(GROWTH),
            _ => cause.is_overflow() && (is_wrecked || has_grown(1.0)),
        };
        if diverged { Cause::Diverged } else { cause }
    }
}

/// Number, from 1, of the pass after which the corrections grew, if they did.
fn growth(corrections: &[f64]) -> Option<usize> {
    let (smallest, least) = (corrections.iter().enumerate()).min_by(|p, q| p.1.total_cmp(q.1))?;
    let last = *corrections.last()?;
    (last > GROWTH * least).then_some(smallest + 1)
}

/// How the last of some corrections went on, with n = ln(correction/tolerance)/-ln(rate) passes left.
fn end_of(corrections: &[f64], tolerance: f64) -> Option<Course> {
    let ends = &corrections[corrections.len().saturating_sub(LAST)..];
    let (&first, &last) = (ends.first()?, ends.last()?);
    let rate = (last / first).powf(1.0 / (ends.len() - 1).max(1) as f64);
    if ends.len() < 2 || !rate.is_finite() {
        return None;
    }
    if rate > STALLED {
        let correction = ends.iter().copied().fold(last, f64::min);
        return Some(Course::Stagnant { correction });
    }
    let left = ((last / tolerance).ln() / -rate.ln()).ceil().max(1.0);
    Some(Course::Slow {
        rate,
        left: left as usize,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The failure after passes with the given corrections, and others before.
    fn failed(cause: Cause, corrections: &[f64]) -> Failed {
        let mut trace = Trace::default();
        let pass = |correction| PassReport {
            correction,
            ..PassReport::default()
        };
        let contact = ContactForces::default();
        trace.begin();
        trace.add(pass(1.0), &contact);
        trace.add(pass(1e-3), &contact);
        trace.begin();
        for &correction in corrections {
            trace.add(pass(correction), &contact);
        }
        trace.failed(cause, 1e-10)
    }

    fn course(corrections: &[f64]) -> Option<Course> {
        failed(Cause::NotConverged, corrections).course.map(|c| *c)
    }

    #[test]
    fn corrections_tell_how_the_passes_went() {
        let growing = Some(Course::Growing { from: 5 });
        assert_eq!(course(&[1.0, 1e-2, 1e-3, 1e-2, 1e-1]), growing);
        let Some(Course::Slow { rate, left }) = course(&[1.0, 0.5, 0.25, 0.125, 0.0625]) else {
            panic!("slow");
        };
        // 0.0625/2^n < 1e-10 for n = 29.2
        assert!((rate - 0.5).abs() < 1e-12 && left == 30, "{rate} {left}");
        let stagnant = Some(Course::Stagnant { correction: 1e-8 });
        assert_eq!(course(&[1.0, 1e-8, 2e-8, 1e-8, 2e-8]), stagnant);
        assert_eq!(course(&[1.0]), None);
        assert_eq!(course(&[]), None);
        assert_eq!(course(&[1.0, f64::NAN]), None);
    }

    #[test]
    fn other_causes_speak_for_themselves() {
        let found = failed(Cause::Indefinite { node: 3 }, &[1.0, 0.5, 0.25]);
        assert_eq!((found.course, found.passes.len()), (None, 5));
    }

    #[test]
    fn an_indefinite_matrix_of_a_wrecked_iterate_is_divergence() {
        let cause = |last: f64| {
            let mut trace = Trace::default();
            [1.0, last].iter().for_each(|force| trace.balance(*force));
            trace.failed(Cause::Indefinite { node: 3 }, 1e-10).cause
        };
        assert_eq!(cause(2.0), Cause::Indefinite { node: 3 });
        assert_eq!(cause(1e3), Cause::Diverged);
        assert_eq!(cause(f64::NAN), Cause::Diverged);
    }
}
