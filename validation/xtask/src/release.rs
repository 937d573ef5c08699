//! Makes a version: its checks, its files, its measurements, its commits and its tag.

use crate::changelog::{self, Changelog};
use crate::edit::Edit;
use crate::interface;
use crate::process::Folder;
use crate::versions;
use anyhow::{Context, Result, ensure};
use semver::Version;
use std::path::PathBuf;
use std::time::Instant;

/// The page whose first block of commands makes the scoreboard.
const SCOREBOARD: &str = "docs/SCOREBOARD.md";

/// Make a version: checks, changelog, version numbers, speed, scoreboard, packages, tag
///
/// Everything is done by default, in this order: the interface (cargo install cargo-semver-checks),
/// the files, the checks of .ci/run (half an hour on two cores), a trial of `cargo publish` for
/// every package (minutes), a commit, the speed (minutes; needs valgrind and a QUIET MACHINE), the
/// scoreboard (half an hour and the integrators of other languages; times in it need a QUIET
/// MACHINE), a second commit, the tag. Nothing is pushed or published.
#[derive(clap::Args)]
pub struct Arguments {
    /// The new version, such as 0.2.0
    version: Version,
    /// Shows what would change in which file, and does nothing
    #[arg(long)]
    dry_run: bool,
    /// The day of the version [default: today]
    #[arg(long, value_name = "YYYY-MM-DD")]
    date: Option<String>,
    /// Leaves out `cargo xtask interface`
    #[arg(long)]
    without_interface: bool,
    /// Leaves out .ci/run, which is run with the new version
    #[arg(long)]
    without_checks: bool,
    /// Leaves out the trial of `cargo publish`
    #[arg(long)]
    without_packages: bool,
    /// Leaves out `percuss bench record`: benches/history.jsonl lacks this version
    #[arg(long)]
    without_speed: bool,
    /// Leaves out the scoreboard: docs/SCOREBOARD.md stays that of an earlier version
    #[arg(long)]
    without_scoreboard: bool,
}

/// The folder in which packed packages are compiled.
const TRIAL_FOLDER: &str = "target/trial";

/// What a version changes.
struct Plan {
    /// The version before.
    old: Version,
    /// The files to be written.
    edits: Vec<Edit>,
    /// How many changes there are of each kind.
    counts: String,
    /// The message of the tag: what changed.
    changes: String,
    /// Whether the interface may break.
    may_break: bool,
}

pub fn run(root: &Folder, arguments: &Arguments) -> Result<()> {
    let day = match &arguments.date {
        Some(day) => day.parse::<chrono::NaiveDate>().with_context(|| format!("--date {day}"))?,
        None => chrono::Utc::now().date_naive(),
    };
    let plan = plan(root, &arguments.version, &day.to_string())?;
    if arguments.dry_run {
        plan.edits.iter().for_each(|edit| print!("{edit}"));
        steps(arguments).iter().for_each(|step| println!("{step}"));
        return Ok(());
    }
    check_clean(root)?;
    make(root, arguments, &plan)
}

/// Makes the version, up to its tag.
fn make(root: &Folder, arguments: &Arguments, plan: &Plan) -> Result<()> {
    let version = &arguments.version;
    let begun = Instant::now();
    let step = |name: &str| println!("\n== {name} ({}s)", begun.elapsed().as_secs());
    if !arguments.without_interface {
        step("interface");
        hold_interface(root, plan.may_break)?;
    }
    step("files");
    write(root, arguments, plan, &step)
        .context("nothing is committed yet: `git restore .` takes back what is written")?;
    let body = format!("{} since {}; CHANGELOG.md has them all.", plan.counts, plan.old);
    commit(root, &format!("release: version {version}"), &body)?;

    measure(root, arguments, &step).context(
        "the version is committed and has no tag: `git reset --hard HEAD~1` takes it back",
    )?;

    step("tag");
    let tag = tag(version);
    root.run("git", &["tag", "--annotate", "--cleanup=verbatim", "-m", &plan.changes, &tag])?;
    println!("\n{tag} is made, and nothing is pushed. To publish it:");
    println!("  git push origin HEAD {tag}\n  cargo publish --workspace --locked");
    println!("Its speed beside that of the version before:");
    println!("  cargo run --release -- bench compare {} {version}", plan.old);
    Ok(())
}

fn tag(version: &Version) -> String {
    format!("v{version}")
}

/// What the version changes, or why there can be none.
fn plan(root: &Folder, version: &Version, day: &str) -> Result<Plan> {
    let old = versions::current(root)?;
    ensure!(*version > old, "{version} does not come after {old}");
    ensure!(version.build.is_empty(), "{version}: a version has no build metadata");
    let tag = tag(version);
    let tagged = root.output("git", &["tag", "--list", &tag])?;
    ensure!(tagged.is_empty(), "the tag {tag} is there already");
    let text = root.read(changelog::FILE)?;
    let changelog = Changelog::parse(&text).context(changelog::FILE)?;
    ensure!(
        !changelog.breaks() || versions::may_break(&old, version),
        "{version} may not break what {old} promised, but {} says **Breaking:**",
        changelog::FILE
    );
    let mut edits = vec![Edit::new(root, changelog::FILE, |_| changelog.released(version, day))?];
    edits.extend(versions::edits(root, &old, version, day)?);
    Ok(Plan {
        edits,
        counts: changelog.counts(),
        changes: format!("percuss {version}\n\n{}\n", changelog.unreleased()),
        may_break: changelog.breaks(),
        old,
    })
}

/// The long steps, with those that are left out.
fn steps(arguments: &Arguments) -> Vec<String> {
    let steps = [
        ("cargo xtask interface", arguments.without_interface),
        (".ci/run", arguments.without_checks),
        ("cargo publish --workspace --dry-run", arguments.without_packages),
        ("percuss bench record --instructions (quiet machine)", arguments.without_speed),
        ("docs/SCOREBOARD.md (quiet machine)", arguments.without_scoreboard),
    ];
    steps
        .map(|(name, out)| format!("{}: {name}", if out { "left out" } else { "would run" }))
        .into()
}

/// What is not committed would be in no version, or in one that nobody has seen.
fn check_clean(root: &Folder) -> Result<()> {
    let changed = root.output("git", &["status", "--porcelain"])?;
    ensure!(changed.is_empty(), "not everything is committed:\n{changed}");
    Ok(())
}

/// Holds the interface against that of the last version, where there is one.
fn hold_interface(root: &Folder, may_break: bool) -> Result<()> {
    match interface::last_release(root)? {
        Some(baseline) => interface::check(root, &baseline, may_break),
        None => {
            println!("{}", interface::NO_VERSION_NOTE);
            Ok(())
        }
    }
}

/// Writes the files of the version, checks them, and tries whether its packages can be published.
fn write(root: &Folder, arguments: &Arguments, plan: &Plan, step: &impl Fn(&str)) -> Result<()> {
    plan.edits.iter().try_for_each(|edit| edit.write(root))?;
    // Fails where a manifest and the lock file do not fit together.
    root.output("cargo", &["tree", "--workspace", "--depth", "0", "--locked"])?;
    if !arguments.without_checks {
        step("checks");
        root.run("bash", &[".ci/run"])?;
    }
    if !arguments.without_packages {
        step("a trial of `cargo publish`");
        packages(root, &arguments.version)?;
    }
    Ok(())
}

/// Packs every package that is published, in the order of their dependencies, compiles what was
/// packed, and uploads nothing.
fn packages(root: &Folder, version: &Version) -> Result<()> {
    forget_unpacked(version)?;
    // What an earlier trial of the same version compiled there, cargo would take for the new one's.
    let target = root.path(TRIAL_FOLDER);
    if target.exists() {
        std::fs::remove_dir_all(&target).with_context(|| target.display().to_string())?;
    }
    let what = ["publish", "--workspace", "--dry-run", "--locked", "--allow-dirty"];
    root.run("cargo", &[&what[..], &["--target-dir", TRIAL_FOLDER]].concat())
        .context("a package cannot be published (cargo before 1.90 can try none)")
}

/// Removes what an earlier trial of the same version has unpacked: cargo would take it for the new
/// one.
fn forget_unpacked(version: &Version) -> Result<()> {
    let given = std::env::var_os("CARGO_HOME").map(PathBuf::from);
    let usual = || std::env::home_dir().map(|home| home.join(".cargo"));
    let home = given.or_else(usual).context("there is no home folder")?;
    let Ok(registries) = std::fs::read_dir(home.join("registry/src")) else { return Ok(()) };
    for registry in registries {
        let registry = registry?;
        // Registries in a folder have a name that is a hash alone.
        if !registry.file_name().to_string_lossy().starts_with('-') {
            continue;
        }
        for package in std::fs::read_dir(registry.path())? {
            let package = package?;
            let name = package.file_name().to_string_lossy().into_owned();
            if name.starts_with("percuss") && name.ends_with(&format!("-{version}")) {
                std::fs::remove_dir_all(package.path())?;
            }
        }
    }
    Ok(())
}

/// The speed and the scores of the version's commit, which stands in both.
fn measure(root: &Folder, arguments: &Arguments, step: &impl Fn(&str)) -> Result<()> {
    let mut measured = Vec::new();
    if !arguments.without_speed {
        step("speed: nothing else should run on this machine");
        let record = ["run", "--release", "--locked", "--", "bench", "record", "--instructions"];
        root.run("cargo", &record)?;
        measured.push("benches/history.jsonl by `percuss bench record --instructions`");
    }
    if !arguments.without_scoreboard {
        step("scoreboard: nothing else should run on this machine");
        let page = root.read(SCOREBOARD)?;
        let commands = first_commands(&page).context(SCOREBOARD)?;
        root.run("bash", &["-euo", "pipefail", "-c", commands])?;
        measured.push("docs/SCOREBOARD.md by the commands on it");
    }
    if !measured.is_empty() {
        let version = &arguments.version;
        let body = format!("{}, at the commit before.", measured.join(",\n"));
        commit(root, &format!("release: measurements of {version}"), &body)?;
    }
    Ok(())
}

/// The first block of commands on a page.
fn first_commands(page: &str) -> Result<&str> {
    let block = page.split_once("\n```sh\n").and_then(|(_, rest)| rest.split_once("```\n"));
    Ok(block.context("has no block of commands")?.0)
}

fn commit(root: &Folder, subject: &str, body: &str) -> Result<()> {
    root.run("git", &["commit", "--all", "--quiet", "-m", subject, "-m", body])
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a panic is a failed test")]
mod tests;
