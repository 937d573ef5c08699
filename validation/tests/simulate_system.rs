//! `simulate SYSTEM`, held against the library, against `events` and against the oscillator's own
//! `simulate`.

use crate::support::{number, refused, rows, run, stdout, text};
use percuss::System;
use std::io::Read;
use std::path::{Path, PathBuf};

const IMPACT_SYSTEM: &str = "rigid-impact-oscillator";

fn system(name: &str) -> System {
    let file = format!("{}/systems/{name}.system.toml", env!("CARGO_MANIFEST_DIR"));
    System::from_file(file).expect("a system")
}

fn simulated(name: &str, more: &[&str]) -> Vec<Vec<String>> {
    rows(&stdout(&[&["simulate", name], more].concat()))
}

/// The numbers of a row: its time and its state, which stand from these columns on.
fn numbers(row: &[String], time: usize, state: usize) -> Vec<f64> {
    std::iter::once(&row[time]).chain(&row[state..]).map(|it| number(it)).collect()
}

#[test]
fn rows_are_the_events_of_the_library() {
    let system = system(IMPACT_SYSTEM);
    let solver = system.solver::<f64>().expect("a solver");
    let events = solver.run().until(60.0).expect("a run");
    let printed = simulated(IMPACT_SYSTEM, &["--until", "60"]);
    assert_eq!(numbers(&printed[0], 1, 4), [0.0, 0.0, 0.0]);
    let mut count = 0;
    for (n, event) in (1..).zip(events) {
        let row = &printed[n];
        assert_eq!([&row[0], &row[2], &row[3]], [&n.to_string(), event.name(), event.mode()]);
        let own: Vec<f64> = std::iter::once(event.time()).chain(event.state()).copied().collect();
        assert_eq!(numbers(row, 1, 4), own, "row {n}");
        count = n;
    }
    assert!(count > 20, "{count}");
    assert_eq!((printed.len(), printed[count][2].as_str()), (count + 1, "end"));
}

/// What roundings of f64 have grown to in some tens of impacts; a wrong event would change a state
/// by more than a tenth.
const STATE_TOLERANCE: f64 = 1e-10;

#[test]
fn samples_are_those_of_the_library() {
    let system = system(IMPACT_SYSTEM);
    let solver = system.solver::<f64>().expect("a solver");
    let samples: Vec<Vec<f64>> = solver
        .run()
        .samples(4)
        .expect("a run")
        .take(41)
        .map(|it| std::iter::once(it.time()).chain(it.state()).copied().collect())
        .collect();
    let all = simulated(IMPACT_SYSTEM, &["--returns", "10", "--samples", "4"]);
    let found: Vec<Vec<f64>> = all.iter().map(|it| numbers(it, 0, 2)).collect();
    assert_eq!(found, samples);
    // Seven returns later the same instants follow. Searches that ended at other times have other
    // roundings, which the motion has multiplied.
    let late = simulated(IMPACT_SYSTEM, &["--returns", "3", "--samples", "4", "--transient", "7"]);
    assert_eq!(late.len(), 13);
    for (a, b) in late.iter().zip(&all[28..]) {
        assert_eq!(a[..2], b[..2]);
        for (a, b) in numbers(a, 0, 2).iter().zip(numbers(b, 0, 2)) {
            approx::assert_abs_diff_eq!(*a, b, epsilon = STATE_TOLERANCE);
        }
    }
    let until = simulated(IMPACT_SYSTEM, &["--until", "7", "--samples", "4"]);
    assert_eq!(until, all[..until.len()]);
    let within = |row: &[String]| number(&row[0]) <= 7.0;
    assert!(within(&all[until.len() - 1]) && !within(&all[until.len()]));
    let second = simulated(IMPACT_SYSTEM, &["--events", "2"]);
    let short = simulated(IMPACT_SYSTEM, &["--events", "2", "--samples", "4"]);
    assert_eq!(short, all[..short.len()]);
    let passed = number(&second[2][1]);
    assert!(number(&all[short.len() - 1][0]) <= passed && passed <= number(&all[short.len()][0]));
}

/// The events after a transient are the last ones of the run without it, in which no search ended
/// at the end of the transient: their times differ by rounding, which the motion has multiplied.
#[test]
fn a_transient_leaves_out_the_first_rows() {
    let all = simulated(IMPACT_SYSTEM, &["--returns", "30"]);
    let late = simulated(IMPACT_SYSTEM, &["--transient", "20", "--returns", "10"]);
    let begins = number(&late[0][1]);
    let period = std::f64::consts::TAU / 2.75;
    approx::assert_abs_diff_eq!(begins, 20.0 * period, epsilon = 1e-12);
    assert_eq!((late[0][0].as_str(), late[0][2].as_str()), ("0", ""));
    let tail: Vec<_> = all.iter().filter(|row| number(&row[1]) > begins).collect();
    assert_eq!(tail.len(), late.len() - 1);
    for (n, (row, own)) in tail.iter().zip(&late[1..]).enumerate() {
        assert_eq!((own[0].clone(), &own[2..4]), ((n + 1).to_string(), &row[2..4]));
        for (a, b) in numbers(row, 1, 4).iter().zip(numbers(own, 1, 4)) {
            approx::assert_abs_diff_eq!(*a, b, epsilon = STATE_TOLERANCE);
        }
    }
    let counted = simulated(IMPACT_SYSTEM, &["--transient", "20", "--events", "3"]);
    assert_eq!(counted[..], late[..4]);
}

const RELAY: &str = "relay-feedback";

/// Whether rows are others, but for what roundings of f64 have grown to.
fn assert_alike(rows: &[Vec<String>], others: &[Vec<String>], [time, state]: [usize; 2]) {
    assert_eq!(rows.len(), others.len());
    for (row, other) in rows.iter().zip(others) {
        assert_eq!(row[time + 1..state], other[time + 1..state]);
        for (a, b) in numbers(row, time, state).iter().zip(numbers(other, time, state)) {
            approx::assert_abs_diff_eq!(*a, b, epsilon = STATE_TOLERANCE);
        }
    }
}

#[test]
fn returns_to_an_event_measure_a_run() {
    let to =
        |section: &str, more: &[&str]| simulated(RELAY, &[&["--section", section], more].concat());
    let all = simulated(RELAY, &["--events", "13"]);
    let ups = || all.iter().enumerate().filter(|(_, row)| row[2] == "switch-up");
    let fifth = ups().nth(4).expect("five").0;
    assert_alike(&to("switch-up", &["--returns", "5"]), &all[..=fifth], [1, 4]);
    assert_alike(&to("switch-up@down", &["--returns", "5"]), &all[..=fifth], [1, 4]);
    // The return that ends the transient is row 0, and so has no event.
    let second = ups().nth(1).expect("two").0;
    let late = to("switch-up", &["--transient", "2", "--returns", "3"]);
    assert_eq!((late[0][0].as_str(), late[0][2].as_str(), late[0][3].as_str()), ("0", "", "up"));
    assert_alike(&late[1..], &all[second + 1..=fifth], [1, 4]);
    let every = to("switch-up", &["--every", "2", "--transient", "1", "--returns", "1"]);
    let fourth = ups().nth(3).expect("four").0;
    assert_eq!(every, late[..=fourth - second]);
    let counted = to("switch-up", &["--transient", "2", "--events", "3"]);
    assert_eq!(counted, late[..4]);
    // The points of the section are those of its own verb.
    let words = ["poincare", RELAY, "--section", "switch-up", "--transient", "2", "--returns", "3"];
    let points = rows(&stdout(&words));
    let own: Vec<_> = late[1..].iter().filter(|row| row[2] == "switch-up").collect();
    assert_eq!(points.len(), own.len());
    for (point, row) in points.iter().zip(own) {
        assert_eq!((numbers(point, 1, 3), &point[2]), (numbers(row, 1, 4), &row[3]));
    }
}

#[test]
fn a_time_ends_a_run_after_a_transient_of_events() {
    let late = ["--section", "switch-up", "--transient", "2", "--until"];
    let found = simulated(RELAY, &[&late[..], &["10"]].concat());
    let all = simulated(RELAY, &["--until", "10"]);
    let second = all.iter().enumerate().filter(|(_, row)| row[2] == "switch-up").nth(1);
    assert_alike(&found[1..], &all[second.expect("two").0 + 1..], [1, 4]);
    assert_eq!(found.last().expect("rows")[2], "end");
    // A run that ends in its transient has its ending as its only row.
    let early = run(&[&["simulate", RELAY], &late[..], &["3"]].concat());
    let found = rows(&text(&early.stdout));
    assert_eq!((found.len(), &found[0][1], &found[0][2]), (1, &"3".into(), &"end".into()));
    assert!(text(&early.stderr).contains("after 1 returns: the run ends"));
}

#[test]
fn samples_between_returns_are_those_of_the_whole_run() {
    let flags = ["--section", "switch-up", "--transient", "2", "--returns", "1"];
    let ends: Vec<f64> = simulated(RELAY, &flags).iter().map(|row| number(&row[1])).collect();
    let (from, to) = (ends[0], ends[ends.len() - 1]);
    let all = simulated(RELAY, &["--until", "20", "--samples", "8"]);
    let within = |row: &&Vec<String>| (from..=to).contains(&number(&row[0]));
    let wanted: Vec<_> = all.iter().filter(within).cloned().collect();
    assert!(wanted.len() > 10);
    let found = simulated(RELAY, &[&flags[..], &["--samples", "8"]].concat());
    assert_alike(&found, &wanted, [0, 2]);
    let whole = ["--section", "switch-up", "--returns", "1", "--samples", "8"];
    assert_eq!(simulated(RELAY, &whole)[0][..], all[0][..]);
}

/// Strobes at an angle that is not that of the start, which is no return: the first is at
/// 0.5/omega.
#[test]
fn returns_to_an_angle_are_those_of_the_section() {
    let strobe = ["--section", "strobe:0.5"];
    let found = simulated(
        IMPACT_SYSTEM,
        &[&strobe[..], &["--transient", "20", "--returns", "10"]].concat(),
    );
    let point = |n: &str| {
        let words = ["poincare", IMPACT_SYSTEM, "--transient", n, "--returns", "1"];
        rows(&stdout(&[&words[..], &strobe].concat()))
    };
    let ends = [found.first(), found.last()].map(|it| vec![it.expect("rows").clone()]);
    for (row, n) in ends.iter().zip(["19", "29"]) {
        let point = point(n);
        assert_eq!(row[0][3], point[0][2]);
        for (a, b) in numbers(&row[0], 1, 4).iter().zip(numbers(&point[0], 1, 3)) {
            approx::assert_abs_diff_eq!(*a, b, epsilon = STATE_TOLERANCE);
        }
    }
    let every = ["--every", "5", "--transient", "4", "--returns", "2"];
    assert_eq!(simulated(IMPACT_SYSTEM, &[&strobe[..], &every].concat()), found);
    // The start is at the angle 0, and is no return either.
    let usual = simulated(IMPACT_SYSTEM, &["--returns", "3"]);
    assert_eq!(simulated(IMPACT_SYSTEM, &["--section", "strobe", "--returns", "3"]), usual);
    // From a start that is on no strobe samples go to the last return.
    let samples =
        simulated(IMPACT_SYSTEM, &[&strobe[..], &["--returns", "2", "--samples", "4"]].concat());
    let period = std::f64::consts::TAU / 2.75;
    let last = number(&samples.last().expect("rows")[0]);
    assert_eq!((samples.len(), last), (5, period));
}

#[test]
fn a_run_that_does_not_return_says_so() {
    for transient in ["0", "2"] {
        let flags = ["--section", "switch-up", "--max-time", "0.4", "--returns", "2"];
        let words = [&["simulate", RELAY, "--transient", transient], &flags[..]].concat();
        let output = run(&words);
        let rows = rows(&text(&output.stdout));
        let last = rows.last().expect("a row");
        assert_eq!((last[1].as_str(), last[2].as_str()), ("0.4", "end"), "{rows:?}");
        assert_eq!(output.status.code(), Some(0));
        let said = text(&output.stderr);
        assert!(said.contains("after 0 returns: the motion does not return"), "{said}");
    }
    let ball = ["simulate", "bouncing-ball", "--section", "impact", "--returns", "1000"];
    let output = run(&ball);
    assert_eq!(output.status.code(), Some(0));
    assert!(text(&output.stdout).contains(",accumulation,"), "{}", text(&output.stdout));
}

/// Proved events, whose digits are those of the exact solution; a rounding of f64 grows by what
/// impacts do to it.
#[test]
fn times_are_those_of_events() {
    const STATE_TOLERANCE: f64 = 1e-12;
    for name in [IMPACT_SYSTEM, "relay-feedback", "two-masses-on-a-belt", "newton-cradle"] {
        let fast = simulated(name, &["--events", "12"]);
        let proved = rows(&stdout(&["events", name, "--events", "12"]));
        assert_eq!(fast.len(), proved.len(), "{name}");
        for (a, b) in fast.iter().zip(&proved) {
            assert_eq!((&a[0], &a[2..4]), (&b[0], &b[2..4]), "{name}");
            for (a, b) in numbers(a, 1, 4).iter().zip(numbers(b, 1, 4)) {
                approx::assert_abs_diff_eq!(*a, b, epsilon = STATE_TOLERANCE * (1.0 + b.abs()));
            }
        }
    }
}

/// The oscillator as a system of any kind, beside its own solver: from rest both have a phase word
/// and instants. Chaos multiplies their different roundings by less than 1e5 in so short a run.
#[test]
fn the_oscillator_is_one_of_the_systems() {
    const STATE_TOLERANCE: f64 = 1e-11;
    let own = rows(&stdout(&["simulate", "--events", "20"]));
    let other = simulated("percussive-oscillator", &["--events", "20"]);
    assert_eq!(own.len(), other.len());
    for (a, b) in own.iter().zip(&other) {
        assert_eq!(a[1], b[3]);
        for (a, b) in numbers(a, 2, 3).iter().zip(numbers(b, 1, 4)) {
            approx::assert_abs_diff_eq!(*a, b, epsilon = STATE_TOLERANCE * (1.0 + b.abs()));
        }
    }
}

#[test]
fn endings_are_those_of_events() {
    let ends = |arguments: &[&str]| {
        let of = |verb: &str| {
            let output = run(&[&[verb], arguments].concat());
            let rows = rows(&text(&output.stdout));
            let last = rows.last().map(|row| [row[0].clone(), row[2].clone()]);
            (output.status.code(), last, text(&output.stderr))
        };
        let (fast, proved) = (of("simulate"), of("events"));
        assert_eq!((&fast.0, &fast.1), (&proved.0, &proved.1), "{arguments:?}");
        fast
    };
    let (code, last, said) = ends(&["bouncing-ball", "--until", "9"]);
    assert_eq!((code, last.expect("a row")[1].as_str()), (Some(0), "accumulation"));
    assert!(said.contains("infinitely many impacts accumulate between 3"), "{said}");
    let stuck = [IMPACT_SYSTEM, "--until", "5", "--set", "d=0"];
    let (code, last, said) = ends(&stuck);
    assert_eq!((code, last.expect("a row")[1].as_str()), (Some(1), "no-progress"));
    assert!(said.contains("comes to rest on the guard of \"impact\""), "{said}");
    let (code, last, said) = ends(&["bouncing-ball", "--until", "1", "--at", "x=-1"]);
    assert_eq!((code, last.expect("a row")[1].as_str()), (Some(1), "beyond-guard"));
    assert!(said.contains("the guard of \"impact\" is positive there"), "{said}");
    // One that ends in its transient has its ending as its only row.
    let output =
        run(&["simulate", IMPACT_SYSTEM, "--set", "d=0", "--transient", "3", "--returns", "1"]);
    let rows = rows(&text(&output.stdout));
    assert_eq!((rows.len(), rows[0][2].as_str()), (1, "no-progress"));
    assert_eq!(output.status.code(), Some(1));
}

#[test]
fn flags_replace_parts_of_the_start() {
    let first = |more: &[&str]| {
        let rows = simulated("bouncing-ball", &[&["--events", "1"], more].concat());
        rows[0][1..].join(",")
    };
    assert_eq!(first(&[]), "0,,flight,0,1.5");
    assert_eq!(first(&["--at", "x=2", "--at", "v=-1"]), "0,,flight,2,-1");
    assert_eq!(first(&["--at", "v=g/4", "--at=t=-3", "--set", "g=2"]), "-3,,flight,0,0.5");
    let mode = simulated("plastic-ball-on-table", &["--events", "1", "--mode", "flight"]);
    assert_eq!(mode[0][3], "flight");
    let two = ["simulate", "bouncing-ball", "--events", "1", "--at", "w=2"];
    refused(&two, &["--at w=2", "w is no state", "t, x, v"]);
}

/// 0.1 and 0.3 are no tenths: the two guards cross within 1e-17.
const NEAR_TIE: &str = r#"
schema = 1
name = "near-tie"
states = ["x", "n", "time", "event"]
[parameters]
a = 0.1
b = 0.3
[[mode]]
name = "on"
equations = ["x' = 1", "n' = 3", "time' = 0", "event' = 0"]
watch = [{ name = "one", guard = "x > a" }, { name = "two", guard = "n > b" }]
[start]
mode = "on"
x = 0
n = 0
time = 5
event = 6
"#;

fn near_tie(folder: &Path) -> PathBuf {
    let path = folder.join("near-tie.system.toml");
    std::fs::write(&path, NEAR_TIE).expect("written");
    path
}

#[test]
fn choices_within_rounding_are_counted() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = near_tie(folder.path()).display().to_string();
    let output = run(&["simulate", &file, "--until", "1", "--format", "json"]);
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!((output.status.code(), &value["undecidable"]), (Some(0), &1.into()));
    let said = text(&output.stderr);
    assert!(said.contains("1 choice lies within rounding"), "{said}");
}

#[test]
fn states_with_the_names_of_columns_keep_theirs_apart() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = near_tie(folder.path()).display().to_string();
    let csv = text(&run(&["simulate", &file, "--until", "1"]).stdout);
    let header = "n,time,event,mode,x,state.n,state.time,state.event\n0,0,,on,0,0,5,6\n";
    assert!(csv.starts_with(header), "{csv}");
    let csv = text(&run(&["simulate", &file, "--until", "1", "--samples", "1"]).stdout);
    let header = "time,mode,x,state.n,state.time,state.event\n0,on,0,0,5,6\n";
    assert!(csv.starts_with(header), "{csv}");
    let path = folder.path().join("run.npz");
    let shown = path.display().to_string();
    run(&["simulate", &file, "--until", "1", "--output", &shown]);
    assert_eq!(texts(&path, "states"), ["x", "n", "time", "event"]);
}

/// An array of an archive, as its file.
pub fn array(path: &Path, name: &str) -> Vec<u8> {
    let file = std::fs::File::open(path).expect("a file");
    let mut archive = zip::ZipArchive::new(file).expect("an archive");
    let mut bytes = Vec::new();
    let mut entry = archive.by_name(&format!("{name}.npy")).expect("an array");
    entry.read_to_end(&mut bytes).expect("read");
    bytes
}

fn f8(bytes: &[u8]) -> (Vec<u64>, Vec<f64>) {
    let file = npyz::NpyFile::new(bytes).expect("an array");
    (file.shape().to_vec(), file.into_vec().expect("f8"))
}

fn i4(bytes: &[u8]) -> Vec<i32> {
    npyz::NpyFile::new(bytes).expect("an array").into_vec().expect("int32")
}

fn texts(path: &Path, name: &str) -> Vec<String> {
    npyz::NpyFile::new(&array(path, name)[..]).expect("an array").into_vec().expect("texts")
}

#[test]
fn arrays_hold_what_csv_does() {
    let folder = tempfile::tempdir().expect("a folder");
    let [npy, npz] = ["run.npy", "run.npz"].map(|it| folder.path().join(it));
    let length = ["--until", "9"];
    let printed = rows(&text(&run(&[&["simulate", "bouncing-ball"], &length[..]].concat()).stdout));
    for path in [&npy, &npz] {
        let shown = path.display().to_string();
        let more = [&["simulate", "bouncing-ball", "--output", &shown], &length[..]].concat();
        assert!(run(&more).status.success());
    }
    let state: Vec<f64> =
        printed.iter().flat_map(|row| row[4..].iter().map(|it| number(it))).collect();
    let shape = vec![printed.len() as u64, 2];
    assert_eq!(f8(&std::fs::read(&npy).expect("read")), (shape.clone(), state.clone()));
    assert_eq!(f8(&array(&npz, "state")), (shape, state));
    let time: Vec<f64> = printed.iter().map(|row| number(&row[1])).collect();
    assert_eq!(f8(&array(&npz, "time")).1, time);
    let (modes, events) = (texts(&npz, "modes"), texts(&npz, "events"));
    let mode = i4(&array(&npz, "mode"));
    let event = i4(&array(&npz, "event"));
    for (row, (mode, event)) in printed.iter().zip(mode.iter().zip(&event)) {
        assert_eq!(row[3], modes[usize::try_from(*mode).expect("a mode")]);
        let name = usize::try_from(*event).map_or("", |it| events[it].as_str());
        assert_eq!(row[2], name);
    }
    assert_eq!(event[0], -1);
    assert_eq!(events, ["impact", "accumulation"]);
}
