//! The states that a file says are drifts, and the expressions that show that one is none.

use crate::affine::model::drift::Place;
use crate::affine::model::error::SystemError;
use crate::affine::model::file::{NextEntry, SystemFile};
use crate::affine::model::scalar::{Assignment, Condition, Scalar};
use crate::affine::model::system::System;

/// The indices of the states that the file says are drifts; none where it does not say.
pub(super) fn declared_drifts(
    file: &SystemFile,
    system: &System,
) -> Result<Option<Vec<usize>>, SystemError> {
    let Some(names) = &file.tables.drift else { return Ok(None) };
    let mut drift = Vec::with_capacity(names.len());
    for name in names {
        let refuse = |what: &str| Err(file.error(&name.span(), what));
        let name = name.get_ref();
        let Some(n) = system.states.iter().position(|it| it == name) else {
            let accepted = system.states.join(", ");
            return refuse(&format!("{name} is no state: accepted are {accepted}"));
        };
        if drift.contains(&n) {
            return refuse(&format!("{name} is there twice"));
        }
        if let Some(place) = system.dependent_on(n) {
            let written = written_text(file, system, place).unwrap_or_default();
            return refuse(&system.no_drift(n, place, written));
        }
        drift.push(n);
    }
    Ok(Some(drift))
}

/// An expression as it is written, where it is a text.
fn written_text<'a>(file: &'a SystemFile, system: &System, place: Place) -> Option<&'a str> {
    let modes = &file.tables.mode;
    let assigned = |it: &'a Assignment, n: usize| match it {
        Assignment::Text(text) => {
            let left = text.split('=').next()?.trim().trim_end_matches('\'').trim_end();
            (left == system.states[n]).then_some(text.as_str())
        }
        Assignment::To { .. } => None,
    };
    match place {
        Place::Equation { mode, state } => {
            let mut all = modes[mode].equations.get_ref().iter();
            all.find_map(|it| assigned(it.get_ref(), state))
        }
        Place::Guard { mode, event } => {
            let table = &modes[mode];
            let watched = table.watch.iter().map(|it| &it.guard);
            let mut all = table.until.iter().map(|it| &it.guard).chain(watched);
            text(all.nth(event)?.get_ref())
        }
        Place::Reset { mode, until, state } => {
            let mut all = modes[mode].until[until].reset.iter();
            all.find_map(|it| assigned(it.get_ref(), state))
        }
        Place::When { mode, until, successor } => {
            let NextEntry::Modes(next) = modes[mode].until[until].next.as_ref()?.get_ref() else {
                return None;
            };
            text(next.get(successor)?.when.as_ref()?.get_ref())
        }
        Place::Limit { .. } => None,
        Place::Start { choice } => text(&file.start.as_ref()?.modes.get(choice)?.when.as_ref()?.0),
    }
}

fn text(Condition(scalar): &Condition) -> Option<&str> {
    match scalar {
        Scalar::Text(text) => Some(text),
        _ => None,
    }
}
