//! The beginning of a run: its start, with the errors of the start where they are followed.

use super::Run;
use super::enclosure::Enclosure;
use super::origins::ExactRun;
use super::turn::LastOfCycle;
use crate::affine::arithmetic::clock::Time;
use crate::affine::arithmetic::real::{BigReal, bits_for};
use crate::affine::arithmetic::vector::{Vector, rounded};
use crate::affine::first_crossing::taylor::FailedAttempts;
use crate::affine::guards::point::{Ends, GuardedSegment};
use crate::affine::guards::track::SearchWork;
use crate::affine::model::error::SystemError;
use crate::affine::model::system::{LARGEST_DIMENSION, StartPoint};
use crate::affine::solver::Solver;
use crate::affine::solver::event::{Event, What};
use crate::affine::solver::pool::Loan;
use crate::affine::solver::start_cache::RunStart;
use crate::numeric::number::{Bound, Number};
use std::collections::VecDeque;

impl<T: Number> Solver<T> {
    /// A run from a start up to a time.
    ///
    /// # Errors
    /// A start in no mode, with more or fewer states than the system has, or whose structural zeros
    /// cannot be decided.
    pub fn run(&self, start: &StartPoint, until: T) -> Result<Run<'_, T>, SystemError> {
        let mut run = self.at_start(start, until)?;
        run.begin(None);
        Ok(run)
    }

    /// A run that follows its own errors: each event has bounds of them, and what they leave open
    /// ends the run as undecided.
    ///
    /// # Errors
    /// A start in no mode, with more or fewer states than the system has, or whose structural zeros
    /// cannot be decided.
    pub fn run_enclosed(&self, start: &StartPoint, until: T) -> Result<Run<'_, T>, SystemError> {
        let mut run = self.at_start(start, until)?;
        // Three products and two sums an entry; sine and cosine are good to two units.
        let error = |size: T| T::unit() * 8.0 * size.bound().abs();
        let mut sizes = [T::Bound::ZERO; LARGEST_DIMENSION];
        for (size, entry) in sizes.iter_mut().zip(&run.state) {
            *size = error(*entry);
        }
        let phase = self.phase_roundings(&run.entered);
        // The error of cos theta follows the states; without forcing it is zero.
        let turned = phase[start.state.len()];
        for (size, terms) in sizes.iter_mut().zip(&start.state) {
            let [cos, sin, one] = [0, 1, 2].map(|n| terms[n].to_f64().abs());
            *size += error(T::exact(cos + sin + one)) + turned * (cos + sin);
        }
        sizes.iter_mut().zip(phase).for_each(|(size, turned)| *size += turned);
        sizes[self.system.dimension() - 1] = T::Bound::ZERO;
        run.exact = Some(ExactRun::at_start(&self.system, start, run.entered));
        run.begin(Some(Enclosure::new(&sizes)));
        Ok(run)
    }

    /// A run whose first segment is not entered yet.
    pub(super) fn at_start(&self, start: &StartPoint, until: T) -> Result<Run<'_, T>, SystemError> {
        let mut graph = self.pool.lend();
        self.system.check_start(start)?;
        let begin = graph.start_of_run(&self.system, start, || self.time_and_state(start));
        let item = || format!("a start of {}", self.system.name);
        let begin = begin.ok_or_else(|| SystemError::Undecidable { item: item() })?;
        Ok(self.not_begun(graph, begin, Time { high: until, low: T::zero() }))
    }

    /// A run at a node of the structural zeros whose first segment is not entered yet.
    pub(super) fn not_begun<'a>(
        &'a self,
        graph: Loan<'a, T>,
        begin: RunStart<T>,
        horizon: Time<T>,
    ) -> Run<'a, T> {
        let mode = graph.node(begin.node).mode;
        let first =
            Event { what: What::Start, time: begin.time, state: Vec::new(), mode, errors: None };
        Run {
            solver: self,
            graph,
            work: SearchWork::default(),
            horizon,
            ahead: None,
            node: begin.node,
            entered: begin.time,
            state: begin.state,
            tracks: Vec::new(),
            ends: Ends::default(),
            segment: GuardedSegment::before_entry(&self.modes[mode].flow, &self.modes[mode].guards),
            failed_attempts: vec![FailedAttempts::default(); self.modes.len()],
            restitution: None,
            limit_ahead: None,
            last_of_cycle: LastOfCycle::default(),
            flight: None,
            is_silent: false,
            at_entry: 0,
            returning: 0,
            is_lenient: false,
            tie: None,
            doubt: None,
            touches: Vec::new(),
            events_in_instant: 0,
            queue: VecDeque::new(),
            decided: 0,
            ended: false,
            enclosure: None,
            exact: None,
            start: first.clone(),
            last: first,
        }
    }

    /// The states of a start, rounded to the arithmetic.
    pub(in crate::affine) fn states_at(&self, start: &StartPoint) -> Vec<T> {
        self.time_and_state(start).1[..start.state.len()].to_vec()
    }

    /// The time and the state of a start, rounded to the arithmetic.
    fn time_and_state(&self, start: &StartPoint) -> (Time<T>, Vector<T>) {
        let time = Time::new(&start.time);
        let (sin, cos) = self.sin_cos(&time);
        let mut states = [T::zero(); LARGEST_DIMENSION];
        for (entry, [c, s, one]) in states.iter_mut().zip(&start.state) {
            let number = |it| rounded::<T>(&BigReal::new(it, bits_for::<T>()));
            *entry = number(c) * cos + number(s) * sin + number(one);
        }
        (time, self.complete(&states[..start.state.len()], &time))
    }
}

impl<T: Number> Run<'_, T> {
    /// Begins the run, with the errors of the start where they are followed.
    pub(super) fn begin(&mut self, enclosure: Option<Enclosure<T::Bound>>) {
        self.start = self.event(What::Start, self.entered, &self.state);
        self.start.errors = enclosure.as_ref().map(|it| self.errors(it));
        self.last.clone_from(&self.start);
        self.enclosure = enclosure;
        self.enter();
    }
}
