//! The runs that users ask for: lengths, starts and samples, in each kind of numbers.

use percuss::{Bits212, DoubleDouble, Ending, Event, Kind, Proved, System, SystemError, gallery};

const GALLERY: [&str; 3] =
    [gallery::BOUNCING_BALL, gallery::IMPACT_OSCILLATOR, gallery::THERMOSTAT];

fn system(text: &str) -> System {
    System::from_toml(text).unwrap()
}

fn names<V>(events: impl Iterator<Item = Event<'static, V>>) -> Vec<(String, String)> {
    events.map(|it| (it.name().to_owned(), it.mode().to_owned())).collect()
}

#[test]
fn all_numbers_have_the_same_events() {
    for text in GALLERY {
        let system: &'static System = Box::leak(Box::new(system(text)));
        macro_rules! of {
            ($number:ty) => {{
                let solver = Box::leak(Box::new(system.solver::<$number>().unwrap()));
                names(solver.run().until(9.0).unwrap())
            }};
        }
        let proved = of!(Proved);
        assert!(proved.len() > 2, "{}", system.name);
        assert_eq!(proved, of!(f64));
        assert_eq!(proved, of!(DoubleDouble));
        assert_eq!(proved, of!(Bits212));
    }
}

#[test]
fn proved_numbers_enclose_those_of_f64() {
    for text in GALLERY {
        let system = system(text);
        let (fast, proved) = (system.solver::<f64>().unwrap(), system.solver::<Proved>().unwrap());
        let pairs = fast.run().events(12).unwrap().zip(proved.run().events(12).unwrap());
        for (own, truth) in pairs {
            assert!((own.time() - truth.time().midpoint()).abs() < 1e-12, "{own:?} {truth:?}");
            for (own, truth) in own.state().iter().zip(truth.state()) {
                let (distance, size) = ((own - truth.midpoint()).abs(), own.abs().max(1.0));
                assert!(distance < 1e-11 * size && truth.error() < 1e-20, "{own} {truth:?}");
            }
        }
    }
}

#[test]
fn lengths_that_mean_nothing_are_refused() {
    let ball = system(gallery::BOUNCING_BALL);
    let solver = ball.solver::<f64>().unwrap();
    for time in [-1.0, f64::NAN, f64::INFINITY] {
        let error = solver.run().until(time).err().unwrap();
        assert!(matches!(error, SystemError::Number { .. }), "{error}");
        assert!(error.to_string().contains("at or after the start at 0"), "{error}");
    }
    let error = solver.run().periods(3).err().unwrap();
    assert_eq!(error.to_string(), "ball has no forcing, and so no periods");
    assert!(matches!(solver.run().samples(0), Err(SystemError::Number { .. })));
    let mut nowhere = ball.clone();
    nowhere.start = None;
    let solver = nowhere.solver::<Proved>().unwrap();
    assert!(matches!(solver.run().until(1.0), Err(SystemError::NoStart { .. })));
    let start = ball.start_at("flight", 0.0, &[1.0, 0.0]).unwrap();
    assert_eq!(solver.run_from(&start).events(2).unwrap().count(), 2);
    for (mode, time, states) in
        [("fall", 0.0, &[1.0, 0.0][..]), ("flight", f64::NAN, &[1.0, 0.0]), ("flight", 0.0, &[1.0])]
    {
        assert!(ball.start_at(mode, time, states).is_err(), "{mode} {time} {states:?}");
    }
}

#[test]
fn a_start_of_another_system_is_refused() {
    let (ball, room) = (system(gallery::BOUNCING_BALL), system(gallery::THERMOSTAT));
    let mut start = room.start_at("off", 0.0, &[20.0, 20.0]).unwrap();
    let solver = ball.solver::<f64>().unwrap();
    assert!(solver.run_from(&start).until(1.0).is_err());
    (start.mode, start.state) = (0, Vec::new());
    assert!(solver.run_from(&start).until(1.0).is_err());
}

#[test]
fn runs_go_back_in_time() {
    let ball = system(gallery::BOUNCING_BALL);
    let solver = ball.backward_solver::<Proved>().unwrap();
    assert!(solver.run().until(1.0).is_err());
    let end = solver.run().until(-1.0).unwrap().last().unwrap();
    assert_eq!(end.ending(), Some(Ending::Horizon));
    assert_eq!(end.state()[0].to_digits(17), "0.50000000000000000");
    let end = solver.run().until(-2.0).unwrap().last().unwrap();
    assert_eq!(end.ending(), Some(Ending::LeavesDomain));
    assert!((end.time().midpoint() + 2_f64.sqrt()).abs() < 1e-15);
}

#[test]
fn a_forced_system_has_periods() {
    let oscillator = system(gallery::IMPACT_OSCILLATOR);
    let solver = oscillator.solver::<Proved>().unwrap();
    let end = solver.run().periods(7).unwrap().last().unwrap();
    let exact = 7.0 * std::f64::consts::TAU / 2.8;
    assert!((end.time().midpoint() - exact).abs() < 1e-14);
    let seventh = solver.run().samples(1).unwrap().nth(7).unwrap();
    assert_eq!(seventh.state()[1].to_digits(20), end.state()[1].to_digits(20));
}

/// A sample and a crossing at the same time, whose order hangs on the bits: a run that goes on in
/// more bits gives each sample once.
#[test]
fn samples_at_events_are_given_once() {
    let text = r#"
        schema = 1
        name = "clock-and-sine"
        states = ["r", "held"]
        forcing = { omega = 6.283185307179586 }
        [[mode]]
        name = "run"
        equations = ["r' = 2", "held' = 0"]
        [[mode.until]]
        name = "sample-and-hold"
        guard = "r > 1"
        reset = ["r = 0", "held = sin"]
        [[mode.watch]]
        name = "zero"
        guard = "sin > 0"
        direction = "both"
        [start]
        mode = "run"
        r = 0
        held = 0
    "#;
    let system = system(text);
    let solver = system.solver::<Proved>().unwrap();
    for digits in [10, 17, 25, 40] {
        let events = solver.run().digits(digits).until_with_samples(50.0, 2).unwrap();
        let samples = events.filter(|it| it.kind() == Kind::Sample);
        let times: Vec<f64> = samples.map(|it| it.time().midpoint()).collect();
        // The period is longer than 1 by 4e-17: the last of 101 is beyond the end.
        assert_eq!(times.len(), 100, "{digits}");
        let steps = times.windows(2).map(|pair| pair[1] - pair[0]);
        assert!(steps.into_iter().all(|step| (step - 0.5).abs() < 1e-12), "{times:?}");
    }
}

/// What happens after the last sample belongs to a run with samples, and so does its ending.
#[test]
fn events_after_the_last_sample_are_there() {
    let ball = system(gallery::BOUNCING_BALL);
    let solver = ball.solver::<f64>().unwrap();
    let kinds = |until| -> Vec<Kind> {
        solver.run().until_with_samples(until, 1).unwrap().map(|it| it.kind()).collect()
    };
    let horizon = Kind::End(Ending::Horizon);
    // The first impact is at the square root of two.
    assert_eq!(kinds(1.25), [Kind::Sample, Kind::Sample, horizon]);
    assert_eq!(kinds(1.5), [Kind::Sample, Kind::Sample, Kind::Until(0, 0), horizon]);
    assert_eq!(kinds(1.0), [Kind::Sample, Kind::Sample, horizon]);
    assert_eq!(kinds(0.0), [Kind::Sample, horizon]);
}

/// Guards that cross 1e-40 apart: 106 bits leave their order open, 212 do not.
#[test]
fn more_bits_go_on_where_fewer_do_not_decide() {
    let text = r#"
        schema = 1
        name = "near-tie"
        states = ["x", "y"]
        [parameters]
        gap = 1e-40
        [[mode]]
        name = "run"
        equations = ["x' = -x", "y' = -y"]
        [[mode.watch]]
        name = "first"
        guard = "x < 1/3"
        [[mode.watch]]
        name = "second"
        guard = "y < 1/3"
        [start]
        mode = "run"
        x = 1
        y = "1 + gap"
    "#;
    let system = system(text);
    let solver = system.solver::<Proved>().unwrap();
    let mut events = solver.run().until(5.0).unwrap();
    assert_eq!(events.bits(), 106);
    let names: Vec<&str> = events.by_ref().map(|it| it.name()).collect();
    assert_eq!(names, ["first", "second", "end"]);
    assert_eq!(events.bits(), 212);
    let mut events = solver.run().max_bits(106).until(5.0).unwrap();
    assert_eq!(events.by_ref().last().unwrap().ending(), Some(Ending::Undecided));
    let cause = events.cause().unwrap().to_string();
    assert!(cause.contains("which of the guards of \"first\" and \"second\""), "{cause}");
}
