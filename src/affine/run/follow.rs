//! The exact continuation of each record of a run that someone else has made, an integrator's: from
//! that record on, the events that the model has next.
//!
//! What is zero at a record by the model, such as the gap after an impact, is a rounded number in
//! its state. A follower carries these structural zeros along the events of the records.

use super::Run;
use super::crossed::low_bits;
use super::turn::LastOfCycle;
use crate::affine::arithmetic::clock::Time;
use crate::affine::arithmetic::vector::Vector;
use crate::affine::model::error::SystemError;
use crate::affine::model::system::StartPoint;
use crate::affine::solver::Solver;
use crate::affine::solver::event::{Event, What};
use crate::affine::zeros::graph::{Firing, ZeroGuards};
use crate::affine::zeros::space::ZeroSpace;
use crate::numeric::number::Number;

/// A follower of a run's records.
pub struct Follower<'a, T: Number> {
    run: Run<'a, T>,
    mode: usize,
    /// The structural zeros at the present record, and the node that they had when last asked for.
    zeros: ZeroSpace,
    known: Option<usize>,
    /// The present record, as it was handed over last.
    record: Event<T>,
    /// The number of decisions that rounding had left open when the continuation began.
    undecided_before: u64,
}

/// The event of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Followed {
    /// The present mode ends by its `until` of this index, and this mode follows.
    Until(usize, usize),
    /// The `watch` of this index of the present mode is crossed.
    Watch(usize),
}

/// A derivative of a guard, its value at order 0, that is zero by the model at a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Imposed {
    /// The guard: those of `until` first, then those of `watch`.
    pub guard: usize,
    /// The order of the derivative.
    pub order: usize,
    /// Its value in the record's state.
    pub value: f64,
}

impl<T: Number> Solver<T> {
    /// A follower of a run that begins so.
    ///
    /// # Errors
    /// A start in no mode, with more or fewer states than the system has, or whose structural zeros
    /// cannot be decided.
    pub fn follow(&self, start: &StartPoint) -> Result<Follower<'_, T>, SystemError> {
        let run = self.at_start(start, T::zero())?;
        let zeros = run.graph.node(run.node).zeros().clone();
        let (known, record) = (Some(run.node), run.event(What::Start, run.entered, &run.state));
        Ok(Follower { run, mode: start.mode, zeros, known, record, undecided_before: 0 })
    }
}

impl<T: Number> Follower<'_, T> {
    /// The mode of the present record.
    #[must_use]
    pub fn mode(&self) -> usize {
        self.mode
    }

    /// Takes the mode and the structural zeros of another follower of the same run.
    pub fn adopt<U: Number>(&mut self, other: &Follower<'_, U>) {
        (self.mode, self.zeros, self.known) = (other.mode, other.zeros.clone(), None);
    }

    /// Forgets what is zero: the records before this one say nothing of its state.
    pub fn forget(&mut self, mode: usize) {
        (self.mode, self.zeros, self.known) = (mode, ZeroSpace::default(), None);
    }

    /// Takes these guards of the present mode, as bits, for zero at the present record.
    pub fn impose(&mut self, guards: u64) {
        self.zeros = self.run.graph.with_guards(self.mode, &self.zeros, guards);
        self.known = None;
    }

    /// Goes on to the record of an event: what is zero there are the zeros that last along the
    /// segment, or all those of its beginning `at_entry`, and the event's guard with those that are
    /// zero where it is, as the reset leaves them. Says whether the present mode has such an event
    /// and such a successor; where it has not, nothing changes.
    #[must_use]
    pub fn pass(&mut self, event: Followed, at_entry: bool) -> bool {
        let solver = self.run.solver;
        let own = &solver.system.modes[self.mode];
        let node = self.node();
        let graph = &mut self.run.graph;
        let guard = match event {
            Followed::Until(until, _) if until < own.until.len() => until,
            Followed::Watch(watch) if watch < own.watch.len() => own.until.len() + watch,
            _ => return false,
        };
        let zero = ZeroGuards { guards: 1 << guard, point: None };
        let zero = ZeroGuards { guards: graph.tied_guards(node, zero, at_entry), point: None };
        let Followed::Until(until, mode) = event else {
            (self.zeros, self.known) = (graph.zeros_with(node, zero, at_entry), None);
            return true;
        };
        let successor = own.until[until].next.iter().position(|it| it.mode == mode);
        let Some(successor) = successor else { return false };
        let next = graph.enter(node, Firing { until, zero, at_entry }, successor);
        (self.mode, self.zeros, self.known) = (mode, graph.node(next).zeros().clone(), Some(next));
        true
    }

    /// The derivatives of guards that are zero by the model at the present record, with their
    /// values in its state; `elapsed` is its time since the run's start.
    pub fn imposed(&mut self, elapsed: f64, state: &[f64]) -> Vec<Imposed> {
        let solver = self.run.solver;
        let node = self.node();
        let orders = self.run.graph.node(node).multiplicities.clone();
        let own = &solver.modes[self.mode];
        let entry = own.flow.modal(&self.complete(elapsed, state).1);
        let mut imposed = Vec::new();
        for (guard, (row, order)) in own.guards.iter().zip(orders.iter()).enumerate() {
            for order in 0..order.unwrap_or(row.last) {
                let value = row.order(order, &entry).0.to_f64();
                imposed.push(Imposed { guard, order, value });
            }
        }
        imposed
    }

    /// Begins the exact continuation of the present record, whose time and state are given, up to a
    /// time; both are times since the run's start.
    ///
    /// A guard of an `until` that is positive there, not by the model alone, fires at once, unless
    /// it is one of `late`, as bits: those are on their way back, and fire after they have been
    /// inside.
    pub fn go_on(&mut self, elapsed: f64, state: &[f64], until: f64, late: u64) {
        let node = self.node();
        let begin = self.complete(elapsed, state);
        let horizon = self.time(until).value();
        let run = &mut self.run;
        let solver = run.solver;
        (run.node, self.undecided_before) = (node, run.work.undecidable);
        (run.entered, run.state) = begin;
        run.horizon = Time { high: horizon, low: T::zero() };
        run.queue.clear();
        (run.ended, run.events_in_instant, run.restitution) = (false, 0, None);
        let until_guards = low_bits(solver.system.modes[self.mode].until.len());
        (run.is_lenient, run.returning) = (true, late & until_guards);
        (run.limit_ahead, run.is_silent) = (None, false);
        (run.last_of_cycle, run.flight) = (LastOfCycle::default(), None);
        run.last = run.event(What::Start, run.entered, &run.state);
        self.record.clone_from(&run.last);
        run.enter();
    }

    /// Goes past an event of the present continuation as if it had not happened: begins anew at
    /// this time after it, in the same mode. The guards of `past`, as bits, are outside and fire
    /// after they have been inside.
    pub fn go_past(&mut self, elapsed: f64, until: f64, past: u64) {
        let state: Vec<f64> = self.along(elapsed).iter().map(|it| it.to_f64()).collect();
        let node = self.node();
        let none = ZeroGuards { guards: 0, point: None };
        let lasting = self.run.graph.zeros_with(node, none, false);
        let zeros = std::mem::replace(&mut self.zeros, lasting);
        self.known = None;
        self.go_on(elapsed, &state, until, past);
        (self.zeros, self.known) = (zeros, Some(node));
    }

    /// The state at a time since the run's start, if the mode that the present record begins went
    /// on without an event.
    #[must_use]
    pub fn along(&self, elapsed: f64) -> Vec<T> {
        self.run.solver.state_at(&self.record, &self.time(elapsed))
    }

    /// The time of an event since the run's start.
    #[must_use]
    pub fn elapsed(&self, event: &Event<T>) -> f64 {
        let elapsed = event.time.since(&self.run.start.time).value().to_f64();
        if self.run.solver.backward { -elapsed } else { elapsed }
    }

    /// The node of the structural zeros at the present record.
    fn node(&mut self) -> usize {
        let node = self.run.graph.at_start(self.mode, &self.zeros, self.known);
        self.known = Some(node);
        node
    }

    /// Whether rounding has left nothing open in the continuation so far.
    #[must_use]
    pub fn is_decided(&self) -> bool {
        self.run.work.undecidable == self.undecided_before
    }

    /// Whether a guard fires at the instant at which the continuation stands.
    #[must_use]
    pub fn fires_at_once(&self) -> bool {
        self.run.at_entry != 0
    }
}

/// The events of the continuation, the ending included.
impl<T: Number> Iterator for Follower<'_, T> {
    type Item = Event<T>;

    fn next(&mut self) -> Option<Event<T>> {
        self.run.next()
    }
}

impl<T: Number> Follower<'_, T> {
    /// The clock's time when this much has elapsed since the run's start.
    fn time(&self, elapsed: f64) -> Time<T> {
        let ahead = if self.run.solver.backward { -elapsed } else { elapsed };
        self.run.start.time.after(T::exact(ahead))
    }

    /// A time and the state there, which are given in f64.
    fn complete(&self, elapsed: f64, state: &[f64]) -> (Time<T>, Vector<T>) {
        let time = self.time(elapsed);
        let states: Vec<T> = state.iter().map(|it| T::exact(*it)).collect();
        (time, self.run.solver.complete(&states, &time))
    }
}
