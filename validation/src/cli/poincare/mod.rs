//! `poincare`: a stroboscopic section, or of a SYSTEM any other, as a table, an array or a picture.

mod system;

use super::help;
use super::note;
use super::shared::format::OutputFlags;
use super::shared::long_work::{self, Bar};
use super::shared::model::ModelFlags;
use super::shared::parse::{self, MAX_PERIODS, SectionChoice, Typed};
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

/// Writes the section; whether the motion was decided to its end.
pub(super) fn run(arguments: &Arguments) -> Result<bool> {
    let format = arguments.output.format(Format::Csv)?;
    match (arguments.system.chosen(&arguments.model)?, arguments.periods, arguments.returns) {
        (Some(_), Some(periods), _) => {
            bail!("--periods {periods} is not accepted with SYSTEM: --returns is")
        }
        (Some(chosen), None, returns) => {
            let count = returns.unwrap_or(1);
            system::check_size(format, count)?;
            system::run(arguments, &chosen, format, count)
        }
        (None, Some(periods), _) => run_oscillator(arguments, format, periods),
        (None, None, returns) => bail!("{}", without_system("--returns", &returns.unwrap_or(1))),
    }
}

fn run_oscillator(arguments: &Arguments, format: Format, periods: u64) -> Result<bool> {
    arguments.section_of_system.refuse()?;
    let angle = angle(arguments)?;
    let problem = arguments.model.problem()?;
    long_work::check_horizon(arguments.transient, periods)?;
    if format == Format::Png && periods > MAX_PICTURE {
        bail!("--periods {periods} is not accepted for a picture: at most {MAX_PICTURE}");
    }
    let destination = arguments.output.destination();
    let bar = long_work::run_bar(destination.is_terminal());
    let section = ShownSection::new(arguments.transient, angle, periods, &problem);
    let progress = section.progress(bar);
    let (mut last, mut count) = (problem.entry, 0);
    let strobes = section.strobes(&progress).inspect(|strobe| (last, count) = (*strobe, count + 1));
    destination.write(|out| match format {
        Format::Csv => write_csv(strobes, out),
        Format::Npy => write_rows(strobes.map(|it| row(&it)), [periods, 4], undecidable, out),
        Format::Png => draw(strobes, &problem, &section, arguments.transient, out),
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

fn write_csv(strobes: impl Iterator<Item = Entry>, out: &mut dyn Write) -> Result<()> {
    writeln!(out, "n,p,y,q,v")?;
    for (n, strobe) in strobes.enumerate() {
        let [p, y, q, v] = row(&strobe).map(shortest);
        writeln!(out, "{n},{p},{y},{q},{v}")?;
    }
    Ok(())
}

/// Writes rows as an array of this shape; `cut` says why there are no more than a number of them.
fn write_rows(
    rows: impl Iterator<Item: IntoIterator<Item = f64>>,
    shape: [u64; 2],
    cut: impl FnOnce(u64) -> String,
    out: &mut dyn Write,
) -> Result<()> {
    let options = npyz::WriteOptions::<f64>::new().default_dtype().shape(&shape);
    let mut writer = options.writer(out).begin_nd()?;
    let mut written = 0;
    for row in rows {
        writer.extend(row)?;
        written += 1;
    }
    // The shape stands at the beginning of the file.
    if written < shape[0] {
        bail!("{}; --format csv writes them", cut(written));
    }
    Ok(writer.finish()?)
}

fn draw(
    strobes: impl Iterator<Item = Entry>,
    problem: &Problem,
    section: &ShownSection<'_>,
    transient: u64,
    out: &mut dyn Write,
) -> Result<()> {
    let points = strobes.map(|strobe| [strobe.state.p, strobe.state.y]).collect();
    let caption = format!(
        "{} points at \u{3c9}\u{3c4} mod 2\u{3c0} = {}, after {} forcing periods",
        section.count, section.angle, transient
    );
    let axes = ["p (displacement)".to_owned(), "y (velocity)".to_owned()];
    draw_points(picture::caption(problem.model.parameters()), caption, axes, points, out)
}

/// Writes a picture of points of a section.
fn draw_points(
    title: String,
    caption: String,
    axes: [String; 2],
    points: Vec<[f64; 2]>,
    out: &mut dyn Write,
) -> Result<()> {
    let layers = vec![Layer::cloud(points, picture::INK)];
    let plots = vec![Plot { title: String::new(), axes, window: None, layers }];
    let figure = Figure { title, caption, columns: 1, panel: (1200, 800), plots };
    Ok(out.write_all(&picture::png(&figure)?)?)
}
