//! The recognition of a motion that approaches a known attractor.

use super::known::{Evidence, KnownAttractor};
use super::space::{Space, Spot};
use super::trap::Trap;
use crate::dynamics::attractor::thresholds::{CLOSER_TURNS, RECURRENCES};

/// What one motion has met of the known attractors.
pub struct Recognizer<'a> {
    space: &'a Space<'a>,
    known: &'a [KnownAttractor],
    /// Returns in a row in the cells of each.
    streaks: Vec<u32>,
    entered: Option<EnteredTrap<'a>>,
}

/// A trap was entered; each turn of the orbit from there on has to bring the motion closer.
struct EnteredTrap<'a> {
    known: usize,
    trap: &'a Trap,
    due: u64,
    size: f64,
    turns: u32,
}

impl<'a> Recognizer<'a> {
    pub fn new(space: &'a Space<'a>, known: &'a [KnownAttractor]) -> Self {
        Self { space, known, streaks: vec![0; known.len()], entered: None }
    }

    /// Takes the n-th return; which attractor it is known to lead to.
    pub fn see(&mut self, n: u64, spot: &Spot) -> Option<usize> {
        if let Some(entered) = &mut self.entered
            && entered.due == n
        {
            let size = entered.trap.size(self.space, spot);
            let closer = size < entered.size || entered.trap.is_at_rest(size);
            entered.turns += 1;
            if closer && entered.turns >= CLOSER_TURNS {
                return Some(entered.known);
            }
            (entered.size, entered.due) = (size, n + self.known[entered.known].period());
            if !closer {
                self.entered = None;
            }
        }
        if self.entered.is_none() {
            self.entered = self.enter(n, spot);
        }
        for (known, streak) in self.streaks.iter_mut().enumerate() {
            if let Evidence::Cells(cells) = &self.known[known].evidence {
                *streak = if cells.hold(spot) { *streak + 1 } else { 0 };
                if *streak >= RECURRENCES {
                    return Some(known);
                }
            }
        }
        None
    }

    fn enter(&self, n: u64, spot: &Spot) -> Option<EnteredTrap<'a>> {
        self.known.iter().enumerate().find_map(|(known, it)| {
            let Evidence::Traps(traps) = &it.evidence else { return None };
            let due = n + it.period();
            let sizes = traps.iter().map(|trap| (trap, trap.size(self.space, spot)));
            let mut inside = sizes.filter(|(_, size)| *size <= 1.0);
            inside.next().map(|(trap, size)| EnteredTrap { known, trap, due, size, turns: 0 })
        })
    }
}
