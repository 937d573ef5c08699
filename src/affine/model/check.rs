//! Whether a system that was made or changed by hand is one: all that a file's reader sees to.

use super::error::SystemError;
use super::form;
use super::naming::{check_event, check_kebab, check_symbol};
use super::rational::Rational;
use super::system::{
    LARGEST_DIMENSION, Limit, MAX_COUNT, Mode, Row, Successor, System, TROUBLE, Until, Watch,
    is_unit,
};
use std::collections::BTreeSet;

impl System {
    /// Refuses a system that its fields do not describe: with rows of the wrong length, without the
    /// rows of its forcing, with modes that are not there, and whatever else a run would stumble
    /// over. A system that was read or built and not changed since is accepted.
    ///
    /// # Errors
    /// The first mistake, with its item and what is accepted.
    ///
    /// ```
    /// # let mut system = percuss::System::parse("ball", r#"
    /// #     schema = 1
    /// #     name = "ball"
    /// #     states = ["x", "v"]
    /// #     [[mode]]
    /// #     name = "flight"
    /// #     equations = ["x' = v", "v' = -10"]
    /// #     [[mode.until]]
    /// #     name = "impact"
    /// #     guard = "x < 0"
    /// #     reset = ["v = -v/2"]
    /// # "#)?;
    /// assert_eq!(system.check(), Ok(()));
    /// system.modes[0].until[0].next[0].mode = 7;
    /// let error = system.check().unwrap_err();
    /// assert_eq!(
    ///     error.to_string(),
    ///     "mode \"flight\", until \"impact\", successor 1: there is no mode 7: accepted are \
    ///      indices below 1"
    /// );
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    pub fn check(&self) -> Result<(), SystemError> {
        self.check_names()?;
        self.check_units()?;
        let mut seen = BTreeSet::new();
        for mode in &self.modes {
            let own = ModeCheck { system: self, item: format!("mode {:?}", mode.name) };
            own.name(&mode.name, seen.insert(&mode.name), check_kebab)?;
            own.mode(mode)?;
        }
        self.check_start_modes()?;
        self.check_drift()?;
        self.start.as_ref().map_or(Ok(()), |it| self.check_start(it))
    }

    fn check_start_modes(&self) -> Result<(), SystemError> {
        let choices = &self.start_modes;
        if choices.is_empty() {
            return Ok(());
        }
        ModeCheck { system: self, item: "start".to_owned() }.choices("modes", "mode", choices)
    }

    fn check_names(&self) -> Result<(), SystemError> {
        let refuse = |what| SystemError::Name { item: "system".to_owned(), what };
        check_kebab(&self.name).map_err(refuse)?;
        if let Some(kind) = self.trouble.iter().find(|it| !TROUBLE.contains(&it.as_str())) {
            let what = format!("{kind:?} is not accepted: any of {}", TROUBLE.join(", "));
            return Err(SystemError::Name { item: "trouble".to_owned(), what });
        }
        let most = LARGEST_DIMENSION - (self.dimension() - self.states.len());
        count("states", self.states.len(), 1, most)?;
        let mut seen = BTreeSet::new();
        for name in &self.states {
            let refuse = |what| SystemError::Name { item: format!("state {name:?}"), what };
            check_symbol(name, true).map_err(refuse)?;
            if !seen.insert(name) {
                return Err(refuse("the state is there twice".to_owned()));
            }
        }
        count("modes", self.modes.len(), 1, MAX_COUNT)
    }

    fn check_units(&self) -> Result<(), SystemError> {
        length("scales", self.scales.len(), self.states.len())?;
        let scales = self.scales.iter().map(|it| ("scales", it));
        for (item, number) in scales.chain([("time_scale", &self.time_scale)]) {
            if !(number.is_finite() && *number > 0.0) {
                let what = format!("{number:?} is not accepted: a positive number is");
                return Err(SystemError::Number { item: item.to_owned(), what });
            }
        }
        let Some(forcing) = &self.forcing else { return Ok(()) };
        let refuse = |what: String| SystemError::Number { item: "forcing".to_owned(), what };
        if forcing.omega.is_zero() {
            return Err(refuse("omega is not accepted as 0".to_owned()));
        }
        check_numbers(&[forcing.omega.clone(), forcing.phi.clone()]).map_err(refuse)
    }
}

/// A check of a mode and of what is in it.
struct ModeCheck<'a> {
    system: &'a System,
    /// The mode, or the event, that is being checked.
    item: String,
}

impl ModeCheck<'_> {
    fn within(&self, item: &str) -> Self {
        Self { system: self.system, item: format!("{}, {item}", self.item) }
    }

    fn name(
        &self,
        name: &str,
        is_new: bool,
        check: impl Fn(&str) -> Result<(), String>,
    ) -> Result<(), SystemError> {
        let refuse = |what| SystemError::Name { item: self.item.clone(), what };
        check(name).map_err(refuse)?;
        if is_new { Ok(()) } else { Err(refuse("it is there twice".to_owned())) }
    }

    fn mode(&self, mode: &Mode) -> Result<(), SystemError> {
        let dimension = self.system.dimension();
        self.rows("matrix", &mode.matrix)?;
        if !self.keeps_clock(mode) {
            return Err(SystemError::Clock { item: self.item.clone() });
        }
        if !mode.matrix[dimension - 1].iter().all(Rational::is_zero) {
            return Err(SystemError::LastRow { item: self.item.clone() });
        }
        let events = mode.until.len() + mode.watch.len();
        count(&format!("{}, events", self.item), events, 0, MAX_COUNT)?;
        let mut seen = BTreeSet::new();
        for until in &mode.until {
            let own = self.within(&format!("until {:?}", until.name));
            own.name(&until.name, seen.insert(&until.name), check_event)?;
            own.until(until)?;
        }
        for Watch { name, guard, .. } in &mode.watch {
            let own = self.within(&format!("watch {name:?}"));
            own.name(name, seen.insert(name), check_event)?;
            own.row("guard", guard)?;
        }
        Ok(())
    }

    /// Whether the matrix of a forced system turns cos theta and sin theta by omega.
    fn keeps_clock(&self, mode: &Mode) -> bool {
        let Some(forcing) = &self.system.forcing else { return true };
        let cos = self.system.states.len();
        let is = |row: usize, column: usize, rate: &Rational| {
            let entry = |(n, it): (usize, &Rational)| {
                if n == column { it == rate } else { it.is_zero() }
            };
            mode.matrix[row].iter().enumerate().all(entry)
        };
        is(cos, cos + 1, &-&forcing.omega) && is(cos + 1, cos, &forcing.omega)
    }

    fn until(&self, until: &Until) -> Result<(), SystemError> {
        self.row("guard", &until.guard)?;
        self.reset(&until.reset)?;
        self.choices("successors", "successor", &until.next)?;
        let Some(Limit { reset, next }) = &until.accumulates_to else { return Ok(()) };
        let own = self.within("accumulates_to");
        own.reset(reset)?;
        own.choices("successors", "successor", next)
    }

    /// The matrix of a reset, which leaves cos theta, sin theta and 1 as they are.
    fn reset(&self, reset: &[Row]) -> Result<(), SystemError> {
        self.rows("reset", reset)?;
        let states = self.system.states.len();
        let names = if self.system.forcing.is_some() { &["cos", "sin", "1"][..] } else { &["1"] };
        for (n, entry) in names.iter().enumerate() {
            if !is_unit(&reset[states + n], states + n) {
                return Err(SystemError::Reset { item: self.item.clone(), entry });
            }
        }
        Ok(())
    }

    /// A list of modes, of which the first follows whose condition holds.
    fn choices(&self, all: &str, one: &str, choices: &[Successor]) -> Result<(), SystemError> {
        count(&format!("{}, {all}", self.item), choices.len(), 1, MAX_COUNT)?;
        if (1..).zip(choices).any(|(n, it)| it.when.is_some() == (n == choices.len())) {
            return Err(SystemError::Successors { item: self.item.clone() });
        }
        let check = |(n, it)| self.within(&format!("{one} {n}")).successor(it);
        (1..).zip(choices).try_for_each(check)
    }

    fn successor(&self, successor: &Successor) -> Result<(), SystemError> {
        let (index, modes) = (successor.mode, self.system.modes.len());
        if index >= modes {
            return Err(SystemError::UnknownMode { item: self.item.clone(), index, modes });
        }
        successor.when.as_ref().map_or(Ok(()), |it| self.row("condition", it))
    }

    /// The rows of a matrix.
    fn rows(&self, name: &str, rows: &[Row]) -> Result<(), SystemError> {
        length(&format!("{}, {name}", self.item), rows.len(), self.system.dimension())?;
        (1..).zip(rows).try_for_each(|(n, row)| self.row(&format!("row {n} of the {name}"), row))
    }

    fn row(&self, name: &str, row: &Row) -> Result<(), SystemError> {
        let item = || format!("{}, {name}", self.item);
        if row.len() != self.system.dimension() {
            return length(&item(), row.len(), self.system.dimension());
        }
        check_numbers(row).map_err(|what| SystemError::Number { item: item(), what })
    }
}

/// Refuses coefficients that are too long, too large or too small.
fn check_numbers(numbers: &[Rational]) -> Result<(), String> {
    numbers.iter().try_for_each(form::check_size)?;
    form::check_range(numbers.iter())
}

fn length(item: &str, found: usize, accepted: usize) -> Result<(), SystemError> {
    if found == accepted {
        return Ok(());
    }
    Err(SystemError::Length { item: item.to_owned(), found, accepted })
}

fn count(item: &str, found: usize, least: usize, most: usize) -> Result<(), SystemError> {
    if (least..=most).contains(&found) {
        return Ok(());
    }
    Err(SystemError::Count { item: item.to_owned(), found, least, most })
}
