//! The oscillator of this crate, written down as a piecewise-affine system.

use super::events;
use percuss::affine::{SystemFile, What};
use percuss::{Model, Parameters, Start};
use std::fmt::Write as _;

const TEXT: &str = include_str!("../../validation/systems/percussive-oscillator.system.toml");

/// Orbits that settle: errors die out, and what is left is rounding.
const SETTLED: [(f64, f64, f64, f64); 3] =
    [(0.3, 0.1, 0.01, 0.1), (0.8, 0.2, 0.5, 2.3), (0.4, 0.08, 1.0, 1.1)];

#[test]
fn the_oscillator_as_a_system_has_the_events_of_its_own_solver() {
    for (a, b, xi, omega) in SETTLED {
        let mut file = SystemFile::read("percussive-oscillator.system.toml", TEXT).unwrap();
        let mut parameters = "[parameters]\n".to_owned();
        for (name, value) in [("a", a), ("b", b), ("xi", xi), ("frequency", omega)] {
            writeln!(parameters, "{name} = {value:?}").unwrap();
        }
        file.replace_from("test", &parameters, false).unwrap();
        let system = file.system().unwrap();
        let model = Model::new(Parameters { a, b, xi, omega, ..Parameters::default() }).unwrap();
        let start = model.start(&Start::default()).unwrap();
        let until = 200.0 * std::f64::consts::TAU / omega;
        let affine = events::<f64>(&system, until);
        let own = model.trajectory(start).skip(1);
        assert!(affine.len() > 100, "{omega}");
        for (event, segment) in affine.iter().zip(own) {
            let What::Until(..) = event.what else { break };
            assert_eq!(system.modes[event.mode].name, segment.phase().to_string());
            let tau = model.time(&segment.entry().instant);
            let apart = (event.time.value() - tau).abs();
            // Some tens of roundings of the times, which are up to 12,000 in the slowest case.
            assert!(apart <= 64.0 * f64::EPSILON * (1.0 + tau), "{omega} at {tau}: {apart:e}");
        }
    }
}
