//! The places of engines, by what the bootstrap tells apart.

use super::{Ranked, is_ahead};

/// An engine that is to be placed.
pub(super) struct Entry {
    /// Its figures.
    pub ranked: Ranked,
    /// The mean score of each draw of the bootstrap.
    pub means: Vec<f64>,
    /// Whether it is the exact reference.
    pub is_exact: bool,
    /// Whether it is not installed.
    pub is_absent: bool,
}

impl Entry {
    const fn has_rank(&self) -> bool {
        !self.is_exact && !self.is_absent
    }

    fn is_better_than(&self, other: &Self) -> bool {
        match (self.ranked.clean, other.ranked.clean) {
            (true, false) => true,
            (false, true) => false,
            _ => is_ahead(&self.means, &other.means),
        }
    }
}

/// Numbers the places and sorts by them: the reference, the ranks, and what is not installed.
pub(super) fn place(engines: Vec<Entry>) -> Vec<Ranked> {
    let rank = |it: &Entry| {
        let better = engines.iter().filter(|other| other.has_rank() && other.is_better_than(it));
        match it {
            it if it.is_absent => None,
            it if it.is_exact => Some(0),
            _ => Some(1 + better.count()),
        }
    };
    let placed = |it: &Entry| Ranked { rank: rank(it), ..it.ranked.clone() };
    let mut ranking: Vec<Ranked> = engines.iter().map(placed).collect();
    let place = |it: &Ranked| it.rank.unwrap_or(usize::MAX);
    ranking.sort_by(|a, b| place(a).cmp(&place(b)).then(b.share().total_cmp(&a.share())));
    ranking
}
