//! The cost of an event: guessed and certified, and by the tests' plain one-sided steps, beside the
//! floor: the sine, cosine and exponential of one closed-form evaluation, each waiting for the
//! last as in one trajectory, and independent. The evaluations per event are printed with each
//! regime, so that one run tells the quotients.
//!
//! `cargo bench -p percuss-validation --bench first_crossing`. For exploration: numbers of a noisy
//! machine; `percuss bench compare` holds versions against each other.

#![allow(
    missing_docs,
    clippy::expect_used,
    reason = "a bench's macros make public items; a panic is a failed bench"
)]

#[path = "../tests/support/one_sided.rs"]
mod one_sided;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use one_sided::{Effort, OneSidedEnd, one_sided_end};
use percuss::{Model, Parameters, Segment, Start};
use percuss_validation::bench::floor::transcendental;
use std::hint::black_box;

const SWITCHES: usize = 2_000;

/// omega, xi: chaos with progression, period two with phases from 0.16 to 71 long, the lightly
/// damped attractors of Fig. 7, over-damped and critical contact.
const REGIMES: [(f64, f64); 6] =
    [(1.4, 0.01), (0.1, 0.01), (1.6, 0.1), (1.4, 0.1), (1.4, 5.0), (1.4, 1.0)];

fn model(omega: f64, xi: f64) -> Model {
    Model::new(Parameters { omega, xi, ..Parameters::default() }).expect("in range")
}

fn segments(model: &Model) -> impl Iterator<Item = Segment> {
    model.trajectory(model.start(&Start::default()).expect("rest is a start"))
}

fn floor(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("floor");
    group.throughput(Throughput::Elements(SWITCHES as u64));
    group.bench_function("chained", |bencher| {
        bencher.iter(|| (0..SWITCHES).fold(black_box(0.3), |angle, _| transcendental(angle)));
    });
    let angles: Vec<f64> = (0..SWITCHES).map(|k| 1.0 + 1e-3 * k as f64).collect();
    group.bench_function("independent", |bencher| {
        bencher.iter(|| black_box(&angles).iter().map(|angle| transcendental(*angle)).sum::<f64>());
    });
    group.finish();
}

fn switches(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("switch");
    group.throughput(Throughput::Elements(SWITCHES as u64));
    for (omega, xi) in REGIMES {
        let name = format!("omega {omega}, xi {xi}");
        let model = model(omega, xi);
        let mut run = model.trajectory(model.start(&Start::default()).expect("rest is a start"));
        let count = run.by_ref().take(SWITCHES).count();
        let evaluations = run.counters().evaluations as f64 / count as f64;
        println!("{name}: {evaluations:.3} evaluations per event");
        group.bench_function(BenchmarkId::new("certified", &name), |bencher| {
            bencher.iter(|| black_box(segments(&model).take(SWITCHES).last()));
        });
        let run: Vec<Segment> = segments(&model).take(SWITCHES).collect();
        group.bench_function(BenchmarkId::new("stepping", &name), |bencher| {
            bencher.iter(|| {
                run.iter()
                    .filter(|segment| {
                        let horizon = 2.0 * segment.duration();
                        let unit = 0.5 * f64::EPSILON;
                        let effort = Effort { horizon, evaluations: 1000, unit };
                        let end = one_sided_end::<f64>(&model, segment, &effort);
                        matches!(end, OneSidedEnd::Crossing { .. })
                    })
                    .count()
            });
        });
    }
    group.finish();
}

criterion_group!(benches, floor, switches);
criterion_main!(benches);
