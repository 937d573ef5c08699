//! `poincare`: a stroboscopic section, as a table, an array or a picture.

use super::endless::notice;
use super::format::OutputFlags;
use super::model::ModelFlags;
use super::{parse, say, work};
use crate::case::Problem;
use crate::number::shortest;
use crate::picture::{self, Layer, Plot, Sheet};
use anyhow::{Result, bail};
use clap::{Args, ValueEnum};
use npyz::WriterBuilder;
use percuss::Entry;
use percuss::dynamics::section::{Section, section};
use std::io::Write;

/// Stroboscopic section of one motion
#[derive(Args)]
pub(super) struct Arguments {
    /// Forcing periods that are left out
    #[arg(long, value_name = "M")]
    transient: u64,
    /// Points, one a forcing period, at least 1
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    periods: u64,
    /// Forcing angle omega tau mod 2 pi of the section, radians, --phi not included
    #[arg(long, value_name = "ANGLE", default_value_t = 0.0, value_parser = parse::angle, allow_hyphen_values = true)]
    section: f64,
    #[command(flatten)]
    output: OutputFlags<Format>,
    #[command(flatten)]
    model: ModelFlags,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    Csv,
    Npy,
    Png,
}

/// A picture of more points shows no more.
const MAX_PICTURE: u64 = 5_000_000;

pub(super) fn run(arguments: &Arguments) -> Result<()> {
    let format = arguments.output.format(Format::Csv)?;
    let problem = arguments.model.problem()?;
    work::check_horizon(arguments.transient, arguments.periods)?;
    if format == Format::Png && arguments.periods > MAX_PICTURE {
        bail!(
            "--periods {} is not accepted for a picture: at most {MAX_PICTURE}",
            arguments.periods
        );
    }
    let bar = work::bar(arguments.periods, "points");
    let mut last = problem.entry;
    let strobes = section(
        &problem.model,
        problem.entry,
        arguments.section,
        arguments.transient,
        arguments.periods,
    )
    .inspect(|strobe| {
        last = *strobe;
        bar.inc(1);
    });
    arguments.output.destination().write(|out| match format {
        Format::Csv => write_csv(strobes, out),
        Format::Npy => write_npy(strobes, arguments.periods, out),
        Format::Png => draw(strobes, &problem, arguments, out),
    })?;
    bar.finish_and_clear();
    if let Some(endless) = Section::endless_at(&problem.model, &last) {
        say(&notice(endless));
    }
    Ok(())
}

fn row(strobe: &Entry) -> [f64; 4] {
    let [p, y, q] = strobe.point();
    [p, y, q, strobe.v()]
}

fn write_csv(strobes: impl Iterator<Item = Entry>, out: &mut dyn Write) -> Result<()> {
    writeln!(out, "n,p,y,q,v")?;
    for (n, strobe) in strobes.enumerate() {
        let [p, y, q, v] = row(&strobe).map(shortest);
        writeln!(out, "{n},{p},{y},{q},{v}")?;
    }
    Ok(())
}

fn write_npy(strobes: impl Iterator<Item = Entry>, count: u64, out: &mut dyn Write) -> Result<()> {
    let options = npyz::WriteOptions::<f64>::new().default_dtype().shape(&[count, 4]);
    let mut writer = options.writer(out).begin_nd()?;
    for strobe in strobes {
        writer.extend(row(&strobe))?;
    }
    Ok(writer.finish()?)
}

fn draw(
    strobes: impl Iterator<Item = Entry>,
    problem: &Problem,
    arguments: &Arguments,
    out: &mut dyn Write,
) -> Result<()> {
    let points = strobes.map(|strobe| [strobe.state.p, strobe.state.y]).collect();
    let sheet = Sheet {
        title: picture::caption(problem.model.parameters()),
        caption: format!(
            "{} points at \u{3c9}\u{3c4} mod 2\u{3c0} = {}, after {} forcing periods",
            arguments.periods, arguments.section, arguments.transient
        ),
        columns: 1,
        panel: (1200, 800),
        plots: vec![Plot {
            title: String::new(),
            axes: ["p (displacement)".to_owned(), "y (velocity)".to_owned()],
            window: None,
            layers: vec![Layer::cloud(points, picture::INK)],
        }],
    };
    Ok(out.write_all(&picture::png(&sheet)?)?)
}
