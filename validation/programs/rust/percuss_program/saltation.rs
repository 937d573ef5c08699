//! Derivatives by experts: one of percuss's own engines finds the events, a library's derivatives
//! of each stretch between two of them are taken anew, and the jump at its end is added by hand.

use super::derivatives::{Passed, Stretch, chained};
use super::{Course, Event, Mode};
use percuss_engines::engine::{Accuracy, Ending, Limits, Outcome, Task, answer};
use percuss_engines::integrators;
use percuss_engines::system::{self, CheckedSystem, Direction, System, Until, Watch};
use std::error::Error;
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;

/// A stretch that is shorter than this, relative to its end, moves no digit of a derivative;
/// libraries refuse an end that is as near as that.
const MIN_STRETCH_SHARE: f64 = 1e3 * f64::EPSILON;

fn until(event: &Event) -> Until {
    let next = event.successors.iter().map(|it| (it.when.clone(), it.mode)).collect();
    let (name, guard) = (event.name.clone(), event.guard().to_vec());
    Until { name, guard, reset: event.reset.clone(), next }
}

fn watch(event: &Event) -> Watch {
    let direction = match event.direction.as_str() {
        "rising" => Direction::Rising,
        "falling" => Direction::Falling,
        _ => Direction::Both,
    };
    Watch { name: event.name.clone(), guard: event.guard().to_vec(), direction }
}

/// A mode, as engines are given it.
fn mode(mode: &Mode) -> system::Mode {
    let wire = &mode.wire;
    let (ends, counted): (Vec<_>, Vec<_>) = mode.events().iter().partition(|it| it.ends());
    system::Mode {
        name: wire.name.clone(),
        a: wire.a.clone(),
        b: wire.b.clone(),
        c: wire.c.clone(),
        until: ends.into_iter().map(until).collect(),
        watch: counted.into_iter().map(watch).collect(),
    }
}

/// The run of one of percuss's own engines.
fn engines_run(course: &Course, name: &str) -> Result<Outcome, Box<dyn Error>> {
    let run = &course.run;
    let system = System {
        name: run.system.name.clone(),
        states: run.system.states.clone(),
        drift: Vec::new(),
        scales: run.system.scales.clone(),
        time_scale: run.system.time_scale,
        omega: run.system.omega,
        phi: run.system.phi,
        modes: course.modes().0.iter().map(|it| mode(it)).collect(),
    };
    let system = Arc::new(CheckedSystem::new(system)?);
    let task = Task::new(system, run.mode, &run.state, run.span, run.samples.clone())?;
    let engine = integrators::all().iter().find(|it| it.declaration().name == name);
    let engine = engine.ok_or_else(|| format!("percuss has no engine {name}"))?;
    let limits = Limits {
        calls: run.limits.calls,
        events: run.limits.events,
        wall: Duration::from_secs_f64(run.limits.wall_s),
    };
    Ok(answer(*engine, &task, Accuracy::Tolerance(run.tolerance.relative), &limits)?)
}

/// The events of a run with the modes around them.
fn trail(course: &Course, outcome: &Outcome) -> Result<Vec<Passed>, Box<dyn Error>> {
    let (modes, mut now) = course.modes();
    let mut trail = Vec::new();
    for event in &outcome.events {
        let before = event.before.as_ref().ok_or("an event has no state before it")?;
        trail.push(Passed {
            t: event.elapsed,
            mode: Rc::clone(&modes[now]),
            event: event.event,
            before: before.to_vec(),
            follows: Rc::clone(&modes[event.mode]),
            after: event.state.to_vec(),
        });
        now = event.mode;
    }
    Ok(trail)
}

/// Answers the run of the engine.
fn adopt(course: &mut Course, outcome: &Outcome, trail: &[Passed]) {
    for passed in trail {
        course.report(passed);
    }
    let samples = outcome.samples.iter().map(|it| it.to_vec()).collect();
    let ended = (outcome.ended != Ending::Horizon).then(|| outcome.ended.as_str());
    course.end(samples, ended, outcome.ended_at, outcome.end.to_vec());
    let work = &outcome.work;
    course.count(work.rhs_evaluations + work.jacobian_evaluations, work.steps);
}

/// Makes a run of the engine of this name, with its derivatives where they are asked for: `along`
/// takes a stretch without events and the derivatives where it begins, a list for each name, and
/// gives those where it ends.
pub fn make(
    course: &mut Course,
    engine: &str,
    along: impl Fn(&Course, &Stretch<'_>, Vec<Vec<f64>>) -> Result<Vec<Vec<f64>>, Box<dyn Error>>,
) -> Result<(), Box<dyn Error>> {
    let outcome = engines_run(course, engine)?;
    let trail = trail(course, &outcome)?;
    if !course.run.gradients.is_empty() && outcome.ended == Ending::Horizon {
        let (modes, first) = course.modes();
        let by_stretch = |stretch: &Stretch<'_>, states| {
            if stretch.end - stretch.begin <= MIN_STRETCH_SHARE * stretch.end {
                return Ok(states);
            }
            along(course, stretch, states)
        };
        course.derivatives = chained(&course.run, &modes[first], &trail, by_stretch)?;
    }
    adopt(course, &outcome, &trail);
    Ok(())
}
