//! The plan of a sweep, read from a TOML file.

use super::{SweepAxis, SweepPoint};
use crate::systems::named;
use anyhow::{Result, anyhow, bail};
use percuss::Parameter;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The most points of a plan.
const MAX_POINTS: u64 = 1 << 24;
/// The most shards of a plan: each is a file in one folder.
const MAX_SHARDS: u32 = 100_000;

/// Flags of a verb that say where and how it writes, which the sweep decides.
const OUTPUT_FLAGS: [&str; 11] = [
    "output", "format", "show", "range", "size", "dpi", "threads", "quiet", "color", "help",
    "version",
];

/// Flags of a verb that are given once for each of their values.
const REPEATED_FLAGS: [&str; 2] = ["set", "at"];
/// Flags of a verb that name a file, which counts by what is in it, wherever it lies.
const FILE_FLAGS: [&str; 2] = ["problem", "start"];

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
    /// A *.system.toml, relative to the plan, or a name of a system; without it the plan is of the
    /// impact oscillator.
    system: Option<String>,
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
    /// The verb's SYSTEM, if the plan has one, and its flags, as words of its command line.
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
    /// The texts of the files that the plan names.
    files: &'a BTreeMap<&'static str, String>,
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
            values: values.map(|(it, step)| (it.parameter.clone(), it.value(step))).collect(),
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
        let Self { sweep: PlanHead { verb, shards, first, system }, fixed, axis: axes } = self;
        if !(1..=MAX_SHARDS).contains(&shards) {
            bail!("shards = {shards} is not accepted: accepted are 1 to {MAX_SHARDS}");
        }
        check_axes(&axes, &fixed)?;
        if system.is_none() {
            check_parameters(&axes, &fixed)?;
        }
        let mut read = PlanWords::default();
        if let Some(system) = &system {
            read.system(system, folder);
        }
        for (name, value) in &fixed {
            read.add_fixed(name, value, folder)?;
        }
        let PlanWords { places, flags, off, files } = read;
        let hash = Hashed { verb: &verb, shards, words: &flags, axes: &axes, files: &files };
        let hash = digest(&serde_json::to_vec(&hash)?);
        Ok(Plan { verb, shards, first, words: [places, flags].concat(), off, axes, hash })
    }
}

/// The words of a verb's command line, as a plan gives them.
#[derive(Default)]
struct PlanWords {
    /// Words that say where files are: the system first.
    places: Vec<String>,
    /// All other words.
    flags: Vec<String>,
    /// Switches that are stated to be off.
    off: Vec<String>,
    /// The texts of the files.
    files: BTreeMap<&'static str, String>,
}

impl PlanWords {
    /// Takes up the system, a file or a name. The verb says what is wrong with one that is neither.
    fn system(&mut self, system: &str, folder: &Path) {
        let path = folder.join(system);
        let (word, text) = match path.is_file() {
            true => (path.display().to_string(), fs::read_to_string(&path).ok()),
            false => (system.to_owned(), named(system).map(str::to_owned)),
        };
        self.places.push(word);
        self.files.insert("system", text.unwrap_or_default());
    }

    /// Takes up an entry of `[fixed]`.
    fn add_fixed(&mut self, name: &str, value: &toml::Value, folder: &Path) -> Result<()> {
        if OUTPUT_FLAGS.contains(&name) {
            bail!("[fixed] {name} is not accepted: the sweep decides where and how it writes");
        }
        if let Some(name) = FILE_FLAGS.into_iter().find(|it| *it == name) {
            let path = folder.join(value.as_str().unwrap_or_default());
            let read = fs::read_to_string(&path);
            let text = read.map_err(|error| anyhow!("[fixed] {name} {value}: {error}"))?;
            self.files.insert(name, text);
            self.places.push(format!("--{name}={}", path.display()));
            return Ok(());
        }
        match value {
            toml::Value::Boolean(true) => self.flags.push(format!("--{name}")),
            toml::Value::Boolean(false) => self.off.push(name.to_owned()),
            value if REPEATED_FLAGS.contains(&name) => {
                self.flags.extend(repeated_flag(name, value)?)
            }
            toml::Value::Array(values) => {
                let texts: Result<Vec<_>> = values.iter().map(|it| plain(name, it)).collect();
                self.flags.push(format!("--{name}={}", texts?.join(",")));
            }
            value => self.flags.push(format!("--{name}={}", plain(name, value)?)),
        }
        Ok(())
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
        if fixed.get("parameter").and_then(toml::Value::as_str) == Some(name) {
            bail!("{name} is both an axis and the verb's own parameter: accepted is one of them");
        }
    }
    if axes.len() == 2 && axes[0].parameter == axes[1].parameter {
        bail!("both axes are {}: accepted are two parameters", axes[0].parameter);
    }
    let points: u64 = axes.iter().map(|axis| u64::from(axis.steps)).product();
    if points > MAX_POINTS {
        bail!("the axes span {points} points: accepted are at most {MAX_POINTS}");
    }
    Ok(())
}

/// Refuses an axis that is no parameter of the impact oscillator, or that `[fixed]` sets as well.
fn check_parameters(axes: &[SweepAxis], fixed: &toml::Table) -> Result<()> {
    for SweepAxis { parameter: name, .. } in axes {
        if name.parse::<Parameter>().is_err() {
            bail!(
                "axis {name} is not accepted: accepted are a, b, xi, omega, g, phi, and with system \
                 in [sweep] a parameter of it"
            );
        }
        if fixed.contains_key(name) {
            bail!("{name} is both an axis and in [fixed]: accepted is one of them");
        }
    }
    Ok(())
}

/// A flag once for each entry of a table, or for each text of a list.
fn repeated_flag(name: &str, value: &toml::Value) -> Result<Vec<String>> {
    let entry = |text: String| format!("--{name}={text}");
    match value {
        toml::Value::Table(entries) => entries
            .iter()
            .map(|(key, value)| Ok(entry(format!("{key}={}", plain(name, value)?))))
            .collect(),
        toml::Value::Array(values) => values.iter().map(|it| Ok(entry(plain(name, it)?))).collect(),
        value => Ok(vec![entry(plain(name, value)?)]),
    }
}

fn plain(name: &str, value: &toml::Value) -> Result<String> {
    match value {
        toml::Value::String(text) => Ok(text.clone()),
        toml::Value::Integer(number) => Ok(number.to_string()),
        toml::Value::Float(number) => Ok(number.to_string()),
        _ => bail!(
            "[fixed] {name} is not accepted: accepted are numbers, texts, true, false, lists of \
             numbers, and for set and at tables"
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
