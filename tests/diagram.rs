//! Diagrams and sections against the runs they are made of.

use percuss::dynamics::diagram::{Diagram, Follow};
use percuss::dynamics::lyapunov::Spectrum;
use percuss::dynamics::section::section;
use percuss::dynamics::strobe::StrobeMap;
use percuss::{Model, Parameter, Parameters, Start};

fn diagram(parameter: Parameter, from: f64, to: f64, follow: Follow) -> Diagram {
    Diagram {
        parameters: Parameters { xi: 0.1, omega: 0.5, ..Parameters::default() },
        start: Start { p: -0.3, y: 0.2, ..Start::default() },
        parameter,
        from,
        to,
        steps: 7,
        transient: 12,
        periods: 5,
        follow,
    }
}

#[test]
fn each_value_is_a_run_of_its_own_when_reset() {
    for (parameter, from, to) in [
        (Parameter::A, 0.2, 0.6),
        (Parameter::B, 0.3, 0.05),
        (Parameter::Xi, 0.01, 2.0),
        (Parameter::Omega, 0.4, 1.5),
        (Parameter::G, 0.0, 0.1),
        (Parameter::Phi, 0.0, 6.0),
    ] {
        let plan = diagram(parameter, from, to, Follow::Reset);
        let steps = plan.steps(|_| {}).unwrap();
        assert_eq!(steps.len(), 7);
        assert_eq!((steps[0].value, steps[6].value), (from, to));
        for step in &steps {
            let model = Model::new(parameter.set(plan.parameters, step.value)).unwrap();
            let entry = model.start(&plan.start).unwrap();
            let strobes: Vec<_> = StrobeMap::new(model, entry.instant).strobes(entry, 17).collect();
            for (n, point) in step.points.iter().enumerate() {
                for (found, run) in point.iter().zip(strobes[12 + n].point()) {
                    assert!((found - run).abs() <= 1e-9 * (1.0 + run.abs()), "{parameter:?}");
                }
            }
            let drift = (strobes[17].v() - strobes[12].v()) / 5.0;
            assert!((step.drift_per_period - drift).abs() <= 1e-9 * (1.0 + drift));
        }
    }
}

/// Carried, a diagram stays on an attractor that the start itself would not reach: the period-four
/// one of Fig. 10 from omega = 1.5 down and up again.
#[test]
fn a_carried_diagram_stays_on_its_attractor() {
    let start = Start { p: -2.22, y: 0.2, q: Some(0.0), ..Start::default() };
    let plan = |from, to, follow, start| Diagram {
        parameters: Parameters { xi: 0.1, ..Parameters::default() },
        start,
        parameter: Parameter::Omega,
        from,
        to,
        steps: 60,
        transient: 200,
        periods: 8,
        follow,
    };
    let orbit_at_first = (0..400).map(f64::from).find_map(|k| {
        let start = Start { p: start.p - 0.001 * k, ..start };
        let first = Diagram { steps: 1, ..plan(1.5, 1.5, Follow::Reset, start) };
        let points = first.steps(|_| {}).unwrap().remove(0).points;
        repeats_after_four(&points).then_some(start)
    });
    let start = orbit_at_first.expect("the basin is met");
    let carried = plan(1.5, 1.42, Follow::Carry, start).steps(|_| {}).unwrap();
    assert!(carried.iter().all(|step| repeats_after_four(&step.points)));
    let reset = plan(1.5, 1.42, Follow::Reset, start).steps(|_| {}).unwrap();
    assert!(reset.iter().any(|step| !repeats_after_four(&step.points)));
}

/// The motion leaves for good below b = 0: those values are left out, and no other starts from
/// where they went. So every value that stays is as near to the slider as one of its own start.
#[test]
fn a_value_that_escapes_is_left_out_and_not_carried_on() {
    let plan = |from, to, follow| Diagram {
        parameters: Parameters { a: 0.42, xi: 0.08, omega: 0.9, g: 0.05, ..Parameters::default() },
        start: Start::default(),
        parameter: Parameter::B,
        from,
        to,
        steps: 400,
        transient: 300,
        periods: 60,
        follow,
    };
    for (from, to) in [(-0.05, 0.5), (0.5, -0.05)] {
        for follow in [Follow::Carry, Follow::Reset] {
            let steps = plan(from, to, follow).steps(|_| {}).unwrap();
            assert_eq!(steps.len(), 400);
            for step in &steps {
                assert_eq!(step.escapes, step.value < 0.0, "{}", step.value);
                assert_eq!(step.points.is_empty(), step.escapes);
                assert_eq!(step.drift_per_period.is_nan(), step.escapes);
            }
            let far = steps.iter().flat_map(|step| &step.points).map(|it| it[0].abs());
            assert!(far.fold(0.0, f64::max) < 600.0);
        }
    }
    // Above b = 1 the slider never stops: its speed grows, its state does not.
    let fast = plan(0.9, 1.1, Follow::Carry).steps(|_| {}).unwrap();
    assert!(!fast[0].escapes && fast[399].escapes && fast[399].points.is_empty());
}

/// A value's start is the last strobe of the last value that stayed, wherever that was.
#[test]
fn what_follows_an_escape_starts_from_the_last_that_stayed() {
    let plan = |from, to, steps, start| Diagram {
        parameters: Parameters { xi: 0.1, ..Parameters::default() },
        start,
        parameter: Parameter::B,
        from,
        to,
        steps,
        transient: 3,
        periods: 2,
        follow: Follow::Carry,
    };
    // b = 0.1, -0.05, -0.2: only the first stays.
    let there = plan(0.1, -0.2, 3, Start::default()).steps(|_| {}).unwrap();
    assert_eq!(there.iter().map(|it| it.escapes).collect::<Vec<_>>(), [false, true, true]);
    // b = -0.2, -0.05, 0.1: the last starts from the start given.
    let back = plan(-0.2, 0.1, 3, Start::default()).steps(|_| {}).unwrap();
    let alone = plan(0.1, 0.1, 1, Start::default()).steps(|_| {}).unwrap();
    assert_eq!(back[2].points, alone[0].points);
    assert_eq!(back[2].points, there[0].points);
}

/// The error of a diagram's mean drift is that of [`Spectrum`] over the same strobes.
#[test]
fn drifts_have_the_errors_of_their_scatter() {
    // An orbit of period 2, in batches of odd lengths.
    let parameters = Parameters { omega: 0.1, ..Parameters::default() };
    let plan = Diagram {
        parameters,
        start: Start::default(),
        parameter: Parameter::B,
        from: 0.1,
        to: 0.1,
        steps: 1,
        transient: 200,
        periods: 100,
        follow: Follow::Reset,
    };
    let step = plan.steps(|_| {}).unwrap().remove(0);
    let model = Model::new(parameters).unwrap();
    let spectrum = Spectrum::new(&model, model.start(&plan.start).unwrap(), 200, 100);
    let pairs = [
        (step.drift_per_period, spectrum.drift_per_period),
        (step.drift_standard_error, spectrum.drift_standard_error),
    ];
    for (found, expected) in pairs {
        assert!(expected > 0.1 && (found - expected).abs() < 1e-10, "{found} {expected}");
    }
    let single = Diagram { periods: 1, ..plan }.steps(|_| {}).unwrap().remove(0);
    assert!(single.drift_standard_error.is_nan());
}

fn repeats_after_four(points: &[[f64; 3]]) -> bool {
    let near = |a: &[f64; 3], b: &[f64; 3]| (0..3).all(|i| (a[i] - b[i]).abs() < 1e-5);
    near(&points[0], &points[4]) && !near(&points[0], &points[2])
}

#[test]
fn a_section_begins_at_its_angle_after_the_transient() {
    let model = Model::new(Parameters::default()).unwrap();
    let omega = model.parameters().omega;
    let from = model.start(&Start { tau: 0.9, ..Start::default() }).unwrap();
    for (angle, first) in [(0.0, 4), (1.26, 3), (2.0, 3), (2.0 - std::f64::consts::TAU, 3)] {
        let strobes: Vec<_> = section(&model, from, angle, 3, 6).collect();
        assert_eq!(strobes.len(), 6);
        for (n, strobe) in strobes.iter().enumerate() {
            let turns = (strobe.instant.angle() - angle) / std::f64::consts::TAU;
            assert!((turns - turns.round()).abs() < 1e-14);
            assert_eq!(strobe.instant.cycle(), first + n as i128);
            let segment = model
                .trajectory(from)
                .until(strobe.instant.after_periods(1, 1))
                .find(|segment| !segment.ends_by(&strobe.instant))
                .unwrap();
            let sample = segment.at_instant(&strobe.instant);
            assert!((sample.state.p - strobe.state.p).abs() <= 1e-12);
            assert!((sample.v - strobe.v()).abs() <= 1e-12);
        }
        let late = strobes[0].instant.since(&from.instant, omega).value() / model.period();
        assert!((3.0..4.0).contains(&late), "{late}");
    }
}
