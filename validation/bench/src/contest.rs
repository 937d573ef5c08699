//! All contestants on one case: which settings give the right answer, and how fast.

use super::contestant::{Contestant, settings as settings_of};
use super::rounds::{Benchmark, PACE, RoundTimes, time_interleaved};
use super::timed::ContestEntry;
use super::timed_case::{Score, TimedCase};
use crate::engine::{Accuracy, Declaration, Failure, REFERENCE, Stepping, Work};

/// A contestant at one setting, with its score and its times.
#[derive(Clone, Debug)]
pub struct SettingResult {
    /// The name of the contestant.
    pub name: &'static str,
    /// The library that the contestant belongs to.
    pub library: &'static str,
    /// How the contestant chooses its steps.
    pub stepping: Stepping,
    /// The tolerance or the step that was asked for.
    pub setting: Accuracy,
    /// Score and times, or why there are none: a wrong answer has no time.
    pub result: Result<Timed, Failure>,
}

/// A right answer and its times.
#[derive(Clone, Debug)]
pub struct Timed {
    /// The errors of the answer.
    pub score: Score,
    /// The evaluations and steps that the run counted.
    pub work: Work,
    /// The best time of each round, ns per forcing period.
    pub series: RoundTimes,
    /// The harness's share of the time: one less the median over the rounds of one round's
    /// quotient, the engine's part alone ([`super::library_part`]) over the whole run. A share that
    /// is next to nothing may come out below zero.
    pub harness_share: Option<HarnessShare>,
}

/// A share of a time, measured in several rounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HarnessShare {
    /// One less the median of the rounds' quotients.
    pub share: f64,
    /// Half the distance between the least and the largest share of a round.
    pub spread: f64,
}

impl HarnessShare {
    fn new(part: &RoundTimes, whole: &RoundTimes) -> Option<Self> {
        let (share, spread) = (1.0 - part.ratio_to(whole), part.ratio_spread(whole));
        (share.is_finite() && spread.is_finite()).then_some(Self { share, spread })
    }
}

/// Times the contestants that run the case's system, at all their settings, in interleaved rounds.
pub fn contest(
    case: &TimedCase,
    contestants: &[&dyn Contestant],
    rounds: usize,
    done: &dyn Fn(),
) -> Vec<SettingResult> {
    let (able, others): (Vec<&dyn Contestant>, Vec<&dyn Contestant>) =
        contestants.iter().copied().partition(|it| it.takes(case));
    (0..size(&others, rounds)).for_each(|_| done());
    let settings = |it: &&dyn Contestant| settings_of(it.declaration().stepping);
    let asked = able.iter().flat_map(|it| settings(it).into_iter().map(move |s| (*it, s)));
    contest_at(case, &asked.collect::<Vec<_>>(), rounds, done)
}

/// Times contestants at the settings given in interleaved rounds.
pub fn contest_at(
    case: &TimedCase,
    asked: &[(&dyn Contestant, Accuracy)],
    rounds: usize,
    done: &dyn Fn(),
) -> Vec<SettingResult> {
    let entered = asked.iter().map(|(contestant, setting)| {
        let entry = contestant.enter(case, *setting);
        done();
        PreparedRun { declaration: contestant.declaration(), setting: *setting, entry }
    });
    timed_runs(entered.collect(), case.periods(), rounds, done)
}

/// Times the contestants whose first answer was right.
fn timed_runs(
    mut all: Vec<PreparedRun<'_>>,
    periods: f64,
    rounds: usize,
    done: &dyn Fn(),
) -> Vec<SettingResult> {
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
    // A contestant without a right answer takes no time; its share of the progress is done.
    (0..rounds * (places - benchmarks.len())).for_each(|_| done());
    let mut times = time_interleaved(&mut benchmarks, rounds, PACE, done).into_iter();
    let mut next = || times.next().unwrap_or_else(|| Err(Failure::new("not timed")));
    let mut timed = |entry: Result<ContestEntry<'_>, Failure>| {
        let ContestEntry { timed, library_part } = entry?;
        let (whole, library_part) = (next(), library_part.map(|_| next()));
        let whole = whole?;
        let part = library_part.and_then(Result::ok);
        let harness_share = part.and_then(|part| HarnessShare::new(&part, &whole));
        let scale = 1.0 / (timed.runs() * periods);
        let series = RoundTimes(whole.0.into_iter().map(|time| time * scale).collect());
        Ok(Timed { score: timed.score()?, work: timed.work(), series, harness_share })
    };
    let result = |PreparedRun { declaration, setting, entry }| {
        let Declaration { name, library, stepping, .. } = declaration;
        SettingResult { name, library, stepping, setting, result: timed(entry) }
    };
    all.into_iter().map(result).collect()
}

/// A contestant made ready at a setting, or why it is not timed.
struct PreparedRun<'a> {
    declaration: Declaration,
    setting: Accuracy,
    entry: Result<ContestEntry<'a>, Failure>,
}

/// The number of progress steps of a contest.
#[must_use]
pub fn size(contestants: &[&dyn Contestant], rounds: usize) -> u64 {
    let settings: usize =
        contestants.iter().map(|it| settings_of(it.declaration().stepping).len()).sum();
    (settings * (2 * rounds + 1)) as u64
}

/// The exact solver's result, with which all others are compared.
#[must_use]
pub fn exact(results: &[SettingResult]) -> Option<&Timed> {
    let own = results.iter().find(|it| it.stepping == Stepping::Exact && it.name == REFERENCE);
    own?.result.as_ref().ok()
}

/// Each contestant's most accurate setting: the right answer with the least error.
#[must_use]
pub fn most_accurate<'a>(results: &'a [SettingResult], name: &str) -> Option<&'a SettingResult> {
    let error =
        |it: &&SettingResult| it.result.as_ref().map_or(f64::INFINITY, |it| it.score.state_error);
    let own = results.iter().filter(|it| it.name == name && it.result.is_ok());
    own.min_by(|a, b| error(a).total_cmp(&error(b)))
}
