//! `CHANGELOG.md` in the form of Keep a Changelog.

use anyhow::{Context, Result, bail, ensure};
use semver::Version;

pub const FILE: &str = "CHANGELOG.md";

/// The kinds of changes, as <https://keepachangelog.com/en/1.1.0/> names them.
const KINDS: [&str; 6] = ["Added", "Changed", "Deprecated", "Removed", "Fixed", "Security"];

/// The beginning of a line whose change breaks what scripts or programs rely on.
const BREAKING_PREFIX: &str = "- **Breaking:** ";

/// The most characters that a line on one change has.
const MAX_LINE_CHARACTERS: usize = 200;

const HEADING: &str = "## [Unreleased]\n";
const LINK_PREFIX: &str = "[Unreleased]: ";

/// A changelog, cut at what is not released yet.
pub struct Changelog<'a> {
    before: &'a str,
    unreleased: &'a str,
    versions: &'a str,
    /// The address that compares what is not released with the last version.
    comparison: &'a str,
    links: &'a str,
}

impl<'a> Changelog<'a> {
    /// Reads a changelog, and checks the form of what is not released.
    pub fn parse(text: &'a str) -> Result<Self> {
        let (before, rest) = text.split_once(HEADING).context("has no `## [Unreleased]`")?;
        let versions = rest.find("\n## [").context("has no version below what is not released")?;
        let (unreleased, rest) = rest.split_at(versions + 1);
        let (versions, links) =
            rest.split_once(LINK_PREFIX).context("has no link `[Unreleased]: `")?;
        let (comparison, links) = links.split_once('\n').context("ends without a line break")?;
        let changelog = Self { before, unreleased, versions, comparison, links };
        changelog.check()?;
        Ok(changelog)
    }

    /// The form: headings of known kinds, each with its changes, each of which is one line.
    fn check(&self) -> Result<()> {
        let mut kind = None;
        let mut changes = 1;
        for line in self.unreleased.lines().filter(|line| !line.is_empty()) {
            if let Some(name) = line.strip_prefix("### ") {
                ensure!(KINDS.contains(&name), "{name:?} is none of {}", KINDS.join(", "));
                ensure!(changes > 0, "`### {}` has no changes", kind.unwrap_or_default());
                (kind, changes) = (Some(name), 0);
                continue;
            }
            ensure!(kind.is_some(), "{line:?} stands before any `### `");
            ensure!(line.starts_with("- "), "{line:?} is no change: one line each, with `- `");
            let length = line.chars().count();
            ensure!(
                length <= MAX_LINE_CHARACTERS,
                "{line:?} has {length} characters of {MAX_LINE_CHARACTERS}"
            );
            changes += 1;
        }
        ensure!(changes > 0, "`### {}` has no changes", kind.unwrap_or_default());
        Ok(())
    }

    /// What is not released, without white space around it.
    pub fn unreleased(&self) -> &'a str {
        self.unreleased.trim()
    }

    /// Whether a change breaks what scripts or programs rely on.
    pub fn breaks(&self) -> bool {
        self.unreleased.lines().any(|line| line.starts_with(BREAKING_PREFIX))
    }

    /// How many changes there are of each kind: `Added 2, Changed 1`.
    pub fn counts(&self) -> String {
        let sections = self.unreleased.split("### ").skip(1);
        let count = |section: &str| {
            let mut lines = section.lines();
            let kind = lines.next().unwrap_or_default();
            format!("{kind} {}", lines.filter(|line| line.starts_with("- ")).count())
        };
        sections.map(count).collect::<Vec<_>>().join(", ")
    }

    /// The text in which everything unreleased belongs to this version of this day.
    pub fn released(&self, version: &Version, day: &str) -> Result<String> {
        if self.unreleased().is_empty() {
            bail!("nothing stands below `## [Unreleased]`");
        }
        let Self { before, versions, links, .. } = self;
        let (address, old) = self.comparison.split_once("/compare/").context("compares nothing")?;
        let old = old.strip_suffix("...HEAD").context("is not compared with HEAD")?;
        let changes = self.unreleased();
        Ok(format!(
            "{before}{HEADING}\n## [{version}] - {day}\n\n{changes}\n\n{versions}\
             {LINK_PREFIX}{address}/compare/v{version}...HEAD\n\
             [{version}]: {address}/compare/{old}...v{version}\n{links}"
        ))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a panic is a failed test")]
mod tests {
    use super::*;

    const BEFORE: &str = "# Changelog\n\n## [Unreleased]\n\n### Added\n\n- A verb.\n\n### Fixed\n\n\
        - **Breaking:** A flag.\n- A digit.\n\n## [0.1.0] - 2026-11-26\n\n### Added\n\n- All.\n\n\
        [Unreleased]: https://example.org/p/compare/v0.1.0...HEAD\n\
        [0.1.0]: https://example.org/p/releases/tag/v0.1.0\n";

    const AFTER: &str = "# Changelog\n\n## [Unreleased]\n\n## [0.2.0] - 2026-12-01\n\n### Added\n\n\
        - A verb.\n\n### Fixed\n\n- **Breaking:** A flag.\n- A digit.\n\n## [0.1.0] - 2026-11-26\n\n\
        ### Added\n\n- All.\n\n\
        [Unreleased]: https://example.org/p/compare/v0.2.0...HEAD\n\
        [0.2.0]: https://example.org/p/compare/v0.1.0...v0.2.0\n\
        [0.1.0]: https://example.org/p/releases/tag/v0.1.0\n";

    fn reason(text: &str) -> String {
        let result = Changelog::parse(text).and_then(|it| it.released(&Version::new(0, 2, 0), "d"));
        result.unwrap_err().to_string()
    }

    #[test]
    fn what_is_not_released_becomes_the_version() {
        let changelog = Changelog::parse(BEFORE).unwrap();
        assert_eq!(changelog.counts(), "Added 1, Fixed 2");
        assert!(changelog.breaks());
        assert_eq!(changelog.released(&Version::new(0, 2, 0), "2026-12-01").unwrap(), AFTER);
    }

    /// The next version is made from what the last one left behind.
    #[test]
    fn after_a_version_nothing_is_unreleased() {
        let changelog = Changelog::parse(AFTER).unwrap();
        assert!(changelog.unreleased().is_empty() && !changelog.breaks());
        assert_eq!(reason(AFTER), "nothing stands below `## [Unreleased]`");
        let more = AFTER.replace("[Unreleased]\n\n", "[Unreleased]\n\n### Fixed\n\n- More.\n\n");
        let next = Changelog::parse(&more).unwrap().released(&Version::new(0, 2, 1), "d").unwrap();
        assert!(next.contains("/compare/v0.2.1...HEAD\n[0.2.1]: https://example.org/p/compare/v0.2.0...v0.2.1\n[0.2.0]: "));
    }

    #[test]
    fn another_form_is_refused() {
        for (from, to, said) in [
            ("### Fixed", "### Mended", "\"Mended\" is none of Added, "),
            ("- A digit.", "- A digit,\n  and more.", "\"  and more.\" is no change"),
            ("- A verb.\n\n", "", "`### Added` has no changes"),
            ("- **Breaking:** A flag.\n- A digit.\n", "", "`### Fixed` has no changes"),
            ("### Added\n\n- A verb.", "- A verb.", "\"- A verb.\" stands before any"),
            ("## [Unreleased]", "## Unreleased", "has no `## [Unreleased]`"),
            ("## [0.1.0]", "## 0.1.0", "has no version below"),
            ("...HEAD", "...main", "is not compared with HEAD"),
            ("[Unreleased]: ", "[unreleased]: ", "has no link"),
        ] {
            assert!(reason(&BEFORE.replacen(from, to, 1)).starts_with(said), "{from} to {to}");
        }
        let long = BEFORE.replace("A digit", &"digit ".repeat(40));
        assert!(reason(&long).ends_with("characters of 200"));
    }

    #[test]
    fn this_projects_changelog_is_in_its_form() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../CHANGELOG.md");
        let text = std::fs::read_to_string(file).unwrap();
        let changelog = Changelog::parse(&text).unwrap();
        assert!(changelog.comparison.starts_with(env!("CARGO_PKG_REPOSITORY")));
    }
}
