//! Fig. 6: the strange attractor's section, exact beside integrated, and how far they lie apart.

use super::claim::{Claim, ClaimVerdict};
use super::integrated::{integrator, representatives};
use super::item_work::{Findings, ItemWork};
use super::paper::chaotic_model;
use crate::case;
use crate::engine::{Accuracy, Engine, Failure, Limits, Task, answer};
use crate::integrators;
use crate::number::shortest;
use crate::picture::{Figure, INK, Layer, Plot, caption, phase_colour};
use crate::score::attractor::{AttractorTest, Comparison, RunSection, calibrated, run_of};
use percuss::{Phase, Start};

/// The harness's case that starts from rest at these parameters; its limits are calibrated.
const CASE: &str = "chaos-from-rest";
/// The tolerance of integrators.
const TOLERANCE: f64 = 1e-9;
const TRANSIENT: u32 = 200;
/// Points of the pictures.
const POINTS: u32 = 20_000;

pub(super) fn run(work: &ItemWork<'_>) -> Result<Findings, Failure> {
    let engines = representatives();
    let integrated = integrator()?;
    let exact = section(integrators::exact(), Accuracy::Exact)?;
    let other = section(integrated, Accuracy::Tolerance(TOLERANCE))?;
    let comparisons = compared(&engines)?;
    let mut findings = Findings::default();
    findings.claims.extend(settle(work, &exact, &other, &comparisons)?);
    let farthest = comparisons.iter().map(|(_, it)| it.share()).fold(0.0, f64::max);
    findings
        .picture("figure-6", &drawing(&exact, &other, integrated.declaration().name, farthest))?;
    for (name, section) in [("figure-6a", &exact), ("figure-6b", &other)] {
        let row = |point: &[f64; 3]| point.iter().copied().map(shortest).collect();
        findings.csv(name, &["p", "y", "q"], section.points.iter().map(row))?;
    }
    Ok(findings)
}

fn section(engine: &dyn Engine, accuracy: Accuracy) -> Result<RunSection, Failure> {
    let refused = || Failure::new("the start is refused");
    let task = run_of(chaotic_model(), Start::default(), TRANSIENT + POINTS).ok_or_else(refused)?;
    let limits = Limits { calls: 1_000_000_000, events: 1_000_000, ..Limits::default() };
    RunSection::new(
        &task,
        &answer(engine, &Task::of_oscillator(&task)?, accuracy, &limits)?,
        TRANSIENT,
    )
}

/// Each integrator's section against the reference, in units of the calibrated limits.
fn compared(engines: &[&'static dyn Engine]) -> Result<Vec<(&'static str, Comparison)>, Failure> {
    let cases = case::embedded().map_err(Failure::new)?;
    let case = cases.iter().find(|case| case.name == CASE);
    let limits = calibrated().map_err(Failure::new)?.into_iter().find(|it| it.case == CASE);
    let (Some(case), Some(limits)) = (case, limits) else {
        return Err(Failure::new(format!("the case {CASE} has no calibrated limits")));
    };
    let own = case.of_oscillator().map_err(Failure::new)?;
    let test = AttractorTest::new(own, limits)?;
    let compare = |engine: &&'static dyn Engine| {
        let accuracy = Accuracy::Tolerance(TOLERANCE);
        let comparison = test.compare(own, *engine, accuracy, &Limits::default())?;
        Ok((engine.declaration().name, comparison))
    };
    engines.iter().map(compare).collect()
}

fn settle(
    work: &ItemWork<'_>,
    exact: &RunSection,
    other: &RunSection,
    comparisons: &[(&'static str, Comparison)],
) -> Result<[Claim; 2], Failure> {
    let strange = exact.lyapunov > 0.0;
    let computed = format!(
        "{} points; the exponent is {:.3} per period: chaotic",
        exact.points.len(),
        exact.lyapunov
    );
    let first = Claim::settle(&work.paper, "fig6a", ClaimVerdict::new(strange), computed)?
        .note(format!("from rest, after {TRANSIENT} periods"))
        .evidence(
            "exact solver, a point a forcing period",
            format!("drift {:.4} per period", exact.drift),
        );
    let agree = comparisons.iter().all(|(_, it)| it.share() <= 1.0);
    let within = comparisons.iter().filter(|(_, it)| it.share() <= 1.0).count();
    // In chaos the digits of an integrator's section are those of its machine: none is printed.
    let computed = format!(
        "{} points by integration; {within} of {} integrators keep within what two exact runs differ by, in every distance",
        other.points.len(),
        comparisons.len(),
    );
    let mut second = Claim::settle(&work.paper, "fig6b", ClaimVerdict::new(agree), computed)?.note(
        "one-dimensional distances of p, y, q and their delay pairs, phase words, exponent, drift; limits that none \
         of 20,000 exact runs exceeded",
    );
    for (name, comparison) in comparisons {
        second = second.evidence(format!("{name}, tolerance {TOLERANCE:e}"), found_of(comparison));
    }
    Ok([first, second])
}

/// How many of a comparison's distances are within their limits, and which are not.
fn found_of(comparison: &Comparison) -> String {
    let all = &comparison.distances;
    let is_within = |it: &&(&str, f64, f64)| it.1 <= it.2;
    let beyond: Vec<_> = all.iter().filter(|it| !is_within(it)).map(|it| it.0).collect();
    let within =
        format!("{} of {} distances within their limits", all.len() - beyond.len(), all.len());
    if beyond.is_empty() { within } else { format!("{within}; not {}", beyond.join(", ")) }
}

fn drawing(exact: &RunSection, other: &RunSection, engine: &str, farthest: f64) -> Figure {
    let plot = |title: String, section: &RunSection, colour| Plot {
        title,
        axes: ["p".to_owned(), "y".to_owned()],
        window: None,
        layers: vec![Layer::Dots {
            points: section.points.iter().map(|[p, y, _]| [*p, *y]).collect(),
            colour,
            size: 0.6,
        }],
    };
    Figure {
        title: "Fig. 6: Poincar\u{e9} section of the strange attractor".to_owned(),
        caption: format!(
            "{}; strobes at \u{3c9}\u{3c4} = 0 (mod 2\u{3c0}), {POINTS} points after {TRANSIENT} periods from rest. (a) exact solver; \
             (b) {engine} at a tolerance of {TOLERANCE:e}. Largest distance between the two kinds of section, over integrators of three \
             libraries: {farthest:.2} of the calibrated limit.",
            caption(&chaotic_model())
        ),
        columns: 2,
        panel: (760, 560),
        plots: vec![
            plot("(a) semi-analytically".to_owned(), exact, INK),
            plot("(b) by numerical integration".to_owned(), other, phase_colour(Phase::NoContact)),
        ],
    }
}
