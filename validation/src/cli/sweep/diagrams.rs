//! `bifurcation` at the points of a sweep.
//!
//! Either each point has a whole diagram in the verb's own parameter, or the last axis takes the
//! place of that parameter and each point has the strobes of one value.

use super::exponents::number_of;
use crate::cli::bifurcation::{self, Arguments, MAX_ROWS};
use crate::sweep::{Array, Plan, SweepPoint, SweepVerb, records};
use anyhow::{Result, anyhow, bail};
use percuss::dynamics::diagram::{Diagram, DiagramStep};

/// Diagrams at each point; a point is one tile.
pub(super) struct DiagramWork {
    arguments: Arguments,
    /// Whether the last axis is what varies in the diagram.
    by_axis: bool,
}

impl DiagramWork {
    /// The flags that the last axis takes the place of, where [fixed] names no parameter.
    pub(super) fn words_of_axis(plan: &Plan) -> Result<Vec<String>> {
        let (false, Some(axis)) = (names_parameter(plan), plan.axes.last()) else {
            return Ok(Vec::new());
        };
        if !plan.words.iter().any(|it| it == "--reset") {
            bail!(
                "a diagram along an axis needs reset = true in [fixed]: values that carry the last \
                 state on are not computed apart; accepted is also a parameter with from, to and \
                 steps in [fixed], for a whole diagram at each point"
            );
        }
        let own = ["from", "to", "steps"];
        let is_given =
            |name: &&str| plan.words.iter().any(|it| it.starts_with(&format!("--{name}=")));
        if let Some(name) = own.iter().find(|name| is_given(name)) {
            bail!(
                "[fixed] {name} is not accepted without parameter: the last axis is the diagram's, \
                 with its own from, to and steps"
            );
        }
        let (name, from) = (axis.parameter.as_str(), axis.from);
        Ok(vec![
            format!("--parameter={name}"),
            format!("--from={from}"),
            format!("--to={from}"),
            "--steps=1".to_owned(),
        ])
    }

    pub(super) fn new(arguments: Arguments, plan: &Plan) -> Result<Self> {
        let periods = arguments.periods_of_oscillator()?;
        bifurcation::check_size(&arguments, ("--periods", periods), MAX_ROWS)?;
        if names_parameter(plan) {
            arguments.model.check_varied(arguments.parameter_of_oscillator()?)?;
        }
        Ok(Self { arguments, by_axis: !names_parameter(plan) })
    }

    fn diagram(&self, point: &SweepPoint) -> Result<Diagram> {
        let diagram = bifurcation::diagram(&self.arguments, &self.arguments.model.at(point))?;
        let value = point.values.last().map(|it| it.1).filter(|_| self.by_axis);
        Ok(match value {
            Some(value) => Diagram { from: value, to: value, ..diagram },
            None => diagram,
        })
    }

    fn arrays(&self, diagram: &Diagram, steps: &[DiagramStep]) -> Vec<Array> {
        let (count, periods) = (steps.len(), diagram.periods as usize);
        // Along an axis each point has one value, which is the axis's.
        let front: Vec<usize> = if self.by_axis { vec![] } else { vec![count] };
        let whole = [&front[..], &[periods]].concat();
        let of = |i: usize| {
            let at = |step: &DiagramStep, n: usize| step.points.get(n).map_or(f64::NAN, |it| it[i]);
            steps.iter().flat_map(|step| (0..periods).map(move |n| at(step, n))).collect()
        };
        let drift = steps.iter().map(|it| it.drift_per_period).collect();
        let errors = steps.iter().map(|it| it.drift_standard_error).collect();
        let escapes = steps.iter().map(|it| i32::from(it.escapes)).collect();
        let endless = steps.iter().map(|it| number_of(it.endless)).collect();
        let undecidable = steps.iter().map(|it| i32::from(it.undecidable)).collect();
        let mut arrays = vec![
            Array::f8("p", &whole, of(0)),
            Array::f8("y", &whole, of(1)),
            Array::f8("q", &whole, of(2)),
            Array::f8("drift_per_period", &front, drift),
            Array::f8("drift_standard_error", &front, errors),
            Array::i4("escapes", &front, escapes),
            Array::i4("endless", &front, endless),
            Array::i4("undecidable", &front, undecidable),
        ];
        if !self.by_axis {
            let values = steps.iter().map(|it| it.value).collect();
            arrays.insert(0, Array::f8("parameter", &front, values));
        }
        arrays
    }
}

/// Whether each point has a whole diagram in a parameter of its own.
pub(super) fn names_parameter(plan: &Plan) -> bool {
    plan.words.iter().any(|it| it.starts_with("--parameter="))
}

impl SweepVerb for DiagramWork {
    fn check(&self, point: &SweepPoint) -> Result<()> {
        self.diagram(point).map(drop)
    }

    fn tile(&self, point: &SweepPoint, _tile: u32) -> Result<Vec<u8>> {
        let diagram = self.diagram(point)?;
        let steps = diagram.steps(|_| {});
        let name = diagram.parameter.as_str();
        let steps = steps.map_err(|error| anyhow!("parameter {name}: {error}"))?;
        records::bytes(&self.arrays(&diagram, &steps))
    }
}
