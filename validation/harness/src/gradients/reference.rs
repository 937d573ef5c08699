//! A case made ready: its truth, its units, and what wrong rules would give.

use super::case::GradientCase;
use super::differences::Quotients;
use super::linear::Linear;
use super::mechanism::{Mechanism, RIGHT_RULE};
use super::path::{Flow, Stop, Stretch, flows, path};
use super::unit::units;
use super::walk::{Along, Rows, walk};
use crate::engine::Failure;

/// A case made ready for answers.
pub struct Reference {
    /// The case.
    pub case: GradientCase,
    linear: Linear,
    path: Vec<Stretch>,
    by: Vec<ByName>,
}

/// All of a case that belongs to one name.
struct ByName {
    rates: Linear,
    flows: Vec<Flow>,
    units: Rows,
}

impl Reference {
    /// Makes a case ready.
    ///
    /// # Errors
    /// A system whose run is not that of the table, or whose start moves in time with a name.
    pub fn new(case: GradientCase) -> Result<Self, Failure> {
        let system = &case.system;
        let start = system.start.as_ref().ok_or_else(|| Failure::new("there is no start"))?;
        let linear = Linear::new(system, start);
        let path = path(system, &linear, case.until)?;
        if path.len() + 1 != case.rows.len() {
            let events = path.len();
            return Err(Failure::new(format!("{}: the run has {events} events", case.name)));
        }
        let mut by = Vec::new();
        for tangent in &case.by {
            if tangent.start.as_ref().is_some_and(|it| !it.time.is_zero()) {
                let name = &tangent.name;
                return Err(Failure::new(format!("{}: the start moves with {name}", case.name)));
            }
            let rates = Linear::rates(system, start, tangent);
            let flows = flows(&path, &linear, &rates);
            let states = system.states.len();
            let along =
                Along { linear: &linear, rates: &rates, path: &path, flows: &flows, states };
            let units = units(&along, system.time_scale);
            by.push(ByName { rates, flows, units });
        }
        Ok(Self { case, linear, path, by })
    }

    pub(super) fn along(&self, name: usize) -> Along<'_> {
        let ByName { rates, flows, .. } = &self.by[name];
        let states = self.case.system.states.len();
        Along { linear: &self.linear, rates, path: &self.path, flows, states }
    }

    /// The proved derivatives by a name.
    pub(super) fn truth(&self, name: usize) -> Rows {
        self.case.rows.iter().map(|it| it.cells[name].clone()).collect()
    }

    /// How far one unit of tolerance brings each cell from its value.
    pub(super) fn units(&self, name: usize) -> &Rows {
        &self.by[name].units
    }

    /// The derivatives in f64 by the right rule.
    #[must_use]
    pub fn derivatives(&self, name: usize) -> Vec<Vec<f64>> {
        walk(&self.along(name), RIGHT_RULE)
    }

    /// What the derivatives would be by the rules at events that a mechanism may mean.
    #[must_use]
    pub fn wrong_derivatives(&self, name: usize, mechanism: Mechanism) -> Vec<Vec<Vec<f64>>> {
        let along = self.along(name);
        mechanism.rules().into_iter().map(|rule| walk(&along, rule)).collect()
    }

    /// Difference quotients over steps of a name.
    pub(super) fn quotients(&self, name: usize) -> Quotients<'_> {
        Quotients::new(self.along(name), self.size(name))
    }

    /// The size of a name's value, for steps.
    fn size(&self, name: usize) -> f64 {
        let system = &self.case.system;
        let name = self.case.by[name].name.to_string();
        let value = system.parameters.get(&name).map_or(0.0, |it| it.abs());
        if value > 0.0 { value } else { 1.0 }
    }

    /// The elapsed time of the whole run.
    #[must_use]
    pub fn path_length(&self) -> f64 {
        self.path.iter().map(|it| it.elapsed).sum()
    }

    /// The elapsed times of the events, the end left out.
    #[must_use]
    pub fn times(&self) -> Vec<f64> {
        let mut time = 0.0;
        let events = self.path.iter().filter(|it| it.stop != Stop::End);
        let later = |it: &Stretch| {
            time += it.elapsed;
            time
        };
        events.map(later).collect()
    }

    /// The difference quotients over a step: `(f(p + h) - f(p))/h`, or central ones.
    #[must_use]
    pub fn differences(&self, name: usize, step: f64, central: bool) -> Option<Vec<Vec<f64>>> {
        self.quotients(name).quotient(step, central)
    }
}
