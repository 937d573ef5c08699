//! Files that are to change, in memory before they are written.

use crate::process::Folder;
use anyhow::{Context, Result};
use similar::TextDiff;
use std::fmt;

/// A file with its text before and after.
pub struct Edit {
    pub path: String,
    pub before: String,
    pub after: String,
}

impl Edit {
    /// Reads a file of the repository and changes its text.
    pub fn new(
        root: &Folder,
        path: &str,
        change: impl FnOnce(&str) -> Result<String>,
    ) -> Result<Self> {
        let before = root.read(path)?;
        let after = change(&before).with_context(|| path.to_owned())?;
        Ok(Self { path: path.to_owned(), before, after })
    }

    pub fn changes(&self) -> bool {
        self.before != self.after
    }

    pub fn write(&self, root: &Folder) -> Result<()> {
        std::fs::write(root.path(&self.path), &self.after).with_context(|| self.path.clone())
    }
}

/// The lines that change, as `diff --unified=1` shows them.
impl fmt::Display for Edit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines = TextDiff::from_lines(&self.before, &self.after);
        let mut shown = lines.unified_diff();
        shown.context_radius(1).header(&self.path, &self.path);
        write!(f, "{shown}")
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a panic is a failed test")]
mod tests {
    use super::*;

    #[test]
    fn changed_lines_are_shown() {
        let [before, after] = ["a\nb\nc\nd\n", "a\nb\nnew\nc\nd\n"].map(str::to_owned);
        let edit = Edit { path: "file".to_owned(), before, after };
        assert!(edit.changes());
        assert_eq!(edit.to_string(), "--- file\n+++ file\n@@ -2,2 +2,3 @@\n b\n+new\n c\n");
    }
}
