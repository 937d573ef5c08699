//! Arrays for NumPy: several in one file, a zip of `.npy` files, written from first to last.

use anyhow::Result;
use npyz::{AutoSerialize, Serialize, WriterBuilder};
use std::io::{BufWriter, Write};
use zip::ZipWriter;
use zip::write::{SimpleFileOptions, StreamWriter};

/// Bytes that are compressed in one go.
const CHUNK: usize = 1 << 16;

/// A `.npz` file in the making.
pub struct Npz<W: Write>(ZipWriter<StreamWriter<W>>);

impl<W: Write> Npz<W> {
    /// Begins a file.
    #[must_use]
    pub fn new(out: W) -> Self {
        Self(ZipWriter::new_stream(out))
    }

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
        self.add_by(name, shape, |push| values.into_iter().try_for_each(push))
    }

    /// Adds an array whose values `give` hands to what it is given, one after the other.
    ///
    /// # Errors
    /// Fewer or more values than the shape holds, what the archive objects to, and what `give`
    /// returns.
    pub fn add_by<T: AutoSerialize + Serialize>(
        &mut self,
        name: &str,
        shape: &[usize],
        give: impl FnOnce(&mut dyn FnMut(T) -> Result<()>) -> Result<()>,
    ) -> Result<()> {
        let shape: Vec<u64> = shape.iter().map(|length| *length as u64).collect();
        // Larger than 4 GiB it may be, and its size is not known before it is written.
        let options = SimpleFileOptions::default().large_file(true);
        self.0.start_file(format!("{name}.npy"), options)?;
        let mut out = BufWriter::with_capacity(CHUNK, &mut self.0);
        let options = npyz::WriteOptions::new().default_dtype().shape(&shape);
        let mut writer = options.writer(&mut out).begin_nd()?;
        give(&mut |value| Ok(writer.push(&value)?))?;
        writer.finish()?;
        Ok(out.flush()?)
    }

    /// Adds a list of texts.
    ///
    /// # Errors
    /// The archive cannot be written.
    pub fn add_texts(&mut self, name: &str, texts: &[impl AsRef<str>]) -> Result<()> {
        // NumPy has no texts of length 0.
        let length = texts.iter().map(|it| it.as_ref().chars().count()).fold(1, usize::max);
        self.0.start_file(format!("{name}.npy"), SimpleFileOptions::default())?;
        let kind = npyz::DType::Plain(format!("<U{length}").parse()?);
        let options = npyz::WriteOptions::<str>::new().dtype(kind).shape(&[texts.len() as u64]);
        let mut writer = options.writer(&mut self.0).begin_nd()?;
        for text in texts {
            writer.push(text.as_ref())?;
        }
        Ok(writer.finish()?)
    }

    /// Ends the file, and gives back what it was written to.
    ///
    /// # Errors
    /// What the archive objects to.
    pub fn finish(self) -> Result<W> {
        Ok(self.0.finish()?.into_inner())
    }
}
