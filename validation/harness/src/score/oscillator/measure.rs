//! The figures of one run.

use super::growth::RunGrowth;
use crate::engine::{Event, OscillatorTask, Outcome};
use crate::score::SCORED_ERROR;
use crate::score::matching::{Matching, WINDOW};
use crate::score::measures::Measures;
use crate::score::mismatch::{Excused, Mismatch};
use crate::score::occurrence::occurrences;
use crate::score::probed::ProbeResults;
use crate::score::statistics::{Spread, worst};
use crate::truth::{Truth, TruthRow};
use percuss::Phase;
use percuss::TwoWord;

/// Measures a run; `unit` is the engine's unit of error: its tolerance, or eps.
#[must_use]
pub fn measure(
    task: &OscillatorTask,
    truth: &Truth,
    growth: &RunGrowth,
    outcome: &Outcome,
    unit: f64,
) -> Measures {
    let period = task.problem.model.period();
    let scored = growth.scored_samples(unit);
    let whole = scored == truth.samples.len();
    let horizon =
        if whole { truth.span() } else { truth.samples[scored.saturating_sub(1)].elapsed.value() };
    let window = WINDOW * period;
    // An event just past the horizon may be the partner of one just before it.
    let rows = prefix(&truth.events, |row| row.elapsed.value() <= horizon + window);
    let found = prefix(&outcome.events, |event| event.elapsed <= horizon + window);
    let (truths, own) = (occurrences(rows), occurrences(&outcome.events));
    let matching = Matching::of(&truths, &own[..found.len()], window);
    let expected = prefix(rows, |row| row.elapsed.value() <= horizon).len();
    let counted = prefix(found, |event| event.elapsed <= horizon).len();
    let pairs: Vec<_> = matching.pairs.iter().copied().filter(|(i, _)| *i < expected).collect();
    let mismatch = Mismatch::of(&matching, (rows.len(), expected), (found.len(), counted));
    let state_errors = sample_errors(truth, outcome);
    Measures {
        horizon_periods: horizon / period,
        whole,
        total: truth.events.len(),
        samples: truth.samples.len().saturating_sub(1),
        sampled: scored.saturating_sub(1),
        expected,
        matched: pairs.len(),
        phase_sequence_ok: mismatch.same_phases(&truths, &own, &Excused::default()),
        event_time: Spread::of(
            pairs.iter().map(|(i, j)| time_error(&rows[*i], &found[*j])).collect(),
        ),
        // The start is given: its error is none.
        state: Spread::of(state_errors.get(1..scored).unwrap_or_default().to_vec()),
        drift: if whole { off(truth.end.state[3], outcome.end[3]) } else { f64::NAN },
        drift_by_times: if whole { drift_by_times(task, rows, found, &pairs) } else { f64::NAN },
        valid_periods: valid_periods(task, truth, &state_errors, period),
        event_time_units: pairs
            .iter()
            .map(|(i, j)| time_units(&rows[*i], &found[*j], growth.events[*i][0], unit, *i))
            .collect(),
        event_constant: event_constant(rows, found, &pairs, growth, unit),
        state_constant: state_constant(truth, outcome, growth, scored, unit),
        found: own,
        mismatch,
        probed: ProbeResults::default(),
    }
}

fn prefix<T>(items: &[T], keep: impl Fn(&T) -> bool) -> &[T] {
    let count = items.iter().position(|item| !keep(item)).unwrap_or(items.len());
    &items[..count]
}

fn off(truth: TwoWord, value: f64) -> f64 {
    truth.minus(TwoWord::new(value)).value().abs()
}

fn time_error(row: &TruthRow, event: &Event) -> f64 {
    off(row.elapsed, event.elapsed)
}

/// max(|dp|, |dy|, |dq|) at each sample of the truth; NaN at one that the engine did not deliver.
#[must_use]
pub fn sample_errors(truth: &Truth, outcome: &Outcome) -> Vec<f64> {
    let error = |(k, row): (usize, &TruthRow)| {
        let Some(state) = outcome.samples.get(k) else { return f64::NAN };
        worst((0..3).map(|i| off(row.state[i], state[i])))
    };
    truth.samples.iter().enumerate().map(error).collect()
}

/// A progression that begins too late by dt lacks v' dt. v' vanishes where contact turns into
/// progression and back, so that only impacts straight into progression hand their errors on.
fn drift_by_times(
    task: &OscillatorTask,
    rows: &[TruthRow],
    found: &[Event],
    pairs: &[(usize, usize)],
) -> f64 {
    let lost = |(i, j): &(usize, usize)| {
        let [_, y, q, _] = rows[*i].rounded();
        let rate = y - (1.0 - q) / (2.0 * task.parameters.xi);
        rate * TwoWord::new(found[*j].elapsed).minus(rows[*i].elapsed).value()
    };
    let slips = pairs.iter().filter(|(i, _)| rows[*i].phase == Some(Phase::Progression));
    slips.map(lost).sum::<f64>().abs()
}

fn valid_periods(task: &OscillatorTask, truth: &Truth, errors: &[f64], period: f64) -> f64 {
    let lost = errors.iter().position(|error| error.is_nan() || *error > SCORED_ERROR);
    let span = lost.map_or(task.span, |k| truth.samples[k.saturating_sub(1)].elapsed.value());
    span / period
}

/// The error of an event's time in units of error x (1 + |value|) x growth x events so far.
fn time_units(row: &TruthRow, event: &Event, growth: f64, unit: f64, n: usize) -> f64 {
    let scale = (1.0 + row.elapsed.value().abs()) * growth * unit * (n + 1) as f64;
    time_error(row, event) / scale
}

fn event_constant(
    rows: &[TruthRow],
    found: &[Event],
    pairs: &[(usize, usize)],
    growth: &RunGrowth,
    unit: f64,
) -> f64 {
    if pairs.is_empty() {
        return f64::NAN;
    }
    worst(pairs.iter().map(|(i, j)| {
        let (row, event) = (&rows[*i], &found[*j]);
        let time =
            time_error(row, event) / (1.0 + row.elapsed.value().abs()) / growth.events[*i][0];
        let state =
            (0..4).map(|k| relative(row.state[k], event.state[k]) / growth.events[*i][k + 1]);
        worst(state.chain([time])) / (unit * (i + 1) as f64)
    }))
}

fn state_constant(
    truth: &Truth,
    outcome: &Outcome,
    growth: &RunGrowth,
    scored: usize,
    unit: f64,
) -> f64 {
    // The start is given and measures nothing.
    if scored <= 1 {
        return f64::NAN;
    }
    let mut events = 0;
    worst((1..scored).map(|n| {
        let (row, growth) = (&truth.samples[n], &growth.samples[n]);
        let passed = |event: &&TruthRow| event.elapsed.minus(row.elapsed).value() <= 0.0;
        events += truth.events[events..].iter().take_while(passed).count();
        let Some(state) = outcome.samples.get(n) else { return f64::NAN };
        let largest = worst((0..4).map(|k| relative(row.state[k], state[k]) / growth[k]));
        largest / (unit * (events.max(1)) as f64)
    }))
}

fn relative(truth: TwoWord, value: f64) -> f64 {
    off(truth, value) / (1.0 + truth.value().abs())
}

#[cfg(test)]
#[path = "measure_tests.rs"]
mod tests;
