//! The evidence of a run: what the rows and the prepared cases hold that a row has no room for.

use super::evidence::{
    CaseNote, ErrorGrowth, FaultRow, ReportEvidence, RestartHistogram, SectionPair,
};
use crate::case::{OscillatorCase, SAMPLES_PER_PERIOD};
use crate::power::{Finding, Gate};
use crate::score::attractor::{AttractorTest, Comparison};
use crate::score::{Histogram, Measures, sample_errors};
use crate::suite::{PreparedCase, Scored, Status, is_shown};

impl ReportEvidence {
    /// Collects it; `embedded`: the cases stand inside the binary.
    #[must_use]
    pub fn gather(
        cases: &[PreparedCase],
        rows: &[Scored],
        findings: &[Finding],
        embedded: bool,
    ) -> Self {
        let mut evidence = Self {
            cases: cases.iter().map(|it| CaseNote::new(&it.case, embedded)).collect(),
            faults: findings.iter().map(fault).collect(),
            ..Self::default()
        };
        for row in rows {
            let Status::Ok(measures, _) = &row.status else { continue };
            let Some(prepared) = cases.iter().find(|it| it.case.name == row.case) else { continue };
            let Some(own) = &prepared.case.oscillator else { continue };
            // Fifty curves in one picture say nothing.
            let shown = is_shown(row.role, row.accuracy);
            if own.regime.is_chaotic() && shown {
                evidence.growth.extend(growth(prepared, row));
            }
            evidence.restarts.extend(restarts(row, measures));
            // A section beyond its limits is shown whosever it is.
            if shown || measures.probed.share() > 1.0 {
                evidence.sections.extend(sections((prepared, own), row, measures));
            }
        }
        evidence
    }
}

fn fault(finding: &Finding) -> FaultRow {
    let gate = |gate: Gate| {
        let trip = finding.gates.get(&gate).cloned().unwrap_or_default();
        let detail = match (trip.held, trip.failed) {
            (0, _) => "not asked".to_owned(),
            (held, 0) => format!("passes on {held} cases"),
            (held, failed) => format!("fails on {failed} of {held} cases, first {}", trip.detail),
        };
        (gate.name().to_owned(), trip.failed > 0, detail)
    };
    FaultRow {
        engine: finding.engine.clone(),
        fault: finding.fault.to_owned() + &shows(finding),
        gates: Gate::ALL.into_iter().map(gate).collect(),
    }
}

/// In which cases a fault shows, where it does so in one way of running them.
fn shows(finding: &Finding) -> String {
    let Some(way) = finding.way else { return String::new() };
    let (others, ref failed) = finding.elsewhere;
    let on_others = match failed.as_slice() {
        [] => format!("of the other {others} cases none fails"),
        failed => format!("of the other {others} cases fail {}", failed.join(", ")),
    };
    format!(" (held against the cases with {}; {on_others})", way.words())
}

fn growth(prepared: &PreparedCase, row: &Scored) -> Option<ErrorGrowth> {
    let Status::Ok(_, outcome) = &row.status else { return None };
    let per_period = f64::from(SAMPLES_PER_PERIOD);
    let PreparedCase { truth, rule, .. } = prepared;
    let error = sample_errors(truth, rule, outcome);
    Some(ErrorGrowth {
        case: row.case.clone(),
        engine: row.engine.to_owned(),
        tolerance: row.accuracy.tolerance(),
        periods: (0..error.len()).map(|k| k as f64 / per_period).collect(),
        truth_growth: truth.samples.iter().map(|it| row.unit * rule.largest_growth(it)).collect(),
        error,
        lambda_per_period: prepared.attractor().map(|it| it.reference.lyapunov),
    })
}

fn restarts(row: &Scored, measures: &Measures) -> Option<RestartHistogram> {
    let restart = measures.probed.restart.as_ref().filter(|it| it.with_impact > 0)?;
    let Histogram { lowest, ref counts } = restart.histogram;
    let edge = |k: usize| f64::from(lowest + k as i32) * std::f64::consts::LOG10_2;
    let unit = match row.accuracy.tolerance() {
        Some(tolerance) if row.unit > tolerance => "tolerances^(p/(p + 1))",
        Some(_) => "tolerances",
        None => "eps",
    };
    Some(RestartHistogram {
        case: row.case.clone(),
        engine: row.engine.to_owned(),
        tolerance: row.accuracy.tolerance(),
        edges: (0..=counts.len()).map(edge).collect(),
        counts: counts.iter().map(|count| *count as u64).collect(),
        unit: format!("{unit} x (1 + |value|) x growth"),
    })
}

/// The name of a distance of two sections in words.
fn in_words(name: &str) -> String {
    let (kind, of) = match name {
        "drift" => return "mean drift".to_owned(),
        "lyapunov" => return "Lyapunov exponent".to_owned(),
        "phase_words" => return "frequencies of phase sequences".to_owned(),
        _ => name.split_once('_').unwrap_or((name, "")),
    };
    let kind = match kind {
        "ks" => "Kolmogorov-Smirnov distance",
        "wasserstein" => "Wasserstein distance",
        "map" if of == "error_median" => return "median error of a period".to_owned(),
        "map" if of == "error_share" => return "share of periods with a large error".to_owned(),
        other => other,
    };
    match of.split_once('_') {
        Some((of, "step")) => format!("{kind}, difference of successive {of}"),
        Some((of, "sum")) => format!("{kind}, sum of successive {of}"),
        _ => format!("{kind}, {of}"),
    }
}

/// An integrator's section beside the exact solver's.
fn sections(
    (prepared, own): (&PreparedCase, &OscillatorCase),
    row: &Scored,
    measures: &Measures,
) -> Option<SectionPair> {
    let AttractorTest { reference, calibrated } = prepared.attractor()?;
    let Comparison { points, distances } = measures.probed.attractor.as_ref()?.as_ref().ok()?;
    row.accuracy.tolerance()?;
    let shown = calibrated.plan.periods as usize;
    let named = distances.iter().map(|(name, value, limit)| (in_words(name), *value, *limit));
    Some(SectionPair {
        omega: own.parameters().omega,
        xi: own.parameters().xi,
        exact: reference.points.iter().take(shown).map(|[p, y, _]| [*p, *y]).collect(),
        direct: points.clone(),
        direct_engine: row.engine.to_owned(),
        distances: named.collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::in_words;

    #[test]
    fn distances_have_names() {
        assert_eq!(in_words("ks_p"), "Kolmogorov-Smirnov distance, p");
        assert_eq!(
            in_words("wasserstein_q_step"),
            "Wasserstein distance, difference of successive q"
        );
        assert_eq!(in_words("phase_words"), "frequencies of phase sequences");
    }
}
