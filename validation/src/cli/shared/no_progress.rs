//! What is said of a run that makes no progress: which events take turns in one instant, why, and
//! what to write in the system's file.

use percuss::Kind;
use percuss::affine::{Rational, Row, System, Until, is_multiple, is_unit};
use std::collections::VecDeque;

/// The largest number of events that are named.
const MAX_NAMED_EVENTS: usize = 6;

/// The number of `until` events in one instant that ends a run, and that are kept to name them.
const MAX_SIMULTANEOUS_EVENTS: usize = 64;

/// An `until` of a mode by its index, with the mode that it begins.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct UntilEvent {
    mode: usize,
    until: usize,
    next: usize,
}

/// The last `until` events of a run, the latest first.
#[derive(Default)]
pub(in crate::cli) struct LastTurns(VecDeque<UntilEvent>);

impl LastTurns {
    /// Keeps an event, where it is an `until`, with the mode that it begins.
    pub(in crate::cli) fn add(&mut self, kind: Kind, next: usize) {
        if let Kind::Until(mode, until) = kind {
            self.0.truncate(MAX_SIMULTANEOUS_EVENTS - 1);
            self.0.push_front(UntilEvent { mode, until, next });
        }
    }
}

/// An `until` of a run, with its mode and the one that it begins.
struct RepeatedEvent<'a> {
    until: &'a Until,
    mode: usize,
    next: usize,
}

/// The events that take turns, by their names and modes.
pub(super) fn note(system: &System, last: &LastTurns) -> String {
    let turns = repeated_events(system, &last.0);
    let name = |mode: usize| &system.modes[mode].name;
    let named = turns.iter().take(MAX_NAMED_EVENTS).map(|turn| {
        let RepeatedEvent { until, mode, next } = turn;
        if mode == next {
            format!("\"{}\" (in {})", until.name, name(*mode))
        } else {
            format!("\"{}\" (from {} to {})", until.name, name(*mode), name(*next))
        }
    });
    let (named, all) = (named.collect::<Vec<_>>().join(", "), turns.len());
    match all {
        1 => format!("{MAX_SIMULTANEOUS_EVENTS} events fall on one instant, all of them {named}"),
        2..=MAX_NAMED_EVENTS => {
            format!("{MAX_SIMULTANEOUS_EVENTS} events fall on one instant, in turn {named}")
        }
        _ => format!("{MAX_SIMULTANEOUS_EVENTS} events fall on one instant, among them {named}"),
    }
}

/// Why the events take turns, and what to write.
pub(super) fn remedy(system: &System, last: &LastTurns) -> Option<String> {
    let turns = repeated_events(system, &last.0);
    let text = match &turns[..] {
        [] => return None,
        [own] if own.mode == own.next && own.leaves_its_guard(system) => format!(
            "it repeats a one-shot: the reset of \"{0}\" does not clear the guard of \"{0}\"; write \
             a reset that makes its condition false, or a next mode without it",
            own.until.name
        ),
        [own] => format!(
            "the motion comes to rest on the guard of \"{}\"; write a mode in which it rests there, \
             and choose it by `next = [{{ when = ..., mode = ... }}, ...]`",
            own.until.name
        ),
        [one, other] if one.faces(other) => format!(
            "the motion slides: {} and {} push it back to one guard from both sides; write a third \
             mode whose equations keep it there, or set the two guards apart (a hysteresis)",
            system.modes[one.mode].name, system.modes[other.mode].name
        ),
        _ => "the motion chatters: each of these events sets off the next; write one event whose \
              reset has the outcome of them all, or set their guards apart (a hysteresis)"
            .to_owned(),
    };
    Some(text)
}

/// The shortest list of events that a run repeats, in their order; all events where it repeats
/// none.
fn repeated_events<'a>(
    system: &'a System,
    recent: &VecDeque<UntilEvent>,
) -> Vec<RepeatedEvent<'a>> {
    let all: Vec<UntilEvent> = recent.iter().rev().copied().collect();
    let half = all.len() / 2;
    let repeats = |length: &usize| (half..all.len()).all(|n| all[n] == all[n - length]);
    let length = (1..=half).find(repeats).unwrap_or(all.len());
    // From the first of its modes on, which is the earlier one in the file.
    let last = &all[all.len() - length..];
    let first = (0..length).min_by_key(|n| last[*n]).unwrap_or(0);
    let order = last[first..].iter().chain(&last[..first]);
    let turn = |it: &UntilEvent| RepeatedEvent {
        until: &system.modes[it.mode].until[it.until],
        mode: it.mode,
        next: it.next,
    };
    order.map(turn).collect()
}

impl RepeatedEvent<'_> {
    /// Whether the reset changes neither the guard nor its rate.
    fn leaves_its_guard(&self, system: &System) -> bool {
        let guard = &self.until.guard;
        let rate = times(guard, &system.modes[self.mode].matrix);
        times(guard, &self.until.reset) == *guard && times(&rate, &self.until.reset) == rate
    }

    /// Whether two events without resets have one guard, which they cross in opposite directions.
    fn faces(&self, other: &Self) -> bool {
        let rests = |it: &Self| it.until.reset.iter().enumerate().all(|(n, row)| is_unit(row, n));
        let [own, others] = [&self.until.guard, &other.until.guard];
        let Some(at) = own.iter().position(|it| !it.is_zero()) else { return false };
        let factor = &others[at] / &own[at];
        rests(self) && rests(other) && is_multiple(others, own) && factor < Rational::ZERO
    }
}

/// A row times a matrix.
pub(in crate::cli) fn times(row: &Row, matrix: &[Row]) -> Row {
    let column = |n: usize| {
        let terms = row.iter().zip(matrix).map(|(factor, row)| factor * &row[n]);
        terms.fold(Rational::ZERO, |sum, term| sum + term)
    };
    (0..row.len()).map(column).collect()
}
