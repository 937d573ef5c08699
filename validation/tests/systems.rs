//! The verbs `systems` and `events`.

use crate::support::{number, percuss, refused, rows, run, stdout, text};
use percuss_validation::systems::SYSTEMS;
use std::path::Path;

#[test]
fn every_file_of_the_folder_is_in_the_program_under_its_own_name() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("systems");
    let mut files: Vec<String> = std::fs::read_dir(folder)
        .expect("the folder is there")
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter_map(|file| file.strip_suffix(".system.toml").map(str::to_owned))
        .collect();
    files.sort();
    let names: Vec<_> = SYSTEMS.iter().map(|(name, _)| *name).collect();
    assert_eq!(files, names);
    for (name, text) in SYSTEMS {
        let system = percuss::affine::System::parse(name, text).expect("it is accepted");
        assert_eq!(system.name, *name);
        assert!(system.start.is_some(), "{name}");
        assert!(!system.trouble.is_empty() && !system.source.is_empty(), "{name}");
    }
}

/// A ball that is thrown up on an incline of its own: none of the repository's systems.
const THROWN: &str = "schema = 1
name = \"thrown\"
states = [\"height\", \"speed\"]
[parameters]
gravity = 3.0
quotient = 0.25
[[mode]]
name = \"air\"
equations = [\"height' = speed\", \"speed' = -gravity\"]
[[mode.until]]
name = \"ground\"
guard = \"height < 0\"
reset = [\"height = 0\", \"speed = -quotient*speed\"]
[[mode.watch]]
name = \"level\"
guard = \"height > 1\"
direction = \"both\"
[start]
mode = \"air\"
height = 2
speed = 0
";

/// sqrt n by Newton's method on integers, scaled by 10^(2 digits): its digits.
fn root(n: u128, digits: u32) -> String {
    let target = n * 10_u128.pow(digits);
    let mut root = target;
    loop {
        let next = (root + target / root) / 2;
        if next >= root {
            return root.to_string();
        }
        root = next;
    }
}

#[test]
fn a_file_of_ones_own_has_events_to_the_digits_promised() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("thrown.system.toml");
    std::fs::write(&file, THROWN).expect("written");
    let file = file.to_str().expect("UTF-8");
    let listed = rows(&stdout(&["events", file, "--until", "1.5", "--digits", "25"]));
    let names: Vec<_> = listed.iter().map(|row| row[2].as_str()).collect();
    // Dropped from 2 it passes 1, and bounces to 1/8.
    assert_eq!(names[..3], ["", "level", "ground"]);
    // sqrt(2/3) = sqrt 6/3 and sqrt(4/3) = sqrt 12/3, by integers.
    for (row, n) in [(1, 6), (2, 12)] {
        let third = root(n, 36).parse::<u128>().expect("digits") / 3;
        let digits: String = listed[row][1].chars().filter(char::is_ascii_digit).collect();
        let digits = digits.trim_start_matches('0');
        // The last digits of the comparison's own 18 are cut, not rounded.
        assert_eq!(digits[..16], third.to_string()[..16], "{row}");
        assert_eq!(digits.len(), 25, "{row}");
    }
    let narrow = rows(&stdout(&["events", file, "--until", "1.5"]));
    assert!((number(&narrow[1][1]) - (2.0_f64 / 3.0).sqrt()).abs() < 1e-15);
    let heavier = rows(&stdout(&["events", file, "--until", "1", "--set", "gravity=8"]));
    assert_eq!(heavier[1][1], "0.50000000000000000");
    let start = folder.path().join("start.toml");
    std::fs::write(&start, "[start]\nmode = \"air\"\nheight = 0\nspeed = 6\n").expect("written");
    let start = start.to_str().expect("UTF-8");
    let thrown = rows(&stdout(&["events", file, "--events", "3", "--start", start]));
    assert_eq!(thrown.len(), 4);
    assert_eq!((thrown[3][1].as_str(), thrown[3][4].as_str()), ("4.0000000000000000", "0"));
    assert_eq!(thrown[3][5], "1.5000000000000000");
}

#[test]
fn endings_have_their_exit_codes() {
    let ended = |arguments: &[&str]| {
        let output = run(arguments);
        let csv = text(&output.stdout);
        let last = rows(&csv).pop().expect("rows")[2].clone();
        (output.status.code(), last, text(&output.stderr))
    };
    let (code, last, said) = ended(&["events", "bouncing-ball", "--until", "10"]);
    assert_eq!((code, last.as_str()), (Some(0), "accumulation"));
    assert!(said.contains("between 2.99999999") && said.contains(" and 3.00000000"), "{said}");
    let (code, last, _) = ended(&["events", "bouncing-ball", "--until", "-1", "--backward"]);
    assert_eq!((code, last.as_str()), (Some(0), "leaves-domain"));
    let inelastic = ["events", "spheres-in-a-row", "--until", "3", "--set", "e=0.05"];
    let (code, last, said) = ended(&inelastic);
    assert_eq!((code, last.as_str()), (Some(1), "no-progress"), "{said}");
    assert!(said.contains("64 events"), "{said}");
}

/// a = exp(-t) touches b + 1/4 with b = exp(-2 t) at the logarithm of two, which no number of bits
/// decides.
const TOUCH: &str = "schema = 1\nname = \"touch\"\nstates = [\"a\", \"b\"]\n[[mode]]\nname = \"go\"\n\
     equations = [\"a' = -a\", \"b' = -2*b\"]\n[[mode.watch]]\nname = \"down\"\nguard = \"4*a < 3\"\n\
     [[mode.watch]]\nname = \"touch\"\nguard = \"4*a > 4*b + 1\"\n\
     [start]\nmode = \"go\"\na = 1\nb = 1\n";

/// The last row is the motion that is known, later than the event before.
#[test]
fn a_touch_that_no_bits_decide_shows_the_motion_up_to_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("touch.system.toml");
    std::fs::write(&file, TOUCH).expect("written");
    for bits in ["106", "424"] {
        let file = file.to_str().expect("UTF-8");
        let output = run(&["events", file, "--until", "1", "--max-bits", bits]);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1));
        assert!(said.contains(&format!("is not decided by {bits} bits")), "{said}");
        assert!(said.contains("the guard of \"touch\" crosses: nearer to zero than 1e-"), "{said}");
        let rows = rows(&text(&output.stdout));
        assert_eq!((rows[1][2].as_str(), rows[2][2].as_str()), ("down", "undecided"));
        let [time, a, b] = [1, 4, 5].map(|n| rows[2][n].parse::<f64>().expect("a number"));
        assert!(time > 0.69 && time < std::f64::consts::LN_2 + 1e-15, "{time:?}");
        assert!((a - (-time).exp()).abs() < 1e-15 && (b - (-2.0 * time).exp()).abs() < 1e-15);
    }
}

/// A touch that the model decides is no event and ends no run.
#[test]
fn a_touch_of_the_model_is_no_event() {
    let csv = stdout(&["events", "watched-ball", "--until", "1"]);
    let named: Vec<String> = rows(&csv).into_iter().map(|row| row[2].clone()).collect();
    assert_eq!(named[..4], ["", "up", "apex", "down"], "{csv}");
}

/// Its time has no digit, and is known all the same.
#[test]
fn an_event_at_time_zero_does_not_end_the_run() {
    let folder = tempfile::tempdir().expect("a folder");
    let start = folder.path().join("before.toml");
    let text = "[start]\nmode = \"flight\"\nt = -1.5\nx = 0\nv = 1.5\n";
    std::fs::write(&start, text).expect("written");
    let start = start.to_str().expect("UTF-8");
    let csv = stdout(&["events", "bouncing-ball", "--until", "1.2", "--start", start]);
    let rows = rows(&csv);
    let named: Vec<&str> = rows.iter().map(|row| row[2].as_str()).collect();
    assert_eq!(named, ["", "impact", "impact", "impact", "end"], "{csv}");
    assert_eq!(rows[2][1], "0.75000000000000000");
}

#[test]
fn what_ends_a_run_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let below = folder.path().join("below.toml");
    std::fs::write(&below, "[start]\nmode = \"flight\"\nx = -1\nv = 0\n").expect("written");
    let below = below.to_str().expect("UTF-8");
    let output = run(&["events", "bouncing-ball", "--until", "1", "--start", below]);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1));
    assert!(said.contains("the guard of \"impact\" is positive there"), "{said}");
    let file = folder.path().join("grown.system.toml");
    let grown = "schema = 1\nname = \"grown\"\nstates = [\"x\"]\n[[mode]]\nname = \"free\"\n\
                 equations = [\"x' = 1000*x\"]\n[start]\nmode = \"free\"\nx = 1\n";
    std::fs::write(&file, grown).expect("written");
    let output =
        run(&["events", file.to_str().expect("UTF-8"), "--until", "2", "--max-bits", "106"]);
    let said = text(&output.stderr);
    assert!(said.contains("is too large for its bounds to be numbers"), "{said}");
}

#[test]
fn what_is_not_accepted_is_named() {
    refused(&["events", "bouncing-bull", "--until", "1"], &["bouncing-ball", "percuss systems"]);
    refused(&["events", "bouncing-ball", "--until", "-1"], &["--until -1", "after the start"]);
    refused(
        &["events", "bouncing-ball", "--until", "1", "--backward"],
        &["--until 1", "before the start"],
    );
    let set = |value| ["events", "bouncing-ball", "--until", "1", "--set", value];
    refused(&set("mass=1"), &["--set", "\"mass\" is no parameter", "e, g"]);
    refused(&set("g"), &["'g' for '--set", "NAME=VALUE"]);
    refused(&set("g=nan"), &["'g=nan' for '--set", "finite"]);
    refused(&["events", "bouncing-ball", "--until", "1", "--digits", "18"], &["18", "17, 25"]);
    refused(&["events", "bouncing-ball"], &["--until", "--events"]);
    refused(
        &["events", "bouncing-ball", "--until", "1", "--start", "/no/such.toml"],
        &["--start", "/no/such.toml"],
    );
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("odd.system.toml");
    std::fs::write(&file, THROWN.replace("-gravity", "-9.81")).expect("written");
    let file = file.to_str().expect("UTF-8");
    refused(&["events", file, "--until", "1"], &["odd.system.toml:9: a decimal is not accepted"]);
}

#[test]
fn a_file_is_written_whole() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("events.csv");
    let to = path.to_str().expect("UTF-8");
    percuss(&["events", "relay-feedback", "--until", "4", "--output", to]).assert().success();
    let csv = std::fs::read_to_string(&path).expect("written");
    assert!(csv.starts_with("n,time,event,mode,x1,x2,x3\n0,0,,up,"), "{csv}");
}

/// The picture of a run, as an SVG.
fn svg(arguments: &[&str]) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("run.svg");
    let to = path.to_str().expect("UTF-8");
    percuss(&[&["events"], arguments, &["--output", to]].concat()).assert().success();
    std::fs::read_to_string(&path).expect("written")
}

#[test]
fn a_run_is_drawn_with_its_modes_and_its_events() {
    let drawn = svg(&["plastic-ball-on-table", "--until", "20"]);
    let mut reader = quick_xml::Reader::from_str(&drawn);
    while !matches!(reader.read_event().expect("well formed"), quick_xml::events::Event::Eof) {}
    for word in ["plastic-ball-on-table", "stuck", "flight", "detach", "impact", "time", "x", "v"] {
        assert!(drawn.contains(&format!(">\n{word}\n</text>")), "{word} is not in the picture");
    }
    assert!(drawn.contains("A = 1.5"), "the parameters");
    // Only what occurs has a name: this run ends before it lands.
    let short = svg(&["plastic-ball-on-table", "--until", "6"]);
    assert!(short.contains(">\ndetach\n</text>") && !short.contains(">\nimpact\n</text>"));
    // The same run in the other direction of time, and one that has no length, are drawn too.
    for arguments in [
        &["watched-impact-oscillator", "--backward", "--until", "-3"][..],
        &["bouncing-ball", "--until", "0"],
        &["bouncing-ball", "--until", "9"],
    ] {
        assert!(svg(arguments).starts_with("<svg"), "{arguments:?}");
    }
    // So is one without progress, which is exit code 1.
    let resting = ["events", "rigid-impact-oscillator", "--until", "5", "--set", "d=0"];
    let output = run(&[&resting[..], &["--format", "svg"]].concat());
    let (drawn, said) = (text(&output.stdout), text(&output.stderr));
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(drawn.starts_with("<svg") && said.contains("64 events"), "{said}");
}

/// Between events a picture shows the closed form: the table's height is A cos t where the ball is
/// stuck to it, and a tenth of a pixel is all that may be left out.
#[test]
fn a_picture_shows_the_motion_itself() {
    let drawn = svg(&["plastic-ball-on-table", "--until", "5.4", "--set", "A=1", "--states", "x"]);
    let line = drawn.split("<path d=\"M").filter(|it| it.contains("stroke-width=\"200\""));
    let line = line.filter_map(|it| it.split('"').next()).next().expect("a curve");
    let (start, steps) = line.split_once('l').expect("steps");
    let numbers = |text: &str| -> Vec<i32> {
        text.split_whitespace().map(|it| it.parse().expect("an integer")).collect()
    };
    let start = numbers(start);
    let mut places = vec![(start[0], start[1])];
    for step in numbers(steps).chunks(2) {
        let last = places[places.len() - 1];
        places.push((last.0 + step[0], last.1 + step[1]));
    }
    assert!(places.len() > 20 && places.len() < 300, "{}", places.len());
    let (first, last) = (places[0], places[places.len() - 1]);
    let time = |x: f64| 2.0 + 3.4 * (x - f64::from(first.0)) / f64::from(last.0 - first.0);
    // Two heights that are known fix the scale of the axis: those of the two ends.
    let (bottom, top) = (2.0_f64.cos(), 5.4_f64.cos());
    let height =
        |y: f64| bottom + (top - bottom) * (y - f64::from(first.1)) / f64::from(last.1 - first.1);
    let pixel = (top - bottom).abs() * 100.0 / f64::from((last.1 - first.1).abs());
    for ends in places.windows(2) {
        // At the points, and half way between them.
        let middle = |a: i32, b: i32| 0.5 * (f64::from(a) + f64::from(b));
        let (x, y) = (middle(ends[0].0, ends[1].0), middle(ends[0].1, ends[1].1));
        let off = (height(y) - time(x).cos()).abs();
        assert!(off < 0.3 * pixel, "{off} at {}", time(x));
    }
}

#[test]
fn what_a_picture_shows_is_chosen() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("run.png");
    let to = path.to_str().expect("UTF-8");
    let cradle = ["events", "newton-cradle", "--until", "2", "--output", to];
    let output = run(&cradle);
    assert!(output.status.success());
    assert!(text(&output.stderr).contains("6 of 10 states"), "{}", text(&output.stderr));
    let bytes = std::io::Cursor::new(std::fs::read(&path).expect("written"));
    let decoder = png::Decoder::new(bytes);
    let width = decoder.read_info().expect("a picture").info().width;
    assert_eq!(width, 1500);
    let chosen = [&cradle[..], &["--states", "x5,v5"]].concat();
    assert!(run(&chosen).stderr.is_empty());
    refused(&[&cradle[..], &["--states", "x1,x9"]].concat(), &["--states x1,x9", "x5"]);
    refused(&[&cradle[..], &["--states", "x1,x1"]].concat(), &["--states x1,x1", "each once"]);
    let many = "x1,x2,x3,x4,x5,v1,v2";
    refused(&[&cradle[..], &["--states", many]].concat(), &[many, "at most 6"]);
    let endless = ["events", "relay-feedback", "--until", "100000", "--format", "svg"];
    refused(&endless, &["more than 20000 events", "csv or json"]);
}

#[test]
fn a_case_serves_as_a_start() {
    let case = "cases/systems/relay-1e-4.toml";
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join(case);
    let case = case.to_str().expect("UTF-8");
    let relay = ["events", "relay-feedback", "--until", "4"];
    let from_case = stdout(&[&relay[..], &["--start", case]].concat());
    assert_eq!(from_case, stdout(&[&relay[..], &["--set", "delta=1e-4"]].concat()));
    let other = ["events", "bouncing-ball", "--until", "1", "--start", case];
    refused(&other, &["--start", "a case of relay-feedback", "one of bouncing-ball"]);
    let folder = tempfile::tempdir().expect("a folder");
    let odd = folder.path().join("odd.toml");
    std::fs::write(&odd, "[begin]\nx = 1\n").expect("written");
    let odd = odd.to_str().expect("UTF-8");
    refused(&[&relay[..], &["--start", odd]].concat(), &["begin is not accepted here", "[start]"]);
}
