//! The truth of a system's case that has no tables: its run in 106 bits, with enclosed errors.
//!
//! It shares its method with the exact solver, which the tables do not.

use super::growth::GrowthMatrices;
use super::replayed::states_of_oscillator;
use super::{DoubleDouble, Truth, TruthRow};
use crate::case::{Case, FileError};
use percuss::Ending;
use percuss::TwoWord;
use percuss::affine::{self, Event, Solver, StartPoint, Time, What};
use percuss::number::Number;

/// The most events that a run without tables may have: how errors grow is followed from each of
/// them to every later one.
const MAX_EVENTS: usize = 3000;

/// The distance that every event keeps from a horizon and from a sample, in the system's unit of
/// time.
const MIN_DISTANCE: f64 = 1e-6;
/// Numbers of samples that are tried to name one that is accepted.
const MAX_SAMPLE_TRIALS: u32 = 1000;
/// States that differ by no more than this, over their scales, are those of one motion.
const STATE_TOLERANCE: f64 = 1e-9;

/// A run in 106 bits with what it is asked for.
struct SystemReplay<'a> {
    case: &'a Case,
    solver: &'a Solver<DoubleDouble>,
    begin: Time<DoubleDouble>,
}

impl Truth {
    /// The truth of a case of which there are no tables.
    pub(super) fn of_system(case: &Case) -> Result<Self, FileError> {
        let refused = |what: String| FileError::new(&case.file, what);
        let solver = solver(case).map_err(refused)?;
        Self::solve(case, &solver).map_err(refused)
    }

    /// The truth of a case's run, by the closed forms of its system in the direction of the run.
    ///
    /// # Errors
    /// What 106 bits leave undecided, and horizons and samples beside an event.
    pub fn solve(case: &Case, solver: &Solver<DoubleDouble>) -> Result<Self, String> {
        let start = case.system.start.as_ref().ok_or("the system has no start")?;
        let replay = SystemReplay { case, solver, begin: Time::new(&start.time) };
        let events = replay.events(start)?;
        replay.refuse_close_instants(&events)?;
        let mut truth = replay.truth(&events)?.with_sizes(&case.system.scales);
        GrowthMatrices::new(case).fill(&mut truth);
        Ok(truth)
    }
}

/// The closed forms of a case's system in the direction of its run, in 106 bits.
///
/// # Errors
/// A system that the solver does not take.
pub fn solver(case: &Case) -> Result<Solver<DoubleDouble>, String> {
    let solver =
        if case.backward { Solver::backward(&case.system) } else { Solver::new(&case.system) };
    solver.map_err(|it| it.to_string())
}

impl Truth {
    /// The states of a case's run in 106 bits at these times since its start; none where that does
    /// not decide the run so far.
    #[must_use]
    pub fn states(case: &Case, instants: &[f64]) -> Option<Vec<Vec<f64>>> {
        if let Some(own) = &case.oscillator {
            return states_of_oscillator(own, instants);
        }
        let (solver, start) = (solver(case).ok()?, case.system.start.as_ref()?);
        let replay = SystemReplay { case, solver: &solver, begin: Time::new(&start.time) };
        let events = replay.events(start).ok()?;
        let (last, events) = events.split_last()?;
        let end = replay.elapsed(&last.time).value();
        let decided = instants.last().is_none_or(|t| *t <= end);
        let state = |t: &f64| replay.sample(events, *t).state.iter().map(|it| it.value()).collect();
        decided.then(|| instants.iter().map(state).collect())
    }
}

impl SystemReplay<'_> {
    /// The start, the events and the ending of a run to just past the horizon.
    fn events(&self, start: &StartPoint) -> Result<Vec<Event<DoubleDouble>>, String> {
        let past = if self.case.backward { -self.least_distance() } else { self.least_distance() };
        let run = self.solver.run_enclosed(start, DoubleDouble::exact(self.case.until + past));
        let mut run = run.map_err(|it| it.to_string())?;
        let mut events = vec![run.start()];
        for event in run.by_ref() {
            events.push(event);
            if events.len() > MAX_EVENTS {
                return Err(format!("has more than {MAX_EVENTS} events; it needs tables"));
            }
        }
        if let Some(What::Until(mode, until)) = run.event_beyond_guard() {
            let mode = &self.case.system.modes[mode];
            let ended = self.elapsed(&events[events.len() - 1].time).value();
            return Err(format!(
                "its run ends {ended:?} after the start, where mode {:?} is entered beyond its guard of {:?}; \
                 accepted are a start inside its mode and a horizon before that",
                mode.name, mode.until[until].name
            ));
        }
        if run.overflows() {
            return Err(
                "its state becomes too large for bounds of it to be numbers; accepted is an earlier horizon"
                    .into(),
            );
        }
        Ok(events)
    }

    /// The least distance of an event from the horizon and from instants at which the state is
    /// tabulated.
    fn least_distance(&self) -> f64 {
        MIN_DISTANCE * self.case.system.time_scale
    }

    /// Refuses a horizon, and samples, beside an event: which of the two comes first is a matter of
    /// rounding there. The start has the state after its own events.
    fn refuse_close_instants(&self, events: &[Event<DoubleDouble>]) -> Result<(), String> {
        let (span, nearest) = (self.case.span(), self.least_distance());
        let is_event = |it: &&Event<DoubleDouble>| {
            !matches!(it.what, What::Start | What::Limit(..) | What::End(_))
        };
        let times = events.iter().filter(is_event).map(|it| self.elapsed(&it.time).value());
        let times: Vec<f64> = times.collect();
        if times.iter().any(|time| (time - span).abs() <= nearest) {
            return Err(format!(
                "until = {:?} is not accepted: an event lies within 1e-6 of the system's time scale of it; \
                 accepted is a horizon between events",
                self.case.until
            ));
        }
        let close = |count: u32| {
            let step = span / f64::from(count);
            let place = |time: f64| (time / step).round();
            let is_close = |time: &f64| {
                let k = place(*time);
                (1.0..f64::from(count)).contains(&k) && (k * step - time).abs() <= nearest
            };
            times.iter().copied().find(is_close)
        };
        let count = self.case.samples;
        let Some(time) = close(count) else { return Ok(()) };
        let other = (count + 1..count + MAX_SAMPLE_TRIALS).find(|count| close(*count).is_none());
        let other = other.map_or("another number".to_owned(), |count| format!("samples = {count}"));
        Err(format!(
            "samples = {count} is not accepted: one of them and the event {time:?} after the start are \
             within 1e-6 of the system's time scale; accepted is {other}"
        ))
    }

    /// The truth without its growth, from the start, the events and the ending of a run.
    fn truth(&self, events: &[Event<DoubleDouble>]) -> Result<Truth, String> {
        let Some((last, events)) = events.split_last() else { return Err("has no run".into()) };
        let What::End(ending) = last.what else { return Err("its run does not end".into()) };
        let end = self.elapsed(&last.time).value();
        let span = match ending {
            affine::Ending::Accumulation(earliest, _) => end + earliest.to_f64(),
            affine::Ending::BeyondGuard | affine::Ending::Undecided => {
                return Err(format!(
                    "is not decided in 106 bits {end:e} after the start; it needs tables"
                ));
            }
            _ => self.case.span(),
        };
        let ended = Ending::from(&ending);
        let rows: Vec<_> = events.iter().map(|event| self.row(event, self.number(event))).collect();
        let sampled_until = if ended == Ending::Horizon { f64::INFINITY } else { end };
        let times = self.case.sample_times(sampled_until);
        Ok(Truth {
            start: rows[0].clone(),
            samples: times.iter().map(|time| self.sample(events, *time)).collect(),
            events: rows[1..].to_vec(),
            end: match ended {
                Ending::Horizon => self.sample(events, span),
                _ => self.row(last, 0),
            },
            ended,
            span,
            ordered: self.order_matters(events),
        })
    }

    /// Whether what follows depends on the order in which events of one instant come: whether a run
    /// in which each mode has its events in the other order differs.
    fn order_matters(&self, events: &[Event<DoubleDouble>]) -> bool {
        let at = |event: &Event<DoubleDouble>| self.elapsed(&event.time);
        if !events.windows(2).any(|pair| at(&pair[1]).minus(at(&pair[0])).value() == 0.0) {
            return false;
        }
        let mut turned = self.case.system.clone();
        turned.modes.iter_mut().for_each(|mode| mode.until.reverse());
        let solver =
            if self.case.backward { Solver::backward(&turned) } else { Solver::new(&turned) };
        let (Ok(solver), Some(start)) = (solver, &self.case.system.start) else { return true };
        let other = SystemReplay { case: self.case, solver: &solver, begin: self.begin };
        let Ok(others) = other.events(start) else { return true };
        let Some((_, others)) = others.split_last() else { return true };
        let alike = |(own, other): (&Event<DoubleDouble>, &Event<DoubleDouble>)| {
            let pairs = own.state.iter().zip(&other.state).zip(&self.case.system.scales);
            let near = |((a, b), scale): ((&DoubleDouble, &DoubleDouble), &f64)| {
                (*a - *b).to_f64().abs() <= STATE_TOLERANCE * (scale + a.to_f64().abs())
            };
            own.mode == other.mode && pairs.into_iter().all(near)
        };
        // Between events of one instant the state is a matter of their order.
        let last = |events: &[Event<DoubleDouble>], n: usize| {
            events.get(n + 1).is_none_or(|next| at(next).minus(at(&events[n])).value() != 0.0)
        };
        let ends = (0..events.len()).filter(|n| last(events, *n));
        events.len() != others.len() || !ends.into_iter().all(|n| alike((&events[n], &others[n])))
    }

    fn elapsed(&self, time: &Time<DoubleDouble>) -> TwoWord {
        let ahead = (time.high - self.begin.high) + (time.low - self.begin.low);
        if self.case.backward { (-ahead).into() } else { ahead.into() }
    }

    fn number(&self, event: &Event<DoubleDouble>) -> usize {
        match event.what {
            What::Watch(mode, watch) => self.case.system.modes[mode].until.len() + watch,
            What::Until(_, until) => until,
            What::Start | What::Limit(..) | What::End(_) => 0,
        }
    }

    fn row(&self, event: &Event<DoubleDouble>, number: usize) -> TruthRow {
        let state = event.state.iter().map(|it| (*it).into()).collect();
        self.without_growth(number, event.mode, self.elapsed(&event.time), state)
    }

    /// The state at an instant, in the segment that the last event before it begins.
    fn sample(&self, events: &[Event<DoubleDouble>], elapsed: f64) -> TruthRow {
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
    ) -> TruthRow {
        let growth = vec![1.0; state.len()];
        TruthRow { event, mode, elapsed, state, growth_time: 1.0, growth, size: 0.0 }
    }
}
