//! The exact continuation of records: of an exact run's own, of records with errors, and of states
//! on the wrong side of a guard.

use super::{BALL, PLASTIC, RELAY, SPHERES, STIFF, system};
use percuss::affine::{Event, Followed, Follower, Solver, System, What};
use percuss::gallery;

/// Small systems of every kind, and how long they are run.
fn systems() -> Vec<(System, f64)> {
    let texts = [BALL, RELAY, STIFF, SPHERES, PLASTIC].map(system);
    let mut all: Vec<(System, f64)> = texts.into_iter().map(|it| (it, 8.0)).collect();
    all.push((system(gallery::IMPACT_OSCILLATOR), 60.0));
    all.push((system(gallery::THERMOSTAT), 20.0));
    all
}

fn followed_event(event: &Event<f64>) -> Option<Followed> {
    Some(match event.what {
        What::Until(_, until) => Followed::Until(until, event.mode),
        What::Watch(_, watch) => Followed::Watch(watch),
        What::Start | What::Limit(..) | What::End(_) => return None,
    })
}

/// Follows an exact run whose states are shifted by `shift` of an entry's number, and hands over
/// each record beside what its predecessor's exact continuation has first.
fn follow(
    (system, until): &(System, f64),
    shift: impl Fn(usize) -> f64,
    mut see: impl FnMut(&Event<f64>, &Event<f64>),
) {
    let solver = Solver::<f64>::new(system).unwrap();
    let start = system.start.as_ref().unwrap();
    let mut run = solver.run(start, *until).unwrap();
    let mut last = run.start();
    let mut follower: Follower<'_, f64> = solver.follow(start).unwrap();
    for event in run.by_ref() {
        let Some(own) = followed_event(&event) else { break };
        let begins = follower.elapsed(&last);
        let state: Vec<f64> =
            last.state.iter().enumerate().map(|(n, value)| value + shift(n)).collect();
        follower.go_on(begins, &state, follower.elapsed(&event) + 1.0, 0);
        let exact = follower.next().unwrap();
        see(&event, &exact);
        let at_entry = event.time.value() == last.time.value();
        assert!(follower.pass(own, at_entry), "{}: {event:?}", system.name);
        assert_eq!(follower.mode(), event.mode, "{}", system.name);
        last = event;
    }
}

#[test]
fn an_exact_runs_records_are_continued_by_its_next_events() {
    for own in systems() {
        let mut count = 0;
        follow(
            &own,
            |_| 0.0,
            |event, exact| {
                assert_eq!((event.what, event.mode), (exact.what, exact.mode), "{}", own.0.name);
                let late = exact.time.value() - event.time.value();
                assert!(
                    late.abs() <= 1e-13 * (1.0 + event.time.value()),
                    "{}: {late:e}",
                    own.0.name
                );
                for (a, b) in event.state.iter().zip(&exact.state) {
                    assert!((a - b).abs() <= 1e-12 * (1.0 + b.abs()), "{}: {a} {b}", own.0.name);
                }
                count += 1;
            },
        );
        assert!(count > 1, "{}: {count}", own.0.name);
    }
}

/// A record's state is off by 1e-10, on either side of every guard that is zero by the model: the
/// next event stays the next, but where the ball touches a level.
#[test]
fn what_is_zero_by_the_model_is_zero_in_a_state_with_errors() {
    for own in systems().into_iter().filter(|it| it.0.name != "ball") {
        for sign in [-1.0, 1.0] {
            let shift = |n: usize| sign * 1e-10 * (1.0 + n as f64);
            follow(&own, shift, |event, exact| {
                // Shorter segments than this end where errors are as large as the motion.
                if event.time.value() < 1.0 {
                    let names = (&own.0.name, event, exact);
                    assert_eq!((event.what, event.mode), (exact.what, exact.mode), "{names:?}");
                    let late = exact.time.value() - event.time.value();
                    assert!(late.abs() < 1e-7, "{names:?}");
                }
            });
        }
    }
}

const THROWN: &str = "schema = 1\nname = \"thrown\"\nstates = [\"x\", \"v\"]\n[[mode]]\nname = \"up\"\n\
    equations = [\"x' = v\", \"v' = -2\"]\n[[mode.until]]\nname = \"down\"\nguard = \"x < 0\"\n\
    reset = [\"x = 0\", \"v = -v\"]\n[start]\nmode = \"up\"\nx = 0\nv = 1\n";

/// A guard that is positive where a record begins fires at once, or comes back inside first.
#[test]
fn a_guard_on_its_way_back_does_not_fire() {
    let thrown = system(THROWN);
    let solver = Solver::<f64>::new(&thrown).unwrap();
    let mut follower = solver.follow(thrown.start.as_ref().unwrap()).unwrap();
    let below = [-1e-3, 1.0];
    follower.forget(0);
    follower.go_on(0.0, &below, 5.0, 0);
    assert!(follower.fires_at_once());
    let at_once = follower.next().unwrap();
    assert_eq!((at_once.what, at_once.time.value()), (What::Until(0, 0), 0.0));
    follower.go_on(0.0, &below, 5.0, 1);
    assert!(!follower.fires_at_once());
    let later = follower.next().unwrap();
    // -1e-3 + t - t^2 has its second zero at (1 + sqrt(1 - 4e-3))/2.
    assert_eq!(later.what, What::Until(0, 0));
    let second = 0.5 * (1.0 + (1.0_f64 - 4e-3).sqrt());
    assert!((later.time.value() - second).abs() < 1e-15, "{:?}", later.time);
}

/// At the start x is zero by the model; taken for forgotten it is what the state says.
#[test]
fn zeros_are_imposed_forgotten_and_told() {
    let thrown = system(THROWN);
    let solver = Solver::<f64>::new(&thrown).unwrap();
    let mut follower = solver.follow(thrown.start.as_ref().unwrap()).unwrap();
    let off = [1e-7, 1.0];
    let told = follower.imposed(0.0, &off);
    assert_eq!(told.len(), 1);
    assert_eq!((told[0].guard, told[0].order), (0, 0));
    assert!((told[0].value + 1e-7).abs() < 1e-20, "{told:?}");
    follower.forget(0);
    assert!(follower.imposed(0.0, &off).is_empty());
    follower.impose(1);
    assert_eq!(follower.imposed(0.0, &off), told);
    assert!(
        !follower.pass(Followed::Watch(0), false) && !follower.pass(Followed::Until(1, 0), false)
    );
    assert!(
        !follower.pass(Followed::Until(0, 1), false) && follower.pass(Followed::Until(0, 0), false)
    );
    assert_eq!(follower.imposed(1.0, &[0.0, 1.0]).len(), 1);
}

/// A throw that is not caught comes down a second time: nothing fires before it has been up again.
#[test]
fn an_event_that_is_passed_over_is_followed_by_the_next_of_the_same_flow() {
    let wave = system(
        r#"
schema = 1
name = "wave"
states = ["x", "v"]
[[mode]]
name = "swing"
equations = ["x' = v", "v' = -x"]
[[mode.until]]
name = "top"
guard = "2*x > 1"
next = [{ mode = "swing" }]
[start]
mode = "swing"
x = 0
v = 1
"#,
    );
    let solver = Solver::<f64>::new(&wave).unwrap();
    let mut follower = solver.follow(wave.start.as_ref().unwrap()).unwrap();
    follower.go_on(0.0, &[0.0, 1.0], 20.0, 0);
    let third = std::f64::consts::PI / 6.0;
    let first = follower.next().unwrap();
    assert!((follower.elapsed(&first) - third).abs() < 1e-15);
    follower.go_past(third + 1e-3, 20.0, 1);
    let second = follower.next().unwrap();
    assert_eq!(second.what, What::Until(0, 0));
    assert!((follower.elapsed(&second) - third - std::f64::consts::TAU).abs() < 1e-12);
    let [x, v] = <[f64; 2]>::try_from(follower.along(1.0)).unwrap();
    assert!((x - 1.0_f64.sin()).abs() < 1e-15 && (v - 1.0_f64.cos()).abs() < 1e-15);
}
