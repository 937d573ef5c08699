//! `basins` and `attractors` at the points of a sweep.

use crate::case::Problem;
use crate::cli::basins::json::{AttractorJson, Json};
use crate::cli::basins::{AttractorArguments, BasinArguments, GridFlags, Survey};
use crate::cli::shared::model::ModelFlags;
use crate::sweep::{Array, SweepPoint, SweepVerb, Tiles, records};
use anyhow::Result;
use percuss::dynamics::attractor::{Basins, BlockLabeller, Grid, Label, LabelledBlock};
use percuss::dynamics::strobe::StrobeMap;
use serde::Serialize;
use std::sync::{Arc, Mutex, PoisonError};

/// Labels or attractors at each point; a tile is a block of a grid's rows.
pub(super) struct BasinWork {
    grid: GridFlags,
    model: ModelFlags,
    wanted: Wanted,
    /// What blocks of one point share: the last point's, where points have several.
    last: Mutex<Option<(u64, Arc<BlockLabeller>)>>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Wanted {
    Labels,
    Attractors,
}

/// The problem, strobe map and grid of a point, before any start is labelled.
struct Ground {
    problem: Problem,
    map: StrobeMap,
    grid: Grid,
}

impl BasinWork {
    pub(super) fn labels(arguments: BasinArguments) -> Result<Self> {
        arguments.refuse_flags_of_system()?;
        Ok(Self::new(arguments.grid, arguments.model, Wanted::Labels))
    }

    pub(super) fn attractors(arguments: AttractorArguments) -> Result<Self> {
        arguments.refuse_flags_of_system()?;
        Ok(Self::new(arguments.grid, arguments.model, Wanted::Attractors))
    }

    fn new(grid: GridFlags, model: ModelFlags, wanted: Wanted) -> Self {
        model.note_replaced_by_grid();
        Self { grid, model, wanted, last: Mutex::default() }
    }

    fn ground(&self, point: &SweepPoint) -> Result<Ground> {
        let problem = self.model.at(point).problem_of_grid()?;
        let map = StrobeMap::new(problem.model, problem.entry.instant);
        let grid = self.grid.grid_of(problem.start.q);
        Ok(Ground { problem, map, grid })
    }

    /// The labeller that the blocks of a point share; it is made once for consecutive blocks.
    fn labeller(&self, point: &SweepPoint) -> Result<Arc<BlockLabeller>> {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((number, labeller)) = &*last
            && *number == point.number
        {
            return Ok(Arc::clone(labeller));
        }
        let Ground { map, grid, .. } = self.ground(point)?;
        let labeller = Arc::new(BlockLabeller::new(&map, &grid, self.grid.limits()));
        *last = Some((point.number, Arc::clone(&labeller)));
        Ok(labeller)
    }

    fn arrays(&self, problem: Problem, map: &StrobeMap, basins: Basins) -> Result<Vec<Array>> {
        let survey = Survey::new(problem, map, self.grid.limits(), basins);
        let json = Json::new(&survey);
        let Basins { grid, attractors: found, labels: all } = &survey.basins;
        match self.wanted {
            Wanted::Labels => labels([grid.columns, grid.rows], all, found.len(), &json),
            Wanted::Attractors => Ok(attractors(&json)),
        }
    }
}

/// The arrays of the verb `basins`, except its axes: labels of rows and columns, the ids of so many
/// attractors, and the verb's JSON.
pub(super) fn labels(
    [columns, rows]: [u32; 2],
    labels: &[Label],
    attractors: usize,
    json: &impl Serialize,
) -> Result<Vec<Array>> {
    let shape = [rows as usize, columns as usize];
    let ids: Vec<i32> = (0..attractors).map(|id| Label::Attractor(id).number()).collect();
    Ok(vec![
        Array::i4("labels", &shape, labels.iter().map(|label| label.number()).collect()),
        Array::i4("ids", &[ids.len()], ids),
        Array::text("meta", serde_json::to_vec(json)?),
    ])
}

/// What the verb `attractors` writes as JSON, of each attractor its first point.
fn attractors(json: &Json) -> Vec<Array> {
    let all = &json.attractors;
    let count = [all.len()];
    let numbers = |of: &dyn Fn(&AttractorJson) -> f64| all.iter().map(of).collect::<Vec<f64>>();
    let integers = |of: &dyn Fn(&AttractorJson) -> i32| all.iter().map(of).collect::<Vec<i32>>();
    let first = |it: &AttractorJson| it.points.first().copied().unwrap_or([f64::NAN; 3]);
    vec![
        Array::i4("ids", &count, integers(&|it| it.id)),
        Array::i4("kind", &count, integers(&|it| kind(it.kind))),
        Array::i4("period", &count, integers(&|it| it.period.map_or(-1, u32::cast_signed))),
        Array::f8("fraction", &count, numbers(&|it| it.fraction)),
        Array::f8("fraction_error", &count, numbers(&|it| it.fraction_error)),
        Array::f8("drift_per_period", &count, numbers(&|it| it.drift_per_period)),
        Array::f8("drift_standard_error", &count, numbers(&drift_error)),
        Array::f8("lyapunov_per_period", &count, numbers(&|it| it.lyapunov_per_period)),
        Array::f8("lyapunov_error", &count, numbers(&|it| it.lyapunov_error)),
        Array::f8("points", &[all.len(), 3], all.iter().flat_map(first).collect()),
        Array::f8("unresolved", &[], vec![json.unresolved]),
    ]
}

/// The standard error of a mean drift; NaN where the drift is none.
fn drift_error(attractor: &AttractorJson) -> f64 {
    attractor.drift_standard_error.unwrap_or(f64::NAN)
}

/// The number of a kind in files.
pub(super) fn kind(name: &str) -> i32 {
    let names = ["periodic", "chaotic", "quasi-periodic", "escaping", "equilibrium"];
    names.iter().position(|it| *it == name).map_or(-1, |place| place as i32)
}

impl SweepVerb for BasinWork {
    fn check(&self, point: &SweepPoint) -> Result<()> {
        self.model.at(point).problem_of_grid().map(drop)
    }

    fn tiles(&self) -> u32 {
        self.grid.grid_of(None).blocks()
    }

    fn tile(&self, point: &SweepPoint, tile: u32) -> Result<Vec<u8>> {
        if self.tiles() > 1 {
            return records::bytes(&self.labeller(point)?.label(tile, &|_| {}));
        }
        let Ground { problem, map, grid } = self.ground(point)?;
        let basins = Basins::new(&map, &grid, self.grid.limits(), &|_| {});
        records::bytes(&self.arrays(problem, &map, basins)?)
    }

    fn join(&self, point: &SweepPoint, tiles: Tiles<'_>) -> Result<Vec<Array>> {
        if self.tiles() == 1 {
            return records::of_single(tiles);
        }
        let blocks = tiles.map(|bytes| records::value::<LabelledBlock>(&bytes?));
        let blocks: Vec<LabelledBlock> = blocks.collect::<Result<_>>()?;
        let Ground { problem, map, grid } = self.ground(point)?;
        self.arrays(problem, &map, Basins::joined(grid, blocks))
    }

    fn coordinates(&self) -> Vec<Array> {
        let grid = self.grid.grid_of(None);
        match self.wanted {
            Wanted::Labels => vec![
                Array::f8("p", &[grid.columns as usize], grid.p()),
                Array::f8("y", &[grid.rows as usize], grid.y()),
            ],
            Wanted::Attractors => Vec::new(),
        }
    }
}
