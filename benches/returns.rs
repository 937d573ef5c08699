//! The dynamics of a system: a bilinear oscillator with clearance and zeta = 0.05. Printed are the
//! costs of returns and of derivatives beside those of the plain run, as medians of the quotients
//! of interleaved rounds on one core; the times of a diagram, of basins and of exponents; and two
//! threads beside one.
//!
//! `cargo bench -p percuss-validation --bench returns`. For exploration, no test.

#![allow(clippy::expect_used, reason = "a panic is a failed bench")]

use percuss::affine::{
    Place, Plane, ReturnDiagram, Section, SectionMap, Solver, System, SystemFile,
};
use percuss::dynamics::attractor::SearchLimits;
use percuss::dynamics::diagram::{Follow, values};
use percuss_validation::bench::rounds::{Benchmark, PACE, Plain, time_interleaved};
use rayon::ThreadPoolBuilder;
use std::hint::black_box;
use std::time::Instant;

const BILINEAR: &str = include_str!("bilinear.system.toml");

/// Returns of each run whose costs are compared.
const RETURNS: u64 = 2_000;

const ROUNDS: usize = 15;

/// The values of the diagram, and the returns at each that are left out and kept.
const VALUES: u32 = 800;
const TRANSIENT_RETURNS: u64 = 300;
const KEPT_RETURNS: u32 = 100;

/// Starts across and up of the basins.
const SIDE: u32 = 300;

/// Forcing periods of the exponents.
const PERIODS: u64 = 100_000;

fn file() -> SystemFile {
    SystemFile::read("bilinear-oscillator", BILINEAR).expect("a system")
}

/// The system with these values of parameters.
fn system(given: &[(&str, f64)]) -> System {
    let mut file = file();
    for (name, value) in given {
        file.set(name, *value, "bench").expect("a parameter");
    }
    file.system().expect("a system")
}

/// Returns and derivatives beside the plain run to the same time.
fn costs(map: &SectionMap<'_, f64>, solver: &Solver<f64>, place: &Place<f64>) {
    let period = map.forcing_period().expect("a forced system");
    let until = place.time.after(RETURNS as f64 * period);
    let events = solver.run_at(place, until).count() as u64;
    let mut plain = Plain(|| {
        let events = solver.run_at(black_box(place), until);
        black_box(events.map(|event| event.time.value()).fold(0.0, f64::max));
    });
    let mut returns = Plain(|| {
        let returns = map.returns_from(black_box(place)).take(RETURNS as usize);
        black_box(returns.map(|it| it.expect("a return").time).fold(0.0, f64::max));
    });
    let mut derivatives = Plain(|| {
        let mut place = black_box(place).clone();
        for _ in 0..RETURNS {
            let passage = map.passage(&place).expect("a return");
            place = passage.image;
        }
        black_box(place);
    });
    let mut exponents = Plain(|| {
        black_box(map.exponents(place, 0, RETURNS, &mut |_| ()).expect("returns"));
    });
    let mut all: [&mut dyn Benchmark; 4] =
        [&mut plain, &mut returns, &mut derivatives, &mut exponents];
    let times = time_interleaved(&mut all, ROUNDS, PACE, &|| ());
    let times: Vec<_> = times.into_iter().map(|it| it.expect("no check")).collect();
    let each = times[0].median() / events as f64;
    println!(
        "{events} events in {RETURNS} returns, {each:.0} ns an event; beside that run returns take \
         {:.2}, derivatives {:.2}, exponents {:.2} times as long",
        times[1].ratio_to(&times[0]),
        times[2].ratio_to(&times[0]),
        times[3].ratio_to(&times[0])
    );
}

/// The seconds that some work takes.
fn seconds<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begun = Instant::now();
    let done = black_box(work());
    (done, begun.elapsed().as_secs_f64())
}

fn prepared() {
    let (_, took) = seconds(|| {
        for k in 0..100 {
            let system = system(&[("frequency", 1.3 + 0.001 * f64::from(k))]);
            black_box(Solver::<f64>::new(&system).expect("modes"));
        }
    });
    println!("a system is read and its solver prepared in {:.2} ms", 10.0 * took);
}

fn diagram() -> f64 {
    let diagram = ReturnDiagram {
        section: Section::strobe(0.0),
        longest: None,
        transient: TRANSIENT_RETURNS,
        returns: KEPT_RETURNS,
        follow: Follow::Carry,
    };
    let file = file();
    let at = |value: f64| {
        let mut file = file.clone();
        file.set("frequency", value, "bench")?;
        file.system()
    };
    let (steps, took) = seconds(|| diagram.steps(&values(0.5, 1.5, VALUES), at, |_| ()));
    let left_out = steps.expect("systems").iter().filter(|it| it.left_out.is_some()).count();
    assert_eq!(left_out, 0, "values that are left out cost nothing");
    took
}

fn basins(map: &SectionMap<'_, f64>) -> f64 {
    let window = [[-3.0, 1.5], [-3.0, 3.0]];
    let plane = Plane { axes: [0, 1], window, columns: SIDE, rows: SIDE };
    let start = map.system().start().expect("a start");
    let limits = SearchLimits::from(100);
    let (basins, took) = seconds(|| map.basins(start, &plane, limits, &|_| ()));
    let basins = basins.expect("a start");
    println!("{} attractors of {SIDE} x {SIDE} starts", basins.attractors.len());
    took
}

/// The system as the file has it, where several motions attract.
fn main() {
    // `cargo test --benches` asks for no numbers.
    if !std::env::args().any(|it| it == "--bench") {
        return;
    }
    let system = system(&[]);
    let solver = Solver::<f64>::new(&system).expect("modes");
    let map = SectionMap::new(&solver, &Section::strobe(0.0)).expect("a strobe");
    let mut settled = map.returns(system.start().expect("a start")).expect("a start");
    assert!(settled.by_ref().take(500).all(|it| it.is_ok()), "a motion that goes on");
    let place = settled.place().expect("a strobe");
    costs(&map, &solver, &place);
    prepared();
    let pool = |threads| ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let [one, two] = [1, 2].map(pool);
    let (_, exponents) =
        seconds(|| map.exponents(&place, 0, PERIODS, &mut |_| ()).expect("returns"));
    println!("exponents of {PERIODS} forcing periods: {exponents:.2} s");
    let [alone, both] = [&one, &two].map(|pool| pool.install(diagram));
    println!("a diagram of {VALUES} values: {alone:.2} s, by two threads {both:.2} s");
    let [alone, both] = [&one, &two].map(|pool| pool.install(|| basins(&map)));
    println!("basins: {alone:.2} s, by two threads {both:.2} s, {:.2} times as fast", alone / both);
}
