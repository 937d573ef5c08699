//! The starts of a system's runs.

use super::error::SystemError;
use super::naming::unknown_mode;
use super::rational::Rational;
use super::system::{StartPoint, System};

impl System {
    /// The start of the system.
    ///
    /// # Errors
    /// A system that has none.
    pub fn start(&self) -> Result<&StartPoint, SystemError> {
        self.start.as_ref().ok_or_else(|| SystemError::NoStart { system: self.name.clone() })
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
