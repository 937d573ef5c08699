//! How far the exact solver is ahead of the engines, and what more it would take where that is too little.

use super::report::{Bench, Row};
use std::fmt;

/// How many times as long the least slow engine is to take, on every case.
pub const ASKED: f64 = 100.0;

/// A ratio in whole numbers, of which it is at least so many.
#[must_use]
pub fn times(ratio: f64) -> String {
    format!("{:.0}", ratio.floor())
}

/// By how much an engine on a case is slower than the exact solver, and how much less accurate.
#[derive(Clone, Debug)]
pub struct Lead<'a> {
    /// The adaptive engine that is least behind at its most accurate tolerance.
    pub next: &'a Row,
    /// How many times as long it takes.
    pub ratio: f64,
    /// Whether the exact solver errs less than every adaptive engine at any tolerance.
    pub most_accurate: bool,
}

/// The exact solver's lead on a case; nothing where no adaptive engine is right.
#[must_use]
pub fn lead<'a>(bench: &'a Bench, case: &str) -> Option<Lead<'a>> {
    let error = |row: &Row| row.state_error_max.unwrap_or(f64::INFINITY);
    let rows = || bench.results.iter().filter(|row| row.case == case);
    let exact = rows().find(|row| row.engine == "exact")?;
    let ratio = |row: &'a Row| Some((row, row.ratio_to_exact?));
    let engines = rows().filter(|row| row.adaptive && row.most_accurate).filter_map(ratio);
    let (next, ratio) = engines.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let most_accurate = rows().filter(|row| row.adaptive).all(|row| error(exact) <= error(row));
    Some(Lead { next, ratio, most_accurate })
}

impl fmt::Display for Lead<'_> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Row { case, engine, .. } = self.next;
        let setting = self.next.setting();
        let accuracy = if self.most_accurate { "errs less" } else { "does not err less" };
        write!(
            out,
            "{case}: adaptive engines at their best take at least {} times as long \
             ({engine} {setting}); exact {accuracy}",
            times(self.ratio)
        )
    }
}

/// A lead that may be too little, by what a switch takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shortfall<'a> {
    /// The case.
    pub case: &'a str,
    /// The engine that is least behind.
    pub engine: &'a str,
    /// How many times as long it takes.
    pub ratio: f64,
    /// What the exact solver takes in a run of the case, ns a period.
    pub exact: f64,
    /// Right-hand sides the engine takes a period.
    pub right_hand_sides: f64,
    /// Periods of the run for each of its switches.
    pub a_switch: f64,
    /// One evaluation at the least, ns.
    pub floor: f64,
}

impl<'a> Shortfall<'a> {
    /// What is missing on a case to [`ASKED`].
    #[must_use]
    pub fn of(bench: &'a Bench, case: &'a str) -> Option<Self> {
        let Lead { next, ratio, .. } = lead(bench, case)?;
        let entry = bench.cases.iter().find(|it| it.case == case)?;
        let own = |row: &&Row| row.case == case && row.engine == "exact";
        let it = Self {
            case,
            engine: next.engine,
            ratio,
            exact: bench.results.iter().find(own)?.ns_per_period?,
            right_hand_sides: next.rhs_per_period?,
            a_switch: entry.periods / entry.switches as f64,
            floor: bench.floor.chained_ns,
        };
        Some(it).filter(Self::is_one)
    }

    /// Whether the lead is less than [`ASKED`], in a run that has switches.
    #[must_use]
    pub fn is_one(&self) -> bool {
        self.ratio < ASKED && self.a_switch.is_finite()
    }
}

impl fmt::Display for Shortfall<'_> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { case, engine, ratio, a_switch, floor, .. } = *self;
        let (exact, right_hand_sides) = (self.exact * a_switch, self.right_hand_sides * a_switch);
        let asked = exact * ratio / ASKED;
        write!(
            out,
            "{case}: {ASKED} times would be a switch in {asked:.0} ns or {:.1} floors, not {exact:.0} or {:.1}; \
             {engine} takes {right_hand_sides:.0} right-hand sides for one, of {:.0} ns each",
            asked / floor,
            exact / floor,
            exact * ratio / right_hand_sides,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::super::report::{CaseEntry, Floor};
    use super::*;
    use crate::build::Build;

    const CASE: &str = "fast";

    fn row(engine: &'static str, ns_per_period: f64, ratio: f64, error: f64) -> Row {
        Row {
            case: CASE.to_owned(),
            engine,
            tolerance: (engine != "exact").then_some(1e-12),
            step: None,
            ns_per_period: Some(ns_per_period),
            state_error_max: Some(error),
            event_time_error_max: Some(error),
            ratio_to_exact: Some(ratio),
            rhs_per_period: Some(400.0),
            most_accurate: true,
            adaptive: engine != "exact",
            why: None,
        }
    }

    /// Two switches a period.
    fn bench(ratio: f64, switches: usize) -> Bench {
        let exact = row("exact", 320.0, 1.0, 1e-15);
        let engine = row("an-engine", 320.0 * ratio, ratio, 1e-12);
        Bench {
            build: Build::this(),
            rounds: 1,
            cases: vec![CaseEntry {
                case: CASE.to_owned(),
                regime: String::new(),
                periods: 10.0,
                switches,
            }],
            results: vec![exact, engine, row("another", 1e9, 1e6, 1e-9)],
            floor: Floor { chained_ns: 40.0, independent_ns: 20.0 },
            switches: Vec::new(),
            length: Vec::new(),
            damping: Vec::new(),
        }
    }

    #[test]
    fn what_is_missing_is_said_in_units_of_a_switch() {
        let bench = bench(50.0, 20);
        assert_eq!(
            Shortfall::of(&bench, CASE).map(|it| it.to_string()).as_deref(),
            Some(
                "fast: 100 times would be a switch in 80 ns or 2.0 floors, not 160 or 4.0; \
                 an-engine takes 200 right-hand sides for one, of 40 ns each"
            )
        );
    }

    #[test]
    fn a_lead_is_enough_or_not_in_what_is_said_of_it_as_well() {
        for (ratio, said, enough) in
            [(99.9, "at least 99 times", false), (100.0, "100 times", true)]
        {
            let bench = bench(ratio, 20);
            let line = lead(&bench, CASE).map(|it| it.to_string()).unwrap_or_default();
            assert!(line.contains(said) && line.contains("an-engine 1e-12"), "{line}");
            assert_eq!(Shortfall::of(&bench, CASE).is_none(), enough);
        }
        assert_eq!(Shortfall::of(&bench(50.0, 0), CASE), None);
    }
}
