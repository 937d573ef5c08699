//! Errors in a system's file are reported with their line, and with what is accepted.

use super::BALL;
use percuss::affine::{System, SystemFile};

/// The error of the ball's file after a replacement.
fn error(old: &str, new: &str) -> String {
    assert!(BALL.contains(old), "{old}");
    let text = BALL.replacen(old, new, 1);
    System::parse("ball.system.toml", &text).err().map_or_else(String::new, |it| it.to_string())
}

#[test]
fn each_mistake_is_named_with_its_line() {
    let cases = [
        ("schema = 1", "schema = 2", "ball.system.toml:1: the schema that is accepted is 1"),
        ("\"ball\"", "\"Ball\"", "ball.system.toml:2: \"Ball\" is not accepted: lower-case words"),
        ("\"v\"]", "\"x\"]", "x is given twice"),
        ("\"v\"]", "\"cos\"]", "cos is reserved"),
        ("\"v\"]", "\"v w\"]", "\"v w\" is no name"),
        ("g = 2.0", "g = \"2\"", "ball.system.toml:5: g: a parameter is a finite number"),
        ("g = 2.0", "g = nan", "a parameter is a finite number"),
        ("v' = -g", "v = -g", "`x' = ...` with a state x is accepted"),
        ("v' = -g", "v' = -9.81", "a decimal is not accepted here"),
        ("v' = -g", "v' = -2e-3", "a decimal is not accepted here"),
        ("v' = -g", "v' = -h", "h is not known"),
        ("v' = -g", "v' = -x*v", "expressions are affine"),
        ("v' = -g", "v' = -g/v", "expressions are affine"),
        ("v' = -g", "v' = -g/(g - 2)", "a division by zero"),
        ("v' = -g", "v' = -g^v", "an exponent is an integer from 0 to 64"),
        ("v' = -g", "v' = v^2", "a power of a state"),
        ("v' = -g", "v' = -(g", "a `)` is missing"),
        ("v' = -g", "v' = -g)", "')' is not accepted here"),
        ("v' = -g", "v' = cos(x)", "cos means nothing without forcing"),
        (", \"v' = -g\"", "", "an equation `v' = ...` is missing"),
        ("0 > x", "0 >= x", "a condition is accepted as `left > right`"),
        ("0 > x", "x", "a condition is accepted as"),
        ("0 > x", "0 > g", "the guard never changes: accepted is one with a state, cos or sin"),
        ("x = 0\", \"v = -e*v", "x = 0\", \"x = 1", "x is assigned twice"),
        ("\"both\"", "\"up\"", "\"up\" is no direction: accepted are rising, falling, both"),
        ("\"touched\"", "\"impact\"", "the event \"impact\" is there twice"),
        ("v = 1\n", "", "the start has no state v"),
        ("v = 1\n", "v = \"v + 1\"\n", "v: a start that hangs on itself"),
        ("v = 1\n", "v = 1\nt = \"x\"\n", "x is a state: an expression of parameters"),
        ("v = 1\n", "v = 1\nw = 1\n", "w is no state: accepted are mode, t, x, v"),
        (
            "mode = \"flight\"",
            "mode = \"fly\"",
            "there is no mode \"fly\": accepted is one of flight",
        ),
        ("mode = \"flight\"\n", "", "the start has no mode: accepted is one of flight"),
        ("mode = \"flight\"", "mode = 1", "mode is no number: accepted is one of flight"),
        ("states = [\"x\", \"v\"]\n", "", "states is missing here: accepted is an array of names"),
        ("guard = \"0 > x\"\n", "", "guard is missing here: accepted is a comparison"),
        ("name = \"apex\"\n", "", "name is missing here: accepted is a string"),
        ("[start]", "unknown = 1\n[start]", "unknown"),
    ];
    for (old, new, said) in cases {
        let message = error(old, new);
        assert!(message.contains(said), "{new}: {message:?}");
        assert!(message.starts_with("ball.system.toml:"), "{message}");
        assert_eq!(message.lines().count(), 1, "{message}");
    }
}

/// A mode alone is short for a list of one.
#[test]
fn a_mode_that_follows_may_stand_alone() {
    let reset = "reset = [\"x = 0\", \"v = -e*v\"]";
    let next = |next: &str| {
        let text = BALL.replace(reset, &format!("{reset}\nnext = {next}"));
        System::parse("ball.system.toml", &text)
    };
    let [alone, list] = ["\"flight\"", "[{ mode = \"flight\" }]"].map(|it| next(it).unwrap());
    let [alone, list] = [&alone, &list].map(|it| &it.modes[0].until[0].next);
    assert_eq!((alone, alone.len()), (list, 1));
    for (wrong, said) in [
        ("\"fly\"", "there is no mode \"fly\": accepted is one of flight"),
        ("1", "the name of a mode, or a list of { when, mode }"),
    ] {
        let message = next(wrong).unwrap_err().to_string();
        assert!(message.contains(said), "{message}");
    }
}

#[test]
fn coefficients_are_exact() {
    let text = BALL.replace("v' = -g", "v' = -g^3/3 + (1/3 - 1/3)*x - 2*(v - x)/6");
    let system = System::parse("ball.system.toml", &text).unwrap();
    let row: Vec<_> = system.modes[0].matrix[1].iter().map(ToString::to_string).collect();
    assert_eq!(row, ["1/3", "-1/3", "-8/3"]);
}

#[test]
fn what_is_too_large_is_refused() {
    let names: Vec<_> = (0..12).map(|n| format!("\"s{n}\"")).collect();
    let text = BALL.replace("\"x\", \"v\"", &names.join(", "));
    let error = System::parse("ball.system.toml", &text).unwrap_err().to_string();
    assert!(error.contains("up to 12 are accepted"), "{error}");
    let long = format!("v' = -{}", "g^64*".repeat(400) + "g^64");
    let error = System::parse("f", &BALL.replace("v' = -g", &long)).unwrap_err().to_string();
    assert!(error.contains("bits is too long"), "{error}");
    let deep = format!("v' = {}g{}", "(".repeat(1000), ")".repeat(1000));
    let error = System::parse("f", &BALL.replace("v' = -g", &deep)).unwrap_err().to_string();
    assert!(error.contains("nested more than"), "{error}");
    let circle = BALL.replace("[[mode]]", "[let]\na = \"b\"\nb = \"a\"\n[[mode]]");
    let error = System::parse("f", &circle).unwrap_err().to_string();
    assert!(error.contains("defined by itself"), "{error}");
}

#[test]
fn parameters_and_start_can_be_replaced() {
    let mut file = SystemFile::read("ball.system.toml", BALL).unwrap();
    let error = file.set("h", 1.0, "--set").unwrap_err().to_string();
    assert_eq!(error, "--set: \"h\" is no parameter of ball: accepted is one of e, g");
    file.replace_from("s.toml", "[start]\nmode = \"flight\"\nx = 3\nv = \"g/3\"\n", false).unwrap();
    let start = file.system().unwrap().start.unwrap();
    assert_eq!(start.state[1][2].to_string(), "2/3");
    let error = file.replace_from("s.toml", "[case]\nname = 1\n", false).unwrap_err().to_string();
    assert!(error.starts_with("s.toml:1: case is not accepted here"), "{error}");
}

#[test]
fn an_error_of_a_line_names_what_has_replaced_a_parameter() {
    let text = BALL.replace("v' = -g", "v' = -1/g");
    let mut file = SystemFile::read("ball.system.toml", &text).unwrap();
    file.set("e", 0.5, "--set e=0.5").unwrap();
    file.set("g", 0.0, "--set g=0").unwrap();
    let error = file.system().unwrap_err().to_string();
    assert!(error.contains(": a division by zero, with --set e=0.5 and --set g=0"), "{error}");
    file.set("g", 1.0, "--set g=1").unwrap();
    assert!(file.system().is_ok());
}
