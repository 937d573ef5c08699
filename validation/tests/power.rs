//! Every engine that is wrong on purpose fails a bound, and every gate has a fault that trips it.

use crate::exact;
use percuss::{Model, Parameters, Start};
use percuss_validation::case::{Case, Given, defaults, embedded};
use percuss_validation::engine::Accuracy;
use percuss_validation::integrators::{
    CONTROL, FAULTY_CONTROL, FAULTY_ON_SYSTEMS_CONTROL, Way, WrongEngine, faulty, wrong,
};
use percuss_validation::power::{
    EXACT_STANDARD, Finding, Gate, Standard, Tally, Variant, all, examine, is_run, tallies, trials,
};
use percuss_validation::suite::{PreparedCase, Suite, prepare};
use percuss_validation::truth::Library;

/// A few cases serve: chaos with all probes, the grazes, late cycles and impacts into progression.
const CASES: [&str; 6] = [
    "chaos-from-rest",
    "fig7a-chaos",
    "graze-overlap-1e-6",
    "impact-into-progression",
    "cycle-1e8",
    "stiff-xi-0-03",
];

fn prepared() -> Vec<PreparedCase> {
    exact::prepared(|name| CASES.contains(&name), Some(Suite::Quick))
}

/// A touch that the control's steps find and an integrator's longest pass by, wherever chaos leads:
/// that of the case with an overlap of 1e-3, made 1e-4 by a wider gap, from a start so much later
/// that two steps of a 24th period end half a step before its middle and half a step after it.
fn light_touch() -> Vec<PreparedCase> {
    let mut cases = embedded().expect("the cases are read").into_iter();
    let case = cases.find(|case| case.name == "graze-overlap-1e-3").expect("the case is there");
    let own = exact::problem(&case);
    let old = *own.model.parameters();
    let parameters = Parameters { g: old.g + 9e-4, ..old };
    let model = Model::new(parameters).expect("the case is checked");
    let entry = model.start(&own.start).expect("the case is checked");
    let [flight, touch] = [0, 1].map(|k| model.trajectory(entry).nth(k).expect("it touches"));
    let step = model.period() / 24.0;
    assert!(touch.duration() < 0.5 * step && touch.duration() > 4.0 * model.period() / 512.0);
    let later = (flight.duration() + 0.5 * (touch.duration() - step)) % step;
    let state = flight.at(later).state;
    let tau = own.start.tau + later;
    let start = Start { tau, p: state.p, y: state.y, q: Some(state.q), ..Start::default() };
    let given = Given { parameters, start, ..Given::default() };
    let case = exact::with_problem(&case, given.check().expect("the start is in range"));
    let case = Case { name: "light-touch".into(), ..case };
    let library = Library::embedded().expect("the tables are read").replaying();
    prepare(vec![case], &library, Some(Suite::Quick)).expect("the case is made ready")
}

/// The wrong engines whose faults show in no one way of running a case, and those that do.
fn split_by_way(all: &[WrongEngine]) -> Vec<WrongEngine> {
    all.iter().copied().filter(|it| it.way.is_none()).collect()
}

fn in_ways(all: &[WrongEngine]) -> Vec<WrongEngine> {
    all.iter().copied().filter(|it| it.way.is_some()).collect()
}

fn findings(wrong: &[WrongEngine], cases: &[PreparedCase], standard: Standard) -> Vec<Finding> {
    let defaults = defaults().expect("the bounds are read");
    wrong.iter().map(|it| examine(it, cases, standard, &defaults)).collect()
}

#[test]
fn every_fault_is_caught_and_every_gate_catches_one() {
    let cases = prepared();
    assert_eq!(cases.len(), CASES.len());
    let found = findings(&split_by_way(wrong()), &cases, EXACT_STANDARD);
    for finding in &found {
        println!("{} ({}): {:?}", finding.engine, finding.fault, finding.gates);
        assert!(finding.gates.values().any(|trip| trip.failed > 0), "{} passes", finding.engine);
    }
    for gate in Gate::ALL {
        let trips = found.iter().any(|finding| finding.gates[&gate].failed > 0);
        assert!(trips, "no fault trips {}", gate.name());
    }
}

/// It is the faults that are caught, not the plain solver that they are built into: without a fault
/// it stays within the bounds of a tolerance of 1e-9, but for touches shorter than its steps, and
/// with one it fails more.
#[test]
fn the_control_passes_where_the_faults_do_not() {
    let standard =
        Standard { engine: "ode_solvers-dopri5", accuracy: Accuracy::Tolerance(1e-9), unit: 1e-9 };
    let cases = prepared().into_iter().chain(light_touch());
    let (grazes, others): (Vec<_>, Vec<_>) =
        cases.partition(|it| it.case.name.starts_with("graze"));
    let control = WrongEngine { engine: CONTROL, fault: "none", way: None };
    for finding in findings(&[control], &others, standard) {
        assert!(!finding.is_caught(), "the control fails: {:?}", finding.gates);
    }
    let failed = |wrong: WrongEngine| -> usize {
        let cases = [&others, &grazes].into_iter();
        let all = cases.flat_map(|cases| findings(&[wrong], cases, LARGE_UNIT_STANDARD));
        all.flat_map(|it| it.gates.into_values()).map(|trip| trip.failed).sum()
    };
    let usual = failed(control);
    let stepping = wrong().iter().filter(|it| it.engine.declaration().method.contains("steps"));
    let stepping: Vec<_> = stepping.copied().collect();
    assert_eq!(stepping.len(), 5);
    for wrong in stepping {
        let name = wrong.engine.declaration().name;
        assert!(failed(wrong) > usual, "{name} fails no more than the control: {usual}");
    }
}

/// The exact solver's bounds, restarts included, with room for what steps and bisection lose.
const LARGE_UNIT_STANDARD: Standard =
    Standard { engine: "exact", accuracy: Accuracy::Exact, unit: 1e-9 };

/// Cases with every kind of event, one of which restarts.
const INTEGRATED_CASES: [&str; 6] = [
    "chaos-from-rest",
    "critical-xi-1",
    "fast-forcing",
    "graze-overlap-1e-3",
    "graze-overlap-1e-6",
    "impact-into-progression",
];

#[test]
fn every_fault_of_an_integrator_is_caught_and_none_of_the_sound_one() {
    let cases = exact::prepared(|name| INTEGRATED_CASES.contains(&name), Some(Suite::Quick));
    for standard in Standard::of_faulty() {
        let found = findings(&split_by_way(faulty()), &cases, standard);
        for finding in &found {
            println!("{} ({}): {:?}", finding.engine, finding.fault, finding.gates);
            let caught = finding.gates.values().any(|trip| trip.failed > 0);
            assert!(caught, "{}: {}", finding.engine, finding.fault);
        }
        for gate in Gate::ALL {
            let trips = found.iter().any(|finding| finding.gates[&gate].failed > 0);
            assert!(trips, "no fault of an integrator trips {}", gate.name());
        }
        let control = WrongEngine { engine: FAULTY_CONTROL, fault: "none", way: None };
        for finding in findings(&[control], &cases, standard) {
            assert!(!finding.is_caught(), "{} {:?}", finding.engine, finding.gates);
        }
    }
}

fn all_systems() -> Vec<PreparedCase> {
    exact::prepared_systems(|_| true)
}

/// A fault in a way of running a case is caught by cases that are run in that way, and by no other.
#[test]
fn faults_in_ways_of_running_are_caught_there_and_nowhere_else() {
    let cases = all_systems();
    let defaults = defaults().expect("the bounds are read");
    for (it, standard) in all().into_iter().filter(|(it, _)| it.way.is_some()) {
        let finding = examine(&it, &cases, standard, &defaults);
        let Finding { engine, fault, gates, failed_on, elsewhere, .. } = &finding;
        println!("{engine} ({fault}): {gates:?}, {failed_on:?}, elsewhere {elsewhere:?}");
        assert!(finding.is_caught(), "{engine}: {fault}");
        // An engine's own motion in chaos, which is judged too, may be run in any way.
        let is_chaotic = |name: &String| {
            let case = cases.iter().find(|it| it.case.name == *name).expect("a case");
            case.case.trouble.iter().any(|it| it == "chaos")
        };
        let all_chaotic = elsewhere.1.iter().all(is_chaotic);
        assert!(elsewhere.0 > 0 && all_chaotic, "{engine} {elsewhere:?}");
        // States between events are measured at no event.
        let at_events = gates[&Gate::Events].failed + gates[&Gate::EventErrors].failed;
        if it.way == Some(Way::OutputBetweenEvents) {
            assert!(at_events == 0 && gates[&Gate::StateErrors].failed > 0, "{engine} {gates:?}");
        }
    }
    for standard in Standard::of_faulty() {
        let way = Some(Way::Simultaneous);
        let control = WrongEngine { engine: FAULTY_ON_SYSTEMS_CONTROL, fault: "none", way };
        let Finding { failed_on, elsewhere, without_result, .. } =
            examine(&control, &cases, standard, &defaults);
        assert!(failed_on.is_empty() && elsewhere.1.is_empty(), "{failed_on:?} {elsewhere:?}");
        assert_eq!(without_result, 0);
    }
}

/// Events of one instant count as a set where their order is free: a run with all of them in the
/// other order is as good. Where the order matters it is not.
#[test]
fn events_of_one_instant_are_a_set_where_their_order_is_free() {
    let cases = all_systems();
    let defaults = defaults().expect("the bounds are read");
    let [last_first] = in_ways(wrong())[..] else { panic!("one of them turns the order") };
    let finding = examine(&last_first, &cases, EXACT_STANDARD, &defaults);
    let tied: Vec<_> = cases.iter().filter(|it| is_run(it, Way::Simultaneous)).collect();
    let [matters, free] = [true, false].map(|ordered| {
        let alike = tied.iter().filter(|it| it.truth.ordered == ordered);
        alike.map(|it| it.case.name.clone()).collect::<Vec<_>>()
    });
    assert!(free.len() > 5, "{free:?}");
    assert!(free.contains(&"spheres-meet".to_owned()), "{free:?}");
    assert_eq!(finding.failed_on, matters);
    assert!(!matters.is_empty());
}

/// Mistakes that at least 95 % of the answers show in which they spoil anything. Late times alone
/// and states off after events show from 300 tolerances on: after a restart right multistep methods
/// err by up to 100.
const CAUGHT_VARIANTS: [Variant; 16] = [
    Variant::Late(10.0),
    Variant::Late(100.0),
    Variant::TimesLate(300.0),
    Variant::TimesLate(1000.0),
    Variant::OneLate,
    Variant::Dropped(50),
    Variant::Swapped,
    Variant::OldState,
    Variant::LinearSamples,
    Variant::Noise(300.0),
    Variant::StatesOff,
    Variant::ColumnsSwapped,
    Variant::SamplesBehind,
    Variant::HalfHorizon,
    Variant::OneNaN,
    Variant::GarbageAfterAThird,
];

/// Mistakes that as many answers of methods other than multistep ones show.
const CAUGHT_ONE_STEP_VARIANTS: [Variant; 2] = [Variant::TimesLate(30.0), Variant::Noise(10.0)];

/// The kinds of mistakes that fewer than 95 % of the answers show.
fn too_few(tallies: &[Tally]) -> Vec<String> {
    let few = tallies.iter().filter(|it| it.spoiled == 0 || 20 * it.caught < 19 * it.spoiled);
    few.map(|it| {
        format!("{}: {} of {}; {:?}", it.variant.words(), it.caught, it.spoiled, it.missed_on)
    })
    .collect()
}

/// On set-ups and cases that set no limit wrong answers are caught, and no right one is condemned.
#[test]
fn wrong_answers_are_caught_where_no_limit_was_set() {
    let cases = exact::prepared(|_| true, Some(Suite::Quick));
    let classes = defaults().expect("the limits are read").classes;
    let variants = [&CAUGHT_VARIANTS[..], &CAUGHT_ONE_STEP_VARIANTS].concat();
    let mut made = trials(&cases, 1e-6, &classes, &variants);
    assert!(made.len() > 200, "{}", made.len());
    let condemned: Vec<_> =
        made.iter().filter(|it| it.is_condemned).map(|it| (it.engine, &it.case)).collect();
    assert!(condemned.is_empty(), "{condemned:?}");
    assert_eq!(too_few(&tallies(&made, &variants)[..CAUGHT_VARIANTS.len()]), Vec::<String>::new());
    made.retain(|it| it.engine != "diffsol-bdf");
    assert!(made.len() > 150, "{}", made.len());
    assert_eq!(too_few(&tallies(&made, &variants)[CAUGHT_VARIANTS.len()..]), Vec::<String>::new());
}
