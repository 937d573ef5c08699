//! The piecewise-affine system that a verb runs: a file or a name, with parameters and a start that
//! flags may replace. Verbs of the dynamics mean the impact oscillator without one.

use super::model::ModelFlags;
use super::names;
use super::parse;
use super::terminal::note;
use crate::case::{FileError, parse_system_case, read_text};
use crate::sweep::SweepPoint;
use crate::systems::{SYSTEMS, named};
use anyhow::{Context, Result, anyhow, bail};
use clap::Args;
use percuss::System;
use percuss::affine::{SystemError, SystemFile};
use std::path::{Path, PathBuf};

/// The place in which a flag of SYSTEM is accepted.
pub(in crate::cli) const FLAG_PLACE: &str =
    "accepted is it after a *.system.toml, or a name that percuss systems prints";

/// SYSTEM, for verbs that mean the impact oscillator without it.
#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct SystemChoice {
    /// A *.system.toml, or a name that `percuss systems` prints; without it the impact oscillator
    #[arg(value_name = "SYSTEM")]
    system: Option<PathBuf>,
    #[command(flatten)]
    flags: SystemFlags,
}

/// The flags that replace parameters and start of a system.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "SYSTEM and its start")]
pub(in crate::cli) struct SystemFlags {
    /// Replaces the value of a parameter
    #[arg(long, value_name = "NAME=VALUE", value_parser = parse::parameter_value, allow_hyphen_values = true)]
    set: Vec<(String, f64)>,
    /// A file whose [start] replaces the system's, and whose [parameters] replace some; a case of
    /// the system serves too
    #[arg(long, value_name = "FILE.toml")]
    start: Option<PathBuf>,
    /// Replaces a state of the start, or its time t, by a number or an expression
    #[arg(long, value_name = "STATE=VALUE", value_parser = parse::start_value, allow_hyphen_values = true)]
    at: Vec<[String; 2]>,
    /// Replaces the mode of the start
    #[arg(long, value_name = "NAME")]
    mode: Option<String>,
}

/// A system that was chosen, whose parameters can be set again.
pub(in crate::cli) struct ChosenSystem {
    pub(in crate::cli) file: SystemFile,
    /// The text of the file.
    text: String,
    path: PathBuf,
    /// The states of the start that `--at` replaced, with their values.
    at: Vec<[String; 2]>,
}

impl SystemChoice {
    /// The system that is chosen, if one is; its flags and those of the oscillator's model are
    /// refused each without what they belong to.
    pub(in crate::cli) fn chosen(&self, model: &ModelFlags) -> Result<Option<ChosenSystem>> {
        let Some(path) = &self.system else {
            self.flags.refuse()?;
            return Ok(None);
        };
        if let Some(flag) = model.first_given() {
            bail!(
                "{flag} is the impact oscillator's: with SYSTEM {}, accepted are --set, --start, \
                 --at and --mode",
                path.display()
            );
        }
        self.flags.system(path).map(Some)
    }
}

impl SystemChoice {
    /// Whether `--set` replaces the value of a parameter.
    pub(in crate::cli) fn sets(&self, parameter: &str) -> bool {
        self.flags.set.iter().any(|it| it.0 == parameter)
    }

    /// Refuses `--set` of the parameter that `--parameter` varies: it would have no effect.
    pub(in crate::cli) fn check_varied(&self, varied: &str) -> Result<()> {
        if let Some((name, value)) = self.flags.set.iter().find(|it| it.0 == varied) {
            bail!(
                "--set {name}={value} has no effect with --parameter {name}, which goes from --from \
                 to --to; accepted is one of the two"
            );
        }
        Ok(())
    }
}

impl SystemFlags {
    /// The system of a path or of a name, with what the flags replace.
    pub(in crate::cli) fn system(&self, path: &Path) -> Result<ChosenSystem> {
        let (mut file, text) = read(path)?;
        if let Some(path) = &self.start {
            replace_start(&mut file, path).context("--start")?;
        }
        for (name, value) in &self.set {
            file.set(name, *value, &format!("--set {name}={value}"))?;
        }
        for [name, value] in &self.at {
            file.set_start(name, value, &format!("--at {name}={value}"))?;
        }
        if let Some(mode) = &self.mode {
            file.set_start_mode(mode, "--mode");
        }
        Ok(ChosenSystem { file, text, path: path.to_owned(), at: self.at.clone() })
    }

    /// Refuses the flags where no system is chosen.
    fn refuse(&self) -> Result<()> {
        let set = self.set.first().map(|(name, value)| format!("--set {name}={value}"));
        let start = self.start.as_ref().map(|it| format!("--start {}", it.display()));
        let at = self.at.first().map(|[name, value]| format!("--at {name}={value}"));
        let mode = self.mode.as_ref().map(|it| format!("--mode {it}"));
        match set.or(start).or(at).or(mode) {
            Some(flag) => bail!("{flag} has no effect without SYSTEM: {FLAG_PLACE}"),
            None => Ok(()),
        }
    }
}

impl ChosenSystem {
    /// The system with the values of a sweep's point.
    pub(in crate::cli) fn at(&self, point: &SweepPoint) -> Result<Self> {
        let mut file = self.file.clone();
        for (name, value) in &point.values {
            file.set(name, *value, &format!("{name} = {value}"))?;
        }
        let Self { text, path, at, .. } = self;
        Ok(Self { file, text: text.clone(), path: path.clone(), at: at.clone() })
    }

    /// The system where a parameter, which a verb varies, has a value.
    pub(in crate::cli) fn system_at(
        &self,
        parameter: &str,
        value: f64,
    ) -> Result<System, SystemError> {
        let mut file = self.file.clone();
        file.set(parameter, value, &format!("{parameter} = {value}"))?;
        file.system()
    }

    /// Says which replaced states of the start the axes of a grid of starts take the place of.
    pub(in crate::cli) fn note_replaced_by_grid(&self, system: &System, axes: [usize; 2]) {
        let is_axis = |name: &String| axes.iter().any(|it| system.states[*it] == *name);
        for [name, value] in self.at.iter().filter(|[name, _]| is_axis(name)) {
            note(&format!(
                "--at {name}={value} is not used: starts are the centres of the grid's cells"
            ));
        }
    }

    /// The text of the system's file, as it was before flags replaced anything.
    pub(in crate::cli) fn text(&self) -> &str {
        &self.text
    }

    /// The system, which has a start.
    pub(in crate::cli) fn system(&self) -> Result<System> {
        let system = self.file.system()?;
        if system.start.is_none() {
            return Err(self.without_start(&system));
        }
        Ok(system)
    }

    /// The error of a system that starts nowhere; those inside the program start somewhere.
    fn without_start(&self, system: &System) -> anyhow::Error {
        let states = system.states.join(", ");
        let accepted =
            format!("one with mode and the states {states}, here or in --start FILE.toml");
        let name = self.path.display().to_string();
        FileError::lacks(&name, &self.text, "start", &accepted).into()
    }
}

/// The names of a system's events, each once.
pub(in crate::cli) fn event_names(system: &System) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for mode in &system.modes {
        let until = mode.until.iter().map(|it| it.name.as_str());
        for name in until.chain(mode.watch.iter().map(|it| it.name.as_str())) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
    }
    names
}

/// Takes start and parameters from a file, or from a case of the same system.
fn replace_start(file: &mut SystemFile, path: &Path) -> Result<()> {
    let text = read_text(path)?;
    let name = path.display().to_string();
    let is_case = text.parse::<toml::Table>().is_ok_and(|it| it.contains_key("case"));
    if is_case {
        let case = parse_system_case(&name, &text, path.parent())?;
        if case.system.name != file.name() {
            let (other, own) = (case.system.name, file.name());
            bail!("{name}: a case of {other} is not accepted here: one of {own} is");
        }
    }
    Ok(file.replace_from(&name, &text, is_case)?)
}

/// The file of this path, or of the system of this name, with its text.
fn read(system: &Path) -> Result<(SystemFile, String)> {
    let name = system.display().to_string();
    if let Some(text) = named(&name).filter(|_| !system.is_file()) {
        return Ok((SystemFile::read(&name, text)?, text.to_owned()));
    }
    let text = read_text(system).map_err(|error| {
        if system.is_file() {
            return anyhow!(error);
        }
        let near = names::nearest_names(&name, SYSTEMS.iter().map(|(name, _)| *name));
        let near = match near.is_empty() {
            true => String::new(),
            false => format!("; the nearest names are {}", near.join(", ")),
        };
        anyhow!("{error}, or a name that percuss systems lists{near}")
    })?;
    Ok((SystemFile::read(&name, &text)?, text))
}
