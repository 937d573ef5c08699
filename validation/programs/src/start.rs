//! A program started for the first time: what it says of itself becomes engines.

use crate::engine::{NotStarted, ProgramEngine};
use crate::pool::Pool;
use crate::process::Process;
use crate::programs_file::{Program, is_name};
use crate::text::plain;
use crate::wire::{Capabilities, ReplyContent, SetUp};
use std::io::ErrorKind;
use std::sync::Arc;

impl Program {
    /// Starts the program and asks it what it can do: each of its set-ups is an engine.
    ///
    /// The processes of the program end with the last of these engines.
    ///
    /// # Errors
    /// Why there are no engines: the program is not installed, or did something wrong.
    pub fn start(&self) -> Result<Vec<ProgramEngine>, NotStarted> {
        let unavailable = |why: String| NotStarted::Unavailable { program: self.name.clone(), why };
        let failed = |why: String| NotStarted::Failed { program: self.name.clone(), why };
        let mut process = match Process::start(self) {
            Ok(process) => process,
            Err(error) if error.kind() == ErrorKind::NotFound => {
                let command = self.command.first().map_or("", String::as_str);
                return Err(unavailable(format!("there is no command {:?}", plain(command))));
            }
            Err(error) => return Err(failed(format!("cannot be started: {error}"))),
        };
        let said = match process.capabilities(self.timeout).map_err(failed)? {
            ReplyContent::Capabilities(said) => said,
            ReplyContent::Unavailable(why) => return Err(unavailable(why)),
            ReplyContent::Failure(why) => return Err(failed(why)),
            _ => return Err(failed("did not say what it can do".to_owned())),
        };
        check(&said).map_err(failed)?;
        process.still_ready(self.timeout).map_err(failed)?;
        let pool = Arc::new(Pool::new(self.clone(), process));
        let engine = |set_up: &SetUp| ProgramEngine::new(&pool, &said, set_up);
        Ok(said.set_ups.iter().map(engine).collect())
    }
}

/// Checks what a program says of itself.
fn check(said: &Capabilities) -> Result<(), String> {
    let Capabilities { library, version, language, set_ups } = said;
    for (key, text) in [("library", library), ("version", version), ("language", language)] {
        is_text(text).map_err(|why| format!("its {key} {why}"))?;
    }
    if set_ups.is_empty() {
        return Err("names no set-ups; accepted is one or more".to_owned());
    }
    for (n, set_up) in set_ups.iter().enumerate() {
        let name = plain(&set_up.name);
        if !is_name(&set_up.name) {
            return Err(format!(
                "its set-up {name:?} has no name: accepted are 1 to 40 lower-case letters, digits, \
                 '-', '_', '.', '+'"
            ));
        }
        if set_ups[..n].iter().any(|other| other.name == set_up.name) {
            return Err(format!("its set-up {name:?} is there twice"));
        }
        is_text(&set_up.method)
            .map_err(|why| format!("the method of its set-up {name:?} {why}"))?;
        if set_up.order.is_some_and(|order| !(1..=64).contains(&order))
            || set_up.stepping.of_order(set_up.order).is_none()
        {
            return Err(format!("its set-up {name:?} has no order: accepted is 1 to 64"));
        }
    }
    Ok(())
}

/// Whether a text fits where it is shown.
fn is_text(text: &str) -> Result<(), String> {
    let shown = plain(text);
    if text.is_empty() || shown != text {
        return Err(format!("is {shown:?}; accepted is one line of 1 to 200 characters"));
    }
    Ok(())
}
