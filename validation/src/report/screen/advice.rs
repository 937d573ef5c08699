//! One line of advice for each kind of problem.

use crate::report::ranking::{Common, work};
use crate::report::table::one_line;
use crate::report::{Report, ReportRow};
use crate::score::Spread;

/// The lines; none of a kind of which no case was run.
pub(super) fn advice(report: &Report) -> Vec<String> {
    let candidates = candidates(report);
    let rows = |is: fn(&ReportRow) -> bool| -> Vec<&ReportRow> {
        let of_kind = |row: &&ReportRow| is(row) && candidates.contains(&row.engine);
        report.results.iter().filter(of_kind).collect()
    };
    let lines = [
        ("non-stiff", most_right(&rows(|row| !row.traits.is_stiff))),
        ("stiff", most_right(&rows(|row| row.traits.is_stiff))),
        ("chaos", longest_valid(&rows(|row| row.traits.is_chaotic))),
    ];
    let told = lines.into_iter().filter_map(|(kind, line)| Some((kind, line?)));
    told.map(|(kind, line)| one_line(&format!("advice, {:<10} {line}", format!("{kind}:"))))
        .collect()
}

/// The integrators without unexpected failures, the best first; all where there is none.
fn candidates(report: &Report) -> Vec<&'static str> {
    let integrators = || report.ranking.iter().filter(|it| it.shown_rank().is_some());
    let clean: Vec<_> = integrators().filter(|it| it.clean).map(|it| it.engine).collect();
    if clean.is_empty() { integrators().map(|it| it.engine).collect() } else { clean }
}

/// An engine at one setting, on the cases of a kind.
struct Choice<'a> {
    rows: Vec<&'a ReportRow>,
}

impl<'a> Choice<'a> {
    /// The engines at their settings, tolerances before steps and coarse before fine.
    fn all(rows: &[&'a ReportRow]) -> Vec<Self> {
        let mut choices: Vec<Self> = Vec::new();
        for row in rows {
            let is_its =
                |it: &&mut Self| it.engine() == row.engine && it.key() == row.setting_key();
            match choices.iter_mut().find(is_its) {
                Some(known) => known.rows.push(row),
                None => choices.push(Self { rows: vec![row] }),
            }
        }
        choices.sort_by(|a, b| {
            let (a, b) = (a.rows[0], b.rows[0]);
            let steps = a.step.is_some().cmp(&b.step.is_some());
            steps.then(b.coarseness().total_cmp(&a.coarseness()))
        });
        choices
    }

    fn engine(&self) -> &'static str {
        self.rows.first().map_or("", |row| row.engine)
    }

    fn key(&self) -> String {
        self.rows.first().map_or(String::new(), |row| row.setting_key())
    }

    fn right(&self) -> usize {
        self.rows.iter().filter(|row| row.is_right()).count()
    }

    fn is_right_on(&self, case: &str) -> bool {
        self.rows.iter().any(|row| row.case == case && row.is_right())
    }

    /// The median of what some rows cost.
    fn cost(&self, cases: &[&str]) -> f64 {
        let own = self.rows.iter().filter(|row| cases.contains(&row.case.as_str()));
        Spread::of(own.map(|row| work(row).unwrap_or(f64::INFINITY)).collect()).median
    }
}

/// The cheapest of the engines with the most right cases, at the loosest tolerance at which one has
/// so many.
fn most_right(rows: &[&ReportRow]) -> Option<String> {
    let choices = Choice::all(rows);
    let most = choices.iter().map(Choice::right).max()?;
    if most == 0 {
        return Some("no integrator gets any case right".to_owned());
    }
    let best = choices.iter().find(|it| it.right() == most)?;
    let cases: Vec<&str> = best.rows.iter().map(|row| row.case.as_str()).collect();
    let is_equal = |it: &&Choice<'_>| it.key() == best.key() && it.right() == most;
    let equal: Vec<&Choice<'_>> = choices.iter().filter(is_equal).collect();
    let shared: Vec<&str> =
        cases.iter().filter(|case| equal.iter().all(|it| it.is_right_on(case))).copied().collect();
    let cheapest = equal.iter().min_by(|a, b| a.cost(&shared).total_cmp(&b.cost(&shared)))?;
    Some(described(cheapest, cases.len(), &shared))
}

/// An engine at its setting, with the share of cases that are right, and the cost.
fn described(choice: &Choice<'_>, cases: usize, shared: &[&str]) -> String {
    let right = choice.right();
    let rows = choice.rows.iter().filter(|row| shared.contains(&row.case.as_str()));
    let events = rows.map(|row| (row.case.as_str(), row.events_total)).collect();
    let cost = Common(events).per_event_at(&choice.rows, &choice.key());
    let cost = cost.map_or(String::new(), |it| format!(", {it:.0} rhs an event"));
    format!("{} at {} ({right} of {cases} cases right{cost})", choice.engine(), choice.key())
}

/// The engine that stays near the truth for longest on average, at the loosest of equally good
/// tolerances.
fn longest_valid(rows: &[&ReportRow]) -> Option<String> {
    let telling = telling(rows);
    let choices = Choice::all(&telling);
    let valid = |it: &Choice<'_>| {
        it.rows.iter().map(|row| valid_periods(row)).sum::<f64>() / it.rows.len() as f64
    };
    let longest = choices.iter().map(valid).max_by(f64::total_cmp)?;
    let best = choices.iter().find(|it| valid(it) >= longest)?;
    Some(format!(
        "{} at {} (within 1e-3 for {longest:.0} periods on average)",
        best.engine(),
        best.key()
    ))
}

/// The rows of the cases that tell engines apart: where all stay near the truth up to the end, none
/// does so for longer. All rows if there is no such case.
fn telling<'a>(rows: &[&'a ReportRow]) -> Vec<&'a ReportRow> {
    let differs = |row: &&&ReportRow| {
        let same = rows.iter().filter(|it| it.case == row.case).map(|it| valid_periods(it));
        let (least, most) =
            same.fold((f64::INFINITY, 0.0_f64), |(least, most), it| (least.min(it), most.max(it)));
        most - least > SAME_PERIODS * most
    };
    let telling: Vec<&ReportRow> = rows.iter().filter(differs).copied().collect();
    if telling.is_empty() { rows.to_vec() } else { telling }
}

/// Horizons that differ by less, as a share, are the same.
const SAME_PERIODS: f64 = 1e-6;

/// How long a row stays near the truth; 0 where it has no result.
fn valid_periods(row: &ReportRow) -> f64 {
    if row.valid_periods > 0.0 { row.valid_periods } else { 0.0 }
}
