//! The programs of `examples/` write what they say.

#[allow(dead_code, reason = "main is the program's")]
#[path = "../examples/basin_labels.rs"]
mod basin_labels;
#[allow(dead_code, reason = "main is the program's")]
#[path = "../examples/dense_output.rs"]
mod dense_output;
#[allow(dead_code, reason = "main is the program's")]
#[path = "../examples/ensemble.rs"]
mod ensemble;
#[allow(dead_code, reason = "main is the program's")]
#[path = "../examples/judge_steps.rs"]
mod judge_steps;
#[allow(dead_code, reason = "main is the program's")]
#[path = "../examples/motion_csv.rs"]
mod motion_csv;
#[allow(dead_code, reason = "main is the program's")]
#[path = "../examples/orbit_multipliers.rs"]
mod orbit_multipliers;
#[allow(dead_code, reason = "main is the program's")]
#[path = "../examples/own_system.rs"]
mod own_system;
#[allow(dead_code, reason = "main is the program's")]
#[path = "../examples/poincare_npy.rs"]
mod poincare_npy;
#[allow(dead_code, reason = "main is the program's")]
#[path = "../examples/section_csv.rs"]
mod section_csv;
#[allow(dead_code, reason = "main is the program's")]
#[path = "../examples/trajectory_csv.rs"]
mod trajectory_csv;

use percuss::{Model, Parameters, Start};
use std::error::Error;

/// The text that an example program writes.
fn text(write: impl FnOnce(&mut Vec<u8>) -> Result<(), Box<dyn Error>>) -> String {
    let mut out = Vec::new();
    write(&mut out).unwrap();
    String::from_utf8(out).unwrap()
}

fn numbers(row: &str) -> Vec<f64> {
    row.split(',').filter_map(|cell| cell.parse().ok()).collect()
}

#[test]
fn the_events_of_table_1_are_written() {
    let csv = text(|out| trajectory_csv::write(out));
    let rows: Vec<&str> = csv.lines().collect();
    assert_eq!(rows[0], "phase,tau,p,y,q,v");
    assert_eq!(rows.len(), 1 + 80);
    assert!(rows[1].starts_with("no-contact,0,0,0,"), "{}", rows[1]);
    assert!((numbers(rows[2])[0] - 0.654_212).abs() < 1e-6, "{}", rows[2]);
    // The first row of Table 1, as printed: tau, p, y.
    let first = rows[rows.len() - 9];
    assert!(first.starts_with("contact,"), "{first}");
    let printed = [1142.28514, 0.02, 4.58005];
    assert!(numbers(first).iter().zip(printed).all(|(a, b)| (a - b).abs() <= 5e-6), "{first}");
    let times: Vec<f64> = rows[1..].iter().map(|row| numbers(row)[0]).collect();
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]) && times[79] < 1268.0);
}

#[test]
fn dense_output_begins_where_the_phase_before_ends() {
    let csv = text(|out| dense_output::write(out));
    let rows: Vec<Vec<f64>> = csv.lines().skip(1).map(numbers).collect();
    let model = Model::new(Parameters::default()).unwrap();
    let rest = model.start(&Start::default()).unwrap();
    let segments: Vec<_> = model.trajectory(rest).for_periods(20).collect();
    assert_eq!(rows.len(), 8 * segments.len());
    for (before, first) in segments.iter().zip(rows.iter().skip(8).step_by(8)) {
        let end = before.at(before.duration());
        let end = [end.state.p, end.state.y, end.state.q, end.v];
        assert!(end.iter().zip(&first[1..]).all(|(a, b)| (a - b).abs() <= 1e-12), "{first:?}");
    }
    let last = rows[rows.len() - 1][0];
    let end = 20.0 * std::f64::consts::TAU / 1.4;
    assert!(last < end && last > end - std::f64::consts::TAU / 1.4, "{last}");
    assert!(rows.windows(2).all(|pair| pair[0][0] < pair[1][0]));
}

#[test]
fn a_section_is_an_array_of_two_columns() {
    let mut out = Vec::new();
    poincare_npy::write(&mut out, 50).unwrap();
    let array = npyz::NpyFile::new(&out[..]).unwrap();
    assert_eq!(array.shape(), [50, 2]);
    let points: Vec<f64> = array.into_vec().unwrap();
    assert!(points.iter().all(|it| it.abs() < 10.0) && points[0] != points[2]);
}

#[test]
fn orbits_are_written_with_their_multipliers() {
    let lines = text(|out| orbit_multipliers::write(out));
    assert!(lines.starts_with("period 1, "), "{lines}");
    let stable: Vec<_> = lines.lines().filter(|line| line.contains(", stable:")).collect();
    assert!(stable.len() == 1 && stable[0].starts_with("period 5"), "{lines}");
    assert!(lines.contains("unstable") && lines.contains("0.000000]"), "{lines}");
}

#[test]
fn basins_are_drawn_and_add_up() {
    let lines = text(|out| basin_labels::write(out));
    let drawn: Vec<&str> = lines.lines().take(24).collect();
    assert!(drawn.iter().all(|row| row.chars().count() == 60), "{lines}");
    let shares = lines.lines().skip(24).filter_map(|line| line.split(", ").nth(1));
    let shares = shares.filter_map(|it| it.split(' ').next()?.parse::<f64>().ok());
    let labelled = drawn.concat().chars().filter(|it| it.is_alphabetic()).count() as f64;
    let expected = 100.0 * labelled / (24.0 * 60.0);
    let sum: f64 = shares.sum();
    // Each share is rounded to a tenth.
    assert!((sum - expected).abs() <= 0.05 * lines.lines().skip(24).count() as f64, "{lines}");
}

#[test]
fn the_block_sticks_and_slips_on_its_belt() {
    let text = text(|out| own_system::write(out));
    let rows: Vec<Vec<&str>> =
        text.lines().skip(1).map(|row| row.split_whitespace().collect()).collect();
    assert_eq!(rows.len(), 8);
    let names: Vec<&str> = rows.iter().map(|row| row[0]).collect();
    assert_eq!(names, ["slip", "stick"].repeat(4));
    // It sticks from 0 to 1 with the belt's speed 1/2, and slips by the closed form of x about 1/4
    // with the amplitude of (3/4, 1/2), until v is 1/2 again at the mirrored x.
    assert_eq!((rows[0][2], rows[0][3]), ("2.0000000000000000", "1.0000000000000000"));
    let angle = 2.0 * (std::f64::consts::PI - f64::atan(0.75 / 0.5));
    assert!((rows[1][2].parse::<f64>().unwrap() - (2.0 + angle)).abs() < 1e-14, "{text}");
    assert_eq!(rows[1][3], "-0.50000000000000000");
}

#[test]
fn the_motion_of_a_ball_is_its_parabola() {
    let system = percuss::System::from_toml(percuss::gallery::BOUNCING_BALL).unwrap();
    let csv = text(|out| motion_csv::write(&system, 3.0, 16, out));
    let rows: Vec<Vec<&str>> = csv.lines().map(|row| row.split(',').collect()).collect();
    assert_eq!(rows[0], ["what", "mode", "time", "x", "v"]);
    let samples = rows.iter().filter(|row| row[0] == "sample").count();
    assert_eq!(samples, 3 * 16 + 1);
    for row in rows[1..].iter().filter(|row| row[0] == "sample") {
        let [time, x, v] = [2, 3, 4].map(|n| row[n].parse::<f64>().unwrap());
        if time < 2_f64.sqrt() {
            assert!((x - (1.0 - 0.5 * time * time)).abs() < 1e-15 && v == -time, "{row:?}");
        }
    }
    assert_eq!(rows.iter().filter(|row| row[0] == "impact").count(), 2);
}

#[test]
fn the_section_lies_before_the_stop() {
    let csv = text(|out| section_csv::write(100, 50, out));
    let rows: Vec<Vec<f64>> = csv.lines().skip(1).map(numbers).collect();
    assert_eq!(rows.len(), 50);
    assert!(rows.iter().all(|row| row.len() == 2 && row[0] <= 0.125 && row[0].abs() < 2.0));
}

#[test]
fn warmer_rooms_switch_sooner() {
    let times = ensemble::first_switches(&[0.0, 5.0, 10.0, 15.0, 20.0]).unwrap();
    assert!(times.windows(2).all(|pair| pair[0] > pair[1]), "{times:?}");
    let system = percuss::System::from_toml(percuss::gallery::THERMOSTAT).unwrap();
    let solver = system.solver::<percuss::Proved>().unwrap();
    let start = system.start_at("on", 0.0, &[15.0, 15.0]).unwrap();
    let proved = solver.run_from(&start).events(1).unwrap().next().unwrap();
    assert!((proved.time().midpoint() - times[3]).abs() < 1e-13);
}

#[test]
fn long_steps_pass_over_contacts() {
    let short = judge_steps::judge(0.01, 20.0).unwrap();
    assert_eq!(short.found, short.events, "{short:?}");
    assert!(short.error < 1e-4, "{short:?}");
    let long = judge_steps::judge(0.5, 20.0).unwrap();
    assert!(long.found < long.events, "{long:?}");
}
