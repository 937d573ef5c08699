//! A mode's guards, conditions and entries in exact arithmetic, and what its resets keep of entries
//! that are known.

use super::circle::Circle;
use super::exact::{Chain, Entries, Instant, product};
use crate::affine::model::rational::Rational;
use crate::affine::model::system::{Mode, Row, Successor, System};

/// The most bits of a rational entry: what is longer is not followed any more.
const MAX_ENTRY_BITS: usize = 4096;

/// A guard with the forcing angle in it: a cos theta + b sin theta + rest.
#[derive(Clone, Debug)]
pub struct TurningGuard {
    turn: [Rational; 2],
    rest: Chain,
}

/// A mode's rows in its exact motion.
#[derive(Clone, Debug)]
pub struct ExactMode {
    /// The guards of `until`, then those of `watch`.
    pub guards: Vec<Chain>,
    /// The guards that have the forcing angle in them.
    pub turning: Vec<Option<TurningGuard>>,
    /// The conditions of each event's successors, in the motion of their modes.
    pub conditions: Vec<Vec<Option<Chain>>>,
    /// The entries of z.
    entries: Vec<Chain>,
}

impl TurningGuard {
    /// A guard of a system with so many states, if the forcing angle is in it.
    fn new(guard: &Row, states: usize, matrix: &[Row]) -> Option<Self> {
        let [a, b, _] = &guard[states..] else { return None };
        if a.is_zero() && b.is_zero() {
            return None;
        }
        let mut rest = guard.clone();
        rest[states..states + 2].fill(Rational::ZERO);
        Some(Self { turn: [a.clone(), b.clone()], rest: Chain::new(&rest, matrix) })
    }

    /// The guard as one of the angle and a constant, on a segment on which the rest is known and
    /// stands still.
    pub fn circle(&self, entries: &Entries) -> Option<Circle> {
        let [a, b] = &self.turn;
        Circle::with([a, b], &self.rest.constant_value(entries)?)
    }
}

impl ExactMode {
    /// The rows of a system's mode.
    pub fn new(system: &System, mode: &Mode) -> Self {
        let states = system.states.len();
        let guards = mode.guards();
        let condition = |it: &Successor| {
            it.when.as_ref().map(|when| Chain::new(when, &system.modes[it.mode].matrix))
        };
        let unit = |n: usize| -> Row {
            (0..mode.matrix.len()).map(|k| Rational::from(u8::from(k == n))).collect()
        };
        Self {
            turning: guards.clone().map(|it| TurningGuard::new(it, states, &mode.matrix)).collect(),
            guards: guards.map(|it| Chain::new(it, &mode.matrix)).collect(),
            conditions: mode
                .exits()
                .map(|(_, next)| next.iter().map(condition).collect())
                .collect(),
            entries: (0..mode.matrix.len()).map(|n| Chain::new(&unit(n), &mode.matrix)).collect(),
        }
    }

    /// The entries of z a time after those at the entry of the mode, as far as they are known.
    pub fn entries_at(&self, entries: &Entries, instant: Option<&Instant>) -> Entries {
        self.entries.iter().map(|it| it.at(entries, instant)).collect()
    }
}

/// The entries after a reset, as far as they are known and not too long.
pub fn entries_after(reset: &[Row], entries: &Entries) -> Entries {
    let is_short = |it: &Rational| it.bits().0 + it.bits().1 < MAX_ENTRY_BITS;
    reset.iter().map(|row| product(row, entries).filter(is_short)).collect()
}

/// Makes known the one entry that a row which is zero leaves open, if it is one.
pub fn solve(row: &Row, entries: &mut Entries) {
    let is_open = |n: &usize| !row[*n].is_zero() && entries[*n].is_none();
    let open: Vec<usize> = (0..row.len()).filter(is_open).collect();
    if let [n] = open[..] {
        let mut others = row.clone();
        others[n] = Rational::ZERO;
        entries[n] = product(&others, entries).map(|sum| -sum / &row[n]);
    }
}
