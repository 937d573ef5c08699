//! The figures of a restart test, of the oscillator and of any other system.

use super::histogram::Histogram;
use super::statistics::Spread;
use std::collections::BTreeMap;

/// The error of one run at its end.
#[derive(Clone, Copy, Debug)]
pub struct RestartError {
    /// The largest error of the state in units of error x (1 + |value|) x growth.
    pub units: f64,
    /// The error of what drifts, in the units of `units`; NaN in a system where nothing does.
    pub drift_units: f64,
    /// The largest error of an event's time, in the units of `units`; NaN where the sequence of
    /// modes is not the truth's.
    pub time_units: f64,
    /// The largest error of the state itself, in other systems over the scales of the states.
    pub absolute: f64,
    /// Whether the modes follow each other as in the truth.
    pub same_modes: bool,
}

/// The score of an engine.
#[derive(Clone, Debug)]
pub struct Restart {
    /// Runs made.
    pub runs: usize,
    /// Runs with an impact; in other systems than the oscillator, with an event. The spreads and
    /// the histogram are of these; `failed` and `wrong_sequences` count all runs.
    pub with_impact: usize,
    /// Runs that the truth leaves undecided, which are not made.
    pub undecided: usize,
    /// Runs that gave no result. They are bounded by themselves and are in none of the errors.
    pub failed: usize,
    /// Runs with a result whose modes follow each other otherwise than in the truth.
    pub wrong_sequences: usize,
    /// Errors at the end in units of error x (1 + |value|) x growth.
    pub units: Spread,
    /// The errors of what drifts alone, in units; NaN in a system where nothing does.
    pub drift_units: Spread,
    /// The errors of event times, over the runs with the right modes, in units.
    pub time_units: Spread,
    /// Errors at the end themselves.
    pub absolute: Spread,
    /// `units` of the runs with this many events, and how many these are.
    pub by_events: BTreeMap<usize, (usize, Spread)>,
    /// The distribution of `units`.
    pub histogram: Histogram,
}

/// One run of a restart test, as its figures are made from it.
#[derive(Clone, Copy, Debug)]
pub(super) struct RestartResult {
    /// Whether the true run has an impact, or an event where systems differ from the oscillator.
    pub(super) impact: bool,
    /// The events of the true run.
    pub(super) events: usize,
    /// The engine's error; none without a result.
    pub(super) error: Option<RestartError>,
}

impl Restart {
    /// The figures of some runs, and of how many more the truth left undecided.
    pub(super) fn new(results: &[RestartResult], undecided: usize) -> Self {
        let with_impact = || results.iter().filter(|it| it.impact);
        let errors = || with_impact().filter_map(|it| Some((it.events, it.error.as_ref()?)));
        let figures = |figure: fn(&RestartError) -> f64| -> Vec<f64> {
            errors().map(|(_, error)| figure(error)).collect()
        };
        let known = |figures: Vec<f64>| figures.into_iter().filter(|it| !it.is_nan()).collect();
        let mut by_events: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        for (events, error) in errors() {
            by_events.entry(events).or_default().push(error.units);
        }
        let spread =
            |(events, units): (usize, Vec<f64>)| (events, (units.len(), Spread::new(units)));
        let units = figures(|error| error.units);
        let wrong = results.iter().filter_map(|it| it.error).filter(|error| !error.same_modes);
        Self {
            runs: results.len(),
            with_impact: with_impact().count(),
            undecided,
            failed: results.iter().filter(|it| it.error.is_none()).count(),
            wrong_sequences: wrong.count(),
            histogram: Histogram::new(&units),
            units: Spread::new(units),
            drift_units: Spread::new(figures(|error| error.drift_units)),
            time_units: Spread::new(known(figures(|error| error.time_units))),
            absolute: Spread::new(figures(|error| error.absolute)),
            by_events: by_events.into_iter().map(spread).collect(),
        }
    }
}
