use super::*;
use clap::Parser;
use std::path::Path;

const CHANGELOG: &str = "# Changelog\n\n## [Unreleased]\n\n### Added\n\n- A verb.\n\n\
    ## [0.1.0] - 2026-11-26\n\n[Unreleased]: https://example.org/p/compare/v0.1.0...HEAD\n";

/// A repository of a workspace of one package, with one commit.
struct Repository {
    folder: tempfile::TempDir,
    root: Folder,
}

impl Repository {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let root = Folder::at(folder.path());
        let write = |path: &str, text: &str| write(folder.path(), path, text);
        write(
            "Cargo.toml",
            "[workspace]\nmembers = [\".\"]\n\n[workspace.package]\nversion = \"0.1.0\"\n\n\
             [package]\nname = \"percuss\"\nversion.workspace = true\nedition = \"2024\"\n",
        );
        write(
            "Cargo.lock",
            "version = 4\n\n[[package]]\nname = \"percuss\"\nversion = \"0.1.0\"\n",
        );
        write("src/lib.rs", "");
        write("CITATION.cff", "version: 0.1.0\ndate-released: 2026-11-26\n");
        write("CHANGELOG.md", CHANGELOG);
        root.run("git", &["init", "--quiet"]).unwrap();
        root.run("git", &["config", "user.name", "A developer"]).unwrap();
        root.run("git", &["config", "user.email", "developer@example.org"]).unwrap();
        root.run("git", &["add", "."]).unwrap();
        commit(&root, "first", "body").unwrap();
        Self { folder, root }
    }

    fn release(&self, version: &str, flags: &[&str]) -> Result<()> {
        let skipped = ["interface", "checks", "packages", "speed", "scoreboard"];
        let skipped = skipped.map(|it| format!("--without-{it}"));
        let words = ["release", version, "--date", "2026-12-01"];
        let words = words.iter().chain(flags).copied().chain(skipped.iter().map(String::as_str));
        run(&self.root, &Words::try_parse_from(words).unwrap().arguments)
    }

    fn said(&self, arguments: &[&str]) -> String {
        self.root.output("git", arguments).unwrap()
    }
}

fn write(folder: &Path, path: &str, text: &str) {
    let path = folder.join(path);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, text).unwrap();
}

fn commit_file(it: &Repository, name: &str) {
    write(it.folder.path(), name, "");
    it.root.run("git", &["add", name]).unwrap();
    commit(&it.root, name, "body").unwrap();
}

#[derive(Parser)]
struct Words {
    #[command(flatten)]
    arguments: Arguments,
}

#[test]
fn a_version_is_committed_and_tagged() {
    let it = Repository::new();
    it.release("0.1.1", &[]).unwrap();
    assert_eq!(it.said(&["status", "--porcelain"]), "");
    assert_eq!(it.said(&["describe"]), "v0.1.1");
    assert_eq!(it.said(&["log", "-1", "--format=%s"]), "release: version 0.1.1");
    let message = it.said(&["tag", "--list", "--format=%(contents)", "v0.1.1"]);
    assert_eq!(message, "percuss 0.1.1\n\n### Added\n\n- A verb.");
    let changed = it.said(&["diff", "--name-only", "HEAD~1"]);
    assert_eq!(changed, "CHANGELOG.md\nCITATION.cff\nCargo.lock\nCargo.toml");
    assert_eq!(versions::current(&it.root).unwrap(), Version::new(0, 1, 1));
    let error = it.release("0.1.2", &[]).unwrap_err();
    assert!(format!("{error:#}").ends_with("nothing stands below `## [Unreleased]`"), "{error:#}");
}

#[test]
fn a_dry_run_changes_nothing() {
    let it = Repository::new();
    it.release("0.2.0", &["--dry-run"]).unwrap();
    assert_eq!(it.said(&["status", "--porcelain"]), "");
    assert_eq!(it.said(&["rev-list", "--count", "HEAD"]), "1");
    assert_eq!(it.said(&["tag"]), "");
}

#[test]
fn a_version_that_cannot_be_is_refused() {
    let it = Repository::new();
    let reason = |version: &str| it.release(version, &[]).unwrap_err().to_string();
    assert_eq!(reason("0.1.0"), "0.1.0 does not come after 0.1.0");
    assert_eq!(reason("0.0.9"), "0.0.9 does not come after 0.1.0");
    write(it.folder.path(), "note", "");
    assert!(reason("0.2.0").starts_with("not everything is committed:\n?? note"));
    it.root.run("git", &["tag", "v0.2.0"]).unwrap();
    assert_eq!(reason("0.2.0"), "the tag v0.2.0 is there already");
}

#[test]
fn what_breaks_needs_a_version_that_may() {
    let it = Repository::new();
    let text = CHANGELOG.replace("- A verb", "- **Breaking:** A verb");
    write(it.folder.path(), "CHANGELOG.md", &text);
    commit(&it.root, "break", "body").unwrap();
    let reason = it.release("0.1.1", &[]).unwrap_err().to_string();
    assert!(reason.starts_with("0.1.1 may not break what 0.1.0 promised"), "{reason}");
    it.release("0.2.0", &[]).unwrap();
    assert_eq!(it.said(&["describe"]), "v0.2.0");
}

#[test]
fn the_last_release_is_the_highest_version_below() {
    let it = Repository::new();
    assert_eq!(interface::last_release(&it.root).unwrap(), None);
    for tag in ["v0.2.0", "v0.10.0-rc.1", "v0.10.0", "v0.9.0", "version", "v2"] {
        it.root.run("git", &["tag", tag]).unwrap();
    }
    assert_eq!(interface::last_release(&it.root).unwrap().as_deref(), Some("v0.10.0"));
    commit_file(&it, "later");
    it.root.run("git", &["tag", "v1.0.0"]).unwrap();
    it.root.run("git", &["checkout", "--quiet", "HEAD~1"]).unwrap();
    assert_eq!(interface::last_release(&it.root).unwrap().as_deref(), Some("v0.10.0"));
}

/// The page says how its scoreboard is made; a version is made by the same commands.
#[test]
fn the_scoreboards_commands_are_found() {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/SCOREBOARD.md");
    let page = std::fs::read_to_string(page).unwrap();
    let commands: Vec<&str> = first_commands(&page).unwrap().lines().collect();
    assert_eq!(commands.first(), Some(&"validation/programs/setup"));
    let last = "cargo maintain scoreboard ";
    assert!(commands.last().is_some_and(|line| line.starts_with(last)), "{commands:?}");
    assert!(first_commands("no block").is_err());
}
