//! The section of a SYSTEM's motions at which verbs of the dynamics look.

use super::parse::{self, SectionChoice, Typed};
use super::system_choice::FLAG_PLACE;
use super::terminal::note;
use anyhow::{Result, anyhow, bail};
use clap::Args;
use percuss::affine::{NoReturn, Section, SectionMap, Solver};

/// The number of returns between two updates of a progress bar.
pub(in crate::cli) const RETURNS_PER_UPDATE: u64 = 64;

/// Flags for the returns to a section: every N-th alone, and the longest wait for one.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "SYSTEM and its start")]
pub(in crate::cli) struct ReturnFlags {
    /// Takes every N-th return to the section alone [default: 1]
    #[arg(long, value_name = "N", value_parser = parse::whole::<u32>(1, 1_000_000_000), allow_hyphen_values = true)]
    every: Option<u32>,
    /// The longest time to wait for a return [default: 1000 of the SYSTEM's units of time]
    #[arg(long, value_name = "T", value_parser = parse::positive, allow_hyphen_values = true)]
    max_time: Option<Typed<f64>>,
}

/// The section of a verb that has none without SYSTEM.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "SYSTEM and its start")]
pub(in crate::cli) struct SectionFlags {
    /// The section: strobe[:ANGLE] at a forcing angle omega t mod 2 pi, or EVENT or EVENT@MODE,
    /// just after it [default: strobe:0 where the SYSTEM is forced]
    #[arg(long, value_name = "SECTION", value_parser = parse::section, allow_hyphen_values = true)]
    section: Option<Typed<SectionChoice>>,
    #[command(flatten)]
    returns: ReturnFlags,
}

impl SectionFlags {
    /// The return map of the section.
    pub(in crate::cli) fn map<'a>(&self, solver: &'a Solver<f64>) -> Result<SectionMap<'a, f64>> {
        self.returns.map(self.section.as_ref(), solver)
    }

    /// The section, and the longest time to wait for a return to it if that is given.
    pub(in crate::cli) fn section(&self) -> Result<(Section, Option<f64>)> {
        Ok((self.returns.section(self.section.as_ref())?, self.returns.longest()))
    }

    /// The section as it was written.
    pub(in crate::cli) fn text(&self) -> &str {
        self.section.as_ref().map_or("strobe", |it| it.text.as_str())
    }

    /// Refuses the flags where no system is chosen.
    pub(in crate::cli) fn refuse(&self) -> Result<()> {
        if let Some(section) = &self.section {
            bail!("{}", without_system("--section", section));
        }
        self.returns.refuse()
    }
}

impl ReturnFlags {
    /// The return map of a section, the default one where none is given.
    pub(in crate::cli) fn map<'a>(
        &self,
        section: Option<&Typed<SectionChoice>>,
        solver: &'a Solver<f64>,
    ) -> Result<SectionMap<'a, f64>> {
        let map = SectionMap::new(solver, &self.section(section)?);
        let map = map.map_err(|error| anyhow!("--{error}"))?;
        Ok(match self.longest() {
            Some(longest) => map.within(longest),
            None => map,
        })
    }

    /// The section, the strobe at the angle 0 where none is given.
    fn section(&self, section: Option<&Typed<SectionChoice>>) -> Result<Section> {
        let section = match section.map(|it| (&it.value, it)) {
            Some((SectionChoice::Angle(_), it)) => bail!(
                "--section {it} is not accepted with SYSTEM: strobe:{it}, EVENT and EVENT@MODE are"
            ),
            Some((SectionChoice::OfSystem(section), _)) => section.section(),
            None => Section::default(),
        };
        Ok(section.every(self.every()))
    }

    /// The number of instants of the section that make one return.
    pub(in crate::cli) fn every(&self) -> u32 {
        self.every.unwrap_or(1)
    }

    /// The longest time to wait for a return, if it is given.
    pub(in crate::cli) fn longest(&self) -> Option<f64> {
        self.max_time.as_ref().map(|it| it.value)
    }

    /// The flags that are given, as they are written.
    pub(in crate::cli) fn given(&self) -> Option<String> {
        let every = self.every.map(|it| format!("--every {it}"));
        every.or_else(|| self.max_time.as_ref().map(|it| format!("--max-time {it}")))
    }

    /// Refuses the flags where no system is chosen.
    pub(in crate::cli) fn refuse(&self) -> Result<()> {
        let every = self.every.map(|it| without_system("--every", &it));
        let longest = self.max_time.as_ref().map(|it| without_system("--max-time", it));
        match every.or(longest) {
            Some(line) => bail!("{line}"),
            None => Ok(()),
        }
    }
}

/// The line that refuses a flag of a system where none is chosen.
pub(in crate::cli) fn without_system(flag: &str, value: &dyn std::fmt::Display) -> String {
    format!("{flag} {value} is not accepted without SYSTEM: {FLAG_PLACE}")
}

/// Says that a motion has not returned as often as was asked; whether the model says so, and not
/// the arithmetic.
pub(in crate::cli) fn tell_no_return(why: NoReturn, returns: u64) -> bool {
    note(&no_return(why, returns));
    is_told_by_model(why)
}

/// The line that says that a motion has not returned as often as was asked.
pub(in crate::cli) fn no_return(why: NoReturn, returns: u64) -> String {
    format!("equilibrium or end after {returns} returns: {why}")
}

/// Whether the model says that a motion does not return, and not the arithmetic.
pub(in crate::cli) const fn is_told_by_model(why: NoReturn) -> bool {
    match why {
        NoReturn::Ended(ending) => ending.is_decided(),
        NoReturn::Equilibrium => true,
        _ => false,
    }
}

/// One line where rounding takes one side of ties and touches.
pub(in crate::cli) fn tell_undecidable(count: u64) {
    if count > 0 {
        note(&format!("{count} ties or touches are not decided by f64: the run takes one side"));
    }
}
