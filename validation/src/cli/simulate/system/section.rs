//! The returns by which a run is measured: to a forcing angle, whose times are known before the
//! run, or to an event.

use super::super::Arguments;
use crate::cli::shared::parse::{MAX_PERIODS, SectionChoice};
use crate::typed::WrittenSection;
use anyhow::{Result, bail};
use percuss::affine::USUAL_LONGEST;
use percuss::{Kind, Solver, System};
use std::f64::consts::TAU;

/// Times so close to a strobe, beside a forcing period, are it.
const AT_STROBE: f64 = 1e-9;

/// The returns that a run counts.
pub(super) enum CountedReturns {
    /// Returns to a forcing angle.
    Strobes(Strobes),
    /// Returns to an event.
    Events(EventReturns),
}

/// Returns to a forcing angle: those that are left out, and those that are wanted where the run's
/// length is so many.
pub(super) struct Strobes {
    /// The time from which returns are counted.
    pub(super) zeroth: f64,
    period: f64,
    /// The number of forcing periods that make one return.
    pub(super) every: u64,
    pub(super) left_out: u64,
    pub(super) wanted: Option<u64>,
}

/// Returns to an event.
pub(super) struct EventReturns {
    kinds: Vec<Kind>,
    /// Events of the section that are left out.
    pub(super) left_out: u64,
    /// Events of the section with which the run ends, where its length is so many returns.
    pub(super) last: Option<u64>,
    /// The number of events that make one return.
    pub(super) every: u64,
    /// The longest time to wait for a return.
    pub(super) longest: f64,
}

impl Strobes {
    /// The time of a return, the first being number 1.
    fn at(&self, number: u64) -> f64 {
        self.zeroth + (number * self.every) as f64 * self.period
    }

    /// The time at which the transient ends.
    pub(super) fn first(&self) -> f64 {
        self.at(self.left_out)
    }

    /// The time at which the run ends, where its length is a number of returns.
    pub(super) fn last(&self) -> Option<f64> {
        self.wanted.map(|wanted| self.at(self.left_out + wanted))
    }
}

impl EventReturns {
    /// Whether an event of this kind is one of the section.
    pub(super) fn counts(&self, kind: Kind) -> bool {
        self.kinds.contains(&kind)
    }
}

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
    let (left_out, wanted) = (arguments.transient.unwrap_or(0), arguments.returns);
    let every = u64::from(arguments.section_of_system.every());
    check_count(left_out, wanted.unwrap_or(0), every)?;
    let system = solver.system();
    let section = arguments.section.as_ref();
    if section.is_some() {
        arguments.section_of_system.map(section, solver.for_sections())?;
    }
    let angle = match section.map(|it| &it.value) {
        Some(SectionChoice::OfSystem(WrittenSection::Event { event, mode })) => {
            let longest = arguments.section_of_system.longest();
            return Ok(Some(CountedReturns::Events(EventReturns {
                kinds: kinds(system, event, mode.as_deref()),
                left_out: left_out * every,
                last: wanted.map(|wanted| (left_out + wanted) * every),
                every,
                longest: longest.unwrap_or(USUAL_LONGEST * system.time_scale),
            })));
        }
        Some(SectionChoice::OfSystem(WrittenSection::Strobe(angle))) => Some(*angle),
        _ => None,
    };
    let Some(forcing) = &system.forcing else {
        bail!(
            "{given} is not accepted without --section: {} is not forced, so that no forcing \
             period makes a return; --section EVENT, --events and --until are accepted",
            system.name
        );
    };
    let omega = forcing.omega.to_f64();
    let (start, period) = (system.start()?.time.to_f64(), TAU / omega);
    let zeroth = angle.map_or(start, |angle| strobe_at_or_before(start, angle / omega, period));
    Ok(Some(CountedReturns::Strobes(Strobes { zeroth, period, every, left_out, wanted })))
}

/// Refuses more returns than a run may have.
fn check_count(left_out: u64, wanted: u64, every: u64) -> Result<()> {
    let whole = left_out.saturating_add(wanted).saturating_mul(every);
    if whole > MAX_PERIODS {
        let times = if every > 1 { ", times --every," } else { "" };
        bail!(
            "--transient and --returns{times} make {whole} returns: accepted are at most \
             {MAX_PERIODS}"
        );
    }
    Ok(())
}

/// The last strobe that is not after a time.
fn strobe_at_or_before(time: f64, first: f64, period: f64) -> f64 {
    let turns = (time - first) / period;
    let nearest = turns.round();
    let is_at_it = (turns - nearest).abs() <= AT_STROBE * turns.abs().max(1.0);
    first + if is_at_it { nearest } else { turns.floor() } * period
}

/// The kinds of the events of a name, in any mode or in one alone.
fn kinds(system: &System, event: &str, mode: Option<&str>) -> Vec<Kind> {
    let modes = system.modes.iter().enumerate();
    let own = modes.filter(|(_, it)| mode.is_none_or(|name| it.name == name));
    let of_mode = own.flat_map(|(n, it)| {
        let until = it.until.iter().enumerate().map(move |(k, it)| (Kind::Until(n, k), &it.name));
        let watch = it.watch.iter().enumerate().map(move |(k, it)| (Kind::Watch(n, k), &it.name));
        until.chain(watch)
    });
    of_mode.filter(|(_, name)| *name == event).map(|(kind, _)| kind).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_strobe_at_the_start_is_the_last_one() {
        assert_eq!(strobe_at_or_before(0.0, 0.0, 2.0), 0.0);
        assert_eq!(strobe_at_or_before(0.0, 0.5, 2.0), -1.5);
        assert_eq!(strobe_at_or_before(7.0, 0.5, 2.0), 6.5);
        assert_eq!(strobe_at_or_before(6.5 - 1e-12, 0.5, 2.0), 6.5);
    }
}
