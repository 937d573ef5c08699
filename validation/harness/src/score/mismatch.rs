//! The events that an engine and the truth do not share, and those of them that a graze excuses.

use super::graze::Graze;
use super::matching::Matching;
use super::occurrence::Occurrence;

/// Missed and spurious events up to the scored horizon.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Mismatch {
    /// Indices of the truth's events that the engine does not have.
    pub missed: Vec<usize>,
    /// Indices of the engine's events that the truth does not have.
    pub spurious: Vec<usize>,
    /// Indices of the truth's missed events, beyond the scored horizon too.
    lost: Vec<usize>,
    /// Indices of the engine's spurious events, beyond the scored horizon too.
    extra: Vec<usize>,
    /// The number of true events before the scored horizon.
    expected: usize,
    /// Indices of the engine's events that are before it, or matched to one that is.
    counted: Vec<usize>,
}

/// The part of a mismatch that grazes excuse.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Excused {
    /// Indices of missed events.
    pub missed: Vec<usize>,
    /// Indices of spurious events.
    pub spurious: Vec<usize>,
    /// The grazes that excuse them, as (time since the start, margin).
    pub grazes: Vec<(f64, f64)>,
}

impl Mismatch {
    /// What a matching of `rows` events of the truth and `own` of the engine leaves over of the
    /// first `expected` and the first `counted` of them.
    #[must_use]
    pub fn new(
        matching: &Matching,
        (rows, expected): (usize, usize),
        (own, counted): (usize, usize),
    ) -> Self {
        let partner = |j: usize| matching.pairs.iter().find(|(_, own)| *own == j).map(|it| it.0);
        let found = |i: &usize| matching.pairs.iter().any(|(truth, _)| truth == i);
        // An event just past the horizon may be the partner of one just before it.
        let last = matching.pairs.iter().filter(|(i, _)| *i < expected).map(|(_, j)| j + 1).max();
        let before = (0..counted.max(last.unwrap_or(0))).filter(|j| match partner(*j) {
            Some(i) => i < expected,
            None => *j < counted,
        });
        let lost: Vec<_> = (0..rows).filter(|i| !found(i)).collect();
        let extra: Vec<_> = (0..own).filter(|j| partner(*j).is_none()).collect();
        Self {
            missed: lost.iter().copied().filter(|i| *i < expected).collect(),
            spurious: extra.iter().copied().filter(|j| *j < counted).collect(),
            lost,
            extra,
            expected,
            counted: before.collect(),
        }
    }

    /// Whether the phases follow each other alike once what is excused is left out.
    #[must_use]
    pub fn same_phases(
        &self,
        rows: &[Occurrence],
        found: &[Occurrence],
        excused: &Excused,
    ) -> bool {
        let truth = (0..self.expected).filter(|i| !excused.missed.contains(i));
        let own = self.counted.iter().filter(|j| !excused.spurious.contains(j));
        truth.clone().count() == own.clone().count()
            && truth.zip(own).all(|(i, j)| rows[i].is_like(&found[*j]))
    }

    /// What the grazes excuse that an engine which may err by `allowed` units need not decide: all
    /// events of a touch together, or the spurious ones within `window` of a near miss that a
    /// crossing there would make. The scored horizon may lie between them.
    #[must_use]
    pub fn excused_by(
        &self,
        grazes: &[Graze],
        found: &[Occurrence],
        window: f64,
        allowed: f64,
    ) -> Excused {
        let mut excused = Excused::default();
        for graze in grazes.iter().filter(|it| it.is_undecidable(allowed)) {
            let missed: Vec<_> =
                graze.events.iter().copied().filter(|i| self.missed.contains(i)).collect();
            let whole = graze.events.iter().all(|i| self.lost.contains(i));
            let touch = graze.events.len() == graze.makes && whole && !missed.is_empty();
            let crossing = if graze.events.is_empty() {
                self.spurious_crossing(graze, found, window, &excused)
            } else {
                None
            };
            if touch || crossing.is_some() {
                excused.grazes.push((graze.elapsed, graze.margin));
            }
            excused.missed.extend(missed.into_iter().filter(|_| touch));
            let scored = |j: &usize| self.spurious.contains(j);
            excused.spurious.extend(crossing.into_iter().flatten().filter(scored));
        }
        excused
    }

    /// The spurious events in a row that a crossing at a near miss would make: out of the mode and
    /// back into it, or one that comes back by itself. The last may lie beyond the scored horizon.
    fn spurious_crossing(
        &self,
        graze: &Graze,
        found: &[Occurrence],
        window: f64,
        excused: &Excused,
    ) -> Option<Vec<usize>> {
        let near = |j: usize| (found[j].elapsed - graze.elapsed).abs() <= window;
        let free = |j: usize| near(j) && !excused.spurious.contains(&j);
        let crossing = self.extra.windows(graze.makes).find(|own| {
            let (first, last) = (own[0], own[graze.makes - 1]);
            self.spurious.contains(&first)
                // Of a system other events may lie between the two.
                && (graze.event.is_some() || last + 1 == first + graze.makes)
                && own.iter().all(|j| graze.event.is_none_or(|event| found[*j].event == event))
                && own.iter().all(|j| free(*j))
                && graze.begins_with(&found[first])
                && found[last].mode == Some(graze.mode)
        })?;
        Some(crossing.to_vec())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::place;
    use percuss::Phase::{self, Contact, NoContact};

    const WINDOW: f64 = 0.1;

    fn event((elapsed, phase): (f64, Phase)) -> Occurrence {
        Occurrence { elapsed, event: 0, mode: Some(place(phase)) }
    }

    fn graze(elapsed: f64, margin: f64, events: impl IntoIterator<Item = usize>) -> Graze {
        Graze {
            elapsed,
            margin,
            growth: 1.0,
            events: events.into_iter().collect(),
            mode: place(NoContact),
            event: None,
            ends: true,
            makes: 2,
        }
    }

    fn mismatch(
        truth: &[(f64, Phase)],
        own: &[(f64, Phase)],
    ) -> (Mismatch, Vec<Occurrence>, Vec<Occurrence>) {
        let rows: Vec<_> = truth.iter().copied().map(event).collect();
        let found: Vec<_> = own.iter().copied().map(event).collect();
        let matching = Matching::new(&rows, &found, WINDOW);
        let (all, own) = (rows.len(), found.len());
        (Mismatch::new(&matching, (all, all), (own, own)), rows, found)
    }

    #[test]
    fn events_at_the_end_and_in_the_middle_are_spurious() {
        let truth = [(1.0, Contact), (2.0, NoContact)];
        let end = [(1.0, Contact), (2.0, NoContact), (3.0, Contact), (3.1, NoContact)];
        let (found, rows, own) = mismatch(&truth, &end);
        assert_eq!((found.missed.len(), found.spurious.clone()), (0, vec![2, 3]));
        assert!(!found.same_phases(&rows, &own, &Excused::default()));
        let middle = [(1.0, Contact), (1.3, NoContact), (1.6, Contact), (2.0, NoContact)];
        let (found, ..) = mismatch(&truth, &middle);
        assert_eq!(found.spurious, [1, 2]);
    }

    #[test]
    fn a_touch_within_what_is_allowed_is_excused_whole_and_alone() {
        let truth = [(1.0, Contact), (1.01, NoContact), (2.0, Contact), (3.0, NoContact)];
        let (found, rows, own) = mismatch(&truth, &truth[2..]);
        let grazes = [graze(1.005, 1e-6, 0..2)];
        let excused = found.excused_by(&grazes, &own, WINDOW, 1e-6);
        assert_eq!(excused.missed, [0, 1]);
        assert!(found.same_phases(&rows, &own, &excused));
        assert_eq!(found.excused_by(&grazes, &own, WINDOW, 0.9e-6), Excused::default());
        // Half of a touch is no answer.
        let (half, _, own) = mismatch(&truth, &truth[1..]);
        assert_eq!(half.excused_by(&grazes, &own, WINDOW, 1.0), Excused::default());
        // Another miss is not the graze's.
        let (other, _, own) = mismatch(&truth, &truth[3..]);
        assert_eq!(other.excused_by(&grazes, &own, WINDOW, 1.0).missed, [0, 1]);
        assert_eq!(other.missed, [0, 1, 2]);
    }

    #[test]
    fn a_graze_on_the_scored_horizon_is_excused_as_one_before_it_is() {
        // The horizon lies between the two events of the pair, then of the touch.
        let pair = [(1.0, Contact), (1.01, NoContact)];
        let found: Vec<_> = pair.into_iter().map(event).collect();
        let spurious = Mismatch::new(&Matching::new(&[], &found, WINDOW), (0, 0), (2, 1));
        assert_eq!(spurious.spurious, [0]);
        let near_miss = [graze(1.0, -1e-6, 0..0)];
        let excused = spurious.excused_by(&near_miss, &found, WINDOW, 1e-6);
        assert_eq!(excused.spurious, [0]);
        assert!(spurious.same_phases(&[], &found, &excused));
        let rows: Vec<_> = pair.into_iter().map(event).collect();
        let missed = Mismatch::new(&Matching::new(&rows, &[], WINDOW), (2, 1), (0, 0));
        let excused = missed.excused_by(&[graze(1.005, 1e-6, 0..2)], &[], WINDOW, 1e-6);
        assert_eq!((excused.missed.as_slice(), excused.grazes.len()), (&[0][..], 1));
        // One that comes back otherwise is none, nor is half of a touch.
        let other: Vec<_> = [(1.0, Contact), (1.5, NoContact)].into_iter().map(event).collect();
        let late = Mismatch::new(&Matching::new(&[], &other, WINDOW), (0, 0), (2, 1));
        assert_eq!(late.excused_by(&near_miss, &other, WINDOW, 1.0), Excused::default());
        let half = Mismatch::new(&Matching::new(&rows, &found[1..], WINDOW), (2, 1), (1, 0));
        assert_eq!(half.missed, [0]);
        assert_eq!(
            half.excused_by(&[graze(1.005, 1e-6, 0..2)], &found[1..], WINDOW, 1.0),
            Excused::default()
        );
    }

    #[test]
    fn a_spurious_pair_at_a_near_miss_is_excused_once() {
        let own = [(1.0, Contact), (1.01, NoContact), (1.02, Contact), (1.03, NoContact)];
        let (found, _, own) = mismatch(&[], &own);
        let grazes = [graze(1.0, -1e-6, 0..0)];
        assert_eq!(found.excused_by(&grazes, &own, WINDOW, 1e-6).spurious, [0, 1]);
        assert_eq!(
            found.excused_by(&[graze(2.0, -1e-6, 0..0)], &own, WINDOW, 1.0).spurious,
            [0; 0]
        );
    }
}
