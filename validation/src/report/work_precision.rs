//! Work-precision: what engines err at their settings against what it costs them.
//!
//! Points are joined only where they are of the same events: a run that misses some has only those
//! that it found to err in, which are the easier ones.

use super::pictures::Palette;
use super::summary::{EngineSummary, SettingSummary};
use super::{EngineEntry, Report};
use crate::picture::{Axis, AxisScale, Curve, Curves, Marker, Stroke};

/// The most hollow points that are named instead of counted.
const MAX_NAMED_POINTS: usize = 8;

/// An error that is shown: its words and its figure.
type Shown = (&'static str, fn(&SettingSummary) -> f64);

impl Palette {
    /// The pictures of errors of event times and of the state, with their files' names.
    pub(super) fn work_precision(
        &self,
        report: &Report,
        summaries: &[EngineSummary],
    ) -> Vec<(String, Curves)> {
        let note = note(report, summaries);
        let picture = |(name, shown): (&str, Shown)| {
            let (label, _) = shown;
            let engines = report.engines.iter().zip(summaries);
            let curves = Curves {
                title: format!("Work-precision, {label}: {}", cases(report)),
                note: note.clone(),
                x: logarithmic("right-hand sides (exact: closed-form evaluations)"),
                y: logarithmic(label),
                curves: engines.map(|it| self.work_curve(it, shown)).collect(),
            };
            (format!("work-precision-{name}"), curves)
        };
        let shown: [(&str, Shown); 2] = [
            ("event-time", ("error of event times", |it| it.time_error)),
            ("state", ("error of the state", |it| it.state_error)),
        ];
        shown.into_iter().map(picture).collect()
    }

    fn work_curve(
        &self,
        (engine, summary): (&EngineEntry, &EngineSummary),
        (_, figure): Shown,
    ) -> Curve {
        let points = |comparable: bool| {
            let own = summary.settings.iter().filter(|it| it.is_comparable == comparable);
            // On a logarithmic axis there is no work of nothing.
            own.map(|it| (it.rhs, figure(it))).filter(|it| it.0 > 0.0).collect()
        };
        Curve {
            name: engine.name.to_owned(),
            colour: self.colour(engine.name),
            marker: Some(self.look(engine.name).map_or(Marker::Circle, |look| look.marker)),
            width: 2.5,
            stroke: Stroke::Solid,
            points: points(true),
            apart: points(false),
        }
    }
}

/// The one case, or how many there are.
fn cases(report: &Report) -> String {
    match (report.number_of_cases(), report.results.first()) {
        (1, Some(row)) => row.case.clone(),
        (cases, _) => format!("median of {cases} cases"),
    }
}

fn logarithmic(label: &str) -> Axis {
    Axis { label: label.to_owned(), scale: AxisScale::Logarithmic }
}

/// The note on hollow points and on runs that count as infinitely wrong.
fn note(report: &Report, summaries: &[EngineSummary]) -> String {
    let one_case = report.number_of_cases() == 1;
    let of_engine = |(engine, summary): (&EngineEntry, &EngineSummary)| {
        let apart = summary.settings.iter().filter(|it| it.runs > 0 && !it.is_comparable);
        let name = engine.name;
        apart.map(|it| format!("{name} {} ({})", it.setting, it.of)).collect::<Vec<_>>()
    };
    let apart: Vec<_> = report.engines.iter().zip(summaries).flat_map(of_engine).collect();
    let why = match one_case {
        true => {
            "these runs have missed or spurious events, or are scored for a part of the events only"
        }
        false => "fewer than nine tenths of their rows were run",
    };
    let hollow = match apart.len() {
        0 => String::new(),
        1..=MAX_NAMED_POINTS => format!("Hollow, not joined: {why}: {}. ", apart.join(", ")),
        count => format!("Hollow, not joined, {count} points: {why}. "),
    };
    let infinite = match one_case {
        true => "",
        false => {
            "A run without a result, and for event times one that has a missed or a spurious event, \
             counts as infinitely wrong."
        }
    };
    hollow + infinite
}
