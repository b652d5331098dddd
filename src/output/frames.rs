//! The frames of field output: their schedule (docs/output.md, "/VTKHDF: the frames"), and their contents.

use std::sync::Arc;

use crate::archive::{Archive, ArchiveError, transfer_fields};
use crate::dynamics::{FrictionResults, IncrementReport, NodalResults, State};
use crate::elements::ElementResult;
use crate::model::{Frames, Model, Step};

/// Default number of frames of a step.
pub const DEFAULT_FRAMES: usize = 100;

/// Round-off by which an increment may end before the time of a frame, relative to the increment.
const TIME_TOLERANCE: f64 = 1e-6;

/// Largest number of intervals: with more, neighbouring frame times would not be distinct numbers.
const MOST_INTERVALS: f64 = (1_u64 << 52) as f64;

/// Decides which increments write a frame.
#[derive(Debug, Clone)]
pub struct FrameSchedule<'a> {
    steps: &'a [Step],
    /// Number of the current step, from 1.
    step: usize,
    /// Index of the next frame time of the step, from 1.
    next: usize,
    /// Number of increments of the step so far.
    increments: usize,
}

impl<'a> FrameSchedule<'a> {
    /// The schedule of the steps of a model.
    pub fn new(model: &'a Model) -> Self {
        FrameSchedule {
            steps: &model.steps,
            step: 1,
            next: 1,
            increments: 0,
        }
    }

    /// Transfers the position in the schedule.
    pub(super) fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        transfer_fields!(archive, self => FrameSchedule { step, next, increments; steps })
    }

    /// Number of the step, from 1, and number of its increments so far.
    pub(super) fn place(&self) -> [usize; 2] {
        [self.step, self.increments]
    }

    /// Whether the increment writes a frame: the start, the end of a step, and every increment
    /// that reaches the next scheduled time.
    pub fn is_due(&mut self, report: &IncrementReport) -> bool {
        if report.increment == 0 {
            return true;
        }
        if report.step != self.step {
            (self.step, self.next, self.increments) = (report.step, 1, 0);
        }
        self.increments += 1;
        let reached = self.reaches(report);
        reached || report.ends_step
    }

    /// Whether the increment reaches scheduled times, which are then passed.
    fn reaches(&mut self, report: &IncrementReport) -> bool {
        let Some(step) = self.steps.get(self.step - 1) else {
            return false;
        };
        if let Frames::Increments(every) = step.frames {
            return self.increments.is_multiple_of(every.max(1));
        }
        let end = report.step_time + TIME_TOLERANCE * report.dt;
        let first = self.next;
        self.next = passed(step, first, end);
        self.next > first
    }
}

/// Index of the first frame from `first` on whose time lies after `end`.
fn passed(step: &Step, first: usize, end: f64) -> usize {
    let period = step.increments.period;
    let evenly = |count: usize| multiples(first, end, |k| period * k as f64 / count as f64);
    match &step.frames {
        Frames::Default => evenly(DEFAULT_FRAMES),
        Frames::Count(count) => evenly((*count).max(1)),
        Frames::Every(interval) => multiples(first, end, |k| interval * k as f64),
        Frames::Times(times) => 1 + times.partition_point(|&time| time <= end),
        Frames::Increments(_) => first,
    }
}

/// The first k from `first` on with `time(k)` after `end`; `time` increases linearly from 0. If intervals are
/// negligible against `end`, the count advances by one, so every increment writes a frame.
fn multiples(first: usize, end: f64, time: impl Fn(usize) -> f64) -> usize {
    let intervals = end / time(1);
    if !(0.0..MOST_INTERVALS).contains(&intervals) {
        return first.saturating_add(1);
    }
    let mut k = first.max(intervals as usize);
    while time(k) <= end {
        k += 1;
    }
    k
}

/// Estimated number of frames of a run without cutbacks.
pub(super) fn expected_frames(model: &Model) -> usize {
    let of_step = |step: &Step| {
        let increments = (step.increments.period / step.increments.dt).ceil() as usize;
        let frames = match &step.frames {
            Frames::Default => DEFAULT_FRAMES,
            Frames::Count(count) => *count,
            Frames::Every(interval) => (step.increments.period / interval) as usize,
            Frames::Increments(every) => increments / (*every).max(1),
            Frames::Times(times) => times.len() + 1,
        };
        frames.clamp(1, increments.max(1))
    };
    let frames = model.steps.iter().map(of_step);
    frames.fold(1, usize::saturating_add)
}

/// Whether the deck requests frames at intervals shorter than the increments of a step, so that
/// each increment writes one.
pub(super) fn are_dense(step: &Step) -> bool {
    let increments = &step.increments;
    let interval = match step.frames {
        Frames::Count(count) => increments.period / count as f64,
        Frames::Every(interval) => interval,
        Frames::Default | Frames::Increments(_) | Frames::Times(_) => return false,
    };
    interval < increments.dt * (1.0 - TIME_TOLERANCE)
}

/// Contents of a field frame.
#[derive(Default)]
pub(crate) struct Frame {
    /// Index of the frame in the file.
    pub index: usize,
    pub time: f64,
    pub state: State,
    pub nodal: NodalResults,
    /// Mean stress and mean strain of every element.
    pub elements: Arc<[ElementResult]>,
}

impl Frame {
    /// Transfers all contents of the frame.
    pub fn transfer(&mut self, archive: &mut Archive) -> Result<(), ArchiveError> {
        let mut of_elements = self.elements.to_vec();
        archive.transfer(&mut of_elements)?;
        self.elements = of_elements.into();
        transfer_fields!(archive, self => Frame { index, time, state, nodal; elements })
    }

    /// Copies the results of an increment, reusing the allocated memory.
    pub fn set(&mut self, report: &IncrementReport) {
        let (state, nodal) = (&report.state, &report.nodal);
        self.time = report.time;
        self.state.u.clone_from(&state.u);
        self.state.v.clone_from(&state.v);
        self.state.a.clone_from(&state.a);
        self.state.internal.clone_from(&state.internal);
        self.state.temperature.clone_from(&state.temperature);
        self.nodal.reaction.clone_from(&nodal.reaction);
        self.nodal.concentrated.clone_from(&nodal.concentrated);
        self.nodal.tie_force.clone_from(&nodal.tie_force);
        self.nodal.contact_force.clone_from(&nodal.contact_force);
        self.nodal.gap.clone_from(&nodal.gap);
        self.nodal.status.clone_from(&nodal.status);
        self.nodal.pressure.clone_from(&nodal.pressure);
        self.nodal.slip.clone_from(&nodal.slip);
        self.nodal.mass.clone_from(&nodal.mass);
        let FrictionResults {
            coefficient,
            work,
            wear,
            heat,
        } = &nodal.friction;
        self.nodal.friction.coefficient.clone_from(coefficient);
        self.nodal.friction.work.clone_from(work);
        self.nodal.friction.wear.clone_from(wear);
        self.nodal.friction.heat.clone_from(heat);
        self.elements.clone_from(&report.elements);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Increments;

    fn model(frames: Frames, period: f64) -> Model {
        let step = Step {
            frames,
            ..Step::new(Increments::fixed(0.1, period))
        };
        Model {
            steps: vec![step.clone(), step],
            ..Model::default()
        }
    }

    /// Numbers of the increments that write a frame, when every increment has length 0.1.
    fn due(frames: Frames, increments: usize, steps: usize) -> Vec<usize> {
        let model = model(frames, 0.1 * increments as f64);
        let mut schedule = FrameSchedule::new(&model);
        let mut numbers = vec![];
        for number in 0..=increments * steps {
            let (step, within) = match number {
                0 => (1, 0),
                n => ((n - 1) / increments + 1, (n - 1) % increments + 1),
            };
            let report = IncrementReport {
                increment: number,
                step,
                step_time: (1..=within).fold(0.0, |t, _| t + 0.1),
                dt: 0.1,
                ends_step: within == increments,
                ..IncrementReport::default()
            };
            if schedule.is_due(&report) {
                numbers.push(number);
            }
        }
        numbers
    }

    #[test]
    fn counts_are_evenly_spaced_and_end_with_the_step() {
        assert_eq!(due(Frames::Count(5), 10, 1), [0, 2, 4, 6, 8, 10]);
        assert_eq!(due(Frames::Count(3), 10, 1), [0, 4, 7, 10]);
        assert_eq!(due(Frames::Count(1), 10, 2), [0, 10, 20]);
        assert_eq!(due(Frames::Count(0), 3, 1), [0, 3]);
        assert_eq!(due(Frames::Default, 1000, 1).len(), DEFAULT_FRAMES + 1);
        assert_eq!(due(Frames::Default, 7, 1).len(), 8);
    }

    #[test]
    fn about_as_many_frames_are_expected_as_become_due() {
        let frames = [
            Frames::Default,
            Frames::Count(5),
            Frames::Count(0),
            Frames::Every(0.3),
            Frames::Every(0.0),
            Frames::Increments(4),
            Frames::Times(vec![0.35, 0.8]),
        ];
        for frames in frames {
            for increments in [10, 1000] {
                let written = due(frames.clone(), increments, 2).len();
                let expected = expected_frames(&model(frames.clone(), 0.1 * increments as f64));
                assert!(
                    expected.abs_diff(written) <= 2,
                    "{frames:?} {increments}: {expected} {written}"
                );
            }
        }
    }

    #[test]
    fn intervals_count_from_the_start_of_the_step() {
        assert_eq!(
            due(Frames::Every(0.3), 10, 2),
            [0, 3, 6, 9, 10, 13, 16, 19, 20]
        );
        assert_eq!(due(Frames::Every(0.25), 6, 1), [0, 3, 5, 6]);
        assert_eq!(due(Frames::Every(0.01), 3, 1), [0, 1, 2, 3]);
        assert_eq!(due(Frames::Every(0.0), 2, 1), [0, 1, 2]);
        assert_eq!(due(Frames::Every(9.0), 4, 1), [0, 4]);
    }

    #[test]
    fn intervals_beyond_all_measure_are_every_increment_or_none() {
        let all: Vec<usize> = (0..=12).collect();
        for interval in [
            1e-300,
            1e-21,
            f64::MIN_POSITIVE,
            5e-324,
            1e-16,
            f64::NAN,
            -1.0,
        ] {
            assert_eq!(due(Frames::Every(interval), 6, 2), all, "{interval}");
        }
        for count in [usize::MAX, 1 << 53, 1 << 52, 1 << 40] {
            assert_eq!(due(Frames::Count(count), 6, 2), all, "{count}");
        }
        assert_eq!(due(Frames::Every(f64::MAX), 6, 2), [0, 6, 12]);
        assert_eq!(due(Frames::Every(f64::INFINITY), 6, 2), [0, 6, 12]);
        assert_eq!(due(Frames::Increments(usize::MAX), 6, 2), [0, 6, 12]);
        let times = vec![-1.0, 1e-300, 0.1, 1e300, f64::INFINITY];
        assert_eq!(due(Frames::Times(times), 6, 2), [0, 1, 6, 7, 12]);
    }

    #[test]
    fn dense_frames_are_those_that_every_increment_writes() {
        let dense = |frames| are_dense(&model(frames, 1.0).steps[0]);
        assert!(dense(Frames::Every(0.09)) && dense(Frames::Count(11)));
        assert!(!dense(Frames::Every(0.1)) && !dense(Frames::Count(10)));
        assert!(!dense(Frames::Default) && !dense(Frames::Increments(1)));
    }

    #[test]
    fn increments_and_times() {
        assert_eq!(due(Frames::Increments(4), 10, 1), [0, 4, 8, 10]);
        assert_eq!(due(Frames::Increments(4), 6, 2), [0, 4, 6, 10, 12]);
        assert_eq!(due(Frames::Times(vec![0.2, 0.55]), 10, 1), [0, 2, 6, 10]);
    }
}
