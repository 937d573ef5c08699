//! Grazes of other systems than the oscillator.

use crate::exact;
use percuss_validation::score::Graze;

fn grazes(case: &str) -> Vec<Graze> {
    exact::prepared_systems(|name| name == case).pop().expect("the case").grazes
}

/// The crest of a watched level is an event of another guard, between the two that a graze makes.
#[test]
fn an_event_at_the_extremum_hides_no_graze() {
    let near: Vec<_> =
        grazes("level-graze-hit-1e-9").into_iter().filter(|it| it.margin.abs() < 1e-6).collect();
    let events: Vec<_> = near.iter().map(|it| it.events.as_slice()).collect();
    assert_eq!(events, [[4], [6]], "up is event 4, the turn 5, and down 6: {near:?}");
    assert!(near.iter().all(|it| (0.9e-9..1.1e-9).contains(&it.margin)), "{near:?}");
}
