//! What a switch costs: guessed and certified, and by plain one-sided stepping (the judge).
//!
//! `cargo bench -p percuss-validation --bench first_crossing`. For exploration: numbers of a noisy
//! machine; regressions are judged by counts.

#![allow(
    missing_docs,
    clippy::expect_used,
    reason = "a bench's macros make public items; a panic is a failed bench"
)]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use percuss::{Leg, Model, Parameters, Start};
use std::hint::black_box;

const SWITCHES: usize = 2_000;

/// omega, xi: chaos with progression, period two with phases from 0.16 to 71 long, the lightly damped
/// attractors of Fig. 7, over-damped contact.
const REGIMES: [(f64, f64); 4] = [(1.4, 0.01), (0.1, 0.01), (1.6, 0.1), (1.4, 5.0)];

fn model(omega: f64, xi: f64) -> Model {
    Model::new(Parameters { omega, xi, ..Parameters::default() }).expect("in range")
}

fn legs(model: &Model) -> impl Iterator<Item = Leg> {
    model.trajectory(model.start(&Start::default()).expect("rest is a start"))
}

fn switches(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("switch");
    group.throughput(Throughput::Elements(SWITCHES as u64));
    for (omega, xi) in REGIMES {
        let name = format!("omega {omega}, xi {xi}");
        let model = model(omega, xi);
        group.bench_function(BenchmarkId::new("certified", &name), |bencher| {
            bencher.iter(|| black_box(legs(&model).take(SWITCHES).last()));
        });
        let run: Vec<Leg> = legs(&model).take(SWITCHES).collect();
        group.bench_function(BenchmarkId::new("stepping", &name), |bencher| {
            bencher.iter(|| {
                run.iter()
                    .filter_map(|leg| leg.judged_duration(2.0 * leg.duration(), 1000))
                    .sum::<f64>()
            });
        });
    }
    group.finish();
}

fn evaluations(criterion: &mut Criterion) {
    let model = model(1.4, 0.01);
    let run: Vec<Leg> = legs(&model).take(30).collect();
    let mut group = criterion.benchmark_group("closed form");
    for phase in percuss::Phase::ALL {
        let Some(leg) = run.iter().find(|leg| leg.phase() == phase) else { continue };
        let middle = 0.5 * leg.duration();
        group.bench_function(phase.token(), |bencher| {
            bencher.iter(|| leg.at(black_box(middle)));
        });
    }
    group.finish();
}

criterion_group!(benches, switches, evaluations);
criterion_main!(benches);
