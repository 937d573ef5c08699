//! What a run of the exact solver holds in memory does not grow with its length: between two phases
//! it holds nothing.

#![allow(clippy::expect_used, reason = "a panic is a failed test")]

use percuss::{Model, Parameters, Start};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use std::alloc::System;

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Follows chaos from rest for this many forcing periods; its events, and the most that is held
/// on the heap when a phase has been found, bytes.
fn follow(periods: u64) -> (u64, usize) {
    let model = Model::new(Parameters { omega: 1.4, ..Parameters::default() }).expect("a model");
    let rest = model.start(&Start::default()).expect("a start");
    let region = Region::new(ALLOCATOR);
    let mut run = model.trajectory(rest).until(rest.instant.after_periods(periods, 1));
    let held = run.by_ref().map(|_| held_bytes(&region)).max().unwrap_or_default();
    (run.counters().switches, held)
}

fn held_bytes(region: &Region<'_, System>) -> usize {
    let change = region.change();
    change.bytes_allocated - change.bytes_deallocated
}

/// A hard search may ask for memory, and gives it back before the phase is handed out. Without the
/// usual harness: what its threads hold would be counted too.
fn main() {
    for periods in [1_000, 1_000_000] {
        let (events, held) = follow(periods);
        assert!(events * 2 > periods, "{events}");
        assert_eq!(held, 0, "{periods} periods");
    }
    // The counter counts.
    let region = Region::new(ALLOCATOR);
    let kept = std::hint::black_box(vec![0_u8; 1 << 20]);
    assert!(held_bytes(&region) >= kept.len());
}
