//! `report.html` in a real browser, at a desk's and at a telephone's width.
//!
//! `cargo test --test harness browser:: -- --ignored`, with `chromium` installed.

use crate::support;
use crate::support::synthetic::{evidence, report};
use percuss_validation::report::exporters;
use serde_json::Value;
use std::process::Command;

/// Uses the page in a frame of a given width and writes down what it sees.
const PROBE: &str = r##"<!doctype html><meta charset="utf-8"><iframe id="frame" src="page.html#verdict=fail" style="border:0;width:WIDTHpx;height:900px"></iframe>
<script>
const frame = document.getElementById("frame");
frame.onload = () => {
  const page = frame.contentDocument, rows = () => page.querySelectorAll("#rows-body > tr.row").length;
  const set = (id, value) => {
    const field = page.getElementById(id);
    field.value = value;
    field.dispatchEvent(new Event("input"));
  };
  const seen = { by_address: rows(), loaded: frame.contentWindow.performance.getEntriesByType("resource").length };
  page.getElementById("filter-clear").click();
  seen.all = page.getElementById("rows-count").textContent;
  set("filter-engine", "exact");
  seen.exact = rows();
  set("filter-text", "graze miss");
  seen.exact_misses = rows();
  page.getElementById("filter-clear").click();
  const heading = [...page.querySelectorAll("#rows-head button")].find((it) => it.textContent === "time error");
  heading.click();
  [...page.querySelectorAll("#rows-head button")].find((it) => it.textContent === "time error").click();
  const column = [...page.querySelectorAll("#rows-head th")].findIndex((it) => it.getAttribute("aria-sort") === "descending");
  seen.largest = Number(page.querySelector("#rows-body > tr").children[column].textContent);
  page.querySelector("#rows-body > tr").click();
  seen.details = page.querySelectorAll("tr.details").length;
  // Texts of a chart that lie on each other.
  const overlapsIn = (svg) => {
    const boxes = [...svg.querySelectorAll("text")].map((it) => [it.textContent, it.getBoundingClientRect()]);
    return boxes.flatMap(([a, r], i) => boxes.slice(i + 1).filter(([, s]) => r.left < s.right - 1 && s.left < r.right - 1 && r.top < s.bottom - 3 && s.top < r.bottom - 3).map(([b]) => `${a} and ${b}`));
  };
  // A wrong event: its row opens, its close-up is changed, and the row is closed again.
  set("filter-verdict", "fail");
  const wrong = page.querySelector("#rows-body > tr.row:has(.off)");
  wrong.click();
  const event = page.querySelector(".event");
  const scale = () => event.querySelector(".zoom:has(button)").textContent;
  seen.scales = [scale()];
  event.querySelectorAll(".zoom button")[1].click();
  seen.scales.push(scale());
  seen.event_marks = [...event.querySelectorAll(".chart svg")].map((it) => it.querySelectorAll(".wrong-event, .look, path").length);
  seen.event_overlaps = [...event.querySelectorAll("svg")].flatMap(overlapsIn);
  const table = page.querySelector("#results .scroll").getBoundingClientRect();
  seen.event_wider_by = Math.max(0, event.getBoundingClientRect().right - table.right);
  seen.command = page.querySelector(".command").textContent.trim();
  seen.case = page.querySelectorAll(".repeat pre").length;
  wrong.click();
  page.getElementById("filter-clear").click();
  // A table that stands in the page is sorted, and its links show rows.
  const engines = page.querySelector("table.engines");
  const first = () => engines.tBodies[0].rows[0].cells[0].textContent;
  const by = (name) => [...engines.tHead.querySelectorAll("button")].find((it) => it.textContent === name).click();
  by("engine");
  seen.sorted = [first()];
  by("engine");
  seen.sorted.push(first());
  const link = engines.querySelector("a[data-engine='exact']");
  link.click();
  seen.linked = rows();
  page.getElementById("filter-clear").click();
  seen.charts = [...page.querySelectorAll("main .chart")].map((it) => it.querySelectorAll("svg path, svg rect").length);
  const curves = () => page.querySelectorAll("#work-time path").length;
  seen.curves = curves();
  page.querySelector("#work-legend button").click();
  seen.fewer_curves = curves();
  seen.painted = [...page.querySelectorAll("canvas")].map((it) => it.getContext("2d").getImageData(0, 0, it.width, it.height).data.some((v) => v > 0));
  seen.wider_by = page.documentElement.scrollWidth - page.documentElement.clientWidth;
  seen.overlaps = [...page.querySelectorAll("svg")].flatMap(overlapsIn);
  // Blocks that lie on each other.
  const blocks = [...page.querySelectorAll("main section > *, header h1, header p, .tile, .controls > *")].map((it) => it.getBoundingClientRect()).filter((it) => it.width && it.height);
  seen.blocks = blocks.filter((r, i) => blocks.some((s, j) => j > i && r.left < s.right - 1 && s.left < r.right - 1 && r.top < s.bottom - 1 && s.top < r.bottom - 1 && !(r.left <= s.left && r.right >= s.right && r.top <= s.top && r.bottom >= s.bottom))).length;
  document.body.append(Object.assign(document.createElement("pre"), { id: "seen", textContent: btoa(unescape(encodeURIComponent(JSON.stringify(seen)))) }));
};
</script>"##;

/// Base 64 without its padding's checks: what the probe says holds no other character.
fn decode(text: &str) -> Vec<u8> {
    const ALPHABET: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let bits = text.bytes().filter_map(|byte| ALPHABET.iter().position(|it| *it == byte));
    let bits: Vec<usize> = bits.collect();
    let bytes = bits.chunks(4).flat_map(|four| {
        let word = four.iter().fold(0, |word, six| word << 6 | six) << (6 * (4 - four.len()));
        (0..four.len() - 1).map(move |i| (word >> (16 - 8 * i) & 255) as u8)
    });
    bytes.collect()
}

fn seen_at(width: u32) -> Value {
    let folder = tempfile::tempdir().expect("a folder");
    let mut page = Vec::new();
    let html = exporters().iter().find(|it| it.file_name() == "report.html").expect("the format");
    html.write(&report(), &evidence(), &mut page).expect("written");
    std::fs::write(folder.path().join("page.html"), page).expect("written");
    let probe = folder.path().join("probe.html");
    std::fs::write(&probe, PROBE.replace("WIDTH", &width.to_string())).expect("written");
    let profile = format!("--user-data-dir={}", folder.path().join("profile").display());
    let flags = "--headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-sync \
                 --disable-background-networking --disable-component-update \
                 --allow-file-access-from-files --virtual-time-budget=8000 --dump-dom";
    let output = Command::new("chromium")
        .args(flags.split_whitespace())
        .args([profile, format!("file://{}", probe.display())])
        .output()
        .expect("chromium runs");
    let dom = support::text(&output.stdout);
    let (_, rest) =
        dom.split_once("<pre id=\"seen\">").expect("the page's scripts ran to their end");
    let (seen, _) = rest.split_once('<').expect("an end");
    serde_json::from_slice(&decode(seen)).expect("JSON")
}

#[test]
#[ignore = "needs chromium"]
fn filters_work_nothing_overlaps_and_nothing_is_loaded() {
    let report = report();
    let exact = report.results.iter().filter(|row| row.engine == "exact").count();
    for width in [1280, 390] {
        let seen = seen_at(width);
        assert_eq!(seen["loaded"], 0);
        assert_eq!(seen["by_address"], report.summary.fail, "{seen}");
        assert_eq!(seen["all"], format!("{0} of {0} rows", report.results.len()));
        assert_eq!((&seen["exact"], &seen["exact_misses"]), (&exact.into(), &4.into()));
        assert!(seen["largest"].as_f64().is_some_and(|it| it > 1e-3), "{seen}");
        assert_eq!(seen["details"], 1);
        let marks = |name: &str| seen[name].as_array().cloned().unwrap_or_default();
        assert_eq!(marks("charts").len(), 4, "{seen}");
        assert!(marks("charts").iter().all(|it| it.as_u64() > Some(10)), "{seen}");
        assert!(seen["fewer_curves"].as_u64() < seen["curves"].as_u64(), "{seen}");
        assert_eq!(marks("painted"), [true; 4]);
        assert_eq!((&seen["wider_by"], &seen["blocks"]), (&0.into(), &0.into()), "{width}: {seen}");
        assert!(marks("overlaps").is_empty(), "{width}: {seen}");
        assert_eq!(marks("scales"), ["close-up 1 of 2widercloser", "close-up 2 of 2widercloser"]);
        assert_eq!(marks("event_marks").len(), 2, "{seen}");
        assert!(marks("event_marks").iter().all(|it| it.as_u64() > Some(3)), "{seen}");
        assert!(marks("event_overlaps").is_empty(), "{width}: {seen}");
        assert_eq!((&seen["event_wider_by"], &seen["case"]), (&0.into(), &1.into()), "{seen}");
        let command = "percuss validate -c '^periodic-00$' -e '^diffsol-bdf$' --suite quick --rows";
        assert_eq!(seen["command"], command);
        let sorted = marks("sorted");
        assert!(sorted[0].as_str() < sorted[1].as_str(), "{seen}");
        assert_eq!(seen["linked"], exact);
    }
}
