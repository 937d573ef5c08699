//! One line of advice for each kind of problem.

use super::names::short_names;
use crate::number::brief;
use crate::report::ranking::{Common, Ranked};
use crate::report::table::one_line;
use crate::report::{Report, ReportRow};
use std::collections::BTreeMap;

/// The lines; none of a kind of which no case was run.
pub(super) fn advice(report: &Report) -> Vec<String> {
    let best = Best::new(report);
    let lines = [
        ("non-stiff", best.most_right(&best.rows(report, |row| !row.traits.is_stiff))),
        ("stiff", best.most_right(&best.rows(report, |row| row.traits.is_stiff))),
        ("chaos", best.longest_valid(&best.rows(report, |row| row.traits.is_chaotic))),
    ];
    let told = lines.into_iter().filter_map(|(kind, line)| Some((kind, line?)));
    told.map(|(kind, line)| one_line(&format!("advice, {:<10} {line}", format!("{kind}:"))))
        .collect()
}

/// The integrators that none is better than.
struct Best<'a> {
    engines: Vec<&'a Ranked>,
    names: BTreeMap<&'static str, &'static str>,
}

impl<'a> Best<'a> {
    fn new(report: &'a Report) -> Self {
        let engines = report.ranking.iter().filter(|it| it.shown_rank() == Some(1)).collect();
        Self { engines, names: short_names(report) }
    }

    /// Their rows of a kind.
    fn rows<'r>(&self, report: &'r Report, is: fn(&ReportRow) -> bool) -> Vec<&'r ReportRow> {
        let is_own = |row: &ReportRow| self.engines.iter().any(|it| it.engine == row.engine);
        report.results.iter().filter(|row| is(row) && is_own(row)).collect()
    }

    /// The choice that costs least at equal error, or in calls where no equal error is known.
    fn cheapest<'c, 'r>(&self, choices: &[&'c Choice<'r>]) -> Option<&'c Choice<'r>> {
        let area = |choice: &Choice<'_>| {
            let own = self.engines.iter().find(|it| it.engine == choice.engine());
            own.and_then(|it| it.cost.area).unwrap_or(0.0)
        };
        let dearer = |a: &&Choice<'_>, b: &&Choice<'_>| {
            area(b).total_cmp(&area(a)).then(a.calls().cmp(&b.calls()))
        };
        choices.iter().copied().min_by(dearer)
    }

    /// A choice by the name that the table of engines gives it.
    fn displayed_name(&self, choice: &Choice<'_>) -> String {
        let name = self.names.get(choice.engine()).copied().unwrap_or(choice.engine());
        format!("{name} at {}", choice.key())
    }

    /// Advises the cheapest of the engines with the most right cases, at the loosest tolerance at
    /// which one has so many.
    fn most_right(&self, rows: &[&ReportRow]) -> Option<String> {
        let choices = Choice::all(rows);
        let most = choices.iter().map(Choice::right).max()?;
        if most == 0 {
            return Some("no integrator gets any case right".to_owned());
        }
        let loosest = choices.iter().find(|it| it.right() == most)?;
        let is_equal = |it: &&Choice<'_>| it.key() == loosest.key() && it.right() == most;
        let equal: Vec<&Choice<'_>> = choices.iter().filter(is_equal).collect();
        let cheapest = self.cheapest(&equal)?;
        let cases = loosest.rows.iter().map(|row| row.case.as_str());
        let shared: Vec<&str> =
            cases.filter(|case| equal.iter().all(|it| it.is_right_on(case))).collect();
        Some(format!("{} ({})", self.displayed_name(cheapest), achieved(cheapest, &shared)))
    }

    /// Advises the cheapest of the engines that stay near the truth for about as long as the best
    /// does on average, at the loosest tolerance at which one does.
    fn longest_valid(&self, rows: &[&ReportRow]) -> Option<String> {
        let telling = telling(rows);
        let choices = Choice::all(&telling);
        let longest = choices.iter().map(Choice::valid_periods).max_by(f64::total_cmp)?;
        let is_about = |it: &&Choice<'_>| it.valid_periods() >= LONG_HORIZON_SHARE * longest;
        let about: Vec<&Choice<'_>> = choices.iter().filter(is_about).collect();
        let loosest = about.first()?.key();
        let loosest: Vec<_> = about.into_iter().filter(|it| it.key() == loosest).collect();
        let best = self.cheapest(&loosest)?;
        let (named, periods) = (self.displayed_name(best), best.valid_periods());
        Some(format!("{named} (within 1e-3 for {periods:.0} periods on average)"))
    }
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

    /// The right-hand sides of all rows.
    fn calls(&self) -> u64 {
        self.rows.iter().filter_map(|row| row.rhs_evaluations).sum()
    }

    fn right(&self) -> usize {
        self.rows.iter().filter(|row| row.is_right()).count()
    }

    /// How long the rows stay near the truth on average.
    fn valid_periods(&self) -> f64 {
        self.rows.iter().map(|row| valid_periods(row)).sum::<f64>() / self.rows.len() as f64
    }

    fn is_right_on(&self, case: &str) -> bool {
        self.rows.iter().any(|row| row.case == case && row.is_right())
    }
}

/// The share of cases that are right, the error, and the cost of an event in the shared cases.
fn achieved(choice: &Choice<'_>, shared: &[&str]) -> String {
    let (right, cases) = (choice.right(), choice.rows.len());
    let rows = choice.rows.iter().filter(|row| shared.contains(&row.case.as_str()));
    let events = rows.map(|row| (row.case.as_str(), row.events_total)).collect();
    let cost = Common(events).per_event_at(&choice.rows, &choice.key());
    let cost = cost.map_or(String::new(), |it| format!(", {it:.0} rhs"));
    let error = nine_tenths(choice);
    format!("{right}/{cases} right, 90 % of errors < {error}{cost}")
}

/// The error that nine tenths of the rows stay below.
fn nine_tenths(choice: &Choice<'_>) -> String {
    let mut errors: Vec<f64> = choice.rows.iter().map(|row| row.state_error.max).collect();
    errors.retain(|it| it.is_finite());
    errors.sort_by(f64::total_cmp);
    errors.get(9 * errors.len() / 10).or(errors.last()).map_or("-".to_owned(), |it| brief(*it))
}

/// The rows of the cases that tell engines apart: where all stay near the truth up to the end, none
/// does so for longer. All rows if there is no such case.
fn telling<'a>(rows: &[&'a ReportRow]) -> Vec<&'a ReportRow> {
    let differs = |row: &&&ReportRow| {
        let same = rows.iter().filter(|it| it.case == row.case).map(|it| valid_periods(it));
        let (least, most) =
            same.fold((f64::INFINITY, 0.0_f64), |(least, most), it| (least.min(it), most.max(it)));
        most - least > PERIODS_TOLERANCE * most
    };
    let telling: Vec<&ReportRow> = rows.iter().filter(differs).copied().collect();
    if telling.is_empty() { rows.to_vec() } else { telling }
}

/// A mean horizon of this share of the longest is about as long.
const LONG_HORIZON_SHARE: f64 = 0.98;
/// Horizons that differ by less, as a share, are the same.
const PERIODS_TOLERANCE: f64 = 1e-6;

/// How long a row stays near the truth; 0 where it has no result.
fn valid_periods(row: &ReportRow) -> f64 {
    if row.valid_periods > 0.0 { row.valid_periods } else { 0.0 }
}
