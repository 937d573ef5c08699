//! `validate` on cases of piecewise-affine systems: those inside the program, and a user's own.

use crate::support::{refused, run, stdout, text};
use percuss_validation::case::TROUBLE;
use percuss_validation::engine::{Accuracy, Limits, Task, answer};
use percuss_validation::integrators::exact;
use percuss_validation::truth::{Library, Truth};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::Arc;

/// A heater with hysteresis: no system of the repository.
const HEATER: &str = "schema = 1
name = \"heater\"
states = [\"warmth\"]
[parameters]
band = 0.25
[[mode]]
name = \"on\"
equations = [\"warmth' = 2 - warmth\"]
[[mode.until]]
name = \"off-at\"
guard = \"warmth > 1 + band\"
next = [{ mode = \"off\" }]
[[mode]]
name = \"off\"
equations = [\"warmth' = -warmth\"]
[[mode.until]]
name = \"on-at\"
guard = \"warmth < 1 - band\"
next = [{ mode = \"on\" }]
[start]
mode = \"on\"
warmth = 0
";

const CASE: &str = "[case]
name = \"warming-up\"
system = \"heater\"
why = \"It is cold.\"
trouble = [\"hysteresis\"]
[horizon]
until = 5.0
";

/// A folder with the heater and its case, as changed.
fn folder(change: impl Fn(&str) -> String) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text);
    write("heater.system.toml", HEATER).expect("written");
    write("warming-up.toml", &change(CASE)).expect("written");
    folder
}

fn name(folder: &Path) -> String {
    folder.display().to_string()
}

#[test]
fn the_exact_solver_has_no_missed_and_no_spurious_events() {
    let summary = stdout(&["validate", "-e", "^exact$", "-c", "^(ball|relay|spheres|plastic|c5)-"]);
    let counts = summary.lines().find(|line| line.contains(" rows: ")).expect("the counts");
    assert!(counts.contains("rows: 27 pass, 0 fail, 0 error"), "{counts}");
}

#[test]
fn every_kind_of_trouble_has_two_cases_and_every_system_three() {
    let cases = crate::exact::of_systems();
    let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
    let mut systems: BTreeMap<&str, usize> = BTreeMap::new();
    for case in &cases {
        case.trouble.iter().for_each(|kind| *kinds.entry(kind).or_default() += 1);
        *systems.entry(&case.system.name).or_default() += 1;
    }
    let every = TROUBLE.iter().all(|kind| kinds.get(kind).is_some_and(|count| *count >= 2));
    assert!(every && kinds.len() == TROUBLE.len(), "{kinds:?}");
    assert!(systems.len() >= 10 && systems.values().all(|count| *count >= 3), "{systems:?}");
}

#[test]
fn a_case_of_ones_own_system_is_held_against_a_run_in_106_bits() {
    let folder = folder(str::to_owned);
    let output = run(&["validate", "--cases", &name(folder.path()), "-e", "exact|dopri5$"]);
    let (table, said) = (text(&output.stdout), text(&output.stderr));
    assert_eq!(output.status.code(), Some(0), "{table}{said}");
    assert!(said.contains("warming-up: without tables"), "{said}");
    assert!(table.contains("4 rows: 4 pass"), "{table}");
    let listed = stdout(&["cases", "--cases", &name(folder.path())]);
    assert!(listed.contains("\nwarming-up,hysteresis,heater,"), "{listed}");
}

/// The truth of a case without tables is what the proved table says, where there is one.
#[test]
fn a_run_in_106_bits_is_the_table() {
    let cases = crate::exact::of_systems();
    let library = Library::embedded().expect("the manifest is read");
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("manifest.json"), "{\"files\": {}}").expect("written");
    let none = Library::from_directory(folder.path()).expect("it is read").replaying();
    let chosen =
        ["ball-forty-impacts", "buck-periodic", "percussive-chaos", "watched-backward-to-stop"];
    for case in cases.iter().filter(|case| chosen.contains(&case.name.as_str())) {
        let proved = library.truth(case).expect("its table");
        let own = none.truth(case).expect("its run");
        assert_eq!(own.ended, proved.ended, "{}", case.name);
        assert_eq!(own.events.len(), proved.events.len(), "{}", case.name);
        for (own, proved) in own.events.iter().zip(&proved.events) {
            assert_eq!((own.event, own.mode), (proved.event, proved.mode), "{}", case.name);
            let off = own.elapsed.minus(proved.elapsed).value().abs();
            assert!(off <= 1e-20 * proved.growth_time * case.span(), "{}: {off:e}", case.name);
        }
        assert_eq!(own.samples.len(), proved.samples.len(), "{}", case.name);
        for (own, proved) in own.samples.iter().zip(&proved.samples) {
            let apart = own.elapsed.minus(proved.elapsed).value().abs();
            assert!(apart <= f64::EPSILON * case.span(), "{}: {apart:e}", case.name);
            // The f64 of an instant is that of a quotient in a table, of a rounded one here.
            for (n, (a, b)) in
                own.state.iter().zip(&proved.state).enumerate().filter(|_| apart == 0.0)
            {
                let off = a.minus(*b).value().abs() / case.system.scales[n];
                let most = 1e-19 * (1.0 + proved.size) * proved.growth[n];
                assert!(off <= most, "{} at {:e}: {off:e}", case.name, own.elapsed.value());
            }
        }
        let ends = own.span - proved.span;
        assert!(ends.abs() <= 1e-8 * case.span(), "{}: {ends:e}", case.name);
    }
}

/// In metres a height is rounded by more than a small velocity, and the next impact hands it on.
#[test]
fn a_ball_from_high_up_is_judged_beside_its_height() {
    let folder = tempfile::tempdir().expect("a folder");
    for height in [1.0, 50.0, 100.0, 1e4] {
        let text = format!(
            "[case]\nname = \"from-{height}\"\nsystem = \"bouncing-ball\"\nwhy = \"High.\"\ntrouble = \
             [\"jump\"]\n[parameters]\ng = 9.81\ne = 0.8\n[start]\nmode = \"flight\"\nx = {height:?}\nv = 0\n\
             [horizon]\nuntil = 30.0\n"
        );
        fs::write(folder.path().join(format!("{height}.toml")), text).expect("written");
    }
    let output = run(&["validate", "--cases", &name(folder.path()), "-e", "^(exact|.*rkv655e)$"]);
    let (table, said) = (text(&output.stdout), text(&output.stderr));
    assert_eq!(output.status.code(), Some(0), "{table}{said}");
    assert!(table.contains(" 0 fail, 0 error"), "{table}");
    assert!(!said.contains("so small"), "{said}");
    // What stays far below the others is said to be seen hardly.
    let faint = "[case]\nname = \"faint\"\nsystem = \"bouncing-ball\"\nwhy = \"Low.\"\ntrouble = [\"jump\"]\n\
                 [start]\nmode = \"flight\"\nx = 1e-5\nv = 0\n[horizon]\nuntil = 0.0015\n";
    let low = tempfile::tempdir().expect("a folder");
    fs::write(low.path().join("faint.toml"), faint).expect("written");
    let said = text(&run(&["validate", "--cases", &name(low.path()), "-e", "exact"]).stderr);
    assert!(said.contains("faint: x stays so small"), "{said}");
}

#[test]
fn a_run_beyond_a_guard_is_refused() {
    let below = "[case]\nname = \"below\"\nsystem = \"bouncing-ball\"\nwhy = \"Below.\"\ntrouble = \
                 [\"jump\"]\n[start]\nmode = \"flight\"\nx = -1\nv = 0\n[horizon]\nuntil = 1.0\n";
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("below.toml"), below).expect("written");
    let wanted = ["below.toml", "beyond its guard of \"impact\"", "accepted"];
    refused(&["validate", "--cases", &name(folder.path())], &wanted);
}

#[test]
fn what_is_not_accepted_in_a_case_is_named() {
    let wrong: [(&str, &str, &[&str]); 10] = [
        ("until = 5.0", "until = -1.0", &["warming-up.toml:7:", "until = -1.0", "after the start"]),
        ("until = 5.0", "until = 5.0\nsamples = 0", &["warming-up.toml:8:", "1 to 100000"]),
        ("\"heater\"", "\"cooler\"", &["warming-up.toml:3:", "cooler.system.toml beside the case"]),
        (
            "[\"hysteresis\"]",
            "[\"hysterisis\"]",
            &["warming-up.toml:5:", "hysterisis", "hysteresis"],
        ),
        ("[horizon]", "[probes]\nintegrators = true\n[horizon]", &["probes"]),
        ("name = \"warming-up\"", "name = \"../up\"", &["warming-up.toml:2:", "name"]),
        ("[horizon]", "[parameters]\nbond = 1.0\n[horizon]", &["bond", "accepted is one of band"]),
        ("[horizon]", "[start]\nmode = \"in\"\nwarmth = 0\n[horizon]", &["in", "on"]),
        ("why = ", "# ", &["warming-up.toml:1: why is missing here; accepted is a string"]),
        ("until = 5.0", "", &["warming-up.toml:6: until is missing here; accepted is a number"]),
    ];
    for (from, to, wanted) in wrong {
        let folder = folder(|case| case.replacen(from, to, 1));
        refused(&["validate", "--cases", &name(folder.path())], wanted);
    }
    let broken = folder(str::to_owned);
    let system = broken.path().join("heater.system.toml");
    fs::write(system, HEATER.replace("2 - warmth", "2 - warmt")).expect("written");
    let wanted = ["heater.system.toml:8:", "warmt"];
    refused(&["validate", "--cases", &name(broken.path())], &wanted);
}

/// Two files would otherwise hold systems of one name.
#[test]
fn a_system_has_the_name_of_its_file() {
    let folder = folder(str::to_owned);
    let system = folder.path().join("heater.system.toml");
    fs::write(system, HEATER.replace("\"heater\"", "\"bouncing-ball\"")).expect("written");
    let wanted = ["heater.system.toml: name = \"bouncing-ball\" is not accepted", "\"heater\""];
    refused(&["validate", "--cases", &name(folder.path())], &wanted);
}

/// A ball that hits the floor at 1, 1.5 and 1.75.
const DROPPED_CASE: &str = "[case]
name = \"dropped\"
system = \"bouncing-ball\"
why = \"Its impacts are round.\"
[parameters]
g = 2.0
e = 0.5
[start]
mode = \"flight\"
x = 0
v = 1.0
[horizon]
until = 1.3
samples = 100
";

/// Whether an event at the horizon, or at a sample, comes before it is a matter of rounding.
#[test]
fn no_horizon_and_no_sample_is_beside_an_event() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("dropped.toml");
    let folder = name(folder.path());
    let validate = ["validate", "--cases", &folder, "-e", "^exact$"];
    let write = |from: &str, to: &str| {
        fs::write(&path, DROPPED_CASE.replace(from, to)).expect("written");
    };
    write("until = 1.3", "until = 1.5");
    refused(&validate, &["dropped.toml: until = 1.5 is not accepted", "between events"]);
    write("until = 1.3", "until = 1.5000001");
    refused(&validate, &["until = 1.5000001 is not accepted"]);
    write("until = 1.3", "until = 1.4999999");
    refused(&validate, &["until = 1.4999999 is not accepted"]);
    write("until = 1.3", "until = 1.25");
    refused(
        &validate,
        &["dropped.toml: samples = 100 is not accepted", "accepted is samples = 101"],
    );
    write("", "");
    let output = run(&validate);
    let (table, said) = (text(&output.stdout), text(&output.stderr));
    assert_eq!(output.status.code(), Some(0), "{table}{said}");
    assert!(table.contains("1 rows: 1 pass"), "{table}");
}

/// Where the order of events in one instant matters, nothing is scored from there on.
#[test]
fn a_run_in_106_bits_tells_whether_an_order_matters() {
    let cases = crate::exact::of_systems();
    let library = Library::embedded().expect("the manifest is read");
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("manifest.json"), "{\"files\": {}}").expect("written");
    let none = Library::from_directory(folder.path()).expect("it is read").replaying();
    let chosen = ["spheres-meet", "spheres-meet-inelastic", "cradle-three-guards", "relay-1e-2"];
    let mut matters = Vec::new();
    for case in cases.iter().filter(|case| chosen.contains(&case.name.as_str())) {
        let proved = library.truth(case).expect("its table");
        let own = none.truth(case).expect("its run");
        assert_eq!(own.ordered, proved.ordered, "{}", case.name);
        matters.push(own.ordered);
    }
    matters.sort_unstable();
    assert_eq!(matters, [false, false, false, true]);
}

/// Tables that were made for another case are refused, in either direction of time.
#[test]
fn a_table_of_another_case_is_refused() {
    let folder = folder(|case| {
        case.replace("warming-up", "ball-geometric").replace("\"heater\"", "\"bouncing-ball\"")
    });
    let output = run(&["validate", "--cases", &name(folder.path()), "-e", "^exact$"]);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("ball-geometric.csv") && said.contains("was made for"), "{said}");
    assert!(said.contains("ball-geometric is a case inside percuss"), "{said}");
}

/// A state between events is that of the table, backward too.
#[test]
fn the_exact_solver_is_sampled_between_events() {
    let library = Library::embedded().expect("the manifest is read");
    for case in crate::exact::of_systems() {
        if !["watched-backward", "buck-dense-output"].contains(&case.name.as_str()) {
            continue;
        }
        let truth: Truth = library.truth(&case).expect("its table");
        let problem = Arc::new(case.problem().expect("it is taken"));
        let task = Task::from_problem(&problem, truth.span, truth.sample_times()).expect("a task");
        let run = answer(exact(), &task, Accuracy::Exact, &Limits::default());
        let outcome = run.expect("it runs");
        for (row, state) in truth.samples.iter().zip(&outcome.samples) {
            for (k, (proved, own)) in row.state.iter().zip(state.iter()).enumerate() {
                let scale = case.system.scales[k] + proved.value().abs();
                let off = (proved.value() - own).abs();
                assert!(off <= 1e-13 * row.growth[k] * scale, "{}: {off:e}", case.name);
            }
        }
    }
}
