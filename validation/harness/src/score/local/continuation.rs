//! The exact continuation of a record, as far as the next record, and what it has there.

use super::units::{Stretch, Units};
use percuss::Ending;
use percuss::affine::{self, Event, Followed, Follower, What};
use percuss::number::Number;

/// The most exact events between two records that are gone past.
const MAX_PASSED_EVENTS: usize = 64;

/// The place of a run at a record.
#[derive(Clone, Debug)]
pub(super) struct Place {
    /// Time since the start.
    pub(super) elapsed: f64,
    pub(super) mode: usize,
    /// The state, in which what is zero by the model is zero.
    pub(super) state: Vec<f64>,
    /// The guards that are outside and on their way back, as bits.
    pub(super) late: u64,
    /// Whether the mode begins here: at the start, and after an event that ended the mode before.
    pub(super) begins: bool,
}

/// An event of a mode, with the mode after it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Named {
    /// The place among the events of the mode, those of `until` first.
    pub(super) event: usize,
    /// The mode after the event.
    pub(super) next: usize,
}

/// An event of the exact continuation.
#[derive(Clone, Debug)]
pub(super) struct Exact {
    /// The mode of which it is an event.
    pub(super) mode: usize,
    pub(super) named: Named,
    pub(super) elapsed: f64,
    pub(super) state: Vec<f64>,
    pub(super) ends_mode: bool,
    /// Whether it is at the instant of the record before by the model.
    pub(super) at_once: bool,
}

/// What the exact continuation has at a record.
#[derive(Clone, Debug)]
pub(super) enum Found {
    /// The record's event, within the time that is allowed.
    Same(Exact),
    /// Another event, within the time that is allowed.
    Another(Exact),
    /// The record's event, earlier than is allowed.
    Late(Exact),
    /// No event within the time that is allowed; the exact event after it, if there is one.
    Nothing(Option<Exact>),
    /// The continuation ends before the record.
    Ended(Ending),
}

/// The exact continuation up to a record.
#[derive(Clone, Debug)]
pub(super) struct Continuation {
    pub(super) found: Found,
    /// The exact events that no record tells, in the order of time.
    pub(super) passed: Vec<Exact>,
    /// Whether the arithmetic decided it.
    pub(super) decided: bool,
}

impl Place {
    /// The stretch from the record up to a time.
    pub(super) fn stretch(&self, elapsed: f64) -> Stretch<'_> {
        let length = (elapsed - self.elapsed).max(0.0);
        Stretch { mode: self.mode, elapsed: self.elapsed, state: &self.state, length }
    }
}

impl Named {
    pub(super) fn followed(self, until: usize) -> Followed {
        if self.event < until {
            Followed::Until(self.event, self.next)
        } else {
            Followed::Watch(self.event - until)
        }
    }
}

/// The exact event of a continuation; none for its ending.
pub(super) fn exact<T: Number>(
    follower: &Follower<'_, T>,
    event: &Event<T>,
    until: usize,
    at_once: bool,
) -> Option<Exact> {
    let (mode, place, ends_mode) = match event.what {
        What::Until(mode, place) => (mode, place, true),
        What::Watch(mode, place) => (mode, until + place, false),
        What::Start | What::Limit(..) | What::End(_) => return None,
    };
    let state = event.state.iter().map(|it| it.to_f64()).collect();
    let named = Named { event: place, next: event.mode };
    Some(Exact { mode, named, elapsed: follower.elapsed(event), state, ends_mode, at_once })
}

/// Follows the exact continuation of a place up to a record's event at a time.
pub(super) fn continuation<T: Number>(
    units: &Units<'_>,
    follower: &mut Follower<'_, T>,
    place: &Place,
    (wanted, elapsed): (Named, f64),
) -> Continuation {
    let until = units.motion.system().modes[place.mode].until.len();
    let ahead = 0.5 * (elapsed - place.elapsed) + units.motion.system().time_scale;
    let horizon = elapsed + ahead;
    follower.go_on(place.elapsed, &place.state, horizon, place.late);
    let mut at_once = follower.fires_at_once();
    let mut passed = Vec::new();
    let mut late: Option<Exact> = None;
    let mut gone_past = place.late;
    let mut found = None;
    while found.is_none() && passed.len() < MAX_PASSED_EVENTS {
        let Some(event) = follower.next() else { break };
        let Some(own) = exact(follower, &event, until, std::mem::take(&mut at_once)) else {
            let What::End(ending) = event.what else { continue };
            found = ending_found(ending);
            break;
        };
        let off = elapsed - own.elapsed;
        let allowed = allowed_time_error(units, place, &own, off);
        let same = own.named.event == wanted.event;
        if off.abs() <= allowed {
            found = Some(if same { Found::Same(own) } else { Found::Another(own) });
        } else if off < 0.0 {
            found = Some(Found::Nothing(Some(own)));
        } else {
            if own.ends_mode {
                gone_past |= 1 << own.named.event;
                follower.go_past(own.elapsed + 0.5 * allowed.min(off), horizon, gone_past);
            }
            // Of the record's own event the nearest counts.
            if same {
                passed.extend(late.replace(own));
            } else {
                passed.push(own);
            }
        }
    }
    let found = match (found, late) {
        (Some(Found::Nothing(_)) | None, Some(late)) => Found::Late(late),
        (found, late) => {
            passed.extend(late);
            found.unwrap_or(Found::Nothing(None))
        }
    };
    passed.sort_by(|a, b| a.elapsed.total_cmp(&b.elapsed));
    Continuation { found, passed, decided: follower.is_decided() }
}

/// The time by which an exact event may be off, as far as it has to be known to place it.
fn allowed_time_error(units: &Units<'_>, place: &Place, own: &Exact, off: f64) -> f64 {
    let plain = units.allowance.time * units.tolerance() * units.motion.system().time_scale;
    if off.abs() <= plain {
        return plain;
    }
    units.allowed_time(&place.stretch(own.elapsed), own.named.event)
}

fn ending_found<T: Number>(ending: affine::Ending<T>) -> Option<Found> {
    let ending = Ending::from(&ending);
    (ending != Ending::Horizon).then_some(Found::Ended(ending))
}
