//! `validate`: every engine on every case against the truth.

use super::names::{CASES, ENGINES};
use super::output::{Destination, reader_left};
use super::programs::ProgramFlags;
use super::{DONE, OUT_OF_BOUNDS, note, parse, reports, say, work};
use crate::case::{self, Cases, Defaults};
use crate::engine::{self, Engine, Wrong, WrongWay, hush_contained_panics};
use crate::power::{self, Finding, Standard};
use crate::report::{
    Baseline, Compared, RankingFormat, Report, ReportEvidence, RowPlace, Summary, event_pictures,
    ranking_text, screen,
};
use crate::suite::{self, CaseRun, Prepared, PreparedSystem, Scope, Suite};
use crate::truth::Library;
use anyhow::{Context, Result, anyhow, bail};
use clap::{Args, ValueEnum};
use regex::Regex;
use std::path::{Path, PathBuf};

/// Hold every engine against the truth on every case
#[derive(Args)]
pub(super) struct Arguments {
    /// How much to run
    #[arg(long, value_enum, default_value_t = Suite::Quick)]
    suite: Suite,
    /// Only rows at this tolerance, one of the suite's; several are alternatives
    #[arg(long, value_name = "T", value_parser = parse::tolerance)]
    tolerance: Vec<parse::Typed<f64>>,
    /// Only engines whose name matches; several are alternatives
    #[arg(short, long = "engine", value_name = "RE", value_parser = parse::pattern, allow_hyphen_values = true)]
    engine: Vec<Regex>,
    /// Only cases whose name matches; several are alternatives
    #[arg(short, long = "case", value_name = "RE", value_parser = parse::pattern, allow_hyphen_values = true)]
    case: Vec<Regex>,
    /// Writes report.html, report.json, errors.csv, junit.xml and pictures into this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// An engine that is not installed is a failure
    #[arg(long)]
    require: bool,
    /// Fails where anything is worse than in this report, or gone
    #[arg(long, value_name = "report.json")]
    baseline: Option<PathBuf>,
    /// A row of the baseline that was not made is no failure
    #[arg(long, requires = "baseline")]
    allow_missing: bool,
    /// Prints every row above the summary, as is done for at most three cases
    #[arg(long)]
    rows: bool,
    /// Format of the summary on stdout
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
    #[command(flatten)]
    programs: ProgramFlags,
    /// Reads the cases from this folder instead of those inside the binary
    #[arg(long, value_name = "DIR")]
    cases: Option<PathBuf>,
    /// Reads the reference data from this folder instead of those inside the binary
    #[arg(long, value_name = "DIR")]
    reference: Option<PathBuf>,
}

/// The summary's formats.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    /// For people: the ranking, where each engine fails, and the number of rows of each class
    Table,
    /// A Markdown table, for a wiki or a comment
    Markdown,
    /// Comma-separated values
    Csv,
    /// The ranking and the number of rows of each class
    Json,
}

/// With at most this many cases the rows are printed too.
const FEW_CASES: usize = 3;

pub(super) fn run(arguments: &Arguments, threads: Option<u16>) -> Result<u8> {
    if arguments.rows && arguments.format != Format::Table {
        bail!("--rows has no effect with this --format; accepted with --rows is table");
    }
    let scope = scope(arguments)?;
    let baseline = arguments.baseline.as_deref().map(read_baseline).transpose()?;
    let _programs = arguments.programs.start()?;
    let engines = chosen_engines(&arguments.engine)?;
    let cases = prepared_cases(arguments)?;
    let all = cases.all();
    if let Some(folder) = &arguments.out {
        std::fs::create_dir_all(folder).map_err(|error| {
            anyhow!(
                "--out {} cannot be made ({error}); accepted is a writable folder",
                folder.display()
            )
        })?;
    }
    let mut defaults = match arguments.cases {
        Some(_) => case::defaults_of_own_cases()?,
        None => case::defaults()?,
    };
    if arguments.cases.is_none() {
        defaults.shortcomings.extend(arguments.programs.shortcomings()?);
    }
    hush_contained_panics();
    let pool = work::pool(threads)?;
    let wrong = WrongEngines::of(arguments);
    let steps = suite::size(all.len(), &engines, &scope) + wrong.count();
    let bar = work::bar(steps as u64, "rows");
    let rows = pool.install(|| suite::run(&all, &engines, &scope, &defaults, &|| bar.inc(1)));
    let asked = suite::size(all.len(), &engines, &scope);
    if rows.len() != asked {
        bail!("{} rows were made where {asked} were asked for", rows.len());
    }
    let findings = pool.install(|| wrong.examine(&cases, &defaults, &|| bar.inc(1)));
    bar.finish_and_clear();
    let mut evidence = ReportEvidence::gather(
        (&cases.oscillator, &cases.systems),
        &rows,
        &findings,
        arguments.cases.is_none(),
    );
    evidence.folders = folders(arguments);
    if arguments.out.is_some() {
        evidence.events = pool.install(|| {
            event_pictures((&cases.oscillator, &cases.systems), &rows, arguments.suite)
        });
    }
    let declarations: Vec<_> = engines.iter().map(|engine| engine.declaration()).collect();
    let report = Report::new(arguments.suite, &declarations, &rows);
    evidence.worse = match &baseline {
        Some(baseline) => worse(arguments, &scope, baseline, &report)?,
        None => Vec::new(),
    };
    write(arguments, &report, &evidence, all.len())?;
    Ok(if unnoticed(&findings) { OUT_OF_BOUNDS } else { code(arguments, &report, &evidence) })
}

/// The suite, as far as tolerances are chosen.
fn scope(arguments: &Arguments) -> Result<Scope> {
    let all = Scope::from(arguments.suite);
    let accepted = || {
        let shown: Vec<_> = all.tolerances().iter().map(|it| format!("{it:e}")).collect();
        shown.join(", ")
    };
    match arguments.tolerance.iter().find(|it| !all.tolerances().contains(&it.value)) {
        Some(other) => {
            bail!("--tolerance {:?} is not accepted: {}", other.text, accepted())
        }
        None => Ok(all.at(arguments.tolerance.iter().map(|it| it.value).collect())),
    }
}

/// The folders that data were read from, with their flags.
fn folders(arguments: &Arguments) -> Vec<(&'static str, String)> {
    let given = [("--cases", &arguments.cases), ("--reference", &arguments.reference)];
    let shown = |(flag, folder): (&'static str, &Option<PathBuf>)| {
        Some((flag, folder.as_ref()?.display().to_string()))
    };
    given.into_iter().filter_map(shown).collect()
}

/// Engines that are wrong on purpose, for the power of the gates; none where something else is
/// asked.
#[derive(Default)]
struct WrongEngines {
    anywhere: Vec<(Wrong, Standard)>,
    on_systems: Vec<(WrongWay, Standard)>,
}

impl WrongEngines {
    fn of(arguments: &Arguments) -> Self {
        let everything =
            arguments.engine.is_empty() && arguments.case.is_empty() && arguments.cases.is_none();
        if everything {
            Self { anywhere: power::all(), on_systems: power::all_on_systems() }
        } else {
            Self::default()
        }
    }

    fn count(&self) -> usize {
        self.anywhere.len() + self.on_systems.len()
    }

    /// What the gates make of them.
    fn examine(&self, cases: &PreparedCases, defaults: &Defaults, done: &dyn Fn()) -> Vec<Finding> {
        let PreparedCases { oscillator, systems } = cases;
        let anywhere = self
            .anywhere
            .iter()
            .map(|(it, held)| power::examine(it, oscillator, *held, &defaults.bounds));
        let on_systems = self
            .on_systems
            .iter()
            .map(|(it, held)| power::examine_on_systems(it, systems, *held, &defaults.of_systems));
        anywhere.chain(on_systems).inspect(|_| done()).collect()
    }
}

/// Whether a wrong engine passes every bound of all cases together; said on stderr.
fn unnoticed(findings: &[Finding]) -> bool {
    let missed: Vec<_> = findings.iter().filter(|it| !it.caught()).collect();
    missed.iter().for_each(|it| say(&format!("no bound notices {}: {}", it.engine, it.fault)));
    !missed.is_empty()
}

/// What is worse than in the baseline, or gone.
fn worse(
    arguments: &Arguments,
    scope: &Scope,
    baseline: &Baseline,
    report: &Report,
) -> Result<Vec<String>> {
    let accepts = |patterns: &[Regex], name: &str| {
        patterns.is_empty() || patterns.iter().any(|it| it.is_match(name))
    };
    let asked = |it: &RowPlace<'_>| {
        accepts(&arguments.engine, it.engine)
            && accepts(&arguments.case, it.case)
            && scope.makes(it.tolerance, it.step)
    };
    let Compared { mut worse, gone, common } = baseline.compare(report, asked);
    if common == 0 {
        bail!("--baseline: no row in common with this run; accepted is a report of the same rows");
    }
    if arguments.allow_missing {
        gone.iter().for_each(|it| note(&format!("{it}: gone, which --allow-missing accepts")));
    } else {
        worse.extend(gone.iter().map(|it| format!("{it}: gone, --allow-missing accepts that")));
    }
    Ok(worse)
}

/// Files, annotations and the summary.
fn write(
    arguments: &Arguments,
    report: &Report,
    evidence: &ReportEvidence,
    cases: usize,
) -> Result<()> {
    if let Some(folder) = &arguments.out {
        reports::write(report, evidence, folder)?;
    }
    reports::annotate(report, evidence, arguments.require);
    let with_rows = arguments.rows || cases <= FEW_CASES;
    let text = match arguments.format {
        Format::Table => screen(report, evidence, with_rows),
        Format::Markdown => ranking_text(report, RankingFormat::Markdown)?,
        Format::Csv => ranking_text(report, RankingFormat::Csv)?,
        Format::Json => ranking_text(report, RankingFormat::Json)?,
    };
    if arguments.format != Format::Table {
        evidence.worse.iter().for_each(|it| say(&format!("worse than --baseline: {it}")));
    }
    let shown = Destination::Stdout.write(|out| Ok(out.write_all(text.as_bytes())?));
    // A reader that leaves early does not turn a failure into a success.
    shown.or_else(|error| if reader_left(&error) { Ok(()) } else { Err(error) })
}

fn code(arguments: &Arguments, report: &Report, evidence: &ReportEvidence) -> u8 {
    let Summary { fail, error, unavailable, .. } = report.summary;
    let lacking = arguments.require && unavailable > 0;
    let out_of_bounds = fail + error > 0 || lacking || !evidence.worse.is_empty();
    if out_of_bounds { OUT_OF_BOUNDS } else { DONE }
}

fn read_baseline(path: &Path) -> Result<Baseline> {
    let accepted = "accepted is a report.json of this program";
    let text = std::fs::read_to_string(path)
        .map_err(|error| anyhow!("--baseline {}: {error}; {accepted}", path.display()))?;
    Baseline::read(&text)
        .map_err(|error| anyhow!("--baseline {}: {error}; {accepted}", path.display()))
}

fn chosen_engines(patterns: &[Regex]) -> Result<Vec<&'static dyn Engine>> {
    let engines = engine::select(patterns)?;
    ENGINES.check(patterns, engine::all().iter().map(|it| it.declaration().name))?;
    Ok(engines)
}

/// All cases that are asked for, made ready.
struct PreparedCases {
    oscillator: Vec<Prepared>,
    systems: Vec<PreparedSystem>,
}

impl PreparedCases {
    /// The cases of the oscillator, then those of other systems.
    fn all(&self) -> Vec<&dyn CaseRun> {
        let oscillator = self.oscillator.iter().map(|it| it as &dyn CaseRun);
        oscillator.chain(self.systems.iter().map(|it| it as &dyn CaseRun)).collect()
    }
}

fn prepared_cases(arguments: &Arguments) -> Result<PreparedCases> {
    let mut cases = match &arguments.cases {
        Some(folder) => Cases::from_directory(folder).context("--cases")?,
        None => Cases::embedded()?,
    };
    CASES.check(&arguments.case, cases.names())?;
    cases.retain(|name| {
        arguments.case.is_empty() || arguments.case.iter().any(|it| it.is_match(name))
    });
    let library = match &arguments.reference {
        Some(folder) => Library::from_directory(folder).context("--reference")?,
        // Cases of a user's own may come before their tables.
        None if arguments.cases.is_some() => Library::embedded()?.replaying(),
        None => Library::embedded()?,
    };
    for name in cases.names().filter(|name| library.is_replayed(name)) {
        note(&format!(
            "{name}: without tables: its truth is the exact solver's run made again in 106 bits"
        ));
    }
    Ok(PreparedCases {
        oscillator: suite::prepare(cases.oscillator, &library, arguments.suite)?,
        systems: suite::prepare_systems(cases.systems, &library)?,
    })
}
