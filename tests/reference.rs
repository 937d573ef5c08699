//! The solver against the proved tables of `reference_data/`.

use crate::support::reference::{self, Row, Table, tables};
use percuss::TwoWord;
use percuss::{Entry, GrowthRecorder, Instant, Model, Segment, Trajectory};

/// k of the bound |error| <= k eps (1 + |value|) growth switches. Ten roundings a switch is the
/// promise; what is reached is printed, and stands in METHODOLOGY.md.
const ROUNDINGS_PER_SWITCH: f64 = 10.0;

fn run(table: &Table) -> (Model, Entry, Trajectory) {
    let model = Model::new(table.parameters).unwrap();
    let entry = model.start(&table.start).unwrap();
    let horizon = match table.horizon() {
        Ok(periods) => entry.instant.after_periods(periods, 1),
        Err(until) => Instant::at(table.parameters.omega, until, 0),
    };
    (model, entry, model.trajectory(entry).until(horizon))
}

/// The error in units of eps (1 + |value|) growth switches.
fn units(found: f64, row: TwoWord, growth: f64, switches: usize) -> f64 {
    let error = TwoWord::new(found).minus(row).value().abs();
    error / (f64::EPSILON * (1.0 + row.high.abs()) * growth * switches as f64)
}

struct Worst {
    units: f64,
    place: String,
}

impl Worst {
    fn take(&mut self, units: f64, place: impl Fn() -> String) {
        if units > self.units || units.is_nan() {
            *self = Self { units, place: place() };
        }
    }
}

fn compare(
    entry: &Entry,
    start: &Entry,
    omega: f64,
    row: &Row,
    growth: &percuss::Growth,
    n: usize,
) -> [(&'static str, f64); 5] {
    let elapsed = entry.instant.since(&start.instant, omega).value();
    let [p, y, q] = row.state;
    let [growth_p, growth_y, growth_q] = growth.state;
    [
        ("tau", units(elapsed, row.elapsed, growth.tau, n)),
        ("p", units(entry.state.p, p, growth_p, n)),
        ("y", units(entry.state.y, y, growth_y, n)),
        ("q", units(entry.state.q, q, growth_q, n)),
        ("v", units(entry.v(), row.v, growth.v, n)),
    ]
}

#[test]
fn every_switch_of_every_case_is_within_ten_roundings() {
    let mut worst = Worst { units: 0.0, place: String::new() };
    let mut switches = 0;
    for table in tables("events") {
        let (_, start, trajectory) = run(&table);
        let mut growth = GrowthRecorder::new();
        let mut rows = table.rows.iter().skip(1);
        assert_eq!(Some(start.phase()), table.rows[0].phase(), "{}", table.name);
        let omega = table.parameters.omega;
        for (n, segment) in trajectory.enumerate() {
            let row =
                rows.next().unwrap_or_else(|| panic!("{}: switch {n} is spurious", table.name));
            let percuss::Exit::Switch(next) = segment.exit() else {
                assert_eq!(row.phase(), None, "{}: switch {} is missed", table.name, n + 1);
                break;
            };
            let growth = growth.pass(&segment).unwrap();
            assert_eq!(Some(next.phase()), row.phase(), "{}: switch {}", table.name, n + 1);
            for (name, units) in compare(next, &start, omega, row, &growth, n + 1) {
                if units > 1.0 {
                    println!("{} {} {name} {units:.2}", table.name, n + 1);
                }
                worst.take(units, || format!("{} of switch {} of {}", name, n + 1, table.name));
            }
            switches += 1;
        }
        assert!(rows.next().is_none(), "{}: switches are missed at the end", table.name);
    }
    println!("{switches} switches, worst {:.2} at {}", worst.units, worst.place);
    assert!(worst.units <= ROUNDINGS_PER_SWITCH, "{:.2} roundings: {}", worst.units, worst.place);
}

#[test]
fn every_sample_of_every_case_is_within_ten_roundings() {
    let mut worst = Worst { units: 0.0, place: String::new() };
    for table in tables("samples") {
        let (_, start, trajectory) = run(&table);
        let mut segments = trajectory;
        let mut growth = GrowthRecorder::new();
        let mut segment: Segment = segments.next().unwrap();
        let mut switches = 1;
        for (k, row) in table.rows.iter().enumerate() {
            let instant = start.instant.after_periods(k as u64, 8);
            while segment.ends_by(&instant) {
                growth.pass(&segment).unwrap();
                segment = segments.next().unwrap();
                switches += 1;
            }
            let sample = segment.at_instant(&instant);
            let elapsed = instant.since(&segment.entry().instant, table.parameters.omega).value();
            let growth = growth.at(&segment, elapsed);
            let found = [sample.state.p, sample.state.y, sample.state.q, sample.v];
            let truth = [row.state[0], row.state[1], row.state[2], row.v];
            let growths = [growth.state[0], growth.state[1], growth.state[2], growth.v];
            for i in 0..4 {
                let units = units(found[i], truth[i], growths[i], switches);
                worst.take(units, || {
                    format!("{} of sample {k} of {}", ["p", "y", "q", "v"][i], table.name)
                });
            }
        }
    }
    println!("samples: worst {:.2} at {}", worst.units, worst.place);
    assert!(worst.units <= ROUNDINGS_PER_SWITCH, "{:.2} roundings: {}", worst.units, worst.place);
}

/// One unit of the last printed digit of Table 1.
const PRINTED_DIGIT: f64 = 1e-5;

fn table_1() -> Vec<[f64; 4]> {
    let text = std::fs::read_to_string(reference::folder("table1.csv")).unwrap();
    let number = |cell: &str| cell.parse().unwrap();
    text.lines()
        .filter(|line| !line.starts_with('#'))
        .skip(1)
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            std::array::from_fn(|i| number(cells[2 + i]))
        })
        .collect()
}

fn largest_difference(entry: &Entry, row: &[f64; 4]) -> f64 {
    let found = [entry.instant.tau(0.1), entry.state.p, entry.state.y, entry.state.q];
    found.iter().zip(row).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn model_of_table_1() -> Model {
    Model::new(percuss::Parameters { omega: 0.1, ..Default::default() }).unwrap()
}

#[test]
fn table_1_appears_from_rest() {
    let model = model_of_table_1();
    let rest = model.start(&percuss::Start::default()).unwrap();
    let rows = table_1();
    let found: Vec<Entry> = model
        .trajectory(rest)
        .map(|segment| *segment.entry())
        .skip_while(|entry| entry.instant.tau(0.1) < rows[0][0] - 1.0)
        .take(rows.len())
        .collect();
    assert_eq!(rows.len(), 9);
    for (entry, row) in found.iter().zip(&rows) {
        let difference = largest_difference(entry, row);
        assert!(difference <= PRINTED_DIGIT, "{difference:e} at {row:?}");
    }
}

#[test]
fn table_1_follows_from_its_first_row_as_printed() {
    let model = model_of_table_1();
    let rows = table_1();
    let [tau, p, y, q] = rows[0];
    let start = percuss::Start { tau, p, y, q: Some(q), ..Default::default() };
    let first = model.start(&start).unwrap();
    assert_eq!(first.phase(), percuss::Phase::Contact);
    for (segment, row) in model.trajectory(first).zip(&rows) {
        // Half a unit of the first row's last digit, grown along the orbit, and half of this row's.
        let difference = largest_difference(segment.entry(), row);
        assert!(difference <= 2.0 * PRINTED_DIGIT, "{difference:e} at {row:?}");
    }
}
