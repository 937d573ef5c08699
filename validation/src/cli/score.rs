//! `score`: answers in files, judged as the runs of `validate` are.

use super::help;
use super::shared::gradients;
use super::shared::judged::JudgedFlags;
use super::shared::long_work;
use super::shared::names::{CASES, held_by};
use super::shared::parse;
use super::{note, say};
use crate::case;
use crate::engine::{Accuracy, Class, REFERENCE, Stepping, SteppingKind};
use crate::number::shortest;
use crate::report::{Report, ReportEvidence, RowPlace, event_pictures};
use crate::suite::first_wrong::first_wrong_events;
use crate::suite::{self, PreparedCase, Scored, Status, Suite};
use anyhow::{Context, Result, anyhow, bail};
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use percuss_programs::files::{
    Answerer, EVENTS_ENDING, FileEngine, GRADIENTS_ENDING, SAMPLES_ENDING,
};
use percuss_programs::{ACCEPTED_NAMES, is_name};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Judge answers in files, made by any program from what export wrote
///
/// Answers how your solver does where it is no engine of percuss: a program in
/// any language reads what `percuss export` wrote and writes its events, and they
/// are judged as `percuss validate` judges.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::SCORE)]
pub(super) struct Arguments {
    /// Name of the solver in the report: 1 to 40 lower-case letters, digits, -, _, . and +
    #[arg(long, value_name = "X", value_parser = name)]
    name: String,
    /// The solver's library (default: its name)
    #[arg(long, value_name = "L", value_parser = words)]
    library: Option<String>,
    /// The library's version
    #[arg(long, value_name = "V", value_parser = words, default_value = "unknown")]
    version: String,
    /// The language that the solver is written in
    #[arg(long, value_name = "LANGUAGE", value_parser = words, default_value = "unknown")]
    language: String,
    /// The tolerance that the answers were made with, which errors are counted in
    #[arg(long, value_name = "T", value_parser = tolerance, allow_hyphen_values = true)]
    tolerance: f64,
    /// The method's order, which --stepping per-step and fixed need
    #[arg(long, value_name = "N", value_parser = parse::whole::<u32>(1, 64), allow_hyphen_values = true)]
    order: Option<u32>,
    /// How the tolerance holds the error (default: adaptive)
    #[arg(long, value_name = "STEPPING", value_parser = one_of(&STEPPINGS))]
    stepping: Option<SteppingKind>,
    /// The class of the method
    #[arg(long, value_name = "CLASS", value_parser = one_of(&METHODS))]
    method: Option<Class>,
    /// The derivatives are differences of runs, whose step may be too large
    #[arg(long)]
    differences: bool,
    /// The folder of CASE.events.csv, CASE.samples.csv and CASE.gradients.csv
    #[arg(long, value_name = "DIR")]
    answers: PathBuf,
    #[command(flatten)]
    judged: JudgedFlags,
}

/// The values of --stepping.
const STEPPINGS: [Choice<SteppingKind>; 3] = [
    (
        "adaptive",
        "The error of the solution that goes on is below the estimate that is held",
        SteppingKind::Adaptive,
    ),
    (
        "per-step",
        "The error of the solution that goes on is what is held: BDF, DIRK",
        SteppingKind::PerStep,
    ),
    (
        "fixed",
        "The step is given, and the tolerance is what errors are counted in",
        SteppingKind::Fixed,
    ),
];
/// The values of --method.
const METHODS: [Choice<Class>; 4] = [
    ("explicit", "Runge-Kutta, extrapolation", Class::Explicit),
    ("implicit", "Radau, Rosenbrock, DIRK, Gauss", Class::Implicit),
    ("multistep", "Adams, BDF", Class::Multistep),
    ("taylor", "Derivatives of the solution", Class::Taylor),
];
/// A value of a flag: its name, its help, and its meaning.
type Choice<T> = (&'static str, &'static str, T);

/// Reads one of the values of a flag whose meanings are another package's.
fn one_of<T>(choices: &'static [Choice<T>]) -> impl TypedValueParser<Value = T>
where
    T: Copy + Send + Sync + 'static,
{
    let names = choices.iter().map(|(name, help, _)| PossibleValue::new(name).help(help));
    PossibleValuesParser::new(names).try_map(move |text| {
        let choice = choices.iter().find(|(name, ..)| *name == text);
        choice.map(|(.., meaning)| *meaning).ok_or("no such value")
    })
}

fn name(text: &str) -> Result<String, String> {
    if is_name(text) && !text.starts_with(REFERENCE) {
        return Ok(text.to_owned());
    }
    Err(format!("accepted is {ACCEPTED_NAMES} that does not begin with {REFERENCE}"))
}

/// A text that fits where it is shown.
fn words(text: &str) -> Result<String, String> {
    let is_accepted = |text: &str| {
        !text.trim().is_empty() && text.chars().count() <= 80 && !text.contains(char::is_control)
    };
    if is_accepted(text) {
        Ok(text.to_owned())
    } else {
        Err("accepted are 1 to 80 characters".to_owned())
    }
}

fn tolerance(text: &str) -> Result<f64, String> {
    // Written so that a NaN is refused.
    let value = text.parse().ok().filter(|value: &f64| (1e-16..=0.1).contains(value));
    value.ok_or_else(|| "accepted is a number, 1e-16 to 0.1".to_owned())
}

/// The suite whose budgets and limits apply.
const SUITE: Suite = Suite::Quick;

pub(super) fn run(arguments: &Arguments, threads: Option<u16>) -> Result<u8> {
    let judged = &arguments.judged;
    judged.check()?;
    let stepping = arguments.stepping()?;
    let baseline = judged.baseline()?;
    let derivatives_of = gradients::answered(&judged.chosen, &arguments.answers)?;
    if arguments.differences && derivatives_of.is_empty() {
        let folder = arguments.answers.display();
        bail!(
            "--differences: --answers {folder} has no CASE{GRADIENTS_ENDING} of a chosen case; \
             accepted is with derivatives"
        );
    }
    let differentiated: Vec<&str> = derivatives_of.iter().map(|it| it.name.as_str()).collect();
    let cases = judged.open(&differentiated)?;
    let answered = answered_cases(&arguments.answers)?;
    // What probes ask needs an engine that is there.
    let cases = cases.prepare(None)?;
    let all = &cases.all;
    check_names(arguments, all, &differentiated, &answered)?;
    let defaults = case::bounds_alone()?;
    let pool = long_work::pool(threads)?;
    let bar = long_work::bar(all.len() as u64, "cases");
    let row = |case: &PreparedCase| {
        let engine = arguments.engine(&case.case.name, stepping);
        let accuracy = Accuracy::Tolerance(arguments.tolerance);
        let row = suite::one(case, &engine, accuracy, SUITE, &defaults);
        bar.inc(1);
        // What it took to read the files says nothing of who answered.
        Scored { wall: Duration::ZERO, ..row }
    };
    let rows: Vec<Scored> = pool.install(|| all.par_iter().with_max_len(1).map(row).collect());
    bar.finish_and_clear();
    rows.iter().for_each(say_what_is_wrong);
    let mut evidence = ReportEvidence::gather(all, &rows, &[], judged.chosen.cases.is_none());
    evidence.replayed.clone_from(&cases.replayed);
    evidence.folders = [arguments.flags(), judged.folders()].concat();
    if judged.out.is_some() {
        evidence.events = pool.install(|| event_pictures(&first_wrong_events(all, &rows)));
    }
    let engine = |case: &str| arguments.engine(case, stepping);
    let gradients =
        pool.install(|| gradients::judged_files(derivatives_of, engine, arguments.tolerance))?;
    let report = Report { gradients, ..Report::new(SUITE, &[&engine("")], &rows) };
    let asked = |it: &RowPlace<'_>| {
        it.engine == arguments.name
            && judged.chosen.accepts(it.case)
            && it.tolerance == Some(arguments.tolerance)
    };
    if let Some(baseline) = &baseline {
        judged.compare(baseline, (&report, &mut evidence), asked)?;
    }
    say_what_is_not_given(&rows);
    judged.write(&report, &evidence, all.len())
}

impl Arguments {
    /// The flags that make a row again.
    fn flags(&self) -> Vec<(&'static str, String)> {
        let answers = self.answers.display().to_string();
        let tolerance = shortest(self.tolerance);
        let mut flags =
            vec![("--answers", answers), ("--name", self.name.clone()), ("--tolerance", tolerance)];
        flags.extend(self.order.map(|order| ("--order", order.to_string())));
        let stepping = STEPPINGS.iter().find(|(.., it)| Some(*it) == self.stepping);
        flags.extend(stepping.map(|(name, ..)| ("--stepping", (*name).to_owned())));
        let method = METHODS.iter().find(|(.., it)| Some(*it) == self.method);
        flags.extend(method.map(|(name, ..)| ("--method", (*name).to_owned())));
        flags
    }

    /// The answers to a case as an engine. The words live as long as this process.
    fn engine(&self, case: &str, stepping: Stepping) -> FileEngine {
        let for_ever = |text: &str| -> &'static str { Box::leak(text.to_owned().into_boxed_str()) };
        let answerer = Answerer {
            name: for_ever(&self.name),
            library: for_ever(self.library.as_deref().unwrap_or(&self.name)),
            version: for_ever(&self.version),
            language: for_ever(&self.language),
            class: self.method,
            order: self.order,
            stepping,
            takes_differences: self.differences,
        };
        FileEngine::new(answerer, self.answers.clone(), case.to_owned())
    }

    /// The way in which the accuracy was chosen, which fixes the unit of error.
    fn stepping(&self) -> Result<Stepping> {
        let kind = self.stepping.unwrap_or(SteppingKind::Adaptive);
        kind.of_order(self.order).context("--stepping: per-step and fixed need --order")
    }
}

/// The cases that a folder holds answers to.
fn answered_cases(folder: &Path) -> Result<BTreeSet<String>> {
    let unreadable = |error: std::io::Error| {
        let folder = folder.display();
        anyhow!(
            "--answers {folder}: {error}; accepted is a folder of CASE{EVENTS_ENDING} and \
             CASE{SAMPLES_ENDING}"
        )
    };
    let mut cases = BTreeSet::new();
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        let name = entry.map_err(unreadable)?.file_name();
        let name = name.to_string_lossy();
        let mut endings = [EVENTS_ENDING, SAMPLES_ENDING, GRADIENTS_ENDING].into_iter();
        let case = endings.find_map(|ending| name.strip_suffix(ending));
        cases.extend(case.map(str::to_owned));
    }
    Ok(cases)
}

/// Refuses answers to no case that is asked for, and names those to cases that there are not.
fn check_names(
    arguments: &Arguments,
    all: &[PreparedCase],
    differentiated: &[&str],
    answered: &BTreeSet<String>,
) -> Result<()> {
    let asked = |name: &String| {
        differentiated.contains(&name.as_str()) || all.iter().any(|it| it.case.name == *name)
    };
    if !answered.iter().any(asked) {
        let folder = arguments.answers.display();
        bail!(
            "--answers {folder}: there is no answer to a case that is asked for; accepted are \
             CASE{EVENTS_ENDING} and CASE{SAMPLES_ENDING}"
        );
    }
    let listed = match &arguments.judged.chosen.cases {
        Some(folder) => {
            held_by(folder, &all.iter().map(|it| it.case.name.as_str()).collect::<Vec<_>>())
        }
        None => CASES.listed.to_owned(),
    };
    for name in answered.iter().filter(|name| !asked(name) && arguments.judged.chosen.accepts(name))
    {
        note(&format!(
            "--answers {}: {name} is no case, its answer is left alone: {listed}",
            arguments.answers.display()
        ));
    }
    Ok(())
}

/// An answer that cannot be read is said at once: its row is one of many.
fn say_what_is_wrong(row: &Scored) {
    if let Status::Failed(failure) = &row.status {
        say(&failure.reason);
    }
}

/// What the answers lack, so that it is not judged, with the number of cases that lack it.
fn say_what_is_not_given(rows: &[Scored]) {
    let mut lacking: BTreeMap<&str, usize> = BTreeMap::new();
    for row in rows {
        let Status::Ok(measures, _) = &row.status else { continue };
        if let Some(what) = measures.not_given() {
            *lacking.entry(what).or_default() += 1;
        }
    }
    for (what, cases) in lacking {
        note(&format!("{cases} of {} cases are judged {what}", rows.len()));
    }
}
