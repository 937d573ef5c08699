//! Every proved table of derivatives through events, `reference_data/gradients`, to the last digit.

use percuss::affine::{Bits212, Bits424, Bits848, Bits1696, Event, Solver, SystemFile, Walk, What};
use percuss::number::{Bound, Number};
use percuss::system::Name;
use std::path::{Path, PathBuf};

/// The tables that there are.
const CASES: usize = 53;

/// An error that no digit of a table sees, beside the derivative itself.
const CLEAR: f64 = 1e-28;

/// A derivative that is zero is known within this.
const ZERO: f64 = 1e-30;

fn folder(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// A table's heading, and its rows.
struct Table {
    settings: Vec<(String, String)>,
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    fn read(path: &Path) -> Self {
        let text = std::fs::read_to_string(path).unwrap();
        let (heading, rows): (Vec<_>, Vec<_>) = text.lines().partition(|it| it.starts_with("# "));
        let pair = |line: &&str| {
            let (key, value) = line[2..].split_once(" = ").unwrap();
            (key.to_owned(), value.to_owned())
        };
        let mut rows =
            rows.iter().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
        let columns = rows.next().unwrap();
        Self { settings: heading.iter().map(pair).collect(), columns, rows: rows.collect() }
    }

    fn setting(&self, key: &str) -> &str {
        &self.settings.iter().find(|it| it.0 == key).unwrap().1
    }

    /// The settings below a key as a table of TOML: numbers, and expressions in quotation marks.
    fn toml(&self, table: &str) -> String {
        let mut text = format!("[{table}]\n");
        for (key, value) in &self.settings {
            if let Some(name) = key.strip_prefix(&format!("{table}.")) {
                let is_number = value.parse::<f64>().is_ok();
                let value = if is_number { value.clone() } else { format!("{value:?}") };
                text += &format!("{name} = {value}\n");
            }
        }
        text
    }

    /// The system as the case sets it.
    fn system(&self) -> SystemFile {
        let name = format!("{}.system.toml", self.setting("system"));
        let places = ["reference_data/gradients", "validation/systems"];
        let mut paths = places.iter().map(|it| folder(it).join(&name));
        let path = paths.find(|it| it.exists()).unwrap();
        let mut file = SystemFile::read(&name, &std::fs::read_to_string(path).unwrap()).unwrap();
        let settings = format!("{}{}", self.toml("parameters"), self.toml("start"));
        file.replace_from("heading", &settings, false).unwrap();
        file
    }

    /// The names by which is differentiated, in order: those of the first row.
    fn names(&self) -> Vec<&str> {
        let first = self.rows.iter().take_while(|it| it[0] == "0");
        first.map(|it| it[3].as_str()).collect()
    }
}

/// A decimal, as a number of many bits.
fn decimal<T: Number>(text: &str) -> T {
    let (mantissa, exponent) = text.split_once('e').unwrap_or((text, "0"));
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let exponent = exponent.parse::<i32>().unwrap() - i32::try_from(fraction.len()).unwrap();
    let ten = T::exact(10.0);
    let mut value = T::zero();
    for digit in whole.trim_start_matches('-').chars().chain(fraction.chars()) {
        value = value * ten + T::exact(f64::from(digit.to_digit(10).unwrap()));
    }
    let power = (0..exponent.abs()).fold(T::one(), |power, _| power * ten);
    value = if exponent > 0 { value * power } else { value / power };
    if whole.starts_with('-') { -value } else { value }
}

/// Half of the last of 25 digits of a number that is written so.
fn half_unit<T: Number>(text: &str) -> T {
    let zeros = |it: char| if it.is_ascii_digit() { '0' } else { it };
    let (mantissa, exponent) = text.split_once('e').unwrap_or((text, "0"));
    let unit: String = mantissa.trim_start_matches('-').chars().map(zeros).collect();
    assert!(unit.contains('.'), "{text}");
    decimal(&format!("{unit}5e{exponent}"))
}

/// Why a derivative is not that of a table; none where it is. An error that is too large to tell
/// is `Unclear`.
enum Off {
    Unclear(String),
    Differs(String),
}

fn compare<T: Number>(cell: &str, (value, error): (T, T::Bound)) -> Result<(), Off> {
    let expected = decimal::<T>(cell);
    // In bounds, because a derivative may be smaller than any number of f64.
    let clear = match cell {
        "0" => T::Bound::of(ZERO),
        _ => expected.bound().abs() * CLEAR,
    };
    let what = || format!("{value:?} +- {error:?}, not {cell}");
    if error > clear {
        return Err(Off::Unclear(what()));
    }
    let allowed = if cell == "0" { T::zero() } else { half_unit::<T>(cell) };
    if (value - expected).abs() <= allowed + T::of_bound(error) {
        return Ok(());
    }
    Err(Off::Differs(what()))
}

/// Holds all derivatives of a table by one name to those that are found in so many bits.
fn by_name<T: Number>(table: &Table, name: &str) -> Result<(), Off> {
    let file = table.system();
    let (system, tangent) = (file.system().unwrap(), file.tangent(&Name::read(name)).unwrap());
    let solver = Solver::<T>::new(&system).unwrap();
    let until = T::exact(table.setting("horizon.until").parse().unwrap());
    let run = solver.run_enclosed(system.start.as_ref().unwrap(), until).unwrap();
    let start = run.start();
    let mut walk = Walk::new(&solver, &tangent, &start).unwrap();
    let rows: Vec<_> = table.rows.iter().filter(|it| it[3] == name).collect();
    let mut events: Vec<Event<T>> = vec![start];
    events.extend(run);
    if events.len() != rows.len() {
        return Err(Off::Unclear(format!("{} events, not {}", events.len(), rows.len())));
    }
    for (n, (row, event)) in rows.iter().zip(&events).enumerate() {
        let event_name = match event.what {
            What::Until(mode, until) => system.modes[mode].until[until].name.as_str(),
            What::Watch(mode, watch) => system.modes[mode].watch[watch].name.as_str(),
            What::End(_) => "end",
            _ => "",
        };
        let mode = &system.modes[event.mode].name;
        assert!(n == 0 || (row[1] == event_name && row[2] == *mode), "{row:?}: {event_name}");
        let found = if n == 0 { Ok(walk.start()) } else { walk.step(event) };
        let found = found.map_err(|error| Off::Unclear(format!("row {n} by {name}: {error}")))?;
        let columns = table.columns[5..].iter().zip(&row[5..]);
        for ((column, cell), own) in columns.zip(std::iter::once(found.time).chain(found.state)) {
            compare(cell, own).map_err(|off| off.at(&format!("row {n} by {name}, {column}")))?;
        }
    }
    Ok(())
}

impl Off {
    fn at(self, place: &str) -> Self {
        match self {
            Self::Unclear(what) => Self::Unclear(format!("{place}: {what}")),
            Self::Differs(what) => Self::Differs(format!("{place}: {what}")),
        }
    }
}

/// Holds a table to the derivatives in as many bits as tell every digit; the errors found.
fn check(path: &Path) -> Vec<String> {
    let table = Table::read(path);
    let mut errors = Vec::new();
    for name in table.names() {
        let tries =
            [by_name::<Bits212>, by_name::<Bits424>, by_name::<Bits848>, by_name::<Bits1696>];
        let mut found = Err(Off::Unclear(String::new()));
        for attempt in tries {
            if matches!(found, Err(Off::Unclear(_))) {
                found = attempt(&table, name);
            }
        }
        if let Err(Off::Unclear(what) | Off::Differs(what)) = found {
            errors.push(format!("{}: {what}", table.setting("case")));
        }
    }
    errors
}

#[test]
fn every_digit_of_every_table_is_found() {
    let files = std::fs::read_dir(folder("reference_data/gradients")).unwrap();
    let mut paths: Vec<_> = files.map(|it| it.unwrap().path()).collect();
    paths.retain(|it| it.extension().is_some_and(|it| it == "csv"));
    assert_eq!(paths.len(), CASES);
    let errors: Vec<String> = paths.iter().flat_map(|it| check(it)).collect();
    assert!(errors.is_empty(), "{}", errors.join("\n"));
}
