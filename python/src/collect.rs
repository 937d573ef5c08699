//! The events of a run one by one, ended as the command `events` ends them.

use crate::gradient::{ByName, by_name};
use percuss::{Answer, Ending, Event, Events, Proved};

/// The most digits of a time that are counted, of which it needs one.
const COUNTED_DIGITS: usize = 6;

/// The ending of a run that has as many events as it may have.
pub(crate) const STOPPED_ENDING: &str = "stopped";

/// The ending of a run at an event whose time is not known to even one significant digit.
const NO_DIGITS_ENDING: &str = "no-digits";

/// The limits of a run besides its time.
#[derive(Clone, Copy)]
pub(crate) struct Limits {
    /// The number of events that are wanted.
    pub(crate) count: Option<usize>,
    /// The number of events after which a run is stopped.
    pub(crate) most: Option<usize>,
    /// The unit of time of the system.
    pub(crate) time_scale: f64,
}

/// A row of a run: the start, an event, or the ending.
#[derive(Clone)]
pub(crate) struct Kept<V> {
    /// The event's name, or that of the ending; nothing for the start.
    pub(crate) name: String,
    /// The index of the mode that begins.
    pub(crate) mode: usize,
    pub(crate) time: V,
    pub(crate) state: Vec<V>,
    /// The derivatives by each name by which the run is differentiated.
    pub(crate) gradients: Vec<ByName<V>>,
}

/// The end of a run.
#[derive(Clone, Default)]
pub(crate) struct End {
    /// Its name; none where the run has the number of events that was asked for.
    pub(crate) name: Option<String>,
    /// Whether the model says so or the time is over.
    pub(crate) is_decided: bool,
    pub(crate) cause: Option<String>,
    /// The earliest and the latest time at which impacts accumulate.
    pub(crate) accumulation: Option<[String; 2]>,
    pub(crate) bits: u32,
    /// The choices that rounding leaves open.
    pub(crate) undecidable: u64,
}

impl End {
    /// The run ends with an event that is its ending.
    pub(crate) fn comes_with<V: Value>(&mut self, event: &Event<'_, V>, ending: Ending) {
        self.name = Some(ending.as_str().to_owned());
        self.is_decided = ending.is_decided();
        self.accumulation = (ending == Ending::Accumulation).then(|| between(event)).flatten();
    }
}

/// A number of a run.
pub(crate) trait Value: Clone + Send + Sync + 'static {
    /// Whether a time of this value has a digit, in a system with this unit of time.
    fn is_known(&self, time_scale: f64) -> bool;

    /// The two decimals between which the number lies.
    fn enclosing_decimals(&self) -> [Option<String>; 2];
}

impl Value for Proved {
    fn is_known(&self, time_scale: f64) -> bool {
        // A time next to zero has few digits though it is known well.
        self.error() <= f64::EPSILON * time_scale || self.digits(COUNTED_DIGITS) != Some(0)
    }

    fn enclosing_decimals(&self) -> [Option<String>; 2] {
        /// The digits that the command shows of the times of an accumulation.
        const END_DIGITS: u8 = 30;
        [self.lower(END_DIGITS), self.upper(END_DIGITS)]
    }
}

impl Value for f64 {
    fn is_known(&self, _: f64) -> bool {
        self.is_finite()
    }

    fn enclosing_decimals(&self) -> [Option<String>; 2] {
        [Some(format!("{self:?}")), Some(format!("{self:?}"))]
    }
}

/// Goes through a run that is differentiated by these names, its start first, and gives each row to
/// `keep`, which may end it by an error.
pub(crate) fn walk<A, E>(
    mut events: Events<'_, A>,
    limits: Limits,
    names: &[String],
    keep: &mut dyn FnMut(Kept<A::Value>) -> Result<(), E>,
) -> Result<End, E>
where
    A: Answer,
    A::Value: Value,
{
    let mut end = End { is_decided: true, ..End::default() };
    let mut last = row(&events.start(), String::new(), names);
    keep(last.clone())?;
    let mut passed = 0;
    while limits.count.is_none_or(|wanted| passed < wanted) {
        let Some(event) = events.next() else { break };
        if event.ending().is_none() && limits.most.is_some_and(|most| passed >= most) {
            end.name = Some(STOPPED_ENDING.to_owned());
            keep(Kept { name: STOPPED_ENDING.to_owned(), ..last })?;
            break;
        }
        passed += 1;
        if !event.time().is_known(limits.time_scale) {
            end.name = Some(NO_DIGITS_ENDING.to_owned());
            break;
        }
        last = row(&event, event.name().to_owned(), names);
        if let Some(ending) = event.ending() {
            end.comes_with(&event, ending);
        }
        keep(last.clone())?;
    }
    end.cause = events.cause().map(|it| it.to_string());
    (end.bits, end.undecidable) = (events.bits(), events.undecidable());
    Ok(end)
}

/// The row of an event, differentiated by these names.
pub(crate) fn row<V: Clone>(event: &Event<'_, V>, name: String, names: &[String]) -> Kept<V> {
    let (time, state) = (event.time().clone(), event.state().to_vec());
    Kept { name, mode: event.mode_index(), time, state, gradients: by_name(event, names) }
}

/// The times between which impacts accumulate.
fn between<V: Value>(event: &Event<'_, V>) -> Option<[String; 2]> {
    let [from, to] = event.accumulation()?;
    let ([earliest, _], [_, latest]) = (from.enclosing_decimals(), to.enclosing_decimals());
    Some([earliest?, latest?])
}
