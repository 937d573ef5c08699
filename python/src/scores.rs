//! Cases, what each asks, and the judgement of what was answered.

use crate::failure::value;
use crate::long_work::{Progress, interruptible};
use percuss_programs::files::{Answerer, CaseFile, FileEngine};
use percuss_programs::{ACCEPTED_NAMES, is_name};
use percuss_validation::case;
use percuss_validation::engine::{
    Accuracy, Class, Declaration, Ending, Engine, Failure, Limits, Outcome, REFERENCE, Stepping,
    Task, Work,
};
use percuss_validation::report::{
    Baseline, Report, ReportEvidence, RowPlace, event_pictures, exporters, pictures,
};
use percuss_validation::suite::{self, PreparedCase, Scored, Suite};
use percuss_validation::truth::Library;
use pyo3::FromPyObject;
use pyo3::exceptions::{PyKeyError, PyOSError};
use pyo3::prelude::{PyErr, PyResult, Python, pyclass, pyfunction, pymethods};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::Duration;

/// The suite whose budgets and limits apply, as in the verb `score`.
const SUITE: Suite = Suite::Quick;

/// The names of all cases inside the program.
#[pyfunction]
pub(crate) fn case_names() -> PyResult<Vec<String>> {
    let cases = case::embedded().map_err(value)?;
    Ok(cases.into_iter().map(|it| it.name).collect())
}

/// The names of the endings of a run before its horizon.
#[pyfunction]
pub(crate) fn ending_names() -> Vec<&'static str> {
    Ending::ALL.into_iter().filter(|it| *it != Ending::Horizon).map(Ending::as_str).collect()
}

/// Cases with their truth.
#[pyclass(frozen, module = "percuss._percuss")]
pub(crate) struct Cases {
    all: Vec<PreparedCase>,
}

/// Answers of one method at one tolerance, in the files of a folder.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Answers {
    name: String,
    library: String,
    version: String,
    language: String,
    class: Option<String>,
    order: Option<u32>,
    stepping: String,
    /// Whether derivatives are differences of whole runs.
    differences: bool,
    tolerance: f64,
    folder: PathBuf,
    /// Why there is no answer to a case that was tried.
    failures: BTreeMap<String, String>,
    /// Right-hand sides, Jacobians, linear systems and steps of a case.
    work: BTreeMap<String, [u64; 4]>,
}

/// The answer to one case in files, with what was said of it beside.
pub(crate) struct Answered {
    files: FileEngine,
    failure: Option<String>,
    work: Option<Work>,
}

impl Engine for Answered {
    fn declaration(&self) -> Declaration {
        self.files.declaration()
    }

    fn language(&self) -> &str {
        self.files.language()
    }

    fn takes_differences(&self) -> bool {
        self.files.takes_differences()
    }

    fn available(&self) -> Result<(), String> {
        if self.failure.is_some() { Ok(()) } else { self.files.available() }
    }

    fn run(&self, task: &Task, accuracy: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        if let Some(reason) = &self.failure {
            return Err(Failure::new(reason.clone()));
        }
        let outcome = self.files.run(task, accuracy, limits)?;
        Ok(Outcome { work: self.work.unwrap_or(outcome.work), ..outcome })
    }
}

impl Answers {
    pub(crate) fn tolerance(&self) -> f64 {
        self.tolerance
    }

    pub(crate) fn engine(&self, answerer: Answerer, case: &str) -> Answered {
        let work = |[rhs, jacobians, solves, steps]: [u64; 4]| Work {
            rhs_evaluations: rhs,
            jacobian_evaluations: jacobians,
            linear_solves: solves,
            steps,
        };
        Answered {
            files: FileEngine::new(answerer, self.folder.clone(), case.to_owned()),
            failure: self.failures.get(case).cloned(),
            work: self.work.get(case).copied().map(work),
        }
    }

    pub(crate) fn answerer(&self) -> PyResult<Answerer> {
        if !is_name(&self.name) || self.name.starts_with(REFERENCE) {
            return Err(value(format!(
                "name = {:?} is not accepted: {ACCEPTED_NAMES} that does not begin with \
                 {REFERENCE} is",
                self.name
            )));
        }
        // Written so that a NaN is refused.
        let is_tolerance = (1e-16..=0.1).contains(&self.tolerance);
        if !is_tolerance {
            let tolerance = self.tolerance;
            return Err(value(format!("rtol = {tolerance} is not accepted: 1e-16 to 0.1 is")));
        }
        Ok(Answerer {
            name: lasting_text(&self.name),
            library: lasting_text(&self.library),
            version: lasting_text(&self.version),
            language: lasting_text(&self.language),
            class: self.class.as_deref().map(class).transpose()?,
            order: self.order,
            stepping: self.stepping()?,
            takes_differences: self.differences,
        })
    }

    /// The way in which the tolerance holds the error, which fixes the unit of error.
    fn stepping(&self) -> PyResult<Stepping> {
        let order = || {
            let order = self.order.and_then(|it| i32::try_from(it).ok());
            order.filter(|it| (1..=64).contains(it)).ok_or_else(|| {
                value(format!("stepping = {:?} needs order, 1 to 64", self.stepping))
            })
        };
        match self.stepping.as_str() {
            "adaptive" => Ok(Stepping::Adaptive),
            "per-step" => Ok(Stepping::PerStep { order: order()? }),
            "fixed" => Ok(Stepping::Fixed { order: order()? }),
            other => Err(value(format!(
                "stepping = {other:?} is not accepted: adaptive, per-step and fixed are"
            ))),
        }
    }
}

fn class(word: &str) -> PyResult<Class> {
    match word {
        "explicit" => Ok(Class::Explicit),
        "implicit" => Ok(Class::Implicit),
        "multistep" => Ok(Class::Multistep),
        "taylor" => Ok(Class::Taylor),
        other => Err(value(format!(
            "kind = {other:?} is not accepted: explicit, implicit, multistep and taylor are"
        ))),
    }
}

/// A text that lasts as long as the process, each once.
fn lasting_text(text: &str) -> &'static str {
    static KEPT_TEXTS: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());
    let Ok(mut kept) = KEPT_TEXTS.lock() else { return "" };
    if let Some(known) = kept.get(text) {
        return known;
    }
    let made: &'static str = Box::leak(text.to_owned().into_boxed_str());
    kept.insert(made);
    made
}

#[pymethods]
impl Cases {
    /// Makes the cases of these names ready.
    #[new]
    fn new(py: Python<'_>, names: BTreeSet<String>) -> PyResult<Self> {
        let all = interruptible(py, &Progress::default(), |_| {
            let mut cases = case::embedded()?;
            cases.retain(|it| names.contains(&it.name));
            suite::prepare(cases, &Library::embedded()?, None)
        })?;
        Ok(Self { all: all.map_err(value)? })
    }

    #[getter]
    fn names(&self) -> Vec<String> {
        self.all.iter().map(|it| it.case.name.clone()).collect()
    }

    /// The question of a case, as the JSON that `percuss export` writes.
    fn ask(&self, name: &str) -> PyResult<String> {
        let case = self.all.iter().find(|it| it.case.name == name);
        let case = case.ok_or_else(|| PyKeyError::new_err(name.to_owned()))?;
        let asked = CaseFile::new(name, &case.task, case.parameters());
        serde_json::to_string(&asked).map_err(value)
    }

    /// The names of the cases on which a method would need more right-hand sides than are allowed.
    fn beyond_budget(&self, method: Answers) -> PyResult<Vec<String>> {
        let (answerer, accuracy) = (method.answerer()?, Accuracy::Tolerance(method.tolerance));
        let is_beyond = |case: &&PreparedCase| {
            let engine = method.engine(answerer, &case.case.name);
            case.least_work(&engine, accuracy) > SUITE.budget()
        };
        Ok(self.all.iter().filter(is_beyond).map(|it| it.case.name.clone()).collect())
    }

    /// Judges answers and writes the report into a folder.
    ///
    /// Returns what is worse than in the best of the earlier reports of these texts, a line each.
    fn judge(
        &self,
        py: Python<'_>,
        answers: Vec<Answers>,
        out: PathBuf,
        baselines: Vec<String>,
    ) -> PyResult<Vec<String>> {
        let declared: PyResult<Vec<_>> =
            answers.iter().map(|it| Ok((it.answerer()?, it))).collect();
        let declared = declared?;
        let baseline = best(&baselines)?;
        let written = interruptible(py, &Progress::default(), |stop| {
            let engine =
                |(answerer, it): &(Answerer, &Answers), case: &str| it.engine(*answerer, case);
            let defaults = case::bounds_alone().map_err(Unjudged::new)?;
            let row = |(case, method): (&PreparedCase, &(Answerer, &Answers))| {
                stop.look();
                let accuracy = Accuracy::Tolerance(method.1.tolerance);
                let engine = engine(method, &case.case.name);
                let row = suite::one(case, &engine, accuracy, SUITE, &defaults);
                // What it took to read the files says nothing of who answered.
                Scored { wall: Duration::ZERO, ..row }
            };
            let pairs: Vec<_> = self
                .all
                .iter()
                .flat_map(|case| declared.iter().map(move |method| (case, method)))
                .collect();
            let rows: Vec<Scored> = pairs.into_par_iter().with_max_len(1).map(row).collect();
            let mut evidence = ReportEvidence::gather(&self.all, &rows, &[], true);
            let events = suite::first_wrong::first_wrong_events(&self.all, &rows);
            evidence.events = event_pictures(&events);
            let mut seen = BTreeSet::new();
            let once = declared.iter().filter(|(it, _)| seen.insert(it.name));
            let engines: Vec<_> = once.map(|it| engine(it, "")).collect();
            let engines: Vec<&dyn Engine> = engines.iter().map(|it| it as &dyn Engine).collect();
            let report = Report::new(SUITE, &engines, &rows);
            if let Some(baseline) = &baseline {
                let is_asked = |it: &RowPlace<'_>| {
                    let is_method = |(who, method): &(Answerer, &Answers)| {
                        who.name == it.engine && Some(method.tolerance) == it.tolerance
                    };
                    let is_case = |case: &PreparedCase| case.case.name == it.case;
                    declared.iter().any(is_method) && self.all.iter().any(is_case)
                };
                let compared = baseline.compare(&report, is_asked);
                if compared.common == 0 {
                    return Err(Unjudged::new(
                        "baseline: no row in common: a report of the same rows is accepted",
                    ));
                }
                evidence.worse = compared.worse;
                evidence.worse.extend(compared.gone.into_iter().map(|it| format!("{it}: gone")));
                evidence.dearer = compared.dearer;
            }
            write(&report, &evidence, &out)?;
            Ok(evidence.worse)
        })?;
        written.map_err(|Unjudged(error)| error)
    }
}

/// The best of earlier reports of these texts, if there are any.
fn best(baselines: &[String]) -> PyResult<Option<Baseline>> {
    let read = |text: &String| {
        Baseline::read(text).map_err(|error| {
            value(format!("baseline: {error}: a report.json of this version is accepted"))
        })
    };
    Ok(Baseline::best(baselines.iter().map(read).collect::<PyResult<Vec<_>>>()?))
}

/// Why there is no report.
struct Unjudged(PyErr);

impl Unjudged {
    fn new(error: impl std::fmt::Display) -> Self {
        Self(value(error))
    }
}

impl From<std::io::Error> for Unjudged {
    fn from(error: std::io::Error) -> Self {
        Self(PyOSError::new_err(error.to_string()))
    }
}

/// Writes every format of the report, and its pictures.
fn write(report: &Report, evidence: &ReportEvidence, out: &Path) -> Result<(), Unjudged> {
    std::fs::create_dir_all(out)?;
    for exporter in exporters() {
        let mut file = std::fs::File::create(out.join(exporter.file_name()))?;
        exporter.write(report, evidence, &mut file)?;
    }
    for (name, bytes) in pictures(report, evidence).map_err(Unjudged::new)? {
        let path = out.join(name);
        path.parent().map(std::fs::create_dir_all).transpose()?;
        std::fs::write(path, bytes)?;
    }
    Ok(())
}
