//! `bench`: a wrong answer has no time, versions are held against each other, and what is given
//! wrongly is refused.

use crate::exact;
use crate::support::{refused, run, stdout, text};
use percuss_validation::bench::cases::{DEFAULT_CASES, SYSTEMS};
use percuss_validation::bench::contest::{contest, contest_at, most_accurate};
use percuss_validation::bench::contestant::{Contestant, EnteredEngine, settings};
use percuss_validation::bench::library_part::library_part;
use percuss_validation::bench::timed_case::TimedCase;
use percuss_validation::engine::{Accuracy, Engine, Limits, Location, Outcome, answer};
use percuss_validation::integration::Script;
use percuss_validation::integrators::{CONTROL, all, wrong};
use percuss_validation::truth::Library;
use std::path::{Path, PathBuf};

fn case(name: &str) -> TimedCase {
    let library = Library::embedded().expect("the tables are read");
    TimedCase::new(&exact::case(name), &library).expect("a case")
}

fn exact_solver() -> &'static dyn Engine {
    all()[0]
}

/// Faults that a run of a few dozen events shows; a dropped hundredth or a digit lost after 1e8
/// cycles need longer ones.
const SHOWN_FAULTS: [&str; 5] =
    ["wrong-omega", "wrong-xi", "wrong-drift", "wrong-arctan", "wrong-impact"];

#[test]
fn a_wrong_answer_has_no_time() {
    let case = case("impact-into-progression");
    let faulty = wrong().iter().map(|it| it.engine);
    let faulty = faulty.filter(|it| SHOWN_FAULTS.contains(&it.declaration().name));
    let engines: Vec<EnteredEngine> =
        [exact_solver(), CONTROL].into_iter().chain(faulty).map(EnteredEngine).collect();
    assert_eq!(engines.len(), 2 + SHOWN_FAULTS.len());
    let asked: Vec<(&dyn Contestant, Accuracy)> =
        engines.iter().map(|it| (it as &dyn Contestant, Accuracy::Exact)).collect();
    let results = contest_at(&case, &asked, 2, &|| ());
    for result in &results[..2] {
        let timed = result.result.as_ref().expect("it is right");
        assert_eq!(timed.series.0.len(), 2);
        assert!(timed.score.state_error < 1e-9, "{result:?}");
    }
    for result in &results[2..] {
        let failure = result.result.as_ref().expect_err("it is wrong");
        assert!(failure.reason.starts_with("wrong: "), "{result:?}");
        assert!(most_accurate(&results, result.name).is_none());
    }
}

#[test]
fn the_usual_cases_are_there_and_the_exact_solver_is_right_on_them() {
    for name in DEFAULT_CASES {
        let case = case(name);
        let found =
            contest_at(&case, &[(&EnteredEngine(exact_solver()), Accuracy::Exact)], 1, &|| ());
        let timed = found[0].result.as_ref().expect("right");
        assert!(timed.score.state_error < 1e-10, "{name}: {:?}", timed.score);
        assert_eq!(timed.work.steps, case.truth.events.len() as u64 + 1);
    }
}

fn system_cases() -> Vec<TimedCase> {
    let library = Library::embedded().expect("the tables are read");
    let cases = exact::of_systems();
    let named = |name: &&str| cases.iter().find(|it| it.name == **name).expect("a case");
    SYSTEMS.iter().map(|it| TimedCase::new(named(it), &library).expect("a case")).collect()
}

/// Every system is timed, and the exact solver's answers are right: its own part is the same run.
#[test]
fn the_exact_solver_is_right_on_every_system() {
    let timed_cases = system_cases();
    let mut timed: Vec<_> = timed_cases.iter().map(|it| it.problem.exact.name.as_str()).collect();
    timed.sort_unstable();
    timed.dedup();
    let all: Vec<_> = percuss_validation::systems::SYSTEMS.iter().map(|it| it.0).collect();
    assert_eq!(timed, all);
    for case in &timed_cases {
        let found = contest(case, &[&EnteredEngine(exact_solver())], 1, &|| ());
        let timed = found[0].result.as_ref().unwrap_or_else(|it| panic!("{}: {it}", case.name));
        assert!(timed.score.state_error < 1e-9, "{}: {:?}", case.name, timed.score);
        assert_eq!(timed.series.0.len(), 1);
        assert!(timed.harness_share.is_some(), "{}", case.name);
    }
}

#[test]
fn a_wrong_answer_of_a_system_has_no_score() {
    for case in system_cases() {
        let run = || exact_solver().run(&case.task, Accuracy::Exact, &Limits::default());
        let right = run().expect("a run");
        assert!(case.score(&right).is_ok());
        let refused = |change: &dyn Fn(&mut Outcome)| {
            let mut answer = right.clone();
            change(&mut answer);
            case.score(&answer).is_err_and(|it| it.reason.starts_with("wrong: "))
        };
        let scale = case.task.system.system().time_scale;
        assert!(refused(&|it| it.events.truncate(it.events.len() - 1)), "{}", case.name);
        assert!(refused(&|it| it.events.push(it.events[0])), "{}", case.name);
        assert!(refused(&|it| it.events[0].elapsed += 2e-3 * scale), "{}", case.name);
        assert!(refused(&|it| it.events[0].elapsed = f64::NAN), "{}", case.name);
        assert!(refused(&|it| it.end[0] = f64::NAN), "{}", case.name);
    }
}

/// The share of the harness is measured on this run: its answer has to be that of the whole run.
#[test]
fn an_engine_that_is_told_its_events_makes_the_same_run() {
    let case = case("impact-into-progression");
    for engine in all() {
        let settings = settings(engine.declaration().stepping);
        let setting = settings[2.min(settings.len() - 1)];
        let told = library_part(*engine, &case, setting, Limits::default()).expect("the same run");
        let mut told = told.expect("something is left out");
        let name = engine.declaration().name;
        assert_eq!(told.call().and_then(|()| told.check()), Ok(()), "{name}");
    }
    // An engine that the harness does not meter is not thought to be free of the harness.
    let unmetered = library_part(CONTROL, &case, Accuracy::Exact, Limits::default());
    assert!(unmetered.is_ok_and(|it| it.is_none()));
}

/// Events at the entry of a mode, and crossings that end nothing, are told as well: the share is
/// known on every system.
#[test]
fn the_harness_share_is_known_on_every_system() {
    let limits = Limits { calls: 200_000, ..Limits::default() };
    for case in system_cases() {
        for engine in all().iter().filter(|it| it.takes(&case.task).is_ok()) {
            let stepping = engine.declaration().stepping;
            let setting = settings(stepping)[settings(stepping).len() / 2];
            if answer(*engine, &case.task, setting, &limits).is_err() {
                continue;
            }
            let part = library_part(*engine, &case, setting, limits);
            let (case, name) = (&case.name, engine.declaration().name);
            assert_eq!(part.map(|it| it.is_some()), Ok(true), "{name} on {case}");
        }
    }
}

/// The search is left out indeed: told of no event, an engine whose events the harness finds has
/// none.
#[test]
fn an_engine_that_is_told_of_no_event_finds_none_unless_its_library_searches() {
    let case = case("impact-into-progression");
    let none = Script::default();
    let limits = Limits::default();
    let integrators = all().iter().filter(|it| it.declaration().events != Location::Proved);
    for engine in integrators {
        let accuracy = settings(engine.declaration().stepping)[2];
        let found = none.follow(|| answer(*engine, &case.task, accuracy, &limits));
        let (name, by) = (engine.declaration().name, engine.declaration().events);
        let found = found.map(|it| it.events.len()).unwrap_or_default();
        assert_eq!(found == 0, by == Location::Harness, "{name}: {found} events");
    }
    assert!(none.was_read());
}

fn binary() -> String {
    assert_cmd::cargo::cargo_bin("percuss").display().to_string()
}

const ONE_BENCHMARK: [&str; 2] = ["-b", "^switches/critical-xi-1$"];

#[test]
fn a_binary_is_compared_with_itself() {
    let own = binary();
    let output = run(&[&["bench", "compare", &own, &own], &ONE_BENCHMARK[..]].concat());
    let said = text(&output.stdout);
    // Whether it passes is for a check that takes its time: docs/PERFORMANCE.md.
    assert!(matches!(output.status.code(), Some(0 | 1)), "{}", text(&output.stderr));
    let lines: Vec<_> = said.lines().collect();
    assert!(lines[0].starts_with("old ") && lines[1].starts_with("new "), "{said}");
    assert_eq!(lines[2], "bench,quotient,lives_apart,again,verdict");
    assert!(lines[3].starts_with("switches/critical-xi-1,") && lines.len() == 4, "{said}");
}

#[test]
fn twice_the_work_fails() {
    let own = binary();
    let slowed = ["bench", "compare", &own, &own, "--slowdown", "1"];
    let output = run(&[&slowed, &ONE_BENCHMARK[..]].concat());
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    assert!(text(&output.stdout).trim_end().ends_with(",fail"));
}

/// A line of a history.
fn line(commit: &str, floors: f64) -> String {
    format!(
        r#"{{"schema":1,"percuss":"0.0.1","commit":"{commit}","rustc":"r","target_cpu":"t","cpu":"c","bench":"one","instructions":null,"best_ns":1,"median_ns":1,"floor_ns":1,"floors":{floors},"floors_again":{floors},"evaluations_per_switch":1,"state_error_max":0}}"#
    )
}

fn history(folder: &Path, lines: &[String]) -> String {
    let path: PathBuf = folder.join("history.jsonl");
    std::fs::write(&path, lines.join("\n")).expect("written");
    path.display().to_string()
}

#[test]
fn recorded_versions_are_compared() {
    let folder = tempfile::tempdir().expect("a folder");
    let lines = [line("aaaaaaa1", 10.0), line("bbbbbbb2", 10.15), line("ccccccc3", 10.3)];
    let path = history(folder.path(), &lines);
    let compared = |old, new| {
        let output = run(&["bench", "compare", old, new, "--history", &path]);
        (output.status.code(), text(&output.stdout))
    };
    assert_eq!(compared("aaaaaaa", "aaaaaaa1").0, Some(0));
    let (code, said) = compared("aaaaaaa1", "bbbbbbb2");
    assert!(code == Some(0) && said.contains("one,floors,10,10.15,1.0150,warn"), "{said}");
    let (code, said) = compared("aaaaaaa1", "ccccccc3");
    assert!(code == Some(1) && said.contains("one,floors,10,10.3,1.0300,fail"), "{said}");
    assert_eq!(compared("ccccccc3", "aaaaaaa1").0, Some(0));
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let good = history(folder.path(), &[line("aaaaaaa1", 10.0)]);
    let own = binary();
    let with = |path: &str, sides: [&str; 2], wanted: &[&str]| {
        refused(&["bench", "compare", sides[0], sides[1], "--history", path], wanted);
    };
    with(&good, ["aaaaaaa1", "1.2.3"], &["1.2.3", "neither a file nor a version", "aaaaaaa1"]);
    with(&good, [&own, "aaaaaaa1"], &[&own, "two binaries or two recorded versions"]);
    with("/no/such", ["0.1.0", "0.2.0"], &["/no/such", "none is recorded"]);
    with("/", ["0.1.0", "0.2.0"], &["--history", "cannot be read"]);
    let corrupt = history(folder.path(), &[line("aaaaaaa1", 10.0), "{\"schema\":1".to_owned()]);
    with(&corrupt, ["aaaaaaa1", "aaaaaaa1"], &["history.jsonl:2: ", "bench record"]);
    refused(&["bench", "history", "--history", &corrupt], &["history.jsonl:2: "]);
    refused(&["bench", "record", "--history", &corrupt], &["history.jsonl:2: "]);
    refused(&["bench", "history", "--history", "/no/such"], &["/no/such", "holds no record"]);
    // No program, a program that is no worker, and one that says nothing.
    refused(&["bench", "compare", &good, &own], &[&good, "cannot be run"]);
    #[cfg(unix)]
    for stranger in ["/bin/cat", "/bin/echo", "/bin/true"] {
        refused(&["bench", "compare", &own, stranger], &["percuss that has bench worker"]);
    }
    refused(&["bench", "compare", &own, &own, "-b", "nothing"], &["--bench nothing", "switches/"]);
    for share in ["-0.1", "1.5", "nan", "x"] {
        refused(
            &["bench", "compare", &own, &own, &format!("--slowdown={share}")],
            &["--slowdown", share],
        );
    }
    refused(&["bench", "compare", "0.1.0", "0.1.0", "--slowdown", "0.1"], &["--slowdown"]);
    refused(&["bench", "compare", &own], &["NEW"]);
}

#[test]
fn what_matches_nothing_is_refused() {
    refused(&["bench", "-e", "sundials"], &["--engine", "sundials", "percuss engines"]);
    refused(&["bench", "-c", "no-such-case"], &["--case", "no-such-case"]);
    refused(&["bench", "-e", "("], &["--engine", "(", "regular expression"]);
    for rounds in ["0", "-1", "1.5", "1001", "x"] {
        refused(&["bench", &format!("--rounds={rounds}")], &["--rounds", rounds]);
    }
    refused(&["bench", "--omega", "1"], &["--omega"]);
    refused(&["bench", "-c", "small-b", "--out", "/proc/nowhere"], &["--out", "/proc/nowhere"]);
    refused(&["bench", "recrod"], &["recrod"]);
    assert!(stdout(&["bench", "--help"]).contains("compare"));
}
