//! The page's tables of engines: their ranking, and their valid horizons.

use super::super::screen::figure;
use super::super::{Ranked, Report, ReportRow};
use super::view::{count, glyph};
use crate::picture::Look;

/// A line of the ranking, for one engine.
pub(super) struct RankedLine {
    pub place: usize,
    /// The rank, or nothing for the reference and for what is not installed.
    pub rank: String,
    pub is_reference: bool,
    pub name: &'static str,
    pub marker: &'static str,
    /// Whether nothing fails unexpectedly.
    pub clean: bool,
    /// The cases that are right, for each setting.
    pub right: Vec<RightBar>,
    /// The share of right cases over all settings, and of stiff ones.
    pub share: f64,
    pub stiff: String,
    /// Wrong events, and of which kinds.
    pub wrong: usize,
    pub kinds: String,
    pub defect: String,
    pub worst_defect: String,
    /// The area under the cost's profile, the share within twice the least, and the cost an event.
    pub cost: [String; 3],
    pub fails: Vec<String>,
}

/// The cases that are right at one setting.
pub(super) struct RightBar {
    pub setting: String,
    pub right: usize,
    pub of: usize,
    pub percent: f64,
}

/// The ranking in its order; `looks` are those of the report's engines.
pub(super) fn ranked_lines(report: &Report, looks: &[Look]) -> Vec<RankedLine> {
    report.ranking.iter().map(|it| ranked_line(report, looks, it)).collect()
}

fn ranked_line(report: &Report, looks: &[Look], it: &Ranked) -> RankedLine {
    let place = report.engines.iter().position(|engine| engine.name == it.engine);
    let look = place.and_then(|place| looks.get(place));
    let shown = |value: Option<f64>| value.map_or(DASH.to_owned(), figure);
    RankedLine {
        place: place.unwrap_or(0),
        rank: it.shown_rank().map_or(String::new(), |rank| rank.to_string()),
        is_reference: it.is_reference(),
        name: it.engine,
        marker: look.map_or("", |it| glyph(it.marker)),
        clean: it.clean,
        right: bars(it),
        share: it.share(),
        stiff: format!("{} of {}", it.stiff.cases_right, it.stiff.cases_total),
        wrong: it.wrong_events(),
        kinds: kinds(it),
        defect: shown(it.defect_units.median),
        worst_defect: shown(it.defect_units.q99),
        cost: [
            shown(it.cost.area),
            shown(it.cost.within_twice),
            it.cost.rhs_per_event.map_or(DASH.to_owned(), count),
        ],
        fails: it.fails_on.clone(),
    }
}

/// The wrong events by kind, in words.
fn kinds(it: &Ranked) -> String {
    let (missed, spurious, wrong_mode) =
        (it.events_missed, it.events_spurious, it.events_wrong_mode);
    let (right, judged) = (it.events_right, it.events_judged);
    format!(
        "{missed} missed, {spurious} spurious, {wrong_mode} in a wrong mode; {right} of {judged} \
         judged are right"
    )
}

/// A bar for each setting, from coarse to fine.
fn bars(it: &Ranked) -> Vec<RightBar> {
    let bar = |((setting, right), (_, of)): (&(String, usize), &(String, usize))| RightBar {
        setting: setting.clone(),
        right: *right,
        of: *of,
        percent: 100.0 * *right as f64 / (*of).max(1) as f64,
    };
    it.cases_right.0.iter().zip(&it.cases_total.0).map(bar).collect()
}

/// The sign in place of a figure that was not measured.
const DASH: &str = "\u{2013}";

/// The valid horizons of one row, as the page shows them.
pub(super) struct HorizonLine {
    pub case: String,
    pub who: String,
    pub runs: usize,
    pub figures: [f64; 3],
}

/// One line per row with valid horizons.
pub(super) fn horizons(report: &Report) -> Vec<HorizonLine> {
    let line = |row: &ReportRow| {
        let it = row.valid_horizon?;
        Some(HorizonLine {
            case: row.case.clone(),
            who: row.who(),
            runs: it.runs,
            figures: [it.q01, it.median, it.predicted_median],
        })
    };
    report.results.iter().filter_map(line).collect()
}
