//! The rows of `events`, made one by one: a long run costs no memory.

use super::digits::{has_digits, proved};
use crate::truth::DoubleDouble;
use anyhow::{Result, bail};
use percuss::affine::{Ending, Event, Run, Solver, System, What};
use percuss::number::Number;
use serde::Serialize;

/// The system, horizon and digits of a run.
pub(super) struct Rows<'a> {
    pub(super) system: &'a System,
    pub(super) solver: &'a Solver<DoubleDouble>,
    pub(super) digits: usize,
    pub(super) most: Option<usize>,
}

/// The ending of a run.
#[derive(Default)]
pub(super) struct RunEnd {
    pub(super) accumulation: Option<Accumulation>,
    pub(super) notes: Vec<String>,
    pub(super) undecided: bool,
}

/// Numbers are texts, because a reader's f64 would not hold their digits.
#[derive(Serialize)]
pub(super) struct EventRow {
    pub(super) n: usize,
    pub(super) time: String,
    pub(super) event: String,
    pub(super) mode: String,
    #[serde(serialize_with = "in_order")]
    pub(super) state: Vec<(String, String)>,
}

#[derive(Serialize)]
pub(super) struct Accumulation {
    earliest: String,
    latest: String,
}

/// Takes a row, and the event that it is of.
type Taker<'a> = &'a mut dyn FnMut(EventRow, Event<DoubleDouble>) -> Result<()>;

impl Rows<'_> {
    /// Runs the system from its start, which is row 0.
    pub(super) fn each(&self, until: f64, take: Taker<'_>) -> Result<RunEnd> {
        let start = self.system.start.as_ref();
        let run = start.and_then(|it| self.solver.run_enclosed(it, DoubleDouble::exact(until)));
        let Some(mut run) = run else { bail!("{}: its start is not decided", self.system.name) };
        let mut end = RunEnd::default();
        let begin = run.start();
        let most = self.most.map_or(usize::MAX, |most| most + 1);
        for (n, event) in std::iter::once(begin).chain(run.by_ref()).take(most).enumerate() {
            let name = self.name(&event, &mut end);
            let row = self.row(n, &event, name)?;
            if !has_digits(&row.time) && self.is_lost(&event) {
                end.notes.push(format!(
                    "after {} events no digit of the time is left: the run ends there",
                    n.saturating_sub(1)
                ));
                break;
            }
            take(row, event)?;
        }
        end.notes.extend(self.cause(&run));
        Ok(end)
    }

    /// Whether the error of an event's time, of which no digit is left, is more than a rounding of
    /// the system's unit of time: a time next to zero has no digit either.
    fn is_lost(&self, event: &Event<DoubleDouble>) -> bool {
        let error = event.errors.as_ref().map_or(f64::INFINITY, |it| it.time);
        error.is_nan() || error > f64::EPSILON * self.system.time_scale
    }

    /// What a run that had to end where it did says of it.
    fn cause(&self, run: &Run<'_, DoubleDouble>) -> Option<String> {
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
    fn search_note(&self, run: &Run<'_, DoubleDouble>) -> String {
        let searched = about(run.searched().value().to_f64());
        if run.overflows() {
            return format!(
                "its state at about {searched} is too large for its bounds to be numbers"
            );
        }
        format!("its search for the next event came to about {searched}{}", self.left_open(run))
    }

    /// What rounding left open where a search ended: which guard is first, or whether one crosses.
    fn left_open(&self, run: &Run<'_, DoubleDouble>) -> String {
        let quoted =
            |it: &What<DoubleDouble>| self.event_name(it).map(|name| format!("\"{name}\""));
        let tie: Vec<String> = run.tie().iter().filter_map(quoted).collect();
        if let [others @ .., last] = &tie[..] {
            let others = others.join(", ");
            return format!(
                ", where rounding leaves open which of the guards of {others} and {last} crosses \
                 first"
            );
        }
        let open = run.doubtful().as_ref().and_then(quoted);
        open.map_or(String::new(), |name| {
            format!(", where rounding leaves open whether the guard of {name} crosses")
        })
    }

    /// The name of an event, if it is none of a start or an ending.
    fn event_name(&self, what: &What<DoubleDouble>) -> Option<&str> {
        match what {
            What::Until(mode, index) => Some(&self.system.modes[*mode].until[*index].name),
            What::Watch(mode, index) => Some(&self.system.modes[*mode].watch[*index].name),
            What::Start | What::End(_) => None,
        }
    }

    fn row(&self, n: usize, event: &Event<DoubleDouble>, name: String) -> Result<EventRow> {
        let Some(errors) = &event.errors else { bail!("event {n} has no enclosed errors") };
        let cells = event.state.iter().zip(&errors.state);
        let cells = cells.map(|(value, error)| proved(*value, *error, self.digits));
        Ok(EventRow {
            n,
            time: proved(event.time.value(), errors.time, self.digits),
            event: name,
            mode: self.system.modes[event.mode].name.clone(),
            state: self.system.states.iter().cloned().zip(cells).collect(),
        })
    }

    /// The event's name, or that of the ending, which leaves a note.
    fn name(&self, event: &Event<DoubleDouble>, end: &mut RunEnd) -> String {
        let What::End(ending) = &event.what else {
            return self.event_name(&event.what).unwrap_or_default().to_owned();
        };
        let time = event.time.value();
        let (name, note, decided) = match ending {
            Ending::Horizon => return "end".to_owned(),
            Ending::Accumulation(from, to) => {
                let error = event.errors.as_ref().map_or(0.0, |it| it.time);
                let middle = time + (*from + *to) * DoubleDouble::exact(0.5);
                let width = 0.5 * (*to - *from).to_f64() + error + 1e-29 * time.to_f64().abs();
                let [earliest, latest] = [-width, width].map(|it| {
                    let bound = middle + DoubleDouble::exact(it);
                    proved(bound, 1e-30 * bound.to_f64().abs(), 30)
                });
                let note =
                    format!("infinitely many impacts accumulate between {earliest} and {latest}");
                end.accumulation = Some(Accumulation { earliest, latest });
                ("accumulation", note, true)
            }
            Ending::LeavesDomain => {
                ("leaves-domain", "the boundary of the mode is reached".to_owned(), true)
            }
            Ending::NoProgress => {
                ("no-progress", "64 events fall on one instant".to_owned(), false)
            }
            Ending::BeyondGuard => {
                ("beyond-guard", "the mode is entered beyond one of its guards".to_owned(), false)
            }
            Ending::Undecided => {
                ("undecided", "what comes next is not decided by 106 bits".to_owned(), false)
            }
        };
        let error = event.errors.as_ref().map_or(0.0, |it| it.time);
        end.notes.push(format!("the run ends at {}: {note}", proved(time, error, self.digits)));
        end.undecided = !decided;
        name.to_owned()
    }
}

/// A number to six digits, with an exponent where it is large.
fn about(number: f64) -> String {
    let rounded = format!("{number:.5e}").parse().unwrap_or(number);
    let text = format!("{rounded:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

fn in_order<S: serde::Serializer>(
    state: &[(String, String)],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_map(state.iter().map(|(name, cell)| (name, cell)))
}
