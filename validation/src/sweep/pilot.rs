//! The pilot: what tiles cost, counted on a coarse grid of points.
//!
//! Events are counted, no time is measured, so that every program finds the same. Points between
//! those of the pilot are taken to cost what the nearest one does.

use super::deal::Deal;
use super::folder::Folder;
use super::plan::{Plan, digest};
use super::tiling::Tiling;
use super::verb::SweepVerb;
use anyhow::{Context, Result};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Points of the pilot along an axis, at most.
const ALONG: u32 = 8;
/// Steps between two points of the pilot, at least, where a point is a single tile: its pilot may
/// cost as much as the tile.
const APART: u32 = 4;

/// The costs that the pilot run has counted.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct PilotCosts {
    plan: String,
    /// The costs of the tiles of each point of the pilot, by the point's number.
    costs: BTreeMap<u64, Vec<u64>>,
    digest: String,
}

/// Tiles dealt to shards.
#[derive(Clone, Debug)]
pub struct Dealt {
    /// The deal.
    pub deal: Deal,
    /// What the deal was made from, in hexadecimal digits: shards of two deals do not fit.
    pub digest: String,
}

/// Deals the tiles of a plan, by a pilot where that can make a difference.
///
/// # Errors
/// What the verb objects to, and a folder that cannot be written.
pub fn dealt(plan: &Plan, work: &dyn SweepVerb, tiling: Tiling, folder: &Folder) -> Result<Dealt> {
    let tiles = tiling.count();
    if plan.shards == 1 || u64::from(plan.shards) == tiles {
        let even = vec![1; usize::try_from(tiles)?];
        return Ok(Dealt { deal: Deal::new(&even, plan.shards), digest: "even".to_owned() });
    }
    let counted = match recalled(plan, folder) {
        Some(counted) => counted,
        None => {
            let counted = count(plan, work)?;
            folder.write_pilot(&serde_json::to_vec(&counted)?)?;
            counted
        }
    };
    let stride = strides(plan, work);
    let cost = |tile: u64| {
        let block = tiling.block_of(tile) as usize;
        let of = |point| counted.costs.get(&nearest(plan, &stride, point))?.get(block).copied();
        tiling.points_of(tile).map(of).sum::<Option<u64>>().context("the pilot lacks a point")
    };
    let costs: Vec<u64> = (0..tiles).map(cost).collect::<Result<_>>()?;
    Ok(Dealt { deal: Deal::new(&costs, plan.shards), digest: counted.digest })
}

/// The pilot that is kept in the folder; none where it is damaged or of another plan.
fn recalled(plan: &Plan, folder: &Folder) -> Option<PilotCosts> {
    let counted: PilotCosts = serde_json::from_slice(&folder.read_pilot()?).ok()?;
    let is_whole = counted.digest == digest_of(&counted.costs).ok()?;
    (counted.plan == plan.hash && is_whole).then_some(counted)
}

fn count(plan: &Plan, work: &dyn SweepVerb) -> Result<PilotCosts> {
    let stride = strides(plan, work);
    let is_pilot = |point: &u64| nearest(plan, &stride, *point) == *point;
    let points: Vec<u64> = (0..plan.points()).filter(is_pilot).collect();
    let costs: Result<BTreeMap<_, _>> =
        points.into_par_iter().map(|point| Ok((point, work.costs(&plan.point(point))?))).collect();
    let costs = costs?;
    let digest = digest_of(&costs)?;
    Ok(PilotCosts { plan: plan.hash.clone(), costs, digest })
}

fn digest_of(costs: &BTreeMap<u64, Vec<u64>>) -> Result<String> {
    Ok(digest(&serde_json::to_vec(costs)?))
}

/// Steps between the pilot's points, along each axis.
fn strides(plan: &Plan, work: &dyn SweepVerb) -> Vec<u32> {
    let least = if work.tiles() == 1 { APART } else { 1 };
    plan.axes.iter().map(|axis| axis.steps.div_ceil(ALONG).max(least)).collect()
}

/// The pilot's point that is nearest to a point.
fn nearest(plan: &Plan, stride: &[u32], point: u64) -> u64 {
    let steps = plan.steps_of(point);
    plan.axes.iter().zip(steps).zip(stride).fold(0, |number, ((axis, step), stride)| {
        let last = (axis.steps - 1) / stride;
        let near = ((step + stride / 2) / stride).min(last) * stride;
        number * u64::from(axis.steps) + u64::from(near)
    })
}
