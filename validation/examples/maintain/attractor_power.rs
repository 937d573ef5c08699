//! Measures what the same-attractor test notices: `cargo maintain attractor-power`.

use super::blocks;
use anyhow::{Context, Result};
use percuss_validation::case::{OscillatorCase, embedded};
use percuss_validation::number::brief;
use percuss_validation::picture::{
    Axis, AxisScale, Curve, Curves, Marker, Stroke, basin_colours, png,
};
use percuss_validation::score::attractor::{
    Alarms, AttractorTest, Calibrated, Changed, calibrated, interval,
};
use std::fmt::Write;
use std::path::PathBuf;

/// Runs a case from which the rate of false alarms is taken: none of the calibration.
const FRESH_RUNS: u32 = 2_000;
/// Runs from which one share of the power curve is taken.
const CHANGED_RUNS: u32 = 20;
/// Changes, relative to the parameter; each with both signs.
const RELATIVE_CHANGES: [f64; 8] = [1e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1];

const PICTURE: &str = "attractor-power.png";

/// Measure the same-attractor test's false alarms and power, into docs/ATTRACTOR_TEST.md
///
/// Without a page it prints the blocks. The picture lies beside the page, as attractor-power.png.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The page to write
    page: Option<PathBuf>,
}

pub(crate) fn run(Arguments { page }: &Arguments) -> Result<()> {
    let cases = ready()?;
    let power = power(&cases)?;
    let blocks = [("false alarms", false_alarms(&cases)?), ("power", power_table(&power))];
    let Some(page) = page else {
        blocks.iter().for_each(|(name, text)| println!("{name}\n\n{text}"));
        return Ok(());
    };
    std::fs::write(page.with_file_name(PICTURE), png(&picture(&power))?)?;
    blocks::replace(page, &blocks)
}

/// Every case that has limits, with its test.
fn ready() -> Result<Vec<(OscillatorCase, AttractorTest)>> {
    let cases = embedded()?;
    let of = |it: Calibrated| {
        let case = cases.iter().find(|case| case.name == it.case).context("no such case")?;
        let case = case.of_oscillator()?;
        Ok((case.clone(), AttractorTest::new(case, it)?))
    };
    calibrated()?.into_iter().map(of).collect()
}

fn percent(share: f64) -> String {
    format!("{} %", brief(100.0 * share))
}

fn false_alarms(cases: &[(OscillatorCase, AttractorTest)]) -> Result<String> {
    let mut table = String::from(
        "| case | fresh runs | false alarms | rate, with its exact 95 % interval | distances that alarmed |\n\
         |---|---|---|---|---|\n",
    );
    for (case, test) in cases {
        let found = test.false_alarms(case, FRESH_RUNS)?;
        let [low, high] = interval(found.raised, found.runs).map(percent);
        let names: Vec<_> = found.by.iter().map(|(name, n)| format!("`{name}` {n}")).collect();
        let rate = percent(f64::from(found.raised) / f64::from(found.runs));
        let (name, names) = (&test.calibrated.case, names.join(", "));
        writeln!(
            table,
            "| `{name}` | {} | {} | {rate} ({low} to {high}) | {names} |",
            found.runs, found.raised
        )?;
    }
    Ok(table)
}

/// The shares of one case, parameter and sign, along [`RELATIVE_CHANGES`].
struct PowerCurve {
    case: String,
    changed: Changed,
    sign: f64,
    steps: Vec<Alarms>,
}

fn power(cases: &[(OscillatorCase, AttractorTest)]) -> Result<Vec<PowerCurve>> {
    let mut curves = Vec::new();
    for (case, test) in cases {
        for (changed, sign) in Changed::ALL.into_iter().flat_map(|it| [(it, 1.0), (it, -1.0)]) {
            let step =
                |size: &f64| test.alarms_of_changed(case, changed, sign * size, CHANGED_RUNS);
            let steps = RELATIVE_CHANGES.iter().map(step).collect::<Result<_, _>>()?;
            curves.push(PowerCurve { case: test.calibrated.case.clone(), changed, sign, steps });
        }
    }
    Ok(curves)
}

fn power_table(power: &[PowerCurve]) -> String {
    let mut table = String::from("| case | change |");
    for size in RELATIVE_CHANGES {
        write!(table, " {} |", percent(size)).ok();
    }
    table += " notices first |\n|---|---|";
    table += &"---|".repeat(RELATIVE_CHANGES.len() + 1);
    table.push('\n');
    for curve in power {
        let sign = if curve.sign > 0.0 { '+' } else { '-' };
        write!(table, "| `{}` | {} {sign} |", curve.case, curve.changed.name()).ok();
        for step in &curve.steps {
            write!(
                table,
                " {}/{} |",
                hundredths(step.raised, step),
                hundredths(step.sampled, step)
            )
            .ok();
        }
        writeln!(table, " {} |", first(curve)).ok();
    }
    table
}

fn hundredths(count: u32, of: &Alarms) -> String {
    format!("{:.0}", 100.0 * f64::from(count) / f64::from(of.runs.max(1)))
}

/// The distances that notice at the smallest change of which half of the runs are caught.
fn first(curve: &PowerCurve) -> String {
    let caught =
        |count: fn(&Alarms) -> u32| curve.steps.iter().position(|it| 2 * count(it) >= it.runs);
    let named = |at: Option<usize>, sampled: bool| {
        let found =
            at.and_then(|at| Some((RELATIVE_CHANGES[at], curve.steps[at].first(sampled)?.0)));
        found.map_or("none".to_owned(), |(size, name)| format!("`{name}` at {}", percent(size)))
    };
    let all = named(caught(|it| it.raised), false);
    let sampled = named(caught(|it| it.sampled), true);
    if all == sampled { all } else { format!("{all}; of the section's: {sampled}") }
}

fn picture(power: &[PowerCurve]) -> Curves {
    const MARKERS: [Marker; 3] = [Marker::Circle, Marker::Square, Marker::Triangle];
    let mut curves = Vec::new();
    let rising = power.iter().filter(|curve| curve.sign > 0.0);
    for of in rising {
        let place = Changed::ALL.iter().position(|it| *it == of.changed).unwrap_or(0);
        let names = power.iter().filter(|it| it.sign > 0.0 && it.changed == of.changed);
        let row = names.take_while(|it| it.case != of.case).count();
        let points = |count: fn(&Alarms) -> u32| {
            let share = |it: &Alarms| 100.0 * f64::from(count(it)) / f64::from(it.runs.max(1));
            RELATIVE_CHANGES.into_iter().zip(of.steps.iter().map(share)).collect()
        };
        let curve = |name: String, dashed, points| Curve {
            name,
            colour: basin_colours(row).1,
            marker: Some(MARKERS[place % MARKERS.len()]),
            width: 2.0,
            stroke: if dashed { Stroke::Dashed } else { Stroke::Solid },
            points,
            apart: Vec::new(),
        };
        curves.push(curve(
            format!("{}, {}", of.changed.name(), of.case),
            false,
            points(|it| it.raised),
        ));
        curves.push(curve(String::new(), true, points(|it| it.sampled)));
    }
    Curves {
        note: String::new(),
        title: "Runs caught by the same-attractor test: solid with the errors of single periods, \
                dashed without"
            .to_owned(),
        x: Axis { label: "relative change (+)".to_owned(), scale: AxisScale::Logarithmic },
        y: Axis { label: "runs caught, %".to_owned(), scale: AxisScale::Linear },
        curves,
    }
}
