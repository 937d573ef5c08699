//! The run in 106 bits against the proved digits of `reference_data/`.
//!
//! `cargo test --release --test harness replay:: -- --nocapture` prints what is reached.

use crate::exact;
use percuss::Start;
use percuss::TwoWord;
use percuss_validation::case::{Case, Given, SAMPLES_PER_PERIOD};
use percuss_validation::engine::{OscillatorTask, SampleGrid};
use percuss_validation::truth::{DoubleDouble, Library, Truth, TruthRow, Undecided};

/// The tables hold 25 significant digits, rounded to nearest, and at most 60 decimals.
const PRINTED_TOLERANCE: f64 = 0.5e-24;
/// They are read into two words in a dozen roundings.
const READING_TOLERANCE: f64 = 16.0 * DoubleDouble::UNIT;

/// k of |error| <= k u (1 + |value| + time) growth events, beyond the tables' own rounding, with
/// u = 2^-106. Ten-odd roundings per event would let it be ten; 0.13 is reached, where 25 digits do
/// not hide it.
const MAX_ROUNDINGS: f64 = 1.0;

struct Worst {
    units: f64,
    place: String,
}

fn prepared(case: &Case) -> (OscillatorTask, Truth) {
    let library = Library::embedded().expect("the manifest is read");
    let truth = library.truth(case).expect("the tables are there");
    let grid = SampleGrid { per_period: SAMPLES_PER_PERIOD, count: truth.samples.len() };
    (OscillatorTask::new(case.of_oscillator().expect("it is one"), grid), truth)
}

/// What is left of an error beyond the table's own digits, in units of 2^-106 (1 + |value| + time):
/// the time in a phase is a number of 106 bits too, and the speeds of these motions are about one.
fn units(found: TwoWord, proved: TwoWord, time: f64) -> f64 {
    let value = proved.value().abs();
    let error = found.minus(proved).value().abs();
    // Not a maximum, which would drop a NaN.
    let printed = PRINTED_TOLERANCE * value + READING_TOLERANCE * value + 0.5e-60;
    let left = if error <= printed { 0.0 } else { error - printed };
    left / (DoubleDouble::UNIT * (1.0 + value + time))
}

/// The place of a row: how many events came before, and how long ago the last of them was.
#[derive(Clone, Copy)]
struct Place {
    events: usize,
    time: f64,
}

/// The growth of tau, p, y, q and v.
fn growth_of(row: &TruthRow, time: f64) -> [f64; 5] {
    let [p, y, q, v] = row.growth[..] else { panic!("four states") };
    [time, p, y, q, v]
}

fn compare(
    (found, proved): (&TruthRow, &TruthRow),
    growth: &[f64; 5],
    Place { events, time }: Place,
    what: &str,
    worst: &mut Worst,
) {
    assert_eq!(found.mode, proved.mode, "{what}");
    let names = ["tau", "p", "y", "q", "v"];
    let values = |row: &TruthRow| {
        let [p, y, q, v] = row.state[..] else { panic!("four states") };
        [row.elapsed, p, y, q, v]
    };
    for (i, (found, proved)) in values(found).into_iter().zip(values(proved)).enumerate() {
        let units = units(found, proved, time) / (growth[i] * events as f64);
        if units > worst.units || units.is_nan() {
            *worst = Worst { units, place: format!("{} of {what}", names[i]) };
        }
    }
}

#[test]
fn every_proved_digit_of_every_case_is_met() {
    let mut worst = Worst { units: 0.0, place: "none".into() };
    let (mut events, mut samples) = (0, 0);
    for case in exact::of_oscillator() {
        let (task, truth) = prepared(&case);
        let grid = (task.grid.count, task.grid.per_period);
        let replayed = Truth::replayed(&task.parameters, &task.problem.entry, task.horizon, grid);
        let replayed = replayed.unwrap_or_else(|undecided| panic!("{}: {undecided}", case.name));
        let name = &case.name;
        let mut here = Worst { units: 0.0, place: "none".into() };
        assert_eq!(replayed.events.len(), truth.events.len(), "{name}");
        let mut begins = 0.0;
        for (n, (found, proved)) in replayed.events.iter().zip(&truth.events).enumerate() {
            let what = format!("switch {} of {name}", n + 1);
            let place = Place { events: n + 1, time: proved.elapsed.value() - begins };
            begins = proved.elapsed.value();
            compare(
                (found, proved),
                &growth_of(proved, proved.growth_time),
                place,
                &what,
                &mut here,
            );
        }
        let place = |row: &TruthRow| {
            let since = |switch: &TruthRow| row.elapsed.minus(switch.elapsed).value();
            let passed = truth.events.iter().take_while(|switch| since(switch) >= 0.0).count();
            let last = passed.checked_sub(1).map_or(&truth.start, |n| &truth.events[n]);
            Place { events: passed.max(1), time: since(last) }
        };
        for (k, rows) in replayed.samples.iter().zip(&truth.samples).enumerate() {
            let what = format!("sample {k} of {name}");
            compare(rows, &growth_of(rows.1, 1.0), place(rows.1), &what, &mut here);
        }
        let what = format!("end of {name}");
        let ends = (&replayed.end, &truth.end);
        compare(ends, &growth_of(&truth.end, 1.0), place(&truth.end), &what, &mut here);
        assert_eq!(replayed.samples.len(), truth.samples.len(), "{name}");
        (events, samples) = (events + truth.events.len(), samples + truth.samples.len());
        println!("{name}: {:.2} at {}", here.units, here.place);
        if here.units > worst.units || here.units.is_nan() {
            worst = here;
        }
    }
    println!("{events} events, {samples} samples: {:.2} at {}", worst.units, worst.place);
    assert!(worst.units <= MAX_ROUNDINGS, "{:.2} roundings: {}", worst.units, worst.place);
}

/// The first flight of a graze with its start moved by `shift`, which moves the margin as far.
fn graze(shift: f64) -> Result<usize, Undecided> {
    let case = exact::case("graze-miss-1e-12");
    let own = exact::problem(&case);
    let start = Start { p: own.start.p + shift, ..own.start };
    let given = Given { parameters: *own.model.parameters(), start, ..Given::default() };
    let entry = given.check().expect("the start is accepted").entry;
    let horizon = entry.instant.after_periods(5, 1);
    Truth::replayed(&given.parameters, &entry, horizon, (0, 1)).map(|truth| truth.events.len())
}

/// A graze that f64 cannot tell from a miss with room to spare has no truth here, and says so; one
/// that is ten times as far has.
#[test]
fn a_graze_within_the_rounding_room_is_undecided() {
    // The case misses by 1e-12 of its own units: the touch is found where the answers change.
    let (mut missing, mut hitting) = (0.0, 4e-12);
    let (missed, hit) = (graze(missing), graze(hitting));
    assert!(missed.is_ok() && hit.is_ok() && missed != hit, "{missed:?} {hit:?}");
    let mut undecided = None;
    while undecided.is_none() && hitting - missing > 1e-16 {
        let middle = 0.5 * (missing + hitting);
        match graze(middle) {
            Err(error) => undecided = Some((middle, error)),
            found if found == missed => missing = middle,
            _ => hitting = middle,
        }
    }
    let (touch, error) = undecided.expect("some margin is too small");
    assert!(error.to_string().contains("margin"), "{error}");
    println!("undecided at {touch:e}: {error}");
    // Sixteen times four eps of terms below one, and the step of the bisection.
    let room = 1e-13;
    assert_eq!((graze(touch - room), graze(touch + room)), (missed, hit));
}
