//! The scoreboard as Markdown and as HTML.

use super::board::{Board, BoardLine, EventCounts, SetupResult};
use anyhow::Result;
use askama::Template;

/// What stands where nothing was measured.
const DASH: &str = "\u{2013}";

/// The block of the Markdown page.
pub(crate) fn markdown(board: &Board) -> String {
    let mut text = format!("{}\n\n", head(board));
    let columns = [
        "engine",
        "library",
        "language",
        "right %",
        "by default %",
        "events right %",
        "by default %",
        "spurious",
        "by default",
        "rhs per event",
        "by default",
        "µs per event",
        "µs of the process",
    ];
    text += &table(&columns.map(str::to_owned), 3, board.lines.iter().map(|it| cells(it).to_vec()));
    text += "\nEvents that are right, in per cent of those that were judged, by kind of trouble; the default set-up's \
             after the stroke.\n\n";
    let mut columns = vec!["engine".to_owned()];
    columns.extend(board.kinds.iter().cloned());
    let line = |it: &BoardLine| {
        let kinds =
            (0..board.kinds.len()).map(|k| both_figures(it, |score| percent(&score.kinds[k])));
        [displayed_name(it)].into_iter().chain(kinds).collect()
    };
    text + &table(&columns, 1, board.lines.iter().map(line))
}

/// What the figures are of, in a sentence.
fn head(board: &Board) -> String {
    let tolerances: Vec<_> = board.tolerances.iter().map(|it| format!("{it:e}")).collect();
    format!(
        "{} cases at {}; {}.",
        board.cases,
        if tolerances.is_empty() { "no tolerance".to_owned() } else { tolerances.join(" and ") },
        board.made.join("; ")
    )
}

/// A table whose columns from `right` on are numbers.
fn table(columns: &[String], right: usize, lines: impl Iterator<Item = Vec<String>>) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let rules: Vec<String> =
        (0..columns.len()).map(|k| if k < right { "---" } else { "--:" }.to_owned()).collect();
    [line(columns), line(&rules)].into_iter().chain(lines.map(|it| line(&it))).collect()
}

fn displayed_name(line: &BoardLine) -> String {
    format!("{} {}", line.name, line.version)
}

/// The cells of an engine in the first table.
fn cells(line: &BoardLine) -> [String; 13] {
    let of = |score: &Option<SetupResult>, figure: fn(&SetupResult) -> String| {
        score.as_ref().map_or(DASH.to_owned(), figure)
    };
    let pair =
        |figure: fn(&SetupResult) -> String| [of(&line.expert, figure), of(&line.default, figure)];
    let best = line.expert.as_ref().or(line.default.as_ref());
    let [right, right_default] = pair(right_percent);
    let [events, events_default] = pair(|it| percent(&it.all));
    let [spurious, spurious_default] = pair(|it| it.all.spurious.to_string());
    let [rhs, rhs_default] = pair(|it| figure(it.rhs));
    [
        displayed_name(line),
        line.library.clone(),
        line.language.clone(),
        right,
        right_default,
        events,
        events_default,
        spurious,
        spurious_default,
        rhs,
        rhs_default,
        figure(best.and_then(|it| it.own)),
        figure(best.and_then(|it| it.overhead)),
    ]
}

/// The expert's figure and the default's, where each was run.
fn both_figures(line: &BoardLine, figure: impl Fn(&SetupResult) -> String) -> String {
    let [expert, default] = [&line.expert, &line.default].map(|it| it.as_ref().map(&figure));
    match (expert, default) {
        (Some(expert), Some(default)) => format!("{expert} / {default}"),
        (Some(expert), None) => expert,
        (None, Some(default)) => format!("{DASH} / {default}"),
        (None, None) => DASH.to_owned(),
    }
}

fn percent(tally: &EventCounts) -> String {
    tally.percent().map_or(DASH.to_owned(), |it| it.to_string())
}

/// The share of rows that are wholly right, with a mark where one fails unexpectedly.
fn right_percent(score: &SetupResult) -> String {
    format!("{:.0}{}", (100.0 * score.right).floor(), if score.clean { "" } else { "!" })
}

/// Two digits that tell.
fn figure(value: Option<f64>) -> String {
    match value {
        None => DASH.to_owned(),
        Some(value) if value >= 10.0 => format!("{value:.0}"),
        Some(value) => format!("{value:.1}"),
    }
}

#[derive(Template)]
#[template(path = "scoreboard.html")]
struct ScoreboardPage<'a> {
    head: String,
    kinds: &'a [String],
    lines: Vec<HtmlLine>,
}

/// An engine in both tables.
struct HtmlLine {
    name: String,
    cells: [String; 13],
    kinds: Vec<[KindCell; 2]>,
}

/// A share of events, whose colour says how much it is.
struct KindCell {
    shown: String,
    share: u64,
}

/// The HTML page, which loads nothing.
///
/// # Errors
/// What the template says.
pub(crate) fn html(board: &Board) -> Result<String> {
    let cell = |score: &Option<SetupResult>, k: usize| KindCell {
        shown: score.as_ref().map_or(DASH.to_owned(), |it| percent(&it.kinds[k])),
        share: score.as_ref().and_then(|it| it.kinds[k].percent()).unwrap_or_default(),
    };
    let line = |it: &BoardLine| HtmlLine {
        name: displayed_name(it),
        cells: cells(it),
        kinds: (0..board.kinds.len())
            .map(|k| [cell(&it.expert, k), cell(&it.default, k)])
            .collect(),
    };
    let lines = board.lines.iter().map(line).collect();
    Ok(ScoreboardPage { head: head(board), kinds: &board.kinds, lines }.render()?)
}
