//! A run as a program answers it, held against the task before anything is measured of it.

use crate::text::plain;
use crate::wire::{EventGradientReply, EventReply, GradientReply, RunReply};
use percuss_engines::engine::Ending;
use percuss_engines::engine::{
    Event, EventDerivatives, Limits, Outcome, RunDerivatives, Task, Work,
};
use percuss_engines::system::{Mode, Values};
use std::fmt;
use std::time::Duration;

/// The distance beyond the horizon at which rounding may put an event, relative to the whole run.
const HORIZON_TOLERANCE: f64 = 16.0 * f64::EPSILON;
/// The time by which a run's reported time may exceed the wait for its answer: two clocks differ by
/// less.
const CLOCK_TOLERANCE: Duration = Duration::from_millis(10);

/// An error in an answer, with its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Wrong {
    pub(crate) part: AnswerPart,
    pub(crate) what: String,
}

/// The part of an answer that an error is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum AnswerPart {
    Run,
    End,
    Event(usize),
    Sample(usize),
}

impl AnswerPart {
    fn wrong(self, what: impl Into<String>) -> Wrong {
        Wrong { part: self, what: what.into() }
    }
}

impl fmt::Display for Wrong {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = &self.what;
        match self.part {
            AnswerPart::Run => f.write_str(what),
            AnswerPart::End => write!(f, "its end {what}"),
            AnswerPart::Event(n) => write!(f, "event {n} {what}"),
            AnswerPart::Sample(n) => write!(f, "sample {n} {what}"),
        }
    }
}

/// The run, if it is one of the task; `asked` is how many samples were asked for, and how long the
/// answer took.
///
/// # Errors
/// What no run of this task is, and where in the answer.
pub(crate) fn checked(
    reply: &RunReply,
    task: &Task,
    (asked, took): (usize, Duration),
    limits: &Limits,
) -> Result<Outcome, Wrong> {
    let size = task.state.len();
    let ended = ending_of(reply, task)?;
    let events = events(&reply.events.0, task, limits)?;
    let ended_at = ended_at(reply, ended, &events, task)?;
    has_states(reply.end.0.len(), size, AnswerPart::End)?;
    let mut samples = Vec::with_capacity(asked);
    for (n, sample) in reply.samples.0.iter().enumerate() {
        has_states(sample.0.len(), size, AnswerPart::Sample(n))?;
        samples.push(sample.0);
    }
    let early = ended != Ending::Horizon && samples.len() < asked;
    if early {
        samples.resize(asked, reply.end.0);
    }
    if samples.len() != asked {
        let what = format!("gave {} samples where {asked} were asked for", samples.len());
        return Err(AnswerPart::Run.wrong(what));
    }
    Ok(Outcome {
        events,
        samples,
        end: reply.end.0,
        ended,
        ended_at,
        work: work(reply, limits)?,
        own_time: own_time(reply, took)?,
        trace: None,
        gradients: gradients(&reply.gradients.0, task)?,
    })
}

/// The derivatives by the names that were asked for, in their order.
fn gradients(given: &[GradientReply], task: &Task) -> Result<Vec<Option<RunDerivatives>>, Wrong> {
    let asked = task.gradients.as_deref().map_or(&[][..], Vec::as_slice);
    let mut by = vec![None; asked.len()];
    for reply in given {
        let name = plain(&reply.wrt);
        let Some(place) = asked.iter().position(|it| it.name == reply.wrt) else {
            let names: Vec<&str> = asked.iter().map(|it| it.name.as_str()).collect();
            let accepted = if names.is_empty() {
                "none, as none is asked for".into()
            } else {
                names.join(", ")
            };
            let what = format!("gave derivatives by {name:?}; accepted are {accepted}");
            return Err(AnswerPart::Run.wrong(what));
        };
        if by[place].replace(derivatives(reply)).is_some() {
            return Err(AnswerPart::Run.wrong(format!("gave derivatives by {name:?} twice")));
        }
    }
    Ok(by)
}

fn derivatives(reply: &GradientReply) -> RunDerivatives {
    let event = |it: &EventGradientReply| EventDerivatives {
        time: it.time,
        state: it.state.map(|it| it.0),
    };
    RunDerivatives { events: reply.events.0.iter().map(event).collect(), end: reply.end.0 }
}

fn ending_of(reply: &RunReply, task: &Task) -> Result<Ending, Wrong> {
    if reply.ended == Ending::LeavesDomain && !task.system.is_backward() {
        return Err(
            AnswerPart::Run.wrong("ended with leaves-domain, which only runs back in time do")
        );
    }
    Ok(reply.ended)
}

/// When a run ended: where it does not say so, at the horizon, or with its last event.
fn ended_at(reply: &RunReply, ended: Ending, events: &[Event], task: &Task) -> Result<f64, Wrong> {
    let last = events.last().map_or(0.0, |event| event.elapsed);
    let usual = if ended == Ending::Horizon { task.span } else { last };
    let time = reply.ended_at.unwrap_or(usual);
    // Written so that a NaN is refused.
    if (last..=task.span * (1.0 + HORIZON_TOLERANCE)).contains(&time) {
        return Ok(time.min(task.span));
    }
    let what = format!("ended at {time:?}; accepted is {last:?} to {:?}", task.span);
    Err(AnswerPart::Run.wrong(what))
}

fn has_states(given: usize, size: usize, part: AnswerPart) -> Result<(), Wrong> {
    if given == size {
        return Ok(());
    }
    Err(part.wrong(format!("has {given} states; accepted are {size}")))
}

/// The state before an event's reset, where the answer has one.
fn before_reset(reply: &EventReply, size: usize, n: usize) -> Result<Option<Values>, Wrong> {
    let Some(before) = reply.before else { return Ok(None) };
    let given = before.0.len();
    if given == size {
        return Ok(Some(before.0));
    }
    let what = format!("has {given} states before its reset; accepted are {size}");
    Err(AnswerPart::Event(n).wrong(what))
}

fn events(replies: &[EventReply], task: &Task, limits: &Limits) -> Result<Vec<Event>, Wrong> {
    if replies.len() > limits.events {
        let what = format!("gave {} events; accepted are {}", replies.len(), limits.events);
        return Err(AnswerPart::Run.wrong(what));
    }
    let (size, latest) = (task.state.len(), task.span * (1.0 + HORIZON_TOLERANCE));
    let (mut mode, mut earliest) = (task.mode, 0.0);
    let mut events = Vec::with_capacity(replies.len());
    for (n, reply) in replies.iter().enumerate() {
        let said = |what: String| AnswerPart::Event(n).wrong(what);
        let time = reply.time;
        if !(earliest..=latest).contains(&time) {
            let span = task.span;
            return Err(said(format!("is at {time:?}; accepted is {earliest:?} to {span:?}")));
        }
        let (event, next) = (part(reply.event.0), part(reply.mode.0));
        follows(&task.system.system().modes, (mode, event, next), task).map_err(said)?;
        has_states(reply.state.0.len(), size, AnswerPart::Event(n))?;
        let before = before_reset(reply, size, n)?;
        let elapsed = time.min(task.span);
        events.push(Event { event, mode: next, elapsed, before, state: reply.state.0 });
        (mode, earliest) = (next, time);
    }
    Ok(events)
}

fn part(count: u64) -> usize {
    usize::try_from(count).unwrap_or(usize::MAX)
}

/// Whether an event of one mode can lead into another.
fn follows(
    modes: &[Mode],
    (mode, event, next): (usize, usize, usize),
    task: &Task,
) -> Result<(), String> {
    let from = &modes[mode];
    let most = from.until.len() + from.watch.len();
    if event >= most {
        return Err(format!("is number {event} of mode {:?}, which has {most} events", from.name));
    }
    if next >= modes.len() {
        return Err(format!("leads into mode {next}, where there are {} modes", modes.len()));
    }
    let accepted: Vec<usize> = match from.until.get(event) {
        Some(_) if task.system.is_backward() => {
            return Err("ends a mode, where a run back in time ends".to_owned());
        }
        Some(until) => until.next.iter().map(|(_, mode)| *mode).collect(),
        None => vec![mode],
    };
    if accepted.contains(&next) {
        return Ok(());
    }
    let named = |mode: usize| format!("{:?}", modes[mode].name);
    let accepted: Vec<String> = accepted.into_iter().map(named).collect();
    let (mode, next, accepted) = (named(mode), named(next), accepted.join(", "));
    Err(format!("leads from mode {mode} into mode {next}; accepted are {accepted}"))
}

fn work(reply: &RunReply, limits: &Limits) -> Result<Work, Wrong> {
    let work = Work {
        rhs_evaluations: reply.work.rhs.0,
        jacobian_evaluations: reply.work.jacobians.0,
        linear_solves: reply.work.linear_solves.0,
        steps: reply.work.steps.0,
    };
    let calls = work.rhs_evaluations.saturating_add(work.jacobian_evaluations);
    if calls > limits.calls {
        return Err(
            AnswerPart::Run.wrong(format!("took {calls} calls; accepted are {}", limits.calls))
        );
    }
    Ok(work)
}

fn own_time(reply: &RunReply, took: Duration) -> Result<Option<Duration>, Wrong> {
    let Some(own) = reply.own_ns else { return Ok(None) };
    let most = took + took / 100 + CLOCK_TOLERANCE;
    if !(0.0..=most.as_nanos() as f64).contains(&own) {
        return Err(AnswerPart::Run.wrong(format!(
            "says that it took {own} ns of its own; accepted is 0 to the {} that its answer took",
            took.as_nanos()
        )));
    }
    Ok(Some(Duration::from_nanos(own as u64)))
}
