//! The verb that a plan names, with its fixed flags.

use super::basins::BasinWork;
use super::branches::BranchWork;
use super::diagrams::DiagramWork;
use super::exponents::ExponentWork;
use super::of_system::{
    SweptSystem, SystemBasinWork, SystemBranchWork, SystemDiagramWork, SystemExponentWork,
};
use crate::cli::shared::model::ModelFlags;
use crate::cli::shared::system_choice::SystemChoice;
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
    of_verb(parsed.verb, plan)
}

/// The work of a verb that was read, of the system that it names or of the impact oscillator.
fn of_verb(verb: Verb, plan: &Plan) -> Result<Box<dyn SweepVerb>> {
    Ok(match verb {
        Verb::Basins(it) => match swept_system(&it.system, &it.model, plan)? {
            Some(swept) => Box::new(SystemBasinWork::labels(swept, *it)?),
            None => Box::new(BasinWork::labels(*it)?),
        },
        Verb::Attractors(it) => match swept_system(&it.system, &it.model, plan)? {
            Some(swept) => Box::new(SystemBasinWork::attractors(swept, *it)?),
            None => Box::new(BasinWork::attractors(*it)?),
        },
        Verb::Lyapunov(it) => match swept_system(&it.system, &it.model, plan)? {
            Some(swept) => Box::new(SystemExponentWork::new(swept, *it)?),
            None => Box::new(ExponentWork::new(*it)?),
        },
        Verb::Bifurcation(it) => match swept_system(&it.system, &it.model, plan)? {
            Some(swept) => Box::new(SystemDiagramWork::new(swept, *it, plan)?),
            None => Box::new(DiagramWork::new(*it, plan)?),
        },
        Verb::Continue(it) => match swept_system(&it.system, &it.model, plan)? {
            Some(swept) => Box::new(SystemBranchWork::new(swept, *it)?),
            None => Box::new(BranchWork::new(*it)?),
        },
        _ => bail!("verb = \"{}\" is not accepted", plan.verb),
    })
}

/// The system of a plan, if it has one; the flags of a system are refused without it.
fn swept_system(
    choice: &SystemChoice,
    model: &ModelFlags,
    plan: &Plan,
) -> Result<Option<SweptSystem>> {
    let chosen = choice.chosen(model)?;
    chosen.map(|chosen| SweptSystem::new(chosen, choice, plan)).transpose()
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
