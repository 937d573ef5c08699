//! The plan of a sweep, read from a TOML file.

use super::{SweepAxis, SweepPoint};
use anyhow::{Result, anyhow, bail};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fs;
use std::path::Path;

/// Most points of a plan.
const MOST_POINTS: u64 = 1 << 24;
/// Most shards of a plan: each is a file in one folder.
const MOST_SHARDS: u32 = 100_000;

/// Flags of a verb that say where and how it writes, which the sweep decides.
const NOT_FIXED: [&str; 11] = [
    "output", "format", "show", "range", "size", "dpi", "threads", "quiet", "color", "help",
    "version",
];

/// A plan as its file has it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlanFile {
    sweep: PlanHead,
    #[serde(default)]
    fixed: toml::Table,
    #[serde(default)]
    axis: Vec<SweepAxis>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct PlanHead {
    verb: String,
    shards: u32,
    /// The index that the first task of an array has, where an engine counts from another number.
    first: Option<u32>,
}

/// A plan that has been checked.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The verb that is swept.
    pub verb: String,
    /// The number of shards.
    pub shards: u32,
    /// The index of the first task of an engine's array, where the plan states one.
    pub first: Option<u32>,
    /// The verb's flags, as words of its command line.
    pub words: Vec<String>,
    /// The verb's switches that are stated to be off.
    pub off: Vec<String>,
    /// What varies; the last axis fastest.
    pub axes: Vec<SweepAxis>,
    /// The hash of all that decides the results and the shards, in hexadecimal digits.
    pub hash: String,
}

/// All that a plan's hash is of; comments and the order of lines are not.
#[derive(Serialize)]
struct Hashed<'a> {
    verb: &'a str,
    shards: u32,
    words: &'a [String],
    axes: &'a [SweepAxis],
    problem: Option<&'a str>,
}

impl Plan {
    /// Reads a plan.
    ///
    /// # Errors
    /// Names the file, the culprit and what is accepted.
    pub fn read(path: &Path) -> Result<Self> {
        let shown = path.display();
        let text = fs::read_to_string(path).map_err(|error| {
            anyhow!("--plan {shown} cannot be read ({error}); accepted is a TOML file")
        })?;
        let file: PlanFile = toml::from_str(&text)
            .map_err(|error| anyhow!("--plan {shown}, {}", objection(&text, &error)))?;
        let folder = path.parent().unwrap_or(Path::new(""));
        file.check(folder).map_err(|error| anyhow!("--plan {shown}: {error}"))
    }

    /// The number of points of the axes.
    #[must_use]
    pub fn points(&self) -> u64 {
        self.axes.iter().map(|axis| u64::from(axis.steps)).product()
    }

    /// A point by its number.
    #[must_use]
    pub fn point(&self, number: u64) -> SweepPoint {
        let steps = self.steps_of(number);
        let values = self.axes.iter().zip(steps);
        SweepPoint {
            number,
            values: values.map(|(it, step)| (it.parameter, it.value(step))).collect(),
        }
    }

    /// The step of each axis at a point.
    #[must_use]
    pub fn steps_of(&self, number: u64) -> Vec<u32> {
        let mut rest = number;
        let mut steps: Vec<u32> = self
            .axes
            .iter()
            .rev()
            .map(|axis| {
                let step = rest % u64::from(axis.steps);
                rest /= u64::from(axis.steps);
                step as u32
            })
            .collect();
        steps.reverse();
        steps
    }
}

impl PlanFile {
    /// Checks all that can be checked without the verb.
    fn check(self, folder: &Path) -> Result<Plan> {
        let Self { sweep: PlanHead { verb, shards, first }, fixed, axis: axes } = self;
        if !(1..=MOST_SHARDS).contains(&shards) {
            bail!("shards = {shards} is not accepted: accepted are 1 to {MOST_SHARDS}");
        }
        check_axes(&axes, &fixed)?;
        let mut problem = None;
        let (mut words, mut off) = (Vec::new(), Vec::new());
        for (name, value) in &fixed {
            if NOT_FIXED.contains(&name.as_str()) {
                bail!("[fixed] {name} is not accepted: the sweep decides where and how it writes");
            }
            if name == "problem" {
                let path = folder.join(value.as_str().unwrap_or_default());
                let read = fs::read_to_string(&path);
                let text = read.map_err(|error| anyhow!("[fixed] problem {value}: {error}"))?;
                problem = Some(text);
                words.push(format!("--problem={}", path.display()));
            } else if let Some(word) = word(name, value)? {
                words.push(word);
            } else {
                off.push(name.clone());
            }
        }
        // A problem file counts by what is in it, wherever it lies.
        let hashed: Vec<_> =
            words.iter().filter(|it| !it.starts_with("--problem=")).cloned().collect();
        let problem = problem.as_deref();
        let hash = Hashed { verb: &verb, shards, words: &hashed, axes: &axes, problem };
        let hash = digest(&serde_json::to_vec(&hash)?);
        Ok(Plan { verb, shards, first, words, off, axes, hash })
    }
}

/// What the reader objects to in a plan, with the line that it means.
fn objection(text: &str, error: &toml::de::Error) -> String {
    let before = error.span().map_or("", |span| &text[..span.start]);
    let number = before.matches('\n').count();
    let line = text.lines().nth(number).unwrap_or_default().trim();
    let line = if line.is_empty() { String::new() } else { format!(", {line}") };
    let message = error.message().replace("expected f64", "expected a number");
    let message = message.replace("expected u32", "expected an integer, 0 to 4294967295");
    format!("line {}{line}: {}", number + 1, message.replace('\n', " "))
}

fn check_axes(axes: &[SweepAxis], fixed: &toml::Table) -> Result<()> {
    if !(1..=2).contains(&axes.len()) {
        bail!("there are {} [[axis]]: accepted are one or two", axes.len());
    }
    for SweepAxis { parameter, from, to, steps } in axes {
        let name = parameter.as_str();
        for (end, value) in [("from", from), ("to", to)] {
            if !value.is_finite() {
                bail!("axis {name}: {end} = {value} is not accepted: accepted are finite numbers");
            }
        }
        if *steps == 0 {
            bail!("axis {name}: steps = 0 is not accepted: accepted are 1 or more");
        }
        if *steps == 1 && from != to {
            bail!("axis {name}: to = {to} has no effect with steps = 1; accepted is {from}");
        }
        if fixed.contains_key(name) {
            bail!("{name} is both an axis and in [fixed]: accepted is one of them");
        }
        if fixed.get("parameter").and_then(toml::Value::as_str) == Some(name) {
            bail!("{name} is both an axis and the verb's own parameter: accepted is one of them");
        }
    }
    if axes.len() == 2 && axes[0].parameter == axes[1].parameter {
        bail!("both axes are {}: accepted are two parameters", axes[0].parameter.as_str());
    }
    let points: u64 = axes.iter().map(|axis| u64::from(axis.steps)).product();
    if points > MOST_POINTS {
        bail!("the axes span {points} points: accepted are at most {MOST_POINTS}");
    }
    Ok(())
}

/// A fixed flag as a word of a command line; none for a switch that is off.
fn word(name: &str, value: &toml::Value) -> Result<Option<String>> {
    let text = match value {
        toml::Value::Boolean(on) => return Ok(on.then(|| format!("--{name}"))),
        toml::Value::Array(values) => {
            let texts: Result<Vec<_>> = values.iter().map(|it| plain(name, it)).collect();
            texts?.join(",")
        }
        value => plain(name, value)?,
    };
    Ok(Some(format!("--{name}={text}")))
}

fn plain(name: &str, value: &toml::Value) -> Result<String> {
    match value {
        toml::Value::String(text) => Ok(text.clone()),
        toml::Value::Integer(number) => Ok(number.to_string()),
        toml::Value::Float(number) => Ok(number.to_string()),
        _ => bail!(
            "[fixed] {name} is not accepted: accepted are numbers, texts, true, false and lists of \
             numbers"
        ),
    }
}

/// The SHA-256 of some bytes, in hexadecimal digits.
pub(super) fn digest(bytes: &[u8]) -> String {
    hexadecimal(&Sha256::digest(bytes))
}

/// Bytes as hexadecimal digits.
pub(super) fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
