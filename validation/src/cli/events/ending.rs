//! The ending of a run, and what is said of it on stderr.

use super::digits::outward;
use super::no_progress;
use super::progress::{Accumulation, Passed, RunEnd};
use super::rows::{Rows, UNDECIDED};
use percuss::affine::{Arithmetic, EnclosedRun, Ending, Event, What};
use percuss::number::{Bound, Number};

impl<T: Arithmetic> Rows<'_, T> {
    /// The event's name, or that of the ending, which leaves a note.
    pub(super) fn name(&self, event: &Event<T>, passed: &Passed<T>, end: &mut RunEnd) -> String {
        let What::End(ending) = &event.what else {
            return self.event_name(&event.what).unwrap_or_default().to_owned();
        };
        let (name, note, decided) = match ending {
            Ending::Horizon => return "end".to_owned(),
            Ending::Accumulation(from, to) => {
                let (note, found) = accumulation(event, *from, *to);
                end.accumulation = Some(found);
                ("accumulation", note, true)
            }
            Ending::LeavesDomain => {
                ("leaves-domain", "the boundary of the mode is reached".to_owned(), true)
            }
            Ending::NoProgress => {
                ("no-progress", no_progress::note(self.system, &passed.recent), false)
            }
            Ending::BeyondGuard => {
                ("beyond-guard", "the mode is entered beyond one of its guards".to_owned(), false)
            }
            Ending::Undecided => {
                self.is_undecided(&self.time(event), end);
                return UNDECIDED.to_owned();
            }
        };
        end.notes.push(format!("the run ends at {}: {note}", self.time(event)));
        if *ending == Ending::NoProgress {
            end.notes.extend(no_progress::remedy(self.system, &passed.recent));
        }
        end.undecided = !decided;
        name.to_owned()
    }

    /// Says that a run ends undecided at a time.
    pub(super) fn is_undecided(&self, time: &str, end: &mut RunEnd) {
        let bits = T::BITS;
        end.notes
            .push(format!("the run ends at {time}: what comes next is not decided by {bits} bits"));
        end.undecided = true;
    }

    /// The name of the ending of a run that has as many events as it may have, which leaves a note.
    pub(super) fn stopped(&self, last: &Event<T>, end: &mut RunEnd) -> String {
        let most = self.limits.most.unwrap_or_default();
        let time = self.time(last);
        end.notes.push(format!("the run is stopped at {time}, after {most} events: --max-events"));
        "stopped".to_owned()
    }

    /// What a run that had to end where it did says of it.
    pub(super) fn cause(&self, run: &dyn EnclosedRun<T>) -> Option<String> {
        match run.ending()? {
            Ending::Undecided => Some(self.search_note(run)),
            Ending::BeyondGuard => {
                let guard = self.event_name(&run.beyond()?)?.to_owned();
                Some(format!("the guard of \"{guard}\" is positive there"))
            }
            _ => None,
        }
    }

    /// How far the search for the next event of an undecided run came, and what it left open.
    fn search_note(&self, run: &dyn EnclosedRun<T>) -> String {
        let searched = about(run.searched().value().to_f64());
        if run.overflows() {
            return format!(
                "its state at about {searched} is too large for its bounds to be numbers"
            );
        }
        let is_one = run.tie().is_empty() && run.doubtful().is_some();
        let near = run.resolution().filter(|_| is_one);
        let near = near.map_or(String::new(), |it| {
            format!(": nearer to zero than {} it is not known", size(it))
        });
        // More bits may run out of work before they meet what fewer of them left open.
        let open = self.open(run).or_else(|| self.left.open.clone());
        let open = open.map_or(String::new(), |it| format!(", where rounding leaves open {it}"));
        format!("its search for the next event came to about {searched}{open}{near}")
    }

    /// What rounding left open where a search ended: which guard is first, or whether one crosses.
    pub(super) fn open(&self, run: &dyn EnclosedRun<T>) -> Option<String> {
        let quoted = |it: &What<T>| self.event_name(it).map(|name| format!("\"{name}\""));
        let tie: Vec<String> = run.tie().iter().filter_map(quoted).collect();
        if let [others @ .., last] = &tie[..] {
            let others = others.join(", ");
            return Some(format!("which of the guards of {others} and {last} crosses first"));
        }
        let name = run.doubtful().as_ref().and_then(quoted)?;
        Some(format!("whether the guard of {name} crosses"))
    }

    /// The name of an event, if it is none of a start or an ending.
    fn event_name(&self, what: &What<T>) -> Option<&str> {
        match what {
            What::Until(mode, index) => Some(&self.system.modes[*mode].until[*index].name),
            What::Watch(mode, index) => Some(&self.system.modes[*mode].watch[*index].name),
            What::Start | What::End(_) => None,
        }
    }
}

/// The instant at which impacts accumulate, between two times after the last of them.
fn accumulation<T: Number>(last: &Event<T>, from: T, to: T) -> (String, Accumulation) {
    /// The digits of each end, which is rounded away from the other.
    const DIGITS: i32 = 30;
    let time = last.time.value();
    let error = last.errors.as_ref().map_or(0.0, |it| it.time.to_f64());
    let middle = time + (from + to) * T::exact(0.5);
    let width = 0.5 * (to - from).to_f64() + error + 1e-29 * time.to_f64().abs();
    let [earliest, latest] =
        [-width, width].map(|it| outward(middle + T::exact(it), it > 0.0, DIGITS));
    let note = format!("infinitely many impacts accumulate between {earliest} and {latest}");
    (note, Accumulation { earliest, latest })
}

/// The order of a size, which may be beyond the exponents of f64.
fn size<B: Bound>(size: B) -> String {
    let (mantissa, exponent) = size.parts();
    let power = mantissa.log10() + exponent as f64 * std::f64::consts::LOG10_2;
    format!("1e{}", power.ceil())
}

/// A number to six digits, with an exponent where it is large.
fn about(number: f64) -> String {
    let rounded = format!("{number:.5e}").parse().unwrap_or(number);
    let text = format!("{rounded:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}
