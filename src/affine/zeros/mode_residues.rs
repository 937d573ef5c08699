//! The rows of a mode modulo primes.

use super::circle::Circle;
use super::residue::{Residues, residues};
use crate::affine::model::rational::Rational;
use crate::affine::model::system::{Mode, Row, Successor, Until};

/// A mode's rows modulo primes.
#[derive(Clone, Debug)]
pub struct ModeResidues {
    pub matrix: Vec<Residues>,
    /// The mode's guards: those of `until`, then those of `watch`.
    pub guards: Vec<Residues>,
    /// For each guard, the rows that are zero where it is zero at one or the other of two rational
    /// points of the circle.
    pub points: Vec<[Vec<Residues>; 2]>,
    /// The resets of `until`, then those of their limits.
    pub resets: Vec<Vec<Residues>>,
    /// For each `until`, whether its reset changes nothing.
    pub changes_nothing: Vec<bool>,
    /// The conditions of each reset's successors, with their modes.
    pub next: Vec<Vec<(Option<Residues>, usize)>>,
    /// The states on which nothing else depends, in the mode and by its `until`, as bits.
    pub idle: u64,
}

impl ModeResidues {
    /// The rows of a mode; none if a coefficient has no residue.
    pub fn new(mode: &Mode, states: usize) -> Option<Self> {
        let rows = mode.guards();
        let guards = rows.clone().map(|it| residues(it));
        let points = rows.map(|it| points(it, states));
        let next = |next: &[Successor]| {
            let one = |it: &Successor| match &it.when {
                Some(row) => residues(row).map(|row| (Some(row), it.mode)),
                None => Some((None, it.mode)),
            };
            next.iter().map(one).collect()
        };
        let mut own = Self {
            matrix: matrix(&mode.matrix)?,
            guards: guards.collect::<Option<_>>()?,
            points: points.collect::<Option<_>>()?,
            changes_nothing: mode.until.iter().map(Until::changes_nothing).collect(),
            resets: mode.exits().map(|(reset, _)| matrix(reset)).collect::<Option<_>>()?,
            next: mode.exits().map(|(_, successors)| next(successors)).collect::<Option<_>>()?,
            idle: 0,
        };
        own.idle = (0..states).filter(|n| own.is_idle(*n)).fold(0, |mask, n| mask | 1 << n);
        Some(own)
    }

    /// The number of the mode's `until`: each has a reset and one at its limit.
    pub fn until(&self) -> usize {
        self.resets.len() / 2
    }

    fn is_idle(&self, n: usize) -> bool {
        let until = self.until();
        let others_lack = |rows: &Vec<Residues>| {
            rows.iter().enumerate().all(|(k, row)| k == n || row[n].is_zero())
        };
        others_lack(&self.matrix)
            && self.guards[..until].iter().all(|row| row[n].is_zero())
            && self.resets[..until].iter().all(others_lack)
            && self.next[..until].iter().all(|next| have_no(next, n))
    }

    /// Whether the limit of an `until` takes none of these states: neither its reset nor the
    /// conditions of what follows.
    pub fn limit_lacks(&self, until: usize, states: u64) -> bool {
        let exit = self.until() + until;
        let mut given = (0..u64::BITS as usize).filter(|n| states >> n & 1 == 1);
        given.all(|n| {
            self.resets[exit].iter().all(|row| row[n].is_zero()) && have_no(&self.next[exit], n)
        })
    }
}

/// Whether no condition depends on a state.
fn have_no(next: &[(Option<Residues>, usize)], n: usize) -> bool {
    next.iter().all(|(when, _)| when.as_ref().is_none_or(|row| row[n].is_zero()))
}

/// For each rational point at which a guard of the forcing angle is zero, the rows cos theta - p
/// and sin theta - q; none if a coefficient has no residue.
fn points(guard: &Row, states: usize) -> Option<[Vec<Residues>; 2]> {
    let Some(points) = Circle::new(guard, states).and_then(|it| it.points) else {
        return Some([Vec::new(), Vec::new()]);
    };
    let row = |at: usize, value: &Rational| {
        let mut row = vec![Rational::ZERO; states + 3];
        (row[at], row[states + 2]) = (Rational::ONE, -value);
        residues(&row)
    };
    let rows = |[cos, sin]: &[Rational; 2]| Some(vec![row(states, cos)?, row(states + 1, sin)?]);
    let [first, second] = &points;
    Some([rows(first)?, rows(second)?])
}

fn matrix(rows: &[Row]) -> Option<Vec<Residues>> {
    rows.iter().map(|it| residues(it)).collect()
}
