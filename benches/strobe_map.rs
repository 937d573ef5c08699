//! The cost of the strobe map: its image, its derivative, and a periodic orbit by Newton's method.
//!
//! `cargo bench -p percuss-validation --bench strobe_map`. For exploration.

#![allow(
    missing_docs,
    clippy::expect_used,
    reason = "a bench's macros make public items; a panic is a failed bench"
)]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use percuss::dynamics::orbit::Orbit;
use percuss::dynamics::strobe::StrobeMap;
use percuss::{Model, Parameters, Start};
use std::hint::black_box;

const PERIODS: u64 = 100;

/// Near the orbit of period five at omega = 1.6, xi = 0.1 (Fig. 7e).
const GUESS: [f64; 3] = [-0.465663, 0.064662, 1e-6];

fn strobes(criterion: &mut Criterion) {
    let parameters = Parameters { omega: 1.6, xi: 0.1, ..Parameters::default() };
    let model = Model::new(parameters).expect("in range");
    let rest = model.start(&Start::default()).expect("rest is a start");
    let map = StrobeMap::new(model, rest.instant);
    let start = map.entry(GUESS).expect("a point");
    let mut group = criterion.benchmark_group("strobe map");
    group.throughput(Throughput::Elements(PERIODS));
    group.bench_function("image", |bencher| {
        bencher.iter(|| map.strobes(black_box(start), PERIODS).last());
    });
    group.bench_function("image and derivative", |bencher| {
        bencher.iter(|| map.passage(black_box(&start), PERIODS));
    });
    group.finish();
    criterion.bench_function("orbit of period five", |bencher| {
        bencher.iter(|| Orbit::find(&map, black_box(GUESS), 5).expect("an orbit"));
    });
}

criterion_group!(benches, strobes);
criterion_main!(benches);
