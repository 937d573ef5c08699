//! Random systems, looked at everywhere between their events by another method.

use super::{events, system};
use percuss::affine::{System, What};
use proptest::prelude::*;

/// exp(M t) z by scaling and a Taylor series, in plain f64.
fn advance(matrix: &[Vec<f64>], z: &[f64], time: f64) -> Vec<f64> {
    const TERMS: usize = 24;
    let size = matrix.iter().flatten().fold(0.0_f64, |size, it| size.max(it.abs()));
    let steps = (4.0 * size * time).ceil().max(1.0);
    let step = time / steps;
    let mut state = z.to_vec();
    for _ in 0..steps as usize {
        let (mut term, mut sum) = (state.clone(), state.clone());
        for k in 1..TERMS {
            term = matrix
                .iter()
                .map(|row| row.iter().zip(&term).map(|(a, b)| a * b).sum::<f64>())
                .map(|it| it * step / k as f64)
                .collect();
            sum.iter_mut().zip(&term).for_each(|(sum, term)| *sum += term);
        }
        state = sum;
    }
    state
}

fn rows(system: &System, mode: usize) -> Vec<Vec<f64>> {
    let rows = system.modes[mode].matrix.iter();
    rows.map(|row| row.iter().map(|it| it.to_f64()).collect()).collect()
}

fn value(row: &[percuss::affine::Rational], z: &[f64]) -> f64 {
    row.iter().zip(z).map(|(a, b)| a.to_f64() * b).sum()
}

fn text(a: [i32; 4], b: i32, stop: i32, e: i32, start: [i32; 2]) -> String {
    format!(
        "schema = 1
name = \"random\"
states = [\"x\", \"v\"]
forcing = {{ omega = 1.5, phi = 0.25 }}
[[mode]]
name = \"free\"
equations = [\"x' = {}*x/8 + v\", \"v' = {}*x/8 + {}*v/8 + {b}*cos/4 + {}/8\"]
[[mode.until]]
name = \"stop\"
guard = \"x > {stop}/8\"
reset = [\"x = {stop}/8\", \"v = -{e}*v/8 - {stop}*({})/64\"]
[[mode.watch]]
name = \"zero\"
guard = \"v > x\"
direction = \"both\"
[start]
mode = \"free\"
x = \"{}/8\"
v = \"{}/8\"
",
        a[0], a[1], a[2], a[3], a[0], start[0], start[1]
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn guards_are_negative_between_events_and_zero_at_them(
        a in [-4..2_i32, -24..9_i32, -9..3_i32, -6..7_i32],
        b in -9..10_i32, stop in 2..12_i32, e in 0..9_i32, start in [-9..2_i32, -9..10_i32],
    ) {
        let system = system(&text(a, b, stop, e, start));
        let until = 12.0;
        let events = events::<f64>(&system, until);
        let matrix = rows(&system, 0);
        let mode = &system.modes[0];
        let complete = |state: &[f64], time: f64| {
            let angle = 1.5 * time + 0.25;
            vec![state[0], state[1], angle.cos(), angle.sin(), 1.0]
        };
        let mut time = 0.0;
        let mut z = complete(&start.map(|it| f64::from(it) / 8.0), 0.0);
        for event in &events {
            let next = event.time.value();
            let size = z.iter().fold(1.0_f64, |size, it| size.max(it.abs()));
            // Growing motions amplify what rounding did in the comparison.
            let room = 1e-11 * size * (2.0 * (next - time)).exp().min(1e4);
            prop_assert!(next >= time && next <= until);
            let watched = value(&mode.watch[0].guard, &advance(&matrix, &z, 0.5 * (next - time)));
            for k in 1..400 {
                let at = advance(&matrix, &z, (next - time) * f64::from(k) / 400.0);
                prop_assert!(value(&mode.until[0].guard, &at) < room, "{time} {next} {k}");
                let other = value(&mode.watch[0].guard, &at);
                prop_assert!(other * watched > 0.0 || other.abs() < room, "{time} {next} {k}");
            }
            let end = advance(&matrix, &z, next - time);
            match event.what {
                What::Until(..) => prop_assert!(value(&mode.until[0].guard, &end).abs() < room),
                What::Watch(..) => prop_assert!(value(&mode.watch[0].guard, &end).abs() < room),
                What::Start | What::Limit(..) | What::End(_) => break,
            }
            time = next;
            z = complete(&event.state, time);
        }
    }
}

/// The last segment began nine units of time before the horizon: a sum with that is rounded.
#[test]
fn a_run_ends_at_its_horizon_to_the_last_digit() {
    let system = system(&text([-4, -7, -2, 0], -6, 9, 0, [-8, -7]));
    let events = events::<f64>(&system, 12.0);
    let time = events.last().map(|it| it.time);
    assert!(time.is_some_and(|it| it.high == 12.0 && it.low == 0.0), "{time:?}");
}
