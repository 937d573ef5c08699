//! Every place where the version of the workspace stands.

use crate::changelog;
use crate::edit::Edit;
use crate::process::Folder;
use anyhow::{Context, Result, bail, ensure};
use semver::{Comparator, Op, Version, VersionReq};
use std::collections::BTreeSet;
use toml_edit::{DocumentMut, Item, TableLike, value};

const ROOT: &str = "Cargo.toml";
const CITATION: &str = "CITATION.cff";
/// Pages on what was.
const ARCHIVE_FOLDER: &str = "docs/archive/";

/// The version that the workspace has now.
pub fn current(root: &Folder) -> Result<Version> {
    let manifest = parse(&root.read(ROOT)?).context(ROOT)?;
    let version = &manifest["workspace"]["package"]["version"];
    Ok(version.as_str().context("Cargo.toml: no workspace.package.version")?.parse()?)
}

/// Whether semantic versioning lets programs that rely on `old` break with `new`.
pub fn may_break(old: &Version, new: &Version) -> bool {
    let compatible = Comparator {
        op: Op::Caret,
        major: old.major,
        minor: Some(old.minor),
        patch: Some(old.patch),
        pre: old.pre.clone(),
    };
    !compatible.matches(new)
}

/// The edits that give the workspace the version `new` of this day: manifests, lock files, what
/// pages tell users to depend on, citation.
pub fn edits(root: &Folder, old: &Version, new: &Version, day: &str) -> Result<Vec<Edit>> {
    let manifests = manifests(root)?;
    let mut edits = vec![Edit::new(root, ROOT, |text| workspace(text, new))?];
    let mut packages = BTreeSet::new();
    for path in &manifests {
        packages.extend(package_of_the_version(&root.read(path)?).with_context(|| path.clone())?);
        if path == ROOT {
            let after_workspace = edits[0].after.clone();
            edits[0].after = dependencies(&after_workspace, old, new).context(ROOT)?;
        } else {
            edits.push(Edit::new(root, path, |text| dependencies(text, old, new))?);
        }
    }
    for path in root.output("git", &["ls-files", "Cargo.lock", "*/Cargo.lock"])?.lines() {
        edits.push(Edit::new(root, path, |text| lock(text, &packages, new))?);
    }
    for path in root.output("git", &["ls-files", "*.md"])?.lines() {
        if path != changelog::FILE && !path.starts_with(ARCHIVE_FOLDER) {
            edits.push(Edit::new(root, path, |text| Ok(page(text, old, new)))?);
        }
    }
    edits.push(Edit::new(root, CITATION, |text| citation(text, new, day))?);
    edits.retain(Edit::changes);
    Ok(edits)
}

/// The manifests of the workspace's members.
fn manifests(root: &Folder) -> Result<Vec<String>> {
    let manifest = parse(&root.read(ROOT)?).context(ROOT)?;
    let members = manifest["workspace"]["members"].as_array().context("workspace.members")?;
    let path = |member: &toml_edit::Value| match member.as_str() {
        Some(".") => Ok(ROOT.to_owned()),
        Some(folder) if !folder.contains('*') => Ok(format!("{folder}/{ROOT}")),
        _ => bail!("workspace.members: {member} is no folder"),
    };
    members.iter().map(path).collect()
}

fn parse(text: &str) -> Result<DocumentMut> {
    Ok(text.parse()?)
}

/// The root's manifest with the workspace's version.
fn workspace(text: &str, new: &Version) -> Result<String> {
    let mut manifest = parse(text)?;
    replace(&mut manifest["workspace"]["package"]["version"], &new.to_string())?;
    Ok(manifest.to_string())
}

/// The name of a package whose version is the workspace's.
fn package_of_the_version(text: &str) -> Result<Option<String>> {
    let manifest = parse(text)?;
    let package = manifest["package"].as_table().context("no [package]")?;
    let shared = package.get("version").and_then(|it| it.get("workspace")).is_some();
    let name = package.get("name").and_then(Item::as_str).context("no name")?;
    Ok(shared.then(|| name.to_owned()))
}

/// A manifest whose dependencies within the workspace ask for `new`.
fn dependencies(text: &str, old: &Version, new: &Version) -> Result<String> {
    let mut manifest = parse(text)?;
    let exact = format!("={old}");
    for table in tables(&mut manifest) {
        for (name, dependency) in table.iter_mut() {
            let Some(dependency) = dependency.as_table_like_mut() else { continue };
            let inside = dependency.contains_key("path");
            let Some(version) = dependency.get_mut("version").filter(|_| inside) else { continue };
            let asked = version.as_str().unwrap_or_default();
            ensure!(asked == exact, "{name}: asks for {asked:?}, but not for {exact:?}");
            replace(version, &format!("={new}"))?;
        }
    }
    Ok(manifest.to_string())
}

/// All tables of dependencies in a manifest, those of single platforms too.
fn tables(manifest: &mut DocumentMut) -> Vec<&mut dyn TableLike> {
    let kinds = ["dependencies", "dev-dependencies", "build-dependencies"];
    let mut found: Vec<&mut dyn TableLike> = Vec::new();
    for (name, item) in manifest.iter_mut() {
        if kinds.contains(&name.get()) {
            found.extend(item.as_table_like_mut());
        } else if name == "target" {
            let platforms = item.as_table_like_mut().into_iter().flat_map(|it| it.iter_mut());
            let tables = platforms.filter_map(|(_, item)| item.as_table_like_mut());
            let inner = tables.flat_map(|it| it.iter_mut());
            let inner = inner.filter(|(name, _)| kinds.contains(&name.get()));
            found.extend(inner.filter_map(|(_, item)| item.as_table_like_mut()));
        }
    }
    found
}

/// A lock file in which these packages, where it has them from their folders, have the version.
fn lock(text: &str, packages: &BTreeSet<String>, new: &Version) -> Result<String> {
    let mut lock = parse(text)?;
    let locked = lock["package"].as_array_of_tables_mut().context("no [[package]]")?;
    for package in locked.iter_mut().filter(|package| !package.contains_key("source")) {
        let name = package.get("name").and_then(Item::as_str).unwrap_or_default();
        if packages.contains(name) {
            replace(&mut package["version"], &new.to_string())?;
        }
    }
    Ok(lock.to_string())
}

/// A page whose lines `percuss = "0.1"`, which users copy, ask for `new` where it is not what they
/// ask for, and whose examples print `"percuss": "0.1.0"`, because tests run them. Results stay
/// those of the version that printed them.
fn page(text: &str, old: &Version, new: &Version) -> String {
    let outdated = |word: &str| {
        let asks = word.parse::<VersionReq>().ok();
        asks.is_some_and(|it| it != VersionReq::STAR && it.matches(old) && !it.matches(new))
    };
    let renewed = |(i, word): (usize, &str)| {
        // Every second piece stands between quotation marks.
        if i % 2 == 0 || !outdated(word) {
            return word.to_owned();
        }
        let operator = word.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.');
        let numbers = word.matches('.').count() + 1;
        let all = [new.major, new.minor, new.patch].map(|number| number.to_string());
        format!("{operator}{}", all[..numbers.min(3)].join("."))
    };
    let printed = format!("\"percuss\": \"{old}\"");
    let line = |line: &str| {
        let name = line.split(" = ").next().unwrap_or_default();
        if line.trim_start().starts_with(&printed) {
            line.replacen(&old.to_string(), &new.to_string(), 1)
        } else if name == "percuss" || name.starts_with("percuss-") {
            line.split('"').enumerate().map(renewed).collect::<Vec<_>>().join("\"")
        } else {
            line.to_owned()
        }
    };
    text.split('\n').map(line).collect::<Vec<_>>().join("\n")
}

/// The citation with the version and its day.
fn citation(text: &str, new: &Version, day: &str) -> Result<String> {
    let mut replaced = 0;
    let line = |line: &str| {
        let keys = [("version: ", new.to_string()), ("date-released: ", day.to_owned())];
        let key = keys.into_iter().find(|(key, _)| line.starts_with(key));
        replaced += usize::from(key.is_some());
        key.map_or_else(|| line.to_owned(), |(key, text)| format!("{key}{text}")) + "\n"
    };
    let text = text.lines().map(line).collect();
    ensure!(replaced == 2, "needs one line `version: ` and one `date-released: `");
    Ok(text)
}

/// Puts another text into a value, and leaves the white space and the comment around it.
fn replace(item: &mut Item, text: &str) -> Result<()> {
    let old = item.as_value().context("no value")?.decor().clone();
    let mut new = value(text);
    if let Some(decor) = new.as_value_mut().map(toml_edit::Value::decor_mut) {
        *decor = old;
    }
    *item = new;
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a panic is a failed test")]
mod tests {
    use super::*;

    fn version(text: &str) -> Version {
        text.parse().unwrap()
    }

    #[test]
    fn versions_that_may_break() {
        for (old, new, breaks) in [
            ("0.1.0", "0.1.1", false),
            ("0.1.0", "0.2.0", true),
            ("0.2.0-rc.1", "0.2.0", false),
            ("1.2.3", "1.3.0", false),
            ("1.2.3", "2.0.0", true),
        ] {
            assert_eq!(may_break(&version(old), &version(new)), breaks, "{old} to {new}");
        }
    }

    #[test]
    fn a_manifest_keeps_what_is_no_dependency_inside() {
        let text = "[package]\nname = \"a\"\n\n[dependencies]\n# why\n\
            b = { path = \"b\", version = \"=0.1.0\", features = [\"x\"] } # here\n\
            c = \"=0.1.0\"\nd = { path = \"d\" }\n\n[target.'cfg(unix)'.dev-dependencies]\n\
            e = { path = \"e\", version = \"=0.1.0\" }\n\n[dev-dependencies.f]\npath = \"f\"\n\
            version = \"=0.1.0\"\n";
        let (old, new) = (version("0.1.0"), version("0.2.0"));
        let expected = text.replace("version = \"=0.1.0\"", "version = \"=0.2.0\"");
        assert_eq!(dependencies(text, &old, &new).unwrap(), expected);
        let error = dependencies(&expected, &old, &new).unwrap_err().to_string();
        assert_eq!(error, "b: asks for \"=0.2.0\", but not for \"=0.1.0\"");
    }

    #[test]
    fn a_lock_file_changes_for_the_packages_alone() {
        let packages = BTreeSet::from(["a".to_owned(), "b".to_owned()]);
        let text = "# made by cargo\nversion = 4\n\n[[package]]\nname = \"a\"\nversion = \"0.1.0\"\n\
            dependencies = [\n \"c\",\n]\n\n[[package]]\nname = \"b\"\nversion = \"0.1.0\"\n\
            source = \"elsewhere\"\n\n[[package]]\nname = \"c\"\nversion = \"0.1.0\"\n";
        let expected = text.replacen("\"0.1.0\"", "\"0.2.0\"", 1);
        assert_eq!(lock(text, &packages, &version("0.2.0")).unwrap(), expected);
    }

    #[test]
    fn pages_ask_for_the_new_version() {
        let text = "percuss 0.1.0 at commit 1\n```toml\npercuss = \"0.1\"\n\
            percuss-engines = { version = \"=0.1.0\", features = [\"0\"] }\nserde = \"0.1\"\n```\n\
            {\n  \"percuss\": \"0.1.0\",\n";
        let expected = text
            .replace("percuss = \"0.1\"", "percuss = \"0.2\"")
            .replace("\"=0.1.0\"", "\"=0.2.0\"")
            .replace("\"0.1.0\"", "\"0.2.0\"");
        let old = version("0.1.0");
        assert_eq!(page(text, &old, &version("0.2.0")), expected);
        let expected = text.replace("=0.1.0\"", "=0.1.1\"").replace("\"0.1.0\"", "\"0.1.1\"");
        assert_eq!(page(text, &old, &version("0.1.1")), expected);
    }

    #[test]
    fn a_citation_needs_both_lines() {
        let text = "cff-version: 1.2.0\nversion: 0.1.0\ndate-released: 2026-11-26\n";
        let expected = "cff-version: 1.2.0\nversion: 0.2.0\ndate-released: 2026-12-01\n";
        assert_eq!(citation(text, &version("0.2.0"), "2026-12-01").unwrap(), expected);
        assert!(citation("version: 0.1.0\n", &version("0.2.0"), "2026-12-01").is_err());
    }

    /// A lock file that its packages do not match would end every command with `--locked`.
    #[test]
    fn every_place_of_this_repository_is_found() {
        let root = Folder::at(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
        let old = current(&root).unwrap();
        let new = Version::new(old.major, old.minor + 1, 0);
        let edits = edits(&root, &old, &new, "2026-12-01").unwrap();
        let paths: Vec<&str> = edits.iter().map(|edit| edit.path.as_str()).collect();
        for path in
            ["Cargo.toml", "Cargo.lock", "validation/Cargo.toml", "fuzz/Cargo.lock", CITATION]
        {
            assert!(paths.contains(&path), "{path} is not among {paths:?}");
        }
        for edit in edits.iter().filter(|edit| edit.path.ends_with("Cargo.toml")) {
            let left: Vec<&str> = edit.after.lines().filter(|it| it.contains("percuss")).collect();
            assert!(left.iter().all(|it| !it.contains(&format!("\"={old}\""))), "{left:?}");
        }
    }
}
