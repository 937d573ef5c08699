//! A piecewise-affine hybrid system with exact coefficients.
//!
//! The state with cos theta and sin theta (of a forced system) and 1 appended is z, in this order.
//! In each mode z' = M z; a guard is a row w, with the value w z; a reset is a matrix R, z+ = R z.

use super::error::SystemError;
use super::file::SystemFile;
use super::source::SourceText;
use crate::affine::model::rational::Rational;
use crate::unknown_name::UnknownName;
use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;
use std::str::FromStr;
use std::sync::Arc;

/// A row of exact coefficients, one for each entry of z.
pub type Row = Vec<Rational>;

/// The product of a row and a matrix, exactly.
pub(in crate::affine) fn row_times(row: &Row, matrix: &[Row]) -> Row {
    let mut sums = vec![Rational::ZERO; row.len()];
    for (factor, own) in row.iter().zip(matrix).filter(|(factor, _)| !factor.is_zero()) {
        let entries = sums.iter_mut().zip(own).filter(|(_, entry)| !entry.is_zero());
        entries.for_each(|(sum, entry)| *sum += factor * entry);
    }
    sums
}

/// Whether a row is that of the identity for an entry of z: a reset with it leaves the entry as it
/// is.
#[must_use]
pub fn is_unit(row: &Row, n: usize) -> bool {
    row.iter().enumerate().all(|(k, it)| if k == n { it.is_one() } else { it.is_zero() })
}

/// Whether a row is a multiple of another one.
#[must_use]
pub fn is_multiple(row: &Row, of: &Row) -> bool {
    let Some(at) = of.iter().position(|it| !it.is_zero()) else {
        return row.iter().all(Rational::is_zero);
    };
    let factor = &row[at] / &of[at];
    row.iter().zip(of).all(|(a, b)| *a == b * &factor)
}

/// The largest number of entries of z.
pub const LARGEST_DIMENSION: usize = 12;

/// The largest number of modes, of events in a mode and of successors of an event.
pub(super) const MAX_COUNT: usize = 64;

/// The kinds of trouble that a system or a case may be said to make.
pub const TROUBLE: [&str; 19] = [
    "jump",
    "accumulation",
    "simultaneous",
    "sliding",
    "chatter",
    "clock",
    "start-on-guard",
    "many-guards",
    "stiffness",
    "graze",
    "double-crossing",
    "multiple-zero",
    "restart-on-zero",
    "side-of-root",
    "output-at-events",
    "backward",
    "direction",
    "hysteresis",
    "chaos",
];

/// A piecewise-affine hybrid system.
///
/// A system is read by [`System::from_toml`], [`System::from_file`] and [`System::parse`], or built
/// by [`System::builder`]. All fields may be read and changed; [`System::check`] says whether what
/// they hold is a system, and every [`Solver`](crate::Solver) asks it.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct System {
    /// The system's name.
    pub name: String,
    /// The purpose of the system, in one sentence, or nothing.
    pub why: String,
    /// The kinds of trouble that the system makes, of those in [`TROUBLE`].
    pub trouble: Vec<String>,
    /// The publication or program that the system is from, or nothing.
    pub source: String,
    /// The values of the system's parameters.
    pub parameters: BTreeMap<String, f64>,
    /// The names of the states.
    pub states: Vec<String>,
    /// The indices of the states that are said to be [drifts](Self::drifts), where the file says
    /// which are.
    pub drift: Option<Vec<usize>>,
    /// The size of each state, by which it is divided before any norm.
    pub scales: Vec<f64>,
    /// The unit by which times are divided before any comparison.
    pub time_scale: f64,
    /// The forcing, of a forced system.
    pub forcing: Option<Forcing>,
    /// The modes.
    pub modes: Vec<Mode>,
    /// The point at which a run begins, if the file says so.
    pub start: Option<StartPoint>,
    /// The states of the start that hang on others of its states, each after those.
    pub(in crate::affine) start_rows: Vec<StartRow>,
    /// The modes in which a start may lie, where the file lists them: the first whose condition
    /// holds at the start is its mode.
    pub start_modes: Vec<Successor>,
    /// The file or the builder's items, whose expressions have the derivatives of all this.
    pub(super) file: Origin,
}

/// A state of a start that hangs on others of its states.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::affine) struct StartRow {
    /// The index of the state.
    pub state: usize,
    /// The factors of the states, of cos theta, of sin theta and of 1.
    pub row: Row,
}

/// The expressions that a system was made from, if it was.
#[derive(Clone, Default)]
pub(super) struct Origin(pub Option<Arc<SystemFile>>);

impl fmt::Debug for Origin {
    /// Two systems of the same coefficients are shown alike, whatever they were made from.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Origin")
    }
}

/// A forcing of the phase theta = omega t + phi.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Forcing {
    /// The frequency, radians a unit of time: positive, or negative where a system runs backward.
    pub omega: Rational,
    /// The phase at time zero, radians.
    pub phi: Rational,
}

/// A mode of a system: its motion, with the guards that end it and those that are watched.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mode {
    /// The mode's name.
    pub name: String,
    /// The rows of the mode's matrix M.
    pub matrix: Vec<Row>,
    /// The guards that end the mode, in the file's order.
    pub until: Vec<Until>,
    /// The guards whose crossings are counted, in the file's order.
    pub watch: Vec<Watch>,
}

impl Mode {
    /// The guards: those of `until`, then those of `watch`.
    pub(in crate::affine) fn guards(&self) -> impl Iterator<Item = &Row> + Clone {
        let watched = self.watch.iter().map(|it| &it.guard);
        self.until.iter().map(|it| &it.guard).chain(watched)
    }

    /// The resets and the successors by which the mode is left: those of each `until`, then in the
    /// same order those of their limits, which are empty where a run ends there.
    pub(in crate::affine) fn exits(&self) -> impl Iterator<Item = (&[Row], &[Successor])> + Clone {
        let limits = self.until.iter().map(Until::limit);
        self.until.iter().map(|it| (&it.reset[..], &it.next[..])).chain(limits)
    }
}

impl Until {
    /// The reset and the successors of the limit, empty where there is none.
    fn limit(&self) -> (&[Row], &[Successor]) {
        self.accumulates_to.as_ref().map_or((&[], &[]), |it| (&it.reset, &it.next))
    }
}

/// A guard that ends its mode where it becomes positive.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Until {
    /// The event's name.
    pub name: String,
    /// The guard, negative inside the mode.
    pub guard: Row,
    /// The rows of the reset's matrix R.
    pub reset: Vec<Row>,
    /// The modes that may follow: the first whose condition holds does.
    pub next: Vec<Successor>,
    /// The passage to what follows where the event accumulates; a run without it ends there.
    pub accumulates_to: Option<Limit>,
}

impl Until {
    /// Whether the guard is zero after the reset wherever it is zero before it.
    pub(in crate::affine) fn keeps_guard_zero(&self) -> bool {
        let after = row_times(&self.guard, &self.reset);
        after == self.guard || after.iter().all(Rational::is_zero)
    }

    /// Whether the reset changes nothing where the guard is zero: all that it adds to entries of z
    /// are multiples of the guard.
    pub(in crate::affine) fn changes_nothing(&self) -> bool {
        self.reset.iter().enumerate().all(|(n, row)| {
            let mut added = row.clone();
            added[n] -= Rational::ONE;
            is_multiple(&added, &self.guard)
        })
    }
}

/// The passage from the limit at which an event accumulates to the mode that follows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Limit {
    /// The rows of the reset's matrix, which acts on the limit of the states.
    pub reset: Vec<Row>,
    /// The modes that may follow: the first whose condition holds does.
    pub next: Vec<Successor>,
}

/// A mode that may follow an event.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Successor {
    /// The condition: that the first of this row's value and derivatives that is not zero is
    /// positive.
    pub when: Option<Row>,
    /// The index of the mode.
    pub mode: usize,
}

/// A guard whose crossings are counted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Watch {
    /// The event's name.
    pub name: String,
    /// The guard.
    pub guard: Row,
    /// The direction in which a crossing is an event.
    pub direction: Direction,
}

/// The direction in which a watched guard has to cross zero for an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// The guard crosses from negative to positive.
    Rising,
    /// The guard crosses from positive to negative.
    Falling,
    /// The guard crosses in either direction.
    Both,
}

impl Direction {
    /// All directions.
    pub const ALL: [Self; 3] = [Self::Rising, Self::Falling, Self::Both];

    /// The name used in the files of systems.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Rising => "rising",
            Self::Falling => "falling",
            Self::Both => "both",
        }
    }
}

impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl FromStr for Direction {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        UnknownName::find("direction", &Self::ALL, Self::as_str, name)
    }
}

/// The point at which a run begins.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StartPoint {
    /// The index of the mode.
    pub mode: usize,
    /// The time.
    pub time: Rational,
    /// Each state as coefficients of cos theta, sin theta and 1 at that time.
    pub state: Vec<[Rational; 3]>,
}

impl System {
    /// Whether theta is zero at a start, as it is for a system without forcing: the start is then
    /// rational.
    pub(in crate::affine) fn is_at_zero_angle(&self, start: &StartPoint) -> bool {
        let angle = |it: &Forcing| &it.omega * &start.time + &it.phi;
        self.forcing.as_ref().is_none_or(|it| angle(it).is_zero())
    }

    /// Reads a system from the text of its file; `file` is its name in errors.
    ///
    /// # Errors
    /// What is not accepted, with file and line.
    pub fn parse(file: &str, text: &str) -> Result<Self, SystemError> {
        SystemFile::read(file, text)?.system()
    }

    /// Reads a system from a text of the format of docs/SYSTEM_FORMAT.md. Errors name a line of it;
    /// [`System::parse`] is for texts that have the name of a file.
    ///
    /// # Errors
    /// What is not accepted, with its line.
    ///
    /// ```
    /// use percuss::System;
    ///
    /// let text = r#"
    /// schema = 1
    /// name = "ball"
    /// states = ["x", "v"]
    /// [[mode]]
    /// name = "flight"
    /// equations = ["x' = v", "v' = -10"]
    /// "#;
    /// assert_eq!(System::from_toml(text)?.dimension(), 3);
    /// let error = System::from_toml(&text.replace("= v", "= w")).unwrap_err();
    /// assert_eq!(
    ///     error.to_string(),
    ///     "line 7: w is not known: accepted are x, v"
    /// );
    /// # Ok::<(), percuss::SystemError>(())
    /// ```
    pub fn from_toml(text: &str) -> Result<Self, SystemError> {
        SystemFile::new(SourceText { file: None, text: text.to_owned() })?.system()
    }

    /// Reads a system from a file.
    ///
    /// # Errors
    /// A file that cannot be read, and what is not accepted in it, with file and line.
    ///
    /// ```
    /// use percuss::System;
    ///
    /// let error = System::from_file("missing.system.toml").unwrap_err();
    /// assert!(error.to_string().starts_with("missing.system.toml: the file cannot be read: "));
    /// ```
    pub fn from_file(path: impl AsRef<Path>) -> Result<Self, SystemError> {
        let path = path.as_ref();
        let name = path.display().to_string();
        let text = std::fs::read_to_string(path).map_err(|error| {
            SystemError::at(&name, &format!("the file cannot be read: {error}"))
        })?;
        Self::parse(&name, &text)
    }

    /// Number of entries of z.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.states.len() + if self.forcing.is_some() { 3 } else { 1 }
    }

    /// The index of the mode of this name.
    #[must_use]
    pub fn mode(&self, name: &str) -> Option<usize> {
        self.modes.iter().position(|mode| mode.name == name)
    }

    /// The system that runs back in time: its elapsed time is the one that has gone back. Only
    /// watched guards and the boundaries of modes mean anything in it.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let mut reversed = self.clone();
        for mode in &mut reversed.modes {
            for row in &mut mode.matrix {
                for entry in row {
                    *entry = -std::mem::take(entry);
                }
            }
        }
        if let Some(forcing) = &mut reversed.forcing {
            forcing.omega = -std::mem::take(&mut forcing.omega);
        }
        reversed
    }
}
