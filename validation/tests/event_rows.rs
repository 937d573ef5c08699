//! The rows of `events`: how a run ends and what is said of it, samples, and columns.

use crate::support::{number, rows, run, stdout, text};
use std::path::PathBuf;

/// A system's file in a folder that lasts as long as the test.
fn file(text: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("own.system.toml");
    std::fs::write(&path, text).expect("written");
    (folder, path)
}

/// The exit code, the rows and the messages of a run of a file's system.
fn events(text_of_file: &str, flags: &[&str]) -> (Option<i32>, Vec<Vec<String>>, String) {
    let (_folder, path) = file(text_of_file);
    let path = path.to_str().expect("UTF-8");
    let output = run(&[&["events", path], flags].concat());
    (output.status.code(), rows(&text(&output.stdout)), text(&output.stderr))
}

/// A watched guard is touched where the motion leaves its mode for one with other guards.
#[test]
fn a_guard_that_is_open_is_named_by_its_own_mode() {
    let first = "schema = 1\nname = \"names\"\nstates = [\"x\", \"y\", \"w\"]\n[[mode]]\nname = \"a\"\n\
                 equations = [\"x' = 1\", \"y' = w\", \"w' = -2\"]\n[[mode.until]]\nname = \"over\"\n\
                 guard = \"x > 1\"\nnext = [{ mode = \"b\" }]\n[[mode.watch]]\nname = \"touch\"\n\
                 guard = \"y > 0\"\n[[mode]]\nname = \"b\"\n\
                 equations = [\"x' = 1\", \"y' = w\", \"w' = -2\"]\n";
    let other = "[[mode.until]]\nname = \"far\"\nguard = \"x > 100\"\n[[mode.watch]]\n\
                 name = \"innocent\"\nguard = \"w > 50\"\n";
    for more in ["", other] {
        let start = "[start]\nmode = \"a\"\nx = 0\ny = -1\nw = 2\n";
        let (code, _, said) = events(&format!("{first}{more}{start}"), &["--until", "5"]);
        assert!(matches!(code, Some(0 | 1)), "{code:?}: {said}");
        assert!(!said.contains("panicked") && !said.contains("innocent"), "{said}");
    }
}

#[test]
fn a_run_of_too_many_events_is_stopped() {
    let relay = ["events", "relay-feedback", "--until", "100"];
    let output = run(&[&relay[..], &["--max-events", "3"]].concat());
    assert_eq!(output.status.code(), Some(0));
    let said = text(&output.stderr);
    assert!(said.contains("after 3 events: --max-events") && said.lines().count() == 1, "{said}");
    let stopped = rows(&text(&output.stdout));
    let all = rows(&stdout(&[&relay[..], &["--max-events", "1e6"]].concat()));
    assert_eq!(stopped[..4], all[..4]);
    assert_eq!(
        (stopped.len(), stopped[4][0].as_str(), stopped[4][2].as_str()),
        (5, "4", "stopped")
    );
    // It stands where the last event is.
    assert_eq!((&stopped[4][1], &stopped[4][3..]), (&stopped[3][1], &stopped[3][3..]));
    // A run that has no more events than it may have is not stopped.
    let [until, most] = [all[3][1].clone(), "3".to_owned()];
    let until = (number(&until) + 1e-3).to_string();
    let whole = ["events", "relay-feedback", "--until", &until, "--max-events", &most];
    assert_eq!(rows(&stdout(&whole)).last().expect("rows")[2], "end");
    // --events is a limit of its own.
    let counted = ["events", "relay-feedback", "--events", "3", "--max-events", "4"];
    assert_eq!(rows(&stdout(&counted)), all[..4]);
    let output = run(&["events", "relay-feedback", "--events", "4", "--max-events", "3"]);
    assert_eq!(rows(&text(&output.stdout)), stopped);
}

/// A spring that is stiffer while the mass moves away from the middle.
const SLIDING: &str = "schema = 1
name = \"semi-active\"
states = [\"x\", \"v\"]
[[mode]]
name = \"out\"
equations = [\"x' = v\", \"v' = 1 - 8*x\"]
[[mode.until]]
name = \"turn\"
guard = \"v < 0\"
next = [{ mode = \"in\" }]
[[mode]]
name = \"in\"
equations = [\"x' = v\", \"v' = 1 - 2*x\"]
[[mode.until]]
name = \"turn-back\"
guard = \"v > 0\"
next = [{ mode = \"out\" }]
[start]
mode = \"out\"
x = 0.125
v = 0.25
";

/// The first event sets a number and leaves its own condition true.
const ONE_SHOT: &str = "schema = 1
name = \"one-shot\"
states = [\"a\", \"clock\"]
[[mode]]
name = \"before\"
equations = [\"a' = 1\", \"clock' = 1\"]
[[mode.until]]
name = \"once\"
guard = \"clock > 10\"
reset = [\"a = a + 10\"]
[[mode.until]]
name = \"never\"
guard = \"clock > 10\"
[start]
mode = \"before\"
a = 1
clock = 0
";

#[test]
fn events_of_one_instant_are_named_and_explained() {
    let explained = |(code, rows, said): (Option<i32>, Vec<Vec<String>>, String),
                     parts: &[&str]| {
        assert_eq!(code, Some(1), "{said}");
        assert_eq!(rows.last().expect("rows")[2], "no-progress");
        assert!(
            said.lines().count() == 2 && said.contains("64 events fall on one instant"),
            "{said}"
        );
        parts.iter().for_each(|part| assert!(said.contains(part), "{part} is not in {said}"));
    };
    let until = ["--until", "20"];
    let turns = "in turn \"turn\" (from out to in), \"turn-back\" (from in to out)";
    explained(events(SLIDING, &until), &[turns, "the motion slides: out and in", "a third mode"]);
    let once = ["all of them \"once\" (in before)", "repeats a one-shot", "does not clear"];
    explained(events(ONE_SHOT, &until), &once);
    let of = |arguments: &[&str]| {
        let output = run(arguments);
        (output.status.code(), rows(&text(&output.stdout)), text(&output.stderr))
    };
    let resting = ["events", "rigid-impact-oscillator", "--until", "5", "--set", "d=0"];
    explained(
        of(&resting),
        &["all of them \"impact\"", "comes to rest on the guard of \"impact\""],
    );
    let inelastic = ["events", "spheres-in-a-row", "--until", "3", "--set", "e=0.05"];
    explained(of(&inelastic), &["\"one-two\" (in free), \"two-three\" (in free)", "chatters"]);
}

/// A ball on the ground at 0, thrown up at 3/2 against a force of 2, returns at 3/2 with a half of
/// its speed.
#[test]
fn samples_are_the_motion_at_equal_steps() {
    let ball = ["events", "bouncing-ball", "--until", "2.4", "--samples", "8"];
    let csv = stdout(&ball);
    assert!(csv.starts_with("time,mode,x,v\n0,flight,0,1.5000000000000000\n"), "{csv}");
    let sampled = rows(&csv);
    assert_eq!(sampled.len(), 20);
    for (n, row) in sampled.iter().enumerate() {
        let time = n as f64 / 8.0;
        assert_eq!((number(&row[0]), row[1].as_str()), (time, "flight"));
        let (since, speed) = match time {
            it if it < 1.5 => (it, 1.5),
            it if it < 2.25 => (it - 1.5, 0.75),
            it => (it - 2.25, 0.375),
        };
        let apart =
            [number(&row[2]) - since * (speed - since), number(&row[3]) - speed + 2.0 * since];
        // All numbers are dyadic: what a cell of a zero may stand for is all that differs.
        assert!(apart.iter().all(|it| it.abs() < 1e-27), "{row:?}");
    }
    // The state at an event is the one after it, as in the rows of events.
    assert_eq!(sampled[12][0], "1.5000000000000000");
    assert_eq!(sampled[12][3], "0.75000000000000000");
    // After the second event there is none, and an accumulation ends the rows.
    let counted = stdout(&["events", "bouncing-ball", "--events", "2", "--samples", "8"]);
    assert_eq!(rows(&counted), sampled[..18]);
    let output = run(&["events", "bouncing-ball", "--until", "10", "--samples", "1"]);
    assert_eq!((output.status.code(), rows(&text(&output.stdout)).len()), (Some(0), 3));
    assert!(
        text(&output.stderr).contains("accumulate between 2.99999"),
        "{}",
        text(&output.stderr)
    );
}

/// x' = cos 4t from 0 is sin(4t)/4; the digits of the times and of sin(pi/3)/4 are mpmath's.
#[test]
fn samples_of_a_forced_system_are_parts_of_its_period() {
    let table = "schema = 1\nname = \"forced\"\nstates = [\"x\"]\nforcing = { omega = 4.0, phi = 0.0 }\n\
                 [[mode]]\nname = \"only\"\nequations = [\"x' = cos\"]\n[start]\nmode = \"only\"\nx = 0\n";
    let (code, sampled, said) =
        events(table, &["--until", "1.6", "--samples", "12", "--digits", "25"]);
    assert_eq!((code, sampled.len(), said.as_str()), (Some(0), 13, ""));
    // The times are parts of pi/2.
    assert_eq!(sampled[1][0], "0.1308996938995747182692768");
    assert_eq!(sampled[1][2], "0.1250000000000000000000000");
    assert_eq!(sampled[2][0], "0.2617993877991494365385536");
    assert_eq!(sampled[2][2], "0.2165063509461096616909308");
    assert_eq!(sampled[12][0], "1.570796326794896619231322");
    assert!(sampled[12][2].starts_with("0e-"), "{:?}", sampled[12]);
}

#[test]
fn a_state_that_is_called_as_a_column_is_told_apart() {
    let system = "schema = 1\nname = \"columns\"\nstates = [\"n\", \"time\", \"event\", \"x\"]\n[[mode]]\n\
                  name = \"only\"\nequations = [\"n' = 1\", \"time' = 0\", \"event' = 0\", \"x' = 0\"]\n\
                  [start]\nmode = \"only\"\nn = 0\ntime = 1\nevent = 2\nx = 3\n";
    let (_folder, path) = file(system);
    let path = path.to_str().expect("UTF-8");
    let header = |more: &[&str]| {
        let csv = stdout(&[&["events", path, "--until", "1"], more].concat());
        csv.lines().next().expect("a header").to_owned()
    };
    assert_eq!(header(&[]), "n,time,event,mode,state.n,state.time,state.event,x");
    assert_eq!(header(&["--samples", "2"]), "time,mode,state.n,state.time,state.event,x");
}

/// exp(-t) touches exp(-2 t) + 1/4 at the logarithm of two, which no bits decide: the search in the
/// most bits ends before it meets the guard that fewer bits name.
#[test]
fn a_guard_that_fewer_bits_leave_open_is_named() {
    let touch = "schema = 1\nname = \"touch\"\nstates = [\"a\", \"b\"]\n[[mode]]\nname = \"only\"\n\
                 equations = [\"a' = -a\", \"b' = -2*b\"]\n[[mode.watch]]\nname = \"touched\"\n\
                 guard = \"4*a > 4*b + 1\"\n[start]\nmode = \"only\"\na = 1\nb = 1\n";
    let (code, rows, said) = events(touch, &["--until", "1"]);
    assert_eq!((code, rows.len(), rows[1][2].as_str()), (Some(1), 2, "undecided"), "{said}");
    assert!(rows[1][1].starts_with("0.6931471805599"), "{rows:?}");
    assert!(said.contains("not decided by 3392 bits"), "{said}");
    assert!(said.contains("leaves open whether the guard of \"touched\" crosses"), "{said}");
    assert_eq!(said.lines().count(), 2, "{said}");
}

/// x = 3 + t - t^2 is zero before the start at (1 - sqrt(13))/2, and so is w = 2 x.
#[test]
fn a_boundary_reached_back_in_time_has_its_zeros() {
    let thrown = "schema = 1\nname = \"thrown\"\nstates = [\"x\", \"w\", \"v\"]\n[[mode]]\nname = \"up\"\n\
                  equations = [\"x' = v\", \"w' = 2*v\", \"v' = -2\"]\n[[mode.until]]\n\
                  name = \"ground\"\nguard = \"x < 0\"\n[start]\nmode = \"up\"\nx = 3\nw = 6\nv = 1\n";
    let (code, rows, said) = events(thrown, &["--until", "-5", "--backward"]);
    assert_eq!(code, Some(0), "{said}");
    assert_eq!(
        rows[1],
        ["1", "-1.3027756377319946", "leaves-domain", "up", "0", "0", "3.6055512754639893"]
    );
    // A start on the boundary leaves at once, and its zeros are those of the row before.
    let ground = thrown.replace("x = 3\nw = 6\nv = 1", "x = 0\nw = 0\nv = 1");
    let (code, rows, said) = events(&ground, &["--until", "-5", "--backward"]);
    assert_eq!((code, rows[1][2].as_str()), (Some(0), "leaves-domain"), "{said}");
    assert_eq!(rows[1][4..6], ["0", "0"]);
}
