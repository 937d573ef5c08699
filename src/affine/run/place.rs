//! Places at which a run may be cut: a run that begins there goes on as the one that came there,
//! and knows what is zero by the model.

use super::Run;
use crate::affine::arithmetic::clock::Time;
use crate::affine::model::error::SystemError;
use crate::affine::model::system::StartPoint;
use crate::affine::solver::Solver;
use crate::affine::solver::event::{Ending, What};
use crate::affine::solver::start_cache::{RunStart, zeros_at_start};
use crate::affine::zeros::graph::ZeroGuards;
use crate::affine::zeros::space::ZeroSpace;
use crate::numeric::number::Number;

/// A mode, a time and a state, with the structural zeros that hold there.
#[derive(Clone, Debug)]
pub struct Place<T> {
    /// The index of the mode that goes on.
    pub mode: usize,
    /// The time.
    pub time: Time<T>,
    /// The states, without cos theta, sin theta and 1.
    pub state: Vec<T>,
    zeros: ZeroSpace,
}

impl<T: Number> Place<T> {
    /// A place in the same mode, with the same structural zeros, at another time and state, which
    /// may be numbers of another kind.
    #[must_use]
    pub fn moved_to<U: Number>(&self, time: Time<U>, state: Vec<U>) -> Place<U> {
        Place { mode: self.mode, time, state, zeros: self.zeros.clone() }
    }
}

impl<T: Number> Solver<T> {
    /// The place of a start.
    ///
    /// # Errors
    /// A start in no mode, with more or fewer states than the system has, or whose structural zeros
    /// cannot be decided.
    pub fn place(&self, start: &StartPoint) -> Result<Place<T>, SystemError> {
        let run = self.at_start(start, T::zero())?;
        let state = run.state[..self.system.states.len()].to_vec();
        let zeros = run.graph.node(run.node).zeros().clone();
        Ok(Place { mode: start.mode, time: run.entered, state, zeros })
    }

    /// The place of a start of which some states, by their indices, may be moved: what is zero
    /// there by the model holds wherever they are.
    ///
    /// # Errors
    /// A start in no mode, with more or fewer states than the system has, or whose structural zeros
    /// cannot be decided.
    pub fn place_free_in(
        &self,
        start: &StartPoint,
        free: &[usize],
    ) -> Result<Place<T>, SystemError> {
        let zeros = zeros_at_start(&self.system, start, free);
        let item = || SystemError::Undecidable { item: "start".to_owned() };
        Ok(Place { zeros: zeros.ok_or_else(item)?, ..self.place(start)? })
    }

    /// Whether a motion may begin at a place: no guard of its mode is positive there.
    #[must_use]
    pub fn admits(&self, place: &Place<T>) -> bool {
        let run = self.run_at(place, place.time);
        !matches!(run.ending(), Some(Ending::BeyondGuard))
    }

    /// A run from a place up to a time.
    #[must_use]
    pub fn run_at(&self, place: &Place<T>, until: Time<T>) -> Run<'_, T> {
        let mut graph = self.pool.lend();
        let node = graph.at_start(place.mode, &place.zeros, None);
        let state = self.complete(&place.state, &place.time);
        let start = RunStart { node, time: place.time, state };
        let mut run = self.not_begun(graph, start, until);
        run.begin(None);
        run
    }
}

impl<T: Number> Run<'_, T> {
    /// The place of the last event, or of the horizon; none between two events of one instant, and
    /// where a run has ended before its horizon.
    #[must_use]
    pub fn place(&mut self) -> Option<Place<T>> {
        if !self.queue.is_empty() {
            return None;
        }
        let node = self.graph.node(self.node);
        let until = self.solver.system.modes[node.mode].until.len();
        let zeros = match self.last.what {
            What::Start | What::Until(..) | What::Limit(..) => node.zeros().clone(),
            What::Watch(_, watch) => self.zeros_along(1 << (until + watch)),
            // No time has passed since the entry, all of whose zeros are there still.
            What::End(Ending::Horizon) if self.is_at_entry() => node.zeros().clone(),
            What::End(Ending::Horizon) => self.zeros_along(0),
            What::End(_) => return None,
        };
        let (mode, time, state) = (self.last.mode, self.last.time, self.last.state.clone());
        Some(Place { mode, time, state, zeros })
    }

    fn is_at_entry(&self) -> bool {
        self.last.time.since(&self.entered).value() == T::zero()
    }

    /// The structural zeros at a point of the segment where these guards, as bits, are zero.
    fn zeros_along(&mut self, guards: u64) -> ZeroSpace {
        let zero = ZeroGuards { guards, point: None };
        let tied = self.graph.tied_guards(self.node, zero, false);
        self.graph.zeros_with(self.node, ZeroGuards { guards: tied, point: None }, false)
    }

    /// Sets the horizon of a run to a later time, whether it has come to its present one or not.
    pub fn go_on_to(&mut self, until: Time<T>) {
        if !self.ended || self.go_on(until.high) {
            self.horizon = until;
        }
    }
}
