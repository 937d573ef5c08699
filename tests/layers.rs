//! The sources use one another in one direction: no folder of the library uses one above it, no
//! room of `src/affine/` does either, and in no package do files use one another in a circle.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The folders and files of `src/`, each allowed to use those before it.
const LAYERS: [&str; 12] = [
    "numeric",
    "phase",
    "error",
    "parameters",
    "state",
    "flow",
    "crossing",
    "model",
    "run",
    "lanes",
    "dynamics",
    "affine",
];

/// The rooms of `src/affine/`, each allowed to use those before it.
const ROOMS: [&str; 9] = [
    "model",
    "zeros",
    "arithmetic",
    "modal",
    "closed_form",
    "guards",
    "first_crossing",
    "solver",
    "run",
];

/// The packages of the workspace, and how many uses of one file by another each has at least.
const PACKAGES: [(&str, usize); 6] = [
    ("src", 500),
    ("validation/engines/src", 100),
    ("validation/pictures/src", 40),
    ("validation/programs/src", 15),
    ("validation/harness/src", 150),
    ("validation/src", 150),
];

type Uses = BTreeMap<String, BTreeSet<String>>;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Every file of a folder by its module path, with the module paths that it uses.
fn uses(folder: &Path) -> Uses {
    let files = texts(folder);
    let names: Vec<String> = files.keys().cloned().collect();
    files.iter().map(|(module, text)| (module.clone(), used(module, text, &names))).collect()
}

/// Every file of a folder by its module path.
fn texts(root: &Path) -> BTreeMap<String, String> {
    let mut files = BTreeMap::new();
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        for file in std::fs::read_dir(folder).unwrap() {
            let path = file.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if let Some(module) = module(root, &path) {
                files.insert(module, std::fs::read_to_string(path).unwrap());
            }
        }
    }
    files
}

/// The module of a file: `run::switch`; none of tests, of the root, which exports them all, and of
/// what the package `faults/` adds to its copy of the sources.
fn module(root: &Path, path: &Path) -> Option<String> {
    let inside: PathBuf = path.strip_prefix(root).ok()?.with_extension("");
    let name = inside.to_str()?.replace(std::path::MAIN_SEPARATOR, "::");
    let tests = name.ends_with("_tests") || name == "lib" || name == "fault";
    (!tests).then(|| name.trim_end_matches("::mod").to_owned())
}

/// The modules that a file names in code before its tests.
fn used(module: &str, text: &str, names: &[String]) -> BTreeSet<String> {
    let text = text.split("\n#[cfg(test)]\nmod tests").next().unwrap_or(text);
    let code: Vec<_> = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
    // `pub(in crate::affine)` says who may use an item, and uses nothing.
    let code = code.join("\n").replace("pub(in crate::", "pub(in ");
    let named = |path: String| {
        let within = |name: &&String| {
            let rest = path.strip_prefix(name.as_str());
            rest.is_some_and(|it| !it.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
        };
        names.iter().filter(within).max_by_key(|name| name.len()).cloned()
    };
    paths(module, &code).into_iter().filter_map(named).filter(|it| it != module).collect()
}

/// The paths that begin with `crate` or `super`, from the root of the package.
fn paths(module: &str, code: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut rest = code;
    while let Some(at) = rest.find("crate::").into_iter().chain(rest.find("super::")).min() {
        let mut base = if rest[at..].starts_with("crate") { "" } else { module };
        rest = &rest[at..];
        while let Some(after) = rest.strip_prefix("super::") {
            base = base.rsplit_once("::").map_or("", |(parent, _)| parent);
            rest = after;
        }
        rest = rest.strip_prefix("crate::").unwrap_or(rest);
        let end = rest.find(|c: char| !(c.is_alphanumeric() || "_:".contains(c)));
        let (path, after) = rest.split_at(end.unwrap_or(rest.len()));
        let group = after.strip_prefix('{').and_then(|it| it.split_once('}'));
        let items = group.map_or(vec![""], |(items, _)| items.split(',').map(str::trim).collect());
        let inside = if base.is_empty() { String::new() } else { format!("{base}::") };
        found.extend(items.iter().map(|item| format!("{inside}{path}{item}")));
    }
    found
}

/// Holds the modules whose paths begin with `inside` to an order of the folders and files that they
/// are in: each may use those before it.
fn assert_ordered(uses: &Uses, inside: &str, order: &[&str]) {
    let place = |module: &str| -> Option<usize> {
        let room = module.strip_prefix(inside)?.split("::").next()?;
        let place = order.iter().position(|it| *it == room);
        Some(place.unwrap_or_else(|| panic!("{module} has no place in the order")))
    };
    for (n, room) in order.iter().enumerate() {
        assert!(uses.keys().any(|it| place(it) == Some(n)), "{inside}{room} is not there");
    }
    for (module, used) in uses {
        let Some(own) = place(module) else { continue };
        for it in used {
            let is_above = place(it).is_some_and(|it| it > own);
            // What a folder exports is from all of its rooms.
            let is_export = it.as_str() == inside.trim_end_matches("::");
            assert!(!is_above && !is_export, "{module} uses {it}, which is above it");
        }
    }
}

#[test]
fn no_layer_uses_one_above_it() {
    let uses = uses(&root().join("src"));
    assert!(uses.len() > 80, "{} files only", uses.len());
    assert_ordered(&uses, "", &LAYERS);
}

#[test]
fn no_room_of_affine_uses_one_above_it() {
    let uses = uses(&root().join("src"));
    let rooms = |it: &str| it.starts_with("affine::");
    let edges = uses.iter().filter(|it| rooms(it.0)).flat_map(|it| it.1).filter(|it| rooms(it));
    assert!(edges.count() > 100, "few uses among the rooms");
    assert_ordered(&uses, "affine::", &ROOMS);
}

/// A folder's `mod.rs` exports what is in the folder, which uses its types: these are one.
#[test]
fn no_files_use_one_another_in_a_circle() {
    for (folder, least) in PACKAGES {
        let mut left = uses(&root().join(folder));
        for (module, used) in &mut left {
            let inside = |one: &str, other: &str| one.starts_with(&format!("{other}::"));
            used.retain(|it| !inside(it, module) && !inside(module, it));
        }
        let pairs: usize = left.values().map(BTreeSet::len).sum();
        assert!(pairs > least, "{folder}: {pairs} uses only");
        // What uses nothing that is left is in no circle.
        loop {
            let names: BTreeSet<String> = left.keys().cloned().collect();
            left.retain(|_, used| !used.is_disjoint(&names));
            if left.len() == names.len() {
                break;
            }
        }
        assert!(left.is_empty(), "{folder}: files in circles, or that use one: {left:?}");
    }
}

/// The solver and the lanes take what they allow themselves from one table.
#[test]
fn what_a_search_allows_itself_stands_in_one_place() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let texts = texts(&root);
    let table = &texts["crossing::allowances"];
    let constants = table.lines().filter_map(|line| line.strip_prefix("pub const "));
    let names: Vec<&str> = constants.filter_map(|it| it.split(':').next()).collect();
    assert!(names.len() >= 10, "{names:?}");
    for name in names {
        let uses = |folder: &str| {
            let within = |it: &&String| it.starts_with(folder) && *it != "crossing::allowances";
            let named = |it: &String| words(&texts[it]).any(|word| word == name);
            texts.keys().filter(within).any(named)
        };
        assert!(uses("lanes") || uses("dynamics"), "no lane takes {name} from the table");
        let solver = uses("crossing::") || uses("model::") || uses("run::");
        assert!(solver || name.starts_with("LANE_"), "the solver does not take {name}");
        for (module, text) in &texts {
            let declared = text.contains(&format!("const {name}:"));
            let proves =
                ["crossing", "lanes", "run", "model"].iter().any(|it| module.starts_with(it));
            let elsewhere = module != "crossing::allowances" && proves;
            assert!(!(declared && elsewhere), "{module} has its own {name}");
        }
    }
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_alphanumeric() || c == '_'))
}
