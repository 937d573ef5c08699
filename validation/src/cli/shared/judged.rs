//! What `validate` and `score` have in common: the cases, the report, and what the verdicts come
//! to.

use super::exit_codes::{DONE, OUT_OF_BOUNDS};
use super::names::{CASES, Selection, held_by};
use super::output::{Destination, make_folder, reader_left};
use super::terminal::{note, say};
use super::{parse, reports};
use crate::case::{self, Case};
use crate::report::{
    Baseline, CASES_FLAG, Compared, RankingFormat, Report, ReportEvidence, RowPlace, ScreenParts,
    Summary, ranking_text, screen,
};
use crate::suite::{self, PreparedCase, Suite};
use crate::truth::Library;
use anyhow::{Context, Result, anyhow, bail};
use clap::{Args, ValueEnum};
use regex::Regex;
use std::path::{Path, PathBuf};

/// The flags of verbs that judge runs.
#[derive(Args)]
pub(in crate::cli) struct JudgedFlags {
    #[command(flatten)]
    pub(in crate::cli) chosen: CaseFlags,
    /// Writes report.html, report.json, errors.csv, junit.xml and pictures into this folder
    #[arg(long, value_name = "DIR")]
    pub(in crate::cli) out: Option<PathBuf>,
    /// A row without an answer is a failure: of an engine that is not installed, or of a case that
    /// was not answered
    #[arg(long)]
    require: bool,
    /// Fails where anything is worse than in this report, or gone; of several the best counts
    #[arg(long, value_name = "report.json")]
    baseline: Vec<PathBuf>,
    /// A row of the baseline that was not made is no failure
    #[arg(long, requires = "baseline")]
    allow_missing: bool,
    /// Prints every row above the summary, as is done for at most three cases
    #[arg(long)]
    rows: bool,
    /// Prints above the summary what it leaves out: kinds of trouble, rows that were not run, all
    /// engines with their events and costs, failing cases, and every reason
    #[arg(long)]
    details: bool,
    /// That more than half of the rows asked are unanswered or not scored is no failure
    #[arg(long)]
    allow_unanswered: bool,
    /// Format of the summary on stdout
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
    /// Reads the reference data from this folder instead of those inside the binary
    #[arg(long, value_name = "DIR")]
    reference: Option<PathBuf>,
}

/// The flags that choose cases.
#[derive(Args)]
pub(in crate::cli) struct CaseFlags {
    /// Only cases whose name matches; several are alternatives
    #[arg(short, long = "case", value_name = "RE", value_parser = parse::pattern, allow_hyphen_values = true)]
    pub(in crate::cli) case: Vec<Regex>,
    /// Reads the cases from this folder instead of those inside the binary
    #[arg(long, value_name = "DIR")]
    pub(in crate::cli) cases: Option<PathBuf>,
}

/// The summary's formats.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    /// For people: which integrator, at what tolerance, at what cost, and what goes wrong
    Table,
    /// A Markdown table, for a wiki or a comment
    Markdown,
    /// Comma-separated values
    Csv,
    /// The ranking and the number of rows of each class
    Json,
}

/// The most cases whose rows are printed too.
const MAX_CASES_WITH_ROWS: usize = 3;

impl CaseFlags {
    /// The cases that are chosen; none where patterns match only `others`, which are judged by
    /// something else.
    fn read(&self, others: &[&str]) -> Result<Vec<Case>> {
        let mut cases = match &self.cases {
            Some(folder) => case::from_directory(folder).context("--cases")?,
            None => case::embedded()?,
        };
        let names: Vec<&str> = cases.iter().map(|it| it.name.as_str()).collect();
        let listed = match &self.cases {
            Some(folder) => held_by(folder, &names),
            None => CASES.listed.to_owned(),
        };
        let known = names.into_iter().chain(others.iter().copied());
        Selection { listed: &listed, ..CASES }.check(&self.case, known)?;
        cases.retain(|it| self.accepts(&it.name));
        Ok(cases)
    }

    /// Whether a case is chosen.
    pub(in crate::cli) fn accepts(&self, name: &str) -> bool {
        accepts(&self.case, name)
    }

    /// The reference data of the cases: those inside the binary, or of a folder.
    fn library(&self, reference: Option<&Path>) -> Result<Library> {
        Ok(match reference {
            Some(folder) => Library::from_directory(folder).context("--reference")?,
            // Cases of a user's own may come before their tables.
            None if self.cases.is_some() => Library::embedded()?.replaying(),
            None => Library::embedded()?,
        })
    }

    /// The chosen cases with their reference data. Patterns may match `others` instead.
    pub(in crate::cli) fn open(
        &self,
        reference: Option<&Path>,
        others: &[&str],
    ) -> Result<OpenedCases> {
        let (cases, library) = (self.read(others)?, self.library(reference)?);
        Ok(OpenedCases { cases, library, are_users: self.cases.is_some() })
    }
}

/// Cases whose truth is still to be read.
pub(in crate::cli) struct OpenedCases {
    cases: Vec<Case>,
    library: Library,
    /// Whether they come from a folder, not from inside the binary.
    are_users: bool,
}

impl OpenedCases {
    /// The cases with their truth, and with the probes of a suite if one is given.
    pub(in crate::cli) fn prepare(self, probes: Option<Suite>) -> Result<PreparedCases> {
        let Self { cases, library, are_users } = self;
        let names = cases.iter().map(|it| it.name.clone());
        let replayed: Vec<String> = names.filter(|name| library.is_replayed(name)).collect();
        let prepared = PreparedCases { replayed, all: suite::prepare(cases, &library, probes)? };
        if are_users {
            let systems = prepared.all.iter().filter(|it| it.case.oscillator.is_none());
            systems.for_each(note_faint_states);
        }
        for name in &prepared.replayed {
            note(&format!(
                "{name}: without tables: its truth is the exact solver's run made again in 106 bits"
            ));
        }
        Ok(prepared)
    }
}

/// Says which states of a case are too small beside the others for their errors to be seen.
fn note_faint_states(prepared: &PreparedCase) {
    let system = &prepared.case.system;
    let faint = prepared.truth.faint_states(&system.scales);
    let names: Vec<&str> = faint.iter().map(|n| system.states[*n].as_str()).collect();
    if !names.is_empty() {
        note(&format!(
            "{}: {} so small beside 1 and the largest state that errors are hardly seen: \
             give {} `scales` in its file",
            prepared.case.name,
            if names.len() == 1 {
                format!("{} stays", names[0])
            } else {
                format!("{} stay", names.join(", "))
            },
            system.name
        ));
    }
}

/// Whether one of the patterns matches, or there are none.
pub(in crate::cli) fn accepts(patterns: &[Regex], name: &str) -> bool {
    patterns.is_empty() || patterns.iter().any(|it| it.is_match(name))
}

/// All cases that are asked for, made ready.
pub(in crate::cli) struct PreparedCases {
    /// The names of those without tables.
    pub(in crate::cli) replayed: Vec<String>,
    /// Those of the oscillator, then those of other systems.
    pub(in crate::cli) all: Vec<PreparedCase>,
}

impl JudgedFlags {
    /// Refuses flags without effect.
    pub(in crate::cli) fn check(&self) -> Result<()> {
        for (flag, is_given) in [("--rows", self.rows), ("--details", self.details)] {
            if is_given && self.format != Format::Table {
                bail!("{flag} has no effect with this --format; accepted with {flag} is table");
            }
        }
        Ok(())
    }

    /// The best of the baseline reports, with which this run is compared.
    pub(in crate::cli) fn baseline(&self) -> Result<Option<Baseline>> {
        let all: Result<Vec<Baseline>> = self.baseline.iter().map(|it| read_baseline(it)).collect();
        Ok(Baseline::best(all?))
    }

    /// The chosen cases with their reference data, once the folder of the report is made: to make
    /// them ready may take long. Patterns may match `others` instead.
    pub(in crate::cli) fn open(&self, others: &[&str]) -> Result<OpenedCases> {
        let cases = self.chosen.open(self.reference.as_deref(), others)?;
        self.out.as_deref().map(make_folder).transpose()?;
        Ok(cases)
    }

    /// The folders that data were read from, with their flags.
    pub(in crate::cli) fn folders(&self) -> Vec<(&'static str, String)> {
        let given = [(CASES_FLAG, &self.chosen.cases), ("--reference", &self.reference)];
        let shown = |(flag, folder): (&'static str, &Option<PathBuf>)| {
            Some((flag, folder.as_ref()?.display().to_string()))
        };
        given.into_iter().filter_map(shown).collect()
    }

    /// Notes the rows that are worse or dearer than in the baseline, or gone although they were
    /// `asked` for.
    pub(in crate::cli) fn compare(
        &self,
        baseline: &Baseline,
        (report, evidence): (&Report, &mut ReportEvidence),
        asked: impl Fn(&RowPlace<'_>) -> bool,
    ) -> Result<()> {
        let Compared { mut worse, dearer, gone, common } = baseline.compare(report, asked);
        if common == 0 {
            bail!(
                "--baseline: no row in common with this run; accepted is a report of the same rows"
            );
        }
        if self.allow_missing {
            gone.iter().for_each(|it| note(&format!("{it}: gone, which --allow-missing accepts")));
        } else {
            worse.extend(gone.iter().map(|it| format!("{it}: gone, --allow-missing accepts that")));
        }
        (evidence.worse, evidence.dearer) = (worse, dearer);
        Ok(())
    }

    /// Writes files, annotations and the summary, and says what the verdicts come to.
    pub(in crate::cli) fn write(
        &self,
        report: &Report,
        evidence: &ReportEvidence,
        cases: usize,
    ) -> Result<u8> {
        if let Some(folder) = &self.out {
            reports::write(report, evidence, folder)?;
        }
        reports::annotate(report, evidence, self.require);
        let parts =
            ScreenParts { rows: self.rows || cases <= MAX_CASES_WITH_ROWS, details: self.details };
        let text = match self.format {
            Format::Table => screen(report, evidence, parts),
            Format::Markdown => ranking_text(report, RankingFormat::Markdown)?,
            Format::Csv => ranking_text(report, RankingFormat::Csv)?,
            Format::Json => ranking_text(report, RankingFormat::Json)?,
        };
        if self.format != Format::Table {
            evidence.worse.iter().for_each(|it| say(&format!("worse than --baseline: {it}")));
            report.unanswered().iter().for_each(|it| say(&it.sentence()));
        }
        let shown = Destination::Stdout.write(|out| Ok(out.write_all(text.as_bytes())?));
        // A reader that leaves early does not turn a failure into a success.
        shown.or_else(|error| if reader_left(&error) { Ok(()) } else { Err(error) })?;
        Ok(self.code(report, evidence))
    }

    fn code(&self, report: &Report, evidence: &ReportEvidence) -> u8 {
        let Summary { fail, error, unavailable, .. } = report.summary;
        let lacking = self.require && unavailable > 0;
        let unanswered = !self.allow_unanswered && report.unanswered().is_some();
        let out_of_bounds = fail + error > 0 || lacking || unanswered || !evidence.worse.is_empty();
        if out_of_bounds { OUT_OF_BOUNDS } else { DONE }
    }
}

fn read_baseline(path: &Path) -> Result<Baseline> {
    let accepted = "accepted is a report.json of this program";
    let text = std::fs::read_to_string(path)
        .map_err(|error| anyhow!("--baseline {}: {error}; {accepted}", path.display()))?;
    Baseline::read(&text)
        .map_err(|error| anyhow!("--baseline {}: {error}; {accepted}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::synthetic::{report, row};
    use crate::score::Verdict;
    use clap::Parser;

    #[derive(Parser)]
    struct Words {
        #[command(flatten)]
        judged: JudgedFlags,
    }

    /// The exit code of a run of ten cases of which some hold nothing to judge.
    fn code(empty: usize, flags: &[&str]) -> Option<u8> {
        let mut rows: Vec<_> =
            (0..10).map(|case| row(&format!("case-{case}"), "one", Some(1e-6))).collect();
        for row in rows.iter_mut().take(empty) {
            row.verdict = Verdict::NotScored;
        }
        let words = ["percuss"].iter().chain(flags);
        let judged = Words::try_parse_from(words).ok()?.judged;
        Some(judged.code(&report(rows), &ReportEvidence::default()))
    }

    #[test]
    fn most_unanswered_is_out_of_bounds_unless_that_is_allowed() {
        assert_eq!([code(5, &[]), code(6, &[])], [Some(DONE), Some(OUT_OF_BOUNDS)]);
        assert_eq!(code(6, &["--allow-unanswered"]), Some(DONE));
    }
}
