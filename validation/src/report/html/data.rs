//! The data inside the page: the rows as columns, and the curves. Rounded; `report.json` has all
//! digits.

use super::super::summary::EngineSummary;
use super::super::{EventPicture, Report, ReportEvidence, ReportRow};
use super::command;
use super::scope::ReportScope;
use crate::picture::Look;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

/// Points of a section that are drawn; a page stays quick with that many.
const MAX_POINTS: usize = 6000;

/// The page's data, fit to stand inside a script element.
pub(super) fn json(
    (report, evidence, scope): (&Report, &ReportEvidence, &ReportScope),
    engines: &[EngineSummary],
    looks: &[Look],
) -> String {
    let mut texts = Texts::default();
    let engine = |(i, engine): (usize, &super::super::EngineEntry)| {
        json!({
            "name": engine.name,
            "library": engine.library,
            "pattern": command::pattern(engine.name),
            "marker": looks.get(i).map(|look| look.marker),
            "settings": engines.get(i).map(|it| round_numbers(json!(it.settings))),
        })
    };
    let data = json!({
        "engines": report.engines.iter().enumerate().map(engine).collect::<Vec<_>>(),
        "cases": cases(report, evidence),
        "columns": columns(&report.results),
        "bounds": report.results.iter().map(|row| bounds(row, &mut texts)).collect::<Vec<_>>(),
        "texts": texts.all,
        "growth": round_numbers(json!(evidence.growth)),
        "restarts": round_numbers(json!(evidence.restarts)),
        "sections": evidence.sections.iter().map(section).collect::<Vec<_>>(),
        "events": evidence.events.iter().filter_map(|it| event(report, it)).collect::<Vec<_>>(),
        "state_error": scope.state_error_briefly,
        "verb": command::verb(&evidence.folders),
        "repeat": command::rest(report.suite, &evidence.folders),
    });
    inside_a_script(&data.to_string())
}

/// Escapes JSON so that nothing in it ends the script element or begins a comment.
fn inside_a_script(json: &str) -> String {
    json.replace('<', "\\u003c").replace('\u{2028}', "\\u2028").replace('\u{2029}', "\\u2029")
}

fn cases(report: &Report, evidence: &ReportEvidence) -> Vec<Value> {
    let names = report.results.chunk_by(|a, b| a.case == b.case).filter_map(|rows| rows.first());
    let note = |row: &ReportRow| {
        let note = evidence.cases.iter().find(|note| note.name == row.case);
        json!({
            "name": row.case,
            "system": note.map(|note| &note.system),
            "regime": note.map(|note| &note.regime),
            "trouble": note.map(|note| &note.trouble),
            "why": note.map(|note| &note.why),
            "toml": note.map(|note| &note.toml),
            "pattern": command::pattern(&row.case),
        })
    };
    names.map(note).collect()
}

/// Each key of a row as an array over the rows; keys of nested objects with a dot.
fn columns(rows: &[ReportRow]) -> Map<String, Value> {
    let flat: Vec<BTreeMap<String, Value>> = rows.iter().map(flat_row).collect();
    let names = flat.iter().flat_map(|row| row.keys().cloned());
    let names: std::collections::BTreeSet<String> = names.collect();
    let column = |name: &String| {
        flat.iter().map(|row| row.get(name).cloned().unwrap_or(Value::Null)).collect::<Vec<_>>()
    };
    // A column that says nothing is not sent.
    let told = |(_, column): &(String, Vec<Value>)| column.iter().any(|value| !value.is_null());
    let all = names.iter().map(|name| (name.clone(), column(name))).filter(told);
    all.map(|(name, column)| (name, Value::Array(column))).collect()
}

fn flat_row(row: &ReportRow) -> BTreeMap<String, Value> {
    let mut flat = BTreeMap::from([("setting".to_owned(), json!(row.setting()))]);
    if let Value::Object(fields) = round_numbers(json!(row)) {
        for (name, value) in fields {
            flatten(&name, value, &mut flat);
        }
    }
    flat.remove("bounds");
    flat
}

fn flatten(name: &str, value: Value, into: &mut BTreeMap<String, Value>) {
    match value {
        Value::Object(fields) => {
            for (key, value) in fields {
                flatten(&format!("{name}.{key}"), value, into);
            }
        }
        value => {
            into.insert(name.to_owned(), value);
        }
    }
}

/// Texts that many rows share, by number.
#[derive(Default)]
struct Texts {
    all: Vec<String>,
    numbers: BTreeMap<String, usize>,
}

impl Texts {
    fn number(&mut self, text: &str) -> usize {
        if let Some(number) = self.numbers.get(text) {
            return *number;
        }
        self.all.push(text.to_owned());
        self.numbers.insert(text.to_owned(), self.all.len() - 1);
        self.all.len() - 1
    }
}

/// The picture of an event with the number of its row.
fn event(report: &Report, picture: &EventPicture) -> Option<Value> {
    let is_its = |row: &ReportRow| {
        (row.case.as_str(), row.engine) == (&picture.case, &picture.engine)
            && (row.tolerance, row.step) == (picture.tolerance, picture.step)
    };
    let row = report.results.iter().position(is_its)?;
    let mut value = round_numbers(json!(picture));
    value["row"] = json!(row);
    // About this time the others are told: it keeps its digits.
    value["centre"] = json!(picture.centre);
    Some(value)
}

/// Quantity and statistic, limit, value, verdict, why.
fn bounds(row: &ReportRow, texts: &mut Texts) -> Vec<Value> {
    let word = |value: Value| value.as_str().unwrap_or_default().replace('_', " ");
    let mut bound = |it: &crate::score::Checked| {
        let quantity = in_words(&word(json!(it.quantity))).to_owned();
        let what = match word(json!(it.statistic)).as_str() {
            "value" => quantity,
            "max" => format!("{quantity}, largest"),
            "q99" => format!("{quantity}, 99 % quantile"),
            statistic => format!("{quantity}, {statistic}"),
        };
        let verdict = texts.number(&word(json!(it.verdict)));
        let [limit, value] = [it.limit, it.value].map(|number| round_numbers(json!(number)));
        json!([texts.number(&what), limit, value, verdict, texts.number(&it.why)])
    };
    row.bounds.iter().map(&mut bound).collect()
}

/// The name of a quantity whose key does not say it.
fn in_words(quantity: &str) -> &str {
    match quantity {
        "events spurious" => "spurious events",
        "events missed" => "missed events",
        "phase word" => "phases or modes in the wrong order",
        "event time error" => "error of event times",
        "state error" => "error of the state",
        "drift error" => "error of the drift",
        "event constant" => "error at events, in its unit",
        "state constant" => "error at samples, in its unit",
        "valid periods" => "forcing periods that are right",
        "valid gain" => "gain of the valid horizon",
        "restart error" => "error after a restart",
        "attractor distance" => "distance of attractors, of its limit",
        other => other,
    }
}

fn section(pair: &super::super::SectionPair) -> Value {
    let thinned = |points: &[[f64; 2]]| {
        let stride = points.len().div_ceil(MAX_POINTS).max(1);
        round_numbers(json!(points.iter().step_by(stride).collect::<Vec<_>>()))
    };
    json!({
        "omega": pair.omega,
        "xi": pair.xi,
        "engine": pair.direct_engine,
        "exact": thinned(&pair.exact),
        "direct": thinned(&pair.direct),
        "total": [pair.exact.len(), pair.direct.len()],
    })
}

/// Numbers to four digits after the first.
fn round_numbers(value: Value) -> Value {
    match value {
        Value::Number(number) if number.is_f64() => {
            let short = number.as_f64().and_then(|it| format!("{it:.4e}").parse::<f64>().ok());
            json!(short)
        }
        Value::Array(values) => values.into_iter().map(round_numbers).collect(),
        Value::Object(fields) => Value::Object(
            fields.into_iter().map(|(key, value)| (key, round_numbers(value))).collect(),
        ),
        value => value,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_ends_the_script() {
        let text = inside_a_script(&json!("</script><!-- \u{2028}").to_string());
        assert!(!text.contains('<') && !text.contains('\u{2028}'), "{text}");
        assert_eq!(
            serde_json::from_str::<Value>(&text).ok(),
            Some(json!("</script><!-- \u{2028}"))
        );
    }

    #[test]
    fn numbers_are_short() {
        let value = round_numbers(json!([0.123_456_789, 1, {"a": f64::NAN, "b": -1.234_567e-12}]));
        assert_eq!(value, json!([0.12346, 1, {"a": null, "b": -1.2346e-12}]));
    }
}
