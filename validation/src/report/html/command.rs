//! The command that repeats a row, for a shell.

use crate::suite::Suite;

/// The verb that makes a row again; only `score` has answers in a folder.
pub(super) fn verb(folders: &[(&str, String)]) -> &'static str {
    if folders.iter().any(|(flag, _)| *flag == "--answers") { "score" } else { "validate" }
}

/// What of the command all rows share, after `-c` and `-e` with their patterns; `folders` are flags
/// with theirs.
pub(super) fn rest(suite: Suite, folders: &[(&str, String)]) -> String {
    let suite = match suite {
        Suite::Quick => "quick",
        Suite::Full => "full",
    };
    let flags = folders.iter().map(|(flag, folder)| format!(" {flag} {}", quote(folder)));
    let flags = flags.collect::<String>();
    if verb(folders) == "score" {
        return format!("--rows{flags}");
    }
    format!("--suite {suite} --rows{flags}")
}

/// A word that a shell takes as it is.
fn quote(text: &str) -> String {
    format!("'{}'", text.replace('\'', "'\\''"))
}

/// The pattern that matches this name and no other, quoted for a shell.
pub(super) fn pattern(name: &str) -> String {
    // regex::escape takes hyphens for special, which they are in brackets only.
    let escaped = regex::escape(name).replace("\\-", "-");
    quote(&format!("^{escaped}$"))
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
        let folders = [("--answers", "a".to_owned()), ("--name", "mine".to_owned())];
        assert_eq!(verb(&folders), "score");
        assert_eq!(rest(Suite::Quick, &folders), "--rows --answers 'a' --name 'mine'");
    }
}
