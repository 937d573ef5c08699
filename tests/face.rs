//! The library's interface beside the runs themselves: horizons in time and in forcing periods,
//! names, and serialized parameters.

use percuss::dynamics::{attractor, continuation};
use percuss::{Endless, Exit, InputError, Instant, Model, Parameter, Parameters, Phase, Start};

fn model() -> Model {
    Model::new(Parameters::default()).unwrap()
}

#[test]
fn a_run_ends_at_a_time_and_after_forcing_periods() {
    let model = model();
    let rest = model.start(&Start { tau: 3.0, ..Start::default() }).unwrap();
    let end = |run: percuss::Trajectory| {
        let last = run.last().unwrap();
        model.time(&last.entry().instant) + last.duration()
    };
    let at = end(model.trajectory(rest).until_time(50.0).unwrap());
    // A sum of two rounded numbers.
    assert!((at - 50.0).abs() <= 4.0 * f64::EPSILON * 50.0, "{at}");
    let after = end(model.trajectory(rest).for_periods(7));
    let expected = 3.0 + 7.0 * model.period();
    assert!((after - expected).abs() <= 4.0 * f64::EPSILON * expected, "{after} {expected}");
}

#[test]
fn periods_are_counted_from_the_phase_that_comes_next() {
    let model = model();
    let rest = model.start(&Start::default()).unwrap();
    let mut run = model.trajectory(rest);
    run.next().unwrap();
    let begun = run.clone().next().unwrap().entry().instant;
    let last = run.for_periods(3).last().unwrap();
    let end = last.entry().instant.after(last.duration_two_word(), 1.4);
    let apart = end.since(&begun.after_periods(3, 1), 1.4).value();
    // The instant, the duration and their sum round once each.
    assert!(apart.abs() <= 8.0 * f64::EPSILON * 3.0 * model.period(), "{apart:e}");
}

#[test]
fn a_time_that_is_none_is_refused() {
    let rest = model().start(&Start::default()).unwrap();
    for tau in [f64::NAN, f64::INFINITY, -2e15] {
        let refused = model().trajectory(rest).until_time(tau).unwrap_err();
        assert!(matches!(refused, InputError::OutOfRange { name: "tau", .. }), "{refused}");
    }
}

#[test]
fn a_horizon_that_is_past_leaves_a_phase_of_no_length() {
    let model = model();
    let rest = model.start(&Start { tau: 3.0, ..Start::default() }).unwrap();
    let mut begun = model.trajectory(rest);
    begun.by_ref().take(5).for_each(drop);
    for run in [
        model.trajectory(rest).until_time(-50.0).unwrap(),
        model.trajectory(rest).for_periods(0),
        begun.until_time(3.0).unwrap(),
    ] {
        let left: Vec<_> = run.collect();
        assert_eq!((left.len(), left[0].duration(), *left[0].exit()), (1, 0.0, Exit::Horizon));
    }
}

#[test]
fn a_run_that_is_over_stays_over() {
    fn is_fused(_: &impl std::iter::FusedIterator) {}
    let model = model();
    let rest = model.start(&Start::default()).unwrap();
    let mut run = model.trajectory(rest).for_periods(1);
    is_fused(&run);
    while run.next().is_some() {}
    assert!(run.next().is_none());
}

#[test]
fn the_time_of_an_instant_is_its_tau() {
    let instant = Instant::at(1.4, 2.75, 3);
    let expected = 2.75 + 3.0 * model().period();
    assert!((model().time(&instant) - expected).abs() <= 4.0 * f64::EPSILON * expected);
}

#[test]
fn names_are_read_back() {
    for phase in Phase::ALL {
        assert_eq!(phase.to_string().parse(), Ok(phase));
    }
    for parameter in Parameter::ALL {
        assert_eq!(parameter.to_string().parse(), Ok(parameter));
    }
    let unknown = "zeta".parse::<Parameter>().unwrap_err().to_string();
    assert_eq!(unknown, "\"zeta\" is no parameter: accepted are a, b, xi, omega, g, phi");
    assert_eq!(format!("{:>14}|", Endless::NeverStops), "   never stops|");
    for endless in Endless::ALL {
        assert_eq!(endless.to_string().parse(), Ok(endless));
    }
    for kind in attractor::AttractorKind::ALL {
        assert_eq!(kind.to_string().parse(), Ok(kind));
    }
    for kind in continuation::BifurcationKind::ALL {
        assert_eq!(kind.to_string().parse(), Ok(kind));
    }
    #[cfg(feature = "affine")]
    for direction in percuss::affine::Direction::ALL {
        assert_eq!(direction.to_string().parse(), Ok(direction));
    }
    #[cfg(feature = "lanes")]
    for set in percuss::lanes::Instructions::available() {
        assert_eq!(set.to_string().parse(), Ok(set));
    }
    assert_eq!(attractor::AttractorKind::QuasiPeriodic.as_str(), "quasi-periodic");
    let unknown = "cusp".parse::<continuation::BifurcationKind>().unwrap_err().to_string();
    let accepted =
        "accepted are fold, flip, neimark-sacker, grazing, corner, event-gained, event-lost";
    assert_eq!(unknown, format!("\"cusp\" is no kind of bifurcation: {accepted}"));
}

#[cfg(feature = "serde")]
#[test]
fn what_is_serialized_is_read_back() {
    use percuss::{Counters, Growth, Sample, State};
    fn comes_back<T>(value: &T)
    where
        T: serde::Serialize + serde::de::DeserializeOwned + PartialEq + std::fmt::Debug,
    {
        let text = serde_json::to_string(value).unwrap();
        assert_eq!(&serde_json::from_str::<T>(&text).unwrap(), value, "{text}");
    }
    let state = State { p: 0.1 + 0.2, y: -1e-300, q: 1.0 / 3.0 };
    comes_back(&Parameters { xi: 0.1, ..Parameters::default() });
    comes_back(&Start { q: Some(0.25), phase: Some(Phase::NoContact), ..Start::default() });
    comes_back(&Sample { state, v: 2.5 });
    comes_back(&Counters { switches: 3, ..Counters::default() });
    comes_back(&Growth { tau: 1.0, state: [2.0, 3.0, 4.0], v: 5.0 });
    fn are_written_as_named<T: serde::Serialize + std::fmt::Display>(all: &[T]) {
        for it in all {
            assert_eq!(serde_json::to_string(it).unwrap(), format!("\"{it}\""));
        }
    }
    are_written_as_named(&Phase::ALL);
    are_written_as_named(&Parameter::ALL);
    are_written_as_named(&Endless::ALL);
    are_written_as_named(&attractor::AttractorKind::ALL);
    are_written_as_named(&continuation::BifurcationKind::ALL);
    comes_back(&Endless::NeverReturns);
    comes_back(&continuation::BifurcationKind::NeimarkSacker);
    let start: Start = serde_json::from_str("{\"p\": 0.5}").unwrap();
    assert_eq!(start, Start { p: 0.5, ..Start::default() });
    let refused = serde_json::from_str::<Parameters>("{\"zeta\": 1}").unwrap_err().to_string();
    assert!(refused.contains("zeta"), "{refused}");
    let parameters: Parameters = serde_json::from_str("{\"omega\": 1.6}").unwrap();
    assert_eq!(parameters, Parameters { omega: 1.6, ..Parameters::default() });
}
