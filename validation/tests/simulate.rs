//! `simulate` as users and scripts rely on it.

use crate::support::{number, percuss, rows, run, stdout, text};
use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};

/// Table 1 of the paper: phase, tau, p, y, q.
const TABLE_1: [(&str, [f64; 4]); 9] = [
    ("contact", [1142.28514, 0.02000, 4.58005, 0.00000]),
    ("progression", [1142.48663, 0.93131, 4.43472, 0.91131]),
    ("contact", [1146.21267, 1.02000, 0.00000, 1.00000]),
    ("no-contact", [1147.60385, 0.04328, -1.16404, 0.02328]),
    ("contact", [1188.10028, 0.02000, 5.68688, 0.00000]),
    ("progression", [1188.25661, 0.90719, 5.64034, 0.88719]),
    ("contact", [1194.99997, 1.02000, 0.00000, 1.00000]),
    ("no-contact", [1196.61048, 0.03901, -0.95049, 0.01901]),
    ("contact", [1267.97881, 0.02000, 4.57225, 0.00000]),
];
/// One unit of the table's last digit.
const LAST_DIGIT: f64 = 1e-5;

/// The rows that should be Table 1, held against it.
fn assert_table_1(rows: &[Vec<String>], table: &[(&str, [f64; 4])], tolerance: f64) {
    assert_eq!(rows.len(), table.len());
    for (row, (phase, values)) in rows.iter().zip(table) {
        assert_eq!(&row[1], phase);
        for (field, value) in row[2..].iter().zip(values) {
            approx::assert_abs_diff_eq!(number(field), *value, epsilon = tolerance);
        }
    }
}

#[test]
fn table_1_from_rest() {
    let rows = rows(&stdout(&["simulate", "--omega", "0.1", "--until", "1268"]));
    assert_eq!(rows.last().map(|row| (row[1].as_str(), row[2].as_str())), Some(("end", "1268")));
    assert_table_1(&rows[rows.len() - 10..rows.len() - 1], &TABLE_1, LAST_DIGIT);
}

#[test]
fn table_1_from_its_first_row() {
    let start = "--tau 1142.28514 --p 0.02 --y 4.58005 --q 0 --v 246.03454 --phase contact";
    let arguments = format!("simulate --omega 0.1 --events 8 {start}");
    let rows = rows(&stdout(&arguments.split(' ').collect::<Vec<_>>()));
    assert_table_1(&rows[1..], &TABLE_1[1..], 2.0 * LAST_DIGIT);
}

#[test]
fn a_start_taken_from_any_printed_row_repeats_the_rows_after_it() {
    let all = rows(&stdout(&["simulate", "--events", "40"]));
    for (index, row) in all.iter().enumerate().take(32) {
        let [_, _, tau, p, y, q, v] = row.as_slice() else { unreachable!("seven columns") };
        let again = rows(&stdout(&[
            "simulate", "--events", "1", "--tau", tau, "--p", p, "--y", y, "--q", q, "--v", v,
        ]));
        assert_eq!(again[0][1], row[1], "row {index}");
        assert_eq!(again[1][1], all[index + 1][1], "row {index}");
        for column in 2..7 {
            let (here, there) = (number(&again[1][column]), number(&all[index + 1][column]));
            // A printed tau resolves less than what the run carries.
            approx::assert_abs_diff_eq!(here, there, epsilon = 1e-12 * (1.0 + there.abs()));
        }
    }
}

#[test]
fn negative_values_both_ways() {
    let spaced =
        stdout(&["simulate", "--events", "2", "--p", "-1", "--y", "-2.5e-3", "--cycle", "-7"]);
    let joined = stdout(&["simulate", "--events", "2", "--p=-1", "--y=-2.5e-3", "--cycle=-7"]);
    assert_eq!(spaced, joined);
    assert!(
        spaced.starts_with(
            "index,phase,tau,p,y,q,v\n0,no-contact,-31.415926535897935,-1,-0.0025,0,0\n"
        ),
        "{spaced}"
    );
}

#[test]
fn samples() {
    let csv = stdout(&["simulate", "--periods", "3", "--samples", "4", "--v", "2"]);
    assert!(csv.starts_with("tau,phase,p,y,q,v,x,z\n0,no-contact,0,0,0,2,2,2\n"), "{csv}");
    let rows = rows(&csv);
    assert_eq!(rows.len(), 13);
    for row in &rows {
        approx::assert_abs_diff_eq!(
            number(&row[6]),
            number(&row[2]) + number(&row[5]),
            epsilon = 1e-15
        );
        approx::assert_abs_diff_eq!(
            number(&row[7]),
            number(&row[4]) + number(&row[5]),
            epsilon = 1e-15
        );
    }
    approx::assert_abs_diff_eq!(
        number(&rows[12][0]),
        6.0 * std::f64::consts::PI / 1.4,
        epsilon = 1e-14
    );
}

#[test]
fn a_file_and_flags() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("problem.toml");
    std::fs::write(&path, "[parameters]\nomega = 0.1\n[start]\np = -1\ncycle = 3\n")
        .expect("written");
    let path = path.display().to_string();
    let by_file = stdout(&["simulate", "--events", "3", "--problem", &path]);
    assert_eq!(
        by_file,
        stdout(&["simulate", "--events", "3", "--omega", "0.1", "--p", "-1", "--cycle", "3"])
    );
    let overridden =
        stdout(&["simulate", "--events", "3", "--problem", &path, "--p", "-2", "--cycle", "0"]);
    assert_eq!(overridden, stdout(&["simulate", "--events", "3", "--omega", "0.1", "--p", "-2"]));
}

#[test]
fn a_harness_case_is_a_problem() {
    let case = concat!(env!("CARGO_MANIFEST_DIR"), "/cases/graze-overlap-1e-6.toml");
    let csv = stdout(&["simulate", "--events", "1", "--problem", case]);
    assert_eq!(rows(&csv).len(), 2);
}

#[test]
fn endless_regimes_end_at_the_horizon_and_say_so() {
    let cases = [
        ("--b -0.02 --omega 1.3 --p -0.05 --y 0.4", "never returns"),
        ("--b 1.1 --xi 0.1 --omega 0.8 --p -0.3", "never stops"),
        ("--a 0.05 --b 0.5 --xi 0.1 --omega 0.7", "stays on the slider for ever"),
    ];
    for (flags, wanted) in cases {
        for length in
            ["--periods 400", "--periods 400 --samples 1", "--events 1000", "--periods 20"]
        {
            let line = format!("simulate {length} {flags}");
            let output = run(&line.split(' ').collect::<Vec<_>>());
            let said = text(&output.stderr);
            assert_eq!(output.status.code(), Some(0), "{line}: {said}");
            assert_eq!(said.lines().count(), 1, "{line}: {said}");
            assert!(said.contains(wanted), "{line}: {said}");
        }
        let line = format!("simulate --periods 400 {flags}");
        let output = run(&line.split(' ').collect::<Vec<_>>());
        assert!(text(&output.stdout).lines().last().is_some_and(|row| row.contains(",end,")));
    }
}

/// Contacts that die out next to a threshold, as they were found to run for ever.
#[test]
fn contacts_that_die_out_are_decided() {
    let cases = [
        ("--b 1e-40 --xi 1.2 --p=-0.1 --y 0.1 --q=-0.12", "stays on the slider for ever"),
        ("--b 1e-17 --xi 1.459 --p=-3.069 --y 1 --q=-3.05", "stays on the slider for ever"),
        ("--b=-1e-40 --xi 1.2 --p=-0.1 --y 0.1 --q=-0.12", "after tau = 164.87"),
    ];
    for (flags, wanted) in cases {
        let lengths = ["--until 1", "--until 2000", "--events 10", "--events 10 --max-periods 7"];
        for length in lengths {
            let line = format!("simulate {length} --a 0 {flags}");
            let output = run(&line.split(' ').collect::<Vec<_>>());
            let said = text(&output.stderr);
            assert_eq!(output.status.code(), Some(0), "{line}: {said}");
            let late = wanted.starts_with("after");
            let short = length == "--until 1" || length.contains("--max-periods");
            assert!(said.contains(wanted) || (late && short), "{line}: {said}");
        }
    }
}

/// Free and forced oscillation in step, which nothing but following them shows to stay inside.
const RESONANT_START: &str =
    "--a 0.84 --b 0.5 --xi 1e-8 --omega 2 --phi 1.5707963267948966 --p 0.8 --y 0.56 --q 0.78";

#[test]
fn a_phase_that_is_not_decided_ends_the_run() {
    for length in [
        "--periods 1000000000",
        "--periods 1000000000 --samples 1",
        "--events 1 --max-periods 1000000000",
    ] {
        let line = format!("simulate {length} {RESONANT_START}");
        let output = run(&line.split(' ').collect::<Vec<_>>());
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{line}: {said}");
        assert_eq!(said.lines().count(), 1, "{line}: {said}");
        assert!(said.contains("undecidable"), "{line}: {said}");
        let out = text(&output.stdout);
        let rows: Vec<_> = out.lines().filter(|row| row.contains(",undecidable,")).collect();
        assert_eq!(rows.len(), 1, "{line}");
        assert_eq!(out.lines().last(), Some(rows[0]));
        // It is a row of numbers like the others.
        assert!(
            rows[0]
                .split(',')
                .filter(|cell| *cell != "undecidable")
                .all(|cell| cell.parse::<f64>().is_ok_and(f64::is_finite))
        );
    }
    let line = format!("simulate --periods 1000 {RESONANT_START}");
    let output = run(&line.split(' ').collect::<Vec<_>>());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stdout).lines().last().is_some_and(|row| row.contains(",end,")));
}

#[test]
fn events_stop_early_after_so_many_periods() {
    let output = run(&["simulate", "--events", "1000", "--max-periods", "10"]);
    let said = text(&output.stderr);
    assert!(output.status.success());
    assert!(
        said.contains("stopped after 10 forcing periods with") && said.contains("of 1000 events"),
        "{said}"
    );
    assert_eq!(said.lines().count(), 1);
    assert_eq!(stdout(&["simulate", "--events", "0"]).lines().count(), 2);
    assert_eq!(stdout(&["simulate", "--periods", "0"]).lines().last(), Some("1,end,0,0,0,0,0"));
}

#[test]
fn files_are_whole_and_their_extension_is_their_format() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    for (name, begins) in [
        ("a.csv", &b"index,"[..]),
        ("a.json", b"{\"schema\":1"),
        ("a.png", b"\x89PNG"),
        ("a.svg", b"<svg"),
    ] {
        let path = at(name);
        std::fs::write(&path, "old").expect("written");
        stdout(&["simulate", "--periods", "4", "--output", &path.display().to_string()]);
        assert!(std::fs::read(&path).expect("read").starts_with(begins), "{name}");
    }
    let plain = at("plain").display().to_string();
    stdout(&["simulate", "--periods", "4", "--output", &plain, "--format", "json"]);
    assert!(std::fs::read_to_string(&plain).expect("read").starts_with('{'));
    assert_eq!(
        stdout(&["simulate", "--events", "1", "--output", "-"]),
        stdout(&["simulate", "--events", "1"])
    );
    assert_eq!(
        std::fs::read_dir(folder.path()).map(Iterator::count).ok(),
        Some(5),
        "no temporary file is left"
    );
}

#[test]
fn numbers_read_back() {
    let tiny =
        stdout(&["simulate", "--events", "0", "--p", "-1e-7", "--y", "1e9", "--v", "-5e-324"]);
    assert_eq!(tiny.lines().last(), Some("0,no-contact,0,-1e-7,1000000000,0,-5e-324"));
}

#[test]
fn a_reader_that_leaves_early_is_no_error() {
    for (words, header) in [
        ("simulate --periods 1000000 --samples 100", "tau,phase,p,y,q,v,x,z\n"),
        ("events relay-feedback --until 3000", "n,time,event,mode,x1,x2,x3\n"),
    ] {
        let mut command = Command::new(percuss(&[]).get_program());
        command.args(words.split(' ')).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("started");
        let mut first = String::new();
        BufReader::new(child.stdout.take().expect("a pipe")).read_line(&mut first).expect("read");
        assert_eq!(first, header);
        let mut said = String::new();
        child.stderr.take().expect("a pipe").read_to_string(&mut said).expect("read");
        assert!(child.wait().expect("ended").success(), "{words}: {said}");
        assert_eq!(said, "");
    }
}
