//! Every flag of every verb with odd values: exit 2, and one line that names the flag, the value as
//! typed and what is accepted. Flags that would have no effect are refused too.

use crate::support::{refused, run, text};
use clap::Command;
use percuss_validation::cli::command;

/// Each verb with flags that make it complete; a flag under test takes the place of its own pair.
const VERBS: &[(&str, &[(&str, &str)])] = &[
    ("simulate", &[("--periods", "1")]),
    ("poincare", &[("--transient", "1"), ("--periods", "1")]),
    ("lyapunov", &[("--transient", "1"), ("--periods", "1")]),
    (
        "bifurcation",
        &[
            ("--parameter", "b"),
            ("--from", "0.1"),
            ("--to", "0.2"),
            ("--steps", "2"),
            ("--transient", "1"),
            ("--periods", "1"),
        ],
    ),
    ("attractors", &[("--grid", "1x1"), ("--window", "-1,1,-1,1"), ("--transient", "1")]),
    (
        "basins",
        &[
            ("--grid", "1x1"),
            ("--window", "-1,1,-1,1"),
            ("--transient", "1"),
            ("--output", "a.npz"),
        ],
    ),
    ("orbit", &[("--period", "1")]),
    ("continue", &[("--parameter", "b"), ("--from", "0.1"), ("--to", "0.2"), ("--period", "1")]),
    ("validate", &[]),
    ("export", &[("--out", "/proc/nowhere")]),
    ("score", &[("--name", "mine"), ("--tolerance", "1e-6"), ("--answers", "/no/such")]),
    ("engines", &[]),
    ("cases", &[]),
    ("systems", &[]),
    ("events", &[("SYSTEM", "bouncing-ball"), ("--until", "1")]),
    ("gradient", &[("SYSTEM", "bouncing-ball"), ("--until", "1"), ("--wrt", "g")]),
    ("check", &[("SYSTEM", "bouncing-ball")]),
    ("new", &[("NAME", "mine")]),
    ("sweep run", &[("--plan", "no.toml"), ("--out", "/proc/nowhere")]),
    ("sweep status", &[("--plan", "no.toml"), ("--out", "/proc/nowhere")]),
    ("sweep merge", &[("--plan", "no.toml"), ("--out", "/proc/nowhere"), ("--output", "a.npz")]),
    ("reproduce", &[("--out", "/proc/nowhere")]),
    ("bench", &[]),
    ("bench record", &[]),
    ("bench history", &[]),
    ("bench compare", &[("OLD", "0.0.1"), ("NEW", "0.0.2")]),
    ("completions", &[("SHELL", "bash")]),
    ("man", &[("--out", "/proc/nowhere")]),
];

const INTEGERS: &[&str] = &["-5", "1e300", "1.5", "nan", "x", "", "18446744073709551616"];
const NUMBERS: &[&str] = &["nan", "inf", "-inf", "1e400", "-1e300", "1,5", "x", ""];
const WORDS: &[&str] = &["", "x", "-5", "1e300"];
const MISSING_FOLDER: &[&str] = &["/no/such/folder/file.json"];

/// The steps of a sweep.
const SWEEP: &[&str] = &["sweep run", "sweep status", "sweep merge"];

/// All orbits of a system.
const RELAY_ORBITS: [&str; 7] =
    ["orbit", "relay-feedback", "--section", "switch-up", "--period", "1", "--all"];

/// A branch of a system.
const BRANCH: [&str; 10] = [
    "continue",
    "buck-converter",
    "--parameter",
    "Vin",
    "--from",
    "24",
    "--to",
    "25",
    "--period",
    "1",
];

/// The verbs of the dynamics that take a SYSTEM.
const SYSTEM_VERBS: &[&str] =
    &["poincare", "lyapunov", "bifurcation", "attractors", "basins", "orbit", "continue"];

/// The verbs that a row is for (all where empty), a flag, values that are refused, and what the
/// line says is accepted.
type Row = (&'static [&'static str], &'static str, &'static [&'static str], &'static str);

const ROWS: &[Row] = &[
    (&[], "--threads", INTEGERS, "1 to 65535"),
    (&[], "--threads", &["0", "65536"], "1 to 65535"),
    (&[], "--color", WORDS, "auto, always, never"),
    (&[], "--a", NUMBERS, "0 <= a <= 1e9"),
    (&[], "--a", &["-0.5"], "0 <= a <= 1e9"),
    (&[], "--b", NUMBERS, "-1e9 <= b <= 1e9"),
    (&[], "--xi", NUMBERS, "1e-8 <= xi <= 1e4"),
    (&[], "--xi", &["0", "00.0"], "1e-8 <= xi <= 1e4"),
    (&[], "--omega", NUMBERS, "1e-6 <= omega <= 1e6"),
    (&[], "--g", NUMBERS, "0 <= g <= 1e9"),
    (&[], "--phi", NUMBERS, "-1e15 <= phi <= 1e15"),
    (&[], "--tau", NUMBERS, "-1e15 <= tau <= 1e15"),
    (&[], "--p", NUMBERS, "-1e9 to 1e9"),
    (&[], "--y", NUMBERS, "-1e9 to 1e9"),
    (&[], "--q", NUMBERS, "-1e9 to 1e9"),
    (&[], "--v", NUMBERS, "-1e9 to 1e9"),
    (&[], "--cycle", ODD_INTEGERS, "-2^53"),
    (&[], "--cycle", &["9007199254740993", "-9007199254740993"], "-2^53 <= cycle <= 2^53"),
    (&[], "--phase", WORDS, "no-contact, contact, progression"),
    (&[], "--problem", &["/no/such.toml", "/"], "accepted is a readable file"),
    (&["simulate"], "--periods", INTEGERS, "0 to 1000000000"),
    (&["simulate"], "--events", INTEGERS, "an integer, 0 to"),
    (&["simulate", "events", "gradient"], "--until", NUMBERS, "at or after the start"),
    (&["events", "gradient"], "--events", INTEGERS, "an integer, 1 to"),
    (&["events"], "--samples", INTEGERS, "1 to 4294967295"),
    (&["events"], "--max-bits", INTEGERS, "an integer, 106 to 3392"),
    (&["events"], "--max-events", INTEGERS, "an integer, 1 to 1000000000"),
    (&["events"], "--max-events", &["0", "2e9"], "an integer, 1 to 1000000000"),
    (&["events", "gradient"], "--digits", WORDS, "17, 25"),
    (&["events"], "--states", WORDS, "png and svg"),
    (&["gradient"], "--wrt", &["", "y", "g,", "start.y", "g,g"], "accepted are"),
    (&[], "--set", &["", "x", "g=", "g=nan"], "NAME=VALUE with a finite number"),
    (
        &["events", "gradient", "check"],
        "--start",
        &["/no/such.toml", "/"],
        "accepted is a readable file",
    ),
    (&[], "--at", &["", "x", "x=", "=1"], "STATE=VALUE"),
    (&["events", "gradient", "check"], "--at", &["y=1", "mode=flight"], "accepted are t, x, v"),
    (&["events", "gradient", "check"], "--at", &["x=nan", "x=w", "x=1/0"], "x"),
    (&["events", "gradient", "check"], "--mode", &["", "fall"], "accepted is one of flight"),
    (&["simulate"], "--start", &["/no/such.toml"], "without SYSTEM"),
    (&["simulate"], "--mode", &["flight"], "without SYSTEM"),
    (&["simulate"], "--returns", INTEGERS, "0 to 1000000000"),
    (&["simulate"], "--transient", INTEGERS, "0 to 1000000000"),
    (&["new"], "NAME", &["", "Mine", "a b", "a--b", "../a"], "joined by hyphens"),
    (SYSTEM_VERBS, "--start", &["/no/such.toml"], "without SYSTEM"),
    (SYSTEM_VERBS, "--mode", &["flight"], "without SYSTEM"),
    (&["simulate"], "--every", INTEGERS, "1 to 1000000000"),
    (&["simulate"], "--every", &["2"], "without SYSTEM"),
    (&["simulate"], "--max-time", NUMBERS, "accepted is a positive number"),
    (&["simulate"], "--max-time", &["5"], "without SYSTEM"),
    (&["simulate"], "--section", &["", "1,5", "-inf", "a@", "strobe:x"], "-1e15 to 1e15"),
    (&["simulate"], "--section", &["0.5", "impact"], "without SYSTEM"),
    (SYSTEM_VERBS, "--every", INTEGERS, "1 to 1000000000"),
    (SYSTEM_VERBS, "--every", &["2"], "without SYSTEM"),
    (SYSTEM_VERBS, "--max-time", NUMBERS, "accepted is a positive number"),
    (SYSTEM_VERBS, "--max-time", &["0", "-1"], "accepted is a positive number"),
    (SYSTEM_VERBS, "--max-time", &["5"], "without SYSTEM"),
    (&["poincare", "lyapunov", "bifurcation"], "--returns", INTEGERS, "1 to 1000000000"),
    (&["poincare", "lyapunov", "bifurcation"], "--returns", &["3"], "without SYSTEM"),
    (
        &["lyapunov", "bifurcation", "attractors", "basins", "orbit", "continue"],
        "--section",
        &["", "1,5", "-inf", "a@", "strobe:x"],
        "-1e15 to 1e15",
    ),
    (
        &["lyapunov", "bifurcation", "attractors", "basins", "orbit", "continue"],
        "--section",
        &["0.5", "impact"],
        "without SYSTEM",
    ),
    (&["attractors", "basins", "orbit"], "--axes", &["", "x,v"], "without SYSTEM"),
    (&["orbit"], "--grid", &["", "x", "-5x5", "5", "1e3x1e3"], "NXxNY"),
    (&["orbit"], "--grid", &["5x5"], "without SYSTEM"),
    (&["orbit"], "--window", &["", "1,2", "1,0,0,1", "nan,1,0,1"], "pmin,pmax"),
    (&["orbit"], "--window", &["0,1,0,1"], "without SYSTEM"),
    (&["orbit", "continue"], "--transient", INTEGERS, "0 to 1000000000"),
    (&["orbit", "continue"], "--transient", &["3"], "without SYSTEM"),
    (&["continue"], "--second", &["R"], "without SYSTEM"),
    (&["continue"], "--second-range", &["", "1", "1,0", "1,1", "nan,1", "0,inf"], "LO,HI"),
    (&["continue"], "--second-range", &["0,1"], "without SYSTEM"),
    (&["simulate"], "--samples", INTEGERS, "1 to 4294967295"),
    (&["simulate"], "--max-periods", INTEGERS, "1 to 1000000000"),
    (&["poincare", "lyapunov"], "--periods", INTEGERS, "1 to 1000000000"),
    (&["bifurcation"], "--periods", INTEGERS, "1 to 1000000000"),
    (&["poincare", "lyapunov", "bifurcation"], "--transient", INTEGERS, "0 to 1000000000"),
    (&["attractors", "basins"], "--transient", INTEGERS, "1 to 10000000"),
    (&["attractors", "basins"], "--grid", &["", "x", "-5x5", "5", "1e3x1e3"], "NXxNY"),
    (&["attractors", "basins"], "--window", &["", "1,2", "1,0,0,1", "nan,1,0,1"], "pmin,pmax"),
    (&[], "--size", &["", "80", "80x", "nanx60", "80x5000", "-80x60"], "WxH in millimetres"),
    (&["reproduce"], "--size", WORDS, "default, full"),
    (&[], "--dpi", NUMBERS, "accepted is a number, 30 to 2400"),
    (&[], "--dpi", &["29", "2401", "-300"], "accepted is a number, 30 to 2400"),
    (&[], "--range", &["", "1", "1,0", "0,1,2", "nan,1", "0,inf"], "LO,HI"),
    (&[], "--show", &["x,v"], "png and svg"),
    (&["poincare"], "--section", NUMBERS, "-1e15 to 1e15"),
    (&["bifurcation"], "--steps", INTEGERS, "1 to 1000000"),
    (&["bifurcation", "continue"], "--parameter", WORDS, "a, b, xi, omega, g, phi"),
    (&["bifurcation", "continue"], "--from", NUMBERS, "accepted"),
    (&["bifurcation", "continue"], "--to", NUMBERS, "accepted"),
    (&["orbit", "continue"], "--period", INTEGERS, "1 to 10000"),
    (&["attractors", "basins"], "--max-period", INTEGERS, "1 to 10000"),
    (&[], "--format", WORDS, "possible values"),
    (&["validate"], "--suite", WORDS, "quick, full"),
    (&["validate"], "--tolerance", NUMBERS, "accepted is a tolerance"),
    (&["reproduce"], "--only", WORDS, "accepted are"),
    (&["bench", "bench record"], "--rounds", INTEGERS, "1 to 1000"),
    (&["bench compare"], "--slowdown", NUMBERS, "0 to 1"),
    (&["score"], "--name", &["", "Mine", "a b", "exact-mine"], "does not begin with exact"),
    (&["score"], "--library", &["", "\n"], "1 to 80 characters"),
    (&["score"], "--version", &["", "\n"], "1 to 80 characters"),
    (&["score"], "--language", &["", "\n"], "1 to 80 characters"),
    (&["score"], "--tolerance", NUMBERS, "1e-16 to 0.1"),
    (&["validate"], "--tolerance", NUMBERS, "accepted"),
    (&["score"], "--tolerance", &["0", "-1e-6", "0.2"], "1e-16 to 0.1"),
    (&["score"], "--order", &["", "0", "65", "5.0"], "1 to 64"),
    (&["score"], "--stepping", &["", "Adaptive"], "adaptive, per-step, fixed"),
    (&["score"], "--method", &["", "bdf"], "explicit, implicit, multistep, taylor"),
    (&["score"], "--answers", &["/no/such", "/proc/version"], "accepted is a folder"),
    (&["validate", "bench"], "--engine", &["(", "qqqqq"], "--engine"),
    (&["validate", "bench", "export", "score"], "--case", &["(", "qqqqq"], "--case"),
    (&["bench compare"], "--bench", &["("], "regular expression"),
    (&["bench record", "bench history", "bench compare"], "--history", &["/"], "--history"),
    (
        &["validate", "cases", "export", "score"],
        "--cases",
        &["/no/such"],
        "accepted is a folder of cases",
    ),
    (
        &["validate", "bench", "engines"],
        "--programs",
        &["/no/such.toml", "/"],
        "accepted is a readable file",
    ),
    (&["validate", "score"], "--reference", &["/no/such"], "accepted is"),
    (&["validate", "score"], "--baseline", &["/no/such.json"], "accepted is"),
    (
        &["validate", "bench", "reproduce", "man", "export", "score"],
        "--out",
        &["/proc/nowhere"],
        "accepted is",
    ),
    (&["basins"], "--output", &["/no/such/folder/file.npz"], "a folder that exists"),
    (
        &["bench history", "poincare"],
        "--output",
        &["/no/such/folder/file.png"],
        "a folder that exists",
    ),
    (&["bifurcation"], "--output", &["/no/such/folder/file.csv"], "a folder that exists"),
    (SWEEP, "--plan", &["/no/such.toml", "/"], "accepted is a TOML file"),
    (SWEEP, "--out", &["/proc/version"], "accepted is a folder"),
    (&["sweep run"], "--shard", &["", "x", "3", "4/4", "-1/4", "1/0", "0.5/4"], "accepted is I/N"),
    (&["sweep merge"], "--output", &["a.csv", "-"], "ends in .npz"),
    (&["sweep merge"], "--output", &["/no/such/folder/file.npz"], "a folder that exists"),
    (&[], "--output", MISSING_FOLDER, "a folder that exists"),
    (&["completions"], "SHELL", &["", "x", "1e300"], "bash"),
];

/// Odd values of a cycle's number, which may be negative.
const ODD_INTEGERS: &[&str] = &["1e300", "1.5", "nan", "x", "", "18446744073709551616"];

/// The rows of a flag of a verb: its own, or else those of all verbs.
fn rows(verb: &str, flag: &str) -> Vec<&'static Row> {
    let of = |own: bool| {
        let fits = move |row: &&Row| {
            row.1 == flag && if own { row.0.contains(&verb) } else { row.0.is_empty() }
        };
        ROWS.iter().filter(fits).collect::<Vec<_>>()
    };
    let own = of(true);
    if own.is_empty() { of(false) } else { own }
}

/// A run of a verb with one flag set to a value, and what else it needs.
fn arguments(verb: &str, flag: &str, value: &str) -> Vec<String> {
    let known = VERBS.iter().find(|it| it.0 == verb);
    let Some((_, usual)) = known else { panic!("{verb} is not in the table") };
    let mut words: Vec<String> = verb.split(' ').map(str::to_owned).collect();
    let one_of = |name: &str| ["--periods", "--events", "--until", "--returns"].contains(&name);
    for (name, usual) in usual.iter() {
        let has_lengths = ["simulate", "poincare", "lyapunov", "bifurcation"].contains(&verb);
        let replaced = has_lengths && one_of(name) && one_of(flag);
        if *name != flag && !replaced && !name.starts_with("--") {
            words.push((*usual).to_owned());
        } else if *name != flag && !replaced {
            words.push(format!("{name}={usual}"));
        }
    }
    words.push(if flag.starts_with("--") { format!("{flag}={value}") } else { value.to_owned() });
    words
}

/// The verbs with their flags that take a value, those of all verbs included.
fn flags(command: &Command, verb: &str, found: &mut Vec<(String, String)>) {
    for inner in command.get_subcommands().filter(|it| it.get_name() != "help") {
        let name = format!("{verb} {}", inner.get_name()).trim().to_owned();
        flags(inner, &name, found);
        if VERBS.iter().any(|it| it.0 == name) || !inner.has_subcommands() {
            let takes = inner.get_arguments().filter(|it| it.get_action().takes_values());
            let flag = |it: &clap::Arg| it.get_long().map(|long| format!("--{long}"));
            found.extend(takes.filter_map(|it| flag(it).map(|flag| (name.clone(), flag))));
        }
    }
}

#[test]
fn odd_values_of_every_flag() {
    let mut command = command();
    command.build();
    let mut found = Vec::new();
    flags(&command, "", &mut found);
    // It answers a protocol of its own and takes no flags but those of all verbs.
    found.retain(|(verb, _)| verb != "bench worker");
    found.push(("completions".to_owned(), "SHELL".to_owned()));
    found.push(("new".to_owned(), "NAME".to_owned()));
    assert!(found.len() > 150, "{}", found.len());
    for (verb, flag) in &found {
        let rows = rows(verb, flag);
        assert!(!rows.is_empty(), "{verb} {flag} is not in the table");
        for (_, _, values, accepted) in rows {
            for value in *values {
                let words = arguments(verb, flag, value);
                let words: Vec<&str> = words.iter().map(String::as_str).collect();
                refused(&words, &[flag, value, accepted]);
            }
        }
    }
}

/// A value that begins with a minus is the flag's, whether an equals sign or a space comes before
/// it.
#[test]
fn negative_values_belong_to_their_flags() {
    for words in [
        &["simulate", "--periods", "-5"][..],
        &["simulate", "--events", "-5"],
        &["simulate", "--periods", "1", "--samples", "-5"],
        &["poincare", "--transient", "-5", "--periods", "1"],
        &["lyapunov", "--periods", "-5", "--transient", "1"],
        &["attractors", "--grid", "1x1", "--window", "0,1,0,1", "--transient", "-5"],
        &["bench", "--rounds", "-5"],
        &["engines", "--threads", "-5"],
    ] {
        let flag = words[words.iter().position(|it| *it == "-5").expect("there") - 1];
        refused(words, &[flag, "'-5'", "accepted is an integer"]);
    }
}

/// A `score` that is refused by its flags alone.
const SCORE_COMMAND: [&str; 7] =
    ["score", "--name", "mine", "--tolerance", "1e-6", "--answers", "/no/such"];

/// A section of a system that is not forced, to which the flag `--section` is missing.
const RELAY: [&str; 6] = ["poincare", "relay-feedback", "--transient", "1", "--returns", "2"];

/// A diagram of a system, to which the number of its points is missing.
const RIG: [&str; 12] = [
    "bifurcation",
    "rigid-impact-oscillator",
    "--parameter",
    "d",
    "--from",
    "0.1",
    "--to",
    "0.2",
    "--steps",
    "2",
    "--transient",
    "1",
];

/// A section of a system with a count of forcing periods.
const SECTION: [&str; 6] = ["poincare", "relay-feedback", "--transient", "1", "--periods", "3"];

#[test]
fn flags_without_effect() {
    let grid = ["--grid", "1x1", "--window", "-1,1,-1,1", "--transient", "1"];
    let interval = ["--parameter", "b", "--from", "0.1", "--to", "0.2", "--steps", "2"];
    let diagram =
        [&["bifurcation"], &interval[..], &["--transient", "1", "--periods", "1"]].concat();
    let basins = [&["basins"], &grid[..]].concat();
    let binary = assert_cmd::cargo::cargo_bin("percuss").display().to_string();
    let rows: Vec<(Vec<&str>, &[&str])> = vec![
        (
            vec!["simulate", "--periods", "1", "--max-periods", "7"],
            &["--max-periods 7", "--events"],
        ),
        (vec!["simulate", "--until", "1", "--max-periods", "7"], &["--max-periods 7", "--events"]),
        (
            vec!["simulate", "--periods", "1", "--samples", "4", "--format", "png"],
            &["--samples 4", "picture"],
        ),
        (
            vec!["simulate", "--periods", "1", "--samples", "4", "--format", "svg"],
            &["--samples 4", "picture"],
        ),
        (
            vec!["events", "bouncing-ball", "--until", "1", "--samples", "2", "--format", "png"],
            &["--samples 2", "csv and json"],
        ),
        (
            vec!["events", "bouncing-ball", "--until", "1", "--states", "x"],
            &["--states x", "png and svg"],
        ),
        (
            vec!["events", "bouncing-ball", "--until", "1", "--digits", "25", "--format", "svg"],
            &["--digits 25", "picture"],
        ),
        (vec!["simulate", "--periods", "1", "--set", "e=0.5"], &["--set e=0.5", "without SYSTEM"]),
        (vec!["simulate", "--periods", "1", "--at", "x=1"], &["--at x=1", "without SYSTEM"]),
        (vec!["simulate", "--returns", "1"], &["--returns 1", "--periods"]),
        (vec!["simulate", "--periods", "1", "--transient", "3"], &["--transient 3", "--cycle"]),
        (vec!["simulate", "--periods", "1", "--format", "npz"], &["without SYSTEM", "csv"]),
        (vec!["simulate", "bouncing-ball", "--until", "1", "--a", "3"], &["--a 3", "--set"]),
        (vec!["simulate", "bouncing-ball", "--events", "1", "--p", "-1"], &["--p -1", "--at"]),
        (vec!["simulate", "bouncing-ball", "--periods", "1"], &["--periods 1", "--returns"]),
        (
            vec!["simulate", "bouncing-ball", "--events", "1", "--max-periods", "7"],
            &["--max-periods 7", "--until"],
        ),
        (vec!["simulate", "bouncing-ball", "--returns", "1"], &["--returns 1", "not forced"]),
        (
            vec!["simulate", "bouncing-ball", "--until", "1", "--transient", "1"],
            &["--transient 1", "not forced", "--until"],
        ),
        (
            vec!["simulate", "bouncing-ball", "--until", "1", "--format", "png", "--show", "x - w"],
            &["--show \"x - w\"", "w is not known", "x, v"],
        ),
        (
            vec!["simulate", "bouncing-ball", "--until", "1", "--format", "png", "--show", "x,v,x"],
            &["--show x,v,x", "one or two"],
        ),
        (
            [&RIG[..], &["--returns", "2", "--format", "png", "--show", "x,v"]].concat(),
            &["--show x,v", "one expression"],
        ),
        ([&RIG[..], &["--returns", "2", "--size", "80x60"]].concat(), &["--size 80x60", "png"]),
        (
            [&RIG[..], &["--returns", "2", "--format", "svg", "--dpi", "300"]].concat(),
            &["--dpi 300", "png"],
        ),
        (
            [&RIG[..], &["--returns", "2", "--format", "png", "--size", "20x20"]].concat(),
            &["--size 20x20", "too small", "at least 35 x 29 mm"],
        ),
        (
            vec!["simulate", "--periods", "1", "--format", "png", "--range", "0,1"],
            &["--range 0,1", "with SYSTEM"],
        ),
        (
            vec!["simulate", "--periods", "1", "--format", "png", "--show", "p,y"],
            &["--show p,y", "without SYSTEM"],
        ),
        (
            vec!["poincare", "--transient", "1", "--periods", "1", "--format", "npz"],
            &["npz", "without SYSTEM", "npy"],
        ),
        (
            [&RIG[..], &["--returns", "2", "--output", "a.png", "--output", "./a.png"]].concat(),
            &["--output ./a.png", "given twice"],
        ),
        (
            [&RIG[..], &["--returns", "2", "--output", "-", "--output", "-"]].concat(),
            &["--output -", "given twice"],
        ),
        (
            [&RIG[..], &["--returns", "2", "--output", "a.png", "--output", "a.xls"]].concat(),
            &["--output a.xls", "csv, png, svg"],
        ),
        (
            vec!["simulate", "relay-feedback", "--until", "9", "--section", "switch-up"],
            &["--section switch-up", "--returns"],
        ),
        (
            vec!["simulate", "relay-feedback", "--until", "9", "--every", "2"],
            &["--every 2", "--returns"],
        ),
        (
            vec!["simulate", "relay-feedback", "--returns", "9", "--section", "switch"],
            &["switch is no event", "switch-up"],
        ),
        (
            vec!["simulate", "relay-feedback", "--returns", "9", "--section", "0.5"],
            &["--section 0.5", "strobe:0.5"],
        ),
        (SECTION.to_vec(), &["--periods 3", "--returns"]),
        ([&RELAY[..], &["--section", "0.5"]].concat(), &["--section 0.5", "strobe:0.5"]),
        ([&RELAY[..], &["--section", "strobe"]].concat(), &["section", "no forcing", "switch-up"]),
        ([&RELAY[..], &["--section", "switch"]].concat(), &["switch is no event", "switch-up"]),
        (
            [&RELAY[..], &["--section", "switch-up@up"]].concat(),
            &["switch-up@up", "switch-up@down"],
        ),
        ([&RELAY[..], &["--xi", "1"]].concat(), &["--xi 1", "--set"]),
        (RELAY_ORBITS.to_vec(), &["--all", "SYSTEM"]),
        ([&RELAY_ORBITS[..], &["--grid", "2x2"]].concat(), &["--all", "--window"]),
        (
            [&RELAY_ORBITS[..], &["--transient", "3"]].concat(),
            &["--transient 3 is not accepted with --all"],
        ),
        ([&RELAY_ORBITS[..6], &["--grid", "2x2"]].concat(), &["--grid 2x2", "--all"]),
        ([&BRANCH[..], &["--doubled"]].concat(), &["--doubled", "SYSTEM"]),
        ([&BRANCH[..], &["--set", "Vin=1"]].concat(), &["--set Vin=1", "--parameter Vin"]),
        ([&BRANCH[..], &["--xi", "1"]].concat(), &["--xi 1", "--set"]),
        ([&BRANCH[..], &["--section", "tick"]].concat(), &["tick is no event", "clock"]),
        ([&diagram[..], &["--carry", "--reset"]].concat(), &["--carry", "--reset"]),
        (
            [&["attractors", "relay-feedback"], &grid[..], &["--p", "1"]].concat(),
            &["--p 1", "--at"],
        ),
        ([&["attractors", "relay-feedback"], &grid[..]].concat(), &["--section", "no forcing"]),
        (
            [&["attractors", "rigid-impact-oscillator"], &grid[..], &["--axes", "x"]].concat(),
            &["--axes x", "two of x, v"],
        ),
        (
            [&["attractors", "rigid-impact-oscillator"], &grid[..], &["--axes", "x,x"]].concat(),
            &["--axes x,x", "two of x, v"],
        ),
        ([&RIG[..], &["--periods", "2"]].concat(), &["--periods 2", "--returns"]),
        ([&RIG[..], &["--returns", "2", "--b", "1"]].concat(), &["--b 1", "--set"]),
        ([&RIG[..], &["--returns", "2", "--set", "d=1"]].concat(), &["--set d=1", "--parameter d"]),
        ([&RIG[..], &["--returns", "2", "--section", "hit"]].concat(), &["hit is no event"]),
        (
            [&basins[..], &["--output", "a.npz", "--format", "png"]].concat(),
            &["--format png", "a.npz"],
        ),
        (
            [&basins[..], &["--output", "a", "--format", "png", "--format", "npz"]].concat(),
            &["--format", "one of npz, png, svg"],
        ),
        (
            [&["attractors"], &grid[..], &["--output", "a.json", "--format", "table"]].concat(),
            &["--format table", "a.json"],
        ),
        (vec!["bench", "--long", "-c", "never-stops"], &["--long", "--case"]),
        (
            vec!["bench", "compare", &binary, &binary, "--history", "h.jsonl"],
            &["--history", "two binaries"],
        ),
        (
            vec!["bench", "compare", "0.0.1", "0.0.2", "--slowdown", "0.5"],
            &["--slowdown 0.5", "two binaries"],
        ),
        (
            vec!["reproduce", "--out", "x", "--only", "table-1", "--size", "full"],
            &["--size", "figure-7"],
        ),
        (vec!["bench", "--rounds", "2", "record"], &["record"]),
        (vec!["validate", "--details", "--format", "csv"], &["--details", "table"]),
        (
            [&SCORE_COMMAND[..], &["--rows", "--allow-unanswered", "--format", "json"]].concat(),
            &["--rows", "table"],
        ),
    ];
    for (words, wanted) in rows {
        refused(&words, wanted);
    }
}

/// The start's flags are those of all verbs; a grid of starts takes their place, which is said.
#[test]
fn starts_that_a_grid_replaces() {
    let grid = ["attractors", "--grid", "1x1", "--window", "-1,1,-1,1", "--transient", "1"];
    let output = run(&[&grid[..], &["--p", "0.1", "--v", "3"]].concat());
    let said = text(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert!(said.contains("--p is not used") && said.contains("--v is not used"), "{said}");
    assert_eq!(said.lines().count(), 2, "{said}");
}

/// Wrong types in a problem or a case: the line, the key, the value as typed, and what is accepted.
#[test]
fn wrong_types_in_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let problem = [
        (
            "[parameters]\nxi = \"thin\"",
            ":2: xi = \"thin\" is not accepted: a number, 1e-8 <= xi <= 1e4",
        ),
        ("[parameters]\na = [0.3]", ":2: a = [0.3] is not accepted: a number, 0 <= a <= 1e9"),
        ("[parameters]\nb = true", ":2: b = true is not accepted: a number, -1e9 <= b <= 1e9"),
        ("[start]\n\np = 1979-05-27", ":3: p = 1979-05-27 is not accepted: a number, -1e9 to 1e9"),
        ("[start]\ncycle = 1.5", ":2: cycle = 1.5 is not accepted: an integer, -2^53 to 2^53"),
        (
            "[start]\ncycle = 9007199254740993",
            ":2: cycle = 9007199254740993 is not accepted: -2^53",
        ),
        ("[start]\nphase = 3", ":2: phase = 3 is not accepted: \"no-contact\", \"contact\""),
        ("[start]\nphase = \"flight\"", ":2: phase = \"flight\" is not accepted: \"no-contact\""),
        ("parameters = 3", ":1: parameters = 3 is not accepted: a table, [parameters]"),
        ("start = \"rest\"", ":1: start = \"rest\" is not accepted: a table, [start]"),
        ("start = { p = \"x\" }", ":1: p = \"x\" is not accepted: a number, -1e9 to 1e9"),
        ("[parameters]\nxi = 0.00_0", ":2: xi = 0.00_0 is not accepted: 1e-8 <= xi <= 1e4"),
    ];
    let path = folder.path().join("problem.toml");
    for (content, wanted) in problem {
        std::fs::write(&path, content).expect("written");
        let shown = path.display().to_string();
        refused(&["simulate", "--periods", "1", "--problem", &shown], &[wanted]);
    }
}

#[test]
fn wrong_types_in_cases() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/small-b.toml");
    let whole = std::fs::read_to_string(file).expect("read");
    let bound = "[[bounds]]\nengine = \"x\"\ntolerance = 1e-6\nquantity = \"state_error\"\nstatistic = \"max\"\nlimit = 1\nwhy = \"-\"\n";
    let rows = [
        ("name = \"small-b\"", "name = 3", "name = 3 is not accepted: a string"),
        ("periods = 60", "periods = 60.5", "periods = 60.5 is not accepted: an integer, 0 to"),
        (
            "periods = 60",
            "periods = \"all\"",
            "periods = \"all\" is not accepted: an integer, 0 to",
        ),
        (
            "periods = 60",
            "until = \"end\"",
            "until = \"end\" is not accepted: a number, at or after",
        ),
        (
            "[case]",
            "[case]\nmargin = \"wide\"",
            "margin = \"wide\" is not accepted: a finite number",
        ),
        ("tolerance = 1e-6", "tolerance = \"fine\"", "a number or a list of numbers"),
        ("limit = 1", "limit = \"low\"", "limit = \"low\" is not accepted: a number"),
        ("engine = \"x\"", "engine = [1]", "engine = [1] is not accepted: a string"),
        ("[[bounds]]", "[bounds]", "a list"),
    ];
    for (from, to, wanted) in rows {
        let text = format!("{whole}{bound}");
        assert!(text.contains(from), "{from}");
        std::fs::write(folder.path().join("small-b.toml"), text.replacen(from, to, 1))
            .expect("written");
        let cases = folder.path().display().to_string();
        refused(&["validate", "--cases", &cases], &["--cases", "small-b.toml:", wanted]);
    }
}
