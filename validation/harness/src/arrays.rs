//! Arrays for NumPy: several in one file, a zip of `.npy` files.

use anyhow::Result;
use npyz::{AutoSerialize, Serialize, WriterBuilder};
use std::io::{Cursor, Write};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

/// A `.npz` file in the making.
pub struct Npz(ZipWriter<Cursor<Vec<u8>>>);

impl Default for Npz {
    fn default() -> Self {
        Self(ZipWriter::new(Cursor::new(Vec::new())))
    }
}

impl Npz {
    /// Adds an array of this shape, last index fastest.
    ///
    /// # Errors
    /// Fewer or more values than the shape holds, or what the archive objects to.
    pub fn add<T: AutoSerialize + Serialize>(
        &mut self,
        name: &str,
        shape: &[usize],
        values: impl IntoIterator<Item = T>,
    ) -> Result<()> {
        let shape: Vec<u64> = shape.iter().map(|length| *length as u64).collect();
        self.0.start_file(format!("{name}.npy"), SimpleFileOptions::default())?;
        let mut array = Vec::new();
        let options = npyz::WriteOptions::new().default_dtype().shape(&shape);
        let mut writer = options.writer(&mut array).begin_nd()?;
        writer.extend(values)?;
        writer.finish()?;
        Ok(self.0.write_all(&array)?)
    }

    /// The file.
    ///
    /// # Errors
    /// What the archive objects to.
    pub fn bytes(self) -> Result<Vec<u8>> {
        Ok(self.0.finish()?.into_inner())
    }
}
