//! Answers in files that are not as they should be: what costs a row, and what does not.

use super::{EVENTS_FILE, SCORE_COMMAND, ball, in_line, report};
use crate::support::{run, text};
use std::fs;

/// Answers with the file of one case changed: that row has failed with a reason that names the
/// place, said on stderr too, and the other row is right.
fn spoiled(file: &str, change: impl Fn(&str) -> Vec<u8>, wanted: &[&str]) {
    let (folder, out) = ball();
    let path = folder.path().join(file);
    let old = fs::read_to_string(&path).unwrap_or_default();
    fs::write(&path, change(&old)).expect("written");
    let words =
        [&SCORE_COMMAND[..], &["--answers", &out, "-c", "^ball-(geometric|cut-short)$"]].concat();
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
    let said = objections(&text(&run(&words).stderr));
    assert_eq!(said.lines().count(), 1, "{said}");
    wanted.iter().for_each(|it| assert!(said.contains(it), "{it:?} is not in {said}"));
}

/// What is said of answers, but for what is not judged of those that can be read.
fn objections(said: &str) -> String {
    let is_objection = |line: &&str| !line.contains(" cases are judged ");
    said.lines().filter(is_objection).map(|line| format!("{line}\n")).collect()
}

const SAMPLES_FILE: &str = "ball-geometric.samples.csv";

#[test]
fn malformed_events_cost_their_row() {
    let line = |n: usize| format!("{EVENTS_FILE} line {n}: ");
    let columns = "the columns are ";
    spoiled(EVENTS_FILE, |_| Vec::new(), &[&line(1), columns, "\"\"", "time,event,mode,x,v"]);
    spoiled(EVENTS_FILE, in_line(1, "time,", ""), &[&line(1), columns, "event,mode,x,v"]);
    spoiled(EVENTS_FILE, in_line(1, ",v", ",v,w"), &[&line(1), "\"time,event,mode,x,v,w\""]);
    spoiled(
        EVENTS_FILE,
        in_line(3, ",flight", ",flight,1"),
        &[&line(3), "6 columns; accepted are 5"],
    );
    spoiled(
        EVENTS_FILE,
        in_line(3, "flight", "rest"),
        &[&line(3), "\"rest\"", "accepted are flight"],
    );
    spoiled(
        EVENTS_FILE,
        in_line(3, "impact", "bump"),
        &[&line(3), "\"bump\"", "accepted are impact"],
    );
    let before = |text: &str| text.replacen("x,v", "x,v,before.x", 1).into_bytes();
    spoiled(EVENTS_FILE, before, &[&line(1), "before.x,before.v"]);
    for number in ["NaN", "inf", "NA", "1.0D0", ""] {
        let change = |text: &str| {
            let row = text.lines().nth(1).expect("an event").split(',').next().expect("a time");
            in_line(2, row, number)(text)
        };
        let shown = format!("time is {number:?}");
        spoiled(EVENTS_FILE, change, &[&line(2), &shown, "accepted is a finite number"]);
    }
    let swapped = |text: &str| {
        let mut lines: Vec<&str> = text.lines().collect();
        lines.swap(1, 2);
        lines.join("\n").into_bytes()
    };
    spoiled(EVENTS_FILE, swapped, &[&line(3), "is at 1.5; accepted is 2.25 to"]);
    let late = |text: &str| format!("{text}99.0,impact,flight,0,0\n").into_bytes();
    spoiled("ball-cut-short.events.csv", late, &["is at 99.0; accepted is"]);
    spoiled(EVENTS_FILE, |text| [text.as_bytes(), b"\xff\n"].concat(), &["not UTF-8"]);
    let after = |text: &str| {
        let more = "2.9,accumulation,flight,0,0\n2.95,impact,flight,0,0\n";
        (text.lines().take(3).map(|line| format!("{line}\n")).collect::<String>() + more)
            .into_bytes()
    };
    spoiled(EVENTS_FILE, after, &[&line(5), "a line after the run's ending"]);
    let back = |text: &str| {
        (text.lines().take(3).map(|line| format!("{line}\n")).collect::<String>()
            + "2.9,leaves-domain,flight,0,0\n")
            .into_bytes()
    };
    spoiled(EVENTS_FILE, back, &[EVENTS_FILE, "leaves-domain, which only runs back in time do"]);
}

#[test]
fn malformed_samples_cost_their_row() {
    let line = |n: usize| format!("{SAMPLES_FILE} line {n}: ");
    spoiled(SAMPLES_FILE, in_line(1, "time", "t"), &[&line(1), "\"t,x,v\"", "\"time,x,v\""]);
    spoiled(SAMPLES_FILE, in_line(4, "0.06", "0.16"), &[&line(4), "time is ", "accepted is "]);
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
    spoiled(
        EVENTS_FILE,
        many,
        &[&format!("{EVENTS_FILE} line 100002: "), "more than the 100000 accepted"],
    );
    let (folder, out) = ball();
    let file = fs::File::create(folder.path().join(EVENTS_FILE)).expect("made");
    // A file with a hole takes no room on the disk.
    file.set_len(1 << 40).expect("a long file");
    let words = [&SCORE_COMMAND[..], &["--answers", &out, "-c", "^ball-geometric$"]].concat();
    let output = run(&words);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("larger than the 67108864 bytes accepted"), "{said}");
}

#[test]
fn files_that_are_none_cost_their_row() {
    let (folder, out) = ball();
    let words =
        [&SCORE_COMMAND[..], &["--answers", &out, "-c", "^ball-(geometric|cut-short)$"]].concat();
    fs::remove_file(folder.path().join(SAMPLES_FILE)).expect("removed");
    fs::create_dir(folder.path().join(SAMPLES_FILE)).expect("made");
    fs::remove_file(folder.path().join("ball-cut-short.events.csv")).expect("removed");
    fs::create_dir(folder.path().join("ball-cut-short.events.csv")).expect("made");
    let output = run(&words);
    let said = objections(&text(&output.stderr));
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(
        said.contains(SAMPLES_FILE) && said.contains("it is no file; accepted is a file"),
        "{said}"
    );
    assert_eq!(said.lines().count(), 2, "{said}");
}

/// Line ends, quotation marks, a byte order mark and blank lines are a language's own business.
#[test]
fn what_languages_write_differently_is_the_same() {
    let (folder, out) = ball();
    let words = [&SCORE_COMMAND[..], &["--answers", &out, "-c", "^ball-geometric$"]].concat();
    let (plain, code) = report(&words);
    assert_eq!(code, Some(0), "{plain:?}");
    for file in [EVENTS_FILE, SAMPLES_FILE] {
        let path = folder.path().join(file);
        let old = fs::read_to_string(&path).expect("read");
        let quoted = old.replace("time", "\"time\"").replace("impact", "\"impact\"");
        let new = quoted.replace('\n', " \r\n").replacen("\r\n", "\r\n\r\n", 2);
        fs::write(&path, format!("\u{feff}{new}")).expect("written");
    }
    assert_eq!(report(&words), (plain, Some(0)));
}
