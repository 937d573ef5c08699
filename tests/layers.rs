//! The sources use one another in one direction: in no package, and not in `src/affine/`, does a
//! folder use one above it, and nowhere do files use one another in a circle.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A package of the workspace.
struct Package {
    /// The folder of the package's sources.
    sources: &'static str,
    /// Its rooms, folders or files directly in `sources`: each may use those before it.
    rooms: &'static [&'static str],
}

/// All packages, in the order in which they are compiled.
const PACKAGES: [Package; 10] = [
    Package {
        sources: "src",
        rooms: &[
            "numeric",
            "unknown_name",
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
            "system",
        ],
    },
    Package {
        sources: "validation/engines/src",
        rooms: &[
            "number",
            "failure",
            "accuracy",
            "class",
            "equations",
            "system",
            "case",
            "engine",
            "integration",
            "integrators",
        ],
    },
    Package {
        sources: "validation/pictures/src",
        rooms: &[
            "arrays",
            "colour",
            "palette",
            "look",
            "font",
            "caption",
            "piece",
            "axes",
            "canvas",
            "print",
            "frame",
            "fitted",
            "axis_unit",
            "key",
            "simplify",
            "basin_map",
            "curves",
            "encounter",
            "heat_map",
            "histograms",
            "motion",
            "figure",
            "system_motion",
        ],
    },
    Package {
        sources: "validation/programs/src",
        rooms: &[
            "text",
            "wire",
            "answer",
            "files",
            "programs_file",
            "process",
            "pool",
            "engine",
            "start",
        ],
    },
    Package {
        sources: "validation/harness/src",
        rooms: &["provenance", "truth", "gradients", "score", "suite", "power"],
    },
    Package {
        sources: "validation/bench/src",
        rooms: &[
            "timed_case",
            "cases",
            "history",
            "clock",
            "equal_accuracy",
            "instructions",
            "rounds",
            "length",
            "timed",
            "workload",
            "library_part",
            "floor",
            "compare",
            "contestant",
            "contest",
            "lanes",
            "damping",
            "report",
            "competitor",
            "pictures",
            "summary",
            "table",
        ],
    },
    Package {
        sources: "validation/paper/src",
        rooms: &[
            "paper",
            "curve",
            "claim",
            "item_work",
            "continued",
            "attractors",
            "integrated",
            "brute",
            "branches",
            "fractal",
            "progression_rate",
            "figure2",
            "table1",
            "figure5",
            "figure6",
            "figure7",
            "figures8_9",
            "bifurcations",
            "figure10",
        ],
    },
    Package {
        sources: "validation/src",
        rooms: &["provenance", "unfinished", "typed", "returns", "sweep", "report", "cli"],
    },
    Package {
        sources: "python/src",
        rooms: &[
            "failure",
            "threads",
            "long_work",
            "arrays",
            "gradient",
            "collect",
            "section",
            "between_returns",
            "derivatives",
            "solvers",
            "asked",
            "motion",
            "rows",
            "stream",
            "system",
            "oscillator",
            "dynamics",
            "diagram",
            "survey",
            "returns",
            "return_diagram",
            "return_survey",
            "branches",
            "scores",
            "gradient_scores",
            "command",
        ],
    },
    Package {
        sources: "validation/xtask/src",
        rooms: &[
            "process",
            "book",
            "changelog",
            "edit",
            "versions",
            "interface",
            "release",
            "main",
        ],
    },
];

/// The rooms of `src/affine/`, each allowed to use those before it. What the folder exports comes
/// from all of them.
const AFFINE_ROOMS: [&str; 16] = [
    "model",
    "zeros",
    "arithmetic",
    "modal",
    "closed_form",
    "guards",
    "first_crossing",
    "solver",
    "run",
    "gradient",
    "events",
    "returns",
    "continuation",
    "attractors",
    "gallery",
    EXPORTS,
];

const EXPORTS: &str = "exports";

type Uses = BTreeMap<String, BTreeSet<String>>;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Every file of a folder by its module path, with the module paths that it uses.
fn uses(folder: &Path) -> Uses {
    let files = texts(folder);
    let names: Vec<String> = files.keys().cloned().collect();
    files
        .iter()
        .map(|(module, text)| (module.clone(), used_modules(module, text, &names)))
        .collect()
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
fn used_modules(module: &str, text: &str, names: &[String]) -> BTreeSet<String> {
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

fn room(module: &str) -> &str {
    module.split("::").next().unwrap()
}

/// The uses among the modules of one folder, by their paths in it.
fn uses_inside(folder: &str, uses: &Uses) -> Uses {
    let path = |module: &str| {
        let rest = module.strip_prefix(folder)?;
        if rest.is_empty() { Some(EXPORTS) } else { rest.strip_prefix("::") }.map(str::to_owned)
    };
    let modules = uses.iter().filter(|(module, _)| *module != folder);
    modules
        .filter_map(|(module, used)| {
            Some((path(module)?, used.iter().filter_map(|it| path(it)).collect()))
        })
        .collect()
}

/// The uses of a room by one that stands before it.
fn upward_uses(rooms: &[&str], uses: &Uses) -> Vec<String> {
    let place = |module: &str| {
        let place = rooms.iter().position(|it| *it == room(module));
        place.unwrap_or_else(|| panic!("{module} has no place among the rooms"))
    };
    let pairs = uses.iter().flat_map(|(module, used)| used.iter().map(move |it| (module, it)));
    let above = pairs.filter(|(module, it)| place(it) > place(module));
    above.map(|(module, it)| format!("{module} uses {it}, which is above it")).collect()
}

#[test]
fn no_room_uses_one_above_it() {
    for Package { sources, rooms } in PACKAGES {
        let uses = uses(&root().join(sources));
        assert!(uses.values().any(|used| !used.is_empty()), "{sources}: no use was found");
        let above = upward_uses(rooms, &uses);
        assert!(above.is_empty(), "{sources}: {above:#?}");
        let are_there: BTreeSet<&str> = uses.keys().map(|it| room(it)).collect();
        let gone: Vec<_> = rooms.iter().filter(|it| !are_there.contains(*it)).collect();
        assert!(gone.is_empty(), "{sources} has no {gone:?}");
    }
}

#[test]
fn no_room_of_affine_uses_one_above_it() {
    let uses = uses_inside("affine", &uses(&root().join("src")));
    let above = upward_uses(&AFFINE_ROOMS, &uses);
    assert!(above.is_empty(), "{above:#?}");
}

#[test]
fn a_use_of_a_room_above_is_noticed() {
    let text = "use crate::run::{Exit, Step};\nuse super::flow::contact;\n";
    let names = ["flow", "flow::contact", "run", "model::entry"].map(str::to_owned);
    let uses = |module: &str| Uses::from([(module.to_owned(), used_modules(module, text, &names))]);
    let said = ["flow::contact uses run, which is above it"];
    assert_eq!(upward_uses(&["flow", "run"], &uses("flow::contact")), said);
    assert!(upward_uses(&["flow", "run"], &uses("run")).is_empty());
    let affine = Uses::from([("affine::run".to_owned(), ["affine".to_owned()].into())]);
    assert_eq!(
        upward_uses(&AFFINE_ROOMS, &uses_inside("affine", &affine)),
        ["run uses exports, which is above it"]
    );
}

/// A folder's `mod.rs` exports what is in the folder, which uses its types: these are one.
#[test]
fn no_files_use_one_another_in_a_circle() {
    for Package { sources, .. } in PACKAGES {
        let mut left = uses(&root().join(sources));
        for (module, used) in &mut left {
            let inside = |one: &str, other: &str| one.starts_with(&format!("{other}::"));
            used.retain(|it| !inside(it, module) && !inside(module, it));
        }
        // What uses nothing that is left is in no circle.
        loop {
            let names: BTreeSet<String> = left.keys().cloned().collect();
            left.retain(|_, used| !used.is_disjoint(&names));
            if left.len() == names.len() {
                break;
            }
        }
        assert!(left.is_empty(), "{sources}: files in circles, or that use one: {left:?}");
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
