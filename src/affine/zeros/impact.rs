//! Impacts by the model, of which infinitely many may follow one another in a finite time.
//!
//! An impact leaves its guard h at zero, h+ = 0, and turns its rate back, h'+ = -e h'. From one to
//! the next the rate falls as a power of a quotient below 1, and so does whatever is a multiple of
//! it. A state whose change is none has to be the same after each impact, as a timer that is set
//! back, or one on which nothing else depends, as a count of the impacts.

use super::mode_residues::ModeResidues;
use super::residue::{Residue, Residues, row_times};
use super::space::ZeroSpace;

/// The changes by impacts that follow one another.
#[derive(Clone, Copy, Debug, Default)]
pub struct Impacts {
    /// The states that have the same value after each of them, as bits.
    pub renewed: u64,
    /// The states whose changes need no sum, as bits: nothing else depends on them in the mode, and
    /// must not in the mode that follows.
    pub idle: u64,
    /// Whether the limit takes none of those.
    pub has_limit: bool,
    /// The successors whose conditions have the same sign after each impact, as bits.
    pub kept: u64,
}

impl Impacts {
    /// Those of an event with these zeros before its reset and after it; none if it is no impact.
    pub fn of(
        modes: &[ModeResidues],
        own: &ModeResidues,
        until: usize,
        [zeros, after]: [&ZeroSpace; 2],
    ) -> Option<Self> {
        let (guard, reset) = (&own.guards[until], &own.resets[until]);
        let rate = row_times(guard, &own.matrix);
        let changed = row_times(&rate, reset);
        let is_multiple = |row: &Residues| zeros.ratio(row, &rate).is_some();
        let turns_back = after.contains(guard)
            && !zeros.contains(&rate)
            && !zeros.contains(&changed)
            && is_multiple(&changed);
        if !turns_back {
            return None;
        }
        let next = &own.next[until];
        let mut found = Self::default();
        for (n, row) in reset.iter().enumerate() {
            let mut jump = row.clone();
            jump[n] = jump[n].minus(Residue::ONE);
            if zeros.contains(&jump) || is_multiple(&jump) {
                continue;
            }
            let mut rest = row.clone();
            *rest.last_mut()? = Residue::ZERO;
            if zeros.contains(&rest) {
                found.renewed |= 1 << n;
            } else if own.idle >> n & 1 == 1 {
                found.idle |= 1 << n;
            } else {
                return None;
            }
        }
        found.has_limit = own.limit_lacks(until, found.idle);
        let keeps_sign = |(when, mode): &(Option<Residues>, usize)| {
            let Some(row) = when else { return false };
            let matrix = &modes[*mode].matrix;
            let Some(order) = after.multiplicity(row, matrix) else { return false };
            let row = (0..order).fold(row.clone(), |row, _| row_times(&row, matrix));
            is_multiple(&row_times(&row, reset))
        };
        let kept = next.iter().enumerate().filter(|(_, it)| keeps_sign(it));
        found.kept = kept.fold(0, |mask, (n, _)| mask | 1 << n);
        Some(found)
    }

    /// Whether the changes of a state add up to a sum that matters.
    pub fn add_up(&self, n: usize) -> bool {
        (self.renewed | self.idle) >> n & 1 == 0
    }
}

/// h+ = 0 and h'+ = 0 with the guard h.
pub fn rests(own: &ModeResidues, until: usize, after: &ZeroSpace) -> bool {
    let guard = &own.guards[until];
    after.contains(guard) && after.contains(&row_times(guard, &own.matrix))
}
