//! The labels as arrays for NumPy.

use super::Survey;
use super::json::Json;
use crate::arrays::Npz;
use anyhow::Result;
use percuss::dynamics::attractor::Label;

/// `labels` int32 [NY, NX], `p` f8 [NX], `y` f8 [NY], `ids` int32, `meta` the JSON as bytes.
pub(super) fn bytes(survey: &Survey, json: &Json) -> Result<Vec<u8>> {
    let basins = &survey.basins;
    let (columns, rows) = (basins.grid.columns as usize, basins.grid.rows as usize);
    let ids: Vec<i32> =
        (0..basins.attractors.len()).map(|k| Label::Attractor(k).number()).collect();
    let meta = serde_json::to_vec(json)?;
    let mut archive = Npz::new(Vec::new());
    archive.add("labels", &[rows, columns], basins.labels.iter().map(|label| label.number()))?;
    archive.add("p", &[columns], basins.grid.p())?;
    archive.add("y", &[rows], basins.grid.y())?;
    archive.add("ids", &[ids.len()], ids)?;
    archive.add("meta", &[meta.len()], meta)?;
    archive.finish()
}
