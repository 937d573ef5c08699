//! `poincare SYSTEM`: the returns of one motion to a section.

use super::sinks::{All, Collected, Lines, Point, Sink};
use super::{Arguments, Format, figure};
use crate::cli::shared::long_work::{self, Bar};
use crate::cli::shared::output::Opened;
use crate::cli::shared::outputs::Outputs;
use crate::cli::shared::picture::{PictureFormat, Shown, place};
use crate::cli::shared::run_arrays::Arrays;
use crate::cli::shared::section::{RETURNS_PER_UPDATE, tell_no_return, tell_undecidable};
use crate::cli::shared::system_choice::ChosenSystem;
use crate::number::shortest;
use crate::picture::Figure;
use anyhow::Result;
use percuss::affine::{NoReturn, Solver, System};
use percuss::system::Observable;
use percuss_programs::files::printed_column;
use std::borrow::Cow;
use std::io::Write;

/// Writes the section; whether the motion was decided to its end.
pub(super) fn run(
    arguments: &Arguments,
    chosen: &ChosenSystem,
    outputs: &Outputs<Format>,
    count: u64,
) -> Result<bool> {
    let system = chosen.system()?;
    let solver = Solver::<f64>::new(&system)?;
    let map = arguments.section_of_system.map(arguments.section.as_ref(), &solver)?;
    let shown = arguments.picture.shown(2)?;
    let shown = shown.unwrap_or_else(|| Shown::first_states(&system.states, 2));
    let observables = shown.observables(&chosen.file)?;
    let bar = long_work::run_bar(outputs.is_terminal());
    let mut returns = map.returns(system.start()?)?;
    let (mut seen, mut end) = (0, None);
    let all = arguments.transient + count;
    let passed = returns.by_ref().take(all as usize).map_while(|it| {
        seen += 1;
        if let Some(bar) = bar.as_ref().filter(|_| seen % RETURNS_PER_UPDATE == 0) {
            bar.show_share(seen as f64 / all as f64);
        }
        end = it.as_ref().err().copied();
        it.ok()
    });
    let mut points = passed.skip(arguments.transient as usize);
    let made = Made { arguments, system: &system, shown: &shown, observables: &observables };
    outputs.together(|opened| {
        let sinks = opened.iter_mut().map(|(format, out)| made.sink(*format, out));
        let mut all = All(sinks.collect::<Result<_>>()?);
        (0..).zip(points.by_ref()).try_for_each(|(n, it)| {
            all.point(&Point { n, time: it.time, mode: it.mode, state: &it.state })
        })?;
        all.finish()
    })?;
    bar.iter().for_each(Bar::finish_and_clear);
    tell_undecidable(returns.undecidable());
    Ok(end.is_none_or(|why: NoReturn| tell_no_return(why, seen - 1)))
}

/// A section of a system that is written.
struct Made<'a> {
    arguments: &'a Arguments,
    system: &'a System,
    shown: &'a Shown,
    observables: &'a [Observable],
}

impl Made<'_> {
    fn sink<'s>(&'s self, format: Format, out: &'s mut Opened) -> Result<Box<dyn Sink + 's>> {
        if let Some(format) = PictureFormat::new(format) {
            return Ok(Box::new(Collected {
                out,
                of: Box::new(|it| place(self.observables, it.n as f64, it.time, it.state)),
                points: Vec::new(),
                write: Box::new(move |points, out| {
                    self.arguments.picture.write(self.drawing(points), format, out)
                }),
            }));
        }
        let folder = out.folder();
        Ok(match format {
            Format::Npy => Box::new(Arrays::npy(out, self.system, &folder)?.without_events()),
            Format::Npz => Box::new(Arrays::npz(out, self.system, &folder)?.without_events()),
            _ => {
                let columns: Vec<Cow<'_, str>> =
                    self.system.states.iter().map(|it| printed_column(it)).collect();
                writeln!(out, "n,time,mode,{}", columns.join(","))?;
                Box::new(Lines { out, line: Box::new(|it| self.line(it)) })
            }
        })
    }

    fn line(&self, point: &Point<'_>) -> String {
        let state: Vec<_> = point.state.iter().map(|it| shortest(*it)).collect();
        let (time, mode) = (shortest(point.time), &self.system.modes[point.mode].name);
        format!("{},{time},{mode},{}", point.n, state.join(","))
    }

    /// The plane of what is shown, or one quantity from return to return.
    fn drawing(&self, points: Vec<[f64; 2]>) -> Figure {
        let section = self.arguments.section.as_ref().map_or("strobe", |it| it.text.as_str());
        let caption = format!(
            "{} returns to {section}, after {} returns",
            points.len(),
            self.arguments.transient
        );
        figure(self.system.name.clone(), caption, self.shown.axes("return"), points)
    }
}

impl Sink for Arrays<'_> {
    fn point(&mut self, point: &Point<'_>) -> Result<()> {
        self.row(point.time, point.mode, None, point.state)
    }

    fn finish(&mut self) -> Result<()> {
        Self::finish(self)
    }
}
