//! The starts of a system's runs.

use super::error::SystemError;
use super::naming::unknown_mode;
use super::rational::Rational;
use super::system::{StartPoint, StartRow, System};

impl System {
    /// The start of the system.
    ///
    /// # Errors
    /// A system that has none.
    pub fn start(&self) -> Result<&StartPoint, SystemError> {
        self.start.as_ref().ok_or_else(|| SystemError::NoStart { system: self.name.clone() })
    }

    /// The states that hang on others, each after those, but for those that are held.
    fn dependent_states(&self, held: &[usize]) -> impl Iterator<Item = &StartRow> {
        self.start_rows.iter().filter(|it| !held.contains(&it.state))
    }

    /// Sets the states of a start that hang on others, but for those that are held.
    pub(in crate::affine) fn follow_start(&self, start: &mut StartPoint, held: &[usize]) {
        let states = self.states.len();
        for StartRow { state, row } in self.dependent_states(held) {
            let Some((others, own)) = row.split_at_checked(states) else { continue };
            let mut entry = [0, 1, 2].map(|n| own.get(n).cloned().unwrap_or_default());
            for (factor, other) in others.iter().zip(&start.state).filter(|it| !it.0.is_zero()) {
                entry.iter_mut().zip(other).for_each(|(sum, number)| *sum += factor * number);
            }
            if let Some(place) = start.state.get_mut(*state) {
                *place = entry;
            }
        }
    }

    /// Whether the states of a start that hang on others, but for those that are held, are as the
    /// system's own start has them.
    pub(in crate::affine) fn follows_start(&self, start: &StartPoint, held: &[usize]) -> bool {
        let mut own = start.clone();
        self.follow_start(&mut own, held);
        own == *start
    }

    /// The changes of all states of a start where one of some that are held changes alone: those
    /// that hang on it change with it, where they [follow](Self::follows_start).
    pub(in crate::affine) fn start_changes(
        &self,
        start: &StartPoint,
        of: usize,
        held: &[usize],
    ) -> Vec<Rational> {
        let unit = |n: usize| if n == of { Rational::ONE } else { Rational::ZERO };
        let mut changes: Vec<Rational> = (0..self.states.len()).map(unit).collect();
        if self.follows_start(start, held) {
            for StartRow { state, row } in self.dependent_states(held) {
                let terms = row.iter().zip(&changes).filter(|(factor, _)| !factor.is_zero());
                let sum = terms.map(|(factor, change)| factor * change);
                let sum = sum.fold(Rational::ZERO, |sum, term| sum + term);
                if let Some(change) = changes.get_mut(*state) {
                    *change = sum;
                }
            }
        }
        changes
    }

    /// Refuses a start in no mode, or with more or fewer states than the system has.
    pub(in crate::affine) fn check_start(&self, start: &StartPoint) -> Result<(), SystemError> {
        let (index, modes) = (start.mode, self.modes.len());
        if index >= modes {
            return Err(SystemError::UnknownMode { item: "start".to_owned(), index, modes });
        }
        self.check_states("start, state", start.state.len())
    }

    /// The start in a mode at a time, with the value of each state in the order of
    /// [`System::states`].
    ///
    /// ```
    /// use percuss::{System, gallery};
    ///
    /// let ball = System::from_toml(gallery::BOUNCING_BALL)?;
    /// let thrown = ball.start_at("flight", 2.0, &[0.5, 1.0])?;
    /// assert_eq!(thrown.time.to_f64(), 2.0);
    /// let error = ball.start_at("flight", 0.0, &[0.5]).unwrap_err();
    /// assert!(error.to_string().contains("2"), "{error}");
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    ///
    /// # Errors
    /// An unknown mode, a number that is not finite, and another number of states.
    pub fn start_at(
        &self,
        mode: &str,
        time: f64,
        states: &[f64],
    ) -> Result<StartPoint, SystemError> {
        let Some(index) = self.mode(mode) else {
            let what = unknown_mode(mode, self.modes.iter().map(|it| it.name.as_str()));
            return Err(SystemError::Name { item: "start".to_owned(), what });
        };
        self.start_in(index, time, states)
    }

    /// The start in a mode of an index at a time, with the value of each state.
    pub(super) fn start_in(
        &self,
        mode: usize,
        time: f64,
        states: &[f64],
    ) -> Result<StartPoint, SystemError> {
        let exact = |item: &str, number: f64| {
            Rational::try_from(number).map_err(|_| SystemError::Number {
                item: format!("start, {item}"),
                what: format!("{number} is not accepted: a finite number is"),
            })
        };
        self.check_states("start, states", states.len())?;
        let state = self
            .states
            .iter()
            .zip(states)
            .map(|(name, value)| Ok([Rational::ZERO, Rational::ZERO, exact(name, *value)?]));
        let state = state.collect::<Result<_, SystemError>>()?;
        Ok(StartPoint { mode, time: exact("time", time)?, state })
    }

    /// Refuses a number of states that is not the system's.
    fn check_states(&self, item: &str, found: usize) -> Result<(), SystemError> {
        let accepted = self.states.len();
        if found == accepted {
            return Ok(());
        }
        Err(SystemError::Length { item: item.to_owned(), found, accepted })
    }
}
