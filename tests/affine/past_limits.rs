//! Runs that go on after the limit at which impacts accumulate.

use super::{enclosed_events, events, names};
use percuss::affine::{Bits212, DoubleDouble, Event, What};
use percuss::number::Number;
use percuss::{Ending, Proved, System};
use proptest::prelude::*;

/// A ball that bounces until it is at rest, and after the time tau is thrown again, `throws` times.
/// The state s is the integral of x, m the sum of the changes of v at impacts, and n counts throws.
fn ball(numbers: &str) -> System {
    let text = format!(
        r#"
        schema = 1
        name = "ball"
        states = ["x", "v", "s", "m", "c", "n"]
        parameters = {{ {numbers} }}
        [[mode]]
        name = "flight"
        equations = ["x' = v", "v' = -g", "s' = x", "m' = 0", "c' = 0", "n' = 0"]
        [[mode.until]]
        name = "impact"
        guard = "x < 0"
        reset = ["x = 0", "v = -e*v", "m = m - (1 + e)*v"]
        [mode.until.accumulates_to]
        reset = ["x = 0", "v = 0", "c = 0"]
        next = [{{ when = "n > 3/2", mode = "over" }}, {{ mode = "rest" }}]
        [[mode]]
        name = "rest"
        equations = ["x' = 0", "v' = 0", "s' = x", "m' = 0", "c' = 1", "n' = 0"]
        [[mode.until]]
        name = "throw"
        guard = "c > tau"
        reset = ["v = u", "n = n + 1"]
        next = [{{ mode = "flight" }}]
        [[mode]]
        name = "over"
        equations = ["x' = 0", "v' = 0", "s' = x", "m' = 0", "c' = 0", "n' = 0"]
        [start]
        mode = "flight"
        x = 0
        v = "u"
        s = 0
        m = 0
        c = 0
        n = 0
        "#
    );
    System::from_toml(&text).unwrap()
}

fn limits<T: Number>(events: &[Event<T>]) -> Vec<&Event<T>> {
    events.iter().filter(|it| matches!(it.what, What::Limit(..))).collect()
}

/// The time, s and m at the n-th limit of the ball: flights of 2 u/g, times e from one to the next.
fn closed_form<T: Number>([u, g, e, tau]: [f64; 4], n: f64) -> [T; 3] {
    let [u, g, e, tau, n] = [u, g, e, tau, n].map(T::exact);
    let (one, two) = (T::one(), T::exact(2.0));
    let bounces = two * u / (g * (one - e));
    let area = two * u * u * u / (T::exact(3.0) * g * g * (one - e * e * e));
    let kicks = (one + e) * u / (one - e);
    [n * bounces + (n - one) * tau, n * area, n * kicks]
}

/// Compares the time, s and m at all limits with known ones, within the errors that the run has or
/// these shares.
pub fn judge<T: Number>(events: &[Event<T>], known: impl Fn(f64) -> [T; 3], shares: [f64; 2]) {
    let [share, most] = shares;
    let all = limits(events);
    assert_eq!(all.len(), 3);
    for (n, it) in (1..).zip(all) {
        let known = known(f64::from(n));
        let found = [it.time.value(), it.state[2], it.state[3]];
        let errors = it.errors.as_ref().map(|it| [it.time, it.state[2], it.state[3]]);
        for (k, (known, found)) in known.into_iter().zip(found).enumerate() {
            let size = known.to_f64().abs();
            let apart = (known - found).to_f64().abs();
            let room = errors.map_or(share * size, |it| percuss::number::Bound::to_f64(it[k]));
            assert!(apart <= room + share * size, "{n}, {k}: {apart:e} of {size}, {room:e}");
            assert!(room <= most * size, "{n}, {k}: {room:e} of {size}");
        }
        assert_eq!(it.state[..2].iter().map(|it| it.to_f64()).collect::<Vec<_>>(), [0.0, 0.0]);
        assert_eq!(it.mode, if n == 3 { 2 } else { 1 });
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// A run in f64 rounds some hundred events. Enclosed ones hold the closed form; with b bits
    /// their errors at a limit are below the second order there, 2^-(2 b/3). A limit multiplies
    /// what it inherits by at most 1 + 2 e/(1 - e) <= 39, by the jumps that it sums.
    #[test]
    fn a_ball_comes_to_rest_where_the_series_says(
        u in 0.5_f64..20.0, g in 1.0_f64..12.0, e in 0.02_f64..0.95, tau in 0.1_f64..3.0,
    ) {
        let ball = ball(&format!("u = {u:?}, g = {g:?}, e = {e:?}, tau = {tau:?}"));
        let numbers = [u, g, e, tau];
        let end = closed_form::<f64>(numbers, 3.0)[0] + 1.0;
        judge(&events::<f64>(&ball, end), |n| closed_form(numbers, n), [1e-12, 1e-12]);
        let most = |bits: f64| 39_f64.powi(2) * (-2.0 * bits / 3.0).exp2();
        let narrow = enclosed_events::<DoubleDouble>(&ball, end);
        judge(&narrow, |n| closed_form(numbers, n), [1e-29, most(106.0)]);
        let wide = enclosed_events::<Bits212>(&ball, end);
        judge(&wide, |n| closed_form(numbers, n), [1e-60, most(212.0)]);
        let [f64s, wide] = [names(&ball, &events::<f64>(&ball, end)), names(&ball, &wide)];
        prop_assert_eq!(&f64s, &wide);
        prop_assert_eq!(f64s.last().map(String::as_str), Some("end"));
    }
}

/// A ball on a table that moves as A cos theta leaves it where A omega^2 cos theta = g.
fn table(e: &str) -> System {
    let text = format!(
        r#"
        schema = 1
        name = "table"
        states = ["x", "v"]
        forcing = {{ omega = 1.25, phi = 1 }}
        parameters = {{ A = 1.0, g = 1.0, e = {e} }}
        [[mode]]
        name = "flight"
        equations = ["x' = v", "v' = -g"]
        [[mode.until]]
        name = "impact"
        guard = "A*cos > x"
        reset = ["x = A*cos", "v = -(1 + e)*A*omega*sin - e*v"]
        [mode.until.accumulates_to]
        reset = ["x = A*cos", "v = -A*omega*sin"]
        next = "stuck"
        [[mode]]
        name = "stuck"
        equations = ["x' = v", "v' = -A*omega^2*cos"]
        [[mode.until]]
        name = "detach"
        guard = "A*omega^2*cos > g"
        reset = ["x = A*cos", "v = -A*omega*sin"]
        next = [{{ mode = "flight" }}]
        [start]
        mode = "flight"
        x = "A*cos + 1/50"
        v = "-A*omega*sin"
        "#
    );
    System::from_toml(&text).unwrap()
}

/// After the limit the ball rides on the table, and leaves it at an angle that is known; 17 digits
/// are proved of each time and state.
#[test]
fn a_ball_sticks_to_its_table_and_leaves_it() {
    for e in ["0.3", "0.8", "0"] {
        let table = table(e);
        let solver = table.solver::<Proved>().unwrap();
        let proved: Vec<_> = solver.run().until(6.0).unwrap().collect();
        let at = proved.iter().position(|it| it.name() == "accumulation").unwrap();
        let [limit, detach] = [&proved[at], &proved[at + 1]];
        assert_eq!((limit.mode(), detach.name()), ("stuck", "detach"));
        let angle = 1.25 * limit.time().midpoint() + 1.0;
        assert!((limit.state()[0].midpoint() - angle.cos()).abs() < 1e-14);
        assert!((limit.state()[1].midpoint() + 1.25 * angle.sin()).abs() < 1e-14);
        let angle = std::f64::consts::TAU - 0.64_f64.acos();
        assert!((detach.time().midpoint() - (angle - 1.0) / 1.25).abs() < 1e-14);
        let solver = table.solver::<f64>().unwrap();
        let plain: Vec<_> = solver.run().until(6.0).unwrap().collect();
        assert_eq!(plain.len(), proved.len());
        // The flight after it comes within 1e-3 of a graze and magnifies errors.
        for (a, b) in plain.iter().zip(&proved).take(at + 2) {
            assert_eq!(a.name(), b.name());
            assert!((a.time() - b.time().midpoint()).abs() < 1e-12, "{a:?} {b:?}");
        }
    }
}

/// Without restitution the first impact is the limit, at the same time; without the key the run
/// makes no progress there.
#[test]
fn an_impact_without_restitution_rests_at_once() {
    let table = table("0");
    let solver = table.solver::<Proved>().unwrap();
    let all: Vec<_> = solver.run().until(2.0).unwrap().collect();
    let names: Vec<_> = all.iter().map(percuss::Event::name).collect();
    assert_eq!(names, ["impact", "accumulation", "end"]);
    assert_eq!(all[0].time().midpoint(), all[1].time().midpoint());
    let mut ends = table.clone();
    ends.modes[0].until[0].accumulates_to = None;
    let solver = ends.solver::<Proved>().unwrap();
    let last = solver.run().until(2.0).unwrap().last().unwrap();
    assert_eq!(last.ending(), Some(Ending::NoProgress));
}

/// With u = 1, g = 2 and e = 1/2 the limit is at 2, and all numbers are exact.
const EXACT_PARAMETERS: &str = "u = 1, g = 2, e = 0.5, tau = 1";

/// A horizon between the last row and the limit is reached by impacts that have no rows; so are
/// samples there.
#[test]
fn impacts_without_rows_lead_to_a_horizon_before_the_limit() {
    let ball = ball(EXACT_PARAMETERS);
    // After the impact at 2 - 2^-k the ball flies for 2^-(k + 1).
    for k in [33, 36, 40] {
        let half_way = 2.0 - 0.75 / 2_f64.powi(k);
        let solver = ball.solver::<Proved>().unwrap();
        let all: Vec<_> = solver.run().until(half_way).unwrap().collect();
        let end = all.last().unwrap();
        assert_eq!((end.ending(), end.mode()), (Some(Ending::Horizon), "flight"));
        let height = 2_f64.powi(-2 * k - 4);
        assert_eq!(end.state()[0].midpoint(), height);
        let solver = ball.solver::<f64>().unwrap();
        let mut plain = solver.run().until(half_way).unwrap();
        assert_eq!(plain.by_ref().last().map(|it| it.state()[0]), Some(height));
        assert!(plain.go_on(2.5));
        let rest: Vec<_> = plain.collect();
        let names: Vec<_> = rest.iter().map(percuss::Event::name).collect();
        assert_eq!((names, *rest[0].time()), (vec!["accumulation", "end"], 2.0));
    }
}

/// A limit that leads back into its own mode is told from progress: the run ends.
#[test]
fn limits_that_lead_to_themselves_make_no_progress() {
    let mut ball = ball(EXACT_PARAMETERS);
    let limit = ball.modes[0].until[0].accumulates_to.as_mut().unwrap();
    limit.next.iter_mut().for_each(|it| it.mode = 0);
    let solver = ball.solver::<f64>().unwrap();
    let last = solver.run().until(9.0).unwrap().last().unwrap();
    assert_eq!(last.ending(), Some(Ending::NoProgress));
    let solver = ball.solver::<Proved>().unwrap();
    let last = solver.run().until(9.0).unwrap().last().unwrap();
    assert_eq!(last.ending(), Some(Ending::NoProgress));
}

/// No derivative is taken across a limit, and it says so; those before it are there.
#[test]
fn no_derivative_is_taken_across_a_limit() {
    let ball = ball(EXACT_PARAMETERS);
    let solver = ball.solver::<f64>().unwrap();
    let all: Vec<_> = solver.run().gradients(["g"]).unwrap().until(4.0).unwrap().collect();
    let at = all.iter().position(|it| it.name() == "accumulation").unwrap();
    assert!(all[at - 1].gradient("g").unwrap().is_ok());
    for event in &all[at..] {
        let reason = event.gradient("g").unwrap().unwrap_err();
        assert_eq!(reason, percuss::NoGradient::Accumulation);
    }
    // Nor at a horizon that impacts without rows lead to.
    let before = solver.run().gradients(["g"]).unwrap().until(2.0 - 0.75 / 2_f64.powi(36)).unwrap();
    let end = before.last().unwrap();
    assert_eq!(end.ending(), Some(Ending::Horizon));
    assert_eq!(end.gradient("g").unwrap().unwrap_err(), percuss::NoGradient::Accumulation);
}

/// A mass that a force P + A cos theta presses against a wall, where it chatters and sticks: it is
/// back and at rest there long before the force pulls again.
const PRESSED: &str = r#"
schema = 1
name = "pressed"
states = ["x", "v"]
forcing = { omega = 1, phi = 0 }
parameters = { P = 0.7, A = 1.0, r = 0.4 }
[[mode]]
name = "free"
equations = ["x' = v", "v' = P + A*cos"]
[[mode.until]]
name = "impact"
guard = "x > 0"
reset = ["x = 0", "v = -r*v"]
accumulates_to = { reset = ["x = 0", "v = 0"], next = "stuck" }
[[mode]]
name = "stuck"
equations = ["x' = 0", "v' = 0"]
[[mode.until]]
name = "detach"
guard = "P + A*cos < 0"
next = [{ mode = "free" }]
[start]
mode = "free"
x = "-1/10"
v = 0
"#;

/// The mass leaves the wall where the force changes its sign, at cos theta = -P/A, and comes back
/// to stick in each period: what was before is forgotten.
#[test]
fn a_pressed_mass_chatters_and_sticks_in_each_period() {
    let pressed = System::from_toml(PRESSED).unwrap();
    let solver = pressed.solver::<Proved>().unwrap();
    let all: Vec<_> = solver.run().until(60.0).unwrap().collect();
    let known = |k: usize| (-0.7_f64).acos() + std::f64::consts::TAU * k as f64;
    let times = |name| all.iter().filter(move |it| it.name() == name).map(|it| it.time());
    assert_eq!(times("detach").count(), 10);
    for (k, time) in times("detach").enumerate() {
        assert!((time.midpoint() - known(k)).abs() < 1e-14 * known(k), "{k}: {time:?}");
    }
    // From the second on one limit is that of the period before.
    let limits: Vec<f64> = times("accumulation").map(Proved::midpoint).collect();
    for pair in limits[1..].windows(2) {
        assert!((pair[1] - pair[0] - std::f64::consts::TAU).abs() < 1e-13, "{pair:?}");
    }
    let plain = pressed.solver::<f64>().unwrap();
    let plain: Vec<_> = plain.run().until(60.0).unwrap().collect();
    assert_eq!(plain.len(), all.len());
    for (plain, proved) in plain.iter().zip(&all) {
        assert_eq!(plain.name(), proved.name());
        assert!((plain.time() - proved.time().midpoint()).abs() < 1e-12, "{plain:?}");
    }
}

/// The times of returns past limits; from there a motion that has stuck has forgotten all but them.
#[test]
fn returns_pass_limits() {
    use percuss::system::Section;
    let pressed = System::from_toml(PRESSED).unwrap();
    let solver = pressed.solver::<f64>().unwrap();
    let map = solver.section(&Section::event("detach")).unwrap();
    let mut returns = map.returns(pressed.start().unwrap()).unwrap();
    let first = returns.next().unwrap().unwrap();
    assert!((first.time - (-0.7_f64).acos()).abs() < 1e-14);
    let orbit = map.orbit(&returns.place().unwrap(), 1).unwrap();
    assert!(orbit.multipliers.iter().flatten().all(|it| it.abs() < 1e-12), "{orbit:?}");
    assert_eq!(orbit.event_names(&pressed), ["impact@free", "detach@stuck"]);
    let exponents = map.exponents(&returns.place().unwrap(), 2, 3, &mut |_| ()).unwrap();
    assert_eq!(exponents.per_return, [f64::NEG_INFINITY; 2]);
}

/// Two masses on springs, the first of which strikes a wall, sticks to it while it is pressed, and
/// leaves it; the impacts kick the second one too.
pub fn two_masses([k, c, load, r, kick]: [f64; 5]) -> String {
    format!(
        r#"
        schema = 1
        name = "two-masses"
        states = ["x", "v", "y", "w"]
        forcing = {{ omega = 0.9, phi = 0.4 }}
        parameters = {{ k = {k:?}, c = {c:?}, load = {load:?}, r = {r:?}, kick = {kick:?} }}
        [let]
        force = "load + cos - x - k*(x - y)"
        [[mode]]
        name = "free"
        equations = ["x' = v", "v' = force - c*v", "y' = w", "w' = k*(x - y) - y - c*w"]
        [[mode.until]]
        name = "impact"
        guard = "x > 1/3"
        reset = ["x = 1/3", "v = -r*v", "w = w + kick*(1 + r)*v"]
        [mode.until.accumulates_to]
        reset = ["x = 1/3", "v = 0"]
        next = [{{ when = "force > 0", mode = "stuck" }}, {{ mode = "free" }}]
        [[mode]]
        name = "stuck"
        equations = ["x' = 0", "v' = 0", "y' = w", "w' = k*(x - y) - y - c*w"]
        [[mode.until]]
        name = "detach"
        guard = "force < 0"
        next = [{{ mode = "free" }}]
        [start]
        mode = "free"
        x = 0
        v = 0
        y = 0
        w = 0
        "#
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Enclosures in 106 and in 212 bits overlap at each event, past limits too, as both hold the
    /// motion; f64 is near them until errors have grown.
    #[test]
    fn enclosures_overlap_past_limits(
        k in 0.1_f64..2.0, c in 0.01_f64..0.3, load in 0.3_f64..1.0, r in 0.05_f64..0.7,
        kick in 0.0_f64..0.5,
    ) {
        let masses = System::from_toml(&two_masses([k, c, load, r, kick])).unwrap();
        overlap(&masses, 25.0);
    }
}

/// Compares the events of a system in 106 and in 212 bits, up to the first that is not decided.
pub fn overlap(system: &System, until: f64) {
    let [narrow, wide] = [
        enclosed_events::<DoubleDouble>(system, until).iter().map(row).collect::<Vec<_>>(),
        enclosed_events::<Bits212>(system, until).iter().map(row).collect::<Vec<_>>(),
    ];
    for (narrow, wide) in narrow.iter().zip(&wide) {
        if narrow.0 == "undecided" || wide.0 == "undecided" {
            break;
        }
        assert_eq!(narrow.0, wide.0);
        for (a, b) in narrow.1.iter().zip(&wide.1) {
            let apart = (a.0 - b.0).to_f64().abs();
            // The comparison itself is made in 106 bits.
            let rounding = 1e-31 * a.0.to_f64().abs();
            assert!(apart <= a.1 + b.1 + rounding, "{} {apart:e} {:e}", narrow.0, a.1);
        }
    }
}

/// An event's name, its time and states with their errors.
fn row<T: Number>(event: &Event<T>) -> (String, Vec<(DoubleDouble, f64)>) {
    let errors = event.errors.as_ref().expect("errors");
    let bound = |it: &T::Bound| percuss::number::Bound::to_f64(*it);
    let number = |it: T| {
        let high = it.to_f64();
        DoubleDouble::exact(high) + DoubleDouble::exact((it - T::exact(high)).to_f64())
    };
    let states = event.state.iter().zip(&errors.state).map(|(it, off)| (number(*it), bound(off)));
    let time = (number(event.time.value()), bound(&errors.time));
    let name = match &event.what {
        What::End(percuss::affine::Ending::Undecided) => "undecided".to_owned(),
        what => format!("{what:?}"),
    };
    (name, std::iter::once(time).chain(states).collect())
}

/// Impacts that come ever faster magnify no errors: the masses stick and leave the wall three
/// times, and all digits are proved.
#[test]
fn two_masses_stick_to_the_wall_again_and_again() {
    let masses = System::from_toml(&two_masses([0.7, 0.1, 0.6, 0.3, 0.2])).unwrap();
    let solver = masses.solver::<Proved>().unwrap();
    let proved: Vec<_> = solver.run().until(25.0).unwrap().collect();
    let named = |name| proved.iter().filter(|it| it.name() == name).count();
    assert_eq!(["accumulation", "detach", "end"].map(named), [3, 3, 1]);
    let solver = masses.solver::<f64>().unwrap();
    let plain: Vec<_> = solver.run().until(25.0).unwrap().collect();
    assert_eq!(plain.len(), proved.len());
    for (plain, proved) in plain.iter().zip(&proved) {
        assert_eq!(plain.name(), proved.name());
        assert!((plain.time() - proved.time().midpoint()).abs() < 1e-11, "{plain:?} {proved:?}");
    }
}
