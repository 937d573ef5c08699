//! The states and guards that are zero by the model, whatever rounded numbers say: at the start,
//! and after an event by that event alone.

use crate::cli::shared::no_progress::times;
use percuss::System;
use percuss::affine::{Rational, Row, StartPoint, Until, is_multiple};

/// The states and guards that are zero by the model.
#[derive(Debug, Default, PartialEq)]
pub(super) struct ZeroNames {
    pub(super) states: Vec<String>,
    /// The event and the mode of each guard.
    pub(super) guards: Vec<[String; 2]>,
}

/// The zeros at the start.
pub(super) fn at_start(system: &System, start: &StartPoint) -> ZeroNames {
    let angle = |omega: &Rational, phi: &Rational| &(omega * &start.time) + phi;
    let is_at_zero_angle =
        system.forcing.as_ref().is_none_or(|it| angle(&it.omega, &it.phi).is_zero());
    let is_zero = |row: &Row| {
        let [cos, sin, one] = at(system, start, row);
        // At the angle 0 cos is 1 and sin is 0; elsewhere the three are independent.
        match is_at_zero_angle {
            true => (cos + one).is_zero(),
            false => [cos, sin, one].iter().all(Rational::is_zero),
        }
    };
    names(system, &[start.mode], is_zero)
}

/// A row at the start, as factors of cos, sin and 1.
fn at(system: &System, start: &StartPoint, row: &Row) -> [Rational; 3] {
    let mut sums = match (row.as_slice(), system.forcing.is_some()) {
        ([.., cos, sin, one], true) => [cos.clone(), sin.clone(), one.clone()],
        ([.., one], _) => [Rational::ZERO, Rational::ZERO, one.clone()],
        ([], _) => [Rational::ZERO, Rational::ZERO, Rational::ZERO],
    };
    for (factor, terms) in row.iter().zip(&start.state) {
        for (sum, term) in sums.iter_mut().zip(terms) {
            *sum += &(factor * term);
        }
    }
    sums
}

/// The zeros after an event that follow from its guard's zero before the reset, in the modes that
/// may come next. Earlier events may add more.
pub(super) fn after(system: &System, until: &Until) -> ZeroNames {
    let mut modes: Vec<usize> = until.next.iter().map(|it| it.mode).collect();
    modes.sort_unstable();
    modes.dedup();
    names(system, &modes, |row| is_multiple(&times(row, &until.reset), &until.guard))
}

/// The states, and the guards of these modes, whose rows are zero.
fn names(system: &System, modes: &[usize], is_zero: impl Fn(&Row) -> bool) -> ZeroNames {
    let unit = |n: usize| {
        let entries = (0..system.dimension()).map(|k| Rational::from(u8::from(k == n)));
        entries.collect::<Row>()
    };
    let zero_states = system.states.iter().enumerate().filter(|(n, _)| is_zero(&unit(*n)));
    let states = zero_states.map(|(_, name)| name.clone()).collect();
    let mut guards = Vec::new();
    for mode in modes.iter().map(|it| &system.modes[*it]) {
        let until = mode.until.iter().map(|it| (&it.name, &it.guard));
        let all = until.chain(mode.watch.iter().map(|it| (&it.name, &it.guard)));
        let zero = all.filter(|(_, guard)| is_zero(guard));
        guards.extend(zero.map(|(name, _)| [name.clone(), mode.name.clone()]));
    }
    ZeroNames { states, guards }
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "a panic is a failed test")]
mod tests {
    use super::*;
    use percuss::gallery;

    #[test]
    fn a_ball_that_bounced_is_on_the_floor() {
        let ball = System::from_toml(gallery::BOUNCING_BALL).expect("a system");
        let zero = after(&ball, &ball.modes[0].until[0]);
        assert_eq!(zero.states, ["x"]);
        assert_eq!(zero.guards, [["impact", "flight"].map(str::to_owned)]);
        // It starts at rest, above the floor.
        let zero = at_start(&ball, ball.start().expect("a start"));
        assert_eq!((zero.states, zero.guards.len()), (vec!["v".to_owned()], 0));
    }

    /// At the angle 0 the position of a table, A cos, is the number A.
    #[test]
    fn a_start_at_the_angle_0_is_rational() {
        let text = r#"
            schema = 1
            name = "table"
            states = ["x"]
            forcing = { omega = 1 }
            [[mode]]
            name = "on"
            equations = ["x' = 1"]
            watch = [{ name = "meets", guard = "x > cos" }]
            [start]
            mode = "on"
            x = 1
        "#;
        let met = |text: &str| {
            let system = System::from_toml(text).expect("a system");
            at_start(&system, system.start().expect("a start")).guards.len()
        };
        assert_eq!(met(text), 1);
        assert_eq!(met(&text.replace("omega = 1", "omega = 1, phi = 1")), 0);
        assert_eq!(
            met(&text
                .replace("omega = 1", "omega = 1, phi = 1")
                .replace("x = 1\n", "x = \"cos\"\n")),
            1
        );
    }
}
