//! Files under their temporary names: gone when they fail, and when the process is interrupted.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::{Builder, NamedTempFile, PersistError};

/// The temporary names that are in use.
static NAMES_IN_USE: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn names() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    // A set of paths is as good after a panic as before it.
    NAMES_IN_USE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Watches for interruptions: they remove what is unfinished and end the programs that were
/// started.
pub(crate) fn watch() {
    signals::watch();
}

/// A file that has not its own name yet.
pub(crate) struct Unfinished {
    // Removed from the disk before its name is forgotten: fields are dropped in this order.
    file: NamedTempFile,
    name: Name,
}

struct Name(PathBuf);

impl Drop for Name {
    fn drop(&mut self) {
        names().remove(&self.0);
    }
}

impl Unfinished {
    /// Makes a temporary file in a folder.
    pub(crate) fn new(builder: &Builder, folder: &Path) -> io::Result<Self> {
        signals::watch();
        // Known from the moment it exists.
        let mut names = names();
        let file = builder.tempfile_in(folder)?;
        let path = file.path().to_owned();
        names.insert(path.clone());
        Ok(Self { file, name: Name(path) })
    }

    /// Gives the file its final name.
    pub(crate) fn finish(self, target: &Path) -> io::Result<()> {
        self.keep(|file| file.persist(target))
    }

    /// Gives it its own name, unless there is a file of that name.
    pub(crate) fn finish_new(self, target: &Path) -> io::Result<()> {
        self.keep(|file| file.persist_noclobber(target))
    }

    /// Waits until what was written is on the disk.
    pub(crate) fn sync(&self) -> io::Result<()> {
        self.file.as_file().sync_all()
    }

    fn keep(
        self,
        persist: impl FnOnce(NamedTempFile) -> Result<File, PersistError>,
    ) -> io::Result<()> {
        let Self { file, name } = self;
        // An interruption comes before this or after it.
        let names = names();
        let kept = persist(file).map(drop).map_err(|error| error.error);
        drop(names);
        drop(name);
        kept
    }
}

impl Write for Unfinished {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

#[cfg(unix)]
mod signals {
    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use std::sync::Once;

    static WATCH_STARTED: Once = Once::new();

    /// From the first file on, SIGINT and SIGTERM remove what is unfinished and end the process
    /// with exit code 128 + signal, as a shell reports it. Until then they do what they do by
    /// default.
    pub(super) fn watch() {
        WATCH_STARTED.call_once(|| {
            // Where signals cannot be watched an interruption leaves its file, as it would without
            // this.
            if let Ok(mut signals) = Signals::new([SIGINT, SIGTERM]) {
                std::thread::spawn(move || signals.forever().next().map(end));
            }
        });
    }

    fn end(signal: i32) {
        // Held until the process is gone: no file is begun or finished any more.
        let names = super::names();
        for name in names.iter() {
            let _ = std::fs::remove_file(name);
        }
        percuss_programs::end_all();
        std::process::exit(128 + signal);
    }
}

#[cfg(not(unix))]
mod signals {
    /// Other systems have no such signals.
    pub(super) fn watch() {}
}
