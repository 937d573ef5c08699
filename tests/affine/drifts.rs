//! States on which nothing depends: which are accepted as drifts, and how fast they go.

use percuss::affine::{SectionMap, Solver, System};
use percuss::dynamics::lyapunov::Spectrum;
use percuss::dynamics::orbit::Orbit;
use percuss::dynamics::strobe::StrobeMap;
use percuss::system::Section;
use percuss::{Instant, Model, Parameters, Start};

const OSCILLATOR: &str = include_str!("../../validation/systems/percussive-oscillator.system.toml");

/// The oscillator's file with some text in the place of another, which is there.
fn replaced_text(from: &str, to: &str) -> String {
    assert!(OSCILLATOR.contains(from), "{from}");
    OSCILLATOR.replacen(from, to, 1)
}

#[test]
fn what_depends_on_a_drift_is_named() {
    let refused = |from: &str, to: &str, wanted: &str| {
        let error = System::from_toml(&replaced_text(from, to)).unwrap_err().to_string();
        assert_eq!(error, format!("line 7: {wanted}"));
    };
    refused(
        "y' = push\"",
        "y' = push - v\"",
        "v is no drift: mode \"no-contact\", equation `y' = push - v` depends on it",
    );
    refused(
        "\"v' = 0\"",
        "\"v' = -v\"",
        "v is no drift: mode \"no-contact\", equation `v' = -v` depends on it",
    );
    refused(
        "p - q > g",
        "p - q > g + v",
        "v is no drift: mode \"no-contact\", until \"impact\", guard `p - q > g + v` depends on it",
    );
    refused(
        "[\"p = q + g\"]",
        "[\"p = q + g + v\"]",
        "v is no drift: mode \"no-contact\", until \"impact\", reset `p = q + g + v` depends on it",
    );
    refused(
        "[\"p = q + g\"]",
        "[\"p = q + g\", \"v = 0\"]",
        "v is no drift: mode \"no-contact\", until \"impact\", reset `v = 0` does not add to it: \
         accepted is v = v and what does not depend on v",
    );
    refused(
        "when = \"f > 1\"",
        "when = \"f > v\"",
        "v is no drift: mode \"no-contact\", until \"impact\", condition `f > v` depends on it",
    );
    refused(
        "[start]\nmode = \"no-contact\"",
        "[start]\nmode = [{ when = \"v > 1\", mode = \"contact\" }, { mode = \"no-contact\" }]",
        "v is no drift: start, condition `v > 1` depends on it",
    );
    refused("drift = [\"v\"]", "drift = [\"v\", \"v\"]", "v is there twice");
    refused("drift = [\"v\"]", "drift = [\"w\"]", "w is no state: accepted are p, y, q, v");
    let watched = "[[mode.watch]]\nname = \"far\"\nguard = \"v > 7\"\n\n[start]";
    refused(
        "[start]",
        watched,
        "v is no drift: mode \"progression\", watch \"far\", guard `v > 7` depends on it",
    );
}

/// Definitions are looked through, and so are parameters: what depends on a state with the factor 0
/// does not depend on it.
#[test]
fn a_factor_of_zero_is_no_dependence() {
    let text = replaced_text("push = \"a*cos + b\"", "push = \"a*cos + b - k*v\"");
    let with = |k: &str| System::from_toml(&text.replace("a = 0.3", &format!("a = 0.3\nk = {k}")));
    assert_eq!(with("0").unwrap().drifts(), [3]);
    let error = with("1e-300").unwrap_err().to_string();
    assert!(error.contains("equation `y' = push` depends on it"), "{error}");
}

#[test]
fn a_drift_may_add_what_others_do() {
    let text = replaced_text("[\"p = q + g\"]", "[\"p = q + g\", \"v = v + 2*q + cos\"]");
    assert_eq!(System::from_toml(&text).unwrap().drifts(), [3]);
}

/// Without the key they are found; with it no others are drifts.
#[test]
fn drifts_are_found_where_the_file_does_not_say() {
    let drifts = |by: &str| {
        let system = System::from_toml(&replaced_text("drift = [\"v\"]\n", by)).unwrap();
        (system.drift.clone(), system.drifts())
    };
    assert_eq!(drifts(""), (None, vec![3]));
    assert_eq!(drifts("drift = []\n"), (Some(vec![]), vec![]));
    assert_eq!(drifts("drift = [\"v\"]\n"), (Some(vec![3]), vec![3]));
}

#[test]
fn a_drift_that_is_made_by_hand_is_checked() {
    let refused = |drift: &[usize], wanted: &str| {
        let mut system = System::from_toml(OSCILLATOR).unwrap();
        system.drift = Some(drift.to_vec());
        assert_eq!(system.check().unwrap_err().to_string(), wanted);
    };
    refused(&[3, 4], "drift: there is no state 4: accepted are indices below 4");
    refused(&[3, 3], "drift: v is there twice");
    let by = "drift: q is no drift: mode \"no-contact\", equation of q depends on it";
    refused(&[2], by);
}

/// The system with omega = 0.1, where Table 1 of the paper goes forward on an orbit of period two.
fn table_1() -> (System, Model) {
    let system = System::from_toml(&replaced_text("frequency = 1.4", "frequency = 0.1")).unwrap();
    (system, Model::new(Parameters { omega: 0.1, ..Parameters::default() }).unwrap())
}

/// An orbit's and a run's drifts are the oscillator's own, and do not hang on where they begin.
#[test]
fn the_oscillators_drift_is_its_own() {
    let (system, model) = table_1();
    let map = StrobeMap::new(model, Instant::at(0.1, 0.0, 0));
    let solver = Solver::<f64>::new(&system).unwrap();
    let section = SectionMap::new(&solver, &Section::strobe(0.0)).unwrap();
    let place = |v: f64| {
        let start = system.start_at("no-contact", 0.0, &[0.0, 0.0, 0.0, v]).unwrap();
        let mut returns = section.returns(&start).unwrap();
        returns.by_ref().take(101).for_each(|it| assert!(it.is_ok()));
        returns.place().unwrap()
    };
    for v in [0.0_f64, -4096.0] {
        // What has drifted is the difference of values of this size, once a return.
        let within = 1e-12 * (1.0 + v.abs() + 100.0 * 14.0);
        let orbit = section.orbit(&place(v), 2).unwrap();
        let own = Orbit::find(&map, orbit.points[0].state[..3].try_into().unwrap(), 2).unwrap();
        assert_eq!((orbit.period(), own.period()), (2, 2));
        let [drift] = orbit.drift_per_return[..] else { panic!("{orbit:?}") };
        assert!(own.drift_per_period > 13.9, "{own:?}");
        assert!((drift - own.drift_per_period).abs() < within, "{drift} {own:?}");
        let found = section.exponents(&place(v), 20, 64, &mut |_| ()).unwrap();
        let [drift] = found.drift_per_return[..] else { panic!("{found:?}") };
        let [error] = found.drift_standard_error[..] else { panic!("{found:?}") };
        assert!((drift - own.drift_per_period).abs() < within && error < within, "{found:?}");
    }
}

/// In chaos, over one run of few enough periods for both programs to follow.
#[test]
fn the_mean_drift_of_a_run_is_the_oscillators_own() {
    let periods = 24;
    let model = Model::new(Parameters::default()).unwrap();
    let entry = model.start(&Start::default()).unwrap();
    let own = Spectrum::new(&model, entry, 0, periods);
    let system = System::from_toml(OSCILLATOR).unwrap();
    let solver = Solver::<f64>::new(&system).unwrap();
    let map = SectionMap::new(&solver, &Section::strobe(0.0)).unwrap();
    let mut returns = map.returns(system.start().unwrap()).unwrap();
    returns.next().unwrap().unwrap();
    let found = map.exponents(&returns.place().unwrap(), 0, periods, &mut |_| ()).unwrap();
    let [drift, error] = [found.drift_per_return[0], found.drift_standard_error[0]];
    // Errors grow by at most exp(0.1) a period; the batches are the same.
    assert!((drift - own.drift_per_period).abs() < 1e-9, "{drift} {own:?}");
    assert!((error - own.drift_standard_error).abs() < 1e-9 && error > 0.0, "{error} {own:?}");
}
