//! `continue`: a branch of periodic orbits, of the impact oscillator or of a SYSTEM.

mod curves;
mod draw;
mod draw_curves;
pub(crate) mod of_system;

use super::super::help;
use super::find::{first_scanned, preferred};
use super::json::{BranchJson, Doubled, Followed, JsonPlace, Special};
use crate::case::Problem;
use crate::cli::shared::long_work;
use crate::cli::shared::model::ModelFlags;
use crate::cli::shared::output::json;
use crate::cli::shared::outputs::OutputsFlags;
use crate::cli::shared::parse::{self, MAX_PERIODS, Typed};
use crate::cli::shared::picture::PictureFlags;
use crate::cli::shared::section::{SectionFlags, without_system};
use crate::cli::shared::system_choice::SystemChoice;
use crate::cli::{DONE, OUT_OF_BOUNDS, say};
use crate::picture::{self, Figure};
use anyhow::{Result, anyhow, bail};
use clap::{Args, ValueEnum};
use draw::{DrawnBifurcation, DrawnOrbit, DrawnPoints};
use percuss::dynamics::continuation::{
    BifurcationKind, Branch, BranchEnding, Criticality, Doubling, Family,
};
use percuss::dynamics::orbit::scan;
use percuss::dynamics::strobe::StrobeMap;
use percuss::{InputError, Parameter};

/// Follow a periodic orbit, stable or not, in a parameter, and locate its bifurcations
///
/// Answers how far in a parameter an orbit exists, where it is stable, and what
/// ends it; of a SYSTEM with the guard that is touched where its events change.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::CONTINUE)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) system: SystemChoice,
    /// What varies: a, b, xi, omega, g or phi; with SYSTEM a parameter of it
    #[arg(long, value_name = "NAME")]
    pub(crate) parameter: String,
    /// The parameter's first value
    #[arg(long, value_name = "X", value_parser = parse::end, allow_hyphen_values = true)]
    pub(crate) from: Typed<f64>,
    /// The parameter's last value
    #[arg(long, value_name = "X", value_parser = parse::end, allow_hyphen_values = true)]
    pub(crate) to: Typed<f64>,
    /// Forcing periods of the orbit, with SYSTEM returns to the section
    #[arg(long, value_name = "K", value_parser = parse::period, allow_hyphen_values = true)]
    period: u32,
    /// With SYSTEM: a second parameter, in which the bifurcations that are found are followed
    #[arg(long, value_name = "NAME")]
    second: Option<String>,
    /// Values of --second between which curves are followed, its own value among them
    #[arg(long, value_name = "LO,HI", value_parser = parse::rising, allow_hyphen_values = true)]
    second_range: Option<Typed<[f64; 2]>>,
    /// Follows the branch of twice the period from the first flip too
    #[arg(long)]
    doubled: bool,
    /// With SYSTEM: returns after which the motion from the start is the guess [default: 0]
    #[arg(long, value_name = "N", value_parser = parse::whole::<u64>(0, MAX_PERIODS), allow_hyphen_values = true)]
    pub(crate) transient: Option<u64>,
    #[command(flatten)]
    pub(crate) section: SectionFlags,
    #[command(flatten)]
    output: OutputsFlags<Format>,
    #[command(flatten)]
    picture: PictureFlags,
    #[command(flatten)]
    pub(crate) model: ModelFlags,
}

/// A second parameter, and the values between which bifurcations are followed in it.
struct Second<'a> {
    name: &'a str,
    range: &'a Typed<[f64; 2]>,
}

/// The output format of a branch, or of curves of bifurcations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    Json,
    /// With --second
    Csv,
    Png,
    Svg,
}

pub(crate) fn run(arguments: &Arguments) -> Result<u8> {
    let usual = if arguments.second.is_some() { Format::Csv } else { Format::Json };
    let outputs = arguments.output.outputs(|_| usual)?;
    if arguments.second.is_none() && outputs.any(|it| it == Format::Csv) {
        bail!("--format csv is not accepted without --second: json, png and svg are");
    }
    arguments.picture.check(&outputs.pictures())?;
    if let Some(chosen) = arguments.system.chosen(&arguments.model)? {
        of_system::check(arguments, &chosen)?;
        return match arguments.second()? {
            Some(second) => curves::run(arguments, &chosen, &second, &outputs),
            None => of_system::run(arguments, &chosen, &outputs),
        };
    }
    arguments.picture.refuse_show()?;
    arguments.check_of_oscillator()?;
    family(arguments, &arguments.model)?;
    arguments.check_varied()?;
    let bar = long_work::share_bar();
    let (followed, why) = follow_branch(
        arguments,
        &arguments.model,
        Reporting::Told(&|share| bar.show_share(share)),
    )?;
    bar.finish_and_clear();
    let figure = || drawing(arguments, &followed);
    outputs.data_and_figure(&arguments.picture, |_, out| json(out, &followed), figure)?;
    if let Some(why) = &why {
        say(why);
    }
    Ok(if why.is_none() { DONE } else { OUT_OF_BOUNDS })
}

/// The displacement at the first strobe of each orbit over the parameter.
fn drawing(arguments: &Arguments, followed: &Followed) -> Result<Figure> {
    let parameter = arguments.parameter_of_oscillator()?;
    let parameters = arguments.model.problem()?.model;
    let doubled = followed.doubled.iter().flatten().map(|it| &it.branch);
    let all: Vec<&BranchJson> = std::iter::once(&followed.branch).chain(doubled).collect();
    let orbits = |it: &&BranchJson| {
        let orbit = |it: &JsonPlace| DrawnOrbit {
            at: DrawnPoints { value: it.parameter, points: vec![it.point[0]] },
            is_stable: it.stable,
        };
        it.branch.iter().map(orbit).collect::<Vec<_>>()
    };
    let found = |it: &Special| DrawnBifurcation {
        name: it.r#type.to_owned(),
        at: DrawnPoints { value: it.value, points: vec![it.point[0]] },
    };
    let branches: Vec<_> = all.iter().map(orbits).collect();
    let found: Vec<_> = all.iter().flat_map(|it| it.bifurcations.iter().map(found)).collect();
    let symbol = picture::symbol(parameter);
    let caption = format!("orbits of period {}, at their first strobe", arguments.period);
    let title = picture::caption_without(parameters.parameters(), Some(parameter));
    let axes = [symbol.to_owned(), "p (displacement)".to_owned()];
    Ok(draw::figure(title, caption, axes, &branches, &found))
}

impl Arguments {
    /// Refuses what does not fit the impact oscillator.
    pub(crate) fn check_of_oscillator(&self) -> Result<()> {
        self.section.refuse()?;
        if let Some(transient) = self.transient {
            bail!("{}", without_system("--transient", &transient));
        }
        if let Some(second) = &self.second {
            bail!("{}", without_system("--second", second));
        }
        if let Some(range) = &self.second_range {
            bail!("{}", without_system("--second-range", range));
        }
        Ok(())
    }

    /// Refuses a second parameter where branches alone are followed.
    pub(crate) fn refuse_second(&self) -> Result<()> {
        match self.second()? {
            Some(Second { name, .. }) => bail!("--second {name} is not accepted in a sweep"),
            None => Ok(()),
        }
    }

    /// The second parameter and its range, if bifurcations are followed in one.
    fn second(&self) -> Result<Option<Second<'_>>> {
        match (&self.second, &self.second_range) {
            (Some(name), Some(range)) => Ok(Some(Second { name, range })),
            (None, None) => Ok(None),
            (Some(second), None) => {
                bail!("--second {second} is not accepted alone: it is with --second-range LO,HI")
            }
            (None, Some(range)) => {
                bail!("--second-range {range} is not accepted alone: it is with --second NAME")
            }
        }
    }

    /// Refuses the own flag of the parameter that varies.
    pub(crate) fn check_varied(&self) -> Result<()> {
        self.model.check_varied(self.parameter_of_oscillator()?)
    }

    /// The parameter of the impact oscillator that varies.
    fn parameter_of_oscillator(&self) -> Result<Parameter> {
        let name = &self.parameter;
        parse::parameter(name).map_err(|what| anyhow!("--parameter {name} is not accepted: {what}"))
    }
}

/// Whether progress and notes are shown.
#[derive(Clone, Copy)]
pub(crate) enum Reporting<'a> {
    /// Shares that are done are told, and what a scan has found.
    Told(&'a dyn Fn(f64)),
    /// Nothing is told.
    Alone,
}

/// The branch that the flags ask for, with this model and start, and why it is not complete.
pub(crate) fn follow_branch(
    arguments: &Arguments,
    model: &ModelFlags,
    seen: Reporting<'_>,
) -> Result<(Followed, Option<String>)> {
    let Arguments { from: Typed { value: from, .. }, to: Typed { value: to, .. }, .. } = *arguments;
    let parameter = arguments.parameter_of_oscillator()?;
    let (problem, guessed, family) = family(arguments, model)?;
    let branch = branch(arguments, &problem, guessed, &family, seen);
    let doubled = match &branch {
        Ok(branch) if arguments.doubled => Some(doubled_branch(branch, &family, from, to, seen)),
        _ => None,
    };
    let complete = branch.as_ref().is_ok_and(Branch::is_complete);
    let followed = Followed {
        schema: 1,
        percuss: env!("CARGO_PKG_VERSION"),
        // JSON has null for a NaN: what varies has no value.
        parameters: (&parameter.set(*problem.model.parameters(), f64::NAN)).into(),
        period: branch.as_ref().ok().and_then(|it| it.points.first()).map(|it| it.orbit.period()),
        branch: branch
            .as_ref()
            .map(|it| BranchJson::new(it, parameter, complete))
            .unwrap_or_default(),
        doubled,
    };
    let why = match branch {
        Ok(_) if complete => None,
        Ok(branch) => Some(format!("--parameter {}: {}", parameter.as_str(), branch.ending)),
        Err(why) => Some(why),
    };
    Ok((followed, why))
}

/// The problem at the first value, whether a start was given, and the models that are passed.
pub(crate) fn family(arguments: &Arguments, model: &ModelFlags) -> Result<(Problem, bool, Family)> {
    let Arguments { from, to, .. } = arguments;
    let parameter = arguments.parameter_of_oscillator()?;
    let (problem, guessed) = model.guess(Some((parameter, "--from", from)))?;
    let family = Family::new(*problem.model.parameters(), parameter, problem.entry.instant);
    family.map(to.value).map_err(|error| refused_end(to, &error))?;
    Ok((problem, guessed, family))
}

impl Reporting<'_> {
    fn share(self, share: f64) {
        if let Self::Told(told) = self {
            told(share);
        }
    }
}

/// What is said of a value of --to that the model does not accept.
fn refused_end(to: &Typed<f64>, error: &InputError) -> anyhow::Error {
    match error {
        InputError::OutOfRange { accepted, .. } => anyhow!("--to {to} is not accepted: {accepted}"),
        error => anyhow!("--to {to}: {error}"),
    }
}

fn branch(
    arguments: &Arguments,
    problem: &Problem,
    guessed: bool,
    family: &Family,
    seen: Reporting<'_>,
) -> Result<Branch, String> {
    let Arguments { period, from, to, .. } = arguments;
    let guess = if guessed {
        problem.entry.point()
    } else {
        let map = StrobeMap::new(problem.model, problem.entry.instant);
        let orbit = match seen {
            Reporting::Told(_) => first_scanned(&map, *period),
            Reporting::Alone => preferred(scan(&map, *period, &mut |_| ()), *period),
        };
        orbit.map_err(|(_, why)| why)?.points[0]
    };
    let told = &mut |share| seen.share(share);
    let branch = Branch::follow(family, guess, *period, from.value, to.value, told);
    branch.map_err(|none| none.to_string())
}

/// The branch of twice the period at the first flip of the branch's own orbit, if there is one.
fn doubled_branch(
    branch: &Branch,
    family: &Family,
    from: f64,
    to: f64,
    seen: Reporting<'_>,
) -> Option<Doubled> {
    let period = branch.points.first()?.orbit.period();
    let own = |it: &&_| is_flip_of(it, period);
    let flip = branch.bifurcations.iter().find(own)?;
    let doubling = Doubling::new(family, flip, from, to, &mut |share| seen.share(share));
    let Doubling { criticality, branch } = doubling?;
    let complete = matches!(branch.ending, BranchEnding::Reached | BranchEnding::Left);
    Some(Doubled {
        at: flip.value,
        criticality: match criticality {
            Criticality::Supercritical => "supercritical",
            Criticality::Subcritical => "subcritical",
        },
        period: 2 * period,
        branch: BranchJson::new(&branch, family.parameter(), complete),
    })
}

fn is_flip_of(found: &percuss::dynamics::continuation::Bifurcation, period: u32) -> bool {
    found.kind == BifurcationKind::Flip && found.orbit.period() == period
}
