//! From the tables of a mode to its equations, events and successors.

use super::names::Names;
use crate::affine::model::dual::Dual;
use crate::affine::model::error::SystemError;
use crate::affine::model::expression::expression;
use crate::affine::model::file::{
    LimitEntry, LimitTable, ModeTable, NextEntry, NextTable, StartChoice, StartTable, SystemFile,
    UntilTable, WatchTable,
};
use crate::affine::model::form::Form;
use crate::affine::model::naming::{check_event, unknown_mode};
use crate::affine::model::rational::Rational;
use crate::affine::model::scalar::{Assignment, Condition, Scalar};
use crate::affine::model::system::{
    Direction, Limit, MAX_COUNT, Mode, Row, Successor, Until, Watch,
};
use crate::unknown_name::UnknownName;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use toml::Spanned;

/// A reader of the tables of modes; the names that expressions may use are passed separately.
pub(super) struct ModeReader<'a> {
    pub(super) file: &'a SystemFile,
    pub(super) places: &'a BTreeMap<String, usize>,
    /// The frequency, or its derivative, of a forced system.
    pub(super) omega: Option<&'a Rational>,
}

impl ModeReader<'_> {
    pub(super) fn mode(
        &self,
        names: &mut Names,
        table: &ModeTable,
        here: usize,
    ) -> Result<Mode, SystemError> {
        let mut matrix = self.rates(names, table)?;
        let dimension = matrix.len() + if self.omega.is_some() { 3 } else { 1 };
        if let Some(omega) = self.omega {
            let cos = dimension - 3;
            let mut rates = [vec![Rational::ZERO; dimension], vec![Rational::ZERO; dimension]];
            rates[0][cos + 1] = -omega.clone();
            rates[1][cos] = omega.clone();
            matrix.extend(rates);
        }
        matrix.push(vec![Rational::ZERO; dimension]);
        let count = table.until.len() + table.watch.len();
        if count > MAX_COUNT {
            let what =
                format!("{count} events are too many: up to {MAX_COUNT} a mode are accepted");
            return Err(self.file.error(&table.name.span(), &what));
        }
        self.check_events(table)?;
        let until = table.until.iter().map(|it| self.until(names, it, here));
        let until = until.collect::<Result<_, _>>()?;
        let watch = table.watch.iter().map(|it| self.watch(names, it)).collect::<Result<_, _>>()?;
        Ok(Mode { name: table.name.get_ref().clone(), matrix, until, watch })
    }

    fn check_events(&self, table: &ModeTable) -> Result<(), SystemError> {
        let until = table.until.iter().map(|it| &it.name);
        let mut seen = BTreeSet::new();
        for name in until.chain(table.watch.iter().map(|it| &it.name)) {
            let refuse = |what: String| self.file.error(&name.span(), &what);
            check_event(name.get_ref()).map_err(refuse)?;
            if !seen.insert(name.get_ref()) {
                let what = format!("the event {:?} is there twice in its mode", name.get_ref());
                return Err(refuse(what));
            }
        }
        Ok(())
    }

    /// The rows of the mode's matrix M that belong to the states.
    fn rates(&self, names: &mut Names, table: &ModeTable) -> Result<Vec<Row>, SystemError> {
        let mut rates = BTreeMap::new();
        for equation in table.equations.get_ref() {
            let (state, rate) = self.assignment(names, equation, true)?;
            if rates.insert(state, rate).is_some() {
                let what = format!("{}' is given twice", names.states[state]);
                return Err(self.file.error(&equation.span(), &what));
            }
        }
        match (0..names.states.len()).find(|state| !rates.contains_key(state)) {
            None => Ok(rates.into_values().collect()),
            Some(state) => {
                let what = format!("an equation `{}' = ...` is missing", names.states[state]);
                Err(self.file.error(&table.equations.span(), &what))
            }
        }
    }

    /// The index of the state that an equation or an assignment is for, and the row.
    fn assignment(
        &self,
        names: &mut Names,
        assignment: &Spanned<Assignment>,
        primed: bool,
    ) -> Result<(usize, Row), SystemError> {
        let read = match assignment.get_ref() {
            Assignment::Text(text) => read_assignment(names, text, primed),
            Assignment::To { state, value } => state_index(names, state)
                .ok_or_else(|| {
                    format!("{state:?} is no state: accepted is one of {}", names.states.join(", "))
                })
                .and_then(|index| Ok((index, names.affine(value)?))),
        };
        let read = read.and_then(|(state, form)| Ok((state, self.row(names, form)?)));
        read.map_err(|what| self.file.error(&assignment.span(), &what))
    }

    fn row(&self, names: &Names, form: Form) -> Result<Row, String> {
        form.check_range()?;
        let states = form.0.len() - 3;
        let forced = self.omega.is_some();
        let kept = |(index, it)| {
            (forced || index < states || index == states + 2).then(|| names.value_or_rate(it))
        };
        Ok(form.0.into_iter().enumerate().filter_map(kept).collect())
    }

    /// The row that is positive where a condition holds.
    fn condition(&self, names: &mut Names, it: &Spanned<Condition>) -> Result<Row, SystemError> {
        let form = names.condition(it.get_ref());
        let row = form.and_then(|form| self.row(names, form));
        row.map_err(|what| self.file.error(&it.span(), &what))
    }

    /// The row of an event's guard. One whose factors are 0 by the parameters is accepted, so that
    /// parameters may be scanned over 0.
    fn guard(&self, names: &mut Names, it: &Spanned<Condition>) -> Result<Row, SystemError> {
        let row = self.condition(names, it)?;
        match &it.get_ref().0 {
            Scalar::Text(text) if !names.may_change(text) => {
                let what =
                    "the guard never changes: accepted is one with a state, cos or sin in it";
                Err(self.file.error(&it.span(), what))
            }
            _ => Ok(row),
        }
    }

    fn until(
        &self,
        names: &mut Names,
        table: &UntilTable,
        here: usize,
    ) -> Result<Until, SystemError> {
        let guard = self.guard(names, &table.guard)?;
        let reset = self.reset(names, &table.reset, guard.len())?;
        let next = match &table.next {
            Some(next) => self.next(names, next)?,
            None => vec![Successor { when: None, mode: here }],
        };
        let limit = table.accumulates_to.as_ref();
        let limit = limit.map(|it| self.limit(names, it, guard.len())).transpose()?;
        let name = table.name.get_ref().clone();
        Ok(Until { name, guard, reset, next, accumulates_to: limit })
    }

    /// The matrix of a reset: states that are not assigned stay.
    fn reset(
        &self,
        names: &mut Names,
        assignments: &[Spanned<Assignment>],
        dimension: usize,
    ) -> Result<Vec<Row>, SystemError> {
        // What a reset leaves as it is does so whatever the parameters are.
        let one = names.value_or_rate(Dual::ONE);
        let unit = |index| {
            let mut row = vec![Rational::ZERO; dimension];
            row[index] = one.clone();
            row
        };
        let mut reset: Vec<Row> = (0..dimension).map(unit).collect();
        let mut assigned = BTreeSet::new();
        for text in assignments {
            let (state, row) = self.assignment(names, text, false)?;
            if !assigned.insert(state) {
                let what = format!("{} is assigned twice", names.states[state]);
                return Err(self.file.error(&text.span(), &what));
            }
            reset[state] = row;
        }
        Ok(reset)
    }

    /// The passage from the limit at which an event accumulates.
    fn limit(
        &self,
        names: &mut Names,
        entry: &Spanned<LimitEntry>,
        dimension: usize,
    ) -> Result<Limit, SystemError> {
        let (assignments, next) = match entry.get_ref() {
            LimitEntry::Mode(mode) => (&[][..], self.alone(mode, &entry.span())?),
            LimitEntry::Table(LimitTable { reset, next }) => (&reset[..], self.next(names, next)?),
        };
        Ok(Limit { reset: self.reset(names, assignments, dimension)?, next })
    }

    /// The index of the mode of a name.
    fn place(&self, mode: &str, span: &Range<usize>) -> Result<usize, SystemError> {
        let unknown = || unknown_mode(mode, self.places.keys().map(String::as_str));
        self.places.get(mode).copied().ok_or_else(|| self.file.error(span, &unknown()))
    }

    /// A mode that follows without a condition.
    fn alone(&self, mode: &str, span: &Range<usize>) -> Result<Vec<Successor>, SystemError> {
        Ok(vec![Successor { when: None, mode: self.place(mode, span)? }])
    }

    fn next(
        &self,
        names: &mut Names,
        next: &Spanned<NextEntry>,
    ) -> Result<Vec<Successor>, SystemError> {
        match next.get_ref() {
            NextEntry::Mode(mode) => self.alone(mode, &next.span()),
            NextEntry::Modes(list) => self.successors(names, list, &next.span()),
        }
    }

    fn successors(
        &self,
        names: &mut Names,
        next: &[NextTable],
        span: &Range<usize>,
    ) -> Result<Vec<Successor>, SystemError> {
        let refuse = |what: &str| Err(self.file.error(span, what));
        let count = next.len();
        if count == 0 || count > MAX_COUNT {
            return refuse(&format!("{count} successors are not accepted: 1 to {MAX_COUNT} are"));
        }
        let mut successors = Vec::with_capacity(count);
        for (n, entry) in next.iter().enumerate() {
            if entry.when.is_some() == (n + 1 == count) {
                return refuse(
                    "every successor but the last has a condition, and the last has none",
                );
            }
            let mode = self.place(entry.mode.get_ref(), &entry.mode.span())?;
            let when = entry.when.as_ref().map(|it| self.condition(names, it)).transpose()?;
            successors.push(Successor { when, mode });
        }
        Ok(successors)
    }

    /// The modes that a start lists, each with its condition.
    pub(super) fn start_modes(
        &self,
        names: &mut Names,
        table: &StartTable,
    ) -> Result<Vec<Successor>, SystemError> {
        let count = table.modes.len();
        if count > MAX_COUNT {
            let what = format!("{count} modes of a start are too many: 1 to {MAX_COUNT} are");
            return Err(SystemError::at(&table.place, &format!("{what} accepted")));
        }
        let mut choices = Vec::with_capacity(count);
        for (n, StartChoice { when, mode: (mode, place) }) in table.modes.iter().enumerate() {
            if when.is_some() == (n + 1 == count) {
                let what = "every mode of a start but the last has a condition, and the last has \
                            none";
                return Err(SystemError::at(place, what));
            }
            let Some(index) = self.places.get(mode) else {
                let what = unknown_mode(mode, self.places.keys().map(String::as_str));
                return Err(SystemError::at(place, &what));
            };
            let row = |(condition, place): &(Condition, String)| {
                let form = names.condition(condition);
                let row = form.and_then(|form| self.row(names, form));
                row.map_err(|what| SystemError::at(place, &what))
            };
            let when = when.as_ref().map(row).transpose()?;
            choices.push(Successor { when, mode: *index });
        }
        Ok(choices)
    }

    fn watch(&self, names: &mut Names, table: &WatchTable) -> Result<Watch, SystemError> {
        let read = |text: &Spanned<String>| {
            let direction = text.get_ref().parse();
            direction.map_err(|it: UnknownName| self.file.error(&text.span(), &it.to_string()))
        };
        let direction = table.direction.as_ref().map_or(Ok(Direction::Rising), read)?;
        let guard = self.guard(names, &table.guard)?;
        Ok(Watch { name: table.name.get_ref().clone(), guard, direction })
    }
}

/// The index of the state of a name.
fn state_index(names: &Names, name: &str) -> Option<usize> {
    names.states.iter().position(|it| it == name)
}

/// Reads `x' = ...`, or without the prime `x = ...`: the state's index, and the right side.
fn read_assignment(names: &mut Names, text: &str, primed: bool) -> Result<(usize, Form), String> {
    let prime = if primed { "'" } else { "" };
    let shape = format!("`x{prime} = ...` with a state x is accepted");
    let Some((left, right)) = text.split_once('=') else { return Err(shape) };
    let left = left.trim();
    let name = if primed { left.strip_suffix('\'').map(str::trim_end) } else { Some(left) };
    let state = name.and_then(|name| state_index(names, name));
    let state = state.ok_or_else(|| format!("{left:?}: {shape}"))?;
    Ok((state, expression(right, names)?))
}
