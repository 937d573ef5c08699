//! A run: segments joined at their events, by the rules of docs/SYSTEM_FORMAT.md.

use super::clock::Time;
use super::enclosure::{EnclosedCrossing, Enclosure};
use super::event::{Ending, Errors, Event, What};
use super::flow::Flow;
use super::known::Loan;
use super::point::{Ends, Passed, Segment};
use super::search::Found;
use super::solver::{self, Solver};
use super::structure::Firing;
use super::system::{Direction, LARGEST_DIMENSION, StartPoint};
use super::track::{SearchWork, Track};
use super::vector::{UNDERFLOW, Vector, dot, rounded, unit};
use crate::number::Number;
use std::collections::VecDeque;

/// How many events of `until` one instant may have.
const MOST_AT_ONCE: u32 = 64;

/// A run of a solver, as an iterator over its events; the last one is an [`Ending`].
pub struct Run<'a, T> {
    pub(super) solver: &'a Solver<T>,
    pub(super) structure: Loan<'a, T>,
    work: SearchWork,
    horizon: T,
    pub(super) node: usize,
    /// The time at which the segment was entered, and the state there.
    entered: Time<T>,
    state: Vector<T>,
    /// Each guard, with the place from which its search goes on.
    tracks: Vec<Track>,
    ends: Ends<T>,
    segment: Option<Segment<'a, T>>,
    pub(super) modal: Vector<T>,
    /// The coefficient of restitution of an impact, from its fastest occurrence.
    pub(super) restitution: Option<Restitution<T>>,
    /// Guards that fire at the instant of entry.
    at_entry: u64,
    at_once: u32,
    queue: VecDeque<Event<T>>,
    ended: bool,
    /// The errors at the entry of the segment, where they are followed.
    pub(super) enclosure: Option<Enclosure>,
    /// The start, with the errors that it has before the rounding of its modal co-ordinates.
    start: Event<T>,
    /// The event that was given out last, or the start.
    last: Event<T>,
}

/// The quotient of the rates after and before an impact, from its fastest occurrence.
#[derive(Clone, Copy, Debug)]
pub(super) struct Restitution<T> {
    pub node: usize,
    pub until: usize,
    pub rate: f64,
    pub quotient: T,
}

impl<T: Number> Solver<T> {
    /// A run from a start up to a time.
    ///
    /// # Errors
    /// A start whose structural zeros cannot be told.
    pub fn run(&self, start: &StartPoint, until: T) -> Option<Run<'_, T>> {
        let mut run = self.at_start(start, until)?;
        run.begin(None);
        Some(run)
    }

    /// A run that follows its own errors: each event has bounds of them, and what they leave open
    /// ends the run as undecided.
    ///
    /// # Errors
    /// A start whose structural zeros cannot be told.
    pub fn run_enclosed(&self, start: &StartPoint, until: T) -> Option<Run<'_, T>> {
        let mut run = self.at_start(start, until)?;
        // Three products and two sums an entry; sine and cosine are good to two units.
        let error = |size: T| 8.0 * unit::<T>() * size.to_f64().abs();
        let mut sizes = [0.0; LARGEST_DIMENSION];
        for (size, entry) in sizes.iter_mut().zip(&run.state) {
            *size = error(*entry);
        }
        for (size, terms) in sizes.iter_mut().zip(&start.state) {
            let terms = terms.iter().map(|it| it.to_f64().value().abs());
            *size += error(T::exact(terms.sum()));
        }
        sizes[self.system.dimension() - 1] = 0.0;
        run.begin(Some(Enclosure::of(&sizes)));
        Some(run)
    }

    /// A run whose first segment is not entered yet.
    fn at_start(&self, start: &StartPoint, until: T) -> Option<Run<'_, T>> {
        let mut structure = self.known.lend();
        let begun = structure.begun(&self.system, start, || self.worked_out(start))?;
        let mode = start.mode;
        let first =
            Event { what: What::Start, time: begun.time, state: Vec::new(), mode, errors: None };
        Some(Run {
            solver: self,
            structure,
            work: SearchWork::default(),
            horizon: until,
            node: begun.node,
            entered: begun.time,
            state: begun.state,
            tracks: Vec::new(),
            ends: Ends::default(),
            segment: None,
            modal: [T::zero(); LARGEST_DIMENSION],
            restitution: None,
            at_entry: 0,
            at_once: 0,
            queue: VecDeque::new(),
            ended: false,
            enclosure: None,
            start: first.clone(),
            last: first,
        })
    }

    /// Time and state of a start.
    fn worked_out(&self, start: &StartPoint) -> (Time<T>, Vector<T>) {
        let time = Time::of(&start.time);
        let (sin, cos) = self.sin_cos(&time);
        let mut states = [T::zero(); LARGEST_DIMENSION];
        for (entry, [c, s, one]) in states.iter_mut().zip(&start.state) {
            let number = |it| rounded::<T>(&super::modal::BigReal::of(it));
            *entry = number(c) * cos + number(s) * sin + number(one);
        }
        (time, self.complete(&states[..start.state.len()], &time))
    }

    /// The states at a time with cos theta, sin theta and 1 appended.
    pub(super) fn complete(&self, states: &[T], time: &Time<T>) -> Vector<T> {
        let mut state = [T::zero(); LARGEST_DIMENSION];
        state[..states.len()].copy_from_slice(states);
        let (sin, cos) = self.sin_cos(time);
        complete(&mut state, self, sin, cos);
        state
    }

    #[inline]
    fn sin_cos(&self, time: &Time<T>) -> (T, T) {
        match &self.clock {
            Some(clock) if self.backward => {
                let time = Time { high: -time.high, low: -time.low };
                clock.sin_cos(&time)
            }
            Some(clock) => clock.sin_cos(time),
            None => (T::zero(), T::one()),
        }
    }
}

impl<T: Number> Run<'_, T> {
    /// The start, as an event at which nothing happens but that the run begins.
    #[must_use]
    pub fn start(&self) -> Event<T> {
        self.start.clone()
    }

    /// What the run has cost so far.
    #[must_use]
    pub fn work(&self) -> SearchWork {
        self.work
    }

    pub(super) fn tracks_live(&self, guard: usize) -> bool {
        self.tracks[guard].live
    }

    /// Begins the run, with the errors of the start where they are followed.
    fn begin(&mut self, enclosure: Option<Enclosure>) {
        self.start = self.event(What::Start, self.entered, &self.state);
        self.start.errors = enclosure.as_ref().map(|it| self.errors(it));
        self.last.clone_from(&self.start);
        self.enclosure = enclosure;
        self.enter();
    }

    /// Begins the segment of the present node: looks at each guard's first derivative that is not a
    /// structural zero.
    fn enter(&mut self) {
        let node = self.structure.node(self.node);
        let mode = node.mode;
        let solver = self.solver;
        let solver_mode = &solver.modes[mode];
        let flow = &solver_mode.flow;
        let until = solver.system.modes[mode].until.len();
        self.modal = flow.modal(&self.state);
        self.tracks.clear();
        self.at_entry = 0;
        let mut ending = None;
        for (n, (row, order)) in
            solver_mode.guards.iter().zip(node.multiplicities.iter()).enumerate()
        {
            let Some(order) = *order else {
                self.tracks.push(Track { outward: 1.0, zeros: 0, live: false });
                continue;
            };
            let (value, size) = row.order(order, &self.modal);
            let value = value.to_f64();
            let mut slack = (flow.dimension + 4) as f64 * unit::<T>() * size;
            if let Some(errors) = &self.enclosure {
                slack += errors.of_row(flow, row, order);
            }
            let doubtful = value.abs() <= slack;
            self.work.undecidable += u64::from(doubtful);
            let outward = if n >= until && value > 0.0 { -1.0 } else { 1.0 };
            self.tracks.push(Track { outward, zeros: order, live: true });
            if n < until && value > 0.0 {
                if order == 0 && !doubtful {
                    ending = ending.or(Some(Ending::BeyondGuard));
                } else if solver.backward {
                    ending = ending.or(Some(Ending::LeavesDomain));
                }
                self.at_entry |= 1 << n;
            }
        }
        if let Some(ending) = ending {
            self.end(ending);
        }
        if let Some(errors) = &mut self.enclosure {
            errors.add_entry(flow, &self.state, unit::<T>());
        }
        let inherited = self.enclosure.as_ref().map_or_else(Vec::new, |errors| {
            solver_mode.guards.iter().map(|row| errors.along(flow, row)).collect()
        });
        let segment = Segment::new(flow, &solver_mode.guards, self.modal, &self.tracks, inherited);
        segment.begin(&mut self.ends.left);
        self.ends.passed = Passed::none();
        self.segment = Some(segment);
    }

    /// Ends the run: at an instant of its own, which is then the entry, or at that of the last
    /// event.
    fn end(&mut self, ending: Ending<T>) {
        if self.ended {
            return;
        }
        self.ended = true;
        let what = What::End(ending);
        let event = if matches!(ending, Ending::Horizon | Ending::LeavesDomain) {
            let errors = self.enclosure.as_ref().map(|it| self.errors(it));
            Event { errors, ..self.event(what, self.entered, &self.state) }
        } else {
            Event { what, ..self.queue.back().unwrap_or(&self.last).clone() }
        };
        self.queue.push_back(event);
    }

    #[inline]
    fn event(&self, what: What<T>, time: Time<T>, state: &Vector<T>) -> Event<T> {
        let states = self.solver.system.states.len();
        let mode = self.structure.node(self.node).mode;
        Event { what, time, state: state[..states].to_vec(), mode, errors: None }
    }

    fn errors(&self, enclosure: &Enclosure) -> Errors {
        let states = self.solver.system.states.len();
        let rounding = 2.0 * unit::<T>() * self.entered.high.to_f64().abs();
        Errors { time: enclosure.time() + rounding, state: enclosure.state()[..states].to_vec() }
    }

    /// Goes on to the next event.
    fn advance(&mut self) {
        if self.at_entry != 0 {
            let guards = self.structure.tied(self.node, self.at_entry, true);
            let until = self.at_entry.trailing_zeros() as usize;
            self.fire(Firing { until, guards, at_entry: true }, self.entered, self.state);
            return;
        }
        let mode = self.structure.node(self.node).mode;
        let limit = self.limit();
        let Some(segment) = &self.segment else { return self.end(Ending::Undecided) };
        let ends = &mut self.ends;
        match segment.first(&mut self.tracks, ends, limit, &mut self.work) {
            Found::Lost => self.end(Ending::Undecided),
            Found::Nothing => {
                let limit = if limit > T::zero() { limit } else { T::zero() };
                segment.evaluate(&mut ends.left, limit, &mut self.work);
                segment.complete(&mut ends.left);
                self.at_horizon(mode, limit);
            }
            Found::Crossing(guards) => {
                segment.complete(&mut ends.left);
                self.crossed(guards);
            }
        }
    }

    /// The run ends a time after the entry.
    fn at_horizon(&mut self, mode: usize, limit: T) {
        (self.entered, self.state) = self.here();
        if limit > T::zero() {
            // The time since an entry long before is rounded; the horizon is not.
            self.entered = Time { high: self.horizon, low: T::zero() };
        }
        let solver::SolverMode { flow, matrix, .. } = &self.solver.modes[mode];
        if let Some(errors) = &self.enclosure {
            let errors = errors.later(flow, limit);
            let rounded = 4.0 * unit::<T>() * limit.to_f64().abs();
            let mut errors = errors.at_given_time(flow, matrix, &self.state, rounded);
            errors.add_box(&roundings(flow, &self.modal, limit));
            self.enclosure = Some(errors);
        }
        self.end(Ending::Horizon);
    }

    /// Time that is left until the horizon.
    #[inline]
    fn limit(&self) -> T {
        let ahead = (self.horizon - self.entered.high) - self.entered.low;
        if self.solver.backward { -ahead } else { ahead }
    }

    /// Time and state where the search has come to.
    #[inline]
    fn here(&self) -> (Time<T>, Vector<T>) {
        let point = &self.ends.left;
        let elapsed = if self.solver.backward { -point.time } else { point.time };
        let mut time = self.entered.after(elapsed);
        let mode = self.structure.node(self.node).mode;
        let solver::SolverMode { flow, matrix, .. } = &self.solver.modes[mode];
        let mut state = flow.state(&point.y);
        if point.later != T::zero() {
            time = time.after(if self.solver.backward { -point.later } else { point.later });
            let before = state;
            let states = &mut state[..self.solver.system.states.len()];
            for (entry, row) in states.iter_mut().zip(matrix) {
                *entry = *entry + dot(row, &before, flow.dimension) * point.later;
            }
        }
        let (sin, cos) = self.solver.sin_cos(&time);
        complete(&mut state, self.solver, sin, cos);
        (time, state)
    }

    /// The guards of these bits are crossed.
    fn crossed(&mut self, guards: u64) {
        let mode = self.structure.node(self.node).mode;
        let until = self.solver.system.modes[mode].until.len();
        let (time, state) = self.here();
        let tied = self.structure.tied(self.node, guards & guards.wrapping_neg(), false);
        self.work.undecidable += u64::from(guards & !tied != 0);
        let errors = self.errors_at(mode, guards, &state);
        for n in bits(guards & !low_bits(until)) {
            self.watched(mode, n, until, time, &state, errors.as_ref());
            self.tracks[n].outward = -self.tracks[n].outward;
        }
        let ending = guards & low_bits(until);
        if ending == 0 {
            if let Some(segment) = &self.segment {
                segment.fill_all(&mut self.ends.left);
            }
            self.tracks.iter_mut().for_each(|track| track.zeros = 0);
            for n in bits(guards) {
                self.tracks[n].zeros = 1;
                self.ends.left.orders[n][0] = T::zero();
            }
            return;
        }
        if self.solver.backward {
            (self.entered, self.state, self.enclosure) = (time, state, errors);
            return self.end(Ending::LeavesDomain);
        }
        let guards = self.structure.tied(self.node, guards, false);
        let until = ending.trailing_zeros() as usize;
        self.enclosure = errors;
        self.fire(Firing { until, guards, at_entry: false }, time, state);
    }

    /// The errors at a crossing, where they are followed.
    fn errors_at(&self, mode: usize, guards: u64, state: &Vector<T>) -> Option<Enclosure> {
        let (enclosure, segment) = (self.enclosure.as_ref()?, self.segment.as_ref()?);
        let point = &self.ends.left;
        let solver_mode = &self.solver.modes[mode];
        let first = guards.trailing_zeros() as usize;
        let inherited = segment.inherited[first]
            * libm::exp(solver_mode.flow.fastest_growth() * point.time.to_f64());
        let mut errors = enclosure.at_crossing(&EnclosedCrossing {
            flow: &solver_mode.flow,
            matrix: &solver_mode.matrix,
            guard: &solver_mode.guards[first],
            y: point.y,
            elapsed: point.time,
            state: *state,
            // The guard is off zero by what was computed, and by what rounding did to that.
            slack: (point.slack[first] - inherited).max(0.0)
                + point.orders[first][0].to_f64().abs()
                + 1e-3 * unit::<T>(),
            unit: unit::<T>(),
        });
        errors.add_box(&roundings(&solver_mode.flow, &segment.entry, point.time));
        Some(errors)
    }

    #[inline]
    fn watched(
        &mut self,
        mode: usize,
        n: usize,
        until: usize,
        time: Time<T>,
        state: &Vector<T>,
        errors: Option<&Enclosure>,
    ) {
        let rising = self.tracks[n].outward > 0.0;
        let counted = match self.solver.system.modes[mode].watch[n - until].direction {
            Direction::Rising => rising,
            Direction::Falling => !rising,
            Direction::Both => true,
        };
        if counted {
            let mut event = self.event(What::Watch(mode, n - until), time, state);
            event.errors = errors.map(|it| self.errors(it));
            self.queue.push_back(event);
        }
    }

    /// An `until` ends the mode: reset, successor, and the entry of the next segment.
    fn fire(&mut self, firing: Firing, time: Time<T>, before: Vector<T>) {
        let solver = self.solver;
        let mode = self.structure.node(self.node).mode;
        self.at_once = if firing.at_entry { self.at_once + 1 } else { 1 };
        let mut state = before;
        for (n, factors) in &solver.modes[mode].changes[firing.until] {
            let terms = factors.iter().map(|(k, factor)| *factor * before[*k]);
            state[*n] = terms.fold(T::zero(), |sum, term| sum + term);
        }
        let successor = self.successor(mode, firing, &state);
        let arrival = self.structure.arrival(self.node, firing);
        let impact = arrival.impact;
        let from = self.node;
        let next = self.structure.enter(from, firing, successor);
        self.node = next;
        (self.entered, self.state) = (time, state);
        let mut event = self.event(What::Until(mode, firing.until), time, &self.state);
        if let Some(errors) = self.enclosure.take() {
            let reset = &solver.modes[mode].resets[firing.until];
            let sizes = reset.iter().map(|row| {
                let terms = row.iter().zip(&before).map(|(a, b)| (a.to_f64() * b.to_f64()).abs());
                (reset.len() + 2) as f64 * unit::<T>() * terms.sum::<f64>()
            });
            let errors = errors.after_reset(reset, &sizes.collect::<Vec<_>>());
            event.errors = Some(self.errors(&errors));
            self.enclosure = Some(errors);
        }
        self.queue.push_back(event);
        self.enter();
        if impact && next == from {
            let below = solver.modes[mode].flow.modal(&before);
            if let Some((earliest, latest)) = self.accumulation(mode, firing, &below, successor) {
                return self.end(Ending::Accumulation(earliest, latest));
            }
        }
        if self.at_once >= MOST_AT_ONCE {
            self.end(Ending::NoProgress);
        }
    }

    /// The first successor whose condition holds.
    #[inline]
    fn successor(&mut self, mode: usize, firing: Firing, state: &Vector<T>) -> usize {
        let solver = self.solver;
        let orders = &self.structure.arrival(self.node, firing).orders;
        let conditions = &solver.modes[mode].conditions[firing.until];
        let next = &solver.system.modes[mode].until[firing.until].next;
        for (n, (condition, order)) in conditions.iter().zip(orders.iter()).enumerate() {
            let (Some(condition), Some(order)) = (condition, *order) else {
                if condition.is_none() {
                    return n;
                }
                continue;
            };
            let flow = &solver.modes[next[n].mode].flow;
            let modal = flow.modal(state);
            let (value, size) = condition.order(order, &modal);
            let value = value.to_f64();
            let mut slack = (flow.dimension + 4) as f64 * unit::<T>() * size;
            if let Some(errors) = &self.enclosure {
                // The errors before the reset bound those after it for all that follows here.
                let reset = &solver.modes[mode].resets[firing.until];
                slack += errors.after_reset(reset, &[]).of_row(flow, condition, order);
            }
            self.work.undecidable += u64::from(value.abs() <= slack);
            if value > 0.0 {
                return n;
            }
        }
        conditions.len() - 1
    }
}

impl<T: Number> Iterator for Run<'_, T> {
    type Item = Event<T>;

    fn next(&mut self) -> Option<Event<T>> {
        loop {
            if let Some(event) = self.queue.pop_front() {
                self.last.clone_from(&event);
                return Some(event);
            }
            if self.ended {
                return None;
            }
            self.advance();
            // What errors may have decided is no event of an enclosed run.
            if self.enclosure.is_some() && self.work.undecidable > 0 {
                self.queue.clear();
                self.ended = false;
                self.end(Ending::Undecided);
            }
        }
    }
}

impl<T: Number> std::iter::FusedIterator for Run<'_, T> {}

/// What rounding may have done to each entry of a state that is evaluated a time after its
/// segment's entry.
fn roundings<T: Number>(flow: &Flow<T>, entry: &Vector<T>, elapsed: T) -> [f64; LARGEST_DIMENSION] {
    /// What is lost where the last word of a number underflows.
    const LAST_WORD: f64 = 1e-280;
    // One of them for the rest of the way to a crossing.
    let margin = (flow.dimension + 7) as f64 * unit::<T>();
    let now = flow.sizes(&flow.sizes_later(entry, elapsed));
    let before = flow.sizes(&entry.map(Number::to_f64));
    std::array::from_fn(|n| {
        // What is made of zeros stays zero.
        let lost = if before[n] > 0.0 || now[n] > 0.0 { LAST_WORD } else { 0.0 };
        margin * now[n] + lost + UNDERFLOW * before[n]
    })
}

#[inline]
fn complete<T: Number>(state: &mut Vector<T>, solver: &Solver<T>, sin: T, cos: T) {
    let (states, dimension) = (solver.system.states.len(), solver.system.dimension());
    state[dimension - 1] = T::one();
    if dimension > states + 1 {
        state[states] = cos;
        state[states + 1] = sin;
    }
}

#[inline]
fn bits(mask: u64) -> impl Iterator<Item = usize> {
    let without_lowest = |mask: &u64| Some(mask & mask.wrapping_sub(1));
    let masks = std::iter::successors(Some(mask), without_lowest).take_while(|it| *it != 0);
    masks.map(|it| it.trailing_zeros() as usize)
}

#[inline]
fn low_bits(count: usize) -> u64 {
    if count >= 64 { u64::MAX } else { (1 << count) - 1 }
}
