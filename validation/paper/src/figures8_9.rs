//! Figs. 8 and 9: the coexisting attractors at omega = 1.4 and omega = 1.6, one by one.

use super::attractors::{described, found, map, of_period, strange};
use super::claim::{Claim, ClaimVerdict};
use super::curve;
use super::item_work::{Findings, ItemWork};
use super::paper::attractors_model;
use crate::engine::Failure;
use crate::number::shortest;
use crate::picture::{Figure, INK, Layer, Plot, caption};
use percuss::dynamics::attractor::Attractor;
use percuss::dynamics::section::section;
use percuss::dynamics::strobe::StrobeMap;

/// Points of the strange attractors' sections.
const POINTS: u64 = 20_000;
const TRANSIENT: u64 = 200;
/// Points per forcing period of the phase planes.
const POINTS_PER_PERIOD: f64 = 200.0;

/// One of the two figures.
struct FigurePanel {
    id: &'static str,
    name: &'static str,
    omega: f64,
    periods: &'static [u32],
}

const FIGURES: [FigurePanel; 2] = [
    FigurePanel { id: "fig8", name: "figure-8", omega: 1.4, periods: &[4] },
    FigurePanel { id: "fig9", name: "figure-9", omega: 1.6, periods: &[5, 6] },
];

pub(super) fn run(work: &ItemWork<'_>) -> Result<Findings, Failure> {
    let mut findings = Findings::default();
    for figure in &FIGURES {
        let map = map(figure.omega)?;
        let attractors = found(figure.omega)?;
        let strange = strange(&attractors)?;
        let cloud = strange_section(&map, strange)?;
        let orbits: Result<Vec<_>, _> =
            figure.periods.iter().map(|period| of_period(&attractors, *period)).collect();
        let mut plots = Vec::new();
        for orbit in orbits? {
            plots.push(phase_plane(&map, orbit)?);
        }
        plots.push(section_plot(&cloud));
        findings.claims.push(settle(work, figure, &attractors)?);
        findings.picture(figure.name, &drawing(figure, plots))?;
        let row = |point: &[f64; 3]| point.iter().copied().map(shortest).collect();
        findings.csv(
            &format!("{}-strange", figure.name),
            &["p", "y", "q"],
            cloud.iter().map(row),
        )?;
        (work.step)();
    }
    Ok(findings)
}

fn settle(
    work: &ItemWork<'_>,
    figure: &FigurePanel,
    attractors: &[Attractor],
) -> Result<Claim, Failure> {
    let strange = strange(attractors)?;
    let said: Vec<_> = attractors.iter().map(described).collect();
    let mut periods: Vec<_> = attractors.iter().filter_map(Attractor::period).collect();
    periods.sort_unstable();
    let chaotic = strange.lyapunov_per_period > 4.0 * strange.lyapunov_error;
    let holds = periods == figure.periods && chaotic && attractors.len() == periods.len() + 1;
    Ok(Claim::settle(&work.paper, figure.id, ClaimVerdict::new(holds), said.join("; "))?
        .note("strobes at omega tau = 0; the attractors that a grid of starts reaches")
        .evidence("Newton on the exact strobe map, multipliers", said.join("; "))
        .evidence("picture", format!("{}.png", figure.name)))
}

/// The phase plane of an orbit, over its whole period.
fn phase_plane(map: &StrobeMap, attractor: &Attractor) -> Result<Plot, Failure> {
    let period = attractor.period().unwrap_or(1);
    let entry = map.entry(attractor.points[0]).map_err(Failure::new)?;
    let end = entry.instant.after_periods(u64::from(period), 1);
    let segments: Vec<_> = map.model().trajectory(entry).until(end).collect();
    let omega = map.model().parameters().omega;
    let pieces = curve::pieces(&segments, &end, omega, POINTS_PER_PERIOD);
    let mut layers = curve::lines(&pieces, |at| [at[1], at[2]]);
    let points = attractor.points.iter().map(|[p, y, _]| [*p, *y]).collect();
    layers.push(Layer::Dots { points, colour: INK, size: 3.5 });
    Ok(Plot {
        title: format!("period {period}"),
        axes: ["p".to_owned(), "y".to_owned()],
        window: None,
        layers,
    })
}

fn strange_section(map: &StrobeMap, strange: &Attractor) -> Result<Vec<[f64; 3]>, Failure> {
    let first = strange.points.first().ok_or_else(|| Failure::new("it has no points"))?;
    let entry = map.entry(*first).map_err(Failure::new)?;
    Ok(section(map.model(), entry, 0.0, TRANSIENT, POINTS).map(|it| it.point()).collect())
}

fn section_plot(points: &[[f64; 3]]) -> Plot {
    Plot {
        title: "strange attractor, Poincar\u{e9} section".to_owned(),
        axes: ["p".to_owned(), "y".to_owned()],
        window: None,
        layers: vec![Layer::Dots {
            points: points.iter().map(|[p, y, _]| [*p, *y]).collect(),
            colour: INK,
            size: 0.6,
        }],
    }
}

fn drawing(figure: &FigurePanel, plots: Vec<Plot>) -> Figure {
    Figure {
        title: format!("Fig. {}: coexisting attractors", figure.id.trim_start_matches("fig")),
        caption: format!(
            "{}. Phase planes over one whole period, with the strobes at \u{3c9}\u{3c4} = 0 (mod 2\u{3c0}) as squares: \
             blue dash-dotted without contact, orange in contact, purple in progression; section of {POINTS} points.",
            caption(&attractors_model(figure.omega))
        ),
        columns: plots.len(),
        panel: (760, 520),
        plots,
    }
}
