//! The cost of an event of each piecewise-affine system inside the program, and of the
//! oscillator beside its own solver, as the quotient of interleaved rounds. The evaluations and
//! pieces per event are printed with each.
//!
//! `cargo bench -p percuss-validation --bench affine`. For exploration.

#![allow(
    missing_docs,
    clippy::expect_used,
    reason = "a bench's macros make public items; a panic is a failed bench"
)]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use percuss::affine::{Solver, System, SystemFile};
use percuss::{Model, Parameters, Start};
use percuss_validation::bench::rounds::{PACE, Plain, time_interleaved};
use percuss_validation::systems::{SYSTEMS, named};
use std::hint::black_box;

/// The largest number of events of a run.
const EVENTS: usize = 2_000;

const ROUNDS: usize = 15;

/// a, b, xi, omega: chaos with progression, progression for most of the time, long phases of period
/// two, light and moderate damping, critical and over-damped contact.
const REGIMES: [(f64, f64, f64, f64); 7] = [
    (0.3, 0.1, 0.01, 1.4),
    (0.3, 0.1, 0.25, 0.15),
    (0.3, 0.1, 0.01, 0.1),
    (0.3, 0.12, 0.1, 0.7),
    (0.8, 0.2, 0.5, 2.3),
    (0.4, 0.08, 1.0, 1.1),
    (0.9, 0.15, 3.0, 1.4),
];

/// Follows a system from its own start, to so many events or to a thousand units of time.
fn run(solver: &Solver<f64>) -> usize {
    let system = solver.system();
    let start = system.start.as_ref().expect("a start");
    let until = 1e3 * system.time_scale;
    solver.run(start, until).expect("a start").take(EVENTS).count()
}

fn systems(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("event");
    for (name, text) in SYSTEMS {
        let system = System::parse(name, text).expect("a system");
        let solver = Solver::<f64>::new(&system).expect("modes");
        let start = system.start.as_ref().expect("a start");
        let mut events = solver.run(start, 1e3 * system.time_scale).expect("a start");
        let count = events.by_ref().take(EVENTS).count();
        let (work, each) = (events.work(), |it| it as f64 / count as f64);
        let (evaluations, pieces) = (each(work.evaluations), each(work.pieces));
        println!(
            "{name}: {count} events, {evaluations:.2} evaluations and {pieces:.2} pieces each"
        );
        group.throughput(Throughput::Elements(count as u64));
        group.bench_function(*name, |bencher| bencher.iter(|| run(black_box(&solver))));
    }
    group.finish();
}

/// The oscillator as a system.
fn oscillator((a, b, xi, omega): (f64, f64, f64, f64)) -> System {
    let text = named("percussive-oscillator").expect("a system");
    let mut file = SystemFile::read("percussive-oscillator", text).expect("a system");
    for (name, value) in [("a", a), ("b", b), ("xi", xi), ("frequency", omega)] {
        file.set(name, value, "bench").expect("a parameter");
    }
    file.system().expect("a system")
}

fn beside_its_own_solver(_: &mut Criterion) {
    for regime in REGIMES {
        let (a, b, xi, omega) = regime;
        let system = oscillator(regime);
        let solver = Solver::<f64>::new(&system).expect("modes");
        let start = system.start.as_ref().expect("a start");
        let model = Model::new(Parameters { a, b, xi, omega, ..Parameters::default() });
        let model = model.expect("in range");
        let rest = model.start(&Start::default()).expect("rest is a start");
        let mut affine = Plain(|| {
            let events = solver.run(start, f64::MAX).expect("a start").take(EVENTS);
            black_box(events.map(|event| event.time.value()).fold(0.0, f64::max));
        });
        let mut own = Plain(|| {
            let segments = model.trajectory(rest).skip(1).take(EVENTS);
            let times = segments.map(|segment| model.time(&segment.entry().instant));
            black_box(times.fold(0.0, f64::max));
        });
        let times = time_interleaved(&mut [&mut affine, &mut own], ROUNDS, PACE, &|| ());
        let times: Vec<_> = times.into_iter().map(|it| it.expect("no check")).collect();
        let mut events = solver.run(start, f64::MAX).expect("a start");
        let count = events.by_ref().take(EVENTS).count() as f64;
        let [affine, own] = [0, 1].map(|k| times[k].median() / count);
        println!(
            "a {a}, b {b}, xi {xi}, omega {omega}: {affine:.0} ns an event, its own solver \
             {own:.0} ns, {:.2} times; {:.2} evaluations an event",
            times[0].ratio_to(&times[1]),
            events.work().evaluations as f64 / count,
        );
    }
}

criterion_group!(benches, beside_its_own_solver, systems);
criterion_main!(benches);
