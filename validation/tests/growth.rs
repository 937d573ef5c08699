//! The growth of errors, computed in two ways that share nothing, and by differences in 106 bits.
//!
//! The harness follows perturbations along the truth's rows with matrix exponentials of the linear
//! phases; the solver multiplies the derivatives of its closed forms.

use crate::exact;
use percuss::TwoWord;
use percuss::number::Number;
use percuss::variation::{ANGLE, IDENTITY, Matrix, P, Q, V, Y, product, times};
use percuss::{Entry, Exit, GrowthRecorder, Instant, Parameters, Segment};
use percuss_validation::case::{Case, SAMPLES_PER_PERIOD};
use percuss_validation::engine::{OscillatorTask, SampleGrid};
use percuss_validation::truth::{DoubleDouble, Library, Replay, Truth, TruthRow};

/// Allowed difference, as a share of the largest growth so far: both are products of matrices in
/// f64 (4e-12 is the most in regular motion; where a growth passes through a minimum, less of its
/// own digits are left).
const GROWTH_TOLERANCE: f64 = 1e-11;
/// Allowed difference in chaos, where the rows are off by eps times the growth, and the derivatives
/// by some times that (8 where most): a grazing impact bends them.
const CHAOS_TOLERANCE: f64 = 20.0 * f64::EPSILON;

const CASES: [&str; 12] = [
    "chaos-from-rest",
    "chaos-mid-flight",
    "critical-xi-1",
    "cycle-1e8",
    "fast-forcing",
    "fig7b-period-12",
    "graze-overlap-1e-6",
    "impact-into-progression",
    "over-damped-xi-20",
    "resonance",
    "stiff-xi-0-001",
    "table1-from-rest",
];

/// The growth of p, y, q and v.
fn four(row: &TruthRow) -> [f64; 4] {
    row.growth.as_slice().try_into().expect("four states")
}

fn run(case: &Case) -> (OscillatorTask, Truth) {
    let library = Library::embedded().expect("the manifest is read");
    let truth = library.truth(case).expect("the tables are there");
    let grid = SampleGrid { per_period: SAMPLES_PER_PERIOD, count: truth.samples.len() };
    (OscillatorTask::new(case.of_oscillator().expect("it is one"), grid), truth)
}

#[test]
fn products_of_the_solver_agree_with_matrix_exponentials() {
    let mut worst = 0.0_f64;
    for name in CASES {
        let case = exact::case(name);
        let (task, truth) = run(&case);
        let mut recorder = GrowthRecorder::new();
        let mut largest = 1.0;
        let mut compare = |ours: [f64; 5], theirs: [f64; 5], what: &str| {
            largest = theirs.into_iter().fold(largest, f64::max);
            for (a, b) in ours.into_iter().zip(theirs) {
                let apart = (a - b).abs() / largest;
                let allowed = GROWTH_TOLERANCE + CHAOS_TOLERANCE * largest;
                assert!(apart <= allowed, "{name}: {what}: {ours:?} and {theirs:?}");
                worst = worst.max(apart);
            }
        };
        let values = |it: percuss::Growth| {
            let [p, y, q] = it.state;
            [it.tau, p, y, q, it.v]
        };
        let start = task.problem.entry;
        let segments = task.problem.model.trajectory(start).until(task.horizon);
        let (mut switch, mut sample) = (0, 0);
        for segment in segments {
            while sample < task.grid.count {
                let instant = start.instant.after_periods(sample as u64, 8);
                if segment.ends_by(&instant) {
                    break;
                }
                let elapsed =
                    instant.since(&segment.entry().instant, task.parameters.omega).value();
                let [p, y, q, v] = four(&truth.samples[sample]);
                let what = format!("sample {sample}");
                compare(values(recorder.at(&segment, elapsed)), [1.0, p, y, q, v], &what);
                sample += 1;
            }
            if let Some(found) = recorder.pass(&segment) {
                let what = format!("switch {}", switch + 1);
                let row = &truth.events[switch];
                let [p, y, q, v] = four(row);
                compare(values(found), [row.growth_time, p, y, q, v], &what);
                switch += 1;
            }
        }
        assert_eq!((switch, sample), (truth.events.len(), truth.samples.len()), "{name}");
    }
    println!("the two growths agree to {worst:.1e}");
}

/// A step whose square is below the digits of f64, and whose quotient leaves 106 bits some twenty.
const STEP: f64 = 1e-11;
/// Derivatives of the run in f64 carry eps times the growth along the run so far; the differences
/// carry STEP^2 times a third derivative, which grows with the cube of the growth.
const DIFFERENCE_TOLERANCE: f64 = 1e-10;

/// tau, p, y, q and v of every event of a run in 106 bits.
fn events(
    parameters: &Parameters,
    entry: &Entry,
    state: [DoubleDouble; 3],
    end: Instant,
) -> Vec<[DoubleDouble; 5]> {
    let passages = Replay::from_two_words(parameters, entry, state, end);
    let rows = passages.map_while(|passage| {
        let next = passage.expect("it is decided").next?;
        let elapsed = next.instant.since(&entry.instant, parameters.omega);
        let [p, y, q, v] = next.values();
        Some([elapsed.into(), p, y, q, v])
    });
    rows.collect()
}

/// The derivatives of every event's row with respect to the start, by the solver's products.
fn derivatives(segments: impl Iterator<Item = Segment>) -> Vec<Matrix> {
    let mut source = IDENTITY;
    let mut all = Vec::new();
    for segment in segments {
        let Exit::Switch(_) = segment.exit() else { break };
        let switch = segment.switch_derivative().expect("a switch ends it");
        source = product(&segment.variation(segment.duration()), &source);
        let mut rows = product(&switch.state, &source);
        // The first row of an event is its time's.
        rows[ANGLE] = times(&switch.time, &source);
        all.push(rows);
        source = product(&segment.saltation(), &source);
    }
    all
}

#[test]
fn the_solvers_products_are_what_differences_in_106_bits_say() {
    let case = exact::case("chaos-mid-flight");
    let (task, _) = run(&case);
    let problem = task.problem;
    let start = problem.entry;
    let end = start.instant.after_periods(20, 1);
    let found = derivatives(problem.model.trajectory(start).until(end));
    let state = [start.state.p, start.state.y, start.state.q].map(DoubleDouble::exact);
    let varied = |column: usize, step: f64| {
        let mut entry = start;
        let mut state = state;
        match column {
            ANGLE => {
                let time = TwoWord::new(step).over(task.parameters.omega);
                entry.instant = start.instant.after(time, task.parameters.omega);
            }
            P => state[0] = state[0] + DoubleDouble::exact(step),
            Y => state[1] = state[1] + DoubleDouble::exact(step),
            _ => state[2] = state[2] + DoubleDouble::exact(step),
        }
        events(&task.parameters, &entry, state, end)
    };
    let mut worst = 0.0_f64;
    for column in [ANGLE, P, Y, Q] {
        let (plus, minus) = (varied(column, STEP), varied(column, -STEP));
        assert!(plus.len() == found.len() && minus.len() == found.len() && found.len() > 10);
        for (n, rows) in found.iter().enumerate() {
            for row in [ANGLE, P, Y, Q, V] {
                let difference = (plus[n][row] - minus[n][row]) / DoubleDouble::exact(2.0 * STEP);
                let (ours, theirs) = (rows[row][column], difference.to_f64());
                let size = rows[row].iter().fold(1.0, |size: f64, slope| size.max(slope.abs()));
                let apart = (ours - theirs).abs() / size;
                assert!(
                    apart <= DIFFERENCE_TOLERANCE,
                    "switch {n}: {row} by {column}: {ours} {theirs}"
                );
                worst = worst.max(apart);
            }
        }
    }
    println!("{} events, derivatives agree to {worst:.1e}", found.len());
}
