//! The search against plain one-sided stepping, which shares nothing with it but the closed forms.

use crate::support::one_sided::{Effort, OneSidedEnd, one_sided_end};
use crate::support::random::Draw;
use percuss::{Counters, DoubleDouble, Entry, Exit, Model, Parameters, Phase, Segment, Start};

/// Evaluations after which the judge gives a segment up.
const MAX_EVALUATIONS: usize = 20_000;

/// omega and xi of the paper's cases and of the corners around them.
const REGIMES: [(f64, f64); 16] = [
    (1.4, 0.01),
    (0.1, 0.01),
    (1.4, 0.1),
    (1.45, 0.1),
    (1.56, 0.1),
    (1.58, 0.1),
    (1.6, 0.1),
    (1.7, 0.1),
    (0.7, 0.1),
    (1.0, 1e-4),
    (1.0, 0.3),
    (0.9, 1.0),
    (1.2, 1.5),
    (2.5, 10.0),
    (6.0, 0.01),
    (0.3, 1e-3),
];

fn random_model(draw: &mut Draw) -> Model {
    let (a, b) = (draw.decades(0.03, 10.0), draw.between(-0.05, 0.9));
    let (xi, omega) = (draw.decades(1e-4, 1e2), draw.decades(0.01, 50.0));
    let (g, phi) = (draw.between(0.0, 0.3), draw.between(0.0, 6.0));
    Model::new(Parameters { a, b, xi, omega, g, phi }).unwrap()
}

fn random_start(draw: &mut Draw, model: &Model) -> Entry {
    let q = draw.between(0.0, 1.0);
    let p = q + model.parameters().g - draw.decades(1e-6, 1.0);
    let y = draw.between(-1.0, 1.0);
    model.start(&Start { p, y, q: Some(q), ..Start::default() }).unwrap()
}

#[derive(Debug, Default)]
struct Agreement {
    switches: u64,
    given_up: u64,
    /// Differences on segments that one of the two called undecidable.
    undecidable: u64,
    disagreements: Vec<String>,
    worst: f64,
}

/// The distance that both solvers' ends of a segment may have: both know the guard to a few eps of
/// its terms, which is that over its slope in time.
fn room(model: &Model, segment: &Segment, next: &Entry) -> f64 {
    let Parameters { a, b, xi, omega, g, .. } = *model.parameters();
    let (from, to) = (segment.entry().state, next.state);
    let (d, rate, two_xi) = (segment.duration(), 0.5 / xi, 2.0 * xi);
    let force = model.force(&next.instant)[0];
    let displacement = a * (0.5 * d * d).min((2.0 + omega * d) / (omega * omega));
    let (terms, slope) = match segment.phase() {
        Phase::NoContact => {
            let lift = 0.5 * b.abs() * d * d + displacement;
            let start = from.p.abs() + g + from.q.abs() + (from.y * d).abs();
            (start + lift, to.y + rate * to.q)
        }
        Phase::Contact => {
            let parts = 1.0 + b.abs() + from.q.abs() + two_xi * from.y.abs() + from.y.abs();
            let f = two_xi * to.y + to.q;
            (parts + displacement.min(a / two_xi), two_xi * (force - f) + to.y)
        }
        Phase::Progression => {
            let parts = from.y.abs() + rate * (1.0 - from.q).abs();
            let push = (b - 1.0).abs() * d + a * d.min(2.0 / omega);
            (parts + push, force - 1.0 + rate * to.y)
        }
    };
    32.0 * f64::EPSILON * (terms / slope.abs() + d)
}

/// The time that a segment lasts by one-sided steps in 106 bits: infinite where it does not end
/// within the horizon, nothing where that is not decided.
fn judged_duration(model: &Model, segment: &Segment, horizon: f64) -> Option<f64> {
    let effort = Effort { horizon, evaluations: MAX_EVALUATIONS, unit: DoubleDouble::UNIT };
    match one_sided_end::<DoubleDouble>(model, segment, &effort) {
        OneSidedEnd::Crossing { elapsed, .. } => Some(elapsed),
        OneSidedEnd::Clear => Some(f64::INFINITY),
        OneSidedEnd::Undecided => None,
    }
}

fn judge(model: &Model, segment: &Segment, undecidable: bool, score: &mut Agreement) {
    let (found, next) = match segment.exit() {
        Exit::Switch(next) => (segment.duration(), next),
        // Not a switch: the judge must not find one either, as far as it can look.
        _ => {
            let horizon = segment.duration().min(20.0 * model.period());
            match judged_duration(model, segment, horizon * (1.0 - 1e-9)) {
                None => score.given_up += 1,
                Some(time) if time.is_infinite() => {}
                Some(_) if undecidable => score.undecidable += 1,
                Some(time) => score.disagreements.push(format!("{segment:?}: judged {time:e}")),
            }
            return;
        }
    };
    score.switches += 1;
    let Some(judged) = judged_duration(model, segment, f64::INFINITY) else {
        score.given_up += 1;
        return;
    };
    let ratio = (judged - found).abs() / room(model, segment, next);
    if ratio <= 1.0 {
        score.worst = score.worst.max(ratio);
    } else if undecidable {
        score.undecidable += 1;
    } else {
        let about = format!("{:?} {:?} {:?}", model.parameters(), segment.phase(), segment.entry());
        score
            .disagreements
            .push(format!("{about}: {found:e}, judged {judged:e}, {ratio:.1} rooms"));
    }
}

fn run(model: &Model, start: Entry, switches: usize, score: &mut Agreement) {
    let horizon = start.instant.after_periods(1_000_000, 1);
    let mut trajectory = model.trajectory(start).until(horizon);
    let mut before = Counters::default();
    for _ in 0..switches {
        let Some(segment) = trajectory.next() else { return };
        let after = trajectory.counters();
        judge(model, &segment, after.undecidable > before.undecidable, score);
        before = after;
    }
}

fn agree(per_regime: usize, random_models: usize, per_model: usize) -> Agreement {
    let mut score = Agreement::default();
    let mut draw = Draw(2004);
    for (omega, xi) in REGIMES {
        let model = Model::new(Parameters { omega, xi, ..Parameters::default() }).unwrap();
        // Several starts, because some come to rest.
        for _ in 0..10 {
            let start = random_start(&mut draw, &model);
            run(&model, start, per_regime / 10, &mut score);
        }
    }
    for _ in 0..random_models {
        let model = random_model(&mut draw);
        let start = random_start(&mut draw, &model);
        run(&model, start, per_model, &mut score);
    }
    let Agreement { switches, given_up, undecidable, worst, disagreements } = &score;
    println!(
        "{switches} switches, {given_up} given up, {undecidable} undecidable, {} disagreements, worst {worst:.2} rooms",
        disagreements.len()
    );
    for line in disagreements.iter().take(10) {
        println!("{line}");
    }
    assert!(disagreements.is_empty(), "{} disagreements", disagreements.len());
    // Long flights at small b + a and slow contacts cost the judge thousands of steps.
    assert!(*given_up as f64 <= 0.01 * *switches as f64, "{given_up} given up");
    assert!(*undecidable as f64 <= 1e-3 * *switches as f64, "{undecidable} undecidable");
    score
}

#[test]
fn search_and_plain_stepping_agree() {
    let score = agree(2000, 600, 40);
    assert!(score.switches > 30_000);
}

#[test]
#[ignore = "a million switches; docs/LONG_TESTS.md names the command"]
fn search_and_plain_stepping_agree_on_a_million_switches() {
    let score = agree(60_000, 20_000, 50);
    assert!(score.switches > 1_000_000, "{}", score.switches);
}
