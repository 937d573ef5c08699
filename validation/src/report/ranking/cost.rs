//! The cost of engines at equal error on the same cases: the performance profile of Dolan and More.

use super::{EngineRows, median};
use crate::report::ReportRow;
use serde::Serialize;

/// The largest error of the state at which costs are compared.
pub(in crate::report) const MAX_COMPARED_ERROR: f64 = 1e-6;
/// The profile goes up to 2 to this power times the least cost.
const DOUBLINGS: f64 = 4.0;

/// An engine's cost beside that of the others, over the cases that all integrators ran; nothing
/// where no work was counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Cost {
    /// The area under the share of cases that an engine solves within a multiple of the least cost,
    /// over the logarithm of the multiple from 1 to 16: from 0 to 1.
    pub area: Option<f64>,
    /// The share of cases that it solves within twice the least cost.
    pub within_twice: Option<f64>,
    /// The cost per event: the median over the cases, nothing where it is infinite.
    pub rhs_per_event: Option<f64>,
}

/// The number of right-hand side evaluations, where a Jacobian counts as its columns and a linear
/// solve counts as one; `None` for a row without a count of right-hand sides.
pub(in crate::report) fn work(row: &ReportRow) -> Option<f64> {
    let jacobians = row.jacobian_evaluations.unwrap_or(0) as f64 * row.traits.states as f64;
    Some(row.rhs_evaluations? as f64 + jacobians + row.linear_solves.unwrap_or(0) as f64)
}

/// The cases on which all integrators of a table were run, with the numbers of their events.
pub(in crate::report) struct Common<'a>(pub Vec<(&'a str, usize)>);

impl<'a> Common<'a> {
    /// The common cases of these engines.
    pub fn new(engines: &[EngineRows<'a>]) -> Self {
        let mut table = engines.iter().filter(|it| it.is_in_the_table());
        let Some(first) = table.next() else { return Self(Vec::new()) };
        let mut cases = ran_on(first);
        for other in table {
            let others = ran_on(other);
            cases.retain(|it| others.contains(it));
        }
        Self(cases)
    }

    /// The cost of each engine.
    pub fn profiles(&self, engines: &[EngineRows<'_>]) -> Vec<Cost> {
        let of = |engine: &EngineRows<'_>| {
            let counted = !engine.is_exact() && engine.rows.iter().any(|it| work(it).is_some());
            counted.then(|| self.least_costs(engine))
        };
        let costs: Vec<Option<Vec<f64>>> = engines.iter().map(of).collect();
        let best = |at: usize| {
            let of_case = costs.iter().flatten().filter_map(|it| it.get(at).copied());
            of_case.fold(f64::INFINITY, f64::min)
        };
        let best: Vec<f64> = (0..self.0.len()).map(best).collect();
        let cost = |own: &Option<Vec<f64>>| {
            own.as_ref().map_or_else(Cost::default, |own| self.profile(own, &best))
        };
        costs.iter().map(cost).collect()
    }

    /// The least cost at an error of at most [`MAX_COMPARED_ERROR`], for each of the cases.
    fn least_costs(&self, engine: &EngineRows<'_>) -> Vec<f64> {
        let least = |(case, _): &(&str, usize)| {
            let own = engine.rows.iter().filter(|row| row.case == *case);
            let exact = own.filter(|row| row.state_error.max <= MAX_COMPARED_ERROR);
            exact.filter_map(|row| work(row)).fold(f64::INFINITY, f64::min)
        };
        self.0.iter().map(least).collect()
    }

    fn profile(&self, own: &[f64], best: &[f64]) -> Cost {
        if own.is_empty() {
            return Cost::default();
        }
        // Where no engine has a result, none is near the best.
        let ratio = |(own, best): (&f64, &f64)| {
            if best.is_finite() { own / best } else { f64::INFINITY }
        };
        let ratios: Vec<f64> = own.iter().zip(best).map(ratio).collect();
        let within = ratios.iter().filter(|it| **it <= 2.0).count();
        let area = |ratio: &f64| (1.0 - ratio.log2() / DOUBLINGS).max(0.0);
        let cases = ratios.len() as f64;
        Cost {
            area: Some(ratios.iter().map(area).sum::<f64>() / cases),
            within_twice: Some(within as f64 / cases),
            rhs_per_event: median(self.per_event(own)),
        }
    }

    /// The costs per event, over the cases that have events.
    fn per_event(&self, costs: &[f64]) -> Vec<f64> {
        let pairs = self.0.iter().zip(costs).filter(|((_, events), _)| *events > 0);
        pairs.map(|((_, events), cost)| cost / *events as f64).collect()
    }

    /// The median cost per event of an engine at one setting, whatever its error.
    pub fn per_event_at(&self, rows: &[&ReportRow], setting: &str) -> Option<f64> {
        let cost = |(case, _): &(&str, usize)| {
            let own = |row: &&&ReportRow| row.case == *case && row.setting_key() == setting;
            rows.iter().find(own).and_then(|row| work(row)).unwrap_or(f64::INFINITY)
        };
        median(self.per_event(&self.0.iter().map(cost).collect::<Vec<_>>()))
    }
}

/// The cases on which an engine was run, with the numbers of their events.
fn ran_on<'a>(engine: &EngineRows<'a>) -> Vec<(&'a str, usize)> {
    let ran = engine.rows.iter().filter(|row| row.was_run());
    let mut cases: Vec<_> = ran.map(|row| (row.case.as_str(), row.events_total)).collect();
    cases.dedup();
    cases
}
