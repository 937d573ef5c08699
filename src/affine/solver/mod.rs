//! A solver: a system prepared for runs in one arithmetic.
//!
//! The solver has each mode's closed form and guards in the numbers of that arithmetic. What runs
//! have learned of the system is kept for the runs that follow: its structural zeros in [`pool`],
//! and the starts that they had in [`start_cache`]. [`event`] says what a run gives out. Read this
//! file first, then `event`.

pub mod event;
pub mod pool;
pub mod start_cache;

use crate::affine::arithmetic::clock::{Clock, Time};
use crate::affine::arithmetic::real::{BigReal, bits_for};
use crate::affine::arithmetic::vector::{Vector, rounded};
use crate::affine::closed_form::bound;
use crate::affine::closed_form::flow::ModeFlow;
use crate::affine::guards::row::ModalRow;
use crate::affine::modal;
use crate::affine::model::error::SystemError;
use crate::affine::model::system::{LARGEST_DIMENSION, Row, Successor, System, Until, is_unit};
use crate::affine::zeros::exact_mode::ExactMode;
use crate::affine::zeros::graph::ZeroGraph;
use crate::dynamics::parallel;
use crate::numeric::number::{Bound, Number};
use event::Event;
use pool::CachePool;
use std::sync::OnceLock;

/// A piecewise-affine system in closed form, in one arithmetic.
#[derive(Clone, Debug)]
pub struct Solver<T: Number> {
    pub(super) system: System,
    pub(super) modes: Vec<SolverMode<T>>,
    pub(super) clock: Option<Clock<T>>,
    pub(super) pool: CachePool<T>,
    pub(super) backward: bool,
}

/// A mode prepared for runs in one arithmetic.
#[derive(Clone, Debug)]
pub(super) struct SolverMode<T: Number> {
    pub flow: ModeFlow<T>,
    /// The mode's matrix M.
    pub matrix: Vec<Vector<T>>,
    /// The mode's guards: those of `until`, then those of `watch`.
    pub guards: Vec<ModalRow<T>>,
    /// The rows of the mode's guards, in the entries of z.
    pub rows: Vec<Vector<T>>,
    /// The matrices of the resets of `until`, then those of their limits.
    pub resets: Vec<Vec<Vector<T>>>,
    /// For each reset, the entries of z that it changes, with their rows.
    pub changes: Vec<Vec<Change<T>>>,
    /// For each `until`, whether it may accumulate and its guard stays zero across its reset.
    pub stays_zero: Vec<bool>,
    /// For each `until`, whether its reset changes nothing where its guard is zero.
    pub changes_nothing: Vec<bool>,
    /// The conditions of the successors of each reset, in the co-ordinates of their modes.
    pub conditions: Vec<Vec<Option<ModalRow<T>>>>,
    /// The rows of those conditions, in the entries of z.
    pub condition_rows: Vec<Vec<Option<Vector<T>>>>,
    /// The mode's rows in exact arithmetic, once a run asks for them.
    pub exact: OnceLock<ExactMode>,
}

/// An entry of z that a reset changes, and the factors of the entries before it.
pub(super) type Change<T> = (usize, Vec<(usize, T)>);

impl<T: Number> Solver<T> {
    /// Prepares a system for runs: decomposes the matrix of each mode.
    ///
    /// # Errors
    /// A system that [`System::check`] refuses, or whose structural zeros cannot be decided.
    pub fn new(system: &System) -> Result<Self, SystemError> {
        Self::prepare(system, false)
    }

    /// A solver that runs back in time: its times decrease, only watched guards are events, and it
    /// ends where the guard of an `until` would become positive.
    ///
    /// # Errors
    /// A system that [`System::check`] refuses, or whose structural zeros cannot be decided.
    pub fn backward(system: &System) -> Result<Self, SystemError> {
        Self::prepare(system, true)
    }

    /// A solver that runs forward, as [`Solver::new`] makes it, or [backward](Solver::backward).
    ///
    /// # Errors
    /// A system that [`System::check`] refuses, or whose structural zeros cannot be decided.
    pub fn prepare(system: &System, backward: bool) -> Result<Self, SystemError> {
        system.check()?;
        let system = if backward { system.reversed() } else { system.clone() };
        let blocks = parallel::map(&system.modes, |mode| {
            bound::ordered(modal::blocks(&mode.matrix, system.time_scale, bits_for::<T>()))
        });
        let graph = ZeroGraph::new(&system);
        let graph = graph.ok_or_else(|| SystemError::Undecidable { item: system.name.clone() })?;
        let flows: Vec<ModeFlow<T>> = parallel::map(&blocks, |it| ModeFlow::new(it));
        let row = |row: &Row, mode: usize| ModalRow::new(row, &flows[mode], &blocks[mode]);
        let mode = |n: &usize| {
            let (n, mode) = (*n, &system.modes[*n]);
            let guards: Vec<_> = mode.guards().collect();
            let guard = |guard: &&Row| {
                let twin = guards.iter().position(|it| it == guard).unwrap_or_default();
                ModalRow { twin, ..row(guard, n) }
            };
            let conditions = mode.exits().map(|(_, next)| {
                let condition = |it: &Successor| it.when.as_ref().map(|when| row(when, it.mode));
                next.iter().map(condition).collect()
            });
            let plain = |it: &Successor| it.when.as_ref().map(|when| numbers(when));
            let condition_rows = mode.exits().map(|(_, next)| next.iter().map(plain).collect());
            let resets = mode.exits().map(|(reset, _)| reset.iter().map(numbers).collect());
            let stays_zero = |it: &Until| it.accumulates_to.is_some() && it.keeps_guard_zero();
            SolverMode {
                flow: flows[n].clone(),
                matrix: mode.matrix.iter().map(numbers).collect(),
                guards: guards.iter().map(guard).collect(),
                rows: guards.iter().map(|it| numbers(it)).collect(),
                resets: resets.collect(),
                changes: mode.exits().map(|(reset, _)| changes(reset)).collect(),
                changes_nothing: mode.until.iter().map(Until::changes_nothing).collect(),
                stays_zero: mode.until.iter().map(stays_zero).collect(),
                conditions: conditions.collect(),
                condition_rows: condition_rows.collect(),
                exact: OnceLock::new(),
            }
        };
        let modes = parallel::map(&Vec::from_iter(0..system.modes.len()), mode);
        let clock = system.forcing.as_ref().map(Clock::new);
        Ok(Self { modes, clock, pool: CachePool::new(graph), backward, system })
    }

    /// Resets entries of z, or changes of them, as the reset of this number of a mode does: those
    /// of `until` come first, then those of their limits.
    #[inline]
    pub(super) fn reset(&self, mode: usize, number: usize, z: &mut Vector<T>) {
        let before = *z;
        for (n, factors) in &self.modes[mode].changes[number] {
            let terms = factors.iter().map(|(k, factor)| *factor * before[*k]);
            z[*n] = terms.fold(T::zero(), |sum, term| sum + term);
        }
    }

    /// The state at a time in the segment that an event of a run of this solver begins.
    #[must_use]
    pub fn state_at(&self, event: &Event<T>, time: &Time<T>) -> Vec<T> {
        let Time { high, low } = time.since(&event.time);
        let [elapsed, rest] = [high, low].map(|it| self.directed(it));
        let flow = &self.modes[event.mode].flow;
        let modal = flow.modal(&self.complete(&event.state, &event.time));
        let mut state = flow.state_shortly_after(flow.at(&modal, elapsed), rest).to_vec();
        state.truncate(self.system.states.len());
        state
    }

    /// Whether the solver runs back in time.
    #[must_use]
    pub fn is_backward(&self) -> bool {
        self.backward
    }

    /// The system that is solved; a backward solver has the [reversed](System::reversed) one.
    #[must_use]
    pub fn system(&self) -> &System {
        &self.system
    }

    /// A difference of times as the time that a run takes for it, or the other way round: they
    /// have different signs where runs go back.
    #[inline]
    pub(super) fn directed(&self, time: T) -> T {
        if self.backward { -time } else { time }
    }

    /// The states at a time with cos theta, sin theta and 1 appended.
    pub(in crate::affine) fn complete(&self, states: &[T], time: &Time<T>) -> Vector<T> {
        let mut state = [T::zero(); LARGEST_DIMENSION];
        state[..states.len()].copy_from_slice(states);
        let (sin, cos) = self.sin_cos(time);
        self.append(&mut state, sin, cos);
        state
    }

    /// Sine and cosine of the forcing angle at a time; 0 and 1 where nothing is forced.
    #[inline]
    pub(super) fn sin_cos(&self, time: &Time<T>) -> (T, T) {
        match &self.clock {
            Some(clock) if self.backward => {
                let time = Time { high: -time.high, low: -time.low };
                clock.sin_cos(&time)
            }
            Some(clock) => clock.sin_cos(time),
            None => (T::zero(), T::one()),
        }
    }

    /// Appends cos theta, sin theta and 1 to the states, which come first.
    #[inline]
    pub(super) fn append(&self, state: &mut Vector<T>, sin: T, cos: T) {
        let (states, dimension) = (self.system.states.len(), self.system.dimension());
        state[dimension - 1] = T::one();
        if dimension > states + 1 {
            state[states] = cos;
            state[states + 1] = sin;
        }
    }

    /// The exact rows of a mode.
    pub(super) fn exact_mode(&self, mode: usize) -> &ExactMode {
        let own = &self.modes[mode];
        own.exact.get_or_init(|| ExactMode::new(&self.system, &self.system.modes[mode]))
    }

    /// The place of cos theta in z, which sin theta follows, where the system is forced.
    pub(super) fn phase(&self) -> Option<usize> {
        self.clock.as_ref().map(|_| self.system.states.len())
    }

    /// Bounds of the errors that the rounding of the time makes in cos theta and sin theta, as
    /// errors of z.
    pub(super) fn phase_roundings(&self, time: &Time<T>) -> Vector<T::Bound> {
        let mut errors = [T::Bound::ZERO; LARGEST_DIMENSION];
        if let Some(clock) = &self.clock {
            let states = self.system.states.len();
            errors[states..states + 2].fill(clock.rounding(time));
        }
        errors
    }
}

/// A row in the arithmetic.
pub(super) fn numbers<T: Number>(row: &Row) -> Vector<T> {
    let mut vector = [T::zero(); LARGEST_DIMENSION];
    for (entry, number) in vector.iter_mut().zip(row) {
        *entry = rounded(&BigReal::new(number, bits_for::<T>()));
    }
    vector
}

/// The rows of a reset that are not those of the identity, without their zeros.
fn changes<T: Number>(reset: &[Row]) -> Vec<Change<T>> {
    let factors = |row: &Row| {
        let there = row.iter().enumerate().filter(|(_, it)| !it.is_zero());
        there.map(|(k, it)| (k, rounded(&BigReal::new(it, bits_for::<T>())))).collect()
    };
    let changed = reset.iter().enumerate().filter(|(n, row)| !is_unit(row, *n));
    changed.map(|(n, row)| (n, factors(row))).collect()
}
