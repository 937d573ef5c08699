//! The oscillator of this crate, written down as a piecewise-affine system.

use super::tables::last_half_unit;
use super::{enclosed_events, events};
use crate::support::reference::{self, Row, Table};
use percuss::affine::DoubleDouble;
use percuss::affine::{Event, Rational, System, SystemFile, What};
use percuss::{Model, Parameters, Phase, Start};
use std::fmt::Write as _;

const TEXT: &str = include_str!("../../validation/systems/percussive-oscillator.system.toml");

/// Orbits that settle: errors die out, and what is left is rounding.
const SETTLED_ORBITS: [(f64, f64, f64, f64); 3] =
    [(0.3, 0.1, 0.01, 0.1), (0.8, 0.2, 0.5, 2.3), (0.4, 0.08, 1.0, 1.1)];

#[test]
fn the_oscillator_as_a_system_has_the_events_of_its_own_solver() {
    for (a, b, xi, omega) in SETTLED_ORBITS {
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

/// The oscillator with a table's parameters and start, as a system: a mass that starts in contact
/// is where the slider says, as in the table.
fn system_of(table: &Table) -> System {
    let Table { parameters: Parameters { a, b, xi, omega, g, phi }, start: begun, .. } = table;
    let mut file = SystemFile::read("percussive-oscillator.system.toml", TEXT).unwrap();
    let parameters = format!(
        "[parameters]\na = {a:?}\nb = {b:?}\nxi = {xi:?}\ng = {g:?}\nfrequency = {omega:?}\n\
         phase = {phi:?}\n"
    );
    file.replace_from("table", &parameters, false).unwrap();
    let mut system = file.system().unwrap();
    let exact = |it: f64| Rational::try_from(it).unwrap();
    let phase = table.rows[0].phase().unwrap();
    let mode = system.modes.iter().position(|it| it.name == phase.to_string()).unwrap();
    let mut states = [begun.p, begun.y, begun.q.unwrap(), begun.v].map(exact);
    if phase != Phase::NoContact {
        states[0] = &states[2] + exact(*g);
    }
    let start = system.start.as_mut().unwrap();
    (start.mode, start.time) = (mode, exact(begun.tau));
    start.state = states.map(|it| [Rational::ZERO, Rational::ZERO, it]).to_vec();
    system
}

/// The end of a table.
fn horizon(table: &Table) -> f64 {
    let period = std::f64::consts::TAU / table.parameters.omega;
    table.horizon().map_or_else(|until| until, |count| table.start.tau + count as f64 * period)
}

/// Whether an event of a run is that of a row, within its enclosed errors and half a unit of the
/// row's last digit.
fn holds(table: &Table, row: &Row, system: &System, event: &Event<DoubleDouble>) -> bool {
    let errors = event.errors.as_ref().unwrap();
    let begin = DoubleDouble::new(table.start.tau, 0.0);
    let time = (event.time.high + event.time.low - begin, errors.time);
    let states = event.state.iter().copied().zip(errors.state.iter().copied());
    let [p, y, q] = row.state;
    let mut pairs = std::iter::once(time).chain(states).zip([row.elapsed, p, y, q, row.v]);
    system.modes[event.mode].name == row.token
        && pairs.all(|((own, error), cell)| {
            let exact = DoubleDouble::from(cell);
            (own - exact).words().0.abs() <= error + last_half_unit(exact)
        })
}

/// Whether an event in f64 is that in 106 bits, within the errors of the first.
fn is_within(own: &Event<f64>, wide: &Event<DoubleDouble>) -> bool {
    let errors = own.errors.as_ref().unwrap();
    let off = |own: f64, wide: DoubleDouble| (wide - DoubleDouble::new(own, 0.0)).words().0.abs();
    let time = off(own.time.high, wide.time.value() - DoubleDouble::new(own.time.low, 0.0));
    let mut states = own.state.iter().zip(&wide.state).zip(&errors.state);
    own.mode == wide.mode
        && time <= errors.time
        && states.all(|((own, wide), error)| off(*own, *wide) <= *error)
}

/// Enclosed runs in 106 bits decide every event of the 47 tables, chaos included, and have every
/// digit that the growth of errors leaves.
#[test]
fn the_oscillators_own_tables_are_reproduced_to_every_digit() {
    let (mut tables, mut events, mut narrow, mut largest) = (0, 0, 0, 0.0);
    for table in reference::tables("events") {
        let (system, until, name) = (system_of(&table), horizon(&table), &table.name);
        let run = enclosed_events::<DoubleDouble>(&system, until);
        // The first row is the start, the last the horizon.
        let [_, rows @ .., _] = &table.rows[..] else { panic!("{name}") };
        let crossings: Vec<_> =
            run.iter().take_while(|it| matches!(it.what, What::Until(..))).collect();
        assert_eq!(crossings.len(), rows.len(), "{name}");
        for (event, row) in crossings.iter().zip(rows) {
            assert!(holds(&table, row, &system, event), "{name} {row:?} {event:?}");
            largest = f64::max(largest, event.errors.as_ref().unwrap().time);
        }
        let in_f64 = enclosed_events::<f64>(&system, until);
        let decided = in_f64.iter().take_while(|it| matches!(it.what, What::Until(..)));
        for (own, event) in decided.zip(&crossings) {
            assert!(is_within(own, event), "{name} {own:?} {event:?}");
            narrow += 1;
        }
        tables += 1;
        events += rows.len();
    }
    assert_eq!((tables, events, narrow), (47, 871, 871));
    // Measured: 2.1e-23.
    assert!(largest < 1e-22, "{largest:e}");
}
