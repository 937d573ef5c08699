//! Sections through the motions of a system, and the events of a system that they name.

use crate::affine::model::error::SystemError;
use crate::affine::model::system::{Direction, System};
use crate::affine::solver::event::What;
use std::fmt;

/// The largest angle of a strobe, in radians: as of a time of the oscillator.
const MAX_ANGLE: f64 = 1e15;

/// A section through the motions of a system: instants of one forcing angle, or an event.
///
/// ```
/// use percuss::system::Section;
///
/// assert_eq!(Section::strobe(0.5).to_string(), "strobe:0.5");
/// let third = Section::event("impact").in_mode("free").every(3);
/// assert_eq!(third.to_string(), "impact@free");
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    cut: Cut,
    every: u32,
}

#[derive(Clone, Debug, PartialEq)]
enum Cut {
    Strobe(f64),
    Event { name: String, mode: Option<String> },
}

impl Section {
    /// The instants at which omega t has this angle modulo 2 pi, in radians from -1e15 to 1e15; phi
    /// is not included.
    #[must_use]
    pub fn strobe(angle: f64) -> Self {
        Self { cut: Cut::Strobe(angle), every: 1 }
    }

    /// An event of this name, in any mode; watched events serve too. Its points are the states just
    /// after it.
    #[must_use]
    pub fn event(name: &str) -> Self {
        Self { cut: Cut::Event { name: name.to_owned(), mode: None }, every: 1 }
    }

    /// The event only where it is one of this mode, which holds before it.
    #[must_use]
    pub fn in_mode(self, mode: &str) -> Self {
        let cut = match self.cut {
            Cut::Event { name, .. } => Cut::Event { name, mode: Some(mode.to_owned()) },
            strobe @ Cut::Strobe(_) => strobe,
        };
        Self { cut, ..self }
    }

    /// Every so many of these instants alone; 0 is taken for 1.
    #[must_use]
    pub fn every(self, count: u32) -> Self {
        Self { every: count.max(1), ..self }
    }

    /// The number of instants of which the last alone counts, and makes a return.
    pub(in crate::affine) fn count(&self) -> u32 {
        self.every
    }

    /// The strobe of an angle that is larger by this, of a section that is a strobe.
    pub(in crate::affine) fn turned(&self, by: f64) -> Option<Self> {
        let Cut::Strobe(angle) = self.cut else { return None };
        Some(Self { cut: Cut::Strobe(angle + by), every: self.every })
    }

    /// The section among the events of a system.
    pub(super) fn resolve(&self, system: &System) -> Result<Resolved, SystemError> {
        let returns = match &self.cut {
            Cut::Strobe(_) if system.forcing.is_none() => {
                let what = format!(
                    "{} has no forcing, and so no strobe: accepted is one of its events, {}",
                    system.name,
                    names(system)
                );
                return Err(error(what));
            }
            // Written so that a NaN is refused.
            Cut::Strobe(angle) if !(-MAX_ANGLE..=MAX_ANGLE).contains(angle) => {
                let what = format!("the angle {angle} is not accepted: -1e15 to 1e15 is");
                return Err(error(what));
            }
            Cut::Strobe(angle) => Returning::Strobe(*angle),
            Cut::Event { name, mode } => Returning::Events(events(system, name, mode.as_deref())?),
        };
        Ok(Resolved { returns, every: self.every })
    }
}

impl Default for Section {
    /// The strobe of the forcing at the angle 0.
    fn default() -> Self {
        Self::strobe(0.0)
    }
}

impl fmt::Display for Section {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.cut {
            Cut::Strobe(angle) => write!(f, "strobe:{angle}"),
            Cut::Event { name, mode: None } => f.write_str(name),
            Cut::Event { name, mode: Some(mode) } => write!(f, "{name}@{mode}"),
        }
    }
}

/// A section whose events are known by their indices.
#[derive(Clone, Debug)]
pub(super) struct Resolved {
    pub returns: Returning,
    pub every: u32,
}

/// The instants at which a motion returns.
#[derive(Clone, Debug)]
pub(super) enum Returning {
    Strobe(f64),
    Events(Vec<Guard>),
}

/// An event by its mode and its index, among those of `until` or of `watch`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Guard {
    /// The index of the mode that holds the event.
    pub mode: usize,
    /// The index of the event among its kind.
    pub index: usize,
    /// Whether the event is only watched.
    pub is_watched: bool,
}

impl Guard {
    /// The guard of an event of a run; none of a start or an ending.
    pub(super) fn new<T>(what: &What<T>) -> Option<Self> {
        match *what {
            What::Until(mode, index) => Some(Self { mode, index, is_watched: false }),
            What::Watch(mode, index) => Some(Self { mode, index, is_watched: true }),
            What::Start | What::Limit(..) | What::End(_) => None,
        }
    }

    /// Takes away the impacts that have accumulated but for the first of them, with the turns after
    /// it, where an event of a run is their limit, from the events before it: their number changes
    /// with every digit.
    pub(super) fn join_accumulated<T, E>(
        what: &What<T>,
        events: &mut Vec<E>,
        guard: impl Fn(&E) -> Self,
    ) {
        let What::Limit(mode, index) = *what else { return };
        let own = Self { mode, index, is_watched: false };
        let other = events.iter().rev().map(&guard).nth(1).filter(|it| *it != own);
        let is_of_cycle = |(n, it): (usize, &E)| match other {
            Some(turn) if n % 2 == 1 => guard(it) == turn,
            _ => guard(it) == own,
        };
        let count = events.iter().rev().enumerate().take_while(|it| is_of_cycle(*it)).count();
        let begin = events.len() - count;
        let first = events[begin..].iter().position(|it| guard(it) == own).unwrap_or(0);
        events.truncate(begin + first + 1);
    }

    /// The index among all guards of its mode: those of `until`, then those of `watch`.
    pub(super) fn place_among_all(&self, system: &System) -> usize {
        let before = if self.is_watched { system.modes[self.mode].until.len() } else { 0 };
        before + self.index
    }

    /// Whether the guard is zero after its event too, so that the section's points lie on it: a
    /// reset may leave them anywhere, such as that of a clock.
    pub(super) fn is_kept_by_its_event(&self, system: &System) -> bool {
        self.is_watched || system.modes[self.mode].until[self.index].keeps_guard_zero()
    }

    /// Whether the event is one where its guard changes at this rate.
    pub(super) fn fires_at_rate(&self, system: &System, rate: f64) -> bool {
        let watch = self.is_watched.then(|| &system.modes[self.mode].watch[self.index]);
        match watch.map_or(Direction::Rising, |it| it.direction) {
            Direction::Rising => rate > 0.0,
            Direction::Falling => rate < 0.0,
            Direction::Both => rate != 0.0,
        }
    }

    /// The names of the event and of its mode, as `impact@free`.
    #[must_use]
    pub fn name(&self, system: &System) -> String {
        let mode = &system.modes[self.mode];
        let event = if self.is_watched {
            &mode.watch[self.index].name
        } else {
            &mode.until[self.index].name
        };
        format!("{event}@{}", mode.name)
    }
}

/// All events of a system, mode by mode, with their names.
fn all(system: &System) -> impl Iterator<Item = (Guard, &str)> {
    system.modes.iter().enumerate().flat_map(|(mode, own)| {
        let guard = move |index, is_watched| Guard { mode, index, is_watched };
        let until = own.until.iter().map(|it| it.name.as_str()).enumerate();
        let watch = own.watch.iter().map(|it| it.name.as_str()).enumerate();
        let until = until.map(move |(index, name)| (guard(index, false), name));
        until.chain(watch.map(move |(index, name)| (guard(index, true), name)))
    })
}

fn events(system: &System, name: &str, mode: Option<&str>) -> Result<Vec<Guard>, SystemError> {
    let there: Vec<Guard> = all(system).filter(|it| it.1 == name).map(|it| it.0).collect();
    if there.is_empty() {
        let (own, accepted) = (&system.name, names(system));
        return Err(error(format!("{name} is no event of {own}: accepted are {accepted}")));
    }
    let Some(mode) = mode else { return Ok(there) };
    let is_own = |it: &&Guard| system.modes[it.mode].name == mode;
    let own: Vec<Guard> = there.iter().filter(is_own).copied().collect();
    if own.is_empty() {
        let modes: Vec<_> = there.iter().map(|it| it.name(system)).collect();
        let accepted = modes.join(", ");
        return Err(error(format!("{name}@{mode} is no event: accepted are {accepted}")));
    }
    Ok(own)
}

/// The names of all events, each once.
fn names(system: &System) -> String {
    let mut names: Vec<&str> = Vec::new();
    for (_, name) in all(system) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    if names.is_empty() { "none, because it has none".to_owned() } else { names.join(", ") }
}

fn error(what: String) -> SystemError {
    SystemError::Name { item: "section".to_owned(), what }
}
