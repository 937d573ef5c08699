use super::*;
use crate::case::{Quantity, Statistic};
use crate::report::WIDTH;
use crate::report::synthetic::{report, row};
use crate::score::Checked;

const TOLERANCES: [f64; 3] = [1e-6, 1e-9, 1e-12];

fn leak(name: String) -> &'static str {
    Box::leak(name.into_boxed_str())
}

fn fail(row: &mut ReportRow, quantity: Quantity, verdict: Verdict) {
    row.verdict = verdict;
    row.why = "a reason of many words that goes on and on\nand on another line ".repeat(9);
    row.bounds = vec![Checked {
        quantity,
        statistic: Statistic::Value,
        limit: 0.0,
        value: 3.0,
        verdict,
        why: String::new(),
    }];
}

/// Engines with long names, every third of which fails, on cases of all kinds.
fn report_of_many(engines: usize) -> Report {
    let mut rows = Vec::new();
    let name = |engine| leak(format!("a-library-with-a-name-and-a-method-{engine:02}"));
    let names: Vec<&'static str> = (0..engines).map(name).collect();
    for case in 0..12 {
        for (engine, name) in names.iter().enumerate() {
            for tolerance in TOLERANCES {
                let mut row = row(&format!("case-{case:02}"), name, Some(tolerance));
                row.traits.is_stiff = case > 8;
                row.traits.is_chaotic = case < 3;
                row.rhs_evaluations = Some(1_000_000_000 + engine as u64);
                if engine % 3 == 1 {
                    fail(&mut row, Quantity::TimeDefect, Verdict::Fail);
                }
                rows.push(row);
            }
        }
    }
    report(rows)
}

fn screen_text(report: &Report) -> String {
    screen(report, &ReportEvidence::default(), ScreenParts::default())
}

#[test]
fn the_screen_is_at_most_thirty_lines_of_a_hundred_columns() {
    for engines in [1, 2, 17, 20, 24, 60] {
        let said = screen_text(&report_of_many(engines));
        assert!(said.lines().count() <= MAX_LINES, "{engines}: {said}");
        let widest = said.lines().map(|line| line.chars().count()).max();
        assert!(widest.is_some_and(|widest| widest <= WIDTH), "{engines}: {said}");
        for part in ["advice, non-stiff:", "advice, stiff:", "advice, chaos:", " rows: "] {
            assert!(said.contains(part), "{part}: {said}");
        }
    }
    let said = screen_text(&report_of_many(60));
    assert!(said.contains(" engines more: --details\n") && said.contains(" more: --details\n"));
    assert!(said.contains("tied"), "{said}");
    assert!(screen_text(&report_of_many(20)).contains("less exact than its class"));
}

#[test]
fn all_engines_of_the_suite_and_some_failures_are_shown() {
    let said = screen_text(&report_of_many(20));
    assert!((0..20).all(|it| said.contains(&format!("and-a-method-{it:02}"))), "{said}");
    assert!(!said.contains("engines more") && said.contains("\nfail: case-00 "), "{said}");
}

#[test]
fn little_that_is_answered_is_said_on_top() {
    let mut half = report_of_many(2);
    let asked = half.results.len();
    for row in half.results.iter_mut().take(asked / 2) {
        row.verdict = Verdict::NotScored;
    }
    assert_eq!(half.unanswered(), None);
    half.results[asked / 2].status = "failed";
    let found = half.unanswered().map(|it| (it.rows, it.asked));
    assert_eq!(found, Some((asked / 2 + 1, asked)));
    assert!(
        screen_text(&half).starts_with("More than half is missing: "),
        "{}",
        screen_text(&half)
    );
    // What was not asked does not count, on either side.
    half.results[asked / 2].status = "unavailable";
    half.results[asked / 2].verdict = Verdict::Unavailable;
    assert_eq!(half.unanswered().map(|it| it.asked), Some(asked - 1));
}

/// The remark is the failure that most cases show, and the graver one of equals.
#[test]
fn a_remark_says_what_goes_wrong_most_often() {
    let of = |spoiled: &[(usize, Quantity)]| {
        let mut rows: Vec<ReportRow> =
            (0..9).map(|case| row(&format!("case-{case}"), "one", Some(1e-9))).collect();
        for (case, quantity) in spoiled {
            fail(&mut rows[*case], *quantity, Verdict::Known);
        }
        let report = report(rows);
        let said = screen_text(&report);
        said.lines().find(|line| line.contains(" one ")).unwrap_or_default().to_owned()
    };
    let twice =
        [(0, Quantity::EventsMissed), (1, Quantity::EventsSpurious), (2, Quantity::EventsSpurious)];
    assert!(of(&twice).ends_with("invents events"), "{}", of(&twice));
    assert!(of(&twice[..2]).ends_with("misses events"), "{}", of(&twice[..2]));
    assert!(!of(&[]).contains("events"));
}

/// Advice names the cheapest of equals at the loosest tolerance that is as good, and no engine that
/// fails unexpectedly.
#[test]
fn advice_is_the_cheapest_of_equals_at_the_loosest_tolerance() {
    let mut rows = Vec::new();
    for (engine, cost) in [("dear", 900), ("cheap", 100), ("poor", 10), ("spoiled", 1)] {
        for case in 0..30 {
            for tolerance in TOLERANCES {
                let mut row = row(&format!("case-{case:02}"), engine, Some(tolerance));
                row.rhs_evaluations = Some(cost);
                row.valid_periods = if engine == "dear" { 20.0 } else { 10.0 };
                row.traits.is_chaotic = case < 5;
                if tolerance == 1e-6 && case < 9 || engine == "poor" && case % 2 == 0 {
                    row.verdict = Verdict::Known;
                }
                if engine == "spoiled" && case == 0 {
                    row.verdict = Verdict::Error;
                }
                rows.push(row);
            }
        }
    }
    let said = screen_text(&report(rows));
    let expected = "advice, non-stiff: cheap at 1e-9 (30/30 right, 90 % of errors < ";
    assert!(said.contains(expected) && said.contains(", 10 rhs)"), "{said}");
    assert!(said.contains("advice, chaos:     dear at 1e-6 (within"), "{said}");
    assert!(!said.contains("advice, stiff"), "{said}");
}

#[test]
fn advice_says_where_nothing_is_right() {
    let mut rows = vec![row("case", "one", Some(1e-9))];
    rows[0].verdict = Verdict::Known;
    let said = screen_text(&report(rows));
    assert!(said.contains("non-stiff: no integrator gets any case right"), "{said}");
}
