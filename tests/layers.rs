//! The sources of the library use one another in one direction: no folder uses one above it, and no
//! two files use each other.

use std::collections::BTreeMap;
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

type Uses = BTreeMap<String, Vec<String>>;

/// Every file of the library by its module path, with the module paths that it uses.
fn uses() -> Uses {
    let files = texts(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
    let names: Vec<String> = files.keys().cloned().collect();
    files.iter().map(|(module, text)| (module.clone(), used(module, text, &names))).collect()
}

/// Every file of the library by its module path.
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
fn used(module: &str, text: &str, names: &[String]) -> Vec<String> {
    let text = text.split("\n#[cfg(test)]\nmod tests").next().unwrap_or(text);
    let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
    let parent = module.rsplit_once("::").map_or("", |(parent, _)| parent);
    let mut found: Vec<String> = code
        .flat_map(|line| {
            let absolute = line.split("crate::").skip(1).map(str::to_owned);
            let beside = line.split("use super::").skip(1).map(|it| format!("{parent}::{it}"));
            absolute.chain(beside).collect::<Vec<_>>()
        })
        .filter_map(|path| {
            let named = |name: &&String| {
                let rest = path.strip_prefix(name.as_str());
                rest.is_some_and(|it| !it.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
            };
            names.iter().filter(named).max_by_key(|name| name.len()).cloned()
        })
        .filter(|it| it != module)
        .collect();
    found.sort();
    found.dedup();
    found
}

#[test]
fn no_layer_uses_one_above_it() {
    let layer = |module: &str| {
        let room = module.split("::").next().unwrap();
        let place = LAYERS.iter().position(|it| *it == room);
        place.unwrap_or_else(|| panic!("{module} has no place among the layers"))
    };
    let uses = uses();
    assert!(uses.len() > 80, "{} files only", uses.len());
    for (module, used) in &uses {
        for it in used {
            assert!(layer(it) <= layer(module), "{module} uses {it}, which is above it");
        }
    }
}

/// A folder's `mod.rs` exports what is in the folder, which uses its types: these are one.
#[test]
fn no_two_files_use_each_other() {
    let uses = uses();
    let pairs: usize = uses.values().map(Vec::len).sum();
    assert!(pairs > 300, "{pairs} uses only");
    for (module, used) in &uses {
        for it in used {
            let family = it.starts_with(&format!("{module}::"));
            let back = !family && !module.starts_with(&format!("{it}::"));
            assert!(!(back && uses[it].contains(module)), "{module} and {it} use each other");
        }
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
