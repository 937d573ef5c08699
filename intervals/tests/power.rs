//! Right claims are confirmed, and wrong ones refuted: later roots, roots off by a little, other
//! parameters.

#![allow(clippy::unwrap_used, reason = "a panic is a failed test")]

use percuss::TwoWord;
use percuss::insides::Motion;
use percuss::insides::crossing::Guarded;
use percuss::{Model, Parameters};
use percuss_intervals::frame::Frame;
use percuss_intervals::proof::{Claim, MAX_SLACKS, Verdict, examine};
use percuss_intervals::regimes::{Chance, REGIMES};
use percuss_intervals::tally::{Found, Tally};

/// Examines the events of every regime in turn.
fn every_event(runs: usize, mut look: impl FnMut(&Parameters, &Found<'_>)) {
    for (number, regime) in REGIMES.iter().enumerate() {
        let mut chance = Chance::new(77 + number as u64);
        for _ in 0..runs {
            for (parameters, start) in (regime.draw)(&mut chance) {
                let Ok(model) = Model::new(parameters) else { continue };
                let Ok(entry) = model.start(&start) else { continue };
                for segment in model.trajectory(entry).take(regime.phases.min(12)) {
                    if let Some(found) = Found::new(&segment) {
                        look(&parameters, &found);
                    }
                }
            }
        }
    }
}

/// A later time at which the f64 guard leaves its corridor once more, after an excursion of this
/// height.
fn later_root(found: &Found<'_>) -> Option<(f64, f64)> {
    match found.segment.motion() {
        Motion::NoContact(it) => later_place(&it, &found.claim),
        Motion::Contact(it) => later_place(&it, &found.claim),
        Motion::Progression(it) => later_place(&it, &found.claim),
    }
}

fn later_place<G: Guarded>(phase: &G, claim: &Claim) -> Option<(f64, f64)> {
    const PLACES: i32 = 2000;
    let excess = |d: f64| {
        let value = phase.at(d).guard.orders[0];
        if claim.rises { value - claim.corridor.high } else { claim.corridor.low - value }
    };
    let from = claim.duration.high;
    let place = |k: i32| from + 20.0 * f64::from(k) / f64::from(PLACES);
    let mut height = 0.0_f64;
    for k in 1..PLACES {
        let (mut inside, mut outside) = (place(k), place(k + 1));
        height = height.max(excess(inside));
        if excess(inside) < 0.0 && excess(outside) >= 0.0 {
            for _ in 0..60 {
                let middle = 0.5 * (inside + outside);
                if excess(middle) < 0.0 { inside = middle } else { outside = middle }
            }
            return Some((outside, height));
        }
    }
    None
}

#[test]
fn switches_of_all_regimes_are_confirmed() {
    let mut total = Tally::default();
    for (number, regime) in REGIMES.iter().enumerate() {
        let switches = (20_000.0 * regime.share) as u64;
        let tally = Tally::new(regime, switches, &mut Chance::new(5 + number as u64));
        assert_eq!(tally.contradicted, 0, "{}: {:?}", regime.name, tally.examples);
        // SLACK, in eps.
        assert!(tally.rounding <= 4.0, "{}: {}", regime.name, tally.rounding);
        total.add(&tally);
    }
    assert!(total.holds() && total.switches >= 19_000, "{}", total.row("all"));
}

/// The closed form goes on after the event: where it crosses again a solver that passes crossings
/// would land.
#[test]
fn a_later_root_is_refuted() {
    let mut refuted = 0;
    every_event(6, |parameters, found| {
        let Some((root, height)) = later_root(found) else { return };
        // An excursion that rounding hides is no fault.
        if height <= 4.0 * MAX_SLACKS * found.claim.slack {
            return;
        }
        let claim = Claim { duration: TwoWord::new(root), ..found.claim };
        let verdict = examine(&found.guard(&Frame::new(parameters)), &claim);
        assert!(matches!(verdict, Verdict::Earlier { .. }), "{verdict:?} {claim:?}");
        refuted += 1;
    });
    println!("{refuted} later roots");
    assert!(refuted > 300, "{refuted}");
}

/// A root that is off by more than the rounding of its guard explains.
#[test]
fn a_root_that_is_off_is_refuted() {
    let (mut refuted, mut passed) = (0, 0);
    every_event(4, |parameters, found| {
        let (frame, duration) = (Frame::new(parameters), found.claim.duration);
        let guard = found.guard(&frame);
        for share in [1e-9, -1e-9] {
            let duration = duration.plus(TwoWord::new(share * duration.high));
            let claim = Claim { duration, ..found.claim };
            match examine(&guard, &claim) {
                Verdict::Confirmed { residual } => {
                    // Soon after the entry, or next to a graze, the guard hardly moves in that
                    // time.
                    assert!(residual <= MAX_SLACKS, "{residual}");
                    passed += 1;
                }
                _ => refuted += 1,
            }
        }
    });
    println!("{refuted} refuted, {passed} within rounding");
    assert!(refuted > 50 * passed && refuted > 1000, "{refuted} {passed}");
}

/// The intervals know the parameters: with xi off by 1e-9, a million times the rounding, nearly all
/// switches are not where they were. The rest are of guards that do not know xi, over a slider at
/// rest, or that are too short to tell.
#[test]
fn other_parameters_are_refuted() {
    let (mut refuted, mut passed) = (0, 0);
    every_event(4, |parameters, found| {
        let other = Parameters { xi: parameters.xi * (1.0 + 1e-9), ..*parameters };
        match examine(&found.guard(&Frame::new(&other)), &found.claim) {
            Verdict::Confirmed { .. } => passed += 1,
            _ => refuted += 1,
        }
    });
    println!("{refuted} refuted, {passed} within rounding");
    assert!(refuted > 10 * passed && refuted > 400, "{refuted} {passed}");
}
