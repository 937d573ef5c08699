//! The returns by which a run is measured, as the flags ask for them.

use super::super::Arguments;
use crate::cli::shared::parse::SectionChoice;
use crate::returns::{CountedReturns, MAX_RETURNS, Uncounted, WantedReturns};
use anyhow::{Result, anyhow};
use percuss::{Solver, System};

/// The returns that the flags ask for; none where a run is not measured in them.
pub(super) fn counted(
    arguments: &Arguments,
    solver: &Solver<f64>,
) -> Result<Option<CountedReturns>> {
    let given = match (arguments.returns, arguments.transient) {
        (Some(count), _) => format!("--returns {count}"),
        (None, Some(count)) => format!("--transient {count}"),
        (None, None) => return Ok(None),
    };
    let (flags, section) = (&arguments.section_of_system, arguments.section.as_ref());
    let written = match section.map(|it| &it.value) {
        Some(SectionChoice::OfSystem(written)) => Some(written),
        _ => None,
    };
    let wanted = WantedReturns {
        left_out: arguments.transient.unwrap_or(0),
        wanted: arguments.returns,
        section: written,
        every: flags.every(),
        longest: flags.longest(),
    };
    if section.is_some() {
        flags.map(section, solver.for_sections())?;
    }
    let counted = wanted.counted(solver.system());
    Ok(Some(counted.map_err(|why| refusal(why, &given, flags.every(), solver.system()))?))
}

/// The line that says why returns cannot be counted.
fn refusal(why: Uncounted, given: &str, every: u32, system: &System) -> anyhow::Error {
    match why {
        Uncounted::TooMany(whole) => {
            let times = if every > 1 { ", times --every," } else { "" };
            anyhow!(
                "--transient and --returns{times} make {whole} returns: accepted are at most \
                 {MAX_RETURNS}"
            )
        }
        Uncounted::NotForced => anyhow!(
            "{given} is not accepted without --section: {} is not forced, so that no forcing \
             period makes a return; --section EVENT, --events and --until are accepted",
            system.name
        ),
        Uncounted::NoStart(error) => error.into(),
    }
}
