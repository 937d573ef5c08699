//! Pictures of missed and spurious events, made from runs as `validate` makes them.

use crate::exact;
use percuss_validation::case::defaults;
use percuss_validation::integrators::select;
use percuss_validation::report::{EventMark, EventPicture, MismatchKind, View, event_pictures};
use percuss_validation::suite::first_wrong::first_wrong_events;
use percuss_validation::suite::{self, Suite};
use regex::Regex;

fn pictures(case: &str, engine: &str) -> Vec<EventPicture> {
    let cases = exact::prepared(|name| name == case, None);
    let engine = Regex::new(&format!("^{engine}$")).expect("a pattern");
    let engines = select(&[engine]).expect("an engine");
    let defaults = defaults().expect("bounds");
    let rows = suite::run(&cases, &engines, &Suite::Quick.into(), &defaults, &|| ());
    event_pictures(&first_wrong_events(&cases, &rows))
}

/// The value at the instant next to `t`.
fn value_at(view: &View, values: &[f64], t: f64) -> f64 {
    let share = (t - view.from) / (view.to - view.from);
    values[(share * (values.len() - 1) as f64).round() as usize]
}

fn max_size(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::NEG_INFINITY, f64::max)
}

/// diffsol's root finder looks at the ends of steps only: its own solution rises above the surface
/// between two of them, and no look sees it.
#[test]
fn a_missed_touch_shows_what_the_root_finder_did_not_see() {
    let all = pictures("graze-overlap-1e-6", "diffsol-bdf");
    let picture = all.iter().find(|it| it.tolerance == Some(1e-12)).expect("it misses the touch");
    assert_eq!((picture.kind, picture.guard.as_str()), (MismatchKind::Missed, "guard of impact"));
    assert!((picture.centre - 1.068_286).abs() < 1e-6, "{}", picture.centre);
    for view in &picture.views {
        assert!(view.truth.events.iter().any(|it| it.t.abs() < 1e-9 && !it.matched));
        assert!(max_size(view.looks.iter().map(|look| look[1])) < 0.0);
        assert!(max_size(view.truth.values.iter().copied()) < 1e-15);
    }
    let close = &picture.views[picture.telling];
    assert_eq!((close.truth.phase.as_str(), close.engine.events.len()), ("no-contact", 0));
    let ends: Vec<_> =
        close.truth.events.iter().map(|it| (it.phase.as_str(), it.matched)).collect();
    assert_eq!(ends, [("contact", false), ("no-contact", false)]);
    // In contact the gap is closed; the margin of 1e-6 is how far it would have opened beyond.
    let within = value_at(close, &close.truth.values, close.truth.events[1].t / 2.0);
    assert!(within.abs() < 1e-15, "{within}");
    let risen = max_size(close.engine.values.iter().copied());
    assert!(risen > 0.9e-6 && risen < 1.1e-6, "{risen}");
    let wide = &picture.views[0];
    assert!(wide.steps.len() > 3, "{:?}", wide.steps);
}

#[test]
fn a_spurious_touch_is_the_engine_s_own() {
    let all = pictures("height-missed", "differential-equations-rkv655e-events");
    let picture =
        all.iter().find(|it| it.tolerance == Some(1e-6)).expect("it has an event too many");
    assert_eq!(picture.kind, MismatchKind::Spurious);
    let close = &picture.views[picture.telling];
    let own = close.engine.events.iter().find(|it| it.t == 0.0).expect("it is shown");
    assert!(!own.matched && picture.title.starts_with("The first wrong record, "));
    assert!(close.truth.events.iter().all(|it| it.t.abs() > 1e-12));
    assert!(value_at(close, &close.truth.values, 0.0).abs() > 1e-3);
}

#[test]
fn a_row_without_a_wrong_event_has_no_picture() {
    assert!(pictures("graze-overlap-1e-9", "exact").is_empty());
}

/// A root finder that looks where steps end passes over a switching of the converter: the picture
/// names the modes and shows its guard, as true and as the engine had it.
#[test]
fn a_wrong_event_of_another_system_is_shown_alike() {
    let cases = exact::prepared_systems(|name| name == "buck-dense-output");
    let engines = select(&[Regex::new("^diffsol-tsit45$").expect("a pattern")]).expect("an engine");
    let defaults = defaults().expect("bounds");
    let rows = suite::run(&cases, &engines, &Suite::Quick.into(), &defaults, &|| ());
    let all = event_pictures(&first_wrong_events(&cases, &rows));
    let picture = all.first().expect("it misses an event");
    assert_eq!(picture.modes, ["on", "off"]);
    assert!(picture.guard.starts_with("guard of "), "{}", picture.guard);
    assert!(picture.title.contains("the mode is o"), "{}", picture.title);
    let close = &picture.views[picture.telling];
    assert!(picture.modes.contains(&close.truth.phase));
    let side = match picture.kind {
        MismatchKind::Missed => &close.truth,
        _ => &close.engine,
    };
    // The exact continuation of the engine's own record has it, and the truth hardly elsewhere.
    let near = |it: &&EventMark| it.t.abs() < 1e-6;
    let wrong = side.events.iter().find(near).expect("it is shown");
    assert!(!wrong.matched && picture.modes.contains(&wrong.phase));
    // The guard is zero at the event on the side that has it.
    let range = max_size(side.values.iter().copied()) + max_size(side.values.iter().map(|v| -v));
    assert!(value_at(close, &side.values, 0.0).abs() <= 0.1 * range, "{range}");
    assert_eq!(close.engine.values.len(), close.truth.values.len());
    assert!(!picture.views[0].steps.is_empty() && !picture.views[0].looks.is_empty());
}

/// The curve of an answer that cannot be made again is the exact continuation of its own records:
/// beside the same run watched it is off by the error of single steps, which is within a thousand
/// tolerances of the guard's size on a period.
#[test]
fn an_answer_of_a_program_is_shown_by_its_records() {
    let cases = exact::prepared_systems(|name| name == "buck-dense-output");
    let engines = select(&[Regex::new("^diffsol-tsit45$").expect("a pattern")]).expect("an engine");
    let defaults = defaults().expect("bounds");
    let mut rows = suite::run(&cases, &engines, &Suite::Quick.into(), &defaults, &|| ());
    let watched = event_pictures(&first_wrong_events(&cases, &rows));
    for row in &mut rows {
        row.engine = "a-program";
    }
    let told = event_pictures(&first_wrong_events(&cases, &rows));
    assert!(!told.is_empty() && told.len() == watched.len());
    for (told, watched) in told.iter().zip(&watched) {
        let tolerance = told.tolerance.expect("an adaptive method");
        assert_eq!((&told.title, told.centre), (&watched.title, watched.centre));
        for (told, watched) in told.views.iter().zip(&watched.views) {
            assert!(told.steps.is_empty() && told.looks.is_empty());
            assert_eq!(told.engine.values.len(), watched.engine.values.len());
            let size = max_size(watched.engine.values.iter().map(|value| value.abs()));
            let pairs = told.engine.values.iter().zip(&watched.engine.values);
            let apart = max_size(pairs.map(|(one, other)| (one - other).abs()));
            assert!(apart <= 1e3 * tolerance * size.max(1.0), "{tolerance:e}: {apart:e} of {size}");
        }
    }
}
