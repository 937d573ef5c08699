//! What a `bench` holds: the keys of `bench.json`.

use super::contest::{Finisher, exact, most_accurate};
use super::course::Course;
use super::damping::Rung;
use super::floor::Floors;
use super::length::Length;
use super::rounds::Series;
use crate::build::Build;
use crate::engine::Stepping;
use crate::number::shortest;
use serde::Serialize;

/// A whole bench.
#[derive(Clone, Debug, Serialize)]
pub struct Bench {
    /// The format's number, and what was run where.
    #[serde(flatten)]
    pub build: Build,
    /// Interleaved rounds.
    pub rounds: usize,
    /// The courses.
    pub cases: Vec<CaseEntry>,
    /// A row for each case, contestant and setting.
    pub results: Vec<Row>,
    /// What one evaluation costs at the least.
    pub floor: Floor,
    /// What the exact solver takes a switch.
    pub switches: Vec<Switch>,
    /// Cost against length; empty where only some cases were asked for.
    pub length: Vec<Length>,
    /// Cost against xi; empty alike.
    pub damping: Vec<Damped>,
}

/// A course.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs, reason = "the keys are explained in the schema")]
pub struct CaseEntry {
    pub case: String,
    pub regime: String,
    pub periods: f64,
    pub switches: usize,
}

/// One contestant at one setting on one case. What there is not is null.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs, reason = "the keys are those of the command line's contract")]
pub struct Row {
    pub case: String,
    pub engine: &'static str,
    pub tolerance: Option<f64>,
    pub step: Option<f64>,
    pub ns_per_period: Option<f64>,
    pub state_error_max: Option<f64>,
    pub event_time_error_max: Option<f64>,
    pub ratio_to_exact: Option<f64>,
    pub rhs_per_period: Option<f64>,
    /// Whether this is the setting at which this engine errs least here.
    pub most_accurate: bool,
    /// Whether its steps are chosen by a tolerance.
    pub adaptive: bool,
    /// Why there is no time.
    pub why: Option<String>,
}

impl Row {
    /// The tolerance or the step, as tables show it.
    #[must_use]
    pub fn setting(&self) -> String {
        match (self.tolerance, self.step) {
            (Some(tolerance), _) => shortest(tolerance),
            (_, Some(step)) => format!("h {step}"),
            _ => "-".to_owned(),
        }
    }
}

/// The floor, ns an evaluation.
#[derive(Clone, Copy, Debug, Serialize)]
#[allow(missing_docs, reason = "the keys are explained in the schema")]
pub struct Floor {
    pub chained_ns: f64,
    pub independent_ns: f64,
}

/// What a switch costs.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs, reason = "the keys are explained in the schema")]
pub struct Switch {
    pub case: String,
    pub evaluations_per_switch: Option<f64>,
    pub ns_per_switch: Option<f64>,
    /// In units of the chained floor, then of the independent one.
    pub floors_per_switch: Option<f64>,
    pub independent_floors_per_switch: Option<f64>,
    pub why: Option<String>,
}

/// A contestant at one xi.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs, reason = "the keys are explained in the schema")]
pub struct Damped {
    pub xi: f64,
    pub engine: &'static str,
    pub tolerance: Option<f64>,
    pub ns_per_period: Option<f64>,
    pub state_error_max: Option<f64>,
    pub why: Option<String>,
}

/// What was measured.
pub struct Measured<'a> {
    /// The courses and who ran on each.
    pub contests: &'a [(&'a Course, Vec<Finisher>)],
    /// The floor and the switches, one a course.
    pub floors: &'a Floors,
    /// The lengths.
    pub length: Vec<Length>,
    /// The ladder of xi.
    pub damping: &'a [Rung],
}

impl Bench {
    /// The bench of what was measured.
    #[must_use]
    pub fn new(rounds: usize, measured: Measured<'_>) -> Self {
        let Measured { contests, floors, length, damping } = measured;
        let courses = contests.iter().map(|(course, _)| *course);
        Self {
            build: Build::this(),
            rounds,
            cases: courses.clone().map(entry).collect(),
            results: contests.iter().flat_map(|(course, all)| rows(course, all)).collect(),
            floor: Floor {
                chained_ns: floors.chained.best(),
                independent_ns: floors.independent.best(),
            },
            switches: courses.enumerate().map(|(i, it)| switch(it, floors, i)).collect(),
            length,
            damping: damping.iter().flat_map(damped).collect(),
        }
    }
}

fn entry(course: &Course) -> CaseEntry {
    CaseEntry {
        case: course.name.clone(),
        regime: course.regime.clone(),
        periods: course.periods(),
        switches: course.truth.switches.len(),
    }
}

fn rows(course: &Course, finishers: &[Finisher]) -> Vec<Row> {
    let unit = exact(finishers).map(|it| it.series.clone()).unwrap_or_default();
    let row = |it: &Finisher| {
        let timed = it.result.as_ref().ok();
        let best = most_accurate(finishers, it.name).is_some_and(|best| std::ptr::eq(best, it));
        Row {
            case: course.name.clone(),
            engine: it.name,
            tolerance: it.setting.tolerance(),
            step: it.setting.step(),
            ns_per_period: timed.map(|it| it.series.typical()),
            state_error_max: timed.map(|it| it.score.state_error),
            event_time_error_max: timed.map(|it| it.score.event_time_error),
            ratio_to_exact: timed.map(|it| it.series.ratio_to(&unit)).filter(|it| it.is_finite()),
            rhs_per_period: timed
                .map(|it| it.work.rhs_evaluations)
                .filter(|it| *it > 0)
                .map(|it| it as f64 / course.periods()),
            most_accurate: best,
            adaptive: !matches!(it.stepping, Stepping::Exact | Stepping::Fixed { .. }),
            why: it.result.as_ref().err().map(ToString::to_string),
        }
    };
    finishers.iter().map(row).collect()
}

fn switch(course: &Course, floors: &Floors, i: usize) -> Switch {
    let cost = floors.switches.get(i).and_then(|it| it.as_ref().ok());
    let failed = floors.switches.get(i).and_then(|it| it.as_ref().err());
    // Least times: a neighbour on the same core slows a switch down, and the chained floor hardly.
    let in_units_of = |floor: &Series| cost.map(|it| it.series.best() / floor.best());
    Switch {
        case: course.name.clone(),
        evaluations_per_switch: cost.map(|it| it.evaluations),
        ns_per_switch: cost.map(|it| it.series.best()),
        floors_per_switch: in_units_of(&floors.chained),
        independent_floors_per_switch: in_units_of(&floors.independent),
        why: failed.map(ToString::to_string),
    }
}

fn damped(rung: &Rung) -> Vec<Damped> {
    let row = |it: &Finisher| {
        let timed = it.result.as_ref().ok();
        Damped {
            xi: rung.xi,
            engine: it.name,
            tolerance: it.setting.tolerance(),
            ns_per_period: timed.map(|it| it.series.typical()),
            state_error_max: timed.map(|it| it.score.state_error),
            why: it.result.as_ref().err().map(ToString::to_string),
        }
    };
    rung.finishers.iter().map(row).collect()
}
