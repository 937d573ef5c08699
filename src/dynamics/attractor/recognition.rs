//! The recognition of a motion that approaches a known attractor.

use super::coordinates::Coordinates;
use super::known::{Evidence, KnownAttractor};
use super::thresholds::{CLOSER_TURNS, RECURRENCES};
use super::trap::Trap;

/// What one motion has met of the known attractors.
pub(crate) struct Recognizer<'a, C: Coordinates> {
    coordinates: &'a C,
    known: &'a [KnownAttractor<C>],
    /// Returns in a row in the cells of each.
    streaks: Vec<u32>,
    entered: Option<EnteredTrap<'a, C>>,
}

/// A trap was entered; each turn of the orbit from there on has to bring the motion closer.
struct EnteredTrap<'a, C: Coordinates> {
    known: usize,
    trap: &'a Trap<C>,
    due: u64,
    size: f64,
    turns: u32,
}

impl<'a, C: Coordinates> Recognizer<'a, C> {
    pub fn new(coordinates: &'a C, known: &'a [KnownAttractor<C>]) -> Self {
        Self { coordinates, known, streaks: vec![0; known.len()], entered: None }
    }

    /// Takes the n-th return; which attractor it is known to lead to.
    pub fn see(&mut self, n: u64, spot: &C::Spot) -> Option<usize> {
        if let Some(entered) = &mut self.entered
            && entered.due == n
        {
            let size = entered.trap.size(self.coordinates, spot);
            let closer = (size < entered.size || entered.trap.is_at_rest(size))
                && entered.trap.is_on_way(self.coordinates, spot);
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
                *streak = if cells.hold(self.coordinates, spot) { *streak + 1 } else { 0 };
                if *streak >= RECURRENCES {
                    return Some(known);
                }
            }
        }
        None
    }

    fn enter(&self, n: u64, spot: &C::Spot) -> Option<EnteredTrap<'a, C>> {
        self.known.iter().enumerate().find_map(|(known, it)| {
            let Evidence::Traps(traps) = &it.evidence else { return None };
            let traps = traps.iter().filter(|it| it.is_on_way(self.coordinates, spot));
            let sizes = traps.map(|trap| (trap, trap.size(self.coordinates, spot)));
            let (trap, size) = sizes.into_iter().find(|(_, size)| *size <= 1.0)?;
            Some(EnteredTrap { known, trap, due: n + it.period(), size, turns: 0 })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::attractor::strobes::{StrobeCoordinates, known_point};

    /// How many strobes at these distances it takes to recognise a motion.
    fn recognised_after(distances: &[f64]) -> Option<usize> {
        let known = [known_point([0.0; 3], 1.0)];
        let mut recognizer = Recognizer::new(&StrobeCoordinates, &known);
        let mut see = |(n, x): (usize, &f64)| recognizer.see(n as u64, &[*x, 0.0, 0.0]);
        distances.iter().enumerate().position(|it| see(it).is_some())
    }

    #[test]
    fn three_turns_that_bring_a_motion_closer_are_needed() {
        assert_eq!(recognised_after(&[0.9, 0.8, 0.7, 0.6]), Some(3));
        assert_eq!(recognised_after(&[2.0, 0.9, 0.8, 0.7, 0.6]), Some(4));
        assert_eq!(recognised_after(&[0.9, 0.8, 0.7]), None);
    }

    #[test]
    fn a_turn_away_begins_the_count_again() {
        assert_eq!(recognised_after(&[0.5, 0.4, 0.3, 0.6, 0.5, 0.4]), None);
        assert_eq!(recognised_after(&[0.5, 0.4, 0.3, 0.6, 0.5, 0.4, 0.3]), Some(6));
        assert_eq!(recognised_after(&[0.5, 0.5, 0.5, 0.5, 0.5, 0.5]), None);
        assert_eq!(recognised_after(&[0.5, 0.4, 2.0, 0.3, 0.2, 0.1]), None);
    }

    #[test]
    fn a_motion_at_rest_on_the_orbit_need_not_come_closer() {
        assert_eq!(recognised_after(&[1e-7, 2e-7, 1e-7, 2e-7]), Some(3));
        assert_eq!(recognised_after(&[1e-7, 2e-5, 3e-5, 4e-5]), None);
    }
}
