//! The bifurcations that Section 5 names, in which the attractors of Fig. 7 appear and vanish.

use super::attractors::{described, found, map, of_period};
use super::brute::{bracket, settled};
use super::claim::{Claim, ClaimVerdict};
use super::continued::{family, first};
use super::integrated::strobes;
use super::item_work::{Findings, ItemWork};
use super::paper::Printed;
use crate::engine::Failure;
use percuss::dynamics::attractor::{Attractor, AttractorKind};
use percuss::dynamics::continuation::{Bifurcation, BifurcationKind, Criticality, Doubling};
use percuss::dynamics::strobe::StrobePoint;

/// Claims of this item, in its order.
pub(super) const CLAIMS: &[&str] = &[
    "omega-1.571",
    "subcritical-1.571",
    "omega-1.5757",
    "omega-1.6395",
    "subcritical-1.6395",
    "red-emerges",
    "five-emerges",
];

/// Forcing periods after which motions next to a bifurcation are taken to be at rest: at 1e-5 from
/// a flip the multiplier is some 2e-4 from -1.
const REST_PERIODS: u64 = 300_000;
/// Strobes that repeat to this are at rest; a doubling at 1e-5 from its flip is some 3e-3 wide.
const STROBE_TOLERANCE: f64 = 1e-4;
/// Width of the intervals found by brute force.
const INTERVAL_WIDTH: f64 = 2e-5;
/// The tolerance of the integrator.
const TOLERANCE: f64 = 1e-10;

pub(super) fn run(work: &ItemWork<'_>) -> Result<Findings, Failure> {
    let mut findings = Findings::default();
    let of = |omega: f64, period: u32| Ok::<_, Failure>(of_period(&found(omega)?, period)?.clone());
    let (six, three, four) = (of(1.58, 6)?, of(1.70, 3)?, of(1.56, 4)?);
    let cascade = first(BifurcationKind::Flip, &six, 1.58, 1.55)?;
    let tripling = first(BifurcationKind::Flip, &three, 1.70, 1.60)?;
    let claims: [&dyn Fn() -> Result<Claim, Failure>; CLAIMS.len()] = [
        &|| flips(work, "omega-1.571", &cascade),
        &|| criticality(work, "subcritical-1.571", &cascade),
        &|| disappears(work, &four),
        &|| flips(work, "omega-1.6395", &tripling),
        &|| criticality(work, "subcritical-1.6395", &tripling),
        &|| red(work, &cascade),
        &|| five(work),
    ];
    for claim in claims {
        findings.claims.push(claim()?);
        (work.step)();
    }
    Ok(findings)
}

/// The least error that is printed, which is below the digits of the value: smaller ones are
/// rounding, and differ from machine to machine.
pub(super) const MIN_PRINTED_ERROR: f64 = 1e-12;

/// A bifurcation in words.
fn said(met: &Bifurcation) -> String {
    let Bifurcation { kind, value, error, orbit, .. } = met;
    let (kind, period) = (kind.as_str(), orbit.period());
    let error = error.max(MIN_PRINTED_ERROR);
    format!("{kind} of period {period} at omega = {value:.10} +- {error:.0e}")
}

/// Between our value and the nearest one that the paper's digits allow, where it is not one of
/// these.
fn between(printed: &Printed, value: f64) -> Option<f64> {
    let (paper, within) = (printed.value?, printed.within.filter(|_| !printed.prints(value))?);
    let edge = if value < paper { paper - within } else { paper + within };
    Some(0.5 * (edge + value))
}

/// A flip downwards in omega: by continuation, by brute force from both sides, and by an integrator
/// where we differ.
fn flips(work: &ItemWork<'_>, id: &str, flip: &Bifurcation) -> Result<Claim, Failure> {
    let printed = work.paper.claim(id)?;
    let period = flip.orbit.period() as usize;
    let start = flip.orbit.points[0];
    let keeps =
        |omega: f64| Ok(settled(omega, start, REST_PERIODS, STROBE_TOLERANCE)?.0 == Some(period));
    let (holds, fails) = bracket(flip.value + 0.003, flip.value - 0.003, INTERVAL_WIDTH, keeps)?;
    let mut claim = Claim::settle(
        &work.paper,
        id,
        ClaimVerdict::new(printed.agrees(flip.value)),
        format!(
            "the flip between periods {} and {} is at omega = {:.7}",
            period,
            2 * period,
            flip.value
        ),
    )?
    .evidence("continuation with multipliers", said(flip))
    .evidence(
        format!("brute force: strobes after {REST_PERIODS} forcing periods"),
        format!("period {period} at omega = {holds:.6}, no longer at {fails:.6}"),
    );
    if let Some(omega) = between(printed, flip.value) {
        let (seen, _) = settled(omega, start, REST_PERIODS, STROBE_TOLERANCE)?;
        let seen = seen.map_or("none up to 64".to_owned(), |period| period.to_string());
        let (integrator, repeats) = integrated(omega, start, &[period, 2 * period])?;
        claim = claim
            .evidence(format!("exact solver at omega = {omega:.5}, between the two values"), format!("period {seen}"))
            .evidence(format!("{integrator}, at omega = {omega:.5}"), repeats)
            .note("the paper's value is approximate (it writes \u{2248}); every method here gives ours");
    }
    Ok(claim)
}

/// An integrator, and which of some periods its strobes repeat with at rest.
fn integrated(
    omega: f64,
    point: StrobePoint,
    periods: &[usize],
) -> Result<(String, String), Failure> {
    const RUN_PERIODS: u32 = 4000;
    let (integrator, strobes) = strobes(omega, point, RUN_PERIODS, TOLERANCE)?;
    let last = strobes.len() - 1;
    let apart = |period: &usize| {
        let (now, then) = (strobes[last], strobes[last - period]);
        format!("to {:.0e} after {period}", (now[0] - then[0]).abs().max((now[1] - then[1]).abs()))
    };
    let apart: Vec<_> = periods.iter().map(apart).collect();
    let repeats = format!("after {RUN_PERIODS} periods its strobes repeat {}", apart.join(", "));
    Ok((integrator, repeats))
}

/// Whether a flip downwards in omega is super- or subcritical: what is there beyond it, and how
/// wide.
fn criticality(work: &ItemWork<'_>, id: &str, flip: &Bifurcation) -> Result<Claim, Failure> {
    let period = flip.orbit.period();
    let doubled = 2 * period as usize;
    let width = |distance: f64| -> Result<Option<f64>, Failure> {
        let omega = flip.value - distance;
        let (repeats, point) = settled(omega, flip.orbit.points[0], REST_PERIODS, 1e-7)?;
        if repeats != Some(doubled) {
            return Ok(None);
        }
        let map = map(omega)?;
        let entry = map.entry(point).map_err(Failure::new)?;
        let half = map.strobes(entry, u64::from(period)).last();
        let half = half.ok_or_else(|| Failure::new("no strobes"))?.point();
        Ok(Some((half[0] - point[0]).hypot(half[1] - point[1])))
    };
    let (near, far) = (width(1e-4)?, width(4e-4)?);
    // The width of a doubling that is born small grows as the square root of the distance.
    let grows =
        matches!((near, far), (Some(near), Some(far)) if (1.6..2.5).contains(&(far / near)));
    let within = (flip.value - 0.01, flip.value + 0.01);
    let doubling = Doubling::new(&family(), flip, within.0, within.1, &mut |_| {});
    let followed = doubling.map(|it| it.criticality);
    let verdict = match (followed, grows) {
        (Some(Criticality::Subcritical), false) => ClaimVerdict::Reproduced,
        (Some(Criticality::Supercritical), true) => ClaimVerdict::Differs,
        _ => ClaimVerdict::NotDetermined,
    };
    let computed = match verdict {
        ClaimVerdict::Differs => format!(
            "supercritical: below omega = {:.7} a stable orbit of period {doubled} takes over, its width growing as the square root",
            flip.value
        ),
        ClaimVerdict::Reproduced => format!(
            "subcritical: no stable orbit of period {doubled} is next to omega = {:.7}",
            flip.value
        ),
        ClaimVerdict::NotDetermined => "continuation and brute force do not agree".to_owned(),
    };
    let said = |it: Option<f64>| it.map_or("no such orbit".to_owned(), |it| format!("{it:.6}"));
    let side = match followed {
        Some(Criticality::Supercritical) => {
            "it exists where the single one is unstable: supercritical"
        }
        Some(Criticality::Subcritical) => "it exists where the single one is stable: subcritical",
        None => "none was found",
    };
    Ok(Claim::settle(&work.paper, id, verdict, computed)?
        .note("followed upwards in omega the cascade runs backwards, periods are halved; that may be what the paper calls subcritical")
        .evidence("continuation of the doubled orbit from the flip", side)
        .evidence(
            format!(
                "strobes after {REST_PERIODS} forcing periods at 1e-4 and 4e-4 beyond the flip"
            ),
            format!("stable period {doubled}, {} and {} wide: a ratio of 2 is the square root's", said(near), said(far)),
        ))
}

/// Period four ends in a fold.
fn disappears(work: &ItemWork<'_>, four: &Attractor) -> Result<Claim, Failure> {
    const ID: &str = "omega-1.5757";
    let printed = work.paper.claim(ID)?;
    let fold = first(BifurcationKind::Fold, four, 1.56, 1.62)?;
    let start = fold.orbit.points[0];
    let keeps =
        |omega: f64| Ok(settled(omega, start, REST_PERIODS, STROBE_TOLERANCE)?.0 == Some(4));
    let (holds, fails) =
        bracket(fold.value - 0.001, fold.value + 0.001, INTERVAL_WIDTH / 10.0, keeps)?;
    let mut claim = Claim::settle(
        &work.paper,
        ID,
        ClaimVerdict::new(printed.agrees(fold.value)),
        format!("period four ends in a fold at omega = {:.7}", fold.value),
    )?
    .evidence("continuation with multipliers", said(&fold))
    .evidence(
        format!("brute force: strobes after {REST_PERIODS} forcing periods"),
        format!("period 4 at omega = {holds:.6}, no longer at {fails:.6}"),
    );
    if let Some(omega) = between(printed, fold.value) {
        let (integrator, repeats) = integrated(omega, start, &[4])?;
        claim = claim
            .evidence(format!("{integrator}, at omega = {omega:.6}, between the two values"), repeats)
            .note(format!(
                "{:.1e} beyond the paper's approximate value, one unit of its last digit rounded as well as cut: \
                 between the two the orbit is still stable, with a small basin",
                fold.value - printed.value.unwrap_or(f64::NAN)
            ));
    }
    Ok(claim)
}

/// The attractors besides period four and the strangest one.
fn others(omega: f64) -> Result<Vec<Attractor>, Failure> {
    let mut all = found(omega)?;
    let strange = all
        .iter()
        .enumerate()
        .filter(|(_, it)| it.kind == AttractorKind::Chaotic)
        .max_by(|a, b| a.1.lyapunov_per_period.total_cmp(&b.1.lyapunov_per_period))
        .map(|(id, _)| id);
    if let Some(id) = strange {
        all.remove(id);
    }
    all.retain(|it| it.period() != Some(4));
    Ok(all)
}

/// Period twelve goes, and the attractor of the period-six cascade appears.
fn red(work: &ItemWork<'_>, cascade: &Bifurcation) -> Result<Claim, Failure> {
    let twelve = found(1.45)?;
    let twelve = of_period(&twelve, 12)?;
    let fold = first(BifurcationKind::Fold, twelve, 1.45, 1.56)?;
    let (there, gone) = bracket(1.56, 1.53, 1e-4, |omega| Ok(!others(omega)?.is_empty()))?;
    let seen = others(there)?;
    let seen: Vec<_> = seen.iter().map(described).collect();
    let holds = fold.value > 1.45 && fold.value < 1.56 && gone > 1.45 && there < 1.56;
    let computed = format!(
        "period twelve ends in a fold at omega = {:.7}; the cascade's attractor is there from {there:.4} on",
        fold.value
    );
    Ok(Claim::settle(&work.paper, "red-emerges", ClaimVerdict::new(holds), computed)?
        .note(format!(
            "it is born chaotic at its crisis and passes backwards through the cascade that ends at {:.7}; at 1.56 it is periodic",
            cascade.value
        ))
        .evidence("continuation of period twelve", said(&fold))
        .evidence("attractors reached from a grid of starts, by halving", format!("at {there:.5}: {}; none at {gone:.5}", seen.join("; "))))
}

/// Period five appears between 1.58 and 1.60.
fn five(work: &ItemWork<'_>) -> Result<Claim, Failure> {
    let attractors = found(1.6)?;
    let five = of_period(&attractors, 5)?;
    let flip = first(BifurcationKind::Flip, five, 1.6, 1.58)?;
    let fold = first(BifurcationKind::Fold, five, 1.6, 1.62)?;
    let start = five.points[0];
    let keeps =
        |omega: f64| Ok(settled(omega, start, REST_PERIODS, STROBE_TOLERANCE)?.0 == Some(5));
    let (holds_at, fails_at) = bracket(1.6, 1.59, INTERVAL_WIDTH, keeps)?;
    let holds = flip.value > 1.58 && flip.value < 1.6;
    let computed =
        format!("period five is stable from omega = {:.7} to {:.7}", flip.value, fold.value);
    Ok(Claim::settle(&work.paper, "five-emerges", ClaimVerdict::new(holds), computed)?
        .note("below it doubles; above it ends in a fold")
        .evidence("continuation with multipliers", format!("{}; {}", said(&flip), said(&fold)))
        .evidence(
            format!("brute force: strobes after {REST_PERIODS} forcing periods"),
            format!("period 5 at omega = {holds_at:.5}, no longer at {fails_at:.5}"),
        ))
}
