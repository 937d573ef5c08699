//! Starts whose mode is chosen by conditions.

use percuss::system::{ModeBuilder, SystemFile};
use percuss::{Proved, System};

/// A mass on a spring with a gap, driven.
fn rig(phi: &str, mode: &str, [x, v]: [&str; 2]) -> String {
    format!(
        r#"
        schema = 1
        name = "rig"
        states = ["x", "v"]
        forcing = {{ omega = 2, phi = {phi} }}
        [[mode]]
        name = "free"
        equations = ["x' = v", "v' = cos"]
        until = [{{ name = "hits", guard = "x > 1", next = [{{ mode = "contact" }}] }}]
        [[mode]]
        name = "contact"
        equations = ["x' = v", "v' = cos - 100*(x - 1)"]
        until = [{{ name = "leaves", guard = "x < 1", next = [{{ mode = "free" }}] }}]
        [start]
        mode = {mode}
        x = {x}
        v = {v}
        "#
    )
}

const LIST: &str = r#"[{ when = "x > 1", mode = "contact" }, { mode = "free" }]"#;

fn chosen_mode(text: &str) -> usize {
    System::from_toml(text).expect("a system").start().expect("a start").mode
}

/// The value decides, and on the surface the velocity, and with it zero the acceleration: cos theta
/// at the start, then its rate.
#[test]
fn the_first_derivative_that_is_not_zero_decides() {
    let on = |x, v| chosen_mode(&rig("0", LIST, [x, v]));
    assert_eq!([on("0.5", "9"), on("1.5", "-9")], [0, 1]);
    assert_eq!([on("1", "-1"), on("1", "1")], [0, 1]);
    // v' = cos theta is 1 at theta = 0.
    assert_eq!(on("1", "0"), 1);
    // It is negative at theta = 3, and positive at theta = 1.
    assert_eq!(chosen_mode(&rig("3", LIST, ["1", "0"])), 0);
    assert_eq!(chosen_mode(&rig("1", LIST, ["1", "0"])), 1);
}

/// A start on the surface by the model is on it whatever theta is: cos(3) is no number that a
/// computer has, and x - 1 is zero nevertheless.
#[test]
fn a_start_that_is_on_a_surface_by_the_model_is_on_it() {
    let list = r#"[{ when = "x - cos > 1", mode = "contact" }, { mode = "free" }]"#;
    // d(x - cos)/dt = v + 2 sin, and sin(3) is positive.
    assert_eq!(chosen_mode(&rig("3", list, ["\"1 + cos\"", "0"])), 1);
    assert_eq!(chosen_mode(&rig("3", list, ["\"1 + cos\"", "\"-3*sin\""])), 0);
    // Without a derivative that is not zero a condition is false.
    let never = r#"[{ when = "cos - cos > 0", mode = "contact" }, { mode = "free" }]"#;
    assert_eq!(chosen_mode(&rig("3", never, ["5", "5"])), 0);
}

/// The first 36 decimals of cos(1) are below it, and one more in the last is above: 106 bits show
/// 32 of them.
#[test]
fn a_sign_that_106_bits_do_not_show_is_shown_in_more() {
    let decimals = |last: u64| {
        format!(
            "cos > 540302305868139717/10^18 + {last}/10^36",
            last = 400_936_607_442_976_603 + last
        )
    };
    for (last, mode) in [(0, 1), (1, 0)] {
        let list = format!(
            r#"[{{ when = "{}", mode = "contact" }}, {{ mode = "free" }}]"#,
            decimals(last)
        );
        assert_eq!(chosen_mode(&rig("1", &list, ["0", "0"])), mode, "{last}");
    }
}

/// Starts that a caller gives lie in the mode that the list chooses, and a run begins in it.
#[test]
fn starts_of_a_grid_lie_in_their_modes() {
    let system = System::from_toml(&rig("0", LIST, ["0", "0"])).expect("a system");
    let solver = system.solver::<Proved>().expect("a solver");
    for (x, name) in [(0.0, "hits"), (1.5, "leaves")] {
        let start = system.start_by_conditions(0.0, &[x, 1.0]).expect("a start");
        let mut events = solver.run_from(&start).events(1).expect("a run");
        assert_eq!(events.next().expect("an event").name(), name);
    }
    let one = System::from_toml(&rig("0", "\"free\"", ["0", "0"])).expect("a system");
    let error = one.start_by_conditions(0.0, &[0.0, 0.0]).unwrap_err();
    assert!(error.to_string().contains("no list of { when, mode }"), "{error}");
    assert!(system.start_by_conditions(0.0, &[0.0]).is_err());
    assert!(system.start_by_conditions(f64::NAN, &[0.0, 0.0]).is_err());
}

#[test]
fn a_name_given_later_takes_the_place_of_the_list() {
    let mut file = SystemFile::read("rig.system.toml", &rig("0", LIST, ["5", "0"])).expect("read");
    assert_eq!(file.system().expect("a system").start().expect("a start").mode, 1);
    file.set_start("x", "0", "--at").expect("a state");
    assert_eq!(file.system().expect("a system").start().expect("a start").mode, 0);
    file.set_start_mode("contact", "--mode");
    let system = file.system().expect("a system");
    assert_eq!(system.start().expect("a start").mode, 1);
    assert!(system.start_modes.is_empty());
}

#[test]
fn lists_that_choose_nothing_are_refused_with_their_line() {
    let refused = |mode: &str, wanted: &str| {
        let error = System::from_toml(&rig("0", mode, ["0", "0"])).unwrap_err().to_string();
        assert!(error.starts_with("line 15: ") && error.contains(wanted), "{error}");
    };
    refused("[]", "one at least");
    refused(r#"[{ when = "x > 1", mode = "free" }]"#, "the last has none");
    refused(r#"[{ mode = "free" }, { mode = "contact" }]"#, "the last has none");
    refused(r#"[{ when = "x > 1", mode = "stuck" }, { mode = "free" }]"#, "no mode \"stuck\"");
    refused(r#"[{ when = "y > 1", mode = "contact" }, { mode = "free" }]"#, "y is not known");
    let text = rig("0", LIST, ["[1]", "0"]);
    assert!(System::from_toml(&text).is_err());
    let mut system = System::from_toml(&rig("0", LIST, ["0", "0"])).expect("a system");
    system.start_modes[0].mode = 7;
    let error = system.check().unwrap_err().to_string();
    assert!(error.contains("start, mode 1: there is no mode 7"), "{error}");
}

#[test]
fn a_builder_has_the_list() {
    let builder = || {
        System::builder("gap")
            .states(["x"])
            .mode(ModeBuilder::new("free").equation("x' = 1"))
            .mode(ModeBuilder::new("contact").equation("x' = -1"))
    };
    let system = builder().start_when("x > 1", "contact").start("free", [("x", 2)]);
    assert_eq!(system.build().expect("a system").start().expect("a start").mode, 1);
    let system = builder().start_when("x > 1", "contact").start("free", [("x", 1)]);
    // At x = 1 the motion in contact, which would begin, falls: the condition does not hold.
    assert_eq!(system.build().expect("a system").start().expect("a start").mode, 0);
    let error = builder().start_when("x > 1", "contact").build().unwrap_err().to_string();
    assert!(error.contains("not accepted without a start"), "{error}");
    let error = builder().start_when("x > 1", "stuck").start("free", [("x", 1)]).build();
    assert!(error.unwrap_err().to_string().starts_with("start, mode 1: "));
}
