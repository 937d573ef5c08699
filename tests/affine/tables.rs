//! Every proved table of a system, in f64 and in 106 bits.

use super::name;
use percuss::affine::DoubleDouble;
use percuss::affine::{Event, Solver, System, SystemFile};
use percuss::number::Number;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The largest error of an event in roundings, amplified by its growth: a segment takes some ten,
/// and the worst of all tables is 4.5.
const ROUNDINGS: f64 = 16.0;

struct Table {
    header: BTreeMap<String, String>,
    /// Event, mode, time, states, growth of the time, growths of the states.
    rows: Vec<Row>,
}

struct Row {
    event: String,
    mode: String,
    time: DoubleDouble,
    state: Vec<DoubleDouble>,
    growth_time: f64,
    growth: Vec<f64>,
}

fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// A decimal of up to 30 digits in two words: integer arithmetic of its digits in 106 bits.
fn decimal(text: &str) -> DoubleDouble {
    let (negative, digits) = match text.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, text),
    };
    let (mantissa, exponent) = digits.split_once('e').unwrap_or((digits, "0"));
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let exponent = exponent.parse::<i32>().unwrap() - i32::try_from(fraction.len()).unwrap();
    let ten = DoubleDouble::exact(10.0);
    let mut value = DoubleDouble::zero();
    for digit in whole.chars().chain(fraction.chars()) {
        value = value * ten + DoubleDouble::exact(f64::from(digit.to_digit(10).unwrap()));
    }
    for _ in 0..exponent.abs() {
        value = if exponent > 0 { value * ten } else { value / ten };
    }
    if negative { -value } else { value }
}

fn table(case: &str, states: usize) -> Table {
    let path = repository(&format!("reference_data/events/{case}.csv"));
    let text = std::fs::read_to_string(&path).unwrap();
    let (header, rows): (Vec<_>, Vec<_>) = text.lines().partition(|line| line.starts_with('#'));
    let header = header.iter().filter_map(|line| line[1..].split_once('='));
    let header = header.map(|(key, value)| (key.trim().to_owned(), value.trim().to_owned()));
    let row = |line: &&str| {
        let cells: Vec<_> = line.split(',').collect();
        let growth = &cells[5 + states..];
        Row {
            event: cells[1].to_owned(),
            mode: cells[2].to_owned(),
            time: decimal(cells[4]),
            state: cells[5..5 + states].iter().map(|it| decimal(it)).collect(),
            growth_time: growth[0].parse().unwrap(),
            growth: growth[1..].iter().map(|it| it.parse().unwrap()).collect(),
        }
    };
    Table { header: header.collect(), rows: rows[1..].iter().map(row).collect() }
}

/// The largest error of a run in units of rounding and growth.
fn worst_error<T: Number>(
    case: &str,
    system: &System,
    table: &Table,
    unit: f64,
    wide: fn(T) -> DoubleDouble,
) -> f64 {
    let backward = table.header.get("horizon.backward").is_some_and(|it| it == "true");
    let until = table.header["horizon.until"].parse().unwrap();
    let solver = if backward { Solver::<T>::backward(system) } else { Solver::<T>::new(system) };
    let solver = solver.unwrap();
    let start = system.start.as_ref().unwrap();
    let events: Vec<Event<T>> = solver.run(start, T::exact(until)).unwrap().collect();
    let found: Vec<_> = events.iter().map(|it| name(system, it)).collect();
    let expected: Vec<_> = table.rows[1..].iter().map(|it| it.event.clone()).collect();
    assert_eq!(found, expected, "{case}");
    let mut worst = 0.0;
    for (n, (event, row)) in events.iter().zip(&table.rows[1..]).enumerate() {
        assert_eq!(system.modes[event.mode].name, row.mode, "{case}, row {}", n + 1);
        let roundings = unit * (n + 1) as f64;
        let time = (wide(event.time.high) + wide(event.time.low) - row.time).abs().to_f64()
            / system.time_scale;
        let size = 1.0 + row.time.to_f64().abs() / system.time_scale;
        worst = f64::max(worst, time / (roundings * size * row.growth_time));
        let states = event.state.iter().zip(&row.state).zip(&row.growth).zip(&system.scales);
        for (((state, exact), growth), scale) in states {
            let error = (wide(*state) - *exact).abs().to_f64() / scale;
            let size = 1.0 + exact.to_f64().abs() / scale;
            worst = f64::max(worst, error / (roundings * size * growth.max(row.growth_time)));
        }
    }
    worst
}

/// Half a unit of the last of 25 digits.
pub(super) fn last_half_unit(value: DoubleDouble) -> f64 {
    5.1e-25 * value.to_f64().abs() + 1e-40
}

/// The events of a run that follows its errors, each of which is smaller than said; how many there
/// are, and the largest error of a time.
fn enclosed_events<T: Number<Bound = f64>>(
    case: &str,
    system: &System,
    table: &Table,
    wide: fn(T) -> DoubleDouble,
) -> (usize, f64) {
    let backward = table.header.get("horizon.backward").is_some_and(|it| it == "true");
    let until = table.header["horizon.until"].parse().unwrap();
    let solver = if backward { Solver::<T>::backward(system) } else { Solver::<T>::new(system) };
    let solver = solver.unwrap();
    let run = solver.run_enclosed(system.start.as_ref().unwrap(), T::exact(until)).unwrap();
    let mut largest = 0.0;
    let mut count = 0;
    for (event, row) in run.zip(&table.rows[1..]) {
        if name(system, &event) == "undecided" {
            break;
        }
        assert_eq!(name(system, &event), row.event, "{case}, row {}", count + 1);
        let errors = event.errors.unwrap();
        let off = (wide(event.time.high) + wide(event.time.low) - row.time).abs().to_f64();
        assert!(
            off <= errors.time + last_half_unit(row.time),
            "{case} {count}: {off:e} {errors:?}"
        );
        for ((state, exact), error) in event.state.iter().zip(&row.state).zip(&errors.state) {
            let off = (wide(*state) - *exact).abs().to_f64();
            assert!(off <= error + last_half_unit(*exact), "{case} {count}: {off:e} {error:e}");
        }
        largest = f64::max(largest, errors.time);
        count += 1;
    }
    (count, largest)
}

#[test]
fn errors_are_smaller_than_an_enclosed_run_says() {
    let (mut whole, mut all) = (0, 0);
    for (case, system) in cases() {
        let table = table(&case, system.states.len());
        let narrow = enclosed_events(&case, &system, &table, DoubleDouble::exact);
        let wide = enclosed_events(&case, &system, &table, |it: DoubleDouble| it);
        println!("{case}: {} of {}, {narrow:?} {wide:?}", wide.0, table.rows.len() - 1);
        all += 1;
        whole += usize::from(wide.0 == table.rows.len() - 1);
        assert!(wide.1 < 1e-12, "{case}");
    }
    // Exact touches and ties are what no arithmetic of so many bits can decide.
    assert!(whole >= all - 12, "{whole} of {all}");
}

#[test]
fn every_proved_table_is_reproduced() {
    let mut count = 0;
    let mut failed = Vec::new();
    for (case, system) in cases() {
        let table = table(&case, system.states.len());
        let outcome = std::panic::catch_unwind(|| {
            let narrow =
                worst_error(&case, &system, &table, 0.5 * f64::EPSILON, DoubleDouble::exact);
            // Tables hold 25 digits.
            let wide = worst_error(&case, &system, &table, DoubleDouble::UNIT.max(1e-25), |it| it);
            println!("{case}: {narrow:.2} {wide:.2}");
            narrow.max(wide)
        });
        if !outcome.as_ref().is_ok_and(|it| *it <= ROUNDINGS) {
            failed.push((case, outcome.unwrap_or(f64::NAN)));
        }
        count += 1;
    }
    assert!(failed.is_empty() && count >= 79, "{failed:?}");
}

/// The errors of all times in f64, over growth, in roundings.
fn time_errors(system: &System, table: &Table) -> Vec<f64> {
    let backward = table.header.get("horizon.backward").is_some_and(|it| it == "true");
    let until = table.header["horizon.until"].parse().unwrap();
    let solver = if backward { Solver::backward(system) } else { Solver::<f64>::new(system) };
    let solver = solver.unwrap();
    let events = solver.run(system.start.as_ref().unwrap(), until).unwrap();
    let off = |(event, row): (Event<f64>, &Row)| {
        let time = DoubleDouble::exact(event.time.high) + DoubleDouble::exact(event.time.low);
        let off = (time - row.time).abs().to_f64() / system.time_scale;
        off / (0.5 * f64::EPSILON * row.growth_time)
    };
    events.zip(&table.rows[1..table.rows.len() - 1]).map(off).collect()
}

/// The mean is 1.2 and the worst 15. Each of three changes for the worse raised it by a third to
/// four fifths: to add each entry of a nilpotent matrix to its co-ordinate by itself, to do so with
/// all powers of the time, and to leave out the rest of the way to a crossing, by the value of its
/// guard. Left out is relay-chatter-fine, whose errors are a random walk of 179 steps in a
/// direction without restoring force: where it ends is chance. Over a thousand starts beside its
/// own, 0.0001 apart, its mean is 430 roundings, or 409 where crossings are not proved by Taylor
/// polynomials.
#[test]
fn times_are_good_to_two_roundings() {
    let all = cases().into_iter().filter(|(case, _)| case != "relay-chatter-fine");
    let errors = all.flat_map(|(case, system)| {
        let table = table(&case, system.states.len());
        time_errors(&system, &table)
    });
    let errors: Vec<_> = errors.collect();
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    let worst = errors.iter().fold(0.0, |most: f64, it| most.max(*it));
    println!("{} events: {mean:.3} roundings in the mean, {worst:.1} at most", errors.len());
    assert!(errors.len() > 2000 && mean < 1.6 && worst < 24.0, "{mean} {worst}");
}

/// Every case of a system, with its parameters and start.
fn cases() -> Vec<(String, System)> {
    let folder = std::fs::read_dir(repository("validation/cases/systems")).unwrap();
    let mut paths: Vec<_> = folder.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let case = |path: &PathBuf| {
        let case = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let text = std::fs::read_to_string(path).unwrap();
        let line = text.lines().find_map(|line| line.strip_prefix("system = ")).unwrap();
        let file = format!("validation/systems/{}.system.toml", line.trim_matches('"'));
        let system = std::fs::read_to_string(repository(&file)).unwrap();
        let mut file = SystemFile::read(&file, &system).unwrap();
        file.replace_from(&case, &text, true).unwrap();
        (case, file.system().unwrap())
    };
    paths.iter().map(case).collect()
}
