//! Exact arithmetic beside a run that follows its errors: which entries of the state are known as
//! rationals, and what that decides of guards and successors which no number of bits would.

use super::Run;
use crate::affine::arithmetic::vector::Vector;
use crate::affine::model::rational::Rational;
use crate::affine::model::system::{StartPoint, System};
use crate::affine::zeros::circle::Circle;
use crate::affine::zeros::exact::{Chain, Entries, Fate, Instant};
use crate::affine::zeros::exact_mode::{ExactMode, entries_after, solve};
use crate::affine::zeros::graph::ZeroGuards;
use crate::numeric::number::Number;

/// The exact side of a run.
pub(super) struct ExactRun {
    /// The entries of z at the entry of the segment that are known.
    entries: Entries,
    /// For each guard of the mode, its future on the segment as far as it is known.
    fates: Vec<Option<Fate>>,
    /// For each guard of the mode that is one of the forcing angle and a constant on the segment:
    /// the constant may be what stands still there.
    circles: Vec<Option<Circle>>,
}

impl ExactRun {
    /// The entries that a start gives exactly.
    pub fn at_start(system: &System, start: &StartPoint) -> Self {
        let zero_angle = system.is_at_zero_angle(start);
        let known = |[cos, sin, one]: &[Rational; 3]| {
            let is_plain = cos.is_zero() && sin.is_zero();
            (zero_angle || is_plain).then(|| cos + one)
        };
        let mut entries: Entries = start.state.iter().map(known).collect();
        if system.forcing.is_some() {
            entries.push(zero_angle.then_some(Rational::ONE));
            entries.push(zero_angle.then_some(Rational::ZERO));
        }
        entries.push(Some(Rational::ONE));
        Self { entries, fates: Vec::new(), circles: Vec::new() }
    }

    /// Enters a mode: the future of its guards.
    pub fn enter(&mut self, mode: &ExactMode) {
        let Self { entries, fates, circles } = self;
        fates.clear();
        fates.extend(mode.guards.iter().map(|it| it.fate(entries)));
        circles.clear();
        circles.extend(mode.turning.iter().map(|it| it.as_ref()?.circle(entries)));
    }

    /// The future of a guard, as far as it is known.
    pub fn fate(&self, guard: usize) -> Option<&Fate> {
        self.fates.get(guard)?.as_ref()
    }
}

impl<T: Number> Run<'_, T> {
    /// Whether a guard of the forcing angle and a constant never crosses by the model: it stays
    /// inside, or is watched and keeps its sign.
    pub(super) fn never_crosses(&self, mode: usize, guard: usize) -> bool {
        let Some(circle) = self.exact.as_ref().and_then(|it| it.circles[guard].as_ref()) else {
            return false;
        };
        let is_watched = guard >= self.solver.system.modes[mode].until.len();
        circle.keeps_sign && (is_watched || circle.is_below)
    }

    /// The instant of a guard's crossing at which the search has arrived, if it is known exactly.
    fn instant(&self, mode: usize, guard: usize) -> Option<Instant> {
        let point = &self.ends.left;
        let time = (point.time + point.to_crossing).to_f64();
        self.solver.exact_mode(mode).guards[guard].zero_near(&self.exact.as_ref()?.entries, time)
    }

    /// The guards that are zero at the very instant at which one of them crosses, as bits.
    pub(super) fn exactly_tied(&self, mode: usize, first: ZeroGuards) -> u64 {
        let Some(exact) = &self.exact else { return 0 };
        let instant = self.instant(mode, first.guards.trailing_zeros() as usize);
        let entries = self.at_crossing(exact, mode, first, instant.as_ref());
        let is_zero = |chain: &Chain| {
            let value = chain.value(&entries);
            value
                .or_else(|| chain.at(&exact.entries, instant.as_ref()))
                .is_some_and(|it| it.is_zero())
        };
        let guards = self.solver.exact_mode(mode).guards.iter().enumerate();
        guards.filter(|(_, it)| is_zero(it)).fold(0, |mask, (n, _)| mask | 1 << n)
    }

    /// Guards that are zero at a state, with the rational point of the circle at which one of them
    /// is.
    pub(super) fn zero_guards(&self, guards: u64, state: &Vector<T>) -> ZeroGuards {
        let point = self.solver.phase().zip(self.exact.as_ref()).and_then(|(at, exact)| {
            let circles = exact.circles.iter().enumerate();
            circles.filter(|(n, _)| guards >> n & 1 == 1).find_map(|(n, circle)| {
                let [cos, sin] = [state[at].to_f64(), state[at + 1].to_f64()];
                Some((n, circle.as_ref()?.nearest(cos, sin)?))
            })
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
            return Some(exact.entries.clone());
        }
        let is_zero = |n: &usize| zero.guards >> n & 1 == 1;
        let guards = 0..self.solver.exact_mode(mode).guards.len();
        let instant = guards.filter(is_zero).find_map(|n| self.instant(mode, n));
        Some(self.at_crossing(exact, mode, zero, instant.as_ref()))
    }

    /// The exact entries where these guards are zero, at an instant that may be known.
    fn at_crossing(
        &self,
        exact: &ExactRun,
        mode: usize,
        zero: ZeroGuards,
        instant: Option<&Instant>,
    ) -> Entries {
        let mut entries = self.solver.exact_mode(mode).entries_at(&exact.entries, instant);
        if let (Some(at), Some((guard, point))) = (self.solver.phase(), zero.point)
            && let Some(points) = exact.circles[guard].as_ref().and_then(|it| it.points.as_ref())
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

    /// The exact entries after the reset of an event.
    pub(super) fn exact_after(&self, mode: usize, until: usize, before: &Entries) -> Entries {
        entries_after(&self.solver.system.modes[mode].until[until].reset, before)
    }

    /// Makes these the exact entries of the next segment.
    pub(super) fn set_exact(&mut self, entries: Option<Entries>) {
        if let (Some(exact), Some(entries)) = (&mut self.exact, entries) {
            exact.entries = entries;
        }
    }
}
