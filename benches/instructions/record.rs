//! What each bench has been recorded to take, with the reason of the last change.

/// By how much a count may exceed its record.
#[derive(Clone, Copy, Debug)]
pub enum Grain {
    /// One thing done once or a few times: half a per cent.
    Micro,
    /// Whole runs: one per cent, since a change of rounding takes a chaotic run elsewhere.
    EndToEnd,
}

impl Grain {
    const fn share(self) -> f64 {
        match self {
            Self::Micro => 0.005,
            Self::EndToEnd => 0.01,
        }
    }
}

/// The most instructions that a bench may take: one, so that it fails, if there is no record of it.
#[must_use]
pub fn limit(bench: &str, grain: Grain) -> u64 {
    let rows = include_str!("record.csv").lines().skip(1);
    let recorded = rows.map(|row| row.splitn(3, ',')).find_map(|mut row| {
        (row.next()? == bench).then(|| row.next()?.parse::<u64>().ok())?
    });
    recorded.map_or(1, |recorded| (recorded as f64 * (1.0 + grain.share())) as u64)
}
