//! Draws a drift map that `percuss sweep` has computed over omega and another parameter: the drift,
//! and the regime of each point. Drifts and chaos are what the verb `lyapunov` gives, periods are
//! those of the last strobes, which the verb `bifurcation` gives.

use anyhow::{Context, Result};
use npyz::NpyFile;
use percuss::{Parameter, Parameters};
use percuss_validation::picture::{
    self, Colour, Figure, KeyEntry, Layer, Plot, PlotWindow, Raster,
};
use std::fs::File;
use std::io::Read;
use std::path::PathBuf;
use zip::ZipArchive;

/// A positive exponent counts as chaos from so many standard errors on, as everywhere in percuss.
const MIN_STANDARD_ERRORS: f64 = percuss::dynamics::attractor::MIN_STANDARD_ERRORS;
/// A drift per period that is no larger is rounding: the slider does not move.
const DRIFT_TOLERANCE: f64 = 1e-12;
/// Strobes that are no farther apart are one point of an orbit.
const POINT_TOLERANCE: f64 = 1e-5;
/// The longest period with a colour of its own, which longer ones share.
const MAX_PERIOD: usize = 4;

/// What a motion does in the long run.
#[derive(Clone, Copy, PartialEq, Eq)]
enum DriftRegime {
    /// Neither progression nor chaos.
    Resting,
    /// Progression, with this period or, from [`MAX_PERIOD`] on, a longer one.
    Periodic(usize),
    Chaotic,
    /// A phase that never ends: the mass leaves or the slider never stops.
    Endless,
    /// The largest exponent is zero within its error.
    Undecided,
}

const REGIMES: [(DriftRegime, &str, Colour); 8] = [
    (DriftRegime::Resting, "no progression", Colour(222, 222, 222)),
    (DriftRegime::Periodic(1), "period 1", Colour(120, 185, 235)),
    (DriftRegime::Periodic(2), "period 2", Colour(20, 75, 150)),
    (DriftRegime::Periodic(3), "period 3", Colour(0, 158, 115)),
    (DriftRegime::Periodic(MAX_PERIOD), "period 4+", Colour(160, 20, 80)),
    (DriftRegime::Chaotic, "chaos", Colour(230, 120, 30)),
    (DriftRegime::Endless, "endless phase", Colour(20, 10, 40)),
    (DriftRegime::Undecided, "undecided", Colour(250, 236, 150)),
];

/// Colours of the drift: none, and five steps up to the largest.
const SHADES: [Colour; 6] = [
    Colour(222, 222, 222),
    Colour(253, 231, 150),
    Colour(122, 209, 81),
    Colour(34, 168, 132),
    Colour(42, 120, 142),
    Colour(68, 1, 84),
];

/// The arrays of a merged sweep.
struct MergedSweep(ZipArchive<File>);

impl MergedSweep {
    fn open(file: &str) -> Result<Self> {
        Ok(Self(ZipArchive::new(File::open(file).with_context(|| file.to_owned())?)?))
    }

    fn f8(&mut self, name: &str) -> Result<Vec<f64>> {
        self.array(name)
    }

    fn array<T: npyz::Deserialize>(&mut self, name: &str) -> Result<Vec<T>> {
        let mut bytes = Vec::new();
        let mut entry = self.0.by_name(&format!("{name}.npy")).context(name.to_owned())?;
        entry.read_to_end(&mut bytes)?;
        Ok(NpyFile::new(&bytes[..])?.into_vec()?)
    }
}

/// Draw a drift map of two merged sweeps, as docs/SWEEPS.md shows
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The merged file of a sweep of lyapunov
    sweep: String,
    /// The merged file of a sweep of bifurcation over the same points
    strobes: String,
    /// The parameter beside omega
    parameter: Parameter,
    /// The picture to write, a PNG
    output: PathBuf,
}

pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    let Arguments { sweep: file, strobes, parameter, output } = arguments;
    let parameter = *parameter;
    let mut sweep = MergedSweep::open(file)?;
    let (x, y) = (sweep.f8("omega")?, sweep.f8(parameter.as_str())?);
    let drift = sweep.f8("drift_per_period")?;
    let periods = periods(&mut MergedSweep::open(strobes)?, drift.len())?;
    let regimes = regimes(&mut sweep, &drift, &periods)?;
    // The quantiles of the drifts that are any, so that each shade fills as much of the picture.
    let mut some: Vec<f64> = drift.iter().copied().filter(|it| is_drift(*it)).collect();
    some.sort_by(f64::total_cmp);
    let steps: Vec<f64> = (0..=5).map(|k| some[k * (some.len() - 1) / 5]).collect();
    let shade = |drift: f64| match steps[1..5].iter().filter(|step| drift > **step).count() {
        step if is_drift(drift) => SHADES[step + 1],
        _ => SHADES[0],
    };
    let colour =
        |regime: DriftRegime| REGIMES.iter().find(|it| it.0 == regime).map_or(SHADES[0], |it| it.2);
    let names = (1..=5).map(|k| format!("up to {}", two_digits(steps[k])));
    let key = names.zip(&SHADES[1..]).map(|(name, colour)| entry(&name, *colour));
    let axes = [Parameter::Omega, parameter].map(|it| picture::symbol(it).to_owned());
    let fixed = picture::caption_without(&Parameters::default(), Some(parameter));
    let fixed = fixed.split(", ").filter(|it| !it.starts_with(&axes[0]));
    let fixed = fixed.collect::<Vec<_>>().join(", ");
    let plot = |title: &str, key: Vec<KeyEntry>, colours: Vec<Colour>| Plot {
        title: title.to_owned(),
        axes: axes.clone(),
        window: Some(window(&x, &y)),
        layers: vec![raster(&x, &y, &colours), Layer::Key(key)],
    };
    let known: Vec<KeyEntry> = REGIMES
        .iter()
        .filter(|it| regimes.contains(&it.0))
        .map(|(_, name, colour)| entry(name, *colour))
        .collect();
    let figure = Figure {
        title: format!("Drift per forcing period, and regime, over {} and {}", axes[0], axes[1]),
        caption: format!(
            "{} x {} motions from rest at the origin; {fixed}. Grey: no progression; chaos is \
             marked with it and without.",
            x.len(),
            y.len()
        ),
        columns: 1,
        panel: (1200, 620),
        plots: vec![
            plot("", key.collect(), drift.iter().map(|it| shade(*it)).collect()),
            plot("", known, regimes.iter().map(|it| colour(*it)).collect()),
        ],
    };
    Ok(std::fs::write(output, picture::png(&figure)?)?)
}

fn is_drift(drift: f64) -> bool {
    drift > DRIFT_TOLERANCE && drift.is_finite()
}

/// A number with two digits, as a key shows it.
fn two_digits(value: f64) -> String {
    let places = (1.0 - value.log10().floor()).max(0.0) as usize;
    format!("{value:.places$}")
}

fn entry(name: &str, colour: Colour) -> KeyEntry {
    KeyEntry { name: name.to_owned(), colour, stroke: None }
}

/// The least period of each motion's last strobes; more than half of them where they have none.
fn periods(sweep: &mut MergedSweep, motions: usize) -> Result<Vec<usize>> {
    let [p, y, q] = [sweep.f8("p")?, sweep.f8("y")?, sweep.f8("q")?];
    let strobes = p.len() / motions;
    let is_same = |i: usize, j: usize| {
        [&p, &y, &q].iter().all(|values| (values[i] - values[j]).abs() <= POINT_TOLERANCE)
    };
    let repeats = |first: usize, period: usize| {
        (first..first + strobes - period).all(|n| is_same(n, n + period))
    };
    let period = |motion: usize| {
        let mut all = 1..=strobes / 2;
        all.find(|period| repeats(motion * strobes, *period)).unwrap_or(strobes)
    };
    Ok((0..motions).map(period).collect())
}

fn regimes(sweep: &mut MergedSweep, drift: &[f64], periods: &[usize]) -> Result<Vec<DriftRegime>> {
    let exponents = sweep.f8("exponents_per_period")?;
    let errors = sweep.f8("standard_error")?;
    let endless: Vec<i32> = sweep.array("endless")?;
    let undecidable: Vec<i32> = sweep.array("undecidable")?;
    let regime = |at: usize| {
        let (largest, error) = (exponents[3 * at], errors[3 * at]);
        match endless[at] {
            // The mass never returns, or the slider never stops.
            0 | 1 => DriftRegime::Endless,
            _ if undecidable[at] != 0 => DriftRegime::Undecided,
            _ if largest > MIN_STANDARD_ERRORS * error => DriftRegime::Chaotic,
            _ if drift[at] <= DRIFT_TOLERANCE => DriftRegime::Resting,
            _ if largest > -MIN_STANDARD_ERRORS * error => DriftRegime::Undecided,
            _ => DriftRegime::Periodic(periods[at].min(MAX_PERIOD)),
        }
    };
    Ok((0..drift.len()).map(regime).collect())
}

/// Ranges that the cells fill: half a step beyond the first and last values.
fn window(x: &[f64], y: &[f64]) -> PlotWindow {
    [x, y].map(|axis| {
        let (from, to) = (axis[0], axis[axis.len() - 1]);
        let half = 0.5 * (to - from) / (axis.len() - 1) as f64;
        (from - half, to + half)
    })
}

fn raster(x: &[f64], y: &[f64], colours: &[Colour]) -> Layer {
    let row = |j: usize| (0..x.len()).map(|i| colours[i * y.len() + j]).collect();
    Layer::Raster(Raster { window: window(x, y), rows: (0..y.len()).map(row).collect() })
}
