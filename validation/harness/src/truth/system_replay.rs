//! The truth of a system's case that has no tables: its run in 106 bits, with enclosed errors.
//!
//! It shares its method with the exact solver, which the tables do not.

use super::{DoubleDouble, SystemTruth, SystemTruthRow, system_growth};
use crate::case::{FileError, SystemCase};
use crate::engine::Ended;
use percuss::TwoWord;
use percuss::affine::{Ending, Event, Solver, Time, What};
use percuss::number::Number;

/// The most events that a run without tables may have: how errors grow is followed from each of
/// them to every later one.
const MOST_EVENTS: usize = 3000;

/// A run in 106 bits with what it is asked for.
struct SystemReplay<'a> {
    case: &'a SystemCase,
    solver: &'a Solver<DoubleDouble>,
    begin: Time<DoubleDouble>,
}

impl SystemTruth {
    /// The truth of a case of which there are no tables.
    pub(super) fn without_tables(case: &SystemCase) -> Result<Self, FileError> {
        let refused = |what: &str| FileError::of(&case.file, what);
        let solver =
            if case.backward { Solver::backward(&case.system) } else { Solver::new(&case.system) };
        let solver: Solver<DoubleDouble> = solver.map_err(|it| refused(&it.to_string()))?;
        let start = case.system.start.as_ref().ok_or_else(|| refused("the system has no start"))?;
        let run = solver.run_enclosed(start, DoubleDouble::exact(case.until));
        let run = run.ok_or_else(|| refused("its start is not decided in 106 bits"))?;
        let replay = SystemReplay { case, solver: &solver, begin: Time::of(&start.time) };
        let mut events = vec![run.start()];
        for event in run {
            events.push(event);
            if events.len() > MOST_EVENTS {
                return Err(refused("has more than 3000 events; it needs tables"));
            }
        }
        let mut truth = replay.truth(&events).map_err(|what| refused(&what))?;
        system_growth::fill(&mut truth, case);
        Ok(truth)
    }
}

impl SystemReplay<'_> {
    /// The truth without its growth, from the start, the events and the ending of a run.
    fn truth(&self, events: &[Event<DoubleDouble>]) -> Result<SystemTruth, String> {
        let Some((last, events)) = events.split_last() else { return Err("has no run".into()) };
        let What::End(ending) = last.what else { return Err("its run does not end".into()) };
        let end = self.elapsed(&last.time).value();
        let (ended, span) = match ending {
            Ending::Horizon => (Ended::Horizon, self.case.span()),
            Ending::LeavesDomain => (Ended::LeavesDomain, self.case.span()),
            Ending::NoProgress => (Ended::NoProgress, self.case.span()),
            Ending::BeyondGuard => (Ended::BeyondGuard, self.case.span()),
            Ending::Accumulation(earliest, _) => (Ended::Accumulation, end + earliest.to_f64()),
            Ending::Undecided => {
                return Err(format!(
                    "is not decided in 106 bits {end:e} after the start; it needs tables"
                ));
            }
        };
        let rows: Vec<_> = events.iter().map(|event| self.row(event, self.number(event))).collect();
        let sampled_until = if ended == Ended::Horizon { f64::INFINITY } else { end };
        let times = self.case.sample_times(sampled_until);
        Ok(SystemTruth {
            start: rows[0].clone(),
            samples: times.iter().map(|time| self.sample(events, *time)).collect(),
            events: rows[1..].to_vec(),
            end: self.row(last, 0),
            ended,
            span,
            ordered: false,
        })
    }

    fn elapsed(&self, time: &Time<DoubleDouble>) -> TwoWord {
        let ahead = (time.high - self.begin.high) + (time.low - self.begin.low);
        if self.case.backward { (-ahead).into() } else { ahead.into() }
    }

    fn number(&self, event: &Event<DoubleDouble>) -> usize {
        match event.what {
            What::Watch(mode, watch) => self.case.system.modes[mode].until.len() + watch,
            What::Until(_, until) => until,
            What::Start | What::End(_) => 0,
        }
    }

    fn row(&self, event: &Event<DoubleDouble>, number: usize) -> SystemTruthRow {
        let state = event.state.iter().map(|it| (*it).into()).collect();
        self.without_growth(number, event.mode, self.elapsed(&event.time), state)
    }

    /// The state at an instant, in the segment that the last event before it begins.
    fn sample(&self, events: &[Event<DoubleDouble>], elapsed: f64) -> SystemTruthRow {
        let begun = |event: &&Event<DoubleDouble>| self.elapsed(&event.time).value() <= elapsed;
        let segment = events.iter().take_while(begun).last().unwrap_or(&events[0]);
        let ahead = if self.case.backward { -elapsed } else { elapsed };
        let time = self.begin.after(DoubleDouble::exact(ahead));
        let state = self.solver.state_at(segment, &time).into_iter().map(Into::into).collect();
        self.without_growth(0, segment.mode, TwoWord::new(elapsed), state)
    }

    fn without_growth(
        &self,
        event: usize,
        mode: usize,
        elapsed: TwoWord,
        state: Vec<TwoWord>,
    ) -> SystemTruthRow {
        let growth = vec![1.0; state.len()];
        SystemTruthRow { event, mode, elapsed, state, growth_time: 1.0, growth }
    }
}
