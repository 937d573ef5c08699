//! Exact arithmetic beside a run that follows its errors: which entries of the state are known as
//! rationals, and what that decides of guards and successors which no number of bits would.

use super::Run;
use super::enclosure::Enclosure;
use super::origins::{ExactRun, Origin};
use crate::affine::arithmetic::vector::Vector;
use crate::affine::model::rational::Rational;
use crate::affine::solver::event::What;
use crate::affine::zeros::exact::{Chain, Entries, Instant};
use crate::affine::zeros::exact_mode::{entries_after, solve};
use crate::affine::zeros::graph::ZeroGuards;
use crate::affine::zeros::touch::Touch;
use crate::numeric::number::{Bound, Number};

impl<T: Number> Run<'_, T> {
    /// Whether a guard of the forcing angle and a constant never crosses by the model: it stays
    /// inside, or is watched and keeps its sign.
    pub(super) fn never_crosses(&self, mode: usize, guard: usize) -> bool {
        let Some(circle) = self.exact.as_ref().and_then(|it| it.circle(guard)) else {
            return false;
        };
        let is_watched = guard >= self.solver.system.modes[mode].until.len();
        circle.keeps_sign && (is_watched || circle.is_below)
    }

    /// The event whose guard touches zero without crossing between two events of a run that
    /// follows its errors, as exact arithmetic alone can tell: none up to the events that have
    /// been returned.
    #[must_use]
    pub fn touched_event(&self) -> Option<What<T>> {
        self.touched_guards().next().map(|(mode, guard)| self.event_of(mode, guard))
    }

    /// The modes and guards of all events such as [`Run::touched_event`] says, each once.
    pub(in crate::affine) fn touched_guards(&self) -> impl Iterator<Item = (usize, usize)> {
        self.touches.iter().copied()
    }

    /// Remembers the guards that never cross but touch zero, up to a time after the entry of the
    /// segment.
    #[inline]
    pub(super) fn remember_touch(&mut self, mode: usize, elapsed: T) {
        let Some(exact) = &self.exact else { return };
        let elapsed = elapsed.to_f64();
        let touches = |n: usize| exact.may_touch(n, elapsed) || self.turns_to(exact, n, elapsed);
        let is_new = |n: &usize| !self.touches.contains(&(mode, *n));
        let guards = (0..self.tracks.len()).filter(is_new).filter(|n| touches(*n));
        let new: Vec<_> = guards.map(|guard| (mode, guard)).collect();
        self.touches.extend(new);
    }

    /// Whether a guard of the forcing angle and a constant that never changes its sign touches zero
    /// within a time after the entry.
    fn turns_to(&self, exact: &ExactRun<T>, guard: usize, elapsed: f64) -> bool {
        let touch = exact.circle(guard).and_then(|it| it.touch);
        let (Some(angle), Some(at)) = (touch, self.solver.phase()) else { return false };
        let Some(forcing) = &self.solver.system.forcing else { return false };
        let [cos, sin] = [self.state[at].to_f64(), self.state[at + 1].to_f64()];
        let ahead = angle - libm::atan2(sin, cos);
        let frequency = forcing.omega.to_f64();
        let touch = Touch::of_angle(ahead, frequency, false);
        touch.may_lie_in([0.0, elapsed])
    }

    /// A bound of the error of the time, where errors are followed.
    fn time_error(&self) -> T::Bound {
        self.enclosure.as_ref().map_or(T::Bound::ZERO, Enclosure::time)
    }

    /// For each origin, the instant at which one of these guards is zero where the search has
    /// arrived, if it is known exactly; the crossing's time has at most this error.
    fn instants(
        &self,
        exact: &ExactRun<T>,
        mode: usize,
        guards: u64,
        error: T::Bound,
    ) -> Vec<Option<Instant>> {
        let own = &self.solver.exact_mode(mode).guards;
        let guards = || (0..own.len()).filter(|n| guards >> n & 1 == 1);
        let point = &self.ends.left;
        let instant = |origin: &Origin<T>| {
            let since = self.solver.directed(self.entered.since(&origin.time).value());
            let time = (since + point.time + point.to_crossing).to_f64();
            let error = (origin.error + error).to_f64();
            guards().find_map(|n| own[n].zero_near(&origin.entries, [time, error]))
        };
        exact.origins().map(instant).collect()
    }

    /// The guards that are zero at the very instant at which one of them crosses, as bits; the
    /// crossing's time has at most this error.
    pub(super) fn exactly_tied(&self, mode: usize, first: ZeroGuards, error: T::Bound) -> u64 {
        let Some(exact) = &self.exact else { return 0 };
        let instants = self.instants(exact, mode, first.guards, error);
        let entries = self.at_crossing(exact, mode, first, &instants);
        let at = |chain: &Chain| {
            let mut origins = exact.origins().zip(&instants);
            origins.find_map(|(it, instant)| chain.at(&it.entries, instant.as_ref()))
        };
        let is_zero =
            |it: &Chain| it.value(&entries).or_else(|| at(it)).is_some_and(|it| it.is_zero());
        let guards = self.solver.exact_mode(mode).guards.iter().enumerate();
        guards.filter(|(_, it)| is_zero(it)).fold(0, |mask, (n, _)| mask | 1 << n)
    }

    /// Guards that are zero at a state, with the rational point of the circle at which one of them
    /// is.
    pub(super) fn zero_guards(&self, guards: u64, state: &Vector<T>) -> ZeroGuards {
        let point = self.solver.phase().zip(self.exact.as_ref()).and_then(|(at, exact)| {
            let [cos, sin] = [state[at].to_f64(), state[at + 1].to_f64()];
            let point = |n: usize| Some((n, exact.circle(n)?.nearest(cos, sin)?));
            (0..u64::BITS as usize).filter(|n| guards >> n & 1 == 1).find_map(point)
        });
        ZeroGuards { guards, point }
    }

    /// The exact entries just before an event, at the entry or at the crossing of these guards.
    pub(super) fn exact_before(
        &self,
        mode: usize,
        zero: ZeroGuards,
        at_entry: bool,
    ) -> Option<Entries> {
        let exact = self.exact.as_ref()?;
        if at_entry {
            return Some(exact.entry.entries.clone());
        }
        let instants = self.instants(exact, mode, zero.guards, self.time_error());
        Some(self.at_crossing(exact, mode, zero, &instants))
    }

    /// The exact entries where these guards are zero, at an instant that may be known from some
    /// origins.
    fn at_crossing(
        &self,
        exact: &ExactRun<T>,
        mode: usize,
        zero: ZeroGuards,
        instants: &[Option<Instant>],
    ) -> Entries {
        let own = self.solver.exact_mode(mode);
        let mut entries: Entries = vec![None; self.solver.system.dimension()];
        for (origin, instant) in exact.origins().zip(instants) {
            let there = own.entries_at(&origin.entries, instant.as_ref());
            let open = entries.iter_mut().zip(there).filter(|(entry, _)| entry.is_none());
            open.for_each(|(entry, own)| *entry = own);
        }
        if let (Some(at), Some((guard, point))) = (self.solver.phase(), zero.point)
            && let Some(points) = exact.circle(guard).and_then(|it| it.points.as_ref())
        {
            let [cos, sin] = points[point].clone();
            (entries[at], entries[at + 1]) = (Some(cos), Some(sin));
        }
        let system = &self.solver.system.modes[mode];
        let guards = system.until.iter().map(|it| &it.guard);
        let guards = guards.chain(system.watch.iter().map(|it| &it.guard)).enumerate();
        let guards = guards.filter(|(n, _)| zero.guards >> n & 1 == 1);
        guards.for_each(|(_, row)| solve(row, &mut entries));
        entries
    }

    /// The exact entries at a limit before its reset, of which only the last is known.
    pub(super) fn exact_at_limit(&self) -> Option<Entries> {
        self.exact.as_ref()?;
        let mut entries: Entries = vec![None; self.solver.system.dimension()];
        *entries.last_mut()? = Some(Rational::ONE);
        Some(entries)
    }

    /// The exact entries after the reset of an event, or of a limit.
    pub(super) fn exact_after(&self, mode: usize, exit: usize, before: &Entries) -> Entries {
        let reset = self.solver.system.modes[mode].exits().nth(exit).map(|(reset, _)| reset);
        entries_after(reset.unwrap_or_default(), before)
    }

    /// Passes an event of a mode, or a limit, with the exact entries after it, to the segment that
    /// now begins.
    pub(super) fn pass_exactly(&mut self, mode: usize, exit: usize, entries: Option<Entries>) {
        let (to, error) = (self.graph.node(self.node).mode, self.time_error());
        let modes = &self.solver.system.modes;
        if let (Some(exact), Some(entries)) = (&mut self.exact, entries) {
            let origin = Origin { time: self.entered, error, entries };
            match modes[mode].until.get(exit) {
                Some(until) => exact.pass([&modes[mode], &modes[to]], until, origin),
                None => exact.pass_limit(origin),
            }
        }
    }
}
