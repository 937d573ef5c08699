//! Fig. 10: the period-four attractor followed in omega, with and without correction of the start.

use super::attractors::{described, found, of_period, start};
use super::bifurcations::MIN_PRINTED_ERROR;
use super::claim::{Claim, ClaimVerdict};
use super::continued::first;
use super::item_work::{Findings, ItemWork};
use super::paper::attractors_model;
use crate::engine::Failure;
use crate::number::shortest;
use crate::picture::{Figure, INK, Layer, Plot};
use percuss::Parameter;
use percuss::dynamics::attractor::Attractor;
use percuss::dynamics::continuation::{Bifurcation, BifurcationKind};
use percuss::dynamics::diagram::{Diagram, DiagramStep, Follow};
use percuss::dynamics::strobe::StrobePoint;

/// The frequency at which the period-four attractor is taken up.
const FIRST_OMEGA: f64 = 1.4;
/// The frequencies between which the period-four attractor is followed.
const OMEGA_RANGE: (f64, f64) = (1.35, 1.62);
/// Values over the range, forcing periods left out and shown at each.
const VALUES: u32 = 541;
const TRANSIENT: u64 = 600;
const PERIODS: u32 = 96;
/// Strobes nearer than this are one point of the diagram.
const POINT_TOLERANCE: f64 = 1e-4;

pub(super) fn run(work: &ItemWork<'_>) -> Result<Findings, Failure> {
    let attractors = found(FIRST_OMEGA)?;
    let four = of_period(&attractors, 4)?;
    let corrected = corrected(four.points[0])?;
    (work.step)();
    let uncorrected = diagram(four.points[0], OMEGA_RANGE.0, OMEGA_RANGE.1, VALUES, Follow::Reset)?;
    (work.step)();
    let stable = Stable::new(four, FIRST_OMEGA)?;
    let mut findings = Findings::default();
    findings.claims.push(settle_a(work, &corrected, &stable)?);
    findings.claims.push(settle_b(work, &uncorrected, &stable)?);
    findings.claims.push(settle_12(work, &uncorrected, &stable)?);
    findings.picture("figure-10", &drawing(&corrected, &uncorrected))?;
    for (name, steps) in [("figure-10a", &corrected), ("figure-10b", &uncorrected)] {
        findings.csv(name, &["omega", "p", "y", "q", "drift_per_period"], rows(steps))?;
    }
    Ok(findings)
}

fn rows(steps: &[DiagramStep]) -> impl Iterator<Item = Vec<String>> {
    steps.iter().flat_map(|step| {
        step.points
            .iter()
            .map(|[p, y, q]| [step.value, *p, *y, *q, step.drift_per_period].map(shortest).to_vec())
    })
}

fn diagram(
    point: StrobePoint,
    from: f64,
    to: f64,
    steps: u32,
    follow: Follow,
) -> Result<Vec<DiagramStep>, Failure> {
    let diagram = Diagram {
        parameters: attractors_model(from),
        start: start(point),
        parameter: Parameter::Omega,
        from,
        to,
        steps,
        transient: TRANSIENT,
        periods: PERIODS,
        follow,
    };
    diagram.steps(|_| {}).map_err(Failure::new)
}

/// Carried from where the attractor is known, to both sides.
fn corrected(four: StrobePoint) -> Result<Vec<DiagramStep>, Failure> {
    let share = (FIRST_OMEGA - OMEGA_RANGE.0) / (OMEGA_RANGE.1 - OMEGA_RANGE.0);
    let below = (f64::from(VALUES) * share) as u32;
    let mut steps = diagram(four, FIRST_OMEGA, OMEGA_RANGE.0, below, Follow::Carry)?;
    steps.reverse();
    steps.pop();
    steps.extend(diagram(four, FIRST_OMEGA, OMEGA_RANGE.1, VALUES - below, Follow::Carry)?);
    Ok(steps)
}

/// Between what an orbit is stable.
struct Stable {
    /// The flip in which it loses its stability downwards.
    flip: Bifurcation,
    /// The fold in which it ends upwards.
    fold: Bifurcation,
}

impl Stable {
    /// The window of an orbit at some frequency, as far as the range goes.
    fn new(orbit: &Attractor, omega: f64) -> Result<Self, Failure> {
        let flip = first(BifurcationKind::Flip, orbit, omega, OMEGA_RANGE.0)?;
        let fold = first(BifurcationKind::Fold, orbit, omega, OMEGA_RANGE.1)?;
        Ok(Self { flip, fold })
    }
}

/// The number of different points of a step, up to a limit.
fn count(step: &DiagramStep) -> usize {
    let mut kept: Vec<&StrobePoint> = Vec::new();
    for point in &step.points {
        let apart = |it: &&StrobePoint| (it[0] - point[0]).abs().max((it[1] - point[1]).abs());
        if kept.iter().all(|it| apart(it) > POINT_TOLERANCE) {
            kept.push(point);
        }
    }
    kept.len()
}

/// Steps inside the orbit's stable interval; next to its ends motions settle too slowly to be
/// counted.
fn inside<'a>(
    steps: &'a [DiagramStep],
    stable: &'a Stable,
) -> impl Iterator<Item = &'a DiagramStep> {
    const OMEGA_MARGIN: f64 = 0.002;
    let within = move |step: &&DiagramStep| {
        step.value > stable.flip.value + OMEGA_MARGIN
            && step.value < stable.fold.value - OMEGA_MARGIN
    };
    steps.iter().filter(within)
}

fn settle_a(work: &ItemWork<'_>, steps: &[DiagramStep], stable: &Stable) -> Result<Claim, Failure> {
    let all = inside(steps, stable).count();
    let four = inside(steps, stable).filter(|step| count(step) == 4).count();
    let computed = format!(
        "carried along, the motion stays on period four at all {four} of {all} values between omega = {:.4} and {:.4}",
        stable.flip.value, stable.fold.value
    );
    Ok(Claim::settle(&work.paper, "fig10a", ClaimVerdict::new(four == all && all > 0), computed)?
        .note(format!(
            "range of omega assumed: {} to {}; each value starts from where the last ended",
            OMEGA_RANGE.0, OMEGA_RANGE.1
        ))
        .evidence(
            "strobes after a transient, value by value",
            format!("{TRANSIENT} periods left out, {PERIODS} kept"),
        )
        .evidence(
            "continuation of the orbit",
            format!(
                "stable from a flip at {:.10} +- {:.0e} to a fold at {:.10} +- {:.0e}",
                stable.flip.value,
                stable.flip.error.max(MIN_PRINTED_ERROR),
                stable.fold.value,
                stable.fold.error.max(MIN_PRINTED_ERROR)
            ),
        ))
}

fn settle_b(work: &ItemWork<'_>, steps: &[DiagramStep], stable: &Stable) -> Result<Claim, Failure> {
    let all = inside(steps, stable).count();
    let off: Vec<_> = inside(steps, stable).filter(|step| count(step) != 4).collect();
    let computed = format!(
        "always from the same start, {} of {all} values show something else than the period four that is stable there",
        off.len()
    );
    let first: Vec<_> = off
        .iter()
        .take(5)
        .map(|step| format!("{:.4} ({} points)", step.value, count(step)))
        .collect();
    Ok(Claim::settle(&work.paper, "fig10b", ClaimVerdict::new(!off.is_empty()), computed)?
        .note("every value starts from the orbit's strobe at omega = 1.4; the paper does not print its start")
        .evidence("strobes after a transient, value by value", format!("first at {}", first.join(", "))))
}

fn settle_12(
    work: &ItemWork<'_>,
    uncorrected: &[DiagramStep],
    stable: &Stable,
) -> Result<Claim, Failure> {
    const OMEGA: f64 = 1.45;
    let attractors = found(OMEGA)?;
    let (four, twelve) = (of_period(&attractors, 4)?, of_period(&attractors, 12)?);
    let twelves: Vec<_> = uncorrected
        .iter()
        .filter(|step| count(step) == 12)
        .map(|step| format!("{:.4}", step.value))
        .collect();
    let beside = Stable::new(twelve, OMEGA)?;
    let untouched = stable.flip.value < beside.flip.value && stable.fold.value > beside.fold.value;
    let computed = format!(
        "period four has no bifurcation between {:.4} and {:.4}; period twelve is stable beside it from {:.6} to {:.6}",
        stable.flip.value, stable.fold.value, beside.flip.value, beside.fold.value
    );
    Ok(Claim::settle(&work.paper, "false-12", ClaimVerdict::new(untouched), computed)?
        .evidence("orbits at omega = 1.45 by Newton", format!("{}; {}", described(four), described(twelve)))
        .evidence("continuation of both orbits", "period twelve ends in a fold above and loses stability in a flip below, period four in neither")
        .evidence(
            "diagram without correction",
            if twelves.is_empty() {
                "shows no period twelve from this start".to_owned()
            } else {
                format!("shows period twelve at omega = {}", twelves.join(", "))
            },
        ))
}

fn drawing(corrected: &[DiagramStep], uncorrected: &[DiagramStep]) -> Figure {
    let plot = |title: &str, steps: &[DiagramStep]| Plot {
        title: title.to_owned(),
        axes: ["\u{3c9}".to_owned(), "p".to_owned()],
        window: Some([OMEGA_RANGE, (-3.4, 1.2)]),
        layers: vec![Layer::Dots {
            points: steps
                .iter()
                .flat_map(|step| step.points.iter().map(|point| [step.value, point[0]]))
                .collect(),
            colour: INK,
            size: 0.6,
        }],
    };
    Figure {
        title: "Fig. 10: bifurcation diagrams of the period-four attractor".to_owned(),
        caption: format!(
            "a = 0.3, b = 0.1, \u{3be} = 0.1, g = 0.02, \u{3c6} = \u{3c0}/2; strobes at \u{3c9}\u{3c4} = 0 (mod 2\u{3c0}), {TRANSIENT} periods \
             left out, {PERIODS} shown, {VALUES} values. (a) each value starts from where the last ended, from \u{3c9} = {FIRST_OMEGA} to both sides; \
             (b) every value starts from the orbit's strobe at \u{3c9} = {FIRST_OMEGA}."
        ),
        columns: 2,
        panel: (760, 560),
        plots: vec![plot("(a) with correction", corrected), plot("(b) without", uncorrected)],
    }
}
