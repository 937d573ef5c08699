//! The input and the results of one item of the reproduction.

use super::claim::Claim;
use super::paper::Paper;
use crate::engine::Failure;
use crate::picture::{Figure, png, svg};
use percuss::{Entry, Model, Parameters, Start};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// The size of the pictures and grids.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Size {
    /// Minutes.
    Default,
    /// Basins of 1000 x 1000 starts.
    Full,
}

/// The folder, size and progress that every item works with.
pub struct ItemWork<'a> {
    /// The paper's side.
    pub paper: Paper,
    /// The size of pictures and grids.
    pub size: Size,
    /// Tells of progress: to be called as often as the item has parts, whenever one is done.
    pub step: &'a (dyn Fn() + Sync),
    /// Parts of items that are kept when work is interrupted.
    pub parts: &'a dyn Parts,
}

/// A store in which finished parts of an item are kept.
pub trait Parts: Sync {
    /// A part of an earlier run of the same program.
    fn recall(&self, name: &str) -> Option<Vec<u8>>;

    /// Keeps a part.
    ///
    /// # Errors
    /// What keeps it from being written.
    fn keep(&self, name: &str, bytes: &[u8]) -> Result<(), Failure>;
}

impl ItemWork<'_> {
    /// A part that an earlier run has finished.
    pub(super) fn recall<T: DeserializeOwned>(&self, name: &str) -> Option<T> {
        serde_json::from_slice(&self.parts.recall(name)?).ok()
    }

    /// Keeps a finished part.
    pub(super) fn keep<T: Serialize>(&self, name: &str, part: &T) -> Result<(), Failure> {
        let bytes = serde_json::to_vec(part).map_err(Failure::new)?;
        self.parts.keep(name, &bytes)
    }
}

/// A picture of more marks is no SVG.
const MAX_SVG_POINTS: usize = 20_000;

/// The results of an item.
#[derive(Clone, Debug, Default)]
pub struct Findings {
    /// Claims settled.
    pub claims: Vec<Claim>,
    /// Files by name: pictures and their data.
    pub files: Vec<(String, Vec<u8>)>,
}

impl Findings {
    /// Draws a picture: PNG, and SVG where it stays small.
    ///
    /// # Errors
    /// The drawing library's reason.
    pub fn picture(&mut self, name: &str, figure: &Figure) -> Result<(), Failure> {
        self.files.push((format!("{name}.png"), png(figure).map_err(Failure::new)?));
        if figure.points() <= MAX_SVG_POINTS {
            self.files.push((format!("{name}.svg"), svg(figure).into_bytes()));
        }
        Ok(())
    }

    /// Writes a picture's data.
    ///
    /// # Errors
    /// A row that is not as long as the header.
    pub fn csv(
        &mut self,
        name: &str,
        header: &[&str],
        rows: impl IntoIterator<Item = Vec<String>>,
    ) -> Result<(), Failure> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(header).map_err(Failure::new)?;
        for row in rows {
            writer.write_record(row).map_err(Failure::new)?;
        }
        let bytes = writer.into_inner().map_err(Failure::new)?;
        self.files.push((format!("{name}.csv"), bytes));
        Ok(())
    }
}

/// A model of the paper.
pub(super) fn model(parameters: Parameters) -> Result<Model, Failure> {
    Model::new(parameters).map_err(Failure::new)
}

/// A model of the paper at rest at tau = 0.
pub(super) fn from_rest(parameters: Parameters) -> Result<(Model, Entry), Failure> {
    let model = model(parameters)?;
    let entry = model.start(&Start::default()).map_err(Failure::new)?;
    Ok((model, entry))
}
