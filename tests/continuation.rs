//! Branches of orbits: where they turn and double, held against runs on both sides, other sections
//! and theory.

use percuss::dynamics::continuation::{
    Bifurcation, BifurcationKind, Branch, BranchEnding, Criticality, Doubling, Family,
};
use percuss::dynamics::linear::modulus;
use percuss::dynamics::orbit::{Orbit, scan};
use percuss::dynamics::strobe::{StrobeMap, StrobePoint};
use percuss::{Instant, Parameter, Parameters};

fn family(angle: f64) -> Family {
    let parameters = Parameters { xi: 0.1, ..Parameters::default() };
    Family::new(parameters, Parameter::Omega, Instant::at(1.0, angle, 0))
}

/// The stable orbit of a period at a value.
fn stable(family: &Family, value: f64, period: u32) -> Orbit {
    let orbit = scan(&family.map(value).unwrap(), period, &mut |_| {}).remove(0);
    assert!(orbit.is_stable() && orbit.period() == period, "{orbit:?}");
    orbit
}

fn follow(family: &Family, period: u32, from: f64, to: f64) -> Branch {
    let guess = stable(family, from, period).points[0];
    Branch::follow(family, guess, period, from, to, &mut |_| {}).unwrap()
}

fn only_bifurcation(branch: &Branch, kind: BifurcationKind) -> &Bifurcation {
    let mut found = branch.bifurcations.iter().filter(|it| it.kind == kind);
    let first = found.next().unwrap();
    assert!(found.next().is_none(), "{:?}", branch.bifurcations);
    first
}

/// After how many forcing periods, at most 64, the motion that has settled from a point closes.
fn settled_period(map: &StrobeMap, start: StrobePoint, periods: u64) -> Option<usize> {
    let entry = map.entry(start).unwrap();
    let last: Vec<_> =
        map.strobes(entry, periods + 64).skip(periods as usize).map(|it| it.point()).collect();
    (1..=64).find(|n| (0..3).all(|i| (last[*n][i] - last[0][i]).abs() <= 1e-8))
}

/// The stable one of the two orbits next to a fold: Newton's method goes from there to either, and
/// the other one lies as far on the other side.
fn stable_beside(map: &StrobeMap, fold: StrobePoint, period: u32) -> Orbit {
    let found = Orbit::find(map, fold, period).unwrap();
    if found.is_stable() {
        return found;
    }
    let across = std::array::from_fn(|i| 2.0 * fold[i] - found.points[0][i]);
    Orbit::find(map, across, period).unwrap()
}

/// Ten digits are promised; a good place keeps fourteen.
fn assert_sharp(found: &Bifurcation) {
    assert!(found.error <= 1e-10 * found.value.abs(), "{found:?}");
}

#[test]
fn period_four_ends_in_a_fold_and_runs_agree_on_both_sides() {
    let family = family(0.0);
    let branch = follow(&family, 4, 1.56, 1.6);
    // It comes back unstable.
    assert_eq!(branch.ending, BranchEnding::Left);
    let fold = only_bifurcation(&branch, BifurcationKind::Fold);
    assert_sharp(fold);
    let leading = fold.orbit.multipliers[0];
    // The multiplier is one to the root of what the parameter's value is off by.
    assert!(modulus([leading[0] - 1.0, leading[1]]) <= 1e-6, "{leading:?}");
    let start = fold.orbit.points[0];
    for (value, closes) in [(fold.value - 1e-6, true), (fold.value + 1e-4, false)] {
        let map = family.map(value).unwrap();
        // Near the fold all is slow: 1 - mu is about the root of the distance.
        let beside = if closes { stable_beside(&map, start, 4).points[0] } else { start };
        let found = settled_period(&map, beside, 20_000);
        assert_eq!(found == Some(4), closes, "{value}: {found:?}");
    }
    // Both halves of the branch are orbits at one value, one stable.
    let middle = |stable: bool| {
        let mut points = branch.points.iter();
        points.any(|it| it.orbit.is_stable() == stable && (it.value - 1.57).abs() < 5e-3)
    };
    assert!(middle(true) && middle(false));
}

#[test]
fn period_six_doubles_supercritically_and_runs_agree_on_both_sides() {
    let family = family(0.0);
    let branch = follow(&family, 6, 1.6, 1.56);
    assert!(branch.is_complete());
    let flip = only_bifurcation(&branch, BifurcationKind::Flip);
    assert_sharp(flip);
    let doubling = Doubling::new(&family, flip, 1.6, 1.56, &mut |_| {}).unwrap();
    assert_eq!(doubling.criticality, Criticality::Supercritical);
    let first = &doubling.branch.points[0];
    assert!(first.orbit.period() == 12 && first.orbit.is_stable() && first.value < flip.value);
    for (value, period) in [(flip.value + 2e-5, 6), (flip.value - 2e-5, 12)] {
        let found = settled_period(&family.map(value).unwrap(), first.orbit.points[0], 60_000);
        assert_eq!(found, Some(period), "{value}");
    }
}

#[test]
fn period_six_is_born_at_the_flip_of_period_three_from_either_side() {
    let family = family(0.0);
    let six = follow(&family, 6, 1.6, 1.7);
    let three = follow(&family, 3, 1.7, 1.6);
    let flip = only_bifurcation(&three, BifurcationKind::Flip);
    assert_sharp(flip);
    let BranchEnding::Halved { value } = six.ending else { panic!("{:?}", six.ending) };
    let merged = only_bifurcation(&six, BifurcationKind::Flip);
    assert!((value - flip.value).abs() <= flip.error + merged.error, "{value} {flip:?}");
    let doubling = Doubling::new(&family, flip, 1.7, 1.6, &mut |_| {}).unwrap();
    assert_eq!(doubling.criticality, Criticality::Supercritical);
    let last = doubling.branch.points.last().unwrap();
    let direct = &six.points[0];
    assert_eq!((last.value, direct.value), (1.6, 1.6));
    let near = |a: &StrobePoint, b: &StrobePoint| (0..3).all(|i| (a[i] - b[i]).abs() <= 1e-12);
    assert!(last.orbit.points.iter().any(|it| near(it, &direct.orbit.points[0])));
}

/// The values do not depend on where the orbits are looked at, within their errors.
#[test]
fn another_section_finds_the_same_values() {
    let wanted = [
        (4, 1.56, 1.6, BifurcationKind::Fold),
        (6, 1.6, 1.56, BifurcationKind::Flip),
        (5, 1.6, 1.59, BifurcationKind::Flip),
    ];
    for (period, from, to, kind) in wanted {
        let found = [0.0, 1.3, 2.9, 4.4].map(|angle| {
            let branch = follow(&family(angle), period, from, to);
            let found = only_bifurcation(&branch, kind);
            (found.value, found.error)
        });
        for (value, error) in found {
            let (first, first_error) = found[0];
            assert!((value - first).abs() <= 2.0 * (error + first_error), "{found:?}");
        }
    }
}

/// Parameters at which a branch of unstable or stable orbits meets a graze of an impact, and where
/// it goes.
fn corner(parameters: Parameters, parameter: Parameter, to: f64, period: u32) -> (Family, Branch) {
    let family = Family::new(parameters, parameter, Instant::at(1.0, 0.7, 0));
    let from = parameter.of(&parameters);
    let map = family.map(from).unwrap();
    let rest = map.entry([0.0; 3]).unwrap();
    let settled = map.strobes(rest, 200).last().unwrap();
    let branch = Branch::follow(&family, settled.point(), period, from, to, &mut |_| {}).unwrap();
    (family, branch)
}

#[test]
fn at_a_graze_a_branch_may_turn_back_with_other_multipliers() {
    let parameters = Parameters {
        a: 0.2743379492565635,
        b: 0.10360219374159782,
        xi: 0.3166314364877223,
        omega: 0.2094436643956773,
        g: 0.0738363457858609,
        ..Parameters::default()
    };
    let (family, branch) = corner(parameters, Parameter::A, 0.5 * parameters.a, 1);
    assert!(branch.is_complete(), "{}", branch.ending);
    let turn = branch
        .bifurcations
        .iter()
        .find(|it| it.kind == BifurcationKind::Grazing && it.turns)
        .unwrap();
    assert_sharp(turn);
    let beyond = turn.beyond.as_ref().unwrap();
    // No multiplier has passed one: it has leapt from one side of it to the other.
    assert!(turn.orbit.multipliers[0][0] > 4.0 && beyond.multipliers[0][0] < -5.0, "{turn:?}");
    assert_eq!(beyond.phases.len(), turn.orbit.phases.len() + 2);
    // Two orbits on one side, with and without the touch, and none of them on the other.
    let near = |value: f64| {
        let map = family.map(value).unwrap();
        [&turn.orbit, beyond].map(|orbit| {
            Orbit::find(&map, orbit.points[0], 1)
                .is_ok_and(|it| (it.points[0][0] - orbit.points[0][0]).abs() < 1e-2)
        })
    };
    assert_eq!(near(turn.value - 1e-7), [true; 2]);
    assert_eq!(near(turn.value + 1e-7), [false; 2]);
}

#[test]
fn every_orbit_of_a_branch_closes_and_no_step_misses_a_crossing() {
    for (period, from, to) in [(4, 1.4, 1.6), (5, 1.6, 1.5), (12, 1.45, 1.43)] {
        let family = family(0.0);
        let branch = follow(&family, period, from, to);
        for point in &branch.points {
            assert!(point.orbit.residual <= 64.0 * f64::EPSILON, "{:?}", point.orbit);
            assert_eq!(point.orbit.period(), period);
        }
        // Stability changes as often as folds and flips were found.
        let changes = branch
            .points
            .windows(2)
            .filter(|pair| pair[0].orbit.is_stable() != pair[1].orbit.is_stable())
            .count();
        assert_eq!(changes, branch.bifurcations.len(), "{:?}", branch.bifurcations);
    }
}

#[test]
fn there_and_back_again() {
    let family = family(0.0);
    let there = follow(&family, 5, 1.6, 1.5);
    let last = there.points.last().unwrap();
    assert_eq!(last.value, 1.5);
    let back = Branch::follow(&family, last.orbit.points[0], 5, 1.5, 1.6, &mut |_| {}).unwrap();
    let (a, b) = (&there.points[0].orbit.points[0], &back.points.last().unwrap().orbit.points[0]);
    assert!((0..3).all(|i| (a[i] - b[i]).abs() <= 1e-13), "{a:?} {b:?}");
    let (a, b) = (
        only_bifurcation(&there, BifurcationKind::Flip),
        only_bifurcation(&back, BifurcationKind::Flip),
    );
    assert!((a.value - b.value).abs() <= a.error + b.error, "{a:?} {b:?}");
}

#[test]
fn an_interval_of_no_length_is_its_orbit() {
    let family = family(0.0);
    let branch = follow(&family, 4, 1.4, 1.4);
    assert!(branch.is_complete() && branch.points.len() == 1);
}

/// b = 1 is where the slider's mean force reaches the threshold: no orbit exists beyond.
#[test]
fn a_branch_without_end_says_where_it_was_lost() {
    let parameters = Parameters { xi: 0.1, omega: 0.9, a: 0.1, b: 0.5, ..Parameters::default() };
    let (_, branch) = corner(parameters, Parameter::B, 1.2, 1);
    let BranchEnding::Lost { value } = branch.ending else { panic!("{}", branch.ending) };
    assert!((value - 1.0).abs() <= 1e-6, "{value}");
}
