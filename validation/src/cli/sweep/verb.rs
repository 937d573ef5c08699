//! The verb that a plan names, with its fixed flags.

use super::basins::BasinWork;
use super::branches::BranchWork;
use super::diagrams::DiagramWork;
use super::exponents::ExponentWork;
use crate::cli::{self, Verb};
use crate::sweep::{Plan, SweepVerb};
use anyhow::{Result, anyhow, bail};
use clap::Parser;

/// The work of a plan's verb at each point.
pub(super) fn work(plan: &Plan) -> Result<Box<dyn SweepVerb>> {
    let verb = plan.verb.as_str();
    let mut words = vec!["percuss".to_owned(), verb.to_owned()];
    words.extend(plan.words.iter().cloned());
    match verb {
        "basins" => words.push("--output=.npz".to_owned()),
        "bifurcation" => words.extend(DiagramWork::words_of_axis(plan)?),
        "attractors" | "lyapunov" | "continue" => {}
        _ => bail!(
            "verb = \"{verb}\" is not accepted: accepted are basins, attractors, bifurcation, \
             lyapunov, continue"
        ),
    }
    check_off(plan)?;
    let parsed = cli::Arguments::try_parse_from(words)
        .map_err(|error| anyhow!("[fixed]: {}", cli::objection(&error)))?;
    Ok(match parsed.verb {
        Verb::Basins(arguments) => Box::new(BasinWork::labels(*arguments)?),
        Verb::Attractors(arguments) => Box::new(BasinWork::attractors(*arguments)?),
        Verb::Lyapunov(arguments) => Box::new(ExponentWork::new(*arguments)?),
        Verb::Bifurcation(arguments) => Box::new(DiagramWork::new(*arguments, plan)?),
        Verb::Continue(arguments) => Box::new(BranchWork::new(*arguments)?),
        _ => bail!("verb = \"{verb}\" is not accepted"),
    })
}

/// Refuses `false` for what is no switch of the verb.
fn check_off(plan: &Plan) -> Result<()> {
    let command = cli::command();
    let verb = command.find_subcommand(&plan.verb);
    let is_switch = |name: &str| {
        verb.into_iter()
            .flat_map(clap::Command::get_arguments)
            .any(|it| it.get_long() == Some(name) && !it.get_action().takes_values())
    };
    if let Some(name) = plan.off.iter().find(|name| !is_switch(name)) {
        bail!("[fixed] {name} = false is not accepted: {} has no such switch", plan.verb);
    }
    Ok(())
}
