//! `score`: the same verdicts for the same answers.

use crate::support::{number, refused, run, text};
use percuss::Ending;
use percuss_validation::case::defaults;
use percuss_validation::engine::{Accuracy, Outcome, Task};
use percuss_validation::integrators::all;
use percuss_validation::number::shortest;
use percuss_validation::suite::{Status, Suite, one};
use serde_json::Value;
use std::fs;
use std::path::Path;

mod malformed;

/// Cases of every kind: the oscillator, jumps, both directions, watched events, several events at
/// once, and every way in which a run ends.
const CASES: &str = "^(small-b|cycle-1e8|graze-overlap-1e-6|never-stops|ball-.*|cradle-.*|spheres-.*|\
                     watched-.*|heights-every-direction|buck-periodic|friction-equal|relay-1e-2|\
                     plastic-.*|belt-symmetric)$";

/// A row over (z, cos theta, sin theta, 1) for each of the states, the columns of the CSV.
fn written(states: &[f64]) -> String {
    states.iter().map(|value| format!(",{}", shortest(*value))).collect()
}

/// The word for how a run ended early.
fn ending(ended: Ending) -> Option<&'static str> {
    (ended != Ending::Horizon).then_some(ended.as_str())
}

/// What a program of a user's own would have written of this run.
struct Files {
    events: String,
    samples: String,
}

impl Files {
    fn new(run: &Outcome, task: &Task) -> Self {
        let system = task.system.system();
        let names = system.states.join(",");
        let has_before = run.events.iter().all(|it| it.before.is_some());
        let column = |state: &String| format!(",before.{state}");
        let more: String = system.states.iter().filter(|_| has_before).map(column).collect();
        let mut files = Self {
            events: format!("time,event,mode,{names}{more}\n"),
            samples: format!("time,{names}\n"),
        };
        let mut before = task.mode;
        for it in &run.events {
            let name = system.event_name(before, it.event).expect("an event of its mode");
            before = it.mode;
            let (next, state) = (&system.modes[before].name, written(&it.state));
            let left = it.before.filter(|_| has_before).map(|it| written(&it)).unwrap_or_default();
            files.events += &format!("{},{name},{next}{state}{left}\n", shortest(it.elapsed));
        }
        let samples: Vec<String> = run.samples.iter().map(|it| written(it)).collect();
        let (end, ended, ended_at) = (written(&run.end), run.ended, run.ended_at);
        if let Some(word) = ending(ended) {
            let mode = &system.modes[before].name;
            let left = if has_before { end.as_str() } else { "" };
            files.events += &format!("{},{word},{mode}{end}{left}\n", shortest(ended_at));
        }
        let mut times = task.samples.clone();
        if times.last() != Some(&task.span) {
            times.push(task.span);
        }
        for (time, state) in times.iter().zip(samples.iter().chain([&end])) {
            files.samples += &format!("{}{state}\n", shortest(*time));
        }
        files
    }

    fn write(&self, folder: &Path, case: &str) {
        fs::write(folder.join(format!("{case}.events.csv")), &self.events).expect("written");
        fs::write(folder.join(format!("{case}.samples.csv")), &self.samples).expect("written");
    }
}

/// Runs an engine here, writes its answers into a folder, and names the cases that it answered.
fn answers(engine: &str, accuracy: Accuracy, pattern: &str, folder: &Path) -> Vec<String> {
    let engine = all().iter().find(|it| it.declaration().name == engine).expect("an engine");
    let pattern = regex::Regex::new(pattern).expect("a pattern");
    let cases = crate::exact::prepared(|name| pattern.is_match(name), None);
    let defaults = defaults().expect("read");
    let mut answered = Vec::new();
    for case in &cases {
        let row = one(case, *engine, accuracy, Suite::Quick, &defaults);
        let Status::Ok(_, run) = row.status else { continue };
        Files::new(&run, &case.task).write(folder, &case.case.name);
        answered.push(case.case.name.clone());
    }
    answered
}

/// The rows of a verb's report, and its exit code.
fn report(arguments: &[&str]) -> (Vec<Value>, Option<i32>) {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().display().to_string();
    let output = run(&[arguments, &["--out", &out]].concat());
    let json = fs::read_to_string(folder.path().join("report.json"));
    let json = json.unwrap_or_else(|_| panic!("{}", text(&output.stderr)));
    let report: Value = serde_json::from_str(&json).expect("JSON");
    for file in ["errors.csv", "report.html", "junit.xml"] {
        assert!(folder.path().join(file).exists(), "{file}");
    }
    (report["results"].as_array().cloned().expect("rows"), output.status.code())
}

/// What a row says that does not depend on who counted the work, nor on whether the last state is
/// the run's end or the sample there, which differ by rounding.
fn judged(row: &Value) -> Value {
    let mut row = row.clone();
    let keys = ["rhs_evaluations", "jacobian_evaluations", "linear_solves", "steps", "wall_ns"];
    for key in keys.iter().chain(&["own_ns", "order", "drift_error"]) {
        assert!(row.as_object_mut().expect("a row").remove(*key).is_some(), "{key}");
    }
    row
}

#[test]
fn an_engines_own_run_has_the_verdicts_that_validate_gives_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let answered = answers("diffsol-bdf", Accuracy::Tolerance(1e-6), CASES, folder.path());
    assert!(answered.len() > 25, "{answered:?}");
    let answers = folder.path().display().to_string();
    let written = fs::read_to_string(folder.path().join("small-b.events.csv")).expect("read");
    assert!(written.starts_with("time,event,mode,p,y,q,v,before.p,"), "{written}");
    let score = ["score", "--name", "diffsol-bdf", "--library", "diffsol", "--tolerance", "1e-6"];
    let method = ["--stepping", "per-step", "--order", "5", "--method", "multistep"];
    let words = [&score[..], &method, &["--answers", &answers, "-c", CASES]].concat();
    let (scored, _) = report(&words);
    let (validated, _) =
        report(&["validate", "-e", "^diffsol-bdf$", "--tolerance", "1e-6", "-c", CASES]);
    let of = |rows: &[Value], case: &str| -> Vec<Value> {
        let own = |row: &&Value| row["case"] == case && row["tolerance"] == 1e-6;
        rows.iter().filter(own).map(judged).collect()
    };
    for case in &answered {
        assert_eq!(of(&scored, case), of(&validated, case), "{case}");
        assert_eq!(of(&scored, case).len(), 1, "{case}");
    }
    let verdicts: Vec<&str> = scored.iter().filter_map(|row| row["verdict"].as_str()).collect();
    assert!(verdicts.contains(&"pass") && verdicts.iter().any(|it| *it != "pass"), "{verdicts:?}");
}

/// The truth's own solver, at the unit of error that it has. Ten units are its promise, which are
/// more than explicit methods are allowed.
#[test]
fn exact_answers_have_every_event() {
    let folder = tempfile::tempdir().expect("a folder");
    let answered = answers("exact", Accuracy::Exact, CASES, folder.path());
    let answers = folder.path().display().to_string();
    let eps = f64::EPSILON.to_string();
    let asked = ["--tolerance", &eps, "--answers", &answers, "-c", CASES];
    let score = [&["score", "--name", "mine", "--method", "implicit"], &asked[..]].concat();
    let (scored, code) = report(&score);
    let failing: Vec<_> = scored.iter().filter(|row| row["verdict"] == "fail").collect();
    let why: Vec<_> = failing.iter().map(|row| (&row["case"], &row["why"])).collect();
    assert_eq!(code, Some(0), "{why:#?}");
    let (validated, _) = report(&["validate", "-e", "^exact$", "-c", CASES]);
    assert_eq!((scored.len(), validated.len()), (answered.len(), answered.len()));
    let keys =
        ["case", "status", "events_total", "events_matched", "event_time_error", "state_error"];
    let mut same = 0;
    for (own, exact) in scored.iter().zip(&validated) {
        assert_eq!(
            (&own["events_missed"], &own["events_spurious"]),
            (&0.into(), &0.into()),
            "{own}"
        );
        // Where a decision hangs by nothing, only the exact solver knows that it is none.
        if own["horizon_periods"] == exact["horizon_periods"] {
            keys.iter().for_each(|key| assert_eq!(own[key], exact[key], "{key}: {own}"));
            same += 1;
        }
    }
    assert!(same > 25, "{same}");
}

/// Expected failures are of the engine that is built in, whatever the name of an answer in files.
#[test]
fn an_answer_called_as_an_engine_has_none_of_its_expected_failures() {
    let folder = tempfile::tempdir().expect("a folder");
    let case = "^chaos-from-rest$";
    answers("exact", Accuracy::Exact, case, folder.path());
    let answers = folder.path().display().to_string();
    let score = ["score", "--name", "ode_solvers-dop853", "--tolerance", "1e-6", "-c", case];
    let (rows, code) = report(&[&score[..], &["--answers", &answers]].concat());
    assert_eq!((&rows[0]["verdict"], code), (&"pass".into(), Some(0)), "{rows:?}");
}

/// What `events` prints is an answer as it is: its first line is the start, its last one the end.
#[test]
fn what_events_prints_is_an_answer() {
    let folder = tempfile::tempdir().expect("a folder");
    let case = "watched-every-direction";
    answers("exact", Accuracy::Exact, &format!("^{case}$"), folder.path());
    let printed = run(&["events", "watched-impact-oscillator", "--until", "30"]).stdout;
    assert!(text(&printed).starts_with("n,time,event,mode,"), "{}", text(&printed));
    fs::write(folder.path().join(format!("{case}.events.csv")), printed).expect("written");
    let path = folder.path().join(format!("{case}.samples.csv"));
    let samples = fs::read_to_string(&path).expect("read");
    let with_mode = samples.replacen("time,", "time,mode,", 1).lines().enumerate().fold(
        String::new(),
        |all, (n, line)| match (n, line.split_once(',')) {
            (1.., Some((time, state))) => format!("{all}{time},free,{state}\n"),
            _ => format!("{all}{line}\n"),
        },
    );
    fs::write(&path, with_mode).expect("written");
    let answers = folder.path().display().to_string();
    let case = format!("^{case}$");
    let (rows, code) =
        report(&[&SCORE_COMMAND[..], &["--answers", &answers, "-c", &case]].concat());
    assert_eq!(code, Some(0), "{rows:?}");
    assert_eq!(rows[0]["verdict"], "pass", "{rows:?}");
    assert_eq!(rows[0]["events_missed"], 0, "{rows:?}");
}

/// The first line of what `percuss events` prints is the start, and its times go forward.
#[test]
fn a_printed_run_of_another_start_or_back_in_time_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let printed = run(&["events", "watched-impact-oscillator", "--until", "30"]).stdout;
    let printed = text(&printed);
    let file = folder.path().join("watched-every-direction.events.csv");
    let answers = folder.path().display().to_string();
    let asked = ["--answers", &answers, "-c", "^watched-every-direction$"];
    let words = [&SCORE_COMMAND[..], &asked].concat();
    let told = |rows: &dyn Fn(usize, Vec<String>) -> Vec<String>| {
        let lines = printed.lines().enumerate().map(|(n, line)| {
            let cells = line.split(',').map(str::to_owned).collect();
            rows(n, cells).join(",") + "\n"
        });
        fs::write(&file, lines.collect::<String>()).expect("written");
    };
    let with = |place: usize, value: &str| {
        let value = value.to_owned();
        move |n: usize, mut cells: Vec<String>| {
            if n == 1 {
                cells[place].clone_from(&value);
            }
            cells
        }
    };
    told(&|n, mut cells| {
        if n > 0 {
            cells[1].insert(0, '-');
        }
        cells
    });
    let refuses = |said: &[&str]| {
        let output = run(&words);
        let error = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{error}");
        assert!(said.iter().all(|it| error.contains(it)), "{error}");
    };
    refuses(&["watched-every-direction.events.csv line 3", "accepted is"]);
    for (place, value, said) in [(2, "hit", "event"), (3, "stuck", "mode"), (4, "9", "start")] {
        told(&with(place, value));
        refuses(&["events.csv line 2", said, "accepted is"]);
    }
}

/// No event of a relay is near a graze, however narrow its switching is beside the tolerance.
#[test]
fn a_relay_that_never_switches_fails() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("relay-1e-6.events.csv");
    fs::write(file, "time,event,mode,x1,x2,x3\n").expect("written");
    let answers = folder.path().display().to_string();
    for tolerance in ["1e-4", "1e-6"] {
        let words = ["score", "--name", "mine", "--tolerance", tolerance, "--answers", &answers];
        let (rows, code) = report(&[&words[..], &["-c", "^relay-1e-6$"]].concat());
        assert_eq!((code, &rows[0]["verdict"]), (Some(1), &"fail".into()), "{rows:?}");
    }
}

/// A state is judged also where the event's order in its instant is open, and without the state
/// before the reset.
#[test]
fn a_wrong_state_of_the_last_of_many_impacts_at_once_fails() {
    let case = "spheres-no-progress";
    let folder = tempfile::tempdir().expect("a folder");
    answers("exact", Accuracy::Exact, &format!("^{case}$"), folder.path());
    let file = folder.path().join(format!("{case}.events.csv"));
    let whole = fs::read_to_string(&file).expect("read");
    let header = whole.lines().next().expect("a header");
    let kept = header.split(',').take_while(|it| !it.starts_with("before.")).count();
    let short: Vec<Vec<&str>> =
        whole.lines().map(|line| line.split(',').take(kept).collect()).collect();
    let last = short.iter().rposition(|it| it[1] != "no-progress").expect("an event");
    let answers = folder.path().display().to_string();
    let words = [&SCORE_COMMAND[..], &["--answers", &answers, "-c", case]].concat();
    for (state, wrong) in [(short[last][3], false), ("2e8", true)] {
        let mut lines = short.clone();
        lines[last][3] = state;
        let lines: Vec<String> = lines.iter().map(|it| it.join(",") + "\n").collect();
        fs::write(&file, lines.concat()).expect("written");
        let (rows, _) = report(&words);
        assert_eq!(rows[0]["verdict"] == "fail", wrong, "{state}: {rows:?}");
    }
}

/// Half of a declaration is refused: a unit of error that follows from an order needs one.
/// The state in which a run ends is judged as a sample is, and an ending is one of the model.
#[test]
fn the_end_of_an_answer_is_judged() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = ["rigid-chaos", "watched-backward-to-stop", "watched-every-direction"];
    answers("exact", Accuracy::Exact, &format!("^({})$", cases.join("|")), folder.path());
    let directory = folder.path().display().to_string();
    let judged = |case: &str| {
        let case = format!("^{case}$");
        let score = ["score", "--name", "mine", "--tolerance", "1e-6", "-c", &case];
        let (rows, _) = report(&[&score[..], &["--answers", &directory]].concat());
        let kind = rows[0]["first_wrong"]["kind"].as_str().unwrap_or_default().to_owned();
        (rows[0]["verdict"].as_str().unwrap_or_default().to_owned(), kind)
    };
    for case in cases {
        assert_eq!(judged(case), ("pass".to_owned(), String::new()), "{case}");
    }
    let spoil = |file: &str, column: usize, add: f64| {
        let path = folder.path().join(file);
        let text = fs::read_to_string(&path).expect("read");
        let (before, last) = text.trim_end().rsplit_once('\n').expect("two lines");
        let mut cells: Vec<String> = last.split(',').map(str::to_owned).collect();
        cells[column] = (number(&cells[column]) + add).to_string();
        fs::write(&path, format!("{before}\n{}\n", cells.join(","))).expect("written");
    };
    spoil("rigid-chaos.samples.csv", 1, 1e-3);
    assert_eq!(judged("rigid-chaos"), ("fail".to_owned(), "sample".to_owned()));
    // The state where the mode is left, in a direction that its guard does not look at.
    spoil("watched-backward-to-stop.events.csv", 4, 1e-3);
    assert_eq!(judged("watched-backward-to-stop"), ("fail".to_owned(), "sample".to_owned()));
    spoil("watched-backward-to-stop.events.csv", 3, 1e-3);
    assert_eq!(judged("watched-backward-to-stop"), ("fail".to_owned(), "location".to_owned()));
    let path = |ending: &str| folder.path().join(format!("watched-every-direction.{ending}.csv"));
    let samples = fs::read_to_string(path("samples")).expect("read");
    let (time, state) =
        samples.lines().last().and_then(|it| it.split_once(',')).expect("a last sample");
    let events = fs::read_to_string(path("events")).expect("read");
    let before = if events.contains("before.") { format!(",{state}") } else { String::new() };
    let ended = format!("{events}{time},no-progress,free,{state}{before}\n");
    fs::write(path("events"), ended).expect("written");
    let expected = ("fail".to_owned(), "spurious".to_owned());
    assert_eq!(judged("watched-every-direction"), expected);
}

#[test]
fn a_stepping_that_needs_an_order_is_refused_without() {
    for stepping in ["per-step", "fixed"] {
        let words = [&SCORE_COMMAND[..], &["--answers", ".", "--stepping", stepping]].concat();
        refused(&words, &["--stepping", "need --order"]);
    }
}

/// What `export` writes of the bouncing ball, and how it is answered.
fn ball() -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().display().to_string();
    let output = run(&["export", "--out", &out, "-c", "^ball-(geometric|cut-short)$"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let pattern = "^ball-(geometric|cut-short)$";
    answers("exact", Accuracy::Exact, pattern, folder.path());
    (folder, out)
}

const SCORE_COMMAND: [&str; 5] = ["score", "--name", "mine", "--tolerance", "1e-9"];

const EVENTS_FILE: &str = "ball-geometric.events.csv";

/// Replaces a text in the n-th line of a file, from 1.
fn in_line(n: usize, from: &str, to: &str) -> impl Fn(&str) -> Vec<u8> {
    move |text| {
        let line = |(i, line): (usize, &str)| {
            if i + 1 == n { line.replacen(from, to, 1) } else { line.to_owned() }
        };
        let lines: Vec<String> = text.lines().enumerate().map(line).collect();
        assert_ne!(lines.join("\n") + "\n", text, "line {n} holds {from:?}");
        (lines.join("\n") + "\n").into_bytes()
    }
}

#[test]
fn what_is_not_answered_counts_as_not_found() {
    let (folder, out) = ball();
    for ending in ["events", "samples"] {
        fs::remove_file(folder.path().join(format!("ball-cut-short.{ending}.csv")))
            .expect("removed");
    }
    fs::write(folder.path().join("no-case.events.csv"), "").expect("written");
    let pattern = "^(ball-(geometric|cut-short)|no-case)$";
    let words = [&SCORE_COMMAND[..], &["--answers", &out, "-c", pattern]].concat();
    let (rows, code) = report(&words);
    assert_eq!(code, Some(0));
    let missing = rows.iter().find(|row| row["case"] == "ball-cut-short").expect("a row");
    assert_eq!(
        (&missing["status"], &missing["verdict"]),
        (&"unavailable".into(), &"unavailable".into())
    );
    assert!(
        missing["why"].as_str().is_some_and(|why| why.starts_with("not answered: ")),
        "{missing}"
    );
    assert!(missing["events_total"].as_u64() > Some(0));
    let output = run(&words);
    let said = text(&output.stderr);
    assert!(said.contains("no-case is no case"), "{said}");
    let shown = text(&run(&[&words[..], &["--details"]].concat()).stdout);
    let told: Vec<&str> = shown.lines().filter(|line| line.starts_with("unavailable: ")).collect();
    let counted =
        "unavailable: 1 rows: mine 1 (not answered: there is no ball-cut-short.events.csv)";
    assert_eq!(told, [counted], "{shown}");
    assert_eq!(run(&[&words[..], &["--require"]].concat()).status.code(), Some(1));
    let json = text(&run(&[&words[..], &["--format", "json"]].concat()).stdout);
    let ranking: Value = serde_json::from_str(&json).expect("JSON");
    let counts = |key: &str| {
        let counts = ranking["ranking"][0][key].as_object().expect("counts of settings");
        counts.values().filter_map(Value::as_u64).sum::<u64>()
    };
    // What was not answered was asked, and is not right.
    let answered = rows.iter().filter(|row| row["status"] == "ok").count() as u64;
    assert_eq!(counts("cases_total"), rows.len() as u64);
    assert!(counts("cases_right") <= answered && answered < rows.len() as u64);
    // A folder without an answer to any of the cases asked for, and none at all.
    refused(
        &[&SCORE_COMMAND[..], &["--answers", &out, "-c", "^small-b$"]].concat(),
        &["--answers", "no answer"],
    );
    refused(
        &[&SCORE_COMMAND[..], &["--answers", "/no/such"]].concat(),
        &["--answers /no/such", "accepted is"],
    );
}

/// Without samples events alone are judged, and without the states before resets not their
/// location: both are said, and a case without samples does not count as right.
#[test]
fn what_is_not_given_is_not_judged_and_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().display().to_string();
    let accuracy = Accuracy::Tolerance(1e-9);
    answers("ode_solvers-dopri5", accuracy, "^ball-cut-short$", folder.path());
    let words = [&SCORE_COMMAND[..], &["--answers", &out, "-c", "^ball-cut-short$"]].concat();
    let told = |rest: &str| {
        let (rows, code) = report(&words);
        assert_eq!((rows.len(), code), (1, Some(0)), "{rows:?}");
        assert_eq!(rows[0]["verdict"], "pass", "{}", rows[0]);
        assert!(rows[0]["why"].as_str().is_some_and(|why| why.starts_with(rest)), "{}", rows[0]);
        let said = text(&run(&words).stderr);
        assert_eq!(said.contains("1 of 1 cases are judged "), !rest.is_empty(), "{said}");
        assert!(said.contains(rest), "{said}");
        rows[0].clone()
    };
    assert!(told("")["defect"]["location"]["max"].is_number());
    let samples = folder.path().join("ball-cut-short.samples.csv");
    let kept = fs::read(&samples).expect("read");
    fs::remove_file(&samples).expect("removed");
    let row = told("of events only: ");
    for key in ["state_error", "event_time_error"] {
        assert_eq!(row[key]["max"].is_null(), key == "state_error", "{row}");
    }
    assert!(row["valid_periods"].is_null() && row["drift_error"].is_null(), "{row}");
    let json = text(&run(&[&words[..], &["--format", "json"]].concat()).stdout);
    let json: Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(json["ranking"][0]["cases_right"]["1e-9"], 0, "{json}");
    assert_eq!(json["ranking"][0]["cases_total"]["1e-9"], 1, "{json}");
    fs::write(&samples, kept).expect("written");
    let events = folder.path().join("ball-cut-short.events.csv");
    let whole = fs::read_to_string(&events).expect("read");
    let short = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        cells[..3 + (cells.len() - 3) / 2].join(",") + "\n"
    };
    fs::write(&events, whole.lines().map(short).collect::<String>()).expect("written");
    assert!(told("without location: ")["defect"]["location"]["max"].is_null());
    fs::remove_file(&samples).expect("removed");
    told("of events only, without location: ");
}

/// Most cases are not answered while a program is written: one line counts them.
#[test]
fn cases_without_an_answer_are_counted_in_one_line() {
    let (_folder, out) = ball();
    let words = [&SCORE_COMMAND[..], &["--answers", &out, "-c", "^(ball-.*|relay-.*)$"]].concat();
    let shown = text(&run(&[&words[..], &["--details"]].concat()).stdout);
    let told: Vec<&str> = shown.lines().filter(|line| line.contains("not answered")).collect();
    assert_eq!(told.len(), 1, "{shown}");
    let (rows, _) = report(&words);
    let count = rows.iter().filter(|row| row["verdict"] == "unavailable").count();
    assert!(count > 3 && count + 2 == rows.len(), "{count} of {}", rows.len());
    let counted = format!("unavailable: {count} rows: mine {count} (not answered: there is no ");
    assert!(told[0].starts_with(&counted), "{shown}");
    assert!(shown.contains(&format!(" {count} unavailable")), "{shown}");
}

#[test]
fn a_baseline_tells_what_is_worse() {
    let (folder, out) = ball();
    let report = folder.path().join("report").display().to_string();
    let words = [&SCORE_COMMAND[..], &["--answers", &out, "-c", "^ball-geometric$"]].concat();
    assert!(run(&[&words[..], &["--out", &report]].concat()).status.success());
    let baseline = format!("{report}/report.json");
    let compared = [&words[..], &["--baseline", &baseline]].concat();
    assert!(run(&compared).status.success());
    let path = folder.path().join(EVENTS_FILE);
    let events = fs::read_to_string(&path).expect("read");
    fs::write(&path, in_line(2, "1.5,", "1.4999,")(&events)).expect("written");
    let output = run(&compared);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stdout));
    let other = ["score", "--name", "other", "--tolerance", "1e-9", "--answers", &out];
    refused(
        &[&other[..], &["--baseline", &baseline]].concat(),
        &["--baseline", "no row in common"],
    );
}
