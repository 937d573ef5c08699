//! `bifurcation SYSTEM` at the points of a sweep.
//!
//! Either each point has a whole diagram in the verb's own parameter, or the last axis takes the
//! place of that parameter and each point has the returns of one value.

use super::{SweptSystem, columns, count_in_file, number_of};
use crate::cli::bifurcation::{Arguments, MAX_ROWS, system};
use crate::cli::sweep::diagrams::names_parameter;
use crate::sweep::{Array, Plan, SweepPoint, SweepVerb, records};
use anyhow::Result;
use percuss::affine::{ReturnDiagram, ReturnDiagramStep};
use percuss::dynamics::diagram::values;

/// Diagrams at each point; a point is one tile.
pub(in crate::cli::sweep) struct SystemDiagramWork {
    swept: SweptSystem,
    arguments: Arguments,
    diagram: ReturnDiagram,
    /// Whether the last axis is what varies in the diagram.
    by_axis: bool,
}

impl SystemDiagramWork {
    pub(in crate::cli::sweep) fn new(
        swept: SweptSystem,
        arguments: Arguments,
        plan: &Plan,
    ) -> Result<Self> {
        let diagram = system::diagram(&arguments, system::returns(&arguments, MAX_ROWS)?)?;
        swept.check(&arguments.section)?;
        let from = arguments.from.value;
        swept.chosen.file.clone().set(&arguments.parameter, from, "--parameter")?;
        Ok(Self { swept, arguments, diagram, by_axis: !names_parameter(plan) })
    }

    /// The values of the diagram's parameter at a point.
    fn values(&self, point: &SweepPoint) -> Vec<f64> {
        let Arguments { from, to, steps, .. } = &self.arguments;
        match point.values.last() {
            Some((_, value)) if self.by_axis => vec![*value],
            _ => values(from.value, to.value, *steps),
        }
    }

    fn arrays(&self, steps: &[ReturnDiagramStep]) -> Vec<Array> {
        let (count, returns) = (steps.len(), self.diagram.returns as usize);
        let states = self.swept.first.states.len();
        // Along an axis each point has one value, which is the axis's.
        let front: Vec<usize> = if self.by_axis { vec![] } else { vec![count] };
        let of = |it: &ReturnDiagramStep| columns(&it.points, returns, states);
        let (modes, all): (Vec<_>, Vec<_>) = steps.iter().map(of).unzip();
        let left_out = steps.iter().map(|it| number_of(it.left_out)).collect();
        let undecidable = steps.iter().map(|it| count_in_file(it.undecidable)).collect();
        let mut arrays = vec![
            Array::i4("mode", &[&front[..], &[returns]].concat(), modes.concat()),
            Array::f8("state", &[&front[..], &[returns, states]].concat(), all.concat()),
            Array::i4("left_out", &front, left_out),
            Array::i4("undecidable", &front, undecidable),
        ];
        if !self.by_axis {
            let values = steps.iter().map(|it| it.value).collect();
            arrays.insert(0, Array::f8("parameter", &front, values));
        }
        arrays
    }
}

impl SweepVerb for SystemDiagramWork {
    fn check(&self, point: &SweepPoint) -> Result<()> {
        self.swept.system(point).map(drop)
    }

    fn tile(&self, point: &SweepPoint, _tile: u32) -> Result<Vec<u8>> {
        let (chosen, values) = (self.swept.at(point)?, self.values(point));
        let parameter = &self.arguments.parameter;
        let steps = system::steps(&self.diagram, &chosen, parameter, &values, |_| ())?;
        records::bytes(&self.arrays(&steps))
    }

    fn names(&self) -> Vec<(&'static str, Vec<String>)> {
        self.swept.names()
    }
}
