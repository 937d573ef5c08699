//! `bench worker`: one side of a comparison of two binaries.

use super::{cases_by_default, courses};
use crate::bench::compare::worker::serve;
use crate::bench::workload;
use crate::build;
use anyhow::{Context, Result};
use std::io;

pub(super) fn run() -> Result<()> {
    let courses = courses(&cases_by_default()?)?;
    serve(&build::this(), &workload::all(&courses), io::stdin().lock(), io::stdout().lock())
        .context("worker")
}
