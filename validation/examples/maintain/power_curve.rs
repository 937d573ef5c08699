//! Draws the power of the judgement of records: `cargo maintain power-curve`.

use anyhow::Result;
use percuss_validation::case::{ClassBounds, defaults, embedded};
use percuss_validation::picture::{Axis, AxisScale, Colour, Curve, Curves, Marker, Stroke, svg};
use percuss_validation::power::{Variant, count_loosened, tallies, trials};
use percuss_validation::suite::{PreparedCase, prepare};
use percuss_validation::truth::Library;
use std::path::PathBuf;

const TOLERANCE: f64 = 1e-6;
/// Lateness in tolerances, and factors by which a tolerance is loosened.
const FAULT_SIZES: [f64; 7] = [1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0];
/// One event in so many is dropped.
const EVENTS_PER_DROPPED: [usize; 6] = [2, 5, 10, 20, 50, 100];

/// A kind of mistake by its size, and its colour and marker.
type Kind = (&'static str, fn(f64) -> Variant, Colour, Marker);

const KINDS: [Kind; 3] = [
    ("events late", Variant::Late, Colour(0, 114, 178), Marker::Circle),
    ("times alone late", Variant::TimesLate, Colour(213, 94, 0), Marker::Square),
    ("states off after events", Variant::Noise, Colour(0, 158, 115), Marker::Triangle),
];

/// Draw the share of wrong answers that are caught, and print its table
///
/// The answers are those of set-ups and cases that set no limit, at 1e-6. The picture's note has
/// the false alarms: right answers that are condemned.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The picture to write, an SVG
    output: PathBuf,
}

pub(crate) fn run(Arguments { output }: &Arguments) -> Result<()> {
    let prepared = prepare(embedded()?, &Library::embedded()?, None)?;
    let classes = defaults()?.classes;
    let of_size = |kind: &Kind| FAULT_SIZES.map(kind.1);
    let mut variants: Vec<Variant> = KINDS.iter().flat_map(of_size).collect();
    variants.extend(EVENTS_PER_DROPPED.map(Variant::Dropped));
    let made = trials(&prepared, TOLERANCE, &classes, &variants);
    let shares: Vec<f64> = tallies(&made, &variants)
        .iter()
        .map(|it| {
            println!("{:44} {:4} of {:4}", it.variant.words(), it.caught, it.spoiled);
            100.0 * it.caught as f64 / it.spoiled as f64
        })
        .collect();
    let mut curves: Vec<Curve> = KINDS
        .iter()
        .zip(shares.chunks(FAULT_SIZES.len()))
        .map(|((name, _, colour, marker), shares)| {
            curve(name, (*colour, *marker), FAULT_SIZES.iter().copied().zip(shares.iter().copied()))
        })
        .collect();
    curves.push(curve("tolerance loosened", LOOSE_STYLE, loosened_shares(&prepared, &classes)));
    let dropped = EVENTS_PER_DROPPED.map(|it| 100.0 / it as f64).into_iter();
    let dropped = dropped.zip(shares[KINDS.len() * FAULT_SIZES.len()..].iter().copied());
    curves.push(curve("events dropped, per cent", DROPPED_STYLE, dropped));
    let condemned = made.iter().filter(|it| it.is_condemned).count();
    let picture = Curves {
        title: "Wrong answers that are caught, by the size of the mistake".to_owned(),
        note: format!(
            "Answers of four set-ups at 1e-6 on 63 cases, none of which set a limit. Of {} right \
             answers {condemned} are condemned.",
            made.len()
        ),
        x: Axis {
            scale: AxisScale::Logarithmic,
            label: "tolerances, or times as loose, or per cent of the events".to_owned(),
        },
        y: Axis { scale: AxisScale::Linear, label: "caught, per cent".to_owned() },
        curves,
    };
    Ok(std::fs::write(output, svg(&picture))?)
}

const LOOSE_STYLE: (Colour, Marker) = (Colour(204, 121, 167), Marker::Diamond);
const DROPPED_STYLE: (Colour, Marker) = (Colour(60, 60, 60), Marker::Cross);

fn loosened_shares(
    cases: &[PreparedCase],
    classes: &[ClassBounds],
) -> impl Iterator<Item = (f64, f64)> {
    FAULT_SIZES.into_iter().map(|factor| {
        let (caught, all) = count_loosened(cases, (TOLERANCE, factor), classes);
        println!("tolerance loosened {factor} times {caught:4} of {all:4}");
        (factor, 100.0 * caught as f64 / all as f64)
    })
}

fn curve(
    name: &str,
    (colour, marker): (Colour, Marker),
    points: impl Iterator<Item = (f64, f64)>,
) -> Curve {
    Curve {
        name: name.to_owned(),
        colour,
        marker: Some(marker),
        width: 2.0,
        stroke: Stroke::Solid,
        points: points.collect(),
        apart: Vec::new(),
    }
}
