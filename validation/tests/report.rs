//! `report.html` and the pictures beside it, full, empty, and with numbers that are not finite.

use crate::support;
use crate::support::synthetic::{UNESCAPED_TEXT, evidence, report, row};
use percuss_validation::report::{
    CaseNote, Report, ReportEvidence, ReportRow, ScreenParts, exporters, pictures, screen,
};
use percuss_validation::score::Verdict;
use serde_json::Value;
use std::path::Path;

fn html_of(name: &str, report: &Report, evidence: &ReportEvidence) -> String {
    let exporter = exporters().iter().find(|it| it.file_name() == name).expect("the format");
    let mut bytes = Vec::new();
    exporter.write(report, evidence, &mut bytes).expect("written");
    let kind = if evidence.cases.is_empty() { "empty" } else { "full" };
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{kind}-{name}"));
    std::fs::write(path, &bytes).expect("kept to be looked at");
    support::text(&bytes)
}

fn data(html: &str) -> Value {
    let (_, rest) =
        html.split_once("<script type=\"application/json\" id=\"data\">").expect("data");
    let (json, _) = rest.split_once("</script>").expect("an end");
    serde_json::from_str(json).expect("JSON")
}

#[test]
fn the_page_holds_every_row() {
    let report = report();
    let html = html_of("report.html", &report, &evidence());
    let data = data(&html);
    let column = |name: &str| data["columns"][name].as_array().cloned().unwrap_or_default();
    assert_eq!(data["bounds"].as_array().map(Vec::len), Some(report.results.len()));
    for (i, row) in report.results.iter().enumerate() {
        assert_eq!(column("case")[i], row.case);
        assert_eq!(column("engine")[i], row.engine);
        assert_eq!(column("tolerance")[i].as_f64(), row.tolerance);
        assert_eq!(column("setting")[i], row.setting());
        assert_eq!(column("why")[i], row.why);
    }
    let wrong = data["events"][0]["row"].as_u64().map(|row| &report.results[row as usize]);
    assert!(wrong.is_some_and(|row| row.records.events_missed == Some(9) && row.verdict == Verdict::Fail));
    let summary = report.summary;
    assert!(html.contains(&format!("{} rows are out of bounds", summary.fail + summary.error)));
    let lines = html.matches("<th scope=\"row\" data-sort=").count();
    assert_eq!(lines, report.ranking.len());
    let place = |engine: &str| html.find(&format!("data-engine=\"{engine}\""));
    assert!(report.ranking.windows(2).all(|pair| place(pair[0].engine) < place(pair[1].engine)));
    assert!(html.contains(">24 of 26<span class=\"bar\"") && !html.contains(">NaN"));
    assert!(html.contains("title=\"15 missed, 4 spurious, 1 in a wrong mode; 2280 of 2300 judged"));
    assert!(html.len() < 2_000_000, "{}", html.len());
}

#[test]
fn nothing_is_loaded_and_nothing_gets_out_of_its_place() {
    let html = html_of("report.html", &report(), &evidence());
    for part in ["src=", "url(", "@import", "<link", "fetch(", "XMLHttpRequest", "import("] {
        assert!(!html.contains(part), "{part}");
    }
    for (at, _) in html.match_indices("href=\"") {
        let to = html[at + 6..].split('"').next().unwrap_or_default();
        assert!(to.starts_with('#') || ["report.json", "errors.csv"].contains(&to), "{to}");
    }
    assert!(html.contains("default-src 'none'"));
    // One script element for the data and one for the scripts, whatever the rows say.
    assert_eq!((html.matches("<script").count(), html.matches("</script>").count()), (2, 2));
    assert!(!html.contains(UNESCAPED_TEXT) && !html.contains("<!--"));
}

#[test]
fn sections_without_data_are_left_out() {
    let (full, empty) = (evidence(), ReportEvidence::default());
    let sections = ["grazing", "error-growth", "restarts", "attractors", "power"];
    let shown = |html: &str| {
        let there = |it: &str| html.contains(&format!("<section id=\"{it}\">"));
        let linked = |it: &str| html.contains(&format!("<a href=\"#{it}\">"));
        assert!(sections.iter().all(|it| there(it) == linked(it)));
        sections.iter().filter(|it| there(it)).count()
    };
    assert_eq!(shown(&html_of("report.html", &report(), &full)), 5);
    // Valid horizons are of the rows, and the page has rows.
    assert_eq!(shown(&html_of("report.html", &report(), &empty)), 1);
    let nothing =
        Report { results: Vec::new(), engines: Vec::new(), ranking: Vec::new(), ..report() };
    assert!(html_of("report.html", &nothing, &empty).contains("No engine was run"));
}

/// The report in which an engine was run at its finest tolerance on the first `ran` cases alone.
fn with_few_rows(engine: &str, ran: usize) -> Report {
    let mut report = report();
    let own = report.results.iter_mut().filter(|row| row.engine == engine);
    for row in own.filter(|row| row.tolerance == Some(1e-12)).skip(ran) {
        row.verdict = Verdict::NotRun;
        row.status = "not-run";
    }
    report
}

#[test]
fn a_median_over_few_rows_is_marked_and_sorted_last() {
    let shown = |ran: usize| {
        let html = html_of("report.html", &with_few_rows("de-radau5", ran), &evidence());
        let (_, table) = html.split_once("<table class=\"engines").expect("the table");
        let (_, line) = table.split_once("data-engine=\"de-radau5\"").expect("the engine");
        line.split_once("</tr>").expect("an end").0.to_owned()
    };
    let few = shown(9);
    assert!(few.contains("<td class=\"number off\">9 of 26</td>"), "{few}");
    assert_eq!(few.matches("<td class=\"number partial\" data-sort=\"\u{2013}\"").count(), 3);
    let most = shown(24);
    assert!(most.contains(">24 of 26<") && !most.contains("partial"), "{most}");
}

fn picture(report: &Report, wanted: &str) -> String {
    let all = pictures(report, &evidence()).expect("drawn");
    let (_, bytes) = all.into_iter().find(|(name, _)| name == wanted).expect("the picture");
    support::text(&bytes)
}

#[test]
fn points_that_score_other_events_are_told_apart() {
    let few = with_few_rows("de-radau5", 9);
    let whole = report();
    let on_one_case = |missed: usize| {
        let own = whole.results.iter().filter(|row| row.case == "periodic-03");
        let mut results: Vec<_> = own.cloned().collect();
        let wanted =
            |row: &&mut ReportRow| row.engine == "de-radau5" && row.tolerance == Some(1e-9);
        let row = results.iter_mut().find(wanted).expect("the row");
        row.events_matched = Some(40 - missed);
        row.records.events_missed = Some(missed);
        Report { results, ..report() }
    };
    let one = on_one_case(2);
    for name in ["work-precision-event-time.svg", "work-precision-state.svg"] {
        let said = picture(&few, name);
        assert!(said.contains("Hollow") && said.contains("(9 of 26 rows)"), "{name}");
        assert!(!picture(&whole, name).contains("Hollow"), "{name}");
        let said = picture(&one, name);
        assert!(said.contains("Hollow") && said.contains("(38 of 40 events)"), "{name}");
        assert!(!picture(&on_one_case(0), name).contains("Hollow"), "{name}");
    }
}

#[test]
fn a_run_with_other_events_counts_as_infinitely_wrong_in_a_median() {
    let errors = |wrong: usize, verdict: Verdict| {
        let mut report = report();
        let own = report.results.iter_mut().filter(|row| row.engine == "de-radau5");
        for row in own.filter(|row| row.tolerance == Some(1e-9)).take(wrong) {
            row.records.events_spurious = Some(1);
            row.verdict = verdict;
        }
        let data = data(&html_of("report.html", &report, &evidence()));
        let engines = data["engines"].as_array().expect("a list").clone();
        let engine = engines.into_iter().find(|it| it["name"] == "de-radau5").expect("the engine");
        let setting = &engine["settings"][1];
        assert_eq!(setting["setting"], "1e-9");
        [&setting["time_error"], &setting["state_error"]].map(Value::is_number)
    };
    assert_eq!(errors(5, Verdict::Known), [true, true]);
    assert_eq!(errors(20, Verdict::Known), [false, true]);
    // Where either answer is right, no other is.
    assert_eq!(errors(20, Verdict::Undecidable), [true, true]);
}

/// Many systems of one case each, on which one engine fails.
#[test]
fn a_failing_case_that_is_all_of_its_system_is_named_once() {
    let names: Vec<String> = (0..60).map(|k| format!("alone-{k:02}")).collect();
    let note = |name: &String| CaseNote {
        name: name.clone(),
        system: if name.ends_with('9') { "together".to_owned() } else { name.clone() },
        ..CaseNote::default()
    };
    let evidence =
        ReportEvidence { cases: names.iter().map(note).collect(), ..ReportEvidence::default() };
    let failing = |(k, name): (usize, &String)| {
        let row = row(name, "de-radau5", Some(1e-9), k);
        ReportRow { verdict: if k < 55 { Verdict::Fail } else { Verdict::Known }, ..row }
    };
    let mut report =
        Report { results: names.iter().enumerate().map(failing).collect(), ..report() };
    report.ranking.retain(|it| it.engine == "de-radau5");
    report.ranking[0].fails_on = names.clone();
    let said = screen(&report, &evidence, ScreenParts { details: true, rows: false });
    let (_, said) = said.split_once("\nfails on").expect("the block");
    let (said, _) = said.split_once("\n\n").expect("an end");
    let words: Vec<&str> = said.split_whitespace().map(|it| it.trim_end_matches(',')).collect();
    let count = |wanted: &str| words.iter().filter(|it| **it == wanted).count();
    // What nothing excuses is named, and so is not counted; the others are counted.
    assert_eq!((count("alone-07!"), count("alone-07")), (1, 0), "{said}");
    assert_eq!((count("alone-58!"), count("alone-58")), (0, 1), "{said}");
    assert_eq!((count("alone-09!"), count("together")), (1, 1), "{said}");
}

#[test]
fn every_format_takes_every_number() {
    for exporter in exporters() {
        for evidence in [evidence(), ReportEvidence::default()] {
            html_of(exporter.file_name(), &report(), &evidence);
        }
    }
}

/// Wrong events are drawn one by one where at most three cases are chosen.
#[test]
fn wrong_events_of_few_cases_are_drawn() {
    let drawn = |keep: &[&str]| {
        let whole = report();
        let kept = whole.results.iter().filter(|row| keep.contains(&row.case.as_str()));
        let some = Report { results: kept.cloned().collect(), ..report() };
        let all = pictures(&some, &evidence()).expect("drawn");
        let names = all.into_iter().map(|(name, _)| name).filter(|it| it.starts_with("events/"));
        names.collect::<Vec<_>>()
    };
    let name = "events/periodic-00__diffsol-bdf__1e-12";
    let both = [format!("{name}.png"), format!("{name}.svg")];
    let four = ["periodic-00", "periodic-01", "periodic-02", "periodic-03"];
    assert_eq!(drawn(&four[..3]), both);
    assert!(drawn(&four).is_empty());
}

#[test]
fn every_picture_is_one() {
    let nothing = Report { results: Vec::new(), engines: Vec::new(), ..report() };
    let full = pictures(&report(), &evidence()).expect("drawn");
    let names: Vec<&str> = full.iter().map(|(name, _)| name.as_str()).collect();
    for name in [
        "work-precision-event-time",
        "work-precision-state",
        "recall",
        "grazing",
        "error-growth-fig7a-chaos",
        "restart-errors-chaos-from-rest",
        "restart-errors-chaos-from-rest-2",
        "attractors-1",
        "attractors-2",
    ] {
        let both =
            [format!("{name}.png"), format!("{name}.svg")].map(|it| names.contains(&it.as_str()));
        // A cloud of many points is no SVG.
        assert_eq!(both, [true, name != "attractors-1"], "{name} of {names:?}");
    }
    let empty = pictures(&report(), &ReportEvidence::default()).expect("drawn");
    let of_nothing = pictures(&nothing, &ReportEvidence::default()).expect("drawn");
    assert_eq!((empty.len(), of_nothing.len()), (6, 6));
    for (name, bytes) in full.iter().chain(&empty).chain(&of_nothing) {
        if name.ends_with(".png") {
            let mut reader =
                png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect(name);
            let mut pixels = vec![0; reader.output_buffer_size().expect(name)];
            let size = reader.next_frame(&mut pixels).expect(name);
            assert!(size.width >= 800 && pixels.iter().any(|it| *it != pixels[0]), "{name}");
        } else {
            let text = support::text(bytes);
            assert!(!text.contains("NaN") && !text.contains("inf\""), "{name}");
            let mut reader = quick_xml::Reader::from_str(&text);
            while !matches!(reader.read_event().expect(name), quick_xml::events::Event::Eof) {}
        }
    }
    for (name, bytes) in full {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("full-{name}"));
        std::fs::write(path, &bytes).expect("kept to be looked at");
    }
}
