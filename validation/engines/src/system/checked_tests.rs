//! Systems that are refused, and facts that are known before a system is run.

use super::*;
use crate::equations::{Equations, Numbers};
use crate::system::{AffineEquations, Until, Values, Watch};

/// A ball that does not rebound from a shaking table, A = 1 and omega = 1.25.
fn table() -> System {
    let thrust = vec![0.0, 0.0, 1.5625, 0.0, -1.0];
    let on_table = Some(vec![vec![0.0, 0.0, 1.0, 0.0, 0.0], vec![0.0, 0.0, 0.0, -1.25, 0.0]]);
    let impact = Until {
        name: "impact".to_owned(),
        guard: vec![-1.0, 0.0, 1.0, 0.0, 0.0],
        reset: on_table.clone(),
        next: vec![(Some(thrust.clone()), 0), (None, 1)],
    };
    let detach =
        Until { name: "detach".to_owned(), guard: thrust, reset: on_table, next: vec![(None, 0)] };
    let mode = |name: &str, b: [f64; 2], c: f64, until: Until| Mode {
        name: name.to_owned(),
        a: vec![vec![0.0, 1.0], vec![0.0, 0.0]],
        b: vec![[0.0, 0.0], b],
        c: vec![0.0, c],
        until: vec![until],
        watch: Vec::new(),
    };
    System {
        name: "table".to_owned(),
        states: vec!["x".to_owned(), "v".to_owned()],
        scales: vec![1.0; 2],
        time_scale: 0.8,
        omega: 1.25,
        phi: 0.0,
        drift: Vec::new(),
        modes: vec![
            mode("flight", [0.0, 0.0], -1.0, impact),
            mode("stuck", [-1.5625, 0.0], 0.0, detach),
        ],
    }
}

/// A detachment puts the ball on the table with the table's speed, where the table's acceleration
/// is that of gravity: the gap, its rate and its acceleration are zero, whatever rounding says.
#[test]
fn a_detachment_begins_a_flight_with_a_triple_zero() {
    let checked = CheckedSystem::new(table());
    let Ok(checked) = checked else { unreachable!("{:?}", checked.err()) };
    assert_eq!(checked.modes[1].until[0].next[0].zeros, [0b00111]);
    // The angle at which the table lets go, but for an error that rounding does not make.
    let t = (TAU - 0.64_f64.acos() - 1e-9) / 1.25;
    let equations = AffineEquations::new(&checked);
    let (mode, state) = equations.after_event(1, 0, t, &Values::from_slice(&[0.0, 0.0]));
    let entered = equations.enter(Some((1, 0)), mode, t, &state);
    assert!(mode == 0 && entered.is_zero(0) && entered.fires.is_none(), "{entered:?}");
    // Without the event it is not known, and the ball seems to be past the table's threshold.
    assert_eq!(equations.enter(None, mode, t, &state).fires, Some(0));
}

/// An impact keeps the table's thrust, and so does not make it zero.
#[test]
fn an_impact_makes_the_gap_and_its_rate_zero_and_no_more() {
    let checked = CheckedSystem::new(table());
    let Ok(checked) = checked else { unreachable!("{:?}", checked.err()) };
    let next = &checked.modes[0].until[0].next;
    assert_eq!((next[0].zeros[0], next[0].when_zeros), (0b00011, 0));
}

#[test]
fn what_is_not_whole_is_refused() {
    let refused = |change: fn(&mut System)| {
        let mut system = table();
        change(&mut system);
        CheckedSystem::new(system).err().map(|it| it.reason).unwrap_or_default()
    };
    assert!(refused(|it| it.modes.clear()).contains("needs a mode"));
    assert!(refused(|it| it.time_scale = f64::NAN).contains("time scale"));
    assert!(refused(|it| it.scales[0] = 0.0).contains("scale"));
    assert!(refused(|it| it.modes[1].c[0] = f64::INFINITY).contains("mode stuck"));
    assert!(refused(|it| it.modes[0].until[0].guard.truncate(3)).contains("event impact"));
    assert!(refused(|it| it.modes[0].until[0].next.truncate(1)).contains("no mode follows"));
    assert!(refused(|it| it.modes[0].until[0].next[1].1 = 7).contains("no mode follows"));
    let watch = || Watch { name: "odd".to_owned(), ..Watch::default() };
    let many = |it: &mut System| {
        let guard = it.modes[0].until[0].guard.clone();
        let one = Watch { guard, direction: Direction::Both, ..Watch::default() };
        it.modes[0].watch = vec![one; 12];
    };
    assert!(refused(many).contains("25 guards"));
    let mut system = table();
    system.modes[0].watch.push(watch());
    assert!(CheckedSystem::new(system).is_err());
    assert!(CheckedSystem::new(table()).is_ok());
}
