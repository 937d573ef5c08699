//! Derivatives of events against differences of runs in 424 bits, which know nothing of them.

use percuss::affine::{Bits424, Event, NoGradient, Solver, System, SystemFile, Walk};
use percuss::number::Number;
use percuss::system::Name;
use percuss::{Bits212, Rational};
use std::sync::Arc;

/// Differences over steps of this share of a parameter, and of twice that: their extrapolation is
/// off by the fourth power, 1e-41, and by what the fifth derivatives make of it.
const STEP_EXPONENT: i32 = -34;

/// Twenty-five digits and what the differences leave: they agree much better where the motion does
/// not amplify.
const DIFFERENCE_TOLERANCE: f64 = 1e-26;

fn file(text: &str, set: &[(&str, f64)]) -> SystemFile {
    let mut file = SystemFile::read("test.system.toml", text).unwrap();
    set.iter().for_each(|(name, value)| file.set(name, *value, "test").unwrap());
    file
}

/// The first events of a run, and its ending where it is among them.
fn events<T: Number>(system: &System, count: usize) -> Vec<Event<T>> {
    let solver = Solver::<T>::new(system).unwrap();
    let start = system.start.as_ref().unwrap();
    let until = T::exact(start.time.to_f64() + 40.0 * system.time_scale);
    solver.run_enclosed(start, until).unwrap().take(count).collect()
}

/// Times and states of events.
fn cells(events: &[Event<Bits424>]) -> Vec<Vec<Bits424>> {
    let cells = |it: &Event<Bits424>| {
        std::iter::once(it.time.value()).chain(it.state.iter().copied()).collect()
    };
    events.iter().map(cells).collect()
}

/// The system that differs from another by so many steps of a name, and the step.
fn moved_system(text: &str, name: &Name, steps: f64) -> (System, f64) {
    match name {
        Name::Parameter(own) => {
            let value = file(text, &[]).system().unwrap().parameters[own];
            let size = if value == 0.0 { 1.0 } else { value.abs() };
            let step = size * 2_f64.powi(STEP_EXPONENT);
            // A power of two of the size of the parameter's last bits.
            let step = 2_f64.powi(step.log2().floor() as i32);
            (file(text, &[(own, value + steps * step)]).system().unwrap(), step)
        }
        Name::Start(state) => {
            let mut system = file(text, &[]).system().unwrap();
            let step = 2_f64.powi(STEP_EXPONENT);
            let at = system.states.iter().position(|it| it == state).unwrap();
            let start = system.start.as_mut().unwrap();
            start.state[at][2] += Rational::try_from(steps * step).unwrap();
            (system, step)
        }
    }
}

/// The differences of the cells of events by a name.
fn differences(text: &str, name: &Name, count: usize) -> Vec<Vec<f64>> {
    let at = |steps: f64| {
        let (system, step) = moved_system(text, name, steps);
        (cells(&events(&system, count)), step)
    };
    let ([(a, step), (b, _)], [(c, _), (d, _)]) = ([at(1.0), at(-1.0)], [at(2.0), at(-2.0)]);
    let entry = |n: usize, k: usize| {
        let near = a[n][k] - b[n][k];
        let far = c[n][k] - d[n][k];
        let eight = Bits424::exact(8.0);
        let sum = (eight * near - far) / Bits424::exact(12.0 * step);
        let high = sum.to_f64();
        [high, (sum - Bits424::exact(high)).to_f64()]
    };
    let row = |n: usize| (0..a[n].len()).flat_map(|k| entry(n, k)).collect();
    (0..a.len()).map(row).collect()
}

/// The derivatives of an event's time and states, each with its error.
type Cells<T> = Result<Vec<(T, <T as Number>::Bound)>, NoGradient>;

/// The derivatives of the first events by a name.
fn gradients<T: Number>(text: &str, name: &Name, count: usize) -> Vec<Cells<T>> {
    let until = |system: &System| {
        T::exact(system.start.as_ref().unwrap().time.to_f64() + 40.0 * system.time_scale)
    };
    walk(text, name, until, count)
}

/// The derivatives of the first events up to a time by a name.
fn walk<T: Number>(
    text: &str,
    name: &Name,
    until: impl Fn(&System) -> T,
    count: usize,
) -> Vec<Cells<T>> {
    let file = file(text, &[]);
    let (system, tangent) = (file.system().unwrap(), Arc::new(file.tangent(name).unwrap()));
    let solver = Solver::<T>::new(&system).unwrap();
    let start = system.start.as_ref().unwrap();
    let mut run = solver.run_enclosed(start, until(&system)).unwrap();
    let mut walk = Walk::new(&solver, &tangent, start, &run.start()).unwrap();
    let mut all = Vec::new();
    while let Some(event) = run.next().filter(|_| all.len() < count) {
        let gradient = walk.step(&event, &run);
        all.push(gradient.map(|it| std::iter::once(it.time).chain(it.state).collect()));
    }
    all
}

/// Compares the derivatives of some events by each name that is given.
fn compare(text: &str, names: &[&str], count: usize) {
    for name in names.iter().map(|it| Name::read(it)) {
        let expected = differences(text, &name, count);
        let found = gradients::<Bits212>(text, &name, count);
        assert_eq!(found.len(), expected.len());
        assert!(found.len() >= 3, "{name}: {} events", found.len());
        for (n, (found, expected)) in found.iter().zip(&expected).enumerate() {
            let found = found.as_ref().unwrap_or_else(|error| panic!("{name}, {n}: {error}"));
            // Beside the largest derivative of the row, and beside 1 where all of them are zero.
            let size = found.iter().map(|it| it.0.to_f64().abs()).fold(0.0, f64::max);
            let size = if size == 0.0 { 1.0 } else { size };
            for ((value, error), expected) in found.iter().zip(expected.chunks(2)) {
                let rest = *value - Bits212::exact(expected[0]) - Bits212::exact(expected[1]);
                let error = Bits212::of_bound(*error).to_f64();
                assert!(error <= 1e-30 * size, "{name}, {n}: {value:?} +- {error:e}");
                let off = rest.to_f64().abs();
                assert!(
                    off <= DIFFERENCE_TOLERANCE * size,
                    "{name}, {n}: {value:?} {expected:?} {off:e}"
                );
            }
        }
    }
}

macro_rules! system {
    ($name:literal) => {
        include_str!(concat!("../../validation/systems/", $name, ".system.toml"))
    };
}

#[test]
fn a_bouncing_ball_by_gravity_restitution_and_speed() {
    compare(system!("bouncing-ball"), &["g", "e", "start.v"], 6);
}

/// Thrown up from the table at speed v it is back after 2 v/g.
#[test]
fn the_first_impact_of_a_ball_has_its_derivatives_in_closed_form() {
    let by = |name: &str| {
        let found = gradients::<f64>(system!("bouncing-ball"), &Name::read(name), 1);
        found[0].as_ref().unwrap().iter().map(|it| it.0).collect::<Vec<f64>>()
    };
    let near = |found: Vec<f64>, expected: [f64; 3]| {
        let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-14, "{found:?} {expected:?}");
    };
    // g = 2, e = 1/2, v = 3/2: time 2 v/g, speed afterwards e v.
    near(by("start.v"), [1.0, 0.0, 0.5]);
    near(by("g"), [-0.75, 0.0, 0.0]);
    near(by("e"), [0.0, 0.0, 1.5]);
}

/// The start is on the table: moved up the ball falls later, moved down it is nowhere.
#[test]
fn a_start_on_a_guard_has_no_derivative_by_its_height() {
    let found = gradients::<Bits212>(system!("bouncing-ball"), &Name::read("start.x"), 3);
    assert_eq!(found.len(), 3);
    assert!(found.iter().all(|it| *it.as_ref().unwrap_err() == NoGradient::OneSided));
}

#[test]
fn a_relay_by_all_its_parameters() {
    let text = system!("relay-feedback");
    let system = file(text, &[]).system().unwrap();
    let names: Vec<&str> = system.parameters.keys().map(String::as_str).collect();
    compare(text, &names, 5);
}

#[test]
fn a_latched_buck_converter_by_its_parts() {
    compare(system!("buck-converter-latched"), &["Vin", "R", "C", "T", "gain", "start.i"], 5);
}

#[test]
fn the_percussive_oscillator_by_each_of_its_parameters() {
    let text = system!("percussive-oscillator");
    let system = file(text, &[]).system().unwrap();
    let names: Vec<&str> = system.parameters.keys().map(String::as_str).collect();
    assert!(names.len() >= 5);
    compare(text, &names, 5);
}

#[test]
fn a_driven_rigid_oscillator_by_its_forcing() {
    let text = system!("rigid-impact-oscillator");
    let system = file(text, &[]).system().unwrap();
    let names: Vec<&str> = system.parameters.keys().map(String::as_str).collect();
    compare(text, &names, 4);
}

#[test]
fn the_horizon_does_not_move() {
    let by_gravity = Name::read("g");
    let half = |_: &System| Bits212::exact(0.5);
    let rows = walk(system!("bouncing-ball"), &by_gravity, half, 9);
    let end = rows.last().unwrap().as_ref().unwrap();
    // x = v t - g t^2/2 and v = v - g t.
    assert_eq!(end.iter().map(|it| it.0.to_f64()).collect::<Vec<_>>(), [0.0, -0.125, -0.5]);
}

/// A horizon at the instant of an impact lies before or behind it.
#[test]
fn an_event_at_the_horizon_has_its_row_and_the_horizon_has_none() {
    let rows = walk(system!("bouncing-ball"), &Name::read("g"), |_| Bits212::exact(1.5), 9);
    let [impact, end] = &rows[..] else { panic!("{} rows", rows.len()) };
    assert!(impact.is_ok());
    assert_eq!(end.as_ref().unwrap_err(), &NoGradient::Undecided);
}

/// A ball thrown up at speed 2 with g = 8 turns at 1/4, after 1/4; it lands at 1/2.
fn thrown_ball(level: &str) -> String {
    format!(
        r#"
        schema = 1
        name = "thrown"
        states = ["x", "v"]
        [parameters]
        g = 8
        h = {level}
        [[mode]]
        name = "up"
        equations = ["x' = v", "v' = -g"]
        watch = [{{ name = "level", guard = "x > h", direction = "both" }}]
        until = [{{ name = "land", guard = "x < 0", reset = ["x = 0", "v = -v/2"] }}]
        [start]
        mode = "up"
        x = 0
        v = 2
        "#
    )
}

fn outcomes(text: &str, name: &str, until: f64) -> Vec<Result<(), NoGradient>> {
    let rows = walk(text, &Name::read(name), |_| Bits212::exact(until), 9);
    rows.into_iter().map(|it| it.map(|_| ())).collect()
}

#[test]
fn a_touch_without_a_crossing_has_two_sides() {
    let touched = Err(NoGradient::Touch);
    assert_eq!(outcomes(&thrown_ball("0.25"), "g", 0.6), [touched, touched]);
    assert_eq!(outcomes(&thrown_ball("0.25"), "g", 0.24), [Ok(())]);
    assert_eq!(outcomes(&thrown_ball("0.375"), "g", 0.6), [Ok(()), Ok(())]);
    // The second flight is lower and touches nothing.
    assert_eq!(outcomes(&thrown_ball("0.1875"), "g", 0.6).len(), 4);
    assert!(outcomes(&thrown_ball("0.1875"), "g", 0.6).iter().all(Result::is_ok));
}

/// 3 cos t + 4 sin t reaches 5 at the angle of (3, 4), and x'' = -4 x from x = 3 at the rate 8 has
/// the amplitude 5.
#[test]
fn a_touch_of_an_oscillation_or_of_the_forcing_has_two_sides() {
    let text = |forcing: &str, guard: &str| {
        format!(
            r#"
            schema = 1
            name = "swing"
            states = ["x", "v"]
            {forcing}
            [parameters]
            k = 4
            level = 5
            [[mode]]
            name = "on"
            equations = ["x' = v", "v' = -k*x"]
            watch = [{{ name = "top", guard = "{guard} > level" }}]
            [start]
            mode = "on"
            x = 3
            v = 8
            "#
        )
    };
    let free = text("", "x");
    let top = 0.5 * 0.8_f64.asin();
    assert_eq!(outcomes(&free, "k", top - 1e-6), [Ok(())]);
    assert_eq!(outcomes(&free, "k", top + 1e-6), [Err(NoGradient::Touch)]);
    let forced = text("forcing = { omega = 1 }", "3*cos + 4*sin");
    let angle = 4.0_f64.atan2(3.0);
    assert_eq!(outcomes(&forced, "level", angle - 1e-6), [Ok(())]);
    assert_eq!(outcomes(&forced, "level", angle + 1e-6), [Err(NoGradient::Touch)]);
    // The forcing touches the level for every stiffness.
    assert_eq!(outcomes(&forced, "k", angle + 1e-6), [Ok(())]);
}

/// The thrown ball touches its level at the top, whatever the tank beside it does. Its tap opens at
/// a level of the tank, which gives the ball a push.
#[test]
fn a_touch_of_what_the_name_does_not_move_has_a_derivative() {
    let text = |push: f64, level: f64| {
        format!(
            r#"
            schema = 1
            name = "beside"
            states = ["x", "v", "y"]
            [parameters]
            k = 0.25
            c = 0.96875
            g = 8
            h = {level}
            push = {push}
            [[mode]]
            name = "closed"
            equations = ["x' = v", "v' = -g", "y' = -k"]
            watch = [{{ name = "top", guard = "x > h" }}]
            [[mode.until]]
            name = "open"
            guard = "y < c"
            reset = ["v = v + push", "y = y/2"]
            next = [{{ mode = "open" }}]
            [[mode]]
            name = "open"
            equations = ["x' = v", "v' = -g", "y' = -4*y"]
            watch = [{{ name = "top", guard = "x > h" }}]
            [start]
            mode = "closed"
            x = 0
            v = 2
            y = 1
            "#
        )
    };
    let (touched, has_one) = ([Ok(()), Err(NoGradient::Touch)], [Ok(()), Ok(())]);
    // No push: the top is at 1/4, after the tap's time of 1/8.
    for (name, expected) in [
        ("k", has_one),
        ("c", has_one),
        ("start.y", has_one),
        ("g", touched),
        ("h", touched),
        ("push", touched),
        ("start.v", touched),
    ] {
        assert_eq!(outcomes(&text(0.0, 0.25), name, 0.5), expected, "{name}");
    }
    // A push by 1 at the height 3/16 and the speed 1 moves the top to 7/16, by the time of the tap.
    for name in ["k", "c", "start.y", "push"] {
        assert_eq!(outcomes(&text(1.0, 0.4375), name, 0.5), touched, "{name}");
    }
    assert_eq!(outcomes(&text(1.0, 0.4376), "c", 0.5), has_one);
}
