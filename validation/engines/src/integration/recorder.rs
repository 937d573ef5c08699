//! Records the steps and guard evaluations of a run while it is made.

use crate::engine::{GuardSample, Outcome, Trace, Watched};
use std::cell::RefCell;

/// The most records that are kept: a search that hangs would fill the memory.
const MAX_RECORDS: usize = 20_000;

/// Records inside a window.
#[derive(Debug)]
pub(crate) struct Recorder {
    window: [f64; 2],
    trace: RefCell<Trace>,
}

impl Recorder {
    pub(crate) fn new(watched: &Watched) -> Self {
        Self { window: watched.window, trace: RefCell::default() }
    }

    fn holds(&self, t: f64) -> bool {
        self.window[0] <= t && t <= self.window[1]
    }

    /// Takes back the ends of steps after `t`, where a mode has ended or a step begins anew.
    pub(crate) fn back_to(&self, t: f64) {
        let steps = &mut self.trace.borrow_mut().steps;
        while steps.last().is_some_and(|end| *end > t) {
            steps.pop();
        }
    }

    /// Notes the end of an accepted step.
    pub(crate) fn step(&self, end: f64) {
        self.back_to(end);
        let steps = &mut self.trace.borrow_mut().steps;
        if self.holds(end) && steps.len() < MAX_RECORDS {
            steps.push(end);
        }
    }

    /// Records one evaluation of a guard.
    pub(crate) fn record_evaluation(&self, look: GuardSample) {
        let looks = &mut self.trace.borrow_mut().looks;
        if self.holds(look.t) && looks.len() < MAX_RECORDS {
            looks.push(look);
        }
    }

    /// Whether a run that has come to `t` has passed the window.
    pub(crate) fn is_over(&self, t: f64) -> bool {
        t > self.window[1]
    }

    /// Moves the recording into the outcome.
    pub(crate) fn hand_over(&self, outcome: &mut Outcome) {
        outcome.trace = Some(self.trace.take());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_lies_in_the_window_is_kept() {
        let recorder = Recorder::new(&Watched { window: [1.0, 2.0], instants: Vec::new() });
        [0.5, 1.0, 2.0, 2.5].into_iter().for_each(|t| recorder.step(t));
        let look = |t, guard| GuardSample { t, mode: 1, guard, value: -0.25 };
        [look(0.5, 1), look(1.5, 0), look(3.0, 0)]
            .into_iter()
            .for_each(|it| recorder.record_evaluation(it));
        let mut outcome = Outcome::default();
        recorder.hand_over(&mut outcome);
        let expected = Trace { steps: vec![1.0, 2.0], looks: vec![look(1.5, 0)] };
        assert_eq!(outcome.trace, Some(expected));
    }

    #[test]
    fn a_step_in_which_a_phase_ends_is_taken_back() {
        let recorder = Recorder::new(&Watched { window: [0.0, 9.0], instants: Vec::new() });
        [1.0, 2.0].into_iter().for_each(|t| recorder.step(t));
        recorder.back_to(1.5);
        [1.75, 4.0, 3.0].into_iter().for_each(|t| recorder.step(t));
        assert_eq!(recorder.trace.take().steps, [1.0, 1.75, 3.0]);
    }

    #[test]
    fn the_memory_is_bounded() {
        let recorder = Recorder::new(&Watched { window: [0.0, 1.0], instants: Vec::new() });
        (0..=MAX_RECORDS).for_each(|_| recorder.step(0.5));
        assert_eq!(recorder.trace.take().steps.len(), MAX_RECORDS);
    }
}
