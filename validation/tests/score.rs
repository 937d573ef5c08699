//! `export` and `score`: what a case asks, as files, and the same verdicts for the same answers.

use crate::support::{percuss, refused, run, text};
use percuss_validation::case::{Cases, defaults};
use percuss_validation::engine::{Accuracy, Ended, SystemTask, all};
use percuss_validation::number::shortest;
use percuss_validation::suite::{Answered, CaseRun, Status, Suite, one, prepare, prepare_systems};
use percuss_validation::truth::Library;
use serde_json::Value;
use std::fs;
use std::path::Path;

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
fn ending(ended: Ended) -> Option<&'static str> {
    Some(match ended {
        Ended::Horizon => return None,
        Ended::NoProgress => "no-progress",
        Ended::Accumulation => "accumulation",
        Ended::LeavesDomain => "leaves-domain",
        Ended::BeyondGuard => "beyond-guard",
        Ended::Undecided => "undecided",
    })
}

/// What a program of a user's own would have written of this run.
struct Files {
    events: String,
    samples: String,
}

impl Files {
    fn of(answered: &Answered, task: &SystemTask) -> Self {
        let system = task.system.system();
        let names = system.states.join(",");
        let mut files = Self {
            events: format!("time,event,mode,{names}\n"),
            samples: format!("time,{names}\n"),
        };
        let mut before = task.mode;
        let mut event = |event: usize, mode: usize, elapsed: f64, state: &[f64]| {
            let (name, next) = (system.event_name(before, event), &system.modes[mode].name);
            let name = name.expect("an event of its mode");
            let row = format!("{},{name},{next}{}\n", shortest(elapsed), written(state));
            before = mode;
            row
        };
        let (samples, end, (ended, ended_at)) = match answered {
            Answered::Oscillator(run) => {
                for it in &run.events {
                    let mode = system.modes.iter().position(|mode| mode.name == it.mode.as_str());
                    let mode = mode.expect("a phase is a mode");
                    files.events += &event(it.event, mode, it.elapsed, &it.state);
                }
                let samples: Vec<String> = run.samples.iter().map(|it| written(it)).collect();
                (samples, written(&run.end), (run.ended, run.ended_at))
            }
            Answered::System(run) => {
                for it in &run.events {
                    files.events += &event(it.event, it.mode, it.elapsed, &it.state);
                }
                let samples: Vec<String> = run.samples.iter().map(|it| written(it)).collect();
                (samples, written(&run.end), (run.ended, run.ended_at))
            }
        };
        if let Some(word) = ending(ended) {
            let mode = &system.modes[before].name;
            files.events += &format!("{},{word},{mode}{end}\n", shortest(ended_at));
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
    let mut cases = Cases::embedded().expect("read");
    cases.retain(|name| pattern.is_match(name));
    let library = Library::embedded().expect("read");
    let oscillator = prepare(cases.oscillator, &library, Suite::Quick).expect("made ready");
    let systems = prepare_systems(cases.systems, &library, Suite::Quick).expect("made ready");
    let oscillator = oscillator.iter().map(|it| it as &dyn CaseRun);
    let defaults = defaults().expect("read");
    let mut answered = Vec::new();
    for case in oscillator.chain(systems.iter().map(|it| it as &dyn CaseRun)) {
        let row = one(case, *engine, accuracy, Suite::Quick, &defaults);
        let Status::Ok(_, run) = row.status else { continue };
        let task = case.system_task().expect("a task");
        Files::of(&run, &task).write(folder, case.name());
        answered.push(case.name().to_owned());
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
    let score = ["score", "--name", "diffsol-bdf", "--library", "diffsol", "--tolerance", "1e-6"];
    let (scored, _) = report(&[&score[..], &["--answers", &answers, "-c", CASES]].concat());
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

/// The truth's own solver, at the unit of error that it has.
#[test]
fn exact_answers_have_every_event() {
    let folder = tempfile::tempdir().expect("a folder");
    let answered = answers("exact", Accuracy::Exact, CASES, folder.path());
    let answers = folder.path().display().to_string();
    let eps = f64::EPSILON.to_string();
    let score =
        ["score", "--name", "mine", "--tolerance", &eps, "--answers", &answers, "-c", CASES];
    let (scored, code) = report(&score);
    assert_eq!(code, Some(0));
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

const SCORE: [&str; 5] = ["score", "--name", "mine", "--tolerance", "1e-9"];

/// Answers with the file of one case changed: that row has failed with a reason that names the
/// place, said on stderr too, and the other row is right.
fn spoiled(file: &str, change: impl Fn(&str) -> Vec<u8>, wanted: &[&str]) {
    let (folder, out) = ball();
    let path = folder.path().join(file);
    let old = fs::read_to_string(&path).unwrap_or_default();
    fs::write(&path, change(&old)).expect("written");
    let words = [&SCORE[..], &["--answers", &out, "-c", "^ball-(geometric|cut-short)$"]].concat();
    let (rows, code) = report(&words);
    assert_eq!(code, Some(1), "{file}: {wanted:?}");
    for row in &rows {
        let is_spoiled = file.starts_with(row["case"].as_str().expect("a name"));
        let class = if is_spoiled { ("failed", "error") } else { ("ok", "pass") };
        assert_eq!(
            (row["status"].as_str(), row["verdict"].as_str()),
            (Some(class.0), Some(class.1))
        );
        if is_spoiled {
            let why = row["why"].as_str().expect("a reason");
            wanted.iter().for_each(|it| assert!(why.contains(it), "{it:?} is not in {why}"));
        }
    }
    let said = text(&run(&words).stderr);
    assert_eq!(said.lines().count(), 1, "{said}");
    wanted.iter().for_each(|it| assert!(said.contains(it), "{it:?} is not in {said}"));
}

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

const EVENTS: &str = "ball-geometric.events.csv";
const TIMES: &str = "ball-geometric.samples.csv";

#[test]
fn malformed_events_cost_their_row() {
    let line = |n: usize| format!("{EVENTS} line {n}: ");
    let columns = "the columns are ";
    spoiled(EVENTS, |_| Vec::new(), &[&line(1), columns, "\"\"", "time,event,mode,x,v"]);
    spoiled(EVENTS, in_line(1, "time,", ""), &[&line(1), columns, "event,mode,x,v"]);
    spoiled(EVENTS, in_line(1, ",v", ",v,w"), &[&line(1), "\"time,event,mode,x,v,w\""]);
    spoiled(EVENTS, in_line(3, ",flight", ",flight,1"), &[&line(3), "6 columns; accepted are 5"]);
    spoiled(EVENTS, in_line(3, "flight", "rest"), &[&line(3), "\"rest\"", "accepted are flight"]);
    spoiled(EVENTS, in_line(3, "impact", "bump"), &[&line(3), "\"bump\"", "accepted are impact"]);
    for number in ["NaN", "inf", "NA", "1.0D0", ""] {
        let change = |text: &str| {
            let row = text.lines().nth(1).expect("an event").split(',').next().expect("a time");
            in_line(2, row, number)(text)
        };
        let shown = format!("time is {number:?}");
        spoiled(EVENTS, change, &[&line(2), &shown, "accepted is a finite number"]);
    }
    let swapped = |text: &str| {
        let mut lines: Vec<&str> = text.lines().collect();
        lines.swap(1, 2);
        lines.join("\n").into_bytes()
    };
    spoiled(EVENTS, swapped, &[&line(3), "is at 1.5; accepted is 2.25 to"]);
    let late = |text: &str| format!("{text}99.0,impact,flight,0,0\n").into_bytes();
    spoiled("ball-cut-short.events.csv", late, &["is at 99.0; accepted is"]);
    spoiled(EVENTS, |text| [text.as_bytes(), b"\xff\n"].concat(), &["not UTF-8"]);
    let after = |text: &str| {
        let more = "2.9,accumulation,flight,0,0\n2.95,impact,flight,0,0\n";
        (text.lines().take(3).map(|line| format!("{line}\n")).collect::<String>() + more)
            .into_bytes()
    };
    spoiled(EVENTS, after, &[&line(5), "a line after the run's ending"]);
    let back = |text: &str| {
        (text.lines().take(3).map(|line| format!("{line}\n")).collect::<String>()
            + "2.9,leaves-domain,flight,0,0\n")
            .into_bytes()
    };
    spoiled(EVENTS, back, &[EVENTS, "leaves-domain, which only runs back in time do"]);
}

#[test]
fn malformed_samples_cost_their_row() {
    let line = |n: usize| format!("{TIMES} line {n}: ");
    spoiled(TIMES, in_line(1, "time", "t"), &[&line(1), "\"t,x,v\"", "\"time,x,v\""]);
    spoiled(TIMES, in_line(4, "0.06", "0.16"), &[&line(4), "time is ", "accepted is "]);
    let short = "ball-cut-short.samples.csv";
    let first =
        |text: &str| text.lines().take(5).map(|line| format!("{line}\n")).collect::<String>();
    spoiled(short, |text| first(text).into_bytes(), &[short, "4 samples; accepted are "]);
    let twice = |text: &str| {
        let last = text.lines().last().expect("a sample");
        format!("{text}{last}\n").into_bytes()
    };
    spoiled(short, twice, &[short, "one sample more than the "]);
}

/// Too much of anything ends the reading: of events at the limit of all engines, of bytes at 64
/// MiB.
#[test]
fn endless_answers_cost_their_row() {
    let many = |text: &str| {
        let header = text.lines().next().expect("a header");
        (header.to_owned() + "\n" + &"0.5,impact,flight,0,0\n".repeat(100_001)).into_bytes()
    };
    spoiled(EVENTS, many, &[&format!("{EVENTS} line 100002: "), "more than the 100000 accepted"]);
    let (folder, out) = ball();
    let file = fs::File::create(folder.path().join(EVENTS)).expect("made");
    // A file with a hole takes no room on the disk.
    file.set_len(1 << 40).expect("a long file");
    let words = [&SCORE[..], &["--answers", &out, "-c", "^ball-geometric$"]].concat();
    let output = run(&words);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("larger than the 67108864 bytes accepted"), "{said}");
}

#[test]
fn files_that_are_none_cost_their_row() {
    let (folder, out) = ball();
    let words = [&SCORE[..], &["--answers", &out, "-c", "^ball-(geometric|cut-short)$"]].concat();
    fs::remove_file(folder.path().join(TIMES)).expect("removed");
    fs::remove_file(folder.path().join("ball-cut-short.events.csv")).expect("removed");
    fs::create_dir(folder.path().join("ball-cut-short.events.csv")).expect("made");
    let output = run(&words);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains(TIMES) && said.contains("it is no file; accepted is a file"), "{said}");
    assert_eq!(said.lines().count(), 2, "{said}");
}

/// Line ends, quotation marks, a byte order mark and blank lines are a language's own business.
#[test]
fn what_languages_write_differently_is_the_same() {
    let (folder, out) = ball();
    let words = [&SCORE[..], &["--answers", &out, "-c", "^ball-geometric$"]].concat();
    let (plain, code) = report(&words);
    assert_eq!(code, Some(0), "{plain:?}");
    for file in [EVENTS, TIMES] {
        let path = folder.path().join(file);
        let old = fs::read_to_string(&path).expect("read");
        let quoted = old.replace("time", "\"time\"").replace("impact", "\"impact\"");
        let new = quoted.replace('\n', " \r\n").replacen("\r\n", "\r\n\r\n", 2);
        fs::write(&path, format!("\u{feff}{new}")).expect("written");
    }
    assert_eq!(report(&words), (plain, Some(0)));
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
    let words = [&SCORE[..], &["--answers", &out, "-c", pattern]].concat();
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
    let said = text(&run(&words).stderr);
    assert!(said.contains("no-case is no case"), "{said}");
    assert_eq!(run(&[&words[..], &["--require"]].concat()).status.code(), Some(1));
    let json = text(&run(&[&words[..], &["--format", "json"]].concat()).stdout);
    let ranking: Value = serde_json::from_str(&json).expect("JSON");
    let total = ranking["ranking"][0]["events_total"].as_u64().expect("a count");
    assert!(ranking["ranking"][0]["events_found"].as_u64() < Some(total));
    // A folder without an answer to any of the cases asked for, and none at all.
    refused(
        &[&SCORE[..], &["--answers", &out, "-c", "^small-b$"]].concat(),
        &["--answers", "no answer"],
    );
    refused(
        &[&SCORE[..], &["--answers", "/no/such"]].concat(),
        &["--answers /no/such", "accepted is"],
    );
}

#[test]
fn a_baseline_tells_what_is_worse() {
    let (folder, out) = ball();
    let report = folder.path().join("report").display().to_string();
    let words = [&SCORE[..], &["--answers", &out, "-c", "^ball-geometric$"]].concat();
    assert!(run(&[&words[..], &["--out", &report]].concat()).status.success());
    let baseline = format!("{report}/report.json");
    let compared = [&words[..], &["--baseline", &baseline]].concat();
    assert!(run(&compared).status.success());
    let path = folder.path().join(EVENTS);
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

#[test]
fn what_is_exported_is_as_its_schema_says() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().display().to_string();
    let output = run(&["export", "--out", &out]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let cases = Cases::embedded().expect("read");
    let names: Vec<&str> = cases.names().collect();
    assert_eq!(text(&output.stdout).lines().count(), names.len());
    let schema = schema();
    let read = |name: &str, ending: &str| {
        fs::read_to_string(folder.path().join(format!("{name}.{ending}"))).expect("written")
    };
    for name in &names {
        let case: Value = serde_json::from_str(&read(name, "json")).expect("JSON");
        assert!(schema.is_valid(&case), "{name}: {:?}", schema.validate(&case).err());
        assert_eq!(case["case"], **name);
        agree(&case, &read(name, "rows.csv"), &read(name, "start.csv"));
        let times: Vec<f64> = read(name, "sample-times.csv")
            .lines()
            .skip(1)
            .map(|it| it.parse().expect("a time"))
            .collect();
        assert_eq!(serde_json::json!(times), case["sample_times"], "{name}");
        assert_eq!(times.last(), case["horizon"].as_f64().as_ref(), "{name}");
    }
    let files = fs::read_dir(folder.path()).expect("read").count();
    assert_eq!(files, 5 * names.len());
    let equations = read("ball-geometric", "txt");
    assert!(
        equations.contains("  x' = v\n") && equations.contains("x rises through 0"),
        "{equations}"
    );
}

/// The schema of a case, whose modes are those of the protocol's requests.
fn schema() -> jsonschema::Validator {
    let read = |name: &str| -> Value {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("schemas").join(name);
        serde_json::from_str(&fs::read_to_string(path).expect("read")).expect("JSON")
    };
    let request = jsonschema::Resource::from_contents(read("program-request.schema.json"));
    jsonschema::options()
        .with_resource("json-schema:///program-request.schema.json", request.expect("a schema"))
        .build(&read("case.schema.json"))
        .expect("a schema")
}

/// CSV and JSON say the same.
fn agree(case: &Value, rows: &str, start: &str) {
    let list = |value: &Value| value.as_array().cloned().expect("a list");
    let numbers = |cells: &[&str]| -> Vec<Value> {
        cells.iter().map(|it| it.parse::<f64>().expect("a number").into()).collect()
    };
    let mut lines = rows.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>());
    for mode in list(&case["modes"]) {
        for (i, state) in list(&case["states"]).iter().enumerate() {
            let line = lines.next().expect("a rate");
            assert_eq!(
                (mode["name"].as_str(), "rate", state.as_str()),
                (Some(line[0]), line[2], Some(line[3]))
            );
            let row =
                [list(&mode["A"][i]), list(&mode["B"][i]), vec![mode["c"][i].clone()]].concat();
            assert_eq!(numbers(&line[4..]), row);
        }
        for event in list(&mode["events"]) {
            let line = lines.next().expect("a guard");
            assert_eq!(
                (event["name"].as_str(), event["direction"].as_str()),
                (Some(line[1]), Some(line[3]))
            );
            assert_eq!(numbers(&line[4..]), list(&event["guard"]));
            for row in event["reset"].as_array().unwrap_or(&Vec::new()) {
                let line = lines.next().expect("a reset");
                assert_eq!((line[2], numbers(&line[4..])), ("reset", list(row)));
            }
            for successor in list(&event["successors"]) {
                let line = lines.next().expect("a successor");
                let next = successor["mode"].as_u64().expect("a place") as usize;
                assert_eq!(
                    (line[2], Some(line[3])),
                    ("successor", case["modes"][next]["name"].as_str())
                );
                let row = numbers(&line[4..]);
                match successor["when"].as_array() {
                    Some(when) => assert_eq!(row, *when),
                    None => assert_eq!(row.last(), Some(&1.0.into())),
                }
            }
        }
    }
    assert_eq!(lines.next(), None);
    let line: Vec<&str> = start.lines().nth(1).expect("a start").split(',').collect();
    let mode = case["start"]["mode"].as_u64().expect("a place") as usize;
    assert_eq!(Some(line[0]), case["modes"][mode]["name"].as_str());
    let own = [&case["horizon"], &case["parameters"]["omega"], &case["parameters"]["phi"]];
    assert_eq!(numbers(&line[1..4]), own.map(Clone::clone));
    assert_eq!(line[4] == "1", case["backward"] == true);
    assert_eq!(numbers(&line[5..]), list(&case["start"]["state"]));
}

#[test]
fn export_writes_into_the_folder_that_it_is_told() {
    refused(&["export"], &["--out"]);
    refused(&["export", "--out", "/proc/nowhere"], &["--out /proc/nowhere", "accepted is"]);
    refused(&["export", "--out", "x", "-c", "qqqqq"], &["--case qqqqq"]);
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = percuss(&["export", "--out", "new/asked", "-c", "^small-b$"]);
    assert!(command.current_dir(folder.path()).output().expect("it runs").status.success());
    assert!(folder.path().join("new/asked/small-b.json").exists());
}
