//! Beyond the paper, for users of a moling rig: the progression rate against the forcing frequency
//! and against the static force.

use super::item_work::{Findings, ItemWork};
use super::paper::chaotic_model;
use crate::engine::Failure;
use crate::number::shortest;
use crate::picture::Colour;
use crate::picture::{Figure, KeyEntry, Layer, Plot, caption_without};
use percuss::dynamics::diagram::{Diagram, DiagramStep, Follow};
use percuss::{Parameter, Parameters, Start};

const VALUES: u32 = 600;
const TRANSIENT: u64 = 600;
const PERIODS: u32 = 128;
/// Strobes that repeat so well belong to an orbit.
const STROBE_TOLERANCE: f64 = 1e-6;
/// The longest period that is told from chaos.
const MAX_PERIOD: usize = 32;

/// The kind of a motion, judged by its strobes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ProgressionRegime {
    Still,
    One,
    Two,
    Longer,
    Irregular,
}

const REGIMES: [(ProgressionRegime, &str, Colour); 5] = [
    (ProgressionRegime::Still, "no progression", Colour(150, 150, 150)),
    (ProgressionRegime::One, "period 1", Colour(0, 114, 178)),
    (ProgressionRegime::Two, "period 2", Colour(0, 158, 115)),
    (ProgressionRegime::Longer, "3 to 32", Colour(204, 121, 167)),
    (ProgressionRegime::Irregular, "irregular", Colour(213, 94, 0)),
];

/// A diagram of the rate.
struct Rate {
    name: &'static str,
    parameter: Parameter,
    range: (f64, f64),
    label: &'static str,
}

const RATES: [Rate; 2] = [
    Rate {
        name: "progression-omega",
        parameter: Parameter::Omega,
        range: (0.1, 3.0),
        label: "\u{3c9}",
    },
    Rate { name: "progression-b", parameter: Parameter::B, range: (0.01, 0.9), label: "b" },
];

pub(super) fn run(work: &ItemWork<'_>) -> Result<Findings, Failure> {
    let mut findings = Findings::default();
    for rate in &RATES {
        let steps = rate.steps()?;
        findings.picture(rate.name, &rate.drawing(&steps))?;
        let header = [rate.parameter.as_str(), "drift_per_period", "drift_per_time", "period"];
        let row = |step: &DiagramStep| {
            let period = period(step).map_or(String::new(), |period| period.to_string());
            let numbers = [step.value, step.drift_per_period, rate.per_time(step)];
            numbers.into_iter().map(shortest).chain([period]).collect()
        };
        findings.csv(rate.name, &header, steps.iter().map(row))?;
        (work.step)();
    }
    Ok(findings)
}

/// The least number of forcing periods after which the strobes repeat.
fn period(step: &DiagramStep) -> Option<usize> {
    let near = |a: &[f64; 3], b: &[f64; 3]| {
        (0..2).all(|i| (a[i] - b[i]).abs() <= STROBE_TOLERANCE * (1.0 + a[i].abs()))
    };
    let repeats = |k: &usize| step.points.iter().zip(&step.points[*k..]).all(|(a, b)| near(a, b));
    (1..=MAX_PERIOD.min(step.points.len().saturating_sub(1))).find(repeats)
}

fn regime(step: &DiagramStep) -> ProgressionRegime {
    match period(step) {
        _ if step.drift_per_period == 0.0 => ProgressionRegime::Still,
        Some(1) => ProgressionRegime::One,
        Some(2) => ProgressionRegime::Two,
        Some(_) => ProgressionRegime::Longer,
        None => ProgressionRegime::Irregular,
    }
}

impl Rate {
    /// Every value from rest, so that no value depends on another.
    fn steps(&self) -> Result<Vec<DiagramStep>, Failure> {
        let diagram = Diagram {
            parameters: chaotic_model(),
            start: Start::default(),
            parameter: self.parameter,
            from: self.range.0,
            to: self.range.1,
            steps: VALUES,
            transient: TRANSIENT,
            periods: PERIODS,
            follow: Follow::Reset,
        };
        diagram.steps(|_| {}).map_err(Failure::new)
    }

    fn per_time(&self, step: &DiagramStep) -> f64 {
        let Parameters { omega, .. } = self.parameter.set(chaotic_model(), step.value);
        step.drift_per_period * omega / std::f64::consts::TAU
    }

    fn drawing(&self, steps: &[DiagramStep]) -> Figure {
        let axis = |label: &str| [self.label.to_owned(), label.to_owned()];
        let dots = |of: &dyn Fn(&DiagramStep) -> Vec<[f64; 2]>, size: f64| -> Vec<Layer> {
            let layer = |(kind, _, colour): &(ProgressionRegime, &str, Colour)| Layer::Dots {
                points: steps.iter().filter(|step| regime(step) == *kind).flat_map(of).collect(),
                colour: *colour,
                size,
            };
            REGIMES.iter().map(layer).collect()
        };
        let mut rate = dots(&|step| vec![[step.value, self.per_time(step)]], 2.4);
        let key = |(_, name, colour): &(ProgressionRegime, &str, Colour)| KeyEntry {
            name: (*name).to_owned(),
            colour: *colour,
            stroke: None,
        };
        rate.push(Layer::Key(REGIMES.iter().take(3).map(key).collect()));
        let strobes =
            |step: &DiagramStep| step.points.iter().map(|it| [step.value, it[0]]).collect();
        let mut section = dots(&strobes, 0.7);
        section.push(Layer::Key(REGIMES.iter().skip(3).map(key).collect()));
        let plot = |axes: [String; 2], layers: Vec<Layer>| Plot {
            title: String::new(),
            axes,
            window: None,
            layers,
        };
        Figure {
            title: format!("Progression rate against {}", self.label),
            caption: format!(
                "{}; {} varied, from rest, {TRANSIENT} forcing periods left out, mean over {PERIODS}. Left: drift per unit of time; \
                 right: strobes at \u{3c9}\u{3c4} = 0 (mod 2\u{3c0}). Colours: period of the motion in forcing periods.",
                caption_without(&chaotic_model(), Some(self.parameter)),
                self.label
            ),
            columns: 2,
            panel: (760, 520),
            plots: vec![plot(axis("drift per unit of time"), rate), plot(axis("p"), section)],
        }
    }
}
