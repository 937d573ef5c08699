//! `report.html`: one page that works offline, with its styles, scripts and data inside.
//!
//! What is read off at a glance (verdicts, recall, grazing, power) is made here, so that it shows
//! without scripts and in print; the rows, which are filtered, and the curves are drawn in the
//! page. The charts are SVG of our own: each engine has abscissas of its own, which charting
//! libraries with one shared column do not take, and SVG follows the colour scheme and prints. They
//! are no copies of the pictures beside the report, which are made for the whole of it: a page with
//! a close-up of every wrong row inside would be nearly three times as large.

mod command;
mod data;
mod ranking;
mod scope;
mod view;

use super::{Exporter, GradientCounts, Report, ReportEvidence, summary};
use crate::picture::looks;
use askama::Template;
use std::io::{self, Write};

pub(super) struct Html;

const STYLE: &str = include_str!("../../../assets/report/report.css");
const SCRIPTS: &str = concat!(
    include_str!("../../../assets/report/format.js"),
    include_str!("../../../assets/report/chart.js"),
    include_str!("../../../assets/report/events.js"),
    include_str!("../../../assets/report/rows.js"),
    include_str!("../../../assets/report/tables.js"),
    include_str!("../../../assets/report/curves.js"),
    include_str!("../../../assets/report/clouds.js"),
);

#[derive(Template)]
#[template(path = "report.html")]
struct Page<'a> {
    report: &'a Report,
    evidence: &'a ReportEvidence,
    engines: Vec<view::EngineLine>,
    failures: Vec<view::FailureView>,
    more_failures: usize,
    ranking: Vec<ranking::RankedLine>,
    scope: &'a scope::ReportScope,
    recall_columns: usize,
    grazing: view::GrazingTable,
    trouble: view::TroubleTable,
    horizons: Vec<ranking::HorizonLine>,
    power: view::PowerTable,
    gradients: Vec<GradientCounts>,
    colours: String,
    style: &'static str,
    scripts: &'static str,
    data: String,
}

impl Exporter for Html {
    fn file_name(&self) -> &'static str {
        "report.html"
    }

    fn write(
        &self,
        report: &Report,
        evidence: &ReportEvidence,
        out: &mut dyn Write,
    ) -> io::Result<()> {
        let summaries = summary::engines(report);
        let names: Vec<_> = report.engines.iter().map(|it| (it.name, it.library)).collect();
        let looks = looks(&names);
        let scope = scope::ReportScope::new(report, evidence);
        let (failures, more_failures) = view::failures(report);
        let page = Page {
            report,
            evidence,
            engines: view::engines(report, &summaries, &looks),
            failures,
            more_failures,
            ranking: ranking::ranked_lines(report, &looks),
            scope: &scope,
            recall_columns: summaries.iter().map(|it| it.settings.len()).max().unwrap_or(0),
            grazing: view::grazing(report, evidence),
            trouble: view::trouble(report, evidence),
            horizons: ranking::horizons(report),
            power: view::power(evidence),
            gradients: GradientCounts::all(&report.gradients),
            colours: view::colours(&looks),
            style: STYLE,
            scripts: SCRIPTS,
            data: data::json((report, evidence, &scope), &summaries, &looks),
        };
        out.write_all(page.render().map_err(io::Error::other)?.as_bytes())
    }
}
