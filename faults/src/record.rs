//! The table of all faults tried.

use crate::fault::Fault;
use anyhow::{Context, Result};
use std::fmt;
use std::fs::File;
use std::path::Path;

/// What became of a fault.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// This test failed.
    Caught(String),
    /// This test program did not end in its time.
    Timeout(String),
    /// This test program ended before its tests did.
    Crash(String),
    /// No test failed.
    Survived,
}

impl Verdict {
    const fn word(&self) -> &'static str {
        match self {
            Self::Caught(_) => "caught",
            Self::Timeout(_) => "timeout",
            Self::Crash(_) => "crash",
            Self::Survived => "survived",
        }
    }

    fn by(&self) -> &str {
        match self {
            Self::Caught(by) | Self::Timeout(by) | Self::Crash(by) => by,
            Self::Survived => "",
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(format!("{} {}", self.word(), self.by()).trim_end())
    }
}

/// The file that the table is written to.
pub struct Table(csv::Writer<File>);

impl Table {
    /// A new table with its header.
    pub fn create(path: &Path) -> Result<Self> {
        let mut writer =
            csv::Writer::from_path(path).with_context(|| path.display().to_string())?;
        writer.write_record([
            "number",
            "file",
            "line",
            "operator",
            "original",
            "replacement",
            "verdict",
            "by",
        ])?;
        writer.flush()?;
        Ok(Self(writer))
    }

    /// Adds a line, which can be read at once.
    pub fn add(&mut self, fault: &Fault, verdict: &Verdict) -> Result<()> {
        let Fault { number, file, line, operator, original, replacement, .. } = fault;
        let (number, line) = (number.to_string(), line.to_string());
        self.0.write_record([
            number.as_str(),
            file,
            &line,
            operator.name(),
            original,
            replacement,
            verdict.word(),
            verdict.by(),
        ])?;
        Ok(self.0.flush()?)
    }
}

/// Prints how many faults were caught, and those that were not as a table in Markdown.
pub fn summary(verdicts: &[(Fault, Verdict)]) {
    let survivors: Vec<_> =
        verdicts.iter().filter(|(_, verdict)| *verdict == Verdict::Survived).collect();
    let (all, caught) = (verdicts.len(), verdicts.len() - survivors.len());
    println!("{caught} of {all} faults caught ({:.1} %)", 100.0 * caught as f64 / all as f64);
    if survivors.is_empty() {
        return;
    }
    println!("\n| fault | place | original | replacement |\n|---|---|---|---|");
    for (Fault { number, file, line, original, replacement, .. }, _) in survivors {
        // A bar would end the cell.
        let [original, replacement] = [original, replacement].map(|it| it.replace('|', "\\|"));
        println!("| {number} | `{file}:{line}` | `{original}` | `{replacement}` |");
    }
}
