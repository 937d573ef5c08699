//! The command that repeats a row, for a shell.

use crate::suite::Suite;

/// What of the command all rows share, after `-c` and `-e` with their patterns.
pub(super) fn rest(suite: Suite) -> String {
    let suite = match suite {
        Suite::Quick => "quick",
        Suite::Full => "full",
    };
    format!("--suite {suite} --rows")
}

/// The pattern that matches this name and no other, quoted for a shell.
pub(super) fn pattern(name: &str) -> String {
    // regex::escape takes hyphens for special, which they are in brackets only.
    let escaped = regex::escape(name).replace("\\-", "-");
    format!("'^{}$'", escaped.replace('\'', "'\\''"))
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
}
