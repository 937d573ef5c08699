//! Curves of errors that grow along chaotic runs: colours tell engines apart, strokes tolerances.

use super::ErrorGrowth;
use super::pictures::{GREY, Palette};
use super::setting::{setting, who};
use crate::picture::Colour;
use crate::picture::{Axis, AxisScale, Curve, Curves, Stroke};

const INK: Colour = Colour(20, 20, 20);

impl Palette {
    pub(super) fn growth(&self, case: &str, runs: &[&ErrorGrowth]) -> Curves {
        let tolerances = tolerances(runs);
        let points = |run: &ErrorGrowth, errors: &[f64]| {
            let points = run.periods.iter().copied().zip(errors.iter().copied());
            points.filter(|point| point.1 > 0.0).collect::<Vec<_>>()
        };
        let truth = |run: &&ErrorGrowth| Curve {
            name: String::new(),
            colour: GREY,
            marker: None,
            width: 1.5,
            stroke: Stroke::Solid,
            points: points(run, &run.truth_growth),
            apart: Vec::new(),
        };
        let error = |run: &&ErrorGrowth| Curve {
            name: who(&run.engine, &setting(run.tolerance, None)),
            colour: self.colour(&run.engine),
            width: 2.0,
            stroke: stroke(&tolerances, run.tolerance),
            points: points(run, &run.error),
            ..truth(run)
        };
        let mut curves: Vec<Curve> = runs.iter().map(truth).collect();
        if let Some(first) = curves.first_mut() {
            first.name = "growth of the truth".to_owned();
        }
        curves.extend(runs.iter().map(error));
        curves.extend(exponential(runs));
        Curves {
            note: String::new(),
            title: format!("Error growth in chaos: {case}"),
            x: Axis { label: "forcing periods".to_owned(), scale: AxisScale::Linear },
            y: Axis { label: "error of the state".to_owned(), scale: AxisScale::Logarithmic },
            curves,
        }
    }
}

/// The tolerances of some runs, from coarse to fine.
fn tolerances(runs: &[&ErrorGrowth]) -> Vec<f64> {
    let mut all: Vec<f64> = runs.iter().filter_map(|run| run.tolerance).collect();
    all.sort_by(|a, b| b.total_cmp(a));
    all.dedup();
    all
}

/// The finer a tolerance, the more of its line is drawn; without one the line is whole.
fn stroke(tolerances: &[f64], tolerance: Option<f64>) -> Stroke {
    const STROKES_FROM_COARSE: [Stroke; 3] = [Stroke::Dotted, Stroke::DashDotted, Stroke::Dashed];
    let place = tolerance.and_then(|it| tolerances.iter().position(|other| *other == it));
    place.map_or(Stroke::Solid, |place| STROKES_FROM_COARSE[place % STROKES_FROM_COARSE.len()])
}

/// The line exp(lambda t) from the smallest error there is, as far as it says anything.
fn exponential(runs: &[&ErrorGrowth]) -> Option<Curve> {
    let lambda = runs.iter().find_map(|run| run.lambda_per_period)?;
    let errors = runs.iter().flat_map(|run| &run.error).copied();
    let floor = errors.filter(|error| *error > 0.0 && error.is_finite()).min_by(f64::total_cmp)?;
    let end = runs.iter().flat_map(|run| &run.periods).copied().fold(0.0, f64::max);
    let last = end.min((1.0 / floor).ln().max(0.0) / lambda.max(1e-9));
    Some(Curve {
        name: format!("exp(\u{3bb}t), \u{3bb} = {lambda:.3}"),
        colour: INK,
        marker: None,
        width: 2.0,
        stroke: Stroke::Dotted,
        points: vec![(0.0, floor), (last, floor * (lambda * last).exp())],
        apart: Vec::new(),
    })
}
