//! What each bench has been recorded to take, with the reason of the last change.

/// Instructions by which any count may exceed its record. Four of the small benches took 12 more
/// on another machine at the very commit that wrote their record; a third of that is room for a
/// third machine.
const MACHINE_TOLERANCE_INSTRUCTIONS: f64 = 16.0;

/// Excess over its record that a count may have, where that is more than
/// `MACHINE_TOLERANCE_INSTRUCTIONS`.
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
    let recorded = rows
        .map(|row| row.splitn(3, ','))
        .find_map(|mut row| (row.next()? == bench).then(|| row.next()?.parse::<u64>().ok())?);
    recorded.map_or(1, |recorded| above(recorded, grain))
}

fn above(recorded: u64, grain: Grain) -> u64 {
    let recorded = recorded as f64;
    (recorded + (recorded * grain.share()).max(MACHINE_TOLERANCE_INSTRUCTIONS)) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_row_may_differ_as_two_machines_do_and_no_more() {
        assert_eq!(above(435, Grain::Micro), 451);
        assert_eq!(above(3022, Grain::Micro), 3038);
    }

    #[test]
    fn a_large_row_may_differ_by_its_share() {
        assert_eq!(above(10_000, Grain::Micro), 10_050);
        assert_eq!(above(7_000_000, Grain::EndToEnd), 7_070_000);
    }

    #[test]
    fn a_bench_without_a_record_fails() {
        assert_eq!(limit("no/such", Grain::Micro), 1);
    }
}
