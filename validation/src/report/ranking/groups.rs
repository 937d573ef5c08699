//! Rows by engine and by case, as the ranking needs them.

use crate::report::ReportRow;
use crate::score::Verdict;
use std::collections::HashMap;

/// An engine with its rows.
pub(in crate::report) struct EngineRows<'a> {
    /// The engine's name.
    pub engine: &'static str,
    /// The rows, in the report's order.
    pub rows: Vec<&'a ReportRow>,
}

impl EngineRows<'_> {
    /// Whether it is the exact reference.
    pub fn is_exact(&self) -> bool {
        self.rows.iter().all(|row| row.is_exact())
    }

    /// Whether it is not installed: nothing was asked of it.
    pub fn is_absent(&self) -> bool {
        self.rows.iter().all(|row| row.verdict == Verdict::Unavailable)
    }

    /// Whether it is an integrator of which something was run.
    pub fn is_in_the_table(&self) -> bool {
        !self.is_exact() && self.rows.iter().any(|row| row.was_run())
    }
}

/// The engines in the order of the rows.
pub(in crate::report) fn by_engine(rows: &[ReportRow]) -> Vec<EngineRows<'_>> {
    let mut engines: Vec<EngineRows<'_>> = Vec::new();
    for row in rows {
        match engines.iter_mut().find(|it| it.engine == row.engine) {
            Some(known) => known.rows.push(row),
            None => engines.push(EngineRows { engine: row.engine, rows: vec![row] }),
        }
    }
    engines
}

/// The cases in the order of the rows, each once.
pub(in crate::report) fn case_names(rows: &[ReportRow]) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for case in rows.chunk_by(|a, b| a.case == b.case).filter_map(|it| it.first()) {
        if !names.contains(&case.case.as_str()) {
            names.push(&case.case);
        }
    }
    names
}

/// The share of right rows on each of the cases; 0 where there is none.
pub(in crate::report) fn scores<'a>(
    cases: &[&str],
    rows: impl Iterator<Item = &'a ReportRow>,
) -> Vec<f64> {
    let places: HashMap<&str, usize> =
        cases.iter().zip(0..).map(|(name, at)| (*name, at)).collect();
    let mut counts = vec![(0_u32, 0_u32); cases.len()];
    for row in rows {
        if let Some(at) = places.get(row.case.as_str()) {
            counts[*at].0 += u32::from(row.is_right());
            counts[*at].1 += 1;
        }
    }
    counts.iter().map(|(right, asked)| f64::from(*right) / f64::from((*asked).max(1))).collect()
}
