//! Messages on stderr: errors, notes, and their colours.

use anstream::ColorChoice as Stream;
use clap::ColorChoice;
use clap::builder::styling::{AnsiColor, Style};
use percuss::Endless;
use std::ffi::OsString;
use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};

const ERROR_STYLE: Style = AnsiColor::Red.on_default().bold();
const NOTE_STYLE: Style = AnsiColor::Yellow.on_default();

/// Whether `--quiet` was given: one process has one stderr.
static QUIET: AtomicBool = AtomicBool::new(false);

/// Takes `--quiet` and `--color` for everything that is said from here on.
pub(in crate::cli) fn configure(quiet: bool, color: ColorChoice) {
    QUIET.store(quiet, Ordering::Relaxed);
    let choice = match color {
        ColorChoice::Auto => Stream::Auto,
        ColorChoice::Always => Stream::Always,
        ColorChoice::Never => Stream::Never,
    };
    choice.write_global();
}

/// Whether notes and progress are unwanted.
pub(in crate::cli) fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// The value of `--color` before the flags are parsed: help and objections of the parser follow it
/// too.
pub(in crate::cli) fn stated_color(arguments: &[OsString]) -> ColorChoice {
    let texts: Vec<_> = arguments.iter().map(|it| it.to_string_lossy()).collect();
    let mut values = texts.iter().enumerate().filter_map(|(i, text)| match text.as_ref() {
        "--color" => texts.get(i + 1).map(AsRef::as_ref),
        text => text.strip_prefix("--color="),
    });
    values.next_back().and_then(|value| value.parse().ok()).unwrap_or(ColorChoice::Auto)
}

/// One line on stderr about an error, or about why the exit code is not 0.
pub(in crate::cli) fn say(line: &str) {
    put(ERROR_STYLE, line);
}

/// One line on stderr that `--quiet` suppresses.
pub(in crate::cli) fn note(line: &str) {
    if !is_quiet() {
        put(NOTE_STYLE, line);
    }
}

fn put(style: Style, line: &str) {
    let line = line.split_whitespace().collect::<Vec<_>>().join(" ");
    // Where stderr is closed there is no one to tell.
    let _ = writeln!(anstream::stderr(), "{style}percuss:{style:#} {line}");
}

/// The event that never happens in an endless phase.
pub(in crate::cli) const fn endless_words(endless: Endless) -> &'static str {
    match endless {
        Endless::NeverReturns => "the mass never returns to the slider",
        Endless::NeverStops => "the slider never stops",
        Endless::RestsForEver => "the mass stays on the slider for ever",
    }
}

/// The note on a run that ends in an endless phase.
pub(in crate::cli) fn endless_notice(endless: Endless) -> String {
    format!("{}: the run ends at its horizon", endless_words(endless))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn color_is_known_before_the_flags_are_parsed() {
        let stated =
            |words: &[&str]| stated_color(&words.iter().map(OsString::from).collect::<Vec<_>>());
        assert_eq!(stated(&["percuss", "engines"]), ColorChoice::Auto);
        assert_eq!(stated(&["percuss", "--color=never", "engines"]), ColorChoice::Never);
        assert_eq!(stated(&["percuss", "engines", "--color", "always"]), ColorChoice::Always);
        assert_eq!(stated(&["percuss", "--color"]), ColorChoice::Auto);
        assert_eq!(stated(&["percuss", "--color", "mauve"]), ColorChoice::Auto);
    }
}
