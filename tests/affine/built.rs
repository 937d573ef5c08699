//! Systems that programs build are those that files describe, and errors name their items.

use super::{PLASTIC, by_hand::all_systems, system};
use percuss::affine::{
    Direction, Expression, ModeBuilder, Rational, Row, System, SystemBuilder, UntilBuilder,
};

/// The system of the file `plastic.system.toml`, in its words.
fn plastic() -> SystemBuilder {
    let reset = |it: UntilBuilder| {
        it.reset("x = A*cos").reset("v = -A*omega*sin").next_when("thrust > 0", "flight")
    };
    let impact = reset(UntilBuilder::new("impact", "A*cos > x")).next("stuck");
    let detach = UntilBuilder::new("detach", "thrust > 0");
    let detach = detach.reset("x = A*cos").reset("v = -A*omega*sin").next("flight");
    let flight = ModeBuilder::new("flight").equation("x' = v").equation("v' = -g").until(impact);
    let stuck = ModeBuilder::new("stuck").equation("x' = v").equation("v' = -A*omega^2*cos");
    System::builder("plastic")
        .states(["x", "v"])
        .forcing(1.25, 0)
        .parameter("A", 1.0)
        .parameter("g", 1)
        .definition("thrust", "A*omega^2*cos - g")
        .mode(flight)
        .mode(stuck.until(detach))
        .start("stuck", [("x", "A*cos"), ("v", "-A*omega*sin")])
        .start_time(1)
}

/// All that a system holds.
fn written_text(system: &System) -> String {
    format!("{system:#?}")
}

#[test]
fn a_built_system_is_that_of_the_file() {
    assert_eq!(written_text(&plastic().build().unwrap()), written_text(&system(PLASTIC)));
}

/// A system once more, by the exact numbers of its rows.
fn by_rows(system: &System) -> SystemBuilder {
    let states = || system.states.iter().map(String::as_str);
    let mut builder = System::builder(&*system.name)
        .states(states())
        .scales(system.scales.clone())
        .time_scale(system.time_scale)
        .about(&*system.why, &*system.source, &system.trouble);
    if let Some(forcing) = &system.forcing {
        builder = builder.forcing(forcing.omega.clone(), forcing.phi.clone());
    }
    if let Some(drift) = &system.drift {
        builder = builder.drift(drift.iter().map(|n| system.states[*n].as_str()));
    }
    for mode in &system.modes {
        let rates = states().zip(&mode.matrix);
        let own = ModeBuilder::new(&*mode.name);
        let mut own = rates.fold(own, |own, (state, row)| own.rate(state, row.clone()));
        for until in &mode.until {
            let event = UntilBuilder::new(&*until.name, until.guard.clone());
            let assigned = states().zip(&until.reset);
            let event = assigned.fold(event, |it, (state, row)| it.assign(state, row.clone()));
            own = own.until(until.next.iter().fold(event, |event, next| {
                let mode = &*system.modes[next.mode].name;
                match &next.when {
                    Some(when) => event.next_when(when.clone(), mode),
                    None => event.next(mode),
                }
            }));
        }
        let watched = |own: ModeBuilder, it: &percuss::affine::Watch| {
            own.watch(&*it.name, it.guard.clone(), it.direction)
        };
        builder = builder.mode(mode.watch.iter().fold(own, watched));
    }
    let Some(start) = &system.start else { return builder };
    let row = |terms: &[Rational; 3]| -> Row {
        let kept = if system.forcing.is_some() { &terms[..] } else { &terms[2..] };
        let zeros = system.states.iter().map(|_| Rational::ZERO);
        zeros.chain(kept.iter().cloned()).collect()
    };
    let values = start.state.iter().map(|it| Expression::from(row(it)));
    builder
        .start(&*system.modes[start.mode].name, states().zip(values))
        .start_time(start.time.clone())
}

#[test]
fn every_system_can_be_built_by_its_rows() {
    for system in all_systems() {
        let mut expected = system.clone();
        expected.parameters.clear();
        let built = by_rows(system).build().unwrap();
        assert_eq!(written_text(&built), written_text(&expected), "{}", system.name);
    }
}

/// The text of an error of a builder.
fn refusal(builder: SystemBuilder) -> String {
    builder.build().unwrap_err().to_string()
}

fn with(mode: ModeBuilder) -> String {
    refusal(System::builder("one").states(["x"]).mode(mode))
}

fn on_mode() -> ModeBuilder {
    ModeBuilder::new("on").equation("x' = 1")
}

#[test]
fn an_error_of_the_system_names_it() {
    for (builder, refused) in [
        (
            plastic().states(["x", "x"]),
            "states: x is given twice; states, parameters and definitions \
                                        share their names",
        ),
        (plastic().states(["x", "cos"]), "states: cos is reserved for theta = omega t + phi"),
        (plastic().parameter("A", 2.0), "parameters: A is given twice"),
        (
            plastic().parameter("B", f64::NAN),
            "parameters: B: a parameter is a finite number; an \
                                              expression is given as a definition",
        ),
        (plastic().definition("thrust", "1"), "definitions: thrust is given twice"),
        (
            plastic().definition("lift", "2*"),
            "definitions: lift: the expression ends where an \
                                              integer, a name or `(` is accepted",
        ),
        (plastic().scales([1.0]), "system \"plastic\": scales holds a number a state, 2 of them"),
        (plastic().scales([1, 0]), "system \"plastic\": scales: a positive number is accepted"),
        (plastic().time_scale(-1), "system \"plastic\": time_scale: a positive number is accepted"),
        (plastic().forcing(0, 0), "system \"plastic\": omega is accepted above 0"),
        (
            plastic().forcing([1, 2], 0),
            "system \"plastic\": omega: a row of 2 entries is not \
                                        accepted: 5 are, of the states, cos, sin, and 1",
        ),
        (
            plastic().mode(ModeBuilder::new("stuck")),
            "mode \"stuck\": the mode \"stuck\" is there \
                                                     twice",
        ),
    ] {
        assert_eq!(refusal(builder), refused);
    }
    assert_eq!(
        refusal(System::builder("Two words").states(["x"]).mode(on_mode())),
        "system \"Two words\": \"Two words\" is not accepted: lower-case words joined by hyphens \
         are"
    );
    let none: [&str; 0] = [];
    assert_eq!(
        refusal(System::builder("none").states(none).mode(on_mode())),
        "system \"none\": at least one state is accepted"
    );
    let trouble = refusal(plastic().about("", "", ["dull"]));
    assert!(
        trouble.starts_with("system \"plastic\": trouble \"dull\" is not accepted: any of jump")
    );
}

#[test]
fn an_error_of_a_mode_names_it() {
    let until = || UntilBuilder::new("full", "x > 1");
    for (mode, refused) in [
        (ModeBuilder::new("on"), "mode \"on\": an equation `x' = ...` is missing"),
        (on_mode().equation("x' = 2"), "mode \"on\", equation `x' = 2`: x' is given twice"),
        (
            on_mode().equation("x = 2"),
            "mode \"on\", equation `x = 2`: \"x\": `x' = ...` with a state x \
                                  is accepted",
        ),
        (
            on_mode().rate("y", 1),
            "mode \"on\", rate of \"y\": \"y\" is no state: accepted is one of x",
        ),
        (
            ModeBuilder::new("on").rate("x", f64::INFINITY),
            "mode \"on\", rate of \"x\": a finite \
                                                           number is accepted",
        ),
        (
            ModeBuilder::new("on").rate("x", [0.0, f64::NAN]),
            "mode \"on\", rate of \"x\": a finite \
                                                             number is accepted",
        ),
        (
            ModeBuilder::new("on").rate("x", [1, 2, 3]),
            "mode \"on\", rate of \"x\": a row of 3 \
                                                       entries is not accepted: 2 are, of the \
                                                       states, and 1",
        ),
        (
            ModeBuilder::new("on").rate("x", ["x", "1"]),
            "mode \"on\", rate of \"x\": x is a state: \
                                                        an expression of parameters is accepted",
        ),
        (
            ModeBuilder::new("on").rate("x", [[1, 0], [0, 1]]),
            "mode \"on\", rate of \"x\": an entry \
                                                              of a row is a number or an \
                                                              expression of parameters",
        ),
        (
            on_mode().until(until()).until(until()),
            "mode \"on\", until \"full\": the event \"full\" is \
                                              there twice in its mode",
        ),
        (
            on_mode().until(UntilBuilder::new("end", "x > 1")),
            "mode \"on\", until \"end\": \"end\" is \
                                                         the name of an ending",
        ),
        (
            on_mode().until(UntilBuilder::new("full", "x")),
            "mode \"on\", until \"full\", guard: a \
                                                      condition is accepted as `left > right` or \
                                                      `left < right`",
        ),
        (
            on_mode().until(until().assign("x", 1).reset("x = 2")),
            "mode \"on\", until \"full\", reset `x \
                                                             = 2`: x is assigned twice",
        ),
        (
            on_mode().until(until().reset("x = 1").assign("x", 2)),
            "mode \"on\", until \"full\", \
                                                             assignment of \"x\": x is assigned \
                                                             twice",
        ),
        (
            on_mode().until(until().next("off")),
            "mode \"on\", until \"full\", successor 1: there is no \
                                           mode \"off\": accepted is one of on",
        ),
        (
            on_mode().until(until().next_when("x > y", "on").next("on")),
            "mode \"on\", until \"full\", \
                                                                   successor 1: y is not known: \
                                                                   accepted are x",
        ),
        (
            on_mode().until(until().next_when("x > 1", "on")),
            "mode \"on\", until \"full\": every \
                                                        successor but the last has a condition, and \
                                                        the last has none",
        ),
        (
            on_mode().watch("half", "x > 0.5", Direction::Both),
            "mode \"on\", watch \"half\", guard: a \
                                                          decimal is not accepted here: give it \
                                                          as a parameter",
        ),
    ] {
        assert_eq!(with(mode), refused);
    }
    let many =
        (0..65).fold(on_mode(), |mode, n| mode.watch(format!("w{n}"), "x > 0", Direction::Both));
    assert_eq!(with(many), "mode \"on\": 65 events are too many: up to 64 a mode are accepted");
}

/// A guard that is constant never fires; the rule is that of files.
#[test]
fn a_guard_that_never_changes_is_refused() {
    let until = |guard: Expression| with(on_mode().until(UntilBuilder::new("full", guard)));
    let number = "mode \"on\", until \"full\", guard: a number is no condition: `left > right`, \
                  `left < right` or a row of factors is accepted";
    for guard in [5.into(), 0.5.into(), (Rational::ONE / Rational::from(3)).into()] {
        assert_eq!(until(guard), number);
    }
    let constant = "the guard never changes: accepted is one with a state, cos or sin in it";
    assert_eq!(until("2 > 1".into()), format!("mode \"on\", until \"full\", guard: {constant}"));
    assert_eq!(
        with(on_mode().watch("half", "1 < 1/2", Direction::Both)),
        format!("mode \"on\", watch \"half\", guard: {constant}")
    );
    let defined = |half: &str, guard: &str| {
        let mode = on_mode().until(UntilBuilder::new("full", guard));
        let one = System::builder("one").states(["x"]).parameter("k", 0);
        one.definition("half", half).definition("all", "2*half").mode(mode).build()
    };
    let refused = defined("k/2", "all + k > 1").unwrap_err().to_string();
    assert_eq!(refused, format!("mode \"on\", until \"full\", guard: {constant}"));
    assert!(defined("x/2", "all > 1").is_ok());
    // Parameters may be 0, and what a row has for a state, too.
    assert!(defined("k*x", "all > 1").is_ok());
    let row = on_mode().until(UntilBuilder::new("full", [0, -1]));
    assert!(System::builder("one").states(["x"]).mode(row).build().is_ok());
}

/// A successor's condition may hang on parameters alone.
#[test]
fn a_condition_may_be_constant() {
    let until = || UntilBuilder::new("full", "x > 1");
    let mode = on_mode().until(until().next_when("2 > 1", "on").next("on"));
    assert!(System::builder("one").states(["x"]).mode(mode).build().is_ok());
    assert_eq!(
        with(on_mode().until(until().next_when(1, "on").next("on"))),
        "mode \"on\", until \"full\", successor 1: a number is no condition: `left > right`, \
         `left < right` or a row of factors is accepted"
    );
}

/// No error of a builder speaks of the tables of a file, which its user has not written.
#[test]
fn errors_of_a_builder_have_no_words_of_files() {
    let until = UntilBuilder::new("full", "x > 1");
    let one = || System::builder("one").states(["x"]);
    for builder in [
        one().mode(on_mode()).parameter("x", 1),
        one().mode(on_mode()).parameter("k", "x"),
        one().mode(on_mode()).start("on", [("y", 1)]),
        one().mode(on_mode()).start("on", [("x", 1), ("y", 1)]),
        one().mode(on_mode().until(until.clone().next_when("x > 0", "on"))),
        one().mode(on_mode().until(until.reset("x = 0.5"))),
        one().mode(on_mode()).definition("half", "1/0"),
    ] {
        let said = refusal(builder);
        assert!(!said.contains(['[', ']']) && !said.contains("`when`"), "{said}");
    }
}

#[test]
fn an_error_of_the_start_names_it() {
    let begin = |states: &[(&str, Expression)]| {
        refusal(System::builder("one").states(["x"]).mode(on_mode()).start("on", states.to_vec()))
    };
    assert_eq!(begin(&[]), "start: the start has no state x");
    assert_eq!(begin(&[("x", 1.into()), ("x", 2.into())]), "start: x is given twice");
    assert_eq!(begin(&[("x", 1.into()), ("y", 2.into())]), "start: y is no state: accepted are x");
    assert_eq!(
        begin(&[("x", [1, 1].into())]),
        "start: x: a start that hangs on itself, by way of other states or not, is not accepted"
    );
    assert_eq!(begin(&[("x", f64::NAN.into())]), "start: x: a finite number is accepted");
    assert_eq!(
        begin(&[("x", 1.into()), ("mode", "on".into())]),
        "start: mode is no state: the mode of the start is given before the states"
    );
    assert_eq!(
        begin(&[("x", 1.into()), ("t", 5.into())]),
        "start: t is no state: the time of the start is given by `start_time`"
    );
    let other = System::builder("one").states(["x"]).mode(on_mode()).start("off", [("x", 1)]);
    assert_eq!(refusal(other), "start: there is no mode \"off\": accepted is one of on");
    let time = System::builder("one").states(["x"]).mode(on_mode()).start_time(1);
    assert_eq!(refusal(time), "start: a time of the start is not accepted without a start");
}

#[test]
fn a_text_without_a_file_has_lines() {
    let changed = |from: &str, to: &str| {
        System::from_toml(&PLASTIC.replace(from, to)).unwrap_err().to_string()
    };
    assert_eq!(written_text(&System::from_toml(PLASTIC).unwrap()), written_text(&system(PLASTIC)));
    assert_eq!(changed("schema = 1", "schema = 2"), "line 1: the schema that is accepted is 1");
    assert_eq!(
        changed("\"v' = -g\"", "\"v' = -h\""),
        "line 12: h is not known: accepted are x, v, A, g, thrust, cos, sin, omega, phi"
    );
    assert_eq!(changed("states =", "state ="), {
        let of_file = System::parse("file", &PLASTIC.replace("states =", "state ="));
        of_file.unwrap_err().to_string().replace("file:", "line ")
    });
    assert!(changed("guard = \"A*cos > x\"", "guard = 5").starts_with("line 15: not accepted: "));
}

#[test]
fn a_file_is_read_by_its_path() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/affine");
    let path = folder.join("plastic.system.toml");
    assert_eq!(written_text(&System::from_file(&path).unwrap()), written_text(&system(PLASTIC)));
    let missing = folder.join("missing.system.toml");
    let error = System::from_file(&missing).unwrap_err().to_string();
    let expected = format!("{}: the file cannot be read: ", missing.display());
    assert!(error.starts_with(&expected), "{error}");
}
