//! What many runs at once cost: a grid of starts, each followed for the same number of forcing periods, one
//! after the other and on all threads. Another way to run an ensemble is one more function here, beside
//! the others.
//!
//! `cargo bench -p percuss-validation --bench ensembles`. For exploration.

#![allow(
    missing_docs,
    clippy::expect_used,
    reason = "a bench's macros make public items; a panic is a failed bench"
)]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use percuss::dynamics::strobe::StrobeMap;
use percuss::{Entry, Model, Parameters, Start};
use rayon::prelude::*;
use std::hint::black_box;

const PERIODS: u64 = 20;
const SIDE: u32 = 16;

/// Cell centres of a square in (p, y).
fn starts(map: &StrobeMap) -> Vec<Entry> {
    let centre = |k: u32| -1.0 + 2.0 * (f64::from(k) + 0.5) / f64::from(SIDE);
    let cells = (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| [column, row]));
    let entry = |[p, y]: [u32; 2]| map.entry([centre(p), centre(y), 0.0]).expect("in range");
    cells.map(entry).collect()
}

/// Where a run ends, as p, y, q.
fn end(model: &Model, start: &Entry) -> [f64; 3] {
    let horizon = start.instant.after_periods(PERIODS, 1);
    let last = model.trajectory(*start).until(horizon).last().expect("a phase");
    last.entry_at(&horizon).point()
}

fn ensembles(criterion: &mut Criterion) {
    let parameters = Parameters { omega: 1.6, xi: 0.1, ..Parameters::default() };
    let model = Model::new(parameters).expect("in range");
    let rest = model.start(&Start::default()).expect("rest is a start");
    let starts = starts(&StrobeMap::new(model, rest.instant));
    let mut group = criterion.benchmark_group("ensemble");
    group.throughput(Throughput::Elements(starts.len() as u64 * PERIODS));
    group.bench_function("one after the other", |bencher| {
        bencher
            .iter(|| black_box(&starts).iter().map(|start| end(&model, start)).collect::<Vec<_>>());
    });
    group.bench_function("on all threads", |bencher| {
        bencher.iter(|| {
            black_box(&starts).par_iter().map(|start| end(&model, start)).collect::<Vec<_>>()
        });
    });
    group.finish();
}

criterion_group!(benches, ensembles);
criterion_main!(benches);
