//! The strobe map against the run it is made from.

use crate::support::random::Draw;
use percuss::dynamics::strobe::StrobeMap;
use percuss::{Entry, Exit, GrowthRecorder, Instant, Model, Parameters, Phase, Start};

/// Roundings of a phase taken up again: the state's, and those of the form evaluated from there;
/// the solver's own constant is 0.5 (`validate`).
const MAX_ROUNDINGS: f64 = 16.0;

fn models() -> Vec<Model> {
    let paper = Parameters::default();
    [
        paper,
        Parameters { omega: 0.1, ..paper },
        Parameters { xi: 0.1, omega: 1.6, ..paper },
        Parameters { xi: 0.5, a: 2.0, b: 0.6, omega: 0.9, ..paper },
        Parameters { xi: 1.0, a: 3.0, b: 0.5, omega: 2.0, ..paper },
        Parameters { xi: 20.0, a: 8.0, b: 0.5, omega: 1.1, ..paper },
        Parameters { a: 0.05, b: 0.5, xi: 0.1, omega: 0.7, ..paper },
    ]
    .map(|parameters| Model::new(parameters).unwrap())
    .to_vec()
}

fn from_rest(model: &Model) -> Entry {
    model.start(&Start::default()).unwrap()
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs() / (1.0 + b.abs())).fold(0.0, f64::max)
}

/// Every phase, cut anywhere: the part that is left ends where the whole does.
#[test]
fn a_phase_taken_up_again_ends_where_it_would_have() {
    let mut draw = Draw(7);
    let mut seen = std::collections::BTreeMap::<Phase, usize>::new();
    for model in models() {
        let omega = model.parameters().omega;
        for segment in model.trajectory(from_rest(&model)).take(400) {
            let Exit::Switch(next) = segment.exit() else { break };
            let share = draw.decades(1e-12, 1.0);
            let share = if draw.once_in(2) { share } else { 1.0 - share };
            let cut = segment
                .entry()
                .instant
                .after(percuss::TwoWord::new(share * segment.duration()), omega);
            if segment.ends_by(&cut) {
                continue;
            }
            let entry = segment.entry_at(&cut);
            let again = model.trajectory(entry).next().unwrap();
            // Next to a switch the phase may already be the next one.
            let (end, next_phase) = if again.phase() == segment.phase() {
                let Exit::Switch(end) = *again.exit() else { panic!("the rest has no end") };
                (end, end.phase())
            } else {
                (entry, entry.phase())
            };
            assert_eq!(next_phase, next.phase());
            let mut recorder = GrowthRecorder::new();
            let growth = recorder.pass(&again).map_or(1.0, |growth| growth.tau.max(1.0));
            let size = 1.0 + segment.duration();
            let late = end.instant.since(&next.instant, omega).value().abs();
            let allowed = MAX_ROUNDINGS * f64::EPSILON * size * growth;
            assert!(
                late <= allowed,
                "{:?} {share}: {late:e}, allowed {allowed:e}",
                segment.entry()
            );
            *seen.entry(segment.phase()).or_default() += 1;
        }
    }
    for phase in Phase::ALL {
        assert!(seen[&phase] > 100, "{phase}: {seen:?}");
    }
}

#[test]
fn strobes_are_the_samples_of_the_run() {
    for model in models() {
        let start = from_rest(&model);
        let map = StrobeMap::new(model, start.instant);
        let end = start.instant.after_periods(30, 1);
        let segments: Vec<_> = model.trajectory(start).until(end).collect();
        let strobes: Vec<_> = map.strobes(start, 30).collect();
        assert_eq!(strobes.len(), 31);
        for (n, strobe) in strobes.iter().enumerate() {
            let instant = start.instant.after_periods(n as u64, 1);
            assert_eq!(strobe.instant, instant);
            let segment = segments.iter().find(|segment| !segment.ends_by(&instant)).unwrap();
            let sample = segment.at_instant(&instant);
            let state = [sample.state.p, sample.state.y, sample.state.q];
            assert!(
                distance(strobe.point(), state) <= 4.0 * f64::EPSILON,
                "{n}: {strobe:?} {sample:?}"
            );
            assert!((strobe.v() - sample.v).abs() <= 4.0 * f64::EPSILON * (1.0 + sample.v));
        }
    }
}

/// One period after the other, each taken up again where the last ended, stays with the run as long
/// as the run's own derivative lets it.
#[test]
fn periods_one_by_one_are_the_run() {
    for model in models() {
        let start = from_rest(&model);
        let map = StrobeMap::new(model, start.instant);
        let mut entry = start;
        for periods in 1..=12 {
            entry = map.passage(&entry, 1).image;
            let whole = map.passage(&start, periods);
            let growth = (1..=periods)
                .map(|n| map.passage(&map.passage(&start, periods - n).image, n))
                .flat_map(|passage| passage.derivative.into_iter().flatten())
                .fold(1.0_f64, |largest, slope| largest.max(slope.abs()));
            let apart = distance(entry.point(), whole.point());
            let allowed = MAX_ROUNDINGS * f64::EPSILON * growth * periods as f64;
            assert!(apart <= allowed, "{:?} {periods}: {apart:e} {allowed:e}", model.parameters());
            let drift = (entry.v() - whole.image.v()).abs() / (1.0 + entry.v().abs());
            assert!(drift <= allowed, "{periods}: drift {drift:e} {allowed:e}");
        }
    }
}

/// The model depends on time through the forcing angle alone.
#[test]
fn the_map_is_the_same_at_every_cycle() {
    for model in models() {
        let omega = model.parameters().omega;
        let [early, late] = [0, 1 << 50].map(|cycle| {
            let map = StrobeMap::new(model, Instant::at(omega, 0.3, cycle));
            let entry = map.entry([-0.2, 0.4, 0.01]).unwrap();
            map.passage(&entry, 3)
        });
        assert_eq!(early.point(), late.point());
        assert_eq!(early.derivative, late.derivative);
        assert_eq!(early.phases, late.phases);
    }
}

#[test]
fn a_mass_beyond_the_slider_takes_it_along() {
    let model = models()[0];
    let map = StrobeMap::new(model, Instant::at(1.4, 0.0, 0));
    let entry = map.entry([0.4, 0.1, 0.0]).unwrap();
    assert_eq!(entry.phase(), Phase::Contact);
    assert!((entry.state.q - (0.4 - 0.02)).abs() <= f64::EPSILON);
    assert!(map.entry([f64::NAN, 0.0, 0.0]).is_err());
    assert!(map.entry([2e9, 0.0, 0.0]).is_err());
}
