//! The times of endings that have no instant of their own.

use super::{enclosed, events, names, system};
use crate::double_double::DoubleDouble;
use percuss::affine::{Event, Solver, What};
use percuss::number::Number;

/// The level of 1/2 is passed upward, and then the amplitude of 1 is met and not passed.
const TOUCH: &str = "
schema = 1
name = \"touch\"
states = [\"x\", \"y\"]
[[mode]]
name = \"free\"
equations = [\"x' = y\", \"y' = -x\"]
[[mode.until]]
name = \"top\"
guard = \"x > 1\"
[[mode.watch]]
name = \"half\"
guard = \"2*x > 1\"
[start]
mode = \"free\"
x = 0
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

#[test]
fn an_undecided_ending_is_at_the_last_event_even_a_watched_one() {
    let touch = system(TOUCH);
    let all = enclosed::<f64>(&touch, 10.0);
    assert_eq!(names(&touch, &all), ["half", "undecided"]);
    assert_at(last_two(&all));
    assert!((all[1].time.value() - std::f64::consts::FRAC_PI_6).abs() < 1e-15);
    assert!(all[1].errors.as_ref().is_some_and(|it| it.time > 0.0));
    let all = enclosed::<DoubleDouble>(&touch, 10.0);
    assert_eq!(names(&touch, &all), ["half", "undecided"]);
    assert_at(last_two(&all));
    // A run that does not follow its errors has no more digits where numbers overflow.
    let growth = system(GROWTH);
    let all = events::<f64>(&growth, 10.0);
    assert_eq!(names(&growth, &all), ["doubled", "undecided"]);
    assert_at(last_two(&all));
}

#[test]
fn an_event_is_given_out_before_an_entry_that_is_open() {
    let root = system(ROOT);
    let all = enclosed::<f64>(&root, 10.0);
    assert_eq!(names(&root, &all), ["quarter", "half", "undecided"]);
    assert_at(last_two(&all));
    // 106 bits decide it.
    let all = enclosed::<DoubleDouble>(&root, 10.0);
    assert_eq!(names(&root, &all)[..3], ["quarter", "half", "root"]);
}

#[test]
fn a_run_has_the_same_start_however_far_it_has_come() {
    let touch = system(TOUCH);
    let solver = Solver::<f64>::new(&touch).unwrap();
    let mut run = solver.run(touch.start.as_ref().unwrap(), 10.0).unwrap();
    assert!(run.by_ref().count() > 2);
    let start = run.start();
    assert_eq!((start.what, start.time.value(), start.state), (What::Start, 0.0, vec![0.0, 1.0]));
}
