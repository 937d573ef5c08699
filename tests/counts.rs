//! The work of the search, counted over thousands of short runs of every regime and pinned.
//!
//! A guess, a bound or a piece's length that is wrong loses no event: the certificate asks for more
//! work instead. So nothing but the work shows such a fault. The runs are short, so that their
//! counts do not depend on the last digits of chaos. Switches and touches have to be as they were;
//! evaluations and divisions may be fewer. The test prints the rows as they are: a row that has
//! become better is pinned anew, and one that has become worse needs a reason.

use crate::support::graze::{self, Crest};
use crate::support::random::Draw;
use percuss::{Counters, Model, Parameters, Start};

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

fn usual_model(draw: &mut Draw) -> Parameters {
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
        add(&mut sum, &run(&model, &start, PERIODS, SWITCHES));
    }
    sum
}

/// The work of at most so many phases, from a start until so many periods later.
fn run(model: &Model, start: &Start, periods: u64, phases: usize) -> Counters {
    let entry = model.start(start).unwrap();
    let mut run = model.trajectory(entry).until(entry.instant.after_periods(periods, 1));
    let _ = run.by_ref().take(phases).count();
    run.counters()
}

fn add(sum: &mut Counters, more: &Counters) {
    sum.switches += more.switches;
    sum.evaluations += more.evaluations;
    sum.divisions += more.divisions;
    sum.undecidable += more.undecidable;
}

const REGIMES: [Regime; 14] = [
    Regime { name: "usual", model: usual_model, counts: [2934, 3660, 212, 0] },
    Regime { name: "weak damping", model: weak_model, counts: [3432, 4990, 202, 0] },
    Regime {
        name: "near critical",
        model: |draw| Parameters { xi: draw.between(0.9, 1.1), ..usual_model(draw) },
        counts: [2924, 3420, 131, 0],
    },
    Regime {
        name: "over-damped",
        model: |draw| Parameters { xi: draw.decades(1.2, 20.0), ..usual_model(draw) },
        counts: [3070, 4363, 1041, 0],
    },
    Regime {
        name: "stiff",
        model: |draw| Parameters { xi: draw.decades(20.0, 1e4), ..usual_model(draw) },
        counts: [3104, 7463, 3717, 0],
    },
    Regime {
        name: "slow forcing",
        model: |draw| Parameters { omega: draw.decades(0.003, 0.1), ..usual_model(draw) },
        counts: [3267, 9979, 501, 0],
    },
    Regime {
        name: "fast forcing",
        model: |draw| Parameters { omega: draw.decades(5.0, 200.0), ..usual_model(draw) },
        counts: [732, 1979, 652, 0],
    },
    Regime {
        name: "resonance",
        model: |draw| Parameters { omega: 1.0 + draw.between(-1e-3, 1e-3), ..usual_model(draw) },
        counts: [3541, 3989, 55, 0],
    },
    Regime {
        name: "next to no static force",
        model: |draw| Parameters { b: draw.decades(1e-12, 1e-3), ..usual_model(draw) },
        counts: [529, 1046, 58, 0],
    },
    Regime {
        name: "pulled",
        model: |draw| Parameters { b: -draw.between(0.0, 0.3), ..usual_model(draw) },
        counts: [441, 902, 43, 0],
    },
    Regime {
        name: "static force next to one",
        model: |draw| Parameters { b: 1.0 + draw.between(-1e-6, 1e-6), ..usual_model(draw) },
        counts: [741, 1464, 81, 0],
    },
    Regime {
        name: "strong force",
        model: |draw| Parameters { a: draw.decades(1.0, 100.0), ..usual_model(draw) },
        counts: [3109, 3682, 108, 0],
    },
    Regime {
        name: "weak force",
        model: |draw| Parameters { a: draw.decades(1e-9, 1e-2), ..usual_model(draw) },
        counts: [1932, 2704, 179, 0],
    },
    Regime {
        name: "strong force, fast",
        model: |draw| Parameters {
            a: draw.decades(1.0, 100.0),
            omega: draw.decades(5.0, 50.0),
            xi: draw.decades(0.5, 100.0),
            ..usual_model(draw)
        },
        counts: [2974, 4618, 336, 0],
    },
];

/// A kind of graze in a regime.
struct Grazes {
    name: &'static str,
    model: fn(&mut Draw) -> Parameters,
    plant: fn(&Parameters, &mut Draw, Crest) -> (Parameters, Start),
    /// Switches, evaluations, divisions, undecidable touches.
    counts: [u64; 4],
}

fn flight(parameters: &Parameters, draw: &mut Draw, crest: Crest) -> (Parameters, Start) {
    (*parameters, graze::flight(parameters, draw.between(-0.5, 1.0), crest))
}

fn contact(parameters: &Parameters, draw: &mut Draw, crest: Crest) -> (Parameters, Start) {
    (*parameters, graze::contact(parameters, draw.once_in(2), crest))
}

fn slip(parameters: &Parameters, draw: &mut Draw, crest: Crest) -> (Parameters, Start) {
    graze::slip(parameters, draw.between(-0.5, 1.0), crest)
}

fn flight_from_surface(parameters: &Parameters, _: &mut Draw, crest: Crest) -> (Parameters, Start) {
    graze::flight_from_surface(parameters, crest)
}

fn weak_model(draw: &mut Draw) -> Parameters {
    Parameters { xi: draw.decades(1e-4, 1e-2), ..usual_model(draw) }
}

fn fast_model(draw: &mut Draw) -> Parameters {
    Parameters { omega: draw.decades(5.0, 50.0), ..usual_model(draw) }
}

fn slow_model(draw: &mut Draw) -> Parameters {
    Parameters { omega: draw.decades(0.01, 0.1), ..usual_model(draw) }
}

fn stiff_model(draw: &mut Draw) -> Parameters {
    Parameters { xi: draw.decades(1.0, 50.0), ..usual_model(draw) }
}

const GRAZES: [Grazes; 14] = [
    Grazes {
        name: "flights from the surface",
        model: usual_model,
        plant: flight_from_surface,
        counts: [2970, 10479, 3855, 376],
    },
    Grazes {
        name: "flights from the surface, fast forcing",
        model: fast_model,
        plant: flight_from_surface,
        counts: [3061, 12456, 4453, 64],
    },
    Grazes {
        name: "flights from the surface, slow slider",
        model: stiff_model,
        plant: flight_from_surface,
        counts: [3033, 11297, 5538, 244],
    },
    Grazes { name: "flights", model: usual_model, plant: flight, counts: [3027, 7692, 2230, 224] },
    Grazes {
        name: "flights, strong spring",
        model: weak_model,
        plant: flight,
        counts: [3138, 9912, 2417, 126],
    },
    Grazes {
        name: "flights, fast forcing",
        model: fast_model,
        plant: flight,
        counts: [1888, 9995, 4644, 484],
    },
    Grazes {
        name: "flights, slow slider",
        model: stiff_model,
        plant: flight,
        counts: [2859, 6450, 1530, 157],
    },
    Grazes {
        name: "contacts",
        model: usual_model,
        plant: contact,
        counts: [3049, 9295, 4007, 453],
    },
    Grazes {
        name: "contacts, weak damping",
        model: weak_model,
        plant: contact,
        counts: [3168, 10730, 4808, 472],
    },
    Grazes {
        name: "contacts, fast forcing",
        model: fast_model,
        plant: contact,
        counts: [2405, 13071, 6053, 498],
    },
    Grazes {
        name: "contacts, slow forcing",
        model: slow_model,
        plant: contact,
        counts: [3757, 14029, 3926, 347],
    },
    Grazes {
        name: "progressions",
        model: usual_model,
        plant: slip,
        counts: [3028, 9124, 4071, 390],
    },
    Grazes {
        name: "progressions, strong spring",
        model: weak_model,
        plant: slip,
        counts: [3083, 13527, 6820, 314],
    },
    Grazes {
        name: "progressions, fast forcing",
        model: fast_model,
        plant: slip,
        counts: [1898, 7780, 2560, 179],
    },
];

/// Two phases from starts whose guard's crest is planted from 1e-8 below its threshold to 1e-8
/// above it, at all decades down to rounding: the rounding rooms decide which of them are touches.
fn count_grazes(grazes: &Grazes) -> Counters {
    /// The number of grazes of a kind, enough for each term of a rounding room to decide some of
    /// them.
    const GRAZES_PER_KIND: usize = 2000;
    let mut draw = Draw(11);
    let mut sum = Counters::default();
    for _ in 0..GRAZES_PER_KIND {
        let drawn = (grazes.model)(&mut draw);
        let crest = Crest {
            elapsed: draw.between(0.5, 8.0) / drawn.omega.max(1.0),
            above: draw.sign() * draw.decades(1e-17, 1e-8),
        };
        let (parameters, start) = (grazes.plant)(&drawn, &mut draw, crest);
        let model = Model::new(parameters).unwrap();
        add(&mut sum, &run(&model, &start, 2, 2));
    }
    sum
}

/// The counts as they are, printed, and a line where they are other or more than those pinned.
fn changed_counts(name: &str, found: &Counters, pinned: [u64; 4]) -> Option<String> {
    let Counters { switches, evaluations, divisions, undecidable } = *found;
    let counts = [switches, evaluations, divisions, undecidable];
    println!("{name}: {counts:?}");
    let is_kept = counts[0] == pinned[0] && counts[3] == pinned[3];
    let is_cheap = counts[1] <= pinned[1] && counts[2] <= pinned[2];
    (!(is_kept && is_cheap)).then(|| format!("{name}: {counts:?}, was {pinned:?}"))
}

#[test]
fn grazes_are_decided_as_they_were() {
    let changed: Vec<_> = GRAZES
        .iter()
        .filter_map(|it| changed_counts(it.name, &count_grazes(it), it.counts))
        .collect();
    assert!(changed.is_empty(), "{changed:#?}");
}

#[test]
fn the_search_takes_the_work_that_it_took() {
    let changed: Vec<_> =
        REGIMES.iter().filter_map(|it| changed_counts(it.name, &count(it), it.counts)).collect();
    assert!(changed.is_empty(), "{changed:#?}");
}
