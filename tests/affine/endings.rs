//! The times and states of endings, and the events that they name.

use super::{enclosed_events, events, names, system};
use percuss::affine::DoubleDouble;
use percuss::affine::{Ending, Event, Solver, What};
use percuss::number::Number;

/// The level of 3/4 is passed, and then exp(-t) touches exp(-2 t) + 1/4 at the logarithm of two.
const TOUCH: &str = "
schema = 1
name = \"touch\"
states = [\"x\", \"y\"]
[[mode]]
name = \"free\"
equations = [\"x' = -x\", \"y' = -2*y\"]
[[mode.until]]
name = \"top\"
guard = \"4*x > 4*y + 1\"
[[mode.watch]]
name = \"half\"
guard = \"4*x < 3\"
[start]
mode = \"free\"
x = 1
y = 1
";

/// The level of 2 is passed long before f64 overflows.
const GROWTH: &str = "
schema = 1
name = \"growth\"
states = [\"x\", \"y\"]
[[mode]]
name = \"free\"
equations = [\"x' = 1000*x\", \"y' = 0\"]
[[mode.until]]
name = \"never\"
guard = \"y > x\"
[[mode.watch]]
name = \"doubled\"
guard = \"x > 2\"
[start]
mode = \"free\"
x = 1
y = 0
";

/// Where x reaches 1/2, y is the square root of 3/4, which the next mode compares with its f64.
const ROOT: &str = "
schema = 1
name = \"root\"
states = [\"x\", \"y\"]
[[mode]]
name = \"rising\"
equations = [\"x' = y\", \"y' = -x\"]
[[mode.until]]
name = \"half\"
guard = \"2*x > 1\"
next = [{ mode = \"falling\" }]
[[mode.watch]]
name = \"quarter\"
guard = \"4*x > 1\"
[[mode]]
name = \"falling\"
equations = [\"x' = y\", \"y' = -x\"]
[[mode.until]]
name = \"root\"
guard = \"root > y\"
[parameters]
root = 0.8660254037844386
[start]
mode = \"rising\"
x = 0
y = 1
";

/// The last event before the ending, and the ending.
fn last_two<T: Number>(all: &[Event<T>]) -> [&Event<T>; 2] {
    let [.., before, ending] = all else { panic!("a run of too few events") };
    [before, ending]
}

fn assert_at<T: Number + std::fmt::Debug>([before, ending]: [&Event<T>; 2]) {
    assert_eq!(ending.time.value(), before.time.value());
    assert_eq!((&ending.state, ending.mode), (&before.state, before.mode));
    assert_eq!(ending.errors, before.errors);
}

/// The motion (exp(-t), exp(-2 t)), at an ending.
fn assert_decayed<T: Number<Bound = f64> + std::fmt::Debug>(ending: &Event<T>) {
    let time = DoubleDouble::exact(ending.time.high.to_f64())
        + DoubleDouble::exact((ending.time.high - T::exact(ending.time.high.to_f64())).to_f64())
        + DoubleDouble::exact(ending.time.low.to_f64());
    let decay = (-time).exp();
    let errors = ending.errors.as_ref().unwrap();
    for ((state, error), truth) in
        ending.state.iter().zip(&errors.state).zip([decay, decay * decay])
    {
        let words = [state.to_f64(), (*state - T::exact(state.to_f64())).to_f64()];
        let state = DoubleDouble::exact(words[0]) + DoubleDouble::exact(words[1]);
        let apart = (state - truth).to_f64().abs();
        // The truth's own rounding, and that of the time.
        let room = error + 1e-30;
        assert!(apart <= room, "{apart:e} beyond {room:e}");
        assert!(*error <= 1e-13, "{error:e} says nothing");
    }
}

/// The motion is known until shortly before the touch, by the square root of what rounding leaves
/// of the guard there.
#[test]
fn an_undecided_ending_shows_the_motion_that_is_known() {
    let touch = system(TOUCH);
    let left = |time: f64| std::f64::consts::LN_2 - time;
    let all = enclosed_events::<f64>(&touch, 10.0);
    assert_eq!(names(&touch, &all), ["half", "undecided"]);
    let ending = &all[1];
    assert!((1e-9..1e-6).contains(&left(ending.time.value())), "{ending:?}");
    assert_decayed(ending);
    let all = enclosed_events::<DoubleDouble>(&touch, 10.0);
    assert_eq!(names(&touch, &all), ["half", "undecided"]);
    let ending = &all[1];
    assert!((0.0..1e-14).contains(&left(ending.time.value().to_f64())), "{ending:?}");
    assert_decayed(ending);
}

#[test]
fn a_run_without_errors_ends_undecided_at_its_last_event() {
    // It has no more digits where numbers overflow.
    let growth = system(GROWTH);
    let all = events::<f64>(&growth, 10.0);
    assert_eq!(names(&growth, &all), ["doubled", "undecided"]);
    assert_at(last_two(&all));
}

#[test]
fn an_event_is_given_out_before_an_entry_that_is_open() {
    let root = system(ROOT);
    let all = enclosed_events::<f64>(&root, 10.0);
    assert_eq!(names(&root, &all), ["quarter", "half", "undecided"]);
    assert_at(last_two(&all));
    // 106 bits decide it.
    let all = enclosed_events::<DoubleDouble>(&root, 10.0);
    assert_eq!(names(&root, &all)[..3], ["quarter", "half", "root"]);
}

#[test]
fn a_run_has_the_same_start_however_far_it_has_come() {
    let touch = system(TOUCH);
    let solver = Solver::<f64>::new(&touch).unwrap();
    let mut run = solver.run(touch.start.as_ref().unwrap(), 10.0).unwrap();
    assert!(run.by_ref().count() > 1);
    let start = run.start();
    assert_eq!((start.what, start.time.value(), start.state), (What::Start, 0.0, vec![1.0, 1.0]));
}

/// At one instant the motion leaves its mode and a watched guard is touched: rounding leaves open
/// whether it is, and the next mode may have no guard of that number, or another one.
fn touch_at_the_end_of_a_mode(next: &str) -> String {
    format!(
        "schema = 1\nname = \"ends-at-a-touch\"\nstates = [\"x\", \"y\", \"w\"]\n[[mode]]\n\
         name = \"first\"\nequations = [\"x' = 1\", \"y' = w\", \"w' = -2\"]\n[[mode.until]]\n\
         name = \"over\"\nguard = \"x > 1\"\nnext = [{{ mode = \"second\" }}]\n[[mode.watch]]\n\
         name = \"touch\"\nguard = \"y > 0\"\n[[mode]]\nname = \"second\"\n\
         equations = [\"x' = 1\", \"y' = w\", \"w' = -2\"]\n{next}[start]\nmode = \"first\"\n\
         x = 0\ny = -1\nw = 2\n"
    )
}

#[test]
fn what_is_open_is_a_guard_of_the_mode_in_which_it_was_met() {
    let other = "[[mode.until]]\nname = \"far\"\nguard = \"x > 100\"\n[[mode.watch]]\n\
                 name = \"innocent\"\nguard = \"w > 50\"\n";
    for next in ["", other] {
        let system = system(&touch_at_the_end_of_a_mode(next));
        let solver = Solver::<DoubleDouble>::new(&system).unwrap();
        let start = system.start.as_ref().unwrap();
        let mut run = solver.run_enclosed(start, DoubleDouble::exact(5.0)).unwrap();
        let _ = run.by_ref().count();
        // A run that decides the touch leaves nothing open.
        let open = run.doubtful_event();
        assert!(open.is_none_or(|it| it == What::Watch(0, 0)), "{open:?}");
    }
}

/// Both guards are reached at the logarithm of two but for less than f64 can tell, and so is the
/// condition of the first successor.
const OPEN_IN_F64: [&str; 2] = [
    "[[mode.until]]\nname = \"left\"\nguard = \"x < 1\"\nreset = [\"x = 2\"]\n\
     [[mode.until]]\nname = \"right\"\nguard = \"y < 1\"\nreset = [\"x = 2\", \"y = 4\"]\n",
    "[[mode.until]]\nname = \"left\"\nguard = \"x < 1\"\nreset = [\"x = 2\"]\n\
     next = [{ when = \"y < 1\", mode = \"second\" }, { mode = \"first\" }]\n",
];

#[test]
fn a_tie_and_a_successor_that_are_open_are_not_passed() {
    for events in OPEN_IN_F64 {
        let system = system(&format!(
            "schema = 1\nname = \"open\"\nstates = [\"x\", \"y\"]\n[[mode]]\nname = \"first\"\n\
             equations = [\"x' = -x\", \"y' = -2*y\"]\n{events}[[mode]]\nname = \"second\"\n\
             equations = [\"x' = 0\", \"y' = 0\"]\n[parameters]\nlittle = 1e-18\n\
             [start]\nmode = \"first\"\nx = 2\ny = \"4 - little\"\n"
        ));
        let all = enclosed_events::<f64>(&system, 5.0);
        assert_eq!(names(&system, &all), ["undecided"]);
        let (time, errors) = (all[0].time.value(), all[0].errors.as_ref().unwrap());
        assert!((0.69..0.6932).contains(&time), "{time:?}");
        assert_eq!(all[0].mode, 0);
        let decay = (-time).exp();
        let apart = [all[0].state[0] - 2.0 * decay, all[0].state[1] - 4.0 * decay * decay];
        for (apart, error) in apart.iter().zip(&errors.state) {
            assert!(apart.abs() <= *error + 1e-15 && *error < 1e-13, "{apart:e} {error:e}");
        }
        assert!(enclosed_events::<DoubleDouble>(&system, 1.5).len() > 1, "106 bits decide it");
    }
}

/// The impacts of a ball whose count of them moves another state are not proved to accumulate: a
/// run in f64 ends once 64 of them come within the clock's last digit.
#[test]
fn impacts_below_the_clocks_last_digit_make_no_progress() {
    let counting = "
schema = 1
name = \"counting\"
states = [\"x\", \"v\", \"n\", \"y\"]
[[mode]]
name = \"flight\"
equations = [\"x' = v\", \"v' = -1\", \"n' = 0\", \"y' = n\"]
[[mode.until]]
name = \"impact\"
guard = \"x < 0\"
reset = [\"x = 0\", \"v = -v/2\", \"n = n + 1\"]
[start]
mode = \"flight\"
x = 1
v = 0
n = 0
y = 0
";
    let all = events::<f64>(&system(counting), 9.0);
    let end = all.last().unwrap();
    assert_eq!(end.what, What::End(Ending::NoProgress));
    // The sum of the flights is 3 sqrt 2, and each impact halves the speed of 2^(1/2).
    assert!((end.time.value() - 3.0 * 2_f64.sqrt()).abs() < 1e-15);
    let steps = (2.0 * f64::from(f64::MANTISSA_DIGITS)) as usize;
    assert!(all.len() < steps + 2 * 64, "{}", all.len());
}
