//! `check` and `new` as their users rely on them.

use crate::support::{percuss, refused, stdout, text};
use std::path::Path;

#[test]
fn equations_are_printed_as_written_and_with_their_numbers() {
    let checked = stdout(&["check", "plastic-ball-on-table", "--set", "A=0.5"]);
    for line in [
        "  states      x, v\n",
        "omega = 1, phi = 0\n",
        "  parameter   A = 0.5\n",
        "mode flight\n  x' = v\n  v' = -g\n     = -1\n",
        "  until impact: A*cos > x\n                -x + 1/2 cos > 0\n",
        "    x = A*cos\n      = 1/2 cos\n",
        "    to flight where thrust > 0\n",
        "                    1/2 cos - 1 > 0\n",
        "    to stuck\n",
        "start in stuck at t = 2\n  x = 1/2 cos\n  v = -1/2 sin\n",
    ] {
        assert!(checked.contains(line), "{line:?} is not in {checked}");
    }
}

/// The zeros after an event are those of that event alone: a ball that bounced is on the floor, and
/// its speed is not zero by the model.
#[test]
fn zeros_are_named() {
    let checked = stdout(&["check", "bouncing-ball"]);
    let line = "    zero after it by the model: x, guard of impact in flight\n";
    assert!(checked.contains(line), "{checked}");
    let line = "  zero there by the model: x, guard of impact in flight\n";
    assert!(checked.contains(line), "{checked}");
    let thrown = stdout(&["check", "bouncing-ball", "--at", "x=1"]);
    assert!(!thrown.contains("zero there"), "{thrown}");
}

#[test]
fn every_system_inside_the_program_is_understood() {
    for (name, _) in percuss_validation::systems::SYSTEMS {
        let checked = stdout(&["check", name]);
        assert!(checked.starts_with(&format!("{name}\n")), "{checked}");
        assert!(checked.contains("\nstart in "), "{checked}");
    }
}

#[test]
fn a_file_that_is_no_system_is_refused_with_its_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("odd.system.toml");
    let odd = "schema = 1\nname = \"odd\"\nstates = [\"x\"]\n[[mode]]\nname = \"on\"\n\
               equations = [\"x' = y\"]\n";
    std::fs::write(&path, odd).expect("written");
    let file = path.display().to_string();
    refused(&["check", &file], &["odd.system.toml:6: y is not known: accepted are x"]);
    // One without a start is a system.
    std::fs::write(&path, odd.replace('y', "-x")).expect("written");
    assert!(stdout(&["check", &file]).contains("no start: --start FILE.toml"));
    refused(&["simulate", &file, "--until", "1"], &["[start]", "--start FILE.toml"]);
    let started = ["simulate", &file, "--until", "1", "--mode", "on", "--at", "x=1"];
    assert!(stdout(&started).starts_with("n,time,event,mode,x\n0,0,,on,1\n"));
}

fn in_folder(folder: &Path, arguments: &[&str]) -> std::process::Output {
    percuss(arguments).current_dir(folder).output().expect("the binary runs")
}

#[test]
fn a_new_file_runs_and_is_not_replaced() {
    let folder = tempfile::tempdir().expect("a folder");
    let made = in_folder(folder.path(), &["new", "hammer-2"]);
    assert!(made.status.success() && made.stdout.is_empty());
    let said = text(&made.stderr);
    assert!(said.contains("hammer-2.system.toml is written"), "{said}");
    let path = folder.path().join("hammer-2.system.toml");
    let file = path.display().to_string();
    let written = std::fs::read_to_string(&path).expect("read");
    assert!(written.contains("name = \"hammer-2\"\n") && !written.contains("my-rig"), "{written}");
    assert!(stdout(&["check", &file]).starts_with("hammer-2\n"));
    let simulated = stdout(&["simulate", &file, "--transient", "50", "--events", "20"]);
    for event in ["strike", "separate", "turn"] {
        assert!(simulated.contains(event), "{event} is not in {simulated}");
    }
    assert!(stdout(&["events", &file, "--events", "10"]).contains("strike"));
    std::fs::write(&path, "mine").expect("written");
    let again = in_folder(folder.path(), &["new", "hammer-2"]);
    assert_eq!(again.status.code(), Some(2));
    assert!(text(&again.stderr).contains("hammer-2.system.toml is there already"));
    assert_eq!(std::fs::read_to_string(&path).expect("read"), "mine");
}
