//! One case, all contestants: who answers rightly at which setting, and how fast.

use super::contestant::{Contestant, settings as settings_of};
use super::rounds::{Benchmark, PACE, RoundTimes, race};
use super::timed::ContestEntry;
use super::timed_case::{Score, TimedCase};
use super::timed_system_case::TimedSystemCase;
use crate::engine::{Accuracy, Declaration, Failure, REFERENCE, Stepping, Work};

/// A contestant at a setting, and what came of it.
#[derive(Clone, Debug)]
pub struct Finisher {
    /// The contestant.
    pub name: &'static str,
    /// The library it is of.
    pub library: &'static str,
    /// How it chooses its steps.
    pub stepping: Stepping,
    /// What it was asked for.
    pub setting: Accuracy,
    /// Score and times, or why there are none: a wrong answer has no time.
    pub result: Result<Timed, Failure>,
}

/// A right answer and its times.
#[derive(Clone, Debug)]
pub struct Timed {
    /// How good the answer is.
    pub score: Score,
    /// What the run counted.
    pub work: Work,
    /// The best time of each round, ns a forcing period.
    pub series: RoundTimes,
    /// What share of the time is the harness's own: one less the median over the rounds of that
    /// round's quotient, the engine's part alone ([`super::library_part`]) over the whole run. A
    /// share that is next to nothing may come out below zero.
    pub harness_share: Option<f64>,
}

/// Races all contestants at all their settings.
pub fn contest(
    case: &TimedCase,
    contestants: &[&dyn Contestant],
    rounds: usize,
    done: &dyn Fn(),
) -> Vec<Finisher> {
    let settings = |it: &&dyn Contestant| settings_of(it.declaration().stepping);
    let asked = contestants.iter().flat_map(|it| settings(it).into_iter().map(move |s| (*it, s)));
    contest_at(case, &asked.collect::<Vec<_>>(), rounds, done)
}

/// Races contestants at the settings given.
pub fn contest_at(
    case: &TimedCase,
    asked: &[(&dyn Contestant, Accuracy)],
    rounds: usize,
    done: &dyn Fn(),
) -> Vec<Finisher> {
    let entered = asked.iter().map(|(contestant, setting)| {
        let entry = qualified(*contestant, case, *setting);
        done();
        Entrant { declaration: contestant.declaration(), setting: *setting, entry }
    });
    raced(entered.collect(), case.periods(), rounds, done)
}

/// Races the contestants that run the case's system, at all their settings.
pub fn system_contest(
    case: &TimedSystemCase,
    contestants: &[&dyn Contestant],
    rounds: usize,
    done: &dyn Fn(),
) -> Vec<Finisher> {
    let (able, others): (Vec<&dyn Contestant>, Vec<&dyn Contestant>) =
        contestants.iter().copied().partition(|it| it.takes(case));
    (0..size(&others, rounds)).for_each(|_| done());
    let settings = |it: &&dyn Contestant| settings_of(it.declaration().stepping);
    let asked = able.iter().flat_map(|it| settings(it).into_iter().map(move |s| (*it, s)));
    let entered = asked.map(|(contestant, setting)| {
        let entry = contestant.enter_system(case, setting).and_then(right);
        done();
        Entrant { declaration: contestant.declaration(), setting, entry }
    });
    raced(entered.collect(), case.periods(), rounds, done)
}

/// Races the contestants whose first answer was right.
fn raced(mut all: Vec<Entrant<'_>>, periods: f64, rounds: usize, done: &dyn Fn()) -> Vec<Finisher> {
    let places = 2 * all.len();
    let mut benchmarks: Vec<&mut dyn Benchmark> = Vec::new();
    for ContestEntry { timed, library_part } in
        all.iter_mut().filter_map(|it| it.entry.as_mut().ok())
    {
        benchmarks.push(&mut **timed);
        if let Some(part) = library_part {
            benchmarks.push(&mut **part);
        }
    }
    // Those that are out take no time; their share of the work is done.
    (0..rounds * (places - benchmarks.len())).for_each(|_| done());
    let mut raced = race(&mut benchmarks, rounds, PACE, done).into_iter();
    let mut next = || raced.next().unwrap_or_else(|| Err(Failure::new("not raced")));
    let mut result = |entry: Result<ContestEntry<'_>, Failure>| {
        let ContestEntry { timed, library_part } = entry?;
        let (whole, library_part) = (next(), library_part.map(|_| next()));
        let whole = whole?;
        let share = library_part.and_then(Result::ok).map(|part| 1.0 - part.ratio_to(&whole));
        let scale = 1.0 / (timed.runs() * periods);
        let series = RoundTimes(whole.0.into_iter().map(|time| time * scale).collect());
        let harness_share = share.filter(|it| it.is_finite());
        Ok(Timed { score: timed.score()?, work: timed.work(), series, harness_share })
    };
    let finisher = |Entrant { declaration, setting, entry }| {
        let Declaration { name, library, stepping, .. } = declaration;
        Finisher { name, library, stepping, setting, result: result(entry) }
    };
    all.into_iter().map(finisher).collect()
}

/// A contestant at a setting, if its answer is right.
struct Entrant<'a> {
    declaration: Declaration,
    setting: Accuracy,
    entry: Result<ContestEntry<'a>, Failure>,
}

/// The contestants that are timed: those whose answer is right.
fn qualified<'a>(
    contestant: &'a dyn Contestant,
    case: &'a TimedCase,
    setting: Accuracy,
) -> Result<ContestEntry<'a>, Failure> {
    let timed = contestant.enter(case, setting)?;
    let entry = right(ContestEntry { timed, library_part: None })?;
    Ok(ContestEntry { library_part: contestant.library_part(case, setting)?, ..entry })
}

/// A contestant whose answer is right.
fn right(mut entry: ContestEntry<'_>) -> Result<ContestEntry<'_>, Failure> {
    entry.timed.call()?;
    entry.timed.score()?;
    Ok(entry)
}

/// How much work a contest is, for progress.
#[must_use]
pub fn size(contestants: &[&dyn Contestant], rounds: usize) -> u64 {
    let settings: usize =
        contestants.iter().map(|it| settings_of(it.declaration().stepping).len()).sum();
    (settings * (2 * rounds + 1)) as u64
}

/// The exact solver's row, which all others are held against.
#[must_use]
pub fn exact(finishers: &[Finisher]) -> Option<&Timed> {
    let own = finishers.iter().find(|it| it.stepping == Stepping::Exact && it.name == REFERENCE);
    own?.result.as_ref().ok()
}

/// Each contestant's most accurate setting: the right answer with the least error.
#[must_use]
pub fn most_accurate<'a>(finishers: &'a [Finisher], name: &str) -> Option<&'a Finisher> {
    let error =
        |it: &&Finisher| it.result.as_ref().map_or(f64::INFINITY, |it| it.score.state_error);
    let own = finishers.iter().filter(|it| it.name == name && it.result.is_ok());
    own.min_by(|a, b| error(a).total_cmp(&error(b)))
}
