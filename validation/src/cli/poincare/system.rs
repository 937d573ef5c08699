//! `poincare SYSTEM`: the returns of one motion to a section.

use super::{Arguments, Format, MAX_PICTURE, draw_points, write_rows};
use crate::cli::shared::long_work::{self, Bar};
use crate::cli::shared::section::{RARELY, tell_no_return, tell_undecidable};
use crate::cli::shared::system_choice::ChosenSystem;
use crate::number::shortest;
use anyhow::{Result, bail};
use percuss::affine::{NoReturn, Return, Solver, System};
use percuss_programs::files::printed_column;
use std::borrow::Cow;
use std::io::Write;

/// Writes the section; whether the motion was decided to its end.
pub(super) fn run(
    arguments: &Arguments,
    chosen: &ChosenSystem,
    format: Format,
    count: u64,
) -> Result<bool> {
    let system = chosen.system()?;
    let solver = Solver::<f64>::new(&system)?;
    let map = arguments.section_of_system.map(arguments.section.as_ref(), &solver)?;
    let destination = arguments.output.destination();
    let bar = long_work::run_bar(destination.is_terminal());
    let mut returns = map.returns(system.start()?)?;
    let (mut seen, mut end) = (0, None);
    let all = arguments.transient + count;
    let shown = returns.by_ref().take(all as usize).map_while(|it| {
        seen += 1;
        if let Some(bar) = bar.as_ref().filter(|_| seen % RARELY == 0) {
            bar.show_share(seen as f64 / all as f64);
        }
        end = it.as_ref().err().copied();
        it.ok()
    });
    let points = shown.skip(arguments.transient as usize);
    destination.write(|out| match format {
        Format::Csv => write_csv(&system, points, out),
        Format::Npy => {
            let cut = |written| format!("the section ends after {written} points of {count}");
            let shape = [count, system.states.len() as u64];
            write_rows(points.map(|it| it.state), shape, cut, out)
        }
        Format::Png => draw(&system, points, arguments, out),
    })?;
    bar.iter().for_each(Bar::finish_and_clear);
    tell_undecidable(returns.undecidable());
    Ok(end.is_none_or(|why: NoReturn| tell_no_return(why, seen - 1)))
}

fn write_csv(
    system: &System,
    points: impl Iterator<Item = Return<f64>>,
    out: &mut dyn Write,
) -> Result<()> {
    let columns: Vec<Cow<'_, str>> = system.states.iter().map(|it| printed_column(it)).collect();
    writeln!(out, "n,time,mode,{}", columns.join(","))?;
    for (n, point) in points.enumerate() {
        let state: Vec<_> = point.state.iter().map(|it| shortest(*it)).collect();
        let (time, mode) = (shortest(point.time), &system.modes[point.mode].name);
        writeln!(out, "{n},{time},{mode},{}", state.join(","))?;
    }
    Ok(())
}

/// The plane of the first two states; of a system with one state, the returns one by one.
fn draw(
    system: &System,
    points: impl Iterator<Item = Return<f64>>,
    arguments: &Arguments,
    out: &mut dyn Write,
) -> Result<()> {
    let axes = match &system.states[..] {
        [first, second, ..] => [first.clone(), second.clone()],
        states => ["return".to_owned(), states.concat()],
    };
    let place = |(n, it): (usize, Return<f64>)| match it.state[..] {
        [first, second, ..] => [first, second],
        _ => [n as f64, it.state[0]],
    };
    let points: Vec<[f64; 2]> = points.enumerate().map(place).collect();
    let section = arguments.section.as_ref().map_or("strobe", |it| it.text.as_str());
    let caption =
        format!("{} returns to {section}, after {} returns", points.len(), arguments.transient);
    draw_points(system.name.clone(), caption, axes, points, out)
}

/// Refuses a picture of more points than show anything.
pub(super) fn check_size(format: Format, count: u64) -> Result<()> {
    if format == Format::Png && count > MAX_PICTURE {
        bail!("--returns {count} is not accepted for a picture: at most {MAX_PICTURE}");
    }
    Ok(())
}
