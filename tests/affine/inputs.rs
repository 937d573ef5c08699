//! Inputs of the library's own functions that have no answer, or the same numbers as another.

use percuss::system::{Section, SectionMap};
use percuss::{Proved, System, gallery};

fn ball() -> System {
    System::from_toml(gallery::BOUNCING_BALL).unwrap()
}

/// An earlier horizon would be passed without a search, and the events up to the present one lost.
#[test]
fn a_run_goes_on_to_no_earlier_time_and_to_none_that_is_no_number() {
    let solver = ball().solver::<f64>().unwrap();
    let backward = ball().backward_solver::<f64>().unwrap();
    for (solver, side) in [(&solver, 1.0), (&backward, -1.0)] {
        let mut expected = solver.run().until(side).unwrap();
        let mut events = solver.run().until(side).unwrap();
        assert!(events.by_ref().last().is_some() && expected.by_ref().last().is_some());
        for time in [0.5 * side, 0.0, -side, f64::NAN, f64::INFINITY, -f64::INFINITY] {
            assert!(!events.go_on(time) && events.next().is_none(), "{time}");
        }
        assert!(events.go_on(side) && expected.go_on(side));
        assert_eq!(events.by_ref().count(), expected.by_ref().count());
        assert!(events.go_on(3.0 * side) && expected.go_on(3.0 * side));
        let found: Vec<_> = events.map(|it| (*it.time(), it.state().to_vec())).collect();
        let known: Vec<_> = expected.map(|it| (*it.time(), it.state().to_vec())).collect();
        assert_eq!(found, known);
    }
    let mut events = solver.run().until(1.0).unwrap();
    events.by_ref().for_each(drop);
    assert!(!events.go_on(0.5) && events.go_on(3.0));
    let impacts: Vec<f64> =
        events.filter(|it| it.name() == "impact").map(|it| *it.time()).collect();
    assert_eq!(impacts.len(), 2, "{impacts:?}");
}

/// Whose start is the system's own, and so follows its parameters, is not told by its numbers.
#[test]
fn a_start_of_the_same_numbers_is_not_the_systems_own() {
    let text = "schema = 1\nname = \"drop\"\nstates = [\"x\", \"v\"]\n[parameters]\nh = 2\n\
                [[mode]]\nname = \"air\"\nequations = [\"x' = v\", \"v' = -1\"]\n\
                until = [{ name = \"ground\", guard = \"x < 0\", reset = [\"x = 0\", \"v = -v\"] }]\n\
                [start]\nmode = \"air\"\nx = \"h\"\nv = 0\n";
    let system = System::from_toml(text).unwrap();
    let solver = system.solver::<f64>().unwrap();
    let by_height = |run: percuss::Run<'_, f64>| {
        let event = run.gradients(["h"]).unwrap().events(1).unwrap().next().unwrap();
        *event.gradient("h").unwrap().unwrap().time()
    };
    assert_eq!(by_height(solver.run()), 0.5);
    for height in [1.0, 2.0, 3.0] {
        let start = system.start_at("air", 0.0, &[height, 0.0]).unwrap();
        assert_eq!(by_height(solver.run_from(&start)), 0.0, "{height}");
    }
}

#[test]
fn sections_are_of_runs_forward_and_of_angles_that_have_digits() {
    let system = System::from_toml(gallery::IMPACT_OSCILLATOR).unwrap();
    let forward = system.solver::<f64>().unwrap();
    let backward = system.backward_solver::<f64>().unwrap();
    let angle = |angle: f64| SectionMap::new(forward.for_sections(), &Section::strobe(angle));
    assert!(angle(1e15).is_ok() && angle(-1e15).is_ok());
    for beyond in [1.1e15, -1e300, f64::INFINITY, f64::NAN] {
        assert!(angle(beyond).is_err_and(|it| it.to_string().contains("-1e15 to 1e15")));
    }
    let refused = SectionMap::new(backward.for_sections(), &Section::strobe(0.0));
    assert!(refused.is_err_and(|it| it.to_string().contains("run forward")));
    let patient = angle(0.0).unwrap().within(f64::INFINITY);
    assert!(patient.returns(system.start.as_ref().unwrap()).unwrap().next().unwrap().is_ok());
}

#[test]
fn all_proved_digits_may_be_asked_for() {
    let solver = ball().solver::<Proved>().unwrap();
    let impact = solver.run().events(1).unwrap().next().unwrap();
    for number in [impact.time(), &impact.state()[1]] {
        let count = number.digits(usize::MAX).unwrap();
        assert!((17..=2000).contains(&count), "{count}");
        assert!(number.to_digits(usize::MAX).len() >= count);
    }
}

#[test]
fn definitions_that_follow_from_each_other_have_an_end() {
    let chain = |count: usize| {
        let next = |n: usize| format!("d{n} = \"d{} + 1\"\n", n + 1);
        let lets: String = (0..count - 1).map(next).collect();
        System::from_toml(&format!(
            "schema = 1\nname = \"chain\"\nstates = [\"x\"]\n[let]\n{lets}d{} = \"1\"\n[[mode]]\n\
             name = \"one\"\nequations = [\"x' = d0\"]\n",
            count - 1
        ))
    };
    assert!(chain(250).is_ok());
    let error = chain(251).map(|it| it.name).unwrap_err().to_string();
    assert!(error.contains("one definition too many: 250 are accepted"), "{error}");
    assert!(chain(3000).is_err());
}

#[test]
fn events_are_sent_to_threads() {
    let solver = ball().solver::<Proved>().unwrap();
    let events = solver.run().events(3).unwrap();
    let count = std::thread::scope(|scope| scope.spawn(|| events.count()).join().unwrap());
    assert_eq!(count, 3);
}
