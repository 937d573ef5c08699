//! What a run of the exact solver holds in memory does not grow with its length: it holds nothing.

#![allow(clippy::expect_used, reason = "a panic is a failed test")]

use percuss::{Model, Parameters, Start};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use std::alloc::System;

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Follows chaos from rest for this many forcing periods; its switches, and what was asked of the heap.
fn followed(periods: u64) -> (u64, stats_alloc::Stats) {
    let model = Model::new(Parameters { omega: 1.4, ..Parameters::default() }).expect("a model");
    let rest = model.start(&Start::default()).expect("a start");
    let region = Region::new(ALLOCATOR);
    let mut run = model.trajectory(rest).until(rest.instant.after_periods(periods, 1));
    run.by_ref().for_each(drop);
    (run.counters().switches, region.change())
}

/// Where each phase is held on the stack and nothing is kept, no length can fill the memory. One test
/// alone stands in this file: another's thread would be counted too.
#[test]
fn a_run_of_a_million_periods_asks_for_no_memory() {
    let (counted, asked) = followed(1_000);
    assert!(counted > 500, "{counted}");
    for periods in [1_000, 1_000_000] {
        let (switches, change) = followed(periods);
        assert!(switches * 2 > periods, "{switches}");
        assert_eq!(change.allocations, asked.allocations, "{periods} periods");
        assert_eq!(change.bytes_allocated, asked.bytes_allocated, "{periods} periods");
    }
    assert_eq!((asked.allocations, asked.reallocations, asked.bytes_allocated), (0, 0, 0));
    // The counter counts.
    let region = Region::new(ALLOCATOR);
    let kept = std::hint::black_box(vec![0_u8; 1 << 20]);
    assert!(region.change().bytes_allocated >= kept.len());
}
