//! `poincare`, `lyapunov`, `bifurcation`, `attractors` and `basins`: golden values, what they
//! refuse, and their arrays, read back by a library and byte by byte against NumPy's published
//! format.

use crate::support;
use crate::support::{run, stdout, text};
use std::collections::BTreeSet;
use std::io::{Cursor, Read};
use std::path::Path;

const SURVEY_COMMAND: [&str; 11] = [
    "basins",
    "--grid",
    "7x4",
    "--window",
    "-3,1.2,-1.5,1.5",
    "--transient",
    "60",
    "--xi",
    "0.1",
    "--omega",
    "1.6",
];

/// The header's dictionary and the data, by NumPy's format 1.0: magic, version, little-endian
/// length of a header that ends in a newline on a multiple of 64 bytes.
fn by_hand(bytes: &[u8]) -> (String, &[u8]) {
    assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
    let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let (header, data) = bytes[10..].split_at(length);
    assert_eq!(header.last(), Some(&b'\n'));
    assert_eq!((10 + length) % 16, 0);
    (String::from_utf8(header.to_vec()).unwrap(), data)
}

fn f8(data: &[u8]) -> Vec<f64> {
    data.chunks_exact(8).map(|it| f64::from_le_bytes(it.try_into().unwrap())).collect()
}

fn i4(data: &[u8]) -> Vec<i32> {
    data.chunks_exact(4).map(|it| i32::from_le_bytes(it.try_into().unwrap())).collect()
}

fn entry(archive: &mut zip::ZipArchive<Cursor<Vec<u8>>>, name: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    archive.by_name(name).unwrap().read_to_end(&mut bytes).unwrap();
    bytes
}

fn archive(path: &Path) -> zip::ZipArchive<Cursor<Vec<u8>>> {
    zip::ZipArchive::new(Cursor::new(std::fs::read(path).unwrap())).unwrap()
}

#[test]
fn a_section_that_is_not_decided_to_its_end_says_so() {
    // The motion of `a_phase_that_is_not_decided_ends_the_run`.
    let line = "poincare --periods 10 --transient 999999990 --a 0.84 --b 0.5 --xi 1e-8 --omega 2 \
                --phi 1.5707963267948966 --p 0.8 --y 0.56 --q 0.78";
    let words: Vec<_> = line.split_whitespace().collect();
    let output = run(&words);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("undecidable") && said.contains("after 0 points"), "{said}");
    assert_eq!(text(&output.stdout), "n,p,y,q,v\n");
    // An array's length stands at its beginning, so there is none of fewer points.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.npy");
    let output = run(&[&words[..], &["--output", path.to_str().unwrap()]].concat());
    let said = text(&output.stderr);
    assert!(!output.status.success() && said.contains("undecidable"), "{said}");
    assert!(!path.exists());
}

#[test]
fn exponents_and_diagrams_that_are_not_decided_to_their_end_say_so() {
    let start = "--b 0.5 --xi 1e-8 --omega 2 --p 0.8 --y 0.56 --q 0.78";
    let ran = |line: &str| {
        let words: Vec<_> = line.split_whitespace().chain(start.split_whitespace()).collect();
        let output = run(&words);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{line}: {said}");
        assert!(said.contains("undecidable: rounding hides how a phase ends"), "{said}");
        text(&output.stdout)
    };
    // The phase is undecided in the transient, and in the last of two halves.
    for (transient, periods) in [(999_999_980_u64, 10_u64), (0, 4_000_000)] {
        let shown = ran(&format!("lyapunov --a 0.84 --transient {transient} --periods {periods}"));
        assert!(shown.contains("\"drift_per_period\": null"), "{shown}");
    }
    let values = "--parameter a --from 0.84 --to 0.84 --steps 1";
    let rows = ran(&format!("bifurcation {values} --transient 999999990 --periods 2"));
    assert_eq!(rows.lines().count(), 1, "{rows}");
}

#[test]
fn a_section_is_the_table() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.npy");
    let usual = ["poincare", "--transient", "30", "--periods", "50", "--section", "1.25"];
    assert_eq!(stdout(&[&usual[..], &["--output", path.to_str().unwrap()]].concat()), "");
    let bytes = std::fs::read(path).unwrap();
    let (header, data) = by_hand(&bytes);
    for part in ["'descr': '<f8'", "'fortran_order': False", "'shape': (50, 4, )"] {
        assert!(header.contains(part), "{header}");
    }
    let table = stdout(&usual);
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some("n,p,y,q,v"));
    let rows: Vec<f64> = lines
        .enumerate()
        .flat_map(|(n, line)| {
            let (number, rest) = line.split_once(',').unwrap();
            assert_eq!(number, n.to_string());
            rest.split(',').map(|it| it.parse().unwrap()).collect::<Vec<f64>>()
        })
        .collect();
    assert_eq!(f8(data), rows);
    let again = npyz::NpyFile::new(&bytes[..]).unwrap();
    assert_eq!(again.shape(), &[50, 4]);
    assert_eq!(again.into_vec::<f64>().unwrap(), rows);
}

#[test]
fn basins_hold_what_the_json_says() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("b.npz");
    let json = stdout(&[&SURVEY_COMMAND[..], &["--output", path.to_str().unwrap()]].concat());
    let said: serde_json::Value = serde_json::from_str(&json).unwrap();
    let mut archive = archive(&path);
    let mut names: Vec<_> = archive.file_names().map(|name| name.unwrap().into_owned()).collect();
    names.sort();
    assert_eq!(names, ["ids.npy", "labels.npy", "meta.npy", "p.npy", "y.npy"]);

    let labels = entry(&mut archive, "labels.npy");
    let (header, data) = by_hand(&labels);
    assert!(header.contains("'descr': '<i4'") && header.contains("'shape': (4, 7, )"), "{header}");
    let labels = i4(data);
    for attractor in said["attractors"].as_array().unwrap() {
        let id = attractor["id"].as_i64().unwrap();
        let count = labels.iter().filter(|label| i64::from(**label) == id).count();
        assert_eq!(attractor["fraction"].as_f64().unwrap(), count as f64 / 28.0);
    }
    let ids = entry(&mut archive, "ids.npy");
    let listed = said["attractors"].as_array().unwrap().len();
    assert_eq!(i4(by_hand(&ids).1), (0..listed as i32).collect::<Vec<_>>());

    let p = entry(&mut archive, "p.npy");
    assert!(by_hand(&p).0.contains("'shape': (7, )"));
    let p = f8(by_hand(&p).1);
    assert!((p[0] - -2.7).abs() < 1e-12 && (p[6] - 0.9).abs() < 1e-12, "{p:?}");
    let y = f8(by_hand(&entry(&mut archive, "y.npy")).1);
    assert!((y[0] - -1.125).abs() < 1e-12 && (y[3] - 1.125).abs() < 1e-12, "{y:?}");

    let meta = entry(&mut archive, "meta.npy");
    let (header, meta) = by_hand(&meta);
    assert!(header.contains("'descr': '|u1'"), "{header}");
    assert_eq!(serde_json::from_slice::<serde_json::Value>(meta).unwrap(), said);

    // Row 0 is at the lowest y: each label is that of a grid of one cell there.
    for (cell, label) in labels.iter().enumerate().step_by(3) {
        let (p, y) = (p[cell % 7], y[cell / 7]);
        let window = format!("{:?},{:?},{:?},{:?}", p - 1e-9, p + 1e-9, y - 1e-9, y + 1e-9);
        let single = ["attractors", "--grid", "1x1", "--window", &window];
        let single = stdout(&[&single[..], &SURVEY_COMMAND[5..]].concat());
        let single: serde_json::Value = serde_json::from_str(&single).unwrap();
        let found = &single["attractors"][0];
        let expected = &said["attractors"][usize::try_from(*label).unwrap()];
        assert_eq!((&found["kind"], &found["period"]), (&expected["kind"], &expected["period"]));
    }
}

#[test]
fn threads_change_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mut seen = Vec::new();
    for threads in ["1", "2", "5"] {
        let path = folder.path().join(format!("{threads}.npz"));
        let more = ["--threads", threads, "--output", path.to_str().unwrap()];
        let json = stdout(&[&SURVEY_COMMAND[..], &more].concat());
        seen.push((json, std::fs::read(path).unwrap()));
    }
    assert!(seen.windows(2).all(|pair| pair[0] == pair[1]));
    let diagram = |threads: &str, how: &str| {
        let more = ["--parameter", "b", "--from", "0.05", "--to", "0.2", "--steps", "9"];
        let run = ["--transient", "20", "--periods", "5", "--threads", threads, how];
        stdout(&[&["bifurcation"], &more[..], &run].concat())
    };
    for how in ["--carry", "--reset"] {
        assert_eq!(diagram("1", how), diagram("4", how));
        assert_eq!(diagram("1", how).lines().count(), 1 + 9 * 5);
    }
}

#[test]
fn pictures_are_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    stdout(&["poincare", "--transient", "9", "--periods", "99", "--output", &path("s.png")]);
    stdout(&[&SURVEY_COMMAND[..], &["--output", &path("b.png")]].concat());
    let bifurcation = [
        "bifurcation",
        "--parameter",
        "omega",
        "--from",
        "1",
        "--to",
        "0.5",
        "--steps",
        "4",
        "--transient",
        "9",
        "--periods",
        "9",
        "--output",
    ];
    stdout(&[&bifurcation[..], &[&path("d.png")]].concat());
    stdout(&[&bifurcation[..], &[&path("d.svg")]].concat());
    for name in ["s.png", "b.png", "d.png"] {
        let file = std::io::BufReader::new(std::fs::File::open(path(name)).unwrap());
        let mut reader = png::Decoder::new(file).read_info().expect(name);
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).expect(name);
        let colours: BTreeSet<&[u8]> = pixels.chunks(3).collect();
        // Paper, axes, and what is drawn.
        assert!(colours.len() > 2, "{name} has {} colours", colours.len());
    }
    let svg = std::fs::read_to_string(path("d.svg")).unwrap();
    let mut reader = quick_xml::Reader::from_str(&svg);
    loop {
        match reader.read_event().unwrap() {
            quick_xml::events::Event::Eof => break,
            _ => continue,
        }
    }
    assert!(svg.contains("drift per period"));
}

#[test]
fn what_is_not_accepted_is_one_line() {
    let grid = ["--grid", "4x4", "--window", "-1,1,-1,1", "--transient", "5"];
    let survey = |verb: &'static str, more: &[&'static str]| [&[verb], &grid[..], more].concat();
    let poincare = |more: &[&'static str]| {
        [&["poincare", "--transient", "5", "--periods", "5"][..], more].concat()
    };
    let bifurcation = |more: &[&'static str]| {
        let usual = ["bifurcation", "--transient", "5", "--periods", "5", "--steps", "3"];
        [&usual[..], more].concat()
    };
    let cases: Vec<(Vec<&str>, &str)> = vec![
        (survey("basins", &[]), "--output"),
        (survey("basins", &["--output", "-"]), "--output"),
        (survey("basins", &["--output", "x.csv"]), "npz"),
        (survey("attractors", &["--grid", "0x4"]), "--grid"),
        (["attractors", "--grid", "9999x9999"].to_vec(), "16777216"),
        (["attractors", "--grid", "4"].to_vec(), "NXxNY"),
        (["attractors", "--grid", "4x4", "--window", "1,-1,0,1"].to_vec(), "rising"),
        (["attractors", "--grid", "4x4", "--window", "0,0,0,1"].to_vec(), "rising"),
        (["attractors", "--grid", "4x4", "--window", "0,nan,0,1"].to_vec(), "rising"),
        (
            ["attractors", "--grid", "4x4", "--window", "0,1,0,1", "--transient", "0"].to_vec(),
            "1 to 10000000",
        ),
        (survey("attractors", &["--xi", "0"]), "--xi"),
        (poincare(&["--section", "nan"]), "--section"),
        (["poincare", "--transient", "999999999", "--periods", "2"].to_vec(), "1000000000"),
        (["poincare", "--transient", "1", "--periods", "0"].to_vec(), "--periods"),
        (poincare(&["--output", "x.xls"]), "csv, npy, npz, png, svg"),
        (
            ["poincare", "--transient", "1", "--periods", "5000001", "--format", "png"].to_vec(),
            "5000000",
        ),
        (bifurcation(&["--parameter", "x", "--from", "1", "--to", "2"]), "a, b, xi, omega, g, phi"),
        (bifurcation(&["--parameter", "omega", "--from", "-1", "--to", "2"]), "--from"),
        (bifurcation(&["--parameter", "omega", "--from", "1", "--to", "1e9"]), "--to"),
        (
            bifurcation(&["--parameter", "b", "--from", "0", "--to", "1", "--carry", "--reset"]),
            "--reset",
        ),
        (
            bifurcation(&[
                "--parameter",
                "g",
                "--from",
                "1",
                "--to",
                "0",
                "--reset",
                "--q",
                "0",
                "--p",
                "0.01",
            ]),
            "--parameter g",
        ),
        (["lyapunov", "--transient", "1", "--periods", "0"].to_vec(), "--periods"),
    ];
    for (arguments, named) in cases {
        let output = run(&arguments);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?} {said}");
        assert!(said.contains(named) && said.lines().count() == 1, "{arguments:?}: {said}");
        assert!(output.stdout.is_empty());
    }
}

fn json(arguments: &[&str]) -> serde_json::Value {
    serde_json::from_str(&stdout(arguments)).unwrap()
}

/// Rounded to what does not depend on the platform: a few roundings of a stable orbit.
#[test]
fn table_1_has_its_exponent_and_its_drift() {
    let table1 = ["--omega", "0.1", "--transient", "200"];
    let found = json(&[&["lyapunov"], &table1[..], &["--periods", "320"]].concat());
    let near = |value: &serde_json::Value, expected: f64, within: f64| {
        assert!((value.as_f64().unwrap() - expected).abs() <= within, "{value} {expected}");
    };
    near(&found["exponents_per_period"][0], -0.249_433_906, 1e-8);
    near(&found["drift_per_period"], 13.910_576, 1e-6);
    assert!(found["exponents_per_period"][2].is_null() && found["standard_error"][2].is_null());
    let grid = ["attractors", "--grid", "3x3", "--window", "-1,1,-1,1"];
    let found = json(&[&grid[..], &table1[..]].concat());
    let orbit = &found["attractors"][0];
    assert_eq!((orbit["id"].as_i64(), orbit["period"].as_i64()), (Some(0), Some(2)));
    assert_eq!(orbit["fraction"], 1.0);
    near(&orbit["lyapunov_per_period"], -0.249_433_906, 1e-8);
    near(&orbit["drift_per_period"], 13.910_576, 1e-6);
    near(&orbit["multipliers"][0][0], -0.607_217_755, 1e-8);
    let diagram =
        ["bifurcation", "--parameter", "omega", "--from", "0.1", "--to", "0.1", "--steps", "1"];
    let diagram = stdout(&[&diagram[..], &table1[2..], &["--periods", "2"]].concat());
    let row: Vec<f64> = diagram.lines().nth(1).unwrap().split(',').map(support::number).collect();
    assert_eq!(row[..2], [0.1, 0.0]);
    assert!((row[5] - 13.910_576).abs() < 1e-6, "{diagram}");
}

#[test]
fn a_motion_without_end_is_told() {
    let runs = [
        &["poincare", "--b=-0.1", "--transient", "5", "--periods", "5"][..],
        &["lyapunov", "--b=-0.1", "--transient", "5", "--periods", "5"],
    ];
    for arguments in runs {
        let output = run(arguments);
        assert_eq!(output.status.code(), Some(0));
        let said = text(&output.stderr);
        assert!(said.contains("never returns") && said.lines().count() == 1, "{said}");
    }
}

#[test]
fn a_state_that_the_axes_of_a_grid_replace_is_told() {
    let at = ["percussive-oscillator", "--at", "p=1", "--at", "q=0.1"];
    let grid = ["--grid", "1x1", "--window", "0,1,0,1", "--axes", "y,p"];
    for verb in [&["attractors", "--transient", "10"][..], &["orbit", "--all", "--period", "1"]] {
        let output = run(&[&verb[..1], &at, &grid, &verb[1..]].concat());
        let said = text(&output.stderr);
        assert!(said.contains("--at p=1 is not used: starts are the centres"), "{said}");
        assert!(!said.contains("--at q"), "{said}");
    }
}
