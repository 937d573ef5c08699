//! The power of the gates: which bounds notice which engine that is wrong on purpose.
//!
//! A bound that no fault trips guards nothing. Every wrong engine is run on every case that is at
//! hand, held against the bounds of the engine that it is without its fault, and must fail at least
//! one. A fault that shows in one way of running a case must be caught by the cases that are run in
//! that way, and by no other ([`examine`]).

mod trials;
mod variants;
mod ways;

pub use trials::{Tally, Trial, count_loosened, set_limits, tallies, trial, trials};
pub use variants::Variant;
pub use ways::is_run;

use crate::case::{Case, ClassBounds, Defaults, Quantity};
use crate::engine::{Accuracy, Limits, REFERENCE};
use crate::integrators::{self, CORRECT_ENGINE, Way, WrongEngine, faulty, wrong};
use crate::number::brief;
use crate::score::{Checked, Subject, Verdict};
use crate::suite::{Extent, PreparedCase, class_of};
use rayon::prelude::*;
use std::collections::BTreeMap;
use ways::{MAX_CALLS, is_affordable};

/// A group of bounds that test the same property.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Gate {
    /// Events missed, spurious, or of another phase.
    Events,
    /// Errors at the events.
    EventErrors,
    /// Errors on the fixed sample, drift included.
    StateErrors,
    /// The valid horizons of runs in chaos.
    ValidHorizon,
    /// Errors after restarts from states on the attractor.
    Restart,
    /// Distance of the sections in chaos.
    Attractor,
}

impl Gate {
    /// All gates, in the order of the report.
    pub const ALL: [Self; 6] = [
        Self::Events,
        Self::EventErrors,
        Self::StateErrors,
        Self::ValidHorizon,
        Self::Restart,
        Self::Attractor,
    ];

    /// The gate's name for people.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Events => "events",
            Self::EventErrors => "event errors",
            Self::StateErrors => "state errors",
            Self::ValidHorizon => "valid horizon",
            Self::Restart => "restart",
            Self::Attractor => "same attractor",
        }
    }

    const fn new(quantity: Quantity) -> Self {
        match quantity {
            Quantity::EventsMissed
            | Quantity::EventsSpurious
            | Quantity::EventsWrongMode
            | Quantity::Inconsistency
            | Quantity::PhaseSequence
            | Quantity::RunsFailed => Self::Events,
            Quantity::EventTimeError
            | Quantity::EventConstant
            | Quantity::Location
            | Quantity::TimeDefect
            | Quantity::StateDefect => Self::EventErrors,
            Quantity::SampleDefect
            | Quantity::SampleDelay
            | Quantity::StateError
            | Quantity::DriftError
            | Quantity::StateConstant
            | Quantity::ValidPeriods => Self::StateErrors,
            Quantity::ValidGain => Self::ValidHorizon,
            Quantity::RestartError | Quantity::RestartsFailed => Self::Restart,
            Quantity::AttractorDistance => Self::Attractor,
        }
    }
}

/// On how many cases a gate was applied to a fault, and caught it.
#[derive(Clone, Debug, Default)]
pub struct Trip {
    /// The number of cases on which the gate was applied to the engine.
    pub held: usize,
    /// The number of cases on which a bound of the gate failed.
    pub failed: usize,
    /// The failure on the first of those cases.
    pub detail: String,
}

/// The result of the power test for one wrong engine.
#[derive(Clone, Debug)]
pub struct Finding {
    /// The engine's name, with its tolerance where it has one.
    pub engine: String,
    /// The fault, in words.
    pub fault: &'static str,
    /// The result of each gate.
    pub gates: BTreeMap<Gate, Trip>,
    /// The number of cases on which the engine gave no result.
    pub without_result: usize,
    /// The names of the cases on which a bound failed.
    pub failed_on: Vec<String>,
    /// The way of running a case in which its fault shows, if it is one; the cases above are then
    /// those that are run in that way.
    pub way: Option<Way>,
    /// The number of cases that are not run in that way, and those of them on which a bound failed.
    pub elsewhere: (usize, Vec<String>),
}

impl Finding {
    /// Whether any gate noticed.
    #[must_use]
    pub fn is_caught(&self) -> bool {
        // Stiff cases give no result to a right integrator either.
        let none = self.way.is_none() && self.without_result > 0;
        none || self.gates.values().any(|trip| trip.failed > 0)
    }

    /// Gathers what the gates said, case by case.
    fn new(
        wrong: &WrongEngine,
        standard: Standard,
        outcomes: impl IntoIterator<Item = (String, Option<Vec<Checked>>)>,
    ) -> Self {
        let mut finding = Self {
            engine: standard.who(wrong.engine.declaration().name),
            fault: wrong.fault,
            gates: Gate::ALL.into_iter().map(|gate| (gate, Trip::default())).collect(),
            without_result: 0,
            failed_on: Vec::new(),
            way: None,
            elsewhere: (0, Vec::new()),
        };
        for (case, checked) in outcomes {
            match checked {
                Some(checked) => finding.add(&case, &checked),
                None => finding.without_result += 1,
            }
        }
        finding
    }

    fn add(&mut self, case: &str, checked: &[Checked]) {
        if checked.iter().any(|it| it.verdict == Verdict::Fail) {
            self.failed_on.push(case.to_owned());
        }
        for (gate, trip) in &mut self.gates {
            let mut own = checked.iter().filter(|it| Gate::new(it.quantity) == *gate).peekable();
            trip.held += usize::from(own.peek().is_some());
            let Some(failed) = own.find(|it| it.verdict == Verdict::Fail) else { continue };
            trip.failed += 1;
            if trip.detail.is_empty() {
                let (value, limit) = (brief(failed.value), brief(failed.limit));
                trip.detail = format!("{case}: {value}, limit {limit}");
            }
        }
    }
}

/// The standard for wrong engines: the name whose bounds are taken, and the unit of error.
#[derive(Clone, Copy, Debug)]
pub struct Standard {
    /// The engine whose bounds are taken.
    pub engine: &'static str,
    /// The accuracy that the engine is asked for.
    pub accuracy: Accuracy,
    /// The unit of error of the engine.
    pub unit: f64,
}

/// The standard to which the exact solver is held.
pub const EXACT_STANDARD: Standard =
    Standard { engine: REFERENCE, accuracy: Accuracy::Exact, unit: f64::EPSILON };

/// The tolerances at which integrators with a fault are run.
const FAULTY_TOLERANCES: [f64; 2] = [1e-6, 1e-9];

impl Standard {
    /// The standards to which the integrator is held of which faulty ones are made, at each of
    /// their tolerances.
    #[must_use]
    pub fn of_faulty() -> [Self; 2] {
        FAULTY_TOLERANCES.map(|tolerance| Self {
            engine: CORRECT_ENGINE,
            accuracy: Accuracy::Tolerance(tolerance),
            unit: tolerance,
        })
    }

    /// The class whose bounds apply; none to the exact solver.
    fn class<'a>(&self, classes: &'a [ClassBounds]) -> Option<&'a ClassBounds> {
        let mut all = integrators::all().iter().map(|it| it.declaration());
        class_of(classes, &all.find(|it| it.name == self.engine)?, self.accuracy)
    }

    /// A wrong engine's name, with the tolerance where there is one.
    fn who(&self, name: &str) -> String {
        match self.accuracy.tolerance() {
            Some(tolerance) => format!("{name} {tolerance:e}"),
            None => name.to_owned(),
        }
    }

    /// The extent of the tests of a wrong engine.
    fn extent(&self, case: &Case) -> Extent {
        if self.accuracy == Accuracy::Exact {
            Extent::of_wrong(case)
        } else {
            Extent::of_faulty(case)
        }
    }
}

/// Every engine that is wrong on purpose, with what it is held to: those whose faults show in ways
/// of running a case come last.
#[must_use]
pub fn all() -> Vec<(WrongEngine, Standard)> {
    let integrators = Standard::of_faulty().into_iter();
    let integrators = integrators.flat_map(|held| faulty().iter().map(move |it| (*it, held)));
    let mut all: Vec<_> =
        wrong().iter().map(|it| (*it, EXACT_STANDARD)).chain(integrators).collect();
    all.sort_by_key(|(it, _)| it.way.is_some());
    all
}

/// Runs a wrong engine on all cases that show its fault. One that is wrong in a way of running a
/// case is run on all cases of systems but for the stiffest: on those that are run in that way it
/// has to fail a bound, and on the others none.
#[must_use]
pub fn examine(
    wrong: &WrongEngine,
    cases: &[PreparedCase],
    standard: Standard,
    defaults: &Defaults,
) -> Finding {
    let run = |cases: Vec<&PreparedCase>| {
        let one = |case: &&PreparedCase| {
            (case.case.name.clone(), bounds_held_against(wrong, case, standard, defaults))
        };
        Finding::new(wrong, standard, cases.par_iter().map(one).collect::<Vec<_>>())
    };
    let (own, others): (Vec<_>, Vec<_>) =
        cases.iter().partition(|case| case.case.oscillator.is_some());
    let Some(way) = wrong.way else { return run(own) };
    let others = others.into_iter().filter(|case| is_affordable(case));
    let (with, without): (Vec<_>, Vec<_>) = others.partition(|case| is_run(case, way));
    let count = without.len();
    let elsewhere = (count, run(without).failed_on);
    Finding { way: Some(way), elsewhere, ..run(with) }
}

/// The bounds that a run of a wrong engine was held against; none without a result.
fn bounds_held_against(
    wrong: &WrongEngine,
    case: &PreparedCase,
    standard: Standard,
    defaults: &Defaults,
) -> Option<Vec<Checked>> {
    let Standard { engine, accuracy, unit } = standard;
    let mut limits = Limits::default();
    if wrong.way.is_some() {
        limits.calls = MAX_CALLS;
    }
    let extent = |_| standard.extent(&case.case);
    let mut measured = case.measured(wrong.engine, (accuracy, unit), &limits, extent).ok()?;
    let class = standard.class(&defaults.classes);
    let subject = Subject { case: &case.case.name, engine, accuracy, unit };
    Some(case.judge(&subject, &mut measured, class, defaults, &[]).bounds)
}
