//! Which format is written: the extension of --output, or --format where there is none.

use super::output::Destination;
use anyhow::{Result, bail};
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};

/// The flags that say where a result goes, and in which format.
#[derive(Args, Clone, Debug)]
pub(in crate::cli) struct OutputFlags<F: ValueEnum + Send + Sync + 'static> {
    /// Where the result goes, - is stdout; its extension is its format
    #[arg(long, value_name = "PATH")]
    output: Option<PathBuf>,
    /// Format where --output has no extension
    #[arg(long, value_enum)]
    format: Option<F>,
}

impl<F: ValueEnum + PartialEq + Send + Sync + 'static> OutputFlags<F> {
    /// The format that --output and --format agree on, or else `usual`; refuses a path that cannot
    /// be written.
    pub(in crate::cli) fn format(&self, usual: F) -> Result<F> {
        let format = chosen(self.output.as_deref(), self.format.clone(), usual)?;
        self.destination().check()?;
        Ok(format)
    }

    pub(in crate::cli) fn destination(&self) -> Destination {
        Destination::new(self.output.as_deref())
    }
}

/// Chooses a format as [`OutputFlags::format`] does, for verbs whose flags are described otherwise.
pub(in crate::cli) fn chosen<F: ValueEnum + PartialEq>(
    output: Option<&Path>,
    stated: Option<F>,
    usual: F,
) -> Result<F> {
    let extension = output.and_then(Path::extension).and_then(|extension| extension.to_str());
    let known = extension.and_then(|extension| F::from_str(extension, true).ok());
    match (known, stated, extension) {
        (Some(known), Some(stated), _) if known != stated => {
            bail!(
                "--format {} contradicts --output {}: accepted is one format",
                name(&stated),
                output.unwrap_or(Path::new("")).display()
            )
        }
        (Some(format), ..) | (None, Some(format), _) => Ok(format),
        (None, None, Some(extension))
            if !output.is_some_and(|path| path.exists() && !path.is_file()) =>
        {
            let accepted: Vec<_> = F::value_variants().iter().map(name).collect();
            bail!(
                "--output {}: extension {extension} is not accepted: {}, or --format",
                output.unwrap_or(Path::new("")).display(),
                accepted.join(", ")
            )
        }
        (None, None, _) => Ok(usual),
    }
}

fn name<F: ValueEnum>(format: &F) -> String {
    format.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
}
