//! The library's own times of the calls that `call_overhead.py` makes from Python: a line each,
//! its name and the least mean microseconds of a batch.

#![allow(clippy::expect_used, reason = "a panic is a failed bench")]

use percuss::affine::{Place, Section, SectionMap, SystemFile};
use percuss::{Answer, DoubleDouble, Model, Parameters, Proved, Solver, Start, System, affine};
use percuss_validation::{returns, systems::named};
use std::hint::black_box;
use std::time::Instant;

const ROUNDS: u32 = 5;

/// The seconds of a batch.
const ROUND: f64 = 0.02;

/// Prints the least mean time of a call over the batches.
fn least<T>(name: &str, mut call: impl FnMut() -> T) {
    black_box(call());
    let begun = Instant::now();
    black_box(call());
    let calls = (ROUND / begun.elapsed().as_secs_f64()).max(1.0) as u32;
    let round = |_| {
        let begun = Instant::now();
        (0..calls).for_each(|_| drop(black_box(call())));
        begun.elapsed().as_secs_f64() / f64::from(calls)
    };
    println!("{name}\t{}", 1e6 * (0..ROUNDS).map(round).fold(f64::INFINITY, f64::min));
}

fn read(name: &str, text: &str) -> SystemFile {
    SystemFile::read(name, text).expect("a system")
}

/// The number of events of a run.
fn passed<A: Answer>(solver: &Solver<A>, count: usize) -> usize {
    solver.run().events(count).expect("a start").count()
}

fn runs(system: &System, name: &str) -> Solver<Proved> {
    let proved = system.solver::<Proved>().expect("a solver");
    let plain = system.solver::<f64>().expect("a solver");
    least(&format!("{name}.events(count=1)"), || passed(&proved, 1));
    least(&format!("{name}.simulate(count=1)"), || passed(&plain, 1));
    least(&format!("{name}.simulate(until=2)"), || {
        plain.run().until(2.0).expect("a start").count()
    });
    proved
}

/// The arrays, digits and states of a run.
fn numbers(system: &System, proved: &Solver<Proved>) {
    least("its time and state", || {
        let events = proved.run().events(1).expect("a start");
        let numbers = events.map(|it| (it.time().midpoint(), it.state()[0].midpoint()));
        numbers.collect::<Vec<_>>()
    });
    let events: Vec<_> = proved.run().events(1).expect("a start").collect();
    least("its digits", || {
        let digits = |it: &Proved| it.to_digits(17);
        let texts = |it: &percuss::Event<'_, Proved>| {
            (digits(it.time()), it.state().iter().map(digits).collect::<Vec<_>>())
        };
        // The start has digits too.
        (0..2).map(|_| texts(&events[0])).collect::<Vec<_>>()
    });
    let forms = affine::Solver::<DoubleDouble>::new(system).expect("a solver");
    let start = system.start().expect("a start");
    let until = DoubleDouble::new(1.0, 0.0);
    let first = forms.run(start, until).expect("a start").next().expect("a start");
    let time = affine::Time { high: DoubleDouble::new(0.75, 0.0), low: DoubleDouble::default() };
    least("its sol(t)", || forms.state_at(&first, &time));
}

fn dynamics(system: &System) {
    let solver = affine::Solver::<f64>::new(system).expect("a solver");
    let map = || SectionMap::new(&solver, &Section::strobe(0.0)).expect("a section");
    let start = system.start().expect("a start");
    least("rig.poincare(returns=1)", || map().returns(start).expect("a start").next());
    least("rig.lyapunov(returns=10)", || returns::exponents(&map(), 0, 10, &mut |_| {}));
    least("rig.orbit(1, transient=10)", || {
        let (guess, _) = returns::guess(&map(), 10, || ()).expect("a start");
        let guess: Place<f64> = guess.expect("returns");
        map().orbit(&guess, 1)
    });
}

fn oscillator() {
    let [a, b, xi, omega, g] = [0.3, 0.1, 0.01, 1.4, 0.02];
    let parameters = Parameters { a, b, xi, omega, g, phi: std::f64::consts::FRAC_PI_2 };
    let start = || {
        let model = Model::new(black_box(parameters)).expect("parameters");
        (model, model.start(&Start::default()).expect("a start"))
    };
    least("Oscillator()", start);
    let (model, entry) = start();
    let until = entry.instant.after_periods(1_000_000, 1);
    least("Oscillator.simulate(count=1)", || model.trajectory(entry).until(until).next());
}

fn main() {
    let file = read("bouncing-ball", named("bouncing-ball").expect("a system of the program"));
    let ball = file.system().expect("a system");
    let proved = runs(&ball, "ball");
    numbers(&ball, &proved);
    least("ball(e=0.6)", || {
        let mut file = file.clone();
        file.set("e", 0.6, "bench").expect("a parameter");
        file.system()
    });
    let rig = read("rig", include_str!("../../benches/bilinear.system.toml"));
    let rig = rig.system().expect("a system");
    runs(&rig, "rig");
    dynamics(&rig);
    oscillator();
}
