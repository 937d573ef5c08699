//! States that only add up what the others do, such as a distance that is gone: a motion from
//! anywhere along them is the same motion.

use super::error::SystemError;
use super::rational::Rational;
use super::system::{Mode, Row, Successor, System};
use std::collections::BTreeSet;

/// Where an expression of a system is that no drift may be in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// The equation of a state in a mode.
    Equation { mode: usize, state: usize },
    /// The guard of an `until` or, after these, of a `watch` of a mode.
    Guard { mode: usize, event: usize },
    /// The reset of a state by an `until`.
    Reset { mode: usize, until: usize, state: usize },
    /// The condition of a successor of an `until`.
    When { mode: usize, until: usize, successor: usize },
    /// The reset or a condition of the limit at which an `until` accumulates.
    Limit { mode: usize, until: usize },
    /// The condition of a mode of the start.
    Start { choice: usize },
}

impl System {
    /// The indices of the states on which nothing depends, not even they themselves: no rate, no
    /// guard, no condition and no reset but the one that keeps them or adds to them. Orbits close
    /// without these states. Where the system [says](Self::drift) which are drifts, no others are.
    ///
    /// ```
    /// use percuss::System;
    ///
    /// let system = System::from_toml(r#"
    ///     schema = 1
    ///     name = "walk"
    ///     states = ["gone", "x"]
    ///     [[mode]]
    ///     name = "going"
    ///     equations = ["gone' = x", "x' = 1 - x"]
    /// "#)?;
    /// assert_eq!(system.drifts(), [0]);
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    #[must_use]
    pub fn drifts(&self) -> Vec<usize> {
        let found = || (0..self.states.len()).filter(|n| self.dependent_on(*n).is_none()).collect();
        self.drift.clone().unwrap_or_else(found)
    }

    /// The first expression that depends on where this state is, or a reset of it that does not add
    /// to it.
    pub(super) fn dependent_on(&self, n: usize) -> Option<Place> {
        let start = choice_on(&self.start_modes, n).map(|choice| Place::Start { choice });
        let modes = self.modes.iter().enumerate();
        modes.filter_map(|(mode, it)| it.dependent_on(n, mode, self.states.len())).next().or(start)
    }

    /// Refuses what is said to be a drift and is none.
    pub(super) fn check_drift(&self) -> Result<(), SystemError> {
        let refuse = |what| Err(SystemError::Name { item: "drift".to_owned(), what });
        let mut seen = BTreeSet::new();
        for n in self.drift.iter().flatten() {
            let Some(name) = self.states.get(*n) else {
                let states = self.states.len();
                return refuse(format!(
                    "there is no state {n}: accepted are indices below {states}"
                ));
            };
            if !seen.insert(n) {
                return refuse(format!("{name} is there twice"));
            }
            if let Some(place) = self.dependent_on(*n) {
                return refuse(self.no_drift(*n, place, ""));
            }
        }
        Ok(())
    }

    /// The reason for which a state is no drift, with the expression as it is written.
    pub(super) fn no_drift(&self, n: usize, place: Place, written: &str) -> String {
        let (name, what) = (&self.states[n], self.place(place, written));
        match place {
            Place::Reset { state, .. } if state == n => format!(
                "{name} is no drift: {what} does not add to it: accepted is {name} = {name} and \
                 what does not depend on {name}"
            ),
            _ => format!("{name} is no drift: {what} depends on it"),
        }
    }

    /// An expression by its place and as it is written.
    fn place(&self, place: Place, written: &str) -> String {
        let mode = |mode: usize| format!("mode {:?}", self.modes[mode].name);
        let until =
            |at: usize, n: usize| format!("{}, until {:?}", mode(at), self.modes[at].until[n].name);
        let state = |n: usize| format!(" of {}", self.states[n]);
        let (item, which) = match place {
            Place::Equation { mode: at, state: n } => (format!("{}, equation", mode(at)), state(n)),
            Place::Guard { mode: at, event } => {
                let own = &self.modes[at];
                let item = match event.checked_sub(own.until.len()) {
                    Some(n) => format!("{}, watch {:?}, guard", mode(at), own.watch[n].name),
                    None => format!("{}, guard", until(at, event)),
                };
                (item, String::new())
            }
            Place::Reset { mode: at, until: event, state: n } => {
                (format!("{}, reset", until(at, event)), state(n))
            }
            Place::When { mode: at, until: event, successor } => {
                (format!("{}, condition", until(at, event)), format!(" {}", successor + 1))
            }
            Place::Limit { mode: at, until: event } => {
                (format!("{}, accumulates_to", until(at, event)), String::new())
            }
            Place::Start { choice } => ("start, condition".to_owned(), format!(" {}", choice + 1)),
        };
        match written.is_empty() {
            true => [item, which].concat(),
            false => format!("{item} `{written}`"),
        }
    }
}

impl Mode {
    /// The place in this mode, which has this index, that depends on where a state is.
    fn dependent_on(&self, n: usize, mode: usize, states: usize) -> Option<Place> {
        let equation = self.matrix.iter().take(states).position(|row| has(row, n));
        let guard = self.guards().position(|it| has(it, n));
        let events = self.until.iter().enumerate();
        let reset = events.clone().find_map(|(until, it)| {
            reset_on(&it.reset, n, states).map(|state| Place::Reset { mode, until, state })
        });
        let when = events.clone().find_map(|(until, it)| {
            choice_on(&it.next, n).map(|successor| Place::When { mode, until, successor })
        });
        let limit = self.until.iter().position(|it| {
            let limit = it.accumulates_to.as_ref();
            limit.is_some_and(|it| {
                reset_on(&it.reset, n, states).is_some() || choice_on(&it.next, n).is_some()
            })
        });
        let equation = equation.map(|state| Place::Equation { mode, state });
        let guard = guard.map(|event| Place::Guard { mode, event });
        let limit = limit.map(|until| Place::Limit { mode, until });
        equation.or(guard).or(reset).or(when).or(limit)
    }
}

/// The state whose reset depends on a state, or does not keep that state itself.
fn reset_on(reset: &[Row], n: usize, states: usize) -> Option<usize> {
    let keeps = |(k, row): (usize, &Row)| match row.get(n).map(Rational::is_one) {
        Some(is_one) if k == n => is_one,
        _ => !has(row, n),
    };
    reset.iter().take(states).enumerate().position(|it| !keeps(it))
}

/// The choice whose condition depends on a state.
fn choice_on(choices: &[Successor], n: usize) -> Option<usize> {
    choices.iter().position(|it| it.when.as_ref().is_some_and(|row| has(row, n)))
}

fn has(row: &Row, n: usize) -> bool {
    row.get(n).is_some_and(|it| !it.is_zero())
}
