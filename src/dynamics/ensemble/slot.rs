//! One motion of a scheduler: into a lane and out of it.

use super::cursor::Cursor;
use super::{Tally, Watcher};
use crate::crossing::allowances::FOUR_ULPS;
use crate::lanes::{Begin, LaneTask, LaneValues, PhaseEnds, Shape};
use crate::model::Model;
use crate::model::entry::{Entry, ModeEntry};
use crate::model::instant::Instant;
use crate::numeric::two_word::TwoWord;
use crate::state::State;
use std::ops::ControlFlow;

/// A motion, what the lanes need of its model, and what begins when its phase ends, if that is
/// known.
pub struct Slot<'a, W> {
    number: usize,
    cursor: Cursor<'a, W>,
    shape: Option<Shape<f64>>,
    next: Option<Entry>,
    tally: Tally,
}

impl<'a, W: Watcher> Slot<'a, W> {
    pub fn new(number: usize, cursor: Cursor<'a, W>) -> Self {
        let shape = Shape::new(cursor.model);
        Self { number, cursor, shape, next: None, tally: Tally::default() }
    }

    /// The motion's number and its watcher, and by what its phases were solved.
    pub fn leave(self) -> (usize, W, Tally) {
        (self.number, self.cursor.into_watcher(), self.tally)
    }

    pub fn model(&self) -> &'a Model {
        self.cursor.model
    }

    /// Gives a lane the constants.
    pub fn shape(&self, lane: usize, shape: &mut Shape<LaneValues>) {
        if let Some(mine) = &self.shape {
            shape.set(lane, mine);
        }
    }

    /// The next task for the lanes. What lanes cannot do, the scalar solver does first. `None` when
    /// the watcher has seen enough.
    pub fn next_task(&mut self) -> Option<LaneTask> {
        loop {
            let task = match self.cursor.entry.mode {
                _ if self.shape.is_none() => None,
                ModeEntry::Separation { h_rate: 0.0 } => Some(LaneTask::Flight),
                ModeEntry::Contact { .. } => Some(LaneTask::Contact),
                ModeEntry::Progression { .. } => Some(LaneTask::Slip),
                ModeEntry::Apart | ModeEntry::Separation { .. } => None,
            };
            if task.is_some() {
                return task;
            }
            self.tally.alone += 1;
            if self.cursor.pass().is_break() {
                return None;
            }
        }
    }

    /// The phase, and in it the strobe that is due, by the scalar solver.
    fn pass_alone(&mut self) -> Option<LaneTask> {
        self.tally.alone += 1;
        match self.cursor.pass() {
            ControlFlow::Continue(()) => self.next_task(),
            ControlFlow::Break(()) => None,
        }
    }

    /// Fills a lane.
    #[inline]
    pub fn begin(&self, task: LaneTask, lane: usize, begin: &mut Begin) {
        let Entry { instant, state, mode, .. } = &self.cursor.entry;
        let angle = instant.angle_two_word();
        begin.angle[lane] = angle.high;
        begin.angle_low[lane] = angle.low;
        begin.y[lane] = state.y;
        begin.q[lane] = state.q;
        let (first, second) = match *mode {
            ModeEntry::Contact { offset, reference } => (offset, reference),
            ModeEntry::Progression { drift_rate, closing } => (drift_rate, closing),
            ModeEntry::Apart | ModeEntry::Separation { .. } => (0.0, 0.0),
        };
        begin.first[lane] = first;
        begin.second[lane] = second;
        if task.is_strobe() {
            let due = self.cursor.due;
            let angle = due.angle_two_word();
            begin.due_cycles[lane] = (due.cycle() - instant.cycle()) as i64 as f64;
            begin.due[lane] = angle.high;
            begin.due_low[lane] = angle.low;
        }
    }

    /// Takes what a lane has found, or has the scalar solver find it; returns the next task.
    #[inline]
    pub fn advance(&mut self, task: LaneTask, lane: usize, end: &PhaseEnds) -> Option<LaneTask> {
        if end.proved[lane] != 1.0 {
            return task.finer_task().or_else(|| self.pass_alone());
        }
        if task.is_strobe() {
            let Some(strobe) = self.strobe(task, lane, end) else { return self.pass_alone() };
            if self.cursor.see(&strobe, None).is_break() {
                return None;
            }
            return match self.next {
                Some(next) => self.task_after(task, next),
                None => self.pass_alone(),
            };
        }
        self.tally.in_lanes += 1;
        let next = self.land(task, lane, end);
        self.task_after(task, next)
    }

    /// The next strobe in the phase, or the phase after it.
    #[inline]
    fn task_after(&mut self, task: LaneTask, next: Entry) -> Option<LaneTask> {
        // As a segment shows them: what is due when the phase ends belongs to the next one.
        while next.instant > self.cursor.due {
            if self.cursor.due > self.cursor.entry.instant {
                self.next = Some(next);
                return Some(task.strobe());
            }
            let entry = self.cursor.entry;
            if self.cursor.see(&entry, None).is_break() {
                return None;
            }
        }
        self.cursor.enter(&next);
        self.next_task()
    }

    /// What begins at a switch, with what is known there imposed ([`crate::run::switch`]).
    #[inline]
    fn land(&self, task: LaneTask, lane: usize, end: &PhaseEnds) -> Entry {
        let Entry { instant, drift, .. } = self.cursor.entry;
        let constants = self.cursor.model.constants();
        let angle = TwoWord { high: end.angle[lane], low: end.angle_low[lane] };
        let instant =
            Instant::from_parts(instant.cycle() + i128::from(end.cycles[lane] as i64), angle);
        let y = end.y[lane];
        let (q, mode, drift) = match task {
            LaneTask::Contact | LaneTask::ContactAgain | LaneTask::ContactStrobe => {
                let threshold = end.guard[lane];
                let mode = if threshold == 1.0 {
                    ModeEntry::Progression { drift_rate: 0.0, closing: y }
                } else {
                    ModeEntry::Separation { h_rate: 0.0 }
                };
                (threshold - constants.two_xi * y, mode, drift)
            }
            LaneTask::Slip | LaneTask::SlipStrobe => {
                let mode = ModeEntry::Contact { offset: 0.0, reference: 1.0 };
                let drift = drift.plus(TwoWord::new(end.drift[lane]));
                (1.0 - constants.two_xi * y, mode, drift)
            }
            LaneTask::Flight | LaneTask::FlightAgain | LaneTask::FlightStrobe => {
                let (f, q) = (end.guard[lane], end.q[lane]);
                let mode = if f < 1.0 {
                    ModeEntry::Contact { offset: f, reference: 0.0 }
                } else {
                    ModeEntry::slipping(constants, &State { p: q + constants.g, y, q })
                };
                (q, mode, drift)
            }
        };
        Entry { instant, state: State { p: q + constants.g, y, q }, drift, mode }
    }

    /// The phase taken up at the strobe ([`crate::Segment::entry_at`]); none next to a threshold.
    #[inline]
    fn strobe(&self, task: LaneTask, lane: usize, end: &PhaseEnds) -> Option<Entry> {
        let Entry { drift, mode, .. } = self.cursor.entry;
        let g = self.cursor.model.constants().g;
        let state = State { p: end.p[lane], y: end.y[lane], q: end.q[lane] };
        let guard = end.guard[lane];
        let (mode, drift) = match (task, mode) {
            (LaneTask::FlightStrobe, _) => {
                let clear = state.p < state.q + g;
                (clear.then_some(ModeEntry::Apart)?, drift)
            }
            (_, ModeEntry::Contact { reference, .. }) => {
                let f = reference + guard;
                let clear = f.min(1.0 - f) > FOUR_ULPS;
                (clear.then_some(ModeEntry::Contact { offset: guard, reference })?, drift)
            }
            _ => {
                let clear = guard > FOUR_ULPS * end.terms[lane];
                let mode = ModeEntry::Progression { drift_rate: guard, closing: end.closing[lane] };
                (clear.then_some(mode)?, drift.plus(TwoWord::new(end.drift[lane])))
            }
        };
        Some(Entry { instant: self.cursor.due, state, drift, mode })
    }
}
