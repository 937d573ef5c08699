//! The cases of derivatives inside the binary.

use super::case::GradientCase;
use crate::case::{FileError, systems};
use include_dir::{Dir, include_dir};

static GRADIENTS: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/reference_data/gradients");

/// The names of all cases of derivatives, in their order.
#[must_use]
pub fn names() -> Vec<&'static str> {
    let mut names: Vec<_> =
        GRADIENTS.files().filter_map(|it| it.path().to_str()?.strip_suffix(".csv")).collect();
    names.sort_unstable();
    names
}

/// The cases of derivatives with accepted names, in the order of these.
///
/// # Errors
/// [`FileError`] if a table cannot be understood; a test shows that all can.
pub fn embedded(accepts: impl Fn(&str) -> bool) -> Result<Vec<GradientCase>, FileError> {
    let accepted = names().into_iter().filter(|it| accepts(it));
    let read = |name| {
        let file = format!("{name}.csv");
        let text = GRADIENTS.get_file(&file).and_then(include_dir::File::contents_utf8);
        let file = format!("reference_data/gradients/{file}");
        GradientCase::read(&file, text.unwrap_or_default(), system)
    };
    accepted.map(read).collect()
}

/// The text of a system's file: one beside the tables, or one of the suite.
fn system(name: &str) -> Option<&'static str> {
    let own = GRADIENTS.get_file(format!("{name}.system.toml"));
    own.and_then(include_dir::File::contents_utf8).or_else(|| systems::named(name))
}
