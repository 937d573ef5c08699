//! What a run costs with each engine, chaos from rest at tolerance 1e-9. `percuss bench` times them
//! in interleaved rounds with their answers checked; this is for exploration of one.
//!
//! `cargo bench -p percuss-validation --bench engines -- NAME`

#![allow(
    missing_docs,
    clippy::expect_used,
    reason = "a bench's macros make public items; a panic is a failed bench"
)]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use percuss_validation::bench::contestant::enter;
use percuss_validation::bench::timed_case::TimedCase;
use percuss_validation::case::embedded;
use percuss_validation::engine::{Accuracy, Stepping};
use percuss_validation::integrators::all;
use percuss_validation::truth::Library;

const CASE: &str = "chaos-from-rest";

fn engines(criterion: &mut Criterion) {
    let mut cases = embedded().expect("the cases are read").into_iter();
    let case = cases.find(|case| case.name == CASE).expect("the case is there");
    let library = Library::embedded().expect("the tables are read");
    let case = TimedCase::new(&case, &library).expect("a case");
    let mut group = criterion.benchmark_group(CASE);
    group.sample_size(10);
    group.throughput(Throughput::Elements(case.periods() as u64));
    for engine in all() {
        let declaration = engine.declaration();
        let setting = match declaration.stepping {
            Stepping::Exact => Accuracy::Exact,
            Stepping::Fixed { .. } => Accuracy::Step(0.0625),
            _ => Accuracy::Tolerance(1e-9),
        };
        // What would take more than a second is not run.
        let Ok(mut timed) = enter(*engine, &case, setting) else { continue };
        group.bench_function(declaration.name, |bencher| bencher.iter(|| timed.call()));
    }
    group.finish();
}

criterion_group!(benches, engines);
criterion_main!(benches);
