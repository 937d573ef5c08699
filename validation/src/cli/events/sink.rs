//! The outputs of a run, which is made once for all of them.

use super::Format;
use super::draw::Drawn;
use super::progress::RunEnd;
use super::rows::{EventRow, Rows, SampleRow, Sink};
use super::write::{Csv, Json};
use crate::cli::shared::output::Opened;
use crate::cli::shared::picture::PictureFormat;
use anyhow::Result;
use percuss::{Event, Proved};

/// Several outputs of one run.
pub(super) struct All<'a>(Vec<Box<dyn Sink + 'a>>);

impl<'a> All<'a> {
    /// An output for each of the data, and one for the picture, which is made once.
    pub(super) fn new(
        opened: &'a mut [(Format, Opened)],
        backward: bool,
        shown: &'a [usize],
    ) -> Self {
        let (mut all, mut drawn): (Vec<Box<dyn Sink + 'a>>, _) = (Vec::new(), Vec::new());
        for (format, out) in opened {
            match (PictureFormat::new(*format), format) {
                (Some(format), _) => drawn.push((format, out as _)),
                (None, Format::Json) => all.push(Box::new(Json::new(out))),
                (None, _) => all.push(Box::new(Csv(out))),
            }
        }
        if !drawn.is_empty() {
            all.push(Box::new(Drawn { outputs: drawn, backward, shown, run: Vec::new() }));
        }
        Self(all)
    }
}

impl Sink for All<'_> {
    fn begin(&mut self, rows: &Rows<'_>) -> Result<()> {
        self.0.iter_mut().try_for_each(|it| it.begin(rows))
    }

    fn passed(&mut self, event: &Event<'_, Proved>) -> Result<()> {
        self.0.iter_mut().try_for_each(|it| it.passed(event))
    }

    fn event(&mut self, row: &EventRow) -> Result<()> {
        self.0.iter_mut().try_for_each(|it| it.event(row))
    }

    fn sample(&mut self, row: &SampleRow) -> Result<()> {
        self.0.iter_mut().try_for_each(|it| it.sample(row))
    }

    fn finish(&mut self, rows: &Rows<'_>, end: &RunEnd) -> Result<()> {
        self.0.iter_mut().try_for_each(|it| it.finish(rows, end))
    }
}
