//! diffsol's sensitivities as an expert takes them through events: percuss's own engine finds them;
//! each stretch between two of them is run again by a fresh solver with its sensitivities in the
//! error control, and the jump at its end is added by hand.

use crate::percuss_program::derivatives::{Passed, Stretch, chained, sum};
use crate::percuss_program::{Course, Event, Mode};
use diffsol::{
    NalgebraLU, NalgebraMat, NalgebraVec, OdeBuilder, OdeEquationsImplicitSens,
    OdeSolverStopReason, SensitivitiesOdeSolverMethod,
};
use percuss_engines::engine::{Accuracy, Ending, Limits, Outcome, Task, answer};
use percuss_engines::integrators;
use percuss_engines::system::{self, CheckedSystem, Direction, System, Until, Watch};
use std::error::Error;
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;

/// A stretch that is shorter than this, relative to its end, moves no digit of a derivative; the
/// library refuses a stop that is as near as that.
const NO_STRETCH: f64 = 1e3 * f64::EPSILON;

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
fn engines_run(course: &Course) -> Result<Outcome, Box<dyn Error>> {
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
    let name = format!("diffsol-{}", run.setup.trim_end_matches("-saltation"));
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

/// Steps to the stop time; the derivatives there, a list for each name.
fn to_the_end<'a, Eqn>(
    course: &Course,
    mut solver: impl SensitivitiesOdeSolverMethod<'a, Eqn>,
    end: f64,
) -> Result<Vec<Vec<f64>>, Box<dyn Error>>
where
    Eqn: OdeEquationsImplicitSens<T = f64, V = NalgebraVec<f64>> + 'a,
{
    solver.set_stop_time(end)?;
    while !matches!(solver.step()?, OdeSolverStopReason::TstopReached) {
        course.within_limits()?;
    }
    let names = course.run.gradients.len();
    Ok((0..names).map(|n| solver.state().s.batch_as_slice(n).to_vec()).collect())
}

/// Derivatives at fixed times along a stretch without events.
fn along(
    course: &Course,
    stretch: &Stretch<'_>,
    states: Vec<Vec<f64>>,
) -> Result<Vec<Vec<f64>>, Box<dyn Error>> {
    let Stretch { mode, begin, state, end } = *stretch;
    if end - begin <= NO_STRETCH * end {
        return Ok(states);
    }
    let (by, size) = (&course.run.gradients, state.len());
    let (relative, absolute) = (course.run.tolerance.relative, course.run.tolerance.absolute);
    let problem = OdeBuilder::<NalgebraMat<f64>>::new()
        .t0(begin)
        .rtol(relative)
        .atol([absolute])
        .sens_rtol(relative)
        .sens_atol([absolute])
        .p(by.iter().map(|it| it.value))
        .rhs_sens_implicit(
            |z, _, t, out| out.copy_from_slice(&mode.rates(t, z)),
            |_, _, _, v, out| out.copy_from_slice(&mode.jacobian(v)),
            |z, _, t, v, out| out.copy_from_slice(&sum(v, size, |n| by[n].field(mode, t, z))),
        )
        .init_sens(
            |_, _, out| out.copy_from_slice(state),
            |_, _, v, out| out.copy_from_slice(&sum(v, size, |n| states[n].clone())),
            size,
        )
        .build()?;
    if course.run.setup.starts_with("bdf") {
        to_the_end(course, problem.bdf_sens::<NalgebraLU<f64>>()?, end)
    } else {
        to_the_end(course, problem.tsit45_sens()?, end)
    }
}

/// Makes a run, with its derivatives where they are asked for.
pub fn make(course: &mut Course) -> Result<(), Box<dyn Error>> {
    let outcome = engines_run(course)?;
    let trail = trail(course, &outcome)?;
    if !course.run.gradients.is_empty() && outcome.ended == Ending::Horizon {
        let (modes, first) = course.modes();
        let by_stretch = |stretch: &Stretch<'_>, states| along(course, stretch, states);
        course.derivatives = chained(&course.run, &modes[first], &trail, by_stretch)?;
    }
    adopt(course, &outcome, &trail);
    Ok(())
}
