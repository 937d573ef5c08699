//! `orbit`: one periodic orbit, by Newton's method.

use super::json::OrbitJson;
use super::{Format, period};
use crate::cli::shared::format::OutputFlags;
use crate::cli::shared::long_work;
use crate::cli::shared::model::ModelFlags;
use crate::cli::{DONE, OUT_OF_BOUNDS, note, say};
use anyhow::Result;
use clap::Args;
use percuss::dynamics::orbit::{Orbit, scan};
use percuss::dynamics::strobe::StrobeMap;

/// Find a periodic orbit, stable or not, from a guess (--p, --y, --q) or from a scan of starts
#[derive(Args)]
pub(crate) struct Arguments {
    /// Forcing periods of the orbit; one that closes after a divisor is reported with that
    #[arg(long, value_name = "K", value_parser = period, allow_hyphen_values = true)]
    period: u32,
    #[command(flatten)]
    output: OutputFlags<Format>,
    #[command(flatten)]
    model: ModelFlags,
}

pub(crate) fn run(arguments: &Arguments) -> Result<u8> {
    arguments.output.format(Format::Json)?;
    let (problem, guessed) = arguments.model.guess(None)?;
    let map = StrobeMap::new(problem.model, problem.entry.instant);
    let found = if guessed {
        Orbit::find(&map, problem.entry.point(), arguments.period)
            .map_err(|none| (none.residual, none.to_string()))
    } else {
        scanned(&map, arguments.period)
    };
    let shown = found.as_ref().map_err(|(residual, _)| *residual);
    arguments.output.destination().json(&OrbitJson::new(&problem.model, shown))?;
    Ok(match found {
        Ok(_) => DONE,
        Err((_, why)) => {
            say(&why);
            OUT_OF_BOUNDS
        }
    })
}

/// The preferred orbit of a scan; how many others there are is said.
pub(super) fn scanned(map: &StrobeMap, period: u32) -> Result<Orbit, (f64, String)> {
    let bar = long_work::share_bar();
    let found = scan(map, period, &mut |share| bar.show_share(share));
    bar.finish_and_clear();
    say_which(&found, period);
    preferred(found, period)
}

/// Says how many orbits of the period a scan has found, where it is more than one.
fn say_which(found: &[Orbit], period: u32) {
    let whole = found.iter().filter(|it| it.period() == period);
    let (count, stable) = (whole.clone().count(), whole.filter(|it| it.is_stable()).count());
    if count > 1 {
        note(&format!(
            "a scan found {count} orbits of period {period}, {stable} of them stable; this is one: --p, --y and --q near another select that"
        ));
    }
}

/// The first orbit that a scan has found.
pub(super) fn preferred(found: Vec<Orbit>, period: u32) -> Result<Orbit, (f64, String)> {
    found.into_iter().next().ok_or_else(|| {
        (f64::INFINITY, format!("no orbit of period {period} was found by a scan of starts"))
    })
}
