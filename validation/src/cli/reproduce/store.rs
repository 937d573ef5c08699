//! Finished items beside the pictures, so that interrupted work is taken up again.

use super::write_file;
use crate::engine::Failure;
use crate::reproduce::{Claim, Item, Parts, Size};
use anyhow::{Result, anyhow};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};

/// The folder in which parts are kept, which is gone when all is done.
const FOLDER: &str = ".unfinished";

pub(super) struct Store {
    out: PathBuf,
    folder: PathBuf,
    key: String,
}

/// A part of an item that is not finished: the key on its first line, then the part.
impl Parts for Store {
    fn recall(&self, name: &str) -> Option<Vec<u8>> {
        let bytes = fs::read(self.part(name)).ok()?;
        let rest = bytes.strip_prefix(self.key.as_bytes())?.strip_prefix(b"\n")?;
        Some(rest.to_vec())
    }

    fn keep(&self, name: &str, bytes: &[u8]) -> Result<(), Failure> {
        let kept = [self.key.as_bytes(), b"\n", bytes].concat();
        write_file(&self.folder, &part(name), &kept)
            .map_err(|error| Failure::new(format!("{error:#}")))
    }
}

fn part(name: &str) -> String {
    format!("{name}.part")
}

/// A finished item.
#[derive(Serialize, Deserialize)]
struct KeptItem {
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

    fn part(&self, name: &str) -> PathBuf {
        self.folder.join(part(name))
    }

    /// The claims of an item that an earlier run of the same program has finished.
    pub(super) fn claims(&self, item: &Item) -> Option<Vec<Claim>> {
        let text = fs::read_to_string(self.path(item)).ok()?;
        let kept: KeptItem = serde_json::from_str(&text).ok()?;
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
        let kept = KeptItem { key: self.key.clone(), claims: claims.to_vec(), files: names };
        write_file(&self.folder, &format!("{}.json", item.id), &serde_json::to_vec(&kept)?)
    }

    /// All of these are done: nothing is left to take up.
    pub(super) fn close(&self, done: &[&Item]) {
        // What cannot be removed is only ignored by the next program.
        for item in done {
            let _ = fs::remove_file(self.path(item));
            item.kept.iter().for_each(|name| {
                let _ = fs::remove_file(self.part(name));
            });
        }
        let _ = fs::remove_dir(&self.folder);
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a panic is a failed test")]
mod tests {
    use super::*;
    use crate::reproduce::items;

    fn files() -> Vec<(String, Vec<u8>)> {
        vec![("a.csv".to_owned(), b"1".to_vec())]
    }

    #[test]
    fn what_is_finished_is_taken_up() {
        let folder = tempfile::tempdir().unwrap();
        let item = &items()[0];
        let store = Store::open(folder.path(), Size::Default).unwrap();
        assert!(store.claims(item).is_none());
        store.keep(item, &[], &files()).unwrap();
        assert_eq!(store.claims(item), Some(Vec::new()));
        assert_eq!(fs::read(folder.path().join("a.csv")).unwrap(), b"1");
        let larger = Store::open(folder.path(), Size::Full).unwrap();
        assert!(larger.claims(item).is_none(), "of another size");
        fs::remove_file(folder.path().join("a.csv")).unwrap();
        assert!(store.claims(item).is_none(), "a file of it is gone");
        store.close(&[item]);
        assert!(!folder.path().join(FOLDER).exists());
    }

    #[test]
    fn parts_are_taken_up_by_the_same_program_only() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path(), Size::Default).unwrap();
        Parts::keep(&store, "frame", b"part\nof it").unwrap();
        assert_eq!(store.recall("frame"), Some(b"part\nof it".to_vec()));
        let larger = Store::open(folder.path(), Size::Full).unwrap();
        assert_eq!(larger.recall("frame"), None);
    }
}
