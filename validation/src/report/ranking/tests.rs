use super::*;
use crate::report::synthetic::row;

const CASES: usize = 40;

/// The rows of an engine at two tolerances; `is_right`: by the case's number.
fn rows(engine: &'static str, is_right: impl Fn(usize) -> bool) -> Vec<ReportRow> {
    let one = |case: usize, tolerance: f64| {
        let verdict = if is_right(case) { Verdict::Pass } else { Verdict::Known };
        ReportRow { verdict, ..row(&format!("case-{case:02}"), engine, Some(tolerance)) }
    };
    (0..CASES).flat_map(|case| [1e-6, 1e-9].map(|tolerance| one(case, tolerance))).collect()
}

fn places(rows: &[ReportRow]) -> Vec<(&'static str, Option<usize>)> {
    ranking(rows).into_iter().map(|it| (it.engine, it.rank)).collect()
}

#[test]
fn equals_share_a_rank_and_a_clearly_better_one_stands_ahead() {
    let engines = [
        rows("half", |case| case % 2 == 0),
        rows("nearly", |case| case > 1),
        rows("all", |_| true),
        rows("other-half", |case| case % 2 == 1),
    ];
    let expected =
        [("all", Some(1)), ("nearly", Some(1)), ("half", Some(3)), ("other-half", Some(3))];
    assert_eq!(places(&engines.concat()), expected);
}

#[test]
fn an_engine_with_an_unexpected_failure_stands_below_every_clean_one() {
    let mut spoiled = rows("spoiled", |_| true);
    spoiled[7].verdict = Verdict::Error;
    let engines = [spoiled, rows("poor", |case| case == 3)];
    let all = ranking(&engines.concat());
    assert_eq!([all[0].engine, all[1].engine], ["poor", "spoiled"]);
    assert_eq!([all[0].rank, all[1].rank], [Some(1), Some(2)]);
    assert_eq!([all[0].clean, all[1].clean], [true, false]);
    assert_eq!(all[1].fails_on, ["case-03"]);
}

#[test]
fn an_engine_that_runs_easy_cases_alone_does_not_lead() {
    let mut easy = rows("easy", |_| true);
    for row in easy.iter_mut().skip(24) {
        row.verdict = Verdict::NotRun;
        row.records = crate::report::JudgedRecords::default();
    }
    let engines = [easy, rows("works", |case| case % 4 != 0)];
    let all = ranking(&engines.concat());
    assert_eq!((all[0].engine, all[1].rank), ("works", Some(2)));
    let counts = |right, total| {
        let map = |count| SettingCounts(vec![("1e-6".into(), count), ("1e-9".into(), count)]);
        (map(right), map(total))
    };
    assert_eq!((all[1].cases_right.clone(), all[1].cases_total.clone()), counts(12, CASES));
}

#[test]
fn the_reference_stands_first_and_what_is_not_installed_last() {
    let exact: Vec<ReportRow> =
        (0..CASES).map(|case| row(&format!("case-{case:02}"), "exact", None)).collect();
    let mut gone = rows("gone", |_| true);
    for row in &mut gone {
        row.verdict = Verdict::Unavailable;
    }
    let all = ranking(&[gone, rows("poor", |_| false), exact].concat());
    let found: Vec<_> = all.iter().map(|it| (it.engine, it.rank)).collect();
    assert_eq!(found, [("exact", Some(0)), ("poor", Some(1)), ("gone", None)]);
    assert_eq!(all[0].cases_right, SettingCounts(vec![("exact".into(), CASES)]));
    assert_eq!((all[2].cases_total.total(), all[2].clean), (0, true));
}

#[test]
fn rows_without_judged_samples_are_not_right() {
    let mut events_only = rows("events-only", |_| true);
    for row in &mut events_only {
        row.records.defect.sample.max = None;
    }
    assert_eq!(ranking(&events_only)[0].cases_right.total(), 0);
}

#[test]
fn stiff_cases_are_counted_apart() {
    let mut own = rows("one", |case| case > 0);
    for row in own.iter_mut().take(4) {
        row.traits.is_stiff = true;
    }
    let stiff = ranking(&own)[0].stiff;
    assert_eq!((stiff.cases_right, stiff.cases_total), (2, 4));
}

/// Two engines on three cases of ten events: one needs 100, 200 and 400 right-hand sides and is
/// dear by its Jacobians on the last; the other 100, 800, and has no result that is near enough.
#[test]
fn a_profile_is_that_of_a_table_by_hand() {
    let one = |engine, case: &str, work: [u64; 3], error: f64| {
        let mut row = row(case, engine, Some(1e-9));
        row.traits.states = 3;
        row.events_total = 10;
        row.state_error.max = error;
        row.rhs_evaluations = Some(work[0]);
        (row.jacobian_evaluations, row.linear_solves) = (Some(work[1]), Some(work[2]));
        row
    };
    let rows = [
        one("a", "x", [100, 0, 0], 1e-7),
        one("a", "y", [200, 0, 0], 1e-7),
        one("a", "z", [300, 30, 10], 1e-6),
        one("b", "x", [100, 0, 0], 1e-7),
        one("b", "y", [800, 0, 0], 1e-7),
        one("b", "z", [50, 0, 0], 1e-5),
        one("b", "w", [50, 0, 0], 1e-9),
    ];
    let all = ranking(&rows);
    let cost = |engine: &str| all.iter().find(|it| it.engine == engine).map(|it| it.cost);
    let whole = Cost { area: Some(1.0), within_twice: Some(1.0), rhs_per_event: Some(20.0) };
    assert_eq!(cost("a"), Some(whole));
    // Four times the least is half of the way to sixteen times; none counts as nothing.
    let part = Cost { area: Some(0.5), within_twice: Some(1.0 / 3.0), rhs_per_event: Some(80.0) };
    assert_eq!(cost("b"), Some(part));
}
