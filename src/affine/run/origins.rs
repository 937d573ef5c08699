//! The instants of a run from which motion is known exactly: the entry of the segment, and earlier
//! ones, whose entries no event has touched since.
//!
//! After an event at a time that is no rational number little is known of the state there. What
//! the event leaves alone goes on as before, though, and its closed form from an earlier instant
//! still holds.

use crate::affine::arithmetic::clock::Time;
use crate::affine::model::rational::Rational;
use crate::affine::model::system::{Mode, Row, StartPoint, System, Until, is_unit};
use crate::affine::zeros::circle::Circle;
use crate::affine::zeros::exact::{Chain, Entries, Fate};
use crate::affine::zeros::exact_mode::{ExactMode, TurningGuard};
use crate::affine::zeros::touch::Touch;
use crate::numeric::number::{Bound, Number};

/// An instant with the entries of z that are known there and whose rows of M have been the same
/// since, without a reset: what is a matter of these alone has its closed form from there.
pub(super) struct Origin<T: Number> {
    pub time: Time<T>,
    /// A bound of the error of the time: it is known exactly to the model alone.
    pub error: T::Bound,
    pub entries: Entries,
}

/// A guard that is known never to cross, from an origin that lies this long before the entry.
struct Kept {
    since: f64,
    touch: Option<Touch>,
}

/// The exact side of a run.
pub(super) struct ExactRun<T: Number> {
    /// The entry of the segment.
    pub entry: Origin<T>,
    /// Earlier instants, the latest first: each knows an entry of z that no later one knows.
    earlier: Vec<Origin<T>>,
    /// For each guard of the mode, its future from the entry of the segment, as far as it is known.
    fates: Vec<Option<Fate>>,
    /// For each guard of the mode that is known never to cross, its touches.
    kept: Vec<Option<Kept>>,
    /// For each guard of the mode that is one of the forcing angle and a constant on the segment:
    /// the constant may be what stands still there.
    circles: Vec<Option<Circle>>,
}

impl<T: Number> ExactRun<T> {
    /// The entries that a start gives exactly.
    pub fn at_start(system: &System, start: &StartPoint, time: Time<T>) -> Self {
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
        Self {
            entry: Origin { time, error: T::Bound::ZERO, entries },
            earlier: Vec::new(),
            fates: Vec::new(),
            kept: Vec::new(),
            circles: Vec::new(),
        }
    }

    /// The entry of the segment, then the earlier instants.
    pub fn origins(&self) -> impl DoubleEndedIterator<Item = &Origin<T>> {
        std::iter::once(&self.entry).chain(&self.earlier)
    }

    /// Enters a mode: the future of its guards.
    pub fn enter(&mut self, mode: &ExactMode) {
        let fates = mode.guards.iter().map(|it| it.fate(&self.entry.entries)).collect();
        let entered = self.entry.time;
        let kept = |guard: &Chain| {
            let kept = |it: &Origin<T>| {
                let fate = guard.fate(&it.entries)?;
                let since = entered.since(&it.time).value().to_f64();
                let never = fate.keeps_sign || fate.begin.is_none();
                never.then_some(Kept { since, touch: fate.touch })
            };
            self.origins().find_map(kept)
        };
        let kept = mode.guards.iter().map(kept).collect();
        let circle = |guard: &Option<TurningGuard>| {
            let guard = guard.as_ref()?;
            self.origins().find_map(|it| guard.circle(&it.entries))
        };
        let circles = mode.turning.iter().map(circle).collect();
        (self.fates, self.kept, self.circles) = (fates, kept, circles);
    }

    /// The future of a guard from the entry of the segment, as far as it is known.
    pub fn fate(&self, guard: usize) -> Option<&Fate> {
        self.fates.get(guard)?.as_ref()
    }

    /// Whether a guard is known never to cross: it keeps the sign that it has.
    pub fn keeps_sign(&self, guard: usize) -> bool {
        self.kept.get(guard).is_some_and(Option::is_some)
    }

    /// Whether a guard that is known never to cross may touch zero within a time after the entry.
    pub fn may_touch(&self, guard: usize, elapsed: f64) -> bool {
        let kept = self.kept.get(guard).and_then(Option::as_ref);
        kept.is_some_and(|it| {
            let span = [it.since, it.since + elapsed];
            it.touch.is_some_and(|touch| touch.may_lie_in(span))
        })
    }

    /// A guard of the present mode as one of the forcing angle and a constant, if it is one.
    pub fn circle(&self, guard: usize) -> Option<&Circle> {
        self.circles.get(guard)?.as_ref()
    }

    /// Begins anew where these entries are known: nothing goes on from before a limit.
    pub fn pass_limit(&mut self, next: Origin<T>) {
        self.entry = next;
        self.earlier.clear();
    }

    /// Passes an event from one mode to another, after which these entries are known.
    pub fn pass(&mut self, [from, to]: [&Mode; 2], until: &Until, next: Origin<T>) {
        self.earlier.insert(0, std::mem::replace(&mut self.entry, next));
        let goes_on = |n: usize| from.matrix[n] == to.matrix[n] && is_unit(&until.reset[n], n);
        for earlier in &mut self.earlier {
            forget(&mut earlier.entries, |n, _| !goes_on(n));
            // What moves by an entry that is not known is not known later either.
            while forget(&mut earlier.entries, |n, known| needs_more(&to.matrix[n], known)) {}
        }
        let mut known: Vec<bool> = self.entry.entries.iter().map(Option::is_some).collect();
        self.earlier.retain(|it| {
            let entries = known.iter_mut().zip(&it.entries);
            let news = entries.filter(|(known, entry)| entry.is_some() && !**known);
            news.map(|(known, _)| *known = true).count() > 0
        });
    }
}

/// Forgets entries that are known, and says whether there were some.
fn forget(entries: &mut Entries, is_lost: impl Fn(usize, &Entries) -> bool) -> bool {
    let is_lost = |n: &usize| entries[*n].is_some() && is_lost(*n, entries);
    let lost: Vec<usize> = (0..entries.len()).filter(is_lost).collect();
    lost.iter().for_each(|n| entries[*n] = None);
    !lost.is_empty()
}

/// Whether a row needs an entry that is not known.
fn needs_more(row: &Row, known: &Entries) -> bool {
    row.iter().zip(known).any(|(factor, entry)| !factor.is_zero() && entry.is_none())
}
