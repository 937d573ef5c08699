//! The figures of one run, of the oscillator and of any other system.

use super::local::{Defects, LocalJudgement};
use super::mismatch::Mismatch;
use super::occurrence::Occurrence;
use super::probed::ProbeResults;
use super::statistics::Spread;
use crate::case::{Quantity, Statistic};

/// The measures of a run up to the scored horizon.
#[derive(Clone, Debug)]
pub struct Measures {
    /// The scored horizon, in forcing periods.
    pub horizon_periods: f64,
    /// Whether the scored horizon is the case's whole horizon.
    pub whole: bool,
    /// The truth's events on the case's whole horizon.
    pub total: usize,
    /// Whether the engine gave samples, or none are asked for.
    pub is_sampled: bool,
    /// The truth's samples on the case's whole horizon, the start left out; none where the engine
    /// gives no samples.
    pub samples: usize,
    /// Samples before the scored horizon, the start left out.
    pub sampled: usize,
    /// The truth's events before the scored horizon.
    pub expected: usize,
    /// The number of matched events, of the `expected` ones.
    pub matched: usize,
    /// The engine's events, as matching sees them.
    pub found: Vec<Occurrence>,
    /// The events that the engine and the truth do not share.
    pub mismatch: Mismatch,
    /// Whether the phases follow each other as in the truth.
    pub phase_sequence_ok: bool,
    /// Errors of matched events' times.
    pub event_time: Spread,
    /// max(|dp|, |dy|, |dq|) on the sample.
    pub state: Spread,
    /// |dv| at the horizon; NaN where that is not scored.
    pub drift: f64,
    /// The part of the drift's error that the errors of the events' times explain to first order;
    /// NaN where the drift is not scored.
    pub drift_by_times: f64,
    /// Forcing periods until the state's error passes [`SCORED_ERROR`](super::SCORED_ERROR).
    pub valid_periods: f64,
    /// Error of each matched event's time in units of error x (1 + |value|) x growth x events.
    pub event_time_units: Vec<f64>,
    /// Largest error of a matched event's time or state in these units; NaN where none is matched.
    pub event_constant: f64,
    /// Largest error of the sample's states in these units; NaN where no sample is scored.
    pub state_constant: f64,
    /// The results of the tests beyond the run itself.
    pub probed: ProbeResults,
    /// What the exact continuations of the run's records say of it; exact engines have none.
    pub local: Option<LocalJudgement>,
}

impl Measures {
    /// A figure; NaN if it was not measured.
    #[must_use]
    pub fn figure(&self, quantity: Quantity, statistic: Statistic) -> f64 {
        let local = self.local.as_ref();
        if let Some(figure) = local.and_then(|it| local_figure(it, quantity, statistic)) {
            return figure;
        }
        let of = |spread: &Spread| of_spread(spread, statistic);
        match quantity {
            Quantity::EventsMissed => self.mismatch.missed.len() as f64,
            Quantity::EventsSpurious => self.mismatch.spurious.len() as f64,
            Quantity::EventsWrongMode
            | Quantity::Location
            | Quantity::Inconsistency
            | Quantity::TimeDefect
            | Quantity::StateDefect
            | Quantity::SampleDefect
            | Quantity::SampleDelay => f64::NAN,
            Quantity::PhaseSequence => f64::from(u8::from(!self.phase_sequence_ok)),
            Quantity::EventTimeError => of(&self.event_time),
            Quantity::StateError => of(&self.state),
            Quantity::DriftError => self.drift,
            Quantity::EventConstant => self.event_constant,
            Quantity::StateConstant => self.state_constant,
            Quantity::ValidPeriods => self.valid_periods,
            Quantity::ValidGain => {
                self.probed.horizons.as_ref().map_or(f64::NAN, |it| of(&it.gained))
            }
            Quantity::RestartError => {
                self.probed.restart.as_ref().map_or(f64::NAN, |it| of(&it.units))
            }
            Quantity::RestartsFailed => {
                self.probed.restart.as_ref().map_or(f64::NAN, |it| it.failed as f64)
            }
            Quantity::RunsFailed => 0.0,
            Quantity::AttractorDistance => self.probed.share(),
        }
    }

    /// Whether a bound on a quantity applies: not where the truth has no event to measure it at,
    /// nor where the suite did not ask for the probe that measures it.
    #[must_use]
    pub fn concerns(&self, quantity: Quantity) -> bool {
        match quantity {
            Quantity::EventsWrongMode => self.local.is_some(),
            // The sequence of phases is compared with the reference tables for exact engines only;
            // the records of other engines are judged one by one.
            Quantity::PhaseSequence => self.local.is_none(),
            Quantity::Location
            | Quantity::Inconsistency
            | Quantity::TimeDefect
            | Quantity::StateDefect
            | Quantity::SampleDefect
            | Quantity::SampleDelay => {
                let defects = self.local.as_ref().and_then(|it| defects(it, quantity));
                defects.is_some_and(|it| !it.is_empty())
            }
            Quantity::EventTimeError
            | Quantity::EventConstant
            | Quantity::StateError
            | Quantity::StateConstant
                if self.local.is_some() && self.lacks(quantity) =>
            {
                false
            }
            Quantity::EventTimeError | Quantity::EventConstant => self.total > 0,
            Quantity::StateError
            | Quantity::StateConstant
            | Quantity::DriftError
            | Quantity::ValidPeriods => self.samples > 0,
            Quantity::ValidGain => self.probed.horizons.is_some(),
            Quantity::RestartError => self.probed.restarted(),
            Quantity::RestartsFailed => self.probed.restart.is_some(),
            Quantity::AttractorDistance => self.probed.attractor.is_some(),
            _ => true,
        }
    }

    /// Whether nothing was measured of a quantity because the scored horizon ends before there is
    /// anything to measure.
    #[must_use]
    pub fn lacks(&self, quantity: Quantity) -> bool {
        match quantity {
            Quantity::EventTimeError | Quantity::EventConstant => self.matched == 0,
            Quantity::StateError | Quantity::StateConstant => self.sampled == 0,
            Quantity::DriftError => !self.whole,
            _ => false,
        }
    }

    /// The part of the judgement that is left out because the engine does not give what it needs;
    /// none where nothing is.
    #[must_use]
    pub fn not_given(&self) -> Option<&'static str> {
        let local = self.local.as_ref()?;
        let unlocated = local.judged() > 0 && local.defects.location.is_empty();
        match (!self.is_sampled, unlocated) {
            (true, true) => Some(
                "of events only, without location: there are neither samples nor states before resets",
            ),
            (true, false) => Some("of events only: there are no samples"),
            (false, true) => Some("without location: there are no states before resets"),
            (false, false) => None,
        }
    }

    /// Whether enough was scored for a row to pass: a record, or a sample where the truth has no
    /// event, or of an exact engine a twentieth of the truth's events, and the whole horizon where
    /// it has none.
    #[must_use]
    pub fn is_scored(&self) -> bool {
        if let Some(local) = &self.local {
            let has_samples = !local.defects.sample.is_empty();
            return local.judged() > 0 || self.total == 0 && has_samples;
        }
        if self.total == 0 { self.whole } else { 20 * self.expected >= self.total }
    }
}

/// The defects that the local judgement measures of a quantity; none of a quantity of another kind.
fn defects(local: &LocalJudgement, quantity: Quantity) -> Option<&[f64]> {
    let Defects { location, time, state, sample, delay, inconsistency } = &local.defects;
    Some(match quantity {
        Quantity::Location => location,
        Quantity::Inconsistency => inconsistency,
        Quantity::TimeDefect => time,
        Quantity::StateDefect => state,
        Quantity::SampleDefect => sample,
        Quantity::SampleDelay => delay,
        _ => return None,
    })
}

/// A figure of the local judgement; none of what it does not measure.
fn local_figure(local: &LocalJudgement, quantity: Quantity, statistic: Statistic) -> Option<f64> {
    let count = match quantity {
        Quantity::EventsMissed => local.missed,
        Quantity::EventsSpurious => local.spurious,
        Quantity::EventsWrongMode => local.wrong_mode,
        _ => return Some(of_spread(&Defects::spread(defects(local, quantity)?), statistic)),
    };
    Some(count as f64)
}

const fn of_spread(spread: &Spread, statistic: Statistic) -> f64 {
    match statistic {
        Statistic::Median => spread.median,
        Statistic::Q99 => spread.q99,
        Statistic::Max | Statistic::Value => spread.max,
    }
}
