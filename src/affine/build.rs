//! From the tables of a file to a system: names are resolved and expressions read.

use super::error::SystemError;
use super::expression::{Scope, condition, expression, is_name};
use super::file::{
    GivenParameter, ModeTable, Scalar, StartTable, SystemFile, UntilTable, WatchTable,
};
use super::form::Form;
use super::system::{
    Direction, Forcing, LARGEST_DIMENSION, Mode, Row, StartPoint, Successor, System, Until, Watch,
};
use dashu_ratio::RBig;
use std::collections::{BTreeMap, BTreeSet};
use toml::Spanned;

/// The largest number of modes, of events in a mode and of successors of an event.
const MOST: usize = 64;

/// Names that expressions cannot give to anything else.
const RESERVED: [&str; 4] = ["cos", "sin", "omega", "phi"];

/// How runs end, which is what no event may be called.
const ENDINGS: [&str; 6] =
    ["end", "accumulation", "leaves-domain", "no-progress", "beyond-guard", "undecided"];

impl SystemFile {
    /// The system that the file describes.
    ///
    /// # Errors
    /// Whatever does not make sense, with its place and what is accepted.
    pub fn system(&self) -> Result<System, SystemError> {
        system(self)
    }
}

fn system(file: &SystemFile) -> Result<System, SystemError> {
    let mut names = Names::of(file)?;
    let forcing = names.forcing()?;
    names.check_lets()?;
    let tables = &file.tables;
    let mut system = System {
        name: kebab(file, &tables.name)?,
        why: tables.why.clone(),
        trouble: tables.trouble.iter().map(|it| kebab(file, it)).collect::<Result<_, _>>()?,
        source: tables.source.clone(),
        parameters: file.parameters.iter().filter_map(parameter).collect(),
        states: names.states.clone(),
        scales: names.scales()?,
        time_scale: names.time_scale(forcing.as_ref())?,
        forcing,
        modes: Vec::new(),
        start: None,
    };
    let dimension = system.dimension();
    if dimension > LARGEST_DIMENSION {
        let what = format!(
            "{} states are too many: with cos, sin (where the system is forced) and 1 appended \
             there are {dimension}, and up to {LARGEST_DIMENSION} are accepted",
            system.states.len()
        );
        return Err(file.error(&tables.states.span(), &what));
    }
    let places = mode_places(file)?;
    let omega = system.forcing.as_ref().map(|it| it.omega.clone());
    for table in &tables.mode {
        let reader = ModeReader { file, places: &places, omega: omega.as_ref() };
        let here = system.modes.len();
        system.modes.push(reader.mode(&mut names, table, here)?);
    }
    if let Some(start) = &file.start {
        system.start = Some(start_point(&mut names, start, &places)?);
    }
    Ok(system)
}

/// A parameter's name and value.
fn parameter((name, it): (&String, &GivenParameter)) -> Option<(String, f64)> {
    number(&it.value).map(|value| (name.clone(), value.to_f64().value()))
}

/// The index of each mode by its name.
fn mode_places(file: &SystemFile) -> Result<BTreeMap<String, usize>, SystemError> {
    let mut places = BTreeMap::new();
    for (index, mode) in file.tables.mode.iter().enumerate() {
        if places.insert(kebab(file, &mode.name)?, index).is_some() {
            let what = format!("the mode {:?} is there twice", mode.name.get_ref());
            return Err(file.error(&mode.name.span(), &what));
        }
    }
    if places.is_empty() || places.len() > MOST {
        let what = format!("{} modes are not accepted: 1 to {MOST} are", places.len());
        return Err(file.error(&file.tables.name.span(), &what));
    }
    Ok(places)
}

/// What the names of a file's expressions mean.
struct Names<'a> {
    file: &'a SystemFile,
    states: Vec<String>,
    forced: bool,
    values: BTreeMap<String, Form>,
    /// The `[let]`s that are being read, to see a circle.
    open: Vec<String>,
    /// Whether states are accepted, as they are not at a start.
    with_states: bool,
}

impl<'a> Names<'a> {
    fn of(file: &'a SystemFile) -> Result<Self, SystemError> {
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
        let mut names = Self { file, states, forced, values, open: Vec::new(), with_states: true };
        names.check_names()?;
        for (name, GivenParameter { value, place }) in &file.parameters {
            let number = number(value).ok_or_else(|| {
                let what = "a parameter is a finite number; an expression belongs into [let]";
                SystemError::at(place, &format!("{name}: {what}"))
            })?;
            names.values.insert(name.clone(), Form::number(names.states.len(), number));
        }
        Ok(names)
    }

    fn check_names(&self) -> Result<(), SystemError> {
        let tables = &self.file.tables;
        let place = |span| self.file.source().place(&span);
        let states = tables.states.get_ref().iter().map(|it| (it.get_ref(), place(it.span())));
        let parameters = self.file.parameters.iter().map(|(name, it)| (name, it.place.clone()));
        let lets = tables.lets.iter().map(|(name, it)| (name, place(it.span())));
        let mut seen = BTreeSet::new();
        for (name, place) in states.chain(parameters).chain(lets) {
            let what = if RESERVED.contains(&name.as_str()) {
                format!("{name} is reserved for theta = omega t + phi")
            } else if !is_name(name) {
                format!("{name:?} is no name: a letter, then letters, digits and underscores are")
            } else if !seen.insert(name) {
                format!("{name} is given twice; states, parameters and [let] share their names")
            } else {
                continue;
            };
            return Err(SystemError::at(&place, &what));
        }
        Ok(())
    }

    /// Reads every `[let]`, used or not.
    fn check_lets(&mut self) -> Result<(), SystemError> {
        let file = self.file;
        for (name, text) in &file.tables.lets {
            self.value(name)
                .map_err(|what| file.error(&text.span(), &format!("{name}: {what}")))?;
        }
        Ok(())
    }

    fn forcing(&mut self) -> Result<Option<Forcing>, SystemError> {
        let Some(table) = &self.file.tables.forcing else { return Ok(None) };
        let omega = self.constant("omega", &table.omega)?;
        let phi = self.constant("phi", &table.phi)?;
        if omega <= RBig::ZERO {
            return Err(self.file.error(&table.omega.span(), "omega is accepted above 0"));
        }
        for (name, value) in [("omega", &omega), ("phi", &phi)] {
            let form = Form::number(self.states.len(), value.clone());
            self.values.insert(name.to_owned(), form);
        }
        Ok(Some(Forcing { omega, phi }))
    }

    fn scales(&mut self) -> Result<Vec<f64>, SystemError> {
        let Some(scales) = &self.file.tables.scales else {
            return Ok(vec![1.0; self.states.len()]);
        };
        if scales.get_ref().len() != self.states.len() {
            let what = format!("scales holds a number a state, {} of them", self.states.len());
            return Err(self.file.error(&scales.span(), &what));
        }
        scales.get_ref().iter().map(|it| self.positive("scales", it)).collect()
    }

    fn time_scale(&mut self, forcing: Option<&Forcing>) -> Result<f64, SystemError> {
        match (&self.file.tables.time_scale, forcing) {
            (Some(scale), _) => self.positive("time_scale", scale),
            (None, Some(forcing)) => Ok(1.0 / forcing.omega.to_f64().value()),
            (None, None) => Ok(1.0),
        }
    }

    fn positive(&mut self, key: &str, scalar: &Spanned<Scalar>) -> Result<f64, SystemError> {
        let value = self.constant(key, scalar)?.to_f64().value();
        if value > 0.0 && value.is_finite() {
            return Ok(value);
        }
        Err(self.file.error(&scalar.span(), &format!("{key}: a positive number is accepted")))
    }

    /// A number, or an expression of parameters.
    fn constant(&mut self, key: &str, scalar: &Spanned<Scalar>) -> Result<RBig, SystemError> {
        let place = self.file.source().place(&scalar.span());
        self.constant_at(key, scalar.get_ref(), &place)
    }

    fn constant_at(
        &mut self,
        key: &str,
        scalar: &Scalar,
        place: &str,
    ) -> Result<RBig, SystemError> {
        let form =
            self.affine(scalar).map_err(|it| SystemError::at(place, &format!("{key}: {it}")))?;
        form.constant().cloned().ok_or_else(|| {
            SystemError::at(place, &format!("{key}: a number or an expression of parameters"))
        })
    }

    fn affine(&mut self, scalar: &Scalar) -> Result<Form, String> {
        let form = match scalar {
            Scalar::Text(text) => expression(text, self)?,
            other => number(other)
                .map(|number| Form::number(self.states.len(), number))
                .ok_or_else(|| "a finite number is accepted".to_owned())?,
        };
        form.check_range()?;
        Ok(form)
    }
}

impl Scope for Names<'_> {
    fn value(&mut self, name: &str) -> Result<Form, String> {
        let states = self.states.len();
        if let Some(form) = self.values.get(name) {
            return Ok(form.clone());
        }
        if let Some(index) = self.states.iter().position(|it| it == name) {
            return if self.with_states {
                Ok(Form::unit(states, index))
            } else {
                Err(format!("{name} is a state: a start is an expression of parameters, cos, sin"))
            };
        }
        if let Some(index) = ["cos", "sin"].iter().position(|it| *it == name) {
            return if self.forced {
                Ok(Form::unit(states, states + index))
            } else {
                Err(format!("{name} means nothing without forcing"))
            };
        }
        let file = self.file;
        let Some(text) = file.tables.lets.get(name) else {
            return Err(format!(
                "{name} is not known: accepted are states, parameters, names of [let], and where \
                 the system is forced cos, sin, omega and phi"
            ));
        };
        if self.open.iter().any(|it| it == name) {
            return Err(format!("{name} is defined by itself"));
        }
        self.open.push(name.to_owned());
        let with_states = std::mem::replace(&mut self.with_states, true);
        let form = expression(text.get_ref(), self);
        self.with_states = with_states;
        self.open.pop();
        let form = form?;
        self.values.insert(name.to_owned(), form.clone());
        Ok(form)
    }

    fn states(&self) -> usize {
        self.states.len()
    }
}

/// What the tables of a mode need beside the names.
struct ModeReader<'a> {
    file: &'a SystemFile,
    places: &'a BTreeMap<String, usize>,
    omega: Option<&'a RBig>,
}

impl ModeReader<'_> {
    fn mode(&self, names: &mut Names, table: &ModeTable, here: usize) -> Result<Mode, SystemError> {
        let mut matrix = self.rates(names, table)?;
        let dimension = matrix.len() + if self.omega.is_some() { 3 } else { 1 };
        if let Some(omega) = self.omega {
            let cos = dimension - 3;
            let mut rates = [vec![RBig::ZERO; dimension], vec![RBig::ZERO; dimension]];
            rates[0][cos + 1] = -omega.clone();
            rates[1][cos] = omega.clone();
            matrix.extend(rates);
        }
        matrix.push(vec![RBig::ZERO; dimension]);
        let count = table.until.len() + table.watch.len();
        if count > MOST {
            let what = format!("{count} events are too many: up to {MOST} a mode are accepted");
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
            if ENDINGS.contains(&name.get_ref().as_str()) {
                let what = format!("{:?} is the name of an ending", name.get_ref());
                return Err(self.file.error(&name.span(), &what));
            }
            if !seen.insert(kebab(self.file, name)?) {
                let what = format!("the event {:?} is there twice in its mode", name.get_ref());
                return Err(self.file.error(&name.span(), &what));
            }
        }
        Ok(())
    }

    /// The rows of M that belong to the states.
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

    /// `x' = ...`, or without the prime: the state's index, and the row.
    fn assignment(
        &self,
        names: &mut Names,
        text: &Spanned<String>,
        primed: bool,
    ) -> Result<(usize, Row), SystemError> {
        let refuse = |what: &str| self.file.error(&text.span(), what);
        let prime = if primed { "'" } else { "" };
        let shape = format!("`x{prime} = ...` with a state x is accepted");
        let Some((left, right)) = text.get_ref().split_once('=') else {
            return Err(refuse(&shape));
        };
        let left = left.trim();
        let name = if primed { left.strip_suffix('\'').map(str::trim_end) } else { Some(left) };
        let state = name.and_then(|name| names.states.iter().position(|it| it == name));
        let state = state.ok_or_else(|| refuse(&format!("{left:?}: {shape}")))?;
        let form = expression(right, names).map_err(|what| refuse(&what))?;
        Ok((state, self.row(form).map_err(|what| refuse(&what))?))
    }

    fn row(&self, form: Form) -> Result<Row, String> {
        form.check_range()?;
        let states = form.0.len() - 3;
        let forced = self.omega.is_some();
        let kept = |(index, it)| (forced || index < states || index == states + 2).then_some(it);
        Ok(form.0.into_iter().enumerate().filter_map(kept).collect())
    }

    fn guard(&self, names: &mut Names, text: &Spanned<String>) -> Result<Row, SystemError> {
        let form = condition(text.get_ref(), names);
        let row = form.and_then(|form| self.row(form));
        row.map_err(|what| self.file.error(&text.span(), &what))
    }

    fn until(
        &self,
        names: &mut Names,
        table: &UntilTable,
        here: usize,
    ) -> Result<Until, SystemError> {
        let guard = self.guard(names, &table.guard)?;
        let dimension = guard.len();
        let unit = |index| {
            let mut row = vec![RBig::ZERO; dimension];
            row[index] = RBig::ONE;
            row
        };
        let mut reset: Vec<Row> = (0..dimension).map(unit).collect();
        let mut assigned = BTreeSet::new();
        for text in &table.reset {
            let (state, row) = self.assignment(names, text, false)?;
            if !assigned.insert(state) {
                let what = format!("{} is assigned twice", names.states[state]);
                return Err(self.file.error(&text.span(), &what));
            }
            reset[state] = row;
        }
        let next = self.successors(names, table, here)?;
        Ok(Until { name: table.name.get_ref().clone(), guard, reset, next })
    }

    fn successors(
        &self,
        names: &mut Names,
        table: &UntilTable,
        here: usize,
    ) -> Result<Vec<Successor>, SystemError> {
        let Some(next) = &table.next else { return Ok(vec![Successor { when: None, mode: here }]) };
        let refuse = |what: &str| Err(self.file.error(&next.span(), what));
        let count = next.get_ref().len();
        if count == 0 || count > MOST {
            return refuse(&format!("{count} successors are not accepted: 1 to {MOST} are"));
        }
        let mut successors = Vec::with_capacity(count);
        for (n, entry) in next.get_ref().iter().enumerate() {
            if entry.when.is_some() == (n + 1 == count) {
                return refuse("every successor but the last has a `when`, and the last has none");
            }
            let Some(mode) = self.places.get(entry.mode.get_ref()) else {
                let known: Vec<_> = self.places.keys().map(String::as_str).collect();
                let what = format!(
                    "there is no mode {:?}: accepted is one of {}",
                    entry.mode.get_ref(),
                    known.join(", ")
                );
                return Err(self.file.error(&entry.mode.span(), &what));
            };
            let when = entry.when.as_ref().map(|it| self.guard(names, it)).transpose()?;
            successors.push(Successor { when, mode: *mode });
        }
        Ok(successors)
    }

    fn watch(&self, names: &mut Names, table: &WatchTable) -> Result<Watch, SystemError> {
        let direction = match table.direction.as_ref().map(|it| (it.get_ref().as_str(), it.span()))
        {
            None | Some(("rising", _)) => Direction::Rising,
            Some(("falling", _)) => Direction::Falling,
            Some(("both", _)) => Direction::Both,
            Some((other, span)) => {
                let what = format!("{other:?} is no direction: rising, falling or both is");
                return Err(self.file.error(&span, &what));
            }
        };
        let guard = self.guard(names, &table.guard)?;
        Ok(Watch { name: table.name.get_ref().clone(), guard, direction })
    }
}

fn start_point(
    names: &mut Names,
    table: &StartTable,
    places: &BTreeMap<String, usize>,
) -> Result<StartPoint, SystemError> {
    let refuse = |what: &str| SystemError::at(&table.place, what);
    let known: Vec<_> = places.keys().map(String::as_str).collect();
    let mode = match table.entries.get("mode") {
        Some(GivenParameter { value: Scalar::Text(name), place }) => {
            places.get(name).copied().ok_or_else(|| {
                let what =
                    format!("there is no mode {name:?}: accepted is one of {}", known.join(", "));
                SystemError::at(place, &what)
            })?
        }
        _ => return Err(refuse(&format!("mode is accepted as one of {}", known.join(", ")))),
    };
    names.with_states = false;
    let time = match table.entries.get("t") {
        Some(GivenParameter { value, place }) if !names.states.iter().any(|it| it == "t") => {
            names.constant_at("t", value, place)?
        }
        _ => RBig::ZERO,
    };
    let states = names.states.clone();
    let mut state = Vec::with_capacity(states.len());
    for name in &states {
        let Some(GivenParameter { value, place }) = table.entries.get(name) else {
            return Err(refuse(&format!("the state {name} is missing in [start]")));
        };
        let form = names.affine(value);
        let form = form.map_err(|what| SystemError::at(place, &format!("{name}: {what}")))?;
        if form.has_states() {
            let what = "a start is an expression of parameters, cos and sin";
            return Err(SystemError::at(place, &format!("{name}: {what}")));
        }
        let [.., cos, sin, one] = form.0.as_slice() else { continue };
        state.push([cos.clone(), sin.clone(), one.clone()]);
    }
    let surplus = |key: &&String| !(["mode", "t"].contains(&key.as_str()) || states.contains(key));
    if let Some(key) = table.entries.keys().find(surplus) {
        let place = &table.entries[key].place;
        let what = format!("{key} is no state: accepted are mode, t, {}", states.join(", "));
        return Err(SystemError::at(place, &what));
    }
    Ok(StartPoint { mode, time, state })
}

/// The exact value of a number; none of text and of what is not finite.
fn number(scalar: &Scalar) -> Option<RBig> {
    match scalar {
        Scalar::Integer(integer) => Some(RBig::from(*integer)),
        Scalar::Decimal(decimal) => RBig::try_from(*decimal).ok(),
        Scalar::Text(_) => None,
    }
}

/// A name of lower-case words that are joined by hyphens.
fn kebab(file: &SystemFile, name: &Spanned<String>) -> Result<String, SystemError> {
    let text = name.get_ref();
    let word = |word: &str| {
        let belongs = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit();
        !word.is_empty() && word.chars().all(belongs)
    };
    if text.split('-').all(word) {
        return Ok(text.clone());
    }
    let what = format!("{text:?} is not accepted: lower-case words joined by hyphens are");
    Err(file.error(&name.span(), &what))
}
