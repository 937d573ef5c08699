//! The keys of `bench.json`.

use super::contest::{SettingResult, exact, most_accurate};
use super::damping::DampingPoint;
use super::equal_accuracy::{
    AccuracyPoint, Basis, LOOSE_ERROR, MAX_COMPARABLE_RATIO, TIGHT_ERROR, time_at,
};
use super::floor::Floors;
use super::length::Length;
pub use super::timed_case::CaseEntry;
use crate::engine::{REFERENCE, Stepping};
use crate::number::shortest;
use crate::provenance::Build;
use serde::{Deserialize, Serialize};

/// A whole bench.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Bench {
    /// The number of the format, and the build and machine.
    #[serde(flatten)]
    pub build: Build,
    /// Interleaved rounds.
    pub rounds: usize,
    /// The cases.
    pub cases: Vec<CaseEntry>,
    /// A row for each case, contestant and setting.
    pub results: Vec<BenchRow>,
    /// The least cost of one closed-form evaluation.
    pub floor: Floor,
    /// The exact solver's time per event on each case.
    pub events: Vec<EventCost>,
    /// Cost against length; empty where only some cases were asked for.
    pub length: Vec<Length>,
    /// Cost against xi; empty where only some cases were asked for.
    pub damping: Vec<Damped>,
}

/// One contestant at one setting on one case. A figure that there is not is null.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[allow(missing_docs, reason = "the keys are those of the command line's contract")]
pub struct BenchRow {
    pub case: String,
    pub engine: String,
    pub tolerance: Option<f64>,
    pub step: Option<f64>,
    pub ns_per_period: Option<f64>,
    pub state_error_max: Option<f64>,
    pub event_time_error_max: Option<f64>,
    pub ratio_to_exact: Option<f64>,
    /// Ratio of times at errors of at most [`MAX_COMPARABLE_RATIO`] times the exact solver's on
    /// this case.
    pub ratio_at_comparable_error: Option<f64>,
    /// Ratio of times at errors of at most 1e-6, read off this engine's work-precision curve on
    /// this case.
    #[serde(rename = "ratio_at_1e-6")]
    pub ratio_at_1e_6: Option<f64>,
    /// Ratio of times at errors of at most 1e-9.
    #[serde(rename = "ratio_at_1e-9")]
    pub ratio_at_1e_9: Option<f64>,
    /// The same ratios of times that are net of the harness's own share ([`net`]).
    pub net_ratio_to_exact: Option<f64>,
    pub net_ratio_at_comparable_error: Option<f64>,
    #[serde(rename = "net_ratio_at_1e-6")]
    pub net_ratio_at_1e_6: Option<f64>,
    #[serde(rename = "net_ratio_at_1e-9")]
    pub net_ratio_at_1e_9: Option<f64>,
    /// Share of the time that is the harness's own ([`super::library_part`]).
    pub harness_share: Option<f64>,
    /// Half the distance between the least and the largest share of a round.
    pub harness_share_spread: Option<f64>,
    pub rhs_per_period: Option<f64>,
    /// Whether this is the setting at which this engine errs least here.
    pub most_accurate: bool,
    /// Whether it errs at most [`MAX_COMPARABLE_RATIO`] times as much as the exact solver here.
    pub comparable: bool,
    /// Whether a tolerance chooses the engine's steps.
    pub adaptive: bool,
    /// The reason why there is no time.
    pub why: Option<String>,
}

impl BenchRow {
    /// The tolerance or the step, as tables show it.
    #[must_use]
    pub fn setting(&self) -> String {
        match (self.tolerance, self.step) {
            (Some(tolerance), _) => shortest(tolerance),
            (_, Some(step)) => format!("h {step}"),
            _ => "-".to_owned(),
        }
    }

    /// The engine's time without the harness's own share over the exact solver's, on the given
    /// basis.
    #[must_use]
    pub fn net_ratio(&self, basis: Basis) -> Option<f64> {
        match basis {
            Basis::MostAccurate => self.net_ratio_to_exact,
            Basis::Comparable => self.net_ratio_at_comparable_error,
            Basis::Tight => self.net_ratio_at_1e_9,
            Basis::Loose => self.net_ratio_at_1e_6,
        }
    }

    /// The time of a forcing period without the harness's own share, ns.
    #[must_use]
    pub fn net_ns_per_period(&self) -> Option<f64> {
        self.ns_per_period.map(|time| net(time, self.harness_share))
    }

    /// The engine's whole time over the exact solver's, on the given basis.
    #[must_use]
    pub fn ratio(&self, basis: Basis) -> Option<f64> {
        match basis {
            Basis::MostAccurate => self.ratio_to_exact,
            Basis::Comparable => self.ratio_at_comparable_error,
            Basis::Tight => self.ratio_at_1e_9,
            Basis::Loose => self.ratio_at_1e_6,
        }
    }

    /// Whether this setting is as accurate as the basis asks.
    #[must_use]
    pub fn meets(&self, basis: Basis) -> bool {
        let errs_at_most = |most| self.state_error_max.is_some_and(|error| error <= most);
        match basis {
            Basis::MostAccurate => self.most_accurate,
            Basis::Comparable => self.comparable,
            Basis::Tight => errs_at_most(TIGHT_ERROR),
            Basis::Loose => errs_at_most(LOOSE_ERROR),
        }
    }
}

/// A time without the harness's own share. One whose share is not known, or comes out below zero
/// because it is next to nothing, is a whole time.
#[must_use]
pub fn net(time: f64, harness_share: Option<f64>) -> f64 {
    time * (1.0 - harness_share.unwrap_or(0.0).max(0.0))
}

/// The floor, ns an evaluation.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[allow(missing_docs, reason = "the keys are explained in the schema")]
pub struct Floor {
    pub chained_ns: f64,
    pub independent_ns: f64,
}

/// The exact solver's time for an event of a case's run: everything that is timed divided by
/// its events.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[allow(missing_docs, reason = "the keys are explained in the schema")]
pub struct EventCost {
    pub case: String,
    pub evaluations_per_event: Option<f64>,
    pub ns_per_event: Option<f64>,
    /// The time per event in units of the floor of dependent evaluations, and below in units of the
    /// floor of independent ones.
    pub floors_per_event: Option<f64>,
    pub independent_floors_per_event: Option<f64>,
    pub why: Option<String>,
}

impl EventCost {
    /// The cost by the exact solver's row on a case.
    #[must_use]
    pub fn new(case: &CaseEntry, exact: Option<&BenchRow>, floor: Floor) -> Self {
        let per_event = |it: Option<f64>| it.and_then(|it| case.per_event(it));
        let ns = per_event(exact.and_then(|row| row.ns_per_period));
        let without = (case.events == 0).then(|| "the run has no event".to_owned());
        Self {
            case: case.case.clone(),
            evaluations_per_event: per_event(exact.and_then(|row| row.rhs_per_period)),
            ns_per_event: ns,
            floors_per_event: ns.map(|it| it / floor.chained_ns),
            independent_floors_per_event: ns.map(|it| it / floor.independent_ns),
            why: exact.and_then(|row| row.why.clone()).or(without),
        }
    }
}

/// A contestant at one damping ratio xi.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[allow(missing_docs, reason = "the keys are explained in the schema")]
pub struct Damped {
    pub xi: f64,
    pub engine: String,
    pub tolerance: Option<f64>,
    pub ns_per_period: Option<f64>,
    pub harness_share: Option<f64>,
    pub state_error_max: Option<f64>,
    pub why: Option<String>,
}

/// The measurements from which a bench is made.
pub struct Measurement<'a> {
    /// The cases and who ran on each.
    pub contests: &'a [(CaseEntry, Vec<SettingResult>)],
    /// The floor.
    pub floors: &'a Floors,
    /// The lengths.
    pub length: Vec<Length>,
    /// The results at each damping ratio.
    pub damping: &'a [DampingPoint],
}

impl Bench {
    /// The bench of what was measured.
    #[must_use]
    pub fn new(build: Build, rounds: usize, measured: Measurement<'_>) -> Self {
        let Measurement { contests, floors, length, damping } = measured;
        let cases: Vec<_> = contests.iter().map(|(case, _)| case.clone()).collect();
        let results: Vec<_> = contests.iter().flat_map(|(case, all)| rows(case, all)).collect();
        let floor =
            Floor { chained_ns: floors.chained.best(), independent_ns: floors.independent.best() };
        let exact =
            |case: &str| results.iter().find(|it| it.case == case && it.engine == REFERENCE);
        let cost = |it: &CaseEntry| EventCost::new(it, exact(&it.case), floor);
        Self {
            build,
            rounds,
            events: cases.iter().map(cost).collect(),
            cases,
            results,
            floor,
            length,
            damping: damping.iter().flat_map(damped).collect(),
        }
    }
}

fn rows(case: &CaseEntry, results: &[SettingResult]) -> Vec<BenchRow> {
    let unit = exact(results).map(|it| it.series.clone()).unwrap_or_default();
    let comparable = exact(results).map_or(0.0, |it| MAX_COMPARABLE_RATIO * it.score.state_error);
    let row = |it: &SettingResult| {
        let timed = it.result.as_ref().ok();
        let best = most_accurate(results, it.name).is_some_and(|best| std::ptr::eq(best, it));
        let ratio = timed.map(|it| it.series.ratio_to(&unit)).filter(|it| it.is_finite());
        let harness = timed.and_then(|it| it.harness_share);
        let share = harness.map(|it| it.share);
        // The exact solver is the unit as a whole: what it saves without its table is no lead.
        let is_unit = it.name == REFERENCE;
        BenchRow {
            case: case.case.clone(),
            engine: it.name.to_owned(),
            tolerance: it.setting.tolerance(),
            step: it.setting.step(),
            ns_per_period: timed.map(|it| it.series.median()),
            state_error_max: timed.map(|it| it.score.state_error),
            event_time_error_max: timed.map(|it| it.score.event_time_error),
            ratio_to_exact: ratio,
            ratio_at_comparable_error: None,
            ratio_at_1e_6: None,
            ratio_at_1e_9: None,
            net_ratio_to_exact: ratio.map(|it| net(it, share.filter(|_| !is_unit))),
            net_ratio_at_comparable_error: None,
            net_ratio_at_1e_6: None,
            net_ratio_at_1e_9: None,
            harness_share: share,
            harness_share_spread: harness.map(|it| it.spread),
            rhs_per_period: timed
                .map(|it| it.work.rhs_evaluations)
                .filter(|it| *it > 0)
                .map(|it| it as f64 / case.periods),
            most_accurate: best,
            comparable: timed.is_some_and(|it| it.score.state_error <= comparable),
            adaptive: !matches!(it.stepping, Stepping::Exact | Stepping::Fixed { .. }),
            why: it.result.as_ref().err().map(ToString::to_string),
        }
    };
    at_equal_accuracy(results.iter().map(row).collect(), comparable)
}

/// Reads each engine's work-precision curve at [`LOOSE_ERROR`], at [`TIGHT_ERROR`] and at errors
/// comparable to the exact solver's. Its times are ratios to the exact solver's, so that what the
/// machine did otherwise in a round is out of them already.
fn at_equal_accuracy(mut rows: Vec<BenchRow>, comparable: f64) -> Vec<BenchRow> {
    for own in rows.chunk_by_mut(|a, b| a.engine == b.engine) {
        let curve = |time: fn(&BenchRow) -> Option<f64>| {
            let corner = |row: &BenchRow| {
                Some(AccuracyPoint { error: row.state_error_max?, time: time(row)? })
            };
            own.iter().map(corner).collect::<Vec<_>>()
        };
        let gross = curve(|row| row.ratio_to_exact);
        let net = curve(|row| row.net_ratio_to_exact);
        for row in own {
            row.ratio_at_comparable_error = time_at(&gross, comparable);
            row.ratio_at_1e_6 = time_at(&gross, LOOSE_ERROR);
            row.ratio_at_1e_9 = time_at(&gross, TIGHT_ERROR);
            row.net_ratio_at_comparable_error = time_at(&net, comparable);
            row.net_ratio_at_1e_6 = time_at(&net, LOOSE_ERROR);
            row.net_ratio_at_1e_9 = time_at(&net, TIGHT_ERROR);
        }
    }
    rows
}

fn damped(point: &DampingPoint) -> Vec<Damped> {
    let row = |it: &SettingResult| {
        let timed = it.result.as_ref().ok();
        Damped {
            xi: point.xi,
            engine: it.name.to_owned(),
            tolerance: it.setting.tolerance(),
            ns_per_period: timed.map(|it| it.series.median()),
            harness_share: timed.and_then(|it| it.harness_share).map(|it| it.share),
            state_error_max: timed.map(|it| it.score.state_error),
            why: it.result.as_ref().err().map(ToString::to_string),
        }
    };
    point.results.iter().map(row).collect()
}
