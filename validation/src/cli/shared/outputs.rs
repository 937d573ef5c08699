//! The outputs of a verb that may write several of one run: which formats they have, and that each
//! file is there whole or not at all.

use super::format::chosen;
use super::output::{Destination, Opened};
use super::picture::{PictureFlags, PictureFormat};
use crate::picture::Figure;
use anyhow::{Result, bail};
use clap::{Args, ValueEnum};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The flags that say where the results of one run go, and in which formats.
#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct OutputsFlags<F: ValueEnum + Send + Sync + 'static> {
    /// Where the result goes, - is stdout; its extension is its format. Given again, the same run
    /// goes there, too
    #[arg(long, value_name = "PATH")]
    output: Vec<PathBuf>,
    /// Format where --output has no extension
    #[arg(long, value_enum)]
    format: Option<F>,
}

/// Formats, each with where it goes; at least one.
pub(in crate::cli) struct Outputs<F>(Vec<(F, Destination)>);

impl<F: ValueEnum + PartialEq + Copy + Send + Sync + 'static> OutputsFlags<F> {
    /// The outputs, where `usual` is the format of one that nothing is said of; refuses paths that
    /// cannot be written, and one that is given twice.
    pub(in crate::cli) fn outputs(&self, usual: impl Fn(&Destination) -> F) -> Result<Outputs<F>> {
        Outputs::new(&self.output, self.format, usual)
    }
}

impl<F: ValueEnum + PartialEq + Copy> Outputs<F> {
    /// The outputs of these paths, stdout where there are none; `stated` is the format of those
    /// whose extension says none.
    pub(in crate::cli) fn new(
        paths: &[PathBuf],
        stated: Option<F>,
        usual: impl Fn(&Destination) -> F,
    ) -> Result<Self> {
        check_once(paths)?;
        if paths.is_empty() {
            let destination = Destination::Stdout;
            return Ok(Self(vec![(stated.unwrap_or_else(|| usual(&destination)), destination)]));
        }
        // The format that is stated is that of the outputs without an extension, where several are.
        let is_open = |path: &&PathBuf| path.extension().is_none();
        let is_of_others = paths.len() > 1 && paths.iter().any(|path| is_open(&path));
        let output = |path: &PathBuf| {
            let destination = Destination::new(Some(path));
            let stated = stated.filter(|_| !is_of_others || is_open(&path));
            let format = chosen(Some(path), stated, usual(&destination))?;
            destination.check()?;
            Ok((format, destination))
        };
        paths.iter().map(output).collect::<Result<_>>().map(Self)
    }

    /// The formats, each once for each output of it.
    pub(in crate::cli) fn formats(&self) -> impl Iterator<Item = F> {
        self.0.iter().map(|it| it.0)
    }

    /// The formats of pictures among them.
    pub(in crate::cli) fn pictures(&self) -> Vec<PictureFormat> {
        self.formats().filter_map(PictureFormat::new).collect()
    }

    /// Whether one of the formats is of a kind.
    pub(in crate::cli) fn any(&self, kind: impl Fn(F) -> bool) -> bool {
        self.formats().any(kind)
    }

    /// Whether an output is seen on a terminal while it is written.
    pub(in crate::cli) fn is_terminal(&self) -> bool {
        self.0.iter().any(|it| it.1.is_terminal())
    }

    /// Writes what is known whole to one output after the other; no file is there before all are
    /// written.
    pub(in crate::cli) fn each(
        &self,
        mut write: impl FnMut(F, &mut dyn Write) -> Result<()>,
    ) -> Result<()> {
        self.together(|opened| opened.iter_mut().try_for_each(|(format, out)| write(*format, out)))
    }

    /// Writes data by `data`, and pictures as the figure that `figure` makes once for all of them.
    pub(in crate::cli) fn data_and_figure(
        &self,
        picture: &PictureFlags,
        mut data: impl FnMut(F, &mut dyn Write) -> Result<()>,
        figure: impl FnOnce() -> Result<Figure>,
    ) -> Result<()> {
        let is_drawn = self.any(|it| PictureFormat::new(it).is_some());
        let figure = is_drawn.then(figure).transpose()?.map(|it| picture.in_range(it));
        self.each(|format, out| match (PictureFormat::new(format), &figure) {
            (Some(format), Some(figure)) => picture.write_drawing(figure, format, out),
            _ => data(format, out),
        })
    }

    /// Writes to all outputs at once what becomes known bit by bit.
    pub(in crate::cli) fn together<T>(
        &self,
        write: impl FnOnce(&mut [(F, Opened)]) -> Result<T>,
    ) -> Result<T> {
        let open = |(format, destination): &(F, Destination)| Ok((*format, destination.open()?));
        let mut opened = self.0.iter().map(open).collect::<Result<Vec<_>>>()?;
        let written = write(&mut opened)?;
        opened.into_iter().try_for_each(|(_, out)| out.finish())?;
        Ok(written)
    }
}

/// Refuses a path that is given twice, stdout among them.
fn check_once(paths: &[PathBuf]) -> Result<()> {
    let same = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    for (n, path) in paths.iter().enumerate() {
        if paths[..n].iter().any(|it| same(it) == same(path)) {
            bail!("--output {} is given twice: accepted is each path once", path.display());
        }
    }
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a panic is a failed test")]
mod tests {
    use super::*;

    #[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
    enum Kind {
        Csv,
        Png,
    }

    fn formats(paths: &[&str], stated: Option<Kind>) -> Result<Vec<Kind>> {
        let paths: Vec<PathBuf> = paths.iter().map(PathBuf::from).collect();
        Ok(Outputs::new(&paths, stated, |_| Kind::Csv)?.formats().collect())
    }

    #[test]
    fn extensions_pick_formats_and_the_rest_has_the_one_that_is_stated() {
        assert_eq!(formats(&[], None).unwrap(), [Kind::Csv]);
        assert_eq!(formats(&[], Some(Kind::Png)).unwrap(), [Kind::Png]);
        assert_eq!(formats(&["a.png", "-"], None).unwrap(), [Kind::Png, Kind::Csv]);
        let stated = formats(&["a.csv", "picture"], Some(Kind::Png));
        assert_eq!(stated.unwrap(), [Kind::Csv, Kind::Png]);
        assert!(formats(&["a.csv"], Some(Kind::Png)).is_err());
        assert!(formats(&["a.csv", "b.csv"], Some(Kind::Png)).is_err());
    }

    #[test]
    fn a_path_is_accepted_once() {
        for twice in [["a.csv", "a.csv"], ["-", "-"], ["a.csv", "./a.csv"]] {
            let error = formats(&twice, None).unwrap_err().to_string();
            assert!(error.contains("given twice"), "{error}");
        }
    }
}
