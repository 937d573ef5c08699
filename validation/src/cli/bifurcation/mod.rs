//! `bifurcation`: a brute-force diagram of the impact oscillator or of a SYSTEM, as a table or a
//! picture.

pub(super) mod system;

use super::help;
use super::note;
use super::shared::long_work;
use super::shared::model::ModelFlags;
use super::shared::outputs::{Outputs, OutputsFlags};
use super::shared::parse::{self, MAX_PERIODS, Typed};
use super::shared::picture::PictureFlags;
use super::shared::section::{SectionFlags, without_system};
use super::shared::system_choice::SystemChoice;
use super::shared::terminal::endless_words;
use crate::number::shortest;
use crate::picture::{self, Figure, Layer, Plot};
use anyhow::{Result, anyhow, bail};
use clap::{ArgGroup, Args, ValueEnum};
use percuss::dynamics::diagram::{Diagram, DiagramStep, Follow};
use percuss::{InputError, Parameter};
use std::io::Write;

/// Draw a brute-force bifurcation diagram; of the oscillator with the drift
///
/// Answers what settles at each value of a parameter, and how fast it goes
/// forward there. Of a SYSTEM it shows the returns to a section.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::BIFURCATION)]
#[command(group(ArgGroup::new("length").required(true).args(["periods", "returns"])))]
pub(super) struct Arguments {
    #[command(flatten)]
    pub(super) system: SystemChoice,
    /// What varies: a, b, xi, omega, g or phi; with SYSTEM a parameter of it
    #[arg(long, value_name = "NAME")]
    pub(super) parameter: String,
    /// The parameter's first value
    #[arg(long, value_name = "X", value_parser = parse::end, allow_hyphen_values = true)]
    pub(super) from: Typed<f64>,
    /// The parameter's last value
    #[arg(long, value_name = "X", value_parser = parse::end, allow_hyphen_values = true)]
    pub(super) to: Typed<f64>,
    /// Number of values, both ends included
    #[arg(long, value_name = "N", value_parser = parse::whole::<u32>(1, 1_000_000), allow_hyphen_values = true)]
    pub(super) steps: u32,
    /// Forcing periods that are left out at each value, with SYSTEM returns
    #[arg(long, value_name = "M", value_parser = parse::whole::<u64>(0, MAX_PERIODS), allow_hyphen_values = true)]
    pub(super) transient: u64,
    /// Points at each value, one a forcing period, at least 1
    #[arg(long, value_name = "N", value_parser = parse::whole::<u32>(1, MAX_PERIODS), allow_hyphen_values = true)]
    pub(super) periods: Option<u32>,
    /// With SYSTEM: points at each value, one a return to the section, at least 1
    #[arg(long, value_name = "N", value_parser = parse::whole::<u32>(1, MAX_PERIODS), allow_hyphen_values = true)]
    pub(super) returns: Option<u32>,
    /// Starts each value from the last state of the one before (the default)
    #[arg(long, conflicts_with = "reset")]
    carry: bool,
    /// Starts each value from the start given
    #[arg(long)]
    pub(super) reset: bool,
    #[command(flatten)]
    pub(super) section: SectionFlags,
    #[command(flatten)]
    output: OutputsFlags<Format>,
    #[command(flatten)]
    picture: PictureFlags,
    #[command(flatten)]
    pub(super) model: ModelFlags,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    Csv,
    Png,
    Svg,
}

/// Rows that are held in memory.
pub(super) const MAX_ROWS: u64 = 10_000_000;
/// An SVG of more points is not small.
const MAX_SVG_POINTS: u64 = 20_000;

/// Writes the diagram; whether the motion was decided to its end at every value.
pub(super) fn run(arguments: &Arguments, threads: Option<u16>) -> Result<bool> {
    let outputs = arguments.output.outputs(|_| Format::Csv)?;
    arguments.picture.check(&outputs.pictures())?;
    if let Some(chosen) = arguments.system.chosen(&arguments.model)? {
        return system::run(arguments, &chosen, &outputs, threads);
    }
    arguments.picture.refuse_show()?;
    let diagram = diagram(arguments, &arguments.model)?;
    arguments.model.check_varied(diagram.parameter)?;
    check_size(arguments, ("--periods", diagram.periods), most_rows(&outputs))?;
    let bar = long_work::bar(u64::from(arguments.steps), "values");
    let steps = long_work::pool(threads)?.install(|| diagram.steps(|more| bar.inc(more)));
    bar.finish_and_clear();
    let steps =
        steps.map_err(|error| anyhow!("--parameter {}: {error}", diagram.parameter.as_str()))?;
    let figure = || Ok(drawing(&diagram, &steps));
    outputs.data_and_figure(&arguments.picture, |_, out| write_csv(&steps, out), figure)?;
    tell_escapes(&diagram, &steps);
    tell_endless(&steps);
    Ok(tell_undecidable(diagram.parameter, &steps))
}

/// The most rows, or points of a picture.
fn most_rows(outputs: &Outputs<Format>) -> u64 {
    if outputs.any(|it| it == Format::Svg) { MAX_SVG_POINTS } else { MAX_ROWS }
}

impl Arguments {
    /// The number of forcing periods of the impact oscillator that are shown at each value.
    pub(super) fn periods_of_oscillator(&self) -> Result<u32> {
        self.section.refuse()?;
        let returns = || without_system("--returns", &self.returns.unwrap_or(1));
        let Some(periods) = self.periods else { bail!("{}", returns()) };
        Ok(periods)
    }

    /// The parameter of the impact oscillator that varies.
    pub(super) fn parameter_of_oscillator(&self) -> Result<Parameter> {
        let name = &self.parameter;
        parse::parameter(name).map_err(|what| anyhow!("--parameter {name} is not accepted: {what}"))
    }

    /// Refuses two ends where there is one value.
    fn check_steps(&self) -> Result<()> {
        if self.steps == 1 && self.from.value != self.to.value {
            bail!("--to {} has no effect with --steps 1; accepted is the value of --from", self.to);
        }
        Ok(())
    }

    /// The start of each value.
    const fn follow(&self) -> Follow {
        if self.reset { Follow::Reset } else { Follow::Carry }
    }
}

/// The diagram that the flags ask for, with this model and start.
pub(super) fn diagram(arguments: &Arguments, model: &ModelFlags) -> Result<Diagram> {
    let parameter = arguments.parameter_of_oscillator()?;
    let periods = arguments.periods_of_oscillator()?;
    let problem = model.problem()?;
    let parameters = *problem.model.parameters();
    arguments.check_steps()?;
    for (flag, value) in [("--from", &arguments.from), ("--to", &arguments.to)] {
        if let Err(InputError::OutOfRange { accepted, .. }) =
            parameter.set(parameters, value.value).check()
        {
            bail!("{flag} {value} is not accepted: {accepted}");
        }
    }
    Ok(Diagram {
        parameters,
        start: problem.start,
        parameter,
        from: arguments.from.value,
        to: arguments.to.value,
        steps: arguments.steps,
        transient: arguments.transient,
        periods,
        follow: arguments.follow(),
    })
}

/// Refuses more rows than are held in memory: so many a value, by this flag.
pub(super) fn check_size(
    arguments: &Arguments,
    (flag, count): (&str, u32),
    most: u64,
) -> Result<()> {
    long_work::check_horizon(arguments.transient, u64::from(count))?;
    let rows = u64::from(arguments.steps) * u64::from(count);
    if rows > most {
        bail!("--steps times {flag} is {rows}: accepted are at most {most}");
    }
    Ok(())
}

fn write_csv(steps: &[DiagramStep], out: &mut dyn Write) -> Result<()> {
    writeln!(out, "parameter,n,p,y,q,drift_per_period,drift_standard_error")?;
    for step in steps {
        let DiagramStep { value, drift_per_period, drift_standard_error, .. } = *step;
        let [value, drift, error] = [value, drift_per_period, drift_standard_error].map(shortest);
        for (n, point) in step.points.iter().enumerate() {
            let [p, y, q] = point.map(shortest);
            writeln!(out, "{value},{n},{p},{y},{q},{drift},{error}")?;
        }
    }
    Ok(())
}

fn drawing(diagram: &Diagram, steps: &[DiagramStep]) -> Figure {
    let section =
        |step: &DiagramStep| step.points.iter().map(|it| [step.value, it[0]]).collect::<Vec<_>>();
    let how = told_start(diagram.follow);
    let left_out = match steps.iter().filter(|step| step.escapes).count() {
        0 => String::new(),
        count => format!("; {count} values that escape are left out"),
    };
    let symbol = picture::symbol(diagram.parameter);
    let plot = |name: &str, points: Vec<[f64; 2]>| Plot {
        title: String::new(),
        axes: [symbol.to_owned(), name.to_owned()],
        window: None,
        layers: vec![Layer::cloud(points, picture::INK)],
    };
    let stays = steps.iter().filter(|step| !step.escapes);
    let drift = stays.map(|step| [step.value, step.drift_per_period]);
    Figure {
        title: picture::caption_without(&diagram.parameters, Some(diagram.parameter)),
        caption: format!(
            "{} values of {symbol}, {} strobes each after {} forcing periods; {how}{left_out}",
            diagram.steps, diagram.periods, diagram.transient
        ),
        columns: 1,
        panel: (1200, 460),
        plots: vec![
            plot("p (displacement)", steps.iter().flat_map(section).collect()),
            plot("drift per period", drift.collect()),
        ],
    }
}

/// The words of a caption for the start of each value.
const fn told_start(follow: Follow) -> &'static str {
    match follow {
        Follow::Carry => "each value starts where the last one ended",
        Follow::Reset => "each value starts from the start given",
    }
}

/// One line where rounding hides how a phase ends; whether there is no such value.
fn tell_undecidable(parameter: Parameter, steps: &[DiagramStep]) -> bool {
    let hidden = || steps.iter().filter(|step| step.undecidable);
    let Some(first) = hidden().next() else { return true };
    note(&format!(
        "undecidable: rounding hides how a phase ends at {} of {} values (first: {} = {}); simulate \
         with that value shows the phase",
        hidden().count(),
        steps.len(),
        parameter.as_str(),
        shortest(first.value)
    ));
    false
}

/// One line where values are left out because their motions escape.
fn tell_escapes(diagram: &Diagram, steps: &[DiagramStep]) {
    let escaped = || steps.iter().filter(|step| step.escapes);
    let Some(first) = escaped().next() else { return };
    let why = first.endless.map_or("its state passes 1e9", endless_words);
    let next = match diagram.follow {
        Follow::Carry => "; the next value starts from the last that did not escape",
        Follow::Reset => "",
    };
    note(&format!(
        "{} of {} values escape and are left out (first: {} = {}, {why}){next}",
        escaped().count(),
        steps.len(),
        diagram.parameter.as_str(),
        shortest(first.value)
    ));
}

/// One line where motions that stay end in a phase without end.
fn tell_endless(steps: &[DiagramStep]) {
    let stays = steps.iter().filter(|step| !step.escapes);
    let ended: Vec<_> = stays.filter_map(|step| step.endless).collect();
    if let Some(first) = ended.first() {
        let values = format!("{} of {} values", ended.len(), steps.len());
        note(&format!(
            "at {values} the run ends in a phase without end (first: {})",
            endless_words(*first)
        ));
    }
}
