//! `attractors` and `basins`: where the starts of a grid lead.

mod draw;
pub(super) mod json;
mod npz;
pub(super) mod system;
mod table;

use super::help;
use super::shared::long_work;
use super::shared::model::ModelFlags;
use super::shared::output::{Destination, json as write_json};
use super::shared::outputs::{Outputs, OutputsFlags};
use super::shared::parse::{self, MAX_TRANSIENT_PERIODS};
use super::shared::picture::{PictureFormat, PrintFlags};
use super::shared::plane::plane;
use super::shared::section::{SectionFlags, without_system};
use super::shared::system_choice::SystemChoice;
use crate::case::Problem;
use anyhow::{Result, bail};
use clap::{Args, ValueEnum};
use percuss::System;
use percuss::affine::Plane;
use percuss::dynamics::attractor::{
    Basins, DEFAULT_MAX_PERIOD, Grid, SearchLimits, UnresolvedStart, Window,
};
use percuss::dynamics::strobe::StrobeMap;
use std::io::Write;
use std::path::PathBuf;

/// List the attractors that a grid of starts reaches
///
/// Answers which motions starts settle into, how large a share of them does, and
/// how fast each goes forward. Of a SYSTEM starts cover two of its states.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::ATTRACTORS)]
pub(super) struct AttractorArguments {
    #[command(flatten)]
    pub(super) system: SystemChoice,
    #[command(flatten)]
    pub(super) grid: GridFlags,
    #[command(flatten)]
    pub(super) section: SectionFlags,
    #[command(flatten)]
    output: OutputsFlags<AttractorFormat>,
    #[command(flatten)]
    pub(super) model: ModelFlags,
}

/// The output format of attractors: a table on a terminal, JSON elsewhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum AttractorFormat {
    Json,
    /// One line per attractor, for reading
    #[value(alias = "txt")]
    Table,
}

/// Draw basins of attraction: which start of a grid reaches which attractor
///
/// Answers which start leads where. The labels go to a picture or to arrays for
/// NumPy, and the attractors to stdout, as `percuss attractors` prints them.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::BASINS)]
pub(super) struct BasinArguments {
    #[command(flatten)]
    pub(super) system: SystemChoice,
    #[command(flatten)]
    pub(super) grid: GridFlags,
    #[command(flatten)]
    pub(super) section: SectionFlags,
    /// Where the labels go; its extension (npz, png, svg) is its format. Given again, the same
    /// labels go there, too
    #[arg(long, value_name = "FILE")]
    output: Vec<PathBuf>,
    #[command(flatten)]
    print: PrintFlags,
    /// npz, png or svg where --output has no extension; table or json for the attractors on stdout
    #[arg(long, value_enum)]
    format: Vec<BasinFormat>,
    #[command(flatten)]
    pub(super) model: ModelFlags,
}

/// The grid of starts and the time for which they are followed.
#[derive(Args, Clone, Debug)]
pub(super) struct GridFlags {
    /// With SYSTEM: the states across and up [default: its first two]
    #[arg(long, value_name = "NAME,NAME")]
    axes: Option<String>,
    /// Cells along p and along y, with SYSTEM across and up; starts are their centres
    #[arg(long, value_name = "NXxNY", value_parser = parse::grid)]
    grid: [u32; 2],
    /// Rectangle of p and y, with SYSTEM of its two states, that the cells cover
    #[arg(long, value_name = "pmin,pmax,ymin,ymax", value_parser = parse::window, allow_hyphen_values = true)]
    window: Window,
    /// Forcing periods, with SYSTEM returns, that a start is followed before it is examined;
    /// doubled up to three times where that does not settle it, and cut short as soon as it does
    #[arg(long, value_name = "M", value_parser = parse::whole::<u64>(1, MAX_TRANSIENT_PERIODS), allow_hyphen_values = true)]
    pub(super) transient: u64,
    /// Longest period of an orbit that is looked for, in forcing periods or returns, 1 to 10000
    #[arg(long, value_name = "K", value_parser = parse::period, allow_hyphen_values = true, default_value_t = DEFAULT_MAX_PERIOD)]
    max_period: u32,
}

/// The output format of labels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Labels {
    Npz,
    Png,
    Svg,
}

/// An SVG of more cells is not small.
const MAX_SVG_CELLS: u64 = 250_000;

/// What `basins --format` takes: one of the labels' formats, one of the attractors', or both.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum BasinFormat {
    Npz,
    Png,
    Svg,
    Json,
    Table,
}

impl BasinFormat {
    const fn of_labels(self) -> Option<Labels> {
        match self {
            Self::Npz => Some(Labels::Npz),
            Self::Png => Some(Labels::Png),
            Self::Svg => Some(Labels::Svg),
            Self::Json | Self::Table => None,
        }
    }

    const fn of_attractors(self) -> Option<AttractorFormat> {
        match self {
            Self::Json => Some(AttractorFormat::Json),
            Self::Table => Some(AttractorFormat::Table),
            Self::Npz | Self::Png | Self::Svg => None,
        }
    }
}

/// A surveyed grid.
pub(super) struct Survey {
    pub(super) problem: Problem,
    pub(super) limits: SearchLimits,
    pub(super) basins: Basins,
    pub(super) unresolved: Vec<UnresolvedStart>,
}

pub(super) fn attractors(arguments: &AttractorArguments, threads: Option<u16>) -> Result<()> {
    let outputs = arguments.output.outputs(default_format)?;
    let AttractorArguments { system, grid, section, model, .. } = arguments;
    if let Some(chosen) = system.chosen(model)? {
        let survey = system::Survey::new(&chosen, grid, section, threads)?;
        return outputs.each(|format, out| survey.show(format, out));
    }
    arguments.refuse_flags_of_system()?;
    let survey = arguments.grid.survey(&arguments.model, threads)?;
    outputs.each(|format, out| show(&survey, format, out))
}

pub(super) fn basins(arguments: &BasinArguments, threads: Option<u16>) -> Result<()> {
    let outputs = outputs_of_labels(arguments)?;
    let shown = only_format(&arguments.format, BasinFormat::of_attractors)?;
    let shown = shown.unwrap_or(default_format(&Destination::Stdout));
    let BasinArguments { system, grid, section, model, print, .. } = arguments;
    if let Some(chosen) = system.chosen(model)? {
        let survey = system::Survey::new(&chosen, grid, section, threads)?;
        outputs.each(|format, out| match PictureFormat::new(format) {
            None => Ok(out.write_all(&survey.npz()?)?),
            Some(format) => print.write(&survey.map(), format, out),
        })?;
        return Destination::Stdout.write(|out| survey.show(shown, out));
    }
    arguments.refuse_flags_of_system()?;
    let survey = arguments.grid.survey(&arguments.model, threads)?;
    outputs.each(|format, out| match PictureFormat::new(format) {
        None => Ok(out.write_all(&npz::bytes(&survey, &json::Json::new(&survey))?)?),
        Some(format) => print.write(&draw::map(&survey), format, out),
    })?;
    Destination::Stdout.write(|out| show(&survey, shown, out))
}

/// Where the labels go, at least one file.
fn outputs_of_labels(arguments: &BasinArguments) -> Result<Outputs<Labels>> {
    let paths = &arguments.output;
    if paths.is_empty() {
        bail!("--output is missing: accepted is a file that ends in .npz, .png or .svg");
    }
    if paths.iter().any(|it| it.as_os_str() == "-") {
        bail!(
            "--output - is not accepted: stdout is for the attractors; accepted is a file that \
             ends in .npz, .png or .svg"
        );
    }
    let labels = only_format(&arguments.format, BasinFormat::of_labels)?;
    let outputs = Outputs::new(paths, labels, |_| Labels::Npz)?;
    arguments.print.check(&outputs.pictures())?;
    let [columns, rows] = arguments.grid.grid;
    if outputs.any(|it| it == Labels::Svg) && u64::from(columns) * u64::from(rows) > MAX_SVG_CELLS {
        bail!("--grid {columns}x{rows} is not accepted for svg: at most {MAX_SVG_CELLS} cells are");
    }
    Ok(outputs)
}

/// The default format: a table on a terminal, JSON elsewhere.
fn default_format(destination: &Destination) -> AttractorFormat {
    if destination.is_terminal() { AttractorFormat::Table } else { AttractorFormat::Json }
}

/// The one format of a kind that was given, if any.
fn only_format<F>(
    given: &[BasinFormat],
    kind: impl Fn(BasinFormat) -> Option<F>,
) -> Result<Option<F>> {
    let mut of_kind = given.iter().filter_map(|it| kind(*it));
    let first = of_kind.next();
    if of_kind.next().is_some() {
        bail!("--format is given twice: accepted are one of npz, png, svg and one of json, table");
    }
    Ok(first)
}

fn show(survey: &Survey, shown: AttractorFormat, out: &mut dyn Write) -> Result<()> {
    match shown {
        AttractorFormat::Json => write_json(out, &json::Json::new(survey)),
        AttractorFormat::Table => Ok(out.write_all(table::text(survey).as_bytes())?),
    }
}

impl AttractorArguments {
    /// Refuses the flags of a system where none is chosen.
    pub(super) fn refuse_flags_of_system(&self) -> Result<()> {
        self.grid.check_without_system()?;
        self.section.refuse()
    }
}

impl BasinArguments {
    /// Refuses the flags of a system where none is chosen.
    pub(super) fn refuse_flags_of_system(&self) -> Result<()> {
        self.grid.check_without_system()?;
        self.section.refuse()
    }
}

impl GridFlags {
    /// Refuses what only a system's grid has: axes, and states of any size.
    fn check_without_system(&self) -> Result<()> {
        if let Some(axes) = &self.axes {
            bail!("{}", without_system("--axes", axes));
        }
        if self.window.check().is_err() {
            bail!("--window is accepted within 1e9 without SYSTEM");
        }
        Ok(())
    }

    /// The grid, with this displacement of the slider's top.
    pub(super) fn grid_of(&self, q: Option<f64>) -> Grid {
        let [columns, rows] = self.grid;
        Grid { window: self.window, columns, rows, q: q.unwrap_or(0.0) }
    }

    /// The grid in two states of a SYSTEM.
    pub(super) fn plane(&self, system: &System) -> Result<Plane> {
        plane(system, self.axes.as_deref(), self.grid, self.window)
    }

    fn survey(&self, model: &ModelFlags, threads: Option<u16>) -> Result<Survey> {
        let problem = model.problem_of_grid()?;
        model.note_replaced_by_grid();
        let map = StrobeMap::new(problem.model, problem.entry.instant);
        let grid = self.grid_of(problem.start.q);
        let bar = long_work::bar(grid.len() as u64, "starts");
        let seen = |count| bar.inc(count);
        let limits = self.limits();
        let basins = long_work::pool(threads)?.install(|| Basins::new(&map, &grid, limits, &seen));
        bar.finish_and_clear();
        Ok(Survey::new(problem, &map, limits, basins))
    }

    /// How long starts are followed, and how long orbits may be.
    pub(super) fn limits(&self) -> SearchLimits {
        SearchLimits { transient: self.transient, max_period: self.max_period }
    }
}

impl Survey {
    /// A surveyed grid, with some of the starts that were not recognised described.
    pub(super) fn new(
        problem: Problem,
        map: &StrobeMap,
        limits: SearchLimits,
        basins: Basins,
    ) -> Self {
        let unresolved = basins.unresolved_examples(map, limits);
        Self { problem, limits, basins, unresolved }
    }
}
