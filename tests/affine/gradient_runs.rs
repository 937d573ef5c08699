//! Runs that are differentiated by names, as users of the library ask for them.

use percuss::system::SystemFile;
use percuss::{Bits212, Event, NoGradient, Proved, System, SystemError, gallery};

fn ball() -> System {
    System::from_toml(gallery::BOUNCING_BALL).unwrap()
}

fn number(text: &str) -> f64 {
    text.parse().unwrap()
}

/// The derivatives of an event's time and states by a name.
fn cells<V: Clone + 'static>(event: &Event<'_, V>, name: &str) -> Result<Vec<V>, NoGradient> {
    let gradient = event.gradient(name).expect("the run was asked for it")?;
    Ok([std::slice::from_ref(gradient.time()), gradient.state()].concat())
}

/// From the height h = 1 with g = 1 and e = 1/2 the n-th impact comes at
/// sqrt(2 h/g) (1 + 2 e + ... + 2 e^(n - 1)).
#[test]
fn every_arithmetic_has_the_same_derivatives() {
    let system = ball();
    let names = ["g", "e", "start.x", "start.v"];
    let solver = system.solver::<Proved>().unwrap();
    let proved: Vec<_> = solver.run().gradients(names).unwrap().events(5).unwrap().collect();
    let solver = system.solver::<f64>().unwrap();
    let fast: Vec<_> = solver.run().gradients(names).unwrap().events(5).unwrap().collect();
    let solver = system.solver::<Bits212>().unwrap();
    let long: Vec<_> = solver.run().gradients(names).unwrap().events(5).unwrap().collect();
    for name in names {
        for ((proved, fast), long) in proved.iter().zip(&fast).zip(&long) {
            let proved = cells(proved, name).unwrap();
            let fast = cells(fast, name).unwrap();
            let long = cells(long, name).unwrap();
            for ((proved, fast), long) in proved.iter().zip(&fast).zip(&long) {
                // Few operations an event: a unit of the last place each, of numbers up to 16.
                assert!((proved.midpoint() - fast).abs() < 1e-14, "{name}: {proved} {fast}");
                // A zero without a bound is rounding, of 212 bits.
                let is_zero = proved.may_be(0.0) && number(&long.to_string()).abs() < 1e-50;
                assert!(is_zero || proved.to_string() == long.to_string(), "{name}: {long}");
            }
        }
    }
    let by_gravity = cells(&proved[2], "g").unwrap();
    let expected = -0.5 * 2_f64.sqrt() * 2.5;
    assert!((by_gravity[0].midpoint() - expected).abs() < 1e-15);
}

#[test]
fn digits_that_are_wanted_are_those_of_the_derivatives_too() {
    let system = ball();
    let solver = system.solver::<Proved>().unwrap();
    let run = solver.run().digits(60).gradients(["g", "start.v"]).unwrap();
    for event in run.until(4.0).unwrap() {
        for name in ["g", "start.v"] {
            let cells = cells(&event, name).unwrap();
            let enough = |it: &Proved| it.digits(60).is_none_or(|count| count >= 59);
            assert!(cells.iter().all(|it| enough(it) || it.may_be(0.0)), "{name}: {cells:?}");
        }
    }
}

/// A start of its own does not move with the parameters, whatever the file's own start does.
#[test]
fn a_run_from_another_place_has_a_start_of_numbers() {
    let text = gallery::BOUNCING_BALL.replace("x = 1", "x = \"g/2\"");
    let system = System::from_toml(&text).unwrap();
    let solver = system.solver::<Proved>().unwrap();
    let first = |run: percuss::Run<'_, Proved>, name| {
        let impact = run.gradients([name]).unwrap().events(1).unwrap().next().unwrap();
        cells(&impact, name).unwrap()[0].clone()
    };
    // The time of the fall from x is the root of 2 x/g, which is 1 for x = g/2.
    assert!(first(solver.run(), "g").may_be(0.0));
    let place = system.start_at("flight", 0.0, &[2.0, 0.0]).unwrap();
    assert_eq!(first(solver.run_from(&place), "g").to_string(), "-1.0000000000000000");
    assert_eq!(first(solver.run_from(&place), "start.x").to_string(), "0.50000000000000000");
}

#[test]
fn what_has_no_expressions_is_refused_by_name() {
    let refused = |system: &System, name: &str| {
        let solver = system.solver::<Proved>().unwrap();
        let error = solver.run().gradients([name]).err().expect("it is refused");
        error.to_string()
    };
    let error = refused(&ball(), "start.y");
    assert!(error.contains("start.y is not known: accepted are e, g, start.x, start.v"), "{error}");
    let mut changed = ball();
    changed.modes[0].matrix[1][2] += percuss::Rational::ONE;
    let error = refused(&changed, "g");
    assert!(error.contains("derivative by g") && error.contains("was changed"), "{error}");
    let mut without = ball();
    without.start = None;
    assert!(matches!(
        without.solver::<f64>().unwrap().run().gradients(["g"]).err(),
        Some(SystemError::NoStart { .. })
    ));
    let backward = ball().backward_solver::<Proved>().unwrap();
    let error = backward.run().gradients(["g"]).err().expect("it is refused").to_string();
    assert!(error.contains("back in time"), "{error}");
}

/// Samples are at fixed times: between impacts x'' = -g.
#[test]
fn samples_have_derivatives_at_their_fixed_times() {
    let system = ball();
    let solver = system.solver::<Proved>().unwrap();
    let run = solver.run().gradients(["g"]).unwrap();
    let samples: Vec<_> = run.until_with_samples(1.0, 2).unwrap().collect();
    for sample in &samples {
        let t = sample.time().midpoint();
        let found = cells(sample, "g").unwrap();
        let expected = [0.0, -t * t / 2.0, -t];
        assert!(found.iter().zip(expected).all(|(a, b)| a.may_be(b)), "{found:?} {expected:?}");
    }
    // The ending is at the time of the last sample.
    assert_eq!(samples.len(), 4);
}

/// Gradients cost nothing where they are not asked for, and no event has any then.
#[test]
fn a_run_that_was_not_asked_has_none() {
    let system = ball();
    let solver = system.solver::<Proved>().unwrap();
    let mut events = solver.run().events(2).unwrap();
    assert!(events.start().gradient("g").is_none());
    assert!(events.all(|it| it.gradient("g").is_none()));
    let asked = solver.run().gradients(["g"]).unwrap().events(2).unwrap();
    let start = asked.start();
    assert!(start.gradient("e").is_none());
    assert!(cells(&start, "g").unwrap().iter().all(Proved::is_zero));
}

/// A start on a surface lies in the one mode or the other as its velocity has it: by its place it
/// has a side each, and by its velocity none.
#[test]
fn a_start_whose_mode_hangs_on_a_zero_has_no_derivative_of_both_sides() {
    let text = |x: &str, v: &str| {
        format!(
            r#"
            schema = 1
            name = "gap"
            states = ["x", "v"]
            [[mode]]
            name = "free"
            equations = ["x' = v", "v' = 1"]
            until = [{{ name = "hits", guard = "x > 1", next = [{{ mode = "contact" }}] }}]
            [[mode]]
            name = "contact"
            equations = ["x' = v", "v' = -9*(x - 1)"]
            until = [{{ name = "leaves", guard = "x < 1", next = [{{ mode = "free" }}] }}]
            [start]
            mode = [{{ when = "x > 1", mode = "contact" }}, {{ mode = "free" }}]
            x = {x}
            v = {v}
            "#
        )
    };
    let found = |x, v, name| {
        let system = System::from_toml(&text(x, v)).unwrap();
        let solver = system.solver::<Proved>().unwrap();
        let mut run = solver.run().gradients([name]).unwrap().events(1).unwrap();
        let event = run.next().expect("an event");
        event.gradient(name).expect("it was asked for").map(|_| ())
    };
    assert_eq!(found("0", "1", "start.x"), Ok(()));
    assert_eq!(found("1.5", "1", "start.v"), Ok(()));
    assert_eq!(found("1", "1", "start.v"), Ok(()));
    assert_eq!(found("1", "1", "start.x"), Err(NoGradient::OneSided));
}

/// Two balls that leave a blow at one speed for e = 1 part by (1 - e)^2/4 for every other e, and
/// then meet again at once: the zero holds to first order, and for this value alone.
#[test]
fn a_zero_of_one_value_alone_is_no_zero() {
    let text = include_str!("../../validation/systems/newton-cradle.system.toml");
    let mut file = SystemFile::read("newton-cradle", text).unwrap();
    file.set("e", 1.0, "the test").unwrap();
    let system = file.system().unwrap();
    let solver = system.solver::<Proved>().unwrap();
    let events: Vec<_> = solver
        .run()
        .gradients(["e"])
        .unwrap()
        .events(4)
        .unwrap()
        .map(|it| it.gradient("e").expect("it was asked for").map(|_| ()))
        .collect();
    assert!(events[0].is_ok(), "{events:?}");
    assert_eq!(events.last(), Some(&Err(NoGradient::HigherOrder)), "{events:?}");
}
