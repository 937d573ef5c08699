//! Spoils sweeps in all the ways that clusters do: `cargo maintain sweep-faults`.

use super::blocks;
use anyhow::{Result, ensure};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

mod faults;

const PLAN: &str = r#"
[sweep]
verb = "lyapunov"
shards = 6
[fixed]
transient = 100
periods = 4000
[[axis]]
parameter = "omega"
from = 0.6
to = 1.9
steps = 20
[[axis]]
parameter = "b"
from = 0.05
to = 0.3
steps = 9
"#;
const SHARDS: u32 = 6;

/// What became of one kind of fault.
struct Tried {
    fault: &'static str,
    times: u32,
    lost: u32,
    doubled: u32,
    outcome: &'static str,
}

/// A sweep in a folder of its own.
struct SweepTrial {
    program: PathBuf,
    folder: TempDir,
    /// The merged bytes of an undisturbed run.
    expected: Vec<u8>,
    /// How long one shard takes.
    shard: Duration,
}

/// Spoil sweeps as clusters do, and count what is lost or doubled, into docs/SWEEPS.md
///
/// The program that it runs lies beside it: build it first, by cargo build --release. Full disks
/// and read-only folders need root on Linux.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The page to write
    page: PathBuf,
}

pub(crate) fn run(Arguments { page }: &Arguments) -> Result<()> {
    let program = std::env::current_exe()?.with_file_name("../percuss").canonicalize()?;
    let mut trial = SweepTrial::new(program)?;
    trial.measure()?;
    let tried = [
        trial.killed()?,
        trial.lost_worker()?,
        trial.killed_merge()?,
        trial.two_workers()?,
        trial.two_runs()?,
        trial.altered()?,
        trial.another_program()?,
        trial.edited_plan()?,
        trial.clock_skew()?,
    ];
    let mut rows: Vec<String> = tried.iter().map(Tried::row).collect();
    for row in [trial.full_disk(), trial.read_only()] {
        rows.push(
            row.map_or_else(|error| format!("| not tried: {error:#} | 0 | | | |"), |it| it.row()),
        );
    }
    let head = "| fault | times | lost | doubled | what happened |\n|---|---|---|---|---|";
    let table = format!("{head}\n{}\n", rows.join("\n"));
    println!("{table}");
    blocks::replace(page, &[("faults", table)])
}

impl Tried {
    fn row(&self) -> String {
        let Self { fault, times, lost, doubled, outcome } = self;
        format!("| {fault} | {times} | {lost} | {doubled} | {outcome} |")
    }
}

impl SweepTrial {
    fn new(program: PathBuf) -> Result<Self> {
        let folder = tempfile::tempdir()?;
        fs::write(folder.path().join("plan.toml"), PLAN)?;
        Ok(Self { program, folder, expected: Vec::new(), shard: Duration::ZERO })
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn command(&self, step: &str, out: &Path) -> Command {
        let mut command = Command::new(&self.program);
        command.args(["sweep", step, "--threads", "1", "--plan"]).arg(self.path("plan.toml"));
        command.arg("--out").arg(out).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    fn run(&self, step: &str, out: &Path, more: &[&str]) -> Result<Output> {
        Ok(self.command(step, out).args(more).output()?)
    }

    fn done(&self, step: &str, out: &Path, more: &[&str]) -> Result<()> {
        let output = self.run(step, out, more)?;
        let said = String::from_utf8_lossy(&output.stderr);
        ensure!(output.status.success(), "{step} {more:?}: {said}");
        Ok(())
    }

    /// A step that is refused with this exit code and these words.
    fn refused(&self, step: &str, out: &Path, more: &[&str], code: i32, words: &str) -> Result<()> {
        let output = self.run(step, out, more)?;
        let said = String::from_utf8_lossy(&output.stderr);
        ensure!(
            output.status.code() == Some(code) && said.contains(words),
            "{step} {more:?} is expected to say {words}: {:?} {said}",
            output.status
        );
        Ok(())
    }

    fn start(&self, out: &Path, shard: Option<u32>) -> Result<Child> {
        let mut command = self.command("run", out);
        if let Some(shard) = shard {
            command.arg("--shard").arg(format!("{shard}/{SHARDS}"));
        }
        Ok(command.spawn()?)
    }

    fn shard(out: &Path, shard: u32) -> PathBuf {
        out.join(format!("{shard:05}.shard"))
    }

    /// The files of finished shards.
    fn finished_shards(out: &Path) -> Vec<(u32, Vec<u8>)> {
        let read = |shard| Some((shard, fs::read(Self::shard(out, shard)).ok()?));
        (0..SHARDS).filter_map(read).collect()
    }

    /// Counts the shards that were finished before and are gone or changed now.
    fn count_lost(out: &Path, before: &[(u32, Vec<u8>)]) -> u32 {
        let is_there = |(shard, bytes): &&(u32, Vec<u8>)| {
            fs::read(Self::shard(out, *shard)).is_ok_and(|it| it == *bytes)
        };
        before.len() as u32 - before.iter().filter(is_there).count() as u32
    }

    /// Ends the sweep; 1 if its merged bytes are not those of an undisturbed one.
    fn differs(&self, out: &Path) -> Result<u32> {
        self.done("run", out, &[])?;
        Ok(u32::from(self.merged(out)? != self.expected))
    }

    fn merged(&self, out: &Path) -> Result<Vec<u8>> {
        let merged = self.path("merged.npz");
        self.done("merge", out, &["--output", &merged.display().to_string()])?;
        Ok(fs::read(merged)?)
    }

    /// An undisturbed run.
    fn measure(&mut self) -> Result<()> {
        let out = self.path("undisturbed");
        let begun = Instant::now();
        self.done("run", &out, &[])?;
        self.shard = begun.elapsed() / SHARDS;
        self.expected = self.merged(&out)?;
        eprintln!("a shard takes {:?}", self.shard);
        Ok(())
    }

    /// A folder with a few finished shards.
    fn begun(&self, name: &str) -> Result<PathBuf> {
        let out = self.path(name);
        let _ = fs::remove_dir_all(&out);
        self.done("run", &out, &["--shard", "1/6"])?;
        self.done("run", &out, &["--shard", "4/6"])?;
        Ok(out)
    }
}
