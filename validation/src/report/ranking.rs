//! The engines in order: which one finds the truth's events, and at what cost.
//!
//! The rule: by (events found - spurious events) as a share of all events of all cases and
//! settings, where events that were not run or not scored count as not found; of equals the one
//! that needs fewer right-hand sides per event at an error of 1e-6 comes first. Exact engines stand
//! above, as the reference.

use super::ReportRow;
use crate::engine::Accuracy;
use crate::score::{Spread, Verdict};
use crate::suite::{Scored, Status};
use serde::Serialize;

/// The error of event times at which costs are compared, units of time.
pub const COMPARED_AT: f64 = 1e-6;

/// An engine's place in the ranking.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ranked {
    /// The engine.
    pub engine: &'static str,
    /// The engine's place among the integrators, from 1; 0 for the exact reference.
    pub rank: usize,
    /// The truth's events that it has, of those that were scored.
    pub events_found: usize,
    /// The truth's events that were scored.
    pub events_checked: usize,
    /// The truth's events on all cases at all settings.
    pub events_total: usize,
    /// Scored events that it does not have.
    pub events_missed: usize,
    /// The engine's events that the truth does not have.
    pub events_spurious: usize,
    /// Cases with a row that fails or errs, expected failures included.
    pub fails_on: Vec<String>,
    /// Errors of event times over tolerance x (1 + |value|) x growth x events so far; eps stands in
    /// for the tolerance of the exact solver, and step^p/(p + 1)! for that of a fixed step.
    pub event_time_error_units: Units,
    /// Right-hand sides per event where the largest event-time error is [`COMPARED_AT`]: the median
    /// over the cases on which its settings reach that error.
    pub rhs_per_event: Option<f64>,
}

/// Errors of event times in units of what is allowed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Units {
    /// The median.
    pub median: f64,
    /// The largest.
    pub max: f64,
}

impl Ranked {
    /// Events found less spurious ones, as a share of all events; what ranks.
    #[must_use]
    pub fn share(&self) -> f64 {
        (self.events_found as f64 - self.events_spurious as f64) / self.events_total.max(1) as f64
    }

    /// Whether it is the exact reference, which has no rank.
    #[must_use]
    pub const fn is_reference(&self) -> bool {
        self.rank == 0
    }
}

/// Ranks the engines of a run; `rows` are the report's rows of `scored`, in the same order.
pub(super) fn ranking(scored: &[Scored], rows: &[ReportRow]) -> Vec<Ranked> {
    let mut engines: Vec<&'static str> = Vec::new();
    for row in scored {
        if !engines.contains(&row.engine) {
            engines.push(row.engine);
        }
    }
    let both: Vec<_> = scored.iter().zip(rows).collect();
    let of = |engine: &&'static str| {
        one(engine, both.iter().filter(|(row, _)| row.engine == *engine).copied().collect())
    };
    place(engines.iter().map(of).collect())
}

/// Sorts by the rule and numbers the places.
fn place(engines: Vec<(Ranked, bool)>) -> Vec<Ranked> {
    let (exact, mut others): (Vec<_>, Vec<_>) = engines.into_iter().partition(|it| it.1);
    let cost = |it: &Ranked| it.rhs_per_event.unwrap_or(f64::INFINITY);
    others.sort_by(|(a, _), (b, _)| {
        b.share().total_cmp(&a.share()).then(cost(a).total_cmp(&cost(b)))
    });
    let numbered = others.into_iter().zip(1..).map(|((it, _), rank)| Ranked { rank, ..it });
    exact.into_iter().map(|it| it.0).chain(numbered).collect()
}

/// An engine's figures without its place, and whether it is exact.
fn one(engine: &'static str, rows: Vec<(&Scored, &ReportRow)>) -> (Ranked, bool) {
    let exact = rows.iter().all(|(scored, _)| scored.accuracy == Accuracy::Exact);
    let counted = || rows.iter().filter_map(|(scored, row)| Counted::of(scored, row));
    let sum = |count: fn(&Counted) -> usize| counted().map(|it| count(&it)).sum();
    let units: Vec<f64> = counted().flat_map(|it| it.units).collect();
    let Spread { median, max, .. } = Spread::of(units);
    let bad =
        |row: &ReportRow| matches!(row.verdict, Verdict::Fail | Verdict::Error | Verdict::Known);
    let mut fails_on: Vec<String> =
        rows.iter().filter(|(_, row)| bad(row)).map(|(_, row)| row.case.clone()).collect();
    fails_on.dedup();
    let ranked = Ranked {
        engine,
        rank: 0,
        events_found: sum(|it| it.found),
        events_checked: sum(|it| it.checked),
        events_total: rows.iter().map(|(scored, _)| scored.events).sum(),
        events_missed: sum(|it| it.missed),
        events_spurious: sum(|it| it.spurious),
        fails_on,
        event_time_error_units: Units { median, max },
        rhs_per_event: rhs_per_event(&rows, exact),
    };
    (ranked, exact)
}

/// The counts of one row: zero if nothing could be judged.
struct Counted {
    found: usize,
    checked: usize,
    missed: usize,
    spurious: usize,
    units: Vec<f64>,
}

impl Counted {
    fn of(scored: &Scored, row: &ReportRow) -> Option<Self> {
        let Status::Ok(measures, _) = &scored.status else { return None };
        // A row that is not scored finds nothing, but its spurious events count.
        let judged = row.verdict != Verdict::NotScored;
        let count = |count: usize| if judged { count } else { 0 };
        Some(Self {
            found: count(measures.matched),
            checked: count(measures.expected),
            missed: count(measures.mismatch.missed.len()),
            spurious: measures.mismatch.spurious.len(),
            units: if judged { in_tolerances(scored, &measures.event_time_units) } else { vec![] },
        })
    }
}

/// Errors that are in the method's own units in those of the tolerance that was asked for.
fn in_tolerances(scored: &Scored, units: &[f64]) -> Vec<f64> {
    let scale = scored.accuracy.tolerance().map_or(1.0, |tolerance| scored.unit / tolerance);
    units.iter().map(|error| error * scale).collect()
}

/// The median over the cases of the cost at [`COMPARED_AT`].
fn rhs_per_event(rows: &[(&Scored, &ReportRow)], exact: bool) -> Option<f64> {
    let costs = rows.chunk_by(|a, b| a.1.case == b.1.case).filter_map(|case| {
        let events = case.first()?.0.events;
        let point = |(scored, row): &(&Scored, &ReportRow)| {
            let Status::Ok(measures, outcome) = &scored.status else { return None };
            let whole = measures.whole && measures.matched == measures.total && events > 0;
            let error = row.event_time_error.max;
            let cost = outcome.work.rhs_evaluations as f64 / events as f64;
            (whole && error.is_finite()).then_some((error, cost))
        };
        let curve: Vec<_> = case.iter().filter_map(point).collect();
        if exact { curve.first().map(|it| it.1) } else { at_error(curve, COMPARED_AT) }
    });
    Some(Spread::of(costs.collect()).median).filter(|it| it.is_finite())
}

/// The cost at an error, read off a work-precision curve by straight lines in logarithms; `None`
/// where the curve does not reach it from both sides.
fn at_error(mut curve: Vec<(f64, f64)>, error: f64) -> Option<f64> {
    curve.retain(|(error, cost)| *error > 0.0 && *cost > 0.0);
    curve.sort_by(|a, b| b.0.total_cmp(&a.0));
    let pair = curve.windows(2).find(|pair| pair[0].0 >= error && error >= pair[1].0)?;
    let [(e0, c0), (e1, c1)] = [pair[0], pair[1]];
    let share = if e0 == e1 { 0.0 } else { (e0 / error).ln() / (e0 / e1).ln() };
    Some((c0.ln() + share * (c1 / c0).ln()).exp())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ranked(engine: &'static str, found: usize, spurious: usize, cost: f64) -> (Ranked, bool) {
        let ranked = Ranked {
            engine,
            rank: 0,
            events_found: found,
            events_checked: found,
            events_total: 100,
            events_missed: 0,
            events_spurious: spurious,
            fails_on: Vec::new(),
            event_time_error_units: Units { median: 0.1, max: 1.0 },
            rhs_per_event: Some(cost),
        };
        (ranked, engine == "exact")
    }

    #[test]
    fn the_least_covered_engine_does_not_lead_and_ties_go_by_cost() {
        let engines = vec![
            ranked("covers-little", 20, 0, 1.0),
            ranked("dear", 90, 0, 200.0),
            ranked("cheap", 90, 0, 100.0),
            ranked("spurious", 95, 10, 50.0),
            ranked("exact", 100, 0, 1.0),
        ];
        let placed: Vec<_> = place(engines).into_iter().map(|it| (it.rank, it.engine)).collect();
        let expected =
            [(0, "exact"), (1, "cheap"), (2, "dear"), (3, "spurious"), (4, "covers-little")];
        assert_eq!(placed, expected);
    }

    #[test]
    fn costs_are_read_between_two_settings_and_not_beyond() {
        let curve = vec![(1e-4, 10.0), (1e-8, 1000.0)];
        assert!(at_error(curve.clone(), 1e-6).is_some_and(|it| (it - 100.0).abs() < 1e-9));
        assert_eq!(at_error(curve.clone(), 1e-9), None);
        assert_eq!(at_error(curve, 1e-3), None);
    }
}
