//! A file of an answer, a line of CSV an event or a sample.

use crate::text::plain;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// The ending of the name of a file of events, after the case's name.
pub const EVENTS_ENDING: &str = ".events.csv";
/// The ending of the name of a file of samples, after the case's name.
pub const SAMPLES_ENDING: &str = ".samples.csv";

/// The ending of the name of a file of derivatives, after the case's name.
pub const GRADIENTS_ENDING: &str = ".gradients.csv";

/// The largest file that is read: 100000 events of the largest system, at 25 characters a number,
/// are half as much.
const MAX_BYTES: u64 = 64 << 20;

/// A file that was read, with its name for errors.
pub(super) struct Table {
    shown: String,
    text: String,
}

/// A line of a table.
pub(super) struct Cells<'a> {
    /// The number of the line in its file, from 1.
    pub(super) line: usize,
    cells: Vec<&'a str>,
}

impl Table {
    /// Reads a file.
    ///
    /// # Errors
    /// A file that is not there, that is too large, or that is not UTF-8.
    pub(super) fn read(path: &Path) -> Result<Self, String> {
        let shown = plain(&path.display().to_string());
        let refused = |what: &str| format!("{shown}: {what}");
        let unreadable = |error: std::io::Error| refused(&format!("{error}; accepted is a file"));
        // A pipe that no one writes to would be waited for.
        if !std::fs::metadata(path).map_err(unreadable)?.is_file() {
            return Err(refused("it is no file; accepted is a file"));
        }
        let mut bytes = Vec::new();
        let file = File::open(path).map_err(unreadable)?;
        file.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(unreadable)?;
        if bytes.len() as u64 > MAX_BYTES {
            return Err(refused(&format!("it is larger than the {MAX_BYTES} bytes accepted")));
        }
        match String::from_utf8(bytes) {
            Ok(text) => Ok(Self { shown, text }),
            Err(error) => {
                let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
                let line = 1 + valid.iter().filter(|byte| **byte == b'\n').count();
                Err(format!("{shown} line {line}: a byte that is not UTF-8; accepted is UTF-8"))
            }
        }
    }

    /// An error in the whole file.
    pub(super) fn error(&self, what: &str) -> String {
        format!("{}: {what}", self.shown)
    }

    /// An error in one line of the file.
    pub(super) fn error_in(&self, line: usize, what: &str) -> String {
        format!("{} line {line}: {what}", self.shown)
    }

    /// The columns that the header names.
    pub(super) fn header(&self) -> Vec<&str> {
        cells(self.without_mark().lines().next().unwrap_or_default())
    }

    /// The error of a header that is none of those accepted.
    pub(super) fn other_header(&self, accepted: &str) -> String {
        let header = plain(self.without_mark().lines().next().unwrap_or_default());
        self.error_in(1, &format!("the columns are {header:?}; accepted are {accepted}"))
    }

    /// The text without the mark of its encoding that some programs write.
    fn without_mark(&self) -> &str {
        self.text.trim_start_matches('\u{feff}')
    }

    /// Hands over its lines after the header, which has to name these columns.
    ///
    /// # Errors
    /// Another header, a line of another length, and what `read` refuses in a line.
    pub(super) fn lines<'a>(
        &'a self,
        columns: &[impl AsRef<str>],
        mut read: impl FnMut(&Cells<'a>) -> Result<(), String>,
    ) -> Result<(), String> {
        let columns: Vec<&str> = columns.iter().map(AsRef::as_ref).collect();
        if self.header() != columns {
            return Err(self.other_header(&format!("{:?}", columns.join(","))));
        }
        let lines = self.without_mark().lines().zip(1..).skip(1);
        for (text, line) in lines.filter(|(text, _)| !text.trim().is_empty()) {
            let cells = Cells { line, cells: cells(text) };
            let (count, wanted) = (cells.cells.len(), columns.len());
            let read = if count == wanted {
                read(&cells)
            } else {
                Err(format!("{count} columns; accepted are {wanted}"))
            };
            read.map_err(|what| self.error_in(line, &what))?;
        }
        Ok(())
    }
}

/// The cells of a line. Some languages put quotes around words; no word here has a comma.
fn cells(line: &str) -> Vec<&str> {
    line.split(',').map(|cell| unquoted(cell.trim())).collect()
}

fn unquoted(cell: &str) -> &str {
    cell.strip_prefix('"').and_then(|cell| cell.strip_suffix('"')).unwrap_or(cell)
}

impl<'a> Cells<'a> {
    /// The word in a column.
    pub(super) fn word(&self, column: usize) -> &'a str {
        self.cells.get(column).copied().unwrap_or_default()
    }

    /// The number in a column called `name`.
    ///
    /// # Errors
    /// What is no number, or none that is finite.
    pub(super) fn number(&self, column: usize, name: &str) -> Result<f64, String> {
        let text = self.word(column);
        let value = text.parse().ok().filter(|value: &f64| value.is_finite());
        value.ok_or_else(|| format!("{name} is {:?}; accepted is a finite number", plain(text)))
    }
}
