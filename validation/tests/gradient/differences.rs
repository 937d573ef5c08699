//! Derivatives against differences of runs of `events --digits 25`, which know nothing of them.
//!
//! Differences over a step and over a quarter of it are off by h^2 f'''/6 and a sixteenth of that:
//! so their extrapolation is good to the fourth order, and the first ones show that the error is
//! that of the differences.

use crate::support::{rows, stdout};

/// The share of a name's value that is the larger step: a power of two.
const STEP_SHARE: f64 = 1.0 / (1 << 18) as f64;

/// The unit of fixed-point numbers: beyond the last of the 25 digits of what is of order 1.
const DECIMAL_PLACES: i32 = 30;

/// A printed number in units of 10^-30; a number below the last of its digits is zero.
fn fixed(text: &str) -> i128 {
    let (digits, exponent) = text.split_once('e').unwrap_or((text, "0"));
    let exponent: i32 = exponent.parse().expect("an exponent");
    let (whole, part) = digits.split_once('.').unwrap_or((digits, ""));
    let mut number: i128 = format!("{whole}{part}").parse().expect("digits");
    let shift = DECIMAL_PLACES + exponent - part.len() as i32;
    let ten = |power: i32| 10_i128.checked_pow(power as u32);
    if shift < 0 {
        number = ten(-shift).map_or(0, |it| number / it);
    } else if number != 0 {
        number *= ten(shift).expect("a number of order 1");
    }
    number
}

fn to_f64(fixed: i128) -> f64 {
    fixed as f64 / 10_f64.powi(DECIMAL_PLACES)
}

/// Times and states of the events of a run whose name has a value.
fn events(system: &[&str], name: &str, value: f64) -> Vec<Vec<i128>> {
    let (flag, name) = match name.strip_prefix("start.") {
        Some(state) => ("--at", state),
        None => ("--set", name),
    };
    let set = format!("{name}={value:?}");
    let words = [&["events"], system, &["--digits", "25", flag, &set]].concat();
    let cells =
        |row: &Vec<String>| [&row[1..2], &row[4..]].concat().iter().map(|it| fixed(it)).collect();
    rows(&stdout(&words)).iter().map(cells).collect()
}

/// Holds the derivatives by a name, which has this value, against differences.
fn hold(system: &[&str], name: &str, value: f64) {
    let words = [&["gradient"], system, &["--digits", "25", "--wrt", name]].concat();
    let found = rows(&stdout(&words));
    let size = if value == 0.0 { 1.0 } else { value.abs() };
    let step = 2_f64.powi((STEP_SHARE * size).log2().floor() as i32);
    let differences = |step: f64| {
        let [above, below] = [step, -step].map(|it| events(system, name, value + it));
        assert_eq!(above.len(), found.len(), "{name}: a step changes the events");
        let cell = move |(a, b): (&i128, &i128)| to_f64(a - b) / (2.0 * step);
        let row =
            move |(a, b): (&Vec<i128>, &Vec<i128>)| a.iter().zip(b).map(cell).collect::<Vec<f64>>();
        above.iter().zip(&below).map(row).collect::<Vec<_>>()
    };
    let [far, near] = [step, step / 4.0].map(differences);
    let values = events(system, name, value);
    for (n, row) in found.iter().enumerate() {
        let own: Vec<f64> = row[5..].iter().map(|it| to_f64(fixed(it))).collect();
        let largest = own.iter().map(|it| it.abs()).fold(0.0, f64::max);
        for k in 0..own.len() {
            let extrapolated = (16.0 * near[n][k] - far[n][k]) / 15.0;
            let off = (extrapolated - own[k]).abs();
            // An f64 holds 16 digits, three are left for what the steps amplify: the fourth order
            // is far below. Zeros of one cell are held beside the row.
            let room = 1e-13 * (own[k].abs() + to_f64(values[n][k]).abs() / size);
            assert!(
                off <= room + 1e-15 * largest,
                "{name}, row {n}, cell {k}: {} {} {extrapolated}",
                row[5 + k],
                near[n][k]
            );
        }
    }
    // The smaller step is the better one, unless both are as good as f64 is.
    let error = |all: &[Vec<f64>]| {
        let cells = |(own, row): (&Vec<String>, &Vec<f64>)| {
            let pairs = own[5..].iter().zip(row);
            pairs.map(|(a, b)| (to_f64(fixed(a)) - b).abs()).fold(0.0, f64::max)
        };
        found.iter().zip(all).map(cells).fold(0.0, f64::max)
    };
    let [far, near] = [error(&far), error(&near)];
    let scale = found.iter().flat_map(|row| &row[5..]).map(|it| to_f64(fixed(it)).abs());
    let scale = scale.fold(0.0, f64::max);
    assert!(near <= far / 8.0 || far <= 1e-14 * scale, "{name}: {far:e} {near:e} {scale:e}");
}

#[test]
fn of_a_bouncing_ball() {
    let ball = ["bouncing-ball", "--until", "2.4"];
    [("g", 2.0), ("e", 0.5), ("start.v", 1.5)]
        .into_iter()
        .for_each(|(name, value)| hold(&ball, name, value));
}

#[test]
fn of_a_relay() {
    let relay = ["relay-feedback", "--until", "3"];
    [("delta", 0.01), ("k", 0.0), ("start.x3", 0.0)]
        .into_iter()
        .for_each(|(name, value)| hold(&relay, name, value));
}

#[test]
fn of_a_latched_converter() {
    let buck = ["buck-converter-latched", "--events", "4"];
    [("Vin", 32.5), ("R", 22.0), ("gain", 8.4)]
        .into_iter()
        .for_each(|(name, value)| hold(&buck, name, value));
}

#[test]
fn of_the_percussive_oscillator() {
    let drill = ["percussive-oscillator", "--until", "12"];
    [("a", 0.3), ("xi", 0.01), ("frequency", 1.4)]
        .into_iter()
        .for_each(|(name, value)| hold(&drill, name, value));
}

#[test]
fn of_a_mass_at_a_rigid_stop() {
    let stop = ["rigid-impact-oscillator", "--until", "6"];
    [("d", 0.125), ("r", 0.75), ("start.x", 0.0)]
        .into_iter()
        .for_each(|(name, value)| hold(&stop, name, value));
}

#[test]
fn printed_numbers_are_read_exactly() {
    assert_eq!(fixed("-0.75"), -75 * 10_i128.pow(28));
    assert_eq!([fixed("0e-28"), fixed("0")], [0, 0]);
    assert_eq!(fixed("1.25e-3"), 125 * 10_i128.pow(25));
}
