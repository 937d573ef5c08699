//! The parameters of a picture, in the paper's notation.

use percuss::{Parameter, Parameters};

/// A parameter's symbol.
#[must_use]
pub const fn symbol(parameter: Parameter) -> &'static str {
    match parameter {
        Parameter::Xi => "\u{3be}",
        Parameter::Omega => "\u{3c9}",
        Parameter::Phi => "\u{3c6}",
        other => other.as_str(),
    }
}

/// All parameters; phi only where it is not the paper's.
#[must_use]
pub fn caption(parameters: &Parameters) -> String {
    caption_without(parameters, None)
}

/// All parameters but the one that varies.
#[must_use]
pub fn caption_without(parameters: &Parameters, varies: Option<Parameter>) -> String {
    let usual = Parameters::default().phi;
    let shown = |parameter: &Parameter| {
        Some(*parameter) != varies && (*parameter != Parameter::Phi || parameters.phi != usual)
    };
    let named = |it: Parameter| format!("{} = {}", symbol(it), it.of(parameters));
    let all: Vec<String> = Parameter::ALL.into_iter().filter(shown).map(named).collect();
    all.join(", ")
}
