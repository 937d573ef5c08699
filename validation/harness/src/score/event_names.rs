//! The events of a system by their names, in a truth and in an engine's answer.
//!
//! Events of one instant may come in any order where the truth says that the order is free: only
//! their names count then, and the mode after the last of them.

use super::occurrence::Occurrence;
use crate::case::Case;
use crate::engine::{Outcome, Task};
use crate::system::System;
use crate::truth::{Truth, TruthRow};
use percuss::Ending;

/// The events of a system, over all of its modes, with a number for each distinct name.
#[derive(Clone, Debug)]
pub struct EventNames {
    /// All names.
    names: Vec<String>,
    /// The number of each event of each mode.
    numbers: Vec<Vec<usize>>,
    /// Whether events are told apart by the modes that begin, and all have one name.
    by_modes: bool,
}

impl EventNames {
    /// The names of the events of a case, which is a run of this system.
    #[must_use]
    pub fn new(case: &Case, system: &System) -> Self {
        let by_modes = case.oscillator.is_some();
        let mut names: Vec<String> = Vec::new();
        let mut number = |name: &String| {
            let name = if by_modes { &system.name } else { name };
            names.iter().position(|it| it == name).unwrap_or_else(|| {
                names.push(name.clone());
                names.len() - 1
            })
        };
        let numbers = system.modes.iter().map(|mode| {
            let until = mode.until.iter().map(|it| &it.name);
            until.chain(mode.watch.iter().map(|it| &it.name)).map(&mut number).collect()
        });
        let numbers = numbers.collect();
        Self { names, numbers, by_modes }
    }

    /// The number of an event's name.
    #[must_use]
    pub fn number(&self, mode: usize, event: usize) -> usize {
        // What is no event of its mode has a name that is none.
        let number = self.numbers.get(mode).and_then(|mode| mode.get(event));
        number.copied().unwrap_or(usize::MAX)
    }

    /// The number of an event's name, where that tells it from others.
    #[must_use]
    pub fn telling(&self, mode: usize, event: usize) -> Option<usize> {
        (!self.by_modes).then(|| self.number(mode, event))
    }

    /// The events of a truth; an ending that engines have to find is the last.
    #[must_use]
    pub fn of_truth(&self, truth: &Truth) -> Vec<Occurrence> {
        let mut mode = truth.start.mode;
        let mut found: Vec<Occurrence> = Vec::new();
        for row in &truth.events {
            let event = self.number(mode, row.event);
            mode = row.mode;
            found.push(Occurrence { elapsed: row.elapsed.value(), event, mode: Some(mode) });
        }
        for group in self.groups(truth) {
            found[group.start..group.end - 1].iter_mut().for_each(|it| it.mode = None);
        }
        found.extend(self.ending(truth.ended, truth.end.elapsed.value()));
        found
    }

    /// The events of an engine's answer, those of one instant in the truth's order.
    #[must_use]
    pub fn of_outcome(&self, task: &Task, truth: &Truth, outcome: &Outcome) -> Vec<Occurrence> {
        let mut mode = task.mode;
        let mut found: Vec<Occurrence> = Vec::new();
        for event in &outcome.events {
            let number = self.number(mode, event.event);
            mode = event.mode;
            found.push(Occurrence { elapsed: event.elapsed, event: number, mode: Some(mode) });
        }
        let expected = self.of_truth(truth);
        for group in self.groups(truth) {
            order_like(&expected[group], &mut found);
        }
        found.extend(self.ending(outcome.ended, outcome.ended_at));
        found
    }

    /// The events of one instant whose order is free, by their indices.
    fn groups(&self, truth: &Truth) -> Vec<std::ops::Range<usize>> {
        if truth.ordered {
            return Vec::new();
        }
        let at_once = |a: &TruthRow, b: &TruthRow| b.elapsed.minus(a.elapsed).value() == 0.0;
        let mut groups = Vec::new();
        let mut from = 0;
        for group in truth.events.chunk_by(at_once) {
            if group.len() > 1 {
                groups.push(from..from + group.len());
            }
            from += group.len();
        }
        groups
    }

    /// An ending that is found like an event; accumulation and the horizon are none.
    fn ending(&self, ended: Ending, elapsed: f64) -> Option<Occurrence> {
        let kind = match ended {
            Ending::NoProgress => 0,
            Ending::LeavesDomain => 1,
            Ending::BeyondGuard => 2,
            _ => return None,
        };
        Some(Occurrence { elapsed, event: self.names.len() + kind, mode: None })
    }
}

/// Takes as many events of an engine in a row as one instant has in the truth, all of them of its
/// names, for those of the truth; their times stay as they are. Three balls that meet may do so in
/// two or three collisions of one kind or of the other: what comes of it is the same.
fn order_like(group: &[Occurrence], found: &mut [Occurrence]) {
    let count = group.len();
    let known = |own: &Occurrence| group.iter().any(|it| it.event == own.event);
    let far = |j: &usize| (found[*j].elapsed - group[0].elapsed).abs();
    let places = 0..(found.len() + 1).saturating_sub(count);
    let places = places.filter(|j| found[*j..*j + count].iter().all(known));
    let Some(nearest) = places.min_by(|a, b| far(a).total_cmp(&far(b))) else { return };
    for (own, truth) in found[nearest..nearest + count].iter_mut().zip(group) {
        own.event = truth.event;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn events(list: &[(f64, usize)]) -> Vec<Occurrence> {
        let event = |(elapsed, event): &(f64, usize)| Occurrence {
            elapsed: *elapsed,
            event: *event,
            mode: Some(0),
        };
        list.iter().map(event).collect()
    }

    fn names(events: &[Occurrence]) -> Vec<usize> {
        events.iter().map(|it| it.event).collect()
    }

    #[test]
    fn events_of_one_instant_may_come_in_any_order() {
        let group = events(&[(1.0, 2), (1.0, 3), (1.0, 2)]);
        let mut found = events(&[(0.5, 1), (1.0, 3), (1.0, 2), (1.1, 3), (2.0, 1)]);
        order_like(&group, &mut found);
        assert_eq!(names(&found), [1, 2, 3, 2, 1]);
        assert_eq!(found[3].elapsed, 1.1);
    }

    #[test]
    fn other_events_and_other_counts_are_left_as_they_are() {
        let group = events(&[(1.0, 2), (1.0, 3)]);
        for list in [vec![(1.0, 2), (1.0, 1)], vec![(1.0, 3)], vec![]] {
            let mut found = events(&list);
            order_like(&group, &mut found);
            assert_eq!(found, events(&list));
        }
    }
}
