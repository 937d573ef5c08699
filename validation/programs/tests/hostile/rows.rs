//! Rows of programs that misbehave, one test per kind.

use super::kinds::{ExpectedEnd, KINDS};
use super::left::{left, processes};
use libtest_mimic::{Arguments, Failed, Trial};
use percuss_engines::engine::{Accuracy, Engine, Failure, Limits, Outcome, Task, answer};
use percuss_engines::system::{CheckedSystem, Direction, Mode, System, Until, Watch};
use percuss_programs::{NotStarted, Program, ProgramEngine};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// The time that a program may take that is right; a machine may be busy.
const LONG_TIMEOUT: Duration = Duration::from_secs(120);
/// The time that a program may take that is too late.
const SHORT_TIMEOUT: Duration = Duration::from_secs(1);

/// Runs the tests.
pub fn test() {
    let arguments = Arguments::from_args();
    let kind = |&(kind, expected): &(&'static str, ExpectedEnd)| {
        Trial::test(kind, move || Ok(check(kind, expected)?))
    };
    let mut trials: Vec<Trial> = KINDS.iter().map(kind).collect();
    trials.extend(super::host::trials());
    trials.push(Trial::test("every_kind_is_listed", every_kind_is_listed));
    trials.push(Trial::test("runs_side_by_side", || Ok(runs_side_by_side()?)));
    libtest_mimic::run(&arguments, trials).exit();
}

/// The program of a kind.
pub fn program(kind: &str, token: &str, timeout: Duration) -> Program {
    let own = std::env::current_exe().expect("it is a file").display().to_string();
    let command = match kind {
        "no-command" => vec!["percuss-no-such-command".to_owned()],
        "a-folder-as-command" => vec!["/".to_owned()],
        _ => vec![own, "misbehave".to_owned(), kind.to_owned(), token.to_owned()],
    };
    let name = "program".to_owned();
    Program { name, command, timeout, folder: PathBuf::from(".") }
}

/// Two modes of uniform motion: the first ends at x = 0.5, the second counts where x rises to 1.
pub fn task(samples: usize) -> Task {
    let mode = |name: &str| Mode {
        name: name.to_owned(),
        a: vec![vec![0.0, 1.0], vec![0.0, 0.0]],
        b: vec![[0.0; 2]; 2],
        c: vec![0.0; 2],
        ..Mode::default()
    };
    let half = vec![1.0, 0.0, 0.0, 0.0, -0.5];
    let until = Until { name: "half".to_owned(), guard: half, reset: None, next: vec![(None, 1)] };
    let guard = vec![1.0, 0.0, 0.0, 0.0, -1.0];
    let watch = Watch { name: "one".to_owned(), guard, direction: Direction::Rising };
    let system = System {
        name: "uniform".to_owned(),
        states: vec!["x".to_owned(), "v".to_owned()],
        scales: vec![1.0; 2],
        time_scale: 1.0,
        modes: vec![
            Mode { until: vec![until], ..mode("first") },
            Mode { watch: vec![watch], ..mode("second") },
        ],
        ..System::default()
    };
    let system = Arc::new(CheckedSystem::new(system).expect("the system is whole"));
    let last = samples.saturating_sub(1).max(1) as f64;
    let samples = (0..samples).map(|k| 2.0 * k as f64 / last).collect();
    Task::new(system, 0, &[0.0, 1.0], 2.0, samples).expect("the task is whole")
}

/// What a program makes of the task.
pub fn run(engine: &ProgramEngine, wall: Duration) -> Result<Outcome, Failure> {
    let limits = Limits { calls: 1000, events: 100, wall };
    answer(engine, &task(3), Accuracy::Tolerance(1e-6), &limits)
}

fn check(kind: &str, expected: ExpectedEnd) -> Result<(), String> {
    let token = format!("token-{kind}-{}", std::process::id());
    let timeout =
        if matches!(expected, ExpectedEnd::LateStart(_)) { SHORT_TIMEOUT } else { LONG_TIMEOUT };
    let started = program(kind, &token, timeout).start();
    match (started, expected) {
        (Ok(engines), ExpectedEnd::Right) => rows(kind, &engines, None, &token)?,
        (Ok(engines), ExpectedEnd::Row(why)) => {
            rows(kind, &engines, Some((why, LONG_TIMEOUT)), &token)?
        }
        (Ok(engines), ExpectedEnd::Late(why)) => {
            rows(kind, &engines, Some((why, SHORT_TIMEOUT)), &token)?
        }
        (Err(not @ NotStarted::Unavailable { .. }), ExpectedEnd::Unavailable(why)) => {
            no_rows(not, why)?;
        }
        (
            Err(not @ NotStarted::Failed { .. }),
            ExpectedEnd::Start(why) | ExpectedEnd::LateStart(why),
        ) => {
            no_rows(not, why)?;
        }
        (Ok(_), _) => return Err("it was started".to_owned()),
        (Err(not), _) => return Err(format!("{not:?}")),
    }
    match left(&token) {
        left if left.is_empty() => Ok(()),
        left => Err(format!("processes are left: {left:?}")),
    }
}

/// Several threads run one engine, beside others whose program ends again and again.
fn runs_side_by_side() -> Result<(), String> {
    let token = format!("token-side-by-side-{}", std::process::id());
    let engines = program("exits", &token, LONG_TIMEOUT).start().map_err(|not| not.to_string())?;
    let [good, odd] = engines.as_slice() else { return Err(format!("{}", engines.len())) };
    let one = |thread: usize| -> Result<(), String> {
        for _ in 0..5 {
            match thread % 2 {
                0 => is_right(run(good, LONG_TIMEOUT), "beside others")?,
                _ => drop(run(odd, LONG_TIMEOUT).err().ok_or("the odd row is right")?),
            }
        }
        Ok(())
    };
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..4).map(|thread| scope.spawn(move || one(thread))).collect();
        let joined = threads.into_iter().map(|it| it.join().map_err(|_| "it panics".to_owned())?);
        joined.collect::<Result<Vec<()>, String>>().map(drop)
    })?;
    drop(engines);
    if left(&token).is_empty() { Ok(()) } else { Err("a process is left".to_owned()) }
}

/// A row that is right, one that is odd, and one that is right.
fn rows(
    kind: &str,
    engines: &[ProgramEngine],
    expected: Option<(&str, Duration)>,
    token: &str,
) -> Result<(), String> {
    let [good, odd] = engines else { return Err(format!("{} engines", engines.len())) };
    is_right(run(good, LONG_TIMEOUT), "before")?;
    let Some((why, wall)) = expected else {
        let outcome = run(odd, LONG_TIMEOUT);
        let lacks = |it: &Outcome| match kind {
            "no-work" => it.own_time.is_none(),
            "no-states-before" => it.events.iter().all(|event| event.before.is_none()),
            _ => false,
        };
        return if outcome.as_ref().is_ok_and(lacks) { Ok(()) } else { is_right(outcome, "odd") };
    };
    let outcome = match kind {
        "reads-nothing" => run_of_many_samples(odd, wall),
        _ => run(odd, wall),
    };
    match outcome {
        Ok(_) => return Err("the odd row is right".to_owned()),
        Err(Failure { reason, .. }) if !reason.contains(why) || reason.len() > 1000 => {
            return Err(format!("its reason is {reason}"));
        }
        Err(Failure { reason, .. }) if reason.contains(char::is_control) => return Err(reason),
        Err(_) => {}
    }
    // What refuses an answer that was whole lets the program go on.
    let is_over = ["ended without", "has ended", "gave up"].iter().any(|it| why.contains(it));
    let goes_on = !is_over && processes(token).len() == 1;
    if !goes_on && !left(token).is_empty() {
        return Err("a process is left after its row".to_owned());
    }
    is_right(run(good, LONG_TIMEOUT), "after")
}

/// A request of more bytes than a pipe holds.
fn run_of_many_samples(odd: &ProgramEngine, wall: Duration) -> Result<Outcome, Failure> {
    let limits = Limits { calls: 1000, events: 100, wall };
    answer(odd, &task(50_000), Accuracy::Tolerance(1e-6), &limits)
}

fn is_right(outcome: Result<Outcome, Failure>, which: &str) -> Result<(), String> {
    let outcome = outcome.map_err(|failure| format!("the row {which} fails: {failure}"))?;
    let times: Vec<f64> = outcome.events.iter().map(|event| event.elapsed).collect();
    let before: Vec<Option<f64>> =
        outcome.events.iter().map(|event| event.before.map(|state| state[0])).collect();
    let samples: Vec<f64> = outcome.samples.iter().map(|sample| sample[0]).collect();
    let seen = (times, before, samples, outcome.end[0], outcome.work.rhs_evaluations);
    let before = vec![Some(0.5), Some(0.5)];
    let expected = (vec![0.5, 1.5], before, vec![0.0, 0.25, 0.75], 0.75, 30);
    if seen == expected && outcome.own_time == Some(Duration::from_nanos(1)) {
        return Ok(());
    }
    Err(format!("the row {which} is {seen:?}"))
}

/// The rows of a program that was not started.
fn no_rows(not: NotStarted, why: &str) -> Result<(), String> {
    let text = not.to_string();
    if !text.contains(why) || text.len() > 1000 {
        return Err(text);
    }
    let is_absent = matches!(not, NotStarted::Unavailable { .. });
    let engine = not.stand_in();
    if engine.available().is_err() != is_absent || engine.declaration().name != "program" {
        return Err(format!("available: {:?}", engine.available()));
    }
    match run(&engine, LONG_TIMEOUT) {
        Err(Failure { reason, .. }) if reason.contains(why) => Ok(()),
        other => Err(format!("{other:?}")),
    }
}

/// The protocol's page lists every kind, and no other.
fn every_kind_is_listed() -> Result<(), Failed> {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/PROTOCOL.md");
    let page = std::fs::read_to_string(page)?;
    let (_, list) = page.split_once("\n## What a program may do wrong\n").unwrap_or_default();
    let rows = list.lines().filter_map(|line| line.strip_prefix("| `")?.split_once("` | "));
    let listed: Vec<&str> = rows.map(|(kind, _)| kind).collect();
    let kinds: Vec<&str> = KINDS.iter().map(|(kind, _)| *kind).collect();
    if listed != kinds {
        return Err(format!("docs/PROTOCOL.md lists {listed:#?}").into());
    }
    Ok(())
}
