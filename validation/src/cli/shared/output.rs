//! The destinations of results: stdout, or a file that is there whole or not at all.

use super::compact;
use crate::unfinished::Unfinished;
use anyhow::{Context, Result, anyhow, bail};
use serde::Serialize;
use std::fs::{self, File};
use std::io::{self, BufWriter, IsTerminal, StdoutLock, Write};
use std::path::{Path, PathBuf};

/// stdout, or a file.
pub(in crate::cli) enum Destination {
    Stdout,
    File(PathBuf),
}

impl Destination {
    /// `--output PATH`; `-` and nothing are stdout.
    pub(in crate::cli) fn new(output: Option<&Path>) -> Self {
        match output {
            Some(path) if path != Path::new("-") => Self::File(path.to_owned()),
            _ => Self::Stdout,
        }
    }

    /// Refuses a file that cannot be made, before the work that would be lost.
    pub(in crate::cli) fn check(&self) -> Result<()> {
        let Self::File(path) = self else { return Ok(()) };
        check_file("--output", path)
    }

    /// A folder for files that wait until the result is written.
    pub(in crate::cli) fn folder(&self) -> PathBuf {
        match self {
            Self::Stdout => std::env::temp_dir(),
            Self::File(path) => folder_of(path).to_owned(),
        }
    }

    /// Whether what is written is seen on a terminal.
    pub(in crate::cli) fn is_terminal(&self) -> bool {
        matches!(self, Self::Stdout) && io::stdout().is_terminal()
    }

    /// Writes by `write`, whole or not at all where it is a file.
    pub(in crate::cli) fn write(
        &self,
        write: impl FnOnce(&mut dyn Write) -> Result<()>,
    ) -> Result<()> {
        match self {
            Self::Stdout => {
                let mut out = BufWriter::new(io::stdout().lock());
                let written = write(&mut out).and_then(|()| Ok(out.flush()?));
                written.map_err(|error| unwritable("stdout", error))
            }
            Self::File(path) => write_whole(path, write).context("--output"),
        }
    }

    /// Writes a value as JSON, a list of plain values on one line.
    pub(in crate::cli) fn json(&self, value: &impl Serialize) -> Result<()> {
        self.write(|out| json(out, value))
    }

    /// Opens it to write to, beside others.
    pub(in crate::cli) fn open(&self) -> Result<Opened> {
        let (name, out, folder) = match self {
            Self::Stdout => {
                let out = Open::Stdout(BufWriter::new(io::stdout().lock()));
                ("stdout".to_owned(), Ok(out), self.folder())
            }
            Self::File(path) => {
                let name = format!("--output: {}", path.display());
                (name, OpenFile::new(path).map(Open::File), self.folder())
            }
        };
        let out = out.map_err(|error| named_error(&name, &error))?;
        Ok(Opened { name, out, folder })
    }
}

/// A destination that is being written to; its errors name it.
pub(in crate::cli) struct Opened {
    name: String,
    out: Open,
    folder: PathBuf,
}

enum Open {
    Stdout(BufWriter<StdoutLock<'static>>),
    File(OpenFile),
}

impl Opened {
    /// A folder for files that wait until the result is written.
    pub(in crate::cli) fn folder(&self) -> PathBuf {
        self.folder.clone()
    }

    /// Gives the file, which is whole, its name.
    pub(in crate::cli) fn finish(self) -> Result<()> {
        let finished = match self.out {
            Open::Stdout(mut out) => out.flush(),
            Open::File(file) => file.finish(),
        };
        Ok(finished.map_err(|error| named_error(&self.name, &error))?)
    }
}

impl Write for Opened {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = match &mut self.out {
            Open::Stdout(out) => out.write(bytes),
            Open::File(file) => file.write(bytes),
        };
        written.map_err(|error| named_error(&self.name, &error))
    }

    fn flush(&mut self) -> io::Result<()> {
        let flushed = match &mut self.out {
            Open::Stdout(out) => out.flush(),
            Open::File(file) => file.flush(),
        };
        flushed.map_err(|error| named_error(&self.name, &error))
    }
}

/// An error of the same kind with the name of what could not be written.
fn named_error(name: &str, error: &io::Error) -> io::Error {
    io::Error::new(error.kind(), format!("{}: {error}", cannot_be_written(name)))
}

/// Writes a value as JSON, a list of plain values on one line.
pub(in crate::cli) fn json(out: &mut dyn Write, value: &impl Serialize) -> Result<()> {
    compact::write(value, &mut *out).map_err(io::Error::from)?;
    Ok(writeln!(out)?)
}

/// Writes a value as JSON on one line, for what is written piece by piece.
pub(in crate::cli) fn json_value(out: &mut dyn Write, value: &impl Serialize) -> Result<()> {
    Ok(serde_json::to_writer(out, value).map_err(io::Error::from)?)
}

/// Whether the error is that whoever read our output has left.
pub(in crate::cli) fn reader_left(error: &anyhow::Error) -> bool {
    let is_pipe = |error: &io::Error| error.kind() == io::ErrorKind::BrokenPipe;
    error.chain().any(|cause| cause.downcast_ref::<io::Error>().is_some_and(is_pipe))
}

/// Writes a file under a temporary name beside it and renames it.
pub(in crate::cli) fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> Result<()>,
) -> Result<()> {
    write_or_replace(path, write).map_err(|error| unwritable(&path.display().to_string(), error))
}

/// Names what could not be written, where that is the error.
fn unwritable(name: &str, error: anyhow::Error) -> anyhow::Error {
    if error.chain().any(|cause| cause.is::<io::Error>()) {
        error.context(cannot_be_written(name))
    } else {
        error
    }
}

fn cannot_be_written(name: &str) -> String {
    format!("{name} cannot be written, accepted is a writable path")
}

fn write_or_replace(path: &Path, write: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    let mut out = OpenFile::new(path)?;
    write(&mut out)?;
    Ok(out.finish()?)
}

/// A file that is being written.
enum OpenFile {
    /// A device or a pipe.
    Itself(BufWriter<File>),
    /// A file that gets its name when it is whole.
    New(BufWriter<Unfinished>, PathBuf),
}

impl OpenFile {
    fn new(path: &Path) -> io::Result<Self> {
        // A link stays a link; a device or a pipe cannot be renamed over.
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        if target.exists() && !target.is_file() {
            let out = BufWriter::new(File::options().write(true).open(&target)?);
            return Ok(Self::Itself(out));
        }
        let mut builder = tempfile::Builder::new();
        builder.prefix(".percuss-").suffix(".tmp");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // As any new file: what the umask leaves, or what the file had.
            let mode =
                fs::metadata(&target).map_or(0o666, |metadata| metadata.permissions().mode());
            builder.permissions(fs::Permissions::from_mode(mode));
        }
        let out = BufWriter::new(Unfinished::new(&builder, folder_of(&target))?);
        Ok(Self::New(out, target))
    }

    fn finish(self) -> io::Result<()> {
        match self {
            Self::Itself(mut out) => out.flush(),
            Self::New(out, target) => {
                out.into_inner().map_err(io::IntoInnerError::into_error)?.finish(&target)
            }
        }
    }
}

impl Write for OpenFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Itself(out) => out.write(bytes),
            Self::New(out, _) => out.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Itself(out) => out.flush(),
            Self::New(out, _) => out.flush(),
        }
    }
}

/// Refuses a file that a flag names and that cannot be made, before the work that would be lost.
pub(in crate::cli) fn check_file(flag: &str, path: &Path) -> Result<()> {
    let shown = path.display();
    let folder = folder_of(path);
    if path.as_os_str().is_empty() || path.is_dir() {
        bail!("{flag} {shown} cannot be written: it is a folder; accepted is a file's path");
    }
    if !folder.is_dir() {
        let folder = folder.display();
        bail!(
            "{flag} {shown} cannot be written: there is no folder {folder}; accepted is a path in a folder that exists"
        );
    }
    Ok(())
}

/// The folder that a file is in.
pub(in crate::cli) fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Makes a folder for several files.
pub(in crate::cli) fn make_folder(folder: &Path) -> Result<()> {
    fs::create_dir_all(folder).map_err(|error| {
        let folder = folder.display();
        anyhow!("--out {folder} cannot be made ({error}); accepted is a writable folder")
    })
}
