//! The copy of the sources.

use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The root of the repository that holds this package.
pub fn root() -> Result<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().context("no parent folder")?;
    Ok(root.to_owned())
}

/// Copies the files that git knows or would add. Files that are there already and equal are left
/// alone, so that cargo builds no more than it must.
pub fn copy(root: &Path, to: &Path) -> Result<()> {
    let list = Command::new("git")
        .args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"])
        .current_dir(root)
        .output()
        .context("git lists the files to copy")?;
    if !list.status.success() {
        bail!("git: {}", String::from_utf8_lossy(&list.stderr));
    }
    for name in String::from_utf8(list.stdout)?.split('\0').filter(|name| !name.is_empty()) {
        let from = root.join(name);
        if from.is_symlink() {
            link(&from, &to.join(name))?;
        } else if from.is_file() {
            write(&to.join(name), &std::fs::read(from)?)?;
        }
    }
    Ok(())
}

/// Writes a file if it is not the same already.
pub fn write(path: &Path, contents: &[u8]) -> Result<()> {
    if std::fs::read(path).is_ok_and(|before| before == contents) {
        return Ok(());
    }
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    std::fs::write(path, contents).with_context(|| path.display().to_string())
}

fn link(from: &Path, to: &Path) -> Result<()> {
    if !to.is_symlink() {
        std::os::unix::fs::symlink(std::fs::read_link(from)?, to)?;
    }
    Ok(())
}
