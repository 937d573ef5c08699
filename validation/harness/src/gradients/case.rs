//! A case of derivatives: a system at a start, the names, and the proved table.

use crate::case::FileError;
use crate::engine::{Failure, Task};
use crate::system::{CoefficientDerivatives, SystemProblem};
use percuss::affine::{Name, System, SystemFile, Tangent};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::sync::Arc;

/// The columns before those of the states.
const LEADING_COLUMNS: usize = 6;

/// A case of derivatives through events.
#[derive(Clone, Debug)]
pub struct GradientCase {
    /// The case's name.
    pub name: String,
    /// The system, with the case's parameters and start.
    pub system: System,
    /// The clock's time at which the run ends.
    pub until: f64,
    /// The derivatives of the system's coefficients by each name, in the table's order.
    pub by: Vec<Tangent>,
    /// The proved derivatives at each event: the start first, the end last.
    pub rows: Vec<GradientRow>,
}

/// The proved derivatives at one event.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GradientRow {
    /// The event's name; empty at the start, `end` at the end.
    pub event: String,
    /// The mode after the event.
    pub mode: String,
    /// For each name the derivatives of the event's time and of the states just after it.
    pub cells: Vec<Vec<f64>>,
}

impl GradientCase {
    /// The parameters of the case's system, by name.
    pub fn parameters(&self) -> impl Iterator<Item = (&str, f64)> {
        self.system.parameters.iter().map(|(name, value)| (name.as_str(), *value))
    }

    /// Reads a table; `system` gives the text of a system's file by its name.
    ///
    /// # Errors
    /// [`FileError`] names what the file lacks, or what in it makes no sense.
    pub fn read(
        file: &str,
        text: &str,
        system: impl Fn(&str) -> Option<&'static str>,
    ) -> Result<Self, FileError> {
        let (heading, lines): (Vec<&str>, Vec<&str>) =
            text.lines().partition(|it| it.starts_with("# "));
        let heading: BTreeMap<&str, &str> =
            heading.iter().filter_map(|it| it[2..].split_once(" = ")).collect();
        let setting = |key: &str| {
            let found = heading.get(key).copied();
            found.ok_or_else(|| FileError::new(file, format!("the heading has no {key}")))
        };
        let wanted = setting("system")?;
        let of_system = |error: percuss::SystemError| FileError::new(file, error);
        let source = system(wanted)
            .ok_or_else(|| FileError::new(file, format!("there is no system {wanted}")))?;
        let mut read = SystemFile::read(wanted, source).map_err(of_system)?;
        let settings = format!("{}{}", toml(&heading, "parameters"), toml(&heading, "start"));
        read.replace_from(file, &settings, false).map_err(of_system)?;
        let exact = read.system().map_err(of_system)?;
        let until = setting("horizon.until")?.parse();
        let until =
            until.map_err(|error| FileError::new(file, format!("horizon.until: {error}")))?;
        let (names, rows) = rows(file, &lines)?;
        let tangent = |name: &String| read.tangent(&Name::read(name)).map_err(of_system);
        let by = names.iter().map(tangent).collect::<Result<_, _>>()?;
        Ok(Self { name: setting("case")?.to_owned(), system: exact, until, by, rows })
    }

    /// The run of the case, with all of its names asked for.
    ///
    /// # Errors
    /// A system that no run can be asked of, such as one without a start.
    pub fn task(&self) -> Result<Task, Failure> {
        let problem = Arc::new(SystemProblem::new(self.system.clone(), false)?);
        let task = Task::from_problem(&problem, self.until - problem.begin(), Vec::new())?;
        let rates = self.by.iter().map(|it| CoefficientDerivatives::new(&problem, it)).collect();
        Ok(Task { gradients: Some(Arc::new(rates)), ..task })
    }

    /// The names by which is differentiated.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        self.by.iter().map(|it| it.name.to_string()).collect()
    }
}

/// The settings below a key as a table of TOML: numbers, and expressions in quotation marks.
fn toml(heading: &BTreeMap<&str, &str>, table: &str) -> String {
    let mut text = format!("[{table}]\n");
    for (key, value) in heading {
        let Some((_, name)) = key.split_once('.').filter(|(first, _)| *first == table) else {
            continue;
        };
        let is_number = value.parse::<f64>().is_ok();
        let value = if is_number { (*value).to_owned() } else { format!("{value:?}") };
        // Writing to a text does not fail.
        let _ = writeln!(text, "{name} = {value}");
    }
    text
}

/// The names of a table, and its rows by events.
fn rows(file: &str, lines: &[&str]) -> Result<(Vec<String>, Vec<GradientRow>), FileError> {
    let mut names: Vec<String> = Vec::new();
    let mut rows: Vec<GradientRow> = Vec::new();
    for line in lines.iter().skip(1) {
        let refused = || FileError::new(file, format!("the line {line:?} is none of a table"));
        let cells: Vec<&str> = line.split(',').collect();
        let [n, event, mode, wrt, side] = *cells
            .get(..LEADING_COLUMNS - 1)
            .and_then(|it| it.first_chunk::<5>())
            .ok_or_else(refused)?;
        let n: usize = n.parse().map_err(|_| refused())?;
        if !side.is_empty() || n > rows.len() {
            return Err(refused());
        }
        if n == 0 {
            names.push(wrt.to_owned());
        }
        if n == rows.len() {
            let (event, mode) = (event.to_owned(), mode.to_owned());
            rows.push(GradientRow { event, mode, cells: Vec::new() });
        }
        let numbers: Result<Vec<f64>, _> =
            cells[LEADING_COLUMNS - 1..].iter().map(|it| it.parse()).collect();
        rows[n].cells.push(numbers.map_err(|_| refused())?);
    }
    if rows.is_empty() || rows.iter().any(|it| it.cells.len() != names.len()) {
        return Err(FileError::new(file, "not every event has a row for each name"));
    }
    Ok((names, rows))
}
