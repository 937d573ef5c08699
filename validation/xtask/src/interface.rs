//! The library's public interface beside that of the last release, by `cargo semver-checks`.

use crate::changelog::{self, Changelog};
use crate::process::Folder;
use crate::versions;
use anyhow::{Context, Result, bail, ensure};
use semver::Version;

/// The package whose interface semantic versioning covers.
const LIBRARY: &str = "percuss";

/// Hold the library's public interface against the last release
///
/// Whether it may break is read in CHANGELOG.md: where a line of what is not released begins with
/// **Breaking:**, or the version is already one that may break, breaks are listed and accepted,
/// else they are an error. Without a tag there is nothing to hold it against, and the command
/// succeeds.
#[derive(clap::Args)]
pub struct Arguments {
    /// Tag or commit of the release [default: the last tag v* before HEAD]
    #[arg(long, value_name = "REVISION")]
    baseline: Option<String>,
}

pub fn run(root: &Folder, arguments: &Arguments) -> Result<()> {
    let text = root.read(changelog::FILE)?;
    let changelog = Changelog::parse(&text).context(changelog::FILE)?;
    let last = last_release(root)?;
    match arguments.baseline.clone().or(last) {
        Some(baseline) => {
            let may_break = changelog.breaks() || is_breaking(&baseline, &versions::current(root)?);
            check(root, &baseline, may_break)
        }
        None => {
            println!("{NO_VERSION_NOTE}");
            Ok(())
        }
    }
}

/// What is said where there is no baseline.
pub const NO_VERSION_NOTE: &str =
    "no version is tagged: there is no interface to hold this one against";

/// The tag of the highest version before the present commit.
pub fn last_release(root: &Folder) -> Result<Option<String>> {
    let tags = root.output("git", &["tag", "--merged", "HEAD", "--list", "v*"])?;
    let versions = tags.lines().filter(|tag| version_of(tag).is_some());
    Ok(versions.max_by_key(|tag| version_of(tag)).map(str::to_owned))
}

/// The version that a tag is of.
fn version_of(tag: &str) -> Option<Version> {
    Version::parse(tag.strip_prefix('v')?).ok()
}

/// Whether the workspace has a version already that may break what the baseline's tag promised:
/// while a version is made, what it breaks stands below its own heading.
fn is_breaking(baseline: &str, now: &Version) -> bool {
    version_of(baseline).is_some_and(|released| versions::may_break(&released, now))
}

/// Fails where the interface breaks beside `baseline` and may not.
pub fn check(root: &Folder, baseline: &str, may_break: bool) -> Result<()> {
    ensure!(
        root.succeeds("cargo", &["semver-checks", "--version"]),
        "needs `cargo install cargo-semver-checks --locked`"
    );
    // With `--release-type major` nothing would be looked at, and nothing listed.
    let arguments = ["semver-checks", "--package", LIBRARY, "--baseline-rev", baseline];
    let arguments = [&arguments[..], &["--release-type", "minor"]].concat();
    let status = root.status("cargo", &arguments)?;
    match status.code() {
        Some(0) => Ok(()),
        Some(BREAKING_EXIT_CODE) if may_break => {
            println!("accepted: {} says **Breaking:**, or the version may break", changelog::FILE);
            Ok(())
        }
        Some(BREAKING_EXIT_CODE) => bail!(
            "the interface breaks beside {baseline}, and no line of {} says **Breaking:**",
            changelog::FILE
        ),
        _ => bail!("cargo semver-checks ended with {status}"),
    }
}

/// The exit code of `cargo semver-checks` where the interface breaks.
const BREAKING_EXIT_CODE: i32 = 100;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_version_that_is_being_made_may_break() {
        for (baseline, minor, patch, breaks) in [
            ("v0.1.0", 2, 0, true),
            ("v0.1.0", 1, 0, false),
            ("v0.1.0", 1, 1, false),
            ("5f11b8c", 2, 0, false),
        ] {
            assert_eq!(is_breaking(baseline, &Version::new(0, minor, patch)), breaks, "{baseline}");
        }
    }
}
