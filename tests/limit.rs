//! The work of a search has a limit, and contacts that die out next to a threshold are decided
//! within it.

use percuss::insides::crossing::allowances::SLACK;
use percuss::insides::crossing::limit::{
    GRANTED_EVALUATIONS, LAST_ROOT_EVALUATIONS, MAX_EVALUATIONS,
};
use percuss::{Counters, Endless, Exit, Model, Parameters, Phase, Segment, Start};

fn first(parameters: Parameters, start: &Start) -> (Segment, Counters) {
    let model = Model::new(parameters).unwrap();
    let mut run = model.trajectory(model.start(start).unwrap());
    let segment = run.next().unwrap();
    (segment, run.counters())
}

/// A contact of the model without harmonic force, from this trial force and speed.
fn dying_contact(xi: f64, b: f64, f: f64, y: f64) -> (Segment, Counters) {
    let parameters = Parameters { a: 0.0, b, xi, ..Parameters::default() };
    let q = f - 2.0 * xi * y;
    let start = Start { p: q + parameters.g, y, q: Some(q), ..Start::default() };
    first(parameters, &start)
}

/// Evaluations that a decided contact may take: one stage of eight decay times takes up to four,
/// and as many divisions; 40 stages lead from 1 to 1e-139.
const MAX_DECIDED_EVALUATIONS: u64 = 600;

#[test]
fn what_dies_out_from_one_side_rests_for_ever() {
    for xi in [1.0_f64, 1.0 + 1e-9, 1.2, 1.459, 3.0, 7.3] {
        for b in [0.0, 5e-324, 1e-127, 1e-40, 1e-17] {
            // f' = -2 xi (f - b) + y, and the part that dies out last is positive.
            let (segment, counters) = dying_contact(xi, b, 0.12, 0.3);
            assert_eq!(
                *segment.exit(),
                Exit::Endless(Endless::RestsForEver),
                "{xi} {b:e} {segment:?}"
            );
            assert!(counters.evaluations <= 40, "{xi} {b:e} {counters:?}");
        }
    }
}

#[test]
fn what_dies_out_towards_a_pull_separates_when_nothing_else_is_left() {
    for xi in [1.1_f64, 1.2, 1.459, 3.0, 7.3] {
        let fast = xi + ((xi - 1.0) * (xi + 1.0)).sqrt();
        let slow = 1.0 / fast;
        for exponent in [17, 25, 40, 60, 90, 127] {
            let pull = 10.0_f64.powi(-exponent);
            let (f, y) = (0.12, 0.1);
            let (segment, counters) = dying_contact(xi, -pull, f, y);
            // f + pull = s exp(-slow d) + k exp(-fast d), of which the second is gone.
            let rate = y - 2.0 * xi * f;
            let s = (rate + fast * f) / (fast - slow);
            let expected = (s / pull).ln() / slow;
            assert!(
                matches!(segment.exit(), Exit::Switch(next) if next.phase() == Phase::NoContact)
            );
            // A stage of eight decay times hands on the guard's rounding room, SLACK of its largest
            // term 2 xi y with y = fast f, while f shrinks by e^8. The exponents' own rounding
            // comes on top.
            let stages = (slow * expected / 8.0).ceil();
            let handed_on = SLACK * 2.0 * xi * fast * 8.0_f64.exp() * stages;
            let room = handed_on / slow + f64::EPSILON * 64.0 * expected;
            let off = (segment.duration() - expected).abs();
            assert!(off <= room, "{xi} {pull:e}: {} for {expected}", segment.duration());
            assert!(counters.evaluations <= MAX_DECIDED_EVALUATIONS, "{xi} {pull:e}: {counters:?}");
            assert_eq!(counters.undecidable, 0, "{xi} {pull:e}");
        }
    }
}

#[test]
fn next_to_the_upper_threshold_it_is_decided_alike() {
    // f comes from below.
    let (segment, _) = dying_contact(1.2, 1.0 - f64::EPSILON / 2.0, 0.9, -0.1);
    assert_eq!(*segment.exit(), Exit::Endless(Endless::RestsForEver));
    let (segment, _) = dying_contact(1.2, 1.0, 0.9, -0.1);
    assert_eq!(*segment.exit(), Exit::Endless(Endless::RestsForEver));
    for beyond in [f64::EPSILON, 1e-15, 1e-12] {
        let (segment, counters) = dying_contact(1.2, 1.0 + beyond, 0.9, -0.1);
        let next = segment.exit();
        assert!(
            matches!(next, Exit::Switch(next) if next.phase() == Phase::Progression),
            "{next:?}"
        );
        assert!(counters.evaluations <= MAX_DECIDED_EVALUATIONS, "{counters:?}");
    }
}

/// Free and forced oscillation in step, three to one, which together stay inside although their
/// amplitudes do not, and die out within 1e8 units of time: nothing but following them shows it.
fn oscillations_in_step() -> (Parameters, Start) {
    let (xi, omega, amplitude) = (1e-8, 2.0, 0.28);
    let parameters = Parameters { a: 3.0 * amplitude, b: 0.5, xi, omega, ..Parameters::default() };
    // f = b + A cos t + A sin 2t
    let (f, rate) = (0.5 + amplitude, 2.0 * amplitude);
    let y = rate - 2.0 * xi * (parameters.b - f);
    let q = f - 2.0 * xi * y;
    (parameters, Start { p: q + parameters.g, y, q: Some(q), ..Start::default() })
}

#[test]
fn a_search_that_passes_its_limit_leaves_the_phase_undecidable() {
    let (parameters, start) = oscillations_in_step();
    let (segment, counters) = first(parameters, &start);
    assert_eq!(*segment.exit(), Exit::Undecidable);
    assert!(
        (MAX_EVALUATIONS..=MAX_EVALUATIONS + GRANTED_EVALUATIONS + LAST_ROOT_EVALUATIONS)
            .contains(&counters.evaluations),
        "{counters:?}"
    );
    // What is proved of it goes far, but not until the two amplitudes together fit inside: 0.28 of
    // the free one has then become 0.22.
    let fits = (0.28_f64 / 0.22).ln() / 1e-8;
    assert!(segment.duration() > 1e5 && segment.duration() < fits, "{}", segment.duration());
    let model = Model::new(parameters).unwrap();
    let entry = model.start(&start).unwrap();
    let mut run = model.trajectory(entry);
    assert!(run.next().is_some() && run.next().is_none() && run.step().is_none());
    let proved = segment.entry().instant.after(segment.duration_two_word(), parameters.omega);
    assert!(!segment.is_undecided_at(&proved.clone()));
    assert!(segment.is_undecided_at(&proved.after_periods(1, 1)));
}

#[test]
fn a_horizon_holds_in_a_phase_that_has_no_decided_end() {
    let (parameters, start) = oscillations_in_step();
    let model = Model::new(parameters).unwrap();
    let entry = model.start(&start).unwrap();
    for periods in [0, 1, 1000] {
        let horizon = entry.instant.after_periods(periods, 1);
        let mut run = model.trajectory(entry).until(horizon);
        let segment = run.next().unwrap();
        assert_eq!(*segment.exit(), Exit::Horizon, "{periods}");
        // The work is that of the time asked for.
        let most = GRANTED_EVALUATIONS as f64 + 64.0 * 3.0 * periods as f64 * model.period();
        assert!((run.counters().evaluations as f64) < most, "{periods} {:?}", run.counters());
    }
}

#[test]
fn sections_end_where_a_run_is_undecidable() {
    use percuss::dynamics::section::Section;
    let (parameters, start) = oscillations_in_step();
    let model = Model::new(parameters).unwrap();
    let entry = model.start(&start).unwrap();
    let far = entry.instant.after_periods(1 << 40, 1);
    assert!(Section::along(model.trajectory(entry), far).next().is_none());
    assert!(Section::along(model.trajectory(entry), entry.instant).next().is_some());
}

/// Forces of 1e-284: the trial force touches zero once a free oscillation to within 6e-8 of its
/// size, far above its rounding. A room for underflow that does not follow the force hides that.
#[test]
fn touches_of_the_smallest_forces_are_decided() {
    let parameters = Parameters { a: 1.07e-284, b: 0.0, xi: 1e-8, omega: 1e-6, g: 0.0, phi: 0.0 };
    let start = Start { cycle: 1 << 53, phase: Some(Phase::Contact), ..Start::default() };
    let model = Model::new(parameters).unwrap();
    let entry = model.start(&start).unwrap();
    let mut run = model.trajectory(entry).until(entry.instant.after_periods(1, 1000));
    assert!(run.by_ref().count() >= 1);
    let counters = run.counters();
    assert_eq!(counters.undecidable, 0, "{counters:?}");
    // One thousandth of a period is a thousand free oscillations; each dip is divided at its crest.
    assert!(counters.evaluations < 20_000, "{counters:?}");
}
