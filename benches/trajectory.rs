//! The cost of a run: its events alone, and with states between them.
//!
//! `cargo bench -p percuss-validation --bench trajectory`. For exploration.

#![allow(
    missing_docs,
    clippy::expect_used,
    reason = "a bench's macros make public items; a panic is a failed bench"
)]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use percuss::dynamics::section::section;
use percuss::{Entry, Model, Parameters, Start};
use std::hint::black_box;

const PERIODS: u64 = 200;

/// omega, xi: chaos, motion of period two with long phases, and over-damped contact.
const REGIMES: [(f64, f64); 3] = [(1.4, 0.01), (0.1, 0.01), (0.4, 20.0)];

fn from_rest(omega: f64, xi: f64) -> (Model, Entry) {
    let parameters = Parameters { omega, xi, ..Parameters::default() };
    let model = Model::new(parameters).expect("in range");
    (model, model.start(&Start::default()).expect("rest is a start"))
}

fn runs(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("run");
    group.throughput(Throughput::Elements(PERIODS));
    for (omega, xi) in REGIMES {
        let name = format!("omega {omega}, xi {xi}");
        let (model, rest) = from_rest(omega, xi);
        let horizon = rest.instant.after_periods(PERIODS, 1);
        group.bench_function(BenchmarkId::new("switches", &name), |bencher| {
            bencher.iter(|| model.trajectory(black_box(rest)).until(horizon).last());
        });
        group.bench_function(BenchmarkId::new("once a period", &name), |bencher| {
            bencher.iter(|| section(&model, black_box(rest), 0.0, 0, PERIODS).last());
        });
    }
    group.finish();
}

criterion_group!(benches, runs);
criterion_main!(benches);
