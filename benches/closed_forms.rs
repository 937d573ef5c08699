//! The cost of one evaluation of each phase's closed form, and of its derivative.
//!
//! `cargo bench -p percuss-validation --bench closed_forms`. For exploration.

#![allow(
    missing_docs,
    clippy::expect_used,
    reason = "a bench's macros make public items; a panic is a failed bench"
)]

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use percuss::{Model, Parameters, Phase, Segment, Start};
use std::hint::black_box;

/// xi below, at and above one: contact oscillates, creeps critically, or relaxes.
const XI: [f64; 3] = [0.01, 1.0, 5.0];

fn segments(xi: f64) -> Vec<Segment> {
    let parameters = Parameters { xi, ..Parameters::default() };
    let model = Model::new(parameters).expect("in range");
    let rest = model.start(&Start::default()).expect("rest is a start");
    model.trajectory(rest).take(30).collect()
}

fn evaluations(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("closed form");
    for xi in XI {
        let run = segments(xi);
        for phase in Phase::ALL {
            let Some(segment) = run.iter().find(|segment| segment.phase() == phase) else {
                continue;
            };
            let middle = 0.5 * segment.duration();
            let name = format!("{}, xi {xi}", phase.as_str());
            group.bench_function(BenchmarkId::new("state", &name), |bencher| {
                bencher.iter(|| segment.at(black_box(middle)));
            });
            group.bench_function(BenchmarkId::new("derivative", &name), |bencher| {
                bencher.iter(|| segment.variation(black_box(middle)));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, evaluations);
criterion_main!(benches);
