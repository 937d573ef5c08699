//! `basins SYSTEM` and `attractors SYSTEM` at the points of a sweep.

use super::{SweptSystem, columns};
use crate::cli::basins::system::json::Json;
use crate::cli::basins::system::{Survey, array_name};
use crate::cli::basins::{AttractorArguments, BasinArguments, GridFlags};
use crate::cli::shared::section::SectionFlags;
use crate::cli::sweep::basins::{Wanted, kind, labels};
use crate::sweep::{Array, SweepPoint, SweepVerb, records};
use anyhow::Result;
use percuss::affine::{Plane, ReturnAttractor, ReturnBasins};
use percuss::dynamics::attractor::Label;

/// Labels or attractors at each point; a point is one tile.
pub(in crate::cli::sweep) struct SystemBasinWork {
    swept: SweptSystem,
    grid: GridFlags,
    section: SectionFlags,
    plane: Plane,
    wanted: Wanted,
}

impl SystemBasinWork {
    pub(in crate::cli::sweep) fn labels(
        swept: SweptSystem,
        arguments: BasinArguments,
    ) -> Result<Self> {
        Self::new(swept, arguments.grid, arguments.section, Wanted::Labels)
    }

    pub(in crate::cli::sweep) fn attractors(
        swept: SweptSystem,
        arguments: AttractorArguments,
    ) -> Result<Self> {
        Self::new(swept, arguments.grid, arguments.section, Wanted::Attractors)
    }

    fn new(
        swept: SweptSystem,
        grid: GridFlags,
        section: SectionFlags,
        wanted: Wanted,
    ) -> Result<Self> {
        swept.check(&section)?;
        let plane = grid.plane(&swept.first)?;
        Ok(Self { swept, grid, section, plane, wanted })
    }
}

/// What the verb `attractors` writes as JSON but the escaping starts' entry, of each attractor its
/// first point.
fn attractors(survey: &Survey) -> Vec<Array> {
    let all = &survey.basins.attractors;
    let (count, states) = ([all.len()], survey.system.states.len());
    let drifts = survey.system.drifts().len();
    let numbers = |of: &dyn Fn(&ReturnAttractor) -> f64| all.iter().map(of).collect::<Vec<f64>>();
    let shares = |of: &dyn Fn(Label) -> f64| {
        (0..all.len()).map(|id| of(Label::Attractor(id))).collect::<Vec<f64>>()
    };
    let means = |of: fn(&ReturnAttractor) -> &Vec<f64>| {
        let padded = |it| {
            let mut means = of(it).clone();
            means.resize(drifts, f64::NAN);
            means
        };
        all.iter().flat_map(padded).collect()
    };
    let first = |it: &ReturnAttractor| columns(&it.points[..it.points.len().min(1)], 1, states);
    let (modes, points): (Vec<_>, Vec<_>) = all.iter().map(first).unzip();
    let period = |it: &ReturnAttractor| it.period().map_or(-1, |it| it as i32);
    let share = |label| vec![survey.basins.fraction(label)];
    vec![
        Array::i4("ids", &count, (0..all.len()).map(|it| it as i32).collect()),
        Array::i4("kind", &count, all.iter().map(|it| kind(it.kind.as_str())).collect()),
        Array::i4("period", &count, all.iter().map(period).collect()),
        Array::f8("fraction", &count, shares(&|it| survey.basins.fraction(it))),
        Array::f8("fraction_error", &count, shares(&|it| survey.basins.fraction_error(it))),
        Array::f8("drift_per_return", &[all.len(), drifts], means(|it| &it.drift_per_return)),
        Array::f8(
            "drift_standard_error",
            &[all.len(), drifts],
            means(|it| &it.drift_standard_error),
        ),
        Array::f8("lyapunov_per_return", &count, numbers(&|it| it.lyapunov_per_return)),
        Array::f8("lyapunov_error", &count, numbers(&|it| it.lyapunov_error)),
        Array::i4("mode", &count, modes.concat()),
        Array::f8("state", &[all.len(), states], points.concat()),
        Array::f8("escaping", &[], share(Label::Escaping)),
        Array::f8("unresolved", &[], share(Label::Unresolved)),
        Array::f8("inadmissible", &[], share(Label::Inadmissible)),
        Array::f8("ended", &[], share(Label::Ended)),
    ]
}

impl SweepVerb for SystemBasinWork {
    fn check(&self, point: &SweepPoint) -> Result<()> {
        self.swept.system(point).map(drop)
    }

    fn tile(&self, point: &SweepPoint, _tile: u32) -> Result<Vec<u8>> {
        let system = self.swept.system(point)?;
        let survey = Survey::watched(system, &self.grid, &self.section, &|_| ())?;
        let ReturnBasins { plane, attractors: found, labels: all, .. } = &survey.basins;
        let size = [plane.columns, plane.rows];
        match self.wanted {
            Wanted::Labels => records::bytes(&labels(size, all, found.len(), &Json::new(&survey))?),
            Wanted::Attractors => records::bytes(&attractors(&survey)),
        }
    }

    fn coordinates(&self) -> Vec<Array> {
        let centres = |axis: usize| {
            let centres = self.plane.centres(axis);
            let name = array_name(&self.swept.first.states[self.plane.axes[axis]]);
            Array::f8(&name, &[centres.len()], centres)
        };
        match self.wanted {
            Wanted::Labels => vec![centres(0), centres(1)],
            Wanted::Attractors => Vec::new(),
        }
    }

    fn names(&self) -> Vec<(&'static str, Vec<String>)> {
        match self.wanted {
            Wanted::Labels => Vec::new(),
            Wanted::Attractors => {
                let mut names = self.swept.names();
                names.push(("drifts", self.swept.drifts()));
                names
            }
        }
    }
}
