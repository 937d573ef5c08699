//! Draws a drift map that `percuss sweep` has computed with the verb `lyapunov` over omega and
//! another parameter: the drift, and the regime of each point.
//!
//! ```sh
//! percuss sweep run --plan docs/sweeps/omega-b.toml --out target/omega-b
//! percuss sweep merge --plan docs/sweeps/omega-b.toml --out target/omega-b \
//!     --output target/omega-b.npz
//! cargo run --release -p percuss-validation --example drift_map -- \
//!     target/omega-b.npz b docs/drift-omega-b.png
//! ```

use anyhow::{Context, Result};
use npyz::NpyFile;
use percuss::{Parameter, Parameters};
use percuss_validation::picture::{
    self, Colour, Figure, KeyEntry, Layer, Plot, PlotWindow, Raster,
};
use std::fs::File;
use std::io::Read;
use zip::ZipArchive;

/// A positive exponent counts as chaos from so many standard errors on, as everywhere in percuss.
const ERRORS: f64 = percuss::dynamics::attractor::ERRORS;
/// A drift per period that is no larger is rounding: the slider does not move.
const NO_DRIFT: f64 = 1e-12;

/// What a motion does in the long run.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Regime {
    Resting,
    Periodic,
    Chaotic,
    /// A phase that never ends: the mass leaves or the slider never stops.
    Endless,
    /// The largest exponent is zero within its error.
    Undecided,
}

const REGIMES: [(Regime, &str, Colour); 5] = [
    (Regime::Resting, "no progression, no chaos", Colour(222, 222, 222)),
    (Regime::Periodic, "progression, periodic", Colour(95, 165, 225)),
    (Regime::Chaotic, "chaos", Colour(230, 120, 30)),
    (Regime::Endless, "endless phase", Colour(120, 30, 90)),
    (Regime::Undecided, "undecided", Colour(250, 236, 150)),
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
struct Sweep(ZipArchive<File>);

impl Sweep {
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

fn main() -> Result<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [file, other, output] = &words[..] else {
        anyhow::bail!("three arguments: the merged file, the second parameter, the picture");
    };
    let parameter: Parameter = other.parse()?;
    let mut sweep = Sweep(ZipArchive::new(File::open(file)?)?);
    let (x, y) = (sweep.f8("omega")?, sweep.f8(other)?);
    let drift = sweep.f8("drift_per_period")?;
    let regimes = regimes(&mut sweep, &drift)?;
    // The quantiles of the drifts that are any, so that each shade fills as much of the picture.
    let mut some: Vec<f64> = drift.iter().copied().filter(|it| is_drift(*it)).collect();
    some.sort_by(f64::total_cmp);
    let steps: Vec<f64> = (0..=5).map(|k| some[k * (some.len() - 1) / 5]).collect();
    let shade = |drift: f64| match steps[1..5].iter().filter(|step| drift > **step).count() {
        step if is_drift(drift) => SHADES[step + 1],
        _ => SHADES[0],
    };
    let colour =
        |regime: Regime| REGIMES.iter().find(|it| it.0 == regime).map_or(SHADES[0], |it| it.2);
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
            "{} x {} motions from rest at the origin; {fixed}. Grey above: no progression.",
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
    drift > NO_DRIFT && drift.is_finite()
}

/// A number with two digits, as a key shows it.
fn two_digits(value: f64) -> String {
    let places = (1.0 - value.log10().floor()).max(0.0) as usize;
    format!("{value:.places$}")
}

fn entry(name: &str, colour: Colour) -> KeyEntry {
    KeyEntry { name: name.to_owned(), colour, stroke: None }
}

fn regimes(sweep: &mut Sweep, drift: &[f64]) -> Result<Vec<Regime>> {
    let exponents = sweep.f8("exponents_per_period")?;
    let errors = sweep.f8("standard_error")?;
    let endless: Vec<i32> = sweep.array("endless")?;
    let undecidable: Vec<i32> = sweep.array("undecidable")?;
    let regime = |at: usize| {
        let (largest, error) = (exponents[3 * at], errors[3 * at]);
        match endless[at] {
            // The mass never returns, or the slider never stops.
            0 | 1 => Regime::Endless,
            _ if undecidable[at] != 0 => Regime::Undecided,
            _ if largest > ERRORS * error => Regime::Chaotic,
            _ if drift[at] <= NO_DRIFT => Regime::Resting,
            _ if largest > -ERRORS * error => Regime::Undecided,
            _ => Regime::Periodic,
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
