//! A run of a system as arrays for NumPy. The number of rows stands at the beginning of an array,
//! so that rows wait in a file without a name until it is known: a long run costs no memory.

use super::system_choice::event_names;
use crate::arrays::Npz;
use anyhow::Result;
use npyz::WriterBuilder;
use percuss::System;
use std::fs::File;
use std::io::{BufReader, BufWriter, Read, Seek, Write};
use std::path::Path;

/// The number of an event in a row that has none.
const NO_EVENT: i32 = -1;

pub(in crate::cli) struct Arrays<'a> {
    out: &'a mut dyn Write,
    system: &'a System,
    is_archive: bool,
    /// Whether rows are those of events.
    has_events: bool,
    waiting: BufWriter<File>,
    rows: usize,
    /// The names of events, and those of endings that came.
    names: Vec<String>,
}

/// A row that has waited.
#[derive(Default)]
struct Waited {
    time: f64,
    mode: i32,
    event: i32,
    state: Vec<f64>,
}

impl<'a> Arrays<'a> {
    /// The states alone.
    pub(in crate::cli) fn npy(
        out: &'a mut dyn Write,
        system: &'a System,
        folder: &Path,
    ) -> Result<Self> {
        Self::new(out, system, folder, false)
    }

    /// All that rows hold.
    pub(in crate::cli) fn npz(
        out: &'a mut dyn Write,
        system: &'a System,
        folder: &Path,
    ) -> Result<Self> {
        Self::new(out, system, folder, true)
    }

    fn new(
        out: &'a mut dyn Write,
        system: &'a System,
        folder: &Path,
        is_archive: bool,
    ) -> Result<Self> {
        let waiting = BufWriter::new(tempfile::tempfile_in(folder)?);
        let names = event_names(system).into_iter().map(str::to_owned).collect();
        Ok(Self { out, system, is_archive, has_events: true, waiting, rows: 0, names })
    }

    /// Rows that are not those of events.
    pub(in crate::cli) fn without_events(self) -> Self {
        Self { has_events: false, ..self }
    }

    /// The number of an event's name.
    fn number(&mut self, name: Option<&str>) -> i32 {
        let Some(name) = name else { return NO_EVENT };
        let known = self.names.iter().position(|it| it == name);
        let place = known.unwrap_or_else(|| {
            self.names.push(name.to_owned());
            self.names.len() - 1
        });
        i32::try_from(place).unwrap_or(NO_EVENT)
    }
}

impl Arrays<'_> {
    /// Adds a row, with the name of its event where it has one.
    pub(in crate::cli) fn row(
        &mut self,
        time: f64,
        mode: usize,
        event: Option<&str>,
        state: &[f64],
    ) -> Result<()> {
        let event = self.number(event);
        self.rows += 1;
        self.waiting.write_all(&time.to_le_bytes())?;
        self.waiting.write_all(&i32::try_from(mode)?.to_le_bytes())?;
        self.waiting.write_all(&event.to_le_bytes())?;
        state.iter().try_for_each(|it| self.waiting.write_all(&it.to_le_bytes()))?;
        Ok(())
    }

    /// Writes what has waited.
    pub(in crate::cli) fn finish(&mut self) -> Result<()> {
        self.waiting.flush()?;
        let system = self.system;
        let states = system.states.len();
        let (rows, file) = (self.rows, self.waiting.get_mut());
        let mut each = |give: &mut dyn FnMut(&Waited) -> Result<()>| each(file, rows, states, give);
        if !self.is_archive {
            let shape = [rows as u64, states as u64];
            let options = npyz::WriteOptions::<f64>::new().default_dtype().shape(&shape);
            let mut writer = options.writer(&mut *self.out).begin_nd()?;
            each(&mut |it| Ok(writer.extend(it.state.iter().copied())?))?;
            return Ok(writer.finish()?);
        }
        let modes: Vec<&str> = system.modes.iter().map(|it| it.name.as_str()).collect();
        let mut archive = Npz::new(&mut *self.out);
        archive.add_by("time", &[rows], |push| each(&mut |it| push(it.time)))?;
        archive.add_by("mode", &[rows], |push| each(&mut |it| push(it.mode)))?;
        if self.has_events {
            archive.add_by("event", &[rows], |push| each(&mut |it| push(it.event)))?;
        }
        archive.add_by("state", &[rows, states], |push| {
            each(&mut |it| it.state.iter().try_for_each(|value| push(*value)))
        })?;
        archive.add_texts("modes", &modes)?;
        archive.add_texts("states", &system.states)?;
        if self.has_events {
            archive.add_texts("events", &self.names)?;
        }
        archive.finish()?;
        Ok(())
    }
}

/// Gives each row that waits in a file, the first to the last.
fn each(
    file: &mut File,
    rows: usize,
    states: usize,
    give: &mut dyn FnMut(&Waited) -> Result<()>,
) -> Result<()> {
    file.rewind()?;
    let mut file = BufReader::new(file);
    let mut row = Waited { state: vec![0.0; states], ..Waited::default() };
    for _ in 0..rows {
        row.time = f64::from_le_bytes(bytes(&mut file)?);
        row.mode = i32::from_le_bytes(bytes(&mut file)?);
        row.event = i32::from_le_bytes(bytes(&mut file)?);
        for value in &mut row.state {
            *value = f64::from_le_bytes(bytes(&mut file)?);
        }
        give(&row)?;
    }
    Ok(())
}

fn bytes<const N: usize>(file: &mut impl Read) -> Result<[u8; N]> {
    let mut bytes = [0; N];
    file.read_exact(&mut bytes)?;
    Ok(bytes)
}
