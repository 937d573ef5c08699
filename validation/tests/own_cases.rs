//! What `validate` and `events` write of a user's own cases and systems.

use crate::support::{run, stdout, text};
use std::path::Path;

/// A body between two walls: none of the repository's systems, and no name of the oscillator's.
const SHUTTLE: &str = "schema = 1
name = \"shuttle\"
states = [\"place\", \"speed\"]
[[mode]]
name = \"free\"
equations = [\"place' = speed\", \"speed' = 0\"]
[[mode.until]]
name = \"right\"
guard = \"place > 1\"
reset = [\"speed = -speed\"]
[[mode.until]]
name = \"left\"
guard = \"place < -1\"
reset = [\"speed = -speed\"]
[start]
mode = \"free\"
place = 0
speed = 1
";
const THERE_AND_BACK: &str = "[case]
name = \"there-and-back\"
system = \"shuttle\"
why = \"Each wall is met twice.\"
[horizon]
until = 8.0
";

fn written() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = folder.path().join("cases");
    std::fs::create_dir(&cases).expect("made");
    std::fs::write(cases.join("shuttle.system.toml"), SHUTTLE).expect("written");
    std::fs::write(cases.join("there-and-back.toml"), THERE_AND_BACK).expect("written");
    folder
}

fn path(folder: &Path, name: &str) -> String {
    folder.join(name).to_str().expect("UTF-8").to_owned()
}

#[test]
fn the_report_of_own_cases_speaks_of_them() {
    let folder = written();
    let (cases, out) = (path(folder.path(), "cases"), path(folder.path(), "out"));
    let engines = "^(exact|ode_solvers-dopri5)$";
    let output = run(&["validate", "--cases", &cases, "-e", engines, "--out", &out]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let html = std::fs::read_to_string(folder.path().join("out/report.html")).expect("written");
    // The scripts serve every report; what they are given, and the page itself, are of this one.
    let (page, rest) = html.split_once("<script type=").expect("data");
    let (data, _) = rest.split_once("</script>").expect("an end");
    for part in [
        "Integrators on cases of your own, of the system shuttle,",
        "2 engines on 1 case.",
        "there are no tables of these cases",
        "run made again in 106 bits",
        "|difference| of a state (place, speed) over its scale",
        "a guard is crossed in its direction",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert!(data.contains("largest error of place, speed"), "{data}");
    for part in ["|dp|", "impact oscillator", "25 proved digits, made once", "the slider", "Fig. 6"]
    {
        assert!(!page.contains(part) && !data.contains(part), "{part}");
    }
    for section in ["grazing", "error-growth", "restarts", "attractors", "power"] {
        assert!(!page.contains(&format!("\"{section}\"")), "{section}");
        assert!(!page.contains(&format!("#{section}\"")), "{section}");
    }
}

/// A ball that is dropped from a million and a half.
const HIGH: &str = "schema = 1
name = \"high\"
states = [\"height\", \"speed\"]
[[mode]]
name = \"air\"
equations = [\"height' = speed\", \"speed' = -2000000\"]
[[mode.until]]
name = \"ground\"
guard = \"height < 0\"
reset = [\"speed = -speed\"]
[start]
mode = \"air\"
height = 1500000
speed = 0
";

#[test]
fn labels_of_large_states_share_a_power_of_ten() {
    let folder = tempfile::tempdir().expect("a folder");
    let [file, picture] = ["high.system.toml", "high.svg"].map(|it| folder.path().join(it));
    std::fs::write(&file, HIGH).expect("written");
    let [file, picture] = [&file, &picture].map(|it| it.to_str().expect("UTF-8"));
    stdout(&["events", file, "--until", "4", "--output", picture]);
    let svg = std::fs::read_to_string(picture).expect("written");
    // Each state names its power beside its own panel and in the plane of both.
    for (name, count) in [("height, in 10\u{2076}", 2), ("speed, in 10\u{2076}", 2), ("time", 1)] {
        assert_eq!(svg.lines().filter(|line| *line == name).count(), count, "{name}");
    }
    let longest = svg.lines().filter(|it| it.parse::<f64>().is_ok()).map(str::len).max();
    assert!(longest.is_some_and(|it| it <= 4), "{longest:?}");
}
