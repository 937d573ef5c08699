//! The recognition of a motion that approaches a known attractor.

use super::known::{Evidence, KnownAttractor, Label};
use super::thresholds::{CLOSER_TURNS, RECURRENCES};
use super::trap::Trap;
use crate::dynamics::ensemble::Watcher;
use crate::dynamics::strobe::StrobePoint;
use crate::model::entry::Entry;
use crate::run::exit::Endless;
use std::ops::ControlFlow;

/// Watches for what is known.
pub(super) struct Recognition<'a> {
    recognizer: Recognizer<'a>,
    label: Option<Label>,
    last: Entry,
    /// Strobes met, and the number after which it is given up.
    met: u64,
    most: u64,
    /// The number of events met.
    events: u64,
    seen: &'a (dyn Fn(u64) + Sync),
}

impl<'a> Recognition<'a> {
    pub fn new(
        known: &'a [KnownAttractor],
        from: Entry,
        most: u64,
        seen: &'a (dyn Fn(u64) + Sync),
    ) -> Self {
        Self {
            recognizer: Recognizer::new(known),
            label: None,
            last: from,
            met: 0,
            most,
            events: 0,
            seen,
        }
    }

    /// How many events the motion has met.
    pub const fn events(&self) -> u64 {
        self.events
    }

    /// The motion's label, or its state if it has none yet.
    pub fn outcome(self) -> Result<Label, Entry> {
        self.label.ok_or(self.last)
    }
}

impl Watcher for Recognition<'_> {
    fn see(&mut self, strobe: &Entry, endless: Option<Endless>) -> ControlFlow<()> {
        self.label = if escapes(endless) {
            Some(Label::Escaping)
        } else {
            self.recognizer.see(self.met, &strobe.point()).map(Label::Attractor)
        };
        (self.last, self.met) = (*strobe, self.met + 1);
        if self.label.is_some() {
            (self.seen)(1);
            return ControlFlow::Break(());
        }
        if self.met > self.most { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn enter(&mut self, _phase: &Entry) {
        self.events += 1;
    }
}

/// Whether a motion is in a phase that never ends, other than rest on the slider, which is an
/// orbit.
pub(super) fn escapes(endless: Option<Endless>) -> bool {
    matches!(endless, Some(Endless::NeverReturns | Endless::NeverStops))
}

/// What one motion has met of the known attractors.
pub(super) struct Recognizer<'a> {
    known: &'a [KnownAttractor],
    /// Strobes in a row in the cells of each.
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
    pub fn new(known: &'a [KnownAttractor]) -> Self {
        Self { known, streaks: vec![0; known.len()], entered: None }
    }

    /// Takes the n-th strobe; which attractor it is known to lead to.
    pub fn see(&mut self, n: u64, point: &StrobePoint) -> Option<usize> {
        if let Some(entered) = &mut self.entered
            && entered.due == n
        {
            let size = entered.trap.size(point);
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
            self.entered = self.enter(n, point);
        }
        for (known, streak) in self.streaks.iter_mut().enumerate() {
            if let Evidence::Cells(cells) = &self.known[known].evidence {
                *streak = if cells.hold(point) { *streak + 1 } else { 0 };
                if *streak >= RECURRENCES {
                    return Some(known);
                }
            }
        }
        None
    }

    fn enter(&self, n: u64, point: &StrobePoint) -> Option<EnteredTrap<'a>> {
        self.known.iter().enumerate().find_map(|(known, it)| {
            let Evidence::Traps(traps) = &it.evidence else { return None };
            let inside = |trap: &'a Trap| {
                let size = trap.size(point);
                (size <= 1.0).then(|| EnteredTrap {
                    known,
                    trap,
                    due: n + it.period(),
                    size,
                    turns: 0,
                })
            };
            traps.iter().find_map(inside)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::attractor::{Attractor, AttractorKind};

    /// An attractor of period 1 in the origin, with a ball of radius 1 as its trap.
    fn origin() -> KnownAttractor {
        let attractor = Attractor {
            kind: AttractorKind::Periodic,
            orbit: None,
            points: vec![[0.0; 3]],
            drift_per_period: 0.0,
            drift_standard_error: 0.0,
            lyapunov_per_period: -1.0,
            lyapunov_error: 0.0,
        };
        KnownAttractor {
            attractor,
            evidence: Evidence::Traps(vec![Trap::ball([0.0; 3], 1.0)]),
            transient: None,
        }
    }

    /// How many strobes at these distances it takes to recognise a motion.
    fn recognised_after(distances: &[f64]) -> Option<usize> {
        let known = [origin()];
        let mut recognizer = Recognizer::new(&known);
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
