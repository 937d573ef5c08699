//! Table 1 with the motion it belongs to: Figs. 3 and 4.

mod figure3;
mod figure4;

use super::claim::{Claim, ClaimVerdict};
use super::curve::{self, HEADER};
use super::item_work::{Findings, ItemWork, from_rest};
use super::paper::{PrintedRow, TABLE_1_UNIT, table_1_model};
use crate::engine::Failure;
use crate::number::shortest;
use crate::picture::MotionPiece;
use percuss::dynamics::orbit::Orbit;
use percuss::dynamics::strobe::StrobeMap;
use percuss::{Entry, Instant, Model, Parameters, Segment};

/// Time up to which the paper follows the motion.
const END_TIME: f64 = 1300.0;
/// Points per forcing period.
const POINTS_PER_PERIOD: f64 = 4000.0;
/// Forcing periods until the motion has settled, and a multiple of the period claimed.
const SETTLING_PERIODS: u64 = 2000;

/// The run that starts from rest, and the phases of it that are listed in Table 1.
struct Table1Run {
    model: Model,
    rest: Entry,
    /// The phases whose beginnings are the table's rows.
    segments: Vec<Segment>,
    /// The instant at which the last row begins.
    end: Instant,
}

impl Table1Run {
    fn new(rows: &[PrintedRow]) -> Result<Self, Failure> {
        let parameters = table_1_model();
        let (model, rest) = from_rest(parameters)?;
        let horizon = Instant::at(parameters.omega, END_TIME, 0);
        let all: Vec<_> = model.trajectory(rest).until(horizon).collect();
        let near =
            |segment: &Segment| (segment.entry().instant.tau(parameters.omega) - rows[0].tau).abs();
        let first = (0..all.len()).min_by(|i, j| near(&all[*i]).total_cmp(&near(&all[*j])));
        let first = first.ok_or_else(|| Failure::new("the run has no phases"))?;
        let last = first + rows.len() - 1;
        let end = all.get(last).ok_or_else(|| Failure::new("the run ends before the table"))?;
        let end = end.entry().instant;
        Ok(Self { model, rest, segments: all[first..=last].to_vec(), end })
    }

    fn parameters(&self) -> &Parameters {
        self.model.parameters()
    }

    fn tau(&self, row: usize) -> f64 {
        self.segments[row].entry().instant.tau(self.parameters().omega)
    }

    /// The phases between the first row and the last.
    fn pieces(&self) -> Vec<MotionPiece> {
        let segments = &self.segments[..self.segments.len() - 1];
        curve::pieces(segments, &self.end, self.parameters().omega, POINTS_PER_PERIOD)
    }
}

pub(super) fn run(work: &ItemWork<'_>) -> Result<Findings, Failure> {
    let told = Table1Run::new(&work.paper.table1)?;
    let pieces = told.pieces();
    let orbit = settled_orbit(&told)?;
    let mut findings = Findings::default();
    findings.claims.push(rows(work, &told)?);
    findings.claims.push(period(work, &told, &orbit)?);
    findings.claims.push(closed(work, &told, &orbit)?);
    findings.claims.push(figure3::settle(work, &told, &pieces)?);
    findings.claims.push(figure4::settle(work, &told, &pieces)?);
    findings.picture("figure-3", &figure3::drawing(&told, &pieces))?;
    findings.picture("figure-4", &figure4::drawing(&told, &pieces))?;
    findings.csv("figures-3-4", &HEADER, curve::rows(&pieces))?;
    findings.csv("table-1", &["point", "phase", "tau", "p", "y", "q"], table(&told))?;
    Ok(findings)
}

fn table(told: &Table1Run) -> impl Iterator<Item = Vec<String>> {
    told.segments.iter().enumerate().map(|(row, segment)| {
        let [p, y, q] = segment.entry().point();
        let numbers = [told.tau(row), p, y, q].map(shortest);
        [(row + 1).to_string(), segment.phase().to_string()].into_iter().chain(numbers).collect()
    })
}

fn rows(work: &ItemWork<'_>, told: &Table1Run) -> Result<Claim, Failure> {
    let printed = &work.paper.table1;
    let phases = told
        .segments
        .iter()
        .zip(printed)
        .all(|(segment, row)| segment.phase().as_str() == row.phase);
    let mut differences = Vec::new();
    for (i, (segment, row)) in told.segments.iter().zip(printed).enumerate() {
        let [p, y, q] = segment.entry().point();
        let pairs =
            [("tau", told.tau(i), row.tau), ("p", p, row.p), ("y", y, row.y), ("q", q, row.q)];
        differences.extend(pairs.map(|(name, ours, theirs)| (i + 1, name, (ours - theirs).abs())));
    }
    let (row, name, largest) = differences
        .iter()
        .copied()
        .max_by(|a, b| a.2.total_cmp(&b.2))
        .ok_or_else(|| Failure::new("the paper's table is empty"))?;
    let rounded = differences.iter().filter(|it| it.2 <= 0.5 * TABLE_1_UNIT).count();
    // A number that was cut instead of rounded is off by up to a whole unit.
    let holds = phases && largest <= TABLE_1_UNIT;
    let computed = format!(
        "all {} phases; {rounded} of {} numbers round to the printed ones, the farthest, {name} of row {row}, is {largest:.1e} off",
        told.segments.len(),
        differences.len()
    );
    Ok(Claim::settle(&work.paper, "table1", ClaimVerdict::new(holds), computed)?
        .note("found by following the motion from rest at tau = 0 through 18 forcing periods; within one unit of the last printed digit")
        .evidence("exact solver from rest", "table-1.csv"))
}

/// The orbit that the motion settles on.
fn settled_orbit(told: &Table1Run) -> Result<Orbit, Failure> {
    let map = StrobeMap::new(told.model, told.rest.instant);
    let settled = map.strobes(told.rest, SETTLING_PERIODS).last();
    let settled = settled.ok_or_else(|| Failure::new("the run has no strobes"))?;
    // Looked for at a multiple of what is claimed: the least period is what comes out.
    Orbit::find(&map, settled.point(), 12).map_err(Failure::new)
}

/// The number of phases in one whole period: the strobe may cut one in two.
fn phases(orbit: &Orbit) -> usize {
    let cut = orbit.phases.len() > 1 && orbit.phases.first() == orbit.phases.last();
    orbit.phases.len() - usize::from(cut)
}

fn period(work: &ItemWork<'_>, told: &Table1Run, orbit: &Orbit) -> Result<Claim, Failure> {
    let printed = work.paper.claim("table1-period")?;
    let holds = printed.periods == [orbit.period()] && orbit.is_stable();
    let computed = format!(
        "from rest the motion settles on a {} orbit of period {} with {} phases, drift {:.6} per forcing period",
        if orbit.is_stable() { "stable" } else { "unstable" },
        orbit.period(),
        phases(orbit),
        orbit.drift_per_period
    );
    let multipliers: Vec<_> =
        orbit.multipliers.iter().map(|[re, im]| format!("{re:.6e}{im:+.1e}i")).collect();
    let point = orbit.points[0];
    Ok(Claim::settle(&work.paper, "table1-period", ClaimVerdict::new(holds), computed)?
        .note("looked for as an orbit of twelve forcing periods: its least period is what is told")
        .evidence(
            format!(
                "{SETTLING_PERIODS} forcing periods from rest, then Newton on the exact strobe map"
            ),
            format!("(p, y, q) = {point:?} at the strobe, residual {:.1e}", orbit.residual),
        )
        .evidence("multipliers of the whole orbit", multipliers.join(", "))
        .evidence("parameters", crate::picture::caption(told.parameters())))
}

fn closed(work: &ItemWork<'_>, told: &Table1Run, orbit: &Orbit) -> Result<Claim, Failure> {
    let printed = &work.paper.table1;
    let whole = f64::from(orbit.period()) * told.model.period();
    let last = told.segments.len() - 1;
    let ours = told.tau(last) - told.tau(0);
    let theirs = printed[last].tau - printed[0].tau;
    let apart = [ours, theirs].map(|length| length - whole);
    let holds = apart.iter().all(|it| it.abs() <= TABLE_1_UNIT);
    let computed = format!(
        "T = {whole:.5}; rows 1 and 9 are {ours:.5} apart, {:.5} more, and y differs by {:.5}: the motion has not settled yet",
        apart[0],
        told.segments[0].entry().state.y - told.segments[last].entry().state.y
    );
    Ok(Claim::settle(&work.paper, "table1-closed", ClaimVerdict::new(holds), computed)?
        .note("the printed rows say so themselves; the orbit that the motion settles on later does close after T")
        .evidence("the printed rows", format!("{theirs:.5} apart, {:.5} more than T", apart[1]))
        .evidence(
            "the settled orbit, by Newton",
            format!("period {} of the forcing, residual {:.1e}", orbit.period(), orbit.residual),
        ))
}
