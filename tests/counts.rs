//! The work of the search, counted over thousands of short runs of every regime and pinned.
//!
//! A guess, a bound or a piece's length that is wrong loses no event: the certificate asks for more
//! work instead. So nothing but the work shows such a fault. The runs are short, so that their
//! counts do not depend on the last digits of chaos. Where a change of the search changes a row, the
//! test prints the rows as they are; fewer evaluations are a gain, more of them need a reason.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a panic is a failed test")]

#[path = "support/random.rs"]
mod random;

use percuss::{Counters, Model, Parameters, Start};
use random::Draw;

/// A regime: how its models are drawn, and the sums over its runs.
struct Regime {
    name: &'static str,
    model: fn(&mut Draw) -> Parameters,
    /// Switches, evaluations, divisions, undecidable touches.
    counts: [u64; 4],
}

const RUNS: usize = 300;
const SWITCHES: usize = 12;
const PERIODS: u64 = 40;

fn usual(draw: &mut Draw) -> Parameters {
    Parameters {
        a: draw.between(0.1, 1.0),
        b: draw.between(0.01, 0.5),
        xi: draw.decades(0.01, 0.5),
        omega: draw.between(0.3, 3.0),
        g: draw.between(0.0, 0.1),
        phi: draw.between(0.0, std::f64::consts::TAU),
    }
}

/// Runs from random starts on the slider, above it and at rest.
fn count(regime: &Regime) -> Counters {
    let mut draw = Draw(7);
    let mut sum = Counters::default();
    for _ in 0..RUNS {
        let parameters = (regime.model)(&mut draw);
        let model = Model::new(parameters).unwrap();
        let q = draw.between(-0.5, 1.5);
        let gap = if draw.between(0.0, 1.0) < 0.5 { 0.0 } else { draw.between(0.0, 1.0) };
        let start = Start {
            p: q + parameters.g - gap,
            y: draw.between(-1.0, 1.0),
            q: Some(q),
            tau: draw.between(0.0, 100.0),
            ..Start::default()
        };
        let entry = model.start(&start).unwrap();
        let mut run = model.trajectory(entry).until(entry.instant.after_periods(PERIODS, 1));
        let _ = run.by_ref().take(SWITCHES).count();
        let Counters { switches, evaluations, divisions, undecidable } = run.counters();
        sum.switches += switches;
        sum.evaluations += evaluations;
        sum.divisions += divisions;
        sum.undecidable += undecidable;
    }
    sum
}

const REGIMES: [Regime; 14] = [
    Regime { name: "usual", model: usual, counts: [2934, 3653, 212, 0] },
    Regime {
        name: "weak damping",
        model: |draw| Parameters { xi: draw.decades(1e-4, 1e-2), ..usual(draw) },
        counts: [3432, 4990, 202, 0],
    },
    Regime {
        name: "near critical",
        model: |draw| Parameters { xi: draw.between(0.9, 1.1), ..usual(draw) },
        counts: [2924, 3420, 131, 0],
    },
    Regime {
        name: "over-damped",
        model: |draw| Parameters { xi: draw.decades(1.2, 20.0), ..usual(draw) },
        counts: [3070, 4363, 1041, 0],
    },
    Regime {
        name: "stiff",
        model: |draw| Parameters { xi: draw.decades(20.0, 1e4), ..usual(draw) },
        counts: [3104, 7463, 3717, 0],
    },
    Regime {
        name: "slow forcing",
        model: |draw| Parameters { omega: draw.decades(0.003, 0.1), ..usual(draw) },
        counts: [3267, 9979, 501, 0],
    },
    Regime {
        name: "fast forcing",
        model: |draw| Parameters { omega: draw.decades(5.0, 200.0), ..usual(draw) },
        counts: [732, 1979, 652, 0],
    },
    Regime {
        name: "resonance",
        model: |draw| Parameters { omega: 1.0 + draw.between(-1e-3, 1e-3), ..usual(draw) },
        counts: [3541, 3999, 55, 0],
    },
    Regime {
        name: "next to no static force",
        model: |draw| Parameters { b: draw.decades(1e-12, 1e-3), ..usual(draw) },
        counts: [529, 1046, 58, 0],
    },
    Regime {
        name: "pulled",
        model: |draw| Parameters { b: -draw.between(0.0, 0.3), ..usual(draw) },
        counts: [441, 902, 43, 0],
    },
    Regime {
        name: "static force next to one",
        model: |draw| Parameters { b: 1.0 + draw.between(-1e-6, 1e-6), ..usual(draw) },
        counts: [741, 1465, 81, 0],
    },
    Regime {
        name: "strong force",
        model: |draw| Parameters { a: draw.decades(1.0, 100.0), ..usual(draw) },
        counts: [3109, 3680, 108, 0],
    },
    Regime {
        name: "weak force",
        model: |draw| Parameters { a: draw.decades(1e-9, 1e-2), ..usual(draw) },
        counts: [1932, 2703, 179, 0],
    },
    Regime {
        name: "strong force, fast",
        model: |draw| Parameters {
            a: draw.decades(1.0, 100.0),
            omega: draw.decades(5.0, 50.0),
            xi: draw.decades(0.5, 100.0),
            ..usual(draw)
        },
        counts: [2974, 4617, 336, 0],
    },
];

#[test]
fn the_search_takes_the_work_that_it_took() {
    let mut changed = Vec::new();
    for regime in &REGIMES {
        let Counters { switches, evaluations, divisions, undecidable } = count(regime);
        let counts = [switches, evaluations, divisions, undecidable];
        println!("{}: {counts:?}", regime.name);
        if counts != regime.counts {
            changed.push(format!("{}: {counts:?}, was {:?}", regime.name, regime.counts));
        }
    }
    assert!(changed.is_empty(), "{changed:#?}");
}
