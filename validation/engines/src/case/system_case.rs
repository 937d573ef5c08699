//! A case of a piecewise-affine system.

use super::Case;
use super::expectations::{BoundTable, ShortcomingTable};
use super::located::{FileError, FileText, read_text};
use super::systems::named;
use percuss::affine::{System, SystemFile, TROUBLE};
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::path::Path;
use toml::Spanned;

/// Samples of the state in a case that names no number of them.
const DEFAULT_SAMPLES: i64 = 100;
/// The most samples of the state that a case may ask for.
const MAX_SAMPLES: i64 = 100_000;

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "the tables of a case of a system")]
struct SystemCaseFile {
    case: SystemCaseTable,
    #[serde(rename = "parameters")]
    _parameters: Option<IgnoredAny>,
    #[serde(rename = "start")]
    _start: Option<IgnoredAny>,
    horizon: SystemHorizonTable,
    #[serde(default)]
    bounds: Vec<BoundTable>,
    #[serde(default)]
    shortcomings: Vec<ShortcomingTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [case]")]
struct SystemCaseTable {
    name: Spanned<String>,
    system: Spanned<String>,
    why: String,
    #[serde(default)]
    trouble: Vec<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [horizon]")]
struct SystemHorizonTable {
    until: Spanned<f64>,
    samples: Option<Spanned<i64>>,
    #[serde(default)]
    backward: bool,
}

/// Whether the text of a case names a system; those of the oscillator do not.
pub(super) fn is_of_a_system(text: &str) -> bool {
    // As the text stands: a number that is too large for its type is no reason to take the case for
    // one of the oscillator.
    let table = toml::de::DeTable::parse(text).ok();
    let case = table.as_ref().and_then(|it| it.get_ref().get("case"));
    case.and_then(|it| it.get_ref().as_table()).is_some_and(|it| it.contains_key("system"))
}

/// Reads a case; `folder` holds the systems' files that are not inside the binary.
///
/// # Errors
/// [`FileError`] names the file's line, the field, its value and what is accepted.
pub fn parse_system_case(file: &str, text: &str, folder: Option<&Path>) -> Result<Case, FileError> {
    let source = FileText { file, text };
    let wire: SystemCaseFile = source.parse()?;
    let SystemCaseTable { name, system, why, trouble } = wire.case;
    source.plain_name(&name)?;
    let each_kind = trouble.into_iter().map(|it| source.kind_of_trouble(it));
    let trouble = each_kind.collect::<Result<_, _>>()?;
    let mut read = source.system(&system, folder)?;
    let of_file = |error: percuss::affine::SystemError| FileError(error.to_string());
    read.replace_from(file, text, true).map_err(of_file)?;
    let exact = read.system().map_err(of_file)?;
    refuse_limits(&exact).map_err(|what| FileError(format!("{file}: {what}")))?;
    let Some(begin) = begin(&exact) else {
        let states = exact.states.join(", ");
        let accepted =
            format!("one with mode and the states {states}, here or in the system's file");
        return Err(FileError::lacks(file, text, "start", &accepted));
    };
    let (until, backward) = (*wire.horizon.until.get_ref(), wire.horizon.backward);
    let ahead = if backward { begin - until } else { until - begin };
    if !(ahead.is_finite() && ahead > 0.0) {
        let side = if backward { "before" } else { "after" };
        let what = format!("until = {until:?} is not accepted: a time {side} the start, {begin:?}");
        return Err(source.error(&wire.horizon.until, &what));
    }
    let each_bound = wire.bounds.into_iter().map(|it| source.bound(it));
    let each_shortcoming = wire.shortcomings.into_iter().map(|it| source.shortcoming(it));
    Ok(Case {
        name: name.into_inner(),
        file: file.to_owned(),
        text: text.to_owned(),
        why,
        trouble,
        system: exact,
        until,
        backward,
        samples: source.samples(wire.horizon.samples)?,
        oscillator: None,
        bounds: each_bound.collect::<Result<_, _>>()?,
        shortcomings: each_shortcoming.collect::<Result<_, _>>()?,
    })
}

/// Refuses a system that goes on after an accumulation: integrators are not asked for that.
fn refuse_limits(system: &System) -> Result<(), String> {
    let named = |mode: &percuss::affine::Mode| {
        let until = mode.until.iter().find(|it| it.accumulates_to.is_some())?;
        Some(format!("mode {:?}, until {:?}", mode.name, until.name))
    };
    let Some(item) = system.modes.iter().find_map(named) else { return Ok(()) };
    Err(format!(
        "the system {}, {item}: accumulates_to is not accepted in a case: accepted are systems \
         whose runs end where impacts accumulate",
        system.name
    ))
}

/// The clock's time at the start, rounded.
fn begin(system: &System) -> Option<f64> {
    Some(system.start.as_ref()?.time.to_f64())
}

impl FileText<'_> {
    /// The system's file of this name: that in the folder, or that inside the binary.
    fn system(
        &self,
        name: &Spanned<String>,
        folder: Option<&Path>,
    ) -> Result<SystemFile, FileError> {
        let file = format!("{}.system.toml", name.get_ref());
        let beside = folder.map(|folder| folder.join(&file)).filter(|path| path.is_file());
        let of_file = |error: percuss::affine::SystemError| FileError(error.to_string());
        if let Some(path) = beside {
            let text = read_text(&path)?;
            let read = SystemFile::read(&path.display().to_string(), &text).map_err(of_file)?;
            return named_like_its_file(read, &path, name.get_ref());
        }
        let text = named(name.get_ref()).ok_or_else(|| {
            let what = format!(
                "system = {:?} is not accepted: {file} beside the case, or a name that percuss \
                 systems lists",
                name.get_ref()
            );
            self.error(name, &what)
        })?;
        SystemFile::read(&format!("systems/{file}"), text).map_err(of_file)
    }

    fn kind_of_trouble(&self, kind: Spanned<String>) -> Result<String, FileError> {
        if TROUBLE.contains(&kind.get_ref().as_str()) {
            return Ok(kind.into_inner());
        }
        let (typed, kinds) = (self.typed(&kind), TROUBLE.join(", "));
        Err(self.error(&kind, &format!("trouble {typed} is not accepted: any of {kinds}")))
    }

    fn samples(&self, samples: Option<Spanned<i64>>) -> Result<u32, FileError> {
        let Some(samples) = samples else { return Ok(DEFAULT_SAMPLES as u32) };
        let count = u32::try_from(*samples.get_ref()).ok();
        let count = count.filter(|_| (1..=MAX_SAMPLES).contains(samples.get_ref()));
        count.ok_or_else(|| self.refused("samples", &samples))
    }
}

/// Refuses a system that has another name than its file: two files could then hold one system.
fn named_like_its_file(read: SystemFile, path: &Path, name: &str) -> Result<SystemFile, FileError> {
    let own = read.system().map_err(|error| FileError(error.to_string()))?.name;
    if own == name {
        return Ok(read);
    }
    let what = format!("name = {own:?} is not accepted: in this file it is {name:?}");
    Err(FileError::new(&path.display().to_string(), what))
}
