//! An answer in files, as the reply of a program would say it.

use super::gradients::gradients;
use super::layout::Layout;
use super::rows::sample_times;
use super::table::{Cells, EVENTS_ENDING, GRADIENTS_ENDING, SAMPLES_ENDING, Table};
use crate::answer::{AnswerPart, Wrong, checked};
use crate::text::plain;
use crate::wire::{BoundedList, Count, EventReply, RunReply, StateReply};
use percuss_engines::engine::Ending;
use percuss_engines::engine::{Limits, Numbers, Outcome, Task};
use percuss_engines::number::shortest;
use percuss_engines::system::{System, Values};
use std::path::Path;
use std::time::Duration;

/// The distance of a sample's written time from the instant asked for, relative to the horizon, up
/// to which the two are one.
const TIME_TOLERANCE: f64 = 1e-9;

/// Reads what was answered to a case and holds it against its task. The files of samples and of
/// derivatives may be missing, and the latter is read where the task asks for them.
///
/// # Errors
/// What is wrong, with the file, its line, the value and what is accepted.
pub(super) fn answer(
    folder: &Path,
    case: &str,
    task: &Task,
    limits: &Limits,
) -> Result<Outcome, String> {
    let file = |ending: &str| folder.join(format!("{case}{ending}"));
    let events = Table::read(&file(EVENTS_ENDING))?;
    let optional = |ending: &str| {
        Some(file(ending)).filter(|it| it.exists()).map(|it| Table::read(&it)).transpose()
    };
    let samples = optional(SAMPLES_ENDING)?;
    let derivatives = if task.gradients.is_some() { optional(GRADIENTS_ENDING)? } else { None };
    let derivatives = derivatives.map(|it| gradients(&it, task, limits)).transpose()?;
    let told = Told::read(&events, task, limits)?;
    let is_whole = matches!(told.ended, None | Some((Ending::Horizon, ..)));
    let (asked, (states, lines)) = match &samples {
        Some(table) => (crate::wire::samples(task).len(), read_samples(table, task, is_whole)?),
        None => (0, Default::default()),
    };
    let (ended, end, ended_at) = match told.ended {
        Some((Ending::Horizon, _, state)) => (Ending::Horizon, state, None),
        Some((ended, time, state)) => (ended, state, Some(time)),
        None => {
            let last = told.events.last().map_or(StateReply(task.state), |it| it.state);
            (Ending::Horizon, states.last().copied().unwrap_or(last), None)
        }
    };
    let reply = RunReply {
        events: BoundedList(told.events),
        samples: BoundedList(states.into_iter().take(asked).collect()),
        end,
        ended,
        ended_at,
        work: Default::default(),
        own_ns: None,
        gradients: BoundedList(derivatives.unwrap_or_default()),
    };
    checked(&reply, task, (asked, Duration::ZERO), limits).map_err(
        |Wrong { part, what }| match part {
            AnswerPart::Event(n) => events.error_in(told.lines[n], &what),
            AnswerPart::Sample(n) => samples
                .as_ref()
                .map_or_else(|| events.error(&what), |it| it.error_in(lines[n], &what)),
            AnswerPart::End | AnswerPart::Run => events.error(&what),
        },
    )
}

/// The distance of a written start from the case's own, relative to 1 and its size, up to which the
/// two are one: files of few digits are accepted, and those of another start are not.
const START_TOLERANCE: f64 = 1e-3;

/// The content of a file of events.
#[derive(Default)]
struct Told {
    events: Vec<EventReply>,
    /// The line of each event.
    lines: Vec<usize>,
    /// How and when the run ended, where the file says it, and in which state.
    ended: Option<(Ending, f64, StateReply)>,
}

impl Told {
    fn read(table: &Table, task: &Task, limits: &Limits) -> Result<Self, String> {
        let system = task.system.system();
        let layout = Layout::of_events(table, system)?;
        let (mut told, mut mode, mut start) = (Self::default(), task.mode, None);
        table.lines(&layout.columns, |cells| {
            if told.ended.is_some() {
                return Err("a line after the run's ending; accepted is none".to_owned());
            }
            if layout.has_start && start.is_none() {
                start = Some(start_of(cells, &layout, task)?);
                return Ok(());
            }
            if told.events.len() == limits.events {
                return Err(format!("one event more than the {} accepted", limits.events));
            }
            let time = cells.number(layout.time, "time")?;
            let time = start.map_or(time, |start| elapsed(task, start, time));
            let state = state(cells, layout.state, system)?;
            let [event, next] = [1, 2].map(|column| cells.word(layout.time + column));
            let next = mode_of(system, next)?;
            if let Some(ended) = layout.ending(event) {
                told.ended = Some((ended, time, state));
                return Ok(());
            }
            let event = event_of(system, mode, event)?;
            let before = layout.before.map(|from| self::state(cells, from, system)).transpose()?;
            let [event, next_count] = [event, next].map(|place| Count(place as u64));
            told.events.push(EventReply { time, event, mode: next_count, state, before });
            told.lines.push(cells.line);
            mode = next;
            Ok(())
        })?;
        Ok(told)
    }
}

/// The time since the start at a time of the clock, which falls back in time.
fn elapsed(task: &Task, start: f64, time: f64) -> f64 {
    if task.system.is_backward() { start - time } else { time - start }
}

/// The time of the first line of what `percuss events` prints, if the line is the task's start.
fn start_of(cells: &Cells<'_>, layout: &Layout, task: &Task) -> Result<f64, String> {
    let system = task.system.system();
    let [event, mode] = [1, 2].map(|column| cells.word(layout.time + column));
    if !event.is_empty() {
        return Err(format!("event is {:?}; accepted is none at the start", plain(event)));
    }
    let own = &system.modes[task.mode].name;
    if mode != own {
        return Err(format!("mode is {:?}; accepted is that of the start, {own}", plain(mode)));
    }
    let given = state(cells, layout.state, system)?.0;
    let all = system.states.iter().zip(given.iter().zip(task.state.iter()));
    for (name, (given, own)) in all {
        // Written so that a NaN is refused.
        let is_near = (given - own).abs() <= START_TOLERANCE * (1.0 + own.abs());
        if !is_near {
            let own = shortest(*own);
            return Err(format!(
                "{name} is {}; accepted is that of the start, {own}",
                shortest(*given)
            ));
        }
    }
    cells.number(layout.time, "time")
}

fn state(cells: &Cells<'_>, from: usize, system: &System) -> Result<StateReply, String> {
    let number = |(i, name): (usize, &String)| cells.number(from + i, name);
    let values: Result<Vec<f64>, String> = system.states.iter().enumerate().map(number).collect();
    Ok(StateReply(Values::from_slice(&values?)))
}

fn mode_of(system: &System, name: &str) -> Result<usize, String> {
    let place = system.modes.iter().position(|mode| mode.name == name);
    place.ok_or_else(|| {
        let accepted: Vec<_> = system.modes.iter().map(|mode| mode.name.as_str()).collect();
        format!("mode is {:?}; accepted are {}", plain(name), accepted.join(", "))
    })
}

fn event_of(system: &System, mode: usize, name: &str) -> Result<usize, String> {
    let own = |event| system.event_name(mode, event);
    let mut names = (0..).map_while(own);
    names.clone().position(|it| it == name).ok_or_else(|| {
        let early = Ending::ALL.into_iter().filter(|it| *it != Ending::Horizon);
        let mut accepted: Vec<&str> = names.by_ref().collect();
        accepted.extend(early.map(|it| it.as_str()));
        let mode = &system.modes[mode].name;
        let name = plain(name);
        format!("event is {name:?} in mode {mode}; accepted are {}", accepted.join(", "))
    })
}

/// The states at the times asked for, with their lines; of a run that ended early as many as there
/// are.
fn read_samples(
    table: &Table,
    task: &Task,
    whole: bool,
) -> Result<(Vec<StateReply>, Vec<usize>), String> {
    let system = task.system.system();
    let layout = Layout::of_samples(table, system)?;
    let asked = sample_times(task);
    let (mut samples, mut lines, mut start) = (Vec::new(), Vec::new(), None);
    table.lines(&layout.columns, |cells| {
        let mut time = cells.number(layout.time, "time")?;
        if layout.has_start {
            time = elapsed(task, *start.get_or_insert(time), time);
        }
        let Some(wanted) = asked.get(samples.len()) else {
            return Err(format!("one sample more than the {} accepted", asked.len()));
        };
        if (time - wanted).abs() > TIME_TOLERANCE * task.span {
            let given = plain(cells.word(0));
            return Err(format!("time is {given:?}; accepted is {}", shortest(*wanted)));
        }
        samples.push(state(cells, layout.state, system)?);
        lines.push(cells.line);
        Ok(())
    })?;
    if whole && samples.len() < asked.len() {
        let (given, wanted) = (samples.len(), asked.len());
        return Err(table.error(&format!(
            "{given} samples; accepted are {wanted}, or fewer where the events' last line is how the \
             run ended"
        )));
    }
    Ok((samples, lines))
}
