//! The library's public interface beside that of the last release, by `cargo semver-checks`.

use crate::changelog::{self, Changelog};
use crate::process::Folder;
use anyhow::{Context, Result, bail, ensure};
use semver::Version;

/// The package whose interface semantic versioning covers.
const LIBRARY: &str = "percuss";

/// Hold the library's public interface against the last release
///
/// Whether it may break is read in CHANGELOG.md: where a line of what is not released begins with
/// **Breaking:**, breaks are listed and accepted, else they are an error. Without a tag there is
/// nothing to hold it against, and the command succeeds.
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
    let Some(baseline) = arguments.baseline.clone().or(last) else {
        println!("no version is tagged: there is no interface to hold this one against");
        return Ok(());
    };
    check(root, &baseline, changelog.breaks())
}

/// The tag of the highest version before the present commit.
pub fn last_release(root: &Folder) -> Result<Option<String>> {
    let tags = root.output("git", &["tag", "--merged", "HEAD", "--list", "v*"])?;
    let version = |tag: &&str| tag.strip_prefix('v').and_then(|it| Version::parse(it).ok());
    let versions = tags.lines().filter(|tag| version(tag).is_some());
    Ok(versions.max_by_key(version).map(str::to_owned))
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
        Some(BREAKS) if may_break => {
            println!("accepted: {} says **Breaking:**", changelog::FILE);
            Ok(())
        }
        Some(BREAKS) => bail!(
            "the interface breaks beside {baseline}, and no line of {} says **Breaking:**",
            changelog::FILE
        ),
        _ => bail!("cargo semver-checks ended with {status}"),
    }
}

/// The exit code of `cargo semver-checks` where the interface breaks.
const BREAKS: i32 = 100;
