//! The files' own shape, turned into checked values.

use super::expectations::{BoundTable, ShortcomingTable};
use super::located::{FileError, FileText, read_text};
use super::probed::ProbesTable;
use super::problem::Given;
use super::{Case, Horizon, OscillatorCase, Regime};
use percuss::{Instant, Phase};
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::path::Path;
use toml::Spanned;

/// The longest horizon, in forcing periods.
const MAX_PERIODS: i64 = 1_000_000_000;

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the tables of a case")]
struct CaseToml {
    case: CaseTable,
    #[serde(default)]
    parameters: ParameterTable,
    #[serde(default)]
    start: CaseStart,
    horizon: Spanned<HorizonTable>,
    #[serde(default)]
    probes: ProbesTable,
    #[serde(default)]
    bounds: Vec<BoundTable>,
    #[serde(default)]
    shortcomings: Vec<ShortcomingTable>,
}

/// A problem file; a harness case serves as one, and its other tables are left alone.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the tables of a problem")]
struct ProblemFile {
    #[serde(default)]
    parameters: ParameterTable,
    #[serde(default)]
    start: CaseStart,
    #[serde(rename = "case")]
    _case: Option<IgnoredAny>,
    #[serde(rename = "horizon")]
    _horizon: Option<IgnoredAny>,
    #[serde(rename = "probes")]
    _probes: Option<IgnoredAny>,
    #[serde(rename = "bounds")]
    _bounds: Option<IgnoredAny>,
    #[serde(rename = "shortcomings")]
    _shortcomings: Option<IgnoredAny>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [case]")]
struct CaseTable {
    name: Spanned<String>,
    regime: Regime,
    why: String,
    margin: Option<Spanned<f64>>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [parameters]")]
struct ParameterTable {
    a: Option<Spanned<f64>>,
    b: Option<Spanned<f64>>,
    xi: Option<Spanned<f64>>,
    omega: Option<Spanned<f64>>,
    g: Option<Spanned<f64>>,
    phi: Option<Spanned<f64>>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [start]")]
struct CaseStart {
    tau: Option<Spanned<f64>>,
    p: Option<Spanned<f64>>,
    y: Option<Spanned<f64>>,
    q: Option<Spanned<f64>>,
    v: Option<Spanned<f64>>,
    cycle: Option<Spanned<i64>>,
    phase: Option<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [horizon]")]
struct HorizonTable {
    periods: Option<Spanned<i64>>,
    until: Option<Spanned<f64>>,
}

/// Reads `[parameters]` and `[start]` of a problem file or of a harness case.
///
/// # Errors
/// A [`FileError`] for what cannot be read or understood; ranges are checked by [`Given::check`].
pub fn read_problem(path: &Path) -> Result<Given, FileError> {
    let text = read_text(path)?;
    parse_problem(&path.display().to_string(), &text)
}

/// [`read_problem`] of a text; `file` is what errors call it.
///
/// # Errors
/// As [`read_problem`].
pub fn parse_problem(file: &str, text: &str) -> Result<Given, FileError> {
    let source = FileText { file, text };
    let file: ProblemFile = source.parse()?;
    source.given(file.parameters, file.start)
}

fn check_each<T, U, E>(list: Vec<T>, check: impl Fn(T) -> Result<U, E>) -> Result<Vec<U>, E> {
    list.into_iter().map(check).collect()
}

impl FileText<'_> {
    fn given(&self, parameters: ParameterTable, start: CaseStart) -> Result<Given, FileError> {
        let mut given = Given::default();
        let model = &mut given.parameters;
        let state = &mut given.start;
        let mut q = None;
        let numbers = [
            ("a", parameters.a, &mut model.a),
            ("b", parameters.b, &mut model.b),
            ("xi", parameters.xi, &mut model.xi),
            ("omega", parameters.omega, &mut model.omega),
            ("g", parameters.g, &mut model.g),
            ("phi", parameters.phi, &mut model.phi),
            ("tau", start.tau, &mut state.tau),
            ("p", start.p, &mut state.p),
            ("y", start.y, &mut state.y),
            ("v", start.v, &mut state.v),
            ("q", start.q, q.insert(f64::NAN)),
        ];
        let mut q_given = false;
        for (name, number, target) in numbers {
            if let Some(number) = number {
                let place = format!("{}: {name} =", self.place(&number));
                given.origins.set(name, place, self.typed(&number));
                *target = number.into_inner();
                q_given |= name == "q";
            }
        }
        state.q = q.filter(|_| q_given);
        if let Some(cycle) = start.cycle {
            let place = format!("{}: cycle =", self.place(&cycle));
            given.origins.set("cycle", place, self.typed(&cycle));
            state.cycle = cycle.into_inner();
        }
        if let Some(phase) = start.phase {
            let place = format!("{}: phase =", self.place(&phase));
            given.origins.set("phase", place, self.typed(&phase));
            let parsed: Result<Phase, _> = phase.get_ref().parse();
            state.phase = Some(parsed.map_err(|_| self.refused("phase", &phase))?);
        }
        Ok(given)
    }
}

/// Reads one case in the oscillator's own words; `file` is what errors call it.
///
/// # Errors
/// [`FileError`] names the file's line, the field, its value and what is accepted.
pub(super) fn parse_oscillator_case(file: &str, text: &str) -> Result<Case, FileError> {
    let source = FileText { file, text };
    let wire: CaseToml = source.parse()?;
    let given = source.given(wire.parameters, wire.start)?;
    let problem = given.check().map_err(FileError)?;
    let start = Instant::at(given.parameters.omega, given.start.tau, given.start.cycle);
    let horizon =
        source.horizon(&wire.horizon, &start, problem.model.period(), given.parameters.omega)?;
    let name = wire.case.name;
    source.plain_name(&name)?;
    let margin = match &wire.case.margin {
        Some(margin) if !margin.get_ref().is_finite() => {
            return Err(source.refused("margin", margin));
        }
        margin => margin.as_ref().map(|margin| *margin.get_ref()),
    };
    let run = Case::of_run(problem, horizon).map_err(|it| FileError::new(file, it))?;
    let probed = source.probed(&wire.probes)?;
    let own = |own| OscillatorCase { regime: wire.case.regime, margin, probed, ..own };
    Ok(Case {
        name: name.into_inner(),
        file: source.file.to_owned(),
        text: source.text.to_owned(),
        why: wire.case.why,
        oscillator: run.oscillator.map(own),
        bounds: check_each(wire.bounds, |it| source.bound(it))?,
        shortcomings: check_each(wire.shortcomings, |it| source.shortcoming(it))?,
        ..run
    })
}

impl FileText<'_> {
    /// Refuses a name that cannot be the name of a file.
    pub(super) fn plain_name(&self, name: &Spanned<String>) -> Result<(), FileError> {
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
        if !name.get_ref().is_empty() && name.get_ref().chars().all(plain) {
            return Ok(());
        }
        let what =
            format!("name {:?} is not accepted: letters, digits, '-', '_' and '.'", name.get_ref());
        Err(self.error(name, &what))
    }

    fn horizon(
        &self,
        table: &Spanned<HorizonTable>,
        start: &Instant,
        period: f64,
        omega: f64,
    ) -> Result<Horizon, FileError> {
        match (&table.get_ref().periods, &table.get_ref().until) {
            (Some(periods), None) => {
                let count = *periods.get_ref();
                match u32::try_from(count) {
                    Ok(periods) if count <= MAX_PERIODS => Ok(Horizon::Periods(periods)),
                    _ => Err(self.refused("periods", periods)),
                }
            }
            (None, Some(until)) => {
                let tau = *until.get_ref();
                let reachable = tau.abs() <= 1e15 && {
                    let span = Instant::at(omega, tau, 0).since(start, omega).value();
                    span >= 0.0 && span <= MAX_PERIODS as f64 * period
                };
                if reachable { Ok(Horizon::Until(tau)) } else { Err(self.refused("until", until)) }
            }
            _ => Err(self.error(table, "horizon: exactly one of periods and until is accepted")),
        }
    }
}
