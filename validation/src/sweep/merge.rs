//! Joins the shards of a sweep into one archive of arrays.
//!
//! Points are joined one after the other, and what each gives is appended to a spool for every
//! array; so the memory that this takes is that of one point, whatever the number of points.

use super::array::{Array, ArrayValues};
use super::plan::Plan;
use super::run::Sweep;
use super::shard::{Damage, TileLocation};
use super::spool::{ArrayNumber, NumberType, Spool};
use super::tiling;
use crate::arrays::Npz;
use anyhow::{Context, Result};
use npyz::{AutoSerialize, Serialize};
use std::fmt;
use std::io::Write;
use std::path::Path;

/// The error for shards that are missing or damaged, so that the sweep cannot be merged.
#[derive(Debug)]
pub struct NotMerged(Vec<(u32, Damage)>);

/// The most shards that are named.
const MAX_NAMED_SHARDS: usize = 10;

impl std::error::Error for NotMerged {}

impl fmt::Display for NotMerged {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let named = self
            .0
            .iter()
            .take(MAX_NAMED_SHARDS)
            .map(|(shard, why)| format!("shard {shard} is {why}"));
        let more = self.0.len().saturating_sub(MAX_NAMED_SHARDS);
        let more = if more > 0 { format!("; and {more} more") } else { String::new() };
        let named = named.collect::<Vec<_>>().join("; ");
        write!(f, "{named}{more}: sweep run with the same plan and folder computes what is missing")
    }
}

/// A sweep whose shards are all there and whole.
pub struct Merge<'a> {
    sweep: &'a Sweep<'a>,
    /// The place of each tile.
    places: Vec<TileLocation>,
}

impl NotMerged {
    /// The error for a folder in which no shard was begun.
    #[must_use]
    pub fn not_begun(plan: &Plan) -> Self {
        Self((0..plan.shards).map(|shard| (shard, Damage::Missing)).collect())
    }
}

impl<'a> Merge<'a> {
    /// Reads all shards once.
    ///
    /// # Errors
    /// [`NotMerged`] names shards that are missing or damaged.
    pub fn new(sweep: &'a Sweep<'a>) -> Result<Self> {
        Ok(Self { sweep, places: places(sweep)? })
    }

    /// Writes all points as an `.npz` file; spools are kept in `folder` meanwhile. `done` is called
    /// as points are done.
    ///
    /// # Errors
    /// What cannot be written, and a shard that has changed meanwhile.
    pub fn write(&self, folder: &Path, out: &mut dyn Write, done: &dyn Fn()) -> Result<()> {
        let Self { sweep, places } = self;
        let spools = spool(sweep, places, folder, done)?;
        archive(sweep, spools, out)
    }
}

/// Writes the axes, the verb's own axes, what the spools hold, and lists of names.
fn archive(sweep: &Sweep<'_>, spools: Vec<Spool>, out: &mut dyn Write) -> Result<()> {
    let axes = &sweep.plan.axes;
    let (coordinates, names) = (sweep.work.coordinates(), sweep.work.names());
    let mut archive = Npz::new(out);
    for axis in axes {
        let values = (0..axis.steps).map(|step| axis.value(step));
        let name = &axis.parameter;
        let is_taken = coordinates.iter().any(|it| it.name == *name)
            || names.iter().any(|it| it.0 == name)
            || spools.iter().any(|it| it.name == *name);
        let name = if is_taken { format!("parameter.{name}") } else { name.clone() };
        archive.add(&name, &[axis.steps as usize], values)?;
    }
    for Array { name, shape, values } in coordinates {
        match values {
            ArrayValues::F8(values) => archive.add(&name, &shape, values)?,
            ArrayValues::I4(values) => archive.add(&name, &shape, values)?,
            ArrayValues::U1(values) => archive.add(&name, &shape, values)?,
        }
    }
    let front: Vec<usize> = axes.iter().map(|it| it.steps as usize).collect();
    for spool in spools {
        match spool.kind {
            NumberType::F8 => add::<f64>(&mut archive, &front, spool)?,
            NumberType::I4 => add::<i32>(&mut archive, &front, spool)?,
            NumberType::U1 => add::<u8>(&mut archive, &front, spool)?,
        }
    }
    names.iter().try_for_each(|(name, list)| archive.add_texts(name, list))?;
    archive.finish()?;
    Ok(())
}

/// The place of each tile, if all are there.
fn places(sweep: &Sweep<'_>) -> Result<Vec<TileLocation>> {
    let mut places = Vec::new();
    let mut not_merged = Vec::new();
    for shard in 0..sweep.plan.shards {
        match sweep.shard(shard) {
            Ok(found) => places.extend(found.places()),
            Err(why) => not_merged.push((shard, why)),
        }
    }
    if !not_merged.is_empty() {
        return Err(NotMerged(not_merged).into());
    }
    places.sort_unstable_by_key(|(tile, _)| *tile);
    Ok(places.into_iter().map(|(_, place)| place).collect())
}

fn spool(
    sweep: &Sweep<'_>,
    places: &[TileLocation],
    folder: &Path,
    done: &dyn Fn(),
) -> Result<Vec<Spool>> {
    let mut spools: Vec<Spool> = Vec::new();
    let mut tile = 0;
    while tile < sweep.tiling.count() {
        // Either the points of one tile, or the blocks of one point.
        let beside = sweep.tiling.tiles_beside(tile);
        let read = |tile: u64| places[tile as usize].read(sweep.folder);
        let read = beside.clone().map(|tile| tiling::unpack(&read(tile)?));
        let pieces: Vec<Vec<Vec<u8>>> = read.collect::<Result<_>>()?;
        for (at, number) in sweep.tiling.points_of(tile).enumerate() {
            let point = sweep.plan.point(number);
            let mut blocks = pieces.iter().map(|it| it.get(at).cloned().context("a tile is cut"));
            let arrays = sweep.work.join(&point, &mut blocks);
            let arrays = arrays.with_context(|| format!("at {point}"))?;
            add_point(&mut spools, &arrays, folder)?;
            done();
        }
        tile = beside.end;
    }
    Ok(spools)
}

/// Appends the arrays of a point; the first point decides which there are.
fn add_point(spools: &mut Vec<Spool>, arrays: &[Array], folder: &Path) -> Result<()> {
    if spools.is_empty() {
        let made: Result<_> = arrays.iter().map(|it| Spool::new(it, folder)).collect();
        *spools = made?;
    }
    spools.iter_mut().zip(arrays).try_for_each(|(spool, array)| spool.add(array))
}

/// Writes what a spool holds as one array, with the axes' dimensions in front.
fn add<T: ArrayNumber + AutoSerialize + Serialize>(
    archive: &mut Npz<&mut dyn Write>,
    front: &[usize],
    spool: Spool,
) -> Result<()> {
    let shape: Vec<usize> = front.iter().chain(&spool.shape).copied().collect();
    let name = spool.name.clone();
    let points: usize = front.iter().product();
    let mut reader = spool.rewind()?;
    archive.add_by(&name, &shape, |push| {
        for _ in 0..points {
            for value in reader.next::<T>()? {
                push(value)?;
            }
        }
        Ok(())
    })
}
