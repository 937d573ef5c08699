//! How far the exact solver is ahead of the engines, and what more it would take where that is too little.

use super::report::{Bench, Row};
use crate::number::shortest;
use std::fmt;

/// How many times as long the least slow engine is to take, on every case.
pub const ASKED: f64 = 100.0;

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
        let Row { case, engine, tolerance, .. } = self.next;
        let tolerance = tolerance.map(shortest).unwrap_or_default();
        let accuracy = if self.most_accurate { "errs less" } else { "does not err less" };
        write!(
            out,
            "{case}: adaptive engines at their best take at least {:.0} times as long \
             ({engine} {tolerance}); exact {accuracy}",
            self.ratio
        )
    }
}

/// A lead that is too little, by what a switch takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shortfall<'a> {
    /// The case.
    pub case: &'a str,
    /// The engine that is least behind.
    pub engine: &'a str,
    /// How many times as long it takes.
    pub ratio: f64,
    /// What a switch takes the exact solver in a run of the case, ns.
    pub exact: f64,
    /// One evaluation at the least, ns.
    pub floor: f64,
    /// Right-hand sides the engine takes for a switch.
    pub right_hand_sides: f64,
}

impl<'a> Shortfall<'a> {
    /// What is missing on a case to [`ASKED`].
    #[must_use]
    pub fn of(bench: &'a Bench, case: &'a str) -> Option<Self> {
        let Lead { next, ratio, .. } = lead(bench, case)?;
        let entry = bench.cases.iter().find(|it| it.case == case)?;
        let own = |row: &&Row| row.case == case && row.engine == "exact";
        let exact = bench.results.iter().find(own)?.ns_per_period?;
        let a_switch = entry.periods / entry.switches as f64;
        let it = Self {
            case,
            engine: next.engine,
            ratio,
            exact: exact * a_switch,
            floor: bench.floor.chained_ns,
            right_hand_sides: next.rhs_per_period? * a_switch,
        };
        Some(it).filter(Self::is_one)
    }

    /// Whether the lead is less than [`ASKED`].
    #[must_use]
    pub fn is_one(&self) -> bool {
        self.ratio < ASKED
    }
}

impl fmt::Display for Shortfall<'_> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { case, engine, ratio, exact, floor, right_hand_sides } = *self;
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
    use super::*;

    #[test]
    fn what_is_missing_is_said_in_units_of_a_switch() {
        let shortfall = Shortfall {
            case: "fast",
            engine: "an-engine",
            ratio: 50.0,
            exact: 160.0,
            floor: 40.0,
            right_hand_sides: 200.0,
        };
        assert_eq!(
            shortfall.to_string(),
            "fast: 100 times would be a switch in 80 ns or 2.0 floors, not 160 or 4.0; \
             an-engine takes 200 right-hand sides for one, of 40 ns each"
        );
    }
}
