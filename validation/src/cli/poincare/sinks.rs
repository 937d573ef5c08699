//! The outputs of a section, which is made once for all of them.

use anyhow::Result;
use std::io::Write;

/// A point of a section.
pub(super) struct Point<'a> {
    pub(super) n: u64,
    /// The time and the mode, of a SYSTEM.
    pub(super) time: f64,
    pub(super) mode: usize,
    pub(super) state: &'a [f64],
}

/// An output of a section.
pub(super) trait Sink {
    fn point(&mut self, point: &Point<'_>) -> Result<()>;
    fn finish(&mut self) -> Result<()>;
}

/// Several outputs of one section.
pub(super) struct All<'a>(pub(super) Vec<Box<dyn Sink + 'a>>);

impl Sink for All<'_> {
    fn point(&mut self, point: &Point<'_>) -> Result<()> {
        self.0.iter_mut().try_for_each(|it| it.point(point))
    }

    fn finish(&mut self) -> Result<()> {
        self.0.iter_mut().try_for_each(|it| it.finish())
    }
}

/// Lines of text, each made of a point.
pub(super) struct Lines<'a> {
    pub(super) out: &'a mut dyn Write,
    pub(super) line: Box<dyn Fn(&Point<'_>) -> String + 'a>,
}

impl Sink for Lines<'_> {
    fn point(&mut self, point: &Point<'_>) -> Result<()> {
        Ok(writeln!(self.out, "{}", (self.line)(point))?)
    }

    fn finish(&mut self) -> Result<()> {
        Ok(())
    }
}

/// Writes all points.
type Writer<'a, T> = Box<dyn Fn(Vec<T>, &mut dyn Write) -> Result<()> + 'a>;

/// All points at once: what is drawn, and arrays whose length stands before their numbers.
pub(super) struct Collected<'a, T> {
    pub(super) out: &'a mut dyn Write,
    pub(super) of: Box<dyn Fn(&Point<'_>) -> T + 'a>,
    pub(super) points: Vec<T>,
    pub(super) write: Writer<'a, T>,
}

impl<T> Sink for Collected<'_, T> {
    fn point(&mut self, point: &Point<'_>) -> Result<()> {
        self.points.push((self.of)(point));
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        (self.write)(std::mem::take(&mut self.points), &mut *self.out)
    }
}
