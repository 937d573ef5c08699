//! Horizons that cut a run at an entry or next to a switch.

use percuss::TwoWord;
use percuss::{Exit, Model, Parameters, Start, Step};

fn from_rest(parameters: Parameters, p: f64) -> (Model, percuss::Entry) {
    let model = Model::new(parameters).unwrap();
    let entry = model.start(&Start { p, ..Start::default() }).unwrap();
    (model, entry)
}

#[test]
fn a_run_that_is_over_at_once_is_cut_even_if_it_never_ended() {
    let (model, entry) = from_rest(Parameters { b: -0.1, ..Parameters::default() }, -1.0);
    let segment = model.trajectory(entry).next().unwrap();
    assert!(matches!(segment.exit(), Exit::Endless(_)));
    let segment = model.trajectory(entry).until(entry.instant).next().unwrap();
    assert!(matches!(segment.exit(), Exit::Horizon) && segment.duration() == 0.0, "{segment:?}");
}

#[test]
fn a_switch_counts_up_to_the_horizon_and_no_later() {
    let omega = Parameters::default().omega;
    let (model, entry) = from_rest(Parameters::default(), 0.0);
    let segments: Vec<_> = model.trajectory(entry).take(60).collect();
    for segment in &segments {
        let Exit::Switch(next) = segment.exit() else { unreachable!("the run goes on") };
        for part in [0.0, 1e-30, 1e-25, 1e-20, 1e-18, 1e-17, 1e-16, 1e-14, 1e-12, 1e-9] {
            let later = next.instant.after(TwoWord::new(part), omega);
            let mut run = model.trajectory(*segment.entry()).until(later);
            let first = run.next().unwrap();
            // Looked for from a horizon's side a root may have other last digits, of 18 at most
            // here.
            assert!((first.duration() - segment.duration()).abs() <= 1e-13);
            let counts = matches!(first.exit(), Exit::Switch(_));
            assert!(counts || part <= 1e-14, "{part}: {first:?}");
            if counts {
                let second = run.next().unwrap();
                assert!(second.duration() >= 0.0, "{part}: {}", second.duration());
            }
        }
        let before = segment.entry().instant.after(TwoWord::new(0.999 * segment.duration()), omega);
        let cut = model.trajectory(*segment.entry()).until(before).next().unwrap();
        assert!(matches!(cut.exit(), Exit::Horizon), "{cut:?}");
        assert!((cut.duration() - 0.999 * segment.duration()).abs() <= 4e-16 * segment.duration());
    }
}

#[test]
fn steps_are_what_iterating_gives() {
    let (model, entry) = from_rest(Parameters::default(), 0.0);
    let horizon = entry.instant.after_periods(40, 1);
    let mut run = model.trajectory(entry).until(horizon);
    for segment in model.trajectory(entry).until(horizon) {
        match (run.step().unwrap(), segment.exit()) {
            (Step::Switch { duration, next }, exit) => {
                assert_eq!(Exit::Switch(*next), *exit);
                assert_eq!(duration.value(), segment.duration());
            }
            (Step::Last(last), exit) => {
                assert_eq!(last.exit(), exit);
                assert_eq!(last.at_instant(&horizon), segment.at_instant(&horizon));
            }
        }
    }
    assert!(run.step().is_none());
}

/// A mass without any force on it.
fn drifting(p: f64, y: f64) -> (Model, percuss::Entry) {
    let parameters = Parameters { a: 0.0, b: 0.0, g: 0.0, ..Parameters::default() };
    let model = Model::new(parameters).unwrap();
    let entry = model.start(&Start { p, y, ..Start::default() }).unwrap();
    (model, entry)
}

#[test]
fn a_phase_that_outlasts_all_angles_is_cut() {
    for y in [1e-100, 1e-155, 1e-200, 5e-324] {
        let (model, entry) = drifting(-1.0, y);
        let segment = model.trajectory(entry).next().unwrap();
        assert!(matches!(segment.exit(), Exit::Horizon), "{y:e}: {segment:?}");
        assert_eq!(segment.duration(), 1e30 / model.parameters().omega);
    }
}

#[test]
fn iterating_and_stepping_take_turns() {
    let (model, entry) = from_rest(Parameters::default(), 0.0);
    let horizon = entry.instant.after_periods(20, 1);
    let segments: Vec<_> = model.trajectory(entry).until(horizon).collect();
    let mut run = model.trajectory(entry).until(horizon);
    for (k, segment) in segments.iter().enumerate() {
        let mut other = run.clone();
        let (duration, last) = match run.step().unwrap() {
            Step::Switch { duration, .. } => (duration, false),
            Step::Last(last) => (last.duration_two_word(), true),
        };
        let same = other.next().unwrap();
        assert_eq!((duration, same.duration_two_word()), (segment.duration_two_word(), duration));
        assert_eq!(same.exit(), segment.exit());
        assert_eq!(last, k + 1 == segments.len());
        // Either may go on.
        if k % 3 == 0 {
            run = other;
        }
    }
    assert!(run.step().is_none() && run.next().is_none() && run.step().is_none());
}

/// Models of every kind of damping and forcing, from a fixed sequence of numbers.
fn models() -> impl Iterator<Item = (Parameters, Start)> {
    let mut seed = 0x2545_f491_4f6c_dd1d_u64;
    let mut unit = move || {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    std::iter::repeat_with(move || {
        let xi = (-6.0 + 8.0 * unit()).exp();
        let omega = (-2.5 + 4.5 * unit()).exp();
        let (a, b, g) = (2.0 * unit(), 0.02 + unit(), 0.3 * unit());
        let q = unit();
        let p = q + g - if unit() < 0.5 { 0.0 } else { unit() };
        let start =
            Start { p, y: 2.0 * unit() - 1.0, q: Some(q), tau: 10.0 * unit(), ..Start::default() };
        (Parameters { a, b, xi, omega, g, ..Parameters::default() }, start)
    })
}

/// A switch exactly at the horizon counts: the horizon must not lead the search to other last
/// digits.
#[test]
fn a_switch_exactly_at_the_horizon_is_never_lost() {
    let mut segments = 0;
    for (parameters, start) in models().take(400) {
        let model = Model::new(parameters).unwrap();
        let Ok(entry) = model.start(&start) else { continue };
        for segment in model.trajectory(entry).take(30) {
            let Some(alone) = model.trajectory(*segment.entry()).next() else { break };
            let Exit::Switch(next) = *alone.exit() else { break };
            let cut = model.trajectory(*segment.entry()).until(next.instant).next().unwrap();
            assert_eq!(cut.exit(), alone.exit(), "{parameters:?} {start:?} {:?}", segment.entry());
            assert_eq!(cut.duration_two_word(), alone.duration_two_word());
            segments += 1;
        }
    }
    println!("{segments} segments");
    assert!(segments > 3000);
}

/// The next number after the switch's angle is late enough, and the one before it is not.
#[test]
fn one_unit_before_a_switch_the_horizon_comes_first() {
    let (model, entry) = from_rest(Parameters::default(), 0.0);
    let omega = model.parameters().omega;
    for segment in model.trajectory(entry).take(40) {
        let alone = model.trajectory(*segment.entry()).next().unwrap();
        let duration = alone.duration_two_word();
        let sooner = TwoWord { high: duration.high, low: duration.low - 1e-15 * duration.high };
        let horizon = segment.entry().instant.after(sooner, omega);
        let cut = model.trajectory(*segment.entry()).until(horizon).next().unwrap();
        assert_eq!(*cut.exit(), Exit::Horizon, "{segment:?}");
    }
}
