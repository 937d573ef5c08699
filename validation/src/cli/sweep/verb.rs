//! The verb that a plan names, with its fixed flags.

use super::basins::BasinWork;
use super::branches::BranchWork;
use super::diagrams::DiagramWork;
use super::exponents::ExponentWork;
use crate::cli::{self, Verb};
use crate::sweep::{Plan, SweepVerb};
use anyhow::{Result, anyhow, bail};
use clap::Parser;

/// What a plan's verb does at each of its points.
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
    let parsed = cli::Arguments::try_parse_from(words).map_err(|error| objection(&error))?;
    Ok(match parsed.verb {
        Verb::Basins(arguments) => Box::new(BasinWork::labels(*arguments)),
        Verb::Attractors(arguments) => Box::new(BasinWork::attractors(*arguments)),
        Verb::Lyapunov(arguments) => Box::new(ExponentWork::new(*arguments)?),
        Verb::Bifurcation(arguments) => Box::new(DiagramWork::new(*arguments, plan)?),
        Verb::Continue(arguments) => Box::new(BranchWork::new(*arguments)),
        _ => bail!("verb = \"{verb}\" is not accepted"),
    })
}

/// What clap objects to in [fixed], in one line.
fn objection(error: &clap::Error) -> anyhow::Error {
    let text = error.to_string();
    let text = text.strip_prefix("error: ").unwrap_or(&text);
    let end = ["\n\nUsage:", "\n\nFor more"].iter().filter_map(|mark| text.find(mark)).min();
    let line: Vec<_> = text[..end.unwrap_or(text.len())].split_whitespace().collect();
    anyhow!("[fixed]: {}", line.join(" "))
}
