//! A truth of any run, in the shape of the tables.

use super::growth::GrowthMatrices;
use super::replay::{Beginning, Replay, Undecided};
use super::{DoubleDouble, Truth, TruthRow};
use crate::case::{Case, FileError, OscillatorCase, SAMPLES_PER_PERIOD};
use crate::engine::{OscillatorTask, SampleGrid, place};
use crate::integration::event_between;
use percuss::Ending;
use percuss::{Entry, Instant, Parameters, Phase, TwoWord};

/// The longest case without tables, in forcing periods: what is longer is not to be had in seconds.
const MAX_PERIODS: f64 = 1000.0;
/// The most events that a replayed run may have.
const MAX_EVENTS: usize = 1_000_000;

impl Truth {
    /// The truth of a case of which there are no tables. It shares its closed forms with the exact
    /// solver, which the tables do not.
    pub(super) fn of_oscillator(case: &Case, own: &OscillatorCase) -> Result<Self, FileError> {
        let period = own.problem.model.period();
        let grid = SampleGrid { per_period: SAMPLES_PER_PERIOD, count: 0 };
        let task = OscillatorTask::new(own, grid);
        if task.span > MAX_PERIODS * period {
            let what = "a horizon of more than 1000 forcing periods needs tables (reference_data/)";
            return Err(FileError(format!("{}: {what}", case.file)));
        }
        let begin = own.problem.entry.instant;
        let per_period = u64::from(SAMPLES_PER_PERIOD);
        let within = |k: &u64| begin.after_periods(*k, per_period) <= task.horizon;
        let samples = (0..).take_while(within).count();
        let grid = (samples, SAMPLES_PER_PERIOD);
        let truth = Self::replayed(own.parameters(), &own.problem.entry, task.horizon, grid);
        let mut truth = truth.map_err(|undecided| {
            FileError(format!("{}: {undecided}; it needs tables", case.file))
        })?;
        GrowthMatrices::new(case).fill(&mut truth);
        Ok(truth.with_sizes(&case.system.scales))
    }

    /// The run from `entry` to `horizon`, and its state at `samples` instants, `k / per_period`
    /// forcing periods after the start; how errors grow along it is not filled in.
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
        let row = |phase: Phase, instant: &Instant, values: [DoubleDouble; 4]| TruthRow {
            event: 0,
            mode: place(phase),
            elapsed: instant.since(&begin, omega),
            state: values.map(Into::into).to_vec(),
            growth_time: 1.0,
            growth: vec![1.0; 4],
            size: 0.0,
        };
        let opening = |it: &Beginning| row(it.phase(), &it.instant, it.values());
        let mut rows: Vec<TruthRow> = Vec::new();
        let mut sampled = Vec::with_capacity(samples);
        let mut before = entry.phase();
        for passage in Replay::new(parameters, entry, horizon) {
            let passage = passage?;
            let phase = passage.begin.phase();
            let event = event_between(std::mem::replace(&mut before, phase), phase);
            rows.push(TruthRow { event, ..opening(&passage.begin) });
            while sampled.len() < samples {
                let instant = begin.after_periods(sampled.len() as u64, u64::from(per_period));
                if passage.ends_by(&instant) {
                    break;
                }
                sampled.push(row(phase, &instant, passage.at(&instant)));
            }
            if passage.next.is_none() {
                let end = row(phase, &horizon, passage.at(&horizon));
                let start = rows.remove(0);
                let span = end.elapsed.value();
                let (ended, ordered) = (Ending::Horizon, true);
                return Ok(Self {
                    start,
                    events: rows,
                    end,
                    ended,
                    span,
                    samples: sampled,
                    ordered,
                });
            }
            if rows.len() > MAX_EVENTS {
                break;
            }
        }
        Err(Undecided { what: "the end of so many events", elapsed: 0.0 })
    }
}

/// The states of a run at these times since its start; none where 106 bits do not decide it so far.
pub(super) fn states_of_oscillator(
    own: &OscillatorCase,
    instants: &[f64],
) -> Option<Vec<Vec<f64>>> {
    let OscillatorTask { parameters, problem, horizon, .. } =
        OscillatorTask::new(own, SampleGrid { per_period: SAMPLES_PER_PERIOD, count: 0 });
    let start = problem.entry.instant;
    let mut states = Vec::with_capacity(instants.len());
    for passage in Replay::new(&parameters, &problem.entry, horizon) {
        let passage = passage.ok()?;
        while let Some(t) = instants.get(states.len()) {
            let instant = start.after(TwoWord::new(*t), parameters.omega);
            if passage.ends_by(&instant) {
                break;
            }
            states.push(passage.at(&instant).map(|it| it.to_f64()).to_vec());
        }
        if states.len() == instants.len() {
            return Some(states);
        }
    }
    None
}
