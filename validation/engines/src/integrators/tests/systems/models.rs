//! Systems written down by hand, as a file would be read.

use crate::system::by_hand::{mode, row, state, until};
use crate::system::{Direction, Mode, Row, System, Watch};

/// A system whose states are of size one.
fn system(name: &str, states: &[&str], [omega, phi]: [f64; 2], modes: Vec<Mode>) -> System {
    System {
        name: name.to_owned(),
        states: states.iter().map(|&state| state.to_owned()).collect(),
        scales: vec![1.0; states.len()],
        time_scale: if omega > 0.0 { 1.0 / omega } else { 1.0 },
        omega,
        phi,
        drift: Vec::new(),
        modes,
    }
}

fn watch(name: &str, guard: Row, direction: Direction) -> Watch {
    Watch { name: name.to_owned(), guard, direction }
}

/// A ball on a floor; v = 0 is watched, where it is highest.
pub(super) fn bouncing_ball(restitution: f64) -> System {
    let impact = until(
        "impact",
        row(2, &[(0, -1.0)]),
        Some(vec![row(2, &[]), row(2, &[(1, -restitution)])]),
        vec![(None, 0)],
    );
    let mut flight = mode("flight", &[state(2, 1), row(2, &[(4, -1.0)])], vec![impact]);
    flight.watch = vec![watch("top", state(2, 1), Direction::Falling)];
    system("bouncing-ball", &["x", "v"], [0.0, 0.0], vec![flight])
}

/// x'' + 2 zeta x' + x = A cos theta with a stop at d; x = 0 is watched in each
/// direction by an event of its own, v = 0 in both by one.
pub(super) fn rigid_oscillator(zeta: f64, amplitude: f64, omega: f64, stop: f64) -> System {
    let rates = [state(2, 1), row(2, &[(0, -1.0), (1, -2.0 * zeta), (2, amplitude)])];
    let impact = until(
        "impact",
        row(2, &[(0, 1.0), (4, -stop)]),
        Some(vec![row(2, &[(4, stop)]), row(2, &[(1, -0.8)])]),
        vec![(None, 0)],
    );
    let mut free = mode("free", &rates, vec![impact]);
    free.watch = vec![
        watch("up", state(2, 0), Direction::Rising),
        watch("down", state(2, 0), Direction::Falling),
        watch("turn", state(2, 1), Direction::Both),
    ];
    system("rigid-impact-oscillator", &["x", "v"], [omega, 0.0], vec![free])
}

/// Three lags in a row, driven by a relay with hysteresis.
pub(super) fn relay(delta: f64) -> System {
    let rates = |drive: f64| {
        [
            row(3, &[(0, -1.0), (1, 1.0)]),
            row(3, &[(1, -1.0), (2, 1.0)]),
            row(3, &[(2, -1.0), (5, drive)]),
        ]
    };
    let above = until("above", row(3, &[(0, 1.0), (5, -delta)]), None, vec![(None, 1)]);
    let below = until("below", row(3, &[(0, -1.0), (5, -delta)]), None, vec![(None, 0)]);
    let modes = vec![mode("up", &rates(1.0), vec![above]), mode("down", &rates(-1.0), vec![below])];
    system("relay-feedback", &["x1", "x2", "x3"], [0.0, 0.0], modes)
}

/// A mass on a spring that slips on a floor and sticks to it. The force on it is A cos theta - x,
/// it slips at `kinetic` and stays up to `sticking`.
pub(super) fn dry_friction(amplitude: f64, omega: f64, kinetic: f64, sticking: f64) -> System {
    let force = |sign: f64, less: f64| row(2, &[(0, -sign), (2, sign * amplitude), (4, -less)]);
    let slip = |sign: f64| [state(2, 1), force(1.0, sign * kinetic)];
    let stop = |sign: f64, back: usize| {
        let reset = Some(vec![state(2, 0), row(2, &[])]);
        let next = vec![(Some(force(-sign, sticking)), back), (None, 2)];
        until("stop", row(2, &[(1, -sign)]), reset, next)
    };
    let leave =
        |sign: f64, next: usize| until("leave", force(sign, sticking), None, vec![(None, next)]);
    let modes = vec![
        mode("right", &slip(1.0), vec![stop(1.0, 1)]),
        mode("left", &slip(-1.0), vec![stop(-1.0, 0)]),
        mode("stick", &[row(2, &[]), row(2, &[])], vec![leave(1.0, 0), leave(-1.0, 1)]),
    ];
    system("dry-friction-oscillator", &["x", "v"], [omega, 0.0], modes)
}

/// The buck converter whose ramp is a state, after Fossas and Olivar.
pub(super) fn buck_converter() -> System {
    let [resistance, capacity, inductance, period] = [22.0, 47e-6, 20e-3, 400e-6];
    let [input, reference, gain, low, high] = [32.5, 11.3, 8.4, 3.8, 8.2];
    let excess = |sign: f64| {
        let constant = -gain * reference - low;
        row(3, &[(0, sign * gain), (2, sign * (low - high)), (5, sign * constant)])
    };
    let rates = |input: f64| {
        [
            row(3, &[(0, -1.0 / (resistance * capacity)), (1, 1.0 / capacity)]),
            row(3, &[(0, -1.0 / inductance), (5, input / inductance)]),
            row(3, &[(5, 1.0 / period)]),
        ]
    };
    let clock = || {
        let reset = Some(vec![state(3, 0), state(3, 1), row(3, &[])]);
        let next = vec![(Some(excess(1.0)), 1), (None, 0)];
        until("clock", row(3, &[(2, 1.0), (5, -1.0)]), reset, next)
    };
    let on = vec![until("open", excess(1.0), None, vec![(None, 1)]), clock()];
    let off = vec![until("close", excess(-1.0), None, vec![(None, 0)]), clock()];
    let modes = vec![mode("on", &rates(input), on), mode("off", &rates(0.0), off)];
    let converter = system("buck-converter", &["v", "i", "r"], [0.0, 0.0], modes);
    System { scales: vec![10.0, 1.0, 1.0], time_scale: period, ..converter }
}

/// Equal spheres of diameter one on a line: their places, then their speeds.
pub(super) fn spheres(count: usize, restitution: f64) -> System {
    let size = 2 * count;
    let rates: Vec<Row> = (0..size)
        .map(|i| if i < count { state(size, count + i) } else { row(size, &[]) })
        .collect();
    let [stays, passes] = [0.5 * (1.0 - restitution), 0.5 * (1.0 + restitution)];
    let collision = |k: usize| {
        let [one, other] = [count + k, count + k + 1];
        let mut reset: Vec<Row> = (0..size).map(|i| state(size, i)).collect();
        reset[one] = row(size, &[(one, stays), (other, passes)]);
        reset[other] = row(size, &[(one, passes), (other, stays)]);
        let guard = row(size, &[(k, 1.0), (k + 1, -1.0), (size + 2, 1.0)]);
        until(&format!("collision-{k}"), guard, Some(reset), vec![(None, 0)])
    };
    let collisions = (0..count - 1).map(collision).collect();
    let names: Vec<String> =
        (0..size).map(|i| format!("{}{}", if i < count { "x" } else { "v" }, i % count)).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    system("spheres-in-a-row", &names, [0.0, 0.0], vec![mode("free", &rates, collisions)])
}

/// A ball that does not rebound from a shaking table.
pub(super) fn plastic_ball(amplitude: f64, omega: f64) -> System {
    let thrust = || row(2, &[(2, amplitude * omega * omega), (4, -1.0)]);
    let table = || Some(vec![row(2, &[(2, amplitude)]), row(2, &[(3, -amplitude * omega)])]);
    let impact = until(
        "impact",
        row(2, &[(0, -1.0), (2, amplitude)]),
        table(),
        vec![(Some(thrust()), 0), (None, 1)],
    );
    let detach = until("detach", thrust(), table(), vec![(None, 0)]);
    let modes = vec![
        mode("flight", &[state(2, 1), row(2, &[(4, -1.0)])], vec![impact]),
        mode("stuck", &[state(2, 1), row(2, &[(2, -amplitude * omega * omega)])], vec![detach]),
    ];
    system("plastic-ball-on-table", &["x", "v"], [omega, 0.0], modes)
}

/// Two states of which one is a million times as fast as the other.
pub(super) fn two_state_switching() -> System {
    let [fast, slow] = [2.7e6, 3.565_120_5];
    let rates = |lift: f64, target: f64| {
        [
            row(2, &[(0, -fast), (1, fast), (4, fast * lift)]),
            row(2, &[(1, -slow), (4, slow * target)]),
        ]
    };
    let high = until("high", row(2, &[(0, 1.0), (4, -5.8)]), None, vec![(None, 1)]);
    let low = until("low", row(2, &[(0, -1.0), (4, 2.5)]), None, vec![(None, 0)]);
    let modes =
        vec![mode("up", &rates(0.4, 5.5), vec![high]), mode("down", &rates(-0.3, 2.73), vec![low])];
    system("two-state-switching", &["y1", "y2"], [0.0, 0.0], modes)
}
