//! `new`: a system's file to begin with.

use super::help;
use super::note;
use super::shared::output;
use anyhow::{Result, bail};
use clap::Args;
use std::path::Path;

/// The file, in which the name stands for itself.
const FILE: &str = include_str!("new.system.toml");

/// The name in [`FILE`].
const NAME: &str = "my-rig";

/// Write a commented system file to begin with
///
/// Writes NAME.system.toml: a mass on a spring that is driven against a stop,
/// with a comment on each table. It runs as it is; change it to your own system,
/// and let `percuss check` say what it means.
#[derive(Args)]
#[command(verbatim_doc_comment, after_long_help = help::NEW)]
pub(super) struct Arguments {
    /// The name of the system: lower-case words joined by hyphens
    #[arg(value_name = "NAME", value_parser = name)]
    name: String,
}

pub(super) fn run(arguments: &Arguments) -> Result<()> {
    let name = &arguments.name;
    let file = format!("{name}.system.toml");
    let path = Path::new(&file);
    if path.symlink_metadata().is_ok() {
        bail!("NAME {name} is not accepted: {file} is there already; accepted is another name");
    }
    let text = FILE.replace(NAME, name);
    output::write_whole(path, |out| Ok(out.write_all(text.as_bytes())?))?;
    note(&format!("{file} is written; percuss check {file} says what it means"));
    Ok(())
}

/// A system's name.
fn name(text: &str) -> Result<String, String> {
    let belongs = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit();
    let is_word = |word: &str| !word.is_empty() && word.chars().all(belongs);
    match text.split('-').all(is_word) {
        true => Ok(text.to_owned()),
        false => Err("accepted are lower-case words joined by hyphens".to_owned()),
    }
}
