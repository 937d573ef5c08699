//! The history: a line of JSON a workload and recorded version, oldest first, appended to and never
//! rewritten.

use crate::provenance::Build;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The file in which the repository keeps the history.
pub const FILE: &str = "benches/history.jsonl";

/// One workload of one recorded version.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HistoryRecord {
    /// The format's number.
    pub schema: u32,
    /// The version.
    pub percuss: String,
    /// The commit, where that is known.
    pub commit: Option<String>,
    /// The compiler.
    pub rustc: String,
    /// The processor for which the program was compiled.
    pub target_cpu: String,
    /// The processor it ran on.
    pub cpu: String,
    /// The workload.
    pub bench: String,
    /// Instructions per unit, where they were counted.
    pub instructions: Option<f64>,
    /// The least time per unit, ns.
    pub best_ns: f64,
    /// The median over the rounds of the best time per unit, ns.
    pub median_ns: f64,
    /// The least time of the chained floor in the same rounds, ns.
    pub floor_ns: f64,
    /// Floors per unit: the quotient of least times in the first half of the rounds.
    pub floors: f64,
    /// Floors per unit in the second half of the rounds: the quotient of least times.
    pub floors_again: f64,
    /// Closed-form evaluations per event.
    pub evaluations_per_switch: f64,
    /// max(|dp|, |dy|, |dq|) of the case's run.
    pub state_error_max: f64,
}

/// The measured figures of a workload.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs, reason = "as in `Record`")]
pub struct Figures {
    pub instructions: Option<f64>,
    pub best_ns: f64,
    pub median_ns: f64,
    pub floor_ns: f64,
    pub floors: f64,
    pub floors_again: f64,
    pub evaluations_per_switch: f64,
    pub state_error_max: f64,
}

impl HistoryRecord {
    /// The line of a program.
    #[must_use]
    pub fn new(build: Build, bench: &str, figures: Figures) -> Self {
        let Build { schema, percuss, commit, rustc, cpu, target_cpu } = build;
        let Figures { instructions, best_ns, median_ns, .. } = figures;
        let Figures { floor_ns, floors, floors_again, .. } = figures;
        let Figures { evaluations_per_switch, state_error_max, .. } = figures;
        Self {
            schema,
            percuss,
            commit,
            rustc,
            target_cpu,
            cpu,
            bench: bench.to_owned(),
            instructions,
            best_ns,
            median_ns,
            floor_ns,
            floors,
            floors_again,
            evaluations_per_switch,
            state_error_max,
        }
    }

    /// Whether it is of the version that a text names: its number, or its commit's first seven
    /// digits or more.
    fn is_of(&self, version: &str) -> bool {
        let is_commit = |commit: &String| version.len() >= 7 && commit.starts_with(version);
        self.percuss == version || self.commit.as_ref().is_some_and(is_commit)
    }

    /// Whether two records belong to the same build.
    #[must_use]
    pub fn is_with(&self, other: &Self) -> bool {
        (&self.percuss, &self.commit) == (&other.percuss, &other.commit)
    }
}

/// A history.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History {
    /// The lines of the history.
    pub records: Vec<HistoryRecord>,
}

impl History {
    /// Reads a history; a file that is not there is an empty history.
    ///
    /// # Errors
    /// One line that names the file, and the line that is not accepted.
    pub fn read(path: &Path) -> Result<Self, String> {
        match std::fs::read_to_string(path) {
            Ok(text) => Self::parse(&text).map_err(|what| format!("{}:{what}", path.display())),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(Self::default()),
            Err(error) => Err(format!(
                "{}: cannot be read ({error}); accepted is a history that bench record wrote",
                path.display()
            )),
        }
    }

    fn parse(text: &str) -> Result<Self, String> {
        let line = |(i, line): (usize, &str)| {
            let refused = |what: String| {
                format!("{}: {what}: accepted is a line that bench record wrote", i + 1)
            };
            let record: HistoryRecord =
                serde_json::from_str(line).map_err(|error| refused(error.to_string()))?;
            let times = [record.best_ns, record.median_ns, record.floor_ns];
            let floors = [record.floors, record.floors_again];
            let counts = [record.instructions.unwrap_or(1.0), record.evaluations_per_switch];
            let all = times.into_iter().chain(floors).chain(counts);
            match all.into_iter().find(|it| !(it.is_finite() && *it > 0.0)) {
                Some(odd) => Err(refused(format!("{odd} is not positive"))),
                None if record.schema != 1 => Err(refused(format!("schema {}", record.schema))),
                None => Ok(record),
            }
        };
        let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
        Ok(Self { records: lines.map(line).collect::<Result<_, _>>()? })
    }

    /// The history's text, as a file holds it.
    ///
    /// # Errors
    /// What the serializer says; never of numbers that were measured.
    pub fn text(&self) -> Result<String, String> {
        let line = |it: &HistoryRecord| serde_json::to_string(it).map(|line| line + "\n");
        self.records.iter().map(line).collect::<Result<_, _>>().map_err(|error| error.to_string())
    }

    /// The last record of each workload of a version, in the order of its workloads.
    #[must_use]
    pub fn version(&self, version: &str) -> Vec<&HistoryRecord> {
        let mut found: Vec<&HistoryRecord> = Vec::new();
        for record in self.records.iter().filter(|it| it.is_of(version)) {
            match found.iter_mut().find(|it| it.bench == record.bench) {
                Some(earlier) => *earlier = record,
                None => found.push(record),
            }
        }
        found
    }

    /// The versions, as they can be named.
    #[must_use]
    pub fn versions(&self) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for record in &self.records {
            let name = match &record.commit {
                Some(commit) => commit.chars().take(10).collect(),
                None => record.percuss.clone(),
            };
            if !names.contains(&name) {
                names.push(name);
            }
        }
        names
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(commit: &str, bench: &str, best_ns: f64) -> HistoryRecord {
        let figures = Figures {
            instructions: None,
            best_ns,
            median_ns: 1.1 * best_ns,
            floor_ns: 31.25,
            floors: best_ns / 31.25,
            floors_again: best_ns / 31.3,
            evaluations_per_switch: 1.05,
            state_error_max: 1e-13,
        };
        HistoryRecord::new(Build::new(commit, "rustc", "any"), bench, figures)
    }

    #[test]
    fn what_is_written_is_what_is_read() {
        let counted =
            HistoryRecord { instructions: Some(1234.5), ..record("bbbbbbbbb", "two", 0.1 + 0.2) };
        let history = History { records: vec![record("aaaaaaaaa", "one", 1e-3 / 3.0), counted] };
        let text = history.text().unwrap_or_default();
        assert_eq!(text.lines().count(), 2);
        assert_eq!(History::parse(&text), Ok(history));
    }

    #[test]
    fn a_version_is_named_by_number_or_commit_and_its_last_record_counts() {
        let records = vec![
            record("aaaaaaa1", "one", 1.0),
            record("aaaaaaa1", "two", 2.0),
            record("aaaaaaa2", "one", 3.0),
            record("aaaaaaa1", "one", 4.0),
        ];
        let history = History { records };
        let times = |version: &str| {
            history.version(version).iter().map(|it| it.best_ns).collect::<Vec<_>>()
        };
        assert_eq!(times("aaaaaaa1"), [4.0, 2.0]);
        assert_eq!(times("aaaaaaa2"), [3.0]);
        assert_eq!(times(env!("CARGO_PKG_VERSION")), [4.0, 2.0]);
        // Fewer than seven digits name no commit.
        assert!(times("aaaaaa").is_empty() && times("").is_empty() && times("9.9.9").is_empty());
        assert_eq!(history.versions(), ["aaaaaaa1", "aaaaaaa2"]);
    }

    #[test]
    fn a_line_that_is_not_accepted_is_named() {
        let good = History { records: vec![record("a", "one", 1.0)] }.text().unwrap_or_default();
        let odd = [
            ("{".to_owned(), "EOF"),
            (good.replace("\"schema\":1", "\"schema\":2"), "schema 2"),
            (good.replace("\"best_ns\":1.0", "\"best_ns\":0.0"), "not positive"),
            (good.replace("\"best_ns\":1.0", "\"best_ns\":null"), "f64"),
            (good.replace("\"bench\"", "\"bnech\""), "bnech"),
        ];
        for (line, wanted) in odd {
            let error = History::parse(&format!("{good}{line}")).err().unwrap_or_default();
            assert!(error.starts_with("2: ") && error.contains(wanted), "{error}");
        }
        assert_eq!(History::parse("\n\n").map(|it| it.records.len()), Ok(0));
    }
}
