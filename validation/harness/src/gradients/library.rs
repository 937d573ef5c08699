//! The cases of derivatives inside the binary.

use super::case::GradientCase;
use crate::case::{FileError, systems};
use include_dir::{Dir, include_dir};

static GRADIENTS: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/reference_data/gradients");

/// The cases of derivatives, in the order of their names.
///
/// # Errors
/// [`FileError`] if a table cannot be understood; a test shows that all can.
pub fn embedded() -> Result<Vec<GradientCase>, FileError> {
    let mut files: Vec<_> = GRADIENTS.files().collect();
    files.sort_by_key(|it| it.path());
    let tables = files.iter().filter_map(|it| {
        let name = it.path().to_str()?;
        name.ends_with(".csv").then_some((name, it.contents_utf8()?))
    });
    tables
        .map(|(name, text)| {
            GradientCase::read(&format!("reference_data/gradients/{name}"), text, system)
        })
        .collect()
}

/// The text of a system's file: one beside the tables, or one of the suite.
fn system(name: &str) -> Option<&'static str> {
    let own = GRADIENTS.get_file(format!("{name}.system.toml"));
    own.and_then(include_dir::File::contents_utf8).or_else(|| systems::named(name))
}
