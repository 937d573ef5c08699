//! Work-precision of every case, and cost against length and against xi.

use super::contestants;
use super::report::{Bench, BenchRow, CaseEntry, Damped, net};
use crate::engine::REFERENCE;
use crate::history::{History, HistoryRecord};
use crate::picture::{
    Axis, AxisScale, Curve, Curves, DrawError, INK, Marker, Picture, Stroke, basin_colours, looks,
    png, svg,
};
use crate::score::SCORED_ERROR;

/// All pictures that there are data for, each as PNG and SVG.
///
/// # Errors
/// [`DrawError`] with the drawing library's reason.
pub fn pictures(bench: &Bench) -> Result<Vec<Picture>, DrawError> {
    let of_case = |entry: &CaseEntry| {
        let case = &entry.case;
        let name = format!("work-precision-{case}");
        let gross = (format!("{name}-gross"), work_precision(bench, case, Times::Gross));
        [(name, work_precision(bench, case, Times::Net)), gross]
    };
    let mut drawn: Vec<(String, Curves)> = bench.cases.iter().flat_map(of_case).collect();
    if !bench.length.is_empty() {
        drawn.push(("length".to_owned(), length(bench)));
    }
    if !bench.damping.is_empty() {
        drawn.push(("damping".to_owned(), damping(bench)));
    }
    both(&drawn)
}

/// Each picture as PNG and SVG.
pub(super) fn both(drawn: &[(String, Curves)]) -> Result<Vec<Picture>, DrawError> {
    let mut files = Vec::new();
    for (name, curves) in drawn {
        files.push((format!("{name}.png"), png(curves)?));
        files.push((format!("{name}.svg"), svg(curves).into_bytes()));
    }
    Ok(files)
}

/// Which times are drawn.
#[derive(Clone, Copy)]
enum Times {
    /// The measured time without the harness's own share.
    Net,
    /// The measured time, which includes the harness's own share.
    Gross,
}

impl Times {
    fn ns_per_period(self, row: &BenchRow) -> Option<f64> {
        match self {
            // The exact solver is the unit as a whole.
            Self::Net if row.engine == REFERENCE => row.ns_per_period,
            Self::Net => row.net_ns_per_period(),
            Self::Gross => row.ns_per_period,
        }
    }

    const fn label(self) -> &'static str {
        match self {
            Self::Net => "processor time a forcing period, net of the harness's share, ns",
            Self::Gross => "processor time a forcing period with the harness's share, ns",
        }
    }
}

fn work_precision(bench: &Bench, case: &str, times: Times) -> Curves {
    let rows: Vec<&BenchRow> = bench.results.iter().filter(|row| row.case == case).collect();
    let point = |row: &&BenchRow| Some((times.ns_per_period(row)?, row.state_error_max?));
    let left_out = rows.iter().filter(|row| point(row).is_none()).count();
    let curves = rows.chunk_by(|a, b| a.engine == b.engine);
    let curves =
        curves.filter_map(|own| Some((own.first()?.engine.as_str(), own.iter().filter_map(point))));
    let curves = curves.map(|(engine, points)| curve(engine, points.collect()));
    Curves {
        note: left_out_note(left_out, rows.len()),
        title: format!("Work-precision: {case}"),
        x: logarithmic(times.label()),
        y: logarithmic("largest error of the state"),
        // The exact solver lies on top.
        curves: curves.collect::<Vec<_>>().into_iter().rev().collect(),
    }
}

/// What a picture does not show: only runs that have every event and no other are timed.
fn left_out_note(count: usize, of: usize) -> String {
    if count == 0 {
        return String::new();
    }
    format!(
        "Left out are {count} of {of} settings, whose runs have missed or spurious events, err by more than \
         {SCORED_ERROR:e} or give no result; their reasons are in bench.json."
    )
}

fn length(bench: &Bench) -> Curves {
    let time = bench.length.iter().map(|it| (it.periods as f64, it.ns_per_period));
    let whole = bench
        .length
        .iter()
        .map(|it| (it.periods as f64, it.ns_per_period * it.periods as f64 / 1e3));
    let proportional = bench.length.last().map(|last| {
        bench
            .length
            .iter()
            .map(|it| (it.periods as f64, last.ns_per_period * it.periods as f64 / 1e3))
    });
    let line = Curve {
        stroke: Stroke::Dashed,
        marker: None,
        width: 1.5,
        ..curve("in proportion", proportional.into_iter().flatten().collect())
    };
    Curves {
        note: String::new(),
        title: "Cost against length: exact, on the orbit of period five at omega = 1.6, xi = 0.1"
            .to_owned(),
        x: logarithmic("forcing periods"),
        y: logarithmic("ns a forcing period; microseconds the whole run"),
        curves: vec![
            line,
            Curve { name: "the whole run, µs".to_owned(), ..curve(REFERENCE, whole.collect()) },
            Curve {
                name: "a period, ns".to_owned(),
                marker: Some(Marker::Square),
                ..curve(REFERENCE, time.collect())
            },
        ],
    }
}

fn damping(bench: &Bench) -> Curves {
    let mut names: Vec<&str> = Vec::new();
    for row in &bench.damping {
        if !names.contains(&row.engine.as_str()) {
            names.push(&row.engine);
        }
    }
    let exact = |row: &Damped| row.engine == REFERENCE;
    let share = |row: &Damped| row.harness_share.filter(|_| !exact(row));
    let point = |row: &Damped| Some((row.xi, net(row.ns_per_period?, share(row))));
    let points = |name: &str| {
        let own = bench.damping.iter().filter(|row| row.engine == name);
        own.filter_map(point).collect::<Vec<_>>()
    };
    let tolerance = bench.damping.iter().find_map(|row| row.tolerance);
    let tolerance = tolerance.map(|it| format!(" (engines at {})", crate::number::shortest(it)));
    Curves {
        note: String::new(),
        title: format!(
            "Cost against xi, from rest at omega = 1.2{}",
            tolerance.unwrap_or_default()
        ),
        x: logarithmic("xi"),
        y: logarithmic(Times::Net.label()),
        curves: names.iter().rev().map(|name| curve(name, points(name))).collect(),
    }
}

/// Two workloads share a colour or a marker, never both.
const MARKERS: [Marker; 5] =
    [Marker::Circle, Marker::Square, Marker::Triangle, Marker::Diamond, Marker::Nabla];

/// The cost of a unit of each workload, version by version.
#[must_use]
pub fn history(history: &History) -> Curves {
    let mut versions: Vec<&HistoryRecord> = Vec::new();
    let mut benches: Vec<&str> = Vec::new();
    for record in &history.records {
        if !versions.iter().any(|it| it.is_with(record)) {
            versions.push(record);
        }
        if !benches.contains(&record.bench.as_str()) {
            benches.push(&record.bench);
        }
    }
    // Recorded twice, the last counts.
    let cost = |bench: &str, version: &HistoryRecord| {
        let mut own = history.records.iter().rev().filter(|it| it.bench == bench);
        own.find(|it| it.is_with(version)).map(|it| it.floors)
    };
    let points = |bench: &str| {
        let costs = versions.iter().enumerate().map(|(i, it)| (i, cost(bench, it)));
        costs.filter_map(|(i, cost)| Some(((i + 1) as f64, cost?))).collect::<Vec<_>>()
    };
    let curve = |(i, bench): (usize, &&str)| Curve {
        name: (*bench).to_owned(),
        colour: basin_colours(i).1,
        marker: Some(MARKERS[i % MARKERS.len()]),
        width: 2.0,
        stroke: Stroke::Solid,
        points: points(bench),
        apart: Vec::new(),
    };
    let last = versions.last().map(|it| it.commit.as_deref().unwrap_or(&it.percuss).chars());
    let last: String = last.into_iter().flatten().take(10).collect();
    Curves {
        note: String::new(),
        title: format!("An event in units of the floor, {} versions up to {last}", versions.len()),
        x: Axis { label: "recorded version, oldest first".to_owned(), scale: AxisScale::Linear },
        y: Axis { label: "sine-cosine-exponentials an event".to_owned(), scale: AxisScale::Linear },
        curves: benches.iter().enumerate().map(curve).collect(),
    }
}

fn logarithmic(label: &str) -> Axis {
    Axis { label: label.to_owned(), scale: AxisScale::Logarithmic }
}

/// A curve that looks as its engine does everywhere.
fn curve(engine: &str, points: Vec<(f64, f64)>) -> Curve {
    let mut known = contestants().into_iter().map(|it| it.declaration());
    let library = known.find(|it| it.name == engine).map_or("", |it| it.library);
    let look = looks(&[(engine, library)]).into_iter().next();
    Curve {
        name: engine.to_owned(),
        colour: look.map_or(INK, |look| look.light),
        marker: Some(look.map_or(Marker::Circle, |look| look.marker)),
        width: 2.5,
        stroke: Stroke::Solid,
        points,
        apart: Vec::new(),
    }
}
