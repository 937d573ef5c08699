//! Answers of programs, checked as far as no task is needed for that.

use super::PROTOCOL;
use super::numbers::{BoundedList, Count, StateReply};
use crate::text::plain;
use percuss_engines::engine::{Class, Ending, SteppingKind};
use serde::Deserialize;

/// The most events and samples of an answer.
const MAX_ROWS: usize = 100_000;
/// The most names by which derivatives are answered.
const MAX_NAMES: usize = 1000;
/// The most set-ups of a program.
const MAX_SET_UPS: usize = 64;

/// The content of an answer.
#[derive(Clone, Debug)]
pub(crate) enum ReplyContent {
    /// The program's capabilities.
    Capabilities(Capabilities),
    /// The reason why the program cannot run on this machine.
    Unavailable(String),
    /// The result of a run.
    Run(Box<RunReply>),
    /// Why a run was not made.
    Failure(String),
    /// The limit that a run exceeded.
    GaveUp(String),
    /// The program waits for the next request.
    Ready,
}

/// A program's declaration of its library and its set-ups.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Capabilities {
    /// The library that the program runs.
    pub library: String,
    /// The library's version.
    pub version: String,
    /// The programming language of the program, with its version.
    pub language: String,
    #[serde(rename = "setups", deserialize_with = "set_ups")]
    /// The ways in which it can be set up, each of which is an engine.
    pub set_ups: Vec<SetUp>,
}

/// A way in which a program can be set up.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SetUp {
    /// The set-up's name, which follows that of the program in the name of the engine.
    pub name: String,
    /// The method.
    pub method: String,
    /// The method's errors are judged by those of its class, which a program may leave out.
    #[serde(default)]
    pub class: Option<Class>,
    /// The order of convergence that the method's authors state, if it has one.
    #[serde(default)]
    pub order: Option<u32>,
    /// Who finds the events.
    pub events: EventsBy,
    /// Whether the library has dense output of its own.
    pub dense_output: bool,
    /// The way in which the engine's accuracy is chosen.
    pub stepping: SteppingKind,
    /// Whether it runs back in time, where the end of a mode ends the run.
    #[serde(default = "default_true")]
    pub backward: bool,
    /// Whether the program reports events that do not end their mode.
    #[serde(default = "default_true")]
    pub watch: bool,
    /// Whether the program answers derivatives through events where they are asked for.
    #[serde(default)]
    pub gradients: bool,
    /// Whether these derivatives are differences of whole runs.
    #[serde(default)]
    pub differences: bool,
}

/// Who finds the events of a set-up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EventsBy {
    /// Events are located by the library.
    Library,
    /// The program locates them on what the library gives it.
    Program,
}

/// A run as a program answers it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RunReply {
    pub(crate) events: BoundedList<EventReply, MAX_ROWS>,
    pub(crate) samples: BoundedList<StateReply, MAX_ROWS>,
    pub(crate) end: StateReply,
    #[serde(default, with = "EndingWord")]
    pub(crate) ended: Ending,
    #[serde(default)]
    pub(crate) ended_at: Option<f64>,
    #[serde(default)]
    pub(crate) work: WorkReply,
    #[serde(default)]
    pub(crate) own_ns: Option<f64>,
    #[serde(default)]
    pub(crate) gradients: BoundedList<GradientReply, MAX_NAMES>,
}

/// The derivatives of a run by a name, as a program answers them.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct GradientReply {
    pub(crate) wrt: String,
    /// A list for all events, or none where there are those of the end alone.
    #[serde(default)]
    pub(crate) events: BoundedList<EventGradientReply, MAX_ROWS>,
    pub(crate) end: StateReply,
}

/// The derivatives of an event, as far as a program has them.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct EventGradientReply {
    #[serde(default)]
    pub(crate) time: Option<f64>,
    #[serde(default)]
    pub(crate) state: Option<StateReply>,
}

/// An event as a program answers it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct EventReply {
    pub(crate) time: f64,
    pub(crate) event: Count,
    pub(crate) mode: Count,
    /// The state just before the event's reset; of an event that ends no mode, its state itself.
    #[serde(default)]
    pub(crate) before: Option<StateReply>,
    pub(crate) state: StateReply,
}

/// The work of a run, as a program counts it.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct WorkReply {
    pub(crate) rhs: Count,
    pub(crate) jacobians: Count,
    pub(crate) linear_solves: Count,
    pub(crate) steps: Count,
}

/// The words for an [`Ending`] in an answer.
#[derive(Deserialize)]
#[serde(remote = "Ending", rename_all = "kebab-case")]
enum EndingWord {
    Horizon,
    NoProgress,
    Accumulation,
    LeavesDomain,
    BeyondGuard,
    Undecided,
}

fn default_true() -> bool {
    true
}

fn set_ups<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Vec<SetUp>, D::Error> {
    Ok(BoundedList::<SetUp, MAX_SET_UPS>::deserialize(deserializer)?.0)
}

/// What every answer begins with; the rest of it may be of another version.
#[derive(Deserialize)]
struct Header {
    percuss_protocol: Option<Count>,
    id: Option<Count>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Reply {
    #[serde(rename = "percuss_protocol")]
    _protocol: Count,
    #[serde(rename = "id")]
    _id: Count,
    capabilities: Option<Capabilities>,
    unavailable: Option<String>,
    run: Option<Box<RunReply>>,
    failure: Option<String>,
    gave_up: Option<String>,
    ready: Option<bool>,
}

/// The answer in a line to the request of this number.
///
/// # Errors
/// What the line is instead.
pub(crate) fn decode(line: &[u8], id: u64) -> Result<ReplyContent, String> {
    let text = std::str::from_utf8(line)
        .map_err(|error| format!("wrote what is not UTF-8, from byte {}", error.valid_up_to()))?;
    let text = text.trim_start_matches('\u{feff}').trim();
    if !text.starts_with('{') {
        return Err(format!(
            "wrote {:?} where an answer in JSON was expected: standard output is for answers alone",
            plain(text)
        ));
    }
    // Where even its head cannot be read, the whole of it says better what is wrong.
    let head = parse(text).map_err(|why| parse::<Reply>(text).err().unwrap_or(why));
    let Header { percuss_protocol: version, id: answered } = head?;
    match version {
        Some(Count(PROTOCOL)) => {}
        Some(Count(other)) => {
            return Err(format!("speaks version {other} of the protocol; accepted is {PROTOCOL}"));
        }
        None => return Err(format!("answers without percuss_protocol; accepted is {PROTOCOL}")),
    }
    match answered {
        Some(Count(answered)) if answered == id => parse::<Reply>(text)?.answered(),
        Some(Count(answered)) if (1..id).contains(&answered) => {
            Err(format!("answered request {answered} again, where {id} was asked"))
        }
        Some(Count(answered)) => {
            Err(format!("answered request {answered}, which was not asked; {id} was"))
        }
        None => Err("answers without an id; accepted is that of the request".to_owned()),
    }
}

impl Reply {
    fn answered(self) -> Result<ReplyContent, String> {
        let answers = [
            self.capabilities.map(ReplyContent::Capabilities),
            self.unavailable.map(|why| ReplyContent::Unavailable(plain(&why))),
            self.run.map(ReplyContent::Run),
            self.failure.map(|why| ReplyContent::Failure(plain(&why))),
            self.gave_up.map(|why| ReplyContent::GaveUp(plain(&why))),
            self.ready.filter(|ready| *ready).map(|_| ReplyContent::Ready),
        ];
        let mut given = answers.into_iter().flatten();
        match (given.next(), given.next()) {
            (Some(answered), None) => Ok(answered),
            (None, _) => Err(format!("answered nothing; accepted is one of {KINDS}")),
            (Some(_), Some(_)) => Err(format!("answered two things; accepted is one of {KINDS}")),
        }
    }
}

const KINDS: &str = "capabilities, unavailable, run, failure, gave_up, ready";

fn parse<'de, T: Deserialize<'de>>(text: &'de str) -> Result<T, String> {
    let mut reader = serde_json::Deserializer::from_str(text);
    let parsed = serde_path_to_error::deserialize(&mut reader).map_err(|error| {
        let path = error.path().to_string();
        let column = error.inner().column();
        format!("answered wrongly at {path}: {}{}", error.into_inner(), shown_near(text, column))
    })?;
    reader.end().map_err(|error| format!("answered more than one object: {error}"))?;
    Ok(parsed)
}

/// The text around a column of a line.
fn shown_near(text: &str, column: usize) -> String {
    const SHOWN_BYTES: usize = 20;
    let bytes = text.as_bytes();
    let from = column.saturating_sub(SHOWN_BYTES).min(bytes.len());
    let to = (column + SHOWN_BYTES).min(bytes.len());
    format!(", near {:?}", plain(&String::from_utf8_lossy(&bytes[from..to])))
}
