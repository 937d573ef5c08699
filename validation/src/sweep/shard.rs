//! A shard's file: one line of JSON, the tiles' bytes, and the SHA-256 of all that.

use super::folder::{ComputedBy, Folder};
use super::plan::hexadecimal;
use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fmt;
use std::fs::File;
use std::io::{self, BufRead, BufReader, ErrorKind, Read, Seek, SeekFrom};

/// The first line of a shard's file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShardHead {
    /// The identity of the sweep that the shard belongs to.
    pub identity: Identity,
    /// The shard's number, from 0.
    pub shard: u32,
    /// The seconds that the shard took.
    pub seconds: f64,
    /// The tiles, in order, and how many bytes each has.
    pub tiles: Vec<(u64, u64)>,
}

/// The values that must be the same in all shards that are joined.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    /// The format's number.
    pub schema: u32,
    /// The plan's hash.
    pub plan: String,
    /// The program that computed the shard.
    pub program: ComputedBy,
}

/// A shard's file that is whole and belongs to the sweep.
#[derive(Debug)]
pub struct Shard {
    /// The file's first line.
    pub head: ShardHead,
    /// The place at which the tiles begin.
    from: u64,
}

/// The reason why a shard's file cannot be used.
#[derive(Debug)]
pub enum Damage {
    /// The shard has no file.
    Missing,
    /// The shard's file is damaged, in the way that the text says.
    Damaged(String),
}

/// The bytes of the checksum at the end: a line break, 64 digits, a line break.
const CHECKSUM_BYTES: u64 = 66;
/// The most bytes of the first line.
const MAX_HEAD_BYTES: u64 = 1 << 30;

impl fmt::Display for Damage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing => f.write_str("missing"),
            Self::Damaged(why) => write!(f, "damaged: {why}"),
        }
    }
}

impl From<io::Error> for Damage {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            ErrorKind::NotFound => Self::Missing,
            ErrorKind::UnexpectedEof => Self::Damaged("it is truncated".to_owned()),
            _ => Self::Damaged(error.to_string()),
        }
    }
}

/// Writes a shard.
///
/// # Errors
/// A folder that cannot be written.
pub fn write(folder: &Folder, head: &ShardHead, tiles: &[Vec<u8>]) -> Result<()> {
    let mut line = serde_json::to_vec(head)?;
    line.push(b'\n');
    let mut parts: Vec<&[u8]> = vec![&line];
    parts.extend(tiles.iter().map(Vec::as_slice));
    let mut hash = Sha256::new();
    parts.iter().for_each(|part| hash.update(part));
    let checksum = format!("\n{}\n", hexadecimal(&hash.finalize()));
    parts.push(checksum.as_bytes());
    folder.write_shard(head.shard, &parts)
}

impl Shard {
    /// Reads a shard's file whole, and checks that it is what was written for this sweep.
    ///
    /// # Errors
    /// Says why it cannot be used.
    pub fn open(
        folder: &Folder,
        identity: &Identity,
        shard: u32,
        tiles: &[u64],
    ) -> Result<Self, Damage> {
        let damaged = |why: &str| Damage::Damaged(why.to_owned());
        let file = File::open(folder.shard(shard))?;
        let length = file.metadata()?.len();
        let body = length.checked_sub(CHECKSUM_BYTES).ok_or_else(|| damaged("it is truncated"))?;
        let mut file = BufReader::new(file);
        let mut hash = Sha256::new();
        io::copy(&mut (&mut file).take(body), &mut hash)?;
        let mut checksum = String::new();
        let stated = file.read_to_string(&mut checksum);
        if stated.is_err() || checksum != format!("\n{}\n", hexadecimal(&hash.finalize())) {
            return Err(damaged("its checksum does not fit: it is truncated or altered"));
        }
        file.rewind()?;
        let mut line = Vec::new();
        (&mut file).take(MAX_HEAD_BYTES.min(body)).read_until(b'\n', &mut line)?;
        let head: ShardHead = serde_json::from_slice(&line)
            .map_err(|error| Damage::Damaged(format!("its first line is none ({error})")))?;
        if head.identity != *identity {
            return Err(damaged(head.identity.difference(identity)));
        }
        if head.shard != shard {
            return Err(Damage::Damaged(format!("it is shard {} under a wrong name", head.shard)));
        }
        let from = line.len() as u64;
        let sum: u64 = head.tiles.iter().map(|it| it.1).sum();
        if !head.tiles.iter().map(|it| &it.0).eq(tiles) || from + sum != body {
            return Err(damaged("it has other tiles"));
        }
        Ok(Self { head, from })
    }

    /// The places of the tiles in the file, and their lengths, in order.
    pub fn places(&self) -> impl Iterator<Item = (u64, TileLocation)> {
        let shard = self.head.shard;
        let places = self.head.tiles.iter().scan(self.from, move |from, (tile, length)| {
            let place = TileLocation { shard, from: *from, length: *length };
            *from += length;
            Some((*tile, place))
        });
        places.collect::<Vec<_>>().into_iter()
    }
}

/// The place of a tile's bytes.
#[derive(Clone, Copy, Debug)]
pub struct TileLocation {
    shard: u32,
    from: u64,
    length: u64,
}

impl TileLocation {
    /// The tile's bytes.
    ///
    /// # Errors
    /// A file that cannot be read any more.
    pub fn read(&self, folder: &Folder) -> Result<Vec<u8>> {
        let name = Folder::name(self.shard);
        let mut bytes = Vec::new();
        let read = File::open(folder.shard(self.shard)).and_then(|mut file| {
            file.seek(SeekFrom::Start(self.from))?;
            file.take(self.length).read_to_end(&mut bytes)
        });
        read.with_context(|| format!("{name} cannot be read"))?;
        Ok(bytes)
    }
}

impl Identity {
    /// The first difference from another identity.
    fn difference(&self, other: &Self) -> &'static str {
        if self.plan == other.plan {
            "it is of another version of percuss, or of another arithmetic"
        } else {
            "it is of another plan"
        }
    }
}
