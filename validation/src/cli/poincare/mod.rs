//! `poincare`: a stroboscopic section, or of a SYSTEM any other, as a table, an array or a picture.

mod sinks;
mod system;

use super::help;
use super::note;
use super::shared::long_work::{self, Bar};
use super::shared::model::ModelFlags;
use super::shared::output::Opened;
use super::shared::outputs::{Outputs, OutputsFlags};
use super::shared::parse::{self, MAX_PERIODS, SectionChoice, Typed};
use super::shared::picture::{PictureFlags, PictureFormat};
use super::shared::progress::Progress;
use super::shared::section::{ReturnFlags, without_system};
use super::shared::system_choice::SystemChoice;
use super::shared::terminal::endless_notice;
use crate::case::Problem;
use crate::number::shortest;
use crate::picture::{self, Figure, Layer, Plot};
use anyhow::{Result, bail};
use clap::{ArgGroup, Args, ValueEnum};
use npyz::WriterBuilder;
use percuss::dynamics::section::Section;
use percuss::{Entry, Instant};
use sinks::{All, Collected, Lines, Point, Sink};
use std::io::Write;

/// Print the section of one motion: of the impact oscillator, or of a SYSTEM
///
/// Answers what a motion settles on: the state once a forcing period. A motion of
/// period k repeats k points, a quasi-periodic one draws a curve, a chaotic one a
/// strange attractor. A SYSTEM has sections at its events, too.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::POINCARE)]
#[command(group(ArgGroup::new("length").required(true).args(["periods", "returns"])))]
pub(super) struct Arguments {
    #[command(flatten)]
    system: SystemChoice,
    /// Forcing periods that are left out, with SYSTEM returns to the section
    #[arg(long, value_name = "M", value_parser = parse::whole::<u64>(0, MAX_PERIODS), allow_hyphen_values = true)]
    transient: u64,
    /// Points, one a forcing period, at least 1
    #[arg(long, value_name = "N", value_parser = parse::whole::<u64>(1, MAX_PERIODS), allow_hyphen_values = true)]
    periods: Option<u64>,
    /// With SYSTEM: points, one a return to the section, at least 1
    #[arg(long, value_name = "N", value_parser = parse::whole::<u64>(1, MAX_PERIODS), allow_hyphen_values = true)]
    returns: Option<u64>,
    /// Forcing angle omega tau mod 2 pi of the section, radians, --phi not included; with SYSTEM
    /// strobe[:ANGLE], or EVENT or EVENT@MODE, just after it [default: 0, or strobe:0]
    #[arg(long, value_name = "SECTION", value_parser = parse::section, allow_hyphen_values = true)]
    section: Option<Typed<SectionChoice>>,
    #[command(flatten)]
    section_of_system: ReturnFlags,
    #[command(flatten)]
    output: OutputsFlags<Format>,
    #[command(flatten)]
    picture: PictureFlags,
    #[command(flatten)]
    model: ModelFlags,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    Csv,
    Npy,
    Npz,
    Png,
    Svg,
}

/// A picture of more points shows no more.
const MAX_PICTURE_POINTS: u64 = 5_000_000;
/// An SVG of more points is not small.
const MAX_SVG_POINTS: u64 = 20_000;

/// Refuses a picture of more points than show anything, or than stay small.
fn check_size(outputs: &Outputs<Format>, flag: &str, count: u64) -> Result<()> {
    let is_picture = outputs.any(|it| PictureFormat::new(it).is_some());
    for (is_drawn, most, kind) in [
        (is_picture, MAX_PICTURE_POINTS, "a picture"),
        (outputs.any(|it| it == Format::Svg), MAX_SVG_POINTS, "svg"),
    ] {
        if is_drawn && count > most {
            bail!("{flag} {count} is not accepted for {kind}: at most {most}");
        }
    }
    Ok(())
}

/// Writes the section; whether the motion was decided to its end.
pub(super) fn run(arguments: &Arguments) -> Result<bool> {
    let outputs = arguments.output.outputs(|_| Format::Csv)?;
    arguments.picture.check(&outputs.pictures())?;
    match (arguments.system.chosen(&arguments.model)?, arguments.periods, arguments.returns) {
        (Some(_), Some(periods), _) => {
            bail!("--periods {periods} is not accepted with SYSTEM: --returns is")
        }
        (Some(chosen), None, returns) => {
            let count = returns.unwrap_or(1);
            check_size(&outputs, "--returns", count)?;
            system::run(arguments, &chosen, &outputs, count)
        }
        (None, Some(periods), _) => run_oscillator(arguments, &outputs, periods),
        (None, None, returns) => bail!("{}", without_system("--returns", &returns.unwrap_or(1))),
    }
}

fn run_oscillator(arguments: &Arguments, outputs: &Outputs<Format>, periods: u64) -> Result<bool> {
    arguments.section_of_system.refuse()?;
    arguments.picture.refuse_show()?;
    if outputs.any(|it| it == Format::Npz) {
        bail!("npz is not accepted without SYSTEM: csv, npy, png and svg are");
    }
    let angle = angle(arguments)?;
    let problem = arguments.model.problem()?;
    long_work::check_horizon(arguments.transient, periods)?;
    check_size(outputs, "--periods", periods)?;
    let bar = long_work::run_bar(outputs.is_terminal());
    let section = ShownSection::new(arguments.transient, angle, periods, &problem);
    let progress = section.progress(bar);
    let (mut last, mut count) = (problem.entry, 0);
    outputs.together(|opened| {
        let sinks = opened
            .iter_mut()
            .map(|(format, out)| sink(*format, out, arguments, &section, &problem));
        let mut all = All(sinks.collect::<Result<_>>()?);
        section.strobes(&progress).try_for_each(|strobe| {
            let point = Point { n: count, time: 0.0, mode: 0, state: &row(&strobe) };
            (last, count) = (strobe, count + 1);
            all.point(&point)
        })?;
        all.finish()
    })?;
    drop(progress);
    if count < periods {
        note(&undecidable(count));
        return Ok(false);
    }
    if let Some(endless) = Section::endless_at(&problem.model, &last) {
        note(&endless_notice(endless));
    }
    Ok(true)
}

/// The section's angle.
fn angle(arguments: &Arguments) -> Result<f64> {
    match &arguments.section {
        None => Ok(0.0),
        Some(Typed { value: SectionChoice::Angle(angle), .. }) => Ok(*angle),
        Some(section) => bail!(
            "--section {section} is not accepted without SYSTEM: accepted is a number, -1e15 to 1e15"
        ),
    }
}

/// What to say of a section that ends where rounding hides how a phase ends.
fn undecidable(points: u64) -> String {
    format!(
        "undecidable: rounding hides how a phase ends, the section ends after {points} points; \
         simulate with the same flags shows the phase"
    )
}

/// A run and the part of it whose stroboscopic section is shown.
struct ShownSection<'a> {
    problem: &'a Problem,
    first: Instant,
    end: Instant,
    angle: f64,
    count: u64,
}

impl<'a> ShownSection<'a> {
    fn new(transient: u64, angle: f64, count: u64, problem: &'a Problem) -> Self {
        let start = problem.entry.instant;
        let first = start.after_periods(transient, 1).first_at_angle(angle);
        Self { problem, first, end: first.after_periods(count, 1), angle, count }
    }

    /// Progress through the periods that are left out and those that are shown.
    fn progress(&self, bar: Option<Bar>) -> Progress {
        let omega = self.problem.model.parameters().omega;
        Progress::new(bar, omega, self.problem.entry.instant, &self.end)
    }

    fn strobes<'s>(&'s self, progress: &'s Progress) -> impl Iterator<Item = Entry> + 's {
        let Problem { model, entry, .. } = self.problem;
        let segments = model.trajectory(*entry).until(self.end);
        let segments = segments.inspect(|segment| progress.at(&segment.entry().instant));
        let strobes = (0..self.count).zip(Section::along(segments, self.first));
        strobes.map(|(_, strobe)| strobe).inspect(|strobe| progress.at(&strobe.instant))
    }
}

fn row(strobe: &Entry) -> [f64; 4] {
    let [p, y, q] = strobe.point();
    [p, y, q, strobe.v()]
}

/// An output of a section of the impact oscillator.
fn sink<'s>(
    format: Format,
    out: &'s mut Opened,
    arguments: &'s Arguments,
    section: &'s ShownSection<'s>,
    problem: &'s Problem,
) -> Result<Box<dyn Sink + 's>> {
    Ok(match PictureFormat::new(format) {
        Some(format) => Box::new(Collected {
            out,
            of: Box::new(|it| [it.state[0], it.state[1]]),
            points: Vec::new(),
            write: Box::new(move |points, out| {
                let figure = drawing(problem, section, arguments.transient, points);
                arguments.picture.write(figure, format, out)
            }),
        }),
        None if format == Format::Npy => Box::new(Rows::new(out, [section.count, 4])?),
        None => {
            writeln!(out, "n,p,y,q,v")?;
            Box::new(Lines { out, line: Box::new(line) })
        }
    })
}

fn line(point: &Point<'_>) -> String {
    let numbers = point.state.iter().map(|it| shortest(*it));
    std::iter::once(point.n.to_string()).chain(numbers).collect::<Vec<_>>().join(",")
}

/// An array whose shape is known before its rows are.
struct Rows<'a> {
    writer: Option<npyz::NpyWriter<f64, &'a mut Opened>>,
    written: u64,
    count: u64,
}

impl<'a> Rows<'a> {
    fn new(out: &'a mut Opened, shape: [u64; 2]) -> Result<Self> {
        let options = npyz::WriteOptions::<f64>::new().default_dtype().shape(&shape);
        let writer = Some(options.writer(out).begin_nd()?);
        Ok(Self { writer, written: 0, count: shape[0] })
    }
}

impl Sink for Rows<'_> {
    fn point(&mut self, point: &Point<'_>) -> Result<()> {
        self.written += 1;
        Ok(self.writer.iter_mut().try_for_each(|it| it.extend(point.state.iter().copied()))?)
    }

    fn finish(&mut self) -> Result<()> {
        // The shape stands at the beginning of the file.
        if self.written < self.count {
            bail!("{}; --format csv writes them", undecidable(self.written));
        }
        Ok(self.writer.take().map_or(Ok(()), npyz::NpyWriter::finish)?)
    }
}

fn drawing(
    problem: &Problem,
    section: &ShownSection<'_>,
    transient: u64,
    points: Vec<[f64; 2]>,
) -> Figure {
    let caption = format!(
        "{} points at \u{3c9}\u{3c4} mod 2\u{3c0} = {}, after {} forcing periods",
        section.count, section.angle, transient
    );
    let axes = ["p (displacement)".to_owned(), "y (velocity)".to_owned()];
    figure(picture::caption(problem.model.parameters()), caption, axes, points)
}

/// A picture of points of a section.
fn figure(title: String, caption: String, axes: [String; 2], points: Vec<[f64; 2]>) -> Figure {
    let layers = vec![Layer::cloud(points, picture::INK)];
    let plots = vec![Plot { title: String::new(), axes, window: None, layers }];
    Figure { title, caption, columns: 1, panel: (1200, 800), plots }
}
