//! A report with everything in it, and with what is hard to show: numbers that are not finite,
//! names that need escaping, engines without a result.

use percuss_validation::provenance::Build;
use percuss_validation::report::{
    CaseNote, Cost, DefectQuantiles, DefectUnits, EngineEntry, ErrorGrowth, EventMark,
    EventPicture, FaultRow, GrazeRow, JudgedRecords, MismatchKind, Quantiles, Ranked, Report,
    ReportEvidence, ReportRow, RestartHistogram, RightRows, SectionPair, SettingCounts, Summary,
    ValidHorizons, View, ViewTrajectory,
};
use percuss_validation::score::{Spread, Verdict};
use percuss_validation::suite::{CaseTraits, Suite};

pub const UNESCAPED_TEXT: &str =
    "</script><script>alert(1)</script> & \"50 %\", a::b\r\n<!-- \u{1}";

const ENGINES: [(&str, &str); 12] = [
    ("exact", "percuss"),
    ("diffsol-bdf", "diffsol"),
    ("diffsol-tr_bdf2", "diffsol"),
    ("diffsol-esdirk34", "diffsol"),
    ("diffsol-tsit45", "diffsol"),
    ("ode_solvers-dopri5", "ode_solvers"),
    ("ode_solvers-dop853", "ode_solvers"),
    ("ode_solvers-rk4", "ode_solvers"),
    ("de-rkv655e", "differential-equations"),
    ("de-radau5", "differential-equations"),
    ("de-kvaerno745", "differential-equations"),
    ("wrong-drops-events", "percuss"),
];
const TOLERANCES: [f64; 3] = [1e-6, 1e-9, 1e-12];

/// A number in [0, 1) that looks like chance.
fn pseudorandom(seed: usize) -> f64 {
    (seed as f64 * 12.9898 + 78.233).sin().abs() * 43_758.545_3 % 1.0
}

fn margins() -> impl Iterator<Item = (String, f64)> {
    let sizes = [1e-3, 1e-6, 1e-9, 1e-12];
    let name = |size: f64| format!("{size:e}");
    let misses = sizes.map(|size| (format!("graze-miss-{}", name(size)), -size));
    let touches = sizes.map(|size| (format!("graze-overlap-{}", name(size)), size));
    misses.into_iter().chain(touches)
}

/// The records of a row, all of them right.
fn right_records() -> JudgedRecords {
    let sample = Quantiles { median: Some(0.1), q99: Some(0.4), max: Some(0.7) };
    JudgedRecords {
        events_judged: Some(40),
        events_right: Some(40),
        events_missed: Some(0),
        events_spurious: Some(0),
        events_wrong_mode: Some(0),
        events_undecidable: Some(0),
        defect: DefectQuantiles { sample, ..DefectQuantiles::default() },
        ..JudgedRecords::default()
    }
}

pub fn row(case: &str, engine: &'static str, tolerance: Option<f64>, seed: usize) -> ReportRow {
    let unit = tolerance.unwrap_or(1e-15);
    let order = 3.0 + (seed % 5) as f64;
    let error = unit * 10.0_f64.powf(4.0 * pseudorandom(seed));
    let chaotic = case.ends_with("-00");
    let rhs = if tolerance.is_none() { 90.0 } else { 400.0 * unit.powf(-1.0 / (2.0 * order)) };
    ReportRow {
        case: case.to_owned(),
        trouble: Vec::new(),
        traits: CaseTraits { states: 3, ..CaseTraits::default() },
        is_sampled: true,
        engine,
        tolerance,
        step: None,
        status: "ok",
        horizon_periods: 12.0,
        events_expected: Some(40),
        events_total: 40,
        events_matched: Some(40),
        records: right_records(),
        phase_word_ok: Some(true),
        event_time_error: Spread { median: error / 8.0, q99: error / 2.0, max: error },
        state_error: Spread { median: error / 9.0, q99: error / 3.0, max: error / 2.0 },
        drift_error: error,
        drift_error_by_event_times: error,
        valid_periods: 12.0,
        valid_horizon: chaotic.then_some(ValidHorizons {
            runs: 200,
            median: 81.0,
            q01: 54.0,
            predicted_median: 79.0,
        }),
        restart: None,
        distance: None,
        order: None,
        rhs_evaluations: Some(rhs as u64),
        jacobian_evaluations: Some(0),
        linear_solves: Some(0),
        steps: Some(rhs as u64 / 7),
        wall_ns: Some(rhs as u64 * 900),
        own_ns: None,
        bounds: Vec::new(),
        verdict: Verdict::Pass,
        why: String::new(),
    }
}

fn results() -> Vec<ReportRow> {
    let mut cases: Vec<String> = (0..18).map(|k| format!("periodic-{k:02}")).collect();
    cases.extend(margins().map(|(name, _)| name));
    let mut rows = Vec::new();
    for (i, case) in cases.iter().enumerate() {
        for (j, (engine, _)) in ENGINES.iter().enumerate() {
            let settings: Vec<_> = if j == 0 { vec![None] } else { TOLERANCES.map(Some).to_vec() };
            for (k, setting) in settings.into_iter().enumerate() {
                rows.push(row(case, engine, setting, 31 * i + 7 * j + k));
            }
        }
    }
    let mut spoil = |at: usize, change: &dyn Fn(&mut ReportRow)| change(&mut rows[at]);
    spoil(3, &|row| {
        row.verdict = Verdict::Fail;
        row.why = UNESCAPED_TEXT.to_owned();
        row.events_matched = Some(31);
        row.records.events_missed = Some(9);
        row.records.events_spurious = Some(2);
    });
    spoil(5, &|row| {
        row.verdict = Verdict::Error;
        row.status = "failed";
        row.why = "3000000 right-hand sides are not enough".to_owned();
        row.event_time_error = Spread::NONE;
        row.state_error = Spread { median: 1.0, q99: f64::INFINITY, max: f64::INFINITY };
        row.drift_error = f64::NEG_INFINITY;
        row.events_expected = None;
        row.events_matched = None;
    });
    spoil(8, &|row| {
        row.verdict = Verdict::Unavailable;
        row.status = "unavailable";
        row.why = "would take more than 3e6 right-hand sides".to_owned();
    });
    spoil(11, &|row| {
        row.verdict = Verdict::Known;
        row.why = "its root finder looks at the ends of steps only".to_owned();
    });
    for (at, verdict, status) in [
        (14, Verdict::Undecidable, "ok"),
        (17, Verdict::NotScored, "ok"),
        (20, Verdict::NotRun, "not-run"),
    ] {
        spoil(at, &|row| {
            row.verdict = verdict;
            row.status = status;
        });
    }
    spoil(13, &|row| {
        row.event_time_error = Spread { median: 0.0, q99: 0.0, max: 0.0 };
        row.state_error = Spread { median: 0.0, q99: 0.0, max: 0.0 };
        row.rhs_evaluations = Some(0);
    });
    rows
}

/// The engines in their order, the first as the reference; the last one is not installed.
fn ranking() -> Vec<Ranked> {
    ENGINES.iter().enumerate().map(|(rank, (engine, _))| ranked_row(rank, engine)).collect()
}

fn ranked_row(rank: usize, engine: &'static str) -> Ranked {
    let counts = |count: usize| match rank {
        0 => SettingCounts(vec![("exact".to_owned(), count)]),
        _ => SettingCounts(TOLERANCES.map(|it| (format!("{it:e}"), count)).to_vec()),
    };
    let figure = |per_rank: f64| (rank < 9).then_some(per_rank * rank as f64);
    Ranked {
        engine,
        rank: (rank + 1 < ENGINES.len()).then_some(rank),
        clean: rank != 3,
        cases_right: counts(26 - 2 * rank),
        cases_total: counts(26),
        stiff: RightRows { cases_right: 9 - rank.min(9), cases_total: 9 },
        events_judged: 2300,
        events_right: 2300 - 20 * rank,
        events_missed: 15 * rank,
        events_spurious: 4 * rank,
        events_wrong_mode: rank,
        fails_on: vec!["periodic-00".to_owned(); rank.min(9)],
        defect_units: DefectUnits { median: figure(0.1), q99: None },
        cost: Cost { area: figure(0.1), within_twice: figure(0.1), rhs_per_event: figure(97.4) },
    }
}

pub fn report() -> Report {
    let results = results();
    let engine = |(name, library): &(&'static str, &'static str)| EngineEntry {
        name,
        library,
        version: "1.2.3".to_owned(),
        method: "a method of order 5(4) & its \"dense output\"",
        language: "Rust".to_owned(),
        order: None,
    };
    Report {
        gradients: Vec::new(),
        build: Build {
            schema: 1,
            percuss: "0.1.0".to_owned(),
            commit: None,
            rustc: "rustc".to_owned(),
            cpu: "a <processor>".to_owned(),
            target_cpu: "any".to_owned(),
        },
        suite: Suite::Quick,
        engines: ENGINES.iter().map(engine).collect(),
        ranking: ranking(),
        summary: Summary::new(&results),
        results,
    }
}

fn growth(engine: &str, tolerance: Option<f64>, seed: usize) -> ErrorGrowth {
    let periods: Vec<f64> = (0..=60).map(f64::from).collect();
    let unit = tolerance.unwrap_or(2.2e-16);
    let grown = |t: f64, factor: f64| unit * factor * (0.4 * t + (t * 0.7).sin()).exp();
    let error = periods.iter().enumerate().map(|(i, t)| match i {
        7 => f64::NAN,
        9 => 0.0,
        _ => (grown(*t, 3.0 + 30.0 * pseudorandom(seed + i))).min(0.5 + pseudorandom(i)),
    });
    ErrorGrowth {
        case: "fig7a-chaos".to_owned(),
        engine: engine.to_owned(),
        tolerance,
        error: error.collect(),
        truth_growth: periods.iter().map(|t| grown(*t, 1.0).min(1e3)).collect(),
        periods,
        lambda_per_period: Some(0.4),
    }
}

fn histogram(engine: &str, tolerance: Option<f64>, seed: usize) -> RestartHistogram {
    let edges: Vec<f64> = (0..=24).map(|k| -4.0 + 0.25 * f64::from(k)).collect();
    let centre = 6.0 + 10.0 * pseudorandom(seed);
    let counts =
        (0..24).map(|k| (1000.0 * (-((f64::from(k) - centre) / 3.0).powi(2)).exp()) as u64);
    let unit = if tolerance.is_some() { "tolerance" } else { "eps (1 + |value|) x growth" };
    RestartHistogram {
        case: "chaos-from-rest".to_owned(),
        engine: engine.to_owned(),
        tolerance,
        edges,
        counts: counts.collect(),
        unit: unit.to_owned(),
    }
}

fn section(count: usize) -> SectionPair {
    let cloud = |seed: usize| {
        let (mut x, mut y) = (0.1 + 0.1 * pseudorandom(seed), 0.1);
        let step = |_| {
            (x, y) = (1.0 - 1.4 * x * x + y, 0.3 * x);
            [x, y]
        };
        (0..count).map(step).collect::<Vec<[f64; 2]>>()
    };
    let mut direct = cloud(2);
    direct[0] = [f64::NAN, 0.0];
    SectionPair {
        omega: 0.8,
        xi: 0.1,
        exact: cloud(1),
        direct,
        direct_engine: "diffsol-tsit45".to_owned(),
        distances: vec![
            ("Wasserstein distance of p".to_owned(), 0.0012, 0.004),
            ("Kolmogorov-Smirnov distance of y".to_owned(), 0.031, 0.02),
            ("phase words".to_owned(), f64::NAN, 0.01),
        ],
    }
}

fn fault(engine: &str, fault: &str, caught: [bool; 4]) -> FaultRow {
    let names = ["events", "time error", "restart test", "same attractor"];
    let gate = |(name, caught): (&str, bool)| {
        (name.to_owned(), caught, if caught { "3.1 above 1".to_owned() } else { String::new() })
    };
    FaultRow {
        engine: engine.to_owned(),
        fault: fault.to_owned(),
        gates: names.into_iter().zip(caught).map(gate).collect(),
    }
}

/// A view of a touch that the engine passes over; the engine's value at one instant is not known.
fn view(half: f64) -> View {
    let instants = || (0..=60).map(|k| half * (f64::from(k) / 30.0 - 1.0));
    let touch = |t: f64| -t * t;
    let mark = |t, phase: &str| EventMark { t, phase: phase.to_owned(), matched: false };
    let mut values: Vec<f64> = instants().map(|t| touch(t) - 1e-7).collect();
    values[7] = f64::NAN;
    let events = vec![mark(0.0, "contact"), mark(1e-4, "no-contact")];
    View {
        from: -half,
        to: half,
        truth: ViewTrajectory {
            phase: "no-contact".to_owned(),
            events,
            values: instants().map(touch).collect(),
        },
        engine: ViewTrajectory { phase: "no-contact".to_owned(), events: Vec::new(), values },
        steps: vec![-0.6 * half, 0.2 * half, 0.8 * half],
        looks: vec![[-0.6 * half, touch(0.6 * half)], [0.8 * half, f64::NAN]],
    }
}

/// The picture of the row that is out of bounds.
fn event() -> EventPicture {
    EventPicture {
        case: "periodic-00".to_owned(),
        engine: "diffsol-bdf".to_owned(),
        tolerance: Some(1e-12),
        step: None,
        kind: MismatchKind::Missed,
        title: UNESCAPED_TEXT.to_owned(),
        guard: "gap p \u{2212} q \u{2212} g".to_owned(),
        modes: Vec::new(),
        centre: 12.345_678_901,
        views: [0.3, 0.02, 0.001].map(view).to_vec(),
        telling: 1,
    }
}

pub fn evidence() -> ReportEvidence {
    let note = |(name, margin): (String, f64)| CaseNote {
        file: format!("validation/cases/{name}.toml"),
        name,
        toml: "[case]\nname = \"graze\" # </script>\n".to_owned(),
        system: "oscillator".to_owned(),
        states: Vec::new(),
        regime: "grazing".to_owned(),
        why: UNESCAPED_TEXT.to_owned(),
        trouble: Vec::new(),
        margin: Some(margin),
    };
    let graze = |engine: &str, tolerance: Option<f64>, (case, margin): (String, f64)| GrazeRow {
        case,
        margin,
        engine: engine.to_owned(),
        tolerance,
        missed: usize::from(margin > 0.0 && tolerance.is_some_and(|it| it >= margin)),
        spurious: usize::from(margin < 0.0 && tolerance.is_some_and(|it| it > -1e2 * margin)),
    };
    let runs = || {
        let engines = ["diffsol-bdf", "ode_solvers-dop853", "de-rkv655e"];
        let adaptive = engines.into_iter().flat_map(|it| TOLERANCES.map(|t| (it, Some(t))));
        std::iter::once(("exact", None)).chain(adaptive)
    };
    let words = "every hundredth event is dropped, counted over the engine's life";
    ReportEvidence {
        cases: margins().map(note).collect(),
        replayed: Vec::new(),
        growth: runs().enumerate().map(|(i, (it, t))| growth(it, t, i)).collect(),
        restarts: runs().enumerate().map(|(i, (it, t))| histogram(it, t, i)).collect(),
        grazes: runs().flat_map(|(it, t)| margins().map(move |of| graze(it, t, of))).collect(),
        sections: vec![section(9000), section(900)],
        faults: vec![
            fault("wrong-drops-events", words, [true, false, true, true]),
            fault("wrong-omega", "omega + 0.002", [false, true, true, true]),
            fault(UNESCAPED_TEXT, "as printed", [false; 4]),
        ],
        events: vec![event()],
        worse: vec![UNESCAPED_TEXT.to_owned()],
        dearer: Vec::new(),
        folders: Vec::new(),
    }
}
