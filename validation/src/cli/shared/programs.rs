//! `--programs FILE.toml`: engines that are programs of any language.

use super::terminal::note;
use crate::case::Shortcoming;
use crate::engine::Engine;
use crate::integrators;
use anyhow::{Context, Result};
use clap::Args;
use std::path::PathBuf;

/// Engines beside those of this program.
#[derive(Args)]
pub(in crate::cli) struct ProgramFlags {
    /// Adds the engines of the programs that this file names
    #[arg(long, value_name = "FILE.toml")]
    programs: Option<PathBuf>,
}

/// The programs of this run; they are ended when it is dropped.
#[must_use]
pub(in crate::cli) struct StartedPrograms(());

impl Drop for StartedPrograms {
    fn drop(&mut self) {
        percuss_programs::end_all();
    }
}

impl ProgramFlags {
    /// The expected failures of the programs.
    pub(in crate::cli) fn shortcomings(&self) -> Result<Vec<Shortcoming>> {
        match &self.programs {
            Some(file) => percuss_programs::shortcomings(file).context("--programs"),
            None => Ok(Vec::new()),
        }
    }

    /// Starts the programs and adds their engines to all others; no engine may have been asked for
    /// before. One that cannot be started has an engine by its name, whose rows say why.
    pub(in crate::cli) fn start(&self) -> Result<StartedPrograms> {
        let started = StartedPrograms(());
        let Some(file) = &self.programs else { return Ok(started) };
        crate::unfinished::watch();
        let mut engines: Vec<&'static dyn Engine> = Vec::new();
        for program in percuss_programs::read(file).context("--programs")? {
            let own = program.start().unwrap_or_else(|why| {
                note(&why.to_string());
                vec![why.stand_in()]
            });
            // They are engines until the program ends, like its own.
            engines.extend(own.into_iter().map(|it| &*Box::leak(Box::new(it)) as &dyn Engine));
        }
        integrators::add(&engines).context("--programs")?;
        Ok(started)
    }
}
