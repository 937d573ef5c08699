//! The command that repeats a row, for a shell.

use crate::suite::Suite;

/// What of the command all rows share, after `-c` and `-e` with their patterns; `folders` are flags
/// with theirs.
pub(super) fn rest(suite: Suite, folders: &[(&str, String)]) -> String {
    let suite = match suite {
        Suite::Quick => "quick",
        Suite::Full => "full",
    };
    let flags = folders.iter().map(|(flag, folder)| format!(" {flag} {}", quoted(folder)));
    format!("--suite {suite} --rows{}", flags.collect::<String>())
}

/// A word that a shell takes as it is.
fn quoted(text: &str) -> String {
    format!("'{}'", text.replace('\'', "'\\''"))
}

/// The pattern that matches this name and no other, quoted for a shell.
pub(super) fn pattern(name: &str) -> String {
    // regex::escape takes hyphens for special, which they are in brackets only.
    let escaped = regex::escape(name).replace("\\-", "-");
    quoted(&format!("^{escaped}$"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pattern_matches_its_own_name_only() {
        assert_eq!(pattern("graze-overlap-1e-9"), "'^graze-overlap-1e-9$'");
        assert_eq!(pattern("a.b"), "'^a\\.b$'");
        assert_eq!(pattern("it's"), "'^it'\\''s$'");
    }

    #[test]
    fn folders_are_said_again() {
        assert_eq!(rest(Suite::Quick, &[]), "--suite quick --rows");
        let folders = [("--cases", "my cases".to_owned())];
        assert_eq!(rest(Suite::Full, &folders), "--suite full --rows --cases 'my cases'");
    }
}
