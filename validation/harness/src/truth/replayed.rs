//! A truth of any run, in the shape of the tables.

use super::replay::{Beginning, Replay, Undecided};
use super::{DoubleDouble, Truth, TruthRow};
use crate::case::{Case, FileError, Given};
use crate::engine::{OscillatorTask, SampleGrid};
use percuss::{Entry, Instant, Parameters};

/// The longest case without tables, in forcing periods: what is longer is not to be had in seconds.
const PERIODS: f64 = 1000.0;
/// The most events that a replayed run may have.
const EVENTS: usize = 1_000_000;

impl Truth {
    /// The truth of a case of which there are no tables. It shares its closed forms with the exact
    /// solver, which the tables do not.
    pub(super) fn without_tables(case: &Case) -> Result<Self, FileError> {
        let given = Given { parameters: case.parameters, start: case.start, ..Given::default() };
        let problem = given.check().map_err(FileError)?;
        let period = problem.model.period();
        let task = OscillatorTask::of(
            case,
            problem,
            SampleGrid { per_period: Self::SAMPLES_PER_PERIOD, count: 0 },
        );
        if task.span > PERIODS * period {
            let what = "a horizon of more than 1000 forcing periods needs tables (reference_data/)";
            return Err(FileError(format!("{}: {what}", case.file)));
        }
        let begin = problem.entry.instant;
        let per_period = u64::from(Self::SAMPLES_PER_PERIOD);
        let within = |k: &u64| begin.after_periods(*k, per_period) <= task.horizon;
        let samples = (0..).take_while(within).count();
        let grid = (samples, Self::SAMPLES_PER_PERIOD);
        Self::replayed(&case.parameters, &problem.entry, task.horizon, grid)
            .map_err(|undecided| FileError(format!("{}: {undecided}; it needs tables", case.file)))
    }

    /// The run from `entry` to `horizon`, and its state at `samples` instants, `k / per_period`
    /// forcing periods after the start.
    ///
    /// # Errors
    /// [`Undecided`] where 106 bits do not tell what comes next.
    pub fn replayed(
        parameters: &Parameters,
        entry: &Entry,
        horizon: Instant,
        (samples, per_period): (usize, u32),
    ) -> Result<Self, Undecided> {
        let omega = parameters.omega;
        let begin = entry.instant;
        let row = |phase, instant: &Instant, values: [DoubleDouble; 4]| TruthRow {
            phase,
            elapsed: instant.since(&begin, omega),
            state: values.map(Into::into),
        };
        let opening = |it: &Beginning| row(Some(it.phase()), &it.instant, it.values());
        let mut rows: Vec<TruthRow> = Vec::new();
        let mut sampled = Vec::with_capacity(samples);
        for passage in Replay::new(parameters, entry, horizon) {
            let passage = passage?;
            rows.push(opening(&passage.begin));
            while sampled.len() < samples {
                let instant = begin.after_periods(sampled.len() as u64, u64::from(per_period));
                if passage.ends_by(&instant) {
                    break;
                }
                sampled.push(row(Some(passage.begin.phase()), &instant, passage.at(&instant)));
            }
            if passage.next.is_none() {
                let end = row(None, &horizon, passage.at(&horizon));
                let start = rows.remove(0);
                return Ok(Self { start, events: rows, end, samples: sampled });
            }
            if rows.len() > EVENTS {
                break;
            }
        }
        Err(Undecided { what: "the end of so many events", elapsed: 0.0 })
    }
}
