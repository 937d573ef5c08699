//! Systems whose events are known.

use super::{BALL, PLASTIC, RELAY, SPHERES, STIFF, agreed_events, events, names, system};
use percuss::affine::DoubleDouble;
use percuss::affine::{Ending, Solver, System, SystemFile, What};

fn with(text: &str, parameters: &[(&str, f64)]) -> System {
    let mut file = SystemFile::read("test.system.toml", text).unwrap();
    for (name, value) in parameters {
        file.set(name, *value, "test").unwrap();
    }
    file.system().unwrap()
}

/// With g = 2 and e = 1/2 all times are sums of powers of two: the arithmetic is exact.
#[test]
fn a_ball_bounces_at_the_instants_of_a_geometric_series() {
    let ball = system(BALL);
    let events = events::<f64>(&ball, 10.0);
    let (mut time, mut flight) = (0.0, 1.0);
    let mut impacts = 0;
    for event in &events {
        match event.what {
            What::Until(..) => {
                time += flight;
                flight *= 0.5;
                impacts += 1;
                assert_eq!((event.time.value(), &event.state), (time, &vec![0.0, flight]));
            }
            What::Watch(_, watch) => {
                // The height of 1/4 is touched by the first flight, and not crossed.
                assert_eq!((watch, event.time.value()), (0, time + 0.5 * flight));
            }
            What::Start | What::Limit(..) => panic!("a run begins once, and ends at its limit"),
            What::End(ending) => {
                let Ending::Accumulation(from, to) = ending else { panic!("{ending:?}") };
                let left = 2.0 - time;
                assert!(from <= left && left <= to && to <= 1.0 / f64::from(1 << 30), "{ending:?}");
            }
        }
    }
    assert_eq!(impacts, 31);
}

/// Half periods T from C (1 + e^AT)^-1 A^-1 (e^AT - 1) B = delta, which a computation in 60 digits
/// gave.
#[test]
fn a_relay_settles_on_its_limit_cycle() {
    for (delta, half_period) in [(1e-2, 1.919201), (1e-4, 1.840734), (1e-6, 1.839883)] {
        let relay = with(RELAY, &[("delta", delta)]);
        let events = agreed_events(&relay, 200.0, 1e-10);
        let [.., (_, a), (_, b), (end, _)] = events.as_slice() else { panic!("too few events") };
        assert_eq!(end, "end");
        assert!((b - a - half_period).abs() < 1e-6, "{delta}: {}", b - a);
    }
}

/// The instants of ARGESIM's comparison C5, to the digits of an independent computation in balls.
#[test]
fn a_stiff_system_switches_at_its_published_instants() {
    let instants = [1.108_306_167_771, 2.129_685_355_155, 3.054_152_906_996, 4.075_532_094_379];
    let events = agreed_events(&system(STIFF), 5.0, 4e-15);
    for (event, instant) in events.iter().zip(instants) {
        assert!((event.1 - instant).abs() < 6e-13, "{event:?}");
    }
    assert!((events[4].1 - 4.999_999_646_220).abs() < 6e-13);
    // Dwells of 2e-7 and 5e-6.
    let fast = with(STIFF, &[("d2", -1.25), ("d4", 4.33), ("lower", 5.1)]);
    let events = agreed_events(&fast, 1.1153, 1e-12);
    let dwells: Vec<_> = events.windows(2).map(|it| it[1].1 - it[0].1).collect();
    assert!(dwells.len() > 4 && dwells[..4].iter().all(|it| *it < 6e-6), "{dwells:?}");
}

#[test]
fn collisions_in_one_instant_follow_the_order_of_the_file() {
    let spheres = system(SPHERES);
    let rows = events::<f64>(&spheres, 3.0);
    assert_eq!(names(&spheres, &rows), ["left", "right", "left", "end"]);
    // In f64 the sum x1 - x2 + 1 is zero at 1 and at the number before it.
    for row in &rows[..3] {
        assert!((row.time.value() - 1.0).abs() <= f64::EPSILON / 2.0);
    }
    for (own, exact) in rows[2].state.iter().zip([1.0, 2.0, 3.0, -1.0, 0.0, 1.0]) {
        assert!((own - exact).abs() <= f64::EPSILON / 2.0 * exact.abs());
    }
    // With losses the order matters: the outer velocities differ, and momentum is kept.
    let soft = with(SPHERES, &[("e", 0.5)]);
    let rows = events::<f64>(&soft, 3.0);
    assert_eq!(names(&soft, &rows), ["left", "right", "left", "end"]);
    let velocities = &rows[2].state[3..];
    assert_eq!(velocities, [-0.359375, 0.046875, 0.3125]);
    // Below 7 - 4 sqrt 3 infinitely many follow.
    let plastic = with(SPHERES, &[("e", 0.05)]);
    let rows = events::<f64>(&plastic, 3.0);
    assert_eq!(names(&plastic, &rows).last().unwrap(), "no-progress");
    assert_eq!(rows.len(), 65);
}

/// At detachment gap, velocity and acceleration vanish, which rounding does not show.
#[test]
fn a_plastic_ball_detaches_with_a_triple_zero() {
    let events = agreed_events(&system(PLASTIC), 60.0, 1e-12);
    assert!(events.len() > 12);
    let kinds = events[..6].iter().map(|it| it.0.as_str()).collect::<Vec<_>>();
    assert_eq!(kinds, ["detach", "impact", "detach", "impact", "detach", "impact"]);
    // The thrust is zero where cos theta = 1/omega^2, on the way up.
    let angle = 1.25 * events[0].1;
    assert!((angle.cos() - 0.64).abs() < 1e-15 && angle.sin() < 0.0);
}

#[test]
fn a_backward_run_knows_watched_guards_until_it_leaves_its_mode() {
    let ball = system(BALL);
    let mut start = ball.start.clone().unwrap();
    start.state = [[0, 0, 0], [0, 0, -1]].map(|it| it.map(Into::into)).to_vec();
    start.time = 1.into();
    let solver = Solver::<DoubleDouble>::backward(&ball).unwrap();
    let run = solver.run(&start, percuss::number::Number::exact(-5.0)).unwrap();
    let events: Vec<_> = run.collect();
    // Back in time the speed crosses zero the other way, which is not watched.
    assert_eq!(names(&ball, &events), ["leaves-domain"]);
    assert!(events[0].time.value().words().0.abs() < 1e-31);
}
