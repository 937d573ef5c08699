//! Pictures and data of one run: several outputs, what is shown, and sizes on paper.

use crate::simulate_system::array;
use crate::support::{number, rows, run, stdout, text};
use std::fs;
use std::path::Path;

/// Pixels across and down, and pixels in a metre where the file says how many.
fn png(path: &Path) -> (u32, u32, Option<u32>) {
    let file = std::io::BufReader::new(fs::File::open(path).expect("a picture"));
    let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    reader.next_frame(&mut pixels).expect("whole");
    let info = reader.info();
    (info.width, info.height, info.pixel_dims.map(|it| it.xppu))
}

const RIG: [&str; 2] = ["rigid-impact-oscillator", "--transient"];

const GRID: [&str; 6] = ["--grid", "2x2", "--window", "-0.1,0.1,-0.1,0.1", "--transient", "100"];

/// Each verb with so little work that it is quick, and the extensions that it has.
fn verbs() -> Vec<(Vec<&'static str>, Vec<&'static str>)> {
    let rig = |verb, more: &[&'static str]| [&[verb][..], &RIG, more].concat();
    let values = ["--from", "0.2", "--to", "0.21", "--steps", "2"];
    vec![
        (vec!["simulate", "--periods", "3"], vec!["csv", "json", "png", "svg"]),
        (
            rig("simulate", &["9", "--returns", "5"]),
            vec!["csv", "json", "npy", "npz", "png", "svg"],
        ),
        (vec!["poincare", "--transient", "9", "--periods", "5"], vec!["csv", "npy", "png", "svg"]),
        (rig("poincare", &["9", "--returns", "5"]), vec!["csv", "npy", "npz", "png", "svg"]),
        (
            [&rig("bifurcation", &["9", "--returns", "5", "--parameter", "d"])[..], &values]
                .concat(),
            vec!["csv", "png", "svg"],
        ),
        (
            rig(
                "continue",
                &["300", "--parameter", "A", "--from", "0.5", "--to", "0.6", "--period", "1"],
            ),
            vec!["json", "png", "svg"],
        ),
        (vec!["events", "bouncing-ball", "--until", "2.5"], vec!["csv", "json", "png", "svg"]),
        (vec!["orbit", "--period", "1", "--all"], vec!["json", "table"]),
        (rig("orbit", &["300", "--period", "1", "--set", "A=0.5"]), vec!["json", "table"]),
        ([&["attractors"], &GRID[..]].concat(), vec!["json", "table"]),
        ([&["attractors", "rigid-impact-oscillator"], &GRID[..]].concat(), vec!["json", "txt"]),
    ]
}

/// Data and pictures of one run are those that runs of their own make.
#[test]
fn several_outputs_are_what_each_is_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    for (words, extensions) in verbs() {
        let path = |name: &str, extension: &str| {
            folder.path().join(format!("{name}.{extension}")).display().to_string()
        };
        let flags: Vec<String> = extensions
            .iter()
            .flat_map(|extension| ["--output".to_owned(), path("all", extension)])
            .collect();
        let flags: Vec<&str> = flags.iter().map(String::as_str).collect();
        stdout(&[&words[..], &flags].concat());
        for extension in extensions {
            stdout(&[&words[..], &["--output", &path("one", extension)]].concat());
            let [all, one] = ["all", "one"].map(|it| fs::read(path(it, extension)).expect("read"));
            assert!(all == one && !one.is_empty(), "{words:?} {extension}");
        }
    }
}

/// With stdout as one of them, the table is seen while the picture is written.
#[test]
fn stdout_may_be_one_of_several() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("p.png").display().to_string();
    let words = ["poincare", "rigid-impact-oscillator", "--transient", "9", "--returns", "4"];
    let table = stdout(&[&words[..], &["--output", "-", "--output", &file]].concat());
    assert_eq!(table, stdout(&words));
    assert!(fs::metadata(file).expect("drawn").len() > 0);
}

/// Samples are rows of the table alone: the picture beside it is that of the events.
#[test]
fn a_picture_beside_samples_is_that_of_the_events() {
    let folder = tempfile::tempdir().expect("a folder");
    let [both, alone] = ["both.svg", "alone.svg"].map(|it| folder.path().join(it));
    let words = ["events", "relay-feedback", "--until", "9"];
    let flags = |it: &Path| ["--output".to_owned(), it.display().to_string()];
    let [beside, own] = [&both, &alone].map(|it| flags(it));
    let sampled = [&words[..], &["--samples", "4"]].concat();
    let more = ["--output", "-", &beside[0], &beside[1]];
    assert_eq!(stdout(&[&sampled[..], &more].concat()), stdout(&sampled));
    stdout(&[&words[..], &[&own[0], &own[1]]].concat());
    assert_eq!(fs::read(both).expect("drawn"), fs::read(alone).expect("drawn"));
}

/// An output that fails leaves no other behind.
#[test]
fn outputs_are_there_together_or_not_at_all() {
    let folder = tempfile::tempdir().expect("a folder");
    let [table, small] = ["t.csv", "s.png"].map(|it| folder.path().join(it).display().to_string());
    let words = ["poincare", "rigid-impact-oscillator", "--transient", "9", "--returns", "4"];
    let flags = ["--output", &table, "--output", &small, "--size", "20x20"];
    let output = run(&[&words[..], &flags].concat());
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0);
}

/// 80 mm by 60 mm at 300 dots an inch are 945 x 709 pixels, which the file states as 11811 a metre.
#[test]
fn sizes_are_those_on_paper() {
    let folder = tempfile::tempdir().expect("a folder");
    let [drawn, vector] = ["d.png", "d.svg"].map(|it| folder.path().join(it));
    let words = ["poincare", "--transient", "9", "--periods", "50", "--size", "80x60"];
    let [png_path, svg_path] = [&drawn, &vector].map(|it| it.display().to_string());
    stdout(&[&words[..], &["--output", &png_path, "--output", &svg_path]].concat());
    assert_eq!(png(&drawn), (945, 709, Some(11811)));
    let svg = fs::read_to_string(&vector).expect("drawn");
    assert!(svg.contains("width=\"80mm\" height=\"60mm\""), "{}", &svg[..200]);
    stdout(&[&words[..], &["--output", &png_path, "--dpi", "600"]].concat());
    assert_eq!(png(&drawn), (1890, 1417, Some(23622)));
    // Without a size a picture has its own, of 1200 pixels at 160 dots an inch.
    let own = &words[..5];
    stdout(&[own, &["--output", &png_path]].concat());
    let (width, height, stated) = png(&drawn);
    assert_eq!((width, stated), (1200, None));
    stdout(&[own, &["--output", &png_path, "--dpi", "320"]].concat());
    let (twice, high, _) = png(&drawn);
    assert_eq!((twice, high), (2 * width, 2 * height));
}

/// The names of the axes are the expressions, and what lies out of the range is not drawn.
#[test]
fn axes_are_named_by_what_they_show() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("s.svg");
    let file = path.display().to_string();
    let words = ["poincare", "rigid-impact-oscillator", "--transient", "300", "--returns", "60"];
    let drawn = |more: &[&str]| {
        stdout(&[&words[..], &["--output", &file], more].concat());
        fs::read_to_string(&path).expect("drawn")
    };
    let svg = drawn(&["--show", "d - x,2*v"]);
    assert!(svg.contains("\nd - x\n") && svg.contains("\n2*v\n"), "{svg}");
    let alone = drawn(&["--show", "x"]);
    assert!(alone.contains("\nreturn\n") && alone.contains("\nx\n"), "{alone}");
    let squares = |svg: &str| svg.matches("v320h-320z").count();
    assert!(squares(&svg) > 40, "{}", squares(&svg));
    assert_eq!(squares(&drawn(&["--range", "100,101"])), 0);
    assert!(squares(&drawn(&["--range", "-9,9,-9,9"])) > 0);
}

/// The arrays of a section are the columns of its table, read as an archive of NumPy's.
#[test]
fn arrays_of_a_section_are_its_table() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("s.npz");
    let file = path.display().to_string();
    let words = ["poincare", "rigid-impact-oscillator", "--transient", "9", "--returns", "7"];
    let table = rows(&stdout(&[&words[..], &["--output", "-", "--output", &file]].concat()));
    let numbers = |name: &str| -> Vec<f64> {
        let bytes = array(&path, name);
        npyz::NpyFile::new(&bytes[..]).expect("an array").into_vec().expect("numbers")
    };
    let (time, state) = (numbers("time"), numbers("state"));
    assert_eq!((time.len(), state.len()), (7, 14));
    for (n, row) in table.iter().enumerate() {
        let cells = [1, 3, 4].map(|it| number(&row[it]));
        assert_eq!(cells, [time[n], state[2 * n], state[2 * n + 1]]);
    }
}
