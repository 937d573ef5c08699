//! Diagrams of returns, beside the runs that they are made of and the oscillator's own.

use percuss::affine::{
    LeftOut, NoReturn, ReturnDiagram, ReturnDiagramStep, SectionMap, Solver, System, SystemFile,
};
use percuss::dynamics::diagram::{Diagram, Follow, values};
use percuss::system::Section;
use percuss::{Ending, Parameter, Parameters, Start};

const OSCILLATOR: &str = include_str!("../../validation/systems/percussive-oscillator.system.toml");
const RIGID: &str = include_str!("../../validation/systems/rigid-impact-oscillator.system.toml");

/// The largest error of f64 over some hundred returns of motions in which none grows.
const STATE_TOLERANCE: f64 = 1e-11;

fn plan(section: Section, follow: Follow) -> ReturnDiagram {
    ReturnDiagram { section, longest: None, transient: 40, returns: 6, follow }
}

/// A system with other values of some parameters.
fn with(text: &str, set: &[(&str, f64)]) -> System {
    let mut file = SystemFile::read("test.system.toml", text).unwrap();
    for (name, value) in set {
        file.set(name, *value, "the test").unwrap();
    }
    file.system().unwrap()
}

/// The diagram of a text's system over a parameter.
fn steps(
    diagram: &ReturnDiagram,
    text: &str,
    parameter: &str,
    values: &[f64],
) -> Vec<ReturnDiagramStep> {
    diagram.steps(values, |it| Ok(with(text, &[(parameter, it)])), |_| ()).unwrap()
}

/// Motions at xi = 0.5 settle, by 0.15 a period at least, so that no rounding grows, and nothing is
/// left after 200 periods of where a value begins: the oscillator's own puts a mass that is carried
/// on back on the slider where the gap has changed.
#[test]
fn the_oscillators_diagram_is_its_own() {
    let text = OSCILLATOR.replace("xi = 0.01", "xi = 0.5");
    let parameters = Parameters { xi: 0.5, ..Parameters::default() };
    for (parameter, name, from, to) in [
        (Parameter::Omega, "frequency", 1.3, 1.5),
        (Parameter::A, "a", 0.31, 0.29),
        (Parameter::B, "b", 0.08, 0.1),
        (Parameter::G, "g", 0.02, 0.03),
        (Parameter::Xi, "xi", 0.5, 0.6),
        (Parameter::Phi, "phase", 1.5, 1.0),
    ] {
        for follow in [Follow::Carry, Follow::Reset] {
            let (start, steps_of, transient, periods) = (Start::default(), 5, 200, 4);
            let own = Diagram {
                parameters,
                start,
                parameter,
                from,
                to,
                steps: steps_of,
                transient,
                periods,
                follow,
            };
            let own = own.steps(|_| ()).unwrap();
            let as_system =
                ReturnDiagram { transient, returns: periods, ..plan(Section::strobe(0.0), follow) };
            let as_system = steps(&as_system, &text, name, &values(from, to, steps_of));
            assert_eq!(own.len(), as_system.len());
            for (own, step) in own.iter().zip(&as_system) {
                assert_eq!((own.value, own.points.len()), (step.value, step.points.len()));
                for (own, point) in own.points.iter().zip(&step.points) {
                    let apart = own.iter().zip(&point.state).map(|(a, b)| (a - b).abs());
                    let apart = apart.fold(0.0, f64::max);
                    assert!(apart < STATE_TOLERANCE, "{name} {own:?} {point:?}");
                }
            }
        }
    }
}

/// Values that are all alike carry one motion on: its returns to an event are those of one run.
#[test]
fn carried_motions_go_on() {
    let set = [("frequency", 2.6), ("zeta", 0.2)];
    let rigid = |_: f64| Ok(with(RIGID, &set));
    let diagram = plan(Section::event("impact"), Follow::Carry);
    let found = diagram.steps(&[0.125; 3], rigid, |_| ()).unwrap();
    let system = rigid(0.0).unwrap();
    let solver = Solver::<f64>::new(&system).unwrap();
    let map = SectionMap::new(&solver, &Section::event("impact")).unwrap();
    let all: Vec<_> = map.returns(system.start().unwrap()).unwrap().take(3 * 46).collect();
    for (k, step) in found.iter().enumerate() {
        assert_eq!((step.left_out, step.points.len()), (None, 6));
        for (n, point) in step.points.iter().enumerate() {
            let known = all[46 * k + 40 + n].as_ref().unwrap();
            let apart = point.state.iter().zip(&known.state).map(|(a, b)| (a - b).abs());
            assert!(apart.fold(0.0, f64::max) < STATE_TOLERANCE, "{k} {n} {point:?} {known:?}");
        }
    }
}

/// A stop that moves towards a mass at rest against it is passed: there is no motion, and the
/// values after it start from the last one that had. A stop that moves away lets the mass fly.
#[test]
fn a_start_beyond_a_guard_is_left_out() {
    let diagram = plan(Section::event("impact"), Follow::Carry);
    let found = steps(&diagram, RIGID, "d", &[0.1, 0.11, 0.09, 0.12]);
    let why: Vec<_> = found.iter().map(|it| it.left_out).collect();
    let beyond = Some(LeftOut::NoReturn(NoReturn::Ended(Ending::BeyondGuard)));
    assert_eq!(why, [None, None, beyond, None]);
    assert!(found[2].points.is_empty());
    assert!(found.iter().flat_map(|it| &it.points).all(|it| it.state[0] >= 0.1), "{found:?}");
    // From its own start each of these values has a motion.
    let diagram = plan(Section::event("impact"), Follow::Reset);
    let found = steps(&diagram, RIGID, "d", &[0.1, 0.11, 0.09, 0.12]);
    assert!(found.iter().all(|it| it.left_out.is_none()));
}

/// A force that outweighs the spring drives the state away by e^(t/2) a unit of time: 1e9 is passed
/// within 40 returns.
#[test]
fn a_motion_that_escapes_has_no_points() {
    let text = RIGID
        .replace("v' = -2*zeta*v - x + A*cos", "v' = A*cos - d*x")
        .replace("[parameters]", "[parameters]\nfar = 1e30")
        .replace("guard = \"x > d\"", "guard = \"x > far\"")
        .replace("reset = [\"x = d\", \"v = -r*v\"]", "");
    let diagram = plan(Section::strobe(0.0), Follow::Carry);
    let found = steps(&diagram, &text, "d", &[1.0, -0.25, 2.0]);
    let why: Vec<_> = found.iter().map(|it| it.left_out).collect();
    assert_eq!(why, [None, Some(LeftOut::Escapes), None]);
}

/// A state counts by its scale, and a drift, which an orbit's goes on for ever, not at all: x grows
/// by 4e8 a period, and the last of the 46 returns, the first of which is the start, is at 1.8e10.
#[test]
fn what_is_far_counts_in_scales_and_without_drifts() {
    let left_out = |line: &str| {
        let text = format!(
            "schema = 1\nname = \"far\"\nstates = [\"x\", \"y\"]\n{line}\n\
             forcing = {{ omega = 1, phi = 0.0 }}\n[parameters]\nrate = 1\n\
             [[mode]]\nname = \"on\"\nequations = [\"x' = rate\", \"y' = cos - y\"]\n\
             [start]\nmode = \"on\"\nx = 0\ny = 0\n"
        );
        let diagram = plan(Section::strobe(0.0), Follow::Reset);
        steps(&diagram, &text, "rate", &[4e8 / std::f64::consts::TAU])[0].left_out
    };
    assert_eq!(left_out("drift = []"), Some(LeftOut::Escapes));
    assert_eq!(left_out("drift = []\nscales = [17, 1]"), Some(LeftOut::Escapes));
    assert_eq!(left_out("drift = []\nscales = [19, 1]"), None);
    assert_eq!(left_out("drift = [\"x\"]"), None);
    assert_eq!(left_out(""), None, "a state on which nothing depends is a drift unless told");
}

#[test]
fn a_value_without_a_system_is_named() {
    let diagram = plan(Section::strobe(0.0), Follow::Carry);
    let read = |it: f64| {
        let text = RIGID.replace("- x + A", &format!("- x/{it} + A"));
        System::parse("test.system.toml", &text)
    };
    let error = diagram.steps(&[1.0, 0.0], read, |_| ()).unwrap_err();
    assert_eq!(error.value, 0.0);
    assert!(error.to_string().starts_with("at 0: test.system.toml:"), "{error}");
    let diagram = plan(Section::event("bang"), Follow::Reset);
    let error = diagram.steps(&[1.0], read, |_| ()).unwrap_err();
    assert!(error.to_string().contains("bang is no event"), "{error}");
}
