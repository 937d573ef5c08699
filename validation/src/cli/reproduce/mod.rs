//! `reproduce`: the paper's tables and figures computed, its claims settled.

mod claims;
mod store;

use super::help;
use super::shared::long_work;
use super::shared::names::nearest_names;
use super::shared::output::{Destination, make_folder, reader_left, write_whole};
use super::{DONE, OUT_OF_BOUNDS, say};
use crate::engine::{Failure, hush_contained_panics};
use crate::reproduce::paper::Paper;
use crate::reproduce::{Claim, Findings, Item, ItemWork, Size, items};
use anyhow::{Context, Result, bail};
use clap::Args;
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use store::Store;

/// Compute every table and figure of the paper and settle its claims
///
/// Answers which claims of Pavlovskaia and Wiercigroch (2004) hold. A claim that
/// differs is a result, not a failure.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::REPRODUCE)]
pub(super) struct Arguments {
    /// Only these claims or items; several are alternatives
    #[arg(long, value_name = "ID")]
    only: Vec<String>,
    /// How large the grids of figure-7 are: minutes, or basins of 1000 x 1000 starts [default:
    /// default]
    #[arg(long, value_enum)]
    size: Option<Size>,
    /// Pictures, their data and claims.json go into this folder; interrupted work is taken up again
    /// there
    #[arg(long, value_name = "DIR", required = true)]
    out: PathBuf,
}

/// The item whose grids have two sizes.
const SIZED_ITEM: &str = "figure-7";

pub(super) fn run(arguments: &Arguments, threads: Option<u16>) -> Result<u8> {
    let chosen = chosen_items(&arguments.only)?;
    if arguments.size.is_some() && !chosen.iter().any(|item| item.id == SIZED_ITEM) {
        bail!("--size has no effect on what --only names: it is accepted with {SIZED_ITEM}");
    }
    let size = arguments.size.unwrap_or(Size::Default);
    make_folder(&arguments.out)?;
    let store = Store::open(&arguments.out, size)?;
    let pool = long_work::pool(threads)?;
    hush_contained_panics();
    let bar = long_work::bar(chosen.iter().map(|item| u64::from(item.parts)).sum(), "parts");
    let task = ItemWork { paper: Paper::read()?, size, step: &|| bar.inc(1), parts: &store };
    let done: Vec<Result<Vec<Claim>, Failure>> =
        pool.install(|| chosen.par_iter().map(|item| settle(item, &task, &store)).collect());
    bar.finish_and_clear();
    finish(arguments, &chosen, done, &store)
}

/// Settles an item: takes it from an earlier run that was interrupted, or computes and keeps it.
fn settle(item: &Item, work: &ItemWork, store: &Store) -> Result<Vec<Claim>, Failure> {
    if let Some(claims) = store.claims(item) {
        (0..item.parts).for_each(|_| (work.step)());
        return Ok(claims);
    }
    let Findings { claims, files } = item.run(work)?;
    store.keep(item, &claims, &files).map_err(|error| Failure::new(format!("{error:#}")))?;
    Ok(claims)
}

fn finish(
    arguments: &Arguments,
    chosen: &[&'static Item],
    done: Vec<Result<Vec<Claim>, Failure>>,
    store: &Store,
) -> Result<u8> {
    let mut settled = Vec::new();
    let mut failed = false;
    for (item, outcome) in chosen.iter().zip(done) {
        match outcome {
            Ok(claims) => {
                settled.extend(
                    claims.into_iter().filter(|it| is_wanted(&arguments.only, item, &it.id)),
                );
            }
            Err(failure) => {
                failed = true;
                say(&format!("{}: {failure}", item.id));
            }
        }
    }
    let path = arguments.out.join("claims.json");
    write_whole(&path, |out| claims::write(&settled, out)).context("--out")?;
    if !failed {
        store.close(chosen);
    }
    let table = claims::table(&settled);
    let shown = Destination::Stdout.write(|out| Ok(out.write_all(table.as_bytes())?));
    shown.or_else(|error| if reader_left(&error) { Ok(()) } else { Err(error) })?;
    Ok(if failed { OUT_OF_BOUNDS } else { DONE })
}

/// Whether a claim of an item was asked for, by its own name or the item's.
fn is_wanted(only: &[String], item: &Item, claim: &str) -> bool {
    only.is_empty() || only.iter().any(|id| id == item.id || id == claim)
}

/// Items that settle what was asked for; all where nothing was.
fn chosen_items(only: &[String]) -> Result<Vec<&'static Item>> {
    for id in only {
        if !items().iter().any(|item| item.answers_to(id)) {
            let names = items().iter().flat_map(|it| std::iter::once(&it.id).chain(it.claims));
            let names: Vec<_> = names.copied().collect();
            let near = match nearest_names(id, names.iter().copied()) {
                near if near.is_empty() => String::new(),
                near => format!("the nearest names are {}; ", near.join(", ")),
            };
            let all = names.join(", ");
            bail!("--only {id} names no claim and no item: {near}accepted are {all}");
        }
    }
    let chosen = |item: &&Item| only.is_empty() || only.iter().any(|id| item.answers_to(id));
    Ok(items().iter().filter(chosen).collect())
}

/// A file of the reproduction, whole or not at all.
fn write_file(folder: &Path, name: &str, bytes: &[u8]) -> Result<()> {
    write_whole(&folder.join(name), |out| Ok(out.write_all(bytes)?)).context("--out")
}
