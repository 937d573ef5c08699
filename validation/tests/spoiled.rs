//! Answers that are spoiled in one way each: none of them passes.

use percuss::Phase;
use percuss_validation::case::defaults;
use percuss_validation::engine::{
    Accuracy, Declaration, Engine, Event, Failure, Limits, Numbers, Outcome, Task, place,
};
use percuss_validation::integrators::exact;
use percuss_validation::score::Verdict;
use percuss_validation::suite::{Suite, run};
use percuss_validation::system::Values;

/// The exact solver's answer with one change.
struct Spoiled {
    name: &'static str,
    change: fn(&mut Outcome),
}

impl Engine for Spoiled {
    fn declaration(&self) -> Declaration {
        // Bounds of the exact solver are for every name that begins like it.
        Declaration { name: self.name, ..exact().declaration() }
    }

    fn run(&self, task: &Task, accuracy: Accuracy, limits: &Limits) -> Result<Outcome, Failure> {
        let mut outcome = exact().run(task, accuracy, limits)?;
        (self.change)(&mut outcome);
        Ok(outcome)
    }
}

const fn spoiled(name: &'static str, change: fn(&mut Outcome)) -> Spoiled {
    Spoiled { name, change }
}

/// Two events that are not there, from this time on.
fn add_spurious(outcome: &mut Outcome, at: usize, elapsed: f64) {
    let state = Values::from_slice(&[0.0; 4]);
    let event =
        |phase, elapsed| Event { event: 0, mode: place(phase), elapsed, state, before: None };
    let pair = [event(Phase::Contact, elapsed), event(Phase::NoContact, elapsed + 1e-9)];
    outcome.events.splice(at..at, pair);
}

static UNSPOILED: Spoiled = spoiled("exact-as-it-is", |_| ());
static FAILING: [Spoiled; 7] = [
    spoiled("exact-nan-sample", |it| it.samples[9][1] = f64::NAN),
    spoiled("exact-nan-event", |it| it.events[3].state[0] = f64::NAN),
    spoiled("exact-samples-late", |it| it.samples.rotate_left(1)),
    spoiled("exact-spurious-in-the-middle", |it| {
        let elapsed = it.events[4].elapsed + 1e-6;
        add_spurious(it, 5, elapsed);
    }),
    spoiled("exact-spurious-at-the-end", |it| {
        let elapsed = it.events.last().map_or(0.0, |last| last.elapsed) + 1e-6;
        add_spurious(it, it.events.len(), elapsed);
    }),
    spoiled("exact-drops-the-last", |it| {
        it.events.pop();
    }),
    // The bound of four units is on every event; the samples stay right.
    spoiled("exact-events-off-by-100-eps", |it| {
        it.events.iter_mut().for_each(|event| event.state[0] += 100.0 * f64::EPSILON);
    }),
];
static ERRING: [Spoiled; 4] = [
    spoiled("exact-few-samples", |it| it.samples.truncate(2)),
    spoiled("exact-surplus-sample", |it| it.samples.push(Values::from_slice(&[0.0; 4]))),
    spoiled("exact-event-without-time", |it| it.events[3].elapsed = f64::NAN),
    spoiled("exact-events-out-of-order", |it| it.events.swap(2, 5)),
];

#[test]
fn no_spoiled_answer_passes() {
    let cases =
        crate::exact::prepared(|name| name == "impact-into-progression", Some(Suite::Quick));
    let defaults = defaults().expect("the bounds are read");
    let verdict = |engine: &'static Spoiled| {
        let rows = run(&cases, &[engine], &Suite::Quick.into(), &defaults, &|| ());
        assert_eq!(rows.len(), 1);
        rows[0].judgement.verdict
    };
    assert_eq!(verdict(&UNSPOILED), Verdict::Pass);
    for engine in &FAILING {
        assert_eq!(verdict(engine), Verdict::Fail, "{}", engine.name);
    }
    for engine in &ERRING {
        assert_eq!(verdict(engine), Verdict::Error, "{}", engine.name);
    }
}
