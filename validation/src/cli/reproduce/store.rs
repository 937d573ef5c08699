//! Finished items beside the pictures, so that interrupted work is taken up again.

use super::write_file;
use crate::reproduce::{Claim, Item, Size};
use anyhow::{Result, anyhow};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};

/// Where they are kept: a folder that is gone when all is done.
const FOLDER: &str = ".unfinished";

pub(super) struct Store {
    out: PathBuf,
    folder: PathBuf,
    key: String,
}

/// A finished item.
#[derive(Serialize, Deserialize)]
struct Kept {
    /// What computed it: another program's work is not taken up.
    key: String,
    claims: Vec<Claim>,
    files: Vec<String>,
}

impl Store {
    pub(super) fn open(out: &Path, size: Size) -> Result<Self> {
        let folder = out.join(FOLDER);
        fs::create_dir_all(&folder).map_err(|error| {
            let folder = folder.display();
            anyhow!("--out: {folder} cannot be made ({error}); accepted is a writable folder")
        })?;
        let key = format!("{} {} {size:?}", env!("CARGO_PKG_VERSION"), env!("PERCUSS_COMMIT"));
        Ok(Self { out: out.to_owned(), folder, key })
    }

    fn path(&self, item: &Item) -> PathBuf {
        self.folder.join(format!("{}.json", item.id))
    }

    /// The claims of an item that an earlier run of the same program has finished.
    pub(super) fn claims(&self, item: &Item) -> Option<Vec<Claim>> {
        let text = fs::read_to_string(self.path(item)).ok()?;
        let kept: Kept = serde_json::from_str(&text).ok()?;
        let is_there = |name: &String| self.out.join(name).is_file();
        (kept.key == self.key && kept.files.iter().all(is_there)).then_some(kept.claims)
    }

    /// Writes an item's files, then that it is finished.
    pub(super) fn keep(
        &self,
        item: &Item,
        claims: &[Claim],
        files: &[(String, Vec<u8>)],
    ) -> Result<()> {
        for (name, bytes) in files {
            write_file(&self.out, name, bytes)?;
        }
        let names = files.iter().map(|(name, _)| name.clone()).collect();
        let kept = Kept { key: self.key.clone(), claims: claims.to_vec(), files: names };
        write_file(&self.folder, &format!("{}.json", item.id), &serde_json::to_vec(&kept)?)
    }

    /// All of these are done: nothing is left to take up.
    pub(super) fn close(&self, done: &[&Item]) {
        // What cannot be removed is only ignored by the next program.
        for item in done {
            let _ = fs::remove_file(self.path(item));
        }
        let _ = fs::remove_dir(&self.folder);
    }
}
