//! Spoils sweeps in all the ways that clusters do, and counts what is lost or doubled.
//!
//! ```sh
//! cargo run --release -p percuss-validation --example sweep_faults -- docs/SWEEPS.md
//! ```
//!
//! writes its table between the marks of that page. The program that it runs lies beside it: build
//! it first, by `cargo build --release`. Full disks and read-only folders need root on Linux.

use anyhow::{Context, Result, bail, ensure};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

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

fn main() -> Result<()> {
    let page = std::env::args().nth(1).context("the page that gets the table is missing")?;
    let program = std::env::current_exe()?.with_file_name("../percuss").canonicalize()?;
    let mut bench = SweepTrial::new(program)?;
    bench.measure()?;
    let tried = [
        bench.killed()?,
        bench.lost_worker()?,
        bench.killed_merge()?,
        bench.two_workers()?,
        bench.two_runs()?,
        bench.altered()?,
        bench.another_program()?,
        bench.edited_plan()?,
        bench.clock_skew()?,
    ];
    let mut rows: Vec<String> = tried.iter().map(Tried::row).collect();
    for row in [bench.full_disk(), bench.read_only()] {
        rows.push(
            row.map_or_else(|error| format!("| not tried: {error:#} | 0 | | | |"), |it| it.row()),
        );
    }
    let head = "| fault | times | lost | doubled | what happened |\n|---|---|---|---|---|";
    splice(Path::new(&page), &format!("{head}\n{}", rows.join("\n")))
}

impl Tried {
    fn row(&self) -> String {
        let Self { fault, times, lost, doubled, outcome } = self;
        format!("| {fault} | {times} | {lost} | {doubled} | {outcome} |")
    }
}

/// Puts a table between the marks of a page.
fn splice(page: &Path, table: &str) -> Result<()> {
    const MARKS: [&str; 2] = ["<!-- faults -->", "<!-- end of faults -->"];
    let text = fs::read_to_string(page)?;
    let (before, rest) = text.split_once(MARKS[0]).context("the page has no mark")?;
    let (_, after) = rest.split_once(MARKS[1]).context("the page has no second mark")?;
    println!("{table}");
    Ok(fs::write(page, format!("{before}{}\n{table}\n{}{after}", MARKS[0], MARKS[1]))?)
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
    fn finished(out: &Path) -> Vec<(u32, Vec<u8>)> {
        let read = |shard| Some((shard, fs::read(Self::shard(out, shard)).ok()?));
        (0..SHARDS).filter_map(read).collect()
    }

    /// Counts the shards that were finished before and are gone or changed now.
    fn lost(out: &Path, before: &[(u32, Vec<u8>)]) -> u32 {
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

    fn killed(&self) -> Result<Tried> {
        let (times, mut lost, mut doubled) = (50, 0, 0);
        let out = self.path("killed");
        for time in 0..times {
            if Self::finished(&out).len() == SHARDS as usize {
                doubled += self.differs(&out)?;
                fs::remove_dir_all(&out)?;
            }
            let before = Self::finished(&out);
            let mut worker = self.start(&out, Some(time % SHARDS))?;
            std::thread::sleep(self.shard.mul_f64(1.2 * fastrand::f64()));
            worker.kill()?;
            worker.wait()?;
            lost += Self::lost(&out, &before);
        }
        doubled += self.differs(&out)?;
        let outcome = "the shard is missing or whole; run again, it is computed";
        Ok(Tried { fault: "kill -9 while a shard is computed", times, lost, doubled, outcome })
    }

    fn lost_worker(&self) -> Result<Tried> {
        let (times, mut lost, mut doubled) = (10, 0, 0);
        for _ in 0..times {
            let out = self.begun("lost")?;
            let before = Self::finished(&out);
            let mut worker = self.start(&out, Some(3))?;
            std::thread::sleep(self.shard.mul_f64(0.9 * fastrand::f64()));
            worker.kill()?;
            worker.wait()?;
            // The engine gives its shard to another.
            self.done("run", &out, &["--shard", "3/6"])?;
            lost += Self::lost(&out, &before);
            doubled += self.differs(&out)?;
        }
        let outcome = "another worker computes its shard; with Dask, `check.sh` does this";
        Ok(Tried { fault: "a worker that is lost for good", times, lost, doubled, outcome })
    }

    fn killed_merge(&self) -> Result<Tried> {
        let (times, mut lost, mut doubled) = (20, 0, 0);
        let (out, merged) = (self.path("undisturbed"), self.path("half.npz"));
        let begun = Instant::now();
        self.merged(&out)?;
        let whole = begun.elapsed();
        let before = Self::finished(&out);
        for _ in 0..times {
            let mut merge = self.command("merge", &out).arg("--output").arg(&merged).spawn()?;
            std::thread::sleep(whole.mul_f64(fastrand::f64()));
            merge.kill()?;
            merge.wait()?;
            let there = fs::read(&merged).ok();
            doubled += u32::from(there.is_some_and(|it| it != self.expected));
            lost += Self::lost(&out, &before);
        }
        doubled += self.differs(&out)?;
        let outcome = "the old file or none is there; merged again, it is whole";
        Ok(Tried { fault: "kill -9 while shards are merged", times, lost, doubled, outcome })
    }

    fn two_workers(&self) -> Result<Tried> {
        let (times, mut lost, mut doubled) = (10, 0, 0);
        for _ in 0..times {
            let out = self.begun("two")?;
            let before = Self::finished(&out);
            let workers = [self.start(&out, Some(2))?, self.start(&out, Some(2))?];
            for worker in workers {
                let output = worker.wait_with_output()?;
                ensure!(output.status.success(), "{output:?}");
            }
            lost += Self::lost(&out, &before);
            doubled += self.differs(&out)?;
        }
        let outcome = "both end well; the later one says that another computes it as well";
        Ok(Tried { fault: "two workers on one shard", times, lost, doubled, outcome })
    }

    fn two_runs(&self) -> Result<Tried> {
        let (times, mut lost, mut doubled) = (5, 0, 0);
        for _ in 0..times {
            let out = self.begun("runs")?;
            let before = Self::finished(&out);
            let workers = [self.start(&out, None)?, self.start(&out, None)?];
            for worker in workers {
                let output = worker.wait_with_output()?;
                ensure!(output.status.success(), "{output:?}");
            }
            lost += Self::lost(&out, &before);
            doubled += self.differs(&out)?;
        }
        let outcome = "each takes shards that the other has not";
        Ok(Tried { fault: "two runs of all shards at once", times, lost, doubled, outcome })
    }

    fn altered(&self) -> Result<Tried> {
        let (times, mut lost, mut doubled) = (50, 0, 0);
        let out = self.path("altered");
        self.done("run", &out, &[])?;
        let before = Self::finished(&out);
        for time in 0..times {
            let path = Self::shard(&out, 2);
            let mut bytes = fs::read(&path)?;
            let place = fastrand::usize(..bytes.len());
            if time % 2 == 0 {
                bytes[place] ^= 1 << fastrand::u32(..8);
            } else {
                bytes.truncate(place);
            }
            fs::write(&path, bytes)?;
            let merged = self.path("no.npz").display().to_string();
            self.refused("merge", &out, &["--output", &merged], 1, "shard 2 is damaged")?;
            let others: Vec<_> = before.iter().filter(|it| it.0 != 2).cloned().collect();
            doubled += self.differs(&out)?;
            lost += Self::lost(&out, &others);
        }
        let outcome = "status and merge name the shard, run computes it again";
        Ok(Tried { fault: "one bit altered, or the file cut", times, lost, doubled, outcome })
    }

    fn another_program(&self) -> Result<Tried> {
        let (mut times, mut lost) = (0, 0);
        let out = self.begun("program")?;
        let before = Self::finished(&out);
        let path = out.join("sweep.json");
        let text = fs::read_to_string(&path)?;
        for (from, to) in [
            ("\"percuss\": \"", "\"percuss\": \"9"),
            ("\"commit\": \"", "\"commit\": \"0"),
            ("\"arithmetic\": \"", "\"arithmetic\": \"un"),
        ] {
            ensure!(text.contains(from), "sweep.json has no {from}");
            fs::write(&path, text.replace(from, to))?;
            self.refused("run", &out, &[], 2, "the same program everywhere")?;
            lost += Self::lost(&out, &before);
            times += 1;
        }
        fs::write(&path, text)?;
        let doubled = self.differs(&out)?;
        let outcome = "exit 2, which says whose shards these are";
        let fault = "a worker of another version, commit or arithmetic";
        Ok(Tried { fault, times, lost, doubled, outcome })
    }

    fn edited_plan(&self) -> Result<Tried> {
        let (mut times, mut lost) = (0, 0);
        let out = self.begun("plan")?;
        let before = Self::finished(&out);
        let path = self.path("plan.toml");
        for (from, to) in [("4000", "4001"), ("shards = 6", "shards = 7"), ("1.9", "1.8")] {
            fs::write(&path, PLAN.replace(from, to))?;
            self.refused("run", &out, &[], 2, "another plan")?;
            self.refused("status", &out, &[], 2, "another plan")?;
            lost += Self::lost(&out, &before);
            times += 1;
        }
        fs::write(&path, PLAN)?;
        let doubled = self.differs(&out)?;
        let outcome = "exit 2, which says that the shards are of another plan";
        Ok(Tried { fault: "a plan edited after the first shard", times, lost, doubled, outcome })
    }

    fn clock_skew(&self) -> Result<Tried> {
        let (mut times, mut lost, mut doubled) = (0, 0, 0);
        for seconds in [0, 1_000_000_000, 4_000_000_000] {
            let out = self.begun("clock")?;
            let before = Self::finished(&out);
            for entry in fs::read_dir(&out)? {
                let file = fs::File::options().write(true).open(entry?.path())?;
                file.set_modified(std::time::UNIX_EPOCH + Duration::from_secs(seconds))?;
            }
            doubled += self.differs(&out)?;
            lost += Self::lost(&out, &before);
            times += 1;
        }
        let outcome = "nothing is told by a file's time";
        Ok(Tried { fault: "files of 1970, 2001 and 2096", times, lost, doubled, outcome })
    }

    fn full_disk(&self) -> Result<Tried> {
        let (times, mut lost, mut doubled) = (10, 0, 0);
        for time in 0..times {
            let out = self.path("full");
            fs::create_dir_all(&out)?;
            mount(&["-t", "tmpfs", "-o", "size=64k", "tmpfs"], &out)?;
            let done = (|| {
                self.done("run", &out, &["--shard", "1/6"])?;
                let before = Self::finished(&out);
                // What is left is less than a shard.
                let free = 64 * 1024 - used(&out)?;
                let left = 4096 * usize::try_from(time % 2)?;
                fs::write(out.join("other"), vec![0; free - left])?;
                self.refused("run", &out, &["--shard", "2/6"], 2, "cannot be written")?;
                lost += Self::lost(&out, &before);
                fs::remove_file(out.join("other"))?;
                doubled += self.differs(&out)?;
                anyhow::Ok(())
            })();
            unmount(&out)?;
            done?;
        }
        let outcome = "exit 2, which names the file; with room again, it is computed";
        Ok(Tried { fault: "a full disk", times, lost, doubled, outcome })
    }

    fn read_only(&self) -> Result<Tried> {
        let out = self.path("read-only");
        fs::create_dir_all(&out)?;
        mount(&["-t", "tmpfs", "tmpfs"], &out)?;
        let mut lost = 0;
        let done = (|| {
            self.done("run", &out, &["--shard", "1/6"])?;
            let before = Self::finished(&out);
            mount(&["-o", "remount,ro"], &out)?;
            self.refused("run", &out, &["--shard", "2/6"], 2, "accepted is a writable folder")?;
            self.refused("run", &out, &[], 2, "accepted is a writable folder")?;
            lost += Self::lost(&out, &before);
            mount(&["-o", "remount,rw"], &out)?;
            self.differs(&out)
        })();
        unmount(&out)?;
        let outcome = "exit 2 before anything is computed";
        Ok(Tried { fault: "a read-only folder", times: 2, lost, doubled: done?, outcome })
    }
}

/// Bytes that the files of a folder take of a file system in pages of 4096.
fn used(folder: &Path) -> Result<usize> {
    let mut used = 0;
    for entry in fs::read_dir(folder)? {
        used += usize::try_from(entry?.metadata()?.len())?.next_multiple_of(4096);
    }
    Ok(used)
}

fn mount(options: &[&str], folder: &Path) -> Result<()> {
    let output = Command::new("mount").args(options).arg(folder).output().context("mount")?;
    if !output.status.success() {
        bail!("{}", String::from_utf8_lossy(&output.stderr).trim());
    }
    Ok(())
}

fn unmount(folder: &Path) -> Result<()> {
    Command::new("umount").arg(folder).status().context("umount")?;
    Ok(())
}
