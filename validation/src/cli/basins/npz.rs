//! The labels as arrays for NumPy: a zip of `.npy` files.

use super::Survey;
use super::json::{Json, id};
use anyhow::Result;
use npyz::{AutoSerialize, Serialize, WriterBuilder};
use percuss::dynamics::attractor::Label;
use std::io::{Cursor, Write};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

type Archive = ZipWriter<Cursor<Vec<u8>>>;

/// `labels` int32 [NY, NX], `p` f8 [NX], `y` f8 [NY], `ids` int32, `meta` the JSON as bytes.
pub(super) fn bytes(survey: &Survey, json: &Json) -> Result<Vec<u8>> {
    let basins = &survey.basins;
    let (columns, rows) = (u64::from(basins.grid.columns), u64::from(basins.grid.rows));
    let ids: Vec<i32> = (0..basins.attractors.len()).map(|k| id(Label::Attractor(k))).collect();
    let meta = serde_json::to_vec(json)?;
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let labels = basins.labels.iter().map(|label| id(*label));
    add(&mut archive, "labels", &[rows, columns], labels)?;
    add(&mut archive, "p", &[columns], basins.grid.p().into_iter())?;
    add(&mut archive, "y", &[rows], basins.grid.y().into_iter())?;
    add(&mut archive, "ids", &[ids.len() as u64], ids.into_iter())?;
    add(&mut archive, "meta", &[meta.len() as u64], meta.into_iter())?;
    Ok(archive.finish()?.into_inner())
}

fn add<T: AutoSerialize + Serialize>(
    archive: &mut Archive,
    name: &str,
    shape: &[u64],
    values: impl Iterator<Item = T>,
) -> Result<()> {
    archive.start_file(format!("{name}.npy"), SimpleFileOptions::default())?;
    let mut array = Vec::new();
    let options = npyz::WriteOptions::new().default_dtype().shape(shape);
    let mut writer = options.writer(&mut array).begin_nd()?;
    writer.extend(values)?;
    writer.finish()?;
    Ok(archive.write_all(&array)?)
}
