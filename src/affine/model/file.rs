//! The tables of a `*.system.toml` before their meaning is checked; docs/SYSTEM_FORMAT.md has the
//! format.

use super::error::SystemError;
use super::naming::check_kebab;
use super::scalar::{Assignment, Condition, Scalar};
use super::source::{Source, SourceText};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{self, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::ops::Range;
use toml::Spanned;

/// A system's file, read but not yet checked for what it means: parameters and start can be
/// replaced.
#[derive(Clone, Debug)]
pub struct SystemFile {
    pub(super) source: Source,
    pub(super) tables: Tables,
    pub(super) parameters: BTreeMap<String, GivenParameter>,
    pub(super) start: Option<StartTable>,
    /// The parameters whose values are no longer those of the file.
    pub(super) replaced: BTreeSet<String>,
}

/// A parameter's value and the place that gave it.
#[derive(Clone, Debug)]
pub(super) struct GivenParameter {
    pub value: Scalar,
    pub place: String,
}

/// The entries of a `[start]`, each with its place.
#[derive(Clone, Debug)]
pub(super) struct StartTable {
    pub place: String,
    pub entries: BTreeMap<String, GivenParameter>,
    /// The modes by conditions, where there is no entry `mode`.
    pub modes: Vec<StartChoice>,
}

/// A mode in which a start may lie, and its condition, each with its place.
#[derive(Clone, Debug)]
pub(super) struct StartChoice {
    pub when: Option<(Condition, String)>,
    pub mode: (String, String),
}

type Entries = BTreeMap<String, Spanned<Scalar>>;
type StartEntries = BTreeMap<String, Spanned<StartEntry>>;

/// An entry of a `[start]`: a number, an expression or a name, or a list of modes.
#[derive(Clone, Debug)]
pub(super) enum StartEntry {
    Value(Scalar),
    Modes(Vec<NextTable>),
}

impl<'de> Deserialize<'de> for StartEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Read;
        impl<'de> Visitor<'de> for Read {
            type Value = StartEntry;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number or an expression, or for the mode a list of { when, mode }")
            }
            fn visit_i64<E: de::Error>(self, value: i64) -> Result<StartEntry, E> {
                Ok(StartEntry::Value(Scalar::Integer(value)))
            }
            fn visit_f64<E: de::Error>(self, value: f64) -> Result<StartEntry, E> {
                Ok(StartEntry::Value(Scalar::Decimal(value)))
            }
            fn visit_str<E: de::Error>(self, value: &str) -> Result<StartEntry, E> {
                Ok(StartEntry::Value(Scalar::Text(value.to_owned())))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<StartEntry, A::Error> {
                Deserialize::deserialize(SeqAccessDeserializer::new(list)).map(StartEntry::Modes)
            }
        }
        deserializer.deserialize_any(Read)
    }
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the tables of a system")]
pub(super) struct Tables {
    pub schema: Spanned<i64>,
    pub name: Spanned<String>,
    #[serde(default)]
    pub why: String,
    #[serde(default)]
    pub trouble: Vec<Spanned<String>>,
    #[serde(default)]
    pub source: String,
    pub states: Spanned<Vec<Spanned<String>>>,
    pub drift: Option<Vec<Spanned<String>>>,
    pub scales: Option<Spanned<Vec<Spanned<Scalar>>>>,
    pub time_scale: Option<Spanned<Scalar>>,
    pub forcing: Option<ForcingTable>,
    #[serde(default)]
    pub parameters: Entries,
    #[serde(default, rename = "let")]
    pub lets: BTreeMap<String, Spanned<String>>,
    #[serde(default)]
    pub mode: Vec<ModeTable>,
    pub start: Option<Spanned<StartEntries>>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, { omega = ..., phi = ... }")]
pub(super) struct ForcingTable {
    pub omega: Spanned<Scalar>,
    pub phi: Option<Spanned<Scalar>>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [[mode]]")]
pub(super) struct ModeTable {
    pub name: Spanned<String>,
    pub equations: Spanned<Vec<Spanned<Assignment>>>,
    #[serde(default)]
    pub until: Vec<UntilTable>,
    #[serde(default)]
    pub watch: Vec<WatchTable>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [[mode.until]]")]
pub(super) struct UntilTable {
    pub name: Spanned<String>,
    pub guard: Spanned<Condition>,
    #[serde(default)]
    pub reset: Vec<Spanned<Assignment>>,
    pub next: Option<Spanned<NextEntry>>,
    pub accumulates_to: Option<Spanned<LimitEntry>>,
}

/// An `accumulates_to`: the name of a mode, or a table with a reset.
#[derive(Clone, Debug)]
pub(super) enum LimitEntry {
    Mode(String),
    Table(LimitTable),
}

impl<'de> Deserialize<'de> for LimitEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Read;
        impl<'de> Visitor<'de> for Read {
            type Value = LimitEntry;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("the name of a mode, or a table { reset = [...], next = ... }")
            }
            fn visit_str<E: de::Error>(self, value: &str) -> Result<LimitEntry, E> {
                Ok(LimitEntry::Mode(value.to_owned()))
            }
            fn visit_map<A: MapAccess<'de>>(self, table: A) -> Result<LimitEntry, A::Error> {
                Deserialize::deserialize(MapAccessDeserializer::new(table)).map(LimitEntry::Table)
            }
        }
        deserializer.deserialize_any(Read)
    }
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, { reset = [...], next = ... }")]
pub(super) struct LimitTable {
    #[serde(default)]
    pub reset: Vec<Spanned<Assignment>>,
    pub next: Spanned<NextEntry>,
}

/// The successors of an event or of a limit: the name of a mode, or a list of modes by conditions.
#[derive(Clone, Debug)]
pub(super) enum NextEntry {
    Mode(String),
    Modes(Vec<NextTable>),
}

impl<'de> Deserialize<'de> for NextEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Read;
        impl<'de> Visitor<'de> for Read {
            type Value = NextEntry;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("the name of a mode, or a list of { when, mode }")
            }
            fn visit_str<E: de::Error>(self, value: &str) -> Result<NextEntry, E> {
                Ok(NextEntry::Mode(value.to_owned()))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<NextEntry, A::Error> {
                Deserialize::deserialize(SeqAccessDeserializer::new(list)).map(NextEntry::Modes)
            }
        }
        deserializer.deserialize_any(Read)
    }
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, { when = \"...\", mode = \"...\" }")]
pub(super) struct NextTable {
    pub when: Option<Spanned<Condition>>,
    pub mode: Spanned<String>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [[mode.watch]]")]
pub(super) struct WatchTable {
    pub name: Spanned<String>,
    pub guard: Spanned<Condition>,
    pub direction: Option<Spanned<String>>,
}

/// The tables of another file that replace those of a system.
#[derive(Deserialize)]
struct Replacing {
    #[serde(default)]
    parameters: Entries,
    start: Option<Spanned<StartEntries>>,
}

impl SystemFile {
    /// Reads the text of a system's file; `file` is its name in errors.
    ///
    /// # Errors
    /// Text that is not TOML of this shape, with file and line.
    pub fn read(file: &str, text: &str) -> Result<Self, SystemError> {
        Self::new(SourceText::of_file(file, text))
    }

    /// The tables of a text.
    pub(super) fn new(text: SourceText) -> Result<Self, SystemError> {
        let mut tables: Tables = text.parse()?;
        let parameters = placed(&text, std::mem::take(&mut tables.parameters));
        let start = tables.start.take().map(|it| start(&text, it)).transpose()?;
        let source = Source::Text(text);
        Ok(Self { source, tables, parameters, start, replaced: BTreeSet::new() })
    }

    /// The name that the file gives the system.
    #[must_use]
    pub fn name(&self) -> &str {
        self.tables.name.get_ref()
    }

    /// Replaces the value of a parameter; `place` says in errors where the value is from.
    ///
    /// # Errors
    /// A name that is no parameter of the system.
    pub fn set(&mut self, name: &str, value: f64, place: &str) -> Result<(), SystemError> {
        let place = place.to_owned();
        self.replace(name, GivenParameter { value: Scalar::Decimal(value), place })?;
        self.replaced.insert(name.to_owned());
        Ok(())
    }

    /// An error with the places of the values that have replaced those of the file: a line of the
    /// file may be wrong by these alone.
    pub(super) fn with_replaced(&self, error: SystemError) -> SystemError {
        let places = self.replaced.iter().map(|name| self.parameters[name].place.as_str());
        let places: Vec<_> = places.collect();
        match error {
            SystemError::Place { place, what }
                if !(places.is_empty() || places.contains(&place.as_str())) =>
            {
                let what = format!("{what}, with {}", places.join(" and "));
                SystemError::Place { place, what }
            }
            other => other,
        }
    }

    /// Replaces a state of the start, or its time `t`, by a number or by an expression as those of
    /// a file's `[start]`; `place` says in errors where the value is from.
    ///
    /// ```
    /// use percuss::{gallery, system::SystemFile};
    ///
    /// let mut ball = SystemFile::read("ball", gallery::BOUNCING_BALL)?;
    /// ball.set_start("x", "2*g", "the height")?;
    /// let start = ball.system()?.start.expect("a start");
    /// assert_eq!(start.state[0][2].to_f64(), 2.0);
    /// let error = ball.set_start("y", "0", "the height").unwrap_err();
    /// assert_eq!(error.to_string(), "the height: y is no state: accepted are t, x, v");
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    ///
    /// # Errors
    /// A name that is neither `t` nor a state of the system.
    pub fn set_start(&mut self, name: &str, value: &str, place: &str) -> Result<(), SystemError> {
        let states = self.tables.states.get_ref().iter().map(|it| it.get_ref().as_str());
        let known: Vec<&str> = std::iter::once("t").chain(states).collect();
        if !known.contains(&name) {
            let what = format!("{name} is no state: accepted are {}", known.join(", "));
            return Err(SystemError::at(place, &what));
        }
        self.enter_start(name, Scalar::from_text(value), place);
        Ok(())
    }

    /// Replaces the mode of the start; `place` says in errors where the name is from.
    pub fn set_start_mode(&mut self, mode: &str, place: &str) {
        self.enter_start("mode", Scalar::Text(mode.to_owned()), place);
    }

    /// Replaces an entry of the start.
    fn enter_start(&mut self, key: &str, value: Scalar, place: &str) {
        let none =
            || StartTable { place: place.to_owned(), entries: BTreeMap::new(), modes: Vec::new() };
        let given = GivenParameter { value, place: place.to_owned() };
        let start = self.start.get_or_insert_with(none);
        if key == "mode" {
            start.modes.clear();
        }
        start.entries.insert(key.to_owned(), given);
    }

    /// Replaces parameters and start by those of another file's `[parameters]` and `[start]`. Its
    /// other tables are refused, unless they belong to something else.
    ///
    /// # Errors
    /// A text that is not TOML, unknown parameters, and other tables where they are not accepted.
    pub fn replace_from(
        &mut self,
        file: &str,
        text: &str,
        others_accepted: bool,
    ) -> Result<(), SystemError> {
        let source = SourceText::of_file(file, text);
        let tables: BTreeMap<String, Spanned<IgnoredAny>> = source.parse()?;
        let other = |key: &&String| !["parameters", "start"].contains(&key.as_str());
        if let (Some(key), false) = (tables.keys().find(other), others_accepted) {
            let what = format!("{key} is not accepted here: [start] and [parameters] are");
            return Err(SystemError::at(&source.place(&tables[key].span()), &what));
        }
        let replacing: Replacing = source.parse()?;
        for (name, parameter) in placed(&source, replacing.parameters) {
            self.replace(&name, parameter)?;
        }
        if let Some(table) = replacing.start {
            self.start = Some(start(&source, table)?);
        }
        Ok(())
    }

    fn replace(&mut self, name: &str, parameter: GivenParameter) -> Result<(), SystemError> {
        if let Some(old) = self.parameters.get_mut(name) {
            *old = parameter;
            return Ok(());
        }
        let known: Vec<_> = self.parameters.keys().map(String::as_str).collect();
        let what = format!(
            "{name:?} is no parameter of {}: accepted is one of {}{}",
            self.name(),
            if known.is_empty() { "none".to_owned() } else { known.join(", ") },
            self.forcing_by(name)
        );
        Err(SystemError::at(&parameter.place, &what))
    }

    /// Words on the parameters that give the forcing's omega or phi, where these are asked for.
    fn forcing_by(&self, name: &str) -> String {
        let forcing = self.tables.forcing.as_ref();
        let by = match name {
            "omega" => forcing.map(|it| &it.omega),
            "phi" => forcing.and_then(|it| it.phi.as_ref()),
            _ => None,
        };
        match by.map(Spanned::get_ref) {
            Some(Scalar::Text(text)) => format!("; the forcing's {name} is {text}"),
            Some(_) => format!("; the forcing's {name} is a number, and no parameter"),
            None => String::new(),
        }
    }

    /// A name of lower-case words that are joined by hyphens.
    pub(super) fn kebab(&self, name: &Spanned<String>) -> Result<String, SystemError> {
        check_kebab(name.get_ref()).map_err(|what| self.error(&name.span(), &what))?;
        Ok(name.get_ref().clone())
    }

    pub(super) fn error(&self, span: &Range<usize>, what: &str) -> SystemError {
        self.source.error(span, what)
    }
}

fn placed(source: &SourceText, entries: Entries) -> BTreeMap<String, GivenParameter> {
    let place = |(name, value): (String, Spanned<Scalar>)| {
        let place = source.place(&value.span());
        (name, GivenParameter { value: value.into_inner(), place })
    };
    entries.into_iter().map(place).collect()
}

fn start(source: &SourceText, table: Spanned<StartEntries>) -> Result<StartTable, SystemError> {
    let place = source.place(&table.span());
    let (mut entries, mut modes) = (BTreeMap::new(), Vec::new());
    for (name, entry) in table.into_inner() {
        let place = source.place(&entry.span());
        match entry.into_inner() {
            StartEntry::Value(value) => {
                entries.insert(name, GivenParameter { value, place });
            }
            StartEntry::Modes(list) if name == "mode" => {
                modes = list.into_iter().map(|it| start_choice(source, it)).collect();
                if modes.is_empty() {
                    let what = "the start has no mode: a list of { when, mode } has one at least";
                    return Err(SystemError::at(&place, what));
                }
            }
            StartEntry::Modes(_) => {
                let what = format!("{name} is a list: accepted is a number or an expression");
                return Err(SystemError::at(&place, &what));
            }
        }
    }
    Ok(StartTable { place, entries, modes })
}

fn start_choice(source: &SourceText, table: NextTable) -> StartChoice {
    let NextTable { when, mode } = table;
    let [when_place, mode_place] = [when.as_ref().map(Spanned::span), Some(mode.span())]
        .map(|span| span.map(|span| source.place(&span)).unwrap_or_default());
    StartChoice {
        when: when.map(|it| (it.into_inner(), when_place)),
        mode: (mode.into_inner(), mode_place),
    }
}
