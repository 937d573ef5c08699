//! Matches an engine's events to the true events.

use super::occurrence::Occurrence;

/// Two events are the same if they are alike and at most this apart, in forcing periods.
pub const WINDOW: f64 = 0.05;

/// A pairing of events in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Matching {
    /// Indices into the truth's and the engine's events.
    pub pairs: Vec<(usize, usize)>,
}

impl Matching {
    /// The pairing in order with the most pairs, and among those the least sum of time differences.
    #[must_use]
    pub fn new(truth: &[Occurrence], engine: &[Occurrence], window: f64) -> Self {
        let width = engine.len() + 1;
        let better = |a: (usize, f64), b: (usize, f64)| a.0 > b.0 || (a.0 == b.0 && a.1 < b.1);
        // best[i * width + j]: pairs and their cost among the first i and j events.
        let mut best = vec![(0_usize, 0.0_f64); (truth.len() + 1) * width];
        let paired = |i: usize, j: usize, best: &[(usize, f64)]| {
            let apart = (truth[i - 1].elapsed - engine[j - 1].elapsed).abs();
            let same = truth[i - 1].is_like(&engine[j - 1]) && apart <= window;
            let (count, cost) = best[(i - 1) * width + j - 1];
            same.then_some((count + 1, cost + apart))
        };
        for i in 1..=truth.len() {
            for j in 1..=engine.len() {
                let (skip_truth, skip_engine) =
                    (best[(i - 1) * width + j], best[i * width + j - 1]);
                let mut here =
                    if better(skip_truth, skip_engine) { skip_truth } else { skip_engine };
                if let Some(pair) = paired(i, j, &best).filter(|pair| better(*pair, here)) {
                    here = pair;
                }
                best[i * width + j] = here;
            }
        }
        let mut pairs = Vec::new();
        let (mut i, mut j) = (truth.len(), engine.len());
        while i > 0 && j > 0 {
            let here = best[i * width + j];
            if here == best[(i - 1) * width + j] {
                i -= 1;
            } else if here == best[i * width + j - 1] {
                j -= 1;
            } else {
                (i, j) = (i - 1, j - 1);
                pairs.push((i, j));
            }
        }
        pairs.reverse();
        Self { pairs }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::place;
    use percuss::Phase;
    use percuss::Phase::{Contact, NoContact, Progression};

    fn events(events: &[(f64, Phase)]) -> Vec<Occurrence> {
        let event = |(elapsed, phase): &(f64, Phase)| Occurrence {
            elapsed: *elapsed,
            event: 0,
            mode: Some(place(*phase)),
        };
        events.iter().map(event).collect()
    }

    const TRUTH: [(f64, Phase); 4] =
        [(1.0, Contact), (1.5, NoContact), (3.0, Contact), (3.2, Progression)];

    #[test]
    fn a_missed_and_a_spurious_event_are_told_apart() {
        let found = [(1.01, Contact), (3.0, Contact), (3.1, NoContact), (3.2, Progression)];
        let matching = Matching::new(&events(&TRUTH), &events(&found), 0.05);
        assert_eq!(matching.pairs, [(0, 0), (2, 1), (3, 3)]);
    }

    #[test]
    fn the_nearer_of_two_candidates_is_taken() {
        let found = [(0.96, Contact), (1.001, Contact)];
        let matching = Matching::new(&events(&TRUTH), &events(&found), 0.05);
        assert_eq!(matching.pairs, [(0, 1)]);
    }

    #[test]
    fn events_of_other_names_are_not_the_same() {
        let named = |event, mode| Occurrence { elapsed: 1.0, event, mode };
        assert!(Matching::new(&[named(1, Some(2))], &[named(0, Some(2))], 0.05).pairs.is_empty());
        // Between events of one instant the mode is a matter of their order.
        assert_eq!(Matching::new(&[named(1, None)], &[named(1, Some(2))], 0.05).pairs, [(0, 0)]);
    }

    #[test]
    fn a_nan_matches_nothing() {
        let matching = Matching::new(&events(&TRUTH), &events(&[(f64::NAN, Contact)]), 0.05);
        assert!(matching.pairs.is_empty());
    }
}
