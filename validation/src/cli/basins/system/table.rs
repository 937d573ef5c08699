//! The attractors of a system as a table for people: a line each.

use super::super::table::digits;
use super::Survey;
use comfy_table::presets::NOTHING;
use comfy_table::{CellAlignment, Table};
use percuss::affine::{ReturnAttractor, UnresolvedReturn};
use percuss::dynamics::attractor::Label;

const COLUMNS: [&str; 6] = ["id", "kind", "period", "% of starts", "exponent/return", "mode"];

/// The most states that are shown of an attractor's first point.
const MAX_STATES: usize = 3;

pub(super) fn text(survey: &Survey) -> String {
    let basins = &survey.basins;
    let states = survey.system.states.iter().take(MAX_STATES).map(String::as_str);
    let columns: Vec<&str> = COLUMNS.into_iter().chain(states).collect();
    let width = columns.len();
    let mut table = Table::new();
    table.load_preset(NOTHING).set_header(columns);
    for (id, attractor) in basins.attractors.iter().enumerate() {
        table.add_row(row(survey, id, attractor));
    }
    if basins.fraction(Label::Escaping) > 0.0 {
        let mut row = vec!["-2".to_owned(), "escaping".to_owned(), String::new()];
        row.push(share(survey, Label::Escaping));
        row.resize(width, String::new());
        table.add_row(row);
    }
    for (i, column) in table.column_iter_mut().enumerate() {
        column.set_padding((0, 2));
        if i > 1 && i != COLUMNS.len() - 1 {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    let lines: String = table.lines().map(|line| line.trim_end().to_owned() + "\n").collect();
    let described: String = basins.unresolved.iter().map(|it| line(survey, it)).collect();
    format!("{lines}{}\n{described}", starts(survey))
}

/// The number of starts, and the shares of those that lead nowhere.
fn starts(survey: &Survey) -> String {
    let plane = &survey.basins.plane;
    let others = [
        (Label::Unresolved, "unresolved"),
        (Label::Inadmissible, "beyond a guard"),
        (Label::Ended, "whose run ends"),
    ];
    let told = others
        .iter()
        .filter(|(label, _)| *label == Label::Unresolved || survey.basins.fraction(*label) > 0.0);
    let told: Vec<_> =
        told.map(|(label, name)| format!("{} % {name}", share(survey, *label))).collect();
    format!("{} x {} starts, {}", plane.columns, plane.rows, told.join(", "))
}

/// The line that describes a start that was not recognised.
fn line(survey: &Survey, start: &UnresolvedReturn) -> String {
    let states = survey.system.states.iter().zip(&start.point.state);
    let state: Vec<_> = states.map(|(name, value)| format!("{name} = {value}")).collect();
    let recurrence = match start.recurrence {
        Some(returns) => format!("repeats after {returns} returns, and is not seen to attract"),
        None => format!("does not repeat within {} returns", survey.limits.max_period),
    };
    let exponent = start.lyapunov_per_return;
    let state = state.join(", ");
    format!("unresolved: {state}: exponent/return {exponent:.6}, {recurrence}\n")
}

fn row(survey: &Survey, id: usize, attractor: &ReturnAttractor) -> Vec<String> {
    let exponent = attractor.lyapunov_per_return;
    let exponent = match exponent.is_nan() {
        true => String::new(),
        false => format!("{exponent:.*}", digits(attractor.lyapunov_error)),
    };
    let first = attractor.points.first();
    let mode = first.map(|it| survey.system.modes[it.mode].name.clone());
    let mut row = vec![
        id.to_string(),
        attractor.kind.as_str().to_owned(),
        attractor.period().map(|it| it.to_string()).unwrap_or_default(),
        share(survey, Label::Attractor(id)),
        exponent,
        mode.unwrap_or_default(),
    ];
    let states = first.map(|it| it.state.as_slice()).unwrap_or_default();
    row.extend(states.iter().take(MAX_STATES).map(|it| format!("{it:.6}")));
    row
}

fn share(survey: &Survey, label: Label) -> String {
    format!("{:.2}", 100.0 * survey.basins.fraction(label))
}
