//! Cases of derivatives through events, what each asks, and the verdicts on what was answered.

use crate::failure::value;
use crate::long_work::{Progress, interruptible};
use crate::scores::{Answered, Answers};
use percuss_programs::files::{Answerer, CaseFile};
use percuss_validation::engine::{Accuracy, Declaration, Engine, Failure, Limits, Outcome, Task};
use percuss_validation::gradients::{self, GradientCase, Judged, Reference, embedded, one};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::{PyResult, Python, pyclass, pyfunction, pymethods};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// The names of all cases of derivatives inside the program.
#[pyfunction]
pub(crate) fn gradient_case_names() -> Vec<&'static str> {
    gradients::names()
}

/// Cases of derivatives with their proved tables.
#[pyclass(frozen, module = "percuss._percuss")]
pub(crate) struct GradientCases {
    all: Vec<GradientCase>,
}

/// A verdict: the engine, the case, the name, the tolerance, the verdict itself, the missing term,
/// and the reason.
type VerdictRow = (String, String, String, f64, &'static str, Option<&'static str>, String);

/// The answers of one method to one case, each at its tolerance.
struct AtTolerances {
    answered: Vec<(f64, Answered)>,
}

impl AtTolerances {
    fn first(&self) -> &Answered {
        &self.answered[0].1
    }
}

impl Engine for AtTolerances {
    fn declaration(&self) -> Declaration {
        self.first().declaration()
    }

    fn language(&self) -> &str {
        self.first().language()
    }

    fn takes_differences(&self) -> bool {
        self.first().takes_differences()
    }

    fn run(&self, task: &Task, accuracy: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        let is_asked = |tolerance: f64| accuracy == Accuracy::Tolerance(tolerance);
        let found = self.answered.iter().find(|(tolerance, _)| is_asked(*tolerance));
        let (_, answered) = found.ok_or_else(|| Failure::new("no answer at this tolerance"))?;
        answered.available().map_err(Failure::new)?;
        answered.run(task, accuracy, limits)
    }
}

#[pymethods]
impl GradientCases {
    /// Reads the cases of these names.
    #[new]
    fn new(names: BTreeSet<String>) -> PyResult<Self> {
        Ok(Self { all: embedded(|it| names.contains(it)).map_err(value)? })
    }

    #[getter]
    fn names(&self) -> Vec<String> {
        self.all.iter().map(|it| it.name.clone()).collect()
    }

    /// The question of a case, as the JSON that `percuss export` writes.
    fn ask(&self, name: &str) -> PyResult<String> {
        let case = self.all.iter().find(|it| it.name == name);
        let case = case.ok_or_else(|| PyKeyError::new_err(name.to_owned()))?;
        let task = case.task().map_err(|failure| value(failure.reason))?;
        serde_json::to_string(&CaseFile::new(name, &task, case.parameters())).map_err(value)
    }

    /// The verdicts on answers, which are taken together where they have one name.
    fn judge(&self, py: Python<'_>, answers: Vec<Answers>) -> PyResult<Vec<VerdictRow>> {
        let mut methods: BTreeMap<&str, Vec<(Answerer, &Answers)>> = BTreeMap::new();
        for it in &answers {
            let answerer = it.answerer()?;
            methods.entry(answerer.name).or_default().push((answerer, it));
        }
        let judged = interruptible(py, &Progress::default(), |stop| {
            let verdicts = |case: &GradientCase| -> Result<Vec<VerdictRow>, Failure> {
                stop.look();
                let reference = Reference::new(case.clone())?;
                let rows = methods.iter().flat_map(|(name, answers)| {
                    let answered = answers
                        .iter()
                        .map(|(answerer, it)| (it.tolerance(), it.engine(*answerer, &case.name)));
                    let engine = AtTolerances { answered: answered.collect() };
                    let tolerances: Vec<f64> =
                        engine.answered.iter().map(|(tolerance, _)| *tolerance).collect();
                    let judged = one(&reference, &engine, &tolerances).into_iter();
                    judged.map(|it| row(name, &case.name, it)).collect::<Vec<_>>()
                });
                Ok(rows.collect())
            };
            let rows: Result<Vec<_>, Failure> = self.all.par_iter().map(verdicts).collect();
            rows
        })?;
        let rows = judged.map_err(|failure| value(failure.reason))?;
        Ok(rows.into_iter().flatten().collect())
    }
}

fn row(engine: &str, case: &str, judged: Judged) -> VerdictRow {
    let Judged { wrt, tolerance, verdict, missing_term, why } = judged;
    let term = missing_term.map(|it| it.as_str());
    (engine.to_owned(), case.to_owned(), wrt, tolerance, verdict.as_str(), term, why)
}
