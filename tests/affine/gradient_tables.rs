//! Every proved table of derivatives through events, `reference_data/gradients`, to the last digit.

use percuss::Bits212;
use percuss::affine::SystemFile;
use percuss::number::Number;
use percuss::{Event, Kind, Proved};
use std::path::{Path, PathBuf};

/// The tables that there are.
const CASES: usize = 53;

/// The digits that are asked for, all but one of which have to be proved.
const DIGITS: usize = 25;

/// A derivative that is zero is known within this.
const ZERO_TOLERANCE: f64 = 1e-20;

/// Derivatives of which a run does not look for digits, because they are so small beside others by
/// the same name: how many there are, and what none of them exceeds.
const UNPROVED_DERIVATIVES: (usize, f64) = (22, 1e-130);

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
fn decimal(text: &str) -> Bits212 {
    let (mantissa, exponent) = text.split_once('e').unwrap_or((text, "0"));
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let exponent = exponent.parse::<i32>().unwrap() - i32::try_from(fraction.len()).unwrap();
    let ten = Bits212::exact(10.0);
    let mut value = Bits212::zero();
    for digit in whole.trim_start_matches('-').chars().chain(fraction.chars()) {
        value = value * ten + Bits212::exact(f64::from(digit.to_digit(10).unwrap()));
    }
    let power = (0..exponent.abs()).fold(Bits212::one(), |power, _| power * ten);
    value = if exponent > 0 { value * power } else { value / power };
    if whole.starts_with('-') { -value } else { value }
}

/// Half of the last digit of a number that is written so.
fn half_unit(text: &str) -> Bits212 {
    let zeros = |it: char| if it.is_ascii_digit() { '0' } else { it };
    let (mantissa, exponent) = text.split_once('e').unwrap_or((text, "0"));
    let unit: String = mantissa.trim_start_matches('-').chars().map(zeros).collect();
    let point = if unit.contains('.') { "" } else { "." };
    decimal(&format!("{unit}{point}5e{exponent}"))
}

/// Whether a derivative is that of a table to every digit, or is one of those that are too small.
enum Cell {
    Right,
    Tiny,
    Wrong,
}

fn compare(cell: &str, found: &Proved) -> Cell {
    if cell == "0" {
        let is_zero = found.may_be(0.0) && found.error() <= ZERO_TOLERANCE;
        return if is_zero { Cell::Right } else { Cell::Wrong };
    }
    let text = found.to_digits(DIGITS);
    if text.starts_with("0e") {
        let below = decimal(&text.replacen('0', "1", 1));
        let is_tiny = decimal(cell).abs() <= below
            && decimal(cell).abs() < Bits212::exact(UNPROVED_DERIVATIVES.1);
        return if is_tiny { Cell::Tiny } else { Cell::Wrong };
    }
    let off = (decimal(&text) - decimal(cell)).abs();
    let is_known = found.digits(DIGITS).is_none_or(|it| it >= DIGITS - 1);
    let is_right = is_known && off <= half_unit(&text) + half_unit(cell);
    if is_right { Cell::Right } else { Cell::Wrong }
}

/// What a table and a run's event have different, and how many derivatives are too small to tell.
fn row(table: &Table, cells: &[String], event: &Event<'_, Proved>) -> (Vec<String>, usize) {
    let place = format!("{}, row {} by {}", table.setting("case"), cells[0], cells[3]);
    let name = if event.kind() == Kind::Start { "" } else { event.name() };
    if (name, event.mode()) != (&cells[1], &cells[2]) {
        return (vec![format!("{place}: {name}, {}", event.mode())], 0);
    }
    let gradient = match event.gradient(&cells[3]).expect("it was asked for") {
        Ok(gradient) => gradient,
        Err(reason) => return (vec![format!("{place}: {reason}")], 0),
    };
    let (mut wrong, mut tiny) = (Vec::new(), 0);
    let found = std::iter::once(gradient.time()).chain(gradient.state());
    for ((column, cell), found) in table.columns[5..].iter().zip(&cells[5..]).zip(found) {
        match compare(cell, found) {
            Cell::Right => {}
            Cell::Tiny => tiny += 1,
            Cell::Wrong => wrong.push(format!("{place}, {column}: {found}, not {cell}")),
        }
    }
    (wrong, tiny)
}

/// What a table and a run have different, and how many derivatives are too small to tell.
fn check(path: &Path) -> (Vec<String>, usize) {
    let table = Table::read(path);
    let system = table.system().system().unwrap();
    let solver = system.solver::<Proved>().unwrap();
    let names = table.names();
    let until = table.setting("horizon.until").parse().unwrap();
    let run = solver.run().digits(DIGITS).gradients(&names).unwrap();
    let mut found = run.until(until).unwrap();
    let mut events = vec![found.start()];
    events.extend(&mut found);
    let (mut wrong, mut tiny) = (Vec::new(), 0);
    if events.len() * names.len() != table.rows.len() {
        wrong.push(format!("{}: {} events", table.setting("case"), events.len()));
    }
    for (n, cells) in table.rows.iter().enumerate() {
        if let Some(event) = events.get(n / names.len()) {
            let (more, count) = row(&table, cells, event);
            wrong.extend(more);
            tiny += count;
        }
    }
    (wrong, tiny)
}

#[test]
fn every_digit_of_every_table_is_found() {
    let files = std::fs::read_dir(folder("reference_data/gradients")).unwrap();
    let mut paths: Vec<_> = files.map(|it| it.unwrap().path()).collect();
    paths.retain(|it| it.extension().is_some_and(|it| it == "csv"));
    assert_eq!(paths.len(), CASES);
    let (mut wrong, mut tiny) = (Vec::new(), 0);
    for path in &paths {
        let (more, count) = check(path);
        wrong.extend(more);
        tiny += count;
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_eq!(tiny, UNPROVED_DERIVATIVES.0);
}
