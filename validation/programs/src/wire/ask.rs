//! Requests to a program.

use super::PROTOCOL;
use percuss_engines::engine::{Accuracy, Limits, Task};
use percuss_engines::system::{
    CheckedSystem, CoefficientDerivatives, Direction, Mode, Row, System,
};
use serde::Serialize;

/// The part of its time after which a program is to give up by itself, before it is ended.
const OWN_TIME_SHARE: f64 = 0.9;

/// A request, one line of JSON.
#[derive(Serialize)]
pub(crate) struct Ask<'a> {
    percuss_protocol: u64,
    id: u64,
    ask: Asked,
    #[serde(skip_serializing_if = "Option::is_none")]
    run: Option<&'a RunAsk<'a>>,
}

/// The kind of a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Asked {
    /// The program's capabilities.
    Capabilities,
    /// A run.
    Run,
    /// Whether the program is waiting for the next request.
    Ready,
}

impl<'a> Ask<'a> {
    /// A request that comes with no run.
    pub(crate) fn plain(id: u64, ask: Asked) -> Self {
        Self { percuss_protocol: PROTOCOL, id, ask, run: None }
    }

    /// A request for a run.
    pub(crate) fn run(id: u64, run: &'a RunAsk<'a>) -> Self {
        Self { run: Some(run), ..Self::plain(id, Asked::Run) }
    }
}

/// A run that a program is asked for.
#[derive(Serialize)]
pub(crate) struct RunAsk<'a> {
    setup: &'a str,
    system: SystemAsk<'a>,
    backward: bool,
    mode: usize,
    state: &'a [f64],
    span: f64,
    samples: Vec<f64>,
    tolerance: Option<Tolerance>,
    step: Option<f64>,
    times: TimesAsk,
    limits: LimitsAsk,
    /// Left out where no derivatives are asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    gradients: Vec<RatesAsk<'a>>,
}

/// A name by which derivatives are asked for, with those of every coefficient.
#[derive(Serialize)]
pub(crate) struct RatesAsk<'a> {
    wrt: &'a str,
    value: f64,
    omega: f64,
    phi: f64,
    state: &'a [f64],
    modes: Vec<ModeRatesAsk<'a>>,
}

/// The derivatives of a mode's coefficients.
#[derive(Serialize)]
struct ModeRatesAsk<'a> {
    #[serde(rename = "A")]
    a: &'a [Vec<f64>],
    #[serde(rename = "B")]
    b: &'a [[f64; 2]],
    c: &'a [f64],
    events: Vec<EventRatesAsk<'a>>,
}

#[derive(Serialize)]
struct EventRatesAsk<'a> {
    guard: &'a [f64],
    reset: Option<&'a [Row]>,
}

#[derive(Serialize)]
struct SystemAsk<'a> {
    name: &'a str,
    states: &'a [String],
    scales: &'a [f64],
    time_scale: f64,
    omega: f64,
    phi: f64,
    modes: Vec<ModeAsk<'a>>,
}

/// A mode, in requests and in the files of cases.
#[derive(Serialize)]
pub(crate) struct ModeAsk<'a> {
    name: &'a str,
    #[serde(rename = "A")]
    a: &'a [Vec<f64>],
    #[serde(rename = "B")]
    b: &'a [[f64; 2]],
    c: &'a [f64],
    events: Vec<EventAsk<'a>>,
}

#[derive(Serialize)]
struct EventAsk<'a> {
    name: &'a str,
    guard: &'a [f64],
    direction: &'static str,
    reset: Option<&'a [Row]>,
    successors: Vec<SuccessorAsk<'a>>,
}

#[derive(Serialize)]
struct SuccessorAsk<'a> {
    when: Option<&'a [f64]>,
    mode: usize,
}

/// Every engine is given its tolerance as both, whatever the scales of the states.
#[derive(Serialize)]
struct Tolerance {
    relative: f64,
    absolute: f64,
}

/// The time scales that an expert knows of a system.
#[derive(Serialize)]
pub(crate) struct TimesAsk {
    period: f64,
    turn: Option<f64>,
    shortest: f64,
}

#[derive(Serialize)]
struct LimitsAsk {
    calls: u64,
    events: usize,
    wall_s: f64,
}

impl<'a> RunAsk<'a> {
    /// The request for a task, in a set-up of a program.
    pub(crate) fn new(setup: &'a str, task: &'a Task, accuracy: Accuracy, limits: &Limits) -> Self {
        let checked = &*task.system;
        let tolerance = |size: f64| Tolerance { relative: size, absolute: size };
        Self {
            setup,
            system: SystemAsk::new(checked.system()),
            backward: checked.is_backward(),
            mode: task.mode,
            state: &task.state,
            span: task.span,
            samples: samples(task),
            tolerance: accuracy.tolerance().map(tolerance),
            step: accuracy.step().map(|step| step * checked.shortest_time()),
            times: TimesAsk::new(checked),
            limits: LimitsAsk {
                calls: limits.calls,
                events: limits.events,
                wall_s: OWN_TIME_SHARE * limits.wall.as_secs_f64(),
            },
            gradients: task.gradients.iter().flat_map(|it| it.iter()).map(RatesAsk::new).collect(),
        }
    }

    /// The number of samples that are asked for.
    pub(crate) fn samples(&self) -> usize {
        self.samples.len()
    }
}

impl<'a> RatesAsk<'a> {
    pub(crate) fn new(rates: &'a CoefficientDerivatives) -> Self {
        Self {
            wrt: &rates.name,
            value: rates.value,
            omega: rates.omega,
            phi: rates.phi,
            state: &rates.state,
            modes: rates.modes.iter().map(ModeRatesAsk::new).collect(),
        }
    }
}

impl<'a> ModeRatesAsk<'a> {
    fn new(mode: &'a Mode) -> Self {
        let until = mode
            .until
            .iter()
            .map(|it| EventRatesAsk { guard: &it.guard, reset: it.reset.as_deref() });
        let watch = mode.watch.iter().map(|it| EventRatesAsk { guard: &it.guard, reset: None });
        Self { a: &mode.a, b: &mode.b, c: &mode.c, events: until.chain(watch).collect() }
    }
}

impl TimesAsk {
    /// The time scales of a system.
    pub(crate) fn new(system: &CheckedSystem) -> Self {
        Self {
            period: system.period(),
            turn: Some(system.turn()).filter(|turn| turn.is_finite()),
            shortest: system.shortest_time(),
        }
    }
}

/// The times at which a task wants the state.
pub(crate) fn samples(task: &Task) -> Vec<f64> {
    let times = task.watched.as_ref().map_or(&task.samples, |watched| &watched.instants);
    times.iter().map(|time| time.min(task.span)).collect()
}

impl<'a> SystemAsk<'a> {
    fn new(system: &'a System) -> Self {
        Self {
            name: &system.name,
            states: &system.states,
            scales: &system.scales,
            time_scale: system.time_scale,
            omega: system.omega,
            phi: system.phi,
            modes: system.modes.iter().map(ModeAsk::new).collect(),
        }
    }
}

impl<'a> ModeAsk<'a> {
    /// A mode with its events.
    pub(crate) fn new(mode: &'a Mode) -> Self {
        let until = mode.until.iter().map(|it| EventAsk {
            name: &it.name,
            guard: &it.guard,
            direction: Direction::Rising.as_str(),
            reset: it.reset.as_deref(),
            successors: it.next.iter().map(successor).collect(),
        });
        let watch = mode.watch.iter().map(|it| EventAsk {
            name: &it.name,
            guard: &it.guard,
            direction: it.direction.as_str(),
            reset: None,
            successors: Vec::new(),
        });
        let events = until.chain(watch).collect();
        Self { name: &mode.name, a: &mode.a, b: &mode.b, c: &mode.c, events }
    }
}

fn successor((when, mode): &(Option<Row>, usize)) -> SuccessorAsk<'_> {
    SuccessorAsk { when: when.as_deref(), mode: *mode }
}
