//! The closest competitor of the exact solver on a case, at its most accurate and at equal
//! accuracy, by times that are net of the harness's own share.

use super::equal_accuracy::{Basis, LOOSE_ERROR, MAX_COMPARABLE_RATIO, TIGHT_ERROR};
use super::report::{Bench, BenchRow};
use crate::engine::REFERENCE;
use crate::number::{brief, shortest};

/// A ratio in whole numbers, below ten in tenths, rounded down: it is at least so many times.
#[must_use]
pub fn times(ratio: f64) -> String {
    if ratio < 10.0 {
        format!("{:.1}", (10.0 * ratio).floor() / 10.0)
    } else {
        format!("{:.0}", ratio.floor())
    }
}

/// The closest competitor of the exact solver on a case.
#[derive(Clone, Debug)]
pub struct ClosestCompetitor<'a> {
    /// The basis on which engines are compared.
    pub basis: Basis,
    /// The adaptive engine that takes least: its most accurate setting, or its fastest setting
    /// whose error is at most that of the basis.
    pub row: &'a BenchRow,
    /// The competitor's time without the harness's own share over the exact solver's.
    pub net: f64,
}

impl ClosestCompetitor<'_> {
    /// The accuracy that the competitor is timed at, for a table.
    #[must_use]
    pub fn accuracy(&self) -> String {
        match self.basis {
            Basis::MostAccurate => {
                format!("least: {}", self.row.state_error_max.map(brief).unwrap_or_default())
            }
            Basis::Comparable => format!("<= {} * exact", shortest(MAX_COMPARABLE_RATIO)),
            Basis::Tight => format!("<= {}", shortest(TIGHT_ERROR)),
            Basis::Loose => format!("<= {}", shortest(LOOSE_ERROR)),
        }
    }
}

/// The closest competitor on a case; nothing where no adaptive engine is as accurate as the basis
/// asks.
#[must_use]
pub fn closest_competitor<'a>(
    bench: &'a Bench,
    case: &str,
    basis: Basis,
) -> Option<ClosestCompetitor<'a>> {
    let rows = bench.results.iter().filter(|row| row.case == case && row.adaptive);
    let ahead = |row: &'a BenchRow| Some((row, row.net_ratio(basis)?));
    // Of an engine's settings that share a ratio the fastest comes first.
    let order =
        |(row, net): &(&BenchRow, f64)| (*net, row.net_ns_per_period().unwrap_or(f64::INFINITY));
    let least = rows.filter(|row| row.meets(basis)).filter_map(ahead).min_by(|a, b| {
        let ((a, time), (b, other)) = (order(a), order(b));
        a.total_cmp(&b).then(time.total_cmp(&other))
    });
    least.map(|(row, net)| ClosestCompetitor { basis, row, net })
}

/// Whether the exact solver errs less on a case than every adaptive engine at any tolerance.
#[must_use]
pub fn errs_least(bench: &Bench, case: &str) -> bool {
    let error = |row: &BenchRow| row.state_error_max.unwrap_or(f64::INFINITY);
    let rows = || bench.results.iter().filter(|row| row.case == case);
    let exact = rows().find(|row| row.engine == REFERENCE).map_or(f64::INFINITY, error);
    rows().filter(|row| row.adaptive).all(|row| exact <= error(row))
}

#[cfg(test)]
mod tests {
    use super::super::report::{CaseEntry, EventCost, Floor};
    use super::*;
    use crate::provenance::Build;

    const CASE: &str = "fast";

    fn row(engine: &str, ns_per_period: f64, ratio: f64, error: f64) -> BenchRow {
        BenchRow {
            case: CASE.to_owned(),
            engine: engine.to_owned(),
            tolerance: (engine != "exact").then_some(1e-12),
            step: None,
            ns_per_period: Some(ns_per_period),
            state_error_max: Some(error),
            event_time_error_max: Some(error),
            ratio_to_exact: Some(ratio),
            ratio_at_comparable_error: None,
            ratio_at_1e_6: Some(0.5 * ratio),
            ratio_at_1e_9: None,
            net_ratio_to_exact: Some(0.75 * ratio),
            net_ratio_at_comparable_error: None,
            net_ratio_at_1e_6: Some(0.375 * ratio),
            net_ratio_at_1e_9: None,
            harness_share: Some(0.25),
            harness_share_spread: Some(0.01),
            rhs_per_period: Some(400.0),
            most_accurate: true,
            comparable: engine == "exact",
            adaptive: engine != "exact",
            why: None,
        }
    }

    /// Two events per period.
    fn bench(ratio: f64, events: usize) -> Bench {
        let exact = row("exact", 320.0, 1.0, 1e-15);
        let engine = row("an-engine", 320.0 * ratio, ratio, 1e-12);
        let (entry, floor) = (
            CaseEntry { case: CASE.to_owned(), regime: String::new(), periods: 10.0, events },
            Floor { chained_ns: 40.0, independent_ns: 20.0 },
        );
        Bench {
            build: Build::new("", "rustc", "any"),
            rounds: 1,
            events: vec![EventCost::new(&entry, Some(&exact), floor)],
            cases: vec![entry],
            results: vec![exact, engine, row("another", 1e9, 1e6, 1e-9)],
            floor,
            length: Vec::new(),
            damping: Vec::new(),
        }
    }

    #[test]
    fn the_table_has_the_time_and_the_floors_of_an_event() {
        let bench = bench(50.0, 20);
        assert_eq!(bench.events[0].ns_per_event, Some(160.0));
        assert_eq!(bench.events[0].floors_per_event, Some(4.0));
        let table = crate::summary(&bench);
        let line = table.lines().find(|line| line.starts_with(CASE)).unwrap_or_default();
        let cells: Vec<_> = line.split_whitespace().collect();
        assert_eq!(cells[..4], [CASE, "20", "160", "4.0"], "{table}");
    }

    #[test]
    fn a_ratio_is_rounded_down() {
        for (ratio, said) in [(133.2, "99"), (100.0 / 0.75, "100"), (1.0, "0.7")] {
            let bench = bench(ratio, 20);
            let closest = closest_competitor(&bench, CASE, Basis::MostAccurate);
            let closest = closest.map(|it| (it.row.engine.clone(), times(it.net)));
            assert_eq!(closest, Some(("an-engine".to_owned(), said.to_owned())));
        }
    }

    /// The engine that leads may be another one without what the harness adds to it.
    #[test]
    fn the_closest_competitor_is_so_without_the_harness() {
        let mut bench = bench(50.0, 20);
        bench.results.push(BenchRow {
            net_ratio_to_exact: Some(30.0),
            harness_share: Some(0.5),
            ..row("searched", 19_200.0, 60.0, 1e-12)
        });
        let closest = closest_competitor(&bench, CASE, Basis::MostAccurate);
        let closest = closest.map(|it| (it.row.engine.as_str(), it.net, it.row.ratio(it.basis)));
        assert_eq!(closest, Some(("searched", 30.0, Some(60.0))));
    }

    #[test]
    fn competitors_are_compared_at_equal_accuracy() {
        let mut bench = bench(50.0, 20);
        // Fast but inaccurate at this setting: it counts where its curve reaches the error.
        let quick = BenchRow { most_accurate: false, ..row("quick", 320.0, 1.0, 1e-5) };
        let reaches = BenchRow {
            net_ratio_at_1e_6: quick.net_ratio_at_1e_6,
            ..row("quick", 6400.0, 20.0, 1e-8)
        };
        bench.results.extend([quick, reaches]);
        let at = |basis| {
            closest_competitor(&bench, CASE, basis)
                .map(|it| (it.row.engine.as_str(), it.net, it.accuracy()))
        };
        assert_eq!(at(Basis::MostAccurate), Some(("quick", 15.0, "least: 1.0e-8".to_owned())));
        assert_eq!(at(Basis::Loose), Some(("quick", 0.375, "<= 1e-6".to_owned())));
        assert_eq!(at(Basis::Tight), None);
        // Nobody errs as little as the exact solver until one does.
        assert_eq!(at(Basis::Comparable), None);
        let reached =
            closest_competitor(&bench, CASE, Basis::Loose).and_then(|it| it.row.ns_per_period);
        assert_eq!(reached, Some(6400.0));
        assert!(errs_least(&bench, CASE));
        let lucky = row("lucky", 1e9, 1e6, 1e-16);
        bench.results.push(BenchRow {
            comparable: true,
            net_ratio_at_comparable_error: Some(30.0),
            ..lucky
        });
        assert!(!errs_least(&bench, CASE));
        let comparable = closest_competitor(&bench, CASE, Basis::Comparable);
        let said = comparable.map(|it| (it.row.engine.as_str(), it.net, it.accuracy()));
        assert_eq!(said, Some(("lucky", 30.0, "<= 10 * exact".to_owned())));
    }
}
