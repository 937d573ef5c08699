//! `engines`: what can be run.

use super::output::Destination;
use crate::engine::{self, Declaration, Location};
use anyhow::Result;
use clap::{Args, ValueEnum};
use serde::Serialize;
use std::path::PathBuf;

/// List the engines
#[derive(Args)]
pub(super) struct Arguments {
    /// Format of the list
    #[arg(long, value_enum, default_value_t = Format::Csv)]
    format: Format,
    /// Where the list goes; - is stdout
    #[arg(long, value_name = "PATH")]
    output: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Format {
    Csv,
    Json,
}

#[derive(Serialize)]
struct Line {
    name: &'static str,
    library: &'static str,
    version: String,
    method: &'static str,
    events: Location,
    available: bool,
}

#[derive(Serialize)]
struct List {
    schema: u32,
    percuss: &'static str,
    engines: Vec<Line>,
}

pub(super) fn run(arguments: &Arguments) -> Result<()> {
    let lines = engine::all().iter().map(|engine| {
        let Declaration { name, library, version, method, events, .. } = engine.declaration();
        Line { name, library, version, method, events, available: engine.available().is_ok() }
    });
    let list = List { schema: 1, percuss: env!("CARGO_PKG_VERSION"), engines: lines.collect() };
    Destination::new(arguments.output.as_deref()).write(|out| {
        match arguments.format {
            Format::Json => {
                serde_json::to_writer_pretty(&mut *out, &list).map_err(std::io::Error::from)?;
                writeln!(out)?;
            }
            Format::Csv => {
                let mut writer = csv::Writer::from_writer(Vec::new());
                for line in &list.engines {
                    writer.serialize(line)?;
                }
                out.write_all(&writer.into_inner()?)?;
            }
        }
        Ok(())
    })
}
