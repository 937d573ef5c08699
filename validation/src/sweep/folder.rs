//! The folder of a sweep: what is in it under which name, and which plan and program it is of.

use super::plan::Plan;
use crate::provenance;
use crate::unfinished::Unfinished;
use anyhow::{Result, anyhow, bail};
use percuss::lanes::Instructions;
use serde::{Deserialize, Serialize};
use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// The file that says which plan and program the folder is of.
const SWEEP_FILE: &str = "sweep.json";
/// The beginning of its temporary name.
const TEMPORARY_PREFIX: &str = ".percuss-";

/// The program that computes. Programs that differ may differ in the last bits, which chaos
/// amplifies, so one sweep is computed by one program.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ComputedBy {
    /// The program's version.
    pub percuss: String,
    /// The commit that it was built from, where that is known.
    pub commit: Option<String>,
    /// Whether ensembles are solved in vectors or one by one: these differ in their last bits.
    /// Vectors of all widths give the same bits.
    pub arithmetic: String,
}

/// The folder of a sweep.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
}

#[derive(PartialEq, Serialize, Deserialize)]
struct Owner {
    schema: u32,
    plan: String,
    program: ComputedBy,
}

/// A shard that is being computed, until this is dropped.
#[derive(Debug)]
pub(super) struct Lock {
    path: PathBuf,
    /// The locked file; none where another process holds it, or the file system has no locks.
    file: Option<File>,
}

impl ComputedBy {
    /// The build of this program on this machine.
    #[must_use]
    pub fn this() -> Self {
        let build = provenance::this();
        let scalar = Instructions::widest() == Instructions::ONE;
        let arithmetic = if scalar { "scalar" } else { "vector" };
        Self { percuss: build.percuss, commit: build.commit, arithmetic: arithmetic.to_owned() }
    }

    fn shown(&self) -> String {
        let commit = self.commit.as_deref().map_or("unknown commit", |it| &it[..it.len().min(12)]);
        format!("percuss {} ({commit}, {} arithmetic)", self.percuss, self.arithmetic)
    }
}

impl Folder {
    /// A folder that may not exist yet.
    ///
    /// # Errors
    /// There is something else of that name.
    pub fn new(path: &Path) -> Result<Self> {
        if path.as_os_str().is_empty() || (path.exists() && !path.is_dir()) {
            bail!("--out {} is no folder: accepted is a folder, or a path for one", path.display());
        }
        Ok(Self { path: path.to_owned() })
    }

    /// Refuses a folder whose shards are of another plan or program; whether any was begun.
    ///
    /// # Errors
    /// Says whose they are, and what to do.
    pub fn check(&self, plan: &Plan) -> Result<bool> {
        let shown = self.path.display();
        let text = match fs::read(self.path.join(SWEEP_FILE)) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(false),
            Err(error) => bail!("--out {shown}: {SWEEP_FILE} cannot be read ({error})"),
        };
        let owner: Owner = serde_json::from_slice(&text).map_err(|error| {
            anyhow!(
                "--out {shown}: {SWEEP_FILE} is damaged ({error}); remove it, and run again: each \
                 shard says itself what it is of"
            )
        })?;
        if owner.plan != plan.hash {
            bail!(
                "--out {shown} has shards of another plan: accepted are the plan that they are of, \
                 or another folder"
            );
        }
        let this = ComputedBy::this();
        if owner.program != this {
            bail!(
                "--out {shown} has shards of {}, and this is {}: accepted are the same program \
                 everywhere, or another folder",
                owner.program.shown(),
                this.shown()
            );
        }
        Ok(true)
    }

    /// Makes the folder, and says in it which plan and program it is of.
    ///
    /// # Errors
    /// What [`Folder::check`] refuses, and a folder that cannot be written.
    pub fn begin(&self, plan: &Plan) -> Result<()> {
        let unwritable = |error| self.unwritable(SWEEP_FILE, &error);
        fs::create_dir_all(&self.path).map_err(unwritable)?;
        if self.check(plan)? {
            return Ok(());
        }
        let owner = Owner { schema: 1, plan: plan.hash.clone(), program: ComputedBy::this() };
        let text = serde_json::to_vec_pretty(&owner)?;
        match self.put(SWEEP_FILE, TEMPORARY_PREFIX, &[&text], Unfinished::finish_new) {
            // Another worker was first.
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {
                self.check(plan)?;
                Ok(())
            }
            written => written.map_err(unwritable),
        }
    }

    /// The file of a shard.
    #[must_use]
    pub fn shard(&self, shard: u32) -> PathBuf {
        self.path.join(Self::name(shard))
    }

    /// The name of a shard's file.
    #[must_use]
    pub fn name(shard: u32) -> String {
        format!("{shard:05}.shard")
    }

    /// Writes a shard's file, whole or not at all, even if the machine fails.
    pub(super) fn write_shard(&self, shard: u32, parts: &[&[u8]]) -> Result<()> {
        let name = Self::name(shard);
        let written = self.put(&name, &temporary(shard), parts, Unfinished::finish);
        written.map_err(|error| self.unwritable(&name, &error))
    }

    /// Marks a shard as being computed, and removes what a worker of it that was killed has left.
    pub(super) fn lock(&self, shard: u32) -> Result<Lock> {
        let path = self.lock_path(shard);
        let was_there = path.exists();
        let file = File::create(&path);
        let file = file.map_err(|error| self.unwritable(&format!("{shard:05}.lock"), &error))?;
        // A file system without locks says no more than one whose lock is held.
        let file = Some(file).filter(|file| file.try_lock().is_ok());
        // Only a worker that was killed leaves its lock, and beside it perhaps half a shard. The
        // folder is not searched for each of many shards.
        if file.is_some() && was_there {
            self.remove_left(shard);
        }
        Ok(Lock { path, file })
    }

    fn remove_left(&self, shard: u32) {
        let prefix = temporary(shard);
        for entry in fs::read_dir(&self.path).into_iter().flatten().flatten() {
            if entry.file_name().to_string_lossy().starts_with(&prefix) {
                let _ = fs::remove_file(entry.path());
            }
        }
    }

    /// Whether some process on this machine, or on one that shares its locks, computes a shard.
    pub(super) fn is_locked(&self, shard: u32) -> bool {
        let file = File::open(self.lock_path(shard));
        file.is_ok_and(|it| matches!(it.try_lock_shared(), Err(TryLockError::WouldBlock)))
    }

    fn lock_path(&self, shard: u32) -> PathBuf {
        self.path.join(format!("{shard:05}.lock"))
    }

    fn put(
        &self,
        name: &str,
        prefix: &str,
        parts: &[&[u8]],
        finish: impl FnOnce(Unfinished, &Path) -> io::Result<()>,
    ) -> io::Result<()> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(prefix).suffix(".tmp");
        readable(&mut builder);
        let mut file = Unfinished::new(&builder, &self.path)?;
        for part in parts {
            file.write_all(part)?;
        }
        file.sync()?;
        finish(file, &self.path.join(name))?;
        // The name is on the disk when the folder is.
        if let Ok(folder) = File::open(&self.path) {
            let _ = folder.sync_all();
        }
        Ok(())
    }

    fn unwritable(&self, name: &str, error: &io::Error) -> anyhow::Error {
        let shown = self.path.display();
        anyhow!("--out {shown}: {name} cannot be written ({error}); accepted is a writable folder")
    }
}

/// The beginning of the temporary names of a shard's file.
fn temporary(shard: u32) -> String {
    format!(".percuss-{shard:05}-")
}

/// Gives a file the permissions of any new file: what the umask leaves. Workers may be of several
/// users.
fn readable(builder: &mut tempfile::Builder<'_, '_>) {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    #[cfg(not(unix))]
    let _ = builder;
}

impl Lock {
    /// Whether the lock was free.
    pub(super) const fn is_ours(&self) -> bool {
        self.file.is_some()
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        if self.file.is_some() {
            // A lock that stays says nothing: it is held by no one.
            let _ = fs::remove_file(&self.path);
        }
    }
}
