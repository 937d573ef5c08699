//! Derivatives of a run through its events, as an engine answers them.

use super::{Outcome, Task};
use crate::failure::Failure;
use crate::system::Values;

/// The derivatives of a run by one name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunDerivatives {
    /// Those of each event of the run, or none where the engine has those of the end alone.
    pub events: Vec<EventDerivatives>,
    /// Those of the states at the horizon, which is a fixed time.
    pub end: Values,
}

/// The derivatives of an event by one name, as far as the engine has them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EventDerivatives {
    /// The derivative of the event's time.
    pub time: Option<f64>,
    /// The total derivatives of the states just after the event, at its time, which moves.
    pub state: Option<Values>,
}

/// Checks that derivatives are those of the names that were asked for and of the run's own events.
pub(super) fn complete(outcome: &Outcome, task: &Task) -> Result<(), Failure> {
    let asked = task.gradients.as_deref().map_or(&[][..], Vec::as_slice);
    let given = &outcome.gradients;
    if !given.is_empty() && given.len() != asked.len() {
        let (given, asked) = (given.len(), asked.len());
        let what = format!("gave derivatives by {given} names where {asked} were asked for");
        return Err(Failure::new(what));
    }
    let by = asked.iter().zip(given).filter_map(|(it, given)| Some((&it.name, given.as_ref()?)));
    for (name, derivatives) in by {
        let (events, size) = (outcome.events.len(), task.state.len());
        derivatives
            .check(events, size)
            .map_err(|what| Failure::new(format!("the derivatives by {name}: {what}")))?;
    }
    Ok(())
}

impl RunDerivatives {
    /// Whether there are those of all events or of none, and all of them are finite.
    fn check(&self, events: usize, size: usize) -> Result<(), String> {
        let given = self.events.len();
        if given > 0 && given != events {
            return Err(format!("they are of {given} events, and the run has {events}"));
        }
        check_state("the end", &self.end, size)?;
        for (n, event) in self.events.iter().enumerate() {
            if let Some(time) = event.time.filter(|it| !it.is_finite()) {
                return Err(format!("event {n} has {time} for its time"));
            }
            if let Some(state) = &event.state {
                check_state(&format!("event {n}"), state, size)?;
            }
        }
        Ok(())
    }
}

fn check_state(of: &str, state: &Values, size: usize) -> Result<(), String> {
    if state.len() != size {
        return Err(format!("{of} has {} states; accepted are {size}", state.len()));
    }
    match state.iter().find(|it| !it.is_finite()) {
        Some(value) => Err(format!("{of} has {value} for a state")),
        None => Ok(()),
    }
}
