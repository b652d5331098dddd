//! Progress of an attempt at an increment, which remains when the attempt fails.
//!
//! Slave nodes whose contact goes to and fro from pass to pass; such nodes keep the passes from converging if contact
//! forces do not come to rest.

use std::collections::VecDeque;

use super::contact_forces::ContactForces;
use crate::contact::{ClosedPair, Constraint, NodeAtSegment, SlaveKey};
use crate::dynamics::results::{Alternation, Cause, Course, PassReport, Worst};
use crate::lcp::ContactState;
use crate::model::Settings;

/// Number of corrections at the end of an attempt over which their mean rate is computed.
const LAST: usize = 4;
/// Growth from which on passes count as diverged: growth of the corrections from the smallest to the last, or of the
/// forces to be balanced from the first pass to the last.
const GROWTH: f64 = 10.0;
/// Number of passes for which memory is reserved at the start.
const ROOM: usize = 100;
/// Mean rate from which on the corrections count as not falling.
const STALLED: f64 = 0.9;

/// Cause of a failed attempt, and its progress.
pub(crate) struct Failed {
    pub cause: Cause,
    pub course: Option<Box<Course>>,
    pub worst: Option<Worst>,
    pub passes: Vec<PassReport>,
}

/// Records of an attempt, which remain even if the attempt fails.
#[derive(Default)]
pub(super) struct Trace {
    pub passes: Vec<PassReport>,
    pub worst: Option<Worst>,
    /// Number of passes before the last start from the predictor.
    earlier: usize,
    contact: PassContacts,
    /// Largest force that the first and the last pass had to balance.
    unbalanced: Option<[f64; 2]>,
}

impl Trace {
    /// An empty trace, with room for the passes that an increment may take.
    pub fn new(most_passes: usize) -> Self {
        Trace {
            passes: Vec::with_capacity(most_passes.min(ROOM)),
            ..Trace::default()
        }
    }

    /// Notes that the passes begin with the predictor, perhaps anew.
    pub fn begin(&mut self) {
        self.earlier = self.passes.len();
        self.contact.clear();
    }

    /// Enters the largest force that a pass has to balance.
    pub fn balance(&mut self, force: f64) {
        let [first, _] = self.unbalanced.unwrap_or([force; 2]);
        self.unbalanced = Some([first, force]);
    }

    /// Enters a pass with its correction and its contact forces.
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

    /// Whether the passes since the last start will converge within MAX PASSES at the rate of the last passes.
    pub fn will_end(&self, settings: &Settings) -> bool {
        let corrections = self.corrections();
        match end_of(&corrections, settings.tolerance) {
            Some(Course::Slow { left, .. }) => corrections.len() + left <= settings.max_passes,
            _ => false,
        }
    }

    /// Relative corrections of the passes since the last start.
    fn corrections(&self) -> Vec<f64> {
        let passes = self.passes[self.earlier..].iter();
        passes.map(|pass| pass.correction).collect()
    }

    /// Notes that the iterate of the last pass is solved to the given residual.
    pub fn solved(&mut self, residual: f64) {
        if let Some(pass) = self.passes.last_mut() {
            pass.residual = residual;
        }
    }

    /// The failure of the attempt; `tolerance` is the tolerance of the passes.
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

    /// Course of the passes; `None` if there were too few passes to judge.
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

    /// The given cause, or `Diverged` if passes with ever larger forces have made numbers overflow
    /// or K* indefinite.
    fn explain(&self, cause: Cause) -> Cause {
        let has_grown = |factor: f64| {
            let grown = |[first, last]: [f64; 2]| last > factor * first || last.is_nan();
            self.unbalanced.is_some_and(grown)
        };
        // with an element turned inside out there are no forces to compare
        let is_wrecked = matches!(cause, Cause::Inverted { .. }) && !self.passes.is_empty();
        let diverged = match cause {
            Cause::Indefinite { .. } => has_grown(GROWTH),
            _ => cause.is_overflow() && (is_wrecked || has_grown(1.0)),
        };
        if diverged { Cause::Diverged } else { cause }
    }
}

/// Number, from 1, of the pass after which the corrections grew; `None` if they did not grow.
fn growth(corrections: &[f64]) -> Option<usize> {
    let (smallest, least) = (corrections.iter().enumerate()).min_by(|p, q| p.1.total_cmp(q.1))?;
    let last = *corrections.last()?;
    (last > GROWTH * least).then_some(smallest + 1)
}

/// Course of the last corrections, with n = ln(correction/tolerance)/-ln(rate) further passes needed.
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

/// Number of last passes within which a slave node must have left a state and come back to it.
const PASSES: usize = 6;
/// Number of last passes within which the state of a slave node must have changed.
const RECENT: usize = 3;

/// A closed pair after a pass.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Touch {
    pair: NodeAtSegment,
    state: ContactState,
}

/// Closed pairs after each of the last passes.
#[derive(Debug, Default)]
pub(super) struct PassContacts {
    /// The closed pairs of all passes, in the order of the passes.
    touches: Vec<Touch>,
    /// Number of closed pairs in every pass.
    counts: VecDeque<usize>,
}

impl PassContacts {
    /// Forgets the passes so far.
    pub fn clear(&mut self) {
        self.touches.clear();
        self.counts.clear();
    }

    /// Enters the closed pairs after a pass.
    pub fn add(&mut self, contact: &ContactForces) {
        let touch = |(constraint, pair): (&Constraint, &ClosedPair)| Touch {
            pair: constraint.pair(),
            // without friction sticking and sliding are the same
            state: match constraint.mu {
                0.0 => ContactState::Stick,
                _ => pair.state,
            },
        };
        self.push(contact.acting().map(touch));
    }

    fn push(&mut self, touches: impl Iterator<Item = Touch>) {
        if self.counts.len() == PASSES
            && let Some(oldest) = self.counts.pop_front()
        {
            self.touches.drain(..oldest);
        }
        let before = self.touches.len();
        self.touches.extend(touches);
        self.counts.push_back(self.touches.len() - before);
        self.make_room();
    }

    /// Reserves memory for as many pairs in all passes as the last pass has.
    fn make_room(&mut self) {
        let of_pass = self.counts.back().copied().unwrap_or(0);
        let passes = PASSES - self.counts.len();
        self.touches.reserve(of_pass * passes);
        self.counts.reserve(passes);
    }

    /// The closed pairs of every pass, one pass after the other.
    fn passes(&self) -> impl Iterator<Item = &[Touch]> {
        let mut rest = self.touches.as_slice();
        self.counts.iter().map(move |&count| {
            let (pass, others) = rest.split_at(count);
            rest = others;
            pass
        })
    }

    /// The slave nodes that went to and fro, in the order of their keys.
    pub fn alternations(&self) -> Vec<Alternation> {
        let all = self.touches.iter().map(|touch| touch.pair.key.slave());
        let mut slaves: Vec<SlaveKey> = all.collect();
        slaves.sort_unstable();
        slaves.dedup();
        slaves
            .into_iter()
            .filter_map(|s| self.of_slave(s))
            .collect()
    }

    /// The two states between which a slave node went to and fro; `None` if it did not.
    fn of_slave(&self, slave: SlaveKey) -> Option<Alternation> {
        let own = |touches: &[Touch]| -> Vec<Touch> {
            let is_own = |touch: &&Touch| touch.pair.key.slave() == slave;
            touches.iter().filter(is_own).copied().collect()
        };
        let states: Vec<Vec<Touch>> = self.passes().map(own).collect();
        let recent = &states[states.len().saturating_sub(RECENT)..];
        if recent.windows(2).all(|pair| pair[0] == pair[1]) {
            return None;
        }
        // the latest pass whose state differs from the last state, and whether the last state occurred before this pass
        let last = states.last()?;
        let other = states.iter().rposition(|state| state != last)?;
        let came_back = |state: &[Vec<Touch>], at: usize| state[..at].contains(last);
        came_back(&states, other).then(|| alternation(&states[other], last))?
    }
}

/// The difference between two states of a slave node; `None` if the states are equal.
fn alternation(p: &[Touch], q: &[Touch]) -> Option<Alternation> {
    let without = |p: &[Touch], q: &[Touch]| {
        let is_other = |touch: &&Touch| q.iter().all(|other| other.pair.nodes != touch.pair.nodes);
        p.iter().find(is_other).map(|touch| touch.pair.nodes)
    };
    match (without(p, q), without(q, p)) {
        (Some([slave, a, b]), Some([_, c, d])) => Some(Alternation::Changing {
            slave,
            segments: [[a, b], [c, d]],
        }),
        (Some(nodes), None) | (None, Some(nodes)) => Some(Alternation::Closing(nodes)),
        (None, None) => {
            let slides = |touch: &&Touch| q.iter().all(|other| other != *touch);
            let touch = p.iter().find(slides)?;
            Some(Alternation::Sliding(touch.pair.nodes))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The failure of an attempt whose last passes have the given corrections, after other passes.
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

#[cfg(test)]
mod alternation_tests {
    use super::*;
    use crate::contact::testing;
    use ContactState::{SlipPlus, Stick};

    /// A node on segment number `segment`, of nodes `segment` and `segment + 1`.
    fn touch(slave: usize, segment: usize, state: ContactState) -> Touch {
        let pair = NodeAtSegment {
            key: testing::key(slave, 0),
            nodes: [100 + slave, segment, segment + 1],
        };
        Touch { pair, state }
    }

    fn alternations(passes: &[&[Touch]]) -> Vec<Alternation> {
        let mut history = PassContacts::default();
        passes
            .iter()
            .for_each(|touches| history.push(touches.iter().copied()));
        history.alternations()
    }

    #[test]
    fn what_goes_to_and_fro_is_named() {
        let (a, b, slides) = (
            touch(1, 3, Stick),
            touch(1, 5, Stick),
            touch(1, 3, SlipPlus),
        );
        let rests = touch(4, 7, Stick);
        let nodes = [101, 3, 4];
        assert_eq!(
            alternations(&[&[a, rests], &[b, rests], &[a, rests]]),
            [Alternation::Changing {
                slave: 101,
                segments: [[5, 6], [3, 4]]
            }]
        );
        let closing = [Alternation::Closing(nodes)];
        assert_eq!(alternations(&[&[a], &[], &[a], &[]]), closing);
        assert_eq!(
            alternations(&[&[b], &[a, b], &[b]]),
            closing,
            "of two pairs"
        );
        assert_eq!(alternations(&[&[], &[], &[a], &[a], &[]]), closing);
        assert_eq!(
            alternations(&[&[a], &[slides], &[a]]),
            [Alternation::Sliding(nodes)]
        );
        let two = [
            Alternation::Closing(nodes),
            Alternation::Closing([104, 7, 8]),
        ];
        assert_eq!(alternations(&[&[a], &[rests], &[a]]), two);
    }

    #[test]
    fn what_comes_to_rest_is_not() {
        let (a, b) = (touch(1, 3, Stick), touch(1, 5, Stick));
        assert_eq!(alternations(&[]), []);
        assert_eq!(alternations(&[&[a], &[b], &[b]]), [], "it has slid on");
        assert_eq!(
            alternations(&[&[a], &[b], &[a], &[a], &[a]]),
            [],
            "at rest again"
        );
        let long_ago: [&[Touch]; 8] = [&[b], &[a], &[a], &[a], &[a], &[a], &[a], &[b]];
        assert_eq!(alternations(&long_ago), [], "six passes ago");
    }
}
