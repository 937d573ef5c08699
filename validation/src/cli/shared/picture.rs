//! The flags of pictures: what they show, their size on paper, and their ranges.

use super::parse::{self, Typed};
use super::section::without_system;
use crate::picture::{Drawing, Figure, PlotWindow, Print};
use anyhow::{Result, anyhow, bail};
use clap::{Args, ValueEnum};
use percuss::affine::SystemFile;
use percuss::system::Observable;
use std::io::Write;

/// The formats of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::cli) enum PictureFormat {
    Png,
    Svg,
}

impl PictureFormat {
    /// The format of a picture that a verb's format is by its name; none of data.
    pub(in crate::cli) fn new(format: impl ValueEnum) -> Option<Self> {
        match format.to_possible_value()?.get_name() {
            "png" => Some(Self::Png),
            "svg" => Some(Self::Svg),
            _ => None,
        }
    }
}

/// The size of a picture on paper.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Pictures")]
pub(in crate::cli) struct PrintFlags {
    /// Width and height in millimetres, as 80x60 for a column: the letters keep their size, and
    /// title and caption are left out
    #[arg(long, value_name = "WxH", value_parser = parse::millimetres, allow_hyphen_values = true)]
    size: Option<Typed<[f64; 2]>>,
    /// Pixels of a PNG in an inch, 30 to 2400 [default: 300 with --size, else 160]
    #[arg(long, value_name = "N", value_parser = parse::dpi, allow_hyphen_values = true)]
    dpi: Option<Typed<f64>>,
}

/// What a picture of one panel shows, and how large it is.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Pictures")]
pub(in crate::cli) struct PictureFlags {
    /// With SYSTEM: what is shown, as expressions of states and parameters, as "x1 - x2,v1":
    /// across and up, or one alone over time, returns or the parameter
    #[arg(long, value_name = "EXPR,EXPR", allow_hyphen_values = true)]
    show: Option<String>,
    /// Range of the vertical axis, or with four numbers of the horizontal one and of it
    #[arg(long, value_name = "LO,HI", value_parser = parse::range, allow_hyphen_values = true)]
    range: Option<Typed<PlotWindow>>,
    #[command(flatten)]
    print: PrintFlags,
}

impl PrintFlags {
    /// The flags that are given, as they are written: the size, and the density.
    fn given_flags(&self) -> [Option<String>; 2] {
        let size = self.size.as_ref().map(|it| format!("--size {it}"));
        [size, self.dpi.as_ref().map(|it| format!("--dpi {it}"))]
    }

    /// Refuses the flags where no picture is drawn, and those that it takes no notice of.
    pub(in crate::cli) fn check(&self, pictures: &[PictureFormat]) -> Result<()> {
        let [size, dpi] = self.given_flags();
        refuse(size.filter(|_| pictures.is_empty()), "png and svg")?;
        refuse(dpi.filter(|_| !pictures.contains(&PictureFormat::Png)), "png")
    }

    /// Writes a picture.
    pub(in crate::cli) fn write(
        &self,
        drawing: &impl Drawing,
        format: PictureFormat,
        out: &mut dyn Write,
    ) -> Result<()> {
        let print = Print {
            size_mm: self.size.as_ref().map(|it| it.value),
            dpi: self.dpi.as_ref().map(|it| it.value),
        };
        let bytes = match format {
            PictureFormat::Png => print.png(drawing),
            PictureFormat::Svg => print.svg(drawing).map(String::into_bytes),
        };
        let flags: Vec<String> = self.given_flags().into_iter().flatten().collect();
        let bytes = bytes.map_err(|error| match flags.is_empty() {
            true => anyhow!(error),
            false => anyhow!("{}: {error}", flags.join(" ")),
        })?;
        Ok(out.write_all(&bytes)?)
    }
}

/// Refuses a flag that has no effect.
fn refuse(flag: Option<String>, accepted: &str) -> Result<()> {
    match flag {
        Some(flag) => bail!("{flag} has no effect here: it is accepted with {accepted}"),
        None => Ok(()),
    }
}

impl PictureFlags {
    /// Refuses the flags where no picture is drawn, and those that it takes no notice of.
    pub(in crate::cli) fn check(&self, pictures: &[PictureFormat]) -> Result<()> {
        let none = pictures.is_empty();
        let show = self.show.as_ref().map(|it| format!("--show {it}"));
        let range = self.range.as_ref().map(|it| format!("--range {it}"));
        refuse(show.or(range).filter(|_| none), "png and svg")?;
        self.print.check(pictures)
    }

    /// Refuses what belongs to pictures of a SYSTEM where none is chosen.
    pub(in crate::cli) fn refuse_show(&self) -> Result<()> {
        match &self.show {
            Some(show) => bail!("{}", without_system("--show", show)),
            None => Ok(()),
        }
    }

    /// Refuses what a picture of curves in two parameters does not show.
    pub(in crate::cli) fn refuse_show_of_curves(&self) -> Result<()> {
        match &self.show {
            Some(show) => bail!(
                "--show {show} is not accepted with --second, whose picture shows both parameters"
            ),
            None => Ok(()),
        }
    }

    /// Refuses a range where panels are several and each has its own.
    pub(in crate::cli) fn refuse_range(&self) -> Result<()> {
        match &self.range {
            Some(range) => bail!(
                "--range {range} is not accepted for a picture of several panels: accepted is it \
                 with SYSTEM"
            ),
            None => Ok(()),
        }
    }

    /// The expressions that are shown, if any are named: at most so many.
    pub(in crate::cli) fn shown(&self, most: usize) -> Result<Option<Shown>> {
        let Some(text) = &self.show else { return Ok(None) };
        let names: Vec<String> = text.split(',').map(|it| it.trim().to_owned()).collect();
        if names.len() > most {
            let accepted = if most == 1 { "one expression is" } else { "one or two are" };
            bail!(
                "--show {text} is not accepted here, with {} expressions: {accepted}",
                names.len()
            );
        }
        Ok(Some(Shown { names }))
    }

    /// A figure in the range that is asked for, which is that of its first panel.
    pub(in crate::cli) fn in_range(&self, mut figure: Figure) -> Figure {
        if let (Some(range), Some(plot)) = (&self.range, figure.plots.first_mut()) {
            plot.window = Some(range.value);
        }
        figure
    }

    /// Writes a figure.
    pub(in crate::cli) fn write(
        &self,
        figure: Figure,
        format: PictureFormat,
        out: &mut dyn Write,
    ) -> Result<()> {
        self.print.write(&self.in_range(figure), format, out)
    }

    /// Writes a picture that is in its range, or has several.
    pub(in crate::cli) fn write_drawing(
        &self,
        drawing: &impl Drawing,
        format: PictureFormat,
        out: &mut dyn Write,
    ) -> Result<()> {
        self.print.write(drawing, format, out)
    }
}

/// Expressions of a system's states and parameters, one for each axis.
#[derive(Clone, Debug)]
pub(in crate::cli) struct Shown {
    /// The expressions as they are written.
    pub(in crate::cli) names: Vec<String>,
}

impl Shown {
    /// The first states of a system, at most so many.
    pub(in crate::cli) fn first_states(states: &[String], most: usize) -> Self {
        Self { names: states.iter().take(most).cloned().collect() }
    }

    /// The expressions for the parameters of a file.
    pub(in crate::cli) fn observables(&self, file: &SystemFile) -> Result<Vec<Observable>> {
        let read = |name: &String| Ok(file.observable(name, &format!("--show {name:?}"))?);
        self.names.iter().map(read).collect()
    }

    /// The expressions where a parameter has a value, which the file has from then on.
    pub(in crate::cli) fn observables_at(
        &self,
        file: &mut SystemFile,
        parameter: &str,
        value: f64,
    ) -> Result<Vec<Observable>> {
        file.set(parameter, value, "--parameter")?;
        self.observables(file)
    }

    /// The names of the axes, with that of the horizontal one where an expression stands alone.
    pub(in crate::cli) fn axes(&self, alone: &str) -> [String; 2] {
        match &self.names[..] {
            [across, up, ..] => [across.clone(), up.clone()],
            names => [alone.to_owned(), names.concat()],
        }
    }
}

/// The place of a state in a picture: across, which is `alone` for a single expression, and up.
pub(in crate::cli) fn place(
    observables: &[Observable],
    alone: f64,
    time: f64,
    state: &[f64],
) -> [f64; 2] {
    match observables {
        [across, up, ..] => [across.value(time, state), up.value(time, state)],
        [up] => [alone, up.value(time, state)],
        [] => [alone, f64::NAN],
    }
}
