//! The pictures beside the report, each as PNG and, where it stays small, as SVG.

use super::grazing::{Grazing, Seen};
use super::setting::{setting, who};
use super::summary::{self, EngineSummary, SettingSummary};
use super::{Report, ReportEvidence, RestartHistogram, SectionPair};
use crate::number::brief;
use crate::picture::Colour;
use crate::picture::{
    self, DrawError, Drawing, Encounter, Figure, HeatCell, HeatMap, HistogramRow, Histograms,
    Layer, Look, Plot, Tint, looks, png, svg,
};
use percuss::Phase;
use rayon::prelude::*;

/// The most points of two clouds together in an SVG.
const MAX_SVG_POINTS: usize = 6000;
/// Wrong events are drawn one by one where at most this many cases are chosen.
const MAX_DRAWN_CASES: usize = 3;
pub(super) const GREY: Colour = Colour(150, 150, 150);

/// A picture's file name and bytes.
pub type PictureFile = (String, Vec<u8>);

/// All pictures that there are data for.
///
/// # Errors
/// [`DrawError`] with the drawing library's reason.
pub fn pictures(report: &Report, evidence: &ReportEvidence) -> Result<Vec<PictureFile>, DrawError> {
    let palette = Palette::new(report, evidence);
    let summaries = summary::engines(report);
    let mut curves = palette.work_precision(report, &summaries);
    curves.extend(
        by_case(&evidence.growth, |it| &it.case)
            .map(|(case, runs)| (format!("error-growth-{case}"), palette.growth(case, &runs))),
    );
    let mut heat_maps = vec![("recall".to_owned(), recall(report, &summaries))];
    let grazing = Grazing::new(report, evidence);
    if !grazing.lines.is_empty() {
        heat_maps.push(("grazing".to_owned(), touches(grazing)));
    }
    let histograms: Vec<_> = by_case(&evidence.restarts, |it| &it.case)
        .flat_map(|(case, runs)| palette.restarts(case, &runs))
        .collect();
    let clouds: Vec<_> = evidence.sections.iter().enumerate().map(attractors).collect();
    let events: Vec<_> = events(report, evidence, &palette).collect();
    let drawn = [
        draw_all(&events, |_| true)?,
        draw_all(&curves, |_| true)?,
        draw_all(&heat_maps, |_| true)?,
        draw_all(&histograms, |_| true)?,
        draw_all(&clouds, |it| it.points() <= MAX_SVG_POINTS)?,
    ];
    Ok(drawn.into_iter().flatten().collect())
}

/// A picture of each wrong event, where few cases are chosen: of all there would be too many.
fn events<'a>(
    report: &Report,
    evidence: &'a ReportEvidence,
    palette: &'a Palette,
) -> impl Iterator<Item = (String, Encounter)> + 'a {
    let cases = report.results.chunk_by(|a, b| a.case == b.case).count();
    let shown = evidence.events.iter().filter(move |_| cases <= MAX_DRAWN_CASES);
    shown.map(|it| (it.file_name(), it.encounter(palette.colour(&it.engine))))
}

fn draw_all<D: Drawing + Sync>(
    drawings: &[(String, D)],
    small: impl Fn(&D) -> bool + Sync,
) -> Result<Vec<PictureFile>, DrawError> {
    let both = |(name, drawing): &(String, D)| {
        let mut files = vec![(format!("{name}.png"), png(drawing)?)];
        if small(drawing) {
            files.push((format!("{name}.svg"), svg(drawing).into_bytes()));
        }
        Ok(files)
    };
    let files: Result<Vec<_>, DrawError> = drawings.par_iter().map(both).collect();
    Ok(files?.into_iter().flatten().collect())
}

/// The items of each case, in the order of their first appearance.
fn by_case<T>(all: &[T], case: fn(&T) -> &String) -> impl Iterator<Item = (&str, Vec<&T>)> {
    let mut names: Vec<&str> = Vec::new();
    for it in all {
        if !names.contains(&case(it).as_str()) {
            names.push(case(it));
        }
    }
    names.into_iter().map(move |name| (name, all.iter().filter(|it| case(it) == name).collect()))
}

/// Engines' looks by name.
pub(super) struct Palette {
    looks: Vec<(String, Look)>,
}

impl Palette {
    /// The looks of the engines of the report, and of those that only the evidence knows.
    fn new(report: &Report, evidence: &ReportEvidence) -> Self {
        let mut names: Vec<(&str, &str)> =
            report.engines.iter().map(|it| (it.name, it.library)).collect();
        let growth = evidence.growth.iter().map(|it| it.engine.as_str());
        for name in growth.chain(evidence.restarts.iter().map(|it| it.engine.as_str())) {
            if names.iter().all(|(known, _)| *known != name) {
                names.push((name, ""));
            }
        }
        let looks = names.iter().zip(looks(&names));
        Self { looks: looks.map(|((name, _), look)| ((*name).to_owned(), look)).collect() }
    }

    pub(super) fn colour(&self, engine: &str) -> Colour {
        self.look(engine).map_or(GREY, |look| look.light)
    }

    pub(super) fn look(&self, engine: &str) -> Option<&Look> {
        self.looks.iter().find(|(name, _)| name == engine).map(|(_, look)| look)
    }

    /// One picture per unit: errors in different units share no axis.
    fn restarts(&self, case: &str, runs: &[&RestartHistogram]) -> Vec<(String, Histograms)> {
        let mut units: Vec<&str> = Vec::new();
        for run in runs {
            if !units.contains(&run.unit.as_str()) {
                units.push(&run.unit);
            }
        }
        let row = |run: &&&RestartHistogram| HistogramRow {
            name: who(&run.engine, &setting(run.tolerance, None)),
            colour: self.colour(&run.engine),
            edges: run.edges.clone(),
            counts: run.counts.clone(),
        };
        let picture = |(i, unit): (usize, &&str)| {
            let suffix = if i == 0 { String::new() } else { format!("-{}", i + 1) };
            let chosen = runs.iter().filter(|run| run.unit == **unit);
            let histograms = Histograms {
                title: format!("Errors after one impact and separation: {case}"),
                label: format!("error in units of {unit}"),
                rows: chosen.collect::<Vec<_>>().iter().map(row).collect(),
            };
            (format!("restart-errors-{case}{suffix}"), histograms)
        };
        units.iter().enumerate().map(picture).collect()
    }
}

fn recall(report: &Report, summaries: &[EngineSummary]) -> HeatMap {
    let tile = |it: &SettingSummary| {
        let tint = match it.recall() {
            share if share.is_nan() => Tint::None,
            share if share < 0.99 => Tint::Bad,
            share if share < 1.0 => Tint::Poor,
            _ if it.spurious > 0 || it.failed > 0 => Tint::Fair,
            _ => Tint::Good,
        };
        let found = format!("{}/{}/{}", it.matched, it.expected, it.total);
        let of = if it.setting.is_empty() { String::new() } else { format!("{}: ", it.setting) };
        HeatCell { text: of + &found, tint }
    };
    let row = |(engine, summary): (&super::EngineEntry, &EngineSummary)| {
        (engine.name.to_owned(), summary.settings.iter().map(tile).collect())
    };
    HeatMap {
        title: "Recall: events found of checked of all".to_owned(),
        note: "settings from coarse to fine; blue: some spurious, or runs without a result"
            .to_owned(),
        columns: Vec::new(),
        rows: report.engines.iter().zip(summaries).map(row).collect(),
    }
}

fn touches(grazing: Grazing) -> HeatMap {
    let tile = |cell: Vec<(String, Seen)>| {
        let sign = |(_, seen): &(String, Seen)| match seen {
            Seen::Right => '\u{25cf}',
            Seen::Missed => '\u{25cb}',
            Seen::Spurious => '\u{d7}',
            Seen::Undecidable => '\u{25d0}',
            Seen::Nothing => '\u{2013}',
        };
        let right = cell.iter().filter(|(_, seen)| *seen == Seen::Right).count();
        let tint = match right {
            _ if cell.is_empty() => Tint::None,
            right if right == cell.len() => Tint::Good,
            0 => Tint::Bad,
            _ => Tint::Poor,
        };
        HeatCell { text: cell.iter().map(sign).collect(), tint }
    };
    let row =
        |(engine, cells): (String, Vec<Vec<_>>)| (engine, cells.into_iter().map(tile).collect());
    HeatMap {
        title: "Grazing: how far the mass stays short of the slider (\u{2212}) or reaches beyond it (+)"
            .to_owned(),
        note: "settings from coarse to fine; \u{25cf} right, \u{25cb} missed, \u{d7} spurious, \u{25d0} undecidable, \u{2013} no result"
            .to_owned(),
        columns: grazing.margins.into_iter().map(|(_, label)| label).collect(),
        rows: grazing.lines.into_iter().map(row).collect(),
    }
}

fn attractors((i, pair): (usize, &SectionPair)) -> (String, Figure) {
    let told = |(name, value, limit): &(String, f64, f64)| {
        format!("{name} {} (limit {})", brief(*value), brief(*limit))
    };
    let plot = |name: &str, points: &[[f64; 2]], colour| Plot {
        title: format!("{name}, {} points", points.len()),
        axes: ["p".to_owned(), "y".to_owned()],
        window: None,
        layers: vec![Layer::cloud(points.to_vec(), colour)],
    };
    let figure = Figure {
        title: format!("Attractors at \u{3c9} = {}, \u{3be} = {}", pair.omega, pair.xi),
        caption: pair.distances.iter().map(told).collect::<Vec<_>>().join("; "),
        columns: 2,
        panel: (750, 640),
        plots: vec![
            plot("exact", &pair.exact, picture::INK),
            plot(&pair.direct_engine, &pair.direct, picture::phase_colour(Phase::NoContact)),
        ],
    };
    (format!("attractors-{}", i + 1), figure.on_the_same_axes())
}
