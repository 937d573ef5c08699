//! Piecewise-affine systems: their files, known results, and runs against other methods.

mod answers;
mod attack;
mod branches;
mod brute;
mod built;
mod by_hand;
mod by_parameter;
mod close_rates;
mod curves;
mod decided;
mod diagrams;
mod drifts;
mod enclosed;
mod endings;
mod files;
mod follow;
mod gradient_runs;
mod gradient_tables;
mod gradients;
mod hostile;
mod impacts_beside;
mod inputs;
mod kept;
mod known;
mod limits;
mod oscillator;
mod past_limits;
mod published;
mod random;
mod return_attractors;
mod return_orbits;
mod returns;
mod search_ahead;
mod sizes;
mod spectra;
mod start_modes;
mod start_rows;
mod still;
mod tables;
mod together;
mod touches;
mod turns;
mod wide;

use percuss::affine::DoubleDouble;
use percuss::affine::{Ending, Event, Solver, System, What};
use percuss::number::Number;

const BALL: &str = include_str!("ball.system.toml");
const RELAY: &str = include_str!("relay.system.toml");
const STIFF: &str = include_str!("stiff.system.toml");
const SPHERES: &str = include_str!("spheres.system.toml");
const PLASTIC: &str = include_str!("plastic.system.toml");

fn system(text: &str) -> System {
    System::parse("test.system.toml", text).unwrap()
}

/// All events of a run, the ending included.
fn events<T: Number>(system: &System, until: f64) -> Vec<Event<T>> {
    let solver = Solver::<T>::new(system).unwrap();
    let start = system.start.as_ref().unwrap();
    solver.run(start, T::exact(until)).unwrap().collect()
}

/// All events of a run that follows its errors, the ending included.
fn enclosed_events<T: Number>(system: &System, until: f64) -> Vec<Event<T>> {
    let solver = Solver::<T>::new(system).unwrap();
    let start = system.start.as_ref().unwrap();
    solver.run_enclosed(start, T::exact(until)).unwrap().collect()
}

/// The name of an event.
fn name<T: Number>(system: &System, event: &Event<T>) -> String {
    match &event.what {
        What::Until(mode, index) => system.modes[*mode].until[*index].name.clone(),
        What::Watch(mode, index) => system.modes[*mode].watch[*index].name.clone(),
        What::Limit(..) => "accumulation".to_owned(),
        What::Start => String::new(),
        What::End(Ending::Horizon) => "end".to_owned(),
        What::End(Ending::Accumulation(..)) => "accumulation".to_owned(),
        What::End(Ending::LeavesDomain) => "leaves-domain".to_owned(),
        What::End(Ending::NoProgress) => "no-progress".to_owned(),
        What::End(Ending::BeyondGuard) => "beyond-guard".to_owned(),
        What::End(Ending::Undecided) => "undecided".to_owned(),
    }
}

fn names<T: Number>(system: &System, events: &[Event<T>]) -> Vec<String> {
    events.iter().map(|event| name(system, event)).collect()
}

/// Events and times in f64, which are also those of 106 bits but for rounding.
fn agreed_events(system: &System, until: f64, room: f64) -> Vec<(String, f64)> {
    let (narrow, wide) = (events::<f64>(system, until), events::<DoubleDouble>(system, until));
    assert_eq!(names(system, &narrow), names(system, &wide));
    let both = narrow.iter().zip(&wide);
    let times = both.map(|(narrow, wide)| {
        let (narrow_time, wide_time) = (narrow.time.value(), wide.time.value().to_f64());
        let apart = (narrow_time - wide_time).abs();
        assert!(apart <= room, "{narrow_time:?} and {wide_time:?} are {apart:e} apart");
        (name(system, narrow), wide_time)
    });
    times.collect()
}
