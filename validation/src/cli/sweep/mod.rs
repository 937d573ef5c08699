//! `sweep`: a verb of the dynamics over one or two parameters, in shards.

mod basins;
mod branches;
mod diagrams;
mod exponents;
mod index;
mod of_system;
mod shown;
mod verb;

use super::help;
use super::shared::format::OutputFlags;
use super::shared::long_work::{self, Bar};
use super::shared::output::{self, Destination};
use super::shared::parse;
use super::{DONE, OUT_OF_BOUNDS, note, say};
use crate::sweep::{
    Damage, Folder, Merge, NotMerged, Plan, Sweep, SweepObserver, SweepStatus, SweepVerb,
};
use anyhow::{Result, anyhow, bail};
use clap::{Args, Subcommand};
use shown::{Format, StatusJson};
use std::path::PathBuf;

/// Run a verb over a grid of one or two parameters, split into shards, on this machine or many
///
/// Answers how basins, attractors, diagrams, exponents or branches change over
/// one or two parameters. A plan says what; `run` computes, `status` says what is
/// missing, `merge` joins.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::SWEEP)]
pub(super) struct Arguments {
    #[command(subcommand)]
    step: SweepStep,
}

#[derive(Subcommand)]
enum SweepStep {
    Run(RunArguments),
    Status(StatusArguments),
    Merge(MergeArguments),
}

/// The plan of a sweep and the folder of its shards.
#[derive(Args)]
struct SweepFlags {
    /// What is swept, and in how many shards
    #[arg(long, value_name = "FILE.toml")]
    plan: PathBuf,
    /// The folder of the shards, which all workers share
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// Compute one shard, or all that are not finished
#[derive(Args)]
#[command(after_long_help = help::SWEEP_RUN)]
struct RunArguments {
    #[command(flatten)]
    sweep: SweepFlags,
    /// The shard to compute, from 0, of N; without it HQ_TASK_ID, SLURM_ARRAY_TASK_ID,
    /// PBS_ARRAY_INDEX or SGE_TASK_ID says which, and without these all are computed
    #[arg(long, value_name = "I/N", value_parser = parse::shard, allow_hyphen_values = true)]
    shard: Option<[u32; 2]>,
}

/// Say which shards are done, running, missing and damaged; exit code 0 where all are done
#[derive(Args)]
#[command(after_long_help = help::SWEEP_STATUS)]
struct StatusArguments {
    #[command(flatten)]
    sweep: SweepFlags,
    #[command(flatten)]
    output: OutputFlags<Format>,
}

/// Join all shards into one file of arrays for NumPy
#[derive(Args)]
#[command(after_long_help = help::SWEEP_MERGE)]
struct MergeArguments {
    #[command(flatten)]
    sweep: SweepFlags,
    /// Where the arrays go, a file that ends in .npz
    #[arg(long, value_name = "FILE.npz")]
    output: PathBuf,
}

pub(super) fn run(arguments: &Arguments, threads: Option<u16>) -> Result<u8> {
    match &arguments.step {
        SweepStep::Run(arguments) => compute(arguments, threads),
        SweepStep::Status(arguments) => status(arguments),
        SweepStep::Merge(arguments) => merge_shards(arguments, threads),
    }
}

impl SweepFlags {
    /// The plan and what it does, both checked.
    fn plan(&self) -> Result<(Plan, Box<dyn SweepVerb>)> {
        let plan = Plan::read(&self.plan)?;
        let work = verb::work(&plan).and_then(|work| {
            Sweep::check(&plan, work.as_ref())?;
            Ok(work)
        });
        let work = work.map_err(|error| anyhow!("--plan {}: {error:#}", self.plan.display()))?;
        Ok((plan, work))
    }
}

fn compute(arguments: &RunArguments, threads: Option<u16>) -> Result<u8> {
    let folder = Folder::new(&arguments.sweep.out)?;
    let (plan, work) = arguments.sweep.plan()?;
    let shard = match arguments.shard {
        Some([shard, shards]) if shards == plan.shards => Some(shard),
        Some([shard, shards]) => bail!(
            "--shard {shard}/{shards} does not fit: the plan has {} shards, accepted are 0/{} to \
             {}/{}",
            plan.shards,
            plan.shards,
            plan.shards - 1,
            plan.shards
        ),
        None => index::of_task(&plan, |name| std::env::var(name).ok())?,
    };
    // The first process of an MPI job alone reports the progress of all.
    let rank = index::rank(|name| std::env::var(name).ok());
    let progress = SweepProgress { bar: (rank == 0).then(|| long_work::bar(0, "tiles")) };
    long_work::pool(threads)?.install(|| {
        folder.begin(&plan)?;
        let sweep = Sweep::new(&plan, work.as_ref(), &folder);
        match shard {
            Some(shard) => sweep.run(shard, &progress),
            None => sweep.run_all(rank, &progress),
        }
    })?;
    Ok(DONE)
}

fn status(arguments: &StatusArguments) -> Result<u8> {
    let usual = shown::usual(&arguments.output.destination());
    let format = arguments.output.format(usual)?;
    let folder = Folder::new(&arguments.sweep.out)?;
    let (plan, work) = arguments.sweep.plan()?;
    let status = if folder.check(&plan)? {
        SweepStatus::new(&Sweep::new(&plan, work.as_ref(), &folder))
    } else {
        SweepStatus::not_begun(&plan)
    };
    let destination = arguments.output.destination();
    match format {
        Format::Json => destination.json(&StatusJson::new(&plan, &status))?,
        Format::Table => {
            let text = shown::table(&plan, &status);
            destination.write(|out| Ok(out.write_all(text.as_bytes())?))?;
        }
    }
    Ok(if status.is_complete() { DONE } else { OUT_OF_BOUNDS })
}

fn merge_shards(arguments: &MergeArguments, threads: Option<u16>) -> Result<u8> {
    let output = &arguments.output;
    if output.extension().is_none_or(|it| it != "npz") {
        bail!(
            "--output {} is not accepted: accepted is a file that ends in .npz",
            output.display()
        );
    }
    let destination = Destination::new(Some(output));
    destination.check()?;
    let folder = Folder::new(&arguments.sweep.out)?;
    let (plan, work) = arguments.sweep.plan()?;
    let beside = output::folder_of(output);
    let merged = if folder.check(&plan)? {
        long_work::pool(threads)?.install(|| {
            let sweep = Sweep::new(&plan, work.as_ref(), &folder);
            let bar = long_work::bar(plan.points(), "points");
            let merge = Merge::new(&sweep)?;
            destination.write(|out| merge.write(beside, out, &|| bar.inc(1)))
        })
    } else {
        Err(NotMerged::not_begun(&plan).into())
    };
    match merged {
        Err(error) if error.is::<NotMerged>() => {
            say(&error.to_string());
            Ok(OUT_OF_BOUNDS)
        }
        merged => merged.map(|()| DONE),
    }
}

/// Shows how a sweep goes on; without a bar nothing at all.
struct SweepProgress {
    bar: Option<Bar>,
}

impl SweepObserver for SweepProgress {
    fn on_damage(&self, shard: u32, why: &Damage) {
        if self.bar.is_some() {
            let name = Folder::name(shard);
            note(&format!("shard {shard} ({name}) is {why}; it is computed again"));
        }
    }

    fn on_duplicate(&self, shard: u32) {
        if self.bar.is_some() {
            note(&format!(
                "shard {shard} is being computed by another process as well: both give the same, \
                 and one of them may be ended"
            ));
        }
    }

    fn begun(&self, tiles: u64) {
        self.bar.iter().for_each(|bar| bar.inc_length(tiles));
    }

    fn tile(&self) {
        self.bar.iter().for_each(|bar| bar.inc(1));
    }
}
