//! Model and start: the flags that all verbs of the dynamics share.

use super::parse::{self, Typed};
use super::terminal::note;
use crate::case::{Given, Problem, read_problem};
use crate::number::shortest;
use crate::sweep::SweepPoint;
use crate::systems;
use anyhow::{Result, anyhow, bail};
use clap::Args;
use percuss::{Parameter, Parameters, Phase};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// The model's parameters, the start, and the file that may give both.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Model and start")]
pub(in crate::cli) struct ModelFlags {
    /// Amplitude of the harmonic force [default: 0.3]
    #[arg(long, value_parser = parse::named("a"), allow_hyphen_values = true)]
    a: Option<Typed<f64>>,
    /// Static force [default: 0.1]
    #[arg(long, value_parser = parse::named("b"), allow_hyphen_values = true)]
    b: Option<Typed<f64>>,
    /// Damping ratio of the slider [default: 0.01]
    #[arg(long, value_parser = parse::named("xi"), allow_hyphen_values = true)]
    xi: Option<Typed<f64>>,
    /// Frequency of the harmonic force [default: 1.4]
    #[arg(long, value_parser = parse::named("omega"), allow_hyphen_values = true)]
    omega: Option<Typed<f64>>,
    /// Gap [default: 0.02]
    #[arg(long, value_parser = parse::named("g"), allow_hyphen_values = true)]
    g: Option<Typed<f64>>,
    /// Phase of the harmonic force, radians [default: 1.5707963267948966]
    #[arg(long, value_parser = parse::named("phi"), allow_hyphen_values = true)]
    phi: Option<Typed<f64>>,
    /// Time of the start [default: 0]
    #[arg(long, value_parser = parse::named("tau"), allow_hyphen_values = true)]
    tau: Option<Typed<f64>>,
    /// Forcing periods from --tau to the start [default: 0]
    #[arg(long, value_parser = parse::cycle, allow_hyphen_values = true)]
    cycle: Option<Typed<i64>>,
    /// Displacement of the mass [default: 0]
    #[arg(long, value_parser = parse::named("p"), allow_hyphen_values = true)]
    p: Option<Typed<f64>>,
    /// Velocity of the mass [default: 0]
    #[arg(long, value_parser = parse::named("y"), allow_hyphen_values = true)]
    y: Option<Typed<f64>>,
    /// Displacement of the slider's top [default: 0, or p - g where p >= g]
    #[arg(long, value_parser = parse::named("q"), allow_hyphen_values = true)]
    q: Option<Typed<f64>>,
    /// Drift [default: 0]
    #[arg(long, value_parser = parse::named("v"), allow_hyphen_values = true)]
    v: Option<Typed<f64>>,
    /// The start's phase, for states copied from rounded tables
    #[arg(long, value_name = "TOKEN", value_parser = parse::phase, allow_hyphen_values = true)]
    phase: Option<Phase>,
    /// Reads [parameters] and [start] from a file; flags win over it
    #[arg(long, value_name = "FILE.toml")]
    problem: Option<PathBuf>,
}

impl ModelFlags {
    /// File and flags together, checked.
    pub(in crate::cli) fn problem(&self) -> Result<Problem> {
        self.given()?.check().map_err(|line| anyhow!(line))
    }

    /// The model's flags at a point of a sweep.
    pub(in crate::cli) fn at(&self, point: &SweepPoint) -> Self {
        let mut at = self.clone();
        for (parameter, value) in point.of_oscillator() {
            let flag = match parameter {
                Parameter::A => &mut at.a,
                Parameter::B => &mut at.b,
                Parameter::Xi => &mut at.xi,
                Parameter::Omega => &mut at.omega,
                Parameter::G => &mut at.g,
                Parameter::Phi => &mut at.phi,
            };
            *flag = Some(Typed { value, text: shortest(value) });
        }
        at
    }

    /// Refuses the flag of a parameter that `--parameter` varies: it would have no effect.
    pub(in crate::cli) fn check_varied(&self, varied: Parameter) -> Result<()> {
        let (flag, given) = match varied {
            Parameter::A => ("--a", &self.a),
            Parameter::B => ("--b", &self.b),
            Parameter::Xi => ("--xi", &self.xi),
            Parameter::Omega => ("--omega", &self.omega),
            Parameter::G => ("--g", &self.g),
            Parameter::Phi => ("--phi", &self.phi),
        };
        if let Some(given) = given {
            bail!(
                "{flag} {given} has no effect with --parameter {}, which goes from --from to --to; \
                 accepted is one of the two",
                varied.as_str()
            );
        }
        Ok(())
    }

    /// The first of the flags that is given, with its value.
    pub(in crate::cli) fn first_given(&self) -> Option<String> {
        let number = |it: &Option<Typed<f64>>| it.as_ref().map(ToString::to_string);
        let flags = [
            ("a", number(&self.a)),
            ("b", number(&self.b)),
            ("xi", number(&self.xi)),
            ("omega", number(&self.omega)),
            ("g", number(&self.g)),
            ("phi", number(&self.phi)),
            ("tau", number(&self.tau)),
            ("cycle", self.cycle.as_ref().map(ToString::to_string)),
            ("p", number(&self.p)),
            ("y", number(&self.y)),
            ("q", number(&self.q)),
            ("v", number(&self.v)),
            ("phase", self.phase.map(|it| it.as_str().to_owned())),
            ("problem", self.problem.as_ref().map(|it| it.display().to_string())),
        ];
        flags.into_iter().find_map(|(name, value)| Some(format!("--{name} {}", value?)))
    }

    fn given(&self) -> Result<Given> {
        let mut given = match &self.problem {
            Some(path) => read_problem(path).map_err(|error| match told_as_system(path) {
                Some(line) => anyhow!(line),
                None => anyhow!("--problem {error}"),
            })?,
            None => Given::default(),
        };
        self.override_in(&mut given);
        Ok(given)
    }

    /// The problem whose start is a guess, and whether one was given; a parameter that a flag of
    /// the verb states is set to that.
    pub(in crate::cli) fn guess(
        &self,
        stated: Option<(Parameter, &'static str, &Typed<f64>)>,
    ) -> Result<(Problem, bool)> {
        let mut given = self.given()?;
        if let Some((parameter, flag, value)) = stated {
            // The value that is replaced has to be one, too.
            given.parameters.check().map_err(|error| anyhow!(given.origins.explain(&error)))?;
            given.origins.set(parameter.as_str(), flag.to_owned(), &value.text);
            given.parameters = parameter.set(given.parameters, value.value);
        }
        let is_given = ["p", "y", "q", "phase"].iter().any(|name| given.origins.is_set(name));
        Ok((given.check().map_err(|line| anyhow!(line))?, is_given))
    }

    /// The model and the instant of a grid of starts, which takes the place of the start's phase.
    pub(in crate::cli) fn problem_of_grid(&self) -> Result<Problem> {
        let mut given = self.given()?;
        given.start.phase = None;
        given.check().map_err(|line| anyhow!(line))
    }

    fn override_in(&self, given: &mut Given) {
        let (model, start) = (&mut given.parameters, &mut given.start);
        let numbers = [
            ("a", "--a", &self.a, &mut model.a),
            ("b", "--b", &self.b, &mut model.b),
            ("xi", "--xi", &self.xi, &mut model.xi),
            ("omega", "--omega", &self.omega, &mut model.omega),
            ("g", "--g", &self.g, &mut model.g),
            ("phi", "--phi", &self.phi, &mut model.phi),
            ("tau", "--tau", &self.tau, &mut start.tau),
            ("p", "--p", &self.p, &mut start.p),
            ("y", "--y", &self.y, &mut start.y),
            ("v", "--v", &self.v, &mut start.v),
        ];
        for (name, flag, value, target) in numbers {
            if let Some(Typed { value, text }) = value {
                given.origins.set(name, flag.to_owned(), text);
                *target = *value;
            }
        }
        if let Some(Typed { value, text }) = &self.q {
            given.origins.set("q", "--q".to_owned(), text);
            start.q = Some(*value);
        }
        if let Some(Typed { value, text }) = &self.cycle {
            given.origins.set("cycle", "--cycle".to_owned(), text);
            start.cycle = *value;
        }
        if let Some(phase) = self.phase {
            given.origins.set("phase", "--phase".to_owned(), phase.as_str());
            start.phase = Some(phase);
        }
    }

    /// Says which flags of the start a grid of starts takes the place of.
    pub(in crate::cli) fn note_replaced_by_grid(&self) {
        let given = [
            ("--p", self.p.is_some()),
            ("--y", self.y.is_some()),
            ("--v", self.v.is_some()),
            ("--phase", self.phase.is_some()),
        ];
        for (flag, _) in given.iter().filter(|it| it.1) {
            note(&format!("{flag} is not used: starts are the centres of the grid's cells"));
        }
    }
}

/// The error where a piecewise-affine system is given, by its file or its name, and a problem file
/// of the oscillator is expected.
fn told_as_system(path: &Path) -> Option<String> {
    let shown = path.display();
    let is_named = path.to_str().and_then(systems::named).is_some();
    let table = || std::fs::read_to_string(path).ok()?.parse::<toml::Table>().ok();
    let is_system = is_named || table().is_some_and(|it| it.contains_key("mode"));
    is_system.then(|| {
        format!(
            "--problem {shown} is a piecewise-affine system: percuss events {shown} runs it; \
             accepted is a file with [parameters] and [start] of the oscillator"
        )
    })
}

/// The model's parameters as JSON; null for a NaN.
#[derive(Clone, Copy, Debug, Serialize)]
pub(in crate::cli) struct ParametersJson {
    a: f64,
    b: f64,
    xi: f64,
    omega: f64,
    g: f64,
    phi: f64,
}

impl From<&Parameters> for ParametersJson {
    fn from(parameters: &Parameters) -> Self {
        let Parameters { a, b, xi, omega, g, phi } = *parameters;
        Self { a, b, xi, omega, g, phi }
    }
}
