//! `orbit`: periodic orbits, by Newton's method.

mod of_system;

use super::super::help;
use super::json::{OrbitJson, OrbitsJson};
use super::table;
use crate::cli::shared::long_work;
use crate::cli::shared::model::ModelFlags;
use crate::cli::shared::output::{Destination, json};
use crate::cli::shared::outputs::OutputsFlags;
use crate::cli::shared::parse::{self, MAX_PERIODS};
use crate::cli::shared::section::{SectionFlags, without_system};
use crate::cli::shared::system_choice::SystemChoice;
use crate::cli::{DONE, OUT_OF_BOUNDS, note, say};
use anyhow::{Result, bail};
use clap::{Args, ValueEnum};
use percuss::dynamics::attractor::Window;
use percuss::dynamics::orbit::{Orbit, scan};
use percuss::dynamics::strobe::StrobeMap;

/// Find periodic orbits, stable or not, from a guess, a scan of starts, or the start of a SYSTEM
///
/// Answers which motions repeat after K forcing periods, or after K returns to a
/// section of a SYSTEM, and whether they are stable.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::ORBIT)]
pub(crate) struct Arguments {
    #[command(flatten)]
    system: SystemChoice,
    /// Forcing periods of the orbit, with SYSTEM returns to the section; one that closes after a
    /// divisor is reported with that
    #[arg(long, value_name = "K", value_parser = parse::period, allow_hyphen_values = true)]
    period: u32,
    /// With SYSTEM: returns after which the motion from the start is the guess [default: 0]
    #[arg(long, value_name = "N", value_parser = parse::whole::<u64>(0, MAX_PERIODS), allow_hyphen_values = true)]
    transient: Option<u64>,
    #[command(flatten)]
    section: SectionFlags,
    /// Prints all orbits that the scan finds, not the first alone; a table prints them all anyway.
    /// With SYSTEM: those that are reached from a --grid of starts
    #[arg(long)]
    all: bool,
    #[command(flatten)]
    starts: StartGridFlags,
    #[command(flatten)]
    output: OutputsFlags<OrbitFormat>,
    #[command(flatten)]
    model: ModelFlags,
}

/// The grid of starts of a SYSTEM that a scan begins at.
#[derive(Args, Clone, Debug)]
struct StartGridFlags {
    /// With SYSTEM and --all: the states across and up [default: its first two]
    #[arg(long, value_name = "NAME,NAME")]
    axes: Option<String>,
    /// With SYSTEM and --all: cells across and up; starts are their centres
    #[arg(long, value_name = "NXxNY", value_parser = parse::grid)]
    grid: Option<[u32; 2]>,
    /// With SYSTEM and --all: rectangle of the two states that the cells cover
    #[arg(long, value_name = "pmin,pmax,ymin,ymax", value_parser = parse::window, allow_hyphen_values = true)]
    window: Option<Window>,
}

impl StartGridFlags {
    /// A flag that is given, and its value.
    fn given_flag(&self) -> Option<(&'static str, String)> {
        let axes = self.axes.clone().map(|it| ("--axes", it));
        let grid = self.grid.map(|[across, up]| ("--grid", format!("{across}x{up}")));
        let window = self.window.map(|Window { p: [left, right], y: [low, high] }| {
            ("--window", format!("{left},{right},{low},{high}"))
        });
        axes.or(grid).or(window)
    }

    fn refuse_without_system(&self) -> Result<()> {
        self.given_flag().map_or(Ok(()), |(flag, value)| bail!("{}", without_system(flag, &value)))
    }

    fn refuse_without_all(&self) -> Result<()> {
        self.given_flag().map_or(Ok(()), |(flag, value)| {
            bail!("{flag} {value} is not accepted without --all, which scans a grid of starts")
        })
    }
}

/// The output format of orbits: a table on a terminal, JSON elsewhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum OrbitFormat {
    Json,
    /// One line per orbit, for reading
    #[value(alias = "txt")]
    Table,
}

/// The default format: a table on a terminal, JSON elsewhere.
fn default_format(destination: &Destination) -> OrbitFormat {
    if destination.is_terminal() { OrbitFormat::Table } else { OrbitFormat::Json }
}

pub(crate) fn run(arguments: &Arguments, threads: Option<u16>) -> Result<u8> {
    let outputs = arguments.output.outputs(default_format)?;
    if let Some(chosen) = arguments.system.chosen(&arguments.model)? {
        return of_system::run(arguments, &chosen, &outputs, threads);
    }
    arguments.starts.refuse_without_system()?;
    arguments.section.refuse()?;
    if let Some(transient) = arguments.transient {
        bail!("{}", without_system("--transient", &transient));
    }
    let (problem, guessed) = arguments.model.guess(None)?;
    if guessed && arguments.all {
        bail!(
            "--all has no effect with a guess, which leads to one orbit; it is accepted without --p, --y, --q, --phase and [start]"
        );
    }
    let map = StrobeMap::new(problem.model, problem.entry.instant);
    let found = if guessed {
        let one = Orbit::find(&map, problem.entry.point(), arguments.period);
        one.map(|it| vec![it]).map_err(|none| (none.residual, none.to_string()))
    } else {
        scan_orbits(&map, arguments.period)
    };
    let orbits = found.as_ref().map_or(&[][..], Vec::as_slice);
    if outputs.any(|it| it == OrbitFormat::Json) && !arguments.all {
        say_which(orbits, arguments.period);
    }
    let first = || found.as_ref().map(|it| &it[0]).map_err(|(residual, _)| *residual);
    outputs.each(|format, out| match format {
        OrbitFormat::Table => Ok(out.write_all(table::text(orbits).as_bytes())?),
        OrbitFormat::Json if arguments.all => json(out, &OrbitsJson::new(&problem.model, orbits)),
        OrbitFormat::Json => json(out, &OrbitJson::new(&problem.model, first())),
    })?;
    Ok(match found {
        Ok(_) => DONE,
        Err((_, why)) => {
            say(&why);
            OUT_OF_BOUNDS
        }
    })
}

/// The orbits that a scan finds, the preferred one first; at least one.
fn scan_orbits(map: &StrobeMap, period: u32) -> Result<Vec<Orbit>, (f64, String)> {
    let bar = long_work::share_bar();
    let found = scan(map, period, &mut |share| bar.show_share(share));
    bar.finish_and_clear();
    if found.is_empty() { Err(none_found(period)) } else { Ok(found) }
}

/// The preferred orbit of a scan; how many others there are is said.
pub(super) fn first_scanned(map: &StrobeMap, period: u32) -> Result<Orbit, (f64, String)> {
    let found = scan_orbits(map, period)?;
    say_which(&found, period);
    preferred(found, period)
}

/// Says how many orbits of the period a scan has found, where it is more than one.
fn say_which(found: &[Orbit], period: u32) {
    let whole = found.iter().filter(|it| it.period() == period);
    let (count, stable) = (whole.clone().count(), whole.filter(|it| it.is_stable()).count());
    if count > 1 {
        note(&format!(
            "a scan found {count} orbits of period {period}, {stable} of them stable; this is one: percuss orbit --all prints all, --p, --y and --q near another select that"
        ));
    }
}

/// The first orbit that a scan has found.
pub(super) fn preferred(found: Vec<Orbit>, period: u32) -> Result<Orbit, (f64, String)> {
    found.into_iter().next().ok_or_else(|| none_found(period))
}

fn none_found(period: u32) -> (f64, String) {
    (f64::INFINITY, format!("no orbit of period {period} was found by a scan of starts"))
}
