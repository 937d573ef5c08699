//! The faults: what is done to a sweep, and what is then lost, doubled or refused.

use super::{PLAN, SHARDS, SweepTrial, Tried};
use anyhow::{Context, Result, bail, ensure};
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

impl SweepTrial {
    pub(super) fn killed(&self) -> Result<Tried> {
        let (times, mut lost, mut doubled) = (50, 0, 0);
        let out = self.path("killed");
        for time in 0..times {
            if Self::finished_shards(&out).len() == SHARDS as usize {
                doubled += self.differs(&out)?;
                fs::remove_dir_all(&out)?;
            }
            let before = Self::finished_shards(&out);
            let mut worker = self.start(&out, Some(time % SHARDS))?;
            std::thread::sleep(self.shard.mul_f64(1.2 * fastrand::f64()));
            worker.kill()?;
            worker.wait()?;
            lost += Self::count_lost(&out, &before);
        }
        doubled += self.differs(&out)?;
        let outcome = "the shard is missing or whole; run again, it is computed";
        Ok(Tried { fault: "kill -9 while a shard is computed", times, lost, doubled, outcome })
    }

    pub(super) fn lost_worker(&self) -> Result<Tried> {
        let (times, mut lost, mut doubled) = (10, 0, 0);
        for _ in 0..times {
            let out = self.begun("lost")?;
            let before = Self::finished_shards(&out);
            let mut worker = self.start(&out, Some(3))?;
            std::thread::sleep(self.shard.mul_f64(0.9 * fastrand::f64()));
            worker.kill()?;
            worker.wait()?;
            // The engine gives its shard to another.
            self.done("run", &out, &["--shard", "3/6"])?;
            lost += Self::count_lost(&out, &before);
            doubled += self.differs(&out)?;
        }
        let outcome = "another worker computes its shard; with Dask, `check.sh` does this";
        Ok(Tried { fault: "a worker that is lost for good", times, lost, doubled, outcome })
    }

    pub(super) fn killed_merge(&self) -> Result<Tried> {
        let (times, mut lost, mut doubled) = (20, 0, 0);
        let (out, merged) = (self.path("undisturbed"), self.path("half.npz"));
        let begun = Instant::now();
        self.merged(&out)?;
        let whole = begun.elapsed();
        let before = Self::finished_shards(&out);
        for _ in 0..times {
            let mut merge = self.command("merge", &out).arg("--output").arg(&merged).spawn()?;
            std::thread::sleep(whole.mul_f64(fastrand::f64()));
            merge.kill()?;
            merge.wait()?;
            let there = fs::read(&merged).ok();
            doubled += u32::from(there.is_some_and(|it| it != self.expected));
            lost += Self::count_lost(&out, &before);
        }
        doubled += self.differs(&out)?;
        let outcome = "the old file or none is there; merged again, it is whole";
        Ok(Tried { fault: "kill -9 while shards are merged", times, lost, doubled, outcome })
    }

    pub(super) fn two_workers(&self) -> Result<Tried> {
        let (times, mut lost, mut doubled) = (10, 0, 0);
        for _ in 0..times {
            let out = self.begun("two")?;
            let before = Self::finished_shards(&out);
            let workers = [self.start(&out, Some(2))?, self.start(&out, Some(2))?];
            for worker in workers {
                let output = worker.wait_with_output()?;
                ensure!(output.status.success(), "{output:?}");
            }
            lost += Self::count_lost(&out, &before);
            doubled += self.differs(&out)?;
        }
        let outcome = "both end well; the later one says that another computes it as well";
        Ok(Tried { fault: "two workers on one shard", times, lost, doubled, outcome })
    }

    pub(super) fn two_runs(&self) -> Result<Tried> {
        let (times, mut lost, mut doubled) = (5, 0, 0);
        for _ in 0..times {
            let out = self.begun("runs")?;
            let before = Self::finished_shards(&out);
            let workers = [self.start(&out, None)?, self.start(&out, None)?];
            for worker in workers {
                let output = worker.wait_with_output()?;
                ensure!(output.status.success(), "{output:?}");
            }
            lost += Self::count_lost(&out, &before);
            doubled += self.differs(&out)?;
        }
        let outcome = "each takes shards that the other has not";
        Ok(Tried { fault: "two runs of all shards at once", times, lost, doubled, outcome })
    }

    pub(super) fn altered(&self) -> Result<Tried> {
        let (times, mut lost, mut doubled) = (50, 0, 0);
        let out = self.path("altered");
        self.done("run", &out, &[])?;
        let before = Self::finished_shards(&out);
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
            lost += Self::count_lost(&out, &others);
        }
        let outcome = "status and merge name the shard, run computes it again";
        Ok(Tried { fault: "one bit altered, or the file cut", times, lost, doubled, outcome })
    }

    pub(super) fn another_program(&self) -> Result<Tried> {
        let (mut times, mut lost) = (0, 0);
        let out = self.begun("program")?;
        let before = Self::finished_shards(&out);
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
            lost += Self::count_lost(&out, &before);
            times += 1;
        }
        fs::write(&path, text)?;
        let doubled = self.differs(&out)?;
        let outcome = "exit 2, which says whose shards these are";
        let fault = "a worker of another version, commit or arithmetic";
        Ok(Tried { fault, times, lost, doubled, outcome })
    }

    pub(super) fn edited_plan(&self) -> Result<Tried> {
        let (mut times, mut lost) = (0, 0);
        let out = self.begun("plan")?;
        let before = Self::finished_shards(&out);
        let path = self.path("plan.toml");
        for (from, to) in [("4000", "4001"), ("shards = 6", "shards = 7"), ("1.9", "1.8")] {
            fs::write(&path, PLAN.replace(from, to))?;
            self.refused("run", &out, &[], 2, "another plan")?;
            self.refused("status", &out, &[], 2, "another plan")?;
            lost += Self::count_lost(&out, &before);
            times += 1;
        }
        fs::write(&path, PLAN)?;
        let doubled = self.differs(&out)?;
        let outcome = "exit 2, which says that the shards are of another plan";
        Ok(Tried { fault: "a plan edited after the first shard", times, lost, doubled, outcome })
    }

    pub(super) fn clock_skew(&self) -> Result<Tried> {
        let (mut times, mut lost, mut doubled) = (0, 0, 0);
        for seconds in [0, 1_000_000_000, 4_000_000_000] {
            let out = self.begun("clock")?;
            let before = Self::finished_shards(&out);
            for entry in fs::read_dir(&out)? {
                let file = fs::File::options().write(true).open(entry?.path())?;
                file.set_modified(std::time::UNIX_EPOCH + Duration::from_secs(seconds))?;
            }
            doubled += self.differs(&out)?;
            lost += Self::count_lost(&out, &before);
            times += 1;
        }
        let outcome = "nothing is told by a file's time";
        Ok(Tried { fault: "files of 1970, 2001 and 2096", times, lost, doubled, outcome })
    }

    pub(super) fn full_disk(&self) -> Result<Tried> {
        let (times, mut lost, mut doubled) = (10, 0, 0);
        for time in 0..times {
            let out = self.path("full");
            fs::create_dir_all(&out)?;
            mount(&["-t", "tmpfs", "-o", "size=64k", "tmpfs"], &out)?;
            let done = (|| {
                self.done("run", &out, &["--shard", "1/6"])?;
                let before = Self::finished_shards(&out);
                // What is left is less than a shard.
                let free = 64 * 1024 - used_bytes(&out)?;
                let left = 4096 * usize::try_from(time % 2)?;
                fs::write(out.join("other"), vec![0; free - left])?;
                self.refused("run", &out, &["--shard", "2/6"], 2, "cannot be written")?;
                lost += Self::count_lost(&out, &before);
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

    pub(super) fn read_only(&self) -> Result<Tried> {
        let out = self.path("read-only");
        fs::create_dir_all(&out)?;
        mount(&["-t", "tmpfs", "tmpfs"], &out)?;
        let mut lost = 0;
        let done = (|| {
            self.done("run", &out, &["--shard", "1/6"])?;
            let before = Self::finished_shards(&out);
            mount(&["-o", "remount,ro"], &out)?;
            self.refused("run", &out, &["--shard", "2/6"], 2, "accepted is a writable folder")?;
            self.refused("run", &out, &[], 2, "accepted is a writable folder")?;
            lost += Self::count_lost(&out, &before);
            mount(&["-o", "remount,rw"], &out)?;
            self.differs(&out)
        })();
        unmount(&out)?;
        let outcome = "exit 2 before anything is computed";
        Ok(Tried { fault: "a read-only folder", times: 2, lost, doubled: done?, outcome })
    }
}

/// Bytes that the files of a folder take of a file system in pages of 4096.
fn used_bytes(folder: &Path) -> Result<usize> {
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
