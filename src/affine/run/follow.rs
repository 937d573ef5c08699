//! The exact continuation of each record of a run that someone else has made, an integrator's: from
//! that record on, the events that the model has next.
//!
//! What is zero at a record by the model, such as the gap after an impact, is a rounded number in
//! its state. A follower carries these structural zeros along the events of the records.

use super::Run;
use super::crossed::low_bits;
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
        let known = Some(run.node);
        Ok(Follower { run, mode: start.mode, zeros, known, undecided_before: 0 })
    }
}

impl<T: Number> Follower<'_, T> {
    /// The mode of the present record.
    #[must_use]
    pub fn mode(&self) -> usize {
        self.mode
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
        let zero = ZeroGuards { guards: graph.tied(node, zero, at_entry), point: None };
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
    /// values in its state.
    pub fn imposed(&mut self, time: f64, state: &[f64]) -> Vec<Imposed> {
        let solver = self.run.solver;
        let node = self.node();
        let orders = self.run.graph.node(node).multiplicities.clone();
        let own = &solver.modes[self.mode];
        let entry = own.flow.modal(&solver.complete_f64(time, state).1);
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
    /// time.
    ///
    /// A guard of an `until` that is positive there, not by the model alone, fires at once, unless
    /// it is one of `late`, as bits: those are on their way back, and fire after they have been
    /// inside.
    pub fn go_on(&mut self, time: f64, state: &[f64], until: f64, late: u64) {
        let node = self.node();
        let run = &mut self.run;
        let solver = run.solver;
        (run.node, self.undecided_before) = (node, run.work.undecidable);
        (run.entered, run.state) = solver.complete_f64(time, state);
        run.horizon = T::exact(until);
        run.queue.clear();
        (run.ended, run.events_in_instant, run.restitution) = (false, 0, None);
        let until_guards = low_bits(solver.system.modes[self.mode].until.len());
        (run.is_lenient, run.returning) = (true, late & until_guards);
        run.last = run.event(What::Start, run.entered, &run.state);
        run.enter();
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

impl<T: Number> Solver<T> {
    /// A time and the state there, which are given in f64.
    fn complete_f64(&self, time: f64, state: &[f64]) -> (Time<T>, Vector<T>) {
        let time = Time { high: T::exact(time), low: T::zero() };
        let states: Vec<T> = state.iter().map(|it| T::exact(*it)).collect();
        (time, self.complete(&states, &time))
    }
}
