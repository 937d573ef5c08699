//! The oscillator of this crate, written down as a piecewise-affine system.

use super::tables::{decimal, repository};
use super::{enclosed, events};
use crate::double_double::DoubleDouble;
use percuss::affine::{Event, Rational, System, SystemFile, What};
use percuss::{Model, Parameters, Start};
use std::collections::BTreeMap;
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

/// A proved table of the oscillator: what its header says, and its rows of phases.
struct Phases {
    header: BTreeMap<String, String>,
    rows: Vec<Vec<String>>,
}

impl Phases {
    /// The table in a file, if it is one of the oscillator.
    fn read(text: &str) -> Option<Self> {
        let (header, rows): (Vec<_>, Vec<_>) = text.lines().partition(|it| it.starts_with('#'));
        let header = header.iter().filter_map(|line| line[1..].split_once('='));
        let header: BTreeMap<_, _> =
            header.map(|(key, value)| (key.trim().to_owned(), value.trim().to_owned())).collect();
        let cells = |row: &&str| row.split(',').map(str::to_owned).collect();
        let rows = rows[1..].iter().map(cells).collect();
        (header.get("rows")? == "phases").then_some(Self { header, rows })
    }

    fn number(&self, key: &str) -> f64 {
        self.header[key].parse().unwrap()
    }

    /// The horizon, of which the last row has passed its phase's begin.
    fn until(&self) -> f64 {
        match self.header.get("horizon.until") {
            Some(until) => until.parse().unwrap(),
            None => {
                let period = std::f64::consts::TAU / self.number("omega");
                self.number("start.tau") + self.number("horizon.periods") * period
            }
        }
    }

    /// The oscillator with the table's parameters and start, as a system: a mass that starts in
    /// contact is where the slider says, as in the table.
    fn system(&self) -> System {
        let mut file = SystemFile::read("percussive-oscillator.system.toml", TEXT).unwrap();
        let mut parameters = "[parameters]\n".to_owned();
        for (name, key) in [("frequency", "omega"), ("phase", "phi")] {
            writeln!(parameters, "{name} = {:?}", self.number(key)).unwrap();
        }
        for name in ["a", "b", "xi", "g"] {
            writeln!(parameters, "{name} = {:?}", self.number(name)).unwrap();
        }
        file.replace_from("table", &parameters, false).unwrap();
        let mut system = file.system().unwrap();
        let exact = |key: &str| Rational::try_from(self.number(key)).unwrap();
        let mode = system.modes.iter().position(|it| it.name == self.rows[0][1]).unwrap();
        let mut states = ["p", "y", "q", "v"].map(|it| exact(&format!("start.{it}")));
        if self.rows[0][1] != "no-contact" {
            states[0] = &states[2] + exact("g");
        }
        let start = system.start.as_mut().unwrap();
        start.mode = mode;
        start.time = exact("start.tau");
        start.state = states.map(|it| [Rational::ZERO, Rational::ZERO, it]).to_vec();
        system
    }

    /// Whether an event of a run is that of a row, within its enclosed errors and half a unit of
    /// the row's last digit.
    fn holds(&self, row: &[String], system: &System, event: &Event<DoubleDouble>) -> bool {
        let errors = event.errors.as_ref().unwrap();
        let begin = DoubleDouble::new(self.number("start.tau"), 0.0);
        let time = (event.time.high + event.time.low - begin, errors.time);
        let states = event.state.iter().copied().zip(errors.state.iter().copied());
        let cells = std::iter::once(&row[2]).chain(&row[4..]);
        let mut pairs = std::iter::once(time).chain(states).zip(cells);
        system.modes[event.mode].name == row[1]
            && pairs.all(|((own, error), cell)| {
                let exact = decimal(cell);
                let printed = 5.1e-25 * exact.words().0.abs() + 1e-40;
                (own - exact).words().0.abs() <= error + printed
            })
    }
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
    for entry in std::fs::read_dir(repository("reference_data/events")).unwrap() {
        let path = entry.unwrap().path();
        let Some(phases) = Phases::read(&std::fs::read_to_string(&path).unwrap()) else { continue };
        let system = phases.system();
        let run = enclosed::<DoubleDouble>(&system, phases.until());
        // The first row is the start, the last the horizon.
        let [_, rows @ .., _] = &phases.rows[..] else { panic!("{path:?}") };
        let crossings: Vec<_> =
            run.iter().take_while(|it| matches!(it.what, What::Until(..))).collect();
        assert_eq!(crossings.len(), rows.len(), "{path:?}");
        for (event, row) in crossings.iter().zip(rows) {
            assert!(phases.holds(row, &system, event), "{path:?} {row:?} {event:?}");
            largest = f64::max(largest, event.errors.as_ref().unwrap().time);
        }
        let in_f64 = enclosed::<f64>(&system, phases.until());
        let decided = in_f64.iter().take_while(|it| matches!(it.what, What::Until(..)));
        for (own, event) in decided.zip(&crossings) {
            assert!(is_within(own, event), "{path:?} {own:?} {event:?}");
            narrow += 1;
        }
        tables += 1;
        events += rows.len();
    }
    assert_eq!((tables, events, narrow), (47, 871, 871));
    // Measured: 2.1e-23.
    assert!(largest < 1e-22, "{largest:e}");
}
