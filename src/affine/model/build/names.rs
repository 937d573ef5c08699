//! The values of the names in a file's expressions.

use crate::affine::model::dual::Dual;
use crate::affine::model::error::SystemError;
use crate::affine::model::expression::{Scope, condition, expression};
use crate::affine::model::file::{GivenParameter, SystemFile};
use crate::affine::model::form::Form;
use crate::affine::model::naming::check_symbol;
use crate::affine::model::rational::Rational;
use crate::affine::model::scalar::{Condition, Scalar};
use crate::affine::model::system::Forcing;
use crate::affine::model::tangent::Name;
use std::collections::{BTreeMap, BTreeSet};
use toml::Spanned;

/// The most definitions each of which needs the next one's value: they are read in each other, and
/// the stack of a thread holds four times as many.
const MAX_NESTED_DEFINITIONS: usize = 250;

/// The names that a file's expressions may use, with their values.
pub(super) struct Names<'a> {
    pub(super) file: &'a SystemFile,
    pub(super) states: Vec<String>,
    forced: bool,
    values: BTreeMap<String, Form>,
    /// The `[let]`s that are being read, to see a circle.
    open: Vec<String>,
    /// The kinds of names that the expression being read may use.
    pub(super) accepts: Accepts,
    /// The name by which coefficients are to be differentiated, if they are.
    by: Option<&'a Name>,
}

/// The kinds of names that an expression may use.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Accepts {
    /// States, cos, sin and constants.
    States,
    /// Constants only.
    Constants,
}

impl<'a> Names<'a> {
    pub(super) fn new(file: &'a SystemFile, by: Option<&'a Name>) -> Result<Self, SystemError> {
        let tables = &file.tables;
        if *tables.schema.get_ref() != 1 {
            return Err(file.error(&tables.schema.span(), "the schema that is accepted is 1"));
        }
        let states: Vec<_> =
            tables.states.get_ref().iter().map(|it| it.get_ref().clone()).collect();
        if states.is_empty() {
            return Err(file.error(&tables.states.span(), "at least one state is accepted"));
        }
        let (forced, values) = (tables.forcing.is_some(), BTreeMap::new());
        let open = Vec::new();
        let mut names = Self { file, states, forced, values, open, accepts: Accepts::States, by };
        names.check_names()?;
        for (name, GivenParameter { value, place }) in &file.parameters {
            let number = value.number().ok_or_else(|| {
                let what = "a parameter is a finite number; an expression is given as a definition";
                SystemError::at(place, &format!("{name}: {what}"))
            })?;
            let rate = Name::is_parameter(by, name);
            let number = Dual { value: number, rate };
            names.values.insert(name.clone(), Form::number(names.states.len(), number));
        }
        Ok(names)
    }

    fn check_names(&self) -> Result<(), SystemError> {
        let tables = &self.file.tables;
        let place = |span| self.file.source.place(&span);
        let states = tables.states.get_ref().iter().map(|it| (it.get_ref(), place(it.span())));
        let parameters = self.file.parameters.iter().map(|(name, it)| (name, it.place.clone()));
        let lets = tables.lets.iter().map(|(name, it)| (name, place(it.span())));
        let mut seen = BTreeSet::new();
        for (name, place) in states.chain(parameters).chain(lets) {
            check_symbol(name, self.states.contains(name))
                .map_err(|what| SystemError::at(&place, &what))?;
            if !seen.insert(name) {
                let what = format!(
                    "{name} is given twice; states, parameters and definitions share their names"
                );
                return Err(SystemError::at(&place, &what));
            }
        }
        Ok(())
    }

    /// Reads every `[let]`, used or not.
    pub(super) fn check_lets(&mut self) -> Result<(), SystemError> {
        let file = self.file;
        for (name, text) in &file.tables.lets {
            self.value(name)
                .map_err(|what| file.error(&text.span(), &format!("{name}: {what}")))?;
        }
        Ok(())
    }

    pub(super) fn forcing(&mut self) -> Result<Option<Forcing>, SystemError> {
        let Some(table) = &self.file.tables.forcing else { return Ok(None) };
        let omega = self.constant("omega", &table.omega)?;
        let phi = table.phi.as_ref().map(|it| self.constant("phi", it)).transpose()?;
        let phi = phi.unwrap_or_default();
        if omega.value <= Rational::ZERO {
            return Err(self.file.error(&table.omega.span(), "omega is accepted above 0"));
        }
        for (name, value) in [("omega", &omega), ("phi", &phi)] {
            let form = Form::number(self.states.len(), value.clone());
            self.values.insert(name.to_owned(), form);
        }
        Ok(Some(Forcing { omega: self.value_or_rate(omega), phi: self.value_or_rate(phi) }))
    }

    /// The value of a coefficient, or its derivative where that is what is read.
    pub(super) fn value_or_rate(&self, coefficient: Dual) -> Rational {
        if self.by.is_some() { coefficient.rate } else { coefficient.value }
    }

    /// The derivative of a state's entry at the start, beyond that of its expression.
    pub(super) fn start_rate(&self, state: &str) -> Rational {
        Name::is_start(self.by, state)
    }

    pub(super) fn scales(&mut self) -> Result<Vec<f64>, SystemError> {
        let Some(scales) = &self.file.tables.scales else {
            return Ok(vec![1.0; self.states.len()]);
        };
        if scales.get_ref().len() != self.states.len() {
            let what = format!("scales holds a number a state, {} of them", self.states.len());
            return Err(self.file.error(&scales.span(), &what));
        }
        scales.get_ref().iter().map(|it| self.positive("scales", it)).collect()
    }

    pub(super) fn time_scale(&mut self, forcing: Option<&Forcing>) -> Result<f64, SystemError> {
        match (&self.file.tables.time_scale, forcing) {
            (Some(scale), _) => self.positive("time_scale", scale),
            (None, Some(forcing)) => Ok(1.0 / forcing.omega.to_f64()),
            (None, None) => Ok(1.0),
        }
    }

    fn positive(&mut self, key: &str, scalar: &Spanned<Scalar>) -> Result<f64, SystemError> {
        let value = self.constant(key, scalar)?.value.to_f64();
        if value > 0.0 && value.is_finite() {
            return Ok(value);
        }
        Err(self.file.error(&scalar.span(), &format!("{key}: a positive number is accepted")))
    }

    /// A number, or an expression of parameters.
    fn constant(&mut self, key: &str, scalar: &Spanned<Scalar>) -> Result<Dual, SystemError> {
        let place = self.file.source.place(&scalar.span());
        self.constant_at(key, scalar.get_ref(), &place)
    }

    pub(super) fn constant_at(
        &mut self,
        key: &str,
        scalar: &Scalar,
        place: &str,
    ) -> Result<Dual, SystemError> {
        let before = std::mem::replace(&mut self.accepts, Accepts::Constants);
        let form = self.affine(scalar);
        self.accepts = before;
        let form = form.map_err(|it| SystemError::at(place, &format!("{key}: {it}")))?;
        form.constant().cloned().ok_or_else(|| {
            SystemError::at(place, &format!("{key}: a number or an expression of parameters"))
        })
    }

    pub(super) fn affine(&mut self, scalar: &Scalar) -> Result<Form, String> {
        let form = match scalar {
            Scalar::Text(text) => expression(text, self)?,
            Scalar::Row(entries) => self.row(entries)?,
            other => other
                .number()
                .map(|number| Form::number(self.states.len(), Dual::fixed(number)))
                .ok_or_else(|| "a finite number is accepted".to_owned())?,
        };
        form.check_range()?;
        Ok(form)
    }

    /// The form that is positive where a condition holds.
    pub(super) fn condition(&mut self, Condition(scalar): &Condition) -> Result<Form, String> {
        match scalar {
            Scalar::Text(text) => condition(text, self),
            Scalar::Row(_) => self.affine(scalar),
            _ => Err("a number is no condition: `left > right`, `left < right` or a row of \
                      factors is accepted"
                .to_owned()),
        }
    }

    /// Whether a text names a state, cos or sin, or a definition that does; it is constant
    /// otherwise.
    pub(super) fn may_change(&self, text: &str) -> bool {
        let lets = &self.file.tables.lets;
        let (mut open, mut met) = (words(text), BTreeSet::new());
        while let Some(word) = open.pop() {
            if ["cos", "sin"].contains(&word) || self.states.iter().any(|it| it == word) {
                return true;
            }
            if met.insert(word) {
                open.extend(lets.get(word).into_iter().flat_map(|it| words(it.get_ref())));
            }
        }
        false
    }

    /// A form by its factors, in the order of z.
    fn row(&mut self, entries: &[Scalar]) -> Result<Form, String> {
        let states = self.states.len();
        let mut form = Form::zero(states);
        let (accepted, turning) =
            if self.forced { (states + 3, " cos, sin,") } else { (states + 1, "") };
        if entries.len() != accepted {
            return Err(format!(
                "a row of {} entries is not accepted: {accepted} are, of the states,{turning} \
                 and 1",
                entries.len()
            ));
        }
        let before = std::mem::replace(&mut self.accepts, Accepts::Constants);
        let numbers: Result<Vec<Dual>, String> = entries.iter().map(|it| self.factor(it)).collect();
        self.accepts = before;
        let numbers = numbers?;
        let places = (0..states + 3).filter(|n| self.forced || *n < states || *n == states + 2);
        for (place, number) in places.zip(numbers) {
            form.0[place] = number;
        }
        form.check_size()?;
        Ok(form)
    }

    /// An entry of a row.
    fn factor(&mut self, entry: &Scalar) -> Result<Dual, String> {
        let what = "an entry of a row is a number or an expression of parameters";
        if matches!(entry, Scalar::Row(_)) {
            return Err(what.to_owned());
        }
        self.affine(entry)?.constant().cloned().ok_or_else(|| what.to_owned())
    }
}

impl Scope for Names<'_> {
    fn value(&mut self, name: &str) -> Result<Form, String> {
        let states = self.states.len();
        if let Some(form) = self.values.get(name) {
            return Ok(form.clone());
        }
        if let Some(index) = self.states.iter().position(|it| it == name) {
            return match self.accepts {
                Accepts::States => Ok(Form::unit(states, index)),
                Accepts::Constants => {
                    Err(format!("{name} is a state: an expression of parameters is accepted"))
                }
            };
        }
        if let Some(index) = ["cos", "sin"].iter().position(|it| *it == name) {
            return if self.accepts == Accepts::Constants {
                Err(format!("{name} changes with time: an expression of parameters is accepted"))
            } else if self.forced {
                Ok(Form::unit(states, states + index))
            } else {
                Err(format!("{name} means nothing without forcing"))
            };
        }
        let file = self.file;
        let Some(text) = file.tables.lets.get(name) else {
            let known = self.known();
            let accepted = if known.is_empty() {
                "a number, as there are no parameters".to_owned()
            } else {
                known.join(", ")
            };
            return Err(format!("{name} is not known: accepted are {accepted}"));
        };
        if self.open.iter().any(|it| it == name) {
            return Err(format!("{name} is defined by itself"));
        }
        if self.open.len() >= MAX_NESTED_DEFINITIONS {
            return Err(format!(
                "{name} is one definition too many: {MAX_NESTED_DEFINITIONS} are accepted that \
                 follow from each other"
            ));
        }
        self.open.push(name.to_owned());
        let before = std::mem::replace(&mut self.accepts, Accepts::States);
        let form = expression(text.get_ref(), self);
        self.accepts = before;
        self.open.pop();
        let form = form?;
        self.values.insert(name.to_owned(), form.clone());
        Ok(form)
    }

    fn states(&self) -> usize {
        self.states.len()
    }
}

/// The names and integers of an expression.
fn words(text: &str) -> Vec<&str> {
    text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').collect()
}

impl Names<'_> {
    /// All names that an expression may hold here.
    fn known(&self) -> Vec<&str> {
        let states = self.states.iter().filter(|_| self.accepts == Accepts::States);
        let turns = self.forced && self.accepts != Accepts::Constants;
        let turning: &[_] = if turns { &["cos", "sin"] } else { &[] };
        let given = ["omega", "phi"].into_iter().filter(|it| self.values.contains_key(*it));
        let names = self.file.parameters.keys().chain(self.file.tables.lets.keys());
        let all = states.chain(names).map(String::as_str);
        all.chain(turning.iter().copied()).chain(given).collect()
    }
}
