//! Derivatives through events in a file: a line an event and a name.

use super::table::{Cells, Table};
use crate::text::plain;
use crate::wire::{EventGradientReply, GradientReply, StateReply};
use percuss_engines::engine::{Limits, Numbers, Task};
use percuss_engines::system::{System, Values};

/// The columns before those of the states.
const COLUMNS: [&str; 4] = ["n", "event", "wrt", "dtime"];

/// The word of the last lines, which have the derivatives at the time at which the run ends.
const END: &str = "end";

/// The derivatives by each name in the file, in the order in which the names come. Line n of a name
/// is about event n of the run, from 1 on; a line 0, of the start, is left out, and so are events
/// without a line. A state's cell that is empty leaves the event's states out.
///
/// # Errors
/// What is wrong, with the line, the value and what is accepted.
pub(super) fn gradients(
    table: &Table,
    task: &Task,
    limits: &Limits,
) -> Result<Vec<GradientReply>, String> {
    let system = task.system.system();
    let names = task.gradients.as_deref().map_or(&[][..], Vec::as_slice);
    let mut found: Vec<(GradientReply, bool)> = Vec::new();
    table.lines(&columns(system), |cells| {
        let wrt = cells.word(2);
        if !names.iter().any(|it| it.name == wrt) {
            let accepted: Vec<&str> = names.iter().map(|it| it.name.as_str()).collect();
            let accepted = accepted.join(", ");
            return Err(format!("wrt is {:?}; accepted are {accepted}", plain(wrt)));
        }
        let place = found.iter().position(|(it, _)| it.wrt == wrt).unwrap_or_else(|| {
            found.push((GradientReply { wrt: wrt.to_owned(), ..Default::default() }, false));
            found.len() - 1
        });
        let (reply, has_end) = &mut found[place];
        if *has_end {
            return Err(format!("a line by {:?} after its end; accepted is none", plain(wrt)));
        }
        let state = state(cells, system)?;
        if cells.word(1) == END {
            reply.end = state.ok_or_else(|| {
                "states without derivatives at the end; accepted are numbers".to_owned()
            })?;
            *has_end = true;
            return Ok(());
        }
        let time = Some(cells.word(3)).filter(|it| !it.is_empty());
        let time = time.map(|_| cells.number(3, COLUMNS[3])).transpose()?;
        let event = EventGradientReply { time, state };
        place_event(&mut reply.events.0, cells, event, limits)
    })?;
    // A name without its end has no answer.
    Ok(found.into_iter().filter(|(_, has_end)| *has_end).map(|(reply, _)| reply).collect())
}

/// Puts the derivatives of an event in its place.
fn place_event(
    events: &mut Vec<EventGradientReply>,
    cells: &Cells<'_>,
    event: EventGradientReply,
    limits: &Limits,
) -> Result<(), String> {
    let n = cells.word(0).parse().ok().filter(|n: &usize| *n <= limits.events);
    let n = n.ok_or_else(|| {
        let given = plain(cells.word(0));
        format!("n is {given:?}; accepted is a whole number, 0 to {}", limits.events)
    })?;
    if n == 0 {
        return Ok(());
    }
    if n <= events.len() {
        return Err(format!("event {n} comes after event {}; accepted is one later", events.len()));
    }
    events.resize(n - 1, EventGradientReply::default());
    events.push(event);
    Ok(())
}

/// The derivatives of the states in a line; none where a cell is empty.
fn state(cells: &Cells<'_>, system: &System) -> Result<Option<StateReply>, String> {
    let places = COLUMNS.len()..COLUMNS.len() + system.states.len();
    if places.clone().any(|it| cells.word(it).is_empty()) {
        return Ok(None);
    }
    let number = |(name, place): (&String, usize)| cells.number(place, &format!("d{name}"));
    let values: Result<Vec<f64>, String> = system.states.iter().zip(places).map(number).collect();
    Ok(Some(StateReply(Values::from_slice(&values?))))
}

fn columns(system: &System) -> Vec<String> {
    let states = system.states.iter().map(|it| format!("d{it}"));
    COLUMNS.iter().map(|it| (*it).to_owned()).chain(states).collect()
}
