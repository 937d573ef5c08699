//! The arrays of one name at all points, on the disk until their common shape is known.
//!
//! That shape is known at the end, and an archive takes one array after the other. Without a spool
//! each array would take a pass over all shards that joins every point anew, or all arrays would
//! have to fit in the memory.

use super::array::{Array, ArrayValues, places};
use anyhow::{Result, bail};
use std::fs::File;
use std::io::{BufReader, BufWriter, Read, Seek, Write};
use std::path::Path;

/// The type of an array's numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NumberType {
    /// Numbers of 64 bits, f8.
    F8,
    /// Integers of 32 bits, i4.
    I4,
    /// Bytes, u1.
    U1,
}

/// Arrays, one after the other, in a file without a name.
pub struct Spool {
    /// The arrays' name.
    pub name: String,
    /// The type of the numbers.
    pub kind: NumberType,
    /// The largest length along each dimension.
    pub shape: Vec<usize>,
    file: BufWriter<File>,
}

impl Spool {
    /// An empty spool for arrays like this one, beside the file that will be written.
    pub fn new(first: &Array, folder: &Path) -> Result<Self> {
        let file = BufWriter::new(tempfile::tempfile_in(folder)?);
        let shape = vec![0; first.shape.len()];
        Ok(Self { name: first.name.clone(), kind: NumberType::new(&first.values), shape, file })
    }

    /// Adds the array of the next point.
    pub fn add(&mut self, array: &Array) -> Result<()> {
        let alike = array.name == self.name
            && array.shape.len() == self.shape.len()
            && NumberType::new(&array.values) == self.kind;
        if !alike {
            bail!("the points differ in the array {}", self.name);
        }
        for (largest, length) in self.shape.iter_mut().zip(&array.shape) {
            *largest = (*largest).max(*length);
            self.file.write_all(&(*length as u64).to_le_bytes())?;
        }
        match &array.values {
            ArrayValues::F8(values) => self.write(values.iter().map(|it| it.to_le_bytes())),
            ArrayValues::I4(values) => self.write(values.iter().map(|it| it.to_le_bytes())),
            ArrayValues::U1(values) => Ok(self.file.write_all(values)?),
        }
    }

    fn write<const N: usize>(&mut self, values: impl Iterator<Item = [u8; N]>) -> Result<()> {
        for value in values {
            self.file.write_all(&value)?;
        }
        Ok(())
    }

    /// Goes back to the first point.
    pub fn rewind(self) -> Result<SpoolReader> {
        let mut file = self.file.into_inner().map_err(std::io::IntoInnerError::into_error)?;
        file.rewind()?;
        Ok(SpoolReader { shape: self.shape, file: BufReader::new(file) })
    }
}

impl NumberType {
    const fn new(values: &ArrayValues) -> Self {
        match values {
            ArrayValues::F8(_) => Self::F8,
            ArrayValues::I4(_) => Self::I4,
            ArrayValues::U1(_) => Self::U1,
        }
    }
}

/// Reads a spool from its first array on.
pub struct SpoolReader {
    shape: Vec<usize>,
    file: BufReader<File>,
}

/// A number of an array.
pub trait ArrayNumber: Copy {
    /// The value in place of a missing number.
    const NONE: Self;
    /// Reads the next number.
    fn read(file: &mut impl Read) -> std::io::Result<Self>;
}

impl ArrayNumber for f64 {
    const NONE: Self = Self::NAN;
    fn read(file: &mut impl Read) -> std::io::Result<Self> {
        let mut bytes = [0; 8];
        file.read_exact(&mut bytes)?;
        Ok(Self::from_le_bytes(bytes))
    }
}

impl ArrayNumber for i32 {
    const NONE: Self = -1;
    fn read(file: &mut impl Read) -> std::io::Result<Self> {
        let mut bytes = [0; 4];
        file.read_exact(&mut bytes)?;
        Ok(Self::from_le_bytes(bytes))
    }
}

impl ArrayNumber for u8 {
    const NONE: Self = b' ';
    fn read(file: &mut impl Read) -> std::io::Result<Self> {
        let mut byte = [0];
        file.read_exact(&mut byte)?;
        Ok(byte[0])
    }
}

impl SpoolReader {
    /// The array of the next point, padded to the shape of the largest.
    pub fn next<T: ArrayNumber>(&mut self) -> Result<Vec<T>> {
        let mut shape = Vec::with_capacity(self.shape.len());
        for _ in &self.shape {
            let mut length = [0; 8];
            self.file.read_exact(&mut length)?;
            shape.push(usize::try_from(u64::from_le_bytes(length))?);
        }
        let count: usize = shape.iter().product();
        let values: Vec<T> =
            (0..count).map(|_| T::read(&mut self.file)).collect::<std::io::Result<_>>()?;
        if shape == self.shape {
            return Ok(values);
        }
        let padded = places(&shape, &self.shape).map(|it| it.map_or(T::NONE, |it| values[it]));
        Ok(padded.collect())
    }
}
